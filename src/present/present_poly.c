// The most readable form of a polynomial: the smallest of
//   its factors, in each view of the trigonometric pairs (c² or 1 - s²);
//   the sums obtained by collecting it by classes of symbols, each coefficient presented in turn;
//   the factors it has when a radicand is recognised (l² -> w² + r² s² for w = √(l² - r² s²));
//   its Fourier form.
// Results are remembered by polynomial and depth. A polynomial that is met again while it is being
// worked on is only expanded.
#include "present/present_impl.h"

#include <stdlib.h>
#include <string.h>

enum {
  MAX_VIEWS = 8,             // of one polynomial: three pairs in both views
  MAX_LEFT_EXPANDED = 4,     // products that may be shorter multiplied out
  MAX_COLLECT_TERMS = 150,   // beyond it a sum is factored and collected once by what moves
  MAX_EXPANDED_TERMS = 3000  // beyond it no form is sought at all
};

// ------------------------------------------------------------------------------------------ groups
bool pl_gen_in_key(pl_present_search* s, int gen, pl_key_set set) {
  pl_gen_kind kind = s->t->gens.at[gen].kind;
  if (set == PL_KEY_ROOT) return kind == PL_G_ROOT;
  pl_bucket b = pl_piece_of_gen(s, gen).bucket;
  switch (set) {
    case PL_KEY_MOTION: return b == PL_K_VELOCITY || b == PL_K_ACCELERATION || b == PL_K_MULTIPLIER;
    case PL_KEY_MASS: return b == PL_K_MASS;
    case PL_KEY_GRAVITY: return b == PL_K_GRAVITY;
    case PL_KEY_OTHER: return b == PL_K_OTHER && kind == PL_G_SYMBOL;
    case PL_KEY_LENGTH: return b == PL_K_LENGTH;
    case PL_KEY_COORD: return b == PL_K_COORD || b == PL_K_START;
    case PL_KEY_FUNCTION: return kind == PL_G_COS || kind == PL_G_SIN || b == PL_K_FUNCTION;
    case PL_KEY_TIME: return pl_has_symbol(s->p, s->t->gens.at[gen].expr, pl_time(s->p));
    default: return false;
  }
}

void pl_key_mask(pl_present_search* s, pl_key_set set, bool* in) {
  for (int g = 0; g < s->t->gens.n; g++) in[g] = pl_gen_in_key(s, g, set);
}

static pl_term_group* find_group(pl_present_search* s, pl_term_group* groups, int* n,
                                 const ulong* key) {
  size_t size = (size_t)s->t->gens.n * sizeof *key;
  for (int i = 0; i < *n; i++)
    if (memcmp(groups[i].key, key, size) == 0) return &groups[i];
  pl_term_group* g = &groups[(*n)++];
  g->key = PL_ARRAY(s->a, ulong, s->t->capacity);
  memcpy(g->key, key, size);
  g->coefficient = pl_poly_new(s->t);
  return g;
}

int pl_poly_group(pl_present_search* s, const pl_poly* f, const bool* in, pl_term_group** out) {
  pl_tower* t = s->t;
  pl_term_group* groups = PL_ARRAY(s->a, pl_term_group, f->length + 1);
  int n = 0;
  ulong rest[PL_MAX_GENERATORS], key[PL_MAX_GENERATORS];
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(rest, f, i, &t->ctx);
    for (int g = 0; g < t->gens.n; g++) {
      key[g] = in[g] ? rest[g] : 0;
      rest[g] -= key[g];
    }
    // dividing equal keys out keeps the terms in order
    fmpz_mpoly_push_term_fmpz_ui(find_group(s, groups, &n, key)->coefficient, &f->coeffs[i], rest,
                                 &t->ctx);
  }
  *out = groups;
  return n;
}

// -------------------------------------------------------------------------------------- candidates
static void keep_best(pl_prod* best, pl_prod x, bool* have) {
  if (*have && best->cost <= x.cost) return;
  *best = x;
  *have = true;
}

static pl_prod monomial(pl_present_search* s, const pl_poly* f, slong i) {
  ulong exponent[PL_MAX_GENERATORS];
  fmpz_mpoly_get_term_exp_ui(exponent, f, i, &s->t->ctx);
  return pl_prod_of_exponents(s, pl_fmpz_expr(s->t, &f->coeffs[i]), exponent);
}

static pl_prod expanded(pl_present_search* s, const pl_poly* f) {
  if (f->length > MAX_EXPANDED_TERMS) pl_tower_give_up(s->t);
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, f->length + 1);
  for (slong i = 0; i < f->length; i++) terms[i] = monomial(s, f, i);
  s->work += f->length / 4;
  return pl_prod_sum(s, terms, (int)f->length);
}

// The sum of f collected by the generators in[]; false when that changes nothing.
static bool collected(pl_present_search* s, const pl_poly* f, const bool* in, int depth,
                      pl_prod* out) {
  pl_term_group* groups;
  int n = pl_poly_group(s, f, in, &groups), n_terms = 0;
  if (n <= 1 || n == f->length) return false;
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, PL_OPENED_TERMS * n);
  pl_expr one = pl_int(s->p, 1);
  for (int i = 0; i < n; i++) {
    pl_prod coefficient = pl_present_poly(s, groups[i].coefficient, depth - 1);
    pl_terms_put(s, pl_prod_mul(s, pl_prod_of_exponents(s, one, groups[i].key), coefficient), terms,
                 &n_terms);
  }
  *out = pl_prod_sum(s, terms, n_terms);
  return true;
}

static bool within_budget(const pl_present_search* s) { return s->work < s->limit; }

// -------------------------------------------------------------------------------------------- sums
static void sums_by_class(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best,
                          bool* have) {
  static const pl_key_set sets[] = {PL_KEY_MASS,   PL_KEY_MOTION, PL_KEY_GRAVITY,  PL_KEY_OTHER,
                                    PL_KEY_LENGTH, PL_KEY_COORD,  PL_KEY_FUNCTION, PL_KEY_ROOT};
  int n = f->length > MAX_COLLECT_TERMS ? 2 : (int)(sizeof sets / sizeof *sets);
  for (int k = 0; k < n && within_budget(s); k++) {
    bool in[PL_MAX_GENERATORS] = {false};
    pl_key_mask(s, sets[k], in);
    pl_prod x;
    if (collected(s, f, in, depth, &x)) keep_best(best, x, have);
  }
}

static void sums_by_symbol(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best,
                           bool* have) {
  if (f->length > 30) return;
  int use[PL_MAX_GENERATORS], n = 0;
  pl_poly_used(s->t, f, use, &n);
  for (int k = 0; k < n && within_budget(s); k++) {
    bool in[PL_MAX_GENERATORS] = {false};
    in[use[k]] = true;
    pl_prod x;
    if (collected(s, f, in, depth, &x)) keep_best(best, x, have);
  }
}

// Generators that meet in a term belong together, and so do sin and cos of an angle: marks the
// component of each by its smallest member.
static void find_components(pl_present_search* s, const pl_poly* f, int* component) {
  pl_tower* t = s->t;
  for (int g = 0; g < t->gens.n; g++) {
    int partner = t->gens.at[g].partner;
    component[g] = partner >= 0 && partner < g ? partner : g;
  }
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, f, i, &t->ctx);
    int first = -1;
    for (int g = 0; g < t->gens.n; g++) {
      if (!exponent[g]) continue;
      if (first < 0) first = component[g];
      int a = component[g] < first ? component[g] : first,
          b = component[g] < first ? first : component[g];
      for (int k = 0; a != b && k < t->gens.n; k++)
        if (component[k] == b) component[k] = a;
      first = a;
    }
  }
}

// The sum of the parts of f that share no generator: x1² - 2 x1 x2 + x2² + y1² - ... = (x1 - x2)² +
// (y1 - y2)².
static bool sum_of_components(pl_present_search* s, const pl_poly* f, int depth, pl_prod* out) {
  pl_tower* t = s->t;
  int component[PL_MAX_GENERATORS], n = 0;
  find_components(s, f, component);
  pl_poly* part[PL_MAX_GENERATORS + 1] = {NULL};
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, f, i, &t->ctx);
    int c = PL_MAX_GENERATORS;  // the constant
    for (int g = 0; g < t->gens.n; g++)
      if (exponent[g]) c = component[g];
    if (!part[c]) {
      part[c] = pl_poly_new(t);
      n++;
    }
    fmpz_mpoly_push_term_fmpz_ui(part[c], &f->coeffs[i], exponent, &t->ctx);
  }
  if (n < 2 || n == f->length) return false;
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, PL_OPENED_TERMS * n);
  int n_terms = 0;
  for (int c = 0; c <= PL_MAX_GENERATORS; c++)
    if (part[c]) pl_terms_put(s, pl_present_poly(s, part[c], depth), terms, &n_terms);
  *out = pl_prod_sum(s, terms, n_terms);
  return true;
}

static void sums(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best, bool* have) {
  if (f->length <= MAX_EXPANDED_TERMS) keep_best(best, expanded(s, f), have);
  pl_prod parts;
  if (f->length <= MAX_COLLECT_TERMS && sum_of_components(s, f, depth, &parts))
    keep_best(best, parts, have);
  if (f->length < 3 || depth < 1) return;
  sums_by_class(s, f, depth, best, have);
  if (depth >= 2) sums_by_symbol(s, f, depth - 1, best, have);
}

// ----------------------------------------------------------------------------------------- factors
static bool is_trivial(pl_factored f) { return f.n == 1 && f.at[0].power == 1; }

static pl_prod factors_product(pl_present_search* s, pl_factored f, int depth) {
  pl_prod product = pl_prod_number(s, pl_fmpz_expr(s->t, f.unit));
  for (int i = 0; i < f.n; i++) {
    pl_prod x = pl_present_poly(s, pl_base_poly(s->t, f.at[i].base), depth);
    product = pl_prod_mul(s, product, pl_prod_pow(s, x, f.at[i].power));
  }
  return product;
}

static pl_factored factor(pl_present_search* s, const pl_poly* f) {
  s->work += 2 + f->length / 4;
  return pl_factored_merge_pairs(s->t, pl_poly_factor(s->t, f));
}

// Both views of every pair whose square occurs; the polynomial itself comes first.
static int views(pl_present_search* s, const pl_poly* f, const pl_poly** out) {
  pl_tower* t = s->t;
  int n = 1, pairs = 0;
  out[0] = f;
  for (int g = 0; g < t->gens.n && pairs < 3; g++) {
    pl_gen_kind kind = t->gens.at[g].kind;
    if (kind != PL_G_COS && kind != PL_G_SINH) continue;
    int before = n;
    for (int i = 0; i < before && n < MAX_VIEWS; i++) {
      const pl_poly* v = pl_poly_view(t, out[i], g);
      if (!pl_poly_equal(t, v, out[i])) out[n++] = v;
    }
    pairs += n > before;
  }
  return n;
}

// One view: its factors, or the sums of it when it has none.
static void present_view(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best,
                         bool* have) {
  if (f->length > MAX_EXPANDED_TERMS) return;
  if (f->length == 0) {
    // the relations, which are not applied everywhere on the way, make it vanish in this view
    keep_best(best, pl_prod_number(s, pl_int(s->p, 0)), have);
    return;
  }
  pl_factored factors = factor(s, f);
  if (!is_trivial(factors)) {
    keep_best(best, factors_product(s, factors, depth), have);
    // l² - x² beside (l + x) (l - x)
    if (f->length <= MAX_LEFT_EXPANDED) keep_best(best, expanded(s, f), have);
  } else if (pl_fmpz_expr(s->t, factors.unit).id == pl_int(s->p, 1).id) {
    sums(s, f, depth, best, have);
  } else {
    pl_prod x = pl_present_poly(s, pl_base_poly(s->t, factors.at[0].base), depth);
    keep_best(best, pl_prod_scale(s, x, pl_fmpz_expr(s->t, factors.unit)), have);
  }
}

// --------------------------------------------------------------------------------------- radicands
// f with v² replaced by what w² = P says of it, for a term ±v² of P; NULL where it does not apply.
static const pl_poly* reraised(pl_present_search* s, const pl_poly* f, int w,
                               const pl_poly* radicand, slong term) {
  pl_tower* t = s->t;
  if (!fmpz_is_pm1(&radicand->coeffs[term])) return NULL;
  ulong exponent[PL_MAX_GENERATORS];
  fmpz_mpoly_get_term_exp_ui(exponent, radicand, term, &t->ctx);
  int v = -1;
  for (int g = 0; g < t->gens.n; g++) {
    if (exponent[g] == 0) continue;
    if (exponent[g] != 2 || v >= 0) return NULL;
    v = g;
  }
  if (v < 0 || pl_poly_degree(t, f, v) < 2) return NULL;
  // v² = ±(w² - P) + v²
  const pl_poly* rest = pl_poly_sub(t, pl_poly_gen_power(t, w, 2), radicand);
  if (fmpz_sgn(&radicand->coeffs[term]) < 0) rest = pl_poly_neg(t, rest);
  const pl_poly* value = pl_poly_add(t, rest, pl_poly_gen_power(t, v, 2));
  if (pl_poly_degree(t, value, v) != 0) return NULL;
  return pl_poly_eliminate(t, f, v, 2, value);
}

static void reraise(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best, bool* have) {
  pl_tower* t = s->t;
  for (int w = 0; w < t->gens.n && within_budget(s); w++) {
    const pl_gen* g = &t->gens.at[w];
    if (g->kind != PL_G_ROOT || g->degree != 2 || pl_poly_degree(t, f, w) != 1
        || g->value->length > 12)
      continue;
    const pl_poly* radicands[MAX_VIEWS];
    int n = views(s, g->value, radicands);
    for (int k = 0; k < n; k++) {
      for (slong i = 0; i < radicands[k]->length; i++) {
        const pl_poly* raised = reraised(s, f, w, radicands[k], i);
        if (!raised || raised->length == 0 || raised->length > MAX_EXPANDED_TERMS
            || pl_poly_equal(t, raised, f))
          continue;
        pl_factored factors = factor(s, raised);
        if (!is_trivial(factors)) keep_best(best, factors_product(s, factors, depth), have);
      }
    }
  }
}

bool pl_poly_root_divides(pl_present_search* s, const pl_poly* f, int w, const pl_poly** rest) {
  pl_tower* t = s->t;
  const pl_gen* g = &t->gens.at[w];
  if (g->kind != PL_G_ROOT || g->degree != 2 || g->value->length > 12) return false;
  const pl_poly* radicands[MAX_VIEWS];
  int n = views(s, g->value, radicands);
  for (int k = 0; k < n; k++) {
    for (slong i = 0; i < radicands[k]->length; i++) {
      const pl_poly* raised = reraised(s, f, w, radicands[k], i);
      s->work++;
      if (raised && pl_poly_divides(t, rest, raised, pl_poly_gen(t, w))) return true;
    }
  }
  return false;
}

// ------------------------------------------------------------------------------------------ memory
static pl_present_found* recall(pl_present_search* s, const pl_poly* f, int depth, uint64_t* key) {
  *key = pl_hash_mix(pl_poly_hash(s->t, f), (uint64_t)depth) | 1;
  for (;; *key += 2) {
    uint64_t at = pl_map_get(s->found_at, *key);
    if (!at) return NULL;
    pl_present_found* found = &s->found.at[at - 1];
    if (found->depth == depth && pl_poly_equal(s->t, found->poly, f)) return found;
  }
}

static pl_prod search_poly(pl_present_search* s, const pl_poly* f, int depth) {
  // thousands of sums inside sums: the form of the depth before stands
  pl_tower_charge(s->t, 200 + 20 * f->length);
  pl_prod best = {0};
  bool have = false;
  const pl_poly* v[MAX_VIEWS];
  int n = f->length <= MAX_COLLECT_TERMS ? views(s, f, v) : 1;
  v[0] = f;
  for (int i = 0; i < n; i++) present_view(s, v[i], depth, &best, &have);
  if (!have) keep_best(&best, expanded(s, f), &have);
  reraise(s, f, depth, &best, &have);
  pl_prod wave;
  if (pl_present_fourier(s, f, depth, &wave)) keep_best(&best, wave, &have);
  return best;
}

pl_prod pl_present_poly(pl_present_search* s, const pl_poly* f, int depth) {
  if (f->length == 0) return pl_prod_number(s, pl_int(s->p, 0));
  if (f->length == 1) return monomial(s, f, 0);
  if (!within_budget(s)) depth = 0;
  if (depth < 0) depth = 0;
  uint64_t key;
  pl_present_found* known = recall(s, f, depth, &key);
  if (known) return known->busy ? expanded(s, f) : known->prod;
  pl_present_found entry = {.poly = f, .depth = depth, .busy = true};
  pl_push(s->a, s->found, entry);
  int at = s->found.n - 1;
  pl_map_set(s->found_at, key, (uint64_t)at + 1);
  pl_prod best = search_poly(s, f, depth);
  s->found.at[at].prod = best;
  s->found.at[at].busy = false;
  return best;
}
