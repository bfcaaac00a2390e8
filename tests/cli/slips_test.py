#!/usr/bin/env python3
"""Slips: what is typed, and the sentence or the fix that must be in the answer.  Usage: slips_test.py PLEUEL"""
import os
import subprocess
import sys

from tap import check, done

program = os.path.abspath(sys.argv[1])
clean = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "COLUMNS")} | {"LC_ALL": "C.UTF-8"}

HEAD = """param m = 1 [kg], l = 0.5 [m], g = 9.81 [m/s^2]
coord x, y
axes x right, y up
mass A: m at (x, y)
point B at (0, l)
gravity g along -y
constraint rod: x^2 + y^2 = l^2
init x = 0.3 [m], y = -0.4 [m]
"""

# line added, what must be said, and what must not
REFUSED = [
    ("rod m between A and B", "write  rod mass m between A and B", "expected"),
    ("simulate 0 to 10 [s]", "write  simulate 0..10 [s]", "expected"),
    ("ask eom", "did you mean lagrange2?", "declare it"),
    ("ask equations of motion", "did you mean  lagrange2 ?", "expected"),
    ("ask degrees of freedom", "did you mean  dof ?", "expected"),
    ("ask DOF", "did you mean dof?", "declare it"),
    ("ask period", "did you mean modes?", "declare it"),
    ("ask frequency", "did you mean modes?", "declare it"),
    ("ask tension of rod", "did you mean  force of rod ?", "expected"),
    ("ask x when y = 0", "write  x where y = 0", "expected"),
    ("ask dof, x at y = 0", "write  x where y = 0", "expected"),
    ("ask force of rod at y = 0", "write  normal(rod) where y = 0", "a comma is missing"),
    ("plot E_kin vs t", "did you mean T?", "declare it"),
    ("init \\dot{x} = 0", "write x'", "E004"),
    ("init \\ddot{\\theta} = 0", "write theta''", "E004"),
    ("event stop when x = 0", "write  event stop: when x = 0 -> stop", "expected"),
    ("event low: when x = 0", "write  event low: when x = 0 -> stop", "expected"),
    ("event when x = 0 -> record", "write  event e: when x = 0 -> record", "reserved"),
    ("param q = 1,000 [kg]", "write 1.000, or 1000 if a thousand is meant", "Dezimalpunkt"),
    ("param q = 1,5 [kg]", "write 1.5", "thousand"),
    ("zwang x = 0", "did you mean constraint?", "lang"),
    ("feder 3 [N/m] between A and B", "did you mean spring?", None),
    ("ask threshold g of stable at x = 0 at y = 0", "a comma", ", ,"),
    ("param rest = 1", "rest is a reserved word", None),
]
for line, wanted, unwanted in REFUSED:
    run = subprocess.run([program, "check", "-"], input=HEAD + line + "\n", capture_output=True, text=True, encoding="utf-8", env=clean)
    said = run.stdout + run.stderr
    check(f"{line}: {wanted}", run.returncode == 3 and wanted in said and not (unwanted and unwanted in said), said)

run = subprocess.run([program, "check", "-"], input="param m = 1;\ncoord x;\nmass m at (x);\n", capture_output=True, text=True, encoding="utf-8",
                     env=clean)
check("a habit costs one message", (run.stdout + run.stderr).count("E002") == 1 and "and 2 more do not" in run.stdout + run.stderr, run.stderr)

# what is simply understood
ACCEPTED = [
    ("simulate 1 [s]", "simulated from t = 0 to 1 s"),
    ("simulate 1 [s] count 4", "simulated from t = 0 to 1 s"),
    ("simulate 1 [s] step 0.1 [s] tol 1e-9", "simulated from t = 0 to 1 s"),
    ("ask dof, simulate 1 [s]", "simulated from t = 0 to 1 s"),
    ("animate\nsimulate 1 [s]", "simulated from t = 0 to 1 s"),
    ("ask x(A)', y(A)'^2, x(A)''", "x(A)''"),
    ("mass at: m at (x, y + l)\nconstraint off: y(at) - y = l, redundant ok\nforce order: (1 [N], 0) on at\nask force of off, y(at)", "Force of off"),
    ("event rest: when x = 0 -> release rod\nsimulate 1 [s]", "simulated"),
    ("event step: when x = 1 [m] -> stop\nsimulate 1 [s]", "simulated"),
]
for line, wanted in ACCEPTED:
    run = subprocess.run([program, "solve", "-"], input=HEAD + line + "\n", capture_output=True, text=True, encoding="utf-8", env=clean)
    check(f"{line!r} is understood", run.returncode in (0, 5) and wanted in run.stdout and "E0" not in run.stderr, f"{run.returncode}\n{run.stdout}{run.stderr}")

# the language of the file is that of its messages, whole ones
run = subprocess.run([program, "check", "-"], input="lang de\nparam m = 1\ncoord x\naxes x right\nmass m at (x)\nmass m at (x)\nfoo\n", capture_output=True, text=True,
                     encoding="utf-8", env=clean)
said = run.stdout + run.stderr
check("lang de: German messages, no English halves", run.returncode == 3 and "ist keine Anweisung" in said and "line" not in said and "did you" not in said, said)

# the axis that is left, and a body that falls along one axis
for model, wanted in (("param m = 1 [kg], g = 9.81 [m/s^2]\ncoord x, y, z\naxes x right, z up\nmass A: m at (x, y, z)\ngravity g along -z\nask lagrangian\n",
                       "V = m g z"),
                      ("param m = 1 [kg], g = 9.81 [m/s^2]\ncoord x, y, z\naxes x right, y up\nmass A: m at (x, y, z)\ngravity g along -z\nask lagrangian\n",
                       "V = m g z"),
                      ("param m = 1 [kg], r = 0.1 [m], J = 0.01 [kg m^2], g = 9.81 [m/s^2]\ncoord x, φ\naxes x down\nbody B: mass m, inertia J at (x) angle φ\n"
                       "gravity g along x\nconstraint roll: x = r φ\ninit x = 0, x' = 0\nask solve x''\nsimulate 1 [s]\n", "= 4.905 m/s²")):
    run = subprocess.run([program, "solve", "-"], input=model, capture_output=True, text=True, encoding="utf-8", env=clean)
    check(f"{model.splitlines()[2]} is enough", run.returncode == 0 and wanted in run.stdout, run.stdout + run.stderr)

run = subprocess.run([program, "solve", "-", "--only", "a"], input=HEAD + "ask a: x(A)', dt(x(A))\n", capture_output=True, text=True, encoding="utf-8",
                     env=clean)
lines = [line.split("(")[0].strip() for line in run.stdout.splitlines() if line.strip().startswith("x' =")]
check("x(A)' is dt(x(A))", len(lines) == 2 and lines[0] == lines[1], run.stdout)
done()
