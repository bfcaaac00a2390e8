// The picture of a model, step by step: things, numbers at each frame, what the constraints look
// like, loads, arrows, the view, points.
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

// beyond this there is nothing to be seen, or to be read
enum { MOST_COORDINATES = 6000, MOST_NAMED = 24 };

// ------------------------------------------------------------------------------------------- stage
static bool turns(pl_pool* p, pl_expr e, pl_symbol x, bool inside) {
  pl_kind kind = pl_kind_of(p, e);
  if (kind == PL_SYMBOL) return inside && pl_symbol_of(p, e).id == x.id;
  bool trig = kind == PL_CALL
              && (pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS
                  || pl_function_of(p, e) == PL_TAN);
  for (int i = 0; i < pl_n_args(p, e); i++) {
    if (pl_has_symbol(p, pl_arg(p, e, i), x) && turns(p, pl_arg(p, e, i), x, inside || trig))
      return true;
  }
  return false;
}

static bool is_angle(pl_stage* s, pl_symbol x) {
  const pl_symbol_info* info = pl_symbol_get(s->pool, x);
  if (s->model->uses_units && info->dimension_known)
    return pl_dimension_equal(info->dimension, pl_dimension_one());
  for (int i = 0; i < s->things.n; i++) {
    for (int j = 0; j < 3; j++) {
      if (!pl_is_poison(s->things.at[i].spot.e[j])
          && turns(s->pool, s->things.at[i].spot.e[j], x, false))
        return true;
    }
  }
  for (int i = 0; i < s->model->constraints.n; i++) {
    if (turns(s->pool, s->model->constraints.at[i].g, x, false)) return true;
  }
  for (int i = 0; i < s->model->choose.n_maps; i++) {
    if (turns(s->pool, s->model->choose.maps[i].map, x, false)) return true;
  }
  for (int i = 0; i < s->model->bodies.n; i++) {
    if (pl_has_symbol(s->pool, s->model->bodies.at[i].angle, x)) return true;
  }
  return false;
}

static void find_coordinates(pl_stage* s) {
  pl_flat_coords flat = pl_model_flat_coords(s->model, s->arena);
  s->n_q = flat.n;
  s->q = PL_ARRAY(s->arena, pl_symbol, flat.n + 1);
  s->v = PL_ARRAY(s->arena, pl_symbol, flat.n + 1);
  s->angle = PL_ARRAY(s->arena, bool, flat.n + 1);
  s->settled = PL_ARRAY(s->arena, bool, flat.n + 1);
  s->q_at = pl_map_make(s->arena);
  for (int k = 0; k < flat.n; k++) {
    s->q[k] = pl_symbol_of(s->pool, flat.at[k]);
    s->v[k] = pl_symbol_dot(s->pool, s->q[k]);
    pl_symbol_dot(s->pool, s->v[k]);
    pl_map_set(s->q_at, s->q[k].id, (uint64_t)k + 1);
  }
}

static void find_gravity(pl_stage* s) {
  for (int i = 0; i < s->model->gravities.n; i++) {
    const pl_gravity* g = &s->model->gravities.at[i];
    double size = pl_eval(s->pool, g->g, s->value);
    if (g->axis < 3) s->down[g->axis] = g->sign * (size < 0 ? -1 : 1);
  }
}

// Without `gravity` a potential may pull: its slope at the start, where a place is given by
// coordinates of its own.
static void find_pull(pl_stage* s) {
  pl_expr V = pl_int(s->pool, 0);
  for (int i = 0; i < s->model->loads.n; i++) {
    if (s->model->loads.at[i].kind == PL_L_POTENTIAL)
      V = pl_add(s->pool, V, s->model->loads.at[i].value);
  }
  double pull[3] = {0, 0, 0}, size = 0;
  for (int j = 0; j < 3 && s->things.n > 0; j++) {
    pl_expr e = s->things.at[0].spot.e[j];
    if (pl_is_poison(e) || pl_kind_of(s->pool, e) != PL_SYMBOL) continue;
    pull[j] = -pl_stage_eval(s, pl_diff(s->pool, V, pl_symbol_of(s->pool, e)));
    size += pull[j] * pull[j];
  }
  for (int j = 0; size > 0 && isfinite(size) && j < 3; j++) s->down[j] = pull[j] / sqrt(size);
}

// Symbols made later (velocities in forces) need room.
static void find_values(pl_stage* s) {
  double* known = pl_model_values(s->model, s->arena);
  int n = pl_symbol_count(s->pool) + 1;
  s->n_value = n + 256;
  s->value = PL_ARRAY(s->arena, double, s->n_value);
  for (int i = 0; i < s->n_value; i++) s->value[i] = i < n ? known[i] : (double)NAN;
}

// ----------------------------------------------------------------------- parts of things and loads
static void add_things(pl_stage* s) {
  for (int i = 0; i < s->things.n; i++) {
    pl_thing* t = &s->things.at[i];
    if (t->kind == PL_THING_BODY) continue;
    bool point = t->kind == PL_THING_POINT;
    // names of the ends must do
    bool crowd = s->things.n > MOST_NAMED && i > 0 && i + 1 < s->things.n;
    pl_part* p = pl_stage_add(s, point ? PL_SHAPE_POINT : PL_SHAPE_MASS, crowd ? "" : t->label,
                              t->name);
    p->n = 1;
    p->mass = pl_is_poison(t->mass) ? 0 : pl_stage_eval(s, t->mass);
    p->spot[0] = t->spot;
    p->moves = t->deps.n > 0 || t->timed;
  }
}

static bool spot_moves(pl_stage* s, const pl_spot* spot) {
  int* deps = NULL;
  int n = 0;
  bool timed = false;
  for (int j = 0; j < 3 && !spot->fixed; j++) pl_collect_coords(s, spot->e[j], &deps, &n, &timed);
  return n > 0 || timed;
}

static void add_loads(pl_stage* s) {
  for (int i = 0; i < s->model->loads.n; i++) {
    const pl_load* l = &s->model->loads.at[i];
    if (l->kind != PL_L_SPRING && l->kind != PL_L_DAMPER) continue;
    const char* label = pl_kind_of(s->pool, l->value) == PL_SYMBOL
                            ? pl_symbol_get(s->pool, pl_symbol_of(s->pool, l->value))->name
                            : "";
    pl_part* p = pl_stage_add(s, l->kind == PL_L_SPRING ? PL_SHAPE_SPRING : PL_SHAPE_DAMPER, label,
                              l->name.text);
    p->spot[0] = pl_spot_of(s, &l->a);
    p->spot[1] = pl_spot_of(s, &l->b);
    p->moves = spot_moves(s, &p->spot[0]) || spot_moves(s, &p->spot[1]);
    // models with one axis: the places across it belong to the things
    for (int k = 0; k < 2; k++) {
      for (int j = 0; j < s->things.n; j++) {
        if (pl_same(s->things.at[j].spot.e[0], p->spot[k].e[0]))
          p->spot[k].side = s->things.at[j].spot.side;
      }
    }
  }
}

// ------------------------------------------------------------------------------------------ points
static void place_part(pl_stage* s, const pl_part* p, double* xyz) {
  if (p->place) {
    p->place(s, p, xyz);
    return;
  }
  for (int i = 0; i < p->n && i < 2; i++) pl_stage_spot(s, &p->spot[i], xyz + 3 * i);
}

// Which side of the line, in the picture, is that of the normal: +1 left.
static int side_of(const pl_stage* s, const pl_part* p, const float* xy) {
  if (!p->normal) return 0;
  double n[2], at[2], d[2] = {0, 0}, nearest = INFINITY;
  pl_view_project(&s->view, p->normal, n);
  pl_view_project(&s->view, p->normal + 3, at);
  for (int m = 0; m + 1 < p->n; m++) {  // the piece of the line where the normal was taken
    double away = hypot((double)xy[2 * m] - at[0], (double)xy[2 * m + 1] - at[1]);
    if (!(away < nearest) || !isfinite(xy[2 * m + 2])) continue;
    nearest = away;
    d[0] = (double)(xy[2 * m + 2] - xy[2 * m]);
    d[1] = (double)(xy[2 * m + 3] - xy[2 * m + 1]);
  }
  double cross = d[0] * n[1] - d[1] * n[0];
  return cross > 0 ? 1 : cross < 0 ? -1 : 0;
}

static void find_box(pl_scene* scene) {
  double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, most[2] = {0, 0},
         least[2] = {0, 0};
  // arrows last: a blow must not make the system small
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i < scene->n_shapes; i++) {
      const pl_shape* p = &scene->shapes[i];
      bool arrow = p->kind == PL_SHAPE_FORCE || p->kind == PL_SHAPE_VELOCITY;
      size_t n = (size_t)p->n * (p->moves ? (size_t)scene->n_frames : 1);
      for (size_t k = 0; arrow == (pass == 1) && p->shown && k < 2 * n; k++) {
        double x = (double)p->xy[k];
        if (!isfinite(x) || (arrow && (x < least[k % 2] || x > most[k % 2]))) continue;
        lo[k % 2] = fmin(lo[k % 2], x);
        hi[k % 2] = fmax(hi[k % 2], x);
      }
    }
    double room = 0.25 * fmax(hi[0] - lo[0], hi[1] - lo[1]);
    for (int j = 0; j < 2; j++) {
      least[j] = lo[j] - room;
      most[j] = hi[j] + room;
    }
  }
  for (int j = 0; j < 2; j++) {
    if (!(hi[j] >= lo[j])) lo[j] = hi[j] = 0;
    scene->box[j] = (float)lo[j];
    scene->box[2 + j] = (float)hi[j];
  }
}

static pleuel_status make_shapes(pl_stage* s, pl_scene* scene) {
  int n = s->parts.n;
  pl_shape* shape = PL_ARRAY(s->arena, pl_shape, n + 1);
  float** xy = PL_ARRAY(s->arena, float*, n + 1);
  int most = 1;
  double heaviest = 0;
  for (int i = 0; i < n; i++) heaviest = fmax(heaviest, s->parts.at[i].mass);
  for (int i = 0; i < n; i++) {
    const pl_part* p = &s->parts.at[i];
    size_t frames = p->moves && p->kind != PL_SHAPE_TRAIL ? (size_t)s->n_frames : 1;
    xy[i] = PL_ARRAY(s->arena, float, 2 * (size_t)p->n * frames);
    shape[i] = (pl_shape){.kind = p->kind,
                          .label = p->label,
                          .of = p->of,
                          .n = p->n,
                          .moves = frames > 1,
                          .xy = xy[i],
                          .shown = !p->hidden,
                          .weight = p->mass > 0 ? (float)(p->mass / heaviest) : 0};
    if (p->n > most) most = p->n;
  }
  double* xyz = PL_ARRAY(s->arena, double, 3 * most);
  for (int f = 0; f < s->n_frames; f++) {
    if (pl_interrupted(s->job)) return PLEUEL_INTERRUPTED;
    pl_stage_set(s, f);
    for (int i = 0; i < n; i++) {
      const pl_part* p = &s->parts.at[i];
      if (p->kind == PL_SHAPE_TRAIL) {
        double x[3], at[2];
        pl_stage_spot(s, &p->spot[0], x);
        pl_view_project(&s->view, x, at);
        xy[i][2 * f] = (float)at[0];
        xy[i][2 * f + 1] = (float)at[1];
        continue;
      }
      if (f > 0 && !p->moves) continue;
      place_part(s, p, xyz);
      float* to = xy[i] + (shape[i].moves ? 2 * (size_t)f * (size_t)p->n : 0);
      for (int k = 0; k < p->n; k++) {
        double at[2];
        pl_view_project(&s->view, xyz + 3 * k, at);
        to[2 * k] = (float)at[0];
        to[2 * k + 1] = (float)at[1];
      }
      if (p->kind == PL_SHAPE_GROUND && shape[i].side == 0) shape[i].side = side_of(s, p, to);
    }
  }
  scene->shapes = shape;
  scene->n_shapes = n;
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------------- marks
static void make_marks(pl_stage* s, pl_scene* scene) {
  const pl_result* r = s->result;
  scene->best = 0;
  if (!r) return;
  pl_scene_mark* mark = PL_ARRAY(s->arena, pl_scene_mark, r->events.n + 1);
  int first_release = -1, first_event = -1;
  for (int i = 0; i < r->events.n; i++) {
    const pl_result_event* e = &r->events.at[i];
    int best = 0;
    for (int f = 1; f < s->n_frames; f++) {
      if (fabs(s->t[f] - e->t) < fabs(s->t[best] - e->t)) best = f;
    }
    mark[scene->n_marks++] = (pl_scene_mark){e->t, e->label ? e->label : "", best};
    if (e->kind == PL_EV_RELEASE && !e->at_start && first_release < 0) first_release = best;
    if (e->kind != PL_EV_STOP && first_event < 0) first_event = best;
  }
  scene->marks = mark;
  scene->best = first_release >= 0 ? first_release : first_event >= 0 ? first_event : 0;
}

// --------------------------------------------------------------------------------------------- all
pleuel_status pl_scene_make(pl_job* job, pl_model* model, const pl_result* result,
                            const pl_scene_options* options, pl_scene** out) {
  pl_arena* a = job->arena;
  pl_scene_options none = {0};
  pl_stage stage = {.job = job,
                    .arena = a,
                    .model = model,
                    .pool = model->pool,
                    .result = result,
                    .options = options ? options : &none,
                    .random = {20}};
  pl_stage* s = &stage;
  pl_scene* scene = PL_NEW(a, pl_scene);
  *out = scene;
  scene->description[0] = scene->description[1] = "";
  if (model->blocks.n > 0 && pl_model_expand(job, model, MOST_COORDINATES, &s->model) != PLEUEL_OK)
    s->model = model;
  s->pool = s->model->pool;
  if (s->model->blocks.n > 0) return PLEUEL_OK;  // too large to be drawn
  find_coordinates(s);
  pl_stage_things(s);
  for (int k = 0; k < s->n_q; k++) s->angle[k] = is_angle(s, s->q[k]);
  bool schematic = s->things.n == 0;
  for (int i = 0; i < s->model->constraints.n; i++) {
    pl_bond b = {.c = &s->model->constraints.at[i],
                 .settles = -1,
                 .velocity = s->model->constraints.at[i].has_velocity};
    pl_push(a, s->bonds, b);
  }
  find_values(s);
  find_gravity(s);
  PL_TRY(pl_stage_frames(s));
  pl_stage_set(s, 0);
  if (schematic) pl_stage_schematic(s);
  pl_stage_set(s, 0);
  if (s->model->gravities.n == 0) find_pull(s);
  pl_stage_bonds(s);
  add_loads(s);
  add_things(s);
  pl_stage_arrows(s);
  pl_stage_draws(s);
  scene->n_frames = s->n_frames;
  scene->t = s->t;
  scene->newton_per_metre = s->newton_per_metre;
  scene->speed_per_metre = s->speed_per_metre;
  PL_TRY(make_shapes(s, scene));
  find_box(scene);
  make_marks(s, scene);
  pl_stage_words(s, scene);
  return PLEUEL_OK;
}
