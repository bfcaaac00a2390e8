#!/usr/bin/env python3
"""Small models where the derivation once went wrong: every answer from mechanics by hand, exit codes, and no hang."""

import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "founding"))
from sheet import *  # noqa: E402
from formulas import Formula, close  # noqa: E402

test = Tests()
CASES = os.path.join(HERE, "derive_cases")


def case(program, name):
    return run(program, os.path.join(CASES, name + ".pleuel"), "--no-simulation")


def at(expr, **names):
    return Formula(expr).value({"pi": math.pi, **names})


def same(value, expected, what):
    need(close(value, expected, 1e-9, 1e-9), f"{what} is {value}, not {expected}")


def certified(answer):
    """Own checks pass; a closed form that was asked for may be missing."""
    checks = answer.document["checks"]
    need(checks and all(c["passed"] for c in checks), f"own checks failed: {checks}")


def freedoms(answer, coordinates, dof):
    found = answer.document["dof"]
    need(found["coordinates"] == coordinates and found["dof"] == dof, f"freedoms {found}")


@test("a torque on the angle of choose adds no coordinate, and the checks see it")
def _(program):
    answer = case(program, "torque_on_angle")
    certified(answer)
    freedoms(answer, 2, 1)
    p = dict(m=1.3, l=0.7, g=9.0, tau=2.1, phi=0.4)
    expr = answer.value("phi_ddot")["expr"]
    same(at(expr, **p), p["tau"] / (p["m"] * p["l"] ** 2) - p["g"] / p["l"] * math.sin(p["phi"]), "phi''")


@test("springs, inertia and friction on angles of choose: two freedoms, checks pass")
def _(program):
    answer = case(program, "springs_on_angles")
    certified(answer)
    freedoms(answer, 4, 2)


@test("elastic pendulum: certified where the length of the spring is positive")
def _(program):
    checks_pass(case(program, "elastic_pendulum"))


for name in ("contradiction_squares", "contradiction_lines", "contradiction_power", "contradiction_no_root"):

    @test(f"{name}: exit 4 and E042")
    def _(program, name=name):
        answer = case(program, name)
        need(answer.exit_code == 4, f"exit {answer.exit_code}")
        need(answer.notes("E042"), "no E042")


@test("rolling given in velocities is integrated: one freedom, s'' = 2/3 g sin α")
def _(program):
    answer = case(program, "rolling_velocities")
    checks_pass(answer)
    freedoms(answer, 2, 1)
    need(answer.document["dof"]["velocity_dof"] == 1, "freedoms of velocity")
    same(at(answer.value("s_ddot")["expr"], g=9.0, alpha=0.3, R=0.5, m=2.0), 6.0 * math.sin(0.3), "s''")


@test("two free masses and a spring: a line of rest, a zero mode and ω² = k (1/m1 + 1/m2)")
def _(program):
    answer = case(program, "two_free_masses")
    rest = answer.value("equilibrium 1")
    need(rest["free"] == ["x2"], f"free {rest.get('free')}")
    p = dict(m1=1.5, m2=0.8, k=3.0, l0=0.5, x2=2.0)
    same(at(component(rest, "x1"), **p), 1.5, "x1")
    squares = sorted(at(v["expr"], **p) for v in answer.values("omega^2", item="modes"))
    same(squares[0], 0, "zero mode")
    same(squares[1], 3.0 / 1.5 + 3.0 / 0.8, "ω²")


@test("magnetic trap: (k - m ω²)² = b² ω²")
def _(program):
    answer = case(program, "magnetic_trap")
    m, k, b = 1.2, 2.0, 0.9
    found = [at(v["expr"], m=m, k=k, b=b) for v in answer.values("omega^2", item="modes")]
    need(len(found) == 2, f"{len(found)} modes")
    for w2 in found:
        same((k - m * w2) ** 2, b * b * w2, "characteristic equation")


@test("damped shafts: the equilibrium is the line u = v")
def _(program):
    rest = case(program, "damped_shafts").value("equilibrium 1")
    same(at(component(rest, "u"), v=0.7), 0.7, "u")


@test("a string does not push: the upper position is none of rest")
def _(program):
    answer = case(program, "pendulum_by_string")
    found = [at(component(v, "phi")) for v in answer.values("equilibrium 1") + answer.values("equilibrium 2")]
    need(found == [0], f"equilibria {found}")


@test("spherical pendulum: not said to have no equilibrium where coordinates fail")
def _(program):
    sections = [i for i in case(program, "spherical_pendulum").items() if i["item"] == "equilibria"]
    text = " ".join(s.get("text", "") for s in sections[0]["steps"])
    need("none" not in text and "singular" in text, text)


@test("redundant constraint: only the sum of the forces is determined, and that is said")
def _(program):
    answer = case(program, "redundant")
    for request in ("force of a", "force of b"):
        text = " ".join(s.get("text", "") for i in answer.items() if i["item"] == request for s in i["steps"])
        need("sum" in text, f"{request}: {text}")


@test("expect decides on the constraint without generalized coordinates")
def _(program):
    passed = [v["passed"] for v in case(program, "expect_on_constraint").values("expect")]
    need(passed == [True, False, True, False], f"{passed}")
    need([v["passed"] for v in case(program, "redundant_power").values("expect")] == [False], "the force beside a redundant one is open")


@test("driven arm: the force on the mass is m g |cos ωt|, energy T + V though not conserved")
def _(program):
    answer = case(program, "driven_arm")
    p = dict(m=2.0, g=9.0, R=1.5, w=3.0, t=0.4)
    size = answer.values(item="norm(force(arm))")[0]["expr"]
    same(at(size, **p), 2.0 * 9.0 * abs(math.cos(1.2)), "size of the force")
    E = answer.values(item="E")[-1]["expr"]
    same(at(E, **p), (1.5 * 3.0) ** 2 + 2.0 * 9.0 * 1.5 * math.sin(1.2), "energy")


@test("kinematics without masses: the slider of a driven crank")
def _(program):
    answer = case(program, "kinematics")
    p = dict(r=0.5, l=2.0, omega=3.0, t=0.3)
    x = 0.5 * math.cos(0.9) + math.sqrt(4 - (0.5 * math.sin(0.9)) ** 2)
    same(at(answer.value("x")["expr"], **p), x, "x")


@test("a damper on a line assumes no sign of the coordinate")
def _(program):
    need(not any("x" in a for a in case(program, "damped_line").document["assumptions"]), "an assumption on x")


@test("a given Lagrange function has no T and V of its own")
def _(program):
    answer = case(program, "given_lagrangian")
    need(not answer.values("T", item="lagrangian") and answer.values("L", item="lagrangian"), "T = 0 was shown")


for name in ("chain8", "linkage12"):

    @test(f"{name}: ends in time, an acceleration is not said to be itself")
    def _(program, name=name):
        answer = case(program, name)
        need(answer.exit_code == 0, f"exit {answer.exit_code}")
        need(all(c["passed"] for c in answer.document["checks"]), "checks")
        need(all(v["expr"] != "x1_ddot" for v in answer.values("x1_ddot", item="x1''")), "x1'' = x1''")


@test("twelve angles: too long is not called singular")
def _(program):
    answer = case(program, "angles12")
    text = " ".join(s.get("text", "") for i in answer.items() for s in i["steps"])
    need("singular" not in text and "limit of 3000 terms" in text, text[:300])
    need(all(v["expr"] != "q1_ddot" and v["where"] for v in answer.values("q1_ddot")), "q1'' = q1''")


@test("no coordinate free: equilibria are answered, not put off")
def _(program):
    need(not case(program, "corner").notes("N091"), "N091")


@test("a start velocity that violates a constraint is said, and what does not hang on it is still answered")
def _(program):
    answer = case(program, "start-velocity")
    need(answer.exit_code == 4 and answer.document["status"] == "contradiction", f"exit {answer.exit_code}")
    need(answer.notes("E041"), "no E041")
    x, y, vx, vy = 0.6, -0.8, 0.8, 0.6
    value = Formula(answer.value("lambda_rod")["expr"]).value({"m": 1, "g": 9.81, "l": 1, "x": x, "y": y, "x_dot": vx, "y_dot": vy})
    same(value, (9.81 * y - vx * vx - vy * vy) / 2, "lambda_rod")


@test("a uniform force has a potential: the energy is conserved")
def _(program):
    E = case(program, "uniform-force").value("E")
    need(E["conserved"] is True, f"{E}")
    phi, v = 0.7, 0.4
    expected = v * v / 2 - 9.81 * math.cos(phi) - 2 * math.sin(phi)
    same(Formula(E["expr"]).value({"m": 1, "l": 1, "g": 9.81, "F": 2, "phi": phi, "phi_dot": v}), expected, "E")


@test("cylinder rolling in a cylinder: θ'' = -2 g sin θ/(3 (R - a)), pressed with 7/3 of the weight at the bottom")
def _(program):
    answer = case(program, "cylinder_in_cylinder")
    checks_pass(answer)
    p = dict(m=1.3, a=0.2, R=0.9, g=9.0, theta=0.4)
    same(at(answer.value("theta_ddot")["expr"], **p), -2 * 9.0 * math.sin(0.4) / (3 * 0.7), "theta''")
    same(at(answer.value("lambda_touch")["expr"], **p), -7 / 3 * 1.3 * 9.0 * math.cos(0.4), "force of touch")


@test("particle in a cone: ω² = 3 g cos α sin α/r0 about the circle, whose rate is g/(r0 tan α)")
def _(program):
    answer = case(program, "cone")
    p = dict(m=1.3, g=9.0, r0=0.6, alpha=0.5)
    same(at(answer.value("omega^2", item="holding")["expr"], **p), 3 * 9.0 * math.cos(0.5) * math.sin(0.5) / 0.6, "omega^2")
    same(at(answer.value("phi_dot^2", item="holding")["expr"], **p), 9.0 / (0.6 * math.tan(0.5)), "rate")
    rest = answer.value("equilibrium 1", item="equilibria for")
    need(rest["stability"] == "unstable", "at a driven rate the circle is unstable")


@test("cylinder rolling down a movable wedge, rolling given in velocities")
def _(program):
    answer = case(program, "cylinder_on_wedge")
    checks_pass(answer)
    p = dict(M=3.0, m=1.3, r=0.1, alpha=0.5, g=9.0)
    want = -2 * 1.3 * 9.0 * math.sin(0.5) * math.cos(0.5) / (9.0 + 1.3 + 2.6 * math.sin(0.5) ** 2)
    same(at(answer.value("X_ddot")["expr"], **p), want, "X''")


@test("Atwood machine with a heavy pulley: two tensions")
def _(program):
    answer = case(program, "heavy_pulley")
    checks_pass(answer)
    p = dict(m1=3.0, m2=2.0, J=0.05, R=0.1, g=9.0)
    a = 1.0 * 9.0 / (5.0 + 5.0)
    same(at(answer.value("x1_ddot")["expr"], **p), a, "x1''")
    same(at(answer.value("lambda_left")["expr"], **p), 3.0 * (a - 9.0), "left")
    same(at(answer.value("lambda_right")["expr"], **p), 2.0 * (-a - 9.0), "right")


@test("heavy top: both cyclic momenta, and θ'' from them")
def _(program):
    answer = case(program, "heavy_top")
    checks_pass(answer)
    p = dict(A=0.02, C=0.03, m=1.0, l=0.1, g=9.0, theta=0.6, phi_dot=2.0, psi_dot=30.0, theta_dot=0.1)
    spin = 0.03 * (30.0 + 2.0 * math.cos(0.6))
    want = (0.02 * 4.0 * math.sin(0.6) * math.cos(0.6) - spin * 2.0 * math.sin(0.6) + 0.9 * math.sin(0.6)) / 0.02
    same(at(answer.value("theta_ddot")["expr"], **p), want, "theta''")
    same(at(answer.value("p_psi")["expr"], **p), spin, "p_psi")


@test("momenta of the whole system in coordinates that are not reduced; about a pivot beside the origin too")
def _(program):
    answer = case(program, "dumbbell")
    checks_pass(answer)
    p = dict(m=1.2, M=2.3, x1=0.3, y1=-0.4, x2=0.7, y2=1.1, x1_dot=0.2, y1_dot=0.9, x2_dot=-0.5, y2_dot=0.4)
    for name, want in (("p_x", 1.2 * 0.2 - 2.3 * 0.5), ("p_y", 1.2 * 0.9 + 2.3 * 0.4),
                       ("L_z", 1.2 * (0.3 * 0.9 + 0.4 * 0.2) + 2.3 * (0.7 * 0.4 + 1.1 * 0.5))):
        v = answer.value(name, conserved=True)
        same(at(v["expr"], **p), want, name)
    answer = case(program, "pivot_aside")
    need(not answer.values("p_x") and not answer.values("p_y"), "a shift is no symmetry")
    p = dict(m=1.2, d=0.7, r=0.4, x=0.9, y=0.2, x_dot=0.3, y_dot=-0.6)
    same(at(answer.value("L_z", conserved=True)["expr"], **p), 1.2 * (0.2 * -0.6 - 0.2 * 0.3), "L_z")


@test("forces whose work does not depend on the way have a potential, others none")
def _(program):
    answer = case(program, "central_force")
    checks_pass(answer)
    p = dict(m=1.0, k=2.0, K=3.0, c=0.5, h=0.2, tau=1.1, D=0.4, x=0.8, y=-0.5, phi=0.3, x_dot=0.2, y_dot=0.1, phi_dot=0.4)
    r = math.hypot(0.8, 0.5)
    want = (0.04 + 0.01 + 0.16) / 2 + r * r - 3 / r + 0.5 * 0.8**4 / 4 + 0.2 * 0.8 * 0.5 + 1.1 * math.cos(0.3) + 0.2 * 0.09
    same(at(answer.value("E", conserved=True)["expr"], **p), want, "E")
    need(answer.exit_code == 0 and not case(program, "whirling_force").values("E", conserved=True), "a whirling force has a potential")


# ------------------------------------------------------------------------------------------------ closed loops
def with_where(value, names):
    names = {"pi": math.pi, **names}
    for name, text in value.get("where", {}).items():
        names[name] = Formula(text).value(names)
    return Formula(value["expr"]).value(names)


def circles(c1, r1, c2, r2, side):
    """The point at distances r1 and r2, left (1) or right (-1) of the way from c1 to c2."""
    dx, dy = c2[0] - c1[0], c2[1] - c1[1]
    apart = math.hypot(dx, dy)
    along = (r1 * r1 - r2 * r2 + apart * apart) / (2 * apart)
    across = side * math.sqrt(r1 * r1 - along * along)
    return c1[0] + (along * dx - across * dy) / apart, c1[1] + (along * dy + across * dx) / apart


def slope(f, x, h=1e-3):
    """f'(x) to O(h^6)."""
    return (45 * (f(x + h) - f(x - h)) - 9 * (f(x + 2 * h) - f(x - 2 * h)) + f(x + 3 * h) - f(x - 3 * h)) / (60 * h)


LENGTHS = dict(a=1.0, b=3.0, c=2.5, d=3.5)


def fourbar(theta, side):
    p = LENGTHS
    crank = p["a"] * math.cos(theta), p["a"] * math.sin(theta)
    x, y = circles(crank, p["b"], (p["d"], 0.0), p["c"], side)
    return x, y, math.atan2(y - crank[1], x - crank[0]), math.atan2(y, x - p["d"])


def both_sides(found, compute, what, tolerance=1e-9):
    """The values found are those of the two assemblies, each once, and each says which one it is."""
    need(len(found) == 2 and all(v["branch"] for v in found), f"{what}: {len(found)} values {[v.get('branch') for v in found]}")
    need(found[0]["branch"] != found[1]["branch"], f"{what}: {found[0]['branch']} twice")
    for theta in (0.4, 1.7, -2.2, 5.0):
        got = sorted(compute(v, theta) for v in found)
        want = sorted(compute(None, theta, side) for side in (1, -1))
        for g, w in zip(got, want):
            need(abs(g - w) <= tolerance * max(1.0, abs(w)), f"{what} at {theta}: {got}, not {want}")


def turned(x):
    return math.remainder(x, 2 * math.pi)


@test("four-bar linkage in angles: both assemblies, their velocities and accelerations")
def _(program):
    answer = case(program, "fourbar_angles")
    checks_pass(answer)
    freedoms(answer, 3, 1)
    w, acc = 1.3, 0.7

    def of(index, order):
        def compute(v, theta, side=0):
            if v:
                x = with_where(v, {**LENGTHS, "theta": theta, "theta_dot": w, "theta_ddot": acc})
                return turned(x) if order == 0 else x
            f = lambda t: fourbar(theta + turned(t), side)[index]   # noqa: E731
            near = lambda t: f(0.0) + turned(f(t) - f(0.0))         # noqa: E731  no jump by 2 pi
            if order == 0:
                return f(0.0)
            first = slope(near, 0.0)
            return first * w if order == 1 else first * acc + slope(lambda t: slope(near, t), 0.0) * w * w
        return compute

    for name, index in (("psi", 3), ("beta", 2)):
        both_sides(answer.values(name, item="ψ" if name == "psi" else "β"), of(index, 0), name)
        asked = [v for i in answer.items() if i["item"] in ("ψ'", "β'") for v in i["values"] if v["name"] == name + "_dot"]
        both_sides(asked, of(index, 1), name + "'", 1e-7)
    both_sides([v for v in answer.values("psi_ddot", item="ψ''")], of(3, 2), "psi''", 1e-5)


@test("four-bar linkage of points with masses: both assemblies, energy and θ''")
def _(program):
    answer = case(program, "fourbar_points")
    checks_pass(answer)
    p = {**LENGTHS, "m1": 1.2, "m2": 2.3, "g": 9.0}
    w = 1.3
    for name, index in (("x2", 0), ("y2", 1)):
        both_sides(answer.values(name, item=name), lambda v, t, s=0: with_where(v, {**p, "theta": t}) if v else fourbar(t, s)[index], name)

    def theta_ddot(v, theta, side=0):
        if v:
            return with_where(v, {**p, "theta": theta, "theta_dot": w})
        M = lambda t: p["m1"] + p["m2"] * sum(slope(lambda u: fourbar(u, side)[k], t) ** 2 for k in (0, 1))   # noqa: E731
        V = lambda t: 9.0 * (p["m1"] * math.sin(t) + p["m2"] * fourbar(t, side)[1])                          # noqa: E731
        return -(slope(M, theta) * w * w / 2 + slope(V, theta)) / M(theta)

    both_sides(answer.values("theta_ddot", item="lagrange2"), theta_ddot, "theta''", 1e-5)


@test("four-bar linkage with a body: a branch picks one assembly, and it moves as computed with it")
def _(program):
    answer = case(program, "fourbar_body")
    checks_pass(answer)
    p = {**LENGTHS, "m": 1.7, "J": 0.4, "g": 9.0, "tau": 2.0}
    w, theta = 1.3, 0.9
    side = 1 if math.sin(fourbar(theta, 1)[3] - fourbar(theta, 1)[2]) > 0 else -1
    psi = answer.values("psi", item="ψ")
    need(len(psi) == 1, f"{len(psi)} assemblies")
    same(turned(with_where(psi[0], {**p, "theta": theta})), fourbar(theta, side)[3], "psi")
    beta = lambda t: fourbar(t, side)[2]   # noqa: E731
    centre = (lambda t: math.cos(t) + 1.5 * math.cos(beta(t)), lambda t: math.sin(t) + 1.5 * math.sin(beta(t)))
    M = lambda t: p["m"] * sum(slope(f, t) ** 2 for f in centre) + p["J"] * slope(beta, t) ** 2   # noqa: E731
    push = p["tau"] - p["m"] * 9.0 * slope(centre[1], theta)
    want = (push - slope(M, theta) * w * w / 2) / M(theta)
    for v in answer.values("theta_ddot"):
        got = with_where(v, {**p, "theta": theta, "theta_dot": w})
        need(abs(got - want) <= 1e-6 * abs(want), f"theta'' = {got}, not {want}")
    need([v["passed"] for v in answer.values("expect")] == [True], "expect of beta'")


@test("offset slider-crank: both sides")
def _(program):
    answer = case(program, "offset_crank")
    checks_pass(answer)
    p = dict(a=0.8, b=2.2, e=0.3)

    def x(v, theta, side=0):
        if v:
            return with_where(v, {**p, "theta": theta, "theta_dot": 1.1})
        return p["a"] * math.cos(theta) + side * math.sqrt(p["b"] ** 2 - (p["e"] - p["a"] * math.sin(theta)) ** 2)

    both_sides(answer.values("x", item="x"), x, "x")
    both_sides(answer.values("x_dot"), lambda v, t, s=0: x(v, t) if v else 1.1 * slope(lambda u: x(None, u, s), t), "x'", 1e-8)


@test("inverted slider-crank with offset: both ways")
def _(program):
    answer = case(program, "inverted_crank")
    checks_pass(answer)
    p = dict(a=1.0, d=3.5, e=0.1)
    way = lambda t, s: s * math.sqrt((math.cos(t) - 3.5) ** 2 + math.sin(t) ** 2 - 0.01)   # noqa: E731
    both_sides(answer.values("s", item="s"), lambda v, t, s=0: with_where(v, {**p, "theta": t}) if v else way(t, s), "s")


@test("two circles, and two circles about driven points")
def _(program):
    answer = case(program, "two_circles")
    checks_pass(answer)
    p = dict(a=1.0, b=3.0, d=3.5)
    x, y = circles((0, 0), 3.0, (3.5, 0), 1.0, 1)
    same(with_where(answer.values("x")[0], p), x, "x")
    need(sorted(v["branch"] for v in answer.values("y", item="y")) == ["y < 0", "y > 0"], "branches")
    same(sorted(v["number"] for v in answer.values("y", item="y"))[1], abs(y), "y")
    answer = case(program, "driven_dyad")
    checks_pass(answer)
    p = {**LENGTHS, "omega": 1.0}
    for name, index in (("x", 0), ("y", 1)):
        both_sides(answer.values(name), lambda v, t, s=0: with_where(v, {**p, "t": t}) if v else fourbar(t, s)[index], name)
        both_sides(answer.values(name + "_dot"),
                   lambda v, t, s=0: with_where(v, {**p, "t": t}) if v else slope(lambda u: fourbar(u, s)[index], t), name + "'", 1e-8)


@test("a coordinate mapped after a loop moves with it; circles that do not meet are not solved")
def _(program):
    answer = case(program, "parallel_point")
    checks_pass(answer)
    p = dict(l=1.0, w=1.2, m=1.0, g=9.0, phi=1.3, phi_dot=0.8)
    point = lambda t: circles((math.cos(t), math.sin(t)), 1.0, (1.2, 0.0), 1.0, 1)   # noqa: E731
    side = 1 if point(1.3)[1] > circles((math.cos(1.3), math.sin(1.3)), 1.0, (1.2, 0.0), 1.0, -1)[1] else -1
    y3 = lambda t: math.sin(t) + circles((math.cos(t), math.sin(t)), 1.0, (1.2, 0.0), 1.0, side)[1]   # noqa: E731
    found = answer.values("y3_dot", item="y3'")
    need(len(found) == 1, f"{len(found)} assemblies")
    got = with_where(found[0], p)
    need(abs(got - 0.8 * slope(y3, 1.3)) < 1e-8, f"y3' = {got}")
    need(not case(program, "apart").values("y"), "circles that do not meet")


def runge_kutta(slope_of, y, t_end, n=2000):
    t, h = 0.0, t_end / n
    for _ in range(n):
        add = lambda c, k: [a + c * b for a, b in zip(y, k)]   # noqa: E731
        k1 = slope_of(t, y)
        k2 = slope_of(t + h / 2, add(h / 2, k1))
        k3 = slope_of(t + h / 2, add(h / 2, k2))
        k4 = slope_of(t + h, add(h, k3))
        y = [a + h / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in zip(y, k1, k2, k3, k4)]
        t += h
    return y


@test("driven and damped linear motions: the closed forms are the solutions of their equations")
def _(program):
    p = dict(m=1.3, k=9.0, c=0.6, F0=2.1, omega=2.2, a=0.4, g=9.0, tau=0.7)
    m, k, c, F0, omega, a, g, tau = p.values()
    w0 = math.sqrt(k / m)
    motions = {
        "driven_damped": ("x", lambda t, y: [y[1], (F0 * math.cos(omega * t) - c * y[1] - k * y[0]) / m]),
        "resonance": ("x", lambda t, y: [y[1], (F0 * math.sin(w0 * t) - k * y[0]) / m]),
        "moved_support": ("y", lambda t, y: [y[1], k / m * (a * math.cos(omega * t) - y[0]) - g]),
        "fading_force": ("x", lambda t, y: [y[1], F0 * math.exp(-t / tau) - 0.5 * y[1]]),
        "damped_pair": ("x", lambda t, y: [y[1], (-2 * k * y[0] + k * y[2] - c * (y[1] - y[3])) / m,
                                           y[3], (-2 * k * y[2] + k * y[0] - c * (y[3] - y[1])) / m]),
    }
    for name, (q, slope_of) in motions.items():
        answer = case(program, name)
        checks_pass(answer)
        expr = answer.value(q)["expr"]
        start = [0.3, -0.8] if name != "damped_pair" else [0.3, -0.8, -0.5, 0.9]
        names = {f"{q}_0": start[0], f"{q}_dot_0": start[1], "y_0": start[-2], "y_dot_0": start[-1]}
        number = dict(p, m=1.0, c=0.5) if name == "fading_force" else p   # given in that model
        for t in (0.4, 1.7):
            same(at(expr, **{**number, **names, "t": t}), runge_kutta(slope_of, start, t)[0], f"{name} at {t}")


@test("the angular momentum of a body in space counts its turning, in quaternion and axes alike")
def _(program):
    q = [0.8, 0.2, -0.4, 0.4]
    omega = [0.7, -1.1, 0.3]
    a, b, c, d = q
    turn = [[1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)]]
    cross = lambda u, v: [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]   # noqa: E731
    columns = [[row[k] for row in turn] for k in range(3)]
    m, h, moments = 1.3, 0.3, (0.2, 0.2, 0.1)
    place = [h * e for e in columns[2]]
    velocity = cross(omega, place)
    spin = sum(moments[k] * sum(w * e for w, e in zip(omega, columns[k])) * columns[k][2] for k in range(3))
    expected = m * cross(place, velocity)[2] + spin
    names = dict(zip("xyz", place), m=m, h=h, g=9.81, **dict(zip("abcd", q)))
    names.update(zip(("x_dot", "y_dot", "z_dot"), velocity))
    rates = [-sum(w * e for w, e in zip(omega, q[1:])) / 2] + [(a * w + e) / 2 for w, e in zip(omega, cross(omega, q[1:]))]
    names.update(zip(("a_dot", "b_dot", "c_dot", "d_dot"), rates))
    for letter, e in zip("uvw", columns):
        names.update({f"{letter}{i + 1}": e[i] for i in range(3)})
        names.update({f"{letter}{i + 1}_dot": x for i, x in enumerate(cross(omega, e))})
    for name in ("top_quaternion", "top_axes"):
        answer = case(program, name)
        need(all(check["passed"] for check in answer.document["checks"]), f"own checks of {name}")
        same(at(answer.value("L_z")["expr"], **names), expected, f"L_z of {name}")


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
