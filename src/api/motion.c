// What a run has to say for itself: events with their states, how far it came, how exact it
// stayed. In words and as JSON.
#include <math.h>
#include <string.h>

#include "api/api_impl.h"

// ------------------------------------------------------------------------------------------- words
typedef struct pl_teller {
  pl_text* out;
  const pleuel_model* m;
  pl_arena* arena;
  pl_language lang;
  bool ascii;
  pl_notation notation;
} pl_teller;

static const char* say(const pl_teller* t, const char* en, const char* de) {
  const char* words = t->lang == PL_GERMAN ? de : en;
  return t->ascii ? pl_ascii_of(t->arena, words) : words;
}

static const char* number(const pl_teller* t, double x, int digits) {
  return pl_notation_number(t->arena, x, digits, t->notation);
}

// The name of a coordinate as it is displayed: ϑ, x[3].
static const char* coordinate_name(const pl_teller* t, int i) {
  const pl_recording* r = t->m->recording;
  const pl_pool* p = t->m->model->pool;
  if (t->ascii || i >= r->flat.n || pl_kind_of(p, r->flat.at[i]) != PL_SYMBOL)
    return r->setup.coordinates[i].name;
  return pl_symbol_get(p, pl_symbol_of(p, r->flat.at[i]))->name;
}

enum { MOST_COORDINATES = 8, DIGITS = 6 };  // of a state shown on one line

// r = 20 m, ϑ = 48.1975°
static void add_state(pl_teller* t, const double* row) {
  const pl_setup* s = &t->m->recording->setup;
  int shown = 0, column = 1;
  double most = 0;  // what is rounding beside it is shown as zero
  for (int i = 0, k = 1; i < t->m->recording->flat.n; i++)
    if (!s->coordinates[i].hidden) most = fmax(most, fabs(row[k++]));
  for (int i = 0; i < t->m->recording->flat.n && shown < MOST_COORDINATES; i++) {
    const pl_coordinate* q = &s->coordinates[i];
    if (q->hidden) continue;
    bool angle = q->unit && strcmp(q->unit, "rad") == 0;
    double x = fabs(row[column]) < 1e-14 * most ? 0
               : angle                          ? row[column] * (180 / M_PI)
                                                : row[column];
    const char* unit = angle                 ? (t->ascii ? " deg" : "°")
                       : q->unit && *q->unit ? pl_format(t->arena, " %s", q->unit)
                                             : "";
    pl_text_addf(t->out, "%s%s = %s%s", shown ? ", " : "   ", coordinate_name(t, i),
                 number(t, x, DIGITS), unit);
    column++;
    shown++;
  }
}

static const char* event_words(const pl_teller* t, const pl_result_event* e) {
  const char* label = e->label ? e->label : "";
  switch (e->kind) {
    case PL_EV_RELEASE:
      if (e->at_start)
        return pl_format(
            t->arena, say(t, PL_BOTH("%s lets go at once: its force would have to pull")), label);
      return pl_format(t->arena, say(t, PL_BOTH("%s lets go")), label);
    case PL_EV_IMPACT: return pl_format(t->arena, say(t, PL_BOTH("impact on %s")), label);
    case PL_EV_SLACK: return pl_format(t->arena, say(t, PL_BOTH("%s goes slack")), label);
    case PL_EV_TAUT:
      if (e->bounces) break;
      return pl_format(
          t->arena,
          e->jump ? say(t, PL_BOTH("%s goes taut with a jerk")) : say(t, PL_BOTH("%s goes taut")),
          label);
    case PL_EV_STICK: return pl_format(t->arena, say(t, PL_BOTH("%s sticks")), label);
    case PL_EV_SLIP: return pl_format(t->arena, say(t, PL_BOTH("%s slips")), label);
    case PL_EV_CONTACT:
      if (e->bounces) break;
      return pl_format(t->arena, say(t, PL_BOTH("contact with %s")), label);
    case PL_EV_SINGULAR: return say(t, PL_BOTH("singular position"));
    case PL_EV_STOP: return pl_format(t->arena, say(t, PL_BOTH("%s: stop")), label);
    case PL_EV_EVENT: break;
  }
  if (e->bounces)
    return pl_format(
        t->arena,
        say(t, PL_BOTH("%s at rest after endless bounces (%ld followed, the rest summed)")), label,
        e->bounces);
  return label;
}

enum { MOST_EVENTS = 40 };  // in words; JSON has all

static void tell_events(pl_teller* t) {
  const pl_result* r = t->m->result;
  int widest = 0;
  for (int i = 0; i < r->events.n && i < MOST_EVENTS; i++) {
    int width = pl_utf8_width(event_words(t, &r->events.at[i]));
    if (width > widest) widest = width;
  }
  const char* unit = t->m->model->uses_units ? " s" : "";
  for (int i = 0; i < r->events.n && i < MOST_EVENTS; i++) {
    const pl_result_event* e = &r->events.at[i];
    const char* when = pl_format(t->arena, "t = %s%s", number(t, e->t, DIGITS), unit);
    const char* what = event_words(t, e);
    pl_text_addf(t->out, "     %s", when);
    pl_text_pad(t->out, 16 - pl_utf8_width(when));
    pl_text_addf(t->out, "  %s", what);
    if (e->after) pl_text_pad(t->out, widest - pl_utf8_width(what));
    if (e->after) add_state(t, e->after);
    pl_text_add(t->out, "\n");
  }
  if (r->events.n > MOST_EVENTS) {
    pl_text_addf(t->out, say(t, PL_BOTH("     and %d more events\n")), r->events.n - MOST_EVENTS);
  }
}

static const char* precision_word(const pl_stats* s) {
  static const char* const word[] = {
      [PL_PRECISION_DOUBLE] = "double", [PL_PRECISION_LONG] = "long", [PL_PRECISION_QUAD] = "quad"};
  return word[s->precision];
}

// Which method took how many steps.
static void tell_steps(pl_teller* t, const pl_stats* s) {
  if (s->steps_implicit < s->steps || s->steps == 0) {
    pl_text_addf(t->out, say(t, PL_BOTH("     %ld steps of order %d")),
                 s->steps - s->steps_implicit, s->order);
  }
  if (s->precision == PL_PRECISION_LONG) pl_text_add(t->out, say(t, PL_BOTH(" in 80-bit numbers")));
  if (s->precision == PL_PRECISION_QUAD)
    pl_text_add(t->out, say(t, PL_BOTH(" in 128-bit numbers")));
  if (s->steps_implicit == 0) return;
  const char* unit = t->m->model->uses_units ? " s" : "";
  if (s->steps_implicit == s->steps) {
    pl_text_addf(t->out, say(t, PL_BOTH("     %ld implicit steps of order %d (Radau IIA)")),
                 s->steps, s->order_implicit);
  } else {
    pl_text_addf(
        t->out,
        say(t, PL_BOTH("; stiff from t = %s%s, %ld implicit steps of order %d (Radau IIA)")),
        number(t, s->t_implicit, 3), unit, s->steps_implicit, s->order_implicit);
  }
}

static void tell_accuracy(pl_teller* t) {
  const pl_result* r = t->m->result;
  const pl_stats* s = &r->stats;
  tell_steps(t, s);
  if (t->m->recording->setup.n_c > 0)
    pl_text_addf(t->out, say(t, PL_BOTH(", constraints kept to %s")), number(t, s->max_g, 2));
  if (t->m->recording->setup.energy_conserved && !isnan(s->energy_drift)) {
    pl_text_addf(t->out, say(t, PL_BOTH(", energy to %s")), number(t, s->energy_drift, 2));
  }
  pl_text_add(t->out, "\n");
  if (t->m->tol_raised) {
    pl_text_addf(
        t->out,
        say(t,
            PL_BOTH("     the tolerance was raised to %s, which is what the arithmetic can do\n")),
        number(t, t->m->tol_used, 2));
  }
  if (t->m->start.largest_move > 0) {
    pl_text_addf(
        t->out,
        say(t,
            PL_BOTH(
                "     given start values were moved by %s (relative) to meet the constraints\n")),
        number(t, t->m->start.largest_move, 2));
  }
}

// Why it ended early, and how it goes on.
static void tell_stop(pl_teller* t, bool started) {
  const pleuel_model* m = t->m;
  if (m->run == PLEUEL_OK || !m->run_message[0]) return;
  pl_text_addf(t->out,
               started ? say(t, PL_BOTH("     stopped there: %s\n"))
                       : say(t, PL_BOTH("  not simulated: %s\n")),
               m->run_message);
  if (m->run != PLEUEL_INTERRUPTED || m->state == NULL) return;
  if (m->kept == PL_KEPT_FAILED)
    pl_text_addf(t->out, say(t, PL_BOTH("     its state could not be kept in %s: %s\n")), m->state,
                 m->kept_why);
  if (m->kept != PL_KEPT_YES) return;
  if (m->resume_command)
    pl_text_addf(t->out, say(t, PL_BOTH("     to go on:  %s\n")), m->resume_command);
  else pl_text_addf(t->out, say(t, PL_BOTH("     its state is kept in %s\n")), m->state);
}

// Columns of multipliers that hold no number for some time: redundant constraints, or more contacts
// and frictions than equations.
static void tell_undetermined(pl_teller* t) {
  enum { SHOWN = 6 };
  const char *list = t->m->result->stats.undetermined, *end = list;
  if (list == NULL) return;
  int more = 0, n = 1;
  for (const char* c = list; *c; c++) {
    if (*c == ',' && n++ >= SHOWN) more++;
    if (more == 0) end = c + 1;
  }
  pl_text_addf(t->out, say(t, PL_BOTH("     several forces fit, so some are not determined: %.*s")),
               (int)(end - list), list);
  if (more > 0) pl_text_addf(t->out, say(t, PL_BOTH(" and %d more")), more);
  pl_text_add(t->out, "\n");
}

void pl_engine_text(pl_text* out, const pleuel_model* m, pl_language lang) {
  pl_teller t = {out, m, m->work, lang, false, {PL_MATH_LINE, lang}};
  if (!m->result) return;
  const pl_stats* s = &m->result->stats;
  if (!isnan(m->resumed_at)) {
    const char* unit = m->model->uses_units ? " s" : "";
    pl_text_addf(out, say(&t, PL_BOTH("     went on from t = %s%s\n")),
                 number(&t, m->resumed_at, DIGITS), unit);
  }
  if (!s->compiled) {
    pl_text_addf(out, say(&t, PL_BOTH("     %ld steps, interpreted")), s->steps);
    if (s->why_interpreted) pl_text_addf(out, ": %s", s->why_interpreted);
    pl_text_add(out, "\n");
    return;
  }
  pl_text_addf(
      out,
      say(&t, PL_BOTH("     %ld steps, %ld of them interpreted, the others compiled (%s ms%s)\n")),
      s->steps, s->steps_interpreted, number(&t, 1e3 * s->compile_s, 2),
      s->stored ? say(&t, PL_BOTH(", from disk")) : "");
}

void pl_motion_text(pl_text* out, const pleuel_model* m, pl_language lang, bool ascii,
                    bool events_only) {
  pl_teller t = {out, m, m->work, lang, ascii, {ascii ? PL_MATH_ASCII : PL_MATH_LINE, lang}};
  const pl_result* r = m->result;
  if (!r) {
    if (m->run_message[0])
      pl_text_addf(out, say(&t, PL_BOTH("  not simulated: %s\n")), m->run_message);
    return;
  }
  const char* unit = m->model->uses_units ? " s" : "";
  bool started = r->rows.n > 0;
  double end = started ? r->rows.at[r->rows.n - 1][0] : m->recording->t_0;
  if (started) {
    pl_text_addf(out, say(&t, PL_BOTH("  simulated from t = %s to %s%s\n")),
                 number(&t, m->recording->t_0, DIGITS), number(&t, end, DIGITS), unit);
    tell_events(&t);
    if (!events_only) tell_accuracy(&t);
    if (!events_only) tell_undetermined(&t);
    pl_certified_text(out, m, lang, ascii);
  }
  tell_stop(&t, started);
}

// -------------------------------------------------------------------------------------------- JSON
// A number of an event: with all its digits where it has more than a double.
static void json_digits(pl_json* j, const char* key, double x, const char* digits) {
  if (digits && isfinite(x)) pl_json_raw(j, key, digits);
  else pl_json_number(j, key, x);
}

static void json_columns(pl_json* j, const char* key, const pl_result* r, const double* row,
                         const char* const* digits, int from, int to) {
  pl_json_object(j, key);
  pl_json_flat(j);
  for (int i = from; i < to; i++)
    json_digits(j, r->columns[i].name, row[i], digits ? digits[i] : NULL);
  pl_json_end_object(j);
}

static int count_shown(const pl_setup* s) {
  int n = 0;
  for (int i = 0; i < s->n_q; i++) n += !s->coordinates[i].hidden;
  return n;
}

static void json_event(pl_json* j, const pleuel_model* m, const pl_result_event* e) {
  const pl_result* r = m->result;
  int state = 1 + 2 * count_shown(&m->recording->setup);
  bool of_constraint = e->kind != PL_EV_EVENT && e->kind != PL_EV_STOP && e->kind != PL_EV_SINGULAR;
  pl_json_object(j, NULL);
  pl_json_string(j, "label", e->label);
  pl_json_string(j, "kind", pl_event_kind_name[e->kind]);
  pl_json_string(j, "of", of_constraint ? e->label : NULL);
  json_digits(j, "t", e->t, e->digits ? e->digits[0] : NULL);
  if (e->at_start) pl_json_bool(j, "at_start", true);
  const double* row = e->after ? e->after : e->before;
  if (row) {
    json_columns(j, "state", r, row, e->after ? e->digits : NULL, 1, state);
    json_columns(j, "values", r, row, e->after ? e->digits : NULL, state, r->n_columns);
  }
  if (e->bounces) pl_json_int(j, "bounces", e->bounces);
  if (e->kind == PL_EV_IMPACT || e->jump) {
    if (of_constraint) pl_json_number(j, "impulse", e->impulse);
    if (e->before) json_columns(j, "before", r, e->before, NULL, 1, state);
    if (e->after) json_columns(j, "after", r, e->after, e->digits, 1, state);
  }
  pl_json_end_object(j);
}

// "a, b" as a list.
static void json_names(pl_arena* a, pl_json* j, const char* key, const char* names) {
  pl_json_list(j, key);
  for (const char* at = names; *at;) {
    size_t n = strcspn(at, ",");
    pl_json_string(j, NULL, pl_copy_n(a, at, n));
    at += n;
    at += strspn(at, ", ");
  }
  pl_json_end_list(j);
}

void pl_motion_json(pl_text* out, const pleuel_model* m) {
  const pl_result* r = m->result;
  const pl_stats none = {.max_g = NAN, .max_gdot = NAN, .energy_drift = NAN};
  const pl_stats* s = r ? &r->stats : &none;
  pl_json j = pl_json_make(out);
  pl_json_object(&j, NULL);
  pl_json_int(&j, "pleuel", 1);
  pl_json_string(&j, "file", m->name);
  pl_json_number(&j, "t_end", r && r->rows.n ? r->rows.at[r->rows.n - 1][0] : (double)NAN);
  pl_json_int(&j, "steps", s->steps);
  pl_json_string(&j, "status", pl_status_word(m->is_run ? m->run : m->checked));
  if (m->run_message[0]) pl_json_string(&j, "message", m->run_message);
  if (m->is_run && m->run == PLEUEL_INTERRUPTED && m->kept == PL_KEPT_YES) {
    pl_json_object(&j, "resume");
    pl_json_string(&j, "state", m->state);
    pl_json_string(&j, "command", m->resume_command);
    pl_json_end_object(&j);
  }
  bool implicit = s->steps_implicit > 0, both = implicit && s->steps_implicit < s->steps;
  pl_json_string(&j, "method", both ? "taylor, radau" : implicit ? "radau" : "taylor");
  pl_json_string(&j, "precision", precision_word(s));
  pl_json_int(&j, "order", implicit && !both ? s->order_implicit : s->order);
  if (both) {
    pl_json_int(&j, "steps_implicit", s->steps_implicit);
    pl_json_int(&j, "order_implicit", s->order_implicit);
    pl_json_number(&j, "t_implicit", s->t_implicit);
  }
  pl_json_number(&j, "residual_g", s->max_g);
  pl_json_number(&j, "residual_gdot", s->max_gdot);
  pl_json_number(
      &j, "energy_drift",
      m->recording && m->recording->setup.energy_conserved ? s->energy_drift : (double)NAN);
  if (s->undetermined) json_names(m->work, &j, "undetermined", s->undetermined);
  pl_json_list(&j, "events");
  for (int i = 0; r && i < r->events.n; i++) json_event(&j, m, &r->events.at[i]);
  pl_json_end_list(&j);
  pl_certified_json(&j, m);
  pl_json_list(&j, "notes");
  for (int i = 0; i < m->diagnostics.list.n; i++) {
    const pl_diagnostic* d = &m->diagnostics.list.at[i];
    pl_place at = d->span.source ? pl_span_place(d->span) : (pl_place){0, 0};
    static const char* const severity[] = {"error", "warning", "note"};
    pl_json_object(&j, NULL);
    pl_json_flat(&j);
    pl_json_string(&j, "code", pl_code_name(d->code));
    pl_json_string(&j, "severity", severity[pl_code_severity(d->code)]);
    pl_json_int(&j, "line", at.line);
    pl_json_int(&j, "col", at.column);
    pl_json_string(&j, "text", d->sentence[m->job.lang]);
    pl_json_string(&j, "fix", d->fix[m->job.lang]);
    pl_json_end_object(&j);
  }
  pl_json_end_list(&j);
  pl_json_end_object(&j);
}
