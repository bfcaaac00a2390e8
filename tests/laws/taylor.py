"""Truncated power series in time, to second order: x + x' t + x'' t^2/2.  The reference of the law tests differentiates with
these and nothing else, so that none of the program's own algebra takes part."""

import math


class Taylor:
    """c[0] + c[1] t + c[2] t^2."""

    def __init__(self, c0, c1=0.0, c2=0.0):
        self.c = (float(c0), float(c1), float(c2))

    @staticmethod
    def of(x):
        return x if isinstance(x, Taylor) else Taylor(x)

    @staticmethod
    def path(q, v, a):
        """The series of a coordinate with position q, velocity v, acceleration a."""
        return Taylor(q, v, a / 2)

    @property
    def value(self):
        return self.c[0]

    @property
    def rate(self):
        return self.c[1]

    @property
    def acceleration(self):
        return 2 * self.c[2]

    def chain(self, f, f1, f2):
        """f(self), given the value and the first two derivatives of f at the constant term."""
        _, b, c = self.c
        return Taylor(f, f1 * b, f1 * c + f2 * b * b / 2)

    def __add__(self, o):
        o = Taylor.of(o)
        return Taylor(*(x + y for x, y in zip(self.c, o.c)))

    def __neg__(self):
        return Taylor(*(-x for x in self.c))

    def __sub__(self, o):
        return self + -Taylor.of(o)

    def __mul__(self, o):
        (a, b, c), (d, e, f) = self.c, Taylor.of(o).c
        return Taylor(a * d, a * e + b * d, a * f + b * e + c * d)

    def __truediv__(self, o):
        o = Taylor.of(o)
        x = o.c[0]
        return self * o.chain(1 / x, -1 / x**2, 2 / x**3)

    def __pow__(self, n):
        if isinstance(n, Taylor):
            if n.c[1] or n.c[2]:
                raise ValueError("a power with an exponent that moves")
            n = n.c[0]
        x = self.c[0]
        if n == int(n) and n >= 0:
            out = Taylor(1)
            for _ in range(int(n)):
                out = out * self
            return out
        return self.chain(x**n, n * x ** (n - 1), n * (n - 1) * x ** (n - 2))

    __radd__ = __add__
    __rmul__ = __mul__

    def __rsub__(self, o):
        return Taylor.of(o) - self

    def __rtruediv__(self, o):
        return Taylor.of(o) / self


def sin(x):
    x = Taylor.of(x)
    s, c = math.sin(x.c[0]), math.cos(x.c[0])
    return x.chain(s, c, -s)


def cos(x):
    x = Taylor.of(x)
    s, c = math.sin(x.c[0]), math.cos(x.c[0])
    return x.chain(c, -s, -c)


def exp(x):
    x = Taylor.of(x)
    e = math.exp(x.c[0])
    return x.chain(e, e, e)


def sqrt(x):
    return Taylor.of(x) ** 0.5


def ln(x):
    x = Taylor.of(x)
    v = x.c[0]
    return x.chain(math.log(v), 1 / v, -1 / v**2)


FUNCTIONS = {"sin": sin, "cos": cos, "exp": exp, "sqrt": sqrt, "ln": ln}


def evaluate(tree, names):
    """The value of a parsed formula (founding/formulas.py) with series for its names."""
    kind = tree[0]
    if kind == "number":
        return Taylor(tree[1])
    if kind == "name":
        return Taylor.of(names[tree[1]])
    if kind == "neg":
        return -evaluate(tree[1], names)
    if kind == "call":
        return FUNCTIONS[tree[1]](*[evaluate(a, names) for a in tree[2]])
    a, b = evaluate(tree[1], names), evaluate(tree[2], names)
    if kind == "+":
        return a + b
    if kind == "-":
        return a - b
    if kind == "*":
        return a * b
    if kind == "/":
        return a / b
    return a**b


def solve_linear(A, b):
    """A x = b by Gauss with pivoting; None when A is singular to rounding."""
    n = len(A)
    M = [list(row) + [x] for row, x in zip(A, b)]
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(M[i][k]))
        if abs(M[p][k]) < 1e-9:
            return None
        M[k], M[p] = M[p], M[k]
        for i in range(n):
            if i != k:
                f = M[i][k] / M[k][k]
                for j in range(k, n + 1):
                    M[i][j] -= f * M[k][j]
    return [M[i][n] / M[i][i] for i in range(n)]
