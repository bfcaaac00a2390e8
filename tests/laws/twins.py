"""Rewrites a model into equivalent spellings.  A twin knows how its state follows from that of the original."""

import random
import re

import symbols as s
from model import Model
from reader import Unread, ascii_name, find_word, split_top, statements_of, tokens_of

LEFT_OUT = {"plot", "animate", "draw", "system", "sweep", "poincare"}
UNTOUCHED = {"axes", "param", "lang", "pleuel", "convention", "include"}


class Change:
    """An old coordinate is scale * new + shift."""

    def __init__(self, new, scale=1.0, shift=0.0):
        self.new, self.scale, self.shift = new, scale, shift

    def text(self, primes, index):
        """The old coordinate, or its derivative, in the new one."""
        u = self.new + index + "'" * primes
        if self.scale == 1 and (self.shift == 0 or primes):
            return u
        out = {1: u, -1: f"-{u}"}.get(self.scale, f"{self.scale:g} {u}")
        return f"({out} {signed(self.shift)})" if self.shift and not primes else f"({out})"

    def inverse(self, primes, text):
        """What the new one is when the old one is given by a text."""
        inner = f"({text}) {signed(-self.shift)}" if self.shift and not primes else text
        if self.scale == 1:
            return inner
        return f"-({inner})" if self.scale == -1 else f"({inner})/{self.scale:g}"


def signed(x):
    return f"- {-x:g}" if x < 0 else f"+ {x:g}"


def text_of(tokens):
    return "".join((" " if t.blank else "") + t.text for t in tokens).strip()


def written(statements, indent=""):
    out = []
    for b in statements:
        if isinstance(b, str):
            out.append(indent + b)
        else:
            out.append(indent + b[0] + " {")
            out.append(written(b[1], indent + "    ").rstrip("\n"))
            out.append(indent + "}")
    return "\n".join(out) + "\n"


def head_of(statement):
    return re.match(r"\w+", statement if isinstance(statement, str) else statement[0]).group()


class Rewriter:
    """Puts new coordinates into statements."""

    def __init__(self, changes, families, labels):
        self.changes, self.families, self.labels = changes, families, labels

    def block(self, statements):
        out = []
        for b in statements:
            if isinstance(b, str):
                if head_of(b) not in LEFT_OUT:
                    out.append(b if head_of(b) in UNTOUCHED else self.statement(b))
            else:
                out.append((b[0], self.block(b[1])))
        return out

    def statement(self, line):
        head, rest = re.match(r"(\w+)\s*(.*)", line, re.S).groups()
        method = getattr(self, "state_" + head, None)
        t = tokens_of(rest)
        return f"{head} " + (method(t) if method else self.expression(t))

    def expression(self, t):
        """Each coordinate replaced where it stands."""
        out, k = [], 0
        while k < len(t):
            change, primes, index, end = self.coordinate(t, k)
            blank = " " if t[k].blank else ""
            if change is None:
                out.append(blank + t[k].text)
                k += 1
            else:
                out.append(blank + change.text(primes, index))
                k = end
        return "".join(out).strip()

    def coordinate(self, t, k):
        """(change, primes, index, next) when a coordinate stands at k, else None in front."""
        none = (None, 0, "", k)
        if t[k].kind != "name":
            return none
        word, dots = ascii_name(t[k].text), 0
        m = re.fullmatch(r"(.*?)_(d?)dot", word)
        if m and m.group(1) in self.changes:
            word, dots = m.group(1), 1 + bool(m.group(2))
        if word not in self.changes:
            return none
        if k + 1 < len(t) and t[k + 1].text == "(" and not t[k + 1].blank and k + 2 < len(t):
            inner = ascii_name(t[k + 2].text)
            if inner in self.labels or t[k + 2].text in ("0", "t"):
                return none if inner in self.labels else self.called(t, k, word)
        index, end = "", k + 1
        if word in self.families:
            close = next(j for j in range(k, len(t)) if t[j].text == "]")
            index, end = text_of(t[k + 1 : close + 1]), close + 1
            index = "[" + self.expression(t[k + 2 : close]) + "]"
        if end < len(t) and t[end].kind == "prime":
            dots, end = len(t[end].text), end + 1
            if end < len(t) and t[end].text == "(" and not t[end].blank and t[end + 1].text in ("0", "t"):
                raise Unread("a start value of a derivative")
        return self.changes[word], dots, index, end

    def called(self, t, k, word):
        """x(0) and x(t)."""
        c = self.changes[word]
        if c.scale != 1 or c.shift:
            raise Unread("a start value")
        return Change(f"{c.new}({t[k + 2].text})"), 0, "", k + 4

    def equation(self, t):
        """`q = text` with the new coordinate on the left."""
        at = find_word(t, "=")
        change, primes, index, end = self.coordinate(t, 0) if t else (None, 0, "", 0)
        if at < 0 or change is None or end != at:
            return self.expression(t)
        return f"{change.new}{index}{chr(39) * primes} = " + change.inverse(primes, self.expression(t[at + 1 :]))

    def state_coord(self, t):
        out = []
        for part in split_top(t, ","):
            word = ascii_name(part[0].text)
            new = self.changes[word].new if word in self.changes else part[0].text
            out.append(new + text_of(part[1:]).join([" ", ""]) if len(part) > 1 and part[1].blank else new + text_of(part[1:]))
        return ", ".join(reversed(out))

    def state_init(self, t):
        front = ""
        if t[0].text == "at":
            end = next(k for k, x in enumerate(t) if x.text == "]") + 1
            front, t = text_of(t[:end]) + " ", t[end:]
        return front + ", ".join(self.equation(p) for p in split_top(t, ","))

    def state_guess(self, t):
        return self.state_init(t)

    def state_choose(self, t):
        given = find_word(t, "with")
        names = ", ".join(self.bare(p) for p in split_top(t[: given if given >= 0 else len(t)], ","))
        if given < 0:
            return names
        return names + " with " + ", ".join(self.equation(p) for p in split_top(t[given + 1 :], ","))

    def bare(self, t):
        change, primes, index, end = self.coordinate(t, 0)
        return text_of(t) if change is None else change.new + index + "'" * primes + text_of(t[end:])

    def state_gravity(self, t):
        along = find_word(t, "along")
        return self.expression(t[:along]) + " " + text_of(t[along:])

    def state_torque(self, t):
        on = find_word(t, "on")
        change, _, index, end = self.coordinate(t, on + 1)
        if change is None:
            return self.expression(t)
        colon = find_word(t[:on], ":")
        front = text_of(t[: colon + 1]) + " " if colon > 0 else ""
        return f"{front}{change.scale:g}*({self.expression(t[colon + 1:on])}) on {change.new}{index}"

    def state_body(self, t):
        return self.labelled(t)

    def state_mass(self, t):
        return self.labelled(t)

    def state_constraint(self, t):
        return self.labelled(t)

    def labelled(self, t):
        """A label is no coordinate."""
        colon = find_word(t, ":")
        if colon < 0:
            return self.expression(t)
        return text_of(t[: colon + 1]) + " " + self.expression(t[colon + 1 :])

    def state_event(self, t):
        arrow = find_word(t, "->")
        actions = []
        for part in split_top(t[arrow + 1 :], ","):
            plain = part[0].text in ("stop", "record", "release", "attach")
            actions.append(text_of(part) if plain else self.equation(part))
        return self.labelled(t[:arrow]) + " -> " + ", ".join(actions)

    def state_ask(self, t):
        front = ""
        if len(t) > 1 and t[1].text == ":":
            front, t = text_of(t[:2]) + " ", t[2:]
        kept = [p for p in split_top(t, ",") if not any(x.text == "diff" for x in p)]   # diff by an expression
        return front + ", ".join(self.item(p) for p in kept or [tokens_of("dof")])

    def item(self, t):
        if not t:
            return ""
        if t[0].text == "solve":
            return "solve " + self.bare(t[1:])
        from_, rest = find_word(t, "from"), ""
        if from_ >= 0:
            rest = " from " + " and ".join(self.condition(p) for p in split_top(t[from_ + 1 :], "and"))
            t = t[:from_]
        for word in ("for", "at", "in", "holding"):
            k = find_word(t, word)
            if k >= 0 and t[0].text in ("equilibria", "modes", "lagrange1", "force", "threshold"):
                return text_of(t[: k + 1]) + " " + self.place(t[k + 1 :]) + rest
        return self.expression(t) + rest

    def condition(self, t):
        tail = ""
        if len(t) > 2 and t[-1].text == "rest" and t[-2].text == "at":
            t, tail = t[:-2], " at rest"
        return self.equation(t) + tail

    def place(self, t):
        """(x = a, y = b) holding z, or names."""
        if t[0].text == "(":
            close = next(k for k in range(len(t) - 1, -1, -1) if t[k].text == ")")
            inner = ", ".join(self.equation(p) if find_word(p, "=") >= 0 else self.bare(p)
                              for p in split_top(t[1:close], ","))
            held = t[close + 1 :]
            return f"({inner})" + (" holding " + self.bare(held[1:]) if held else "")
        return self.equation(t) if find_word(t, "=") >= 0 else self.bare(t)


# ------------------------------------------------------------------------------------------------ the twins
class Twin:
    """A text, and how the numbers of its names follow from those of the original."""

    def __init__(self, kind, text, changes=None, added=None, dropped=()):
        self.kind, self.text = kind, text
        self.changes = changes or {}
        self.added = added or {}      # new coordinate -> expression in old names
        self.dropped = dropped        # coordinates of the original that the twin does not have


def new_name(taken, word):
    name = "w" + re.sub(r"\W", "", word)
    while name in taken:
        name += "w"
    taken.add(name)
    return name


def changed(model, text, kind, rng):
    """Coordinates renamed, turned round, shifted or stretched, declared in another order."""
    taken = set(model.coords) | set(model.params) | set(model.lets)
    bases = [c for c in bases_of(model)]
    changes = {}
    for word in bases:
        new = new_name(taken, word)
        if kind == "renamed" or rng.random() < 0.3:
            changes[word] = Change(new)
        elif kind == "negative":
            changes[word] = Change(new, -1.0)
        elif kind == "shifted":
            changes[word] = Change(new, 1.0, rng.choice([0.25, -0.5]))
        else:
            changes[word] = Change(new, rng.choice([2.0, 0.5, 3.0]))
    if kind != "renamed" and all(c.scale == 1 and not c.shift for c in changes.values()):
        word = rng.choice(bases)
        changes[word] = Change(changes[word].new, -1.0 if kind == "negative" else 2.0 if kind == "scaled" else 1.0,
                               0.25 if kind == "shifted" else 0.0)
    rewriter = Rewriter(changes, model.families, set(model.position_texts))
    statements = rewriter.block(statements_of(text))
    if kind == "renamed":
        statements = shuffled(statements, rng)
    each = {}
    for word, c in changes.items():
        for q in model.coords:
            if q == word:
                each[q] = (c.new, c)
            elif word in model.families and q.rpartition("_")[0] == word:
                each[q] = (c.new + "_" + q.rpartition("_")[2], c)
    return Twin(kind, written(statements), each)


def bases_of(model):
    """Names as declared: a family counts once."""
    out = []
    for q in model.coords:
        word = q.rpartition("_")[0]
        word = word if word in model.families else q
        if word not in out:
            out.append(word)
    return out


def shuffled(statements, rng):
    """Another order; constraints among themselves and requests keep theirs, since they have numbers."""
    kept = [b for b in statements if head_of(b) in ("ask", "constraint", "for", "simulate", "pleuel", "lang", "expect")]
    free = [b for b in statements if b not in kept]
    rng.shuffle(free)
    out = list(kept)
    for b in free:
        out.insert(rng.randrange(len(out) + 1), b)
    return out


def lifted(model, text, rng, choose=False):
    """Masses get coordinates of their own, tied to the places that they had."""
    statements, added, lines, coords = statements_of(text), {}, [], []
    out = []
    for b in statements:
        if not isinstance(b, str) or head_of(b) != "mass":
            out.append(b)
            continue
        t = tokens_of(b)[1:]
        at = find_word(t, "at")
        colon = find_word(t[:at], ":")
        label = ascii_name(t[0].text) if colon > 0 or at == 1 else None
        place = model.position(label) if label in model.position_texts else None
        if place is None or all(x.op in ("name", "num") for x in place):
            out.append(b)
            continue
        names = [f"W{axis}{label}" for axis in "uvw"[: len(place)]]
        parts = split_top(t[at + 2 : -1], ",") if t[at + 1].text == "(" else []
        if len(parts) != len(place):
            out.append(b)
            continue
        coords += names
        for name, part, x in zip(names, parts, place):
            added[name] = x
            lines.append(f"constraint lift_{name}: {name} = {text_of(part)}")
        out.append(f"mass {text_of(t[:at])} at ({', '.join(names)})")
    if not coords:
        return None
    out = [b for b in out if head_of(b) not in LEFT_OUT]
    out = ["coord " + ", ".join(coords)] + out + lines
    if choose and not model.chosen and not model.constraints:
        out.append("choose " + ", ".join(model.coords))
    elif choose:
        return None
    return Twin("lifted, chosen" if choose else "lifted", written(out), {}, added)


def unchosen(model, text, start):
    """Without `choose`; coordinates that only it spoke of are gone, the start is given by numbers."""
    if not model.chosen:
        return None
    gone = [q for q in model.chosen if model.maps and q not in start]
    out = []
    for b in statements_of(text):
        head = head_of(b)
        if head in LEFT_OUT or head == "choose":
            continue
        if isinstance(b, str) and head == "coord" and gone:
            parts = [p for p in split_top(tokens_of(b)[1:], ",") if ascii_name(p[0].text) not in gone]
            b = "coord " + ", ".join(text_of(p) for p in parts)
            if not parts:
                continue
        if gone and isinstance(b, str) and head in ("init", "guess"):
            continue
        if gone and isinstance(b, str) and head in ("ask", "branch", "event", "output", "let") and speaks_of(b, gone):
            if head != "ask":
                return None
            b = without_items(b, gone)
            if not b:
                continue
        out.append(b)
    if gone:
        out.append("init " + ", ".join(f"{k} = {x!r}" for k, x in start.items()))
    return Twin("unchosen", written(out), {}, {}, tuple(gone))


def speaks_of(line, words):
    return any(t.kind == "name" and re.sub(r"_d?dot$", "", ascii_name(t.text)) in words for t in tokens_of(line))


def without_items(line, words):
    t = tokens_of(line)[1:]
    front = "ask "
    if len(t) > 1 and t[1].text == ":":
        front, t = f"ask {text_of(t[:2])} ", t[2:]
    kept = [text_of(p) for p in split_top(t, ",") if not speaks_of(text_of(p), words)]
    return front + ", ".join(kept) if kept else None


def turned_axes(model, text, rng):
    """The axes named in another order."""
    out, found = [], False
    for b in statements_of(text):
        if isinstance(b, str) and head_of(b) == "axes":
            parts = split_top(tokens_of(b)[1:], ",")
            if len(parts) > 1 and all(p[0].text in "xyz" for p in parts):
                b, found = "axes " + ", ".join(text_of(p) for p in reversed(parts)), True
        if head_of(b) not in LEFT_OUT:
            out.append(b)
    return Twin("axes", written(out)) if found else None


def twins_of(text, seed, start=None):
    """Every twin that this model has.  start: numbers for the coordinates and velocities at the beginning."""
    model, rng, out = Model(text), random.Random(seed), []
    for kind in ("renamed", "negative", "shifted", "scaled"):
        try:
            out.append(changed(model, text, kind, rng))
        except Unread:
            continue
    for twin in (lifted(model, text, rng), lifted(model, text, rng, True),
                 unchosen(model, text, start) if start is not None else None, turned_axes(model, text, rng)):
        if twin:
            out.append(twin)
    return out
