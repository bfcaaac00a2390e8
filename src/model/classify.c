// What the names of a checked model are: assumed signs and classes.
//
// Masses, inertias, stiffnesses, rest lengths and g are positive because they are used as such; any
// other parameter is positive unless its number or an `assume` says otherwise (design: symbolic.md,
// section 6).
#include "model_impl.h"

#include <math.h>

// ------------------------------------------------------------------------------------- assumptions
// name > 0, 0 < name, name >= 0 ... : the sign that an assumption gives to a plain name.
static void sign_of_relation(const pl_pool* p, const pl_condition* c, pl_symbol* s,
                             pl_sign_known* sign) {
  bool left = pl_kind_of(p, c->left) == PL_SYMBOL && pl_is_number(p, c->right);
  bool right = pl_kind_of(p, c->right) == PL_SYMBOL && pl_is_number(p, c->left);
  *s = (pl_symbol){0};
  if (!left && !right) return;
  pl_expr number = left ? c->right : c->left;
  int n = pl_number_sign(p, number);
  pl_relation r = c->relation;
  if (right)
    r = r == PL_GE ? PL_LE : r == PL_LE ? PL_GE : r == PL_GT ? PL_LT : r == PL_LT ? PL_GT : r;
  pl_sign_known found = PL_SIGN_ANY;
  if ((r == PL_GT && n >= 0) || (r == PL_GE && n > 0)) found = PL_SIGN_POSITIVE;
  if (r == PL_GE && n == 0) found = PL_SIGN_NONNEGATIVE;
  if ((r == PL_LT && n <= 0) || (r == PL_LE && n < 0)) found = PL_SIGN_NEGATIVE;
  if (r == PL_LE && n == 0) found = PL_SIGN_NONPOSITIVE;
  if (r == PL_NE && n == 0) found = PL_SIGN_NONZERO;
  if (found == PL_SIGN_ANY) {
    // name < 5 or name > -5: the default no longer holds, the name may have either sign
    if ((r == PL_GT || r == PL_GE) && n < 0) found = PL_SIGN_ANY;
    else return;
  }
  *s = pl_symbol_of(p, left ? c->left : c->right);
  *sign = found;
}

static void sign_of_range(const pl_pool* p, const pl_assumption* a, pl_symbol* s,
                          pl_sign_known* sign) {
  *s = (pl_symbol){0};
  if (pl_is_poison(a->subject) || pl_kind_of(p, a->subject) != PL_SYMBOL) return;
  if (pl_is_poison(a->lo) || pl_is_poison(a->hi) || !pl_is_number(p, a->lo)
      || !pl_is_number(p, a->hi))
    return;
  int lo = pl_number_sign(p, a->lo), hi = pl_number_sign(p, a->hi);
  *s = pl_symbol_of(p, a->subject);
  *sign = lo > 0    ? PL_SIGN_POSITIVE
          : lo == 0 ? PL_SIGN_NONNEGATIVE
          : hi < 0  ? PL_SIGN_NEGATIVE
          : hi == 0 ? PL_SIGN_NONPOSITIVE
                    : PL_SIGN_ANY;
}

// The sign that the file assumes for a name; false: it says nothing.
static bool assumed_sign(const pl_model* m, pl_symbol of, pl_sign_known* sign) {
  bool any = false;
  for (int i = 0; i < m->assumptions.n; i++) {
    const pl_assumption* a = &m->assumptions.at[i];
    pl_symbol s = {0};
    pl_sign_known found = PL_SIGN_ANY;
    if (a->kind == PL_A_RELATION) sign_of_relation(m->pool, &a->condition, &s, &found);
    if (a->kind == PL_A_IN) sign_of_range(m->pool, a, &s, &found);
    if (s.id != of.id || !s.id) continue;
    *sign = found;
    any = true;
  }
  return any;
}

// ------------------------------------------------------------------------------------------- signs
static void set_default_signs(pl_model* m) {
  pl_arena* a = pl_pool_arena(m->pool);
  const double* value = pl_model_values(m, a);
  for (int i = 0; i < m->params.n; i++) {
    pl_symbol s = m->params.at[i].symbol;
    pl_symbol_info* info = pl_symbol_get(m->pool, s);
    pl_sign_known sign = PL_SIGN_ANY;
    double x = value[s.id];
    bool given = !pl_is_poison(m->params.at[i].value);
    if (assumed_sign(m, s, &sign)) info->sign = sign;
    else info->sign = given && !(x > 0) ? PL_SIGN_ANY : PL_SIGN_POSITIVE;
  }
  // a kept abbreviation is a given quantity, but a difference of positive ones may be negative:
  // only its number tells
  for (int i = 0; i < m->lets.n; i++) {
    pl_symbol s = m->lets.at[i].symbol;
    if (m->lets.at[i].inserted || m->lets.at[i].n_args || !s.id) continue;
    pl_sign_known sign;
    pl_symbol_get(m->pool, s)->sign = assumed_sign(m, s, &sign) ? sign
                                      : value[s.id] > 0         ? PL_SIGN_POSITIVE
                                                                : PL_SIGN_ANY;
  }
  for (int i = 0; i < m->coords.n; i++) {
    pl_sign_known sign;
    if (assumed_sign(m, m->coords.at[i].symbol, &sign))
      pl_symbol_get(m->pool, m->coords.at[i].symbol)->sign = sign;
  }
}

// A plain name used where only something positive makes sense.
static void positive(pl_model* m, pl_expr e) {
  if (pl_is_poison(e) || pl_kind_of(m->pool, e) != PL_SYMBOL) return;
  pl_symbol_info* info = pl_symbol_get(m->pool, pl_symbol_of(m->pool, e));
  if (info->role != PL_R_PARAM) return;
  // a number that is given and not positive has been reported or is allowed (g = 0): nothing is
  // claimed about it
  const pl_param* p = pl_model_param(m, pl_symbol_of(m->pool, e));
  if (p && !pl_is_poison(p->value) && info->sign == PL_SIGN_ANY) return;
  info->sign = PL_SIGN_POSITIVE;
}

static void set_used_signs(pl_model* m) {
  for (int i = 0; i < m->masses.n; i++) positive(m, m->masses.at[i].mass);
  for (int i = 0; i < m->bodies.n; i++) {
    positive(m, m->bodies.at[i].mass);
    positive(m, m->bodies.at[i].inertia);
  }
  for (int i = 0; i < m->gravities.n; i++) positive(m, m->gravities.at[i].g);
  for (int i = 0; i < m->loads.n; i++) {
    if (m->loads.at[i].kind != PL_L_SPRING) continue;
    positive(m, m->loads.at[i].value);
    positive(m, m->loads.at[i].rest);
  }
}

// ----------------------------------------------------------------------------------------- classes
static void set_class(pl_model* m, pl_expr e, pl_class class) {
  if (pl_is_poison(e) || pl_kind_of(m->pool, e) != PL_SYMBOL) return;
  pl_symbol_info* info = pl_symbol_get(m->pool, pl_symbol_of(m->pool, e));
  bool name = pl_is_poison(info->number);  // a number with its unit stands where numbers stand
  if (name && (info->role == PL_R_PARAM || info->role == PL_R_LOCAL)) info->class = class;
}

// Use wins over dimension: what stands in a mass statement is a mass even without units.
static void set_used_classes(pl_model* m) {
  for (int i = 0; i < m->masses.n; i++) set_class(m, m->masses.at[i].mass, PL_C_MASS);
  for (int i = 0; i < m->bodies.n; i++) {
    set_class(m, m->bodies.at[i].mass, PL_C_MASS);
    set_class(m, m->bodies.at[i].inertia, PL_C_MASS);
  }
  for (int i = 0; i < m->gravities.n; i++) set_class(m, m->gravities.at[i].g, PL_C_GRAVITY);
  for (int i = 0; i < m->loads.n; i++) {
    if (m->loads.at[i].kind == PL_L_SPRING) set_class(m, m->loads.at[i].rest, PL_C_LENGTH);
  }
}

void pl_classify_symbols(pl_model* m) {
  set_default_signs(m);
  set_used_signs(m);
  set_used_classes(m);
}
