// What the picture shows: `animate` names the arrows and trails, `draw` adds a line between two
// places, shows or hides.
#include "lang/lower_impl.h"

#include <string.h>

#include "grammar.h"

// Things with a name of their own; anything else is the label of a mass, a point or a constraint.
static const char* const things[] = {"weight",   "trail", "force",  "force on",
                                     "velocity", "axes",  "angles", "count"};

static bool is_thing(const char* word) {
  for (size_t i = 0; i < sizeof things / sizeof *things; i++) {
    if (strcmp(things[i], word) == 0) return true;
  }
  return false;
}

static bool is_label(pl_lower* l, const pl_ast* thing) {
  return pl_site_find(l, thing->key) != NULL || pl_scope_rule(l, thing->key) != NULL;
}

static void complain(pl_lower* l, const pl_ast* thing, const char* en, const char* de,
                     const char* fix_en, const char* fix_de) {
  pl_diagnostic* m = pl_lower_complain(l, PL_E001, pl_ast_span(thing), en, de, thing->text);
  pl_suggest(l->job, m, NULL, fix_en, fix_de);
}

// The label behind `of` must be there.
static void look_up(pl_lower* l, const pl_ast* thing, const pl_ast* of) {
  pl_point at;
  if (strcmp(thing->text, "count") == 0) pl_lower_scalar(l, of);
  else if (strcmp(thing->text, "force") == 0) pl_constraint_label(l, of);
  else pl_lower_label_point(l, pl_ast_kid(of, 0), pl_ast_kid(of, 1), &at, NULL);
}

static void lower_thing(pl_lower* l, const pl_ast* thing, pl_draw_kind kind) {
  const pl_ast* of = pl_ast_kid(thing, 0);
  bool known = is_thing(thing->text);
  if (!known && (kind == PL_DRAW_ANIMATE || of || !is_label(l, thing))) {
    if (kind == PL_DRAW_ANIMATE)
      complain(l, thing, PL_BOTH("%s cannot be animated"),
               PL_BOTH("write  force of LABEL, weight, trail of LABEL, count N"));
    else
      complain(l, thing, PL_BOTH("there is no %s in the picture"),
               PL_BOTH("axes, angles, weight, trail, velocity, force of LABEL, or a label"));
    return;
  }
  if (of) look_up(l, thing, of);
  pl_drawn d = {.kind = kind,
                .what = known ? thing->text : "",
                .of = of && strcmp(thing->text, "count") != 0
                          ? pl_label_text(l, pl_ast_kid(of, 0), pl_ast_kid(of, 1))
                      : known ? NULL
                              : thing->shown,
                .span = pl_ast_span(thing)};
  pl_push(l->arena, l->m->draws, d);
}

static void lower_line(pl_lower* l, const pl_ast* s, const pl_ast* word) {
  static const char* const kinds[] = {"line", "rod", "rope", "spring", "damper"};
  pl_drawn d = {.kind = PL_DRAW_LINE, .what = NULL, .span = pl_ast_span(s)};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    if (strcmp(kinds[i], word->text) == 0) d.what = kinds[i];
  }
  if (!d.what) {
    complain(l, word, PL_BOTH("%s cannot be drawn between two places"),
             PL_BOTH("line, rod, rope, spring or damper"));
    return;
  }
  bool a = pl_lower_where(l, pl_ast_kid(s, 2), &d.a, NULL),
       b = pl_lower_where(l, pl_ast_kid(s, 3), &d.b, NULL);
  if (a && b) pl_push(l->arena, l->m->draws, d);
}

void pl_lower_draw(pl_lower* l, const pl_ast* s) {
  bool animate = s->token == TOK_ANIMATE;
  const pl_ast *word = pl_ast_kid(s, 0), *list = animate ? word : pl_ast_kid(s, 1);
  if (!list) {
    lower_line(l, s, word);
    return;
  }
  bool show = !animate && strcmp(word->text, "show") == 0,
       hide = !animate && strcmp(word->text, "hide") == 0;
  if (!animate && !show && !hide) {
    complain(l, word, PL_BOTH("draw %s is not understood"),
             PL_BOTH("write  draw hide THINGS, draw show THINGS or draw line between A and B"));
    return;
  }
  for (int i = 0; i < list->kids.n; i++)
    lower_thing(l, list->kids.at[i],
                animate ? PL_DRAW_ANIMATE
                : show  ? PL_DRAW_SHOW
                        : PL_DRAW_HIDE);
}
