// Calls: elementary functions, the special forms (norm, diff, sum, if, ...), results of
// constraints, functions of `let`.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

typedef struct call {
  const pl_ast* name;
  const pl_ast* group;  // its arguments
  int n;
} call;

bool pl_lower_is_function(const pl_lower* l, const char* key) {
  if (pl_scope_local(l, key)) return false;
  const pl_entity* e = pl_scope_find(l, key);
  if (e) return e->kind == PL_ENTITY_FUNCTION;
  return pl_word_function(key) || strcmp(key, "force") == 0 || strcmp(key, "spherical") == 0;
}

static pl_span span_of(const call* c) {
  return c->group ? pl_span_join(pl_ast_span(c->name), pl_ast_span(c->group))
                  : pl_ast_span(c->name);
}
static const pl_ast* arg(const call* c, int i) { return c->group->kids.at[i]; }

static pl_quantity wrong_count(pl_lower* l, const call* c, const char* usage) {
  // sin(0,5): a decimal comma rather than two arguments
  if (c->n == 2) {
    const pl_ast *a = pl_ast_single(arg(c, 0)), *b = pl_ast_single(arg(c, 1));
    bool comma = a && b && a->kind == PL_AST_NUMBER && b->kind == PL_AST_NUMBER
                 && a->end + 1 == b->begin;
    if (comma) {
      const char* fixed = pl_format(l->arena, "%s.%s", a->text, b->text);
      pl_diagnostic* m = pl_lower_complain(l, PL_E003, pl_span_join(pl_ast_span(a), pl_ast_span(b)),
                                           PL_BOTH("decimal comma"));
      pl_suggest(l->job, m, fixed, PL_BOTH("write %s        (Dezimalpunkt statt Komma)"), fixed);
      return pl_quantity_bad();
    }
  }
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, span_of(c),
                                       PL_BOTH("wrong number of arguments for %s: %d"),
                                       c->name->shown, c->n);
  pl_suggest(l->job, m, NULL, PL_BOTH("write %s"), usage);
  return pl_quantity_bad();
}

static bool scalar_args(pl_lower* l, const call* c, pl_expr* out) {
  bool fine = true;
  for (int i = 0; i < c->n; i++) {
    out[i] = pl_lower_scalar(l, arg(c, i));
    fine &= !pl_is_poison(out[i]);
  }
  return fine;
}

static pl_quantity checked(pl_lower* l, const call* c, pl_expr e) {
  if (pl_is_poison(e)) pl_lower_complain(l, PL_E040, span_of(c), PL_BOTH("this has no value"));
  return pl_quantity_of(e);
}

// ---------------------------------------------------------------------------- elementary functions
static int elementary(const char* key) {
  for (int i = 0; i < PL_N_FUNCTIONS; i++) {
    if (strcmp(pl_function_name[i], key) == 0) return i;
  }
  return -1;
}

static pl_expr apply_elementary(pl_lower* l, const char* key, pl_expr x) {
  if (strcmp(key, "sqrt") == 0) return pl_sqrt(l->pool, x);
  int f = strcmp(key, "log") == 0 ? PL_LN : elementary(key);
  return f >= 0 && pl_function_arity[f] == 1 ? pl_call(l->pool, (pl_function)f, x) : pl_poison();
}

static void hint_log(pl_lower* l, const pl_ast* name) {
  if (strcmp(name->key, "log") != 0 || l->log_said) return;
  l->log_said = true;
  pl_diagnostic* m = pl_lower_complain(l, PL_N072, pl_ast_span(name),
                                       PL_BOTH("log is the natural logarithm"));
  pl_suggest(l->job, m, "ln", PL_BOTH("write ln to say so"));
}

// sin 30: an angle without its sign for degrees, several turns if it is one in radians.
static void hint_degrees(pl_lower* l, const pl_ast* name, pl_expr x, const pl_ast* where) {
  bool trig = strcmp(name->key, "sin") == 0 || strcmp(name->key, "cos") == 0
              || strcmp(name->key, "tan") == 0;
  long n = 0;
  if (!trig || pl_is_poison(x) || !pl_is_int(l->pool, x, &n) || (n < 7 && n > -7)) return;
  pl_diagnostic* m = pl_lower_complain(l, PL_N021, pl_ast_span(where),
                                       PL_BOTH("%s of %ld is taken in radians"), name->shown, n);
  pl_suggest(l->job, m, NULL, PL_BOTH("write %s(%ld°) if degrees are meant"), name->shown, n);
}

static bool is_elementary_of_one(const char* key) {
  if (strcmp(key, "sqrt") == 0 || strcmp(key, "log") == 0) return true;
  int f = elementary(key);
  return f >= 0 && pl_function_arity[f] == 1;
}

static pl_quantity call_of_several(pl_lower* l, const call* c, pl_function f) {
  bool many = f == PL_MIN || f == PL_MAX;
  if (c->n < 2 || (c->n > 2 && !many))
    return wrong_count(l, c, pl_format(l->arena, "%s(a, b)", c->name->shown));
  pl_expr* x = PL_ARRAY(l->arena, pl_expr, c->n);
  if (!scalar_args(l, c, x)) return pl_quantity_bad();
  pl_expr value = x[0];
  for (int i = 1; i < c->n; i++) value = pl_call2(l->pool, f, value, x[i]);
  return checked(l, c, value);
}

// ----------------------------------------------------------------------------------------- vectors
static bool vector_args(pl_lower* l, const call* c, pl_quantity* v) {
  bool fine = true;
  for (int i = 0; i < c->n; i++) {
    v[i] = pl_lower_quantity(l, arg(c, i));
    if (!v[i].force_of && pl_quantity_is_bad(&v[i])) fine = false;
    else if (v[i].n == 0 && !v[i].force_of) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(arg(c, i)),
                                           PL_BOTH("%s takes vectors, this is a number"),
                                           c->name->shown);
      pl_suggest(l->job, m, NULL, PL_BOTH("write a vector as (a, b) or pos(A)"));
      fine = false;
    }
  }
  return fine;
}

static pl_expr dot_of(pl_lower* l, const pl_quantity* a, const pl_quantity* b) {
  pl_expr sum = pl_int(l->pool, 0);
  for (int i = 0; i < a->n; i++) sum = pl_add(l->pool, sum, pl_mul(l->pool, a->at[i], b->at[i]));
  return sum;
}

static pl_quantity call_norm(pl_lower* l, const call* c) {
  if (c->n != 1) return wrong_count(l, c, "norm(a)");
  pl_quantity v;
  if (!vector_args(l, c, &v)) return pl_quantity_bad();
  if (v.force_of)
    return pl_quantity_of(
        pl_sym(l->pool, pl_model_result_symbol(l->m, PL_RES_FORCE_NORM, v.force_of)));
  return checked(l, c, pl_sqrt(l->pool, dot_of(l, &v, &v)));
}

static bool two_vectors(pl_lower* l, const call* c, pl_quantity* v) {
  if (!vector_args(l, c, v)) return false;
  if (v[0].force_of || v[1].force_of) {
    pl_lower_complain(l, PL_E017, span_of(c),
                      PL_BOTH("of a force only its size can be used here: norm(force(...))"));
    return false;
  }
  if (v[0].n == v[1].n) return true;
  pl_lower_complain(l, PL_E017, span_of(c), PL_BOTH("the vectors have %d and %d components"),
                    v[0].n, v[1].n);
  return false;
}

static pl_quantity call_dot(pl_lower* l, const call* c) {
  pl_quantity v[2];
  if (c->n != 2) return wrong_count(l, c, "dot(a, b)");
  return two_vectors(l, c, v) ? checked(l, c, dot_of(l, &v[0], &v[1])) : pl_quantity_bad();
}

static pl_expr minor(pl_lower* l, const pl_quantity* v, int i, int j) {
  pl_pool* p = l->pool;
  return pl_sub(p, pl_mul(p, v[0].at[i], v[1].at[j]), pl_mul(p, v[0].at[j], v[1].at[i]));
}

static pl_quantity call_cross(pl_lower* l, const call* c) {
  pl_quantity v[2];
  if (c->n != 2) return wrong_count(l, c, "cross(a, b)");
  if (!two_vectors(l, c, v)) return pl_quantity_bad();
  if (v[0].n == 2) return checked(l, c, minor(l, v, 0, 1));
  return (pl_quantity){.n = 3, .at = {minor(l, v, 1, 2), minor(l, v, 2, 0), minor(l, v, 0, 1)}};
}

static pl_quantity call_polar(pl_lower* l, const call* c) {
  pl_expr x[2];
  if (c->n != 2) return wrong_count(l, c, "polar(r, φ)");
  if (!scalar_args(l, c, x)) return pl_quantity_bad();
  return (pl_quantity){.n = 2,
                       .at = {pl_mul(l->pool, x[0], pl_call(l->pool, PL_COS, x[1])),
                              pl_mul(l->pool, x[0], pl_call(l->pool, PL_SIN, x[1]))}};
}

// spherical(r, θ, φ) with θ from the third axis
static pl_quantity call_spherical(pl_lower* l, const call* c) {
  pl_expr x[3];
  pl_pool* p = l->pool;
  if (c->n != 3) return wrong_count(l, c, "spherical(r, θ, φ)");
  if (!scalar_args(l, c, x)) return pl_quantity_bad();
  pl_expr in_plane = pl_mul(p, x[0], pl_call(p, PL_SIN, x[1]));
  return (pl_quantity){.n = 3,
                       .at = {pl_mul(p, in_plane, pl_call(p, PL_COS, x[2])),
                              pl_mul(p, in_plane, pl_call(p, PL_SIN, x[2])),
                              pl_mul(p, x[0], pl_call(p, PL_COS, x[1]))}};
}

static pl_quantity call_place(pl_lower* l, const call* c, bool velocity) {
  if (c->n != 1) return wrong_count(l, c, velocity ? "vel(A)" : "pos(A)");
  const pl_ast* index;
  const pl_ast* label = pl_ast_label(arg(c, 0), &index);
  pl_point at;
  if (label == NULL) {
    pl_lower_complain(l, PL_E017, pl_ast_span(arg(c, 0)),
                      PL_BOTH("%s takes the label of a mass, body or point"), c->name->shown);
    return pl_quantity_bad();
  }
  if (!pl_lower_label_point(l, label, index, &at, NULL)) return pl_quantity_bad();
  pl_quantity q = {.n = at.n};
  for (int i = 0; i < at.n; i++) q.at[i] = velocity ? pl_dt(l->pool, at.at[i]) : at.at[i];
  if (at.n == 1) q.n = 0;
  return q;
}

// ---------------------------------------------------------------------------------------- calculus
// Names of results (T, E, force(label)) are derived when they are known.
static bool has_results(const pl_lower* l, pl_expr e) {
  for (int i = 0; i < l->m->result_names.n; i++) {
    if (pl_has_symbol(l->pool, e, l->m->result_names.at[i].symbol)) return true;
  }
  return false;
}

static pl_quantity call_diff(pl_lower* l, const call* c) {
  if (c->n != 2) return wrong_count(l, c, "diff(f, x)");
  pl_quantity f = pl_lower_quantity(l, arg(c, 0));
  pl_expr x = pl_lower_scalar(l, arg(c, 1));
  if (pl_quantity_is_bad(&f) || pl_is_poison(x)) return pl_quantity_bad();
  pl_kind kind = pl_kind_of(l->pool, x);
  if (kind != PL_SYMBOL && kind != PL_AT) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(arg(c, 1)),
                                         PL_BOTH("diff derives by a name"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write diff(f, x), or dt(f) for the time derivative"));
    return pl_quantity_bad();
  }
  for (int i = 0; i < (f.n ? f.n : 1); i++) {
    if (kind == PL_SYMBOL && has_results(l, f.at[i])) {
      f.at[i] = pl_sym(l->pool, pl_model_result_derivative(l->m, PL_RES_DIFF, f.at[i],
                                                           pl_symbol_of(l->pool, x)));
      continue;
    }
    bool of_motion = pl_has_role(l->pool, f.at[i], PL_R_MULTIPLIER)
                     || pl_has_role(l->pool, f.at[i], PL_R_ACCELERATION);
    bool own = kind == PL_SYMBOL && pl_has_symbol(l->pool, f.at[i], pl_symbol_of(l->pool, x));
    if (of_motion && !own) {
      pl_lower_complain(
          l, PL_E017, span_of(c),
          PL_BOTH("accelerations and multipliers hang on the motion and cannot be derived here"));
      return pl_quantity_bad();
    }
    f.at[i] = kind == PL_SYMBOL ? pl_diff(l->pool, f.at[i], pl_symbol_of(l->pool, x))
                                : pl_diff_at(l->pool, f.at[i], x);
  }
  return f;
}

static pl_quantity call_dt(pl_lower* l, const call* c) {
  if (c->n != 1) return wrong_count(l, c, "dt(f)");
  pl_quantity f = pl_lower_quantity(l, arg(c, 0));
  if (pl_quantity_is_bad(&f)) return f;
  for (int i = 0; i < (f.n ? f.n : 1); i++) {
    if (has_results(l, f.at[i])) {
      f.at[i] = pl_sym(l->pool,
                       pl_model_result_derivative(l->m, PL_RES_DT, f.at[i], (pl_symbol){0}));
      continue;
    }
    bool fixed = pl_has_role(l->pool, f.at[i], PL_R_MULTIPLIER)
                 || pl_has_role(l->pool, f.at[i], PL_R_ACCELERATION);
    if (!fixed) f.at[i] = pl_dt(l->pool, f.at[i]);
    if (!fixed && !pl_is_poison(f.at[i])) continue;
    pl_lower_complain(l, PL_E017, span_of(c),
                      PL_BOTH("accelerations and multipliers cannot be derived by time here"));
    return pl_quantity_bad();
  }
  return f;
}

static pl_quantity call_sum(pl_lower* l, const call* c) {
  bool shape = c->n == 2 && arg(c, 0)->kind == PL_AST_IN
               && arg(c, 0)->kids.at[1]->kind == PL_AST_RANGE;
  const pl_ast* index = shape ? pl_ast_single(arg(c, 0)->kids.at[0]) : NULL;
  if (!shape || !index || index->kind != PL_AST_NAME || index->number)
    return wrong_count(l, c, "sum(i in 1..N, x[i])");
  const pl_ast* range = arg(c, 0)->kids.at[1];
  pl_expr lo = pl_lower_scalar(l, range->kids.at[0]), hi = pl_lower_scalar(l, range->kids.at[1]);
  pl_symbol_info info = {.name = index->shown,
                         .ascii = index->key,
                         .role = PL_R_INDEX,
                         .class = PL_C_OTHER,
                         .dimension = pl_dimension_one()};
  pl_symbol i = pl_symbol_find(l->pool, index->key);
  if (i.id == 0 || pl_symbol_get(l->pool, i)->role != PL_R_INDEX) {
    if (i.id) info.ascii = pl_format(l->arena, "%s_index", index->key);
    i = pl_symbol_make(l->pool, &info);
  }
  pl_push(l->arena, l->locals, (pl_local){.key = index->key, .symbol = i});
  pl_expr body = pl_lower_scalar(l, arg(c, 1));
  l->locals.n--;
  if (pl_is_poison(lo) || pl_is_poison(hi) || pl_is_poison(body)) return pl_quantity_bad();
  return checked(l, c, pl_sum_over(l->pool, i, lo, hi, body));
}

static pl_quantity call_if(pl_lower* l, const call* c) {
  if (c->n != 3 || arg(c, 0)->kind != PL_AST_RELATION || arg(c, 0)->kids.n != 2)
    return wrong_count(l, c, "if(x > 0, a, b)");
  pl_condition test;
  bool fine = pl_lower_relation(l, arg(c, 0), &test, 0);
  pl_expr a = pl_lower_scalar(l, arg(c, 1)), b = pl_lower_scalar(l, arg(c, 2));
  if (!fine || pl_is_poison(a) || pl_is_poison(b)) return pl_quantity_bad();
  pl_expr difference = pl_sub(l->pool, test.left, test.right),
          opposite = pl_sub(l->pool, test.right, test.left);
  switch (test.relation) {
    case PL_GT: return checked(l, c, pl_if(l->pool, difference, a, b));
    case PL_LT: return checked(l, c, pl_if(l->pool, opposite, a, b));
    case PL_LE: return checked(l, c, pl_if(l->pool, difference, b, a));
    case PL_GE: return checked(l, c, pl_if(l->pool, opposite, b, a));
    default: break;
  }
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, test.span, PL_BOTH("if compares with > or <"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write if(a > b, ..., ...)"));
  return pl_quantity_bad();
}

// ----------------------------------------------------------------------------------------- results
static pl_quantity call_result(pl_lower* l, const call* c, pl_result_kind kind) {
  if (!l->results) {
    pl_lower_complain(l, PL_E057, span_of(c),
                      PL_BOTH("%s is a result: it can stand in ask, plot, event and output"),
                      c->name->shown);
    return pl_quantity_bad();
  }
  const pl_ast* index = NULL;
  const pl_ast* name = c->n == 1 ? pl_ast_label(arg(c, 0), &index) : NULL;
  if (name == NULL) return wrong_count(l, c, pl_format(l->arena, "%s(label)", c->name->shown));
  pl_ast label = {
      .kind = PL_AST_LABEL, .source = name->source, .begin = name->begin, .end = name->end};
  pl_ast* kids[2] = {(pl_ast*)(uintptr_t)name, (pl_ast*)(uintptr_t)index};
  label.kids.at = kids;
  label.kids.n = 2;
  const char* text = pl_constraint_label(l, &label);
  if (text == NULL) return pl_quantity_bad();
  pl_quantity q = pl_quantity_of(pl_sym(l->pool, pl_model_result_symbol(l->m, kind, text)));
  if (kind == PL_RES_FORCE) q.force_of = text;
  return q;
}

const char* pl_force_label(const pl_lower* l, pl_expr e) {
  if (pl_is_poison(e) || pl_kind_of(l->pool, e) != PL_SYMBOL) return NULL;
  const pl_result_name* r = pl_model_result_name(l->m, pl_symbol_of(l->pool, e));
  return r && r->kind == PL_RES_FORCE ? r->label : NULL;
}

// -------------------------------------------------------------------------------- functions of let
// A function of a finished model: its body is an expression over the symbols of its arguments.
static pl_quantity call_finished(pl_lower* l, const call* c, pl_entity* e) {
  if (c->n != e->n_args)
    return wrong_count(l, c, pl_format(l->arena, "%s with %d", e->shown, e->n_args));
  pl_replace* r = PL_ARRAY(l->arena, pl_replace, c->n + 1);
  pl_expr* x = PL_ARRAY(l->arena, pl_expr, c->n + 1);
  if (!scalar_args(l, c, x)) return pl_quantity_bad();
  for (int i = 0; i < c->n; i++) r[i] = (pl_replace){e->arguments[i], x[i]};
  return checked(l, c, pl_subst(l->pool, e->value, r, c->n));
}

static pl_quantity call_own(pl_lower* l, const call* c, pl_entity* e) {
  if (e->definition == NULL) return call_finished(l, c, e);
  const pl_ast* parameters = pl_ast_kid(e->definition, 1);
  if (c->n != parameters->kids.n)
    return wrong_count(l, c,
                       pl_source_text(l->arena, pl_span_join(e->span, pl_ast_span(parameters))));
  enum { MOST_ARGS = 16, MAX_DEPTH = 100 };
  if (c->n > MOST_ARGS)
    return wrong_count(l, c, pl_format(l->arena, "%s with fewer arguments", e->shown));
  if (e->state == 1 || l->call_depth > MAX_DEPTH) {
    if (!e->broken)
      pl_lower_complain(l, PL_E018, e->span, PL_BOTH("%s leads back to itself"), e->shown);
    e->broken = true;
    l->wrong++;
    return pl_quantity_bad();
  }
  PL_VEC(pl_local) bound = {0};
  bool fine = true;
  for (int i = 0; i < c->n; i++) {
    pl_quantity q = pl_lower_quantity(l, arg(c, i));
    fine &= !pl_quantity_is_bad(&q);
    const pl_ast* name = pl_ast_single(parameters->kids.at[i]);
    pl_local local = {.key = name ? name->key : "?", .value = q.at[0], .n = q.n};
    memcpy(local.at, q.at, sizeof local.at);
    pl_push(l->arena, bound, local);
  }
  if (!fine || e->broken) {
    l->wrong += e->broken != 0;
    return pl_quantity_bad();
  }
  // the body sees its arguments and the declarations, nothing of the place where it is called
  pl_local* outer = l->locals.at;
  int n_outer = l->locals.n, cap_outer = l->locals.cap, wrong = l->wrong;
  pl_block* block = l->block;
  bool results = l->results;
  l->locals.at = bound.at;
  l->locals.n = bound.n;
  l->locals.cap = bound.cap;
  l->block = NULL;
  l->results = true;
  e->state = 1;
  l->call_depth++;
  pl_quantity value = pl_lower_quantity(l, pl_ast_kid(e->definition, 2));
  l->call_depth--;
  e->state = 0;
  l->locals.at = outer;
  l->locals.n = n_outer;
  l->locals.cap = cap_outer;
  l->block = block;
  l->results = results;
  if (l->wrong > wrong) e->broken = true;  // its body has been complained about
  return value;
}

// ---------------------------------------------------------------------------------------- dispatch
pl_quantity pl_lower_call(pl_lower* l, const pl_ast* name, const pl_ast* group) {
  call c = {name, group, group ? group->kids.n : 0};
  if (group == NULL) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E015, pl_ast_span(name),
                                         PL_BOTH("%s needs an argument"), name->shown);
    pl_suggest(l->job, m, NULL, PL_BOTH("write %s(...)"), name->shown);
    return pl_quantity_bad();
  }
  pl_entity* e = pl_scope_find(l, name->key);
  if (e && e->kind == PL_ENTITY_FUNCTION) return call_own(l, &c, e);
  if (is_elementary_of_one(name->key)) {
    if (c.n != 1) return wrong_count(l, &c, pl_format(l->arena, "%s(x)", name->shown));
    return pl_lower_apply(l, name, pl_lower_quantity(l, arg(&c, 0)), group);
  }
  int f = elementary(name->key);
  if (f >= 0) return call_of_several(l, &c, (pl_function)f);
  static const struct {
    const char* key;
    pl_quantity (*go)(pl_lower*, const call*);
  } forms[] = {
      {"norm", call_norm}, {"dot", call_dot},     {"cross", call_cross},
      {"diff", call_diff}, {"dt", call_dt},       {"sum", call_sum},
      {"if", call_if},     {"polar", call_polar}, {"spherical", call_spherical},
  };
  for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
    if (strcmp(forms[i].key, name->key) == 0) return forms[i].go(l, &c);
  }
  if (strcmp(name->key, "pos") == 0) return call_place(l, &c, false);
  if (strcmp(name->key, "vel") == 0) return call_place(l, &c, true);
  if (strcmp(name->key, "force") == 0) return call_result(l, &c, PL_RES_FORCE);
  if (strcmp(name->key, "normal") == 0) return call_result(l, &c, PL_RES_NORMAL);
  pl_lower_complain(l, PL_E017, span_of(&c), PL_BOTH("%s belongs to a body in space"), name->shown);
  return pl_quantity_bad();
}

// A function and its one argument, with or without brackets.
pl_quantity pl_lower_apply(pl_lower* l, const pl_ast* name, pl_quantity x, const pl_ast* where) {
  if (pl_quantity_is_bad(&x)) return x;
  hint_log(l, name);
  if (!is_elementary_of_one(name->key) || pl_scope_find(l, name->key)) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E015, pl_ast_span(name),
                                         PL_BOTH("%s needs brackets"), name->shown);
    pl_suggest(l->job, m, NULL, PL_BOTH("write %s(...)"), name->shown);
    return pl_quantity_bad();
  }
  if (x.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(where),
                                         PL_BOTH("%s takes a number, this is a vector"),
                                         name->shown);
    if (strcmp(name->key, "abs") == 0) pl_suggest(l->job, m, NULL, PL_BOTH("write norm(...)"));
    return pl_quantity_bad();
  }
  hint_degrees(l, name, x.at[0], where);
  pl_expr value = apply_elementary(l, name->key, x.at[0]);
  if (pl_is_poison(value))
    pl_lower_complain(l, PL_E040, pl_ast_span(where), PL_BOTH("this has no value"));
  return pl_quantity_of(value);
}
