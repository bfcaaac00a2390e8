// What is said of a certified run: in words, and as JSON.
#include <math.h>
#include <stdlib.h>

#include "api/certified_impl.h"

typedef struct teller {
  pl_text* out;
  const pleuel_model* m;
  const pl_certificate_of_run* c;
  pl_arena* arena;
  pl_language lang;
  bool ascii;
  pl_notation notation;
} teller;

static const char* say(const teller* t, const char* sentence) {
  const char* s = pl_in_language(t->lang, sentence);
  return t->ascii ? pl_ascii_of(t->arena, s) : s;
}

static const char* number(const teller* t, double x, int digits) {
  return pl_notation_number(t->arena, x, digits, t->notation);
}

// A bound is rounded up.
static const char* bound(const teller* t, double x) {
  if (!(x > 0) || isinf(x)) return number(t, x, 2);
  double unit = pow(10, floor(log10(x)) - 1);
  return number(t, fmax(ceil(x / unit) * unit, x), 2);
}

// ----------------------------------------------------------------------------------------- reasons
static const char* const refusal_words[PL_N_REFUSALS] = {
    [PL_REFUSED_RUN] = PL_KEY("the run did not reach its end"),
    [PL_REFUSED_FRICTION] = PL_KEY("there is friction on %s, which is not certified"),
    [PL_REFUSED_EVENT] =
        PL_KEY("the event %s may change the motion in a way that is not certified"),
    [PL_REFUSED_BACKWARD] = PL_KEY("contacts and events are certified forwards in time only"),
    [PL_REFUSED_TURN] = PL_KEY("bodies whose attitude is a quaternion are not certified"),
    [PL_REFUSED_SENSITIVITIES] = PL_KEY("sensitivities are not certified"),
    [PL_REFUSED_ROWS] = PL_KEY("there are too many rows"),
};

static const char* const end_words[PL_N_CERTIFY_ENDS] = {
    [PL_CERTIFY_TOO_LARGE] = PL_KEY("the system is too large"),
    [PL_CERTIFY_NO_EXACT] = PL_KEY("%s has no exact value"),
    [PL_CERTIFY_REDUNDANT] =
        PL_KEY("constraints may depend on each other, and that they do is not proved"),
    [PL_CERTIFY_START] = PL_KEY("that a start exists near that of the run is not proved"),
    [PL_CERTIFY_ELSEWHERE] = PL_KEY("the exact start is not that of the run"),
    [PL_CERTIFY_STEP] = PL_KEY(
        "no further step could be proved: the position is nearly singular, or a "
        "function is at the end of its domain or at a kink"),
    [PL_CERTIFY_BUDGET] = PL_KEY("the work that is allowed is used up"),
    [PL_CERTIFY_WIDE] = PL_KEY("the precision that is allowed does not suffice"),
    [PL_CERTIFY_INTERRUPTED] = PL_KEY("interrupted"),
    [PL_CERTIFY_WATCH] = PL_KEY("the event %s speaks of forces or accelerations"),
    [PL_CERTIFY_IMPACT] = PL_KEY("%s is met there, and impacts are not certified"),
    [PL_CERTIFY_UNDECIDED] =
        PL_KEY("a contact or event is grazed there, or several come at one time"),
};

// ORDER REFUSALS, ORDER ENDS: words of the JSON document.
static const char* const refusal_names[PL_N_REFUSALS] = {
    NULL, "run", "friction", "event", "backward", "attitude", "sensitivities", "rows"};
static const char* const end_names[PL_N_CERTIFY_ENDS] = {
    NULL,     "size",  "number",      "redundant", "start",  "elsewhere", "step",
    "budget", "width", "interrupted", "watch",     "impact", "undecided"};

static const char* reason(const teller* t) {
  const pl_certificate_of_run* c = t->c;
  if (c->refusal != PL_CERTIFY_TRIED)
    return pl_format(t->arena, say(t, refusal_words[c->refusal]),
                     c->refused_name ? c->refused_name : "");
  if (c->proof.end == PL_CERTIFIED) return "";
  return pl_format(t->arena, say(t, end_words[c->proof.end]), c->proof.what ? c->proof.what : "?");
}

// ---------------------------------------------------------------------------------------- one time
typedef struct extremes {
  double radius, error, least;
  int worst;  // value with the largest error, -1 none
} extremes;

static extremes extremes_of(const pl_certificate_of_run* c, int time, int from, int to) {
  extremes e = {0, 0, 0, -1};
  const pl_certified_value* v = c->value + (size_t)time * (size_t)(2 * c->n_q + c->n_c);
  for (int i = from; i < to; i++) {
    if (!v[i].text) continue;
    e.radius = fmax(e.radius, v[i].radius);
    if (!(v[i].error >= e.error)) continue;
    e.error = v[i].error;
    e.least = v[i].least;
    e.worst = i;
  }
  return e;
}

static const char* name_of(const teller* t, int i) {
  const pl_setup* s = &t->m->recording->setup;
  if (i < s->n_q) return s->coordinates[i].name;
  if (i < 2 * s->n_q) return s->coordinates[i - s->n_q].v_name;
  return s->constraints[i - 2 * s->n_q].column;
}

static void tell_group(teller* t, int time, int from, int to, const char* what) {
  extremes e = extremes_of(t->c, time, from, to);
  if (e.worst < 0 && e.radius == 0) return;
  static const char* const within = PL_KEY("       %s: proved to within %s");
  static const char* const off = PL_KEY("; this run is off by %s (%s)\n");
  static const char* const at_most = PL_KEY("; this run is off by at most %s (%s)\n");
  pl_text_addf(t->out, say(t, within), say(t, what), bound(t, e.radius));
  if (e.worst < 0) pl_text_add(t->out, "\n");
  else
    pl_text_addf(t->out, say(t, e.least > 0 ? off : at_most), bound(t, e.error),
                 name_of(t, e.worst));
}

static void tell_time(teller* t, int time) {
  static const char* const head = PL_KEY("     certified at t = %s%s\n");
  static const char *const q = PL_KEY("coordinates"), *const v = PL_KEY("velocities"),
                           *const l = PL_KEY("multipliers");
  const pl_certificate_of_run* c = t->c;
  pl_text_addf(t->out, say(t, head), number(t, c->time[time], 12),
               t->m->model->uses_units ? " s" : "");
  tell_group(t, time, 0, c->n_q, q);
  tell_group(t, time, c->n_q, 2 * c->n_q, v);
  tell_group(t, time, 2 * c->n_q, 2 * c->n_q + c->n_c, l);
}

// --------------------------------------------------------------------------------------------- all
static void tell_start(teller* t) {
  const pl_certified* p = &t->c->proof;
  static const char* const pinned =
      PL_KEY("     nothing determines the start of %s: the number of the run was taken as exact\n");
  static const char* const moved = PL_KEY(
      "     the start given for %s contradicts the constraints by %s (relative) and was replaced "
      "by what follows from them\n");
  for (int i = 0; i < p->n_pinned; i++)
    pl_text_addf(t->out, say(t, pinned), name_of(t, p->pinned[i]));
  for (int i = 0; i < p->n_moved; i++)
    pl_text_addf(t->out, say(t, moved), name_of(t, p->moved_q[i]), bound(t, p->moved));
}

static const char* name_of_happening(const teller* t, int i) {
  const pl_happening* h = &t->c->proof.happened[i];
  bool named = h->kind == PL_HAPPENED_EVENT || h->kind == PL_HAPPENED_STOP;
  const pl_setup* s = &t->m->recording->setup;
  return named ? s->events[h->index].name : s->constraints[h->index].name;
}

static void tell_happenings(teller* t) {
  static const char* const what[] = {PL_KEY("%s lets go"), "%s", PL_KEY("%s: stop"),
                                     PL_KEY("%s is met")};
  static const char* const when = PL_KEY("     certified: %s at t = %s, proved to within %s");
  static const char* const off = PL_KEY("; this run is off by at most %s\n");
  for (int i = 0; i < t->c->proof.n_happened; i++) {
    const pl_certified_value* v = &t->c->happened[i];
    const char* words = pl_format(t->arena, say(t, what[t->c->proof.happened[i].kind]),
                                  name_of_happening(t, i));
    pl_text_addf(t->out, say(t, when), words, number(t, strtod(v->text, NULL), 12),
                 bound(t, v->radius));
    if (isnan(v->error)) pl_text_add(t->out, "\n");
    else pl_text_addf(t->out, say(t, off), bound(t, v->error));
  }
}

static void tell_how(teller* t) {
  const pl_certified* p = &t->c->proof;
  static const char* const how = PL_KEY(
      "       %ld proved steps of order up to %d in balls of %ld bits; the motion and the "
      "arithmetic widened them by %s bits\n");
  if (p->steps > 0)
    pl_text_addf(t->out, say(t, how), p->steps, p->order, p->bits,
                 number(t, fmax(p->bits_lost, 0), 3));
}

void pl_certified_text(pl_text* out, const pleuel_model* m, pl_language lang, bool ascii) {
  const pl_certificate_of_run* c = m->certified;
  if (!c) return;
  teller t = {out, m, c, m->work, lang, ascii, {ascii ? PL_MATH_ASCII : PL_MATH_LINE, lang}};
  static const char* const not_at_all = PL_KEY("     not certified: %s\n");
  static const char* const until =
      PL_KEY("     the motion exists until t = %s, beyond it nothing is certified: %s\n");
  static const char* const wide = PL_KEY("     the enclosure is wider than asked for: %s\n");
  int done = c->refusal == PL_CERTIFY_TRIED ? c->proof.n_done : 0;
  // all times are in the JSON document
  if (c->refusal == PL_CERTIFY_TRIED && (done > 0 || c->proof.n_happened > 0)) {
    tell_start(&t);
    tell_happenings(&t);
  }
  if (done > 0) {
    tell_time(&t, done - 1);
    tell_how(&t);
  }
  if (c->refusal == PL_CERTIFY_TRIED && c->proof.end == PL_CERTIFIED) return;
  if (done > 0 && done == c->n_times) pl_text_addf(out, say(&t, wide), reason(&t));
  else if (c->refusal == PL_CERTIFY_TRIED && !isnan(c->proof.t_reached))
    pl_text_addf(out, say(&t, until), number(&t, c->proof.t_reached, 6), reason(&t));
  else pl_text_addf(out, say(&t, not_at_all), reason(&t));
}

// -------------------------------------------------------------------------------------------- JSON
// A number with its radius; `error` only where there is one to compare with.
static void json_value(pl_json* j, const char* name, const pl_certified_value* v, bool compared) {
  pl_json_object(j, name);
  pl_json_flat(j);
  pl_json_string(j, "value", v->text);
  pl_json_number(j, "radius", v->radius);
  if (compared) pl_json_number(j, "error", v->error);
  pl_json_end_object(j);
}

static void json_rows(pl_json* j, const teller* t) {
  const pl_certificate_of_run* c = t->c;
  size_t width = (size_t)(2 * c->n_q + c->n_c);
  pl_json_list(j, "rows");
  for (int time = 0; c->value && time < c->proof.n_done; time++) {
    pl_json_object(j, NULL);
    pl_json_number(j, "t", c->time[time]);
    for (int i = 0; i < (int)width; i++)
      if (c->value[(size_t)time * width + (size_t)i].text && name_of(t, i))
        json_value(j, name_of(t, i), &c->value[(size_t)time * width + (size_t)i], true);
    pl_json_end_object(j);
  }
  pl_json_end_list(j);
}

static void json_names(pl_json* j, const char* key, const teller* t, const int* at, int n) {
  pl_json_list(j, key);
  pl_json_flat(j);
  for (int i = 0; i < n; i++) pl_json_string(j, NULL, name_of(t, at[i]));
  pl_json_end_list(j);
}

static void json_happenings(pl_json* j, const teller* t) {
  static const char* const kinds[] = {"release", "event", "stop", "impact"};
  pl_json_list(j, "events");
  for (int i = 0; t->c->happened && i < t->c->proof.n_happened; i++) {
    const pl_certified_value* v = &t->c->happened[i];
    pl_json_object(j, NULL);
    pl_json_string(j, "kind", kinds[t->c->proof.happened[i].kind]);
    pl_json_string(j, "label", name_of_happening(t, i));
    json_value(j, "t", v, true);
    pl_json_object(j, "state");
    for (int k = 0; k < 2 * t->c->n_q; k++)
      if (name_of(t, k))
        json_value(j, name_of(t, k), &t->c->state[(size_t)i * 2 * (size_t)t->c->n_q + (size_t)k],
                   false);
    pl_json_end_object(j);
    pl_json_end_object(j);
  }
  pl_json_end_list(j);
}

void pl_certified_json(pl_json* j, const pleuel_model* m) {
  const pl_certificate_of_run* c = m->certified;
  if (!c) return;
  teller t = {NULL, m, c, m->work, m->job.lang, false, {PL_MATH_LINE, m->job.lang}};
  const pl_certified* p = &c->proof;
  bool tried = c->refusal == PL_CERTIFY_TRIED, complete = tried && p->end == PL_CERTIFIED;
  pl_json_object(j, "certified");
  pl_json_bool(j, "complete", complete);
  if (!complete) {
    pl_json_string(j, "why", tried ? end_names[p->end] : refusal_names[c->refusal]);
    pl_json_string(j, "reason", reason(&t));
  }
  pl_json_number(j, "t_reached", tried ? p->t_reached : (double)NAN);
  pl_json_number(j, "width", tried ? p->width : (double)NAN);
  pl_json_int(j, "steps", p->steps);
  pl_json_int(j, "order", p->order);
  pl_json_int(j, "bits", p->bits);
  pl_json_number(j, "bits_lost", p->bits_lost);
  pl_json_int(j, "passes", p->passes);
  json_names(j, "start_taken_from_run", &t, p->pinned, p->n_pinned);
  json_names(j, "start_moved", &t, p->moved_q, p->n_moved);
  json_happenings(j, &t);
  json_rows(j, &t);
  pl_json_end_object(j);
}
