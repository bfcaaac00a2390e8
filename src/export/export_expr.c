// Expressions in the syntax of other programs. Sums, products and powers look alike everywhere;
// calls and the rest are templates (export.def). Exact numbers stay exact where the target has
// them, and a division never joins two integers that a target would round.
#include "export/export_impl.h"

#include <string.h>

typedef struct writer {
  pl_text* out;
  const pl_pool* p;
  const pl_dialect* d;
  const pl_export_names* names;
} writer;

// How tightly the text of a node holds together.
typedef enum binding { SUM, PRODUCT, POWER, ATOM } binding;

static void write(writer* w, pl_expr e, binding outer);

static void add(writer* w, const char* s) { pl_text_add(w->out, s); }

// ----------------------------------------------------------------------------------------- numbers
static const char* size_of(writer* w, pl_expr x) {
  const char* s = pl_number_num_text(w->out->arena, w->p, x);
  return *s == '-' ? s + 1 : s;
}

static const char* denominator(writer* w, pl_expr x) {
  return pl_number_den_text(w->out->arena, w->p, x);
}

static bool is_one(const char* s) { return s[0] == '1' && s[1] == '\0'; }

// Fills the texts into a template.
static void fill(writer* w, const char* how, int n, const char* const* text) {
  for (const char* c = how; *c; c++) {
    int k = *c == '$' && c[1] >= '1' && c[1] <= '9' ? c[1] - '0' : 0;
    if (k && k <= n) add(w, text[k - 1]);
    else pl_text_add_n(w->out, c, 1);
    c += k > 0;
  }
}

static void write_number(writer* w, pl_expr x, binding outer) {
  bool minus = pl_number_sign(w->p, x) < 0, whole = is_one(denominator(w, x));
  bool atom = !minus && (whole || w->d->rational_is_atom);
  bool brackets = !atom && outer > (minus ? SUM : PRODUCT);
  if (brackets) add(w, "(");
  if (minus) add(w, "-");
  const char* part[] = {size_of(w, x), denominator(w, x)};
  if (whole) add(w, part[0]);
  else fill(w, w->d->rational, 2, part);
  if (brackets) add(w, ")");
}

// ---------------------------------------------------------------------------------------- products
// Negative numbers as exponents stand below the line.
static bool is_below(const pl_pool* p, pl_expr e) {
  if (pl_kind_of(p, e) != PL_POW) return false;
  pl_expr x = pl_arg(p, e, 1);
  return pl_is_number(p, x) && pl_number_sign(p, x) < 0;
}

static bool is_half(const pl_pool* p, pl_expr x, bool inverse) {
  long num, den;
  return pl_is_ratio(p, x, &num, &den) && den == 2 && num == (inverse ? -1 : 1);
}

// base^x, or base^-x below the line.
static void write_power(writer* w, pl_expr base, pl_expr x, bool inverse) {
  long n;
  if (is_half(w->p, x, inverse)) {
    const char* at = strstr(w->d->root, "$1");
    pl_text_add_n(w->out, w->d->root, (size_t)(at - w->d->root));
    write(w, base, SUM);
    add(w, at + 2);
    return;
  }
  if (inverse && pl_is_int(w->p, x, &n) && n == -1) {
    write(w, base, POWER);
    return;
  }
  write(w, base, ATOM);
  add(w, w->d->power);
  if (!inverse) {
    write(w, x, ATOM);
  } else if (is_one(denominator(w, x))) {
    add(w, size_of(w, x));
  } else {
    add(w, "(");
    fill(w, w->d->rational, 2, (const char*[]){size_of(w, x), denominator(w, x)});
    add(w, ")");
  }
}

static void write_factor(writer* w, pl_expr e, bool inverse) {
  if (pl_kind_of(w->p, e) == PL_POW)
    write_power(w, pl_arg(w->p, e, 0), pl_arg(w->p, e, 1), inverse);
  else write(w, e, POWER);
}

// A product or a single factor is read as its number and its factors.
static int n_factors(const pl_pool* p, pl_expr e) {
  return pl_kind_of(p, e) == PL_MUL ? pl_n_args(p, e) : 1;
}
static pl_expr factor(const pl_pool* p, pl_expr e, int i) {
  return pl_kind_of(p, e) == PL_MUL ? pl_arg(p, e, i) : e;
}

static pl_expr coefficient(const pl_pool* p, pl_expr e) {
  for (int i = 0, n = n_factors(p, e); i < n; i++) {
    if (pl_is_number(p, factor(p, e, i))) return factor(p, e, i);
  }
  return pl_poison();
}

static bool is_negative(const pl_pool* p, pl_expr e) {
  pl_expr c = coefficient(p, e);
  return !pl_is_poison(c) && pl_number_sign(p, c) < 0;
}

// Factors above and below the line; the sign of the number is the caller's.
static void write_product(writer* w, pl_expr e) {
  const pl_pool* p = w->p;
  pl_expr c = coefficient(p, e);
  const char* above = pl_is_poison(c) ? "1" : size_of(w, c);
  const char* below = pl_is_poison(c) ? "1" : denominator(w, c);
  int n = n_factors(p, e), n_above = !is_one(above), n_below = !is_one(below);
  if (n_above) add(w, above);
  for (int i = 0; i < n; i++) {
    pl_expr f = factor(p, e, i);
    if (pl_is_number(p, f)) continue;
    n_below += is_below(p, f);
    if (is_below(p, f)) continue;
    if (n_above++ > 0) add(w, "*");
    write_factor(w, f, false);
  }
  if (n_above == 0) add(w, "1");
  if (n_below == 0) return;

  add(w, n_below > 1 ? "/(" : "/");
  int written = !is_one(below);
  if (written) add(w, below);
  for (int i = 0; i < n; i++) {
    pl_expr f = factor(p, e, i);
    if (pl_is_number(p, f) || !is_below(p, f)) continue;
    if (written++ > 0) add(w, "*");
    write_factor(w, f, true);
  }
  if (n_below > 1) add(w, ")");
}

// -------------------------------------------------------------------------------------------- sums
static void write_term(writer* w, pl_expr e, bool first) {
  bool minus = is_negative(w->p, e);
  add(w, minus ? (first ? "-" : " - ") : (first ? "" : " + "));
  if (!pl_is_number(w->p, e)) {
    write_product(w, e);
  } else if (is_one(denominator(w, e))) {
    add(w, size_of(w, e));
  } else {
    fill(w, w->d->rational, 2, (const char*[]){size_of(w, e), denominator(w, e)});
  }
}

// In the order of the node, the number last.
static void write_sum(writer* w, pl_expr e) {
  int n = pl_n_args(w->p, e), written = 0;
  for (int last = 0; last < 2; last++) {
    for (int i = 0; i < n; i++) {
      pl_expr term = pl_arg(w->p, e, i);
      if (pl_is_number(w->p, term) == (last == 1)) write_term(w, term, written++ == 0);
    }
  }
}

// --------------------------------------------------------------------------------- calls, patterns
// Arguments of a node in the places of a template.
static void write_template(writer* w, const char* how, pl_expr e) {
  int n = pl_n_args(w->p, e);
  for (const char* c = how; *c; c++) {
    int k = *c == '$' && c[1] >= '1' && c[1] <= '9' ? c[1] - '0' : 0;
    if (!k) {
      pl_text_add_n(w->out, c, 1);
      continue;
    }
    if (k <= n) write(w, pl_arg(w->p, e, k - 1), SUM);
    c++;
  }
}

static const char* name_of(const writer* w, pl_symbol s, int dots) {
  return w->names->of[s.id].name[dots < PL_EXPORT_DOTS ? dots : PL_EXPORT_DOTS - 1];
}

static void write_element(writer* w, pl_expr e) {
  add(w, name_of(w, pl_symbol_of(w->p, e), pl_dots_of(w->p, e)));
  add(w, "[");
  write(w, pl_arg(w->p, e, 0), SUM);
  add(w, "]");
}

// --------------------------------------------------------------------------------------------- all
static binding binding_of(const writer* w, pl_expr e) {
  switch (pl_kind_of(w->p, e)) {
    case PL_ADD: return SUM;
    case PL_MUL: return is_negative(w->p, e) ? SUM : PRODUCT;
    case PL_POW:
      if (pl_is_sqrt(w->p, e)) return ATOM;
      return is_below(w->p, e) ? PRODUCT : POWER;
    default: return ATOM;
  }
}

static void write(writer* w, pl_expr e, binding outer) {
  if (pl_kind_of(w->p, e) == PL_NUMBER) {
    write_number(w, e, outer);
    return;
  }
  bool brackets = binding_of(w, e) < outer;
  if (brackets) add(w, "(");
  switch (pl_kind_of(w->p, e)) {
    // pl_export_can has seen to it
    case PL_POISON:
    case PL_NUMBER:
    case PL_UNKNOWN_FUNCTION: break;
    case PL_PI: add(w, w->d->pi); break;
    case PL_INFINITY: add(w, w->d->infinity); break;
    case PL_SYMBOL: add(w, name_of(w, pl_symbol_of(w->p, e), 0)); break;
    case PL_AT: write_element(w, e); break;
    case PL_ADD: write_sum(w, e); break;
    case PL_MUL:
    case PL_POW: write_term(w, e, true); break;
    case PL_CALL: write_template(w, w->d->function[pl_function_of(w->p, e)], e); break;
    case PL_IF: write_template(w, w->d->condition, e); break;
    case PL_SUM: write_template(w, w->d->sum, e); break;
  }
  if (brackets) add(w, ")");
}

bool pl_export_can(pl_arena* a, const pl_pool* p, pl_expr e) {
  // the text of the JSON document gives up on what is too long or too deep; so do we
  return !pl_is_poison(e) && *pl_expr_text(a, p, e) != '<';
}

void pl_export_expr(pl_text* out, const pl_pool* p, const pl_dialect* d,
                    const pl_export_names* names, pl_expr e) {
  writer w = {out, p, d, names};
  bool whole = pl_is_number(p, e) && is_one(denominator(&w, e));
  if (whole) fill(&w, d->whole, 1, (const char*[]){pl_number_num_text(out->arena, p, e)});
  else write(&w, e, SUM);
}

// ------------------------------------------------------------------------------------------- trees
// A list whose first element says what is done with the others; names and integers are leaves,
// integers beyond 2^53, where readers of JSON begin to round, are strings of digits.
static void tree_integer(pl_text* out, const char* digits) {
  bool small = strlen(digits) <= 15;
  pl_text_addf(out, small ? "%s" : "\"%s\"", digits);
}

static const char* head_of(const pl_pool* p, pl_expr e) {
  switch (pl_kind_of(p, e)) {
    case PL_ADD: return "+";
    case PL_MUL: return "*";
    case PL_POW: return "^";
    case PL_IF: return "if";
    case PL_SUM: return "sum";
    case PL_CALL: return pl_function_name[pl_function_of(p, e)];
    default: return "at";
  }
}

void pl_export_tree(pl_text* out, const pl_pool* p, pl_expr e) {
  pl_arena* a = out->arena;
  switch (pl_kind_of(p, e)) {
    case PL_NUMBER: {
      bool whole = is_one(pl_number_den_text(a, p, e));
      if (!whole) pl_text_add(out, "[\"/\", ");
      tree_integer(out, pl_number_num_text(a, p, e));
      if (whole) return;
      pl_text_add(out, ", ");
      tree_integer(out, pl_number_den_text(a, p, e));
      pl_text_add(out, "]");
      return;
    }
    case PL_PI: pl_text_add(out, "\"pi\""); return;
    case PL_INFINITY: pl_text_add(out, "\"infinity\""); return;
    case PL_SYMBOL:
      pl_text_addf(out, "\"%s\"", pl_symbol_get(p, pl_symbol_of(p, e))->ascii);
      return;
    default: break;
  }
  pl_text_addf(out, "[\"%s\"", head_of(p, e));
  if (pl_kind_of(p, e) == PL_AT)
    pl_text_addf(out, ", \"%s\"", pl_export_ascii(a, p, pl_symbol_of(p, e), pl_dots_of(p, e)));
  for (int i = 0, n = pl_n_args(p, e); i < n; i++) {
    pl_text_add(out, ", ");
    pl_export_tree(out, p, pl_arg(p, e, i));
  }
  pl_text_add(out, "]");
}
