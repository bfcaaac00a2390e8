// Steps of the worked solution, handed over while it is made.
#include <string.h>

#include "api/editor.h"

typedef struct pl_relaying {
  pleuel_model* m;
  pleuel_solve_options options;
  int (*step)(void* user, const pleuel_step* step);
  void* user;
  pl_arena* scratch;
  int next;  // section that comes next
  bool stopped;
} pl_relaying;

static pleuel_step step_of(const pl_section* s, int i, pleuel_step_kind kind) {
  return (pleuel_step){.size = sizeof(pleuel_step),
                       .kind = kind,
                       .section = (size_t)i,
                       .letter = s->letter,
                       .item = s->item,
                       .span = s->ask ? pl_api_span(s->ask->span) : (pleuel_span){0}};
}

static void tell(pl_relaying* r, const pleuel_step* step) {
  if (!r->stopped) r->stopped = r->step(r->user, step) != 0;
}

static void tell_section(pl_relaying* r, const pl_solution* solution, int i) {
  static const pleuel_step_kind kinds[] = {[PL_STEP_TEXT] = PLEUEL_STEP_TEXT,
                                           [PL_STEP_EQUATION] = PLEUEL_STEP_EQUATION,
                                           [PL_STEP_ROW] = PLEUEL_STEP_ROW,
                                           [PL_STEP_HEADING] = PLEUEL_STEP_HEADING,
                                           [PL_STEP_NOTE] = PLEUEL_STEP_NOTE};
  const pl_section* s = &solution->sections.at[i];
  pl_language lang = pl_api_language_of(r->m, r->options.lang);
  pleuel_step head = step_of(s, i, PLEUEL_STEP_SECTION);
  head.text = s->title[lang] ? s->title[lang] : s->title[PL_ENGLISH];
  tell(r, &head);
  for (int k = 0; !r->stopped && k < s->steps.n; k++) {
    pl_mark mark = pl_arena_mark(r->scratch);
    const pl_step* one = &s->steps.at[k];
    pleuel_step out = step_of(s, i, kinds[one->kind]);
    pl_pool* pool = s->model ? s->model->pool : solution->model->pool;
    out.text = pl_worked_step(r->scratch, pool, one, lang, PL_MATH_LINE);
    out.tex = pl_worked_step(r->scratch, pool, one, lang, PL_MATH_TEX);
    out.number = one->number;
    out.detail = one->detail;
    tell(r, &out);
    pl_arena_rewind(r->scratch, mark);
  }
}

// Sections that are new since the last time.
static bool relay(void* user, const pl_solution* solution) {
  pl_relaying* r = user;
  for (; !r->stopped && r->next < solution->sections.n; r->next++)
    tell_section(r, solution, r->next);
  return !r->stopped;
}

static pleuel_status solve(pleuel_model* m, void* argument) {
  pl_relaying* r = argument;
  m->ready = relay;
  m->ready_user = r;
  pleuel_status s = pl_pipeline_derive(m, r->options.only, r->options.seconds,
                                       !r->options.no_simulation);
  m->ready = NULL;
  if (!m->solution) return s;
  relay(r, m->solution);
  for (int i = 0; s != PLEUEL_INTERRUPTED && !r->stopped && i < m->solution->sections.n; i++) {
    pleuel_step verdict = step_of(&m->solution->sections.at[i], i, PLEUEL_STEP_VERDICT);
    verdict.passed = !m->solution->sections.at[i].withdrawn;
    tell(r, &verdict);
  }
  return r->stopped ? pl_fail(&m->job, PLEUEL_INTERRUPTED, "the caller wants no more steps") : s;
}

static pleuel_status with_scratch(pleuel_model* m, pl_arena* a, void* argument) {
  pl_relaying* r = argument;
  r->scratch = a;
  return pl_api_guarded(m, solve, r);
}

pleuel_status pleuel_steps(pleuel_model* m, const pleuel_solve_options* options,
                           int (*step)(void* user, const pleuel_step* step), void* user) {
  if (!m || !step) return PLEUEL_USAGE;
  pl_relaying r = {.m = m, .step = step, .user = user};
  PL_TRY(pl_api_take(m->ctx, &r.options, sizeof r.options, options));
  pleuel_status s = pl_editor_answer(m, PL_ANSWER_STEPS, with_scratch, &r);
  return s;
}
