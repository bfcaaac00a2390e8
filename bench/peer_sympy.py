"""Derives one system with SymPy.  Usage: peer_sympy.py SYSTEM; prints a line of JSON for each stage.

LagrangesMethod, then LUsolve for accelerations and multipliers ("solved"), then simplify on each ("simplified").
The clock starts after the import and the reading of the formulas.
"""
import json
import sys
import time

import sympy
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from systems import NUMBERS, SYSTEMS


def main(name):
    _, coords, masses, potential, constraints, _ = SYSTEMS[name]
    t = dynamicsymbols._t
    q = [dynamicsymbols(n) for n in coords.split()]
    names = dict(zip(coords.split(), q)) | {"t": t}

    def formula(text):
        given = {n: sympy.Symbol(n, positive=True) for n in NUMBERS if n not in names}
        return sympy.sympify(text.replace("^", "**"), locals=given | names)

    places = [(formula(m), [formula(p) for p in place]) for m, *place in masses]
    potential, rows = formula(potential), [formula(c) for c in constraints]

    start = time.process_time()
    kinetic = sum(m * p.diff(t) ** 2 for m, place in places for p in place) / 2
    method = LagrangesMethod(kinetic - potential, q, hol_coneqs=rows or None)
    method.form_lagranges_equations()
    n = len(q)
    results = list(method.mass_matrix_full[n:, n:].LUsolve(method.forcing_full[n:, :]))
    tell("solved", start, results, q, t)
    tell("simplified", start, [sympy.simplify(r) for r in results], q, t)


def tell(stage, start, results, q, t):
    ms = 1e3 * (time.process_time() - start)
    plain = [(x.diff(t), sympy.Symbol(f"{x.func}_dot")) for x in q] + [(x, sympy.Symbol(str(x.func))) for x in q]
    print(json.dumps({"stage": stage, "ms": ms, "results": [str(r.subs(plain)) for r in results]}), flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "--version":
        print(sympy.__version__)
    else:
        main(sys.argv[1])
