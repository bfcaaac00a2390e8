#!/usr/bin/env python3
"""Every sentence of the program that has a word of docs/glossary.md in English has its German word in German."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAIR = re.compile(r'"((?:[^"\\]|\\.)+)"\s*,\s*"((?:[^"\\]|\\.)+)"')
GERMAN = re.compile(r"[äöüßÄÖÜ]|\b(der|die|das|ist|und|nicht|von|ein|eine|einen|mit|wird|sind|zu|im|auf|für|kein|keine|des|dem|den|aus|bei|hat)\b")


def glossary():
    for line in (ROOT / "docs/glossary.md").read_text(encoding="utf-8").splitlines():
        cells = [c.strip() for c in line.strip("|").split("|")]
        if line.startswith("|") and len(cells) == 2 and cells[0] not in ("English", "---"):
            yield cells[0], [w.strip() for w in cells[1].split("/")]


def sentences():
    """Pairs of literals that stand beside each other, the second one German."""
    files = [*(ROOT / "src").rglob("*.c"), *(ROOT / "src").rglob("*.def"), *(ROOT / "cli").glob("*.def")]
    for path in sorted(p for p in files if not p.name.endswith("_test.c")):
        text = re.sub(r'"\s*"', "", path.read_text(encoding="utf-8"))
        for english, german in PAIR.findall(text):
            if GERMAN.search(german) and not re.search("[äöüß]", english):
                yield path.relative_to(ROOT), english, german


def english_pattern(term):
    forms = {"equilibrium": "equilibri(um|a)", "velocity": "velocit(y|ies)", "mass": "mass(es)?", "degree of freedom": "degrees? of freedom",
             "moment of inertia": "moments? of inertia", "series": "series"}
    return re.compile(r"\b" + forms.get(term, re.escape(term) + "s?") + r"\b", re.I)


def main():
    pairs = list(sentences())
    bad = []
    for term, words in glossary():
        pattern = english_pattern(term)
        for path, english, german in pairs:
            m = pattern.search(english)
            # a word of the model language stays what it is
            if not m or re.search(rf"\b{re.escape(m.group(0))}\b", german):
                continue
            if not any(w.lower() in german.lower() for w in words):
                bad.append(f"{path}: {term} is {' or '.join(words)}\n    {english}\n    {german}")
    if len(pairs) < 300:
        bad.append(f"only {len(pairs)} sentences found: the pattern has come away from the code")
    print("\n".join(bad) if bad else f"{len(pairs)} sentences agree with the glossary")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
