// course: the way of a motion of one coordinate in numbers, from its start over its turning points.
#ifndef PL_COURSE_H
#define PL_COURSE_H

#include "mechanics/mechanics.h"

// How a leg ends: the motion turns, comes to rest after an endless time, cannot go on (a pole, the
// end of a domain), or goes on.
typedef enum pl_leg_end { PL_END_TURN, PL_END_REST, PL_END_EDGE, PL_END_OPEN } pl_leg_end;
// sign of the velocity
typedef struct pl_leg {
  double from, to;
  int sign;
  bool from_turn;
  pl_leg_end end;
} pl_leg;

enum { pl_max_legs = 3 };  // start - turn - turn - turn: then all repeats
typedef struct pl_course {
  pl_analysis* d;
  double* value;  // numbers by symbol id; those of q and q' are overwritten
  pl_symbol q, v;
  pl_expr v2;  // q'^2 as a function of q
  double start, speed;
  double first, longest, most;  // first and longest step of a search, and how far it goes
  double rate;                  // the lowest k of sin(k q), cos(k q); 0: q stands in none
  bool stays;                   // at rest in an equilibrium
  bool either;                  // that it may leave to either side
  int n_legs;
  pl_leg leg[pl_max_legs];
} pl_course;

// The course of a motion that starts at q0 with the velocity v0, or from rest to the side `side`
// (0: none is named; an acceleration
// comes first).  false: some number is missing, or the motion cannot start.
bool pl_course_make(pl_analysis* d, double* value, pl_symbol q, pl_expr v2, double q0, double v0,
                    int side, pl_course* out);
// Of a function of time on 0 <= t: one open leg.
void pl_course_of_time(pl_analysis* d, double* value, pl_expr f, pl_course* out);

// The first place after the start where f(q, q') vanishes.
// sign of q' there, 0 at a turn
typedef struct pl_meeting {
  int leg;
  double at;
  int sign;
  bool touches;
} pl_meeting;
bool pl_course_meets(const pl_course* c, pl_expr f, pl_meeting* out);
// Is the place q itself met?  The start counts.
bool pl_course_reaches(const pl_course* c, double q, pl_meeting* out);
bool pl_course_repeats(const pl_course* c, pl_expr f);  // q'^2 and f after one turn of the angle
double pl_course_value(const pl_course* c, pl_expr f, double q, int sign);  // f(q, q') there
bool pl_meets_before(const pl_meeting* a, const pl_meeting* b, const pl_course* c);

#endif
