// Axes: those of the line `axes`, those that points ask for, and how a point is written.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

int pl_axis_find(const pl_lower* l, const char* key) {
  for (int i = 0; i < l->m->n_axes; i++) {
    if (strcmp(l->m->axes[i].ascii, key) == 0) return i;
  }
  return -1;
}

// How many components a point has, as far as the text shows.
int pl_ast_components(const pl_ast* point) {
  const pl_ast* one = pl_ast_single(point);
  if (one && one->kind == PL_AST_GROUP) return one->kids.n;
  if (point->kind == PL_AST_PRODUCT && point->kids.n == 2
      && point->kids.at[0]->kind == PL_AST_NAME) {
    return strcmp(point->kids.at[0]->key, "spherical") == 0 ? 3
           : strcmp(point->kids.at[0]->key, "polar") == 0   ? 2
                                                            : 0;
  }
  return 0;
}

static int most_components(const pl_ast* node) {
  int most = 0;
  for (int i = 0; i < node->kids.n; i++) {
    const pl_ast* s = node->kids.at[i];
    if (s == NULL || s->kind != PL_AST_STATEMENT) continue;
    int n = 0;
    if (s->token == TOK_FOR) n = most_components(pl_ast_kid(s, 2));
    if (s->token == TOK_MASS) n = pl_ast_components(pl_ast_kid(s, 2));
    if (s->token == TOK_POINT) n = pl_ast_components(pl_ast_kid(s, 1));
    if (s->token == TOK_BODY) n = pl_ast_components(pl_ast_kid(s, 3));
    if (n > most) most = n;
  }
  return most;
}

// A point is (x, y, z) in whatever order `axes` names them: "axes x right, z up, y out" says where
// they point. Axes of other names are in the order of the line.
static void axes_in_order(pl_model* m) {
  for (int i = 0; i < m->n_axes; i++) {
    if (strlen(m->axes[i].ascii) != 1 || !strchr("xyz", m->axes[i].ascii[0])) return;
  }
  for (int i = 1; i < m->n_axes; i++) {
    for (int k = i; k > 0 && m->axes[k].ascii[0] < m->axes[k - 1].ascii[0]; k--) {
      pl_axis other = m->axes[k];
      m->axes[k] = m->axes[k - 1];
      m->axes[k - 1] = other;
    }
  }
}

// Points of three components under two axes x, y, z: the one that is left is there too.
static void third_axis(pl_lower* l, const pl_ast* file) {
  static const char* const names[] = {"x", "y", "z"};
  static const char* const ways[] = {"out", "up", "right"};
  if (l->m->n_axes != 2 || most_components(file) != 3) return;
  pl_axis third = {.direction = NULL};
  for (int i = 0; i < 3; i++) {
    if (pl_axis_find(l, names[i]) < 0)
      third.name = third.ascii = third.name ? third.name : names[i];
    bool free_way = true;
    for (int k = 0; k < 2; k++)
      free_way &= !l->m->axes[k].direction || strcmp(l->m->axes[k].direction, ways[i]) != 0;
    if (free_way && !third.direction) third.direction = ways[i];
  }
  for (int k = 0; k < 2; k++)
    if (strlen(l->m->axes[k].ascii) != 1 || !strchr("xyz", l->m->axes[k].ascii[0])) return;
  l->m->axes[l->m->n_axes++] = third;
  axes_in_order(l->m);
}

// Of a text with broken lines three axes were taken; its whole lines may need fewer.
void pl_axes_trim(pl_lower* l, const pl_ast* file) {
  if (l->lost.n == 0 || l->m->n_axes != 3 || l->m->axes[0].declared) return;
  int n = most_components(file);
  for (int i = 0; i < l->m->gravities.n; i++) {
    if (l->m->gravities.at[i].axis >= n) n = l->m->gravities.at[i].axis + 1;
  }
  if (n > 0 && n < 3) l->m->n_axes = n;
}

// Without `axes`: as many as the points have components, x right, y up, z out.
void pl_axes_settle(pl_lower* l, const pl_ast* file) {
  static const pl_axis usual[3] = {
      {"x", "x", "right", false}, {"y", "y", "up", false}, {"z", "z", "out", false}};
  axes_in_order(l->m);
  third_axis(l, file);
  if (l->m->n_axes) return;
  // where a broken line may have told, no axis is missed
  int n = l->lost.n ? 3 : most_components(file);
  l->m->n_axes = n > 3 ? 3 : n;
  for (int i = 0; i < l->m->n_axes; i++) l->m->axes[i] = usual[i];
}
