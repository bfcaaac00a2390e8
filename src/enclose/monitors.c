// Functions whose sign decides which equations hold: forces of contacts, gaps of free contacts,
// values of events.
//
// Along a step each has a series with a proven tail: coefficient k is at most B R^-k, B a bound on
// the disk of times. A sign is proved on the whole step by evaluating the polynomial on intervals,
// halved where they are too long. Where a function is not proved to keep its sign, its derivative
// is proved to have the other one, the function to have changed at the end, and Newton's method on
// intervals encloses the one zero between [Moore1966].
//
// Where a mode begins at a zero, the first `fresh` coefficients are exactly zero (one for an event
// that was just passed, three for the gap of a contact that lets go: its gap, the velocity and,
// since the force is zero, the acceleration of it). Then the function divided by that power of the
// time is looked at.
// See theory (18.6).
#include "enclose/enclose_impl.h"

#include <math.h>

enum { HALVINGS = 16, LOOK_BITS = 96, MOST_NEWTON = 60 };

typedef struct pl_monitors {
  PL_VEC(pl_monitor) list;
  int cap;
  arb_ptr series;  // of the function looked at       (cap)
} pl_monitors;

// The function looked at: f(τ) = sum c_k τ^k, k = fresh .. order, times sign, divided by τ^fresh,
// and its tail.
typedef struct look {
  pl_enclosure_stepper* e;
  pl_monitors* all;
  const pl_monitor* m;
  int order;
  mag_t bound;  // of |f| on the disk of times
  mag_t tail, slope_tail;
  arb_srcptr h;
} look;

// ------------------------------------------------------------------------------------------- which
static bool does_something(const pl_event_setup* e) {
  for (int i = 0; i < e->n_actions; i++)
    if (e->actions[i].kind != PL_ACTION_RECORD) return true;
  return false;
}

bool pl_monitors_any(const pl_system* s) {
  for (int c = 0; c < s->n_c; c++)
    if (s->setup->constraints[c].side != 0) return true;
  for (int i = 0; i < s->setup->n_events; i++)
    if (does_something(&s->setup->events[i])) return true;
  return false;
}

// Events keep their monitors from mode to mode.
void pl_monitors_reset(pl_system* s, bool anew, int released) {
  pl_monitors* all = s->monitors;
  int kept = 0;
  for (int i = 0; i < all->list.n; i++)
    if (!anew && all->list.at[i].kind == PL_MONITOR_EVENT) all->list.at[kept++] = all->list.at[i];
  all->list.n = kept;
  for (int c = 0; c < s->n_c; c++) {
    const pl_constraint_setup* constraint = &s->setup->constraints[c];
    bool exists = constraint->contact < 0 || s->held[constraint->contact];
    if (constraint->side == 0 || constraint->off || !exists) continue;
    pl_monitor m = {.kind = s->active[c] ? PL_MONITOR_FORCE : PL_MONITOR_GAP,
                    .index = c,
                    .sign = constraint->side};
    if (c == released) {
      m.fresh = 3;
      m.begun = true;
    }
    pl_push(s->arena, all->list, m);
  }
  for (int i = 0; i < s->setup->n_events && anew; i++)
    if (does_something(&s->setup->events[i]))
      pl_push(s->arena, all->list, (pl_monitor){.kind = PL_MONITOR_EVENT, .index = i});
}

void pl_monitors_free(pl_system* s) {
  if (s->monitors) _arb_vec_clear(s->monitors->series, s->monitors->cap);
  s->monitors = NULL;
}

void pl_monitors_moved(pl_system* s) {
  for (int i = 0; i < s->monitors->list.n; i++) {
    s->monitors->list.at[i].fresh = 0;
    s->monitors->list.at[i].begun = true;
  }
}

// ---------------------------------------------------------------------------------------- programs
typedef void (*visit)(pl_system* s, pl_ball_jet* j, int root, void* data);

// Every root that contributes to the function of a monitor.
static void each_root(pl_system* s, const pl_monitor* m, visit visit_root, void* data) {
  for (int i = 0; i < s->n_jets; i++) {
    pl_ball_jet* j = &s->jet[i];
    const pl_pattern* p = j->pattern;
    for (int e = 0; e < p->n_g && m->kind == PL_MONITOR_GAP; e++)
      if (j->c[p->g[e].row] == m->index) visit_root(s, j, p->g[e].root, data);
    for (int e = 0; e < p->n_out && m->kind == PL_MONITOR_EVENT; e++)
      if (j->out && j->out[p->outputs[e].row] == s->setup->events[m->index].watch)
        visit_root(s, j, p->outputs[e].root, data);
  }
}

static void want(pl_system* s, pl_ball_jet* j, int root, void* data) {
  bool* plain = data;
  *plain = *plain && j->tape->nodes[j->tape->roots[root]].level < PL_LEVEL_FORCE;
  int* stack = PL_ARRAY(s->arena, int, 3 * (size_t)j->tape->n_nodes + 4);
  pl_jet_want(j, stack, root, PL_FOR_MOTION);
}

pl_certify_end pl_monitors_mark(pl_system* s, const char** what) {
  s->monitors = PL_NEW(s->arena, pl_monitors);
  for (int c = 0; c < s->n_c; c++) {
    bool plain = true;
    if (s->setup->constraints[c].side != 0)
      each_root(s, &(pl_monitor){.kind = PL_MONITOR_GAP, .index = c}, want, &plain);
  }
  for (int i = 0; i < s->setup->n_events; i++) {
    if (!does_something(&s->setup->events[i])) continue;
    bool plain = true;
    each_root(s, &(pl_monitor){.kind = PL_MONITOR_EVENT, .index = i}, want, &plain);
    if (plain) continue;
    *what = s->setup->events[i].name;
    return PL_CERTIFY_WATCH;
  }
  return PL_CERTIFIED;
}

static void add_series(pl_system* s, pl_ball_jet* j, int root, void* data) {
  look* k = data;
  mag_t m;
  mag_init(m);
  arb_srcptr c = pl_root_series(j, root);
  for (int i = 0; i <= k->order; i++)
    arb_add(k->all->series + i, k->all->series + i, c + i, s->prec);
  pl_disk_bound(m, &j->disk[j->tape->roots[root]]);
  mag_add(k->bound, k->bound, m);
  mag_clear(m);
}

// Series and bound of the function; forces have one coefficient less.
static void load(look* k) {
  pl_system* s = k->e->s;
  k->order = k->m->kind == PL_MONITOR_FORCE ? k->e->order - 1 : k->e->order;
  if (k->all->cap < k->order + 2) {
    _arb_vec_clear(k->all->series, k->all->cap);
    k->all->cap = k->order + 32;
    k->all->series = _arb_vec_init(k->all->cap);
  }
  _arb_vec_zero(k->all->series, k->all->cap);
  mag_zero(k->bound);
  if (k->m->kind == PL_MONITOR_FORCE) {
    _arb_vec_set(k->all->series, s->l + (slong)k->m->index * s->cap, k->order + 1);
    pl_disk_bound(k->bound, &s->l_disk[k->m->index]);
  } else {
    each_root(s, k->m, add_series, k);
  }
}

// tail: B R^-f x^(p+1-f)/(1-x). That of the derivative: (p+1-f) B R^-(f+1) x^(p-f)/(1-x)², since
// sum k x^(k-1) over k > n is at most (n+1) x^n/(1-x)².
static void set_tails(look* k) {
  mag_t R, one, gap;
  mag_init(R);
  mag_init(one);
  mag_init(gap);
  int f = k->m->fresh, n = k->order - f;
  mag_set_d_lower(R, k->e->radius);
  for (int i = 0; i < f; i++) mag_div(k->bound, k->bound, R);
  pl_series_tail(k->tail, k->bound, k->e->x, n);
  mag_one(one);
  mag_sub_lower(gap, one, k->e->x);
  mag_mul_lower(gap, gap, gap);
  mag_pow_ui(k->slope_tail, k->e->x, (ulong)n);
  mag_mul_ui(k->slope_tail, k->slope_tail, (ulong)n + 1);
  mag_mul(k->slope_tail, k->slope_tail, k->bound);
  mag_div(k->slope_tail, k->slope_tail, R);
  mag_div(k->slope_tail, k->slope_tail, gap);
  mag_clear(R);
  mag_clear(one);
  mag_clear(gap);
}

// ------------------------------------------------------------------------------------------ values
// The function, or its derivative, on the ball τ.
static void value(const look* k, arb_t out, arb_srcptr tau, bool slope, slong prec) {
  arb_t c;
  arb_init(c);
  int f = k->m->fresh, n = k->order - f;
  arb_zero(out);
  for (int i = n; i >= (slope ? 1 : 0); i--) {
    arb_mul(out, out, tau, prec);
    if (slope) arb_mul_si(c, k->all->series + f + i, i, prec);
    else arb_set_round(c, k->all->series + f + i, prec);
    arb_add(out, out, c, prec);
  }
  arb_add_error_mag(out, slope ? k->slope_tail : k->tail);
  if (k->m->sign < 0) arb_neg(out, out);
  arb_clear(c);
}

static void between(arb_t out, double lo, double hi) {
  arf_t a, b;
  arf_init_set_ui(a, 0);
  arf_init_set_ui(b, 0);
  arf_set_d(a, lo);
  arf_set_d(b, hi);
  arb_set_interval_arf(out, a, b, LOOK_BITS);
  arf_clear(a);
  arf_clear(b);
}

// 1, -1: that is the sign (of the derivative) on all of [lo, hi]; 0: not proved.
static int sign_on(const look* k, double lo, double hi, bool slope) {
  arb_t tau, y;
  arb_init(tau);
  arb_init(y);
  between(tau, lo, hi);
  value(k, y, tau, slope, LOOK_BITS);
  int sign = arb_is_positive(y) ? 1 : arb_is_negative(y) ? -1 : 0;
  arb_clear(tau);
  arb_clear(y);
  return sign;
}

// The first short interval on which the function is not proved to be positive; false: there is
// none.
static bool first_doubt(const look* k, double lo, double hi, int halvings, double* from,
                        double* to) {
  if (sign_on(k, lo, hi, false) > 0) return false;
  if (halvings == 0) {
    *from = lo;
    *to = hi;
    return true;
  }
  double middle = lo + (hi - lo) / 2;
  return first_doubt(k, lo, middle, halvings - 1, from, to)
         || first_doubt(k, middle, hi, halvings - 1, from, to);
}

// ------------------------------------------------------------------------------------------- zeros
// Newton's method on the interval [lo, hi], on which the derivative has no zero and the function
// changes sign.
static bool newton(const look* k, arb_t root, double lo, double hi) {
  slong prec = k->e->s->prec;
  arb_t middle, slope, next;
  arb_init(middle);
  arb_init(slope);
  arb_init(next);
  between(root, lo, hi);
  for (int i = 0; i < MOST_NEWTON; i++) {
    arb_get_mid_arb(middle, root);
    value(k, slope, root, true, prec);
    value(k, next, middle, false, prec);
    arb_div(next, next, slope, prec);
    arb_sub(next, middle, next, prec);
    if (!arb_is_finite(next) || !arb_intersection(next, next, root, prec)) break;
    bool narrower = mag_cmp(arb_radref(next), arb_radref(root)) < 0;
    if (!narrower) break;
    arb_swap(root, next);
  }
  arb_clear(middle);
  arb_clear(slope);
  arb_clear(next);
  return arb_is_finite(root);
}

// The zero behind the first doubt, if the function is proved to fall through it within the step.
static bool zero_behind(const look* k, arb_t root, double from, double to, double h) {
  double width = to - from;
  for (int i = 0; i < HALVINGS && to < h; i++, width *= 2) {
    to = fmin(to + width, h);
    if (sign_on(k, from, to, true) >= 0) return false;
    if (sign_on(k, to, to, false) < 0) return newton(k, root, from, to);
  }
  return false;
}

// --------------------------------------------------------------------------------------- beginning
// Coefficients that are exactly zero where the motion begins; the sign of an event's value there.
static bool begin(look* k, pl_monitor* m) {
  if (m->begun && m->sign != 0) return true;
  while (!m->begun && m->fresh < 3 && arb_is_zero(k->all->series + m->fresh)) m->fresh++;
  m->begun = true;
  arb_srcptr c = k->all->series + m->fresh;
  if (m->sign == 0) m->sign = arb_is_positive(c) ? 1 : arb_is_negative(c) ? -1 : 0;
  return m->sign != 0;
}

// One function along the step; root is set when it changes sign, *safe is up to where it keeps it.
static pl_monitor_look look_at(look* k, pl_monitor* m, arb_t root, double* safe) {
  double h = pl_ball_double(k->h), from = h, to = h;
  k->m = m;
  load(k);
  if (!begin(k, m)) return PL_LOOK_LOST;
  set_tails(k);
  *safe = h;
  double end = h * (1 + 1e-15);  // h may be a ball
  if (!first_doubt(k, 0, end, HALVINGS, &from, &to)) return PL_LOOK_CLEAR;
  *safe = from;
  // a beginning at zero is no zero of its own
  if (m->fresh == 0 && zero_behind(k, root, from, to, end)) return PL_LOOK_HIT;
  return from > 0 ? PL_LOOK_SHORTER : PL_LOOK_LOST;
}

// --------------------------------------------------------------------------------------------- all
typedef struct first {
  pl_monitor_look look;
  double safe;  // all functions keep their signs up to here, but for the one that hits
  arb_t root;
  pl_monitor* hit;
} first;

// The zero found before and another function that is safe up to `safe`: which comes first?
static void merge(first* f, pl_monitor_look one, double safe, arb_srcptr root, pl_monitor* m) {
  arb_t limit;
  arb_init(limit);
  arb_set_d(limit, safe);
  if (f->look == PL_LOOK_HIT && one != PL_LOOK_CLEAR) {
    bool before = one == PL_LOOK_HIT ? arb_lt(f->root, root) : arb_lt(f->root, limit);
    bool behind = one == PL_LOOK_HIT ? arb_lt(root, f->root) : false;
    if (behind) {
      arb_set(f->root, root);
      f->hit = m;
    } else if (!before) {
      f->look = PL_LOOK_SHORTER;
    }
  } else if (f->look != PL_LOOK_HIT && one == PL_LOOK_HIT) {
    arb_set_d(limit, f->safe);
    if (f->look == PL_LOOK_CLEAR || arb_lt(root, limit)) {
      f->look = PL_LOOK_HIT;
      f->hit = m;
      arb_set(f->root, root);
    }
  } else if (one == PL_LOOK_SHORTER && f->look == PL_LOOK_CLEAR) {
    f->look = PL_LOOK_SHORTER;
  }
  f->safe = fmin(f->safe, safe);
  arb_clear(limit);
}

pl_monitor_look pl_monitors_look(pl_enclosure_stepper* e, arb_srcptr h, arb_t part,
                                 pl_monitor** hit) {
  pl_monitors* all = e->s->monitors;
  look k = {.e = e, .all = all, .h = h};
  first f = {.look = PL_LOOK_CLEAR, .safe = pl_ball_double(h)};
  arb_t root;
  arb_init(root);
  arb_init(f.root);
  mag_init(k.bound);
  mag_init(k.tail);
  mag_init(k.slope_tail);
  bool lost = false;
  for (int i = 0; i < all->list.n && !lost; i++) {
    double safe;
    pl_monitor_look one = look_at(&k, &all->list.at[i], root, &safe);
    lost = one == PL_LOOK_LOST;
    if (!lost) merge(&f, one, safe, root, &all->list.at[i]);
  }
  *hit = f.hit;
  if (f.look == PL_LOOK_HIT) arb_set(part, f.root);
  else if (f.look == PL_LOOK_SHORTER) arb_set_d(part, f.safe);
  if (f.look == PL_LOOK_SHORTER && !(f.safe > 0)) lost = true;
  arb_clear(root);
  arb_clear(f.root);
  mag_clear(k.bound);
  mag_clear(k.tail);
  mag_clear(k.slope_tail);
  return lost ? PL_LOOK_LOST : f.look;
}
