// The checked model as text, statement by statement: golden file, bug report and teaching material
// at once.
#include "model_impl.h"

#include <math.h>

typedef struct dumper {
  pl_text* out;
  const pl_model* m;
} dumper;

static const char* text(const dumper* d, pl_expr e) {
  return pl_is_poison(e) ? "-" : pl_expr_text(d->out->arena, d->m->pool, e);
}

static const char* const relation_signs[] = {"=", ">=", "<=", ">", "<", "!="};
static const char* const sign_words[] = {"", "  > 0", "  >= 0", "  < 0", "  <= 0", "  != 0"};
static const char* const class_words[] = {"number",   "mass",         "gravity",   "length",
                                          "other",    "time",         "function",  "coord",
                                          "velocity", "acceleration", "multiplier"};

static void unit(const dumper* d, pl_symbol s) {
  const pl_symbol_info* info = pl_symbol_get(d->m->pool, s);
  if (info->dimension_known)
    pl_text_addf(d->out, "  [%s]",
                 pl_unit_of_symbol(d->out->arena, d->m->pool, s, info->dimension, true));
}

static void label(const dumper* d, const pl_name* n) {
  if (!n->text) return;
  pl_text_addf(d->out, "%s%s", n->generated ? "(" : "", n->text);
  if (!pl_is_poison(n->index)) pl_text_addf(d->out, "[%s]", text(d, n->index));
  pl_text_add(d->out, n->generated ? ")" : "");
}

static void block(const dumper* d, const pl_block* b) {
  for (; b; b = b->outer) {
    pl_text_addf(d->out, "  for %s in %s..%s", pl_symbol_get(d->m->pool, b->index)->ascii,
                 text(d, b->lo), text(d, b->hi));
    if (!pl_is_poison(b->step)) pl_text_addf(d->out, " step %s", text(d, b->step));
  }
}

static void point(const dumper* d, const pl_point* p) {
  pl_text_add(d->out, "(");
  for (int i = 0; i < p->n && i < 3; i++)
    pl_text_addf(d->out, "%s%s", i ? ", " : "", text(d, p->at[i]));
  pl_text_add(d->out, ")");
}

static void end_line(const dumper* d, const pl_block* b) {
  block(d, b);
  pl_text_add(d->out, "\n");
}

static void dump_names(const dumper* d) {
  const pl_model* m = d->m;
  for (int i = 0; i < m->params.n; i++) {
    if (m->params.at[i].literal) continue;
    const pl_symbol_info* info = pl_symbol_get(m->pool, m->params.at[i].symbol);
    pl_text_addf(d->out, "param %s", info->ascii);
    if (!pl_is_poison(m->params.at[i].value))
      pl_text_addf(d->out, " = %s", text(d, m->params.at[i].value));
    unit(d, m->params.at[i].symbol);
    pl_text_addf(d->out, "  %s%s\n", class_words[info->class], sign_words[info->sign]);
  }
  for (int i = 0; i < m->lets.n; i++) {
    if (!m->lets.at[i].symbol.id) continue;
    pl_text_addf(d->out, "let %s = %s", pl_symbol_get(m->pool, m->lets.at[i].symbol)->ascii,
                 text(d, m->lets.at[i].value));
    unit(d, m->lets.at[i].symbol);
    pl_text_add(d->out, m->lets.at[i].inserted ? "  inserted\n" : "\n");
  }
  for (int i = 0; i < m->coords.n; i++) {
    const pl_coord* c = &m->coords.at[i];
    pl_text_addf(d->out, "coord %s", pl_symbol_get(m->pool, c->symbol)->ascii);
    if (!pl_is_poison(c->lo)) pl_text_addf(d->out, "[%s..%s]", text(d, c->lo), text(d, c->hi));
    unit(d, c->symbol);
    pl_text_add(d->out, "\n");
  }
  for (int i = 0; i < m->n_axes; i++) {
    pl_text_addf(d->out, "%s%s%s%s", i ? ", " : "axes ", m->axes[i].name,
                 m->axes[i].direction ? " " : "", m->axes[i].direction ? m->axes[i].direction : "");
  }
  if (m->n_axes) pl_text_add(d->out, "\n");
}

static void condition(const dumper* d, const char* word, const pl_condition* c) {
  pl_text_addf(d->out, "%s %s %s %s\n", word, text(d, c->left), relation_signs[c->relation],
               text(d, c->right));
}

static void dump_assumptions(const dumper* d) {
  for (int i = 0; i < d->m->assumptions.n; i++) {
    const pl_assumption* a = &d->m->assumptions.at[i];
    if (a->kind == PL_A_RELATION) condition(d, "assume", &a->condition);
    else if (a->kind == PL_A_IN)
      pl_text_addf(d->out, "assume %s in %s..%s\n", text(d, a->subject), text(d, a->lo),
                   text(d, a->hi));
    else pl_text_addf(d->out, "assume %s integer\n", text(d, a->subject));
  }
}

static void dump_masses(const dumper* d) {
  const pl_model* m = d->m;
  for (int i = 0; i < m->masses.n; i++) {
    const pl_mass* x = &m->masses.at[i];
    pl_text_add(d->out, "mass ");
    label(d, &x->name);
    pl_text_addf(d->out, ": %s at ", text(d, x->mass));
    point(d, &x->point);
    end_line(d, x->block);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    const pl_body* x = &m->bodies.at[i];
    pl_text_add(d->out, "body ");
    label(d, &x->name);
    pl_text_addf(d->out, ": mass %s, inertia %s at ", text(d, x->mass), text(d, x->inertia));
    point(d, &x->centre);
    pl_text_addf(d->out, " angle %s", text(d, x->angle));
    end_line(d, x->block);
  }
  for (int i = 0; i < m->points.n; i++) {
    pl_text_add(d->out, "point ");
    label(d, &m->points.at[i].name);
    pl_text_add(d->out, " at ");
    point(d, &m->points.at[i].point);
    end_line(d, m->points.at[i].block);
  }
  for (int i = 0; i < m->gravities.n; i++) {
    const pl_gravity* g = &m->gravities.at[i];
    const char* axis = g->axis >= 0 && g->axis < m->n_axes ? m->axes[g->axis].name : "?";
    pl_text_addf(d->out, "gravity %s along %s%s\n", text(d, g->g), g->sign < 0 ? "-" : "", axis);
  }
}

static void dump_load(const dumper* d, const pl_load* x) {
  static const char* const words[] = {"force",    "torque", "potential", "kinetic", "lagrangian",
                                      "rayleigh", "spring", "damper",    "drag",    "torque"};
  pl_text_addf(d->out, "%s ", words[x->kind]);
  label(d, &x->name);
  pl_text_add(d->out, ": ");
  if (x->kind == PL_L_FORCE || x->kind == PL_L_COUPLE) {
    pl_point vector = {
        x->kind == PL_L_COUPLE ? 3 : x->a.n, {x->vector[0], x->vector[1], x->vector[2]}, {0}};
    point(d, &vector);
  } else {
    pl_text_add(d->out, text(d, x->value));
  }
  if (x->kind == PL_L_SPRING) pl_text_addf(d->out, ", rest %s", text(d, x->rest));
  if (x->coordinate.id)
    pl_text_addf(d->out, " on %s", pl_symbol_get(d->m->pool, x->coordinate)->ascii);
  if (x->a.n) {
    pl_text_add(d->out, x->b.n ? " between " : " on ");
    point(d, &x->a);
  }
  if (x->b.n) {
    pl_text_add(d->out, " and ");
    point(d, &x->b);
  }
  end_line(d, x->block);
}

static void dump_constraints(const dumper* d) {
  const pl_model* m = d->m;
  for (int i = 0; i < m->constraints.n; i++) {
    const pl_constraint* c = &m->constraints.at[i];
    pl_text_add(d->out, "constraint ");
    label(d, &c->name);
    pl_text_addf(d->out, ": %s %s %s", text(d, c->left), relation_signs[c->relation],
                 text(d, c->right));
    if (c->lambda.id) {
      pl_text_addf(d->out, "  with %s", pl_symbol_get(m->pool, c->lambda)->ascii);
      unit(d, c->lambda);
    }
    if (c->while_label) pl_text_addf(d->out, " while %s", c->while_label);
    if (c->redundant_ok) pl_text_add(d->out, ", redundant ok");
    if (c->off) pl_text_add(d->out, ", off");
    end_line(d, c->block);
  }
  for (int i = 0; i < m->choose.coords.n; i++) {
    pl_text_addf(d->out, "%s%s", i ? ", " : "choose ",
                 pl_symbol_get(m->pool, m->choose.coords.at[i])->ascii);
  }
  for (int i = 0; i < m->choose.n_maps; i++) {
    pl_text_addf(d->out, "%s%s = %s", i ? ", " : " with ", text(d, m->choose.maps[i].old),
                 text(d, m->choose.maps[i].map));
  }
  if (m->choose.coords.n) pl_text_add(d->out, "\n");
  for (int i = 0; i < m->branches.n; i++) condition(d, "branch", &m->branches.at[i]);
}

static void dump_start(const dumper* d) {
  const pl_model* m = d->m;
  for (int i = 0; i < m->inits.n; i++) {
    const pl_init* x = &m->inits.at[i];
    pl_text_add(d->out, x->guess ? "guess" : "init");
    if (!pl_is_poison(x->time)) pl_text_addf(d->out, " at %s", text(d, x->time));
    pl_text_addf(d->out, " %s = %s", text(d, x->target), text(d, x->value));
    end_line(d, x->block);
  }
  static const char* const actions[] = {"stop", "record", "release", "attach", "set"};
  for (int i = 0; i < m->events.n; i++) {
    const pl_event* e = &m->events.at[i];
    pl_text_add(d->out, "event ");
    label(d, &e->name);
    pl_text_addf(d->out, ": when %s = 0%s ->", text(d, e->value),
                 e->direction > 0   ? " rising"
                 : e->direction < 0 ? " falling"
                                    : "");
    for (int k = 0; k < e->actions.n; k++) {
      const pl_action* a = &e->actions.at[k];
      pl_text_addf(d->out, "%s ", k ? "," : "");
      if (a->kind == PL_DO_SET)
        pl_text_addf(d->out, "%s = %s", text(d, a->target), text(d, a->value));
      else
        pl_text_addf(d->out, "%s%s%s", actions[a->kind], a->label ? " " : "",
                     a->label ? a->label : "");
    }
    pl_text_add(d->out, "\n");
  }
}

static void dump_requests(const dumper* d) {
  const pl_model* m = d->m;
  for (int i = 0; i < m->asks.n; i++) {
    const pl_ask* a = &m->asks.at[i];
    pl_text_addf(d->out, "ask %s%s%s\n", a->letter ? a->letter : "", a->letter ? ": " : "",
                 a->text ? a->text : text(d, a->value));
  }
  for (int i = 0; i < m->outputs.n; i++)
    pl_text_addf(d->out, "output %s = %s\n", m->outputs.at[i].name,
                 text(d, m->outputs.at[i].value));
  const pl_simulate* s = &m->simulate;
  if (s->given) {
    pl_text_addf(d->out, "simulate %s..%s", text(d, s->from), text(d, s->to));
    if (!pl_is_poison(s->step)) pl_text_addf(d->out, " step %s", text(d, s->step));
    if (s->count) pl_text_addf(d->out, " count %ld", s->count);
    if (!pl_is_poison(s->tol)) pl_text_addf(d->out, " tol %s", text(d, s->tol));
    pl_text_add(d->out, "\n");
  }
  for (int i = 0; i < m->plots.n; i++) {
    pl_text_add(d->out, "plot ");
    for (int k = 0; k < m->plots.at[i].y.n; k++)
      pl_text_addf(d->out, "%s%s", k ? ", " : "", text(d, m->plots.at[i].y.at[k]));
    pl_text_addf(d->out, " vs %s\n", text(d, m->plots.at[i].x));
  }
  static const char* const draws[] = {"animate", "draw show", "draw hide", "draw"};
  for (int i = 0; i < m->draws.n; i++) {
    const pl_drawn* x = &m->draws.at[i];
    pl_text_addf(d->out, "%s %s%s%s\n", draws[x->kind], x->what, x->of ? " of " : "",
                 x->of ? x->of : "");
  }
  for (int i = 0; i < m->pending.n; i++)
    pl_text_addf(d->out, "not computed: %s\n", m->pending.at[i].what);
}

static void dump_contacts(dumper* d) {
  const pl_model* m = d->m;
  for (int i = 0; i < m->restitutions.n; i++)
    pl_text_addf(d->out, "restitution %s on %s\n", text(d, m->restitutions.at[i].value),
                 m->restitutions.at[i].label);
  for (int i = 0; i < m->frictions.n; i++) {
    const pl_friction* f = &m->frictions.at[i];
    pl_text_addf(d->out, "friction %s", text(d, f->kinetic));
    if (!pl_is_poison(f->sticking)) pl_text_addf(d->out, ", static %s", text(d, f->sticking));
    for (int k = 0; k < f->surface.n; k++)
      pl_text_addf(d->out, "%s%s", k ? ", " : ", surface (", text(d, f->surface.at[k]));
    for (int k = 0; k < f->at.n; k++)
      pl_text_addf(d->out, "%s%s",
                   k              ? ", "
                   : f->surface.n ? "), at ("
                                  : ", at (",
                   text(d, f->at.at[k]));
    pl_text_addf(d->out, "%s on %s\n", f->surface.n || f->at.n ? ")" : "", f->label);
  }
}

void pl_model_dump(pl_text* out, const pl_model* m) {
  dumper d = {out, m};
  if (m->title) pl_text_addf(out, "system \"%s\"\n", m->title);
  pl_text_addf(out, "units %s\n", m->uses_units ? "checked" : "none");
  if (m->lambda_minus) pl_text_add(out, "convention lambda-minus\n");
  dump_names(&d);
  dump_assumptions(&d);
  dump_masses(&d);
  for (int i = 0; i < m->loads.n; i++) dump_load(&d, &m->loads.at[i]);
  dump_constraints(&d);
  dump_contacts(&d);
  dump_start(&d);
  dump_requests(&d);
}
