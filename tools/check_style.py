#!/usr/bin/env python3
"""C files are laid out by clang-format 14 with .clang-format, lines have at most 100 columns, and no
comma operator joins two statements.

The layout is left out, with its reason, where another version is installed: versions differ.
"""
import pathlib
import re
import subprocess
import sys
import unicodedata

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLUMNS = 100
VERSION = "14"
SKIPPED = 77


def tracked():
    lines = subprocess.run(["git", "ls-files", "*.c", "*.h"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in lines.stdout.splitlines() if (ROOT / name).exists()]


def width(line):
    return sum(not unicodedata.combining(c) for c in line)


def bare(text):
    """The text without comments, directives, and what stands in quotes; lines stay where they are."""
    def blank(m):
        return re.sub(r"[^\n]", " ", m.group(0)) if m.group(0)[0] == "/" else '"' + "\n" * m.group(0).count("\n") + '"'
    text = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'', blank, text, flags=re.S)
    return re.sub(r"^[ \t]*#(?:[^\n\\]|\\\n|\\.)*", lambda m: "\n" * m.group(0).count("\n"), text, flags=re.M)


def statements(text):
    """Pieces that end with a semicolon outside of round brackets, and their lines."""
    depth, start = 0, 0
    for i, c in enumerate(text):
        depth += (c in "([") - (c in ")]")
        if c in "{}" and depth == 0 or c == ";" and depth == 0:
            if c == ";":
                yield text[start:i], text.count("\n", 0, i) + 1
            start = i + 1


HEADER = re.compile(r"\s*(?:else\b|do\b|case [^:?]+:|default\s*:|(?:if|for|while|switch)\s*(?=\())")


def without_header(s):
    """What is left of `if (a) b` is `b`."""
    while m := HEADER.match(s):
        s = s[m.end():]
        if s.startswith("("):
            depth = 0
            for i, c in enumerate(s):
                depth += (c == "(") - (c == ")")
                if depth == 0:
                    break
            s = s[i + 1:]
    return s.strip()


DECLARES = re.compile(r"(?!return\b)[A-Za-z_]\w*\b(\s*\([^)]*\))?[\s*]*[\s*][A-Za-z_(]")


def joins(s):
    s = without_header(s)
    if not s or s[0] in ",)}=" or DECLARES.match(s):
        return False
    depth = 0
    for c in s:
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            return True
    return False


def layout(files):
    try:
        said = subprocess.run(["clang-format", "--version"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return None, "the layout needs clang-format " + VERSION
    if not re.search(rf"version {VERSION}\.", said):
        return None, f"the layout is that of clang-format {VERSION}, here is {said.strip()}"
    done = subprocess.run(["clang-format", "--dry-run", "-Werror", "--ferror-limit=1", *files], cwd=ROOT, capture_output=True, text=True)
    return sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", done.stderr, re.M))), None


def main():
    files, bad = tracked(), []
    for path in files:
        name, text = path.relative_to(ROOT), path.read_text(encoding="utf-8")
        for n, line in enumerate(text.splitlines(), 1):
            if width(line) > COLUMNS:
                bad.append(f"{name}:{n}: {width(line)} columns")
        bad += [f"{name}:{n}: a comma joins two statements" for s, n in statements(bare(text)) if joins(s)]
    wrong, reason = layout(files)
    bad += [f"{pathlib.Path(p).relative_to(ROOT) if p[0] == '/' else p}: clang-format -i {p}" for p in wrong or []]
    print("\n".join(bad) if bad else reason or f"{len(files)} files are laid out alike")
    return 1 if bad else SKIPPED if reason else 0


if __name__ == "__main__":
    sys.exit(main())
