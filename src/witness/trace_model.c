// The models that traces run: numbers for parameters without any, and starts beside the one that is
// given.
//
// A model is copied as far as it changes; expressions stay in its pool.
#include "witness/trace_impl.h"

#include <math.h>

// ------------------------------------------------------------------------------------------ copies
#define COPY_OF(a, vec)                                     \
  do {                                                      \
    size_t bytes_ = (size_t)(vec).n * sizeof *(vec).at;     \
    void* copy_ = pl_alloc((a), bytes_ + sizeof *(vec).at); \
    if (bytes_) memcpy(copy_, (vec).at, bytes_);            \
    (vec).at = copy_;                                       \
    (vec).cap = (vec).n + 1;                                \
  } while (0)

pl_model* pl_trace_copy(pl_arena* a, const pl_model* m) {
  pl_model* out = PL_NEW(a, pl_model);
  *out = *m;
  COPY_OF(a, out->params);
  COPY_OF(a, out->constraints);
  COPY_OF(a, out->inits);
  COPY_OF(a, out->events);
  COPY_OF(a, out->outputs);
  COPY_OF(a, out->result_names);
  return out;
}

pl_expr pl_trace_number(pl_pool* p, double x) {
  char text[32];
  pl_double_text(text, x);
  bool negative = text[0] == '-';
  pl_expr e = pl_number_from_text(p, text + negative, strlen(text + negative));
  return negative ? pl_neg(p, e) : e;
}

// ----------------------------------------------------------------------------------------- numbers
// Whether an assumption is met; what cannot be evaluated (it speaks of coordinates) does not count.
static bool is_met(const pl_model* m, const pl_assumption* a, const double* value) {
  if (a->kind == PL_A_INTEGER) return true;
  if (a->kind == PL_A_IN) {
    double x = pl_eval(m->pool, a->subject, value);
    return !(x < pl_eval(m->pool, a->lo, value)) && !(x > pl_eval(m->pool, a->hi, value));
  }
  double x = pl_eval(m->pool, pl_sub(m->pool, a->condition.left, a->condition.right), value);
  if (isnan(x)) return true;
  switch (a->condition.relation) {
    case PL_GT: return x > 0;
    case PL_GE: return x >= 0;
    case PL_LT: return x < 0;
    case PL_LE: return x <= 0;
    case PL_NE: return x != 0;
    case PL_EQ: return fabs(x) < 1e-9;
  }
  return true;
}

static bool all_met(const pl_model* m, const double* value) {
  for (int i = 0; i < m->assumptions.n; i++) {
    if (!is_met(m, &m->assumptions.at[i], value)) return false;
  }
  return true;
}

static bool is_integer(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->assumptions.n; i++) {
    const pl_assumption* a = &m->assumptions.at[i];
    if (a->kind == PL_A_INTEGER && pl_has_symbol(m->pool, a->subject, s)) return true;
  }
  return false;
}

// `in lo..hi` of one parameter gives its range.
static void range_of(const pl_model* m, pl_symbol s, const double* value, double* lo, double* hi) {
  for (int i = 0; i < m->assumptions.n; i++) {
    const pl_assumption* a = &m->assumptions.at[i];
    if (a->kind != PL_A_IN || !pl_same(a->subject, pl_sym(m->pool, s))) continue;
    double from = pl_eval(m->pool, a->lo, value), to = pl_eval(m->pool, a->hi, value);
    if (isfinite(from) && isfinite(to) && from < to) {
      *lo = from;
      *hi = to;
    }
  }
}

// Numbers of a short decimal, so that they are exact and can be told.
static double draw(pl_random* r, double lo, double hi) {
  double x = pl_random_between(r, lo, hi), unit = pow(10, floor(log10(hi - lo)) - 3);
  return nearbyint(x / unit) * unit;
}

// Try number k: from a narrow range first, so that formulas are well conditioned, then from wider
// ones.
static void give_numbers(pl_model* m, const pl_model* plain, const double* value, pl_random* r,
                         int k) {
  double wide = k < 200 ? 2 : k < 600 ? 10 : 100;
  for (int i = 0; i < m->params.n; i++) {
    if (!pl_is_poison(plain->params.at[i].value)) continue;
    pl_symbol s = m->params.at[i].symbol;
    double lo = 1 / wide, hi = wide;
    range_of(m, s, value, &lo, &hi);
    double x = is_integer(m, s) ? 2 + (double)(pl_random_bits(r) % 3) : draw(r, lo, hi);
    pl_sign_known sign = pl_symbol_get(m->pool, s)->sign;
    if (sign == PL_SIGN_NEGATIVE || sign == PL_SIGN_NONPOSITIVE) x = -fabs(x);
    m->params.at[i].value = pl_trace_number(m->pool, x);
  }
}

pl_model* pl_trace_model(pl_job* job, pl_model* m, uint64_t seed) {
  enum { MOST_TRIES = 1000 };
  bool missing = false;
  for (int i = 0; i < m->params.n; i++) missing |= pl_is_poison(m->params.at[i].value);
  if (!missing) return m;
  const double* value = pl_model_values(m, job->arena);
  pl_model* out = pl_trace_copy(job->arena, m);
  pl_random r = {seed};
  for (int k = 0; k < MOST_TRIES; k++) {
    give_numbers(out, m, value, &r, k);
    if (all_met(out, pl_model_values(out, job->arena))) return out;
  }
  return NULL;
}

// ------------------------------------------------------------------------------------------ starts
static void guess(pl_job* job, pl_model* m, pl_expr atom, bool velocity, double x) {
  pl_pool* p = m->pool;
  pl_expr target = atom;
  if (velocity && pl_kind_of(p, atom) == PL_AT)
    target = pl_at(p, pl_symbol_of(p, atom), 1, pl_arg(p, atom, 0));
  else if (velocity) target = pl_sym(p, pl_symbol_dot(p, pl_symbol_of(p, atom)));
  pl_init init = {.target = target, .value = pl_trace_number(p, x), .guess = true};
  pl_push(job->arena, m->inits, init);
}

static double size_of(const double* x, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most > 0 ? most : 1;
}

// What touches at the start of `beside` holds for good, what does not is away: which of several
// contacts holds is no matter of a random start. What goes with a contact goes with it still.
static void settle_contacts(pl_model* m, const pl_trace* beside) {
  for (int i = 0; i < m->constraints.n; i++) {
    pl_constraint* c = &m->constraints.at[i];
    if (c->block || (c->relation == PL_EQ && !c->while_label)) continue;
    bool holds = !beside || pl_trace_holds(beside, &beside->phases.at[0], i);
    c->relation = PL_EQ;
    c->while_label = NULL;
    c->off |= !holds;
  }
}

pl_model* pl_trace_closed(pl_job* job, pl_model* m) {
  if (m->inits.n > 0) return m;
  pl_model* out = pl_trace_copy(job->arena, m);
  settle_contacts(out, NULL);
  return out;
}

// A state that is drawn: positions and velocities of all coordinates.
typedef struct pl_drawn_state {
  pl_flat_coords flat;
  double *q, *v;
} pl_drawn_state;

static pl_drawn_state draw_state(pl_job* job, const pl_model* m, const pl_trace* beside,
                                 uint64_t seed) {
  pl_drawn_state s = {.flat = pl_model_flat_coords(m, job->arena)};
  int n = s.flat.n;
  s.q = PL_ARRAY(job->arena, double, n + 1);
  s.v = PL_ARRAY(job->arena, double, n + 1);
  pl_random r = {seed};
  const pl_trace_sample* at = beside && beside->started ? &beside->samples.at[0] : NULL;
  double q_size = at ? size_of(at->q, n) : 1, v_size = at ? size_of(at->v, n) : 1;
  for (int i = 0; i < n; i++) {
    double shift = pl_random_between(&r, -0.3, 0.3), push = pl_random_between(&r, -1, 1);
    s.q[i] = at ? at->q[i] + shift * fmin(q_size, fmax(fabs(at->q[i]), 1))
                : pl_random_between(&r, 0.3, 1.5);
    s.v[i] = at ? at->v[i] + push * v_size : push;
  }
  return s;
}

// The table of numbers with a state in it.
static void put_state(const pl_model* m, const pl_drawn_state* s, double* value) {
  for (int i = 0; i < s->flat.n; i++) {
    if (pl_kind_of(m->pool, s->flat.at[i]) != PL_SYMBOL) continue;
    pl_symbol x = pl_symbol_of(m->pool, s->flat.at[i]);
    value[x.id] = s->q[i];
    value[pl_symbol_dot(m->pool, x).id] = s->v[i];
  }
}

// The coordinates that `choose` maps follow from the others: there the equations of the map and the
// constraints that it solves hold already, of which some depend on others.
static void follow_maps(pl_job* job, pl_model* m, pl_drawn_state* s) {
  // makes the symbols
  for (int k = 0; k < m->choose.n_maps; k++) pl_dt(m->pool, m->choose.maps[k].map);
  for (int i = 0; i < s->flat.n; i++) pl_dt(m->pool, s->flat.at[i]);
  double* value = pl_model_values(m, job->arena);
  value[pl_time(m->pool).id] = 0;
  for (int pass = 0; pass < m->choose.n_maps; pass++) {
    put_state(m, s, value);
    for (int k = 0; k < m->choose.n_maps; k++) {
      double x = pl_eval(m->pool, m->choose.maps[k].map, value),
             v = pl_eval(m->pool, pl_dt(m->pool, m->choose.maps[k].map), value);
      for (int i = 0; i < s->flat.n; i++) {
        if (!pl_same(s->flat.at[i], m->choose.maps[k].old) || isnan(x) || isnan(v)) continue;
        s->q[i] = x;
        s->v[i] = v;
      }
    }
  }
}

pl_model* pl_trace_random_start(pl_job* job, pl_model* m, const pl_trace* beside, uint64_t seed) {
  pl_model* out = pl_trace_copy(job->arena, m);
  out->inits.n = 0;
  out->events.n = 0;
  if (beside && beside->started) settle_contacts(out, beside);
  pl_drawn_state s = draw_state(job, m, beside, seed);
  follow_maps(job, m, &s);
  for (int i = 0; i < s.flat.n; i++) {
    guess(job, out, s.flat.at[i], false, s.q[i]);
    guess(job, out, s.flat.at[i], true, s.v[i]);
  }
  return out;
}

// Whether `init` speaks of a coordinate or of its velocity; of families it is taken to.
static bool is_given(const pl_model* m, pl_expr atom, bool velocity) {
  pl_pool* p = m->pool;
  for (int i = 0; i < m->inits.n; i++) {
    pl_expr target = m->inits.at[i].target;
    pl_kind kind = pl_kind_of(p, target);
    if (kind != pl_kind_of(p, atom)) continue;
    if (kind == PL_AT) {
      if (pl_symbol_of(p, target).id == pl_symbol_of(p, atom).id
          && (pl_dots_of(p, target) > 0) == velocity)
        return true;
      continue;
    }
    pl_symbol s = pl_symbol_of(p, atom);
    if (velocity) s = pl_symbol_dot(p, s);
    if (pl_symbol_of(p, target).id == s.id) return true;
  }
  return false;
}

// Coordinates of which nothing is known start somewhere: zero is a singular place of many
// coordinates.
pl_model* pl_trace_open_start(pl_job* job, pl_model* m) {
  pl_model* out = pl_trace_copy(job->arena, m);
  pl_drawn_state s = draw_state(job, m, NULL, 0x73746172);
  follow_maps(job, m, &s);
  for (int i = 0; i < s.flat.n; i++) {
    if (!is_given(m, s.flat.at[i], false)) guess(job, out, s.flat.at[i], false, s.q[i]);
    if (!is_given(m, s.flat.at[i], true)) guess(job, out, s.flat.at[i], true, s.v[i]);
  }
  return out;
}

pl_model* pl_trace_marked(pl_job* job, const pl_model* m, pl_expr meet) {
  pl_model* out = pl_trace_copy(job->arena, m);
  pl_event mark = {.name = {.text = PL_TRACE_MARK, .ascii = PL_TRACE_MARK}, .value = meet};
  pl_push(job->arena, out->events, mark);
  return out;
}

// The start that `from` names: its conditions with a coordinate or velocity on the left, at rest or
// not; the rest as `init` says.
pl_model* pl_trace_named_start(pl_job* job, pl_model* m, const pl_motion* from, double push) {
  pl_model* out = pl_trace_copy(job->arena, m);
  out->inits.n = 0;
  pl_flat_coords flat = pl_model_flat_coords(m, job->arena);
  for (int i = 0; i < from->n_from; i++) {
    pl_init init = {.target = from->from[i].left, .value = from->from[i].right};
    pl_push(job->arena, out->inits, init);
  }
  int named = out->inits.n;
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* old = &m->inits.at[i];
    bool velocity = pl_has_role(m->pool, old->target, PL_R_VELOCITY);
    bool again = from->at_rest && velocity;
    for (int k = 0; k < named; k++) again |= pl_same(out->inits.at[k].target, old->target);
    if (!again) pl_push(job->arena, out->inits, *old);
  }
  for (int i = 0; from->at_rest && i < flat.n; i++) guess(job, out, flat.at[i], true, push);
  return out;
}
