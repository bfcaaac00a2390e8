// A run that is kept between two steps and goes on in a fresh one takes the same steps, bit for
// bit: for each model that is given, kept at several steps, with each method that takes it; and
// whatever a kept state holds, reading it is safe.
//
// Usage: resume_test 'MODELS'...     patterns of file names.  RESUME_SEED=n starts other dice,
// RESUME_MORE=n looks n times as often
#define _GNU_SOURCE  // memmem

#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/api_impl.h"

static int n_checks, n_failed;

static void check(bool fine, const char* what, const char* model, const char* how, long step,
                  const char* why) {
  n_checks++;
  if (!fine) n_failed++;
  if (!fine) printf("# %s: %s (%s), kept at step %ld: %s\n", model, what, how, step, why);
}

// -------------------------------------------------------------------------------------------- runs
typedef struct bench {
  pleuel* ctx;
  pleuel_model* m;
  pl_run* run;
  pleuel_status status;
} bench;

typedef struct manner {
  const char *name, *method, *engine, *sensitivities;
  double dt, tol;
  const char* precision;
} manner;

static void close_bench(bench* b) {
  pl_run_free(b->run);
  pleuel_model_free(b->m);
  pleuel_close(b->ctx);
}

// A started run without a sink; false: this model cannot be run this way.
static bool open_bench(bench* b, const char* file, const manner* how) {
  *b = (bench){.ctx = pleuel_open(NULL)};
  PLEUEL_OPTIONS(pleuel_sim_options, o);
  static const char* const methods[] = {"auto", "taylor", "radau"};
  static const char* const engines[] = {"auto", "interpreter", "compiled"};
  static const char* const precisions[] = {"double", "long", "quad"};
  for (int i = 0; i < 3; i++) {
    if (how->method && strcmp(how->method, methods[i]) == 0) o.method = (pleuel_method)i;
    if (how->engine && strcmp(how->engine, engines[i]) == 0) o.engine = (pleuel_engine)i;
    if (how->precision && strcmp(how->precision, precisions[i]) == 0)
      o.precision = (pleuel_precision)i;
  }
  o.sensitivities = how->sensitivities;
  if (how->dt > 0) {
    o.dt = how->dt;
    o.has_dt = 1;
  }
  if (how->tol > 0) {
    o.tol = how->tol;
    o.has_tol = 1;
  }
  b->status = pleuel_load_file(b->ctx, &b->m, file, NULL);
  if (b->status == PLEUEL_OK) b->status = pl_pipeline_record(b->m);
  if (b->status == PLEUEL_OK && isnan(b->m->recording->t_end)) {
    o.until = 2;
    o.has_until = 1;
  }
  if (b->status == PLEUEL_OK) b->status = pl_pipeline_start(b->m, &o, &b->run);
  return b->status == PLEUEL_OK;
}

static pl_keeper kept(bench* b) {
  pl_keeper k = pl_keeper_to_write(b->m->arena);
  pl_run_save(b->run, &k);
  return k;
}

static bool load_into(bench* b, const pl_keeper* state) {
  static const pl_sink none;
  pl_keeper in = pl_keeper_to_read(b->m->arena, state->at, state->next);
  b->status = pl_run_load(b->run, &in, &none);
  return b->status == PLEUEL_OK && pl_keep_is_whole(&in);
}

// --------------------------------------------------------------------------------- the same motion
static bool same_bits(const double* a, const double* b, int n) {
  return memcmp(a, b, (size_t)n * sizeof *a) == 0;
}

static const char* difference(const bench* a, const bench* b) {
  const pl_setup* s = &a->m->recording->setup;
  const pl_run *x = a->run, *y = b->run;
  double t = pl_run_time(x), u = pl_run_time(y);
  if (!same_bits(&t, &u, 1)) return "time";
  if (!same_bits(pl_run_q(x), pl_run_q(y), s->n_q) || !same_bits(pl_run_v(x), pl_run_v(y), s->n_q))
    return "position or velocity";
  if (!same_bits(pl_run_a(x), pl_run_a(y), s->n_q)) return "acceleration";
  if (!same_bits(pl_run_lambda(x), pl_run_lambda(y), s->n_c)) return "multiplier";
  if (memcmp(pl_run_unique(x), pl_run_unique(y), (size_t)s->n_c * sizeof(bool)) != 0)
    return "uniqueness";
  const pl_stats *p = pl_run_stats(x), *r = pl_run_stats(y);
  if (p->steps != r->steps || p->rejections != r->rejections || p->n_events != r->n_events)
    return "steps or events";
  const double mine[] = {p->max_g,        p->max_gdot, p->max_projection, p->energy_0,
                         p->energy_drift, p->h_min,    p->h_max};
  const double other[] = {r->max_g,        r->max_gdot, r->max_projection, r->energy_0,
                          r->energy_drift, r->h_min,    r->h_max};
  return same_bits(mine, other, 7) ? NULL : "accuracy";
}

// What was kept behind the memory of compiled steps, where other modes may have left other remains.
static bool same_state(const pl_keeper* a, const pl_keeper* b) {
  static const char mark[16] = "pivots";
  const unsigned char *x = memmem(a->at, a->next, mark, sizeof mark),
                      *y = memmem(b->at, b->next, mark, sizeof mark);
  if (x == NULL || y == NULL) return false;
  static const char end[16] = "lead";  // whose codes come behind
  const unsigned char* u = memmem(x, (size_t)(a->at + a->next - x), end, sizeof end);
  const unsigned char* w = memmem(y, (size_t)(b->at + b->next - y), end, sizeof end);
  return u && w && u - x == w - y && memcmp(x, y, (size_t)(u - x)) == 0;
}

// Steps that are looked at: fewer where they are long, so that large models do not take all the
// time.
static long steps_for(const bench* b, long most) {
  static const long work = 12000;
  const pl_setup* s = &b->m->recording->setup;
  long n = work / (s->n_q + s->n_c);
  return n > most ? most : n < 10 ? 10 : n;
}

enum { TAKEN = 500, FOLLOWED = 200 };

// b goes on from where a was kept; a is taken along the same way, from `state` on.
static void follow(bench* a, bench* b, const char* file, const char* how, long step, bool whole) {
  const char* off = NULL;
  for (long i = 0; i < steps_for(a, FOLLOWED) && off == NULL; i++) {
    a->status = pl_run_step(a->run);
    b->status = pl_run_step(b->run);
    off = a->status != b->status ? "status" : difference(a, b);
    if (off || a->status != PLEUEL_OK || pl_run_done(a->run)) break;
    if (whole && i % 8 == 0) {
      pl_keeper x = kept(a), y = kept(b);
      if (!same_state(&x, &y)) off = "state";
    }
  }
  check(off == NULL, "goes on as it would have", file, how, step, off ? off : "");
}

// ----------------------------------------------------------------------------------------- a model
// Steps taken before the end, up to a limit; -1: it cannot be run this way.
static long count_steps(const char* file, const manner* how) {
  bench b;
  long n = -1;
  if (open_bench(&b, file, how)) {
    for (n = 0; n < steps_for(&b, TAKEN) && !pl_run_done(b.run); n++)
      if (pl_run_step(b.run) != PLEUEL_OK) break;
  }
  close_bench(&b);
  return n;
}

static void try_at(const char* file, const manner* how, const char* other_engine, long step) {
  bench a, b;
  manner other = *how;
  if (other_engine) other.engine = other_engine;
  if (!open_bench(&a, file, how)) {
    close_bench(&a);
    return;
  }
  for (long i = 0; i < step; i++) pl_run_step(a.run);
  pl_run_step(a.run);
  if (!pl_run_done(a.run)) {
    pl_keeper state = kept(&a);
    bool opened = open_bench(&b, file, &other);
    bool loaded = opened && load_into(&b, &state);
    check(loaded, "is read back", file, how->name, step, loaded ? "" : b.m->job.message);
    if (loaded) follow(&a, &b, file, how->name, step, other_engine == NULL);
    close_bench(&b);
  }
  close_bench(&a);
}

static void try_model(const char* file, const manner* how, pl_random* dice, int times) {
  long n = count_steps(file, how);
  if (n < 1) return;
  for (int i = 0; i < times; i++) {
    long step = (long)(pl_random_bits(dice) % (uint64_t)n);
    try_at(file, how, i % 4 == 3 ? "compiled" : NULL, step);
  }
}

// ------------------------------------------------------------------------- bytes that are no state
// Bytes turned at random, and cut: reading ends with a status, and what was read can be stepped or
// says why not.
static void try_damage(const char* file, pl_random* dice) {
  static const manner how = {.name = "damaged", .engine = "interpreter"};
  bench a, b;
  if (!open_bench(&a, file, &how)) {
    close_bench(&a);
    return;
  }
  for (int i = 0; i < 20 && !pl_run_done(a.run); i++) pl_run_step(a.run);
  pl_keeper state = kept(&a);
  for (int round = 0; round < 12; round++) {
    if (!open_bench(&b, file, &how)) break;
    pl_keeper bad = state;
    bad.at = pl_alloc(a.m->arena, state.next);
    memcpy(bad.at, state.at, state.next);
    if (round % 4 == 0) bad.next = (size_t)(pl_random_bits(dice) % state.next);
    else
      for (int i = 0; i < round; i++)
        bad.at[pl_random_bits(dice) % bad.next] ^= (unsigned char)(1 + pl_random_bits(dice) % 255);
    bool loaded = load_into(&b, &bad);
    check(round % 4 != 0 || !loaded, "a state that is cut off is not taken", file, how.name, 20,
          "");
    for (int i = 0; i < 5 && loaded && !pl_run_done(b.run); i++)
      if (pl_run_step(b.run) != PLEUEL_OK) break;
    close_bench(&b);
  }
  close_bench(&a);
}

int main(int argc, char** argv) {
  static const manner manners[] = {
      {.name = "interpreted", .engine = "interpreter"},
      {.name = "radau", .method = "radau", .engine = "interpreter", .tol = 1e-6},
      {.name = "grid", .method = "taylor", .engine = "interpreter", .dt = 0.0137, .tol = 1e-9},
      {.name = "derivatives", .engine = "interpreter", .sensitivities = "g"},
      {.name = "long", .engine = "interpreter", .precision = "long", .dt = 0.0137},
      {.name = "quad", .precision = "quad"},
  };
  const char *seed = getenv("RESUME_SEED"), *more = getenv("RESUME_MORE");
  pl_random dice = {seed ? strtoull(seed, NULL, 10) : 4};
  int times = more ? atoi(more) : 1;
  glob_t found = {0};
  for (int i = 1; i < argc; i++) glob(argv[i], i > 1 ? GLOB_APPEND : 0, NULL, &found);
  for (size_t f = 0; f < found.gl_pathc; f++) {
    const char *file = found.gl_pathv[f], *name = strrchr(file, '/');
    int before = n_failed;
    for (size_t i = 0; i < sizeof manners / sizeof *manners; i++) {
      if (times == 1 && i > 0 && f % 6 != i) continue;
      try_model(file, &manners[i], &dice, i == 0 ? times + 1 : times);
    }
    if (f % 8 == 0 || times > 1) try_damage(file, &dice);
    printf("%sok %zu - %s goes on where it was interrupted\n", n_failed > before ? "not " : "",
           f + 1, name ? name + 1 : file);
    fflush(stdout);
  }
  printf("1..%zu\n# %d checks, dice %s\n", found.gl_pathc, n_checks, seed ? seed : "4");
  globfree(&found);
  return n_failed > 0 || n_checks == 0;
}
