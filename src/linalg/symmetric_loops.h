// Loops over a front for one number of lanes. symmetric_kernels.c includes this once for each: T is
// a number or a vector of eight, P how many of them are a unit, NAME(x) names the functions: one
// text for what would otherwise be four.
#define UNIT(x, i) ((T*)(x) + (size_t)(i)*P)
#define PARTS      for (int p = 0; p < P; p++)

static void NAME(eliminate)(pl_symmetric_front* f) {
  const int* pair = f->pair;
  for (int k = 0; k < f->m; k++) {
    T inverse[P], *column = UNIT(f->w, f->m + f->column[k]);
    PARTS UNIT(f->inverse, k)[p] = inverse[p] = 1 / UNIT(f->w, k)[p];
    int n = f->column[k + 1] - f->column[k];
    const int* to = pair + n * (n + 1) / 2;
    pair = to;
    // from the last on, because those before are still needed as they are
    for (int i = n - 1; i >= 0; i--) {
      T L[P], *c = UNIT(column, i);
      to -= i + 1;
      PARTS L[p] = c[p] * inverse[p];
      for (int j = 0; j <= i; j++) PARTS UNIT(f->w, to[j])[p] -= L[p] * UNIT(column, j)[p];
      PARTS c[p] = L[p];
    }
  }
}

// y of the border's rows begins with what stands there.
static void NAME(forward)(const pl_symmetric_front* f) {
  T* L = UNIT(f->w, f->m);
  T* y = (T*)f->y;
  T before[P];
  PARTS before[p] = y[p];
  for (int r = 0; r < f->m; r++) {
    T acc[P];
    int i = f->row_start[r], end = f->row_start[r + 1];
    // what has just been computed is still at hand
    bool last = end > i && f->row_column[end - 1] == r - 1;
    PARTS acc[p] = UNIT(y, r)[p];
    for (end -= last; i < end; i++)
      PARTS acc[p] -= UNIT(L, f->row_entry[i])[p] * UNIT(y, f->row_column[i])[p];
    if (last) PARTS acc[p] -= UNIT(L, f->row_entry[end])[p] * before[p];
    PARTS UNIT(y, r)[p] = before[p] = acc[p];
  }
  for (int r = f->m; r < f->m + f->nb; r++) {
    // two sums, because one waits for itself
    T even[P], odd[P];
    PARTS even[p] = UNIT(y, r)[p], odd[p] = (T){0};
    int i = f->row_start[r], end = f->row_start[r + 1];
    for (; i + 1 < end; i += 2) {
      PARTS even[p] -= UNIT(L, f->row_entry[i])[p] * UNIT(y, f->row_column[i])[p];
      PARTS odd[p] -= UNIT(L, f->row_entry[i + 1])[p] * UNIT(y, f->row_column[i + 1])[p];
    }
    if (i < end) PARTS even[p] -= UNIT(L, f->row_entry[i])[p] * UNIT(y, f->row_column[i])[p];
    PARTS UNIT(y, r)[p] = even[p] + odd[p];
  }
}

static void NAME(backward)(const pl_symmetric_front* f) {
  T* L = UNIT(f->w, f->m);
  T* y = (T*)f->y;
  T before[P];
  PARTS before[p] = y[p];
  for (int k = f->m - 1; k >= 0; k--) {
    T acc[P];
    int first = f->column[k], i = f->column[k + 1] - 1;
    bool last = i >= first && f->row[first] == k + 1 && k + 1 < f->m;
    PARTS acc[p] = UNIT(y, k)[p] * UNIT(f->inverse, k)[p];
    for (first += last; i >= first; i--) PARTS acc[p] -= UNIT(L, i)[p] * UNIT(y, f->row[i])[p];
    if (last) PARTS acc[p] -= UNIT(L, i)[p] * before[p];
    PARTS UNIT(y, k)[p] = before[p] = acc[p];
  }
}

#undef UNIT
#undef PARTS
