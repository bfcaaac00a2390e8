// answer_equilibria: positions of rest of the generalized coordinates, their stability and small oscillations.
//   f_i(q) = 0 with f the equations of the second kind at rest;  K = df/dq, M = d2T/dv2;  det(K - ω² M) = 0.
#include <math.h>
#include <string.h>

#include "derive/derive_impl.h"

enum { max_gen = 6, max_found = 32 };

typedef struct pl_rest {
  pl_expr q[max_gen];       // values of the generalized coordinates
  pl_expr condition;        // >= 0 for it to exist, or poison
} pl_rest;

typedef struct pl_rests {
  pl_rest at[max_found];
  int n;
  bool complete;
  int n_singular;           // positions where the coordinates fail
  pl_rest singular;         // the last of them
} pl_rests;

// ---------------------------------------------------------------------------------------------- equations at rest
static pl_expr at_rest(pl_analysis* d, pl_expr e) {
  pl_replace r[2 * max_gen];
  for (int k = 0; k < d->gen.n; k++) {
    const pl_variable* c = &d->q.at[d->gen.at[k]];
    r[2 * k] = (pl_replace){c->v, pl_int(d->pool, 0)};
    r[2 * k + 1] = (pl_replace){c->a, pl_int(d->pool, 0)};
  }
  return pl_alg_normal(d->tower, pl_subst(d->pool, e, r, 2 * d->gen.n));
}

static pl_expr insert(pl_analysis* d, pl_expr e, const pl_rest* r) {
  pl_replace s[max_gen];
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_is_poison(r->q[k])) s[n++] = (pl_replace){d->q.at[d->gen.at[k]].q, r->q[k]};
  }
  return pl_subst(d->pool, e, s, n);
}

// Generalized coordinate that is the only unknown one in e: its place, -1 none, -2 several.
static int only_unknown(const pl_analysis* d, pl_expr e, const pl_rest* r) {
  int found = -1;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_is_poison(r->q[k]) || !pl_has_symbol(d->pool, e, d->q.at[d->gen.at[k]].q)) continue;
    if (found >= 0) return -2;
    found = k;
  }
  return found;
}

// Of linear equations A q = b (rows x n) the independent rows and columns; the other coordinates stay free, a line or plane of
// positions.  False when the rows that are left over contradict, or a coefficient is not decided.
static bool solve_square(pl_analysis* d, int rows, int n, const pl_expr* A, const pl_expr* b, const int* unknown, pl_rest* r) {
  int row[max_gen], column[max_gen];
  pl_expr transposed[max_gen * max_gen], S[max_gen * max_gen], c[max_gen], x[max_gen];
  int rank = pl_alg_rank(d->tower, rows, n, A, row);
  for (int k = 0; k < rank; k++) {
    for (int j = 0; j < n; j++) transposed[j * rank + k] = A[row[k] * n + j];
  }
  if (rank == 0 || pl_alg_rank(d->tower, n, rank, transposed, column) != rank) return false;
  for (int k = 0; k < rank; k++) {
    c[k] = b[row[k]];
    for (int j = 0; j < n; j++) {
      bool solved = false;
      for (int i = 0; i < rank; i++) solved |= column[i] == j;
      pl_expr free = pl_mul(d->pool, A[row[k] * n + j], pl_sym(d->pool, d->q.at[d->gen.at[unknown[j]]].q));
      if (!solved) c[k] = pl_sub(d->pool, c[k], free);
    }
    for (int i = 0; i < rank; i++) S[k * rank + i] = A[row[k] * n + column[i]];
  }
  if (pl_alg_solve(d->tower, rank, S, c, x, 20000) != PL_YES) return false;
  for (int i = 0; i < rank; i++) r->q[unknown[column[i]]] = pl_alg_normal(d->tower, x[i]);
  return true;
}

static bool at_rest_everywhere(pl_analysis* d, const pl_expr* f, const pl_rest* r) {
  for (int k = 0; k < d->gen.n; k++) {
    if (pl_alg_is_zero(d->tower, insert(d, f[k], r)) != PL_YES) return false;
  }
  return true;
}

// Equations linear in the coordinates that are left: one position, or a line of them.
static bool solve_linear(pl_analysis* d, const pl_expr* f, pl_rest* r) {
  int unknown[max_gen], n = 0, rows = 0;
  pl_expr A[max_gen * max_gen], b[max_gen];
  for (int k = 0; k < d->gen.n; k++) {
    if (pl_is_poison(r->q[k])) unknown[n++] = k;
  }
  pl_replace zero[max_gen];
  for (int j = 0; j < n; j++) zero[j] = (pl_replace){d->q.at[d->gen.at[unknown[j]]].q, pl_int(d->pool, 0)};
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_alg_normal(d->tower, insert(d, f[k], r));
    if (pl_is_zero_node(d->pool, e)) continue;
    for (int j = 0; j < n; j++) {
      A[rows * n + j] = pl_alg_normal(d->tower, pl_diff(d->pool, e, d->q.at[d->gen.at[unknown[j]]].q));
      if (pl_has_coordinates(d, A[rows * n + j])) return false;
    }
    b[rows++] = pl_neg(d->pool, pl_subst(d->pool, e, zero, n));
  }
  return n > 0 && solve_square(d, rows, n, A, b, unknown, r);
}

static void search(pl_analysis* d, const pl_expr* f, pl_rest r, pl_rests* out);

// One coordinate of a branch solved from e, and the search goes on from each root.
static void branch(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_expr e, int j, pl_rests* out) {
  pl_root root[8];
  bool complete = false;
  int n = pl_alg_roots(d->tower, e, d->q.at[d->gen.at[j]].q, root, 8, &complete);
  out->complete &= complete;
  for (int i = 0; i < n; i++) {
    pl_rest next = *r;
    next.q[j] = root[i].value;
    if (!pl_is_poison(root[i].condition)) next.condition = root[i].condition;
    search(d, f, next, out);
  }
}

// An equation in several coordinates that falls into factors: each factor in a single one is a branch.
static bool branch_factors(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_expr e, pl_rests* out) {
  pl_factor factor[12];
  pl_expr unit;
  int n = pl_alg_factors(d->tower, e, factor, 12, &unit), single = 0;
  for (int k = 0; k < n; k++) {
    if (factor[k].power > 0 && only_unknown(d, factor[k].base, r) >= 0) single++;
  }
  if (n < 2 || single == 0) return false;
  for (int k = 0; k < n; k++) {
    if (factor[k].power < 0) continue;
    int j = only_unknown(d, factor[k].base, r);
    if (j >= 0) branch(d, f, r, factor[k].base, j, out);
    if (j == -2) out->complete = false;
  }
  return true;
}

// Where the mass matrix is singular the coordinates fail (r = 0 of polar ones): no position of rest.
static bool regular(pl_analysis* d, const pl_rest* r) {
  pl_expr M[max_gen * max_gen];
  int n = d->gen.n;
  for (int i = 0; i < n; i++) {
    pl_expr momentum = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[i]].v);
    for (int j = 0; j < n; j++) M[i * n + j] = insert(d, at_rest(d, pl_diff(d->pool, momentum, d->q.at[d->gen.at[j]].v)), r);
  }
  return pl_alg_is_zero(d->tower, pl_alg_det(d->tower, n, M, 20000)) != PL_YES;
}

// Solves equation after equation, each for the one coordinate that is left in it; branches multiply.
static void search(pl_analysis* d, const pl_expr* f, pl_rest r, pl_rests* out) {
  bool done = true;
  pl_expr several = pl_poison();
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_alg_normal(d->tower, insert(d, f[k], &r));
    if (pl_alg_is_zero(d->tower, e) == PL_YES) continue;
    int j = only_unknown(d, e, &r);
    if (j == -1) return;   // contradiction on this branch
    done = false;
    if (j < 0) {
      several = e;
      continue;
    }
    branch(d, f, &r, e, j, out);
    return;
  }
  pl_rest linear = r;
  if (!done && solve_linear(d, f, &linear)) {
    if (!at_rest_everywhere(d, f, &linear)) return;   // contradiction on this branch
    r = linear;
  } else if (!done) {
    if (pl_is_poison(several) || !branch_factors(d, f, &r, several, out)) out->complete = false;
    return;
  }
  if (!regular(d, &r)) {
    out->n_singular++;
    out->singular = r;
  } else if (out->n < max_found) {
    out->at[out->n++] = r;
  }
}

// ---------------------------------------------------------------------------------------------- stability
//   M u'' + C u' + K u = 0,  C split by symmetry into damping and gyroscopic terms.
typedef struct pl_linearised {
  int n;
  pl_expr M[max_gen * max_gen], C[max_gen * max_gen], K[max_gen * max_gen];
  bool damped, gyroscopic;
} pl_linearised;

static bool vanishes(pl_analysis* d, pl_expr e) { return pl_alg_is_zero(d->tower, e) == PL_YES; }

static void velocity_terms(pl_analysis* d, const pl_rest* r, pl_linearised* out) {
  int n = out->n;
  for (int i = 0; i < n; i++) {
    pl_expr f = pl_second_kind(d, d->gen.at[i]);
    for (int j = 0; j < n; j++) {
      pl_expr slope = pl_diff(d->pool, f, d->q.at[d->gen.at[j]].v);
      out->C[i * n + j] = pl_alg_normal(d->tower, insert(d, at_rest(d, slope), r));
    }
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j <= i; j++) {
      out->damped |= !vanishes(d, pl_add(d->pool, out->C[i * n + j], out->C[j * n + i]));
      out->gyroscopic |= !vanishes(d, pl_sub(d->pool, out->C[i * n + j], out->C[j * n + i]));
    }
  }
}

static void linearise(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_linearised* out) {
  *out = (pl_linearised){.n = d->gen.n};
  velocity_terms(d, r, out);
  for (int i = 0; i < out->n; i++) {
    pl_expr momentum = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[i]].v);
    for (int j = 0; j < out->n; j++) {
      pl_expr M = pl_diff(d->pool, momentum, d->q.at[d->gen.at[j]].v);
      out->M[i * out->n + j] = pl_alg_normal(d->tower, insert(d, at_rest(d, M), r));
      out->K[i * out->n + j] = pl_alg_normal(d->tower, insert(d, pl_diff(d->pool, f[i], d->q.at[d->gen.at[j]].q), r));
    }
  }
}

// Signs of the leading minors of K: all positive is stable; some negative is unstable.  Free coordinates, which no force
// depends on, drift at will and are left out.
static const char* stability(pl_analysis* d, const pl_linearised* l, const pl_rest* r, pl_expr* stable_if) {
  bool all = true;
  *stable_if = pl_poison();
  int held[max_gen], n = 0;
  for (int k = 0; k < l->n; k++) {
    if (!pl_is_poison(r->q[k])) held[n++] = k;
  }
  for (int m = 1; m <= n; m++) {
    pl_expr A[max_gen * max_gen];
    for (int i = 0; i < m; i++) {
      for (int j = 0; j < m; j++) A[i * m + j] = l->K[held[i] * l->n + held[j]];
    }
    pl_expr minor = pl_alg_normal(d->tower, pl_alg_det(d->tower, m, A, 20000));
    int sign = 0;
    pl_answer3 known = pl_alg_sign(d->tower, minor, false, &sign);
    if (known != PL_YES) {
      *stable_if = minor;
      all = false;
    } else if (sign < 0) {
      return l->gyroscopic ? NULL : "unstable";   // gyroscopic terms may hold what forces do not
    } else if (sign == 0) {
      return "marginal";
    }
  }
  if (n == 0) return "marginal";
  return all ? "stable" : NULL;
}

static pl_symbol omega_squared(pl_analysis* d) {
  bool taken = pl_symbol_find(d->pool, "omega").id != 0;   // the model has an ω of its own
  pl_symbol_info info = {.name = taken ? "Ω²" : "ω²", .ascii = "omega_squared", .role = PL_R_LOCAL, .class = PL_C_OTHER,
                         .dimension = pl_dimension_of(0, 0, -2), .dimension_known = true};
  return pl_symbol_make(d->pool, &info);
}

// det(K - ω² M); with gyroscopic terms det(K + s C + s² M), which is even in s, at s² = -ω².  Damping is left out: what is
// given then are the frequencies of the undamped system, and that is said.
static pl_expr characteristic(pl_analysis* d, const pl_linearised* l, pl_symbol w2) {
  pl_pool* p = d->pool;
  int n = l->n;
  pl_symbol_info info = {.name = "s", .ascii = "characteristic_s", .role = PL_R_LOCAL, .class = PL_C_OTHER};
  pl_symbol s = pl_symbol_make(p, &info);
  pl_expr A[max_gen * max_gen], c[2 * max_gen + 1];
  for (int k = 0; k < n * n; k++) A[k] = pl_sub(p, l->K[k], pl_mul(p, pl_sym(p, w2), l->M[k]));
  if (!l->gyroscopic) return pl_alg_det(d->tower, n, A, 20000);
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      pl_expr turn = pl_mul(p, pl_ratio(p, 1, 2), pl_sub(p, l->C[i * n + j], l->C[j * n + i]));
      A[i * n + j] = pl_add(p, A[i * n + j], pl_mul(p, pl_sym(p, s), turn));
    }
  }
  int degree = pl_alg_coefficients(d->tower, pl_alg_det(d->tower, n, A, 20000), s, c, 2 * max_gen);
  pl_expr sum = degree < 0 ? pl_poison() : pl_int(p, 0);
  for (int k = 0; k <= degree; k += 2) {
    sum = pl_add(p, sum, pl_mul(p, c[k], pl_pow_int(p, pl_neg(p, pl_sym(p, w2)), k / 2)));
  }
  return sum;
}

static int small_oscillations(pl_analysis* d, const pl_linearised* l, pl_root* root, int max) {
  pl_symbol w2 = omega_squared(d);
  bool complete;
  return pl_alg_roots(d->tower, characteristic(d, l, w2), w2, root, max, &complete);
}

// ---------------------------------------------------------------------------------------------- display
static bool is_angle(pl_analysis* d, int i) {
  const pl_symbol_info* s = pl_symbol_get(d->pool, d->q.at[i].q);
  bool plain = !s->dimension_known || pl_dimension_equal(s->dimension, pl_dimension_one());
  if (!plain) return false;
  pl_expr c = pl_call(d->pool, PL_COS, pl_sym(d->pool, d->q.at[i].q)), s2 = pl_call(d->pool, PL_SIN, pl_sym(d->pool, d->q.at[i].q));
  pl_expr mark = pl_int(d->pool, 7);
  pl_expr probe = pl_add(d->pool, d->Tg, d->Vg);
  return !pl_same(pl_subst_expr(d->pool, probe, c, mark), probe) || !pl_same(pl_subst_expr(d->pool, probe, s2, mark), probe);
}

// No equation contains a coordinate: every position is one of rest.
static const pl_form* all_free(pl_analysis* d) {
  pl_text words[2] = {pl_text_make(d->arena), pl_text_make(d->arena)};
  for (int k = 0; k < d->gen.n; k++) {
    const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[k]].q)->name;
    pl_text_addf(&words[0], "%s%s", k ? ", " : "any ", name);
    pl_text_addf(&words[1], "%s%s", k ? ", " : "jedes ", name);
  }
  return pl_form_words(d->arena, pl_text_string(&words[0]), pl_text_string(&words[1]));
}

static const pl_form* rest_form(pl_analysis* d, const pl_rest* r) {
  const pl_form* f[max_gen];
  int n = 0;
  for (int k = 0; k < d->gen.n; k++) {
    int i = d->gen.at[k];
    if (pl_is_poison(r->q[k])) continue;
    const pl_form* value = pl_f(d, r->q[k], PL_S_PLAIN);
    double x = pl_number(d, r->q[k]);
    if (is_angle(d, i) && !isnan(x) && x != 0) {
      pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
      value = pl_feq(d, value, pl_fn(d, pl_format(d->arena, "%s°", pl_notation_number(d->arena, x * 180 / M_PI, 6, how))));
    }
    f[n++] = pl_feq(d, pl_fs(d, d->q.at[i].q), value);
  }
  if (n == 0) return all_free(d);
  return n == 1 ? f[0] : pl_flist(d, f, n);
}

static const char* german_stability(const char* s) {
  return strcmp(s, "stable") == 0 ? "stabil" : strcmp(s, "unstable") == 0 ? "instabil" : "indifferent";
}

static void show_oscillations(pl_analysis* d, const pl_linearised* l, const char* at) {
  pl_root root[8];
  int n = small_oscillations(d, l, root, 8);
  for (int k = 0; k < n; k++) {
    const pl_form* form = pl_f(d, root[k].value, PL_S_QUOTIENT);
    pl_step* s = pl_show_numbered(d, pl_feq(d, pl_fs(d, omega_squared(d)), form));
    bool zero = vanishes(d, root[k].value);
    pl_step_after(s, zero ? "zero mode: it drifts" : "small oscillations", zero ? "Nullmode: Drift" : "kleine Schwingungen");
    double x = pl_number(d, root[k].value);
    if (x > 0) {
      s->has_value = true;
      s->value = sqrt(x);
      s->unit = "1/s";
      s->value_name = strncmp(pl_symbol_get(d->pool, omega_squared(d))->name, "Ω", 2) == 0 ? "Ω" : "ω";
    }
    pl_value* v = pl_answer(d, "omega^2", root[k].value, form);
    v->of = pl_format(d->arena, "mode %d", k + 1);
    v->at = at;
  }
}

// A one-sided constraint that would have to pull: the position is none of rest.
static const pl_bond* pulls(pl_analysis* d, const pl_rest* r) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!l->contact || !l->lambda_known || l->implied) continue;
    pl_expr lambda = insert(d, at_rest(d, l->lambda_value), r);
    bool push_is_positive = (l->source->relation == PL_GE) != d->model->lambda_minus;
    int sign = pl_sign_at_numbers(d, pl_alg_normal(d->tower, lambda));
    if (sign != 0 && (sign > 0) != push_is_positive) return l;
  }
  return NULL;
}

static void say_pulls(pl_analysis* d, const pl_bond* l, const pl_rest* r) {
  pl_say(d, "{1} is none: {2} is one-sided and would have to act the other way.",
         "{1} ist keine: {2} ist einseitig und müsste andersherum wirken.", 2, rest_form(d, r), pl_fn(d, l->source->name.text));
}

static void say_singular(pl_analysis* d, const pl_rests* found) {
  if (found->n_singular == 0) return;
  pl_say(d, "At positions like {1} the forces vanish too, but these coordinates fail there (the mass matrix is singular); other coordinates decide.",
         "Auch bei Lagen wie {1} verschwinden die Kräfte, aber diese Koordinaten versagen dort (die Massenmatrix ist singulär); andere Koordinaten "
         "entscheiden.", 1, rest_form(d, &found->singular));
}

static void say_velocity_terms(pl_analysis* d, const pl_linearised* l) {
  if (l->damped) {
    pl_say(d, "The motion is damped; ω² is that of the system without damping.", "Die Bewegung ist gedämpft; ω² ist das ohne Dämpfung.", 0);
  }
}

static void show_rest(pl_analysis* d, const pl_expr* f, const pl_rest* r, int number) {
  pl_linearised l;
  linearise(d, f, r, &l);
  pl_expr stable_if;
  const char* verdict = stability(d, &l, r, &stable_if);
  pl_step* step = pl_show(d, rest_form(d, r));
  double at_numbers = verdict ? (double)NAN : pl_number(d, stable_if);
  const char* here = verdict ? verdict : at_numbers > 0 ? "stable" : at_numbers < 0 && !l.gyroscopic ? "unstable" : NULL;
  if (verdict) pl_step_after(step, verdict, german_stability(verdict));
  if (!verdict && here) {
    pl_step_after(step, pl_format(d->arena, "%s for the given numbers", here),
                  pl_format(d->arena, "%s bei den gegebenen Zahlen", german_stability(here)));
  }
  pl_value v = {.name = pl_format(d->arena, "equilibrium %d", number), .number = (double)NAN, .conserved = -1, .passed = -1, .order = -1,
                .stability = here};
  v.components = PL_ARRAY(d->arena, pl_component, d->gen.n);
  const char** free_names = PL_ARRAY(d->arena, const char*, d->gen.n);
  for (int k = 0; k < d->gen.n; k++) {
    const char* name = pl_symbol_get(d->pool, d->q.at[d->gen.at[k]].q)->ascii;
    if (pl_is_poison(r->q[k])) {
      free_names[v.n_free++] = name;
      continue;
    }
    v.components[v.n_components++] = (pl_component){name, r->q[k], pl_f(d, r->q[k], PL_S_PLAIN), pl_number(d, r->q[k])};
  }
  v.free_names = free_names;
  if (!pl_is_poison(r->condition)) {
    v.exists_if = pl_format(d->arena, "%s >= 0", pl_expr_text(d->arena, d->pool, r->condition));
    pl_say(d, "exists if {1}", "besteht, wenn {1}", 1, pl_frel(d, pl_f(d, r->condition, PL_S_PLAIN), "≥", pl_form_leaf(d->arena, pl_int(d->pool, 0))));
  }
  if (!verdict && l.gyroscopic) {
    pl_say(d, "No minimum of the potential is proven here; the gyroscopic terms decide with the signs of ω².",
           "Ein Minimum des Potentials ist hier nicht bewiesen; die gyroskopischen Terme entscheiden mit den Vorzeichen von ω².", 0);
  } else if (!verdict) {
    v.stable_if = pl_format(d->arena, "%s > 0", pl_expr_text(d->arena, d->pool, stable_if));
    pl_say(d, "stable if {1}", "stabil, wenn {1}", 1, pl_frel(d, pl_f(d, stable_if, PL_S_PLAIN), ">", pl_form_leaf(d->arena, pl_int(d->pool, 0))));
  }
  pl_push(d->arena, d->section->values, v);
  bool oscillates = !here || strcmp(here, "stable") == 0;
  if (oscillates) say_velocity_terms(d, &l);
  if (oscillates) show_oscillations(d, &l, v.name);
  for (int k = 0; k < d->gen.n; k++) pl_claim_free(d, PL_CLAIM_INSERTED, insert(d, f[k], r), pl_int(d->pool, 0));
}

static bool at_rest_equations(pl_analysis* d, pl_expr* f) {
  for (int k = 0; k < d->gen.n; k++) f[k] = at_rest(d, pl_second_kind(d, d->gen.at[k]));
  if (!pl_has_symbol(d->pool, pl_add_n(d->pool, f, d->gen.n), pl_time(d->pool))) return true;
  pl_say(d, "The equations contain t: there is no position of rest.", "Die Gleichungen enthalten t: es gibt keine Ruhelage.", 0);
  return false;
}

static pl_rests* find_rests(pl_analysis* d, const pl_expr* f) {
  pl_rests* found = PL_NEW(d->arena, pl_rests);
  found->complete = true;
  search(d, f, (pl_rest){0}, found);
  return found;
}

// Positions of rest are sought in a few generalized coordinates.
static bool out_of_reach(pl_analysis* d) {
  if (d->reduced && d->gen.n == 0) {
    pl_say(d, "No coordinate is free: the constraints give the position.", "Keine Koordinate ist frei: die Zwangsbedingungen geben die Lage.", 0);
    return true;
  }
  if (d->reduced && d->gen.n <= max_gen) return false;
  if (!d->reduced) {
    pl_say(d, "They are sought in generalized coordinates, and the constraints were not solved for such. Name them: choose φ with ...",
           "Sie werden in verallgemeinerten Koordinaten gesucht, und danach sind die Zwangsbedingungen nicht aufgelöst. Man nenne sie: choose φ with ...",
           0);
  } else {
    pl_say(d, pl_format(d->arena, "They are sought for up to %d generalized coordinates; here there are %d.", max_gen, d->gen.n),
           pl_format(d->arena, "Sie werden für höchstens %d verallgemeinerte Koordinaten gesucht; hier sind es %d.", max_gen, d->gen.n), 0);
  }
  d->section->not_found = true;
  return true;
}

void pl_answer_equilibria(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Equilibria", "Gleichgewichtslagen");
  pl_expr f[max_gen];
  if (out_of_reach(d)) return;
  if (ask->where.n > 0) {
    pl_answer_pending(d, ask);
    return;
  }
  if (!at_rest_equations(d, f)) return;
  pl_rests* found = find_rests(d, f);
  int shown = 0;
  for (int k = 0; k < found->n; k++) {
    const pl_bond* against = pulls(d, &found->at[k]);
    if (against) say_pulls(d, against, &found->at[k]);
    else show_rest(d, f, &found->at[k], ++shown);
  }
  say_singular(d, found);
  if (shown == 0 && found->complete && found->n_singular == 0) pl_say(d, "There is none.", "Es gibt keine.", 0);
  if (!found->complete) {
    pl_say(d, found->n > 0 ? "There may be others: not every equation was solved in closed form."
                           : "None was found in closed form.",
           found->n > 0 ? "Es kann weitere geben: nicht jede Gleichung war geschlossen lösbar." : "Geschlossen wurde keine gefunden.", 0);
    d->section->not_found = found->n == 0;
  }
}

// ---------------------------------------------------------------------------------------------- modes
// The amplitudes of a mode: cofactors of a row of K - ω² M that do not all vanish, the first non-zero one scaled to 1.
static bool amplitudes(pl_analysis* d, const pl_linearised* l, pl_expr w2, pl_expr* u) {
  int n = l->n;
  for (int row = 0; row < n; row++) {
    int first = -1;
    for (int j = 0; j < n; j++) {
      pl_expr A[max_gen * max_gen];
      int m = 0;
      for (int a = 0; a < n; a++) {
        for (int b = 0; b < n; b++) {
          if (a != row && b != j) A[m++] = pl_sub(d->pool, l->K[a * n + b], pl_mul(d->pool, w2, l->M[a * n + b]));
        }
      }
      pl_expr minor = n == 1 ? pl_int(d->pool, 1) : pl_alg_normal(d->tower, pl_alg_det(d->tower, n - 1, A, 20000));
      u[j] = (row + j) % 2 ? pl_neg(d->pool, minor) : minor;
      if (first < 0 && pl_alg_is_zero(d->tower, minor) == PL_NO) first = j;
    }
    if (first < 0) continue;
    pl_expr scale = u[first];
    for (int j = 0; j < n; j++) u[j] = pl_alg_normal(d->tower, pl_div(d->pool, u[j], scale));
    return true;
  }
  return false;
}

static void show_mode(pl_analysis* d, const pl_linearised* l, pl_expr w2, int number, const char* at) {
  const pl_form* form = pl_f(d, w2, PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, omega_squared(d)), form));
  pl_step_after(step, pl_format(d->arena, "mode %d", number), pl_format(d->arena, "Mode %d", number));
  pl_value v = {.name = "omega^2", .of = pl_format(d->arena, "mode %d", number), .at = at, .form = form, .expr = w2,
                .number = pl_number(d, w2), .unit = "1/s^2", .conserved = -1, .passed = -1, .order = -1};
  pl_expr u[max_gen];
  if (!l->gyroscopic && amplitudes(d, l, w2, u)) {
    const pl_form* ratio[max_gen];
    v.components = PL_ARRAY(d->arena, pl_component, l->n);
    for (int j = 0; j < l->n; j++) {
      const pl_symbol_info* q = pl_symbol_get(d->pool, d->q.at[d->gen.at[j]].q);
      ratio[j] = pl_f(d, u[j], PL_S_QUOTIENT);
      v.components[v.n_components++] = (pl_component){q->ascii, u[j], ratio[j], pl_number(d, u[j])};
    }
    if (l->n > 1) {
      const pl_form* names[max_gen];
      for (int j = 0; j < l->n; j++) names[j] = pl_fs(d, d->q.at[d->gen.at[j]].q);
      pl_say(d, "amplitudes {1} as {2}", "Amplituden {1} wie {2}", 2, pl_flist(d, names, l->n), pl_flist(d, ratio, l->n));
    }
  }
  pl_push(d->arena, d->section->values, v);
}

static void show_modes(pl_analysis* d, const pl_expr* f, const pl_rest* r, int number) {
  pl_linearised l;
  linearise(d, f, r, &l);
  const char* at = pl_format(d->arena, "equilibrium %d", number);
  pl_say(d, "At {1}:", "Bei {1}:", 1, rest_form(d, r));
  say_velocity_terms(d, &l);
  pl_root root[max_gen];
  int n = small_oscillations(d, &l, root, max_gen);
  for (int k = 0; k < n; k++) show_mode(d, &l, root[k].value, k + 1, at);
  if (n < l.n) {
    pl_say(d, "Not every root of the characteristic equation was found in closed form.",
           "Nicht jede Wurzel der charakteristischen Gleichung war geschlossen zu finden.", 0);
    d->section->not_found = n == 0;
  }
}

// The position named by `at (u = 0, v = 0)`; what is not named is free to fit an equilibrium.
static bool named_position(pl_analysis* d, const pl_ask* ask, const pl_rest* r) {
  for (int k = 0; k < d->gen.n; k++) {
    for (int c = 0; c < ask->where.n; c++) {
      if (!pl_same(ask->where.at[c].left, pl_sym(d->pool, d->q.at[d->gen.at[k]].q))) continue;
      if (pl_is_poison(r->q[k]) || pl_alg_equal(d->tower, r->q[k], ask->where.at[c].right) != PL_YES) return false;
    }
  }
  return true;
}

void pl_answer_modes(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Modes", "Eigenschwingungen");
  pl_expr f[max_gen];
  if (out_of_reach(d)) return;
  if (!at_rest_equations(d, f)) return;
  pl_rests* found = find_rests(d, f);
  int shown = 0, number = 0;
  for (int k = 0; k < found->n; k++) {
    if (pulls(d, &found->at[k])) continue;
    number++;
    if (!named_position(d, ask, &found->at[k])) continue;
    show_modes(d, f, &found->at[k], number);
    shown++;
  }
  if (shown > 0) return;
  pl_say(d, "No equilibrium to oscillate about was found there.", "Dort wurde keine Gleichgewichtslage gefunden.", 0);
  d->section->not_found = true;
}
