#!/usr/bin/env python3
"""Work and precision of motions beside other programs: relative error against CPU time, and ratios at equal error.

Usage: bench/motion_peers.py PLEUEL [--only NAME,...] [--svg FILE]     NAME of problems.py, or `stiff`

PLEUEL stands beside motion_kernel, the program that times pleuel's run alone.  Everybody integrates the same position-level
problem; peers that cannot do that get the reduced equations as straight-line C (straight.py), compiled with -O3 -march=native.  Times
are of the process clock, around the integration alone, best of repeated runs.  The error is the larger of |dq|/|q| and |dv|/|v| at
the end, in the largest norm, against a reference in quad precision (peer_quad.c) that shares no code with pleuel.
Environment: BENCH_PYTHON, an interpreter with heyoka and SciPy; without one a throw-away environment is made if the network is there.
BENCH_WITHOUT_NETWORK=1 leaves that out.
"""
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
cases = here.parent / "tests" / "cases"
LADDER = [10.0 ** -k for k in (4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16)]
IMPLICIT = [10.0 ** -k for k in (4, 6, 7, 8, 9, 10, 11, 12)]
HEYOKA = [1e-6, 1e-9, 1e-12, 1e-15]     # each is compiled anew
LEVELS = (1e-6, 1e-9, 1e-12)
PATIENCE_S = 240
MOST_LINES = 1000     # coordinates up to which heyoka is given its lines: it compiles each
IN_LARGE = ("CVODE Adams", "ARKODE ERK8", "GSL rk8pd")     # who runs in systems above

SUNDIALS = ("-lsundials_cvode -lsundials_arkode -lsundials_ida -lsundials_nvecserial -lsundials_sunmatrixdense -lsundials_sunlinsoldense "
            "-lsundials_sunlinsolspgmr -lsundials_sunnonlinsolfixedpoint").split()
KLU = ["-DWITH_KLU", "-I/usr/include/suitesparse", "-lsundials_sunlinsolklu", "-lsundials_sunmatrixsparse"]
C_PEERS = {      # name -> source, method, ladder
    "CVODE Adams": ("peer_sundials", "adams", LADDER[:-1]),
    "CVODE BDF": ("peer_sundials", "bdf", IMPLICIT),
    "ARKODE ERK8": ("peer_sundials", "erk8", LADDER[:-1]),
    "IDA (GGL)": ("peer_sundials", "ida", IMPLICIT[:-1]),
    "GSL rk8pd": ("peer_gsl", "rk8pd", LADDER[:-1]),
}


# ---------------------------------------------------------------------------------------------- building
def run(command, **more):
    try:
        return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=PATIENCE_S, **more)
    except subprocess.TimeoutExpired as late:
        return subprocess.CompletedProcess(command, 124, (late.stdout or b"").decode(), "out of time")


def written(path, text):
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def generate(folder, name, make):
    """The header of a system and its lines for heyoka, unless they stand from last time."""
    stamp = hashlib.sha256(b"".join((here / f).read_bytes() for f in ("straight.py", "problems.py", "chain_system.h"))).hexdigest()
    header, lines, mark = folder / f"{name}.h", folder / f"{name}.json", folder / f"{name}.stamp"
    if not (mark.exists() and mark.read_text() == stamp and header.exists()):
        import problems
        import straight
        header_text, lines_text = problems.by_hand(name) or (None, None)
        if header_text is None:
            system = make()
            header_text = straight.c_text(system)
            lines_text = {"n": system.n, "start": [float(x) for x in system.q0 + system.v0], "lines": system.accelerations()}
        written(header, header_text)
        written(lines, json.dumps(lines_text))
        mark.write_text(stamp)
    return header


def compiled(folder, source, name, flags, output=None):
    """The program, or None with the reason printed."""
    header, program = folder / f"{name}.h", folder / (output or f"{source}_{name}")
    files = [here / f"{source}.c", here / "peer_common.h", header]
    stamp, mark = hashlib.sha256(b"".join(f.read_bytes() for f in files) + repr(flags).encode()).hexdigest(), folder / f"{program.name}.made"
    if mark.exists() and mark.read_text() == stamp and program.exists():
        return program
    before = [f for f in flags if not f.startswith("-l")]
    after = [f for f in flags if f.startswith("-l")]
    done = run([os.environ.get("CC", "cc"), "-std=gnu17", "-O3", "-march=native", f'-DSYSTEM="{header}"', f"-I{here}", *before, here / f"{source}.c",
                "-o", program, *after, "-lm"])
    if done.returncode:
        return None
    mark.write_text(stamp)
    return program


def missing(peers):
    """Which sources cannot be built here, told once."""
    found = []
    for source, package, probe in (("peer_sundials", "libsundials-dev", "cvode/cvode.h"), ("peer_gsl", "libgsl-dev", "gsl/gsl_odeiv2.h")):
        if run(["cc", "-E", "-include", probe, "-x", "c", "/dev/null"]).returncode:
            print(f"{source[5:]} is not installed ({package}): left out")
            found.append(source)
    return found


def python_with(folder):
    """An interpreter with heyoka and SciPy (module -> interpreter)."""
    found = {}
    for candidate in filter(None, [os.environ.get("BENCH_PYTHON"), folder / "venv/bin/python", sys.executable]):
        for module in ("heyoka", "scipy"):
            if module not in found and pathlib.Path(candidate).exists() and run([candidate, "-c", f"import {module}"]).returncode == 0:
                found[module] = str(candidate)
    if len(found) < 2 and not os.environ.get("BENCH_WITHOUT_NETWORK"):
        venv = folder / "venv"
        if run([sys.executable, "-m", "venv", venv]).returncode == 0:
            for module in {"heyoka", "scipy"} - set(found):
                if run([venv / "bin/pip", "install", "-q", "--only-binary", ":all:", module]).returncode == 0:
                    found[module] = str(venv / "bin/python")
    for module in {"heyoka", "scipy"} - set(found):
        print(f"{module} is not installed: left out")
    return found


# ---------------------------------------------------------------------------------------------- runs
def reference(folder, name, end, steps):
    """State and multipliers at the end, and the difference of two step sizes."""
    program = compiled(folder, "peer_quad", name, ["-lquadmath"])
    kept = folder / f"{name}.reference"
    key = hashlib.sha256((folder / f"{name}.h").read_bytes() + (here / "peer_quad.c").read_bytes() + f"{end} {steps}".encode()).hexdigest()
    if kept.exists() and kept.read_text().startswith(key):
        values = kept.read_text().split()[1:]
        return [float(x) for x in values[1:]], float(values[0])
    rough, fine = ([float(x) for x in run([program, end, s]).stdout.split()] for s in (steps, 2 * steps))
    n = len(fine)
    off = max(abs(a - b) for a, b in zip(rough, fine)) / max(map(abs, fine)) if n and len(rough) == n else math.nan
    kept.write_text(" ".join([key, repr(off), *map(repr, fine)]))
    return fine, off


def error(state, exact, n):
    if len(state) < 2 * n or not all(map(math.isfinite, state[:2 * n])):
        return math.inf
    return max(max(abs(a - b) for a, b in zip(state[k:k + n], exact[k:k + n])) / max(map(abs, exact[k:k + n])) for k in (0, n))


def pleuel_curve(kernel, model, engine, end, exact, n, order, ladder=LADDER):
    curve = []
    for tolerance in ladder:
        once = run([kernel, model, engine, tolerance, end, 1])
        cost = next((float(line.split()[0]) for line in once.stdout.splitlines() if " us " in line), None)
        if once.returncode or cost is None:
            continue
        repeats = max(3, min(200, int(60e3 / max(cost, 1))))
        text = run([kernel, model, engine, tolerance, end, repeats]).stdout.splitlines()
        best = float(next(line.split()[1] for line in text if line.startswith("best")))
        rows = [list(map(float, line.split())) for line in text if line.startswith("  ") and len(line.split()) == 2][-n:]
        if engine == "compiled" and any("interpreted" in line for line in text):
            return []
        rows = [rows[k] for k in order(n)]
        curve.append((error([r[0] for r in rows] + [r[1] for r in rows], exact, n), best))
    return curve


def c_curve(program, method, end, exact, n, ladder):
    curve = []
    for tolerance in ladder:
        done = run([program, method, tolerance, end])
        lines = done.stdout.split("\n")
        if done.returncode == 0 and lines[0].startswith("us "):
            curve.append((error([float(x) for x in lines[2:] if x], exact, n), float(lines[0].split()[1])))
    return curve


def python_curve(interpreter, peer, system, end, exact, n, ladder, folder):
    done = run([interpreter, here / "peer_python.py", peer, system, end, *ladder], env=os.environ | {"BENCH_MOTION": str(folder)})
    curve = []
    for line in done.stdout.splitlines():
        words = line.split()
        if words[:1] == ["result"] and int(words[2]) >= 0:
            curve.append((error(list(map(float, words[3:])), exact, n), float(words[1])))
    if not curve and done.stderr:
        print(f"      {peer}: {done.stderr.strip().splitlines()[-1][:150]}")
    return curve


# ---------------------------------------------------------------------------------------------- what is told
def frontier(curve):
    """Only what nothing cheaper beats: errors falling, times rising."""
    best, kept = math.inf, []
    for e, us in sorted(((max(e, 1e-17), us) for e, us in curve if math.isfinite(e)), key=lambda p: p[1]):
        if e < best:
            kept.append((e, us))
            best = e
    return kept


def time_at(curve, level):
    """Microseconds to reach an error, log-log between neighbours of the frontier; None: not reached."""
    points = frontier(curve)
    before = None
    for e, us in points:
        if e <= level:
            if before is None:
                return us
            share = (math.log(before[0]) - math.log(level)) / (math.log(before[0]) - math.log(e))
            return math.exp(math.log(before[1]) + share * (math.log(us) - math.log(before[1])))
        before = (e, us)
    return None


def told(us):
    return "-" if us is None else f"{us:.0f}" if us >= 100 else f"{us:.1f}"


def table(title, curves, levels, note=""):
    own = [c for n, c in curves.items() if n.startswith("pleuel")]
    mine = [min(filter(None, (time_at(c, level) for c in own)), default=None) for level in levels]
    lines = [f"### {title}", ""] + ([note, ""] if note else [])
    lines += ["| µs of CPU (times the best of pleuel) | " + " | ".join(f"{x:.0e}".replace("e-0", "e-") for x in levels) + " | best error, µs there |",
              "|" + "---|" * (len(levels) + 2)]
    for name, curve in curves.items():
        cells = []
        for own_us, level in zip(mine, levels):
            us = time_at(curve, level)
            cells.append(told(us) + (f" ({us / own_us:.2g})" if us and own_us and not name.startswith("pleuel") else ""))
        last = frontier(curve)[-1:] or [(math.nan, None)]
        lines.append(f"| {name} | " + " | ".join(cells) + f" | {last[0][0]:.0e}, {told(last[0][1])} |")
    return "\n".join(lines) + "\n"


def in_pairs(n):
    """x[1..N], y[1..N] of a chain's model in the order x1, y1, x2, y2 of the system."""
    return [k // 2 + (k % 2) * (n // 2) for k in range(n)]


def motion(name, kernel, folder, pythons, left_out):
    import problems
    title, model, make, end, steps = problems.MOTIONS[name]
    end = float(end)
    generate(folder, name, make)
    exact, off = reference(folder, name, end, steps)
    n = json.loads((folder / f"{name}.json").read_text())["n"]
    order = in_pairs if model.startswith("chain") else lambda n: range(n)
    path = cases / f"{model}.pleuel"
    if not path.exists():
        path = written(folder / f"{model}.pleuel", problems.model_text(model))
    curves = {f"pleuel, {'compiled' if e == 'compiled' else 'interpreter'}": pleuel_curve(kernel, path, e, end, exact, n, order)
              for e in ("compiled", "interpreter")}
    if "heyoka" in pythons and n <= MOST_LINES:
        # unrolled code is faster, but takes minutes to compile for larger systems
        for peer, label in (("heyoka", "heyoka"), ("heyoka-compact", "heyoka, compact mode")):
            if n <= 50 or "compact" in peer:
                curves[label] = python_curve(pythons["heyoka"], peer, name, end, exact, n, HEYOKA, folder)
            if curves.get(label):
                break
    for peer, (source, method, ladder) in C_PEERS.items():
        if n > MOST_LINES and peer not in IN_LARGE:
            continue
        flags = (SUNDIALS + KLU if source == "peer_sundials" else ["-lgsl", "-lgslcblas"])
        program = None if source in left_out else compiled(folder, source, name, flags)
        curves[peer] = c_curve(program, method, end, exact, n, ladder) if program else []
    if "scipy" in pythons and n <= MOST_LINES:
        library = compiled(folder, "peer_library", name, ["-shared", "-fPIC"], f"lib{name}.so")
        curves["SciPy DOP853"] = python_curve(pythons["scipy"], "DOP853", str(library), end, exact, n, IMPLICIT, folder) if library else []
    return title + f", t = {end:g}", {k: c for k, c in curves.items() if c}, off


def stiff(kernel, folder, pythons, left_out):
    """The family of growing stiffness: name -> curves."""
    import problems
    found = []
    for k in problems.STIFF:
        name, end = f"stiff{k}", problems.STIFF_END
        generate(folder, name, lambda k=k: problems.stiff(10 ** k))
        exact, off = reference(folder, name, end, max(400, int(1.2 * 10 ** (k / 2))))
        model = written(folder / f"{name}.pleuel", problems.STIFF_MODEL.format(k=10 ** k))
        curves = {f"pleuel, {m}": pleuel_curve(kernel, model, m, end, exact, 4, lambda n: range(n), LADDER[:-4])
                  for m in ("compiled", "radau", "auto")}
        for peer in ("CVODE BDF", "IDA (GGL)"):
            source, method, ladder = C_PEERS[peer]
            program = None if source in left_out else compiled(folder, source, name, SUNDIALS + KLU)
            curves[peer] = c_curve(program, method, end, exact, 4, ladder) if program else []
        if "scipy" in pythons:
            library = compiled(folder, "peer_library", name, ["-shared", "-fPIC"], f"lib{name}.so")
            curves["SciPy Radau"] = python_curve(pythons["scipy"], "Radau", str(library), end, exact, 4, IMPLICIT[:6], folder) if library else []
        found.append((f"stiff spring, K = 1e{k}, t = {end}", {n: c for n, c in curves.items() if c}, off))
    return found


def main(arguments):
    import problems
    import svg_plot
    program = pathlib.Path(arguments[0]).resolve()
    options = dict(zip(arguments[1::2], arguments[2::2]))
    wanted = options.get("--only", ",".join([*problems.MOTIONS, "stiff"])).split(",")
    kernel = program.parent / "motion_kernel"
    if not kernel.exists():
        print("motion_kernel is not built beside the program: nothing to time")
        return 1
    folder = program.parent / "motion"
    folder.mkdir(exist_ok=True)
    left_out, pythons = missing(C_PEERS), python_with(folder)
    print("Motion: CPU microseconds of the integration alone to reach a relative error; in brackets: over the best of pleuel\n")
    panels = []
    for name in wanted:
        results = stiff(kernel, folder, pythons, left_out) if name == "stiff" else [motion(name, kernel, folder, pythons, left_out)]
        for title, curves, off in results:
            levels = (1e-4, 1e-6, 1e-9) if name == "stiff" else LEVELS
            print(table(title, curves, levels, f"Reference: two step sizes agree to {off:.0e}."), flush=True)
            panels.append((title, {n: frontier(c) for n, c in curves.items()}))
            with open(folder / "results.json", "w", encoding="utf-8") as file:
                json.dump(panels, file)
    if "--svg" in options:
        pathlib.Path(options["--svg"]).write_text(svg_plot.plot(panels), encoding="utf-8")
    return 0


if __name__ == "__main__":
    try:
        import sympy  # noqa: F401
    except ImportError:
        other = next((p for p in ("/usr/bin/python3", os.environ.get("SYMPY_PYTHON")) if p and run([p, "-c", "import sympy"]).returncode == 0), None)
        if not other or other == sys.executable:
            sys.exit(print("SymPy is not installed (python3-sympy): the right sides for the peers cannot be made; left out") or 0)
        os.execv(other, [other, *sys.argv])
    sys.exit(main(sys.argv[1:]))
