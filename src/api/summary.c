// What `check` says when nothing is wrong: freedoms, and whether the start is consistent.
#include <math.h>

#include "api/api_impl.h"

static const char* plural(int n, const char* one, const char* many) { return n == 1 ? one : many; }

static void tell_freedoms(pl_text* out, const pleuel_model* m, pl_language lang) {
  const pl_setup* s = &m->recording->setup;
  int n_q = s->n_q - m->recording->n_hidden, n_c = m->recording->n_declared;
  pl_text_addf(out, lang == PL_GERMAN ? "%d %s, %d %s" : "%d %s, %d %s", n_q,
               lang == PL_GERMAN ? plural(n_q, "Koordinate", "Koordinaten") : plural(n_q, "coordinate", "coordinates"), n_c,
               lang == PL_GERMAN ? plural(n_c, "Zwangsbedingung", "Zwangsbedingungen") : plural(n_c, "constraint", "constraints"));
  if (!m->result) return;
  int dof = s->n_q - m->result->stats.rank_start;
  pl_text_addf(out, lang == PL_GERMAN ? ", %d %s beim Start" : ", %d %s at the start", dof,
               lang == PL_GERMAN ? plural(dof, "Freiheitsgrad", "Freiheitsgrade") : plural(dof, "degree of freedom", "degrees of freedom"));
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
    pl_text_addf(out, "%s%s = %.6g%s%s", shown++ ? ", " : lang == PL_GERMAN ? "Aus den Zwangsbedingungen folgt " : "the constraints give ",
                 move->velocity ? q->v_name : q->name, move->to, unit && *unit ? " " : "", unit ? unit : "");
  }
  if (shown) pl_text_add(out, "\n");
}

void pl_check_summary(pl_text* out, const pleuel_model* m, pl_language lang) {
  pl_text_addf(out, "%s: ", m->name);
  if (!m->recording) {
    pl_text_add(out, lang == PL_GERMAN ? "keine Fehler im Text\n" : "no errors in the text\n");
    return;
  }
  tell_freedoms(out, m, lang);
  if (!m->result) {
    pl_text_addf(out, lang == PL_GERMAN ? "\nDer Start wurde nicht geprüft: %s\n" : "\nthe start was not looked at: %s\n", m->run_message);
    return;
  }
  pl_text_add(out, lang == PL_GERMAN ? "; der Start ist widerspruchsfrei\n" : "; the start is consistent\n");
  tell_start(out, m, lang);
}
