// Trial points: other values of the coordinates, to see what stays the same with them.
#include "scene/scene_impl.h"

void pl_coords_keep(const pl_stage* s, double* kept) {
  for (int k = 0; k < s->n_q; k++) kept[k] = s->value[s->q[k].id];
}
void pl_coords_back(pl_stage* s, const double* kept) {
  for (int k = 0; k < s->n_q; k++) s->value[s->q[k].id] = kept[k];
}

// Random coordinates; those held at a constant stay.
void pl_coords_shuffle(pl_stage* s, const int* q, int n) {
  double size = s->size > 0 ? s->size : 1;
  for (int i = 0; i < n; i++) {
    if (s->settled[q[i]]) continue;
    s->value[s->q[q[i]].id] = s->angle[q[i]] ? pl_random_between(&s->random, -1.4, 1.4)
                                             : size * pl_random_between(&s->random, 0.2, 1.3);
  }
}

double pl_squared_distance(pl_stage* s, const void* what) {
  const pl_spot* const* pair = what;
  double a[3], b[3], sum = 0;
  pl_stage_spot(s, pair[0], a);
  pl_stage_spot(s, pair[1], b);
  for (int j = 0; j < 3; j++) sum += (a[j] - b[j]) * (a[j] - b[j]);
  return sum;
}
