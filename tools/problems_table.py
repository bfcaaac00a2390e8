#!/usr/bin/env python3
"""Writes docs/problems.md: for each outside problem what pleuel answers beside what its source states.

usage: problems_table.py PLEUEL [--check]      --check compares with the file and prints the difference"""
import os
import sys

from kept_page import ROOT, keep

sys.path[:0] = [os.path.join(ROOT, "tests", "problems"), os.path.join(ROOT, "tests", "founding")]
import problems_test as tests  # noqa: E402
from expected import ENTRIES, NOT_ASKED, At  # noqa: E402

HEAD = """# Outside problems, side by side

Written by `tools/problems_table.py` from the models and answers in `tests/problems/`; the tests compare every line by value at random
points and at the numbers of the source, and compare this page with what the program prints. Left the request and the answer as pleuel prints it,
right the answer of the source in its own symbols. Simulated values are events of `pleuel sim` with the source's numbers.

"""


def cell(text):
    return "`" + text.replace("|", "\\|") + "`"


def printed(program, problem, name, entry):
    if not isinstance(entry, At):
        settings = " ".join(f"--set {s}" for s in entry.set)
        return f"event `{entry.event}`, {cell(entry.ours)} with {cell(settings)}"
    tests_entry = [e for e in problem["expected"] if e["name"] == name]
    if tests_entry:
        tests.check_formula(program, problem, tests_entry[0], entry)
    document = tests.solved(program, problem["id"], entry)
    along = entry.name.partition("@")[2]
    for item in document.items(entry.letter):
        for v in item["values"]:
            if v["name"] != entry.name.partition("@")[0] or not tests.fits(v, entry):
                continue
            expr = tests.component(v, along) if along else v.get("expr")
            if tests_entry and entry.found[0] != expr:
                continue
            text = v.get("text") if not along else expr
            shown = text if text else f"{v['number']:.12g}" if v.get("number") is not None else "-"
            return f"{cell(item['item'])}: {cell(shown)}"
    raise SystemExit(f"{problem['id']} {name}: not found")


def page(program):
    out = [HEAD]
    for problem in tests.PROBLEMS:
        source = problem["source"]
        out.append(f"## {problem['id']}: {problem['title']}\n\nModel: [`tests/problems/{problem['id']}.pleuel`](../tests/problems/"
                   f"{problem['id']}.pleuel). Source: {source['title']}.\n\n| | pleuel | source |\n|---|---|---|\n")
        expected = {e["name"]: e["ascii"] for e in problem["expected"]}
        for name, entry in ENTRIES[problem["id"]].items():
            theirs = expected.get(name) or problem["numeric"][name]["value"]
            out.append(f"| {name} | {printed(program, problem, name, entry)} | {cell(theirs)} |\n")
        for (where, name), why in NOT_ASKED.items():
            if where == problem["id"]:
                out.append(f"| {name} | not asked: {why} | {cell(expected.get(name) or problem['numeric'][name]['value'])} |\n")
        if problem["report"]:
            out.append(f"\nTo be said besides: {problem['report']}\n")
        out.append("\n")
    return "".join(out).rstrip() + "\n"


def main():
    program = os.path.abspath(sys.argv[1])
    return keep("problems.md", page(program))


if __name__ == "__main__":
    sys.exit(main())
