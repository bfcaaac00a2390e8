// Names, labels, components, and what kind of quantity may stand where.
#include "model_impl.h"

#include <string.h>

// ------------------------------------------------------------------------------------------- theta
static bool contains(const char* s, const char* part) { return s && strstr(s, part) != NULL; }

// θ and ϑ print alike in ASCII: a model uses one of them.
static void check_theta(pl_job* job, pl_model* m) {
  pl_span at[2] = {{0}, {0}};
  const char* name[2] = {NULL, NULL};
  for (int pass = 0; pass < 2; pass++) {
    const char* letter = pass ? "ϑ" : "θ";
    for (int i = 0; i < m->params.n && !name[pass]; i++) {
      const char* s = pl_symbol_get(m->pool, m->params.at[i].symbol)->name;
      if (contains(s, letter)) {
        name[pass] = s;
        at[pass] = m->params.at[i].span;
      }
    }
    for (int i = 0; i < m->coords.n && !name[pass]; i++) {
      const char* s = pl_symbol_get(m->pool, m->coords.at[i].symbol)->name;
      if (contains(s, letter)) {
        name[pass] = s;
        at[pass] = m->coords.at[i].span;
      }
    }
    for (int i = 0; i < m->lets.n && !name[pass]; i++) {
      const char* s = m->lets.at[i].symbol.id ? pl_symbol_get(m->pool, m->lets.at[i].symbol)->name
                                              : NULL;
      if (contains(s, letter)) {
        name[pass] = s;
        at[pass] = m->lets.at[i].span;
      }
    }
  }
  if (!name[0] || !name[1]) return;
  pl_diagnostic* d = pl_tell(
      job, PL_E059, at[1],
      PL_BOTH_FORMAT(job->arena, "%s and %s: θ and ϑ in one model cannot be told apart in ASCII",
                     name[0], name[1]));
  pl_report_label(job->diagnostics, d, at[0], name[0]);
  pl_report_fix(d, PL_BOTH("write θ everywhere, or choose another letter"), NULL);
}

// ------------------------------------------------------------------------------------------ labels
// Places, constraints and loads, and events each have their own names: `force on A` and `force of
// A` differ.
typedef struct label_check {
  pl_job* job;
  pl_index_sets given;
  PL_VEC(pl_span) used;  // by owner
} label_check;

static void tell_label(label_check* c, const pl_name* name, const char* shown, pl_span span,
                       int first) {
  pl_span at = span, found;
  if (pl_span_find_name(span, name->ascii ? name->ascii : name->text, &found)) at = found;
  pl_diagnostic* d = pl_tell(c->job, PL_E034, at,
                             PL_BOTH_FORMAT(c->job->arena, "the label %s is used twice", shown));
  if (first == c->used.n - 1 && pl_is_poison(name->index)) {
    pl_report_fix(
        d, PL_BOTH_FORMAT(c->job->arena, "inside `for` give each its own: %s[i]", name->text),
        NULL);
    return;
  }
  if (first < c->used.n - 1 && c->used.at[first].source) {
    pl_report_label(c->job->diagnostics, d, c->used.at[first],
                    c->job->lang == PL_GERMAN ? pl_german("first here") : "first here");
  }
  pl_report_fix(d, PL_BOTH("choose another label"), NULL);
}

static void check_label(label_check* c, const pl_name* name, const pl_block* b, pl_span span) {
  if (!name->text || name->generated) return;
  pl_push(c->job->arena, c->used, span);
  bool has_index = !pl_is_poison(name->index);
  uint64_t key = pl_hash_bytes(name->text, strlen(name->text), has_index ? 7 : 3);
  long index;
  int first = pl_index_sets_add(&c->given, key, name->index, b, c->used.n - 1, &index);
  if (first < 0) return;
  tell_label(c, name, has_index ? PL_F(c->job, "%s[%ld]", name->text, index) : name->text, span,
             first);
}

static label_check label_space(pl_job* job, pl_model* m) {
  return (label_check){.job = job, .given = pl_index_sets_make(m, job->arena)};
}

static void check_labels(pl_job* job, pl_model* m) {
  label_check places = label_space(job, m);
  for (int i = 0; i < m->masses.n; i++)
    check_label(&places, &m->masses.at[i].name, m->masses.at[i].block, m->masses.at[i].span);
  for (int i = 0; i < m->bodies.n; i++)
    check_label(&places, &m->bodies.at[i].name, m->bodies.at[i].block, m->bodies.at[i].span);
  for (int i = 0; i < m->points.n; i++)
    check_label(&places, &m->points.at[i].name, m->points.at[i].block, m->points.at[i].span);
  label_check acts = label_space(job, m);
  for (int i = 0; i < m->constraints.n; i++) {
    check_label(&acts, &m->constraints.at[i].name, m->constraints.at[i].block,
                m->constraints.at[i].span);
  }
  for (int i = 0; i < m->loads.n; i++)
    check_label(&acts, &m->loads.at[i].name, m->loads.at[i].block, m->loads.at[i].span);
  label_check events = label_space(job, m);
  for (int i = 0; i < m->events.n; i++)
    check_label(&events, &m->events.at[i].name, NULL, m->events.at[i].span);
}

void pl_check_names(pl_job* job, pl_model* m) {
  check_theta(job, m);
  check_labels(job, m);
}

// -------------------------------------------------------------------------------------- components
static const char* axes_text(pl_job* job, const pl_model* m) {
  pl_text t = pl_text_make(job->arena);
  for (int i = 0; i < m->n_axes; i++)
    pl_text_addf(&t, "%s%s", i ? ", " : "", m->axes[i].name ? m->axes[i].name : "?");
  return pl_text_string(&t);
}

static void check_components(pl_job* job, const pl_model* m, int n, pl_span span, const char* en,
                             const char* de) {
  if (n == m->n_axes || n == 0) return;
  const char* parts = n == 1 ? PL_KEY("component") : PL_KEY("components");
  pl_diagnostic* d = pl_tell(
      job, PL_E035, span, PL_F(job, "%s has %d %s, but there are %d axes", en, n, parts, m->n_axes),
      PL_F(job, pl_german("%s has %d %s, but there are %d axes"), de, n, pl_german(parts),
           m->n_axes));
  pl_report_reason(d, PL_BOTH_FORMAT(job->arena, "axes: %s", axes_text(job, m)));
  pl_report_fix(
      d,
      PL_BOTH(n < m->n_axes
                  ? "write 0 for what is missing, or name the axes in use: axes x right, y up"
                  : "leave components out, or name all axes: axes x right, y up, z out"),
      NULL);
}

static void check_all_components(pl_job* job, pl_model* m) {
  for (int i = 0; i < m->masses.n; i++)
    check_components(job, m, m->masses.at[i].point.n, m->masses.at[i].span, PL_BOTH("this point"));
  for (int i = 0; i < m->bodies.n; i++)
    check_components(job, m, m->bodies.at[i].centre.n, m->bodies.at[i].span,
                     PL_BOTH("this centre"));
  for (int i = 0; i < m->points.n; i++)
    check_components(job, m, m->points.at[i].point.n, m->points.at[i].span, PL_BOTH("this point"));
  for (int i = 0; i < m->loads.n; i++) {
    const pl_load* x = &m->loads.at[i];
    bool at_points = x->kind == PL_L_FORCE || x->kind == PL_L_SPRING || x->kind == PL_L_DAMPER
                     || x->kind == PL_L_DRAG;
    if (!at_points) continue;
    check_components(job, m, x->a.n, x->span, PL_BOTH("the point of attack"));
    if (x->kind == PL_L_SPRING || x->kind == PL_L_DAMPER)
      check_components(job, m, x->b.n, x->span, PL_BOTH("the other end"));
    int n = 0;
    for (int k = 0; k < 3; k++) n += x->kind == PL_L_FORCE && !pl_is_poison(x->vector[k]);
    check_components(job, m, n, x->span, PL_BOTH("this force"));
  }
}

static void check_gravity(pl_job* job, pl_model* m) {
  for (int i = 0; i < m->gravities.n; i++) {
    const pl_gravity* g = &m->gravities.at[i];
    if (g->axis < 0 || g->axis >= m->n_axes) {
      pl_diagnostic* d = pl_tell(job, PL_E029, g->span,
                                 PL_BOTH("gravity acts along an axis that does not exist"));
      pl_report_reason(d, PL_BOTH_FORMAT(job->arena, "axes: %s", axes_text(job, m)));
      const char* last = m->n_axes ? m->axes[m->n_axes - 1].name : "y";
      pl_report_fix(d, PL_F(job, "gravity g along -%s", last),
                    PL_F(job, "gravity g along -%s", last), NULL);
    }
    if (pl_has_coordinate(m->pool, g->g, job->arena)) {
      pl_diagnostic* d = pl_tell(job, PL_E057, g->span,
                                 PL_BOTH("gravity cannot depend on the motion"));
      pl_report_fix(d, PL_BOTH("write it as a potential: potential -G M m/r"), NULL);
    }
    if (i == 1) {
      pl_diagnostic* d = pl_tell(job, PL_N066, g->span,
                                 PL_BOTH("gravity is given more than once: both act"));
      if (m->gravities.at[0].span.source)
        pl_report_label(job->diagnostics, d, m->gravities.at[0].span,
                        job->lang == PL_GERMAN ? pl_german("first here") : "first here");
    }
  }
}

// ---------------------------------------------------------------------------- what may stand where
// Values that have to be there and are poison come from a division by zero, unless the text had
// errors before.
static void check_value(pl_job* job, pl_expr e, pl_span span, const char* en, const char* de) {
  if (!pl_is_poison(e) || job->diagnostics->n_errors) return;
  pl_diagnostic* d = pl_tell(job, PL_E040, span, PL_F(job, "%s has no value", en),
                             PL_F(job, pl_german("%s has no value"), de));
  pl_report_reason(d, PL_BOTH("a division by zero?"));
  pl_report_fix(d, PL_BOTH("look for a denominator that is zero"), NULL);
}

static const char* kind_name(int dots, bool german) {
  const char* kind = dots == 2 ? PL_KEY("an acceleration") : PL_KEY("a velocity");
  return german ? pl_german(kind) : kind;
}

// At most `allowed` derivatives: 0 position, 1 velocity.
static void check_order(pl_job* job, pl_model* m, pl_expr e, int allowed, pl_span span,
                        const char* en, const char* de) {
  int dots = pl_max_dots(m->pool, e, job->arena);
  if (dots <= allowed) return;
  pl_diagnostic* d = pl_tell(
      job, PL_E057, span, PL_F(job, "%s cannot contain %s", en, kind_name(dots, false)),
      PL_F(job, pl_german("%s cannot contain %s"), de, kind_name(dots, true)));
  pl_report_fix(
      d,
      PL_BOTH(allowed ? "write it with positions and velocities" : "write it with positions only"),
      NULL);
}

static void check_no_multiplier(pl_job* job, pl_model* m, pl_expr e, pl_span span, const char* en,
                                const char* de) {
  if (pl_is_poison(e) || !pl_has_role(m->pool, e, PL_R_MULTIPLIER)) return;
  pl_diagnostic* d = pl_tell(job, PL_E057, span, PL_F(job, "%s cannot contain a multiplier", en),
                             PL_F(job, pl_german("%s cannot contain a multiplier"), de));
  pl_report_fix(d, PL_BOTH("multipliers may stand in `force`, `event`, `ask` and `plot`"), NULL);
}

static void check_point(pl_job* job, pl_model* m, const pl_point* p, pl_span span) {
  for (int k = 0; k < p->n && k < 3; k++) {
    check_value(job, p->at[k], span, PL_BOTH("a component of this point"));
    check_order(job, m, p->at[k], 0, span, PL_BOTH("a point"));
    check_no_multiplier(job, m, p->at[k], span, PL_BOTH("a point"));
  }
}

static void check_mass_expression(pl_job* job, pl_model* m, pl_expr e, pl_span span) {
  check_value(job, e, span, PL_BOTH("this mass"));
  if (pl_is_poison(e)) return;
  bool time = pl_has_symbol(m->pool, e, pl_time(m->pool));
  if (!time && !pl_has_coordinate(m->pool, e, job->arena)
      && !pl_has_role(m->pool, e, PL_R_MULTIPLIER))
    return;
  pl_diagnostic* d = pl_tell(
      job, PL_E056, span,
      PL_F(job, "a mass has to be constant, but this one depends on %s",
           time ? "time" : "the motion"),
      PL_F(job, pl_german("a mass has to be constant, but this one depends on %s"),
           time ? pl_german("time") : pl_german("the motion")));
  pl_report_fix(d, PL_BOTH("write the kinetic energy yourself: kinetic 1/2 M(x) x'^2"), NULL);
}

static void check_masses(pl_job* job, pl_model* m) {
  for (int i = 0; i < m->masses.n; i++) {
    check_mass_expression(job, m, m->masses.at[i].mass, m->masses.at[i].span);
    check_point(job, m, &m->masses.at[i].point, m->masses.at[i].span);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    const pl_body* b = &m->bodies.at[i];
    check_mass_expression(job, m, b->mass, b->span);
    check_mass_expression(job, m, b->inertia, b->span);
    check_point(job, m, &b->centre, b->span);
    check_value(job, b->angle, b->span, PL_BOTH("this angle"));
    check_order(job, m, b->angle, 0, b->span, PL_BOTH("the angle of a body"));
    if (m->n_axes > 2) {  // along one axis it turns about an axis across: a yo-yo
      pl_diagnostic* d = pl_tell(
          job, PL_E035, b->span,
          PL_BOTH_FORMAT(job->arena,
                         "a body with one angle lives in a plane, but there are %d axes",
                         m->n_axes));
      pl_report_fix(d, "axes x right, y up", "axes x right, y up", NULL);
    }
  }
  for (int i = 0; i < m->points.n; i++)
    check_point(job, m, &m->points.at[i].point, m->points.at[i].span);
}

static bool same_point(const pl_point* a, const pl_point* b) {
  if (a->n != b->n || a->n == 0) return false;
  for (int k = 0; k < a->n && k < 3; k++) {
    if (!pl_same(a->at[k], b->at[k])) return false;
  }
  return true;
}

static void check_load(pl_job* job, pl_model* m, const pl_load* x) {
  check_point(job, m, &x->a, x->span);
  check_point(job, m, &x->b, x->span);
  bool between = x->kind == PL_L_SPRING || x->kind == PL_L_DAMPER;
  if (between && same_point(&x->a, &x->b)) {
    pl_diagnostic* d = pl_tell(job, PL_E064, x->span, PL_BOTH("both ends are the same point"));
    pl_report_fix(d, PL_BOTH("name two different points"), NULL);
  }
  if (x->kind == PL_L_COUPLE) {
    for (int k = 0; k < 3; k++) {
      check_value(job, x->vector[k], x->span, PL_BOTH("this torque"));
      check_order(job, m, x->vector[k], 1, x->span, PL_BOTH("a torque"));
    }
    return;
  }
  if (x->kind == PL_L_FORCE) {
    for (int k = 0; k < x->a.n && k < 3; k++)
      check_order(job, m, x->vector[k], 1, x->span, PL_BOTH("a force"));
    return;
  }
  check_value(job, x->value, x->span, PL_BOTH("this expression"));
  switch (x->kind) {
    case PL_L_POTENTIAL: check_order(job, m, x->value, 1, x->span, PL_BOTH("a potential")); break;
    case PL_L_KINETIC:
      check_order(job, m, x->value, 1, x->span, PL_BOTH("a kinetic energy"));
      break;
    case PL_L_LAGRANGIAN: check_order(job, m, x->value, 1, x->span, PL_BOTH("a Lagrangian")); break;
    case PL_L_RAYLEIGH:
      check_order(job, m, x->value, 1, x->span, PL_BOTH("a dissipation function"));
      break;
    case PL_L_COUPLE: return;
    case PL_L_TORQUE:
      check_order(job, m, x->value, 1, x->span, PL_BOTH("a torque"));
      return;  // may hold multipliers
    default: check_order(job, m, x->value, 0, x->span, PL_BOTH("a coefficient")); break;
  }
  check_no_multiplier(job, m, x->value, x->span, PL_BOTH("this expression"));
}

// `lagrangian` says it all: masses and potentials beside it would be counted or forgotten.
static void check_lagrangian(pl_job* job, pl_model* m) {
  const pl_load* lagrangian = NULL;
  for (int i = 0; i < m->loads.n && !lagrangian; i++) {
    if (m->loads.at[i].kind == PL_L_LAGRANGIAN) lagrangian = &m->loads.at[i];
  }
  if (!lagrangian) return;
  pl_span other = {0};
  bool any = m->masses.n || m->bodies.n || m->gravities.n;
  if (m->masses.n) other = m->masses.at[0].span;
  else if (m->bodies.n) other = m->bodies.at[0].span;
  else if (m->gravities.n) other = m->gravities.at[0].span;
  for (int i = 0; i < m->loads.n && !any; i++) {
    pl_load_kind k = m->loads.at[i].kind;
    if (k == PL_L_POTENTIAL || k == PL_L_KINETIC || k == PL_L_SPRING) {
      any = true;
      other = m->loads.at[i].span;
    }
  }
  if (!any) return;
  pl_diagnostic* d = pl_tell(
      job, PL_E054, lagrangian->span,
      PL_BOTH("lagrangian stands instead of masses, gravity and potentials"));
  if (other.source)
    pl_report_label(job->diagnostics, d, other,
                    job->lang == PL_GERMAN ? pl_german("this too?") : "this too?");
  pl_report_fix(
      d, PL_BOTH("write kinetic and potential instead of lagrangian, or remove the others"), NULL);
}

static void check_two_gravity_users(pl_job* job, pl_model* m) {
  if (!m->gravities.n || m->masses.n || m->bodies.n) return;
  for (int i = 0; i < m->loads.n; i++) {
    if (m->loads.at[i].kind == PL_L_LAGRANGIAN) return;  // told there
  }
  if (m->pending.n) return;  // the mass may be in a statement this version does not know
  pl_diagnostic* d = pl_tell(job, PL_N064, m->gravities.at[0].span,
                             PL_BOTH("gravity has no effect: there is no mass"));
  pl_report_fix(d, PL_BOTH("add a mass, or write its potential: potential m g y"), NULL);
}

static void check_moving(pl_job* job, pl_model* m) {
  if (m->coords.n || job->diagnostics->n_errors) return;
  bool physics = m->masses.n || m->bodies.n || m->loads.n || m->constraints.n || m->simulate.given
                 || m->asks.n;
  pl_span at = m->masses.n         ? m->masses.at[0].span
               : m->constraints.n  ? m->constraints.at[0].span
               : m->simulate.given ? m->simulate.span
               : m->asks.n         ? m->asks.at[0].span
                                   : (pl_span){0};
  pl_diagnostic* d = pl_tell(
      job, PL_E053, at,
      PL_BOTH(physics ? "nothing moves: the model has no coordinate" : "the model is empty"));
  pl_report_fix(d, "coord x, y", "coord x, y", NULL);
}

// ------------------------------------------------------------------------------------- constraints
static void check_velocity_constraint(pl_job* job, pl_model* m, pl_constraint* c) {
  const char* name = c->name.text ? c->name.text : "?";
  const char* text = NULL;
  pl_diagnostic* d;
  switch (pl_velocity_kind_of(job, m, c->g, &text)) {
    case PL_NO_VELOCITY: return;
    case PL_ACCELERATION:
      d = pl_tell(job, PL_E057, c->span,
                  PL_BOTH_FORMAT(job->arena, "constraint %s cannot contain an acceleration", name));
      pl_report_fix(d, PL_BOTH("write it for positions or velocities"), NULL);
      return;
    case PL_NOT_LINEAR:
      d = pl_tell(
          job, PL_E039, c->span,
          PL_BOTH_FORMAT(job->arena, "constraint %s is not linear in the velocities", name));
      pl_report_reason(d, PL_BOTH("such a constraint has no agreed law for its force"));
      pl_report_fix(d, PL_BOTH("write it linear, as in x' = R φ'"), NULL);
      return;
    case PL_INTEGRABLE:
      d = pl_tell(
          job, PL_N092, c->span,
          PL_BOTH_FORMAT(job->arena,
                         "constraint %s can be integrated: it restricts positions too, up to a "
                         "constant of the start",
                         name));
      if (text)
        pl_report_fix(
            d, PL_BOTH_FORMAT(job->arena, "as a constraint of positions: %s = constant", text),
            NULL);
      break;
    case PL_NONHOLONOMIC:
      d = pl_tell(
          job, PL_N092, c->span,
          PL_BOTH_FORMAT(job->arena,
                         "constraint %s cannot be integrated: it is nonholonomic and restricts "
                         "velocities only",
                         name));
      break;
  }
  c->has_velocity = true;
  if (c->relation == PL_EQ) return;
  d = pl_tell(
      job, PL_E057, c->span,
      PL_BOTH_FORMAT(job->arena, "constraint %s is one-sided and cannot contain velocities", name));
  pl_report_fix(d, PL_BOTH("write it for positions, or with ="), NULL);
}

// Always true, or never: a constraint that does not speak of the motion.
static void check_constraint(pl_job* job, pl_model* m, pl_constraint* c) {
  const char* name = c->name.text ? c->name.text : "?";
  check_value(job, c->g, c->span, PL_BOTH("this constraint"));
  if (pl_is_poison(c->g)) return;
  check_no_multiplier(job, m, c->g, c->span, PL_BOTH("a constraint"));
  check_velocity_constraint(job, m, c);
  if (pl_is_zero_node(m->pool, c->g)) {
    pl_diagnostic* d = pl_tell(
        job, PL_N053, c->span,
        PL_BOTH_FORMAT(job->arena, "constraint %s is always true: both sides are the same", name));
    pl_report_fix(d, PL_BOTH("remove it"), NULL);
    return;
  }
  if (pl_has_coordinate(m->pool, c->g, job->arena) || pl_has_role(m->pool, c->g, PL_R_MULTIPLIER))
    return;
  pl_diagnostic* d = pl_tell(
      job, PL_E051, c->span,
      PL_BOTH_FORMAT(job->arena, "constraint %s speaks of no coordinate", name));
  pl_report_reason(d, PL_BOTH("so it says nothing about the motion"));
  pl_report_fix(d, PL_BOTH("a relation between given quantities is written with let or assume"),
                NULL);
}

static const pl_constraint* contact(const pl_model* m, const char* label) {
  return pl_model_constraint(m, label);
}

static void check_while(pl_job* job, pl_model* m, const pl_constraint* c) {
  if (!c->while_label) return;
  const pl_constraint* other = contact(m, c->while_label);
  // a missing label is told where names are read
  if (!other || (other->relation != PL_EQ && other != c)) return;
  pl_diagnostic* d = pl_tell(
      job, PL_E063, c->span,
      PL_BOTH_FORMAT(job->arena, "`while %s` needs a contact, but %s cannot end", c->while_label,
                     c->while_label));
  pl_report_fix(d, PL_BOTH("name a one-sided constraint (>= or <=)"), NULL);
}

void pl_check_structure(pl_job* job, pl_model* m) {
  check_moving(job, m);
  check_all_components(job, m);
  check_gravity(job, m);
  check_masses(job, m);
  for (int i = 0; i < m->loads.n; i++) check_load(job, m, &m->loads.at[i]);
  check_lagrangian(job, m);
  check_two_gravity_users(job, m);
  for (int i = 0; i < m->constraints.n; i++) {
    check_constraint(job, m, &m->constraints.at[i]);
    check_while(job, m, &m->constraints.at[i]);
  }
}
