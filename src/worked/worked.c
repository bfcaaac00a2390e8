// worked: the derivation from end to end, and the requests answered in order.
#include <string.h>

#include "mechanics/propose.h"
#include "worked/worked_impl.h"

// coordinates up to which a family is written out and derived member by member
static const int largest_expansion = 24;
// the same when a multiplier, an acceleration or a force of a member is asked for
static const int largest_for_a_member = 80;

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

static void note_friction(pl_analysis* d) {
  if (pl_knows_friction(d) || d->page->options->structure) return;
  pl_diagnostic* m = pl_report(
      d->job->diagnostics, PL_N091, d->model->frictions.at[0].span,
      PL_BOTH("friction is computed by the simulation, formulas are not derived with it"));
  pl_report_fix(m, PL_BOTH("without this line the formulas hold for smooth surfaces"), NULL);
}

static pleuel_status answer_all(pl_analysis* d) {
  note_friction(d);
  if (d->model->asks.n == 0) answer_standard(d);
  for (int k = 0; k < d->model->asks.n; k++) {
    pl_job_done(d->job, k, d->model->asks.n);
    if (pl_interrupted(d->job))
      return pl_fail(d->job, PLEUEL_INTERRUPTED, "stopped after %d of %d requests", k,
                     d->model->asks.n);
    const pl_ask* ask = &d->model->asks.at[k];
    if (!wanted(d->page->options, ask)) continue;
    pl_analysis* of = pl_analysis_of(d, ask);
    pl_answer_one(of ? of : d, ask);
    pl_answer_closed(d, ask);
    const pl_derive_options* o = d->page->options;
    bool goes_on = !o->ready || o->ready(o->ready_user, d->page->solution);
    if (!goes_on)
      return pl_fail(d->job, PLEUEL_INTERRUPTED, "stopped after %d of %d requests", k + 1,
                     d->model->asks.n);
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

// The time since *since goes to the stage.
static void pass(pl_analysis* d, pl_derive_stage stage, double* since) {
  double now = pl_cpu_ms();
  d->page->solution->cpu_ms[stage] += now - *since;
  *since = now;
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

static void check_claims(pl_analysis* d) {
  const char* const claim_name[PL_N_CLAIMS + 1][2] = {
      [PL_CLAIM_MOTION] = {PL_BOTH("accelerations and multipliers against d'Alembert")},
      [PL_CLAIM_ONE_TWO] = {PL_BOTH("Lagrange I against II")},
      [PL_CLAIM_MAP] = {PL_BOTH("constraints vanish identically")},
      [PL_CLAIM_ENERGY] = {PL_BOTH("energies against the Cartesian ones")},
      [PL_CLAIM_INSERTED] = {PL_BOTH("solutions inserted")},
      [PL_CLAIM_OTHER] = {PL_BOTH("other formulas")},
      [PL_N_CLAIMS] = {PL_BOTH("units")},
  };
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
  if (!families) return derive(pl_page_analysis(job, flat, options, *out, stage));
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
