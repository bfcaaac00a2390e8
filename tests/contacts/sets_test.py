#!/usr/bin/env python3
"""Which constraints are in the equations: `solve --json` against the rows of `sim`, and the sets against closed forms.
Usage: sets_test.py PLEUEL [WORD]

Each case is a model, the sets of its motion in order, and when each of them holds, by hand.  Every acceleration, multiplier,
motion and conserved quantity of `solve` is compared with the rows of `sim` of its set; a value of the wrong set cannot agree.
"""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.path.insert(0, str(HERE.parent / "founding"))
from formulas import Formula  # noqa: E402
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
only = sys.argv[2] if len(sys.argv) > 2 else ""
scratch = tempfile.TemporaryDirectory()
G = 9.81
POINT = "param m = 2 [kg], g = 9.81 [m/s^2]\ncoord x, y\naxes x right, y up\nmass A: m at (x, y)\ngravity g along -y\n"
DROP = "param m = 1 [kg], g = 9.81 [m/s^2]\ncoord y\naxes y up\nmass m at (y)\ngravity g along -y\n"


class Failure(Exception):
    pass


def need(condition, sentence):
    if not condition:
        raise Failure(sentence)


def call(*words):
    out = subprocess.run([program, *words], capture_output=True, text=True, timeout=120)
    return out.returncode, out.stdout, out.stderr


def accelerations(document):
    names = [v["name"] for s in sections(document) for v in s["values"] if v.get("name", "").endswith("_ddot")]
    return sorted(set(names))


def sections(document):
    return [s for answer in document["answers"].values() for s in answer]


def number(text):
    """A cell: words such as the mode, and what is not determined, are nothing to compare with."""
    try:
        return float(text)
    except ValueError:
        return math.nan


class Motion:
    """What solve says, and the rows of sim with the accelerations beside them."""

    def __init__(self, text):
        model = pathlib.Path(scratch.name, "m.pleuel")
        model.write_text(text, encoding="utf-8")
        self.code, out, err = call("solve", "--json", str(model))
        need(out.strip(), f"solve says nothing: {err[:300]}")
        self.document = json.loads(out)
        need(self.document["status"] in ("ok", "no_closed_form"), f"status {self.document['status']}: {self.document.get('message')} {err[:200]}")
        self.parameters = {k: p["number"] for k, p in self.document["parameters"].items()}
        self.rows = self.simulate(text)

    def simulate(self, text):
        names = accelerations(self.document)
        extra = "".join(f"output acc_{n[:-5]} = {n[:-5]}''\n" for n in names)
        model, table = pathlib.Path(scratch.name, "s.pleuel"), pathlib.Path(scratch.name, "s.csv")
        lines = text.rstrip("\n").split("\n")
        model.write_text("\n".join(line for line in lines if not line.startswith("ask")) + "\n" + extra, encoding="utf-8")
        table.unlink(missing_ok=True)
        code, out, err = call("sim", str(model), "-f", "-o", str(table), "--dt", "0.01")
        need(code == 0, f"sim ends with {code}: {err[:300]}")
        rows = list(csv.reader(open(table, encoding="utf-8")))
        head = [n.split(" [")[0] for n in rows[0]]
        return [{n: number(x) for n, x in zip(head, r)} for r in rows[1:] if r and not r[0].startswith("#")]

    def within(self, window):
        """Rows well inside: at its ends both sets have a row."""
        lo, hi = window
        return [r for r in self.rows if lo + 1e-9 < r["t"] < hi - 1e-9]


def names_of(motion, row, begin):
    names = dict(motion.parameters)
    names.update({k: v for k, v in row.items() if isinstance(v, float)})
    names.update({"g": motion.parameters.get("g", G)})
    for k, v in begin.items():
        names[k + "_0"] = v
    return names


def compare(motion, stage, value, rows):
    """One value of solve on the rows of its set; returns how often it was compared."""
    name, expr, begin = value["name"], value.get("expr"), rows[0]
    if expr is None or value.get("where"):
        return 0
    formula = Formula(expr)
    column = "acc_" + name[:-5] if name.endswith("_ddot") else name
    motion_of_its_own = name in motion.document["coords"]      # closed motions of a later set have a clock of their own
    clock = begin["t"] if stage > 1 and motion_of_its_own else 0.0
    first = begin if stage > 1 else motion.rows[0]
    if value.get("conserved") == 1:
        got = [formula.value(names_of(motion, r, first)) for r in rows]
        need(max(got) - min(got) <= 1e-8 * max(1.0, max(map(abs, got))), f"set {stage}: {name} = {expr} is not conserved")
        return 1
    if column not in begin:
        return 0
    for r in rows:
        names = names_of(motion, r, first)
        names["t"] = r["t"] - clock
        want, got = r[column], formula.value(names)
        need(abs(got - want) <= 1e-7 * max(1.0, abs(want)), f"set {stage}, t = {r['t']}: {name} = {expr} = {got}, sim has {want}")
    return 1


def follow(text, sets, compared):
    """sets: (closed or attached labels, degrees of freedom, from, to) of each set in order."""
    motion = Motion(text)
    document, count = motion.document, 0
    open_now = {c["label"] for c in document["constraints"] if c.get("open")}
    held = {c["label"] for c in document["constraints"]} - open_now
    need(held == set(sets[0][0]), f"at the start {sorted(held)} hold, not {sorted(sets[0][0])}")
    need(document["dof"]["dof"] == sets[0][1], f"degrees of freedom {document['dof']}")
    stages = sorted({s.get("stage", 1) for s in sections(document)})
    need(stages == list(range(1, len(sets) + 1)), f"{len(stages)} sets are told, not {len(sets)}")
    for k, (_, freedoms, lo, hi) in enumerate(sets, start=1):
        rows = motion.within((lo, hi))
        need(len(rows) > 3, f"no rows in set {k}")
        for s in sections(document):
            if s.get("stage", 1) != k:
                continue
            for v in s["values"]:
                if v["name"] == "dof":
                    need(v["expr"] == str(freedoms), f"set {k}: {v['expr']} degrees of freedom, not {freedoms}")
                else:
                    count += compare(motion, k, v, rows)
    need(count >= compared, f"only {count} values were compared, not {compared}")
    return motion


def case(sentence, text, sets, compared=1, then=None):
    if only and only not in sentence:
        return
    try:
        motion = follow(text, sets, compared)
        if then:
            then(motion)
        check(sentence, True)
    except (Failure, KeyError, ValueError, subprocess.TimeoutExpired) as e:
        check(sentence, False, e)


def texts(motion, stage=None):
    return "\n".join(step.get("text", "") for s in sections(motion.document) if stage in (None, s.get("stage", 1)) for step in s["steps"])


def says(words, stage=None):
    def look(motion):
        need(words in texts(motion, stage), f"nobody says {words!r}:\n{texts(motion, stage)[:600]}")
    return look


# ---------------------------------------------------------------------------------------------- floors
fall = math.sqrt(4 / G)
case("a ball in the air falls until the floor is met",
     DROP + "constraint floor: y >= 0\nrestitution 0 on floor\ninit y = 2 [m], y' = 0\nask solve y'', solve y(t), solve λ_floor, conserved\nsimulate 0..1 [s]\n",
     [([], 1, 0, fall), (["floor"], 0, fall, 1)], 4, says("y = 0, at t = 0.638551"))
case("a ball on the floor stays there",
     DROP + "constraint floor: y >= 0\ninit y = 0, y' = 0\nask solve y'', solve λ_floor\nsimulate 0..1 [s]\n", [(["floor"], 0, 0, 1)], 2)
up = 2 * 3 / G
case("a ball that leaves the floor is not on it",
     DROP + "constraint floor: y >= 0\nrestitution 0 on floor\ninit y = 0, y' = 3 [m/s]\nask solve y'', solve y(t), solve λ_floor\nsimulate 0..1 [s]\n",
     [([], 1, 0, up), (["floor"], 0, up, 1)], 4)
case("a floor that falls away lets the ball go when it falls faster",
     DROP + "constraint floor: y >= -6 t^2\nrestitution 0 on floor\ninit y = 0, y' = 0\nask solve y'', solve λ_floor\nsimulate 0..1 [s]\n"
     .replace("-6 t^2", "-(6 [m/s^2]) t^2"), [([], 1, 0, 1)], 1, says("would have to pull"))
case("a floor that falls slower holds the ball",
     DROP + "constraint floor: y >= -(2 [m/s^2]) t^2\ninit y = 0, y' = 0\nask solve y'', solve λ_floor\nsimulate 0..1 [s]\n", [(["floor"], 0, 0, 1)], 2)
case("a ball between floor and ceiling",
     POINT + "param h = 1 [m]\nconstraint floor: y >= 0\nconstraint ceiling: y <= h\nrestitution 0 on floor\ninit x = 0, y = h/2, x' = 1 [m/s], y' = 0\n"
     "ask dof, constraints, solve x'', solve y'', solve λ_floor, solve λ_ceiling, conserved\nsimulate 0..1 [s]\n",
     [([], 2, 0, math.sqrt(1 / G)), (["floor"], 1, math.sqrt(1 / G), 1)], 6)
case("a ball on the floor below a ceiling: the floor alone carries it",
     POINT + "param h = 1 [m]\nconstraint floor: y >= 0\nconstraint ceiling: y <= h\ninit x = 0, y = 0, x' = 1 [m/s], y' = 0\n"
     "ask dof, solve x'', solve λ_floor, solve λ_ceiling, conserved\nsimulate 0..1 [s]\n", [(["floor"], 1, 0, 1)], 4)
case("a ceiling that comes down is far away at first",
     POINT + "constraint floor: y >= 0\nconstraint ceiling: y <= 1 [m] - (1 [m/s]) t\ninit x = 0, y = 0, x' = 1 [m/s], y' = 0\n"
     "ask dof, solve x'', solve λ_floor, solve λ_ceiling\nsimulate 0..0.9 [s]\n", [(["floor"], 1, 0, 0.9)], 3)
case("a ball below a ceiling that falls faster is pushed down",
     DROP + "constraint ceiling: y <= 1 [m] - (20 [m/s^2]) t^2/2\ninit y = 1 [m], y' = 0\nask solve y'', solve λ_ceiling\nsimulate 0..0.3 [s]\n",
     [(["ceiling"], 0, 0, 0.3)], 2)



def shares(motion):
    """Two contacts on one place: only what they do together is determined, and no choice is made that pulls."""
    need("λ_floor + λ_lid = m g" in texts(motion) and "minimum norm" not in texts(motion), texts(motion))


case("a floor and a ceiling at the same height are an equality",
     POINT + "constraint floor: y >= 0\nconstraint lid: y <= 0\ninit x = 0, y = 0, x' = 1 [m/s], y' = 0\n"
     "ask dof, solve x'', solve λ_floor, conserved\nsimulate 0..1 [s]\n", [(["floor", "lid"], 1, 0, 1)], 2, shares)

# ---------------------------------------------------------------------------------------------- walls
case("a wall far away does nothing",
     POINT + "param F = 150 [N]\nforce (F, 0) on A\nconstraint table: y >= 0\nconstraint wall: x >= -100 [m]\n"
     "init x = 0, y = 0, x' = 1 [m/s], y' = 0\nask solve x'', solve x(t), solve λ_table, conserved\nsimulate 0..0.5 [s]\n",
     [(["table"], 1, 0, 0.5)], 4)
meet = (-1 + math.sqrt(1 + 4 * 2)) / 2
case("a wall that is met holds the block",
     POINT + "param F = 4 [N]\nforce (F, 0) on A\nconstraint table: y >= 0\nconstraint wall: x <= 2 [m]\nrestitution 0 on wall\n"
     "init x = 0, y = 0, x' = 1 [m/s], y' = 0\nask solve x'', solve λ_table, solve λ_wall, conserved\nsimulate 0..2 [s]\n",
     [(["table"], 1, 0, meet), (["table", "wall"], 0, meet, 2)], 5)
case("a block beside a wall that moves away from it",
     POINT + "constraint table: y >= 0\nconstraint wall: x >= 0\ninit x = 0, y = 0, x' = 1 [m/s], y' = 0\nask solve x'', solve λ_wall\nsimulate 0..1 [s]\n",
     [(["table"], 1, 0, 1)], 2)
case("a block that is drawn from a wall lets go at once",
     POINT + "param F = 4 [N]\nforce (F, 0) on A\nconstraint table: y >= 0\nconstraint wall: x >= 0\ninit x = 0, y = 0, x' = 0, y' = 0\n"
     "ask solve x'', solve λ_wall\nsimulate 0..1 [s]\n", [(["table"], 1, 0, 1)], 2, says("would have to pull"))

# ---------------------------------------------------------------------------------------------- ropes
TWO = "param m1 = 3 [kg], m2 = 2 [kg], g = 9.81 [m/s^2], l = 4 [m], h = 2 [m]\ncoord x1, x2\naxes x down\nmass m1 at (x1)\nmass m2 at (x2)\ngravity g along x\n"
a = G / 5
reach = math.sqrt(2 * 1 / a)
case("a pulley whose floor is not reached yet",
     TWO + "constraint rope: x1 + x2 <= l\nconstraint floor: x1 <= h\nrestitution 0 on floor\ninit x1 = 1 [m], x2 = 3 [m], x1' = 0, x2' = 0\n"
     "ask solve x1'', solve x2'', solve λ_rope, solve λ_floor, conserved\nsimulate 0..1.2 [s]\n",
     [(["rope"], 1, 0, reach), (["floor"], 1, reach, 1.2)], 6)
case("a rope that hangs slack does nothing",
     TWO + "constraint rope: x1 + x2 <= l\ninit x1 = 1 [m], x2 = 2 [m], x1' = 0, x2' = 0\nask solve x1'', solve x2'', solve λ_rope\nsimulate 0..0.2 [s]\n",
     [([], 2, 0, 0.2)], 3)
case("a stone on a string that is slack falls, then swings",
     POINT + "param l = 1 [m]\nconstraint string: x^2 + y^2 <= l^2\ninit x = 0.6 [m], y = 0.2 [m], x' = 0, y' = 0\n"
     "ask solve x'', solve y'', solve λ_string\nsimulate 0..0.6 [s]\n",
     [([], 2, 0, math.sqrt(2 / G)), (["string"], 1, math.sqrt(2 / G), 0.6)], 5)
case("a stone on a taut string above the horizontal falls freely",
     POINT + "param l = 1 [m]\nconstraint string: x^2 + y^2 <= l^2\ninit x = 0.6 [m], y = 0.8 [m], x' = 0, y' = 0\n"
     "ask solve x'', solve y'', solve λ_string\nsimulate 0..0.3 [s]\n", [([], 2, 0, 0.3)], 3, says("would have to pull"))

# ---------------------------------------------------------------------------------------------- slopes and hills
case("a jump that lands on a slope",
     POINT + "constraint slope: x + y >= 0\nrestitution 0 on slope\ninit x = 0, y = 0, x' = 2 [m/s], y' = 2 [m/s]\n"
     "ask solve x'', solve y'', solve λ_slope\nsimulate 0..1.2 [s]\n", [([], 2, 0, 2 * 4 / G), (["slope"], 1, 2 * 4 / G, 1.2)], 5)
case("a body on a slope slides",
     POINT + "constraint slope: x + y >= 0\ninit x = 0, y = 0, x' = 0, y' = 0\nask solve x'', solve y'', solve λ_slope, conserved\nsimulate 0..1 [s]\n",
     [(["slope"], 1, 0, 1)], 3)
jerk = math.sqrt(4 * 0.92 * math.sin(math.radians(5)) / G)


def keeps_place(motion):
    """What goes taut loses the radial part of its velocity, and stays where it is."""
    rows = [r for r in motion.rows if abs(r["t"] - jerk) < 1e-6]
    need(len(rows) == 2, f"rows at the jerk: {rows}")
    for name, want in (("x", 0.92 * math.cos(math.radians(5))), ("y", -0.92 * math.sin(math.radians(5)))):
        need(abs(rows[1][name] - want) < 1e-9, f"{name} = {rows[1][name]} after the jerk, not {want}")
    fall, side = -G * jerk, math.radians(85)
    along = (math.cos(side), math.sin(side))
    speed = fall * along[1]
    for name, want in (("x_dot", speed * along[0]), ("y_dot", speed * along[1])):
        need(abs(rows[1][name] - want) < 1e-9, f"{name} = {rows[1][name]} after the jerk, not {want}")


case("a string goes taut where its angle is a choice",
     POINT + "param l = 0.92 [m]\ncoord φ\nconstraint string: sqrt(x^2 + y^2) <= l\nchoose φ with x = l sin φ, y = -l cos φ\ninit φ = 95°, φ' = 0\n"
     "ask solve x'', solve y'', solve λ_string\nsimulate 0..1 [s]\n", [([], 2, 0, jerk), (["string"], 1, jerk, 1)], 4, keeps_place)
case("a bead leaves a sphere, in Cartesian coordinates with a choice",
     "param m = 1 [kg], R = 1 [m], g = 9.81 [m/s^2]\ncoord x, z, ϑ\naxes x right, z up\nmass m at (x, z)\ngravity g along -z\n"
     "constraint h: x^2 + z^2 >= R^2\nchoose ϑ with x = R sin ϑ, z = R cos ϑ\ninit ϑ = 0.3, ϑ' = 0\nevent ground: when z = 0 -> stop\n"
     "ask solve x'', solve z'', solve λ_h\nsimulate 0..5 [s]\n",
     [(["h"], 1, 0, 0.563), ([], 2, 0.564, 0.777)], 5)
case("a skier who starts in the air lands on the hill",
     "param m = 1 [kg], R = 1 [m], g = 9.81 [m/s^2]\ncoord r, φ\naxes x right, z up\nmass m at (r sin φ, r cos φ)\ngravity g along -z\n"
     "constraint hill: r >= R\nrestitution 0 on hill\ninit r = 1.2 [m], φ = 0.1, r' = 0, φ' = 0\nask solve r'', solve φ'', solve λ_hill\nsimulate 0..0.3 [s]\n",
     [([], 2, 0, 0.2), (["hill"], 1, 0.21, 0.3)], 5)

# ---------------------------------------------------------------------------------------------- release and attach
PENDULUM = ("param m = 1 [kg], l = 1 [m], g = 9.81 [m/s^2]\ncoord x, y, φ\naxes x right, y up\nmass m at (x, y)\ngravity g along -y\n"
            "constraint thread: x^2 + y^2 = l^2\n")
case("a pendulum whose thread is cut flies on",
     PENDULUM + "choose φ with x = l sin φ, y = -l cos φ\ninit φ = 45°, φ' = 0\nevent cut: when t = 1/2 [s] -> release thread\n"
     "ask solve x'', solve y'', solve λ_thread, conserved\nsimulate 0..1 [s]\n", [(["thread"], 1, 0, 0.5), ([], 2, 0.5, 1)], 6)
case("the same without a choice",
     PENDULUM.replace(", φ", "") + "init x = 0.6 [m], y = -0.8 [m], x' = 0, y' = 0\nevent cut: when t = 0.3 [s] -> release thread\n"
     "ask solve x'', solve y'', solve λ_thread\nsimulate 0..1 [s]\n", [(["thread"], 1, 0, 0.3), ([], 2, 0.3, 1)], 5)
case("a bead leaves the end of its wire",
     POINT + "constraint wire: y = 0\ninit x = 0, y = 0, x' = 2 [m/s], y' = 0\nevent end: when x = 1 [m] -> release wire\n"
     "ask solve x'', solve y'', solve λ_wire, conserved\nsimulate 0..1 [s]\n", [(["wire"], 1, 0, 0.5), ([], 2, 0.5, 1)], 5)
case("a rod that is attached later",
     POINT + "param l = 1 [m]\nconstraint rod: x^2 + y^2 = l^2, off\ninit x = 0.6 [m], y = -0.8 [m], x' = 0, y' = 0\n"
     "event grip: when t = 0 -> record\nevent hold: when x = 0.6 [m] -> attach rod\nask solve x'', solve y''\nsimulate 0..0.2 [s]\n"
     .replace("event grip: when t = 0 -> record\n", "").replace("event hold: when x = 0.6 [m]", "event hold: when t = 1 [s]"),
     [([], 2, 0, 0.2)], 2)

# ---------------------------------------------------------------------------------------------- several at once
case("a ladder between wall and floor, by a choice",
     "param m = 10 [kg], l = 4 [m], g = 9.81 [m/s^2]\ncoord x, y, α\naxes x right, y up\nbody ladder: mass m, inertia m l^2/12 at (x, y) angle α\n"
     "gravity g along -y\nconstraint wall: x - l/2 cos α >= 0\nconstraint floor: y - l/2 sin α >= 0\nchoose α with x = l/2 cos α, y = l/2 sin α\n"
     "init α = 70°, α' = 0\nevent down: when α = 0 -> stop\nask solve α'', solve λ_wall, solve λ_floor\nsimulate 0..5 [s]\n",
     [(["wall", "floor"], 1, 0, 0.84), (["floor"], 2, 0.85, 1.18)], 5)
case("a ball rolls along the floor to the wall, by a choice",
     POINT + "coord s\nconstraint wall: x >= 0\nconstraint floor: y >= 0\nrestitution 0 on wall\nchoose s with x = s, y = 0\ninit s = 1 [m], s' = -1 [m/s]\n"
     "ask solve x'', solve λ_floor, solve λ_wall\nsimulate 0..2 [s]\n", [(["floor"], 1, 0, 1), (["floor", "wall"], 0, 1, 2)], 4)
case("an impact at the start is none that contradicts",
     DROP + "constraint f: y >= 0\nrestitution 0.5 on f\ninit y = 0, y' = -2 [m/s]\nask solve y'', solve λ_f\nsimulate 0..0.2 [s]\n",
     [([], 1, 0, 0.2)], 2)
case("two blocks that are pushed together stay together",
     "param m = 1 [kg], M = 2 [kg], F = 3 [N]\ncoord x1, x2\naxes x right\nmass A: m at (x1)\nmass B: M at (x2)\nforce (F) on A\n"
     "constraint touch: x2 - x1 >= 1 [m]\ninit x1 = 0, x2 = 1 [m], x1' = 0, x2' = 0\nask solve x1'', solve x2'', solve λ_touch\nsimulate 0..1 [s]\n",
     [(["touch"], 1, 0, 1)], 3)
case("two blocks that are drawn apart part at once",
     "param m = 1 [kg], M = 2 [kg], F = 3 [N]\ncoord x1, x2\naxes x right\nmass A: m at (x1)\nmass B: M at (x2)\nforce (F) on B\n"
     "constraint touch: x2 - x1 >= 1 [m]\ninit x1 = 0, x2 = 1 [m], x1' = 0, x2' = 0\nask solve x1'', solve x2'', solve λ_touch\nsimulate 0..1 [s]\n",
     [([], 2, 0, 1)], 3)

# ---------------------------------------------------------------------------------------------- friction
BLOCK = "param μ = 0.3, F = 5 [N]\nforce (F, 0) on A\nconstraint floor: y >= 0\nfriction μ on floor\n"
ASK = "ask lagrange1, solve x'', solve λ_floor, conserved\n"
stop = 1 / (0.3 * G - 2.5)
case("a block slides, comes to rest and sticks",
     POINT + BLOCK + "init x = 0, y = 0, x' = 1 [m/s], y' = 0\n" + ASK + "simulate 0..4 [s]\n",
     [(["floor"], 1, 0, stop), (["floor"], 1, stop, 4)], 6)
case("a block that is pushed too weakly stays",
     POINT + BLOCK + "init x = 0, y = 0, x' = 0, y' = 0\n" + ASK + "simulate 0..1 [s]\n", [(["floor"], 1, 0, 1)], 3)
case("a block that is pushed harder slips at once",
     POINT + BLOCK.replace("5 [N]", "8 [N]") + "init x = 0, y = 0, x' = 0, y' = 0\n" + ASK + "simulate 0..1 [s]\n", [(["floor"], 1, 0, 1)], 3)
case("a force that grows makes a block slip",
     POINT + "param μ = 0.3, c = 4 [N/s]\nforce (c t, 0) on A\nconstraint floor: y >= 0\nfriction μ on floor\ninit x = 0, y = 0, x' = 0, y' = 0\n" + ASK
     + "simulate 0..3 [s]\n", [(["floor"], 1, 0, 0.3 * 2 * G / 4), (["floor"], 1, 0.3 * 2 * G / 4, 3)], 5)
half = math.pi / math.sqrt(10)
case("a spring draws a block to and fro: the friction turns with the slip",
     POINT.replace("m = 2 [kg]", "m = 1 [kg]") + "param μ = 0.2, k = 10 [N/m]\npotential k x^2/2\nconstraint floor: y >= 0\nfriction μ, static 0.3 on floor\n"
     "init x = 1 [m], y = 0, x' = 0, y' = 0\nask solve x'', solve λ_floor\nsimulate 0..4 [s]\n",
     [(["floor"], 1, 0, half), (["floor"], 1, half, 2 * half), (["floor"], 1, 2 * half, 4)], 6)
case("a body slips down a slope",
     POINT + "param μ = 0.2, α = 30°\nconstraint slope: y >= -x tan α\nfriction μ on slope\ninit x = 0, y = 0, x' = 0, y' = 0\n"
     "ask solve x'', solve y'', solve λ_slope\nsimulate 0..1 [s]\n", [(["slope"], 1, 0, 1)], 3)
case("a body sticks on a flat slope",
     POINT + "param μ = 0.7, α = 30°\nconstraint slope: y >= -x tan α\nfriction μ on slope\ninit x = 0, y = 0, x' = 0, y' = 0\n"
     "ask solve x'', solve y'', solve λ_slope\nsimulate 0..1 [s]\n", [(["slope"], 1, 0, 1)], 3)
roll = 2 / (3.5 * 0.2 * G)
case("a bowling ball slips, then rolls",
     "param m = 5 [kg], R = 0.1 [m], g = 9.81 [m/s^2], μ = 0.2\ncoord x, y, φ\naxes x right, y up\nbody ball: mass m, inertia 2/5 m R^2 at (x, y) angle φ\n"
     "gravity g along -y\nconstraint floor: y >= R\nfriction μ on floor\ninit x = 0, y = R, φ = 0, x' = 2 [m/s], y' = 0, φ' = 0\n"
     "ask lagrange1, solve x'', solve φ'', solve λ_floor\nsimulate 0..1 [s]\n", [(["floor"], 2, 0, roll), (["floor"], 2, roll, 1)], 6)
case("a block on a belt is carried along, then sticks to it",
     POINT + "param μ = 0.3, u = 1 [m/s]\nconstraint belt: y >= 0\nfriction μ, surface (u, 0) on belt\ninit x = 0, y = 0, x' = 0, y' = 0\n"
     "ask solve x'', solve λ_belt\nsimulate 0..1 [s]\n", [(["belt"], 1, 0, 1 / (0.3 * G)), (["belt"], 1, 1 / (0.3 * G), 1)], 4)
case("a block slides to the edge of a table and falls",
     POINT + "param μ = 0.1\nconstraint floor: y >= 0\nfriction μ on floor\nevent edge: when x = 1 [m] -> release floor\n"
     "init x = 0, y = 0, x' = 3 [m/s], y' = 0\nask solve x'', solve y'', solve λ_floor\nsimulate 0..0.8 [s]\n",
     [(["floor"], 1, 0, 0.35), ([], 2, 0.37, 0.8)], 5)
case("a spring that has passed zero length when another set begins",
     "param m = 1 [kg], k = 20 [N/m], F = 3 [N]\ncoord u, w\naxes x right, y up\nmass A: m at (u, 0)\nmass B: m at (w, 0)\n"
     "spring k, rest 0.3 [m] between A and (0, 0)\nforce (-F, 0) on B\nconstraint stop: w >= -0.5 [m]\n"
     "init u = 0.9 [m], u' = 0, w = -0.5 [m], w' = 0\nevent cut: when u = -0.1 [m] falling -> release stop\n"
     "ask solve u'', conserved\nsimulate 0..0.8 [s]\n",
     # zero length at (2 pi/3)/sqrt(20) = 0.4683: the other side, which has the third number, is left for the second set at 0.512
     [(["stop"], 1, 0, 0.45), ([], 2, 0.52, 0.75), (["stop"], 1, 0.469, 0.51)], 4)
done()
