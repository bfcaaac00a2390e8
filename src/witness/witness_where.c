// `x' where λ = 0 from x = 0 at rest`: the motion is followed to the first place where the
// condition holds, and what is asked is read there.
#include <math.h>
#include <string.h>

#include "witness/witness_impl.h"

enum { SAMPLES = 400 };

static bool is_asked_of_motion(const pl_section* s) {
  const pl_ask* ask = s->ask;
  return ask && ask->kind == PL_ASK_VALUE && ask->where.n == 1 && ask->where.at[0].relation == PL_EQ
         && s->stage == 0 && !s->not_found;
}

static bool is_of(const pl_witness* w, const pl_value* v, pl_expr asked) {
  return strcmp(v->name, pl_expr_text(w->arena, w->pool, asked)) == 0
         && (!pl_is_poison(v->expr) || isfinite(v->number));
}

// A condition on given quantities is inserted, and met nowhere; one on coordinates and the like is
// met by a motion.
static bool speaks_of_motion(const pl_witness* w, pl_expr e) {
  static const pl_role moving[] = {PL_R_COORD, PL_R_VELOCITY, PL_R_ACCELERATION, PL_R_MULTIPLIER};
  for (size_t i = 0; i < sizeof moving / sizeof *moving; i++) {
    if (pl_has_role(w->pool, e, moving[i])) return true;
  }
  return false;
}

static const char* number(const pl_witness* w, double x, pl_language lang) {
  return pl_notation_number(w->arena, x, 6, (pl_notation){.math = PL_MATH_LINE, .lang = lang});
}

static void refuse(pl_witness* w, int section, const pl_value* v, pl_expr asked, double t,
                   double shown, double motion) {
  pl_refusal r = {.section = section, .of = v->name, .name = pl_form_of(w->arena, w->pool, asked)};
  r.words[PL_ENGLISH] = pl_format(
      w->arena,
      "The motion meets the condition first at t = %s s; {1} is %s there, and %s by the formula.",
      number(w, t, PL_ENGLISH), number(w, motion, PL_ENGLISH), number(w, shown, PL_ENGLISH));
  r.words[PL_GERMAN] = pl_format(w->arena,
                                 pl_german("The motion meets the condition first at t = %s s; {1} "
                                           "is %s there, and %s by the formula."),
                                 number(w, t, PL_GERMAN), number(w, motion, PL_GERMAN),
                                 number(w, shown, PL_GERMAN));
  pl_push(w->arena, w->refusals, r);
}

// One of the values, if there are several for several cases, is that of the motion.
static void compare(pl_witness* w, int section, const pl_trace* t, const pl_trace_sample* at,
                    bool pushed) {
  const pl_section* s = &w->solution->sections.at[section];
  const pl_trace_sample* start = &t->samples.at[0];
  double most = 0;  // what vanishes there is small beside its values on the way
  for (int k = 0; k < t->samples.n; k++) {
    pl_state_set(w, t, &t->samples.at[k], start, 0);
    double x = pl_state_value(w, s->ask->value);
    if (isfinite(x)) most = fmax(most, fabs(x));
  }
  pl_state_set(w, t, at, start, 0);
  double motion = pl_state_value(w, s->ask->value),
         noise = pl_state_noise(w, s->ask->value) + 1e-10 * most;
  const pl_value* wrong = NULL;
  double shown = 0;
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    if (!is_of(w, v, s->ask->value)) continue;
    pl_state_define(w, v);
    bool in_numbers = pl_is_poison(v->expr);
    double x = in_numbers ? v->number : pl_state_value(w, v->expr);
    double allowed = noise + (in_numbers ? 1e-8 * fabs(x) : pl_state_noise(w, v->expr))
                     + (pushed ? 1e-4 : 1e-7) * (fabs(x) + fabs(motion));
    if (isnan(x) || isnan(motion) || fabs(x - motion) <= allowed) return;
    if (pushed && fabs(x + motion) <= allowed) return;  // it may be pushed to the other side
    wrong = v;
    shown = x;
  }
  if (wrong) refuse(w, section, wrong, s->ask->value, at->t, shown, motion);
}

static bool rests(const pl_witness* w, const pl_trace* t) {
  for (int k = 0; k < t->samples.n; k++) {
    for (int i = 0; i < t->recording->flat.n; i++) {
      if (fabs(t->samples.at[k].v[i]) > PL_SMALL_PUSH * w->v_size) return false;
    }
  }
  return true;
}

// λ = 0 is where a contact ends: the condition is met with the last sample of the first stretch.
// NULL: it is not.
static const pl_trace_sample* ends_there(pl_witness* w, const pl_trace* t, pl_expr meet) {
  if (t->phases.n < 2 || t->phases.at[0].n < 2) return NULL;
  double most = 0, left = 0;
  for (int k = 0; k < t->phases.at[0].n; k++) {
    pl_state_set(w, t, &t->samples.at[k], &t->samples.at[0], 0);
    left = fabs(pl_state_value(w, meet));
    most = fmax(most, left);
  }
  return left <= 1e-8 * most ? &t->samples.at[t->phases.at[0].n - 1] : NULL;
}

static void follow(pl_witness* w, int section, double push) {
  const pl_ask* ask = w->solution->sections.at[section].ask;
  pl_expr meet = pl_sub(w->pool, ask->where.at[0].left, ask->where.at[0].right);
  pl_trace_options how = {.meet = meet, .push = push, .most_samples = SAMPLES};
  if (ask->motion.given) how.from = &ask->motion;
  // the way out of rest is long
  if (push != 0) how.span = 20 * sqrt(fmax(w->q_size, 1e-12) / w->a_size);
  const pl_trace* t = pl_trace_make(w->job, w->model, &how);
  if (!t->started || t->moved > 1e-8) return;
  if (t->marks.n == 0 && push == 0 && ask->motion.given && ask->motion.at_rest && rests(w, t)) {
    follow(w, section, PL_SMALL_PUSH * sqrt(w->a_size * fmax(w->q_size, 1e-12)));
    return;
  }
  pl_state_open(w);
  const pl_trace_sample *at = t->marks.n > 0 ? &t->marks.at[0] : ends_there(w, t, meet),
                        *start = &t->samples.at[0];
  if (!at) return;
  pl_state_set(w, t, start, start, 0);
  bool at_start = fabs(pl_state_value(w, meet)) <= pl_state_noise(w, meet);
  // behind a contact the motion is another one
  if (at->phase != 0 || at->t == start->t || at_start) return;
  w->n_searched++;
  compare(w, section, t, at, push != 0);
}

void pl_meet(pl_witness* w) {
  for (int i = 0; i < w->solution->sections.n; i++) {
    const pl_section* s = &w->solution->sections.at[i];
    if (!is_asked_of_motion(s)) continue;
    pl_expr meet = pl_sub(w->pool, s->ask->where.at[0].left, s->ask->where.at[0].right);
    bool any = false;
    for (int k = 0; k < s->values.n; k++) any |= is_of(w, &s->values.at[k], s->ask->value);
    if (any && speaks_of_motion(w, meet)) follow(w, i, 0);
  }
}
