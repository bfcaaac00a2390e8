// Bounds of a polynomial over all angles. The coefficient of each monomial in the other generators
// is a trigonometric polynomial; as a Fourier sum a_0 + sum_k a_k e^(ikθ) it lies between a_0 - sum
// |a_k| and a_0 + sum |a_k|. So m1 + m2 sin^2(a - b), expanded into sines and cosines of a and b,
// is seen to be at least m1.
//
// Coefficients are exact integers over a common power of 2 (each sine and cosine halves); whatever
// would not fit gives up.
// See theory (19.5).
#include "algebra/tower.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  PL_MAX_WAVE_PAIRS = 7,
  PL_MAX_WAVE_TERMS = 1024,
  PL_MAX_WAVE_DEGREE = 12,
  PL_MAX_WAVE_BITS = 36,
  PL_MAX_BOUND_TERMS = 400
};  // 36 bits, 12 for the degree and 9 for the sum of the terms fit into 62

typedef struct pl_harmonic {
  int k[PL_MAX_WAVE_PAIRS];
  long re, im;
} pl_harmonic;

typedef struct pl_fourier {
  int pair[PL_MAX_WAVE_PAIRS], n_pairs;  // the cosines
  int degree;                            // everything is over 2^degree
  int n;
  pl_harmonic at[PL_MAX_WAVE_TERMS];
} pl_fourier;

// ---------------------------------------------------------------------------------------- one term
static bool add_harmonic(pl_fourier* f, const pl_harmonic* h) {
  for (int i = 0; i < f->n; i++) {
    if (memcmp(f->at[i].k, h->k, sizeof h->k) != 0) continue;
    f->at[i].re += h->re;
    f->at[i].im += h->im;
    return true;
  }
  if (f->n == PL_MAX_WAVE_TERMS) return false;
  f->at[f->n++] = *h;
  return true;
}

// Adds h times the remaining sines and cosines: 2 cos = z + 1/z, 2 sin = -i z + i/z.
static bool expand(pl_fourier* f, pl_harmonic h, const int* cosines, const int* sines, int pair) {
  while (pair < f->n_pairs && cosines[pair] == 0 && sines[pair] == 0) pair++;
  if (pair == f->n_pairs) return add_harmonic(f, &h);
  int c[PL_MAX_WAVE_PAIRS], s[PL_MAX_WAVE_PAIRS];
  memcpy(c, cosines, sizeof c);
  memcpy(s, sines, sizeof s);
  bool sine = s[pair] > 0;
  if (sine) s[pair]--;
  else c[pair]--;
  pl_harmonic up = h, down = h;
  up.k[pair]++;
  down.k[pair]--;
  if (sine) {
    up.re = h.im;
    up.im = -h.re;
    down.re = -h.im;
    down.im = h.re;
  }
  return expand(f, up, c, s, pair) && expand(f, down, c, s, pair);
}

static int pair_of(const pl_fourier* f, int cosine) {
  for (int i = 0; i < f->n_pairs; i++) {
    if (f->pair[i] == cosine) return i;
  }
  return -1;
}

// Exponents of a term split into those of cosines and sines; the rest stays in `exponent`.
static int take_waves(pl_tower* t, const pl_fourier* f, ulong* exponent, int* cosines, int* sines) {
  int degree = 0;
  memset(cosines, 0, PL_MAX_WAVE_PAIRS * sizeof *cosines);
  memset(sines, 0, PL_MAX_WAVE_PAIRS * sizeof *sines);
  for (int g = 0; g < t->gens.n; g++) {
    const pl_gen* gen = &t->gens.at[g];
    if (exponent[g] == 0 || (gen->kind != PL_G_COS && gen->kind != PL_G_SIN)) continue;
    bool sine = gen->kind == PL_G_SIN;
    int p = pair_of(f, sine ? gen->partner : g);
    (sine ? sines : cosines)[p] = (int)exponent[g];
    degree += (int)exponent[g];
    exponent[g] = 0;
  }
  return degree;
}

// Pairs that occur, and the highest degree; false when there are too many.
static bool survey(pl_tower* t, const pl_poly* a, pl_fourier* f) {
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < a->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, a, i, &t->ctx);
    ulong degree = 0;
    for (int g = 0; g < t->gens.n; g++) {
      const pl_gen* gen = &t->gens.at[g];
      if (exponent[g] == 0 || (gen->kind != PL_G_COS && gen->kind != PL_G_SIN)) continue;
      degree += exponent[g];
      int cosine = gen->kind == PL_G_SIN ? gen->partner : g;
      if (pair_of(f, cosine) >= 0) continue;
      if (f->n_pairs == PL_MAX_WAVE_PAIRS) return false;
      f->pair[f->n_pairs++] = cosine;
    }
    if (degree > PL_MAX_WAVE_DEGREE) return false;
    if ((int)degree > f->degree) f->degree = (int)degree;
    if (fmpz_bits(&a->coeffs[i]) > PL_MAX_WAVE_BITS) return false;
  }
  return f->n_pairs > 0;
}

// ------------------------------------------------------------------------------------ one monomial
// Is the monomial, which has no sines, at least 0?  1 yes, -1 at most 0, 0 open.
static int monomial_sign(pl_tower* t, const ulong* exponent) {
  int sign = 1;
  for (int g = 0; g < t->gens.n; g++) {
    if (exponent[g] % 2 == 0) continue;
    int s = t->gens.at[g].sign;
    if (s == 0) return 0;
    if (s < 0) sign = -sign;
  }
  return sign;
}

static long amplitude(const pl_harmonic* h) {
  if (h->im == 0) return labs(h->re);
  if (h->re == 0) return labs(h->im);
  return (long)ceil(hypot((double)h->re, (double)h->im) * (1 + 1e-12)) + 1;
}

static void bounds_of(const pl_fourier* f, long* low, long* high) {
  static const int zero[PL_MAX_WAVE_PAIRS] = {0};
  long middle = 0, swing = 0;
  for (int i = 0; i < f->n; i++) {
    if (memcmp(f->at[i].k, zero, sizeof zero) == 0) middle += f->at[i].re;
    else swing += amplitude(&f->at[i]);
  }
  *low = middle - swing;
  *high = middle + swing;
}

static bool same_monomial(pl_tower* t, const ulong* a, const ulong* b) {
  return memcmp(a, b, (size_t)t->gens.n * sizeof *a) == 0;
}

// Fourier sum of the coefficient of the monomial of term i; terms that belong to it are marked.
static bool collect_monomial(pl_tower* t, const pl_poly* a, slong i, pl_fourier* f, bool* done,
                             ulong* monomial) {
  int cosines[PL_MAX_WAVE_PAIRS], sines[PL_MAX_WAVE_PAIRS];
  f->n = 0;
  fmpz_mpoly_get_term_exp_ui(monomial, a, i, &t->ctx);
  take_waves(t, f, monomial, cosines, sines);
  for (slong j = i; j < a->length; j++) {
    ulong exponent[PL_MAX_GENERATORS];
    fmpz_mpoly_get_term_exp_ui(exponent, a, j, &t->ctx);
    int degree = take_waves(t, f, exponent, cosines, sines);
    if (!same_monomial(t, monomial, exponent)) continue;
    done[j] = true;
    pl_harmonic h = {.re = fmpz_get_si(&a->coeffs[j]) * (1L << (f->degree - degree))};
    if (!expand(f, h, cosines, sines, 0)) return false;
  }
  return true;
}

static const pl_poly* add_term(pl_tower* t, const pl_poly* sum, const ulong* monomial, long c) {
  pl_poly* term = pl_poly_new(t);
  fmpz_mpoly_set_coeff_si_ui(term, c, monomial, &t->ctx);
  return pl_poly_add(t, sum, term);
}

bool pl_poly_trig_bounds(pl_tower* t, const pl_poly* a, const pl_poly** low, const pl_poly** high) {
  pl_fourier* f = PL_NEW(t->arena, pl_fourier);
  if (a->length > PL_MAX_BOUND_TERMS || !survey(t, a, f)) return false;
  bool* done = PL_ARRAY(t->arena, bool, a->length);
  *low = *high = pl_poly_int(t, 0);
  for (slong i = 0; i < a->length; i++) {
    if (done[i]) continue;
    ulong monomial[PL_MAX_GENERATORS] = {0};
    if (!collect_monomial(t, a, i, f, done, monomial)) return false;
    long lo, hi;
    bounds_of(f, &lo, &hi);
    int sign = lo == hi ? 1 : monomial_sign(t, monomial);
    if (sign == 0) return false;
    *low = add_term(t, *low, monomial, sign > 0 ? lo : hi);
    *high = add_term(t, *high, monomial, sign > 0 ? hi : lo);
  }
  return true;
}
