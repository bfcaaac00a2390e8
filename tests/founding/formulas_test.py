#!/usr/bin/env python3
"""The checker checks itself first: the evaluator reads formulas as the model language does, and refuses the rest."""

import sys

from formulas import NotAFormula
from sheet import *

test = Tests()


def gives(text, expected, **names):
    got = Formula(text).value(names)
    need(close(got, expected), f"{text} is {got}, expected {expected}")


@test("precedence: powers before products before sums, from left to right")
def _(program):
    gives("2 + 3*4^2/8", 8)
    gives("-2^2", -4)
    gives("8/4/2", 1)
    gives("8 - 4 - 2", 2)
    gives("2^-1", 0.5)
    gives("2^3^2", 512)
    gives("-a*b/(a + b)", -2 * 3 / 5, a=2, b=3)


@test("functions and constants")
def _(program):
    gives("acos(2/3)", math.acos(2 / 3))
    gives("sqrt(l^2 - r^2*sin(phi)^2)", math.sqrt(9 - 4 * math.sin(1) ** 2), l=3, r=2, phi=1)
    gives("cos(pi/3)", 0.5)
    gives("atan2(1, -1)", 3 * math.pi / 4)


@test("what is no formula is refused")
def _(program):
    for text in ("", "2 +", "a b", "sin x", "(1", "1)", "a..b", "__import__('os')", "2 $ 3"):
        try:
            Formula(text)
        except NotAFormula:
            continue
        raise Failure(f"{text!r} was accepted")


@test("a wrong formula is found at random points")
def _(program):
    points = Points(lambda rng: {"m": positive(rng), "g": positive(rng)})
    points.same("m*g", lambda p: p["m"] * p["g"], "right")
    try:
        points.same("m*g*(1 + 1/1000000)", lambda p: p["m"] * p["g"], "wrong")
    except Failure:
        return
    raise Failure("a relative error of 1e-6 was not seen")


if __name__ == "__main__":
    sys.exit(test.main(sys.argv[0]))
