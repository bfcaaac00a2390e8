"""Motions to compare with, by extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer) of order 16.

Shares no code or method with what is measured.  The equations are written by hand here: angles for the double pendulum,
the crank angle for the slider-crank, tensions of the links for the chain.  Each is computed with steps H and H/2; the
difference of the two is told as the accuracy of the reference.  The small systems use 30 digits (mpmath), the chain doubles.
"""
from math import cos, sin, sqrt

COLUMNS = 8      # order 2 COLUMNS


def midpoint(f, y, H, n):
    """n steps of the modified midpoint rule over H; error is even in H/n."""
    h = H / n
    before, now = y, [a + h * b for a, b in zip(y, f(y))]
    for _ in range(n - 1):
        before, now = now, [a + 2 * h * b for a, b in zip(before, f(now))]
    return now


def extrapolate(f, y, end, steps):
    H = end / steps
    for _ in range(steps):
        row = []
        for j in range(1, COLUMNS + 1):
            last, row = row, [midpoint(f, y, H, 2 * j)]
            for k, left in enumerate(last):
                inner, outer = (j - k - 1) ** 2, j ** 2
                row.append([a + (a - b) * inner / (outer - inner) for a, b in zip(row[-1], left)])
        y = row[-1]
    return y


# ---- the equations; sine, cosine and root are arguments, so that they serve doubles and many digits

def double_pendulum(sin, cos, g, l=1, m=1):
    """Equal masses and rods; state a, b, a', b'."""
    def f(y):
        a, b, u, v = y
        s, c = sin(a - b), cos(a - b)
        p, q = -m * l * v * v * s - 2 * m * g * sin(a), l * u * u * s - g * sin(b)
        # 2 m l a'' + m l c b'' = p;  l c a'' + l b'' = q
        return [u, v, (p - m * c * q) / (m * l * (2 - c * c)), (2 * q - c * p / m) / (l * (2 - c * c))]
    return f


def slider_crank(sin, cos, root, g, r, l, m1=1, m2=2):
    """State a, a', with x2 = r cos a - root(l^2 - r^2 sin^2 a): M a'' + M'/2 a'^2 + V' = 0."""
    def f(y):
        a, u = y
        s, c = sin(a), cos(a)
        w = root(l * l - r * r * s * s)
        slope = -r * s + r * r * s * c / w
        bend = -r * c + r * r * (c * c - s * s) / w + r ** 4 * s * s * c * c / w ** 3
        return [u, -(m2 * slope * bend * u * u + m1 * g * r * c) / (m1 * r * r + m2 * slope * slope)]
    return f


def chain(n, d, g):
    """n equal masses on links of length d; state x, y, x', y'.  The tensions over the mass solve a tridiagonal system."""
    def f(state):
        x, y, u, v = (state[i * n:(i + 1) * n] for i in range(4))
        dx, dy = ([p[0]] + [p[i] - p[i - 1] for i in range(1, n)] for p in (x, y))
        du, dv = ([p[0]] + [p[i] - p[i - 1] for i in range(1, n)] for p in (u, v))
        diagonal = [2 * (dx[i] ** 2 + dy[i] ** 2) for i in range(n)]
        diagonal[0] /= 2
        beside = [-(dx[i] * dx[i + 1] + dy[i] * dy[i + 1]) for i in range(n - 1)]
        tension = [du[i] ** 2 + dv[i] ** 2 for i in range(n)]
        tension[0] -= g * dy[0]
        for i in range(1, n):
            ratio = beside[i - 1] / diagonal[i - 1]
            diagonal[i] -= ratio * beside[i - 1]
            tension[i] -= ratio * tension[i - 1]
        tension[-1] /= diagonal[-1]
        for i in range(n - 2, -1, -1):
            tension[i] = (tension[i] - beside[i] * tension[i + 1]) / diagonal[i]
        px, py = ([t * e for t, e in zip(tension, dd)] + [0.0] for dd in (dx, dy))
        return u + v + [px[i + 1] - px[i] for i in range(n)] + [py[i + 1] - py[i] - g for i in range(n)]
    return f


# ---- places of the masses at the end, as a list of numbers: what errors are measured in

def double_places(y, l=1):
    a, b = float(y[0]), float(y[1])
    return [l * sin(a), -l * cos(a), l * (sin(a) + sin(b)), -l * (cos(a) + cos(b))]


def crank_places(y, r=0.1, l=0.3):
    a = float(y[0])
    return [r * cos(a), r * sin(a), r * cos(a) - sqrt(l * l - (r * sin(a)) ** 2)]


def chain_places(y, n=100):
    return list(y[:2 * n])


def chain_start(n=100, d=0.01):
    return [(i + 1) * d for i in range(n)] + [0.0] * (3 * n)


# ---- name -> (places at the end, accuracy)

def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def twice(f, start, end, steps, places):
    rough, fine = (places(extrapolate(f, start, end, s)) for s in (steps, 2 * steps))
    return fine, distance(rough, fine)


def reference(name):
    """ImportError if the digits that it needs are not at hand."""
    if name == "chain":
        return twice(chain(100, 0.01, 9.81), chain_start(), 0.3, 100, chain_places)
    from mpmath import mp, mpf
    mp.dps = 30
    g = mpf(981) / 100
    if name == "double":
        start = [mp.pi * 2 / 3, -mp.pi / 18, mpf(0), mpf(0)]
        return twice(double_pendulum(mp.sin, mp.cos, g), start, mpf(5), 300, double_places)
    f = slider_crank(mp.sin, mp.cos, mp.sqrt, g, mpf(1) / 10, mpf(3) / 10)
    return twice(f, [mp.atan2(8, 6), mpf(-1)], mpf(2), 160, crank_places)
