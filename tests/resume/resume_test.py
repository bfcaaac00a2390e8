#!/usr/bin/env python3
"""`sim --resume`: a run that is interrupted anyhow goes on to the same bytes; what does not fit is refused in words.
Usage: resume_test.py PLEUEL"""
import json
import os
import pathlib
import random
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from tap import check, done  # noqa: E402

program = os.path.abspath(sys.argv[1])
scratch = tempfile.TemporaryDirectory(prefix="pleuel resume ")      # a blank in the path on purpose
os.chdir(scratch.name)
seed = int(os.environ.get("RESUME_SEED", time.time_ns() % 100000))
dice = random.Random(seed)
clean = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG", "PLEUEL_LANG"))}
print(f"# dice {seed}")

MODEL = """param m = 1, l = 1, g = 9.81
coord x1, y1, x2, y2
axes x right, y up
mass m at (x1, y1)
mass m at (x2, y2)
gravity g along -y
constraint a: x1^2 + y1^2 = l^2
constraint b: (x2 - x1)^2 + (y2 - y1)^2 = l^2
init x1 = 1, y1 = 0, x2 = 2, y2 = 0, x1' = 0, x2' = 0
event side: when x1 = 0.9 -> record
simulate 0..400
"""
model = pathlib.Path("two pendulums.pleuel")
model.write_text(MODEL)
ROWS, PART, STATE = pathlib.Path("run.csv"), pathlib.Path("run.csv.part"), pathlib.Path("run.csv.resume")


def sim(*flags, output="run.csv", env=None):
    return subprocess.run([program, "sim", str(model), "-o", output, *flags], capture_output=True, text=True, env={**clean, **(env or {})})


def told(r):
    return f"exit {r.returncode}\n{r.stdout[-500:]}\n{r.stderr}\n{sorted(os.listdir())}"


def interrupt(how, part, *flags):
    """Starts the run and interrupts it when that part of the rows is there (and a state, for what gives no time to write one)."""
    child = subprocess.Popen([program, "sim", str(model), "-o", "run.csv", *flags], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             text=True, env=clean)
    while child.poll() is None:
        ready = STATE.exists() or how != signal.SIGKILL
        if ready and PART.exists() and PART.stat().st_size >= part * len(whole):
            child.send_signal(how)
            break
        time.sleep(0.001)
    out, err = child.communicate()
    return subprocess.CompletedProcess([], child.returncode, out, err)


def begin_anew():
    for file in (ROWS, PART, STATE):
        file.unlink(missing_ok=True)


full = sim("--json", output="full.csv")
whole = pathlib.Path("full.csv").read_bytes()
check("the run itself", full.returncode == 0 and json.loads(full.stdout)["events"], told(full))
check("it leaves nothing beside its rows", sorted(os.listdir()) == ["full.csv", model.name], told(full))

# ------------------------------------------------------------------------------------------------ interrupted and resumed
r = interrupt(signal.SIGINT, 0.2 + 0.2 * dice.random())
check("Ctrl-C ends it, keeps rows and state, and tells how it goes on",
      r.returncode == 130 and ROWS.exists() and STATE.exists() and not PART.exists() and "# incomplete" in ROWS.read_text()
      and "to go on:" in r.stdout, told(r))
command = re.search(r"to go on: +pleuel (.*)", r.stdout)
again = shlex.split(command.group(1)) if command else []
r = subprocess.run([program, *again, "--json"], capture_output=True, text=True, env=clean)
check("the command that was told goes on to the same rows", r.returncode == 0 and ROWS.read_bytes() == whole, told(r))
check("and to the same summary with all events", r.stdout == full.stdout, told(r))
check("then the state is gone", not STATE.exists() and not PART.exists(), told(r))

for word, signals in (("Ctrl-C and SIGTERM", [signal.SIGINT, signal.SIGTERM, signal.SIGINT]),
                      ("kill -9", [signal.SIGKILL, signal.SIGKILL]),
                      ("all of them", [signal.SIGKILL, signal.SIGINT, signal.SIGKILL])):
    begin_anew()
    flags, at, stopped = [], 0, 0
    for s in signals:
        at += 0.1 + 0.15 * dice.random()
        r = interrupt(s, at, "--checkpoint", "0.02", *flags)
        stopped += r.returncode in (130, -signal.SIGKILL)
        if r.returncode == 0:
            break
        flags = ["--resume"]
    engine = dice.choice(["interpreter", "compiled"])
    r = sim("--json", "--engine", engine, *flags) if flags and r.returncode else r
    check(f"interrupted by {word}, several times, it ends with the same rows", stopped and ROWS.read_bytes() == whole, f"{stopped} {told(r)}")
    check(f"interrupted by {word}: the same summary", r.stdout == full.stdout or r.returncode == 130, told(r))

# ------------------------------------------------------------------------------------------------ what is refused
begin_anew()
r = interrupt(signal.SIGINT, 0.3, "--json")
kept = json.loads(r.stdout)
check("JSON tells where the state is and how to go on",
      kept["status"] == "interrupted" and kept["resume"]["state"] == "run.csv.resume" and kept["resume"]["command"].endswith("--resume"), told(r))
rows, state = ROWS.read_bytes(), STATE.read_bytes()


def restore():
    begin_anew()
    ROWS.write_bytes(rows)
    STATE.write_bytes(state)
    model.write_text(MODEL)


def refused(name, code, words, *flags, env=None):
    r = sim("--resume", *flags, env=env)
    intact = STATE.exists() and not PART.exists()
    check(f"refused in words: {name}", r.returncode == code and words in r.stderr + r.stdout and intact, told(r))


refused("another --tol", 2, "another --tol: it was -, now it is 1e-09", "--tol", "1e-9")
refused("another --until", 2, "another --until: it was 400, now it is 500", "--until", "500")
refused("another --set", 2, "another --set", "--set", "g=9.7")
refused("another --method", 2, "another --method: it was auto, now it is taylor", "--method", "taylor")
refused("another --dt", 2, "another --dt", "--dt", "0.5")
refused("other sensitivities", 2, "another --sensitivities", "--sensitivities", "g")
refused("told in German", 2, "gehört zu einer Rechnung mit anderem --dt", "--dt", "0.5", env={"PLEUEL_LANG": "de"})
model.write_text(MODEL.replace("9.81", "9.82"))
refused("another text of the model", 2, "another text of two pendulums.pleuel")
restore()
ROWS.write_bytes(rows[:100] + b"7" + rows[101:])
refused("rows that were edited", 7, "the rows were changed")
ROWS.write_bytes(rows[:len(rows) // 2])
refused("rows that were cut", 7, "rows are missing")
check("rows that do not fit stay as they are", ROWS.read_bytes() == rows[:len(rows) // 2])
restore()
STATE.write_bytes(state[:-1])
refused("a state that was cut", 7, "is damaged")
STATE.write_bytes(b"")
refused("an empty state", 7, "is damaged")
bad = []
for i in range(12):
    at = dice.randrange(len(state))
    STATE.write_bytes(state[:at] + bytes([state[at] ^ dice.randrange(1, 256)]) + state[at + 1:])
    r = sim("--resume")
    if r.returncode != 7 or "is damaged" not in r.stderr + r.stdout or ROWS.read_bytes() != rows:
        bad.append(f"byte {at}: {told(r)}")
check("a state of which any byte was changed is refused", not bad, "\n".join(bad))
restore()
r = sim()
check("a new run does not go over an interrupted one", r.returncode == 7 and "--resume goes on with it" in r.stderr and STATE.read_bytes() == state, told(r))
ROWS.unlink()
r = sim()
check("nor when only the state is there", r.returncode == 7 and "--resume goes on with it" in r.stderr, told(r))
r = sim("--resume")
check("a state without its rows is no use", r.returncode == 7 and "are gone" in r.stderr, told(r))
restore()
r = sim("-f", "--until", "1")
check("-f begins anew and forgets the state", r.returncode == 0 and not STATE.exists() and ROWS.stat().st_size < len(rows), told(r))
r = sim("--resume")
check("nothing to resume", r.returncode == 7 and "nothing to go on from" in r.stderr and "without --resume" in r.stderr, told(r))
r = sim("--resume", output="-")
check("--resume needs a file", r.returncode == 2 and "-o FILE.csv" in r.stderr, told(r))
r = sim("-f", "--checkpoint", "soon")
check("--checkpoint takes a time", r.returncode == 2 and "soon" in r.stderr, told(r))

# ------------------------------------------------------------------------------------------------ rows behind the state
restore()
PART.write_bytes(rows + b"half a row, 1, 2")
ROWS.unlink()
r = sim("--resume", "-v")
check("rows behind the state, as kill -9 leaves them, are cut off", r.returncode == 0 and ROWS.read_bytes() == whole and "went on from" in r.stdout, told(r))
restore()
PART.write_bytes(rows)
r = sim("--resume")
check("another file under the name of the rows is not gone over", r.returncode == 7 and "-f replaces it" in r.stderr and ROWS.read_bytes() == rows, told(r))

# ------------------------------------------------------------------------------------------------ two at a time
begin_anew()
child = subprocess.Popen([program, "sim", str(model), "-o", "run.csv"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=clean)
while not PART.exists() or PART.stat().st_size < 1000:
    time.sleep(0.001)
r = sim()
child.send_signal(signal.SIGINT)
child.wait()
check("two runs do not write the same file", child.returncode == 0 or r.returncode == 7 and "another run writes" in r.stderr, told(r))
done()
