"""The motions that are compared, as SymPy systems.  name -> title, pleuel model, System, end, names of the coordinates in it."""
import pathlib

import sympy as sp
from sympy import Rational as R, cos, sin, sqrt

import straight

here = pathlib.Path(__file__).resolve().parent
t = sp.Symbol("t")
G = R(981, 100)


def symbols(n):
    return sp.symbols(f"q0:{n}"), sp.symbols(f"v0:{n}")


def speed2(point, q, v):
    rates = [sp.diff(p, t) + sum(sp.diff(p, x) * u for x, u in zip(q, v)) for p in point]
    return sum(r * r for r in rates)


def chain(n, length=1, mass=1):
    """n masses on rods, from rest at the horizontal; x and y of a mass side by side, so that the tensions stay tridiagonal."""
    q, v = symbols(2 * n)
    x, y = q[0::2], q[1::2]
    T = sum(u * u for u in v) * R(mass) / 2
    V = G * mass * sum(y)
    g = [(x[i] - (x[i - 1] if i else 0)) ** 2 + (y[i] - (y[i - 1] if i else 0)) ** 2 - length ** 2 for i in range(n)]
    q0 = [length * (k // 2 + 1) if k % 2 == 0 else 0 for k in range(2 * n)]
    return straight.System(q, v, T, V, [0] * (2 * n), g, q0, [0] * (2 * n))


def caraxis():
    (xl, yl, xr, yr), v = q, v = symbols(4)
    mu = R(5, 10000)
    yb = sin(10 * t) / 10
    xb = sqrt(1 - yb ** 2)
    left, right = sqrt(xl ** 2 + yl ** 2), sqrt((xr - xb) ** 2 + (yr - yb) ** 2)
    V = ((left - R(1, 2)) ** 2 + (right - R(1, 2)) ** 2) / 2 + mu * (yl + yr)
    g = [xl * xb + yl * yb, (xl - xr) ** 2 + (yl - yr) ** 2 - 1]
    h = R(1, 2)
    return straight.System(q, v, mu / 2 * sum(u * u for u in v), V, [0] * 4, g, [0, h, 1, h], [-h, 0, -h, 0])


def andrews():
    q, v = symbols(7)
    be, th, ga, ph, de, om, ep = q
    words = ("m1 .04325 m2 .00365 m3 .02373 m4 .00706 m5 .07050 m6 .00706 m7 .05498 I1 2.194e-6 I2 4.410e-7 I3 5.255e-6 I4 5.667e-7 "
             "I5 1.169e-5 I6 5.667e-7 I7 1.912e-5 xa -.06934 ya -.00227 xb -.03635 yb .03273 xc .014 yc .072 c0 4530 l0 .07785 "
             "mom .033 d .028 da .0115 e .02 ea .01421 rr .007 ra .00092 ss .035 sa .01874 sb .01043 sc .018 sd .02 ta .02308 "
             "tb .00916 u .04 ua .01228 ub .00449 zf .02 zt .04 fa .01421").split()
    p = type("parameters", (), {k: R(x) for k, x in zip(words[0::2], words[1::2])})
    e_, z_ = p.e - p.ea, p.zf - p.fa
    m2 = (p.rr * cos(be) - p.da * cos(be + th), p.rr * sin(be) - p.da * sin(be + th))
    m4 = (p.xa + p.zt * cos(de) + e_ * sin(ph + de), p.ya + p.zt * sin(de) - e_ * cos(ph + de))
    m6 = (p.xa + p.u * sin(ep) + z_ * cos(om + ep), p.ya - p.u * cos(ep) + z_ * sin(om + ep))
    bv, tv, gv, pv, dv, ov, ev = v
    T = (p.m2 * speed2(m2, q, v) + p.m4 * speed2(m4, q, v) + p.m6 * speed2(m6, q, v) + (p.m1 * p.ra ** 2 + p.I1) * bv ** 2
         + p.I2 * (bv + tv) ** 2 + (p.m3 * (p.sa ** 2 + p.sb ** 2) + p.I3) * gv ** 2 + p.I4 * (pv + dv) ** 2
         + (p.m5 * (p.ta ** 2 + p.tb ** 2) + p.I5) * dv ** 2 + p.I6 * (ov + ev) ** 2 + (p.m7 * (p.ua ** 2 + p.ub ** 2) + p.I7) * ev ** 2) / 2
    T = simplified(T, q, v)
    xd, yd = p.xb + p.sd * cos(ga) + p.sc * sin(ga), p.yb + p.sd * sin(ga) - p.sc * cos(ga)
    V = p.c0 * (sqrt((xd - p.xc) ** 2 + (yd - p.yc) ** 2) - p.l0) ** 2 / 2
    xe, ye = p.rr * cos(be) - p.d * cos(be + th), p.rr * sin(be) - p.d * sin(be + th)
    g = [xe - p.ss * sin(ga) - p.xb, ye + p.ss * cos(ga) - p.yb, xe - p.e * sin(ph + de) - p.zt * cos(de) - p.xa,
         ye + p.e * cos(ph + de) - p.zt * sin(de) - p.ya, xe - p.zf * cos(om + ep) - p.u * sin(ep) - p.xa,
         ye - p.zf * sin(om + ep) + p.u * cos(ep) - p.ya]
    start = [R("-0.0617138900142764496358948458001"), R(0), R("0.455279819163070380255912382449"), R("0.222668390165885884674473185609"),
             R("0.487364979543842550225598953530"), R("-0.222668390165885884674473185609"), R("1.23054744454982119249735015568")]
    return straight.System(q, v, T, V, [p.mom] + [0] * 6, g, start, [0] * 7)


def simplified(T, q, v):
    """Kinetic energy with each coefficient of v_i v_j reduced to its short form."""
    T = sp.expand(T)
    out = 0
    for i, a in enumerate(v):
        for b in v[i:]:
            c = T.coeff(a, 2) if a == b else T.coeff(a, 1).coeff(b, 1)
            out += sp.trigsimp(c) * a * b
    return out


def stiff(k):
    """Pendulum, and on it by a strong, critically damped spring a second mass (numerics of the test: K = 1e2 ... 1e8)."""
    q, v = symbols(4)
    x, y, u, w = q
    length = sqrt((u - x) ** 2 + (w - y) ** 2)
    c = 2 * sqrt(sp.Integer(k))
    rate = ((u - x) * (v[2] - v[0]) + (w - y) * (v[3] - v[1])) / length
    pull = [-c * rate * sp.diff(length, s) for s in q]
    V = R(k) / 2 * (length - 1) ** 2 + G * (y + w)
    return straight.System(q, v, sum(s * s for s in v) / 2, V, pull, [x ** 2 + y ** 2 - 1], [1, 0, 2, 0], [0] * 4)


def chain_by_hand(n):
    """Header and lines for heyoka of the long chain: what chain_system.h does, in assignments."""
    header = f'#define N_CHAIN {n}\n#include "{here / "chain_system.h"}"\n'
    lines, square = [], "({0})*({0}) + ({1})*({1})".format
    for k in range(2 * n):
        lines += [(f"s_{k}", f"q{k} - q{k - 2}" if k > 1 else f"q{k}"), (f"w_{k}", f"v{k} - v{k - 2}" if k > 1 else f"v{k}")]
    for i in range(n):
        a, b = 2 * i, 2 * i + 1
        lines.append((f"d_{i}", f"{2 if i else 1}*({square(f's_{a}', f's_{b}')})"))
        lines.append((f"r_{i}", square(f"w_{a}", f"w_{b}") + ("" if i else " - K(981,100)*s_1")))
        if i:
            lines.append((f"f_{i}", f"-(s_{a}*s_{a - 2} + s_{b}*s_{b - 2})"))
    lines += [("e_0", "K(1,1)/d_0"), ("y_0", "r_0")]
    for i in range(1, n):
        lines += [(f"h_{i}", f"f_{i}*e_{i - 1}"), (f"e_{i}", f"K(1,1)/(d_{i} - h_{i}*f_{i})"), (f"y_{i}", f"r_{i} - h_{i}*y_{i - 1}")]
    for i in reversed(range(n)):
        lines.append((f"T_{i}", f"y_{i}*e_{i}" if i == n - 1 else f"(y_{i} - f_{i + 1}*T_{i + 1})*e_{i}"))
    for k in range(2 * n):
        more = f"T_{k // 2 + 1}*s_{k + 2}" if k // 2 + 1 < n else "K(0,1)"
        lines.append((f"z_{k}", f"{more} - T_{k // 2}*s_{k}" + (" - K(981,100)" if k % 2 else "")))
    start = [k // 2 + 1.0 if k % 2 == 0 else 0.0 for k in range(2 * n)] + [0.0] * (2 * n)
    return header, {"n": 2 * n, "start": start, "lines": lines}


def by_hand(name):
    return chain_by_hand(int(name[5:])) if name in ("chain100", "chain1000") else None


def model_text(name):
    """A chain of another length: the model of the cases with another N."""
    text = (here.parent / "tests" / "cases" / "chain100.pleuel").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return "\n".join(lines).replace("param N = 100,", f"param N = {int(name[5:])},") + "\n"


# name -> title, model in tests/cases, maker, end, steps of the reference; the coordinates of pleuel's model stand in the order of the
# system, those of chains in pairs
MOTIONS = {
    "pendulum": ("pendulum", "pendulum", lambda: chain(1), 100, 400),
    "double": ("double pendulum", "chain2", lambda: chain(2), 10, 300),
    "caraxis": ("car axis", "caraxis", caraxis, 3, 100),
    "andrews": ("Andrews' squeezer", "andrews", andrews, R(3, 100), 40),
    "chain100": ("chain, N = 100", "chain100", None, 1, 30),
    "chain1000": ("chain, N = 1000", "chain1000", None, R(1, 10), 30),
}
STIFF = [2, 4, 6, 8]
STIFF_END = 5
STIFF_MODEL = """param K = {k}, g = 9.81
let c = 2 sqrt K
coord x, y, u, w
axes x right, y up
mass A: 1 at (x, y)
mass B: 1 at (u, w)
gravity g along -y
constraint rod: x^2 + y^2 = 1
spring K, rest 1 between A and B
damper c between A and B
init x = 1, y = 0, u = 2, w = 0, x' = 0, y' = 0, u' = 0, w' = 0
simulate 0..5
"""
