// drag: a point of a system is moved on the manifold of its constraints.
#ifndef PL_DRAG_H
#define PL_DRAG_H

#include "model/model.h"

enum { PL_MOST_DRAGGED = 120 };  // coordinates and constraints

// What the positions of a model must satisfy, with the derivatives.
typedef struct pl_manifold pl_manifold;
// value: numbers of all symbols by id, those of coordinates and velocities at a consistent start;
// kept and written to. Constraints count that are met there; one-sided ones that are not are
// walls.  NULL: too large.
pl_manifold* pl_manifold_make(pl_arena* a, pl_model* flat, double* value);

pl_symbol pl_manifold_coordinate(const pl_manifold* m, int i);
pl_symbol pl_manifold_velocity(const pl_manifold* m, int i);

typedef struct pl_hold pl_hold;  // a point of the system
pl_hold* pl_hold_make(pl_arena* a, pl_manifold* m, const pl_point* point);
void pl_hold_place(const pl_hold* h, double* place);
bool pl_hold_can_move(pl_hold* h);
// Moves the point as near to a place as it goes, then the velocities by the least that keeps the
// constraints.  false: the constraints could not be met on the way; nothing has changed.
bool pl_hold_move(pl_hold* h, const double* place);
// Gives the point a velocity, as near to this one as the constraints let it.
void pl_hold_throw(pl_hold* h, const double* velocity);

#endif
