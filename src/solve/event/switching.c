// Switching points: places where |x|, sign x, min, max or if change their branch. A series
// continues the branch it began on, so a step must not reach across: it ends just behind the first
// crossing, where the other branch begins.
#include "solve/event/event.h"

#include <float.h>
#include <math.h>

static bool has_branches(const pl_tape_node* node) {
  return node->op == PL_OP_ABS || node->op == PL_OP_SIGN || node->op == PL_OP_IF
         || node->op == PL_OP_MIN || node->op == PL_OP_MAX;
}

static bool compares_two(const pl_tape_node* node) {
  return node->op == PL_OP_MIN || node->op == PL_OP_MAX;
}

// What changes sign at the switching point is operand a, or a - b.
static int count_in(const pl_tape* tape) {
  int n = 0;
  for (int i = tape->level_end[PL_LEVEL_CONST]; i < tape->level_end[PL_LEVEL_VELOCITY]; i++)
    n += tape->nodes[i].high && has_branches(&tape->nodes[i]);
  return n;
}

static void list_batch(pl_run* run, const pl_batch* b) {
  const pl_tape* tape = b->pattern->tape;
  for (int i = tape->level_end[PL_LEVEL_CONST]; i < tape->level_end[PL_LEVEL_VELOCITY]; i++) {
    const pl_tape_node* node = &tape->nodes[i];
    if (!node->high || !has_branches(node)) continue;
    for (int l = 0; l < b->n; l++)
      run->event->switches[run->event->n_switches++] = (pl_switch){
          b, node->a, compares_two(node) ? node->b : -1, l};
  }
}

void pl_switching_make(pl_run* run) {
  size_t n = 0;
  for (int i = 0; i < run->dae.motion.n; i++)
    n += (size_t)count_in(run->dae.motion.at[i].pattern->tape) * (size_t)run->dae.motion.at[i].n;
  run->event->switches = PL_ARRAY(run->job->arena, pl_switch, n + 1);
  run->event->K_series = PL_ARRAY(run->job->arena, double, n*(size_t)run->order + 1);
  for (int i = 0; i < run->dae.motion.n; i++) list_batch(run, &run->dae.motion.at[i]);
}

static double coefficient(const pl_switch* at_switch, int node, int k) {
  if (node < 0 || (k > 0 && node < at_switch->batch->pattern->tape->level_end[PL_LEVEL_CONST]))
    return 0;
  return pl_jet_at(at_switch->batch->jet, node, k)[at_switch->lane];
}

void pl_switching_series(pl_run* run) {
  for (int i = 0; i < run->event->n_switches; i++) {
    const pl_switch* at_switch = &run->event->switches[i];
    for (int k = 0; k < run->order; k++)
      run->event->K_series[(size_t)i * (size_t)run->order + (size_t)k] =
          coefficient(at_switch, at_switch->a, k) - coefficient(at_switch, at_switch->b, k);
  }
}

// What changes sign, at the point that the programs were evaluated at.
double pl_switching_value(const pl_run* run, int i) {
  const pl_switch* at_switch = &run->event->switches[i];
  return coefficient(at_switch, at_switch->a, 0) - coefficient(at_switch, at_switch->b, 0);
}

static double value_at(const double* c, int n, double x) {
  double p = 0;
  for (int k = n - 1; k >= 0; k--) p = p * x + c[k];
  return p;
}

// A value below this part of the size of its polynomial has no certain sign.
static const double unsure = 64 * DBL_EPSILON;

// Just behind a root, where rounding leaves no doubt about the side.
static double behind(const double* c, int n, double size, double root) {
  for (double more = 0x1p-46; more < 1e-6; more *= 2)
    if (fabs(value_at(c, n, root + more)) > unsure * size) return root + more;
  return root;
}

static bool same_side(double a, double b) { return (a > 0 && b > 0) || (a < 0 && b < 0); }

// Just behind the first switching point of one polynomial; -1 none on the step.
static double find_kink(pl_run* run, const double* c, int n, double size) {
  double root;
  if (fabs(c[0]) > unsure * size) {
    root = pl_first_root(c, n - 1, 0, run->event->root_work);
  } else {
    // at a switching point: the side on which it stands must be the one to which it moves
    double away = behind(c, n, size, 0);
    if (away > 0 && !same_side(c[0], value_at(c, n, away))) return away;
    root = n > 1 ? pl_first_root(c + 1, n - 2, 0, run->event->root_work) : -1;
  }
  return root < 0 ? -1 : behind(c, n, size, root);
}

double pl_switching_reach(pl_run* run, double h) {
  double part = fmax(100 * run->control.tol, 1e-14);
  for (int i = 0; i < run->event->n_switches; i++) {
    double *c = run->event->poly, power = 1;
    for (int k = 0; k < run->dae.use; k++, power *= h)
      c[k] = power * run->event->K_series[(size_t)i * (size_t)run->order + (size_t)k];
    h *= pl_watch_known(c, run->dae.use, 0, part);
  }
  return h;
}

double pl_switching_first(pl_run* run, double h) {
  double first = -1;
  for (int i = 0; i < run->event->n_switches; i++) {
    double *c = run->event->poly, power = 1, size = 0;
    for (int k = 0; k < run->dae.use; k++, power *= h) {
      c[k] = power * run->event->K_series[(size_t)i * (size_t)run->order + (size_t)k];
      size += fabs(c[k]);
    }
    double end = size > 0 ? find_kink(run, c, run->dae.use, size) : -1;
    if (end >= 0 && (first < 0 || end < first)) first = end;
  }
  return first;
}
