// Rows of a run on extended numbers: all columns with the digits of the state.
#include <math.h>

#include "solve/stepper/taylor/extended_impl.h"

static int column_text(void* user, pl_row_part part, int i, bool negative, char out[PL_ROW_TEXT]) {
  const pl_sheet* s = user;
  const int at[] = {[PL_ROW_T] = s->time,
                    [PL_ROW_Q] = s->Q,
                    [PL_ROW_V] = s->V,
                    [PL_ROW_LAMBDA] = s->L,
                    [PL_ROW_OUT] = s->out};
  return s->real->text(out, s->m, at[part] + i, negative);
}

static void fill(pl_run* run, int q, int v, int a, int l, pl_row* row, double* out) {
  pl_extended* w = run->extended;
  pl_sheet* s = w->rows;
  pl_extended_copy(s->real, s->m, s->time, w->fine, w->m, w->o->time, 1);
  pl_extended_copy(s->real, s->m, s->Q, w->fine, w->m, q, run->n_q);
  pl_extended_copy(s->real, s->m, s->V, w->fine, w->m, v, run->n_q);
  pl_extended_copy(s->real, s->m, s->A, w->fine, w->m, a, run->n_q);
  pl_extended_copy(s->real, s->m, s->L, w->fine, w->m, l, run->n_c);
  pl_sheet_run(s);
  s->real->read(s->m, s->out, run->setup->n_out, out);
  w->digits = (pl_row_digits){s, column_text};
  row->digits = &w->digits;
}

void pl_extended_row(pl_run* run, pl_row* row, double* out) {
  const pl_step_program* o = run->extended->o;
  fill(run, o->Q, o->V, o->A, o->L, row, out);
}

// n times the distance of rows, rounded once: each product of doubles is a sum of two.
static void multiply(pl_extended* w, double n) {
  pl_parts high = {{0}}, low = {{0}};
  for (int i = 0; i < 2; i++) {
    high.part[i] = n * w->way.part[i];
    low.part[i] = fma(n, w->way.part[i], -high.part[i]);
  }
  low.part[2] = n * w->way.part[2];
  w->fine->set(w->m, w->scratch + 1, (pl_parts){{high.part[1], low.part[1], low.part[2]}});
  w->fine->set(w->m, w->scratch, (pl_parts){{high.part[0], low.part[0], 0}});
  w->fine->add(w->m, w->scratch, w->scratch + 1, 1);
}

// The row at `length`, which stands there already.
static void row_of_series(pl_run* run, pl_row* row, double* out) {
  pl_extended* w = run->extended;
  const pl_step_program* o = w->o;
  pl_extended_sum(run);
  fill(run, o->end_q, o->end_v, w->end_a, w->end_l, row, out);
  w->fine->read(w->m, o->time, 1, &row->t);
  w->fine->read(w->m, o->end_q, run->n_q, run->control.row_q);
  w->fine->read(w->m, o->end_v, run->n_q, run->control.row_v);
  w->fine->read(w->m, w->end_a, run->n_q, run->control.row_a);
  w->fine->read(w->m, w->end_l, run->n_c, run->control.row_l);
}

void pl_extended_grid_row(pl_run* run, long n, pl_row* row, double* out) {
  pl_extended* w = run->extended;
  const pl_step_program* o = w->o;
  // the end of the step stands in `time` and `length`, and is needed there later
  pl_parts end = w->fine->get(w->m, o->time), length = w->fine->get(w->m, o->length);
  multiply(w, (double)n);
  w->fine->interpret(w->grid, w->m, 0, 1);
  row_of_series(run, row, out);
  w->fine->set(w->m, o->time, end);
  w->fine->set(w->m, o->length, length);
}

void pl_extended_row_at(pl_run* run, double t, pl_row* row, double* out) {
  pl_extended* w = run->extended;
  const pl_step_program* o = w->o;
  double dt = t - run->dae.t_series;
  pl_parts end = w->fine->get(w->m, o->time), length = w->fine->get(w->m, o->length);
  w->fine->write(w->m, o->length, 1, &dt);
  w->fine->interpret(w->clock, w->m, 0, 1);
  row_of_series(run, row, out);
  w->fine->set(w->m, o->time, end);
  w->fine->set(w->m, o->length, length);
}
