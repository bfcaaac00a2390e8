// algebra: exact calculation in a field tower, on FLINT (beside enclose the only folder that sees
// FLINT and Arb).
//
// A tower is opened for one derivation. Its generators are the symbols, sin and cos of each angle
// base with s^2 = 1 - c^2, w = sqrt(P) with w^2 = P (Kummer test before a new one is added), exp
// over a lattice of exponents, sinh and cosh, and formal transcendentals (ln, atan, ...). Fractions
// have reduced numerators; denominators stay factored and are not rationalised. Expressions go in
// and come out as pl_expr; conversions are remembered.
//
// FLINT can neither abort nor block the program: sizes are capped before the call, flint_set_abort
// unwinds to the service that was called, which then answers "not found" (NULL, PL_UNKNOWN, or the
// input unchanged).
#ifndef PL_ALGEBRA_H
#define PL_ALGEBRA_H

#include "expr/expr.h"

typedef struct pl_tower pl_tower;

// What is assumed: signs from the symbols, relations such as r < l, ranges. difference > 0 (strict)
// or >= 0.
typedef struct pl_fact {
  pl_expr difference;
  bool strict;
} pl_fact;

pl_tower* pl_tower_make(pl_job* job, pl_pool* p, const pl_fact* facts, int n_facts);
// Values at which signs may be probed when nothing proves them (start values, parameters), by
// symbol id. The answers that rest on it are recorded as assumptions.
void pl_tower_probe(pl_tower* t, const double* value_of_symbol);
// Names that stand for other quantities, a := g: they stay names in formulas, and every question
// (zero, sign, rank) sees through them. Each value over names that come before it.
void pl_tower_define(pl_tower* t, const pl_replace* names, int n);
// Frees FLINT's memory.  Expressions stay.
void pl_tower_free(pl_tower* t);
// Frees what FLINT keeps for the calling thread.  Only when no tower of this thread is alive.
void pl_algebra_thread_end(void);
// Runs a body that uses FLINT outside of a tower. false: FLINT aborted, and what it held is lost.
// The body lets nothing else unwind through it.
bool pl_algebra_guarded(void (*body)(void* data), void* data);

// The assumptions that were used so far, as differences known to be > 0 or >= 0; n in *n. "used: m1
// > 0, r < l".
const pl_fact* pl_tower_used(const pl_tower* t, int* n);
void pl_tower_use(pl_tower* t, pl_fact fact);

// ---------------------------------------------------------------------- the three-valued questions
pl_answer3 pl_alg_is_zero(pl_tower* t, pl_expr e);  // algebra, mod p, Arb
pl_answer3 pl_alg_equal(pl_tower* t, pl_expr a, pl_expr b);
// Sign of e under the assumptions: order of proof of symbolic.md section 6. PL_UNKNOWN when it may
// change. *sign is -1, 0 or 1; with `or_zero` a result of >= 0 is answered as 1 and <= 0 as -1.
pl_answer3 pl_alg_sign(pl_tower* t, pl_expr e, bool or_zero, int* sign);
// The same by proof alone: neither samples nor the probe decide, and nothing is assumed.
pl_answer3 pl_alg_sign_proven(pl_tower* t, pl_expr e, bool or_zero, int* sign);

// ------------------------------------------------------------------------------------ normal forms
// Canonical up to the tower: one fraction, numerator reduced, common factors cancelled.
pl_expr pl_alg_normal(pl_tower* t, pl_expr e);
// Numerator and denominator of the normal form, as expressions.
void pl_alg_fraction(pl_tower* t, pl_expr e, pl_expr* num, pl_expr* den);
// Irreducible factors of the numerator and the denominator.  Powers negative in the denominator.
typedef struct pl_factor {
  pl_expr base;
  int power;
} pl_factor;
// unit: numeric factor
int pl_alg_factors(pl_tower* t, pl_expr e, pl_factor* out, int max, pl_expr* unit);
// Coefficients of e as a polynomial in the symbol x (0 .. degree) after normalisation; -1 when it
// is none (x in the denominator, inside a function) or degree > max.
int pl_alg_coefficients(pl_tower* t, pl_expr e, pl_symbol x, pl_expr* coefficient, int max_degree);
// Coefficients in an atom of the tower, e.g. cos θ or sqrt(P): polynomial in that atom.
int pl_alg_coefficients_atom(pl_tower* t, pl_expr e, pl_expr atom, pl_expr* coefficient,
                             int max_degree);
// Solutions of e = 0 for the symbol x: linear, quadratic (with sqrt), and through sin/cos/tan of x
// when e is linear in one of them or A cos x + B sin x + C, biquadratic, products of these
// factors. Returns how many were written; *complete tells whether these are all (up to periods of
// 2π). `condition` is what must hold besides (may be poison): -1 <= 2/3 <= 1 is decided silently.
// condition >= 0 for the root to be real
typedef struct pl_root {
  pl_expr value;
  pl_expr condition;
} pl_root;
int pl_alg_roots(pl_tower* t, pl_expr e, pl_symbol x, pl_root* out, int max, bool* complete);
// Zeros of e, which contains no other symbol than x, between lo and hi, as numbers, by ball
// arithmetic. *complete: these are all. One that is not proven stands for a narrow box in which it
// is not decided how many there are: a multiple zero, or none.
typedef struct pl_zero {
  double value;
  bool proven;
} pl_zero;
int pl_alg_zeros(pl_tower* t, pl_expr e, pl_symbol x, double lo, double hi, pl_zero* out, int max,
                 bool* complete);

// ---------------------------------------------------------------------------------- linear systems
// A x = b by memoised minors in the quotient ring, row contents removed, one gcd at the end. A
// row-major (n x n). PL_YES: solved. PL_NO: det A is zero. PL_UNKNOWN: too large (max_terms in any
// minor) or the tower gave up; x untouched.
pl_answer3 pl_alg_solve(pl_tower* t, int n, const pl_expr* A, const pl_expr* b, pl_expr* x,
                        long max_terms);
// poison when too large
pl_expr pl_alg_det(pl_tower* t, int n, const pl_expr* A, long max_terms);
// Rank over the field (generic point). rows: indices of a maximal independent set, the first rows
// preferred.
int pl_alg_rank(pl_tower* t, int m, int n, const pl_expr* A, int* rows);
// Row dependency: coefficients c (m) with sum c_i row_i = row_k over the other independent rows;
// PL_NO if there is none.
pl_answer3 pl_alg_dependency(pl_tower* t, int m, int n, const pl_expr* A, int k, pl_expr* c);

// ---------------------------------------------------------------------------------- series, limits
// e around x = at (or x -> infinity when at is PL_INFINITY): the exponent of the first term in
// *lead, then coefficients of (x - at)^(lead + k), k = 0 .. n-1 (of x^-(lead+k) at infinity). false
// when not found.
bool pl_alg_series(pl_tower* t, pl_expr e, pl_symbol x, pl_expr at, int n, int* lead,
                   pl_expr* coefficient);
// Limit from above.  Poison when not found; PL_INFINITY or its negative when it diverges.
pl_expr pl_alg_limit(pl_tower* t, pl_expr e, pl_symbol x, pl_expr to);
// Antiderivative of polynomials in x, times exp, sin, cos of linear arguments; poison when not
// found.
pl_expr pl_alg_integral(pl_tower* t, pl_expr e, pl_symbol x);

// ----------------------------------------------------------------------------------------- domains
// A domain to draw points from: free symbols with their facts, then defined symbols in order (x1 :=
// r cos φ), then unknowns found by solving a linear system numerically (accelerations,
// multipliers): A u = b.
typedef struct pl_definition {
  pl_symbol symbol;
  pl_expr value;
} pl_definition;
typedef struct pl_domain {
  const pl_fact* facts;
  int n_facts;
  const pl_definition* definitions;
  int n_definitions;
  // A row-major; may be 0
  int n_unknowns;
  const pl_symbol* unknowns;
  const pl_expr* A;
  const pl_expr* b;
} pl_domain;

#endif
