// The interpreter of codes. This file is compiled twice where the compiler can: for processors with
// a fused multiply-add instruction, and for those without, where the C library computes the same
// bits more slowly.
#include <math.h>

#include "program/program.h"

#ifndef PL_INTERPRET
#  define PL_INTERPRET pl_prog_interpret_plain
#endif
void PL_INTERPRET(const pl_prog* c, double* memory, int from, int to);

#define INLINE static inline __attribute__((always_inline))
#define LANES  for (int l = 0; l < width; l++)

// -------------------------------------------------------------------------------------------- sums
INLINE void add_row(double* s, const double* a, const double* b, int ja, int jb, bool weighted,
                    int width) {
  a += ja * width;
  b += jb * width;
  if (weighted) LANES s[l] = __builtin_fma((double)ja * a[l], b[l], s[l]);
  else LANES s[l] = __builtin_fma(a[l], b[l], s[l]);
}

// Rows i and K - i of a pair, to their two parts.
INLINE void add_rows(double part[2][8], const double* a, const double* b, int j, int K,
                     bool weighted, int width) {
  add_row(part[0], a, b, j, K - j, weighted, width);
  if (2 * j != K) add_row(part[1], a, b, K - j, j, weighted, width);
}

INLINE void sum(const pl_prog* c, const pl_prog_sum* x, double* m, int K, int width) {
  double part[PL_PROG_PARTS][8] = {{0}};
  const pl_prog_pair* pairs = c->pairs.at + x->first;
  for (int j = K / 2; j >= 1; j--)
    for (int p = 0; p < x->n; p += 2) {
      add_rows(part, m + pairs[p].a, m + pairs[p].b, j, K, x->weighted, width);
      if (p + 1 < x->n)
        add_rows(part + 2, m + pairs[p + 1].a, m + pairs[p + 1].b, j, K, x->weighted, width);
    }
  LANES {
    double s = part[0][l] + part[1][l];
    if (x->n > 1) s += part[2][l] + part[3][l];
    if (x->scale >= 0)
      s = __builtin_fma(s, m[x->rest + K * width + l], s * m[x->scale + K * width + l]);
    m[x->to + l] = s;
  }
}

static void block_sums(const pl_prog* c, const pl_prog_block* b, double* m, int k) {
  for (int i = b->first; i < b->first + b->n; i++) {
    if (b->width == 8) sum(c, &c->sums.at[i], m, k + b->shift, 8);
    else sum(c, &c->sums.at[i], m, k + b->shift, 1);
  }
}

INLINE void add_column(double* s, const pl_prog_product* p, const double* m, int j, int block) {
  enum { width = 8 };
  const double* column = m + p->matrix + (j * p->blocks + block) * width;
  double x = m[p->vector + j];
  LANES s[l] = __builtin_fma(column[l], x, s[l]);
}

static void product(const pl_prog_product* p, double* m) {
  enum { width = 8 };
  for (int block = 0; block < p->blocks; block++) {
    double part[4][8] = {{0}}, last[2][8] = {{0}};
    for (int j = 0; j < p->n - p->late; j++) add_column(part[j % 4], p, m, j, block);
    LANES last[0][l] = (part[0][l] + part[1][l]) + (part[2][l] + part[3][l]);
    for (int i = 0; i < p->late; i++) add_column(last[i % 2], p, m, p->n - p->late + i, block);
    LANES m[p->to + block * width + l] = p->late > 1 ? last[0][l] + last[1][l] : last[0][l];
  }
}

// ------------------------------------------------------------------------------ double precision
typedef double real;
#define FUNCTION(name) name
#define TO_REAL(x)     ((double)(x))
#define ADD(a, b)      ((a) + (b))
#define SUB(a, b)      ((a) - (b))
#define MUL(a, b)      ((a) * (b))
#define DIV(a, b)      ((a) / (b))
#define FMA(a, b, c)   __builtin_fma(a, b, c)
#define FNMA(a, b, c)  __builtin_fma(-(a), b, c)
#define NEG(a)         (-(a))
#define MORE(a, b)     ((a) > (b))
#define AT_MOST(a, b)  ((a) <= (b))
#include "program/prog_loop_impl.h"

void PL_INTERPRET(const pl_prog* c, double* memory, int from, int to) {
  interpret(c, memory, from, to);
}
