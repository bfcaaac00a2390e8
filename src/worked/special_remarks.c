// special_remarks: given numbers that are a special case, and what loses its meaning at the start.
#include "worked/worked_impl.h"

void pl_say_special(pl_analysis* d) {
  if (d->special.n == 0) return;
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->special.n);
  for (int k = 0; k < d->special.n; k++)
    f[k] = pl_feq(d, pl_fs(d, d->special.at[k].from), pl_f(d, d->special.at[k].to, PL_S_QUOTIENT));
  pl_say(
      d,
      PL_BOTH(
          "The given numbers are a special case, {1}, for which the general result does not hold. "
          "In this case:"),
      1, pl_flist(d, f, d->special.n));
}

void pl_tell_cases(pl_analysis* d) {
  if (d->cases.n == 0 || d->page->cases_told) return;
  d->page->cases_told = true;
  const pl_form** f = PL_ARRAY(d->arena, const pl_form*, d->cases.n);
  for (int k = 0; k < d->cases.n; k++)
    f[k] = pl_feq(d, pl_fs(d, d->cases.at[k].from), pl_f(d, d->cases.at[k].to, PL_S_QUOTIENT));
  pl_say(d,
         PL_BOTH("The given numbers are a special case, {1}; everything here holds for this case."),
         1, pl_flist(d, f, d->cases.n));
}

void pl_say_pole(pl_analysis* d, pl_expr e) {
  pl_expr base;
  if (!pl_pole_at_numbers(d, e, &base)) return;
  pl_say(d, PL_BOTH("For the given numbers {1} is 0: the formula has no value there."), 1,
         pl_f(d, base, PL_S_PLAIN));
}

void pl_say_rank_at_start(pl_analysis* d) {
  int m = 0, rank = pl_rank_at_start(d, &m);
  if (rank < 0 || rank == m) return;
  pl_say(
      d,
      pl_format(d->arena,
                "This counts at a general position. At the start the constraints lose rank: of "
                "%d gradients %d %s independent there.",
                m, rank, rank == 1 ? "is" : "are"),
      pl_format(
          d->arena,
          pl_german("This counts at a general position. At the start the constraints lose rank: of "
                    "%d gradients %d %s independent there."),
          m, rank, pl_german(rank == 1 ? "is" : "are")),
      0);
}

void pl_say_pole_at_start(pl_analysis* d, const pl_form* name, pl_expr e) {
  if (!pl_divides_by_zero_at_start(d, e)) return;
  pl_say(d, PL_BOTH("At the start the denominator vanishes: {1} has no value there."), 1, name);
}
