// Physics: masses, bodies, forces, springs, constraints, choice of coordinates, start values.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

static pl_name name_of_place(const pl_site* p) {
  return (pl_name){.text = p->shown, .ascii = p->key, .index = p->index, .generated = p->generated};
}

static pl_site* place_of(pl_lower* l, const pl_ast* s) {
  for (int i = 0; i < l->places.n; i++) {
    if (l->places.at[i]->statement == s) return l->places.at[i];
  }
  return NULL;
}

static pl_name name_of_label(pl_lower* l, const pl_ast* label, const char* otherwise) {
  if (label == NULL) return (pl_name){.text = otherwise, .ascii = otherwise, .generated = true};
  const pl_ast *name = pl_ast_kid(label, 0), *index = pl_ast_kid(label, 1);
  return (pl_name){.text = name->shown,
                   .ascii = name->key,
                   .index = index ? pl_lower_scalar(l, index) : pl_poison()};
}

// -------------------------------------------------------------------------- masses, bodies, points
// `mass A m1 at` lacks its colon: the first factor is no name, the rest would do.
static bool missing_colon(pl_lower* l, const pl_ast* s, const pl_ast* value) {
  while (value->kind == PL_AST_SUM && value->ops.at[0] != '-') value = value->kids.at[0];
  if (pl_ast_kid(s, 0) || value->kind != PL_AST_PRODUCT || value->kids.n < 2
      || value->ops.at[1] != ' ')
    return false;
  const pl_ast* first = value->kids.at[0];
  if (first->kind != PL_AST_NAME || pl_scope_known(l, first) || pl_scope_lost(l, first->key))
    return false;
  pl_diagnostic* m = pl_lower_complain(l, PL_E001, pl_ast_span(first),
                                       PL_BOTH("a colon is missing after the label %s"),
                                       first->shown);
  pl_suggest(l->job, m, pl_format(l->arena, "%s:", first->shown), PL_BOTH("write %s:"),
             first->shown);
  pl_push(l->arena, l->lost, first->key);
  pl_push(l->arena, l->lost, pl_intern(l->names, pl_format(l->arena, "lambda_%s", first->key)));
  return true;
}

static void lower_mass(pl_lower* l, const pl_ast* s) {
  pl_site* p = place_of(l, s);
  if (p == NULL) return;
  if (missing_colon(l, s, pl_ast_kid(s, 1))) return;
  pl_expr mass = pl_lower_scalar(l, pl_ast_kid(s, 1));
  if (!pl_site_finish(l, p) || pl_is_poison(mass)) return;
  pl_push(l->arena, l->m->masses,
          (pl_mass){name_of_place(p), mass, p->point, l->block, pl_ast_span(s)});
}

static void lower_body(pl_lower* l, const pl_ast* s) {
  pl_site* p = place_of(l, s);
  if (p == NULL) return;
  if (pl_ast_kid(s, 5)) {
    if (pl_site_finish(l, p)) pl_space_body(l, s, p, name_of_place(p));
    return;
  }
  pl_body b = {.mass = pl_lower_scalar(l, pl_ast_kid(s, 1)),
               .inertia = pl_lower_scalar(l, pl_ast_kid(s, 2)),
               .block = l->block,
               .span = pl_ast_span(s)};
  if (!pl_site_finish(l, p) || pl_is_poison(b.mass) || pl_is_poison(b.inertia)) return;
  b.name = name_of_place(p);
  b.centre = p->point;
  b.angle = p->angle;
  pl_push(l->arena, l->m->bodies, b);
}

static void lower_point_statement(pl_lower* l, const pl_ast* s) {
  pl_site* p = place_of(l, s);
  if (p && pl_site_finish(l, p))
    pl_push(l->arena, l->m->points,
            (pl_place_def){name_of_place(p), p->point, l->block, pl_ast_span(s)});
}

// A uniform rod of mass M between A and B moves like M/6 at A, M/6 at B and 2 M/3 in the middle:
// T = M/6 (vA² + vA·vB + vB²), and its weight acts in the middle either way.
static void lower_rod(pl_lower* l, const pl_ast* s) {
  pl_point a, b;
  bool fine_a = pl_lower_where(l, pl_ast_kid(s, 2), &a, NULL),
       fine_b = pl_lower_where(l, pl_ast_kid(s, 3), &b, NULL);
  pl_expr mass = pl_lower_scalar(l, pl_ast_kid(s, 1));
  pl_name name = name_of_label(l, pl_ast_kid(s, 0),
                               pl_format(l->arena, "rod%d", l->m->masses.n + 1));
  if (!fine_a || !fine_b || pl_is_poison(mass)) return;
  if (a.n != b.n) {
    pl_lower_complain(l, PL_E017, pl_ast_span(s), PL_BOTH("the ends have %d and %d components"),
                      a.n, b.n);
    return;
  }
  pl_point middle = a;
  for (int i = 0; i < a.n; i++)
    middle.at[i] = pl_div(l->pool, pl_add(l->pool, a.at[i], b.at[i]), pl_int(l->pool, 2));
  const pl_point* at[3] = {&a, &middle, &b};
  static const char* const part[3] = {"start", "middle", "end"};
  for (int i = 0; i < 3; i++) {
    pl_name n = name;
    n.text = pl_format(l->arena, "%s.%s", name.text, part[i]);
    n.ascii = pl_format(l->arena, "%s_%s", name.ascii, part[i]);
    n.generated = true;
    pl_expr share = pl_mul(l->pool, mass,
                           i == 1 ? pl_ratio(l->pool, 2, 3) : pl_ratio(l->pool, 1, 6));
    pl_push(l->arena, l->m->masses, (pl_mass){n, share, *at[i], l->block, pl_ast_span(s)});
  }
}

static void lower_gravity(pl_lower* l, const pl_ast* s) {
  const pl_ast *way = pl_ast_kid(s, 1), *axis = pl_ast_kid(way, 0);
  pl_expr g = pl_lower_scalar(l, pl_ast_kid(s, 0));
  int i = pl_axis_find(l, axis->key);
  if (i < 0) {
    pl_text all = pl_text_make(l->arena);
    for (int k = 0; k < l->m->n_axes; k++)
      pl_text_addf(&all, "%s%s", k ? ", " : "", l->m->axes[k].name);
    pl_diagnostic* m = pl_lower_complain(l, PL_E029, pl_ast_span(axis),
                                         PL_BOTH("there is no axis %s"), axis->shown);
    if (l->m->n_axes)
      pl_suggest(l->job, m, NULL,
                 PL_BOTH("the axes are %s; others are declared by  axes x right, z up"),
                 pl_text_string(&all));
    else pl_suggest(l->job, m, NULL, PL_BOTH("declare  axes x right, %s up"), axis->shown);
    return;
  }
  if (!pl_is_poison(g))
    pl_push(l->arena, l->m->gravities, (pl_gravity){g, i, way->number, pl_ast_span(s)});
}

// ------------------------------------------------------------------------------------------- loads
static void push_load(pl_lower* l, pl_load load, const pl_ast* s, const char* kind) {
  load.name = name_of_label(l, s->kids.n > 1 ? pl_ast_kid(s, 0) : NULL,
                            pl_format(l->arena, "%s%d", kind, l->m->loads.n + 1));
  load.block = l->block;
  load.span = pl_ast_span(s);
  pl_push(l->arena, l->m->loads, load);
}

static void lower_force(pl_lower* l, const pl_ast* s) {
  pl_load load = {.kind = PL_L_FORCE};
  pl_quantity v = pl_lower_quantity(l, pl_ast_kid(s, 1));
  bool fine = pl_lower_where(l, pl_ast_kid(s, 2), &load.a, NULL);
  if (pl_quantity_is_bad(&v) || !fine) return;
  int n = v.n ? v.n : 1;
  if (n != load.a.n) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(pl_ast_kid(s, 1)),
                                         PL_BOTH("the force has %d components, its point has %d"),
                                         n, load.a.n);
    pl_suggest(l->job, m, NULL,
               PL_BOTH(load.a.n == 2   ? "write (Fx, Fy)"
                       : load.a.n == 3 ? "write (Fx, Fy, Fz)"
                                       : "write one component"));
    return;
  }
  memcpy(load.vector, v.at, sizeof load.vector);
  push_load(l, load, s, "force");
}

static bool torque_target(pl_lower* l, const pl_ast* on, pl_symbol* out) {
  const pl_ast* index;
  const pl_ast* name = pl_ast_label(on, &index);
  pl_expr angle = pl_poison();
  if (name && !pl_scope_find(l, name->key) && pl_site_find(l, name->key)) {
    pl_point at;
    pl_site* p;
    if (!pl_lower_label_point(l, name, index, &at, &p)) return false;
    if (p->kind != PL_SITE_BODY) {
      pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(on),
                                           PL_BOTH("a torque acts on a body or a coordinate"));
      pl_suggest(l->job, m, NULL, PL_BOTH("write  force (Fx, Fy) on %s"), p->shown);
      return false;
    }
    angle = p->angle;
  } else {
    angle = pl_lower_scalar(l, on);
    if (pl_is_poison(angle)) return false;
  }
  bool symbol = pl_kind_of(l->pool, angle) == PL_SYMBOL;
  *out = symbol ? pl_symbol_of(l->pool, angle) : (pl_symbol){0};
  if (symbol && pl_symbol_get(l->pool, *out)->role == PL_R_COORD) return true;
  if (!symbol && (pl_kind_of(l->pool, angle) == PL_AT || pl_has_role(l->pool, angle, PL_R_COORD))) {
    pl_lower_pending(
        l, PL_E091, "torque", pl_ast_span(on),
        PL_BOTH("a torque on anything but a coordinate is not computed by this version"));
    return false;
  }
  pl_lower_complain(l, PL_E017, pl_ast_span(on),
                    PL_BOTH("a torque acts on a body or a coordinate"));
  return false;
}

static void lower_torque(pl_lower* l, const pl_ast* s) {
  pl_load load = {.kind = PL_L_TORQUE};
  if (pl_space_of(l, pl_ast_kid(s, 2))) {
    if (pl_space_torque(l, s, &load)) push_load(l, load, s, "torque");
    return;
  }
  load.value = pl_lower_scalar(l, pl_ast_kid(s, 1));
  if (torque_target(l, pl_ast_kid(s, 2), &load.coordinate) && !pl_is_poison(load.value))
    push_load(l, load, s, "torque");
}

static void lower_function(pl_lower* l, const pl_ast* s, pl_load_kind kind, const char* word) {
  pl_load load = {.kind = kind, .value = pl_lower_scalar(l, pl_ast_kid(s, 1))};
  if (!pl_is_poison(load.value)) push_load(l, load, s, word);
}

static void lower_spring(pl_lower* l, const pl_ast* s) {
  const pl_ast* rest = pl_ast_kid(s, 2);
  pl_load load = {.kind = PL_L_SPRING,
                  .value = pl_lower_scalar(l, pl_ast_kid(s, 1)),
                  .rest = rest ? pl_lower_scalar(l, rest) : pl_int(l->pool, 0)};
  bool a = pl_lower_where(l, pl_ast_kid(s, 3), &load.a, NULL),
       b = pl_lower_where(l, pl_ast_kid(s, 4), &load.b, NULL);
  if (a && b && !pl_is_poison(load.value) && !pl_is_poison(load.rest))
    push_load(l, load, s, "spring");
}

static void lower_damper(pl_lower* l, const pl_ast* s) {
  pl_load load = {.kind = PL_L_DAMPER, .value = pl_lower_scalar(l, pl_ast_kid(s, 1))};
  bool a = pl_lower_where(l, pl_ast_kid(s, 2), &load.a, NULL),
       b = pl_lower_where(l, pl_ast_kid(s, 3), &load.b, NULL);
  if (a && b && !pl_is_poison(load.value)) push_load(l, load, s, "damper");
}

static void lower_drag(pl_lower* l, const pl_ast* s) {
  pl_load load = {.kind = PL_L_DRAG, .value = pl_lower_scalar(l, pl_ast_kid(s, 1))};
  if (pl_lower_where(l, pl_ast_kid(s, 2), &load.a, NULL) && !pl_is_poison(load.value))
    push_load(l, load, s, "drag");
}

// ------------------------------------------------------------------------------------- constraints
static bool check_relation(pl_lower* l, const pl_ast* r) {
  if (r->kids.n > 2) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(r),
                                         PL_BOTH("a constraint has one relation sign"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write one constraint for each"));
    return false;
  }
  char op = r->ops.at[1];
  if (op == '=' || op == 'g' || op == 'l') return true;
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(r),
                                       PL_BOTH("a constraint is written with =, >= or <="));
  if (op != '!') pl_suggest(l->job, m, NULL, PL_BOTH(op == '>' ? "write >=" : "write <="));
  return false;
}

static void lower_options(pl_lower* l, const pl_ast* list, pl_constraint* c) {
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast* o = list->kids.at[i];
    const pl_ast* value = pl_ast_kid(o, 0);
    if (strcmp(o->text, "with") == 0) c->multiplier = value->shown;
    if (strcmp(o->text, "while") == 0) c->while_label = pl_constraint_label(l, value);
    if (strcmp(o->text, "redundant") == 0) c->redundant_ok = true;
    if (strcmp(o->text, "off") == 0) c->off = true;
  }
}

static void lower_constraint(pl_lower* l, const pl_ast* s) {
  const pl_ast *label = pl_ast_kid(s, 0), *relation = pl_ast_kid(s, 1);
  int number = ++l->n_rules_lowered;
  pl_constraint c = {
      .block = l->block, .span = pl_ast_span(s), .relation_span = pl_ast_span(relation)};
  c.name = name_of_label(l, label, pl_format(l->arena, "%d", number));
  lower_options(l, pl_ast_kid(s, 2), &c);
  pl_condition r;
  if (missing_colon(l, s, relation->kids.at[0])) return;
  if (!check_relation(l, relation) || !pl_lower_relation(l, relation, &r, 0)) return;
  const pl_rule* rule = pl_scope_rule(
      l, label ? pl_ast_kid(label, 0)->key : pl_intern(l->names, c.name.ascii));
  c.left = r.left;
  c.right = r.right;
  c.relation = r.relation;
  c.g = pl_sub(l->pool, r.left, r.right);
  c.lambda = rule ? rule->lambda : (pl_symbol){0};
  c.has_velocity = pl_has_role(l->pool, c.g, PL_R_VELOCITY);
  pl_push(l->arena, l->m->constraints, c);
}

// --------------------------------------------------------------------------- coordinates to choose
static bool plain_coordinate(pl_lower* l, const pl_ast* node, pl_expr* out, int most_dots) {
  *out = pl_lower_scalar(l, node);
  if (pl_is_poison(*out)) return false;
  pl_kind kind = pl_kind_of(l->pool, *out);
  if (kind == PL_AT && pl_symbol_get(l->pool, pl_symbol_of(l->pool, *out))->role == PL_R_ARRAY)
    return pl_dots_of(l->pool, *out) <= most_dots;
  if (kind == PL_SYMBOL) {
    pl_role role = pl_symbol_get(l->pool, pl_symbol_of(l->pool, *out))->role;
    if (role == PL_R_COORD || (role == PL_R_VELOCITY && most_dots >= 1)) return true;
  }
  const char* text = pl_source_text(l->arena, pl_ast_span(node));
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E030, pl_ast_span(node),
      PL_BOTH(most_dots ? "%s is not a coordinate or velocity" : "%s is not a coordinate"), text);
  if (kind == PL_SYMBOL
      && pl_symbol_get(l->pool, pl_symbol_of(l->pool, *out))->role == PL_R_START) {
    const pl_ast* first = node->kind == PL_AST_PRODUCT ? node->kids.at[0] : node;
    const char* name = pl_source_text(l->arena, pl_ast_span(first));
    pl_suggest(l->job, m, name, PL_BOTH("write %s"), name);
  } else {
    pl_suggest(l->job, m, NULL, PL_BOTH("write  coordinate = value"));
  }
  return false;
}

static bool equation(pl_lower* l, const pl_ast* r) {
  if (r->kids.n == 2 && r->ops.at[1] == '=') return true;
  pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(r),
                                       PL_BOTH("an equation with one = is needed here"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write  name = value"));
  return false;
}

static void lower_choose(pl_lower* l, const pl_ast* s) {
  const pl_ast *names = pl_ast_kid(s, 0), *maps = pl_ast_kid(s, 1);
  pl_choose* c = &l->m->choose;
  if (c->span.source == NULL) c->span = pl_ast_span(s);
  for (int i = 0; i < names->kids.n; i++) {
    pl_expr q;
    l->choosing = true;
    bool fine = plain_coordinate(l, names->kids.at[i], &q, 0);
    l->choosing = false;
    if (!fine) continue;
    if (pl_kind_of(l->pool, q) == PL_SYMBOL) pl_push(l->arena, c->coords, pl_symbol_of(l->pool, q));
    else
      pl_lower_pending(l, PL_N091, "choose", pl_ast_span(names->kids.at[i]),
                       PL_BOTH("members of families are not chosen by this version"));
  }
  int n = maps ? maps->kids.n : 0;
  struct pl_map_equation* all = PL_ARRAY(l->arena, struct pl_map_equation, c->n_maps + n + 1);
  if (c->n_maps) memcpy(all, c->maps, (size_t)c->n_maps * sizeof *all);
  c->maps = all;
  for (int i = 0; i < n; i++) {
    const pl_ast* r = maps->kids.at[i];
    pl_expr old;
    if (!equation(l, r)) continue;
    bool fine = plain_coordinate(l, r->kids.at[0], &old, 0);
    pl_expr map = pl_lower_scalar(l, r->kids.at[1]);
    if (!fine || pl_is_poison(map)) continue;
    c->maps[c->n_maps].old = old;
    c->maps[c->n_maps].map = map;
    c->maps[c->n_maps++].span = pl_ast_span(r);
  }
}

static void lower_branch(pl_lower* l, const pl_ast* s) {
  const pl_ast* list = pl_ast_kid(s, 0);
  for (int i = 0; i < list->kids.n; i++) {
    for (int k = 0; k + 1 < list->kids.at[i]->kids.n; k++) {
      pl_condition c;
      if (pl_lower_relation(l, list->kids.at[i], &c, k)) pl_push(l->arena, l->m->branches, c);
    }
  }
}

// ------------------------------------------------------------------------------------------- start
void pl_lower_start(pl_lower* l, const pl_ast* s) {
  const pl_ast *time = pl_ast_kid(s, 0), *list = pl_ast_kid(s, 1);
  pl_expr at = time ? pl_lower_scalar(l, time) : pl_poison();
  for (int i = 0; i < list->kids.n; i++) {
    const pl_ast* r = list->kids.at[i];
    pl_init init = {
        .time = at, .guess = s->token == TOK_GUESS, .block = l->block, .span = pl_ast_span(r)};
    if (!equation(l, r)) continue;
    bool fine = plain_coordinate(l, r->kids.at[0], &init.target, 1);
    init.value = pl_lower_scalar(l, r->kids.at[1]);
    if (fine && !pl_is_poison(init.value)) pl_push(l->arena, l->m->inits, init);
  }
}

// ---------------------------------------------------------------------------------------- dispatch
void pl_lower_physics(pl_lower* l, const pl_ast* s) {
  l->mute += s->broken;
  bool results = l->results;
  l->results = false;
  switch (s->token) {
    case TOK_MASS: lower_mass(l, s); break;
    case TOK_BODY: lower_body(l, s); break;
    case TOK_POINT: lower_point_statement(l, s); break;
    case TOK_ROD: lower_rod(l, s); break;
    case TOK_GRAVITY: lower_gravity(l, s); break;
    case TOK_FORCE: lower_force(l, s); break;
    case TOK_TORQUE: lower_torque(l, s); break;
    case TOK_POTENTIAL: lower_function(l, s, PL_L_POTENTIAL, "potential"); break;
    case TOK_KINETIC: lower_function(l, s, PL_L_KINETIC, "kinetic"); break;
    case TOK_LAGRANGIAN: lower_function(l, s, PL_L_LAGRANGIAN, "lagrangian"); break;
    case TOK_RAYLEIGH: lower_function(l, s, PL_L_RAYLEIGH, "rayleigh"); break;
    case TOK_SPRING: lower_spring(l, s); break;
    case TOK_DAMPER: lower_damper(l, s); break;
    case TOK_DRAG: lower_drag(l, s); break;
    case TOK_CONSTRAINT: lower_constraint(l, s); break;
    case TOK_CHOOSE: lower_choose(l, s); break;
    case TOK_BRANCH: lower_branch(l, s); break;
    case TOK_FRICTION:
    case TOK_RESTITUTION: pl_lower_contact(l, s); break;
    default: break;
  }
  l->results = results;
  l->mute -= s->broken;
}
