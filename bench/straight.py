"""Mechanical systems as straight-line programs for the peers: what an expert would write by hand, generated with SymPy.

A system  M(q,t) a = F(q,v,t) + G^T λ,  g(q,t) = 0  is turned into lists of assignments (common subexpressions named once):

    accelerations   M and G assembled, the KKT matrix factored as sparse L D L^T without pivots (masses first, then
                    constraints, as written), one solve; this is the reduced equation for explicit methods
    jacobian        of the accelerations by q and v: the same factors, one solve for each right side dR/d(q,v)
    residual, GGL   q' = v + G^T μ,  M v' = F + G^T λ,  g = 0,  G v + g_t = 0  for IDA, with its Jacobian in sparse form

The assignments are plain infix text with the names SIN COS SQRT LOG and K(p,q) = p/q, so that one text serves C with doubles, C with
__float128 (the references) and Python (heyoka).  Shares no code with pleuel.
"""
import sympy as sp
from sympy.printing.str import StrPrinter


class Infix(StrPrinter):
    """Powers as products, rationals as K(p,q)."""
    def _print_Rational(self, e):
        return f"K({e.p},{e.q})"

    _print_Half = _print_Rational

    def _print_Integer(self, e):
        return f"K({e.p},1)"

    _print_Zero = _print_One = _print_NegativeOne = _print_Integer

    def _print_Mul(self, e):
        sign, rest = ("-", -e) if e.could_extract_minus_sign() else ("", e)
        if not rest.is_Mul:
            return sign + self.factor(rest)
        top, bottom = [], []
        for f in rest.args:
            if f.is_Pow and f.exp.is_number and f.exp < 0:
                bottom.append(self.factor(1 / f))
            elif not f == 1:
                top.append(self.factor(f))
        text = "*".join(top) or "K(1,1)"
        return sign + (text if not bottom else f"{text}/({'*'.join(bottom)})")

    def factor(self, e):
        text = self._print(e)
        return text if e.is_Symbol or e.is_Function or (e.is_number and e.is_Rational and e >= 0) else f"({text})"

    def _print_Pow(self, e):
        if e.exp.is_Integer and e.exp > 0:
            return "*".join([self.factor(e.base)] * int(e.exp))
        if e.exp == sp.Rational(1, 2):
            return f"SQRT({self._print(e.base)})"
        if e.exp.is_negative:
            return f"K(1,1)/({self._print(1 / e)})"
        if e.exp.is_Rational and e.exp.q == 2:
            return f"{self.factor(e.base ** (e.exp.p // 2))}*SQRT({self._print(e.base)})"
        raise ValueError(f"power {e}")

    def _print_Add(self, e):
        text = ""
        for part in e.args:
            piece = self._print(part)
            text += piece if not text else f" - {piece[1:]}" if piece.startswith("-") and part.is_Mul else f" + ({piece})"
        return text

    def _print_Function(self, e):
        return f"{e.func.__name__.upper()}({self._print(e.args[0])})"


infix = Infix().doprint


class System:
    """Built from kinetic and potential energy, further forces and constraints over symbols q, v, t."""
    def __init__(self, q, v, T, V, forces, g, q0, v0):
        t = sp.Symbol("t")
        self.q, self.v, self.t = list(q), list(v), t
        self.n, self.m = len(q), len(g)
        momenta = [sp.diff(T, x) for x in v]
        self.M = {}
        self.F = []
        for i, p in enumerate(momenta):
            for x in p.free_symbols & set(v):
                j = self.v.index(x)
                if j <= i:
                    self.M[i, j] = sp.diff(p, x)
            rate = sp.diff(p, t) + sum(sp.diff(p, x) * u for x, u in zip(q, v) if p.has(x))
            self.F.append(forces[i] + sp.diff(T, q[i]) - sp.diff(V, q[i]) - rate)
        self.g = list(g)
        self.G, self.g_t, self.gamma = {}, [], []
        for c, e in enumerate(g):
            present = [i for i in range(self.n) if e.has(q[i])]
            for i in present:
                self.G[c, i] = sp.diff(e, q[i])
            self.g_t.append(sp.diff(e, t))
            speed = sum(self.G[c, i] * v[i] for i in present) + self.g_t[c]
            self.gamma.append(sum(sp.diff(speed, q[i]) * v[i] for i in present) + sp.diff(speed, t))
        self.q0, self.v0 = list(q0), list(v0)

    # ---- assignments
    def accelerations(self):
        """Assignments to a0.. and l0.. from q0.., v0.., t."""
        names, exprs = [], []
        for (i, j), e in sorted(self.M.items()):
            names.append(f"k_{i}_{j}"), exprs.append(e)
        for (c, i), e in sorted(self.G.items()):
            names.append(f"k_{self.n + c}_{i}"), exprs.append(-e)
        for i, e in enumerate(self.F):
            names.append(f"r_{i}"), exprs.append(e)
        for c, e in enumerate(self.gamma):
            names.append(f"r_{self.n + c}"), exprs.append(e)
        lines = named(names, exprs)
        filled = {tuple(map(int, n[2:].split("_"))) for n in names if n.startswith("k_")}
        self.factor_pattern = factor_lines(lines, filled, self.n + self.m)
        lines += solve_lines(self.factor_pattern, self.n + self.m, "r", "z")
        return lines

    def jacobian(self):
        """After accelerations(): assignments to J_row_col of d a / d(q,v), rows of a."""
        z = [sp.Symbol(f"z_{i}") for i in range(self.n + self.m)]
        a, lam = z[:self.n], z[self.n:]
        R = [sum(self.M.get((max(i, j), min(i, j)), 0) * a[j] for j in range(self.n))
             - sum(self.G.get((c, i), 0) * lam[c] for c in range(self.m)) - self.F[i] for i in range(self.n)]
        R += [-sum(self.G.get((c, i), 0) * a[i] for i in range(self.n)) - self.gamma[c] for c in range(self.m)]
        names, exprs = [], []
        columns = []
        for k, x in enumerate(self.q + self.v):
            rows = [i for i, e in enumerate(R) if e.has(x)]
            columns.append(rows)
            for i in rows:
                names.append(f"d{k}_{i}"), exprs.append(-sp.diff(R[i], x))
        lines = named(names, exprs, "w")
        for k, rows in enumerate(columns):
            lines += solve_lines(self.factor_pattern, self.n + self.m, f"d{k}", f"J{k}", set(rows), self.n)
        return lines

    def ggl(self):
        """(residual lines r_i, jacobian lines j_i, pattern [(row, column)], number of unknowns) for IDA; cj is a name."""
        n, m = self.n, self.m
        lam, mu = ([sp.Symbol(f"{s}{c}") for c in range(m)] for s in ("l", "u"))
        qp, vp = ([sp.Symbol(f"{s}p{i}") for i in range(n)] for s in ("q", "v"))
        R = [qp[i] - self.v[i] - sum(self.G.get((c, i), 0) * mu[c] for c in range(m)) for i in range(n)]
        R += [sum(self.M.get((max(i, j), min(i, j)), 0) * vp[j] for j in range(n))
              - sum(self.G.get((c, i), 0) * lam[c] for c in range(m)) - self.F[i] for i in range(n)]
        R += self.g
        R += [sum(self.G.get((c, i), 0) * self.v[i] for i in range(n)) + self.g_t[c] for c in range(m)]
        cj = sp.Symbol("cj")
        y, yp = self.q + self.v + lam + mu, qp + vp
        place = {x: i for i, x in enumerate(y)} | {x: i for i, x in enumerate(yp)}
        pattern, exprs = [], []
        for i, e in enumerate(R):
            found = {}
            for x in e.free_symbols & set(place):
                d = sp.diff(e, x) * (cj if x in yp else 1)
                found[place[x]] = found.get(place[x], 0) + d
            for j in sorted(found):
                pattern.append((i, j)), exprs.append(found[j])
        residual = named([f"r_{i}" for i in range(len(R))], R, "w")
        return residual, named([f"j_{i}" for i in range(len(exprs))], exprs, "w"), pattern, len(y)


def named(names, exprs, prefix="x"):
    common, rest = sp.cse(exprs, symbols=sp.numbered_symbols(prefix + "_"), order="none")
    return [(str(s), infix(e)) for s, e in common] + [(n, infix(e)) for n, e in zip(names, rest)]


def factor_lines(lines, filled, size):
    """Assignments of the factors L_i_j and 1/D_i appended; returns rows of L by column."""
    columns = {j: sorted(i for i, k in filled if k == j and i > j) for j in range(size)}
    current = {(i, j): f"k_{i}_{j}" for i, j in filled}
    for j in range(size):
        lines.append((f"e_{j}", f"K(1,1)/({current[j, j]})"))
        rows = columns[j]
        for i in rows:
            lines.append((f"f_{i}_{j}", f"({current[i, j]})*e_{j}"))
        for a, i in enumerate(rows):
            for k in rows[:a + 1]:
                old = current.get((i, k))
                name = f"s_{i}_{k}_{j}"
                update = f"f_{i}_{j}*({current[k, j]})"
                lines.append((name, f"{old} - {update}" if old else f"-({update})"))
                if not old and i != k:
                    columns[k] = sorted(columns[k] + [i])
                current[i, k] = name
    return columns


def solve_lines(columns, size, right, out, present=None, wanted=None):
    """out_i = (L D L^T)^-1 right; `present`: rows of the right side that are there; `wanted`: how many are read."""
    lines, now = [], {i: f"{right}_{i}" for i in (range(size) if present is None else present)}
    for j in range(size):
        if j not in now:
            continue
        for i in columns[j]:
            name = f"{out}_y{i}_{j}"
            lines.append((name, f"{now[i]} - f_{i}_{j}*{now[j]}" if i in now else f"-(f_{i}_{j}*{now[j]})"))
            now[i] = name
    for i in reversed(range(size)):
        text = f"{now[i]}*e_{i}" if i in now else "K(0,1)"
        for k in columns[i]:
            text += f" - f_{k}_{i}*{out}_{k}"
        lines.append((f"{out}_{i}", text))
    return lines


# ---------------------------------------------------------------------------------------------- C
def block(lines, indent="  "):
    return "\n".join(f"{indent}const real {name} = {text};" for name, text in lines)


def reads(names, array):
    return "\n".join(f"  const real {x} = {array}[{i}];" for i, x in enumerate(names))


def c_text(system):
    """The header that peer_*.c include; without a Jacobian of the accelerations for large systems."""
    n, m = system.n, system.m
    accelerations = system.accelerations()
    start = "\n".join(f"  y[{i}] = {infix(sp.nsimplify(e))};" for i, e in enumerate(system.q0 + system.v0))
    state = reads(system.q, "y") + "\n" + reads(system.v, f"(y + {n})")
    out = f"""// Generated by bench/straight.py
enum {{ N_Q = {n}, N_C = {m} }};
static void start(real* y) {{
{start}
}}
static void accelerations(real t, const real* restrict y, real* restrict a, real* restrict lambda) {{
  (void)t, (void)lambda;
{state}
{block(accelerations)}
""" + "".join(f"  a[{i}] = z_{i};\n" for i in range(n)) + (
        "  if (lambda) {\n" + "".join(f"    lambda[{c}] = z_{n + c};\n" for c in range(m)) + "  }\n" if m else "") + "}\n"
    if n > 50:
        return out + "#define WITHOUT_JACOBIAN\n" + ggl_text(system)
    jacobian = system.jacobian()
    out += f"""// d(v, a)/d(q, v), column-major (2 N_Q x 2 N_Q), zeroed by the caller
static void jacobian(real t, const real* restrict y, real* restrict J) {{
  (void)t;
{state}
{block(accelerations)}
{block(jacobian)}
""" + "".join(f"  J[{(n + i) * 2 * n + i}] = 1;\n" for i in range(n)) + "".join(
        f"  J[{k * 2 * n + n + i}] = J{k}_{i};\n" for k in range(2 * n) for i in range(n)) + "}\n"
    return out + ggl_text(system)


def ggl_text(system):
    n, m = system.n, system.m
    residual, entries, pattern, size = system.ggl()
    order = sorted(range(len(pattern)), key=lambda k: (pattern[k][1], pattern[k][0]))
    starts = [sum(1 for _, j in pattern if j < column) for column in range(size + 1)]
    state = (reads(system.q, "y") + "\n" + reads(system.v, f"(y + {n})") + "\n" + reads([f"l{c}" for c in range(m)], f"(y + {2 * n})")
             + "\n" + reads([f"u{c}" for c in range(m)], f"(y + {2 * n + m})") + "\n" + reads([f"qp{i}" for i in range(n)], "yp")
             + "\n" + reads([f"vp{i}" for i in range(n)], f"(yp + {n})"))
    ignore = "  (void)t, (void)y, (void)yp;\n"
    return f"""enum {{ N_GGL = {size}, N_ENTRIES = {len(pattern)} }};
static void ggl_residual(real t, const real* restrict y, const real* restrict yp, real* restrict r) {{
{ignore}{state}
{block(residual)}
""" + "".join(f"  r[{i}] = r_{i};\n" for i in range(size)) + f"""}}
static const int ggl_rows[N_ENTRIES] = {{{", ".join(str(pattern[k][0]) for k in order)}}};
static const int ggl_columns[N_GGL + 1] = {{{", ".join(map(str, starts))}}};
static void ggl_jacobian(real t, real cj, const real* restrict y, const real* restrict yp, real* restrict entries) {{
{ignore}{state}
{block(entries)}
""" + "".join(f"  entries[{k}] = j_{p};\n" for k, p in enumerate(order)) + "}\n"
