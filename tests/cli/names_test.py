#!/usr/bin/env python3
"""A declared name hides the result of that name: no letter means two things on a page.  Usage: names_test.py PLEUEL"""
import os
import re
import subprocess
import sys

from tap import check, done

program = os.path.abspath(sys.argv[1])
clean = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "COLUMNS")} | {"LC_ALL": "C.UTF-8"}

MODEL = """param {L} = 3 [m], m1 = 3 [kg], m2 = 2 [kg], g = 9.81 [m/s^2], {M} = 1 [kg], {E} = 3 [N/m], {V} = 1 [N], {T} = 2 [N], {H} = 1 [m]
coord x1, x2
axes x down
mass m1 at (x1)
mass m2 at (x2)
mass B: {M} at (x1)
gravity g along x
potential {E} x1^2/2 + {V} x1
force ({T}) on m1
constraint g1: x1 + x2 = {L} + {H} with λ
init x1 = 1 [m], x1' = 0
ask lagrangian, lagrange1, lagrange2, conserved, hamiltonian, kinetic, energy
simulate 0..1 [s] count 2
"""
LETTERS = "LMEVTH"
OTHERS = {"L": "L_Lag", "E": "E_tot", "V": "V_pot", "T": "T_kin", "H": "H_Ham"}


def pleuel(*arguments, text):
    run = subprocess.run([program, *arguments], input=text, capture_output=True, text=True, encoding="utf-8", env=clean, timeout=60)
    return run.returncode, run.stdout


for lang in ("en", "de"):
    for letter in LETTERS:
        names = {x: x if x == letter else f"{x.lower()}z" for x in LETTERS}
        code, out = pleuel("solve", "-", "--steps", "full", "--lang", lang, text=MODEL.format(**names))
        # what begins a line `X =` is a result
        results = set(re.findall(r"^ +(?:[dD]\S* )?([A-Z]\w*) = ", out, re.M)) | set(re.findall(r"∂([A-Z]\w*)/∂", out)) | set(re.findall(r"d([A-Z]\w*)/dt", out))
        check(f"{lang}: {letter} is declared, and no result bears its name", code == 0 and letter not in results, f"{code} {results}\n{out}")
        if letter in OTHERS:
            check(f"{lang}: the result is called {OTHERS[letter]}", OTHERS[letter] in results, f"{results}\n{out}")
        else:
            check(f"{lang}: all others keep their letters", {"L", "T", "V", "E", "H"} <= results, f"{results}\n{out}")

code, out = pleuel("solve", "-", "--steps", "full", text="""param r = 1 [m], l = 3 [m], m1 = 1 [kg], J = 2 [kg m^2], M = 5 [kg], g = 9.81 [m/s^2]
assume r < l
coord φ, x2
axes x right, z up
mass m1 at (r cos φ, r sin φ)
mass B: M at (x2, 0)
gravity g along -z
kinetic J φ'^2/2
constraint k: (x2 - r cos φ)^2 + (r sin φ)^2 = l^2
branch x2 > r cos φ
choose φ
ask lagrange2
""")
check("M(φ) beside a mass M is called M_eff(φ)", code == 0 and "M_eff(φ) = " in out and "M(φ)" not in out, out)

code, out = pleuel("sim", "-", "-o", "-", text="""param m = 1 [kg], k = 2 [N/m]
coord E, T
axes x right, y up
mass m at (E, T)
potential k E^2/2 + k T^2/2
init E = 1 [m], T = 1 [m], E' = 0, T' = 0
simulate 0..1 [s] count 2
plot kinetic, energy vs t
""")
head = [column.split(" ")[0] for column in out.splitlines()[0].split(",")]
check("columns have one name each", code == 0 and len(set(head)) == len(head) and "T_kin" in head and "E_tot" in head, head)
done()
