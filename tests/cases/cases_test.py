#!/usr/bin/env python3
"""Published and exact motions: each *.pleuel here carries its source and values in lines

    #= t TIME   NAME VALUE  NAME VALUE ...   TOLERANCE

and `pleuel sim FILE --until TIME` must end there.  The tolerance is relative to the larger of the value and the largest value
of the line.  Usage: cases_test.py PLEUEL [NAME...]
"""
import csv
import io
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
folder = pathlib.Path(__file__).resolve().parent
wanted = sys.argv[2:]


def last_row(path, until):
    run = subprocess.run([program, "sim", str(path), "--until", until, "-o", "-"], capture_output=True, text=True, timeout=100)
    if run.returncode != 0:
        return None, run.stderr
    rows = list(csv.reader(io.StringIO(run.stdout)))
    names = [re.sub(r" \[[^\]]*\]$", "", n) for n in rows[0]]
    return dict(zip(names, rows[-1])), run.stderr


def compare(path, line):
    words = line.split()
    until, tolerance = words[1], float(words[-1])
    pairs = [(words[i], float(words[i + 1])) for i in range(2, len(words) - 1, 2)]
    row, said = last_row(path, until)
    what = f"{path.stem} at t = {until}: {' '.join(n for n, _ in pairs)} to {tolerance:g}"
    if row is None:
        check(what, False, said)
        return
    scale = max(abs(v) for _, v in pairs) or 1
    worst = max((abs(float(row.get(n, "nan")) - v) / scale if n in row else float("inf"), n) for n, v in pairs)
    check(what, worst[0] <= tolerance and float(row["t"]) == float(until),
          f"off by {worst[0]:.2e} at {worst[1]}\n" + "\n".join(f"{n}: want {v!r}, got {row.get(n)}" for n, v in pairs))


for path in sorted(folder.glob("*.pleuel")):
    if wanted and path.stem not in wanted:
        continue
    values = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("#= ")]
    check(f"{path.stem} has values", bool(values))
    for value in values:
        compare(path, value[3:])
done()
