"""Random models for the law test: scenes with contacts, ropes, events, drives, families, bodies, in several spellings.

A scene is a text; what it means is read by model.py, so a generator cannot be wrong about its own model.
"""

import random
import re

# What a scene may contain.  A feature that is off is left out in `make test`; the reason stands beside it.
FEATURES = {
    "units": True,           # units, and numbers with units in formulas
    "numbers": True,         # numbers as masses and other given quantities
    "let": True,             # abbreviations
    "let_given": True,       # let a = g
    "stays": True,           # a mass that stays where it is
    "sticks": True,          # friction from rest
    "degenerate_rest": True,    # a force that begins with a cube
    "cosine_length": False,  # a length inside a cosine: rest modulo 2 pi is claimed to be all
    "free_fall": True,       # a lift that falls with g
    "open_contact": True,    # one-sided constraints that the start leaves open
    "closed_contact": True,
    "rope": True,            # <= between distances
    "release": True,         # release and attach by events
    "choose": True,          # choose with maps
    "choose_rope": True,     # the map of a rope that is slack
    "line_spring": True,     # springs on a line, whose length is an absolute value
    "contact_equilibria": True,   # positions of rest of models with contacts
    "choose_release": True,  # the map of a constraint that is released
    "velocity": True,        # starts with velocity
    "kinetic": True,
    "lagrangian": True,
    "total_derivative": True,   # parts of L that change no equation
    "family": True,
    "drive": True,           # f(t) in constraints, points or forces
    "friction": True,
    "damping": True,
    "body": True,
    "loop": True,
    "no_freedom": True,
    "nonholonomic": True,
    "where": True,
    "where_events": True,    # places behind a contact or an event
    "from": True,
    "equilibria": True,
    "closed_motion": True,
    "cartesian": True,       # no generalized coordinate of its own
}


def s_line(s):
    return s.on("line_spring")


class Scene:
    def __init__(self, seed, features=None, only=None):
        self.rng = random.Random(seed)
        self.features = dict(FEATURES) if features is None else dict(features)
        self.lines, self.asks, self.end = [], [], 1.0
        self.used = set()
        self.moving, self.constrained, self.letters = [], [], set()
        names = [n for n in RECIPES if not only or n in only]
        while not any(line.startswith("coord") for line in self.lines):
            self.lines, self.letters, self.used = [], set(), set()
            self.recipe = self.rng.choice(names)
            RECIPES[self.recipe](self)

    # -------------------------------------------------------------------------------------------- parts
    def on(self, feature, chance=1.0):
        """Whether a feature is allowed and drawn; remembers that it was."""
        drawn = self.rng.random() < chance
        if drawn and self.features.get(feature, True):
            self.used.add(feature)
            return True
        return False

    def one(self, *choices):
        return self.rng.choice(choices)

    def n(self, low, high, digits=2):
        return f"{round(self.rng.uniform(low, high), digits):g}"

    def line(self, *texts):
        self.lines += texts

    def param(self, name, low, high, unit):
        """A given quantity: a name, or its number with its unit where it stands."""
        if name != "g" and self.on("numbers", 0.12):
            return f"{self.n(low, high)} [{unit}]" if unit else self.n(low, high)
        if name not in self.letters:
            self.letters.add(name)
            self.line(f"param {name} = {self.n(low, high)}" + (f" [{unit}]" if unit else ""))
        if self.on("let", 0.08):
            self.line(f"let {name}_h = {name}/2")
            return f"2 {name}_h"
        return name

    def named(self, name, low, high, unit):
        """A given quantity that stays a name, since it stands more than once."""
        if name not in self.letters:
            self.letters.add(name)
            self.line(f"param {name} = {self.n(low, high)}" + (f" [{unit}]" if unit else ""))
        return name

    def weight(self, along="-y"):
        self.letters.add("g")
        self.line("param g = 9.81 [m/s^2]")
        if self.on("let_given", 0.15):
            self.line("let a_g = g")
            self.line(f"gravity a_g along {along}")
        else:
            self.line(f"gravity g along {along}")

    def mass(self, label, place, name=None):
        name = name or ("m" + label[-1] if label[-1].isdigit() else "m")
        self.line(f"mass {label}: {self.param(name, 0.5, 3, 'kg')} at {place}")
        self.moving.append(label)

    def loads(self, plane=True, conservative=False):
        """Forces of every kind on the masses."""
        for label in self.moving:
            roll = self.rng.random()
            anchor = f"({self.n(-1, 1)} [m], {self.n(1.2, 2)} [m])" if plane else f"({self.n(-1, 1)} [m])"
            if roll < 0.22 and (plane or s_line(self)):
                self.line(f"spring {self.param('k', 2, 20, 'N/m')}, rest {self.param('d', 0.2, 0.6, 'm')}"
                          f" between {label} and {anchor}")
            elif roll < 0.30 and not conservative and self.on("damping"):
                self.line(f"damper {self.param('c', 0.1, 1, 'N s/m')} between {label} and {anchor}")
            elif roll < 0.38 and not conservative and self.on("damping"):
                self.line(f"drag {self.param('b', 0.1, 1, 'N s/m')} on {label}")
            elif roll < 0.48:
                F = self.param("F", -3, 3, "N")
                self.line(f"force ({F}, 0) on {label}" if plane else f"force ({F}) on {label}")
            elif roll < 0.55 and not conservative and self.on("drive"):
                push = f"{self.param('F', 1, 3, 'N')} cos({self.n(1, 4)} [1/s] t)"
                self.line(f"force ({push}, 0) on {label}" if plane else f"force ({push}) on {label}")
        return self

    def velocity(self, low=-2, high=2):
        return self.n(low, high) if self.on("velocity", 0.7) else "0"

    def ask(self, *items):
        for i in items:
            self.asks.append(f"ask {i}")

    def usual(self, coords, labels=(), multipliers=()):
        """What is asked of every scene."""
        self.ask("dof, constraints", "lagrange1", "lagrange2", "conserved", "T, V")
        for x in coords:
            self.ask(f"solve {x}''")
        for c in multipliers:
            self.ask(f"solve λ_{c}", f"force of {c}")
        contact = any(re.match(r"constraint .*[<>]=", line) for line in self.lines)
        if (not contact or self.on("contact_equilibria")) and self.on("equilibria", 0.5):
            self.ask("equilibria")
        if self.on("closed_motion", 0.3):
            self.ask(f"solve {coords[0]}(t)")

    def meets(self, q, low, high, unit, multipliers=(), velocity=True):
        """Quantities where the motion meets a place."""
        ends = any(re.match(r"(constraint .*[<>]=|event)", line) for line in self.lines)
        if ends and not self.on("where_events") or not self.on("where", 0.6):
            return
        at = f"{q} = {self.n(low, high)}" + (f" [{unit}]" if unit else "")
        wanted = [f"{q}'", f"{q}''", "T"] + [f"λ_{c}" for c in multipliers]
        start = ""
        if self.on("from", 0.3):
            first = self.n(low, high)
            start = f" from {q} = {first}" + (f" [{unit}]" if unit else "") + " at rest"
        self.ask(f"{self.rng.choice(wanted)} where {at}{start}")

    def text(self):
        text = "\n".join(self.lines + self.asks) + f"\nsimulate 0..{self.end:g} [s]\n"
        units = self.recipe != "abstract" and self.on("units", 0.5)
        return text if units else re.sub(r" \[[^\]]*\]", "", text)


# ------------------------------------------------------------------------------------------------ scenes
def thrown(s):
    """A mass in the plane, with walls, floors and slopes that it may meet or lie on."""
    s.line("coord x, y", "axes x right, y up")
    s.mass("A", "(x, y)")
    s.weight()
    s.loads()
    x0, y0, vx, vy = s.n(-0.5, 0.5), s.n(0.6, 1.5), s.velocity(), s.velocity()
    contacts = []
    if s.on("open_contact", 0.5):
        contacts.append("floor")
        s.line(f"constraint floor: y >= {s.n(-1, 0.2)} [m]")
    elif s.on("closed_contact", 0.5):
        contacts.append("floor")
        y0, vy = s.n(0.1, 0.5), "0"
        s.line(f"constraint floor: y >= {y0} [m]")
    if s.on("open_contact", 0.3):
        contacts.append("wall")
        s.line(s.one(f"constraint wall: x <= {s.n(0.8, 2)} [m]", f"constraint wall: x >= {s.n(-2, -0.8)} [m]",
                     f"constraint wall: x + y <= {s.n(3, 4)} [m]"))
    if s.on("open_contact", 0.15):
        contacts.append("roof")
        s.line(f"constraint roof: y <= {s.n(1.6, 2.5)} [m]")
    for c in contacts:
        if s.rng.random() < 0.5:
            s.line(f"restitution {s.n(0, 0.9)} on {c}")
    s.line(f"init x = {x0} [m], y = {y0} [m], x' = {vx} [m/s], y' = {vy} [m/s]")
    s.usual(["x", "y"], ["A"], contacts)
    s.end = float(s.n(0.4, 1.2))


def pendulum(s):
    """A mass on a rod, rope or rail, in several spellings, at a place that may be driven."""
    l = s.named("l", 0.5, 1.5, "m")
    spelling = s.one("cartesian", "polar", "angle", "choose")
    kind = s.one("rod", "rod", "rope") if spelling != "angle" else "rod"
    if kind == "rope" and (not s.on("rope") or spelling == "choose" and not s.on("choose_rope")):
        kind = "rod"
    if spelling == "cartesian" and not s.on("cartesian"):
        spelling = "polar"
    if spelling == "choose" and not s.on("choose"):
        spelling = "angle"
    relation = "<=" if kind == "rope" else "="
    drive = f"{s.n(0.1, 0.3)} [m] sin({s.n(1, 5)} [1/s] t)" if s.on("drive", 0.2) else None
    x0, w = s.n(20, 160, 0), s.velocity(-3, 3)
    at_x = lambda f: f"{f} + {drive}" if drive else f  # noqa: E731
    multipliers = ["rod"] if spelling != "angle" else []
    if spelling == "angle":
        s.line("coord φ", "axes x right, y up")
        s.mass("A", f"({at_x(l + ' sin φ')}, -{l} cos φ)")
        s.line(f"init φ = {x0}°, φ' = {w} [1/s]")
        coords = ["φ"]
    elif spelling == "polar":
        s.line("coord r [m], φ", "axes x right, y up")
        s.mass("A", f"({at_x('r sin φ')}, -r cos φ)")
        s.line(f"constraint rod: r {relation} {l}")
        s.line(f"init r = {l}, φ = {x0}°, r' = 0, φ' = {w} [1/s]")
        coords = ["r", "φ"]
    else:
        s.line("coord x [m], y [m]" + (", φ" if spelling == "choose" else ""), "axes x right, y up")
        s.mass("A", "(x, y)")
        gap = f"(x - {drive})^2" if drive else "x^2"
        form = s.one(f"{gap} + y^2 {relation} {l}^2", f"sqrt({gap} + y^2) {relation} {l}")
        s.line(f"constraint rod: {form}")
        coords = ["x", "y"]
        if spelling == "choose":
            s.line(f"choose φ with x = {at_x(l + ' sin φ')}, y = -{l} cos φ")
            s.line(f"init φ = {x0}°, φ' = {w} [1/s]")
            coords = ["x", "φ"]
        elif s.rng.random() < 0.5 or drive:
            s.line("init x = 0 [m], y = -" + l + f", x' = {w} [m/s]")
        else:
            s.line("init x = 0.6 " + l + ", y = " + s.one("-", "") + "0.8 " + l + ", x' = 0, y' = 0")
    s.weight()
    s.loads()
    multipliers_known = list(multipliers)
    if s.on("open_contact", 0.15) and spelling != "angle":
        s.line(f"constraint ground: y(A) >= -{s.n(0.3, 0.9)} {l}")
        multipliers_known.append("ground")
    if multipliers and (spelling != "choose" or s.features.get("choose_release", True)) and s.on("release", 0.15):
        if spelling == "choose":
            s.used.add("choose_release")
        s.line(f"event cut: when t = {s.n(0.1, 0.5)} [s] -> release rod")
    s.usual(coords, ["A"], multipliers_known)
    if spelling in ("angle", "choose", "polar"):
        s.meets("φ", 0.2, 2.5, "", multipliers)


def oscillator(s):
    """One coordinate with a potential, a spring, drag or a drive."""
    kind = s.one("spring", "hill", "drag", "hanging")
    s.line("coord x [m]", "axes x right, y up" if kind == "hill" else "axes x down")
    if kind == "hill":
        form = s.one("0.3 x^2/(1 [m])", "0.4 [m] cos(x/(1 [m]))", "0.5 [m] sin(2 x/(1 [m]))", "0.7 x")
        s.mass("A", f"(x, {form})")
        s.weight()
    else:
        s.mass("A", "(x)")
        s.weight("x")
        k = s.param("k", 5, 30, "N/m")
        if kind != "drag" and not s.on("line_spring", 0.3):
            s.line(f"potential {k}/2 (x + {s.n(1, 3)} [m])^2")
        elif kind != "drag":
            s.line(f"spring {k}, rest {s.n(0.1, 0.6)} [m] between A and (-{s.n(1, 3)} [m])")
        if kind == "drag" and s.on("damping"):
            s.line(f"drag {s.param('b', 0.2, 1, 'N s/m')} on A")
        if kind == "hanging" and s.on("drive", 0.3):
            s.line(f"force ({s.n(1, 3)} [N] sin({s.n(1, 4)} [1/s] t)) on A")
    s.line(f"init x = {s.n(-0.6, 0.6)} [m], x' = {s.velocity()} [m/s]")
    if s.on("open_contact", 0.2):
        s.line(f"constraint stop: x <= {s.n(0.8, 1.5)} [m]")
    s.usual(["x"], ["A"])
    s.meets("x", -0.8, 0.9, "m")
    s.end = float(s.n(0.8, 2))


def wire(s):
    """A bead on a curve, with or without choose, two-sided or on top of it."""
    s.line("coord x [m], y [m]", "axes x right, y up")
    s.mass("A", "(x, y)")
    s.weight()
    s.loads()
    f = s.one("0.4 x^2/(1 [m])", "-0.3 x^2/(1 [m])", "0.6 x")
    if s.on("cosine_length", 0.4):
        f = s.one("0.5 [m] cos(x/(1 [m]))", "0.2 [m] sin(2 x/(1 [m]))")
    relation = "="
    if s.on("closed_contact", 0.35):
        relation = ">="
    s.line(f"constraint wire: y {relation} {f}")
    if s.on("choose", 0.5):
        s.line("choose x")
    elif not s.on("cartesian"):
        s.line("choose x")
    x0 = s.n(-0.8, 0.8)
    at = f.replace("x", f"({x0} [m])")
    s.line(f"init x = {x0} [m], y = {at}, x' = {s.velocity()} [m/s]")
    s.usual(["x", "y"], ["A"], ["wire"])
    s.meets("x", -1, 1, "m", ["wire"])


def pulley(s):
    """Masses over a pulley; the rope may go slack, floors may be met."""
    s.line("coord x1 [m], x2 [m]", "axes x down")
    s.mass("A1", "(x1)")
    s.mass("A2", "(x2)")
    s.weight("x")
    s.loads(plane=False)
    x1, x2 = s.n(0.3, 0.8), s.n(0.3, 0.8)
    l = f"{float(x1) + float(x2):g} [m]"
    contacts = ["rope"]
    if s.on("rope", 0.5):
        s.line(f"constraint rope: x1 + x2 <= {l}")
    else:
        s.line(f"constraint rope: x1 + x2 = {l}")
        if s.on("release", 0.3):
            s.line(f"event cut: when t = {s.n(0.1, 0.4)} [s] -> release rope")
            if s.rng.random() < 0.4:
                s.line(f"event stop1: when t = {s.n(0.5, 0.8)} [s] -> stop")
    if s.on("open_contact", 0.4):
        contacts.append("floor")
        s.line(f"constraint floor: x1 <= {s.n(0.9, 1.4)} [m]")
    elif s.on("closed_contact", 0.3):
        contacts.append("floor")
        s.line(f"constraint floor: x1 <= {x1} [m]")
    v = s.velocity(-1, 1) if "floor" not in contacts else "0"
    s.line(f"init x1 = {x1} [m], x2 = {x2} [m], x1' = {v} [m/s], x2' = {-float(v):g} [m/s]")
    s.usual(["x1", "x2"], ["A1", "A2"], contacts)
    s.meets("x1", 0.2, 0.9, "m", ["rope"])


def skier(s):
    """On top of a cylinder, in polar or Cartesian coordinates."""
    R = s.named("R", 1, 3, "m")
    where = s.one("on", "on", "above")
    polar = s.one(True, False)
    if where == "above" and not s.on("open_contact"):
        where = "on"
    if where == "on" and not s.on("closed_contact"):
        return
    if not polar and not s.on("cartesian"):
        polar = True
    high = "1.2*" if where == "above" else ""
    if polar:
        s.line("coord r [m], θ", "axes x right, z up")
        s.mass("A", "(r sin θ, r cos θ)")
        s.line(f"constraint dome: r >= {R}")
        s.line(f"init r = {high}{R}, θ = {s.n(2, 20)}°, r' = 0, θ' = {s.n(0, 0.5)} [1/s]")
        coords = ["r", "θ"]
    else:
        s.line("coord x [m], z [m]", "axes x right, z up")
        s.mass("A", "(x, z)")
        s.line(f"constraint dome: x^2 + z^2 >= {R}^2")
        if where == "on" and s.on("choose", 0.4):
            s.line("choose x", "branch z > 0")
        s.line(f"init x = 0.28*{high}{R}, z = 0.96*{high}{R}, x' = 0, z' = 0")
        coords = ["x", "z"]
    s.weight("-z")
    if s.on("open_contact", 0.3):
        s.line(f"constraint ground: z(A) >= -0.4 {R}")
    s.usual(coords, ["A"], ["dome"])
    if s.on("where", 0.5):
        s.ask(f"{s.one(*coords)} where λ_dome = 0" + (
            " from θ = 0 at rest" if polar and s.on("from", 0.5) else ""))
    s.end = 1.5


def hoop(s):
    """A bead on a turning hoop or rod: energies of the turning as `kinetic`, or a drive."""
    R, W = s.named("R", 0.5, 1.5, "m"), s.named("Ω", 1, 5, "1/s")
    m = s.named("m", 0.5, 2, "kg")
    if s.rng.random() < 0.5 and s.on("kinetic"):
        s.line("coord θ", "axes x right, z up")
        s.line(f"mass A: {m} at ({R} sin θ, -{R} cos θ)", f"kinetic 1/2 {m} {R}^2 sin(θ)^2 {W}^2")
        s.weight("-z")
        s.line(f"init θ = {s.n(10, 120, 0)}°, θ' = {s.velocity()} [1/s]")
        s.usual(["θ"], ["A"])
        s.meets("θ", 0.2, 2, "")
    elif s.on("drive"):
        s.line("coord r [m], φ", "axes x right, y up")
        s.line(f"mass A: {m} at (r cos φ, r sin φ)", f"constraint turn: φ = {W} t")
        if s.rng.random() < 0.5:
            s.line(f"spring {s.param('k', 30, 60, 'N/m')}, rest {R} between A and (0, 0)")
        s.line(f"init r = {s.n(0.3, 1)} [m], r' = {s.velocity()} [m/s]")
        s.usual(["r"], ["A"], ["turn"])
        s.end = 0.6


def abstract(s):
    """A Lagrange function alone, with drag or a force, of one or two coordinates."""
    if not s.on("lagrangian"):
        return
    two = s.rng.random() < 0.5
    s.line("coord u, v" if two else "coord u")
    a, b, c, e = (s.n(0.5, 2) for _ in range(4))
    L = f"1/2*{a}*u'^2 - " + s.one(f"1/2*{b}*u^2", f"{b}*cos(u)", f"{b}*(1 - cos(u))",
                                          f"1/4*{b}*u^4" if s.on("degenerate_rest") else f"1/4*{b}*(u^4 + u^2)")
    if two:
        L += f" + 1/2*{c}*v'^2 - 1/2*{e}*v^2 + " + s.one(f"({s.n(-0.4, 0.4)})*u*v", f"{s.n(0.2, 1)}*u*v'",
                                                      f"({s.n(-0.3, 0.3)})*u'*v'", f"1/2*{s.n(0.1, 0.5)}*u^2*v'^2")
    elif s.on("total_derivative", 0.4):
        L += " + " + s.one(f"{s.n(0.2, 1)}*sin(t)*u", f"{s.n(0.2, 1)}*sin(t)*u'", f"{s.n(0.2, 1)}*u*u'")
    s.line(f"lagrangian {L}")
    if s.on("damping", 0.3):
        s.line(f"rayleigh 1/2*{s.n(0.1, 0.5)}*u'^2")
    s.line(f"init u = {s.n(-1, 1)}, u' = {s.velocity()}" + (f", v = {s.n(-1, 1)}, v' = {s.velocity()}" if two else ""))
    s.ask("dof", "lagrange2", "conserved", "solve u''", "equilibria", "hamiltonian")
    if s.on("closed_motion", 0.3):
        s.ask("solve u(t)")
    if not two:
        s.meets("u", -1, 1, "")
    s.end = 2.0


def chain(s):
    """A family of masses on springs or rods."""
    if not s.on("family"):
        return
    N = s.one(2, 3)
    s.line(f"param N = {N}")
    k, m = s.named("k", 5, 30, "N/m"), s.named("m", 0.3, 1, "kg")
    if s.rng.random() < 0.6:
        s.line("coord x[1..N] [m]", "axes x right")
        s.line("for i in 1..N {", f"    mass P[i]: {m} at (x[i])",
               f"    init x[i] = {s.n(0.2, 0.5)} [m] i, x[i]' = {s.velocity()} [m/s]", "}")
        s.line("for i in 2..N {", f"    potential {k}/2 (x[i] - x[i-1] - {s.n(0.1, 0.5)} [m])^2", "}")
        s.line(f"potential {k}/2 x[1]^2")
        if s.on("open_contact", 0.3):
            s.line("for i in 1..N {", f"    constraint stop[i]: x[i] <= {s.n(1.7, 2.5)} [m]", "}")
        s.usual(["x[1]", f"x[{N}]"])
    else:
        s.line("coord x[1..N] [m], y[1..N] [m]", "axes x right, y up", "param d = 0.4 [m]")
        s.line("constraint c[1]: x[1]^2 + y[1]^2 = d^2")
        s.line("for i in 1..N {", f"    mass P[i]: {m} at (x[i], y[i])",
               "    init x[i] = 0.6 d i, y[i] = -0.8 d i, x[i]' = 0, y[i]' = 0", "}")
        s.line("for i in 2..N {", "    constraint c[i]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 = d^2", "}")
        s.weight()
        s.usual(["x[1]"], [], ["c[1]"])
    s.end = 0.8


def cart(s):
    """A pendulum on a cart, or two pendulums: two freedoms."""
    l = s.named("l", 0.5, 1.2, "m")
    kind = s.one("angle", "cartesian", "double")
    if kind == "cartesian" and not s.on("cartesian"):
        kind = "angle"
    if kind == "angle":
        s.line("coord X [m], φ", "axes x right, y up")
        s.mass("C1", "(X, 0)")
        s.mass("A2", f"(X + {l} sin φ, -{l} cos φ)")
        s.line(f"init X = 0, φ = {s.n(10, 150, 0)}°, X' = {s.velocity()} [m/s], φ' = {s.velocity()} [1/s]")
        coords, bonds = ["X", "φ"], []
    elif kind == "double":
        s.line("coord α, β", "axes x right, y up")
        s.mass("A1", f"({l} sin α, -{l} cos α)")
        s.mass("A2", f"({l} sin α + {l} sin β, -{l} cos α - {l} cos β)")
        s.line(f"init α = {s.n(10, 100, 0)}°, β = {s.n(10, 100, 0)}°, α' = {s.velocity()} [1/s], β' = {s.velocity()} [1/s]")
        coords, bonds = ["α", "β"], []
    else:
        s.line("coord X [m], x [m], y [m]", "axes x right, y up")
        s.mass("C1", "(X, 0)")
        s.mass("A2", "(x, y)")
        s.line(f"constraint rod: (x - X)^2 + y^2 = {l}^2")
        s.line(f"init X = 0, x = 0.6 {l}, y = -0.8 {l}, X' = 0, x' = 0, y' = 0")
        coords, bonds = ["X", "x"], ["rod"]
    s.weight()
    if s.rng.random() < 0.4:
        s.loads()
    s.usual(coords, [], bonds)
    s.end = 0.8


def crank(s):
    """A slider-crank: free, driven, or with the drive let go."""
    if not s.on("loop"):
        return
    s.line("param r = 0.3 [m], l = 0.8 [m]", "assume r < l")
    s.line("coord φ, x [m]", "axes x right, y up")
    s.mass("A1", "(r cos φ, r sin φ)")
    s.mass("B2", "(x, 0)")
    s.weight()
    s.line("constraint rod: (x - r cos φ)^2 + (r sin φ)^2 = l^2")
    driven = s.rng.random() < 0.4 and s.on("no_freedom")
    bonds = ["rod"]
    if driven:
        bonds.append("drive")
        s.line(f"constraint drive: φ = {s.n(1, 5)} [1/s] t")
        s.line("init x = r + l")
    elif s.rng.random() < 0.5:
        s.line("choose φ", "branch x > r cos φ")
        s.line(f"init φ = {s.n(10, 80, 0)}°, φ' = {s.velocity()} [1/s]")
    else:
        s.line("branch x > r cos φ")
        s.line(f"init φ = {s.n(10, 80, 0)}°, φ' = {s.velocity()} [1/s]")
    if s.rng.random() < 0.3:
        s.line(f"torque {s.n(0.5, 3)} [N m] on φ")
    s.usual(["φ", "x"], [], bonds)
    s.ask("x", "x'") if s.rng.random() < 0.5 else None
    s.end = 0.6


def rolling(s):
    """A disc that rolls or slides down an incline, or a swinging body, with a torque."""
    if not s.on("body"):
        return
    m, J, R = s.named("m", 0.5, 2, "kg"), s.named("J", 0.05, 0.4, "kg m^2"), s.named("R", 0.2, 0.5, "m")
    if s.rng.random() < 0.5:
        s.line("coord x [m], y [m], θ", "axes x right, y up")
        s.line(f"body disc: mass {m}, inertia {J} at (x, y) angle θ")
        s.line(f"constraint plane: y = {s.n(0.1, 0.8)} x", f"constraint roll: x = -{R} θ")
        s.line(f"init x = 0, y = 0, θ = 0, x' = {s.velocity()} [m/s]")
        coords, bonds = ["x", "θ"], ["plane", "roll"]
    else:
        s.line("coord θ", "axes x right, y up")
        s.line(f"body bar: mass {m}, inertia {J} at ({R} sin θ, -{R} cos θ) angle θ")
        if s.rng.random() < 0.5:
            s.line(f"point P on bar at (0, -{R})")
            s.line(f"spring {s.param('k', 3, 20, 'N/m')}, rest {s.n(0.1, 0.4)} [m] between P and (1 [m], 0)")
        s.line(f"init θ = {s.n(10, 150, 0)}°, θ' = {s.velocity()} [1/s]")
        coords, bonds = ["θ"], []
        s.meets("θ", 0.2, 2, "")
    s.weight()
    if s.rng.random() < 0.4:
        s.line(f"torque {s.n(-2, 2)} [N m] on " + ("disc" if bonds else s.one("bar", "θ")))
    s.usual(coords, [], bonds)


def blade(s):
    """Constraints between velocities."""
    if not s.on("nonholonomic"):
        return
    if s.rng.random() < 0.5:
        s.line("coord x [m], y [m], θ", "axes x right, y up")
        m, J, a = s.named("m", 0.5, 2, "kg"), s.named("J", 0.05, 0.4, "kg m^2"), s.named("a", 0.1, 0.4, "m")
        s.line(f"body sleigh: mass {m}, inertia {J} at (x + {a} cos θ, y + {a} sin θ) angle θ")
        s.line("constraint edge: y' cos θ - x' sin θ = 0")
        s.line(f"init x = 0, y = 0, θ = 0, x' = {s.velocity()} [m/s], θ' = {s.velocity()} [1/s]")
        coords = ["x", "θ"]
    else:
        s.line("coord x [m], y [m], z [m]", "axes x right, y out, z up")
        s.mass("A", "(x, y, z)")
        s.line(f"constraint edge: z' = {s.n(0.3, 1)} [1/m] y x'")
        s.line(f"init x = 0, y = {s.n(0.3, 1)} [m], z = 0, x' = {s.velocity()} [m/s], y' = {s.velocity()} [m/s]")
        coords = ["x", "y"]
        if s.rng.random() < 0.5:
            s.weight("-z")
    s.usual(coords, [], ["edge"])


def sliding(s):
    """Friction: only the motion can be compared."""
    if not s.on("friction"):
        return
    s.line("coord x [m], y [m]", "axes x right, y up")
    s.mass("A", "(x, y)")
    s.weight()
    s.line(s.one("constraint floor: y >= 0", "constraint floor: y = 0", "constraint floor: y = 0.3 x"))
    s.line(f"friction {s.n(0.1, 0.6)} on floor")
    if s.rng.random() < 0.5:
        s.line(f"spring {s.param('k', 3, 20, 'N/m')}, rest 0.2 [m] between A and (1.5 [m], 1 [m])")
    s.line(f"init x = 0, y = 0, x' = {'0' if s.on('sticks', 0.2) else s.n(0.4, 2.5)} [m/s]")
    s.ask("dof, constraints, conserved")
    s.end = 0.8


def corner(s):
    """A ball between a floor and a wall, on a moving floor, or in a wedge: two contacts that both may hold."""
    if not s.on("closed_contact"):
        return
    s.line("coord x [m], y [m]", "axes x right, y up")
    s.mass("A", "(x, y)")
    s.weight()
    kind = s.one("corner", "wedge", "lift") if s.on("stays") else "lift"
    if kind == "lift" and not s.on("drive"):
        s.lines = []
        return
    if kind == "corner":
        s.line("constraint floor: y >= 0", "constraint wall: x >= 0", "init x = 0, y = 0, x' = 0, y' = 0")
        s.line(f"force ({s.n(-3, 3)} [N], {s.n(-5, 5)} [N]) on A")
        contacts = ["floor", "wall"]
    elif kind == "wedge":
        s.line(f"constraint left: y >= -{s.n(0.4, 1.5)} x", f"constraint right: y >= {s.n(0.4, 1.5)} x")
        s.line("init x = 0, y = 0, x' = 0, y' = 0")
        s.line(f"force ({s.n(-6, 6)} [N], 0) on A")
        contacts = ["left", "right"]
    else:
        s.line(f"constraint floor: y >= {s.n(0.05, 0.3)} [m] sin({s.n(2, 6)} [1/s] t)")
        s.line(f"init x = 0, y = 0, x' = {s.velocity()} [m/s]")
        contacts = ["floor"]
    s.usual(["x", "y"], ["A"], contacts)
    s.end = 0.6


def bound(s):
    """Constraints that say the same twice, fix a coordinate, or are put on by an event."""
    s.line("coord x [m], y [m], z [m]", "axes x right, y out, z up")
    s.mass("A", "(x, y, z)")
    s.weight("-z")
    kind = s.one("fixed", "twice", "attach")
    slope = s.n(0.2, 0.8)
    if kind == "fixed":
        s.line(f"constraint side: y = {s.n(-1, 1)} [m]", f"constraint slope: z = {slope} x")
        s.line(f"init x = 0, x' = {s.velocity()} [m/s]")
        bonds = ["side", "slope"]
    elif kind == "twice":
        s.line(f"constraint slope: z = {slope} x", f"constraint same: 2 z - 2*{slope} x = 0")
        s.line(f"init x = 0, y = 0, x' = {s.velocity()} [m/s], y' = {s.velocity()} [m/s]")
        bonds = []
    else:
        if not s.on("release"):
            kind = "plain"
        s.line(f"constraint slope: z = {slope} x")
        s.line(f"init x = 0, y = 0, x' = {s.velocity()} [m/s], y' = {s.velocity()} [m/s]")
        bonds = ["slope"]
        if kind == "attach":
            s.line(f"event off: when t = {s.n(0.1, 0.3)} [s] -> release slope")
    if s.rng.random() < 0.4:
        s.line(f"spring {s.param('k', 3, 20, 'N/m')}, rest 0.2 [m] between A and (1 [m], 0.5 [m], 1 [m])")
    s.usual(["x", "z"], ["A"], bonds)
    s.end = 0.6


def space(s):
    """A pendulum in space, a bowl, a cone: three coordinates."""
    s.line("coord x [m], y [m], z [m]" if s.one(True, False) else "coord ρ [m], φ, z [m]", "axes x right, y out, z up")
    cylindrical = "ρ" in s.lines[-2]
    s.mass("A", "(ρ cos φ, ρ sin φ, z)" if cylindrical else "(x, y, z)")
    s.weight("-z")
    square = "ρ^2" if cylindrical else "(x^2 + y^2)"
    kind = s.one("sphere", "bowl", "cone")
    relation = s.one("=", ">=") if kind == "bowl" and s.on("closed_contact") else "="
    if kind == "sphere":
        s.line(f"constraint tie: {square} + z^2 = 1")
        r, z = "0.6", "-0.8"
    elif kind == "bowl":
        s.line(f"constraint tie: z {relation} {square}/(1 [m])")
        r, z = "0.5", "0.25"
    else:
        s.line(f"constraint tie: z = sqrt({square})")
        r, z = "0.7", "0.7"
    v, w = s.n(0.5, 2), s.n(0.5, 2)      # not through the tip of the cone
    if cylindrical:
        s.line(f"init ρ = {r} [m], φ = 0.3, z = {z} [m], ρ' = 0, φ' = {w} [1/s]")
        coords = ["ρ", "φ"]
    else:
        s.line(f"init x = {r} [m], y = 0, z = {z} [m], x' = 0, y' = {v} [m/s]")
        coords = ["x", "z"]
    s.usual(coords, ["A"], ["tie"])
    s.end = 0.6


def lift(s):
    """A pendulum or a spring in a lift: the weight of the lift under another name."""
    if not s.on("drive"):
        return
    s.line("param g = 9.81 [m/s^2]")
    s.letters.add("g")
    same = s.on("let_given", 0.5) and s.on("free_fall")
    s.line("let a = g" if same else f"param a = {s.n(1, 9)} [m/s^2]", "gravity g along -y")
    l = s.named("l", 0.5, 1.2, "m")
    s.line("coord φ", "axes x right, y up")
    s.mass("A", f"({l} sin φ, -1/2 a t^2 - {l} cos φ)")
    s.line(f"init φ = {s.n(10, 120, 0)}°, φ' = {s.velocity()} [1/s]")
    s.usual(["φ"], ["A"])


RECIPES = {f.__name__: f for f in (thrown, pendulum, oscillator, wire, pulley, skier, hoop, abstract, chain, cart, crank,
                                   rolling, blade, sliding, corner, bound, space, lift)}
