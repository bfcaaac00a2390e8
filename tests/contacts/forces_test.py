#!/usr/bin/env python3
"""The size of a constraint force is that of the force on a mass, whatever the coordinates are.  Usage: forces_test.py PLEUEL"""
import csv
import io
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
scratch = tempfile.TemporaryDirectory()


def sim(text, step):
    """Rows of a run as dictionaries without units, and what was said."""
    model = pathlib.Path(scratch.name, "m.pleuel")
    model.write_text(text, encoding="utf-8")
    run = subprocess.run([program, "sim", str(model), "-o", "-", "--dt", str(step)], capture_output=True, text=True, timeout=60)
    rows = list(csv.reader(io.StringIO(run.stdout)))
    if not rows:
        return [], run.stderr
    names = [n.split(" [")[0] for n in rows[0]]
    return [dict(zip(names, map(float, r))) for r in rows[1:]], run.stderr


def near(a, b, tol=1e-10):
    return abs(a - b) <= tol * (1 + abs(a) + abs(b))


CRANK = """param m1 = 1, m2 = 2, r = 0.1, l = 0.3, g = 9.81, w = 50
assume r < l
coord {coords}
axes x right, z up
{lines}
gravity g along -z
output S = norm(force(rod))
simulate 0..0.12
"""
SPELLINGS = {
    "pin by an angle": ("u, x2, z2", """mass A: m1 at (r cos u, r sin u)
mass B: m2 at (x2, z2)
constraint drive: u = w t
constraint guide: z2 = 0
constraint rod: (x2 - r cos u)^2 + (z2 - r sin u)^2 = l^2
branch x2 > r cos u"""),
    "slider without height": ("u, x2", """mass A: m1 at (r cos u, r sin u)
mass B: m2 at (x2, 0)
constraint drive: u = w t
constraint rod: (x2 - r cos u)^2 + (r sin u)^2 = l^2
branch x2 > r cos u"""),
    "pin with coordinates of its own": ("x1, z1, u, x2, z2", """mass B: m2 at (x2, z2)
mass A: m1 at (x1, z1)
constraint k1: x1 = r cos u
constraint k2: z1 = r sin u
constraint drive: u = w t
constraint guide: z2 = 0
constraint rod: (x2 - x1)^2 + (z2 - z1)^2 = l^2
branch x2 > x1"""),
}
runs = {}
for name, (coords, lines) in SPELLINGS.items():
    runs[name], said = sim(CRANK.format(coords=coords, lines=lines), 0.01)
    check("a crank, " + name + ": it runs", len(runs[name]) > 5, said)
first = runs["pin by an angle"]
for name, rows in runs.items():
    check("a crank, " + name + ": the same force in the rod",
          len(rows) == len(first) and all(near(a["S"], b["S"]) for a, b in zip(rows, first)), [r.get("S") for r in rows])
check("a crank: the force in the rod is that on the slider",
      all(near(r["S"], (r["force_rod_B_x"] ** 2 + r["force_rod_B_z"] ** 2) ** 0.5) for r in first))

rows, said = sim("""param m = 1, r = 1, l = 3, n = 2
coord u, s
axes x right, y up
mass S: m at (s, 0)
constraint drive: u = n t
constraint rod: (s - r cos u)^2 + r^2 sin^2 u = l^2
branch s > 0
output F = norm(force(rod))
simulate 0..1
""", 0.5)
check("what virtual work does not determine is refused", not rows and "do not determine the whole force of rod" in said, said)

rows, said = sim("""param m = 2, M = 1, g = 10, l = 3
coord x, y
axes x down
mass A: m at (x)
mass B: M at (y)
gravity g along x
constraint rope: x + y = l
constraint drive: x = t^2
output F = norm(force(rope))
output D = norm(force(drive))
init x = 0, y = 3
simulate 0..1
""", 0.5)
check("a rope over a pulley pulls both masses alike", rows and near(rows[-1]["F"], 12) and near(rows[-1]["D"], abs(2 * 2 - 20 + 12)), said or rows)

rows, said = sim("""param N = 5, m = 2, d = 1, g = 10
coord x[1..N], y[1..N]
axes x right, y up
for i in 1..N {
    mass P[i]: m at (x[i], y[i])
    init x[i] = 0, y[i] = -i d, x[i]' = 0, y[i]' = 0
}
constraint c[1]: x[1]^2 + y[1]^2 = d^2
for i in 2..N {
    constraint c[i]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 = d^2
}
gravity g along -y
output a = norm(force(c[1]))
output b = norm(force(c[4]))
simulate 0..1
""", 0.5)
check("members of a family carry what hangs below them", rows and near(rows[-1]["a"], 100) and near(rows[-1]["b"], 40), said or rows)

ROD = """param m = 1, M = 2, r = 0.5, l = 1, g = 9.81, w = 4
coord u, x, y
axes x right, y up
mass A: m at (r cos u, r sin u)
mass B: M at (x, y)
gravity g along -y
constraint drive: u = w t
constraint rod: (x - r cos u)^2 + (y - r sin u)^2 = l^2
ask force of rod
"""
model = pathlib.Path(scratch.name, "rod.pleuel")
model.write_text(ROD, encoding="utf-8")
said = subprocess.run([program, "solve", "--no-simulation", str(model)], capture_output=True, text=True, timeout=60).stdout
check("the force on a pin that moves on a circle is the reaction", "on A, the reaction to the force on B" in said and
      "Z_A = 2 λ_rod (r cos(w t) - x) e_x + 2 λ_rod (r sin(w t) - y) e_y" in said, said)
model.write_text(ROD.replace("ask force of rod", "constraint wall: x = 2\nask force of drive"), encoding="utf-8")
said = subprocess.run([program, "solve", "--no-simulation", str(model)], capture_output=True, text=True, timeout=60).stdout
check("a force of which only a part is known is called that", "on A, in the directions in which it can move" in said, said)

done()
