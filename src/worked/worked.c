// worked: the derivation from end to end, and the requests answered in order.
#include <string.h>

#include "mechanics/propose.h"
#include "worked/worked_impl.h"

// coordinates up to which a family is written out and derived member by member
static const int largest_expansion = 24;
// the same when a multiplier, an acceleration or a force of a member is asked for
static const int largest_for_a_member = 80;

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
  if (!d->page->section || d->page->section->item != ask->text)
    pl_section_open(d, ask, ask->text, ask->text);
  pl_say(d,
         "Friction acts here, with a force that jumps between sticking and slipping: no formula is "
         "given. The simulation computes the motion.",
         "Hier wirkt Reibung, deren Kraft zwischen Haften und Gleiten springt: keine Formel. Die "
         "Simulation berechnet die Bewegung.",
         0);
  d->page->section->not_found = true;
}

static void note_friction(pl_analysis* d) {
  if (pl_knows_friction(d) || d->page->options->structure) return;
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
  d->page->section->not_found = true;
  if (ask->kind == PL_ASK_EQUILIBRIA) show_rest(d);
}

// ------------------------------------------------------------------------------- which coordinates
static bool of_forces(pl_analysis* d, pl_expr e) {
  return pl_has_role(d->pool, e, PL_R_ACCELERATION) || pl_has_role(d->pool, e, PL_R_MULTIPLIER)
         || pl_has_role(d->pool, e, PL_R_LOCAL);
}

// What is answered in generalized coordinates. Multipliers, accelerations and forces stay in the
// coordinates of the model, where
// these have a closed form and no motion is named.
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
  pl_analysis* a = rest ? pl_page_propose_for_rest(d) : pl_page_propose(d);
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
  int n = d->page->solution->sections.n;
  // another analysis may have written it
  d->page->section = n > 0 ? &d->page->solution->sections.at[n - 1] : NULL;
  if (pl_answer_open(d, ask)) return;
  ask = pl_without_open(d, ask);
  pl_analysis* base = d;
  pl_analysis* a = pl_serving(d, ask);
  pl_ask own = in_its_coordinates(a, ask);
  if (own.motion.given && (base = pl_analysis_around(d, a, &own.motion)) != d) {
    a = pl_serving(base, ask);
    own = in_its_coordinates(a, ask);
  }
  a->page->base = base;
  a->page->section = d->page->section;
  a->page->open_told = d->page->open_told;
  a->stage = d->stage;
  answer_with(a, &own);
  d->page->section = a->page->section;
  d->page->open_told = a->page->open_told;
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
  const pl_analysis* a = d->reduced ? d : pl_page_propose(d);
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
    if (!wanted(d->page->options, ask)) continue;
    pl_analysis* of = pl_analysis_of(d, ask);
    pl_answer_one(of ? of : d, ask);
    pl_answer_closed(d, ask);
  }
  pl_answer_stages(d);
  return PLEUEL_OK;
}

// --------------------------------------------------------------------------------------- the whole
static void list_hidden(pl_analysis* d) {
  for (int k = 0; k < d->hidden.n; k++) {
    const pl_variable* c = &d->q.at[d->hidden.at[k]];
    pl_push(d->arena, d->page->solution->hidden, pl_sub(d->pool, pl_sym(d->pool, c->q), c->map));
  }
}

static pl_analysis* open_analysis(pl_job* job, pl_model* whole, const pl_derive_options* options,
                                  pl_solution* solution, const pl_stage* stage) {
  pl_analysis* d = pl_analysis_open(job, whole, stage, &solution->towers);
  pl_page_open(d, options, solution);
  return d;
}

// The time since *since goes to the stage.
static void pass(pl_analysis* d, pl_derive_stage stage, double* since) {
  double now = pl_cpu_ms();
  d->page->solution->cpu_ms[stage] += now - *since;
  *since = now;
}

pl_analysis* pl_analysis_make(const pl_analysis* like, const pl_stage* stage) {
  pl_job* job = like->job;
  pl_analysis* d = open_analysis(job, like->whole, like->page->options, like->page->solution,
                                 stage);
  d->page->first = like->page->first;
  int messages = job->diagnostics->list.n, errors = job->diagnostics->n_errors;
  if (pl_derive_motion(d, d->page->solution->cpu_ms) == PLEUEL_OK) {
    pl_page_prepare(d);
    return d;
  }
  job->diagnostics->list.n = messages;  // a set that does not fit is no fault of the model
  job->diagnostics->n_errors = errors;
  job->status = PLEUEL_OK;
  job->message[0] = '\0';
  return NULL;
}

// Those of all sets, and of the coordinates that are proposed for them.
static pl_analysis** all_analyses(pl_analysis* first, int* n) {
  pl_analysis** out = PL_ARRAY(first->arena, pl_analysis*, 3 * first->page->sets.n);
  *n = 0;
  for (int k = 0; k < first->page->sets.n; k++) {
    pl_analysis* d = first->page->sets.at[k];
    pl_analysis* proposed = d->proposal ? pl_page_propose(d) : NULL;
    out[(*n)++] = d;
    if (proposed) out[(*n)++] = proposed;
    pl_analysis* at_rest = d->proposal_for_rest ? pl_page_propose_for_rest(d) : NULL;
    if (at_rest && at_rest != proposed) out[(*n)++] = at_rest;
  }
  return out;
}

static const char* const claim_name[PL_N_CLAIMS + 1][2] = {
    [PL_CLAIM_MOTION] = {"accelerations and multipliers against d'Alembert",
                         "Beschleunigungen und Multiplikatoren gegen d'Alembert"},
    [PL_CLAIM_ONE_TWO] = {"Lagrange I against II", "Lagrange I gegen II"},
    [PL_CLAIM_MAP] = {"constraints vanish identically", "Zwangsbedingungen verschwinden identisch"},
    [PL_CLAIM_ENERGY] = {"energies against the Cartesian ones", "Energien gegen die kartesischen"},
    [PL_CLAIM_INSERTED] = {"solutions inserted", "Lösungen eingesetzt"},
    [PL_CLAIM_OTHER] = {"other formulas", "weitere Formeln"},
    [PL_N_CLAIMS] = {"units", "Einheiten"},
};

static void check_claims(pl_analysis* d) {
  pl_claim_loops(d);
  pl_claims_check(d, &d->page->claims, claim_name, &d->page->solution->checks);
}

static pleuel_status derive(pl_analysis* d) {
  d->page->first = d;
  d->page->has_section = true;
  pl_push(d->arena, d->page->sets, d);
  pleuel_status formed = pl_derive_motion(d, d->page->solution->cpu_ms);
  if (formed == PLEUEL_CONTRADICTION) return pl_report_contradiction(d);
  PL_TRY(formed);
  double since = pl_cpu_ms();
  pl_page_prepare(d);
  pl_describe_constraints(d);
  d->page->solution->dof = d->dof;
  list_hidden(d);
  pl_note_equilibrium_start(d);
  pl_note_undecided(d);
  if (d->page->options->structure) return PLEUEL_OK;
  pleuel_status status = answer_all(d);
  int n;
  pl_analysis** all = all_analyses(d, &n);
  for (int k = 0; k < n; k++) pl_spread_assemblies(all[k]);
  for (int k = 0; k < d->page->sets.n; k++) pl_define_proposed(d->page->sets.at[k]);
  pass(d, PL_D_PRESENTATION, &since);
  for (int k = 0; k < n; k++) check_claims(all[k]);
  pass(d, PL_D_CERTIFICATES, &since);
  pl_list_assumptions(d, all, n);
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
  if (!families) return derive(open_analysis(job, flat, options, *out, stage));
  pl_analysis* d = PL_NEW(job->arena, pl_analysis);
  *d = (pl_analysis){.job = job,
                     .arena = job->arena,
                     .pool = flat->pool,
                     .model = flat,
                     .towers = &(*out)->towers,
                     .contradicting = -1};
  pl_page_open(d, options, *out);
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
