#!/usr/bin/env python3
"""Every sentence that pl_fail or cli_error is given stands in the list of its folder in both languages, with the same
conversions in the same order, and no list has a sentence that the code has not."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
CALLS = {"src": r"\b(?:pl_fail|pl_api_fail|fail|give_up)\(", "cli": r"\bcli_error\("}
LISTS = {"src": ROOT / "src/base/sentences.def", "cli": ROOT / "cli/cli_sentences.def"}


def arguments(text, at):
    """The text between the bracket at `at` - 1 and the one that closes it."""
    depth, i, quoted = 1, at, False
    while depth:
        c = text[i]
        if quoted and c == "\\":
            i += 1
        elif c == '"':
            quoted = not quoted
        elif not quoted:
            depth += (c == "(") - (c == ")")
        i += 1
    return text[at:i - 1]


def joined(text):
    return re.sub(r'"\s*"', "", text)


def sentences_of(folder):
    """Sentence and place: literals with at least two words, but no arguments of ?: that only fill a gap."""
    for path in sorted((ROOT / folder).rglob("*.c")):
        if path.name.endswith("_test.c"):
            continue
        text = path.read_text(encoding="utf-8")
        for call in re.finditer(CALLS[folder], text):
            inside = joined(arguments(text, call.end()))
            for literal in STRING.findall(inside):
                if len(re.findall(r"[A-Za-z]{2,}", re.sub(r"%[-+.0-9*]*l?[a-z]", "", literal))) >= 2:
                    yield literal, f"{path.relative_to(ROOT)}:{text[:call.start()].count(chr(10)) + 1}"


def conversions(s):
    return re.findall(r"%[-+.0-9*]*(?:l|z)?[a-zA-Z]", s.replace("%%", ""))


def main():
    bad = []
    for folder, file in LISTS.items():
        pairs = dict(re.findall(r'PL_SENTENCE\("((?:[^"\\]|\\.)*)",\s*"((?:[^"\\]|\\.)*)"\)', joined(file.read_text(encoding="utf-8"))))
        used = {}
        for sentence, place in sentences_of(folder):
            used.setdefault(sentence, place)
        bad += [f"{place}: not in {file.relative_to(ROOT)}: {s}" for s, place in used.items() if s not in pairs]
        bad += [f"{file.relative_to(ROOT)}: nobody says: {s}" for s in pairs if s not in used]
        bad += [f"{file.relative_to(ROOT)}: other conversions: {s}" for s, german in pairs.items() if conversions(s) != conversions(german)]
    print("\n".join(bad) if bad else "every sentence is there in both languages")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
