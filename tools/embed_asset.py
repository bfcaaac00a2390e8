#!/usr/bin/env python3
"""Turns one file into a C string.

Usage: tools/embed_asset.py OUT SYMBOL FILE

Style sheets and scripts lose their indentation, the lines that are comments only, and blanks beside signs; anything that is no text is written in
base64, as it stands in a data: address.
"""
import base64
import pathlib
import re
import sys


def literal(text):
    for line in text.splitlines(keepends=True):
        for start in range(0, len(line), 2000):
            part = line[start:start + 2000]
            yield '  "' + "".join(
                c if " " <= c <= "~" and c not in '"\\?' else
                {"\n": "\\n", '"': '\\"', "\\": "\\\\", "?": "\\?"}.get(c) or "".join(f"\\{b:03o}" for b in c.encode())
                for c in part) + '"'


def closer(line):
    """A line of script without the blanks that mean nothing; lines with a regular expression stay as they are."""
    if re.search(r"[(=]\s*/[^/ ]|[(]/", line):
        return line
    parts = re.split(r"('(?:\\.|[^'\\])*'|\"(?:\\.|[^\"\\])*\"|`[^`]*`)", line)
    parts[::2] = (re.sub(r"\s*([=,;:?{}()<>&|*])\s*", r"\1", part) for part in parts[::2])
    return "".join(parts)


def shortened(text, script):
    lines = (line.strip() for line in text.splitlines())
    kept = (line for line in lines if line and not line.startswith("//") and not re.fullmatch(r"/\*.*\*/", line))
    return "\n".join(closer(line) if script else line for line in kept) + "\n"


def main():
    out, symbol, path = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    text = path.suffix in (".css", ".js")
    content = shortened(path.read_text(encoding="utf-8"), path.suffix == ".js") if text else base64.b64encode(path.read_bytes()).decode()
    body = "\n".join(literal(content)) or '  ""'
    pathlib.Path(out).write_text(
        f"// Made by tools/embed_asset.py from {path.name}.\nextern const char {symbol}[];\nconst char {symbol}[] =\n{body};\n",
        encoding="utf-8")


main()
