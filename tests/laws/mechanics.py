"""Random mechanical systems, and their accelerations and constraint forces from d'Alembert's principle in Cartesian coordinates.

A system is a list of particles; each hangs on the one before it (or on the suspension, which may be driven) by a rod, moves on a
curve or an incline, on a surface, in a turning plane, or is free.  It can be written as a model in several coordinates, and each
constraint in several spellings; forces and motion must not care.
"""

import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "founding"))
from formulas import Formula  # noqa: E402
from taylor import Taylor, evaluate, solve_linear  # noqa: E402

SPELLINGS = ["plain", "root", "normalised", "product", "reversed", "halved", "growing"]
UNITS = {"m": "kg", "l": "m", "g": "m/s^2", "k": "N/m", "c": "kg/s", "F": "N", "a": "1/m", "b": "1/m", "A": "m", "w": "1/s", "al": "1", "V": "m/s",
         "e": "1"}


class Particle:
    """One mass.  cartesian: its coordinates; place: its position in generalized coordinates, texts; q: those coordinates."""

    def __init__(self, number, kind, dimension):
        self.number, self.kind = number, kind
        self.cartesian = [f"{axis}{number}" for axis in "xyz"[:dimension]]
        self.label, self.mass = f"P{number}", f"m{number}"
        self.place, self.q, self.q_unit = [], [], []
        self.bonds = []   # (label, left, right, whether both sides are positive, length scale or None)


class System:
    def __init__(self, seed, dimension=None, n=None, driven=None, loads=True, dissipative=True, kinds=None):
        self.seed = seed
        self.rng = random.Random(seed)
        self.dimension = dimension or self.rng.choice([2, 2, 2, 3])
        self.parameters = {}
        self.particles = []
        self.loads = []
        self.dissipative = dissipative
        self.driven = self.rng.random() < 0.35 if driven is None else driven
        self.parameter("g", 9.81)
        self.suspend()
        for k in range(n or self.rng.choice([1, 1, 2])):
            self.attach(k + 1, kinds)
        if loads:
            self.add_loads()

    # ------------------------------------------------------------------------------------------ making
    def parameter(self, name, value=None):
        self.parameters[name] = value if value is not None else round(self.rng.uniform(0.4, 2.4), 2)
        return name

    def suspend(self):
        self.anchor = ["0"] * self.dimension
        if not self.driven:
            return
        how = self.rng.choice(["shaken", "lifted", "carried"])
        if how == "shaken":
            self.anchor[0] = f"{self.parameter('A0')}*sin({self.parameter('w0')}*t)"
        elif how == "lifted":
            self.anchor[-1] = f"{self.parameter('V0')}*t"
        else:
            self.anchor[0] = f"{self.parameter('V0')}*t"

    def before(self, k):
        return self.particles[k - 2].cartesian if k > 1 else self.anchor

    def place_before(self, k):
        return self.particles[k - 2].place if k > 1 else self.anchor

    def attach(self, k, kinds):
        if kinds is None:
            kinds = ["rod", "rod", "bead", "incline", "polar", "free"] if self.dimension == 2 else ["rod", "bowl", "turning", "free"]
        kind = self.rng.choice(kinds)
        p = Particle(k, kind, self.dimension)
        self.parameter(p.mass)
        getattr(self, "attach_" + kind)(p, k)
        self.particles.append(p)

    def apart(self, p, k):
        return [f"{a} - ({b})" if b != "0" else a for a, b in zip(p.cartesian, self.before(k))]

    def attach_rod(self, p, k):
        l = self.parameter(f"l{k}")
        if self.dimension == 2:
            p.q, p.q_unit = [f"u{k}"], ["1"]
            direction = [f"sin(u{k})", f"(-cos(u{k}))"]
        else:
            p.q, p.q_unit = [f"u{k}", f"s{k}"], ["1", "1"]
            direction = [f"sin(u{k})*cos(s{k})", f"sin(u{k})*sin(s{k})", f"(-cos(u{k}))"]
        p.place = [f"{b} + {l}*{d}" if b != "0" else f"{l}*{d}" for b, d in zip(self.place_before(k), direction)]
        squares = " + ".join(f"({d})^2" for d in self.apart(p, k))
        p.bonds.append((f"rod{k}", squares, f"{l}^2", True, l))

    def attach_bead(self, p, k):
        shape = self.rng.choice(["parabola", "wave", "cubic"])
        x, y, q = *p.cartesian, f"q{k}"
        p.q, p.q_unit = [q], ["m"]
        a = self.parameter(f"a{k}")
        if shape == "parabola":
            curve = "{a}*{x}^2"
        elif shape == "wave":
            curve = "sin({b}*{x})/{a}"
            self.parameter(f"b{k}")
        else:
            curve = "{a}^2*{x}^3"
        p.place = [q, curve.format(a=a, b=f"b{k}", x=q)]
        p.bonds.append((f"wire{k}", y, curve.format(a=a, b=f"b{k}", x=x), False, f"(1/{a})"))

    def attach_incline(self, p, k):
        x, y = p.cartesian
        p.q, p.q_unit = [f"q{k}"], ["m"]
        al = self.parameter(f"al{k}", round(self.rng.uniform(0.2, 1.2), 2))
        p.place = [f"q{k}*cos({al})", f"q{k}*sin({al})"]
        p.bonds.append((f"slope{k}", f"{y}*cos({al})", f"{x}*sin({al})", False, self.parameter(f"l{k}")))

    def attach_polar(self, p, k):
        p.q, p.q_unit = [f"r{k}", f"u{k}"], ["m", "1"]
        p.place = [f"{b} + r{k}*{d}" if b != "0" else f"r{k}*{d}" for b, d in zip(self.place_before(k), [f"sin(u{k})", f"(-cos(u{k}))"])]
        self.loads.append(("spring", self.parameter(f"k{k}"), f"l{k}", k, k - 1))
        self.parameter(f"l{k}")

    def attach_free(self, p, k):
        p.q, p.q_unit = [f"q{k}{axis}" for axis in "xyz"[: self.dimension]], ["m"] * self.dimension
        p.place = list(p.q)

    def attach_bowl(self, p, k):
        x, y, z = p.cartesian
        a = self.parameter(f"a{k}")
        p.q, p.q_unit = [f"r{k}", f"s{k}"], ["m", "1"]
        p.place = [f"r{k}*cos(s{k})", f"r{k}*sin(s{k})", f"{a}*r{k}^2"]
        p.bonds.append((f"bowl{k}", z, f"{a}*({x}^2 + {y}^2)", True, f"(1/{a})"))

    def attach_turning(self, p, k):
        x, y, z = p.cartesian
        l, w = self.parameter(f"l{k}"), self.parameter(f"w{k}")
        p.q, p.q_unit = [f"u{k}"], ["1"]
        p.place = [f"{l}*sin(u{k})*cos({w}*t)", f"{l}*sin(u{k})*sin({w}*t)", f"(-{l}*cos(u{k}))"]
        p.bonds.append((f"hoop{k}", f"{x}^2 + {y}^2 + {z}^2", f"{l}^2", True, l))
        p.bonds.append((f"plane{k}", f"{y}*cos({w}*t)", f"{x}*sin({w}*t)", False, l))

    def add_loads(self):
        n = len(self.particles)
        for _ in range(self.rng.choice([0, 1, 1, 2])):
            k = self.rng.randint(1, n)
            kinds = ["spring", "force", "field"] + (["drag", "damper", "push"] if self.dissipative else [])
            kind = self.rng.choice(kinds)
            number = len(self.loads) + 11
            if any(l[0] in ("spring", "damper") for l in self.loads) and kind in ("spring", "damper"):
                continue   # at most one more square root
            if kind == "spring":
                self.loads.append(("spring", self.parameter(f"k{number}"), self.parameter(f"l{number}"), k, 0 if n == 1 else (k % n) + 1))
            elif kind == "damper":
                self.loads.append(("damper", self.parameter(f"c{number}"), None, k, 0 if n == 1 else (k % n) + 1))
            elif kind == "drag":
                self.loads.append(("drag", self.parameter(f"c{number}"), None, k, None))
            elif kind == "field":
                self.loads.append(("field", self.parameter(f"k{number}"), None, k, None))
            elif kind == "push":
                self.loads.append(("push", self.parameter(f"F{number}"), self.parameter(f"w{number}"), k, None))
            else:
                self.loads.append(("force", self.parameter(f"F{number}"), None, k, None))

    # ------------------------------------------------------------------------------------------ writing models
    def spelled(self, bond, spelling):
        _, left, right, positive, length = bond
        if spelling == "root" and positive:
            return f"sqrt({left}) = sqrt({right})"
        if spelling == "normalised":
            return f"({left} - {right})/{length}^2 = 0" if not positive else f"({left})/({right}) = 1"
        if spelling == "product":
            return f"({left})*(1 + x1^2/{length}^2) = ({right})*(1 + x1^2/{length}^2)"
        if spelling == "reversed":
            return f"{right} = {left}"
        if spelling == "halved":
            return f"({left} - ({right}))/2 = 0"
        if spelling == "growing":
            return f"exp(x1/{length})*({left} - ({right})) = 0"
        return f"{left} = {right}"

    def unit(self, name):
        return UNITS["al" if name.startswith("al") else name[0]]

    def header(self, units, scale):
        lines = []
        for name, value in self.parameters.items():
            unit = self.unit(name) if units else ""
            if units and scale and unit == "m":
                unit, value = "mm", value * 1000
            elif units and scale and unit == "kg":
                unit, value = "g", value * 1000
            lines.append(f"param {name} = {value!r}" + (f" [{unit}]" if unit else ""))
        return lines

    def physics(self, positions, anchor):
        lines = ["axes " + ("x right, y up" if self.dimension == 2 else "x right, y out, z up")]
        for p, at in zip(self.particles, positions):
            lines.append(f"mass {p.label}: {p.mass} at ({', '.join(at)})")
        lines.append("gravity g along -" + "xyz"[self.dimension - 1])
        for number, (kind, size, more, k, other) in enumerate(self.loads):
            where = "(" + ", ".join(anchor) + ")" if not other else f"P{other}"
            if kind == "spring":
                lines.append(f"spring {size}, rest {more} between P{k} and {where}")
            elif kind == "damper":
                lines.append(f"damper {size} between P{k} and {where}")
            elif kind == "drag":
                lines.append(f"drag {size} on P{k}")
            elif kind == "field":
                lines.append(f"potential {size}/2*({positions[k - 1][0]})^2")
            else:
                push = size if kind == "force" else f"{size}*cos({more}*t)"
                lines.append(f"force F{number}: ({push}" + ", 0" * (self.dimension - 1) + f") on P{k}")
        return lines

    def bonds(self):
        return [b for p in self.particles for b in p.bonds]

    def cartesian_model(self, spellings=None, units=True, scale=False, extra=(), transform=None):
        """Cartesian coordinates and constraints.  transform: texts for the Cartesian position in other coordinates."""
        rename = {}
        positions = [list(p.cartesian) for p in self.particles]
        names = [c for p in self.particles for c in p.cartesian]
        if transform:
            positions, rename, names = transform(self)
        lines = self.header(units, scale)
        lines.append("coord " + ", ".join(n + (" [m]" if units else "") for n in names))
        lines += self.physics(positions, self.anchor)
        for j, b in enumerate(self.bonds()):
            text = self.spelled(b, spellings[j] if spellings else "plain")
            lines.append(f"constraint {b[0]}: " + replaced(text, rename))
        return "\n".join(lines + list(extra)) + "\n"

    def generalized_model(self, units=True, scale=False, extra=()):
        """Generalized coordinates, no constraint at all."""
        lines = self.header(units, scale)
        for p in self.particles:
            lines.append("coord " + ", ".join(q + (f" [{u}]" if units and u != "1" else "") for q, u in zip(p.q, p.q_unit)))
        lines += self.physics([p.place for p in self.particles], self.anchor)
        return "\n".join(lines + list(extra)) + "\n"

    def chosen_model(self, units=True, scale=False, extra=(), spellings=None):
        """Cartesian coordinates with constraints, and generalized ones chosen."""
        lines = self.header(units, scale)
        for p in self.particles:
            lines.append("coord " + ", ".join(c + (" [m]" if units else "") for c in p.cartesian))
            lines.append("coord " + ", ".join(q + (f" [{u}]" if units and u != "1" else "") for q, u in zip(p.q, p.q_unit)))
        lines += self.physics([p.cartesian for p in self.particles], self.anchor)
        for j, b in enumerate(self.bonds()):
            lines.append(f"constraint {b[0]}: " + self.spelled(b, spellings[j] if spellings else "plain"))
        maps = [f"{c} = {place}" for p in self.particles for c, place in zip(p.cartesian, p.place)]
        lines.append("choose " + ", ".join(q for p in self.particles for q in p.q) + " with " + ", ".join(maps))
        return "\n".join(lines + list(extra)) + "\n"

    def forces_asked(self):
        return [f"ask force of {b[0]}" for b in self.bonds()]

    def accelerations_asked(self):
        return ["ask " + ", ".join(f"solve {c}''" for p in self.particles for c in p.cartesian)]

    # ------------------------------------------------------------------------------------------ states and the reference
    def state(self, rng):
        """Generalized coordinates and velocities, and t: a dict of numbers."""
        s = {"t": rng.uniform(0.1, 0.9)}
        for p in self.particles:
            for q in p.q:
                s[q], s[q + "_dot"] = rng.uniform(0.35, 1.15), rng.uniform(-0.8, 0.8)
        return s

    def series(self, s, acceleration=None):
        """Names as series in time; accelerations of the generalized coordinates are zero unless given."""
        out = {k: Taylor(v) for k, v in self.parameters.items()}
        out["t"] = Taylor(s["t"], 1)
        for p in self.particles:
            for q in p.q:
                out[q] = Taylor.path(s[q], s[q + "_dot"], (acceleration or {}).get(q, 0.0))
        return out

    def cartesian(self, s, acceleration=None):
        """Positions, velocities and accelerations of all particles."""
        names = self.series(s, acceleration)
        return [[evaluate(Formula(text).tree, names) for text in p.place] for p in self.particles]

    def names(self, s):
        """Everything that a formula of an answer may contain, as numbers."""
        out = dict(self.parameters, **s)
        for p, at in zip(self.particles, self.cartesian(s)):
            for c, x in zip(p.cartesian, at):
                out[c], out[c + "_dot"] = x.value, x.rate
        return out

    def load(self, s):
        """Applied forces on the particles, by hand."""
        at = self.cartesian(s)
        names = self.series(s)
        anchor = [evaluate(Formula(a).tree, names) for a in self.anchor]
        d, par = self.dimension, self.parameters
        F = [[0.0] * d for _ in self.particles]
        for p, f in zip(self.particles, F):
            f[d - 1] -= par[p.mass] * par["g"]
        for kind, size, more, k, other in self.loads:
            X = at[k - 1]
            f = F[k - 1]
            if kind in ("spring", "damper"):
                Y = at[other - 1] if other else anchor
                gap = [a - b for a, b in zip(X, Y)]
                length = math.sqrt(sum(g.value**2 for g in gap))
                e = [g.value / length for g in gap]
                rate = sum(g.rate * ei for g, ei in zip(gap, e))
                tension = par[size] * (length - par[more]) if kind == "spring" else par[size] * rate
                for c in range(d):
                    f[c] -= tension * e[c]
                    if other:
                        F[other - 1][c] += tension * e[c]
            elif kind == "drag":
                for c in range(d):
                    f[c] -= par[size] * X[c].rate
            elif kind == "field":
                f[0] -= par[size] * X[0].value
            elif kind == "force":
                f[0] += par[size]
            else:
                f[0] += par[size] * math.cos(par[more] * s["t"])
        return F

    def reference(self, s):
        """Accelerations by Cartesian name and constraint forces by (label, particle): M a = F + sum lambda dg/dx, d2g/dt2 = 0."""
        d, par = self.dimension, self.parameters
        unknown = [c for p in self.particles for c in p.cartesian]
        mass = [par[p.mass] for p in self.particles for _ in p.cartesian]
        force = [x for f in self.load(s) for x in f]
        moved = {c: x for p, at in zip(self.particles, self.cartesian(s)) for c, x in zip(p.cartesian, at)}
        tree = [Formula(f"{b[1]} - ({b[2]})").tree for b in self.bonds()]

        def second(j, which):
            names = self.series(s)
            for i, c in enumerate(unknown):
                names[c] = Taylor.path(moved[c].value, moved[c].rate, 1.0 if i == which else 0.0)
            return evaluate(tree[j], names).acceleration

        n, m = len(unknown), len(tree)
        gamma = [second(j, -1) for j in range(m)]
        G = [[second(j, i) - gamma[j] for i in range(n)] for j in range(m)]
        A = [[mass[i] if i == k else 0.0 for k in range(n)] + [-G[j][i] for j in range(m)] for i in range(n)]
        A += [[G[j][i] for i in range(n)] + [0.0] * m for j in range(m)]
        x = solve_linear(A, force + [-y for y in gamma])
        if x is None:
            return None
        acceleration = dict(zip(unknown, x))
        forces = {}
        for j, b in enumerate(self.bonds()):
            for k, p in enumerate(self.particles):
                forces[b[0], p.label] = [x[n + j] * G[j][k * d + c] for c in range(d)]
        return acceleration, forces


def replaced(text, rename):
    """Names replaced by bracketed texts."""
    import re
    return re.sub(r"[A-Za-z_][A-Za-z_0-9]*", lambda m: f"({rename[m.group()]})" if m.group() in rename else m.group(), text)
