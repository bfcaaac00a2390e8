// Names that nothing uses, coordinates without mass, masses that stand still: mostly slips of the
// pen, told as notes.
#include "model_impl.h"

typedef struct use_table {
  pl_model* m;
  pl_arena* arena;
  unsigned* uses;  // by symbol id: a bit for each kind of slot
  pl_slot_kind kind;
  const pl_param* self;  // a parameter's own value does not count as its use
} use_table;

enum { BIT_INERTIA = 1 << 30, BIT_CHOSEN = 1 << 29, BIT_PUSHED = 1 << 28 };

static void use_symbol(use_table* t, pl_symbol s, unsigned bit) {
  if (!s.id) return;
  const pl_symbol_info* info = pl_symbol_get(t->m->pool, s);
  t->uses[s.id] |= bit;
  if (info->base.id) t->uses[info->base.id] |= bit;
}

static void use_expr(use_table* t, pl_expr e, unsigned bit, pl_map* visited) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return;
  pl_map_set(visited, e.id, 1);
  pl_kind kind = pl_kind_of(t->m->pool, e);
  if (kind == PL_SYMBOL || kind == PL_AT) use_symbol(t, pl_symbol_of(t->m->pool, e), bit);
  for (int i = 0; i < pl_n_args(t->m->pool, e); i++)
    use_expr(t, pl_arg(t->m->pool, e, i), bit, visited);
}

static void see_slot(void* user, const pl_slot* slot) {
  use_table* t = user;
  use_expr(t, *slot->at, 1u << slot->kind, pl_map_make(t->arena));
}

static void use_inertia(use_table* t, pl_expr e) {
  use_expr(t, e, BIT_INERTIA, pl_map_make(t->arena));
}

static void see_inertia(use_table* t) {
  const pl_model* m = t->m;
  for (int i = 0; i < m->masses.n; i++) {
    for (int k = 0; k < m->masses.at[i].point.n && k < 3; k++)
      use_inertia(t, m->masses.at[i].point.at[k]);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    use_inertia(t, m->bodies.at[i].angle);
    for (int k = 0; k < m->bodies.at[i].centre.n && k < 3; k++)
      use_inertia(t, m->bodies.at[i].centre.at[k]);
  }
  for (int i = 0; i < m->loads.n; i++) {
    pl_load_kind k = m->loads.at[i].kind;
    if (k == PL_L_KINETIC || k == PL_L_LAGRANGIAN) use_inertia(t, m->loads.at[i].value);
    use_symbol(t, m->loads.at[i].coordinate, BIT_PUSHED);
  }
  for (int i = 0; i < m->choose.coords.n; i++) use_symbol(t, m->choose.coords.at[i], BIT_CHOSEN);
  for (int i = 0; i < m->choose.n_maps; i++) {
    use_expr(t, m->choose.maps[i].old, BIT_CHOSEN, pl_map_make(t->arena));
    use_expr(t, m->choose.maps[i].map, BIT_CHOSEN, pl_map_make(t->arena));
  }
  for (int i = 0; i < m->asks.n; i++) {
    use_symbol(t, m->asks.at[i].variable, 1u << PL_SLOT_ASK);
    for (int k = 0; k < m->asks.at[i].frame.n; k++)
      use_symbol(t, m->asks.at[i].frame.at[k], 1u << PL_SLOT_ASK);
  }
}

static const unsigned in_physics = 1u << PL_SLOT_POINT | 1u << PL_SLOT_MASS | 1u << PL_SLOT_LOAD
                                   | 1u << PL_SLOT_CONSTRAINT | 1u << PL_SLOT_CHOOSE | BIT_CHOSEN
                                   | BIT_INERTIA | BIT_PUSHED;

// The name in its declaration, for `coord x, y, z` has one span.
static pl_span name_place(const pl_model* m, pl_symbol s, pl_span span) {
  pl_span at;
  return pl_span_find_name(span, pl_symbol_get(m->pool, s)->ascii, &at) ? at : span;
}

// --------------------------------------------------------------------- chosen, but tied to nothing
// a x^2 + a y^2 - a r^2 in the two coordinates: the radius; poison for any other expression.
static pl_expr radius_in(pl_job* job, const pl_model* m, pl_expr g, pl_symbol x, pl_symbol y) {
  pl_pool* p = m->pool;
  pl_expr gx = pl_diff(p, g, x), gy = pl_diff(p, g, y), a = pl_diff(p, gx, x), zero = pl_int(p, 0);
  if (!pl_same(a, pl_diff(p, gy, y)) || !pl_is_zero_node(p, pl_diff(p, gx, y))
      || pl_has_coordinate(p, a, job->arena))
    return pl_poison();
  pl_replace centre[2] = {{x, zero}, {y, zero}};
  pl_expr rest = pl_subst(p, g, centre, 2);
  if (!pl_is_zero_node(p, pl_subst(p, gx, centre, 2))
      || !pl_is_zero_node(p, pl_subst(p, gy, centre, 2)))
    return pl_poison();
  if (pl_is_zero_node(p, a) || pl_has_coordinate(p, rest, job->arena)) return pl_poison();
  pl_expr square = pl_neg(p, pl_div(p, pl_mul(p, pl_int(p, 2), rest), a));
  long power = 0;
  if (pl_kind_of(p, square) == PL_POW) pl_is_int(p, pl_arg(p, square, 1), &power);
  return power == 2 ? pl_arg(p, square, 0) : pl_sqrt(p, square);
}

// "choose φ with x1 = r cos φ, z1 = r sin φ" where a constraint makes it possible.
static const char* choice_for(pl_job* job, const pl_model* m, const char* name) {
  for (int k = 0; k < m->constraints.n; k++) {
    for (int i = 0; i < m->coords.n; i++) {
      for (int j = i + 1; j < m->coords.n; j++) {
        pl_symbol x = m->coords.at[i].symbol, y = m->coords.at[j].symbol;
        pl_expr g = m->constraints.at[k].g;
        if (pl_is_poison(g) || !pl_has_symbol(m->pool, g, x) || !pl_has_symbol(m->pool, g, y))
          continue;
        pl_expr r = radius_in(job, m, g, x, y);
        if (pl_is_poison(r)) continue;
        const char *radius = pl_expr_words(job->arena, m->pool, r),
                   *a = pl_symbol_get(m->pool, x)->name, *b = pl_symbol_get(m->pool, y)->name;
        return pl_format(job->arena, "choose %s with %s = %s cos %s, %s = %s sin %s", name, a,
                         radius, name, b, radius, name);
      }
    }
  }
  return NULL;
}

static void check_chosen(pl_job* job, use_table* t) {
  static const unsigned tied = 1u << PL_SLOT_POINT | 1u << PL_SLOT_MASS | 1u << PL_SLOT_CONSTRAINT
                               | 1u << PL_SLOT_CHOOSE | BIT_INERTIA;
  const pl_model* m = t->m;
  for (int i = 0; i < m->choose.coords.n; i++) {
    pl_symbol q = m->choose.coords.at[i];
    if (t->uses[q.id] & tied) continue;
    const char *name = pl_symbol_get(m->pool, q)->name, *choice = choice_for(job, m, name);
    pl_diagnostic* d = pl_tell(
        job, PL_E058, m->choose.span,
        PL_BOTH_FORMAT(job->arena, "%s is chosen, but nothing ties it to the other coordinates",
                       name));
    if (choice) pl_report_fix(d, PL_BOTH_FORMAT(job->arena, "write  %s", choice), choice);
    else
      pl_report_fix(d, PL_F(job, "choose %s with x = ... %s ...", name, name),
                    PL_F(job, "choose %s with x = ... %s ...", name, name), NULL);
  }
}

static void check_coordinates(pl_job* job, use_table* t) {
  const pl_model* m = t->m;
  bool dynamic = m->masses.n || m->bodies.n;
  for (int i = 0; i < m->loads.n; i++)
    dynamic |= m->loads.at[i].kind == PL_L_KINETIC || m->loads.at[i].kind == PL_L_LAGRANGIAN;
  for (int i = 0; i < m->coords.n; i++) {
    pl_symbol q = m->coords.at[i].symbol;
    const char* name = pl_symbol_get(m->pool, q)->name;
    pl_span at = name_place(m, q, m->coords.at[i].span);
    if (!(t->uses[q.id] & in_physics)) {
      pl_diagnostic* d = pl_tell(
          job, PL_N062, at,
          PL_BOTH_FORMAT(job->arena,
                         "%s is declared, but no mass, force or constraint speaks of it", name));
      pl_report_fix(d, PL_BOTH_FORMAT(job->arena, "remove %s, or use it", name), NULL);
    } else if (dynamic && !(t->uses[q.id] & (BIT_INERTIA | BIT_CHOSEN))) {
      pl_diagnostic* d = pl_tell(
          job, PL_N067, at,
          PL_BOTH_FORMAT(job->arena,
                         "%s carries no mass: its motion has to follow from constraints or forces",
                         name));
      pl_report_fix(d, PL_BOTH("let a mass or body depend on it, or leave it as it is"), NULL);
    }
  }
}

static void check_params(pl_job* job, use_table* t) {
  for (int i = 0; i < t->m->params.n; i++) {
    if (t->m->params.at[i].literal) continue;
    const pl_param* p = &t->m->params.at[i];
    if (t->uses[p->symbol.id]) continue;
    const char* name = pl_symbol_get(t->m->pool, p->symbol)->name;
    pl_diagnostic* d = pl_tell(
        job, PL_N063, name_place(t->m, p->symbol, p->span),
        PL_BOTH_FORMAT(job->arena, "%s is given, but nothing uses it", name));
    pl_report_fix(d, PL_BOTH_FORMAT(job->arena, "remove %s, or look for a slip of the pen", name),
                  NULL);
  }
}

// The centre of a body in space may rest while it turns.
static bool turns(const pl_model* m, const pl_mass* x) {
  for (int i = 0; i < m->spatials.n; i++) {
    if (m->spatials.at[i].name.text == x->name.text && m->spatials.at[i].block == x->block)
      return true;
  }
  return false;
}

static void check_still_masses(pl_job* job, const pl_model* m) {
  for (int i = 0; i < m->masses.n; i++) {
    const pl_mass* x = &m->masses.at[i];
    bool still = x->point.n > 0;
    for (int k = 0; k < x->point.n && k < 3; k++) {
      pl_expr e = x->point.at[k];
      if (pl_is_poison(e) || pl_has_coordinate(m->pool, e, job->arena)
          || pl_has_symbol(m->pool, e, pl_time(m->pool)))
        still = false;
    }
    if (!still || turns(m, x)) continue;
    pl_diagnostic* d = pl_tell(
        job, PL_N065, x->span,
        PL_BOTH("this mass does not move: its point contains no coordinate"));
    pl_report_fix(d, PL_BOTH("a fixed point is written: point A at (x, y)"), NULL);
  }
}

// Statements that this version does not know may use what seems unused here; so may errors.
void pl_check_use(pl_job* job, pl_model* m) {
  if (m->pending.n || job->diagnostics->n_errors) return;
  use_table t = {.m = m,
                 .arena = job->arena,
                 .uses = PL_ARRAY(job->arena, unsigned, pl_symbol_count(m->pool) + 1)};
  pl_model_each_slot(m, see_slot, &t);
  see_inertia(&t);
  check_chosen(job, &t);
  check_coordinates(job, &t);
  check_params(job, &t);
  check_still_masses(job, m);
}
