#!/usr/bin/env python3
"""Three habits of the house, by linker symbols and by types.

  knot   files of a folder that call each other in a circle: at most four of them
  type   a type name is defined in one folder only
  alone  a function that only its own file uses is static

Usage: tools/check_house.py BUILD [--shrink]
tools/house_exceptions.txt lists what is not so yet.  The list may only shrink: what is better than
the list is a fault too, and --shrink writes the better list.
"""
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = ROOT / "tools/house_exceptions.txt"
LARGEST_KNOT = 4
SYMBOL_KINDS = "TDBRVWC"    # what nm calls a definition that other files can see


def objects(build):
    """Symbols that each object file defines and wants, with its folder (cli and plugins have none)."""
    found = {}
    for path in sorted(build.rglob("*.o")):
        inside = path.relative_to(build).parts
        folder = inside[1] if inside[0] == "src" and len(inside) > 2 else None
        # tests and generated tables have no room of their own
        if re.search(r"(_test|_fuzz|_text)\.c\.o$", path.name) or "meson-generated" in path.name:
            folder = None
        found[str(path)] = (folder, set(), set())
    text = subprocess.run(["nm", "-A", "-P", "-g", *found], capture_output=True, text=True, check=True).stdout
    for path, symbol, kind in re.findall(r"^(.*\.o): (\S+) (\S)", text, re.M):
        folder, defined, wanted = found[path]
        if kind in SYMBOL_KINDS:
            defined.add(symbol)
        elif kind == "U":
            wanted.add(symbol)
    return found


def file_of(path):
    return pathlib.Path(path).name.removesuffix(".o")


def knots(calls):
    """Strongly connected groups of a graph, larger than one (Tarjan)."""
    index, low, stack, groups = {}, {}, [], []

    def visit(v):
        index[v] = low[v] = len(index)
        stack.append(v)
        for w in calls[v]:
            if w not in index:
                visit(w)
            if w in stack:
                low[v] = min(low[v], low[w])
        if low[v] == index[v]:
            at = stack.index(v)
            groups.append(stack[at:])
            del stack[at:]

    for v in calls:
        if v not in index:
            visit(v)
    return [g for g in groups if len(g) > 1]


def find_knots(found):
    rooms = collections.defaultdict(dict)
    for path, (folder, defined, wanted) in found.items():
        if folder:
            rooms[folder][file_of(path)] = (defined, wanted)
    for folder, files in rooms.items():
        owner = {s: name for name, (defined, _) in files.items() for s in defined}
        calls = {name: {owner[s] for s in wanted if s in owner} for name, (_, wanted) in files.items()}
        for group in knots(calls):
            if len(group) > LARGEST_KNOT:
                yield folder, len(group), " ".join(sorted(group))


def find_types():
    """Type names that several folders define."""
    folders = collections.defaultdict(set)
    for path in (ROOT / "src").rglob("*.[ch]"):
        if not path.name.endswith("_test.c"):
            text = path.read_text(encoding="utf-8")
            names = re.findall(r"^\} (pl_\w+);", text, re.M) + re.findall(r"^typedef [^;{(]*\{[^}]*\} (pl_\w+);", text, re.M)
            for name in names + re.findall(r"^(?:struct|union|enum) (pl_\w+) \{", text, re.M):
                folders[name].add(path.relative_to(ROOT / "src").parts[0])
    return {name: sorted(f) for name, f in folders.items() if len(f) > 1}


def find_alone(found):
    """Symbols that only their own file uses, by folder."""
    # a file that is compiled several times is one file
    users = collections.defaultdict(set)
    for path, (_, _, wanted) in found.items():
        for s in wanted:
            users[s].add(file_of(path))
    alone = collections.defaultdict(set)
    for path, (folder, defined, _) in found.items():
        if folder:
            alone[folder] |= {s for s in defined if s.startswith("pl_") and not s.startswith("pl_jit_plugin_") and not users[s] - {file_of(path)}}
    return {folder: sorted(names) for folder, names in alone.items() if names}


def state(build):
    """What is not as it should be: a line each, with the size that counts and an explanation."""
    found = objects(build)
    lines = {}
    sizes = collections.defaultdict(list)
    for folder, size, group in find_knots(found):
        sizes[folder].append((size, group))
    for folder, groups in sizes.items():
        groups.sort(reverse=True)
        for n, (size, group) in enumerate(groups, 1):
            lines[f"knot {folder} {n}"] = (size, f"{size} files of {folder} call each other in a circle: {group}")
    for name, folders in find_types().items():
        lines[f"type {name}"] = (len(folders), f"the type {name} is defined in {', '.join(folders)}")
    for folder, names in find_alone(found).items():
        lines[f"alone {folder}"] = (len(names), f"used in their own file only (static?): {' '.join(names)}")
    return lines


def listed():
    rows = [line.rsplit(None, 1) for line in LIST.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"]
    return {key: int(size) for key, size in rows}


def main():
    lines, allowed = state(pathlib.Path(sys.argv[1])), listed()
    worse = [text for key, (size, text) in sorted(lines.items()) if size > allowed.get(key, 0)]
    better = [key for key, size in allowed.items() if size > lines.get(key, (0,))[0]]
    if "--shrink" in sys.argv:
        head = [line for line in LIST.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
        kept = [(key, min(size, lines[key][0])) for key, size in allowed.items() if key in lines]
        LIST.write_text("\n".join(head + [f"{key} {size}" for key, size in sorted(kept)]) + "\n", encoding="utf-8")
        better = []
    for text in worse:
        print(text)
    if better:
        print("better than tools/house_exceptions.txt says (run tools/check_house.py BUILD --shrink):", ", ".join(better))
    return 1 if worse or better else 0


if __name__ == "__main__":
    sys.exit(main())
