// Formulas for LaTeX: how wide they come out, and where a displayed one is broken. amsmath breaks
// nothing by itself, so a chain a = b = c gets a line for each link, a sum is broken between its
// terms, and long sums inside fractions and brackets become blocks of several lines.
#include "tex_impl.h"

#include <string.h>

// ------------------------------------------------------------------------------------------- width
// In letters: what a sign takes with the space around it.
static const double infix = 2.2, relation = 2.8, bracket = 0.9, thin = 0.3;

static double sum_width(const pl_tex_page* g, const pl_form* f, double between) {
  double w = 0;
  for (int i = 0; i < f->n; i++) w += pl_tex_width(g, f->args[i]) + (i > 0 ? between : 0);
  return w;
}

static double leaf_width(const pl_tex_page* g, const pl_form* f) {
  const char* s = pl_notation_print(g->arena, g->pool, f, (pl_notation){PL_MATH_LINE, g->how.lang});
  size_t n = strlen(s), small = 0;
  for (const char* c = s; *c; c++)
    small += strchr("'^_", *c) || (c > s && *c >= '0' && *c <= '9' && n > 1);
  return pl_utf8_width(s) - 0.5 * (double)small;
}

static double vector_width(const pl_tex_page* g, const pl_form* f) {
  double w = 0;
  for (int i = 0; i < f->n; i++) {
    bool sum = f->args[i]->kind == PL_F_SUM;
    w += pl_tex_width(g, f->args[i]) + 1.8 + (sum ? 2 * bracket : 0) + (i > 0 ? infix : 0);
  }
  return w;
}

static double product_width(const pl_tex_page* g, const pl_form* f) {
  double w = sum_width(g, f, thin);
  for (int i = 0; i < f->n; i++) w += f->args[i]->kind == PL_F_SUM ? 2 * bracket : 0;
  return w;
}

static double larger(double a, double b) { return a > b ? a : b; }

double pl_tex_width(const pl_tex_page* g, const pl_form* f) {
  switch (f->kind) {
    case PL_F_EXPR:
    case PL_F_NAME: return leaf_width(g, f);
    case PL_F_SUM:
    case PL_F_PLUSMINUS: return sum_width(g, f, infix);
    case PL_F_NEG:
      return 1.2 + sum_width(g, f, 0) + (f->n && f->args[0]->kind == PL_F_SUM ? 2 * bracket : 0);
    case PL_F_PRODUCT: return product_width(g, f);
    case PL_F_QUOTIENT:
      return f->n < 2 ? 1 : 0.5 + larger(pl_tex_width(g, f->args[0]), pl_tex_width(g, f->args[1]));
    case PL_F_POWER:
      return f->n < 2 ? 1
                      : pl_tex_width(g, f->args[0]) + 0.7 * pl_tex_width(g, f->args[1])
                            + (f->args[0]->kind == PL_F_EXPR ? 0 : 2 * bracket);
    case PL_F_ROOT: return 1.6 + sum_width(g, f, 0);
    case PL_F_CALL:
      return 3 + sum_width(g, f, 1) + (f->n && f->args[0]->kind != PL_F_EXPR ? 2 * bracket : 0);
    case PL_F_GROUP: return 2 * bracket + sum_width(g, f, 0);
    case PL_F_RELATION: return sum_width(g, f, relation);
    case PL_F_VECTOR: return vector_width(g, f);
    case PL_F_DERIVATIVE: return 2 + sum_width(g, f, 0);
    case PL_F_INTEGRAL: return 4 + sum_width(g, f, 0);
    case PL_F_ORDER: return 3 + sum_width(g, f, 0);
    case PL_F_LIST: return sum_width(g, f, 1.2);
    case PL_F_TEXT: return f->words[g->how.lang] ? 0.9 * pl_utf8_width(f->words[g->how.lang]) : 0;
  }
  return 1;
}

// ------------------------------------------------------------------------------------------ macros
// \dot, \ddot and \vec by the names that a document may redefine.
static const char* with_macros(pl_tex_page* g, const char* s) {
  static const char* const own[][2] = {
      {"\\dot{", "\\pldot{"}, {"\\ddot{", "\\plddot{"}, {"\\vec{", "\\plvec{"}};
  if (g->style->plain) return s;
  pl_text out = pl_text_make(g->arena);
  while (*s) {
    int k = 0;
    while (k < 3 && strncmp(s, own[k][0], strlen(own[k][0])) != 0) k++;
    if (k < 3) pl_text_add(&out, own[k][1]);
    else pl_text_add_n(&out, s, 1);
    s += k < 3 ? strlen(own[k][0]) : 1;
  }
  return pl_text_string(&out);
}

const char* pl_tex_math(pl_tex_page* g, const pl_form* f) {
  return with_macros(g, pl_notation_print(g->arena, g->pool, f, g->how));
}

// ------------------------------------------------------------------------------------------ blocks
// What is too wide is printed with a name in its place, and then the name is exchanged for a block
// of lines.
typedef struct pl_exchange {
  const char *name, *block;
} pl_exchange;
typedef PL_VEC(pl_exchange) pl_exchanges;

static const char* narrow(pl_tex_page* g, const pl_form* f, double room);

static const pl_form* take_out(pl_tex_page* g, pl_exchanges* list, const pl_form* f, double room) {
  pl_text name = pl_text_make(g->arena);
  pl_text_add(&name, "plblock");
  for (int k = list->n; k >= 0; k = k / 26 - 1)
    pl_text_add_n(&name, &"abcdefghijklmnopqrstuvwxyz"[k % 26], 1);
  pl_exchange x = {pl_text_string(&name), narrow(g, f, room)};
  pl_push(g->arena, *list, x);
  return pl_form_name(g->arena, x.name, pl_poison());
}

// s with every `from` exchanged.
static const char* exchange(pl_tex_page* g, const char* s, const char* from, const char* to) {
  pl_text out = pl_text_make(g->arena);
  for (const char* at; (at = strstr(s, from)) != NULL; s = at + strlen(from)) {
    pl_text_add_n(&out, s, (size_t)(at - s));
    pl_text_add(&out, to);
  }
  pl_text_add(&out, s);
  return pl_text_string(&out);
}

static const char* print_with(pl_tex_page* g, const pl_form* f, const pl_exchanges* list) {
  const char* s = pl_tex_math(g, f);
  for (int i = 0; i < list->n; i++) {
    const char* name = pl_format(g->arena, "\\mathit{%s}", list->at[i].name);
    const char* tall = pl_format(g->arena, "\\left(%s\\right)", list->at[i].block);
    s = exchange(g, s, pl_format(g->arena, "(%s)", name), tall);
    s = exchange(g, s, name, list->at[i].block);
  }
  return s;
}

// A sum in lines of at most `room`; the sign of each term in front of it.
static void sum_lines(pl_tex_page* g, const pl_form* f, double room, const char* begin,
                      pl_tex_lines* out) {
  pl_text line = pl_text_make(g->arena);
  double used = 0;
  pl_text_add(&line, begin);
  for (int i = 0; i < f->n; i++) {
    const pl_form* t = f->args[i];
    bool minus = i > 0 && t->kind == PL_F_NEG && t->n == 1 && t->args[0]->kind != PL_F_SUM;
    if (minus) t = t->args[0];
    double w = pl_tex_width(g, t) + (i > 0 ? infix : 0);
    const char* sign = i == 0 ? "" : minus ? " - " : " + ";
    if (i > 0 && used + w > room) {
      pl_push(g->arena, out->list, pl_text_string(&line));
      line = pl_text_make(g->arena);
      used = 2;
      pl_text_add(&line, "&\\quad{}");
    }
    const pl_form* bracketed = i > 0 && t->kind == PL_F_SUM
                                   ? pl_form_make(g->arena, PL_F_GROUP, 1, &t)
                                   : t;
    pl_text_addf(&line, "%s%s", sign, narrow(g, bracketed, room - 2));
    used += w;
  }
  pl_push(g->arena, out->list, pl_text_string(&line));
  out->last = used;
}

static const char* block_of(pl_tex_page* g, const pl_tex_lines* lines) {
  pl_text out = pl_text_make(g->arena);
  pl_text_add(&out, "\\begin{aligned}");
  for (int i = 0; i < lines->list.n; i++)
    pl_text_addf(&out, "%s%s", i ? " \\\\ " : "", lines->list.at[i]);
  pl_text_add(&out, "\\end{aligned}");
  return pl_text_string(&out);
}

static int widest(pl_tex_page* g, const pl_form* f) {
  int best = 0;
  for (int i = 1; i < f->n; i++) {
    if (pl_tex_width(g, f->args[i]) > pl_tex_width(g, f->args[best])) best = i;
  }
  return best;
}

static bool is_bracketed(const pl_form* f) { return f->kind == PL_F_SUM || f->kind == PL_F_GROUP; }

// The same form with its widest part taken out, brackets kept.
static const char* narrow_part(pl_tex_page* g, const pl_form* f, double room, int part) {
  pl_exchanges list = {0};
  const pl_form** args = PL_ARRAY(g->arena, const pl_form*, f->n);
  memcpy(args, f->args, (size_t)f->n * sizeof *args);
  const pl_form* inner = args[part]->kind == PL_F_GROUP ? args[part]->args[0] : args[part];
  double rest = pl_tex_width(g, f) - pl_tex_width(g, args[part]);
  double left = room - rest > room / 3 ? room - rest : room / 3;
  const pl_form* name = take_out(g, &list, inner, left - 2 * bracket);
  bool fence = is_bracketed(args[part]) && f->kind != PL_F_QUOTIENT && f->kind != PL_F_ROOT
               && f->kind != PL_F_GROUP;
  args[part] = fence ? pl_form_make(g->arena, PL_F_GROUP, 1, &name) : name;
  if (f->kind == PL_F_QUOTIENT && pl_tex_width(g, args[1 - part]) > room)
    args[1 - part] = take_out(g, &list, args[1 - part], room);
  pl_form* copy = pl_form_make(g->arena, f->kind, f->n, args);
  copy->expr = f->expr;
  copy->function = f->function;
  copy->text = f->text;
  copy->names = f->names;
  return print_with(g, copy, &list);
}

// The form as one piece of math at most `room` wide, as far as that can be had.
static const char* narrow(pl_tex_page* g, const pl_form* f, double room) {
  if (pl_tex_width(g, f) <= room || f->n == 0 || room < 12) return pl_tex_math(g, f);
  if (f->kind == PL_F_SUM) {
    pl_tex_lines lines = {0};
    sum_lines(g, f, room, "&", &lines);
    return block_of(g, &lines);
  }
  bool keeps_names = f->kind == PL_F_VECTOR || f->kind == PL_F_LIST || f->kind == PL_F_RELATION
                     || f->kind == PL_F_DERIVATIVE;
  return keeps_names ? pl_tex_math(g, f) : narrow_part(g, f, room, widest(g, f));
}

// ----------------------------------------------------------------------------------------- display
typedef struct pl_constraint_of {
  const char* op;
  const pl_form* form;
} pl_constraint_of;
typedef PL_VEC(pl_constraint_of) pl_chain;

static void chain_of(pl_tex_page* g, const pl_form* f, const char* op, pl_chain* out) {
  if (f->kind == PL_F_RELATION && f->n == 2) {
    chain_of(g, f->args[0], op, out);
    chain_of(g, f->args[1], f->text ? f->text : "=", out);
    return;
  }
  pl_constraint_of constraint = {op, f};
  pl_push(g->arena, *out, constraint);
}

static const char* op_tex(const char* op) {
  static const char* const table[][2] = {{"≥", "\\ge"},     {"≤", "\\le"},  {"≠", "\\ne"},
                                         {"≈", "\\approx"}, {"->", "\\to"}, {"→", "\\to"}};
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    if (strcmp(table[i][0], op) == 0) return table[i][1];
  }
  return op;
}

// A vector in lines: each component with its unit vector is a term.
static const pl_form* spread(pl_tex_page* g, const pl_form* f) {
  if (f->kind != PL_F_VECTOR || f->n < 2) return f;
  const pl_form** term = PL_ARRAY(g->arena, const pl_form*, f->n);
  int n = 0;
  for (int i = 0; i < f->n; i++) {
    const pl_form* c = f->args[i];
    if (c->kind == PL_F_EXPR && pl_is_zero_node(g->pool, c->expr)) continue;
    bool minus = c->kind == PL_F_NEG && c->n == 1;
    pl_form* one = pl_form_vector(g->arena, minus ? c->args : &f->args[i], &f->names[i], 1);
    term[n++] = minus ? pl_form_neg(g->arena, one) : one;
  }
  return n < 2 ? f : pl_form_sum(g->arena, term, n);
}

// One side of a relation, the first line beginning with `begin`.
static void side_lines(pl_tex_page* g, const pl_form* f, double room, const char* begin,
                       pl_tex_lines* out) {
  const pl_form* form = pl_tex_width(g, f) > room ? spread(g, f) : f;
  if (form->kind == PL_F_SUM && pl_tex_width(g, form) > room) {
    sum_lines(g, form, room, begin, out);
    return;
  }
  const char* line = pl_format(g->arena, "%s%s", begin, narrow(g, form, room));
  pl_push(g->arena, out->list, line);
  double w = pl_tex_width(g, form);
  out->last = w < room ? w : room;
}

// The left side of a chain; beside a vector a name has its arrow.
static const char* head_of(pl_tex_page* g, const pl_chain* chain) {
  const char* pair = pl_tex_math(
      g, pl_form_relation(g->arena, chain->at[0].form, "=", chain->at[1].form));
  int depth = 0;
  size_t n = 0;
  for (; pair[n] && !(depth == 0 && strncmp(pair + n, " = ", 3) == 0); n++)
    depth += (pair[n] == '{') - (pair[n] == '}');
  return pl_copy_n(g->arena, pair, n);
}

pl_tex_lines pl_tex_display(pl_tex_page* g, const pl_form* f) {
  pl_tex_lines out = {0};
  pl_chain chain = {0};
  chain_of(g, f, NULL, &chain);
  double whole = pl_tex_width(g, f), left = pl_tex_width(g, chain.at[0].form);
  if (chain.n == 1) {
    side_lines(g, f, PL_TEX_LINE, "&", &out);
    out.right = whole < PL_TEX_LINE ? whole : PL_TEX_LINE;
    return out;
  }
  if (whole <= PL_TEX_LINE) {
    pl_text all = pl_text_make(g->arena);
    pl_text_addf(&all, "%s &", head_of(g, &chain));
    for (int i = 1; i < chain.n; i++)
      pl_text_addf(&all, "%s%s %s", i > 1 ? " " : "", op_tex(chain.at[i].op),
                   pl_tex_math(g, chain.at[i].form));
    pl_push(g->arena, out.list, pl_text_string(&all));
    out.last = whole;
    out.left = left;
    out.right = whole - left;
    return out;
  }
  // a long left side stands on a line of its own
  bool own_line = left > PL_TEX_LINE / 2;
  if (own_line) side_lines(g, chain.at[0].form, PL_TEX_LINE, "&", &out);
  double room = own_line ? PL_TEX_LINE - 4 : PL_TEX_LINE - left - relation;
  for (int i = 1; i < chain.n; i++) {
    bool first = i == 1 && !own_line;
    const char* head = first ? head_of(g, &chain) : own_line ? "&\\quad{}" : "";
    const char* begin = pl_format(g->arena, "%s %s%s ", head, own_line ? "" : "&",
                                  op_tex(chain.at[i].op));
    side_lines(g, chain.at[i].form, room, begin, &out);
  }
  out.last += own_line ? 4 : left + relation;
  out.left = own_line ? 0 : left;
  out.right = PL_TEX_LINE - out.left;
  return out;
}
