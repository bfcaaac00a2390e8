#!/usr/bin/env python3
"""What `conserved` says, against motions computed here from equations written by hand: what is conserved stays, and the energy that
is not conserved changes.  Then frequencies of driven systems.

    conserved_test.py PROGRAM
"""

import json
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402

AXES = "axes x right, y up\n"
# name, model, accelerations by hand, start, energy conserved, names of what is conserved
MODELS = [
    ("time in a linear term", "coord u\nlagrangian 1/2 u'^2 + sin(t) u'\n",
     lambda t, q, v: [-math.cos(t)], [0.3], [0.2], False, {"p_u"}),
    ("time in a total derivative", "coord u\nlagrangian 1/2 u'^2 + t u u'\n",
     lambda t, q, v: [-q[0]], [0.3], [0.2], False, {"J"}),
    ("accelerated frame", "coord x\naxes x right\nmass A: 2 at (x + t^2)\npotential 3/2 x^2\n",
     lambda t, q, v: [-2 - 1.5 * q[0]], [0.3], [0.2], False, {"J"}),
    ("swinging frame", "coord x\naxes x right\nmass A: 2 at (x + sin(t))\npotential 3/2 x^2\n",
     lambda t, q, v: [math.sin(t) - 1.5 * q[0]], [0.3], [0.2], False, set()),
    ("driven oscillator", "coord x\naxes x right\nmass A: 2 at (x)\npotential 3/2 x^2 - x cos(t)\n",
     lambda t, q, v: [(math.cos(t) - 3 * q[0]) / 2], [0.3], [0.2], False, set()),
    ("force across the velocity", "coord x, y\n" + AXES + "mass A: 2 at (x, y)\npotential 1/2 x^2\nforce (3 y', -3 x') on A\n",
     lambda t, q, v: [(3 * v[1] - q[0]) / 2, -1.5 * v[0]], [0.3, 0], [0.2, 0.7], True, {"E"}),
    ("force along the velocity", "coord x, y\n" + AXES + "mass A: 2 at (x, y)\npotential 1/2 x^2\nforce (3 x', 0) on A\n",
     lambda t, q, v: [(3 * v[0] - q[0]) / 2, 0], [0.3, 0], [0.2, 0.7], False, {"p_y"}),
    ("hoop that is turned", "coord θ\nkinetic 1/2 θ'^2 + 9/2 sin(θ)^2\npotential -9.81 cos(θ)\n",
     lambda t, q, v: [9 * math.sin(q[0]) * math.cos(q[0]) - 9.81 * math.sin(q[0])], [0.3], [0.2], True, {"E"}),
    ("rod that is turned", "param w = 3\ncoord r\n" + AXES + "mass A: 1 at (r cos(w t), r sin(w t))\n",
     lambda t, q, v: [9 * q[0]], [0.3], [0.2], False, {"H"}),
]


def run(f, q, v, end=2.0, n=2000):
    """Runge-Kutta of fourth order: rows (t, q, v)."""
    h, rows = end / n, [(0.0, list(q), list(v))]
    size = len(q)

    def slope(t, y):
        return y[size:] + f(t, y[:size], y[size:])
    y, t = list(q) + list(v), 0.0
    for _ in range(n):
        a = slope(t, y)
        b = slope(t + h / 2, [x + h / 2 * s for x, s in zip(y, a)])
        c = slope(t + h / 2, [x + h / 2 * s for x, s in zip(y, b)])
        d = slope(t + h, [x + h * s for x, s in zip(y, c)])
        y = [x + h / 6 * (p + 2 * r + 2 * s + u) for x, p, r, s, u in zip(y, a, b, c, d)]
        t += h
        rows.append((t, y[:size], y[size:]))
    return rows


def solve(program, text):
    got = subprocess.run([program, "solve", "--json", "--no-simulation", "-"], input=text, capture_output=True, text=True, timeout=60)
    document = json.loads(got.stdout)
    return [a for letter in document["answers"].values() for a in letter], got


def value(text, coordinates, row, given):
    names = {k: getattr(math, k) for k in ("sin", "cos", "sqrt", "exp")} | given | {"t": row[0]}
    for i, c in enumerate(coordinates):
        names |= {c: row[1][i], c + "_dot": row[2][i]}
    return eval(text.replace("^", "**"), {}, names)


def check_model(program, name, model, f, q, v, energy, conserved):
    answers, got = solve(program, model + "ask conserved\n")
    values = {x["name"]: x for x in answers[0]["values"]}
    tap.check(f"{name}: no check of its own fails", got.returncode == 0, got.stderr)
    kept = {n for n, x in values.items() if x.get("conserved")}
    tap.check(f"{name}: these are conserved: {sorted(conserved)}", kept == conserved, values)
    tap.check(f"{name}: the energy is {'' if energy else 'not '}conserved", bool(values["E"].get("conserved")) == energy, values["E"])
    words = " ".join(s.get("text", "") for s in answers[0]["steps"])
    if "H" not in kept and "E" not in kept:
        tap.check(f"{name}: nothing is said of a Lagrange function without t", "does not contain t" not in words.replace("it does not occur", ""), words)
    coordinates = [c.replace("θ", "theta") for c in model.split("coord ")[1].split("\n")[0].split(", ")]
    rows = run(f, q, v)
    for n in kept:
        along = [value(values[n]["expr"], coordinates, row, {"w": 3}) for row in rows[::100]]
        tap.check(f"{name}: {n} stays on a motion computed by hand", max(along) - min(along) < 1e-8 * (1 + abs(along[0])), along[:5])


def check_drives(program):
    """Modes of driven systems: the drive is set to 0, and that is said."""
    car = ("param m1, m2, k1, k2, a, w\ncoord x1, x2\nkinetic 1/2 m1 x1'^2 + 1/2 m2 x2'^2\n"
           "potential 1/2 k1 (x1 - x2)^2 + 1/2 k2 (x2 - a cos(w t))^2\nask modes\n")
    answers, _ = solve(program, car)
    at = {"m1": 3, "m2": 2, "k1": 5, "k2": 11, "sqrt": math.sqrt}
    got = sorted(eval(v["expr"].replace("^", "**"), {}, at) for v in answers[0]["values"] if v["name"] == "omega^2")
    # 6 w^4 - (2*5 + 3*16) w^2 + 55 = 0
    wanted = sorted(((58 + s * math.sqrt(58 * 58 - 24 * 55)) / 12 for s in (-1, 1)))
    tap.check("a quarter car on a wavy road has its frequencies", len(got) == 2 and max(abs(a - b) for a, b in zip(got, wanted)) < 1e-9, (got, wanted))
    words = " ".join(s.get("text", "") for s in answers[0]["steps"])
    tap.check("and what was left out is told", "Without the drive" in words, words)
    for where in ("(l sin θ + A cos(Ω t), -l cos θ)", "(l sin θ, -l cos θ + A cos(Ω t))"):
        answers, _ = solve(program, f"param m, l, g, A, Ω\ncoord θ\n{AXES}mass m at {where}\ngravity g along -y\nask modes, equilibria\n")
        got = [v["expr"] for v in answers[0]["values"] if v["name"] == "omega^2"]
        tap.check(f"a pendulum on a moved support at {where} has the frequencies of one at rest", got == ["g/l", "-g/l"], got)
        rests = [v["components"][0]["number"] for v in answers[1]["values"]]
        stays = where.endswith("A cos(Ω t))")
        tap.check("and stays upright or hanging only where the support moves up and down", len(rests) == (2 if stays else 0), rests)
        tap.check("without a word on stability from a potential", all(not v.get("stability") for v in answers[1]["values"]), answers[1]["values"])
    answers, _ = solve(program, "coord x\nkinetic 1/2 x'^2\npotential 1/2 (1 + t) x^2\nask modes\n")
    words = " ".join(s.get("text", "") for s in answers[0]["steps"])
    tap.check("a spring that stiffens has no modes", "no modes" in words and not answers[0]["values"], words)


def main(program):
    for case in MODELS:
        check_model(program, *case)
    check_drives(program)
    tap.done()


if __name__ == "__main__":
    main(sys.argv[1])
