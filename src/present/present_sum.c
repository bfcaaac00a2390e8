// Sums of products: the order of terms and the brackets made from them.
//
// Terms stand in the order accelerations, velocities, rest; then as their factors do (K5). When the
// first term would carry a minus, the first positive terms go in front: 3 cos ϑ - 2, x2 - x1, m g
// cos ϑ - m R ϑ'².
#include "present/present_impl.h"

#include <stdlib.h>
#include <string.h>

int pl_prod_motion(pl_present_search* s, pl_prod x) {
  int accelerations = 0, velocities = 0;
  for (int i = 0; i < x.n; i++) {
    if (x.at[i].bucket == PL_K_ACCELERATION) accelerations += abs(x.at[i].power);
    if (x.at[i].bucket == PL_K_VELOCITY) velocities += abs(x.at[i].power);
  }
  return accelerations * 100 + velocities;
}

static int compare_piece(pl_present_search* s, const pl_piece* x, const pl_piece* y) {
  int c = pl_piece_compare(s, x, y);
  return c ? c : (x->power < y->power) - (x->power > y->power);
}

int pl_terms_compare(pl_present_search* s, const pl_prod* x, const pl_prod* y) {
  int mx = pl_prod_motion(s, *x), my = pl_prod_motion(s, *y);
  if (mx != my) return mx > my ? -1 : 1;
  // what stands above the line decides
  int i = 0, k = 0;
  for (;; i++, k++) {
    while (i < x->n && x->at[i].power < 0) i++;
    while (k < y->n && y->at[k].power < 0) k++;
    if (i >= x->n || k >= y->n) break;
    int c = compare_piece(s, &x->at[i], &y->at[k]);
    if (c) return c;
  }
  if ((i < x->n) != (k < y->n)) return i < x->n ? 1 : -1;
  for (i = 0; i < x->n && i < y->n; i++) {
    int c = compare_piece(s, &x->at[i], &y->at[i]);
    if (c) return c;
  }
  return (x->n > y->n) - (x->n < y->n);
}

// The first run of positive terms to the front, if the sum begins with a minus.
static void positive_first(pl_present_search* s, pl_prod* terms, int n) {
  int begin = 0;
  while (begin < n && pl_prod_is_negative(s, terms[begin])) begin++;
  if (begin == 0 || begin == n) return;
  int end = begin;
  while (end < n && !pl_prod_is_negative(s, terms[end])) end++;
  pl_prod* old = PL_ARRAY(s->a, pl_prod, begin);
  memcpy(old, terms, (size_t)begin * sizeof *old);
  memmove(terms, terms + begin, (size_t)(end - begin) * sizeof *terms);
  memcpy(terms + (end - begin), old, (size_t)begin * sizeof *old);
}

void pl_terms_sort(pl_present_search* s, pl_prod* terms, int n) {
  // insertion keeps equal terms in place, and sums on paper are short
  for (int i = 1; i < n; i++) {
    pl_prod x = terms[i];
    int k = i;
    for (; k > 0 && pl_terms_compare(s, &x, &terms[k - 1]) < 0; k--) terms[k] = terms[k - 1];
    terms[k] = x;
  }
  positive_first(s, terms, n);
}

const pl_form* pl_terms_form(pl_present_search* s, const pl_prod* terms, int n) {
  if (n == 0) return pl_form_leaf(s->a, pl_int(s->p, 0));
  // the terms of one sum agree on where their fractions stand
  bool first = false;
  for (int i = 0; i < n; i++) first |= pl_prod_wants_fraction_first(s, terms[i]);
  const pl_form** f = PL_ARRAY(s->a, const pl_form*, n);
  for (int i = 0; i < n; i++) f[i] = pl_prod_form_with(s, terms[i], first);
  return n == 1 ? f[0] : pl_form_sum(s->a, f, n);
}

const pl_form* pl_piece_base(pl_present_search* s, const pl_piece* piece) {
  const pl_sum_terms* sum = piece->sum;
  if (!sum || sum->form != piece->base || sum->form->n > 0) return piece->base;
  *sum->form = *pl_terms_form(s, sum->at, sum->n);
  return sum->form;
}

// ---------------------------------------------------------------------------------------- brackets
typedef struct sum_census {
  bool mass, motion, coord, function;
  unsigned buckets;
} sum_census;

static void count_pieces(pl_present_search* s, pl_prod x, sum_census* c) {
  for (int i = 0; i < x.n; i++) {
    const pl_piece* f = &x.at[i];
    if (f->sum) {
      for (int k = 0; k < f->sum->n; k++) count_pieces(s, f->sum->at[k], c);
      continue;
    }
    c->mass |= f->bucket == PL_K_MASS;
    c->motion |= f->bucket == PL_K_VELOCITY || f->bucket == PL_K_ACCELERATION
                 || f->bucket == PL_K_MULTIPLIER;
    c->coord |= f->bucket >= PL_K_START;
    c->function |= f->bucket == PL_K_FUNCTION || f->bucket == PL_K_ROOT;
    c->buckets |= 1u << f->bucket;
  }
}

// Where a bracket stands among the factors: (m1 + m2) with the masses, (m1 + m2 sin²θ) before what
// it multiplies, (l0 + x) with the coordinates, the rest last.
static pl_bucket bucket_of_sum(pl_present_search* s, const pl_prod* terms, int n) {
  sum_census c = {0};
  for (int i = 0; i < n; i++) count_pieces(s, terms[i], &c);
  if (c.motion) return PL_K_SUM;
  if (c.coord && c.mass) return PL_K_INERTIA;
  if (c.coord) return c.function ? PL_K_SUM : PL_K_COORD;
  static const pl_bucket pure[] = {PL_K_NUMBER, PL_K_MASS, PL_K_GRAVITY, PL_K_LENGTH};
  for (size_t i = 0; i < sizeof pure / sizeof *pure; i++)
    if ((c.buckets & ~(1u << pure[i])) == 0) return pure[i];
  return PL_K_PARAM_SUM;
}

static pl_symbol lead_of(const pl_prod* terms, int n) {
  for (int i = 0; i < n; i++)
    for (int k = 0; k < terms[i].n; k++)
      if (terms[i].at[k].lead.id) return terms[i].at[k].lead;
  return (pl_symbol){0};
}

pl_prod pl_prod_bracket(pl_present_search* s, const pl_prod* given, int n) {
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, n);
  memcpy(terms, given, (size_t)n * sizeof *terms);
  pl_terms_sort(s, terms, n);
  pl_sum_terms* sum = PL_NEW(s->a, pl_sum_terms);
  sum->n = n;
  sum->at = terms;
  sum->form = pl_form_make(s->a, PL_F_SUM, 0, NULL);
  pl_piece piece = {.gen = -1,
                    .power = 1,
                    .sum = sum,
                    .bucket = bucket_of_sum(s, terms, n),
                    .lead = lead_of(terms, n)};
  piece.base = sum->form;
  for (int i = 0; i < n; i++) piece.cost += terms[i].cost + 2;
  // a minus between two terms costs nothing, only a leading one does
  for (int i = 1; i < n; i++) piece.cost -= pl_prod_is_negative(s, terms[i]);
  return pl_prod_piece(s, piece, 1);
}

// 0.5 m, (2 kg) (3 m/s²): numbers with units and nothing else.
static bool is_measured_number(pl_present_search* s, const pl_prod* x) {
  for (int i = 0; i < x->n; i++) {
    pl_symbol lead = x->at[i].lead;
    if (x->at[i].sum || !lead.id || pl_is_poison(pl_symbol_get(s->p, lead)->number)) return false;
  }
  return x->n > 0;
}

// The term that comes first by K5, before any minus is avoided: w - 0.5 m begins with w.
static int leading_term(pl_present_search* s, const pl_prod* terms, int n) {
  int first = 0;
  for (int i = 1; i < n; i++) {
    bool number = is_measured_number(s, &terms[i]),
         first_number = is_measured_number(s, &terms[first]);
    if (number == first_number ? pl_terms_compare(s, &terms[i], &terms[first]) < 0 : first_number)
      first = i;
  }
  return first;
}

pl_prod pl_prod_sum(pl_present_search* s, const pl_prod* given, int n) {
  if (n == 0) return pl_prod_number(s, pl_int(s->p, 0));
  if (n == 1) return given[0];
  if (!pl_prod_is_negative(s, given[leading_term(s, given, n)]))
    return pl_prod_bracket(s, given, n);
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, n);
  for (int i = 0; i < n; i++) terms[i] = pl_prod_neg(s, given[i]);
  return pl_prod_neg(s, pl_prod_bracket(s, terms, n));
}

// Plain numbers come from several terms: 2 sin²a is 1 - cos(2 a).  They are one term, or none.
void pl_terms_add(pl_present_search* s, pl_prod x, pl_prod* terms, int* n) {
  for (int i = 0; x.n == 0 && i < *n; i++) {
    if (terms[i].n != 0) continue;
    pl_expr sum = pl_add(s->p, terms[i].unit, x.unit);
    if (pl_is_zero_node(s->p, sum)) terms[i] = terms[--*n];
    else terms[i] = pl_prod_number(s, sum);
    return;
  }
  terms[(*n)++] = x;
}

void pl_terms_put(pl_present_search* s, pl_prod x, pl_prod* terms, int* n) {
  bool bare = x.n == 1 && x.at[0].sum && x.at[0].power == 1 && x.at[0].sum->n <= PL_OPENED_TERMS;
  bool one = pl_is_one_node(s->p, x.unit), minus_one = pl_is_one_node(s->p, pl_neg(s->p, x.unit));
  if (!bare || (!one && !minus_one)) {
    pl_terms_add(s, x, terms, n);
    return;
  }
  for (int i = 0; i < x.at[0].sum->n; i++) {
    pl_prod y = x.at[0].sum->at[i];
    pl_terms_add(s, one ? y : pl_prod_neg(s, y), terms, n);
  }
}
