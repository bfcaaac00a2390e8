#!/usr/bin/env python3
"""`where`, `from`, limits and series on small models whose answers follow by hand.

    where_cases_test.py PROGRAM
"""

import json
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402

G = 9.81

SPRING = """param m = 1 [kg], k = 10 [N/m], g = 9.81 [m/s^2]
coord x
axes x up
mass m at (x)
gravity g along -x
potential 1/2 k x^2
init x = 0, x' = -2 [m/s]
"""
# v² = 4 - 2 g x - 10 x²;  x = -A + B cos(w t + p)
SPRING_V = math.sqrt(4 - 2 * G * 0.1 - 10 * 0.01)
SPRING_TURN = -(G + math.sqrt(G * G + 40)) / 10

THROWN = """param m = 1 [kg], h = 10 [m], v0 = 3 [m/s], g = 9.81 [m/s^2]
coord x, y
axes x right, y up
mass m at (x, y)
gravity g along -y
init x = 0, y = h, x' = v0, y' = 0
"""
FALL = math.sqrt(20 / G)

SKI = """param m = 75 [kg], R = 20 [m], g = 9.81 [m/s^2], v0 = 1 [m/s]
coord r, ϑ
axes x right, z up
mass S: m at (r sin ϑ, r cos ϑ)
gravity g along -z
constraint h: r >= R with λ
init ϑ = 0, ϑ' = v0/R
"""
SKI_LIFT = math.acos(2 / 3 + 1 / (3 * G * 20))

COSINE = """param m = 75 [kg], H = 5 [m], b = 8 [m], g = 9.81 [m/s^2], v0 = %s [m/s]
coord x, z
axes x right, z up
mass m at (x, z)
gravity g along -z
constraint Hang: z >= H cos(x/b) with λ
choose x
init x = -2 [m], x' = v0
"""

DRAG = """param m = 75 [kg], R = 20 [m], g = 9.81 [m/s^2], k = 0.3 [kg/m]
coord r, ϑ
axes x right, z up
mass S: m at (r sin ϑ, r cos ϑ)
gravity g along -z
force -k norm(vel(S)) vel(S) on S
constraint h: r >= R with λ
init ϑ = 1°, ϑ' = 0
"""

SPHERE = """param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2], w = 3 [1/s]
coord r, θ, φ
axes x right, y out, z up
mass A: m at (r sin θ cos φ, r sin θ sin φ, -r cos θ)
gravity g along -z
constraint string: r = l
init θ = 60°, θ' = 0, φ = 0, φ' = w
"""

PLANE = """param m = 1, c = %s, g = 9.81
coord x, y
axes x right, y up
mass A: m at (x, y)
gravity g along -y
drag c on A
init x = 0, y = 2, x' = 3, y' = 1
"""

ATWOOD = """param m1%s, m2%s, g%s, l
coord x1, x2
axes x down
mass m1 at (x1)
mass m2 at (x2)
gravity g along x
constraint g1: x1 + x2 = l with λ
"""

HILL = """param m, g, f0, f1, f2, v0
coord x, z
axes x right, z up
mass m at (x, z)
gravity g along -z
constraint Hang: z >= f0 + f1 x + f2 x^2 with λ
choose x
init x = 0, x' = v0
"""

BALL = """param m = 1 [kg], g = 9.81 [m/s^2]
coord x, y
axes x right, y up
mass A: m at (x, y)
gravity g along -y
constraint floor: y >= 0
init x = 0, y = 2 [m], x' = 1 [m/s], y' = 3 [m/s]
"""

CUT = """param l = 0.93, m = 2.33, g = 9.81
coord x, y, φ
axes x right, y up
mass A: m at (x, y)
constraint rod: sqrt(x^2 + y^2) = l
choose φ with x = l sin φ, y = -l cos φ
init φ = 110°, φ' = -1.19
gravity g along -y
event cut: when t = 0.24 -> release rod
"""

PENDULUM = """param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2]
coord φ
axes x right, y up
mass A: m at (l sin φ, -l cos φ)
gravity g along -y
init φ = 60°, φ' = 0
"""

FOURBAR = """param a = 0.1 [m], b = 0.3 [m], c = 0.25 [m], D = 0.3 [m], m = 1 [kg], g = 9.81 [m/s^2], W = 2 [1/s]
coord th2, th3, th4
axes x right, y up
mass B: m at (a cos th2 + b/2 cos th3, a sin th2 + b/2 sin th3)
gravity g along -y
constraint lx: a cos th2 + b cos th3 = D + c cos th4
constraint ly: a sin th2 + b sin th3 = c sin th4
init th2 = 45°, th2' = W
"""


def fourbar(th2):
    x, y = 0.3 - 0.1 * math.cos(th2), -0.1 * math.sin(th2)   # from the coupler's end to the other bearing
    d = math.hypot(x, y)
    spread = math.acos((0.09 - d * d - 0.0625) / (2 * d * 0.25))
    return sorted(math.remainder(math.atan2(y, x) + s * spread, 2 * math.pi) for s in (1, -1))


def drag_lift(k=0.3, m=75, R=20):
    """Where λ = 0 from 1° at rest: u = (R ϑ')² by small steps of du/dϑ = 2 g R sin ϑ - 2 (k R/m) u."""
    q, u, h = math.radians(1), 0.0, 1e-5
    f = lambda q, u: 2 * G * R * math.sin(q) - 2 * k * R / m * u  # noqa: E731
    while G * math.cos(q) > u / R:
        a = f(q, u)
        b = f(q + h / 2, u + h / 2 * a)
        u += h * b
        q += h
    return q



# model, request, numbers in order (None: no number), words that must stand in the steps, words that must not
CASES = [
    (SPRING, "x' where x = 0.1 [m]", [SPRING_V], ["turns round at x = -2.1482"], []),
    (SPRING, "x' where x = -1 [m]", [-math.sqrt(4 + 2 * G - 10)], [], ["turns round"]),
    (SPRING, "x' where x = -5 [m]", [], ["never happens", "turns round"], []),
    (SPRING, "x where x' = 0", [SPRING_TURN], [], []),
    (SPRING, "x'' where x' = 1 [m/s]", [None], [], []),
    (SPRING, "E(0)", [2], [], []),
    (SPRING, "x''(0)", [-G], [], []),
    (SPRING, "limit g -> 0 of x(t)", [None], ["x(t) -> "], ["-> x "]),
    (THROWN, "x where y = 0", [3 * FALL], ["√(2 h/g) v0"], ["x = x"]),
    (THROWN, "t where y = 0", [FALL], [], ["t = t"]),
    (THROWN, "y' where x = 6 [m]", [-2 * G], [], []),
    (THROWN, "y where y' = -5 [m/s]", [10 - 25 / (2 * G)], [], []),
    (THROWN, "y where x = -1 [m]", [], [], ["y = "]),
    (THROWN, "limit g -> 0 of y(t)", [None], ["y(t) -> y(0) + y'(0) t"], []),
    (SKI, "λ_h(0)", [75 * G - 75 / 20], [], []),
    (SKI, "v0 where λ = 0 and ϑ = 0", [math.sqrt(G * 20)], ["√(g R)"], []),
    (SKI, "ϑ where λ = 0", [SKI_LIFT], [], []),
    (SKI, "ϑ' where ϑ = 90°", [], ["h lets go before, at ϑ = 48.059°"], ["ϑ' ="]),
    (SKI, "ϑ where λ = 0 from ϑ = 0 at rest", [math.acos(2 / 3), -math.acos(2 / 3)], ["either side"], []),
    (SKI, "λ where ϑ = 30° from ϑ = 0 at rest", [75 * G * (1.5 * math.sqrt(3) - 2)], [], []),
    (SKI, "expect λ = m g (3 cos ϑ - 2) from ϑ = 0 at rest", [None], [": yes"], []),
    (COSINE % 6, "x where λ = 0 from x = 0 and x' = v0", [], ["never happens"], ["acos"]),
    (COSINE % 12, "x where λ = 0 from x = 0 and x' = v0", [], ["lets go at once"], ["acos"]),
    (DRAG, "ϑ where λ = 0", [drag_lift()], [], []),
    (DRAG, "λ from ϑ = 0 at rest", [None], ["exp(2 R k ϑ/m)", "while ϑ' > 0"], ["ϑ'²"]),
    (SPHERE, "λ_string from θ = 60° and θ' = 0 and φ' = w", [None], ["4 g - 12 g cos θ - 3 l w²"], ["φ'"]),
    (SPHERE, "φ' where θ' = 0", [5.2151651], [], []),
    (PLANE % 0.5, "t where x = 2", [-2 * math.log(1 - 2 * 0.5 / 3)], [], []),
    (PLANE % 0.5, "t where x = 7", [], [], ["t = "]),
    (ATWOOD % (" = 1 [kg]", " = 2 [kg]", " = 9.81 [m/s^2]"), "x1'' where m1 = 3 m2", [G / 2], [], []),
    (ATWOOD % ("", "", ""), "series m1 -> ∞ of x1''", [None], ["g - 2 m2 g (1/m1) + 2 m2² g (1/m1)² + O((1/m1)³)"], ["∞)"]),
    (ATWOOD % ("", "", ""), "series m1 -> ∞ of m1 x1''", [None], ["g m1 - 2 m2 g + 2 m2² g (1/m1)"], ["∞)"]),
    (ATWOOD % ("", "", ""), "series m1 -> 0 of x1''/m1", [None], ["-g m1⁻¹ + 2 g/m2", "O(m1³)"], []),
    (ATWOOD % ("", "", ""), "limit m1 = m2 of x1(t)", [None], ["x1(0) + x1'(0) t"], []),
    (HILL, "v0 where λ = 0 and x = 0", [None, None], ["f2 ≤ 0"], ["No state"]),
    (BALL, "y' where y = 1 [m]", [-math.sqrt(9 + 2 * G)], [], []),
    (BALL, "y where x = 5 [m]", [], ["floor is met before"], ["y ="]),
    (SPRING, "x where x' = 0, x x'", [SPRING_TURN, None], [], []),   # the search leaves no numbers behind
    (CUT, "λ_rod where φ = 0.86", [], ["cut comes before"], ["λ_rod ="]),
    (CUT, "φ' where φ = 1.8", [-math.sqrt(1.19 ** 2 + 2 * G / 0.93 * (math.cos(1.8) - math.cos(math.radians(110))))], [], []),
    (PENDULUM, "φ' where φ = 90°", [], ["never happens", "φ = -60° and at φ = 60°"], []),
    (PENDULUM, "φ' where φ = 0", [-math.sqrt(G)], [], []),
    (PENDULUM, "t where φ = 0", [math.pi / 2 / math.sqrt(G) * 1.0731820071], [], []),   # K(sin 30°)/(π/2)
    (PENDULUM, "φ where φ' = 1 [1/s]", [-math.acos(1 / (2 * G) + 0.5)], ["turns round"], []),
    (PENDULUM, "φ where φ' = 0 from φ = 0 and φ' = 2 sqrt(g/l)", [], ["never happens", "approaches φ = 180°"], []),
    (PENDULUM, "φ' where φ = 450° from φ = 0 and φ' = 7 [1/s]", [math.sqrt(49 - 2 * G)], [], []),
    (PENDULUM, "φ where φ' = 2 [1/s] from φ = 0 and φ' = 7 [1/s]", [], ["never happens"], []),
    (FOURBAR, "th4 where th2 = 60°", fourbar(math.pi / 3), [], []),
]


def ask(model, request):
    text = model + f"ask {request}\n"
    done = subprocess.run([PROGRAM, "solve", "--json", "--no-simulation", "-"], input=text.encode(), capture_output=True, timeout=120)
    document = json.loads(done.stdout)
    items = [i for group in document.get("answers", {}).values() for i in group]
    failed = [c["name"] for c in document.get("checks", []) if not c["passed"]]
    return items, failed + [e["text"] for e in document.get("errors", [])]


def agrees(number, true):
    return true is None or (number is not None and abs(number - true) <= 2e-5 * (1 + abs(true)))


PROGRAM = sys.argv[1]
for model, request, numbers, words, never in CASES:
    items, wrong = ask(model, request)
    got = [v.get("number") for i in items for v in i["values"]]
    text = "\n".join(s["text"] for i in items for s in i["steps"])
    ordered = sorted(x for x in got if x is not None) if request.startswith("th4") else got
    right = len(got) == len(numbers) and all(agrees(x, y) for x, y in zip(ordered, numbers))
    said = all(w in text for w in words) and not any(w in text for w in never)
    tap.check(request, right and said and not wrong, f"{model}{got}, expected {numbers}\n{text}\n{wrong}")
tap.done()
