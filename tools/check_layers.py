#!/usr/bin/env python3
"""Checks that folders use only the folders they may use, by includes and by calls, and that file names are unique.

Usage: tools/check_layers.py BUILD     (BUILD holds the static library of each folder, for the calls)
The rules are in src/layers.txt: `folder: folders it may include`, lower folders first.  A folder inside a folder that has a line of
its own there (solve/dae) is a room of its own; one that has none belongs to the folder around it.  Tests of a room may use the rooms
above it in the same folder, and every room may include the header that the whole folder shows (solve/solve.h), which it helps to keep.
"""
import collections
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
build = pathlib.Path(sys.argv[1])
faults = []


def rules():
    allowed = {}
    for line in (root / "src/layers.txt").read_text(encoding="utf-8").splitlines():
        line = line.split("#")[0].strip()
        if line:
            folder, rest = line.split(":")
            allowed[folder.strip()] = set(rest.split()) | {folder.strip()}
    return allowed


def room_of(path, allowed):
    """The folder in the rules that holds path, which is relative to src: the innermost one; None where there is none."""
    for folder in path.parents:
        if folder.as_posix() in allowed:
            return folder.as_posix()
    return None


def check_order(allowed):
    seen = set()
    for folder, uses in allowed.items():
        for u in uses - seen - {folder}:
            faults.append(f"src/layers.txt: {folder} may use {u}, which stands above it")
        seen.add(folder)


def check_includes(allowed):
    sources = [p for p in (root / "src").rglob("*") if p.suffix in (".c", ".h", ".re", ".y", ".def")]
    for path in sources:
        folder = room_of(path.relative_to(root / "src"), allowed)
        if folder is None:
            faults.append(f"{path.relative_to(root)}: the folder is not in src/layers.txt")
            continue
        for n, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            m = re.match(r'\s*#\s*include\s+"([a-z_0-9/]+/[a-z_0-9]+\.[a-z]+)"', line)
            included = room_of(pathlib.PurePosixPath(m.group(1)), allowed) if m else None
            beside = path.stem.endswith("_test") and included and included.split("/")[0] == folder.split("/")[0]
            face = m and "/" in folder and m.group(1) == "{0}/{0}.h".format(folder.split("/")[0])
            reads = path.stem.endswith(("_test", "_test_kit")) and included == "lang"   # models of tests are texts
            if included and included not in allowed[folder] and not (beside or face or reads):
                faults.append(f"{path.relative_to(root)}:{n}: {folder} may not include {included}")
            if re.match(r'\s*#\s*include\s+[<"]([a-z]+/)?(flint|arb|acb|fmpz|fmpq)', line) and folder.split("/")[0] not in ("algebra", "present", "verify", "enclose"):
                faults.append(f"{path.relative_to(root)}:{n}: only algebra, present, verify and enclose see FLINT")
            m = re.match(r'\s*#\s*include\s+"([a-z_0-9/]+)/([a-z_0-9]+_impl)\.h"', line)
            if m and included != folder:
                faults.append(f"{path.relative_to(root)}:{n}: {m.group(2)}.h belongs to the files of {m.group(1)}")
    for path in [*root.glob("cli/*.c"), *root.glob("cli/*.h")]:
        for n, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            m = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if m and m.group(1) != "pleuel.h" and not (root / "cli" / m.group(1)).exists():
                faults.append(f"{path.relative_to(root)}:{n}: cli sees only pleuel.h")


def symbols(archive):
    """Names that a static library defines and names that it wants."""
    defined, wanted = set(), set()
    text = subprocess.run(["nm", "-P", "-g", str(archive)], capture_output=True, text=True, check=True).stdout
    for line in text.splitlines():
        parts = line.split()
        if len(parts) >= 2 and len(parts[1]) == 1:
            (wanted if parts[1] == "U" else defined).add(parts[0])
    return defined, wanted


def check_calls(allowed):
    table, owner = {}, {}
    for archive in sorted((build / "src").rglob("*.a")):
        folder = room_of(archive.relative_to(build / "src"), allowed)
        if folder is None:
            continue
        defined, wanted = table.setdefault(folder, (set(), set()))
        d, w = symbols(archive)
        defined |= d
        wanted |= w
    table = {folder: table[folder] for folder in allowed if folder in table}   # a library may hold those below it: the lowest owns
    for folder, (defined, _) in table.items():
        for name in defined:
            owner.setdefault(name, folder)
    if "base" not in table:
        faults.append(f"{build}: no static libraries there")
    for folder, (defined, wanted) in table.items():
        for name in sorted(wanted - defined):
            if name in owner and owner[name] not in allowed[folder]:
                faults.append(f"src/{folder}: calls {name} of {owner[name]}, which it may not")
    for folder, (defined, _) in table.items():
        for name in sorted(defined):
            if not name.startswith(("pl_", "pleuel_", "yy", "pl")) and not name.startswith("__"):
                faults.append(f"src/{folder}: the symbol {name} does not begin with pl_ or pleuel_")


def check_names():
    places = collections.defaultdict(list)
    for folder in ("src", "cli"):
        for p in (root / folder).rglob("*"):
            if p.is_file() and p.suffix in (".c", ".h", ".re", ".y", ".def"):
                places[p.name].append(str(p.relative_to(root)))
    for name, where in sorted(places.items()):
        if len(where) > 1:
            faults.append(f"{name} stands in several places: {', '.join(where)}")


allowed = rules()
check_order(allowed)
check_includes(allowed)
check_calls(allowed)
check_names()
for f in faults:
    print(f)
sys.exit(1 if faults else 0)
