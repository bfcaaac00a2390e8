#!/usr/bin/env python3
"""Numbers for which a general formula has no value: resonance, critical damping, poles that coincide, masses whose matrix is singular.
The closed motion is evaluated at the numbers and held against a motion computed here from equations written by hand.

    numbers_test.py PROGRAM
"""

import json
import math
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
sys.path.insert(0, HERE)
import tap  # noqa: E402
from conserved_test import run  # noqa: E402

ONE = "coord x\naxes x right\nmass A: m at (x)\n"
TWO = "coord x, y\nkinetic 1/2 m (x'^2 + y'^2)\n"
# name, numbers, model, accelerations by hand, start; special: the answer says so
MOTIONS = [
    ("critical damping", {"m": "1", "k": "4", "b": "4"}, ONE + "potential 1/2 k x^2\ndrag b on A\n",
     lambda p, t, q, v: [-(p["b"] * v[0] + p["k"] * q[0]) / p["m"]], True),
    ("critical damping in decimals", {"m": "0.1", "k": "0.4", "b": "0.4"}, ONE + "potential 1/2 k x^2\ndrag b on A\n",
     lambda p, t, q, v: [-(p["b"] * v[0] + p["k"] * q[0]) / p["m"]], True),
    ("critical damping given by a formula", {"m": "3", "k": "5", "b": "2 sqrt(m k)"}, ONE + "potential 1/2 k x^2\ndrag b on A\n",
     lambda p, t, q, v: [-(p["b"] * v[0] + p["k"] * q[0]) / p["m"]], True),
    ("nearly critical damping", {"m": "1", "k": "4", "b": "4.001"}, ONE + "potential 1/2 k x^2\ndrag b on A\n",
     lambda p, t, q, v: [-(p["b"] * v[0] + p["k"] * q[0]) / p["m"]], False),
    ("resonance", {"m": "1", "k": "4", "F": "1", "w": "2"}, ONE + "potential 1/2 k x^2\nforce (F cos(w t)) on A\n",
     lambda p, t, q, v: [(p["F"] * math.cos(p["w"] * t) - p["k"] * q[0]) / p["m"]], True),
    ("resonance given by a formula", {"m": "3", "k": "5", "F": "1", "w": "sqrt(k/m)"}, ONE + "potential 1/2 k x^2\nforce (F sin(w t)) on A\n",
     lambda p, t, q, v: [(p["F"] * math.sin(p["w"] * t) - p["k"] * q[0]) / p["m"]], True),
    ("off resonance", {"m": "1", "k": "4", "F": "1", "w": "3"}, ONE + "potential 1/2 k x^2\nforce (F cos(w t)) on A\n",
     lambda p, t, q, v: [(p["F"] * math.cos(p["w"] * t) - p["k"] * q[0]) / p["m"]], False),
    ("a push that fades as fast as the motion", {"m": "2", "b": "1", "F": "3", "a": "0.5"}, ONE + "drag b on A\nforce (F exp(-a t)) on A\n",
     lambda p, t, q, v: [(p["F"] * math.exp(-p["a"] * t) - p["b"] * v[0]) / p["m"]], True),
    ("two springs without coupling", {"m": "1", "k1": "4", "k2": "3", "c": "0"}, TWO + "potential 1/2 k1 x^2 + 1/2 k2 y^2 + c x y\n",
     lambda p, t, q, v: [-p["k1"] * q[0] / p["m"], -p["k2"] * q[1] / p["m"]], False),
    ("two equal springs without coupling", {"m": "1", "k1": "4", "k2": "4", "c": "0"}, TWO + "potential 1/2 k1 x^2 + 1/2 k2 y^2 + c x y\n",
     lambda p, t, q, v: [-p["k1"] * q[0] / p["m"], -p["k2"] * q[1] / p["m"]], True),
    ("two equal springs with coupling", {"m": "1", "k1": "4", "k2": "4", "c": "1"}, TWO + "potential 1/2 k1 x^2 + 1/2 k2 y^2 + c x y\n",
     lambda p, t, q, v: [-(p["k1"] * q[0] + p["c"] * q[1]) / p["m"], -(p["k2"] * q[1] + p["c"] * q[0]) / p["m"]], None),
    ("resonance of the second mode", {"m": "1", "k": "2", "c": "1", "w": "sqrt(3)"},
     TWO + "potential 1/2 k (x^2 + y^2) + c x y - x cos(w t)\n",
     lambda p, t, q, v: [(math.cos(p["w"] * t) - p["k"] * q[0] - p["c"] * q[1]) / p["m"], -(p["k"] * q[1] + p["c"] * q[0]) / p["m"]], True),
]


def solve(program, text):
    got = subprocess.run([program, "solve", "--json", "--no-simulation", "-"], input=text, capture_output=True, text=True, timeout=120)
    document = json.loads(got.stdout)
    return [a for letter in document["answers"].values() for a in letter], got


def names_of(values):
    names = {k: getattr(math, k) for k in ("sin", "cos", "sqrt", "exp", "sinh", "cosh")} | {"abs": abs}
    for k, v in values.items():
        names[k] = eval(re.sub(r"(\d) (?=[a-z])", r"\1*", v).replace("m k", "m*k"), {}, names)
    return names


def words(answer):
    return " ".join(s.get("text", "") for s in answer["steps"])


def check_motion(program, name, values, model, f, special):
    head = "".join(f"param {k} = {v}\n" for k, v in values.items())
    answers, got = solve(program, head + model + "ask solve x(t)\n")
    shown = [v for v in answers[0]["values"] if v["name"] == "x"]
    if not tap.check(f"{name}: there is a closed motion", len(shown) == 1 and got.returncode == 0, words(answers[0]) + got.stderr):
        return
    if special is not None:
        tap.check(f"{name}: it is {'' if special else 'not '}told as a special case", ("special case" in words(answers[0])) == special, words(answers[0]))
    given = names_of(values)
    n = model.count(",", 0, model.index("\n")) + 1
    start, speed = [0.7, -0.4][:n], [0.3, 0.9][:n]
    rows = run(lambda t, q, v: f(given, t, q, v), start, speed)
    names = given | {"x_0": start[0], "x_dot_0": speed[0], "pi": math.pi}
    if n > 1:
        names |= {"y_0": start[1], "y_dot_0": speed[1]}
    worst = 0.0
    for row in rows[::200]:
        x = eval(shown[0]["expr"].replace("^", "**"), {}, names | {"t": row[0]})
        worst = max(worst, abs(x - row[1][0]))
    tap.check(f"{name}: it is the motion computed by hand", worst < 1e-7, (worst, shown[0]["expr"]))


def check_rests(program):
    spun = "coord r\nkinetic 1/2 m r'^2 + 1/2 m w^2 r^2\npotential 1/2 k (r - l0)^2\nask equilibria\n"
    answers, _ = solve(program, "param m = 1, k = 4, w = 2, l0 = 1\n" + spun)
    tap.check("a spring turned at its own frequency holds nothing anywhere", not answers[0]["values"] and "There is none" in words(answers[0]),
              answers[0])
    answers, _ = solve(program, "param m = 1, k = 5, w = 2, l0 = 1\n" + spun)
    tap.check("slower, at k l0/(k - m w^2)", [v["components"][0]["number"] for v in answers[0]["values"] if "components" in v] == [5], answers[0]["values"])
    answers, _ = solve(program, "param m = 1, F = 0\ncoord x\nkinetic 1/2 m x'^2\npotential -F x\nask equilibria\n")
    tap.check("without the force every place is one of rest", [v.get("free") for v in answers[0]["values"] if v["name"].startswith("equil")] == [["x"]],
              answers[0]["values"])
    answers, _ = solve(program, "param m = 1, k = 4, b = 4\ncoord x\naxes x right\nmass A: m at (x)\npotential 1/2 k x^2\ndrag b on A\nask modes\n")
    tap.check("modes know critical damping", "Critically damped" in words(answers[0]), words(answers[0]))


def check_masses(program):
    model = "param m1 = 1, m2 = 4, c = {c}, k = 3\ncoord x, y\nkinetic 1/2 m1 x'^2 + 1/2 m2 y'^2 + c x' y'\npotential 1/2 k x^2 + 1/2 k y^2\nask dof, modes\n"
    answers, got = solve(program, model.format(c=2))
    w2 = [v["number"] for v in answers[1]["values"] if v["name"] == "omega^2"]
    tap.check("masses whose matrix the numbers make singular leave one freedom", answers[0]["values"][-1]["number"] == 1, answers[0])
    tap.check("with the frequency of what is left", len(w2) == 1 and abs(w2[0] - 0.6) < 1e-12 and got.returncode == 0, (w2, got.stderr))
    answers, got = solve(program, model.format(c=1))
    tap.check("other numbers leave two", answers[0]["values"][-1]["number"] == 2 and "special case" not in words(answers[0]), answers[0])


def check_turntable(program):
    """A ball that rolls on a turntable: constraints between velocities, and yet linear equations for x and y alone."""
    model = ("param m = 0.3, R = 0.05, w = 1.4\ncoord x, y, p, q\naxes x right, y up\nmass m at (x, y)\nkinetic 1/5 m R^2 (p'^2 + q'^2)\n"
             "constraint sideways: x' - R q' = -w y\nconstraint away: y' + R p' = w x\nask solve x(t), solve y(t)\n")
    answers, got = solve(program, model)
    rate = 2 / 7 * 1.4
    rows = run(lambda t, q, v: [-rate * v[1], rate * v[0]], [0.2, -0.1], [0.5, 0.3])
    names = names_of({}) | {"w": 1.4, "x_0": 0.2, "y_0": -0.1, "x_dot_0": 0.5, "y_dot_0": 0.3}
    for i, name in enumerate("xy"):
        shown = [v["expr"] for v in answers[i]["values"] if v["name"] == name]
        worst = max([abs(eval(shown[0].replace("^", "**"), {}, names | {"t": row[0]}) - row[1][i]) for row in rows[::200]]) if shown else None
        tap.check(f"a ball on a turntable runs on a circle: {name}(t)", shown and worst < 1e-9, (worst, words(answers[i])))


def check_net(program):
    answers, _ = solve(program, "param m1 = 2, m2 = 2\ncoord x\nkinetic 1/2 (m1 + m2) x'^2\nask m1/(m1 - m2)\n")
    tap.check("a value that divides by zero for the given numbers is told", "has no value" in words(answers[0]), words(answers[0]))


FOURBAR = """param a = 0.1, b = 0.3, c = 0.25, d = 0.3, W = 2, m = 1, g = 9.81
coord φ, x1, y1, x2, y2
mass A: m at (x1, y1)
mass B: m at (x2, y2)
gravity g along -y
constraint crankx: x1 = a cos φ
constraint cranky: y1 = a sin φ
constraint coupler: (x2 - x1)^2 + (y2 - y1)^2 = b^2
constraint rocker: (x2 - d)^2 + y2^2 = c^2
constraint M: φ = W t
branch y2 > 0
ask λ_M where φ = 450°
simulate 0..5
"""


def fourbar_place(angle):
    """Joint B: the upper intersection of the circles of coupler and rocker."""
    x, y = 0.1 * math.cos(angle), 0.1 * math.sin(angle)
    far = math.hypot(0.3 - x, y)
    along = (far**2 + 0.3**2 - 0.25**2) / (2 * far)
    across = math.sqrt(0.3**2 - along**2)
    ex, ey = (0.3 - x) / far, -y / far
    return x, y, x + along * ex - across * ey, y + along * ey + across * ex


def check_drive(program):
    """A drive moves all: the moment of the drive is the power into the linkage over its rate."""
    def energy(t, h=1e-4):
        p, q, r = (fourbar_place(2 * s) for s in (t - h, t, t + h))
        return sum(((z - x) / (2 * h))**2 / 2 for x, z in zip(p, r)) + 9.81 * (q[1] + q[3])
    t, h = math.radians(450) / 2, 1e-3
    moment = (energy(t + h) - energy(t - h)) / (2 * h) / 2
    answers, document = solve(program, FOURBAR)
    values = [v["number"] for v in answers[0]["values"]]
    tap.check("a linkage that a drive moves is followed to a place", len(values) == 1 and abs(values[0] - moment) < 1e-4 * abs(moment), (values, moment))


def main(program):
    check_drive(program)
    for case in MOTIONS:
        check_motion(program, *case)
    check_rests(program)
    check_masses(program)
    check_net(program)
    check_turntable(program)
    tap.done()


if __name__ == "__main__":
    main(sys.argv[1])
