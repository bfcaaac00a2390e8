#!/usr/bin/env python3
"""Derivatives of motions by parameters and start values, `pleuel sim --sensitivities`, against closed forms and against central
differences of runs at moved values: (f(h) - f(-h)) / 2h at h, 2h, 4h, extrapolated twice (Richardson), so that their
own error is h^6 and rounding over h.  Usage: sensitivity_test.py PLEUEL
"""
import csv
import io
import math
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])


def sim(text, *flags):
    run = subprocess.run([program, "sim", "-", "-o", "-", *flags], input=text, capture_output=True, text=True, timeout=100)
    if run.returncode != 0:
        return None, run.stderr
    rows = list(csv.reader(io.StringIO(run.stdout)))
    names = [re.sub(r" \[[^\]]*\]$", "", n) for n in rows[0]]
    return [dict(zip(names, row)) for row in rows[1:]], run.stderr


def near(what, row, want, tolerance):
    if row is None:
        check(what, False, "no rows")
        return
    scale = max([abs(v) for v in want.values()] + [1e-300])
    off = max((abs(float(row.get(n, "nan")) - v) / scale if n in row else math.inf, n) for n, v in want.items())
    check(f"{what}, to {tolerance:g}", off[0] <= tolerance, f"off by {off[0]:.2e} at {off[1]}: want {want}\ngot {row}")


# ------------------------------------------------------------------------------------------------ closed forms
oscillator = """
param k = 3, m = 2, A = 0.7
coord x
axes x right
mass m at (x)
potential 1/2 k x^2
init x = A, x' = 0
simulate 0..5
"""
rows, said = sim(oscillator, "--sensitivities", "k,m,A,x0,x_dot0")
w = math.sqrt(1.5)
s, c = math.sin(5 * w), math.cos(5 * w)
want = {
    "d(x)/d(k)": -0.7 * s * 5 * w / (2 * 3), "d(x)/d(m)": 0.7 * s * 5 * w / (2 * 2), "d(x)/d(A)": c, "d(x)/d(x0)": c,
    "d(x)/d(x_dot0)": s / w, "d(x_dot)/d(x0)": -w * s, "d(x_dot)/d(x_dot0)": c,
    "d(x_dot)/d(k)": -0.7 * w / 6 * s - 0.7 * w * c * 5 * w / 6,
}
near("an oscillator, by stiffness, mass and start", rows and rows[-1], want, 1e-13)

atwood = """
param m1 = 3 [kg], m2 = 2 [kg], g = 9.81 [m/s^2], L = 3.7 [m]
coord x1, x2
axes x down
mass m1 at (x1)
mass m2 at (x2)
gravity g along x
constraint rope: x1 + x2 = L
init x1 = 1, x1' = 0
simulate 0..1.2
"""
rows, said = sim(atwood, "--sensitivities", "m1,m2,L,x10")
M = 5.0
want = {
    "d(x1)/d(m1)": 0.72 * 9.81 * 2 * 2 / M**2, "d(x1)/d(m2)": -0.72 * 9.81 * 2 * 3 / M**2, "d(x2)/d(L)": 1.0, "d(x1)/d(L)": 0.0,
    "d(x1)/d(x10)": 1.0, "d(x2)/d(x10)": -1.0, "d(lambda_rope)/d(m1)": -2 * 9.81 * 2**2 / M**2,
    "d(lambda_rope)/d(m2)": -2 * 9.81 * 3**2 / M**2, "d(lambda_rope)/d(L)": 0.0,
}
near("two masses on a rope, multiplier included", rows and rows[-1], want, 1e-13)

knife = """
param a = 4.905, ω = 2
coord x, y, φ
axes x down, y right
mass 1 at (x, y)
kinetic 1/2 φ'^2
gravity a along x
constraint blade: x' sin φ - y' cos φ = 0
init x = 0, y = 0, φ = 0, x' = 0, y' = 0, φ' = ω
simulate 0..3
"""
rows, said = sim(knife, "--sensitivities", "a,ω")
T, W, A = 3.0, 2.0, 4.905
# x = a/(2 ω²) sin² ω t, y = a/(2 ω²) (ω t - sin(2 ω t)/2), φ = ω t
S, C2, S2 = math.sin(W * T), math.cos(2 * W * T), math.sin(2 * W * T)
want = {
    "d(x)/d(a)": S * S / (2 * W * W), "d(y)/d(a)": (W * T - S2 / 2) / (2 * W * W),
    "d(x)/d(omega)": -A / W**3 * S * S + A / (2 * W * W) * T * S2,
    "d(y)/d(omega)": -A / W**3 * (W * T - S2 / 2) + A / (2 * W * W) * (T - T * C2), "d(phi)/d(omega)": T,
}
near("a skate, with its constraint on velocities", rows and rows[-1], want, 1e-12)

bouncing = """
param e = 0.7, H = 5, g = 10
coord x, y
axes x right, y up
mass 2 at (x, y)
gravity g along -y
constraint floor: y >= 0
restitution e on floor
init x = 0, x' = 1, y = H, y' = 0
simulate 0..4
"""
rows, said = sim(bouncing, "--sensitivities", "e,H,y0,x_dot0")
e, H, g = 0.7, 5.0, 10.0
t0, u0 = math.sqrt(2 * H / g), math.sqrt(2 * g * H)       # the first impact, its speed; the third ends at T
T, u = t0 * (1 + 2 * e + 2 * e * e), e**3 * u0
dT = {"e": t0 * (2 + 4 * e), "H": (1 + 2 * e + 2 * e * e) / (g * t0)}
du = {"e": 3 * e * e * u0, "H": e**3 * g / u0}
want = {"d(x)/d(x_dot0)": 4.0, "d(y)/d(x_dot0)": 0.0}
for n, of in (("e", "e"), ("H", "H"), ("y0", "H")):
    want[f"d(y)/d({n})"] = du[of] * (4 - T) - (u - g * (4 - T)) * dT[of]
    want[f"d(y_dot)/d({n})"] = du[of] + g * dT[of]
near("a ball after three bounces, by restitution and height", rows and rows[-1], want, 1e-13)

hit = """
param g = 10, v = 20, α = 0.6, b = 0
coord x, y
axes x right, y up
mass 2 at (x, y)
gravity g along -y
event top: when y' = b falling -> x' = 2 x'
init x = 0, x' = v cos α, y = 0, y' = v sin α
simulate 0..2
"""
rows, said = sim(hit, "--sensitivities", "v,α,b")
v, a, up = 20.0, 0.6, 2.0          # after the top the velocity is doubled: x = v cos α (2 t - t*), t* = (v sin α - b) / g
t = v * math.sin(a) / 10
want = {"d(x)/d(v)": math.cos(a) * (4 - t) - v * math.cos(a) * math.sin(a) / 10,
        "d(x)/d(alpha)": -v * math.sin(a) * (4 - t) - v * math.cos(a) * v * math.cos(a) / 10, "d(x)/d(b)": v * math.cos(a) / 10,
        "d(y)/d(v)": 2 * math.sin(a), "d(x_dot)/d(v)": 2 * math.cos(a)}
near("a throw that is doubled at its top", rows and rows[-1], want, 1e-13)

# ------------------------------------------------------------------------------------------------ differences
models = {
    "a pendulum in Cartesian coordinates, released at an angle that is a parameter": ("""
param l = 2, g = 9.81, m = 3, α = 1
coord x, y
axes x right, y down
mass m at (x, y)
gravity g along y
constraint rod: x^2 + y^2 = l^2
init x = l sin α, y = l cos α, x' = 0, y' = 0
simulate 0..3
""", {"l": 2, "g": 9.81, "m": 3, "α": 1}),
    "a spring and damper between masses, a force of time, derived parameters": ("""
param k = 5, ζ = 0.1, m = 1.5
let c = 2 ζ sqrt(k m)
coord x, y
axes x right, y up
mass A: m at (x, y)
mass B: 2 m at (1 + 0.3 sin y, 0)
point O at (0, 0)
spring k, rest 1 between A and O
damper c between A and O
gravity 9.81 along -y
init x = 1 + m/10, y = 0.2, x' = 0.3, y' = 0
simulate 0..2
""", {"k": 5, "ζ": 0.1, "m": 1.5}),
    "a sphere pendulum with a driven length": ("""
param l = 1, b = 0.2, g = 9.81
coord x, y, z
axes x right, y out, z up
mass 1 at (x, y, z)
gravity g along -z
constraint rod: x^2 + y^2 + z^2 = (l + b sin(2 t))^2
init x = l/2, y = l/2, z = -l/sqrt(2), x' = 0, y' = 1
simulate 0..2
""", {"l": 1, "b": 0.2, "g": 9.81}),
    "a chain as a family": ("""
param N = 6, k = 40, m = 0.2
coord x[0..N], y[0..N]
axes x right, y up
for i in 1..N { mass m at (x[i], y[i]) }
gravity 9.81 along -y
for i in 1..N { potential k/2 (sqrt((x[i] - x[i-1])^2 + (y[i] - y[i-1])^2) - 1)^2 }
constraint left: x[0] = 0
constraint pin: y[0] = 0
for i in 0..N { init x[i] = i, y[i] = 0 }
for i in 0..N { init x[i]' = 0, y[i]' = 0 }
simulate 0..0.7
""", {"k": 40, "m": 0.2}),
    "a cut pendulum that bounces on a moving slope, and is kicked": ("""
param m = 2, g = 10, l = 1, x0 = 0.6, β = 0.3, e = 0.6, w = 0.4
coord x, y
axes x right, y up
mass A: m at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = l^2
constraint floor: y - β x + 1.5 + 0.1 sin(3 t) >= 0
restitution e on floor
event cut: when x = x0 rising -> release rod
event kick: when t = 1.1 -> x' = x' + 2 y^2 + m
init x = -0.9 l, x' = 0
guess y = -0.4
simulate 0..1.4
""", {"m": 2, "g": 10, "l": 1, "x0": 0.6, "β": 0.3, "e": 0.6}),
    "a rod that falls on its ends": ("""
param m = 2, l = 1, g = 10, e = 0.4, θ = 0.5, H = 2
coord x, y, φ
axes x right, y up
body rod: mass m, inertia m l^2/12 at (x, y) angle φ
gravity g along -y
constraint floor: y - l/2 sin φ >= 0
restitution e on floor
init x = 0, y = H, φ = θ, x' = 1, y' = 0, φ' = 0.3
simulate 0..0.9
""", {"l": 1, "g": 10, "e": 0.4, "θ": 0.5, "H": 2}),
    "a double pendulum that hits a wall": ("""
param l = 1, g = 10, e = 0.4, H = 0.3, k = 2
coord α, β
axes x right, y down
mass A: 1 at (l sin α, l cos α)
mass B: k at (l sin α + l sin β, l cos α + l cos β)
gravity g along y
constraint wall: l sin α + l sin β >= -H
restitution e on wall
init α = 0.4, β = 0.7, α' = 0, β' = 0
simulate 0..1.6
""", {"l": 1, "g": 10, "e": 0.4, "H": 0.3, "k": 2}),
    "a rope that goes slack and taut": ("""
param l = 1, g = 10, V = 6
coord x, y
axes x right, y down
mass A: 1 at (x, y)
gravity g along y
constraint rope: x^2 + y^2 <= l^2
init x = 0, y = l, x' = V, y' = 0
simulate 0..1.5
""", {"l": 1, "g": 10, "V": 6}),
    "a skier who takes off": ("""
param R = 20, m = 75, g = 9.81, a = 0.3, L = 2
coord r, ϑ
axes x right, z up
mass A: m at (r sin ϑ, r cos ϑ)
gravity g along -z
constraint h: r >= R
init ϑ = a, ϑ' = 0
simulate 0..3.5
""", {"R": 20, "g": 9.81, "a": 0.3}),
    "a ball that comes to rest on a slope": ("""
param g = 10, e = 0.5, H = 5, u = 1, β = 0.1
coord x, y
axes x right, y up
mass A: 2 at (x, y)
gravity g along -y
constraint floor: y - β x >= 0
restitution e on floor
init x = 0, x' = u, y = H, y' = 0
simulate 0..4
""", {"g": 10, "H": 5, "u": 1, "β": 0.1}),
}


def difference(text, name, value, key):
    def at(x):
        rows, _ = sim(text, "--set", f"{name}={x!r}")
        return {n: float(v) for n, v in rows[-1].items() if n not in ("t", "mode") and v}

    h, level = abs(value) * 2e-3, []
    for k in (1, 2, 4):
        up, down = at(value + k * h), at(value - k * h)
        level.append({n: (up[n] - down[n]) / (2 * k * h) for n in up})
    one = [{n: (4 * a[n] - b[n]) / 3 for n in a} for a, b in zip(level, level[1:])]
    return {f"d({n})/d({key})": (16 * one[0][n] - one[1][n]) / 15 for n in one[0]}


ascii_name = {"α": "alpha", "ζ": "zeta", "β": "beta", "θ": "theta"}
for what, (text, values) in models.items():
    rows, said = sim(text, "--sensitivities", ",".join(values))
    if rows is None:
        check(what, False, said)
        continue
    for name, value in values.items():
        want = difference(text, name, value, ascii_name.get(name, name))
        want = {n: v for n, v in want.items() if n in rows[-1]}
        check(f"{what}: columns for {name}", len(want) >= 2, str(sorted(rows[-1])))
        near(f"{what}: by {name}", rows[-1], want, 1e-9)
    plain, _ = sim(text)
    same = {n: float(v) for n, v in plain[-1].items() if n not in ("mode",) and v}
    near(f"{what}: the motion itself is the same", rows[-1], same, 1e-11)

# ------------------------------------------------------------------------------------------------ limits
rubs = """
coord x, y
axes x right, y up
mass 1 at (x, y)
gravity 9.81 along -y
constraint floor: y >= 0
friction 0.2 on floor
init x = 0, x' = 1, y = 1, y' = 0
simulate 0..2
"""
for text, names, word in ((rubs, "y0", "friction"), (oscillator, "q", "no sensitivity to q"), (oscillator, "k,k", "twice"),
                          (atwood, "x20", "no start value"), (oscillator, " , ", "to what")):
    rows, said = sim(text, "--sensitivities", names)
    check(f"--sensitivities {names!r}: a sentence says why not", rows is None and word in said, said)

# what has no derivative is told when it happens: a corner that is met with both sides at once, a floor that is only grazed
corner = """
coord x, y
axes x right, y up
mass 1 at (x, y)
constraint floor: y >= 0
constraint wall: x <= 2
init x = 0, x' = 1, y = 2, y' = -1
simulate 0..4
"""
grazing = """
param h = 1/8
coord x, y
axes x right, y up
mass 1 at (x, y)
gravity 1 along y
constraint floor: y >= 1 - h
init x = 0, x' = 1, y = 1, y' = -1/2
simulate 0..4
"""
for text, names, word in ((corner, "y0", "together"), (grazing, "h", "grazed")):
    run = subprocess.run([program, "sim", "-", "-o", "-", "--sensitivities", names], input=text, capture_output=True, text=True, timeout=100)
    check(f"no derivative: {word}", run.returncode != 0 and word in run.stderr, run.stderr)
done()
