#!/usr/bin/env python3
"""The same systems in pleuel, SymPy and Maxima: time to all accelerations and multipliers, and length of the results.

Usage: bench/derivation_peers.py PLEUEL

pleuel counts in processor time: "solved", equations and exact solution, is what the peers' "solved" is; "first" ends with the
first acceleration or multiplier in a readable form; "all" contains every form and the certificates; then the whole process.  The
peers' clocks start after start-up and import, and count processor time too.  What has not ended after SECONDS_PER_STAGE (10) seconds (and 2 for start-up) is given up and said so.
Environment: SYMPY_PYTHON, an interpreter that can import sympy; MAXIMA, the maxima command; SECONDS_PER_STAGE.
"""
import collections
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

import formula
from systems import SYSTEMS, state, unknowns

here = pathlib.Path(__file__).resolve().parent
program = os.path.abspath(sys.argv[1])
seconds = float(os.environ.get("SECONDS_PER_STAGE", 10))
runs = 5


Times = collections.namedtuple("Times", "solved first all process")


# ---- the three programs; each yields (stage, ms, results in the order of unknowns())

def run_pleuel(name):
    command = [program, "solve", "--json", "--timing", "--no-simulation", str(here / "models" / f"{name}.pleuel")]
    rows = []
    for _ in range(runs):
        child = subprocess.Popen(command, stdout=subprocess.PIPE, env=os.environ | {"LC_ALL": "C.UTF-8"})
        document = json.loads(child.stdout.read())
        _, _, usage = os.wait4(child.pid, 0)
        if document["status"] != "ok":
            raise RuntimeError(f"{name}: {document['status']}")
        t = document["timing_ms"]
        solved = t["cpu_equations"] + t["cpu_solution"]
        everything = solved + t["cpu_presentation"] + t["cpu_certificates"]
        rows.append((solved, t.get("cpu_first_form", everything), everything, 1e3 * (usage.ru_utime + usage.ru_stime)))
    return Times(*(statistics.median(column) for column in zip(*rows))), pleuel_results(name, document)


def pleuel_results(name, document):
    """Printed forms; what was dropped as trivially constrained is 0.  Named intermediates come with them, each once."""
    entries = {v["name"]: v for answers in document["answers"].values() for a in answers for v in a["values"]}
    rename = {f"lambda_{i + 1}": f"lambda_{c['label']}" for i, c in enumerate(document["constraints"])}
    wanted = [rename.get(u, u) for u in unknowns(name)]
    names = {}
    for u in wanted:
        names |= {n: e for n, e in entries.get(u, {}).get("where", {}).items() if n not in wanted}
    return [entries[u].get("text", "0").split(" = ")[-1] if u in entries else "0" for u in wanted], names, rename


def stages_of(command):
    """The lines of JSON that a peer printed before it ended or its time was over, and which of the two."""
    with tempfile.TemporaryFile("w+") as out:
        child = subprocess.Popen(command, stdout=out, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        ended = "ended without a result"
        try:
            child.wait(seconds + 2)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
            ended = f"not within {seconds:.0f} s"
        out.seek(0)
        found = []
        for line in out.read().splitlines():
            try:
                found.append(json.loads(line))
            except ValueError:
                pass
        return {f["stage"]: f for f in found if isinstance(f, dict)} | {"ended": ended}


def run_sympy(name):
    return stages_of([sympy_python, str(here / "peer_sympy.py"), name])


def run_maxima(name):
    with tempfile.NamedTemporaryFile("w", suffix=".mac") as batch:
        batch.write(maxima_program(name))
        batch.flush()
        return stages_of([maxima, "--very-quiet", "--batch=" + batch.name])


def maxima_program(name):
    """Lagrange's equations by the chain rule on plain symbols, linsolve, then factor(trigsimp()) of each result.

    The clock of Maxima may tick in hundredths of a second, so each stage is repeated for 200 ms; what Maxima loads on
    the first use of trigsimp is loaded before."""
    _, coords, masses, potential, constraints, _ = SYSTEMS[name]
    q = coords.split()
    places = ", ".join(f"[{m}, [{', '.join(place)}]]" for m, *place in masses)
    return f"""display2d: false$ linel: 100000$ linsolvewarn: false$
q_all: [{', '.join(q)}]$ v_all: [{', '.join(x + '_dot' for x in q)}]$ a_all: [{', '.join(x + '_ddot' for x in q)}]$
n_all: {len(q)}$
total(f_) := sum(diff(f_, q_all[i_])*v_all[i_] + diff(f_, v_all[i_])*a_all[i_], i_, 1, n_all) + diff(f_, t)$
tell(stage_, ms_, found_) := (
  printf(true, "~%{{\\"stage\\": \\"~a\\", \\"ms\\": ~f, \\"results\\": ", stage_, ms_),
  printf(true, "[~{{\\"~a\\"~^, ~}}]}}~%", map(string, found_)))$
accelerations() := block([lagr_, rows_, eqs_],
  lagr_: lsum(p_[1]*lsum(total(x_)^2, x_, p_[2])/2, p_, [{places}]) - ({potential}),
  rows_: [{', '.join(constraints)}],
  eqs_: makelist(total(diff(lagr_, v_all[j_])) - diff(lagr_, q_all[j_])
    - sum(concat(lambda_, k_)*diff(rows_[k_], q_all[j_]), k_, 1, {len(constraints)}), j_, 1, n_all),
  eqs_: append(eqs_, map(lambda([c_], total(total(c_))), rows_)),
  map(rhs, linsolve(eqs_, [{', '.join(unknowns(name))}])))$
readable(results_) := map(lambda([f_], factor(trigsimp(f_))), results_)$
factor(trigsimp(sin(x_)^2 + cos(x_)^2))$
derive() := block([start_, n_: 0, solved_ms_: 0, ms_: 0, found_, simple_],
  start_: elapsed_run_time(),
  while solved_ms_ < 200 do (
    found_: accelerations(), n_: n_ + 1, solved_ms_: 1000.0*(elapsed_run_time() - start_)),
  solved_ms_: solved_ms_/n_,
  tell("solved", solved_ms_, found_),
  start_: elapsed_run_time(), n_: 0,
  while ms_ < 200 do (
    simple_: readable(found_), n_: n_ + 1, ms_: 1000.0*(elapsed_run_time() - start_)),
  tell("simplified", solved_ms_ + ms_/n_, simple_))$
derive()$
"""


# ---- what is told

def measure(name, results, names=None, rename=None):
    """Operations of the printed results and of the names in them, and their values at the state of the system."""
    trees = [formula.read(r) for r in results]
    at = dict(state(name))
    defined = {n: formula.read(e) for n, e in (names or {}).items()}
    ops = sum(map(formula.operations, trees)) + sum(map(formula.operations, defined.values()))
    # names and unknowns may speak of those before them: put in what is known until nothing is left
    shown = [(rename or {}).get(u, u) for u in unknowns(name)]
    left = defined | dict(zip(shown, trees))
    while left:
        known = {n: formula.value(tree, at) for n, tree in left.items() if formula.names(tree) <= at.keys()}
        if not known:
            raise RuntimeError(f"{name}: {sorted(left)} are not defined")
        at |= known
        left = {n: tree for n, tree in left.items() if n not in known}
    return ops, [at[u] for u in shown]


def difference(name, ours, theirs):
    """Largest relative difference; multipliers up to their sign, which is a convention."""
    worst = 0.0
    for unknown, x, y in zip(unknowns(name), ours, theirs):
        if unknown.startswith("lambda"):
            x, y = abs(x), abs(y)
        worst = max(worst, abs(x - y) / max(1.0, abs(x), abs(y)))
    return worst


def tell_peer(name, peer, found, times, ops, values):
    for stage in ("solved", "simplified"):
        label = f"    {peer + ' ' + stage:20}"
        if stage not in found:
            print(f"{label} {found['ended']}")
            return
        ms = found[stage]["ms"]
        their_ops, their_values = measure(name, found[stage]["results"])
        off = difference(name, values, their_values)
        ours = times.solved if stage == "solved" else times.all
        compared = f"{ms:9.1f} ms {ms / ours:8.1f} x {'solved' if stage == 'solved' else 'all'}"
        print(f"{label} {compared:32} {their_ops:6d} ops {their_ops / max(ops, 1):6.2f} x"
              + ("" if off < 1e-9 else f"   RESULTS DIFFER: {off:.1e}"))


def find_sympy():
    for candidate in filter(None, [os.environ.get("SYMPY_PYTHON"), "/usr/bin/python3", sys.executable]):
        try:
            done = subprocess.run([candidate, str(here / "peer_sympy.py"), "--version"], capture_output=True, text=True)
        except OSError:
            continue
        if done.returncode == 0:
            return candidate, done.stdout.strip()
    return None, None


def maxima_version():
    try:
        return subprocess.run([maxima, "--version"], capture_output=True, text=True).stdout.split()[1]
    except (OSError, IndexError):
        return "of unknown version"


def main():
    print(f"Derivation, processor time: pleuel (median of {runs}) beside its peers (one run); the peers' start-up and import excluded")
    print(f"SymPy {sympy_version}: LagrangesMethod + LUsolve, then simplify" if sympy_python
          else "SymPy: not installed, left out")
    print(f"Maxima {maxima_version()}: linsolve, then factor(trigsimp())" if maxima
          else "Maxima: not installed, left out")
    print("Giac: not packaged for Debian 12, left out")
    for name, (title, *_) in SYSTEMS.items():
        times, (results, names, rename) = run_pleuel(name)
        ops, values = measure(name, results, names, rename)
        print(f"  {title} (unknowns: {len(unknowns(name))})")
        print(f"    {'pleuel':20} " + " ".join(f"{stage} {ms:.2f} ms" for stage, ms in times._asdict().items()) + f" {ops:6d} ops",
              flush=True)
        if sympy_python:
            tell_peer(name, "SymPy", run_sympy(name), times, ops, values)
        if maxima:
            tell_peer(name, "Maxima", run_maxima(name), times, ops, values)
        sys.stdout.flush()


if __name__ == "__main__":
    sympy_python, sympy_version = find_sympy()
    maxima = shutil.which(os.environ.get("MAXIMA", "maxima"))
    main()
