// The names of a text: what they are called, what they mean, where they are declared; and what
// stands at a place.
#include "api/editor.h"

#include <math.h>
#include <string.h>

// ---------------------------------------------------------------------------------------- values
typedef struct pl_listing {
  pleuel_model* m;
  pl_arena* a;
  const pl_outline* o;
  const double* value;  // of parameters by symbol id; NULL: the text has errors
  PL_VEC(pleuel_name) list;
} pl_listing;

static const char* unit_of_symbol(const pl_listing* w, pl_symbol s) {
  if (!s.id) return NULL;
  const pl_symbol_info* info = pl_symbol_get(w->m->model->pool, s);
  if (!info->dimension_known) return NULL;
  bool angle = info->role == PL_R_COORD || info->role == PL_R_ARRAY;
  if (angle && pl_dimension_equal(info->dimension, pl_dimension_one())) return "rad";
  return pl_unit_of_symbol(w->a, w->m->model->pool, s, info->dimension, true);
}

static const char* unit_of_expr(const pl_listing* w, pl_expr e) {
  pl_dimension d;
  bool known = w->value && !pl_is_poison(e) && pl_model_dimension(w->m->model, e, &d);
  return known ? pl_dimension_unit(w->a, d, true) : NULL;
}

static void give_value(pleuel_name* n, double x) {
  n->has_value = !isnan(x);
  n->value = n->has_value ? x : 0;
}

// Where a coordinate or velocity starts, if the text gives a number.
static void give_start(const pl_listing* w, pleuel_name* n, pl_symbol s) {
  const pl_model* m = w->m->model;
  for (int i = 0; w->value && i < m->inits.n; i++) {
    const pl_init* init = &m->inits.at[i];
    bool of_it = !init->guess && pl_is_poison(init->time)
                 && pl_kind_of(m->pool, init->target) == PL_SYMBOL
                 && pl_symbol_of(m->pool, init->target).id == s.id;
    if (of_it) give_value(n, pl_eval(m->pool, init->value, w->value));
  }
}

static const pl_let* let_of(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->lets.n; i++) {
    if (m->lets.at[i].symbol.id == s.id && s.id) return &m->lets.at[i];
  }
  return NULL;
}

static pl_expr output_of(const pl_model* m, const char* key) {
  for (int i = 0; i < m->outputs.n; i++) {
    if (strcmp(m->outputs.at[i].name, key) == 0) return m->outputs.at[i].value;
  }
  return pl_poison();
}

// ------------------------------------------------------------------------------- the list
static pleuel_name plain(const pl_named* n) {
  return (pleuel_name){.kind = (pleuel_kind)n->kind,
                       .ascii = n->key,
                       .shown = n->shown,
                       .meaning = n->comment,
                       .family = n->family,
                       .span = pl_api_span(n->span),
                       .definition = pl_api_span(n->definition)};
}

static void add_velocity(pl_listing* w, const pl_named* n, pl_symbol s) {
  pl_pool* pool = w->m->model->pool;
  pleuel_name v = plain(n);
  v.kind = PLEUEL_KIND_VELOCITY;
  v.of = n->key;
  v.meaning = NULL;
  v.ascii = pl_format(w->a, "%s_dot", n->key);
  v.shown = pl_format(w->a, "%s'", n->shown);
  v.unit = NULL;
  if (s.id) {
    const pl_symbol_info* info = pl_symbol_get(pool, s);
    pl_dimension d = pl_dimension_div(info->dimension, pl_dimension_of(0, 0, 1));
    bool angle = pl_dimension_equal(info->dimension, pl_dimension_one());
    if (info->dimension_known) v.unit = angle ? "rad/s" : pl_dimension_unit(w->a, d, true);
    if (!n->family) give_start(w, &v, pl_symbol_dot(pool, s));
  }
  pl_push(w->a, w->list, v);
}

// λ_rod of a constraint that names no multiplier of its own.
static void add_multiplier(pl_listing* w, const pl_named* n) {
  for (int i = 0; i < w->o->named.n; i++) {
    const pl_named* other = &w->o->named.at[i];
    if (other->kind == PL_NAMED_MULTIPLIER && other->label == n->key) return;
  }
  pleuel_name v = plain(n);
  v.kind = PLEUEL_KIND_MULTIPLIER;
  v.of = n->key;
  v.meaning = NULL;
  v.ascii = pl_format(w->a, "lambda_%s", n->key);
  v.shown = pl_format(w->a, "λ_%s", n->shown);
  v.unit = unit_of_symbol(w, pl_symbol_find(w->m->model->pool, v.ascii));
  pl_push(w->a, w->list, v);
}

static pl_symbol symbol_of(const pl_listing* w, const pl_named* n) {
  const char* key = n->kind == PL_NAMED_MULTIPLIER ? pl_format(w->a, "lambda_%s", n->label)
                                                   : n->key;
  return pl_symbol_find(w->m->model->pool, key);
}

static void add_named(pl_listing* w, const pl_named* n) {
  const pl_model* m = w->m->model;
  pleuel_name out = plain(n);
  pl_symbol s = {0};
  const pl_let* let = NULL;
  switch (n->kind) {
    case PL_NAMED_PARAMETER:
    case PL_NAMED_INPUT:
      s = symbol_of(w, n);
      out.unit = unit_of_symbol(w, s);
      if (s.id && w->value) give_value(&out, w->value[s.id]);
      break;
    case PL_NAMED_COORDINATE:
      s = symbol_of(w, n);
      out.unit = unit_of_symbol(w, s);
      if (!n->family) give_start(w, &out, s);
      break;
    case PL_NAMED_MULTIPLIER:
      out.of = n->label;
      out.unit = unit_of_symbol(w, symbol_of(w, n));
      break;
    case PL_NAMED_ABBREVIATION:
      let = let_of(m, symbol_of(w, n));
      if (let) out.unit = unit_of_expr(w, let->value);
      if (let && w->value) give_value(&out, pl_eval(m->pool, let->value, w->value));
      break;
    case PL_NAMED_OUTPUT: out.unit = unit_of_expr(w, output_of(m, n->key)); break;
    default: break;
  }
  pl_push(w->a, w->list, out);
  if (n->kind == PL_NAMED_COORDINATE) add_velocity(w, n, s);
  if (n->kind == PL_NAMED_CONSTRAINT) add_multiplier(w, n);
}

static pleuel_status list_names(pleuel_model* m, pl_arena* a, void* argument) {
  (void)argument;
  pl_listing w = {.m = m, .a = a, .o = m->editor->outline};
  if (m->checked == PLEUEL_OK && m->is_checked) w.value = pl_model_values(m->model, a);
  for (int i = 0; i < w.o->named.n; i++) {
    const pl_named* n = &w.o->named.at[i];
    bool again = n->unlabelled && pl_outline_find(w.o, n->key) >= 0;
    if (n->kind != PL_NAMED_INDEX && !again) add_named(&w, n);
  }
  m->editor->names = w.list.at;
  m->editor->n_names = (size_t)w.list.n;
  return PLEUEL_OK;
}

// Units follow from the check, so it comes first; its verdict does not matter here.
static pleuel_status know_names(pleuel_model* m, void* argument) {
  (void)argument;
  if (m->editor->names) return PLEUEL_OK;
  pl_pipeline_check(m);
  m->job.message[0] = '\0';
  return pl_editor_keep(m, list_names, NULL);
}

static pleuel_status names_of(pleuel_model* m) {
  if (!pl_editor_of(m)) return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  return m->editor->names ? PLEUEL_OK : pl_api_guarded(m, know_names, NULL);
}

size_t pleuel_name_count(pleuel_model* m) {
  return m && names_of(m) == PLEUEL_OK ? m->editor->n_names : 0;
}

pleuel_status pleuel_name_get(pleuel_model* m, size_t i, pleuel_name* out) {
  if (!m || !out) return PLEUEL_USAGE;
  pleuel_status s = names_of(m);
  if (s != PLEUEL_OK) return s;
  return i < m->editor->n_names ? pl_api_give(out, &m->editor->names[i], sizeof *out)
                                : PLEUEL_USAGE;
}

// The name a spelling means: as it stands, then without its dots, primes or λ.
static const pleuel_name* find(pleuel_model* m, const char* spelling) {
  pl_arena* a = m->editor->arena;
  size_t n = strlen(spelling), stem = n;
  while (stem > 0 && spelling[stem - 1] == '\'') stem--;
  const char* asked = pl_copy_n(a, spelling, stem);
  if (n - stem == 1) asked = pl_format(a, "%s_dot", asked);
  if (n - stem > 1) return NULL;
  for (size_t i = 0; i < m->editor->n_names; i++) {
    const pleuel_name* one = &m->editor->names[i];
    if (pl_spelled_same(a, asked, one->ascii) || strcmp(spelling, one->shown) == 0) return one;
    if (strcmp(asked, one->ascii) == 0) return one;
  }
  // λ_rod where the constraint has a name for it, λ where there is one constraint
  for (size_t i = 0; i < m->editor->n_names; i++) {
    const pleuel_name* one = &m->editor->names[i];
    if (one->kind != PLEUEL_KIND_MULTIPLIER || !one->of) continue;
    if (pl_spelled_same(a, asked, pl_format(a, "lambda_%s", one->of))) return one;
  }
  return NULL;
}

typedef struct pl_finding {
  const char* spelling;
  const pleuel_name* found;
} pl_finding;

static pleuel_status find_name(pleuel_model* m, pl_arena* a, void* argument) {
  pl_finding* f = argument;
  pl_mark mark = pl_arena_mark(a);
  f->found = find(m, f->spelling);
  pl_arena_rewind(a, mark);
  return PLEUEL_OK;
}

pleuel_status pleuel_name_find(pleuel_model* m, const char* spelling, pleuel_name* out) {
  if (!m || !spelling || !out) return PLEUEL_USAGE;
  pleuel_status s = names_of(m);
  pl_finding f = {spelling, NULL};
  if (s == PLEUEL_OK) s = pl_editor_keep(m, find_name, &f);
  if (s != PLEUEL_OK) return s;
  if (!f.found) return pl_api_fail(m->ctx, PLEUEL_USAGE, "nothing has this name");
  return pl_api_give(out, f.found, sizeof *out);
}

// ---------------------------------------------------------------------------------------- hover
typedef struct pl_hovering {
  size_t at;
  const char* text;
  pl_span span;
} pl_hovering;

static const char* kind_words(pleuel_kind kind, pl_language lang) {
  static const char* const words[] = {
      PL_KEY("time"),   PL_KEY("coordinate"),   PL_KEY("velocity"), PL_KEY("multiplier"),
      PL_KEY("output"), PL_KEY("parameter"),    PL_KEY("input"),    PL_KEY("constraint"),
      PL_KEY("mass"),   PL_KEY("body"),         PL_KEY("point"),    PL_KEY("force"),
      PL_KEY("event"),  PL_KEY("abbreviation"), PL_KEY("function"), PL_KEY("index"),
      PL_KEY("axis"),   PL_KEY("request"),
  };
  return pl_in_language(lang, words[kind]);
}

static const pleuel_name* name_of_use(const pleuel_model* m, const pl_use* u) {
  const pl_named* n = &m->editor->outline->named.at[u->named];
  bool coordinate = n->kind == PL_NAMED_COORDINATE;
  for (size_t i = 0; i < m->editor->n_names; i++) {
    const pleuel_name* one = &m->editor->names[i];
    bool velocity = one->kind == PLEUEL_KIND_VELOCITY;
    if (velocity != (coordinate && u->dots == 1)) continue;
    if (strcmp(velocity ? one->of : one->ascii, n->key) != 0) continue;
    if (velocity || (int)one->kind == (int)n->kind) return one;
  }
  return NULL;
}

static void hover_name(pl_text* out, const pleuel_model* m, const pl_use* u, pl_language lang) {
  const pl_named* n = &m->editor->outline->named.at[u->named];
  const pleuel_name* one = name_of_use(m, u);
  pl_text_addf(out, "**%s**", one ? one->shown : n->shown);
  pl_text_addf(out, " %s", kind_words(one ? one->kind : (pleuel_kind)n->kind, lang));
  if (one && one->unit) pl_text_addf(out, " [%s]", one->unit);
  if (one && one->has_value) {
    bool starts = one->kind == PLEUEL_KIND_COORDINATE || one->kind == PLEUEL_KIND_VELOCITY;
    const char* before = !starts ? "=" : lang == PL_GERMAN ? pl_german("starts at") : "starts at";
    pl_text_addf(out, " %s %s", before, pl_shortest_double(out->arena, one->value));
    if (one->unit && strcmp(one->unit, "1") != 0) pl_text_addf(out, " %s", one->unit);
  }
  if (n->comment) pl_text_addf(out, "\n\n%s", n->comment);
  pl_span d = n->definition;
  const char* text = d.source ? pl_copy_n(out->arena, d.source->text + d.begin, d.end - d.begin)
                              : NULL;
  if (text && strchr(text, '\n')) *strchr((char*)(uintptr_t)text, '\n') = '\0';
  if (text) {
    pl_text_addf(out, "\n\n    %s\n", text);
    pl_text_addf(out, lang == PL_GERMAN ? pl_german("\n%s, line %d") : "\n%s, line %d",
                 d.source->name, pl_span_place(d).line);
  }
}

static const pl_classed* unit_at(const pl_outline* o, size_t at) {
  for (int i = 0; i < o->classed.n; i++) {
    const pl_classed* c = &o->classed.at[i];
    if (c->class == PL_CLASS_UNIT && at >= c->span.begin && at < c->span.end) return c;
  }
  return NULL;
}

static pleuel_status hover(pleuel_model* m, pl_arena* a, void* argument) {
  pl_hovering* h = argument;
  const pl_outline* o = m->editor->outline;
  pl_language lang = pl_api_language_of(m, NULL);
  pl_text out = pl_text_make(a);
  int use = pl_outline_use_at(o, m->source, h->at);
  const char* help = use < 0 ? pl_outline_help_at(o, h->at, lang, &h->span) : NULL;
  const pl_classed* unit = use < 0 && !help ? unit_at(o, h->at) : NULL;
  if (use >= 0) {
    h->span = o->uses.at[use].span;
    hover_name(&out, m, &o->uses.at[use], lang);
  } else if (help) {
    const char* line = strchr(help, '\n');
    pl_text_addf(&out, "    %.*s\n\n%s", (int)(line - help), help, line + 1);
  } else if (unit) {
    h->span = unit->span;
    pl_span in = {unit->span.source, unit->span.begin + 1, unit->span.end - 1};
    const char* text = pl_copy_n(a, in.source->text + in.begin, in.end - in.begin);
    pl_text_add(&out, pl_unit_explain(a, pl_pool_make(a), text, lang));
  }
  h->text = out.n ? pl_text_string(&out) : NULL;
  return PLEUEL_OK;
}

pleuel_status pleuel_hover(pleuel_model* m, size_t at, const char** text, pleuel_span* span) {
  if (text) *text = NULL;
  if (span) *span = (pleuel_span){0};
  if (!m || !text) return PLEUEL_USAGE;
  pl_hovering h = {.at = at};
  pleuel_status s = names_of(m);
  if (s == PLEUEL_OK) s = pl_editor_answer(m, PL_ANSWER_HOVER, hover, &h);
  *text = h.text;
  if (span) *span = pl_api_span(h.span);
  return s;
}
