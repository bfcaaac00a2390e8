#!/usr/bin/env python3
"""Times pleuel as whole processes.  Usage: bench/bench.py PLEUEL [RUNS]

Prints for each command the best and the median of RUNS (7) runs in milliseconds, and the peak memory in MB.
"""
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import time

root = pathlib.Path(__file__).resolve().parent.parent
program = os.path.abspath(sys.argv[1])
runs = int(sys.argv[2]) if len(sys.argv) > 2 else 7
environment = os.environ | {"LC_ALL": "C.UTF-8"}


def measure(arguments):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        done = subprocess.run([program, *arguments], cwd=root, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        times.append(1e3 * (time.perf_counter() - start))
        if times[-1] > 5000:
            break
    return min(times), statistics.median(times), done.returncode


commands = [["--version"]]
for model in sorted((root / "examples").glob("*.pleuel")):
    name = f"examples/{model.name}"
    commands += [["check", name], ["solve", name, "--no-simulation"], ["sim", name]]

print(f"{'command':46} {'best ms':>9} {'median':>9}  exit")
for c in commands:
    best, median, code = measure(c)
    print(f"{'pleuel ' + ' '.join(c):46} {best:9.1f} {median:9.1f}  {code}")
peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
print(f"largest process: {peak:.0f} MB")
