// A stable sort in memory of the pool.
#include "expr/expr_impl.h"

#include <string.h>

static void merge_halves(char* to, const char* a, int n_a, const char* b, int n_b, size_t size,
                         pl_less less, const void* user) {
  while (n_a > 0 || n_b > 0) {
    bool right = n_a == 0 || (n_b > 0 && less(b, a, user));
    memcpy(to, right ? b : a, size);
    to += size;
    if (right) {
      b += size;
      n_b--;
    } else {
      a += size;
      n_a--;
    }
  }
}

// Merge sort; a range that is in order already costs one comparison per merge.
static void sort_range(char* at, char* spare, int n, size_t size, pl_less less, const void* user) {
  if (n < 2) return;
  int half = n / 2;
  char* middle = at + (size_t)half * size;
  sort_range(at, spare, half, size, less, user);
  sort_range(middle, spare, n - half, size, less, user);
  if (!less(middle, middle - size, user)) return;
  merge_halves(spare, at, half, middle, n - half, size, less, user);
  memcpy(at, spare, (size_t)n * size);
}

void pl_sort(const pl_pool* p, void* at, int n, size_t size, pl_less less, const void* user) {
  if (n < 2) return;
  void* spare = pl_scratch_take(p, (size_t)n * size);
  sort_range(at, spare, n, size, less, user);
  pl_scratch_give(p, spare, (size_t)n * size);
}
