#!/usr/bin/env python3
"""Springs that pass through zero length, |x|, min and max: each side has its own formulas, and no answer is given for the wrong one.
Every motion is integrated here with the force as it is on both sides, every place of rest is found here by bisection.

    sides_test.py PROGRAM
"""

import json
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
sys.path.insert(0, os.path.join(HERE, "..", "founding"))
import tap  # noqa: E402
from formulas import Formula  # noqa: E402


def solve(program, text):
    got = subprocess.run([program, "solve", "--json", "-"], input=text, capture_output=True, text=True, timeout=60)
    return json.loads(got.stdout), got.returncode


def items(document, word):
    return [i for letter in document["answers"].values() for i in letter if i["item"] == word]


def words(item):
    return " ".join(s.get("text", "") for s in item["steps"])


def motion(force, x, v, t, steps=20000):
    """(x, v) after t, by Runge-Kutta of order 4 with the force as it is on both sides; the first time that x passes `kink`."""
    h = t / steps
    for _ in range(steps):
        k1, l1 = v, force(x, v)
        k2, l2 = v + h / 2 * l1, force(x + h / 2 * k1, v + h / 2 * l1)
        k3, l3 = v + h / 2 * l2, force(x + h / 2 * k2, v + h / 2 * l2)
        k4, l4 = v + h * l3, force(x + h * k3, v + h * l3)
        x, v = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), v + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
    return x, v


SPRING = """coord x
param m = 0.95, k = 26.86
mass A: m at (x)
spring k, rest 0.2 between A and (-1.8)
init x = 0.5, x' = -0.28
"""


def spring_force(x, v):
    u = x + 1.8
    return -26.86 * (abs(u) - 0.2) * math.copysign(1, u) / 0.95


def passing():
    """When x = -1.8 is passed the first time: u = x + 1.6 = 2.1 cos(w t) - 0.28/w sin(w t) is -0.2 there."""
    w = math.sqrt(26.86 / 0.95)
    size, phase = math.hypot(2.1, 0.28 / w), math.atan2(0.28 / w, 2.1)
    return (math.acos(-0.2 / size) - phase) / w


def check_motion(program):
    document, code = solve(program, SPRING + "ask solve x(t)\nsimulate 0..1\n")
    first, second = items(document, "solve x(t)")
    t1 = passing()
    tap.check("a spring through zero length passes its own checks", code == 0, document["checks"])
    tap.check("x(t) says how long it holds", f"until t = {t1:.6g}" in words(first) and "9 + 5 x ≥ 0" in words(first), words(first))
    tap.check("its value assumes the side", first["values"][0]["assuming"] == ["5*x + 9 >= 0"], first["values"])
    at = {"m": 0.95, "k": 26.86, "x_0": 0.5, "x_dot_0": -0.28}
    for t in (0.1, 0.3):
        x = Formula(first["values"][0]["expr"]).value({**at, "t": t})
        tap.check(f"x({t}) of the first side", abs(x - motion(spring_force, 0.5, -0.28, t)[0]) < 1e-8, x)
    # the second side: its clock begins where it does
    x1, v1 = motion(spring_force, 0.5, -0.28, t1)
    tap.check("the other side has a section of its own", second["stage"] == 2 and second["values"][0]["assuming"] == ["5*x + 9 <= 0"], second)
    for t in (0.1, 0.5):
        x = Formula(second["values"][0]["expr"]).value({"m": 0.95, "k": 26.86, "x_0": x1, "x_dot_0": v1, "t": t})
        wanted = motion(spring_force, 0.5, -0.28, t1 + t)[0]
        tap.check(f"x(t) of the second side, {t} s later", abs(x - wanted) < 1e-4, (x, wanted))
    head = items(document, "stage 2")[0]
    tap.check("which says where it begins and how it ends", f"t = {t1:.6g}" in words(head) and "This holds until 9 + 5 x = 0" in words(head), words(head))
    tap.check("assumptions are those of the first side", document["assumptions"].count("9 + 5 x ≥ 0") == 1
              and not any("9 + 5 x ≤ 0" in a for a in document["assumptions"]), document["assumptions"])


def check_unknown_span(program):
    document, code = solve(program, SPRING + "ask solve x(t)\n")
    said = words(items(document, "solve x(t)")[0])
    tap.check("without a span the condition is said", code == 0 and "This holds as long as 9 + 5 x ≥ 0." in said, said)


def check_rests(program):
    document, code = solve(program, SPRING + "ask equilibria\n")
    found = {round(v["components"][0]["number"], 9): v["stability"] for v in items(document, "equilibria")[0]["values"] if v.get("components")}
    tap.check("both sides of a spring have their place of rest", code == 0 and found == {-1.6: "stable", -2.0: "stable"}, found)
    # hanging: on one side only, the weight is larger than the spring can push
    heavy = "coord x\nparam m = 2, k = 10, g = 9.81\nmass m at (x)\ngravity g along x\nspring k, rest 0.5 between m and (1)\ninit x = 0.2\nask equilibria\n"
    document, code = solve(program, heavy.replace("mass m at", "mass A: m at").replace("between m", "between A"))
    found = [v["components"][0]["number"] for v in items(document, "equilibria")[0]["values"] if v.get("components")]
    tap.check("a place on the other side alone", code == 0 and len(found) == 1 and abs(found[0] - (1.5 + 1.962)) < 1e-9, found)
    # |x| + a parabola: rest where the slope vanishes on each side, 2 (x - 3) + 4 sign x = 0 only for x = 1; none for x < 0
    document, code = solve(program, "coord x\nmass 1 at (x)\npotential (x - 3)^2 + 4*abs(x)\ninit x = -1\nask equilibria\n")
    found = [v["components"][0]["number"] for v in items(document, "equilibria")[0]["values"] if v.get("components")]
    tap.check("of |x| the side that has it", code == 0 and found == [1], found)


def check_where(program):
    document, code = solve(program, SPRING + "ask x' where x = -1\nask x' where x = -2\nask x' where x = -2 from x = -3 at rest\nsimulate 0..1\n")
    near, far, other = (items(document, w)[0] for w in ("x' where x = -1", "x' where x = -2", "x' where x = -2 from x = -3 at rest"))
    v = -math.sqrt(0.28**2 + 26.86 / 0.95 * (2.1**2 - 0.6**2))
    tap.check("a place on the side of the start", code == 0 and abs(near["values"][0]["number"] - v) < 1e-9, near["values"])
    tap.check("a place beyond is not answered with the wrong formula", not [x for x in far["values"] if x.get("expr")], far["values"])
    tap.check("and where the formulas end is said", "leaves 9 + 5 x ≥ 0 before, at x = -1.8" in words(far), words(far))
    v = math.sqrt(26.86 / 0.95)
    tap.check("a start on the other side has the formulas of that side", abs(other["values"][0]["number"] - v) < 1e-9, other["values"])
    # from the other side through the zero length, back to the side of `init`
    document, code = solve(program, SPRING + "ask x' where x = -1 from x = -3 at rest\nsimulate 0..1\n")
    back = items(document, "x' where x = -1 from x = -3 at rest")[0]
    tap.check("a start on the other side ends where its own formulas end",
              code == 0 and not back["values"] and "leaves 9 + 5 x ≤ 0 before, at x = -1.8" in words(back), (words(back), document["checks"]))


def check_borders(program):
    """A well with two stiffnesses, |x|^3, a stop, nested branches, dry friction: no stability or frequency of one side."""
    for name, v, wanted in (("two stiffnesses", "if(x > 0, k*x^2/2, k*x^2)", [0]), ("|x|^3", "k*abs(x)^3", [0])):
        document, code = solve(program, f"coord x\nparam m = 1, k = 4\nmass A: m at (x)\npotential {v}\ninit x = 1\nask equilibria\n")
        values = [x for x in items(document, "equilibria")[0]["values"]]
        places = [x["components"][0]["number"] for x in values if x.get("components")]
        tap.check(f"{name}: it rests at the kink, and no stability of one side is told",
                  code == 0 and places == wanted and not any(x.get("stability") or x["name"] == "omega^2" for x in values), values)
    stop = "coord x\nparam m = 1, k = 4, K = 200\nmass A: m at (x)\npotential k*x^2/2 + K*max(x - 0.5, 0)^2/2\ninit x = -1\nask equilibria\nask modes\n"
    document, code = solve(program, stop)
    values = items(document, "equilibria")[0]["values"]
    places = [x["components"][0]["number"] for x in values if x.get("components")]
    tap.check("a stop that is not touched at rest", places == [0] and values[0]["stability"] == "stable", values)
    tap.check("modes at a kink are refused", "have a kink" in words(items(document, "modes")[0]), words(items(document, "modes")[0]))
    dead = "coord x\nparam m = 2, k = 30\nmass A: m at (x)\npotential k*max(abs(x) - 0.2, 0)^2/2\ninit x = 1\nask equilibria\n"
    document, code = solve(program, dead)
    tap.check("branches within branches are not claimed to be searched", code == 0 and "There may be others" in words(items(document, "equilibria")[0]),
              words(items(document, "equilibria")[0]))
    dry = "coord x\nparam m = 1, k = 10, c = 0.4\nmass A: m at (x)\npotential k*x^2/2\nforce (-c*sign(x')) on A\ninit x = 1, x' = 0.3\nask lagrange2\nask equilibria\n"
    document, code = solve(program, dry)
    said = words(items(document, "lagrange2")[0])
    tap.check("dry friction has an equation", "undefined" not in said and "abs(x')" in said, said)
    tap.check("and no single place of rest", not items(document, "equilibria")[0]["values"], items(document, "equilibria")[0]["values"])


def check_angle(program):
    """m g l sin φ + c sign φ = 0: on the side φ >= 0 sin φ = -c/(m g l) at π + asin and 2 π - asin, and so on."""
    model = "coord φ\nparam m = 1, l = 1, g = 9.81, c = 2\nmass A: m at (l sin φ, -l cos φ)\naxes x right, y up\ngravity g along -y\npotential c*abs(φ)\ninit φ = 0.5\nask equilibria\n"
    document, code = solve(program, model)
    item = items(document, "equilibria")[0]
    tap.check("an angle under |φ| has places in other turns, and completeness is not claimed", code == 0 and "There may be others" in words(item), words(item))
    for v in item["values"]:
        if v.get("components"):
            x = v["components"][0]["number"]
            tap.check(f"φ = {x:.4f} rests", abs(9.81 * math.sin(x) + 2 * math.copysign(1, x)) < 1e-9, x)


def check_sets(program):
    """A spring turns over on the way to a rope: sections in the order of time, each with its own sign."""
    model = ("coord x\nparam m = 1, k = 30, g = 9.81\nmass A: m at (x)\naxes x down\ngravity g along x\nspring k, rest 0.2 between A and (1)\n"
             "constraint rope: x <= 1.2\ninit x = 0.5, x' = 0\nask V\nask x' where x = 1.1\nsimulate 0..1\n")
    document, code = solve(program, model)
    # x = 0.8 + g/k + (0.5 - 0.8 - g/k) cos(w t) = 1
    w = math.sqrt(30)
    t1 = math.acos((1 - 0.8 - 0.327) / (0.5 - 0.8 - 0.327)) / w
    heads = [i for letter in document["answers"].values() for i in letter if i["item"].startswith("stage")]
    said = [words(h) for h in heads]
    tap.check("a rope behind a spring of no length passes its checks", code == 0, document["checks"])
    tap.check("the turn of the spring comes before the rope", len(heads) == 2 and f"t = {t1:.6g}" in said[0] and "x = 6/5" in said[1], said)
    values = [(i.get("stage", 1), i["values"][0]["number"]) for i in items(document, "V")]
    tap.check("V of the rope is that of the side where it holds", abs(values[-1][1] - (0 - 9.81 * 1.2)) < 1e-9, values)


def check_pulley(program):
    model = ("coord x1, x2\nparam m1 = 2.63, m2 = 1.5, g = 9.81, k = 9.41, d = 0.42\nmass A1: m1 at (x1)\nmass A2: m2 at (x2)\n"
             "gravity g along x\nspring k, rest d between A2 and (0.72)\nconstraint rope: x1 + x2 <= 1.4\n"
             "init x1 = 0.61, x2 = 0.79, x1' = 0, x2' = -0\nask equilibria\nask solve x1(t)\nsimulate 0..1\n")
    document, code = solve(program, model)
    found = [v["components"][0]["number"] for v in items(document, "equilibria")[0]["values"] if v.get("components")]
    wanted = 1.4 - 0.72 + 0.42 + 1.13 * 9.81 / 9.41      # (m1 - m2) g = k (0.72 - x2 - d)
    tap.check("a rope over a pulley: the place of rest with the spring turned", code == 0 and len(found) == 1 and abs(found[0] - wanted) < 1e-9, found)
    stages = [i.get("stage", 1) for i in items(document, "solve x1(t)")]
    tap.check("and the motion has both sides", stages == [1, 2], stages)


def check_jump(program):
    """The motion has a sample where the force of the spring jumps; the formulas of the sides stand all the same."""
    text = """coord x1, x2
axes x down
param m1 = 2.2, m2 = 2.49, g = 9.81, k = 2.69, d = 0.57
mass A1: m1 at (x1)
mass A2: m2 at (x2)
gravity g along x
spring k, rest d between A1 and (0.67)
constraint rope: x1 + x2 <= 1.02
init x1 = 0.68, x2 = 0.34, x1' = 0, x2' = 0
ask solve x1''
simulate 0..1
"""
    document, code = solve(program, text)
    value = [v for a in document["answers"].values() for i in a for v in i["values"] if v["name"] == "x1_ddot" and v.get("expr")]
    at = {"x1": 0.68, "m1": 2.2, "m2": 2.49, "g": 9.81, "k": 2.69, "d": 0.57}
    true = ((2.2 - 2.49) * 9.81 - 2.69 * (0.68 - 0.67 - 0.57)) / (2.2 + 2.49)
    got = Formula(value[0]["expr"]).value(at) if value else None
    tap.check("a sample where the force jumps withdraws nothing", code == 0 and got is not None and abs(got - true) < 1e-9, (code, got, true))


def check_directions(program):
    """A unit vector whose length takes a sign for granted does not halve the list of rests: ω² R cos α = g or sin α = 0, α = 3 w."""
    text = """param m = 0.1, R = 0.5, ω = 6, g = 9.81
coord u, w, r
mass m at (r sin (3 w) cos u, r sin (3 w) sin u, -r cos (3 w))
gravity g along -z
constraint hoop: r = R
constraint drive: u = ω t
init w = 0.1, w' = 0
ask a: lagrange1 in (r, w, u)
ask b: equilibria
"""
    document, code = solve(program, text)
    found = sorted(v["components"][0]["number"] for i in items(document, "equilibria") for v in i["values"] if v.get("components"))
    alpha = [0.0, math.pi] + [s * math.acos(9.81 / (36 * 0.5)) for s in (1, -1)]
    true = sorted(w for a in alpha for n in range(-3, 4) for w in [(a + 2 * math.pi * n) / 3] if -math.pi + 1e-9 < w <= math.pi + 1e-9)
    near = len(found) == len(true) and all(abs(a - b) < 1e-5 for a, b in zip(found, true))
    tap.check("directions of unit vectors leave all places of rest", code == 0 and near, (code, found, true))


def main():
    program = sys.argv[1]
    check_motion(program)
    check_unknown_span(program)
    check_rests(program)
    check_where(program)
    check_borders(program)
    check_angle(program)
    check_sets(program)
    check_pulley(program)
    check_jump(program)
    check_directions(program)
    tap.done()


main()
