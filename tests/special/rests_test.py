#!/usr/bin/env python3
"""Positions of rest of one coordinate against a search that knows nothing of pleuel: zeros of the slope of the potential on a fine
grid, minimum or maximum by the values around.  "There is none", "there are no others" and "stable" are statements about all positions.

    rests_test.py PROGRAM
"""

import json
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402

TURN = 2 * math.pi

# name, potential as pleuel reads it, the same for Python, periodic
POTENTIALS = [
    ("inverted pendulum on a soft torsion spring", "5/2 q^2 + 9.81 cos q", lambda q: 2.5 * q * q + 9.81 * math.cos(q), False),
    ("inverted pendulum on a stiff torsion spring", "10 q^2 + 9.81 cos q", lambda q: 10 * q * q + 9.81 * math.cos(q), False),
    ("tilted double well", "q^4 - 2 q^2 + 1/5 q", lambda q: q**4 - 2 * q * q + q / 5, False),
    ("two molecules", "1/q^12 - 2/q^6 + q^2/50", lambda q: q**-12 - 2 * q**-6 + q * q / 50, False),
    ("exponential and line", "exp(q) - 2 q", lambda q: math.exp(q) - 2 * q, False),
    ("no rest on a slope", "q + 1/2 sin(q)", lambda q: q + math.sin(q) / 2, False),
    ("no rest beside a wall", "exp(-q)", lambda q: math.exp(-q), False),
    ("cosh and waves", "cosh(q/2) + cos(3 q)", lambda q: math.cosh(q / 2) + math.cos(3 * q), False),
    ("pendulum with a second harmonic", "cos(q) + 3/5 cos(2 q) + 1/10 sin(3 q)",
     lambda q: math.cos(q) + 0.6 * math.cos(2 * q) + 0.1 * math.sin(3 * q), True),
    ("hoop", "-cos(q) - 3/2 sin(q)^2", lambda q: -math.cos(q) - 1.5 * math.sin(q) ** 2, True),
    ("fourth order minimum", "q^4", lambda q: q**4, False),
    ("fourth order maximum", "-q^4", lambda q: -(q**4), False),
    ("sixth order minimum of an angle", "cos(q) + q^2/2 + cos(q)/24 - cos(q)/24 - q^4/24 + q^6", lambda q: math.cos(q) + q * q / 2 - q**4 / 24 + q**6, False),
    ("inflection", "q^3", lambda q: q**3, False),
    ("hoop at its threshold", "-cos(q) - 1/2 sin(q)^2", lambda q: -math.cos(q) - 0.5 * math.sin(q) ** 2, True),
]


def solve(program, text):
    got = subprocess.run([program, "solve", "--json", "--no-simulation", "-"], input=text, capture_output=True, text=True, timeout=60)
    document = json.loads(got.stdout)
    document["list"] = [answer for letter in document["answers"].values() for answer in letter]
    return document, got


def rests(document):
    """place -> stability, and the sentences."""
    found, words = {}, ""
    for answer in document["list"]:
        words += " ".join(s.get("text", "") for s in answer["steps"])
        for v in answer["values"]:
            if v["name"].startswith("equilibrium"):
                found[v["components"][0]["number"]] = v["stability"]
    return found, words


def slope(V, q):
    h = 1e-6 * max(1, abs(q))
    return (V(q + h) - V(q - h)) / (2 * h)


def by_hand(V, lo, hi):
    """Extrema on a grid: place -> True for a minimum."""
    n, out = 20011, {}
    grid = [lo + (hi - lo) * (k + 0.37) / n for k in range(n)]
    values = []
    for q in grid:
        try:
            values.append(V(q))
        except (ZeroDivisionError, OverflowError):
            values.append(math.nan)
    for k in range(1, n - 1):
        a, b, c = values[k - 1:k + 2]
        if math.isnan(a + b + c) or abs(b) > 1e6:
            continue
        if (b < a and b <= c) or (b > a and b >= c):
            out[grid[k]] = b < a
    return out


def same(a, b, periodic, within):
    off = abs(a - b)
    if periodic:
        off = abs((off + math.pi) % TURN - math.pi)
    return off < within


def check_potential(program, name, text, V, periodic):
    document, got = solve(program, f"coord q\nkinetic 1/2 q'^2\npotential {text}\nask equilibria\n")
    found, words = rests(document)
    lo, hi = (-math.pi, math.pi) if periodic else (-30, 30)
    wanted = by_hand(V, lo, hi)
    step = (hi - lo) / 20000
    for q, stable in wanted.items():
        near = [s for p, s in found.items() if same(p, q, periodic, 5 * step)]
        tap.check(f"{name}: the extremum at {q:.3f} is listed and its stability is right",
                  near == [("stable" if stable else "unstable")], f"{found}\n{words}")
    for p, s in found.items():
        if lo <= p <= hi:
            tap.check(f"{name}: the force vanishes at {p:.6f}", abs(slope(V, p)) < 1e-5, (slope(V, p), s))
    if not wanted and not found:
        tap.check(f"{name}: none, and it says so", "There is none" in words, words)
    return found, words


def check_named(program):
    model = "param m, l, g, k\ncoord θ\naxes x right, y up\nmass m at (l sin θ, l cos θ)\ngravity g along -y\npotential 1/2 k θ^2\n"
    document, _ = solve(program, model + "ask a: threshold k of stable\nask b: modes at θ = 0\nask c: modes at θ = 1\nask d: equilibria\n")
    answers = {letter: a[0] for letter, a in document["answers"].items()}
    tap.check("the inverted pendulum on a spring is stable from k = m g l on",
              [v["expr"] for v in answers["a"]["values"]] in (["m*g*l"], ["g*l*m"]), answers["a"]["values"])
    at = {"m": 2, "l": 0.5, "g": 9.81, "k": 30}
    w2 = [eval(v["expr"].replace("^", "**"), {}, dict(at)) for v in answers["b"]["values"] if v["name"] == "omega^2"]
    tap.check("its frequency upright is that of a spring less gravity", len(w2) == 1 and abs(w2[0] - (30 / (2 * 0.25) - 9.81 / 0.5)) < 1e-9, w2)
    words = " ".join(s.get("text", "") for s in answers["c"]["steps"])
    tap.check("a named place that is none of rest is refused in words", "no position of rest" in words, words)
    words = " ".join(s.get("text", "") for s in answers["d"]["steps"])
    tap.check("without numbers the equation that has no closed solution is named", "There may be others" in words and "sin" in words, words)


def check_several(program):
    """Two coordinates: both conditions are told, an indefinite potential is unstable, forces without potential are no potential."""
    base = "coord x, y\nkinetic 1/2 x'^2 + 1/2 y'^2\n"
    document, _ = solve(program, "param a, b, c\nassume a in -9..9, b in -9..9, c in -9..9\n" + base + "potential 1/2 a x^2 + 1/2 b y^2 + c x y\nask equilibria\n")
    v = document["list"][0]["values"][0]
    conditions = v["stable_if"].split(" and ")
    tap.check("stability of two coordinates has two conditions", len(conditions) == 2, v["stable_if"])

    def holds(a, b, c):
        names = {"a": a, "b": b, "c": c, "abs": abs}
        return all(eval(e.replace("^", "**"), {}, names) for e in conditions)
    for a, b, c in ((1, 2, 1), (1, 2, 2), (-1, -2, 1), (2, -1, 0.5), (3, 3, -2), (-3, 3, 1)):
        stable = a > 0 and a * b - c * c > 0
        tap.check(f"and they decide a = {a}, b = {b}, c = {c}", holds(a, b, c) == stable, v["stable_if"])
    document, _ = solve(program, base + "potential x y\nask equilibria\n")
    tap.check("a saddle with a zero diagonal is unstable", document["list"][0]["values"][0]["stability"] == "unstable",
              document["list"][0]["values"][0])
    follower = "param k, p\ncoord x, y\naxes x right, y up\nmass A: 1 at (x, y)\npotential 1/2 k (x^2 + y^2)\nforce (p y, -p x) on A\nask equilibria\n"
    document, _ = solve(program, follower)
    v = document["list"][0]["values"][0]
    tap.check("a circulating force is not judged by its potential", not v.get("stability") and not v.get("stable_if"), v)


def check_driven_damping(program):
    document, _ = solve(program, "coord x\naxes x right\nmass A: 1 at (x)\npotential 1/2 x^2\nforce (x'/10) on A\nask equilibria\n")
    v = document["list"][0]["values"][0]
    tap.check("an oscillator that is pushed along its velocity is unstable", v["stability"] == "unstable", v)


def check_lets(program):
    """A given quantity under another name is only a way of printing."""
    model = "param m, l, g\n{let}coord φ\naxes x right, z up\nmass m at (l sin φ, -l cos φ - 1/2 {a} t^2)\ngravity g along -z\nask a: equilibria\nask b: solve φ''\n"
    document, _ = solve(program, model.format(let="let a = g\n", a="a"))
    v = [x for x in document["list"][0]["values"] if x["name"].startswith("equilibrium")]
    tap.check("a pendulum in a lift that falls freely rests anywhere", len(v) == 1 and v[0]["free"] == ["phi"], v)
    tap.check("and nothing accelerates it", document["list"][1]["values"][0]["expr"] == "0", document["list"][1]["values"])
    document, _ = solve(program, model.format(let="let a = g/2\n", a="a"))
    v = {round(x["components"][0]["number"], 6): x["stability"] for x in document["list"][0]["values"] if "components" in x}
    tap.check("at half of it the lower place is stable, the upper one is not", v == {0: "stable", round(math.pi, 6): "unstable"}, v)


def check_sides(program):
    """Formulas that hold on one side of a spring, or up to the end of a map, give no places beyond it."""
    atwood = ("param m1 = 2.88, m2 = 2, g = 9.81, F = -1.57, k = 3.51, d = 0.52\ncoord x1, x2\naxes x down\nmass A1: m1 at (x1)\n"
              "mass A2: m2 at (x2)\ngravity g along x\nforce (F) on A1\nspring k, rest d between A2 and (0.63)\n"
              "constraint rope: x1 + x2 = 1.07\ninit x1 = 0.37, x2 = 0.7, x1' = 0, x2' = 0\nask equilibria\n")
    document, got = solve(program, atwood)
    found, said = rests(document)
    # the force on the rope with A2 above the pin: (m1 - m2) g + F = k (x1 - 0.44 - d)
    wanted = (0.88 * 9.81 - 1.57) / 3.51 + 0.96
    ok = len(found) == 1 and all(abs(x - wanted) < 1e-9 and s == "stable" for x, s in found.items())
    tap.check("the place is on the other side of the spring, where the motion does not begin", ok and "With 100 x2" in said, (found, said))
    tap.check("and the place of no length is named", "Not looked at: places with 63 = 100 x2" in said, said)
    far = ("param k = 13, d = {d}, m = 1\ncoord x, y\naxes x right, y up\nmass A: m at (x, y)\nspring k, rest d between A and (0.87, 1.31)\n"
           "constraint rail: y = -0.37\nask equilibria\n")
    for d, wanted in ((0.48, 1), (2, 3)):
        document, got = solve(program, far.format(d=d))
        at_numbers = [v for v in document["list"][0]["values"] if v["name"].startswith("equil") and v.get("stability")]
        tap.check(f"a spring of rest length {d} at 1.68 from a rail: {wanted} places, own checks pass",
                  len(at_numbers) == wanted and got.returncode == 0, (at_numbers, got.stderr))
    wire = ("param m = 2.68, g = 9.81\ncoord x, y\naxes x right, y up\nmass A: m at (x, y)\ngravity g along -y\nforce (2.46, 0) on A\n"
            "constraint wire: y = 0.5 cos(x)\nchoose x\ninit x = 0.14, y = 0.5 cos(0.14), x' = 0.64\nask equilibria\n")
    document, _ = solve(program, wire)
    said = rests(document)[1]
    tap.check("a length is no angle, and the places of other waves are told of", "°" not in said and "whole periods further" in said, said)
    turned = "coord x, y\nkinetic 1/2 x'^2 + 1/2 y'^2\npotential x cos(y) + exp(y/2)\nask equilibria\n"
    document, got = solve(program, turned)
    places = {round(v["components"][1]["number"] / math.pi, 6) for v in document["list"][0]["values"] if v["name"].startswith("equil")}
    tap.check("where the system does not repeat, other turns are other places", {0.5, -0.5, 1.5, -1.5, 2.5, -2.5} <= places, places)
    document, _ = solve(program, turned.replace("x cos(y) + exp", "a x cos(y) + b exp").replace("coord", "param a, b\ncoord"))
    tap.check("and without numbers they are told of", "There are others" in rests(document)[1], rests(document)[1])


BARS = """param g = 9.81
coord {order}
axes x right, y up
mass A: 1 at (sin(a0{shift}), cos(a0{shift}))
mass B: 1 at (1 + sin(a1{shift}), cos(a1{shift}))
mass C: 2 at (x, y)
gravity g along -y
constraint b0x: x = sin(a0{shift})
constraint b0y: y = cos(a0{shift})
constraint b1x: x = sin(a1{shift})
constraint b1y: y = cos(a1{shift}), redundant ok
init a0 = 0.1, a1 = 0.1
ask equilibria
"""


def check_chains(program):
    """Maps that are inserted into each other, in both orders, and with angles counted from elsewhere."""
    for order in ("x, y, a0, a1", "a1, a0, y, x"):
        for shift, place in (("", 0), (" + 0.25", -0.25)):
            document, _ = solve(program, BARS.format(order=order, shift=shift))
            found, said = rests(document)
            tap.check(f"parallel bars in the order {order}, angles{shift or ' as they are'}: they stand upright, not stably",
                      any(abs(q - place) < 1e-9 and s == "unstable" for q, s in found.items()), (found, said))


TRAMMEL = """param m = 1 [kg], M = 2 [kg], l = 1 [m], g = 9.81 [m/s^2], k = 30 [N/m]
coord θ
axes x right, y up
mass A: m at (l cos θ, 0)
mass B: M at (0, l sin θ)
gravity g along -y
spring k between A and (0, 0)
ask equilibria
"""


def check_existence(program):
    """The leaning rod exists for l k >= M g only, and would be stable for l k < M g: unstable wherever it is."""
    document, got = solve(program, TRAMMEL)
    leaning = [v for v in document["list"][0]["values"] if v.get("exists_if")]
    tap.check("a condition of stability that existence excludes is no condition",
              len(leaning) == 2 and all(v["stability"] == "unstable" and not v.get("stable_if") for v in leaning), got)


def main(program):
    for case in POTENTIALS:
        check_potential(program, *case)
    check_named(program)
    check_several(program)
    check_driven_damping(program)
    check_lets(program)
    check_sides(program)
    check_chains(program)
    check_existence(program)
    tap.done()


if __name__ == "__main__":
    main(sys.argv[1])
