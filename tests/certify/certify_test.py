#!/usr/bin/env python3
"""`pleuel sim --certify`: the proven intervals contain the exact motions, evaluated here in 60 digits from closed forms; they do
not contain those of models that differ in the 21st digit; and what is not proved is said.
Usage: certify_test.py PLEUEL
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from decimal import Decimal as D, getcontext

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
cases = pathlib.Path(__file__).resolve().parent.parent / "cases"
scratch = tempfile.TemporaryDirectory()
getcontext().prec = 70
HALF_UNIT = D("1e-60")    # of the closed forms here


# ------------------------------------------------------------------------------------------ closed forms
def series(x, term, ratio):
    """The sum of term * ratio(1) * ratio(2) ..."""
    total, k = D(0), 1
    while abs(term) > D("1e-75"):
        total += term
        term *= ratio(k)
        k += 1
    return total


def sin(x):
    return series(x, x, lambda k: -x * x / ((2 * k) * (2 * k + 1)))


def cos(x):
    return series(x, D(1), lambda k: -x * x / ((2 * k - 1) * (2 * k)))


def atan(x):
    """Arguments halved until the series is short."""
    halvings = 0
    while abs(x) > D("0.01"):
        x = x / (1 + (1 + x * x).sqrt())
        halvings += 1
    total, power, k = D(0), x, 0
    while abs(power) > D("1e-75"):
        total += (-1) ** k * power / (2 * k + 1)
        power *= x * x
        k += 1
    return total * 2 ** halvings


PI = 4 * atan(D(1))


def jacobi(u, m):
    """sn, cn, dn of parameter m, by descending Landen transformations (Abramowitz and Stegun 16.4)."""
    a, c, b = [D(1)], [m.sqrt()], (1 - m).sqrt()
    while abs(c[-1]) > D("1e-66"):
        a_new = (a[-1] + b) / 2
        c.append((a[-1] - b) / 2)
        b = (a[-1] * b).sqrt()
        a.append(a_new)
    phi = a[-1] * u * 2 ** (len(a) - 1)
    for n in range(len(a) - 1, 0, -1):
        s = c[n] / a[n] * sin(phi - 2 * PI * (phi / (2 * PI)).to_integral_value())
        phi = (atan(s / (1 - s * s).sqrt()) + phi) / 2
    sn = sin(phi)
    return sn, cos(phi), (1 - m * sn * sn).sqrt()


def kepler(t, e):
    """x, y at unit semi-major axis and mean motion, from the pericentre."""
    E = t
    for _ in range(80):
        E -= (E - e * sin(E) - t) / (1 - e * cos(E))
    return cos(E) - e, (1 - e * e).sqrt() * sin(E)


# ------------------------------------------------------------------------------------------ the program
def run(model, *flags, code=0):
    path = pathlib.Path(scratch.name, "model.pleuel")
    path.write_text(model, encoding="utf-8")
    result = subprocess.run([program, "sim", str(path), "--json", *flags], capture_output=True, text=True, timeout=100)
    if result.returncode != code:
        check(f"exit code {code}", False, f"{result.returncode}\n{model}\n{result.stdout[:2000]}{result.stderr[:1000]}")
    return json.loads(result.stdout)


def certified(model, *flags, width=None, code=0):
    return run(model, f"--certify={width}" if width else "--certify", *flags, code=code)["certified"]


def contains(ball, exact):
    return abs(D(ball["value"]) - exact) <= D(ball["radius"]) + HALF_UNIT


def check_row(name, row, exact, widest):
    for column, value in exact.items():
        ball = row[column]
        check(f"{name}: {column} contains the exact value, within {widest}", contains(ball, value) and ball["radius"] <= float(widest),
              f"{ball}\nexact {value}")


# ------------------------------------------------------------------------------------------ exact motions
FALL = """coord x, y
axes x right, y up
mass 0.3 at (x, y)
gravity 9.81 along -y
init x = 0.1, y = 1/3, x' = 0.7, y' = π
simulate 0..1.3
"""
row = certified(FALL, width="1e-35")["rows"][-1]
t = D("1.3")
check_row("free fall", row, {"x": D("0.1") + D("0.7") * t, "x_dot": D("0.7"),
                             "y": D(1) / 3 + PI * t - D("9.81") * t * t / 2, "y_dot": PI - D("9.81") * t}, "1e-34")
other = certified(FALL.replace("9.81", "9.81000000000000000001"), width="1e-35")["rows"][-1]
check("a model that differs in the 21st digit is told apart",
      abs(D(row["y"]["value"]) - D(other["y"]["value"])) > 10 * (D(row["y"]["radius"]) + D(other["y"]["radius"])), f"{row['y']}\n{other['y']}")
check("decimals are taken exactly, not as doubles", not contains(row["x_dot"], D(0.7)) and contains(row["x_dot"], D("0.7")), row["x_dot"])

OSCILLATOR = """param k = 0.1
coord x
potential k x^2/2
kinetic x'^2/2
init x = 1, x' = 0
simulate 0..7
"""
w = D("0.1").sqrt()
for back in ("", "-"):
    row = certified(OSCILLATOR, "--until", f"{back}7", width="1e-40")["rows"][-1]
    t = D(back + "7")
    check_row(f"oscillator to {back}7", row, {"x": cos(w * t), "x_dot": -w * sin(w * t)}, "1e-39")

rest = certified(OSCILLATOR.replace("x = 1", "x = 0"))
check("a body that rests at zero is certified too", rest["complete"] and contains(rest["rows"][-1]["x"], D(0)), rest)
document = run(OSCILLATOR, "--certify", "--dt", "0.7", "-f", "-o", str(pathlib.Path(scratch.name, "rows.csv")))
rows = document["certified"]["rows"]
table = [line.split(",") for line in pathlib.Path(scratch.name, "rows.csv").read_text(encoding="utf-8").splitlines()[1:]]
check("with --dt every time of the grid is enclosed", len(rows) == 10, len(rows))
check("each contains the exact value at the exact time", all(contains(r["x"], cos(w * D("0.7") * (i + 1))) for i, r in enumerate(rows)))
off = [abs(D(float(table[i + 1][1])) - cos(w * D("0.7") * (i + 1))) for i in range(10)]
check("the proven error of the run is its error", all(abs(D(r["x"]["error"]) - o) <= D("1e-18") for r, o in zip(rows, off)),
      [(r["x"]["error"], float(o)) for r, o in zip(rows, off)])

PENDULUM = """param g = 9.81
coord x, y
axes x right, y up
mass 1 at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = 1
init x = 1, y = 0, x' = 0, y' = 0
simulate 0..2
"""
# sin(θ/2) = k sn(K - ω t), θ from the downward vertical, k² = 1/2; K - u turns sn into cn/dn
sn, cn, dn = jacobi(D("9.81").sqrt() * 2, D("0.5"))
half = D("0.5").sqrt() * cn / dn
y = 2 * half * half - 1
row = certified(PENDULUM, width="1e-30")["rows"][-1]
check_row("pendulum in Cartesian coordinates", row, {"y": y}, "1e-29")
check("pendulum in Cartesian coordinates: x too, and the force", contains(row["x"], (1 - y * y).sqrt().copy_sign(D(row["x"]["value"])))
      and contains(row["lambda_rod"], 3 * D("9.81") * y / 2), f"{row}\n{y}")
angle = PENDULUM.replace("constraint rod: x^2 + y^2 = 1", "constraint rod: x^2 + y^2 = 1\nchoose φ with x = sin φ, y = -cos φ").replace("coord x, y", "coord x, y, φ")
angle = angle.replace("init x = 1, y = 0, x' = 0, y' = 0", "init φ = π/2, φ' = 0")
row = certified(angle, width="1e-25")["rows"][-1]
check("constraints that follow from maps are recognised: the same motion, the same force",
      contains(row["y"], y) and contains(row["lambda_rod"], 3 * D("9.81") * y / 2), row)

KEPLER = (cases / "kepler.pleuel").read_text(encoding="utf-8")
x, y = kepler(D(3), D("0.6"))
check_row("Kepler, e = 0.6", certified(KEPLER, "--until", "3", width="1e-32")["rows"][-1], {"x": x, "y": y}, "1e-31")

DAMPED = """coord x
kinetic x'^2/2
rayleigh 0.25 x'^2
init x = 0, x' = 1
simulate 0..3
"""
check_row("a damped mass", certified(DAMPED, width="1e-33")["rows"][-1], {"x": 2 * (1 - D("-1.5").exp()), "x_dot": D("-1.5").exp()}, "1e-32")

# x'' = x by several functions: x = cosh t, sqrt(1 + x'²) = x; its logarithm and inverse are true along the motion
FUNCTIONS = """coord x
kinetic x'^2/2
force (%s) on (x)
axes x right
init x = 1, x' = 0
simulate 0..1
"""
e = D(1).exp()
for force in ("x", "sqrt(1 + x'^2)", "exp(ln(x))", "cosh(t)", "exp(t) - sinh(t)", "x^(3/2)/sqrt(x)", "tan(atan(x))", "sinh(asinh(x))", "sin(asin(x/4))*4",
              "4 cos(acos(x/4))", "x tanh(x)/tanh(x)", "sqrt(x^2 + x'^2) cos(atan2(x', x))", "if(x > 0, x, -x)", "abs(x)", "max(x, -3)"):
    model = (FUNCTIONS % force).replace("axes x right\n", "").replace("coord x\n", "coord x\naxes x right\n")
    check_row(f"x'' = {force}", certified(model, width="1e-30")["rows"][-1], {"x": (e + 1 / e) / 2, "x_dot": (e - 1 / e) / 2}, "1e-29")


SLOPE = """param μ = 0.2
coord x, y
axes x right, y up
mass 1 at (x, y)
gravity 9.81 along -y
constraint line: y - x = 0 with λ
force (μ λ, 0) on (x, y)
init x = 0, y = 0, x' = 0, y' = 0
simulate 0..1
"""
# x'' = -λ + μ λ, y'' = λ - g, x'' = y'': λ (2 - μ) = g
force = D("9.81") / D("1.8")
check_row("a force that depends on a multiplier", certified(SLOPE, width="1e-30")["rows"][-1],
          {"lambda_line": force, "x": (force - D("9.81")) / 2}, "1e-29")


# ------------------------------------------------------------------------------------------ values of tests/cases
def reference(path, until):
    """NAME VALUE pairs of the lines `#= t UNTIL` of a case."""
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:3] == ["#=", "t", until] and "with" not in words:
            for i in range(3, len(words) - 1, 2):
                if len(words[i + 1].strip("-").replace(".", "").lstrip("0")) >= 15:
                    yield words[i], D(words[i + 1])


for case, until in (("pendulum", "0.5"), ("hoop", "1"), ("knife-edge", "1"), ("spherical", "1"), ("sleigh", "1"), ("disc", "1"),
                    ("turntable", "2"), ("chain2", "1"), ("pleiades", "1"), ("cycloid", "1"), ("henon-heiles", "10")):
    path = cases / f"{case}.pleuel"
    pairs = list(reference(path, until)) if path.exists() else []
    if not pairs:
        continue
    row = certified(path.read_text(encoding="utf-8"), "--until", until)["rows"][-1]
    pairs = [(name, value) for name, value in pairs if name in row]
    # the last two digits of a reference value are its own uncertainty
    wrong = [(n, str(v), row[n]) for n, v in pairs
             if abs(D(row[n]["value"]) - v) > D(row[n]["radius"]) + D(100).scaleb(v.as_tuple().exponent)]
    check(f"{case} at t = {until}: {len(pairs)} reference values lie in the enclosure", pairs and not wrong, wrong)

# ------------------------------------------------------------------------------------------ starts
start = certified(PENDULUM.replace("x = 1, y = 0, x' = 0, y' = 0", "x = 0.6, y = -0.8, x' = 0"), "--until", "0.1")
check("a start that meets the constraints exactly is not moved", start["complete"] and start["start_moved"] == [], start)
start = certified(PENDULUM.replace("x = 1, y = 0, x' = 0, y' = 0", "x = 0.6, x' = 0").replace("simulate", "guess y = -1\nsimulate"), "--until", "0.1")
check("what follows from the constraints is enclosed", start["complete"] and start["start_moved"] == start["start_taken_from_run"] == [], start)
start = certified(PENDULUM.replace("x = 1, y = 0, x' = 0, y' = 0", "x = 0.7071067811865475244, y = -0.7071067811865475244, x' = 0"), "--until", "0.1")
check("a start that contradicts them in the 20th digit is said to be moved", start["complete"] and len(start["start_moved"]) == 1, start)
start = certified(PENDULUM.replace("x = 1, y = 0, x' = 0, y' = 0", "x = sin(0.3), y = -cos(0.3), x' = 0"), "--until", "0.1")
check("sin and cos of the same number meet the circle", start["complete"] and start["start_moved"] == [], start)

# ------------------------------------------------------------------------------------------ contacts and events
SKI = """param R = 20, g = 9.81
coord r, ϑ
axes x right, z up
mass 75 at (r sin ϑ, r cos ϑ)
gravity g along -z
constraint h: r >= R
init ϑ = 1°, ϑ' = 0
event ground: when r cos ϑ = 0 -> stop
simulate 0..10
"""
answer = certified(SKI, width="1e-24")
off, ground = answer["events"]
cosine = 2 * cos(PI / 180) / 3
sine = (1 - cosine * cosine).sqrt()
angle = 2 * atan(sine / (1 + cosine))
check("the skier takes off at the angle whose cosine is 2/3 of that of the start", off["kind"] == "release" and off["label"] == "h"
      and contains(off["state"]["theta"], angle) and off["state"]["theta"]["radius"] < 1e-20, f"{off}\n{angle}")
speed = (D("9.81") * 20 * cosine).sqrt()
check("and with the speed at which weight alone holds it on the circle", contains(off["state"]["theta_dot"], speed / 20), f"{off}\n{speed / 20}")
# free flight from there
up, fall = speed * sine, 20 * cosine
flight = (-up + (up * up + 2 * D("9.81") * fall).sqrt()) / D("9.81")
check("it lands where the parabola from there does", ground["kind"] == "stop" and contains(answer["rows"][-1]["r"], 20 * sine + speed * cosine * flight),
      answer["rows"][-1])
check("after so long a flight", abs(D(ground["t"]["value"]) - D(off["t"]["value"]) - flight) <= D(ground["t"]["radius"]) + D(off["t"]["radius"]), answer["events"])
other = certified(SKI.replace("1°", "1.0000000000000000001°"), width="1e-24")["events"][0]
check("a start that differs in the 20th digit takes off at another angle", not contains(other["state"]["theta"], angle), other)

SLING = """coord x, y
axes x right, y up
mass 1 at (x, y)
constraint rod: x^2 + y^2 = 1
event up: when y = 0 rising -> release rod
event cut: when y = 1/2 rising -> release rod
event end: when x = -3 -> stop
init x = 1, y = 0, x' = 0, y' = %s
simulate 0..10
"""
answer = certified(SLING % "1")
check("released by an event on the way, stopped by another", [e["label"] for e in answer["events"]] == ["cut", "end"]
      and contains(answer["events"][0]["t"], PI / 6) and contains(answer["events"][1]["t"], PI / 6 + (D("0.75").sqrt() + 3) * 2), answer)
answer = certified(SLING % "-1")
check("the zero that the motion begins with is no event, the next one is", answer["events"][0]["label"] == "up"
      and contains(answer["events"][0]["t"], PI), answer["events"])
answer = certified((SLING % "1").replace("y = 1/2 rising", "y = 1/2 falling"), "--until", "3")
check("an event in the other direction does not count", [e["label"] for e in answer["events"]] == ["cut"]
      and contains(answer["events"][0]["t"], 5 * PI / 6), answer["events"])

BALL = """coord x, y
axes x right, y up
mass 1 at (x, y)
gravity 10 along -y
constraint floor: y >= 0
init x = 0, y = 5, x' = 1, y' = 0
simulate 0..3
"""
answer = certified(BALL, "--dt", "0.5", code=6)
check("an impact is enclosed and ends the proof", answer["why"] == "impact" and contains(answer["events"][0]["t"], D(1))
      and answer["events"][0]["t"]["radius"] < 1e-20 and len(answer["rows"]) >= 1, answer)
# a parabola that touches y = 0 at t = 1 and one that misses it by 1e-18
graze = """coord x, y
axes x right, y up
mass 1 at (x, y)
gravity 10 along -y
constraint roof: y <= %s
init x = 0, y = 0, x' = 1, y' = 10
simulate 0..2
"""
answer = certified(graze % "5", code=6)
check("a grazed contact is not decided", answer["why"] == "undecided" and 0.9 < answer["t_reached"] < 1, answer)
check("one that is missed by 1e-6 is proved to be missed", certified(graze % "5.000001")["complete"])

# ------------------------------------------------------------------------------------------ what is not proved is said
kink = """coord x
kinetic x'^2/2
potential abs(x)
init x = 1, x' = 0
simulate 0..3
"""
answer = certified(kink, code=6)
check("a kink ends the proof, and what was proved until then is kept",
      not answer["complete"] and answer["why"] == "step" and 1.41 < answer["t_reached"] < 2 ** 0.5 and answer["rows"] == [], answer)
answer = certified(kink, "--dt", "0.5", code=6)
check("rows before it stay", len(answer["rows"]) == 2 and contains(answer["rows"][1]["x"], D("0.5")), answer)
twin = (cases / "twin.pleuel").read_text(encoding="utf-8")
check("redundant constraints are refused", certified(twin, code=6)["why"] == "redundant")
jump = FALL.replace("simulate", "event kick: when y = 0 -> x' = 1\nsimulate")
answer = certified(jump, code=6)
check("events that set values are refused", answer["why"] == "event" and answer["rows"] == [], answer)
for bad in ("1", "-1e-9", "nan", "many"):
    wrong = subprocess.run([program, "sim", str(cases / "pendulum.pleuel"), f"--certify={bad}"], capture_output=True, text=True, timeout=100)
    check(f"--certify={bad} is a wrong call", wrong.returncode == 2 and wrong.stderr + wrong.stdout, wrong.stdout)
done()
