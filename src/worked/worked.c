// worked: the derivation from end to end, and the requests answered in order.
#include <string.h>

#include "worked/worked_impl.h"

// coordinates up to which a family is written out and derived member by member
static const int largest_expansion = 24;
// the same when a multiplier, an acceleration or a force of a member is asked for
static const int largest_for_a_member = 80;

// ------------------------------------------------------------------------------ degrees of freedom
// Those that depend on others only where all hold.
static void depend_where_they_hold(pl_analysis* d, const int* row, int m, const int* column,
                                   int n) {
  int *kept = PL_ARRAY(d->arena, int, m), n_kept = 0;
  for (int a = 0; a < m; a++) {
    if (!d->g.at[row[a]].implied) kept[n_kept++] = row[a];
  }
  for (int a = 0; a < m; a++) {
    if (d->g.at[row[a]].implied) pl_depend_on_manifold(d, row[a], kept, n_kept, column, n);
  }
}

// Constraints that the others imply, by the rank of dg/dq at a generic point, or at points where
// the constraints hold.
static void find_implied(pl_analysis* d) {
  int n = 0, m = 0;
  int* column = PL_ARRAY(d->arena, int, d->q.n + 1);
  int* row = PL_ARRAY(d->arena, int, d->g.n + 1);
  for (int i = 0; i < d->q.n; i++) {
    if (d->q.at[i].carries && d->q.at[i].fixed_by < 0) column[n++] = i;
  }
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].fixes < 0 && !d->g.at[k].implied) row[m++] = k;
  }
  if (m == 0) return;
  if (n == 0) {  // nothing is left to move: what holds, holds already
    for (int a = 0; a < m; a++) d->g.at[row[a]].implied = true;
    return;
  }
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, m * n);
  for (int a = 0; a < m; a++) {
    for (int b = 0; b < n; b++) A[a * n + b] = pl_on_maps(d, d->g.at[row[a]].gradient[column[b]]);
  }
  int *independent = PL_ARRAY(d->arena, int, m), *there = PL_ARRAY(d->arena, int, m);
  int rank = pl_alg_rank(d->tower, m, n, A, independent);
  int where_they_hold = d->reduced ? -1 : pl_rank_on_manifold(d, row, m, column, n, there);
  bool smaller = where_they_hold >= 0 && where_they_hold < rank;
  if (smaller) {
    rank = where_they_hold;
    memcpy(independent, there, (size_t)rank * sizeof *independent);
  }
  for (int a = 0; a < m; a++) {
    bool kept = false;
    for (int r = 0; r < rank; r++) kept |= independent[r] == a;
    d->g.at[row[a]].implied = !kept;
  }
  if (smaller) depend_where_they_hold(d, row, m, column, n);
}

static void count_freedom(pl_analysis* d) {
  pl_dof* f = &d->dof;
  int velocity = 0, contacts = 0;
  for (int i = 0; i < d->q.n; i++) f->coordinates += d->q.at[i].carries;
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].source->sticking) continue;  // friction is a force
    f->constraints++;
    if (d->g.at[k].implied) continue;
    if (d->g.at[k].velocity) {
      velocity++;
    } else {
      f->rank++;
      contacts += d->g.at[k].contact || d->g.at[k].source->while_label;
    }
  }
  for (int k = 0; k < d->open.n; k++) f->open += d->open.at[k].contact && !d->open.at[k].released;
  f->dof = f->coordinates - f->rank - d->hidden.n;
  f->velocity_dof = f->dof - velocity;
  f->free = f->dof + contacts;
}

static void list_hidden(pl_analysis* d) {
  for (int k = 0; k < d->hidden.n; k++) {
    const pl_variable* c = &d->q.at[d->hidden.at[k]];
    pl_push(d->arena, d->solution->hidden, pl_sub(d->pool, pl_sym(d->pool, c->q), c->map));
  }
}

static const char* relation_text(pl_analysis* d, const pl_constraint* c) {
  const char* op = c->relation == PL_GE ? ">=" : c->relation == PL_LE ? "<=" : "=";
  return pl_format(d->arena, "%s %s %s", pl_expr_text(d->arena, d->pool, c->left), op,
                   pl_expr_text(d->arena, d->pool, c->right));
}

// ∇g_k as a combination of the gradients of the independent constraints: coefficients c of the
// bonds in `row`, k at `place`.
static pl_answer3 dependency(pl_analysis* d, int k, int* row, pl_expr* c, int* m, int* place) {
  int n = d->q.n;
  pl_expr* A = PL_ARRAY(d->arena, pl_expr, d->g.n * n);
  *m = 0;
  for (int a = 0; a < d->g.n; a++) {
    if (a != k && d->g.at[a].implied) continue;
    if (a == k) *place = *m;
    for (int i = 0; i < n; i++) A[*m * n + i] = pl_on_maps(d, d->g.at[a].gradient[i]);
    row[(*m)++] = a;
  }
  return pl_alg_dependency(d->tower, *m, n, A, *place, c);
}

// Labels of the constraints that one implied constraint depends on.
static void implied_by(pl_analysis* d, int k, pl_constraint_info* info) {
  int m = 0, place = -1;
  int* row = PL_ARRAY(d->arena, int, d->g.n);
  pl_expr* c = PL_ARRAY(d->arena, pl_expr, d->g.n);
  if (dependency(d, k, row, c, &m, &place) != PL_YES) return;
  pl_depend(d, k, m, row, c, place);
  info->implied_by = PL_ARRAY(d->arena, const char*, m);
  for (int a = 0; a < m; a++) {
    if (a == place || pl_is_poison(c[a]) || pl_is_zero_node(d->pool, c[a])) continue;
    info->implied_by[info->n_implied_by++] = d->g.at[row[a]].source->name.text;
  }
}

// ---------------------------------------------------------------------------------- contradictions
// Every root of one constraint inserted into another leaves something: they have no position in
// common.
static bool no_common_root(pl_analysis* d, pl_expr given, pl_expr e) {
  for (int i = 0; i < d->q.n; i++) {
    if (!pl_has_symbol(d->pool, given, d->q.at[i].q)) continue;
    pl_root root[8];
    bool complete = false, all = true;
    int n = pl_alg_roots(d->tower, given, d->q.at[i].q, root, 8, &complete);
    for (int r = 0; r < n; r++)
      all &= pl_zero_for_numbers(d, pl_subst1(d->pool, e, d->q.at[i].q, root[r].value)) == PL_NO;
    if (n > 0 && complete) return all;
  }
  return false;
}

// A constraint whose gradient depends on those of the others holds where they hold, or nowhere.
// With ∇g = sum c_a ∇g_a and constant c_a the difference g - sum c_a g_a is a constant.
static pleuel_status no_contradiction(pl_analysis* d, int k) {
  const pl_bond* l = &d->g.at[k];
  if (d->reduced) {
    pl_expr left = pl_on_maps(d, l->g);
    if (pl_has_followers(d, left) && pl_holds_on_loops(d, left, pl_int(d->pool, 0)) != PL_NO)
      return PLEUEL_OK;
    return pl_zero_for_numbers(d, left) == PL_NO
               ? pl_contradiction(d, l, pl_alg_normal(d->tower, left))
               : PLEUEL_OK;
  }
  int m = 0, place = -1, others = 0, other = -1;
  int* row = PL_ARRAY(d->arena, int, d->g.n);
  pl_expr* c = PL_ARRAY(d->arena, pl_expr, d->g.n);
  if (dependency(d, k, row, c, &m, &place) != PL_YES) return PLEUEL_OK;
  bool constant = true;
  pl_expr rest = l->g;
  for (int a = 0; a < m; a++) {
    if (a == place || pl_is_poison(c[a]) || pl_is_zero_node(d->pool, c[a])) continue;
    constant &= !pl_has_coordinates(d, c[a]) && !d->g.at[row[a]].velocity;
    rest = pl_sub(d->pool, rest, pl_mul(d->pool, c[a], d->g.at[row[a]].g));
    other = row[a];
    others++;
  }
  if (others == 0) return PLEUEL_OK;
  if (constant) {
    rest = pl_alg_normal(d->tower, pl_on_fixed(d, rest));
    bool left = !pl_has_coordinates(d, rest) && pl_zero_for_numbers(d, rest) == PL_NO;
    return left ? pl_contradiction(d, l, rest) : PLEUEL_OK;
  }
  pl_expr e = pl_on_fixed(d, l->g);
  return others == 1 && no_common_root(d, pl_on_fixed(d, d->g.at[other].g), e)
             ? pl_contradiction(d, l, e)
             : PLEUEL_OK;
}

static pleuel_status find_contradictions(pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    if (l->implied && !l->velocity && !l->contact) PL_TRY(no_contradiction(d, k));
  }
  return PLEUEL_OK;
}

static void note_implied(pl_analysis* d, const pl_bond* l, const pl_constraint_info* info) {
  if (l->source->redundant_ok) return;
  pl_text by = pl_text_make(d->arena);
  for (int k = 0; k < info->n_implied_by; k++)
    pl_text_addf(&by, "%s%s", k ? ", " : "", info->implied_by[k]);
  const char* others = info->n_implied_by > 0 ? pl_text_string(&by) : NULL;
  const char* label = l->source->name.text;
  pl_diagnostic* m = pl_report(d->job->diagnostics, PL_N052, l->source->span,
                               pl_format(d->arena, "constraint %s says nothing new", label),
                               pl_format(d->arena, "Zwangsbedingung %s sagt nichts Neues", label));
  pl_report_reason(m, pl_format(d->arena, "implied by %s", others ? others : "the others"),
                   pl_format(d->arena, "folgt aus %s", others ? others : "den anderen"));
  pl_report_fix(m,
                "fine for the motion, but the forces of these constraints are not unique; add \", "
                "redundant ok\" to keep it",
                "für die Bewegung ohne Folgen, aber die Kräfte dieser Zwangsbedingungen sind nicht "
                "eindeutig; mit \", redundant ok\" bleibt sie",
                NULL);
}

static void describe_open(pl_analysis* d) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_open* o = &d->open.at[k];
    if (o->off) continue;
    pl_constraint_info info = {.source = o->source,
                               .label = o->source->name.text,
                               .text = relation_text(d, o->source),
                               .open = true,
                               .nonholonomic = o->source->has_velocity,
                               .one_sided = o->contact,
                               .rheonomic = pl_has_symbol(d->pool, o->source->g, pl_time(d->pool))};
    pl_push(d->arena, d->solution->constraints, info);
  }
}

// first: it is told.  What depends on what is found for every set.
static void describe_constraints(pl_analysis* d, bool first) {
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    pl_constraint_info info = {.source = l->source,
                               .label = l->source->name.text,
                               .text = relation_text(d, l->source),
                               .nonholonomic = l->velocity,
                               .one_sided = l->contact,
                               .rheonomic = pl_has_symbol(d->pool, l->g, pl_time(d->pool)),
                               .dropped = l->fixes >= 0 && !l->contact,
                               .implied = l->implied};
    if (l->implied) {
      implied_by(d, k, &info);
      if (first) note_implied(d, l, &info);
    }
    if (first && !l->source->sticking) pl_push(d->arena, d->solution->constraints, info);
  }
  if (first) describe_open(d);
}

// ---------------------------------------------------------------------------------------- requests
// What friction leaves as it is.  Everything else would be right without friction only.
static bool survives_friction(pl_analysis* d, const pl_ask* ask) {
  switch (ask->kind) {
    case PL_ASK_DOF:
    case PL_ASK_CONSTRAINTS:
    case PL_ASK_LAGRANGIAN: return true;
    case PL_ASK_LAGRANGE1:
    case PL_ASK_NEWTON:
    case PL_ASK_CONSERVED:
    case PL_ASK_SOLVE: return pl_knows_friction(d);
    case PL_ASK_VALUE: return pl_knows_friction(d) && ask->where.n == 0 && !ask->motion.given;
    default: return false;
  }
}

static bool rubs(const pl_analysis* d) {
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].rub || d->g.at[k].source->sticking) return true;
  }
  return false;
}

// What slips takes energy, and more is not claimed.
static void answer_conserved_with_friction(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, "Conserved", "Erhaltungsgrößen");
  pl_say(d, "The energy is not conserved: where surfaces slip, friction does work.",
         "Die Energie ist nicht erhalten: wo Flächen gleiten, leistet die Reibung Arbeit.", 0);
  pl_value* v = pl_answer(d, "E", pl_poison(), NULL);
  v->conserved = 0;
  v->because[0] = "friction does work";
  v->because[1] = "die Reibung leistet Arbeit";
}

static void leave_to_simulation(pl_analysis* d, const pl_ask* ask) {
  if (!d->section || d->section->item != ask->text) pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d,
         "Friction acts here, with a force that jumps between sticking and slipping: no formula is "
         "given. The simulation computes the motion.",
         "Hier wirkt Reibung, deren Kraft zwischen Haften und Gleiten springt: keine Formel. Die "
         "Simulation berechnet die Bewegung.",
         0);
  d->section->not_found = true;
}

static void note_friction(pl_analysis* d) {
  if (pl_knows_friction(d) || d->options->structure) return;
  pl_diagnostic* m = pl_report(
      d->job->diagnostics, PL_N091, d->model->frictions.at[0].span,
      "friction is computed by the simulation, formulas are not derived with it",
      "Reibung berechnet die Simulation, Formeln werden mit ihr nicht hergeleitet");
  pl_report_fix(m, "without this line the formulas hold for smooth surfaces",
                "ohne diese Zeile gelten die Formeln für glatte Flächen", NULL);
}

// What asks for roots or series in the generalized coordinates, on which the coordinates of loops
// hang without being written out.
static bool needs_explicit_maps(const pl_ask* ask) {
  return ask->kind == PL_ASK_EQUILIBRIA || ask->kind == PL_ASK_MODES
         || ask->kind == PL_ASK_THRESHOLD || ask->kind == PL_ASK_LIMIT || ask->kind == PL_ASK_SERIES
         || (ask->kind == PL_ASK_VALUE && ask->where.n > 0);
}

// The equations of the second kind at rest, over the names of the loops.
static void show_rest(pl_analysis* d) {
  pl_tell_loops(d);
  pl_say(d, "At rest the constraints hold and", "In Ruhe gelten die Zwangsbedingungen und", 0);
  for (int k = 0; k < d->gen.n; k++) {
    pl_expr e = pl_second_kind(d, d->gen.at[k]);
    for (int j = 0; j < d->gen.n; j++) {
      const pl_variable* c = &d->q.at[d->gen.at[j]];
      e = pl_subst1(d->pool, pl_subst1(d->pool, e, c->a, pl_int(d->pool, 0)), c->v,
                    pl_int(d->pool, 0));
    }
    pl_show_numbered(d, pl_feq(d, pl_f(d, pl_alg_normal(d->tower, e), PL_S_EQUATION),
                               pl_form_leaf(d->arena, pl_int(d->pool, 0))));
  }
}

static void leave_implicit(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d,
         "The coordinates of closed loops follow from the generalized ones through roots; no "
         "closed form was found for this.",
         "Die Koordinaten geschlossener Schleifen folgen aus den verallgemeinerten durch Wurzeln; "
         "hierfür wurde keine geschlossene Form gefunden.",
         0);
  d->section->not_found = true;
  if (ask->kind == PL_ASK_EQUILIBRIA) show_rest(d);
}

// ------------------------------------------------------------------------------- which coordinates
static bool of_forces(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_MULTIPLIER)
         || pl_has_role(d->pool, e, PL_R_LOCAL);
}

// What is answered in generalized coordinates. Multipliers, accelerations and forces stay in the
// coordinates of the model, where these have a closed form and no motion is named.
static bool in_generalized(pl_analysis* d, const pl_ask* ask) {
  switch (ask->kind) {
    case PL_ASK_LIMIT:
    case PL_ASK_SERIES: return false;
    case PL_ASK_SOLVE: return !d->solved || ask->of_time || !of_forces(d, ask->value);
    case PL_ASK_VALUE:
      return !d->solved || ask->where.n > 0 || ask->motion.given || !of_forces(d, ask->value);
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON: return !d->solved || ask->motion.given;
    default: return true;
  }
}

// No freedom is left: all is a function of t.
static bool is_driven(const pl_analysis* d) { return d->dof.dof == 0; }

// The analysis that answers: in the coordinates of the model, or with what is proposed.
pl_analysis* pl_serving(pl_analysis* d, const pl_ask* ask) {
  bool first_kind = ask->kind == PL_ASK_DOF || ask->kind == PL_ASK_CONSTRAINTS
                    || ask->kind == PL_ASK_LAGRANGE1 || ask->kind == PL_ASK_NEWTON
                    || ask->kind == PL_ASK_CONSERVED;
  if (d->reduced || first_kind || !(in_generalized(d, ask) || is_driven(d))) return d;
  bool rest = ask->kind == PL_ASK_EQUILIBRIA || ask->kind == PL_ASK_MODES
              || ask->kind == PL_ASK_THRESHOLD;
  pl_analysis* a = rest ? pl_propose_for_rest(d) : pl_propose(d);
  return a ? a : d;
}

static void answer_with(pl_analysis* d, const pl_ask* ask) {
  if (d->model->frictions.n > 0 && !survives_friction(d, ask)) {
    leave_to_simulation(d, ask);
    return;
  }
  if (d->loops.n > 0 && needs_explicit_maps(ask)) {
    if (ask->kind == PL_ASK_VALUE && pl_where_in_loops(d, ask)) return;
    leave_implicit(d, ask);
    return;
  }
  switch (ask->kind) {
    case PL_ASK_DOF: pl_answer_dof(d, ask); break;
    case PL_ASK_CONSTRAINTS: pl_answer_constraints(d, ask); break;
    case PL_ASK_LAGRANGE1:
    case PL_ASK_NEWTON: pl_answer_lagrange1(d, ask); break;
    case PL_ASK_LAGRANGE2: pl_answer_lagrange2(d, ask); break;
    case PL_ASK_LAGRANGIAN: pl_answer_lagrangian(d, ask); break;
    case PL_ASK_HAMILTONIAN: pl_answer_hamiltonian(d, ask); break;
    case PL_ASK_SOLVE: pl_answer_solve(d, ask); break;
    case PL_ASK_VALUE: pl_answer_value(d, ask); break;
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON: pl_answer_force(d, ask); break;
    case PL_ASK_CONSERVED:
      if (rubs(d)) answer_conserved_with_friction(d, ask);
      else pl_answer_conserved(d, ask);
      break;
    case PL_ASK_EQUILIBRIA: pl_answer_equilibria(d, ask); break;
    case PL_ASK_MODES: pl_answer_modes(d, ask); break;
    case PL_ASK_LIMIT: pl_answer_limit(d, ask); break;
    case PL_ASK_SERIES: pl_answer_series(d, ask); break;
    case PL_ASK_EXPECT: pl_answer_expect(d, ask); break;
    case PL_ASK_THRESHOLD: pl_answer_threshold(d, ask); break;
    case PL_ASK_MAX:
    case PL_ASK_MIN:
    case PL_ASK_AVERAGE:
    case PL_ASK_STABILITY: pl_answer_pending(d, ask); break;
  }
}

// The motion that is meant, and the place of a position of rest, in generalized coordinates.
static pl_ask in_its_coordinates(pl_analysis* d, const pl_ask* ask) {
  pl_ask own = *ask;
  pl_condition* found;
  int n = pl_in_generalized(d, ask->motion.from, ask->motion.n_from, &found);
  if (n >= 0) {
    own.motion.from = found;
    own.motion.n_from = n;
  }
  bool place = ask->kind == PL_ASK_MODES || ask->kind == PL_ASK_EQUILIBRIA
               || ask->kind == PL_ASK_THRESHOLD;
  n = place ? pl_in_generalized(d, ask->where.at, ask->where.n, &found) : -1;
  if (n >= 0) {
    own.where.at = found;
    own.where.n = own.where.cap = n;
  }
  return own;
}

void pl_answer_one(pl_analysis* d, const pl_ask* ask) {
  if (ask->kind == PL_ASK_LAGRANGIAN) d = pl_without_sticking(d);
  int n = d->solution->sections.n;
  // another analysis may have written it
  d->section = n > 0 ? &d->solution->sections.at[n - 1] : NULL;
  if (pl_answer_open(d, ask)) return;
  ask = pl_without_open(d, ask);
  pl_analysis* base = d;
  pl_analysis* a = pl_serving(d, ask);
  pl_ask own = in_its_coordinates(a, ask);
  if (own.motion.given && (base = pl_analysis_around(d, a, &own.motion)) != d) {
    a = pl_serving(base, ask);
    own = in_its_coordinates(a, ask);
  }
  a->base = base;
  a->section = d->section;
  a->open_told = d->open_told;
  a->stage = d->stage;
  answer_with(a, &own);
  d->section = a->section;
  d->open_told = a->open_told;
}

static void standard(pl_analysis* d, pl_ask_kind kind, const char* text) {
  pl_ask ask = {.kind = kind, .text = text};
  pl_answer_one(d, &ask);
}

// Without `ask`: the standard worked solution.
static void answer_standard(pl_analysis* d) {
  standard(d, PL_ASK_DOF, "dof");
  standard(d, PL_ASK_CONSTRAINTS, "constraints");
  if (d->particle.n == 0 && d->model->loads.n == 0) {  // nothing heavy, no force: kinematics
    pl_answer_positions(d);
    return;
  }
  standard(d, PL_ASK_LAGRANGE1, "lagrange1");
  for (int k = 0; k < d->g.n; k++) {
    if (d->g.at[k].implied || (d->g.at[k].fixes >= 0 && !d->g.at[k].contact)) continue;
    const pl_symbol_info* lambda = pl_symbol_get(d->pool, d->g.at[k].lambda);
    pl_ask ask = {.kind = PL_ASK_SOLVE,
                  .text = pl_format(d->arena, "solve %s", lambda->name),
                  .value = pl_sym(d->pool, d->g.at[k].lambda)};
    pl_answer_one(d, &ask);
  }
  const pl_analysis* a = d->reduced ? d : pl_propose(d);
  if (a) {
    standard(d, PL_ASK_LAGRANGIAN, "lagrangian");
    standard(d, PL_ASK_LAGRANGE2, "lagrange2");
  }
  standard(d, PL_ASK_CONSERVED, "conserved");
  if (a && a->loops.n == 0) standard(d, PL_ASK_EQUILIBRIA, "equilibria");
}

static bool wanted(const pl_derive_options* o, const pl_ask* ask) {
  if (!o->only) return true;
  if (!ask->letter) return false;
  size_t n = strlen(ask->letter);
  for (const char* at = o->only; *at;) {
    const char* end = strchr(at, ',');
    size_t length = end ? (size_t)(end - at) : strlen(at);
    if (length == n && strncmp(at, ask->letter, n) == 0) return true;
    at += length + (end != NULL);
  }
  return false;
}

static pleuel_status answer_all(pl_analysis* d) {
  note_friction(d);
  if (d->model->asks.n == 0) answer_standard(d);
  for (int k = 0; k < d->model->asks.n; k++) {
    if (pl_interrupted(d->job))
      return pl_fail(d->job, PLEUEL_INTERRUPTED, "stopped after %d of %d requests", k,
                     d->model->asks.n);
    const pl_ask* ask = &d->model->asks.at[k];
    if (!wanted(d->options, ask)) continue;
    pl_analysis* of = pl_analysis_of(d, ask);
    pl_answer_one(of ? of : d, ask);
    pl_answer_closed(d, ask);
  }
  pl_answer_stages(d);
  return PLEUEL_OK;
}

// ------------------------------------------------------------------------------------- assumptions
// "m1 > 0", "r < l": a difference a - b is written as b < a.
static const char* fact_text(pl_analysis* d, const pl_fact* f) {
  pl_notation how = {.math = PL_MATH_LINE, .lang = d->job->lang};
  return pl_notation_print(d->arena, d->pool, pl_fact_form(d, f), how);
}

// A one-sided constraint of the model is no assumption of ours.
static bool is_contact(pl_analysis* d, const pl_fact* f) {
  for (int k = 0; k < d->open.n; k++) {
    const pl_constraint* c = d->open.at[k].source;
    bool same = pl_same(f->difference, c->g) || pl_same(f->difference, pl_neg(d->pool, c->g));
    if (d->open.at[k].contact && !f->strict && same) return true;
  }
  for (int k = 0; k < d->g.n; k++) {
    const pl_bond* l = &d->g.at[k];
    bool same = pl_same(f->difference, l->g) || pl_same(f->difference, pl_neg(d->pool, l->g));
    if (l->contact && !f->strict && same) return true;
  }
  return false;
}

// Signs of single names first, in the order of their declaration; then relations between several.
static uint64_t fact_order(const pl_analysis* d, const pl_fact* f) {
  pl_symbol first = {0};
  int n = pl_symbols_in(d->pool, f->difference, &first, 1);
  return ((uint64_t)n << 32) + first.id;
}

static bool is_listed(pl_analysis* d, const pl_fact* f, const pl_fact** sorted, int n) {
  // 2 kg > 0
  bool numbers = pl_is_constant(d->pool, pl_without_measures(d->pool, f->difference));
  bool listed = numbers || is_contact(d, f);
  for (int k = 0; k < n; k++)
    listed |= sorted[k]->strict == f->strict && pl_same(sorted[k]->difference, f->difference);
  return listed;
}

// What a section is about stands in its title: a side of |x| that the motion comes to later.
static bool stands_in_title(const pl_analysis* of, const pl_fact* f) {
  for (int k = 0; of->stage && k < of->stage->n_sides; k++) {
    if (pl_same(of->stage->sides[k].difference, f->difference)) return true;
  }
  return false;
}

// An assumption about the place belongs to the stretch of the motion that is spoken of.
static const char* told_fact(pl_analysis* d, const pl_analysis* of, const pl_fact* f) {
  const char* text = fact_text(d, f);
  bool later = of->stage && of->stage->from > 0 && pl_has_coordinates(d, f->difference);
  if (!later) return text;
  const char* when = pl_notation_print(d->arena, d->pool, pl_moment_form(d, of->stage->from),
                                       (pl_notation){.math = PL_MATH_LINE, .lang = d->job->lang});
  return pl_format(d->arena, d->job->lang == PL_GERMAN ? "%s (ab %s)" : "%s (from %s)", text, when);
}

// Those of all analyses.
static void list_assumptions(pl_analysis* d, pl_analysis** of, int n_of) {
  int most = 0, n = 0, n_used;
  for (int k = 0; k < n_of; k++) {
    pl_tower_used(of[k]->tower, &n_used);
    most += n_used;
  }
  const pl_fact** sorted = PL_ARRAY(d->arena, const pl_fact*, most + 1);
  const pl_analysis** by = PL_ARRAY(d->arena, const pl_analysis*, most + 1);
  for (int k = 0; k < n_of; k++) {
    const pl_fact* used = pl_tower_used(of[k]->tower, &n_used);
    // by insertion: few, and equal ones keep their order
    for (const pl_fact* f = used; f < used + n_used; f++) {
      if (is_listed(d, f, sorted, n) || stands_in_title(of[k], f)) continue;
      int at = n++;
      for (; at > 0 && fact_order(d, sorted[at - 1]) > fact_order(d, f); at--) {
        sorted[at] = sorted[at - 1];
        by[at] = by[at - 1];
      }
      sorted[at] = f;
      by[at] = of[k];
    }
  }
  for (int k = 0; k < n; k++) pl_push(d->arena, d->solution->used, told_fact(d, by[k], sorted[k]));
}

// --------------------------------------------------------------------------------------- the whole
// The time since *since goes to the stage.
static void pass(pl_analysis* d, pl_derive_stage stage, double* since) {
  double now = pl_cpu_ms();
  d->solution->cpu_ms[stage] += now - *since;
  *since = now;
}

pleuel_status pl_form_equations(pl_analysis* d) {
  PL_TRY(pl_setup_coordinates(d));
  PL_TRY(pl_setup_trivial(d));
  PL_TRY(pl_energies(d));
  PL_TRY(pl_reduce(d));
  pl_start_in_generalized(d);
  find_implied(d);
  return PLEUEL_OK;
}

static pleuel_status solve_equations(pl_analysis* d, double* since) {
  pleuel_status status = pl_form_equations(d);
  if (status == PLEUEL_OK) status = find_contradictions(d);
  pass(d, PL_D_EQUATIONS, since);
  PL_TRY(status);
  status = pl_solve_motion(d);
  pass(d, PL_D_SOLUTION, since);
  return status;
}

// From the beginning, with the special case known that the given numbers are.
static void begin_again(pl_analysis* d) {
  pl_analysis fresh = {.job = d->job,
                       .arena = d->arena,
                       .pool = d->pool,
                       .options = d->options,
                       .solution = d->solution};
  fresh.told = pl_map_make(d->arena);
  fresh.began_ms = d->began_ms;
  fresh.sets = d->sets;
  fresh.first = d->first;
  fresh.has_section = d->has_section;
  fresh.cases = d->cases;
  fresh.model = d->whole;
  pl_setup_facts(&fresh);
  pl_choose_set(&fresh, d->whole, d->stage);
  *d = fresh;
}

// Equations and the motion that follows from them.
static pleuel_status derive_motion(pl_analysis* d, bool first, double* since) {
  PL_TRY(solve_equations(d, since));
  while (pl_find_case(d)) {
    begin_again(d);
    PL_TRY(solve_equations(d, since));
  }
  count_freedom(d);
  describe_constraints(d, first);
  pl_share_forces(d);
  return PLEUEL_OK;
}

static pl_analysis* analysis(pl_job* job, pl_model* whole, const pl_derive_options* options,
                             pl_solution* solution, const pl_stage* stage) {
  pl_analysis* d = PL_NEW(job->arena, pl_analysis);
  *d = (pl_analysis){.job = job,
                     .arena = job->arena,
                     .pool = whole->pool,
                     .model = whole,
                     .options = options,
                     .solution = solution};
  d->told = pl_map_make(job->arena);
  d->began_ms = pl_cpu_ms();
  pl_setup_facts(d);
  pl_choose_set(d, whole, stage);
  return d;
}

pl_analysis* pl_analysis_make(const pl_analysis* like, const pl_stage* stage) {
  pl_job* job = like->job;
  pl_analysis* d = analysis(job, like->whole, like->options, like->solution, stage);
  d->first = like->first;
  double since = pl_cpu_ms();
  int messages = job->diagnostics->list.n, errors = job->diagnostics->n_errors;
  if (derive_motion(d, false, &since) == PLEUEL_OK) return d;
  job->diagnostics->list.n = messages;  // a set that does not fit is no fault of the model
  job->diagnostics->n_errors = errors;
  job->status = PLEUEL_OK;
  job->message[0] = '\0';
  return NULL;
}

// Those of all sets, and of the coordinates that are proposed for them.
static pl_analysis** all_analyses(pl_analysis* first, int* n) {
  pl_analysis** out = PL_ARRAY(first->arena, pl_analysis*, 3 * first->sets.n);
  *n = 0;
  for (int k = 0; k < first->sets.n; k++) {
    pl_analysis* d = first->sets.at[k];
    pl_analysis* proposed = d->proposal ? pl_propose(d) : NULL;
    out[(*n)++] = d;
    if (proposed) out[(*n)++] = proposed;
    pl_analysis* at_rest = d->proposal_for_rest ? pl_propose_for_rest(d) : NULL;
    if (at_rest && at_rest != proposed) out[(*n)++] = at_rest;
  }
  return out;
}

static pleuel_status derive(pl_analysis* d) {
  double since = pl_cpu_ms();
  d->first = d;
  d->has_section = true;
  pl_push(d->arena, d->sets, d);
  PL_TRY(derive_motion(d, true, &since));
  d->solution->dof = d->dof;
  list_hidden(d);
  pl_note_equilibrium_start(d);
  pl_note_undecided(d);
  if (d->options->structure) return PLEUEL_OK;
  pleuel_status status = answer_all(d);
  int n;
  pl_analysis** all = all_analyses(d, &n);
  for (int k = 0; k < n; k++) pl_spread_assemblies(all[k]);
  for (int k = 0; k < d->sets.n; k++) pl_define_proposed(d->sets.at[k]);
  pass(d, PL_D_PRESENTATION, &since);
  for (int k = 0; k < n; k++) pl_claims_check(all[k]);
  pass(d, PL_D_CERTIFICATES, &since);
  list_assumptions(d, all, n);
  return status;
}

// The pattern of a family has no answer for one of its members.
static bool asks_for_a_member(const pl_model* m) {
  for (int i = 0; i < m->asks.n; i++) {
    pl_ask_kind kind = m->asks.at[i].kind;
    if (kind == PL_ASK_SOLVE || kind == PL_ASK_FORCE_OF || kind == PL_ASK_FORCE_ON) return true;
  }
  return false;
}

pleuel_status pl_derive(pl_job* job, pl_model* model, const pl_derive_options* options,
                        pl_solution** out) {
  pl_model* flat = NULL;
  int most = asks_for_a_member(model) ? largest_for_a_member : largest_expansion;
  pleuel_status status = pl_model_expand(job, model, most, &flat);
  bool families = status == PLEUEL_UNSUPPORTED;  // too large to be written out: by pattern
  if (families) {
    flat = model;
    job->status = PLEUEL_OK;
    job->message[0] = 0;
  }
  if (!families && status != PLEUEL_OK) return status;
  static const pl_derive_options plain = {0};
  if (!options) options = &plain;
  *out = PL_NEW(job->arena, pl_solution);
  (*out)->model = flat;
  const pl_stage* stage = options->n_stages > 0 ? &options->stages[0] : NULL;
  if (!families) return derive(analysis(job, flat, options, *out, stage));
  pl_analysis* d = PL_NEW(job->arena, pl_analysis);
  *d = (pl_analysis){.job = job,
                     .arena = job->arena,
                     .pool = flat->pool,
                     .model = flat,
                     .options = options,
                     .solution = *out};
  d->told = pl_map_make(job->arena);
  d->began_ms = pl_cpu_ms();
  return pl_derive_families(d);
}

void pl_solution_close(pl_solution* s) {
  for (int k = 0; s && k < s->towers.n; k++) pl_tower_free(s->towers.at[k]);
  if (s) s->towers.n = 0;
}

void pl_derive_dump(pl_text* out, const pl_solution* s) {
  const pl_pool* p = s->model->pool;
  for (int k = 0; k < s->sections.n; k++) {
    const pl_section* section = &s->sections.at[k];
    pl_text_addf(out, "[%s] %s\n", section->letter ? section->letter : "-",
                 section->item ? section->item : "");
    for (int v = 0; v < section->values.n; v++) {
      const pl_value* value = &section->values.at[v];
      if (!pl_is_poison(value->expr))
        pl_text_addf(out, "  %s = %s\n", value->name, pl_expr_text(out->arena, p, value->expr));
      for (int c = 0; c < value->n_components; c++) {
        pl_text_addf(out, "  %s . %s = %s\n", value->name, value->components[c].along,
                     pl_expr_text(out->arena, p, value->components[c].expr));
      }
    }
  }
}
