#!/usr/bin/env python3
"""Pictures: SVG that any XML parser reads, curves where the data are, PNG and GIF decoded here, hostile names as text.

Usage: picture_test.py PLEUEL      The numbers that a plot shows are compared with what `pleuel sim` writes.
"""
import csv
import io
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
import zlib

root = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(root / "tests/cli"))
from tap import check, done, skip  # noqa: E402

program = os.path.abspath(sys.argv[1])
work = pathlib.Path(tempfile.mkdtemp())
env = {k: v for k, v in os.environ.items() if k != "PLEUEL_LANG"} | {"LC_ALL": "C.UTF-8"}
SVG = "{http://www.w3.org/2000/svg}"


def run(*arguments, text=None):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, cwd=work, env=env, input=text)


def model(name, text):
    path = work / name
    path.write_text(text, encoding="utf-8")
    return path


def parsed(path):
    return ET.parse(path).getroot()


def texts(svg):
    return ["".join(t.itertext()) for t in svg.iter(SVG + "text")]


def points(path):
    return [tuple(map(float, p.split(","))) for p in re.findall(r"-?[\d.]+,-?[\d.]+", path.get("d"))]


def of_class(svg, name, tag="path"):
    return [e for e in svg.iter(SVG + tag) if name in e.get("class", "").split()]


# ---------------------------------------------------------------------------------------------- what the model says about it
pendulum = """param m = 1, l = 1, g = 9.81
coord x, y
axes x right, y up
mass A: m at (x, y)
gravity g along -y
constraint stab: x^2 + y^2 = l^2
init x = 0.6, y = -0.8, x' = 0
simulate 0..1
"""


def drawing(name, extra):
    r = run("plot", model(name + ".pleuel", pendulum + extra), "-o", name + ".svg", "--show", "drawing")
    return r, parsed(work / (name + ".svg")) if r.returncode == 0 else None


r, plain = drawing("plain", "")
check("the plain drawing has axes and its weight", plain is not None and {"x", "y", "m g"} <= set(texts(plain)), r)
r, bare = drawing("bare", "draw hide axes, weight\n")
check("draw hide takes axes and weight out", bare is not None and not {"x", "m g"} & set(texts(bare)), r)
r, more = drawing("more", "draw spring between (0, -1.5) and A\ndraw rod between (1, 1) and A\n")
check("draw adds what is not in the model", more is not None and len(list(more.iter(SVG + "path"))) >= len(list(plain.iter(SVG + "path"))) + 1, r)
r, named = drawing("named", "animate force of stab\n")
check("animate names the arrows", named is not None and "m g" not in texts(named), r)
for line, what in [("draw foo between A and A", "cannot be drawn"), ("draw hide nothing", "there is no nothing"), ("draw hide trail of B", "not declared"),
                   ("draw colour axes", "not understood")]:
    r = run("check", model("bad.pleuel", pendulum + line + "\n"))
    check(f"{line}: an error with its place", r.returncode == 3 and what in (r.stdout + r.stderr).decode() and "bad.pleuel:9:" in (r.stdout + r.stderr).decode(), r)

# ---------------------------------------------------------------------------------------------- every model has a picture
shown = {"atwood": ["m₁", "m₂"], "crank": ["m₁", "φ"], "ski": ["ϑ", "m"], "ladder": ["ladder"], "caraxis": ["A", "B"], "hoop": ["θ"]}
for name, labels in shown.items():
    r = run("plot", root / f"examples/{name}.pleuel", "-o", f"{name}.svg", "--show", "drawing")
    fine = r.returncode == 0 and (work / f"{name}.svg").exists()
    found = texts(parsed(work / f"{name}.svg")) if fine else []
    check(f"{name} is drawn with its names", fine and all(x in found for x in labels), (r.stderr, found))

bad = []
for path in sorted((root / "tests/problems").glob("P??.pleuel")):
    if b"ask" in path.read_bytes() and run("check", path).returncode == 3:
        continue
    r = run("plot", path, "-o", "p.svg", "-f", "--show", "drawing")
    try:
        svg = parsed(work / "p.svg")
        shapes = [e for e in svg.iter() if e.tag in (SVG + "path", SVG + "circle")]
        numbers = [float(x) for e in shapes for x in re.findall(r"-?\d+(?:\.\d+)?", e.get("d", "") or e.get("cx", ""))]
        if r.returncode not in (0, 6) or len(shapes) < 2 or any(abs(x) > 1e5 for x in numbers):
            bad.append((path.name, r.returncode, len(shapes)))
    except (ET.ParseError, OSError) as e:
        bad.append((path.name, r.returncode, str(e), r.stderr[:200]))
check("every outside problem has a drawing that an XML parser reads", not bad, bad)

# ---------------------------------------------------------------------------------------------- geometry of a drawing
pendulum = model("pendulum.pleuel", """system "Pendulum"
param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]
coord x, y
axes x right, y up
mass P: m at (x, y)
gravity g along -y
constraint rod: x^2 + y^2 = l^2
init x = 1.2 [m], y = -1.6 [m], x' = 0
simulate 0..1 [s]
""")
run("plot", pendulum, "-o", "pendulum.svg", "--show", "drawing", "--no-forces")
svg = parsed(work / "pendulum.svg")
rod = points(of_class(svg, "pl-rod")[0])
mass = of_class(svg, "plf-mass", "circle")[0]
mx, my = float(mass.get("cx")), float(mass.get("cy"))
far = min(math.hypot(x - mx, y - my) for x, y in rod)
check("a rod ends at its mass", far < 0.2, (rod, mx, my))
(x0, y0), (x1, y1) = sorted(rod, key=lambda p: -math.hypot(p[0] - mx, p[1] - my))
check("and has the direction of the start", abs((x1 - x0) / (y1 - y0) - 1.2 / 1.6) < 0.01, rod)

atwood = parsed(work / "atwood.svg")
check("a rope over a pulley: rope, wheel, two masses", len(of_class(atwood, "pl-rope")) == 1 and len(of_class(atwood, "plf-body")) == 1
      and len(of_class(atwood, "plf-mass", "circle")) == 2)
compound = model("compound.pleuel", """param m = 1 [kg], g = 9.81 [m/s^2], a = 2 [m], b = 1 [m]
coord u, v, w, p
axes u down
mass A: 4 m at (u)
mass B: 2 m at (v)
mass C: m at (w)
gravity g along u
constraint first: u + p = a
constraint second: v + w - 2 p = b
""")
run("plot", compound, "-o", "compound.svg")
svg = parsed(work / "compound.svg")
centres = [float(c.get("cx")) for c in of_class(svg, "plf-mass", "circle")]
check("a pulley that hangs itself: two ropes, two wheels, masses beside each other", len(of_class(svg, "pl-rope")) == 2 and len(of_class(svg, "plf-body")) == 2
      and len(centres) == 3 and min(abs(a - b) for a in centres for b in centres if a != b) > 20, centres)
ladder = parsed(work / "ladder.svg")
(a, b), = [points(e)[:2] for e in of_class(ladder, "plf-body")]
check("a body that touches two planes stands between them", len(of_class(ladder, "pl-ground")) == 4 and a[0] != b[0] and a[1] != b[1], (a, b))
polar = model("polar.pleuel", pendulum.read_text().replace("coord x, y", "coord r, q").replace("at (x, y)", "at (r sin q, -r cos q)")
              .replace("x^2 + y^2 = l^2", "r = l").replace("init x = 1.2 [m], y = -1.6 [m], x' = 0", "init q = 0.6435011087932844, q' = 0"))
run("plot", polar, "-o", "polar.svg", "--show", "drawing", "--no-forces")
again = parsed(work / "polar.svg")
check("the same constraint in polar coordinates is a rod as well", len(of_class(again, "pl-rod")) == 1, ET.tostring(again)[:400])
slide = model("slide.pleuel", """param m = 1 [kg], g = 9.81 [m/s^2], b = 0.5
coord x [m], y [m]
axes x right, y up
mass m at (x, y)
gravity g along -y
constraint track: y = b x
init x = 1 [m], x' = 0
simulate 0..1 [s]
""")
run("plot", slide, "-o", "slide.svg", "--show", "drawing", "--no-forces")
svg = parsed(work / "slide.svg")
line = max((points(e) for e in of_class(svg, "pl-guide") + of_class(svg, "pl-ground")), key=len)
slopes = [-(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(line[::20], line[20::20])]
check("a curve has the slope that its equation says", slopes and all(abs(s - 0.5) < 0.02 for s in slopes), slopes)


# ---------------------------------------------------------------------------------------------- curves against data
def axis(svg, anchor, coordinate):
    """Pixel of a value from the two outermost ticks."""
    ticks = []
    for t in svg.iter(SVG + "text"):
        value = "".join(t.itertext()).replace("−", "-").replace(",", ".")
        if t.get("text-anchor") == anchor and re.fullmatch(r"-?\d+(\.\d+)?", value):
            ticks.append((float(value), float(t.get(coordinate)) - (4 if coordinate == "y" else 0)))
    (v0, p0), (v1, p1) = min(ticks), max(ticks)
    return lambda v: p0 + (v - v0) * (p1 - p0) / (v1 - v0)


fall = model("fall.pleuel", (root / "examples/ski.pleuel").read_text(encoding="utf-8").replace("plot λ/(m g), ϑ vs t", "plot ϑ vs t"))
run("plot", fall, "-o", "fall.svg", "--show", "plots")
svg = parsed(work / "fall.svg")
px, py = axis(svg, "middle", "x"), axis(svg, "end", "y")
curve = points(of_class(svg, "pl-s0")[0])
rows = list(csv.DictReader(io.StringIO(run("sim", fall, "-o", "-", "--dt", "0.25").stdout.decode())))
off = []
for row in rows:
    t, v = float(row["t [s]"]), float(row["theta [rad]"])
    near = [(a, b) for a, b in zip(curve, curve[1:]) if a[0] <= px(t) <= b[0] and b[0] > a[0]]
    if near:
        (xa, ya), (xb, yb) = near[0]
        off.append(abs(ya + (yb - ya) * (px(t) - xa) / (xb - xa) - py(v)))
check("a plotted curve runs where the data say", len(off) > 25 and max(off) < 1, off)
check("events are named", "h lets go" in texts(svg), texts(svg))
across = model("across.pleuel", """param m = 1 [kg], r = 1 [m], l = 3 [m], n = 2 [rad/s]
coord u, s
axes x right, y up
mass S: m at (s, 0)
constraint drive: u = n t
constraint rod: (s - r cos u)^2 + r^2 sin^2 u = l^2
branch s > 0
output push = m s''
simulate 0..1 [s]
plot norm(force(rod)), force(rod), s'', push vs t
""")
r = run("plot", across, "-o", "across.svg", "--show", "plots")
check("all quantities without a number are named", r.returncode == 0 and
      b"no curve: norm(force(rod)), force(rod)" in r.stderr, r.stderr)
check("accelerations and outputs have their curves", {"s̈ [m/s²]", "push [N]"} <= set(texts(parsed(work / "across.svg"))),
      texts(parsed(work / "across.svg")))
r = run("plot", root / "examples/chain.pleuel", "--set", "N=4", "--until", "0.1", "-o", "chain.svg", "--show", "plots")
check("the force of a member of a family has its curve", r.returncode == 0 and b"no curve" not in r.stderr and
      "norm(force(c[1])) [N]" in texts(parsed(work / "chain.svg")), r.stderr)
fourbar = model("fourbar.pleuel", """param W = 5 [rad/s], a = 0.1 [m], b = 0.3 [m], c = 0.25 [m], d = 0.3 [m], m = 1 [kg], g = 9.81 [m/s^2]
coord α, x, y, β, γ
axes x right, y up
body crank: mass m, inertia m a^2/12 at (a/2 cos α, a/2 sin α) angle α
body coupler: mass m, inertia m b^2/12 at (x, y) angle β
point A on coupler at (-b/2, 0)
body rocker: mass m, inertia m c^2/12 at (d + c/2 cos γ, c/2 sin γ) angle γ
gravity g along -y
constraint drive: α = W t
constraint j1x: x - b/2 cos β = a cos α
constraint j1y: y - b/2 sin β = a sin α
constraint j2x: x + b/2 cos β = d + c cos γ
constraint j2y: y + b/2 sin β = c sin γ
branch sin β > 0
simulate 0..0.1 [s]
""")
run("plot", fourbar, "-o", "fourbar.svg", "--show", "drawing")
shown = texts(parsed(work / "fourbar.svg"))
check("a force is drawn where it acts: at the joint, once", shown.count("j1x") == 1 and shown.count("j1y") == 1, shown)
check("no arrow where virtual work does not give a force", not {"drive", "j2x", "j2y"} & set(shown), shown)
crank = model("coupler.pleuel", """param m1 = 1 [kg], m2 = 2 [kg], r = 0.1 [m], l = 0.3 [m], g = 9.81 [m/s^2]
coord x1, y1, x2
mass A: m1 at (x1, y1)
mass B: m2 at (x2, 0)
gravity g along -y
constraint crank: x1^2 + y1^2 = r^2
constraint coupler: (x2 - x1)^2 + y1^2 = l^2
branch x2 > x1
init x1 = 0.06, y1 = 0.08, x1' = 0.4
simulate 0..0.1 [s]
""")
run("plot", crank, "-o", "coupler.svg", "--show", "drawing")
arrows = [(q[0] - p[0], q[1] - p[1]) for p, q in
          (points(a)[:2] for a in of_class(parsed(work / "coupler.svg"), "pl-force"))]
opposite = [(a, b) for i, a in enumerate(arrows) for b in arrows[i + 1:]
            if math.hypot(a[0] + b[0], a[1] + b[1]) < 0.05 * math.hypot(*a)]
rod = [math.atan2(b, a) for a, b in (p for p in opposite[:1] for p in p)]
slope = math.atan2(0.08, math.sqrt(0.3**2 - 0.08**2))
check("a rod to a mass on a guide pulls both of its ends along itself", len(opposite) == 1 and
      all(abs(math.sin(a - slope)) < 0.05 for a in rod), (arrows, slope))
phase = model("phase.pleuel", pendulum.read_text() + "plot y vs x\n")
run("plot", phase, "-o", "phase.svg", "--show", "plots")
svg = parsed(work / "phase.svg")
px, py = axis(svg, "middle", "x"), axis(svg, "end", "y")
curve = points(of_class(svg, "pl-s0")[0])
ux, uy = px(1) - px(0), py(1) - py(0)
radii = [math.hypot((x - px(0)) / ux, (y - py(0)) / uy) for x, y in curve]
check("a plot over another quantity: the pendulum stays on its circle", len(radii) > 20 and max(abs(r - 2) for r in radii) < 0.01, radii[:5])
r = run("plot", fall, "-o", "-", "--show", "plots", "--lang", "de")
german = ET.fromstring(r.stdout)
check("German: decimal comma and words", "h löst sich" in texts(german) and any(re.fullmatch(r"\d,\d", t) for t in texts(german)), texts(german))


# ---------------------------------------------------------------------------------------------- PNG, PDF, GIF
def png_pixels(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, body, size = 8, b"", None
    while at < len(data):
        n, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            size = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            body += data[at + 8:at + 8 + n]
        at += 12 + n
    return size, zlib.decompress(body)


def lzw(data, width):
    clear, out, kept, have, bits, table, last = 1 << width, bytearray(), 0, 0, width + 1, None, None
    for byte in data:
        kept |= byte << have
        have += 8
        while have >= bits:
            code, kept, have = kept & ((1 << bits) - 1), kept >> bits, have - bits
            if code == clear:
                table, bits, last = [bytes([i]) for i in range(clear)] + [b"", b""], width + 1, None
                continue
            if code == clear + 1:
                return bytes(out)
            if last is None:
                piece = table[code]
            else:
                piece = table[code] if code < len(table) else last + last[:1]
                if len(table) < 4096:
                    table.append(last + piece[:1])
                if len(table) == 1 << bits and bits < 12:
                    bits += 1
            out += piece
            last = piece
    raise ValueError("no end code")


def gif_frames(data):
    assert data[:6] == b"GIF89a"
    at, frames = 13 + 3 * (2 << (data[10] & 7)), []
    while data[at] != 0x3b:
        if data[at] == 0x21:
            at += 2
            frame = None
        else:
            _, _, w, h = struct.unpack("<HHHH", data[at + 1:at + 9])
            frame, at = (w, h, data[at + 10]), at + 11
        blocks = b""
        while data[at]:
            blocks += data[at + 1:at + 1 + data[at]]
            at += data[at] + 1
        at += 1
        if frame:
            frames.append(len(lzw(blocks, frame[2])) == frame[0] * frame[1])
    return struct.unpack("<HH", data[6:10]), frames


r = run("plot", pendulum, "-o", "p.png", "--size", "320x240")
if b"no cairo" in r.stderr:
    check("without cairo PNG is refused with a reason", r.returncode != 0 and not (work / "p.png").exists())
    skip("PNG, PDF and GIF", "this build has no cairo")
else:
    (w, h, depth, kind), pixels = png_pixels((work / "p.png").read_bytes())
    check("a PNG has the size that was asked for and is not blank", (w, h) == (320, 240) and len(set(pixels[i] for i in range(0, len(pixels), 7))) > 8, (w, h, depth, kind))
    run("plot", pendulum, "-o", "p.pdf")
    pdf = (work / "p.pdf").read_bytes()
    check("a PDF is one", pdf.startswith(b"%PDF-") and pdf.rstrip().endswith(b"%%EOF"))
    run("plot", pendulum, "-o", "q.pdf")
    check("the same input gives the same PDF", pdf == (work / "q.pdf").read_bytes())
    r = run("animate", pendulum, "-o", "p.gif", "--size", "160x140", "--fps", "8")
    size, frames = gif_frames((work / "p.gif").read_bytes())
    check("a GIF has its size and a frame for each moment, all of which decode", size == (160, 140) and len(frames) == 24 and all(frames),
          (r.stderr, size, frames[:3]))

# ---------------------------------------------------------------------------------------------- films
r = run("animate", pendulum, "-o", "p.svg", "-f", "--fps", "10")
svg = parsed(work / "p.svg")
groups = [g for g in svg.iter(SVG + "g") if "f" in g.get("class", "").split()]
style = "".join(svg.find(SVG + "style").itertext())
check("an SVG film has a group for each frame", len(groups) == 30, (r.stderr, len(groups)))
check("one of them is shown where motion is not wanted", sum("b" in g.get("class").split() for g in groups) == 1 and "prefers-reduced-motion" in style, style[-300:])
places = [float(c.get("cx")) for g in groups for c in g.iter(SVG + "circle") if "plf-mass" in c.get("class")]
check("the mass moves", len(places) == 30 and max(places) - min(places) > 50, places[:5])
missing = dict(env, PATH="/nonexistent")
r = subprocess.run([program, "animate", str(pendulum), "-o", "p.mp4"], capture_output=True, cwd=work, env=missing)
check("MP4 without ffmpeg says so and leaves no file", r.returncode == 7 and b"ffmpeg" in r.stderr and not (work / "p.mp4").exists(), r.stderr)
r = run("animate", model("still.pleuel", pendulum.read_text().replace("simulate 0..1 [s]", "")), "-o", "s.svg")
check("a film of no length asks how long", r.returncode == 2 and b"--until" in r.stderr, (r.returncode, r.stderr))

# ---------------------------------------------------------------------------------------------- rules of the program
r = run("plot", pendulum, "-o", "pendulum.svg")
check("a file that is there is not replaced", r.returncode == 7 and b"-f" in r.stderr, r.stderr)
for arguments in (["-o", "x.bmp"], [], ["-o", "x.svg", "--size", "12"], ["-o", "x.svg", "--size", "9x9"], ["-o", "x.svg", "--until", "soon"]):
    r = run("plot", pendulum, *arguments)
    check(f"plot {' '.join(arguments)} is refused", r.returncode == 2 and not (work / "x.svg").exists(), (r.returncode, r.stderr))
hostile = model("hostile.pleuel", pendulum.read_text().replace('"Pendulum"', '"</title></svg><script>alert(1)</script>&amp; \x07"'))
r = run("plot", hostile, "-o", "hostile.svg")
svg = parsed(work / "hostile.svg")
check("markup in a title is text", any("<script>" in t for t in texts(svg)) and not list(svg.iter(SVG + "script")), texts(svg)[:3])
check("a description is there for those who cannot see it", "rod" in svg.get("aria-label", ""), svg.get("aria-label"))
first = run("plot", pendulum, "-o", "-").stdout
check("the same input gives the same picture", first == run("plot", pendulum, "-o", "-").stdout)
done()
