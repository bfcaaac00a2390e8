// Physical dimensions: rational exponents of the seven base units, and how they are called.
#include "base/base.h"

#include <stdlib.h>
#include <string.h>

static const char* const base_units[PL_N_BASE_UNITS] = {"m", "kg", "s", "A", "K", "mol", "cd"};
static const int written_order[PL_N_BASE_UNITS] = {1, 0, 2, 3, 4, 5, 6};  // kg before m: "kg m/s"

// -------------------------------------------------------------------------------------- arithmetic
static int gcd_int(int a, int b) {
  while (b != 0) {
    int r = a % b;
    a = b;
    b = r;
  }
  return abs(a);
}

// Exponents beyond what fits stop at the end of the range: no quantity of physics has them.
static int8_t clamp(int x) { return (int8_t)(x > 127 ? 127 : x < -127 ? -127 : x); }

static void set_exponent(pl_dimension* d, int i, int num, int den) {
  if (den < 0) {
    num = -num;
    den = -den;
  }
  int g = gcd_int(num, den);
  if (g > 1) {
    num /= g;
    den /= g;
  }
  d->num[i] = clamp(num);
  d->den[i] = clamp(den);
}

static int den_of(pl_dimension d, int i) { return d.den[i] > 0 ? d.den[i] : 1; }

pl_dimension pl_dimension_one(void) {
  pl_dimension d = {0};
  for (int i = 0; i < PL_N_BASE_UNITS; i++) d.den[i] = 1;
  return d;
}

pl_dimension pl_dimension_of(int m, int kg, int s) {
  pl_dimension d = pl_dimension_one();
  set_exponent(&d, 0, m, 1);
  set_exponent(&d, 1, kg, 1);
  set_exponent(&d, 2, s, 1);
  return d;
}

static pl_dimension combine(pl_dimension a, pl_dimension b, int sign) {
  pl_dimension d = pl_dimension_one();
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    int p = den_of(a, i), q = den_of(b, i);
    set_exponent(&d, i, a.num[i] * q + sign * b.num[i] * p, p * q);
  }
  return d;
}

pl_dimension pl_dimension_mul(pl_dimension a, pl_dimension b) { return combine(a, b, 1); }
pl_dimension pl_dimension_div(pl_dimension a, pl_dimension b) { return combine(a, b, -1); }

pl_dimension pl_dimension_pow(pl_dimension a, int num, int den) {
  if (den == 0) return pl_dimension_one();
  pl_dimension d = pl_dimension_one();
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    long n = (long)a.num[i] * num, m = (long)den_of(a, i) * den;
    if (labs(n) > 1000000 || labs(m) > 1000000) {
      n = n < 0 ? -127 : 127;
      m = 1;
    }
    set_exponent(&d, i, (int)n, (int)m);
  }
  return d;
}

bool pl_dimension_equal(pl_dimension a, pl_dimension b) {
  for (int i = 0; i < PL_N_BASE_UNITS; i++) {
    if (a.num[i] * den_of(b, i) != b.num[i] * den_of(a, i)) return false;
  }
  return true;
}

// ---------------------------------------------------------------------------- what they are called
// Exponents of m kg s A, unit (UTF-8 and ASCII) where a name fits better than base units, words
// (NULL: "a quantity in").
typedef struct named {
  int8_t m, kg, s, A;
  const char *unit, *ascii;
  const char* words;
} named;

// clang-format off
static const named known[] = {
  { 0, 0,  0,  0, "1",   "1",   PL_KEY("a pure number")},
  { 1, 0,  0,  0, NULL,  NULL,  PL_KEY("a length")},
  { 2, 0,  0,  0, NULL,  NULL,  PL_KEY("an area")},
  { 3, 0,  0,  0, NULL,  NULL,  PL_KEY("a volume")},
  { 0, 1,  0,  0, NULL,  NULL,  PL_KEY("a mass")},
  { 0, 0,  1,  0, NULL,  NULL,  PL_KEY("a time")},
  { 0, 0, -1,  0, NULL,  NULL,  PL_KEY("a frequency")},
  { 0, 0, -2,  0, NULL,  NULL,  PL_KEY("an angular acceleration")},
  { 1, 0, -1,  0, NULL,  NULL,  PL_KEY("a velocity")},
  { 1, 0, -2,  0, NULL,  NULL,  PL_KEY("an acceleration")},
  { 1, 1, -2,  0, "N",   "N",   PL_KEY("a force")},
  { 2, 1, -2,  0, "J",   "J",   PL_KEY("an energy")},
  { 2, 1, -3,  0, "W",   "W",   PL_KEY("a power")},
  {-1, 1, -2,  0, "Pa",  "Pa",  PL_KEY("a pressure")},
  { 0, 1, -2,  0, "N/m", "N/m", PL_KEY("a stiffness")},
  { 1, 1, -1,  0, NULL,  NULL,  PL_KEY("a momentum")},
  { 2, 1, -1,  0, NULL,  NULL,  PL_KEY("an angular momentum")},
  { 2, 1,  0,  0, NULL,  NULL,  PL_KEY("a moment of inertia")},
  {-3, 1,  0,  0, NULL,  NULL,  PL_KEY("a density")},
  {-1, 1,  0,  0, NULL,  NULL,  PL_KEY("a mass per length")},
  { 0, 0,  0,  1, NULL,  NULL,  PL_KEY("a current")},
  { 0, 0,  1,  1, "C",   "C",   PL_KEY("a charge")},
  { 2, 1, -3, -1, "V",   "V",   PL_KEY("a voltage")},
  { 2, 1, -3, -2, "Ω",   "Ohm", PL_KEY("a resistance")},
  {-2,-1,  4,  2, "F",   "F",   PL_KEY("a capacitance")},
  { 2, 1, -2, -2, "H",   "H",   PL_KEY("an inductance")},
  { 0, 1, -2, -1, "T",   "T",   PL_KEY("a magnetic field")},
  { 2, 1, -2, -1, "Wb",  "Wb",  PL_KEY("a magnetic flux")},
  { 1, 1, -3, -1, "V/m", "V/m", PL_KEY("an electric field")},
};
// clang-format on

static const named* find_named(pl_dimension d) {
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    pl_dimension k = pl_dimension_of(known[i].m, known[i].kg, known[i].s);
    k.num[3] = known[i].A;
    if (pl_dimension_equal(d, k)) return &known[i];
  }
  return NULL;
}

static void add_exponent(pl_text* t, int num, int den, bool ascii) {
  static const char* const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (num == 1 && den == 1) return;
  if (den != 1) {
    pl_text_addf(t, "^(%d/%d)", num, den);
  } else if (ascii) {
    pl_text_addf(t, "^%d", num);
  } else {
    if (num >= 100) pl_text_add(t, raised[num / 100]);
    if (num >= 10) pl_text_add(t, raised[num / 10 % 10]);
    pl_text_add(t, raised[num % 10]);
  }
}

// The base units with positive (sign 1) or negative (sign -1) exponents, separated by blanks.
// Returns how many.
static int add_units(pl_text* t, pl_dimension d, int sign, bool ascii) {
  int n = 0;
  for (int k = 0; k < PL_N_BASE_UNITS; k++) {
    int i = written_order[k];
    if (d.num[i] * sign <= 0) continue;
    if (n++ > 0) pl_text_add(t, " ");
    pl_text_add(t, base_units[i]);
    add_exponent(t, abs(d.num[i]), den_of(d, i), ascii);
  }
  return n;
}

const char* pl_dimension_unit(pl_arena* a, pl_dimension d, bool ascii) {
  const named* k = find_named(d);
  if (k != NULL && k->unit != NULL) return ascii ? k->ascii : k->unit;

  pl_text over = pl_text_make(a), under = pl_text_make(a);
  int n_over = add_units(&over, d, 1, ascii), n_under = add_units(&under, d, -1, ascii);
  const char* top = n_over ? pl_text_string(&over) : "1";
  if (n_under == 0) return top;
  return pl_format(a, n_under > 1 ? "%s/(%s)" : "%s/%s", top, pl_text_string(&under));
}

const char* pl_dimension_words(pl_arena* a, pl_dimension d, pl_language lang) {
  const named* k = find_named(d);
  if (k != NULL) return pl_in_language(lang, k->words);
  const char* unit = pl_dimension_unit(a, d, false);
  return pl_format(a, lang == PL_GERMAN ? pl_german("a quantity in %s") : "a quantity in %s", unit);
}
