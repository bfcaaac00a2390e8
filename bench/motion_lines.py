"""The assignments of a motion for heyoka, from a cache that motion_peers.py writes (heyoka's interpreter may lack SymPy)."""
import json
import os


def of(name):
    """Lines, number of coordinates, start values."""
    with open(os.path.join(os.environ["BENCH_MOTION"], f"{name}.json"), encoding="utf-8") as file:
        found = json.load(file)
    return found["lines"], found["n"], found["start"]
