#!/usr/bin/env python3
"""`expect` decides whether a statement holds on the motion and on the constraints: thirty that do, thirty that do not.

    expect_test.py PROGRAM
"""

import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402

PENDULUM = """param m = 2, l = 1.5, g = 9.81
coord x, y, φ
axes x right, y up
mass P: m at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = l^2
choose φ with x = l sin φ, y = -l cos φ
init φ = 1, φ' = 0
"""
CARTESIAN = """param m = 2, l = 1.5, g = 9.81
coord x, y
axes x right, y up
mass P: m at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = l^2
init x = 1.5, y = 0, x' = 0
"""
CRANK = """param m = 2, r = 0.1, l = 0.3, g = 9.81, k
assume r < l
coord φ, x
axes x right, y up
mass P: m at (x, 0)
mass Q: m at (r cos φ, r sin φ)
gravity g along -y
constraint c: x = r cos φ + sqrt(l^2 - r^2 sin(φ)^2)
choose φ
"""
KEPLER = """param m = 1, G = 2
coord r, φ
axes x right, y up
mass P: m at (r cos φ, r sin φ)
potential -m G/r
"""
FREE = """param a = 1.2, b = 0.7, n
assume a > b
coord x
axes x right
mass P: a at (x)
"""
SKI = """param m = 75, R = 20, g = 9.81
coord r, ϑ
axes x right, z up
mass m at (r sin ϑ, r cos ϑ)
gravity g along -z
constraint h: r >= R with λ
init ϑ = 1°, ϑ' = 0
"""

TRUE = [
    (PENDULUM, "x^2 + y^2 = l^2"),
    (PENDULUM, "x x' + y y' = 0"),
    (PENDULUM, "φ'' = -(g/l) sin φ"),
    (PENDULUM, "φ'' = -2 (g/l) sin(φ/2) cos(φ/2)"),
    (PENDULUM, "T = m l^2 φ'^2/2"),
    (PENDULUM, "x''^2 + y''^2 = l^2 φ'^4 + g^2 sin(φ)^2"),
    (PENDULUM, "λ_rod = -m (x'^2 + y'^2 - g y)/(2 l^2)"),
    (PENDULUM, "V = 2 m g l sin(φ/2)^2 - m g l"),
    (PENDULUM, "E = T + V"),
    (PENDULUM, "x y'' - y x'' = l^2 φ''"),
    (PENDULUM, "tan(φ/2) = sin(φ)/(1 + cos φ)"),
    (PENDULUM, "4 cos(φ)^3 = 3 cos(φ) + cos(3φ)"),
    (CARTESIAN, "x x'' + y y'' = -x'^2 - y'^2"),
    (CARTESIAN, "λ_rod = m (g y - x'^2 - y'^2)/(2 l^2)"),
    (CARTESIAN, "x'' y - y'' x = g x"),
    (CARTESIAN, "(x y' - y x')^2 = l^2 (x'^2 + y'^2)"),
    (CARTESIAN, "x''= -x (x'^2 + y'^2 - g y)/l^2"),
    (CRANK, "(x - r cos φ)^2 + r^2 sin(φ)^2 = l^2"),
    (CRANK, "x' = -r φ' sin φ (1 + r cos φ/sqrt(l^2 - r^2 sin(φ)^2))"),
    (CRANK, "sqrt(l^2 - r^2 sin(φ)^2) = sqrt(l^2 - r^2/2 + r^2/2 cos(2φ))"),
    (CRANK, "(x - r cos φ)(x + r cos φ) = l^2 - r^2 + 2 r cos φ (x - r cos φ) + r^2 cos(φ)^2"),
    (KEPLER, "r'' = r φ'^2 - G/r^2"),
    (KEPLER, "r^2 φ'' + 2 r r' φ' = 0"),
    (KEPLER, "E = m (r'^2 + r^2 φ'^2)/2 - m G/r"),
    (FREE, "sqrt(5 + 2 sqrt(6)) = sqrt(2) + sqrt(3)"),
    (FREE, "sqrt(a) sqrt(b) = sqrt(a b)"),
    (FREE, "asin(b/a) + acos(b/a) = π/2"),
    (FREE, "sqrt(a^2 - 2 a b + b^2) = a - b"),
    (FREE, "sin(acos(b/a)) = sqrt(1 - b^2/a^2)"),
    (FREE, "cosh(x)^2 - sinh(x)^2 = 1"),
    (FREE, "exp(a) exp(x) = exp(a + x)"),
    (FREE, "tan(acos(b/a))^2 = a^2/b^2 - 1"),
    (FREE, "atan(a/b) = π/2 - atan(b/a)"),
    (FREE, "ln(a^2) = 2 ln(a)"),
    (SKI, "λ = m g cos ϑ - m R ϑ'^2"),
    (SKI, "ϑ'' = 2 (g/R) sin(ϑ/2) cos(ϑ/2)"),
]
FALSE = [
    (PENDULUM, "x^2 + y^2 = l"),
    (PENDULUM, "x x' - y y' = 0"),
    (PENDULUM, "φ'' = (g/l) sin φ"),
    (PENDULUM, "φ'' = -(g/l) φ"),
    (PENDULUM, "T = m l^2 φ'^2"),
    (PENDULUM, "x''^2 + y''^2 = l^2 φ'^4"),
    (PENDULUM, "λ_rod = -m (x'^2 + y'^2 + g y)/(2 l^2)"),
    (PENDULUM, "V = 2 m g l sin(φ/2)^2"),
    (PENDULUM, "E = T - V"),
    (PENDULUM, "φ' = 0"),
    (PENDULUM, "φ = 1"),
    (PENDULUM, "tan(φ/2) = sin(φ)/(1 - cos φ)"),
    (PENDULUM, "4 cos(φ)^3 = 3 cos(φ) - cos(3φ)"),
    (PENDULUM, "cos φ = 1 - φ^2/2"),
    (CARTESIAN, "x x'' + y y'' = x'^2 + y'^2"),
    (CARTESIAN, "λ_rod = m (g y - x'^2)/(2 l^2)"),
    (CARTESIAN, "x'' y - y'' x = -g x"),
    (CARTESIAN, "x = l"),
    (CARTESIAN, "x^2 + y^2 = 2 l^2"),
    (CRANK, "(x - r cos φ)^2 + r^2 sin(φ)^2 = r^2"),
    (CRANK, "x' = -r φ' sin φ"),
    (CRANK, "sqrt(l^2 - r^2 sin(φ)^2) = l - r sin φ"),
    (KEPLER, "r'' = r φ'^2 + G/r^2"),
    (KEPLER, "r^2 φ'' - 2 r r' φ' = 0"),
    (KEPLER, "φ'' = 0"),
    (FREE, "sqrt(5 + 2 sqrt(6)) = sqrt(2) + sqrt(3.000001)"),
    (FREE, "sqrt(a + b) = sqrt(a) + sqrt(b)"),
    (FREE, "asin(b/a) - acos(b/a) = π/2"),
    (FREE, "sqrt(a^2 - 2 a b + b^2) = b - a"),
    (FREE, "exp(a) + exp(x) = exp(a + x)"),
    (FREE, "atan(a/b) = π/2 + atan(b/a)"),
    (FREE, "ln(a + b) = ln(a) + ln(b)"),
    (SKI, "λ = m g cos ϑ + m R ϑ'^2"),
    (SKI, "λ = m g"),
]


def ask(model, statement):
    text = model + f"ask expect {statement}\n"
    done = subprocess.run([sys.argv[1], "solve", "--json", "--no-simulation", "-"], input=text.encode(), capture_output=True, timeout=120)
    document = json.loads(done.stdout)
    steps = [s["text"] for items in document["answers"].values() for i in items for s in i["steps"]]
    return done.returncode, document["status"], steps, [n["text"] for n in document.get("errors", [])]


for model, statement in TRUE:
    code, status, steps, errors = ask(model, statement)
    tap.check(f"holds: {statement}", code == 0 and any(": yes" in s for s in steps), f"exit {code}, {status}, {steps}, {errors}")
for model, statement in FALSE:
    code, status, steps, errors = ask(model, statement)
    tap.check(f"does not: {statement}", code == 1 and any(": no, " in s for s in steps), f"exit {code}, {status}, {steps}, {errors}")
tap.done()
