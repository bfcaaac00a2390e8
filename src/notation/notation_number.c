// Numbers for display: exact ones inside formulas, measured ones beside them.
#include "notation_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The decimal sign of the language: German displays write a comma, the ASCII of the model language
// never does.
static char decimal_sign(pl_notation how) {
  return how.lang == PL_GERMAN && how.math != PL_MATH_ASCII ? ',' : '.';
}

// The decimal comma as each manner writes it: TeX takes a bare comma for punctuation.
static void add_mantissa(pl_text* out, const char* s, pl_notation how) {
  for (; *s; s++) {
    if (*s == '.' && decimal_sign(how) == ',')
      pl_text_add(out, how.math == PL_MATH_TEX ? "{,}" : ",");
    else pl_text_add_n(out, s, 1);
  }
}

// ----------------------------------------------------------------------------------- exact numbers
// The exponent k with den | 10^k, or -1 if there is none.
static int all_decimal_places(const char* den) {
  if (strlen(den) > 15) return -1;
  long long d = strtoll(den, NULL, 10);
  int twos = 0, fives = 0;
  while (d % 2 == 0) {
    d /= 2;
    twos++;
  }
  while (d % 5 == 0) {
    d /= 5;
    fives++;
  }
  if (d != 1) return -1;
  return twos > fives ? twos : fives;
}

// The same for denominators written in decimal: such numbers came from decimals.
// A denominator without the factor 5 (1/2, 3/8) and the fifths stay fractions.
static int decimal_places(const char* den) {
  if (strlen(den) > 15) return -1;
  long long d = strtoll(den, NULL, 10);
  if (d < 10 || d % 5 != 0) return -1;
  return all_decimal_places(den);
}

// num * 10^places / den as digits with a decimal point. num and den are short: the caller has
// looked.
static const char* decimal_digits(pl_arena* a, const char* num, const char* den, int places) {
  unsigned long long n = strtoull(num, NULL, 10), d = strtoull(den, NULL, 10), scale = 1;
  for (int i = 0; i < places; i++) scale *= 10;
  unsigned long long f = scale / d;
  if (f && n > 999999999999999999ull / f) return NULL;
  unsigned long long v = n * f;
  return pl_format(a, "%llu.%0*llu", v / scale, places, v % scale);
}

void pl_number_parts(pl_arena* a, const pl_pool* p, pl_expr e, pl_notation how, bool* negative,
                     const char** num, const char** den) {
  const char* n = pl_number_num_text(a, p, e);
  const char* d = pl_number_den_text(a, p, e);
  *negative = n[0] == '-';
  if (*negative) n++;
  *num = n;
  *den = strcmp(d, "1") == 0 ? NULL : d;
  if (!*den) return;
  int places = strlen(n) <= 18 ? decimal_places(d) : -1;
  if (places < 0 || places > 15) return;
  const char* digits = decimal_digits(a, n, d, places);
  if (!digits) return;
  pl_text t = pl_text_make(a);
  add_mantissa(&t, digits, how);
  *num = pl_text_string(&t);
  *den = NULL;
}

const char* pl_number_decimal(pl_arena* a, const pl_pool* p, pl_expr e, pl_notation how) {
  const char *num = pl_number_num_text(a, p, e), *den = pl_number_den_text(a, p, e);
  if (strcmp(den, "1") == 0) return num;
  int places = strlen(num) <= 18 && num[0] != '-' ? all_decimal_places(den) : -1;
  const char* digits = places >= 0 && places <= 15 ? decimal_digits(a, num, den, places) : NULL;
  pl_text t = pl_text_make(a);
  if (digits) add_mantissa(&t, digits, how);
  return digits ? pl_text_string(&t) : NULL;
}

// -------------------------------------------------------------------------------- measured numbers
static const char* minus_sign(pl_notation how) {
  switch (how.math) {
    case PL_MATH_2D: return "−";
    case PL_MATH_MATHML: return "<mo form=\"prefix\" lspace=\"0\" rspace=\"0\">−</mo>";
    default: return "-";
  }
}

// Splits "%.*e" output into mantissa without trailing zeros and exponent.
static int scientific(double x, int digits, char mantissa[64]) {
  char s[64];
  snprintf(s, sizeof s, "%.*e", digits - 1, x);
  char* e = strchr(s, 'e');
  int exponent = atoi(e + 1);
  *e = 0;
  if (strchr(s, '.')) {
    size_t n = strlen(s);
    while (s[n - 1] == '0') s[--n] = 0;
    if (s[n - 1] == '.') s[n - 1] = 0;
  }
  strcpy(mantissa, s);
  return exponent;
}

static void positional(double x, int decimals, char out[400]) {
  snprintf(out, 400, "%.*f", decimals, x);
  if (!strchr(out, '.')) return;
  size_t n = strlen(out);
  while (out[n - 1] == '0') out[--n] = 0;
  if (out[n - 1] == '.') out[n - 1] = 0;
}

static void add_exponent(pl_text* t, int e, pl_notation how) {
  char s[16];
  snprintf(s, sizeof s, "%d", e);
  switch (how.math) {
    case PL_MATH_2D: pl_text_addf(t, "·10%s", pl_superscript(t->arena, s)); break;
    case PL_MATH_TEX: pl_text_addf(t, "\\cdot 10^{%d}", e); break;
    case PL_MATH_MATHML:
      pl_text_add(t, "<mo>·</mo><msup><mn>10</mn>");
      if (e < 0) pl_text_addf(t, "<mrow>%s<mn>%d</mn></mrow></msup>", minus_sign(how), -e);
      else pl_text_addf(t, "<mn>%d</mn></msup>", e);
      break;
    default: pl_text_addf(t, "e%d", e); break;
  }
}

static const char* not_finite(pl_arena* a, double x, pl_notation how) {
  if (isnan(x))
    return how.math == PL_MATH_MATHML ? "<mi>NaN</mi>"
           : how.math == PL_MATH_TEX  ? "\\mathrm{NaN}"
                                      : "NaN";
  static const char* const infinity[] = {"∞", "∞", "inf", "\\infty", "<mi>∞</mi>"};
  return pl_format(a, "%s%s", x < 0 ? minus_sign(how) : "", infinity[how.math]);
}

const char* pl_notation_number(pl_arena* a, double x, int digits, pl_notation how) {
  if (!isfinite(x)) return not_finite(a, x, how);
  if (digits < 1) digits = 1;
  if (digits > 17) digits = 17;
  char body[400];
  bool negative = x < 0;
  double size = fabs(x);
  int e = size > 0 ? scientific(size, digits, body) : (strcpy(body, "0"), 0);
  // small exponents are written out, like printf's %g but a little further down
  bool plain = e >= -4 && e < (digits > 6 ? digits : 6);
  if (plain && size > 0) positional(size, digits - 1 - e > 0 ? digits - 1 - e : 0, body);
  pl_text t = pl_text_make(a);
  if (negative) pl_text_add(&t, minus_sign(how));
  if (how.math == PL_MATH_MATHML) pl_text_add(&t, "<mn>");
  add_mantissa(&t, body, how);
  if (how.math == PL_MATH_MATHML) pl_text_add(&t, "</mn>");
  if (!plain) add_exponent(&t, e, how);
  return pl_text_string(&t);
}
