#!/usr/bin/env python3
"""Motions of pleuel beside SciPy's DOP853, and heyoka if there is one: CPU time at equal error.

Usage: bench/motion_peers.py PLEUEL

The error is the largest distance of a coordinate of a mass from the reference (references.py) at the end.  For each
tolerance of pleuel the cheapest run of the peer is chosen whose error is not larger.  CPU time is user and system: of
the whole process for pleuel (reading and preparing included), of the integration alone for the peers (start-up, import
and compilation excluded); the best of 3 runs.  The stages `record` and `simulate` of pleuel's own --timing (wall clock),
where `solve` tells them, are the part that compares with the peers' figure.
Environment: BENCH_PYTHON, an interpreter that can import scipy.
"""
import functools
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import time

import references

here = pathlib.Path(__file__).resolve().parent
runs = 3

# name -> title, end, columns of pleuel's output that hold the state, places of the masses from it
MOTIONS = {
    "double": ("double pendulum, 5 s", 5, ["a [rad]", "b [rad]"], references.double_places),
    "crank1": ("slider-crank as a closed loop, 2 s", 2, ["x1 [m]", "z1 [m]", "x2 [m]"], list),
    "chain": ("chain of 100 masses, 0.3 s", 0.3, [f"{c}[{i}] [m]" for c in "xy" for i in range(1, 101)], list),
}


def interpreter_with(modules):
    for candidate in filter(None, [os.environ.get("BENCH_PYTHON"), sys.executable, "python3", "/usr/bin/python3"]):
        try:
            if subprocess.run([candidate, "-c", f"import {modules}"], capture_output=True).returncode == 0:
                return candidate
        except OSError:
            continue
    return None


# ---- pleuel

def run_pleuel(program, name, tolerance):
    """Places of the masses at the end, CPU seconds."""
    _, end, columns, places = MOTIONS[name]
    command = [program, "sim", str(here / "models" / f"{name}.pleuel"), "-o", "-", "--dt", str(end),
               "--until", str(end), "--tol", str(tolerance)]
    best = math.inf
    for _ in range(runs):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"LC_ALL": "C.UTF-8"})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            raise RuntimeError(f"{name}: exit {done.returncode}")
        best = min(best, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    lines = done.stdout.splitlines()
    row = dict(zip(lines[0].split(","), lines[-1].split(",")))
    if abs(float(row["t [s]"]) - end) > 1e-12:
        raise RuntimeError(f"{name}: the last row is not the end")
    return places([float(row[c]) for c in columns]), best


def stages_ms(program, name, tolerance):
    """What `solve --timing` tells for recording and integrating (best run, wall clock); None where it does not simulate."""
    lines = (here / "models" / f"{name}.pleuel").read_text(encoding="utf-8").splitlines()
    text = "\n".join(f"{line} tol {tolerance}" if line.startswith("simulate") else line for line in lines) + "\n"
    found = []
    for _ in range(runs):
        done = subprocess.run([program, "solve", "--json", "--timing", "-"], input=text, capture_output=True, text=True,
                              env=os.environ | {"LC_ALL": "C.UTF-8"})
        document = json.loads(done.stdout)
        if document.get("simulation"):
            found.append(document["timing_ms"]["record"] + document["timing_ms"]["simulate"])
    return min(found) if found else None


# ---- SciPy: angles for the pendulum, crank angle for the slider-crank, tensions of the links for the chain

def chain_for_numpy(n, d, g):
    import numpy as np
    from scipy.linalg import solveh_banded

    def f(t, state):
        p, v = state[:2 * n].reshape(2, n), state[2 * n:].reshape(2, n)
        link, rate = np.diff(p, prepend=0.0), np.diff(v, prepend=0.0)
        bands = np.empty((2, n))
        bands[0, 0] = 0
        bands[0, 1:] = -(link[:, 1:] * link[:, :-1]).sum(0)
        bands[1] = 2 * (link * link).sum(0)
        bands[1, 0] /= 2
        right = (rate * rate).sum(0)
        right[0] -= g * link[1, 0]
        pull = solveh_banded(bands, right, overwrite_ab=True, overwrite_b=True, check_finite=False) * link
        a = np.diff(pull, append=0.0)
        a[1] -= g
        return np.concatenate((state[2 * n:], a.ravel()))
    return f


def peer_problem(name):
    """Right side, start and places for the peer."""
    if name == "double":
        f = references.double_pendulum(math.sin, math.cos, 9.81)
        return lambda t, y: f(y.tolist()), [math.radians(120), math.radians(-10), 0, 0], references.double_places
    if name == "crank1":
        f = references.slider_crank(math.sin, math.cos, math.sqrt, 9.81, 0.1, 0.3)
        return lambda t, y: f(y.tolist()), [math.atan2(8, 6), -1.0], references.crank_places
    return chain_for_numpy(100, 0.01, 9.81), references.chain_start(), references.chain_places


def cpu_of(work):
    """Result and best CPU seconds of `runs` calls; a long one is called once."""
    best = math.inf
    for _ in range(runs):
        start = time.process_time()
        found = work()
        best = min(best, time.process_time() - start)
        if best > 2:
            break
    return found, best


def scipy_ladder(name, exact):
    """(tolerance, error, CPU seconds) from loose to tight."""
    from scipy.integrate import solve_ivp
    f, start, places = peer_problem(name)
    end = MOTIONS[name][1]
    rungs = []
    for k in range(3, 14):
        tolerance = 10.0 ** -k
        run = functools.partial(solve_ivp, f, (0, end), start, method="DOP853", rtol=tolerance, atol=tolerance / 10)
        found, cpu = cpu_of(run)
        if found.success:
            rungs.append((tolerance, references.distance(places(found.y[:, -1]), exact), cpu))
    return rungs


def heyoka_ladder(name, exact):
    """As scipy_ladder; the time to compile is excluded."""
    import heyoka
    f, start, places = peer_problem(name)
    if name == "double":
        y = heyoka.make_vars("a", "b", "u", "v")
        right = references.double_pendulum(heyoka.sin, heyoka.cos, 9.81)(y)
    elif name == "crank1":
        y = heyoka.make_vars("a", "u")
        right = references.slider_crank(heyoka.sin, heyoka.cos, heyoka.sqrt, 9.81, 0.1, 0.3)(y)
    else:
        return []
    rungs = []
    for k in range(3, 16, 3):
        run = heyoka.taylor_adaptive(list(zip(y, right)), list(start), tol=10.0 ** -k)

        def once():
            run.time, run.state[:] = 0.0, start
            run.propagate_until(float(MOTIONS[name][1]))
            return list(run.state)
        found, cpu = cpu_of(lambda: [once() for _ in range(20)][-1])
        rungs.append((10.0 ** -k, references.distance(places(found), exact), cpu / 20))
    return rungs


# ---- what is told

def ratios(spent, cpu, own_ms):
    return f"{spent / cpu:8.2f} x process" + (f" {1e3 * spent / own_ms:8.2f} x stages" if own_ms else "")


def tell_peer(peer, rungs, error, cpu, own_ms):
    enough = [r for r in rungs if r[1] <= error]
    if not rungs:
        print(f"      {peer:8} not run for this system")
        return
    tolerance, reached, spent = min(enough, key=lambda r: r[2]) if enough else min(rungs, key=lambda r: r[1])
    print(f"      {peer:8} tol {tolerance:.0e}   error {reached:.1e}   CPU {1e3 * spent:8.2f} ms {ratios(spent, cpu, own_ms)}"
          + ("" if enough else "   does not reach the error of pleuel"))


def main(program):
    print(f"Motion: CPU time at equal error, best of {runs} runs; x is the time of the peer over that of pleuel")
    print("pleuel: whole process, with its tape interpreter; peers: integration only, without start-up, import and compilation")
    ladders = {}
    for peer, module, ladder in (("DOP853", "scipy", scipy_ladder), ("heyoka", "heyoka", heyoka_ladder)):
        try:
            found = __import__(module)
            print(f"{peer}: {module} {found.__version__}" + (", right sides in Python" if module == "scipy" else ""))
            ladders[peer] = ladder
        except ImportError:
            print(f"{peer}: {module} is not installed, left out")
    for name, (title, *_) in MOTIONS.items():
        try:
            exact, accuracy = references.reference(name)
        except ImportError:
            print(f"  {title}: mpmath is not installed, so there is no reference; left out")
            continue
        print(f"  {title}; reference good to {max(accuracy, 1e-16):.0e}", flush=True)
        rungs = {peer: ladder(name, exact) for peer, ladder in ladders.items()}
        for tolerance in (1e-6, 1e-9, 1e-12):
            places, cpu = run_pleuel(program, name, tolerance)
            error = references.distance(places, exact)
            note = "   (not above the accuracy of the reference)" if error <= accuracy else ""
            own_ms = stages_ms(program, name, tolerance)
            own = f"   of this record and simulate {own_ms:.2f} ms" if own_ms else ""
            print(f"    pleuel     tol {tolerance:.0e}   error {error:.1e}   CPU {1e3 * cpu:8.2f} ms{own}{note}")
            for peer in ladders:
                tell_peer(peer, rungs[peer], max(error, accuracy), cpu, own_ms)
        sys.stdout.flush()


if __name__ == "__main__":
    better = next(filter(None, map(interpreter_with, ("scipy, mpmath", "scipy", "mpmath"))), None)
    if better and not os.environ.get("BENCH_CHOSEN") and better != sys.executable:
        os.environ["BENCH_CHOSEN"] = "1"
        os.execvp(better, [better, *sys.argv])
    main(os.path.abspath(sys.argv[1]))
