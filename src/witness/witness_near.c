// Statements about motions near something: a limit, a threshold of stability, a position of rest.
//
// A limit or a series is compared with motions whose given quantity comes close to its target, in
// two steps: what is left has to become smaller, of a series by the power that it leaves out.
// On both sides of a threshold the motion beside the position has different stability.
// A frequency is one of the motion beside its position.
#include <math.h>
#include <string.h>

#include "witness/witness_impl.h"

static const double shrinks = 0.8;  // what is left of a limit, a hundred times closer: logarithms
static const double frequency = 1e-4;  // of the coefficients of the motion beside rest
static const double beside = 0.02;     // of a threshold

static void refuse(pl_witness* w, int section, const char* of, const pl_form* name, const char* en,
                   const char* de) {
  pl_refusal r = {.section = section, .words = {en, de}, .name = name, .of = of};
  pl_push(w->arena, w->refusals, r);
}

static const char* number(const pl_witness* w, double x, pl_language lang) {
  return pl_notation_number(w->arena, x, 6, (pl_notation){.math = PL_MATH_LINE, .lang = lang});
}

// ----------------------------------------------------------------------------- a quantity as given
static int param_index(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->params.n; i++) {
    if (m->params.at[i].symbol.id == s.id) return i;
  }
  return -1;
}

static pl_model* with_number(pl_witness* w, pl_symbol s, double x) {
  int i = param_index(w->model, s);
  if (i < 0 || !isfinite(x)) return NULL;
  pl_model* m = pl_trace_copy(w->arena, w->model);
  m->params.at[i].value = pl_trace_number(w->pool, x);
  return m;
}

// What a limit goes along: the quantity whose number changes, and its number at a distance.
typedef struct pl_approach {
  pl_symbol moved;
  double to;  // NaN: infinity
  double size;
  pl_symbol small;  // of `m1 = m2 + δm`; id 0
} pl_approach;

static bool find_approach(const pl_witness* w, const pl_ask* ask, const double* value,
                          pl_approach* out) {
  *out = (pl_approach){.moved = ask->variable};
  if (ask->kind == PL_ASK_LIMIT && ask->limit == PL_LIMIT_MUCH_GREATER) {
    out->to = (double)NAN;
    out->size = fabs(pl_eval(w->pool, ask->to, value));
  } else if (pl_kind_of(w->pool, ask->to) == PL_INFINITY) {
    out->to = (double)NAN;
    out->size = fabs(value[ask->variable.id]);
  } else {
    out->to = pl_eval(w->pool, ask->to, value);
    out->size = out->to != 0 ? fabs(out->to) : fabs(value[ask->variable.id]);
    if (!isfinite(out->to)) return false;
  }
  if (ask->kind == PL_ASK_SERIES && !pl_is_poison(ask->substitution_left)) {
    if (out->to != 0 || pl_kind_of(w->pool, ask->substitution_left) != PL_SYMBOL) return false;
    out->small = ask->variable;
    out->moved = pl_symbol_of(w->pool, ask->substitution_left);
    out->size = fabs(value[out->moved.id]);
  }
  return param_index(w->model, out->moved) >= 0 && isfinite(out->size) && out->size > 0;
}

static double number_at(const pl_witness* w, const pl_ask* ask, const pl_approach* a, double near,
                        double* value) {
  if (a->small.id == 0) return isnan(a->to) ? a->size / near : a->to + near * a->size;
  value[a->small.id] = near * a->size;
  return pl_eval(w->pool, ask->substitution_right, value);
}

// ------------------------------------------------------------------------------- limits and series
typedef struct pl_distance {  // of formula and motion
  double shown, motion, apart, noise;
} pl_distance;

// A motion with the quantity at `near` of its target, from a random start.
static const pl_trace* motion_near(pl_witness* w, const pl_ask* ask, double near) {
  double* value = pl_model_values(w->model, w->arena);
  pl_approach a;
  if (!find_approach(w, ask, value, &a)) return NULL;
  pl_model* m = with_number(w, a.moved, number_at(w, ask, &a, near, value));
  if (!m) return NULL;
  const pl_trace* init = w->starts.at[0].trace;
  pl_trace* t = pl_trace_make(
      w->job, m,
      &(pl_trace_options){
          .seed = 1, .beside = init->started ? init : NULL, .most_samples = 1, .span = 1});
  if (a.small.id && (int)a.small.id < t->n_value) t->value[a.small.id] = value[a.small.id];
  return t->started ? t : NULL;
}

static pl_distance distance(pl_witness* w, const pl_trace* t, const pl_value* v, pl_expr left) {
  pl_state_open(w);
  pl_state_set(w, t, &t->samples.at[0], &t->samples.at[0], 0);
  pl_state_define(w, v);
  pl_distance d = {.shown = pl_state_value(w, v->expr), .motion = pl_state_value(w, left)};
  d.apart = fabs(d.shown - d.motion);
  d.noise = pl_state_noise(w, v->expr) + pl_state_noise(w, left)
            + 1e-9 * (fabs(d.shown) + fabs(d.motion));
  return d;
}

// The assumptions on given quantities that the formula rests on hold there.
static bool is_meant(const pl_witness* w, const pl_section* s, const pl_trace* t) {
  int n = 0;
  const pl_fact* fact = s->tower ? pl_tower_used(s->tower, &n) : NULL;
  for (int i = 0; i < n; i++) {
    if (pl_eval(w->pool, fact[i].difference, t->value) < 0) return false;
  }
  return true;
}

static void refuse_limit(pl_witness* w, int section, const pl_value* v, const pl_distance* d) {
  const char* const words[] = {
      PL_BOTH("Formula and motion disagree about {1} near the limit: the formula gives %s, the "
              "motion %s.")};
  const char* said[2];
  for (int lang = 0; lang < 2; lang++) {
    said[lang] = pl_format(w->arena, words[lang], number(w, d->shown, (pl_language)lang),
                           number(w, d->motion, (pl_language)lang));
  }
  refuse(w, section, v->name, pl_form_name(w->arena, v->name, pl_poison()), said[PL_ENGLISH],
         said[PL_GERMAN]);
}

static bool belongs_to_a_motion(const pl_witness* w, pl_expr left) {
  pl_role role = pl_kind_of(w->pool, left) == PL_SYMBOL
                     ? pl_symbol_get(w->pool, pl_symbol_of(w->pool, left))->role
                     : PL_R_LOCAL;
  return role == PL_R_COORD || role == PL_R_VELOCITY;
}

static void try_limit(pl_witness* w, int section, const pl_value* v) {
  const pl_section* s = &w->solution->sections.at[section];
  const pl_ask* ask = s->ask;
  bool series = ask->kind == PL_ASK_SERIES, ratio = false;
  pl_expr left = ask->of_letter ? pl_statement_subject(w, v) : ask->value;
  if (pl_is_poison(left) || pl_is_poison(v->expr) || belongs_to_a_motion(w, left)) return;
  // of m1 >> m2 the leading term is told, of which a part is left
  ratio = !series && ask->limit == PL_LIMIT_MUCH_GREATER;
  double near[2] = {series ? 1e-2 : 1e-4, series ? 2e-3 : 1e-6};
  pl_distance d[2];
  for (int k = 0; k < 2; k++) {
    const pl_trace* t = motion_near(w, ask, near[k]);
    if (t && !is_meant(w, s, t)) t = motion_near(w, ask, -near[k]);
    if (!t || !is_meant(w, s, t)) return;
    d[k] = distance(w, t, v, left);
    if (!isfinite(d[k].apart) || !isfinite(d[k].noise)) return;
    double size = ratio ? fabs(d[k].shown) + fabs(d[k].motion) : 1;
    d[k].apart = size > 0 ? d[k].apart / size : 0;
    d[k].noise = size > 0 ? d[k].noise / size : 0;
  }
  w->n_searched++;
  double allowed = series ? pow(near[1] / near[0], v->order + 0.5) : shrinks;
  if (d[1].apart > 10 * d[1].noise && d[1].apart > allowed * d[0].apart)
    refuse_limit(w, section, v, &d[1]);
}

static void try_limits(pl_witness* w, int section) {
  const pl_section* s = &w->solution->sections.at[section];
  const pl_ask* ask = s->ask;
  if (s->stage > 0 || s->beside || ask->motion.given || ask->of_time || !ask->variable.id) return;
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    bool is_asked = ask->of_letter
                    || strcmp(v->name, pl_expr_text(w->arena, w->pool, ask->value)) == 0;
    if (is_asked && (ask->kind == PL_ASK_LIMIT || v->order >= 0)) try_limit(w, section, v);
  }
}

// --------------------------------------------------------------------------------- places of rest
// The coordinates of the position that a value belongs to; false: it speaks of others.
static bool read_place(pl_witness* w, const pl_rest_field* f, const pl_trace* t, const pl_value* v,
                       double* q, bool* known) {
  for (int i = 0; i < PL_MOST_AT_REST; i++) known[i] = false;
  for (int k = 0; k < v->n_place; k++) {
    const pl_component* c = &v->place[k];
    int at = -1;
    for (int i = 0; i < t->recording->flat.n; i++) {
      if (strcmp(t->recording->setup.coordinates[i].name, c->along) == 0)
        at = pl_rest_place_of(f, i);
    }
    double x = pl_eval(w->pool, c->expr, t->value);
    if (at < 0 || !isfinite(x)) return false;
    known[at] = true;
    q[at] = x;
  }
  return v->n_place > 0;
}

// The position in all coordinates; false: it is not there at these numbers.
static bool find_place(pl_witness* w, pl_rest_field* f, const pl_trace* t, const pl_value* v,
                       double* q) {
  double place[PL_MOST_AT_REST], left;
  bool known[PL_MOST_AT_REST];
  return f && pl_rest_is_possible(f) && read_place(w, f, t, v, place, known)
         && pl_search_rest_at(f, t, place, known, q, &left);
}

static void try_frequency(pl_witness* w, int section, pl_rest_field* f, const pl_trace* t,
                          const pl_value* v) {
  double q[PL_MOST_AT_REST], square = pl_eval(w->pool, v->expr, t->value);
  if (!isfinite(square) || !find_place(w, f, t, v, q)) return;
  double off = pl_rest_frequency_off(f, q, square);
  if (isnan(off)) return;
  w->n_searched++;
  if (off < frequency) return;
  refuse(
      w, section, v->name, pl_form_name(w->arena, v->name, pl_poison()),
      pl_format(w->arena, "{1} is %s by the formula: the motion beside the position is another.",
                number(w, square, PL_ENGLISH)),
      pl_format(w->arena,
                pl_german("{1} is %s by the formula: the motion beside the position is another."),
                number(w, square, PL_GERMAN)));
}

// 1 stable, -1 unstable, 0 not decided, with the quantity a little beside its threshold.
static int stability_with(pl_witness* w, pl_symbol s, double x, const pl_value* v) {
  pl_model* m = with_number(w, s, x);
  if (!m) return 0;
  pl_trace* t = pl_trace_make(w->job, m, &(pl_trace_options){.most_samples = 1, .span = 1});
  if (!t->started) return 0;
  pl_rest_field* f = pl_rest_make(w, t);
  double q[PL_MOST_AT_REST];
  return find_place(w, f, t, v, q) ? pl_rest_stability(f, q) : 0;
}

static void try_threshold(pl_witness* w, int section, const pl_value* v) {
  const pl_section* s = &w->solution->sections.at[section];
  double x = pl_eval(w->pool, v->expr, pl_model_values(w->model, w->arena));
  if (v->n_place == 0 || !isfinite(x) || x == 0) return;
  int below = stability_with(w, s->ask->variable, (1 - beside) * x, v),
      above = stability_with(w, s->ask->variable, (1 + beside) * x, v);
  if (below == 0 || above == 0) return;
  w->n_searched++;
  if (below != above) return;
  refuse(w, section, v->name, pl_form_name(w->arena, v->name, pl_poison()),
         PL_BOTH(below > 0 ? "The position is stable on both sides of the value of {1}."
                           : "The position is unstable on both sides of the value of {1}."));
}

// ----------------------------------------------------------------------------------------- service
void pl_search_near(pl_witness* w) {
  const pl_trace* t = w->starts.at[0].trace;
  for (int i = 1; i < w->starts.n && !t->started; i++) t = w->starts.at[i].trace;
  if (!t->started) return;
  pl_rest_field* f = NULL;
  for (int i = 0; i < w->solution->sections.n; i++) {
    const pl_section* s = &w->solution->sections.at[i];
    if (!s->ask) continue;
    if (s->ask->kind == PL_ASK_LIMIT || s->ask->kind == PL_ASK_SERIES) try_limits(w, i);
    bool rests = s->ask->kind == PL_ASK_EQUILIBRIA || s->ask->kind == PL_ASK_MODES
                 || s->ask->kind == PL_ASK_THRESHOLD;
    if (!rests || s->stage > 0 || s->beside || s->ask->where.n > 8) continue;
    if (!f) f = pl_rest_make(w, t);
    for (int k = 0; k < s->values.n; k++) {
      const pl_value* v = &s->values.at[k];
      if (s->ask->kind == PL_ASK_THRESHOLD) try_threshold(w, i, v);
      else if (v->n_place > 0 && strcmp(v->name, "omega^2") == 0) try_frequency(w, i, f, t, v);
    }
  }
}
