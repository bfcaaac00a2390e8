#!/usr/bin/env python3
"""Writes docs/errors-in-print.md from the models in tests/problems/print: their first lines say what the source prints and what is
right, their answers show it.

usage: errors_page.py PLEUEL [--check]      --check compares with the file and prints the difference"""
import os
import re
import subprocess
import sys

from kept_page import ROOT, keep

FOLDER = os.path.join("tests", "problems", "print")
ORDER = ["atwood_excess", "parabola", "rod_angle", "ladder", "cone", "cone_momentum", "governor", "crank", "sleigh"]
HEAD = """# Errors found in print

Where a source of the [outside problems](problems.md) prints something else than what follows from its own premises: what is printed, what is
right, and one command that shows it, run from the top folder. Written by `tools/errors_page.py`; the tests run each command.
"""


def section(program, name):
    path = os.path.join(FOLDER, name + ".pleuel")
    with open(os.path.join(ROOT, path), encoding="utf-8") as f:
        text = f.read()
    said = dict(re.findall(r"^# (source|printed|right): +(.*)$", text, re.M))
    title = re.search(r'^system "(.*)"', text, re.M).group(1)
    done = subprocess.run([program, "solve", path], cwd=ROOT, capture_output=True, timeout=60)
    if done.returncode != 0:
        raise SystemExit(f"{path}: exit code {done.returncode}")
    return (f"\n## {title}\n\n- source: {said['source']}\n- printed: {said['printed']}\n- right: {said['right']}\n\n"
            f"```text\n$ pleuel solve {path}\n{done.stdout.decode('utf-8').rstrip()}\n```\n")


def main():
    program = os.path.abspath(sys.argv[1])
    if sorted(ORDER) != sorted(f[:-7] for f in os.listdir(os.path.join(ROOT, FOLDER)) if f.endswith(".pleuel")):
        raise SystemExit(f"{FOLDER} and ORDER differ")
    text = HEAD + "".join(section(program, name) for name in ORDER)
    return keep("errors-in-print.md", text)


if __name__ == "__main__":
    sys.exit(main())
