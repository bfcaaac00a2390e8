// Inside of the driver: output of rows, derivatives through events, which steppers a run has.
#ifndef PL_DRIVER_IMPL_H
#define PL_DRIVER_IMPL_H

#include "solve/event/event.h"
#include "solve/stepper/stepper.h"

// Rows on their way to the sink.
typedef struct pl_output_state {
  // rows
  double *out_now, *out_before;
  char *mode, *mode_before;
  size_t mode_size;
  bool opened, begun, ended;
  bool refused;       // the sink wants no more rows
  double last_row_t;  // of a row that was not one before an event; NaN
} pl_output_state;

// ---- output.c
extern const pl_observer pl_output_observer;
void pl_output_make(pl_run* run);
pleuel_status pl_output_open(pl_run* run);  // begin of the sink
pleuel_status pl_output_begin(pl_run* run);
pleuel_status pl_output_point(pl_run* run, pl_row_kind kind);  // the point itself
// grid times in (t_from, t_to)
pleuel_status pl_output_grid(pl_run* run, double t_from, double t_to);
pl_row pl_output_row(pl_run* run, pl_row_kind kind, double* out, char* mode);
// remembers the point before a mode change
void pl_output_before(pl_run* run);
// An event whose state, in row_q and row_v, is not that of the point.
pleuel_status pl_output_event_beside(pl_run* run, pl_event_record e, double t, const double* a,
                                     const double* lambda);
// energy at the point, drift
void pl_output_energy(pl_run* run, bool anew);
// The mode as text: "contact(h)", "free".
void pl_output_mode(const pl_run* run, char* out);

// ---- sensitivity.c: derivatives through contacts and events
typedef struct pl_sensitivity pl_sensitivity;
// What the driver asks of a lead run, without knowing how it leads.
typedef struct pl_lead {
  const char* (*mode)(const pl_sensitivity* p);  // as text, until the moment ahead
  bool (*waits)(const pl_sensitivity* p);        // for the follower
  pleuel_status (*begin)(pl_sensitivity* p);     // reports what happened at the start
  // A step of the follower; of = what takes one.
  pleuel_status (*step)(pl_sensitivity* p, pleuel_status (*of)(pl_run* run));
  void (*save)(pl_sensitivity* p, pl_keeper* k);
  pleuel_status (*load)(pl_sensitivity* p, pl_keeper* k);
  void (*close)(pl_sensitivity* p);
} pl_lead;

// ---- steppers.c: which steppers a run has
void pl_steppers_choose(pl_run* run);

#endif
