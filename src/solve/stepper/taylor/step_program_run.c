// A step with the step program: projection, order 0, series.
//
// The step program serve while their pivots are sound. A pivot of what has no mass is compared with
// the largest sum that was ever subtracted there, which shows both a row that becomes dependent and
// one that fades away; where one has faded to a part of the best that was met, the point goes
// through the patterns, which choose rows and pivots anew and find singular positions.
#include <math.h>
#include <string.h>

#include "solve/stepper/taylor/step_program_impl.h"

// square of the part of its best at which a pivot is no longer trusted
static const double sound = 0.02;
// of what was subtracted there: below, whatever the best was, it may be rounding
static const double least_sound = 1e-7;
static const double rounding = 2.3e-16;

static void run_part(pl_step_program* o, pl_step_part part, int from, int to) {
  if (o->compiled[part]) o->compiled[part](o->m, from, to);
  else pl_prog_interpret(o->code[part], o->m, from, to);
}

// ---------------------------------------------------------------------------------------- choosing
static bool same_mode(const pl_run* run, const pl_step_program* o) {
  return memcmp(o->taken, run->dae.taken, (size_t)run->n_c * sizeof(bool)) == 0;
}

pl_step_program* pl_step_program_for_mode(pl_run* run) {
  for (pl_step_program* o = run->taylor->programs; o; o = o->next)
    if (same_mode(run, o)) return o;
  pl_step_program* o = pl_step_program_make(run);
  o->next = run->taylor->programs;
  return run->taylor->programs = o;
}

// --------------------------------------------------------------------------------------- compiling
static void compile(pl_run* run, pl_step_program* o) {
  const pl_prog* progs[PL_N_PARTS];
  pl_prog_run* found[PL_N_PARTS];
  int part[PL_N_PARTS], n = 0;
  pl_jit_story story;
  o->tried = true;
  for (int i = 0; i < PL_N_PARTS; i++)
    if (o->code[i]) {
      progs[n] = o->code[i];
      part[n++] = i;
    }
  o->jit = pl_jit_compile(run->job->arena, progs, n, found, &story, run->options.places);
  run->stats.compile_s += story.seconds;
  if (o->jit == NULL) {
    pl_jit_available(&run->stats.why_interpreted, run->options.places);
    return;
  }
  for (int i = 0; i < n; i++) o->compiled[part[i]] = found[i];
  run->stats.compiled = true;
  run->stats.stored |= story.stored;
}

// Seconds that compiling may take: the compiler is opened, then so much for each line.
static double price(const pl_step_program* o) {
  double lines = 0;
  for (int i = 0; i < PL_N_PARTS; i++) {
    const pl_prog* c = o->code[i];
    if (c) lines += c->orders > 0 ? (double)c->lines.n * (c->orders - c->first_order) : c->lines.n;
  }
  return 0.03 + 60e-6 * lines;
}

// After 8, 16, 32 ... steps the time that is left is estimated from the time so far. Only when,
// never what, depends on it.
static bool compiling_pays(pl_run* run, const pl_step_program* o) {
  long steps = run->stats.steps;
  if (run->taylor->considered == 0) {
    run->taylor->clock_begin = pl_clock();
    run->taylor->t_begin = run->dae.t;
    run->taylor->considered = steps + 8;
  }
  if (steps < run->taylor->considered) return false;
  run->taylor->considered = 2 * steps;
  double way = run->dae.t - run->taylor->t_begin, left = run->options.t_end - run->dae.t;
  return (pl_clock() - run->taylor->clock_begin) * (left / way) > 2 * price(o);
}

void pl_step_program_update(pl_run* run) {
  if (run->options.general || run->event->n_switches > 0
      || (run->options.precision != PL_PRECISION_DOUBLE && run->taylor->program == NULL))
    return;
  if (!run->dae.at_point && !(run->taylor->program && same_mode(run, run->taylor->program)))
    run->taylor->program = pl_step_program_for_mode(run);
  pl_step_program* o = run->taylor->program;
  if (o == NULL || !o->usable || o->tried || run->options.engine == PL_ENGINE_INTERPRETER) return;
  if (run->options.engine == PL_ENGINE_COMPILED || compiling_pays(run, o)) compile(run, o);
}

bool pl_step_program_is_compiled(const pl_run* run) {
  return run->taylor->program && run->taylor->program->jit;
}

void pl_step_program_free(pl_run* run) {
  for (pl_step_program* o = run->taylor->programs; o; o = o->next) pl_jit_free(o->jit);
}

// ------------------------------------------------------------------------------------------ pivots
static bool pivots_are_sound(pl_step_program* o) {
  double least = (double)INFINITY;
  for (int u = o->n_mass; u < o->n; u++) {
    double size = o->m[o->pivot_size + u], part;
    if (size > o->size_most[u]) o->size_most[u] = size;
    part = fabs(o->m[o->pivot + u]) / o->size_most[u];
    least = part >= least ? least : part;
  }
  if (o->n == o->n_mass) return true;
  if (!(least > least_sound)) return false;
  if (least > o->fade_best) o->fade_best = least;
  return least > sound * o->fade_best;
}

// -------------------------------------------------------------------------------------- projection
static void note_largest(double x, double* most) {
  if (!(x <= *most)) *most = x;
}

static void set_floors(const pl_run* run, pl_step_program* o) {
  for (int i = 0; i < o->n_q; i++) {
    o->m[o->q_floor + i] = pl_larger(run->dae.q_most[i], 1e-6 * run->dae.q_size);
    o->m[o->v_floor + i] = pl_larger(run->dae.v_most[i], 1e-6 * run->dae.v_size);
  }
}

// Adds the correction to x; its size relative to that of x.
static double correct(pl_step_program* o, pl_step_part part, double* x, double size) {
  run_part(o, part, 0, 1);
  const double* move = o->m + o->move;
  double most = pl_norm(move, o->n_q);
  for (int i = 0; i < o->n_q; i++) x[i] += move[i];
  return size > 0 ? most / size : most;
}

static bool project_positions(pl_run* run, pl_step_program* o, pl_projection* p) {
  enum { MAX_NEWTON = 8 };
  double before = (double)INFINITY;
  for (int round = 0; round < MAX_NEWTON; round++) {
    run_part(o, PL_PART_POSITION, 0, 1);
    double g = pl_residual(&run->dae, o->m + o->g, o->m + o->g_size, true);
    if (round == 0) p->g_before = g;
    p->g_after = g;
    if (!isfinite(g) || !pivots_are_sound(o)) return false;
    if (g == 0 || (round > 0 && (g <= 2 * rounding || g >= 0.5 * before))) return true;
    before = g;
    double move = correct(o, PL_PART_CORRECT_Q, o->m + o->Q, run->dae.q_size);
    if (!isfinite(move)) return false;
    note_largest(move, &p->move_q);
  }
  return false;
}

static bool project_velocities(pl_run* run, pl_step_program* o, pl_projection* p) {
  for (int round = 0;; round++) {
    run_part(o, PL_PART_VELOCITY, 0, 1);
    double r = pl_residual(&run->dae, o->m + o->r, o->m + o->r_size, false);
    if (round == 0) p->r_before = r;
    p->r_after = r;
    if (!isfinite(r)) return false;
    if (round > 0 || r == 0) return true;
    double move = correct(o, PL_PART_CORRECT_V, o->m + o->V, run->dae.v_size);
    if (!isfinite(move)) return false;
    note_largest(move, &p->move_v);
  }
}

bool pl_step_program_project(pl_run* run, double t, double* q, double* v, pl_projection* p) {
  pl_step_program* o = run->taylor->program;
  run->dae.at_point = false;
  if (o) o->arrived = false;
  if (o == NULL || !o->usable || run->dae.watch_landings || !same_mode(run, o)) return false;
  *p = (pl_projection){0};
  pl_sizes_note(&run->dae, q, v);
  set_floors(run, o);
  o->m[o->time] = t;
  memcpy(o->m + o->Q, q, (size_t)o->n_q * sizeof *q);
  memcpy(o->m + o->V, v, (size_t)o->n_q * sizeof *v);
  p->ok = project_positions(run, o, p) && project_velocities(run, o, p);
  if (!p->ok) return false;
  memcpy(q, o->m + o->Q, (size_t)o->n_q * sizeof *q);
  memcpy(v, o->m + o->V, (size_t)o->n_q * sizeof *v);
  run->dae.at_point = true;
  run->dae.factored = false;
  return true;
}

// ------------------------------------------------------------------------------------------ series
static void copy_rows(double* to, const double* from, int n, int first, int last) {
  memcpy(to + (size_t)first * (size_t)n, from + (size_t)first * (size_t)n,
         (size_t)(last - first + 1) * (size_t)n * sizeof *to);
}

static void copy_orders(pl_run* run, int first, int last) {
  const pl_step_program* o = run->taylor->program;
  copy_rows(run->dae.Q, o->m + o->Q, o->n_q, first, last + 1);
  copy_rows(run->dae.V, o->m + o->V, o->n_q, first, last + 1);
  copy_rows(run->dae.A, o->m + o->A, o->n_q, first, last);
  copy_rows(run->dae.L, o->m + o->L, o->n_c, first, last);
}

static void compute_start(pl_step_program* o) {
  if (o->code[PL_PART_INVERSE]) run_part(o, PL_PART_INVERSE, 0, 1);
  run_part(o, PL_PART_START, 0, 1);
}

void pl_step_program_arrive(pl_run* run, double* off, double* size) {
  pl_step_program* o = run->taylor->program;
  compute_start(o);
  o->arrived = true;
  *off = o->m[o->off];
  *size = o->m[o->off + 1];
}

bool pl_step_program_enter(pl_run* run) {
  pl_step_program* o = run->taylor->program;
  if (!o->arrived) compute_start(o);
  o->arrived = false;
  copy_orders(run, 0, 0);
  double force = pl_norm(o->m + o->h, o->n_q);
  if (force > run->dae.force_size) run->dae.force_size = force;
  run->dae.smallest = run->dae.best;  // sound: as good as it has been
  run->dae.ready = isfinite(pl_norm(run->dae.A, o->n_q)) && isfinite(pl_norm(run->dae.L, o->n_c));
  return run->dae.ready;
}

bool pl_step_program_enter_at(pl_run* run, double t, const double* q, const double* v) {
  pl_step_program* o = run->taylor->program;
  o->m[o->time] = t;
  memcpy(o->m + o->Q, q, (size_t)o->n_q * sizeof *q);
  memcpy(o->m + o->V, v, (size_t)o->n_q * sizeof *v);
  o->arrived = false;
  run_part(o, PL_PART_POSITION, 0, 1);
  double smallest = run->dae.smallest;
  bool ready = pl_step_program_enter(run);
  run->dae.smallest = smallest;
  return ready;
}

void pl_step_program_norms(pl_run* run, const double** q, const double** v) {
  pl_step_program* o = run->taylor->program;
  run_part(o, PL_PART_NORMS, 0, 1);
  *q = o->m + o->norms;
  *v = *q + PL_BLOCK_ROWS;
}

void pl_step_program_advance(pl_run* run, double dt, double* q, double* v) {
  pl_step_program* o = run->taylor->program;
  o->m[o->length] = dt;
  run_part(o, PL_PART_ADVANCE, 0, 1);
  memcpy(q, o->m + o->end_q, (size_t)o->n_q * sizeof *q);
  memcpy(v, o->m + o->end_v, (size_t)o->n_q * sizeof *v);
}

void pl_step_program_end_a(const pl_run* run, double* a) {
  const pl_step_program* o = run->taylor->program;
  memcpy(a, o->m + o->end_a, (size_t)o->n_q * sizeof *a);
}

bool pl_step_program_energy(pl_run* run, double* kinetic, double* potential, double* all) {
  pl_step_program* o = run->taylor->program;
  if (!run->dae.at_point || o->code[PL_PART_ENERGY] == NULL) return false;
  run_part(o, PL_PART_ENERGY, 0, 1);
  *kinetic = o->m[o->energy];
  *potential = o->m[o->energy + 1];
  *all = run->setup->energy > 0 ? o->m[o->energy + 2] : *kinetic + *potential;
  return true;
}

void pl_step_program_expand(pl_run* run) {
  pl_step_program* o = run->taylor->program;
  run_part(o, PL_PART_ORDER, 1, run->order);
  // q gets one more coefficient without a solve
  for (int i = 0; i < o->n_q; i++)
    o->m[o->Q + (run->order + 1) * o->n_q + i] = o->m[o->V + run->order * o->n_q + i]
                                                 / (run->order + 1);
  copy_orders(run, 1, run->order - 1);
}
