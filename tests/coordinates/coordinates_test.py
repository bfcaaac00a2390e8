#!/usr/bin/env python3
"""One mechanism in many spellings: polar, Cartesian, tied, in any order and sign.  Where no coordinate is chosen pleuel proposes one; the
answers are the same.  What is true comes from mechanics by hand, never from another spelling."""

import math
import os
import random
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "founding"))
from sheet import *  # noqa: E402
from sheet import SEED  # noqa: E402

test = Tests()
FOLDER = tempfile.TemporaryDirectory()


def solve(program, text, *flags):
    path = os.path.join(FOLDER.name, f"{abs(hash(text)):x}.pleuel")
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)
    return run(program, path, "--no-simulation", *flags)


def certified(answer, title):
    checks = answer.document["checks"]
    need(checks and all(c["passed"] for c in checks), f"{title}: own checks failed: {checks}")


def evaluated(answer, value, names):
    """The value at a state of the model's own coordinates: angles that were proposed are defined beside it."""
    known = {"pi": math.pi, **answer.parameters(), **names}
    return Formula(value["expr"]).value(bind(value, known))


def same(got, wanted, what):
    need(close(got, wanted, 1e-9, 1e-9), f"{what} is {got}, not {wanted}")


def rests(answer):
    """The positions of rest, each once, also where it takes several coordinates to name it."""
    return [v for v in answer.values() if v["name"].startswith("equilibrium")]


# ------------------------------------------------------------------------------------------------ pendulum
PENDULUM = "param m = 1.3 [kg], l = 0.7 [m], g = 9.81 [m/s^2], a = 0.2 [m]\n"
RIGHT_UP = "axes x right, y up\nmass A: m at (x, y)\ngravity g along -y\n"
START = "init x = 0.42 [m], y = -0.56 [m], x' = 0, y' = 0\n"
pendulums = {   # text, the state at the angle θ from below, force of the rod along x and y
    "squares": ("coord x, y\n" + RIGHT_UP + "constraint rod: x^2 + y^2 = l^2\n" + START, lambda s, c: (s, -c)),
    "a distance": ("coord x, y\n" + RIGHT_UP + "constraint rod: norm(pos(A)) = l\n" + START, lambda s, c: (s, -c)),
    "scaled": ("coord x, y\n" + RIGHT_UP + "constraint rod: (x/l)^2 + (y/l)^2 = 1\n" + START, lambda s, c: (s, -c)),
    "turned round": ("coord y, x\n" + RIGHT_UP + "constraint rod: l^2 - y^2 = x^2\n" + START, lambda s, c: (s, -c)),
    "fourth powers": ("coord x, y\n" + RIGHT_UP + "constraint rod: (x^2 + y^2)^2 = l^4\n" + START, lambda s, c: (s, -c)),
    "depth": ("coord x, y\naxes x right, y down\nmass A: m at (x, y)\ngravity g along y\nconstraint rod: x^2 + y^2 = l^2\n"
              "init x = 0.42 [m], y = 0.56 [m], x' = 0, y' = 0\n", lambda s, c: (s, c)),
    "tied": ("coord β, x, y\n" + RIGHT_UP + "constraint c1: x = l sin β\nconstraint c2: y = -l cos β\n" + START, None),
    "shifted": ("coord x, y\n" + RIGHT_UP + "constraint rod: (x - a)^2 + (y + a)^2 = l^2\n"
                "init x = 0.62 [m], y = -0.76 [m], x' = 0, y' = 0\n", lambda s, c: (s, -c)),
}


def pendulum_state(title, theta, omega):
    l, a = 0.7, 0.2
    s, c = math.sin(theta), math.cos(theta)
    if title == "depth":
        return dict(x=l * s, y=l * c, x_dot=l * c * omega, y_dot=-l * s * omega)
    x0, y0 = (a, -a) if title == "shifted" else (0, 0)
    return dict(x=x0 + l * s, y=y0 - l * c, x_dot=l * c * omega, y_dot=l * s * omega, beta=theta, beta_dot=omega)


@test("pendulum: the acceleration of the angle, its positions of rest and its frequency in every spelling")
def _(program):
    rng = random.Random(SEED)
    for title, (text, _) in pendulums.items():
        answer = solve(program, PENDULUM + text + "ask a: lagrangian, lagrange2\nask b: equilibria\n")
        certified(answer, title)
        angle = [v for v in answer.values(key="a") if v["name"].endswith("_ddot")]
        need(len(angle) == 1, f"{title}: {[v['name'] for v in answer.values(key='a')]}")
        for _ in range(5):
            theta, omega = rng.uniform(-3, 3), rng.uniform(-2, 2)
            state = pendulum_state(title, theta, omega)
            same(abs(evaluated(answer, angle[0], state)), abs(9.81 / 0.7 * math.sin(theta)), f"{title}: {angle[0]['name']}")
            T = answer.value("T", key="a")
            same(evaluated(answer, T, state), 1.3 / 2 * (0.7 * omega) ** 2, f"{title}: T")
        rest = rests(answer)
        need(sorted(v["stability"] for v in rest) == ["stable", "unstable"], f"{title}: {[v.get('stability') for v in rest]}")
        slow = answer.values("omega^2", key="b")
        same(evaluated(answer, slow[0], {}), 9.81 / 0.7, f"{title}: frequency")


@test("pendulum: the force of the rod on a motion that is named in Cartesian coordinates")
def _(program):
    rng = random.Random(SEED)
    for title, (text, outward) in pendulums.items():
        if outward is None or title == "shifted":
            continue
        answer = solve(program, PENDULUM + text + "ask d: force of rod from x = l and y = 0 at rest\n")
        certified(answer, title)
        value = [v for v in answer.values(key="d") if v.get("components")][0]
        for _ in range(5):
            theta = rng.uniform(-1.2, 1.2)
            state = pendulum_state(title, theta, 0)
            push = -3 * 1.3 * 9.81 * math.cos(theta)      # from rest at the height of the pivot
            e = outward(math.sin(theta), math.cos(theta))
            known = bind(value, {"pi": math.pi, **answer.parameters(), **state})
            for k, along in enumerate(("e_x", "e_y")):
                same(Formula(component(value, along)).value(known), push * e[k], f"{title}: Z {along}")


@test("pendulum: the modes about a place that is named in Cartesian coordinates")
def _(program):
    for title, place in (("squares", "x = 0, y = -l"), ("depth", "x = 0, y = l"), ("turned round", "y = -l, x = 0")):
        answer = solve(program, PENDULUM + pendulums[title][0] + f"ask modes at ({place})\n")
        found = answer.values("omega^2")
        need(len(found) == 1, f"{title}: {len(found)} frequencies")
        same(evaluated(answer, found[0], {}), 9.81 / 0.7, f"{title}: frequency")


@test("pendulum: what `choose` names in its maps needs no declaration, and its own choice wins")
def _(program):
    for declared in ("coord x, y, th\n", "coord x, y\n"):
        text = declared + RIGHT_UP + "constraint rod: x^2 + y^2 = l^2\nchoose th with x = l sin th, y = -l cos th\n" + START
        answer = solve(program, PENDULUM + text + "ask a: lagrange2, equilibria\n")
        certified(answer, declared)
        angle = answer.value("th_ddot", key="a")
        same(Formula(angle["expr"]).value({**answer.parameters(), "th": 0.4}), -9.81 / 0.7 * math.sin(0.4), f"{declared}: th''")
        need("where" not in angle, "the angle is the model's own")


# ------------------------------------------------------------------------------------------------ skier
SKI = "param m = 75 [kg], R = 20 [m], g = 9.81 [m/s^2], v0 = 3 [m/s]\n"
PISTE = "axes x right, z up\nmass S: m at (x, z)\ngravity g along -z\n"
skiers = {
    "squares": "coord x, z\n" + PISTE + "constraint h: x^2 + z^2 >= R^2\n",
    "a distance": "coord z, x\n" + PISTE + "constraint h: norm(pos(S)) >= R\n",
    "the other way": "coord x, z\n" + PISTE + "constraint h: R^2 <= z^2 + x^2\n",
    "polar": "coord r, ϑ\naxes x right, z up\nmass S: m at (r sin ϑ, r cos ϑ)\ngravity g along -z\nconstraint h: r >= R\n",
}


@test("skier: where he takes off, in every spelling, from rest and with a velocity")
def _(program):
    for title, text in skiers.items():
        polar = title == "polar"
        start = "init ϑ = 1°, ϑ' = 0\n" if polar else "init x = 0.349 [m], x' = 0, z' = 0\nbranch z > 0\n"
        at = "ϑ = 0 at rest" if polar else "x = 0 and z = R at rest"
        fast = "ϑ = 0 and ϑ' = v0/R" if polar else "x = 0 and z = R and x' = v0"
        z, x = ("z(S)", "x(S)") if polar else ("z", "x")
        answer = solve(program, SKI + text + start + f"ask a: {z} where λ_h = 0 from {at}\nask b: {x} where λ_h = 0 from {at}\n"
                       f"ask c: {z} where λ_h = 0 from {fast}\n")
        certified(answer, title)
        for key, wanted in (("a", 40 / 3), ("b", 20 * math.sqrt(5) / 3), ("c", 40 / 3 + 3 ** 2 / (3 * 9.81))):
            found = [v for v in answer.values(key=key) if v["number"] is not None]
            need(found, f"{title}: nothing under {key}")
            same(found[0]["number"], wanted, f"{title}: {key}")


# ------------------------------------------------------------------------------------------------ slider-crank
CRANK = "param m1 = 1.2 [kg], m2 = 2 [kg], r = 0.1 [m], l = 0.35 [m], g = 9.81 [m/s^2]\nassume r < l\naxes x right, z up\n"
A, B = "mass A: m1 at (x1, z1)\n", "mass B: m2 at (x2, 0)\n"
TURNED = "mass A: m1 at (r cos φ, r sin φ)\n"
FALL = "gravity g along -z\n"
cranks = {
    "Cartesian": "coord x1, z1, x2\n" + A + B + FALL + "constraint k: x1^2 + z1^2 = r^2\n"
                 "constraint rod: (x2 - x1)^2 + z1^2 = l^2\nbranch x2 > x1\n",
    "Cartesian, other order": "coord x2, z1, x1\n" + B + A + FALL + "constraint rod: l^2 = z1^2 + (x1 - x2)^2\n"
                 "constraint k: r^2 - z1^2 - x1^2 = 0\nbranch x1 < x2\n",
    "angle and slide": "coord φ, x2\n" + TURNED + B + FALL + "constraint rod: (x2 - r cos φ)^2 + r^2 sin^2 φ = l^2\n"
                 "branch x2 > r cos φ\n",
    "two angles": "coord φ, ψ\n" + TURNED + "mass B: m2 at (r cos φ + l cos ψ, 0)\n" + FALL +
                 "constraint rod: r sin φ = l sin ψ\nbranch cos ψ > 0\n",
    "tied": "coord φ, x1, z1, x2\n" + A + B + FALL + "constraint c1: x1 = r cos φ\nconstraint c2: z1 = r sin φ\n"
                 "constraint rod: norm(pos(B) - pos(A)) = l\nbranch x2 > x1\n",
    "all in the plane": "coord x1, z1, x2, z2\n" + A + "mass B: m2 at (x2, z2)\n" + FALL + "constraint slide: z2 = 0\n"
                 "constraint k: x1^2 + z1^2 = r^2\nconstraint rod: (x2 - x1)^2 + (z2 - z1)^2 = l^2\nbranch x2 > x1\n",
}


def crank_state(phi, omega):
    r, l = 0.1, 0.35
    x1, z1 = r * math.cos(phi), r * math.sin(phi)
    root = math.sqrt(l * l - z1 * z1)
    slope = -z1 - z1 * x1 / root                    # dx2/dφ
    psi = math.asin(z1 / l)
    return dict(phi=phi, phi_dot=omega, x1=x1, z1=z1, x2=x1 + root, z2=0.0, x1_dot=-z1 * omega, z1_dot=x1 * omega, x2_dot=slope * omega,
                z2_dot=0.0, psi=psi, psi_dot=x1 * omega / (l * math.cos(psi))), slope


def crank_acceleration(phi, omega):
    """(m1 r^2 + m2 s^2) φ'' + m2 s s' φ'^2 + m1 g r cos φ = 0 with s = dx2/dφ."""
    r, l, m1, m2, g = 0.1, 0.35, 1.2, 2, 9.81
    s, c = math.sin(phi), math.cos(phi)
    w = math.sqrt(l * l - r * r * s * s)
    slope = -r * s - r * r * s * c / w
    bend = -r * c - r * r * (c * c - s * s) / w - r ** 4 * s * s * c * c / w ** 3
    return -(m2 * slope * bend * omega ** 2 + m1 * g * r * c) / (m1 * r * r + m2 * slope ** 2)


@test("slider-crank: the Lagrange function, the acceleration of the angle and the positions of rest in every spelling")
def _(program):
    rng = random.Random(SEED)
    for title, text in cranks.items():
        answer = solve(program, CRANK + text + "ask a: lagrangian, lagrange2, solve λ_rod\nask b: equilibria\n")
        certified(answer, title)
        for _ in range(5):
            phi, omega = rng.uniform(-3, 3), rng.uniform(-9, 9)
            state, slope = crank_state(phi, omega)
            L = (1.2 * 0.1 ** 2 + 2 * slope ** 2) * omega ** 2 / 2 - 1.2 * 9.81 * state["z1"]
            same(evaluated(answer, answer.value("L", key="a"), state), L, f"{title}: L")
            found = [v for v in answer.values(key="a") if v["name"] == "phi_ddot"]
            for v in found:
                same(evaluated(answer, v, state), crank_acceleration(phi, omega), f"{title}: phi''")
        rest = rests(answer)
        need(sorted(v["stability"] for v in rest) == ["stable", "unstable"], f"{title}: {[v.get('stability') for v in rest]}")
        same(evaluated(answer, answer.values("omega^2", key="b")[0], {}), 1.2 * 9.81 / (3.2 * 0.1), f"{title}: frequency")


@test("a rod as long as its crank: the singular positions are named, and nothing is claimed there")
def _(program):
    for title in ("Cartesian", "angle and slide", "two angles"):
        text = CRANK.replace("l = 0.35 [m]", "l = 0.1 [m]").replace("assume r < l\n", "") + cranks[title]
        answer = solve(program, text + "ask a: lagrangian\nask b: equilibria\n")
        words = str(answer.items("a"))
        need("Singular position" in words, f"{title}: {words[-300:]}")
        need(not [v for v in answer.values(key="b") if v["name"] == "omega^2"], f"{title}: a frequency at a singular position")
    for title in ("Cartesian", "angle and slide"):
        answer = solve(program, CRANK + cranks[title] + "ask a: lagrangian\n")
        need("Singular" not in str(answer.items("a")), f"{title}: a long rod has no singular position")


# ------------------------------------------------------------------------------------------------ two and more freedoms
DOUBLE = "param m1 = 1 [kg], m2 = 2 [kg], l1 = 0.5 [m], l2 = 0.7 [m], g = 9.81 [m/s^2]\naxes x right, y up\n"
BOBS = "mass A: m1 at (x1, y1)\nmass B: m2 at (x2, y2)\ngravity g along -y\n"
doubles = {
    "squares": "coord x1, y1, x2, y2\n" + BOBS + "constraint a: x1^2 + y1^2 = l1^2\nconstraint b: (x2 - x1)^2 + (y2 - y1)^2 = l2^2\n",
    "distances, other order": "coord y2, x2, y1, x1\n" + BOBS + "constraint b: norm(pos(B) - pos(A)) = l2\nconstraint a: norm(pos(A)) = l1\n",
    "angles": "coord α, β\nmass A: m1 at (l1 sin α, -l1 cos α)\nmass B: m2 at (l1 sin α + l2 sin β, -l1 cos α - l2 cos β)\n"
              "gravity g along -y\n",
    "relative": "coord x1, y1, u, v\nmass A: m1 at (x1, y1)\nmass B: m2 at (x1 + u, y1 + v)\ngravity g along -y\n"
                "constraint a: x1^2 + y1^2 = l1^2\nconstraint b: u^2 + v^2 = l2^2\n",
}


@test("double pendulum: positions of rest and both frequencies in every spelling")
def _(program):
    m, l1, l2, g = 3.0, 0.5, 0.7, 9.81
    b, c, a = m * g * (l1 + l2), m * g * g, 1.0 * l1 * l2     # m1 l1 l2 ω^4 - M g (l1 + l2) ω^2 + M g^2 = 0
    wanted = sorted((b + s * math.sqrt(b * b - 4 * a * c)) / (2 * a) for s in (1, -1))
    for title, text in doubles.items():
        answer = solve(program, DOUBLE + text + "ask b: equilibria\n")
        certified(answer, title)
        rest = rests(answer)
        need(sorted(v["stability"] for v in rest) == ["stable"] + 3 * ["unstable"], f"{title}: {[v.get('stability') for v in rest]}")
        found = sorted(evaluated(answer, v, {}) for v in answer.values("omega^2", key="b"))
        need(len(found) == 2, f"{title}: {found}")
        for x, y in zip(found, wanted):
            same(x, y, f"{title}: frequency")


@test("two-link arm: equations of the second kind give every acceleration")
def _(program):
    answer = solve(program, "param m1 = 2 [kg], m2 = 1.5 [kg], l1 = 0.5 [m], l2 = 0.4 [m], g = 9.81 [m/s^2]\ncoord q1, q2\n"
                   "axes x right, y up\nbody arm1: mass m1, inertia m1 l1^2/12 at (l1/2 cos q1, l1/2 sin q1) angle q1\n"
                   "body arm2: mass m2, inertia m2 l2^2/12 at (l1 cos q1 + l2/2 cos(q1 + q2), l1 sin q1 + l2/2 sin(q1 + q2)) angle q1 + q2\n"
                   "gravity g along -y\nask lagrange2\n")
    certified(answer, "arm")
    steps = " ".join(str(s) for i in answer.items() for s in i["steps"])
    for name in ("q1''", "q2''"):
        need(f"{name} =" in steps, f"{name} is not shown")
    for name in ("q1_ddot", "q2_ddot"):
        answer.value(name)


# ------------------------------------------------------------------------------------------------ a hoop that turns
HOOP = "param m = 1 [kg], R = 0.8 [m], Ω = 5 [rad/s], g = 9.81 [m/s^2]\naxes x right, y out, z up\n"
HOOPS = {   # text, how the angle from below shows in its coordinates
    "sphere and plane": "coord x, y, z\nmass P: m at (x, y, z)\ngravity g along -z\nconstraint ring: x^2 + y^2 + z^2 = R^2\n"
                        "constraint turn: y cos(Ω t) = x sin(Ω t)\n",
    "distance, other order": "coord z, y, x\nmass P: m at (x, y, z)\ngravity g along -z\nconstraint turn: x sin(Ω t) - y cos(Ω t) = 0\n"
                             "constraint ring: norm(pos(P)) = R\n",
    "circle in its plane": "coord ρ, z\nmass P: m at (ρ cos(Ω t), ρ sin(Ω t), z)\ngravity g along -z\nconstraint ring: ρ^2 + z^2 = R^2\n",
    "angle": "coord ϑ\nmass P: m at (R sin ϑ cos(Ω t), R sin ϑ sin(Ω t), -R cos ϑ)\ngravity g along -z\n",
}


@test("bead on a turning hoop: four positions of rest, the Jacobi integral, and the frequency in every spelling")
def _(program):
    for title, text in HOOPS.items():
        answer = solve(program, HOOP + text + "ask a: equilibria\nask b: conserved\nask c: lagrangian\n")
        certified(answer, title)
        rest = rests(answer)
        need(len(rest) == 4 and sum(v["stability"] == "stable" for v in rest) == 2, f"{title}: {[v.get('stability') for v in rest]}")
        for v in answer.values("omega^2", key="a"):
            same(evaluated(answer, v, {}), 25 - 9.81 ** 2 / (0.8 ** 2 * 25), f"{title}: frequency")
        answer.value("H", key="b", conserved=True)
        rng = random.Random(SEED)
        for _ in range(5):
            θ, rate, t = rng.uniform(0.1, 3), rng.uniform(-3, 3), rng.uniform(0, 3)
            ρ, z = 0.8 * math.sin(θ), -0.8 * math.cos(θ)
            dρ, dz, c, s = 0.8 * math.cos(θ) * rate, 0.8 * math.sin(θ) * rate, math.cos(5 * t), math.sin(5 * t)
            state = dict(t=t, x=ρ * c, y=ρ * s, z=z, rho=ρ, rho_dot=dρ, z_dot=dz, theta=θ, theta_dot=rate,
                         x_dot=dρ * c - 5 * ρ * s, y_dot=dρ * s + 5 * ρ * c)
            L = (dρ ** 2 + dz ** 2 + 25 * ρ ** 2) / 2 - 9.81 * z
            same(evaluated(answer, answer.value("L", key="c"), state), L, f"{title}: L")


# ------------------------------------------------------------------------------------------------ driven mechanisms
DRIVEN = "param m1 = 1 [kg], m2 = 2 [kg], r = 0.1 [m], l = 0.3 [m], g = 9.81 [m/s^2], ω = 5 [rad/s]\nassume r < l\naxes x right, z up\n"
driven = {
    "angle and slide": "coord φ, x2\n" + TURNED + B + FALL + "constraint rod: norm(pos(A) - pos(B)) = l\n"
                       "constraint drive: φ = ω t with M\nbranch x2 > r cos φ\n",
    "tied": "coord x1, z1, x2, z2, φ\n" + A + "mass B: m2 at (x2, z2)\n" + FALL + "constraint c1: x1 = r cos φ\nconstraint c2: z1 = r sin φ\n"
            "constraint slide: z2 = 0\nconstraint rod: (x2 - x1)^2 + (z2 - z1)^2 = l^2\nconstraint drive: φ = ω t with M\nbranch x2 > x1\n",
    "two angles": "coord ψ, φ\n" + TURNED + "mass B: m2 at (r cos φ + l cos ψ, 0)\n" + FALL + "constraint drive: φ - ω t = 0 with M\n"
                  "constraint rod: l sin ψ = r sin φ\nbranch cos ψ > 0\n",
}


@test("a driven crank: place, velocity and torque are functions of time, the torque in N m")
def _(program):
    r, l, m1, m2, g, w = 0.1, 0.3, 1, 2, 9.81, 5

    def slide(t):
        return r * math.cos(w * t) + math.sqrt(l * l - (r * math.sin(w * t)) ** 2)

    def torque(t):     # power of the drive = rate of the energy, by differences of fourth order
        def energy(u):
            h = 1e-4
            v = (8 * (slide(u + h) - slide(u - h)) - slide(u + 2 * h) + slide(u - 2 * h)) / (12 * h)
            return m2 * v * v / 2 + m1 * g * r * math.sin(w * u)
        h = 1e-3
        return (8 * (energy(t + h) - energy(t - h)) - energy(t + 2 * h) + energy(t - 2 * h)) / (12 * h) / w

    for title, text in driven.items():
        place = "r cos φ + l cos ψ" if title == "two angles" else "x2"
        asks = f"ask a: solve M\nask b: {place}\nask c: dof\n" + ("" if title == "two angles" else "ask d: x2'\nask e: solve x2(t)\n")
        answer = solve(program, DRIVEN + text + asks)
        certified(answer, title)
        need(answer.document["dof"]["dof"] == 0, f"{title}: {answer.document['dof']}")
        M = answer.value("lambda_drive", key="a")
        need(M["unit"] == "N m", f"{title}: the torque is in {M['unit']}")
        for t in (0.05, 0.31, 0.9, 1.7):
            at = {"t": t}
            need(close(evaluated(answer, M, at), torque(t), 1e-6, 1e-3), f"{title}: M({t}) is {evaluated(answer, M, at)}, not {torque(t)}")
            same(evaluated(answer, answer.values(key="b")[0], at), slide(t), f"{title}: {place}")
            if title != "two angles":
                same(evaluated(answer, answer.value("x2", key="e"), at), slide(t), f"{title}: x2(t)")


# ------------------------------------------------------------------------------------------------ loads of the chosen angle
@test("slider-crank with a torque on the chosen angle, or with a flywheel: forces of rod, slide and crank")
def _(program):
    head = ("param ML = 5 [N m], F = 200 [N], J = 0.3 [kg m^2]\n" + CRANK + "coord x1, z1, x2, z2, φ\n" + A + "mass B: m2 at (x2, z2)\n" + FALL +
            "constraint k: x1^2 + z1^2 = r^2\nconstraint slide: z2 = 0\nconstraint rod: (x2 - x1)^2 + (z2 - z1)^2 = l^2\n"
            "choose φ with x1 = r cos φ, z1 = r sin φ\nbranch x2 > x1\nforce gas: (-F, 0) on B\n")
    ask = "ask a: solve λ_rod, solve λ_slide, solve λ_k\n"
    rng = random.Random(SEED)
    for load in ("torque -ML on φ\n", "kinetic J/2 φ'^2\n"):
        answer = solve(program, head + load + ask)
        certified(answer, load)
        for _ in range(5):
            phi, omega = rng.uniform(-3, 3), rng.uniform(-9, 9)
            state, slope = crank_state(phi, omega)
            x1, z1, x2 = state["x1"], state["z1"], state["x2"]
            torque, extra = (-5, 0) if "torque" in load else (0, 0.3)
            # x1, z1, x2, z2 with the torque as a tangential force, the flywheel as a mass J/r^2 that the crank carries
            m = 1.2
            a1 = crank_inverse(state, m + extra / 0.01, torque, -200)
            push = [m * a1[0], m * (a1[1] + 9.81)]          # what the constraints and the torque exert on A
            t = [-z1 / 0.1, x1 / 0.1]
            tangential = (torque - extra * a1[3]) / 0.1
            push = [push[k] - tangential * t[k] for k in range(2)]
            rod = (2 * a1[2] + 200) / (2 * (x2 - x1))       # on B along x
            radial = (push[0] * x1 + push[1] * z1) / 0.01 - 2 * rod * ((x1 - x2) * x1 + z1 * z1) / 0.01
            names = {"lambda_rod": rod, "lambda_slide": 2 * 9.81 + 2 * rod * z1, "lambda_k": radial / 2}
            for name, wanted in names.items():
                same(evaluated(answer, answer.value(name), state), wanted, f"{load.strip()}: {name}")


def crank_inverse(state, m1, torque, gas):
    """Accelerations x1'', z1'', x2'', φ'' of the crank with m1 as its turning mass; the weight is that of 1.2 kg."""
    r, l, g = 0.1, 0.35, 9.81
    phi, omega = state["phi"], state["phi_dot"]
    s, c = math.sin(phi), math.cos(phi)
    w = math.sqrt(l * l - r * r * s * s)
    slope = -r * s - r * r * s * c / w
    bend = -r * c - r * r * (c * c - s * s) / w - r ** 4 * s * s * c * c / w ** 3
    a = (torque + gas * slope - 2 * slope * bend * omega ** 2 - 1.2 * g * r * c) / (m1 * r * r + 2 * slope ** 2)
    return -r * s * a - r * c * omega ** 2, r * c * a - r * s * omega ** 2, slope * a + bend * omega ** 2, a


@test("statics of a massless crank: the condition of balance, and no check fails")
def _(program):
    rng = random.Random(SEED)
    for text in ("coord φ, x2\npoint B at (x2, 0)\nconstraint rod: (x2 - r cos φ)^2 + (r sin φ)^2 = l^2\nbranch x2 > r cos φ\n"
                 "force (-F, 0) on B\ntorque Mo on φ\n",
                 "coord φ, ψ\npoint B at (r cos φ + l cos ψ, 0)\nconstraint rod: r sin φ = l sin ψ\nbranch cos ψ > 0\n"
                 "force (-F, 0) on B\ntorque Mo on φ\n"):
        answer = solve(program, "param r = 0.1 [m], l = 0.35 [m], F = 7 [N], Mo = 2 [N m]\nassume r < l\naxes x right, z up\n" + text +
                       "ask lagrange2\n")
        certified(answer, text)
        need(any("= 0" in str(s) for i in answer.items() for s in i["steps"]), "no equation")


@test("spherical pendulum in Cartesian coordinates: two positions of rest, named in these, and the frequency below")
def _(program):
    for up, axes, order in (("z", "axes x right, y out, z up", "x, y, z"), ("z", "axes x right, y out, z up", "z, y, x"),
                            ("y", "axes x right, y up, z out", "x, y, z")):
        text = (f"coord {order}\n{axes}\nmass A: m at (x, y, z)\ngravity g along -{up}\nconstraint rod: x^2 + y^2 + z^2 = l^2\n"
                "init x = l/2\nask b: equilibria\nask c: conserved\n")
        answer = solve(program, PENDULUM + text)
        certified(answer, f"{order}, {up}")
        rest = rests(answer)
        need(sorted(v["stability"] for v in rest) == ["stable", "unstable"], f"{order}, {up}: {[v.get('stability') for v in rest]}")
        below = next(v for v in rest if v["stability"] == "stable")
        place = {c["along"]: Formula(c["expr"]).value({"pi": math.pi, **answer.parameters()}) for c in below["components"]}
        for name in "xyz":
            same(place[name], -0.7 if name == up else 0, f"{order}, {up}: {name}")
        same(evaluated(answer, answer.values("omega^2", key="b")[0], {}), 9.81 / 0.7, f"{order}, {up}: frequency")
        answer.value(f"L_{up}", key="c", conserved=True)


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
