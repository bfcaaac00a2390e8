// What the implicit stepper keeps when a run is written down (checkpoint.c).
//
// clang-format off
// not kept of pl_radau, follows from setup and options: method n n_q n_c n_C tol tol_stage ready
//   fits shape friction_of
// not kept of pl_radau, lives within a step: lanes here at coupled coupled_scale coupled_rhs
//   coupled_work coupled_pivot real real_scale work pair pair_scale pivot sparse sparse_pair Z Q V
//   A L t F w error_q error_v rhs sc_q sc_v coefficient part watched watched_h bent first_g last_g
//   last_size end_a end_l save_a save_l error next chosen full
// clang-format on
#include <limits.h>
#include <math.h>

#include "solve/stepper/radau/radau_impl.h"

// Counts go on from where they are, so there is room above.
static const long most_count = LONG_MAX / 8;
enum { LARGE_COUNT = 1 << 28 };

static void keep_fixed(pl_keeper* k, int x) { pl_keep_int(k, &x, x, x); }

void pl_radau_save(pl_run* run, pl_keeper* k) {
  pl_radau* r = run->radau;
  pl_keep_section(k, "implicit");
  keep_fixed(k, r->method.s);
  // the next step is predicted from the polynomial of the last one, and a look at stiffness reads
  // it too
  size_t rows = (size_t)run->order + 2;
  pl_keep_f64s(k, run->dae.V_last, rows * (size_t)run->n_q);
  pl_keep_f64s(k, run->dae.L_last, rows * (size_t)run->n_c);
  double* numbers[] = {&r->h_factored, &r->rounding, &r->h,           &r->h_last,
                       &r->error_last, &r->theta,    &r->cost_series, &r->h_dense};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) pl_keep_f64(k, numbers[i]);
  bool* flags[] = {&r->couples, &r->has_jacobian, &r->has_factor, &r->has_last, &r->rejected};
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) pl_keep_bool(k, flags[i]);
  long* counts[] = {&r->stay_next, &r->steps_in_row, &r->looks, &r->next_look};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
    pl_keep_long(k, counts[i], 0, most_count);
  pl_keep_long(k, &r->stay, -1, most_count);
  pl_keep_int(k, &r->newton, 0, LARGE_COUNT);
  pl_keep_int(k, &r->newton_last, 0, LARGE_COUNT);
  pl_keep_int(k, &r->dear, 0, LARGE_COUNT);
  if (k->reads && !(r->h >= 0 && isfinite(r->h))) pl_keep_fail(k);
}
