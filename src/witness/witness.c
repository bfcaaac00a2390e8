// The comparison of statements with motions, and what becomes of those that disagree.
// See theory (19.4).
#include "witness/witness_impl.h"

#include <math.h>
#include <string.h>

enum {
  // coordinates and constraints up to which a motion is made for comparing
  LARGEST = 60,
  RANDOM_STARTS = 2,
  SAMPLES_OF_RANDOM = 8,
  SAMPLES_OF_INIT = 60
};
// of the size of a motion: what its closed form may be off by at its end
static const double closed_form = 1e-6;

// ------------------------------------------------------------------------------------------ starts
// Names of results get columns, so that T, E or norm(force(rope)) are those of the simulation.
static pl_model* watched_model(pl_witness* w, const pl_model* numbered) {
  pl_model* m = pl_trace_copy(w->arena, numbered);
  for (int i = 0; i < m->result_names.n; i++) {
    pl_output o = {.name = pl_format(w->arena, "witness_%d", i),
                   .value = pl_sym(w->pool, m->result_names.at[i].symbol),
                   .optional = true};
    pl_push(w->arena, m->outputs, o);
  }
  return m;
}

static const pl_witnessed* add_start(pl_witness* w, pl_start_kind kind,
                                     const pl_trace_options* how) {
  pl_witnessed s = {.kind = kind,
                    .from = how->from,
                    .pushed = how->push != 0,
                    .trace = pl_trace_make(w->job, w->model, how)};
  pl_push(w->arena, w->starts, s);
  return &w->starts.at[w->starts.n - 1];
}

static bool same_motion(const pl_motion* a, const pl_motion* b) {
  if (a->n_from != b->n_from || a->at_rest != b->at_rest) return false;
  for (int i = 0; i < a->n_from; i++) {
    if (!pl_same(a->from[i].left, b->from[i].left) || !pl_same(a->from[i].right, b->from[i].right))
      return false;
  }
  return true;
}

static double fastest(const pl_trace* t) {
  double most = 0;
  for (int k = 0; k < t->samples.n; k++) {
    for (int i = 0; i < t->recording->flat.n; i++) most = fmax(most, fabs(t->samples.at[k].v[i]));
  }
  return most;
}

// A start at rest where nothing moves: what is said from there is the limit of starts close to it.
static void push_it(pl_witness* w, const pl_motion* from) {
  pl_state_sizes(w);
  double natural = sqrt(fmax(w->a_size, 1e-12) * fmax(w->q_size, 1e-12));
  for (int side = -1; side <= 1; side += 2) {
    pl_trace_options how = {
        .from = from, .push = side * PL_SMALL_PUSH * natural, .most_samples = SAMPLES_OF_INIT};
    add_start(w, PL_FROM_NAMED, &how);
  }
}

static void add_named_start(pl_witness* w, const pl_motion* from) {
  const pl_trace* t = add_start(w, PL_FROM_NAMED,
                                &(pl_trace_options){.from = from, .most_samples = SAMPLES_OF_INIT})
                          ->trace;
  if (t->started && from->at_rest && fastest(t) < PL_SMALL_PUSH * w->v_size) push_it(w, from);
}

static void add_named_starts(pl_witness* w) {
  for (int i = 0; i < w->statements.n; i++) {
    const pl_motion* from = w->statements.at[i].from;
    bool known = !from;
    for (int k = 0; k < w->starts.n && !known; k++)
      known = w->starts.at[k].from && same_motion(w->starts.at[k].from, from);
    if (!known) add_named_start(w, from);
  }
}

static void make_starts(pl_witness* w) {
  const pl_trace* init =
      add_start(w, PL_FROM_INIT, &(pl_trace_options){.most_samples = SAMPLES_OF_INIT})->trace;
  for (uint64_t seed = 1; init->recording && seed <= RANDOM_STARTS; seed++) {
    add_start(w, PL_FROM_RANDOM,
              &(pl_trace_options){.seed = seed, .beside = init, .most_samples = SAMPLES_OF_RANDOM});
  }
  pl_state_sizes(w);
  add_named_starts(w);
}

// ---------------------------------------------------------------------------------- one comparison
typedef enum pl_agreement { PL_NOT_COMPARED, PL_AGREE, PL_DISAGREE } pl_agreement;

// What a run remembers of a statement: the value at the beginning of a phase, of what stays.
typedef struct pl_memory {
  int phase;
  double value, noise;
  bool left;  // of a closed motion: it has ended
} pl_memory;

static pl_agreement verdict(double shown, double motion, double allowed) {
  if (isnan(shown) || isnan(motion) || isnan(allowed) || isinf(shown)) return PL_NOT_COMPARED;
  return fabs(shown - motion) <= allowed + 1e-9 * (fabs(shown) + fabs(motion)) ? PL_AGREE
                                                                               : PL_DISAGREE;
}

static pl_agreement compare_constant(const pl_witness* w, const pl_statement* s, pl_memory* m,
                                     int phase, pl_contradiction_found* out) {
  double x = pl_state_value(w, s->shown), noise = pl_state_noise(w, s->shown);
  if (isnan(x)) return PL_NOT_COMPARED;
  if (m->phase != phase) {
    *m = (pl_memory){.phase = phase, .value = x, .noise = noise};
    return PL_NOT_COMPARED;
  }
  *out = (pl_contradiction_found){.shown = m->value, .motion = x};
  return verdict(m->value, x, fmax(noise, m->noise));
}

// What a comparison may be off by for another reason than rounding at the sample, in units of the
// largest value met.
static double slack_of(const pl_statement* s, const pl_witnessed* start) {
  return s->kind == PL_FOLLOWS || start->pushed ? closed_form : 1e-10;
}

// A position that is an angle is told up to whole turns, where it comes from an arc function.
static double without_turns(const pl_witness* w, const pl_statement* s, double shown,
                            double motion) {
  bool place = s->kind == PL_EQUALS && pl_kind_of(w->pool, s->left) == PL_SYMBOL;
  const pl_symbol_info* info = place ? pl_symbol_get(w->pool, pl_symbol_of(w->pool, s->left))
                                     : NULL;
  if (!info || info->role != PL_R_COORD
      || (info->dimension_known && !pl_dimension_equal(info->dimension, pl_dimension_one())))
    return shown;
  double turns = nearbyint((motion - shown) / (2 * M_PI));
  return isfinite(turns) ? shown + 2 * M_PI * turns : shown;
}

static pl_agreement compare(const pl_witness* w, pl_statement* s, const pl_witnessed* start,
                            pl_memory* m, int phase, pl_contradiction_found* out) {
  if (s->value && !pl_is_poison(s->value->holds_while)
      && !(pl_state_value(w, s->value->holds_while) > 0))
    return PL_NOT_COMPARED;
  if (s->kind == PL_STAYS) return compare_constant(w, s, m, phase, out);
  double shown = pl_state_value(w, s->shown), noise = pl_state_noise(w, s->shown);
  if (s->kind == PL_VANISHES) {
    *out = (pl_contradiction_found){.shown = shown};
    return isnan(shown) ? PL_NOT_COMPARED : fabs(shown) <= noise ? PL_AGREE : PL_DISAGREE;
  }
  double motion = pl_state_value(w, s->left);
  noise += pl_state_noise(w, s->left) + slack_of(s, start) * s->most;
  *out = (pl_contradiction_found){.shown = shown, .motion = motion};
  return verdict(without_turns(w, s, shown, motion), motion, noise);
}

// ---------------------------------------------------------------------------------- along a motion
// Answers hold for the contacts of the start: samples where other ones hold say nothing of them.
// Friction goes on the same way: it sticks, or slips to the same side.
static bool same_frictions(const pl_trace* a, int phase_a, const pl_trace* b, int phase_b) {
  for (int i = 0; i < a->recording->setup.n_frictions; i++) {
    const pl_friction_report *x = &a->phases.at[phase_a].frictions[i],
                             *y = &b->phases.at[phase_b].frictions[i];
    if (x->mode != y->mode
        || (x->mode == PL_FRICTION_SLIPS && x->way * x->press != y->way * y->press))
      return false;
  }
  return true;
}

static bool same_set(const pl_trace* a, int phase_a, const pl_trace* b, int phase_b) {
  int n = a->recording->setup.n_c;
  if (n != b->recording->setup.n_c) return false;
  if (!same_frictions(a, phase_a, b, phase_b)) return false;
  return memcmp(a->phases.at[phase_a].active, b->phases.at[phase_b].active,
                (size_t)n * sizeof(bool))
         == 0;
}

static bool is_stage(const pl_trace* t, int phase, const pl_stage* stage) {
  for (int i = 0; i < stage->n_rubs; i++) {
    const pl_stage_rub* friction = &stage->rubs[i];
    const pl_friction_report* now = &t->phases.at[phase].frictions[i];
    if (friction->sticks != (now->mode == PL_FRICTION_STICKS)
        || friction->slips != (now->mode == PL_FRICTION_SLIPS))
      return false;
    if (friction->slips && friction->way * friction->press != now->way * now->press) return false;
  }
  const pl_setup* s = &t->recording->setup;
  for (int c = 0; c < s->n_c; c++) {
    for (int k = 0; k < stage->n; k++) {
      if (strcmp(stage->name[k], s->constraints[c].name) == 0
          && stage->holds[k] != t->phases.at[phase].active[c])
        return false;
    }
  }
  return true;
}

// The first stretch of a motion with the constraints of a stage; -1 none.
static int begins_at(const pl_witness* w, const pl_trace* t, int stage) {
  if (stage == 0) return 0;
  for (int k = 0; k < t->phases.n && stage < w->n_stages; k++) {
    const pl_stage* s = &w->stages[stage];
    bool before = s->n_sides > 0 && t->phases.at[k].t_end <= s->from;
    if (!before && is_stage(t, k, s)) return k;
  }
  return -1;
}

static bool speaks_of(const pl_witness* w, const pl_statement* s, const pl_witnessed* start,
                      int phase) {
  if (s->stage > 0 && s->kind == PL_FOLLOWS)
    return start->kind == PL_FROM_INIT && phase == begins_at(w, start->trace, s->stage);
  if (s->stage > 0)
    return s->stage < w->n_stages && is_stage(start->trace, phase, &w->stages[s->stage]);
  if (s->from) {
    bool named = start->kind == PL_FROM_NAMED && same_motion(s->from, start->from);
    return named && phase == 0;  // behind an impact its energy is another one
  }
  if (s->kind == PL_FOLLOWS)
    return phase == 0 && start->trace->samples.at[0].t == 0 && start->kind != PL_FROM_NAMED;
  const pl_trace* init = w->starts.at[0].trace;
  return same_set(start->trace, phase, init->started ? init : start->trace, 0);
}

// All statements of a group at one sample: one of them has to hold.
static pl_agreement compare_group(pl_witness* w, int first, const pl_witnessed* start,
                                  pl_memory* memory, int phase, pl_contradiction_found* out) {
  pl_agreement all = PL_NOT_COMPARED;
  int group = w->statements.at[first].group;
  for (int i = first; i < w->statements.n; i++) {
    pl_statement* s = &w->statements.at[i];
    if (s->group != group) continue;
    pl_state_define(w, s->value);
    pl_contradiction_found here;
    pl_agreement one = compare(w, s, start, &memory[i], phase, &here);
    if (one == PL_AGREE) return one;
    if (one == PL_DISAGREE && all != PL_DISAGREE) *out = here;
    if (one == PL_DISAGREE) all = one;
  }
  return all;
}

static bool leads_group(const pl_witness* w, int i) {
  for (int k = 0; k < i; k++) {
    if (w->statements.at[k].group == w->statements.at[i].group) return false;
  }
  return true;
}

static bool is_zero(const pl_witness* w, pl_expr e) {
  return pl_is_poison(e) || !(fabs(pl_state_value(w, e)) > pl_state_noise(w, e));
}

// A sample is worth something where its state satisfies the constraints that hold, and its
// accelerations the same differentiated as they stand.
static bool is_sound(const pl_witness* w, const pl_trace* t, int phase) {
  for (int i = 0; i < w->model->constraints.n; i++) {
    if (!pl_trace_holds(t, &t->phases.at[phase], i)) continue;
    bool position = w->model->constraints.at[i].block || is_zero(w, w->model->constraints.at[i].g);
    if (!position || !is_zero(w, w->rate[i])) return false;
  }
  return true;
}

// by statement
typedef struct pl_verdicts {
  pl_agreement* of;
  pl_contradiction_found* found;
} pl_verdicts;

static void compare_one(pl_witness* w, int i, const pl_witnessed* start,
                        const pl_trace_sample* sample, pl_memory* memory, pl_verdicts* v) {
  pl_contradiction_found found;
  pl_agreement a = compare_group(w, i, start, memory, sample->phase, &found);
  if (a == PL_NOT_COMPARED) return;
  v->of[i] = a;
  if (a != PL_DISAGREE) return;
  found.t = sample->t;
  found.start = start->kind;
  v->found[i] = found;
}

// Closed motions of a later stage count the time from its beginning; where a force contains t there
// are none.
static bool has_motions(const pl_witness* w, int stage) {
  for (int i = 0; i < w->statements.n; i++) {
    if (w->statements.at[i].stage == stage && w->statements.at[i].kind == PL_FOLLOWS) return true;
  }
  return false;
}

// Where a stage begins.  A change of sides is no change of the constraints, and no sample is there.
static pl_trace_sample origin_of(const pl_witness* w, const pl_trace* t, int stage, int phase) {
  pl_trace_sample origin = t->samples.at[t->phases.at[phase].first];
  const pl_stage* s = stage > 0 ? &w->stages[stage] : NULL;
  if (!s || s->n_sides == 0 || s->n_q != t->recording->flat.n) return origin;
  origin.t = s->from;
  origin.q = s->q;
  origin.v = s->v;
  return origin;
}

// A closed motion holds from its beginning on, until what it assumes fails for the first time.
static bool still_follows(const pl_statement* s, const pl_trace_sample* sample,
                          const pl_trace_sample* origin, bool valid, pl_memory* m) {
  static const double behind = 1e-9;  // relative: the beginning itself is on neither side
  double begin = origin->t + (s->stage > 0 ? behind * (1 + fabs(origin->t)) : 0);
  if (s->kind != PL_FOLLOWS) return valid;
  if (sample->t < begin) return false;
  m->left |= !valid;
  return !m->left;
}

// The statements about one stage; times and start values of a later one are those of its beginning.
static void compare_stage(pl_witness* w, int stage, const pl_witnessed* start,
                          const pl_trace_sample* sample, pl_memory* memory, pl_verdicts* v) {
  const pl_trace* t = start->trace;
  int begin = begins_at(w, t, stage);
  if (begin < 0) return;
  const pl_trace_sample first = origin_of(w, t, stage, begin), *origin = &first;
  pl_state_set(w, t, sample, origin, stage > 0 && has_motions(w, stage) ? origin->t : 0);
  if (!is_sound(w, t, sample->phase)) return;
  for (int i = 0; i < w->statements.n; i++) {
    const pl_statement* s = &w->statements.at[i];
    if (s->stage != stage || v->of[i] == PL_DISAGREE || !leads_group(w, i)
        || !speaks_of(w, s, start, sample->phase))
      continue;
    bool valid = pl_state_is_valid(w, w->solution->sections.at[s->section].tower);
    if (still_follows(s, sample, origin, valid, &memory[i]))
      compare_one(w, i, start, sample, memory, v);
  }
}

// The largest values that what is compared takes on a motion: rounding and pushes are small beside
// them.
static void find_largest(pl_witness* w, const pl_witnessed* start) {
  for (int k = 0; k < start->trace->samples.n; k++) {
    pl_state_set(w, start->trace, &start->trace->samples.at[k], &start->trace->samples.at[0], 0);
    for (int i = 0; i < w->statements.n; i++) {
      double x = pl_state_value(w, w->statements.at[i].left);
      if (isfinite(x)) w->statements.at[i].most = fmax(w->statements.at[i].most, fabs(x));
    }
  }
}

static int last_stage(const pl_witness* w) {
  int last = 0;
  for (int i = 0; i < w->statements.n; i++)
    last = w->statements.at[i].stage > last ? w->statements.at[i].stage : last;
  return last;
}

// A start that had to be moved is another one.
static bool is_usable(const pl_trace* t) { return t->started && t->moved < 1e-8; }

// A motion through the border between two assemblies goes on in the other one, of which formulas
// for a `branch` say nothing.
static bool keeps_branches(pl_witness* w, const pl_trace* t, const pl_trace_sample* s) {
  for (int i = 0; i < w->model->branches.n; i++) {
    const pl_condition* c = &w->model->branches.at[i];
    pl_expr side = pl_sub(w->pool, c->left, c->right);
    pl_state_set(w, t, &t->samples.at[0], &t->samples.at[0], 0);
    double begin = pl_state_value(w, side);
    pl_state_set(w, t, s, &t->samples.at[0], 0);
    if (begin * pl_state_value(w, side) < 0) return false;
  }
  return true;
}

static void mark_border(pl_witness* w, const pl_trace* t, pl_expr side, bool* border) {
  static const double small = 1e-9;  // of its largest value on the motion
  double most = 0;
  double* x = PL_ARRAY(w->arena, double, t->samples.n + 1);
  for (int k = 0; k < t->samples.n; k++) {
    pl_state_set(w, t, &t->samples.at[k], &t->samples.at[0], 0);
    x[k] = pl_state_value(w, side);
    most = fmax(most, fabs(x[k]));
  }
  for (int k = 0; k < t->samples.n; k++) border[k] |= fabs(x[k]) < small * most;
}

// At a sample on the border of two sides, |x - a| with x = a, accelerations and forces may jump:
// the motion has those of neither side there. Whether each sample is such a one.
static bool* find_borders(pl_witness* w, const pl_trace* t) {
  bool* border = PL_ARRAY(w->arena, bool, t->samples.n + 1);
  const pl_tower* seen = NULL;
  for (int i = 0; i < w->solution->sections.n; i++) {
    const pl_tower* tower = w->solution->sections.at[i].tower;
    if (!tower || tower == seen) continue;
    seen = tower;
    int n = 0;
    const pl_fact* fact = pl_tower_used(tower, &n);
    for (int k = 0; k < n; k++) mark_border(w, t, fact[k].difference, border);
  }
  return border;
}

static void compare_along(pl_witness* w, const pl_witnessed* start, pl_verdicts* v) {
  if (!is_usable(start->trace)) return;
  find_largest(w, start);
  pl_memory* memory = PL_ARRAY(w->arena, pl_memory, w->statements.n + 1);
  for (int i = 0; i < w->statements.n; i++) memory[i].phase = -1;
  const bool* border = find_borders(w, start->trace);
  for (int k = 0;
       k < start->trace->samples.n && keeps_branches(w, start->trace, &start->trace->samples.at[k]);
       k++) {
    if (border[k]) continue;
    for (int stage = 0; stage <= last_stage(w); stage++)
      compare_stage(w, stage, start, &start->trace->samples.at[k], memory, v);
  }
}

// ---------------------------------------------------------------------------------- what disagrees
static const char* number(const pl_witness* w, double x, pl_language lang) {
  return pl_notation_number(w->arena, x, 6, (pl_notation){.math = PL_MATH_LINE, .lang = lang});
}

static const char* start_words(const pl_witness* w, const pl_contradiction_found* f,
                               pl_language lang) {
  static const char* const words[] = {PL_KEY("from the start"),
                                      PL_KEY("from the start that is named"),
                                      PL_KEY("from a random start")};
  return pl_format(w->arena, "%s, t = %s s", pl_in_language(lang, words[f->start]),
                   number(w, f->t, lang));
}

static const char* disagreement(const pl_witness* w, const pl_statement* s,
                                const pl_contradiction_found* f, pl_language lang) {
  static const char* const words[] = {
      [PL_EQUALS] = PL_KEY(
          "Formula and motion disagree about {1} (%s): the formula gives %s, the motion %s."),
      [PL_VANISHES] =
          PL_KEY("The motion does not satisfy {1} (%s): %s is left where %s should be."),
      [PL_STAYS] = PL_KEY("{1} is not constant along the motion (%s): it goes from %s to %s."),
      [PL_FOLLOWS] = PL_KEY(
          "Formula and motion disagree about {1} (%s): the formula gives %s, the motion %s."),
  };
  return pl_format(w->arena, pl_in_language(lang, words[s->kind]), start_words(w, f, lang),
                   number(w, f->shown, lang), number(w, f->motion, lang));
}

static pl_step sentence(pl_witness* w, const char* en, const char* de, const pl_form* name) {
  if (!name) return (pl_step){.kind = PL_STEP_TEXT, .words = {en, de}};
  const pl_form** insert = PL_ARRAY(w->arena, const pl_form*, 1);
  insert[0] = name;
  return (pl_step){.kind = PL_STEP_TEXT, .words = {en, de}, .n_inserts = 1, .inserts = insert};
}

static void withdraw_value(pl_value* v) {
  v->withdrawn = true;
  v->expr = v->lhs = v->got = pl_poison();
  v->form = v->lhs_form = NULL;
  v->number = (double)NAN;
  v->display = NULL;
  v->n_components = v->n_where = 0;
  v->conserved = v->passed = -1;
  v->stability = v->exists_if = v->stable_if = NULL;
}

// The formulas of the section go with the one that is false: they came the same way.
static void withdraw_section(pl_witness* w, pl_section* section, pl_step why) {
  if (section->withdrawn) return;
  section->withdrawn = true;
  section->steps.n = 0;
  for (int i = 0; i < section->values.n; i++) withdraw_value(&section->values.at[i]);
  pl_push(w->arena, section->steps, why);
  pl_push(w->arena, section->steps,
          sentence(w, PL_BOTH("One of them is wrong; nothing is claimed here."), NULL));
}

static void withdraw(pl_witness* w, const pl_statement* s, const pl_contradiction_found* f) {
  pl_section* section = &w->solution->sections.at[s->section];
  const pl_form* name = s->kind == PL_EQUALS || s->kind == PL_FOLLOWS
                            ? pl_form_of(w->arena, w->pool, s->left)
                            : pl_form_name(w->arena, s->name, pl_poison());
  pl_step why = sentence(w, disagreement(w, s, f, PL_ENGLISH), disagreement(w, s, f, PL_GERMAN),
                         name);
  withdraw_section(w, section, why);
}

// --------------------------------------------------------------------------------------- the check
static int count_started(const pl_witness* w) {
  int n = 0;
  for (int i = 0; i < w->starts.n; i++) n += is_usable(w->starts.at[i].trace);
  return n;
}

static void report(pl_witness* w, const pl_verdicts* v) {
  pl_check check = {
      .name = {PL_BOTH("formulas against the motion")}, .passed = true, .starts = count_started(w)};
  for (int i = 0; i < w->statements.n; i++) check.formulas += v->of[i] != PL_NOT_COMPARED;
  check.formulas += w->n_searched;
  for (int i = 0; i < w->statements.n; i++) {
    if (v->of[i] != PL_DISAGREE) continue;
    check.passed = false;
    if (!check.failed_on) check.failed_on = w->statements.at[i].name;
    withdraw(w, &w->statements.at[i], &v->found[i]);
  }
  for (int i = 0; i < w->refusals.n; i++) {
    const pl_refusal* r = &w->refusals.at[i];
    check.passed = false;
    if (!check.failed_on) check.failed_on = r->of;
    withdraw_section(w, &w->solution->sections.at[r->section],
                     sentence(w, r->words[0], r->words[1], r->name));
  }
  pl_push(w->arena, w->solution->checks, check);
}

static void report_without_motion(pl_witness* w, const char* why_en, const char* why_de) {
  pl_check check = {
      .passed = true,
      .name = {pl_format(w->arena, "formulas not held against the motion: %s", why_en),
               pl_format(w->arena, pl_german("formulas not held against the motion: %s"), why_de)}};
  pl_push(w->arena, w->solution->checks, check);
}

static bool too_large(const pl_witness* w, const pl_model* m) {
  return pl_model_flat_coords(m, w->arena).n + m->constraints.n > LARGEST;
}

// Constraints differentiated until accelerations occur.
static void differentiate(pl_witness* w) {
  w->rate = PL_ARRAY(w->arena, pl_expr, w->model->constraints.n + 1);
  for (int i = 0; i < w->model->constraints.n; i++) {
    const pl_constraint* c = &w->model->constraints.at[i];
    if (c->block || pl_is_poison(c->g)) continue;
    pl_expr once = pl_dt(w->pool, c->g);
    w->rate[i] = c->has_velocity ? once : pl_dt(w->pool, once);
  }
}

static bool is_searched(const pl_witness* w) {
  for (int i = 0; i < w->solution->sections.n; i++) {
    const pl_ask* ask = w->solution->sections.at[i].ask;
    if (!ask) continue;
    switch (ask->kind) {
      case PL_ASK_DOF:
      case PL_ASK_EQUILIBRIA:
      case PL_ASK_MODES:
      case PL_ASK_THRESHOLD:
      case PL_ASK_LIMIT:
      case PL_ASK_SERIES: return true;
      default:
        if (ask->where.n == 1) return true;
    }
  }
  return false;
}

void pl_witness_hold(pl_job* job, pl_solution* solution, const pl_stage* stages, int n_stages) {
  pl_model* m = (pl_model*)(uintptr_t)solution->model;
  pl_witness w = {.job = job,
                  .arena = job->arena,
                  .pool = m->pool,
                  .solution = solution,
                  .stages = stages,
                  .n_stages = n_stages};
  if (solution->sections.n == 0) return;
  pl_statements_collect(&w);
  if (w.statements.n == 0 && !is_searched(&w)) return;
  if (too_large(&w, m)) {
    report_without_motion(&w, PL_BOTH("the system is large"));
    return;
  }
  pl_model* numbered = pl_trace_model(job, m, PL_SEED_OF_NUMBERS);
  if (!numbered) {
    report_without_motion(&w, PL_BOTH("no numbers fit the assumptions"));
    return;
  }
  w.model = watched_model(&w, numbered);
  differentiate(&w);
  make_starts(&w);
  pl_state_open(&w);
  pl_verdicts v = {PL_ARRAY(w.arena, pl_agreement, w.statements.n),
                   PL_ARRAY(w.arena, pl_contradiction_found, w.statements.n)};
  for (int i = 0; i < w.starts.n; i++) compare_along(&w, &w.starts.at[i], &v);
  pl_search(&w);
  pl_meet(&w);
  pl_search_near(&w);
  if (count_started(&w) > 0) report(&w, &v);
  else
    report_without_motion(&w, w.starts.at[0].trace->message,
                          pl_in_language(PL_GERMAN, w.starts.at[0].trace->message));
}
