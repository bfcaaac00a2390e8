#!/usr/bin/env python3
"""Turns the lists of sentences into one table in the order of strcmp.

Usage: tools/embed_messages.py OUT LIST...
"""
import re
import sys

ENTRY = re.compile(r'PL_SENTENCE\(((?:\s*"(?:[^"\\]|\\.)*")+),((?:\s*"(?:[^"\\]|\\.)*")+)\)')


def joined(literals):
    return "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals))


def in_bytes(text):
    return text.encode().decode("unicode_escape").encode("latin-1")


def read(path):
    with open(path, encoding="utf-8") as f:
        return [(joined(a), joined(b)) for a, b in ENTRY.findall(f.read())]


def main():
    rows = sorted((pair for path in sys.argv[2:] for pair in read(path)), key=lambda pair: in_bytes(pair[0]))
    with open(sys.argv[1], "w", encoding="utf-8") as f:
        f.write("// Made by tools/embed_messages.py.\n#include \"messages/messages_table.h\"\n\nconst pl_message pl_messages[] = {\n")
        f.writelines(f'    {{"{a}", "{b}"}},\n' for a, b in rows)
        f.write(f"}};\nconst size_t pl_n_messages = {len(rows)};\n")


if __name__ == "__main__":
    main()
