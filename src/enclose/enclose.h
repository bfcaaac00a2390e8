// certify: a proven enclosure of a motion. Ball arithmetic (Arb) takes the model as written (exact
// decimals, π, exact start values) to intervals that contain the true motion, or says why it
// cannot.
//
// Each step is a Taylor series in balls whose tail is bounded by Cauchy's estimate on a disk of
// complex times; that the motion exists there, and how far it gets, is proved by Picard's operator
// in disk arithmetic [Moore1966], [Tucker2011], [Johansson2017]. How initial boxes turn is followed
// by a frame [Lohner1987], [NedialkovJacksonCorliss1999]. docs/decisions/0011-certify.md tells why
// each inclusion holds.
//
// Needs the setup of a simulation, what its numbers are exactly, and the start that the simulation
// found.
#ifndef PL_ENCLOSE_H
#define PL_ENCLOSE_H

#include "solve/solve.h"

// What is to be enclosed.  All arrays belong to the caller.
typedef struct pl_certify_problem {
  pl_pool* pool;
  const pl_setup* setup;
  const pl_expr* coordinates;  // atoms of the coordinates: symbols and elements      (n_q)
  // of each symbol: its exact value, poison if none     (n_symbols, by id)
  const pl_expr* exact;
  int n_symbols;
  const pl_expr *q_start, *v_start;  // exact start values; poison: the constraints decide  (n_q)
  const double *q_run, *v_run;       // the start that the simulation found                 (n_q)
  const bool* active;                // constraints that hold at the start                  (n_c)
  const bool* implied;               // follows from the others by algebra                  (n_c)
  pl_expr t_0;                       // exact
  int n_times;
  // exact, in the order of the motion; the last is its end   (n_times)
  const pl_expr* times;
  // largest half width wanted, relative to the largest coordinate, or velocity
  double width;
  long budget;  // units of work; 0: the default
  void (*progress)(void* user, double t, double t_end, double h, long steps);  // or NULL
  void* progress_user;
} pl_certify_problem;

// Why there is no enclosure, or none further on.
typedef enum pl_certify_end {
  PL_CERTIFIED,          // everything that was asked for
  PL_CERTIFY_TOO_LARGE,  // too many unknowns or operations
  PL_CERTIFY_NO_EXACT,   // a number of the model is not exact
  PL_CERTIFY_REDUNDANT,  // constraints that may depend on each other
  PL_CERTIFY_START,      // no proof that the start exists
  PL_CERTIFY_ELSEWHERE,  // the start proved is not that of the simulation
  // no step can be proved: singular, or a function at the end of its domain
  PL_CERTIFY_STEP,
  PL_CERTIFY_BUDGET,  // the work that is allowed is used up
  PL_CERTIFY_WIDE,    // the enclosure is wider than asked for
  PL_CERTIFY_INTERRUPTED,
  PL_CERTIFY_WATCH,      // an event speaks of forces or accelerations
  PL_CERTIFY_IMPACT,     // a contact is met; impacts are not followed
  PL_CERTIFY_UNDECIDED,  // a contact or event that is grazed, or several at one time
  PL_N_CERTIFY_ENDS
} pl_certify_end;

typedef enum pl_certify_kind { PL_CERTIFY_Q, PL_CERTIFY_V, PL_CERTIFY_LAMBDA } pl_certify_kind;

// What happened on the way, at a time that is enclosed.
typedef enum pl_happening_kind {
  PL_HAPPENED_RELEASE,
  PL_HAPPENED_EVENT,
  PL_HAPPENED_STOP,
  PL_HAPPENED_IMPACT
} pl_happening_kind;
// of the constraint, of the event
typedef struct pl_happening {
  pl_happening_kind kind;
  int index;
} pl_happening;

typedef struct pl_certified {
  pl_certify_end end;
  bool stopped;  // by an event: time number n_done - 1 is that of the event
  int n_happened;
  const pl_happening* happened;
  int n_done;         // times that are enclosed, from the first
  double t_reached;   // the motion is enclosed up to here, NaN: nowhere
  double width;       // largest half width over all times done, relative as in the problem
  long steps;         // of the last pass
  int order, passes;  // highest order; passes with growing precision
  long bits;          // working precision of the last pass
  // log2 of the growth of the half width over the motion: what wrapping and the motion cost
  double bits_lost;
  // coordinates that nothing determines: taken from the simulation's start, as exact numbers
  int n_pinned;
  const int* pinned;
  // start values that do not meet the constraints exactly: moved by at most `moved`
  int n_moved;
  const int* moved_q;  // coordinate, + n_q for a velocity
  double moved;        // relative
  const char* what;    // name that belongs to `end`, or NULL
  struct pl_certified_balls* balls;
} pl_certified;

// pl_verify proves what it can. *out is always set; free it with pl_certified_free. Deterministic.
pleuel_status pl_certify_motion(pl_job* job, const pl_certify_problem* p, pl_certified* out);
void pl_certified_free(pl_certified* c);

// The true value at time number `time` lies within *radius of the decimal number that is returned
// (in the arena). NULL: not determined (multiplier of a constraint that does not act).
const char* pl_certified_ball(const pl_certified* c, pl_arena* a, int time, pl_certify_kind kind,
                              int i, double* radius);
// A coordinate (velocity) at the time of a happening.
const char* pl_certified_state(const pl_certified* c, pl_arena* a, int happening,
                               pl_certify_kind kind, int i, double* radius);
// The time of a happening, and bounds of how far t is from it.
const char* pl_certified_time(const pl_certified* c, pl_arena* a, int happening, double* radius);
double pl_certified_time_error(const pl_certified* c, int happening, double t);
// An upper bound of |x - true value|; NaN where it is not determined.
double pl_certified_error(const pl_certified* c, int time, pl_certify_kind kind, int i, double x);
// A lower bound of it: 0 when x may be the true value.
double pl_certified_error_least(const pl_certified* c, int time, pl_certify_kind kind, int i,
                                double x);

#endif
