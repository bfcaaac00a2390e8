"""Mechanics of a model from first principles, in numbers: accelerations, multipliers, rank, positions of rest, motion.

It knows the model from model.py alone.  The equations are d/dt(dL/dv) - dL/dq = Q + G^T lambda with the second derivatives of
the constraints beside them; which contacts hold is found by trying every set of them.
"""

import itertools
import math
import random

import symbols as s
from symbols import name, num


class Lost(Exception):
    """The witness cannot tell: a singular place, or several answers."""


def reduced(A, b, tolerance=1e-10):
    """Gauss-Jordan with full pivoting.  Gives (solution, determined, rank, consistent)."""
    n, k = len(A), len(A[0]) if A else 0
    M = [list(row) + [x] for row, x in zip(A, b)]
    size = max([abs(x) for row in A for x in row] + [1e-300])
    columns, rank = list(range(k)), 0
    for step in range(min(n, k)):
        best, at = 0.0, None
        for i in range(step, n):
            for j in range(step, k):
                if abs(M[i][j]) > best:
                    best, at = abs(M[i][j]), (i, j)
        if best <= tolerance * size:
            break
        i, j = at
        M[step], M[i] = M[i], M[step]
        for row in M:
            row[step], row[j] = row[j], row[step]
        columns[step], columns[j] = columns[j], columns[step]
        pivot = M[step][step]
        M[step] = [x / pivot for x in M[step]]
        for i in range(n):
            f = M[i][step]
            if i != step and f:
                top = M[step]
                M[i] = [x - f * y for x, y in zip(M[i], top)]
        rank += 1
    rest = max([abs(M[i][k]) for i in range(rank, n)] + [0.0])
    consistent = rest <= 1e-6 * max(1.0, max([abs(x) for x in b] + [0.0]))
    x, determined = [0.0] * k, [False] * k
    for i in range(rank):
        x[columns[i]] = M[i][k]
        determined[columns[i]] = all(abs(M[i][j]) < 1e-7 for j in range(rank, k))
    return x, determined, rank, consistent


def rank_of(A, tolerance=1e-9):
    if not A:
        return 0
    rows = []
    for r in A:
        size = max(abs(x) for x in r) if r else 0
        rows.append([x / size for x in r] if size > 0 else r)
    return reduced(rows, [0.0] * len(rows), tolerance)[2]


class Witness:
    def __init__(self, model, values=None):
        self.m = model
        self.q = list(model.coords)
        self.n = len(self.q)
        self.values = {k: v for k, v in model.params.items()}
        for k, v in (values or {}).items():
            self.values[k] = v
        self.parameters = list(self.values)
        self.names = self.q + [q + "_dot" for q in self.q] + ["t"] + self.parameters
        self.acceleration_names = [q + "_ddot" for q in self.q]
        self.split_coordinates()
        self.build()

    # -------------------------------------------------------------------------------------------- building
    def split_coordinates(self):
        """Coordinates of `choose` that only name a place take no part in the dynamics."""
        m = self.m
        self.rows = [c for c in m.constraints if not c.is_map]
        self.kinematic, self.map_rows = [], [c for c in m.constraints if c.is_map]
        if not self.map_rows:
            return
        carried = set()
        for e in [m.L, m.rayleigh] + [c.g for c in self.rows]:
            carried |= {strip(n) for n in s.names_of(e)}
        for Q in m.pushes:
            for k, e in Q.items():
                carried |= {strip(n) for n in s.names_of(e)} | {k}
        spare = [q for q in self.q if q in m.chosen and q not in carried]
        if not self.maps_only_name(spare):
            self.rows, self.map_rows = self.rows + self.map_rows, []
            return
        self.kinematic = spare

    def maps_only_name(self, spare):
        """Whether the maps restrict nothing: rank with them is rank without them and one for each new name."""
        rng = random.Random(5)
        if not spare:
            return False
        rows = [c.g for c in self.rows if not c.velocity]
        grad = [[s.diff(g, q) for q in self.q] for g in rows + [c.g for c in self.map_rows]]
        program = s.compiled([x for r in grad for x in r] + [c.g for c in self.map_rows], self.names)
        for _ in range(8):
            z = [rng.uniform(0.3, 1.2) for _ in range(2 * self.n + 1)]
            z += [self.values[p] if self.values[p] is not None else 1.3 for p in self.parameters]
            z = self.on_maps(z)
            try:
                got = program(z)
            except (ValueError, ZeroDivisionError, OverflowError):
                continue
            G = [got[i * self.n : (i + 1) * self.n] for i in range(len(grad))]
            return rank_of(G) == rank_of(G[: len(rows)]) + len(spare)
        return False

    def on_maps(self, z):
        """Old coordinates from new ones, so that rank is asked on the set where the maps hold."""
        for c, old in zip(self.map_rows, self.m.maps):
            if old in self.q:
                i = self.q.index(old)
                g = s.compiled([c.g], self.names)
                z[i] = 0.0
                try:
                    z[i] = -g(z)[0]
                except (ValueError, ZeroDivisionError, OverflowError):
                    pass
        return z

    def build(self):
        m = self.m
        self.d = [q for q in self.q if q not in self.kinematic]      # coordinates with dynamics
        v = [q + "_dot" for q in self.d]
        p = [s.diff(m.L, x) for x in v]
        M = [[s.diff(pi, vj) for vj in v] for pi in p]
        force = []
        for q, vi, pi in zip(self.d, v, p):
            f = s.diff(m.L, q) - s.diff(m.rayleigh, vi) - s.diff(pi, "t")
            for other in self.d:
                f = f - s.diff(pi, other) * name(other + "_dot")
            for Q in m.pushes:
                f = f + Q.get(q, num(0))
            force.append(f)
        self.sizes = (len(self.d), len(self.rows))
        roots = [x for row in M for x in row] + force
        for c in self.rows:
            roots += self.row(c, v)
        self.steady = m.steady if m.steady is not None else num(float("nan"))
        roots += [m.T, m.V, self.jacobi(p, v), self.steady]
        extra = {n for e in roots for n in s.names_of(e)} - set(self.names)
        if extra:
            raise Lost(f"the equations contain {sorted(extra)}")
        self.program = s.compiled(roots, self.names)
        self.slips = self.read_friction()
        self.map_program = self.build_maps()
        self.lets = self.build_lets()

    def read_friction(self):
        """Row number: (coefficient, the two coordinates of the mass that rubs); None where it is more than that."""
        out = {}
        for label, (mu, more) in self.m.friction.items():
            j = next((k for k, c in enumerate(self.rows) if c.label == label), None)
            if j is None or "surface" in more or "at" in more or not s.is_num(self.numbered(mu)):
                return None
            moved = [q for q in self.d if not s.is_num(s.diff(self.rows[j].g, q), 0)]
            owners = [at for _, at in self.m.masses.values() if {x.args[0] for x in at if x.op == "name"} >= set(moved)]
            if len(owners) != 1 or len(owners[0]) != 2 or any(x.op != "name" for x in owners[0]):
                return None
            out[j] = (self.numbered(mu).args[0], [self.d.index(x.args[0]) for x in owners[0]])
        return out

    def numbered(self, e):
        return s.replaced(e, {k: num(v) for k, v in self.values.items() if v is not None})

    def jacobi(self, p, v):
        h = num(0) - self.m.L
        for pi, vi in zip(p, v):
            h = h + pi * name(vi)
        return h

    def row(self, c, v):
        """g, its rate, its gradient, its second rate without accelerations."""
        g, rate = c.g, c.g
        if not c.velocity:
            rate = self.m.total(g)
        gradient = [s.diff(rate, vi) for vi in v]
        gamma = s.diff(rate, "t")
        for q in self.d:
            gamma = gamma + s.diff(rate, q) * name(q + "_dot")
        return [g, rate] + gradient + [gamma]

    def build_maps(self):
        """Rates of the new coordinates of maps."""
        if not self.kinematic:
            return None
        roots = []
        for c in self.map_rows:
            rate = self.m.total(c.g)
            second = self.m.total(rate)
            roots.append(c.g)
            roots += [s.diff(c.g, q) for q in self.kinematic]
            roots += [s.replaced(rate, {q + "_dot": num(0) for q in self.kinematic}),
                      s.replaced(second, {q + "_ddot": num(0) for q in self.kinematic})]
        return s.compiled(roots, self.names + [q + "_ddot" for q in self.q])

    def build_lets(self):
        out = {}
        for word in self.m.lets:
            try:
                e = self.m.let(word)
            except Exception:  # noqa: BLE001  an abbreviation of results
                continue
            if not isinstance(e, tuple) and s.names_of(e) <= set(self.names + self.acceleration_names):
                out[word] = s.compiled([e], self.names + self.acceleration_names)
        return out

    # -------------------------------------------------------------------------------------------- numbers
    def state(self, q, v, t):
        return list(q) + list(v) + [t] + [self.values[p] for p in self.parameters]

    def at(self, z):
        """Everything at a state: a Point."""
        try:
            got = self.program(z)
        except (ValueError, ZeroDivisionError, OverflowError, TypeError) as e:
            raise Lost(f"no numbers here: {e}")
        if any(x != x or abs(x) == math.inf for x in got[:-1]):
            raise Lost("no numbers here")
        return Point(self, z, got)


def strip(n):
    for tail in ("_ddot", "_dot"):
        if n.endswith(tail):
            return n[: -len(tail)]
    return n


class Point:
    """The equations at one state."""

    def __init__(self, w, z, got):
        self.w, self.z = w, z
        n, k = w.sizes
        self.M = [got[i * n : (i + 1) * n] for i in range(n)]
        self.f = got[n * n : n * n + n]
        at, width = n * n + n, n + 3
        self.g, self.rate, self.G, self.gamma = [], [], [], []
        for j in range(k):
            part = got[at + j * width : at + (j + 1) * width]
            self.g.append(part[0])
            self.rate.append(part[1])
            self.G.append(part[2:-1])
            self.gamma.append(part[-1])
        self.T, self.V, self.H, self.steady = got[-4:]

    def candidates(self, released):
        """Contacts that touch and do not separate at first order; the smallest bounce followed is faster."""
        out = []
        for j, c in enumerate(self.w.rows):
            if c.one_sided and c.label not in released:
                size = max([abs(x) for x in self.G[j]] + [1e-9])
                if abs(self.g[j]) <= 1e-9 * size and abs(self.rate[j]) <= 1e-10 * size:
                    out.append(j)
        return out

    def always(self, released):
        return [j for j, c in enumerate(self.w.rows) if not c.one_sided and c.label not in released]

    def solve(self, active):
        """Accelerations and multipliers with these rows in force; what rubs, slips."""
        rubs = [j for j in active if j in (self.w.slips or {})]
        for signs in itertools.product((1.0, -1.0), repeat=len(rubs)):
            a, lam, determined = self.solve_pushed(active, dict(zip(rubs, signs)))
            if all(lam[active.index(j)] * sign >= 0 for j, sign in zip(rubs, signs)):
                return a, lam, determined
        raise Lost("friction fits with no sign of the force")

    def rubbing(self, j, push):
        """The gradient of a row with the friction that belongs to it, against the slip along the tangent."""
        mu, (x, y) = self.w.slips[j]
        row, n, at = list(self.G[j]), self.w.n, [self.w.q.index(q) for q in self.w.d]
        size = math.hypot(row[x], row[y])
        tangent = (row[y] / size, -row[x] / size)
        slip = tangent[0] * self.z[n + at[x]] + tangent[1] * self.z[n + at[y]]
        if abs(slip) < 1e-6:
            raise Lost("it sticks, or begins to slip")
        pull = -mu * size * math.copysign(1.0, slip) * push
        return {x: pull * tangent[0], y: pull * tangent[1]}

    def solve_pushed(self, active, pushes):
        n = self.w.sizes[0]
        column = {j: [self.G[j][i] for i in range(n)] for j in active}
        for j, push in pushes.items():
            for i, extra in self.rubbing(j, push).items():
                column[j][i] += extra
        A = [self.M[i] + [-column[j][i] for j in active] for i in range(n)]
        A += [self.G[j] + [0.0] * len(active) for j in active]
        x, determined, rank, consistent = reduced(A, self.f + [-self.gamma[j] for j in active])
        if not consistent:
            raise Lost("the equations contradict each other")
        return x[:n], x[n:], determined

    def motion(self, released=frozenset()):
        """Accelerations, multipliers (None where undetermined), and the rows in force."""
        fixed, touch = self.always(released), self.candidates(released)
        found = []
        for size in range(len(touch), -1, -1):
            for chosen in itertools.combinations(touch, size):
                got = self.feasible(fixed, chosen, touch)
                if got:
                    found.append(got)
        if not found:
            raise Lost("no set of contacts fits")
        first = found[0]
        for other in found[1:]:
            if any(abs(a - b) > 1e-6 * max(1, abs(a)) for a, b in zip(first.a, other.a)):
                raise Lost("several sets of contacts fit")
        best = max(found, key=lambda r: (r.all_known, -len(r.active)))
        best.touching = [self.w.rows[j].label for j in touch]
        return best

    def feasible(self, fixed, chosen, touch):
        active = fixed + list(chosen)
        try:
            a, lam, determined = self.solve(active)
        except Lost:
            return None
        if not all(determined[: len(a)]):
            return None
        for j, x in zip(active, lam):
            c = self.w.rows[j]
            if c.one_sided and (x < -1e-8 if c.sense == ">=" else x > 1e-8):
                return None
        for j in touch:
            if j not in active:
                second = sum(x * y for x, y in zip(self.G[j], a)) + self.gamma[j]
                if second < -1e-7 if self.w.rows[j].sense == ">=" else second > 1e-7:
                    return None
        return Motion(self, a, dict(zip(active, lam)), dict(zip(active, determined[len(a):])))


class Motion:
    """What follows from the equations at a state."""

    def __init__(self, point, a, lam, known):
        self.point, self.a, self.active = point, a, sorted(lam)
        self.lam, self.known = lam, known
        self.all_known = all(known.values())
        self.touching = []

    def labels(self):
        """One-sided constraints that are closed."""
        rows = self.point.w.rows
        return sorted(rows[j].label for j in self.active if rows[j].one_sided)

    def accelerations(self):
        w = self.point.w
        out = {q: a for q, a in zip(w.d, self.a)}
        for q, (_, a) in kinematic_rates(w, self.point.z, self.a).items():
            out[q] = a
        return out

    def multipliers(self):
        """By name, in the sign of the model; None where several fit."""
        w, out = self.point.w, {}
        for j, c in enumerate(w.rows):
            if c.is_map:
                continue
            out[c.multiplier] = w.m.sign * self.lam[j] if j in self.lam and self.known[j] else (
                None if j in self.lam else 0.0)
        return out


def kinematic_rates(w, z, a):
    """Velocity and acceleration of coordinates that only name a place, by least squares."""
    if not w.map_program:
        return {}
    k = len(w.kinematic)
    by = dict(zip(w.d, a))
    second = [by.get(q, 0.0) for q in w.q]
    try:
        got = w.map_program(list(z) + second)
        width = k + 3
        rows = [got[i * width : (i + 1) * width] for i in range(len(w.map_rows))]
        J = [r[1 : 1 + k] for r in rows]
        N = [[sum(r[i] * r[j] for r in J) for j in range(k)] for i in range(k)]
        v = reduced(N, [-sum(r[i] * row[1 + k] for r, row in zip(J, rows)) for i in range(k)])
        z2 = list(z)
        for i, q in enumerate(w.kinematic):
            z2[w.n + w.q.index(q)] = v[0][i]
        got = w.map_program(z2 + second)
        rows = [got[i * width : (i + 1) * width] for i in range(len(w.map_rows))]
        x = reduced(N, [-sum(r[i] * row[2 + k] for r, row in zip(J, rows)) for i in range(k)])
    except (ValueError, ZeroDivisionError, OverflowError):
        return {}
    off = max(abs(row[0]) + abs(row[2 + k] + sum(j * y for j, y in zip(row[1 : 1 + k], x[0]))) for row in rows)
    if v[2] < k or off > 1e-6 * max(1.0, max(abs(y) for y in second)):
        return {}               # nothing ties the new coordinate to the old ones here
    return {q: (v[0][i], x[0][i]) for i, q in enumerate(w.kinematic)}


def kinematic_places(w, z):
    """z with the places of such coordinates by Newton on the maps; None where it fails."""
    if not w.map_program:
        return z
    k, z = len(w.kinematic), list(z)
    zero = [0.0] * w.n
    for _ in range(30):
        try:
            got = w.map_program(z + zero)
        except (ValueError, ZeroDivisionError, OverflowError):
            return None
        rows = [got[i * (k + 3) : (i + 1) * (k + 3)] for i in range(len(w.map_rows))]
        if max(abs(r[0]) for r in rows) < 1e-12:
            return z
        J = [r[1 : 1 + k] for r in rows]
        N = [[sum(r[i] * r[j] for r in J) for j in range(k)] for i in range(k)]
        step = reduced(N, [-sum(r[i] * row[0] for r, row in zip(J, rows)) for i in range(k)])[0]
        for i, q in enumerate(w.kinematic):
            z[w.q.index(q)] += step[i]
    return None


# ------------------------------------------------------------------------------------------------ states of one's own
def project(w, q, v, t, active_labels=None, released=frozenset()):
    """The nearest place on the constraints, with a velocity that keeps them; None where Newton fails."""
    q, v = list(q), list(v)
    for _ in range(40):
        p = w.at(w.state(q, v, t))
        rows = [j for j in p.always(released)] + [j for j, c in enumerate(w.rows)
                                                 if c.one_sided and c.label in (active_labels or ())]
        place = [j for j in rows if not w.rows[j].velocity]
        residual = [p.g[j] for j in place]
        if max([abs(x) for x in residual] + [0.0]) < 1e-13:
            break
        G = [expanded(w, p.G[j]) for j in place]
        step = least_norm(G, [-x for x in residual])
        q = [a + b for a, b in zip(q, step)]
    else:
        return None
    p = w.at(w.state(q, v, t))
    G = [expanded(w, p.G[j]) for j in rows]
    v = [a + b for a, b in zip(v, least_norm(G, [-p.rate[j] for j in rows]))]
    p = w.at(w.state(q, v, t))
    if max([abs(p.rate[j]) for j in rows] + [0.0]) > 1e-9:
        return None
    return q, v


def expanded(w, row):
    by = dict(zip(w.d, row))
    return [by.get(q, 0.0) for q in w.q]


def least_norm(G, b):
    """The shortest x with G x = b."""
    if not G:
        return [0.0] * 64
    n = len(G[0])
    A = [[sum(x * y for x, y in zip(r, c)) for c in G] for r in G]
    y = reduced(A, b)[0]
    return [sum(G[j][i] * y[j] for j in range(len(G))) for i in range(n)]


# ------------------------------------------------------------------------------------------------ motion by integration
DP_C = [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1]
DP_A = [[], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]]
DP_E = [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]


def integrate(w, q, v, t0, t1, active, tolerance=1e-10, most=4000):
    """Dormand and Prince with the rows in `active` in force.  Coordinates that only name a place stay."""
    d = [w.q.index(x) for x in w.d]
    y, t, h = [q[i] for i in d] + [v[i] for i in d], t0, (t1 - t0) / 4
    n, calls = len(d), 0

    def rate(t, y):
        full_q, full_v = list(q), list(v)
        for k, i in enumerate(d):
            full_q[i], full_v[i] = y[k], y[n + k]
        a = w.at(w.state(full_q, full_v, t)).solve(active)[0]
        return y[n:] + a

    while (t1 - t) * math.copysign(1, t1 - t0) > 1e-14 * max(1, abs(t1)):
        h = min(h, t1 - t) if t1 > t0 else max(h, t1 - t)
        k = []
        for c, row in zip(DP_C, DP_A):
            at = [yi + h * sum(a * ki[i] for a, ki in zip(row, k)) for i, yi in enumerate(y)]
            k.append(rate(t + c * h, at))
        calls += 7
        wrong = max(abs(h * sum(e * ki[i] for e, ki in zip(DP_E, k))) / (1 + abs(y[i])) for i in range(2 * n))
        if calls > most:
            raise Lost("the integration takes too long")
        if wrong <= tolerance:
            y, t = at, t + h
        h *= min(4.0, max(0.2, 0.9 * (tolerance / max(wrong, 1e-18)) ** 0.2))
    return dict(zip(w.d, y[:n])), dict(zip(w.d, y[n:]))
