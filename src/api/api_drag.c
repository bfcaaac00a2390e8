// Dragging for programs: a point by its label, new start values, and the edits of the text that
// write them.
//
// Edits are tried before they are handed out: the edited text is read, its start is found and held
// against the wanted one.  First the numbers that stand in `init` are written anew, in few digits,
// then in all of them; then what nothing determined gets a line of its own; at last `guess` lines
// say which assembly is meant.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/drag.h"
#include "api/editor.h"

struct pleuel_drag {
  pleuel_model* m;
  pl_arena *arena, *answer;
  pl_manifold* manifold;
  pl_hold* hold;
  const char* point;
  double *value, *q_0, *v_0;  // numbers by symbol id; where the text starts      (n)
  double *q, *v;              // (n)
  const char** names;         // as in `sim`                                      (n)
  const char** units;
  const bool* free;  // positions that nothing determines                (n)
  int n, n_place;
  double place[3];
  const pleuel_edit* edits;
  size_t n_edits;
};

// ------------------------------------------------------------------------------- taking hold
typedef struct pl_grasp {
  pleuel_drag* d;
  const char* point;
} pl_grasp;

static bool is_called(pl_arena* a, const pl_name* n, const char* label) {
  bool same = n->text && (strcmp(n->text, label) == 0 || pl_spelled_same(a, n->text, label));
  return same || (n->ascii && strcmp(n->ascii, label) == 0);
}

static const pl_point* point_named(pl_arena* a, const pl_model* m, const char* label) {
  for (int i = 0; i < m->masses.n; i++) {
    if (is_called(a, &m->masses.at[i].name, label)) return &m->masses.at[i].point;
  }
  for (int i = 0; i < m->bodies.n; i++) {
    if (is_called(a, &m->bodies.at[i].name, label)) return &m->bodies.at[i].centre;
  }
  for (int i = 0; i < m->spatials.n; i++) {
    if (is_called(a, &m->spatials.at[i].name, label)) return &m->spatials.at[i].centre;
  }
  for (int i = 0; i < m->points.n; i++) {
    if (is_called(a, &m->points.at[i].name, label)) return &m->points.at[i].point;
  }
  return NULL;
}

// The start as the text gives it, in the coordinates as declared.
static pleuel_status find_start(pleuel_model* m, pl_run** run) {
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  how.certify = 1;  // Euler angles stay angles
  pl_result* result = m->result;
  m->result = NULL;
  pleuel_status s = pl_pipeline_start(m, &how, run);
  m->result = result;
  return s;
}

static void copy_start(pleuel_drag* d, const pl_setup* setup, const pl_run* run,
                       const pl_start_report* report) {
  bool* free = PL_ARRAY(d->arena, bool, d->n);
  for (int i = 0; i < d->n; i++) {
    d->q[i] = d->q_0[i] = pl_run_q(run)[i];
    d->v[i] = d->v_0[i] = pl_run_v(run)[i];
    d->names[i] = pl_copy(d->arena, setup->coordinates[i].name);
    d->units[i] = setup->coordinates[i].unit ? pl_copy(d->arena, setup->coordinates[i].unit) : "";
  }
  for (int i = 0; i < report->n_free; i++) {
    if (report->free[i] < d->n) free[report->free[i]] = true;
  }
  d->free = free;
}

static void make_rooms(pleuel_drag* d, int n) {
  d->n = n;
  d->q = PL_ARRAY(d->arena, double, n);
  d->v = PL_ARRAY(d->arena, double, n);
  d->q_0 = PL_ARRAY(d->arena, double, n);
  d->v_0 = PL_ARRAY(d->arena, double, n);
  d->names = PL_ARRAY(d->arena, const char*, n);
  d->units = PL_ARRAY(d->arena, const char*, n);
}

// Numbers of all symbols of the flat model at the start.
static double* numbers(pleuel_drag* d, pl_model* flat, double t) {
  for (int i = 0; i < d->n; i++) pl_symbol_dot(flat->pool, flat->coords.at[i].symbol);
  pl_symbol time = pl_time(flat->pool);
  double* known = pl_model_values(flat, d->arena);
  known[time.id] = t;
  for (int i = 0; i < d->n; i++) {
    pl_symbol q = flat->coords.at[i].symbol;
    known[q.id] = d->q[i];
    known[pl_symbol_dot(flat->pool, q).id] = d->v[i];
  }
  return known;
}

static pleuel_status take_hold(pleuel_model* m, void* argument) {
  pl_grasp* g = argument;
  pleuel_drag* d = g->d;
  pl_run* run = NULL;
  PL_TRY(pl_pipeline_check(m));
  pl_model* flat = NULL;
  PL_TRY(pl_model_expand(&m->job, m->model, PL_MOST_DRAGGED, &flat));
  const pl_point* point = point_named(d->arena, flat, g->point);
  if (!point) return pl_fail(&m->job, PLEUEL_USAGE, "there is no mass, body or point %s", g->point);
  pleuel_status s = find_start(m, &run);
  if (s == PLEUEL_OK && m->recording->setup.n_q != flat->coords.n) {
    s = pl_fail(&m->job, PLEUEL_UNSUPPORTED, "this system is too large to be dragged");
  }
  if (s == PLEUEL_OK) {
    make_rooms(d, flat->coords.n);
    copy_start(d, &m->recording->setup, run, pl_run_start_report(run));
    d->value = numbers(d, flat, pl_run_time(run));
    d->manifold = pl_manifold_make(d->arena, flat, d->value);
    if (!d->manifold)
      s = pl_fail(&m->job, PLEUEL_UNSUPPORTED, "this system is too large to be dragged");
  }
  if (run) pl_run_free(run);
  if (s != PLEUEL_OK) return s;
  d->point = pl_copy(d->arena, g->point);
  d->hold = pl_hold_make(d->arena, d->manifold, point);
  d->n_place = point->n;
  pl_hold_place(d->hold, d->place);
  if (pl_hold_can_move(d->hold)) return PLEUEL_OK;
  return pl_fail(&m->job, PLEUEL_UNSUPPORTED,
                 "%s cannot be dragged: the constraints hold it where it is", g->point);
}

static pleuel_status open_in(pleuel_model* m, pl_arena* a, void* argument) {
  (void)a;
  return pl_api_guarded(m, take_hold, argument);
}

pleuel_status pleuel_drag_open(pleuel_model* m, const char* point, pleuel_drag** drag) {
  if (drag) *drag = NULL;
  if (!m || !point || !drag) return PLEUEL_USAGE;
  if (!pl_editor_of(m)) return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  pleuel_drag* d = calloc(1, sizeof *d);
  pl_arena* a = d ? pl_arena_make(m->ctx->alloc) : NULL;
  if (!a) {
    free(d);
    return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  }
  d->m = m;
  d->arena = a;
  pl_grasp g = {d, point};
  pleuel_status s = pl_editor_guarded_in(m, a, open_in, &g);
  if (s == PLEUEL_OK) *drag = d;
  else pleuel_drag_free(d);
  return s;
}

void pleuel_drag_free(pleuel_drag* d) {
  if (!d) return;
  if (d->answer) pl_arena_free(d->answer);
  pl_arena_free(d->arena);
  free(d);
}

// ---------------------------------------------------------------------------------------- moving
static void read_state(pleuel_drag* d) {
  for (int i = 0; i < d->n; i++) {
    pl_symbol q = pl_manifold_coordinate(d->manifold, i);
    d->q[i] = d->value[q.id];
    d->v[i] = d->value[pl_manifold_velocity(d->manifold, i).id];
  }
  pl_hold_place(d->hold, d->place);
}

const double* pleuel_drag_place(const pleuel_drag* d, size_t* n) {
  if (n) *n = d ? (size_t)d->n_place : 0;
  return d ? d->place : NULL;
}

static bool are_numbers(const double* x, size_t n) {
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(x[i])) return false;
  }
  return true;
}

pleuel_status pleuel_drag_to(pleuel_drag* d, const double* place, size_t n) {
  if (!d || !place || n != (size_t)d->n_place || !are_numbers(place, n)) return PLEUEL_USAGE;
  bool fine = pl_hold_move(d->hold, place);
  read_state(d);
  return fine ? PLEUEL_OK
              : pl_api_fail(d->m->ctx, PLEUEL_NUMERICAL,
                            "the constraints could not be kept on the way");
}

pleuel_status pleuel_drag_throw(pleuel_drag* d, const double* velocity, size_t n) {
  if (!d || !velocity || n != (size_t)d->n_place || !are_numbers(velocity, n)) return PLEUEL_USAGE;
  pl_hold_throw(d->hold, velocity);
  read_state(d);
  return PLEUEL_OK;
}

pleuel_status pleuel_drag_state(const pleuel_drag* d, const char* const** names, const double** q,
                                const double** v, size_t* n) {
  if (!d) return PLEUEL_USAGE;
  if (names) *names = d->names;
  if (q) *q = d->q;
  if (v) *v = d->v;
  if (n) *n = (size_t)d->n;
  return PLEUEL_OK;
}

// ---------------------------------------------------------------------------------------- writing
typedef struct pl_writing {
  pleuel_drag* d;
  pl_arena* a;
  int digits;
  int level;  // 0: numbers that stand there; 1: and what is free; 2: and guesses of the rest
  PL_VEC(pleuel_edit) edits;
  const char* refused;  // a name whose start value cannot be written
} pl_writing;

// The unit behind the number of a value: "[cm]", "°", "" with its blank; and what it is worth.
static const char* suffix_of(pl_writing* w, const char* text, double* scale) {
  const char* open = strrchr(text, '[');
  const char* degree = strstr(text, "°");
  *scale = 1;
  if (degree && degree[strlen("°")] == '\0') {
    *scale = acos(-1) / 180;
    return "°";
  }
  if (!open || text[strlen(text) - 1] != ']') return "";
  pl_pool* p = pl_pool_make(w->a);
  pl_unit unit;
  size_t at, n;
  const char* near;
  if (!pl_unit_parse(p, open + 1, strlen(open + 1) - 1, &unit, &at, &n, &near)) return "";
  *scale = pl_eval(p, unit.scale, PL_ARRAY(w->a, double, pl_symbol_count(p) + 1));
  return open > text && open[-1] == ' ' ? pl_format(w->a, " %s", open) : open;
}

static const char* in_digits(const pl_writing* w, double x) {
  return pl_format(w->a, "%.*g", w->digits, x == 0 ? 0.0 : x);
}

// A name of `sim`: x, x[3]; its key and index.
static void split(const pl_writing* w, const char* name, const char** key, long* index) {
  const char* open = strchr(name, '[');
  *key = open ? pl_copy_n(w->a, name, (size_t)(open - name)) : name;
  *index = open ? strtol(open + 1, NULL, 10) : 0;
}

static long index_written(const pl_span* relation) {
  const char* open = memchr(relation->source->text + relation->begin, '[',
                            relation->end - relation->begin);
  return open ? strtol(open + 1, NULL, 10) : 0;
}

static const pl_written_start* written(pl_writing* w, int i, int dots) {
  const pl_outline* o = w->d->m->editor->outline;
  const char* key;
  long index;
  split(w, w->d->names[i], &key, &index);
  for (int k = 0; k < o->starts.n; k++) {
    const pl_written_start* s = &o->starts.at[k];
    const pl_named* n = &o->named.at[s->named];
    bool of_it = n->kind == PL_NAMED_COORDINATE && strcmp(n->key, key) == 0 && s->dots == dots
                 && !s->guess && !s->at;
    if (!of_it) continue;
    if (s->indexed && !s->in_block && index_written(&s->relation) != index) continue;
    return s;
  }
  return NULL;
}

static void add_edit(pl_writing* w, pl_span span, const char* text) {
  pl_push(w->a, w->edits, (pleuel_edit){pl_api_span(span), text});
}

static void write_number(pl_writing* w, const pl_written_start* s, int i, double x, double size) {
  double scale;
  const char* old = pl_copy_n(w->a, s->value.source->text + s->value.begin,
                              s->value.end - s->value.begin);
  const char* suffix = suffix_of(w, old, &scale);
  if (s->in_block) w->refused = w->d->names[i];
  if (!*suffix && s->dots == 0 && w->d->m->model->uses_units && strcmp(w->d->units[i], "rad") != 0
      && *w->d->units[i]) {
    suffix = pl_format(w->a, " [%s]", w->d->units[i]);  // the old value had names in it
  }
  add_edit(w, s->value,
           pl_format(w->a, "%s%s", in_digits(w, fabs(x) < 1e-13 * size ? 0 : x / scale), suffix));
}

static bool moved(double x, double from, double size) { return fabs(x - from) > 1e-12 * size; }

static double size_of(const double* x, int n) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most > 0 ? most : 1;
}

// A line of its own, for what no line says.
static void say(pl_writing* w, pl_text* lines, const char* word, int i, int dots, double x,
                double size) {
  const char* key;
  long index;
  split(w, w->d->names[i], &key, &index);
  const char* name = index ? pl_format(w->a, "%s[%ld]", pl_spell_shown(w->a, key), index)
                           : pl_spell_shown(w->a, key);
  bool angle = strcmp(w->d->units[i], "rad") == 0,
       bare = !w->d->m->model->uses_units || !*w->d->units[i];
  double factor = angle && !dots ? 180 / acos(-1) : 1;
  const char* number = in_digits(w, fabs(x) < 1e-13 * size ? 0 : x * factor);
  const char* unit = angle && !dots  ? "°"
                     : bare || angle ? ""
                                     : pl_format(w->a, dots ? " [%s/s]" : " [%s]", w->d->units[i]);
  if (lines->n == 0 || !strstr(lines->at, pl_format(w->a, "\n%s ", word)))
    pl_text_addf(lines, "\n%s ", word);
  else pl_text_add(lines, ", ");
  pl_text_addf(lines, "%s%s = %s%s", name, dots ? "'" : "", number, unit);
}

// Behind the last line that says how the motion starts, else at the end of the text.
static pl_span line_behind(const pl_writing* w) {
  const pl_source* s = w->d->m->source;
  const pl_outline* o = w->d->m->editor->outline;
  size_t at = s->size;
  while (at > 0 && (s->text[at - 1] == '\n' || s->text[at - 1] == '\r')) at--;
  for (int k = 0; k < o->starts.n; k++) {
    const pl_written_start* one = &o->starts.at[k];
    if (one->statement.source == s && !one->in_block) at = one->statement.end;
  }
  while (at < s->size && s->text[at] != '\n' && s->text[at] != '\r') at++;
  return (pl_span){s, (uint32_t)at, (uint32_t)at};
}

static void write_start(pl_writing* w) {
  const pleuel_drag* d = w->d;
  pl_text lines = pl_text_make(w->a);
  double q_size = size_of(d->q, d->n), v_size = size_of(d->v, d->n);
  for (int i = 0; i < d->n; i++) {
    const pl_written_start *place = written(w, i, 0), *speed = written(w, i, 1);
    if (place && moved(d->q[i], d->q_0[i], q_size)) write_number(w, place, i, d->q[i], q_size);
    if (speed && moved(d->v[i], d->v_0[i], v_size)) write_number(w, speed, i, d->v[i], v_size);
    if (!place && w->level >= 1 && d->free[i]) say(w, &lines, "init", i, 0, d->q[i], q_size);
    if (!speed && w->level >= 1 && d->free[i] && moved(d->v[i], 0, v_size))
      say(w, &lines, "init", i, 1, d->v[i], v_size);
  }
  for (int i = 0; w->level >= 2 && i < d->n; i++) {
    if (!written(w, i, 0) && !d->free[i]) say(w, &lines, "guess", i, 0, d->q[i], q_size);
  }
  if (lines.n) add_edit(w, line_behind(w), pl_text_string(&lines));
}

// ---------------------------------------------------------------------------------------- trying
static const char* included_again(void* user, const char* path, const char* from) {
  const pleuel_model* m = user;
  for (int i = 0; i < m->included.n; i++) {
    const pl_included* f = &m->included.at[i];
    if (strcmp(f->path, path) == 0 && strcmp(f->from, from) == 0) return f->source->text;
  }
  return NULL;
}

typedef struct pl_trial {
  pl_run* run;
} pl_trial;

static pleuel_status start_of(pleuel_model* m, void* argument) {
  pl_trial* t = argument;
  PL_TRY(pl_pipeline_check(m));
  return find_start(m, &t->run);
}

static bool is_near(const double* x, const double* wanted, int n, double tolerance) {
  double size = size_of(wanted, n);
  for (int i = 0; i < n; i++) {
    if (!(fabs(x[i] - wanted[i]) <= tolerance * size)) return false;
  }
  return true;
}

// Does the edited text start where it was dragged to?
static bool starts_there(pl_writing* w, const char* text) {
  pleuel_drag* d = w->d;
  PLEUEL_OPTIONS(pleuel_load_options, o);
  o.name = d->m->source->name;
  o.read = included_again;
  o.read_user = d->m;
  pleuel_setting* set = PL_ARRAY(w->a, pleuel_setting, d->m->n_settings + 1);
  for (int i = 0; i < d->m->n_settings; i++)
    set[i] = (pleuel_setting){d->m->settings[i].name, d->m->settings[i].value};
  o.settings = set;
  o.n_settings = (size_t)d->m->n_settings;
  pleuel_model* trial = NULL;
  if (pleuel_load_text(d->m->ctx, &trial, text, strlen(text), &o) != PLEUEL_OK) {
    pleuel_model_free(trial);
    return false;
  }
  pl_trial t = {0};
  bool fine = pl_api_guarded(trial, start_of, &t) == PLEUEL_OK
              && trial->recording->setup.n_q == d->n;
  double tolerance = w->digits < 10 ? 10 * pow(10, -w->digits) : 1e-8;
  fine = fine && is_near(pl_run_q(t.run), d->q, d->n, tolerance)
         && is_near(pl_run_v(t.run), d->v, d->n, 100 * tolerance);
  if (t.run) pl_run_free(t.run);
  pleuel_model_free(trial);
  return fine;
}

static pleuel_status write_edits(pleuel_model* m, pl_arena* a, void* argument) {
  pleuel_drag* d = argument;
  static const struct {
    int level, digits;
  } ways[] = {{0, 6}, {0, 15}, {1, 6}, {1, 15}, {2, 6}, {2, 15}};
  const char* refused = NULL;
  for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
    pl_writing w = {.d = d, .a = a, .digits = ways[k].digits, .level = ways[k].level};
    write_start(&w);
    refused = w.refused;
    if (refused) break;
    const char* text = NULL;
    if (pleuel_edited(m, w.edits.at, (size_t)w.edits.n, &text) != PLEUEL_OK
        || !starts_there(&w, text))
      continue;
    d->edits = w.edits.at;
    d->n_edits = (size_t)w.edits.n;
    m->ctx->message[0] = '\0';
    return PLEUEL_OK;
  }
  if (refused) {
    pl_fail(&m->job, PLEUEL_UNSUPPORTED, "the start of %s is written for its whole family at once",
            refused);
  } else {
    pl_fail(&m->job, PLEUEL_UNSUPPORTED, "the text cannot be made to start there by numbers alone");
  }
  return pl_api_fail(m->ctx, PLEUEL_UNSUPPORTED, m->job.message);
}

pleuel_status pleuel_drag_edits(pleuel_drag* d, const pleuel_edit** edits, size_t* n) {
  if (edits) *edits = NULL;
  if (n) *n = 0;
  if (!d || !edits || !n) return PLEUEL_USAGE;
  if (d->answer) pl_arena_free(d->answer);
  d->answer = pl_arena_make(d->m->ctx->alloc);
  if (!d->answer) return pl_api_fail(d->m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  d->edits = NULL;
  d->n_edits = 0;
  pleuel_status s = pl_editor_guarded_in(d->m, d->answer, write_edits, d);
  *edits = d->edits;
  *n = d->n_edits;
  return s;
}
