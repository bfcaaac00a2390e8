"""Work-precision plots as SVG, without a plotting library: relative error (right to left smaller) against CPU time, both logarithmic."""
import math

COLOURS = ["#0b5fff", "#00a0c6", "#d1495b", "#8f5bb5", "#2a9d5c", "#e08e0b", "#7a7a7a", "#b35900", "#444444",
           "#c2185b", "#5d4037", "#00897b"]
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 420, 300, 62, 34, 12, 44


def panel(title, series, colours, x0, y0):
    """series: name -> [(error, us)]."""
    points = [p for s in series.values() for p in s]
    low_e, high_e = -16, -2
    low_u = math.floor(min(math.log10(u) for _, u in points))
    high_u = math.ceil(max(math.log10(u) for _, u in points))
    w, h = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def x(error):
        return x0 + LEFT + w * (high_e - min(max(math.log10(error), low_e), high_e)) / (high_e - low_e)

    def y(us):
        return y0 + TOP + h * (high_u - math.log10(us)) / (high_u - low_u)
    out = [f'<text x="{x0 + LEFT}" y="{y0 + 22}" class="title">{title}</text>']
    for k in range(low_e, high_e + 1, 2):
        out.append(f'<line x1="{x(10.0**k):.1f}" y1="{y0 + TOP}" x2="{x(10.0**k):.1f}" y2="{y0 + TOP + h}" class="grid"/>'
                   f'<text x="{x(10.0**k):.1f}" y="{y0 + TOP + h + 15}" class="tick" text-anchor="middle">1e{k}</text>')
    for k in range(low_u, high_u + 1):
        name = {0: "1 µs", 1: "10 µs", 2: "100 µs", 3: "1 ms", 4: "10 ms", 5: "100 ms", 6: "1 s", 7: "10 s"}.get(k, f"1e{k} µs")
        out.append(f'<line x1="{x0 + LEFT}" y1="{y(10.0**k):.1f}" x2="{x0 + LEFT + w}" y2="{y(10.0**k):.1f}" class="grid"/>'
                   f'<text x="{x0 + LEFT - 5}" y="{y(10.0**k) + 4:.1f}" class="tick" text-anchor="end">{name}</text>')
    out.append(f'<text x="{x0 + LEFT + w / 2}" y="{y0 + HEIGHT - 10}" class="tick" text-anchor="middle">relative error at the end</text>')
    for name, line in series.items():
        if not line:
            continue
        own = name.startswith("pleuel")
        path = " ".join(f"{x(e):.1f},{y(u):.1f}" for e, u in line)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colours[name]}" stroke-width="{2.6 if own else 1.3}"/>')
        out += [f'<circle cx="{x(e):.1f}" cy="{y(u):.1f}" r="{2.6 if own else 1.8}" fill="{colours[name]}"/>' for e, u in line]
    return out


def plot(panels):
    """panels: [(title, series)].  Two side by side, the legend in the last place."""
    names = list(dict.fromkeys(n for _, s in panels for n in s if s[n]))
    colours = {n: COLOURS[i % len(COLOURS)] for i, n in enumerate(names)}
    rows = (len(panels) + 2) // 2
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {2 * WIDTH} {rows * HEIGHT}" font-family="sans-serif">',
           "<style>.grid{stroke:#ddd;stroke-width:.6}.tick{font-size:10px;fill:#555}.title{font-size:14px;font-weight:bold;fill:#222}"
           ".name{font-size:12px;fill:#222}</style>", f'<rect width="{2 * WIDTH}" height="{rows * HEIGHT}" fill="#fff"/>']
    for i, (title, series) in enumerate(panels):
        out += panel(title, series, colours, (i % 2) * WIDTH, (i // 2) * HEIGHT)
    x0, y0 = (len(panels) % 2) * WIDTH + LEFT, (len(panels) // 2) * HEIGHT + TOP
    for i, name in enumerate(names):
        out.append(f'<line x1="{x0}" y1="{y0 + 20 * i}" x2="{x0 + 26}" y2="{y0 + 20 * i}" stroke="{colours[name]}" '
                   f'stroke-width="{2.6 if name.startswith("pleuel") else 1.3}"/><text x="{x0 + 34}" y="{y0 + 20 * i + 4}" class="name">{name}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"
