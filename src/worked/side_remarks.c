// side_remarks: the signs that formulas took for granted, as they are told, and how long they hold.
// Whether a motion leaves its side is found out by the simulation (pl_derive_options).
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

// a - b >= 0 as b <= a.
typedef struct pl_two_parts {
  pl_expr left, right;
  const char* op;
} pl_two_parts;

static bool is_negative(pl_analysis* d, pl_expr term) {
  pl_pool* p = d->pool;
  if (pl_is_number(p, term)) return pl_number_sign(p, term) < 0;
  return pl_op_count(p, pl_neg(p, term)) < pl_op_count(p, term);
}

static pl_two_parts parts_of(pl_analysis* d, const pl_fact* f) {
  pl_pool* p = d->pool;
  pl_expr e = pl_expand(p, f->difference, 64), minus = pl_int(p, 0), plus = pl_int(p, 0);
  int n = pl_kind_of(p, e) == PL_ADD ? pl_n_args(p, e) : 0;
  for (int k = 0; k < n; k++) {
    pl_expr term = pl_arg(p, e, k);
    if (is_negative(d, term)) minus = pl_add(p, minus, pl_neg(p, term));
    else plus = pl_add(p, plus, term);
  }
  if (n == 0 && is_negative(d, e)) minus = pl_neg(p, e);
  bool below = !pl_is_zero_node(p, minus);
  bool split = below && !pl_is_zero_node(p, plus);
  if (split) return (pl_two_parts){minus, plus, f->strict ? "<" : "≤"};
  if (below) return (pl_two_parts){minus, pl_int(p, 0), f->strict ? "<" : "≤"};
  return (pl_two_parts){e, pl_int(p, 0), f->strict ? ">" : "≥"};
}

const pl_form* pl_fact_form(pl_analysis* d, const pl_fact* f) {
  pl_two_parts s = parts_of(d, f);
  const pl_form* right = pl_is_zero_node(d->pool, s.right) ? pl_form_leaf(d->arena, s.right)
                                                           : pl_fe(d, s.right);
  return pl_frel(d, pl_fe(d, s.left), s.op, right);
}

static const char* plain_text(pl_analysis* d, const pl_fact* f) {
  pl_two_parts s = parts_of(d, f);
  const char* op = strcmp(s.op, "≤") == 0 ? "<=" : strcmp(s.op, "≥") == 0 ? ">=" : s.op;
  return pl_format(d->arena, "%s %s %s", pl_expr_text(d->arena, d->pool, s.left), op,
                   pl_expr_text(d->arena, d->pool, s.right));
}

const pl_form* pl_facts_form(pl_analysis* d, const pl_fact* fact, int n) {
  const pl_form** form = PL_ARRAY(d->arena, const pl_form*, n + 1);
  for (int k = 0; k < n; k++) form[k] = pl_fact_form(d, &fact[k]);
  return n == 1 ? form[0] : pl_flist(d, form, n);
}

static void assume(pl_analysis* d, pl_value* v, const pl_fact* side, int n) {
  if (v->n_assuming > 0) return;
  const char** text = PL_ARRAY(d->arena, const char*, n + 1);
  for (int k = 0; k < n; k++) text[k] = plain_text(d, &side[k]);
  v->assuming = text;
  v->n_assuming = n;
}

void pl_assume_sides(pl_analysis* d, pl_section* s, int from) {
  const pl_fact* side;
  int n = pl_taken_sides(d, &side);
  for (int k = from; n > 0 && k < s->values.n; k++) assume(d, &s->values.at[k], side, n);
}

// -------------------------------------------------------------------------------------- until when
bool pl_leave(pl_analysis* d, const pl_fact* side, int n, double from, double to, pl_leaving* out) {
  const pl_derive_options* o = d->page->options;
  if (n == 0 || !o->leaves) return false;
  pl_expr* e = PL_ARRAY(d->arena, pl_expr, n + 1);
  for (int k = 0; k < n; k++) e[k] = side[k].difference;
  return o->leaves(o->user, e, n, from, to, out);
}

double pl_end_of_stage(const pl_stage* s) {
  return s && s->end != PL_END_UNKNOWN ? s->to : (double)INFINITY;
}

bool pl_leaves_first(pl_analysis* d, const pl_stage* s, pl_leaving* out, pl_expr* crossed) {
  pl_fact side[2 * pl_max_sides];
  int n = pl_known_sides(d, side);
  if (!pl_leave(d, side, n, s->from, pl_end_of_stage(s), out) || !out->leaves) return false;
  for (int k = n - 1; k >= 0; k--) {
    if (out->through[k]) *crossed = side[k].difference;
  }
  return true;
}

bool pl_motion_changes_sides(pl_analysis* d) {
  pl_fact side[2 * pl_max_sides];
  pl_leaving l;
  int n = pl_known_sides(d, side);
  double begin = d->stage ? d->stage->from : 0;
  return pl_leave(d, side, n, begin, pl_end_of_stage(d->stage), &l) && l.leaves;
}

void pl_say_while(pl_analysis* d, int from) {
  const pl_fact* side;
  int n = pl_taken_sides(d, &side);
  if (n == 0) return;
  const pl_form* form = pl_facts_form(d, side, n);
  pl_assume_sides(d, d->page->section, from);
  pl_fact known[2 * pl_max_sides];
  pl_leaving l;
  int m = pl_known_sides(d, known);
  double begin = d->stage ? d->stage->from : 0;
  bool told = m >= n && !d->later && pl_leave(d, known, m, begin, pl_end_of_stage(d->stage), &l);
  if (told && l.leaves) {
    pl_say(d, PL_BOTH("This holds as long as {1}, until {2}."), 2, form, pl_moment_form(d, l.t));
  } else {
    pl_say(d, PL_BOTH("This holds as long as {1}."), 1, form);
  }
}

// ------------------------------------------------------------------------------------ other starts
// What an expression of places and velocities is at the start of a motion; NaN: not known.
static double number_at_start(pl_analysis* a, const pl_motion* motion, pl_expr e) {
  e = pl_on_maps(a, e);
  for (int k = 0; k < a->gen.n; k++) {
    const pl_variable* c = &a->q.at[a->gen.at[k]];
    pl_expr q, v;
    pl_motion_start(a, motion, c, &q, &v);
    e = pl_subst1(a->pool, pl_subst1(a->pool, e, c->q, q), c->v, v);
  }
  return pl_number(a, e);
}

pl_analysis* pl_analysis_around(pl_analysis* d, pl_analysis* a, const pl_motion* motion) {
  pl_fact side[2 * pl_max_sides];
  bool through[2 * pl_max_sides], any = false;
  int n = a->reduced ? pl_known_sides(d, side) : 0;
  for (int k = 0; k < n; k++)
    any |= through[k] = number_at_start(a, motion, side[k].difference) < 0;
  pl_analysis* other = any ? pl_analysis_beyond(d, side, n, through) : NULL;
  return other ? other : d;
}
