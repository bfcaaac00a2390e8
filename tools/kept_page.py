"""A page of the manual that a tool writes: stored, or with --check compared with what is stored."""

import difflib
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def keep(page, text):
    """Exit code: 1 when --check was given and docs/PAGE is not `text`; the difference is printed."""
    path = os.path.join(ROOT, "docs", page)
    if "--check" not in sys.argv:
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
        return 0
    with open(path, encoding="utf-8") as f:
        stored = f.read()
    sys.stdout.writelines(difflib.unified_diff(stored.splitlines(True), text.splitlines(True), "docs/" + page, "now", n=0))
    return int(stored != text)
