"""The systems that all programs derive: masses at places, a potential, constraints, and a state to compare results at.

Formulas are in the syntax that SymPy and Maxima share.  The same systems for pleuel are bench/models/*.pleuel.
"""
from math import acos, atan2, cos, hypot, sin, sqrt

NUMBERS = {"m": 1.3, "m1": 1.7, "m2": 0.9, "m3": 1.1, "l": 1.2, "m4": 0.8, "l1": 0.8, "l2": 1.1, "l3": 0.7, "l4": 1.3, "g": 9.81, "k": 35.0,
           "l0": 0.9, "R": 0.6, "r": 0.5, "w": 5.0, "t": 0.4}


def crank_state(a=0.7, a_dot=1.9, r=0.5, l=1.2):
    """A state on the constraints of the slider-crank."""
    root = sqrt(l * l - (r * sin(a)) ** 2)
    slope = -r * sin(a) + r * r * sin(a) * cos(a) / root
    return {"x1": r * cos(a), "z1": r * sin(a), "x2": r * cos(a) - root,
            "x1_dot": -r * sin(a) * a_dot, "z1_dot": r * cos(a) * a_dot, "x2_dot": slope * a_dot}


def angles(names):
    return {n: 0.4 + 0.5 * i for i, n in enumerate(names)} | {f"{n}_dot": 1.1 - 0.7 * i for i, n in enumerate(names)}


def rods_state(n):
    """Angles of n rods that hang from each other, and what they make of the Cartesian coordinates."""
    at, x, y, x_dot, y_dot = {}, 0.0, 0.0, 0.0, 0.0
    for i in range(1, n + 1):
        a, a_dot, l = 0.4 + 0.5 * i, 1.1 - 0.7 * i, NUMBERS[f"l{i}"]
        x, y = x + l * sin(a), y - l * cos(a)
        x_dot, y_dot = x_dot + l * cos(a) * a_dot, y_dot + l * sin(a) * a_dot
        at |= {f"x{i}": x, f"y{i}": y, f"x{i}_dot": x_dot, f"y{i}_dot": y_dot}
    return at


def four_bar_angles(a=0.9, a_dot=1.3):
    """Crank a, coupler b, rocker c of the closed loop l1, l2, l3 on the base l4."""
    l1, l2, l3, l4 = (NUMBERS[k] for k in ("l1", "l2", "l3", "l4"))
    x, y = l1 * cos(a) - l4, l1 * sin(a)              # crank pin, seen from the bearing of the rocker
    d = hypot(x, y)
    c = atan2(y, x) - acos((d * d + l3 * l3 - l2 * l2) / (2 * d * l3))
    b = atan2(l3 * sin(c) - y, l3 * cos(c) - x)
    # l1 e_a' a_dot + l2 e_b' b_dot = l3 e_c' c_dot
    b_dot = a_dot * l1 * sin(c - a) / (l2 * sin(b - c))
    c_dot = a_dot * l1 * sin(b - a) / (l3 * sin(b - c))
    return {"a": a, "b": b, "c": c, "a_dot": a_dot, "b_dot": b_dot, "c_dot": c_dot}


def four_bar_points():
    s, l1, l3, l4 = four_bar_angles(), NUMBERS["l1"], NUMBERS["l3"], NUMBERS["l4"]
    return {"x1": l1 * cos(s["a"]), "y1": l1 * sin(s["a"]), "x2": l4 + l3 * cos(s["c"]), "y2": l3 * sin(s["c"]),
            "x1_dot": -l1 * sin(s["a"]) * s["a_dot"], "y1_dot": l1 * cos(s["a"]) * s["a_dot"],
            "x2_dot": -l3 * sin(s["c"]) * s["c_dot"], "y2_dot": l3 * cos(s["c"]) * s["c_dot"]}


def sphere_state(l=1.2, x=0.7, y=0.4, x_dot=1.0, y_dot=0.5):
    z = -sqrt(l * l - x * x - y * y)
    return {"x": x, "y": y, "z": z, "x_dot": x_dot, "y_dot": y_dot, "z_dot": -(x * x_dot + y * y_dot) / z}


def rods(n):
    """n rods in Cartesian coordinates: coordinates, masses, potential, constraints."""
    before = lambda c, i: f"({c}{i}-{c}{i - 1})" if i > 1 else f"{c}{i}"
    return (" ".join(f"x{i} y{i}" for i in range(1, n + 1)), [(f"m{i}", f"x{i}", f"y{i}") for i in range(1, n + 1)],
            "+".join(f"m{i}*g*y{i}" for i in range(1, n + 1)),
            [f"{before('x', i)}^2+{before('y', i)}^2-l{i}^2" for i in range(1, n + 1)], rods_state(n))


ROD4 = ("l4*sin(d)", "-l4*cos(d)")
ROD1, ROD2, ROD3 = ("l1*sin(a)", "-l1*cos(a)"), ("l2*sin(b)", "-l2*cos(b)"), ("l3*sin(c)", "-l3*cos(c)")


def hang(*rods):
    """The end of a row of rods."""
    return tuple("+".join(part) for part in zip(*rods))


# model: title, coordinates, masses with places, potential, constraints (= 0), state
SYSTEMS = {
    "atwood": ("Atwood machine", "x1 y1 z1 x2 y2 z2", [("m1", "x1", "y1", "z1"), ("m2", "x2", "y2", "z2")],
               "-m1*g*x1-m2*g*x2", ["x1+x2-l", "y1+R", "y2-R", "z1", "z2"],
               dict.fromkeys("y1 z1 y2 z2 x1_dot y1_dot z1_dot x2_dot y2_dot z2_dot".split(), 0.0) | {"x1": 1.0, "x2": 0.2}),
    "crank1": ("slider-crank, Lagrange I", "x1 z1 x2", [("m1", "x1", "z1"), ("m2", "x2")],
               "m1*g*z1", ["x1^2+z1^2-r^2", "z1^2+(x2-x1)^2-l^2"], crank_state()),
    "crank2": ("slider-crank, Lagrange II", "a", [("m1", "r*cos(a)", "r*sin(a)"),
                                                  ("m2", "r*cos(a)-sqrt(l^2-r^2*sin(a)^2)")],
               "m1*g*r*sin(a)", [], angles("a")),
    "double": ("double pendulum, angles", "a b", [("m1", *ROD1), ("m2", *hang(ROD1, ROD2))],
               f"m1*g*({ROD1[1]})+m2*g*({hang(ROD1, ROD2)[1]})", [], angles("ab")),
    "cart": ("pendulum on a cart", "x a", [("m1", "x"), ("m2", "x+l*sin(a)", "-l*cos(a)")],
             "-m2*g*l*cos(a)", [], angles("xa")),
    "elastic": ("elastic pendulum", "r a", [("m", "r*sin(a)", "-r*cos(a)")],
                "-m*g*r*cos(a)+k/2*(r-l0)^2", [], angles("ra")),
    "spherical": ("spherical pendulum, angles", "a b", [("m", "l*sin(a)*cos(b)", "l*sin(a)*sin(b)", "-l*cos(a)")],
                  "-m*g*l*cos(a)", [], angles("ab")),
    "hoop": ("bead on a rotating hoop", "a", [("m", "R*sin(a)*cos(w*t)", "R*sin(a)*sin(w*t)", "-R*cos(a)")],
             "-m*g*R*cos(a)", [], angles("a")),
    "skier": ("skier on a round hill, polar", "r a", [("m", "r*sin(a)", "r*cos(a)")], "m*g*r*cos(a)", ["r-R"],
              angles("a") | {"r": 0.6, "r_dot": 0.0}),
    "spherical1": ("spherical pendulum, Cartesian", "x y z", [("m", "x", "y", "z")], "m*g*z", ["x^2+y^2+z^2-l^2"], sphere_state()),
    "elastic1": ("elastic pendulum, Cartesian", "x y", [("m", "x", "y")], "m*g*y+k/2*(sqrt(x^2+y^2)-l0)^2", [],
                 {"x": 0.5, "y": -0.8, "x_dot": 0.3, "y_dot": 0.7}),
    "foucault": ("Foucault pendulum, rotating frame", "x y",
                 [("m", "x*cos(w*t)-y*sin(w*t)", "x*sin(w*t)+y*cos(w*t)", "-sqrt(l^2-x^2-y^2)")], "-m*g*sqrt(l^2-x^2-y^2)", [],
                 {"x": 0.5, "y": -0.4, "x_dot": 0.3, "y_dot": 0.7}),
    "pulleys": ("movable pulley, three masses", "x1 x2 x3", [("m1", "x1"), ("m2", "x2"), ("m3", "x3")],
                "-m1*g*x1-m2*g*x2-m3*g*x3", ["2*x1+x2+x3-l"], angles(["x1", "x2", "x3"])),
    "fourbar1": ("four-bar linkage, Cartesian", "x1 y1 x2 y2", [("m1", "x1", "y1"), ("m2", "x2", "y2")], "m1*g*y1+m2*g*y2",
                 ["x1^2+y1^2-l1^2", "(x2-x1)^2+(y2-y1)^2-l2^2", "(x2-l4)^2+y2^2-l3^2"], four_bar_points()),
    "fourbar2": ("four-bar linkage, angles, three masses", "a b c",
                 [("m1", "l1/2*cos(a)", "l1/2*sin(a)"), ("m2", "l1*cos(a)+l2/2*cos(b)", "l1*sin(a)+l2/2*sin(b)"),
                  ("m3", "l4+l3/2*cos(c)", "l3/2*sin(c)")],
                 "m1*g*l1/2*sin(a)+m2*g*(l1*sin(a)+l2/2*sin(b))+m3*g*l3/2*sin(c)",
                 ["l1*cos(a)+l2*cos(b)-l3*cos(c)-l4", "l1*sin(a)+l2*sin(b)-l3*sin(c)"], four_bar_angles()),
    "double1": ("double pendulum, Cartesian", *rods(2)),
    "triple1": ("triple pendulum, Cartesian", *rods(3)),
    "quadruple1": ("4-pendulum, Cartesian", *rods(4)),
    "quadruple": ("4-pendulum, angles", "a b c d", [("m1", *ROD1), ("m2", *hang(ROD1, ROD2)), ("m3", *hang(ROD1, ROD2, ROD3)),
                                                    ("m4", *hang(ROD1, ROD2, ROD3, ROD4))],
                  f"m1*g*({ROD1[1]})+m2*g*({hang(ROD1, ROD2)[1]})+m3*g*({hang(ROD1, ROD2, ROD3)[1]})"
                  f"+m4*g*({hang(ROD1, ROD2, ROD3, ROD4)[1]})", [], angles("abcd")),
    "triple": ("triple pendulum, angles", "a b c", [("m1", *ROD1), ("m2", *hang(ROD1, ROD2)), ("m3", *hang(ROD1, ROD2, ROD3))],
               f"m1*g*({ROD1[1]})+m2*g*({hang(ROD1, ROD2)[1]})+m3*g*({hang(ROD1, ROD2, ROD3)[1]})", [], angles("abc")),
}


def unknowns(name):
    """Accelerations, then multipliers: the order in which every program gives its results."""
    _, coords, _, _, constraints, _ = SYSTEMS[name]
    return [f"{q}_ddot" for q in coords.split()] + [f"lambda_{i + 1}" for i in range(len(constraints))]


def state(name):
    return NUMBERS | SYSTEMS[name][5]
