// An axis: a range that holds the data, ticks at round numbers, and their texts.
#include <math.h>
#include <string.h>

#include "picture/picture_impl.h"

// The step 1, 2 or 5 times a power of ten that makes about `wanted` ticks.
static double round_step(double span, double wanted) {
  double raw = span / wanted, power = pow(10, floor(log10(raw))), digit = raw / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

pl_axis_scale pl_axis_make(double lo, double hi, double wanted, bool tight) {
  pl_axis_scale a = {.lo = lo, .hi = hi};
  if (!(isfinite(lo) && isfinite(hi))) {
    a.lo = 0;
    a.hi = 1;
  }
  double size = fmax(fabs(a.lo), fabs(a.hi));
  if (!(a.hi - a.lo > 1e-9 * size) || !(a.hi > a.lo)) {  // constant: some room around it
    double room = size > 0 ? 0.1 * size : 1;
    a.lo -= room;
    a.hi += room;
    tight = true;
  }
  a.step = round_step(a.hi - a.lo, fmax(2, wanted));
  if (!tight) {
    a.lo = floor(a.lo / a.step + 1e-9) * a.step;
    a.hi = ceil(a.hi / a.step - 1e-9) * a.step;
  }
  size = fmax(fabs(a.lo), fabs(a.hi));
  int magnitude = size > 0 ? (int)floor(log10(size) + 1e-9) : 0;
  if (magnitude > 4 || magnitude < -3) a.power = magnitude;
  double shown = a.step / pow(10, a.power);
  a.decimals = shown < 1 ? (int)fmin(9, ceil(-log10(shown) - 1e-9)) : 0;
  a.first = ceil(a.lo / a.step - 1e-9);
  a.n = (int)fmin(200, fmax(0, floor(a.hi / a.step + 1e-9) - a.first + 1));
  return a;
}

double pl_axis_tick(const pl_axis_scale* a, int i) {
  double x = (a->first + i) * a->step;
  return fabs(x) < 1e-9 * a->step ? 0 : x;
}

const char* pl_axis_text(pl_arena* arena, const pl_axis_scale* a, double x, pl_language lang) {
  char* text = pl_format(arena, "%.*f", a->decimals, x / pow(10, a->power));
  if (lang == PL_GERMAN) {
    char* dot = strchr(text, '.');
    if (dot) *dot = ',';
  }
  if (text[0] != '-') return text;
  return pl_format(arena, "−%s", text + 1);
}

static const char* small(pl_arena* a, int n) {
  static const char* const digit[10] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  pl_text t = pl_text_make(a);
  const char* plain = pl_format(a, "%d", n);
  for (const char* c = plain; *c; c++) pl_text_add(&t, *c == '-' ? "⁻" : digit[*c - '0']);
  return pl_text_string(&t);
}

// "x₁ [m]", "λ [10³ N]", "ϑ"
const char* pl_axis_title(pl_arena* arena, const char* name, const char* unit, int power) {
  bool has_unit = unit && *unit;
  if (!has_unit && power == 0) return name;
  const char* factor = power ? pl_format(arena, "10%s", small(arena, power)) : "";
  const char* space = power && has_unit ? " " : "";
  return pl_format(arena, "%s%s[%s%s%s]", name, *name ? " " : "", factor, space,
                   has_unit ? unit : "");
}
