"""Expressions for the witness: interned, differentiated by rule, compiled to Python.

Written for the tests alone, so that nothing of the program's own algebra takes part.
"""

import math


class E:
    """One node.  op: num, name, +, *, /, ^ or the name of a function."""

    __slots__ = ("op", "args", "number")
    pool = {}

    def __new__(cls, op, *args):
        key = (op,) + tuple(id(a) if isinstance(a, E) else a for a in args)
        found = cls.pool.get(key)
        if found is None:
            found = object.__new__(cls)
            found.op, found.args, found.number = op, args, len(cls.pool)
            cls.pool[key] = found
        return found

    def __add__(self, o):
        return add(self, of(o))

    def __radd__(self, o):
        return add(of(o), self)

    def __sub__(self, o):
        return add(self, mul(num(-1), of(o)))

    def __rsub__(self, o):
        return add(of(o), mul(num(-1), self))

    def __mul__(self, o):
        return mul(self, of(o))

    def __rmul__(self, o):
        return mul(of(o), self)

    def __truediv__(self, o):
        return div(self, of(o))

    def __rtruediv__(self, o):
        return div(of(o), self)

    def __neg__(self):
        return mul(num(-1), self)

    def __pow__(self, o):
        return power(self, of(o))


def num(x):
    return E("num", float(x))


def name(s):
    return E("name", s)


def of(x):
    return x if isinstance(x, E) else num(x)


ZERO, ONE = num(0), num(1)


def is_num(e, x=None):
    return e.op == "num" and (x is None or e.args[0] == x)


def add(a, b):
    if is_num(a, 0):
        return b
    if is_num(b, 0):
        return a
    if is_num(a) and is_num(b):
        return num(a.args[0] + b.args[0])
    return E("+", a, b)


def mul(a, b):
    if is_num(a, 0) or is_num(b, 0):
        return ZERO
    if is_num(a, 1):
        return b
    if is_num(b, 1):
        return a
    if is_num(a) and is_num(b):
        return num(a.args[0] * b.args[0])
    return E("*", a, b)


def div(a, b):
    if is_num(b, 1):
        return a
    if is_num(a, 0):
        return ZERO
    if is_num(a) and is_num(b) and b.args[0] != 0:
        return num(a.args[0] / b.args[0])
    return E("/", a, b)


def power(a, b):
    if is_num(b, 0):
        return ONE
    if is_num(b, 1):
        return a
    if is_num(a) and is_num(b):
        try:
            value = a.args[0] ** b.args[0]
            if isinstance(value, float):
                return num(value)
        except (ZeroDivisionError, OverflowError):
            pass
    return E("^", a, b)


def call(f, *args):
    if all(is_num(a) for a in args):
        try:
            return num(PYTHON[f](*[a.args[0] for a in args]))
        except (ValueError, ZeroDivisionError, OverflowError):
            pass
    return E(f, *args)


def sign(x):
    return float((x > 0) - (x < 0))


def heaviside_if(c, a, b):
    return a if c > 0 else b


PYTHON = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos,
    "atan": math.atan, "atan2": math.atan2, "sinh": math.sinh, "cosh": math.cosh,
    "tanh": math.tanh, "sqrt": math.sqrt, "exp": math.exp, "ln": math.log, "abs": abs,
    "sign": sign, "min": min, "max": max, "if": heaviside_if,
}


def slope(f, i, a):
    """The derivative of a function by its argument number i."""
    x = a[0]
    if f == "atan2":
        r = a[0] * a[0] + a[1] * a[1]
        return a[1] / r if i == 0 else -a[0] / r
    if f in ("min", "max"):
        first = call("if", x - a[1], *((ONE, ZERO) if f == "max" else (ZERO, ONE)))
        return first if i == 0 else 1 - first
    if f == "if":
        return (ZERO, call("if", x, ONE, ZERO), call("if", x, ZERO, ONE))[i]
    return {
        "sin": lambda: call("cos", x), "cos": lambda: -call("sin", x),
        "tan": lambda: 1 + call("tan", x) ** 2, "asin": lambda: 1 / call("sqrt", 1 - x * x),
        "acos": lambda: -1 / call("sqrt", 1 - x * x), "atan": lambda: 1 / (1 + x * x),
        "sinh": lambda: call("cosh", x), "cosh": lambda: call("sinh", x),
        "tanh": lambda: 1 - call("tanh", x) ** 2, "sqrt": lambda: 1 / (2 * call("sqrt", x)),
        "exp": lambda: call("exp", x), "ln": lambda: 1 / x, "abs": lambda: call("sign", x),
        "sign": lambda: ZERO,
    }[f]()


def diff(e, by, memo=None):
    """de/d(by); by is a name."""
    memo = {} if memo is None else memo
    if e in memo:
        return memo[e]
    if e.op == "num":
        out = ZERO
    elif e.op == "name":
        out = ONE if e.args[0] == by else ZERO
    else:
        out = diff_node(e, by, memo)
    memo[e] = out
    return out


def diff_node(e, by, memo):
    d = [diff(a, by, memo) for a in e.args]
    a = e.args
    if e.op == "+":
        return d[0] + d[1]
    if e.op == "*":
        return d[0] * a[1] + a[0] * d[1]
    if e.op == "/":
        return d[0] / a[1] - a[0] * d[1] / (a[1] * a[1]) if not is_num(d[1], 0) else d[0] / a[1]
    if e.op == "^" and is_num(d[1], 0):
        return a[1] * power(a[0], a[1] - 1) * d[0] if not is_num(d[0], 0) else ZERO
    if e.op == "^":
        return e * (d[1] * call("ln", a[0]) + a[1] * d[0] / a[0])
    out = ZERO
    for i, di in enumerate(d):
        if not is_num(di, 0):
            out = out + slope(e.op, i, a) * di
    return out


def names_of(e, found=None, seen=None):
    found = set() if found is None else found
    seen = set() if seen is None else seen
    stack = [e]
    while stack:
        x = stack.pop()
        if x in seen or x.op == "num":
            continue
        seen.add(x)
        if x.op == "name":
            found.add(x.args[0])
        else:
            stack.extend(x.args)
    return found


def replaced(e, by, memo=None):
    """e with names replaced: by is a dict from names to expressions."""
    memo = {} if memo is None else memo
    if e in memo:
        return memo[e]
    if e.op == "name":
        out = by.get(e.args[0], e)
    elif e.op == "num":
        out = e
    else:
        a = [replaced(x, by, memo) for x in e.args]
        make = {"+": add, "*": mul, "/": div, "^": power}.get(e.op)
        out = make(*a) if make else call(e.op, *a)
    memo[e] = out
    return out


def compiled(roots, names):
    """A Python function of a list of numbers (in the order of names) that gives the values of roots."""
    place = {n: i for i, n in enumerate(names)}
    lines, done, constants = [], {}, {}

    def emit(e):
        stack = [(e, False)]
        while stack:
            x, ready = stack.pop()
            if x in done:
                continue
            if x.op == "num":
                done[x] = repr(x.args[0]) if math.isfinite(x.args[0]) else f"float('{x.args[0]}')"
            elif x.op == "name":
                done[x] = f"z[{place[x.args[0]]}]"
            elif not ready:
                stack.append((x, True))
                stack.extend((a, False) for a in x.args)
            else:
                a = [done[y] for y in x.args]
                if x.op in "+*/":
                    text = f"{a[0]} {x.op} {a[1]}"
                elif x.op == "^":
                    text = f"power(({a[0]}), {a[1]})"
                else:
                    constants[x.op] = PYTHON[x.op]
                    text = f"f_{x.op}({', '.join(a)})"
                done[x] = f"v{len(done)}"
                lines.append(f"  {done[x]} = {text}")

    for r in roots:
        emit(r)
    body = "\n".join(["def program(z):"] + lines + ["  return [" + ", ".join(done[r] for r in roots) + "]"])
    room = {f"f_{k}": f for k, f in constants.items()}
    room["power"] = real_power
    exec(compile(body, "<witness>", "exec"), room)  # noqa: S102  our own text
    return room["program"]


def real_power(a, b):
    if b == int(b):
        return a ** int(b)
    return a ** b if a >= 0 else math.nan
