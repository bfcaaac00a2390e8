// The numbers that formulas are read with at a sample of a motion: by symbol, as pl_eval wants
// them.
//
// A second table holds the same state moved by more than the noise of a run. What a formula changes
// by is a measure of the digits that it can have there, cancellation and poles included.
#include <math.h>
#include <string.h>

#include "witness/witness_impl.h"

static const double moved = 1e-9;      // relative, of what the state is moved by
static const double rounding = 1e-11;  // of the terms of a formula
// of the change that this makes: what formula and motion may differ by
static const double times_moved = 100;

// ------------------------------------------------------------------------------------------ tables
static double largest(const double* x, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

// Where everything is at rest or uniform, what a run leaves of forces that cancel is rounding.
static double or_small(double size) {
  static const double nothing = 1e-12, small = 1e-3;
  return size < nothing ? small : size;
}

void pl_state_sizes(pl_witness* w) {
  for (int i = 0; i < w->starts.n; i++) {
    const pl_trace* t = w->starts.at[i].trace;
    if (!t->started) continue;
    const pl_trace_sample* s = &t->samples.at[0];
    int n = t->recording->flat.n;
    const pl_setup* setup = &t->recording->setup;
    if (setup->kinetic >= 0 && setup->potential >= 0) {
      w->e_size = fmax(w->e_size, fabs(s->out[setup->kinetic]) + fabs(s->out[setup->potential]));
    }
    w->q_size = fmax(w->q_size, largest(s->q, n));
    w->v_size = fmax(w->v_size, largest(s->v, n));
    w->a_size = fmax(w->a_size, largest(s->a, n));
    w->l_size = fmax(w->l_size, largest(s->lambda, t->recording->setup.n_c));
  }
  w->e_size = or_small(w->e_size);
  w->a_size = or_small(w->a_size);
  w->l_size = or_small(w->l_size);
}

void pl_state_open(pl_witness* w) {
  pl_state_sizes(w);
  int n = pl_symbol_count(w->pool) + 1;
  if (n <= w->n_value) return;
  w->value = PL_ARRAY(w->arena, double, n);
  w->shifted = PL_ARRAY(w->arena, double, n);
  w->n_value = n;
}

static void put(pl_witness* w, pl_symbol s, double x, double shift) {
  if (s.id == 0 || (int)s.id >= w->n_value) return;
  w->value[s.id] = x;
  w->shifted[s.id] = x + shift;
}

// Of its own size and a tenth of that of its kind, with a sign of its own: not all move alike.
static double shift_of(double x, double size, uint64_t k) {
  double sign = pl_hash_mix(k, 0x6d6f7665) & 1 ? 1 : -1;
  return sign * moved * (fabs(x) + 0.1 * size);
}

// Where all of a kind rest, a little of what they are at other starts.
static double size_of(const double* x, int n, double elsewhere) {
  return fmax(largest(x, n), 1e-3 * elsewhere);
}

static void put_coordinates(pl_witness* w, const pl_trace* t, const pl_trace_sample* s,
                            const pl_trace_sample* start) {
  const pl_flat_coords* flat = &t->recording->flat;
  double q = size_of(s->q, flat->n, w->q_size), v = size_of(s->v, flat->n, w->v_size),
         a = size_of(s->a, flat->n, w->a_size);
  double q0 = size_of(start->q, flat->n, w->q_size), v0 = size_of(start->v, flat->n, w->v_size);
  for (int i = 0; i < flat->n; i++) {
    if (pl_kind_of(w->pool, flat->at[i]) != PL_SYMBOL) continue;
    pl_symbol x = pl_symbol_of(w->pool, flat->at[i]), dot = pl_symbol_dot(w->pool, x);
    uint64_t k = 4 * (uint64_t)i;
    put(w, x, s->q[i], shift_of(s->q[i], q, k));
    put(w, dot, s->v[i], shift_of(s->v[i], v, k + 1));
    put(w, pl_symbol_dot(w->pool, dot), s->a[i], shift_of(s->a[i], a, k + 2));
    put(w, pl_symbol_start(w->pool, x), start->q[i], shift_of(start->q[i], q0, k));
    put(w, pl_symbol_start(w->pool, dot), start->v[i], shift_of(start->v[i], v0, k + 1));
  }
}

static void put_multipliers(pl_witness* w, const pl_trace* t, const pl_trace_sample* s) {
  const pl_setup* setup = &t->recording->setup;
  double size = size_of(s->lambda, setup->n_c, w->l_size);
  for (int i = 0; i < t->model->constraints.n; i++) {
    const pl_constraint* c = &t->model->constraints.at[i];
    if (c->block || !c->lambda.id) continue;
    int at = t->recording->first_constraint[i];
    double x = setup->constraints[at].minus ? -s->lambda[at] : s->lambda[at];
    put(w, c->lambda, s->unique[at] ? x : (double)NAN, shift_of(x, size, 1000 + (uint64_t)i));
  }
}

// What a result is small beside: energies, or forces.
static double size_of_result(const pl_witness* w, pl_result_kind kind) {
  bool force = kind == PL_RES_FORCE_NORM || kind == PL_RES_NORMAL;
  return 1e-3 * (force ? w->l_size : w->e_size);
}

// T, E, norm(force(rope)): as the simulation reads them.
static void put_results(pl_witness* w, const pl_trace* t, const pl_trace_sample* s,
                        const pl_trace_sample* origin) {
  const pl_setup* setup = &t->recording->setup;
  for (int i = 0; i < w->model->result_names.n; i++) {
    const char* name = pl_format(w->arena, "witness_%d", i);
    double size = size_of_result(w, w->model->result_names.at[i].kind);
    for (int k = 0; k < setup->n_out; k++) {
      if (strcmp(setup->out[k].name, name) != 0) continue;
      pl_symbol of = w->model->result_names.at[i].symbol;
      put(w, of, s->out[k], shift_of(s->out[k], size, 2000 + (uint64_t)i));
      pl_symbol start = pl_symbol_find(
          w->pool, pl_format(w->arena, "%s_0", pl_symbol_get(w->pool, of)->name));
      put(w, start, origin->out[k], shift_of(origin->out[k], size, 2000 + (uint64_t)i));
    }
  }
}

void pl_state_set(pl_witness* w, const pl_trace* t, const pl_trace_sample* s,
                  const pl_trace_sample* origin, double t_0) {
  for (int i = 0; i < w->n_value; i++)
    w->value[i] = w->shifted[i] = i < t->n_value ? t->value[i] : (double)NAN;
  put(w, pl_time(w->pool), s->t - t_0, shift_of(s->t - t_0, 0, 1));
  put_coordinates(w, t, s, origin);
  put_multipliers(w, t, s);
  put_results(w, t, s, origin);
  // abbreviations that were inserted where they are used, but name what is shown
  for (int i = 0; i < w->model->lets.n; i++) {
    const pl_let* l = &w->model->lets.at[i];
    if (!l->inserted || l->n_args > 0) continue;
    double x = pl_eval(w->pool, l->value, w->value);
    put(w, l->symbol, x, pl_eval(w->pool, l->value, w->shifted) - x);
  }
}

void pl_state_define(pl_witness* w, const pl_value* v) {
  for (int i = 0; v && i < v->n_where; i++) {
    pl_symbol s = pl_symbol_find(w->pool, v->where_name[i]);
    double x = pl_eval(w->pool, v->where_expr[i], w->value);
    put(w, s, x, pl_eval(w->pool, v->where_expr[i], w->shifted) - x);
  }
}

// ----------------------------------------------------------------------------------------- reading
double pl_state_value(const pl_witness* w, pl_expr e) {
  return pl_is_poison(e) ? (double)NAN : pl_eval(w->pool, e, w->value);
}

double pl_state_noise(const pl_witness* w, pl_expr e) {
  if (pl_is_poison(e)) return 0;
  double moves = fabs(pl_eval(w->pool, e, w->shifted) - pl_eval(w->pool, e, w->value));
  return times_moved * moves + rounding * pl_eval_terms(w->pool, e, w->value);
}

// What is assumed of given quantities alone is met by their numbers, or the formula is false for
// them.
static bool speaks_of_state(const pl_witness* w, pl_expr e) {
  return pl_has_role(w->pool, e, PL_R_COORD) || pl_has_role(w->pool, e, PL_R_VELOCITY)
         || pl_has_role(w->pool, e, PL_R_TIME);
}

bool pl_state_is_valid(const pl_witness* w, const pl_tower* tower) {
  if (!tower) return true;
  int n = 0;
  const pl_fact* fact = pl_tower_used(tower, &n);
  for (int i = 0; i < n; i++) {
    if (!speaks_of_state(w, fact[i].difference)) continue;
    double x = pl_eval(w->pool, fact[i].difference, w->value);
    if (x < 0 || (fact[i].strict && !(x > 0) && !isnan(x))) return false;
  }
  return true;
}
