"""heyoka and SciPy on a generated system.  Usage: peer_python.py heyoka|heyoka-compact|DOP853|Radau SYSTEM END TOLERANCE...

SYSTEM is the name of a motion in problems.py (heyoka) or the shared library of its right side (SciPy: the same compiled code as for the
C peers, called through ctypes).  Prints for each tolerance: microseconds (process clock, best of repeats), steps, state.
"""
import ctypes
import sys
import time


def repeated(once):
    best, spent, count = float("inf"), 0, 0
    while (count < 3 or spent < 0.06) and spent < 2:
        begin = time.process_time_ns()
        steps, state = once()
        used = (time.process_time_ns() - begin) / 1e9
        best, spent, count = min(best, used), spent + used, count + 1
    print("result", 1e6 * best, steps, *(f"{float(x):.17g}" for x in state), flush=True)


def with_heyoka(name, end, tolerances, compact):
    import heyoka
    import motion_lines
    lines, n, start = motion_lines.of(name)
    y = heyoka.make_vars(*[f"y{i}" for i in range(2 * n)])
    known = {"SIN": heyoka.sin, "COS": heyoka.cos, "SQRT": heyoka.sqrt, "LOG": heyoka.log, "K": lambda p, q: p / q, "t": heyoka.time}
    known |= {f"q{i}": y[i] for i in range(n)} | {f"v{i}": y[n + i] for i in range(n)}
    for target, text in lines:
        known[target] = eval(text, known)
    right = list(y[n:]) + [known[f"z_{i}"] for i in range(n)]
    for tolerance in tolerances:
        run = heyoka.taylor_adaptive(list(zip(y, right)), start, tol=tolerance, compact_mode=compact)

        def once():
            run.time, run.state[:] = 0.0, start
            outcome = run.propagate_until(end)
            return outcome[3], run.state
        repeated(once)


def with_scipy(method, library, end, tolerances):
    import numpy as np
    from scipy.integrate import solve_ivp
    code = ctypes.CDLL(library)
    double = ctypes.POINTER(ctypes.c_double)
    code.peer_slope.argtypes = [ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p]
    code.peer_jacobian.argtypes = code.peer_slope.argtypes
    size = code.peer_size()
    start = np.zeros(size)
    code.peer_start(start.ctypes.data_as(double))

    def f(t, y):
        y, out = np.ascontiguousarray(y), np.empty(size)
        code.peer_slope(t, y.ctypes.data, out.ctypes.data)
        return out

    def jacobian(t, y):
        y, out = np.ascontiguousarray(y), np.zeros((size, size), order="F")
        code.peer_jacobian(t, y.ctypes.data, out.ctypes.data)
        return out
    more = {"jac": jacobian} if method == "Radau" else {}
    for tolerance in tolerances:
        def once():
            found = solve_ivp(f, (0, end), start, method=method, rtol=max(tolerance, 3e-14), atol=tolerance, **more)
            return (len(found.t) if found.success else -1), found.y[:, -1]
        repeated(once)


if __name__ == "__main__":
    peer, system, end = sys.argv[1], sys.argv[2], float(sys.argv[3])
    tolerances = [float(x) for x in sys.argv[4:]]
    with_heyoka(system, end, tolerances, "compact" in peer) if peer.startswith("heyoka") else with_scipy(peer, system, end, tolerances)
