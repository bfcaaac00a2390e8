#!/usr/bin/env python3
"""Published and exact motions: each *.pleuel here carries its source and values in lines

    #= t TIME   NAME VALUE  NAME VALUE ...   TOLERANCE     the end of `pleuel sim FILE --until TIME`
    #= t TIME with NAME=NUMBER   NAME VALUE ...   TOLERANCE      the same with `--set NAME=NUMBER`
    #@ LABEL   TIME TIME ...   TOLERANCE                   when the first events of this label happen
    #@ LABEL until TIME   COUNT                            how many of them there are

at the default tolerance of the program.  TOLERANCE is relative to the largest value of the line; that of events is relative
to the time, or absolute below 1.  Every run has to keep its constraints to 1e-15 of their terms.
Usage: cases_test.py PLEUEL [NAME...]
"""
import csv
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
folder = pathlib.Path(__file__).resolve().parent
wanted = sys.argv[2:]
scratch = tempfile.TemporaryDirectory()
RESIDUAL = 1e-15


def without_unit(name):
    return re.sub(r" \[[^\]]*\]$", "", name)


@functools.lru_cache(maxsize=None)
def simulate(path, until, number=None):
    """Last row, the JSON document, what was said; and the line that tells whether the constraints were kept."""
    table = pathlib.Path(scratch.name, "rows.csv")
    command = [program, "sim", str(path), "-f", "-o", str(table), "--json"] + (["--until", until] if until else [])
    command += ["--set", number] if number else []
    run = subprocess.run(command, capture_output=True, text=True, timeout=100)
    if run.returncode != 0:
        check(f"{path.stem} until {until} runs", False, run.stdout[-2000:] + run.stderr)
        return None, None
    with open(table, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    document = json.loads(run.stdout)
    check(f"{path.stem}{f', {number}' if number else ''}, until {document['t_end']:g}: constraints kept to {RESIDUAL:g}",
          document["residual_g"] <= RESIDUAL, f"|g| is {document['residual_g']:g} of its terms")
    return dict(zip(map(without_unit, rows[0]), rows[-1])), document


def end_of_run(path, words):
    number = words[3] if words[2] == "with" else None
    words = words[:2] + words[4:] if number else words
    until, tolerance = words[1], float(words[-1])
    pairs = [(words[i], float(words[i + 1])) for i in range(2, len(words) - 1, 2)]
    row, _ = simulate(path, until, number)
    if row is None:
        return
    scale = max(abs(v) for _, v in pairs) or 1
    worst = max((abs(float(row.get(n, "nan")) - v) / scale if n in row else float("inf"), n) for n, v in pairs)
    check(f"{path.stem} at t = {until}{f' with {number}' if number else ''}: {' '.join(n for n, _ in pairs)} to {tolerance:g}",
          worst[0] <= tolerance and float(row["t"]) == float(until),
          f"off by {worst[0]:.2e} at {worst[1]}\n" + "\n".join(f"{n}: want {v!r}, got {row.get(n)}" for n, v in pairs))


def events(path, words):
    until = words[2] if words[1] == "until" else None
    _, document = simulate(path, until)
    if document is None:
        return
    times = [e["t"] for e in document["events"] if e["label"] == words[0]]
    if until:
        check(f"{path.stem}: {words[3]} events {words[0]} until {until}", len(times) == int(words[3]), f"{len(times)} events")
        return
    want, tolerance = [float(w) for w in words[1:-1]], float(words[-1])
    off = max(abs(a - b) / max(b, 1) for a, b in zip(times, want)) if len(times) >= len(want) else float("inf")
    check(f"{path.stem}: first {len(want)} events {words[0]} to {tolerance:g}", off <= tolerance,
          f"off by {off:.2e}\nwant {want}\ngot {times[:len(want)]}")


for path in sorted(folder.glob("*.pleuel")):
    if wanted and path.stem not in wanted:
        continue
    lines = path.read_text(encoding="utf-8").splitlines()
    check(f"{path.stem} has values", any(line[:3] in ("#= ", "#@ ") for line in lines))
    for line in lines:
        if line.startswith("#= "):
            end_of_run(path, line[3:].split())
        elif line.startswith("#@ "):
            events(path, line[3:].split())
done()
