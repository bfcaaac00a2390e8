// What the step programs keep when a run is written down (checkpoint.c): which modes have one, and
// its memory at the point, whose last digits depend on the way that led there.
//
// clang-format off
// not kept of pl_step_program, follows from the mode: code next size orders n_q n_c n_mass n_taken
//   time ratio rest Q V A L q_floor v_floor g g_size argument r r_size norms length end_q end_v
//   end_a off energy h pivot pivot_size move vector result matrix identity of_constraint index
//   inverse_up_to constants scales
// not kept of pl_step_program, of this process: compiled jit tried
// clang-format on
#include <string.h>

#include "solve/stepper/taylor/step_program_impl.h"

static void keep_fixed(pl_keeper* k, int x) { pl_keep_int(k, &x, x, x); }

static bool same_program(const pl_run* run, const pl_step_program* o, const bool* taken,
                         const bool* moves) {
  if (memcmp(o->taken, taken, (size_t)run->n_c * sizeof(bool)) != 0) return false;
  for (int i = 0; i < run->n_q && o->of_coordinate; i++)
    if ((o->of_coordinate[i] >= 0) != moves[i]) return false;
  return true;
}

// Codes for a mode, as pl_step_program_make makes them where it begins; those that the start made
// already are taken over.
static pl_step_program* program_for(pl_run* run, pl_step_program* made, const bool* taken,
                                    const bool* moves) {
  for (pl_step_program* o = made; o; o = o->next)
    if (same_program(run, o, taken, moves)) return o;
  memcpy(run->dae.taken, taken, (size_t)run->n_c * sizeof(bool));
  for (int i = 0; i < run->n_q; i++) run->dae.has_equation[i] = moves[i];
  pl_step_program* o = pl_step_program_make(run);
  return same_program(run, o, taken, moves) ? o : NULL;
}

static void keep_program(pl_run* run, pl_keeper* k, pl_step_program* o, bool here) {
  keep_fixed(k, o->usable);
  if (!o->usable) return;
  keep_fixed(k, o->n);
  keep_fixed(k, o->size);
  pl_keep_f64s(k, o->size_most, (size_t)o->n);
  pl_keep_f64(k, &o->fade_best);
  if (here) pl_keep_bytes(k, o->m, (size_t)o->size * sizeof *o->m);
}

static int count_programs(const pl_run* run) {
  int n = 0;
  for (const pl_step_program* o = run->taylor->programs; o; o = o->next) n++;
  return n;
}

static void write_programs(pl_run* run, pl_keeper* k) {
  int n = count_programs(run);
  pl_keep_count(k, &n, 1);
  for (pl_step_program* o = run->taylor->programs; o; o = o->next) {
    bool at_work = o == run->taylor->program, here = at_work && run->dae.at_point;
    pl_keep_bool(k, &at_work);
    pl_keep_bool(k, &here);
    pl_keep_bools(k, o->taken, (size_t)run->n_c);
    for (int i = 0; i < run->n_q; i++) {
      bool moves = o->of_coordinate && o->of_coordinate[i] >= 0;
      pl_keep_bool(k, &moves);
    }
    keep_program(run, k, o, here);
  }
}

static void read_programs(pl_run* run, pl_keeper* k) {
  pl_step_program *made = run->taylor->programs, **last = &run->taylor->programs;
  bool *taken = PL_ARRAY(run->job->arena, bool, run->n_c + 1),
       *moves = PL_ARRAY(run->job->arena, bool, run->n_q + 1);
  int n = 0;
  pl_keep_count(k, &n, (size_t)run->n_c + (size_t)run->n_q + 2);
  run->taylor->programs = run->taylor->program = NULL;
  for (int i = 0; i < n; i++) {
    bool at_work = false, here = false;
    pl_keep_bool(k, &at_work);
    pl_keep_bool(k, &here);
    pl_keep_bools(k, taken, (size_t)run->n_c);
    pl_keep_bools(k, moves, (size_t)run->n_q);
    if (k->wrong) break;
    pl_step_program* o = program_for(run, made, taken, moves);
    if (o == NULL || (here && !o->usable)) {
      pl_keep_fail(k);
      break;
    }
    // one that was made at the start leaves that list
    for (pl_step_program** at = &made; *at; at = &(*at)->next)
      if (*at == o) {
        *at = o->next;
        break;
      }
    o->next = NULL;
    *last = o;
    last = &o->next;
    keep_program(run, k, o, here);
    if (at_work) run->taylor->program = o;
  }
  *last = made;  // so that they are freed with the others; a mode that comes later finds them
}

void pl_step_program_save(pl_run* run, pl_keeper* k) {
  pl_keep_section(k, "programs");
  if (k->reads) run->taylor->considered = 0;
  if (k->reads) read_programs(run, k);
  else write_programs(run, k);
}
