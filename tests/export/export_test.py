#!/usr/bin/env python3
"""Exported formulas mean what the JSON document says.  Usage: export_test.py PLEUEL

Every formula of every model is evaluated at a random point three times: as `expr` of the JSON document by the reader of
tests/founding/formulas.py, as exported by the program it was exported for, and from the tree of the JSON export.  SymPy,
NumPy and Maxima are used where they are installed.  What is written for Julia and Mathematica is read by the same small reader after
its spelling was translated back; the programs themselves are not asked.
"""
import ast
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(here.parent / "cli"), str(here.parent / "founding"), str(here.parent / "laws")]
import formulas  # noqa: E402
from formulas import FUNCTIONS, NotAFormula, close  # noqa: E402
from mechanics import System  # noqa: E402
from tap import check, done, skip  # noqa: E402

program = os.path.abspath(sys.argv[1])
root = here.parent.parent
seed = int(os.environ.get("PLEUEL_SEED", 20251))
print(f"# seed {seed}")
# caraxis has formulas of some hundred thousand letters, which take SymPy and Maxima minutes
models = [here / "names.pleuel", *(p for p in sorted((root / "examples").glob("*.pleuel")) if p.stem != "caraxis"),
          *sorted((root / "tests/problems").glob("*.pleuel"))]
RANDOM_SYSTEMS = 8
PYTHONS = [sys.executable, "/usr/bin/python3"]
work = tempfile.TemporaryDirectory(prefix="pleuel export ")


def random_system(k):
    """A system of the law tests, with accelerations, forces, multipliers and energies."""
    system = System(seed % 10**6 + k, dimension=2)
    asked = system.accelerations_asked() + system.forces_asked() + ["ask conserved, lagrangian, lagrange2"]
    path = pathlib.Path(work.name) / f"random {system.seed}.pleuel"
    path.write_text(system.chosen_model(extra=asked), encoding="utf-8")
    return path


models += [random_system(k) for k in range(RANDOM_SYSTEMS)]


def run(*arguments):
    r = subprocess.run([program, *map(str, arguments)], capture_output=True, timeout=120)
    return r.returncode, r.stdout.decode(), r.stderr.decode()


# ------------------------------------------------------------------------------------------------ what is expected
def Formula(text):
    """if(a > 0, b, c) of the document is if(a, b, c) of the reader."""
    return formulas.Formula(text.replace(" > 0, ", ", "))


def expected_entries(document):
    """key -> expr, by the rule of docs/cli.md."""
    entries = {}

    def put(key, expr):
        k, name = 1, key
        while name in entries:
            k += 1
            name = f"{key} ({k})"
        entries[name] = expr

    for letter, sections in document["answers"].items():
        for value in (v for s in sections for v in s["values"]):
            for c in [None, *value.get("components", [])]:
                key = letter + " " + value["name"]
                for word in ("of", "on", "at"):
                    key += f" {word} {value[word]}" if value.get(word) else ""
                key += f" along {c['along']}" if c else ""
                key += f" if {value['branch']}" if value.get("branch") else ""
                expr = c.get("expr") if c else value.get("expr")
                if expr is not None:
                    put(key, expr)
                left = None if c else value.get("lhs")
                if left and not re.fullmatch(r"\w+", left):
                    put(key + ", left side", left)
    return entries


def abbreviations_of(document):
    found = {}
    for sections in document["answers"].values():
        for value in (v for s in sections for v in s["values"]):
            found.update(value.get("where", {}))
    return found


class Case:
    """A model, its formulas, and a point for each at which it has a value."""

    def __init__(self, path, dice):
        self.path, self.name = path, path.parent.name + "/" + path.stem
        code, out, err = run("solve", "--json", "--no-simulation", path)
        self.document = json.loads(out)
        self.code = code
        self.lets = abbreviations_of(self.document)
        self.entries = expected_entries(self.document)
        self.signs = signs_of(run("export", path, "--to", "sympy")[1])
        self.points, self.values = {}, {}
        for key, expr in self.entries.items():
            self.find_point(key, Formula(expr), dice)

    def find_point(self, key, formula, dice):
        lets = {k: Formula(v) for k, v in self.lets.items()}
        names = set(formula.names).union(*(f.names for f in lets.values())) - set(lets)
        for attempt in range(200):
            sign = {"positive": 1, "nonnegative": 1, "negative": -1, "nonpositive": -1}
            point = {n: dice.uniform(0.2, 1.8) * sign.get(self.signs.get(n), 1 if attempt % 2 else dice.choice([-1, 1])) for n in names}
            try:
                full = dict(point)
                for k, f in lets.items():
                    full[k] = f.value(full)
                value = formula.value(full)
            except (ValueError, ZeroDivisionError, OverflowError, TypeError):   # complex numbers have no order
                continue
            if isinstance(value, complex) or value != value:
                continue
            self.points[key], self.values[key] = point, value
            return


def signs_of(sympy_text):
    return dict(re.findall(r'sp\.\w+\("(\w+)", (\w+)=True', sympy_text))


dice = random.Random(seed)
cases = [Case(p, dice) for p in models]
n_entries = sum(len(c.entries) for c in cases)
n_points = sum(len(c.points) for c in cases)
check("every model solves", all(c.code == 0 for c in cases), [(c.name, c.code) for c in cases if c.code != 0])
check(f"there are formulas with values: {n_points} of {n_entries}", n_points >= 200 and n_points >= 0.97 * n_entries,
      [(c.name, k) for c in cases for k in c.entries if k not in c.points])


def compare(what, got):
    """got: case name -> key -> number or text of a failure"""
    for case in cases:
        answers = got.get(case.name, {})
        wrong = [f"{k}: {case.entries[k]} is {case.values[k]}, got {answers.get(k)} at {case.points[k]}" for k in case.points
                 if not (isinstance(answers.get(k), (int, float)) and close(float(answers[k]), case.values[k], 1e-8))]
        check(f"{what}: {case.name}, {len(case.points)} formulas", not wrong, "\n".join(wrong))


def export(case, target):
    path = pathlib.Path(work.name) / f"{case.name.replace('/', '_')}.{'mac' if target == 'maxima' else target}"   # Maxima looks at it
    code, out, err = run("export", case.path, "--to", target)
    path.write_text(out, encoding="utf-8")
    return path, out


# ------------------------------------------------------------------------------------------------ SymPy
SYMPY_WORKER = r"""
import json, math, sys
import sympy as sp
for name, path, points in json.load(sys.stdin):
    space = {}
    exec(compile(open(path, encoding="utf-8").read(), path, "exec"), space)
    answers = {"keys": sorted(space["values"]), "parameters": {str(k): float(v) for k, v in space["parameters"].items()}}
    for key, point in points.items():
        try:
            e = space["values"][key]
            assert isinstance(e, sp.Basic)
            for _ in space["abbreviations"]:
                e = e.subs(space["abbreviations"])
            symbols = sorted(e.free_symbols, key=str)
            answers[key] = float(sp.lambdify(symbols, e, "math")(*(point[str(s)] for s in symbols)))
        except Exception as trouble:
            answers[key] = repr(trouble)
    print(json.dumps([name, answers]))
"""


def python_with(module):
    for python in PYTHONS:
        if shutil.which(python) and subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0:
            return python
    return None


def test_sympy():
    texts = {c.name: export(c, "sympy") for c in cases}
    for c in cases:
        try:
            ast.parse(texts[c.name][1])
            check(f"sympy: {c.name} is Python", True)
        except SyntaxError as trouble:
            check(f"sympy: {c.name} is Python", False, trouble)
    python = python_with("sympy")
    if not python:
        skip("SymPy evaluates", "sympy is not installed")
        return
    jobs = [[c.name, str(texts[c.name][0]), c.points] for c in cases]
    r = subprocess.run([python, "-c", SYMPY_WORKER], input=json.dumps(jobs).encode(), capture_output=True, timeout=200)
    got = dict(json.loads(line) for line in r.stdout.decode().splitlines())
    check("SymPy read every file", len(got) == len(cases), r.stderr.decode()[-800:])
    for c in cases:
        keys = got.get(c.name, {}).get("keys")
        check(f"sympy: {c.name} has every value under its key", keys == sorted(c.entries), f"{keys}\n{sorted(c.entries)}")
        numbers = {k: p["number"] for k, p in c.document["parameters"].items() if p["number"] is not None}
        check(f"sympy: {c.name} has the parameters", got.get(c.name, {}).get("parameters") == numbers, numbers)
    compare("sympy", got)


# ------------------------------------------------------------------------------------------------ Python
NUMPY_WORKER = r"""
import json, sys
import numpy as np
np.seterr(all="ignore")
for name, path, points, spelling in json.load(sys.stdin):
    space = {}
    exec(compile(open(path, encoding="utf-8").read(), path, "exec"), space)
    answers = {"keys": sorted(space["values"]())}
    taken = space["values"].__code__.co_varnames[:space["values"].__code__.co_argcount]
    for key, point in points.items():
        try:
            at = {spelling.get(n, n): v for n, v in point.items()}
            at = {n: v for n, v in at.items() if n in taken}
            alone = float(space["values"](**at)[key]())
            many = space["values"](**{n: np.array([v, v, v]) for n, v in at.items()})[key]()
            assert np.allclose(many, alone, rtol=1e-12, equal_nan=True), "an array gives another value"
            answers[key] = alone
        except Exception as trouble:
            answers[key] = repr(trouble)
    print(json.dumps([name, answers]))
"""


def test_python():
    texts = {c.name: export(c, "python") for c in cases}
    for c in cases:
        try:
            ast.parse(texts[c.name][1])
            check(f"python: {c.name} is Python", True)
        except SyntaxError as trouble:
            check(f"python: {c.name} is Python", False, trouble)
    python = python_with("numpy")
    if not python:
        skip("NumPy evaluates", "numpy is not installed")
        return
    jobs = [[c.name, str(texts[c.name][0]), c.points, {ours: theirs for theirs, ours in renamed(texts[c.name][1]).items()}]
            for c in cases]
    r = subprocess.run([python, "-c", NUMPY_WORKER], input=json.dumps(jobs).encode(), capture_output=True, timeout=200)
    got = dict(json.loads(line) for line in r.stdout.decode().splitlines())
    check("NumPy read every file", len(got) == len(cases), r.stderr.decode()[-800:])
    for c in cases:
        keys = got.get(c.name, {}).get("keys")
        check(f"python: {c.name} has every value under its key", keys == sorted(c.entries), f"{keys}\n{sorted(c.entries)}")
    compare("python", got)


# ------------------------------------------------------------------------------------------------ Maxima
def renamed(text):
    """Names that a target spells differently: its spelling -> ours."""
    return dict(re.findall(r"^(?:# |/\* |\(\* )([\w$]+) is (\w+)(?: \*/| \*\))?$", text, re.M))


def test_maxima():
    texts = {c.name: export(c, "maxima") for c in cases}
    if not shutil.which("maxima"):
        skip("Maxima evaluates", "maxima is not installed")
        return
    lines = ["display2d: false$", "linel: 100000$"]
    for c in cases:
        path, text = texts[c.name]
        spelling = {ours: theirs for theirs, ours in renamed(text).items()}
        lines += ["kill(all)$", f'load("{path}")$']
        for key, point in c.points.items():
            at = ", ".join(f"{spelling.get(n, n)} = {v!r}" for n, v in point.items())
            lines += [f'pleuel_e: assoc("{key}", pleuel_values)$', "for i: 1 thru length(pleuel_abbreviations) do pleuel_e: subst(pleuel_abbreviations, pleuel_e)$",
                      f"pleuel_e: subst([{at}], pleuel_e)$",
                      f'print("VALUE", "{c.name}", "|", "{key}", "|", string(float(ev(pleuel_e))))$']
    batch = pathlib.Path(work.name) / "all.mac"
    batch.write_text("\n".join(lines) + "\n")
    r = subprocess.run(["maxima", "--very-quiet", "-b", str(batch)], capture_output=True, timeout=200)
    got = {}
    for line in r.stdout.decode().splitlines():
        if not line.startswith("VALUE "):
            continue
        name, key, value = (part.strip() for part in line[6:].split("|"))
        try:
            got.setdefault(name, {})[key] = float(value)
        except ValueError:
            got.setdefault(name, {})[key] = value
    compare("maxima", got)


# ------------------------------------------------------------------------------------------------ Julia, Mathematica
def entries_of(text, between):
    """key -> formula text, from lines  "key" => formula,  # unit"""
    found = {}
    for line in text.splitlines():
        m = re.match(r'\s+"((?:[^"\\]|\\.)*)"' + re.escape(between) + r"(.*?),?(  (?:# |\(\* ).*)?$", line)
        if m:
            found[m.group(1)] = m.group(2)
    return found


def from_julia(formula):
    while " ? " in formula:                  # (a > 0 ? b : c): back to the bracket that opens it
        end = formula.index(" > 0 ? ")
        begin, depth = end - 1, 0
        while formula[begin] != "(" or depth:
            depth += (formula[begin] == ")") - (formula[begin] == "(")
            begin -= 1
        formula = formula[:begin] + "if" + formula[begin:end] + ", " + formula[end + 7:].replace(" : ", ", ", 1)
    formula = re.sub(r"\batan\(([^(),]+), ", r"atan2(\1, ", formula)
    return re.sub(r"\blog\(", "ln(", formula.replace("//", "/").replace("Inf", "infinity"))


def from_mathematica(formula):
    formula = re.sub(r"ArcTan\[([^\[\],]+), ([^\[\],]+)\]", r"atan2(\2, \1)", formula)
    names = {"ArcSin": "asin", "ArcCos": "acos", "ArcTan": "atan", "Log": "ln", "Pi": "pi", "Infinity": "infinity"}
    names["If"] = "if"
    names.update({f.capitalize(): f for f in FUNCTIONS if f not in ("if", "ln", "log", "asin", "acos", "atan", "atan2")})
    formula = re.sub(r"[A-Za-z][\w$]*", lambda m: names.get(m.group(), m.group()), formula)
    return formula.replace("[", "(").replace("]", ")").replace("$", "__")


def test_by_reading(target, between, translate):
    """What another program would see, with its spelling translated back."""
    got = {}
    for c in cases:
        _, text = export(c, target)
        back = {theirs.replace("$", "__"): ours for theirs, ours in renamed(text).items()}
        found, got[c.name] = entries_of(text, between), {}
        check(f"{target}: {c.name} has every value under its key", sorted(found) == sorted(c.entries), f"{sorted(found)}\n{sorted(c.entries)}")
        for key in c.points:
            try:
                formula = Formula(translate(found[key]))
                lets = {k: Formula(v).value for k, v in c.lets.items()}
                point = dict(c.points[key])
                for k, f in lets.items():
                    point[k] = f(point)
                got[c.name][key] = formula.value({n: point[back.get(n, n)] for n in formula.names})
            except (NotAFormula, KeyError, ValueError) as trouble:
                got[c.name][key] = repr(trouble)
    compare(f"{target}, read back", got)


# ------------------------------------------------------------------------------------------------ JSON
def tree_value(tree, point):
    if isinstance(tree, (int, float)):
        return tree
    if isinstance(tree, str):
        fixed = {"pi": FUNCTIONS["acos"](-1), "infinity": float("inf")}
        return fixed.get(tree, int(tree) if re.fullmatch(r"-?\d+", tree) else point.get(tree))
    head, args = tree[0], [tree_value(t, point) for t in tree[1:]]
    if head == "+":
        return sum(args)
    if head == "*":
        product = 1
        for a in args:
            product *= a
        return product
    if head == "/":
        return args[0] / args[1]
    if head == "^":
        return args[0] ** args[1]
    return FUNCTIONS[head](*args)


def test_json():
    got = {}
    for c in cases:
        document = json.loads(export(c, "json")[1])
        values = document["values"]
        check(f"json: {c.name} has every value, with the expr of solve --json", {k: v["expr"] for k, v in values.items()} == c.entries,
              "\n".join(f"{k}: {values.get(k, {}).get('expr')} against {c.entries.get(k)}"
                        for k in {**values, **c.entries} if values.get(k, {}).get("expr") != c.entries.get(k))[:2000])
        got[c.name] = {}
        for key, point in c.points.items():
            full = dict(point)
            for name, formula in document["abbreviations"].items():
                full[name] = tree_value(formula["tree"], full)
            got[c.name][key] = tree_value(values[key]["tree"], full)
    compare("json tree", got)


# ------------------------------------------------------------------------------------------------ the program
def test_program():
    model = root / "examples/atwood.pleuel"
    out = pathlib.Path(work.name) / "atwood.py"
    check("-o writes a file", run("export", model, "--to", "sympy", "-o", out)[0] == 0 and "import sympy" in out.read_text())
    out.write_text("mine")
    code, _, err = run("export", model, "--to", "sympy", "-o", out)
    check("and does not replace one", code == 7 and out.read_text() == "mine" and "-f" in err, err)
    check("but with -f", run("export", model, "--to", "sympy", "-o", out, "-f")[0] == 0 and out.read_text() != "mine")
    check("without --to it is wrong usage", run("export", model)[0] == 2)
    code, text, err = run("export", model, "--to", "c")
    check("C is refused", code == 2 and not text and "sympy" in err, err)
    check("two files are wrong usage", run("export", model, model, "--to", "json")[0] == 2)
    check("a missing file is exit code 7", run("export", "missing.pleuel", "--to", "json")[0] == 7)
    bad = pathlib.Path(work.name) / "bad.pleuel"
    bad.write_text("param m = = 3\n")
    code, text, err = run("export", bad, "--to", "sympy")
    check("a wrong model is exit code 3, and nothing on stdout", code == 3 and not text and "bad.pleuel" in err, err)
    only = json.loads(run("export", model, "--to", "json", "--only", "c")[1])["values"]
    check("--only c exports c", only and all(v["letter"] == "c" for v in only.values()), list(only))
    set_to = json.loads(run("export", model, "--to", "json", "--set", "m2=2.5")[1])["parameters"]
    check("--set sets", set_to["m2"] == 2.5, set_to)
    check("the same input gives the same bytes", run("export", model, "--to", "julia") == run("export", model, "--to", "julia"))


test_json()
test_sympy()
test_python()
test_maxima()
test_by_reading("julia", " => () -> ", from_julia)
skip("Julia evaluates", "what is written for Julia is only read, not run")
test_by_reading("mathematica", " -> ", from_mathematica)
skip("Mathematica evaluates", "what is written for Mathematica is only read, not run")
test_program()
work.cleanup()
done()
