#!/usr/bin/env python3
"""The implicit method on the published and exact motions of this folder, stiff or not: `--method radau --tol 1e-11` must come to
the values in the lines `#= t TIME NAME VALUE ... TOLERANCE` within 1e-9, and keep the constraints to rounding.
Usage: implicit_test.py PLEUEL
"""
import csv
import io
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
folder = pathlib.Path(__file__).resolve().parent
until_of = {"andrews": 0.03, "caraxis": 3, "chain2": 5, "cycloid": 1, "disc": 30, "fekete": 5, "hoop": 10, "knife-edge": 10,
            "pleiades": 3, "sleigh": 8, "turntable": 20, "twin": 4}


def run(path, until, *flags):
    return subprocess.run([program, "sim", str(path), "--until", until, "--method", "radau", "--tol", "1e-11", *flags],
                          capture_output=True, text=True, timeout=100)


for name, most in until_of.items():
    path = folder / f"{name}.pleuel"
    values = [line[3:].split() for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("#= t")]
    until = max((w[1] for w in values if 0 < float(w[1]) <= most), key=float)
    said = run(path, until, "--json")
    report = json.loads(said.stdout) if said.returncode == 0 else {}
    check(f"{name}: every step is implicit and on the constraints",
          report.get("method") == "radau" and report["residual_g"] < 1e-14 and report["residual_gdot"] < 1e-13, said.stdout[:400])
    rows = list(csv.reader(io.StringIO(run(path, until, "--dt", until, "-o", "-").stdout)))
    names = [re.sub(r" \[[^\]]*\]$", "", n) for n in rows[0]] if rows else []
    row = dict(zip(names, rows[-1])) if rows else {}
    for words in values:
        if words[1] != until:
            continue
        pairs = [(words[i], float(words[i + 1])) for i in range(2, len(words) - 1, 2)]
        scale = max(abs(v) for _, v in pairs) or 1
        off = max((abs(float(row.get(n, "nan")) - v) / scale if n in row else float("inf"), n) for n, v in pairs)
        check(f"{name} at t = {until}: {' '.join(n for n, _ in pairs[:4])}", off[0] <= 1e-9, f"off by {off[0]:.1e} at {off[1]}")
done()
