"""What a model text says, as expressions: masses, forces, constraints, start, events.  See reader.py."""

import re

import symbols as s
from reader import (STATEMENTS, Parser, Unread, ascii_name, find_word, split_top, statements_of, tokens_of)
from symbols import call, name, num

IGNORED = {"pleuel", "system", "lang", "ask", "plot", "animate", "draw", "output", "assume", "guess", "sweep",
           "poincare", "branch"}


class Constraint:
    def __init__(self, label, g, sense, velocity, is_map=False):
        self.label, self.g, self.sense, self.velocity, self.is_map = label, g, sense, velocity, is_map
        self.multiplier = "lambda_" + label
        self.redundant_ok = False
        self.holder = None      # `while label`

    @property
    def one_sided(self):
        return self.sense != "="


class Event:
    def __init__(self, label, g, direction, actions):
        self.label, self.g, self.direction, self.actions = label, g, direction, actions


class Model:
    """Reads a text.  Everything is an expression in coordinates, velocities, t and parameters."""

    def __init__(self, text):
        self.text = text
        self.coords, self.params, self.lets, self.functions = [], {}, {}, {}
        self.families, self.axes, self.sign = set(), ["x", "y", "z"], 1.0
        self.masses, self.bodies, self.points = {}, {}, {}
        self.kinetic, self.potential, self.rayleigh, self.lagrangian = num(0), num(0), num(0), None
        self.pushes = []        # (generalized force by coordinate name) dicts
        self.steady = num(0)    # potential of forces and torques that are constant, None beside others
        self.constraints, self.chosen, self.maps = [], [], []
        self.restitution, self.friction = {}, {}
        self.init, self.start_time, self.events = [], 0.0, []
        self.interval, self.branches, self.assumed = None, [], []
        self.gravity, self.todo = [], []
        self.position_texts, self.angle_texts = {}, {}
        self.read(text)

    # -------------------------------------------------------------------------------------------- reading
    def read(self, text):
        statements = self.unrolled(statements_of(text))
        for tokens, index in statements:
            self.declare(tokens, index)
        self.number_parameters()
        statements = self.unrolled(statements_of(text))   # bounds of families are numbers now
        for tokens, index in statements:
            self.place(tokens, index)
        self.ordinal, self.label_count = {}, 0
        for tokens, index in statements:
            self.state(tokens, index)
        self.weigh()

    def unrolled(self, blocks, index=None):
        """(tokens, index, ordinal of the statement in the text)."""
        out = []
        for b in blocks:
            if isinstance(b, str):
                if re.match(r"(system|include|lang)\b", b):
                    if b.startswith("include"):
                        raise Unread("include")
                    continue
                tokens = tokens_of(b)
                if tokens and tokens[0].text not in STATEMENTS:
                    raise Unread(f"no statement: {b}")
                out.append((tokens, index or {}))
            elif not self.params and "for" in b[0]:
                continue                                 # bounds are not known before the parameters
            else:
                for inner in self.instances(b[0], index or {}):
                    out += self.unrolled(b[1], inner)
        return out

    def instances(self, head, index):
        t = tokens_of(head)
        if t[0].text != "for" or t[2].text != "in":
            raise Unread(f"block {head}")
        dots = find_word(t, "..")
        stop = find_word(t, "step")
        low = self.integer(t[3:dots], index)
        high = self.integer(t[dots + 1 : stop if stop > 0 else len(t)], index)
        step = self.integer(t[stop + 1 :], index) if stop > 0 else 1
        word = ascii_name(t[1].text)
        return [{**index, word: k} for k in range(low, high + 1, step)]

    def integer(self, tokens, index):
        e = self.parse(tokens, index)
        e = s.replaced(e, {k: num(v) for k, v in self.params.items() if v is not None})
        if not s.is_num(e):
            raise Unread("a bound without number")
        return round(e.args[0])

    def parse(self, tokens, index):
        return Parser(tokens, self, index).whole()

    # -------------------------------------------------------------------------------------------- names
    def declare(self, t, index):
        head = t[0].text
        if head == "param":
            for part in split_top(t[1:], ","):
                self.declare_param(part)
        elif head == "let":
            for part in split_top(t[1:], ","):
                self.declare_let(part, index)
        elif head == "axes":
            words = [ascii_name(p[0].text) for p in split_top(t[1:], ",")]
            self.axes = sorted(words) if set(words) <= set("xyz") else words
        elif head == "convention":
            self.sign = -1.0

    def declare_param(self, part):
        word = ascii_name(part[0].text)
        equals = find_word(part, "=")
        if len(part) > 1 and part[1].text == "[" and any(x.text == ".." for x in part):
            raise Unread("a family of parameters")
        self.params[word] = part[equals + 1 :] if equals > 0 else None

    def number_parameters(self):
        for word, text in self.params.items():
            if isinstance(text, list):
                self.params[word] = self.parameter_number(word)

    def parameter_number(self, word):
        text = self.params[word]
        if not isinstance(text, list):
            return text
        e = self.parse(text, {})
        e = s.replaced(e, {n: num(self.parameter_number(n) or 0.0) for n in s.names_of(e)})
        if not s.is_num(e):
            raise Unread(f"parameter {word}")
        self.params[word] = e.args[0]
        return e.args[0]

    def declare_let(self, part, index):
        if index:
            raise Unread("let in a family")
        equals = find_word(part, "=")
        word = ascii_name(part[0].text)
        if part[1].text == "(":
            self.functions[word] = (ascii_name(part[2].text), part[equals + 1 :])
        else:
            self.lets[word] = part[equals + 1 :]

    def declare_coord(self, part):
        word = ascii_name(part[0].text)
        dots = next((k for k, x in enumerate(part) if x.text == ".."), -1)
        if dots < 0:
            self.coords.append(word)
            return
        close = next(k for k, x in enumerate(part) if k > dots and x.text == "]")
        self.families.add(word)
        low, high = self.integer(part[2:dots], {}), self.integer(part[dots + 1 : close], {})
        self.coords += [f"{word}_{k}" for k in range(low, high + 1)]

    def is_family(self, word):
        return word in self.families

    def value(self, word, primes, parser):
        """What a name stands for."""
        if word in self.coords:
            if primes > 2:
                raise Unread("a third derivative")
            return name(word + ("", "_dot", "_ddot")[primes])
        m = re.fullmatch(r"(.*?)_(d?dot)", word)
        if m and m.group(1) in self.coords:
            return name(word)
        if primes and word not in self.lets:
            raise Unread(f"{word} with primes")
        if word in self.params or word == "t":
            return name(word)
        if word in self.lets:
            e = self.let(word)
            for _ in range(primes):
                e = self.total(e)
            return e
        raise Unread(f"the name {word}")

    def let(self, word):
        if isinstance(self.lets[word], list):
            text, self.lets[word] = self.lets[word], None
            self.lets[word] = self.parse(text, {})
        if self.lets[word] is None:
            raise Unread(f"let {word} hangs on itself")
        return self.lets[word]

    def application(self, word, parser):
        """word( right behind it: a function, a component, a start value; None for a product."""
        if word in self.functions:
            bound, text = self.functions[word]
            return self.parse(text, {bound: parser.bracket()})
        inside = parser.t[parser.at + 1]
        if word in self.axes and inside.kind == "name" and self.is_label(inside.text):
            label = parser.label()
            at = self.position(label)
            return at[self.axes.index(word)]
        if word in self.coords and inside.text == "0" and parser.t[parser.at + 2].text == ")":
            parser.bracket()
            return name(word + "_0")
        return None

    def is_label(self, text):
        word = ascii_name(text)
        return word in self.position_texts or any(k.startswith(word + "_") for k in self.position_texts)

    def total(self, e):
        """The derivative by time."""
        if isinstance(e, tuple):
            return tuple(self.total(x) for x in e)
        out = s.diff(e, "t")
        for n in s.names_of(e):
            for word, next_word in ((n, n + "_dot"), (n[:-4], n[:-4] + "_ddot")):
                if word in self.coords and n in (word, word + "_dot"):
                    out = out + s.diff(e, n) * name(next_word if n == word else word + "_ddot")
                    break
        return out

    # -------------------------------------------------------------------------------------------- places
    def place(self, t, index):
        """Coordinates, and where things are; positions are read when somebody asks."""
        head = t[0].text
        if head == "coord":
            if index:
                raise Unread("coord in a family")
            for part in split_top(t[1:], ","):
                self.declare_coord(part)
        elif head == "mass" or head == "body" or head == "point":
            label, rest = self.label(t[1:], index)
            at = find_word(rest, "at")
            if label is None:
                label = ascii_name(rest[0].text)
                if len(rest) > 1 and rest[1].text == "[" and rest[0].kind == "name":
                    label = f"{label}_{self.integer(self.inside(rest, 1), index)}"
            self.position_texts[label] = (rest, index, head)

    @staticmethod
    def inside(tokens, at):
        depth = 0
        for k in range(at, len(tokens)):
            depth += (tokens[k].text in "([") - (tokens[k].text in ")]")
            if depth == 0:
                return tokens[at + 1 : k]
        raise Unread("an open bracket")

    def label(self, t, index):
        """`label:` or `label[i]:` in front, and the rest."""
        if len(t) > 1 and t[0].kind == "name" and t[1].text == ":":
            return ascii_name(t[0].text), t[2:]
        if len(t) > 3 and t[0].kind == "name" and t[1].text == "[":
            inner = self.inside(t, 1)
            end = len(inner) + 3
            if end < len(t) and t[end].text == ":":
                return f"{ascii_name(t[0].text)}_{self.integer(inner, index)}", t[end + 1 :]
        return None, t

    def position(self, label):
        if label in self.points:
            return self.points[label]
        if label not in self.position_texts:
            raise Unread(f"the label {label}")
        rest, index, head = self.position_texts[label]
        at = find_word(rest, "at")
        if head == "point" and rest[0].kind == "name" and find_word(rest, "on") == 1:
            self.points[label] = self.point_on(rest, index)
            return self.points[label]
        if head == "point" and find_word(rest, "on") >= 0:
            self.points[label] = self.point_on(rest, index)
            return self.points[label]
        end = find_word(rest, "angle", "axes")
        where = self.parse(rest[at + 1 : end if end > 0 else len(rest)], index)
        self.points[label] = where if isinstance(where, tuple) else (where,)
        return self.points[label]

    def point_on(self, rest, index):
        at, on = find_word(rest, "at"), find_word(rest, "on")
        body = self.reference(rest[on + 1 : at], index)
        offset = self.parse(rest[at + 1 :], index)
        angle = self.angle(body)
        x, y = self.position(body)
        c, si = call("cos", angle), call("sin", angle)
        return (x + offset[0] * c - offset[1] * si, y + offset[0] * si + offset[1] * c)

    def angle(self, body):
        rest, index, head = self.position_texts[body]
        at = find_word(rest, "angle")
        if head != "body" or at < 0:
            raise Unread("a body in space")
        return self.parse(rest[at + 1 :], index)

    def reference(self, t, index):
        """The label that a list of tokens names."""
        word = ascii_name(t[0].text)
        if len(t) > 1 and t[1].text == "[":
            word = f"{word}_{self.integer(self.inside(t, 1), index)}"
        return word

    def end_point(self, t, index):
        """A label or a place."""
        if t[0].kind == "name" and (len(t) == 1 or t[1].text == "["):
            label = self.reference(t, index)
            if label in self.position_texts:
                return self.position(label)
        at = self.parse(t, index)
        return at if isinstance(at, tuple) else (at,)

    # -------------------------------------------------------------------------------------------- statements
    def state(self, t, index):
        head = t[0].text
        if head == "rod":
            return self.state_rod(t, index)
        read = getattr(self, "state_" + head, None)
        if read:
            read(t[1:], index)
        elif head not in IGNORED and head not in ("param", "coord", "let", "axes", "convention", "point"):
            raise Unread(f"the statement {head}")

    def state_mass(self, t, index):
        label, rest = self.label(t, index)
        at = find_word(rest, "at")
        if label is None:
            label = self.reference(rest[:at], index)
        self.masses[label] = (self.parse(rest[:at], index), self.position(label))

    def state_body(self, t, index):
        label, rest = self.label(t, index)
        at = find_word(rest, "at")
        m = inertia = num(0)
        for part in split_top(rest[:at], ","):
            if part[0].text == "mass":
                m = self.parse(part[1:], index)
            elif part[0].text == "inertia":
                inertia = self.parse(part[1:], index)
        self.bodies[label] = (m, inertia, self.position(label), self.angle(label))
        self.masses[label] = (m, self.position(label))

    def state_rod(self, t, index):
        between, both = find_word(t, "between"), find_word(t, "and")
        m = self.parse(t[2:between], index)
        a = self.end_point(t[between + 1 : both], index)
        b = self.end_point(t[both + 1 :], index)
        middle = tuple((x + y) / 2 for x, y in zip(a, b))
        for k, (part, where) in enumerate(((6.0, a), (6.0, b), (1.5, middle))):
            self.masses[f"rod{len(self.masses)}_{k}"] = (m / part, where)

    def state_gravity(self, t, index):
        along = find_word(t, "along")
        g = self.parse(t[:along], index)
        down = t[along + 1].text == "-"
        axis = self.axes.index(ascii_name(t[along + 1 + down].text))
        self.gravity.append((-g if down else g, axis))

    def state_spring(self, t, index):
        stiffness, rest, d = self.link(t, index)
        d = call("sqrt", d)
        self.potential = self.potential + stiffness / 2 * (d - rest) ** 2

    def state_damper(self, t, index):
        c, _, square = self.link(t, index)
        rate = self.total(square) / (2 * call("sqrt", square))
        self.rayleigh = self.rayleigh + c / 2 * rate ** 2

    def link(self, t, index):
        between = find_word(t, "between")
        both = between + 1 + find_word(t[between + 1 :], "and")
        parts = split_top(t[:between], ",")
        rest = num(0)
        for p in parts[1:]:
            if p[0].text != "rest":
                raise Unread("a link with more than a rest length")
            rest = self.parse(p[1:], index)
        a, b = self.end_point(t[between + 1 : both], index), self.end_point(t[both + 1 :], index)
        square = num(0)
        for x, y in zip(a, b):
            square = square + (x - y) ** 2
        return self.parse(parts[0], index), rest, square

    def state_drag(self, t, index):
        on = find_word(t, "on")
        c = self.parse(t[:on], index)
        for x in self.end_point(t[on + 1 :], index):
            self.rayleigh = self.rayleigh + c / 2 * self.total(x) ** 2

    def state_force(self, t, index):
        _, t = self.label(t, index)
        on = find_word(t, "on")
        F = self.parse(t[:on], index)
        F = F if isinstance(F, tuple) else (F,)
        at = self.end_point(t[on + 1 :], index)
        self.push(sum_products(F, at))

    def push(self, pairs):
        """Generalized force of parts (factor, place)."""
        Q = {}
        for factor, place in pairs:
            constant = s.names_of(factor) <= set(self.params)
            self.steady = self.steady - factor * place if constant and self.steady else None
            for q in self.coords:
                d = s.diff(place, q)
                if not s.is_num(d, 0):
                    Q[q] = Q.get(q, num(0)) + factor * d
        self.pushes.append(Q)

    def state_torque(self, t, index):
        _, t = self.label(t, index)
        on = find_word(t, "on")
        M = self.parse(t[:on], index)
        if isinstance(M, tuple):
            raise Unread("a torque in space")
        target = self.reference(t[on + 1 :], index)
        if target in self.coords:
            self.push([(M, name(target))])
        elif target in self.position_texts:
            self.push([(M, self.angle(target))])
        else:
            raise Unread("torque on something else")

    def state_potential(self, t, index):
        _, t = self.label(t, index)
        self.potential = self.potential + self.scalar(t, index)

    def state_kinetic(self, t, index):
        _, t = self.label(t, index)
        self.kinetic = self.kinetic + self.scalar(t, index)

    def state_rayleigh(self, t, index):
        _, t = self.label(t, index)
        self.rayleigh = self.rayleigh + self.scalar(t, index)

    def state_lagrangian(self, t, index):
        _, t = self.label(t, index)
        self.lagrangian = (self.lagrangian or num(0)) + self.scalar(t, index)

    def scalar(self, t, index):
        e = self.parse(t, index)
        if isinstance(e, tuple):
            raise Unread("a vector where a number belongs")
        return e

    def state_constraint(self, t, index):
        label, t = self.label(t, index)
        ordinal = self.statement_ordinal(t)
        if label is None:
            label = str(ordinal) + "".join(f"_{k}" for k in index.values())
        at = find_word(t, "=", ">=", "<=")
        ends = [k for k in (find_word(t, "with"), find_word(t, "while"), find_word(t, ",")) if k > 0]
        left, right = self.parse(t[:at], index), self.parse(t[at + 1 : min(ends + [len(t)])], index)
        if isinstance(left, tuple) or isinstance(right, tuple):
            raise Unread("a constraint of vectors")
        tail = " ".join(x.text for x in t[min(ends + [len(t)]) :])
        if re.search(r"\boff\b", tail):
            return
        g = left - right
        velocity = any(n.endswith("_dot") for n in s.names_of(g))
        c = Constraint(label, g, t[at].text, velocity)
        named = re.search(r"with (\S+)", tail)
        c.multiplier = ascii_name(named.group(1)) if named else c.multiplier
        c.redundant_ok = "redundant ok" in tail
        holder = re.search(r"while (\w+)", tail)
        c.holder = ascii_name(holder.group(1)) if holder else None
        self.constraints.append(c)

    def statement_ordinal(self, tokens):
        """Which constraint of the text this is, counted from 1; members of a family share it."""
        key = " ".join(x.text for x in tokens)
        if key not in self.ordinal:
            self.ordinal[key] = len(self.ordinal) + 1
        return self.ordinal[key]

    def state_choose(self, t, index):
        given = find_word(t, "with")
        for part in split_top(t[: given if given >= 0 else len(t)], ","):
            self.chosen.append(self.reference(part, index))
        if given >= 0:
            for part in split_top(t[given + 1 :], ","):
                at = find_word(part, "=")
                g = self.parse(part[:at], index) - self.parse(part[at + 1 :], index)
                self.constraints.append(Constraint(f"map{len(self.maps)}", g, "=", False, is_map=True))
                self.maps.append(self.reference(part[:at], index))

    def state_restitution(self, t, index):
        on = find_word(t, "on")
        self.restitution[self.reference(t[on + 1 :], index)] = self.parse(t[:on], index)

    def state_friction(self, t, index):
        on = find_word(t, "on")
        parts = split_top(t[:on], ",")
        more = {p[0].text: self.parse(p[1:], index) for p in parts[1:]}
        self.friction[self.reference(t[on + 1 :], index)] = (self.parse(parts[0], index), more)

    def state_init(self, t, index):
        if t[0].text == "at":
            end = next(k for k, x in enumerate(t) if x.text == "]") + 1 if "[" in [x.text for x in t[:4]] else 2
            self.start_time = self.number(self.parse(t[1:end], index))
            t = t[end:]
        for part in split_top(t, ","):
            at = find_word(part, "=")
            if at < 0:
                raise Unread("a start without =")
            left, right = self.parse(part[:at], index), self.parse(part[at + 1 :], index)
            if left.op == "name":
                self.init.append((left.args[0], right))

    def number(self, e):
        e = s.replaced(e, {k: num(v) for k, v in self.params.items() if v is not None})
        if not s.is_num(e):
            raise Unread("a number expected")
        return e.args[0]

    def state_event(self, t, index):
        label, t = self.label(t, index)
        arrow = find_word(t, "->")
        condition, direction = t[1:arrow], None
        if t[0].text != "when" or arrow < 0:
            raise Unread("an event")
        if condition[-1].text in ("rising", "falling"):
            condition, direction = condition[:-1], condition[-1].text
        at = find_word(condition, "=", ">=", "<=")
        try:
            g = self.parse(condition[:at], index) - self.parse(condition[at + 1 :], index)
        except Unread:
            g = None            # a condition on results
        self.events.append(Event(label, g, direction, self.actions(t[arrow + 1 :], index)))

    def actions(self, t, index):
        out = []
        for part in split_top(t, ","):
            word = part[0].text
            if word in ("release", "attach") and len(part) > 1:
                out.append((word, self.reference(part[1:], index)))
            elif word in ("stop", "record"):
                out.append((word, None))
            else:
                out.append(("set", None))
        return out

    def state_simulate(self, t, index):
        dots = find_word(t, "..")
        ends = [k for k in (find_word(t, "step", "count", "tol"),) if k > 0]
        self.interval = (self.number(self.parse(t[:dots], index)),
                         self.number(self.parse(t[dots + 1 : min(ends + [len(t)])], index)))

    # -------------------------------------------------------------------------------------------- the whole
    def weigh(self):
        """Kinetic and potential energy of masses and bodies, or the given Lagrange function."""
        T, V = self.kinetic, self.potential
        for m, at in self.masses.values():
            for x in at:
                T = T + m / 2 * self.total(x) ** 2
            for g, axis in self.gravity:
                if axis < len(at):
                    V = V - m * g * at[axis]
        for _, inertia, _, angle in self.bodies.values():
            if isinstance(inertia, tuple):
                raise Unread("a body in space")
            T = T + inertia / 2 * self.total(angle) ** 2
        self.T, self.V = T, V
        self.L = T - V + self.lagrangian if self.lagrangian is not None else T - V


def sum_products(F, at):
    if len(F) != len(at):
        raise Unread("a force of another dimension")
    return list(zip(F, at))
