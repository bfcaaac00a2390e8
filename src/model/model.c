// The model as a container: making it, finding things in it, its numbers.
#include "model_impl.h"

#include <stdlib.h>
#include <string.h>

pl_model* pl_model_make(pl_arena* a) {
  pl_model* m = PL_NEW(a, pl_model);
  m->pool = pl_pool_make(a);
  pl_time(m->pool);
  return m;
}

// ----------------------------------------------------------------------------------------- lookups
const pl_param* pl_model_param(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->params.n; i++) {
    if (m->params.at[i].symbol.id == s.id && s.id) return &m->params.at[i];
  }
  return NULL;
}

// "c[3]" is the member 3 of the family c: splits it.  false: no index.
static bool split_label(const char* label, size_t* stem, long* index) {
  const char* open = strchr(label, '[');
  if (!open) return false;
  char* end;
  *index = strtol(open + 1, &end, 10);
  *stem = (size_t)(open - label);
  return end > open + 1 && end[0] == ']' && end[1] == 0;
}

// How well a name answers to a label: 2 itself, 1 the family that it may belong to, 0 not at all.
static int answers(const pl_model* m, const pl_name* name, const char* label) {
  if (!name->text || !label) return 0;
  bool has_index = !pl_is_poison(name->index);
  if (strcmp(name->text, label) == 0 || (name->ascii && strcmp(name->ascii, label) == 0)) return 2;
  size_t stem;
  long index, own;
  if (!has_index || !split_label(label, &stem, &index)) return 0;
  if (strlen(name->text) != stem || strncmp(name->text, label, stem) != 0) return 0;
  if (pl_is_int(m->pool, name->index, &own)) return own == index ? 2 : 0;
  return 1;
}

const pl_constraint* pl_model_constraint(const pl_model* m, const char* label) {
  const pl_constraint* found = NULL;
  for (int i = 0; i < m->constraints.n; i++) {
    int k = answers(m, &m->constraints.at[i].name, label);
    if (k == 2) return &m->constraints.at[i];
    if (k == 1) found = &m->constraints.at[i];
  }
  return found;
}

// Whether a label speaks of a constraint: of itself, or of the family it stands in.
static bool speaks_of(const pl_model* m, const char* label, const pl_constraint* c) {
  if (answers(m, &c->name, label) == 2) return true;
  const char* open = label ? strchr(label, '[') : NULL;
  size_t stem = open ? (size_t)(open - label) : label ? strlen(label) : 0;
  // "c" and "c[i]" of a block speak of the family c
  return label && c->block && c->name.text && strlen(c->name.text) == stem
         && strncmp(c->name.text, label, stem) == 0
         && (!open || answers(m, &c->name, label) == 1 || strspn(open + 1, "0123456789-") == 0);
}

const pl_restitution* pl_model_restitution(const pl_model* m, const pl_constraint* c) {
  for (int i = 0; i < m->restitutions.n; i++)
    if (speaks_of(m, m->restitutions.at[i].label, c)) return &m->restitutions.at[i];
  return NULL;
}

const pl_friction* pl_model_friction(const pl_model* m, const pl_constraint* c) {
  for (int i = 0; i < m->frictions.n; i++)
    if (speaks_of(m, m->frictions.at[i].label, c)) return &m->frictions.at[i];
  return NULL;
}

const pl_mass* pl_model_mass(const pl_model* m, const char* label) {
  const pl_mass* found = NULL;
  for (int i = 0; i < m->masses.n; i++) {
    int k = answers(m, &m->masses.at[i].name, label);
    if (k == 2) return &m->masses.at[i];
    if (k == 1) found = &m->masses.at[i];
  }
  return found;
}

// -------------------------------------------------------------------------------- names of results
static const char* result_text(pl_arena* a, pl_result_kind kind, const char* label) {
  switch (kind) {
    case PL_RES_T: return "T";
    case PL_RES_V: return "V";
    case PL_RES_L: return "L";
    case PL_RES_E: return "E";
    case PL_RES_H: return "H";
    case PL_RES_FORCE: return pl_format(a, "force(%s)", label ? label : "");
    case PL_RES_FORCE_NORM: return pl_format(a, "norm(force(%s))", label ? label : "");
    case PL_RES_NORMAL: return pl_format(a, "normal(%s)", label ? label : "");
    case PL_RES_DT: return pl_format(a, "dt(%s)", label ? label : "");
    case PL_RES_DIFF: return pl_format(a, "diff(%s)", label ? label : "");
    case PL_RES_START: return pl_format(a, "%s(0)", label ? label : "");
  }
  return "?";
}

static bool is_declared(const pl_model* m, const char* name) {
  for (int i = 0; i < m->params.n; i++)
    if (strcmp(pl_symbol_get(m->pool, m->params.at[i].symbol)->name, name) == 0) return true;
  for (int i = 0; i < m->coords.n; i++)
    if (strcmp(pl_symbol_get(m->pool, m->coords.at[i].symbol)->name, name) == 0) return true;
  for (int i = 0; i < m->lets.n; i++)
    if (m->lets.at[i].symbol.id
        && strcmp(pl_symbol_get(m->pool, m->lets.at[i].symbol)->name, name) == 0)
      return true;
  return false;
}

const char* pl_model_letter(const pl_model* m, pl_arena* a, const char* letter) {
  static const char* const others[][2] = {{"T", "T_kin"}, {"V", "V_pot"}, {"L", "L_Lag"},
                                          {"E", "E_tot"}, {"H", "H_Ham"}, {"J", "J_Jac"},
                                          {"M", "M_eff"}, {"Z", "F_Z"}};
  if (!is_declared(m, letter)) return letter;
  const char* other = letter;
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    if (strcmp(others[i][0], letter) == 0) other = others[i][1];
  while (is_declared(m, other)) other = pl_format(a, "%s_", other);
  return other;
}

const char* pl_model_column(const pl_model* m, pl_arena* a, const char* letter) {
  for (int i = 0; i < m->coords.n; i++)
    if (strcmp(pl_symbol_get(m->pool, m->coords.at[i].symbol)->ascii, letter) == 0)
      return pl_model_letter(m, a, letter);
  return letter;
}

// The ASCII name cannot be that of a declared quantity: a parameter T and the kinetic energy T live
// side by side.
static pl_symbol result_symbol(pl_model* m, pl_result_kind kind, const char* label,
                               const char* shown_label) {
  pl_arena* a = pl_pool_arena(m->pool);
  const char* text = result_text(a, kind, label);
  for (int i = 0; i < m->result_names.n; i++) {
    const pl_result_name* r = &m->result_names.at[i];
    if (r->kind == kind
        && (r->label == label || (r->label && label && strcmp(r->label, label) == 0)))
      return r->symbol;
  }
  const char* ascii = pl_symbol_find(m->pool, text).id ? pl_format(a, "%s_result", text) : text;
  pl_symbol_info info = {.name = pl_model_letter(m, a, result_text(a, kind, shown_label)),
                         .ascii = ascii,
                         .role = PL_R_LOCAL,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_one()};
  pl_symbol s = pl_symbol_make(m->pool, &info);
  pl_push(a, m->result_names,
          (pl_result_name){.symbol = s, .kind = kind, .label = label ? pl_copy(a, label) : NULL});
  return s;
}

pl_symbol pl_model_result_symbol(pl_model* m, pl_result_kind kind, const char* label) {
  return result_symbol(m, kind, label, label);
}

// A derivative carries the name of what it is derived from; its primes are added.
static const char* shown_name(const pl_model* m, pl_arena* a, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(m->pool, s);
  const char* primes = info->role == PL_R_VELOCITY       ? "'"
                       : info->role == PL_R_ACCELERATION ? "''"
                                                         : "";
  return pl_format(a, "%s%s", info->name, primes);
}

// diff(T, φ'), in ASCII diff(T, phi_dot).
pl_symbol pl_model_result_derivative(pl_model* m, pl_result_kind kind, pl_expr of, pl_symbol by) {
  pl_arena* a = pl_pool_arena(m->pool);
  const char* text = pl_expr_text(a, m->pool, of);
  const char* shown = pl_kind_of(m->pool, of) == PL_SYMBOL
                          ? shown_name(m, a, pl_symbol_of(m->pool, of))
                          : text;
  if (kind == PL_RES_DIFF) {
    text = pl_format(a, "%s, %s", text, pl_symbol_get(m->pool, by)->ascii);
    shown = pl_format(a, "%s, %s", shown, shown_name(m, a, by));
  }
  pl_symbol s = result_symbol(m, kind, text, shown);
  for (int i = 0; i < m->result_names.n; i++) {
    pl_result_name* r = &m->result_names.at[i];
    if (r->symbol.id != s.id) continue;
    r->of = of;
    r->by = by;
  }
  return s;
}

const pl_result_name* pl_model_result_name(const pl_model* m, pl_symbol s) {
  for (int i = 0; i < m->result_names.n; i++) {
    if (m->result_names.at[i].symbol.id == s.id && s.id) return &m->result_names.at[i];
  }
  return NULL;
}

// ----------------------------------------------------------------------------------------- numbers
// Parameters and kept abbreviations may be given through others, in any order: each is evaluated
// after those it needs. A circle has no value.
typedef struct value_pass {
  const pl_model* m;
  pl_arena* arena;
  double* value;
  pl_expr* given;  // what is written behind the name, by symbol id; poison: nothing
  char* state;     // by symbol id: 0 new, 1 on the way, 2 done
} value_pass;

static void evaluate_name(value_pass* v, pl_symbol first) {
  PL_VEC(pl_symbol) stack = {0};
  pl_push(v->arena, stack, first);
  while (stack.n) {
    pl_symbol s = stack.at[stack.n - 1];
    pl_expr given = v->given[s.id];
    if (v->state[s.id] == 2 || pl_is_poison(given)) {
      v->state[s.id] = 2;
      stack.n--;
      continue;
    }
    if (v->state[s.id] == 1) {  // what it needs is done, or part of a circle
      v->value[s.id] = pl_eval(v->m->pool, given, v->value);
      v->state[s.id] = 2;
      stack.n--;
      continue;
    }
    v->state[s.id] = 1;
    int n = pl_symbols_in(v->m->pool, given, NULL, 0);
    pl_symbol* needs = PL_ARRAY(v->arena, pl_symbol, n + 1);
    pl_symbols_in(v->m->pool, given, needs, n);
    for (int i = 0; i < n; i++) {
      if (!pl_is_poison(v->given[needs[i].id]) && v->state[needs[i].id] == 0)
        pl_push(v->arena, stack, needs[i]);
    }
  }
}

// The first declaration counts; a second one is an error of the text.
static void give(value_pass* v, pl_symbol s, pl_expr value) {
  if (s.id && pl_is_poison(v->given[s.id])) v->given[s.id] = value;
}

static void give_all(value_pass* v) {
  const pl_model* m = v->m;
  for (int i = 0; i < m->params.n; i++) give(v, m->params.at[i].symbol, m->params.at[i].value);
  for (int i = 0; i < m->lets.n; i++) {
    const pl_let* l = &m->lets.at[i];
    if (l->n_args == 0 && !l->inserted) give(v, l->symbol, l->value);
  }
}

double* pl_model_values(const pl_model* m, pl_arena* a) {
  int n = pl_symbol_count(m->pool) + 1;
  value_pass v = {m, a, PL_ARRAY(a, double, n), PL_ARRAY(a, pl_expr, n), PL_ARRAY(a, char, n)};
  for (int i = 0; i < n; i++) v.value[i] = PL_NAN;
  for (int i = 1; i < n; i++) {
    const pl_symbol_info* info = pl_symbol_get(m->pool, (pl_symbol){(uint32_t)i});
    if (!pl_is_poison(info->number)) v.value[i] = pl_eval(m->pool, info->number, v.value);
    else if (pl_unit_is_symbol(m->pool, (pl_symbol){(uint32_t)i})) v.value[i] = 1;
  }
  give_all(&v);
  for (int i = 1; i < n; i++) {
    if (!pl_is_poison(v.given[i])) evaluate_name(&v, (pl_symbol){(uint32_t)i});
  }
  return v.value;
}

pl_expr* pl_model_definitions(const pl_model* m, pl_arena* a) {
  value_pass v = {.m = m, .arena = a, .given = PL_ARRAY(a, pl_expr, pl_symbol_count(m->pool) + 1)};
  give_all(&v);
  return v.given;
}
