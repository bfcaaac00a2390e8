#!/usr/bin/env python3
"""Random models: what `solve` says and how `sim` moves are held against an independent reading of the model.

    motions_test.py PROGRAM [SEED [COUNT]] [--all] [--feature a,b] [--scene thrown,wire] [--show]
    motions_test.py PROGRAM --damage     tests the test: damaged answers have to be noticed

A failure prints seed, model and operands, and the smallest model that still fails the same way.  --all switches every
feature on, --feature keeps only models that use one of these, --show prints each model.
"""

import argparse
import os
import re
import subprocess
import sys
from collections import Counter

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
import tap  # noqa: E402
from examine import Program, examine  # noqa: E402
from reader import Unread  # noqa: E402
from scenes import FEATURES, RECIPES, Scene  # noqa: E402
from witness import Lost  # noqa: E402


def failures(program, text):
    """A Report; None where the witness does not know the model."""
    try:
        return examine(program, text)
    except (Unread, Lost):
        return None


def smallest(program, text, kinds):
    """Lines are left out as long as one of the kinds still fails."""
    lines = text.splitlines()
    changed = True
    while changed:
        changed = False
        for k in reversed(range(len(lines))):
            if k >= len(lines):
                continue
            shorter = lines[:k] + lines[k + 1 :]
            try:
                r = failures(program, "\n".join(shorter) + "\n")
            except Exception:  # noqa: BLE001  half a model need not be readable
                continue
            if r and set(r.kinds()) & set(kinds) and not r.refused:
                lines, changed = shorter, True
    return "\n".join(lines) + "\n"


def told(report):
    return "\n".join(f"{k}: {text}" for k, text in report.wrong[:6])


def one(program, seed, options, totals):
    scene = Scene(seed, features_of(options), options.scene and options.scene.split(","))
    if options.feature and not set(options.feature.split(",")) & scene.used:
        return
    text = scene.text()
    if options.show:
        print(text)
    name = f"{scene.recipe}, seed {seed}"
    try:
        r = failures(program, text)
    except subprocess.TimeoutExpired:
        tap.check(name, False, f"no answer within a minute\n{text}")
        return
    except Exception as e:  # noqa: BLE001  a stumble of the witness is shown with its model, and the run goes on
        tap.check(name, False, f"the witness stumbled, {type(e).__name__}: {e}\n{text}")
        return
    if r is None:
        totals["not read"] += 1
        tap.check(name, False, f"the witness cannot read its own model\n{text}")
        return
    totals.update(r.compared)
    totals.update({"declined: " + k: n for k, n in r.refused.items()})
    totals["models"] += 1
    if options.declined and r.refused:
        print(f"# {name} declined: " + "; ".join(getattr(r, k) for k in ("sim_said", "solve_said") if hasattr(r, k)))
    if not r.wrong:
        tap.check(name, True)
        return
    small = smallest(program, text, r.kinds()) if not options.quick else text
    again = failures(program, small) or r
    tap.check(name, False, f"{told(again)}\n--- smallest model\n{small}--- uses {sorted(scene.used)}")


def features_of(options):
    given = {k: True for k in FEATURES} if options.all else dict(FEATURES)
    for k in options.without.split(",") if options.without else ():
        given[k] = False
    return given


# ------------------------------------------------------------------------------------------------ the test of the test
def bend(text):
    """A formula that is wrong by a little."""
    return f"({text})*1.001 + 1/1000"


def damages():
    """By kind of comparison: a function that spoils answers or rows, and tells whether it found any."""
    def values(document):
        return [(i, v) for items in document["answers"].values() for i in items for v in i["values"]]

    def each(select, change):
        def damage(verb, what):
            found = [v for i, v in values(what) if select(i, v)] if verb == "solve" else []
            for v in found:
                change(v)
            return bool(found)
        return damage

    def named(test):
        return lambda i, v: test(v["name"]) and v.get("expr")

    def expr(v):
        v["expr"] = bend(v["expr"])

    def part(v):
        for c in v["components"]:
            c["expr"], c["number"] = bend(c["expr"]), None

    def missing(verb, what):
        hurt = False
        for i in [i for items in what["answers"].values() for i in items] if verb == "solve" else ():
            found = [v for v in i["values"] if v["name"].startswith("equilibrium")]
            if len(found) > 1 and not any(v.get("exists_if") for v in found):
                i["values"].remove(found[0])
                hurt = True
        return hurt

    def equation(verb, what):
        """x'' becomes 1.01 x''."""
        steps = [x for items in what["answers"].values() for i in items for x in i["steps"]] if verb == "solve" else []
        found = [x for x in steps if x.get("kind") == "equation" and "''" in (x.get("text") or "")]
        for x in found:
            x["text"] = re.sub(r"(\w+'')", r"1.01*\1", x["text"])
        return bool(found)

    def dof(verb, what):
        if verb == "solve" and what.get("dof"):
            what["dof"]["dof"] += 1
            return True
        return False

    def column(test, change):
        def damage(verb, rows):
            if verb != "sim":
                return False
            for r in rows[1:]:
                for k in r:
                    if test(k) and isinstance(r[k], float):
                        r[k] = change(r[k])
            return True
        return damage

    bump = lambda x: x * 1.001 + 0.001  # noqa: E731
    return {
        "acceleration": each(named(lambda n: n.endswith("_ddot")), expr),
        "multiplier": each(named(lambda n: n.startswith("lambda_")), expr),
        "expression": each(named(lambda n: n in ("T", "V")), expr),
        "x(t)": each(lambda i, v: "(t)" in i["item"] and v.get("expr"), expr),
        "conserved": each(lambda i, v: v.get("conserved"), lambda v: v.update(expr=f"({v['expr']})*(1 + t/100) + t/100")),
        "energy": each(named(lambda n: n == "E"), lambda v: v.update(expr=f"2*({v['expr']})")),
        "energy missing": each(lambda i, v: v["name"] in ("E", "H"), lambda v: v.update(conserved=False)),
        "force": each(lambda i, v: v["name"] == "Z" and v.get("components"), part),
        "equilibrium": each(lambda i, v: v["name"].startswith("equilibrium"), part),
        "equilibrium missing": missing,
        "equation": equation,
        "dof": dof,
        "where": each(lambda i, v: " where " in i["item"] and v["number"], lambda v: v.update(number=v["number"] * 1.01 + 0.01)),
        "sim acceleration": column(lambda k: k.startswith("acc_"), bump),
        "sim multiplier": column(lambda k: k.startswith("lambda"), bump),
        "sim energy": column(lambda k: k == "T", bump),
        "sim step": column(lambda k: k.endswith("_dot"), bump),
        "constraint kept": column(lambda k: k in ("x", "y", "r", "x1", "phi"), bump),
        "contact kept": column(lambda k: k in ("x", "y", "x1", "z"), lambda x: -x - 3),
    }


# what every run of eighty models and more has to have compared
ALWAYS = ["equation", "acceleration", "multiplier", "expression", "force", "conserved", "energy", "dof", "equilibrium", "x(t)",
          "sim acceleration", "sim multiplier", "sim energy", "sim step", "constraint kept", "event place"]


# scenes in which a kind of comparison is frequent
SCENES_FOR = {"where": ["oscillator"], "contact kept": ["thrown"], "equilibrium": ["oscillator", "rolling", "hoop"],
              "equilibrium missing": ["rolling", "hoop", "cart", "pendulum"], "x(t)": ["oscillator", "chain"]}


def damage_noticed(options):
    """Each kind of comparison notices its damage in most models where it took place."""
    clean = Program(options.program)
    for kind, damage in damages().items():
        hurt, compared, noticed = Program(options.program, damage), 0, 0
        for seed in range(options.seed, options.seed + 80):
            if compared >= 3:
                break
            text = Scene(seed, features_of(options), SCENES_FOR.get(kind)).text()
            before, hurt.hurt = failures(clean, text), 0
            if not before or kind in before.kinds() or not before.compared[kind]:
                continue
            after = failures(hurt, text)
            if hurt.hurt:
                compared += 1
                noticed += after is not None and kind in after.kinds()
        tap.check(f"damage of kind '{kind}' is noticed", compared >= 1 and 2 * noticed >= compared,
                  f"{noticed} of {compared}")


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("program")
    p.add_argument("seed", nargs="?", type=int, default=1)
    p.add_argument("count", nargs="?", type=int, default=60)
    p.add_argument("--all", action="store_true")
    p.add_argument("--feature")
    p.add_argument("--scene")
    p.add_argument("--without", help="features that are switched off")
    p.add_argument("--show", action="store_true")
    p.add_argument("--quick", action="store_true", help="no search for the smallest model")
    p.add_argument("--declined", action="store_true", help="says what the program declined")
    p.add_argument("--damage", action="store_true")
    options = p.parse_args()
    if options.damage:
        damage_noticed(options)
        tap.done()
    totals = Counter()
    program = Program(options.program)
    for seed in range(options.seed, options.seed + options.count):
        one(program, seed, options, totals)
    if options.count >= 80 and not (options.feature or options.scene):
        for kind in ALWAYS:
            tap.check(f"comparisons of kind '{kind}' took place", totals[kind] > 0)
    print("# " + ", ".join(f"{k} {n}" for k, n in sorted(totals.items())))
    tap.done()


if __name__ == "__main__":
    main()
