// Inside of the symmetric solver: what symmetric.c builds once and symmetric_kernels.c runs.
#ifndef PL_SYMMETRIC_IMPL_H
#define PL_SYMMETRIC_IMPL_H

#include "linalg/linalg.h"

enum { PL_SYMMETRIC_LANES = 32 };  // at most; 1 or a multiple of 8

// y_i = sum of A_ij x_j for rows i side by side in groups of eight.
typedef struct pl_symmetric_rows {
  int n_groups;
  int* first;     // entries of a group: first[g] .. first[g + 1] - 1
  int* base;      // of an entry: its eight x stand side by side from here; -1: at index
  int* index;     // (8 n)
  int* from;      // place of each number in the values of the matrix, -1: zero   (8 n)
  double* value;  // (8 n)
} pl_symmetric_rows;

// L D L^T of several systems of one structure side by side in lanes: m unknowns, and below them nb
// rows of a border that are not eliminated. Entries of L stand column by column, rows ascending,
// the border's last. The memory w holds, in units of `lanes` numbers: the diagonal (m), entries
// (n), products for the border (row b, column b' <= b at b (b + 1) / 2 + b').
typedef struct pl_symmetric_front {
  int lanes, m, nb, n;
  int *column, *row;  // of the entries: column[k] .. column[k + 1] - 1; row >= m: border
  // the same by rows, columns ascending           (m + nb + 1, n, n)
  int *row_start, *row_entry, *row_column;
  // for each column, its entries a and b <= a: unit that L_a D L_b is subtracted from
  int* pair;
  double *w, *inverse, *y;  // y (m + nb, in units): right side, solution
  double* d;                // the diagonal before elimination                                  (m)
} pl_symmetric_front;

struct pl_symmetric {
  int n, n_early, n_core;
  int *early, *core;        // which unknowns
  int early_run, core_run;  // the first of them when they follow each other, else -1
  // entries between both, by rows of the core, by rows of the early ones
  pl_symmetric_rows by_core, by_early;
  int* early_from;  // place of the diagonal                                           (n_early)
  double *early_inverse, *z, *x;    // padded to eight
  pl_symmetric_front main, border;  // the border of all lanes together, in one lane
  // of product unit u and lane l: number in memory of the border's front, -1 none
  int* to_border;
  int n_products;
  double* memory;  // of both fronts
  size_t n_memory;
  int* of_core;      // place of an unknown of the core in the solution of the fronts      (n_core)
  double* solution;  // y of main, then y of the border
  int n_direct, *direct_from, *direct_to;  // numbers of the core's own matrix
  // early ones: their entries to the core, and where the products of pairs go
  int *schur_start, *schur_from, *schur_to;
  int n_ones, *ones;  // places that hold 1: lanes that end early
  // of the border's slot b in lane l: number of the unknown in the border's front, -1 none
  int* slot_border;
};

typedef struct pl_symmetric_kernels {
  double (*factor)(pl_symmetric* s, const double* value);
  void (*solve)(pl_symmetric* s, double* b);
} pl_symmetric_kernels;
extern const pl_symmetric_kernels pl_symmetric_plain, pl_symmetric_avx2, pl_symmetric_avx512;

// ---- partition.c: parts of a graph, orders of elimination
typedef struct pl_graph {
  int n;
  int *start, *to;
} pl_graph;  // symmetric, without loops
// Cuts the graph into `parts` (a power of 2) parts that touch only through separators. part[i]: 0
// .. parts - 1, or -1; then i stands in separator[], those of the last cuts first. order[] lists
// the nodes of a part in order of elimination, part p at order[first[p]] .. Returns the number of
// separator nodes.
int pl_graph_cut(pl_arena* a, const pl_graph* g, int parts, int* part, int* separator, int* order,
                 int* first);
// order of elimination with little fill
bool pl_graph_least_degree(const pl_graph* g, int* order);

// ---- symmetric_front.c
typedef struct pl_int_list {
  PL_VEC(int) v;
} pl_int_list;
// below[k]: rows > k of column k, unsorted, repeats allowed; fills in.  false: too large.
bool pl_symmetric_front_make(pl_arena* a, pl_symmetric_front* f, int lanes, int m, int nb,
                             pl_int_list* below);
// unit in w, -1 none
int pl_symmetric_front_find(const pl_symmetric_front* f, int row, int column);

#endif
