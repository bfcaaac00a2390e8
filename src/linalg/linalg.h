// linalg: dense factorisations with pivoting, a sparse LU (KLU), roots of polynomials on an
// interval. Matrices are column-major. Kernels work on raw arrays that the caller reserved; nothing
// is allocated.
#ifndef PL_LINALG_H
#define PL_LINALG_H

#include "base/base.h"

// ------------------------------------------------------------------------------------------- dense
// LU with partial pivoting and row scaling, in place: A (n x n) becomes L\U, p (n) the rows chosen,
// scale (n) work. Returns the ratio of the smallest to the largest pivot of the scaled matrix, 0
// when it is singular or not finite.
double pl_lu_factor(double* A, int* p, double* scale, int n);
// Solves A x = b in place.  work (n).
void pl_lu_solve(const double* LU, const int* p, const double* scale, double* b, double* work,
                 int n);

// The same for a complex matrix, re and im alternating: entry (i, j) at A[2 (i + j n)], b (2 n).
double pl_zlu_factor(double* A, int* p, double* scale, int n);
void pl_zlu_solve(const double* LU, const int* p, const double* scale, double* b, int n);

// Symmetric indefinite A = P L D L^T P^T [BunchKaufman1977]; the lower triangle is used
// and overwritten. p (n): pivot rows; negative marks 2 x 2 blocks. Returns the smallest |pivot|
// over the largest, 0 if singular.
double pl_ldlt_factor(double* A, int* p, int n);
void pl_ldlt_solve(const double* A, const int* p, double* b, int n);

// QR with column pivoting [BusingerGolub1965] of A (m x n), in place: R above, Householder
// vectors below. jpvt (n): column order; tau (min(m,n)); norm (2 n) work. Returns the rank:
// diagonals above rel * the largest.
int pl_qr_factor(double* A, int* jpvt, double* tau, double* norm, int m, int n, double rel);
// Least squares with a QR of rank k: b (m) becomes Q^T b with the solution in its first k entries,
// in order of jpvt.
void pl_qr_least_squares(const double* A, const double* tau, double* b, int m, int k);

// Maximal independent subset of the rows of A (m x n, row-major here: row r at A + r * n;
// overwritten). Rows are scaled to length 1, then taken by priority (lower first) and, within one
// priority, by what is left of them after projection on those taken (modified Gram-Schmidt,
// twice). taken[r] is set; a row is left out when less than rel of it is left. *smallest: the
// smallest remainder among rows taken (1 if none). Returns the number taken. work (m).
int pl_independent_rows(double* A, const int* priority, bool* taken, double* work, int m, int n,
                        double rel, double* smallest);

// ------------------------------------------------------------------------------------------ sparse
// LU of a matrix with fixed structure, through KLU. The structure is analysed once; numbers change
// every step.
typedef struct pl_sparse pl_sparse;

// pl_sparse_make: n x n, compressed columns: start (n+1), row (start[n]), rows ascending in each
// column. The arrays are kept. NULL when the structure is singular or memory is short;
// pl_sparse_free gives back what the library took.
pl_sparse* pl_sparse_make(pl_arena* a, int n, const int* start, const int* row);
void pl_sparse_free(pl_sparse* s);
// Factors with the values given; keeps the pivot order of last time while it serves. false:
// singular.
bool pl_sparse_factor(pl_sparse* s, const double* value);
void pl_sparse_solve(pl_sparse* s, double* b);  // in place
double pl_sparse_rcond(pl_sparse* s);           // cheap estimate of the pivot ratio

// The same for a complex matrix, re and im alternating: value (2 start[n]), b (2 n).
typedef struct pl_zsparse pl_zsparse;
pl_zsparse* pl_zsparse_make(pl_arena* a, int n, const int* start, const int* row);
void pl_zsparse_free(pl_zsparse* s);
bool pl_zsparse_factor(pl_zsparse* s, const double* value);
void pl_zsparse_solve(pl_zsparse* s, double* b);
double pl_zsparse_rcond(pl_zsparse* s);
// operations of a real factorisation, as the analysis expects
double pl_zsparse_work(const pl_zsparse* s);
// the next factor finds a pivot order of its own
void pl_sparse_forget(pl_sparse* s);
// The pivot order that the next factor begins with, written down or read back (base.h).
void pl_sparse_keep(pl_sparse* s, pl_keeper* k);

// --------------------------------------------------------------------------------------- symmetric
// L D L^T of a symmetric matrix with fixed structure without pivoting, in an order found once that
// runs in lanes (symmetric.c).
typedef struct pl_symmetric pl_symmetric;
// What an unknown is decides when it is eliminated: coordinates with a mass, constraints, what is
// left.
enum { PL_UNKNOWN_MASS, PL_UNKNOWN_CONSTRAINT, PL_UNKNOWN_OTHER };

// pl_symmetric_make: as pl_sparse_make; every diagonal place is there, value (i, j) equals value
// (j, i). kind (n). NULL: the structure is not symmetric or fills in too much.
pl_symmetric* pl_symmetric_make(pl_arena* a, int n, const int* start, const int* row,
                                const unsigned char* kind);
// Returns the smallest part of a pivot that the subtractions have left; 0: a pivot is zero or no
// number, no solving.
double pl_symmetric_factor(pl_symmetric* s, const double* value);
void pl_symmetric_solve(pl_symmetric* s, double* b);  // in place

// ------------------------------------------------------------------------------------------- roots
// Every root in [0, 1] of c_0 + c_1 x + ... + c_n x^n, in order. The value at x is taken to be
// known to max(noise sum |c_k| x^k, floor): what stays below that counts as zero, so a double root
// that rounding has lifted or split is one root, which touches.
//
// A root where the sign before is that after only touches. A sign 0 is not known: the root lies at
// an end. At most room roots are given, the first ones; returns how many. work: PL_ROOT_WORK(n).
typedef struct pl_real_root {
  double x;
  int before, after;  // signs on both sides
} pl_real_root;
#define PL_ROOT_WORK(n) (4 * ((size_t)(n) + 2))
int pl_roots(const double* c, int n, double noise, double floor, pl_real_root* out, int room,
             double* work);
// What rounding of the coefficients and of the evaluation itself leaves open, as noise: half an ulp
// for each coefficient, Horner's bound 2 n ulps [Higham2002, 5.3] and as much again for the change
// of basis.
double pl_root_noise(int n);

// Earliest root in (0, 1]. direction: +1 only crossings from below, -1 from above, 0 both and
// touching ones. Returns -1 when there is none.
double pl_first_root(const double* c, int n, int direction, double* work);

#endif
