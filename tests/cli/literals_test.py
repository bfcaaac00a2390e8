#!/usr/bin/env python3
"""Numbers with units in formulas: each place where one may stand, beside its twin with a parameter.  Usage: literals_test.py PLEUEL

A twin says the same with a name: the formulas for programs must have the same values, the motions the same end, the checks must pass."""
import json
import math
import os
import random
import re
import subprocess
import sys

from tap import check, done

program = os.path.abspath(sys.argv[1])
clean = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "NO_COLOR", "LANG", "LC_ALL", "LC_MESSAGES", "COLUMNS")}

HEAD = """param m = 2 [kg], k = 400 [N/m], r = 0.1 [m], g = 9.81 [m/s^2], J = 0.02 [kg m^2], Q = {value}
coord φ
axes x right, y up
"""
START = "init φ = 0.2, φ' = 0\nask a: lagrange2, lagrangian\nsimulate 0..0.5 [s]\n"

# where the number stands as {}, its value, how it must be shown
PLACES = {
    "mass": ("mass A: {} at (r cos φ, r sin φ)\ngravity g along -y\n", "2.5 [kg]", "2.5 kg"),
    "a place": ("mass A: m at (r cos φ, r sin φ)\npoint W at ({}, 0)\nspring k between W and A\n", "0.5 [m]", "0.5 m"),
    "force": ("mass A: m at (r cos φ, r sin φ)\nforce (0, {}) on A\n", "3 [N]", "3 N"),
    "a minus": ("mass A: m at (r cos φ, r sin φ)\nforce (0, -{}) on A\n", "3 [N]", "3 N"),
    "stiffness": ("mass A: m at (r cos φ, r sin φ)\npoint W at (r/2, 0)\nspring {} between W and A\n", "20 [kN/m]", "20 kN/m"),
    "rest length": ("mass A: m at (r cos φ, r sin φ)\npoint W at (r/2, 0)\nspring k, rest {} between W and A\n", "5 [cm]", "5 cm"),
    "damper": ("mass A: m at (r cos φ, r sin φ)\npoint W at (r/2, 0)\ndamper {} between W and A\n", "0.1 [N s/m]", "0.1 N s/m"),
    "drag": ("mass A: m at (r cos φ, r sin φ)\ndrag {} on A\ngravity g along -y\n", "0.02 [N s/m]", "0.02 N s/m"),
    "gravity": ("mass A: m at (r cos φ, r sin φ)\ngravity {} along -y\n", "9.81 [m/s^2]", "9.81 m/s²"),
    "mass of a body": ("body W: mass {}, inertia J at (r cos φ, r sin φ) angle 2 φ\ngravity g along -y\n", "0.1 [kg]", "0.1 kg"),
    "inertia": ("body W: mass m, inertia {} at (r cos φ, r sin φ) angle 2 φ\ngravity g along -y\n", "0.3 [kg m^2]", "0.3 kg m²"),
    "torque": ("body W: mass m, inertia J at (r cos φ, r sin φ) angle φ\ntorque {} on W\n", "7 [N m]", "7 N m"),
    "potential": ("mass A: m at (r cos φ, r sin φ)\npotential {} cos φ\n", "1.5 [J]", "1.5 J"),
    "kinetic": ("kinetic {} φ'^2/2\npotential 3 [J] cos φ\n", "0.25 [kg m^2]", "0.25 kg m²"),
    "lagrangian": ("lagrangian 1/2 J φ'^2 - {} cos φ\n", "4 [J]", "4 J"),
    "a sum": ("mass A: m at ((r + {}) cos φ, (r + {}) sin φ)\ngravity g along -y\n", "0.4 [m]", "0.4 m"),
    "a frequency": ("mass A: m at (r cos φ, r sin φ)\nforce (0, m g cos({} t)) on A\n", "30 [rad/s]", "30 rad/s"),
    "an abbreviation": ("let R = r + {}\nmass A: m at (R cos φ, R sin φ)\ngravity g along -y\n", "0.3 [m]", None),
    "a third": ("mass A: m at (r cos φ, r sin φ)\nforce (0, {}) on A\n", "1/3 [N]", "(1/3) N"),
}


def pleuel(arguments, text):
    run = subprocess.run([program, *arguments, "-"], input=text.encode(), capture_output=True, timeout=60, env=clean)
    return run.returncode, run.stdout.decode(), run.stderr.decode()


def expressions(document):
    """The values of a document: name, item and text for programs, in order."""
    found = []
    for items in document["answers"].values():
        for item in items:
            for value in item.get("values", []):
                if value.get("expr"):
                    found.append((value.get("name"), value["expr"]))
    return found


def number(expr, point):
    names = {"sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "pi": math.pi}
    return eval(expr.replace("^", "**"), {"__builtins__": {}}, names | point)


def same(a, b, point):
    x, y = number(a, point), number(b, point)
    return abs(x - y) <= 1e-9 * max(1, abs(x))


def columns(csv):
    head, *rows = [line.split(",") for line in csv.splitlines() if not line.startswith("#")]
    return [float(x) for x in rows[-1] if re.fullmatch(r"[-+.\de]+", x)]


rng = random.Random(5)
for name, (lines, value, shown) in PLACES.items():
    plain = HEAD.replace(", Q = {value}", "") + lines.replace("{}", value) + START
    named = HEAD.replace("{value}", value) + lines.replace("{}", "Q") + START
    code, out, err = pleuel(["solve", "--json"], plain)
    twin_code, twin_out, twin_err = pleuel(["solve", "--json"], named)
    if not check(f"{name}: both are solved, and every check passes", code == 0 and twin_code == 0, err + twin_err):
        continue
    a, b = json.loads(out), json.loads(twin_out)
    check(f"{name}: no parameter is made up", "Q" not in a["parameters"] and all(re.fullmatch(r"\w+", n) for n in a["parameters"]),
          a["parameters"])
    number_of_q = b["parameters"]["Q"]["number"]
    point = {n: rng.uniform(0.5, 2) for n in ("phi", "phi_dot", "phi_ddot", "t", "m", "k", "r", "g", "J")} | {"Q": number_of_q}
    if "R" in lines.split("\n")[0]:
        point["R"] = point["r"] + number_of_q
    pairs = list(zip(expressions(a), expressions(b)))
    wrong = [(x, y) for x, y in pairs if not same(x[1], y[1], point)]
    check(f"{name}: the formulas for programs have the same values in SI", pairs and not wrong, wrong)
    if shown:
        for manner, text in (("line", shown), ("2d", shown), ("ascii", value.replace("1/3", "(1/3)"))):
            _, said, _ = pleuel(["solve", "--math", manner], plain)
            check(f"{name}: shown as {text} in {manner}", text in said, said)
    _, said, _ = pleuel(["solve"], plain)
    check(f"{name}: a number is no assumption", not re.search(r"used.*\d \w+ >", said), said)
    ends = [pleuel(["sim", "-o", "-"], text)[1] for text in (plain, named)]
    difference = max(abs(x - y) for x, y in zip(*map(columns, ends)))
    check(f"{name}: the same motion", difference < 1e-9, difference)

# ---------------------------------------------------------------------------------------------- the other manners
TWO = HEAD.replace(", Q = {value}", "") + "mass A: 2 [kg] at (r cos φ, r sin φ)\nforce (0, 0.5 [N]) on A\nask a: lagrange2\n"
_, tex, _ = pleuel(["tex", "-o", "-"], TWO)
check("LaTeX: the unit is upright", r"2\,\mathrm{kg}" in tex and r"0.5\,\mathrm{N}" in tex, tex)
_, german, _ = pleuel(["solve", "--lang", "de"], TWO)
check("German: a decimal comma", "0,5 N" in german, german)
document = json.loads(pleuel(["solve", "--json"], TWO)[1])
text = json.dumps(document, ensure_ascii=False)
check("MathML: the unit is upright", '<mi mathvariant=\\"normal\\">kg</mi>' in text, text[:400])
for target in ("sympy", "maxima", "mathematica", "julia", "python", "json"):
    _, out, _ = pleuel(["export", "--to", target], TWO)
    check(f"{target}: numbers, no units", "kg]" not in out and "2 kg" not in out and "phi" in out, out)

# ---------------------------------------------------------------------------------------------- arithmetic
def shown(expression, rest=""):
    model = f"param m = 1 [kg]\ncoord x\naxes x right\nmass A: m at (x)\nforce ({expression}) on A\nask a: solve x''\n" + rest
    code, out, err = pleuel(["solve"], model)
    return out if code == 0 else f"exit {code}: {out}{err}"


for expression, text in (("2 [N] + 30 [cN]", "2.3 N"), ("2 * 3 [N]", "6 N"), ("2 [kg] 3 [m/s^2]", "6 N"), ("2 π [N]", "2 π N"),
                         ("5 [N] - 7 [N]", "-2 N"), ("(1 [m])^2 3 [Pa]", "3 N")):
    out = shown(expression)
    check(f"{expression} is {text}", text.lstrip("-") in out and ("-" in text) == ("-(2 N)" in out or "-2 N" in out), out)
check("a quotient of equal units is a number", "x'' = (1.5 N)/m" in shown("3 [N] (1 [m]/(2 [m]))"), shown("3 [N] (1 [m]/(2 [m]))"))
out = shown("2 [N] + 3 [m]")
check("what cannot be added is refused", "E021" in out, out)

# numbers may make constraints agree, or contradict
CHAIN = """coord x, y, z
axes x right
mass A: 1 [kg] at (x)
mass B: 2 [kg] at (y)
mass C: 3 [kg] at (z)
constraint a: x - y = 1 [m]
constraint b: y - z = 2 [m]
constraint c: x - z = {}, redundant ok
ask dof
"""
code, out, err = pleuel(["solve"], CHAIN.format("3 [m]"))
check("constraints that agree for their numbers are redundant", code == 0 and "says nothing new" in out, out + err)
code, out, err = pleuel(["solve"], CHAIN.format("4 [m]"))
check("those that do not contradict each other", code == 4 and "E042" in err and "1 m + 2 m - 4 m" in err.replace("(", "").replace(")", ""), out + err)
named = "param p = 1 [m], q = 2 [m], s = 3 [m]\n" + CHAIN.replace("1 [m]\n", "p\n").replace("2 [m]\n", "q\n")
code, out, err = pleuel(["solve"], named.format("s"))
check("the same with parameters", code == 0 and "says nothing new" in out, out + err)
# ---------------------------------------------------------------------------------------------- without a unit, beside quantities
code, out, err = pleuel(["solve"], """param m = 75 [kg], R = 20 [m], g = 9.81 [m/s^2]
coord w, θ
axes x right, z up
mass m at ((w - 0.5) sin θ, (w - 0.5) cos θ)
gravity g along -z
constraint hill: w - 0.5 >= R
init w = R + 0.5, θ = 1°, θ' = 0
ask lagrange1 in (w, θ)
""")
check("a bare number beside a length is one, in brackets beside a mass m", code == 0 and "m (w - (0.5 m)) θ''" in out and "N021" in out, out + err)
code, out, err = pleuel(["solve"], """param m = 1 [kg], k = 2 [N/m]
coord x, y
axes x right, y up
mass A: 2 at (x, y)
mass B: m at (x + 1, y)
point O at (1, 0)
spring 3, rest 0.2 between O and A
force (0, 4) on A
drag 0.1 on A
potential k (y - 0.5)^2/2
constraint c: y = 1
ask lagrange1, solve λ_c
""")
shown_all = all(text in out for text in ("2 kg", "1 m", "3 N/m", "0.2 m", "4 N", "0.1 kg/s", "0.5 m"))
check("bare numbers are quantities wherever they stand", code == 0 and shown_all, out + err)
done()
