// Export: every formula of the worked solution in the language of another program, one entry a
// value, with a key that says which it is: "c lambda_g1 of g1". Symbols are declared with what is
// known of their sign, the numbers of the parameters stand beside, abbreviations of the model stay
// abbreviations.
#include "export/export_impl.h"

#include <math.h>
#include <string.h>

// ORDER EXPORTS
const pl_dialect pl_dialects[] = {
    {.word = "sympy",
     .power = "**",
     .pi = "sp.pi",
     .infinity = "sp.oo",
     .root = "sp.sqrt($1)",
     .condition = "sp.Piecewise(($2, $1 > 0), ($3, True))",
     .sum = "sp.Sum($4, ($1, $2, $3))",
     .rational = "sp.Rational($1, $2)",
     .rational_is_atom = true,
     .whole = "sp.Integer($1)",
#define PL_EXPORT(id, sympy, mathematica, maxima, julia, python) [PL_##id] = sympy,
     .function =
         {
#include "export/export.def"
         },
#undef PL_EXPORT
     .reserved = " sp symbols parameters abbreviations values False None True and as assert async "
                 "await break class continue def"
                 " del elif else except finally for from global if import in is lambda nonlocal "
                 "not or pass raise return try"
                 " while with yield ",
     .comment = {"# ", ""}},
    {.word = "mathematica",
     .power = "^",
     .pi = "Pi",
     .infinity = "Infinity",
     .root = "Sqrt[$1]",
     .condition = "If[$1 > 0, $2, $3]",
     .sum = "Sum[$4, {$1, $2, $3}]",
     .rational = "$1/$2",
     .whole = "$1",
#define PL_EXPORT(id, sympy, mathematica, maxima, julia, python) [PL_##id] = mathematica,
     .function =
         {
#include "export/export.def"
         },
#undef PL_EXPORT
     .camel = true,
     .reserved = " C D E I K N O pleuelParameters pleuelAbbreviations pleuelValues ",
     .comment = {"(* ", " *)"}},
    {.word = "maxima",
     .power = "^",
     .pi = "%pi",
     .infinity = "inf",
     .root = "sqrt($1)",
     .condition = "(if $1 > 0 then $2 else $3)",
     .sum = "sum($4, $1, $2, $3)",
     .rational = "$1/$2",
     .whole = "$1",
#define PL_EXPORT(id, sympy, mathematica, maxima, julia, python) [PL_##id] = maxima,
     .function =
         {
#include "export/export.def"
         },
#undef PL_EXPORT
     .reserved =
         " pleuel_parameters pleuel_abbreviations pleuel_values and do else elseif false for from "
         "if in inf ind infinity"
         " lambda minf next not or product return step sum then thru true und unless values while "
         "functions labels props"
         " float numer simp infix domain float2bf radexpand ratfac ratprint gradefs macros rules "
         "aliases arrays"
         " dependencies linel fpprec go block catch throw error errors at diff integrate limit ",
     .comment = {"/* ", " */"}},
    {.word = "julia",
     .power = "^",
     .pi = "pi",
     .infinity = "Inf",
     .root = "sqrt($1)",
     .condition = "($1 > 0 ? $2 : $3)",
     .sum = "sum($4 for $1 in Int($2):Int($3); init = 0)",
     .rational = "($1//$2)",
     .rational_is_atom = true,
     .whole = "$1",
#define PL_EXPORT(id, sympy, mathematica, maxima, julia, python) [PL_##id] = julia,
     .function =
         {
#include "export/export.def"
         },
#undef PL_EXPORT
     .reserved = " pleuel_values Any Dict Float64 Inf Int NaN String abstract baremodule begin "
                 "break catch const continue do else"
                 " elseif end export false finally for function global if import in isa let local "
                 "macro module mutable pi"
                 " primitive quote return struct sum sqrt true try type using where while ",
     .comment = {"# ", ""}},
    {.word = "python",
     .power = "**",
     .pi = "np.pi",
     .infinity = "np.inf",
     .root = "np.sqrt($1)",
     .condition = "np.where($1 > 0, $2, $3)",
     .sum = "sum($4 for $1 in range(int($2), int($3) + 1))",
     .rational = "($1/$2)",
     .rational_is_atom = true,
     .whole = "$1",
#define PL_EXPORT(id, sympy, mathematica, maxima, julia, python) [PL_##id] = python,
     .function =
         {
#include "export/export.def"
         },
#undef PL_EXPORT
     .reserved = " np values sum range int False None True and as assert async await break class "
                 "continue def del elif else except finally for from global if import in is lambda "
                 "nonlocal not or pass raise return try while with yield ",
     .comment = {"# ", ""}},
};

bool pl_export_target_find(const char* word, pl_export_target* target) {
  for (int i = 0; i < PL_EXPORT_JSON; i++) {
    if (strcmp(pl_dialects[i].word, word) != 0) continue;
    *target = (pl_export_target)i;
    return true;
  }
  *target = PL_EXPORT_JSON;
  return strcmp(word, "json") == 0;
}

// -------------------------------------------------------------------------------- what is exported
typedef struct entry {
  const char* key;
  const char *letter, *part;  // part: "left side" or NULL
  const pl_value* value;
  const char* along;
  pl_expr expr;
  const char* unit;  // NULL when not known
} entry;

// A name that stays in the formulas: an abbreviation of the model, or an intermediate of the
// solution.
typedef struct abbreviation {
  pl_symbol symbol;
  pl_expr value;
} abbreviation;

typedef struct exporter {
  pl_text* out;
  pl_arena* arena;
  pl_pool* pool;
  const pl_export_input* in;
  const pl_model* model;
  const pl_dialect* d;  // NULL for JSON
  pl_export_names names;
  PL_VEC(entry) entries;
  PL_VEC(abbreviation) named;  // intermediates, in order of use
  PL_VEC(abbreviation) kept;   // all abbreviations, in order of use
  pl_names* interned;          // keys that are taken
  pl_map* keys;
  bool* used;  // symbols that are declared      (n_used)
  int n_used;
  int n_left_out;
} exporter;

static const char* free_key(exporter* x, const char* key) {
  for (int k = 1;; k++) {
    const char* name = pl_intern(x->interned, k > 1 ? pl_format(x->arena, "%s (%d)", key, k) : key);
    if (pl_map_get(x->keys, (uint64_t)(uintptr_t)name)) continue;
    pl_map_set(x->keys, (uint64_t)(uintptr_t)name, 1);
    return name;
  }
}

static const char* key_of(exporter* x, const entry* e) {
  const pl_value* v = e->value;
  const char* word[][2] = {{"", e->letter},     {" ", v->name},  {" of ", v->of},
                           {" on ", v->on},     {" at ", v->at}, {" along ", e->along},
                           {" if ", v->branch}, {", ", e->part}};
  pl_text key = pl_text_make(x->arena);
  for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
    if (word[i][1]) pl_text_addf(&key, "%s%s", word[i][0], word[i][1]);
  }
  return pl_ascii_of(x->arena, pl_text_string(&key));
}

static void use(exporter* x, pl_expr e) {
  int n = pl_symbols_in(x->pool, e, NULL, 0);
  pl_symbol* s = PL_ARRAY(x->arena, pl_symbol, n + 1);
  pl_symbols_in(x->pool, e, s, n);
  for (int i = 0; i < n; i++) {
    if ((int)s[i].id < x->n_used) x->used[s[i].id] = true;
  }
}

// Other programs read numbers in SI.
static void collect(exporter* x, entry e) {
  if (pl_is_poison(e.expr)) return;
  e.expr = pl_without_measures(x->pool, e.expr);
  if (!pl_export_can(x->arena, x->pool, e.expr)) {
    x->n_left_out++;
    return;
  }
  e.key = free_key(x, key_of(x, &e));
  use(x, e.expr);
  pl_push(x->arena, x->entries, e);
}

// Intermediates of different values may bear one name: the second gets another.
static void name_intermediate(exporter* x, pl_symbol symbol, pl_expr value, pl_replace* renamed,
                              int* n) {
  for (int i = 0; i < x->named.n; i++) {
    const abbreviation* known = &x->named.at[i];
    if (known->symbol.id != symbol.id) continue;
    if (known->value.id == value.id) return;
    pl_symbol_info info = *pl_symbol_get(x->pool, symbol);
    for (int k = 2; pl_symbol_find(x->pool, info.ascii).id; k++) {
      info.ascii = pl_format(x->arena, "%s_%d", pl_symbol_get(x->pool, symbol)->ascii, k);
      info.name = info.ascii;
    }
    info.role = PL_R_LOCAL;
    renamed[(*n)++] = (pl_replace){symbol, pl_sym(x->pool, pl_symbol_make(x->pool, &info))};
    symbol = pl_symbol_of(x->pool, renamed[*n - 1].to);
    break;
  }
  pl_push(x->arena, x->named, (abbreviation){symbol, pl_without_measures(x->pool, value)});
}

static void collect_value(exporter* x, const char* letter, const pl_value* v) {
  pl_replace* renamed = PL_ARRAY(x->arena, pl_replace, v->n_where + 1);
  int n = 0;
  for (int i = 0; i < v->n_where; i++) {
    pl_expr value = pl_subst(x->pool, v->where_expr[i], renamed, n);
    name_intermediate(x, pl_symbol_find(x->pool, v->where_name[i]), value, renamed, &n);
  }
  entry e = {.letter = letter,
             .value = v,
             .unit = v->unit,
             .expr = pl_subst(x->pool, v->expr, renamed, n)};
  collect(x, e);
  bool plain = pl_kind_of(x->pool, v->lhs) == PL_SYMBOL;  // x1 = ... has x1 as its name
  e.part = "left side";
  e.expr = plain ? pl_poison() : pl_subst(x->pool, v->lhs, renamed, n);
  collect(x, e);
  e.part = NULL;
  for (int i = 0; i < v->n_components; i++) {
    e.along = v->components[i].along;
    e.expr = pl_subst(x->pool, v->components[i].expr, renamed, n);
    collect(x, e);
  }
}

// Abbreviations of the model that stay in the formulas.
static bool is_kept(const pl_let* l) {
  return !l->inserted && l->n_args == 0 && l->symbol.id != 0 && !pl_is_poison(l->value);
}

static bool is_used(const exporter* x, pl_symbol s) {
  return (int)s.id < x->n_used && x->used[s.id];
}

// A let may speak of those before it.
static void use_lets(exporter* x) {
  for (int k = x->model->lets.n - 1; k >= 0; k--) {
    const pl_let* l = &x->model->lets.at[k];
    if (is_kept(l) && is_used(x, l->symbol)) use(x, l->value);
  }
}

// Those of the model come first; intermediates may speak of them.
static void keep_abbreviations(exporter* x) {
  for (int k = x->named.n - 1; k >= 0; k--) {
    if (is_used(x, x->named.at[k].symbol)) use(x, x->named.at[k].value);
  }
  use_lets(x);
  for (int k = 0; k < x->model->lets.n; k++) {
    const pl_let* l = &x->model->lets.at[k];
    if (!is_kept(l) || !is_used(x, l->symbol)) continue;
    pl_push(x->arena, x->kept, (abbreviation){l->symbol, pl_without_measures(x->pool, l->value)});
  }
  for (int k = 0; k < x->named.n; k++) {
    if (is_used(x, x->named.at[k].symbol)) pl_push(x->arena, x->kept, x->named.at[k]);
  }
}

static bool is_abbreviation(const exporter* x, pl_symbol s) {
  for (int k = 0; k < x->kept.n; k++) {
    if (x->kept.at[k].symbol.id == s.id) return true;
  }
  return false;
}

static void collect_all(exporter* x) {
  const pl_solution* s = x->in->solution;
  int running = 0;
  for (int i = 0; i < s->sections.n; i++) {
    const pl_section* section = &s->sections.at[i];
    const char* letter = section->letter ? section->letter : pl_format(x->arena, "%d", ++running);
    if (!pl_worked_wanted(x->in->only, section->letter)) continue;
    for (int k = 0; k < section->values.n; k++) collect_value(x, letter, &section->values.at[k]);
  }
  for (int i = 0; i < x->model->params.n; i++)
    x->used[x->model->params.at[i].symbol.id] |= !x->model->params.at[i].literal;
  keep_abbreviations(x);
}

// ---------------------------------------------------------------------------------- pieces of text
static void add(exporter* x, const char* s) { pl_text_add(x->out, s); }

static const char* name_of(const exporter* x, pl_symbol s, int dots) {
  return x->names.of[s.id].name[dots];
}

static void add_expr(exporter* x, pl_expr e) {
  pl_export_expr(x->out, x->pool, x->d, &x->names, e);
}

// A comment on one line that cannot end the comment it stands in.
static void add_comment(exporter* x, const char* s) {
  add(x, x->d->comment[0]);
  for (const char* c = pl_ascii_of(x->arena, s); *c; c++) {
    bool blank = (unsigned char)*c < ' ';
    pl_text_add_n(x->out, blank ? " " : c, 1);
    bool ends = *c == '*' && (c[1] == '/' || c[1] == ')'),
         begins = (*c == '/' || *c == '(') && c[1] == '*';
    if (ends || begins) add(x, " ");
  }
  add(x, x->d->comment[1]);
}

static void add_line_comment(exporter* x, const char* s) {
  add_comment(x, s);
  add(x, "\n");
}

static void add_string(exporter* x, const char* s) {
  bool julia = x->in->target == PL_EXPORT_JULIA;
  add(x, "\"");
  for (; *s; s++) {
    if (*s == '"' || *s == '\\' || (*s == '$' && julia)) add(x, "\\");
    pl_text_add_n(x->out, (unsigned char)*s < ' ' ? " " : s, 1);
  }
  add(x, "\"");
}

// A decimal as the target reads it, a float even when it is whole.
static void add_decimal(exporter* x, double value) {
  const char* s = pl_shortest_double(x->arena, value);
  const char* e = strchr(s, 'e');
  if (e)
    pl_text_addf(x->out, "%.*s%s%s", (int)(e - s), s,
                 x->in->target == PL_EXPORT_MATHEMATICA ? "*^" : "e", e + 1);
  else add(x, s);
  if (!strpbrk(s, ".e")) add(x, ".0");
}

static int dots_of(const exporter* x, pl_symbol s) {
  return pl_symbol_get(x->pool, s)->role == PL_R_ARRAY ? PL_EXPORT_DOTS : 1;
}

// ----------------------------------------------------------------------------- parts of a document
static void add_header(exporter* x, const char* use_it) {
  const char* title = x->model->title ? x->model->title : x->in->file;
  add_line_comment(x, pl_format(x->arena,
                                "%s: the formulas of %s, exported by pleuel " PLEUEL_VERSION
                                ".  All in SI units.",
                                title, x->in->file));
  add_line_comment(x, use_it);
  for (int i = 1, n = pl_symbol_count(x->pool); i <= n && i < x->n_used; i++) {
    pl_symbol s = {(uint32_t)i};
    for (int k = 0; x->used[i] && k < dots_of(x, s); k++) {
      const char* ascii = pl_export_ascii(x->arena, x->pool, s, k);
      if (strcmp(ascii, name_of(x, s, k)) == 0) continue;
      add_line_comment(x, pl_format(x->arena, "%s is %s", name_of(x, s, k), ascii));
    }
  }
  if (x->n_left_out)
    add_line_comment(
        x, pl_format(x->arena, "%d formulas are too long to be written out", x->n_left_out));
  add(x, "\n");
}

// "x = value" for each parameter that has a number, separated by commas.
static void add_parameters(exporter* x, const char* between) {
  const double* value = pl_model_values(x->model, x->arena);
  bool first = true;
  for (int i = 0; i < x->model->params.n; i++) {
    if (x->model->params.at[i].literal) continue;
    pl_symbol s = x->model->params.at[i].symbol;
    if (!isfinite(value[s.id])) continue;
    pl_text_addf(x->out, "%s%s%s", first ? "" : ", ", name_of(x, s, 0), between);
    add_decimal(x, value[s.id]);
    first = false;
  }
}

static void add_abbreviations(exporter* x, const char* before, const char* between,
                              const char* separator) {
  for (int k = 0; k < x->kept.n; k++) {
    pl_text_addf(x->out, "%s%s%s%s", k == 0 ? "" : separator, before,
                 name_of(x, x->kept.at[k].symbol, 0), between);
    add_expr(x, x->kept.at[k].value);
  }
}

// The entries; each is followed by a comma but for the last one where the target does not allow it,
// and by its unit.
static void add_entries(exporter* x, const char* before, const char* between, const char* after,
                        bool comma_at_end) {
  for (int i = 0; i < x->entries.n; i++) {
    const entry* e = &x->entries.at[i];
    add(x, before);
    add_string(x, e->key);
    add(x, between);
    add_expr(x, e->expr);
    add(x, after);
    if (i + 1 < x->entries.n || comma_at_end) add(x, ",");
    if (e->unit && *e->unit) {
      add(x, "  ");
      add_comment(x, e->unit);
    }
    add(x, "\n");
  }
}

// --------------------------------------------------------------------------------------- documents
static const char* sympy_assumption(const pl_symbol_info* s) {
  if (s->role == PL_R_INDEX) return "integer=True";
  switch (s->sign) {
    case PL_SIGN_POSITIVE: return "positive=True";
    case PL_SIGN_NONNEGATIVE: return "nonnegative=True";
    case PL_SIGN_NEGATIVE: return "negative=True";
    case PL_SIGN_NONPOSITIVE: return "nonpositive=True";
    case PL_SIGN_NONZERO: return "real=True, nonzero=True";
    case PL_SIGN_ANY: break;
  }
  return "real=True";
}

static void add_sympy(exporter* x) {
  add_header(x,
             "values[\"KEY\"].subs(parameters) inserts the numbers; put the abbreviations in "
             "before, if there are any.");
  add(x, "import sympy as sp\n\n");
  for (int i = 1, n = pl_symbol_count(x->pool); i <= n && i < x->n_used; i++) {
    pl_symbol s = {(uint32_t)i};
    const pl_symbol_info* info = pl_symbol_get(x->pool, s);
    for (int k = 0; x->used[i] && k < dots_of(x, s); k++) {
      bool family = info->role == PL_R_ARRAY;
      pl_text_addf(x->out, "%s = sp.%s(\"%s\", %s)\n", name_of(x, s, k),
                   family ? "IndexedBase" : "Symbol", pl_export_ascii(x->arena, x->pool, s, k),
                   family ? "real=True" : sympy_assumption(info));
    }
  }
  add(x, "\nparameters = {");
  add_parameters(x, ": ");
  add(x, "}\nabbreviations = {");
  add_abbreviations(x, "", ": ", ", ");
  add(x, "}\nvalues = {\n");
  add_entries(x, "    ", ": ", "", true);
  add(x, "}\n");
}

static void add_mathematica(exporter* x) {
  add_header(
      x, "pleuelValues[\"KEY\"] //. pleuelAbbreviations /. pleuelParameters inserts the numbers.");
  add(x, "pleuelParameters = {");
  add_parameters(x, " -> ");
  add(x, "};\npleuelAbbreviations = {");
  add_abbreviations(x, "", " -> ", ", ");
  add(x, "};\npleuelValues = <|\n");
  add_entries(x, "  ", " -> ", "", false);
  add(x, "|>;\n");
}

static void add_maxima(exporter* x) {
  add_header(x,
             "subst(pleuel_parameters, assoc(\"KEY\", pleuel_values)) inserts the numbers;"
             " before, if there are any, the abbreviations.");
  add(x, "pleuel_parameters: [");
  add_parameters(x, " = ");
  add(x, "]$\npleuel_abbreviations: [");
  add_abbreviations(x, "", " = ", ", ");
  add(x, "]$\npleuel_values: [\n");
  add_entries(x, "  [", ", ", "]", false);
  add(x, "]$\n");
}

// "x = 0.1" for each name; what stands for a number that is not known is a word of the target.
static void add_names_with_numbers(exporter* x, const char* between, const char* missing) {
  const double* value = pl_model_values(x->model, x->arena);
  bool first = true;
  for (int i = 1, n = pl_symbol_count(x->pool); i <= n && i < x->n_used; i++) {
    pl_symbol s = {(uint32_t)i};
    if (!x->used[i] || pl_symbol_get(x->pool, s)->role == PL_R_INDEX || is_abbreviation(x, s))
      continue;
    for (int k = 0; k < dots_of(x, s); k++) {
      pl_text_addf(x->out, "%s%s%s", first ? "" : ", ", name_of(x, s, k), between);
      if (isfinite(value[i])) add_decimal(x, value[i]);
      else add(x, missing);
      first = false;
    }
  }
}

// A function of all names. Each value is a function too, so that a root of a negative number spoils
// no other.
static void add_julia(exporter* x) {
  add_header(x,
             "pleuel_values(; x = 0.1)[\"KEY\"]() is a number; names that are not given have the "
             "number of the model or NaN.");
  add(x, "function pleuel_values(; ");
  add_names_with_numbers(x, " = ", "NaN");
  add(x, ")\n");
  add_abbreviations(x, "  ", " = ", "\n");
  add(x, "\n  return Dict{String,Any}(\n");
  add_entries(x, "    ", " => () -> ", "", true);
  add(x, "  )\nend\n");
}

static void add_python(exporter* x) {
  add_header(x,
             "values(x=0.1)[\"KEY\"]() is a number, or an array where arrays are given; names that "
             "are not given have the number of the model or NaN.");
  add(x, "import numpy as np\n\n\ndef values(");
  add_names_with_numbers(x, "=", "np.nan");
  add(x, "):\n");
  add_abbreviations(x, "    ", " = ", "\n");
  add(x, "\n    return {\n");
  add_entries(x, "        ", ": lambda: ", "", true);
  add(x, "    }\n");
}

static void add_json_parameters(exporter* x, pl_json* j) {
  const double* value = pl_model_values(x->model, x->arena);
  pl_json_object(j, "parameters");
  for (int i = 0; i < x->model->params.n; i++) {
    if (x->model->params.at[i].literal) continue;
    pl_symbol s = x->model->params.at[i].symbol;
    pl_json_number(j, pl_symbol_get(x->pool, s)->ascii, value[s.id]);
  }
  pl_json_end_object(j);
}

static void add_json_formula(exporter* x, pl_json* j, pl_expr e) {
  pl_text tree = pl_text_make(x->arena);
  pl_export_tree(&tree, x->pool, e);
  pl_json_string(j, "expr", pl_expr_text(x->arena, x->pool, e));
  pl_json_raw(j, "tree", pl_text_string(&tree));
}

static void add_json_abbreviations(exporter* x, pl_json* j) {
  pl_json_object(j, "abbreviations");
  for (int k = 0; k < x->kept.n; k++) {
    pl_json_object(j, pl_symbol_get(x->pool, x->kept.at[k].symbol)->ascii);
    add_json_formula(x, j, x->kept.at[k].value);
    pl_json_end_object(j);
  }
  pl_json_end_object(j);
}

static void add_json_entry(exporter* x, pl_json* j, const entry* e) {
  const char* word[][2] = {{"letter", e->letter},        {"name", e->value->name},
                           {"of", e->value->of},         {"on", e->value->on},
                           {"at", e->value->at},         {"along", e->along},
                           {"branch", e->value->branch}, {"part", e->part}};
  pl_json_object(j, e->key);
  for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
    if (word[i][1]) pl_json_string(j, word[i][0], pl_ascii_of(x->arena, word[i][1]));
  }
  add_json_formula(x, j, e->expr);
  pl_json_string(j, "unit", e->unit);
  pl_json_end_object(j);
}

static void add_json(exporter* x) {
  enum { VERSION = 1 };
  pl_json j = pl_json_make(x->out);
  pl_json_object(&j, NULL);
  pl_json_int(&j, "pleuel_export", VERSION);
  pl_json_string(&j, "program", "pleuel " PLEUEL_VERSION);
  pl_json_string(&j, "file", x->in->file);
  pl_json_string(&j, "system", x->model->title);
  pl_json_int(&j, "left_out", x->n_left_out);
  add_json_parameters(x, &j);
  add_json_abbreviations(x, &j);
  pl_json_object(&j, "values");
  for (int i = 0; i < x->entries.n; i++) add_json_entry(x, &j, &x->entries.at[i]);
  pl_json_end_object(&j);
  pl_json_end_object(&j);
  add(x, "\n");
}

void pl_export(pl_text* out, const pl_export_input* in) {
  // ORDER EXPORTS
  static void (*const document[])(exporter*) = {add_sympy, add_mathematica, add_maxima,
                                                add_julia, add_python,      add_json};
  pl_arena* a = out->arena;
  exporter x = {.out = out,
                .arena = a,
                .in = in,
                .model = in->solution->model,
                .pool = in->solution->model->pool,
                .interned = pl_names_make(a),
                .keys = pl_map_make(a)};
  int intermediates = 0;  // each may need another name
  for (int i = 0; i < in->solution->sections.n; i++) {
    const pl_section* c = &in->solution->sections.at[i];
    for (int k = 0; k < c->values.n; k++) intermediates += c->values.at[k].n_where;
  }
  x.n_used = pl_symbol_count(x.pool) + intermediates + 1;
  x.used = PL_ARRAY(a, bool, x.n_used);
  collect_all(&x);
  if (in->target != PL_EXPORT_JSON) {
    x.d = &pl_dialects[in->target];
    x.names = pl_export_names_make(a, x.pool, x.d);
  }
  document[in->target](&x);
}
