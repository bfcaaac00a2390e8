#!/usr/bin/env python3
"""The founding problem sheet, equation by equation: Atwood machine (1)-(16), connecting rod (17)-(27), skier (28)-(47).

The right sides below were derived by hand from Newton's laws, independently of the program; where the sheet prints a
formula it is named by its number.  Formulas of the program are evaluated at random points and compared.
"""

import sys

from sheet import *

test = Tests()


# ------------------------------------------------------------------------------------------------ Atwood
def atwood_state(rng, fixed=None):
    p = dict(fixed) if fixed else {k: positive(rng) for k in ("m1", "m2", "g", "L")} | {"R": rng.uniform(0.05, 0.1)}
    p["l"] = p["L"] - math.pi * p["R"]
    p["x1"], p["x1_dot"] = rng.uniform(0, 2), rng.uniform(-2, 2)
    p["x2"], p["x2_dot"] = p["l"] - p["x1"], -p["x1_dot"]
    p |= {"y1": -p["R"], "y2": p["R"], "z1": 0.0, "z2": 0.0, "y1_dot": 0.0, "y2_dot": 0.0, "z1_dot": 0.0, "z2_dot": 0.0}
    a = (p["m1"] - p["m2"]) / (p["m1"] + p["m2"]) * p["g"]
    p |= {"t": rng.uniform(0, 3), "x1_0": rng.uniform(0, 2), "x1_dot_0": rng.uniform(-2, 2), "x1_ddot": a, "x2_ddot": -a}
    p["lambda_g1"] = atwood_lambda(p)
    p["x2_0"], p["x2_dot_0"] = p["l"] - p["x1_0"], -p["x1_dot_0"]
    return p


def atwood_lambda(p):   # (13)
    return -2 * p["g"] * p["m1"] * p["m2"] / (p["m1"] + p["m2"])


def atwood_acceleration(p):
    return (p["m1"] - p["m2"]) / (p["m1"] + p["m2"]) * p["g"]


@test("Atwood (1)-(8): why a constant coordinate may be dropped, told with --steps full")
def _(program):
    steps = [s for i in run(program, example("atwood.pleuel")).items("b") for s in i["steps"] if s.get("detail")]
    told = " ".join(s["text"] for s in steps)
    for formula in ("m x'' = F + λ_1 + Σ λ_a ∂g_a/∂x", "x'' = 0", "λ_1 = -F - Σ λ_a ∂g_a/∂x", "m x'' = 0"):
        need(formula in told, f"{formula} is not told: {told!r}")


@test("Atwood (9), (10): 6 coordinates, 5 constraints, 1 degree of freedom; g2 to g5 are dropped")
def _(program):
    a = run(program, example("atwood.pleuel"))
    dof = a.document["dof"]
    need((dof["coordinates"], dof["constraints"], dof["dof"]) == (6, 5, 1), f"dof: {dof}")
    for label in ("g2", "g3", "g4", "g5"):
        need(a.constraint(label)["dropped"], f"{label} is not dropped")
    g1 = a.constraint("g1")
    need(not g1["dropped"] and g1["kind"] == "holonomic" and not g1["rheonomic"] and g1["sided"] == "two", f"g1: {g1}")
    checks_pass(a)


@test("Atwood (11)-(13): multiplier and accelerations")
def _(program):
    a, points = run(program, example("atwood.pleuel")), Points(atwood_state)
    v = a.value("lambda_g1", key="c")
    need(v.get("of") == "g1", f"lambda of {v.get('of')}")
    points.same(v["expr"], atwood_lambda, "lambda (13)")
    number(v, -23.544, "lambda")
    need(v["unit"] == "N", f"unit {v['unit']}")
    points.same(a.value("x1_ddot", key="c")["expr"], atwood_acceleration, "x1''")
    points.same(a.value("x2_ddot", key="c")["expr"], lambda p: -atwood_acceleration(p), "x2''")


@test("Atwood (14): motion from any start")
def _(program):
    a, points = run(program, example("atwood.pleuel")), Points(atwood_state)
    v = a.value("x1", key="d")
    points.same(v["expr"], lambda p: p["x1_0"] + p["x1_dot_0"] * p["t"] + atwood_acceleration(p) * p["t"] ** 2 / 2, "x1(t)")
    for v in a.values("x2", key="d"):
        points.same(v["expr"], lambda p: p["l"] - (p["x1_0"] + p["x1_dot_0"] * p["t"] + atwood_acceleration(p) * p["t"] ** 2 / 2),
                    "x2(t)")


@test("Atwood d: energy is conserved, with the reason")
def _(program):
    a = run(program, example("atwood.pleuel"))
    fixed = {"m1": 1.7, "m2": 0.6, "g": 9.3, "L": 4.1, "R": 0.07}
    e = a.value("E", key="d")
    Points(lambda rng: atwood_state(rng, fixed)).same_up_to_constant(
        e["expr"], lambda p: (p["m1"] + p["m2"]) * p["x1_dot"] ** 2 / 2 - p["m1"] * p["g"] * p["x1"] - p["m2"] * p["g"] * p["x2"], "E")
    need(e.get("conserved") is True, "E is not marked as conserved")
    need("potential" in e.get("because", "") and ("time" in e["because"] or " t" in e["because"]), f"because: {e.get('because')!r}")


@test("Atwood (15): the rope pulls both masses with the same force")
def _(program):
    a, points = run(program, example("atwood.pleuel")), Points(atwood_state)
    for mass in ("m1", "m2"):
        force = a.value(key="e", item="force of g1", on=mass)
        points.same(component(force, "e_x"), atwood_lambda, f"Z on {mass}")
        need(force.get("of") == "g1", f"of: {force.get('of')}")


@test("Atwood (16): limits m1 = m2 and m2 -> 0, series m1 = m2 + dm with its right factor 1/2")
def _(program):
    a, points = run(program, example("atwood.pleuel")), Points(atwood_state)
    points.same(a.value(key="e", item="limit m1 = m2 of x1''")["expr"], lambda p: 0.0, "limit m1 = m2")
    points.same(a.value(key="e", item="limit m2 -> 0 of x1''")["expr"], lambda p: p["g"], "limit m2 -> 0")
    v = a.value(key="e", item="series")
    small = [n for n in Formula(v["expr"]).names if n not in ("m1", "m2", "g")]
    need(len(small) == 1, f"names of the series: {Formula(v['expr']).names}")

    def with_small(rng):
        return atwood_state(rng) | {small[0]: rng.uniform(-0.3, 0.3)}

    def series(p):
        d, m, n = p[small[0]], p["m2"], v.get("order", 2)
        # g d/(2 m + d) expanded
        return p["g"] * sum((-1) ** k * d ** (k + 1) / (2 * m) ** (k + 1) for k in range(n))
    need(v.get("order", 2) >= 2, "the series ends before the second order")
    Points(with_small).same(v["expr"], series, "series in dm")


# ------------------------------------------------------------------------------------------------ slider-crank
def crank_state(rng, fixed=None, sign=-1.0):
    """A state on the constraints g4, g5 as written on the sheet; sign of the root picks the branch."""
    p = dict(fixed) if fixed else {"m1": positive(rng), "m2": positive(rng), "r": rng.uniform(0.2, 0.8), "g": positive(rng)}
    p.setdefault("l", p["r"] * rng.uniform(1.2, 3))
    phi, w = rng.uniform(-3.1, 3.1), rng.uniform(-3, 3)
    m1, m2, r, l, g = (p[k] for k in ("m1", "m2", "r", "l", "g"))
    s, c = math.sin(phi), math.cos(phi)
    root = math.sqrt(l * l - r * r * s * s)
    p |= {"phi": phi, "phi_dot": w, "x1": r * c, "z1": r * s, "x2": r * c + sign * root, "x1_dot": -w * r * s, "z1_dot": w * r * c}
    p["x2_dot"] = -w * r * s - sign * w * r * r * s * c / root                                  # (23)
    gradients = [[2 * p["x1"], 2 * p["z1"], 0], [2 * (p["x1"] - p["x2"]), 2 * p["z1"], 2 * (p["x2"] - p["x1"])]]
    vx, vz, v2 = p["x1_dot"], p["z1_dot"], p["x2_dot"]
    curvature = [2 * vx * vx + 2 * vz * vz, 2 * vz * vz + 2 * (v2 - vx) ** 2]
    a, multiplier = kkt([m1, m1, m2], [0, -m1 * g, 0], gradients, curvature)
    p |= {"x1_ddot": a[0], "z1_ddot": a[1], "x2_ddot": a[2], "lambda_g4": multiplier[0], "lambda_g5": multiplier[1]}
    p["phi_ddot"] = (a[1] * c - a[0] * s) / r
    p |= {k + d: 0.0 for k in ("y1", "y2", "z2") for d in ("", "_dot", "_ddot")}
    p |= {"lambda_g1": 0.0, "lambda_g2": 0.0, "lambda_g3": m2 * g, "t": rng.uniform(0, 2)}
    return p


def crank_T(p):   # (24)
    root = math.sqrt(p["l"] ** 2 - p["r"] ** 2 * math.sin(p["phi"]) ** 2)
    bracket = 1 - p["r"] * math.cos(p["phi"]) / root
    return p["r"] ** 2 * p["phi_dot"] ** 2 / 2 * (p["m1"] + p["m2"] * math.sin(p["phi"]) ** 2 * bracket ** 2)


def crank_V(p):   # (25)
    return p["m1"] * p["g"] * p["r"] * math.sin(p["phi"])


@test("crank (17)-(20): 6 coordinates, 1 degree of freedom; g1, g2, g3 are dropped")
def _(program):
    a = run(program, example("crank.pleuel"))
    dof = a.document["dof"]
    need((dof["coordinates"], dof["constraints"], dof["dof"]) == (6, 5, 1), f"dof: {dof}")
    dropped = [c["label"] for c in a.document["constraints"] if c["dropped"]]
    need(dropped == ["g1", "g2", "g3"], f"dropped: {dropped}")
    checks_pass(a)


@test("crank (21)-(23): the maps of the old coordinates, on the branch x2 < x1")
def _(program):
    a, points = run(program, example("crank.pleuel")), Points(crank_state)
    for name in ("x1", "z1", "x2"):
        points.same(a.value(name, key="b")["expr"], lambda p, n=name: p[n], name)
    for v in a.values(key="b"):
        if v["name"] in ("x1_dot", "z1_dot", "x2_dot"):
            points.same(v["expr"], lambda p, n=v["name"]: p[n], v["name"])


@test("crank (24)-(26): T, V, L")
def _(program):
    a, points = run(program, example("crank.pleuel")), Points(crank_state)
    points.same(a.value("T", key="b")["expr"], crank_T, "T")
    points.same(a.value("V", key="b")["expr"], crank_V, "V")
    points.same(a.value("L", key="b")["expr"], lambda p: crank_T(p) - crank_V(p), "L", scale=crank_T)


@test("crank: Lagrange equation of the second kind agrees with Newton's laws")
def _(program):
    a, points = run(program, example("crank.pleuel")), Points(crank_state)
    points.same(a.value("phi_ddot")["expr"], lambda p: p["phi_ddot"], "phi''", rel=1e-8)


@test("crank: force of g5 on both masses, and the note that z2 is left out")
def _(program):
    a, points = run(program, example("crank.pleuel")), Points(crank_state)
    on2 = a.value(item="force of g5", on="m2")
    points.same(component(on2, "e_x"), lambda p: p["m2"] * p["x2_ddot"], "Z on m2 along x", rel=1e-8)
    on1 = a.value(item="force of g5", on="m1")
    points.same(component(on1, "e_x"), lambda p: -p["m2"] * p["x2_ddot"], "Z on m1 along x", rel=1e-8)
    points.same(component(on1, "e_z"), lambda p: 2 * p["lambda_g5"] * p["z1"], "Z on m1 along z", rel=1e-8)
    need(a.notes("N055"), "no note about the spelling of g5")


@test("crank: equilibria at +90 degrees (unstable) and -90 degrees (stable)")
def _(program):
    a = run(program, example("crank.pleuel"))
    found = {}
    for v in a.values(item="equilibria"):
        if v["name"].startswith("equilibrium"):
            angle = Formula(component(v, "phi")).value({}) % (2 * math.pi)
            found[round(math.degrees(angle), 9)] = v["stability"]
    need(found == {90.0: "unstable", 270.0: "stable"}, f"found {found}")


# ------------------------------------------------------------------------------------------------ skier
def ski_state(rng):
    p = {"m": positive(rng), "R": positive(rng), "g": positive(rng)}
    p |= {"r": p["R"], "theta": rng.uniform(0.05, 0.8), "theta_dot": rng.uniform(-1, 1), "r_dot": 0.0, "r_ddot": 0.0}
    p["theta_ddot"] = p["g"] * math.sin(p["theta"]) / p["R"]
    p["lambda_h"] = p["m"] * p["g"] * math.cos(p["theta"]) - p["m"] * p["R"] * p["theta_dot"] ** 2      # (40)
    return p


@test("skier (28)-(30): h = r - R, one-sided")
def _(program):
    a = run(program, example("ski.pleuel"))
    h = a.constraint("h")
    need(h["sided"] == "one" and h["kind"] == "holonomic" and not h["rheonomic"], f"h: {h}")
    need(a.document["dof"]["dof"] == 1, f"dof: {a.document['dof']}")
    checks_pass(a)


@test("skier (37)-(40): accelerations on the piste")
def _(program):
    a, points = run(program, example("ski.pleuel")), Points(ski_state)
    points.same(a.value("theta_ddot", key="b")["expr"], lambda p: p["theta_ddot"], "theta'' (38)")
    for v in a.values("lambda_h", key="b"):
        points.same(v["expr"], lambda p: p["lambda_h"], "lambda (40)")


@test("skier (43)-(46): speed and force from rest at the top")
def _(program):
    a, points = run(program, example("ski.pleuel")), Points(ski_state)

    def force(p):
        return p["m"] * p["g"] * (3 * math.cos(p["theta"]) - 2)
    v = a.value(key="c", item="force of h", on="m")
    points.same(component(v, "e_r"), force, "Z (46)", scale=lambda p: p["m"] * p["g"])
    for v in a.values("lambda_h", key="c"):
        points.same(v["expr"], force, "lambda (45)", scale=lambda p: p["m"] * p["g"])


@test("skier (47): lift-off at acos(2/3) = 48.1897 degrees, whatever m, R, g")
def _(program):
    a = run(program, example("ski.pleuel"))
    v = a.value("theta", key="d")
    need(not Formula(v["expr"]).names, f"the angle depends on {Formula(v['expr']).names}")
    number(v, math.acos(2 / 3), "lift-off angle")
    need(close(Formula(v["expr"]).value({}), math.acos(2 / 3)), v["expr"])
    need(v["unit"] == "rad" and v["display"].replace(",", ".").startswith("48.1897"), f"{v['unit']}, {v['display']}")


@test("skier: the start at the top at rest is an equilibrium, and that is said")
def _(program):
    a = run(program, example("ski.pleuel"))
    said = a.notes("N061") or [s for i in a.items() for s in i["steps"] if "N061" in s["text"] or "equilibrium" in s["text"]]
    need(said, "nothing is said about the equilibrium at the top")


# ------------------------------------------------------------------------------------------------ beyond the sheet
@test("crank: small oscillations about the lower equilibrium, omega² = m1 g/((m1 + m2) r)")
def _(program):
    a, points = run(program, example("crank.pleuel")), Points(crank_state)
    v = a.value("omega^2", item="equilibria")
    # at φ = -90° the slider moves with r φ', so the inertia is (m1 + m2) r², and V'' = m1 g r
    points.same(v["expr"], lambda p: p["m1"] * p["g"] / ((p["m1"] + p["m2"]) * p["r"]), "omega²")
    number(v, 9.81 / (3 * 0.1), "omega²")


@test("crank: numbers that make r = l contradict the assumption r < l, and that is said")
def _(program):
    a = run(program, example("crank.pleuel"), "--set", "l=0.1")
    need(a.exit_code in (3, 4) and [n for n in a.document["notes"] if n["severity"] == "error"], f"exit {a.exit_code}")


@test("crank with r = l: the dead centres that the motion passes are recorded as singular")
def _(program):
    a = run(program, "crank_equal.pleuel")
    events = a.document["simulation"]["events"]
    # the slider stands at the centre; at φ = -90° the gradients (0, 2 z1, 0) of both constraints are parallel
    need([e for e in events if e["kind"] == "singular"], f"events: {[e['kind'] for e in events]}")


@test("crank: two seconds of motion keep constraints and energy")
def _(program):
    s = run(program, example("crank.pleuel")).document["simulation"]
    need(s["status"] == "ok" and close(s["t_end"], 2.0), f"{s['status']} at {s['t_end']}")
    need(abs(s["residual_g"]) < 1e-14 and abs(s["energy_drift"]) < 1e-12, f"g {s['residual_g']}, energy {s['energy_drift']}")


def simpson(f, a, b, n=4000):
    h = (b - a) / n
    return h / 3 * (f(a) + f(b) + sum((4 if k % 2 else 2) * f(a + k * h) for k in range(1, n)))


@test("skier from 1 degree: lift-off at acos(2/3 cos 1°), its time, and the landing of the free flight")
def _(program):
    a = run(program, example("ski.pleuel"))
    g, R, start = 9.81, 20.0, math.radians(1)
    top = math.acos(2 / 3 * math.cos(start))

    # t = ∫ dϑ/ϑ' with ϑ'² = 2 (g/R)(cos ϑ0 - cos ϑ); ϑ = ϑ0 + u² takes the root out of the start
    def integrand(u):
        if u == 0:
            return 2 / math.sqrt(2 * g / R * math.sin(start))
        return 2 * u / math.sqrt(2 * g / R * 2 * math.sin((2 * start + u * u) / 2) * math.sin(u * u / 2))
    t_off = simpson(integrand, 0.0, math.sqrt(top - start))
    w = math.sqrt(2 * g / R * (math.cos(start) - math.cos(top)))
    x, z, vx, vz = R * math.sin(top), R * math.cos(top), R * w * math.cos(top), -R * w * math.sin(top)
    t_fall = (vz + math.sqrt(vz * vz + 2 * g * z)) / g
    events = {e["label"]: e for e in a.document["simulation"]["events"]}
    need(set(events) == {"h", "ground"}, f"events: {set(events)}")
    off, down = events["h"], events["ground"]
    need(off["kind"] == "release" and close(off["state"]["theta"], top, 1e-11), f"lift-off: {off}")
    need(close(off["t"], t_off, 1e-9), f"lift-off at {off['t']!r} s, expected {t_off!r}")
    need(close(down["t"], t_off + t_fall, 1e-9), f"landing at {down['t']!r} s, expected {t_off + t_fall!r}")
    landing = down["state"]["r"] * math.sin(down["state"]["theta"])
    need(close(landing, x + vx * t_fall, 1e-9), f"landing at x = {landing!r}, expected {x + vx * t_fall!r}")


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
