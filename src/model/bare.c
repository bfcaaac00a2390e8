// Bare numbers in a model with units: `w - 0.5` with w a length means 0.5 m (note N021 says so).
// They become numbers with their unit, so that formulas show it and stay right in their
// dimensions. Needs known dimensions (dimensions.c).
#include "model_impl.h"

// A number that is a quantity of dimension x, in its SI unit; anything else stays.
static pl_expr dressed_number(pl_model* m, pl_expr e, pl_dimension x) {
  if (pl_is_poison(e) || !pl_is_constant(m->pool, e) || pl_is_zero_node(m->pool, e)) return e;
  if (pl_kind_of(m->pool, e) == PL_INFINITY || pl_dimension_equal(x, pl_dimension_one())) return e;
  pl_unit unit = {.dimension = x, .scale = pl_int(m->pool, 1)};
  return pl_measure_make(m->pool, e, &unit, pl_dimension_unit(pl_pool_arena(m->pool), x, false));
}

static bool is_dimension(const pl_model* m, pl_expr e, pl_dimension* x) {
  return !pl_is_constant(m->pool, e) && pl_known_dimension(m, e, x)
         && !pl_dimension_equal(*x, pl_dimension_one());
}

// The first sum in e that adds a bare number to a quantity, and its dimension.
static pl_expr bare_sum(const pl_model* m, pl_expr e, pl_map* visited, pl_dimension* x) {
  if (pl_is_poison(e) || pl_map_get(visited, e.id)) return pl_poison();
  pl_map_set(visited, e.id, 1);
  int n = pl_n_args(m->pool, e);
  for (int i = 0; i < n; i++) {
    pl_expr found = bare_sum(m, pl_arg(m->pool, e, i), visited, x);
    if (!pl_is_poison(found)) return found;
  }
  if (pl_kind_of(m->pool, e) != PL_ADD) return pl_poison();
  bool bare = false, quantity = false;
  for (int i = 0; i < n; i++) {
    pl_expr term = pl_arg(m->pool, e, i);
    bare |= pl_is_constant(m->pool, term);
    quantity |= !quantity && is_dimension(m, term, x);
  }
  return bare && quantity ? e : pl_poison();
}

static pl_expr dressed_sum(pl_model* m, pl_expr sum, pl_dimension x) {
  int n = pl_n_args(m->pool, sum);
  pl_expr* terms = PL_ARRAY(pl_pool_arena(m->pool), pl_expr, n);
  for (int i = 0; i < n; i++) terms[i] = dressed_number(m, pl_arg(m->pool, sum, i), x);
  return pl_add_n(m->pool, terms, n);
}

static void dress_sums(void* user, const pl_slot* slot) {
  enum { MOST = 50 };  // of one expression; what is left stays bare
  pl_model* m = user;
  pl_slot_kind k = slot->kind;
  bool formula = k == PL_SLOT_POINT || k == PL_SLOT_MASS || k == PL_SLOT_LOAD
                 || k == PL_SLOT_GRAVITY || k == PL_SLOT_CONSTRAINT || k == PL_SLOT_CHOOSE
                 || k == PL_SLOT_BRANCH || k == PL_SLOT_LET || k == PL_SLOT_ASK
                 || k == PL_SLOT_OUTPUT;
  if (!formula || pl_is_poison(*slot->at) || pl_is_constant(m->pool, *slot->at)) return;
  for (int i = 0; i < MOST; i++) {
    pl_dimension x;
    pl_expr sum = bare_sum(m, *slot->at, pl_map_make(pl_pool_arena(m->pool)), &x);
    if (pl_is_poison(sum)) return;
    *slot->at = pl_subst_expr(m->pool, *slot->at, sum, dressed_sum(m, sum, x));
  }
}

// One side of a relation takes the dimension of the other.
static void dress_sides(pl_model* m, pl_expr* left, pl_expr* right) {
  pl_dimension x;
  if (pl_is_poison(*left) || pl_is_poison(*right)) return;
  if (is_dimension(m, *right, &x)) *left = dressed_number(m, *left, x);
  else if (is_dimension(m, *left, &x)) *right = dressed_number(m, *right, x);
}

static void dress_point(pl_model* m, pl_point* p) {
  for (int i = 0; i < p->n && i < 3; i++)
    p->at[i] = dressed_number(m, p->at[i], pl_dimension_of(1, 0, 0));
}

static void dress_load(pl_model* m, pl_load* x) {
  static const struct {
    pl_load_kind kind;
    int s, m;
  } value[] = {{PL_L_SPRING, -2, 0}, {PL_L_DAMPER, -1, 0}, {PL_L_DRAG, -1, 0}};
  for (size_t i = 0; i < sizeof value / sizeof *value; i++)
    if (x->kind == value[i].kind)
      x->value = dressed_number(m, x->value, pl_dimension_of(value[i].m, 1, value[i].s));
  pl_dimension energy = pl_dimension_of(2, 1, -2);
  if (x->kind == PL_L_SPRING) x->rest = dressed_number(m, x->rest, pl_dimension_of(1, 0, 0));
  if (x->kind == PL_L_FORCE || x->kind == PL_L_COUPLE) {
    for (int k = 0; k < 3; k++)
      x->vector[k] = dressed_number(m, x->vector[k],
                                    x->kind == PL_L_FORCE ? pl_dimension_of(1, 1, -2) : energy);
  }
  if (x->kind == PL_L_TORQUE) {
    pl_dimension q = pl_dimension_one();
    if (x->coordinate.id && !pl_known_dimension(m, pl_sym(m->pool, x->coordinate), &q)) return;
    x->value = dressed_number(m, x->value, pl_dimension_div(energy, q));
  }
  dress_point(m, &x->a);
  dress_point(m, &x->b);
}

void pl_dress_bare_numbers(pl_model* m) {
  if (!m->uses_units) return;
  pl_model_each_slot(m, dress_sums, m);
  for (int i = 0; i < m->masses.n; i++) {
    m->masses.at[i].mass = dressed_number(m, m->masses.at[i].mass, pl_dimension_of(0, 1, 0));
    dress_point(m, &m->masses.at[i].point);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    m->bodies.at[i].mass = dressed_number(m, m->bodies.at[i].mass, pl_dimension_of(0, 1, 0));
    m->bodies.at[i].inertia = dressed_number(m, m->bodies.at[i].inertia, pl_dimension_of(2, 1, 0));
    dress_point(m, &m->bodies.at[i].centre);
  }
  for (int i = 0; i < m->points.n; i++) dress_point(m, &m->points.at[i].point);
  for (int i = 0; i < m->gravities.n; i++)
    m->gravities.at[i].g = dressed_number(m, m->gravities.at[i].g, pl_dimension_of(1, 0, -2));
  for (int i = 0; i < m->loads.n; i++) dress_load(m, &m->loads.at[i]);
  for (int i = 0; i < m->constraints.n; i++) {
    pl_constraint* c = &m->constraints.at[i];
    dress_sides(m, &c->left, &c->right);
    c->g = pl_is_poison(c->g) ? c->g : pl_sub(m->pool, c->left, c->right);
  }
  for (int i = 0; i < m->choose.n_maps; i++)
    dress_sides(m, &m->choose.maps[i].old, &m->choose.maps[i].map);
  for (int i = 0; i < m->branches.n; i++)
    dress_sides(m, &m->branches.at[i].left, &m->branches.at[i].right);
  for (int i = 0; i < m->asks.n; i++) {
    pl_ask* a = &m->asks.at[i];
    for (int k = 0; k < a->where.n; k++)
      dress_sides(m, &a->where.at[k].left, &a->where.at[k].right);
    for (int k = 0; k < a->motion.n_from; k++)
      dress_sides(m, &a->motion.from[k].left, &a->motion.from[k].right);
  }
}
