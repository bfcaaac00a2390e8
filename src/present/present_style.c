// How each kind of quantity is written: the rules that no cost function finds (K1 to K3).
//
//   energies    one term for each monomial of velocities (momenta), squares first, ½ distributed;
//               what does not move is separated by masses, gravity and other parameters: K1
//   equations   accelerations, velocities, forces, one term each: K2
//   quotients   one fraction, but two forces of different kind stay a sum,
//               as m g cos ϑ - m R ϑ'²: K3
//   solutions   a sum by powers and functions of time.
#include "present/present_impl.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_STYLE_TERMS = 60 };

typedef struct term_list {
  pl_present_search* s;
  int n;
  pl_prod at[MAX_STYLE_TERMS];
  bool full;
} term_list;

static void put(term_list* l, pl_prod x) {
  if (pl_prod_is_zero(l->s, x)) return;
  if (l->n == MAX_STYLE_TERMS) l->full = true;
  else pl_terms_add(l->s, x, l->at, &l->n);
}

// The same with a bare bracket opened.
static void put_opened(term_list* l, pl_prod x) {
  pl_prod terms[PL_OPENED_TERMS];
  int n = 0;
  pl_terms_put(l->s, x, terms, &n);
  for (int i = 0; i < n; i++) put(l, terms[i]);
}

// -------------------------------------------------------------------------- what a product is like
static bool is_plain(pl_prod x) {
  for (int i = 0; i < x.n; i++)
    if (x.at[i].sum) return false;
  return true;
}

static bool has_root_or_bracket(pl_prod x) {
  for (int i = 0; i < x.n; i++)
    if (x.at[i].sum || x.at[i].base->kind == PL_F_ROOT) return true;
  return false;
}

// A coefficient that is better written as one term for each mass: some bracket holds roots or
// further brackets.
static bool is_overloaded(pl_prod x) {
  for (int i = 0; i < x.n; i++) {
    const pl_sum_terms* sum = x.at[i].sum;
    if (!sum || x.at[i].power != 1) continue;
    for (int k = 0; k < sum->n; k++)
      if (has_root_or_bracket(sum->at[k])) return true;
  }
  return false;
}

static int only_sum(pl_prod x) {
  int found = -1;
  for (int i = 0; i < x.n; i++) {
    if (!x.at[i].sum) continue;
    if (found >= 0 || x.at[i].power != 1) return -1;
    found = i;
  }
  return found;
}

static bool has_pure_number(const pl_sum_terms* sum) {
  for (int i = 0; i < sum->n; i++)
    if (sum->at[i].n == 0) return true;
  return false;
}

static pl_prod times_rest(pl_present_search* s, pl_prod x, int i, pl_prod y) {
  pl_prod rest = pl_prod_mul(s, x, pl_prod_piece(s, x.at[i], -x.at[i].power));
  return pl_prod_mul(s, rest, y);
}

// Adds a(b + c) as a b + a c where the bracket is a plain sum of quantities; m g l (1 - cos θ) and
// (m1 + m2) g stay.
static void put_distributed(term_list* l, pl_prod x) {
  pl_present_search* s = l->s;
  int i = only_sum(x);
  bool keep = i < 0 || has_pure_number(x.at[i].sum) || x.at[i].bucket < PL_K_PARAM_SUM
              || x.at[i].sum->n > 6;
  if (keep) {
    put(l, x);
    return;
  }
  for (int k = 0; k < x.at[i].sum->n; k++) put(l, times_rest(s, x, i, x.at[i].sum->at[k]));
}

// ------------------------------------------------------------------------------------------ groups
typedef struct style_group {
  pl_frac part;
  const ulong* key;
} style_group;

// f by its monomials in the generators in[]: the part that goes with each, with the monomial or
// without. 0 if there are too many.
static int groups_of(pl_present_search* s, pl_frac f, const bool* in, bool with_key,
                     style_group* out) {
  pl_term_group* groups;
  int n = pl_poly_group(s, f.num, in, &groups);
  if (n > MAX_STYLE_TERMS) return 0;
  for (int i = 0; i < n; i++) {
    out[i].part = pl_frac_part(s, f,
                               with_key ? pl_group_poly(s, &groups[i]) : groups[i].coefficient);
    out[i].key = groups[i].key;
  }
  return n;
}

static bool is_unit_key(pl_present_search* s, const ulong* key) {
  for (int g = 0; g < s->t->gens.n; g++)
    if (key[g]) return false;
  return true;
}

static void mask_of(pl_present_search* s, const pl_key_set* sets, int n, bool* in) {
  bool one[PL_MAX_GENERATORS];
  memset(in, 0, PL_MAX_GENERATORS * sizeof *in);
  for (int k = 0; k < n; k++) {
    memset(one, 0, sizeof one);
    pl_key_mask(s, sets[k], one);
    for (int g = 0; g < s->t->gens.n; g++) in[g] |= one[g];
  }
}

// -------------------------------------------------------------------------- energies and equations
static void put_by_mass(term_list* l, pl_frac f, pl_prod key, int depth) {
  pl_present_search* s = l->s;
  static const pl_key_set by_mass[] = {PL_KEY_MASS};
  bool in[PL_MAX_GENERATORS];
  mask_of(s, by_mass, 1, in);
  style_group group[MAX_STYLE_TERMS];
  int n = groups_of(s, f, in, true, group);
  for (int i = 0; i < n; i++)
    put(l, pl_prod_mul(s, key, pl_present_quotient(s, group[i].part, depth)));
  if (n == 0) put(l, pl_prod_mul(s, key, pl_present_quotient(s, f, depth)));
}

// Everything that goes with one monomial of velocities: one term, or one for each mass when that is
// more than a reader takes in at once.
static void put_kinetic(term_list* l, pl_frac f, const ulong* key, int depth) {
  pl_present_search* s = l->s;
  pl_prod monomial = pl_prod_of_exponents(s, pl_int(s->p, 1), key);
  pl_prod whole = pl_prod_mul(s, monomial, pl_present_quotient(s, f, depth));
  if (is_overloaded(whole)) put_by_mass(l, f, monomial, depth);
  else put(l, whole);
}

static void put_parts(term_list* l, pl_frac f, const pl_key_set* sets, int n_sets, bool distribute,
                      int depth) {
  pl_present_search* s = l->s;
  bool in[PL_MAX_GENERATORS];
  mask_of(s, sets, n_sets, in);
  style_group group[MAX_STYLE_TERMS];
  int n = groups_of(s, f, in, true, group);
  if (n == 0) l->full = true;
  for (int i = 0; i < n; i++) {
    pl_prod x = pl_present_quotient(s, group[i].part, depth);
    if (distribute) put_distributed(l, x);
    else put_opened(l, x);
  }
}

static long list_cost(const term_list* l) {
  long cost = 0;
  for (int i = 0; i < l->n; i++) cost += l->at[i].cost + 2;
  return cost;
}

// (m1 - m2) g x: a difference of masses is no natural factor of an energy.
static bool has_mass_difference(const term_list* l) {
  for (int i = 0; i < l->n; i++) {
    for (int k = 0; k < l->at[i].n; k++) {
      const pl_piece* f = &l->at[i].at[k];
      if (!f->sum || f->bucket != PL_K_MASS) continue;
      for (int j = 0; j < f->sum->n; j++)
        if (pl_prod_is_negative(l->s, f->sum->at[j])) return true;
    }
  }
  return false;
}

// Potentials and forces: by gravity and other parameters as plain sums, (m1 + m2) g l1 cos α + ...,
// or by masses too, m1 g x + m2 g (l - x), whichever is shorter.
static void put_static(term_list* l, pl_frac f, int depth) {
  static const pl_key_set sets[] = {PL_KEY_MASS, PL_KEY_GRAVITY, PL_KEY_OTHER};
  term_list* by_mass = PL_NEW(l->s->a, term_list);
  term_list* by_kind = PL_NEW(l->s->a, term_list);
  by_mass->s = by_kind->s = l->s;
  put_parts(by_mass, f, sets, 3, false, depth);
  put_parts(by_kind, f, sets + 1, 2, true, depth);
  bool heaps = l->s->style == PL_S_ENERGY && has_mass_difference(by_kind);
  bool shorter = heaps || list_cost(by_mass) <= list_cost(by_kind);
  const term_list* best = by_kind->full || (!by_mass->full && shorter) ? by_mass : by_kind;
  if (best->full) put(l, pl_present_quotient(l->s, f, depth));
  else
    for (int i = 0; i < best->n; i++) put(l, best->at[i]);
}

static int motion_rank(pl_present_search* s, const pl_prod* x) {
  // squares and products of velocities of two coordinates: the squares first, then the products,
  // then what is linear
  int pieces = 0, total = 0;
  for (int i = 0; i < x->n; i++) {
    if (x->at[i].bucket != PL_K_VELOCITY && x->at[i].bucket != PL_K_ACCELERATION) continue;
    pieces++;
    total += abs(x->at[i].power);
  }
  if (total == 0) return 3;
  return total >= 2 ? (pieces == 1 ? 0 : 1) : 2;
}

// The coordinate that moves in a term: terms stand in the order in which the model declares its
// coordinates.
static uint32_t moving_coordinate(pl_present_search* s, const pl_prod* x) {
  for (int i = 0; i < x->n; i++) {
    if (x->at[i].bucket != PL_K_VELOCITY && x->at[i].bucket != PL_K_ACCELERATION) continue;
    if (!x->at[i].lead.id) return 0;
    const pl_symbol_info* info = pl_symbol_get(s->p, x->at[i].lead);
    return info->base.id ? info->base.id : x->at[i].lead.id;
  }
  return 0;
}

static bool goes_before(pl_present_search* s, const pl_prod* x, const pl_prod* y) {
  int rx = motion_rank(s, x), ry = motion_rank(s, y);
  if (s->style == PL_S_EQUATION) {
    int mx = pl_prod_motion(s, *x), my = pl_prod_motion(s, *y);
    if (mx != my) return mx > my;
  }
  if (rx != ry) return rx < ry;
  uint32_t a = moving_coordinate(s, x), b = moving_coordinate(s, y);
  if (a != b && a && b) return a < b;
  return pl_terms_compare(s, x, y) < 0;
}

static void sort_terms(term_list* l) {
  for (int i = 1; i < l->n; i++) {
    pl_prod x = l->at[i];
    int k = i;
    for (; k > 0 && goes_before(l->s, &x, &l->at[k - 1]); k--) l->at[k] = l->at[k - 1];
    l->at[k] = x;
  }
}

// A sum with a leading minus takes its first positive term to the front, if no term moves past a
// kinetic one.
static void avoid_leading_minus(term_list* l) {
  if (l->n < 2 || !pl_prod_is_negative(l->s, l->at[0])) return;
  int i = 1;
  while (i < l->n && pl_prod_is_negative(l->s, l->at[i])) i++;
  if (i == l->n || motion_rank(l->s, &l->at[i]) != motion_rank(l->s, &l->at[0])) return;
  pl_prod x = l->at[i];
  memmove(l->at + 1, l->at, (size_t)i * sizeof *l->at);
  l->at[0] = x;
}

// ---------------------------------------------------------------------------------------------- ½
static pl_expr half(pl_present_search* s) { return pl_ratio(s->p, 1, 2); }

static bool is_half(pl_present_search* s, pl_prod x) {
  pl_expr size = pl_prod_is_negative(s, x) ? pl_neg(s->p, x.unit) : x.unit;
  return pl_same(size, half(s));
}

// All terms with ½ begin with the symbol of one mass, and not all with the same: m1/2 r² φ'² + m2/2
// ...
static bool mass_takes_half(term_list* l) {
  const pl_form* first = NULL;
  bool several = false;
  for (int i = 0; i < l->n; i++) {
    pl_prod x = l->at[i];
    if (!is_half(l->s, x)) continue;
    if (x.n == 0 || x.at[0].bucket != PL_K_MASS || x.at[0].sum || x.at[0].power != 1) return false;
    if (first && x.at[0].base != first) several = true;
    first = x.at[0].base;
  }
  return several;
}

// m1/2 r² φ'²: the ½ under the first factor.
static const pl_form* halved_first_factor(pl_present_search* s, pl_prod x) {
  bool minus = pl_prod_is_negative(s, x);
  x.unit = pl_int(s->p, 1);
  const pl_form* f = pl_prod_form(s, x);
  if (f->kind != PL_F_PRODUCT) return NULL;
  const pl_form** all = PL_ARRAY(s->a, const pl_form*, f->n);
  memcpy(all, f->args, (size_t)f->n * sizeof *all);
  all[0] = pl_form_quotient(s->a, f->args[0], pl_form_leaf(s->a, pl_int(s->p, 2)));
  const pl_form* r = pl_form_product(s->a, all, f->n);
  return minus ? pl_form_neg(s->a, r) : r;
}

static const pl_form* energy_form(term_list* l) {
  pl_present_search* s = l->s;
  bool into_mass = mass_takes_half(l);
  const pl_form** f = PL_ARRAY(s->a, const pl_form*, l->n);
  for (int i = 0; i < l->n; i++) {
    f[i] = into_mass && is_half(s, l->at[i]) && !pl_prod_has_denominator(l->at[i])
               ? halved_first_factor(s, l->at[i])
               : NULL;
    if (!f[i]) f[i] = pl_prod_form_with(s, l->at[i], true);
  }
  return l->n == 1 ? f[0] : pl_form_sum(s->a, f, l->n);
}

static bool moving_denominator(pl_present_search* s, pl_frac f) {
  for (int i = 0; i < f.n; i++) {
    int use[PL_MAX_GENERATORS], n = 0;
    pl_poly_used(s->t, pl_base_poly(s->t, f.den[i].base), use, &n);
    for (int k = 0; k < n; k++)
      if (pl_gen_in_key(s, use[k], PL_KEY_MOTION)) return true;
  }
  return false;
}

// A product that is the whole formula: -(a + b) becomes -a - b.
static const pl_form* whole_form(pl_present_search* s, pl_prod x) {
  bool bare = x.n == 1 && x.at[0].sum && x.at[0].power == 1
              && pl_is_one_node(s->p, pl_neg(s->p, x.unit));
  if (!bare) return pl_prod_form(s, x);
  const pl_sum_terms* sum = x.at[0].sum;
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, sum->n);
  for (int i = 0; i < sum->n; i++) terms[i] = pl_prod_neg(s, sum->at[i]);
  pl_terms_sort(s, terms, sum->n);
  // -m g (2 - 3 cos ϑ) - m v²/R -> m g (3 cos ϑ - 2) - m v²/R
  if (pl_prod_is_negative(s, terms[0])) terms[0] = pl_prod_flip(s, terms[0]);
  return pl_terms_form(s, terms, sum->n);
}

static const pl_form* plain(pl_present_search* s, pl_frac f, int depth, long* cost) {
  pl_prod x = pl_prod_flip(s, pl_present_quotient(s, f, depth));
  *cost = x.cost;
  return whole_form(s, x);
}

// The terms of f whose highest derivative is `order`: 2 accelerations, 1 velocities and momenta, 0
// the rest.
static const pl_poly* terms_of_order(pl_present_search* s, const pl_poly* f, int order) {
  pl_tower* t = s->t;
  pl_poly* part = pl_poly_new(t);
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, f, i, &t->ctx);
    int highest = 0;
    for (int g = 0; g < t->gens.n; g++) {
      if (!exponent[g]) continue;
      pl_bucket b = pl_piece_of_gen(s, g).bucket;
      int here = b == PL_K_ACCELERATION ? 2 : b == PL_K_VELOCITY || b == PL_K_MULTIPLIER ? 1 : 0;
      if (here > highest) highest = here;
    }
    if (highest == order) fmpz_mpoly_push_term_fmpz_ui(part, &f->coeffs[i], exponent, &t->ctx);
  }
  return part;
}

// (x1 - x2) (x1'' - x2''), (x1' - x2')²
static bool is_product_of_sums(pl_prod x) {
  int sums = 0;
  for (int i = 0; i < x.n; i++)
    if (x.at[i].sum && x.at[i].power > 0) sums += x.at[i].power;
  return sums >= 2;
}

// A part of an equation written in products of brackets, as constraints of distances differentiated
// twice are: 2 (x1 - x2) (x1'' - x2'') + 2 (y1 - y2) (y1'' - y2''), when all of it can be.
static bool put_products(term_list* l, pl_frac part, int depth) {
  pl_present_search* s = l->s;
  pl_prod x = pl_present_quotient(s, part, depth);
  int i = only_sum(x);
  if (i < 0 || is_product_of_sums(x)) {
    if (!is_product_of_sums(x)) return false;
    put(l, x);
    return true;
  }
  const pl_sum_terms* sum = x.at[i].sum;
  for (int k = 0; k < sum->n; k++)
    if (!is_product_of_sums(sum->at[k])) return false;
  for (int k = 0; k < sum->n; k++) put(l, times_rest(s, x, i, sum->at[k]));
  return true;
}

// f by monomials of accelerations and velocities, one term each.
static void put_by_motion(term_list* l, pl_frac f, int depth) {
  pl_present_search* s = l->s;
  static const pl_key_set motion[] = {PL_KEY_MOTION};
  bool in[PL_MAX_GENERATORS];
  mask_of(s, motion, 1, in);
  style_group group[MAX_STYLE_TERMS];
  int n = groups_of(s, f, in, false, group);
  if (n == 0) l->full = true;
  for (int i = 0; i < n; i++) {
    if (is_unit_key(s, group[i].key)) put_static(l, group[i].part, depth);
    else put_kinetic(l, group[i].part, group[i].key, depth);
  }
}

static const pl_form* by_motion(pl_present_search* s, pl_frac f, int depth, long* cost) {
  if (moving_denominator(s, f)) return plain(s, f, depth, cost);
  term_list l = {.s = s};
  if (s->style == PL_S_ENERGY) {
    put_by_motion(&l, f, depth);
  } else {
    for (int order = 2; order >= 0; order--) {
      const pl_poly* terms = terms_of_order(s, f.num, order);
      if (terms->length == 0) continue;
      pl_frac part = pl_frac_part(s, f, terms);
      if (order == 0 || !put_products(&l, part, depth)) put_by_motion(&l, part, depth);
    }
  }
  if (l.full) return plain(s, f, depth, cost);
  sort_terms(&l);
  avoid_leading_minus(&l);
  *cost = list_cost(&l);
  return s->style == PL_S_ENERGY ? energy_form(&l) : pl_terms_form(s, l.at, l.n);
}

// --------------------------------------------------------------------------------------- quotients
// m (g cos ϑ - R ϑ'²) -> m g cos ϑ - m R ϑ'²: forces of different kind under one short factor, no
// denominator.
static bool is_sum_of_forces(pl_present_search* s, pl_prod x, int* bracket) {
  int i = only_sum(x);
  if (i < 0 || pl_prod_has_denominator(x) || x.n > 3 || x.at[i].sum->n > 3) return false;
  const pl_sum_terms* sum = x.at[i].sum;
  bool differ = false;
  for (int k = 0; k < sum->n; k++) {
    if (!is_plain(sum->at[k]) || sum->at[k].n == 0 || pl_prod_has_denominator(sum->at[k]))
      return false;
    differ |= pl_prod_motion(s, sum->at[k]) != pl_prod_motion(s, sum->at[0]);
  }
  bool plain_front = true;
  for (int k = 0; k < x.n; k++)
    if (k != i && (x.at[k].bucket > PL_K_OTHER || x.at[k].power != 1)) plain_front = false;
  *bracket = i;
  return differ && plain_front && x.n > 1;
}

static const pl_form* quotient(pl_present_search* s, pl_frac f, int depth, long* cost) {
  pl_prod x = pl_prod_flip(s, pl_present_quotient(s, f, depth));
  *cost = x.cost;
  int i;
  if (!is_sum_of_forces(s, x, &i)) return whole_form(s, x);
  int n = x.at[i].sum->n;
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, n);
  for (int k = 0; k < n; k++) terms[k] = times_rest(s, x, i, x.at[i].sum->at[k]);
  pl_terms_sort(s, terms, n);
  return pl_terms_form(s, terms, n);
}

// --------------------------------------------------------------------------------------- solutions
enum { LAST_RANK = 40 };

static long time_rank(pl_present_search* s, const ulong* key) {
  long power = 0;
  for (int g = 0; g < s->t->gens.n; g++) {
    if (!key[g]) continue;
    if (pl_piece_of_gen(s, g).bucket != PL_K_TIME) return LAST_RANK;
    power += (long)key[g];
  }
  return power < LAST_RANK ? power : LAST_RANK;
}

// Of the constant terms x(0) comes first.
static void start_first(term_list* l) {
  for (int i = 1; i < l->n; i++) {
    pl_prod x = l->at[i];
    if (x.n != 1 || x.at[0].bucket != PL_K_START || pl_prod_is_negative(l->s, x)) continue;
    memmove(l->at + 1, l->at, (size_t)i * sizeof *l->at);
    l->at[0] = x;
    return;
  }
}

static const pl_form* by_time(pl_present_search* s, pl_frac f, int depth, long* cost) {
  bool in[PL_MAX_GENERATORS] = {false};
  pl_key_mask(s, PL_KEY_TIME, in);
  for (int i = 0; i < f.n; i++) {
    int use[PL_MAX_GENERATORS], n = 0;
    pl_poly_used(s->t, pl_base_poly(s->t, f.den[i].base), use, &n);
    for (int k = 0; k < n; k++)
      if (in[use[k]]) return plain(s, f, depth, cost);
  }
  style_group group[MAX_STYLE_TERMS];
  int n = groups_of(s, f, in, true, group);
  if (n == 0) return plain(s, f, depth, cost);
  term_list l = {.s = s};
  // ascending powers of t, functions of t behind them
  for (long rank = 0; rank <= LAST_RANK; rank++) {
    for (int i = 0; i < n; i++)
      if (time_rank(s, group[i].key) == rank)
        put_opened(&l, pl_present_quotient(s, group[i].part, depth));
    if (rank == 0) start_first(&l);
  }
  *cost = list_cost(&l);
  return pl_terms_form(s, l.at, l.n);
}

const pl_form* pl_present_styled(pl_present_search* s, pl_frac f, int depth, long* cost) {
  if (pl_poly_is_zero(s->t, f.num)) {
    *cost = 0;
    return pl_form_leaf(s->a, pl_int(s->p, 0));
  }
  switch (s->style) {
    case PL_S_ENERGY:
    case PL_S_EQUATION: return by_motion(s, f, depth, cost);
    case PL_S_QUOTIENT: return quotient(s, f, depth, cost);
    case PL_S_SOLUTION: return by_time(s, f, depth, cost);
    case PL_S_PLAIN: break;
  }
  return plain(s, f, depth, cost);
}
