#!/usr/bin/env python3
"""Runs pleuel as listed in the file `cases` and compares with the stored outputs beside it.

A case is a line: its name, then the arguments of pleuel.  NAME holds what came out on stdout, NAME.stderr what came out on
stderr if anything did, NAME.exit the exit code if it was not 0.  Programs run in the root of the project, twice, and must
give the same bytes both times.

    tests/golden/run.py build/pleuel              compare, TAP output
    tests/golden/run.py build/pleuel --accept     rewrite the stored outputs; read the diff before committing it
"""

import difflib
import os
import shlex
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def cases():
    for line in open(os.path.join(HERE, "cases"), encoding="utf-8"):
        words = shlex.split(line, comments=True)
        if words:
            yield words[0], words[1:]


def produce(program, arguments):
    environment = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "NO_COLOR", "COLUMNS")} | {"LC_ALL": "C.UTF-8"}
    done = subprocess.run([program, *arguments], capture_output=True, cwd=ROOT, env=environment, timeout=60)
    return {"": done.stdout, ".stderr": done.stderr, ".exit": b"" if done.returncode == 0 else b"%d\n" % done.returncode}


def stored(name):
    out = {}
    for ending in ("", ".stderr", ".exit"):
        path = os.path.join(HERE, name + ending)
        out[ending] = open(path, "rb").read() if os.path.exists(path) else b""
    return out


def accept(name, output):
    for ending, data in output.items():
        path = os.path.join(HERE, name + ending)
        if data:
            open(path, "wb").write(data)
        elif os.path.exists(path):
            os.remove(path)


def difference(name, want, got):
    for ending in want:
        old, new = (x[ending].decode("utf-8", "replace").splitlines() for x in (want, got))
        yield from difflib.unified_diff(old, new, name + ending, name + ending + " (now)", lineterm="", n=1)


def compare(i, name, program, arguments):
    want, got = stored(name), produce(program, arguments)
    again = produce(program, arguments)
    good = want == got and got == again and any(want.values())
    print(f"{'ok' if good else 'not ok'} {i} - {name}: pleuel {shlex.join(arguments)}")
    if got != again:
        print("  # two runs differ")
    if not any(want.values()):
        print("  # nothing is stored: tests/golden/run.py PLEUEL --accept")
    for line in list(difference(name, want, got))[:60] if want != got else []:
        print("  # " + line)
    return good


def main():
    program = os.path.abspath(sys.argv[1])
    if "--accept" in sys.argv[2:]:
        for name, arguments in cases():
            accept(name, produce(program, arguments))
        return 0
    everything = list(cases())
    print(f"1..{len(everything)}")
    results = [compare(i, name, program, arguments) for i, (name, arguments) in enumerate(everything, 1)]
    return 0 if all(results) else 1


sys.exit(main())
