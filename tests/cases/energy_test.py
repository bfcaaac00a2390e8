#!/usr/bin/env python3
"""Energy over many periods: the pendulum in Cartesian coordinates from different angles.

Usage: energy_test.py PLEUEL [PERIODS [STARTS]]      1000 periods from 8 angles; `make bench` asks for 1e5 from 32

The drift is the largest |E - E(0)| over max(|T| + |V|) on the whole run.  At the default precision it may grow linearly, up to 1e-11 at 1e5
periods.  Where the program has more precise modes of running (`--precision`), each is measured over decades of time, and the
growth of its root mean square over the starts has to be that of the square root of time: exponent 0.5 within 0.15.
"""
import json
import math
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
periods = float(sys.argv[2]) if len(sys.argv) > 2 else 1e3
starts = int(sys.argv[3]) if len(sys.argv) > 3 else 8
LIMIT = 1e-11 / 1e5         # a period

MODEL = """param α = {angle!r}, g = 9.81
coord x, y
axes x right, y up
mass 1 at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = 1
init x = sin α, y = -cos α, x' = 0, y' = 0
simulate 0..1
"""


def period(angle):
    """By the arithmetic-geometric mean."""
    a, b = 1.0, math.cos(angle / 2)
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi / math.sqrt(9.81) / a


def drift(angle, n, flags=()):
    end = n * period(angle)
    run = subprocess.run([program, "sim", "-", "--json", "--until", repr(end), *flags], input=MODEL.format(angle=angle), capture_output=True,
                         text=True)
    return json.loads(run.stdout)["energy_drift"] if run.returncode == 0 else math.nan


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def exponent(counts, values):
    """Slope of log value over log count, least squares."""
    x, y = [math.log(c) for c in counts], [math.log(v) for v in values]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


angles = [0.1 + 2.9 * (k + 0.5) / starts for k in range(starts)]
found = [drift(a, periods) for a in angles]
check(f"{starts} pendulums over {periods:g} periods: energy drifts by less than {LIMIT * periods:.0e}",
      all(d <= LIMIT * periods for d in found), "\n".join(f"from {a:.3f} rad: {d:.2e}" for a, d in zip(angles, found)))
print(f"# largest {max(found):.2e}, root mean square {rms(found):.2e}")

# Over decades of time up to the periods asked for; at least sixteen starts, so that the exponent is known to 0.05.
usage = subprocess.run([program, "sim", "-h"], capture_output=True, text=True).stdout
angles = [0.1 + 2.9 * (k + 0.5) / max(starts, 16) for k in range(max(starts, 16))]
if "--precision" in usage and periods >= 100 and math.isfinite(drift(angles[0], 1, ("--precision", "long"))):
    first = 2 if periods >= 1e4 else math.log10(periods) - 1.5
    n = max(3, round(math.log10(periods) - first) + 1)
    counts = [10.0 ** (first + (math.log10(periods) - first) * k / (n - 1)) for k in range(n)]
    table = [[drift(a, n, ("--precision", "long")) for a in angles] for n in counts]
    values = [rms(row) for row in table]
    slope = exponent(counts, values)
    check("long run: the drift grows like the square root of time", abs(slope - 0.5) <= 0.15,
          f"exponent {slope:.2f}: " + ", ".join(f"{n:.0f} {v:.1e}" for n, v in zip(counts, values)))
    print(f"# exponent {slope:.3f}: " + ", ".join(f"{n:.0f} periods {v:.2e}" for n, v in zip(counts, values)))
    quad = drift(angles[-1], counts[0], ("--precision", "quad"))
    check("quad: its drift over the first of these times is far below", quad < 1e-10 * values[0], f"{quad:.1e}")
elif "--precision" in usage:
    print("# long runs: not measured, this build has no such numbers or the time is too short")
done()
