// Notes on what was read otherwise than it was perhaps meant: a coordinate in the place of another
// axis, degrees without their sign.
#include "model_impl.h"

#include <math.h>
#include <string.h>

// -------------------------------------------------------------------------------------- components
// "z" of a plain coordinate z, z2, z_m or z[i]; NULL for anything else.
static const char* axis_letter(const pl_model* m, pl_arena* a, pl_expr e) {
  pl_kind kind = pl_kind_of(m->pool, e);
  if (kind != PL_SYMBOL && kind != PL_AT) return NULL;
  const pl_symbol_info* info = pl_symbol_get(m->pool, pl_symbol_of(m->pool, e));
  if (info->role != PL_R_COORD && info->role != PL_R_ARRAY) return NULL;
  size_t n = strcspn(info->ascii, "_0123456789");
  return n ? pl_copy_n(a, info->ascii, n) : NULL;
}

static bool told_place(pl_job* job, const pl_model* m, const pl_point* p, pl_span span) {
  if (p->n < 2 || p->n != m->n_axes) return false;
  for (int k = 0; k < p->n; k++) {
    const char* letter = axis_letter(m, job->arena, p->at[k]);
    for (int j = 0; letter && j < m->n_axes; j++) {
      if (j == k || strcmp(m->axes[j].ascii, letter) != 0) continue;
      const char* name = pl_expr_words(job->arena, m->pool, p->at[k]);
      pl_diagnostic* d = pl_tell(
          job, PL_N076, p->span.source ? p->span : span,
          PL_BOTH_FORMAT(job->arena, "%s stands in the place of %s", name, m->axes[k].name));
      const char* third = m->n_axes == 3 ? PL_F(job, ", %s", m->axes[2].name) : "";
      pl_report_reason(d, PL_BOTH_FORMAT(job->arena, "points are read as (%s, %s%s)",
                                         m->axes[0].name, m->axes[1].name, third));
      pl_report_fix(
          d, PL_BOTH("write the components in this order, whatever the line `axes` says first"),
          NULL);
      return true;
    }
  }
  return false;
}

static void check_places(pl_job* job, const pl_model* m) {
  bool told = false;
  for (int i = 0; i < m->masses.n && !told; i++)
    told = told_place(job, m, &m->masses.at[i].point, m->masses.at[i].span);
  for (int i = 0; i < m->bodies.n && !told; i++)
    told = told_place(job, m, &m->bodies.at[i].centre, m->bodies.at[i].span);
  for (int i = 0; i < m->points.n && !told; i++)
    told = told_place(job, m, &m->points.at[i].point, m->points.at[i].span);
}

// ------------------------------------------------------------------------------------------ angles
typedef struct angle_search {
  pl_model* m;
  pl_arena* arena;
  pl_map* angle;  // by symbol id: it stands in a sine, cosine or tangent
} angle_search;

static void mark_angles(angle_search* s, pl_expr e, bool inside, pl_map* visited) {
  const pl_pool* p = s->m->pool;
  uint64_t key = ((uint64_t)e.id << 1) | inside;
  if (pl_is_poison(e) || pl_map_get(visited, key)) return;
  pl_map_set(visited, key, 1);
  pl_kind kind = pl_kind_of(p, e);
  if ((kind == PL_SYMBOL || kind == PL_AT) && inside)
    pl_map_set(s->angle, pl_symbol_of(p, e).id, 1);
  if (kind == PL_CALL)
    inside = pl_function_of(p, e) == PL_SIN || pl_function_of(p, e) == PL_COS
             || pl_function_of(p, e) == PL_TAN;
  int factors = 0;
  for (int i = 0; kind == PL_MUL && i < pl_n_args(p, e); i++)
    factors += !pl_is_number(p, pl_arg(p, e, i));
  if (factors > 1 || kind == PL_AT) inside = false;  // sin(ω t), sin(x/l)
  for (int i = 0; i < pl_n_args(p, e); i++) mark_angles(s, pl_arg(p, e, i), inside, visited);
}

static void see_angles(void* user, const pl_slot* slot) {
  angle_search* s = user;
  if (slot->kind == PL_SLOT_INIT || slot->kind == PL_SLOT_ASK) return;
  mark_angles(s, *slot->at, false, pl_map_make(s->arena));
}

static void check_degrees(pl_job* job, pl_model* m) {
  static const double turn = 6.2831853071795864769;
  angle_search s = {m, job->arena, pl_map_make(job->arena)};
  pl_model_each_slot(m, see_angles, &s);
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* x = &m->inits.at[i];
    if (pl_is_poison(x->value) || pl_is_poison(x->target) || !pl_is_int(m->pool, x->value, NULL))
      continue;
    pl_kind kind = pl_kind_of(m->pool, x->target);
    if ((kind != PL_SYMBOL && kind != PL_AT)
        || !pl_map_get(s.angle, pl_symbol_of(m->pool, x->target).id))
      continue;
    double value = pl_number_double(m->pool, x->value);
    const pl_source* source = x->span.source;
    const char* text = source ? pl_copy_n(job->arena, source->text + x->span.begin,
                                          x->span.end - x->span.begin)
                              : "";
    if (fabs(value) <= turn || strstr(text, "rad")) continue;
    const char* name = pl_expr_words(job->arena, m->pool, x->target);
    pl_diagnostic* d = pl_tell(job, PL_N021, x->span,
                               PL_BOTH_FORMAT(job->arena, "%s = %g is taken in radians: %.3g turns",
                                              name, value, value / turn));
    pl_report_fix(
        d,
        PL_BOTH_FORMAT(job->arena, "write %g° if degrees are meant, %g [rad] if not", value, value),
        NULL);
  }
}

// ----------------------------------------------------------------------------------------- gravity
static bool moves_along(pl_job* job, const pl_model* m, int axis) {
  for (int i = 0; i < m->masses.n; i++)
    if (pl_has_coordinate(m->pool, m->masses.at[i].point.at[axis], job->arena)) return true;
  for (int i = 0; i < m->bodies.n; i++)
    if (pl_has_coordinate(m->pool, m->bodies.at[i].centre.at[axis], job->arena)) return true;
  return false;
}

static void check_idle_gravity(pl_job* job, const pl_model* m) {
  if (m->masses.n + m->bodies.n == 0 || job->diagnostics->n_errors) return;
  for (int i = 0; i < m->gravities.n; i++) {
    const pl_gravity* g = &m->gravities.at[i];
    if (g->axis < 0 || g->axis >= m->n_axes || moves_along(job, m, g->axis)) continue;
    const char* axis = m->axes[g->axis].name;
    pl_diagnostic* d = pl_tell(
        job, PL_N064, g->span,
        PL_BOTH_FORMAT(job->arena, "gravity has no effect: no mass moves along %s", axis));
    pl_report_fix(
        d, PL_BOTH("let it point along an axis that masses move along, or leave it as it is"),
        NULL);
  }
}

// ------------------------------------------------------------------------------------------- start
// A run without any start value begins somewhere. Where constraints may give every coordinate
// nothing is said.
static void check_no_start(pl_job* job, const pl_model* m) {
  if (!m->simulate.given || m->inits.n > 0 || m->blocks.n > 0 || job->diagnostics->n_errors) return;
  if (m->coords.n + m->choose.coords.n == 0 || m->coords.n <= m->constraints.n) return;
  const char* name = pl_symbol_get(m->pool, m->coords.at[0].symbol)->name;
  pl_diagnostic* d = pl_tell(
      job, PL_N077, m->simulate.span,
      PL_BOTH("no start value is given: the run begins at a place of its own choice"));
  pl_report_fix(d, PL_BOTH_FORMAT(job->arena, "give one: init %s = ..., %s' = ...", name, name),
                NULL);
}

void pl_check_reading(pl_job* job, pl_model* m) {
  check_no_start(job, m);
  check_idle_gravity(job, m);
  check_places(job, m);
  check_degrees(job, m);
}
