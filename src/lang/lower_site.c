// Places: points, attitudes, and the labels of masses, bodies and points.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

// ------------------------------------------------------------------------------------------ labels
// The name in an expression that is nothing but a label, such as A or P[i-1]; NULL otherwise.
const pl_ast* pl_ast_label(const pl_ast* node, const pl_ast** index) {
  const pl_ast* one = pl_ast_single(node);
  *index = NULL;
  if (one && one->kind == PL_AST_NUMBER) return NULL;
  if (one && one->kind == PL_AST_LABEL) {
    *index = pl_ast_kid(one, 1);
    return pl_ast_kid(one, 0);
  }
  if (one && one->kind == PL_AST_INDEXED) {
    *index = pl_ast_kid(one, 1);
    one = pl_ast_kid(one, 0);
  }
  return one && one->kind == PL_AST_NAME && one->number == 0 ? one : NULL;
}

// The text of a label: "g1", "c[3]", "c[i]".
const char* pl_label_text(pl_lower* l, const pl_ast* name, const pl_ast* index) {
  if (index == NULL) return name->shown;
  pl_expr i = pl_lower_scalar(l, index);
  if (pl_is_poison(i)) return NULL;
  // a parameter such as N has its number when the file is read
  double* values = pl_model_values(l->m, l->arena);
  double v = pl_eval(l->pool, i, values);
  if (v > -1e15 && v < 1e15 && v == (double)(long)v)
    return pl_format(l->arena, "%s[%ld]", name->shown, (long)v);
  return pl_format(l->arena, "%s[%s]", name->shown, pl_expr_text(l->arena, l->pool, i));
}

const char* pl_constraint_label(pl_lower* l, const pl_ast* label) {
  const pl_ast *name = pl_ast_kid(label, 0), *index = pl_ast_kid(label, 1);
  const pl_rule* r = pl_scope_rule(l, name->key);
  if (r == NULL) {
    const char** known = PL_ARRAY(l->arena, const char*, l->rules.n + 1);
    int n = 0;
    for (int i = 0; i < l->rules.n; i++) {
      bool twice = n > 0 && strcmp(known[n - 1], l->rules.at[i].shown) == 0;
      if (!l->rules.at[i].generated && !twice) known[n++] = l->rules.at[i].shown;
    }
    pl_scope_unknown_label(l, name, PL_BOTH("constraint"), known, n);
    return NULL;
  }
  if (r->family && index == NULL) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E025, pl_ast_span(label),
        PL_BOTH("%s is a family of constraints, so it needs an index"), r->shown);
    pl_suggest(l->job, m, pl_format(l->arena, "%s[1]", r->shown), PL_BOTH("write %s[1]"), r->shown);
    return NULL;
  }
  if (!r->family && index) {
    pl_lower_complain(l, PL_E025, pl_ast_span(label),
                      PL_BOTH("%s is not a family, so it takes no index"), r->shown);
    return NULL;
  }
  return pl_label_text(l, name, index);
}

// --------------------------------------------------------------------------------------- declaring
pl_site* pl_site_find(const pl_lower* l, const char* key) {
  for (int i = 0; i < l->places.n; i++) {
    if (l->places.at[i]->key == key) return l->places.at[i];
  }
  return NULL;
}

// A mass without label bears the name of its mass: m1; a second m1 becomes m1_2.
static void generate_label(pl_lower* l, pl_site* p, const pl_ast* mass) {
  const pl_ast* one = pl_ast_single(mass);
  bool simple = one && one->kind == PL_AST_NAME && one->number == 0;
  const char* key = simple ? one->key
                           : pl_intern(l->names, pl_format(l->arena, "mass%d", l->places.n + 1));
  const char* shown = simple ? one->shown : key;
  p->generated = true;
  p->key = key;
  p->shown = shown;
  for (int k = 2; pl_site_find(l, p->key); k++) {
    p->key = pl_intern(l->names, pl_format(l->arena, "%s_%d", key, k));
    p->shown = pl_format(l->arena, "%s_%d", shown, k);
  }
}

void pl_site_declare(pl_lower* l, const pl_ast* s) {
  const pl_ast* label = pl_ast_kid(s, 0);
  pl_site* p = PL_NEW(l->arena, pl_site);
  p->kind = s->token == TOK_MASS   ? PL_SITE_MASS
            : s->token == TOK_BODY ? PL_SITE_BODY
                                   : PL_SITE_POINT;
  p->statement = s;
  p->block = l->block;
  p->n_locals = l->locals.n;
  p->locals = PL_ARRAY(l->arena, pl_local, l->locals.n + 1);
  if (l->locals.n) memcpy(p->locals, l->locals.at, (size_t)l->locals.n * sizeof(pl_local));
  if (label) {
    p->key = pl_ast_kid(label, 0)->key;
    p->shown = pl_ast_kid(label, 0)->shown;
    p->index_node = pl_ast_kid(label, 1);
  } else {
    generate_label(l, p, pl_ast_kid(s, 1));
  }
  if (s->broken) p->state = 3;
  pl_push(l->arena, l->places, p);
}

// ------------------------------------------------------------------------------------------ points
bool pl_lower_point(pl_lower* l, const pl_ast* node, pl_point* out) {
  pl_quantity q = pl_lower_quantity(l, node);
  out->span = pl_ast_span(node);
  if (pl_quantity_is_bad(&q)) return false;
  const pl_ast* one = pl_ast_single(node);
  if (q.n == 0 && !(one && one->kind == PL_AST_GROUP)) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(node),
                                         PL_BOTH("a point is needed here, this is a number"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write (x, y)"));
    return false;
  }
  out->n = q.n ? q.n : 1;
  memcpy(out->at, q.at, sizeof out->at);
  return true;
}

// -------------------------------------------------------------------------- attitudes of bodies
// The brackets of name(...), NULL when the node is no such call.
static const pl_ast* call_of(const pl_ast* node, const char* name, int n) {
  if (node && node->kind == PL_AST_SUM) node = node->kids.n == 1 ? node->kids.at[0] : NULL;
  if (node == NULL || node->kind != PL_AST_PRODUCT || node->kids.n != 2) return NULL;
  const pl_ast *word = node->kids.at[0], *group = node->kids.at[1];
  bool named = word->kind == PL_AST_NAME && word->number == 0 && strcmp(word->key, name) == 0;
  return named && group->kind == PL_AST_GROUP && (n == 0 || group->kids.n == n) ? group : NULL;
}

// The form that the text shows; PL_AXES_NONE when it is none of the three.
pl_axes_form pl_attitude_form(const pl_ast* axes) {
  if (axes == NULL) return PL_AXES_NONE;
  if (axes->kids.n == 3) return PL_AXES_VECTORS;
  if (axes->kids.n != 1) return PL_AXES_NONE;
  if (call_of(axes->kids.at[0], "euler", 3)) return PL_AXES_EULER;
  return call_of(axes->kids.at[0], "quaternion", 4) ? PL_AXES_QUATERNION : PL_AXES_NONE;
}

static void complain_form(pl_lower* l, const pl_ast* axes) {
  const pl_ast* one = axes->kids.n == 1 ? axes->kids.at[0] : NULL;
  bool euler = one && call_of(one, "euler", 0), quaternion = one && call_of(one, "quaternion", 0);
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E017, pl_ast_span(axes),
      PL_BOTH(euler        ? "euler takes three angles: precession, nutation, spin"
              : quaternion ? "a quaternion has four components"
                           : "the axes of a body are euler(φ, ϑ, ψ), quaternion(q0, q1, q2, q3) or "
                             "three vectors"));
  pl_suggest(l->job, m, NULL, PL_BOTH("write  axes %s"),
             euler        ? "euler(φ, ϑ, ψ)"
             : quaternion ? "quaternion(q0, q1, q2, q3)"
                          : "euler(φ, ϑ, ψ)");
}

static bool read_vectors(pl_lower* l, const pl_ast* axes, pl_expr at[9]) {
  for (int j = 0; j < 3; j++) {
    pl_point e;
    if (!pl_lower_point(l, axes->kids.at[j], &e)) return false;
    if (e.n != 3) {
      pl_diagnostic* m = pl_lower_complain(
          l, PL_E017, e.span,
          PL_BOTH("an axis of a body in space has three components, this has %d"), e.n);
      pl_suggest(l->job, m, NULL, PL_BOTH("write  (ex, ey, ez)"));
      return false;
    }
    for (int i = 0; i < 3; i++) at[3 * j + i] = e.at[i];
  }
  return true;
}

// Reads what stands after `axes`.
static bool read_attitude(pl_lower* l, const pl_ast* axes, pl_attitude* out) {
  *out = (pl_attitude){.form = pl_attitude_form(axes)};
  if (out->form == PL_AXES_NONE) {
    complain_form(l, axes);
    return false;
  }
  bool fine = true;
  if (out->form == PL_AXES_VECTORS) {
    fine = read_vectors(l, axes, out->at);
  } else {
    const char* word = out->form == PL_AXES_EULER ? "euler" : "quaternion";
    const pl_ast* group = call_of(axes->kids.at[0], word, 0);
    for (int i = 0; i < group->kids.n; i++) {
      out->at[i] = pl_lower_scalar(l, group->kids.at[i]);
      fine &= !pl_is_poison(out->at[i]);
    }
  }
  if (fine) pl_attitude_turn(l->pool, out);
  return fine;
}

// ------------------------------------------------------------------------------------------ places
// A point fixed in a body in space: centre + turn (a, b, c).
static bool point_on_body_in_space(pl_lower* l, pl_site* p, const pl_site* body,
                                   const pl_point* centre, const pl_point* local) {
  pl_pool* q = l->pool;
  if (local->n != 3) {
    pl_lower_complain(l, PL_E017, local->span,
                      PL_BOTH("a point on a body in space has three components"));
    return false;
  }
  p->point.n = 3;
  for (int i = 0; i < 3; i++) {
    p->point.at[i] = centre->at[i];
    for (int j = 0; j < 3; j++)
      p->point.at[i] = pl_add(q, p->point.at[i],
                              pl_mul(q, body->attitude.turn[3 * i + j], local->at[j]));
  }
  p->point.span = pl_ast_span(pl_ast_kid(p->statement, 1));
  return true;
}

// A point fixed in a planar body: centre + turn(angle) (a, b).
static bool point_on_body(pl_lower* l, pl_site* p, const pl_ast* on) {
  pl_site* body = NULL;
  pl_point centre, local;
  if (!pl_lower_where(l, on, &centre, &body)
      || !pl_lower_point(l, pl_ast_kid(p->statement, 1), &local))
    return false;
  if (body == NULL || body->kind != PL_SITE_BODY) {
    pl_diagnostic* m = pl_lower_complain(l, PL_E017, pl_ast_span(on),
                                         PL_BOTH("a point can be fixed on a body only"));
    pl_suggest(l->job, m, NULL, PL_BOTH("write  point P at (x, y)  for a point in space"));
    return false;
  }
  if (body->in_space) return point_on_body_in_space(l, p, body, &centre, &local);
  if (local.n != 2 || centre.n != 2) {
    pl_lower_complain(l, PL_E017, local.span,
                      PL_BOTH("a point on a planar body has two components"));
    return false;
  }
  pl_pool* q = l->pool;
  pl_expr c = pl_call(q, PL_COS, body->angle), s = pl_call(q, PL_SIN, body->angle);
  p->point.n = 2;
  p->point.at[0] = pl_add(q, centre.at[0],
                          pl_sub(q, pl_mul(q, local.at[0], c), pl_mul(q, local.at[1], s)));
  p->point.at[1] = pl_add(q, centre.at[1],
                          pl_add(q, pl_mul(q, local.at[0], s), pl_mul(q, local.at[1], c)));
  p->point.span = pl_ast_span(pl_ast_kid(p->statement, 1));
  return true;
}

static bool lower_place(pl_lower* l, pl_site* p) {
  const pl_ast* s = p->statement;
  if (p->index_node) p->index = pl_lower_scalar(l, p->index_node);
  if (p->index_node && pl_is_poison(p->index)) return false;
  if (p->kind == PL_SITE_MASS) return pl_lower_point(l, pl_ast_kid(s, 2), &p->point);
  if (p->kind == PL_SITE_BODY) {
    bool fine = pl_lower_point(l, pl_ast_kid(s, 3), &p->point);
    const pl_ast* angle = pl_ast_kid(s, 4);
    p->angle = angle ? pl_lower_scalar(l, angle) : pl_poison();
    p->in_space = pl_ast_kid(s, 5) != NULL;
    if (p->in_space) fine &= read_attitude(l, pl_ast_kid(s, 5), &p->attitude);
    return fine && (angle == NULL || !pl_is_poison(p->angle));
  }
  const pl_ast* on = pl_ast_kid(s, 2);
  return on ? point_on_body(l, p, on) : pl_lower_point(l, pl_ast_kid(s, 1), &p->point);
}

bool pl_site_finish(pl_lower* l, pl_site* p) {
  if (p->state == 2) return true;
  if (p->state == 3) {
    l->wrong++;
    return false;
  }
  enum { MAX_DEPTH = 300 };
  if (p->state == 1 || l->call_depth > MAX_DEPTH) {
    pl_lower_complain(
        l, PL_E018,
        pl_ast_span(pl_ast_kid(p->statement, 0) ? pl_ast_kid(p->statement, 0) : p->statement),
        PL_BOTH("the place of %s leads back to itself"), p->shown);
    p->state = 3;
    return false;
  }
  p->state = 1;
  pl_local* locals = l->locals.at;
  int n = l->locals.n, cap = l->locals.cap;
  pl_block* block = l->block;
  bool results = l->results;
  l->locals.at = p->locals;
  l->locals.n = p->n_locals;
  l->locals.cap = p->n_locals;
  l->block = p->block;
  l->results = false;
  l->call_depth++;
  bool fine = lower_place(l, p);
  l->call_depth--;
  l->locals.at = locals;
  l->locals.n = n;
  l->locals.cap = cap;
  l->block = block;
  l->results = results;
  p->state = fine && p->state != 3 ? 2 : 3;
  return p->state == 2;
}

// -------------------------------------------------------------------------------------- references
static pl_point substitute(pl_lower* l, const pl_point* at, pl_symbol from, pl_expr to) {
  pl_point out = *at;
  for (int i = 0; i < at->n; i++) out.at[i] = pl_subst1(l->pool, at->at[i], from, to);
  return out;
}

// Member `index` of the family that p declares: P[i] or P[i + 1] with i the index of its block.
static bool member(pl_lower* l, const pl_site* p, pl_expr index, pl_point* out, pl_expr* angle,
                   pl_attitude* attitude) {
  if (p->block == NULL) {
    *out = p->point;
    *angle = p->angle;
    return pl_same(p->index, index);
  }
  pl_symbol i = p->block->index;
  pl_expr shift = pl_sub(l->pool, p->index, pl_sym(l->pool, i));
  if (pl_has_symbol(l->pool, shift, i)) return false;
  pl_expr value = pl_sub(l->pool, index, shift);
  *out = substitute(l, &p->point, i, value);
  *angle = pl_is_poison(p->angle) ? p->angle : pl_subst1(l->pool, p->angle, i, value);
  for (int k = 0; p->in_space && k < 9; k++) {
    attitude->turn[k] = pl_subst1(l->pool, p->attitude.turn[k], i, value);
    attitude->at[k] = pl_subst1(l->pool, p->attitude.at[k], i, value);
  }
  return true;
}

static bool family_point(pl_lower* l, const pl_ast* name, pl_expr index, pl_point* out,
                         pl_site** place) {
  bool found = false;
  for (int pass = 0; pass < 2 && !found; pass++) {  // a member of its own comes before the family
    for (int k = 0; k < l->places.n && !found; k++) {
      pl_site* p = l->places.at[k];
      if (p->key != name->key || (p->block == NULL) != (pass == 0)) continue;
      if (!pl_site_finish(l, p)) return false;
      if (pl_is_poison(p->index)) continue;
      pl_site* copy = PL_NEW(l->arena, pl_site);
      *copy = *p;
      if (!member(l, p, index, out, &copy->angle, &copy->attitude)) continue;
      if (place) *place = copy;
      found = true;
    }
  }
  return found;
}

static void unknown_place(pl_lower* l, const pl_ast* name) {
  const char** known = PL_ARRAY(l->arena, const char*, l->places.n + 1);
  int n = 0;
  for (int i = 0; i < l->places.n; i++) {
    if (n == 0 || strcmp(known[n - 1], l->places.at[i]->shown) != 0)
      known[n++] = l->places.at[i]->shown;
  }
  pl_scope_unknown_label(l, name, PL_BOTH("mass, body or point"), known, n);
}

bool pl_lower_label_point(pl_lower* l, const pl_ast* name, const pl_ast* index, pl_point* out,
                          pl_site** place) {
  pl_site* p = pl_site_find(l, name->key);
  if (p == NULL) {
    unknown_place(l, name);
    return false;
  }
  bool family = p->index_node != NULL || !pl_is_poison(p->index);
  if (family != (index != NULL)) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E025, pl_ast_span(name),
        PL_BOTH(family ? "%s is a family, so it needs an index"
                       : "%s is not a family, so it takes no index"),
        p->shown);
    if (family)
      pl_suggest(l->job, m, pl_format(l->arena, "%s[1]", p->shown), PL_BOTH("write %s[1]"),
                 p->shown);
    return false;
  }
  if (!family) {
    if (!pl_site_finish(l, p)) return false;
    *out = p->point;
    if (place) *place = p;
    return true;
  }
  pl_expr i = pl_lower_scalar(l, index);
  if (pl_is_poison(i)) return false;
  int wrong = l->wrong;
  if (family_point(l, name, i, out, place)) return true;
  if (l->wrong == wrong) {
    pl_lower_complain(l, PL_E025, pl_span_join(pl_ast_span(name), pl_ast_span(index)),
                      PL_BOTH("this member of %s cannot be told from the text"), p->shown);
  }
  return false;
}

// Where something acts: a label, or a point.
bool pl_lower_where(pl_lower* l, const pl_ast* node, pl_point* out, pl_site** place) {
  if (place) *place = NULL;
  const pl_ast* index;
  const pl_ast* name = pl_ast_label(node, &index);
  if (name == NULL) return pl_lower_point(l, node, out);
  if (pl_site_find(l, name->key) == NULL) {
    pl_entity* e = pl_scope_find(l, name->key);
    // an abbreviation of a point, or a number: that is said
    if (e) return pl_lower_point(l, node, out);
  }
  if (!pl_lower_label_point(l, name, index, out, place)) return false;
  out->span = pl_ast_span(node);
  return true;
}
