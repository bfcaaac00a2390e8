#!/usr/bin/env python3
"""The program as a user meets it: exit codes, streams, files, flags.  Usage: cli_test.py PLEUEL"""
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time

from tap import check, done, skip

program = os.path.abspath(sys.argv[1])
root = pathlib.Path(__file__).resolve().parent.parent.parent
examples = root / "examples"
ski = str(examples / "ski.pleuel")
atwood = str(examples / "atwood.pleuel")
clean = {k: v for k, v in os.environ.items() if k not in ("PLEUEL_LANG", "NO_COLOR", "LANG", "LC_ALL", "LC_MESSAGES", "COLUMNS")}
work = tempfile.TemporaryDirectory(prefix="pleuel test ")       # a blank in the path on purpose
os.chdir(work.name)

PENDULUM = """param m = 1 [kg], l = 0.5 [m], g = 9.81 [m/s^2]
coord x, y
axes x right, y up
mass m at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = l^2
init x = 0.3 [m], x' = 0
branch y < 0
simulate 0..1 [s]
"""


class Done:
    def __init__(self, arguments, text=None, env=None):
        run = subprocess.run([program, *arguments], input=(text or "").encode(), capture_output=True, timeout=60,
                             env={**clean, **(env or {})})
        self.code, self.out, self.err = run.returncode, run.stdout.decode("utf-8", "replace"), run.stderr.decode("utf-8", "replace")

    def __str__(self):
        return f"exit {self.code}\n--- stdout\n{self.out}--- stderr\n{self.err}"


def run(*arguments, text=None, env=None):
    return Done(arguments, text, env)


def write(name, text):
    pathlib.Path(name).write_text(text, encoding="utf-8")
    return name


# ------------------------------------------------------------------------------------------------ help
r = run()
check("pleuel alone prints twelve lines", r.code == 0 and r.out.count("\n") == 12 and not r.err, r)
check("and does not promise verbs of later versions", not re.search(r"\b(studio|sweep|lsp)\b", r.out), r)
check("--version names the version", re.match(r"pleuel \d+\.\d+\.\d+\n$", run("--version").out), run("--version"))
for verb in ["solve", "check", "sim", "fmt", "new", "examples", "explain", "units", "dump", "completion", "help",
             "report", "tex", "plot", "animate", "export"]:
    r = run(verb, "-h")
    check(f"{verb} -h fits on a screen", r.code == 0 and 3 <= r.out.count("\n") <= 24 and not r.err, r)
    check(f"help {verb} says the same", run("help", verb).out == r.out, r)
for verb in ["sweep", "studio", "lsp"]:
    r = run(verb, ski)
    check(f"{verb} is honest about not being there", r.code == 2 and not r.out and "this version" in r.err, r)

# ------------------------------------------------------------------------------------------------ wrong usage
r = run("chek", ski)
check("a mistyped verb gets a suggestion", r.code == 2 and "check" in r.err and not r.out, r)
r = run("solve", "--onyl", "b", ski)
check("a mistyped flag gets a suggestion", r.code == 2 and "--only" in r.err, r)
r = run("solve", "--math", "3d", ski)
check("a wrong choice lists the choices", r.code == 2 and "line|2d|ascii" in r.err, r)
r = run("check", "-", text="param l = 2 [m]\ncoord φ\nmass 1 [kg] at (l sin φ, l cos φ)\nconstraint c: φ = 5 [m]\n")
check("a number that has its unit is not given another", r.code == 3 and "E021" in r.out and "write it" not in r.out + r.err, r)
r = run("solve", ski, "--only")
check("a flag without its value is named", r.code == 2 and "--only" in r.err, r)
check("-x is named", "-x" in run("solve", "-x", ski).err)
check("a missing file argument is wrong usage", run("solve").code == 2)
r = run("solve", "nowhere.pleuel")
check("a missing file has exit code 7", r.code == 7 and "nowhere.pleuel" in r.err and not r.out, r)
check("a folder instead of a file has exit code 7", run("solve", ".", text="").code == 7, run("solve", "."))
r = run("check", "--set", "m", ski)
check("--set without = is wrong usage", r.code == 2, r)
r = run("sim", ski, "--until", "soon")
check("a time that is none is wrong usage", r.code == 2 and "until" in r.err, r)
r = run("sim", ski, "-o", "x.h5")
check("other formats than CSV are refused by name", r.code == 2 and ".h5" in r.err, r)

# ------------------------------------------------------------------------------------------------ check
r = run("check", ski)
check("check of a right model is content", r.code == 0 and "consistent" in r.out, r)
wrong = write("wrong.pleuel", PENDULUM.replace("mass m at (x, y)", "mass m at (x, z9)"))
r = run("check", wrong)
check("check names code, line and caret", r.code == 3 and re.search(r"^wrong\.pleuel:4: E\d+  ", r.out, re.M) and "^" in r.out, r)
r = run("check", "--terse", wrong)
check("check --terse is one line a message", r.code == 3 and re.match(r"wrong\.pleuel:4:\d+: E\d+: ", r.out), r)
r = run("check", "--json", wrong)
try:
    document = json.loads(r.out)
    check("check --json is one document with the error in it", r.code == 3 and document["pleuel"] == 1
          and any(n["severity"] == "error" for n in document["notes"]) and not r.err, r)
except ValueError as e:
    check("check --json is one document with the error in it", False, f"{e}\n{r}")
r = run("check", ski, wrong)
check("several files get a header each, the worst code counts", r.code == 3 and r.out.count("==> ") == 2, r)
r = run("check", "--json", ski, wrong)
check("several files give one document", r.code == 3 and len(json.loads(r.out)["documents"]) == 2, r)
r = run("check", "-", text=PENDULUM)
check("- is stdin", r.code == 0 and "<stdin>" in r.out, r)
r = run("check", "-", text=PENDULUM.replace("branch y < 0\n", ""))
check("two solutions that fit the start are E043, exit 4", r.code == 4 and "E043" in r.out and "branch y" in r.out, r)
linkage = """param a = 1 [m], b = 3 [m], c = 2.5 [m], d = 3 [m], m = 1 [kg], g = 9.81 [m/s^2]
coord α, β, γ
axes x right, y up
mass B: m at (a cos α + b cos β, a sin α + b sin β)
mass C: m at (d + c/2 cos γ, c/2 sin γ)
gravity g along -y
constraint lx: a cos α + b cos β - c cos γ = d
constraint ly: a sin α + b sin β - c sin γ = 0
init α = 60°, α' = 0
simulate 0..0.1 [s]
"""
r = run("sim", "-", "-o", "-", text=linkage)
check("of two assemblies the nearer one is taken, and that is said", r.code == 0 and "N073" in r.err and
      "branch sin β > 0" in r.err, r)
taken = r.out
r = run("sim", "-", "-o", "-", text=linkage + "branch sin β > 0\n")
check("the proposed branch takes the same one without a word", r.code == 0 and r.out == taken and "N073" not in r.err, r)
r = run("sim", "-", "-o", "-", text=linkage + "branch sin β < 0\n")
check("the other branch takes another one", r.code == 0 and r.out != taken and "N073" not in r.err, r)
loop = linkage.replace("init α = 60°,", "init α = 60°, β = 30°, γ = 1.5,")
r = run("check", "-", text=loop)
check("one start value cannot close a loop of two equations", r.code == 4 and "would fit" not in r.out, r)
crank = linkage.replace("constraint lx: a cos α + b cos β - c cos γ = d\n", "").replace("init α = 60°,", "init α = 60°, β = 30°, γ = 20°,")
r = run("check", "-", text=crank)
fits = re.search(r"= γ = (-?[\d.]+°)", r.out)
check("a value that would fit is given as the text has it", r.code == 4 and fits is not None, r)
if fits:
    r = run("check", "-", text=crank.replace("γ = 20°", "γ = " + fits.group(1)))
    check("and is accepted when it is typed", r.code == 0, r)
r = run("check", "-", text=PENDULUM.replace("branch y < 0\n", "constraint bar: x^2 + y^2 = 4 l^2\n").replace("x = 0.3 [m],", "x = 0.3 [m], y = 0.2 [m],"))
check("constraints that contradict each other are E042 whatever the start is", r.code == 4 and "E042" in r.out and "E041" not in r.out, r)
r = run("check", "-", text=PENDULUM.replace("x = 0.3 [m], x' = 0", "x = 0.3 [m], y = -0.3 [m], x' = 0"))
check("a start off the constraint is E041, exit 4", r.code == 4 and "E041" in r.out, r)
r = run("check", wrong, env={"PLEUEL_LANG": "de"})
german = r.out
check("PLEUEL_LANG chooses the language", r.code == 3 and german != run("check", wrong).out, r)
check("--lang wins over PLEUEL_LANG", run("check", "--lang", "en", wrong, env={"PLEUEL_LANG": "de"}).out == run("check", wrong).out)
check("the locale chooses the language", run("check", wrong, env={"LC_ALL": "de_DE.UTF-8"}).out == german)
check("--color always colours", "\033[" in run("check", "--color", "always", wrong).out)
check("no colour into a pipe", "\033[" not in run("check", wrong).out)

# ------------------------------------------------------------------------------------------------ solve
r = run(atwood)
check("pleuel FILE solves", r.code == 0 and "Atwood" in r.out and r.out == run("solve", atwood).out, r)
check("the answer alone is on stdout", "note" not in r.err, r.err)
r = run("solve", "--json", atwood)
document = json.loads(r.out) if r.out else {}
check("solve --json is one document", r.code == 0 and document.get("pleuel") == 1 and document.get("status") == "ok", r)
check("same input, same bytes", run("solve", "--json", atwood).out == r.out)
check("--timing fills timing_ms", json.loads(run("solve", "--json", "--timing", atwood).out or "{}").get("timing_ms"), r)
r = run("solve", "--json", wrong)
check("solve --json of a wrong model is a document too", r.code == 3 and json.loads(r.out)["status"] != "ok", r)
r = run("solve", wrong)
check("the messages of a wrong model go to stderr", r.code == 3 and not r.out and "E0" in r.err, r)
r = run("solve", "--only", "c", atwood)
check("--only leaves the other parts out", r.code == 0 and " c) " in r.out and " b) " not in r.out, r)
r = run("solve", "--math", "ascii", "--lang", "de", atwood)
check("--math ascii is ASCII, also in German", r.code == 0 and r.out.isascii() and "lambda" in r.out, r)
expect = PENDULUM + "ask expect T = m/2 (x'^2 + y'^2)\n"
r = run("-", "--no-simulation", text=expect)
check("an expect that is right has exit code 0", r.code == 0, r)
r = run("-", "--no-simulation", text=expect.replace("m/2", "m/3"))
check("an expect that is wrong has exit code 1", r.code == 1, r)
r = run("-", text="coord x\nmass 1 at (x)\nconstraint a: x = 1\nconstraint b: x = 2\n")
check("constraints that contradict each other have exit code 4", r.code == 4, r)

quartic = "param a\ncoord x\nmass a at (x)\npotential 1/2 a x^4\nask solve x(t)\n"
r = run("-", text=quartic)
check("a closed form that is not found is a note", r.code == 0 and "No elementary closed form" in r.out, r)
check("and an error with --strict", run("solve", "--strict", "-", text=quartic).code == 5)
r = run("solve", str(examples / "chain.pleuel"))
check("a big family is left to sim, and that is said", r.code == 0 and "pleuel sim" in r.out, r)
with open(program, "rb") as whole, open("program.pleuel", "wb") as part:   # a program with sanitizers passes the limit of a text
    part.write(whole.read(1 << 20))
r = run("check", "program.pleuel")
check("a program is no model, and not every byte of it is told", r.code == 3 and r.out.count("\n") < 400 and " more messages" in r.out, r.out[:300])
check("neither is nothing", run("solve", "-", text="").code == 3)

# ------------------------------------------------------------------------------------------------ sim
r = run("sim", ski)
check("sim alone tells the events", r.code == 0 and "lets go" in r.out and "ground" in r.out, r)
r = run("sim", ski, "-o", "ski.csv")
rows = pathlib.Path("ski.csv").read_text().splitlines() if os.path.exists("ski.csv") else [""]
check("sim -o writes a CSV with names and units", r.code == 0 and rows[0].startswith("t [s],r [m],theta [rad],r_dot [m/s],theta_dot [rad/s],lambda"), rows[0])
check("its rows have as many fields as its header", len({row.count(",") for row in rows}) == 1, rows[:3])
check("nothing is left beside it", [n for n in os.listdir(".") if n.startswith("ski.csv") and n != "ski.csv"] == [], os.listdir("."))
before = pathlib.Path("ski.csv").read_bytes()
r = run("sim", ski, "-o", "ski.csv", "--until", "1")
check("a file is not overwritten without -f", r.code == 7 and pathlib.Path("ski.csv").read_bytes() == before and "-f" in r.err, r)
r = run("sim", ski, "-o", "ski.csv", "--until", "1", "-f")
last = pathlib.Path("ski.csv").read_text().splitlines()[-1]
check("-f replaces it, and the last row is exactly at the end", r.code == 0 and float(last.split(",")[0]) == 1.0, last)
r = run("sim", ski, "-o", "-", "--until", "500[ms]", "--dt", "0.125")
times = [float(line.split(",")[0]) for line in r.out.splitlines()[1:]]
check("times may carry units; --dt sets the rows; -o - is stdout", r.code == 0 and times == [0, .125, .25, .375, .5], r)
r = run("sim", ski, "--json")
document = json.loads(r.out) if r.out else {}
kinds = [e["kind"] for e in document.get("events", [])]
check("sim --json has the events", r.code == 0 and "release" in kinds and document["status"] == "ok", r)
release = next((e for e in document.get("events", []) if e["kind"] == "release"), {"state": {"theta": 0}})
import math
want = math.acos(2 / 3 * math.cos(math.radians(1)))
check("the skier leaves at acos(2/3 cos 1°)", abs(release["state"]["theta"] - want) < 1e-11, release)
r = run("sim", ski, "--set", "R=5[m]", "--set", "m=80", "--json")
other = next(e for e in json.loads(r.out)["events"] if e["kind"] == "release")
check("and the angle does not depend on R and m", abs(other["state"]["theta"] - want) < 1e-11 and abs(other["state"]["r"] - 5) < 1e-12, other)
r = run("sim", "-", text=PENDULUM.replace("simulate 0..1 [s]\n", ""))
check("a model without simulate line asks for --until", r.code == 2 and "--until" in r.err, r)
r = run("sim", "-", "--until", "1", text=PENDULUM.replace("m = 1 [kg]", "m").replace("simulate 0..1 [s]\n", ""))
check("a parameter without number is named", r.code == 2 and "m" in r.err and "--set" in r.err, r)
r = run("sim", "-", "--set", "q7=1", text=PENDULUM)
check("--set of a name that is not there fails", r.code in (2, 3) and "q7" in r.err, r)
r = run("sim", ski, "-o", "nowhere/ski.csv")
check("an output that cannot be written has exit code 7", r.code == 7, r)

# Ctrl-C: what is there is kept and marked
long_run = write("long.pleuel", PENDULUM.replace("0..1 [s]", "0..1000000 [s]"))
p = subprocess.Popen([program, "sim", long_run, "-o", "long.csv"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=clean)
time.sleep(0.7)
p.send_signal(signal.SIGINT)
try:
    p.communicate(timeout=20)
    tail = pathlib.Path("long.csv").read_text().splitlines()[-1] if os.path.exists("long.csv") else ""
    check("Ctrl-C keeps the rows, marks the file and exits with 130", p.returncode == 130 and tail.startswith("# incomplete"), f"{p.returncode} {tail}")
except subprocess.TimeoutExpired:
    p.kill()
    check("Ctrl-C keeps the rows, marks the file and exits with 130", False, "did not stop")

# progress: a line on a terminal, nothing else
try:
    pid, fd = pty.fork()
except OSError as e:
    skip("a terminal sees progress after half a second", f"no terminal can be opened here ({e})")
else:
    if pid == 0:
        os.execve(program, [program, "sim", long_run, "--until", "100000"], {**clean, "TERM": "xterm"})
    seen = b""
    end = time.time() + 5
    while time.time() < end and b"eta" not in seen:
        try:
            seen += os.read(fd, 4096)
        except OSError:
            break
    os.kill(pid, signal.SIGINT)
    os.waitpid(pid, 0)
    os.close(fd)
    check("a terminal sees progress after half a second", b"sim " in seen and b"% " in seen and b"eta" in seen, seen[-200:])

# ------------------------------------------------------------------------------------------------ fmt, new, examples
r = run("new", "first steps")
check("new writes a model", r.code == 0 and os.path.exists("first steps.pleuel"), r)
check("and does not overwrite it", run("new", "first steps").code == 7)
check("its title is the name", 'system "first steps"' in pathlib.Path("first steps.pleuel").read_text())
r = run("first steps.pleuel")
check("the new model solves", r.code == 0, r)
r = run("fmt", "--check", "first steps.pleuel")
check("the new model is laid out canonically", r.code == 0, r)
messy = write("messy.pleuel", PENDULUM.replace("coord x, y", "coord   x,y").replace("mass m", "mass    m"))
r = run("fmt", "--check", messy)
check("fmt --check names the file and changes nothing", r.code == 1 and r.out == "messy.pleuel\n" and "x,y" in pathlib.Path(messy).read_text(), r)
r = run("fmt", messy)
check("fmt formats in place", r.code == 0 and "coord x, y" in pathlib.Path(messy).read_text() and run("fmt", "--check", messy).code == 0, r)
r = run("fmt", "--ascii", "-o", "-", ski)
check("fmt --ascii writes ASCII outside of comments and texts", r.code == 0 and re.sub(r'#.*|"[^"]*"', "", r.out).isascii(), r)
r = run("fmt", wrong.replace("wrong", "syntax"))
check("fmt of a missing file has exit code 7", r.code == 7, r)
broken = write("broken.pleuel", "param m = = 3\n")
r = run("fmt", broken)
check("fmt leaves a file with errors alone", r.code == 3 and pathlib.Path(broken).read_text() == "param m = = 3\n", r)
r = run("examples")
names = [line.split()[0] for line in r.out.splitlines()]
check("examples lists the examples", r.code == 0 and {"atwood", "crank", "ski"} <= set(names) and sorted(names) == sorted(p.stem for p in examples.glob("*.pleuel")), r)
for name in names:
    check(f"example {name} is the file", run("examples", name).out == (examples / f"{name}.pleuel").read_text(encoding="utf-8"))
    check(f"example {name} has no errors", run("check", "-", text=run("examples", name).out).code == 0, run("check", str(examples / f"{name}.pleuel")))
r = run("examples", "atwod")
check("a mistyped example gets a suggestion", r.code == 2 and "atwood" in r.err, r)
r = run("examples", "atwood", "-o", "copy.pleuel")
check("examples -o copies", r.code == 0 and pathlib.Path("copy.pleuel").read_text(encoding="utf-8") == run("examples", "atwood").out, r)

# ------------------------------------------------------------------------------------------------ explain, units, dump
codes = [line.split()[0] for line in run("explain").out.splitlines()]
check("explain lists the messages", len(codes) > 10 and "E021" in codes, codes)
for code in codes:
    check(f"explain {code} has a page with an example", "## Example" in run("explain", code).out or "## How to mend" in run("explain", code).out, run("explain", code).out)
check("explain takes lower case", run("explain", "e021").out == run("explain", "E021").out)
check("an unknown code is wrong usage", run("explain", "E999").code == 2)
r = run("units", "km/h")
check("units km/h tells dimension and factor", r.code == 0 and "m/s" in r.out and ("5/18" in r.out or "0.2777" in r.out), r)
r = run("units", "kmm")
check("an unknown unit is wrong usage", r.code == 2 and not r.out, r)
for after in ["check", "derive", "record"]:
    r = run("dump", f"--after={after}", atwood)
    check(f"dump --after={after} prints something", r.code == 0 and len(r.out.splitlines()) > 5, r)

# ------------------------------------------------------------------------------------------------ completion
r = run("completion", "bash")
check("completion bash is bash", r.code == 0 and subprocess.run(["bash", "-n"], input=r.out.encode()).returncode == 0, r)
script = r.out + '\nCOMP_WORDS=(pleuel so); COMP_CWORD=1; _pleuel; echo "${COMPREPLY[@]}"\n' \
    + f'COMP_WORDS=(pleuel solve "{atwood}" --only ""); COMP_CWORD=4; _pleuel; echo "${{COMPREPLY[@]}}"\n' \
    + f'compopt() {{ :; }}; COMP_WORDS=(pleuel sim "{atwood}" --set m); COMP_CWORD=4; _pleuel; echo "${{COMPREPLY[@]}}"\n'
said = subprocess.run(["bash"], input=script.encode(), capture_output=True, env={**clean, "PATH": os.path.dirname(program) + ":" + clean["PATH"]}).stdout.decode().splitlines()
check("it completes verbs", said[:1] == ["solve"], said)
check("and the letters of a file", said[1:2] == ["b c d e"], said)
check("and parameters", said[2:3] == ["m1= m2="], said)
for shell in ["zsh", "fish"]:
    r = run("completion", shell)
    check(f"completion {shell} names every verb", r.code == 0 and all(v in r.out for v in ["solve", "check", "sim", "fmt", "units"]), r)
check("another shell is wrong usage", run("completion", "csh").code == 2)
work.cleanup()
done()
