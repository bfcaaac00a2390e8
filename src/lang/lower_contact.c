// Coefficients of contacts: `restitution e on label`, `friction μ, static μs, surface v, at P on
// label`.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

// The label of the constraint that a coefficient is for; a family without index stands for all its
// members.
static const char* constraint_of(pl_lower* l, const pl_ast* node) {
  const pl_ast* index;
  const pl_ast* name = pl_ast_label(node, &index);
  if (name == NULL) {
    pl_lower_complain(l, PL_E017, pl_ast_span(node),
                      PL_BOTH("the label of a constraint is needed here"));
    return NULL;
  }
  const pl_rule* rule = pl_scope_rule(l, name->key);
  if (rule == NULL && pl_site_find(l, name->key)) {
    pl_diagnostic* m = pl_lower_complain(
        l, PL_E017, pl_ast_span(node), PL_BOTH("%s is no constraint, but contacts are constraints"),
        name->shown);
    pl_suggest(l->job, m, NULL,
               PL_BOTH("write the label of the constraint that keeps %s on its surface"),
               name->shown);
    return NULL;
  }
  if (rule == NULL) {
    pl_scope_unknown_label(l, name, PL_BOTH("constraint"), NULL, 0);
    return NULL;
  }
  if (!rule->family && index) {
    pl_lower_complain(l, PL_E025, pl_ast_span(node),
                      PL_BOTH("%s is not a family, so it takes no index"), rule->shown);
    return NULL;
  }
  return pl_label_text(l, name, index);
}

static void lower_restitution(pl_lower* l, const pl_ast* s) {
  pl_restitution r = {.block = l->block, .span = pl_ast_span(s)};
  r.value = pl_lower_scalar(l, pl_ast_kid(s, 0));
  r.label = constraint_of(l, pl_ast_kid(s, 1));
  if (r.label && !pl_is_poison(r.value)) pl_push(l->arena, l->m->restitutions, r);
}

// The velocity of a surface: a vector, or one number along the only axis.
static bool lower_surface(pl_lower* l, const pl_ast* node, pl_point* out) {
  pl_quantity v = pl_lower_quantity(l, node);
  if (pl_quantity_is_bad(&v)) return false;
  out->n = v.n ? v.n : 1;
  out->span = pl_ast_span(node);
  memcpy(out->at, v.at, sizeof out->at);
  if (out->n == l->m->n_axes) return true;
  pl_diagnostic* m = pl_lower_complain(
      l, PL_E035, out->span,
      PL_BOTH("the velocity of the surface has %d components, there are %d axes"), out->n,
      l->m->n_axes);
  pl_suggest(
      l->job, m, NULL,
      PL_BOTH(l->m->n_axes == 2 ? "write  surface (vx, vy)" : "write  surface (vx, vy, vz)"));
  return false;
}

static void lower_friction(pl_lower* l, const pl_ast* s) {
  pl_friction f = {.block = l->block, .span = pl_ast_span(s)};
  f.kinetic = pl_lower_scalar(l, pl_ast_kid(s, 0));
  const pl_ast* options = pl_ast_kid(s, 1);
  bool fine = !pl_is_poison(f.kinetic);
  for (int i = 0; i < options->kids.n; i++) {
    const pl_ast *o = options->kids.at[i], *value = pl_ast_kid(o, 0);
    if (strcmp(o->text, "static") == 0) {
      f.sticking = pl_lower_scalar(l, value);
      fine &= !pl_is_poison(f.sticking);
    }
    if (strcmp(o->text, "surface") == 0) fine &= lower_surface(l, value, &f.surface);
    if (strcmp(o->text, "at") == 0) fine &= pl_lower_where(l, value, &f.at, NULL);
  }
  f.label = constraint_of(l, pl_ast_kid(s, 2));
  if (fine && f.label) pl_push(l->arena, l->m->frictions, f);
}

void pl_lower_contact(pl_lower* l, const pl_ast* s) {
  if (s->token == TOK_FRICTION) lower_friction(l, s);
  else lower_restitution(l, s);
}
