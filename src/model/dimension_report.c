// What a conflict of dimensions looks like to the reader: both places, where each dimension came
// from, and a name that would fit.
//
//   E021  a length cannot equal an acceleration
//       9 | constraint g1: x1 + x2 = g
//         |                ^^^^^^^   ^ m/s²  (line 2)
//         |                m  (x1 from line 10: init x1 = 1 [m])
//         = did you mean l (line 4, m)?
#include "dimension_impl.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SYMBOLS = 64, MAX_NAME_DISTANCE = 2, MAX_BARE = 6, QUOTE_CELLS = 40 };

// ---------------------------------------------------------------------------- echoes of a conflict
// The coordinate or parameter behind a velocity or start value.
static pl_symbol root_of(const pl_dim_pass* d, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(d->pool, s);
  return info->base.id ? info->base : s;
}

static int symbols_of(pl_dim_pass* d, pl_expr e, pl_symbol* out) {
  if (pl_is_poison(e)) return 0;
  pl_symbol found[MAX_SYMBOLS];
  int n = pl_symbols_in(d->pool, e, found, MAX_SYMBOLS);
  if (n > MAX_SYMBOLS) n = MAX_SYMBOLS;
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (!pl_unit_is_symbol(d->pool, found[i])
        && pl_symbol_get(d->pool, found[i])->role != PL_R_INDEX)
      out[kept++] = found[i];
  }
  return kept;
}

static pl_dim_var* var_of(pl_dim_pass* d, pl_symbol s) {
  uint64_t known = pl_map_get(d->var_of, root_of(d, s).id);
  return known ? &d->system.vars.at[known - 1] : NULL;
}

// A name without declared unit that already took part in a conflict has a doubtful dimension.
static bool is_echo(pl_dim_pass* d, pl_expr e) {
  pl_symbol s[MAX_SYMBOLS];
  int n = symbols_of(d, e, s);
  for (int i = 0; i < n; i++) {
    const pl_dim_var* v = var_of(d, s[i]);
    if (v && v->tainted) return true;
  }
  return false;
}

static void taint(pl_dim_pass* d, pl_expr e) {
  pl_symbol s[MAX_SYMBOLS];
  int n = symbols_of(d, e, s);
  for (int i = 0; i < n; i++) {
    pl_dim_var* v = var_of(d, s[i]);
    if (v && !v->declared) v->tainted = true;
  }
}

// ------------------------------------------------------------------------------ where it came from
// The statement that brought the fixed exponents into a solved unknown: follow the rows as first
// found.
static pl_span origin_of(pl_dim_pass* d, int var) {
  pl_dim_system* s = &d->system;
  for (int depth = 0; depth < 100; depth++) {
    const pl_dim_var* v = &s->vars.at[var];
    if (!v->solved) return (pl_span){0};
    int next = -1;
    for (int i = 0; i < v->first->n; i++) {
      int k = v->first->part[i].var;
      if (k != d->time && k != d->energy && s->vars.at[k].solved) next = k;
    }
    if (next < 0 || s->vars.at[next].declared || !s->vars.at[next].reason.source) return v->reason;
    var = next;
  }
  return (pl_span){0};
}

static const char* quoted(pl_arena* a, pl_span s) { return pl_span_text(a, s, QUOTE_CELLS); }

// "(line 2)", "(x1 from line 10: init x1 = 1 [m])"; "" when the expression says it all.
static const char* origin_text(pl_dim_pass* d, pl_expr e, pl_language lang) {
  pl_arena* a = d->job->arena;
  pl_symbol s[MAX_SYMBOLS];
  int n = symbols_of(d, e, s);
  const char* line = lang == PL_GERMAN ? pl_german("line") : "line";
  for (int i = 0; i < n; i++) {
    pl_symbol root = root_of(d, s[i]);
    const pl_dim_var* v = var_of(d, root);
    if (!v || root.id == pl_time(d->pool).id) continue;
    const char* name = pl_symbol_get(d->pool, root)->name;
    if (v->declared && v->span.source) {
      int at = pl_span_place(v->span).line;
      return n == 1 ? pl_format(a, "  (%s %d)", line, at)
                    : pl_format(a, "  (%s: %s %d)", name, line, at);
    }
    pl_span from = origin_of(d, (int)(v - d->system.vars.at));
    if (!from.source) continue;
    return pl_format(
        a, lang == PL_GERMAN ? pl_german("  (%s from line %d: %s)") : "  (%s from line %d: %s)",
        name, pl_span_place(from).line, quoted(a, from));
  }
  return "";
}

// "m/s²  (line 2)", or what is known of it.
static const char* side_text(pl_dim_pass* d, pl_expr e, const pl_dim_form* f, pl_language lang) {
  pl_dimension x;
  if (!pl_dim_known(&d->system, f, &x)) return NULL;
  return pl_format(d->job->arena, "%s%s", pl_dimension_unit(d->job->arena, x, false),
                   origin_text(d, e, lang));
}

// ------------------------------------------------------------------------------------ did you mean
typedef struct suggestion {
  pl_symbol wrong;
  const char* name;  // what would fit
  pl_dimension dimension;
  int line;   // of its declaration, 0 without text
  int score;  // smaller is better
} suggestion;

// e = s^p times the rest: the p of a plain factor, 0 if there is none.
static pl_fraction power_of(pl_dim_pass* d, pl_expr e, pl_symbol s) {
  pl_kind kind = pl_kind_of(d->pool, e);
  if (kind == PL_SYMBOL && pl_symbol_of(d->pool, e).id == s.id) return (pl_fraction){1, 1};
  if (kind == PL_POW && power_of(d, pl_arg(d->pool, e, 0), s).num == 1) {
    long num, den;
    if (pl_is_ratio(d->pool, pl_arg(d->pool, e, 1), &num, &den)) return pl_fraction_make(num, den);
  }
  if (kind == PL_MUL) {
    for (int i = 0; i < pl_n_args(d->pool, e); i++) {
      pl_fraction f = power_of(d, pl_arg(d->pool, e, i), s);
      if (f.num) return f;
    }
  }
  return (pl_fraction){0, 1};
}

static void consider(pl_dim_pass* d, suggestion* best, pl_symbol wrong, pl_symbol candidate,
                     pl_dimension wanted, pl_span span) {
  if (!candidate.id || candidate.id == wrong.id) return;
  const pl_symbol_info* info = pl_symbol_get(d->pool, candidate);
  const pl_symbol_info* bad = pl_symbol_get(d->pool, wrong);
  pl_dimension x;
  uint64_t known = pl_map_get(d->var_of, candidate.id);
  if (!known || !pl_dim_known(&d->system, pl_dim_unknown(&d->system, (int)known - 1), &x)) return;
  if (!pl_dimension_equal(x, wanted) || pl_dimension_equal(x, pl_dimension_one())) return;
  int distance = pl_edit_distance(bad->ascii, info->ascii, MAX_NAME_DISTANCE);
  if (distance > MAX_NAME_DISTANCE) return;
  // a name that nothing else uses is the likelier one
  int uses = d->model->source ? pl_source_count_name(d->model->source, info->ascii) : 0;
  int score = distance * 100 + (uses > 50 ? 50 : uses)
              + (info->role != bad->role && info->role != PL_R_LOCAL ? 10 : 0);
  if (score >= best->score) return;
  *best = (suggestion){wrong, info->name, x, span.source ? pl_span_place(span).line : 0, score};
}

// Every name that would mend the conflict if it stood in place of a factor of e.
static void suggest_for_side(pl_dim_pass* d, suggestion* best, pl_expr e, const pl_dim_form* is,
                             const pl_dim_form* wanted) {
  const pl_model* m = d->model;
  pl_symbol s[MAX_SYMBOLS];
  int n = symbols_of(d, e, s);
  for (int i = 0; i < n; i++) {
    pl_fraction p = power_of(d, e, s[i]);
    pl_role role = pl_symbol_get(d->pool, s[i])->role;
    if (p.num == 0 || (role != PL_R_PARAM && role != PL_R_COORD)) continue;
    const pl_dim_form* gap = pl_dim_combine(&d->system, wanted, (pl_fraction){-1, 1}, is);
    const pl_dim_form* own = pl_dim_unknown(&d->system, pl_dim_symbol_var(d, s[i]));
    pl_dimension x;
    if (!pl_dim_known(&d->system,
                      pl_dim_combine(&d->system, own, pl_fraction_div((pl_fraction){1, 1}, p), gap),
                      &x))
      continue;
    for (int k = 0; k < m->params.n; k++)
      consider(d, best, s[i], m->params.at[k].symbol, x, m->params.at[k].span);
    for (int k = 0; k < m->lets.n; k++) {
      if (m->lets.at[k].n_args == 0)
        consider(d, best, s[i], m->lets.at[k].symbol, x, m->lets.at[k].span);
    }
    for (int k = 0; k < m->coords.n; k++) {
      if (pl_is_poison(m->coords.at[k].lo))
        consider(d, best, s[i], m->coords.at[k].symbol, x, m->coords.at[k].span);
    }
  }
}

static const char* line_and_unit(pl_dim_pass* d, const suggestion* s, bool german) {
  const char* unit = pl_dimension_unit(d->job->arena, s->dimension, false);
  if (!s->line) return pl_format(d->job->arena, "(%s)", unit);
  return pl_format(d->job->arena, german ? pl_german("(line %d, %s)") : "(line %d, %s)", s->line,
                   unit);
}

// --------------------------------------------------------------------------------------- sentences
static const char* words(pl_dim_pass* d, const pl_dim_form* f, pl_language lang) {
  pl_dimension x;
  return pl_dim_known(&d->system, f, &x) ? pl_dimension_words(d->job->arena, x, lang) : NULL;
}

// As a reader writes it: 0.001 rather than 1/1000.
static const char* text_of(pl_dim_pass* d, pl_expr e) {
  pl_expr plain = pl_unit_to_si(d->pool, e);
  if (pl_is_number(d->pool, plain))
    return pl_format(d->job->arena, "%.9g", pl_number_double(d->pool, plain));
  return pl_expr_words(d->job->arena, d->pool, plain);
}

static void both_sentences(pl_dim_pass* d, const pl_dim_conflict* c, const char** en,
                           const char** de) {
  pl_arena* a = d->job->arena;
  const char* a_en = words(d, c->form_a, PL_ENGLISH);
  const char* a_de = words(d, c->form_a, PL_GERMAN);
  const char* b_en = words(d, c->form_b, PL_ENGLISH);
  const char* b_de = words(d, c->form_b, PL_GERMAN);
  if (c->kind == PL_CLASH_NEED) {
    if (a_en) {
      *en = pl_format(a, "%s, but %s is %s", c->what[0], text_of(d, c->a), a_en);
      *de = pl_format(a, pl_german("%s, but %s is %s"), c->what[1], text_of(d, c->a), a_de);
    } else {
      *en = pl_format(a, "%s, and %s cannot be that", c->what[0], text_of(d, c->a));
      *de = pl_format(a, pl_german("%s, and %s cannot be that"), c->what[1], text_of(d, c->a));
    }
    return;
  }
  bool sum = c->kind == PL_CLASH_SUM;
  if (a_en && b_en) {
    *en = pl_format(a, sum ? "%s and %s cannot be added" : "%s cannot equal %s", a_en, b_en);
    *de = pl_format(a, pl_german(sum ? "%s and %s cannot be added" : "%s cannot equal %s"), a_de,
                    b_de);
    return;
  }
  pl_dimension ratio;
  const pl_dim_form* gap = pl_dim_combine(&d->system, c->form_a, (pl_fraction){-1, 1}, c->form_b);
  if (!pl_dim_known(&d->system, gap, &ratio)) {
    *en = sum ? PL_KEY("the units of these terms do not fit")
              : PL_KEY("the units of these sides do not fit");
    *de = pl_german(*en);
    return;
  }
  const char* unit = pl_dimension_unit(a, ratio, false);
  *en = pl_format(a,
                  sum ? "these terms cannot be added: their units differ by %s"
                      : "these sides cannot be equal: their units differ by %s",
                  unit);
  *de = pl_format(a,
                  pl_german(sum ? "these terms cannot be added: their units differ by %s"
                                : "these sides cannot be equal: their units differ by %s"),
                  unit);
}

// ------------------------------------------------------------------------------------------ places
// Where an expression stands inside a statement: the first name of it that can be found there.
static bool find_part(pl_dim_pass* d, pl_span where, pl_expr e, pl_span* out) {
  pl_symbol s[MAX_SYMBOLS];
  int n = symbols_of(d, e, s);
  for (int i = 0; i < n; i++) {
    if (pl_span_find_name(where, pl_symbol_get(d->pool, root_of(d, s[i]))->ascii, out)) return true;
  }
  return false;
}

// Places of both parts.  A relation gives its sides if the parts of it are where they should be.
static void find_places(pl_dim_pass* d, const pl_dim_conflict* c, pl_span* at_a, pl_span* at_b) {
  *at_a = d->where;
  *at_b = (pl_span){0};
  pl_span left, right;
  if (c->kind == PL_CLASH_RELATION && pl_span_split_relation(d->where, &left, &right)) {
    pl_span inside;
    bool swapped = !find_part(d, left, c->a, &inside) && find_part(d, right, c->a, &inside);
    *at_a = swapped ? right : left;
    *at_b = swapped ? left : right;
    return;
  }
  pl_span a, b;
  pl_span in = d->focus.source ? d->focus : d->where;
  if (find_part(d, in, c->a, &a)) *at_a = a;
  else if (d->focus.source) *at_a = in;
  if (c->kind != PL_CLASH_NEED && find_part(d, in, c->b, &b)) *at_b = b;
  if (at_b->source && at_a->begin == at_b->begin) *at_b = (pl_span){0};
}

// The second place outside the statement, when the text of the statement does not show it: where
// the name is declared.
static bool label_declarations(pl_dim_pass* d, pl_diagnostic* m, pl_expr e) {
  pl_symbol s[MAX_SYMBOLS];
  int n = symbols_of(d, e, s);
  for (int i = 0; i < n && i < 2; i++) {
    const pl_dim_var* v = var_of(d, s[i]);
    pl_dimension x;
    if (!v || !v->span.source || v->span.begin == d->where.begin) continue;
    if (!pl_dim_known(&d->system, pl_dim_unknown(&d->system, (int)(v - d->system.vars.at)), &x))
      continue;
    const char* name = pl_symbol_get(d->pool, root_of(d, s[i]))->name;
    pl_report_label(
        d->job->diagnostics, m, v->span,
        pl_format(d->job->arena, "%s: %s", name, pl_dimension_unit(d->job->arena, x, false)));
    return true;
  }
  return false;
}

// ------------------------------------------------------------------------------------------- fixes
// The number in front of a product, 1 if there is none.
static pl_expr number_before(pl_dim_pass* d, pl_expr e) {
  if (pl_kind_of(d->pool, e) == PL_MUL) {
    for (int i = 0; i < pl_n_args(d->pool, e); i++) {
      if (pl_is_number(d->pool, pl_arg(d->pool, e, i))) return pl_arg(d->pool, e, i);
    }
  }
  return pl_int(d->pool, 1);
}

// "5 [m]": the number has its unit already.
static bool has_unit(pl_dim_pass* d, pl_expr e) {
  for (int i = 0; pl_kind_of(d->pool, e) == PL_MUL && i < pl_n_args(d->pool, e); i++) {
    pl_expr factor = pl_arg(d->pool, e, i);
    if (pl_kind_of(d->pool, factor) == PL_POW) factor = pl_arg(d->pool, factor, 0);
    if (pl_kind_of(d->pool, factor) == PL_SYMBOL
        && pl_unit_is_symbol(d->pool, pl_symbol_of(d->pool, factor)))
      return true;
  }
  return false;
}

// Numbers in front are pure, but the 3 of sin(3 t) may have been meant as 3 [1/s]. Halves and
// doubles are not.
static bool fix_of_number_before(pl_dim_pass* d, pl_expr e, const pl_dim_form* is,
                                 const pl_dim_form* wanted, pl_diagnostic* m) {
  pl_pool* p = d->pool;
  if (has_unit(d, e)) return false;
  pl_expr number = number_before(d, e), twice = pl_mul(p, pl_int(p, 2), number);
  long k;
  pl_dimension gap;
  bool simple = (pl_is_int(p, number, &k) && labs(k) <= 2)
                || (pl_is_int(p, twice, &k) && labs(k) <= 1);
  if (simple
      || !pl_dim_known(&d->system, pl_dim_combine(&d->system, wanted, (pl_fraction){-1, 1}, is),
                       &gap))
    return false;
  if (pl_dimension_equal(gap, pl_dimension_one())) return false;
  const char* unit = pl_dimension_unit(d->job->arena, gap, false);
  const char* text = text_of(d, number);
  pl_report_fix(
      m, PL_BOTH_FORMAT(d->job->arena, "if the number has a unit, write it: %s [%s]", text, unit),
      NULL);
  return true;
}

// A parameter of the same dimension, to divide by: sin(x/l).
static const char* divisor_for(pl_dim_pass* d, pl_expr e, pl_dimension is) {
  const pl_model* m = d->model;
  for (int i = 0; i < m->params.n; i++) {
    pl_dimension x;
    pl_symbol s = m->params.at[i].symbol;
    if (pl_has_symbol(d->pool, e, s) || !pl_map_get(d->var_of, s.id)) continue;
    if (!pl_dim_known(&d->system, pl_dim_unknown(&d->system, pl_dim_symbol_var(d, s)), &x))
      continue;
    if (pl_dimension_equal(x, is)) return pl_symbol_get(d->pool, s)->name;
  }
  return NULL;
}

static void fix_pure_number(pl_dim_pass* d, const pl_dim_conflict* c, pl_diagnostic* m) {
  pl_arena* a = d->job->arena;
  pl_dimension is;
  const char* name = text_of(d, c->a);
  const char* divisor = pl_dim_known(&d->system, c->form_a, &is) ? divisor_for(d, c->a, is) : NULL;
  const char* example = pl_kind_of(d->pool, c->a) == PL_SYMBOL ? "%s/%s" : "(%s)/%s";
  if (divisor) {
    const char* quotient = pl_format(a, example, name, divisor);
    pl_report_fix(
        m, PL_BOTH_FORMAT(a, "divide by a quantity of the same unit, for example %s", quotient),
        NULL);
  } else {
    pl_report_fix(
        m,
        PL_BOTH_FORMAT(a, "divide %s by a quantity of the same unit, so that a pure number is left",
                       name),
        NULL);
  }
}

// A statement that wants another kind of quantity.
static void fix_need(pl_dim_pass* d, const pl_dim_conflict* c, pl_diagnostic* m) {
  pl_dimension wanted;
  if (!pl_dim_known(&d->system, c->form_b, &wanted)) return;
  if (pl_dimension_equal(wanted, pl_dimension_one())) {
    fix_pure_number(d, c, m);
    return;
  }
  const char* unit = pl_dimension_unit(d->job->arena, wanted, false);
  bool short_name = pl_kind_of(d->pool, c->a) == PL_SYMBOL
                    || pl_is_number(d->pool, pl_unit_to_si(d->pool, c->a));
  const char* name = short_name ? text_of(d, c->a) : NULL;
  pl_report_fix(m, pl_format(d->job->arena, "%s has to be in %s", name ? name : "this", unit),
                pl_format(d->job->arena, pl_german("%s has to be in %s"),
                          name ? name : pl_german("this"), unit),
                NULL);
}

static void fix_of_value(pl_dim_pass* d, const pl_dim_conflict* c, pl_diagnostic* m) {
  if (c->kind == PL_CLASH_NEED) {
    fix_need(d, c, m);
    return;
  }
  // a number with a unit against something whose unit is known: name the unit it should have
  pl_arena* a = d->job->arena;
  pl_dimension x;
  pl_symbol s[MAX_SYMBOLS];
  bool a_is_number = symbols_of(d, c->a, s) == 0, b_is_number = symbols_of(d, c->b, s) == 0;
  if (a_is_number || b_is_number) {
    if (!pl_dim_known(&d->system, a_is_number ? c->form_b : c->form_a, &x)) return;
    const char* unit = pl_dimension_unit(a, x, false);
    const char* name = text_of(d, a_is_number ? c->b : c->a);
    pl_report_fix(m, PL_BOTH_FORMAT(a, "%s is in %s: give the number in that unit", name, unit),
                  NULL);
    return;
  }
  const pl_dim_form* gap = pl_dim_combine(&d->system, c->form_a, (pl_fraction){-1, 1}, c->form_b);
  if (!pl_dim_known(&d->system, gap, &x)) return;
  const char* unit = pl_dimension_unit(a, x, false);
  pl_report_fix(m,
                PL_BOTH_FORMAT(
                    a, "a factor in %s is missing on one side, or one of the units is wrong", unit),
                NULL);
}

static bool fix_of_name(pl_dim_pass* d, const suggestion* best, pl_diagnostic* m,
                        pl_span* culprit) {
  if (best->score == INT_MAX) return false;
  pl_span at;
  bool found = pl_span_find_name(d->focus.source ? d->focus : d->where,
                                 pl_symbol_get(d->pool, best->wrong)->ascii, &at);
  if (found) *culprit = at;
  const char* wrong = pl_symbol_get(d->pool, best->wrong)->name;
  const char* instead[2] = {found ? "" : pl_format(d->job->arena, " instead of %s", wrong),
                            found ? "" : pl_format(d->job->arena, " statt %s", wrong)};
  pl_report_fix(m,
                pl_format(d->job->arena, "did you mean %s %s%s?", best->name,
                          line_and_unit(d, best, false), instead[0]),
                pl_format(d->job->arena, pl_german("did you mean %s %s%s?"), best->name,
                          line_and_unit(d, best, true), instead[1]),
                found ? best->name : NULL);
  return true;
}

void pl_dim_report(pl_dim_pass* d, const pl_dim_conflict* c) {
  bool echo = is_echo(d, c->a) || is_echo(d, c->b);
  taint(d, c->a);
  taint(d, c->b);
  if (d->silent || echo) return;

  const char *en, *de;
  both_sentences(d, c, &en, &de);
  pl_span at_a, at_b;
  find_places(d, c, &at_a, &at_b);
  suggestion best = {.score = INT_MAX};
  suggest_for_side(d, &best, c->a, c->form_a, c->form_b);
  if (c->kind != PL_CLASH_NEED) suggest_for_side(d, &best, c->b, c->form_b, c->form_a);

  pl_diagnostic* m = pl_report(d->job->diagnostics, c->code, at_a, en, de);
  pl_span culprit = {0};
  bool named = fix_of_name(d, &best, m, &culprit);
  const char* text_a[2] = {side_text(d, c->a, c->form_a, PL_ENGLISH),
                           side_text(d, c->a, c->form_a, PL_GERMAN)};
  const char* text_b[2] = {NULL, NULL};
  if (c->kind != PL_CLASH_NEED) {
    text_b[0] = side_text(d, c->b, c->form_b, PL_ENGLISH);
    text_b[1] = side_text(d, c->b, c->form_b, PL_GERMAN);
  }
  // the message stands where the fix applies: at the name to replace, if it is the second part
  int lang = d->job->lang == PL_GERMAN;
  bool second = culprit.source && at_b.source && culprit.begin >= at_b.begin
                && culprit.end <= at_b.end;
  if (culprit.source) m->span = culprit;
  pl_report_reason(m, second ? text_b[0] : text_a[0], second ? text_b[1] : text_a[1]);
  pl_span other = second ? at_a : at_b;
  if (other.source && other.begin != m->span.begin) {
    pl_report_label(d->job->diagnostics, m, other, second ? text_a[lang] : text_b[lang]);
  } else if (!other.source && label_declarations(d, m, c->kind == PL_CLASH_NEED ? c->a : c->b)) {
    pl_dimension x;  // the line of the declaration is shown: no need to name it
    if (c->kind == PL_CLASH_NEED && pl_dim_known(&d->system, c->form_a, &x)) {
      const char* unit = pl_dimension_unit(d->job->arena, x, false);
      pl_report_reason(m, unit, unit);
    }
  }
  if (named) return;
  if (fix_of_number_before(d, c->a, c->form_a, c->form_b, m)) return;
  if (c->kind != PL_CLASH_NEED && fix_of_number_before(d, c->b, c->form_b, c->form_a, m)) return;
  fix_of_value(d, c, m);
}

// ------------------------------------------------------------------------------------ bare numbers
// Bare numbers that something connected gave a unit: one note for all of them.
typedef struct bare_number {
  const char* text;
  pl_span span;
} bare_number;

static int compare_bare(const void* x, const void* y) {
  const bare_number *a = x, *b = y;
  if (a->span.begin != b->span.begin) return a->span.begin < b->span.begin ? -1 : 1;
  return strcmp(a->text, b->text);
}

static bool unit_of_form(pl_dim_pass* d, const pl_dim_form* f, const char** unit) {
  pl_dimension x;
  if (!pl_dim_known(&d->system, f, &x) || pl_dimension_equal(x, pl_dimension_one())) return false;
  *unit = pl_dimension_unit(d->job->arena, x, false);
  return true;
}

void pl_dim_report_bare_numbers(pl_dim_pass* d) {
  const pl_model* m = d->model;
  pl_arena* a = d->job->arena;
  PL_VEC(bare_number) found = {0};
  const char* unit;
  for (int i = 0; i < m->params.n; i++) {
    const pl_param* p = &m->params.at[i];
    if (p->has_unit || pl_is_poison(p->value) || pl_is_zero_node(d->pool, p->value)
        || !pl_is_constant(d->pool, p->value))
      continue;
    const pl_dim_var* v = var_of(d, p->symbol);
    if (v && v->tainted) continue;
    if (!unit_of_form(d, pl_dim_unknown(&d->system, pl_dim_symbol_var(d, p->symbol)), &unit))
      continue;
    const char* name = pl_symbol_get(d->pool, p->symbol)->name;
    pl_push(a, found,
            (bare_number){pl_format(a, "%s = %s %s", name, text_of(d, p->value), unit), p->span});
  }
  for (int i = 0; i < d->system.vars.n; i++) {
    const pl_dim_var* v = &d->system.vars.at[i];
    if (v->kind != PL_DIM_NUMBER || !unit_of_form(d, pl_dim_unknown(&d->system, i), &unit))
      continue;
    pl_push(a, found, (bare_number){pl_format(a, "%s %s", text_of(d, v->number), unit), v->span});
  }
  if (found.n == 0) return;

  qsort(found.at, (size_t)found.n, sizeof *found.at, compare_bare);
  pl_text list = pl_text_make(a);
  int shown = 0, n = 0;
  for (int i = 0; i < found.n; i++) {
    if (i > 0 && compare_bare(&found.at[i - 1], &found.at[i]) == 0) continue;
    if (n++ >= MAX_BARE) continue;
    pl_text_addf(&list, "%s%s", shown++ ? ", " : "", found.at[i].text);
  }
  const char* more = n > MAX_BARE ? pl_format(a, ", +%d", n - MAX_BARE) : "";
  pl_diagnostic* note = pl_report(
      d->job->diagnostics, PL_N021, found.at[0].span,
      PL_BOTH_FORMAT(a, "numbers without unit are taken in SI units: %s%s", pl_text_string(&list),
                     more));
  pl_report_fix(note, PL_BOTH("write the unit in [ ] to be sure"), NULL);
}
