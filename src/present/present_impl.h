// present_impl.h: what the rooms of presentation share: pieces, products, and the state of one
// search.
//
// The search works on polynomials of the tower and keeps what it finds as products of pieces: a
// number times powers of symbols, functions, roots and bracketed sums. A product knows what it
// costs to read. Forms are made from products at the very end of each step, with factors and terms
// in the order K5.
#ifndef PL_PRESENT_IMPL_H
#define PL_PRESENT_IMPL_H

#include "algebra/tower.h"
#include "present/present.h"

// Order of factors inside a product.                                                  ORDER BUCKETS
typedef enum pl_bucket {
  PL_K_NUMBER,
  PL_K_MULTIPLIER,
  PL_K_MASS,
  PL_K_GRAVITY,
  PL_K_LENGTH,
  PL_K_OTHER,
  PL_K_PARAM_SUM,
  PL_K_INERTIA,
  PL_K_START,
  PL_K_TIME,
  PL_K_COORD,
  PL_K_VELOCITY,
  PL_K_ACCELERATION,
  PL_K_FUNCTION,
  PL_K_ROOT,
  PL_K_SUM
} pl_bucket;

typedef struct pl_sum_terms pl_sum_terms;

// One factor. Two pieces are the same when their bases are the same form (pointers): forms of
// generators and of presented polynomials are kept for the whole search.
typedef struct pl_piece {
  const pl_form* base;
  int power;  // negative: stands in the denominator
  pl_bucket bucket;
  pl_symbol lead;           // for the order within a bucket
  int order;                // sin before cos
  long cost;                // of the base alone
  int gen;                  // generator, or -1
  const pl_sum_terms* sum;  // terms of a bracketed sum, or NULL
} pl_piece;

typedef struct pl_prod {
  pl_expr unit;  // rational number
  int n;
  const pl_piece* at;  // (n), sorted by K5
  long cost;
} pl_prod;

// The form of a sum is made when it is asked for: most sums of a search are never shown. Until then
// it is an empty sum, which tells the piece from others.
struct pl_sum_terms {
  int n;
  const pl_prod* at;
  pl_form* form;
};

typedef struct pl_present_found {
  const pl_poly* poly;
  int depth;
  bool busy;
  pl_prod prod;
} pl_present_found;

typedef struct pl_wave_known {
  pl_piece piece;
} pl_wave_known;

typedef struct pl_present_search {
  pl_tower* t;
  pl_arena* a;
  pl_pool* p;
  pl_style style;
  long work, limit;  // units spent, units allowed
  pl_map* found_at;  // hash of polynomial and depth -> index in found + 1
  PL_VEC(pl_present_found) found;
  pl_piece gen_piece[PL_MAX_GENERATORS];
  bool gen_known[PL_MAX_GENERATORS];
  pl_map* wave_at;  // multiples of angles: hash -> index in waves + 1
  PL_VEC(pl_wave_known) waves;
} pl_present_search;

// ------------------------------------------------------------------------------- present_product.c
pl_prod pl_prod_number(pl_present_search* s, pl_expr number);
pl_prod pl_prod_piece(pl_present_search* s, pl_piece piece, int power);
pl_prod pl_prod_mul(pl_present_search* s, pl_prod x, pl_prod y);
pl_prod pl_prod_pow(pl_present_search* s, pl_prod x, int n);
pl_prod pl_prod_scale(pl_present_search* s, pl_prod x, pl_expr number);
pl_prod pl_prod_neg(pl_present_search* s, pl_prod x);
bool pl_prod_is_zero(const pl_present_search* s, pl_prod x);
bool pl_prod_is_negative(const pl_present_search* s, pl_prod x);
bool pl_prod_has_denominator(pl_prod x);
pl_piece pl_piece_of_gen(pl_present_search* s, int gen);
// The number in a sum, which is taken out of it; 0: there is none.
pl_expr pl_take_number(pl_pool* p, pl_expr* e);
pl_prod pl_prod_of_gen(pl_present_search* s, int gen, int power);
pl_prod pl_prod_of_exponents(pl_present_search* s, pl_expr unit, const ulong* exponent);
const pl_form* pl_prod_form(pl_present_search* s, pl_prod x);
// The same with a numeric fraction in front, 2/3 sin α, 1/2 m g cos α, rather than below, x²/2. A
// product wants it when the numerator is not 1 or a function ends it: cos α/2 would be read in two
// ways.
const pl_form* pl_prod_form_with(pl_present_search* s, pl_prod x, bool fraction_first);
bool pl_prod_wants_fraction_first(pl_present_search* s, pl_prod x);
// The product with a leading minus moved into a bracket where that removes it: -(m2 - m1) g -> (m1
// - m2) g.
pl_prod pl_prod_flip(pl_present_search* s, pl_prod x);
// cos²/..., √A √B -> √(A B), sin/cos -> tan: what can be merged once numerator and denominator are
// known.
pl_prod pl_prod_tidy(pl_present_search* s, pl_prod x);
int pl_piece_compare(pl_present_search* s, const pl_piece* x,
                     const pl_piece* y);  // K5, powers aside

// ----------------------------------------------------------------------------------- present_sum.c
// A sum of products as one product: a single piece, or the term itself if there is only one. The
// first term by K5 is made positive, the sign goes in front.
pl_prod pl_prod_sum(pl_present_search* s, const pl_prod* terms, int n);
// the same with all signs as they are
pl_prod pl_prod_bracket(pl_present_search* s, const pl_prod* terms, int n);
// Appends x to the terms of a sum; a bare bracket is opened, up to PL_OPENED_TERMS terms.
enum { PL_OPENED_TERMS = 8 };
void pl_terms_put(pl_present_search* s, pl_prod x, pl_prod* terms, int* n);
void pl_terms_add(pl_present_search* s, pl_prod x, pl_prod* terms, int* n);  // as it is
const pl_form* pl_terms_form(pl_present_search* s, const pl_prod* terms,
                             int n);  // in the order given
// with the form of a sum filled in
const pl_form* pl_piece_base(pl_present_search* s, const pl_piece* piece);
void pl_terms_sort(pl_present_search* s, pl_prod* terms, int n);
int pl_terms_compare(pl_present_search* s, const pl_prod* x, const pl_prod* y);
// Derivative order and total power of velocities in a product: what K2 sorts by.
int pl_prod_motion(pl_present_search* s, pl_prod x);

// ---------------------------------------------------------------------------------- present_poly.c
pl_prod pl_present_poly(pl_present_search* s, const pl_poly* f, int depth);

// f = w * rest, seen when a square in f is written with w² = P: l √P - x² - y² = √P (l - √P) for P
// = x² + y².
bool pl_poly_root_divides(pl_present_search* s, const pl_poly* f, int w, const pl_poly** rest);

// Which generators form the key of a collection.
typedef enum pl_key_set {
  PL_KEY_MOTION,  // velocities, accelerations, momenta, multipliers
  PL_KEY_MASS,
  PL_KEY_GRAVITY,
  PL_KEY_OTHER,
  PL_KEY_LENGTH,
  PL_KEY_COORD,
  PL_KEY_FUNCTION,
  PL_KEY_ROOT,
  PL_KEY_TIME,
  PL_N_KEY_SETS
} pl_key_set;
bool pl_gen_in_key(pl_present_search* s, int gen, pl_key_set set);
typedef struct pl_term_group {
  ulong* key;
  pl_poly* coefficient;
} pl_term_group;
// Groups the terms of f by their part in the generators of `in` (by index). Returns the number of
// groups.
int pl_poly_group(pl_present_search* s, const pl_poly* f, const bool* in, pl_term_group** out);
void pl_key_mask(pl_present_search* s, pl_key_set set, bool* in);

// ------------------------------------------------------------------------------- present_fourier.c
// The polynomial as a sum of cos and sin of multiple angles; false where there is nothing to gain
// or it is too large.
bool pl_present_fourier(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best);

// ------------------------------------------------------------------------------ present_quotient.c
pl_prod pl_present_quotient(pl_present_search* s, pl_frac f, int depth);
// part over the denominator of f, reduced
pl_frac pl_frac_part(pl_present_search* s, pl_frac f, const pl_poly* part);
// key times coefficient
const pl_poly* pl_group_poly(pl_present_search* s, const pl_term_group* g);

// --------------------------------------------------------------------------------- present_style.c
const pl_form* pl_present_styled(pl_present_search* s, pl_frac f, int depth, long* cost);

#endif
