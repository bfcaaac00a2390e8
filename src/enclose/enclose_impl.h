// certify, inside: balls and disks through the tapes, the system of a step, its pieces.
#ifndef PL_ENCLOSE_IMPL_H
#define PL_ENCLOSE_IMPL_H

#include "enclose/enclose.h"

#include <flint/flint.h>
#include <flint/fmpq.h>
#if __has_include(<flint/arb.h>)
#  include <flint/arb.h>
#  include <flint/arb_mat.h>
#else
#  include <arb.h>
#  include <arb_mat.h>
#endif

enum {
  PL_CERTIFY_UNKNOWNS = 80,    // coordinates and multipliers
  PL_CERTIFY_NODES = 40000,    // operations of all instances
  PL_CERTIFY_ORDER = 400,      // of a series
  PL_CERTIFY_CELLS = 6000000,  // operations times orders: memory
  PL_CERTIFY_HAPPENINGS = 64,  // events, contacts that let go
  PL_DISK_BITS = 64            // of the centres of disks
};

// ------------------------------------------------------------------------------------------- disks
// All complex numbers within r of a number of the real ball c. Operations include the image of
// every pair of points, so a program run in disks includes its values at all complex arguments of
// the disks it began with.
typedef struct pl_disk {
  arb_struct c;
  mag_struct r;
} pl_disk;

pl_disk* pl_disks_make(slong n);  // FLINT's memory
void pl_disks_free(pl_disk* d, slong n);
void pl_disk_set_ball(pl_disk* d, arb_srcptr c);
void pl_disk_bound(mag_t out, const pl_disk* d);  // of |z|
// d = op(a, b, c); false when the operation is not analytic on the disks, or a branch is not
// decided there.
bool pl_disk_op(pl_disk* d, pl_op op, const pl_disk* a, const pl_disk* b, const pl_disk* c);
// The same for an elementary function of one argument by its derivative; w: the disk of its
// partner.
bool pl_disk_by_slope(pl_disk* z, pl_op op, const pl_disk* x, const pl_disk* w);
// Its derivative from those of the operands: d w/ds with da/ds, db/ds, dc/ds; value w, partner p.
void pl_disk_derivative(pl_disk* dw, pl_op op, const pl_disk* w, const pl_disk* a, const pl_disk* b,
                        const pl_disk* p, const pl_disk* da, const pl_disk* db, const pl_disk* dp);
void pl_disk_add(pl_disk* z, const pl_disk* x, const pl_disk* y);
void pl_disk_sub(pl_disk* z, const pl_disk* x, const pl_disk* y);
void pl_disk_mul(pl_disk* z, const pl_disk* x, const pl_disk* y);

// ----------------------------------------------------------------------------- balls of operations
void pl_ball_op(arb_t out, pl_op op, arb_srcptr a, arb_srcptr b, arb_srcptr c, slong prec);

// Exact expressions to balls. Names mean what the problem says: parameters, start values of
// coordinates.
typedef struct pl_exact {
  const pl_certify_problem* p;
  pl_arena* arena;
  pl_map* place;  // id of a coordinate or velocity atom -> place + 1 in q (n_q ..: velocity)
  pl_map* done;   // id of an expression -> 1 + its ball
  PL_VEC(arb_ptr) balls;
  slong prec;
  int depth;
  const char* missing;  // the first name without exact value
} pl_exact;
// forgets what was computed at another precision
void pl_exact_begin(pl_exact* x, slong prec);
void pl_exact_free(pl_exact* x);
bool pl_exact_ball(pl_exact* x, arb_t out, pl_expr e);  // false: something has no exact value

// ----------------------------------------------------------------------- one instance of a pattern
typedef struct pl_ball_jet {
  const pl_pattern* pattern;
  const pl_tape* tape;
  const int *q, *c;  // global coordinate and constraint of each slot
  const double* index;
  const int* out;  // watched quantity of each output; NULL: no events watch this
  int cap;         // coefficients there is room for
  arb_ptr coef;    // node i, order k at i cap + k
  int n_aux;
  int* aux_at;  // node -> its weighted series j x_j, -1 none
  arb_ptr aux;
  uint8_t* wanted;        // who needs a node: PL_FOR_MOTION, PL_FOR_START        (n_nodes)
  pl_disk *disk, *slope;  // value and time derivative              (n_nodes)
} pl_ball_jet;

enum { PL_FOR_MOTION = 1, PL_FOR_START = 2 };

// Order k of the nodes of a level that are wanted.
void pl_jet_coefficients(pl_ball_jet* j, pl_tape_level level, int k, slong prec, uint8_t wanted);

// -------------------------------------------------------------------------------------- the system
typedef struct pl_system {
  pl_job* job;
  pl_arena* arena;
  const pl_certify_problem* p;
  const pl_setup* setup;
  pl_exact exact;
  int n_q, n_c, n;  // n: most unknowns, n_q + n_c
  int n_jets;
  pl_ball_jet* jet;
  long n_nodes;
  int cap;
  slong prec;
  bool *held, *active;  // constraints: not released by an event; in force
  struct pl_monitors* monitors;
  int n_rows;                   // constraints in use
  int n_wanted;                 // how many there must be
  int *row_of, *constraint_of;  // of a constraint: its row, -1 not in use; and back
  arb_ptr q, v, a, l;           // series: i cap + k
  arb_ptr rhs;                  // (n)
  arb_mat_t inverse;            // of [M  -(G^T + W); G  0] at order 0   (n_q + n_rows)
  bool has_inverse;
  // disks of a step: every point that the motion reaches at complex times |s - t| < radius
  pl_disk *q_disk, *v_disk, *a_disk, *l_disk;
  pl_disk* matrix;           // (n x n), row by row
  pl_disk *right, *scratch;  // (n); one
  mag_ptr slack, spread;     // work of the linear system in disks     (n x n), (4 n)
} pl_system;

// ---- system.c
void pl_jet_want(pl_ball_jet* j, int* stack, int root, uint8_t who);  // stack: 3 n_nodes + 4
pl_certify_end pl_system_make(pl_system* s, pl_job* job, const pl_certify_problem* p);
void pl_system_free(pl_system* s);
void pl_system_reserve(pl_system* s, int cap);  // room for so many coefficients
// constants of all programs anew; false: one is not exact
bool pl_system_precision(pl_system* s, slong prec);
void pl_system_hold(pl_system* s);                          // what is active, from what is held
arb_srcptr pl_root_series(const pl_ball_jet* j, int root);  // coefficients of a root

// ---- equations.c
// Programs at order 0 for t, q[0], v[0].
void pl_system_values(pl_system* s, arb_srcptr t, uint8_t wanted);
// independent rows, declared ones first; -1: a force needs another
int pl_system_choose_rows(pl_system* s);
// Series of q, v up to order p, of a and λ up to p - 1, after values and inverse.
void pl_system_series(pl_system* s, int p, double bits_per_order);
// The two steps above at a point: rows, inverse, a and λ.
bool pl_system_point(pl_system* s, arb_srcptr t);

// ---- disk_system.c
// Disks of a and λ from those of t, q, v; false: not proved.
bool pl_system_disks(pl_system* s, const pl_disk* t);
// Doubles at the middle of order 0.
double pl_ball_double(arb_srcptr x);

// --------------------------------------------------------------------------------- start and steps
// ---- enclose_start.c: q[0], v[0] at t; PL_CERTIFIED or why not.
pl_certify_end pl_enclose_start(pl_system* s, pl_certified* out, arb_srcptr t);

// ---- enclose_step.c
typedef struct pl_enclosure_stepper {
  pl_system* s;
  int direction;             // of time: 1, -1
  double radius;             // of the disk of times of the last step, 0 before the first
  double longest;            // radius so far
  double growth;             // natural step over radius
  int order, highest;        // of the step; that is allowed
  mag_t x;                   // step over radius, of the series at hand
  mag_ptr reach_q, reach_v;  // how far q and v get from their start on the disk of times    (n_q)
  mag_ptr pull;              // bounds of |a|                                                (n_q)
  double work;               // done so far, in units of the budget
} pl_enclosure_stepper;
void pl_stepper_make(pl_enclosure_stepper* e, pl_system* s, int direction);
void pl_stepper_free(pl_enclosure_stepper* e);
// A disk of times around t on which the motion is proved to exist, with bounds. false: none is
// found.
bool pl_step_prove(pl_enclosure_stepper* e, arb_srcptr t, double longest);
// Series for a step of h, |h| < radius / 2; then the balls of q[0], v[0] after `part`, which lies
// between 0 and h.
bool pl_step_series(pl_enclosure_stepper* e, arb_srcptr t, arb_srcptr h);
void pl_step_take(pl_enclosure_stepper* e, arb_srcptr part);
// reach x^(p+1)/(1-x): what is left of a series bounded by reach on the disk of times.
void pl_series_tail(mag_t out, mag_srcptr reach, const mag_t x, int p);

// ---- monitors.c: functions whose sign decides the mode of the motion
typedef enum pl_monitor_kind { PL_MONITOR_FORCE, PL_MONITOR_GAP, PL_MONITOR_EVENT } pl_monitor_kind;
typedef struct pl_monitor {
  pl_monitor_kind kind;
  int index;  // of the constraint, of the event
  int sign;   // of the function now; 0: that of its beginning
  int fresh;  // so many coefficients are zero at the start of this step
  bool begun;
} pl_monitor;

// pl_monitors_reset begins a pass (anew), or a mode in which contact `released` has just let go at
// zero force (-1: none).
void pl_monitors_reset(pl_system* s, bool anew, int released);
void pl_monitors_free(pl_system* s);
bool pl_monitors_any(const pl_system* s);
// nodes that they read are wanted; or PL_CERTIFY_WATCH
pl_certify_end pl_monitors_mark(pl_system* s, const char** what);

typedef enum pl_monitor_look {
  PL_LOOK_CLEAR,
  PL_LOOK_SHORTER,
  PL_LOOK_HIT,
  PL_LOOK_LOST
} pl_monitor_look;
// Looks along the step h for the first function that changes sign. CLEAR: none. SHORTER: none up to
// *part. HIT: one does, alone, and for the first time within the ball *part. LOST: not decided.
pl_monitor_look pl_monitors_look(pl_enclosure_stepper* e, arb_srcptr h, arb_t part,
                                 pl_monitor** hit);
void pl_monitors_moved(pl_system* s);  // a step without change was taken

struct pl_certified_balls {
  int n_q, n_c, n_times;  // the last time is for an event that stops
  arb_ptr q, v, l;        // time after time
  bool* determined;       // of each multiplier
  bool* is_stop;          // of each time: it is that of an event that stops
  arb_ptr time;           // of what happened            (room)
  arb_ptr state;          // q, v then                   (room x 2 n_q)
  int room;
};
void pl_certified_balls_make(pl_certified* out, pl_job* job, const pl_certify_problem* p);

#endif
