// tower.h: what the files of the algebra share, and present: the tower, its generators,
// polynomials, factors, fractions.
//
// Polynomials live in one FLINT context of t->capacity variables; variable i is generator i. When a
// conversion needs more generators, a finer angle base, or another basis of exponents, the tower is
// emptied, enlarged, and the outermost service starts again (pl_tower_restart). So polynomials,
// fractions and generator numbers never outlive the service that made them; expressions do.
//
// A service is a body run by pl_tower_run. Inside it polynomials are taken from a stack and given
// back all at once at its end (no clear anywhere), and whoever cannot go on calls pl_tower_give_up,
// which unwinds to the innermost service. FLINT's own abort takes the same road. A body hands its
// results over as expressions, numbers and flags.
//
//   static void body(pl_tower* t, void* data) {
//     struct job* j = data;
//     pl_frac f = pl_convert(t, j->in);
//     j->out = pl_frac_expr(t, f);
//   }
//   ...
//   if (!pl_tower_run(t, body, &j)) ...           // gave up: j->out is what it was before
#ifndef PL_TOWER_H
#define PL_TOWER_H

#include "algebra/algebra.h"

#include <setjmp.h>

#include <gmp.h>

#include <flint/flint.h>
#include <flint/fmpz.h>
#include <flint/fmpz_factor.h>
#include <flint/fmpz_vec.h>
#include <flint/fmpq.h>
#include <flint/fmpz_mpoly.h>
#include <flint/fmpz_mpoly_factor.h>
#if __has_include(<flint/arb.h>)
#  include <flint/arb.h>
#else
#  include <arb.h>
#endif

// ------------------------------------------------------------------------------------------ limits
// Each keeps a single call into FLINT below about a second, since none of them can be interrupted.
enum {
  PL_MAX_GENERATORS = 192,  // contexts grow in steps of 8 up to here
  // terms of a times terms of b: a heap product of this size takes about half a second
  PL_MAX_PRODUCT = 4000000,
  PL_MAX_TERMS = 200000,       // terms of a result
  PL_MAX_FACTOR_TERMS = 1200,  // beyond it a polynomial is kept as one composite factor
  PL_MAX_FACTOR_DEGREE = 80,   // total degree, likewise
  // sum of the terms of both; beyond it gcd = 1 (the fraction is right, only not reduced)
  PL_MAX_GCD_TERMS = 20000,
  // terms of a dividend times terms of a divisor, for division modulo the relations
  PL_MAX_CONJUGATE = 20000,
  PL_MAX_DEGREE = 4000,      // in one variable: Horner's rule for s^2 = 1 - c^2 is linear in it
  PL_MAX_INTEGER_BITS = 96,  // integers up to this size are split into primes
  PL_MAX_POWER = 64,         // integer exponent of a sum
  // cos(nθ) is written in powers of cos θ up to this n: its coefficients stay below 50
  PL_MAX_MULTIPLE = 6,
  // numerator and denominator of a multiple; larger ones stay inside the atom
  PL_MAX_RATIO = 24,
  PL_MAX_APART = 8,  // multiples of an atom that are remembered as atoms of their own
  // products of terms, about 2 s; counted, not timed: the same input ends in the same way
  // everywhere
  PL_WORK_OF_SERVICE = 15000000,
  PL_WORK_OF_ALL = 60000000,  // of all services of a tower, about 8 s; beyond it each has
  PL_WORK_OF_SMALL = 200000,
  PL_WORK_OF_PRODUCT = 40,  // of the product and sum of small polynomials, which is overhead
  PL_WORK_OF_SUM = 15,
  PL_WORK_OF_WRITTEN_TERM = 15,
  // a longer polynomial is no normal form for anybody: the expression stays as it was
  PL_MAX_WRITTEN_TERMS = 10000,
  PL_MAX_DEPTH = 2000  // nesting of an expression that is converted by recursion
};

// ------------------------------------------------------------------------------------------- types
typedef fmpz_mpoly_struct pl_poly;

typedef enum pl_gen_kind {
  PL_G_SYMBOL,  // a symbol or an element of a family
  PL_G_COS,     // cos of an angle base
  PL_G_SIN,     // sin of it: s^2 = 1 - c^2
  PL_G_SINH,
  PL_G_COSH,   // C^2 = 1 + S^2
  PL_G_EXP,    // exp of a base of exponents
  PL_G_ROOT,   // w >= 0 with w^degree = P, degree 2 nearly always
  PL_G_ABS,    // |u| where the sign of u may change: a^2 = u^2
  PL_G_FORMAL  // ln, asin, acos, atan, atan2, if, sums over an index, x^a, π: no relation
} pl_gen_kind;

typedef struct pl_gen {
  pl_gen_kind kind;
  pl_expr expr;          // what it stands for: θ, cos(θ/2), sqrt(P)
  pl_symbol symbol;      // of a PL_G_SYMBOL that is a plain symbol
  int partner;           // sin <-> cos, sinh <-> cosh; -1
  int degree;            // the relation is gen^degree = value; 0: none
  const pl_poly* value;  // reduced, in older generators
  pl_class class;        // for the order K5
  int sign;              // 1: > 0 known, 2: >= 0 known, -1: < 0, -2: <= 0, 0: open
} pl_gen;

// A factor that occurs: primitive polynomial, its leading coefficient by K5 positive. Irreducible
// unless `composite`.
typedef struct pl_base {
  const pl_poly* poly;
  bool composite;  // too large to be factored
  int gen;         // the generator it consists of, or -1
  pl_expr expr;    // as an expression, 0 until asked
} pl_base;

typedef struct pl_power {
  int base, power;
} pl_power;

// n / (unit * prod base^power), powers > 0, bases ascending; unit > 0 and coprime to the content of
// num.
typedef struct pl_frac {
  const pl_poly* num;  // reduced modulo the relations
  const fmpz* unit;
  int n;
  const pl_power* den;
} pl_frac;

// A factored polynomial: unit * prod base^power.
typedef struct pl_factored {
  const fmpz* unit;  // with sign
  int n;
  const pl_power* at;
} pl_factored;

typedef struct pl_factoring {
  const pl_poly* poly;
  pl_factored factors;
} pl_factoring;  // remembered

typedef struct pl_points pl_points;  // sample points with Arb values, alg_points.c
typedef struct pl_entry pl_entry;    // a running service, tower.c

// An angle base or a base of exponents, kept when the tower restarts: the atom occurs as
// (integer/den) * atom.
typedef struct pl_multiple {
  long num, den;
} pl_multiple;
typedef struct pl_lattice {
  pl_expr atom;
  pl_expr shift;  // of angles: a number
  long num, den;  // the base is num/den (atom + shift)
  bool settled;   // the shift is
  bool hyperbolic;
  int gen;
  // largest multiple of the atom met so far; what measures all of them
  pl_multiple most, common;
  pl_multiple apart[PL_MAX_APART];  // multiples that became atoms of their own     (n_apart)
  int n_apart;
} pl_lattice;

struct pl_tower {
  pl_job* job;
  pl_pool* pool;
  pl_arena* arena;  // of the pool: lives as long as the expressions
  PL_VEC(pl_fact) facts;
  PL_VEC(pl_fact) used;
  PL_VEC(pl_replace) names;  // that stand for other quantities
  const double* probe;       // by symbol id, n_probe + 1 entries, or NULL
  int n_probe;

  fmpz_mpoly_ctx_struct ctx;
  int capacity;
  PL_VEC(pl_gen) gens;
  pl_map* gen_of;  // expression id -> generator + 1
  // position of a generator in the order K5, valid while n_ranked == gens.n
  int rank[PL_MAX_GENERATORS];
  int by_rank[PL_MAX_GENERATORS];
  int n_ranked;

  pl_map* converted;  // expression id -> index in fractions + 1
  PL_VEC(pl_frac) fractions;
  PL_VEC(pl_base) bases;
  pl_map* base_of;      // hash of polynomial -> base + 1, collisions at hash + k
  pl_map* factored_of;  // hash of polynomial -> index in factorings + 1
  PL_VEC(pl_factoring) factorings;
  PL_VEC(pl_lattice) angles;  // survive a restart
  PL_VEC(pl_lattice) exponents;
  pl_map* angle_of;  // atom id -> index + 1
  pl_map* exponent_of;

  // what FLINT has to free: two stacks of polynomials and integers, and those that are kept
  PL_VEC(pl_poly*) poly_chunks;
  int polys_used, polys_made;
  PL_VEC(fmpz*) int_chunks;
  int ints_used;
  PL_VEC(pl_poly*) kept_polys;
  PL_VEC(fmpz*) kept_ints;
  fmpz_mpoly_ctx_struct* small[PL_MAX_GENERATORS + 1];  // compact contexts, by number of variables

  // of the last factoring, while it is being read
  fmpz_mpoly_factor_struct flint_factors;
  const fmpz_mpoly_ctx_struct* flint_factors_context;  // NULL: none
  fmpz_factor_struct flint_integer_factors;
  bool has_flint_integer_factors;

  pl_entry* entry;    // innermost running service of this tower
  pl_points* points;  // for signs and zero tests
  // points modulo p at which presented forms are compared, made when needed
  PL_VEC(pl_mod_point*) mod_points;
  pl_points* fine_points;  // the same at a higher precision, made when needed
  bool facts_busy;         // facts are being used: no facts inside facts
  // bases were refined or roots combined: the next service starts from an empty tower,
  // so that its result does not depend on what was asked before
  bool tangled;
  bool began_empty, wanted_empty;  // the running service did; it has to
  long work_left, work_done;       // of the running service; of all
  bool silent;                     // proofs are not recorded: nothing that is shown rests on them
  const pl_poly* radicand;         // under the root that is being taken: >= 0, as roots are real
  int depth;                       // of the conversion
};

// ------------------------------------------------------------------------------- services, tower.c
bool pl_tower_run(pl_tower* t, void (*body)(pl_tower* t, void* data), void* data);
_Noreturn void pl_tower_give_up(pl_tower* t);  // to the innermost service: "not found"
_Noreturn void pl_tower_restart(pl_tower* t);  // empty the tower, start the outermost service again
// The running service has to begin, and the next one too, as if it were the first.
void pl_tower_start_empty(pl_tower* t);
typedef struct pl_tower_mark {
  int polys, ints;
} pl_tower_mark;
pl_tower_mark pl_tower_mark_now(const pl_tower* t);
// gives back the polynomials and integers taken since
void pl_tower_rewind(pl_tower* t, pl_tower_mark m);
// gives up when the budget of the service is used
void pl_tower_charge(pl_tower* t, long work);
// gives up when the job was interrupted
void pl_tower_check(pl_tower* t);
// appends; restarts with a larger context when full
int pl_tower_generator(pl_tower* t, const pl_gen* g);
// generator that stands for e, or -1
int pl_tower_find(const pl_tower* t, pl_expr e);
// brings rank and by_rank up to date
void pl_tower_order(pl_tower* t);
// x occurs in what the generator stands for
bool pl_gen_contains(const pl_tower* t, int gen, pl_symbol x);

// ----------------------------------------------------------------------------- polynomials, poly.c
pl_poly* pl_poly_new(pl_tower* t);  // zero
fmpz* pl_int_new(pl_tower* t);      // zero
// a copy that lives as long as the tower is not emptied
const pl_poly* pl_poly_keep(pl_tower* t, const pl_poly* f);
const fmpz* pl_int_keep(pl_tower* t, const fmpz* c);
const pl_poly* pl_poly_int(pl_tower* t, long c);
const pl_poly* pl_poly_fmpz(pl_tower* t, const fmpz* c);
const pl_poly* pl_poly_gen(pl_tower* t, int gen);
const pl_poly* pl_poly_gen_power(pl_tower* t, int gen, long power);
const pl_poly* pl_poly_add(pl_tower* t, const pl_poly* a, const pl_poly* b);
const pl_poly* pl_poly_sub(pl_tower* t, const pl_poly* a, const pl_poly* b);
const pl_poly* pl_poly_neg(pl_tower* t, const pl_poly* a);
const pl_poly* pl_poly_scale(pl_tower* t, const pl_poly* a, const fmpz* c);
const pl_poly* pl_poly_scale_down(pl_tower* t, const pl_poly* a, const fmpz* c);   // exact
const pl_poly* pl_poly_mul(pl_tower* t, const pl_poly* a, const pl_poly* b);       // reduced
const pl_poly* pl_poly_mul_free(pl_tower* t, const pl_poly* a, const pl_poly* b);  // not reduced
const pl_poly* pl_poly_pow(pl_tower* t, const pl_poly* a, long n);                 // reduced
bool pl_poly_is_zero(const pl_tower* t, const pl_poly* a);
bool pl_poly_is_one(const pl_tower* t, const pl_poly* a);
bool pl_poly_is_number(const pl_tower* t, const pl_poly* a);
bool pl_poly_equal(const pl_tower* t, const pl_poly* a, const pl_poly* b);
long pl_poly_terms(const pl_poly* a);
uint64_t pl_poly_hash(pl_tower* t, const pl_poly* a);
long pl_poly_degree(const pl_tower* t, const pl_poly* a, int gen);
void pl_poly_degrees(const pl_tower* t, const pl_poly* a, long* degree);  // (capacity)
void pl_poly_content(pl_tower* t, fmpz* c, const pl_poly* a);             // >= 0
// gen^degree -> value throughout a, once.
const pl_poly* pl_poly_eliminate(pl_tower* t, const pl_poly* a, int gen, int degree,
                                 const pl_poly* value);
const pl_poly* pl_poly_reduce(pl_tower* t, const pl_poly* a);  // modulo all relations
// The other view of a pair: c^2 -> 1 - s^2 (or S^2 -> C^2 - 1).  gen is the cos (sinh).
const pl_poly* pl_poly_view(pl_tower* t, const pl_poly* a, int gen);
// The view with the fewest terms, pair after pair in the order K5.
const pl_poly* pl_poly_shortest_view(pl_tower* t, const pl_poly* a);
// Coefficients in one generator, 0 .. degree; the array lives in the arena.
const pl_poly** pl_poly_coefficients(pl_tower* t, const pl_poly* a, int gen, int* degree);
// Exact division and greatest common divisor in the free ring; gcd in a compact context.
bool pl_poly_divides(pl_tower* t, const pl_poly** q, const pl_poly* a, const pl_poly* b);
// Exact division modulo the relations, divide.c: 1 - c^2 is divisible by s. Not found beyond a
// size.
bool pl_poly_divides_reduced(pl_tower* t, const pl_poly** q, const pl_poly* a, const pl_poly* b);
const pl_poly* pl_poly_gcd(pl_tower* t, const pl_poly* a, const pl_poly* b);
bool pl_poly_square_root(pl_tower* t, const pl_poly** root, const pl_poly* a);
// Sign of the leading coefficient by K5: numbers first, then masses, g, lengths, ...; 0 for the
// zero polynomial.
int pl_poly_leading_sign(pl_tower* t, const pl_poly* a);
// Compact contexts: the polynomial in the generators that it uses, *n of them, listed in use[].
const fmpz_mpoly_ctx_struct* pl_poly_small_context(pl_tower* t, int n);
// adds to use[0 .. n-1], ascending
void pl_poly_used(const pl_tower* t, const pl_poly* a, int* use, int* n);
void pl_poly_pack(pl_tower* t, fmpz_mpoly_struct* out, const fmpz_mpoly_ctx_struct* small,
                  const pl_poly* a, const int* use, int n);
void pl_poly_unpack(pl_tower* t, pl_poly* out, const fmpz_mpoly_struct* a,
                    const fmpz_mpoly_ctx_struct* small, const int* use, int n);

// ------------------------------------------------------------------------------- factors, factor.c
pl_factored pl_poly_factor(pl_tower* t, const pl_poly* a);                // a != 0; remembered
int pl_base_find(pl_tower* t, const pl_poly* primitive, bool composite);  // sign must be normalised
const pl_poly* pl_base_poly(const pl_tower* t, int base);
pl_expr pl_base_expr(pl_tower* t, int base);
const pl_poly* pl_factored_expand(pl_tower* t, pl_factored f);  // reduced
// Primes of |c| with their powers; an integer of more than PL_MAX_INTEGER_BITS bits counts as one
// prime.
typedef struct pl_prime {
  fmpz* p;
  long power;
} pl_prime;
typedef struct pl_primes {
  pl_prime* at;
  int n, cap;
} pl_primes;
pl_primes pl_int_primes(pl_tower* t, const fmpz* c);
// f without integer and monomial content in the generators use[0 .. n-1]: proven to have no
// factors. Otherwise, a generator in which it is linear with coefficients that seem to have a
// common factor, in *linear; -1. irreducible.c
bool pl_poly_proven_irreducible(pl_tower* t, const pl_poly* f, const int* use, int n, int* linear);
void pl_factor_free(pl_tower* t);  // what FLINT holds for the last factoring
// (1 - c)^k (1 + c)^k -> s^2k, likewise C, S.  Bases stay bases: sin is one.
pl_factored pl_factored_merge_pairs(pl_tower* t, pl_factored f);

// --------------------------------------------------------------------------- fractions, fraction.c
pl_frac pl_frac_int(pl_tower* t, long c);
pl_frac pl_frac_ratio(pl_tower* t, const fmpz* num, const fmpz* den);  // den != 0
pl_frac pl_frac_poly(pl_tower* t, const pl_poly* num);
pl_frac pl_frac_gen(pl_tower* t, int gen);
// reduces, cancels; den != 0
pl_frac pl_frac_make(pl_tower* t, const pl_poly* num, const pl_poly* den);
// num over the denominator of `like`
pl_frac pl_frac_over(pl_tower* t, const pl_poly* num, pl_frac like);
pl_frac pl_frac_add(pl_tower* t, pl_frac a, pl_frac b);
pl_frac pl_frac_sub(pl_tower* t, pl_frac a, pl_frac b);
pl_frac pl_frac_neg(pl_tower* t, pl_frac a);
pl_frac pl_frac_mul(pl_tower* t, pl_frac a, pl_frac b);
pl_frac pl_frac_div(pl_tower* t, pl_frac a, pl_frac b);  // gives up on division by zero
pl_frac pl_frac_inv(pl_tower* t, pl_frac a);
pl_frac pl_frac_pow(pl_tower* t, pl_frac a, long n);
bool pl_frac_is_zero(const pl_tower* t, pl_frac a);
// unit and factors multiplied out
const pl_poly* pl_frac_den(pl_tower* t, pl_frac a);
pl_frac pl_frac_keep(pl_tower* t, pl_frac a);

// ------------------------------------------------------------------------------------- conversions
// remembered; gives up on poison and infinity       convert.c
pl_frac pl_convert(pl_tower* t, pl_expr e);
// e was made from f: it needs no conversion
void pl_convert_known(pl_tower* t, pl_expr e, pl_frac f);
// num in its shortest view over factored den        poly_expr.c
pl_expr pl_frac_expr(pl_tower* t, pl_frac a);
pl_expr pl_poly_expr(pl_tower* t, const pl_poly* a);  // expanded, shortest view
pl_expr pl_fmpz_expr(pl_tower* t, const fmpz* c);
pl_expr pl_fmpq_expr(pl_tower* t, const fmpz* num, const fmpz* den);

// Angles and exponents: sum of rational multiples of atoms. angle.c
typedef struct pl_sincos {
  pl_frac s, c;
} pl_sincos;
pl_lattice pl_lattice_of(pl_tower* t, pl_expr atom);  // as coarse as it begins
pl_sincos pl_convert_sincos(pl_tower* t, pl_expr argument);
pl_sincos pl_convert_sinhcosh(pl_tower* t, pl_expr argument);
pl_frac pl_convert_exp(pl_tower* t, pl_expr argument);

// Roots and what depends on signs. radical.c
// e without names that stand for other quantities          tower.c
pl_expr pl_tower_see(const pl_tower* t, pl_expr e);
pl_frac pl_frac_sqrt(pl_tower* t, pl_frac a);
pl_frac pl_frac_abs(pl_tower* t, pl_frac a);
pl_frac pl_frac_ln(pl_tower* t, pl_frac a);
// e as a generator without relation                 convert.c
pl_frac pl_formal(pl_tower* t, pl_expr e);

// ----------------------------------------------------------------------------------- signs, sign.c
// Sign of a polynomial: 1, -1, 0 (identically zero), or PL_SIGN_OPEN. With `guess`, samples of the
// domain and the probe may decide, and the assumption is recorded. or_zero accepts >= 0 and <= 0.
enum { PL_SIGN_OPEN = 9 };
int pl_poly_sign(pl_tower* t, const pl_poly* a, bool or_zero, bool guess);
int pl_base_sign(pl_tower* t, int base, bool or_zero, bool guess);
// Bounds over all angles: low <= c a <= high for a positive number c, low and high without sines.
// trig_bounds.c
bool pl_poly_trig_bounds(pl_tower* t, const pl_poly* a, const pl_poly** low, const pl_poly** high);

// ---------------------------------------------------------------------------------- sample points,
// alg_points.c Points of a domain: free symbols drawn by name and point number (so that the values
// do not depend on history) such that the facts hold, definitions in order, unknowns by a numeric
// solve. Expressions are evaluated by a growing straight-line program, whose values are kept for
// each point.
pl_points* pl_points_make(pl_job* job, pl_pool* p, const pl_domain* s, int n_points, long precision,
                          uint64_t seed);
int pl_points_count(const pl_points* s);
// Ball of e at a point; false where it is not finite or the point is unusable. Valid until the next
// call.
bool pl_points_value(pl_points* s, int point, pl_expr e, arb_srcptr* value);
// Value of e as a double, NaN where it is not usable.
double pl_points_double(pl_points* s, int point, pl_expr e);
// The tower's own points, under its facts, made when needed; at PL_POINT_BITS.
enum { PL_POINT_BITS = 256, PL_POINT_COUNT = 50 };
pl_points* pl_tower_points(pl_tower* t);

#endif
