#!/usr/bin/env python3
"""Systems that are too long to be written out: what is shown over names, solved again by hand at a state on the constraints.

The reference is Newton's law with the constraint forces as unknowns, by Gauss elimination in doubles.  Usage:
structured_test.py PROGRAM
"""
import math
import re
import os
import subprocess
import sys
import tempfile

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "founding"))
sys.path.insert(0, os.path.join(here, "..", "..", "bench"))
from formulas import Formula  # noqa: E402
from sheet import Tests, need, program_of, run  # noqa: E402
from systems import SYSTEMS  # noqa: E402

test = Tests()
MODELS = os.path.join(here, "..", "..", "bench", "models")


def chain(n):
    """n rods and masses that hang from each other: the model, and a state on the constraints."""
    names = range(1, n + 1)
    rods = "".join(f"constraint c{i}: (x{i} - x{i - 1})^2 + (y{i} - y{i - 1})^2 = l{i}^2\n" for i in names[1:])
    text = (f"param {', '.join(f'm{i} = {i} [kg], l{i} = 1.{i} [m]' for i in names)}, g = 9.81 [m/s^2]\n"
            f"coord {', '.join(f'x{i}, y{i}' for i in names)}\naxes x right, y up\n"
            + "".join(f"mass m{i} at (x{i}, y{i})\n" for i in names)
            + "gravity g along -y\nconstraint c1: x1^2 + y1^2 = l1^2\n" + rods
            + "ask " + ", ".join(f"solve λ_c{i}" for i in names) + ", solve x1''\n")
    at, x, y, u, v = {"g": 9.81}, 0.0, 0.0, 0.0, 0.0
    for i in names:
        a, w, l = 0.3 + 0.37 * i, 1.1 - 0.4 * i, 1.0 + i / (10 if i < 10 else 100)
        x, y, u, v = x + l * math.sin(a), y - l * math.cos(a), u + l * math.cos(a) * w, v + l * math.sin(a) * w
        at |= {f"m{i}": float(i), f"l{i}": l, f"x{i}": x, f"y{i}": y, f"x{i}_dot": u, f"y{i}_dot": v}
    return text, at


def gauss(A, b):
    n = len(b)
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(A[i][k]))
        A[k], A[p], b[k], b[p] = A[p], A[k], b[p], b[k]
        for i in range(k + 1, n):
            f = A[i][k] / A[k][k]
            A[i] = [x - f * y for x, y in zip(A[i], A[k])]
            b[i] -= f * b[k]
    x = [0.0] * n
    for k in reversed(range(n)):
        x[k] = (b[k] - sum(A[k][j] * x[j] for j in range(k + 1, n))) / A[k][k]
    return x


def tensions(n, at):
    """Multipliers of the chain: d_k . (a_k - a_(k-1)) = -|d_k'|^2 with m_k a_k = -m_k g + 2 λ_k d_k - 2 λ_(k+1) d_(k+1)."""
    get = lambda name, i: at[f"{name}{i}"] if i else 0.0
    d = [[at[f"{c}{i}"] - (at[f"{c}{i - 1}"] if i > 1 else 0.0) for c in "xy"] for i in range(1, n + 1)]
    w = [[at[f"{c}{i}_dot"] - (at[f"{c}{i - 1}_dot"] if i > 1 else 0.0) for c in "xy"] for i in range(1, n + 1)]
    dot = lambda p, q: p[0] * q[0] + p[1] * q[1]
    A, b = [[0.0] * n for _ in range(n)], []
    for k in range(n):
        m, before = get("m", k + 1), get("m", k)
        A[k][k] = 2 * dot(d[k], d[k]) * (1 / m + (1 / before if k else 0.0))
        if k + 1 < n:
            A[k][k + 1] = -2 * dot(d[k], d[k + 1]) / m
        if k:
            A[k][k - 1] = -2 * dot(d[k], d[k - 1]) / before
        b.append(-dot(w[k], w[k]) + (0.0 if k else at["g"] * d[0][1]))
    return gauss(A, b)


def value_of(entry, at):
    at = dict(at)
    for name, expr in entry.get("where", {}).items():   # in order of use
        at[name] = Formula(expr).value(at)
    return Formula(entry["expr"]).value(at)


def solve(program, text):
    with tempfile.NamedTemporaryFile("w", suffix=".pleuel", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        return run(program, file.name, "--no-simulation")


def passed(answer):
    need(answer.exit_code == 0, f"exit {answer.exit_code}")
    need(all(c["passed"] for c in answer.document["checks"]), "a check failed")


for n in (4, 10):

    @test(f"{n} rods in Cartesian coordinates: multipliers over names, as by hand")
    def _(program, n=n):
        text, at = chain(n)
        answer = solve(program, text)
        passed(answer)
        for k, expected in enumerate(tensions(n, at)):
            entry = answer.values(f"lambda_c{k + 1}")[0]
            need(entry["where"] and abs(value_of(entry, at) - expected) < 1e-9 * max(1, abs(expected)), f"lambda_c{k + 1}")


FAMILY = """param N = 30, m = 1 [kg], d = 1 [m], g = 9.81 [m/s^2]
coord x[1..N] [m], y[1..N] [m]
axes x right, y up
for i in 1..N {
  mass P[i]: m at (x[i], y[i])
}
constraint c[1]: x[1]^2 + y[1]^2 = d^2
for i in 2..N {
  constraint c[i]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 = d^2
}
gravity g along -y
ask solve λ_c[1]
"""


@test("a multiplier of one member of a family of 30 rods, as by hand")
def _(program):
    answer = solve(program, FAMILY)
    passed(answer)
    _, at = chain(30)
    x = y = u = v = 0.0
    for i in range(1, 31):       # the state of the chain, with equal masses and rods
        a, w = 0.3 + 0.37 * i, 1.1 - 0.4 * i
        x, y, u, v = x + math.sin(a), y - math.cos(a), u + math.cos(a) * w, v + math.sin(a) * w
        at |= {f"m{i}": 1.0, f"l{i}": 1.0, f"x{i}": x, f"y{i}": y, f"x{i}_dot": u, f"y{i}_dot": v}
    entry = answer.values("lambda_c_1")[0]
    full = at | {"m": 1.0, "d": 1.0} | {re.sub(r"^([xy])(\d+)", r"\1_\2", k): v for k, v in at.items()}
    expected = tensions(30, at)[0]
    need(abs(value_of(entry, full) - expected) < 1e-9 * max(1, abs(expected)), f"{value_of(entry, full)} against {expected}")


@test("a large family of polar coordinates: each element is one quantity, contacts stay one-sided")
def _(program):
    text = """param N = 50, m = 75 [kg], R = 20 [m], g = 9.81 [m/s^2]
coord r[1..N], u[1..N]
axes x right, z up
for i in 1..N {
    mass S[i]: m at (r[i] sin u[i], r[i] cos u[i])
    constraint h[i]: r[i] >= R
}
gravity g along -z
ask dof, lagrange1
"""
    with tempfile.NamedTemporaryFile("w", suffix=".pleuel", encoding="utf-8") as f:
        f.write(text)
        f.flush()
        shown = subprocess.run([program, "solve", f.name], capture_output=True, text=True, timeout=60).stdout
    for line in ("h[i] = r[i] - R ≥ 0", "m r[i]'' = m r[i] u[i]'² - m g cos u[i] + λ_h[i]",
                 "m r[i]² u[i]'' = -2 m r[i] u[i]' r[i]' + m g r[i] sin u[i]", "counted as closed"):
        need(line in shown, f"{line} is not in\n{shown}")


@test("the names of the model are not taken: A_1 is a length of the model")
def _(program):
    text, at = chain(4)
    answer = solve(program, text.replace("l1", "A_1"))
    passed(answer)
    need("A_2" not in answer.values("lambda_c1")[0]["where"], "the letter A was taken")


for model in SYSTEMS:

    @test(f"{model}: solved, each displayed formula at 50 points in balls and 20 modulo p")
    def _(program, model=model):
        answer = run(program, os.path.join(MODELS, model + ".pleuel"), "--no-simulation")
        passed(answer)
        need(any(v.get("expr") for i in answer.items() for v in i["values"]), "no formula")


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
