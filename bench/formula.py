"""Reads a printed formula, counts its operations and evaluates it.

One reader for what pleuel, SymPy and Maxima print, so that all are counted in the same way: every + - * / ^, every
unary minus and every call is one operation; a product written as a blank is a product, a raised 2 is a power.
"""
import math
import re

FUNCTIONS = {"sin": math.sin, "cos": math.cos, "tan": math.tan, "sqrt": math.sqrt, "√": math.sqrt, "abs": abs,
             "csc": lambda x: 1 / math.sin(x), "sec": lambda x: 1 / math.cos(x), "cot": lambda x: 1 / math.tan(x),
             "asin": math.asin, "acos": math.acos, "atan": math.atan, "exp": math.exp, "log": math.log}
RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹"
TOKEN = re.compile(rf"\s*(\d+\.?\d*|[A-Za-zα-ωΑ-Ωϑ_%][A-Za-z0-9α-ωΑ-Ωϑ_]*'*|[{RAISED}]+|√|\*\*|[-+*/^()])")


def tokens(text):
    found, at = [], 0
    text = text.strip()
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise ValueError(f"cannot read {text[at:at + 20]!r}")
        found.append("^" if match[1] == "**" else match[1])
        at = match.end()
    return found


class Reader:
    """Recursive descent; a node is a number, a name, or (operator, operands...)."""

    def __init__(self, text):
        self.rest = tokens(text)[::-1]

    def peek(self):
        return self.rest[-1] if self.rest else ""

    def take(self, expected=None):
        token = self.rest.pop()
        if expected and token != expected:
            raise ValueError(f"expected {expected}, found {token}")
        return token

    def sum(self):
        left = self.product()
        while self.peek() in ("+", "-"):
            left = (self.take(), left, self.product())
        return left

    def product(self):
        if self.peek() in ("-", "+"):
            return ("neg", self.product()) if self.take() == "-" else self.product()
        left = self.power()
        while self.peek() not in ("", "+", "-", ")"):
            operator = self.take() if self.peek() in ("*", "/") else "*"
            left = (operator, left, self.power())
        return left

    def exponent(self, base):
        if self.peek() == "^":
            self.take()
            return ("^", base, ("neg", self.power()) if self.peek() == "-" and self.take() else self.power())
        if self.peek() and self.peek()[0] in RAISED:
            return ("^", base, float("".join(str(RAISED.index(c)) for c in self.take())))
        return base

    def power(self):
        if self.peek() in FUNCTIONS:
            return self.call()
        return self.exponent(self.atom())

    def atom(self):
        token = self.take()
        if token == "(":
            inside = self.sum()
            self.take(")")
            return inside
        if token[0].isdigit():
            return float(token)
        if token in ("*", "/", "^", ")", "+", "-") or token[0] in RAISED:
            raise ValueError(f"unexpected {token}")
        return token

    def call(self):
        """sin(a)^2, sin²a and sin a: without brackets a function takes one factor."""
        name, raised = self.take(), None
        if self.peek() and self.peek()[0] in RAISED:
            raised = float("".join(str(RAISED.index(c)) for c in self.take()))
        bracket = self.peek() == "("
        inside = self.atom() if bracket else self.power()
        node = (name, inside)
        return ("^", node, raised) if raised is not None else self.exponent(node) if bracket else node


def read(text):
    reader = Reader(text)
    tree = reader.sum()
    if reader.rest:
        raise ValueError(f"left over: {reader.peek()}")
    return tree


def operations(tree):
    return 1 + sum(map(operations, tree[1:])) if isinstance(tree, tuple) else 0


def symbol(name):
    """x' is called x_dot, λ_c lambda_c."""
    primes = len(name) - len(name.rstrip("'"))
    return name.rstrip("'").replace("λ", "lambda") + ["", "_dot", "_ddot"][primes]


def names(tree):
    if isinstance(tree, str):
        return {symbol(tree)}
    return set().union(*map(names, tree[1:])) if isinstance(tree, tuple) else set()


def value(tree, at):
    """The value of a formula with the names of `at`; x' is called x_dot there."""
    if isinstance(tree, float):
        return tree
    if isinstance(tree, str):
        return at[symbol(tree)]
    operands = [value(operand, at) for operand in tree[1:]]
    if tree[0] in FUNCTIONS:
        return FUNCTIONS[tree[0]](*operands)
    if tree[0] == "neg":
        return -operands[0]
    a, b = operands
    return {"+": lambda: a + b, "-": lambda: a - b, "*": lambda: a * b, "/": lambda: a / b, "^": lambda: a ** b}[tree[0]]()
