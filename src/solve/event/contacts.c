// Which contacts hold and which surfaces stick, at a moment when that is open: after an impact, at
// a release, when slip comes to rest.
//
// Twice the same question. For the impact: velocities v+ and impulses with, for each contact near
// by,
//
//     u+ + e u- >= 0,  Λ >= 0,  one of them zero      [Moreau1988], Newton's e, u velocity along g
//
// and for each friction |Λt| <= μ Λn while the slip ends with zero, or Λt = -μ Λn s+/|s+|. For the
// motion that follows: accelerations and forces with g'' >= 0, λ >= 0, one of them zero, and
// Coulomb's law with the derivative of the slip where there is none yet. A set of decisions (open
// or closed, stick or slip) makes both linear; a set is consistent when all signs are right. It is
// looked for by exchange: the first decision that is wrong is turned round ([Murty1974]; finite
// without friction, where the matrix is positive). With friction all sets are tried too, while they
// are not too many: none that fits, or two that fit with different accelerations, is Painlevé's
// paradox, and the run says so.
// See theory (13.2), (13.3), (14.1) to (14.3).
#include "solve/event/event.h"

#include <math.h>
#include <string.h>

enum { MOST_EXCHANGES = 400, MOST_SETS = 3000, MOST_TURNS = 100 };

static const double wrong_rate = 1e-10;  // of its terms: a rate with the wrong sign
static const double no_slip = 1e-11;     // of its terms: a slip velocity that counts as none
static const double over_limit = 1e-10;  // of the limit: a force that sticking cannot give

// Velocities along g and of slip, and the size of their terms. That the coordinates themselves are
// rounded counts for residuals, not for what is small here.
void pl_contacts_rates(pl_run* run, double* rates) {
  pl_assemble_gdot(&run->dae, rates, run->dae.r_size);
  for (int c = 0; c < run->n_c; c++) run->dae.r_size[c] /= fmax(run->dae.argument[c], 1);
}

// ----------------------------------------------------------------------------------- the decisions
static int side_of(const pl_run* run, int c) { return run->setup->constraints[c].side; }

static int way_of(int choice) { return (choice - PL_CHOICE_SLIP) & 1 ? -1 : 1; }
static int press_of(int choice) { return (choice - PL_CHOICE_SLIP) & 2 ? -1 : 1; }
static int slip_choice(int way, int press) { return PL_CHOICE_SLIP + (way < 0) + 2 * (press < 0); }
static bool is_allowed(const pl_decision* d, int choice) { return d->allowed >> choice & 1; }

static void add(pl_run* run, bool of_friction, int index, unsigned allowed, int choice) {
  pl_decision d = {of_friction, index, allowed, choice};
  for (int k = 0; k < 8 && !is_allowed(&d, d.choice); k++) d.choice = (d.choice + 1) % 8;
  run->event->decision[run->event->n_decisions++] = d;
}

// All that a friction may do: in space the direction is found, not chosen.
static unsigned choices_of(const pl_run* run, int r, int only_way) {
  const pl_friction_setup* friction = &run->setup->frictions[r];
  int side = side_of(run, friction->constraint);
  unsigned all = only_way ? 0 : 1u << PL_CHOICE_STICK;
  for (int press = -1; press <= 1; press += 2) {
    if (side != 0 && press != side) continue;
    for (int way = -1; way <= 1; way += 2) {
      if (friction->n_rows == 3 && way < 0) continue;
      if (only_way && friction->n_rows == 1 && way != only_way) continue;
      all |= 1u << slip_choice(way, press);
    }
  }
  return all;
}

// Puts the decisions into force.
static void apply(pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++) {
    const pl_decision* d = &run->event->decision[i];
    if (!d->of_friction) {
      run->dae.on[d->index] = d->choice == PL_CHOICE_CLOSED;
      continue;
    }
    pl_friction_state* now = &run->dae.friction[d->index];
    now->state = d->choice == PL_CHOICE_STICK ? PL_FRICTION_STICK : PL_FRICTION_SLIP;
    if (now->state == PL_FRICTION_SLIP) {
      now->way = way_of(d->choice);
      now->press = press_of(d->choice);
    }
  }
}

// ------------------------------------------------------------------------ what is wrong with a set
// decision, and what it should be instead; at -1: nothing
typedef struct pl_fault {
  int at, better;
} pl_fault;
static const pl_fault no_fault = {-1, 0};

// The forces of a contact or friction, the rates that belong to them, and what counts as zero.
typedef struct pl_trial_state {
  const double *force, *rate, *rate_size;
  double force_zero;  // of impulses; < 0: from the noise of multipliers
  bool kinetic;       // the limit of sticking is that of slipping
} pl_trial_state;

static double force_zero(const pl_run* run, const pl_trial_state* l, int c) {
  return l->force_zero >= 0 ? l->force_zero : pl_watch_force_noise(run, c);
}

static bool is_wrong_contact(const pl_run* run, const pl_trial_state* l, const pl_decision* d) {
  int c = d->index, side = side_of(run, c);
  if (d->choice == PL_CHOICE_CLOSED)
    return run->dae.active[c] && side * l->force[c] < -force_zero(run, l, c);
  return side * l->rate[c] < -wrong_rate * l->rate_size[c];
}

static int better_for_friction(const pl_run* run, const pl_trial_state* l, const pl_decision* d) {
  int r = d->index;
  const pl_friction_setup* friction = &run->setup->frictions[r];
  const pl_friction_state* now = &run->dae.friction[r];
  double press = l->force[friction->constraint], zero = force_zero(run, l, friction->constraint);
  if (d->choice == PL_CHOICE_STICK) {
    double limit = run->dae.C_series[l->kinetic ? friction->scale : friction->limit] * fabs(press);
    double F = pl_friction_force(&run->dae, r, l->force);
    if (F <= limit * (1 + over_limit) + force_zero(run, l, friction->row[0])) return d->choice;
    // it slips against the force that held it
    int way = friction->n_rows == 1 && l->force[friction->row[0]] > 0 ? -1 : 1;
    return slip_choice(way, press < 0 ? -1 : 1);
  }
  if (now->press * press < -zero) return slip_choice(now->way, -now->press);
  if (!is_allowed(d, PL_CHOICE_STICK)) return d->choice;
  double rate = now->way * l->rate[friction->row[0]],
         small = wrong_rate * l->rate_size[friction->row[0]];
  if (friction->n_rows == 3) {
    rate = small = 0;
    for (int i = 0; i < 3; i++) {
      rate += now->d[i] * l->rate[friction->row[i]];
      small += wrong_rate * l->rate_size[friction->row[i]];
    }
  }
  return rate < -small ? PL_CHOICE_STICK : d->choice;
}

static pl_fault find_fault(const pl_run* run, const pl_trial_state* l) {
  for (int i = 0; i < run->event->n_decisions; i++) {
    const pl_decision* d = &run->event->decision[i];
    if (!d->of_friction && is_wrong_contact(run, l, d))
      return (pl_fault){i, d->choice == PL_CHOICE_CLOSED ? PL_CHOICE_OPEN : PL_CHOICE_CLOSED};
    if (!d->of_friction || !pl_friction_is_used(&run->dae, d->index)) continue;
    int better = better_for_friction(run, l, d);
    if (better != d->choice) return (pl_fault){i, better};
  }
  return no_fault;
}

// -------------------------------------------------------------------------- accelerations of a set
// In space slip begins in the direction d that it itself makes: found by repetition. Returns
// whether d still changes.
static bool turn_slips(pl_run* run, const double* rate) {
  bool turned = false;
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->dae.friction[r];
    if (now->state != PL_FRICTION_SLIP || !now->given || !pl_friction_is_used(&run->dae, r))
      continue;
    double d[3];
    // slip that would at once run against itself is none
    if (pl_friction_speed(&run->dae, r, rate, d) == 0
        || d[0] * now->d[0] + d[1] * now->d[1] + d[2] * now->d[2] < 0)
      continue;
    for (int i = 0; i < 3; i++) turned |= fabs(d[i] - now->d[i]) > 1e-13;
    memcpy(now->d, d, sizeof d);
  }
  return turned;
}

static void restore_point(pl_run* run) {
  memcpy(run->dae.q, run->event->hold_q, (size_t)run->n_q * sizeof(double));
  memcpy(run->dae.v, run->event->hold_v, (size_t)run->n_q * sizeof(double));
  run->dae.factored = false;
}

// A first guess of the direction of slip in space: along the slip acceleration without friction.
static void guess_directions(pl_run* run) {
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->dae.friction[r];
    if (now->state == PL_FRICTION_SLIP && now->given) now->d[0] = now->d[1] = now->d[2] = 0;
  }
}

// Whether accelerations meet the rows that were left out because others seemed to say the same:
// where rows depend on each other for a moment only, as sticking does at a dead centre, they need
// not, and then that set cannot last.
static bool meets_all_rows(const pl_run* run) {
  static const double off = 1e-7;
  for (int c = 0; c < run->n_c && run->dae.rank < run->dae.n_active; c++)
    if (run->dae.active[c] && !run->dae.taken[c]
        && fabs(run->event->second[c]) > off * run->event->second_size[c])
      return false;
  return true;
}

static bool try_accelerations(pl_run* run, pl_trial_state* l) {
  apply(run);
  guess_directions(run);
  for (int turn = 0;; turn++) {
    restore_point(run);
    pl_active_set_update(&run->dae);
    pl_projection p = pl_project(&run->dae, run->dae.t, run->dae.q, run->dae.v);
    if (!p.ok || !pl_point_enter(&run->dae)) return false;
    pl_assemble_row_sizes(&run->dae);
    pl_assemble_second(&run->dae, run->dae.A, run->event->second, run->event->second_size);
    if (!meets_all_rows(run)) return false;
    if (!turn_slips(run, run->event->second) || turn >= MOST_TURNS) break;
  }
  *l = (pl_trial_state){run->dae.L, run->event->second, run->event->second_size, -1, false};
  return true;
}

// ------------------------------------------------------------------------------- impulses of a set
// What the velocity along g is to be after the impact.
static double rebound(const pl_run* run, int c) {
  const pl_constraint_setup* constraint = &run->setup->constraints[c];
  double u = run->event->approach[c];
  return run->dae.rebounds[c] && constraint->side * u < 0 ? -constraint->restitution * u : 0;
}

static bool solve_impulses(pl_run* run) {
  pl_active_set_update(&run->dae);
  memcpy(run->dae.v, run->event->hold_v, (size_t)run->n_q * sizeof(double));
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
  pl_active_set_choose(&run->dae);
  run->dae.impulsive = true;
  bool regular = pl_point_factor(&run->dae, false);
  run->dae.impulsive = false;
  run->dae.factored = false;
  if (!regular) return false;
  for (int i = 0; i < run->n_q; i++) run->dae.rhs[i] = 0;
  for (int c = 0; c < run->n_c; c++)
    run->dae.rhs[run->n_q + c] = run->dae.taken[c]
                                     ? (side_of(run, c) != 0 ? rebound(run, c) : 0) - run->dae.r[c]
                                     : 0;
  pl_kkt_solve(&run->dae.kkt, run->dae.rhs);
  if (!isfinite(pl_norm(run->dae.rhs, run->n_q))) return false;
  for (int i = 0; i < run->n_q; i++) run->dae.v[i] += run->dae.rhs[i];
  for (int c = 0; c < run->n_c; c++)
    run->event->impulse[c] = run->dae.taken[c] || run->dae.slips[c] ? -run->dae.rhs[run->n_q + c]
                                                                    : 0;
  pl_batches_load_v(&run->dae.motion, run->dae.v, 0);
  pl_assemble_gdot(&run->dae, run->event->second, run->event->second_size);
  return true;
}

static bool try_impulses(pl_run* run, pl_trial_state* l) {
  apply(run);
  for (int turn = 0;; turn++) {
    if (!solve_impulses(run)) return false;
    if (!turn_slips(run, run->event->second) || turn >= MOST_TURNS) break;
  }
  // rates of contacts count from the rebound
  for (int c = 0; c < run->n_c; c++)
    if (side_of(run, c) != 0) run->event->second[c] -= rebound(run, c);
  *l = (pl_trial_state){run->event->impulse, run->event->second, run->event->second_size,
                        1e-12 * pl_norm(run->event->impulse, run->n_c), true};
  return true;
}

// ------------------------------------------------------------------------------- looking for a set
typedef bool pl_trial(pl_run* run, pl_trial_state* l);

static bool has_used_friction(const pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++)
    if (run->event->decision[i].of_friction) return true;
  return false;
}

// By exchange; it may cycle with friction; stop after MOST_EXCHANGES rounds.
static bool exchange(pl_run* run, pl_trial* trial) {
  for (int round = 0; round < MOST_EXCHANGES; round++) {
    pl_trial_state l;
    if (!trial(run, &l)) return false;
    pl_fault f = find_fault(run, &l);
    if (f.at < 0) return true;
    pl_decision* d = &run->event->decision[f.at];
    if (!is_allowed(d, f.better)) return false;
    d->choice = f.better;
  }
  return false;
}

static double count_sets(const pl_run* run) {
  double n = 1;
  for (int i = 0; i < run->event->n_decisions; i++)
    n *= __builtin_popcount(run->event->decision[i].allowed);
  return n;
}

static void first_set(pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++)
    run->event->decision[i].choice = __builtin_ctz(run->event->decision[i].allowed);
}

// The next set in order; false: all were there.
static bool next_set(pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++) {
    pl_decision* d = &run->event->decision[i];
    for (d->choice++; d->choice < 8; d->choice++)
      if (is_allowed(d, d->choice)) return true;
    d->choice = __builtin_ctz(d->allowed);
  }
  return false;
}

// Friction choices do not matter while the contact is open: only the first is tried.
static bool is_idle(const pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++) {
    const pl_decision* d = &run->event->decision[i];
    if (d->of_friction && !pl_friction_is_used(&run->dae, d->index)
        && d->choice != __builtin_ctz(d->allowed))
      return true;
  }
  return false;
}

static void keep_choices(pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++)
    run->event->choice_kept[i] = run->event->decision[i].choice;
}

// If static exceeds kinetic friction, both can be consistent: sticking is preferred.
static bool sticks_harder(const pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++) {
    if (!run->event->decision[i].of_friction) continue;
    const pl_friction_setup* friction = &run->setup->frictions[run->event->decision[i].index];
    if (run->dae.C_series[friction->limit] > run->dae.C_series[friction->scale] * (1 + 1e-12))
      return true;
  }
  return false;
}

static bool same_contacts(const pl_run* run) {
  for (int i = 0; i < run->event->n_decisions; i++)
    if (!run->event->decision[i].of_friction
        && run->event->decision[i].choice != run->event->choice_kept[i])
      return false;
  return true;
}

static bool same_motion(const pl_run* run, const double* x, bool impact) {
  double most = pl_norm(run->event->first_a, run->n_q);
  for (int i = 0; i < run->n_q; i++) {
    double size = most + (impact ? run->dae.v_size : pl_free_size(&run->dae, i));
    if (fabs(x[i] - run->event->first_a[i]) > 1e-6 * size) return false;
  }
  return true;
}

// All sets; the first consistent one is kept. Returns how many different motions fit: 0, 1, or 2
// for several.
static int try_all(pl_run* run, pl_trial* trial, const double* motion) {
  int found = 0;
  first_set(run);
  do {
    pl_trial_state l;
    if (!trial(run, &l) || is_idle(run) || find_fault(run, &l).at >= 0) continue;
    if (found == 0) {
      found = 1;
      keep_choices(run);
      memcpy(run->event->first_a, motion, (size_t)run->n_q * sizeof(double));
    } else if (!same_motion(run, motion, motion == run->dae.v)
               && !(sticks_harder(run) && same_contacts(run))) {
      found = 2;
    }
  } while (found < 2 && next_set(run));
  for (int i = 0; i < run->event->n_decisions && found > 0; i++)
    run->event->decision[i].choice = run->event->choice_kept[i];
  pl_trial_state l;
  if (found == 1 && !trial(run, &l)) return 0;
  return found;
}

static pleuel_status paradox(pl_run* run, int found, bool impact) {
  const char* what = impact ? "impulses" : "forces";
  if (found == 0)
    return pl_fail(run->job, PLEUEL_NUMERICAL,
                   "no %s fit Coulomb's law and the contacts together at t = %.9g s (Painlevé's "
                   "paradox): rigid bodies with "
                   "this friction have no motion from here",
                   what, run->dae.t);
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "several %s fit Coulomb's law and the contacts at t = %.9g s (Painlevé's "
                 "paradox): rigid bodies with this "
                 "friction do not tell which motion follows",
                 what, run->dae.t);
}

// Finds the set.  motion: where a trial leaves accelerations or velocities.
static pleuel_status decide(pl_run* run, pl_trial* trial, const double* motion, bool impact) {
  if (has_used_friction(run) && count_sets(run) <= MOST_SETS) {
    int found = try_all(run, trial, motion);
    if (found != 1) return paradox(run, found, impact);
    return PLEUEL_OK;
  }
  if (exchange(run, trial)) return PLEUEL_OK;
  if (has_used_friction(run)) return paradox(run, 0, impact);
  if (!run->dae.ready && !impact) return pl_run_undetermined(run);
  return pl_fail(
      run->job, PLEUEL_NUMERICAL,
      "the contacts at t = %.9g s do not fit together: no set of them has forces that push",
      run->dae.t);
}

// ----------------------------------------------------------------------------------------- impacts
static const double at_rest = 1e-9;  // of the terms of the velocity along g

static bool is_arriving(const pl_run* run, int c) {
  const pl_constraint_setup* constraint = &run->setup->constraints[c];
  if (constraint->side != 0)
    return run->dae.near_by[c]
           && constraint->side * run->event->approach[c] < -at_rest * run->dae.r_size[c];
  return run->dae.active[c] && fabs(run->event->approach[c]) > at_rest * run->dae.r_size[c];
}

static void list_impact(pl_run* run) {
  run->event->n_decisions = 0;
  for (int c = 0; c < run->n_c; c++)
    if (run->dae.near_by[c])
      add(run, false, c, 1u << PL_CHOICE_OPEN | 1u << PL_CHOICE_CLOSED, PL_CHOICE_CLOSED);
  for (int r = 0; r < run->setup->n_frictions; r++) {
    int c = run->setup->frictions[r].constraint;
    run->dae.friction[r].given = run->setup->frictions[r].n_rows == 3;
    pl_friction_speed(&run->dae, r, run->event->approach, run->dae.friction[r].d);
    if (run->dae.near_by[c] || run->dae.active[c])
      add(run, true, r, choices_of(run, r, 0), PL_CHOICE_STICK);
  }
}

// Work of the impulses on the mean velocity: what the impact adds to the kinetic energy.
static double energy_gain(const pl_run* run) {
  double gain = 0;
  for (int c = 0; c < run->n_c; c++) {
    double after = run->event->second[c] + (side_of(run, c) != 0 ? rebound(run, c) : 0);
    gain += 0.5 * run->event->impulse[c] * (run->event->approach[c] + after);
  }
  return gain;
}

static pleuel_status check_gain(pl_run* run) {
  double size = 0, gain = energy_gain(run);
  for (int c = 0; c < run->n_c; c++) size += fabs(run->event->impulse[c] * run->event->approach[c]);
  if (!(gain > 1e-9 * size)) return PLEUEL_OK;
  return pl_fail(run->job, PLEUEL_NUMERICAL,
                 "Newton's impact law with friction would create energy at t = %.9g s (%.3g J): "
                 "this impact needs more than a "
                 "coefficient of restitution",
                 run->dae.t, gain);
}

static bool moving_walls(const pl_run* run) {
  for (int i = 0; i < run->dae.motion.n; i++)
    if (run->dae.motion.at[i].pattern->n_gt > 0) return true;
  return false;
}

pleuel_status pl_contacts_impact(pl_run* run, bool* any) {
  *any = false;
  for (int c = 0; c < run->n_c; c++) run->event->jumped[c] = false;
  pl_active_set_update(&run->dae);
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  pl_contacts_rates(run, run->event->approach);
  for (int c = 0; c < run->n_c; c++) {
    run->event->jumped[c] = is_arriving(run, c);
    *any |= run->event->jumped[c];
  }
  if (!*any) {
    for (int c = 0; c < run->n_c; c++) {
      if (!run->dae.near_by[c]
          || !(side_of(run, c) * run->event->approach[c] > at_rest * run->dae.r_size[c]))
        continue;
      run->dae.near_by[c] = run->dae.on[c] = false;  // it moves away
    }
    return PLEUEL_OK;
  }
  for (int c = 0; c < run->n_c; c++)
    run->dae.rebounds[c] = run->event->jumped[c] && run->dae.near_by[c]
                           && run->setup->constraints[c].restitution > 0
                           && !isfinite(run->event->settled_t[c]);
  memcpy(run->event->hold_v, run->dae.v, (size_t)run->n_q * sizeof(double));
  memcpy(run->event->hold_q, run->dae.q, (size_t)run->n_q * sizeof(double));
  list_impact(run);
  PL_TRY(decide(run, try_impulses, run->dae.v, true));
  run->event->impacts++;
  for (int c = 0; c < run->n_c; c++) {
    run->event->impact_taken[c] = run->dae.taken[c];
    run->event->impact_factor[c] = rebound(run, c) != 0 ? run->setup->constraints[c].restitution
                                                        : 0;
  }
  // a friction against a driven surface may add energy, and so may a driven wall
  if (has_used_friction(run) && !moving_walls(run)) PL_TRY(check_gain(run));
  for (int c = 0; c < run->n_c; c++) {
    run->event->jumped[c] = run->event->jumped[c] && run->event->impulse[c] != 0;
    if (!run->dae.near_by[c]) continue;
    double u = run->event->second[c] + rebound(run, c);
    bool bounced = run->dae.rebounds[c] && run->event->jumped[c];
    run->dae.on[c] = !bounced && !(side_of(run, c) * u > 1e-10 * run->dae.r_size[c]);
    run->dae.near_by[c] = run->dae.on[c];
  }
  for (int c = 0; c < run->n_c; c++) run->dae.rebounds[c] = false;
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------- the motion that follows
static void list_motion(pl_run* run) {
  run->event->n_decisions = 0;
  for (int c = 0; c < run->n_c; c++) {
    unsigned all = 1u << PL_CHOICE_OPEN | 1u << PL_CHOICE_CLOSED;
    if (run->dae.near_by[c])
      add(run, false, c, run->event->fixed[c] ? run->event->fixed[c] : all, PL_CHOICE_CLOSED);
  }
  for (int r = 0; r < run->setup->n_frictions; r++) {
    const pl_friction_setup* friction = &run->setup->frictions[r];
    pl_friction_state* now = &run->dae.friction[r];
    if (!run->dae.near_by[friction->constraint] && !run->dae.active[friction->constraint]) continue;
    double d[3], speed = pl_friction_speed(&run->dae, r, run->dae.r, d);
    bool slips = speed > no_slip * run->dae.r_size[friction->row[0]];
    if (friction->n_rows == 3) {
      double size = 0;
      for (int i = 0; i < 3; i++) size = fmax(size, run->dae.r_size[friction->row[i]]);
      slips = speed > fmax(no_slip * size, 2 * now->small);
    }
    if (run->event->friction_fixed[r] & PL_FRICTION_AT_REST) slips = false;
    now->given = friction->n_rows == 3 && !slips;
    unsigned all = choices_of(run, r, slips ? (friction->n_rows == 1 && d[0] < 0 ? -1 : 1) : 0);
    if (all & run->event->friction_fixed[r]) all &= run->event->friction_fixed[r];
    add(run, true, r, all, PL_CHOICE_STICK);
  }
}

// In space slip that begins has no direction yet in the equations: a velocity far below everything
// else gives it one.
static pleuel_status nudge(pl_run* run) {
  static const double speck = 1e-12;  // of the largest velocity
  bool any = false;
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->dae.friction[r];
    if (now->state != PL_FRICTION_SLIP || !now->given) continue;
    any = true;
  }
  if (!any) return PLEUEL_OK;
  // towards where the accelerations lead
  double a = pl_norm(run->dae.A, run->n_q), v = run->dae.v_size > 0 ? run->dae.v_size : 1;
  double dt = a > 0 ? speck * v / a : 0;
  for (int i = 0; i < run->n_q; i++) run->dae.v[i] += dt * run->dae.A[i];
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_gdot(&run->dae, run->dae.r, run->dae.r_size);
  for (int r = 0; r < run->setup->n_frictions; r++) {
    pl_friction_state* now = &run->dae.friction[r];
    if (now->state != PL_FRICTION_SLIP || !now->given) continue;
    double d[3];
    double speed = pl_friction_speed(&run->dae, r, run->dae.r, d);
    now->given = false;
    if (speed == 0)
      return pl_fail(run->job, PLEUEL_NUMERICAL,
                     "friction on %s begins to slip at t = %.9g s without a direction",
                     run->setup->frictions[r].name, run->dae.t);
    now->small = 0.1 * speed;
  }
  return pl_modes_enter(run);
}

pleuel_status pl_contacts_settle(pl_run* run) {
  pl_active_set_update(&run->dae);
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_assemble_g(&run->dae, 0, run->dae.g, run->dae.g_size);
  pl_contacts_rates(run, run->dae.r);
  memcpy(run->event->hold_q, run->dae.q, (size_t)run->n_q * sizeof(double));
  memcpy(run->event->hold_v, run->dae.v, (size_t)run->n_q * sizeof(double));
  list_motion(run);
  if (run->event->n_decisions > 0) PL_TRY(decide(run, try_accelerations, run->dae.A, false));
  PL_TRY(pl_modes_enter(run));
  return nudge(run);
}
