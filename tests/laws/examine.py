"""Holds what the program says about a model against the witness: the rows of `sim` and every answer of `solve`.

    examine.py PROGRAM MODEL.pleuel...      examines given models and lists what disagrees
"""

import csv
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "founding"))
from formulas import Formula, NotAFormula  # noqa: E402
from formulas import evaluate as evaluate_formula  # noqa: E402

import rest  # noqa: E402
import symbols as s  # noqa: E402
from model import Model  # noqa: E402
from reader import Parser, Unread, ascii_name, find_word, split_top, tokens_of  # noqa: E402
from witness import Lost, Witness, integrate, kinematic_places, kinematic_rates, project, rank_of  # noqa: E402

sys.setrecursionlimit(100000)
ROWS = 24            # rows of a motion that are looked at
UNIT_BEHIND = r"(\d) (?:m|s|kg|N)\b"     # 1.5 m is a length, or a product with m: both are tried
TURNS = {"release", "impact", "contact", "slack", "taut", "stick", "slip"}


class Report:
    """What disagreed (kind, sentence), what was compared (counts), what the program declined."""

    def __init__(self):
        self.wrong, self.compared, self.refused = [], Counter(), Counter()

    def say(self, kind, text):
        self.wrong.append((kind, text))

    def check(self, kind, ok, text):
        self.compared[kind] += 1
        if not ok:
            self.say(kind, text() if callable(text) else text)
        return ok

    def kinds(self):
        return sorted({k for k, _ in self.wrong})


def near(a, b, scale=0.0, rel=1e-7):
    return abs(a - b) <= rel * max(abs(a), abs(b), scale, 1e-2)


def inertia(pair, names):
    """What stands in front of accelerations in an equation, where that is large: an equation times a million says the same."""
    def left_over(bumped):
        a, b = (value_or_none(e, {**names, **bumped}) for e in pair)
        return None if a is None or b is None else a - b
    plain = left_over({})
    moved = [left_over({k: x + 1.0}) for k, x in names.items() if k.endswith("_ddot") and isinstance(x, float)]
    return max([1.0] + [abs(x - plain) for x in moved if x is not None and plain is not None])


# ------------------------------------------------------------------------------------------------ the program
class Program:
    """Runs pleuel.  damage is a function of the parsed answers that a test of the test hands in."""

    def __init__(self, path, damage=None):
        self.path, self.damage, self.hurt = path, damage, 0

    def call(self, verb, text, *flags):
        done = subprocess.run([self.path, verb, *flags, "-"], input=text.encode(), capture_output=True, timeout=60)
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")

    def solve(self, text):
        code, out, err = self.call("solve", text, "--json", "--no-simulation")
        try:
            document = json.loads(out)
        except ValueError:
            document = None
        if document and self.damage:
            self.hurt += bool(self.damage("solve", document))
        return code, document, err

    def simulate(self, text, *flags):
        with tempfile.TemporaryDirectory() as room:
            path = os.path.join(room, "rows.csv")
            code, out, err = self.call("sim", text, "--json", "-o", path, *flags)
            try:
                document = json.loads(out)
            except ValueError:
                document = {}
            rows = rows_of(path) if os.path.exists(path) else []
        if self.damage:
            self.hurt += bool(self.damage("sim", rows))
        return code, document, rows, err


def column_name(head):
    """x_dot[2] [m/s] is x_2_dot."""
    word = re.sub(r" \[[^\]]*\]$", "", head)
    m = re.fullmatch(r"(.*?)_(d?dot)((?:\[-?\d+\])+)", word)
    if m:
        word = f"{m.group(1)}{m.group(3)}_{m.group(2)}"
    return re.sub(r"\[(-?\d+)\]", r"_\1", word)


def rows_of(path):
    with open(path, encoding="utf-8") as f:
        lines = [line for line in f if not line.startswith("#")]
    out = []
    for r in csv.DictReader(lines):
        row = {}
        for k, v in r.items():
            try:
                row[column_name(k)] = float(v)
            except (TypeError, ValueError):
                row[column_name(k)] = v
        out.append(row)
    return out


def spelled(model, q):
    """A coordinate as one writes it: x_3 of a family is x[3]."""
    word, _, k = q.rpartition("_")
    return f"{word}[{k}]" if word in model.families else q


# ------------------------------------------------------------------------------------------------ the motion
class Moment:
    """One row of the motion: state, what the witness says there, and the phase it belongs to."""

    def __init__(self, row, z, q, v, motion, released, phase):
        self.row, self.z, self.q, self.v = row, z, q, v
        self.motion, self.released, self.phase = motion, released, phase


class Examination:
    def __init__(self, program, text, values=None):
        self.program, self.text, self.report = program, text, Report()
        self.model = Model(text)
        given = {k: 0.83 + 0.31 * i for i, (k, v) in enumerate(self.model.params.items()) if v is None}
        self.assumed = {**given, **(values or {})}
        self.w = Witness(self.model, self.assumed)
        self.moments, self.events, self.near_by = [], [], []
        self.sim = {}

    def go(self):
        if self.w.slips is not None:
            self.motion()
        self.answers()
        return self.report

    # -------------------------------------------------------------------------------------------- sim
    def motion(self):
        text = self.text
        for q in self.w.q:
            text += f"\noutput acc_{q} = {spelled(self.model, q)}''"
        t0, t1 = self.model.interval or (self.model.start_time, self.model.start_time + 1.0)
        flags = ["--dt", repr((t1 - t0) / ROWS)]
        flags += [] if self.model.interval else ["--until", repr(t1)]
        for k, v in self.assumed.items():
            flags += ["--set", f"{k}={v!r}"]
        code, self.sim, rows, err = self.program.simulate(text, *flags)
        if code != 0:
            said = self.sim.get("message") or err.strip().splitlines()[:1]
            self.report.refused[f"sim {code}"] += 1
            self.report.sim_said = f"sim {code}: {said}"
            if code not in (3, 4, 6, 2) or (code == 4 and self.start_is_fine()):
                self.report.say("sim exit", f"exit {code}: {said}")
        self.events = self.sim.get("events", [])
        self.read_rows(rows)
        self.check_rows()
        self.check_steps()
        self.check_events()

    def start_is_fine(self):
        """Whether the start as given fulfils everything."""
        init = dict(self.model.init)
        values = {k: s.num(v) for k, v in self.w.values.items()}
        z = []
        for n in self.w.names[: 2 * self.w.n]:
            e = s.replaced(init[n], values) if n in init else None
            if e is None or not s.is_num(e):
                return False
            z.append(e.args[0])
        try:
            p = self.w.at(self.w.state(z[: self.w.n], z[self.w.n :], self.model.start_time))
        except Lost:
            return False
        for j, c in enumerate(self.w.rows):
            if not c.one_sided and max(abs(p.g[j]), abs(p.rate[j])) > 1e-9:
                return False
            if c.one_sided and (p.g[j] < 0 if c.sense == ">=" else p.g[j] > 0):
                return False
        return True

    def read_rows(self, rows):
        """Moments from rows; the released constraints from the events."""
        released, phase = frozenset(), 0
        pending = list(self.events)
        by_label = {e.label: e for e in self.model.events}
        for k, row in enumerate(rows):
            while pending and self.is_behind(pending[0], rows, k):
                e = pending.pop(0)
                event = by_label.get(e["label"]) if e["kind"] in ("event", "stop") else None
                for verb, target in event.actions if event else ():
                    if verb == "release":
                        released = released | {target}
                    elif verb == "attach":
                        released = released - {target}
                    if verb in ("release", "attach", "set"):
                        phase += 1
                if e["kind"] in TURNS and not e.get("at_start"):
                    phase += 1
            q, v = [row[x] for x in self.w.q], [row.get(x + "_dot", 0.0) for x in self.w.q]
            z = self.w.state(q, v, row["t"])
            try:
                motion = self.w.at(z).motion(released)
            except Lost:
                motion = None
            self.moments.append(Moment(row, z, q, v, motion, released, phase))

    @staticmethod
    def is_behind(event, rows, k):
        """Whether row k is behind the event: the first of two rows at its time is before it."""
        t = rows[k]["t"]
        if abs(event["t"] - t) > 1e-12 * max(1.0, abs(t)):
            return t > event["t"]
        twin_follows = k + 1 < len(rows) and rows[k + 1]["t"] == t
        if not twin_follows:
            return True
        state = event["state"]
        here = sum(abs(rows[k].get(n, 0.0) - x) for n, x in state.items() if isinstance(x, float))
        there = sum(abs(rows[k + 1].get(n, 0.0) - x) for n, x in state.items() if isinstance(x, float))
        return here < there

    def check_rows(self):
        for at in self.moments:
            p = at.motion.point if at.motion else None
            if not p:
                self.report.compared["row not told"] += 1
                continue
            self.check_place(at, p)
            self.check_row_numbers(at, p)

    def check_place(self, at, p):
        t = at.row["t"]
        for j, c in enumerate(self.w.rows):
            if c.label in at.released:
                continue
            size = max([abs(x) for x in p.G[j]] + [1e-9])
            if c.one_sided:
                depth = p.g[j] if c.sense == ">=" else -p.g[j]
                self.report.check("contact kept", depth > -1e-7 * max(1.0, size), lambda: (
                    f"{c.label} is passed through at t = {t}: {p.g[j]}"))
            elif not c.is_map or not at.released:
                off = max(abs(p.g[j]) if not c.velocity else 0.0, abs(p.rate[j]))
                self.report.check("constraint kept", off < 1e-7 * max(1.0, size), lambda: (
                    f"{c.label} is violated at t = {t}: {p.g[j]}, rate {p.rate[j]}"))

    def check_row_numbers(self, at, p):
        """Accelerations, multipliers and energies of a row."""
        t, row = at.row["t"], at.row
        size = max([abs(a) for a in at.motion.a] + [1.0])
        for q, a in at.motion.accelerations().items():
            got = row.get("acc_" + q)
            named_only = q in self.w.kinematic and (at.released or any(c.one_sided for c in self.w.rows))
            if isinstance(got, float) and got == got and not named_only:
                self.report.check("sim acceleration", near(got, a, size, 1e-6), lambda: (
                    f"sim says {q}'' = {got} at t = {t}, the equations say {a}; {at.motion.labels()} hold"))
        push = max([abs(x) for x in at.motion.lam.values()] + [1.0])
        for label, x in at.motion.multipliers().items():
            got = row.get(label)
            if x is not None and isinstance(got, float) and got == got:
                self.report.check("sim multiplier", near(got, x, push, 1e-6), lambda: (
                    f"sim says {label} = {got} at t = {t}, the equations say {x}"))
        if self.model.lagrangian is None and not self.velocity_potential() and isinstance(row.get("V"), float):
            self.report.check("sim energy", near(row["T"], p.T, 1.0), lambda: (
                f"sim says T = {row['T']} at t = {t}, it is {p.T}"))
            if p.steady == p.steady:
                ok = near(row["V"], p.V, 1.0) or near(row["V"], p.V + p.steady, 1.0)
                self.report.check("sim energy", ok, lambda: (
                    f"sim says V = {row['V']} at t = {t}, it is {p.V}, with constant forces {p.V + p.steady}"))

    def velocity_potential(self):
        return any(n.endswith("_dot") for n in s.names_of(self.model.V))

    def check_steps(self):
        """From row to row by integration of one's own, where nothing happens between them."""
        for a, b in zip(self.moments, self.moments[1:]):
            quiet = a.motion and b.motion and a.phase == b.phase and a.row["t"] < b.row["t"]
            if not quiet or a.motion.active != b.motion.active and set(a.motion.labels()) ^ set(b.motion.labels()):
                continue
            try:
                q, v = integrate(self.w, a.q, a.v, a.row["t"], b.row["t"], a.motion.active)
            except (Lost, OverflowError, ValueError):
                self.report.compared["step not told"] += 1
                continue
            size = max([abs(x) for x in v.values()] + [1.0])
            for name, want in list(q.items()) + [(k + "_dot", x) for k, x in v.items()]:
                got = b.row[name]
                self.report.check("sim step", near(got, want, size, 3e-6), lambda: (
                    f"from t = {a.row['t']} to {b.row['t']} sim moves {name} to {got}, integration to {want}"))

    def check_events(self):
        by_label = {e.label: e for e in self.model.events}
        for e in self.events:
            event = by_label.get(e["label"])
            if e["kind"] in ("event", "stop") and event and event.g is not None:
                self.check_event_place(e, event)
            if e["kind"] in ("impact", "taut") and not self.model.friction and "before" in e and "after" in e:
                self.check_impact(e)

    def check_event_place(self, e, event):
        names = {**self.numbers(), **(e.get("before") or e["state"]), "t": e["t"]}
        names = {column_name(k): x for k, x in names.items()}
        if any(a[0] == "set" for a in event.actions) or not s.names_of(event.g) <= set(names):
            return
        x = value_of(event.g, names)
        slope = sum(abs(value_of(s.diff(event.g, n), names)) for n in s.names_of(event.g)) + 1.0
        self.report.check("event place", abs(x) < 1e-6 * slope, lambda: (
            f"event {e['label']} at t = {e['t']}: its condition is off by {x}"))

    def check_impact(self, e):
        """Velocities behind an impact: the rows that hold or are hit, u+ + e u- >= 0, impulse >= 0."""
        before = {column_name(k): x for k, x in e["before"].items()}
        after = {column_name(k): x for k, x in e["after"].items()}
        at = [m for m in self.moments if m.row["t"] <= e["t"]]
        released = at[-1].released if at else frozenset()
        q, v = [before[x] for x in self.w.q], [before[x + "_dot"] for x in self.w.q]
        try:
            p = self.w.at(self.w.state(q, v, e["t"]))
            want = rest.impact(self.w, p, v, released, self.restitution())
        except Lost:
            return
        size = max(abs(x) for x in v) + 1e-3
        for name, x in want.items() if want else ():
            got = after[name + "_dot"]
            self.report.check("impact", near(got, x, size, 1e-6), lambda: (
                f"impact on {e['of']} at t = {e['t']}: {name}' becomes {got}, the law says {x}"))

    def restitution(self):
        return {k: value_of(e, self.numbers()) for k, e in self.model.restitution.items()}

    def numbers(self):
        return {k: v for k, v in self.w.values.items() if v is not None}

    # -------------------------------------------------------------------------------------------- solve
    def answers(self):
        code, document, err = self.program.solve(self.text)
        if document is None:
            self.report.say("no document", f"exit {code}: {err[:200]}")
            return
        failed = [c["name"] + ": " + str(c.get("failed_on"))[:150] for c in document.get("checks", []) if not c["passed"]]
        if failed:
            self.report.say("own check", f"exit {code}: {failed}")
        if document["status"] not in ("ok", "expect_failed", "no_closed_form"):
            said = [n["text"] for n in document.get("notes", []) if n.get("severity") == "error"]
            self.report.refused[f"solve {code}"] += 1
            self.report.solve_said = f"solve {code} {document['status']}: {document.get('message')} {said[:1]}"
            if code not in (0, 1, 3, 4, 5, 6) or code == 4 and self.moments:
                self.report.say("solve exit", f"exit {code}, {document['status']}: {document.get('message')} {said}")
        self.document = document
        self.conditions = self.read_assumptions(document.get("assumptions", []))
        self.first = [m for m in self.moments if m.phase == 0 and m.motion]
        self.first = self.with_one_set(self.first)
        self.perturb()
        self.along = list(self.first)
        self.first = self.within(self.first)
        self.near_by = self.within(self.near_by)
        self.check_dof()
        for items in document.get("answers", {}).values():
            for item in items:
                self.check_item(item)
        self.check_missing(document)

    def read_assumptions(self, texts):
        """Relations as expressions that are not negative where they hold."""
        out, both = [], []
        for text in texts:
            text = re.sub(r"\((\d[\d.]*) (?:m|s|kg|N)\)", r"\1", text)      # in brackets it is a unit
            both += [text] + ([re.sub(UNIT_BEHIND, r"\1", text)] if re.search(UNIT_BEHIND, text) else [])
        for text in both:
            try:
                tokens = tokens_of(text)
                at = find_word(tokens, ">", "<", ">=", "<=")
                left, right = Parser(tokens[:at], self.model, {}).whole(), Parser(tokens[at + 1 :], self.model, {}).whole()
                out.append(left - right if tokens[at].text in (">", ">=") else right - left)
            except (Unread, AttributeError, IndexError, TypeError):
                continue
        return out

    def with_one_set(self, moments):
        """Those with the constraints of the start.  At the start and at an event a force may be zero: neither tells which."""
        at_event = [e["t"] for e in self.events]
        sure = [m for m in moments[1:] if all(abs(m.row["t"] - t) > 1e-12 * max(1.0, abs(t)) for t in at_event)]
        told = sure or moments
        return [m for m in moments if m.motion.labels() == told[0].motion.labels()] if told else moments

    def on_its_sides(self, value, moments, to_the_end=False):
        """Moments where all holds that a value assumes; of a closed motion those before it fails for the first time."""
        conditions = self.read_assumptions(value.get("assuming") or [])
        out = []
        for m in moments:
            if self.meets(conditions, m.z):
                out.append(m)
            elif to_the_end:
                break
        return out

    def within(self, moments):
        """Those where all that the program says it assumed is so."""
        kept = [m for m in moments if self.holds_at(m.z)]
        self.report.compared["outside of assumptions"] += len(moments) - len(kept)
        return kept

    def holds_at(self, z):
        return self.meets(self.conditions, z)

    def meets(self, conditions, z):
        names = dict(zip(self.w.names, z))
        return all((value_or_none(e, names) or 0.0) >= -1e-9 for e in conditions)

    def assumed_there(self, q):
        """Whether a place without velocity is among those that the program speaks of."""
        return self.holds_at(self.w.state(q, [0.0] * self.w.n, self.model.start_time))

    def perturb(self):
        """States beside the motion, with the same contacts."""
        rng = random.Random(len(self.text))
        base = self.first[:: max(1, len(self.first) // 6)] or self.made_states(rng)
        for m in base:
            q = [x + 0.05 * rng.uniform(-1, 1) for x in m.q]
            v = [x + 0.2 * rng.uniform(-1, 1) for x in m.v]
            labels = m.motion.labels()
            try:
                got = project(self.w, q, v, m.z[2 * self.w.n], labels, m.released)
                if not got:
                    continue
                z = self.with_maps(*got, m.z[2 * self.w.n])
                if not z:
                    continue
                motion = self.w.at(z).motion(m.released)
            except Lost:
                continue
            if motion.labels() == labels and self.open_ones_are(motion):
                n = self.w.n
                self.near_by.append(Moment({"t": z[2 * n]}, z, z[:n], z[n : 2 * n], motion, m.released, 0))

    def open_ones_are(self, motion):
        p = motion.point
        return all(not c.one_sided or j in motion.active or (p.g[j] > 0) == (c.sense == ">=")
                   for j, c in enumerate(self.w.rows))

    def with_maps(self, q, v, t):
        """The state, with coordinates that only name a place from their maps."""
        z = kinematic_places(self.w, self.w.state(q, v, t))
        if not z:
            return None
        for x, (rate, _) in kinematic_rates(self.w, z, [0.0] * len(self.w.d)).items():
            z[self.w.n + self.w.q.index(x)] = rate
        return z

    def made_states(self, rng):
        """Consistent states of a model that was not simulated."""
        out = []
        if any(c.one_sided for c in self.w.rows) or self.text.count("branch "):
            return out
        for _ in range(12):
            q = [rng.uniform(0.2, 1.3) for _ in self.w.q]
            v = [rng.uniform(-1, 1) for _ in self.w.q]
            t = self.model.start_time + 0.3
            try:
                got = project(self.w, q, v, t)
                z = self.with_maps(*got, t) if got else None
                if z:
                    n = self.w.n
                    motion = self.w.at(z).motion()
                    out.append(Moment({"t": t}, z, z[:n], z[n : 2 * n], motion, frozenset(), 0))
            except Lost:
                continue
        return out[:4]

    def names_at(self, m):
        """Everything that a formula may contain, as numbers."""
        w = self.w
        out = dict(zip(w.names, m.z))
        for q, (v, _) in kinematic_rates(w, m.z, m.motion.a).items():
            out[q + "_dot"] = v
        for q, a in m.motion.accelerations().items():
            out[q + "_ddot"] = a
        for label, x in m.motion.multipliers().items():
            if x is not None:
                out[label] = x
        for word, program in w.lets.items():
            try:
                out[word] = program(m.z + [out.get(n, math.nan) for n in w.acceleration_names])[0]
            except (ValueError, ZeroDivisionError, OverflowError):
                pass
        out.update(self.start_values())
        if not w.rows and self.model.lagrangian is not None:
            out.update({f"p_{q}": x for q, x in zip(w.d, momenta(w, m.z))})
            out["H of the witness"] = m.motion.point.H
        p = m.motion.point
        for n, x in (("T", p.T), ("V", p.V if not self.model.pushes else p.V + p.steady)):
            out.setdefault(n, x)
        return out

    def start_values(self):
        first = self.moments[0] if self.moments else None
        if not first:
            return {}
        out = {}
        for q, x, v in zip(self.w.q, first.q, first.v):
            out[q + "_0"], out[q + "_dot_0"] = x, v
        return out

    def formula(self, value, names):
        """The number of a value; None where it has none, or was withdrawn."""
        if not value.get("expr"):
            return None
        try:
            names = dict(names)
            for k, text in value.get("where", {}).items():
                names[k] = parsed(text).value(names)
            x = parsed(value["expr"]).value(names)
            return float(x) if not isinstance(x, complex) else None
        except (NotAFormula, ValueError, ZeroDivisionError, OverflowError, TypeError):
            return None

    def check_dof(self):
        """Freedoms at the start, with the contacts that hold there, by numeric rank."""
        got = self.document.get("dof") or {}
        if self.model.friction:
            return
        states = self.first or self.near_by
        if got.get("dof") is None or not states or got.get("hidden") or len(states) < 2:
            return
        m = states[1]
        p = m.motion.point
        rows = [j for j in m.motion.active if not self.w.rows[j].is_map or self.w.map_rows == []]
        place = [j for j in rows if not self.w.rows[j].velocity]
        dof = len(self.w.d) - rank_of([p.G[j] for j in place])
        both = len(self.w.d) - rank_of([p.G[j] for j in rows])
        self.report.check("dof", got["dof"] == dof and got.get("velocity_dof", both) == both, lambda: (
            f"dof {got['dof']} (velocities {got.get('velocity_dof')}), by numeric rank {dof} ({both}); "
            f"{m.motion.labels()} hold"))

    # -------------------------------------------------------------------------------------------- items
    def check_item(self, item):
        text = item["item"]
        if item.get("stage", 1) > 1:
            self.check_stage(item)
            return
        text_said = " ".join(str(x.get("text")) for x in item.get("steps", []))
        if re.match(r"equilibria\s*$", text):
            rest.check_equilibria(self, item, text_said)
            return
        if re.search(r"\b(limit|series|threshold|max|min|for|at|modes)\b", text):
            return
        if re.search(r"\b(where|from)\b", text):
            rest.check_where(self, item, text_said)
            return
        if re.match(r"lagrange[12]", text):
            self.check_equations(item)
        branches = any(v.get("branch") for v in item["values"])
        for v in item["values"]:
            if v.get("withdrawn"):
                self.report.refused["withdrawn"] += 1
                self.report.solve_said = f"withdrawn: {v['name']} of {text}"
            elif v.get("components"):
                self.check_force(item, v)
            elif v.get("conserved"):
                self.check_conserved(v)
            elif v.get("expr") and not branches and not v.get("lhs"):
                self.check_value(text, v)

    def check_equations(self, item):
        """Every equation that is shown, as far as its names are known, holds at every moment."""
        for step in item.get("steps", []):
            pair = self.shown_equation(step)
            if not pair:
                continue
            for m in self.first[:: max(1, len(self.first) // 4)] + self.near_by:
                names = self.names_at(m)
                a, b = (value_or_none(e, names) for e in pair)
                if a is None or b is None:
                    continue
                size = max([abs(x) for x in m.motion.a] + [abs(a), 1.0]) * inertia(pair, names)
                if not self.report.check("equation", near(a, b, size, 1e-6), lambda: (
                        f"{step['text']} ({item['item']}): {a} = {b} at t = {m.row['t']}; {brief(m)}")):
                    return

    def shown_equation(self, step):
        """Both sides of an equation that is shown; None where it speaks of something else."""
        text = step.get("text") or ""
        if step.get("kind") != "equation" or not text or " e_" in text or re.search(r"\d (?:1/)?(?:m|s|kg|N|rad)\b", text):
            return None         # 1.5 m may be a length there, or a product with m
        try:
            sides = split_top(tokens_of(step["text"]), "=")
            if len(sides) != 2 or any(not side for side in sides):
                return None
            scope = Shown(self.model, self.multipliers())
            return [Parser(side, scope, {}).whole() for side in sides]
        except (Unread, AttributeError, IndexError, TypeError):
            return None

    def check_stage(self, item):
        """Formulas for a later set of contacts are those of one of the sets that the motion has."""
        sets = {}
        for m in self.moments:
            if m.motion:
                sets.setdefault((tuple(m.motion.labels()), tuple(sorted(m.released))), []).append(m)
        groups = [g[:8] for g in sets.values() if len(g) > 1]
        for v in item["values"]:
            known_kind = v["name"].endswith("_ddot") or v["name"] in self.multipliers()
            if groups and v.get("expr") and known_kind and not v.get("branch"):
                sides = [self.on_its_sides(v, g) for g in groups]
                self.report.check("later stage", any(self.agrees(v, g) for g in sides if g), lambda: (
                    f"{v['name']} = {v['expr'][:300]} ({item['item']}, stage {item['stage']}) fits no set of contacts "
                    f"of the motion: {sorted(sets)}"))

    def agrees(self, value, moments):
        for m in moments:
            names = self.names_at(m)
            x, want = self.formula(value, names), names.get(value["name"])
            if x is not None and want is not None and not near(x, want, max([abs(a) for a in m.motion.a] + [1.0]), 1e-6):
                return False
        return True

    def expected(self, text, value):
        """What a value is at a moment, as a function; None if this cannot be told."""
        n = value["name"]
        if n.endswith("_ddot") or n in self.multipliers():
            return lambda names: names.get(n)
        if n == "H" and text == "hamiltonian":
            return lambda names: names.get("H of the witness")
        if n in ("T", "V") and not (n == "V" and self.velocity_potential()) and self.model.lagrangian is None:
            return lambda names: names.get(n)
        if text.startswith("solve ") and "(t)" in text:
            return lambda names: names.get(n)
        try:
            e = Parser(tokens_of(text), self.model, {}).whole()
        except (Unread, AttributeError, IndexError, TypeError):
            return None
        if isinstance(e, tuple):
            return None
        return lambda names: value_or_none(e, names)

    def multipliers(self):
        return [c.multiplier for c in self.w.rows]

    def check_value(self, text, value):
        want = self.expected(text, value)
        if not want:
            return
        kind = ("x(t)" if "(t)" in text else "acceleration" if value["name"].endswith("_ddot") else
                "multiplier" if value["name"] in self.multipliers() else "expression")
        moments = self.first + self.near_by
        if kind == "x(t)":
            moments = self.on_its_sides(value, self.along, True)
        tried = held = 0
        for m in moments:
            names = self.names_at(m)
            x = want(names)
            if kind == "x(t)":
                names = {k: v for k, v in names.items() if k in self.w.values or k == "t" or k.endswith("_0")
                         or k in self.w.lets}
            if x is None or x != x:
                continue
            tried += 1
            got = self.formula(value, names)
            if got is None or got != got:
                continue
            held += 1
            size = max([abs(a) for a in m.motion.a] + [1.0])
            if not self.report.check(kind, near(got, x, size, 1e-6), lambda: (
                    f"{value['name']} = {value['expr'][:300]} ({text}) is {got} at t = {m.row['t']}, true is {x}; "
                    f"{m.motion.labels()} hold; state {brief(m)}")):
                return
        if tried > 2 and held == 0:
            self.report.check(kind, False, f"{value['name']} = {value['expr'][:300]} ({text}) has no number anywhere")

    def check_conserved(self, value):
        along = [self.formula(value, self.names_at(m)) for m in self.first]
        along = [x for x in along if x is not None and x == x]
        if len(along) > 2:
            size = max([abs(x) for x in along] + [1e-2])
            off = max(along) - min(along)
            self.report.check("conserved", off <= 1e-6 * size, lambda: (
                f"{value['name']} = {value['expr'][:300]} is not constant: it changes by {off} of {size}"))
        if value["name"] in ("E", "H") and self.model.lagrangian is None:
            self.check_energy_formula(value)

    def check_energy_formula(self, value):
        """Up to a constant it is T + V or v dL/dv - L, beside the motion too."""
        pairs = []
        for m in self.near_by:
            x = self.formula(value, self.names_at(m))
            if x is not None:
                p = m.motion.point
                pairs.append([x] + [e + y for e in (p.T + p.V, p.H) for y in (0.0, p.steady)])
        if len(pairs) < 3 or any(c.velocity is False and "t" in s.names_of(c.g) for c in self.w.rows):
            return
        size = max(abs(x) for p in pairs for x in p if x == x) + 1e-2
        spread = [max(p[0] - p[k] for p in pairs) - min(p[0] - p[k] for p in pairs) for k in (1, 2, 3, 4)]
        spread = [x for x in spread if x == x]
        self.report.check("energy", min(spread) <= 1e-6 * size, lambda: (
            f"{value['name']} = {value['expr'][:300]} is not the energy: off by {min(spread)} of {size}"))

    def check_missing(self, document):
        """The energy is constant on the motion and nothing says so."""
        if self.model.friction:
            return
        asked = [i for items in document.get("answers", {}).values() for i in items if i["item"] == "conserved"]
        points = [m.motion.point for m in self.first]
        H = [p.T + p.V + p.steady for p in points]
        if not asked or len(H) < 10 or self.model.lagrangian is not None or H[0] != H[0]:
            return
        T = [p.T for p in points]
        driven = [x for _, at in self.model.masses.values() for x in at] + [c.g for c in self.w.rows]
        if any("t" in s.names_of(e) for e in driven):
            return
        if max(T) - min(T) > 1e-3 and max(H) - min(H) < 1e-9 * max(map(abs, H + T)):
            held = any(v.get("conserved") and v["name"] in ("E", "H") for i in asked for v in i["values"])
            self.report.check("energy missing", held, "T + V is constant on the motion, and `conserved` does not say so")

    def check_force(self, item, value):
        """A force on a mass whose place is given by coordinates of its own: lambda times the gradient there."""
        if value["name"] != "Z" or value.get("on") not in self.model.masses:
            return
        place = self.model.masses[value["on"]][1]
        rows = {c.label: c for c in self.w.rows}
        c = rows.get(column_name(value["of"]))
        if not c or any(x.op != "name" or x.args[0] not in self.w.d for x in place):
            return
        own = [x.args[0] for x in place]
        parts = {p["along"]: p for p in value["components"]}
        axes = ["e_" + spelled(self.model, q) for q in own] if set(parts) & {"e_" + q for q in own} else [
            "e_" + a for a in self.model.axes]
        if not set(parts) <= set(axes):
            return
        for m in self.first + self.near_by:
            names = self.names_at(m)
            if c.multiplier not in names:
                continue
            j, p = self.w.rows.index(c), m.motion.point
            for axis, q in zip(axes, own):
                want = self.model.sign * names[c.multiplier] * p.G[j][self.w.d.index(q)]
                got = self.formula({**value, **parts[axis]}, names) if axis in parts else 0.0
                size = abs(names[c.multiplier]) * max(abs(x) for x in p.G[j])
                if got is not None and not self.report.check("force", near(got, want, size, 1e-6), lambda: (
                        f"force of {value['of']} on {value['on']} along {axis} is {got}, true is {want}, at {brief(m)}")):
                    return


class Shown:
    """Names in formulas as they are shown: those of the model, and multipliers."""

    def __init__(self, model, multipliers):
        self.model, self.multipliers = model, multipliers

    def __getattr__(self, word):
        return getattr(self.model, word)

    def value(self, word, primes, parser):
        if word in self.multipliers and not primes:
            return s.name(word)
        return self.model.value(word, primes, parser)


def momenta(w, z):
    """dL/dv."""
    if not hasattr(w, "momentum_program"):
        w.momentum_program = s.compiled([s.diff(w.m.L, q + "_dot") for q in w.d], w.names)
    return w.momentum_program(z)


class Parsed:
    cache = {}


def parsed(text):
    if text not in Parsed.cache:
        if len(Parsed.cache) > 5000:
            Parsed.cache.clear()
        Parsed.cache[text] = Formula(text)
    return Parsed.cache[text]


def value_of(e, names):
    order = sorted(s.names_of(e))
    return s.compiled([e], order)([names[n] for n in order])[0]


def value_or_none(e, names):
    try:
        return value_of(e, names)
    except (KeyError, ValueError, ZeroDivisionError, OverflowError):
        return None


def brief(m):
    return {k: round(x, 6) for k, x in zip(m.motion.point.w.names, m.z)}


def examine(program, text, values=None):
    """A Report, or None where the reader or the witness does not know the model."""
    return Examination(program, text, values).go()


def main():
    program = Program(sys.argv[1])
    for path in sys.argv[2:]:
        text = open(path, encoding="utf-8").read()
        try:
            r = examine(program, text)
        except (Unread, Lost) as e:
            print(f"{os.path.basename(path)}: not read: {e}")
            continue
        said = [getattr(r, k) for k in ("sim_said", "solve_said") if hasattr(r, k)]
        print(f"{os.path.basename(path)}: {sum(r.compared.values())} compared {dict(r.compared)} {said}")
        for kind, sentence in r.wrong:
            print(f"    {kind}: {sentence}")


if __name__ == "__main__":
    main()
