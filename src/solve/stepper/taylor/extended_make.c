// What a run on extended numbers needs: whether this model is supported, programs, memory.
#include <math.h>
#include <string.h>

#include "solve/stepper/taylor/extended_impl.h"

// Orders below this are computed in extended numbers, those above in doubles: terms there are e^-24
// of the whole and less, so that their rounding errors are four thousand times smaller than those
// of the state, which has 64 digits.
enum { LOW_ORDERS = 12 };

// Jorba and Zou: terms of a series fall best like e^-2 from one to the next, where the work is that
// of the orders.
void pl_extended_order(pl_run* run) {
  pl_taylor_make(run);
  enum { LEAST = 6, MOST = 40 };
  int p = (int)ceil(-0.5 * log(run->control.tol) + 1);
  run->order = p < LEAST ? LEAST : p > MOST ? MOST : p;
  run->taylor->shrink = -2;
}

// --------------------------------------------------------------------------- what is not supported
const char* pl_extended_name(const pl_run* run) {
  return run->options.precision == PL_PRECISION_LONG ? "long" : "quad";
}

static bool changes_motion(const pl_event_setup* e) {
  for (int i = 0; i < e->n_actions; i++)
    if (e->actions[i].kind != PL_ACTION_STOP && e->actions[i].kind != PL_ACTION_RECORD) return true;
  return false;
}

static pleuel_status check_types(pl_run* run) {
  if (run->options.precision == PL_PRECISION_LONG && pl_real_long() == NULL)
    return pl_fail(
        run->job, PLEUEL_UNSUPPORTED,
        "precision long: this processor or compiler has no 80-bit numbers; use quad or double");
  if (pl_real_quad() == NULL)
    return pl_fail(
        run->job, PLEUEL_UNSUPPORTED,
        "precision %s: the compiler that built this program has no 128-bit numbers; use double",
        pl_extended_name(run));
  return PLEUEL_OK;
}

static pleuel_status check_contacts(pl_run* run) {
  const pl_setup* s = run->setup;
  const char* mode = pl_extended_name(run);
  if (s->n_frictions > 0)
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: friction (on %s) is followed in double only", mode,
                   s->frictions[0].name);
  for (int c = 0; c < s->n_c; c++)
    if (s->constraints[c].side != 0 || s->constraints[c].off)
      return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                     "precision %s: contacts that open and close (%s) are followed in double only",
                     mode, s->constraints[c].name);
  for (int e = 0; e < s->n_events; e++)
    if (changes_motion(&s->events[e]))
      return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                     "precision %s: event %s changes the motion, which is done in double only; "
                     "record and stop are possible",
                     mode, s->events[e].name);
  return PLEUEL_OK;
}

pleuel_status pl_extended_check(pl_run* run) {
  const char* mode = pl_extended_name(run);
  PL_TRY(check_types(run));
  PL_TRY(check_contacts(run));
  if (run->options.method == PL_METHOD_RADAU)
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: the implicit method computes in double only; use the series",
                   mode);
  if (run->event->n_switches > 0)
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: a force or constraint with a kink (abs, sign, min, max, if) is "
                   "followed in double only",
                   mode);
  if (run->dae.has_W)
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: forces that depend on multipliers are computed in double only",
                   mode);
  if (run->dae.mass_of_velocity)
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: masses that depend on velocities are computed in double only",
                   mode);
  if (run->setup->n_attitudes > 0)
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: bodies in Euler angles are followed in double only; give their "
                   "axes as a quaternion",
                   mode);
  if (!pl_step_program_fits(run))
    return pl_fail(run->job, PLEUEL_UNSUPPORTED,
                   "precision %s: %d coordinates and constraints are more than the %d that it is "
                   "made for; use double",
                   mode, run->n_q + run->n_c, PL_STEP_UNKNOWNS);
  return PLEUEL_OK;
}

// ---------------------------------------------------------------------------- the series at a time
// A series in memory: rows of n numbers; a copy of the first, which order 0 of the next point
// takes; the sum of rows that are not here; the result.
typedef struct series {
  int rows, n, first, n_first, tail, end;
} series;

// Horner's sum of rows 0 .. last.  tail: where the sum of the rows behind lies, -1 none.
static void sum_rows(pl_prog* c, const series* s, int i, int h, int last, int tail) {
  int x = tail >= 0 ? pl_prog_load(c, tail + i, 0) : pl_prog_load(c, s->rows + last * s->n + i, 0);
  for (int row = tail >= 0 ? last : last - 1; row >= 0; row--) {
    int from = (row < s->n_first ? s->first : s->rows) + row * s->n;
    x = pl_prog_op3(c, PL_PROG_FMA, x, h, pl_prog_load(c, from + i, 0));
  }
  pl_prog_store(c, x, s->end + i, 0);
}

static void end_code(pl_extended* w, pl_prog* c) {
  c->spill = w->o->size;
  w->o->size += c->n_registers;
}

static pl_prog* sum_code(pl_run* run, const char* name, const series* s, const int* low) {
  pl_extended* w = run->extended;
  pl_prog* c = pl_prog_make(run->job->arena, name, 1);
  int h = pl_prog_load(c, w->o->length, 0);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < s[k].n; i++)
      sum_rows(c, &s[k], i, h, low[k], w->by_doubles ? s[k].tail : -1);
  end_code(w, c);
  return c;
}

// q gets one more coefficient without a solve.
static pl_prog* top_code(pl_run* run) {
  const pl_step_program* o = run->extended->o;
  pl_prog* c = pl_prog_make(run->job->arena, "top", 1);
  int by = pl_prog_number(c, run->order + 1);
  for (int i = 0; i < o->n_q; i++) {
    int v = pl_prog_load(c, o->V + run->order * o->n_q + i, 0);
    pl_prog_store(c, pl_prog_op2(c, PL_PROG_DIV, v, by), o->Q + (run->order + 1) * o->n_q + i, 0);
  }
  end_code(run->extended, c);
  return c;
}

static void write_clock(pl_run* run) {
  pl_extended* w = run->extended;
  pl_arena* a = run->job->arena;
  int length = w->o->length;
  pl_prog* c = w->clock = pl_prog_make(a, "clock", 1);
  pl_prog_store(c,
                pl_prog_op2(c, PL_PROG_ADD, pl_prog_load(c, w->t_0, 0), pl_prog_load(c, length, 0)),
                w->o->time, 0);
  end_code(w, c);
  c = w->left = pl_prog_make(a, "left", 1);
  pl_prog_store(c,
                pl_prog_op2(c, PL_PROG_SUB, pl_prog_load(c, w->to, 0), pl_prog_load(c, w->t_0, 0)),
                length, 0);
  end_code(w, c);
  c = w->grid = pl_prog_make(a, "grid", 1);
  int way = pl_prog_op2(c, PL_PROG_DIV, pl_prog_load(c, w->scratch, 0),
                        pl_prog_load(c, w->share, 0));
  int t = pl_prog_op2(c, PL_PROG_ADD, way, pl_prog_load(c, w->from, 0));
  pl_prog_store(c, t, w->o->time, 0);
  pl_prog_store(c, pl_prog_op2(c, PL_PROG_SUB, t, pl_prog_load(c, w->t_0, 0)), length, 0);
  end_code(w, c);
}

static void write_drift(pl_run* run) {
  pl_extended* w = run->extended;
  pl_prog* c = w->drift = pl_prog_make(run->job->arena, "drift", 1);
  int T = pl_prog_load(c, w->o->energy, 0), V = pl_prog_load(c, w->o->energy + 1, 0);
  int E = run->setup->energy > 0 ? pl_prog_load(c, w->o->energy + 2, 0)
                                 : pl_prog_op2(c, PL_PROG_ADD, T, V);
  pl_prog_store(c, pl_prog_op2(c, PL_PROG_SUB, E, pl_prog_load(c, w->energy_base, 0)), w->scratch,
                0);
  pl_prog_store(c, E, w->scratch + 1, 0);
  end_code(w, c);
}

static void write_sums(pl_run* run) {
  pl_extended* w = run->extended;
  const pl_step_program* o = w->o;
  int p = run->order, n_q = run->n_q, n_c = run->n_c;
  series state[2] = {{o->Q, n_q, w->q_0, 2, w->tail_q, o->end_q},
                     {o->V, n_q, w->v_0, 2, w->tail_v, o->end_v}};
  series forces[2] = {{o->A, n_q, w->a_0, 1, w->tail_a, w->end_a},
                      {o->L, n_c, w->l_0, 1, w->tail_l, w->end_l}};
  int last[2] = {w->by_doubles ? w->low : p + 1, w->low}, last_forces[2] = {w->low - 1, w->low - 1};
  w->top = top_code(run);
  w->head = sum_code(run, "head", state, last);
  w->head_forces = sum_code(run, "head_forces", forces, last_forces);
}

// ------------------------------------------------------------------------------------------ memory
static int take(pl_extended* w, int n) {
  int at = w->o->size;
  w->o->size += n;
  return at;
}

static void lay_out(pl_run* run) {
  pl_extended* w = run->extended;
  int n_q = run->n_q, n_c = run->n_c;
  int* one[] = {&w->t_0, &w->from, &w->to, &w->share, &w->energy_base};
  int *of_q[] = {&w->a_0, &w->end_a, &w->tail_q, &w->tail_v, &w->tail_a},
      *of_c[] = {&w->l_0, &w->end_l, &w->tail_l};
  for (size_t i = 0; i < sizeof one / sizeof *one; i++) *one[i] = take(w, 1);
  for (size_t i = 0; i < sizeof of_q / sizeof *of_q; i++) *of_q[i] = take(w, n_q);
  for (size_t i = 0; i < sizeof of_c / sizeof *of_c; i++) *of_c[i] = take(w, n_c);
  w->q_0 = take(w, 2 * n_q);
  w->v_0 = take(w, 2 * n_q);
  w->scratch = take(w, n_q + 4);
}

static void fill_memory(pl_extended* w) {
  const pl_step_program* o = w->o;
  const pl_real* real = w->fine;
  void* m = w->m;
  const double one = 1;
  memset(m, 0, (size_t)o->size * real->size);
  real->ratios(m, o->ratio, o->rest, o->orders + 2);
  real->write(m, o->time + 1, 1, &one);
  for (int i = 0; i < o->scales.n; i++) {
    const pl_scale_cell* s = &o->scales.at[i];
    if (s->from >= 0) real->move(m, s->cell, s->from, 1);
    else real->write(m, s->cell, 1, &s->x);
  }
  for (int i = 0; i < o->constants.n; i++)
    real->set(m, o->constants.at[i].cell, o->constants.at[i].x);
}

static void choose_types(pl_run* run) {
  pl_extended* w = run->extended;
  bool quad = run->options.precision == PL_PRECISION_QUAD;
  w->fine = quad || pl_real_pair() == NULL ? pl_real_quad() : pl_real_pair();
  w->state = quad ? pl_real_quad() : pl_real_long();
  w->low = run->order;
  w->by_doubles = !quad && run->order > LOW_ORDERS;
  if (w->by_doubles) w->low = LOW_ORDERS;
  w->floor = 2 * w->state->epsilon;
}

pleuel_status pl_extended_make(pl_run* run) {
  pl_extended* w = run->extended = PL_NEW(run->job->arena, pl_extended);
  const pl_setup* s = run->setup;
  choose_types(run);
  w->o = pl_step_program_make_for(run, w->fine);
  if (!w->o->usable)
    return pl_fail(
        run->job, PLEUEL_UNSUPPORTED,
        "precision %s: the mass matrix of this model needs pivots, which are chosen in double only",
        pl_extended_name(run));
  run->taylor->program = w->by_doubles ? pl_step_program_for_mode(run) : NULL;
  if (run->taylor->program && !run->taylor->program->usable) {
    run->taylor->program = NULL;
    w->by_doubles = false;
    w->low = run->order;
  }
  w->high = run->taylor->program;
  lay_out(run);
  write_sums(run);
  write_clock(run);
  write_drift(run);
  w->m = PL_ARRAY(run->job->arena, char, ((size_t)w->o->size + 8) * w->fine->size);
  fill_memory(w);
  w->rows = pl_sheet_make(run, w->state, &run->observers, s->n_out);
  w->watched = pl_sheet_make(run, w->fine, &run->watched, s->n_watched);
  return PLEUEL_OK;
}

// -------------------------------------------------------------------- rows that follow from others
bool pl_extended_of_mode(pl_run* run) {
  pl_extended* first = run->extended;
  for (pl_extended* w = first; w; w = w->next)
    if (memcmp(w->o->taken, run->dae.taken, (size_t)run->n_c * sizeof(bool)) == 0) {
      // to the front, where it is at work
      for (pl_extended** at = &first; *at; at = &(*at)->next)
        if (*at == w) {
          *at = w->next;
          break;
        }
      w->next = first;
      run->extended = w;
      run->taylor->program = w->high;
      return true;
    }
  bool made = pl_extended_make(run) == PLEUEL_OK;
  if (made) {
    run->extended->next = first;
    run->extended->way = first->way;
    run->extended->held = first->held;
  } else {
    run->extended = first;
    run->job->message[0] = '\0';
    run->job->status = PLEUEL_OK;
  }
  return made;
}

// What a point is, from the memory of one mode to that of another, whose pivots are known from here
// on.
static void take_over(pl_extended* to, const pl_extended* from, int n_q) {
  const int cells[][3] = {{to->o->time, from->o->time, 1},
                          {to->from, from->from, 1},
                          {to->to, from->to, 1},
                          {to->share, from->share, 1},
                          {to->energy_base, from->energy_base, 1},
                          {to->o->Q, from->o->Q, n_q},
                          {to->o->V, from->o->V, n_q}};
  fill_memory(to);  // as a run has it that comes here for the first time
  for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
    pl_extended_copy(to->fine, to->m, cells[i][0], from->fine, from->m, cells[i][1], cells[i][2]);
  to->o->fade_best = 0;
  for (int u = 0; u < to->o->n; u++) to->o->size_most[u] = 0;
}

void pl_extended_change_rows(pl_run* run) {
  pl_extended* from = run->extended;
  size_t n = (size_t)run->n_c * sizeof(bool);
  bool* before = from->o->taken;
  int rank = run->dae.rank;
  double smallest = run->dae.smallest, best = run->dae.best;
  pl_point_evaluate(&run->dae, run->dae.t, run->dae.q, run->dae.v);
  pl_active_set_choose(&run->dae);
  bool other = run->dae.rank == rank && memcmp(before, run->dae.taken, n) != 0
               && pl_extended_of_mode(run);
  if (!other) {
    memcpy(run->dae.taken, before, n);
    run->dae.rank = rank;
    run->dae.smallest = smallest;
    run->dae.best = best;
    return;
  }
  take_over(run->extended, from, run->n_q);
}
