// answer_dof: degrees of freedom, constraints, and what was dropped with its reason.
#include <string.h>

#include "worked/worked_impl.h"

static const char* label_of(const pl_bond* l) { return l->source->name.text; }

// Friction that sticks holds like a constraint, but is none that was written: it stands behind the
// others.
static int count_written(const pl_analysis* d) {
  int n = d->g.n;
  while (n > 0 && d->g.at[n - 1].source->sticking) n--;
  return n;
}

static const pl_form* zero_form(pl_analysis* d) {
  return pl_form_leaf(d->arena, pl_int(d->pool, 0));
}

// "g1 = x1 + x2 - l = 0", "h = r - R ≥ 0"
static const pl_form* constraint_form(pl_analysis* d, const pl_constraint* c) {
  const char* op = c->relation == PL_GE ? "≥" : c->relation == PL_LE ? "≤" : "=";
  const pl_form* body = pl_frel(d, pl_difference_form(d, c->left, c->right), op, zero_form(d));
  return pl_feq(d, pl_fn(d, c->name.text), body);
}

static const pl_form* link_form(pl_analysis* d, const pl_bond* l) {
  return constraint_form(d, l->source);
}

static bool told(pl_analysis* d, const char* what) {
  const char* key = pl_format(d->arena, "told %s", what);
  uint64_t hash = pl_hash_bytes(key, strlen(key), 1);
  if (pl_map_get(d->page->told, hash)) return true;
  pl_map_set(d->page->told, hash, 1);
  return false;
}

// Abbreviations of given quantities that occur in e: "l = L - π R".
static void row_of_lets(pl_analysis* d, pl_expr e) {
  for (int k = 0; k < d->model->lets.n; k++) {
    const pl_let* let = &d->model->lets.at[k];
    if (let->inserted || !pl_has_symbol(d->pool, e, let->symbol)) continue;
    if (told(d, pl_symbol_get(d->pool, let->symbol)->ascii)) continue;
    pl_row(d, "", "", pl_feq(d, pl_fs(d, let->symbol), pl_fe(d, let->value)), NULL);
  }
}

static int count_coordinates(const pl_analysis* d) {
  int n = 0;
  for (int i = 0; i < d->q.n; i++) n += d->q.at[i].carries;
  return n;
}

static void row_of_coordinates(pl_analysis* d) {
  const pl_form** names = PL_ARRAY(d->arena, const pl_form*, d->q.n);
  int n = 0;
  for (int i = 0; i < d->q.n; i++) {
    if (d->q.at[i].carries) names[n++] = pl_fs(d, d->q.at[i].q);
  }
  pl_row(d, PL_BOTH("coordinates"), pl_flist(d, names, n), pl_format(d->arena, "%d", n));
}

static void rows_of_constraints(pl_analysis* d) {
  const char* heading = PL_KEY("constraints");
  for (int k = 0; k < count_written(d); k++) {
    const pl_bond* l = &d->g.at[k];
    pl_step* row = pl_row(d, PL_BOTH(heading), link_form(d, l), l->implied ? "0" : "-1");
    if (l->implied) {
      pl_step_after(row, PL_BOTH("says nothing new"));
    } else if (l->fixes >= 0 && !l->contact) {
      pl_step_after(row, PL_BOTH("dropped"));
    } else if (l->contact) {
      pl_step_after(row, PL_BOTH("one-sided"));
    }
    row_of_lets(d, l->g);
    heading = "";
  }
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (o->off) continue;
    pl_step* row = pl_row(d, PL_BOTH(heading), constraint_form(d, o->source), "0");
    if (o->contact && !o->released) pl_step_after(row, PL_BOTH("one-sided, open"));
    else pl_step_after(row, PL_BOTH("does not hold"));
    row_of_lets(d, o->source->g);
    heading = "";
  }
}

static bool any(const pl_analysis* d, bool (*is)(const pl_analysis*, const pl_bond*)) {
  for (int k = 0; k < count_written(d); k++) {
    if (is(d, &d->g.at[k])) return true;
  }
  return false;
}

static bool is_rheonomic(const pl_analysis* d, const pl_bond* l) {
  return pl_has_symbol(d->pool, l->g, pl_time(d->pool));
}
static bool is_nonholonomic(const pl_analysis* d, const pl_bond* l) { return l->velocity; }
static bool is_contact(const pl_analysis* d, const pl_bond* l) { return l->contact; }
static bool is_implied(const pl_analysis* d, const pl_bond* l) { return l->implied; }

static void say_kinds(pl_analysis* d) {
  if (count_written(d) == 0) return;
  const char* time[2] = {PL_BOTH(any(d, is_rheonomic) ? "time-dependent (rheonomic)"
                                                      : "independent of time (scleronomic)")};
  if (count_written(d) == 1) {
    bool integrable = !any(d, is_nonholonomic);
    pl_say(d, pl_format(d->arena, "%s, %s", integrable ? "holonomic" : "nonholonomic", time[0]),
           pl_format(d->arena, "%s, %s",
                     integrable ? pl_german("holonomic") : pl_german("nonholonomic"), time[1]),
           0);
    return;
  }
  bool depend = any(d, is_implied);
  const char* independent[2] = {
      PL_BOTH(depend ? "not independent of each other" : "independent of each other")};
  const char* holonomic[2] = {
      PL_BOTH(any(d, is_nonholonomic) ? "not all holonomic" : "all holonomic")};
  pl_say(d, pl_format(d->arena, "%s, %s, %s", holonomic[0], time[0], independent[0]),
         pl_format(d->arena, "%s, %s, %s", holonomic[1], time[1], independent[1]), 0);
}

static void say_hidden(pl_analysis* d) {
  for (int k = 0; k < d->hidden.n; k++) {
    const pl_variable* c = &d->q.at[d->hidden.at[k]];
    if (c->by_combination) {
      pl_say(d,
             PL_BOTH(
                 "The mass matrix is singular: in a combination of the equations all accelerations "
                 "cancel, and what is left is a hidden constraint, {1}. "
                 "The start value of {2} is not free."),
             2, pl_feq(d, pl_fs(d, c->q), pl_f(d, c->map, PL_S_SOLUTION)), pl_fs(d, c->q));
      continue;
    }
    pl_say(
        d,
        PL_BOTH("{1} carries no inertia: its own equation contains no acceleration and is a hidden "
                "constraint, {2}. Its start value is not free."),
        2, pl_fs(d, c->q), pl_feq(d, pl_fs(d, c->q), pl_f(d, c->map, PL_S_SOLUTION)));
  }
}

// "in contact", and with what the start leaves open: "at the start".
static void rows_of_freedom(pl_analysis* d) {
  const pl_dof* f = &d->dof;
  bool closed = f->free > f->dof;
  pl_step* row = pl_row(d, PL_BOTH("degrees of freedom"), NULL, pl_format(d->arena, "%d", f->dof));
  if (f->open > 0) pl_step_after(row, PL_BOTH("at the start"));
  else if (closed) pl_step_after(row, PL_BOTH("in contact"));
  if (closed) {
    row = pl_row(d, "", "", NULL, pl_format(d->arena, "%d", f->free));
    if (f->open > 0) pl_step_after(row, PL_BOTH("with all contacts open"));
    else pl_step_after(row, PL_BOTH("after lift-off"));
  }
  if (f->velocity_dof == f->dof) return;
  pl_step_after(row, PL_BOTH("of position"));
  row = pl_row(d, "", "", NULL, pl_format(d->arena, "%d", f->velocity_dof));
  pl_step_after(row, PL_BOTH("of velocity"));
}

void pl_answer_dof(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Degrees of freedom"));
  row_of_coordinates(d);
  rows_of_constraints(d);
  say_kinds(d);
  rows_of_freedom(d);
  say_hidden(d);
  pl_say_rank_at_start(d);
  if (d->mass_is_singular) {
    pl_say(
        d,
        PL_BOTH("The mass matrix is singular and the equations do not determine all accelerations: "
                "fewer start values than this number promises are free."),
        0);
  }
  pl_answer(d, "dof", pl_int(d->pool, d->dof.dof), NULL);
}

// ------------------------------------------------------------------------------------- constraints
static void say_contact(pl_analysis* d, const pl_constraint* c) {
  bool push = (c->relation == PL_GE) != d->model->lambda_minus;
  const pl_form* closed = pl_feq(d, pl_fe(d, c->left), pl_fe(d, c->right));
  const pl_form* lambda = pl_frel(d, pl_fs(d, c->lambda), push ? "≥" : "≤", zero_form(d));
  const pl_form* open = pl_feq(d, pl_fs(d, c->lambda), zero_form(d));
  pl_show(d, constraint_form(d, c));
  pl_say(d, PL_BOTH("One-sided: in contact {1} and {2}; after lift-off {3}."), 3, closed, lambda,
         open);
}

static bool dropped(const pl_bond* l) { return l->fixes >= 0 && !l->contact; }

// Of the dropped constraints, those with a vanishing (or not) multiplier, or fixed by a function of
// time.
typedef enum pl_dropped_kind {
  PL_DROPPED_IDLE,
  PL_DROPPED_LOADED,
  PL_DROPPED_DRIVEN
} pl_dropped_kind;

static bool of_kind(pl_analysis* d, const pl_bond* l, pl_dropped_kind kind) {
  if (!dropped(l)) return false;
  bool driven = pl_has_symbol(d->pool, d->q.at[l->fixes].fixed, pl_time(d->pool));
  if (driven || kind == PL_DROPPED_DRIVEN) return driven && kind == PL_DROPPED_DRIVEN;
  bool idle = l->lambda_known && pl_is_zero_node(d->pool, l->lambda_value);
  return idle == (kind == PL_DROPPED_IDLE);
}

static const long longest_inline = 30;  // operations of a multiplier inside a sentence

// The multiplier of a dropped constraint; where its closed form is long, in terms of the other
// multipliers.
static const pl_form* multiplier_form(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  if (!l->lambda_known) return pl_fn(d, "?");
  const pl_form* form = pl_f(d, l->lambda_value, PL_S_QUOTIENT);
  if (pl_form_ops(form) <= longest_inline) return form;
  int i;
  pl_expr row = pl_multiplier_by_row(d, k, &i);
  return pl_is_poison(row) ? form : pl_positive_first(d, pl_f(d, row, PL_S_QUOTIENT));
}

static int collect_dropped(pl_analysis* d, pl_dropped_kind kind, const pl_form** label,
                           const pl_form** second, const pl_form** lambda) {
  int n = 0;
  for (int k = 0; k < count_written(d); k++) {
    const pl_bond* l = &d->g.at[k];
    if (!of_kind(d, l, kind)) continue;
    const pl_variable* c = &d->q.at[l->fixes];
    pl_expr a = kind == PL_DROPPED_DRIVEN ? pl_dt(d->pool, pl_dt(d->pool, c->fixed))
                                          : pl_int(d->pool, 0);
    label[n] = pl_fn(d, label_of(l));
    second[n] = pl_feq(d, pl_fs(d, c->a), pl_fe(d, a));
    lambda[n] = pl_feq(d, pl_fs(d, l->lambda), multiplier_form(d, k));
    n++;
  }
  return n;
}

static void say_dropped(pl_analysis* d) {
  const pl_form** label = PL_ARRAY(d->arena, const pl_form*, 3 * d->g.n + 1);
  const pl_form **second = label + d->g.n, **lambda = second + d->g.n;
  int n = collect_dropped(d, PL_DROPPED_IDLE, label, second, lambda);
  if (n > 0) {
    pl_say(
        d,
        PL_BOTH(
            n == 1
                ? "{1} has the form coordinate = constant. Differentiated twice it gives {2}; no "
                  "force acts along this "
                  "coordinate, so {3}, and the other coordinates do not depend on it. It is "
                  "dropped."
                : "{1} have the form coordinate = constant. Differentiated twice they give {2}; no "
                  "force acts along these "
                  "coordinates, so {3}, and the other coordinates do not depend on them. They are "
                  "dropped."),
        3, pl_flist(d, label, n), pl_flist(d, second, n), pl_flist(d, lambda, n));
  }
  n = collect_dropped(d, PL_DROPPED_LOADED, label, second, lambda);
  if (n > 0) {
    pl_say(
        d,
        PL_BOTH(
            n == 1
                ? "{1}: coordinate = constant, so {2}. The coordinate is inserted and dropped; "
                  "its own equation still gives the "
                  "multiplier: {3}."
                : "{1}: coordinate = constant, so {2}. The coordinates are inserted and dropped; "
                  "their own equations still give "
                  "the multipliers: {3}."),
        3, pl_flist(d, label, n), pl_flist(d, second, n), pl_flist(d, lambda, n));
  }
  n = collect_dropped(d, PL_DROPPED_DRIVEN, label, second, lambda);
  if (n > 0) {
    pl_say(
        d,
        PL_BOTH("{1}: coordinate = given function of time (rheonomic), so {2}. It is inserted and "
                "dropped; the drive does work. Its "
                "multiplier is {3}."),
        3, pl_flist(d, label, n), pl_flist(d, second, n), pl_flist(d, lambda, n));
  }
}

// The theorem itself, as steps that are shown on demand.
static void theorem(pl_analysis* d) {
  pl_step* s = pl_say(
      d,
      PL_BOTH("Why: let {1} with constant a. Lagrange I for this coordinate is {2}, and "
              "{3}. So {4}; inserted back, {5}, and with x(0) = a, "
              "x'(0) = 0 the coordinate stays at a. It may be inserted from the start; λ_1 "
              "is the force of the plane (pleuel explain T101)."),
      5, pl_fn(d, "g_1 = x - a = 0"), pl_fn(d, "m x'' = F + λ_1 + Σ λ_a ∂g_a/∂x"),
      pl_fn(d, "x'' = 0"), pl_fn(d, "λ_1 = -F - Σ λ_a ∂g_a/∂x"), pl_fn(d, "m x'' = 0"));
  s->detail = true;
}

// What holds between the axes of a body in space is none of the constraints that were written down.
static void say_attitudes(pl_analysis* d) {
  const pl_form** label = PL_ARRAY(d->arena, const pl_form*, d->g.n + 1);
  for (int k = 0; k < d->g.n; k++) {
    const char* body = d->g.at[k].source->body;
    int n = 0;
    bool first = body != NULL;
    for (int i = 0; i < d->g.n; i++) {
      const char* other = d->g.at[i].source->body;
      if (!body || !other || strcmp(body, other) != 0) continue;
      first &= i >= k;
      label[n++] = pl_fn(d, label_of(&d->g.at[i]));
    }
    if (!first) continue;
    if (d->g.at[k].source->axes == PL_AXES_QUATERNION) {
      pl_say(
          d,
          PL_BOTH(
              n == 1
                  ? "{1} makes the four numbers that give the attitude of {2} a rotation: a unit "
                    "quaternion. Its multiplier is no force, "
                    "since no turning of the body changes |q|."
                  : "{1} make the four numbers that give the attitude of each {2} a rotation: a "
                    "unit quaternion. Their multipliers are no "
                    "forces, since no turning of a body changes |q|."),
          2, pl_flist(d, label, n), pl_fn(d, body));
    } else {
      pl_say(
          d,
          PL_BOTH("{1} make the axes of {2} unit vectors at right angles. Their multipliers are no "
                  "forces on the body: they keep the axes "
                  "together and do no work when it turns."),
          2, pl_flist(d, label, n), pl_fn(d, body));
    }
  }
}

static int count_open(const pl_analysis* d) {
  int n = 0;
  for (int k = 0; k < d->open.n; k++) n += !d->open.at[k].off;
  return n;
}

static void show_open(pl_analysis* d, const pl_open* o, bool after_dof) {
  if (o->off) return;
  const pl_constraint* c = o->source;
  if (o->contact && !o->released) {
    say_contact(d, c);
    pl_say(d, PL_BOTH("At the start {1} is open."), 1, pl_fn(d, c->name.text));
  } else {
    if (!after_dof) pl_show(d, constraint_form(d, c));
    pl_say(d, PL_BOTH("{1} does not hold here."), 1, pl_fn(d, c->name.text));
  }
  pl_answer(d, c->name.text, c->g, pl_difference_form(d, c->left, c->right))->of = c->name.text;
}

// Freedoms in contact and after lift-off.
static void say_freedom(pl_analysis* d) {
  const pl_dof* f = &d->dof;
  int n = count_coordinates(d);
  const char* constraints = f->rank == 1 ? PL_KEY("constraint") : PL_KEY("constraints");
  const char* degrees = f->dof == 1 ? PL_KEY("degree of freedom") : PL_KEY("degrees of freedom");
  pl_say(
      d,
      pl_format(d->arena, "%d coordinates, %d independent %s: %d %s in contact, %d after lift-off.",
                n, f->rank, constraints, f->dof, degrees, f->free),
      pl_format(
          d->arena,
          pl_german("%d coordinates, %d independent %s: %d %s in contact, %d after lift-off."), n,
          f->rank, pl_german(constraints), f->dof, pl_german(degrees), f->free),
      0);
}

void pl_answer_constraints(pl_analysis* d, const pl_ask* ask) {
  bool after_dof = d->page->section && d->page->solution->sections.n > 0 && ask->letter
                   && d->page->section->letter
                   && strcmp(ask->letter, d->page->section->letter) == 0;
  pl_section_open(d, ask, after_dof ? NULL : "Constraints",
                  after_dof ? NULL : pl_german("Constraints"));
  bool some_dropped = false;
  if (count_written(d) + count_open(d) == 0) pl_say(d, PL_BOTH("There are none."), 0);
  for (int k = 0; k < count_written(d); k++) {
    const pl_bond* l = &d->g.at[k];
    some_dropped |= dropped(l);
    if (l->contact) {
      say_contact(d, l->source);
    } else if (!after_dof) {
      pl_show(d, link_form(d, l));
      row_of_lets(d, l->g);
    }
    if (l->integrated) {
      pl_say(
          d,
          PL_BOTH(
              "{1} is given for velocities and can be integrated: {2}. It restricts positions and "
              "is treated as holonomic."),
          2, pl_fn(d, label_of(l)), pl_feq(d, pl_fe(d, l->g), zero_form(d)));
    }
    pl_value* v = pl_answer(d, label_of(l), l->g,
                            pl_difference_form(d, l->source->left, l->source->right));
    v->of = label_of(l);
  }
  for (int k = 0; k < d->open.n; k++) show_open(d, &d->open.at[k], after_dof);
  if (!after_dof) say_kinds(d);
  say_attitudes(d);
  if (any(d, is_contact)) say_freedom(d);
  if (some_dropped) {
    say_dropped(d);
    theorem(d);
  }
}
