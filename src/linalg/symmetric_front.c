// The structure of a front: what elimination fills in, and where every product goes.
#include "linalg/symmetric_impl.h"

// products of the elimination; above, a general factorisation is the better one
enum { MOST_PAIRS = 6000000 };

static int sort_unique(int* list, int n) {
  for (int i = 1; i < n; i++) {  // columns are short, or almost sorted
    int x = list[i], j = i;
    for (; j > 0 && list[j - 1] > x; j--) list[j] = list[j - 1];
    list[j] = x;
  }
  int kept = 0;
  for (int i = 0; i < n; i++)
    if (kept == 0 || list[kept - 1] != list[i]) list[kept++] = list[i];
  return kept;
}

// Column k has the rows of its own and those of every column whose first row is k. false: too many.
static bool fill_in(pl_arena* a, int m, int nb, pl_int_list* below) {
  int *child = PL_ARRAY(a, int, m + 1), *next = PL_ARRAY(a, int, m + 1),
      *seen = PL_ARRAY(a, int, m + nb + 1);
  double pairs = 0;
  for (int k = 0; k < m; k++) child[k] = -1;
  for (int k = 0; k < m; k++) {
    int n = 0;
    for (int i = 0; i < below[k].v.n; i++) {
      int r = below[k].v.at[i];
      if (seen[r] != k + 1) {
        below[k].v.at[n++] = r;
        seen[r] = k + 1;
      }
    }
    below[k].v.n = n;
    for (int c = child[k]; c >= 0; c = next[c])
      for (int i = 1; i < below[c].v.n; i++) {  // the first is k itself
        int r = below[c].v.at[i];
        if (seen[r] == k + 1) continue;
        seen[r] = k + 1;
        pl_push(a, below[k].v, r);
      }
    pairs += 0.5 * below[k].v.n * (below[k].v.n + 1.0);
    if (pairs > MOST_PAIRS + 16.0 * m) return false;
    below[k].v.n = sort_unique(below[k].v.at, below[k].v.n);
    if (below[k].v.n == 0 || below[k].v.at[0] >= m) continue;
    next[k] = child[below[k].v.at[0]];
    child[below[k].v.at[0]] = k;
  }
  return true;
}

static void list_rows(pl_arena* a, pl_symmetric_front* f) {
  int rows = f->m + f->nb;
  f->row_start = PL_ARRAY(a, int, rows + 2);
  f->row_entry = PL_ARRAY(a, int, f->n + 1);
  f->row_column = PL_ARRAY(a, int, f->n + 1);
  int* at = PL_ARRAY(a, int, rows + 1);
  for (int e = 0; e < f->n; e++) f->row_start[f->row[e] + 1]++;
  for (int r = 0; r < rows; r++) {
    f->row_start[r + 1] += f->row_start[r];
    at[r] = f->row_start[r];
  }
  for (int k = 0; k < f->m; k++)
    for (int e = f->column[k]; e < f->column[k + 1]; e++) {
      int to = at[f->row[e]]++;
      f->row_entry[to] = e;
      f->row_column[to] = k;
    }
}

int pl_symmetric_front_find(const pl_symmetric_front* f, int row, int column) {
  if (row < column) return pl_symmetric_front_find(f, column, row);
  if (column >= f->m) return f->m + f->n + (row - f->m) * (row - f->m + 1) / 2 + column - f->m;
  if (row == column) return row;
  int lo = f->column[column], hi = f->column[column + 1];
  while (lo < hi) {
    int mid = (lo + hi) / 2;
    if (f->row[mid] < row) lo = mid + 1;
    else hi = mid;
  }
  return lo < f->column[column + 1] && f->row[lo] == row ? f->m + lo : -1;
}

bool pl_symmetric_front_make(pl_arena* a, pl_symmetric_front* f, int lanes, int m, int nb,
                             pl_int_list* below) {
  *f = (pl_symmetric_front){.lanes = lanes, .m = m, .nb = nb};
  if (nb > 4000 || !fill_in(a, m, nb, below)) return false;
  f->column = PL_ARRAY(a, int, m + 2);
  int pairs = 0;
  for (int k = 0; k < m; k++) {
    f->column[k + 1] = f->column[k] + below[k].v.n;
    pairs += below[k].v.n * (below[k].v.n + 1) / 2;
  }
  f->n = f->column[m];
  f->row = PL_ARRAY(a, int, f->n + 1);
  for (int k = 0; k < m; k++)
    for (int i = 0; i < below[k].v.n; i++) f->row[f->column[k] + i] = below[k].v.at[i];
  list_rows(a, f);
  f->pair = PL_ARRAY(a, int, pairs + 1);
  int n = 0;
  for (int k = 0; k < m; k++)
    for (int i = f->column[k]; i < f->column[k + 1]; i++)
      for (int j = f->column[k]; j <= i; j++)
        f->pair[n++] = pl_symmetric_front_find(f, f->row[i], f->row[j]);
  return true;
}
