// answer_lagrange1: the Lagrange equations of the first kind, in the coordinates or along an
// orthonormal frame, and the way from
// them to the multipliers: constraints twice differentiated, equations inserted, solved.
#include <string.h>

#include "worked/worked_impl.h"

// ------------------------------------------------------------------------------------ one equation
// M_i a = forces + sum lambda dg/dq_i, each side divided by the scale of the frame.
typedef struct pl_sides {
  pl_expr inertia, force;
} pl_sides;

static pl_expr without_accelerations(pl_analysis* d, pl_expr e) {
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, d->q.n);
  for (int j = 0; j < d->q.n; j++) zero[j] = (pl_replace){d->q.at[j].a, pl_int(d->pool, 0)};
  return pl_subst(d->pool, e, zero, d->q.n);
}

static pl_sides sides_of(pl_analysis* d, int i, pl_expr scale, bool insert) {
  pl_expr e = insert ? pl_on_fixed(d, d->euler[i]) : d->euler[i];
  pl_expr force = without_accelerations(d, e);
  pl_sides s = {pl_sub(d->pool, e, force), pl_neg(d->pool, force)};
  s.inertia = pl_alg_normal(d->tower, pl_div(d->pool, s.inertia, scale));
  s.force = pl_alg_normal(d->tower, pl_div(d->pool, s.force, scale));
  return s;
}

static const pl_form* push_form(pl_analysis* d, const pl_bond* l, pl_expr gradient) {
  const pl_form* lambda = pl_fs(d, l->lambda);
  if (pl_is_one_node(d->pool, gradient)) return lambda;
  long n;
  if (pl_is_int(d->pool, gradient, &n) && n == -1) return pl_form_neg(d->arena, lambda);
  pl_expr product = pl_mul(d->pool, pl_sym(d->pool, l->lambda), gradient);
  return pl_f(d, product, PL_S_PLAIN);
}

// Terms of a form, so that the multipliers stand at the end of one flat sum.
static void flatten(const pl_form* f, const pl_form** out, int* n, int max) {
  if (f->kind == PL_F_SUM && *n + f->n <= max) {
    for (int k = 0; k < f->n; k++) out[(*n)++] = f->args[k];
  } else {
    out[(*n)++] = f;
  }
}

enum { max_sum = 96 };

static const pl_form* right_side(pl_analysis* d, int i, const pl_sides* s, pl_expr scale,
                                 bool insert) {
  const pl_form** term = PL_ARRAY(d->arena, const pl_form*, max_sum + d->g.n);
  int n = 0;
  if (!pl_is_zero_node(d->pool, s->force))
    flatten(pl_f(d, s->force, PL_S_EQUATION), term, &n, max_sum);
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if ((l->implied && !l->shared) || (insert && l->fixes >= 0 && !l->contact && l->fixes != i))
      continue;
    pl_expr gradient = pl_div(d->pool, insert ? pl_on_fixed(d, l->push[i]) : l->push[i], scale);
    gradient = pl_alg_normal(d->tower, gradient);
    if (!pl_is_zero_node(d->pool, gradient))
      flatten(push_form(d, l, gradient), term, &n, max_sum + d->g.n);
  }
  if (n == 0) return pl_form_leaf(d->arena, pl_int(d->pool, 0));
  return n == 1 ? term[0] : pl_form_sum(d->arena, term, n);
}

static pl_expr push_of(pl_analysis* d, int i) {
  pl_expr sum = pl_int(d->pool, 0);
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].implied && !d->g.at[k].shared) continue;
    sum = pl_add(d->pool, sum,
                 pl_mul(d->pool, pl_sym(d->pool, d->g.at[k].lambda), d->g.at[k].push[i]));
  }
  return sum;
}

static void show_equation(pl_analysis* d, int i, pl_expr scale, bool insert) {
  pl_sides s = sides_of(d, i, scale, insert);
  if (pl_is_zero_node(d->pool, s.inertia) && pl_is_zero_node(d->pool, s.force)
      && d->q.at[i].fixed_by < 0 && pl_is_zero_node(d->pool, push_of(d, i))) {
    return;
  }
  if (pl_is_one_node(d->pool, scale)) pl_why_first_kind(d, i);
  const pl_form* left = pl_f(d, s.inertia, PL_S_EQUATION);
  pl_step* step = pl_show_numbered(d, pl_feq(d, left, right_side(d, i, &s, scale, insert)));
  pl_push(d->arena, d->page->lagrange1_numbers, step->number);
  if (!d->page->number_lagrange1) d->page->number_lagrange1 = step->number;
  // On the motion the displayed equation is the row of d'Alembert.
  pl_claim_that(d, PL_CLAIM_MOTION, pl_form_value(d->pool, left),
                pl_add(d->pool, s.force, pl_div(d->pool, push_of(d, i), scale)));
}

// ------------------------------------------------------------------------------------------ frames
static const pl_particle* particle_of_frame(pl_analysis* d, const pl_ask* ask, pl_frame* f) {
  for (int k = 0; k < d->particle.n; k++) {
    const pl_particle* m = &d->particle.at[k];
    if (!pl_frame_find(d, m, f)) continue;
    for (int j = 0; j < f->n; j++) {
      if (ask->frame.n > 0 && d->q.at[f->coordinate[j]].q.id == ask->frame.at[0].id) return m;
    }
  }
  return NULL;
}

static const pl_form* vector_form(pl_analysis* d, const pl_frame* f, const pl_expr* component,
                                  pl_style style) {
  const pl_form** part = PL_ARRAY(d->arena, const pl_form*, f->n);
  const char** unit = PL_ARRAY(d->arena, const char*, f->n);
  int n = 0;
  for (int j = 0; j < f->n; j++) {
    if (pl_is_zero_node(d->pool, component[j])) continue;
    part[n] = pl_f(d, component[j], style);
    unit[n++] = pl_unit_vector(d, f->coordinate[j]);
  }
  if (n == 0) return pl_form_leaf(d->arena, pl_int(d->pool, 0));
  return pl_form_vector(d->arena, part, unit, n);
}

// Components of a vector, given along the axes, in the frame.
static void in_frame(pl_analysis* d, const pl_particle* k, const pl_frame* f, const pl_expr* vector,
                     pl_expr* out) {
  for (int j = 0; j < f->n; j++) {
    pl_expr sum = pl_int(d->pool, 0);
    for (int c = 0; c < k->n; c++) {
      pl_expr along = pl_diff(d->pool, k->at[c], d->q.at[f->coordinate[j]].q);
      sum = pl_add(d->pool, sum, pl_mul(d->pool, vector[c], along));
    }
    out[j] = pl_alg_normal(d->tower, pl_div(d->pool, sum, f->scale[j]));
  }
}

static void show_vector(pl_analysis* d, const char* name, const pl_frame* f,
                        const pl_expr* component) {
  pl_show(d, pl_feq(d, pl_fn(d, name), vector_form(d, f, component, PL_S_EQUATION)));
}

// Velocity, acceleration, weight and constraint forces along the frame.
static void show_kinematics(pl_analysis* d, const pl_particle* k, const pl_frame* f) {
  pl_expr vector[3], component[3];
  for (int c = 0; c < k->n; c++) vector[c] = pl_dt(d->pool, k->at[c]);
  in_frame(d, k, f, vector, component);
  show_vector(d, "v", f, component);
  for (int c = 0; c < k->n; c++) vector[c] = pl_dt(d->pool, vector[c]);
  in_frame(d, k, f, vector, component);
  show_vector(d, "a", f, component);
  for (int c = 0; c < k->n; c++) vector[c] = pl_int(d->pool, 0);
  for (int j = 0; j < d->model->gravities.n; j++) {
    const pl_gravity* g = &d->model->gravities.at[j];
    if (g->axis >= k->n) continue;
    pl_expr weight = pl_mul_n(d->pool, (pl_expr[]){pl_int(d->pool, g->sign), k->mass, g->g}, 3);
    vector[g->axis] = pl_add(d->pool, vector[g->axis], weight);
  }
  in_frame(d, k, f, vector, component);
  if (d->model->gravities.n > 0) show_vector(d, "F_g", f, component);
  for (int c = 0; c < d->g.n; c++) {
    const pl_bond* l = &d->g.at[c];
    bool acts = false;
    for (int j = 0; j < f->n; j++) {
      pl_expr push = pl_div(d->pool,
                            pl_mul(d->pool, pl_sym(d->pool, l->lambda), l->push[f->coordinate[j]]),
                            f->scale[j]);
      component[j] = pl_alg_normal(d->tower, push);
      acts |= !pl_is_zero_node(d->pool, component[j]);
    }
    if (acts && (!l->implied || l->shared))
      show_vector(d, pl_format(d->arena, "Z_%s", l->source->name.text), f, component);
  }
}

// ------------------------------------------------------------------------------------- the section
static const char* title_of(pl_analysis* d, pl_language lang) {
  const pl_bond* only = NULL;
  int n = 0;
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].fixes >= 0 && !d->g.at[k].contact) continue;
    only = &d->g.at[k];
    n++;
  }
  const char* en = "Lagrange equations of the first kind";
  const char* de = pl_german("Lagrange equations of the first kind");
  const char* sign = d->model->lambda_minus ? "-" : "";
  const char* Z = pl_letter(d, "Z");
  if (d->g.n == 0) return lang == PL_GERMAN ? de : en;
  if (n != 1)
    return pl_format(
        d->arena,
        lang == PL_GERMAN ? pl_german("%s, with %s = %sΣ λ ∇g") : "%s, with %s = %sΣ λ ∇g",
        lang == PL_GERMAN ? de : en, Z, sign);
  const char* lambda = pl_symbol_get(d->pool, only->lambda)->name;
  return pl_format(
      d->arena, lang == PL_GERMAN ? pl_german("%s, with %s = %s%s ∇%s") : "%s, with %s = %s%s ∇%s",
      lang == PL_GERMAN ? de : en, Z, sign, lambda, only->source->name.text);
}

static void lagrange1_in_frame(pl_analysis* d, const pl_particle* k, const pl_frame* f) {
  pl_why_frame(d, k, f);
  show_kinematics(d, k, f);
  pl_say(d, PL_BOTH("Newton's law with {1} along the unit vectors:"), 1, pl_fl(d, "Z"));
  for (int j = 0; j < f->n; j++) show_equation(d, f->coordinate[j], f->scale[j], false);
}

static void lagrange1_in_coordinates(pl_analysis* d, const pl_ask* ask) {
  bool insert = d->fixed.n > 0;
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    bool named = ask->frame.n == 0;
    for (int j = 0; j < ask->frame.n; j++) named |= ask->frame.at[j].id == c->q.id;
    if (!c->carries || !named) continue;
    if (ask->frame.n == 0 && c->fixed_by >= 0 && !c->by_contact) continue;
    show_equation(d, i, pl_int(d->pool, 1), insert && c->fixed_by < 0);
  }
}

// Operations of a normal form up to which a shorter one is looked for, and of that; beyond them the
// value is given over named
// intermediates.
static const long longest_searched = 1500, longest_answer = 150;

static void answer_accelerations(pl_analysis* d) {
  for (int i = 0; i < d->q.n; i++) {
    const pl_variable* c = &d->q.at[i];
    if (!c->carries || (c->fixed_by >= 0 && !c->by_contact)) continue;
    bool open = !d->solved || pl_is_poison(d->acceleration[i]);
    bool can = c->fixed_by < 0,
         unread = open || pl_op_count(d->pool, d->acceleration[i]) > longest_searched;
    if ((unread && can && pl_answer_structured(d, c->a)) || open) continue;
    const pl_form* form = pl_f(d, d->acceleration[i], PL_S_QUOTIENT);
    if (!unread && pl_form_ops(form) > longest_answer && can && pl_answer_structured(d, c->a))
      continue;
    pl_answer(d, pl_symbol_get(d->pool, c->a)->ascii, d->acceleration[i], form);
  }
}

// A force on a coordinate that is only a name for the place of masses: how it divides among them is
// open up to constraint forces.
static bool not_in_these_coordinates(pl_analysis* d) {
  int i = pl_loaded_by_name(d);
  if (i < 0) return false;
  pl_say(d,
         PL_BOTH(
             "A force or potential acts on {1}, which only names the place of the masses. How it "
             "divides among their coordinates is not "
             "determined, constraint forces may be added; the equations of the second kind need no "
             "such choice."),
         1, pl_fs(d, d->q.at[i].q));
  d->page->section->not_found = true;
  return true;
}

// No mass stands in the coordinates that are named.
static void say_not_along(pl_analysis* d, const pl_ask* ask) {
  const pl_form** name = PL_ARRAY(d->arena, const pl_form*, ask->frame.n + 1);
  for (int j = 0; j < ask->frame.n; j++) name[j] = pl_fs(d, ask->frame.at[j]);
  pl_say(
      d,
      PL_BOTH(
          "The masses do not stand in {1}: ask for the equations without \"in\", for those of the "
          "second kind, or write the places of the "
          "masses in {1}."),
      1, pl_flist(d, name, ask->frame.n));
  d->page->section->not_found = true;
}

void pl_answer_lagrange1(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, title_of(d, PL_ENGLISH), title_of(d, PL_GERMAN));
  if (not_in_these_coordinates(d)) {
    answer_accelerations(d);
    return;
  }
  pl_frame frame;
  const pl_particle* k = ask->frame.n > 0 ? particle_of_frame(d, ask, &frame) : NULL;
  bool own = k && frame.n > 0;
  // A frame of plain coordinates adds nothing to the equations in coordinates.
  for (int j = 0; own && j < frame.n; j++)
    own = !pl_is_one_node(d->pool, frame.scale[j]) || frame.n > 1;
  if (own) {
    lagrange1_in_frame(d, k, &frame);
  } else {
    int before = d->page->lagrange1_numbers.n;
    lagrange1_in_coordinates(d, ask);
    if (ask->frame.n > 0 && d->page->lagrange1_numbers.n == before) say_not_along(d, ask);
  }
  answer_accelerations(d);
}
