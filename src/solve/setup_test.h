// Setups built by hand for the tests: coordinates by name, one pattern with one instance unless
// said otherwise.
#ifndef PL_SETUP_TEST_H
#define PL_SETUP_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "solve/solve.h"

enum { T_MAX = 1024 };

typedef struct t_bench {
  pl_arena* arena;
  pl_pool* pool;
  pl_job job;
  pl_diagnostics diagnostics;
  int n_q, n_c, n_out, n_watch, n_branch, n_events;
  pl_expr q[T_MAX], v[T_MAX], lambda[T_MAX], g[T_MAX], out[16], watch[16], branch[8], force[T_MAX];
  bool velocity[T_MAX];
  pl_coordinate coordinate[T_MAX];
  pl_constraint_setup constraint[T_MAX];
  pl_column column[16];
  pl_event_setup event[8];
  pl_event_action action[8][4];
  pl_branch_setup branch_setup[8];
  double value[4096];
  int identity[T_MAX];
  pl_pattern pattern[4], observer, watcher, branches;
  pl_setup setup;
  pl_run_options options;
  // what the sink saw
  long rows, events;
  double last[64], event_t[64];
  pl_event_kind event_kind[64];
  int event_index[64];
  pl_run* run;
} t_bench;

static inline t_bench* t_open(void) {
  pl_arena* a = pl_arena_make(NULL);
  t_bench* b = PL_NEW(a, t_bench);
  b->arena = a;
  b->pool = pl_pool_make(a);
  b->diagnostics.arena = a;
  b->job = (pl_job){.arena = a, .diagnostics = &b->diagnostics};
  for (int i = 0; i < T_MAX; i++) b->identity[i] = i;
  for (int i = 0; i < 4096; i++) b->value[i] = (double)NAN;
  b->setup.kinetic = b->setup.potential = -1;
  return b;
}

static inline void t_close(t_bench* b) {
  pl_run_free(b->run);
  pl_arena_free(b->arena);
}

static inline pl_symbol t_symbol(t_bench* b, const char* name, pl_role role) {
  return pl_symbol_make(b->pool, &(pl_symbol_info){.name = name,
                                                   .ascii = name,
                                                   .role = role,
                                                   .class = PL_C_OTHER,
                                                   .dimension = pl_dimension_one()});
}

static inline pl_expr t_param(t_bench* b, const char* name, double value) {
  pl_symbol s = t_symbol(b, name, PL_R_PARAM);
  b->value[s.id] = value;
  return pl_sym(b->pool, s);
}

static inline pl_expr t_coord(t_bench* b, const char* name) {
  int i = b->n_q++;
  b->q[i] = pl_sym(b->pool, t_symbol(b, name, PL_R_COORD));
  b->v[i] = pl_dt(b->pool, b->q[i]);
  b->coordinate[i] = (pl_coordinate){.name = pl_copy(b->arena, name),
                                     .v_name = pl_format(b->arena, "%s_dot", name)};
  return b->q[i];
}

static inline int t_constraint(t_bench* b, const char* name, pl_expr g) {
  int c = b->n_c++;
  b->g[c] = g;
  b->lambda[c] = pl_sym(b->pool,
                        t_symbol(b, pl_format(b->arena, "lambda_%s", name), PL_R_MULTIPLIER));
  b->constraint[c] = (pl_constraint_setup){.name = pl_copy(b->arena, name),
                                           .column = pl_format(b->arena, "lambda_%s", name),
                                           .contact = -1};
  return c;
}

static inline int t_output(t_bench* b, const char* name, pl_expr e) {
  b->out[b->n_out] = e;
  b->column[b->n_out] = (pl_column){name, ""};
  return b->n_out++;
}

static inline void t_start(t_bench* b, int i, double q, double v) {
  b->coordinate[i].has_q = b->coordinate[i].has_v = true;
  b->coordinate[i].q = q;
  b->coordinate[i].v = v;
}

static inline int t_event(t_bench* b, const char* name, pl_expr e, int direction,
                          pl_event_action_kind action, int target) {
  int i = b->n_events++;
  b->watch[b->n_watch] = e;
  b->action[i][0] = (pl_event_action){action, target, 0};
  b->event[i] = (pl_event_setup){.name = name,
                                 .watch = b->n_watch++,
                                 .direction = direction,
                                 .n_actions = 1,
                                 .actions = b->action[i]};
  return i;
}

static inline pleuel_status t_on_row(void* user, const pl_row* row) {
  t_bench* b = user;
  b->rows++;
  for (int i = 0; i < b->n_q && i < 16; i++) {
    b->last[i] = row->q[i];
    b->last[16 + i] = row->v[i];
  }
  b->last[63] = row->t;
  return PLEUEL_OK;
}

static inline pleuel_status t_on_event(void* user, const pl_event_record* e) {
  t_bench* b = user;
  if (b->events < 64) {
    b->event_t[b->events] = e->after.t;
    b->event_kind[b->events] = e->kind;
    b->event_index[b->events] = e->index;
  }
  b->events++;
  return PLEUEL_OK;
}

static inline void t_record_list(t_bench* b, const pl_expr* e, int n, pl_pattern* out) {
  pl_pattern_source s = {.slots = {.n_q = b->n_q,
                                   .q = b->q,
                                   .n_c = b->n_c,
                                   .lambda = b->lambda,
                                   .value_of_symbol = b->value},
                         .n_outputs = n,
                         .output = e,
                         .n = 1,
                         .q = b->identity,
                         .c = b->identity,
                         .out = b->identity};
  assert_int_equal(pl_pattern_record(&b->job, b->pool, &s, out), PLEUEL_OK);
}

// Records everything and makes the run.
static inline pleuel_status t_make(t_bench* b, pl_expr L, double t_end, double tol) {
  pl_pattern_source s = {.slots = {.n_q = b->n_q,
                                   .q = b->q,
                                   .n_c = b->n_c,
                                   .lambda = b->lambda,
                                   .value_of_symbol = b->value},
                         .lagrangian = L,
                         .force = b->force,
                         .constraint = b->g,
                         .velocity = b->velocity,
                         .n = 1,
                         .q = b->identity,
                         .c = b->identity};
  pleuel_status status = pl_pattern_record(&b->job, b->pool, &s, &b->pattern[0]);
  if (status != PLEUEL_OK) return status;
  t_record_list(b, b->out, b->n_out, &b->observer);
  t_record_list(b, b->watch, b->n_watch, &b->watcher);
  t_record_list(b, b->branch, b->n_branch, &b->branches);
  int kinetic = b->setup.kinetic, potential = b->setup.potential;
  bool conserved = b->setup.energy_conserved;
  b->setup = (pl_setup){.n_q = b->n_q,
                        .coordinates = b->coordinate,
                        .n_c = b->n_c,
                        .constraints = b->constraint,
                        .n_patterns = 1,
                        .patterns = b->pattern,
                        .n_out = b->n_out,
                        .out = b->column,
                        .n_observers = 1,
                        .observers = &b->observer,
                        .kinetic = kinetic,
                        .potential = potential,
                        .energy_conserved = conserved,
                        .n_events = b->n_events,
                        .events = b->event,
                        .n_watched = b->n_watch,
                        .n_watch_patterns = 1,
                        .watch = &b->watcher,
                        .n_branches = b->n_branch,
                        .branches = b->branch_setup,
                        .n_branch_outputs = b->n_branch,
                        .n_branch_patterns = 1,
                        .branch_patterns = &b->branches};
  b->options.t_end = t_end;
  b->options.tol = tol;
  b->options.sink = (pl_sink){.user = b, .row = t_on_row, .event = t_on_event};
  return pl_run_make(&b->job, &b->setup, &b->options, &b->run);
}

// Energy columns from T and V, said to be conserved; returns T - V.
static inline pl_expr t_energy(t_bench* b, pl_expr T, pl_expr V) {
  b->setup.kinetic = t_output(b, "T", T);
  b->setup.potential = t_output(b, "V", V);
  b->setup.energy_conserved = true;
  return pl_sub(b->pool, T, V);
}

#endif
