// Bodies in space. `body B: mass m, inertia J at (x, y, z) axes ...` becomes a mass at its centre,
// the kinetic energy of its turning, and the constraints that hold between the numbers of its
// attitude; `torque (Mx, My, Mz) on B` a load.
#include <math.h>
#include <string.h>

#include "lang/lower_impl.h"

// ------------------------------------------------------------------------------- names, first pass
static const char* condition_name(pl_lower* l, const char* label, const char* part) {
  return pl_format(l->arena, "%s_%s", label, part);
}

static void declare_condition(pl_lower* l, const pl_ast* label, bool family, const char* part) {
  pl_rule r = {.family = family};
  r.key = pl_intern(l->names, condition_name(l, pl_ast_kid(label, 0)->key, part));
  r.shown = condition_name(l, pl_ast_kid(label, 0)->shown, part);
  if (pl_scope_rule(l, r.key)) return;
  pl_symbol_info info = {.name = pl_format(l->arena, "λ_%s", r.shown),
                         .ascii = pl_format(l->arena, "lambda_%s", r.key),
                         .role = PL_R_MULTIPLIER,
                         .class = PL_C_MULTIPLIER,
                         .dimension = pl_dimension_one()};
  r.lambda = pl_symbol_make(l->pool, &info);
  pl_push(l->arena, l->rules, r);
}

void pl_space_declare(pl_lower* l, const pl_ast* body) {
  pl_attitude shape = {.form = pl_attitude_form(pl_ast_kid(body, 5))};
  const pl_ast* label = pl_ast_kid(body, 0);
  pl_expr left, right;
  const char* part;
  for (int i = 0; i < 9; i++) shape.at[i] = pl_int(l->pool, 0);
  for (int k = 0; pl_attitude_condition(l->pool, &shape, k, &left, &right, &part); k++)
    declare_condition(l, label, pl_ast_kid(label, 1) != NULL || l->block != NULL, part);
}

// ----------------------------------------------------------------------------------------- inertia
static bool vanishes(pl_lower* l, pl_expr e) {
  if (pl_is_zero_node(l->pool, e)) return true;
  for (uint64_t seed = 1; seed <= 3; seed++) {
    bool ok;
    uint64_t residue = pl_eval_mod(pl_mod_point_make(l->arena, l->pool, seed), e, &ok);
    if (!ok || residue != 0) return false;
  }
  return true;
}

static void complain_inertia(pl_lower* l, const pl_ast* node) {
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E017, pl_ast_span(node),
      PL_BOTH(
          "the inertia of a body in space is three principal moments, (J1, J2, J3), or a matrix of "
          "three rows"));
  pl_suggest(l->job, m, NULL,
             PL_BOTH("write  ((Jxx, Jxy, Jxz), (Jxy, Jyy, Jyz), (Jxz, Jyz, Jzz))"));
}

// Symbols or numbers: what is the same on both sides of the diagonal is one entry.
static bool symmetric(pl_lower* l, pl_expr rows[9], const pl_ast* node) {
  double* value = pl_model_values(l->m, l->arena);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < i; j++) {
      pl_expr a = rows[3 * j + i], b = rows[3 * i + j];
      double x = pl_eval(l->pool, a, value), y = pl_eval(l->pool, b, value);
      if (vanishes(l, pl_sub(l->pool, a, b)) || x == y) continue;
      pl_diagnostic* m = pl_lower_complain(
          l, PL_E067, pl_ast_span(node),
          PL_BOTH("a matrix of inertia is symmetric: entries %d%d and %d%d are %s and %s"), j + 1,
          i + 1, i + 1, j + 1, pl_expr_text(l->arena, l->pool, a),
          pl_expr_text(l->arena, l->pool, b));
      pl_suggest(l->job, m, NULL, PL_BOTH("write the same on both sides of the diagonal"));
      return false;
    }
  }
  return true;
}

// Three numbers: principal moments; three vectors: rows of a matrix.
static bool read_group(pl_lower* l, const pl_ast* group, const pl_ast* node, pl_expr J[6]) {
  pl_expr rows[9];
  int n_vectors = 0;
  for (int i = 0; i < 3; i++) {
    pl_quantity q = pl_lower_quantity(l, group->kids.at[i]);
    if (pl_quantity_is_bad(&q)) return false;
    n_vectors += q.n == 3;
    if (q.n == 2) n_vectors = -9;
    for (int j = 0; j < 3; j++)
      rows[3 * i + j] = q.n == 3 ? q.at[j] : i == j ? q.at[0] : pl_int(l->pool, 0);
  }
  if (n_vectors != 0 && n_vectors != 3) {
    complain_inertia(l, node);
    return false;
  }
  if (n_vectors && !symmetric(l, rows, node)) return false;
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++) J[k++] = rows[3 * i + j];
  return true;
}

static bool read_inertia(pl_lower* l, const pl_ast* node, pl_expr J[6]) {
  const pl_ast* group = pl_ast_single(node);
  pl_unit unit;
  const pl_ast* unit_node = NULL;
  if (group && group->kind == PL_AST_UNIT) {  // one unit for all: (1, 2, 3) [kg m^2]
    if (!pl_lower_unit(l, group, &unit)) return false;
    unit_node = group;
    group = pl_ast_single(pl_ast_kid(group, 0));
  }
  if (group && group->kind == PL_AST_GROUP && group->kids.n == 3) {
    if (!read_group(l, group, node, J)) return false;
    for (int k = 0; k < 6 && unit_node; k++) {
      bool number = pl_is_constant(l->pool, J[k]);
      J[k] = number ? pl_measure_make(l->pool, J[k], &unit, unit_node->text)
                    : pl_mul(l->pool, J[k], unit.factor);
    }
    return true;
  }
  pl_quantity q = pl_lower_quantity(l, node);
  if (pl_quantity_is_bad(&q)) return false;
  if (q.n != 3) complain_inertia(l, node);
  for (int k = 0; k < 6; k++) J[k] = pl_int(l->pool, 0);
  J[0] = q.at[0];
  J[3] = q.at[1];
  J[5] = q.at[2];
  return q.n == 3;
}

// ------------------------------------------------------------------------------------------ bodies
// A condition that holds whatever moves is none: axes (cos φ, sin φ, 0), ...
static bool is_needed(pl_lower* l, const pl_ast* axes, const pl_constraint* c, const char* part) {
  if (vanishes(l, c->g)) return false;
  if (pl_has_role(l->pool, c->g, PL_R_COORD) || pl_has_role(l->pool, c->g, PL_R_ARRAY)) return true;
  double x = pl_eval(l->pool, pl_unit_to_si(l->pool, c->g), pl_model_values(l->m, l->arena));
  if (fabs(x) < 1e-12) return false;
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E067, pl_ast_span(axes),
      PL_BOTH("the axes of a body are unit vectors at right angles: %s is %s, not %s"),
      part[0] == 'u' ? "|q|²" : pl_format(l->arena, "e%c·e%c", part[0], part[1]),
      pl_expr_text(l->arena, l->pool, c->left), pl_expr_text(l->arena, l->pool, c->right));
  pl_suggest(l->job, m, NULL, PL_BOTH("give unit vectors, or coordinates"));
  return false;
}

// e1 · (e2 × e3) > 0: of the two frames that orthonormal vectors allow, the right-handed one.
static void choose_right_hand(pl_lower* l, const pl_site* p, pl_span span) {
  const pl_expr* e = p->attitude.at;
  pl_pool* q = l->pool;
  pl_condition c = {.left = pl_int(q, 0), .right = pl_int(q, 0), .relation = PL_GT, .span = span};
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    pl_expr cross = pl_sub(q, pl_mul(q, e[3 + j], e[6 + k]), pl_mul(q, e[3 + k], e[6 + j]));
    c.left = pl_add(q, c.left, pl_mul(q, e[i], cross));
  }
  if (l->block == NULL) pl_push(l->arena, l->m->branches, c);
}

static void push_conditions(pl_lower* l, const pl_ast* s, const pl_site* p) {
  const pl_ast* axes = pl_ast_kid(s, 5);
  pl_constraint c = {.relation = PL_EQ,
                     .block = l->block,
                     .span = pl_ast_span(axes),
                     .body = p->shown,
                     .axes = p->attitude.form};
  const char* part;
  int n = 0;
  for (int k = 0; pl_attitude_condition(l->pool, &p->attitude, k, &c.left, &c.right, &part); k++) {
    c.g = pl_sub(l->pool, c.left, c.right);
    if (!is_needed(l, axes, &c, part)) continue;
    c.name = (pl_name){.text = condition_name(l, p->shown, part),
                       .ascii = condition_name(l, p->key, part),
                       .index = p->index};
    const pl_rule* rule = pl_scope_rule(l, pl_intern(l->names, c.name.ascii));
    c.lambda = rule ? rule->lambda : (pl_symbol){0};
    pl_push(l->arena, l->m->constraints, c);
    n++;
  }
  if (p->attitude.form == PL_AXES_VECTORS && n == 6) choose_right_hand(l, p, c.span);
}

void pl_space_body(pl_lower* l, const pl_ast* s, pl_site* p, pl_name name) {
  pl_spatial b = {.name = name,
                  .form = p->attitude.form,
                  .centre = p->point,
                  .block = l->block,
                  .span = pl_ast_span(s),
                  .inertia_span = pl_ast_span(pl_ast_kid(s, 2))};
  b.mass = pl_lower_scalar(l, pl_ast_kid(s, 1));
  if (!read_inertia(l, pl_ast_kid(s, 2), b.inertia) || pl_is_poison(b.mass)) return;
  if (p->point.n != 3) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E017, p->point.span, PL_BOTH("the centre of a body in space has three components"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write  at (x, y, z)"));
    return;
  }
  memcpy(b.axes, p->attitude.at, sizeof b.axes);
  memcpy(b.turn, p->attitude.turn, sizeof b.turn);
  pl_attitude_spin(l->pool, &p->attitude, b.spin);
  pl_load turning = {.kind = PL_L_KINETIC, .block = l->block, .span = b.span};
  turning.name.text = turning.name.ascii = pl_format(l->arena, "kinetic%d", l->m->loads.n + 1);
  turning.name.generated = true;
  turning.value = pl_attitude_energy(l->pool, &p->attitude, b.inertia);
  pl_push(l->arena, l->m->masses, (pl_mass){name, b.mass, p->point, l->block, b.span});
  pl_push(l->arena, l->m->loads, turning);
  pl_push(l->arena, l->m->spatials, b);
  push_conditions(l, s, p);
}

// ----------------------------------------------------------------------------------------- torques
pl_site* pl_space_of(pl_lower* l, const pl_ast* on) {
  const pl_ast* index;
  const pl_ast* name = pl_ast_label(on, &index);
  if (name == NULL || pl_scope_find(l, name->key)) return NULL;
  pl_site* p = pl_site_find(l, name->key);
  return p && p->kind == PL_SITE_BODY && p->statement && pl_ast_kid(p->statement, 5) ? p : NULL;
}

bool pl_space_torque(pl_lower* l, const pl_ast* s, pl_load* out) {
  const pl_ast* index;
  const pl_ast* name = pl_ast_label(pl_ast_kid(s, 2), &index);
  pl_point at;
  pl_site* body;
  pl_quantity v = pl_lower_quantity(l, pl_ast_kid(s, 1));
  if (!pl_lower_label_point(l, name, index, &at, &body) || pl_quantity_is_bad(&v)) return false;
  if (v.n != 3) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E017, pl_ast_span(pl_ast_kid(s, 1)),
        PL_BOTH("a torque on a body in space is a vector with three components"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write  torque (Mx, My, Mz) on %s"), body->shown);
    return false;
  }
  out->kind = PL_L_COUPLE;
  memcpy(out->vector, v.at, sizeof out->vector);
  pl_attitude_spin(l->pool, &body->attitude, out->spin);
  return true;
}
