// jet: truncated power series through a tape. jet[node][order][lane], the lane fastest: lanes are
// instances of a pattern or members of an ensemble. Coefficients are normalised: x(t) = sum x_k
// t^k.
//
// An order is computed in two phases: first, for every series operation, the sum over coefficients
// 1..k-1, which needs nothing of order k; then one linear sweep whose code is the same for every
// order. The interpreter here is the reference; a compiled kernel has the same signature
// (pl_kernel) and the same bits.
#ifndef PL_JET_H
#define PL_JET_H

#include "program/tape.h"

typedef struct pl_jet pl_jet;
enum { PL_JET_LANES = 128 };

// pl_kernel computes coefficient k of the nodes of one level. Orders below k of this level, and k
// of lower levels, must be there; inputs of order k too. all: also nodes that the motion does not
// need above order 0.
typedef void pl_kernel(pl_jet* jet, pl_tape_level level, int k, bool all);

struct pl_jet {
  const pl_tape* tape;
  int lanes;   // 1 or a multiple of 8 up to PL_JET_LANES
  int orders;  // coefficients 0 .. orders - 1 have room
  double* c;   // the coefficients
  // of each node: row of its order 0 in c, rows having `lanes` numbers
  size_t* at;
  const int* series[PL_N_LEVELS];  // series nodes of each level, those with .high first
  int n_series[PL_N_LEVELS], n_series_high[PL_N_LEVELS];
  pl_kernel* kernel;
};

// pl_jet_make reserves a jet and fills in the kernel of the interpreter. Nothing is allocated
// later.
pl_jet* pl_jet_make(pl_arena* a, const pl_tape* tape, int lanes, int orders);
// The same with room for orders 0 and 1 only where the motion needs no more: then no order above 1
// with `all`.
pl_jet* pl_jet_make_lean(pl_arena* a, const pl_tape* tape, int lanes, int orders);

// Coefficient k of a node, all its lanes.
static inline double* pl_jet_at(const pl_jet* j, int node, int k) {
  return j->c + (j->at[node] + (size_t)k) * (size_t)j->lanes;
}

// pl_jet_constants computes everything of level CONST. index[s * lanes + lane]: values of the index
// slots.
void pl_jet_constants(pl_jet* j, const double* index);

// pl_jet_time sets t and its derivative 1 in all lanes and orders.
void pl_jet_time(pl_jet* j, double t);

#endif
