// Another number for a parameter or a start value, and what then has to be looked at again.
#include "model_impl.h"

#include <string.h>

static bool is_start_target(const pl_model* m, pl_expr target, pl_symbol s) {
  return pl_kind_of(m->pool, target) == PL_SYMBOL && pl_symbol_of(m->pool, target).id == s.id;
}

static pleuel_status set_param(pl_job* job, pl_model* m, pl_param* p, pl_expr value) {
  const pl_symbol_info* info = pl_symbol_get(m->pool, p->symbol);
  if (pl_has_symbol(m->pool, value, p->symbol)) {
    return pl_fail(job, PLEUEL_USAGE, "%s cannot be set to an expression of itself", info->name);
  }
  pl_dimension x;
  bool with_unit = pl_unit_occurs(m->pool, value);
  if (with_unit && info->dimension_known && pl_known_dimension(m, value, &x)
      && !pl_dimension_equal(x, info->dimension)) {
    return pl_fail(job, PLEUEL_USAGE, "%s is %s, but the value set is %s", info->name,
                   pl_dimension_words(job->arena, info->dimension, job->lang),
                   pl_dimension_words(job->arena, x, job->lang));
  }
  p->value = m->checked ? pl_unit_to_si(m->pool, value) : value;
  return PLEUEL_OK;
}

// Sign follows the number (classify.c), family sizes are looked at again.
static pleuel_status settle_after_set(pl_job* job, pl_model* m) {
  if (!m->checked) return PLEUEL_OK;
  int before = job->diagnostics ? job->diagnostics->n_errors : 0;
  pl_classify_symbols(m);
  if (pl_check_sizes(job, m)) pl_check_families(job, m);
  pl_check_numbers(job, m);
  pl_check_inertia(job, m);
  return job->diagnostics && job->diagnostics->n_errors > before ? PLEUEL_MODEL_ERROR : PLEUEL_OK;
}

pleuel_status pl_model_set(pl_job* job, pl_model* m, const char* name, pl_expr value) {
  if (pl_is_poison(value))
    return pl_fail(job, PLEUEL_USAGE, "the value for %s cannot be computed", name);
  for (int i = 0; i < m->params.n; i++) {
    const pl_symbol_info* info = pl_symbol_get(m->pool, m->params.at[i].symbol);
    if (m->params.at[i].literal) continue;
    if (strcmp(info->ascii, name) != 0 && strcmp(info->name, name) != 0) continue;
    PL_TRY(set_param(job, m, &m->params.at[i], value));
    return settle_after_set(job, m);
  }
  // a start value: x1=..., x1_dot=...
  pl_symbol s = pl_symbol_find(m->pool, name);
  pl_role role = s.id ? pl_symbol_get(m->pool, s)->role : PL_R_PARAM;
  if (role != PL_R_COORD && role != PL_R_VELOCITY)
    return pl_fail(job, PLEUEL_USAGE, "no parameter is named %s", name);
  pl_expr plain = m->checked ? pl_unit_to_si(m->pool, value) : value;
  for (int i = 0; i < m->inits.n; i++) {
    if (!m->inits.at[i].guess && is_start_target(m, m->inits.at[i].target, s)) {
      m->inits.at[i].value = plain;
      return PLEUEL_OK;
    }
  }
  pl_push(pl_pool_arena(m->pool), m->inits,
          (pl_init){.target = pl_sym(m->pool, s), .value = plain});
  return PLEUEL_OK;
}
