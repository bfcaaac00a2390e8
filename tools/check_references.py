#!/usr/bin/env python3
"""Keys such as [Goldstein2002] and numbers such as `theory (3.4)` in sources and documents lead somewhere.

Every key stands in docs/references.md and every entry there is cited; works are cited by key, not by
name and year; every number of a formula stands in docs/theory.md, once and in order.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEY = re.compile(r"\[([A-Z][A-Za-z]+[12]\d{3}|FLINT)\b[^\]\n]*\]")
BARE = re.compile(r"//.*\b([A-Z][a-z]+(?:,| and [A-Z][a-z]+)?,? \(?(?:1[89]|20)\d\d)\b")


def places():
    """Files that cite, with their text."""
    for pattern in ("src/**/*.[chy]", "src/**/*.re", "src/**/*.def", "include/*.h", "cli/*.c", "docs/**/*.md", "tests/**/*.py", "bench/*"):
        for path in sorted(p for p in ROOT.glob(pattern) if p.is_file() and p.suffix not in (".csv", ".json")):
            if path.name != "references.md":
                yield path, path.read_text(encoding="utf-8", errors="replace")


def formulas(theory):
    """Numbers at the ends of lines of formulas, in their order."""
    return [(int(a), int(b)) for a, b in re.findall(r"^    .*\((\d+)\.(\d+)\)$", theory, re.M)]


def main():
    entries = re.findall(r"^- \[(\w+)\]", (ROOT / "docs/references.md").read_text(encoding="utf-8"), re.M)
    numbers = formulas((ROOT / "docs/theory.md").read_text(encoding="utf-8"))
    bad = [f"docs/references.md: {k} stands there twice" for k in set(entries) if entries.count(k) > 1]
    bad += ["docs/references.md: entries are not in alphabetical order"] * (entries != sorted(entries, key=str.lower))
    for (a, b), (c, d) in zip([(0, 0)] + numbers, numbers):
        if (c, d) not in ((a, b + 1), (a + 1, 1)):
            bad.append(f"docs/theory.md: ({c}.{d}) follows ({a}.{b})")
    cited, uses = set(), 0
    for path, text in places():
        for n, line in enumerate(text.splitlines(), 1):
            where = f"{path.relative_to(ROOT)}:{n}"
            keys = KEY.findall(line)
            cited |= set(keys)
            bad += [f"{where}: [{k}] is not in docs/references.md" for k in keys if k not in entries]
            if path.suffix in (".c", ".h"):
                bad += [f"{where}: cite by key: {b}" for b in BARE.findall(line)]
            for number in re.findall(r"\((\d+)\.(\d+)\)", line) if re.search(r"\btheory\b", line) else []:
                uses += 1
                if tuple(map(int, number)) not in numbers:
                    bad.append(f"{where}: ({'.'.join(number)}) is not in docs/theory.md")
    bad += [f"docs/references.md: nobody cites [{k}]" for k in entries if k not in cited]
    print("\n".join(bad) if bad else f"{len(entries)} works, {len(numbers)} formulas, {uses} mentions of them")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
