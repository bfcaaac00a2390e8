// Expressions as text, for the tests: see algebra_test_text.h.
#include "algebra/algebra_test_text.h"

#include <ctype.h>
#include <stdlib.h>

typedef struct pl_reader {
  pl_world* w;
  const char* at;
} pl_reader;

pl_symbol pl_text_symbol(pl_world* w, const char* name) {
  pl_symbol s = pl_symbol_find(w->pool, name);
  if (s.id) return s;
  bool free = strchr("xyzuvabtp", name[0]) != NULL;
  pl_symbol_info info = {.name = name, .ascii = name, .dimension = pl_dimension_one()};
  info.role = free ? PL_R_COORD : PL_R_PARAM;
  info.class = free             ? PL_C_COORD
               : name[0] == 'm' ? PL_C_MASS
               : name[0] == 'g' ? PL_C_GRAVITY
                                : PL_C_LENGTH;
  info.sign = free ? PL_SIGN_ANY : PL_SIGN_POSITIVE;
  info.name = info.ascii = pl_copy(w->arena, name);
  return pl_symbol_make(w->pool, &info);
}

static pl_expr read_sum(pl_reader* r);

static bool taken(pl_reader* r, char c) {
  while (*r->at == ' ') r->at++;
  if (*r->at != c) return false;
  r->at++;
  return true;
}

static pl_expr read_call(pl_reader* r, const char* name) {
  pl_expr a = read_sum(r), b = pl_poison();
  if (taken(r, ',')) b = read_sum(r);
  assert_true(taken(r, ')'));
  if (strcmp(name, "sqrt") == 0) return pl_sqrt(r->w->pool, a);
  for (int f = 0; f < PL_N_FUNCTIONS; f++) {
    if (strcmp(name, pl_function_name[f]) != 0) continue;
    return pl_function_arity[f] == 2 ? pl_call2(r->w->pool, (pl_function)f, a, b)
                                     : pl_call(r->w->pool, (pl_function)f, a);
  }
  fail_msg("no function %s", name);
  return pl_poison();
}

static pl_expr read_atom(pl_reader* r) {
  if (taken(r, '(')) {
    pl_expr e = read_sum(r);
    assert_true(taken(r, ')'));
    return e;
  }
  size_t n = 0;
  if (isdigit((unsigned char)*r->at)) {
    while (isdigit((unsigned char)r->at[n]) || r->at[n] == '.') n++;
    r->at += n;
    return pl_number_from_text(r->w->pool, r->at - n, n);
  }
  while (isalnum((unsigned char)r->at[n]) || r->at[n] == '_') n++;
  if (n == 0) fail_msg("cannot read '%s'", r->at);
  const char* name = pl_copy_n(r->w->arena, r->at, n);
  r->at += n;
  if (taken(r, '(')) return read_call(r, name);
  if (strcmp(name, "pi") == 0) return pl_pi(r->w->pool);
  return pl_sym(r->w->pool, pl_text_symbol(r->w, name));
}

static pl_expr read_sign(pl_reader* r) {
  if (taken(r, '-')) return pl_neg(r->w->pool, read_sign(r));
  pl_expr base = read_atom(r);
  if (!taken(r, '^')) return base;
  bool minus = taken(r, '-');
  while (*r->at == ' ') r->at++;
  pl_expr exponent = read_atom(r);
  return pl_pow(r->w->pool, base, minus ? pl_neg(r->w->pool, exponent) : exponent);
}

static pl_expr read_product(pl_reader* r) {
  pl_expr e = read_sign(r);
  for (;;) {
    if (taken(r, '*')) e = pl_mul(r->w->pool, e, read_sign(r));
    else if (taken(r, '/')) e = pl_div(r->w->pool, e, read_sign(r));
    else return e;
  }
}

static pl_expr read_sum(pl_reader* r) {
  pl_expr e = read_product(r);
  for (;;) {
    if (taken(r, '+')) e = pl_add(r->w->pool, e, read_product(r));
    else if (taken(r, '-')) e = pl_sub(r->w->pool, e, read_product(r));
    else return e;
  }
}

pl_expr pl_text_expr(pl_world* w, const char* text) {
  pl_reader r = {w, text};
  return read_sum(&r);
}

// ------------------------------------------------------------------------------------------ worlds
pl_world* pl_world_make(const char* facts) {
  pl_arena* a = pl_arena_make(NULL);
  pl_world* w = PL_NEW(a, pl_world);
  w->arena = a;
  w->pool = pl_pool_make(a);
  w->job.arena = a;
  pl_fact list[16];
  int n = 0;
  char* rest = pl_copy(a, facts ? facts : "");
  for (char* one = strtok(rest, ","); one && n < 16; one = strtok(NULL, ",")) {
    list[n++] = (pl_fact){pl_text_expr(w, one), true};
  }
  w->tower = pl_tower_make(&w->job, w->pool, list, n);
  return w;
}

void pl_world_free(pl_world* w) {
  pl_tower_free(w->tower);
  pl_arena_free(w->arena);
}

const char* pl_text_of(pl_world* w, pl_expr e) {
  return pl_is_poison(e) ? "poison" : pl_expr_text(w->arena, w->pool, e);
}

const char* pl_text_normal(pl_world* w, const char* text) {
  return pl_text_of(w, pl_alg_normal(w->tower, pl_text_expr(w, text)));
}

void pl_assert_zero(pl_world* w, const char* text) {
  pl_answer3 zero = pl_alg_is_zero(w->tower, pl_text_expr(w, text));
  if (zero != PL_YES) fail_msg("%s should be zero, answer %d", text, zero);
}

void pl_assert_not_zero(pl_world* w, const char* text) {
  pl_answer3 zero = pl_alg_is_zero(w->tower, pl_text_expr(w, text));
  if (zero != PL_NO) fail_msg("%s should not be zero, answer %d", text, zero);
}

// ------------------------------------------------------------------------------ random expressions
static pl_expr random_leaf(pl_world* w, pl_random* r) {
  static const char* const names[] = {"x", "y", "m1", "m2", "l"};
  uint64_t k = pl_random_bits(r) % 8;
  if (k < 5) return pl_sym(w->pool, pl_text_symbol(w, names[k]));
  return pl_int(w->pool, (long)(pl_random_bits(r) % 7) + 1);
}

pl_expr pl_random_expr(pl_world* w, pl_random* r, int depth) {
  pl_pool* p = w->pool;
  if (depth == 0) return random_leaf(w, r);
  pl_expr a = pl_random_expr(w, r, depth - 1), b = pl_random_expr(w, r, depth - 1);
  switch (pl_random_bits(r) % 9) {
    case 0:
    case 1: return pl_add(p, a, b);
    case 2: return pl_sub(p, a, b);
    case 3:
    case 4: return pl_mul(p, a, b);
    case 5: return pl_div(p, a, pl_add(p, pl_square(p, b), pl_int(p, 1)));
    case 6: return pl_call(p, pl_random_bits(r) % 2 ? PL_SIN : PL_COS, random_leaf(w, r));
    case 7: return pl_sqrt(p, pl_add(p, pl_square(p, a), pl_int(p, 2)));
    default: return pl_pow_int(p, a, 2);
  }
}
