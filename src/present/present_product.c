// Products of pieces: arithmetic, cost, the order K5, and the forms made from them.
#include "present/present_impl.h"

#include <stdlib.h>
#include <string.h>

// What things cost to read.  Symbolic design, section 4.
enum {
  COST_SYMBOL = 2,
  COST_POWER = 2,
  COST_FACTOR = 1,
  COST_FUNCTION = 2,
  COST_BRACKET = 2,
  COST_DIGIT = 2,
  COST_MINUS = 1
};

// -------------------------------------------------------------------------------------------- cost
static long number_cost(pl_present_search* s, pl_expr number) {
  long digits = 0, num = 0, den = 1;
  if (pl_is_ratio(s->p, number, &num, &den)) {
    for (num = labs(num); num > 0; num /= 10) digits++;
    for (; den > 1; den /= 10) digits++;
    return (digits > 0 ? digits : 1) * COST_DIGIT;
  }
  const char* text = pl_number_text(s->a, s->p, number);
  for (; *text; text++) digits += *text >= '0' && *text <= '9';
  return digits * COST_DIGIT;
}

static long cost_of(pl_present_search* s, pl_prod x) {
  long cost = 0, factors = x.n;
  pl_expr unit = x.unit;
  if (pl_number_sign(s->p, unit) < 0) {
    cost += COST_MINUS;
    unit = pl_neg(s->p, unit);
  }
  if (!pl_is_one_node(s->p, unit) || x.n == 0) {
    cost += number_cost(s, unit);
    factors++;
  }
  for (int i = 0; i < x.n; i++) {
    const pl_piece* f = &x.at[i];
    cost += f->cost;
    bool alone = factors == 1 && f->power == 1;
    // (m1 + m2) is read as one mass
    if (f->sum && !alone && f->bucket >= PL_K_PARAM_SUM) cost += COST_BRACKET;
    if (abs(f->power) > 1) cost += COST_POWER;
  }
  return cost + (factors > 1 ? (factors - 1) * COST_FACTOR : 0);
}

static pl_prod costed(pl_present_search* s, pl_prod x) {
  x.cost = cost_of(s, x);
  return x;
}

static long form_cost(pl_present_search* s, const pl_form* f) {
  long cost = 0;
  for (int i = 0; i < f->n; i++) cost += form_cost(s, f->args[i]);
  switch (f->kind) {
    case PL_F_EXPR: return pl_is_number(s->p, f->expr) ? number_cost(s, f->expr) : COST_SYMBOL;
    case PL_F_SUM: return cost + 2 * f->n;
    case PL_F_NEG: return cost + COST_MINUS;
    case PL_F_PRODUCT:
    case PL_F_QUOTIENT: return cost + (f->n - 1) * COST_FACTOR;
    case PL_F_POWER: return cost + COST_POWER;
    case PL_F_CALL:
      return cost + COST_FUNCTION + (f->n == 1 && f->args[0]->kind == PL_F_EXPR ? 0 : COST_BRACKET);
    default: return cost + COST_FUNCTION;
  }
}

// ------------------------------------------------------------------------------------------- order
// Coordinates and their derivatives stand in the order in which the model declares them, all else
// by name.
static int compare_leads(pl_present_search* s, const pl_piece* x, const pl_piece* y) {
  if (x->lead.id == y->lead.id) return 0;
  if (!x->lead.id || !y->lead.id) return x->lead.id ? -1 : 1;
  if (x->bucket == PL_K_COORD || x->bucket == PL_K_VELOCITY || x->bucket == PL_K_ACCELERATION) {
    pl_symbol a = pl_symbol_get(s->p, x->lead)->base, b = pl_symbol_get(s->p, y->lead)->base;
    uint32_t i = a.id ? a.id : x->lead.id, k = b.id ? b.id : y->lead.id;
    if (i != k) return i < k ? -1 : 1;
  }
  return pl_symbol_compare(s->p, x->lead, y->lead);
}

int pl_piece_compare(pl_present_search* s, const pl_piece* x, const pl_piece* y) {
  if (x->bucket != y->bucket) return x->bucket < y->bucket ? -1 : 1;
  int c = compare_leads(s, x, y);
  if (c) return c;
  // a bracket stands behind a symbol of its kind
  if (!x->sum != !y->sum) return x->sum ? 1 : -1;
  return (x->order > y->order) - (x->order < y->order);
}

static void insert_sorted(pl_present_search* s, pl_piece* at, int n, pl_piece x) {
  int i = n;
  for (; i > 0 && pl_piece_compare(s, &x, &at[i - 1]) < 0; i--) at[i] = at[i - 1];
  at[i] = x;
}

// -------------------------------------------------------------------------------------- arithmetic
pl_prod pl_prod_number(pl_present_search* s, pl_expr number) {
  return costed(s, (pl_prod){.unit = number});
}

bool pl_prod_is_zero(const pl_present_search* s, pl_prod x) {
  return pl_is_zero_node(s->p, x.unit);
}

bool pl_prod_is_negative(const pl_present_search* s, pl_prod x) {
  return pl_number_sign(s->p, x.unit) < 0;
}

bool pl_prod_has_denominator(pl_prod x) {
  for (int i = 0; i < x.n; i++)
    if (x.at[i].power < 0) return true;
  return false;
}

pl_prod pl_prod_piece(pl_present_search* s, pl_piece piece, int power) {
  pl_piece* at = PL_NEW(s->a, pl_piece);
  *at = piece;
  at->power = power;
  return costed(s, (pl_prod){.unit = pl_int(s->p, 1), .n = power != 0, .at = at});
}

pl_prod pl_prod_mul(pl_present_search* s, pl_prod x, pl_prod y) {
  pl_piece* at = PL_ARRAY(s->a, pl_piece, x.n + y.n + 1);
  int n = x.n;
  if (n) memcpy(at, x.at, (size_t)n * sizeof *at);
  for (int j = 0; j < y.n; j++) {
    int i = 0;
    while (i < n && at[i].base != y.at[j].base) i++;
    if (i < n) {
      at[i].power += y.at[j].power;
      if (at[i].power == 0) {
        memmove(at + i, at + i + 1, (size_t)(n - i - 1) * sizeof *at);
        n--;
      }
    } else {
      insert_sorted(s, at, n++, y.at[j]);
    }
  }
  return costed(s, (pl_prod){.unit = pl_mul(s->p, x.unit, y.unit), .n = n, .at = at});
}

pl_prod pl_prod_pow(pl_present_search* s, pl_prod x, int k) {
  if (k == 1) return x;
  pl_piece* at = PL_ARRAY(s->a, pl_piece, x.n + 1);
  if (x.n) memcpy(at, x.at, (size_t)x.n * sizeof *at);
  for (int i = 0; i < x.n; i++) at[i].power *= k;
  return costed(s, (pl_prod){.unit = pl_pow_int(s->p, x.unit, k), .n = k ? x.n : 0, .at = at});
}

pl_prod pl_prod_scale(pl_present_search* s, pl_prod x, pl_expr number) {
  x.unit = pl_mul(s->p, x.unit, number);
  return costed(s, x);
}

pl_prod pl_prod_neg(pl_present_search* s, pl_prod x) {
  return pl_prod_scale(s, x, pl_int(s->p, -1));
}

// A function with its argument in its own best form.
// The number in a sum, which is taken out of it; 0: there is none.
pl_expr pl_take_number(pl_pool* p, pl_expr* e) {
  for (int i = 0; pl_kind_of(p, *e) == PL_ADD && i < pl_n_args(p, *e); i++) {
    pl_expr number = pl_arg(p, *e, i);
    if (!pl_is_constant(p, number)) continue;
    *e = pl_sub(p, *e, number);
    return number;
  }
  return pl_int(p, 0);
}

// The angle of a sine, where a number stands beside the others: θ + 1/4, not (4 θ + 1)/4.
static const pl_form* angle_form(pl_present_search* s, pl_expr angle) {
  pl_expr number = pl_take_number(s->p, &angle);
  const pl_form* f = pl_prod_form(
      s, pl_prod_flip(s, pl_present_quotient(s, pl_convert(s->t, angle), 1)));
  if (pl_is_zero_node(s->p, number)) return f;
  return pl_form_sum(s->a, (const pl_form* const[]){f, pl_form_of(s->a, s->p, number)}, 2);
}

static const pl_form* call_form(pl_present_search* s, pl_expr e) {
  if (pl_kind_of(s->p, e) != PL_CALL) return pl_form_of(s->a, s->p, e);
  int n = pl_n_args(s->p, e);
  const pl_form* args[2];
  for (int i = 0; i < n; i++) {
    pl_expr x = pl_arg(s->p, e, i);
    if (pl_kind_of(s->p, x) == PL_SYMBOL || pl_is_constant(s->p, x))
      args[i] = pl_form_of(s->a, s->p, x);
    else if (pl_function_of(s->p, e) == PL_SIN || pl_function_of(s->p, e) == PL_COS)
      args[i] = angle_form(s, x);
    else args[i] = pl_prod_form(s, pl_prod_flip(s, pl_present_quotient(s, pl_convert(s->t, x), 1)));
  }
  return pl_form_call(s->a, pl_function_of(s->p, e), args, n);
}

// -------------------------------------------------------------------------------------- generators
static pl_bucket bucket_of_symbol(pl_present_search* s, pl_symbol x) {
  const pl_symbol_info* i = pl_symbol_get(s->p, x);
  switch (i->role) {
    case PL_R_COORD: return PL_K_COORD;
    case PL_R_VELOCITY:
    case PL_R_MOMENTUM: return PL_K_VELOCITY;
    case PL_R_ACCELERATION: return PL_K_ACCELERATION;
    case PL_R_MULTIPLIER: return PL_K_MULTIPLIER;
    case PL_R_TIME: return PL_K_TIME;
    case PL_R_START: return PL_K_START;
    default: break;
  }
  switch (i->class) {
    case PL_C_NUMBER:  // a number with its unit: before the masses, by its class
    case PL_C_MASS: return PL_K_MASS;
    case PL_C_GRAVITY: return PL_K_GRAVITY;
    case PL_C_LENGTH: return PL_K_LENGTH;
    case PL_C_FUNCTION: return PL_K_FUNCTION;
    case PL_C_MULTIPLIER: return PL_K_MULTIPLIER;
    default: return PL_K_OTHER;
  }
}

static pl_symbol first_symbol(pl_present_search* s, pl_expr e) {
  int n = pl_symbols_in(s->p, e, NULL, 0);
  if (n == 0) return (pl_symbol){0};
  pl_symbol* all = PL_ARRAY(s->a, pl_symbol, n);
  pl_symbols_in(s->p, e, all, n);
  pl_symbol best = all[0];
  for (int i = 1; i < n; i++)
    if (pl_symbol_compare(s->p, all[i], best) < 0) best = all[i];
  return best;
}

static pl_bucket bucket_of_element(pl_present_search* s, pl_expr e) {
  int dots = pl_dots_of(s->p, e);
  return dots == 0 ? PL_K_COORD : dots == 1 ? PL_K_VELOCITY : PL_K_ACCELERATION;
}

static bool moves(pl_present_search* s, pl_expr e) {
  return pl_has_role(s->p, e, PL_R_COORD) || pl_has_role(s->p, e, PL_R_VELOCITY)
         || pl_has_role(s->p, e, PL_R_TIME) || pl_has_role(s->p, e, PL_R_ARRAY);
}

// w = √P with P in its own best form.
static void root_piece(pl_present_search* s, int gen, pl_piece* piece) {
  const pl_gen* g = &s->t->gens.at[gen];
  pl_prod inside = pl_prod_flip(s, pl_present_poly(s, g->value, 1));
  const pl_form* f = pl_prod_form(s, inside);
  piece->base = g->degree == 2
                    ? pl_form_root(s->a, f)
                    : pl_form_power(s->a, f, pl_form_leaf(s->a, pl_ratio(s->p, 1, g->degree)));
  piece->cost = COST_FUNCTION + COST_BRACKET + inside.cost;
  piece->bucket = pl_poly_is_number(s->t, g->value) ? PL_K_NUMBER
                  : moves(s, g->expr)               ? PL_K_ROOT
                                                    : PL_K_OTHER;
}

static pl_piece make_gen_piece(pl_present_search* s, int gen) {
  const pl_gen* g = &s->t->gens.at[gen];
  pl_piece piece = {
      .power = 1, .gen = gen, .lead = first_symbol(s, g->expr), .bucket = PL_K_FUNCTION};
  switch (g->kind) {
    case PL_G_ROOT: root_piece(s, gen, &piece); return piece;
    case PL_G_SYMBOL:
      piece.base = pl_form_leaf(s->a, g->expr);
      piece.cost = COST_SYMBOL;
      if (pl_kind_of(s->p, g->expr) == PL_AT) piece.bucket = bucket_of_element(s, g->expr);
      else if (pl_kind_of(s->p, g->expr) == PL_SYMBOL)
        piece.bucket = bucket_of_symbol(s, pl_symbol_of(s->p, g->expr));
      else piece.bucket = PL_K_NUMBER;
      return piece;
    default:
      piece.base = call_form(s, g->expr);
      piece.cost = form_cost(s, piece.base);
      if (pl_kind_of(s->p, g->expr) == PL_CALL) piece.order = (int)pl_function_of(s->p, g->expr);
      if (pl_kind_of(s->p, g->expr) == PL_PI) piece.bucket = PL_K_NUMBER;
      return piece;
  }
}

static pl_piece plain_piece(pl_present_search* s, int gen) {
  const pl_gen* g = &s->t->gens.at[gen];
  pl_piece piece = {
      .power = 1, .gen = gen, .lead = first_symbol(s, g->expr), .bucket = PL_K_FUNCTION};
  piece.base = pl_form_of(s->a, s->p, g->expr);
  piece.cost = form_cost(s, piece.base);
  return piece;
}

pl_piece pl_piece_of_gen(pl_present_search* s, int gen) {
  if (!s->gen_known[gen]) {
    // While the argument of a function is presented, the search asks for all generators, this one
    // too: it then stands in its plain form.
    s->gen_piece[gen] = plain_piece(s, gen);
    s->gen_known[gen] = true;
    pl_piece made = make_gen_piece(s, gen);
    s->gen_piece[gen] = made;
  }
  return s->gen_piece[gen];
}

pl_prod pl_prod_of_gen(pl_present_search* s, int gen, int power) {
  return pl_prod_piece(s, pl_piece_of_gen(s, gen), power);
}

pl_prod pl_prod_of_exponents(pl_present_search* s, pl_expr unit, const ulong* exponent) {
  int n = 0, present = 0;  // few of the generators: a piece for each would fill the memory
  for (int g = 0; g < s->t->gens.n; g++) present += exponent[g] != 0;
  pl_piece* at = PL_ARRAY(s->a, pl_piece, present + 1);
  for (int g = 0; g < s->t->gens.n; g++) {
    if (!exponent[g]) continue;
    pl_piece piece = pl_piece_of_gen(s, g);
    piece.power = (int)exponent[g];
    insert_sorted(s, at, n++, piece);
  }
  return costed(s, (pl_prod){.unit = unit, .n = n, .at = at});
}

// ------------------------------------------------------------------------------------------- forms
typedef PL_VEC(const pl_form*) forms;

static const pl_form* product_of(pl_present_search* s, forms* f) {
  if (f->n == 0) return pl_form_leaf(s->a, pl_int(s->p, 1));
  return f->n == 1 ? f->at[0] : pl_form_product(s->a, f->at, f->n);
}

// base^k.  Powers of roots are written with the exponent k/2: (l² - x²)^(3/2).
static const pl_form* piece_form(pl_present_search* s, const pl_piece* f, int power) {
  const pl_form* base = pl_piece_base(s, f);
  pl_expr exponent = pl_int(s->p, power);
  if (base->kind == PL_F_ROOT && power > 1) {
    base = base->args[0];
    exponent = pl_ratio(s->p, power, 2);
  }
  if (pl_is_one_node(s->p, exponent)) return base;
  return pl_form_power(s->a, base, pl_form_leaf(s->a, exponent));
}

static bool is_exp(pl_present_search* s, const pl_piece* f) {
  return f->gen >= 0 && s->t->gens.at[f->gen].kind == PL_G_EXP;
}

// e^x e^2y / e^z as one function: the exponent of all exponentials of a product together.
static pl_expr exponents_together(pl_present_search* s, pl_prod x) {
  pl_expr sum = pl_int(s->p, 0);
  for (int i = 0; i < x.n; i++) {
    if (!is_exp(s, &x.at[i])) continue;
    pl_expr argument = pl_arg(s->p, s->t->gens.at[x.at[i].gen].expr, 0);
    sum = pl_add(s->p, sum, pl_mul(s->p, pl_int(s->p, x.at[i].power), argument));
  }
  return sum;
}

static pl_expr denominator_of(pl_present_search* s, pl_expr number) {
  long num = 0, den = 1;
  if (pl_is_ratio(s->p, number, &num, &den)) return pl_int(s->p, den);
  const char* text = pl_number_den_text(s->a, s->p, number);
  return pl_number_from_text(s->p, text, strlen(text));
}

bool pl_prod_wants_fraction_first(pl_present_search* s, pl_prod x) {
  pl_expr den = denominator_of(s, x.unit);
  if (x.n == 0 || pl_is_one_node(s->p, den) || pl_prod_has_denominator(x)) return false;
  pl_expr num = pl_mul(s->p, x.unit, den);
  bool plain = pl_is_one_node(s->p, num) || pl_is_one_node(s->p, pl_neg(s->p, num));
  return !plain || x.at[x.n - 1].base->kind == PL_F_CALL;
}

// The factors above and below the line, without the number.
static void split_pieces(pl_present_search* s, pl_prod x, forms* above, forms* below) {
  bool exp_done = false;
  for (int i = 0; i < x.n; i++) {
    const pl_piece* f = &x.at[i];
    if (is_exp(s, f)) {
      if (!exp_done)
        pl_push(s->a, *above, call_form(s, pl_call(s->p, PL_EXP, exponents_together(s, x))));
      exp_done = true;
    } else if (f->power > 0) {
      pl_push(s->a, *above, piece_form(s, f, f->power));
    } else {
      pl_push(s->a, *below, piece_form(s, f, -f->power));
    }
  }
}

const pl_form* pl_prod_form_with(pl_present_search* s, pl_prod x, bool fraction_first) {
  pl_pool* p = s->p;
  bool minus = pl_number_sign(p, x.unit) < 0;
  pl_expr unit = minus ? pl_neg(p, x.unit) : x.unit;
  pl_expr den = denominator_of(s, unit), num = pl_mul(p, unit, den);
  forms above = {0}, below = {0};
  if (fraction_first && x.n > 0 && !pl_is_one_node(p, den) && !pl_prod_has_denominator(x)) {
    pl_push(s->a, above, pl_form_quotient(s->a, pl_form_leaf(s->a, num), pl_form_leaf(s->a, den)));
  } else {
    if (!pl_is_one_node(p, num)) pl_push(s->a, above, pl_form_leaf(s->a, num));
    if (!pl_is_one_node(p, den)) pl_push(s->a, below, pl_form_leaf(s->a, den));
  }
  split_pieces(s, x, &above, &below);
  const pl_form* r = product_of(s, &above);
  if (below.n) r = pl_form_quotient(s->a, r, product_of(s, &below));
  return minus ? pl_form_neg(s->a, r) : r;
}

const pl_form* pl_prod_form(pl_present_search* s, pl_prod x) {
  return pl_prod_form_with(s, x, pl_prod_wants_fraction_first(s, x));
}

// ----------------------------------------------------------------------------------------- tidying
static bool has_both_signs(pl_present_search* s, const pl_sum_terms* sum) {
  int minus = 0;
  for (int i = 0; i < sum->n; i++) minus += pl_prod_is_negative(s, sum->at[i]);
  return minus > 0 && minus < sum->n;
}

// 1 - r cos φ/√(...) reads as a correction to 1 and is left as it is.
static bool begins_with_one(pl_present_search* s, const pl_sum_terms* sum) {
  return sum->at[0].n == 0 && pl_is_one_node(s->p, sum->at[0].unit);
}

static pl_prod negated_sum(pl_present_search* s, const pl_sum_terms* sum) {
  pl_prod* terms = PL_ARRAY(s->a, pl_prod, sum->n);
  for (int i = 0; i < sum->n; i++) terms[i] = pl_prod_neg(s, sum->at[i]);
  return pl_prod_bracket(s, terms, sum->n);
}

static pl_prod without_piece(pl_present_search* s, pl_prod x, int i) {
  pl_piece* at = PL_ARRAY(s->a, pl_piece, x.n);
  memcpy(at, x.at, (size_t)x.n * sizeof *at);
  memmove(at + i, at + i + 1, (size_t)(x.n - i - 1) * sizeof *at);
  x.at = at;
  x.n--;
  return costed(s, x);
}

pl_prod pl_prod_flip(pl_present_search* s, pl_prod x) {
  if (!pl_prod_is_negative(s, x)) return x;
  for (int i = 0; i < x.n; i++) {
    if (!x.at[i].sum || x.at[i].power % 2 == 0 || x.at[i].power < 0) continue;
    if (!has_both_signs(s, x.at[i].sum) || begins_with_one(s, x.at[i].sum)) continue;
    pl_prod flipped = pl_prod_pow(s, negated_sum(s, x.at[i].sum), x.at[i].power);
    return pl_prod_mul(s, pl_prod_neg(s, without_piece(s, x, i)), flipped);
  }
  return x;
}

static int find_partner(pl_present_search* s, pl_prod x, int i) {
  int partner = x.at[i].gen >= 0 ? s->t->gens.at[x.at[i].gen].partner : -1;
  for (int k = 0; partner >= 0 && k < x.n; k++)
    if (x.at[k].gen == partner) return k;
  return -1;
}

// sin^n / cos^n -> tan^n, cos^n / sin^n -> 1/tan^n; cos alone in the denominator stays.
static pl_prod merge_tangent(pl_present_search* s, pl_prod x) {
  for (int i = 0; i < x.n; i++) {
    if (x.at[i].gen < 0 || s->t->gens.at[x.at[i].gen].kind != PL_G_SIN) continue;
    int k = find_partner(s, x, i);
    if (k < 0 || x.at[k].power != -x.at[i].power) continue;
    pl_expr angle = pl_arg(s->p, s->t->gens.at[x.at[i].gen].expr, 0);
    pl_piece tangent = x.at[i];
    tangent.base = pl_form_of(s->a, s->p, pl_call(s->p, PL_TAN, angle));
    if (tangent.base->kind != PL_F_CALL) continue;
    tangent.gen = -1;
    tangent.order = PL_TAN;
    int power = x.at[i].power;
    pl_prod rest = without_piece(s, without_piece(s, x, i > k ? i : k), i > k ? k : i);
    return merge_tangent(s, pl_prod_mul(s, rest, pl_prod_piece(s, tangent, power)));
  }
  return x;
}

static bool is_root(const pl_piece* f) { return f->base->kind == PL_F_ROOT; }

// √A √B -> √(A B), √A/√B -> √(A/B): all plain roots of a product under one sign.
static pl_prod merge_roots(pl_present_search* s, pl_prod x) {
  forms above = {0}, below = {0};
  int first = -1, n = 0;
  for (int i = 0; i < x.n; i++) {
    if (!is_root(&x.at[i]) || abs(x.at[i].power) != 1) continue;
    if (x.at[i].power > 0) pl_push(s->a, above, x.at[i].base->args[0]);
    else pl_push(s->a, below, x.at[i].base->args[0]);
    if (first < 0 || x.at[i].bucket > x.at[first].bucket) first = i;
    n++;
  }
  if (n < 2 || (above.n && below.n)) return x;
  pl_piece root = x.at[first];
  forms* inside = above.n ? &above : &below;
  root.base = pl_form_root(s->a, product_of(s, inside));
  root.cost = form_cost(s, root.base);
  root.gen = -1;
  int power = above.n ? 1 : -1;
  for (int i = x.n - 1; i >= 0; i--)
    if (is_root(&x.at[i]) && abs(x.at[i].power) == 1) x = without_piece(s, x, i);
  return pl_prod_mul(s, x, pl_prod_piece(s, root, power));
}

static pl_prod with_root(pl_present_search* s, pl_prod x, int i, pl_prod inside) {
  pl_piece root = x.at[i];
  root.base = pl_form_root(s->a, pl_prod_form(s, inside));
  root.cost = COST_FUNCTION + COST_BRACKET + inside.cost;
  root.gen = -1;
  return pl_prod_mul(s, without_piece(s, x, i), pl_prod_piece(s, root, 1));
}

// √(g l)/l -> √(g/l) and l/√(g l) -> √(l/g), for positive symbols on the other side of the line
// that divide what stands under the root.
static pl_prod divide_under_root(pl_present_search* s, pl_prod x) {
  pl_tower* t = s->t;
  for (int i = 0; i < x.n; i++) {
    int w = x.at[i].gen, side = x.at[i].power;
    if (w < 0 || t->gens.at[w].kind != PL_G_ROOT || t->gens.at[w].degree != 2 || abs(side) != 1)
      continue;
    const pl_poly* rest = t->gens.at[w].value;
    pl_prod taken = pl_prod_number(s, pl_int(s->p, 1));
    for (int k = 0; k < x.n; k++) {
      int b = x.at[k].gen;
      if (b < 0 || x.at[k].power * side >= 0 || t->gens.at[b].kind != PL_G_SYMBOL
          || t->gens.at[b].sign != 1)
        continue;
      if (pl_poly_divides(t, &rest, rest, pl_poly_gen(t, b)))
        taken = pl_prod_mul(s, taken, pl_prod_of_gen(s, b, 1));
    }
    if (taken.n == 0) continue;
    pl_prod inside = pl_prod_mul(s, pl_present_poly(s, rest, 1), pl_prod_pow(s, taken, -1));
    if (side > 0) {
      // a number below the line goes along: √(6 g/l)/2 -> √(3 g/(2 l))
      pl_expr under = denominator_of(s, x.unit);
      x = pl_prod_scale(s, x, under);
      inside = pl_prod_scale(s, inside, pl_pow_int(s->p, under, -2));
    }
    // the symbols leave the side they stood on
    pl_prod y = with_root(s, x, i, pl_prod_pow(s, inside, side));
    return pl_prod_mul(s, y, pl_prod_pow(s, taken, side));
  }
  return x;
}

// g l/√(g l) -> √(g l), where that is shorter.
static pl_prod raise_roots(pl_present_search* s, pl_prod x) {
  for (int i = 0; i < x.n; i++) {
    int w = x.at[i].gen;
    if (w < 0 || x.at[i].power >= 0 || s->t->gens.at[w].kind != PL_G_ROOT
        || s->t->gens.at[w].degree != 2)
      continue;
    pl_prod radicand = pl_present_poly(s, s->t->gens.at[w].value, 1);
    pl_prod y = pl_prod_mul(s, pl_prod_mul(s, x, pl_prod_pow(s, radicand, -1)),
                            pl_prod_of_gen(s, w, 2));
    if (y.cost < x.cost) return raise_roots(s, y);
  }
  return x;
}

pl_prod pl_prod_tidy(pl_present_search* s, pl_prod x) {
  return merge_roots(s, divide_under_root(s, raise_roots(s, merge_tangent(s, x))));
}
