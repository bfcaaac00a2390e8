// scene: the picture of a model, made from the model: masses, rods, ropes, springs, curves, walls,
// axes, force arrows.
//
// A scene is geometry in picture coordinates: metres, x to the right, y up, one projection of the
// axes of the model (a plane problem fills its plane; a spatial one is seen obliquely). A shape is
// a poly-line of points; what moves has its points for every frame, what rests has them once. How a
// shape looks (colour, line width) is the business of the writer. Names come from the model and are
// plain text: a writer escapes them.
#ifndef PL_SCENE_H
#define PL_SCENE_H

#include "model/model.h"
#include "result/result.h"

typedef enum pl_shape_kind {
  PL_SHAPE_MASS,      // 1 point: a point mass
  PL_SHAPE_POINT,     // 1 point: a pivot or another fixed or massless point
  PL_SHAPE_BODY,      // outline of a rigid body, closed
  PL_SHAPE_ROD,       // 2 points: a constraint between two points
  PL_SHAPE_ROPE,      // points of a rope, over pulleys where the model says so
  PL_SHAPE_SPRING,    // 2 points: ends; the writer draws the coil
  PL_SHAPE_DAMPER,    // 2 points
  PL_SHAPE_CURVE,     // points on the surface or curve of a constraint of a single point
  PL_SHAPE_GROUND,    // the same of a one-sided constraint; `side` tells where its material is
  PL_SHAPE_AXIS,      // 2 points: a coordinate axis, from tail to tip; label at the tip
  PL_SHAPE_ANGLE,     // arc of an angle coordinate with its label
  PL_SHAPE_FORCE,     // 2 points: tail and tip of a force arrow, to the scale of the scene
  PL_SHAPE_VELOCITY,  // 2 points: likewise
  PL_SHAPE_TRAIL      // the path of a mass; the writer shows it up to the present frame
} pl_shape_kind;

typedef struct pl_shape {
  pl_shape_kind kind;
  const char* label;  // "m", "g1", "Z", "λ"; Unicode, "" if none
  const char* of;     // name of the mass, constraint or force it belongs to; "" if none
  // GROUND: +1 material on the left of the line, -1 on the right, 0 unknown
  int side;
  int n;  // points
  bool moves;
  // (n x 2) when at rest, (n_frames x n x 2) when it moves; NaN: not there in this frame
  const float* xy;
  // false: prepared, but hidden until the reader asks (velocities; what `draw` hides)
  bool shown;
  // MASS, BODY: its mass over the largest one, 0 unknown: for the size of its picture
  float weight;
} pl_shape;

// an event
typedef struct pl_scene_mark {
  double t;
  const char* label;
  int frame;
} pl_scene_mark;

typedef struct pl_scene {
  int n_shapes;
  const pl_shape* shapes;
  int n_frames;
  const double* t;          // (n_frames) s, evenly spaced but for the frames exactly at events
  float box[4];             // x_min, y_min, x_max, y_max that hold everything at all times
  double newton_per_metre;  // scale of the force arrows; 0: there are none
  double speed_per_metre;   // scale of the velocity arrows, 1/s; 0: there are none
  // frame that tells most when nothing moves: the most interesting event, else the start
  int best;
  int n_marks;
  const pl_scene_mark* marks;
  const char* description[2];  // sentence for those who cannot see it, by language
} pl_scene;

typedef struct pl_scene_options {
  int frames;               // how many at most; 0: 240
  bool forces, velocities;  // prepare arrows for them
} pl_scene_options;

// pl_scene_make draws the model along a result that kept its rows (NULL: at its start values only,
// one frame). Memory in the job's arena. A model without anything that has a place (no points at
// all) gives a scene without shapes.
pleuel_status pl_scene_make(pl_job* job, pl_model* model, const pl_result* result,
                            const pl_scene_options* options, pl_scene** out);

#endif
