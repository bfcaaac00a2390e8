#!/usr/bin/env python3
"""Laws that hold for every system: motion and forces do not hang on the spelling of a constraint, on coordinates, on units or on
the sign of multipliers.  Random systems; a failure prints the seed and the model.

    laws_test.py PROGRAM [SYSTEMS-PER-LAW [FIRST-SEED [LAW]]]
"""

import csv
import io
import json
import math
import os
import random
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402
from mechanics import SPELLINGS, Formula, System  # noqa: E402
from taylor import Taylor, cos, sin  # noqa: E402

sys.setrecursionlimit(100000)   # long sums are deep trees
PROGRAM = sys.argv[1]
COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 3
FIRST = int(sys.argv[3]) if len(sys.argv) > 3 else 20260
ONLY = sys.argv[4] if len(sys.argv) > 4 else ""
POINTS = 3


class Wrong(Exception):
    pass


def run(verb, model, *flags):
    done = subprocess.run([PROGRAM, verb, *flags, "-"], input=model.encode(), capture_output=True, timeout=120)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def solve(model):
    code, out, err = run("solve", model, "--json", "--no-simulation")
    try:
        document = json.loads(out)
    except ValueError:
        raise Wrong(f"exit {code}, no JSON: {out[:300]} {err[:300]}\n{model}")
    failed = [c["name"] + ": " + str(c.get("failed_on"))[:200] for c in document.get("checks", []) if not c["passed"]]
    if code != 0 or failed:
        said = [n["text"] for n in document.get("notes", [])] + [n["text"] for n in document.get("errors", [])]
        raise Wrong(f"exit {code}, status {document.get('status')}, failed checks {failed}, {said}\n{model}")
    return document


def values(document):
    return [v for items in document["answers"].values() for i in items for v in i["values"]]


def with_where(value, names):
    names = dict(names)
    for name, text in value.get("where", {}).items():
        names[name] = Formula(text).value(names)
    return names


def near(a, b, scale=0.0):
    return abs(a - b) <= 1e-8 * max(abs(a), abs(b), scale, 1e-3)


def number_of(document, name, names):
    for v in values(document):
        if v["name"] == name and v.get("expr"):
            return Formula(v["expr"]).value(with_where(v, names))
    raise Wrong(f"no value {name} among {[v['name'] for v in values(document)]}")


def force_of(document, label, mass, names, axes):
    for v in values(document):
        if v["name"] == "Z" and v.get("of") == label and v.get("on") == mass:
            along = {c["along"]: Formula(c["expr"]).value(with_where(v, names)) for c in v["components"]}
            if all(f"e_{a}" not in along for a in axes):
                raise Wrong(f"force of {label} along {list(along)}")
            return [along.get(f"e_{a}", 0.0) for a in axes]
    return [0.0] * len(axes)   # no part on this mass


def points(system, n=POINTS):
    rng = random.Random(system.seed + 1)
    found = []
    while len(found) < n:
        s = system.state(rng)
        reference = system.reference(s)
        if reference:
            found.append((s, *reference))
    return found


def compare(system, document, model, forces=True, translate=None):
    """Accelerations and forces of a model in Cartesian names against the reference."""
    for s, acceleration, force in points(system):
        names = system.names(s)
        if translate:
            names = translate(names, s)
        scale = max(abs(a) for a in acceleration.values())
        for name, a in acceleration.items():
            got = number_of(document, name + "_ddot", names)
            if not near(got, a, scale):
                raise Wrong(f"{name}'' is {got}, d'Alembert says {a}, at {s}\n{model}")
        push = max([abs(x) for f in force.values() for x in f] + [0])
        for (label, mass), f in force.items() if forces else ():
            got = force_of(document, label, mass, names, "xyz"[: system.dimension])
            if not all(near(a, b, push) for a, b in zip(got, f)):
                raise Wrong(f"force of {label} on {mass} is {got}, d'Alembert says {f}, at {s}\n{model}")


# ---------------------------------------------------------------------------------------------- laws
def spelling(seed):
    """However a constraint is spelled, accelerations and constraint forces are the same."""
    system = System(seed, kinds=["rod", "bead", "incline", "free"] if seed % 3 else None, dimension=2 if seed % 3 else None)
    rng = random.Random(seed)
    for _ in range(2):
        chosen = [rng.choice(SPELLINGS) for _ in system.bonds()]
        model = system.cartesian_model(chosen, extra=system.accelerations_asked() + system.forces_asked())
        compare(system, solve(model), model)


def spelling_chosen(seed):
    """The same with generalized coordinates chosen."""
    system = System(seed)
    rng = random.Random(seed)
    chosen = [rng.choice(SPELLINGS) for _ in system.bonds()]
    model = system.chosen_model(extra=system.accelerations_asked() + system.forces_asked(), spellings=chosen)
    compare(system, solve(model), model)


def second_kind(seed):
    """Lagrange's equations of the second kind give the motion of those of the first."""
    system = System(seed)
    model = system.generalized_model(extra=["ask lagrange2"])
    document = solve(model)
    for s, acceleration, _ in points(system):
        names = system.names(s)
        second = {q: number_of(document, q + "_ddot", names) for p in system.particles for q in p.q}
        scale = max(abs(a) for a in acceleration.values())
        for p, at in zip(system.particles, system.cartesian(s, second)):
            for c, x in zip(p.cartesian, at):
                if not near(x.acceleration, acceleration[c], scale):
                    raise Wrong(f"{c}'' is {x.acceleration}, d'Alembert says {acceleration[c]}, at {s}\n{model}")


def turned(rng):
    """Shifted, turned and stretched axes; or a frame that moves: the text of the map, and its inverse on series."""
    b, s, V, A = (round(rng.uniform(0.3, 1.2), 2) for _ in range(4))
    x0, y0 = round(rng.uniform(-1, 1), 2), round(rng.uniform(-1, 1), 2)
    moving = rng.random() < 0.5

    def transform(system):
        positions, rename, names = [], {}, []
        system.parameter("bT", b), system.parameter("sT", s), system.parameter("VT", V), system.parameter("AT", A)
        turn = "(bT + AT*t)" if moving else "bT"
        for p in system.particles:
            k = p.number
            x = f"{x0} + VT*t + sT*(cos({turn})*X{k} - sin({turn})*Y{k})"
            y = f"{y0} + sT*(sin({turn})*X{k} + cos({turn})*Y{k})"
            rest = [f"Z{k} - AT*t^2"] if system.dimension == 3 else []
            positions.append([x, y] + rest)
            rename.update(zip(p.cartesian, positions[-1]))
            names += [f"X{k}", f"Y{k}", f"Z{k}"][: system.dimension]
        return positions, rename, names

    def angle(t):
        return Taylor(b) + (Taylor(A) * t if moving else 0)

    def inverse(path, t):
        a = angle(t)
        X, Y = (path[0] - x0 - Taylor(V) * t) / s, (path[1] - y0) / s
        out = [cos(a) * X + sin(a) * Y, cos(a) * Y - sin(a) * X]
        return out + ([path[2] + Taylor(A) * t * t] if len(path) > 2 else [])

    return transform, inverse, angle


def along_axes(f, a):
    return [f[0] * math.cos(a) + f[1] * math.sin(a), f[1] * math.cos(a) - f[0] * math.sin(a)] + f[2:]


def axes_moved(seed):
    """Shifted, turned, stretched or moving axes change neither motion nor forces."""
    system = System(seed, n=1)
    transform, inverse, angle = turned(random.Random(seed))
    k = "XYZ"[: system.dimension]
    asked = ["ask " + ", ".join(f"solve {c}1''" for c in k)] + system.forces_asked()
    model = system.cartesian_model(extra=asked, transform=transform, units=False)
    document = solve(model)
    for s, acceleration, force in points(system):
        p = system.particles[0]
        at = system.cartesian(s)[0]
        t = Taylor(s["t"], 1)
        there = inverse([Taylor.path(x.value, x.rate, acceleration[c]) for c, x in zip(p.cartesian, at)], t)
        names = system.names(s)
        for c, x in zip(k, there):
            names[c + "1"], names[c + "1_dot"] = x.value, x.rate
        scale = max(abs(x.acceleration) for x in there)
        for c, x in zip(k, there):
            got = number_of(document, f"{c}1_ddot", names)
            if not near(got, x.acceleration, scale):
                raise Wrong(f"{c}1'' is {got}, d'Alembert says {x.acceleration}, at {s}\n{model}")
        push = max([abs(x) for f in force.values() for x in f] + [0])
        for (label, mass), f in force.items():
            f = along_axes(f, angle(t).value)   # the frame of the map: unit vectors along its coordinates
            got = force_of(document, label, mass, names, [c + "1" for c in k])
            if not all(near(a, b, push) for a, b in zip(got, f)):
                raise Wrong(f"force of {label} on {mass} is {got}, d'Alembert says {f}, at {s}\n{model}")


def units(seed):
    """Millimetres and grams instead of metres and kilograms: the same formulas and SI numbers; and each formula scales as its
    unit says when the units of length, mass and time are changed."""
    system = System(seed)
    asked = system.accelerations_asked() + system.forces_asked() + ["ask conserved, lagrange2"]
    one = solve(system.chosen_model(extra=asked))
    two = solve(system.chosen_model(extra=asked, scale=True))
    for a, b in zip(values(one), values(two)):
        if (a["name"], a["unit"], a.get("expr")) != (b["name"], b["unit"], b.get("expr")) or (a["number"] is None) != (b["number"] is None):
            raise Wrong(f"{a['name']} = {a.get('expr')} [{a['unit']}] becomes {b['name']} = {b.get('expr')} [{b['unit']}]\n{system.chosen_model(extra=asked)}")
        if a["number"] is not None and not near(a["number"], b["number"]):
            raise Wrong(f"{a['name']}: {a['number']} becomes {b['number']}")
    length, mass, time = 1.7, 0.6, 1.3
    (s, _, _), = points(system, 1)
    names = system.names(s)
    dimension = {k: system.unit(k) for k in system.parameters}
    dimension.update((q, u) for p in system.particles for q, u in zip(p.q, p.q_unit))
    dimension.update((c, "m") for p in system.particles for c in p.cartesian)
    dimension["t"] = "s"
    scaled = {}
    for name, x in names.items():
        base, dots = (name[:-4], 1) if name.endswith("_dot") else (name, 0)
        scaled[name] = x * factor(dimension[base], length, mass, time) / time**dots
    for v in values(one):
        for unit, expr in [(v["unit"], v.get("expr"))] + [(v["unit"], c["expr"]) for c in v.get("components", [])]:
            if not expr:
                continue
            extended = {n for n in Formula(expr).names if n not in names}
            if extended:
                continue   # start values, accelerations
            a, b = Formula(expr).value(with_where(v, names)), Formula(expr).value(with_where(v, scaled))
            if not near(a * factor(unit, length, mass, time), b, 1e-3 * abs(a)):
                raise Wrong(f"{v['name']} = {expr} does not scale as {unit}")


def factor(unit, length, mass, time):
    size = {"m": length, "kg": mass, "s": time, "N": mass * length / time**2, "J": mass * length**2 / time**2, "W": mass * length**2 / time**3,
            "1": 1.0, "rad": 1.0, "Pa": mass / length / time**2, "Hz": 1 / time}
    out, divided = 1.0, False
    for part in unit.replace("*", " ").replace("/", " / ").replace("(", " ").replace(")", " ").split():
        if part == "/":
            divided = True
            continue
        base, _, power = part.partition("^")
        f = size[base] ** float(power or 1)
        out = out / f if divided else out * f
    return out


def sign(seed):
    """The other sign of multipliers turns them round and leaves forces and motion alone."""
    system = System(seed, kinds=["rod", "bead", "incline"], dimension=2)
    asked = ["ask " + ", ".join(f"solve λ_{b[0]}" for b in system.bonds())] + system.accelerations_asked() + system.forces_asked()
    one, two = solve(system.chosen_model(extra=asked)), solve("convention lambda-minus\n" + system.chosen_model(extra=asked))
    for s, _, _ in points(system):
        names = system.names(s)
        for b in system.bonds():
            x, y = (number_of(d, f"lambda_{b[0]}", names) for d in (one, two))
            if not near(x, -y):
                raise Wrong(f"lambda_{b[0]} = {x} becomes {y}\n{system.chosen_model(extra=asked)}")
    compare(system, two, system.chosen_model(extra=asked))


def simulated(seed):
    """Multipliers and accelerations along a simulated motion are those of the formulas, and what is called conserved stays."""
    system = System(seed, n=1 if seed % 2 else 2)
    (s, _, _), = points(system, 1)
    start = ", ".join(f"{p}" for k in system.particles for q in k.q for p in (f"{q} = {s[q]!r}", f"{q}' = {s[q + '_dot']!r}"))
    bonds = system.bonds()
    extra = ["init " + start, "ask " + ", ".join([f"solve λ_{b[0]}" for b in bonds] + ["conserved"]), "ask lagrange2"]
    outputs = [f"output acc_{q} = {q}''" for p in system.particles for q in p.q]
    model = system.chosen_model(extra=extra, units=False)
    document = solve(model)
    with tempfile.TemporaryDirectory() as room:
        path = os.path.join(room, "out.csv")
        code, out, err = run("sim", model + "\n".join(outputs) + "\nsimulate 0..0.4 tol 1e-11\n", "-o", path)
        if code != 0:
            raise Wrong(f"sim ends with {code}: {out} {err}\n{model}")
        with open(path, encoding="utf-8") as f:
            rows = list(csv.DictReader(line for line in io.StringIO(f.read()) if not line.startswith("#")))
    rows = [{k.split(" ")[0].split("[")[0]: v for k, v in r.items()} for r in rows]
    first = {}
    for r in rows[:: max(1, len(rows) // 12)]:
        names = dict(system.parameters)
        for k, v in r.items():
            try:
                names[k] = float(v)
            except (ValueError, TypeError):
                pass
        for v in values(document):
            if v.get("expr") is None:
                continue
            x = Formula(v["expr"]).value(with_where(v, names))
            if v["name"].startswith("lambda_"):
                if not abs(x - names[v["name"]]) <= 1e-6 * max(1, abs(x)):
                    raise Wrong(f"{v['name']} at t = {names['t']}: sim {names[v['name']]}, formula {x}\n{model}")
            elif v["name"].endswith("_ddot") and "acc_" + v["name"][:-5] in names:
                if not abs(x - names["acc_" + v["name"][:-5]]) <= 1e-6 * max(1, abs(x)):
                    raise Wrong(f"{v['name']} at t = {names['t']}: sim {names['acc_' + v['name'][:-5]]}, formula {x}\n{model}")
            elif v.get("conserved"):
                first.setdefault(v["name"], x)
                if not abs(x - first[v["name"]]) <= 1e-7 * max(1, abs(x)):
                    raise Wrong(f"{v['name']} = {v['expr']} is not constant: {first[v['name']]} -> {x} at t = {names['t']}\n{model}")


LAWS = [spelling, spelling_chosen, second_kind, axes_moved, units, sign, simulated]

for law in LAWS:
    if ONLY and law.__name__ != ONLY:
        continue
    for seed in range(FIRST, FIRST + COUNT):
        try:
            law(seed)
            tap.check(f"{law.__name__}, seed {seed}", True)
        except Exception as e:  # noqa: BLE001  any surprise is a failure with its seed
            tap.check(f"{law.__name__}, seed {seed}", False, f"{type(e).__name__}: {e}")
tap.done()
