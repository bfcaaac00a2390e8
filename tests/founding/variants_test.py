#!/usr/bin/env python3
"""The founding sheet told differently: other names, axes, order, start speeds, branches, languages.

A solution that was tuned to the three sheets fails here.  All right sides were derived by hand; where there is a short
derivation it stands beside the test.
"""

import sys

from sheet import *

test = Tests()


def some(rng, *names):
    return {n: positive(rng) for n in names}


# ------------------------------------------------------------------------------------------------ Atwood
def up_state(rng, fixed=None):
    p = dict(fixed) if fixed else some(rng, "a", "b", "gamma", "s", "c")
    p |= {"h": rng.uniform(-1, 1), "h_dot": rng.uniform(-2, 2), "t": rng.uniform(0, 2)}
    p |= {"k": p["s"] - p["h"], "k_dot": -p["h_dot"], "h_0": rng.uniform(-1, 1), "h_dot_0": rng.uniform(-1, 1)}
    # a h'' = -a γ + 2λ, b k'' = -b γ + 2λ, h'' + k'' = 0
    p["h_ddot"] = (p["b"] - p["a"]) * p["gamma"] / (p["a"] + p["b"])
    p["k_ddot"] = -p["h_ddot"]
    p["lambda_rope"] = p["a"] * p["b"] * p["gamma"] / (p["a"] + p["b"])
    return p


@test("heights, doubled constraint: 2 λ is the force, λ halves")
def _(program):
    a, points = run(program, "atwood_up.pleuel"), Points(up_state)
    points.same(a.value("lambda_rope", key="q")["expr"], lambda p: p["lambda_rope"], "lambda")
    points.same(a.value("h_ddot", key="q")["expr"], lambda p: p["h_ddot"], "h''")
    points.same(a.value("k_ddot", key="q")["expr"], lambda p: p["k_ddot"], "k''")
    points.same(a.value("h", key="q")["expr"], lambda p: p["h_0"] + p["h_dot_0"] * p["t"] + p["h_ddot"] * p["t"] ** 2 / 2, "h(t)")
    for mass in ("Eimer", "Stein"):
        z = a.value(key="p", item="force of rope", on=mass)
        points.same(component(z, "e_y"), lambda p: 2 * p["lambda_rope"], f"Z on {mass}")
    number(a.value("lambda_rope", key="q"), 4 * 5 * 9.81 / 9, "lambda")
    checks_pass(a)


@test("heights: energy with the other sign of V")
def _(program):
    fixed = {"a": 1.3, "b": 0.8, "gamma": 7.7, "s": 1.1, "c": 0.2}
    e = run(program, "atwood_up.pleuel").value("E", key="q")
    Points(lambda rng: up_state(rng, fixed)).same_up_to_constant(
        e["expr"], lambda p: (p["a"] + p["b"]) * p["h_dot"] ** 2 / 2 + p["gamma"] * (p["a"] * p["h"] + p["b"] * p["k"]), "E")


@test("one symbol for both masses: x1'' = 0, λ = -m g, uniform motion")
def _(program):
    a = run(program, "atwood_equal.pleuel")
    points = Points(lambda rng: some(rng, "m", "g", "l", "x1_0", "x1_dot_0", "t"))
    points.same(a.value("lambda_g1", key="a")["expr"], lambda p: -p["m"] * p["g"], "lambda")
    points.same(a.value("x1_ddot", key="a")["expr"], lambda p: 0.0, "x1''")
    points.same(a.value("x1", key="b")["expr"], lambda p: p["x1_0"] + p["x1_dot_0"] * p["t"], "x1(t)")
    checks_pass(a)


def movable_state(rng):
    p = some(rng, "m1", "m2", "g", "l", "x1_0", "x1_dot_0", "t")
    # m1 x1'' = m1 g + λ, m2 x2'' = m2 g + 2λ, x1'' + 2 x2'' = 0
    p["lambda"] = -3 * p["g"] * p["m1"] * p["m2"] / (4 * p["m1"] + p["m2"])
    p["x1_ddot"] = p["g"] + p["lambda"] / p["m1"]
    p["x2_ddot"] = -p["x1_ddot"] / 2
    return p


@test("movable pulley: λ = -3 m1 m2 g/(4 m1 + m2), the force on m2 is twice that on m1")
def _(program):
    a, points = run(program, "atwood_movable.pleuel"), Points(movable_state)
    points.same(a.value("lambda_g1", key="a")["expr"], lambda p: p["lambda"], "lambda")
    points.same(a.value("x2_ddot", key="a")["expr"], lambda p: p["x2_ddot"], "x2''", scale=lambda p: p["g"])
    points.same(a.value("x1", key="b")["expr"], lambda p: p["x1_0"] + p["x1_dot_0"] * p["t"] + p["x1_ddot"] * p["t"] ** 2 / 2, "x1(t)",
                scale=lambda p: p["g"])
    points.same(component(a.value(key="b", item="force of g1", on="m1"), "e_x"), lambda p: p["lambda"], "Z on m1")
    points.same(component(a.value(key="b", item="force of g1", on="m2"), "e_x"), lambda p: 2 * p["lambda"], "Z on m2")
    checks_pass(a)


@test("movable pulley: x1'' = g (4 m1 - 2 m2)/(4 m1 + m2) for m1 >> m2 and its series in m2")
def _(program):
    a, points = run(program, "atwood_movable.pleuel"), Points(movable_state)
    v = a.value(key="c", item="series")
    # (4 m1 - 2 m2)/(4 m1 + m2) = 1 - (3/4) e + (3/16) e² - ..., e = m2/m1
    points.same(v["expr"], lambda p: p["g"] * (1 - 0.75 * p["m2"] / p["m1"] + 3 / 16 * (p["m2"] / p["m1"]) ** 2), "series",
                scale=lambda p: p["g"] * (1 + (p["m2"] / p["m1"]) ** 2))
    v = a.value(key="c", item="limit m1 >> m2")

    def leading(rng):
        return movable_state(rng) | {"m1": rng.uniform(1e6, 2e6), "m2": rng.uniform(0.5, 1)}
    Points(leading).same(v["expr"], lambda p: p["g"] * (1 - 0.75 * p["m2"] / p["m1"]), "limit m1 >> m2", rel=1e-5)


@test("in German the same formulas, numbers with a point, words in German")
def _(program):
    a = run(program, "atwood_de.pleuel")
    points = Points(lambda rng: some(rng, "m1", "m2", "g", "l"))
    v = a.value("lambda_g1", key="c")
    points.same(v["expr"], lambda p: -2 * p["g"] * p["m1"] * p["m2"] / (p["m1"] + p["m2"]), "lambda")
    number(v, -23.544, "lambda")
    words = " ".join(s["text"] for i in a.items() for s in i["steps"] if s["kind"] in ("text", "row", "heading"))
    need(any(w in words for w in ("Zwangsbedingung", "eingesetzt", "integriert")), f"no German words: {words[:200]!r}")
    need(not any(w in words for w in (" inserted ", "constraint", "conserved")), f"English words: {words[:300]!r}")
    checks_pass(a)


@test("convention lambda-minus: λ changes its sign, forces and motion do not")
def _(program):
    a = run(program, "atwood_minus.pleuel")
    points = Points(lambda rng: some(rng, "m1", "m2", "g", "l", "x1_0", "x1_dot_0", "t"))

    def tension(p):
        return 2 * p["g"] * p["m1"] * p["m2"] / (p["m1"] + p["m2"])
    points.same(a.value("lambda_g1", key="c")["expr"], tension, "lambda")
    number(a.value("lambda_g1", key="c"), 23.544, "lambda")
    points.same(component(a.value(key="e", item="force of g1", on="m1"), "e_x"), lambda p: -tension(p), "Z on m1")
    points.same(a.value("x1", key="d")["expr"], lambda p: p["x1_0"] + p["x1_dot_0"] * p["t"] +
                (p["m1"] - p["m2"]) / (p["m1"] + p["m2"]) * p["g"] * p["t"] ** 2 / 2, "x1(t)", scale=lambda p: p["g"])
    checks_pass(a)


# ------------------------------------------------------------------------------------------------ skier
def dome_state(rng):
    p = some(rng, "mu", "a", "g") | {"v0": rng.uniform(0, 0.5), "beta": rng.uniform(0, 0.7)}
    p |= {"rho": p["a"], "rho_dot": 0.0, "beta_dot": rng.uniform(-1, 1)}
    return p


@test("start speed v0 at the top: Z = m g (3 cos β - 2) - m v0²/a")
def _(program):
    a, points = run(program, "ski_v0.pleuel"), Points(dome_state)
    z = a.value(key="b", item="force of dome", on="ball")
    points.same(component(z, "e_rho"), lambda p: p["mu"] * p["g"] * (3 * math.cos(p["beta"]) - 2) - p["mu"] * p["v0"] ** 2 / p["a"], "Z",
                scale=lambda p: p["mu"] * p["g"])
    checks_pass(a)


@test("start speed v0: lift-off at cos β = (2 g a + v0²)/(3 g a)")
def _(program):
    a, points = run(program, "ski_v0.pleuel"), Points(dome_state)
    v = a.value("beta", key="c")
    points.same(v["expr"], lambda p: math.acos((2 * p["g"] * p["a"] + p["v0"] ** 2) / (3 * p["g"] * p["a"])), "beta")
    number(v, math.acos((2 * 9.81 * 10 + 9) / (3 * 9.81 * 10)), "beta")


@test("let go at ϑ0: Z = m g (3 cos ϑ - 2 cos ϑ0), lift-off at cos ϑ = 2/3 cos ϑ0")
def _(program):
    a = run(program, "ski_theta0.pleuel")
    z = a.value(key="c", item="force of h", on="m")
    start = [n for n in Formula(component(z, "e_r")).names if n not in ("m", "g", "theta", "R")]
    need(len(start) == 1, f"names of Z: {Formula(component(z, 'e_r')).names}")
    points = Points(lambda rng: some(rng, "m", "g", "R") | {start[0]: rng.uniform(0.1, 0.5), "theta": rng.uniform(0.5, 1)})
    points.same(component(z, "e_r"), lambda p: p["m"] * p["g"] * (3 * math.cos(p["theta"]) - 2 * math.cos(p[start[0]])), "Z",
                scale=lambda p: p["m"] * p["g"])
    v = a.value("theta", key="d")
    points.same(v["expr"], lambda p: math.acos(2 / 3 * math.cos(p[start[0]])), "theta")
    number(v, math.acos(2 / 3 * math.cos(math.radians(10))), "theta")
    checks_pass(a)


@test("angle from the horizontal, axes exchanged: Z = m g (3 sin ψ - 2), sin ψ = 2/3")
def _(program):
    a = run(program, "ski_horizon.pleuel")
    points = Points(lambda rng: some(rng, "M", "G", "b") | {"psi": rng.uniform(0.6, 1.6)})
    z = a.value(item="force of hill", on="P")
    points.same(component(z, "e_q"), lambda p: p["M"] * p["G"] * (3 * math.sin(p["psi"]) - 2), "Z", scale=lambda p: p["M"] * p["G"])
    v = a.value(key="3", item="where")
    need(not Formula(v["expr"]).names, v["expr"])
    number(v, 2 / 3, "sin psi")


@test("inside a loop: λ <= 0, let go at cos θ = 2/3 - v0²/(3 g R)")
def _(program):
    a = run(program, "loop.pleuel")
    points = Points(lambda rng: some(rng, "m", "g", "R", "v0") | {"theta": rng.uniform(0, 3)})
    z = a.value(key="b", item="force of track", on="m")
    # m v²/R = N - m g cos θ with v² = v0² - 2 g R (1 - cos θ), and Z = -N e_r
    points.same(component(z, "e_r"), lambda p: -(p["m"] * p["v0"] ** 2 / p["R"] + p["m"] * p["g"] * (3 * math.cos(p["theta"]) - 2)), "Z",
                scale=lambda p: p["m"] * (p["v0"] ** 2 / p["R"] + p["g"]))
    v = a.value(key="c")
    points.same(v["expr"], lambda p: 2 / 3 - p["v0"] ** 2 / (3 * p["g"] * p["R"]), "cos theta", scale=lambda p: 1.0)
    number(v, 2 / 3 - 64 / (3 * 9.81 * 2), "cos theta")
    checks_pass(a)


# ------------------------------------------------------------------------------------------------ slider-crank
def right_state(rng):
    """Crank pin (X, Y) = a (sin α, cos α), slider at (0, S) above it: S = a cos α + √(b² - a² sin² α)."""
    p = {"ma": positive(rng), "mb": positive(rng), "a": rng.uniform(0.2, 0.6), "b": rng.uniform(0.8, 1.5), "g": positive(rng)}
    s, c, w = math.sin(alpha := rng.uniform(-3, 3)), math.cos(alpha), rng.uniform(-2, 2)
    root = math.sqrt(p["b"] ** 2 - p["a"] ** 2 * s * s)
    slope = -p["a"] * s - p["a"] ** 2 * s * c / root                       # dS/dα
    p |= {"alpha": alpha, "alpha_dot": w, "X": p["a"] * s, "Y": p["a"] * c, "S": p["a"] * c + root}
    p |= {"X_dot": w * p["a"] * c, "Y_dot": -w * p["a"] * s, "S_dot": w * slope}
    p["T"] = w * w / 2 * (p["ma"] * p["a"] ** 2 + p["mb"] * slope ** 2)
    p["V"] = p["g"] * (p["ma"] * p["Y"] + p["mb"] * p["S"])
    vx, vy, vs = p["X_dot"], p["Y_dot"], p["S_dot"]
    gradients = [[2 * p["X"], 2 * p["Y"], 0], [2 * p["X"], -2 * (p["S"] - p["Y"]), 2 * (p["S"] - p["Y"])]]
    acc, multiplier = kkt([p["ma"], p["ma"], p["mb"]], [0, -p["ma"] * p["g"], -p["mb"] * p["g"]], gradients,
                          [2 * vx * vx + 2 * vy * vy, 2 * vx * vx + 2 * (vs - vy) ** 2])
    p["alpha_ddot"] = (acc[0] * c - acc[1] * s) / p["a"]
    p |= {"X_ddot": acc[0], "Y_ddot": acc[1], "S_ddot": acc[2]}
    return p


@test("vertical slider on the other branch: T, V and α''")
def _(program):
    a, points = run(program, "crank_right.pleuel"), Points(right_state)
    points.same(a.value("S", key="b")["expr"], lambda p: p["S"], "S")
    points.same(a.value("T", key="b")["expr"], lambda p: p["T"], "T")
    points.same(a.value("V", key="b")["expr"], lambda p: p["V"], "V", scale=lambda p: p["g"] * (p["ma"] + p["mb"]))
    points.same(a.value("L", key="b")["expr"], lambda p: p["T"] - p["V"], "L", scale=lambda p: p["T"] + p["g"])
    points.same(a.value("alpha_ddot", key="c")["expr"], lambda p: p["alpha_ddot"], "alpha''", rel=1e-7, scale=lambda p: 1.0)
    need(a.document["dof"]["dof"] == 1, f"dof: {a.document['dof']}")
    checks_pass(a)


@test("vertical slider: unstable at the top, stable at the bottom")
def _(program):
    a = run(program, "crank_right.pleuel")
    found = {}
    for v in a.values(key="c", item="equilibria"):
        if v["name"].startswith("equilibrium"):
            found[round(math.degrees(Formula(component(v, "alpha")).value({})) % 360, 6)] = v["stability"]
    need(found.get(0.0) == "unstable" and found.get(180.0) == "stable", f"found {found}")


def full_state(rng):
    p = {"m1": positive(rng), "m2": positive(rng), "r": rng.uniform(0.2, 0.6), "l": rng.uniform(0.8, 1.5), "g": positive(rng)}
    s, c, w = math.sin(phi := rng.uniform(-3, 3)), math.cos(phi), rng.uniform(-2, 2)
    root = math.sqrt(p["l"] ** 2 - p["r"] ** 2 * s * s)
    p |= {"phi": phi, "phi_dot": w, "x1": p["r"] * c, "z1": p["r"] * s, "x2": p["r"] * c + root, "z2": 0.0, "z2_dot": 0.0}
    p |= {"x1_dot": -w * p["r"] * s, "z1_dot": w * p["r"] * c, "x2_dot": -w * p["r"] * s - w * p["r"] ** 2 * s * c / root}
    dx = p["x2"] - p["x1"]
    gradients = [[2 * p["x1"], 2 * p["z1"], 0, 0], [0, 0, 0, 1], [-2 * dx, 2 * p["z1"], 2 * dx, -2 * p["z1"]]]
    curvature = [2 * p["x1_dot"] ** 2 + 2 * p["z1_dot"] ** 2, 0, 2 * p["z1_dot"] ** 2 + 2 * (p["x2_dot"] - p["x1_dot"]) ** 2]
    acc, la = kkt([p["m1"], p["m1"], p["m2"], p["m2"]], [0, -p["m1"] * p["g"], 0, -p["m2"] * p["g"]], gradients, curvature)
    p |= {"x1_ddot": acc[0], "z1_ddot": acc[1], "x2_ddot": acc[2], "z2_ddot": 0.0, "phi_ddot": (acc[1] * c - acc[0] * s) / p["r"]}
    p |= {"lambda_axle": la[0], "lambda_guide": la[1], "lambda_rod": la[2]}
    return p


@test("rod with all coordinates: its force lies along it, axle and guide carry the rest")
def _(program):
    a, points = run(program, "crank_full.pleuel"), Points(full_state)
    big = {"rel": 1e-7, "scale": lambda p: abs(p["lambda_rod"]) + p["g"]}
    on2 = a.value(key="c", item="force of rod", on="m2")
    points.same(component(on2, "e_x"), lambda p: 2 * p["lambda_rod"] * (p["x2"] - p["x1"]), "rod on m2, x", **big)
    points.same(component(on2, "e_z"), lambda p: -2 * p["lambda_rod"] * p["z1"], "rod on m2, z", **big)
    on1 = a.value(key="c", item="force of rod", on="m1")
    points.same(component(on1, "e_x"), lambda p: -2 * p["lambda_rod"] * (p["x2"] - p["x1"]), "rod on m1, x", **big)
    guide = a.value(key="c", item="force of guide", on="m2")
    points.same(component(guide, "e_z"), lambda p: p["lambda_guide"], "guide", **big)
    axle = a.value(key="c", item="force of axle", on="m1")
    points.same(component(axle, "e_x"), lambda p: 2 * p["lambda_axle"] * p["x1"], "axle, x", **big)
    points.same(component(axle, "e_z"), lambda p: 2 * p["lambda_axle"] * p["z1"], "axle, z", **big)
    points.same(a.value("phi_ddot", key="b")["expr"], lambda p: p["phi_ddot"], "phi''", rel=1e-7, scale=lambda p: 1.0)
    need(not a.notes("N055"), "a note about a missing coordinate, although none is missing")
    checks_pass(a)


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
