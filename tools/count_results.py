#!/usr/bin/env python3
"""Reads meson's testlog.json and prints one line a test: passed|failed|skipped, name, reason.

A test that speaks TAP counts with each of its points, any other test as one.  A test program that reports fewer
points than it announced, or ends badly, counts as failed.
"""
import json
import re
import sys

POINT = re.compile(r"^(not )?ok\b\s*(\d+)?\s*(?:-\s*)?([^#]*)(?:#\s*(\w+)\s*(.*))?$")


def points(stdout):
    announced, found = None, []
    for line in stdout.splitlines():
        plan = re.match(r"^1\.\.(\d+)(?:\s*#\s*SKIP\s*(.*))?$", line, re.I)
        if plan:
            announced = (announced or 0) + int(plan.group(1))
            if int(plan.group(1)) == 0:
                found.append(("skipped", "all", plan.group(2) or "nothing to do"))
            continue
        point = POINT.match(line)
        if point:
            bad, _, name, directive, why = point.groups()
            skip = (directive or "").upper() == "SKIP"
            found.append(("skipped" if skip else "failed" if bad else "passed", name.strip(), why or ""))
    return announced, found


def main():
    path, prefix = sys.argv[1:3]
    n = 0
    for line in open(path, encoding="utf-8"):
        test = json.loads(line)
        n += 1
        name = f"{prefix}/{test['name'].split(' / ')[-1]}"
        announced, found = points(test.get("stdout") or "")
        result = test["result"].upper()
        last = (test.get("stdout") or "").strip().splitlines()[-1:] or [""]
        if announced is None and not found:
            kind = {"OK": "passed", "EXPECTEDFAIL": "passed", "SKIP": "skipped"}.get(result, "failed")
            print(f"{kind}\t{name}\t{'' if kind == 'passed' else last[0] if kind == 'skipped' else result.lower()}")
            continue
        for kind, point, why in found:
            print(f"{kind}\t{name}/{point}\t{why}")
        real = sum(1 for f in found if f[1] != "all" or f[0] != "skipped")
        if announced is not None and real != announced:
            print(f"failed\t{name}\treports {real} of {announced} points")
        elif result not in ("OK", "SKIP") and not any(f[0] == "failed" for f in found):
            print(f"failed\t{name}\t{result.lower()}, exit {test.get('returncode')}")
    if n == 0:
        print(f"failed\t{prefix}\tno tests")


main()
