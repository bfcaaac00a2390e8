// structured: a linear system for multipliers or accelerations whose entries have names.
//
//   S u = R,   S symmetric,   entries by name: A_k, B_k, R_k along a chain, S_jk, R_k in general
//
// structured.c finds the system, structured_solve.c solves it over the names,
// worked/structured_text.c shows it.
#ifndef PL_STRUCTURED_H
#define PL_STRUCTURED_H

#include "mechanics/mechanics.h"
#include "present/present.h"

typedef enum pl_structure_kind {
  PL_ST_MULTIPLIERS,   // (G M^-1 G^T) λ = R
  PL_ST_BOTH,          // [M, -G^T; G, 0] (q'', λ) = R: where M is no matrix of small blocks
  PL_ST_ACCELERATIONS  // M q'' = R in generalized coordinates
} pl_structure_kind;

// One line: name = value.  Lines stand in the order in which they can be computed.
typedef struct pl_naming {
  pl_symbol name;
  pl_expr value;        // over earlier names; on the constraints (l1^2 where x1^2 + y1^2 stood)
  pl_expr exact;        // the same value off the constraints too: what points are drawn with
  pl_expr raw;          // of an entry: by differentiation of the model, the reference
  const pl_form* form;  // of value, as displayed
  int level;            // by which constraint, and which of its terms, value differs from exact; -1
} pl_naming;

struct pl_structure {
  pl_structure_kind kind;
  int n;
  pl_symbol* u;  // unknowns, numbered along the chain if it is one                       (n)
  int* bond;     // bond of each multiplier, -1 for an acceleration                       (n)
  // raw entries (n x n), (n)
  pl_expr *S, *R;
  // 0 where the entry vanishes (n x n), (n)
  pl_symbol *S_name, *R_name;
  // diagonal, beside it, right side, pivots, rows of the factor, reduced right side
  const char* letter[6];
  PL_VEC(pl_naming) lines;  // entries, then what the solution needs, then the unknowns
  int n_entries, n_pivots;  // lines of entries; then lines of the solution without the unknowns
  pl_expr* solution;        // of each unknown, over names                                   (n)
  int* pivot_order;         // rows in the order of elimination                              (n)
  bool chain;               // S is tridiagonal
  bool closed;              // solved over names without recursion
  bool natural;             // eliminated from the first row to the last
};

// Made when it is asked for first.  NULL when there is no such system.
pl_structure* pl_structure_of_multipliers(pl_analysis* d);
pl_structure* pl_structure_of_accelerations(pl_analysis* d);
// names in order, for the points of the motion
int pl_structure_definitions(pl_analysis* d, pl_definition* out, int max);
// structured_solve.c: lines and solution; false if S is singular
bool pl_structure_solve(pl_analysis* d, pl_structure* s);
// the shortest form of a value, which names are given to
const pl_form* pl_structure_form(pl_analysis* d, pl_expr e, pl_style style);
// letter, letter_j, letter_jk: from 0, -1 none
pl_symbol pl_structure_name(pl_analysis* d, const pl_structure* s, const char* letter, int j, int k,
                            pl_expr of);

// The parameter that a constraint determines on its level: l1 -> sqrt(x1^2 + y1^2).
bool pl_structure_level(pl_analysis* d, int level, pl_replace* out);

#endif
