#!/usr/bin/env python3
"""Every document that pleuel writes about these models: keys and types, formulas that parse, MathML that is XML, TeX whose
braces close, numbers that are what their formulas give at the parameters of the model."""

import glob
import os
import sys
import xml.etree.ElementTree as ElementTree

from sheet import *

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = sorted(glob.glob(os.path.join(HERE, "*.pleuel"))) + [example(n) for n in ("atwood.pleuel", "crank.pleuel", "ski.pleuel")]
KEYS = ["pleuel", "file", "system", "coords", "parameters", "constraints", "dof", "answers", "checks", "assumptions", "notes", "status"]

test = Tests()


def every(program, look):
    for model in MODELS:
        answer = run(program, model)
        for item in answer.items():
            for value in item["values"]:
                look(os.path.basename(model), item, value, answer)


def formulas_of(value):
    for key in ("expr", "lhs", "got"):
        if value.get(key) is not None:
            yield value[key]
    for c in value.get("components", []):
        yield c["expr"]


@test("the keys of the contract, in its order")
def _(program):
    for model in MODELS:
        keys = [k for k in run(program, model).document if k in KEYS]
        need(keys == KEYS, f"{model}: {keys}")


@test("all formulas parse, and know all their names")
def _(program):
    def look(model, item, value, answer):
        known = set(answer.document["parameters"]) | set(value.get("where", {})) | {"t", "E"}
        for c in answer.document["coords"]:
            known |= {c, c + "_dot", c + "_ddot", c + "_0", c + "_dot_0"}
        known |= {"lambda_" + c["label"] for c in answer.document["constraints"]}
        for text in formulas_of(value):
            unknown = Formula(text).names - known
            small = item["item"].startswith("series")   # a series may bring its own small name
            need(not unknown or small, f"{model}, {item['item']}: {text} speaks of {unknown}")
    every(program, look)


@test("numbers are what the formulas give at the parameters")
def _(program):
    def look(model, item, value, answer):
        if value.get("expr") is None or value["number"] is None:
            return
        got = Formula(value["expr"]).value(bind(value, answer.parameters()))
        need(close(got, value["number"], 1e-12), f"{model}, {item['item']}: {value['expr']} is {got!r}, not {value['number']!r}")
    every(program, look)


@test("MathML is well-formed XML")
def _(program):
    seen = []

    def look(model, item, value, answer):
        if "mathml" in value:
            seen.append(ElementTree.fromstring(value["mathml"]).tag)
    every(program, look)
    need(len(seen) > 40 and set(seen) == {"math"}, f"{len(seen)} formulas, {set(seen)}")


@test("TeX: braces close, no bare Unicode letters of the model, left and right come in pairs")
def _(program):
    def look(model, item, value, answer):
        tex = value.get("tex")
        if tex is None:
            return
        bare = tex.replace("\\{", "").replace("\\}", "")
        need(bare.count("{") == bare.count("}"), f"{model}: {tex}")
        need(bare.count("\\left") == bare.count("\\right") + bare.count("\\leftarrow") - bare.count("\\rightarrow"), f"{model}: {tex}")
        need(all(ord(c) < 0x80 for c in tex), f"{model}: {tex} is not ASCII")
    every(program, look)


@test("equations are numbered from 1 without gaps, and refer to earlier ones")
def _(program):
    for model in MODELS:
        last = 0
        for item in run(program, model).items():
            for step in item["steps"]:
                if "number" in step:
                    need(step["number"] == last + 1, f"{model}: ({step['number']}) after ({last})")
                    last += 1
                need(all(r <= last for r in step["refs"]), f"{model}: refers to {step['refs']} before ({last})")


@test("a wrong text gives a document of the same shape, and exit code 3")
def _(program):
    path = os.path.join(HERE, "wrong.txt")
    a = run(program, path)
    need(a.exit_code == 3 and a.document["status"] == "model_error", f"exit {a.exit_code}, status {a.document['status']}")
    errors = [n for n in a.document["notes"] if n["severity"] == "error"]
    need(errors and errors[0]["code"] == "E011" and errors[0]["line"] == 4, f"notes: {a.document['notes']}")
    need([k for k in a.document if k in KEYS] == KEYS and a.document["answers"] == {}, f"keys: {list(a.document)}")


@test("a file that is not there gives a document too, and exit code 7")
def _(program):
    a = run(program, os.path.join(HERE, "no-such-file.pleuel"))
    need(a.exit_code == 7 and a.document["status"] == "file", f"exit {a.exit_code}, status {a.document['status']}")


@test("--only keeps the letters that were asked for")
def _(program):
    a = run(program, example("atwood.pleuel"), "--only", "c,e")
    need(set(a.document["answers"]) == {"c", "e"}, f"letters: {set(a.document['answers'])}")


@test("times are given only when they are asked for")
def _(program):
    need(run(program, example("ski.pleuel")).document["timing_ms"] == {}, "times without --timing")
    need(run(program, example("ski.pleuel"), "--timing").document["timing_ms"], "no times with --timing")


if __name__ == "__main__":
    sys.exit(test.main(program_of(sys.argv)))
