// The Fourier form of a polynomial: powers and products of sines and cosines written as cos and sin
// of multiple angles.
//
// Each monomial c1^a1 s1^b1 c2^a2 ... is a Laurent polynomial in z_i = e^(iθ_i): c = (z + 1/z)/2, s
// = (z - 1/z)/(2i). The coefficients of z^k and z^-k together are a cosine when the number of sines
// is even, a sine when it is odd. Two more forms come from cos 2K = 1 - 2 sin²K and cos 2K = 2
// cos²K - 1, which turn m1 + m2/2 - m2/2 cos(2(α - β)) into m1 + m2 sin²(α - β).
#include "present/present_impl.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_ANGLES = 4, MAX_ORDER = 8, MAX_WAVES = 40, MAX_WAVE_TERMS = 80, MAX_HALVED = 8 };

typedef struct wave_key {
  int k[MAX_ANGLES];  // multiples of the angle bases
  bool sine;
  int power;  // 1, or 2 after cos 2K was replaced
} wave_key;

typedef struct wave {
  wave_key key;
  const pl_poly* coefficient;
} wave;

typedef struct series {
  pl_present_search* s;
  int n_angles;
  int cos_gen[MAX_ANGLES];
  int halvings;  // everything stands over 2^halvings
  int n;
  wave at[MAX_WAVES];
} series;

// ------------------------------------------------------------------------------------------ angles
// θ and 19/20 θ, which have no base in common: their sums and differences are multiples of θ again,
// and no wave of its own.
static bool is_multiple_of_known(series* w, int gen) {
  pl_present_search* s = w->s;
  for (int j = 0; j < w->n_angles; j++) {
    pl_expr known = pl_arg(s->p, s->t->gens.at[w->cos_gen[j]].expr, 0);
    pl_expr ratio = pl_div(s->p, pl_arg(s->p, s->t->gens.at[gen].expr, 0), known);
    if (pl_is_number(s->p, ratio)) return true;
  }
  return false;
}

static bool find_angles(series* w, const pl_poly* f) {
  pl_tower* t = w->s->t;
  long degree[PL_MAX_GENERATORS];
  pl_poly_degrees(t, f, degree);
  long total = 0;
  for (int g = 0; g < t->gens.n; g++) {
    if (t->gens.at[g].kind != PL_G_COS) continue;
    long d = degree[g] + degree[t->gens.at[g].partner];
    if (d == 0) continue;
    if (w->n_angles == MAX_ANGLES || is_multiple_of_known(w, g)) return false;
    w->cos_gen[w->n_angles++] = g;
    total += d;
  }
  return w->n_angles > 0 && total <= MAX_ORDER;
}

// Largest number of sines and cosines in one term.
static int trig_degree(series* w, const pl_poly* f) {
  pl_tower* t = w->s->t;
  ulong exponent[PL_MAX_GENERATORS];
  int most = 0;
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, f, i, &t->ctx);
    int d = 0;
    for (int j = 0; j < w->n_angles; j++) {
      int g = w->cos_gen[j];
      d += (int)(exponent[g] + exponent[t->gens.at[g].partner]);
    }
    if (d > most) most = d;
  }
  return most;
}

// ------------------------------------------------------------------------------------ adding waves
static bool same_key(const wave_key* x, const wave_key* y) {
  return memcmp(x->k, y->k, sizeof x->k) == 0 && x->sine == y->sine && x->power == y->power;
}

static bool add_wave(series* w, wave_key key, const pl_poly* f) {
  pl_tower* t = w->s->t;
  for (int i = 0; i < w->n; i++) {
    if (!same_key(&w->at[i].key, &key)) continue;
    w->at[i].coefficient = pl_poly_add(t, w->at[i].coefficient, f);
    return true;
  }
  if (w->n == MAX_WAVES) return false;
  w->at[w->n++] = (wave){key, f};
  return true;
}

// Makes the first multiple positive: cos(-x) = cos x, sin(-x) = -sin x. Returns the sign that comes
// out; 0 for sin 0.
static int normalise(wave_key* key) {
  int first = 0;
  while (first < MAX_ANGLES && key->k[first] == 0) first++;
  if (first == MAX_ANGLES) return key->sine ? 0 : 1;
  if (key->k[first] > 0) return 1;
  for (int j = 0; j < MAX_ANGLES; j++) key->k[j] = -key->k[j];
  return key->sine ? -1 : 1;
}

// (z + 1/z)^a (z - 1/z)^b = sum over m of out[m] z^(a + b - 2 m)
static void laurent(long* out, int a, int b) {
  memset(out, 0, (MAX_ORDER + 1) * sizeof *out);
  out[0] = 1;
  for (int i = 0; i < a + b; i++)
    for (int m = i + 1; m > 0; m--) out[m] += i < a ? out[m - 1] : -out[m - 1];
}

typedef struct expansion {
  long coefficient;
  int k[MAX_ANGLES];
} expansion;

// One term of f: rest * prod c^a s^b, over all combinations of exponents of z.
static bool add_term(series* w, const fmpz* coefficient, const ulong* exponent) {
  pl_tower* t = w->s->t;
  ulong rest[PL_MAX_GENERATORS] = {0};
  memcpy(rest, exponent, (size_t)t->gens.n * sizeof *rest);
  long table[MAX_ANGLES][MAX_ORDER + 1];
  int order[MAX_ANGLES] = {0}, sines = 0, total = 0;
  for (int j = 0; j < w->n_angles; j++) {
    int c = w->cos_gen[j], s = t->gens.at[c].partner;
    order[j] = (int)(exponent[c] + exponent[s]);
    sines += (int)exponent[s];
    total += order[j];
    laurent(table[j], (int)exponent[c], (int)exponent[s]);
    rest[c] = rest[s] = 0;
  }
  // i^-sines: cosines come with ±1, sines with 2i * i^-sines / 2
  int sign = sines % 2 == 0 ? (sines % 4 == 0 ? 1 : -1) : (sines % 4 == 1 ? 1 : -1);
  int m[MAX_ANGLES] = {0};
  for (;;) {
    long c = sign;
    wave_key key = {.sine = sines % 2, .power = 1};
    for (int j = 0; j < w->n_angles; j++) {
      c *= table[j][m[j]];
      key.k[j] = order[j] - 2 * m[j];
    }
    // z^k and z^-k both come by; each gives half of the real wave, which cancels the 2 in 2 cos k
    // or 2i sin k
    c *= normalise(&key);
    if (c != 0) {
      pl_poly* f = pl_poly_new(t);
      fmpz* value = pl_int_new(t);
      fmpz_mul_si(value, coefficient, c);
      fmpz_mul_2exp(value, value, (ulong)(w->halvings - total));
      fmpz_mpoly_push_term_fmpz_ui(f, value, rest, &t->ctx);
      if (!add_wave(w, key, f)) return false;
    }
    int j = 0;
    while (j < w->n_angles && m[j] == order[j]) m[j++] = 0;
    if (j == w->n_angles) return true;
    m[j]++;
  }
}

static bool add_all(series* w, const pl_poly* f) {
  ulong exponent[PL_MAX_GENERATORS];
  for (slong i = 0; i < f->length; i++) {
    fmpz_mpoly_get_term_exp_ui(exponent, f, i, &w->s->t->ctx);
    if (!add_term(w, &f->coeffs[i], exponent)) return false;
  }
  int n = 0;
  for (int i = 0; i < w->n; i++)
    if (w->at[i].coefficient->length > 0) w->at[n++] = w->at[i];
  w->n = n;
  return true;
}

// ----------------------------------------------------------------------------------- double angles
static bool is_even(const wave_key* key) {
  bool zero = true;
  for (int j = 0; j < MAX_ANGLES; j++) {
    if (key->k[j] % 2) return false;
    zero &= key->k[j] == 0;
  }
  return !zero && !key->sine && key->power == 1;
}

// cos 2K -> 1 - 2 sin²K, or 2 cos²K - 1, in the wave `only` or in all when it is -1. false when
// there is no such wave.
static bool halve_angles(series* w, bool to_sine, int only) {
  pl_tower* t = w->s->t;
  bool any = false;
  int n = w->n;
  for (int i = 0; i < n; i++) {
    if (!is_even(&w->at[i].key) || (only >= 0 && i != only)) continue;
    any = true;
    const pl_poly* f = w->at[i].coefficient;
    wave_key key = {.sine = to_sine, .power = 2}, constant = {.power = 1};
    for (int j = 0; j < MAX_ANGLES; j++) key.k[j] = w->at[i].key.k[j] / 2;
    fmpz* two = pl_int_new(t);
    fmpz_set_si(two, to_sine ? -2 : 2);
    w->at[i].key = key;
    w->at[i].coefficient = pl_poly_scale(t, f, two);
    if (!add_wave(w, constant, to_sine ? f : pl_poly_neg(t, f))) return false;
  }
  int kept = 0;
  for (int i = 0; i < w->n; i++)
    if (w->at[i].coefficient->length > 0) w->at[kept++] = w->at[i];
  w->n = kept;
  return any;
}

// ----------------------------------------------------------------------------------------- writing
static int common_multiple(const wave_key* key) {
  int g = 0;
  for (int j = 0; j < MAX_ANGLES; j++) {
    int a = abs(key->k[j]), b = g;
    while (b) {
      int r = a % b;
      a = b;
      b = r;
    }
    g = a;
  }
  return g;
}

static const pl_form* argument_form(series* w, const wave_key* key, pl_expr* value) {
  pl_present_search* s = w->s;
  int common = common_multiple(key);
  pl_expr inner = pl_int(s->p, 0), numbers = inner;
  int n = 0;
  for (int j = 0; j < w->n_angles; j++) {
    if (key->k[j] == 0) continue;
    pl_expr angle = pl_arg(s->p, s->t->gens.at[w->cos_gen[j]].expr, 0);
    pl_expr number = pl_take_number(s->p, &angle), k = pl_int(s->p, key->k[j] / common);
    inner = pl_add(s->p, inner, pl_mul(s->p, k, angle));
    numbers = pl_add(s->p, numbers, pl_mul(s->p, k, number));
    n++;
  }
  *value = pl_mul(s->p, pl_int(s->p, common), pl_add(s->p, inner, numbers));
  const pl_form* f = pl_form_of(s->a, s->p, inner);
  bool plain = pl_is_zero_node(s->p, numbers);
  if (!plain)
    f = pl_form_sum(s->a, (const pl_form* const[]){f, pl_form_of(s->a, s->p, numbers)}, 2);
  if (common == 1) return f;
  if (n == 1 && plain) return pl_form_of(s->a, s->p, *value);
  return pl_form_product(s->a,
                         (const pl_form* const[]){pl_form_leaf(s->a, pl_int(s->p, common)), f}, 2);
}

// cos or sin of the multiple as a piece. One piece an expression, so that equal ones are
// recognised.
static pl_piece wave_piece(series* w, const wave_key* key) {
  pl_present_search* s = w->s;
  pl_expr value;
  const pl_form* argument = argument_form(w, key, &value);
  pl_function f = key->sine ? PL_SIN : PL_COS;
  pl_expr call = pl_call(s->p, f, value);
  uint64_t at = pl_map_get(s->wave_at, call.id);
  if (at) return s->waves.at[at - 1].piece;
  int first = 0;
  while (key->k[first] == 0) first++;
  pl_piece piece = pl_piece_of_gen(s, w->cos_gen[first]);
  int one = abs(key->k[first]), others = 0;
  for (int j = 0; j < MAX_ANGLES; j++) others += j != first && key->k[j] != 0;
  if (one == 1 && others == 0)
    return key->sine ? pl_piece_of_gen(s, s->t->gens.at[w->cos_gen[first]].partner) : piece;
  piece.base = pl_form_call(s->a, f, &argument, 1);
  piece.gen = -1;
  piece.order = (int)f;
  // function, brackets, two for each angle, two for each digit of a multiple
  piece.cost = 4 + 2 * (1 + others) + (others ? 2 * (1 + others) : 0)
               + (common_multiple(key) > 1 ? 2 : 0);
  pl_push(s->a, s->waves, (pl_wave_known){piece});
  pl_map_set(s->wave_at, call.id, (uint64_t)s->waves.n);
  return piece;
}

static bool is_constant(const wave_key* key) {
  for (int j = 0; j < MAX_ANGLES; j++)
    if (key->k[j]) return false;
  return true;
}

static const pl_poly* common_factor(series* w) {
  pl_tower* t = w->s->t;
  const pl_poly* g = w->at[0].coefficient;
  for (int i = 1; i < w->n && !pl_poly_is_one(t, g); i++)
    g = pl_poly_gcd(t, g, w->at[i].coefficient);
  w->s->work += w->n;
  return g;
}

// Divides all coefficients by their common factor, which is returned.
static const pl_poly* take_common_factor(series* w) {
  pl_tower* t = w->s->t;
  const pl_poly* common = common_factor(w);
  if (pl_poly_is_one(t, common)) return common;
  const pl_poly* rest[MAX_WAVES];
  for (int i = 0; i < w->n; i++)
    if (!pl_poly_divides(t, &rest[i], w->at[i].coefficient, common)) return pl_poly_int(t, 1);
  for (int i = 0; i < w->n; i++) w->at[i].coefficient = rest[i];
  return common;
}

static pl_prod written(series* w, int depth) {
  pl_present_search* s = w->s;
  if (w->n == 0) return pl_prod_number(s, pl_int(s->p, 0));
  const pl_poly* common = take_common_factor(w);
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, PL_OPENED_TERMS * w->n);
  int n = 0;
  for (int i = 0; i < w->n; i++) {
    pl_prod x = pl_present_poly(s, w->at[i].coefficient, depth - 1);
    bool constant = is_constant(&w->at[i].key);
    if (!constant)
      x = pl_prod_mul(s, x, pl_prod_piece(s, wave_piece(w, &w->at[i].key), w->at[i].key.power));
    pl_terms_put(s, x, terms, &n);
  }
  pl_prod sum = pl_prod_mul(s, pl_present_poly(s, common, depth), pl_prod_sum(s, terms, n));
  return pl_prod_scale(s, sum, pl_ratio(s->p, 1, 1L << w->halvings));
}

bool pl_present_fourier(pl_present_search* s, const pl_poly* f, int depth, pl_prod* best) {
  if (f->length > MAX_WAVE_TERMS || s->work >= s->limit) return false;
  series w = {.s = s};
  if (!find_angles(&w, f)) return false;
  w.halvings = trig_degree(&w, f);
  if (w.halvings < 2) return false;
  s->work += 1 + f->length / 2;
  if (!add_all(&w, f)) return false;
  const series waves = w;  // writing takes the common factor out
  *best = written(&w, depth);
  // all double angles at once, or, with work to spare, one of them
  int last = depth > 0 && waves.n <= MAX_HALVED ? waves.n : 0;
  for (int only = -1; only < last; only++) {
    for (int to_sine = 0; to_sine < 2 && s->work < s->limit; to_sine++) {
      w = waves;
      if (!halve_angles(&w, to_sine, only)) continue;
      pl_prod x = written(&w, depth);
      if (x.cost < best->cost) *best = x;
    }
  }
  return true;
}
