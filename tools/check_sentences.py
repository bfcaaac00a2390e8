#!/usr/bin/env python3
"""The sentences of the program stand in src/messages/*.def, English and German side by side, once.

  - every sentence that the code gives to PL_BOTH, PL_BOTH_FORMAT, pl_german, PL_KEY, pl_fail or
    cli_error has an entry, and every entry is used;
  - an entry stands in one list, once, and both languages have the same conversions and places;
  - no German stands in the code itself.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
ENTRY = re.compile(r'PL_SENTENCE\(((?:\s*"(?:[^"\\]|\\.)*")+),((?:\s*"(?:[^"\\]|\\.)*")+)\)')
MARKED = re.compile(r"\b(?:PL_BOTH|PL_BOTH_FORMAT|pl_german|PL_KEY)\(")
FAILING = {"src": re.compile(r"\b(?:pl_fail|pl_api_fail|fail|give_up)\("), "cli": re.compile(r"\bcli_error\(")}
GERMAN = re.compile(r"[äöüßÄÖÜ]|\b(?:der|die|das|ist|und|nicht|von|mit|wird|sind|für|kein|keine|des|dem)\b")
# They read or write letters, not sentences: what a user may have typed, and how letters are shown.
READERS = {"slips.c", "ascii.c", "scene_hints.c", "notation_2d.c", "html_model.c", "keywords.c", "export.c"}


def without_comments(text):
    keep = lambda m: m.group(0) if m.group(0)[0] in "\"'" else re.sub(r"[^\n]", " ", m.group(0))
    return re.sub(r'"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'|//[^\n]*|/\*.*?\*/', keep, text, flags=re.S)


def joined(text):
    return re.sub(r'"\s*"', "", text)


def arguments(text, at):
    """The text between the bracket before `at` and the one that closes it."""
    depth, i, quoted = 1, at, False
    while depth and i < len(text):
        c = text[i]
        if quoted and c == "\\":
            i += 1
        elif c == '"':
            quoted = not quoted
        elif not quoted:
            depth += (c == "(") - (c == ")")
        i += 1
    return text[at:i - 1]


def is_sentence(literal):
    return len(re.findall(r"[A-Za-z]{2,}", re.sub(r"%[-+.0-9*$]*l?[a-z]", "", literal))) >= 2


def sources():
    for folder in ("src", "cli"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".c", ".h", ".re", ".y") and not path.name.endswith("_test.c") and path.parent.name != "messages":
                yield folder, path, joined(without_comments(path.read_text(encoding="utf-8")))


def used():
    """Sentence, its place, and the list that has to have it: src or cli."""
    for folder, path, text in sources():
        for call in MARKED.finditer(text):
            inside = arguments(text, call.end())
            if "FORMAT" in call.group(0):
                # the arena, the sentence, what goes into it
                inside = inside.split(",", 1)[1]
                first = re.match(r'[^"]*"(?:[^"\\]|\\.)*"(?:\s*:\s*"(?:[^"\\]|\\.)*")?', inside)
                inside = first.group(0) if first else ""
            for literal in LITERAL.findall(inside):
                yield literal, path, folder
        for call in FAILING[folder].finditer(text):
            for literal in LITERAL.findall(arguments(text, call.end())):
                if is_sentence(literal):
                    yield literal, path, folder


def conversions(s):
    """Place -> conversion, and the formulas that are inserted: %2$s is the second one wherever it stands."""
    found = re.findall(r"%(?:(\d)\$)?([-+.0-9*]*(?:l|z)?[a-zA-Z])", s.replace("%%", ""))
    of_place = {int(place) if place else n: how.replace(".0s", "s") for n, (place, how) in enumerate(found, 1)}
    return of_place, set(re.findall(r"\{\d\}", s))


def entries(bad):
    """The lists: English -> its file, for the library and for the command line."""
    lists = {"src": {}, "cli": {}}
    for path in sorted((ROOT / "src/messages").glob("*.def")):
        into = lists["cli" if path.name == "cli.def" else "src"]
        for english, german in ENTRY.findall(path.read_text(encoding="utf-8")):
            english, german = (joined(s).strip()[1:-1] for s in (english, german))
            if english in into:
                bad.append(f"{path.name} and {into[english]}: twice: {english}")
            into[english] = path.name
            if conversions(english) != conversions(german):
                bad.append(f"{path.name}: other conversions: {english}")
    return lists


def main():
    bad = []
    lists = entries(bad)
    seen = {"src": set(), "cli": set()}
    for sentence, path, folder in used():
        seen[folder].add(sentence)
        if sentence not in lists[folder] and re.search(r"[A-Za-z]{2}", re.sub(r"%[-+.0-9*$]*l?[a-z]", "", sentence)):
            bad.append(f"{path.relative_to(ROOT)}: no German for: {sentence}")
    for folder, table in lists.items():
        bad += [f"{file}: nobody says: {s}" for s, file in table.items() if s not in seen[folder]]
    for folder, path, text in sources():
        if path.name not in READERS:
            bad += [f"{path.relative_to(ROOT)}: German in the code: {s}" for s in LITERAL.findall(text)
                    if GERMAN.search(s) and not s.startswith("GERMAN")]
    if sum(map(len, lists.values())) < 1000:
        bad.append("fewer than 1000 sentences were found: the pattern has come away from the lists")
    print("\n".join(bad) if bad else f"{sum(map(len, lists.values()))} sentences, each once and in both languages")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
