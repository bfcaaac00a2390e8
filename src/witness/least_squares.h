// least_squares: small dense systems for searches. Stands apart from what sees algebra, whose names
// linalg shares.
#ifndef PL_LEAST_SQUARES_H
#define PL_LEAST_SQUARES_H

#include "base/base.h"

typedef struct pl_squares pl_squares;
pl_squares* pl_squares_make(pl_arena* a, int most);  // up to `most` rows and columns
// entry (i, j) of an m x n matrix at i + j m; overwritten
double* pl_squares_matrix(pl_squares* s);
double* pl_squares_right(pl_squares* s);  // (m); overwritten
int pl_squares_rank(pl_squares* s, int m, int n, double rel);
// The shortest correction of a basis of columns: A x = right in the least squares; x (n).
void pl_squares_solve(pl_squares* s, int m, int n, double* x);

#endif
