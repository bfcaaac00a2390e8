// structured_text: a linear system with named entries, displayed once, and its unknowns as they are
// asked for.
//
//   λ_c1 has 7624 terms; shown in A_k, B_k, R_k: the rows of the system, the names, the solution
// over the names.
// Claimed at points of the motion: each entry against raw differentiation, each row of the system
// with the accelerations and
// multipliers of d'Alembert in it, each unknown.
#include "mechanics/structured.h"
#include "worked/worked_impl.h"

enum { rows_written_out = 4, most_definitions = 48 };

static pl_structure_shown* shown_of(const pl_analysis* d, const pl_structure* s) {
  return &d->page->structure[s->kind == PL_ST_ACCELERATIONS];
}

// ----------------------------------------------------------------------------- forms with an index
static const pl_form* indexed(pl_analysis* d, const char* letter, const char* index) {
  return pl_fn(d, pl_format(d->arena, "%s_%s", letter, index));
}

static const pl_form* times2(pl_analysis* d, const pl_form* a, const pl_form* b) {
  const pl_form* factor[2] = {a, b};
  return pl_form_product(d->arena, factor, 2);
}

static const pl_form* over(pl_analysis* d, const pl_form* a, const pl_form* b) {
  return pl_form_quotient(d->arena, a, b);
}

static const pl_form* minus(pl_analysis* d, const pl_form* a, const pl_form* b) {
  const pl_form* term[2] = {a, pl_form_neg(d->arena, b)};
  return pl_form_sum(d->arena, term, 2);
}

static const pl_form* squared(pl_analysis* d, const pl_form* a) {
  return pl_form_power(d->arena, a, pl_form_leaf(d->arena, pl_int(d->pool, 2)));
}

static const pl_form* sigma(pl_analysis* d, const pl_form* a) {
  return times2(d, pl_fn(d, "Σ"), a);
}

// --------------------------------------------------------------------------------------------- why
static long terms_of(pl_analysis* d, pl_expr e) {
  pl_expr num, den;
  pl_alg_fraction(d->tower, e, &num, &den);
  return pl_kind_of(d->pool, num) == PL_ADD ? pl_n_args(d->pool, num) : 1;
}

static const pl_form* letters_form(pl_analysis* d, const pl_structure* s) {
  const pl_form* name[3];
  int n = 0;
  name[n++] = indexed(d, s->letter[0], s->chain ? "k" : "jk");
  if (s->chain && s->n > 1) name[n++] = indexed(d, s->letter[1], "k");
  name[n++] = indexed(d, s->letter[2], "k");
  return pl_flist(d, name, n);
}

static void say_why(pl_analysis* d, const pl_structure* s, pl_symbol u, pl_expr closed) {
  if (pl_is_poison(closed)) {
    pl_say(d, PL_BOTH("Written out, {1} passes the limit of 3000 terms; shown in {2}:"), 2,
           pl_fs(d, u), letters_form(d, s));
    return;
  }
  long n = terms_of(d, closed);
  pl_say(d, PL_BOTH_FORMAT(d->arena, "{1} has %ld terms; shown in {2}:", n), 2, pl_fs(d, u),
         letters_form(d, s));
}

// -------------------------------------------------------------------------------------- the system
static const pl_form* row_form(pl_analysis* d, const pl_structure* s, int k) {
  const pl_form** term = PL_ARRAY(d->arena, const pl_form*, s->n);
  int n = 0;
  for (int j = 0; j < s->n; j++) {
    pl_symbol c = s->S_name[k * s->n + j];
    if (c.id) term[n++] = times2(d, pl_fs(d, c), pl_fs(d, s->u[j]));
  }
  const pl_form* zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
  const pl_form* left = n == 0 ? zero : n == 1 ? term[0] : pl_form_sum(d->arena, term, n);
  return pl_feq(d, left, s->R_name[k].id ? pl_fs(d, s->R_name[k]) : zero);
}

static pl_expr row_value(pl_analysis* d, const pl_structure* s, int k) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int j = 0; j < s->n; j++) {
    pl_symbol c = s->S_name[k * s->n + j];
    if (c.id)
      sum = pl_add(d->pool, sum, pl_mul(d->pool, pl_sym(d->pool, c), pl_sym(d->pool, s->u[j])));
  }
  return sum;
}

static const char* unknown_letter(const pl_structure* s) {
  return s->kind == PL_ST_MULTIPLIERS ? "λ" : "u";
}

static void say_numbering(pl_analysis* d, const pl_structure* s) {
  const pl_form** u = PL_ARRAY(d->arena, const pl_form*, s->n);
  for (int k = 0; k < s->n; k++) u[k] = pl_fs(d, s->u[k]);
  const char* letter = unknown_letter(s);
  pl_say(d,
         PL_BOTH_FORMAT(
             d->arena,
             "Here %s_1 … %s_%d stand for {1}; i = k + 1, j = k - 1, and what is not listed is 0.",
             letter, letter, s->n),
         1, pl_flist(d, u, s->n));
}

static void show_chain_row(pl_analysis* d, pl_structure* s) {
  const char* u = unknown_letter(s);
  const pl_form* term[3] = {times2(d, indexed(d, s->letter[1], "j"), indexed(d, u, "j")),
                            times2(d, indexed(d, s->letter[0], "k"), indexed(d, u, "k")),
                            times2(d, indexed(d, s->letter[1], "k"), indexed(d, u, "i"))};
  shown_of(d, s)->number =
      pl_show_numbered(d, pl_feq(d, pl_form_sum(d->arena, term, 3), indexed(d, s->letter[2], "k")))
          ->number;
  say_numbering(d, s);
}

static void show_general_row(pl_analysis* d, pl_structure* s) {
  const pl_form* product = times2(d, indexed(d, s->letter[0], "jk"),
                                  indexed(d, unknown_letter(s), "k"));
  shown_of(d, s)->number =
      pl_show_numbered(d, pl_feq(d, sigma(d, product), indexed(d, s->letter[2], "j")))->number;
  const pl_form** u = PL_ARRAY(d->arena, const pl_form*, s->n);
  for (int k = 0; k < s->n; k++) u[k] = pl_fs(d, s->u[k]);
  const char* letter = unknown_letter(s);
  pl_say(
      d,
      PL_BOTH_FORMAT(d->arena,
                     "Sum over k; %s_1 … %s_%d stand for {1}. The matrix is symmetric, and what is "
                     "not listed is 0.",
                     letter, letter, s->n),
      1, pl_flist(d, u, s->n));
}

static void show_system(pl_analysis* d, pl_structure* s) {
  switch (s->kind) {
    case PL_ST_MULTIPLIERS:
      pl_say(d, PL_BOTH("The equations of motion inserted into the differentiated constraints:"),
             0);
      break;
    case PL_ST_BOTH:
      pl_say(d, PL_BOTH("The equations of motion and the differentiated constraints together:"), 0);
      break;
    case PL_ST_ACCELERATIONS:
      pl_say(d, PL_BOTH("The equations of motion are linear in the accelerations:"), 0);
      break;
  }
  if (s->n <= rows_written_out) {
    for (int k = 0; k < s->n; k++) {
      int number = pl_show_numbered(d, row_form(d, s, k))->number;
      if (k == 0) shown_of(d, s)->number = number;
    }
  } else if (s->chain) {
    show_chain_row(d, s);
  } else {
    show_general_row(d, s);
  }
  for (int k = 0; k < s->n; k++) {
    pl_claim_that(d, PL_CLAIM_MOTION, row_value(d, s, k),
                  s->R_name[k].id ? pl_sym(d->pool, s->R_name[k]) : pl_int(d->pool, 0));
  }
}

static void show_lines(pl_analysis* d, const pl_structure* s, int from, int to, bool detail) {
  for (int k = from; k < to; k++) {
    const pl_naming* l = &s->lines.at[k];
    pl_show(d, pl_feq(d, pl_fs(d, l->name), l->form))->detail = detail;
  }
}

static void claim_entry(pl_analysis* d, const pl_naming* l) {
  pl_claim_that(d, PL_CLAIM_MOTION, pl_sym(d->pool, l->name), l->raw);
  pl_replace level;
  if (!pl_structure_level(d, l->level, &level)) return;
  pl_claim_that(d, PL_CLAIM_MOTION, pl_subst(d->pool, l->value, &level, 1),
                pl_subst(d->pool, l->exact, &level, 1));
}

static void show_entries(pl_analysis* d, const pl_structure* s) {
  bool many = s->n_entries > most_definitions;
  if (many) {
    pl_say(d,
           PL_BOTH_FORMAT(d->arena,
                          "The %d entries stand in the JSON answer and here with --steps full.",
                          s->n_entries),
           0);
  } else {
    pl_say(d, PL_BOTH("with"), 0);
  }
  show_lines(d, s, 0, s->n_entries, many);
  for (int k = 0; k < s->n_entries; k++) claim_entry(d, &s->lines.at[k]);
}

// ------------------------------------------------------------------------------------ the solution
static void show_chain_recursion(pl_analysis* d, const pl_structure* s) {
  const char *D = s->letter[3], *Y = s->letter[5], *B = s->letter[1], *u = unknown_letter(s);
  const pl_form* Bj = indexed(d, B, "j");
  pl_say(d, PL_BOTH("From the first row to the last, then backwards:"), 0);
  pl_show(d, pl_feq(d, indexed(d, D, "k"),
                    minus(d, indexed(d, s->letter[0], "k"),
                          over(d, squared(d, Bj), indexed(d, D, "j")))));
  pl_show(d, pl_feq(d, indexed(d, Y, "k"),
                    minus(d, indexed(d, s->letter[2], "k"),
                          over(d, times2(d, Bj, indexed(d, Y, "j")), indexed(d, D, "j")))));
  const pl_form* rest = minus(d, indexed(d, Y, "k"),
                              times2(d, indexed(d, B, "k"), indexed(d, u, "i")));
  pl_show(d, pl_feq(d, indexed(d, u, "k"), over(d, rest, indexed(d, D, "k"))));
}

static void show_general_recursion(pl_analysis* d, const pl_structure* s) {
  const char *D = s->letter[3], *Y = s->letter[5], *C = s->letter[4], *S = s->letter[0],
             *u = unknown_letter(s);
  const pl_form *Di = indexed(d, D, "i"), *Cik = indexed(d, C, "ik"), *Cij = indexed(d, C, "ij");
  pl_say(d,
         PL_BOTH(
             "From the first row to the last, then backwards (sums over i < k, in the last formula "
             "over j > k):"),
         0);
  pl_show(d, pl_feq(d, indexed(d, D, "k"),
                    minus(d, indexed(d, S, "kk"), sigma(d, over(d, squared(d, Cik), Di)))));
  pl_show(d, pl_feq(d, indexed(d, C, "kj"),
                    minus(d, indexed(d, S, "kj"), sigma(d, over(d, times2(d, Cik, Cij), Di)))));
  pl_show(d, pl_feq(d, indexed(d, Y, "k"),
                    minus(d, indexed(d, s->letter[2], "k"),
                          sigma(d, over(d, times2(d, Cik, indexed(d, Y, "i")), Di)))));
  const pl_form* rest = minus(d, indexed(d, Y, "k"),
                              sigma(d, times2(d, indexed(d, C, "kj"), indexed(d, u, "j"))));
  pl_show(d, pl_feq(d, indexed(d, u, "k"), over(d, rest, indexed(d, D, "k"))));
}

static void show_recursion(pl_analysis* d, const pl_structure* s) {
  int to = s->n_entries + s->n_pivots;
  if (s->closed) {
    show_lines(d, s, s->n_entries, to, false);
    return;
  }
  bool by_index = s->kind != PL_ST_BOTH && s->natural;
  if (by_index && s->chain) show_chain_recursion(d, s);
  else if (by_index) show_general_recursion(d, s);
  else pl_say(d, PL_BOTH("Row by row:"), 0);
  show_lines(d, s, s->n_entries, to, by_index);
}

static void tell(pl_analysis* d, pl_structure* s, pl_symbol u, pl_expr closed) {
  pl_structure_shown* shown = shown_of(d, s);
  if (shown->told) return;
  shown->told = true;
  shown->section = d->page->solution->sections.n;
  say_why(d, s, u, closed);
  show_system(d, s);
  show_entries(d, s);
  show_recursion(d, s);
}

// ----------------------------------------------------------------------------------------- answers
static int line_of(const pl_structure* s, pl_symbol u) {
  for (int k = s->n_entries + s->n_pivots; k < s->lines.n; k++) {
    if (s->lines.at[k].name.id == u.id) return k;
  }
  return -1;
}

static bool speaks_of(pl_analysis* d, const pl_value* v, pl_symbol s) {
  bool has = pl_has_symbol(d->pool, v->expr, s);
  for (int c = 0; c < v->n_components; c++) has |= pl_has_symbol(d->pool, v->components[c].expr, s);
  return has;
}

// The names that the value needs, in the order in which they can be computed.
static void add_where(pl_analysis* d, const pl_structure* s, pl_value* v) {
  bool* needed = PL_ARRAY(d->arena, bool, s->lines.n);
  int n = 0;
  for (int k = s->lines.n - 1; k >= 0; k--) {
    pl_symbol name = s->lines.at[k].name;
    needed[k] = speaks_of(d, v, name);
    for (int later = k + 1; later < s->lines.n && !needed[k]; later++) {
      needed[k] = needed[later] && pl_has_symbol(d->pool, s->lines.at[later].value, name);
    }
    n += needed[k];
  }
  v->where_name = PL_ARRAY(d->arena, const char*, n + 1);
  v->where_expr = PL_ARRAY(d->arena, pl_expr, n + 1);
  for (int k = 0; k < s->lines.n; k++) {
    if (!needed[k]) continue;
    v->where_name[v->n_where] = pl_symbol_get(d->pool, s->lines.at[k].name)->ascii;
    v->where_expr[v->n_where++] = s->lines.at[k].value;
  }
}

void pl_structure_where(pl_analysis* d, pl_value* v) {
  if (v->n_where > 0) return;
  if (d->of_multipliers) add_where(d, d->of_multipliers, v);
  if (v->n_where == 0 && d->of_accelerations) add_where(d, d->of_accelerations, v);
}

// x'' = (F + sum λ dg/dx)/m when no other acceleration stands in the equation of x.
static pl_expr own_row(pl_analysis* d, int i) {
  pl_pool* p = d->pool;
  pl_expr e = pl_on_contact(d, d->euler[i]), own = pl_diff(p, e, d->q.at[i].a),
          rest = pl_subst1(p, e, d->q.at[i].a, pl_int(p, 0));
  if (pl_is_zero_node(p, own) || pl_has_role(p, rest, PL_R_ACCELERATION)) return pl_poison();
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (l->implied || l->fixes >= 0) continue;
    rest = pl_sub(p, rest, pl_mul(p, pl_sym(p, l->lambda), pl_on_contact(d, l->push[i])));
  }
  return pl_neg(p, pl_div(p, rest, own));
}

typedef struct pl_found {
  pl_structure* s;
  pl_expr value;
  const pl_form* form;
} pl_found;

static int bond_of(const pl_analysis* d, pl_symbol lambda) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].lambda.id == lambda.id) return k;
  }
  return -1;
}

// With generalized coordinates, beside their accelerations: the acceleration of a coordinate that
// follows from them, by its map; a
// multiplier, by one equation of the first kind.  It becomes a line over the accelerations.
static bool find_by_row(pl_analysis* d, pl_symbol u, pl_found* f) {
  pl_structure* s = d->reduced ? pl_structure_of_accelerations(d) : NULL;
  int bond = bond_of(d, u), i, line = s ? line_of(s, u) : -1;
  if (!s) return false;
  if (line >= 0) {
    *f = (pl_found){s, s->lines.at[line].value, s->lines.at[line].form};
    return true;
  }
  pl_expr e = bond >= 0 ? pl_multiplier_by_row(d, bond, &i) : pl_sym(d->pool, u);
  if (pl_is_poison(e)) return false;
  e = pl_alg_normal(d->tower, pl_on_maps(d, e));
  if (pl_has_role(d->pool, e, PL_R_MULTIPLIER) || pl_has_symbol(d->pool, e, u)) return false;
  const pl_form* form = pl_positive_first(d, pl_f(d, e, PL_S_QUOTIENT));
  pl_expr value = pl_form_value(d->pool, form);
  pl_push(
      d->arena, s->lines,
      (pl_naming){.name = u, .value = value, .exact = value, .raw = e, .form = form, .level = -1});
  *f = (pl_found){s, value, form};
  return true;
}

static bool find(pl_analysis* d, pl_symbol u, pl_found* f) {
  int i = pl_variable_index(d, u);
  bool acceleration = i >= 0 && d->q.at[i].a.id == u.id;
  pl_structure* s = acceleration && d->reduced ? pl_structure_of_accelerations(d)
                                               : pl_structure_of_multipliers(d);
  int k = s ? line_of(s, u) : -1;
  if (k >= 0) {
    *f = (pl_found){s, s->lines.at[k].value, s->lines.at[k].form};
    return true;
  }
  if (d->reduced) return find_by_row(d, u, f);
  if (!s || !acceleration || s->kind != PL_ST_MULTIPLIERS) return false;
  pl_expr row = own_row(d, i);
  if (pl_is_poison(row)) return false;
  const pl_form* form = pl_positive_first(d, pl_f(d, pl_alg_normal(d->tower, row), PL_S_QUOTIENT));
  *f = (pl_found){s, pl_form_value(d->pool, form), form};
  return true;
}

static void answer(pl_analysis* d, pl_symbol u, const pl_found* f) {
  pl_claim_that(d, PL_CLAIM_MOTION, f->value, pl_sym(d->pool, u));
  pl_value* v = pl_answer(d, pl_symbol_get(d->pool, u)->ascii, f->value, f->form);
  add_where(d, f->s, v);
}

bool pl_show_structured(pl_analysis* d, pl_symbol u, pl_expr closed) {
  pl_found f;
  if (!find(d, u, &f)) return false;
  bool again = shown_of(d, f.s)->told && shown_of(d, f.s)->section != d->page->solution->sections.n;
  tell(d, f.s, u, closed);
  if (again)
    pl_say(d, PL_BOTH("From {1}, solved over the names above:"), 1,
           pl_fref(d, shown_of(d, f.s)->number));
  pl_step* step = pl_show_numbered(d, pl_feq(d, pl_fs(d, u), f.form));
  pl_step_refs(step, 1, shown_of(d, f.s)->number);
  answer(d, u, &f);
  return true;
}

bool pl_answer_structured(pl_analysis* d, pl_symbol u) {
  pl_found f;
  if (!find(d, u, &f)) return false;
  for (int k = 0; k < f.s->n_entries && !shown_of(d, f.s)->told; k++)
    claim_entry(d, &f.s->lines.at[k]);
  answer(d, u, &f);
  return true;
}

// e with each acceleration that has a row of its own inserted; false when some acceleration or
// multiplier has no line.
static bool over_lines(pl_analysis* d, pl_expr* e, pl_found* last) {
  int n = pl_symbols_in(d->pool, *e, NULL, 0);
  pl_symbol* s = PL_ARRAY(d->arena, pl_symbol, n + 1);
  pl_symbols_in(d->pool, *e, s, n);
  last->s = NULL;
  for (int k = 0; k < n; k++) {
    pl_role role = pl_symbol_get(d->pool, s[k])->role;
    if (role != PL_R_ACCELERATION && role != PL_R_MULTIPLIER) continue;
    pl_found f;
    if (!find(d, s[k], &f) || (last->s && last->s != f.s)) return false;
    if (line_of(f.s, s[k]) < 0) *e = pl_subst1(d->pool, *e, s[k], f.value);
    *last = f;
  }
  return last->s != NULL;
}

bool pl_show_value_structured(pl_analysis* d, pl_expr asked, pl_expr e) {
  pl_found f;
  if (!over_lines(d, &e, &f)) return false;
  int first = f.s->n_entries + f.s->n_pivots;
  tell(d, f.s, f.s->u[0], pl_poison());
  pl_expr value = pl_alg_normal(d->tower, e);
  for (int k = first; k < f.s->lines.n; k++) {
    if (pl_has_symbol(d->pool, value, f.s->lines.at[k].name)) show_lines(d, f.s, k, k + 1, false);
  }
  const pl_form* form = pl_f(d, value, PL_S_QUOTIENT);
  if (!pl_same(asked, value)) pl_show_numbered(d, pl_feq(d, pl_fe(d, asked), form));
  pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, form), pl_with_results(d, asked));
  pl_value* v = pl_answer(d, pl_expr_text(d->arena, d->pool, asked), value, form);
  for (int k = first; k < f.s->lines.n && pl_same(asked, value); k++) {  // an unknown itself
    if (pl_same(asked, pl_sym(d->pool, f.s->lines.at[k].name))) {
      v->expr = f.s->lines.at[k].value;
      v->form = f.s->lines.at[k].form;
    }
  }
  add_where(d, f.s, v);
  return true;
}

bool pl_structure_is_told(const pl_analysis* d) {
  return d->of_multipliers && shown_of(d, d->of_multipliers)->told;
}
