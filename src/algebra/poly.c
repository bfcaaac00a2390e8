// Polynomials of the tower: arithmetic in the quotient ring, views of the trigonometric pairs,
// greatest common divisors in compact contexts. Needs a running service (the results stand on its
// stack).
//
// Reduced means: degree in s below 2 for every sine, in w below 2 for every square root. The
// relations are taken newest first, since the value of a root may contain older generators but
// never newer ones.
#include "algebra/tower.h"

#include <string.h>

const pl_poly* pl_poly_int(pl_tower* t, long c) {
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_set_si(f, c, &t->ctx);
  return f;
}

const pl_poly* pl_poly_fmpz(pl_tower* t, const fmpz* c) {
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_set_fmpz(f, c, &t->ctx);
  return f;
}

const pl_poly* pl_poly_gen(pl_tower* t, int gen) {
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_gen(f, gen, &t->ctx);
  return f;
}

const pl_poly* pl_poly_gen_power(pl_tower* t, int gen, long power) {
  ulong exponent[PL_MAX_GENERATORS] = {0};
  exponent[gen] = (ulong)power;
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_set_coeff_si_ui(f, 1, exponent, &t->ctx);
  return f;
}

const pl_poly* pl_poly_add(pl_tower* t, const pl_poly* a, const pl_poly* b) {
  if (a->length + b->length > PL_MAX_TERMS) pl_tower_give_up(t);
  pl_tower_charge(t, PL_WORK_OF_SUM + a->length + b->length);
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_add(f, a, b, &t->ctx);
  return f;
}

const pl_poly* pl_poly_sub(pl_tower* t, const pl_poly* a, const pl_poly* b) {
  if (a->length + b->length > PL_MAX_TERMS) pl_tower_give_up(t);
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_sub(f, a, b, &t->ctx);
  return f;
}

const pl_poly* pl_poly_neg(pl_tower* t, const pl_poly* a) {
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_neg(f, a, &t->ctx);
  return f;
}

const pl_poly* pl_poly_scale(pl_tower* t, const pl_poly* a, const fmpz* c) {
  if (fmpz_is_one(c)) return a;
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_scalar_mul_fmpz(f, a, c, &t->ctx);
  return f;
}

const pl_poly* pl_poly_scale_down(pl_tower* t, const pl_poly* a, const fmpz* c) {
  if (fmpz_is_one(c)) return a;
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_scalar_divexact_fmpz(f, a, c, &t->ctx);
  return f;
}

const pl_poly* pl_poly_mul_free(pl_tower* t, const pl_poly* a, const pl_poly* b) {
  if (pl_poly_is_one(t, a)) return b;
  if (pl_poly_is_one(t, b)) return a;
  if (a->length > 0 && b->length > PL_MAX_PRODUCT / a->length) pl_tower_give_up(t);
  if (a->length > 1000 || b->length > 1000) pl_tower_check(t);
  pl_tower_charge(t, PL_WORK_OF_PRODUCT + a->length * b->length);
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_mul(f, a, b, &t->ctx);
  if (f->length > PL_MAX_TERMS) pl_tower_give_up(t);
  return f;
}

const pl_poly* pl_poly_mul(pl_tower* t, const pl_poly* a, const pl_poly* b) {
  return pl_poly_reduce(t, pl_poly_mul_free(t, a, b));
}

const pl_poly* pl_poly_pow(pl_tower* t, const pl_poly* a, long n) {
  if (n < 0 || (n > PL_MAX_POWER && a->length > 1) || n > PL_MAX_DEGREE) pl_tower_give_up(t);
  const pl_poly* f = pl_poly_int(t, 1);
  const pl_poly* square = a;
  for (; n > 0; n >>= 1) {
    if (n & 1) f = pl_poly_mul(t, f, square);
    if (n > 1) square = pl_poly_mul(t, square, square);
  }
  return f;
}

bool pl_poly_is_zero(const pl_tower* t, const pl_poly* a) { return fmpz_mpoly_is_zero(a, &t->ctx); }

bool pl_poly_is_one(const pl_tower* t, const pl_poly* a) { return fmpz_mpoly_is_one(a, &t->ctx); }

bool pl_poly_is_number(const pl_tower* t, const pl_poly* a) {
  return fmpz_mpoly_is_fmpz(a, &t->ctx);
}

bool pl_poly_equal(const pl_tower* t, const pl_poly* a, const pl_poly* b) {
  return fmpz_mpoly_equal(a, b, &t->ctx);
}

long pl_poly_terms(const pl_poly* a) { return a->length; }

uint64_t pl_poly_hash(pl_tower* t, const pl_poly* a) {
  uint64_t h = 0x9e3779b97f4a7c15u;
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < a->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, a, i, &t->ctx);
    // the exponents may be packed in fields of any width, so they are hashed unpacked
    for (int g = 0; g < t->gens.n; g++) {
      if (exponent[g]) h = pl_hash_mix(h, exponent[g] * 1021u + (uint64_t)g);
    }
    h = pl_hash_mix(h, fmpz_fdiv_ui(&a->coeffs[i], 2305843009213693951u));
  }
  return h | 1;
}

void pl_poly_degrees(const pl_tower* t, const pl_poly* a, long* degree) {
  if (a->length == 0) {
    memset(degree, 0, (size_t)t->capacity * sizeof *degree);
    return;
  }
  fmpz_mpoly_degrees_si(degree, a, &t->ctx);
}

long pl_poly_degree(const pl_tower* t, const pl_poly* a, int gen) {
  return a->length == 0 ? 0 : fmpz_mpoly_degree_si(a, gen, &t->ctx);
}

void pl_poly_content(pl_tower* t, fmpz* c, const pl_poly* a) {
  _fmpz_vec_content(c, a->coeffs, a->length);
}

// --------------------------------------------------------------------------------------- relations
const pl_poly** pl_poly_coefficients(pl_tower* t, const pl_poly* a, int gen, int* degree) {
  long d = pl_poly_degree(t, a, gen);
  if (d > PL_MAX_DEGREE) pl_tower_give_up(t);
  const pl_poly** c = PL_ARRAY(t->arena, const pl_poly*, d + 1);
  pl_poly** out = PL_ARRAY(t->arena, pl_poly*, d + 1);
  for (long i = 0; i <= d; i++) c[i] = out[i] = pl_poly_new(t);
  // from here on nothing allocates in the arena, so nothing of FLINT's is left behind when memory
  // runs out
  fmpz_mpoly_univar_t u;
  fmpz_mpoly_univar_init(u, &t->ctx);
  fmpz_mpoly_to_univar(u, a, gen, &t->ctx);
  slong n = fmpz_mpoly_univar_length(u, &t->ctx);
  for (slong i = 0; i < n; i++) {
    slong k = fmpz_mpoly_univar_get_term_exp_si(u, i, &t->ctx);
    fmpz_mpoly_univar_swap_term_coeff(out[k], u, i, &t->ctx);
  }
  fmpz_mpoly_univar_clear(u, &t->ctx);
  *degree = (int)d;
  return c;
}

// gen^degree -> value: sum_k c_k gen^k = sum_r gen^r sum_m c_{degree m + r} value^m, the inner sums
// by Horner.
const pl_poly* pl_poly_eliminate(pl_tower* t, const pl_poly* a, int gen, int degree,
                                 const pl_poly* value) {
  int d = 0;
  const pl_poly** c = pl_poly_coefficients(t, a, gen, &d);
  if (d < degree) return a;
  const pl_poly* f = pl_poly_int(t, 0);
  for (int r = 0; r < degree; r++) {
    const pl_poly* sum = pl_poly_int(t, 0);
    for (int k = d - (d - r) % degree; k >= r; k -= degree) {
      sum = pl_poly_add(t, pl_poly_mul_free(t, sum, value), c[k]);
    }
    f = pl_poly_add(t, f, r == 0 ? sum : pl_poly_mul_free(t, sum, pl_poly_gen_power(t, gen, r)));
  }
  return f;
}

const pl_poly* pl_poly_reduce(pl_tower* t, const pl_poly* a) {
  if (a->length == 0) return a;
  long degree[PL_MAX_GENERATORS];
  pl_poly_degrees(t, a, degree);
  for (int g = t->gens.n - 1; g >= 0; g--) {
    const pl_gen* gen = &t->gens.at[g];
    if (gen->degree == 0 || degree[g] < gen->degree) continue;
    a = pl_poly_eliminate(t, a, g, gen->degree, gen->value);
    pl_poly_degrees(t, a, degree);
  }
  return a;
}

const pl_poly* pl_poly_view(pl_tower* t, const pl_poly* a, int gen) {
  const pl_gen* g = &t->gens.at[gen];
  if (g->partner < 0 || pl_poly_degree(t, a, gen) < 2) return a;
  const pl_poly* square = pl_poly_gen_power(t, g->partner, 2);
  const pl_poly* one = pl_poly_int(t, 1);
  // c^2 = 1 - s^2,  S^2 = C^2 - 1
  const pl_poly* value = g->kind == PL_G_COS ? pl_poly_sub(t, one, square)
                                             : pl_poly_sub(t, square, one);
  return pl_poly_eliminate(t, a, gen, 2, value);
}

const pl_poly* pl_poly_shortest_view(pl_tower* t, const pl_poly* a) {
  pl_tower_order(t);
  for (int k = 0; k < t->gens.n; k++) {
    int g = t->by_rank[k];
    pl_gen_kind kind = t->gens.at[g].kind;
    if ((kind != PL_G_COS && kind != PL_G_SINH) || pl_poly_degree(t, a, g) < 2) continue;
    const pl_poly* other = pl_poly_view(t, a, g);
    if (other->length < a->length) a = other;
  }
  return a;
}

// -------------------------------------------------------------------------------- compact contexts
const fmpz_mpoly_ctx_struct* pl_poly_small_context(pl_tower* t, int n) {
  if (n == 0) n = 1;  // a number; FLINT wants a variable
  if (!t->small[n]) {
    fmpz_mpoly_ctx_struct* ctx = PL_NEW(t->arena, fmpz_mpoly_ctx_struct);
    fmpz_mpoly_ctx_init(ctx, n, ORD_LEX);
    t->small[n] = ctx;
  }
  return t->small[n];
}

void pl_poly_used(const pl_tower* t, const pl_poly* a, int* use, int* n) {
  int used[PL_MAX_GENERATORS] = {0};
  fmpz_mpoly_used_vars(used, a, &t->ctx);
  for (int i = 0; i < *n; i++) used[use[i]] = 1;
  *n = 0;
  for (int g = 0; g < t->capacity; g++) {
    if (used[g]) use[(*n)++] = g;
  }
}

void pl_poly_pack(pl_tower* t, fmpz_mpoly_struct* out, const fmpz_mpoly_ctx_struct* small,
                  const pl_poly* a, const int* use, int n) {
  ulong wide[PL_MAX_GENERATORS], narrow[PL_MAX_GENERATORS] = {0};
  fmpz_mpoly_zero(out, small);
  for (slong i = 0; i < a->length; i++) {
    fmpz_mpoly_get_term_exp_ui(wide, a, i, &t->ctx);
    for (int k = 0; k < n; k++) narrow[k] = wide[use[k]];
    // the order stays, since use[] ascends
    fmpz_mpoly_push_term_fmpz_ui(out, &a->coeffs[i], narrow, small);
  }
}

void pl_poly_unpack(pl_tower* t, pl_poly* out, const fmpz_mpoly_struct* a,
                    const fmpz_mpoly_ctx_struct* small, const int* use, int n) {
  ulong wide[PL_MAX_GENERATORS] = {0}, narrow[PL_MAX_GENERATORS];
  fmpz_mpoly_zero(out, &t->ctx);
  for (slong i = 0; i < a->length; i++) {
    fmpz_mpoly_get_term_exp_ui(narrow, a, i, small);
    for (int k = 0; k < n; k++) wide[use[k]] = narrow[k];
    fmpz_mpoly_push_term_fmpz_ui(out, &a->coeffs[i], wide, &t->ctx);
  }
}

// ---------------------------------------------------------------------------------------- division
bool pl_poly_divides(pl_tower* t, const pl_poly** q, const pl_poly* a, const pl_poly* b) {
  if (a->length == 0 || a->length < (b->length > 1 ? 2 : 1)) return false;
  long da[PL_MAX_GENERATORS], db[PL_MAX_GENERATORS];
  pl_poly_degrees(t, a, da);
  pl_poly_degrees(t, b, db);
  for (int g = 0; g < t->gens.n; g++) {
    if (db[g] > da[g]) return false;
  }
  pl_poly* f = pl_poly_new(t);
  if (!fmpz_mpoly_divides(f, a, b, &t->ctx)) return false;
  *q = f;
  return true;
}

static const pl_poly* gcd_small(pl_tower* t, const pl_poly* a, const pl_poly* b, const int* use,
                                int n) {
  const fmpz_mpoly_ctx_struct* small = pl_poly_small_context(t, n);
  pl_poly* f = pl_poly_new(t);
  fmpz_mpoly_t x, y, g;
  fmpz_mpoly_init(x, small);
  fmpz_mpoly_init(y, small);
  fmpz_mpoly_init(g, small);
  pl_poly_pack(t, x, small, a, use, n);
  pl_poly_pack(t, y, small, b, use, n);
  if (fmpz_mpoly_gcd(g, x, y, small)) {
    pl_poly_unpack(t, f, g, small, use, n);
  } else {
    fmpz_mpoly_one(f, &t->ctx);
  }
  fmpz_mpoly_clear(x, small);
  fmpz_mpoly_clear(y, small);
  fmpz_mpoly_clear(g, small);
  return f;
}

const pl_poly* pl_poly_gcd(pl_tower* t, const pl_poly* a, const pl_poly* b) {
  if (a->length == 0) return b;
  if (b->length == 0) return a;
  if (a->length + b->length > PL_MAX_GCD_TERMS) return pl_poly_int(t, 1);
  int use[PL_MAX_GENERATORS], n = 0;
  pl_poly_used(t, a, use, &n);
  pl_poly_used(t, b, use, &n);
  return gcd_small(t, a, b, use, n);
}

bool pl_poly_square_root(pl_tower* t, const pl_poly** root, const pl_poly* a) {
  if (a->length == 0) {
    *root = a;
    return true;
  }
  if (a->length > PL_MAX_FACTOR_TERMS) return false;
  long degree[PL_MAX_GENERATORS];
  pl_poly_degrees(t, a, degree);
  for (int g = 0; g < t->gens.n; g++) {
    if (degree[g] % 2) return false;
  }
  pl_poly* f = pl_poly_new(t);
  if (!fmpz_mpoly_sqrt(f, a, &t->ctx)) return false;
  *root = f;
  return true;
}

// ------------------------------------------------------------------------------------ leading sign
// Compares terms i and j in the order of writing: a number first, then by exponent of the first
// generator that differs.
static bool written_before(pl_tower* t, const ulong* x, const ulong* y) {
  bool x_number = true, y_number = true;
  for (int g = 0; g < t->gens.n; g++) {
    x_number &= x[g] == 0;
    y_number &= y[g] == 0;
  }
  if (x_number || y_number) return x_number;
  for (int k = 0; k < t->gens.n; k++) {
    int g = t->by_rank[k];
    if (x[g] != y[g]) return x[g] > y[g];
  }
  return false;
}

int pl_poly_leading_sign(pl_tower* t, const pl_poly* a) {
  if (a->length == 0) return 0;
  pl_tower_order(t);
  ulong best[PL_MAX_GENERATORS], here[PL_MAX_GENERATORS];
  slong at = 0;
  fmpz_mpoly_get_term_exp_ui(best, a, 0, &t->ctx);
  for (slong i = 1; i < a->length; i++) {
    fmpz_mpoly_get_term_exp_ui(here, a, i, &t->ctx);
    if (!written_before(t, here, best)) continue;
    memcpy(best, here, sizeof best);
    at = i;
  }
  return fmpz_sgn(&a->coeffs[at]);
}
