// answer_equilibria: positions of rest of the generalized coordinates, their stability and small oscillations.
//   f_i(q) = 0 with f the equations of the second kind at rest;  K = df/dq, M = d2T/dv2;  det(K - ω² M) = 0.
#include <math.h>
#include <string.h>

#include "derive/equilibria_impl.h"

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
  int row[pl_max_gen], column[pl_max_gen];
  pl_expr transposed[pl_max_gen * pl_max_gen], S[pl_max_gen * pl_max_gen], c[pl_max_gen], x[pl_max_gen];
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
    if (pl_alg_is_zero(d->tower, pl_insert_rest(d, f[k], r)) != PL_YES) return false;
  }
  return true;
}

// Equations linear in the coordinates that are left: one position, or a line of them.
static bool solve_linear(pl_analysis* d, const pl_expr* f, pl_rest* r) {
  int unknown[pl_max_gen], n = 0, rows = 0;
  pl_expr A[pl_max_gen * pl_max_gen], b[pl_max_gen];
  for (int k = 0; k < d->gen.n; k++) {
    if (pl_is_poison(r->q[k])) unknown[n++] = k;
  }
  pl_replace zero[pl_max_gen];
  for (int j = 0; j < n; j++) zero[j] = (pl_replace){d->q.at[d->gen.at[unknown[j]]].q, pl_int(d->pool, 0)};
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_alg_normal(d->tower, pl_insert_rest(d, f[k], r));
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
  pl_expr M[pl_max_gen * pl_max_gen];
  int n = d->gen.n;
  for (int i = 0; i < n; i++) {
    pl_expr momentum = pl_diff(d->pool, d->Lg, d->q.at[d->gen.at[i]].v);
    for (int j = 0; j < n; j++) M[i * n + j] = pl_insert_rest(d, pl_at_rest(d, pl_diff(d->pool, momentum, d->q.at[d->gen.at[j]].v)), r);
  }
  return pl_alg_is_zero(d->tower, pl_alg_det(d->tower, n, M, 20000)) != PL_YES;
}

// Solves equation after equation, each for the one coordinate that is left in it; branches multiply.
static void search(pl_analysis* d, const pl_expr* f, pl_rest r, pl_rests* out) {
  bool done = true;
  pl_expr several = pl_poison();
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_alg_normal(d->tower, pl_insert_rest(d, f[k], &r));
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
  } else if (out->n < pl_max_found) {
    out->at[out->n++] = r;
  }
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

const pl_form* pl_rest_form(pl_analysis* d, const pl_rest* r) {
  const pl_form* f[pl_max_gen];
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
  int n = pl_small_oscillations(d, l, root, 8);
  if (n > 0 && !l->gyroscopic) pl_why_oscillations(d, l->M, l->K, l->n);
  for (int k = 0; k < n; k++) {
    const pl_form* form = pl_f(d, root[k].value, PL_S_QUOTIENT);
    pl_step* s = pl_show_numbered(d, pl_feq(d, pl_fs(d, pl_omega_squared(d)), form));
    for (int r = 0; r < d->lagrange2_numbers.n; r++) pl_step_refs(s, 1, d->lagrange2_numbers.at[r]);
    bool zero = pl_vanishes(d, root[k].value);
    pl_step_after(s, zero ? "zero mode: it drifts" : "small oscillations", zero ? "Nullmode: Drift" : "kleine Schwingungen");
    double x = pl_number(d, root[k].value);
    if (x > 0) {
      s->has_value = true;
      s->value = sqrt(x);
      s->unit = "1/s";
      s->value_name = strncmp(pl_symbol_get(d->pool, pl_omega_squared(d))->name, "Ω", 2) == 0 ? "Ω" : "ω";
    }
    pl_value* v = pl_answer(d, "omega^2", root[k].value, form);
    v->of = pl_format(d->arena, "mode %d", k + 1);
    v->at = at;
  }
}

// A one-sided constraint that would have to pull: the position is none of rest.
const pl_bond* pl_rest_pulls(pl_analysis* d, const pl_rest* r) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (!l->contact || !l->lambda_known || l->implied) continue;
    pl_expr lambda = pl_insert_rest(d, pl_at_rest(d, l->lambda_value), r);
    bool push_is_positive = (l->source->relation == PL_GE) != d->model->lambda_minus;
    int sign = pl_sign_at_numbers(d, pl_alg_normal(d->tower, lambda));
    if (sign != 0 && (sign > 0) != push_is_positive) return l;
  }
  return NULL;
}

static void say_pulls(pl_analysis* d, const pl_bond* l, const pl_rest* r) {
  pl_say(d, "{1} is none: {2} is one-sided and would have to act the other way.",
         "{1} ist keine: {2} ist einseitig und müsste andersherum wirken.", 2, pl_rest_form(d, r), pl_fn(d, l->source->name.text));
}

static void say_singular(pl_analysis* d, const pl_rests* found) {
  if (found->n_singular == 0) return;
  pl_say(d, "At positions like {1} the forces vanish too, but these coordinates fail there (the mass matrix is singular); other coordinates decide.",
         "Auch bei Lagen wie {1} verschwinden die Kräfte, aber diese Koordinaten versagen dort (die Massenmatrix ist singulär); andere Koordinaten "
         "entscheiden.", 1, pl_rest_form(d, &found->singular));
}

void pl_say_velocity_terms(pl_analysis* d, const pl_linearised* l) {
  if (l->damped) {
    pl_say(d, "The motion is damped; ω² is that of the system without damping.", "Die Bewegung ist gedämpft; ω² ist das ohne Dämpfung.", 0);
  }
}

static void show_rest(pl_analysis* d, const pl_expr* f, const pl_rest* r, int number) {
  pl_linearised l;
  pl_linearise(d, f, r, &l);
  pl_expr stable_if;
  const char* verdict = pl_stability(d, &l, r, &stable_if);
  pl_step* step = pl_show(d, pl_rest_form(d, r));
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
  if (oscillates) pl_say_velocity_terms(d, &l);
  if (oscillates) show_oscillations(d, &l, v.name);
  for (int k = 0; k < d->gen.n; k++) pl_claim_free(d, PL_CLAIM_INSERTED, pl_insert_rest(d, f[k], r), pl_int(d->pool, 0));
}

// A quantity that is given through others, ω = √(2 g k), is a special case: positions of rest are sought with it inserted.
static pl_expr with_relations(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->model->params.n; k++) {
    const pl_param* given = &d->model->params.at[k];
    if (pl_is_poison(given->value) || pl_is_constant(d->pool, given->value)) continue;
    e = pl_subst1(d->pool, e, given->symbol, given->value);
  }
  return pl_alg_normal(d->tower, e);
}

bool pl_at_rest_equations(pl_analysis* d, pl_expr* f) {
  for (int k = 0; k < d->gen.n; k++) f[k] = with_relations(d, pl_at_rest(d, pl_second_kind(d, d->gen.at[k])));
  if (!pl_has_symbol(d->pool, pl_add_n(d->pool, f, d->gen.n), pl_time(d->pool))) return true;
  pl_say(d, "The equations contain t: there is no position of rest.", "Die Gleichungen enthalten t: es gibt keine Ruhelage.", 0);
  return false;
}

pl_rests* pl_find_rests(pl_analysis* d, const pl_expr* f) {
  pl_rests* found = PL_NEW(d->arena, pl_rests);
  found->complete = true;
  search(d, f, (pl_rest){0}, found);
  return found;
}

// Positions of rest are sought in a few generalized coordinates.
bool pl_rests_out_of_reach(pl_analysis* d) {
  if (d->reduced && d->gen.n == 0) {
    pl_say(d, "No coordinate is free: the constraints give the position.", "Keine Koordinate ist frei: die Zwangsbedingungen geben die Lage.", 0);
    return true;
  }
  if (d->reduced && d->gen.n <= pl_max_gen) return false;
  if (!d->reduced) {
    pl_say(d, "They are sought in generalized coordinates, and the constraints were not solved for such. Name them: choose φ with ...",
           "Sie werden in verallgemeinerten Koordinaten gesucht, und danach sind die Zwangsbedingungen nicht aufgelöst. Man nenne sie: choose φ with ...",
           0);
  } else {
    pl_say(d, pl_format(d->arena, "They are sought for up to %d generalized coordinates; here there are %d.", pl_max_gen, d->gen.n),
           pl_format(d->arena, "Sie werden für höchstens %d verallgemeinerte Koordinaten gesucht; hier sind es %d.", pl_max_gen, d->gen.n), 0);
  }
  d->section->not_found = true;
  return true;
}

// The coordinates of `for` take part again.
static void end_of_steady(pl_analysis* d) {
  if (d->steady.n == 0) return;
  d->steady.n = d->gen.n = 0;
  pl_collect_generalized(d);
}

// `for φ' = Ω`: the coordinate is driven at a steady rate and is no freedom then.  It must not occur itself.
static bool turns_steadily(pl_analysis* d, const pl_ask* ask) {
  for (int k = 0; k < ask->where.n; k++) {
    const pl_condition* c = &ask->where.at[k];
    pl_symbol v = pl_kind_of(d->pool, c->left) == PL_SYMBOL ? pl_symbol_of(d->pool, c->left) : (pl_symbol){0};
    int i = pl_variable_index(d, v), place = -1;
    for (int j = 0; j < d->gen.n; j++) {
      if (d->gen.at[j] == i && d->q.at[i].v.id == v.id) place = j;
    }
    bool steady = place >= 0 && !pl_has_coordinates(d, c->right) && !pl_has_symbol(d->pool, c->right, pl_time(d->pool));
    if (!steady || pl_alg_is_zero(d->tower, pl_diff(d->pool, d->Lg, d->q.at[i].q)) != PL_YES) {
      pl_say(d, "After `for` the velocity of a cyclic coordinate is given a constant value, as in φ' = Ω.",
             "Nach `for` erhält die Geschwindigkeit einer zyklischen Koordinate einen festen Wert, wie in φ' = Ω.", 0);
      end_of_steady(d);
      d->section->not_found = true;
      return false;
    }
    pl_push(d->arena, d->steady, (pl_replace){v, c->right});
    for (int j = place + 1; j < d->gen.n; j++) d->gen.at[j - 1] = d->gen.at[j];
    d->gen.n--;
  }
  return true;
}

void pl_answer_equilibria(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Equilibria", "Gleichgewichtslagen");
  pl_expr f[pl_max_gen];
  if (pl_rests_out_of_reach(d)) return;
  if (ask->where.n > 0 && !turns_steadily(d, ask)) return;
  if (!pl_at_rest_equations(d, f)) {
    end_of_steady(d);
    return;
  }
  pl_rests* found = pl_find_rests(d, f);
  int shown = 0;
  for (int k = 0; k < found->n; k++) {
    const pl_bond* against = pl_rest_pulls(d, &found->at[k]);
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
  end_of_steady(d);
}

// ---------------------------------------------------------------------------------------------- thresholds
enum { max_thresholds = 16 };
typedef struct pl_found_thresholds { pl_expr value[max_thresholds]; int n; } pl_found_thresholds;

// The values of a given quantity at which the stability of a position of rest changes, or at which it comes into being: the roots of
// its conditions.
static void threshold_of(pl_analysis* d, pl_expr e, pl_symbol x, pl_found_thresholds* found, const pl_form* where) {
  pl_root root[8];
  bool complete = false;
  if (pl_is_poison(e) || !pl_has_symbol(d->pool, e, x)) return;
  int n = pl_alg_roots(d->tower, e, x, root, 8, &complete), own = 0, sign = 0;
  bool positive = pl_alg_sign(d->tower, pl_sym(d->pool, x), false, &own) == PL_YES && own > 0;
  double here = pl_number(d, pl_sym(d->pool, x));
  for (int k = 0; k < n; k++) {
    pl_expr value = root[k].value;
    bool negative = pl_alg_sign(d->tower, value, true, &sign) == PL_YES && sign <= 0;
    if (negative && (positive || here > 0)) continue;
    bool told = false;
    for (int j = 0; j < found->n; j++) told |= pl_alg_equal(d->tower, found->value[j], value) == PL_YES;
    if (told || found->n == max_thresholds) continue;
    found->value[found->n++] = value;
    const pl_form* form = pl_f(d, value, PL_S_QUOTIENT);
    pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, x), form));
    bool known;
    pl_step_value(d, step, value, pl_dimension_of_expr(d, value, &known));
    pl_answer(d, pl_symbol_get(d->pool, x)->ascii, value, form);
    pl_say(d, "where the stability of {1} changes", "dort ändert sich die Stabilität von {1}", 1, where);
    pl_claim_free(d, PL_CLAIM_INSERTED, pl_subst1(d->pool, e, x, value), pl_int(d->pool, 0));
  }
}

void pl_answer_threshold(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Threshold", "Schwelle");
  pl_expr f[pl_max_gen];
  if (!ask->label || strcmp(ask->label, "stable") != 0 || !ask->variable.id) {
    pl_answer_pending(d, ask);
    return;
  }
  if (pl_rests_out_of_reach(d) || !pl_at_rest_equations(d, f)) return;
  pl_rests* rests = pl_find_rests(d, f);
  pl_found_thresholds found = {.n = 0};
  for (int k = 0; k < rests->n; k++) {
    pl_linearised l;
    pl_expr stable_if;
    pl_linearise(d, f, &rests->at[k], &l);
    if (pl_stability(d, &l, &rests->at[k], &stable_if)) continue;
    threshold_of(d, stable_if, ask->variable, &found, pl_rest_form(d, &rests->at[k]));
  }
  if (found.n > 0) return;
  pl_say(d, "No position of rest changes its stability with {1}.", "Keine Ruhelage ändert mit {1} ihre Stabilität.", 1, pl_fs(d, ask->variable));
}
