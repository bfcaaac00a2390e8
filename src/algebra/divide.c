// Division modulo the relations: 1 - c^2 is divisible by s, and q1^2 + q2^2 - 2 q1 q2 (c1 c2 + s1
// s2) may be a factor that a product no longer shows once its s1^2 s2^2 have been rewritten.
//
// a/b = a b'/(b b') with the conjugate b' = c0 - c1 g of b = c0 + c1 g, relation after relation,
// newest first; the last divisor is free of them, and division in the free ring decides. Most
// candidates are no factors, which one look modulo a prime along a line shows.
#include "algebra/tower.h"

#if __has_include(<flint/nmod.h>)
#  include <flint/nmod.h>
#else
#  include <flint/nmod_vec.h>
#endif
#include <flint/nmod_poly.h>

static const ulong prime = 2147483647;  // 3 modulo 4: roots are powers

// ------------------------------------------------------------------------------------ along a line
static bool is_free(const pl_tower* t, int g) {
  const pl_gen* gen = &t->gens.at[g];
  return gen->degree == 0 && gen->partner < 0;
}

// Of b: a generator without relation, of lowest degree; -1 none.
static int line_of(pl_tower* t, const pl_poly* b) {
  long degree[PL_MAX_GENERATORS];
  int best = -1;
  pl_poly_degrees(t, b, degree);
  for (int g = 0; g < t->gens.n; g++)
    if (degree[g] > 0 && is_free(t, g) && (best < 0 || degree[g] < degree[best])) best = g;
  return best;
}

// a along the line: all generators but x have their values.
static void on_line(pl_tower* t, nmod_poly_t out, const pl_poly* a, int x, const ulong* value) {
  ulong exponent[PL_MAX_GENERATORS];
  nmod_t mod;
  nmod_init(&mod, prime);
  nmod_poly_zero(out);
  for (slong i = 0; i < a->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, a, i, &t->ctx);
    ulong c = fmpz_fdiv_ui(&a->coeffs[i], prime);
    for (int g = 0; g < t->gens.n; g++)
      if (exponent[g] && g != x) c = nmod_mul(c, nmod_pow_ui(value[g], exponent[g], mod), mod);
    slong at = (slong)exponent[x];
    nmod_poly_set_coeff_ui(out, at, nmod_add(nmod_poly_get_coeff_ui(out, at), c, mod));
  }
}

static ulong drawn(int g, int attempt) {
  uint64_t h = pl_hash_mix(UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)attempt, (uint64_t)g + 1);
  return 2 + (ulong)(h % (prime - 3));
}

// A root of the value of the relation at what is known so far; 0 where there is none.
static ulong root_of(pl_tower* t, const pl_poly* square, int x, const ulong* value) {
  nmod_t mod;
  nmod_init(&mod, prime);
  if (pl_poly_degree(t, square, x) > 0) return 0;  // it moves along the line
  nmod_poly_t p;
  nmod_poly_init(p, prime);
  on_line(t, p, square, x, value);
  ulong y = nmod_poly_get_coeff_ui(p, 0), w = nmod_pow_ui(y, (prime + 1) / 4, mod);
  nmod_poly_clear(p);
  return nmod_mul(w, w, mod) == y ? w : 0;
}

// Values that meet all relations; false where that was not found.
static bool draw_point(pl_tower* t, const long* used, int x, ulong* value) {
  enum { TRIES = 12 };
  for (int g = 0; g < t->gens.n; g++) {
    const pl_gen* gen = &t->gens.at[g];
    value[g] = drawn(g, 0);
    if (gen->degree == 0 || !used[g]) continue;
    if (gen->degree != 2) return false;
    value[g] = 0;
    for (int k = 1; k <= TRIES && value[g] == 0; k++) {
      value[g] = root_of(t, gen->value, x, value);
      if (value[g] == 0 && gen->partner >= 0 && gen->partner < g)
        value[gen->partner] = drawn(gen->partner, k);
    }
    if (value[g] == 0) return false;
  }
  return true;
}

// Whether b does not divide a along a line modulo the prime, and so not at all.
static bool refuted(pl_tower* t, const pl_poly* a, const pl_poly* b) {
  long used[PL_MAX_GENERATORS], of_b[PL_MAX_GENERATORS];
  ulong value[PL_MAX_GENERATORS];
  int x = line_of(t, b);
  if (x < 0) return false;
  pl_poly_degrees(t, a, used);
  pl_poly_degrees(t, b, of_b);
  if (used[x] < of_b[x]) return true;
  for (int g = 0; g < t->gens.n; g++) used[g] += of_b[g];
  if (!draw_point(t, used, x, value)) return false;
  nmod_poly_t top, below;
  nmod_poly_init(top, prime);
  nmod_poly_init(below, prime);
  on_line(t, top, a, x, value);
  on_line(t, below, b, x, value);
  bool degenerate = nmod_poly_degree(below) < of_b[x];
  if (!degenerate) nmod_poly_rem(top, top, below);
  bool rest = !degenerate && !nmod_poly_is_zero(top);
  nmod_poly_clear(top);
  nmod_poly_clear(below);
  return rest;
}

// ----------------------------------------------------------------------------------- by conjugates
// The newest square relation whose generator occurs; -1 none, -2 a relation of another degree.
static int newest_relation(const pl_tower* t, const pl_poly* a) {
  long degree[PL_MAX_GENERATORS];
  pl_poly_degrees(t, a, degree);
  for (int g = t->gens.n - 1; g >= 0; g--) {
    if (degree[g] > 0 && t->gens.at[g].degree > 0)
      return t->gens.at[g].degree == 2 && degree[g] == 1 ? g : -2;
  }
  return -1;
}

bool pl_poly_divides_reduced(pl_tower* t, const pl_poly** q, const pl_poly* a, const pl_poly* b) {
  if (newest_relation(t, b) < 0 || refuted(t, a, b)) return false;
  for (int g; (g = newest_relation(t, b)) != -1;) {
    int d = 0;
    if (g < 0 || a->length * b->length > PL_MAX_CONJUGATE) return false;
    const pl_poly** c = pl_poly_coefficients(t, b, g, &d);
    const pl_poly* conjugate = pl_poly_sub(t, c[0], pl_poly_mul_free(t, c[1], pl_poly_gen(t, g)));
    a = pl_poly_mul(t, a, conjugate);
    b = pl_poly_mul(t, b, conjugate);
  }
  return pl_poly_divides(t, q, a, b);
}
