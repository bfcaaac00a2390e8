#!/usr/bin/env python3
"""Turns the files of a folder into a C table of names and texts.

Usage: tools/embed.py OUT DEPFILE SYMBOL FOLDER SUFFIX [LINE_COMMENT]

The table is `const pl_embedded SYMBOL[]`, in order of names, ended by a row of NULLs.  The depfile names the folder too,
so that a file that is added or removed makes the table anew.
"""
import pathlib
import sys


def literal(text):
    lines = []
    for line in text.splitlines(keepends=True):
        quoted = "".join(
            c if " " <= c <= "~" and c not in '"\\?' else
            {"\n": "\\n", '"': '\\"', "\\": "\\\\", "?": "\\?"}.get(c) or "".join(f"\\{b:03o}" for b in c.encode())
            for c in line)
        lines.append(f'    "{quoted}"')
    return "\n".join(lines) or '    ""'


def main():
    out, depfile, symbol, folder, suffix = sys.argv[1:6]
    files = sorted(pathlib.Path(folder).glob("*" + suffix))
    with open(out, "w", encoding="utf-8") as f:
        f.write(f"// Made by tools/embed.py.\n#include \"api/embedded.h\"\n\nconst pl_embedded {symbol}[] = {{\n")
        for path in files:
            f.write(f'  {{"{path.stem}",\n{literal(path.read_text(encoding="utf-8"))}}},\n')
        f.write("  {0, 0}\n};\n")
    with open(depfile, "w", encoding="utf-8") as f:
        names = [str(p).replace(" ", "\\ ") for p in [pathlib.Path(folder), *files]]
        f.write(f"{out.replace(' ', chr(92) + ' ')}: {' '.join(names)}\n")


main()
