// forces: the force of a constraint on each mass, Z = λ ∇g, along the axes or along the frame of
// the mass.
#include <string.h>

#include "mechanics/mechanics.h"

static bool shared(const pl_analysis* d, int particle, pl_symbol q) {
  for (int k = 0; k < d->particle.n; k++) {
    if (k == particle) continue;
    for (int c = 0; c < d->particle.at[k].n; c++) {
      if (pl_has_symbol(d->pool, d->particle.at[k].at[c], q)) return true;
    }
  }
  return false;
}

// Each component of the position is a coordinate of its own: Z along the axes is λ dg/dx.
static bool along_axes(pl_analysis* d, int link, int particle, pl_force* out) {
  const pl_particle* m = &d->particle.at[particle];
  *out = (pl_force){.whole = true, .reaction_to = -1};
  for (int c = 0; c < m->n; c++) {
    if (!pl_has_coordinates(d, m->at[c])) {  // stays, or is moved as given
      out->whole = false;
      continue;
    }
    if (pl_kind_of(d->pool, m->at[c]) != PL_SYMBOL) return false;
    int i = pl_variable_index(d, pl_symbol_of(d->pool, m->at[c]));
    if (i < 0 || shared(d, particle, d->q.at[i].q)) return false;
    pl_expr factor = pl_alg_normal(d->tower, pl_on_fixed(d, d->g.at[link].gradient[i]));
    if (pl_is_zero_node(d->pool, factor)) continue;
    out->along[out->n] = pl_format(d->arena, "e_%s", d->model->axes[c].name);
    out->factor[out->n++] = factor;
  }
  return true;
}

static bool along_frame(pl_analysis* d, int link, int particle, pl_force* out) {
  pl_frame f;
  *out = (pl_force){.reaction_to = -1};
  if (!pl_frame_find(d, &d->particle.at[particle], &f)) return false;
  out->whole = f.n == d->particle.at[particle].n;
  for (int j = 0; j < f.n; j++) {
    int i = f.coordinate[j];
    if (shared(d, particle, d->q.at[i].q)) return false;
    pl_expr factor = pl_div(d->pool, d->g.at[link].gradient[i], f.scale[j]);
    factor = pl_alg_normal(d->tower, pl_on_fixed(d, factor));
    if (pl_is_zero_node(d->pool, factor)) continue;
    out->along[out->n] = pl_unit_vector(d, i);
    out->factor[out->n++] = factor;
  }
  return true;
}

bool pl_force_on(pl_analysis* d, int link, int particle, pl_force* out) {
  return along_axes(d, link, particle, out) || along_frame(d, link, particle, out);
}

// Action is reaction: where constraint `link` joins mass a to mass b, whose force is known along
// all axes, the force on a is
// the opposite one.  Virtual work along each coordinate of a decides whether it joins them:
//   dg/dq_i = -Z_b . dX_a/dq_i.
static bool is_reaction(pl_analysis* d, int link, int a, int b, const pl_force* on_b) {
  const pl_particle* m = &d->particle.at[a];
  if (!on_b->whole || m->n != d->particle.at[b].n) return false;
  for (int i = 0; i < d->q.n; i++) {
    pl_expr work = d->g.at[link].gradient[i];
    bool moves = false;
    for (int c = 0; c < m->n; c++) {
      pl_expr way = pl_diff(d->pool, m->at[c], d->q.at[i].q);
      const char* along = pl_format(d->arena, "e_%s", d->model->axes[c].name);
      moves |= !pl_is_zero_node(d->pool, way);
      for (int j = 0; j < on_b->n; j++) {
        if (strcmp(on_b->along[j], along) != 0) continue;
        work = pl_add(d->pool, work, pl_mul(d->pool, on_b->factor[j], way));
      }
    }
    if (moves && pl_alg_is_zero(d->tower, pl_on_fixed(d, work)) != PL_YES) return false;
  }
  return true;
}

// Of two masses that the constraint acts on, one may lack coordinates for a part of its force.
static void complete_by_reaction(pl_analysis* d, int link, pl_force* f) {
  int acted[2], n = 0;
  for (int m = 0; m < d->particle.n; m++) {
    if (f[m].n == 0) continue;
    if (n == 2) return;
    acted[n++] = m;
  }
  for (int k = 0; n == 2 && k < 2; k++) {
    int a = acted[k], b = acted[1 - k];
    pl_force own;
    if (f[a].whole || !along_axes(d, link, b, &own) || !is_reaction(d, link, a, b, &own)) continue;
    f[a] = own;
    f[a].reaction_to = b;
    for (int j = 0; j < own.n; j++) f[a].factor[j] = pl_neg(d->pool, own.factor[j]);
  }
}

int pl_forces_of(pl_analysis* d, int link, pl_force* f, int* first) {
  int n = 0;
  *first = -1;
  for (int m = 0; m < d->particle.n; m++) {
    if (!pl_force_on(d, link, m, &f[m])) f[m].n = 0;
    if (f[m].n > 0 && n++ == 0) *first = m;
  }
  complete_by_reaction(d, link, f);
  return n;
}

pl_expr pl_force_scale(pl_analysis* d, int link) {
  pl_expr square = pl_poison();
  for (int m = 0; m < d->particle.n; m++) {
    pl_force f;
    if (!pl_force_on(d, link, m, &f)) return pl_poison();
    if (f.n == 0) continue;
    pl_expr sum = pl_int(d->pool, 0);
    for (int j = 0; j < f.n; j++) sum = pl_add(d->pool, sum, pl_square(d->pool, f.factor[j]));
    if (!pl_is_poison(square) && pl_alg_equal(d->tower, square, sum) != PL_YES) return pl_poison();
    square = sum;
  }
  return pl_is_poison(square) ? square : pl_sqrt(d->pool, square);
}
