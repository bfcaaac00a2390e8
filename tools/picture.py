#!/usr/bin/env python3
"""Draws the picture of the README from what the program computes.  Usage: tools/picture.py PLEUEL OUT.svg

Left: the path of the skier of examples/ski.pleuel over the quarter circle, a dot every quarter of a second.  Right: the
force of the piste over the weight.  All numbers come from `pleuel sim`.
"""
import csv
import io
import json
import math
import pathlib
import subprocess
import sys

program, out = sys.argv[1:3]
model = pathlib.Path(__file__).resolve().parent.parent / "examples/ski.pleuel"


def simulate(*arguments):
    return subprocess.run([program, "sim", str(model), *arguments], capture_output=True, text=True, check=True).stdout


rows = [{k.split(" ")[0]: v for k, v in row.items()} for row in csv.DictReader(io.StringIO(simulate("-o", "-", "--dt", "0.02")))]
events = json.loads(simulate("--json"))["events"]
release = next(e for e in events if e["kind"] == "release")
R, weight = 20.0, 75 * 9.81

# path: metres to pixels
S, X0, Y0 = 11.0, 40.0, 262.0
path = [(float(r["t"]), float(r["r"]) * math.sin(float(r["theta"])), float(r["r"]) * math.cos(float(r["theta"]))) for r in rows]
line = " ".join(f"{X0 + S * x:.1f},{Y0 - S * z:.1f}" for _, x, z in path)
dots = [p for p in path if p[0] >= 4 and abs(p[0] * 4 - round(p[0] * 4)) < 1e-9]
th = release["state"]["theta"]
tx, tz = X0 + S * R * math.sin(th), Y0 - S * R * math.cos(th)

# force: seconds and multiples of the weight to pixels
t0, t1, PX, PW, PY, PH = 3.0, float(rows[-1]["t"]), 380.0, 250.0, 262.0, 200.0


def at(t, f):
    return PX + PW * (t - t0) / (t1 - t0), PY - PH * f


force = " ".join("{:.1f},{:.1f}".format(*at(float(r["t"]), float(r["lambda"]) / weight)) for r in rows if float(r["t"]) >= t0)
ticks = "".join(f'<text x="{at(t, 0)[0]:.1f}" y="{PY + 16}" text-anchor="middle">{t}</text>' for t in range(3, int(t1) + 1))
ticks += "".join(f'<text x="{PX - 6}" y="{at(t0, f)[1] + 4:.1f}" text-anchor="end">{f:g}</text>' for f in (0, 0.5, 1))
rx, ry = at(release["t"], 0)
circles = "".join(f'<circle cx="{X0 + S * x:.1f}" cy="{Y0 - S * z:.1f}" r="3"/>' for _, x, z in dots)

svg = f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 660 300" font-family="sans-serif" font-size="12" role="img"
 aria-label="The skier leaves the quarter circle at {math.degrees(th):.4f} degrees, where the force of the piste becomes zero.">
<rect width="660" height="300" fill="#fff"/>
<path d="M{X0},{Y0 - S * R} A{S * R},{S * R} 0 0 1 {X0 + S * R},{Y0} L{X0},{Y0} Z" fill="#e8eef4" stroke="#8aa0b4"/>
<line x1="{X0}" y1="{Y0}" x2="{X0 + 26 * S}" y2="{Y0}" stroke="#8aa0b4"/>
<line x1="{X0}" y1="{Y0}" x2="{tx:.1f}" y2="{tz:.1f}" stroke="#8aa0b4" stroke-dasharray="4 3"/>
<polyline points="{line}" fill="none" stroke="#1f5fa8" stroke-width="2"/>
<g fill="#1f5fa8">{circles}</g>
<circle cx="{tx:.1f}" cy="{tz:.1f}" r="5" fill="none" stroke="#c0392b" stroke-width="2"/>
<text x="{tx + 10:.1f}" y="{tz - 4:.1f}" fill="#c0392b">take-off, ϑ = {math.degrees(th):.4f}°</text>
<text x="{X0 + 4}" y="{Y0 + 16}">ski.pleuel: path, a dot every 0.25 s</text>
<line x1="{PX}" y1="{PY}" x2="{PX + PW}" y2="{PY}" stroke="#444"/><line x1="{PX}" y1="{PY}" x2="{PX}" y2="{PY - PH - 10}" stroke="#444"/>
<polyline points="{force}" fill="none" stroke="#1f5fa8" stroke-width="2"/>
<circle cx="{rx:.1f}" cy="{ry:.1f}" r="5" fill="none" stroke="#c0392b" stroke-width="2"/>
<g fill="#444">{ticks}<text x="{PX + 4}" y="{PY - PH - 14}">force of the piste / weight</text><text x="{PX + PW}" y="{PY + 30}" text-anchor="end">t in s</text></g>
</svg>
"""
pathlib.Path(out).write_text(svg, encoding="utf-8")
