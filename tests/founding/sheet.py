"""What the founding tests share: running pleuel, finding answers in its JSON, comparing at random points, TAP output."""

import functools
import json
import math
import os
import random
import subprocess
import sys
import traceback

from formulas import Formula, close

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SEED = int(os.environ.get("PLEUEL_TEST_SEED", "20251"))
POINTS = 25


class Failure(Exception):
    pass


class Skip(Exception):
    """What a test needs is not on this machine."""


def need(condition, sentence):
    if not condition:
        raise Failure(sentence)


# ------------------------------------------------------------------------------------------------ running
class Answer:
    """The JSON document of `pleuel solve --json`."""

    def __init__(self, document, exit_code):
        self.document = document
        self.exit_code = exit_code

    def items(self, key=None):
        out = []
        for k, items in self.document["answers"].items():
            if key is None or k == key:
                out += items
        return out

    def values(self, name=None, key=None, item=None, **fields):
        """All values with this name, under this letter, of a request whose text contains `item`, with these fields."""
        out = []
        for i in self.items(key):
            if item is not None and item not in i["item"]:
                continue
            for v in i["values"]:
                if name is not None and v["name"] != name:
                    continue
                if all(v.get(k) == x for k, x in fields.items()):
                    out.append(v)
        return out

    def value(self, name=None, key=None, item=None, **fields):
        found = self.values(name, key, item, **fields)
        need(found, f"no value {name or ''} under {key or 'any letter'} of {item or 'any request'} {fields or ''}")
        return found[0]

    def parameters(self):
        return {k: p["number"] for k, p in self.document["parameters"].items() if p["number"] is not None}

    def constraint(self, label):
        for c in self.document["constraints"]:
            if c["label"] == label:
                return c
        raise Failure(f"no constraint {label}")

    def notes(self, code):
        return [n for n in self.document["notes"] if n["code"] == code]


@functools.lru_cache(maxsize=None)
def run(program, model, *flags):
    path = model if os.path.isabs(model) else os.path.join(HERE, model)
    done = subprocess.run([program, "solve", "--json", *flags, path], capture_output=True, timeout=120)
    text = done.stdout.decode("utf-8")
    need(done.returncode >= 0, f"pleuel ended by signal {-done.returncode}")
    try:
        document = json.loads(text)
    except ValueError as e:
        raise Failure(f"stdout is not one JSON document ({e}): {text[:200]!r} stderr {done.stderr[:300]!r}")
    return Answer(document, done.returncode)


def example(name):
    return os.path.join(ROOT, "examples", name)


# ------------------------------------------------------------------------------------------------ comparing
class Points:
    """Random points of a state space.  draw(rng) returns all names with values; derived ones included."""

    def __init__(self, draw, n=POINTS, seed=SEED):
        rng = random.Random(seed)
        self.at = [draw(rng) for _ in range(n)]

    def same(self, expr, expected, what, scale=None, rel=1e-9):
        """expr (text) equals expected(point) at every point; scale(point) is the size of the terms."""
        formula = Formula(expr)
        for p in self.at:
            got, want = formula.value(p), expected(p)
            if not close(got, want, rel, scale(p) if scale else 0.0):
                raise Failure(f"{what}: {expr} is {got!r}, expected {want!r} at {shown(p, formula.names)} (seed {SEED})")

    def same_up_to_constant(self, expr, expected, what):
        """The difference of expr and expected is the same at all points with the same parameters (potentials)."""
        formula = Formula(expr)
        offset = None
        for p in self.at:
            d = formula.value(p) - expected(p)
            offset = d if offset is None else offset
            need(close(d, offset, 1e-8, abs(expected(p)) + abs(offset)),
                 f"{what}: {expr} differs by {d!r} and by {offset!r} (seed {SEED})")


def shown(point, names):
    return ", ".join(f"{k} = {point[k]:.6g}" for k in sorted(names) if k in point)


def positive(rng, lo=0.4, hi=2.5):
    return rng.uniform(lo, hi)


def number(value, expected, what, rel=1e-9):
    got = value["number"]
    need(got is not None and close(got, expected, rel), f"{what}: number {got!r}, expected {expected!r}")


def bind(value, names):
    """The names with the abbreviations that the value itself explains."""
    names = dict(names)
    for name, expr in value.get("where", {}).items():
        names[name] = Formula(expr).value(names)
    return names


def component(value, along):
    for c in value.get("components", []):
        if c["along"] == along:
            return c["expr"]
    raise Failure(f"{value['name']}: no component along {along}")


def checks_pass(answer):
    need(answer.document["checks"], "no check was made")
    bad = [c["name"] for c in answer.document["checks"] if not c["passed"]]
    need(not bad, f"own checks failed: {bad}")
    need(answer.exit_code == 0, f"exit code {answer.exit_code}")
    need(answer.document["status"] == "ok", f"status {answer.document['status']}")


# ------------------------------------------------------------------------------------------------ numeric mechanics
def solve_linear(a, b):
    """Gauss with pivoting; a is a list of rows."""
    n = len(b)
    m = [list(map(float, row)) + [float(x)] for row, x in zip(a, b)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(m[i][k]))
        m[k], m[pivot] = m[pivot], m[k]
        for i in range(k + 1, n):
            f = m[i][k] / m[k][k]
            for j in range(k, n + 1):
                m[i][j] -= f * m[k][j]
    x = [0.0] * n
    for k in range(n - 1, -1, -1):
        x[k] = (m[k][n] - sum(m[k][j] * x[j] for j in range(k + 1, n))) / m[k][k]
    return x


def kkt(masses, forces, gradients, curvature):
    """M a = F + G^T lambda, G a = -curvature with curvature = v^T g'' v: accelerations and multipliers."""
    n, r = len(masses), len(gradients)
    rows = [[masses[i] if i == j else 0.0 for j in range(n)] + [-gradients[k][i] for k in range(r)] for i in range(n)]
    rows += [list(g) + [0.0] * r for g in gradients]
    x = solve_linear(rows, list(forces) + [-c for c in curvature])
    return x[:n], x[n:]


# ------------------------------------------------------------------------------------------------ TAP
class Tests:
    def __init__(self):
        self.list = []

    def __call__(self, sentence):
        def keep(f):
            self.list.append((sentence, f))
            return f
        return keep

    def main(self, program):
        print(f"1..{len(self.list)}")
        failed = 0
        for i, (sentence, f) in enumerate(self.list, 1):
            try:
                f(program)
                print(f"ok {i} - {sentence}")
            except Skip as why:
                print(f"ok {i} - {sentence} # SKIP {why}")
            except Exception as e:  # a failure of any kind is reported, and the next test runs
                failed += 1
                print(f"not ok {i} - {sentence}")
                print(f"  # {e}")
                if not isinstance(e, Failure):
                    for line in traceback.format_exc().splitlines():
                        print(f"  # {line}")
            sys.stdout.flush()
        return 1 if failed else 0


def program_of(argv):
    if len(argv) != 2:
        sys.exit(f"usage: {argv[0]} PLEUEL")
    return os.path.abspath(argv[1])


__all__ = ["Answer", "Failure", "Formula", "Points", "Tests", "bind", "checks_pass", "close", "component", "example", "kkt", "math",
           "need", "number", "positive", "program_of", "run", "solve_linear"]
