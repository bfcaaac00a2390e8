// Formulas of the worked solution as values: texts, trees, numbers, derivatives.
//
// They live in an arena of their own that goes when the model is solved anew.  Expressions that
// are made on the way lie in the pool of the solution; a pool holds equal expressions once, so
// asking again takes no more memory.
#include <math.h>
#include <string.h>

#include "api/editor.h"
#include "present/present.h"

struct pleuel_formula {
  pleuel_model* m;
  const pl_section* section;
  const pl_value* value;
  const pl_component* component;  // NULL: the value itself
  pl_expr expr;
  const pl_form* form;       // NULL: found when it is written
  pl_symbol by;              // of a derivative
  const pleuel_formula* of;  // that it is the derivative of; NULL
  const char* text[PLEUEL_NOTATION_EXPR + 1];
  pleuel_node* nodes;
  size_t n_nodes;
  pl_symbol* symbols;  // names in it, abbreviations by what they stand for
  const char** free;
  size_t n_free;
  PL_VEC(pleuel_formula*) derivatives;
};

typedef struct pl_formulas {
  PL_VEC(pleuel_formula*) list;
} pl_formulas;

static pl_pool* pool_of(const pleuel_formula* f) { return f->section->model->pool; }

// ---------------------------------------------------------------------------------------- memory
typedef pleuel_status pl_formula_work(pleuel_formula* f, pl_arena* a, void* argument);

typedef struct pl_formula_call {
  pleuel_formula* f;
  pl_formula_work* work;
  void* argument;
} pl_formula_call;

static pleuel_status call_work(pleuel_model* m, void* argument) {
  pl_formula_call* c = argument;
  pl_arena* a = m->editor->formula_arena;
  volatile pleuel_status status = PLEUEL_NO_MEMORY;
  pl_guard guard;
  PL_GUARD(a, guard) { status = c->work(c->f, a, c->argument); }
  else {
    status = guard.status;
  }
  pl_guard_end(a, &guard);
  return status;
}

// Runs work on a formula; what it makes is kept with the formulas.
static pleuel_status guarded(const pleuel_formula* f, pl_formula_work* work, void* argument) {
  pl_formula_call c = {(pleuel_formula*)(uintptr_t)f, work, argument};
  return pl_api_guarded(f->m, call_work, &c);
}

// ------------------------------------------------------------------------------- the list
static pleuel_formula* add(pleuel_model* m, pl_arena* a, const pl_section* s, const pl_value* v) {
  pleuel_formula* f = PL_NEW(a, pleuel_formula);
  *f = (pleuel_formula){.m = m, .section = s, .value = v, .expr = v->expr, .form = v->form};
  pl_push(a, m->editor->formulas->list, f);
  return f;
}

static pleuel_status list_formulas(pleuel_model* m, pl_arena* a, void* argument) {
  (void)argument;
  const pl_solution* s = m->solution;
  m->editor->formulas = PL_NEW(a, pl_formulas);
  for (int i = 0; i < s->sections.n; i++) {
    const pl_section* section = &s->sections.at[i];
    for (int k = 0; k < section->values.n; k++) {
      const pl_value* v = &section->values.at[k];
      if (!pl_is_poison(v->expr)) add(m, a, section, v);
      for (int c = 0; c < v->n_components; c++) {
        if (pl_is_poison(v->components[c].expr)) continue;
        pleuel_formula* f = add(m, a, section, v);
        f->component = &v->components[c];
        f->expr = f->component->expr;
        f->form = f->component->form;
      }
    }
  }
  return PLEUEL_OK;
}

void pl_editor_forget_solution(pleuel_model* m) {
  if (!m->editor || !m->editor->formula_arena) return;
  pl_arena_free(m->editor->formula_arena);
  m->editor->formula_arena = NULL;
  m->editor->formulas = NULL;
}

static pleuel_status solve(pleuel_model* m, void* argument) {
  const pleuel_solve_options* o = argument;
  return pl_pipeline_derive(m, o->only, o->seconds, !o->no_simulation);
}

static pleuel_status know_formulas(pleuel_model* m) {
  pl_editor* e = pl_editor_of(m);
  if (!e) return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  if (e->formulas || !m->solution || m->structure) return PLEUEL_OK;
  return pl_editor_keep_formulas(m, list_formulas);
}

pleuel_status pleuel_formulas(pleuel_model* m, const pleuel_solve_options* options, size_t* n) {
  if (n) *n = 0;
  if (!m || !n) return PLEUEL_USAGE;
  pleuel_solve_options o;
  PL_TRY(pl_api_take(m->ctx, &o, sizeof o, options));
  pleuel_status s = pl_api_guarded(m, solve, &o);
  if (m->broken || !m->solution) return s;
  pleuel_status listed = know_formulas(m);
  if (listed != PLEUEL_OK) return listed;
  *n = m->editor->formulas ? (size_t)m->editor->formulas->list.n : 0;
  return s;
}

static const pl_formulas* formulas_of(pleuel_model* m) {
  return m && m->editor ? m->editor->formulas : NULL;
}

const pleuel_formula* pleuel_formula_get(pleuel_model* m, size_t i) {
  const pl_formulas* all = formulas_of(m);
  return all && i < (size_t)all->list.n ? all->list.at[i] : NULL;
}

// A name in ASCII: θ1' is theta1_dot, λ_rod lambda_rod.
static const char* key_of(pl_arena* a, const char* spelling) {
  size_t n = strlen(spelling), stem = n;
  while (stem > 0 && spelling[stem - 1] == '\'') stem--;
  const char* key = pl_spelled_key(a, pl_copy_n(a, spelling, stem));
  if (!key) return spelling;
  return n - stem == 1   ? pl_format(a, "%s_dot", key)
         : n - stem == 2 ? pl_format(a, "%s_ddot", key)
                         : key;
}

const pleuel_formula* pleuel_formula_find(pleuel_model* m, const char* name) {
  const pl_formulas* all = formulas_of(m);
  if (!all || !name) return NULL;
  pl_arena* a = pl_arena_make(m->ctx->alloc);
  if (!a) return NULL;
  const pleuel_formula* volatile found = NULL;
  pl_guard guard;
  PL_GUARD(a, guard) {
    const char* key = key_of(a, name);
    for (int i = 0; !found && i < all->list.n; i++) {
      const char* own = all->list.at[i]->value->name;
      if (own && (strcmp(own, name) == 0 || strcmp(own, key) == 0)) found = all->list.at[i];
    }
    for (int i = 0; !found && i < all->list.n; i++) {
      const char* letter = all->list.at[i]->section->letter;
      if (letter && strcmp(letter, name) == 0) found = all->list.at[i];
    }
  }
  pl_guard_end(a, &guard);
  pl_arena_free(a);
  return found;
}

// ------------------------------------------------------------------------------- names in it
// What stands for something else: abbreviations of the model, named intermediates of the answer.
static pl_expr meaning_of(const pleuel_formula* f, pl_symbol s) {
  const pl_model* m = f->section->model;
  for (int i = 0; i < f->value->n_where; i++) {
    if (pl_symbol_find(m->pool, f->value->where_name[i]).id == s.id) return f->value->where_expr[i];
  }
  for (int i = 0; i < m->lets.n; i++) {
    const pl_let* l = &m->lets.at[i];
    if (l->symbol.id == s.id && !l->inserted && l->n_args == 0) return l->value;
  }
  return pl_poison();
}

// The expression with everything that stands for something else replaced, innermost last.
static pl_expr spelled_out(const pleuel_formula* f, pl_arena* a, pl_expr e) {
  enum { DEEPEST = 64 };
  pl_pool* p = pool_of(f);
  for (int depth = 0; depth < DEEPEST; depth++) {
    int n = pl_symbols_in(p, e, NULL, 0), k = 0;
    pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
    pl_replace* r = PL_ARRAY(a, pl_replace, n + 1);
    pl_symbols_in(p, e, s, n);
    for (int i = 0; i < n; i++) {
      pl_expr to = meaning_of(f, s[i]);
      if (!pl_is_poison(to)) r[k++] = (pl_replace){s[i], to};
    }
    if (k == 0) break;
    e = pl_subst(p, e, r, k);
  }
  return pl_without_measures(p, e);
}

static pleuel_status know_free(pleuel_formula* f, pl_arena* a, void* argument) {
  (void)argument;
  if (f->free) return PLEUEL_OK;
  pl_pool* p = pool_of(f);
  pl_expr e = spelled_out(f, a, f->expr);
  int n = pl_symbols_in(p, e, NULL, 0);
  f->symbols = PL_ARRAY(a, pl_symbol, n + 1);
  pl_symbols_in(p, e, f->symbols, n);
  const char** names = PL_ARRAY(a, const char*, n + 1);
  for (int i = 0; i < n; i++) names[i] = pl_symbol_get(p, f->symbols[i])->ascii;
  f->free = names;
  f->n_free = (size_t)n;
  return PLEUEL_OK;
}

static bool all_checks_passed(const pl_solution* s) {
  for (int i = 0; s && i < s->checks.n; i++) {
    if (!s->checks.at[i].passed) return false;
  }
  return s != NULL;
}

pleuel_status pleuel_formula_about(const pleuel_formula* f, pleuel_formula_info* out) {
  if (!f || !out) return PLEUEL_USAGE;
  pleuel_status s = guarded(f, know_free, NULL);
  if (s != PLEUEL_OK) return s;
  const pl_value* v = f->value;
  bool withdrawn = v->withdrawn || f->section->withdrawn;
  bool derived = f->of != NULL;
  pleuel_formula_info info = {
      .letter = f->section->letter,
      .item = f->section->item,
      .name = derived ? NULL : v->name,
      .of = v->of,
      .on = v->on,
      .along = f->component ? f->component->along : NULL,
      .branch = v->branch,
      .unit = derived ? NULL : v->unit,
      .number = derived        ? (double)NAN
                : f->component ? f->component->number
                               : v->number,
      .certified = !withdrawn && all_checks_passed(f->m->solution),
      .withdrawn = withdrawn,
      .n_assuming = (size_t)v->n_assuming,
      .assuming = v->assuming,
      .n_free = f->n_free,
      .free = f->free,
      .span = f->section->ask ? pl_api_span(f->section->ask->span) : (pleuel_span){0}};
  return pl_api_give(out, &info, sizeof info);
}

// ---------------------------------------------------------------------------------------- texts
static const pl_form* form_of(pleuel_formula* f, pl_arena* a) {
  if (!f->form) f->form = pl_form_of(a, pool_of(f), f->expr);
  return f->form;
}

static pleuel_status write_formula(pleuel_formula* f, pl_arena* a, void* argument) {
  pleuel_notation how = *(pleuel_notation*)argument;
  static const pl_math math[] = {PL_MATH_LINE, PL_MATH_2D, PL_MATH_ASCII, PL_MATH_TEX,
                                 PL_MATH_MATHML};
  pl_pool* p = pool_of(f);
  const char* text;
  if (how == PLEUEL_NOTATION_EXPR) {
    text = pl_expr_text(a, p, pl_without_measures(p, f->expr));
  } else {
    pl_notation notation = {math[how], f->m->job.lang};
    text = pl_notation_print(a, p, form_of(f, a), notation);
  }
  bool bare = how == PLEUEL_NOTATION_MATHML && strncmp(text, "<math", 5) != 0;
  f->text[how] = bare ? pl_format(a, "<math>%s</math>", text) : text;
  return PLEUEL_OK;
}

const char* pleuel_formula_text(const pleuel_formula* f, pleuel_notation notation) {
  if (!f || (unsigned)notation > PLEUEL_NOTATION_EXPR) return NULL;
  if (f->value->withdrawn || f->section->withdrawn) return NULL;
  if (!f->text[notation] && guarded(f, write_formula, &notation) != PLEUEL_OK) return NULL;
  return f->text[notation];
}

// ------------------------------------------------------------------------------------ the tree
typedef struct pl_growing {
  pl_arena* a;
  pl_pool* p;
  pl_map* known;          // expression -> node + 1
  PL_VEC(pl_expr) queue;  // the node of each place
} pl_growing;

static size_t node_of(pl_growing* g, pl_expr e) {
  uint64_t at = pl_map_get(g->known, e.id);
  if (at) return (size_t)at - 1;
  pl_push(g->a, g->queue, e);
  pl_map_set(g->known, e.id, (uint64_t)g->queue.n);
  return (size_t)g->queue.n - 1;
}

static pleuel_node node(pl_growing* g, pl_expr e) {
  static const pleuel_node_kind kinds[] = {[PL_NUMBER] = PLEUEL_NODE_NUMBER,
                                           [PL_PI] = PLEUEL_NODE_PI,
                                           [PL_INFINITY] = PLEUEL_NODE_INFINITY,
                                           [PL_SYMBOL] = PLEUEL_NODE_NAME,
                                           [PL_AT] = PLEUEL_NODE_MEMBER,
                                           [PL_ADD] = PLEUEL_NODE_ADD,
                                           [PL_MUL] = PLEUEL_NODE_MULTIPLY,
                                           [PL_POW] = PLEUEL_NODE_POWER,
                                           [PL_CALL] = PLEUEL_NODE_CALL,
                                           [PL_UNKNOWN_FUNCTION] = PLEUEL_NODE_CALL,
                                           [PL_IF] = PLEUEL_NODE_IF,
                                           [PL_SUM] = PLEUEL_NODE_SUM};
  pl_kind kind = pl_kind_of(g->p, e);
  pleuel_node out = {.kind = kinds[kind], .value = (double)NAN};
  int first = kind == PL_SUM ? 1 : 0, n = kind == PL_SYMBOL ? 0 : pl_n_args(g->p, e);
  if (kind == PL_NUMBER) {
    out.text = pl_number_text(g->a, g->p, e);
    out.value = pl_number_double(g->p, e);
  }
  if (kind == PL_PI) out.value = acos(-1);
  if (kind == PL_CALL) out.text = pl_function_name[pl_function_of(g->p, e)];
  if (kind == PL_SYMBOL || kind == PL_SUM)
    out.text = pl_symbol_get(g->p, pl_symbol_of(g->p, e))->ascii;
  if (kind == PL_AT) {
    static const char* const dots[] = {"", "_dot", "_ddot"};
    out.text = pl_format(g->a, "%s%s", pl_symbol_get(g->p, pl_symbol_of(g->p, e))->ascii,
                         dots[pl_dots_of(g->p, e)]);
  }
  size_t* child = PL_ARRAY(g->a, size_t, n + 1);
  for (int i = first; i < n; i++) child[out.n++] = node_of(g, pl_arg(g->p, e, i));
  out.child = child;
  return out;
}

static pleuel_status grow(pleuel_formula* f, pl_arena* a, void* argument) {
  (void)argument;
  pl_growing g = {.a = a, .p = pool_of(f), .known = pl_map_make(a)};
  PL_VEC(pleuel_node) nodes = {0};
  node_of(&g, pl_without_measures(g.p, f->expr));
  for (int i = 0; i < g.queue.n; i++) pl_push(a, nodes, node(&g, g.queue.at[i]));
  f->nodes = nodes.at;
  f->n_nodes = (size_t)nodes.n;
  return PLEUEL_OK;
}

const pleuel_node* pleuel_formula_tree(const pleuel_formula* f, size_t* n) {
  if (n) *n = 0;
  if (!f || !n || f->value->withdrawn || f->section->withdrawn) return NULL;
  if (!f->nodes && guarded(f, grow, NULL) != PLEUEL_OK) return NULL;
  *n = f->n_nodes;
  return f->nodes;
}

// ---------------------------------------------------------------------------------------- numbers
typedef struct pl_evaluating {
  const char* const* names;
  const double* values;
  size_t n;
  double value;
} pl_evaluating;

// The symbol of a name, in any spelling; by its ASCII name or as it is shown.
static pl_symbol symbol_named(pl_pool* p, pl_arena* a, const char* name) {
  pl_symbol s = pl_symbol_find(p, name);
  if (!s.id) s = pl_symbol_find(p, key_of(a, name));
  for (uint32_t i = 1; !s.id && i <= (uint32_t)pl_symbol_count(p); i++) {
    const pl_symbol_info* info = pl_symbol_get(p, (pl_symbol){i});
    if (info->role == PL_R_MULTIPLIER && strcmp(info->name, name) == 0) s = (pl_symbol){i};
  }
  return s;
}

static pleuel_status evaluate(pleuel_formula* f, pl_arena* a, void* argument) {
  pl_evaluating* w = argument;
  pl_pool* p = pool_of(f);
  know_free(f, a, NULL);
  pl_mark mark = pl_arena_mark(a);
  pl_expr e = spelled_out(f, a, f->expr);
  const double* known = pl_model_values(f->section->model, a);
  int count = pl_symbol_count(p);
  double* value = PL_ARRAY(a, double, count + 1);
  memcpy(value, known, ((size_t)count + 1) * sizeof *value);
  pleuel_status s = PLEUEL_OK;
  for (size_t i = 0; s == PLEUEL_OK && i < w->n; i++) {
    pl_symbol at = symbol_named(p, a, w->names[i]);
    if (!at.id)
      s = pl_fail(&f->m->job, PLEUEL_USAGE, "there is no name %s in the formulas", w->names[i]);
    else value[at.id] = w->values[i];
  }
  for (size_t i = 0; s == PLEUEL_OK && i < f->n_free; i++) {
    if (isnan(value[f->symbols[i].id]))
      s = pl_fail(&f->m->job, PLEUEL_USAGE, "%s has no value", f->free[i]);
  }
  if (s == PLEUEL_OK) w->value = pl_eval(p, e, value);
  pl_arena_rewind(a, mark);
  return s;
}

pleuel_status pleuel_formula_value(const pleuel_formula* f, const char* const* names,
                                   const double* values, size_t n, double* value) {
  if (value) *value = (double)NAN;
  if (!f || !value || (n && (!names || !values))) return PLEUEL_USAGE;
  if (f->value->withdrawn || f->section->withdrawn) return PLEUEL_USAGE;
  pl_evaluating w = {names, values, n, (double)NAN};
  pleuel_status s = guarded(f, evaluate, &w);
  *value = w.value;
  return s;
}

// ------------------------------------------------------------------------------- derivatives
typedef struct pl_deriving {
  const char* name;
  const pleuel_formula* result;
} pl_deriving;

static pleuel_status derive(pleuel_formula* f, pl_arena* a, void* argument) {
  pl_deriving* w = argument;
  pl_pool* p = pool_of(f);
  pl_symbol by = symbol_named(p, a, w->name);
  if (!by.id)
    return pl_fail(&f->m->job, PLEUEL_USAGE, "there is no name %s in the formulas", w->name);
  for (int i = 0; i < f->derivatives.n; i++) {
    if (f->derivatives.at[i]->by.id == by.id) w->result = f->derivatives.at[i];
  }
  if (w->result) return PLEUEL_OK;
  pl_expr e = pl_diff(p, spelled_out(f, a, f->expr), by);
  if (pl_is_poison(e))
    return pl_fail(&f->m->job, PLEUEL_UNSUPPORTED, "this has no derivative by %s", w->name);
  pleuel_formula* d = PL_NEW(a, pleuel_formula);
  *d = (pleuel_formula){
      .m = f->m, .section = f->section, .value = f->value, .expr = e, .by = by, .of = f};
  if (f->section->tower) d->form = pl_present(f->section->tower, e, PL_S_PLAIN, 0);
  pl_push(a, f->derivatives, d);
  w->result = d;
  return PLEUEL_OK;
}

pleuel_status pleuel_formula_derivative(const pleuel_formula* f, const char* name,
                                        const pleuel_formula** derivative) {
  if (derivative) *derivative = NULL;
  if (!f || !name || !derivative || f->value->withdrawn || f->section->withdrawn)
    return PLEUEL_USAGE;
  pl_deriving w = {name, NULL};
  pleuel_status s = guarded(f, derive, &w);
  *derivative = w.result;
  return s;
}
