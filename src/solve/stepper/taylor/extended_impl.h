// A run on extended precision: the step program of the motion (step_program_impl.h) on memory of
// another type, in which the state lives from step to step. What the run shows and watches is its
// rounding. For files of this folder.
//
// Two types have a part in it: `state`, to which positions and velocities are rounded at the end of
// a step, and `fine`, in which the point, its projection and the orders below `low` are computed.
// In quad both are one, and `low` is the order. In long, the orders above are those of the ordinary
// programs in doubles, compiled where that pays: terms of order k are about e^(-2k) of the whole.
#ifndef PL_EXTENDED_IMPL_H
#define PL_EXTENDED_IMPL_H

#include "solve/stepper/taylor/step_program_impl.h"

// Values of a set of patterns at one point, for rows and events.
typedef struct pl_sheet {
  const pl_real* real;
  pl_prog* code;
  void* m;
  int time, Q, V, A, L, out;  // inputs, outputs
} pl_sheet;

typedef struct pl_extended pl_extended;
struct pl_extended {
  const pl_real *state, *fine;
  int low;             // orders below are fine
  bool by_doubles;     // orders from there on are those of run->taylor->program
  pl_step_program* o;  // for the constraints that are taken; its own memory is not used
  void* m;
  pl_prog *top, *head;   // one more coefficient of q; the series at `length`
  pl_prog* head_forces;  // accelerations and multipliers there
  // time at `length`; `length` to the end; both for the row whose n `way` is in `scratch`
  pl_prog *clock, *left, *grid;
  pl_prog* drift;     // energy and what it has changed, into `scratch`
  int t_0, q_0, v_0;  // where the series starts: two rows
  int end_a, end_l;   // of the series at `length`
  int a_0, l_0;       // and where it starts: one row
  bool arrived;       // order 0 of the end of the step that is tried stands in memory
  int tail_q, tail_v, tail_a, tail_l;  // the part of it that doubles give, divided by length^low
  int from, to, share;                 // time of row 0, of the end; row n is at n `way` / share
  pl_parts way;
  int scratch;  // n_q + 2 numbers
  int energy_base;
  pl_sheet *rows, *watched;
  pl_row_digits digits;
  double floor;              // what rounding of the state leaves of a residual
  bool held;                 // given start values are exact
  double part;               // of the best pivot of this mode that the smallest is now
  pl_step_program* high;     // programs in doubles for this mode, where by_doubles
  struct pl_extended* next;  // of another mode
};

// ---- extended_tape.c: tapes in extended numbers
// Constants of an instance: parts of its nodes of level CONST.
void pl_extended_constants(pl_arena* a, const pl_real* real, const pl_batch* b, int lane,
                           pl_parts* out);
// Values of the roots of a tape that has constants only.
void pl_extended_roots(pl_arena* a, const pl_real* real, const pl_tape* tape, pl_parts* out);
pl_sheet* pl_sheet_make(pl_run* run, const pl_real* real, const pl_batches* b, int n_out);
void pl_sheet_run(pl_sheet* s);

// ---- extended_make.c
// order and length of the steps from the tolerance
void pl_extended_order(pl_run* run);
const char* pl_extended_name(const pl_run* run);  // of its precision
// whether the run can be had; fails with what is not supported
pleuel_status pl_extended_check(pl_run* run);
// programs and memory, for the constraints that are taken
pleuel_status pl_extended_make(pl_run* run);
// Of dependent rows the better conditioned ones are taken.
void pl_extended_change_rows(pl_run* run);
// run->wide for the constraints that are taken; false: there are no programs
bool pl_extended_of_mode(pl_run* run);

// ---- extended_start.c
pleuel_status pl_extended_begin(pl_run* run, double t);  // from the start that was found in doubles

// ---- extended_run.c: as pl_motion_
void pl_extended_copy(const pl_real* to_type, void* to, int at, const pl_real* from_type,
                      const void* from, int from_at, int n);
bool pl_extended_enter(pl_run* run);
bool pl_extended_arrive(pl_run* run, double* off, double* size);  // pl_point_arrive
void pl_extended_expand(pl_run* run);
void pl_extended_norms(pl_run* run, const double** q, const double** v);
// the length of a step, where steps are not to keep time with the motion
double pl_extended_vary(const pl_run* run, double h);
// the state at the end of a step: trial_q, trial_v
void pl_extended_advance(pl_run* run, double dt);
bool pl_extended_project(pl_run* run, pl_projection* p);
void pl_extended_accept(pl_run* run, bool to_end);  // time
void pl_extended_sum(pl_run* run);                  // end_q, end_v, end_a, end_l at `length`
bool pl_extended_energy(pl_run* run, bool anew, pl_energy* e);
// After pl_extended_advance to the root of an event that was found in doubles: Newton to the digits
// of the type.
void pl_extended_refine(pl_run* run, double dt);

// ---- extended_output.c
void pl_extended_row(pl_run* run, pl_row* row, double* out);               // of the point
void pl_extended_grid_row(pl_run* run, long n, pl_row* row, double* out);  // of grid time n
void pl_extended_row_at(pl_run* run, double t, pl_row* row, double* out);  // on the step

// ---- extended_save.c
void pl_extended_save(pl_run* run, pl_keeper* k);

#endif
