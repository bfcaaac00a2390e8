// where, inside: what is looked for along a motion.
#ifndef PL_WHERE_IMPL_H
#define PL_WHERE_IMPL_H

#include "mechanics/course.h"
#include "worked/worked_impl.h"

enum { pl_max_roots_met = 8, pl_max_contacts_met = 8 };
// The first place on a motion where a condition holds: along a coordinate that moves by its energy
// integral, or along time.
typedef struct pl_search {
  const pl_line* line;  // NULL: along time
  pl_symbol s;          // the coordinate, or t
  pl_expr condition;    // vanishes there; over s, and the velocity of a coordinate
  bool place;           // the condition is s = root[0]: the start counts
  pl_expr asked;        // over the same
  pl_expr name;         // what was asked for
  pl_root root[pl_max_roots_met];
  int n_roots;
  bool complete;   // all roots are there
  int n_contacts;  // one-sided constraints: what must stay above zero up to there
  pl_expr push[pl_max_contacts_met];  // λ of a closed one, the distance of an open one
  bool open[pl_max_contacts_met];
  const char* contact[pl_max_contacts_met];
  const pl_form* side[pl_max_contacts_met];  // no contact: a sign that the formulas took; NULL
} pl_search;

void pl_search_motion(pl_analysis* d, const pl_search* p);
// The equations followed in numbers, where nothing else is known: what the condition meets on the
// motion. Roots are not used.
// not possible; not met up to `time`
typedef enum pl_followed_how { PL_FOLLOWED_NOT, PL_FOLLOWED_PAST, PL_FOLLOWED_MET } pl_followed_how;
// lost: a contact, -1
typedef struct pl_followed {
  pl_followed_how how;
  double time, asked;
  int lost;
  double lost_at;
} pl_followed;
// 0 without loops
void pl_follow_motion(pl_analysis* d, const pl_motion* motion, int assembly, const pl_search* p,
                      pl_followed* out);
// an event that changes the motion comes first
bool pl_say_event_before(pl_analysis* d, const pl_motion* motion, const pl_search* p);
void pl_say_followed(pl_analysis* d, const pl_search* p, const pl_followed* f);
void pl_show_met(pl_analysis* d, pl_expr name, pl_expr value, pl_expr condition);
void pl_show_met_number(pl_analysis* d, pl_expr name, double x);
// an open contact
// The other side of a sign that was taken for granted.
void pl_say_left_before(pl_analysis* d, const pl_form* side, const pl_form* where);
void pl_say_met_before(pl_analysis* d, const char* contact, const pl_form* where);

#endif
