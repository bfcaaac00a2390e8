#!/usr/bin/env python3
"""Models whose closed forms explode: the program ends, and what it shows passes its own checks.  Usage: nasty_test.py PROGRAM"""
import math
import os
import re
import sys
import tempfile

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "founding"))
from sheet import Tests, need, program_of, run  # noqa: E402

test = Tests()
HEAD = "param m = 1 [kg], l = 1 [m], k = 2 [J], g = 9.81 [m/s^2]\n"
ANGLES = "a b c d e f u h".split()


def nested(word, depth):
    for _ in range(depth):
        word = f"sin({word} + b)"
    return word


def radical(depth):
    word = "x^2 + l^2"
    for _ in range(depth):
        word = f"l*sqrt({word}) + x^2 + l^2"
    return f"sqrt({word})"


def rods(n):
    text = f"param {', '.join(f'm{i} = 1 [kg], l{i} = 1 [m]' for i in range(1, n + 1))}, g = 9.81 [m/s^2]\n"
    text += f"coord {', '.join(ANGLES[:n])}\naxes x right, y up\n"
    for i in range(1, n + 1):
        x, y = ("+".join(f"l{j}*{f}({ANGLES[j - 1]})" for j in range(1, i + 1)) for f in ("sin", "cos"))
        text += f"mass m{i} at ({x}, -({y}))\n"
    return text + "gravity g along -y\nask lagrange2\n"


MODELS = {
    "a product of eight angles": HEAD + f"coord {', '.join(ANGLES)}\n"
        f"kinetic m*l^2/2*({' + '.join(f'{n}_dot^2' for n in ANGLES)})\n".replace("_dot", "'")
        + f"potential k*{'*'.join(f'cos({n})' for n in ANGLES)}\nask lagrange2\n",
    "nested sines": HEAD + f"coord a, b\naxes x right, y up\nmass m at (l*{nested('a', 3)}, l*b)\ngravity g along -y\nask lagrangian\n",
    "nested roots": HEAD + f"coord x, y\naxes x right, y up\nmass m at (x, y)\ngravity g along -y\n"
        f"constraint s: y = {radical(6)}\nask lagrange1, solve λ_s\n",
    "eight rods in angles": rods(8),
}


def declare(name, text):
    @test(f"{name}: it ends, and every check passes")
    def _(program):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "nasty.pleuel")
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)
            document = run(program, path, "--no-simulation").document
        need(document["status"] == "ok", f"status {document['status']}: {document.get('message')}")
        need(document["checks"] and all(c["passed"] for c in document["checks"]), f"checks {document['checks']}")
        need(any(document["answers"].values()), "no answers")


for name, text in MODELS.items():
    declare(name, text)

@test("multiples of an angle that are far apart: formulas keep their digits in doubles")
def _(program):
    potentials = ["cos(0.95 θ + 0.32 x)", "cos(0.95 θ) cos(θ)", "sin(13 θ) cos(x)", "cosh(0.95 θ) + cosh(x/7) + cosh(x)"]
    for potential in potentials:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "multiples.pleuel")
            with open(path, "w", encoding="utf-8") as out:
                out.write(f"coord θ, x\nlagrangian 1/2 θ'^2 + 1/2 x'^2 - {potential}\nask a: lagrange2\n")
            document = run(program, path, "--no-simulation").document
        need(document["status"] == "ok", f"{potential}: {document['status']}")
        expr = next(v["expr"] for item in document["answers"]["a"] for v in item["values"] if v["name"] == "theta_ddot")
        need(len(expr) < 200, f"{potential}: {expr}")
        names = {f: getattr(math, f) for f in ("sin", "cos", "sinh", "cosh")}
        value = lambda text, **at: eval(text.replace("^", "**"), {"__builtins__": {}}, names | at)
        plain = re.sub(r"(\d) ([θx])", r"\1*\2", potential).replace(") c", ")*c").replace("θ", "theta")
        for theta, x in ((0.3, -1.1), (1.7, 2.3), (-2.9, 0.4)):
            step = 1e-5          # difference quotient, good to ten digits
            slope = (value(plain, theta=theta + step, x=x) - value(plain, theta=theta - step, x=x)) / (2 * step)
            got = value(expr, theta=theta, x=x)
            need(abs(got + slope) < 1e-7 * (1 + abs(slope)), f"{potential}: {got} for {-slope} at {theta}, {x}")


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
