#!/usr/bin/env python3
"""Sums whose length hangs on the index of a family: the same motion as without the family.  Usage: families_test.py PLEUEL"""
import csv
import io
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])


def last_row(text):
    run = subprocess.run([program, "sim", "-", "-o", "-", "--until", "0.5"], input=text, capture_output=True, text=True, timeout=60)
    rows = [r for r in csv.reader(io.StringIO(run.stdout)) if r and not r[0].startswith("#")]
    return ([float(x) for x in rows[-1]] if len(rows) > 1 else []), run.stderr


def same(name, family, plain, columns=None):
    (a, said_a), (b, said_b) = last_row(family), last_row(plain)
    n = columns or len(b)
    near = len(a) >= n and len(b) >= n and all(abs(x - y) < 1e-9 * (1 + abs(y)) for x, y in zip(a[:n], b[:n]))
    check(name, near, f"{said_a}{said_b}{a}\n{b}")


HEAD = "param m = 1, l = 0.5, g = 9.81\n"
FAMILY = HEAD + """param N = 3
coord u[1..N]
axes x right, y up
for i in 1..N {
    mass P[i]: m at (sum(j in 1..i, l sin u[j]), -sum(j in 1..i, l cos u[j]))
    init u[i] = 0.3 i, u[i]' = 0
}
gravity g along -y
"""
PLAIN = HEAD + """coord a, b, c
axes x right, y up
mass P: m at (l sin a, -l cos a)
mass Q: m at (l sin a + l sin b, -l cos a - l cos b)
mass R: m at (l sin a + l sin b + l sin c, -l cos a - l cos b - l cos c)
init a = 0.3, b = 0.6, c = 0.9, a' = 0, b' = 0, c' = 0
gravity g along -y
"""
same("masses at sums over the links before them", FAMILY, PLAIN)
same("constraints on sums, their multipliers and columns",
     FAMILY.replace("    init u[i] = 0.3 i,", "    constraint c[i]: sum(j in 1..i, u[j]) = i/5 + t^2/10\n    init") +
     "output q = λ_c[3] - λ_c[1]\n",
     PLAIN.replace("init a = 0.3, b = 0.6, c = 0.9, ", "constraint c1: a = 1/5 + t^2/10\nconstraint c2: a + b = 2/5 + t^2/10\n"
                   "constraint c3: a + b + c = 3/5 + t^2/10\ninit ") + "output q = λ_c3 - λ_c1\n")

STARS = """param k = 0.3, N = 4
coord x[1..N], y[1..N]
axes x right, y up
for i in 1..N {
    mass P[i]: i at (x[i], y[i])
    init x[i] = cos(2 i), y[i] = sin(2 i) + 0.1 i, x[i]' = 0, y[i]' = 0
}
"""
same("potentials of all pairs", STARS + """for i in 2..N {
    potential -k/2 sum(j in 1..i-1, ln((x[i] - x[j])^2 + (y[i] - y[j])^2))
}
""", STARS + """for i in 2..N {
    for j in 1..i-1 {
        potential -k/2 ln((x[i] - x[j])^2 + (y[i] - y[j])^2)
    }
}
""")
done()
