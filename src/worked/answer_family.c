// answer_family: models whose families are too large to be written out. The Lagrange equations of
// the first kind are derived
// once for a member with index i: each pattern (mass, potential, constraint) that contains x[k + c]
// contributes to the equation
// of x[i] with k = i - c, where its range allows; ranges with the same contributions share one
// equation.
#include <math.h>
#include <string.h>

#include "worked/worked_impl.h"

// A pattern: part of L, or a constraint with its multiplier.
typedef struct pl_motif {
  const pl_block* block;  // NULL: one instance
  pl_expr L;              // T - V of one member; poison for a constraint
  pl_expr g;              // of one member; poison for a part of L
  pl_expr lambda;         // its multiplier, an element of a family for c[1] and c[i]
} pl_motif;

// It contributes through the element array[k + shift] (or array[shift] without block) for i in
// lo..hi.
typedef struct pl_contribution {
  const pl_motif* motif;
  pl_expr element;
  long shift, lo, hi;
} pl_contribution;

typedef struct pl_family_pass {
  pl_analysis* d;
  PL_VEC(pl_motif) motifs;
  PL_VEC(pl_contribution) list;  // of the array at hand
  pl_symbol i;                   // running index of what is printed
} pl_family_pass;

// ---------------------------------------------------------------------------------------- patterns
static pl_expr speed_squared(pl_pool* p, const pl_point* at) {
  pl_expr sum = pl_int(p, 0);
  for (int c = 0; c < at->n; c++) sum = pl_add(p, sum, pl_square(p, pl_dt(p, at->at[c])));
  return sum;
}

static void mass_motif(pl_family_pass* f, const pl_mass* m) {
  pl_pool* p = f->d->pool;
  pl_expr L = pl_mul_n(p, (pl_expr[]){pl_ratio(p, 1, 2), m->mass, speed_squared(p, &m->point)}, 3);
  for (int k = 0; k < f->d->model->gravities.n; k++) {
    const pl_gravity* g = &f->d->model->gravities.at[k];
    if (g->axis >= m->point.n) continue;
    L = pl_add(
        p, L, pl_mul_n(p, (pl_expr[]){pl_int(p, g->sign), m->mass, g->g, m->point.at[g->axis]}, 4));
  }
  pl_push(f->d->arena, f->motifs, (pl_motif){.block = m->block, .L = L});
}

static pl_expr multiplier(pl_analysis* d, const pl_constraint* c) {
  return pl_is_poison(c->name.index) ? pl_sym(d->pool, c->lambda)
                                     : pl_at(d->pool, c->lambda, 0, c->name.index);
}

static bool collect_motifs(pl_family_pass* f) {
  pl_model* m = f->d->model;
  for (int k = 0; k < m->masses.n; k++) mass_motif(f, &m->masses.at[k]);
  for (int k = 0; k < m->loads.n; k++) {
    const pl_load* l = &m->loads.at[k];
    if (l->kind != PL_L_POTENTIAL && l->kind != PL_L_KINETIC) return false;
    pl_expr L = l->kind == PL_L_KINETIC ? l->value : pl_neg(f->d->pool, l->value);
    pl_push(f->d->arena, f->motifs, (pl_motif){.block = l->block, .L = L});
  }
  for (int k = 0; k < m->constraints.n; k++) {
    const pl_constraint* c = &m->constraints.at[k];
    if (c->off || c->has_velocity) return false;
    pl_push(f->d->arena, f->motifs,
            (pl_motif){.block = c->block, .g = c->g, .lambda = multiplier(f->d, c)});
  }
  for (int k = 0; k < f->motifs.n; k++) {
    if (f->motifs.at[k].block && f->motifs.at[k].block->outer) return false;  // nested ranges
  }
  return m->bodies.n == 0;
}

// --------------------------------------------------------------------------------- who contributes
static bool whole(pl_analysis* d, pl_expr e, long* out) {
  double x = pl_number(d, e);
  if (isnan(x) || fabs(x) > 1e9 || x != floor(x)) return false;
  *out = (long)x;
  return true;
}

static void elements(pl_analysis* d, pl_expr e, pl_symbol array, pl_map* seen, pl_expr* out, int* n,
                     int max) {
  if (pl_is_poison(e) || pl_map_get(seen, e.id)) return;
  pl_map_set(seen, e.id, 1);
  if (pl_kind_of(d->pool, e) == PL_AT) {
    if (pl_symbol_of(d->pool, e).id != array.id) return;
    pl_expr position = pl_at(d->pool, array, 0, pl_arg(d->pool, e, 0));
    for (int k = 0; k < *n; k++) {
      if (pl_same(out[k], position)) return;
    }
    if (*n < max) out[(*n)++] = position;
    return;
  }
  for (int k = 0; k < pl_n_args(d->pool, e); k++)
    elements(d, pl_arg(d->pool, e, k), array, seen, out, n, max);
}

static bool contribute(pl_family_pass* f, const pl_motif* m, pl_expr element) {
  pl_analysis* d = f->d;
  pl_contribution c = {.motif = m, .element = element};
  pl_expr index = pl_arg(d->pool, element, 0);
  if (m->block && pl_has_symbol(d->pool, index, m->block->index)) {
    long lo, hi;
    if (!whole(d, pl_sub(d->pool, index, pl_sym(d->pool, m->block->index)), &c.shift)) return false;
    if (!whole(d, m->block->lo, &lo) || !whole(d, m->block->hi, &hi)) return false;
    c.lo = lo + c.shift;
    c.hi = hi + c.shift;
  } else {
    if (m->block || !whole(d, index, &c.shift)) return false;
    c.lo = c.hi = c.shift;
  }
  pl_push(d->arena, f->list, c);
  return true;
}

static bool contributions(pl_family_pass* f, pl_symbol array) {
  f->list.n = 0;
  for (int k = 0; k < f->motifs.n; k++) {
    const pl_motif* m = &f->motifs.at[k];
    pl_expr found[16];
    int n = 0;
    elements(f->d, pl_is_poison(m->L) ? m->g : m->L, array, pl_map_make(f->d->arena), found, &n,
             16);
    for (int j = 0; j < n; j++) {
      if (!contribute(f, m, found[j])) return false;
    }
  }
  return true;
}

// ------------------------------------------------------------------------------------ one equation
// Elements become plain names: x[i-1]'' is the symbol "x[i - 1]" with two dots, so that algebra and
// notation treat it as any other.
static pl_symbol element_name(pl_analysis* d, pl_expr element) {
  pl_symbol_info info = *pl_symbol_get(d->pool, pl_symbol_of(d->pool, element));
  bool multiplier = info.role == PL_R_MULTIPLIER;
  const char* index = pl_expr_text(d->arena, d->pool, pl_arg(d->pool, element, 0));
  info.name = pl_format(d->arena, "%s[%s]", info.name, index);
  info.ascii = pl_format(d->arena, "%s[%s]", info.ascii, index);
  info.role = multiplier ? PL_R_MULTIPLIER : PL_R_COORD;
  info.class = multiplier ? PL_C_MULTIPLIER : PL_C_COORD;
  info.dots = 0;
  info.base = info.up = (pl_symbol){0};
  return pl_symbol_make(d->pool, &info);
}

typedef PL_VEC(pl_expr) pl_elements;

static void list_elements(pl_analysis* d, pl_expr e, pl_map* seen, pl_elements* out) {
  if (pl_is_poison(e) || pl_map_get(seen, e.id)) return;
  pl_map_set(seen, e.id, 1);
  if (pl_kind_of(d->pool, e) == PL_AT) pl_push(d->arena, *out, e);
  for (int k = 0; k < pl_n_args(d->pool, e); k++)
    list_elements(d, pl_arg(d->pool, e, k), seen, out);
}

static pl_expr named(pl_analysis* d, pl_expr e) {
  pl_elements all = {0};
  list_elements(d, e, pl_map_make(d->arena), &all);
  for (int k = 0; k < all.n; k++) {
    pl_symbol s = element_name(d, all.at[k]);
    for (int j = 0; j < pl_dots_of(d->pool, all.at[k]); j++) s = pl_symbol_dot(d->pool, s);
    e = pl_subst_expr(d->pool, e, all.at[k], pl_sym(d->pool, s));
  }
  return e;
}

// The running index of a pattern, moved so that its element is member i.
static pl_expr shifted(pl_family_pass* f, const pl_contribution* c, pl_expr e, pl_expr i) {
  pl_pool* p = f->d->pool;
  if (!c->motif->block) return e;
  return pl_subst1(p, e, c->motif->block->index, pl_sub(p, i, pl_int(p, c->shift)));
}

static pl_expr euler_part(pl_family_pass* f, const pl_contribution* c, pl_expr i) {
  pl_pool* p = f->d->pool;
  pl_symbol array = pl_symbol_of(p, c->element);
  pl_expr velocity = pl_at(p, array, 1, pl_arg(p, c->element, 0));
  pl_expr e = pl_sub(p, pl_dt(p, pl_diff_at(p, c->motif->L, velocity)),
                     pl_diff_at(p, c->motif->L, c->element));
  return shifted(f, c, e, i);
}

static pl_expr push_part(pl_family_pass* f, const pl_contribution* c, pl_expr i) {
  pl_pool* p = f->d->pool;
  pl_expr slope = pl_diff_at(p, c->motif->g, c->element);
  return shifted(
      f, c, pl_mul(p, c->motif->lambda, f->d->model->lambda_minus ? pl_neg(p, slope) : slope), i);
}

static pl_expr rest_of(pl_analysis* d, pl_expr e) {  // without accelerations
  int n = pl_symbols_in(d->pool, e, NULL, 0), m = 0;
  pl_symbol* s = PL_ARRAY(d->arena, pl_symbol, n + 1);
  pl_replace* zero = PL_ARRAY(d->arena, pl_replace, n + 1);
  pl_symbols_in(d->pool, e, s, n);
  for (int k = 0; k < n; k++) {
    if (pl_symbol_get(d->pool, s[k])->role == PL_R_ACCELERATION)
      zero[m++] = (pl_replace){s[k], pl_int(d->pool, 0)};
  }
  return pl_subst(d->pool, e, zero, m);
}

static void show_equation(pl_family_pass* f, long lo, long hi) {
  pl_analysis* d = f->d;
  pl_expr i = lo == hi ? pl_int(d->pool, lo) : pl_sym(d->pool, f->i), euler = pl_int(d->pool, 0);
  const pl_form** part = PL_ARRAY(d->arena, const pl_form*, f->list.n + 1);
  int n = 1;
  for (int k = 0; k < f->list.n; k++) {
    const pl_contribution* c = &f->list.at[k];
    if (c->lo > lo || c->hi < hi) continue;
    if (pl_is_poison(c->motif->L)) {
      part[n++] = pl_f(d, named(d, push_part(f, c, i)), PL_S_PLAIN);
    } else {
      euler = pl_add(d->pool, euler, euler_part(f, c, i));
    }
  }
  euler = named(d, euler);
  pl_expr force = rest_of(d, euler);
  part[0] = pl_f(d, pl_alg_normal(d->tower, pl_neg(d->pool, force)), PL_S_EQUATION);
  if (lo == hi) {
    pl_say(d, PL_BOTH_FORMAT(d->arena, "for i = %ld:", lo), 0);
  } else {
    pl_say(d, PL_BOTH_FORMAT(d->arena, "for i = %ld … %ld:", lo, hi), 0);
  }
  const pl_form* left = pl_f(d, pl_alg_normal(d->tower, pl_sub(d->pool, euler, force)),
                             PL_S_EQUATION);
  pl_show_numbered(d, pl_feq(d, left, pl_joined_sum(d, part, n)));
}

// Ranges over which the same patterns contribute.
static int ranges(const pl_family_pass* f, long lo, long hi, long* start, int max) {
  int n = 0;
  start[n++] = lo;
  for (;;) {  // smallest change above the last start
    long next = hi + 1;
    for (int k = 0; k < f->list.n; k++) {
      long edge[2] = {f->list.at[k].lo, f->list.at[k].hi + 1};
      for (int j = 0; j < 2; j++) {
        if (edge[j] > start[n - 1] && edge[j] < next) next = edge[j];
      }
    }
    if (next > hi || n == max) return n;
    start[n++] = next;
  }
}

static bool equations_of(pl_family_pass* f, const pl_coord* c) {
  long lo, hi, start[32];
  if (pl_is_poison(c->lo)) return true;  // a single coordinate beside families
  if (!whole(f->d, c->lo, &lo) || !whole(f->d, c->hi, &hi) || !contributions(f, c->symbol))
    return false;
  int n = ranges(f, lo, hi, start, 32);
  for (int k = 0; k < n; k++) show_equation(f, start[k], k + 1 < n ? start[k + 1] - 1 : hi);
  return true;
}

// ---------------------------------------------------------------------------------------- sections
static void lagrange1(pl_analysis* d, const pl_ask* ask) {
  bool minus = d->model->lambda_minus;
  pl_section_open(d, ask,
                  PL_BOTH(minus ? "Lagrange equations of the first kind, with Z = -Σ λ ∇g"
                                : "Lagrange equations of the first kind, with Z = Σ λ ∇g"));
  pl_family_pass f = {.d = d};
  pl_symbol_info info = {.name = "i", .ascii = "i", .role = PL_R_INDEX};
  f.i = pl_symbol_find(d->pool, "i");
  if (!f.i.id) f.i = pl_symbol_make(d->pool, &info);
  bool ok = collect_motifs(&f);
  for (int k = 0; ok && k < d->model->coords.n; k++) ok = equations_of(&f, &d->model->coords.at[k]);
  if (!ok) pl_answer_pending(d, ask);
}

static long count_instances(pl_analysis* d, const pl_block* b) {
  pl_instances in;
  if (!b) return 1;
  return pl_model_instances(d->job, d->model, b, &in) == PLEUEL_OK ? in.n : 0;
}

static void dof(pl_analysis* d, const pl_ask* ask) {
  pl_section_open(d, ask, PL_BOTH("Degrees of freedom"));
  const pl_dof* f = &d->page->solution->dof;
  bool contacts = false;
  pl_row(d, PL_BOTH("coordinates"), NULL, pl_format(d->arena, "%d", f->coordinates));
  for (int k = 0; k < d->model->constraints.n; k++) {
    const pl_constraint* c = &d->model->constraints.at[k];
    static const char* const signs[] = {[PL_EQ] = "=", [PL_GE] = "≥", [PL_LE] = "≤"};
    const pl_form* zero = pl_form_leaf(d->arena, pl_int(d->pool, 0));
    const pl_form* body = pl_frel(d, pl_difference_form(d, c->left, c->right), signs[c->relation],
                                  zero);
    contacts |= c->relation != PL_EQ;
    const char* label = pl_is_poison(c->name.index)
                            ? c->name.text
                            : pl_format(d->arena, "%s[%s]", c->name.text,
                                        pl_expr_text(d->arena, d->pool, c->name.index));
    pl_row(d, PL_BOTH(k ? "" : "constraints"), pl_feq(d, pl_fn(d, label), body),
           pl_format(d->arena, "-%ld", count_instances(d, c->block)));
  }
  pl_row(d, PL_BOTH("degrees of freedom"), NULL, pl_format(d->arena, "%d", f->dof));
  pl_say(d,
         PL_BOTH(
             "Counted, not tested for independence: the families are too large to be written out."),
         0);
  if (contacts) {
    pl_say(
        d,
        PL_BOTH(
            "One-sided constraints are counted as closed, each with λ on the side where it pushes; "
            "where one is open its λ is 0."),
        0);
  }
  pl_answer(d, "dof", pl_int(d->pool, f->dof), NULL);
}

pleuel_status pl_derive_families(pl_analysis* d) {
  d->tower = pl_tower_make(d->job, d->pool, NULL, 0);
  pl_push(d->arena, *d->towers, d->tower);
  pl_dof* f = &d->page->solution->dof;
  f->coordinates = pl_model_flat_coords(d->model, d->arena).n;
  for (int k = 0; k < d->model->constraints.n; k++)
    f->constraints += (int)count_instances(d, d->model->constraints.at[k].block);
  f->rank = f->constraints;
  f->dof = f->velocity_dof = f->coordinates - f->rank;
  static const pl_ask standard[2] = {{.kind = PL_ASK_DOF, .text = "dof"},
                                     {.kind = PL_ASK_LAGRANGE1, .text = "lagrange1"}};
  bool own = d->model->asks.n == 0;
  for (int k = 0; k < (own ? 2 : d->model->asks.n); k++) {
    const pl_ask* ask = own ? &standard[k] : &d->model->asks.at[k];
    if (ask->kind == PL_ASK_DOF) {
      dof(d, ask);
    } else if (ask->kind == PL_ASK_LAGRANGE1) {
      lagrange1(d, ask);
    } else {
      pl_answer_pending(d, ask);
    }
  }
  return PLEUEL_OK;
}
