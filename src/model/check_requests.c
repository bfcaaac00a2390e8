// Choice of coordinates, events and requests: whether what they speak of is there.
#include "model_impl.h"

#include <string.h>

// ------------------------------------------------------------------------------------------ choose
static bool is_chosen(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->choose.coords.n; i++) {
    if (m->choose.coords.at[i].id == s.id) return true;
  }
  return false;
}

static pl_span choose_place(const pl_model* m, int i) {
  pl_span s = m->choose.maps[i].span;
  return s.source ? s : m->choose.span;
}

// The map that gives a coordinate, or -1.
static int map_of(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->choose.n_maps; i++) {
    pl_expr old = m->choose.maps[i].old;
    if (!pl_is_poison(old) && pl_kind_of(m->pool, old) == PL_SYMBOL
        && pl_symbol_of(m->pool, old).id == s.id)
      return i;
  }
  return -1;
}

static bool map_returns(const pl_model* m, pl_arena* a, int from, int wanted, char* visited) {
  pl_expr map = m->choose.maps[from].map;
  if (pl_is_poison(map)) return false;
  int n = pl_symbols_in(m->pool, map, NULL, 0);
  pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
  pl_symbols_in(m->pool, map, s, n);
  for (int i = 0; i < n; i++) {
    int next = map_of(m, s[i]);
    if (next < 0) continue;
    if (next == wanted) return true;
    if (visited[next]) continue;
    visited[next] = 1;
    if (map_returns(m, a, next, wanted, visited)) return true;
  }
  return false;
}

static void check_map(pl_job* job, pl_model* m, int i) {
  pl_expr old = m->choose.maps[i].old, map = m->choose.maps[i].map;
  if (pl_is_poison(old) || pl_is_poison(map)) return;
  pl_span at = choose_place(m, i);
  pl_kind kind = pl_kind_of(m->pool, old);
  bool coordinate = (kind == PL_SYMBOL
                     && pl_symbol_get(m->pool, pl_symbol_of(m->pool, old))->role == PL_R_COORD)
                    || (kind == PL_AT && pl_dots_of(m->pool, old) == 0);
  const char* text = pl_expr_words(job->arena, m->pool, old);
  if (!coordinate) {
    pl_diagnostic* d = pl_tell(
        job, PL_E058, at,
        PL_BOTH_FORMAT(job->arena, "%s is not a coordinate: `with` gives the old coordinates",
                       text));
    pl_report_fix(d, PL_BOTH("write  old coordinate = expression of the chosen ones"), NULL);
    return;
  }
  pl_symbol s = pl_symbol_of(m->pool, old);
  if (kind == PL_SYMBOL && is_chosen(m, s)) {
    pl_diagnostic* d = pl_tell(
        job, PL_E058, at,
        PL_BOTH_FORMAT(job->arena, "%s is chosen and given by a map at the same time", text));
    pl_report_fix(d, PL_BOTH_FORMAT(job->arena, "remove %s from one of them", text), NULL);
  }
  if (kind == PL_SYMBOL && map_of(m, s) != i) {
    pl_diagnostic* d = pl_tell(job, PL_E058, at,
                               PL_BOTH_FORMAT(job->arena, "%s is given by two maps", text));
    pl_report_fix(d, PL_BOTH("keep one of them"), NULL);
  }
  if (pl_max_dots(m->pool, map, job->arena) > 0 || pl_has_role(m->pool, map, PL_R_MULTIPLIER)) {
    pl_diagnostic* d = pl_tell(
        job, PL_E058, at,
        PL_BOTH_FORMAT(job->arena, "the map of %s may contain coordinates and time only", text));
    pl_report_fix(d, PL_BOTH("write it with positions"), NULL);
  }
  if (kind == PL_SYMBOL
      && map_returns(m, job->arena, i, i, PL_ARRAY(job->arena, char, m->choose.n_maps + 1))) {
    pl_diagnostic* d = pl_tell(
        job, PL_E058, at, PL_BOTH_FORMAT(job->arena, "the map of %s leads back to %s", text, text));
    pl_report_fix(d, PL_BOTH("write it with the chosen coordinates"), NULL);
  }
}

static void check_choose(pl_job* job, pl_model* m) {
  int before = job->diagnostics->n_errors;
  for (int i = 0; i < m->choose.n_maps && job->diagnostics->n_errors == before; i++)
    check_map(job, m, i);
  if (job->diagnostics->n_errors > before) return;
  // with maps, a chosen coordinate that stands in none of them and in nothing else steers nothing
  for (int k = 0; k < m->choose.coords.n && m->choose.n_maps; k++) {
    pl_symbol q = m->choose.coords.at[k];
    bool used = false;
    for (int i = 0; i < m->choose.n_maps && !used; i++)
      used = !pl_is_poison(m->choose.maps[i].map)
             && pl_has_symbol(m->pool, m->choose.maps[i].map, q);
    for (int i = 0; i < m->masses.n && !used; i++) {
      for (int c = 0; c < m->masses.at[i].point.n; c++)
        used |= !pl_is_poison(m->masses.at[i].point.at[c])
                && pl_has_symbol(m->pool, m->masses.at[i].point.at[c], q);
    }
    for (int i = 0; i < m->bodies.n && !used; i++) {
      used |= !pl_is_poison(m->bodies.at[i].angle)
              && pl_has_symbol(m->pool, m->bodies.at[i].angle, q);
      for (int c = 0; c < m->bodies.at[i].centre.n; c++)
        used |= !pl_is_poison(m->bodies.at[i].centre.at[c])
                && pl_has_symbol(m->pool, m->bodies.at[i].centre.at[c], q);
    }
    for (int i = 0; i < m->loads.n && !used; i++)
      used = !pl_is_poison(m->loads.at[i].value) && pl_has_symbol(m->pool, m->loads.at[i].value, q);
    for (int i = 0; i < m->constraints.n && !used; i++)
      used = !pl_is_poison(m->constraints.at[i].g)
             && pl_has_symbol(m->pool, m->constraints.at[i].g, q);
    if (used) continue;
    const char* name = pl_symbol_get(m->pool, q)->name;
    pl_diagnostic* d = pl_tell(
        job, PL_E058, m->choose.span,
        PL_BOTH_FORMAT(job->arena, "%s is chosen, but no map contains it", name));
    pl_report_fix(d, PL_F(job, "choose %s with x = ... %s ...", name, name),
                  PL_F(job, "choose %s with x = ... %s ...", name, name), NULL);
  }
}

// ------------------------------------------------------------------------------------------ events
static bool depends_on_motion(pl_job* job, const pl_model* m, pl_expr e) {
  if (pl_has_coordinate(m->pool, e, job->arena) || pl_has_symbol(m->pool, e, pl_time(m->pool)))
    return true;
  if (pl_has_role(m->pool, e, PL_R_MULTIPLIER)) return true;
  for (int i = 0; i < m->result_names.n; i++) {
    if (pl_has_symbol(m->pool, e, m->result_names.at[i].symbol)) return true;
  }
  return false;
}

static bool is_released(const pl_model* m, const char* label) {
  for (int i = 0; i < m->events.n; i++) {
    for (int k = 0; k < m->events.at[i].actions.n; k++) {
      const pl_action* a = &m->events.at[i].actions.at[k];
      if (a->kind == PL_DO_RELEASE && a->label && strcmp(a->label, label) == 0) return true;
    }
  }
  return false;
}

static void check_action(pl_job* job, pl_model* m, const pl_event* e, const pl_action* a) {
  pl_span at = a->span.source ? a->span : e->span;
  if (a->kind == PL_DO_ATTACH && a->label) {
    const pl_constraint* c = pl_model_constraint(m, a->label);
    if (!c || c->off || c->relation != PL_EQ || is_released(m, a->label)) return;
    pl_diagnostic* d = pl_tell(
        job, PL_E063, at,
        PL_BOTH_FORMAT(job->arena, "%s holds all the time, so it cannot be attached", a->label));
    pl_report_fix(
        d, PL_BOTH_FORMAT(job->arena, "start it inactive: constraint %s: ... , off", a->label),
        NULL);
    return;
  }
  if (a->kind != PL_DO_SET || pl_is_poison(a->target)) return;
  pl_kind kind = pl_kind_of(m->pool, a->target);
  bool atom = kind == PL_SYMBOL || kind == PL_AT;
  pl_role role = atom ? pl_symbol_get(m->pool, pl_symbol_of(m->pool, a->target))->role : PL_R_TIME;
  bool good = atom
              && (role == PL_R_COORD || role == PL_R_VELOCITY || role == PL_R_PARAM
                  || (role == PL_R_ARRAY && pl_dots_of(m->pool, a->target) < 2));
  if (good) return;
  pl_diagnostic* d = pl_tell(job, PL_E063, at,
                             PL_BOTH_FORMAT(job->arena, "%s cannot be set by an event",
                                            pl_expr_words(job->arena, m->pool, a->target)));
  pl_report_fix(d, PL_BOTH("an event sets coordinates, velocities and parameters"), NULL);
}

static void check_event(pl_job* job, pl_model* m, const pl_event* e) {
  if (!pl_is_poison(e->value) && !depends_on_motion(job, m, e->value)) {
    const char* name = e->name.text ? e->name.text : "?";
    pl_diagnostic* d = pl_tell(
        job, PL_E062, e->span,
        PL_BOTH_FORMAT(job->arena, "event %s does not depend on the motion", name));
    pl_report_fix(d, PL_BOTH("use a coordinate, a velocity, a force or t"), NULL);
  }
  for (int k = 0; k < e->actions.n; k++) check_action(job, m, e, &e->actions.at[k]);
}

// ---------------------------------------------------------------------------------------- requests
static void check_solve(pl_job* job, pl_model* m, const pl_ask* a) {
  if (pl_is_poison(a->value) || pl_kind_of(m->pool, a->value) != PL_SYMBOL) return;
  const pl_symbol_info* info = pl_symbol_get(m->pool, pl_symbol_of(m->pool, a->value));
  if (info->role != PL_R_PARAM && info->role != PL_R_TIME) return;
  pl_diagnostic* d = pl_tell(
      job, PL_E057, a->span,
      PL_BOTH_FORMAT(job->arena, "%s is given, there is nothing to solve for", info->name));
  pl_report_fix(d, PL_BOTH("solve for a multiplier, an acceleration x'' or a motion x(t)"), NULL);
}

static void check_frame(pl_job* job, pl_model* m, const pl_ask* a) {
  for (int k = 0; k < a->frame.n; k++) {
    const pl_symbol_info* info = pl_symbol_get(m->pool, a->frame.at[k]);
    if (info->role == PL_R_COORD) continue;
    pl_diagnostic* d = pl_tell(
        job, PL_E057, a->span,
        PL_BOTH_FORMAT(job->arena, "equations cannot be written in %s: it is no coordinate",
                       info->name));
    pl_report_fix(d, PL_BOTH("name coordinates: in (r, θ)"), NULL);
  }
}

void pl_check_requests(pl_job* job, pl_model* m) {
  check_choose(job, m);
  for (int i = 0; i < m->events.n; i++) check_event(job, m, &m->events.at[i]);
  for (int i = 0; i < m->asks.n; i++) {
    if (m->asks.at[i].kind == PL_ASK_SOLVE) check_solve(job, m, &m->asks.at[i]);
    check_frame(job, m, &m->asks.at[i]);
  }
}
