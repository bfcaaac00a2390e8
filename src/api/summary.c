// What `check` says when nothing is wrong: freedoms, and whether the start is consistent.
#include <math.h>

#include "api/api_impl.h"

static const char* plural(int n, const char* one, const char* many) { return n == 1 ? one : many; }

static void tell_freedoms(pl_text* out, const pleuel_model* m, pl_language lang) {
  const pl_dof* f = &m->solution->dof;
  bool de = lang == PL_GERMAN;
  pl_text_addf(out, "%d %s, %d %s", f->coordinates,
               de ? plural(f->coordinates, PL_BOTH("Koordinate"))
                  : plural(f->coordinates, "coordinate", "coordinates"),
               f->constraints,
               de ? plural(f->constraints, PL_BOTH("Zwangsbedingung"))
                  : plural(f->constraints, "constraint", "constraints"));
  int hidden = m->solution->hidden.n;
  if (f->rank < f->constraints)
    pl_text_addf(out, de ? pl_german(", %d of them independent") : ", %d of them independent",
                 f->rank);
  if (f->open > 0)
    pl_text_addf(out, de ? pl_german(", %d %s open") : ", %d %s open", f->open,
                 de ? plural(f->open, PL_BOTH("Kontakt")) : plural(f->open, "contact", "contacts"));
  if (hidden > 0) pl_text_addf(out, de ? pl_german(", %d hidden") : ", %d hidden", hidden);
  pl_text_addf(out, ", %d %s", f->dof,
               de ? plural(f->dof, PL_BOTH("Freiheitsgrad"))
                  : plural(f->dof, "degree of freedom", "degrees of freedom"));
  if (f->velocity_dof != f->dof)
    pl_text_addf(out, de ? pl_german(" (%d of the velocity)") : " (%d of the velocity)",
                 f->velocity_dof);
}

// Positions and velocities that the constraints settled.
static void tell_start(pl_text* out, const pleuel_model* m, pl_language lang) {
  const pl_setup* s = &m->recording->setup;
  int shown = 0;
  for (int i = 0; i < m->start.n_moves && shown < 12; i++) {
    const pl_start_move* move = &m->start.moves[i];
    if (move->given || move->to == 0) continue;
    const pl_coordinate* q = &s->coordinates[move->coordinate];
    const char* unit = move->velocity ? q->v_unit : q->unit;
    pl_text_addf(out, "%s%s = %.6g%s%s",
                 shown++             ? ", "
                 : lang == PL_GERMAN ? pl_german("the constraints give ")
                                     : "the constraints give ",
                 move->velocity ? q->v_name : q->name, move->to, unit && *unit ? " " : "",
                 unit ? unit : "");
  }
  if (shown) pl_text_add(out, "\n");
}

void pl_check_summary(pl_text* out, const pleuel_model* m, pl_language lang) {
  bool de = lang == PL_GERMAN;
  pl_text_addf(out, "%s: ", m->name);
  if (m->solution) tell_freedoms(out, m, lang);
  else pl_text_add(out, de ? pl_german("no errors in the text") : "no errors in the text");
  if (m->result) {
    pl_text_add(out, de ? pl_german("; the start is consistent\n") : "; the start is consistent\n");
    tell_start(out, m, lang);
  } else {
    pl_text_add(out, "\n");
    if (m->run_message[0])
      pl_text_addf(
          out,
          de ? pl_german("the start was not looked at: %s\n") : "the start was not looked at: %s\n",
          m->run_message);
  }
}
