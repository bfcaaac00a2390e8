// The order of the series and the length of a step in units of its radius, from the tolerance.
// See theory (10.5).
#include "solve/stepper/taylor/taylor_impl.h"

#include <math.h>

enum { MIN_ORDER = 6, MAX_ORDER = 24 };

void pl_taylor_make(pl_run* run) {
  run->taylor = PL_NEW(run->job->arena, pl_taylor);
  run->taylor->end_a = PL_ARRAY(run->job->arena, double, run->n_q + 1);
}

// Jorba and Zou: terms of a series fall best like e^-2 from one to the next.
static int plain_order(double tol) {
  int p = (int)ceil(-0.5 * log(tol) + 1);
  return p < MIN_ORDER ? MIN_ORDER : p > MAX_ORDER ? MAX_ORDER : p;
}

// Nodes of the equations, of all instances together.
static double nodes_of(const pl_setup* s) {
  double nodes = 0;
  for (int i = 0; i < s->n_patterns; i++)
    nodes += (double)s->patterns[i].n * s->patterns[i].tape->n_nodes;
  return nodes;
}

// That is the best order when the work of a step grows with the square of the order. But much of it
// is done once a step: evaluating the point, the factor, two projections cost as much as eight
// orders, in the smallest systems as twenty. Then a higher order with a step of tol^(1/(p-1)) radii
// gets farther for its price. In small systems products of series are cheap beside everything else;
// in large ones they are all that is there, and memory is the limit.
static int cheapest_order(double tol, double nodes, int largest) {
  // in units of the work of an order
  const double fixed = 8 + 400 / (17 + nodes), square = 0.1 * nodes / (nodes + 100);
  int best = plain_order(tol);
  double least = (double)INFINITY;
  for (int p = best; p <= largest; p++) {
    double price = (fixed + p + square * p * p) * pow(tol, -1.0 / (p - 1));
    if (price < least) {
      best = p;
      least = price;
    }
  }
  return best;
}

// Twenty where rounding decides; more pays in small systems whose tolerance is given.
void pl_taylor_plan(pl_run* run) {
  pl_taylor_make(run);
  enum { LARGEST = 20, LARGEST_SMALL = 25 };
  bool small = run->n_q + run->n_c <= PL_DENSE_UP_TO && run->options.tol > 0
               && !run->control.tol_raised;
  run->order = cheapest_order(run->control.tol, nodes_of(run->setup),
                              small ? LARGEST_SMALL : LARGEST);
  run->taylor->shrink = run->order == plain_order(run->control.tol)
                            ? -2
                            : log(0.1 * run->control.tol) / (run->order - 1);
}
