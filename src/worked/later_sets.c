// later sets: a section for each set of constraints that the motion comes to, and for each side of
// a sign that its formulas took for granted: how it begins, how it ends, and the requests that hang
// on it again.
//
// Which sets there are is told by the simulation (pl_stage); where the motion changes sides is
// asked of it (pl_leave).
#include <math.h>
#include <string.h>

#include "worked/sets_impl.h"

enum { MOST_LATER_STAGES = 5 };

// What hangs on the set, and is asked about the motion of `init`.
static bool is_repeated(const pl_analysis* d, const pl_ask* ask) {
  bool told = d->stage->n_sides > 0 && ask->kind == PL_ASK_EQUILIBRIA;  // for all sides already
  if (told) return false;
  switch (ask->kind) {
    case PL_ASK_LAGRANGE1:
    case PL_ASK_LAGRANGE2:
    case PL_ASK_NEWTON:
    case PL_ASK_SOLVE:
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON:
    case PL_ASK_CONSERVED:
    case PL_ASK_EQUILIBRIA: return true;
    case PL_ASK_VALUE: return ask->where.n == 0 && !ask->motion.given;
    default: return false;
  }
}

static bool contains_time(pl_analysis* d) {
  bool any = !pl_scleronomic(d);
  for (int i = 0; i < d->q.n; i++) any |= pl_has_symbol(d->pool, d->force[i], pl_time(d->pool));
  return any;
}

static bool is_motion(const pl_ask* ask) { return ask->kind == PL_ASK_SOLVE && ask->of_time; }

// What speaks of t or of the start means those of the whole motion: a stretch in the middle has
// another clock.
static bool fits_clock(pl_analysis* d, const pl_ask* ask) {
  if (is_motion(ask)) return !contains_time(d);
  return pl_is_poison(ask->value) || !pl_has_role(d->pool, ask->value, PL_R_START);
}

// Answers a request for the set; what is not found there is left out.
static bool repeat(pl_analysis* d, const pl_ask* ask) {
  pl_ask again = *ask;
  again.letter = NULL;
  again.motion = (pl_motion){0};
  pl_symbol unnamed;
  if (pl_speaks_of_unnamed(d, &again, &unnamed)) return false;
  for (int k = 0; k < d->open.n; k++) {
    if (pl_is_about_open(d, &again, &d->open.at[k])) return false;
  }
  int sections = d->page->solution->sections.n, equations = d->page->solution->n_equations,
      claims = d->page->claims.n;
  pl_answer_one(d, &again);
  bool found = true;
  for (int k = sections; k < d->page->solution->sections.n; k++)
    found &= !d->page->solution->sections.at[k].not_found;
  if (found) return true;
  d->page->solution->sections.n = sections;
  d->page->solution->n_equations = equations;
  d->page->claims.n = claims;
  return false;
}

// What has become of a constraint, in one word.
typedef enum pl_state_word {
  PL_WORD_CONTACT,
  PL_WORD_ROPE,
  PL_WORD_DEED,
  PL_N_WORDS
} pl_state_word;
static const char* const state_word[PL_N_WORDS][2] = {
    // holds, does not
    [PL_WORD_CONTACT] = {PL_KEY("closed"), PL_KEY("open")},
    [PL_WORD_ROPE] = {PL_KEY("taut"), PL_KEY("slack")},
    [PL_WORD_DEED] = {PL_KEY("attached"), PL_KEY("released")},
};

static pl_state_word word_for(const pl_analysis* d, const pl_constraint* c) {
  int row = pl_stage_row(d->stage, pl_stage_label(c));
  if (c->relation == PL_EQ || d->stage->released[row]) return PL_WORD_DEED;
  return d->stage->rope[row] ? PL_WORD_ROPE : PL_WORD_CONTACT;
}

static int list_changes(pl_analysis* d, const pl_stage* before, bool holds, pl_state_word word,
                        const char** out) {
  int n = 0;
  for (int k = 0; k < d->whole->constraints.n; k++) {
    const pl_constraint* c = &d->whole->constraints.at[k];
    int now = pl_stage_row(d->stage, pl_stage_label(c)),
        then = pl_stage_row(before, pl_stage_label(c));
    if (now < 0 || then < 0 || d->stage->holds[now] != holds || before->holds[then] == holds
        || c->while_label)
      continue;
    if (word_for(d, c) != word) continue;
    out[n++] = c->name.text;
  }
  return n;
}

static void add_names(pl_text* t, const char* const* name, int n, const char* what, bool* any) {
  if (n == 0) return;
  if (*any) pl_text_add(t, ", ");
  for (int k = 0; k < n; k++) pl_text_addf(t, "%s%s", k ? ", " : "", name[k]);
  pl_text_addf(t, " %s", what);
  *any = true;
}

// "From t = 6.54427 s: h open"
static const char* stage_title(pl_analysis* d, pl_language lang) {
  const char** name = PL_ARRAY(d->arena, const char*, d->whole->constraints.n + 1);
  bool de = lang == PL_GERMAN;
  pl_text t = pl_text_make(d->arena);
  pl_text_addf(
      &t, de ? pl_german("From %s: ") : "From %s: ", pl_stage_seconds(d, d->stage->from, lang));
  const pl_stage* first = &d->page->solution->stages.at[0];
  bool any = false;
  for (int holds = 1; holds >= 0; holds--) {
    for (int word = 0; word < PL_N_WORDS; word++) {
      int n = list_changes(d, first, holds, (pl_state_word)word, name);
      add_names(&t, name, n, pl_in_language(de ? PL_GERMAN : PL_ENGLISH, state_word[word][!holds]),
                &any);
    }
  }
  for (int k = 0; k < d->stage->n_crossed; k++) {
    const pl_form* side = pl_fact_form(d, &d->stage->sides[k]);
    const char* text = pl_notation_print(d->arena, d->pool, side,
                                         (pl_notation){PL_MATH_LINE, lang});
    pl_text_addf(&t, "%s%s", any ? ", " : "", text);
    any = true;
  }
  for (int k = 0; k < d->stage->n_rubs; k++) {
    const pl_stage_rub *now = &d->stage->rubs[k],
                       *then = k < first->n_rubs ? &first->rubs[k] : NULL;
    bool same = then && now->sticks == then->sticks && now->slips == then->slips
                && (!now->slips || now->way == then->way);
    if (same || (!now->sticks && !now->slips)) continue;
    add_names(
        &t, &now->on, 1,
        now->sticks ? (de ? pl_german("sticks") : "sticks") : (de ? pl_german("slips") : "slips"),
        &any);
  }
  return pl_text_string(&t);
}

// x = 20 m, ϑ = 48.2°
static const char* place_text(pl_analysis* d, const pl_stage* s, pl_language lang) {
  enum { most = 8 };
  pl_text t = pl_text_make(d->arena);
  double size = 0;
  for (int i = 0; i < s->n_q; i++)
    size = fmax(size, fmax(fabs(s->q[i]), s->v ? fabs(s->v[i]) : 0));  // of the motion in a second
  for (int i = 0; i < s->n_q && i < most; i++) {
    bool angle = strcmp(s->q_unit[i], "rad") == 0;
    double x = fabs(s->q[i]) < 1e-14 * size ? 0 : angle ? s->q[i] * (180 / M_PI) : s->q[i];
    const char* number = pl_notation_number(d->arena, x, 6, (pl_notation){PL_MATH_LINE, lang});
    pl_symbol symbol = pl_symbol_find(d->pool, s->q_name[i]);
    const char* name = symbol.id ? pl_symbol_get(d->pool, symbol)->name : s->q_name[i];
    pl_text_addf(&t, "%s%s = %s%s%s", i ? ", " : "", name, number,
                 angle           ? "°"
                 : *s->q_unit[i] ? " "
                                 : "",
                 angle ? "" : s->q_unit[i]);
  }
  return pl_text_string(&t);
}

static void say_begin(pl_analysis* d, const pl_stage* before) {
  const pl_stage* s = d->stage;
  const pl_form* place = pl_form_words(d->arena, place_text(d, s, PL_ENGLISH),
                                       place_text(d, s, PL_GERMAN));
  const pl_form* end = before->to == s->from ? pl_form_end(d, before) : NULL;
  if (end) {
    pl_say(d, PL_BOTH("It begins where {1}: at {2}, {3}."), 3, end, pl_moment_form(d, s->from),
           place);
  } else {
    pl_say(d, PL_BOTH("It begins at {1}, {2}."), 2, pl_moment_form(d, s->from), place);
  }
  int n = d->dof.dof;
  pl_say(d, n == 1 ? "1 degree of freedom." : pl_format(d->arena, "%d degrees of freedom.", n),
         n == 1 ? pl_german("1 degree of freedom.")
                : pl_format(d->arena, pl_german("%d degrees of freedom."), n),
         0);
  for (int k = 0; k < d->whole->asks.n; k++) {
    if (!is_motion(&d->whole->asks.at[k]) || contains_time(d)) continue;
    pl_say(d,
           PL_BOTH(
               "In the motions that follow {1} counts from here, and the start values are those of "
               "this moment."),
           1, pl_fs(d, pl_time(d->pool)));
    return;
  }
}

static void mark(pl_analysis* d, int from, int stage) {
  for (int k = from; k < d->page->solution->sections.n; k++)
    d->page->solution->sections.at[k].stage = stage;
}

// The section of a stage behind the requests.
static void answer_stage(pl_analysis* d, const pl_stage* s, const pl_stage* before, int k) {
  d->later = d->page->has_section = true;
  int from = d->page->solution->sections.n;
  pl_ask head = {.kind = PL_ASK_DOF, .text = pl_format(d->arena, "stage %d", k + 1)};
  pl_section_open(d, &head, stage_title(d, PL_ENGLISH), stage_title(d, PL_GERMAN));
  say_begin(d, before);
  pl_say_stage_end(d, s);
  pl_answer(d, "dof", pl_int(d->pool, d->dof.dof), NULL);
  d->page->open_told = true;
  pl_tell_friction(d);
  bool any = false;
  for (int i = 0; i < d->whole->asks.n; i++) {
    const pl_ask* ask = &d->whole->asks.at[i];
    if (is_repeated(d, ask) && fits_clock(d, ask)) any |= repeat(d, ask);
  }
  pl_ask plain = {.kind = PL_ASK_LAGRANGE1, .text = "lagrange1"};
  if (!any) repeat(d, &plain);
  mark(d, from, k);
  for (int i = from; s->n_sides > 0 && i < d->page->solution->sections.n; i++)
    pl_assume_sides(d, &d->page->solution->sections.at[i], 0);
  d->later = false;
}

// ------------------------------------------------------------------------------------- other sides
// Where a stage ends: where the motion changes sides, or as its constraints end.
static void find_end(pl_analysis* d, pl_stage* s) {
  pl_leaving l;
  pl_expr crossed;
  if (!pl_leaves_first(d, s, &l, &crossed)) return;
  s->end = PL_END_SIDE;
  s->to = l.t;
  s->crossed = crossed;
}

// The stretch that begins where the motion leaves the sides of d.
static pl_stage* next_side(pl_analysis* d, const pl_stage* now, const pl_fact* side, int n,
                           const pl_leaving* l) {
  const pl_stage* own = d->stage;
  d->stage = now;
  pl_stage* s = pl_stage_turned(d, side, n, l->through);
  d->stage = own;
  s->from = l->t;
  s->n_q = l->n_q;
  s->q_name = l->q_name;
  s->q_unit = l->q_unit;
  s->q = l->q;
  s->v = l->v;
  return s;
}

// Follows the motion of one set of constraints from side to side; each that is new has a section.
static void follow_sides(pl_analysis* first, pl_analysis* d, const pl_stage* set) {
  enum { MOST_CHANGES = 40 };
  pl_solution* solution = first->page->solution;
  pl_stage now = *set;
  for (int i = 0; i < MOST_CHANGES && first->page->n_turns < MOST_LATER_STAGES; i++) {
    pl_fact side[2 * pl_max_sides];
    pl_leaving l;
    int n = pl_known_sides(d, side);
    if (!pl_leave(d, side, n, now.from, pl_end_of_stage(&now), &l) || !l.leaves) return;
    pl_stage before = now, *next = next_side(d, &now, side, n, &l);
    before.end = PL_END_SIDE;
    before.to = l.t;
    before.crossed = next->sides[0].difference;
    pl_analysis* other = pl_analysis_find(first, next);
    now = *next;
    if (other && other->page->has_section) {
      d = other;
      continue;
    }
    if (!(other = pl_analysis_in(first, next))) return;
    first->page->n_turns++;
    find_end(other, next);
    pl_push(first->arena, solution->stages, *next);
    answer_stage(other, next, &before, solution->stages.n - 1);
    d = other;
  }
}

void pl_answer_stages(pl_analysis* first) {
  const pl_derive_options* o = first->page->options;
  pl_solution* solution = first->page->solution;
  for (int k = 0; k < o->n_stages; k++) pl_push(first->arena, solution->stages, o->stages[k]);
  if (o->n_stages == 0) pl_push(first->arena, solution->stages, *pl_stage_like(first));
  if (o->only || !pl_knows_friction(first)) return;
  for (int k = 0; k < o->n_stages || k == 0; k++) {
    if (pl_interrupted(first->job)) return;
    pl_stage set = solution->stages.at[k];
    pl_analysis* d = k == 0 ? first : pl_analysis_in(first, &o->stages[k]);
    if (d && k > 0 && k <= MOST_LATER_STAGES) answer_stage(d, &o->stages[k], &o->stages[k - 1], k);
    if (d) follow_sides(first, d, &set);
  }
}

// ------------------------------------------------------------------------ with all contacts closed
void pl_answer_closed(pl_analysis* first, const pl_ask* ask) {
  if (ask->kind != PL_ASK_EQUILIBRIA) return;
  const pl_stage* s = pl_stage_all_closed(first);
  pl_analysis* d = s ? pl_analysis_in(first, s) : NULL;
  if (!d || !d->reduced) return;
  pl_section* own = &first->page->solution->sections.at[first->page->solution->sections.n - 1];
  own->title[0] = "Equilibria as the start has the contacts";
  own->title[1] = pl_german("Equilibria as the start has the contacts");
  pl_answer_one(d, ask);
  d->page->section->beside = true;
  d->page->section->title[0] = "Equilibria with all contacts closed";
  d->page->section->title[1] = pl_german("Equilibria with all contacts closed");
}
