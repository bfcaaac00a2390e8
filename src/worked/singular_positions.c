// branch_points: positions where a constraint does not determine the coordinate that it was solved
// for: dg/dx = 0 on the map. There the rank of the constraints drops, the mechanism may branch (a
// crank whose rod is as long as the crank), and formulas divide by zero.
// See theory (5.4).
#include <math.h>

#include "worked/worked_impl.h"

enum { max_roots = 8 };

static void say_places(pl_analysis* d, int i, const pl_form* const* place, int n) {
  const char* label = d->g.at[d->q.at[i].solved_by].source->name.text;
  pl_say(
      d,
      PL_BOTH(
          "Singular position {1}: there {2} does not determine {3}, the mechanism can branch, and "
          "these formulas do not hold."),
      3, pl_flist(d, place, n), pl_fn(d, label), pl_fs(d, d->q.at[i].q));
}

// With the given numbers: the places themselves.
static bool tell_at_numbers(pl_analysis* d, int i, pl_expr square) {
  pl_expr e = pl_alg_normal(d->tower, pl_with_given_numbers(d, square));
  const pl_form* place[max_roots];
  int n = 0, unknown = -1, several = 0;
  for (int k = 0; k < d->gen.n; k++) {
    if (!pl_has_symbol(d->pool, e, d->q.at[d->gen.at[k]].q)) continue;
    unknown = d->gen.at[k];
    several++;
  }
  if (several != 1) return false;
  pl_root root[max_roots];
  bool complete = false;
  int found = pl_alg_roots(d->tower, e, d->q.at[unknown].q, root, max_roots, &complete);
  for (int r = 0; r < found; r++) {
    double x = pl_number(d, root[r].value);
    if (isnan(x) && !pl_has_symbol(d->pool, e, pl_time(d->pool))) continue;  // not real
    place[n++] = pl_feq(d, pl_fs(d, d->q.at[unknown].q), pl_fe(d, root[r].value));
  }
  if (n > 0) say_places(d, i, place, n);
  return complete;
}

static bool has_all_numbers(pl_analysis* d, pl_expr e) {
  enum { max_symbols = 32 };
  pl_symbol s[max_symbols];
  int n = pl_symbols_in(d->pool, e, s, max_symbols);
  for (int k = 0; k < n && k < max_symbols; k++) {
    bool given = pl_symbol_get(d->pool, s[k])->role == PL_R_PARAM;
    if (given && isnan(pl_number(d, pl_sym(d->pool, s[k])))) return false;
  }
  return n <= max_symbols;
}

void pl_tell_singular(pl_analysis* d) {
  if (d->page->singular_told || !d->reduced) return;
  d->page->singular_told = true;
  for (int i = 0; i < d->q.n; i++) {
    pl_expr square = pl_branch_slope_squared(d, i);
    if (pl_is_poison(square) || !pl_has_coordinates(d, square)) continue;
    if (has_all_numbers(d, square)) {
      tell_at_numbers(d, i, square);
      continue;
    }
    if (pl_keeps_sign(d, square)) continue;
    pl_expr unit, rest = pl_int(d->pool, 1);
    pl_factor f[max_roots];
    int n = pl_alg_factors(d->tower, square, f, max_roots, &unit);
    for (int k = 0; k < n; k++) {
      if (f[k].power > 0 && pl_has_coordinates(d, f[k].base))
        rest = pl_mul(d->pool, rest, f[k].base);
    }
    const pl_form* place = pl_feq(d, pl_f(d, rest, PL_S_PLAIN),
                                  pl_form_leaf(d->arena, pl_int(d->pool, 0)));
    say_places(d, i, &place, 1);
  }
}
