// answer_open: requests about constraints that do not hold where the motion begins.
#include <string.h>

#include "worked/sets_impl.h"

static bool asks_lambda(const pl_analysis* d, pl_expr e, const pl_open* o) {
  return !pl_is_poison(e) && o->source->lambda.id && pl_same(e, pl_sym(d->pool, o->source->lambda));
}

// A request for the force of an open constraint, or for the place where that vanishes.
bool pl_is_about_open(const pl_analysis* d, const pl_ask* ask, const pl_open* o) {
  const pl_name* name = &o->source->name;
  if (ask->kind == PL_ASK_EXPECT) return false;  // decided with λ = 0
  if (ask->kind == PL_ASK_FORCE_OF && ask->label)
    return strcmp(name->text, ask->label) == 0
           || (name->ascii && strcmp(name->ascii, ask->label) == 0);
  if (asks_lambda(d, ask->value, o)) return true;
  for (int k = 0; k < ask->where.n; k++) {
    if (asks_lambda(d, ask->where.at[k].left, o) || asks_lambda(d, ask->where.at[k].right, o))
      return true;
  }
  return false;
}

static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

static void say_open(pl_analysis* d, const pl_open* o) {
  const pl_form *label = pl_fn(d, o->source->name.text),
                *none = pl_feq(d, pl_fs(d, o->source->lambda), zero_form(d));
  if (pl_would_pull(d, o)) {
    pl_say(
        d,
        PL_BOTH("At this start the force of {1} would have to pull: it lets go at once, and {2}."),
        2, label, none);
  } else if (o->contact && !o->released) {
    pl_say(d, PL_BOTH("{1} is open here, {2}: it exerts no force, {3}."), 3, label,
           pl_form_apart(d, o->source), none);
  } else {
    pl_say(d, PL_BOTH("{1} does not hold here: it exerts no force, {2}."), 2, label, none);
  }
}

static const char* german_force(pl_analysis* d, const pl_open* o) {
  return pl_format(d->arena, pl_german("Constraint force of %s"), o->source->name.text);
}

// A name that only a map explains, whose constraint does not hold.
bool pl_speaks_of_unnamed(pl_analysis* d, const pl_ask* ask, pl_symbol* which) {
  for (int k = 0; k < d->unnamed.n; k++) {
    pl_symbol q = d->unnamed.at[k], v = pl_symbol_dot(d->pool, q),
              name[3] = {q, v, pl_symbol_dot(d->pool, v)};
    for (int j = 0; j < 3; j++) {
      bool here = !pl_is_poison(ask->value) && pl_has_symbol(d->pool, ask->value, name[j]);
      for (int c = 0; c < ask->where.n; c++) {
        here |= pl_has_symbol(d->pool, ask->where.at[c].left, name[j])
                || pl_has_symbol(d->pool, ask->where.at[c].right, name[j]);
      }
      if (!here) continue;
      *which = q;
      return true;
    }
  }
  return false;
}

bool pl_answer_open(pl_analysis* d, const pl_ask* ask) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (!pl_is_about_open(d, ask, o)) continue;
    bool force = ask->kind == PL_ASK_FORCE_OF;
    bool told = d->page->open_told;
    d->page->open_told = true;  // said here in other words
    pl_section_open(d, ask,
                    force ? pl_format(d->arena, "Force of %s", o->source->name.text) : ask->text,
                    force ? german_force(d, o) : ask->text);
    d->page->open_told = told;
    say_open(d, o);
    if (ask->where.n > 0 || !o->source->lambda.id) return true;
    pl_answer(d, pl_symbol_get(d->pool, o->source->lambda)->ascii, pl_int(d->pool, 0), zero_form(d))
        ->of = o->source->name.text;
    return true;
  }
  pl_symbol s;
  if (!pl_speaks_of_unnamed(d, ask, &s)) return false;
  pl_section_open(d, ask, ask->text, ask->text);
  pl_say(
      d,
      PL_BOTH(
          "{1} names the place only while the constraints of its map hold, and here they do not."),
      1, pl_fs(d, s));
  d->page->section->not_found = true;
  return true;
}

const pl_ask* pl_without_open(pl_analysis* d, const pl_ask* ask) {
  if (d->open.n == 0) return ask;
  pl_ask* out = PL_NEW(d->arena, pl_ask);
  *out = *ask;
  out->value = pl_open_removed(d, ask->value);
  out->where.at = PL_ARRAY(d->arena, pl_condition, ask->where.n + 1);
  for (int k = 0; k < ask->where.n; k++) {
    out->where.at[k] = ask->where.at[k];
    out->where.at[k].left = pl_open_removed(d, ask->where.at[k].left);
    out->where.at[k].right = pl_open_removed(d, ask->where.at[k].right);
  }
  return out;
}
