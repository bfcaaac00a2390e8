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
  const char *en, *de;
} named;

// clang-format off
static const named known[] = {
  { 0, 0,  0,  0, "1",   "1",   "a pure number",          "eine reine Zahl"},
  { 1, 0,  0,  0, NULL,  NULL,  "a length",               "eine Länge"},
  { 2, 0,  0,  0, NULL,  NULL,  "an area",                "eine Fläche"},
  { 3, 0,  0,  0, NULL,  NULL,  "a volume",               "ein Volumen"},
  { 0, 1,  0,  0, NULL,  NULL,  "a mass",                 "eine Masse"},
  { 0, 0,  1,  0, NULL,  NULL,  "a time",                 "eine Zeit"},
  { 0, 0, -1,  0, NULL,  NULL,  "a frequency",            "eine Frequenz"},
  { 0, 0, -2,  0, NULL,  NULL,  "an angular acceleration", "eine Winkelbeschleunigung"},
  { 1, 0, -1,  0, NULL,  NULL,  "a velocity",             "eine Geschwindigkeit"},
  { 1, 0, -2,  0, NULL,  NULL,  "an acceleration",        "eine Beschleunigung"},
  { 1, 1, -2,  0, "N",   "N",   "a force",                "eine Kraft"},
  { 2, 1, -2,  0, "J",   "J",   "an energy",              "eine Energie"},
  { 2, 1, -3,  0, "W",   "W",   "a power",                "eine Leistung"},
  {-1, 1, -2,  0, "Pa",  "Pa",  "a pressure",             "ein Druck"},
  { 0, 1, -2,  0, "N/m", "N/m", "a stiffness",            "eine Federkonstante"},
  { 1, 1, -1,  0, NULL,  NULL,  "a momentum",             "ein Impuls"},
  { 2, 1, -1,  0, NULL,  NULL,  "an angular momentum",    "ein Drehimpuls"},
  { 2, 1,  0,  0, NULL,  NULL,  "a moment of inertia",    "ein Trägheitsmoment"},
  {-3, 1,  0,  0, NULL,  NULL,  "a density",              "eine Dichte"},
  {-1, 1,  0,  0, NULL,  NULL,  "a mass per length",      "eine Masse pro Länge"},
  { 0, 0,  0,  1, NULL,  NULL,  "a current",              "eine Stromstärke"},
  { 0, 0,  1,  1, "C",   "C",   "a charge",               "eine Ladung"},
  { 2, 1, -3, -1, "V",   "V",   "a voltage",              "eine Spannung"},
  { 2, 1, -3, -2, "Ω",   "Ohm", "a resistance",           "ein Widerstand"},
  {-2,-1,  4,  2, "F",   "F",   "a capacitance",          "eine Kapazität"},
  { 2, 1, -2, -2, "H",   "H",   "an inductance",          "eine Induktivität"},
  { 0, 1, -2, -1, "T",   "T",   "a magnetic field",       "ein Magnetfeld"},
  { 2, 1, -2, -1, "Wb",  "Wb",  "a magnetic flux",        "ein magnetischer Fluss"},
  { 1, 1, -3, -1, "V/m", "V/m", "an electric field",      "ein elektrisches Feld"},
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
  if (k != NULL) return lang == PL_GERMAN ? k->de : k->en;
  const char* unit = pl_dimension_unit(a, d, false);
  return pl_format(a, lang == PL_GERMAN ? "eine Größe in %s" : "a quantity in %s", unit);
}
