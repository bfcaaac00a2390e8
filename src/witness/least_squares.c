// Least squares by QR with column pivoting; columns that depend on others get nothing.
#include "witness/least_squares.h"
#include "linalg/linalg.h"

struct pl_squares {
  double *A, *b, *tau, *norm;
  int* order;
};

static const double dependent = 1e-10;  // diagonals below, beside the largest

pl_squares* pl_squares_make(pl_arena* a, int most) {
  pl_squares* s = PL_NEW(a, pl_squares);
  *s = (pl_squares){PL_ARRAY(a, double, most* most + 1), PL_ARRAY(a, double, most + 1),
                    PL_ARRAY(a, double, most + 1), PL_ARRAY(a, double, 2 * most + 2),
                    PL_ARRAY(a, int, most + 1)};
  return s;
}

double* pl_squares_matrix(pl_squares* s) { return s->A; }
double* pl_squares_right(pl_squares* s) { return s->b; }
int pl_squares_rank(pl_squares* s, int m, int n, double rel) {
  return pl_qr_factor(s->A, s->order, s->tau, s->norm, m, n, rel);
}

void pl_squares_solve(pl_squares* s, int m, int n, double* x) {
  int rank = pl_squares_rank(s, m, n, dependent);
  pl_qr_least_squares(s->A, s->tau, s->b, m, rank);
  for (int j = 0; j < n; j++) x[j] = 0;
  for (int j = 0; j < rank; j++) x[s->order[j]] = s->b[j];
}
