"""The systems that all programs derive: masses at places, a potential, constraints, and a state to compare results at.

Formulas are in the syntax that SymPy and Maxima share.  The same systems for pleuel are bench/models/*.pleuel.
"""
from math import cos, sin, sqrt

NUMBERS = {"m": 1.3, "m1": 1.7, "m2": 0.9, "m3": 1.1, "l": 1.2, "l1": 0.8, "l2": 1.1, "l3": 0.7, "g": 9.81, "k": 35.0,
           "l0": 0.9, "R": 0.6, "r": 0.5, "w": 5.0, "t": 0.4}


def crank_state(a=0.7, a_dot=1.9, r=0.5, l=1.2):
    """A state on the constraints of the slider-crank."""
    root = sqrt(l * l - (r * sin(a)) ** 2)
    slope = -r * sin(a) + r * r * sin(a) * cos(a) / root
    return {"x1": r * cos(a), "z1": r * sin(a), "x2": r * cos(a) - root,
            "x1_dot": -r * sin(a) * a_dot, "z1_dot": r * cos(a) * a_dot, "x2_dot": slope * a_dot}


def angles(names):
    return {n: 0.4 + 0.5 * i for i, n in enumerate(names)} | {f"{n}_dot": 1.1 - 0.7 * i for i, n in enumerate(names)}


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
    "triple": ("triple pendulum, angles", "a b c", [("m1", *ROD1), ("m2", *hang(ROD1, ROD2)), ("m3", *hang(ROD1, ROD2, ROD3))],
               f"m1*g*({ROD1[1]})+m2*g*({hang(ROD1, ROD2)[1]})+m3*g*({hang(ROD1, ROD2, ROD3)[1]})", [], angles("abc")),
}


def unknowns(name):
    """Accelerations, then multipliers: the order in which every program gives its results."""
    _, coords, _, _, constraints, _ = SYSTEMS[name]
    return [f"{q}_ddot" for q in coords.split()] + [f"lambda_{i + 1}" for i in range(len(constraints))]


def state(name):
    return NUMBERS | SYSTEMS[name][5]
