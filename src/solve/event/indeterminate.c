// Statically indeterminate forces of contact and friction: a table on four legs, a ladder that
// rests on rough ground.
//
// The motion is determined, and so is what all forces do together; one set of them was chosen
// (contacts.c). Another one differs by a null vector z of the map from multipliers to forces on the
// coordinates. It is admissible as long as contacts push and friction stays below its limit, so z
// counts when the inequalities that are equalities now allow it:
//
//     B z = 0,     C z >= 0
//
// Over a basis Z of the null space, z = Z w, multiplier i is not determined when some w has C Z w
// >= 0 and (Z w)_i != 0, by Farkas when -(±Z_i) is no combination of the rows of C Z with weights
// >= 0: least squares with such weights [LawsonHanson1974, chapter 23] leave a residual. Asked for
// once a mode; multipliers of frictions that slip go with those that press, and contacts that are
// met without a force take part.
// See theory (13.5).
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solve/event/event.h"

enum { MOST = 160 };  // multipliers that are examined together
// of a column of length 1: what is left of one that says nothing new
static const double dependent = 1e-9;
static const double zero_rate = 1e-9;  // of its terms: a rate that counts as none
static const double at_limit = 1e-8;   // of the limit: a force that has reached it
static const double leaves = 1e-6;     // of a null vector: what is no combination

struct pl_indeterminate {
  int n, n_rows;  // multipliers that may differ; inequalities that are equalities
  // of each constraint among them, -1; the constraint of each              (n_c, MOST)
  int *place, *row_of;
  // columns of length 1, their lengths before                               (n_q x n, n)
  double *B, *length;
  // inequalities                                                           (2 MOST x n)
  double* C;
  double *Z, *E, *copy;  // null space (n x d), its inequalities (d x rows), work
  double *tau, *norm, *w, *rest, *weight, *trial, *f;
  int *jpvt, *passive;
  bool* in;
};

void pl_indeterminate_make(pl_run* run) {
  pl_arena* a = run->job->arena;
  bool any = run->setup->n_frictions > 0;
  for (int c = 0; c < run->n_c; c++) any |= run->setup->constraints[c].side != 0;
  if (!any) return;
  pl_indeterminate* s = run->event->indeterminate = PL_NEW(a, pl_indeterminate);
  size_t n = run->n_c < MOST ? (size_t)run->n_c : MOST, q = (size_t)run->n_q, rows = 2 * n + 1;
  s->place = PL_ARRAY(a, int, run->n_c + 1);
  s->row_of = PL_ARRAY(a, int, n + 1);
  s->B = PL_ARRAY(a, double, q* n + 1);
  s->length = PL_ARRAY(a, double, n + 1);
  s->C = PL_ARRAY(a, double, rows* n + 1);
  s->Z = PL_ARRAY(a, double, n* n + 1);
  s->E = PL_ARRAY(a, double, rows* n + 1);
  s->copy = PL_ARRAY(a, double, rows* n + 1);
  double** of[] = {&s->tau, &s->norm, &s->w, &s->rest, &s->weight, &s->trial, &s->f};
  for (size_t i = 0; i < 7; i++) *of[i] = PL_ARRAY(a, double, 2 * rows + q);
  s->jpvt = PL_ARRAY(a, int, rows + 1);
  s->passive = PL_ARRAY(a, int, rows + 1);
  s->in = PL_ARRAY(a, bool, rows + 1);
}

// ---------------------------------------------------------------------- multipliers that take part
static bool no_rate(const pl_run* run, int c) {
  return fabs(run->dae.r[c]) <= zero_rate * run->dae.r_size[c]
         && fabs(run->event->second[c]) <= zero_rate * run->event->second_size[c];
}

static bool rests_on(const pl_run* run, int r) {
  if (run->dae.friction[r].state == PL_FRICTION_STICK) return true;
  for (int i = 0; i < run->setup->frictions[r].n_rows; i++)
    if (!no_rate(run, run->setup->frictions[r].row[i])) return false;
  return true;
}

static void take(pl_indeterminate* s, int c) {
  if (s->n < MOST && s->place[c] < 0) s->row_of[s->place[c] = s->n++] = c;
}

static void find_multipliers(pl_run* run, pl_indeterminate* s) {
  s->n = 0;
  for (int c = 0; c < run->n_c; c++) s->place[c] = -1;
  for (int c = 0; c < run->n_c; c++) {
    const pl_constraint_setup* constraint = &run->setup->constraints[c];
    bool met = constraint->side != 0 && !constraint->velocity && run->event->met[c]
               && !run->dae.active[c] && no_rate(run, c);
    // equations that only define coordinates carry no force of their own
    if (!constraint->slip && constraint->priority == 0 && (run->dae.active[c] || met)) take(s, c);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    if (s->place[friction->constraint] < 0 || run->dae.friction[r].state == PL_FRICTION_OFF
        || !rests_on(run, r))
      continue;
    for (int i = 0; i < friction->n_rows; i++) take(s, friction->row[i]);
  }
}

// ------------------------------------------------------------------------------------ their forces
// Adds factor times the forces of constraint c to column k.
static void add_forces(const pl_run* run, pl_indeterminate* s, int c, int k, double factor) {
  double* to = s->B + (size_t)k * (size_t)run->n_q;
  for (int i = 0; i < run->dae.motion.n; i++) {
    const pl_batch* b = &run->dae.motion.at[i];
    const pl_pattern* p = b->pattern;
    for (int l = 0; l < b->n; l++) {
      for (const pl_pattern_entry* e = p->G; e < p->G + p->n_G; e++)
        if (b->c[e->row * b->lanes + l] == c)
          to[b->q[e->col * b->lanes + l]] += factor
                                             * pl_jet_at(b->jet, p->tape->roots[e->root], 0)[l];
      for (const pl_pattern_entry* e = p->W; e < p->W + p->n_W; e++)
        if (b->c[e->col * b->lanes + l] == c)
          to[b->q[e->row * b->lanes + l]] += factor
                                             * pl_jet_at(b->jet, p->tape->roots[e->root], 0)[l];
    }
  }
}

static void make_columns(pl_run* run, pl_indeterminate* s) {
  int n = run->n_q;
  memset(s->B, 0, (size_t)n * (size_t)s->n * sizeof(double));
  for (int k = 0; k < s->n; k++) add_forces(run, s, s->row_of[k], k, 1);
  // friction that slips goes with the force that presses
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    if (run->dae.friction[r].state != PL_FRICTION_SLIP || s->place[friction->constraint] < 0
        || s->place[friction->row[0]] >= 0)
      continue;
    for (int i = 0; i < friction->n_rows; i++)
      add_forces(run, s, friction->row[i], s->place[friction->constraint],
                 pl_friction_kappa(&run->dae, r, i, run->dae.C_series));
  }
  for (int k = 0; k < s->n; k++) {
    double *x = s->B + (size_t)k * (size_t)n, sum = 0, most = pl_norm(x, n);
    for (int i = 0; i < n && most > 0; i++) sum += (x[i] / most) * (x[i] / most);
    s->length[k] = most > 0 ? most * sqrt(sum) : 1;
    for (int i = 0; i < n; i++) x[i] /= s->length[k];
  }
}

// ------------------------------------------------------------------------------------ their limits
static double* new_row(pl_indeterminate* s) {
  double* row = s->C + (size_t)s->n_rows++ * (size_t)s->n;
  memset(row, 0, (size_t)s->n * sizeof(double));
  return row;
}

// The unknowns belong to columns of length 1.
static void put(pl_indeterminate* s, double* row, int c, double x) {
  row[s->place[c]] += x / s->length[s->place[c]];
}

static void limit_friction(pl_run* run, pl_indeterminate* s, int r, bool pressed) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  double limit = run->dae.C_series[friction->limit], lambda = run->dae.L[friction->constraint],
         most = limit * fabs(lambda);
  double F = pl_friction_force(&run->dae, r, run->dae.L),
         press = lambda < 0
                         || (lambda == 0 && run->setup->constraints[friction->constraint].side < 0)
                     ? -1
                     : 1;
  if (friction->n_rows == 1) {
    for (int way = -1; way <= 1; way += 2) {
      double m = way * run->dae.L[friction->row[0]];
      if (pressed && m < most * (1 - at_limit)) continue;
      double* row = new_row(s);
      put(s, row, friction->constraint, press * limit);
      put(s, row, friction->row[0], -way);
    }
    return;
  }
  if (!pressed || F < most * (1 - at_limit)) return;
  static const int pair[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  double* row = new_row(s);
  put(s, row, friction->constraint, limit * limit * lambda);
  for (int i = 0; i < 3; i++) {
    double slope = 0;
    for (int j = 0; j < 3; j++)
      slope += run->dae.C_series[friction->metric[pair[i][j]]] * run->dae.L[friction->row[j]];
    put(s, row, friction->row[i], -slope);
  }
}

static void find_limits(pl_run* run, pl_indeterminate* s) {
  s->n_rows = 0;
  for (int k = 0; k < s->n; k++) {
    int c = s->row_of[k], side = run->setup->constraints[c].side;
    if (side == 0 || run->setup->constraints[c].slip) continue;
    if (fabs(run->dae.L[c]) <= pl_watch_force_noise(run, c)) put(s, new_row(s), c, side);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    if (s->place[friction->row[0]] < 0) continue;
    bool pressed = fabs(run->dae.L[friction->constraint])
                   > pl_watch_force_noise(run, friction->constraint);
    limit_friction(run, s, r, pressed);
  }
}

// ---------------------------------------------------------------------------------- the null space
// Z (n x d), columns; returns d.
static int find_null_space(pl_run* run, pl_indeterminate* s) {
  int n = s->n, m = run->n_q;
  int rank = pl_qr_factor(s->B, s->jpvt, s->tau, s->norm, m, n, dependent);
  for (int d = 0; d < n - rank; d++) {
    double* z = s->Z + (size_t)d * (size_t)n;
    memset(z, 0, (size_t)n * sizeof(double));
    // R11 x = -R12 e_d
    for (int i = rank - 1; i >= 0; i--) {
      double sum = -s->B[(size_t)i + (size_t)(rank + d) * (size_t)m];
      for (int j = i + 1; j < rank; j++) sum -= s->B[(size_t)i + (size_t)j * (size_t)m] * s->w[j];
      s->w[i] = sum / s->B[(size_t)i + (size_t)i * (size_t)m];
    }
    for (int i = 0; i < rank; i++) z[s->jpvt[i]] = s->w[i];
    z[s->jpvt[rank + d]] = 1;
  }
  return n - rank;
}

// Columns of E: the inequalities over the null space, of length 1.
static void reduce_limits(pl_indeterminate* s, int d) {
  for (int r = 0; r < s->n_rows; r++) {
    double *e = s->E + (size_t)r * (size_t)d, sum = 0;
    for (int k = 0; k < d; k++) {
      e[k] = 0;
      for (int i = 0; i < s->n; i++)
        e[k] += s->C[(size_t)r * (size_t)s->n + (size_t)i]
                * s->Z[(size_t)k * (size_t)s->n + (size_t)i];
      sum += e[k] * e[k];
    }
    for (int k = 0; k < d && sum > 0; k++) e[k] /= sqrt(sum);
  }
}

// --------------------------------------------------------------------- least squares, weights >= 0
static double residual(const pl_indeterminate* s, int d) {
  double sum = 0;
  for (int k = 0; k < d; k++) {
    s->rest[k] = s->f[k];
    for (int r = 0; r < s->n_rows; r++)
      s->rest[k] -= s->E[(size_t)r * (size_t)d + (size_t)k] * s->weight[r];
    sum += s->rest[k] * s->rest[k];
  }
  return sqrt(sum);
}

static int most_promising(const pl_indeterminate* s, int d) {
  int best = -1;
  double most = 1e-10;
  for (int r = 0; r < s->n_rows; r++) {
    double along = 0;
    for (int k = 0; k < d; k++) along += s->E[(size_t)r * (size_t)d + (size_t)k] * s->rest[k];
    if (!s->in[r] && along > most) {
      most = along;
      best = r;
    }
  }
  return best;
}

// Least squares with the weights that are in, into trial.
static int solve_passive(pl_indeterminate* s, int d) {
  int k = 0;
  for (int r = 0; r < s->n_rows; r++) {
    if (!s->in[r]) continue;
    memcpy(s->copy + (size_t)k * (size_t)d, s->E + (size_t)r * (size_t)d,
           (size_t)d * sizeof(double));
    s->passive[k++] = r;
  }
  int rank = pl_qr_factor(s->copy, s->jpvt, s->tau, s->norm, d, k, 1e-12);
  memcpy(s->w, s->f, (size_t)d * sizeof(double));
  pl_qr_least_squares(s->copy, s->tau, s->w, d, rank);
  for (int i = 0; i < k; i++) s->trial[s->passive[s->jpvt[i]]] = i < rank ? s->w[i] : 0;
  return k;
}

// How far f is from every combination of the inequalities with weights >= 0.
static double distance(pl_indeterminate* s, int d) {
  for (int r = 0; r < s->n_rows; r++) {
    s->weight[r] = 0;
    s->in[r] = false;
  }
  for (int round = 0; round < 3 * s->n_rows + 3; round++) {
    residual(s, d);
    int next = most_promising(s, d);
    if (next < 0) break;
    s->in[next] = true;
    for (int inner = 0; inner <= s->n_rows; inner++) {
      int k = solve_passive(s, d);
      double part = 1;
      for (int i = 0; i < k; i++) {
        int r = s->passive[i];
        if (s->trial[r] <= 0)
          part = fmin(part, s->weight[r] > 0 ? s->weight[r] / (s->weight[r] - s->trial[r]) : 0);
      }
      for (int i = 0; i < k; i++) {
        int r = s->passive[i];
        bool out = part < 1 && s->trial[r] <= 0
                   && (s->weight[r] == 0 || s->weight[r] / (s->weight[r] - s->trial[r]) <= part);
        s->weight[r] = out ? 0 : s->weight[r] + part * (s->trial[r] - s->weight[r]);
        s->in[r] = !out;
      }
      if (part == 1) break;
    }
  }
  return residual(s, d);
}

static bool may_differ(pl_indeterminate* s, int i, int d) {
  double size = 0;
  for (int k = 0; k < d; k++) size = fmax(size, fabs(s->Z[(size_t)k * (size_t)s->n + (size_t)i]));
  if (size <= leaves) return false;
  for (int sign = -1; sign <= 1; sign += 2) {
    for (int k = 0; k < d; k++) s->f[k] = sign * s->Z[(size_t)k * (size_t)s->n + (size_t)i] / size;
    if (distance(s, d) > leaves) return true;
  }
  return false;
}

// ----------------------------------------------------------------------------------------- telling
void pl_indeterminate_report(pl_run* run) {
  size_t n = 0, at = 0;
  run->stats.undetermined = NULL;
  for (int c = 0; c < run->n_c; c++)
    if (run->dae.ever_several[c]) n += strlen(run->setup->constraints[c].column) + 2;
  if (n == 0) return;
  char* text = PL_ARRAY(run->job->arena, char, n + 1);
  for (int c = 0; c < run->n_c; c++)
    if (run->dae.ever_several[c])
      at += (size_t)snprintf(text + at, n + 1 - at, "%s%s", at > 0 ? ", " : "",
                             run->setup->constraints[c].column);
  run->stats.undetermined = text;
}

// --------------------------------------------------------------------------------------------- all
// After a mode was chosen: run->event->met, r, second and the programs belong to the point.
void pl_indeterminate_mark(pl_run* run) {
  pl_indeterminate* s = run->event->indeterminate;
  if (s == NULL) return;
  for (int c = 0; c < run->n_c; c++) run->dae.several[c] = false;
  find_multipliers(run, s);
  if (s->n == 0 || s->n == MOST) return;
  make_columns(run, s);
  find_limits(run, s);
  int d = find_null_space(run, s);
  if (d == 0) return;
  reduce_limits(s, d);
  for (int i = 0; i < s->n; i++) run->dae.several[s->row_of[i]] = may_differ(s, i, d);
  // what slips goes with what presses
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    bool tied = run->dae.friction[r].state == PL_FRICTION_SLIP && s->place[friction->row[0]] < 0;
    for (int i = 0; i < friction->n_rows && tied; i++)
      run->dae.several[friction->row[i]] = run->dae.several[friction->constraint];
  }
  for (int c = 0; c < run->n_c; c++)
    run->dae.unique[c] = run->dae.unique[c] && !run->dae.several[c];
  pl_active_set_note(&run->dae);
}
