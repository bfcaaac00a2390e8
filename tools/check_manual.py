#!/usr/bin/env python3
"""Runs the examples of the manual.  Usage: tools/check_manual.py PLEUEL

In README.md and docs/*.md:
  a fenced block ```pleuel        a model; `pleuel check` must find no error, and `pleuel solve` of those in docs/language.md must
                                  end with 0.  Blocks that belong together are joined when
                                  one says `<!-- continues -->` on the line before.  `<!-- wrong: E014 -->` before a block: the
                                  check must say E014.  `<!-- part -->`: a fragment, read with the declarations that it lacks
                                  in the block `<!-- given -->` before it.  `<!-- not run -->`: skipped.
  a fenced block ```console       lines `$ pleuel ...` are run in a folder that holds the examples; what stands below must be what
                                  comes out.  A line `...` stands for any lines.
In docs/diagnostics/CODE.md: the first ```pleuel block must produce CODE.
In man/: the pages of both languages name every verb of `pleuel help` and every flag of its page.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parent.parent
program = os.path.abspath(sys.argv[1])
environment = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "COLUMNS")} | {
    "LC_ALL": "C.UTF-8", "PATH": os.path.dirname(program) + ":" + os.environ["PATH"]}
faults = []
runs = 0


def blocks(path):
    """Line, mark, language and text of each fenced block."""
    lines = path.read_text(encoding="utf-8").splitlines()
    mark, i = "", 0
    while i < len(lines):
        fence = re.match(r"^```(\w*)\s*$", lines[i])
        remark = re.match(r"^<!--\s*(.*?)\s*-->$", lines[i])
        if remark:
            mark = remark.group(1)
        elif fence:
            start = i + 1
            i = start
            while i < len(lines) and lines[i] != "```":
                i += 1
            yield start, mark, fence.group(1), "\n".join(lines[start:i]) + "\n"
            mark = ""
        elif lines[i].strip():
            mark = ""
        i += 1


def pleuel(arguments, folder, text=None):
    global runs
    runs += 1
    done = subprocess.run([program, *arguments], cwd=folder, input=text, capture_output=True, text=True, encoding="utf-8",
                          env=environment, timeout=60)
    return done.returncode, done.stdout, done.stderr


def model_block(where, mark, text, given, folder):
    wrong = re.match(r"wrong:\s*(\w+)", mark)
    code, out, err = pleuel(["check", "--terse", "-"], folder, given + text if mark == "part" else text)
    said = out + err
    if wrong:
        if f" {wrong.group(1)}:" not in said:
            faults.append(f"{where}: should say {wrong.group(1)}, but says:\n{said}")
    elif code != 0:
        faults.append(f"{where}: does not check (exit {code}):\n{said}")
    elif where.startswith("docs/language.md"):
        code, out, err = pleuel(["solve", "-"], folder, given + text if mark == "part" else text)
        if code != 0:
            faults.append(f"{where}: does not solve (exit {code}):\n{out}{err}")


def matches(want, got):
    """Line by line; `...` stands for any lines."""
    if not want:
        return not got
    if want[0].strip() in ("...", "…"):
        return any(matches(want[1:], got[k:]) for k in range(len(got) + 1))
    return bool(got) and want[0].rstrip() == got[0].rstrip() and matches(want[1:], got[1:])


def session(where, text, folder):
    command, want = None, []
    for line in [*text.splitlines(), "$ "]:
        if not line.startswith("$ "):
            want.append(line)
            continue
        if command and "pleuel" in command:
            global runs
            runs += 1
            done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, encoding="utf-8",
                                  env=environment, timeout=60)
            got = (done.stdout + done.stderr).splitlines()
            while want and not want[-1].strip():
                want.pop()
            while got and not got[-1].strip():
                got.pop()
            if not matches(want, got):
                faults.append(f"{where}: $ {command}\n  the manual says:\n" + "\n".join("    " + w for w in want)
                              + "\n  the program says:\n" + "\n".join("    " + g for g in got[:60]))
        command, want = line[2:].strip(), []


def check_pages(folder):
    for path in sorted((root / "docs/diagnostics").glob("*.md")):
        models = [b for b in blocks(path) if b[2] == "pleuel"]
        where = f"docs/diagnostics/{path.name}"
        if not models:
            faults.append(f"{where}: has no model")
            continue
        line, mark, _, text = models[0]
        verb = re.search(r"run:\s*(.*)", mark)
        arguments = shlex.split(verb.group(1)) if verb else ["check", "--terse", "-"]
        _, out, err = pleuel(arguments, folder, text)
        if not re.search(rf"\b{path.stem}\b", out + err):
            faults.append(f"{where}:{line}: does not produce {path.stem}, but says:\n{out}{err}")


def check_man_pages():
    _, completion, _ = pleuel(["completion", "bash"], root)
    verbs = re.findall(r"^        ([a-z]+)\) words='", completion, re.M)
    if "solve" not in verbs:
        faults.append("tools/check_manual.py: no verbs found in the completion")
    for suffix in ("", ".de"):
        page = {n: (root / f"man/{n}{suffix}.1").read_text(encoding="utf-8").replace("\\-", "-") for n in ("pleuel", "pleuel-sim")}
        for verb in verbs:
            text = page["pleuel-sim" if verb == "sim" else "pleuel"]
            if not re.search(rf"^\.B[IR]* \"?{verb}\b", page["pleuel"], re.M):
                faults.append(f"man/pleuel{suffix}.1: no verb {verb}")
            _, help_text, _ = pleuel([verb, "-h"], root)
            for flag in sorted(set(re.findall(r"--[a-z][a-z-]*", help_text)) - {"--help"}):
                if flag not in text + page["pleuel"] and flag not in ("--output", "--force"):
                    faults.append(f"man/pleuel{suffix}.1: {verb} has {flag}")


with tempfile.TemporaryDirectory() as folder:
    for example in (root / "examples").glob("*.pleuel"):
        shutil.copy(example, folder)
    for path in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
        given = ""
        for line, mark, language, text in blocks(path):
            where = f"{path.relative_to(root)}:{line}"
            if mark == "not run":
                continue
            if mark == "given":
                given = text
            if language == "pleuel":
                model_block(where, mark, text, given, folder)
            if language == "console":
                session(where, text, folder)
    check_pages(folder)
    check_man_pages()

for f in faults:
    print(f)
print(f"{runs} examples run, {len(faults)} wrong")
sys.exit(1 if faults or runs == 0 else 0)
