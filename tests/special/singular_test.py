#!/usr/bin/env python3
"""Mass matrices that are singular by their values, equations without accelerations, constraints that lose rank at the start.  The reduced
system is held against the same system with a small mass where there was none: its slow motion, computed here.

    singular_test.py PROGRAM
"""

import json
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402


def call(program, verb, text):
    got = subprocess.run([program, verb, "--json", "-"], input=text, capture_output=True, text=True, timeout=60)
    document = json.loads(got.stdout) if got.stdout.strip() else {}
    return document, got


def words(answers):
    return " ".join(s.get("text", "") for a in answers for s in a["steps"])


def every(document):
    return [a for letter in document["answers"].values() for a in letter]


def solve_linear(A, b):
    n = len(b)
    M = [list(A[i]) + [b[i]] for i in range(n)]
    for k in range(n):
        p = max(range(k, n), key=lambda r: abs(M[r][k]))
        M[k], M[p] = M[p], M[k]
        for i in range(k + 1, n):
            f = M[i][k] / M[k][k]
            for j in range(k, n + 1):
                M[i][j] -= f * M[k][j]
    x = [0.0] * n
    for k in reversed(range(n)):
        x[k] = (M[k][n] - sum(M[k][j] * x[j] for j in range(k + 1, n))) / M[k][k]
    return x


# name, coordinates, T as a quadratic form, V as one, freedoms left
HIDDEN = [
    ("two coordinates that only move together", "xy", [[1, 1], [1, 1]], [[2, 0], [0, 3]], 1),
    ("a sum and a free mass", "xyz", [[1, 1, 0], [1, 1, 0], [0, 0, 3]], [[2, 0, 0], [0, 2, -2], [0, -2, 2]], 2),
    ("a difference with weights", "xy", [[4, -2], [-2, 1]], [[1, 0], [0, 5]], 1),
    ("rank one of three", "xyz", [[1, 2, -1], [2, 4, -2], [-1, -2, 1]], [[3, 1, 0], [1, 2, 0], [0, 0, 4]], 1),
    ("a coordinate without mass", "xy", [[2, 0], [0, 0]], [[1, -1], [-1, 2]], 1),
]


def form(names, A, dot):
    terms = [f"({A[i][j]}/2) {a}{dot} {b}{dot}" for i, a in enumerate(names) for j, b in enumerate(names) if A[i][j]]
    return " + ".join(terms)


def check_hidden(program, name, names, M, K, freedoms):
    text = f"coord {', '.join(names)}\nlagrangian {form(names, M, chr(39))} - ({form(names, K, '')})\nask dof, modes, solve {names[0]}''\n"
    document, got = call(program, "solve", text)
    tap.check(f"{name}: {freedoms} freedoms", document["dof"]["dof"] == freedoms, document["dof"])
    tap.check(f"{name}: as many hidden constraints as are missing", len(document["dof"]["hidden"]) == len(names) - freedoms, document["dof"])
    tap.check(f"{name}: no check fails", got.returncode == 0, got.stderr)
    # hidden constraints by hand: null vectors w of M give w K q = 0; frequencies on what is left
    found = sorted(v["number"] if v["number"] is not None else math.nan for v in every(document)[1]["values"] if v["name"] == "omega^2")
    wanted = frequencies(M, K)
    tap.check(f"{name}: the frequencies are those of a small mass's slow motion", len(found) == len(wanted) and
              all(abs(a - b) < 1e-3 * (1 + abs(b)) for a, b in zip(found, wanted)), (found, wanted))


def determinant(A):
    A = [list(r) for r in A]
    n, d = len(A), 1.0
    for k in range(n):
        p = max(range(k, n), key=lambda r: abs(A[r][k]))
        if A[p][k] == 0:
            return 0.0
        if p != k:
            A[k], A[p], d = A[p], A[k], -d
        d *= A[k][k]
        for i in range(k + 1, n):
            f = A[i][k] / A[k][k]
            for j in range(k, n):
                A[i][j] -= f * A[k][j]
    return d


def frequencies(M, K):
    """Finite roots of det(K - w2 (M + tiny)): signs on a fine grid."""
    n, tiny = len(M), 1e-7

    def f(w2):
        return determinant([[K[i][j] - w2 * (M[i][j] + (tiny if i == j else 0)) for j in range(n)] for i in range(n)])
    roots, last = [], f(-0.00123)
    if abs(f(0)) < 1e-9:
        roots.append(0.0)
    steps = 60000
    for k in range(1, steps):
        w2 = -0.00123 + 50 * k / steps
        here = f(w2)
        if last * here < 0 and not (roots and abs(roots[-1] - w2) < 0.002):
            roots.append(w2)
        last = here
    return roots


def check_first_order(program):
    document, got = call(program, "sim", "coord x\nlagrangian x x'\nsimulate 0..1\n")
    tap.check("no motion is made up for a Lagrange function that is a total derivative", got.returncode == 6, (got.returncode, got.stdout[:300]))
    document, got = call(program, "solve", "coord x\nlagrangian x x'\nask dof, lagrange2\nsimulate 0..1\n")
    tap.check("and the freedoms are told not to be determined", "mass matrix is singular" in words(every(document)), words(every(document)))
    text = "coord x, y\nlagrangian x y' - (x^2 + y^2)/2\nask dof, lagrange1, lagrange2\nsimulate 0..1\n"
    document, got = call(program, "solve", text)
    tap.check("equations of first order: no check of right equations fails", got.returncode in (0, 6) and all(c["passed"] for c in document["checks"]),
              document["checks"])
    document, got = call(program, "sim", "coord x, u\naxes x right\nmass A: 1 at (x)\npotential 1/2 (x - u)^2 + 1/2 u^2\nsimulate 0..1\n")
    tap.check("a place without mass that forces determine is not said to be free", got.returncode == 6 and "nothing determines" not in got.stderr,
              got.stderr)


def check_rank(program):
    base = "axes x right, y up, z out\nparam m = 1, a = 1\ncoord x, y, z\nmass m at (x, y, z)\nconstraint c1: x^2 + y^2 = a^2\nconstraint c2: (x - 2 a)^2 + y^2 + z^2 = a^2\n"
    lost = "At the start the constraints lose rank"
    document, _ = call(program, "solve", base + "init x = 1, y = 0, z = 0, x' = 0, y' = 0, z' = 1\nask dof, solve λ_c1\n")
    said = words(every(document))
    tap.check("two spheres that touch: the freedoms say so", lost in said and "of 2 gradients 1 is independent" in said, said)
    tap.check("and so does the multiplier", "λ_c1 has no value there" in said, said)
    base = base.replace("(x - 2 a)^2", "(x - a)^2")
    document, _ = call(program, "solve", base + "init x = 1/2, y = 3^(1/2)/2, z = 0, x' = 0, y' = 0, z' = 0\nask dof, solve λ_c1\n")
    said = words(every(document))
    tap.check("where they cross nothing is said", lost not in said and "no value" not in said, said)


def check_manifold(program):
    """Bars that are parallel on one coupler: their gradients depend on each other only where all constraints hold."""
    def bars(l, third):
        out = "coord x, y, a0, a1, a2\naxes x right, y up\nmass coupler: 2 at (x, y)\ngravity 9.81 along -y\n"
        for k, length in enumerate((l, l, third)):
            out += f"constraint b{k}x: x = {k + 1} + {length} sin a{k} - {k}\nconstraint b{k}y: y = {length} cos a{k}\n"
        return out + "ask dof, lagrange2\n"
    document, got = call(program, "solve", bars("1", "1") + "init a0 = 0.3, a1 = 0.3, a2 = 0.3\n")
    tap.check("three parallel bars on a coupler: one freedom", (document["dof"]["rank"], document["dof"]["dof"]) == (4, 1), document["dof"])
    tap.check("and no check of its own fails", got.returncode == 0, got.stderr)
    document, _ = call(program, "solve", "param l\n" + bars("l", "l"))
    tap.check("the same with a letter for the length", document["dof"]["dof"] == 1, document["dof"])
    document, _ = call(program, "solve", bars("1", "1").replace("x = 3 + 1 sin a2 - 2", "x = 3/2 + 1 sin a2") + "init a0 = 0.3, a1 = 0.3\n")
    tap.check("a third bar that is not parallel holds the coupler", document["dof"]["dof"] == 0, document["dof"])


def main(program):
    for case in HIDDEN:
        check_hidden(program, *case)
    check_first_order(program)
    check_rank(program)
    check_manifold(program)
    tap.done()


if __name__ == "__main__":
    main(sys.argv[1])
