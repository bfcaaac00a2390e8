#!/usr/bin/env python3
"""`sim --engine`: compiled and interpreted steps give the same bytes, whatever the state of the store on disk.

Usage: engine_test.py PLEUEL MODEL...
"""
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
import tap

program, models = sys.argv[1], sys.argv[2:]


def sim(model, *flags, **environment):
    return subprocess.run([program, "sim", model, "-o", "-", *flags], capture_output=True, text=True,
                          env=os.environ | {"LC_ALL": "C.UTF-8", "PLEUEL_CACHE": "off"} | environment)


def told(done):
    return next((line for line in done.stderr.splitlines() if "interpret" in line), "")


for model in models:
    name = pathlib.Path(model).stem
    plain = sim(model, "--engine", "interpreter", "-v")
    tap.check(f"{name} is simulated by the interpreter", plain.returncode == 0 and "steps, interpreted" in told(plain), plain.stderr)
    compiled = sim(model, "--engine", "compiled", "-v")
    if "compiler plugin" in told(compiled):
        tap.skip(f"{name}: compiled steps give the same rows", told(compiled).strip())
    else:
        tap.check(f"{name} is compiled", compiled.returncode == 0 and "the others compiled" in told(compiled), compiled.stderr)
    tap.check(f"{name}: compiled steps give the same rows", compiled.stdout == plain.stdout)
    chosen = sim(model)
    tap.check(f"{name}: the choice left to the program gives the same rows", chosen.stdout == plain.stdout)

with tempfile.TemporaryDirectory() as folder:
    first = sim(models[0], "--engine", "compiled", "-v", PLEUEL_CACHE="on", XDG_CACHE_HOME=folder)
    second = sim(models[0], "--engine", "compiled", "-v", PLEUEL_CACHE="on", XDG_CACHE_HOME=folder)
    if "compiler plugin" in told(first):
        tap.skip("what was compiled is found again", told(first).strip())
    else:
        tap.check("what was compiled is found again", "from disk" not in told(first) and "from disk" in told(second), told(first) + told(second))
    tap.check("rows from disk are the same", first.stdout == second.stdout)
    for file in pathlib.Path(folder, "pleuel").glob("*.o"):
        file.write_bytes(file.read_bytes()[:-100])
    third = sim(models[0], "--engine", "compiled", "-v", PLEUEL_CACHE="on", XDG_CACHE_HOME=folder)
    tap.check("a torn file is not used", third.stdout == first.stdout and "from disk" not in told(third), told(third))

ANGLES = """param m = 1, l = 1, g = 9.81
coord a, b
axes x right, y up
mass m at (l sin a, -l cos a)
mass m at (l sin a + l sin b, -l cos a - l cos b)
gravity g along -y
init a = 1, b = 1/2, a' = 0, b' = 0
simulate 0..5
"""
with tempfile.TemporaryDirectory() as folder:
    model = pathlib.Path(folder, "angles.pleuel")
    model.write_text(ANGLES, encoding="utf-8")
    done = sim(str(model), "--engine", "compiled", "-v")
    if "compiler plugin" in told(done):
        tap.skip("a system without constraints is compiled too", told(done).strip())
    else:
        words = told(done).split()
        tap.check("a system without constraints is compiled too", int(words[2]) <= 2 < int(words[0]), told(done))

wrong = sim(models[0], "--engine", "steam")
tap.check("an unknown engine is a wrong call", wrong.returncode != 0 and "steam" in wrong.stderr, wrong.stderr)
german = subprocess.run([program, "sim", models[0], "-v", "--lang", "de", "--engine", "interpreter"], capture_output=True, text=True,
                        env=os.environ | {"LC_ALL": "C.UTF-8"})
tap.check("it is told in German too", "interpretiert" in german.stdout, german.stdout)
tap.done()
