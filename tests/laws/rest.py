"""Positions of rest, first places on a motion, and impacts: what the witness says about them."""

import itertools
import math
import random
import re

import symbols as s
from formulas import NotAFormula
from reader import Parser, Unread, ascii_name, find_word, split_top, tokens_of
from witness import Lost, expanded, reduced, least_norm


def impact(w, p, v, released, restitution):
    """Velocities by coordinate name behind an impact, by trying every set of contacts; None where several fit."""
    index = [w.q.index(x) for x in w.d]
    v = [v[i] for i in index]
    fixed = p.always(released)
    touch = [j for j, c in enumerate(w.rows) if c.one_sided and c.label not in released
             and abs(p.g[j]) <= 1e-7 * max([abs(x) for x in p.G[j]] + [1e-9])]
    n, found = len(v), []
    momentum = [sum(a * b for a, b in zip(row, v)) for row in p.M]
    for size in range(len(touch) + 1):
        for hit in itertools.combinations(touch, size):
            active = fixed + list(hit)
            A = [p.M[i] + [-p.G[j][i] for j in active] for i in range(n)] + [p.G[j] + [0.0] * len(active) for j in active]
            goal = [sum(x * y for x, y in zip(p.G[j], v)) - p.rate[j] for j in active]
            goal = [g - restitution.get(w.rows[j].label, 0.0) * p.rate[j] if j in hit else g for j, g in zip(active, goal)]
            x, determined, _, consistent = reduced(A, momentum + goal)
            if consistent and all(determined[:n]) and allowed(w, p, v, x, n, active, hit, touch, restitution):
                found.append(x[:n])
    if not found or any(abs(a - b) > 1e-6 * (1 + abs(a)) for other in found[1:] for a, b in zip(found[0], other)):
        return None
    return dict(zip(w.d, found[0]))


def allowed(w, p, v, x, n, active, hit, touch, restitution):
    for j, impulse in zip(active, x[n:]):
        if j in hit and (impulse < -1e-9 if w.rows[j].sense == ">=" else impulse > 1e-9):
            return False
    for j in touch:
        if j in hit:
            continue
        after = sum(a * (b - c) for a, b, c in zip(p.G[j], x[:n], v)) + p.rate[j]
        u = after + restitution.get(w.rows[j].label, 0.0) * p.rate[j]
        if u < -1e-9 if w.rows[j].sense == ">=" else u > 1e-9:
            return False
    return True


# ------------------------------------------------------------------------------------------------ positions of rest
def static_residual(w, q, active):
    """Forces that the constraints cannot hold at a place without velocity, and the constraints."""
    p = w.at(w.state(q, [0.0] * w.n, 0.0))
    G = [p.G[j] for j in active]
    if not G:
        return p.f, p
    A = [[sum(x * y for x, y in zip(r, c)) for c in G] for r in G]
    lam = reduced(A, [-sum(x * y for x, y in zip(r, p.f)) for r in G])[0]
    rest = [f + sum(l * r[i] for l, r in zip(lam, G)) for i, f in enumerate(p.f)]
    return rest + [p.g[j] for j in active], p


def newton(w, q, active):
    """A place of rest near q, or None."""
    d = [w.q.index(x) for x in w.d]
    q = list(q)
    for _ in range(30):
        try:
            r, _ = static_residual(w, q, active)
            size = max(abs(x) for x in r)
            if size < 1e-11:
                return q
            J = []
            for i in d:
                h = 1e-6 * max(1.0, abs(q[i]))
                up, down = list(q), list(q)
                up[i] += h
                down[i] -= h
                a, b = static_residual(w, up, active)[0], static_residual(w, down, active)[0]
                J.append([(x - y) / (2 * h) for x, y in zip(a, b)])
            rows = [[J[k][i] for k in range(len(d))] for i in range(len(r))]
            step = least_squares(rows, [-x for x in r])
            big = max(abs(x) for x in step)
            for k, i in enumerate(d):
                q[i] += step[k] * min(1.0, 1.0 / max(big, 1e-12))
            if max(abs(x) for x in q) > 50:
                return None
        except Lost:
            return None
    return None


def least_squares(rows, b):
    n = len(rows[0])
    A = [[sum(r[i] * r[j] for r in rows) + (1e-13 if i == j else 0.0) for j in range(n)] for i in range(n)]
    return reduced(A, [sum(r[i] * x for r, x in zip(rows, b)) for i in range(n)], 1e-14)[0]


def isolated(w, q, active):
    """Whether no other place of rest is next to it."""
    d = [w.q.index(x) for x in w.d]
    J = []
    for i in d:
        up, down = list(q), list(q)
        up[i] += 1e-5
        down[i] -= 1e-5
        a, b = static_residual(w, up, active)[0], static_residual(w, down, active)[0]
        J.append([(x - y) / 2e-5 for x, y in zip(a, b)])
    rows = [[J[k][i] for k in range(len(d))] for i in range(len(J[0]))]
    return reduced(rows, [0.0] * len(rows), 1e-5)[2] == len(d)


def periodic(w, i, states):
    """Whether a coordinate may be turned by 2 pi without any change."""
    for z in states:
        try:
            a = w.program(z)
            b = w.program(z[:i] + [z[i] + 2 * math.pi] + z[i + 1 :])
        except (ValueError, ZeroDivisionError, OverflowError):
            return False
        if any(abs(x - y) > 1e-7 * (1 + abs(x)) for x, y in zip(a, b)):
            return False
    return True


def apart(w, i, turns, a, b):
    x = a - b
    return abs(math.remainder(x, 2 * math.pi)) if turns[i] else abs(x)


def check_equilibria(ex, item, said):
    """Every place named is one of rest, and, where the list claims to be whole, every place found is named."""
    w, states = ex.w, ex.first or ex.near_by
    if not states or any(c.one_sided for c in w.rows) or ex.model.lagrangian is not None:
        return
    if any("t" in s.names_of(x) for x in [ex.model.L, ex.model.rayleigh] + [c.g for c in w.rows]
           + [e for Q in ex.model.pushes for e in Q.values()]):
        return
    if w.map_rows or any(c.velocity for c in w.rows):
        return
    active = list(range(len(w.rows)))
    turns = [periodic(w, i, [m.z for m in states[:2]]) for i in range(w.n)]
    named = named_places(ex, item)
    if any(k not in w.q for place in named for k in place):
        return                  # no number, or coordinates of the program's own
    check_named(ex, named, active)
    check_stability(ex, item, active)
    whole = not re.search(r"may be others|closed form|[Cc]ould|name them|sought|not |Only places", said)
    if not (named or "There is none" in said) or not whole:
        return
    all_sides = "Not looked at: places with" in said
    for q in found_places(ex, active):
        if not all_sides and not ex.assumed_there(q):
            continue
        ok = any(all(apart(w, w.q.index(k), turns, q[w.q.index(k)], x) < 1e-5 for k, x in place.items() if x is not None)
                 or same_points(ex, q, place, active) for place in named)
        ex.report.check("equilibrium missing", ok, lambda: (
            f"at rest at {dict(zip(w.q, [round(x, 6) for x in q]))}, which is not among {named} ({said[:200]})"))


def same_points(ex, q, place, active):
    """Whether all masses are where they are at a named place: r and -r may be the same."""
    w = ex.w
    at = completed(w, [place.get(k) if place.get(k) is not None else x for k, x in zip(w.q, q)],
                   [k for k, x in place.items() if x is not None], active)
    if at is None or not ex.model.masses:
        return False
    points = [x for _, where in ex.model.masses.values() for x in where]
    program = s.compiled(points, w.names)
    zero = [0.0] * w.n
    one, two = program(w.state(q, zero, 0.0)), program(w.state(at, zero, 0.0))
    return all(abs(a - b) < 1e-5 for a, b in zip(one, two))


class Place(dict):
    """Coordinates of a place, and what it assumes beside the assumptions of the whole answer."""

    def __init__(self, place, assuming):
        super().__init__(place)
        self.assuming = assuming


def named_places(ex, item):
    """Places by coordinate; None for a free coordinate, {'?': ..} for what has no number."""
    out = []
    for v in item["values"]:
        if not v["name"].startswith("equilibrium"):
            continue
        if v.get("exists_if") and not holds(ex, v["exists_if"]):
            continue
        place = {k: None for k in v.get("free", [])}
        for c in v.get("components", []):
            x = ex.formula(c, ex.numbers())
            place[c["along"]] = x
            if x is None:
                place = {"?": c["expr"]}
                break
        place = {re.sub(r"\[(-?\d+)\]", r"_\1", ascii_name(k) if k != "?" else k): x for k, x in place.items()}
        out.append(Place(place, v.get("assuming") or []))
    return out


def holds(ex, condition):
    m = re.fullmatch(r"(.*?)\s*(>=|<=|>|<|=)\s*(.*)", condition)
    if not m:
        return True
    a, b = (ex.formula({"expr": m.group(k)}, ex.numbers()) for k in (1, 3))
    if a is None or b is None:
        return True
    return {">=": a >= b - 1e-12, "<=": a <= b + 1e-12, ">": a > b, "<": a < b, "=": abs(a - b) < 1e-9}[m.group(2)]


def check_named(ex, named, active):
    w = ex.w
    for place in named:
        check_assumed(ex, place)
        if any(k not in w.q for k in place):
            continue
        best, closed = None, False
        for m in (ex.first + ex.near_by)[:10]:
            q = [place[k] if place.get(k) is not None else x for k, x in zip(w.q, m.q)]
            fixed = [k for k, x in place.items() if x is not None]
            q = completed(w, q, fixed, active)
            if q is None:
                continue
            closed = True
            try:
                r, p = static_residual(w, q, active)
            except Lost:
                continue
            size = max([abs(x) for x in p.f] + [1.0])
            off = max(abs(x) for x in r) / size
            best = off if best is None else min(best, off)
        if not closed:
            ex.report.check("equilibrium", False, f"{place} is named as a place of rest; no such place fulfils the constraints")
        if best is not None:
            ex.report.check("equilibrium", best < 1e-6, lambda: (
                f"{place} is named as a place of rest; a force of {best} is left there"))


def check_assumed(ex, place):
    """A place named is one that the assumptions of the same answer allow."""
    w = ex.w
    base = (ex.first or ex.near_by)[0]
    q = completed(w, [place[k] if place.get(k) is not None else x for k, x in zip(w.q, base.q)],
                  [k for k, x in place.items() if x is not None], list(range(len(w.rows))))
    if q is not None and None not in place.values():
        own = ex.read_assumptions(place.assuming)
        there = ex.meets(own, w.state(q, [0.0] * w.n, ex.model.start_time)) if own else ex.assumed_there(q)
        ex.report.check("equilibrium assumed", there, lambda: (
            f"{place} is named as a place of rest, against {place.assuming or ex.document['assumptions']}"))


def completed(w, q, fixed, active):
    """The other coordinates from the constraints, by Newton from where they are."""
    q = list(q)
    place = [j for j in active if not w.rows[j].velocity]
    for _ in range(30):
        try:
            p = w.at(w.state(q, [0.0] * w.n, 0.0))
        except Lost:
            return None
        r = [p.g[j] for j in place]
        if max([abs(x) for x in r] + [0.0]) < 1e-12:
            return q
        G = [expanded(w, p.G[j]) for j in place]
        G = [[0.0 if k in fixed else x for k, x in zip(w.q, row)] for row in G]
        step = least_norm(G, [-x for x in r])
        q = [a + b for a, b in zip(q, step)]
    return None


def found_places(ex, active):
    """Isolated places of rest in a box around the motion, by Newton from many starts."""
    w, rng, out = ex.w, random.Random(7), []
    base = (ex.first or ex.near_by)[0]
    for _ in range(30):
        q = newton(w, [x + rng.uniform(-3, 3) for x in base.q], active)
        if q is None or any(max(abs(a - b) for a, b in zip(q, o)) < 1e-5 for o in out):
            continue
        try:
            if isolated(w, q, active):
                out.append(q)
        except Lost:
            continue
    return out


# ------------------------------------------------------------------------------------------------ around a place of rest
def slow_motions(ex, q, active):
    """omega^2 of the small oscillations at a place of rest, sorted; None where this is no question of M and K."""
    w = ex.w
    d = [w.q.index(x) for x in w.d]
    p = w.at(w.state(q, [0.0] * w.n, 0.0))
    N = null_space([p.G[j] for j in active], len(d))
    if not velocity_free(ex, q) or not N:
        return None
    M = [[sum(a[i] * p.M[i][j] * b[j] for i in range(len(d)) for j in range(len(d))) for b in N] for a in N]
    columns = []
    for direction in N:
        h, moved = 1e-4, []
        for step in (h, -h):
            at = list(q)
            for k, i in enumerate(d):
                at[i] += step * direction[k]
            at = completed(w, at, [], active)
            if at is None:
                return None
            r, _ = static_residual(w, at, active)
            moved.append(r[: len(d)])
        columns.append([(a - b) / (2 * h) for a, b in zip(*moved)])
    K = [[-sum(a[i] * c[i] for i in range(len(d))) for c in columns] for a in N]
    return roots_of_pencil(M, K)


def velocity_free(ex, q):
    """Whether forces near rest hang on places alone: no damping, no gyroscopic terms."""
    w, zero = ex.w, [0.0] * ex.w.n
    base = w.at(w.state(q, zero, 0.0)).f
    for i in range(w.n):
        v = list(zero)
        v[i] = 1e-4
        if any(abs(a - b) > 1e-6 for a, b in zip(w.at(w.state(q, v, 0.0)).f, base)):
            return False
    return True


def null_space(G, n):
    """Orthonormal directions that the rows allow."""
    basis = []
    for row in G:
        basis = grown(basis, row)
    known = len(basis)
    for i in range(n):
        basis = grown(basis, [1.0 if k == i else 0.0 for k in range(n)])
    return basis[known:]


def grown(basis, v):
    for b in basis:
        x = sum(p * r for p, r in zip(v, b))
        v = [p - x * r for p, r in zip(v, b)]
    size = math.sqrt(sum(x * x for x in v))
    return basis + [[x / size for x in v]] if size > 1e-8 else basis


def roots_of_pencil(M, K):
    """det(K - s M) = 0 for one or two directions."""
    if len(M) == 1:
        return [K[0][0] / M[0][0]] if M[0][0] > 0 else None
    if len(M) > 2:
        return None
    a = M[0][0] * M[1][1] - M[0][1] * M[1][0]
    b = -(K[0][0] * M[1][1] + K[1][1] * M[0][0] - K[0][1] * M[1][0] - K[1][0] * M[0][1])
    c = K[0][0] * K[1][1] - K[0][1] * K[1][0]
    root = b * b - 4 * a * c
    if a <= 0 or root < 0:
        return None
    return sorted([(-b - math.sqrt(root)) / (2 * a), (-b + math.sqrt(root)) / (2 * a)])


def check_stability(ex, item, active):
    """`stable`, `unstable` and omega^2 of each place named, against M and K in numbers."""
    w, spoken = ex.w, {}
    for v in item["values"]:
        if v["name"] == "omega^2":
            spoken.setdefault(v.get("at"), []).append(number(ex, v))
    for v in item["values"]:
        places = named_places(ex, {"values": [v]})
        if not places or None in places[0].values() or not set(places[0]) <= set(w.q) or v.get("free"):
            continue
        place, found = places[0], None
        for m in (ex.first + ex.near_by)[:6]:
            q = completed(w, [place.get(k, x) for k, x in zip(w.q, m.q)], list(place), active)
            try:
                if q is not None and max(map(abs, static_residual(w, q, active)[0])) < 1e-6:
                    found = slow_motions(ex, q, active)
                    break
            except Lost:
                continue
        if not found:
            continue
        size = max(abs(x) for x in found) + 1e-3
        verdict = "stable" if found[0] > 1e-4 * size else "unstable" if found[0] < -1e-4 * size else None
        if verdict and v.get("stability") in ("stable", "unstable"):
            ex.report.check("stability", v["stability"] == verdict, lambda: (
                f"{place} is called {v['stability']}; omega^2 there is {found}"))
        said = spoken.get(v["name"], [])
        if said and None not in said:
            ex.report.check("modes", len(said) <= len(found) and all(
                min(abs(x - y) for y in found) < 1e-4 * size for x in said), lambda: (
                f"omega^2 at {place} is {said}, by numbers {found}"))


# ------------------------------------------------------------------------------------------------ first places
def check_where(ex, item, said):
    """`A where B = C` with one condition between coordinates: the first place that the motion meets."""
    m = re.fullmatch(r"(.*?)\s+where\s+(.*?)(?:\s+from\s+(.*))?", item["item"])
    if not m or " and " in m.group(2) or re.search(r"\blimit|series|\bof\b", m.group(1)):
        return
    wanted, condition, start = m.groups()
    try:
        tokens = tokens_of(condition)
        at = find_word(tokens, "=")
        g = Parser(tokens[:at], ex.model, {}).whole() - Parser(tokens[at + 1 :], ex.model, {}).whole()
        expr = wanted_expression(ex, re.sub(r"^solve\s+", "", wanted))
    except (Unread, AttributeError, IndexError, TypeError):
        return
    states = {n for q in ex.w.q for n in (q, q + "_dot")} | set(ex.w.values)
    if not s.names_of(g) <= states or not s.names_of(g) & {n for n in states if n not in ex.w.values}:
        return
    if start is None and ex.moments and abs(s.compiled([g], ex.w.names)(ex.moments[0].z)[0]) < 1e-9:
        return                  # the start is such a place
    met = first_meeting(ex, condition, start, expr)
    if met is None:
        return
    values = [v for v in item["values"] if v.get("expr")]
    numbers = [x for x in (number(ex, v) for v in values) if x is not None]
    if met == "never":
        never_given(ex, item, numbers)
    elif numbers:
        size = max(abs(met), 1.0)
        ex.report.check("where", any(abs(x - met) < 1e-5 * size for x in numbers), lambda: (
            f"{item['item']} is {numbers}, the motion first meets it with {met}"))
    elif re.search(r"never|niemals|nie\b|No state", said):
        ex.report.check("where", False, f"{item['item']}: {said[-160:]!r}, the motion meets it with {met}")
    elif any(v["expr"] == v["name"] for v in values):
        ex.report.check("where", False, f"{item['item']} is answered {values[0]['name']} = {values[0]['expr']}")
    else:
        ex.report.compared["where without number"] += 1


def wanted_expression(ex, text):
    """The quantity asked for: a result by its name, or an expression."""
    word = ascii_name(text.strip())
    if word in ("T", "V", "E") and word not in ex.model.coords + list(ex.model.params) + list(ex.model.lets):
        return s.name(word)
    if word in ex.multipliers():
        return s.name(word)
    return Parser(tokens_of(text), ex.model, {}).whole()


def number(ex, v):
    x = v.get("number")
    return x if x is not None else ex.formula(v, {**ex.numbers(), **ex.start_values()})


def never_given(ex, item, numbers):
    if not numbers:
        ex.report.compared["where never"] += 1
        return
    if ex.horizon_is_long:
        ex.report.check("where", False, f"{item['item']} is {numbers}, the motion never meets it")


def first_meeting(ex, condition, start, expr):
    """The value where the motion first meets the condition; 'never', or None where this cannot be told."""
    text = "\n".join(line for line in ex.text.splitlines() if not re.match(r"\s*(ask|simulate|plot|output|event)\b", line)
                     or re.search(r"->\s*(release|attach)", line))
    if start is not None:
        text = with_start(ex, text, start)
        if text is None:
            return None
    t0, t1 = ex.model.interval or (ex.model.start_time, ex.model.start_time + 1.0)
    end = t0 + 8 * (t1 - t0)
    from examine import column_name, spelled
    for q in ex.w.q:
        text += f"\noutput acc_{q} = {spelled(ex.model, q)}''"
    text += f"\nevent meeting: when {condition} -> stop\nsimulate {t0!r}..{end!r}\n"
    flags = []
    for k, v in ex.assumed.items():
        flags += ["--set", f"{k}={v!r}"]
    code, document, rows, _ = ex.program.simulate(text, *flags)
    if code != 0 or not rows:
        return None
    ex.horizon_is_long = True
    hit = [e for e in document.get("events", []) if e["label"] == "meeting"]
    if not hit:
        return "never"
    if hit[0]["t"] <= t0 + 1e-12:
        return None
    if not all(assumed(ex, e["state"], e["t"]) for e in document["events"]):
        return None
    names = {**ex.numbers(), **{column_name(k): x for k, x in {**hit[0]["values"], **hit[0]["state"]}.items()}}
    names.update({q + "_ddot": names["acc_" + q] for q in ex.w.q if "acc_" + q in names}, t=hit[0]["t"])
    names = {k: x for k, x in names.items() if x is not None and x == x}
    if not s.names_of(expr) <= set(names):
        return None
    order = sorted(s.names_of(expr))
    try:
        return s.compiled([expr], order)([names[n] for n in order])[0]
    except (ValueError, ZeroDivisionError, OverflowError):
        return None


def assumed(ex, state, t):
    """Whether a state is among those that the program speaks of."""
    from examine import column_name
    names = {column_name(k): x for k, x in state.items()}
    if not all(q in names and q + "_dot" in names for q in ex.w.q):
        return True
    return ex.holds_at(ex.w.state([names[q] for q in ex.w.q], [names[q + "_dot"] for q in ex.w.q], t))


def with_start(ex, text, start):
    """The text with another start: `x = 1 and y = 0 at rest`."""
    text = "\n".join(line for line in text.splitlines() if not re.match(r"\s*init\b", line))
    rest = start.endswith("at rest")
    parts = (start[: -len("at rest")] if rest else start).split(" and ")
    text += "\ninit " + ", ".join(p.strip() for p in parts)
    if not rest:
        return text
    from examine import spelled
    return text + "\ninit " + ", ".join(f"{spelled(ex.model, q)}' = 0" for q in ex.w.d)
