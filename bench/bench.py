#!/usr/bin/env python3
"""Times `pleuel solve` on three examples, from the start of the process to its exit.  Usage: bench/bench.py PLEUEL [RUNS]

Prints the median and the best of RUNS (20) runs in milliseconds, the goal, and the peak memory of the process.
"""
import os
import pathlib
import statistics
import sys
import time

root = pathlib.Path(__file__).resolve().parent.parent
program = os.path.abspath(sys.argv[1])
runs = int(sys.argv[2]) if len(sys.argv) > 2 else 20
environment = os.environ | {"LC_ALL": "C.UTF-8"}

# Goals are for the first readable form; the whole process contains it, so a process below the goal meets it.
goals_ms = {"atwood": 50, "crank": 300}


def run_once(arguments):
    """Wall-clock ms, peak memory in MB and exit code of one process."""
    start = time.perf_counter()
    child = os.posix_spawn(program, [program, *arguments], environment, file_actions=[
        (os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0), (os.POSIX_SPAWN_OPEN, 2, os.devnull, os.O_WRONLY, 0)])
    _, status, usage = os.wait4(child, 0)
    return 1e3 * (time.perf_counter() - start), usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status)


def main():
    os.chdir(root)
    failed = False
    print(f"pleuel as a whole process, {runs} runs each")
    print(f"  {'command':42} {'median ms':>9} {'best ms':>8} {'goal ms':>8} {'peak MB':>8}")
    for name in ("atwood", "crank", "ski"):
        for more in ([], ["--no-simulation"]):
            arguments = ["solve", f"examples/{name}.pleuel", *more]
            times, peaks, codes = zip(*(run_once(arguments) for _ in range(runs)))
            goal = goals_ms.get(name)
            line = f"  {'solve ' + name + ' ' + ' '.join(more):42} {statistics.median(times):9.1f} {min(times):8.1f}"
            line += f" {goal or '-':>8} {max(peaks):8.1f}"
            if goal:
                line += "  met" if statistics.median(times) <= goal else "  NOT met"
            if set(codes) != {0}:
                line += f"  exit {sorted(set(codes))}"
                failed = True
            print(line, flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
