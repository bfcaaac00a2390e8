#!/usr/bin/env python3
"""Each member of the structs that make up a run is kept when a run is interrupted, or stands in one of the lists at the head of
src/solve/checkpoint.c that say why not.  A member that is forgotten would let a run that was resumed go another way."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOLVE = ROOT / "src/solve"
# struct: header, names by which its members are reached where they are kept
STRUCTS = {
    "pl_run": ("stepper/stepper.h", "run"),
    "pl_dae": ("dae/dae.h", r"(?:run->)?dae"),
    "pl_control": ("stepper/stepper.h", r"run->control"),
    "pl_events": ("event/event.h", r"run->event"),
    "pl_output_state": ("driver_impl.h", r"run->output"),
    "pl_taylor": ("stepper/taylor/taylor_impl.h", r"run->taylor"),
    "pl_kkt": ("dae/dae.h", "kkt|k"),
    "pl_watch": ("event/event.h", r"watch\[i\]"),
    "pl_friction_state": ("dae/dae.h", "now"),
    "pl_fade": ("event/event.h", r"fade\[[01]\]"),
    "pl_attitude_state": ("dae/dae.h", r"attitude\[i\]"),
    "pl_stats": ("solve.h", "s"),
    "pl_step_program": ("stepper/taylor/step_program_impl.h", "o"),
    "pl_radau": ("stepper/radau/radau_impl.h", "r"),
    "pl_extended": ("stepper/taylor/extended_impl.h", "w"),
}
KEEPERS = [SOLVE / "checkpoint.c", SOLVE / "dae/kkt.c", SOLVE / "stepper/taylor/step_program_save.c",
           SOLVE / "stepper/taylor/extended_save.c", SOLVE / "stepper/radau/radau_save.c"]


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def members(header, struct):
    text = without_comments((SOLVE / header).read_text(encoding="utf-8"))
    found = re.search(r"struct " + struct + r"\s*\{(.*?)\n?\}", text, re.S)
    names = []
    for declaration in found.group(1).split(";") if found else []:
        declaration = re.sub(r"\[[^\]]*\]", "", declaration).strip()
        pointer = re.search(r"\(\*(\w+)\)\s*\(", declaration)
        if pointer:
            names.append(pointer.group(1))
        elif declaration:
            first, *others = declaration.split(",")
            names += [re.search(r"(\w+)\s*$", part).group(1) for part in (first, *others)]
    return names


def explained(text):
    """Names in the lists `// not kept of STRUCT, STRUCT, why: names`, which go on over lines that are indented."""
    lists = {}
    head = re.sub(r"\n//   ", " ", text)
    for structs, names in re.findall(r"^// not kept of ((?:pl_\w+, )+)[^:]*: (.*)$", head, re.M):
        for struct in structs.rstrip(", ").split(", "):
            lists.setdefault(struct, set()).update(names.split())
    return lists


def main():
    code = "".join(file.read_text(encoding="utf-8") for file in KEEPERS)
    lists = explained("\n".join(file.read_text(encoding="utf-8") for file in KEEPERS))
    bare = without_comments(code)
    kept_of_kkt = without_comments(KEEPERS[1].read_text(encoding="utf-8"))
    kept_of_kkt = kept_of_kkt[kept_of_kkt.find("void pl_kkt_keep"):]
    bad = []
    for struct, (header, owner) in STRUCTS.items():
        names = members(header, struct)
        if not names:
            bad.append(f"{header}: struct {struct} is not found")
        where = kept_of_kkt if struct == "pl_kkt" else bare
        for name in names:
            kept = re.search(r"\b(?:" + owner + r")(?:->|\.)" + name + r"\b", where) is not None
            if not kept and name not in lists.get(struct, set()):
                bad.append(f"{header}: {struct}.{name} is neither kept in checkpoint.c nor named there with the reason why not")
        for name in sorted(lists.get(struct, set()) - set(names)):
            others = [s for s in STRUCTS if name in members(STRUCTS[s][0], s) and name in lists.get(s, set())]
            if not others:
                bad.append(f"checkpoint.c: {struct} has no member {name}")
    print("\n".join(bad) if bad else "all that lasts from step to step is kept")
    return 1 if bad or not code else 0


if __name__ == "__main__":
    sys.exit(main())
