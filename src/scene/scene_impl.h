// scene, inside: a stage is the model while its picture is made. First the things are found (what
// has a place), then the parts (what is drawn), then each part gets its points frame by frame.
#ifndef PL_SCENE_IMPL_H
#define PL_SCENE_IMPL_H

#include "scene/scene.h"

enum { PL_NO_THING = -1 };

// Where something is, in the space of the model: an expression for each axis, and on bodies a point
// (p, q) that turns with `angle`. Fixed spots are numbers.
typedef struct pl_spot {
  bool fixed;
  double at[3];   // fixed: components along the axes
  pl_expr e[3];   // else; poison beyond the axes of the model
  pl_expr angle;  // poison: none
  double p[2];    // on a body: along and across it
  double sense;   // +1, -1: how the angle turns
  double side;    // models with one axis: place across it
} pl_spot;

typedef enum pl_thing_kind { PL_THING_MASS, PL_THING_BODY, PL_THING_POINT } pl_thing_kind;
typedef struct pl_thing {
  pl_thing_kind kind;
  const char *label, *name;  // as shown; its name in the model
  pl_spot spot;
  pl_expr mass;          // poison for points
  const pl_body* body;   // of a body
  double radius, reach;  // of a round body, 0 otherwise, m; of any body
  double sense;          // of a body: how its angle turns
  PL_VEC(int) deps;      // coordinates that its place depends on
  bool timed;            // its place depends on time by itself
  bool linked;           // a rod, rope or surface explains it
  bool roped;            // hangs on a rope
  bool curved;           // the curve of its own constraints is drawn
} pl_thing;

// What is drawn, before it has points.
typedef struct pl_stage pl_stage;
typedef struct pl_part pl_part;
// Writes the n points of a part at the present values, in the space of the model (3 numbers a
// point, NaN: not there).
typedef void pl_placing(pl_stage* s, const pl_part* part, double* xyz);
struct pl_part {
  pl_shape_kind kind;
  const char *label, *of;
  int n;
  double mass;  // kg, 0 unknown
  bool moves, hidden;
  int side;         // GROUND: sign of the constraint's gradient; settled when projected
  pl_spot spot[2];  // ends
  pl_placing* place;
  const void* data;  // what place needs besides
  // GROUND: direction into the material, in space, and where it was found (6)
  const double* normal;
  // a vector of the model's space that is scaled to the picture: spot 0 and vector
  bool arrow;
  pl_expr vector[3];
};

typedef enum pl_hint {
  PL_HINT_NONE,
  PL_HINT_ROD,
  PL_HINT_ROPE,
  PL_HINT_TRACK,
  PL_HINT_GROUND
} pl_hint;

// A constraint as the picture sees it.
typedef struct pl_bond {
  const pl_constraint* c;
  int link;          // its place among the multipliers of the result
  PL_VEC(int) deps;  // coordinates that occur
  bool timed;
  bool drawn;
  bool velocity;
  bool touches;            // a point of a body touches a plane: drawn with the body
  int touched;             // that body, a thing
  double touch_normal[2];  // force per λ there
  double touch_place[2];   // on the body, as in a spot
  pl_hint hint;
  int settles;  // coordinate that it holds at a constant, -1
  bool pair;    // g is a function of the distance of two things alone
  int end[2];   // these things
} pl_bond;

// picture of each axis
typedef struct pl_view {
  double e[3][2];
  int n_axes;
  bool plane;
} pl_view;

struct pl_stage {
  pl_job* job;
  pl_arena* arena;
  pl_model* model;  // without families
  pl_pool* pool;
  const pl_result* result;
  const pl_scene_options* options;
  int n_q;
  pl_symbol *q, *v;       // coordinates and their velocities       (n_q)
  bool *angle, *settled;  // of each coordinate                     (n_q)
  pl_map* q_at;           // symbol id -> coordinate + 1
  double* value;          // by symbol id, of the present frame
  int n_value;
  PL_VEC(pl_thing) things;
  PL_VEC(pl_bond) bonds;
  PL_VEC(pl_part) parts;
  int n_frames;
  double* t;      // (n_frames)
  double* state;  // (n_frames x n_state) t, q, v, λ        ORDER STATE
  int n_state, n_lambda;
  pl_view view;
  double size;          // of the picture, m
  double lo[3], hi[3];  // space that the things fill
  double down[3];       // direction of gravity, 0 without
  double newton_per_metre, speed_per_metre;
  pl_random random;
};

// ---- scene_frames.c: times and values
// from the result, or from a sketch of the start
pleuel_status pl_stage_frames(pl_stage* s);
void pl_stage_set(pl_stage* s, int frame);  // the values of this frame
double pl_stage_eval(const pl_stage* s, pl_expr e);
void pl_stage_spot(const pl_stage* s, const pl_spot* spot, double x[3]);

// ---- scene_sketch.c: a start that shows the system when the model gives none
void pl_stage_sketch(pl_stage* s);
double pl_stage_length(const pl_stage* s);  // typical size of the given lengths, m

// ---- scene_things.c: what has a place
void pl_stage_things(pl_stage* s);
void pl_stage_bodies(pl_stage* s);  // outlines, after the bonds were looked at
bool pl_list_has(const int* list, int n, int x);
void pl_collect_coords(pl_stage* s, pl_expr e, int** deps, int* n, bool* timed);
void pl_stage_space(pl_stage* s);  // lo, hi, size

// ---- scene_parts.c: parts that several files add
pl_part* pl_stage_add(pl_stage* s, pl_shape_kind kind, const char* label, const char* of);
void pl_add_rod(pl_stage* s, pl_shape_kind kind, const pl_bond* b, const pl_spot* from,
                const pl_spot* to);
void pl_add_pivot(pl_stage* s, const double x[3]);

// ---- scene_draw.c: what the model says about its picture
void pl_stage_draws(pl_stage* s);

// ---- scene_bonds.c: what constraints look like
void pl_stage_bonds(pl_stage* s);

// ---- scene_trial.c: other values of the coordinates
void pl_coords_keep(const pl_stage* s, double* kept);  // (n_q)
void pl_coords_back(pl_stage* s, const double* kept);
// random values; what is held at a constant stays
void pl_coords_shuffle(pl_stage* s, const int* q, int n);
// of two spots: const pl_spot* what[2]
double pl_squared_distance(pl_stage* s, const void* what);

// ---- scene_hints.c
pl_hint pl_hint_of(const char* label);
bool pl_radius_is_length(const pl_stage* s, const pl_bond* b, double radius);

// ---- scene_rods.c
void pl_stage_rods(pl_stage* s);  // distances that the places themselves keep

// ---- scene_ropes.c
void pl_stage_ropes(pl_stage* s);

// ---- scene_trace.c: the curve that constraints leave to a thing
typedef struct pl_track {
  int thing;
  int n_eq;
  pl_expr eq[8];
  int n_q;
  int q[8];         // coordinates that move along it
  pl_expr G[8][8];  // d eq_i / d q_k
  pl_expr J[3][8];  // d place_j / d q_k
  int fixed_axis;   // this component stays: a slice of a surface; -1
  double fixed_at;
  bool whole;                   // a closed curve is followed beyond the box until it comes back
  double box_lo[3], box_hi[3];  // where to stop
  int n;                        // points wanted
} pl_track;
pl_track* pl_track_make(pl_stage* s, int thing, const pl_expr* eq, int n_eq, const int* q, int n_q);
// Follows the curve from the present values; writes at most t->n points evenly along it, the rest
// NaN. Returns how many; *closed tells whether it comes back.
int pl_track_follow(pl_stage* s, const pl_track* t, double* xyz, bool* closed);
int pl_track_freedom(pl_stage* s, const pl_track* t);
// Direction in space in which eq[0] rises, across the curve, at the present values.
bool pl_track_normal(pl_stage* s, const pl_track* t, double n[3]);

// ---- scene_surface.c
bool pl_stage_surface(pl_stage* s, const pl_track* surface, const char* of);

// ---- scene_schematic.c: models in which nothing has a place
void pl_stage_schematic(pl_stage* s);

// ---- scene_view.c
void pl_stage_view(pl_stage* s);
void pl_view_project(const pl_view* v, const double x[3], double xy[2]);

// ---- scene_arrows.c
void pl_stage_arrows(pl_stage* s);

// ---- scene_words.c
void pl_stage_words(pl_stage* s, pl_scene* scene);

pl_spot pl_spot_fixed(const double x[3]);
pl_spot pl_spot_of(const pl_stage* s, const pl_point* point);
// Solves A x = b (n x n, row-major, n <= 8) in the least-squares sense of smallest x where it can;
// false: not finite.
int pl_null_space(double* A, int m, int n, double null[8][8]);
// m x n row-major, smallest least-squares x
bool pl_least(const double* A, const double* b, int m, int n, double* x);

#endif
