#!/usr/bin/env python3
"""What a run must not get wrong: events faster than the motion, events without end, rows, energies, roots at rest, dead centres.

Usage: steps_test.py PLEUEL
"""
import json
import math
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])


def call(text, *flags):
    return subprocess.run([program, "sim", "-", *flags], input=text, capture_output=True, text=True,
                          timeout=120)


def table(text, *flags):
    """Rows as dictionaries, the run's exit code and words."""
    ran = call(text, "-o", "-", *flags)
    lines = [line for line in ran.stdout.splitlines() if line and not line.startswith("#")]
    names = [name.split(" ")[0] for name in lines[0].split(",")] if lines else []
    return [dict(zip(names, line.split(","))) for line in lines[1:]], ran.returncode, ran.stderr


def last_line(text, *flags):
    ran = call(text, "-o", "-", *flags)
    return ran.stdout.strip().splitlines()[-1] if ran.stdout.strip() else ran.stderr


# ---- a stroboscope: events are found at their own pace, whatever the steps of the motion
STROBE = """param ω = {}
coord x
axes x right
mass 1 at (x)
potential 1/2 x^2
init x = 1, x' = 0
event strobe: when sin({}) = 0 rising -> record
simulate 0..10
"""
for pace in (20, 40, 100, 1000, 3000):
    for flags in ([], ["--tol", "1e-9"], ["--dt", "1"], ["--method", "radau"], ["--precision", "quad"]):
        if pace > 100 and "quad" in flags:
            continue
        ran = call(STROBE.format(pace, "ω t"), "--json", *flags)
        times = [event["t"] for event in json.loads(ran.stdout)["events"]]
        worst = max(abs(math.sin(pace * t)) for t in times)
        check(f"a strobe {pace} times as fast as the motion, {' '.join(flags) or 'plain'}: every flash, in its place",
              ran.returncode == 0 and len(times) == int(10 * pace / (2 * math.pi)) and worst < 1e-10,
              f"{len(times)} events, worst {worst}\n{ran.stderr}")
# the same by the place: x = cos t
ran = call(STROBE.format(1, "2000 x"), "--json")
times = [event["t"] for event in json.loads(ran.stdout)["events"]]
worst = max(abs(math.sin(2000 * math.cos(t))) for t in times)
# x passes ±1 three times by t = 10, so each half swing from 1 to -1 or back meets every root of sin 2000 x that rises that way
steps, found = 200000, 0
before = math.sin(2000.0)
for k in range(1, steps + 1):
    now = math.sin(2000 * math.cos(10 * k / steps))
    found += before < 0 <= now
    before = now
check("a strobe that depends on the place: every flash, in its place",
      ran.returncode == 0 and len(times) == found and worst < 1e-9, f"{len(times)} of {found}, worst {worst}")

# ---- events that come to an end that they never reach
BOUNCE = """coord x
axes x up
mass 1 at (x)
gravity 10 along -x
init x = 1, x' = 0
event bounce: when x = 0 falling -> x' = -{} x'
simulate 0..200
"""
for part in (0.5, 0.9):
    for flags in ([], ["--dt", "1"], ["--method", "radau"]):
        rows, code, told = table(BOUNCE.format(part), *flags)
        end = math.sqrt(0.2) * (1 + 2 * part / (1 - part))
        lowest = min(float(row["x"]) for row in rows)
        named = [float(word) for word in told.split("t = ")[-1].split(",")[0].split()[:1]]
        check(f"a ball that an event throws back with {part} of its velocity, {' '.join(flags) or 'plain'}: stops with a sentence",
              code == 6 and "without end" in told and lowest > -1e-9 and named and abs(named[0] - end) < 1e-6,
              f"lowest {lowest}, end {end}\n{told}")
CONTACT = """param e = 0.99
coord x
axes x up
mass 1 at (x)
gravity 10 along -x
constraint floor: x >= 0
restitution e on floor
init x = 1, x' = 0
simulate 0..200
"""
ran = call(CONTACT, "--json")
check("a ball that bounces is not stiff", ran.returncode == 0 and "implicit" not in call(CONTACT).stdout, ran.stdout[-300:])

# ---- rows are rows
GENEVA = """param r = 0.05 [m], D = 0.08 [m], J = 0.001 [kg m^2], Ω = 6 [rad/s], ρ = 0.004 [m]
coord φ, ψ
axes x right, y up
point pin at (r cos φ, r sin φ)
body wheel: mass 0.1 [kg], inertia J at (D, 0) angle ψ
constraint drive: φ = Ω t
constraint contact: (x(pin) - D) sin ψ - y(pin) cos ψ >= ρ
restitution 0.1 on contact
init φ = 0, ψ = -15°, ψ' = 0
simulate 0..2 [s]
"""
SWING = """coord a, b
axes x right, y up
mass A: 1 at (sin a, -cos a)
mass B: 1 at (sin a + sin b, -cos a - cos b)
gravity 9.81 along -y
init a = 90°, b = 20°, a' = 0, b' = 0
event through: when a = 0 -> record
event kick: when t = 1.3 -> b' = b' + 1
simulate 0..5
"""
SLIDE = """coord x, y
axes x right, y up
mass B: 1 at (x, y)
gravity 9.81 along x
force -2 norm(vel(B)) vel(B) on B
init x = 0, x' = 0, y = 0, y' = 0
simulate 0..3
"""
for name, text in (("a pin in a slot", GENEVA), ("a pendulum with events", SWING), ("a fall with drag", SLIDE),
                   ("a ball", CONTACT.replace("200", "20").replace("0.99", "0.7"))):
    ends = {flags: last_line(text, *flags.split()) for flags in ("", "--dt 0.01", "--dt 0.1", "--dt 0.37", "--dt 2")}
    check(f"{name}: the end does not depend on the rows", len(set(ends.values())) == 1 and "," in ends[""], ends)

# ---- energies: T2 - T0 + V is conserved, whatever else T or L contain
FIELD = "coord r, s\n{}\ninit r = 1, r' = 0.3, s = 0.5, s' = -0.2\nsimulate 0..5\n"
KINDS = {
    "kinetic energy with a part of degree 0": ("kinetic 1/2 (r'^2 + s'^2 + 4 r^2)\npotential 9/2 (r^2 + s^2)",
                                               lambda r, s, v, w: ((v * v + w * w) / 2 + 2 * r * r, 4.5 * (r * r + s * s), -4 * r * r)),
    "kinetic energy with a part of degree 1": ("kinetic 1/2 (r'^2 + s'^2) + r s' + s r'/3\npotential 9/2 (r^2 + s^2)",
                                               lambda r, s, v, w: ((v * v + w * w) / 2 + r * w + s * v / 3, 4.5 * (r * r + s * s),
                                                                   -r * w - s * v / 3)),
    "a Lagrange function": ("lagrangian 1/2 (r'^2 + s'^2) + 2 r^2 + r s' - 9/2 (r^2 + s^2)",
                            lambda r, s, v, w: ((v * v + w * w) / 2, 4.5 * (r * r + s * s) - 2 * r * r, 0)),
}
for name, (text, energies) in KINDS.items():
    for flags in ([], ["--method", "radau"], ["--precision", "quad"]):
        rows, code, told = table(FIELD.format(text), "--dt", "1", *flags)
        worst = drift = 0.0
        for row in rows:
            state = [float(row[key]) for key in ("r", "s", "r_dot", "s_dot")]
            T, V, more = energies(*state)
            shown = [float(row[key]) for key in "TVE"]
            worst = max([worst] + [abs(a - b) for a, b in zip(shown, (T, V, T + V + more))])
            drift = max(drift, abs(shown[2] - float(rows[0]["E"])))
        check(f"{name}, {' '.join(flags) or 'plain'}: T, V and E are right, E is conserved, the run goes on",
              code == 0 and len(rows) == 6 and worst < 1e-12 and drift < 1e-10, f"off {worst}, drift {drift}\n{told}")

# ---- a root at rest: drag with the square of the velocity
vt = math.sqrt(9.81 / 2)
fall = vt * vt / 9.81 * math.log(math.cosh(9.81 * 3 / vt))
for flags, limit in ((["--tol", "1e-9"], 1e-8), ([], 1e-13), (["--engine", "compiled"], 1e-13), (["--method", "radau"], 1e-9),
                     (["--precision", "long"], 1e-14)):
    rows, code, told = table(SLIDE, *flags)
    off = abs(float(rows[-1]["x"]) - fall) if rows else math.inf
    check(f"a fall from rest with quadratic drag, {' '.join(flags) or 'plain'}", code == 0 and off < limit, f"{off}\n{told}")


def swing_with_drag(angle, until, steps):
    def slope(y):
        return y[1], -9.81 * math.sin(y[0]) - 0.3 * abs(y[1]) * y[1]
    y, h = (angle, 0.0), until / steps
    for _ in range(steps):
        a = slope(y)
        b = slope((y[0] + h / 2 * a[0], y[1] + h / 2 * a[1]))
        c = slope((y[0] + h / 2 * b[0], y[1] + h / 2 * b[1]))
        d = slope((y[0] + h * c[0], y[1] + h * c[1]))
        y = tuple(y[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) for i in (0, 1))
    return y


TURNS = {
    "in its angle": "coord p\naxes x right, y up\nmass S: 1 at (sin p, -cos p)\ninit p = 2, p' = 0\noutput X = sin p",
    "with its rod": "coord x, y\naxes x right, y up\nmass S: 1 at (x, y)\nconstraint rod: x^2 + y^2 = 1\n"
                    "init x = sin(2), y = -cos(2), x' = 0, y' = 0\noutput X = x",
}
angle = swing_with_drag(2.0, 10, 40000)[0]
for name, text in TURNS.items():
    text += "\ngravity 9.81 along -y\nforce -0.3 norm(vel(S)) vel(S) on S\nsimulate 0..10\n"
    for flags, limit in ((["--tol", "1e-9"], 1e-6), ([], 1e-9), (["--method", "radau"], 1e-8)):
        rows, code, told = table(text, *flags)
        off = abs(float(rows[-1]["X"]) - math.sin(angle)) if rows else math.inf
        check(f"a pendulum with quadratic drag turns round, {name}, {' '.join(flags) or 'plain'}",
              code == 0 and off < limit, f"{off}\n{told}")

# ---- dead centres: the slider rests for a moment and does not stick
CRANK = """param m1 = 1, m2 = 2, r = 0.1, l = 0.3, g = 9.81, μ = 0.2
coord φ, x2, z2
axes x right, z up
mass A: m1 at (r cos φ, r sin φ)
mass B: m2 at (x2, z2)
gravity g along -z
constraint guide: z2 = {offset}
constraint rod: (x2 - r cos φ)^2 + (z2 - r sin φ)^2 = l^2
branch x2 > r cos φ
{rest}
"""


def without_friction_law(offset, start):
    """φ'' from the power of all forces, with |λ_guide| in the friction, by Runge and Kutta; the reference of the crank."""
    r, l, m1, m2, g, mu = 0.1, 0.3, 1.0, 2.0, 9.81, 0.2

    def geometry(p):
        u = offset - r * math.sin(p)
        root = math.sqrt(l * l - u * u)
        x1 = -r * math.sin(p) + u * r * math.cos(p) / root
        du = -r * math.cos(p)
        d_root = -u * du / root
        x2 = -r * math.cos(p) + ((du * r * math.cos(p) - u * r * math.sin(p)) * root - u * r * math.cos(p) * d_root) / root ** 2
        return root, u, x1, x2

    def slope(y):
        p, w = y
        root, u, k, dk = geometry(p)
        sense = 1 if k * w > 0 else -1
        # forces on the slider: along x m2 x'' = S root/l - sense mu |N|, across 0 = -m2 g + S u/l + N; S pulls along the rod
        # the crank: m1 r² φ'' = -m1 g r cos φ + torque of -S
        best = None
        for press in (1, -1):
            # unknowns φ'', S, N
            # m2 (k φ'' + dk w²) = S root/l - sense mu press N
            # N = m2 g - S u/l
            # m1 r² φ'' = -m1 g r cos φ - S (root (-r sin φ) + u r cos φ)/l
            arm = (root * -r * math.sin(p) + u * r * math.cos(p)) / l
            c = root / l + sense * mu * press * u / l
            d = -sense * mu * press * m2 * g
            # m2 k φ'' - c S = d - m2 dk w² ;  m1 r² φ'' + arm S = -m1 g r cos φ
            right1, right2 = d - m2 * dk * w * w, -m1 * g * r * math.cos(p)
            det = m2 * k * arm + c * m1 * r * r
            a = (right1 * arm + c * right2) / det
            S = (m2 * k * right2 - m1 * r * r * right1) / det
            N = m2 * g - S * u / l
            if N * press >= 0:
                best = a
        return w, best

    y, until, steps = start, 1.0, 200000
    h = until / steps
    for _ in range(steps):
        a = slope(y)
        b = slope((y[0] + h / 2 * a[0], y[1] + h / 2 * a[1]))
        c = slope((y[0] + h / 2 * b[0], y[1] + h / 2 * b[1]))
        d = slope((y[0] + h * c[0], y[1] + h * c[1]))
        y = tuple(y[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) for i in (0, 1))
    return y


for offset in (0, 0.05):
    text = CRANK.format(offset=offset, rest="friction μ on guide\ninit φ = 30°, φ' = 20\nsimulate 0..1")
    rows, code, told = table(text)
    want = without_friction_law(offset, (math.radians(30), 20.0))
    off = abs(float(rows[-1]["phi"]) - want[0]) if rows else math.inf
    check(f"a crank with friction passes its dead centres, guide at {offset}", code == 0 and off < 1e-4, f"{off} {want}\n{told}")
    driven = CRANK.format(offset=offset, rest="friction μ on guide\nconstraint drive: φ = 50 t\nsimulate 0..0.5")
    rows, code, told = table(driven)
    check(f"a driven crank with friction passes its dead centres, guide at {offset}",
          code == 0 and rows and float(rows[-1]["t"]) == 0.5, told)

# ---- multipliers where most of the coordinates carry no mass: the drive's power is the change of the energy
FOURBAR = """param a = 0.1, b = 0.3, c = 0.25, d = 0.3, g = 9.81
coord α, β, γ
axes x right, y up
mass B: 1 at (a cos α + b cos β, a sin α + b sin β)
gravity g along -y
constraint drive: α = 5 t with M
constraint lx: a cos α + b cos β - c cos γ = d
constraint ly: a sin α + b sin β - c sin γ = 0
branch sin β > 0
simulate 0..1
"""
rows, code, told = table(FOURBAR, "--dt", "0.001")
E, M = [float(row["E"]) for row in rows], [float(row["lambda_drive"]) for row in rows]
worst = max(abs((E[i + 1] - E[i - 1]) / 0.002 / 5 - M[i]) for i in range(1, len(E) - 1))
check("the torque of a driven four-bar linkage without mass in two of its bars is the power over the speed",
      code == 0 and worst < 1e-3 and max(map(abs, M)) < 2, f"{worst}\n{told}")

# ---- what stays where it is, and what runs away
STILL = """coord a, b, c
axes x right, y up
mass P: 1 at (sin a, -cos a)
mass Q: 1 at (sin a + sin b, -cos a - cos b)
mass R: 1 at (sin a + sin b + sin c, -cos a - cos b - cos c)
gravity 9.81 along -y
constraint c1: a = 0.1
constraint c2: a + b = 0.2
constraint c3: a + b + c = 0.3
init a' = 0
simulate 0..1
"""
rows, code, told = table(STILL)
check("a system without freedom rests to the end", code == 0 and float(rows[-1]["t"]) == 1, told)
rows, code, told = table("coord x\naxes x right\nmass 1 at (x)\npotential -x^4\ninit x = 1, x' = 0\nsimulate 0..10\n")
check("a motion that runs to infinity is told as that", code == 6 and "runs away" in told and "0.92703" in told, told)

done()
