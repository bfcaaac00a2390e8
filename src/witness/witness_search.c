// Statements that no single motion tells: degrees of freedom, "none", "these are all", "stable".
// They are tried at the starts, and by Newton from many places.
#include <math.h>
#include <string.h>

#include "witness/witness_impl.h"

enum { TRIES = 12 };
// of a coordinate: Newton ends as far from a position where forces vanish with their slopes
static const double same_place = 1e-2;

static void refuse(pl_witness* w, int section, const char* of, const pl_form* name, const char* en,
                   const char* de) {
  pl_refusal r = {.section = section, .words = {en, de}, .name = name, .of = of};
  pl_push(w->arena, w->refusals, r);
}

static const char* number(const pl_witness* w, double x, pl_language lang) {
  return pl_notation_number(w->arena, x, 6, (pl_notation){.math = PL_MATH_LINE, .lang = lang});
}

// Where is searched: the equations of a model, with what holds at its start.
typedef struct pl_ground {
  const pl_model* model;  // contacts as they are written
  const pl_trace* t;
  pl_rest_field* f;
} pl_ground;

// ------------------------------------------------------------------------------ degrees of freedom
// The freedoms that the rows leave at the start of a motion; -1 when that has no number.
static int freedoms(pl_rest_field* f, const pl_trace* t, bool with_velocities) {
  int n = pl_rest_coordinates(f);
  double q[PL_MOST_AT_REST];
  for (int i = 0; i < t->recording->flat.n; i++) {
    int at = pl_rest_place_of(f, i);
    if (at >= 0) q[at] = t->samples.at[0].q[i];
  }
  int rank = pl_rest_rank(f, q, with_velocities);
  return rank < 0 ? -1 : n - pl_rest_idle(f) - rank;
}

// Constraints on velocities may be integrable, and are then counted as constraints of positions. At
// one start at least it is as said: at others the rank may be smaller.
static bool count_is(pl_witness* w, pl_rest_field* f, const pl_dof* said, int hidden, int* found) {
  bool any = false;
  for (int i = 0; i < w->starts.n; i++) {
    const pl_trace* t = w->starts.at[i].trace;
    if (!t->started || w->starts.at[i].kind == PL_FROM_NAMED) continue;
    int positions = freedoms(f, t, false), velocities = freedoms(f, t, true);
    if (positions < 0 || velocities < 0) continue;
    bool between = said->dof + hidden <= positions && said->dof + hidden >= velocities;
    if (between && said->velocity_dof + hidden == velocities) return true;
    *found = velocities - hidden;
    any = true;
  }
  return !any;
}

static void search_freedoms(pl_witness* w, int section, pl_rest_field* f) {
  int found = 0;
  if (w->model->frictions.n > 0) return;  // surfaces that stick are counted too
  w->n_searched++;
  if (count_is(w, f, &w->solution->dof, w->solution->hidden.n, &found)) return;
  refuse(
      w, section, "dof", pl_form_leaf(w->arena, pl_int(w->pool, found)),
      PL_BOTH(
          "The rank of the constraints at the start, and beside it, leaves {1} degrees of freedom, "
          "not what was counted."));
}

// ----------------------------------------------------------------------- positions that are listed
typedef struct pl_listed {
  const pl_value* value;
  bool exists;  // at these numbers
  bool known[PL_MOST_AT_REST];
  double q[PL_MOST_AT_REST];
} pl_listed;

static int coordinate_named(const pl_rest_field* f, const pl_trace* t, const char* name) {
  for (int i = 0; i < t->recording->flat.n; i++) {
    if (strcmp(t->recording->setup.coordinates[i].name, name) == 0) return pl_rest_place_of(f, i);
  }
  return -1;
}

// false: it speaks of a coordinate that the motion does not know, or of other coordinates.
static bool read_listed(pl_witness* w, const pl_rest_field* f, const pl_trace* t, const pl_value* v,
                        pl_listed* out) {
  *out = (pl_listed){.value = v, .exists = true};
  for (int k = 0; k < v->n_components; k++) {
    const pl_component* c = &v->components[k];
    int at = coordinate_named(f, t, pl_ascii_of(w->arena, c->along));
    if (at < 0 || pl_has_role(w->pool, c->expr, PL_R_COORD) || v->n_where > 0) return false;
    double x = pl_is_poison(c->expr) ? c->number : pl_eval(w->pool, c->expr, t->value);
    if (isnan(x)) out->exists = false;
    out->known[at] = true;
    out->q[at] = x;
  }
  return true;
}

static bool is_angle(const pl_rest_field* f, const pl_trace* t, int at) {
  for (int i = 0; i < t->recording->flat.n; i++) {
    const char* unit = t->recording->setup.coordinates[i].unit;
    if (pl_rest_place_of(f, i) == at) return !unit || !*unit || strcmp(unit, "rad") == 0;
  }
  return false;
}

static bool is_at(const pl_rest_field* f, const pl_trace* t, const pl_listed* l, const double* q) {
  for (int i = 0; i < pl_rest_coordinates(f); i++) {
    if (!l->known[i]) continue;
    double apart = q[i] - l->q[i];
    if (is_angle(f, t, i) && fabs(apart) > same_place) apart = remainder(apart, 2 * M_PI);
    if (fabs(apart) > same_place * (1 + fabs(q[i]))) return false;
  }
  return true;
}

// --------------------------------------------------------------------------------- places to begin
static void begin_at(pl_rest_field* f, const pl_trace* t, pl_random* r, int k, double* q) {
  for (int i = 0; i < t->recording->flat.n; i++) {
    int at = pl_rest_place_of(f, i);
    if (at < 0) continue;
    double start = t->samples.at[0].q[i], range = 2 * fmax(1, fabs(start));
    q[at] = k == 0                        ? start
            : is_angle(f, t, at) && k % 2 ? pl_random_between(r, -M_PI, M_PI)
                                          : start + pl_random_between(r, -range, range);
  }
}

// Contacts push, branches hold, and so does what was assumed of coordinates.
static bool is_allowed(pl_witness* w, const pl_ground* on, int section, const double* q) {
  pl_rest_field* f = on->f;
  const pl_trace* t = on->t;
  double lambda[PL_MOST_ROWS];
  if (!(pl_rest_left(f, q, lambda) < 1e-6)) return false;
  for (int i = 0; i < on->model->constraints.n; i++) {
    pl_relation relation = on->model->constraints.at[i].relation;
    int side = relation == PL_GE || relation == PL_GT   ? 1
               : relation == PL_LE || relation == PL_LT ? -1
                                                        : 0;
    for (int k = 0; k < pl_rest_rows(f); k++) {
      if (pl_rest_constraint(f, k) == pl_trace_constraint(t, i, 0) && side * lambda[k] < 0)
        return false;
    }
  }
  for (int i = 0; i < t->recording->flat.n; i++) {
    int at = pl_rest_place_of(f, i);
    if (at >= 0) w->value[pl_symbol_of(w->pool, t->recording->flat.at[i]).id] = q[at];
  }
  for (int i = 0; i < on->model->branches.n; i++) {
    const pl_condition* c = &on->model->branches.at[i];
    double x = pl_eval(w->pool, pl_sub(w->pool, c->left, c->right), w->value);
    bool above = c->relation == PL_GT || c->relation == PL_GE,
         below = c->relation == PL_LT || c->relation == PL_LE;
    if ((above && x < 0) || (below && x > 0)) return false;
  }
  for (int i = 0; i < on->model->constraints.n; i++) {  // contacts that are open stay so
    const pl_constraint* c = &on->model->constraints.at[i];
    double g = pl_eval(w->pool, c->g, w->value);
    if ((c->relation == PL_GE && g < -1e-9) || (c->relation == PL_LE && g > 1e-9)) return false;
  }
  const pl_section* s = &w->solution->sections.at[section];
  return s->all_sides || pl_state_is_valid(w, s->tower);
}

// ---------------------------------------------------------------------------- what is listed rests
// The other coordinates follow from the constraints, in one way of several: in one of them it
// rests.
bool pl_search_rest_at(pl_rest_field* f, const pl_trace* t, const double* place, const bool* known,
                       double* q, double* left) {
  pl_random r = {0x72657374};
  double lambda[PL_MOST_ROWS];
  bool placed = false;
  *left = (double)NAN;
  for (int k = 0; k < TRIES / 2; k++) {
    begin_at(f, t, &r, k, q);
    for (int i = 0; i < pl_rest_coordinates(f); i++) q[i] = known[i] ? place[i] : q[i];
    if (!pl_rest_place(f, q, known)) continue;
    double here = pl_rest_left(f, q, lambda);
    if (here < 1e-6) return true;
    *left = here;
    placed |= isfinite(here);
  }
  if (!placed) *left = (double)NAN;
  return false;
}

static void try_listed(pl_witness* w, int section, pl_rest_field* f, const pl_trace* t,
                       const pl_listed* l) {
  double q[PL_MOST_AT_REST], left;
  if (!l->exists || l->value->n_components == 0) return;
  bool found_rest = pl_search_rest_at(f, t, l->q, l->known, q, &left);
  if (!found_rest && isnan(left)) return;  // no way to put it there
  if (!found_rest) {
    refuse(
        w, section, l->value->name, pl_form_name(w->arena, l->value->name, pl_poison()),
        pl_format(w->arena,
                  "{1} is no position of rest of the equations as they stand: %s of the forces "
                  "is left there.",
                  number(w, left, PL_ENGLISH)),
        pl_format(
            w->arena,
            pl_german("{1} is no position of rest of the equations as they stand: %s of the forces "
                      "is left there."),
            number(w, left, PL_GERMAN)));
    return;
  }
  const char* said = l->value->stability;
  if (!said || l->value->n_free > 0) return;
  int found = pl_rest_stability(f, q);
  bool wrong = (found > 0 && strcmp(said, "unstable") == 0)
               || (found < 0 && strcmp(said, "stable") == 0);
  if (!wrong) return;
  refuse(w, section, l->value->name, pl_form_name(w->arena, l->value->name, pl_poison()),
         PL_BOTH(found > 0 ? "{1} is stable: so the motion beside it says, by its eigenvalues."
                           : "{1} is unstable: so the motion beside it says, by its eigenvalues."));
}

// ------------------------------------------------------------------------------ nothing is missing
static void try_complete(pl_witness* w, int section, const pl_ground* on, const pl_listed* l,
                         int n) {
  pl_rest_field* f = on->f;
  const pl_trace* t = on->t;
  pl_random r = {0x616c6c};
  for (int k = 0; k < TRIES; k++) {
    double q[PL_MOST_AT_REST], lambda[PL_MOST_ROWS] = {0};
    begin_at(f, t, &r, k, q);
    if (!pl_rest_find(f, q, lambda, NULL) || !is_allowed(w, on, section, q)
        || pl_rest_is_kink(f, q))
      continue;
    bool known = false;
    for (int i = 0; i < n; i++) known |= is_at(f, t, &l[i], q);
    if (known) continue;
    pl_text where = pl_text_make(w->arena);
    for (int i = 0; i < t->recording->flat.n; i++) {
      int at = pl_rest_place_of(f, i);
      if (at >= 0)
        pl_text_addf(&where, "%s%s = %s", where.n ? ", " : "",
                     t->recording->setup.coordinates[i].name, number(w, q[at], PL_ENGLISH));
    }
    refuse(
        w, section, "equilibria", pl_form_name(w->arena, pl_text_string(&where), pl_poison()),
        PL_BOTH("The list of positions of rest is not complete: the equations as they stand have "
                "another one at {1}."));
    return;
  }
}

static void search_rests(pl_witness* w, int section, const pl_ground* on) {
  const pl_section* s = &w->solution->sections.at[section];
  if (!on->f || !pl_rest_is_possible(on->f) || s->ask->where.n > 0 || s->stage > 0 || s->beside)
    return;
  pl_listed* l = PL_ARRAY(w->arena, pl_listed, s->values.n + 1);
  int n = 0;
  for (int i = 0; i < s->values.n; i++) {
    if (strncmp(s->values.at[i].name, "equilibrium", 11) != 0) continue;
    if (!read_listed(w, on->f, on->t, &s->values.at[i], &l[n])) return;
    n++;
  }
  w->n_searched++;
  for (int i = 0; i < n; i++) try_listed(w, section, on->f, on->t, &l[i]);
  if (s->complete) try_complete(w, section, on, l, n);
}

// A section may be about other contacts than those of the start.
static bool is_of_start(const pl_witness* w, const pl_section* s, const pl_trace* t) {
  int holds = 0;
  for (int i = 0; i < w->model->constraints.n; i++) holds += pl_trace_holds(t, &t->phases.at[0], i);
  return !s->model || s->model->constraints.n == holds;
}

// Coordinates that were proposed are those of another model, in which they are chosen.
static pl_ground ground_of(pl_witness* w, const pl_section* s, const pl_ground* plain) {
  if (!s->model || s->model->choose.n_maps == w->model->choose.n_maps) return *plain;
  pl_model* numbered = pl_trace_model(w->job, (pl_model*)(uintptr_t)s->model, PL_SEED_OF_NUMBERS);
  if (!numbered) return *plain;
  pl_ground out = {
      .model = numbered,
      .t = pl_trace_make(w->job, numbered, &(pl_trace_options){.most_samples = 1, .span = 1})};
  if (out.t->started) out.f = pl_rest_make(w, out.t);
  return out;
}

void pl_search(pl_witness* w) {
  pl_ground plain = {.model = w->model, .t = w->starts.at[0].trace};
  for (int i = 1; i < w->starts.n && !plain.t->started; i++) plain.t = w->starts.at[i].trace;
  if (!plain.t->started) return;
  plain.f = pl_rest_make(w, plain.t);
  for (int i = 0; plain.f && i < w->solution->sections.n; i++) {
    const pl_section* s = &w->solution->sections.at[i];
    if (!s->ask) continue;
    if (s->ask->kind == PL_ASK_DOF && s->stage == 0) search_freedoms(w, i, plain.f);
    if (s->ask->kind != PL_ASK_EQUILIBRIA || !is_of_start(w, s, plain.t)) continue;
    pl_ground on = ground_of(w, s, &plain);
    search_rests(w, i, &on);
  }
}
