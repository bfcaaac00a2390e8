// The step program (jit.h): what a step computes from a point to the next, for one set of
// constraints in force, as straight-line code on one block of memory. For files of this folder.
//
// Codes, in the order in which a step uses them:
//   place     t, q -> nodes of q and t, g, G, dg/dt, M, and the factor of [M G^T; G 0]
//   correct_q, correct_v    corrections of the projection from g, or G v + dg/dt, with that factor
//   speed     G v + dg/dt and its size
//   inverse   the factor's inverse, when the system is small
//   start     order 0 of the series: forces, a_0, λ_0
//   order     order k >= 1
//   norms     of the rows that the length of a step is found from
//   advance   the series at the end of a step
//   energy    kinetic and potential energy at the point
// The factor is L D L^T without pivoting in an order found once: coordinates first, then
// constraints. Where its pivots fade the point goes through the patterns (assemble.c, kkt.c), which
// pivot.
#ifndef PL_STEP_PROGRAM_IMPL_H
#define PL_STEP_PROGRAM_IMPL_H

#include "jit/jit.h"
#include "solve/stepper/taylor/taylor_impl.h"

enum {
  PL_STEP_UNKNOWNS = 100,  // largest system: above, compiling takes longer than most runs
  PL_STEP_INVERSE = 24,    // so many unknowns are solved for by a product with the inverse
  // operations over all orders up to which these are written out one by one
  PL_STEP_WRITTEN_OUT = 4500,
  PL_STEP_NODES = 6000  // of all instances together
};

typedef enum pl_step_part {
  PL_PART_POSITION,
  PL_PART_CORRECT_Q,
  PL_PART_VELOCITY,
  PL_PART_CORRECT_V,
  PL_PART_INVERSE,
  PL_PART_START,
  PL_PART_ORDER,
  PL_PART_NORMS,
  PL_PART_ADVANCE,
  PL_PART_ENERGY,
  PL_N_PARTS
} pl_step_part;

// nodes term[first ..]
typedef struct pl_step_entry {
  int row, col, first, n, cell;
} pl_step_entry;

typedef struct pl_constant_cell {
  int cell;
  pl_parts x;
} pl_constant_cell;
// as the cell `from`; x where that is -1
typedef struct pl_scale_cell {
  int cell, from;
  double x;
} pl_scale_cell;

struct pl_step_program {
  pl_prog* code[PL_N_PARTS];
  pl_prog_run* compiled[PL_N_PARTS];  // NULL: interpreted
  pl_jit_code* jit;
  bool tried;   // to compile
  bool usable;  // false: this mode goes through the patterns
  bool* taken;  // which constraints it was made for               (n_c)
  pl_step_program* next;
  double* m;            // the memory
  int size, orders;     // rows of each series: 0 .. orders - 1
  int n_q, n_c, n;      // n: unknowns
  int n_mass, n_taken;  // the first have a mass, the last are constraints

  // places in memory
  int time, ratio, rest;    // t and its derivative; 1/k rounded, and what rounding left
  int Q, V, A, L;           // series, row by row
  int q_floor, v_floor;     // sizes of coordinates and velocities                (n_q)
  int g, g_size, argument;  // constraint values, sizes, as in pl_run            (n_c)
  int r, r_size;            // G v + dg/dt                                       (n_c)
  int norms;                // pl_block_rows of Q, then of V
  // of a step; the state there                          (1, n_q, n_q)
  int length, end_q, end_v;
  // accelerations of the series there; what these are off by, how large they are   (n_q, 2)
  int end_a, off;
  bool arrived;           // order 0 of the end of the step that is tried stands in memory
  int energy;             // kinetic, potential, what is conserved if that is not their sum
  int h;                  // forces at order 0                                 (n_q)
  int pivot, pivot_size;  // of the unknowns: pivot, sum of what was subtracted          (n)
  int move;               // correction of the coordinates                     (n_q)
  int vector, result, matrix, identity;  // of the product with the inverse

  // unknowns: coordinates that something determines, then constraints taken
  int *of_coordinate, *of_constraint;  // unknown, -1 none
  int* index;                          // coordinate or constraint of each unknown
  double* size_most;                   // largest pivot_size met                              (n)
  double fade_best;

  // for extended precision
  int inverse_up_to;                   // unknowns up to which the inverse is formed
  PL_VEC(pl_constant_cell) constants;  // what stands in memory from the start and is no double
  PL_VEC(pl_scale_cell) scales;
};

// ---- step_program_run.c
pl_step_program* pl_step_program_for_mode(pl_run* run);
// Order 0 at a point that is known to be sound.
bool pl_step_program_enter_at(pl_run* run, double t, const double* q, const double* v);

// ---- step_program_make.c
bool pl_step_program_fits(const pl_run* run);
// Codes for numbers of this type, which are interpreted; NULL: doubles.
pl_step_program* pl_step_program_make_for(pl_run* run, const pl_real* real);

// ---- step_program_factor.c: L D L^T of a sparse symmetric system as code
typedef struct pl_step_elimination {
  int n;
  int* order;  // unknown that is eliminated as number i
  // place in memory of L[i][j], i > j, in order of elimination; -1 zero: cell[i * n + j]
  int* cell;
  int inverse_d;  // 1 / D_i
} pl_step_elimination;
// Unknowns: n_mass coordinates with a mass, then the other coordinates up to n_coordinates, then
// constraints. NULL when no order of elimination is seen from the structure.
pl_step_elimination* pl_step_elimination_make(pl_arena* a, const bool* entry, int n, int n_mass,
                                              int n_coordinates, int* memory);
// entry[i * n + j]: register of the matrix at unknowns i, j (-1 zero), lower or upper half; pivots
// and sums of what was subtracted go to pivot[i], size[i], registers by unknown.
void pl_step_elimination_factor(const pl_step_elimination* e, pl_prog* c, const int* entry,
                                int* pivot, int* size);
// registers by unknown; -1 zero
void pl_step_elimination_solve(const pl_step_elimination* e, pl_prog* c, int* x);

// ---- step_program_make.c, step_program_run.c: the step program
pl_step_program* pl_step_program_make(pl_run* run);  // not usable when it does not fit
// the step program for the constraints that are taken, compiled if it pays
void pl_step_program_update(pl_run* run);
bool pl_step_program_is_compiled(const pl_run* run);
void pl_step_program_free(pl_run* run);
// false: not this way
bool pl_step_program_project(pl_run* run, double t, double* q, double* v, pl_projection* p);
bool pl_step_program_enter(pl_run* run);
void pl_step_program_expand(pl_run* run);
void pl_step_program_norms(pl_run* run, const double** q, const double** v);  // of pl_block_rows
void pl_step_program_advance(pl_run* run, double dt, double* q, double* v);
// Order 0 after pl_step_program_project; how large its accelerations are, and what those of the
// series were off by after pl_step_program_advance.
void pl_step_program_arrive(pl_run* run, double* off, double* size);
// accelerations of the series after pl_step_program_advance
void pl_step_program_end_a(const pl_run* run, double* a);
// T, V and what is conserved, at the point; false: not this way.
bool pl_step_program_energy(pl_run* run, double* kinetic, double* potential, double* all);

// ---- step_program_save.c
void pl_step_program_save(pl_run* run, pl_keeper* k);

#endif
