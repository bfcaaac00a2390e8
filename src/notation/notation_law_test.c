// Laws on random forms: a line, in Unicode or ASCII, is read back by the rules of the model
// language as the same value; ASCII is ASCII; TeX braces and MathML tags are balanced; a picture
// has as many lines as it says.
//
// The reader below follows the language page: blank products, one factor after a function name,
// sin²x, and rule 5: after a division by anything but a plain number a blank product is refused.
#include "notation/notation.h"

#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct fixture {
  pl_arena* a;
  pl_pool* p;
  pl_expr atom[12];
  int n;
} fixture;

static void add_symbol(fixture* f, const char* name, const char* ascii, pl_role role,
                       pl_class class) {
  pl_symbol_info i = {.name = name, .ascii = ascii, .role = role, .class = class};
  f->atom[f->n++] = pl_sym(f->p, pl_symbol_make(f->p, &i));
}

static int set_up(void** state) {
  pl_arena* a = pl_arena_make(NULL);
  fixture* f = PL_NEW(a, fixture);
  f->a = a;
  f->p = pl_pool_make(a);
  add_symbol(f, "m1", "m1", PL_R_PARAM, PL_C_MASS);
  add_symbol(f, "g", "g", PL_R_PARAM, PL_C_GRAVITY);
  add_symbol(f, "l", "l", PL_R_PARAM, PL_C_LENGTH);
  add_symbol(f, "ϑ", "theta", PL_R_COORD, PL_C_COORD);
  add_symbol(f, "x1", "x1", PL_R_COORD, PL_C_COORD);
  add_symbol(f, "λ_h", "lambda_h", PL_R_MULTIPLIER, PL_C_MULTIPLIER);
  for (int i = 3; i <= 4; i++) {
    pl_symbol v = pl_symbol_dot(f->p, pl_symbol_of(f->p, f->atom[i]));
    f->atom[f->n++] = pl_sym(f->p, v);
    f->atom[f->n++] = pl_sym(f->p, pl_symbol_dot(f->p, v));
  }
  f->atom[f->n++] = pl_sym(f->p, pl_symbol_start(f->p, pl_symbol_of(f->p, f->atom[4])));
  f->atom[f->n++] = pl_pi(f->p);
  *state = f;
  return 0;
}

static int tear_down(void** state) {
  fixture* f = *state;
  pl_arena_free(f->a);
  return 0;
}

// -------------------------------------------------------------------------------------- the reader
// bare: what was read last is a function with a name (1) or a number (2) as its argument, without
// brackets.
typedef struct reader {
  fixture* f;
  const char *s, *why;
  int bare;
} reader;
static pl_expr read_sum(reader* r);
static pl_expr read_factor(reader* r);

static pl_expr refuse(reader* r, const char* why) {
  if (!r->why) r->why = why;
  return pl_poison();
}

static bool blank(reader* r) {
  bool any = *r->s == ' ';
  while (*r->s == ' ') r->s++;
  return any;
}

static bool take(reader* r, const char* sign) {
  size_t n = strlen(sign);
  if (strncmp(r->s, sign, n) != 0) return false;
  r->s += n;
  return true;
}

static bool takes_superscript(reader* r, long* value) {
  static const char* const digit[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  bool minus = take(r, "⁻"), any = false;
  long n = 0;
  for (int i = 0; i < 10; i++) {
    if (!take(r, digit[i])) continue;
    n = 10 * n + i;
    any = true;
    i = -1;
  }
  if (any) *value = minus ? -n : n;
  return any;
}

static bool is_letter(const char* s) {
  uint32_t c = 0;
  if (pl_utf8_decode(s, s + strlen(s), &c) <= 0) return false;
  return c < 128 ? isalpha((int)c) != 0 : c >= 0x370 && c < 0x400;
}

static const char* take_name(reader* r) {
  const char* begin = r->s;
  while (is_letter(r->s) || isdigit((unsigned char)*r->s) || *r->s == '_') {
    uint32_t c;
    r->s += pl_utf8_decode(r->s, r->s + strlen(r->s), &c);
  }
  return pl_copy_n(r->f->a, begin, (size_t)(r->s - begin));
}

static int function_named(const char* name) {
  for (int i = 0; i < PL_N_FUNCTIONS; i++)
    if (strcmp(pl_function_name[i], name) == 0) return i;
  return -1;
}

// A function takes exactly one factor: a bracket directly behind it, or what stands after a blank.
static pl_expr read_application(reader* r, int function) {
  pl_pool* p = r->f->p;
  long power = 1;
  if (!takes_superscript(r, &power) && take(r, "^"))
    power = strtol(r->s, (char**)(uintptr_t)&r->s, 10);
  if (power < 1) return refuse(r, "sin^-1 is refused");
  blank(r);
  pl_expr argument;
  int bare = 0;
  if (take(r, "(")) {
    argument = read_sum(r);
    if (!take(r, ")")) return refuse(r, "bracket after function");
  } else {
    bare = isdigit((unsigned char)*r->s) ? 2 : 1;
    argument = read_factor(r);
  }
  r->bare = bare;
  pl_expr value = function < 0 ? pl_sqrt(p, argument) : pl_call(p, (pl_function)function, argument);
  return pl_pow_int(p, value, power);
}

static pl_expr symbol_named(reader* r, const char* name) {
  fixture* f = r->f;
  int dots = 0;
  while (take(r, "'")) dots++;
  bool start = take(r, "(0)");
  for (int i = 0; i < 6; i++) {
    pl_symbol s = pl_symbol_of(f->p, f->atom[i]);
    const pl_symbol_info* info = pl_symbol_get(f->p, s);
    if (strcmp(info->name, name) != 0 && strcmp(info->ascii, name) != 0) continue;
    for (int k = 0; k < dots; k++) s = pl_symbol_dot(f->p, s);
    if (start) s = pl_symbol_start(f->p, s);
    return pl_sym(f->p, s);
  }
  return refuse(r, pl_format(f->a, "unknown name %s", name));
}

static pl_expr read_primary(reader* r) {
  pl_pool* p = r->f->p;
  const char* begin = r->s;
  r->bare = 0;
  if (take(r, "(")) {
    pl_expr x = read_sum(r);
    r->bare = 0;
    return take(r, ")") ? x : refuse(r, "bracket is not closed");
  }
  if (isdigit((unsigned char)*r->s)) {
    while (isdigit((unsigned char)*r->s) || *r->s == '.') r->s++;
    return pl_number_from_text(p, begin, (size_t)(r->s - begin));
  }
  if (take(r, "√")) return read_application(r, -1);
  if (take(r, "π")) return pl_pi(p);
  if (!is_letter(r->s)) return refuse(r, pl_format(r->f->a, "unexpected %.8s", r->s));
  const char* name = take_name(r);
  if (strcmp(name, "pi") == 0) return pl_pi(p);
  if (strcmp(name, "sqrt") == 0) return read_application(r, -1);
  int function = function_named(name);
  return function >= 0 ? read_application(r, function) : symbol_named(r, name);
}

static pl_expr read_factor(reader* r) {
  pl_pool* p = r->f->p;
  pl_expr x = read_primary(r);
  long power;
  while (takes_superscript(r, &power)) x = pl_pow_int(p, x, power);
  if (!take(r, "^")) return x;
  return pl_pow(p, x, read_factor(r));
}

static bool function_follows(reader* r) {
  reader ahead = *r;
  if (strncmp(r->s, "√", strlen("√")) == 0) return true;
  const char* name = is_letter(r->s) ? take_name(&ahead) : "";
  return strcmp(name, "sqrt") == 0 || function_named(name) >= 0;
}

static bool factor_follows(reader* r) {
  return *r->s == '(' || isdigit((unsigned char)*r->s) || is_letter(r->s)
         || strncmp(r->s, "√", strlen("√")) == 0;
}

// After `cos φ` no bare name or number may follow, after `√2` nothing but a function.
static bool misleading(reader* r) {
  if (!r->bare || function_follows(r)) return false;
  reader ahead = *r;
  if (isdigit((unsigned char)*ahead.s) || r->bare == 2) return true;
  if (!is_letter(ahead.s)) return false;
  take_name(&ahead);
  return *ahead.s != '\'';
}

static pl_expr read_term(reader* r) {
  pl_pool* p = r->f->p;
  pl_expr x = read_factor(r);
  bool divided = false;
  for (;;) {
    blank(r);
    if (take(r, "*") || take(r, "·")) {
      x = pl_mul(p, x, read_factor(r));
    } else if (take(r, "/")) {
      blank(r);
      bool minus = take(r, "-");
      const char* begin = r->s;
      pl_expr y = read_factor(r);
      size_t n = (size_t)(r->s - begin);
      if (strspn(begin, "0123456789.") < n || minus) divided = true;
      x = pl_div(p, x, minus ? pl_neg(p, y) : y);
    } else if (factor_follows(r)) {
      if (divided) return refuse(r, "a blank product after a division");
      if (misleading(r)) return refuse(r, "this could belong to the argument of the function");
      x = pl_mul(p, x, read_factor(r));
    } else {
      return x;
    }
  }
}

static pl_expr read_sum(reader* r) {
  pl_pool* p = r->f->p;
  blank(r);
  bool minus = take(r, "-");
  pl_expr x = read_term(r);
  if (minus) x = pl_neg(p, x);
  for (blank(r); *r->s == '+' || *r->s == '-'; blank(r)) {
    char op = *r->s++;
    blank(r);
    pl_expr y = read_term(r);
    x = op == '+' ? pl_add(p, x, y) : pl_sub(p, x, y);
  }
  return x;
}

// ------------------------------------------------------------------------------------ random forms
static const pl_form* random_form(fixture* f, pl_random* r, int depth);

static const pl_form* random_leaf(fixture* f, pl_random* r) {
  static const char* const numbers[] = {"2", "3", "12", "1/2", "2/3", "9.81", "0.05", "1"};
  if (pl_random_bits(r) % 3) return pl_form_leaf(f->a, f->atom[pl_random_bits(r) % (uint64_t)f->n]);
  const char* text = numbers[pl_random_bits(r) % (sizeof numbers / sizeof *numbers)];
  pl_expr number = pl_number_from_text(f->p, text, strlen(text));
  return pl_form_leaf(f->a, pl_random_bits(r) % 4 ? number : pl_neg(f->p, number));
}

static const pl_form* random_list(fixture* f, pl_random* r, pl_form_kind kind, int depth) {
  const pl_form* args[3];
  int n = 2 + (int)(pl_random_bits(r) % 2);
  for (int i = 0; i < n; i++) args[i] = random_form(f, r, depth - 1);
  return pl_form_make(f->a, kind, n, args);
}

static const pl_form* random_power(fixture* f, pl_random* r, int depth) {
  static const long num[] = {2, 3, -1, -2, 1, 3, 10}, den[] = {1, 1, 1, 1, 2, 2, 1};
  size_t k = pl_random_bits(r) % (sizeof num / sizeof *num);
  return pl_form_power(f->a, random_form(f, r, depth - 1),
                       pl_form_leaf(f->a, pl_ratio(f->p, num[k], den[k])));
}

static const pl_form* random_form(fixture* f, pl_random* r, int depth) {
  static const pl_function functions[] = {PL_SIN, PL_COS, PL_TAN, PL_EXP, PL_ABS, PL_LN, PL_SINH};
  if (depth == 0) return random_leaf(f, r);
  switch (pl_random_bits(r) % 9) {
    case 0:
    case 1: return random_list(f, r, PL_F_SUM, depth);
    case 2:
    case 3: return random_list(f, r, PL_F_PRODUCT, depth);
    case 4:
      return pl_form_quotient(f->a, random_form(f, r, depth - 1), random_form(f, r, depth - 1));
    case 5: return random_power(f, r, depth);
    case 6: return pl_form_root(f->a, random_form(f, r, depth - 1));
    case 7: return pl_form_neg(f->a, random_form(f, r, depth - 1));
    default: {
      const pl_form* x = random_form(f, r, depth - 1);
      return pl_form_call(
          f->a, functions[pl_random_bits(r) % (sizeof functions / sizeof *functions)], &x, 1);
    }
  }
}

// -------------------------------------------------------------------------------------------- laws
static bool same_value(fixture* f, pl_expr x, pl_expr y) {
  if (pl_same(x, y)) return true;
  int good = 0;
  for (uint64_t seed = 1; seed < 30 && good < 3; seed++) {
    pl_mod_point* m = pl_mod_point_make(f->a, f->p, seed);
    bool ok_x = true, ok_y = true;
    uint64_t a = pl_eval_mod(m, x, &ok_x), b = pl_eval_mod(m, y, &ok_y);
    if (!ok_x || !ok_y) continue;
    if (a != b) return false;
    good++;
  }
  return true;
}

static void read_back(fixture* f, uint64_t seed, const pl_form* form, pl_math math) {
  pl_expr value = pl_form_value(f->p, form);
  const char* text = pl_notation_print(f->a, f->p, form, (pl_notation){math, PL_ENGLISH});
  reader r = {.f = f, .s = text};
  pl_expr got = read_sum(&r);
  blank(&r);
  if (r.why || *r.s)
    fail_msg("seed %llu: %s: %s", (unsigned long long)seed, text, r.why ? r.why : "text left over");
  if (pl_is_poison(value) || pl_is_poison(got)) return;
  if (!same_value(f, value, got))
    fail_msg("seed %llu: %s has another value than %s", (unsigned long long)seed, text,
             pl_expr_text(f->a, f->p, value));
}

static void a_line_is_read_back_as_the_same_value(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 4000; seed++) {
    pl_random r = {seed};
    const pl_form* form = random_form(f, &r, 1 + (int)(seed % 4));
    read_back(f, seed, form, PL_MATH_LINE);
    read_back(f, seed, form, PL_MATH_ASCII);
  }
}

static void plain_forms_are_read_back_too(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 1000; seed++) {
    pl_random r = {seed * 77u};
    pl_expr e = pl_form_value(f->p, random_form(f, &r, 3));
    if (pl_is_poison(e)) continue;
    read_back(f, seed, pl_form_of(f->a, f->p, e), PL_MATH_LINE);
    read_back(f, seed, pl_form_of(f->a, f->p, e), PL_MATH_ASCII);
  }
}

static void ascii_is_ascii(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 500; seed++) {
    pl_random r = {seed};
    const char* s = pl_notation_print(f->a, f->p, random_form(f, &r, 4),
                                      (pl_notation){PL_MATH_ASCII, PL_GERMAN});
    for (; *s; s++)
      if ((unsigned char)*s >= 128 || *s < ' ')
        fail_msg("seed %llu: %s", (unsigned long long)seed, s);
  }
}

static void tex_braces_are_balanced(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 500; seed++) {
    pl_random r = {seed};
    const char* text = pl_notation_print(f->a, f->p, random_form(f, &r, 4),
                                         (pl_notation){PL_MATH_TEX, PL_ENGLISH});
    int open = 0, left = 0;
    for (const char* s = text; *s; s++) {
      open += (*s == '{') - (*s == '}');
      left += (strncmp(s, "\\left", 5) == 0) - (strncmp(s, "\\right", 6) == 0);
      if (open < 0 || left < 0) break;
    }
    if (open || left) fail_msg("seed %llu: %s", (unsigned long long)seed, text);
    if (strstr(text, "^{") && strstr(text, "}^{") && strstr(text, "}^{}"))
      fail_msg("seed %llu: %s", (unsigned long long)seed, text);
  }
}

// Every tag that opens closes, in order.
static bool tags_match(fixture* f, const char* s) {
  const char* stack[256];
  int n = 0;
  while ((s = strchr(s, '<'))) {
    const char* end = strchr(s, '>');
    if (!end) return false;
    bool closes = s[1] == '/';
    const char* name = s + 1 + closes;
    const char* tag = pl_copy_n(f->a, name, strcspn(name, " />"));
    if (closes && (n == 0 || strcmp(stack[--n], tag) != 0)) return false;
    if (!closes && end[-1] != '/') {
      if (n == 256) return false;
      stack[n++] = tag;
    }
    s = end;
  }
  return n == 0;
}

static void mathml_is_well_formed(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 500; seed++) {
    pl_random r = {seed};
    const char* s = pl_notation_print(f->a, f->p, random_form(f, &r, 4),
                                      (pl_notation){PL_MATH_MATHML, PL_ENGLISH});
    if (!tags_match(f, s)) fail_msg("seed %llu: %s", (unsigned long long)seed, s);
  }
}

static void a_picture_has_the_height_it_says(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 500; seed++) {
    pl_random r = {seed};
    int above, below, lines = 1;
    const char* s = pl_notation_print_2d(f->a, f->p, random_form(f, &r, 4),
                                         (pl_notation){PL_MATH_2D, PL_ENGLISH}, &above, &below);
    for (const char* c = s; *c; c++) lines += *c == '\n';
    if (lines != above + below + 1)
      fail_msg("seed %llu: %d lines, %d above, %d below\n%s", (unsigned long long)seed, lines,
               above, below, s);
  }
}

// A displayed number, read again, is the number to the digits shown.
static void measured_numbers_keep_their_digits(void** state) {
  fixture* f = *state;
  pl_random r = {2024};
  for (int i = 0; i < 2000; i++) {
    double x = (pl_random_unit(&r) - 0.5) * 2;
    for (int k = (int)(pl_random_bits(&r) % 40) - 20; k; k += k > 0 ? -1 : 1) x *= k > 0 ? 10 : 0.1;
    const char* s = pl_notation_number(f->a, x, 6, (pl_notation){PL_MATH_LINE, PL_ENGLISH});
    double back = strtod(s, NULL);
    if (back < x ? x - back > 5.1e-6 * (x < 0 ? -x : x) : back - x > 5.1e-6 * (x < 0 ? -x : x))
      fail_msg("%.17g as %s", x, s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
#define T(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
      T(a_line_is_read_back_as_the_same_value),
      T(plain_forms_are_read_back_too),
      T(ascii_is_ascii),
      T(tex_braces_are_balanced),
      T(mathml_is_well_formed),
      T(a_picture_has_the_height_it_says),
      T(measured_numbers_keep_their_digits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
