// An expression in the names of a finished model: for --set, for tests, for expect from outside.
#include "lang/lower_impl.h"

#include <string.h>

static void add_entity(pl_lower* l, pl_symbol s, pl_entity_kind kind) {
  const pl_symbol_info* info = pl_symbol_get(l->pool, s);
  pl_entity* e = PL_NEW(l->arena, pl_entity);
  *e = (pl_entity){.kind = kind,
                   .key = pl_intern(l->names, info->ascii),
                   .shown = info->name,
                   .symbol = s,
                   .state = 2,
                   .value = pl_sym(l->pool, s)};
  if (pl_scope_find(l, e->key) == NULL) pl_scope_add(l, e);
}

// The arguments of `let f(u, v)` are the symbols u_of_f, v_of_f, made in this order
// (lower_declare.c).
static void add_function(pl_lower* l, const pl_let* let) {
  const char* ending = pl_format(l->arena, "_of_%s", pl_symbol_get(l->pool, let->symbol)->ascii);
  pl_symbol* arguments = PL_ARRAY(l->arena, pl_symbol, let->n_args);
  int n = 0;
  for (int i = 1; i <= pl_symbol_count(l->pool) && n < let->n_args; i++) {
    const char* ascii = pl_symbol_get(l->pool, (pl_symbol){(uint32_t)i})->ascii;
    size_t length = strlen(ascii), tail = strlen(ending);
    if (length > tail && strcmp(ascii + length - tail, ending) == 0)
      arguments[n++] = (pl_symbol){(uint32_t)i};
  }
  if (n < let->n_args) return;
  add_entity(l, let->symbol, PL_ENTITY_FUNCTION);
  pl_entity* e = pl_scope_find(l, pl_intern(l->names, pl_symbol_get(l->pool, let->symbol)->ascii));
  e->value = let->value;
  e->n_args = n;
  e->arguments = arguments;
}

static void add_lets(pl_lower* l) {
  for (int i = 0; i < l->m->lets.n; i++) {
    const pl_let* let = &l->m->lets.at[i];
    if (let->symbol.id == 0) continue;
    if (let->n_args) {
      add_function(l, let);
      continue;
    }
    add_entity(l, let->symbol, PL_ENTITY_LET);
    pl_entity* e = pl_scope_find(l,
                                 pl_intern(l->names, pl_symbol_get(l->pool, let->symbol)->ascii));
    if (e == NULL || e->symbol.id != let->symbol.id) continue;
    e->inserted = let->inserted;
    e->value = let->inserted ? let->value : pl_sym(l->pool, let->symbol);
    e->at[0] = e->value;
  }
}

static void add_place(pl_lower* l, pl_site_kind kind, const pl_name* name, const pl_point* at,
                      pl_expr angle, pl_block* block) {
  pl_site* p = PL_NEW(l->arena, pl_site);
  *p = (pl_site){.kind = kind,
                 .key = pl_intern(l->names, name->ascii),
                 .shown = name->text,
                 .state = 2,
                 .index = name->index,
                 .point = *at,
                 .angle = angle,
                 .block = block};
  pl_push(l->arena, l->places, p);
}

static void add_places(pl_lower* l) {
  const pl_model* m = l->m;
  for (int i = 0; i < m->masses.n; i++)
    add_place(l, PL_SITE_MASS, &m->masses.at[i].name, &m->masses.at[i].point, pl_poison(),
              m->masses.at[i].block);
  for (int i = 0; i < m->bodies.n; i++)
    add_place(l, PL_SITE_BODY, &m->bodies.at[i].name, &m->bodies.at[i].centre,
              m->bodies.at[i].angle, m->bodies.at[i].block);
  for (int i = 0; i < m->points.n; i++)
    add_place(l, PL_SITE_POINT, &m->points.at[i].name, &m->points.at[i].point, pl_poison(),
              m->points.at[i].block);
}

static void add_rules(pl_lower* l) {
  for (int i = 0; i < l->m->constraints.n; i++) {
    const pl_constraint* c = &l->m->constraints.at[i];
    pl_rule r = {.key = pl_intern(l->names, c->name.ascii),
                 .shown = c->name.text,
                 .generated = c->name.generated,
                 .lambda = c->lambda,
                 .family = c->block || !pl_is_poison(c->name.index)};
    pl_spelled s;
    size_t bad;
    if (c->multiplier
        && pl_spell(l->arena, l->names, c->multiplier, strlen(c->multiplier), &s, &bad)) {
      r.with = s.key;
      r.with_shown = c->multiplier;
    }
    if (pl_scope_rule(l, r.key) == NULL) pl_push(l->arena, l->rules, r);
  }
}

void pl_lower_from_model(pl_lower* l) {
  const pl_model* m = l->m;
  for (int i = 0; i < m->params.n; i++)
    if (!m->params.at[i].literal) add_entity(l, m->params.at[i].symbol, PL_ENTITY_PARAM);
  for (int i = 0; i < m->coords.n; i++) {
    add_entity(l, m->coords.at[i].symbol,
               pl_is_poison(m->coords.at[i].lo) ? PL_ENTITY_COORD : PL_ENTITY_FAMILY);
  }
  // small quantities and indices that the text introduced
  for (int i = 1; i <= pl_symbol_count(l->pool); i++) {
    pl_symbol s = {(uint32_t)i};
    if (pl_symbol_get(l->pool, s)->role == PL_R_SMALL) add_entity(l, s, PL_ENTITY_SMALL);
    if (pl_symbol_get(l->pool, s)->role == PL_R_INDEX) add_entity(l, s, PL_ENTITY_INDEX);
  }
  add_lets(l);
  add_places(l);
  add_rules(l);
}

pleuel_status pl_lang_expression(pl_job* job, pl_model* m, const char* text, pl_expr* out) {
  *out = pl_poison();
  int before = job->diagnostics->n_errors;
  pl_names* names = pl_names_make(job->arena);
  pl_source* source = pl_source_make(job->arena, "<expression>", pl_copy(job->arena, text),
                                     strlen(text));
  pl_parse* p = PL_NEW(job->arena, pl_parse);
  pl_ast* node = pl_parse_expression(p, job, names, source);
  if (node == NULL || job->diagnostics->n_errors > before) return PLEUEL_MODEL_ERROR;
  pl_lower* l = pl_lower_make(job, m, names);
  pl_lower_from_model(l);
  l->results = l->infinity = true;
  *out = pl_lower_scalar(l, node);
  if (m->checked && !pl_is_poison(*out)) *out = pl_unit_to_si(m->pool, *out);
  return job->diagnostics->n_errors > before || pl_is_poison(*out) ? PLEUEL_MODEL_ERROR : PLEUEL_OK;
}
