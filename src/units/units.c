// Units as written in [ ]: "m/s^2", "kN m", "m²/s", "1/min". A unit is an exact factor to SI and a
// dimension.
//
//   unit    = power { ("*" | "·" | blank | "/") power }         from left to right
//   power   = atom [ "^" exponent | superscript digits ]  integer, decimal, or fraction in brackets
//   atom    = number | "(" unit ")" | [prefix] symbol
//
// A product after a division ("J/kg K") can be read in two ways and is refused, as in formulas.
#include "units/units.h"

#include <string.h>

typedef struct unit_row {
  const char* name;
  const char* words;
  const char* factor;
  int pi;
  int exponent[PL_N_BASE_UNITS];
  bool prefixed;
} unit_row;

static const unit_row unit_rows[] = {
#define PL_UNIT(name, words, factor, pi, m, kg, s, A, K, mol, cd, prefixed) \
  {name, words, factor, pi, {m, kg, s, A, K, mol, cd}, prefixed},
#define PL_UNIT_WORD(word, unit)
#include "units.def"
#undef PL_UNIT
#undef PL_UNIT_WORD
};
enum { N_UNIT_ROWS = sizeof unit_rows / sizeof unit_rows[0] };

static const struct unit_word {
  const char* word;
  const char* unit;
} unit_words[] = {
#define PL_UNIT(name, words, factor, pi, m, kg, s, A, K, mol, cd, prefixed)
#define PL_UNIT_WORD(word, unit) {word, unit},
#include "units.def"
#undef PL_UNIT
#undef PL_UNIT_WORD
};
enum { N_UNIT_WORDS = sizeof unit_words / sizeof unit_words[0] };

// SI prefixes up to yotta: the four newer ones would turn slips of the pen (qm, Rm) into units. The
// micro sign comes as U+00B5, as Greek mu, and as u.
static const struct unit_prefix {
  const char* name;
  int power;
} unit_prefixes[] = {
    {"da", 1}, {"µ", -6},  {"μ", -6},  {"u", -6},  {"Y", 24},  {"Z", 21},  {"E", 18}, {"P", 15},
    {"T", 12}, {"G", 9},   {"M", 6},   {"k", 3},   {"h", 2},   {"d", -1},  {"c", -2}, {"m", -3},
    {"n", -9}, {"p", -12}, {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24},
};
enum { N_UNIT_PREFIXES = sizeof unit_prefixes / sizeof unit_prefixes[0] };

static const char* const base_names[PL_N_BASE_UNITS] = {"m", "kg", "s", "A", "K", "mol", "cd"};
static const char* const base_ascii[PL_N_BASE_UNITS] = {"[m]", "[kg]",  "[s]", "[A]",
                                                        "[K]", "[mol]", "[cd]"};

enum { MAX_UNIT_DEPTH = 50, MAX_UNIT_EXPONENT = 60, MAX_UNIT_DIGITS = 60 };

// -------------------------------------------------------------------------------------- the reader
typedef struct unit_value {
  pl_expr scale;
  pl_exponents dimension;
  bool angle;  // built from angle units only
  bool plain;  // only numbers so far
} unit_value;

typedef struct unit_reader {
  pl_pool* pool;
  const char* begin;
  const char* at;
  const char* end;
  int depth;
  const char* bad;  // first offending part; NULL while all is well
  size_t bad_n;
  const char* near;
} unit_reader;

static unit_value unit_one(pl_pool* p) {
  return (unit_value){pl_int(p, 1), pl_exponents_zero(), false, true};
}

static void refuse(unit_reader* r, const char* at, size_t n, const char* near) {
  if (r->bad) return;
  r->bad = at;
  r->bad_n = n;
  r->near = near;
}

// The exact number of a row: decimal numbers joined by * and /.
static pl_expr row_number(pl_pool* p, const char* text) {
  pl_expr value = pl_int(p, 1);
  char op = '*';
  while (*text) {
    size_t n = strcspn(text, "*/");
    pl_expr x = pl_number_from_text(p, text, n);
    value = op == '*' ? pl_mul(p, value, x) : pl_div(p, value, x);
    text += n;
    if (*text) op = *text++;
  }
  return value;
}

static unit_value row_value(pl_pool* p, const unit_row* row, int prefix_power) {
  unit_value v = unit_one(p);
  v.scale = row_number(p, row->factor);
  if (row->pi) v.scale = pl_mul(p, v.scale, pl_pow_int(p, pl_pi(p), row->pi));
  if (prefix_power) v.scale = pl_mul(p, v.scale, pl_pow_int(p, pl_int(p, 10), prefix_power));
  for (int i = 0; i < PL_N_BASE_UNITS; i++) v.dimension.e[i] = (pl_fraction){row->exponent[i], 1};
  v.plain = strcmp(row->name, "%") == 0 || strcmp(row->name, "‰") == 0
            || strcmp(row->name, "ppm") == 0;
  v.angle = pl_exponents_are_zero(v.dimension) && !v.plain;
  return v;
}

static const unit_row* find_row(const char* s, size_t n) {
  for (int i = 0; i < N_UNIT_ROWS; i++) {
    if (strlen(unit_rows[i].name) == n && memcmp(unit_rows[i].name, s, n) == 0)
      return &unit_rows[i];
  }
  return NULL;
}

// A symbol, or a prefix and a symbol that takes one.
static bool find_symbol(const char* s, size_t n, const unit_row** row, int* power) {
  *power = 0;
  *row = find_row(s, n);
  if (*row) return true;
  for (int i = 0; i < N_UNIT_PREFIXES; i++) {
    size_t k = strlen(unit_prefixes[i].name);
    if (k >= n || memcmp(unit_prefixes[i].name, s, k) != 0) continue;
    *row = find_row(s + k, n - k);
    if (*row && (*row)->prefixed) {
      *power = unit_prefixes[i].power;
      return true;
    }
  }
  *row = NULL;
  return false;
}

static void skip_blanks(unit_reader* r) {
  for (;;) {
    if (r->at < r->end && (*r->at == ' ' || *r->at == '\t')) r->at++;
    else if (r->end - r->at >= 2 && memcmp(r->at, "\u00a0", 2) == 0) r->at += 2;
    else if (r->end - r->at >= 3 && memcmp(r->at, "\u202f", 3) == 0) r->at += 3;
    else return;
  }
}

static bool starts_with(const unit_reader* r, const char* s) {
  size_t n = strlen(s);
  return (size_t)(r->end - r->at) >= n && memcmp(r->at, s, n) == 0;
}

static bool take(unit_reader* r, const char* s) {
  if (!starts_with(r, s)) return false;
  r->at += strlen(s);
  return true;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Superscript digits and minus, as a digit, 10 for minus, -1 for anything else.
static int superscript(const unit_reader* r, int* bytes) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹", "⁻"};
  for (int i = 0; i <= 10; i++) {
    if (starts_with(r, digits[i])) {
      *bytes = (int)strlen(digits[i]);
      return i;
    }
  }
  return -1;
}

// A letter of a unit symbol: ASCII letters, % and every non-ASCII character that is not an operator
// or a digit.
static int symbol_letter(const unit_reader* r) {
  if (r->at >= r->end) return 0;
  unsigned char c = (unsigned char)*r->at;
  if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || c == '_') return 1;
  if (c < 0x80) return 0;
  int bytes;
  if (superscript(r, &bytes) >= 0) return 0;
  static const char* const operators[] = {"·", "⋅", "×", "∙", "−", "\u00a0", "\u202f", "∕"};
  for (size_t i = 0; i < sizeof operators / sizeof operators[0]; i++) {
    if (starts_with(r, operators[i])) return 0;
  }
  uint32_t code;
  int n = pl_utf8_decode(r->at, r->end, &code);
  return n > 0 ? n : 1;
}

static bool read_integer(unit_reader* r, long* out) {
  const char* from = r->at;
  bool negative = take(r, "-") || take(r, "−");
  if (!negative) take(r, "+");
  if (r->at >= r->end || !is_digit(*r->at)) {
    refuse(r, from, r->at < r->end ? 1 : 0, NULL);
    return false;
  }
  long n = 0;
  while (r->at < r->end && is_digit(*r->at)) {
    n = n * 10 + (*r->at++ - '0');
    if (n > MAX_UNIT_EXPONENT) {
      while (r->at < r->end && is_digit(*r->at)) r->at++;
      refuse(r, from, (size_t)(r->at - from), NULL);
      return false;
    }
  }
  *out = negative ? -n : n;
  return true;
}

// 2, -2, (1/2), (-3), 0.5
static bool read_exponent(unit_reader* r, long* num, long* den) {
  *den = 1;
  const char* from = r->at;
  skip_blanks(r);
  bool bracket = take(r, "(");
  if (bracket) skip_blanks(r);
  bool negative = starts_with(r, "-") || starts_with(r, "−");
  if (!read_integer(r, num)) return false;
  if (r->at < r->end && *r->at == '.') {
    r->at++;
    long scale = 1, digits = 0;
    while (r->at < r->end && is_digit(*r->at) && scale < 1000) {
      digits = digits * 10 + (*r->at++ - '0');
      scale *= 10;
    }
    *num = *num * scale + (negative ? -digits : digits);
    *den = scale;
  }
  if (bracket) {
    skip_blanks(r);
    if (take(r, "/")) {
      skip_blanks(r);
      long d;
      if (!read_integer(r, &d)) return false;
      if (d <= 0) {
        refuse(r, from, (size_t)(r->at - from), NULL);
        return false;
      }
      *den *= d;
      skip_blanks(r);
    }
    if (!take(r, ")")) {
      refuse(r, from, (size_t)(r->at - from), NULL);
      return false;
    }
  }
  return true;
}

static bool read_superscript(unit_reader* r, long* out) {
  int bytes, digit = superscript(r, &bytes);
  if (digit < 0) return false;
  const char* from = r->at;
  bool negative = digit == 10, any = false;
  if (negative) r->at += bytes;
  long n = 0;
  while ((digit = superscript(r, &bytes)) >= 0 && digit < 10) {
    r->at += bytes;
    any = true;
    n = n * 10 + digit;
    if (n > MAX_UNIT_EXPONENT) {
      refuse(r, from, (size_t)(r->at - from), NULL);
      return false;
    }
  }
  if (!any) {
    refuse(r, from, (size_t)(r->at - from), NULL);
    return false;
  }
  *out = negative ? -n : n;
  return true;
}

static unit_value read_unit(unit_reader* r);

static unit_value read_number(unit_reader* r) {
  unit_value v = unit_one(r->pool);
  const char* from = r->at;
  while (r->at < r->end && (is_digit(*r->at) || *r->at == '.')) r->at++;
  size_t n = (size_t)(r->at - from);
  int dots = 0;
  for (size_t i = 0; i < n; i++) dots += from[i] == '.';
  if (n > MAX_UNIT_DIGITS || dots > 1) {
    refuse(r, from, n, NULL);
    return v;
  }
  v.scale = pl_number_from_text(r->pool, from, n);
  if (!pl_is_number(r->pool, v.scale) || pl_is_zero_node(r->pool, v.scale)) {
    refuse(r, from, n, NULL);
    v.scale = pl_int(r->pool, 1);
  }
  return v;
}

static unit_value read_symbol(unit_reader* r) {
  const char* from = r->at;
  int k;
  while ((k = symbol_letter(r)) > 0) r->at += k;
  size_t n = (size_t)(r->at - from);
  const unit_row* row;
  int power;
  if (find_symbol(from, n, &row, &power)) {
    unit_value v = row_value(r->pool, row, power);
    // m2 for m^2
    const char* digits = r->at;
    while (r->at < r->end && is_digit(*r->at)) r->at++;
    if (r->at > digits) {
      refuse(r, from, (size_t)(r->at - from),
             pl_format(pl_pool_arena(r->pool), "%.*s^%.*s", (int)n, from, (int)(r->at - digits),
                       digits));
    }
    return v;
  }
  refuse(r, from, n, pl_unit_near(pl_pool_arena(r->pool), from, n));
  return unit_one(r->pool);
}

static unit_value read_atom(unit_reader* r) {
  if (r->at < r->end && *r->at == '(') {
    const char* from = r->at++;
    if (++r->depth > MAX_UNIT_DEPTH) {
      refuse(r, from, (size_t)(r->end - from), NULL);
      return unit_one(r->pool);
    }
    unit_value v = read_unit(r);
    r->depth--;
    skip_blanks(r);
    if (!take(r, ")")) refuse(r, from, (size_t)(r->end - from), NULL);
    return v;
  }
  if (r->at < r->end && is_digit(*r->at)) return read_number(r);
  if (symbol_letter(r)) return read_symbol(r);
  if (r->at < r->end) {
    uint32_t code;
    int n = pl_utf8_decode(r->at, r->end, &code);
    refuse(r, r->at, n > 0 ? (size_t)n : 1, NULL);
  } else {
    refuse(r, r->at, 0, NULL);
  }
  return unit_one(r->pool);
}

static unit_value raise(unit_reader* r, unit_value v, long num, long den) {
  pl_fraction f = pl_fraction_make(num, den);
  v.dimension = pl_exponents_add(pl_exponents_zero(), f, v.dimension);
  v.scale = pl_pow(r->pool, v.scale, pl_ratio(r->pool, num, den));
  v.angle = v.angle && f.num == 1 && f.den == 1;
  return v;
}

static unit_value read_power(unit_reader* r) {
  unit_value v = read_atom(r);
  if (r->bad) return v;
  long num, den = 1;
  int bytes;
  if (superscript(r, &bytes) >= 0) {
    if (read_superscript(r, &num)) v = raise(r, v, num, 1);
    return v;
  }
  const char* before = r->at;
  skip_blanks(r);
  if (take(r, "**") || take(r, "^")) {
    if (read_exponent(r, &num, &den)) v = raise(r, v, num, den);
  } else {
    r->at = before;
  }
  return v;
}

static unit_value join(unit_reader* r, unit_value a, unit_value b, bool divide) {
  unit_value v;
  v.scale = divide ? pl_div(r->pool, a.scale, b.scale) : pl_mul(r->pool, a.scale, b.scale);
  v.dimension = pl_exponents_add(a.dimension, (pl_fraction){divide ? -1 : 1, 1}, b.dimension);
  v.angle = (a.angle && b.plain && !divide) || (a.plain && b.angle && !divide)
            || (a.angle && b.plain);
  v.plain = a.plain && b.plain;
  return v;
}

// What may follow a factor: an operator, a blank product, or the end.
typedef enum unit_operator { OP_END, OP_PRODUCT, OP_DIVISION } unit_operator;

static unit_operator read_operator(unit_reader* r) {
  const char* before = r->at;
  skip_blanks(r);
  if (r->at >= r->end || *r->at == ')') return OP_END;
  if (take(r, "/") || take(r, "∕")) return OP_DIVISION;
  if (take(r, "·") || take(r, "⋅") || take(r, "×") || take(r, "∙")) return OP_PRODUCT;
  if (*r->at == '*' && !starts_with(r, "**")) {
    r->at++;
    return OP_PRODUCT;
  }
  if (symbol_letter(r) || *r->at == '(' || (is_digit(*r->at) && r->at > before)) return OP_PRODUCT;
  uint32_t code;
  int n = pl_utf8_decode(r->at, r->end, &code);
  refuse(r, r->at, n > 0 ? (size_t)n : 1, NULL);
  return OP_END;
}

static unit_value read_unit(unit_reader* r) {
  skip_blanks(r);
  unit_value v = read_power(r);
  bool divided = false;
  const char* divisor = NULL;
  while (!r->bad) {
    unit_operator op = read_operator(r);
    if (op == OP_END) break;
    skip_blanks(r);
    const char* from = r->at;
    unit_value next = read_power(r);
    if (r->bad) break;
    if (op == OP_PRODUCT && divided) {
      size_t n = (size_t)(r->at - divisor);
      refuse(r, divisor, n, pl_format(pl_pool_arena(r->pool), "(%.*s)", (int)n, divisor));
      break;
    }
    if (op == OP_DIVISION) {
      divided = true;
      divisor = from;
    }
    v = join(r, v, next, op == OP_DIVISION);
  }
  return v;
}

// ------------------------------------------------------------------------------------ unit symbols
static pl_symbol base_symbol(pl_pool* p, int i) {
  pl_symbol s = pl_symbol_find(p, base_ascii[i]);
  if (s.id) return s;
  pl_symbol_info info = {.name = base_names[i],
                         .ascii = base_ascii[i],
                         .role = PL_R_LOCAL,
                         .class = PL_C_OTHER,
                         .sign = PL_SIGN_POSITIVE,
                         .dimension = pl_dimension_one(),
                         .dimension_known = true};
  info.dimension.num[i] = 1;
  return pl_symbol_make(p, &info);
}

bool pl_unit_is_symbol(const pl_pool* p, pl_symbol s) {
  if (!s.id) return false;
  const pl_symbol_info* info = pl_symbol_get(p, s);
  return info->ascii && info->ascii[0] == '[';
}

// The product of SI base units of a dimension.
static pl_expr base_product(pl_pool* p, pl_exponents d) {
  pl_expr e = pl_int(p, 1);
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    if (d.e[i].num == 0) continue;
    pl_expr power = pl_ratio(p, (long)d.e[i].num, (long)d.e[i].den);
    e = pl_mul(p, e, pl_pow(p, pl_sym(p, base_symbol(p, i)), power));
  }
  return e;
}

// The dimension of an expression that has numbers and numbers with units only; false: its terms do
// not fit together.
static bool measure_dimension(const pl_pool* p, pl_expr e, pl_dimension* out) {
  *out = pl_dimension_one();
  pl_exponents sum = pl_exponents_zero();
  int n = pl_n_args(p, e);
  pl_dimension x;
  long num, den;
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER:
    case PL_PI: return true;
    case PL_SYMBOL: *out = pl_symbol_get(p, pl_symbol_of(p, e))->dimension; return true;
    case PL_MUL:
      for (int i = 0; i < n; i++) {
        if (!measure_dimension(p, pl_arg(p, e, i), &x)) return false;
        sum = pl_exponents_add(sum, (pl_fraction){1, 1}, pl_exponents_of(x));
      }
      return pl_exponents_get_dimension(sum, out);
    case PL_POW:
      if (!measure_dimension(p, pl_arg(p, e, 0), &x)
          || !pl_is_ratio(p, pl_arg(p, e, 1), &num, &den))
        return false;
      return pl_exponents_get_dimension(
          pl_exponents_add(sum, pl_fraction_make(num, den), pl_exponents_of(x)), out);
    case PL_ADD:
      for (int i = 0; i < n; i++) {
        if (!measure_dimension(p, pl_arg(p, e, i), &x)) return false;
        if (i > 0 && !pl_dimension_equal(x, *out)) return false;
        *out = x;
      }
      return true;
    default: return false;
  }
}

// A unit as it is displayed: "kg m^2" with raised digits, one blank or a point between its parts.
static const char* displayed_unit(pl_arena* a, const char* text) {
  static const char* const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  pl_text t = pl_text_make(a);
  for (const char* s = text; *s; s++) {
    bool exponent = *s == '^' && (s[1] == '-' || (s[1] >= '0' && s[1] <= '9'));
    if (*s == '*') pl_text_add(&t, " ");
    else if (!exponent) pl_text_add_n(&t, s, 1);
    if (!exponent) continue;
    if (s[1] == '-') {
      pl_text_add(&t, "⁻");
      s++;
    }
    while (s[1] >= '0' && s[1] <= '9') pl_text_add(&t, raised[*++s - '0']);
  }
  return pl_text_string(&t);
}

pl_expr pl_measure_make(pl_pool* p, pl_expr number, const pl_unit* unit, const char* text) {
  pl_expr si = pl_mul(p, number, unit->scale);
  bool pure = pl_dimension_equal(unit->dimension, pl_dimension_one());
  if (pl_is_poison(si) || pl_is_zero_node(p, si) || pure) return si;
  double size = pl_eval(p, si, PL_ARRAY(pl_pool_arena(p), double, pl_symbol_count(p) + 1));
  if (!(size > 0)) return pl_neg(p, pl_measure_make(p, pl_neg(p, number), unit, text));
  pl_arena* a = pl_pool_arena(p);
  const char* ascii = pl_format(a, "[%s %s]", pl_expr_text(a, p, si),
                                pl_dimension_unit(a, unit->dimension, true));
  pl_symbol_info info = {
      .name = pl_format(a, "%s %s", pl_expr_text(a, p, number), displayed_unit(a, text)),
      .ascii = ascii,
      .role = PL_R_PARAM,
      .class = PL_C_NUMBER,
      .sign = PL_SIGN_POSITIVE,
      .dimension = unit->dimension,
      .dimension_known = true,
      .number = si,
      .written = number,
      .unit = displayed_unit(a, text)};
  return pl_sym(p, pl_symbol_make(p, &info));
}

// What numbers with units make together, 0.5 m + 20 cm = 0.7 m, in the unit of the first that has
// the dimension of the result; e itself where something else occurs in it, or where it adds what
// cannot be added.
pl_expr pl_measure_join(pl_pool* p, pl_expr e) {
  pl_arena* a = pl_pool_arena(p);
  int n = pl_is_poison(e) ? 0 : pl_symbols_in(p, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(a, pl_symbol, n + 1);
  if (n) pl_symbols_in(p, e, s, n);
  pl_unit unit = {.scale = pl_int(p, 1)};
  for (int i = 0; i < n; i++) {
    if (pl_is_poison(pl_symbol_get(p, s[i])->number)) return e;
  }
  if (n == 0 || pl_is_measure(p, e) || !measure_dimension(p, e, &unit.dimension)) return e;
  const char* text = pl_dimension_unit(a, unit.dimension, false);
  for (int i = 0; i < n; i++) {
    const pl_symbol_info* info = pl_symbol_get(p, s[i]);
    if (!pl_dimension_equal(info->dimension, unit.dimension)) continue;
    unit.scale = pl_div(p, info->number, info->written);
    text = info->unit;
    break;
  }
  return pl_measure_make(p, pl_div(p, pl_without_measures(p, e), unit.scale), &unit, text);
}

// e with the base units taken out, [m] = 1; numbers with units stay.
pl_expr pl_unit_drop(pl_pool* p, pl_expr e) {
  pl_replace replace[PL_N_BASE_UNITS];
  int n = 0;
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    pl_symbol s = pl_symbol_find(p, base_ascii[i]);
    if (s.id) replace[n++] = (pl_replace){s, pl_int(p, 1)};
  }
  return n && !pl_is_poison(e) ? pl_subst(p, e, replace, n) : e;
}

pl_expr pl_unit_to_si(pl_pool* p, pl_expr e) { return pl_unit_drop(p, pl_without_measures(p, e)); }

bool pl_unit_occurs(const pl_pool* p, pl_expr e) {
  int n_symbols = pl_symbols_in(p, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(pl_pool_arena(p), pl_symbol, n_symbols + 1);
  pl_symbols_in(p, e, s, n_symbols);
  for (int i = 0; i < n_symbols; i++) {
    if (pl_unit_is_symbol(p, s[i])) return true;
  }
  return false;
}
// -------------------------------------------------------------------------------------- near names
static bool same_but_case(const char* a, size_t n, const char* b) {
  if (strlen(b) != n) return false;
  for (size_t i = 0; i < n; i++) {
    char x = a[i], y = b[i];
    if (x >= 'A' && x <= 'Z') x = (char)(x + 32);
    if (y >= 'A' && y <= 'Z') y = (char)(y + 32);
    if (x != y) return false;
  }
  return true;
}

// Prefix and symbol in the wrong case: "KHZ", "Mm" is fine as it is, "kw".
static const char* near_by_case(pl_arena* a, const char* word, size_t n) {
  static const char* const common[] = {"k", "m", "M", "c", "G"};
  for (size_t j = 0; j < sizeof common / sizeof common[0]; j++) {
    for (int i = 0; i < N_UNIT_ROWS && n > 1; i++) {
      if (unit_rows[i].prefixed && same_but_case(word, 1, common[j])
          && same_but_case(word + 1, n - 1, unit_rows[i].name)) {
        return pl_format(a, "%s%s", common[j], unit_rows[i].name);
      }
    }
  }
  for (int i = 0; i < N_UNIT_ROWS; i++) {
    if (same_but_case(word, n, unit_rows[i].name)) return unit_rows[i].name;
  }
  return NULL;
}

const char* pl_unit_near(pl_arena* a, const char* word, size_t n) {
  for (int i = 0; i < N_UNIT_WORDS; i++) {
    if (same_but_case(word, n, unit_words[i].word)) return unit_words[i].unit;
  }
  const char* by_case = near_by_case(a, word, n);
  if (by_case) return by_case;
  if (n < 2) return NULL;

  // one typing error, two in long words
  const char* text = pl_copy_n(a, word, n);
  int best = n > 4 ? 3 : 2;
  const char* near = NULL;
  // the units of every day before all others: kq is meant to be kg rather than Bq
  static const char* const common[] = {"kg", "cm", "mm", "km", "ms", "kN", "Nm", "Hz"};
  for (size_t i = 0; i < sizeof common / sizeof common[0]; i++) {
    int d = pl_edit_distance(text, common[i], best);
    if (d < best) {
      best = d;
      near = common[i];
    }
  }
  for (int i = 0; i < N_UNIT_ROWS; i++) {
    int d = pl_edit_distance(text, unit_rows[i].name, best);
    if (d < best && strlen(unit_rows[i].name) > 1) {
      best = d;
      near = unit_rows[i].name;
    }
  }
  for (int i = 0; i < N_UNIT_WORDS; i++) {
    int d = pl_edit_distance(text, unit_words[i].word, best);
    if (d < best && strlen(unit_words[i].word) > 3) {
      best = d;
      near = unit_words[i].unit;
    }
  }
  return near;
}

// ------------------------------------------------------------------------------------------- entry
bool pl_unit_parse(pl_pool* p, const char* text, size_t n, pl_unit* out, size_t* bad_at,
                   size_t* bad_n, const char** near) {
  unit_reader r = {.pool = p, .begin = text, .at = text, .end = text + n};
  unit_value v = read_unit(&r);
  skip_blanks(&r);
  if (!r.bad && r.at < r.end) refuse(&r, r.at, (size_t)(r.end - r.at), NULL);

  pl_unit unit = {pl_poison(), pl_dimension_one(), v.angle, v.scale};
  if (!r.bad
      && (!pl_exponents_get_dimension(v.dimension, &unit.dimension) || pl_is_poison(v.scale)))
    refuse(&r, text, n, NULL);
  if (r.bad) {
    if (bad_at) *bad_at = (size_t)(r.bad - text);
    if (bad_n) *bad_n = r.bad_n;
    if (near) *near = r.near;
    return false;
  }
  unit.factor = pl_mul(p, v.scale, base_product(p, v.dimension));
  *out = unit;
  return true;
}

// ------------------------------------------------------------------------------------- explanation
// The name in words of a text that is one symbol, perhaps with a prefix.
static const char* symbol_words(pl_arena* a, const char* text) {
  const unit_row* row;
  int power;
  if (!find_symbol(text, strlen(text), &row, &power)) return NULL;
  return power ? pl_format(a, "10^%d %s", power, row->words) : row->words;
}

static bool row_has_dimension(const unit_row* row, pl_dimension d) {
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    if (d.den[i] != 1 || d.num[i] != row->exponent[i]) return false;
  }
  return true;
}

static void list_same_dimension(pl_text* t, pl_dimension d, const char* text, pl_language lang) {
  int n = 0;
  for (int i = 0; i < N_UNIT_ROWS && n < 12; i++) {
    if (!row_has_dimension(&unit_rows[i], d) || strcmp(unit_rows[i].name, text) == 0) continue;
    if (n == 0) pl_text_add(t, lang == PL_GERMAN ? pl_german("  fits with  ") : "  fits with  ");
    pl_text_addf(t, "%s%s", n ? ", " : "", unit_rows[i].name);
    n++;
  }
  if (n) pl_text_add(t, "\n");
}

const char* pl_unit_explain(pl_arena* a, pl_pool* p, const char* text, pl_language lang) {
  bool german = lang == PL_GERMAN;
  pl_text t = pl_text_make(a);
  pl_unit unit;
  size_t at, n;
  const char* near = NULL;
  if (!pl_unit_parse(p, text, strlen(text), &unit, &at, &n, &near)) {
    pl_text_addf(&t, german ? pl_german("%s  is not a unit") : "%s  is not a unit", text);
    if (n && n < strlen(text))
      pl_text_addf(&t, german ? pl_german(": \"%.*s\" is not known") : ": \"%.*s\" is not known",
                   (int)n, text + at);
    pl_text_add(&t, "\n");
    if (near)
      pl_text_addf(&t, german ? pl_german("  meant?     %.*s%s%s\n") : "  meant?     %.*s%s%s\n",
                   (int)at, text, near, text + at + n);
    return pl_text_string(&t);
  }
  pl_text_add(&t, text);
  const char* words = symbol_words(a, text);
  if (words) pl_text_addf(&t, "  (%s)", words);
  pl_text_add(&t, "\n");
  pl_text_addf(&t, german ? pl_german("  is         %s\n") : "  is         %s\n",
               pl_dimension_words(a, unit.dimension, lang));
  pl_text_addf(&t, german ? "  in SI      1 %s = %s %s\n" : "  in SI      1 %s = %s %s\n", text,
               pl_expr_text(a, p, unit.scale), pl_dimension_unit(a, unit.dimension, false));
  if (!pl_is_number(p, unit.scale)) {
    double* none = PL_ARRAY(a, double, pl_symbol_count(p) + 1);
    pl_text_addf(&t, german ? pl_german("  that is    %.17g\n") : "  that is    %.17g\n",
                 pl_eval(p, unit.scale, none));
  }
  list_same_dimension(&t, unit.dimension, text, lang);
  return pl_text_string(&t);
}

const char* pl_unit_name(int i) { return i >= 0 && i < N_UNIT_ROWS ? unit_rows[i].name : NULL; }
