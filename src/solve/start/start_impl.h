// Inside of the consistent start: a search over guesses, one solve with given values held.
#ifndef PL_START_IMPL_H
#define PL_START_IMPL_H

#include "solve/start/start.h"

struct pl_start {
  pl_run* run;
  double *q, *v;          // the numbers worked on                    (n_q)
  bool *held_q, *held_v;  // given                                     (n_q)
  double* try_q;          // for the line search                       (n_q)
  double* solutions;      // distinct ones, one after the other        (room x n_q)
  bool* solution_on;      // contacts of each                          (room x n_c)
  int n_solutions;
  bool* sits;            // one-sided, closed without being given     (n_c)
  bool* before_on;       // contacts before velocities were looked at (n_c)
  bool on_maps;          // with the contacts that maps take for granted
  int worst_constraint;  // of the last solve that failed
  double worst;          // its relative residual
  int below;             // one-sided constraint that given values put on the wrong side, -1
};

enum { PL_START_ROOM = 16 };

// ---- start_solve.c
// Gauss-Newton from s->q; true: met to 1e-9
bool pl_start_positions(pl_start* s, const bool* held);
bool pl_start_velocities(pl_start* s, const bool* held);  // least norm in the mass metric
// independent active rows in what is not held
int pl_start_rank(pl_start* s, const bool* held);
double pl_start_residual(pl_start* s, const double* q, int* worst);

#endif
