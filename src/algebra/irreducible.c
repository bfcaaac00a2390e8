// Proofs of irreducibility that are much cheaper than factoring. Most polynomials that presentation
// asks about have no factors, and many are linear in a mass or in g; FLINT's general factoring
// spends 50 to 500 µs to find that out.
//
// Seen as a polynomial in one generator x of degree d, f = g h means that g is free of x (then it
// divides every coefficient of f), or that the image of f under values for the other generators,
// modulo a prime, splits too as long as it keeps its degree. So f is irreducible when
//   its coefficients have no common factor, and
//   d = 1, or some image of degree d is irreducible over the prime field.
// A common factor of the coefficients contains a generator y that all of them contain; its degree
// in y is at most that of the greatest common divisor of the images in y, when one coefficient
// keeps its degree. Both arguments are proofs whatever the prime and the values are; bad luck only
// sends f to FLINT.
#include "algebra/tower.h"

#include <flint/nmod_poly.h>
#include <flint/nmod_poly_factor.h>
#include <string.h>

enum { MAX_DEGREE = 6, MAX_TRIES = 6, MAX_VARIABLES = 3 };
static const uint64_t prime = 2147483647u;  // 2^31 - 1: products fit into a word

// A polynomial with its exponents laid open.
typedef struct open_poly {
  int n, terms;           // generators that occur, terms
  ulong* exponent;        // (terms x n)
  uint64_t* coefficient;  // modulo the prime      (terms)
  int* degree;            // (n)
} open_poly;

static uint64_t times(uint64_t a, uint64_t b) { return a * b % prime; }

static uint64_t power(uint64_t a, uint64_t k) {
  uint64_t r = 1;
  for (; k > 0; k >>= 1) {
    if (k & 1) r = times(r, a);
    a = times(a, a);
  }
  return r;
}

static open_poly lay_open(pl_tower* t, const pl_poly* f, const int* use, int n) {
  open_poly o = {.n = n, .terms = (int)f->length};
  o.exponent = PL_ARRAY(t->arena, ulong, f->length * n);
  o.coefficient = PL_ARRAY(t->arena, uint64_t, f->length);
  o.degree = PL_ARRAY(t->arena, int, n);
  ulong wide[PL_MAX_GENERATORS];
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(wide, f, i, &t->ctx);
    for (int k = 0; k < n; k++) {
      ulong e = wide[use[k]];
      o.exponent[i * n + k] = e;
      if ((ulong)o.degree[k] < e) o.degree[k] = (int)e;
    }
    o.coefficient[i] = fmpz_fdiv_ui(&f->coeffs[i], prime);
  }
  return o;
}

// Values for the generators: the same for every polynomial, so that a result never depends on
// history.
static uint64_t value_of(int variable, int trial) {
  return pl_hash_mix(0x51ab3e07u + (uint64_t)trial, (uint64_t)variable + 1) % prime;
}

// Term i with values for all generators but a and b.
static uint64_t term_value(const open_poly* o, int i, const uint64_t* value, int a, int b) {
  uint64_t v = o->coefficient[i];
  for (int k = 0; k < o->n; k++) {
    ulong e = o->exponent[i * o->n + k];
    if (e == 0 || k == a || k == b) continue;
    v = times(v, e == 1 ? value[k] : power(value[k], e));
  }
  return v;
}

// --------------------------------------------------------------------- polynomials in one variable
static int degree_of(const uint64_t* a, int from) {
  while (from >= 0 && a[from] == 0) from--;
  return from;
}

// a becomes the greatest common divisor of a and b, which is used up; returns its degree. Degrees
// -1: zero.
static int common_degree(uint64_t* a, int da, uint64_t* b, int db) {
  while (db >= 0) {
    uint64_t inverse = power(b[db], prime - 2);
    while (da >= db) {
      uint64_t q = times(a[da], inverse);
      for (int k = 0; k <= db; k++)
        a[da - db + k] = (a[da - db + k] + prime - times(q, b[k])) % prime;
      da = degree_of(a, da - 1);
    }
    for (int k = 0; k <= db || k <= da; k++) {
      uint64_t swap = a[k];
      a[k] = b[k];
      b[k] = swap;
    }
    int swap = da;
    da = db;
    db = swap;
  }
  return da;
}

// ---------------------------------------------------------------------------------------- contents
// Generators other than x that every coefficient of f in x contains, in `shared`; returns how many
// there are.
static int shared_variables(const open_poly* o, int x, bool* shared) {
  bool present[MAX_DEGREE + 1] = {false};
  uint64_t in[MAX_DEGREE + 1][PL_MAX_GENERATORS / 64 + 1];
  memset(in, 0, sizeof in);
  for (int i = 0; i < o->terms; i++) {
    ulong d = o->exponent[i * o->n + x];
    present[d] = true;
    for (int k = 0; k < o->n; k++)
      if (k != x && o->exponent[i * o->n + k]) in[d][k / 64] |= UINT64_C(1) << (k % 64);
  }
  int n = 0;
  for (int k = 0; k < o->n; k++) {
    shared[k] = k != x;
    for (int d = 0; d <= o->degree[x]; d++)
      if (present[d] && !(in[d][k / 64] >> (k % 64) & 1)) shared[k] = false;
    n += shared[k];
  }
  return n;
}

// The coefficients of f in x have no common factor that contains y.
static bool free_of(pl_tower* t, const open_poly* o, int x, int y, const uint64_t* value) {
  int dx = o->degree[x], dy = o->degree[y], size = dy + 1;
  uint64_t* image = PL_ARRAY(t->arena, uint64_t, (dx + 1) * size);
  int full[MAX_DEGREE + 1];
  for (int d = 0; d <= dx; d++) full[d] = -1;
  for (int i = 0; i < o->terms; i++) {
    int d = (int)o->exponent[i * o->n + x], e = (int)o->exponent[i * o->n + y];
    if (full[d] < e) full[d] = e;
    uint64_t* c = &image[d * size + e];
    *c = (*c + term_value(o, i, value, x, y)) % prime;
  }
  // the first divisor must be one that keeps its degree: it bounds that of the common factor
  int best = -1, common = -1;
  bool kept = false;
  for (int d = 0; d <= dx; d++) {
    if (full[d] < 0) continue;
    int degree = degree_of(&image[d * size], full[d]);
    kept |= degree == full[d];
    if (best < 0) {
      best = d;
      common = degree;
    } else common = common_degree(&image[best * size], common, &image[d * size], degree);
  }
  return kept && common == 0;
}

static bool content_is_one(pl_tower* t, const open_poly* o, int x, const uint64_t* value) {
  bool shared[PL_MAX_GENERATORS];
  if (shared_variables(o, x, shared) == 0) return true;
  for (int y = 0; y < o->n; y++)
    if (shared[y] && !free_of(t, o, x, y, value)) return false;
  return true;
}

// ------------------------------------------------------------------------------------------ images
// f as a polynomial in x alone, of degree d with a leading coefficient that is not 0; false when
// that is lost.
static bool image_in(const open_poly* o, int x, const uint64_t* value, uint64_t* c) {
  memset(c, 0, (size_t)(o->degree[x] + 1) * sizeof *c);
  for (int i = 0; i < o->terms; i++) {
    uint64_t* at = &c[o->exponent[i * o->n + x]];
    *at = (*at + term_value(o, i, value, x, x)) % prime;
  }
  return c[o->degree[x]] != 0;
}

// x^2 + ... does not split when its discriminant is no square.
static bool quadratic_is_irreducible(const uint64_t* c) {
  uint64_t disc = (times(c[1], c[1]) + prime - times(4, times(c[0], c[2]))) % prime;
  return power(disc, (prime - 1) / 2) == prime - 1;
}

static bool image_is_irreducible(const uint64_t* c, int degree) {
  if (degree == 2) return quadratic_is_irreducible(c);
  nmod_poly_t f;
  nmod_poly_init2(f, prime, degree + 1);
  for (int k = 0; k <= degree; k++) nmod_poly_set_coeff_ui(f, k, c[k]);
  bool answer = nmod_poly_is_irreducible(f);
  nmod_poly_clear(f);
  return answer;
}

static void set_values(const open_poly* o, int trial, uint64_t* value) {
  for (int k = 0; k < o->n; k++) value[k] = value_of(k, trial);
}

static bool some_image_is_irreducible(const open_poly* o, int x) {
  uint64_t value[PL_MAX_GENERATORS], c[MAX_DEGREE + 1];
  for (int trial = 0; trial < MAX_TRIES; trial++) {
    set_values(o, trial, value);
    if (image_in(o, x, value, c) && image_is_irreducible(c, o->degree[x])) return true;
  }
  return false;
}

// ----------------------------------------------------------------------------------------- verdict
static int terms_of_degree(const open_poly* o, int x, ulong d) {
  int n = 0;
  for (int i = 0; i < o->terms; i++) n += o->exponent[i * o->n + x] == d;
  return n;
}

// The generator in which f is linear with the shortest coefficient; -1.
static int linear_variable(const open_poly* o) {
  int best = -1, fewest = 0;
  for (int k = 0; k < o->n; k++) {
    if (o->degree[k] != 1) continue;
    int n = terms_of_degree(o, k, 1);
    if (2 * n > o->terms) n = o->terms - n;
    if (best >= 0 && n >= fewest) continue;
    best = k;
    fewest = n;
  }
  return best;
}

static bool is_proven(pl_tower* t, const open_poly* o, int* linear) {
  uint64_t value[PL_MAX_GENERATORS];
  set_values(o, 0, value);
  int x = linear_variable(o);
  if (x >= 0) {
    if (content_is_one(t, o, x, value)) return true;
    *linear = x;
    return false;
  }
  int tried = 0;
  for (int degree = 2; degree <= MAX_DEGREE; degree++) {
    for (int k = 0; k < o->n && tried < MAX_VARIABLES; k++) {
      if (o->degree[k] != degree) continue;
      tried++;
      if (content_is_one(t, o, k, value) && some_image_is_irreducible(o, k)) return true;
    }
  }
  return false;
}

bool pl_poly_proven_irreducible(pl_tower* t, const pl_poly* f, const int* use, int n, int* linear) {
  *linear = -1;
  pl_mark mark = pl_arena_mark(t->arena);
  open_poly o = lay_open(t, f, use, n);
  bool small = true;
  for (int k = 0; k < n; k++) small &= o.degree[k] <= 1000;
  bool proven = small && is_proven(t, &o, linear);
  pl_arena_rewind(t->arena, mark);
  if (*linear >= 0) *linear = use[*linear];
  return proven;
}
