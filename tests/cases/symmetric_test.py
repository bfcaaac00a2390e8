#!/usr/bin/env python3
"""The same pendulum of N rods written in several ways: angles, Cartesian coordinates, families; from starts with a symmetry.

Usage: symmetric_test.py PLEUEL

From rest, horizontal, stretched or folded, most coefficients of the series are zero or rounding: a step that is chosen from a few of them is
wrong.  The reference is an extrapolation method of its own, in this file.  Motions are chaotic: how much a small change of the start
grows is measured with the reference, and that many times the tolerance is allowed.
"""
import math
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
G = 9.81


# ---- the reference: Gragg's midpoint rule, extrapolated (Bulirsch and Stoer), on the equations in angles
def accelerations(a, w):
    n = len(a)
    rows = []
    for i in range(n):
        row, right = [], -(n - i) * G * math.sin(a[i])
        for j in range(n):
            mass = n - max(i, j)
            row.append(mass * math.cos(a[i] - a[j]))
            right -= mass * math.sin(a[i] - a[j]) * w[j] ** 2
        rows.append(row + [right])
    for i in range(n):
        for j in range(i + 1, n):
            f = rows[j][i] / rows[i][i]
            for k in range(i, n + 1):
                rows[j][k] -= f * rows[i][k]
    for i in reversed(range(n)):
        rows[i][n] = (rows[i][n] - sum(rows[i][j] * rows[j][n] for j in range(i + 1, n))) / rows[i][i]
    return [row[n] for row in rows]


def slope(y):
    n = len(y) // 2
    return y[n:] + accelerations(y[:n], y[n:])


def midpoint(y, H, n):
    h, f = H / n, slope(y)
    before, now = y, [u + h * s for u, s in zip(y, f)]
    for _ in range(n - 1):
        before, now = now, [u + 2 * h * s for u, s in zip(before, slope(now))]
    return [(u + v + h * s) / 2 for u, v, s in zip(before, now, slope(now))]


def reference(angles, until, steps):
    y, H = list(angles) + [0.0] * len(angles), until / steps
    for _ in range(steps):
        table = []
        for j in range(7):
            table.append(midpoint(y, H, 2 * (j + 1)))
            for k in range(j - 1, -1, -1):
                ratio = ((j + 1) / (k + 1)) ** 2 - 1
                table[k] = [u + (u - v) / ratio for u, v in zip(table[k + 1], table[k])]
        y = table[0]
    return y


def tip(y):
    n = len(y) // 2
    return sum(math.sin(a) for a in y[:n]), -sum(math.cos(a) for a in y[:n])


# ---- the models
def in_angles(angles):
    n = len(angles)
    points = [(" + ".join(f"sin a{j + 1}" for j in range(i + 1)), "".join(f" - cos a{j + 1}" for j in range(i + 1))) for i in range(n)]
    lines = [f"coord {', '.join(f'a{i + 1}' for i in range(n))}", "axes x right, y up", f"gravity {G} along -y"]
    lines += [f"mass P{i + 1}: 1 at ({x}, {y})" for i, (x, y) in enumerate(points)]
    lines += [f"init a{i + 1} = {a!r}, a{i + 1}' = 0" for i, a in enumerate(angles)]
    return lines + [f"output X = x(P{n})", f"output Y = y(P{n})"]


def as_family(angles):
    lines = [f"param N = {len(angles)}", "coord a[1..N]", "axes x right, y up", f"gravity {G} along -y"]
    lines += ["for i in 1..N {", "  mass P[i]: 1 at (sum(j in 1..i, sin(a[j])), -sum(j in 1..i, cos(a[j])))", "}"]
    lines += [f"init a[{i + 1}] = {a!r}, a[{i + 1}]' = 0" for i, a in enumerate(angles)]
    return lines + ["output X = x(P[N])", "output Y = y(P[N])"]


def places(angles):
    x = y = 0.0
    for a in angles:
        x, y = x + math.sin(a), y - math.cos(a)
        yield x, y


def cartesian(angles):
    n = len(angles)
    lines = [f"coord {', '.join(f'x{i + 1}, y{i + 1}' for i in range(n))}", "axes x right, y up", f"gravity {G} along -y"]
    for i, (x, y) in enumerate(places(angles)):
        lines += [f"mass 1 at (x{i + 1}, y{i + 1})", f"init x{i + 1}' = 0, y{i + 1}' = 0", f"guess x{i + 1} = {x!r}, y{i + 1} = {y!r}"]
        lines += [f"init x{i + 1} = {x!r}, y{i + 1} = {y!r}"]
        before = (f"x{i}", f"y{i}") if i else ("0", "0")
        lines += [f"constraint c{i + 1}: (x{i + 1} - {before[0]})^2 + (y{i + 1} - {before[1]})^2 = 1"]
    return [line for line in lines if not line.startswith("guess")] + [f"output X = x{n}", f"output Y = y{n}"]


def cartesian_family(angles):
    lines = [f"param N = {len(angles)}", "coord x[1..N], y[1..N]", "axes x right, y up", f"gravity {G} along -y"]
    lines += ["for i in 1..N {", "  mass P[i]: 1 at (x[i], y[i])", "}", "constraint c[1]: x[1]^2 + y[1]^2 = 1"]
    lines += ["for i in 2..N {", "  constraint c[i]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 = 1", "}"]
    for i, (x, y) in enumerate(places(angles)):
        lines += [f"init x[{i + 1}] = {x!r}, y[{i + 1}] = {y!r}, x[{i + 1}]' = 0, y[{i + 1}]' = 0"]
    return lines + ["output X = x[N]", "output Y = y[N]"]


def run(lines, until, *flags):
    text = "\n".join(lines + [f"simulate 0..{until}", ""])
    done_run = subprocess.run([program, "sim", "-", "-o", "-", *flags], input=text, capture_output=True, text=True, timeout=120)
    rows = [line for line in done_run.stdout.splitlines() if line]
    if done_run.returncode or len(rows) < 2:
        return None, done_run.stderr
    row = dict(zip(rows[0].split(","), rows[-1].split(",")))
    return (float(row["X"]), float(row["Y"])), done_run.stderr


def degrees(*angles):
    """With the sines and cosines of multiples of 90° as exact as a double allows, so that symmetries are."""
    return [math.radians(a) for a in angles]


STARTS = {
    "both rods horizontal": degrees(90, 90),
    "rods folded along the horizontal": degrees(90, -90),
    "one up, one horizontal": degrees(180, 90),
    "one horizontal, one hanging": degrees(90, 0),
    "symmetric about the vertical": degrees(60, -60),
    "three rods horizontal": degrees(90, 90, 90),
    "three rods folded": degrees(90, -90, 90),
    "three rods in line, slanted": degrees(120, 120, 120),
}
WAYS = {"angles": in_angles, "a family of angles": as_family, "Cartesian": cartesian, "a Cartesian family": cartesian_family}
SETTINGS = [(["--tol", "1e-9"], 1e-9), (["--tol", "1e-12"], 1e-12), ([], 1e-15), (["--dt", "0.5"], 1e-15)]

for name, angles in STARTS.items():
    until = 10 if len(angles) == 2 else 4
    end = tip(reference(angles, until, 60 * until))
    shift = 1e-7
    moved = tip(reference([angles[0] + shift] + angles[1:], until, 60 * until))
    growth = 1 + max(abs(u - v) for u, v in zip(end, moved)) / shift
    for way, write in WAYS.items():
        off, told = 0.0, ""
        for flags, tol in SETTINGS:
            got, message = run(write(angles), until, *flags)
            error = max(abs(u - v) for u, v in zip(got, end)) if got else math.inf
            part = error / (growth * (100 * tol + 3e-12))
            if part > off:
                off, told = part, f"{' '.join(flags)}: off by {error:.2g}, a change grows {growth:.2g} times\n{message}"
        check(f"{name}, {way}: as the reference at every tolerance", off <= 1, told)

# ---- a wide gap: x'' = -x^(n-1) from the middle has coefficients 1, n + 1, 2 n + 1, ... only; half a period is known
for n in (4, 8, 14, 24, 30):
    half = 2 * (n / 2) ** (1 / n) * math.sqrt(math.pi) * math.gamma(1 + 1 / n) / math.gamma(0.5 + 1 / n)
    model = ["coord x", "axes x right", "mass 1 at (x)", f"potential x^{n}/{n}", "init x = 0, x' = 1", "output X = x", "output Y = x'"]
    for flags, tol in SETTINGS:
        got, message = run(model, repr(half), *flags)
        off = max(abs(got[0]), abs(got[1] + 1)) if got else math.inf
        check(f"x^{n}, {' '.join(flags) or 'machine precision'}: back in the middle after half a period", off < 100 * tol + 1e-13, f"{off}\n{message}")

done()
