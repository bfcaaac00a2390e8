"""An independent reader of models, written from docs/language.md alone: text goes in, expressions in SI come out.

It reads what it knows and raises Unread for the rest.  Names are spelled as in the JSON document: theta, m1, x_dot, x_3.
"""

import re

import symbols as s
from symbols import call, name, num

GREEK = dict(zip("αβγδεζηθικλμνξοπρστυφχψωϑϕΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩ", (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho sigma tau "
    "upsilon phi chi psi omega theta phi Alpha Beta Gamma Delta Epsilon Zeta Eta Theta Iota Kappa Lambda "
    "Mu Nu Xi Omicron Pi Rho Sigma Tau Upsilon Phi Chi Psi Omega").split()))
SUBSCRIPT = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
SUPERSCRIPT = {c: str(i) for i, c in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")}
SUPERSCRIPT["⁻"] = "-"
DOTTED = {"ẋ": "x'", "ẍ": "x''", "ẏ": "y'", "ż": "z'", "ṙ": "r'", "ṡ": "s'", "ṫ": "t'"}
UMLAUT = {"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss"}
LETTER = "A-Za-zäöüÄÖÜßα-ωϑϕΑ-Ω"
TOKEN = re.compile(
    r"(?P<blank>\s+)|(?P<number>\d+(?:\.(?!\.)\d*)?(?:[eE][-+]?\d+)?)|(?P<name>[%s][%s0-9_₀-₉]*)"
    r"|(?P<prime>['′]+)|(?P<super>[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)|(?P<op>->|\.\.|>=|<=|>>|<<|≥|≤|→|[-+*/^()\[\],=<>√·°:{}|∞%%−])"
    % (LETTER, LETTER))
FUNCTIONS = set(s.PYTHON) | {"log"}
STATEMENTS = {
    "pleuel", "system", "lang", "axes", "convention", "include", "param", "coord", "let", "assume", "output",
    "mass", "body", "point", "rod", "gravity", "force", "spring", "damper", "drag", "potential", "kinetic",
    "rayleigh", "lagrangian", "torque", "constraint", "choose", "branch", "restitution", "friction", "init",
    "guess", "event", "for", "ask", "simulate", "plot", "animate", "draw", "sweep", "poincare", "input"}
SMALL = {"at", "on", "of", "with", "when", "where", "while", "from", "in", "and", "for", "vs", "along",
         "between", "over", "holding", "rising", "falling", "step", "count", "tol", "order", "rest", "off",
         "redundant"}


class Unread(Exception):
    """What the reader does not know; the model is left alone."""


def ascii_name(text):
    """One name for all its spellings: m₁, m_1, m1; θ, theta."""
    text = text.translate(SUBSCRIPT)
    parts, out = re.findall(r"[α-ωϑϕΑ-Ω]|[^α-ωϑϕΑ-Ω]+", text), ""
    for k, p in enumerate(parts):
        if p in GREEK:
            letter_follows = k + 1 < len(parts) and parts[k + 1][0].isalpha()
            letter_before = out and out[-1].isalpha()
            out += ("_" if letter_before else "") + GREEK[p] + ("_" if letter_follows else "")
        else:
            out += "".join(UMLAUT.get(c, c) for c in p)
    return re.sub(r"_(?=\d)", "", out)


class Token:
    __slots__ = ("kind", "text", "blank")

    def __init__(self, kind, text, blank):
        self.kind, self.text, self.blank = kind, text, blank

    def __repr__(self):
        return self.text


def tokens_of(text):
    for c, plain in DOTTED.items():
        text = text.replace(c, plain)
    at, out, blank = 0, [], False
    while at < len(text):
        m = TOKEN.match(text, at)
        if not m:
            raise Unread(f"cannot read {text[at:at + 20]!r}")
        at = m.end()
        if m.lastgroup == "blank":
            blank = True
            continue
        word = {"≥": ">=", "≤": "<=", "→": "->", "·": "*", "−": "-"}.get(m.group(), m.group())
        out.append(Token(m.lastgroup, word, blank))
        blank = False
    return out


# ------------------------------------------------------------------------------------------------ lines
def without_comment(line):
    quoted = False
    for k, c in enumerate(line):
        if c == '"':
            quoted = not quoted
        elif c == "#" and not quoted:
            return line[:k]
    return line


def lines_of(text):
    """Statements as texts; a line goes on while a bracket is open or behind an operator or a comma."""
    out, held, depth = [], "", 0
    for raw in text.splitlines():
        line = without_comment(raw).strip()
        if not line:
            continue
        held = (held + " " + line).strip()
        depth = sum(held.count(c) for c in "([") - sum(held.count(c) for c in ")]")
        if depth > 0 or (re.search(r"[-+*/^=,<>]$|->$", held) and not held.endswith("{")):
            continue
        out.append(held)
        held = ""
    return out + ([held] if held else [])


def statements_of(text):
    """Statements, and (head, statements) for families."""
    spread = re.sub(r"[{}]", lambda m: "{\n" if m.group() == "{" else "\n}\n",
                    "\n".join(without_comment(line) for line in text.splitlines()))
    stack = [[]]
    for line in lines_of(spread):
        if line.endswith("{"):
            stack.append([])
            stack[-2].append((line[:-1].strip(), stack[-1]))
        elif line == "}":
            stack.pop()
        else:
            stack[-1].append(line)
    return stack[0]


def split_top(tokens, separator):
    """Token lists between separators outside of brackets."""
    out, depth, part = [], 0, []
    for t in tokens:
        if t.text in ("(", "["):
            depth += 1
        elif t.text in (")", "]"):
            depth -= 1
        if depth == 0 and t.text == separator:
            out.append(part)
            part = []
        else:
            part.append(t)
    return out + [part]


def find_word(tokens, *words):
    """Where a word stands outside of brackets, or -1."""
    depth = 0
    for k, t in enumerate(tokens):
        if t.text in ("(", "["):
            depth += 1
        elif t.text in (")", "]"):
            depth -= 1
        elif depth == 0 and t.text in words:
            return k
    return -1


# ------------------------------------------------------------------------------------------------ units
UNIT = {
    "m": 1, "g": 1e-3, "s": 1, "A": 1, "K": 1, "mol": 1, "cd": 1, "Hz": 1, "N": 1, "Pa": 1, "J": 1, "W": 1,
    "C": 1, "V": 1, "F": 1, "Ω": 1, "Ohm": 1, "T": 1, "rad": 1, "mrad": 1e-3, "deg": 3.141592653589793 / 180,
    "°": 3.141592653589793 / 180, "rpm": 3.141592653589793 / 30, "rev": 6.283185307179586, "min": 60,
    "h": 3600, "t": 1000, "l": 1e-3, "bar": 1e5, "Nm": 1, "Nmm": 1e-3, "Ns": 1, "Js": 1, "eV": 1.602176634e-19,
    "kmh": 1 / 3.6, "%": 0.01}
PREFIX = {"k": 1e3, "M": 1e6, "G": 1e9, "m": 1e-3, "c": 1e-2, "d": 1e-1, "µ": 1e-6, "u": 1e-6, "n": 1e-9, "h": 1e2}


def unit_symbol(text):
    if text in UNIT:
        return UNIT[text]
    if text[0] in PREFIX and text[1:] in UNIT:
        return PREFIX[text[0]] * UNIT[text[1:]]
    raise Unread(f"unit {text}")


def unit_factor(tokens):
    """The factor to SI; products and quotients from left to right."""
    value, _ = unit_product(tokens, 0)
    return value


def unit_product(tokens, at):
    value, divide = 1.0, False
    while at < len(tokens) and tokens[at].text != ")":
        t = tokens[at]
        if t.text in "*/":
            divide = t.text == "/"
            at += 1
            continue
        if t.text == "(":
            factor, at = unit_product(tokens, at + 1)
        elif t.kind == "number":
            factor = float(t.text)
        else:
            factor = unit_symbol(t.text)
        at += 1
        power, at = unit_power(tokens, at)
        value = value / factor**power if divide else value * factor**power
        divide = False
    return value, at


def unit_power(tokens, at):
    if at < len(tokens) and tokens[at].kind == "super":
        return float("".join(SUPERSCRIPT[c] for c in tokens[at].text)), at + 1
    if at >= len(tokens) or tokens[at].text != "^":
        return 1.0, at
    at += 1
    if tokens[at].text == "(":
        return float(tokens[at + 1].text) / float(tokens[at + 3].text), at + 5
    sign = 1.0
    if tokens[at].text == "-":
        sign, at = -1.0, at + 1
    return sign * float(tokens[at].text), at + 1


# ------------------------------------------------------------------------------------------------ expressions
def lift(f, a, b):
    """A sum or difference of numbers, or of vectors."""
    if isinstance(a, tuple) or isinstance(b, tuple):
        if not (isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b)):
            raise Unread("a sum of a vector and something else")
        return tuple(f(x, y) for x, y in zip(a, b))
    return f(a, b)


def times(a, b):
    if isinstance(a, tuple) and isinstance(b, tuple):
        raise Unread("a product of two vectors")
    if isinstance(a, tuple):
        return tuple(x * b for x in a)
    if isinstance(b, tuple):
        return tuple(a * x for x in b)
    return a * b


def over(a, b):
    return tuple(x / b for x in a) if isinstance(a, tuple) else a / b


class Parser:
    """Reads one expression.  scope answers what a name stands for; index holds numbers of family indices."""

    def __init__(self, tokens, scope, index):
        self.t, self.at, self.scope, self.index = tokens, 0, scope, index

    def peek(self, k=0):
        return self.t[self.at + k].text if self.at + k < len(self.t) else None

    def kind(self):
        return self.t[self.at].kind if self.at < len(self.t) else None

    def take(self, expected=None):
        if self.at >= len(self.t) or (expected and self.peek() != expected):
            raise Unread(f"{expected or 'more'} expected in {self.t!r}")
        self.at += 1
        return self.t[self.at - 1]

    def whole(self):
        out = self.sum()
        if self.at != len(self.t):
            raise Unread(f"{self.peek()!r} is left over in {self.t!r}")
        return out

    def sum(self):
        out = self.product()
        while self.peek() in ("+", "-"):
            sign = self.take().text
            right = self.product()
            out = lift(lambda a, b: a + b if sign == "+" else a - b, out, right)
        return out

    def product(self):
        if self.peek() in ("-", "+"):
            sign = self.take().text
            inner = self.product()
            return times(num(-1), inner) if sign == "-" else inner
        out = self.factor()
        while True:
            if self.peek() == "*":
                self.take()
                out = times(out, self.signed())
            elif self.peek() == "/":
                self.take()
                out = over(out, self.signed())
            elif self.peek() == "[":
                out = times(out, num(self.unit()))
            elif self.starts_factor():
                out = times(out, self.factor())
            else:
                return out

    def signed(self):
        if self.peek() == "-":
            self.take()
            return times(num(-1), self.signed())
        return self.factor()

    def unit(self):
        self.take("[")
        depth, inner = 1, []
        while True:
            t = self.take()
            depth += (t.text == "[") - (t.text == "]")
            if depth == 0:
                return unit_factor(inner)
            inner.append(t)

    def starts_factor(self):
        k = self.kind()
        if k == "name":
            return self.peek() not in SMALL
        return k == "number" or self.peek() in ("(", "√")

    def factor(self):
        base = self.atom()
        while self.peek() == "°":
            self.take()
            base = times(base, num(3.141592653589793 / 180))
        return self.raised(base)

    def raised(self, base):
        if self.kind() == "super":
            return base ** num(float("".join(SUPERSCRIPT[c] for c in self.take().text)))
        if self.peek() == "^":
            self.take()
            return base ** self.exponent()
        return base

    def exponent(self):
        if self.peek() == "-":
            self.take()
            return -self.exponent()
        return self.raised(self.atom())

    def atom(self):
        kind, text = self.kind(), self.peek()
        if kind == "number":
            return num(float(self.take().text))
        if text == "(":
            return self.bracket()
        if text == "√":
            self.take()
            return call("sqrt", self.atom())
        if kind != "name":
            raise Unread(f"{text!r} is no operand in {self.t!r}")
        return self.named(ascii_name(self.take().text))

    def bracket(self):
        self.take("(")
        parts = [self.sum()]
        while self.peek() == ",":
            self.take()
            parts.append(self.sum())
        self.take(")")
        return parts[0] if len(parts) == 1 else tuple(parts)

    def arguments(self):
        got = self.bracket()
        return list(got) if isinstance(got, tuple) else [got]

    def named(self, word):
        if word in FUNCTIONS:
            return self.function("ln" if word == "log" else word)
        special = getattr(self, "call_" + word, None)
        if special and self.peek() == "(":
            return special()
        if word == "pi":
            return num(3.141592653589793)
        if word in self.index:
            return num(self.index[word])
        if self.peek() == "(" and not self.t[self.at].blank:
            got = self.scope.application(word, self)
            if got is not None:
                return got
        if self.peek() == "[" and self.scope.is_family(word):
            word = f"{word}_{self.subscript()}"
        return self.scope.value(word, self.primes(), self)

    def subscript(self):
        self.take("[")
        k = self.sum()
        self.take("]")
        if not s.is_num(k):
            raise Unread("an index that is no number")
        return round(k.args[0])

    def primes(self):
        if self.kind() == "prime":
            return len(self.take().text)
        return 0

    def function(self, f):
        power = None
        if self.kind() == "super":
            power = num(float("".join(SUPERSCRIPT[c] for c in self.take().text)))
        elif self.peek() == "^":
            self.take()
            power = self.exponent()
        if self.peek() == "(":
            out = call(f, *self.arguments())
        else:
            out = call(f, self.bare_argument())
        return out ** power if power is not None else out

    def bare_argument(self):
        if self.kind() == "number" and self.at + 1 < len(self.t) and self.t[self.at + 1].text == "°":
            k = float(self.take().text)
            self.take()
            return num(k * 3.141592653589793 / 180)
        out = self.atom()
        if self.peek() == "^" or self.kind() == "super":
            raise Unread("a power behind the argument of a function without brackets")
        return out

    # functions with a meaning of their own
    def call_norm(self):
        v = self.bracket()
        if not isinstance(v, tuple):
            return call("abs", v)
        return call("sqrt", dot(v, v))

    def call_dot(self):
        a, b = self.arguments()
        return dot(a, b)

    def call_polar(self):
        r, a = self.arguments()
        return (r * call("cos", a), r * call("sin", a))

    def call_spherical(self):
        r, a, b = self.arguments()
        return (r * call("sin", a) * call("cos", b), r * call("sin", a) * call("sin", b), r * call("cos", a))

    def call_cross(self):
        a, b = self.arguments()
        return tuple(a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3))

    def call_pos(self):
        return self.scope.position(self.label())

    def call_vel(self):
        return tuple(self.scope.total(x) for x in self.scope.position(self.label()))

    def label(self):
        self.take("(")
        word = ascii_name(self.take().text)
        if self.peek() == "[":
            word = f"{word}_{self.subscript()}"
        self.take(")")
        return word

    def call_diff(self):
        e, by = self.arguments()
        if by.op != "name":
            raise Unread("diff by something that is no name")
        return s.diff(e, by.args[0])

    def call_dt(self):
        return self.scope.total(self.bracket())

    def call_sum(self):
        self.take("(")
        word = ascii_name(self.take().text)
        self.take("in")
        low = self.sum()
        self.take("..")
        high = self.sum()
        self.take(",")
        start, out, saved = self.at, num(0), dict(self.index)
        for k in range(round(low.args[0]), round(high.args[0]) + 1):
            self.at, self.index = start, {**saved, word: k}
            out = lift(lambda a, b: a + b, out, self.sum())
        if round(high.args[0]) < round(low.args[0]):
            self.index = {**saved, word: round(low.args[0])}
            self.sum()
        self.index = saved
        self.take(")")
        return out


def dot(a, b):
    out = num(0)
    for x, y in zip(a, b):
        out = out + x * y
    return out
