#!/usr/bin/env python3
"""Formatting is a law: every model of the manual, the examples and the tests keeps its signs and its meaning.  Usage: fmt_test.py PLEUEL"""
import os
import pathlib
import re
import subprocess
import sys

from tap import check, done

program = os.path.abspath(sys.argv[1])
root = pathlib.Path(__file__).resolve().parent.parent.parent
clean = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "COLUMNS")} | {"LC_ALL": "C.UTF-8"}

# statements that no example has; with the lines that they need
HEAD = "param m = 1, g = 9.81, l = 1\ncoord x, y\naxes x right, y up\nmass A: m at (x, y)\npoint W at (l, 0)\n"
STATEMENTS = ["convention lambda-minus", "convention λ-minus", "convention lambda - minus", "convention lambda-plus",
              "gravity g along -y", "assume l in 0..2, m != 3", "init at 2 x = -1, x' = -(2)", "branch x >= -l",
              "constraint a: x - y >= -l with λ, off", "event e: when x-y = -1 falling -> x' = -0.5x', record",
              "let f(u) = -u^-2", "ask limit l >> x of -x, series m -> 0 order 2 of x^-1, expect -x = - x",
              "plot -x, E-E(0) vs -t", "simulate -1..2 step 1/10 tol 1e-9", "draw line between A and (-1, -l)",
              "for i in 1..3 step 2 {\npoint P[i] at (-i, i-1)\n}", "animate force of a, trail of A"]


def models():
    # tests/wrong is read by lang/format_test, and the large systems of tests/cases take their time
    for path in sorted([*root.glob("examples/*.pleuel"), *root.glob("tests/founding/*.pleuel"), *root.glob("tests/problems/*.pleuel"),
                        *root.glob("tests/export/*.pleuel")]):
        yield str(path.relative_to(root)), path.read_text(encoding="utf-8", errors="surrogateescape")
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        given = ""
        for mark, text in re.findall(r"(?:<!-- (\S+).*? -->\n)?```pleuel\n(.*?)```", page.read_text(encoding="utf-8"), re.S):
            given = text if mark == "given" else given
            yield f"{page.relative_to(root)}: {text.splitlines()[0]}", (given if mark == "part" else "") + text
    for line in STATEMENTS:
        yield line, HEAD + line + "\n"


def pleuel(arguments, text):
    run = subprocess.run([program, *arguments, "-"], input=text, capture_output=True, text=True, encoding="utf-8", env=clean,
                         errors="surrogateescape", timeout=60)
    return run.returncode, run.stdout


def meaning(text):
    code, dump = pleuel(["dump", "--after=check"], text)
    # requests and titles are kept as they were written
    return code, [line for line in dump.splitlines() if not line.startswith(("ask ", "plot ", "system"))]


def signs(text):
    # a comment gets a blank behind its mark, nothing else comes or goes
    return re.sub(r"\s+", "", text)


faults, n = [], 0
for name, text in models():
    before = None
    for flags in ([], ["--ascii"], ["--unicode"]):
        code, once = pleuel(["fmt", *flags], text)
        if code != 0:
            break                       # the syntax is wrong: the file is left alone
        n += 1
        before = before or meaning(text)
        if flags and before[0] == 3:
            continue                    # a wrong model may be wrong in its spelling: ϑ and θ are one in ASCII
        after = meaning(once)
        if before != after:
            faults.append(f"{name} {flags}: another meaning, exit {before[0]} becomes {after[0]}")
        if pleuel(["fmt", *flags], once)[1] != once:
            faults.append(f"{name} {flags}: formatting again changes it")
        if not flags and signs(text) != signs(once):
            faults.append(f"{name}: its signs change")
check(f"{n} texts keep their signs and their meaning", n > 300 and not faults, "\n".join(faults))
for line in STATEMENTS:
    code, _ = pleuel(["check"], HEAD + "constraint a: x = 0\n" * ("force of a" in line) + line + "\n")
    check(f"{line!r} is a statement", code in (0, 4), code)
done()
