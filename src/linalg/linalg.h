// linalg: dense factorisations with pivoting, a sparse LU (KLU), roots of polynomials on an interval.
// Matrices are column-major.  Kernels work on raw arrays that the caller reserved; nothing is allocated.
#ifndef PL_LINALG_H
#define PL_LINALG_H

#include "base/base.h"

// ---------------------------------------------------------------------------------------------- dense
// LU with partial pivoting and row scaling, in place: A (n x n) becomes L\U, p (n) the rows chosen, scale (n) work.
// Returns the ratio of the smallest to the largest pivot of the scaled matrix, 0 when it is singular or not finite.
double pl_lu_factor(double* A, int* p, double* scale, int n);
// Solves A x = b in place.  work (n).
void pl_lu_solve(const double* LU, const int* p, const double* scale, double* b, double* work, int n);

// Symmetric indefinite A = P L D L^T P^T after Bunch and Kaufman 1977; the lower triangle is used and overwritten.
// p (n): pivot rows; negative marks 2 x 2 blocks.  Returns the smallest |pivot| over the largest, 0 if singular.
double pl_ldlt_factor(double* A, int* p, int n);
void pl_ldlt_solve(const double* A, const int* p, double* b, int n);

// QR with column pivoting (Businger and Golub 1965) of A (m x n), in place: R above, Householder vectors below.
// jpvt (n): column order; tau (min(m,n)); norm (2 n) work.  Returns the rank: diagonals above rel * the largest.
int pl_qr_factor(double* A, int* jpvt, double* tau, double* norm, int m, int n, double rel);
void pl_qr_apply_qt(const double* A, const double* tau, double* b, int m, int k);   // b := Q^T b with k reflectors
// Least squares with a QR of rank k: b (m) becomes Q^T b with the solution in its first k entries, in order of jpvt.
void pl_qr_least_squares(const double* A, const double* tau, double* b, int m, int k);

// Maximal independent subset of the rows of A (m x n, row-major here: row r at A + r * n; overwritten).  Rows are
// scaled to length 1, then taken by priority (lower first) and, within one priority, by what is left of them after
// projection on those taken (modified Gram-Schmidt, twice).  taken[r] is set; a row is left out when less than rel of
// it is left.
// *smallest: the smallest remainder among rows taken (1 if none).  Returns the number taken.  work (m).
int pl_independent_rows(double* A, const int* priority, bool* taken, double* work, int m, int n, double rel,
                        double* smallest);

// ---------------------------------------------------------------------------------------------- sparse
// LU of a matrix with fixed structure, through KLU.  The structure is analysed once; numbers change every step.
typedef struct pl_sparse pl_sparse;

// pl_sparse_make: n x n, compressed columns: start (n+1), row (start[n]), rows ascending in each column.  The arrays
// are kept.  NULL when the structure is singular or memory is short; pl_sparse_free gives back what the library took.
pl_sparse* pl_sparse_make(pl_arena* a, int n, const int* start, const int* row);
void pl_sparse_free(pl_sparse* s);
// Factors with the values given; keeps the pivot order of last time while it serves.  false: singular.
bool pl_sparse_factor(pl_sparse* s, const double* value);
void pl_sparse_solve(pl_sparse* s, double* b);       // in place
double pl_sparse_rcond(pl_sparse* s);                // cheap estimate of the pivot ratio

// ---------------------------------------------------------------------------------------------- roots
// Earliest root in (0, 1] of a polynomial c_0 + c_1 x + ... + c_n x^n; work has room for PL_ROOT_WORK(n).
// direction: +1 only crossings from below, -1 from above, 0 both (a touching root counts only for 0).
// Isolation by Bernstein coefficients and Descartes' rule (Collins and Akritas 1976, Lane and Riesenfeld 1981), then
// Newton with bisection.  Returns -1 when there is none.
#define PL_ROOT_WORK(n) (64 * ((size_t)(n) + 1))
double pl_first_root(const double* c, int n, int direction, double* work);

#endif
