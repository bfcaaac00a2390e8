"""A few lines of TAP for test programs in Python."""
import sys

_n = 0
_failed = 0


def check(name, ok, detail=""):
    """One point: a sentence that should be true."""
    global _n, _failed
    _n += 1
    print(f"{'ok' if ok else 'not ok'} {_n} - {name.replace('#', '')}")
    if not ok:
        _failed += 1
        for line in str(detail).splitlines()[:30]:
            print("#   " + line)
    sys.stdout.flush()
    return ok


def skip(name, why):
    global _n
    _n += 1
    print(f"ok {_n} - {name.replace('#', '')} # SKIP {why}")


def done():
    print(f"1..{_n}")
    sys.exit(1 if _failed else 0)
