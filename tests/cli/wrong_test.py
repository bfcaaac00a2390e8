#!/usr/bin/env python3
"""Every wrong model in tests/wrong says what it should: `pleuel check --terse FILE` against FILE.expected.

Usage: wrong_test.py PLEUEL [--accept]      --accept rewrites the expectations; read the diff before committing it.
An expectation holds the lines without the file name: line:col: CODE: sentence.
"""
import os
import pathlib
import subprocess
import sys

from tap import check, done

program = os.path.abspath(sys.argv[1])
folder = pathlib.Path(__file__).resolve().parent.parent / "wrong"
accept = "--accept" in sys.argv


def said(path):
    run = subprocess.run([program, "check", "--terse", "--lang", "en", path.name], cwd=folder, capture_output=True, timeout=20)
    text = run.stdout.decode("utf-8", "replace").replace(path.name + ":", "", -1)
    return "".join(line.replace(path.name + ":", "") + "\n" for line in text.splitlines()), run


models = sorted(folder.glob("*.pleuel"))
for path in models:
    text, run = said(path)
    expectation = path.with_suffix(".expected")
    if accept:
        expectation.write_text(text, encoding="utf-8")
        continue
    code = path.name.split("-")[0]
    if not expectation.exists():
        check(f"{path.name}: has an expectation", False, text)
        continue
    want = expectation.read_text(encoding="utf-8").replace(path.name + ":", "")
    check(f"{path.name}: says what it should", text == want, f"expected:\n{want}got:\n{text}{run.stderr.decode()}")
    check(f"{path.name}: its code is among the messages", f" {code}:" in " " + text, text)
    is_error = code.startswith("E")
    check(f"{path.name}: exit code", (run.returncode in (3, 4)) if is_error else run.returncode in (0, 3, 6), run.returncode)
if accept:
    sys.exit(0)
check("there are wrong models", len(models) >= 45, f"{len(models)} found")
done()
