#!/usr/bin/env python3
"""Motions on numbers wider than doubles, against closed forms that are computed here in decimal arithmetic of 60 digits.

Usage: precision_test.py PLEUEL

Numbers of the models are decimals, fractions and multiples of π that no double holds: a run that rounded one of them to a double
would be off by 1e-17.
"""
import csv
import io
import json
import os
import pathlib
import subprocess
import sys
from decimal import Decimal, getcontext

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done, skip  # noqa: E402

program = os.path.abspath(sys.argv[1])
getcontext().prec = 60
D = Decimal
TINY = D(10) ** -58


# ------------------------------------------------------------------------------------------------ functions in decimals
def series(x, first, ratio):
    """Sum of terms, each the one before times ratio(n)."""
    total, term, n = first, first, 1
    while abs(term) > TINY:
        term *= ratio(n)
        total += term
        n += 1
    return total


def cos(x):
    return series(x, D(1), lambda n: -x * x / ((2 * n - 1) * (2 * n)))


def sin(x):
    return series(x, x, lambda n: -x * x / ((2 * n) * (2 * n + 1)))


def cosh(x):
    return series(x, D(1), lambda n: x * x / ((2 * n - 1) * (2 * n)))


def newton(f, slope, x):
    for _ in range(100):
        move = f(x) / slope(x)
        x -= move
        if abs(move) < TINY:
            return x
    raise ArithmeticError("no root")


def asin(x):
    return newton(lambda y: sin(y) - x, cos, x)


PI = newton(sin, cos, D("3.14159265358979323846"))


def quarter(k):
    """K(k) by the arithmetic-geometric mean, and its steps: [Abramowitz and Stegun, 17.6]."""
    a, b, c = D(1), (1 - k * k).sqrt(), k
    steps = []
    while abs(c) > TINY:
        a, b, c = (a + b) / 2, (a * b).sqrt(), (a - b) / 2
        steps.append((a, c))
    return PI / (2 * a), steps


def sn(u, k):
    """[Abramowitz and Stegun, 16.4]"""
    _, steps = quarter(k)
    phi = steps[-1][0] * u * 2 ** len(steps)
    turns = (phi / (2 * PI)).to_integral_value()
    phi -= 2 * PI * turns
    whole = turns        # of 2π that were taken away; halving brings them back
    for a, c in reversed(steps):
        phi = (phi + asin(c / a * sin(phi))) / 2 + PI * whole
        turns = (phi / (2 * PI)).to_integral_value()
        phi -= 2 * PI * turns
        whole = turns
    return sin(phi)


# ------------------------------------------------------------------------------------------------ running
def run(model, *flags):
    return subprocess.run([program, "sim", "-", *flags], input=model, capture_output=True, text=True, timeout=100)


def rows(model, *flags):
    done_run = run(model, "-o", "-", *flags)
    if done_run.returncode != 0:
        check("runs", False, done_run.stderr)
        return [{}]
    return [{name.split(" ")[0]: x for name, x in row.items()} for row in csv.DictReader(io.StringIO(done_run.stdout))]


def last(model, *flags):
    return {name: D(x) for name, x in rows(model, *flags)[-1].items()}


def close(name, row, exact, limit):
    """The largest difference relative to the largest number."""
    size = max(abs(x) for x in exact.values())
    worst = max(abs(row.get(key, D(9)) - x) for key, x in exact.items()) / size
    check(f"{name}: {limit:.0e}", worst <= D(limit), f"off by {worst:.2e}\n{row}\n{exact}")
    return worst


MODES = {"quad": 1e-31, "long": 3e-18}
if run("coord x\nmass 1 at (x)\ninit x = 0, x' = 1\nsimulate 0..1\n", "--precision", "long").returncode != 0:
    skip("motions on wider numbers", "this build has no such numbers")
    done()

# ------------------------------------------------------------------------------------------------ the pendulum
PENDULUM = """param α = π/3, g = 9.81, l = 7/10
coord {coordinates}
axes x right, y up
mass 1 at {point}
gravity g along -y
{rest}
simulate 0..12.3
"""
ANGLE = PENDULUM.format(coordinates="φ", point="(l sin φ, -l cos φ)", rest="init φ = α, φ' = 0")
CARTESIAN = PENDULUM.format(coordinates="x, y", point="(x, y)",
                            rest="constraint rod: x^2 + y^2 = l^2\ninit x = l sin α, y = -l cos α, x' = 0, y' = 0")


def angle_at(t, g=D("9.81"), l=D("0.7")):
    """From rest at 60°: sin(φ/2) = k sn(K - ω t, k), k = sin 30°."""
    k, w = D("0.5"), (g / l).sqrt()
    return 2 * asin(k * sn(quarter(k)[0] - w * t, k))


exact = angle_at(D("12.3"))
place = {"x": D("0.7") * sin(exact), "y": -D("0.7") * cos(exact)}
for mode, limit in MODES.items():
    close(f"pendulum over seven periods, {mode}, its angle", last(ANGLE, "--precision", mode), {"phi": exact}, limit)
    close(f"pendulum over seven periods, {mode}, with its rod as a constraint", last(CARTESIAN, "--precision", mode), place, limit)
in_double = abs(last(ANGLE)["phi"] - exact)
check("the same in double has the digits of a double", D("1e-19") < in_double < D("1e-14"), in_double)

table = rows(CARTESIAN, "--precision", "quad", "--dt", "0.1", "--until", "0.7")
check("times of rows are the decimals asked for", [row["t"] for row in table] == ["0"] + [f"0.{n}" for n in range(1, 8)],
      [row["t"] for row in table])
worst = max(abs(D(row["x"]) - D("0.7") * sin(angle_at(D(row["t"])))) for row in table)
check("rows between the steps have all digits", worst < D("1e-32"), worst)
table = rows(ANGLE, "--precision", "long", "--dt", "100[ms]", "--until", "700[ms]")
check("units of times are exact too", [row["t"] for row in table][-2:] == ["0.6", "0.7"], [row["t"] for row in table])

other = angle_at(D("1.1"), g=D("9.80665"), l=D("0.71"))
close("values that are set are exact", last(ANGLE, "--precision", "quad", "--set", "g=9.80665", "--set", "l=71/100", "--until", "1.1"),
      {"phi": other}, 1e-32)

# ------------------------------------------------------------------------------------------------ events
STOP = ANGLE + "event down: when φ = 0 -> stop\nevent slow: when φ' = -1 -> record\n"
document = json.loads(run(STOP, "--precision", "quad", "--json").stdout, parse_float=D, parse_int=D)
quarter_period = quarter(D("0.5"))[0] / (D("9.81") / D("0.7")).sqrt()
end = last(STOP, "--precision", "quad")
check("an event is located to all digits", abs(end["t"] - quarter_period) < D("1e-33"), (end["t"], quarter_period))
check("its digits stand in the JSON document", document["events"][-1]["t"] == end["t"], document["events"])
slow = next(e for e in document["events"] if e["label"] == "slow")
check("so does one that only records", abs(slow["state"]["phi_dot"] + 1) < D("1e-32"), slow)
check("the document names the precision", document["precision"] == "quad" and document["residual_g"] == 0, document)

# ------------------------------------------------------------------------------------------------ other motions
KEPLER = """coord x, y
mass 1 at (x, y)
potential -1/sqrt(x^2 + y^2)
init x = 7/10, y = 0, x' = 0, y' = sqrt(13/7)
simulate 0..17
"""
# perihelion 0.7 at eccentricity 0.3 and semi-axis 1: Kepler's equation
E = newton(lambda e: e - D("0.3") * sin(e) - (D(17) - 4 * PI), lambda e: 1 - D("0.3") * cos(e), D(17) - 4 * PI)
orbit = {"x": cos(E) - D("0.3"), "y": (1 - D("0.09")).sqrt() * sin(E)}
for mode, limit in MODES.items():
    close(f"Kepler's ellipse, {mode}", last(KEPLER, "--precision", mode), orbit, 10 * limit)

BEAD = """param w = 13/10
coord x, y
mass 1 at (x, y)
constraint rod: y cos(w t) = x sin(w t)
init x = 1/3, y = 0, x' = 0
simulate 0..1.9
"""
turned, out = D("1.3") * D("1.9"), cosh(D("1.3") * D("1.9")) / 3
bead = {"x": out * cos(turned), "y": out * sin(turned)}
for mode, limit in MODES.items():
    close(f"bead on a rod that turns, with a velocity that its constraint gives, {mode}", last(BEAD, "--precision", mode), bead, limit)

HALF = CARTESIAN.replace("init x = l sin α, y = -l cos α, x' = 0, y' = 0", "guess y = -1\ninit x = 3/10, x' = 0, y' = 0")
start = D(rows(HALF, "--precision", "quad")[0]["y"])
check("a start value that constraints determine has all digits", abs(start + (D("0.49") - D("0.09")).sqrt()) < D("2e-34"), start)

# Two rods of length 1 from rest at 1 rad and 2 rad.  Digits: extrapolation
# of midpoint steps (Gragg) in arithmetic of 55 digits on the equations for angles, the same with 80 and with 100 steps.
DOUBLE = """param g = 9.81
coord x1, y1, x2, y2
axes x right, y up
mass 1 at (x1, y1)
mass 1 at (x2, y2)
gravity g along -y
constraint one: x1^2 + y1^2 = 1
constraint two: (x2 - x1)^2 + (y2 - y1)^2 = 1
init x1 = sin 1, y1 = -cos 1, x2 = sin 1 + sin 2, y2 = -cos 1 - cos 2, x1' = 0, y1' = 0, x2' = 0, y2' = 0
output a = atan2(x1, -y1)
output b = atan2(x2 - x1, y1 - y2)
simulate 0..2
"""
angles = {"a": D("-0.114959670952308179213942492002668702442137"), "b": D("-1.01229602706868539053894532848327905166513")}
for mode, limit in MODES.items():
    close(f"double pendulum, {mode}", last(DOUBLE, "--precision", mode), angles, limit)

# ------------------------------------------------------------------------------------------------ what cannot be had
BLOCK = """param g = 9.81
coord x, y
axes x right, y up
mass 1 at (x, y)
gravity g along -y
{law}
init x = 0, y = 0, x' = 1, y' = 0
simulate 0..1
"""
REFUSED = {
    "contacts": (BLOCK.format(law="constraint floor: y >= 0"), "floor"),
    "friction": (BLOCK.format(law="constraint floor: y = 0\nfriction 0.3 on floor"), "floor"),
    "kinks": (BLOCK.format(law="potential abs(x)"), "kink"),
    "deeds": (BLOCK.format(law="event there: when x = 0.1 -> x' = 2"), "there"),
}
for what, (model, word) in REFUSED.items():
    answer = run(model, "--precision", "quad")
    check(f"{what}: refused with the name of what stands in the way", answer.returncode != 0 and "precision quad" in answer.stdout + answer.stderr
          and word in answer.stdout + answer.stderr, answer.stdout + answer.stderr)
answer = run(ANGLE, "--precision", "long", "--method", "radau")
check("the implicit method is refused", answer.returncode != 0 and "implicit" in answer.stdout + answer.stderr, answer.stdout + answer.stderr)
answer = run(ANGLE, "--precision", "half")
check("a precision that there is not", answer.returncode != 0 and "double, long or quad" in answer.stdout + answer.stderr, answer.stderr)
done()
