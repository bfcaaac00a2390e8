"""Reads and evaluates the `expr` strings of pleuel's JSON: names, numbers, + - * / ^, brackets, calls, pi, infinity.

Written from the description in docs/json.md alone, so that it also shows that any program can evaluate them.
"""

import math
import re

TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?)|([A-Za-z_][A-Za-z_0-9]*(?:\[[^\]]*\])?)|(\*\*|[-+*/^(),]))")

FUNCTIONS = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "atan2": math.atan2, "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh, "sqrt": math.sqrt, "exp": math.exp,
    "ln": math.log, "log": math.log, "abs": abs, "min": min, "max": max,
    "sign": lambda x: (x > 0) - (x < 0),
    "if": lambda condition, then, otherwise: then if condition > 0 else otherwise,
}


class NotAFormula(Exception):
    pass


def tokens_of(text):
    at, out = 0, []
    while at < len(text.rstrip()):
        m = TOKEN.match(text, at)
        if not m:
            raise NotAFormula(f"cannot read {text!r} at {at}")
        out.append(m.group(m.lastindex))
        at = m.end()
    return out


class Formula:
    """A parsed formula.  value(names) gives a float; names holds floats by name."""

    def __init__(self, text):
        self.text = text
        self.tokens = tokens_of(text)
        self.at = 0
        self.names = set()
        self.tree = self.sum()
        if self.at != len(self.tokens):
            raise NotAFormula(f"{text!r}: {self.tokens[self.at]!r} is left over")

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, expected=None):
        token = self.peek()
        if token is None or (expected and token != expected):
            raise NotAFormula(f"{self.text!r}: {expected or 'more'} expected, {token!r} found")
        self.at += 1
        return token

    def sum(self):
        left = self.product()
        while self.peek() in ("+", "-"):
            left = (self.take(), left, self.product())
        return left

    def product(self):
        left = self.signed()
        while self.peek() in ("*", "/"):
            left = (self.take(), left, self.signed())
        return left

    def signed(self):
        if self.peek() in ("-", "+"):
            sign = self.take()
            inner = self.signed()
            return ("neg", inner) if sign == "-" else inner
        return self.power()

    def power(self):
        base = self.atom()
        if self.peek() == "^":
            self.take()
            return ("^", base, self.signed())
        return base

    def atom(self):
        token = self.take()
        if token == "(":
            inner = self.sum()
            self.take(")")
            return inner
        if token[0].isdigit():
            return ("number", float(token))
        if not (token[0].isalpha() or token[0] == "_"):
            raise NotAFormula(f"{self.text!r}: {token!r} is no operand")
        if token in FUNCTIONS and self.peek() == "(":
            return self.call(token)
        if token == "pi":
            return ("number", math.pi)
        if token in ("infinity", "oo", "inf"):
            return ("number", math.inf)
        self.names.add(token)
        return ("name", token)

    def call(self, name):
        self.take("(")
        args = [self.sum()]
        while self.peek() == ",":
            self.take()
            args.append(self.sum())
        self.take(")")
        return ("call", name, args)

    def value(self, names):
        return evaluate(self.tree, names)


def evaluate(tree, names):
    kind = tree[0]
    if kind == "number":
        return tree[1]
    if kind == "name":
        if tree[1] not in names:
            raise NotAFormula(f"{tree[1]} has no value here")
        return names[tree[1]]
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
    return a ** b


def close(a, b, rel=1e-9, scale=0.0):
    """Equal up to rounding; scale is the size of the terms that make up a and b."""
    if math.isnan(a) or math.isnan(b):
        return False
    return a == b or abs(a - b) <= rel * max(abs(a), abs(b), scale, 1e-12)
