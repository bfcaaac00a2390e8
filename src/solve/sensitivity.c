// Derivatives of a motion through contacts and events that change it.
//
// A run of the motion alone, the lead run, goes ahead to the next moment at which something happens
// and decides what; the run with the derivatives (record_variation.c) follows in the mode that
// holds until then. There the derivatives jump. With the moment t* at which e(q, v, a, λ, t, p) =
// 0, for each direction
//
//     dt* = -(e_p + e_q δ + ...) / (de/dt),   Dq = δ + v- dt*,   Dv = δ' + a- dt*    just before,
//     Dq, Dv through what the event does: the derivative of the impact, or of the new values,
//     δ = Dq - v+ dt*,     δ' = Dv - a+ dt*                                     just after
//
// [Rozenwasser1959], [HiskensPai2000], for impacts [LeineNijmeijer2004]. The derivative of an
// impact needs no formula of its own: the impulses of the system with the variations are the
// derivatives of the impulses. What has no derivative is refused when it happens: grazing contacts,
// and two things at once that each change the motion.
// See theory (16.3), (16.4).
#include <math.h>
#include <string.h>

#include "solve/driver_impl.h"

typedef struct report {
  pl_event_record e;  // without its rows
  double t;
} report;

struct pl_sensitivity {
  pl_run *lead, *follower;
  const pl_varied* s;
  report* report;  // what happened at the moment ahead
  int n_reports, room;
  bool waits;         // that moment is not reached by the follower yet
  pleuel_status how;  // that the lead run ended with
  const char* why;
  double t;                                      // the moment
  double *q, *v, *a, *l, *lambda_rate, *a_rate;  // of the lead run just before it     (n_q, n_c)
  long impacts;                                  // of the lead run, before
  double* dt;                                    // of the directions
  double* watched;                               // values, slopes, variations of what is watched
  double* flow;                       // the same, with the motion itself as the variation
  double *row, *row_size, *flow_row;  // of the follower
  char* mode;                         // until the moment
  pl_keeper before;                   // state of the lead run where it set out for the moment ahead
};

// ----------------------------------------------------------------------- what the lead run reports
// Slopes of accelerations and multipliers at the end of the last step.
static void slope_of(const double* X, int n, int last, double dt, double* out) {
  for (int i = 0; i < n; i++) out[i] = 0;
  for (int k = last; k >= 1; k--)
    for (int i = 0; i < n; i++) out[i] = out[i] * dt + k * X[(size_t)k * (size_t)n + (size_t)i];
}

static void remember_point(pl_sensitivity* p) {
  pl_run* run = p->lead;
  size_t n_q = (size_t)p->s->n_q * sizeof(double), n_c = (size_t)p->s->n_c * sizeof(double);
  memcpy(p->q, run->event->save_q, n_q);
  memcpy(p->v, run->event->save_v, n_q);
  memcpy(p->a, run->event->save_a, n_q);
  memcpy(p->l, run->event->save_l, n_c);
  slope_of(run->dae.A_last, p->s->n_q, run->control.use_last - 1, run->dae.t - run->control.t_last,
           p->a_rate);
  slope_of(run->dae.L_last, p->s->n_c, run->control.use_last - 1, run->dae.t - run->control.t_last,
           p->lambda_rate);
}

static pleuel_status hear(void* user, const pl_event_record* e) {
  pl_sensitivity* p = user;
  if (p->n_reports == 0 && p->lead) remember_point(p);
  if (p->n_reports == p->room) return PLEUEL_OK;
  p->report[p->n_reports] = (report){*e, e->after.t};
  p->report[p->n_reports].e.label = e->label;
  p->n_reports++;
  return PLEUEL_OK;
}

pl_sensitivity* pl_sensitivity_make(pl_job* job, const pl_run* follower, const pl_setup* plain,
                                    pl_sink* sink) {
  pl_arena* a = job->arena;
  pl_sensitivity* p = PL_NEW(a, pl_sensitivity);
  const pl_varied* s = p->s = follower->setup->varied;
  p->room = s->n_c + plain->n_frictions + plain->n_events * (s->n_c + 1) + 4;
  p->report = PL_ARRAY(a, report, p->room);
  double** of_q[] = {&p->q, &p->v, &p->a, &p->a_rate};
  for (size_t i = 0; i < 4; i++) *of_q[i] = PL_ARRAY(a, double, s->n_q + 1);
  p->l = PL_ARRAY(a, double, s->n_c + 1);
  p->lambda_rate = PL_ARRAY(a, double, s->n_c + 1);
  p->dt = PL_ARRAY(a, double, s->n_directions + 1);
  p->watched = PL_ARRAY(a, double, follower->setup->n_watched + 1);
  p->flow = PL_ARRAY(a, double, follower->setup->n_watched + 1);
  p->row = PL_ARRAY(a, double, follower->n_c + 1);
  p->flow_row = PL_ARRAY(a, double, follower->n_c + 1);
  p->row_size = PL_ARRAY(a, double, follower->n_c + 1);
  p->mode = PL_ARRAY(a, char, follower->output->mode_size);
  *sink = (pl_sink){.user = p, .event = hear};
  return p;
}

// ----------------------------------------------------------------------------- the follower's mode
static void take_mode(pl_sensitivity* p) {
  const pl_varied* s = p->s;
  for (int c = 0; c < s->n_c; c++)
    for (int k = 0; k < 2 * s->n_directions; k++)
      p->follower->dae.on[k * s->n_c + c] = p->lead->dae.active[c];
  pl_output_mode(p->lead, p->mode);
}

static void close(pl_sensitivity* p) { pl_run_free(p->lead); }

static const char* mode_of(const pl_sensitivity* p) { return p->mode; }
static bool waits(const pl_sensitivity* p) { return p->waits; }

// ----------------------------------------------------------------------------- events for the sink
static pleuel_status send_reports(pl_sensitivity* p) {
  pl_run* f = p->follower;
  for (int i = 0; i < p->n_reports; i++) {
    const report* t = &p->report[i];
    const pl_sink* s = &f->options.sink;
    f->stats.n_events++;
    if (!s->event) continue;
    pl_event_record e = t->e;
    e.before = (pl_row){.t = f->dae.t,
                        .q = f->event->save_q,
                        .v = f->event->save_v,
                        .a = f->event->save_a,
                        .lambda = f->event->save_l,
                        .unique = f->event->save_unique,
                        .out = f->output->out_before,
                        .mode = f->output->mode_before,
                        .kind = PL_ROW_BEFORE};
    e.after = pl_output_row(f, PL_ROW_AFTER, f->output->out_now, f->output->mode);
    double dt = t->t - f->dae.t;
    if (e.bounces > 0 && dt != 0) {
      // the state at the limit of the bounces
      for (int k = 0; k < f->n_q; k++) {
        f->control.row_q[k] = f->dae.q[k] + dt * (f->dae.v[k] + 0.5 * dt * f->dae.A[k]);
        f->control.row_v[k] = f->dae.v[k] + dt * f->dae.A[k];
      }
      PL_TRY(pl_output_event_beside(f, e, t->t, f->dae.A, f->dae.L));
      continue;
    }
    pleuel_status how = s->event(s->user, &e);
    f->output->refused |= how != PLEUEL_OK;
    PL_TRY(how);
  }
  p->n_reports = 0;
  return PLEUEL_OK;
}

static pleuel_status begin(pl_sensitivity* p) {
  pl_output_before(p->follower);
  return send_reports(p);
}

// -------------------------------------------------------------------------------------------- when
static const char* name_of(const pl_run* run, const pl_watch* w) {
  if (w->kind == PL_WATCH_EVENT) return run->setup->events[w->index].name;
  return run->setup->constraints[w->index].name;
}

static bool switches(const pl_run* run, const pl_watch* w) {
  if (w->kind != PL_WATCH_EVENT) return true;
  const pl_event_setup* e = &run->setup->events[w->index];
  for (int d = 0; d < e->n_actions; d++)
    if (e->actions[d].kind != PL_ACTION_STOP && e->actions[d].kind != PL_ACTION_RECORD) return true;
  return false;
}

static const char* label_of(const pl_sensitivity* p) {
  return p->n_reports > 0 && p->report[0].e.label ? p->report[0].e.label : "?";
}

// What changes the motion: exactly one thing.
static pleuel_status find_cause(const pl_sensitivity* p, int* cause) {
  const pl_run* run = p->lead;
  *cause = -1;
  for (int i = 0; i < run->event->n_watch; i++) {
    if (!run->event->hit[i] || !switches(run, &run->event->watch[i])) continue;
    if (*cause >= 0)
      return pl_fail(
          p->follower->job, PLEUEL_UNSUPPORTED,
          "the motion has no derivative at t = %.9g s: %s changes together with something else",
          p->t, name_of(run, &run->event->watch[i]));
    *cause = i;
    if (run->event->touch[i])
      return pl_fail(p->follower->job, PLEUEL_UNSUPPORTED,
                     "the motion has no derivative at t = %.9g s: %s is only grazed", p->t,
                     name_of(run, &run->event->watch[i]));
  }
  if (*cause < 0)
    return pl_fail(
        p->follower->job, PLEUEL_UNSUPPORTED,
        "the motion has no derivative at t = %.9g s: %s changes with nothing that leads to it",
        p->t, label_of(p));
  return PLEUEL_OK;
}

// The watched quantities at another state than that of the follower.
static void watch_at(pl_sensitivity* p, const double* q, const double* v, const double* a,
                     const double* lambda, double* out) {
  pl_run* f = p->follower;
  pl_batches* b = &f->watched;
  if (f->setup->n_watched == 0) return;
  pl_batches_time(b, f->dae.t);
  pl_batches_load_q(b, q, 0);
  pl_batches_load_v(b, v, 0);
  pl_batches_load_a(b, a, 0);
  pl_batches_load_lambda(b, lambda, 0);
  for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
    pl_batches_sweep(b, (pl_tape_level)level, 0, true);
  pl_batches_outputs(b, out, f->setup->n_watched, 0);
}

// The change along the motion of everything watched: variations taken along it, without what they
// depend on p by, with that on t. row_q and so on serve as the state; flow[i] is d(watched i)/dt.
static void watch_flow(pl_sensitivity* p) {
  pl_run* f = p->follower;
  const pl_varied* s = p->s;
  size_t n = (size_t)s->n_q, c = (size_t)s->n_c;
  if (s->n_watched == 0) return;
  double* state[] = {f->control.row_q, f->control.row_v, f->control.row_a};
  const double* along[2][3] = {{NULL, NULL, NULL}, {p->v, p->a, p->a_rate}};
  const double* from[] = {f->dae.q, f->dae.v, f->dae.A};
  for (int with = 0; with < 2; with++) {
    for (int i = 0; i < 3; i++) {
      memcpy(state[i], from[i], (size_t)f->n_q * sizeof(double));
      for (size_t e = 0; e < n; e++) state[i][n + e] = with ? along[1][i][e] : 0;
    }
    memcpy(f->control.row_l, f->dae.L, (size_t)f->n_c * sizeof(double));
    for (size_t e = 0; e < c; e++) f->control.row_l[c + e] = with ? p->lambda_rate[e] : 0;
    watch_at(p, f->control.row_q, f->control.row_v, f->control.row_a, f->control.row_l, p->watched);
    for (int i = 0; i < s->n_watched; i++)
      p->flow[i] = with ? p->watched[2 * s->n_watched + i] - p->flow[i]
                              + p->watched[s->n_watched + i]
                        : p->watched[2 * s->n_watched + i];
  }
  watch_at(p, f->dae.q, f->dae.v, f->dae.A, f->dae.L, p->watched);
}

// Rows of the constraints of the follower at its point.
static void find_rows(pl_sensitivity* p, bool speeds) {
  pl_run* f = p->follower;
  pl_point_evaluate(&f->dae, f->dae.t, f->dae.q, f->dae.v);
  pl_assemble_g(&f->dae, 0, f->dae.g, f->dae.g_size);
  if (speeds) pl_assemble_gdot(&f->dae, p->row, p->row_size);
  else memcpy(p->row, f->dae.g, (size_t)f->n_c * sizeof(double));
}

// dt* of each direction, from the state of the follower just before.
static pleuel_status find_moment(pl_sensitivity* p, int cause) {
  pl_run* f = p->follower;
  const pl_varied* s = p->s;
  const pl_watch* w = &p->lead->event->watch[cause];
  const char* name = name_of(p->lead, w);
  int c = w->index, n = s->n_c;
  double rate = 0;
  if (w->kind == PL_WATCH_LANDING) {
    find_rows(p, true);
    rate = p->row[n + c];
    if (!(fabs(rate) > 1e-13 * p->row_size[n + c]))
      return pl_fail(p->follower->job, PLEUEL_UNSUPPORTED,
                     "the motion has no derivative at t = %.9g s: %s is only grazed", p->t, name);
    find_rows(p, false);
    for (int k = 0; k < s->n_directions; k++) p->dt[k] = -p->row[2 * k * n + c] / rate;
  } else if (w->kind == PL_WATCH_RELEASE) {
    rate = p->lambda_rate[c];
    if (!p->lead->event->save_unique[c])
      return pl_fail(
          p->follower->job, PLEUEL_UNSUPPORTED,
          "the motion has no derivative at t = %.9g s: the force of %s is not determined", p->t,
          name);
    if (!(fabs(rate) > 0))
      return pl_fail(p->follower->job, PLEUEL_UNSUPPORTED,
                     "the motion has no derivative at t = %.9g s: %s only just lets go", p->t,
                     name);
    for (int k = 0; k < s->n_directions; k++) p->dt[k] = -f->dae.L[(2 * k + 1) * n + c] / rate;
  } else {
    int i = p->lead->setup->events[c].watch;
    rate = p->flow[i];
    if (!(fabs(rate) > 0))
      return pl_fail(p->follower->job, PLEUEL_UNSUPPORTED,
                     "the motion has no derivative at t = %.9g s: %s only touches zero", p->t,
                     name);
    for (int k = 0; k < s->n_directions; k++)
      p->dt[k] = -p->watched[(2 + k) * s->n_watched + i] / rate;
  }
  for (int k = 0; k < s->n_directions; k++)
    if (!isfinite(p->dt[k]))
      return pl_fail(p->follower->job, PLEUEL_UNSUPPORTED,
                     "the motion has no derivative at t = %.9g s: %s only touches zero", p->t,
                     name);
  return PLEUEL_OK;
}

// ---------------------------------------------------------------------------------------- the jump
// δ and δ' in the follower become total derivatives of the state at the moment, or what is left of
// them behind it.
static void shift(const pl_sensitivity* p, double* variations, const double* rate, double sign) {
  const pl_varied* s = p->s;
  for (int k = 0; k < s->n_directions; k++)
    for (int i = 0; i < s->n_q; i++)
      variations[(2 * k + 1) * s->n_q + i] += sign * p->dt[k] * rate[i];
}

static void set_motion(pl_sensitivity* p, const double* q, const double* v) {
  const pl_varied* s = p->s;
  for (int k = 0; k < s->n_directions; k++) {
    memcpy(p->follower->dae.q + 2 * k * s->n_q, q, (size_t)s->n_q * sizeof(double));
    memcpy(p->follower->dae.v + 2 * k * s->n_q, v, (size_t)s->n_q * sizeof(double));
  }
}

static bool sets_values(const pl_run* run, const pl_watch* w) {
  if (w->kind != PL_WATCH_EVENT) return false;
  const pl_event_setup* e = &run->setup->events[w->index];
  for (int d = 0; d < e->n_actions; d++)
    if (e->actions[d].kind == PL_ACTION_SET_Q || e->actions[d].kind == PL_ACTION_SET_V) return true;
  return false;
}

static bool moves(const pl_run* run) {
  for (int i = 0; i < run->dae.motion.n; i++)
    if (run->dae.motion.at[i].pattern->n_gt > 0) return true;
  return false;
}

// New values that an event sets: total derivatives of what is set.
static void set_values(pl_sensitivity* p, int cause) {
  const pl_varied* s = p->s;
  const pl_event_setup* e = &p->lead->setup->events[p->lead->event->watch[cause].index];
  for (int d = 0; d < e->n_actions; d++) {
    const pl_event_action* action = &e->actions[d];
    if (action->kind != PL_ACTION_SET_Q && action->kind != PL_ACTION_SET_V) continue;
    for (int k = 0; k < s->n_directions; k++) {
      double* to = (action->kind == PL_ACTION_SET_Q ? p->follower->dae.q : p->follower->dae.v)
                   + (2 * k + 1) * s->n_q;
      to[action->target] = p->watched[(2 + k) * s->n_watched + action->value]
                           + p->dt[k] * p->flow[action->value];
    }
  }
}

// What the moment adds to the equations of the impact: M and G change along the motion before it by
// dt* dM/dt, dt* dG/dt.
//
// d/dt (G v + dg/dt) without accelerations, at the velocities v of the motion.
static void turn_of_rows(pl_sensitivity* p, const double* v, double* out) {
  pl_run* f = p->follower;
  const pl_varied* s = p->s;
  for (int i = 0; i < f->n_q; i++) {
    f->control.row_v[i] = (i / s->n_q) % 2 == 0 && v ? v[i % s->n_q] : 0;
    f->control.row_a[i] = 0;
  }
  pl_batches_load_v(&f->dae.motion, f->control.row_v, 0);
  pl_assemble_second(&f->dae, f->control.row_a, out, f->event->second_size);
}

// -dM/dt Δv + (dG/dt)^T Λ, times dt* of the direction, to the equations of the varied motion.
static void add_turn_of_forces(pl_sensitivity* p, const double* change) {
  pl_run *f = p->follower, *run = p->lead;
  const pl_varied* s = p->s;
  for (int i = 0; i < f->dae.motion.n; i++) {
    const pl_batch* b = &f->dae.motion.at[i];
    const pl_tape* tape = b->pattern->tape;
    for (const pl_pattern_entry* e = b->pattern->mass; e < b->pattern->mass + b->pattern->n_mass;
         e++) {
      int node = tape->roots[e->root];
      for (int l = 0; l < b->n && node >= tape->level_end[PL_LEVEL_CONST]; l++) {
        int q = b->q[e->row * b->lanes + l], d = b->q[e->col * b->lanes + l];
        if ((q / s->n_q) % 2 == (d / s->n_q) % 2) continue;
        if ((q / s->n_q) % 2 == 1) {
          q = q + d;
          d = q - d;
          q = q - d;
        }  // q of the motion, d of the variation
        f->dae.rhs[q] -= p->dt[q / s->n_q / 2] * pl_jet_at(b->jet, node, 1)[l] * change[d % s->n_q];
      }
    }
    for (const pl_pattern_entry* e = b->pattern->G; e < b->pattern->G + b->pattern->n_G; e++) {
      int node = tape->roots[e->root];
      for (int l = 0; l < b->n && node >= tape->level_end[PL_LEVEL_CONST]; l++) {
        int q = b->q[e->col * b->lanes + l], c = b->c[e->row * b->lanes + l];
        if ((c / s->n_c) % 2 == 0 || (q / s->n_q) % 2 == 1 || !run->event->impact_taken[c % s->n_c])
          continue;
        f->dae.rhs[q] += p->dt[q / s->n_q / 2] * pl_jet_at(b->jet, node, 1)[l]
                         * run->event->impulse[c % s->n_c];
      }
    }
  }
}

// The derivative of the impact: impulses of the system with the variations, where a velocity u
// along g becomes -e u and its variation -e du - de u. along: positions are still varied at fixed
// time, the moment adds its part.
static pleuel_status strike(pl_sensitivity* p, bool along) {
  pl_run *f = p->follower, *run = p->lead;
  const pl_varied* s = p->s;
  int n = s->n_c;
  double *turn = f->event->second, *change = p->flow_row, *jump_v = p->a_rate;
  set_motion(p, run->event->jump_q, run->event->jump_v);
  for (int c = 0; c < n; c++)
    for (int k = 0; k < 2 * s->n_directions; k++)
      f->dae.on[k * n + c] = run->event->impact_taken[c];
  pl_active_set_update(&f->dae);
  for (int i = 0; i < s->n_q; i++) jump_v[i] = run->dae.v[i] - run->event->jump_v[i];
  find_rows(p, true);
  if (along) {
    turn_of_rows(p, jump_v, change);
    turn_of_rows(p, NULL, turn);
    for (int c = 0; c < f->n_c; c++) change[c] -= turn[c];
    turn_of_rows(p, run->event->jump_v, turn);
  }
  pl_active_set_choose(&f->dae);
  f->dae.impulsive = true;
  bool regular = pl_point_factor(&f->dae, false);
  f->dae.impulsive = f->dae.factored = false;
  if (!regular) return pl_run_undetermined(f);
  for (int i = 0; i < f->n_q; i++) f->dae.rhs[i] = 0;
  if (along) add_turn_of_forces(p, jump_v);
  for (int c = 0; c < n; c++) {
    double e = run->event->impact_factor[c];
    for (int k = 0; k < s->n_directions; k++) {
      int varied = 2 * k * n + c, plain = varied + n;
      double u = p->row[plain], du = p->row[varied],
             de = e > 0 ? s->restitution_slope[k * n + c] : 0, more = 0;
      if (along) {
        du += p->dt[k] * turn[plain];
        more = p->dt[k] * change[plain];
      }
      f->dae.rhs[f->n_q + plain] = f->dae.taken[plain] ? -e * u - u : 0;
      f->dae.rhs[f->n_q + varied] = f->dae.taken[varied] ? -e * du - de * u - du - more : 0;
    }
  }
  pl_kkt_solve(&f->dae.kkt, f->dae.rhs);
  if (!isfinite(pl_norm(f->dae.rhs, f->n_q))) return pl_run_undetermined(f);
  for (int i = 0; i < f->n_q; i++) f->dae.v[i] += f->dae.rhs[i];
  return PLEUEL_OK;
}

static bool has_changed(const pl_sensitivity* p) {
  const pl_run* run = p->lead;
  if (run->event->impacts != p->impacts) return true;
  for (int c = 0; c < p->s->n_c; c++)
    if (p->follower->dae.on[c] != run->dae.active[c]) return true;
  for (int i = 0; i < run->event->n_watch; i++)
    if (run->event->hit[i] && switches(run, &run->event->watch[i])) return true;
  return false;
}

static pleuel_status jump(pl_sensitivity* p) {
  pl_run *f = p->follower, *run = p->lead;
  int cause;
  PL_TRY(find_cause(p, &cause));
  set_motion(p, p->q, p->v);
  watch_flow(p);
  PL_TRY(find_moment(p, cause));
  bool strikes = run->event->impacts != p->impacts,
       sets = sets_values(run, &run->event->watch[cause]);
  if (strikes && sets && moves(f))
    return pl_fail(
        p->follower->job, PLEUEL_UNSUPPORTED,
        "the motion has no derivative at t = %.9g s: %s sets values and strikes what moves", p->t,
        name_of(run, &run->event->watch[cause]));
  shift(p, f->dae.v, p->a, 1);
  if (strikes && !sets) PL_TRY(strike(p, true));
  shift(p, f->dae.q, p->v, 1);
  if (sets) set_values(p, cause);
  if (strikes && sets) PL_TRY(strike(p, false));
  set_motion(p, run->dae.q, run->dae.v);
  shift(p, f->dae.q, run->dae.v, -1);
  shift(p, f->dae.v, run->dae.A, -1);
  take_mode(p);
  f->dae.factored = false;
  PL_TRY(pl_modes_enter(f));
  pl_steppers_changed(f, true);
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------------- steps
static pleuel_status remember_state(pl_sensitivity* p) {
  pl_arena* a = p->lead->job->arena;
  pl_guard guard;
  if (p->before.arena == NULL) p->before = pl_keeper_to_write(a);
  p->before.next = 0;
  PL_GUARD(a, guard) {
    pl_run_save(p->lead, &p->before);
    guard.status = PLEUEL_OK;
  }
  pl_guard_end(a, &guard);
  return guard.status;
}

// To the next moment at which something happens, or to the end.
static void go_ahead(pl_sensitivity* p) {
  pl_run* run = p->lead;
  p->impacts = run->event->impacts;
  p->how = remember_state(p);
  while (p->how == PLEUEL_OK && p->n_reports == 0 && !pl_run_done(run)) p->how = pl_run_step(run);
  p->t = run->dae.t;
  p->waits = true;
  p->follower->control.stop = (pl_stop){true, run->dae.t, run->dae.t_low};
}

static pleuel_status arrive(pl_sensitivity* p) {
  pl_run* f = p->follower;
  f->control.stop.early = false;
  p->waits = false;
  if (p->how != PLEUEL_OK) return p->how;
  if (p->n_reports == 0) return PLEUEL_OK;
  bool changes = has_changed(p);
  // programs at the point by the general way, with their slopes along the motion
  if (f->stepper->to_patterns) f->stepper->to_patterns(f);
  f->dae.factored = false;
  if (changes && !pl_point_enter(&f->dae)) return pl_run_undetermined(f);
  if (changes) PL_TRY(pl_output_point(f, PL_ROW_BEFORE));
  pl_output_before(f);
  if (changes) PL_TRY(jump(p));
  pl_output_energy(f, true);
  PL_TRY(send_reports(p));
  f->control.stopped |= p->lead->control.stopped;
  return pl_output_point(f, PL_ROW_AFTER);
}

// Without the moment ahead the follower cannot go on: both are kept where they parted.
static pleuel_status stop_here(pl_sensitivity* p) {
  pl_run* f = p->follower;
  if (f->options.keep) f->options.keep(f->options.keep_user, f, true);
  return pl_fail(f->job, PLEUEL_INTERRUPTED, "interrupted at t = %.9g s", f->dae.t);
}

// A step of the follower; of = what takes one.
static pleuel_status step(pl_sensitivity* p, pleuel_status (*of)(pl_run* run)) {
  if (!p->waits) go_ahead(p);
  if (p->how == PLEUEL_INTERRUPTED) return stop_here(p);
  if (pl_run_left(p->follower) != 0) PL_TRY(of(p->follower));
  return pl_run_left(p->follower) == 0 ? arrive(p) : PLEUEL_OK;
}

// ------------------------------------------------------------------------------------- interrupted
// While the follower is on its way, the lead run is kept as it was where they parted: it goes ahead
// once more.
static void save(pl_sensitivity* p, pl_keeper* k) {
  bool waits = p->waits && p->how != PLEUEL_INTERRUPTED;
  pl_keep_bool(k, &waits);
  if (p->waits) pl_keep_bytes(k, p->before.at, p->before.next);
  else pl_run_save(p->lead, k);
}

static pleuel_status load(pl_sensitivity* p, pl_keeper* k) {
  bool waits = false;
  pl_keep_bool(k, &waits);
  pl_sink hears = p->lead->options.sink;
  PL_TRY(pl_run_load(p->lead, k, &hears));
  pl_output_mode(p->lead, p->mode);
  if (waits) go_ahead(p);
  return p->how == PLEUEL_INTERRUPTED ? p->how : PLEUEL_OK;
}

static const pl_lead lead_slots = {.mode = mode_of,
                                   .waits = waits,
                                   .begin = begin,
                                   .step = step,
                                   .save = save,
                                   .load = load,
                                   .close = close};

void pl_sensitivity_attach(pl_sensitivity* p, pl_run* follower, pl_run* plain) {
  p->lead = plain;
  p->follower = follower;
  follower->lead = &lead_slots;
  follower->sensitivity = p;
  take_mode(p);
}
