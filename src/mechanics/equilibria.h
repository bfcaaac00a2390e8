// equilibria: positions of rest, and what is linear around them. rests.c finds the positions,
// linearise.c has the matrices and the
// stability.
#ifndef PL_EQUILIBRIA_H
#define PL_EQUILIBRIA_H

#include "mechanics/mechanics.h"

enum { pl_max_gen = 6, pl_max_found = 32, pl_max_conditions = 8 };

typedef struct pl_rest {
  pl_expr q[pl_max_gen];                 // values of the generalized coordinates; poison: free
  pl_expr condition[pl_max_conditions];  // each >= 0 for it to exist
  int n_conditions;
  // 1 + place of a coordinate whose equation has no closed solution; q holds its name then
  int open;
  int open_row;            // that equation
  bool turns;              // solved for one period of it; the system does not repeat
  bool numeric;            // a zero found in numbers
  bool exact[pl_max_gen];  // of such a one: coordinates that do not hang on that zero
} pl_rest;

typedef struct pl_rests {
  pl_rest at[pl_max_found];
  int n;
  bool complete;       // these are all, up to periods
  bool complete_here;  // all on the side that was taken
  int n_singular;      // positions where the coordinates fail
  pl_rest singular;    // the last of them
  pl_rest open[4];     // an equation in one coordinate was left
  int n_open;
  // |q| up to which the open ones were searched in numbers; 0: one period, or not at all
  double searched;
  int searched_place;
  // each >= 0 where the formulas hold: signs taken from the start
  pl_fact side[pl_max_sides];
  int n_sides;
  bool map_ends;      // a root of the map vanishes somewhere: the coordinates end there
  bool more_turns;    // places in other periods were left out
  bool by_numbers;    // completeness was proven in numbers
  int tries;          // positions inserted by trial
  bool special_case;  // the given numbers are one, d->special
} pl_rests;

//   M u'' + C u' + K u = 0,  C split by symmetry into damping and gyroscopic terms.
typedef struct pl_linearised {
  int n;
  pl_expr M[pl_max_gen * pl_max_gen], C[pl_max_gen * pl_max_gen], K[pl_max_gen * pl_max_gen];
  // circulatory: K is not symmetric, forces without potential
  bool damped, gyroscopic, circulatory;
} pl_linearised;

typedef enum pl_doubt {
  PL_DOUBT_NONE,
  PL_DOUBT_GYROSCOPIC,
  PL_DOUBT_CIRCULATORY,
  PL_DOUBT_DRIVEN,
  PL_DOUBT_DAMPING,
  PL_DOUBT_INERTIA,
  PL_DOUBT_DEGENERATE
} pl_doubt;

// stable if all conditions are > 0.
typedef struct pl_verdict {
  const char* word;        // "stable", "unstable", "marginal"; NULL: conditions, or a doubt
  const char* at_numbers;  // the same for the given numbers
  pl_expr condition[2 * pl_max_gen];
  int n;
  pl_doubt doubt;  // why there is no word and no condition
} pl_verdict;

// linearise.c
// velocities 0, or those of the steady motion; accelerations 0
pl_expr pl_at_rest(pl_analysis* d, pl_expr e);
pl_expr pl_insert_rest(pl_analysis* d, pl_expr e, const pl_rest* r);
bool pl_vanishes(pl_analysis* d, pl_expr e);
void pl_linearise(pl_analysis* d, const pl_expr* f, const pl_rest* r, pl_linearised* out);
void pl_stability(pl_analysis* d, const pl_expr* f, const pl_linearised* l, const pl_rest* r,
                  pl_verdict* out);
pl_symbol pl_omega_squared(pl_analysis* d);
int pl_small_oscillations(pl_analysis* d, const pl_linearised* l, pl_root* root, int max,
                          bool* complete);
// rests.c
void pl_at_rest_equations(pl_analysis* d, pl_expr* f);
// with the special case inserted that the given numbers are
pl_rests* pl_find_rests(pl_analysis* d, pl_expr* f);
// What equations that contain t lose: forces that depend on t alone, or an amplitude, which joins
// d->steady.
typedef struct pl_drive {
  int n;
  pl_expr force[pl_max_gen];
  pl_symbol amplitude;  // id 0: none
} pl_drive;
// false where t cannot be taken out
bool pl_without_drive(pl_analysis* d, pl_expr* f, pl_drive* out);
// The position that the conditions `q = value` name: tried by inserting it. PL_YES: one of rest;
// PL_NO: none, a force is left;
// PL_UNKNOWN: they do not name every coordinate, or it is not decided.
pl_answer3 pl_named_rest(pl_analysis* d, const pl_ask* ask, const pl_expr* f, pl_rest* out);
bool pl_rest_is_named(pl_analysis* d, const pl_ask* ask, const pl_rest* r);
bool pl_names_a_place(pl_analysis* d, const pl_ask* ask);
// the forces repeat with a coordinate, the places do not
bool pl_rests_recur(pl_analysis* d, const pl_expr* f, int place);
bool pl_rest_exists_at_numbers(pl_analysis* d, const pl_rest* r);
// a one-sided constraint that would have to pull; NULL
const pl_bond* pl_rest_pulls(pl_analysis* d, const pl_rest* r);
// coordinate i is a pure number under sin or cos
bool pl_is_angle(pl_analysis* d, int i);

#endif
