#!/usr/bin/env python3
"""Outside problems: every answer of the sources that the models ask for, compared at random points."""

import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "founding"))
from sheet import *  # noqa: E402
from expected import ALIAS, FREEDOM, PROBLEMS  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
POINTS = 12
test = Tests()
answers = {}


def answer_of(program, problem):
    if problem not in answers:
        answers[problem] = run(program, os.path.join(HERE, problem + ".pleuel"))
    return answers[problem]


def point(rng, names, parameters):
    """Parameters near their numbers, everything else in a range where roots are real and angles acute."""
    p = {"pi": math.pi}
    for name in sorted(names):
        given = parameters.get(name)
        p[name] = given * rng.uniform(0.97, 1.03) if given else rng.uniform(0.3, 1.1)
    for theirs, ours in ALIAS.items():
        if ours in p:
            p[theirs] = p[ours]
    return p


def agree(expr, where, source, parameters):
    ours, theirs = Formula(expr), Formula(source)
    names = ours.names | {ALIAS.get(n, n) for n in theirs.names}
    for w in where.values():
        names |= Formula(w).names
    rng = random.Random(7)
    for _ in range(POINTS):
        p = point(rng, names - set(where), parameters)
        p = bind({"where": where}, p)
        if not close(ours.value(p), theirs.value(p), 1e-9, 1e-9):
            return False
    return True


def candidates(answer, letter, name):
    name, _, along = name.partition("@")
    for value in answer.values(name, letter or None):
        where = value.get("where", {})
        if along:
            yield component(value, along), where
        elif value.get("expr") is not None:
            yield value["expr"], where


def declare(problem, letter, name, source):
    @test(f"{problem}: {name} = {source[:60]}")
    def _(program):
        answer = answer_of(program, problem)
        found = list(candidates(answer, letter, name))
        need(found, f"no value {name} under {letter or 'any letter'}")
        need(any(agree(e, w, source, answer.parameters()) for e, w in found), f"{name} is {found[0][0]}, the source has {source}")


def declare_whole(problem, what):
    @test(f"{problem}, {what}: own checks pass, degrees of freedom as counted")
    def _(program):
        answer = answer_of(program, problem)
        checks_pass(answer)
        if problem in FREEDOM:
            need(answer.document["dof"]["dof"] == FREEDOM[problem], f"{answer.document['dof']}")


for problem, what, _, entries in PROBLEMS:
    declare_whole(problem, what)
    for letter, name, source in entries:
        declare(problem, letter, name, source)

if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
