// Consistent start: given values are held, the rest follows from the constraints.
//
// Positions: Gauss-Newton from the guesses, then, where the given values determine the rest, from a
// fixed set of random guesses of several sizes, so that other solutions are found; those that fit
// the branch conditions are kept. One fits: it is the start. Several: the one nearest to the given
// numbers is, unless two are equally near; all are listed. None: a given value is looked for that,
// left free, would let the constraints be met. Velocities: linear, of least kinetic energy where
// they are free.
//
// A one-sided constraint whose side the other values determine is in contact when it is met and
// free otherwise; one that they do not determine closes the start: the body sits on it.
#include "solve/start/start_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { GUESSES = 72, GUESSES_LARGE = 6 };  // guesses tried; for systems that are solved sparse

static const double met = 1e-9;
static const double pi = 3.14159265358979323846;

// ------------------------------------------------------------------------------------------ set-up
static pl_start make(pl_run* run) {
  pl_arena* a = run->job->arena;
  size_t q = (size_t)run->n_q, c = (size_t)run->n_c;
  pl_start s = {.run = run, .below = -1};
  s.q = PL_ARRAY(a, double, q + 1);
  s.v = PL_ARRAY(a, double, q + 1);
  s.try_q = PL_ARRAY(a, double, q + 1);
  s.held_q = PL_ARRAY(a, bool, q + 1);
  s.held_v = PL_ARRAY(a, bool, q + 1);
  s.solutions = PL_ARRAY(a, double, q* PL_START_ROOM + 1);
  s.solution_on = PL_ARRAY(a, bool, c* PL_START_ROOM + 1);
  s.sits = PL_ARRAY(a, bool, c + 1);
  s.before_on = PL_ARRAY(a, bool, c + 1);
  for (int i = 0; i < run->n_q; i++) {
    s.held_q[i] = run->setup->coordinates[i].has_q;
    s.held_v[i] = run->setup->coordinates[i].has_v;
  }
  return s;
}

static double plain_guess(const pl_coordinate* c) {
  return c->has_q ? c->q : c->has_guess ? c->guess : 0;
}

static double size_of_given(const pl_run* run) {
  double most = 0;
  for (int i = 0; i < run->n_q; i++)
    most = fmax(most, fabs(plain_guess(&run->setup->coordinates[i])));
  return most > 0 ? most : 1;
}

// Guess number 0 is what the caller said, with 0 where nothing was said. The others are random, of
// sizes from a hundredth to a hundred times the given values; what was said as a guess is only
// shaken.
static void set_guess(pl_start* s, int number) {
  static const double scale[] = {1, 0.3, 3, 0.1, 10, 0.01, 100, 1};
  const pl_run* run = s->run;
  double size = size_of_given(run) * scale[number % 8];
  pl_random r = {0x9e3779b97f4a7c15ull * (uint64_t)(number + 1)};
  for (int i = 0; i < run->n_q; i++) {
    const pl_coordinate* c = &run->setup->coordinates[i];
    double x = pl_random_between(&r, -1, 1);
    s->q[i] = plain_guess(c);
    if (number == 0 || c->has_q) continue;
    s->q[i] += c->has_guess ? 0.1 * x * fmax(fabs(c->guess), 0.1 * size) : x * size;
  }
}

// ---------------------------------------------------------------------------------------- contacts
static void only_two_sided(pl_start* s) {
  pl_run* run = s->run;
  for (int c = 0; c < run->n_c; c++) {
    run->dae.on[c] = !run->dae.detached[c] && run->setup->constraints[c].side == 0;
    s->sits[c] = false;
  }
  pl_active_set_update(&run->dae);
}

// Whether what is not held can still move the one-sided constraint c, the others being met.
static bool is_undetermined(pl_start* s, int c) {
  pl_run* run = s->run;
  int before = pl_start_rank(s, s->held_q);
  run->dae.on[c] = true;
  pl_active_set_update(&run->dae);
  int after = pl_start_rank(s, s->held_q);
  run->dae.on[c] = false;
  pl_active_set_update(&run->dae);
  return after > before;
}

static double side_value(pl_start* s, int c) {
  int worst;
  pl_start_residual(s, s->q, &worst);
  double size = s->run->dae.g_size[c] > 0 ? s->run->dae.g_size[c] : 1;
  return s->run->setup->constraints[c].side * s->run->dae.g[c] / size;
}

// Decides one contact at a solution of those decided so far; false: given values lie on the wrong
// side.
static bool decide_contact(pl_start* s, int c) {
  pl_run* run = s->run;
  const pl_constraint_setup* constraint = &run->setup->constraints[c];
  if (constraint->side == 0 || run->dae.detached[c]) return true;
  // one that stands with another contact follows that
  bool sits = is_undetermined(s, c);
  double value = side_value(s, c);
  if (!sits && value < -met) {
    s->below = c;
    return false;
  }
  s->sits[c] = sits;
  run->dae.on[c] = sits || value <= met;
  pl_active_set_update(&run->dae);
  if (!sits || pl_start_positions(s, s->held_q)) return true;
  // it cannot be reached: then it is free, if that is allowed
  run->dae.on[c] = false;
  s->sits[c] = false;
  pl_active_set_update(&run->dae);
  return pl_start_positions(s, s->held_q) && side_value(s, c) >= -met;
}

// Contacts that a map takes for granted: whoever writes the map means them.
static bool close_granted(pl_start* s) {
  pl_run* run = s->run;
  bool any = false;
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* map = &run->setup->constraints[c];
    for (int i = 0; i < map->n_needs; i++) {
      int k = map->needs[i];
      if (run->setup->constraints[k].side == 0 || run->dae.detached[k] || run->dae.on[k]) continue;
      run->dae.on[k] = any = true;
    }
  }
  pl_active_set_update(&run->dae);
  return any;
}

static bool decide_contacts(pl_start* s) {
  for (int c = 0; c < s->run->n_c; c++)
    if (!s->run->dae.on[c] && !decide_contact(s, c)) return false;
  return pl_start_positions(s, s->held_q);
}

// Positions from the guess in s->q, contacts decided.
static bool solve_positions(pl_start* s) {
  only_two_sided(s);
  if (s->on_maps) close_granted(s);
  return pl_start_positions(s, s->held_q) && decide_contacts(s);
}

// ---------------------------------------------------------------------------------------- branches
static bool fits_branches(pl_start* s, const double* q) {
  pl_run* run = s->run;
  const pl_setup* setup = run->setup;
  pl_batches* b = &run->branches;
  pl_batches_time(b, run->options.t_0);
  pl_batches_load_q(b, q, 0);
  pl_batches_load_v(b, s->v, 0);
  for (int level = PL_LEVEL_POSITION; level < PL_N_LEVELS; level++)
    pl_batches_sweep(b, (pl_tape_level)level, 0, true);
  pl_batches_outputs(b, run->branch_value, setup->n_branch_outputs, 0);
  for (int i = 0; i < setup->n_branches; i++) {
    double x = run->branch_value[setup->branches[i].output];
    int relation = setup->branches[i].relation;
    if (relation == 0 ? !(fabs(x) <= met * fmax(run->dae.q_size, 1e-300)) : !(relation * x >= 0))
      return false;
  }
  return true;
}

// ------------------------------------------------------------------------------ distinct solutions
// Equal, or equal up to whole turns of angles: then the constraints look the same from both.
static bool same_but_for_turns(pl_start* s, const double* a, const double* b) {
  pl_run* run = s->run;
  double size = fmax(pl_norm(a, run->n_q), pl_norm(b, run->n_q));
  bool turned = false;
  for (int i = 0; i < run->n_q; i++) {
    double d = a[i] - b[i], turns = nearbyint(d / (2 * pi));
    if (fabs(d) <= 1e-6 * size) continue;
    if (turns == 0 || fabs(d - 2 * pi * turns) > 1e-6 * size) return false;
    turned = true;
  }
  if (!turned) return true;
  // one comparison of all gradients, summed with weights that do not cancel by accident
  double sum[2] = {0, 0};
  for (int which = 0; which < 2; which++) {
    int worst;
    pl_start_residual(s, which == 0 ? a : b, &worst);
    pl_assemble_rows(&run->dae);
    for (int r = 0; r < run->dae.n_active; r++)
      for (int j = 0; j < run->n_q; j++)
        sum[which] += run->dae.rows[(size_t)r * (size_t)run->n_q + (size_t)j]
                      * (1 + 0.37 * sin(1.0 + 7 * r + 3 * j));
  }
  return fabs(sum[0] - sum[1]) <= 1e-5 * (fabs(sum[0]) + fabs(sum[1])) + 1e-9;
}

static bool can_compare_turns(const pl_run* run) { return run->n_c <= PL_RANK_UP_TO; }

// Takes whole turns out of angles that lie more than half a turn from their guess.
static void unwind(pl_start* s) {
  pl_run* run = s->run;
  size_t n = (size_t)run->n_q;
  for (int i = 0; i < run->n_q; i++) {
    double turns = nearbyint((s->q[i] - plain_guess(&run->setup->coordinates[i])) / (2 * pi));
    if (s->held_q[i] || turns == 0) continue;
    memcpy(s->try_q, s->q, n * sizeof(double));
    s->try_q[i] -= 2 * pi * turns;
    int worst;
    bool fits = pl_start_residual(s, s->try_q, &worst) <= met;
    if (fits && same_but_for_turns(s, s->q, s->try_q)) memcpy(s->q, s->try_q, n * sizeof(double));
  }
}

// Keeps the solution in s->q if it is new.
static void keep_solution(pl_start* s) {
  pl_run* run = s->run;
  size_t n = (size_t)run->n_q;
  if (can_compare_turns(run)) unwind(s);
  for (int k = 0; k < s->n_solutions && can_compare_turns(run); k++)
    if (same_but_for_turns(s, s->solutions + (size_t)k * n, s->q)) return;
  if (s->n_solutions == PL_START_ROOM) return;
  memcpy(s->solutions + (size_t)s->n_solutions * n, s->q, n * sizeof(double));
  memcpy(s->solution_on + (size_t)s->n_solutions * (size_t)run->n_c, run->dae.on,
         (size_t)run->n_c * sizeof(bool));
  s->n_solutions++;
}

static int count_free(const pl_start* s) {
  int n = 0;
  for (int i = 0; i < s->run->n_q; i++) n += !s->held_q[i];
  return n;
}

// Coordinates that could move with all constraints met: listed in the report.
static void list_free(pl_start* s, int n_free, int rank) {
  pl_run* run = s->run;
  pl_start_report* report = &run->start;
  int* list = PL_ARRAY(run->job->arena, int, run->n_q + 1);
  report->free = list;
  if (n_free == rank || run->dae.n_active > PL_RANK_UP_TO) return;
  for (int i = 0; i < run->n_q; i++) {
    if (s->held_q[i]) continue;
    // it is determined when holding it costs a rank
    s->held_q[i] = true;
    bool determined = pl_start_rank(s, s->held_q) < rank;
    s->held_q[i] = false;
    if (!determined) list[report->n_free++] = i;
  }
}

static bool a_guess_was_given(const pl_run* run) {
  for (int i = 0; i < run->n_q; i++)
    if (run->setup->coordinates[i].has_guess && !run->setup->coordinates[i].has_q) return true;
  return false;
}

static void search_guesses(pl_start* s) {
  pl_run* run = s->run;
  int n_free = count_free(s), most = n_free == 0 ? 1 : run->dae.kkt.dense ? GUESSES : GUESSES_LARGE;
  for (int number = 0; number < most; number++) {
    set_guess(s, number);
    if (!solve_positions(s) || !fits_branches(s, s->q)) continue;
    keep_solution(s);
    int rank = pl_start_rank(s, s->held_q);
    bool determined = rank == n_free;
    if (s->n_solutions == 1) {
      run->start.n_free = 0;
      list_free(s, n_free, rank);
    }
    // nothing to compare with: the first solution is the start
    if (!determined || (number == 0 && a_guess_was_given(run))) return;
  }
}

// Looks for solutions; how many fit is in s->n_solutions. With the contacts that maps take for
// granted first; where given values lie elsewhere, without.
static void search(pl_start* s) {
  only_two_sided(s);
  s->on_maps = close_granted(s);
  if (s->on_maps) search_guesses(s);
  if (s->n_solutions > 0) return;
  s->on_maps = false;
  search_guesses(s);
}

// --------------------------------------------------------------------------------- what went wrong
// In large systems only coordinates of the violated constraint itself are tried.
static bool worth_trying(const pl_run* run, int coordinate, int constraint) {
  if (run->dae.kkt.dense) return true;
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    for (int e = 0; e < b->pattern->n_G; e++)
      for (int l = 0; l < b->n; l++)
        if (b->c[b->pattern->G[e].row * b->lanes + l] == constraint
            && b->q[b->pattern->G[e].col * b->lanes + l] == coordinate)
          return true;
  }
  return false;
}

// The given value that, left free, lets the constraints be met; the one that moves least.
static void suggest_position(pl_start* s) {
  pl_run* run = s->run;
  pl_start_report* report = &run->start;
  double least = (double)INFINITY;
  for (int i = 0; i < run->n_q; i++) {
    if (!run->setup->coordinates[i].has_q || !worth_trying(run, i, report->constraint)) continue;
    s->held_q[i] = false;
    set_guess(s, 0);
    if (solve_positions(s)) {
      double from = run->setup->coordinates[i].q,
             move = fabs(s->q[i] - from) / fmax(fabs(from), 1e-3 * run->dae.q_size);
      if (move < least) {
        least = move;
        report->move_coordinate = i;
        report->move_to = s->q[i];
      }
    }
    s->held_q[i] = true;
  }
}

static void suggest_velocity(pl_start* s) {
  pl_run* run = s->run;
  pl_start_report* report = &run->start;
  double least = (double)INFINITY;
  for (int i = 0; i < run->n_q; i++) {
    if (!run->setup->coordinates[i].has_v || !worth_trying(run, i, report->constraint)) continue;
    s->held_v[i] = false;
    for (int j = 0; j < run->n_q; j++)
      s->v[j] = run->setup->coordinates[j].has_v ? run->setup->coordinates[j].v : 0;
    if (pl_start_velocities(s, s->held_v)) {
      double from = run->setup->coordinates[i].v,
             move = fabs(s->v[i] - from) / fmax(fabs(from), 1e-3 * run->dae.v_size);
      if (move < least) {
        least = move;
        report->move_coordinate = i;
        report->move_velocity = true;
        report->move_to = s->v[i];
      }
    }
    s->held_v[i] = true;
  }
}

static pleuel_status violated(pl_start* s, int constraint, double residual, bool velocity) {
  pl_run* run = s->run;
  pl_start_report* report = &run->start;
  report->trouble = PL_START_VIOLATED;
  report->constraint = constraint;
  report->residual = residual;
  report->constraint_velocity = velocity;
  report->move_coordinate = -1;
  if (velocity) suggest_velocity(s);
  else suggest_position(s);
  const char* name = run->setup->constraints[constraint].name;
  if (report->move_coordinate < 0)
    return pl_fail(run->job, PLEUEL_CONTRADICTION,
                   velocity ? "start velocities violate %s by %.3g of its terms"
                            : "start values violate %s by %.3g of its terms",
                   name, residual);
  const pl_coordinate* c = &run->setup->coordinates[report->move_coordinate];
  return pl_fail(
      run->job, PLEUEL_CONTRADICTION,
      velocity ? "start velocities violate %s by %.3g of its terms; with %s = %.10g it would be met"
               : "start values violate %s by %.3g of its terms; with %s = %.10g it would be met",
      name, residual, report->move_velocity && c->v_name ? c->v_name : c->name, report->move_to);
}

static pleuel_status no_solution(pl_start* s) {
  pl_run* run = s->run;
  // the plain guess once more: which constraint resists
  set_guess(s, 0);
  s->below = -1;
  bool solved = solve_positions(s);
  int constraint = s->below >= 0 ? s->below : s->worst_constraint;
  if (!solved && constraint >= 0) {
    bool any_given = count_free(s) < run->n_q;
    // in units of the terms as they are written
    double residual = s->below >= 0 ? fabs(side_value(s, constraint)) : s->worst;
    if (any_given)
      return violated(s, constraint, residual * fmax(run->dae.argument[constraint], 1), false);
  }
  run->start.trouble = PL_START_NONE;
  run->start.constraint = constraint;
  if (solved)
    return pl_fail(run->job, PLEUEL_CONTRADICTION,
                   "no solution of the constraints fits the branch conditions");
  if (constraint < 0)
    return pl_fail(run->job, PLEUEL_CONTRADICTION,
                   "no positions were found that meet the constraints");
  return pl_fail(run->job, PLEUEL_CONTRADICTION,
                 "no positions were found that meet the constraints, in particular %s",
                 run->setup->constraints[constraint].name);
}

static pleuel_status several_solutions(pl_start* s) {
  pl_run* run = s->run;
  char text[400];
  size_t n = 0;
  text[0] = '\0';
  run->start.trouble = PL_START_SEVERAL;
  for (int k = 0; k < s->n_solutions && n < sizeof text - 1; k++) {
    for (int i = 0, shown = 0; i < run->n_q && n < sizeof text - 1; i++) {
      if (s->held_q[i]) continue;
      int w = snprintf(text + n, sizeof text - n, "%s%s = %.6g",
                       shown++ ? ", "
                       : k     ? "; or "
                               : "",
                       run->setup->coordinates[i].name,
                       s->solutions[(size_t)k * (size_t)run->n_q + (size_t)i]);
      if (w < 0) break;
      n += (size_t)w;
    }
  }
  return pl_fail(run->job, PLEUEL_CONTRADICTION, "%d solutions fit the start: %s", s->n_solutions,
                 text);
}

// How far a solution is from what was given or guessed, in units of the given values.
static double distance_from_guess(const pl_start* s, const double* q) {
  double sum = 0;
  for (int i = 0; i < s->run->n_q; i++) {
    double d = q[i] - plain_guess(&s->run->setup->coordinates[i]);
    sum += d * d;
  }
  return sqrt(sum) / size_of_given(s->run);
}

// The solution nearest to the given numbers; -1 when another one is as near, as for mirror images.
static int nearest_solution(const pl_start* s) {
  static const double as_near = 1e-6;
  size_t n = (size_t)s->run->n_q;
  int best = 0;
  for (int k = 1; k < s->n_solutions; k++) {
    bool nearer = distance_from_guess(s, s->solutions + (size_t)k * n)
                  < distance_from_guess(s, s->solutions + (size_t)best * n);
    if (nearer) best = k;
  }
  double least = distance_from_guess(s, s->solutions + (size_t)best * n);
  for (int k = 0; k < s->n_solutions; k++) {
    double other = distance_from_guess(s, s->solutions + (size_t)k * n);
    if (k != best && other <= least * (1 + as_near) + as_near) return -1;
  }
  return best;
}

// --------------------------------------------------------------------------- positions, velocities
static pleuel_status find_positions(pl_start* s) {
  pl_run* run = s->run;
  search(s);
  run->start.n_candidates = s->n_solutions;
  run->start.candidates = s->solutions;
  if (s->n_solutions == 0) return no_solution(s);
  int taken = nearest_solution(s);
  if (taken < 0) return several_solutions(s);
  run->start.taken = taken;
  memcpy(s->q, s->solutions + (size_t)taken * (size_t)run->n_q, (size_t)run->n_q * sizeof(double));
  memcpy(run->dae.on, s->solution_on + (size_t)taken * (size_t)run->n_c,
         (size_t)run->n_c * sizeof(bool));
  pl_active_set_update(&run->dae);
  return PLEUEL_OK;
}

static void set_velocities(pl_start* s) {
  for (int i = 0; i < s->run->n_q; i++) {
    const pl_coordinate* c = &s->run->setup->coordinates[i];
    s->v[i] = c->has_v ? c->v : c->has_v_guess ? c->v_guess : 0;
  }
}

// A contact that the given velocities leave is no contact; the landing of it is not found again at
// once.
static bool leaves(pl_start* s, int c) {
  pl_run* run = s->run;
  run->dae.on[c] = false;
  pl_active_set_update(&run->dae);
  set_velocities(s);
  bool solved = pl_start_velocities(s, s->held_v);
  double rate = run->setup->constraints[c].side * run->dae.r[c];
  if (solved && rate > met * run->dae.r_size[c]) {
    s->sits[c] = false;
    return true;
  }
  run->dae.on[c] = true;
  pl_active_set_update(&run->dae);
  return false;
}

// Contacts that the given velocities run into: an impact at the start, which the run computes. All
// that move are taken out.
static bool run_into(pl_start* s) {
  pl_run* run = s->run;
  bool any = false;
  for (int c = 0; c < run->n_c; c++) {
    s->before_on[c] = run->dae.on[c];
    if (run->setup->constraints[c].side != 0 && !run->setup->constraints[c].velocity)
      run->dae.on[c] = false;
  }
  pl_active_set_update(&run->dae);
  set_velocities(s);
  bool solved = pl_start_velocities(s, s->held_v);
  for (int c = 0; c < run->n_c; c++) {
    if (run->dae.on[c] == s->before_on[c]) continue;
    bool moves = solved && fabs(run->dae.r[c]) > met * run->dae.r_size[c];
    run->dae.on[c] = !moves;
    if (moves) s->sits[c] = false;
    any |= moves;
  }
  pl_active_set_update(&run->dae);
  set_velocities(s);
  return any && pl_start_velocities(s, s->held_v);
}

static pleuel_status find_velocities(pl_start* s) {
  pl_run* run = s->run;
  set_velocities(s);
  if (pl_start_velocities(s, s->held_v)) return PLEUEL_OK;
  for (int c = 0; c < run->n_c; c++)
    if (run->setup->constraints[c].side != 0 && run->dae.on[c] && leaves(s, c))
      return find_velocities(s);
  if (run_into(s)) return PLEUEL_OK;
  memcpy(run->dae.on, s->before_on, (size_t)run->n_c * sizeof(bool));
  pl_active_set_update(&run->dae);
  set_velocities(s);
  pl_start_velocities(s, s->held_v);
  if (s->worst_constraint < 0)
    return pl_fail(
        run->job, PLEUEL_SINGULAR,
        "the start velocities cannot be found: the constraints or the masses are singular there");
  return violated(s, s->worst_constraint, s->worst, true);
}

// ---------------------------------------------------------------------------------- singular start
// Compares the rank of the start with that of a neighbour on the constraints, a small way along a
// fixed tangent.
static bool is_singular_start(pl_start* s) {
  pl_run* run = s->run;
  if (run->dae.n_active == 0 || run->dae.n_active > PL_RANK_UP_TO || !run->dae.kkt.dense)
    return false;
  bool* none = PL_ARRAY(run->job->arena, bool, run->n_q + 1);
  double* home = PL_ARRAY(run->job->arena, double, run->n_q + 1);
  memcpy(home, s->q, (size_t)run->n_q * sizeof(double));
  pl_random r = {20};
  int worst;
  pl_start_residual(s, s->q, &worst);
  int rank = pl_start_rank(s, none), higher = 0, found = 0;
  for (int attempt = 0; attempt < 3 && higher == found; attempt++) {
    for (int i = 0; i < run->n_q; i++)
      s->q[i] = home[i] + 1e-3 * fmax(run->dae.q_size, 1e-300) * pl_random_between(&r, -1, 1);
    if (!pl_start_positions(s, none)) continue;
    // gradients at the point that was found, not at the last but one
    pl_start_residual(s, s->q, &worst);
    found++;
    higher += pl_start_rank(s, none) > rank;
  }
  memcpy(s->q, home, (size_t)run->n_q * sizeof(double));
  // at a regular start rounding may let one neighbour look richer, not all
  return found > 0 && higher == found;
}

// ------------------------------------------------------------------------------------------ report
static void list_moves(pl_start* s) {
  pl_run* run = s->run;
  pl_start_report* report = &run->start;
  pl_start_move* moves = PL_ARRAY(run->job->arena, pl_start_move, 2 * (size_t)run->n_q + 1);
  for (int pass = 0; pass < 2; pass++) {
    const double* x = pass == 0 ? run->dae.q : s->v;  // before an impact at the start
    double size = pl_norm(x, run->n_q);
    for (int i = 0; i < run->n_q; i++) {
      const pl_coordinate* c = &run->setup->coordinates[i];
      bool given = pass == 0 ? c->has_q : c->has_v;
      double from = pass == 0 ? plain_guess(c) : c->has_v ? c->v : c->has_v_guess ? c->v_guess : 0;
      // rounding is no move
      if (fabs(x[i] - from) <= 1e-14 * size) continue;
      moves[report->n_moves++] = (pl_start_move){
          .coordinate = i, .velocity = pass == 1, .given = given, .from = from, .to = x[i]};
      if (given) report->largest_move = fmax(report->largest_move, fabs(x[i] - from) / size);
    }
  }
  report->moves = moves;
}

static void list_sitting(pl_start* s) {
  pl_run* run = s->run;
  int* list = PL_ARRAY(run->job->arena, int, run->n_c + 1);
  for (int c = 0; c < run->n_c; c++)
    if (s->sits[c] && run->dae.on[c]) list[run->start.n_sitting++] = c;
  run->start.sitting = list;
}

static pleuel_status check_given(pl_run* run) {
  for (int i = 0; i < run->n_q; i++) {
    const pl_coordinate* c = &run->setup->coordinates[i];
    bool fine = (!c->has_q || isfinite(c->q)) && (!c->has_v || isfinite(c->v))
                && (!c->has_guess || isfinite(c->guess))
                && (!c->has_v_guess || isfinite(c->v_guess));
    if (!fine)
      return pl_fail(run->job, PLEUEL_USAGE, "the start value of %s is not a number", c->name);
  }
  return PLEUEL_OK;
}

// Contacts that given velocities leave: g is zero there, its derivative is not.
static void mark_leaving(pl_start* s) {
  pl_run* run = s->run;
  for (int c = 0; c < run->n_c; c++) {
    if (run->setup->constraints[c].side == 0 || run->dae.on[c] || run->dae.detached[c]
        || run->setup->constraints[c].velocity)
      continue;
    if (fabs(side_value(s, c)) <= met) pl_watch_of(run, PL_WATCH_LANDING, c)->fresh = 1;
  }
}

pleuel_status pl_start_find(pl_run* run, pl_start** out) {
  run->start = (pl_start_report){.constraint = -1, .move_coordinate = -1};
  PL_TRY(check_given(run));
  pl_start* s = *out = PL_NEW(run->job->arena, pl_start);
  *s = make(run);
  PL_TRY(find_positions(s));
  if (is_singular_start(s)) {
    run->start.trouble = PL_START_SINGULAR;
    return pl_fail(run->job, PLEUEL_SINGULAR,
                   "the start is a singular position: the constraints have lost rank there");
  }
  PL_TRY(find_velocities(s));
  memcpy(run->dae.q, s->q, (size_t)run->n_q * sizeof(double));
  memcpy(run->dae.v, s->v, (size_t)run->n_q * sizeof(double));
  pl_watch_forget(run);
  mark_leaving(s);
  run->control.start_given = true;
  run->dae.t = run->options.t_0;
  return PLEUEL_OK;
}

void pl_start_list(pl_start* s) {
  list_moves(s);
  list_sitting(s);
}
