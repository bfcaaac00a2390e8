#!/usr/bin/env python3
"""Twins: a model and its other spellings have the same answers and the same motion.

    twins_test.py PROGRAM [--all] [--kinds renamed,negative] [--show] [MODEL.pleuel...]

Without models: all problems, examples and cases.  A twin that is refused in words is counted and listed, a disagreement
fails.  Kinds: renamed, negative, shifted, scaled, lifted, "lifted, chosen", unchosen, axes.
"""

import argparse
import glob
import math
import os
import re
import subprocess
import sys
from collections import Counter

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402
import symbols as s  # noqa: E402
from examine import Examination, Program, near, parsed, value_of, value_or_none  # noqa: E402
import rest  # noqa: E402
from formulas import NotAFormula  # noqa: E402
from model import Model  # noqa: E402
from reader import Unread, ascii_name  # noqa: E402
from twins import twins_of  # noqa: E402
from witness import Lost  # noqa: E402

sys.setrecursionlimit(100000)
LARGE = {"chain100", "chain10", "fourbar40", "long-pendulum", "pleiades", "fekete", "andrews", "bricard", "chain", "nutation"}
SINGULAR = {"fourbar2", "parallelograms"}    # started where the forces are not determined


class Original:
    """A model with its answers, its states and its rows."""

    def __init__(self, program, text):
        self.text = text
        self.x = Examination(program, text)
        self.model = self.x.model
        self.code, self.document, _ = program.solve(text)
        self.rows, self.sim_code = [], None
        self.simulate(program)
        self.x.read_rows([r for r in self.rows if "acc_" not in r])
        self.x.first = [m for m in self.x.moments if m.phase == 0 and m.motion]
        if len(self.x.first) > 1:
            self.x.first = [m for m in self.x.first if m.motion.labels() == self.x.first[1].motion.labels()]
        self.x.perturb()
        self.moments = (self.x.first[:: max(1, len(self.x.first) // 4)] + self.x.near_by)[:6]
        self.names = [self.x.names_at(m) for m in self.moments]

    def simulate(self, program):
        t0, t1 = self.model.interval or (self.model.start_time, self.model.start_time + 1.0)
        self.flags = ["--dt", repr((t1 - t0) / 40), "--until", repr(t0 + (t1 - t0) / 4)]
        for k, v in self.x.assumed.items():
            self.flags += ["--set", f"{k}={v!r}"]
        self.sim_code, self.run, self.rows, _ = program.simulate(self.text, *self.flags)

    def start(self):
        """Numbers for what carries the motion."""
        if not self.rows:
            return None
        w = self.x.w
        return {k: self.rows[0][k] for q in w.d for k in (q, q + "_dot")}


class Comparison:
    def __init__(self, original, twin, program):
        self.o, self.t = original, twin
        self.wrong, self.counts, self.refused = [], Counter(), []
        self.program = program

    def go(self):
        if self.motion():
            self.answers()
        return self

    def check(self, kind, ok, text):
        self.counts[kind] += 1
        if not ok:
            self.wrong.append(f"{kind}: {text}")

    # -------------------------------------------------------------------------------------------- names
    def twin_names(self, names):
        """The numbers of the twin's names."""
        out = dict(names)
        for old, (new, c) in self.t.changes.items():
            for tail, tail_new in (("", ""), ("_dot", "_dot"), ("_ddot", "_ddot"), ("_0", "_0"), ("_dot_0", "_dot_0")):
                if old + tail in names:
                    shift = c.shift if tail in ("", "_0") else 0.0
                    out[new + tail_new] = (names[old + tail] - shift) / c.scale
            for tail in ("", "_dot", "_ddot"):
                if new != old:
                    out.pop(old + tail, None)
        total = self.o.model.total
        for new, place in self.t.added.items():
            rate = total(place)
            for tail, e in (("", place), ("_dot", rate), ("_ddot", total(rate))):
                if s.names_of(e) <= set(names):
                    out[new + tail] = value_of(e, names)
        return out

    def twin_of(self, name):
        """(name in the twin, scale, shift) of a result."""
        for old, (new, c) in self.t.changes.items():
            if name == old:
                return new, c.scale, c.shift
            if name in (old + "_dot", old + "_ddot"):
                return new + name[len(old):], c.scale, 0.0
            if name == "p_" + old:
                return "p_" + new, 1 / c.scale, 0.0
        return name, 1.0, 0.0

    # -------------------------------------------------------------------------------------------- answers
    def answers(self):
        code, document, err = self.program.solve(self.t.text)
        a, b = self.o.document, document
        if b is None:
            self.wrong.append(f"exit {code}, no document: {err[:200]}")
            return
        good = ("ok", "expect_failed", "no_closed_form")
        if b["status"] not in good:
            if a["status"] in good:
                said = [n["text"] for n in b.get("notes", []) if n.get("severity") == "error"]
                self.refused.append(f"{b['status']}: {b.get('message') or said[:1]}")
            return
        if a["status"] not in good:
            self.refused.append(f"the original: {a['status']}")
            return
        bad = [c["name"] for c in b["checks"] if not c["passed"]]
        if bad and all(c["passed"] for c in a["checks"]):
            self.wrong.append(f"checks of the twin fail: {bad}")
        self.believe(a, b)
        self.dof(a.get("dof"), b.get("dof"))
        if self.t.kind == "unchosen" and self.t.dropped:
            return self.by_item(a, b)
        for letter, items in a["answers"].items():
            for i, j in zip(items, b["answers"].get(letter, [])):
                self.item(i, j)

    def believe(self, a, b):
        """Only states where both say that their assumptions hold."""
        mine, x = self.o.x.read_assumptions(a.get("assumptions", [])), self.o.x
        other = Examination(self.program, self.t.text).read_assumptions(b.get("assumptions", []))
        self.names = []
        for names in self.o.names:
            twin = self.twin_names(names)
            good = all(holds(e, names) for e in mine) and all(holds(e, twin) for e in other)
            self.names += [names] if good else []

    def by_item(self, a, b):
        """Requests that are left, found by their text."""
        mine = {i["item"]: i for items in a["answers"].values() for i in items}
        for items in b["answers"].values():
            for j in items:
                if j["item"] in mine:
                    self.item(mine[j["item"]], j)

    def dof(self, a, b):
        if a and b and a.get("dof") is not None and b.get("dof") is not None:
            self.check("dof", a["dof"] == b["dof"] and a["velocity_dof"] == b["velocity_dof"],
                       f"{a['dof']} and {b['dof']}")

    def item(self, i, j):
        mine, other = i["values"], j["values"]
        if mine and not other:
            said = " ".join(str(x.get("text")) for x in j.get("steps", []))
            self.refused.append(f"{i['item']}: {said[:140]}")
            return
        if re.match(r"equilibria\s*$", i["item"]):
            return self.equilibria(i, j)
        if any(v.get("branch") for v in mine + other):
            return
        by_name = {}
        for v in other:
            by_name.setdefault((v["name"], v.get("of"), v.get("on"), v.get("at")), []).append(v)
        for v in mine:
            if self.proposed(v):
                self.counts["proposed coordinate"] += 1
                continue
            name, scale, shift = self.twin_of(v["name"])
            found = by_name.get((name, v.get("of"), v.get("on"), v.get("at")))
            if not found:
                continue
            w = found.pop(0)
            if v.get("components") and v["name"] == "Z":
                self.force(i["item"], v, w)
            elif v.get("passed") is not None or w.get("passed") is not None:
                self.check("expect", v.get("passed") == w.get("passed"), f"{i['item']}: {v.get('passed')}, {w.get('passed')}")
            elif v.get("expr") and w.get("expr"):
                self.value(i["item"], v, w, scale, shift)

    def proposed(self, value):
        """About a coordinate that the program added: the twin may take another one."""
        word = re.sub(r"_d?dot$", "", value["name"].removeprefix("p_"))
        return word != value["name"] and word not in self.o.model.coords

    def number(self, value, names):
        try:
            names = dict(names)
            for k, text in value.get("where", {}).items():
                names[k] = parsed(text).value(names)
            x = parsed(value["expr"]).value(names)
            return float(x) if not isinstance(x, complex) and x == x else None
        except (NotAFormula, ValueError, ZeroDivisionError, OverflowError, TypeError):
            return None

    def value(self, item, v, w, scale, shift):
        pairs = []
        for names in self.names:
            x, y = self.number(v, names), self.number(w, self.twin_names(names))
            if x is not None and y is not None:
                pairs.append((x, y * scale + shift))
        if not pairs and v.get("number") is not None and w.get("number") is not None:
            pairs = [(v["number"], w["number"] * scale + shift)]
        if not pairs:
            self.counts["no number"] += 1
            return
        constant = pairs[0][0] - pairs[0][1] if v["name"] in ("E", "H", "V", "L") and len(pairs) > 1 else 0.0
        size = max([abs(x) for p in pairs for x in p if abs(x) < math.inf] + [1e-2])
        worst = max((abs(x - y - constant) if x != y else 0.0) for x, y in pairs)
        self.check("value", worst <= 1e-6 * size, (
            f"{item}: {v['name']} = {v['expr'][:200]} is {pairs[0][0]}, in the twin {w['name']} = {w['expr'][:200]} "
            f"means {pairs[0][1]}"))

    def force(self, item, v, w):
        if len(v["components"]) != len(w["components"]):
            self.counts["force in other directions"] += 1      # said in words
            return
        for names in self.names:
            twin = self.twin_names(names)
            a = [self.number({**v, **c}, names) for c in v["components"]]
            b = [self.number({**w, **c}, twin) for c in w["components"]]
            if None in a or None in b:
                continue
            x, y = (math.sqrt(sum(k * k for k in z)) for z in (a, b))
            self.check("force", near(x, y, 1.0, 1e-6), f"{item} on {v.get('on')}: its size is {x}, in the twin {y}")
            return

    def equilibria(self, i, j):
        """The same places of the masses, as far as a list claims to be whole."""
        a, b = self.places(i, False), self.places(j, True)
        if a is None or b is None:
            self.counts["equilibria in other coordinates"] += 1
            return
        for one, two, whose, item in ((a, b, "the twin", j), (b, a, "the original", i)):
            if not whole(item):
                continue
            for p in one:
                ok = any(all(abs(x - y) < 1e-5 for x, y in zip(p[0], q[0])) or all(
                    abs(math.remainder(p[1][k] - q[1][k], 2 * math.pi)) < 1e-6 for k in p[1] if k in q[1]) for q in two)
                self.check("equilibrium", ok, f"masses at rest at {p} are missing in {whose}: {two}")

    def places(self, item, twin):
        """Where the masses are at each position of rest; None where coordinates stay free or unknown."""
        w, out = self.o.x.w, []
        if not self.o.moments or self.t.kind == "unchosen":
            return None
        back = {new: (old, c) for old, (new, c) in self.t.changes.items()} if twin else {}
        for v in item["values"]:
            if not v["name"].startswith("equilibrium") or v.get("exists_if") and not rest.holds(self.o.x, v["exists_if"]):
                continue
            place = {}
            for c in v.get("components", []):
                name, x = ascii_name(c["along"]), self.number(c, self.o.x.numbers())
                old, change = back.get(name, (name, None))
                place[old] = x if change is None or x is None else change.scale * x + change.shift
            if v.get("free") or None in place.values() or not set(place) <= set(w.q):
                return None
            q = [place.get(k, x) for k, x in zip(w.q, self.o.moments[0].q)]
            q = rest.completed(w, q, list(place), list(range(len(w.rows))))
            if q is None:
                return None
            points = [x for _, where in self.o.model.masses.values() for x in where] or [s.name(k) for k in w.q]
            out.append((s.compiled(points, w.names)(w.state(q, [0.0] * w.n, 0.0)), place))
        return out

    # -------------------------------------------------------------------------------------------- motion
    def motion(self):
        """Rows; false where the two start in different states, because `init` leaves that open."""
        if not self.o.rows or self.o.sim_code != 0:
            return True
        code, _, rows, err = self.program.simulate(self.t.text, *self.o.flags)
        if code != 0 or not rows:
            self.refused.append(f"sim {code}: {err.strip().splitlines()[:1]}")
            return True
        if not self.same_start(rows[0]):
            self.counts["start not given"] += 1
            return False
        mine = {r["t"]: r for r in self.o.rows}
        for r in rows:
            a = mine.get(r["t"])
            if a:
                self.row(a, r)
        return True

    def same_start(self, b):
        """Where `init` leaves something open, the spelling may decide it."""
        given = {n for n, _ in self.o.model.init}
        if all(q in given for q in self.o.x.w.d):
            return True
        a = self.o.rows[0]
        for q in self.o.x.w.d:
            for tail in ("", "_dot"):
                new, scale, shift = self.twin_of(q + tail)
                if not near(b.get(new, math.nan) * scale + shift, a[q + tail], 1.0, 1e-9):
                    return False
        return True

    def row(self, a, b):
        coords = [q for q in self.o.model.coords if q not in self.t.dropped]
        size = max([abs(a[q + "_dot"]) for q in coords] + [1.0])
        for q in coords:
            for tail in ("", "_dot"):
                new, scale, shift = self.twin_of(q + tail)
                got = b.get(new)
                if got is None or a[q + tail] != a[q + tail] or got != got:
                    continue
                got = got * scale + shift
                self.check("row", near(got, a[q + tail], size, 1e-5),
                           f"{q + tail} at t = {a['t']} is {a[q + tail]}, in the twin {got}")
        for k, x in a.items():
            if k.startswith("lambda") and isinstance(x, float) and isinstance(b.get(k), float) and x == x and b[k] == b[k]:
                self.check("row", near(x, b[k], size, 1e-5), f"{k} at t = {a['t']} is {x}, in the twin {b[k]}")


def holds(e, names):
    x = value_or_none(e, names)
    return x is None or x >= -1e-9


def whole(item):
    said = " ".join(str(x.get("text")) for x in item.get("steps", []))
    return not re.search(r"may be others|closed form|name them|sought|Only places|look", said)


def models(paths):
    if paths:
        return paths
    top = os.path.join(HERE, "..", "..")
    found = sorted(glob.glob(os.path.join(top, "tests", "problems", "P*.pleuel"))
                   + glob.glob(os.path.join(top, "examples", "*.pleuel")) + glob.glob(os.path.join(top, "tests", "cases", "*.pleuel")))
    return [f for f in found if os.path.basename(f)[:-7] not in LARGE | SINGULAR]


# Disagreements that are known; they are shown and do not fail.
KNOWN = {}


def known(name, kind):
    return KNOWN.get((name, kind)) or KNOWN.get((name, "")) or KNOWN.get(("", kind))


def three(twins, name):
    """The renamed twin, and two more that hang on the name."""
    rest_ = sorted(twins[1:], key=lambda t: (hash_of(name + t.kind)))
    return twins[:1] + rest_[:2]


def hash_of(text):
    return sum(ord(c) * 31**k for k, c in enumerate(text)) % 1009


def compare(program, path, options, totals):
    name = os.path.basename(path)[:-7]
    with open(path, encoding="utf-8") as f:
        text = f.read()
    try:
        original = Original(program, text)
        twins = twins_of(text, name, original.start())
    except (Unread, Lost) as e:
        totals["not read"] += 1
        print(f"# {name}: not read: {e}")
        return
    if options.kinds:
        twins = [t for t in twins if t.kind in options.kinds.split(",")]
    for twin in twins if options.all or options.kinds else three(twins, name):
        if options.show:
            print(f"# ---- {name}, {twin.kind}\n{twin.text}")
        try:
            c = Comparison(original, twin, program).go()
        except subprocess.TimeoutExpired:
            tap.check(f"{name}, {twin.kind}", False, "no answer within a minute")
            continue
        totals.update(c.counts)
        totals["twins"] += 1
        for r in c.refused:
            totals["refused"] += 1
            print(f"# refused: {name}, {twin.kind}: {r}")
        why = known(name, twin.kind)
        if c.wrong and why:
            tap.skip(f"{name}, {twin.kind}", why)
            totals["known"] += 1
            continue
        tap.check(f"{name}, {twin.kind}", not c.wrong, "\n".join(c.wrong[:5]) + f"\n{twin.text}")


def bend(verb, what):
    """Each formula of the twin is wrong by a little."""
    if verb == "solve":
        for v in [v for items in what["answers"].values() for i in items for v in i["values"]]:
            for part in [v] + v.get("components", []):
                if part.get("expr"):
                    part["expr"] = f"({part['expr']})*1.001 + 1/1000"


def damage_noticed(program, path):
    """A twin with another weight moves otherwise; a twin with bent formulas answers otherwise."""
    name = os.path.basename(path)[:-7]
    with open(path, encoding="utf-8") as f:
        text = f.read()
    clean, bent = Program(program), Program(program, bend)
    original = Original(clean, text)
    for twin in three(twins_of(text, name, original.start()), name):
        right = Comparison(original, twin, clean).go()
        tap.check(f"{name}, {twin.kind}: bent formulas are noticed",
                  not right.counts["value"] or Comparison(original, twin, bent).go().wrong)
        twin.text = twin.text.replace("g = 9.81", "g = 9.82")
        tap.check(f"{name}, {twin.kind}: another weight is noticed",
                  not right.counts["row"] or Comparison(original, twin, clean).go().wrong)


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("program")
    p.add_argument("models", nargs="*")
    p.add_argument("--kinds")
    p.add_argument("--all", action="store_true", help="every kind, not three of them")
    p.add_argument("--show", action="store_true")
    p.add_argument("--damage", action="store_true", help="tests the test: damaged twins have to be noticed")
    options = p.parse_args()
    if options.damage:
        for name in ("problems/P01", "problems/P52", "problems/P21", "cases/pendulum"):
            damage_noticed(options.program, os.path.join(HERE, "..", name + ".pleuel"))
        tap.done()
    totals = Counter()
    program = Program(options.program)
    for path in models(options.models):
        compare(program, path, options, totals)
    print("# " + ", ".join(f"{k} {n}" for k, n in sorted(totals.items())))
    tap.done()


if __name__ == "__main__":
    main()
