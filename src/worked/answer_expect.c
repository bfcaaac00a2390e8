// answer_expect: `expect`, the check of somebody's own statement: does it hold on the motion and on
// the constraints? Start values
// are not inserted.  Three answers: yes, no, not decided.
#include "worked/worked_impl.h"

// ------------------------------------------------------------------------------- inverse functions
// sin e and cos e of a sum of angles, inverse functions inserted in closed form: sin acos u =
// sqrt(1 - u²), ...
typedef struct pl_turn {
  pl_expr s, c;
} pl_turn;

static pl_expr other_leg(pl_analysis* d, pl_expr u) {
  return pl_sqrt(d->pool, pl_sub(d->pool, pl_int(d->pool, 1), pl_square(d->pool, u)));
}

static pl_turn turn_of_inverse(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  pl_expr u = pl_arg(p, e, 0);
  switch (pl_function_of(p, e)) {
    case PL_ASIN: return (pl_turn){u, other_leg(d, u)};
    case PL_ACOS: return (pl_turn){other_leg(d, u), u};
    case PL_ATAN: {
      pl_expr long_side = pl_sqrt(p, pl_add(p, pl_int(p, 1), pl_square(p, u)));
      return (pl_turn){pl_div(p, u, long_side), pl_div(p, pl_int(p, 1), long_side)};
    }
    case PL_ATAN2: {
      pl_expr x = pl_arg(p, e, 1), r = pl_sqrt(p, pl_add(p, pl_square(p, u), pl_square(p, x)));
      return (pl_turn){pl_div(p, u, r), pl_div(p, x, r)};
    }
    default: return (pl_turn){pl_call(p, PL_SIN, e), pl_call(p, PL_COS, e)};
  }
}

static pl_turn both(pl_analysis* d, pl_turn a, pl_turn b) {
  pl_pool* p = d->pool;
  return (pl_turn){pl_add(p, pl_mul(p, a.s, b.c), pl_mul(p, a.c, b.s)),
                   pl_sub(p, pl_mul(p, a.c, b.c), pl_mul(p, a.s, b.s))};
}

enum { most_turns = 8 };  // multiples of an angle that are expanded

static pl_turn turn_of(pl_analysis* d, pl_expr e) {
  pl_pool* p = d->pool;
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_CALL) return turn_of_inverse(d, e);
  if (kind == PL_ADD) {
    pl_turn sum = turn_of(d, pl_arg(p, e, 0));
    for (int i = 1; i < pl_n_args(p, e); i++) sum = both(d, sum, turn_of(d, pl_arg(p, e, i)));
    return sum;
  }
  long n = 0;
  if (kind == PL_MUL && pl_is_int(p, pl_arg(p, e, 0), &n) && n != 0 && n >= -most_turns
      && n <= most_turns) {
    pl_turn one = turn_of(d, pl_div(p, e, pl_int(p, n))), all = {pl_int(p, 0), pl_int(p, 1)};
    if (n < 0) one.s = pl_neg(p, one.s);
    for (long k = n < 0 ? -n : n; k > 0; k--) all = both(d, all, one);
    return all;
  }
  return (pl_turn){pl_call(p, PL_SIN, e), pl_call(p, PL_COS, e)};
}

static bool has_inverse(const pl_pool* p, pl_expr e) {
  if (pl_kind_of(p, e) == PL_CALL) {
    pl_function f = pl_function_of(p, e);
    if (f == PL_ASIN || f == PL_ACOS || f == PL_ATAN || f == PL_ATAN2) return true;
  }
  if (pl_kind_of(p, e) != PL_ADD && pl_kind_of(p, e) != PL_MUL) return false;
  for (int i = 0; i < pl_n_args(p, e); i++) {
    if (has_inverse(p, pl_arg(p, e, i))) return true;
  }
  return false;
}

// e is zero when sin e = 0 and cos e = 1 hold identically, so that it is a multiple of 2π, and the
// sample points say which.
static pl_answer3 zero_by_turns(pl_analysis* d, pl_expr e) {
  if (!has_inverse(d->pool, e)) return PL_UNKNOWN;
  pl_turn turn = turn_of(d, e);
  if (pl_alg_is_zero(d->tower, turn.s) != PL_YES) return PL_UNKNOWN;
  if (pl_alg_is_zero(d->tower, pl_sub(d->pool, turn.c, pl_int(d->pool, 1))) != PL_YES)
    return PL_UNKNOWN;
  pl_domain setup = {.facts = d->facts.at, .n_facts = d->facts.n};
  return pl_verify(pl_verifier_make(d->job, d->pool, &setup), e, pl_int(d->pool, 0)).equal;
}

// ------------------------------------------------------------------------------------- the section
// constraints that are solved and inserted for an `expect` without generalized coordinates
enum { max_inserted = 3 };

// Is e zero wherever the constraints from k on hold? Each is solved for one coordinate, all its
// roots are inserted, and their
// derivatives for its velocity.
static pl_answer3 zero_on_constraints(pl_analysis* d, pl_expr e, int k, int depth) {
  pl_answer3 zero = pl_alg_is_zero(d->tower, e);
  while (k < d->g.n && (d->g.at[k].implied || d->g.at[k].velocity || d->g.at[k].fixes >= 0)) k++;
  if (zero == PL_YES || k == d->g.n) return zero;
  if (depth == max_inserted) return PL_UNKNOWN;
  pl_expr g = pl_on_contact(d, d->g.at[k].g);
  for (int i = d->q.n - 1; i >= 0; i--) {
    const pl_variable* c = &d->q.at[i];
    if (!pl_has_symbol(d->pool, g, c->q)) continue;
    pl_root root[8];
    bool complete = false;
    int n = pl_alg_roots(d->tower, g, c->q, root, 8, &complete);
    if (n == 0 || !complete) continue;
    pl_answer3 all = PL_YES;
    for (int r = 0; r < n && all != PL_NO; r++) {
      pl_replace inserted[2] = {{c->q, root[r].value}, {c->v, pl_dt(d->pool, root[r].value)}};
      pl_answer3 one = zero_on_constraints(d, pl_subst(d->pool, e, inserted, 2), k + 1, depth + 1);
      if (one != PL_YES) all = one;
    }
    return all;
  }
  return PL_UNKNOWN;
}

static bool unsolved(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_MULTIPLIER);
}

// A side of the statement, on the motion that `from` names.
static pl_expr side_of(pl_analysis* d, const pl_ask* ask, pl_expr e, bool* unused) {
  pl_line line;
  bool eliminated = false;
  if (!ask->motion.given) return pl_on_motion(d, pl_with_results(d, e));
  e = pl_value_on(d, &ask->motion, e, &line, &eliminated);
  *unused |= !eliminated && pl_has_role(d->pool, e, PL_R_VELOCITY);
  return e;
}

void pl_answer_expect(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Expected"));
  const pl_condition* c = &ask->where.at[0];
  bool unused = false;  // the start gives no velocities
  pl_expr left = side_of(d, ask, c->left, &unused), right = side_of(d, ask, c->right, &unused);
  for (int k = 1; k < ask->where.n; k++) {
    left = pl_subst_expr(d->pool, left, ask->where.at[k].left, ask->where.at[k].right);
    right = pl_subst_expr(d->pool, right, ask->where.at[k].left, ask->where.at[k].right);
  }
  pl_answer3 equal = pl_alg_equal(d->tower, left, right);
  if (equal != PL_YES && !d->reduced)
    equal = zero_on_constraints(d, pl_sub(d->pool, left, right), 0, 0);
  if (equal != PL_YES && (pl_has_followers(d, left) || pl_has_followers(d, right))
      && !unsolved(d, left) && !unsolved(d, right)) {
    equal = pl_holds_on_loops(d, left, right);
  }
  if (equal == PL_UNKNOWN) equal = zero_by_turns(d, pl_sub(d->pool, left, right));
  if (equal == PL_NO && (unused || unsolved(d, left) || unsolved(d, right))) equal = PL_UNKNOWN;
  if (equal == PL_UNKNOWN && unused) pl_say_from_unused(d);
  const pl_form* claim = pl_feq(d, pl_fe(d, c->left), pl_fe(d, c->right));
  left = pl_alg_normal(d->tower, left);
  pl_value* v = pl_answer(d, "expect", equal == PL_YES ? right : left, NULL);
  v->passed = equal == PL_YES;
  if (equal == PL_YES) {
    pl_say(d, "{1}: yes", "{1}: ja", 1, claim);
    return;
  }
  v->got = left;
  if (pl_not_determined(d, pl_alg_normal(d->tower, pl_sub(d->pool, left, right)))) {
    pl_say(d,
           PL_BOTH("{1}: no, this is not determined; only sums of the forces of constraints that "
                   "depend on "
                   "each other are."),
           1, claim);
    d->page->solution->expect_failed = true;
    return;
  }
  const pl_form* got = pl_feq(d, pl_fe(d, c->left), pl_f(d, left, PL_S_QUOTIENT));
  pl_say(d, PL_BOTH(equal == PL_NO ? "{1}: no, {2}" : "{1}: not decided; {2}"), 2, claim, got);
  d->page->solution->expect_failed = true;
}
