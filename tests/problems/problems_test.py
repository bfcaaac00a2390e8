#!/usr/bin/env python3
"""Outside problems: every answer of the sources (answers.json), compared by value at random points and at the source's numbers."""

import functools
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "founding"))
from sheet import *  # noqa: E402
from sheet import json, subprocess  # noqa: E402
from expected import ALIAS, ENTRIES, FREEDOM, NOT_ASKED, At  # noqa: E402
from reports import REPORTS  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
POINTS, LEAST = 16, 8
SPREAD = 0.25        # random points: the source's numbers, each changed by up to this part
test = Tests()

with open(os.path.join(HERE, "answers.json"), encoding="utf-8") as f:
    PROBLEMS = json.load(f)


def model_of(name):
    return os.path.join(HERE, name + ".pleuel")


def flags_of(settings):
    return [f for s in settings for f in ("--set", s)]


def solved(program, problem, entry=None):
    name = entry.model if entry is not None and entry.model else problem
    return run(program, model_of(name), "--no-simulation", *flags_of(entry.set if entry is not None else ()))


@functools.lru_cache(maxsize=None)
def simulated(program, model, settings):
    done = subprocess.run([program, "sim", "--json", *flags_of(settings), model_of(model)], capture_output=True, timeout=60)
    return json.loads(done.stdout.decode("utf-8"))


# ------------------------------------------------------------------------------------------------ points
def number(x):
    return float(x)


def points(problem, rng):
    """The source's numbers first, then random ones around them."""
    yield dict(problem["at"], pi=math.pi)
    for _ in range(POINTS):
        p = {k: number(v) * rng.uniform(1 - SPREAD, 1 + SPREAD) for k, v in problem["at"].items()}
        yield dict(p, pi=math.pi)


class Extra:
    """Names of the model that the source does not have: the same random number wherever they are met."""

    def __init__(self, rng):
        self.rng, self.kept = rng, {}

    def __call__(self, name):
        return self.kept.setdefault(name, self.rng.uniform(0.3, 1.1))


def ours_at(text, where, entry, p, extra):
    names = {"pi": math.pi}
    for name in Formula(text).names.union(*[Formula(w).names for w in where.values()]) - set(where):
        if name in entry.names:
            names[name] = Formula(entry.names[name]).value(p)
        elif name in p:
            names[name] = p[name]
        elif ALIAS.get(name) in p:
            names[name] = p[ALIAS[name]]
        else:
            names[name] = extra(name)
    for name, expr in where.items():
        names[name] = Formula(expr).value(names)
    return Formula(text).value(names)


def theirs_at(program, problem, expected, p, extra):
    """The source's formula; what it leaves to another formula of the source, or to an acceleration, is put in."""
    p = dict(p)
    for name, expr in expected.get("on", {}).items():
        p[name] = Formula(expr).value(p)
    for name in Formula(expected["ascii"]).names - set(p):
        other = [e for e in problem["expected"] if e["name"] == name]
        if other:
            p[name] = theirs_at(program, problem, other[0], p, extra)
        elif name.endswith("dd"):
            value = solved(program, problem["id"]).value(name[:-2] + "_ddot")
            p[name] = ours_at(value["expr"], value.get("where", {}), ENTRIES[problem["id"]]["phidd"], p, extra)
        else:
            raise Failure(f"the source does not explain {name}")
    return Formula(expected["ascii"]).value(p)


# ------------------------------------------------------------------------------------------------ values
def fits(value, entry):
    return all(want is None or value.get(key) == want for key, want in (("of", entry.of), ("at", entry.at), ("branch", entry.branch)))


def candidates(program, problem, entry):
    """(expr or None, number, where) of every value that the entry may mean."""
    name, _, along = entry.name.partition("@")
    for v in solved(program, problem, entry).values(name, entry.letter):
        if not fits(v, entry):
            continue
        if along:
            yield component(v, along), None, v.get("where", {})
        else:
            yield v.get("expr"), v.get("number"), v.get("where", {})


def in_full(program, problem, entry, expr, where, p, extra):
    value = ours_at(expr, where, entry, p, extra)
    if entry.ours == "value":
        return value
    names = dict(p, value=value)
    for other, e in ENTRIES[problem["id"]].items():
        if other in Formula(entry.ours).names:
            expr, where = e.found
            names[other] = ours_at(expr, where, e, p, extra)
    for name in Formula(entry.ours).names - set(names):
        names[name] = p[ALIAS[name]] if ALIAS.get(name) in p else extra(name)
    return Formula(entry.ours).value(names)


def agrees(program, problem, expected, entry, expr, where, numeric):
    rng = random.Random(7)
    tried = 0
    for i, p in enumerate(points(problem, rng)):
        extra = Extra(rng)
        try:
            ours, theirs = in_full(program, problem, entry, expr, where, p, extra), theirs_at(program, problem, expected, p, extra)
        except (ValueError, ZeroDivisionError, OverflowError):
            continue   # outside the domain of the formulas
        if isinstance(ours, complex) or isinstance(theirs, complex):
            continue
        if not close(ours, theirs, 1e-9, 1e-4):
            return f"{ours!r} instead of {theirs!r} at {shown(p, set(p))}"
        if i == 0 and numeric is not None and not close(ours, number(numeric), 1e-9, 1e-4):
            return f"{ours!r} instead of {numeric} at the numbers of the source"
        tried += 1
    return None if tried >= LEAST else f"only {tried} points lie in the domain"


def shown(point, names):
    return ", ".join(f"{k} = {point[k]:.6g}" for k in sorted(names) if k in point)


def check_formula(program, problem, expected, entry):
    numeric = problem["numeric"].get(expected["name"], {}).get("value")
    found = [c for c in candidates(program, problem["id"], entry) if c[0] is not None]
    need(found, f"no value {entry.name} under {entry.letter}")
    reasons = []
    for expr, _, where in found:
        reason = agrees(program, problem, expected, entry, expr, where, numeric)
        if reason is None:
            entry.found = (expr, where)
            return
        reasons.append(f"{expr}: {reason}")
    raise Failure("; ".join(reasons)[:600])


def check_number(program, problem, name, entry):
    """A number without formula: that of the value, with the source's numbers set, or of the formula there."""
    want = number(problem["numeric"][name]["value"])
    got = []
    for expr, n, where in candidates(program, problem["id"], entry):
        value = n
        if expr is not None:
            value = ours_at(expr, where, entry, dict(problem["at"], pi=math.pi), Extra(random.Random(7))) if not entry.set else n
        if value is None:
            continue
        got.append(Formula(entry.ours).value({"value": value, "pi": math.pi}))
    need(any(close(g, want, 1e-9, 1e-12) for g in got), f"{got} instead of {want}")


def check_event(program, problem, name, entry):
    document = simulated(program, entry.model or problem["id"], tuple(entry.set))
    events = [e for e in document["events"] if entry.event in (e.get("label"), e.get("of"))]
    need(len(events) > (1 if entry.after else 0), f"no event {entry.event}: {document.get('status')}")
    e = events[1] if entry.after else events[0]
    names = dict(e.get("state", {}), t=e["t"] - (events[0]["t"] if entry.after else 0), pi=math.pi)
    got, want = Formula(entry.ours).value(names), number(problem["numeric"][name]["value"])
    need(close(got, want, entry.relative, 1e-12), f"{got!r} instead of {want!r}")


# ------------------------------------------------------------------------------------------------ tests
@test("every answer of the sources is compared, or stands with the reason why not")
def _(program):
    for problem in PROBLEMS:
        names = {e["name"] for e in problem["expected"]} | set(problem["numeric"])
        entries = ENTRIES.get(problem["id"], {})
        missing = [n for n in sorted(names) if n not in entries and (problem["id"], n) not in NOT_ASKED]
        need(not missing, f"{problem['id']}: nothing compares {missing}")
        need(not set(entries) - names, f"{problem['id']}: the source has no {set(entries) - names}")
        need(not problem["report"] or problem["id"] in REPORTS, f"{problem['id']}: nothing compares the report: {problem['report']}")
    for key in NOT_ASKED:
        need(key[1] not in ENTRIES[key[0]], f"{key} is compared")


def declare(problem, name, entry):
    expected = [e for e in problem["expected"] if e["name"] == name]
    what = expected[0]["ascii"][:60] if expected else problem["numeric"][name]["value"]

    @test(f"{problem['id']}: {name} = {what}")
    def _(program):
        if not isinstance(entry, At):
            check_event(program, problem, name, entry)
        elif expected:
            check_formula(program, problem, expected[0], entry)
        else:
            check_number(program, problem, name, entry)


def declare_whole(problem):
    @test(f"{problem['id']}, {problem['title']}: own checks pass, degrees of freedom as counted")
    def _(program):
        answer = solved(program, problem["id"])
        need(all(c["passed"] for c in answer.document["checks"]), f"own checks failed: {answer.document['checks']}")
        need(answer.exit_code == 0, f"exit code {answer.exit_code}")
        if problem["id"] in FREEDOM:
            dof = answer.document["dof"]
            need((dof["dof"], dof["velocity_dof"]) == FREEDOM[problem["id"]], f"{dof}")


def declare_report(problem):
    for sentence, check in REPORTS[problem["id"]]:
        @test(f"{problem['id']}, report: {sentence}")
        def _(program, check=check):
            check(lambda name=problem["id"], *flags: run(program, model_of(name), *flags))


def declare_page(tool, page):
    @test(f"{page} shows what the program prints now")
    def _(program):
        done = subprocess.run([sys.executable, os.path.join(HERE, "..", "..", "tools", tool), program, "--check"], capture_output=True, timeout=120)
        need(done.returncode == 0, (done.stdout + done.stderr).decode("utf-8")[:1500])


declare_page("problems_table.py", "docs/problems.md")
declare_page("errors_page.py", "docs/errors-in-print.md")
for problem in PROBLEMS:
    declare_whole(problem)
    for name, entry in ENTRIES.get(problem["id"], {}).items():
        declare(problem, name, entry)
    if problem["id"] in REPORTS:
        declare_report(problem)

if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
