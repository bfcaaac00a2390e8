// Linear algebra of dimensions. A dimension is a vector of rational exponents; the dimension of a
// product of powers is a linear combination, so every equation of the model is one linear equation
// between unknown vectors, and elimination finds all that follows: x² = a y² gives [a] = [x]² /
// [y]² whatever [x] and [y] turn out to be.
//
// Each unknown is free or solved. A solved one has a row: fixed exponents plus multiples of
// unknowns that were free when the row was made. Resolving puts rows in until only free unknowns
// are left. [WandOKeefe1991]
// See theory (20.1).
#include "units/units.h"

#include <string.h>

int pl_dim_var_add(pl_dim_system* s, pl_dim_var_kind kind) {
  pl_push(s->arena, s->vars, (pl_dim_var){.kind = kind});
  return s->vars.n - 1;
}

const pl_dim_form* pl_dim_fixed(pl_dim_system* s, pl_exponents d) {
  pl_dim_form* f = PL_NEW(s->arena, pl_dim_form);
  f->fixed = d;
  return f;
}

const pl_dim_form* pl_dim_unknown(pl_dim_system* s, int var) {
  pl_dim_form* f = PL_NEW(s->arena, pl_dim_form);
  f->fixed = pl_exponents_zero();
  f->n = 1;
  f->part = PL_NEW(s->arena, pl_dim_part);
  f->part[0] = (pl_dim_part){var, {1, 1}};
  return f;
}

// Merge of two sorted lists.
const pl_dim_form* pl_dim_combine(pl_dim_system* s, const pl_dim_form* a, pl_fraction f,
                                  const pl_dim_form* b) {
  pl_dim_form* c = PL_NEW(s->arena, pl_dim_form);
  c->fixed = pl_exponents_add(a->fixed, f, b->fixed);
  c->part = PL_ARRAY(s->arena, pl_dim_part, a->n + b->n);
  int i = 0, j = 0;
  while (i < a->n || j < b->n) {
    pl_dim_part next;
    if (j == b->n || (i < a->n && a->part[i].var < b->part[j].var)) {
      next = a->part[i++];
    } else if (i == a->n || b->part[j].var < a->part[i].var) {
      next = (pl_dim_part){b->part[j].var, pl_fraction_mul(f, b->part[j].f)};
      j++;
    } else {
      next = (pl_dim_part){a->part[i].var,
                           pl_fraction_add(a->part[i].f, pl_fraction_mul(f, b->part[j].f))};
      i++;
      j++;
    }
    if (next.f.num != 0 || !pl_fraction_valid(next.f)) c->part[c->n++] = next;
  }
  return c;
}

static bool is_sound(const pl_dim_form* a) {
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    if (!pl_fraction_valid(a->fixed.e[i])) return false;
  }
  for (int i = 0; i < a->n; i++) {
    if (!pl_fraction_valid(a->part[i].f)) return false;
  }
  return true;
}

static const pl_dim_form* resolve(pl_dim_system* s, const pl_dim_form* a) {
  const pl_dim_form* start = a;
  for (int i = 0; i < a->n;) {
    const pl_dim_var* v = &s->vars.at[a->part[i].var];
    if (!v->solved || !pl_fraction_valid(a->part[i].f)) {
      i++;
      continue;
    }
    // a without the unknown, plus its row
    pl_dim_form rest = *a;
    pl_fraction f = a->part[i].f;
    rest.part = PL_ARRAY(s->arena, pl_dim_part, a->n);
    memcpy(rest.part, a->part, (size_t)i * sizeof *a->part);
    memcpy(rest.part + i, a->part + i + 1, (size_t)(a->n - i - 1) * sizeof *a->part);
    rest.n--;
    a = pl_dim_combine(s, &rest, f, v->row);
    i = 0;
  }
  // one unknown alone: keep the shortened row for the next time
  if (start->n == 1 && start != a && start->part[0].f.num == 1 && start->part[0].f.den == 1
      && pl_exponents_are_zero(start->fixed)) {
    s->vars.at[start->part[0].var].row = a;
  }
  return a;
}

// Which unknown an equation settles: a bare number first, then the one met last; the energy stays
// as long as it can.
static int pivot_of(const pl_dim_system* s, const pl_dim_form* d) {
  int best = -1, rank = -1;
  for (int i = 0; i < d->n; i++) {
    pl_dim_var_kind kind = s->vars.at[d->part[i].var].kind;
    int r = kind == PL_DIM_NUMBER ? 2 : kind == PL_DIM_SYMBOL ? 1 : 0;
    if (r >= rank) {
      best = i;
      rank = r;
    }
  }
  return best;
}

bool pl_dim_unify(pl_dim_system* s, const pl_dim_form* a, const pl_dim_form* b, pl_span reason) {
  const pl_dim_form* d = resolve(s, pl_dim_combine(s, a, (pl_fraction){-1, 1}, b));
  if (!is_sound(d)) return true;  // exponents beyond any physics: nothing can be said
  if (d->n == 0) return pl_exponents_are_zero(d->fixed);

  // d = rest + f v = 0, so v = -rest / f
  int k = pivot_of(s, d);
  pl_fraction f = d->part[k].f;
  int var = d->part[k].var;
  pl_dim_form* rest = PL_NEW(s->arena, pl_dim_form);
  rest->fixed = d->fixed;
  rest->part = PL_ARRAY(s->arena, pl_dim_part, d->n);
  for (int i = 0; i < d->n; i++) {
    if (i != k) rest->part[rest->n++] = d->part[i];
  }
  pl_dim_form zero = {.fixed = pl_exponents_zero()};
  const pl_dim_form* row = pl_dim_combine(s, &zero, pl_fraction_div((pl_fraction){-1, 1}, f), rest);
  if (!is_sound(row)) return true;
  pl_dim_var* v = &s->vars.at[var];
  v->solved = true;
  v->row = v->first = row;
  v->reason = reason;
  return true;
}

bool pl_dim_known(pl_dim_system* s, const pl_dim_form* a, pl_dimension* out) {
  const pl_dim_form* d = resolve(s, a);
  return d->n == 0 && pl_exponents_get_dimension(d->fixed, out);
}
