// What a constraint presses together, found from the constraint and the masses alone.
#ifndef PL_CONTACT_GEOMETRY_H
#define PL_CONTACT_GEOMETRY_H

#include "assembly/assembly_impl.h"

// Force of a constraint per unit of its multiplier, and the velocity with which the surfaces slide
// along each other.
typedef struct pl_contact_touch {
  int n;  // components
  pl_expr force[3];
  pl_expr size;     // |force|
  pl_expr slip[3];  // relative velocity of the surfaces, not yet projected
  // where they touch, when a body is one of the partners and no place was given
  pl_expr place[3];
  bool placed;
  int sense;  // +1: the angle of the body turns it counter-clockwise
} pl_contact_touch;

// pl_contact_geometry finds it.  Otherwise false: a message has been reported.
bool pl_contact_geometry(pl_recorder* r, const pl_constraint* c, const pl_friction* f,
                         pl_contact_touch* out);

// |Z| per unit of its multiplier: the size of the force that the constraint exerts on each mass
// that it touches. Poison where virtual work does not determine it or where the masses feel
// different ones.
pl_expr pl_force_length(pl_recorder* r, const pl_constraint* c);

#endif
