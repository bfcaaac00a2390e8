// answer_value: a quantity on the motion, or where something holds; and `expect`, the check of
// somebody's own answer.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

const char* pl_text_of(pl_analysis* d, pl_expr e) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  return pl_notation_print(d->arena, d->pool, pl_f(d, e, PL_S_PLAIN), how);
}

static bool unsolved(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_MULTIPLIER);
}

bool pl_say_unsolved(pl_analysis* d, pl_expr asked, pl_expr e) {
  if (!unsolved(d, e)) return false;
  if (pl_not_determined(d, e)) {
    pl_say(d,
           PL_BOTH("{1} is not determined: constraints depend on each other, and only sums of "
                   "their forces "
                   "follow from the motion."),
           1, pl_fe(d, asked));
    return true;
  }
  pl_say(d,
         PL_BOTH("{1} hangs on accelerations or multipliers for which no closed form was found."),
         1, pl_fe(d, asked));
  d->page->section->not_found = true;
  return true;
}

// Nothing was found for the quantity: it is what it was, or hangs on accelerations and multipliers
// that are not solved.
static bool stays_open(pl_analysis* d, pl_expr asked, pl_expr e) {
  if (pl_say_unsolved(d, asked, e)) return true;
  if (pl_same(asked, e) && pl_kind_of(d->pool, e) == PL_SYMBOL && pl_has_coordinates(d, e)) {
    pl_say(
        d,
        PL_BOTH("{1} belongs to the state; the constraints give no closed form for it. Its motion: "
                "\"solve {1}(t)\" for a coordinate."),
        1, pl_fe(d, asked));
  } else {
    return false;
  }
  d->page->section->not_found = true;
  return true;
}

static bool kinematic(const pl_analysis* d) { return d->particle.n == 0 && d->model->loads.n == 0; }

static void plain_value(pl_analysis* d, const pl_ask* ask) {
  if (pl_kind_of(d->pool, ask->value) == PL_SYMBOL
      && pl_answer_follower(d, pl_symbol_of(d->pool, ask->value)))
    return;
  bool eliminated = false;
  pl_line line;
  pl_expr e = ask->motion.given
                  ? pl_value_on(d, &ask->motion, ask->value, &line, &eliminated)
                  : pl_alg_normal(d->tower, pl_on_motion(d, pl_with_results(d, ask->value)));
  if (pl_is_poison(e)) {
    pl_answer_pending(d, ask);
    return;
  }
  if (pl_has_followers(d, e)) {
    if (unsolved(d, e) || unsolved(d, ask->value)) pl_tell_loops(d);
    else e = pl_alg_normal(d->tower, pl_without_slopes(d, e));
  }
  if (unsolved(d, e) && !pl_not_determined(d, e) && pl_show_value_structured(d, ask->value, e))
    return;
  // accelerations of generalized coordinates are
  bool given = kinematic(d) && d->reduced && !pl_same(ask->value, e);
  if (!given && stays_open(d, ask->value, e)) return;
  if (ask->motion.given && !eliminated && pl_has_role(d->pool, e, PL_R_VELOCITY))
    pl_say_from_unused(d);
  const pl_form* form = pl_f(d, e, PL_S_QUOTIENT);
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fe(d, ask->value), form));
  bool known;
  pl_step_value(d, step, e, pl_dimension_of_expr(d, e, &known));
  if (!eliminated)
    pl_claim_that(d, PL_CLAIM_OTHER, pl_form_value(d->pool, form), pl_with_results(d, ask->value));
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, ask->value), e, form);
  if (eliminated)
    v->holds_while = pl_say_way(d, &line, pl_on_motion(d, pl_with_results(d, ask->value)));
}

// The request as a German title: the words between its formulas, "ϑ für λ = 0, Start aus der Ruhe
// bei ϑ = 0".
static const char* german_title(pl_analysis* d, const char* request) {
  size_t length = strlen(request), rest = strlen(" at rest");
  bool at_rest = length > rest && strcmp(request + length - rest, " at rest") == 0;
  const char* const word[][2] = {
      {PL_BOTH(" where ")},
      {PL_BOTH(" from rest")},
      {" at rest", ""},
      {" from ", at_rest ? pl_german(" at rest from ") : pl_german(" from ")},
      {PL_BOTH(" and ")}};
  pl_text out = pl_text_make(d->arena);
  while (*request) {
    size_t n = 0;
    for (size_t k = 0; k < sizeof word / sizeof *word && n == 0; k++) {
      if (strncmp(request, word[k][0], strlen(word[k][0])) != 0) continue;
      pl_text_add(&out, word[k][1]);
      n = strlen(word[k][0]);
    }
    if (n == 0) pl_text_add_n(&out, request, n = 1);
    request += n;
  }
  return pl_text_string(&out);
}

void pl_answer_value(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, ask->text, german_title(d, ask->text));
  if (ask->where.n > 0) {
    pl_answer_where(d, ask);
  } else {
    plain_value(d, ask);
  }
}
