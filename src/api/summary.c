// What `check` says when nothing is wrong: freedoms, and whether the start is consistent.
#include <math.h>

#include "api/api_impl.h"

static const char* plural(int n, const char* one, const char* many) { return n == 1 ? one : many; }

static void tell_freedoms(pl_text* out, const pleuel_model* m, pl_language lang) {
  const pl_dof* f = &m->solution->dof;
  bool de = lang == PL_GERMAN;
  pl_text_addf(out, "%d %s, %d %s", f->coordinates,
               de ? plural(f->coordinates, "Koordinate", "Koordinaten")
                  : plural(f->coordinates, "coordinate", "coordinates"),
               f->constraints,
               de ? plural(f->constraints, "Zwangsbedingung", "Zwangsbedingungen")
                  : plural(f->constraints, "constraint", "constraints"));
  int hidden = m->solution->hidden.n;
  if (f->rank < f->constraints)
    pl_text_addf(out, de ? ", davon %d unabhängig" : ", %d of them independent", f->rank);
  if (f->open > 0)
    pl_text_addf(
        out, de ? ", %d %s offen" : ", %d %s open", f->open,
        de ? plural(f->open, "Kontakt", "Kontakte") : plural(f->open, "contact", "contacts"));
  if (hidden > 0) pl_text_addf(out, de ? ", %d verborgen" : ", %d hidden", hidden);
  pl_text_addf(out, ", %d %s", f->dof,
               de ? plural(f->dof, "Freiheitsgrad", "Freiheitsgrade")
                  : plural(f->dof, "degree of freedom", "degrees of freedom"));
  if (f->velocity_dof != f->dof)
    pl_text_addf(out, de ? " (%d der Geschwindigkeit)" : " (%d of the velocity)", f->velocity_dof);
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
                 : lang == PL_GERMAN ? "Aus den Zwangsbedingungen folgt "
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
  else pl_text_add(out, de ? "keine Fehler im Text" : "no errors in the text");
  if (m->result) {
    pl_text_add(out, de ? "; der Start ist widerspruchsfrei\n" : "; the start is consistent\n");
    tell_start(out, m, lang);
  } else {
    pl_text_add(out, "\n");
    if (m->run_message[0])
      pl_text_addf(out,
                   de ? "der Start wurde nicht geprüft: %s\n" : "the start was not looked at: %s\n",
                   m->run_message);
  }
}
