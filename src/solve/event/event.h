// Events of a motion: what is watched for roots on a step, contacts and friction at a moment of
// change, switching points of forces, singular positions.
#ifndef PL_EVENT_H
#define PL_EVENT_H

#include "solve/stepper/stepper.h"

// A decision at a moment of change: whether a contact holds, how a friction goes on.
typedef enum pl_choice {
  PL_CHOICE_OPEN,
  PL_CHOICE_CLOSED,
  PL_CHOICE_STICK,
  PL_CHOICE_SLIP  // with way and press: PL_CHOICE_SLIP + (way < 0) + 2 (press < 0)
} pl_choice;
enum {
  PL_FRICTION_AT_REST = 1 << 8
};  // beside the choices left to a friction: there is no slip now
typedef struct pl_decision {
  bool of_friction;
  int index;         // constraint or friction
  unsigned allowed;  // bits of the choices
  int choice;
} pl_decision;

// Something that is watched for a root on a step: a release, a landing or an event.
typedef enum pl_watch_kind {
  PL_WATCH_RELEASE,
  PL_WATCH_LANDING,
  PL_WATCH_STICK,  // the slip velocity of a friction reaches zero
  PL_WATCH_SLIP,   // the force that holds it reaches its limit
  PL_WATCH_PRESS,  // the multiplier that presses changes its sign while it slips
  PL_WATCH_EVENT
} pl_watch_kind;
typedef struct pl_watch {
  pl_watch_kind kind;
  int index;      // constraint, friction or event
  int direction;  // +1 rising, -1 falling, 0 both
  // number of leading coefficients that vanish because the event is at this point
  int fresh;
  int side;  // sign on which it is known to be; 0 unknown
} pl_watch;

// how small the smallest pivot was, and when
typedef struct pl_fade {
  double t, smallest;
} pl_fade;

// How often an event has changed the motion in ever shorter time: when last, after how long, the
// longest of these times.
typedef struct pl_repeat {
  double t, gap, widest;
  long n;
} pl_repeat;

// A place in a program that has branches: node a (or a - b) changes sign at the switching point.
typedef struct pl_switch {
  const pl_batch* batch;
  int a, b, lane;
} pl_switch;

typedef struct pl_indeterminate pl_indeterminate;
typedef struct pl_events {
  // watching
  pl_watch* watch;
  int n_watch;
  double *poly, *root_work;
  bool* hit;       // (n_watch)
  double* root;    // (n_watch)
  bool* touch;     // the root only touches    (n_watch)
  bool undecided;  // what is watched may be zero just at the end of the step
  int sunk;        // constraint that the step went through, unseen; -1 none
  // dense series of what is watched
  double* G_series;  // g of each constraint: coefficient k at k n_c
  double* W_series;  // watched quantities: coefficient k at k n_watched
  double* S_series;  // G v + dg/dt of slip: order k at k n_c
  double* poly_2;    // for products of series
  double* W_coef;    // values of watched quantities at a point   (n_watched)
  pl_switch* switches;
  int n_switches;
  double* K_series;  // of what changes sign: coefficient k of switching point i at i order + k
  pl_friction_state* friction_before;  // at the point before a mode change
  // of them all that are met, also if they open at once                (n_c)
  bool* met;
  bool* on_before;               // (n_c)
  unsigned* fixed;               // choices that an event leaves to a contact, 0: all   (n_c)
  unsigned* friction_fixed;      // the same for frictions                          (n_frictions)
  bool* jumped;                  // had an impact                                   (n_c)
  double* approach;              // velocity along g before an impact               (n_c)
  double *second, *second_size;  // g'' of constraints, derivative of slip   (n_c)
  double *hold_q, *hold_v;       // the point that decisions are tried at           (n_q)
  double* first_a;               // accelerations of the first consistent set       (n_q)
  pl_decision* decision;         // (n_c + n_frictions)
  int* choice_kept;
  int n_decisions;
  double* fastest;    // largest approach that a contact has seen        (n_c)
  double* bounce_t;   // times of its last three impacts                 (3 n_c)
  long* bounces;      // how many one after the other                    (n_c)
  pl_repeat* repeat;  // (n_events)
  double* settled_t;  // end of its infinitely many bounces, NaN         (n_c)
  double *save_q, *save_v, *save_a, *save_l;  // the point before a mode change
  bool* save_unique;
  double* impulse;          // (n_c)
  double *jump_v, *jump_q;  // (n_q)
  // so far; of the last one the rows in force and the factor of their rebound   (n_c)
  long impacts;
  bool* impact_taken;
  double* impact_factor;
  pl_indeterminate* indeterminate;  // NULL without contacts and friction
  int mode_changes;                 // in a row without progress
  double mode_change_t;
  double smallest_here, t_before;  // at the point, at the one before, its time
  pl_fade fade[2];
  double reach;      // from the point to the singular position that a leap passes
  double h_regular;  // step that the series allowed last where the pivots were large
} pl_events;

// ---- event_make.c
void pl_events_make(pl_run* run);

// ---- watch.c
void pl_watch_make(pl_run* run);
void pl_watch_series(pl_run* run);  // after pl_series_expand
// earliest root in (0, h], hit[] says who; -1 none
double pl_watch_first(pl_run* run, double h);
// up to h, where the series of all that is watched are known
double pl_watch_reach(pl_run* run, double h);
double pl_watch_known(double* c, int n, double noise, double part);
// events that end the step that is tried at x h are zero there
bool pl_watch_holds(pl_run* run, double h, double x);
// events between the stages of an implicit step are as they say
bool pl_watch_is_followed(pl_run* run, double h);
void pl_watch_forget(pl_run* run);            // all sides unknown: after a start or a jump
void pl_watch_passed(pl_run* run, double h);  // the step h was taken: sides at its end
pl_watch* pl_watch_of(pl_run* run, pl_watch_kind kind, int index);
double pl_watch_force_noise(const pl_run* run, int c);  // rounding error of λ_c
// what of a watched value is rounding
double pl_watch_noise(const pl_run* run, const pl_watch* w, double h);

// ---- watch_friction.c
void pl_watch_friction_make(pl_run* run);
// In space a slip that ends at the end of this step keeps the direction it had.
void pl_watch_friction_directions(pl_run* run);
// Series of what is watched of friction r.
int pl_watch_friction(const pl_run* run, int r, pl_watch_kind kind, double* c, int n);

// ---- switching.c
void pl_switching_make(pl_run* run);
void pl_switching_series(pl_run* run);  // after pl_series_expand
double pl_switching_value(const pl_run* run, int i);
double pl_switching_reach(pl_run* run, double h);  // as pl_watch_reach
// just behind the first switching point, in units of h; -1 none on the step
double pl_switching_first(pl_run* run, double h);

// ---- contacts.c: which contacts hold, which surfaces stick
// velocities along g and of slip; r_size
void pl_contacts_rates(pl_run* run, double* rates);
// velocities after an impact, if something arrives
pleuel_status pl_contacts_impact(pl_run* run, bool* any);
// the mode whose accelerations and forces fit together
pleuel_status pl_contacts_settle(pl_run* run);

// ---- indeterminate.c: statically indeterminate forces
void pl_indeterminate_make(pl_run* run);
void pl_indeterminate_mark(pl_run* run);    // at the begin of a mode
void pl_indeterminate_report(pl_run* run);  // in the statistics

// ---- modes.c
pleuel_status pl_modes_enter(pl_run* run);                 // the point in the mode that on[] says
pleuel_status pl_modes_check(pl_run* run, bool at_start);  // contacts that pull are released
pleuel_status pl_modes_handle(pl_run* run);                // what hit[] says, at the point
// what counts as small where the start rests
void pl_modes_size_rest(pl_run* run);

// ---- singular.c
void pl_singular_watch(pl_run* run);  // at every point
bool pl_is_singular(const pl_run* run);
pleuel_status pl_run_singular(pl_run* run);  // fails with the place
// fails where a coordinate of the energies has no equation: L = x x'
pleuel_status pl_run_left_open(pl_run* run);
// fails with the reason why there are no accelerations
pleuel_status pl_run_undetermined(pl_run* run);
// fails with the reason why no step is short enough; h was tried
pleuel_status pl_run_too_small(pl_run* run, double h);
bool pl_singular_leap(pl_run* run, double left, double* length, pl_projection* p);
pleuel_status pl_singular_record(pl_run* run);

#endif
