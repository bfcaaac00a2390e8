#!/usr/bin/env python3
"""HTML reports in Chromium: what a reader can do with them, and whether they keep to themselves.

Needs chromium and node; playwright-core and axe-core come from npm into a directory of their own (the cache of the user),
never into the project.  Where something is missing the tests are skipped and say why.
"""
import csv
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests", "cli"))
from tap import check, done, skip  # noqa: E402

FOUNDING = ["examples/ski", "examples/atwood", "examples/crank"]
OTHERS = ["tests/problems/" + p for p in ("P03", "P16", "P21", "P47", "P49", "P54", "P09", "P31", "P40", "P43")]
LIMIT = 150_000
TOOLS = os.path.join(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "pleuel-browser")
PACKAGES = ["playwright-core", "axe-core", "vnu-jar"]


def tools():
    """The directory with the packages of npm, or None and why."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        return None, None, "chromium is not installed"
    if not shutil.which("node") or not shutil.which("npm"):
        return None, None, "node and npm are not installed"
    if not all(os.path.isdir(os.path.join(TOOLS, "node_modules", p)) for p in PACKAGES):
        os.makedirs(TOOLS, exist_ok=True)
        command = ["npm", "install", "--prefix", TOOLS, "--no-audit", "--no-fund", "--ignore-scripts", *PACKAGES]
        try:
            got = subprocess.run(command, capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired:
            return None, None, "npm did not answer"
        if got.returncode:
            return None, None, "npm could not install " + ", ".join(PACKAGES)
    return chromium, os.path.join(TOOLS, "node_modules"), None


def run(program, *arguments):
    env = {k: v for k, v in os.environ.items() if k != "PLEUEL_LANG"} | {"LC_ALL": "C.UTF-8"}
    return subprocess.run([program, *arguments], capture_output=True, cwd=ROOT, env=env, timeout=60)


def make(program, model, folder, *flags, name=None):
    name = name or os.path.basename(model)
    path = os.path.join(folder, name + ".html")
    made = run(program, "report", model + ".pleuel", "-o", path, *flags)
    check(f"{name}: a page is written", os.path.exists(path) and made.returncode in (0, 1), made.stderr.decode())
    return path


def rows(program, model, folder):
    """What `sim` writes on a grid that the page's rows contain: columns by name."""
    path = os.path.join(folder, "rows.csv")
    run(program, "sim", model + ".pleuel", "-f", "-o", path, "--dt", "0.05")
    if not os.path.exists(path):
        return {}
    table = list(csv.reader(open(path, encoding="utf-8")))
    return {head: [row[i] for row in table[1:] if not row[0].startswith("#")] for i, head in enumerate(table[0])}


def jobs_of(program, folder):
    jobs = []
    for model in FOUNDING + OTHERS:
        path = make(program, model, folder)
        size = os.path.getsize(path)
        if model in FOUNDING:
            check(f"{os.path.basename(model)}: at most {LIMIT} bytes with its font", size <= LIMIT, size)
        jobs.append({"name": os.path.basename(model), "path": path, "deep": model in FOUNDING})
    jobs[0]["sim"] = rows(program, FOUNDING[0], folder)
    jobs[2]["sim"] = rows(program, FOUNDING[2], folder)
    german = make(program, "examples/ski", folder, "--lang", "de", name="ski-de")
    jobs.append({"name": "ski-de", "path": german, "german": True})
    jobs.append({"name": "hostile", "path": make(program, "tests/browser/hostile", folder), "hostile": True})
    return jobs


class Reader(html.parser.HTMLParser):
    """Collects what a page points at, and whether the things are there that need no script."""

    def __init__(self):
        super().__init__()
        self.outside, self.tags, self.style = [], set(), False

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        self.style = tag == "style"
        self.outside += [f"{k}={v}" for k, v in attributes if k in ("src", "href", "action", "data", "poster", "srcset") and not (v or "").startswith("#")]
        self.outside += [f"{k}={v}" for k, v in attributes if k.startswith("on")]

    def handle_data(self, data):
        if self.style:
            self.outside += re.findall(r"@import[^;]*|url\((?!data:|#)[^)]*\)", data)


def without_script(path):
    """The derivation is there without a script, and nothing points outside."""
    name = os.path.basename(path)[:-5]
    page = Reader()
    page.feed(open(path, encoding="utf-8").read())
    check(f"{name}: formulas and picture are in the page itself", {"math", "svg"} <= page.tags)
    check(f"{name}: nothing points outside, nothing is run by an attribute", not page.outside, page.outside)


def flags(program, folder):
    plain = os.path.getsize(make(program, "examples/ski", folder, name="flags"))
    bare = open(make(program, "examples/ski", folder, "--no-font", "--no-animation", "--data", "none", name="flags-none"), encoding="utf-8").read()
    check("--no-font leaves the font out", "@font-face" not in bare and len(bare) < plain - 30_000)
    check("--no-animation leaves the picture out", 'id="anim"' not in bare)
    check("--data none leaves nothing to save", 'id="csv"' not in bare)
    full = open(make(program, "examples/ski", folder, "--data", "full", name="flags-full"), encoding="utf-8").read()
    check("--data full has every column", '"full":{' in full and "r_dot [m/s]" in full)
    some = open(make(program, "examples/ski", folder, "--only", "d", name="flags-only"), encoding="utf-8").read()
    check("--only shows the letter asked for", "<span>d</span>" in some and "<span>a</span>" not in some)
    other = open(make(program, "examples/ski", folder, "--set", "m=50", name="flags-set"), encoding="utf-8").read()
    check("--set changes the numbers", "50\u00a0kg" in other and "--set m=50" in other)
    again = run(program, "report", "examples/ski.pleuel", "-o", os.path.join(folder, "flags.html"))
    check("a page that is there is not replaced", again.returncode == 7 or again.returncode == 2, again.returncode)
    first, second = (run(program, "report", "examples/ski.pleuel", "-o", "-").stdout for _ in range(2))
    check("the same input gives the same bytes", first == second and first.startswith(b"<!doctype html>"))


def validate(paths, modules):
    jar = next((os.path.join(d, "vnu.jar") for d, _, files in os.walk(os.path.join(modules, "vnu-jar")) if "vnu.jar" in files), None)
    if not shutil.which("java") or not jar:
        skip("pages are valid HTML", "java or vnu.jar is not there")
        return
    said = subprocess.run(["java", "-jar", jar, "--format", "json", *paths], capture_output=True, text=True, timeout=120).stderr
    messages = json.loads(said)["messages"]
    # its style checker knows neither container queries nor math-depth, and it does not compare hashes of scripts
    wrong = [m for m in messages if m["type"] == "error" and not m["message"].startswith("CSS:")]
    check("pages are valid HTML", not wrong, "\n".join(f"{m['url'].split('/')[-1]}:{m.get('lastLine')}: {m['message']}" for m in wrong))


def browse(chromium, modules, jobs, folder):
    listing = os.path.join(folder, "jobs.json")
    json.dump({"chromium": chromium, "jobs": jobs, "pictures": os.environ.get("PLEUEL_PICTURES")}, open(listing, "w", encoding="utf-8"))
    env = os.environ | {"NODE_PATH": modules}
    got = subprocess.run(["node", os.path.join(HERE, "pages.js"), listing], capture_output=True, text=True, timeout=840, env=env)
    said = False
    for line in got.stdout.splitlines():
        fact = json.loads(line)
        said = True
        check(fact["name"], fact["ok"], json.dumps(fact.get("detail"), ensure_ascii=False))
    check("the browser went through all pages", got.returncode == 0 and said, got.stderr)


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        jobs = jobs_of(program, folder)
        for job in jobs:
            without_script(job["path"])
        flags(program, folder)
        chromium, modules, why = tools()
        if why:
            for what in ("pages in a browser", "pages are valid HTML"):
                skip(what, why)
        else:
            validate([job["path"] for job in jobs], modules)
            browse(chromium, modules, jobs, folder)
    done()


main()
