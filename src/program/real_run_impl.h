// The interpreter of programs for a type of numbers with more digits than a double: included by a
// file that defines `real`, its arithmetic (TO_REAL, ADD, SUB, MUL, DIV, NEG, MORE, AT_MOST) and
// FUNCTION(name) for functions of the C library.
//
// A multiply-add rounds twice: one that rounds once is hundreds of times slower here. What a
// program keeps in eight lanes for the sake of vector registers is computed in those lanes only
// that hold something.
#ifndef PL_REAL_RUN_IMPL_H
#define PL_REAL_RUN_IMPL_H

#include "program/program.h"

#define INLINE        static inline __attribute__((always_inline))
#define LANES         for (int l = 0; l < width; l++)
#define FMA(a, b, c)  ADD(MUL(a, b), c)
#define FNMA(a, b, c) SUB(c, MUL(a, b))

// -------------------------------------------------------------------------------------------- sums
INLINE void add_row(real* s, const real* a, const real* b, int ja, int jb, bool weighted,
                    int stride, int lanes) {
  a += ja * stride;
  b += jb * stride;
  for (int l = 0; l < lanes; l++)
    s[l] = ADD(s[l], MUL(weighted ? MUL(TO_REAL(ja), a[l]) : a[l], b[l]));
}

static void sum(const pl_prog* c, const pl_prog_sum* x, real* m, int K, int stride) {
  real s[8];
  for (int l = 0; l < 8; l++) s[l] = TO_REAL(0);
  int lanes = x->lanes > 0 ? x->lanes : stride;
  const pl_prog_pair* pairs = c->pairs.at + x->first;
  if (K >= 2 && K % 2 == 0)
    for (int p = 0; p < x->n; p++)
      add_row(s, m + pairs[p].a, m + pairs[p].b, K / 2, K / 2, x->weighted, stride, lanes);
  for (int j = (K - 1) / 2; j >= 1; j--)
    for (int p = 0; p < x->n; p++) {
      add_row(s, m + pairs[p].a, m + pairs[p].b, j, K - j, x->weighted, stride, lanes);
      add_row(s, m + pairs[p].a, m + pairs[p].b, K - j, j, x->weighted, stride, lanes);
    }
  for (int l = 0; l < lanes; l++) {
    if (x->scale >= 0)
      s[l] = ADD(MUL(s[l], m[x->scale + K * stride + l]), MUL(s[l], m[x->rest + K * stride + l]));
    m[x->to + l] = s[l];
  }
}

static void block_sums(const pl_prog* c, const pl_prog_block* b, real* m, int k) {
  for (int i = b->first; i < b->first + b->n; i++)
    sum(c, &c->sums.at[i], m, k + b->shift, b->width);
}

static void product(const pl_prog_product* p, real* m) {
  enum { width = 8 };
  for (int block = 0; block < p->blocks; block++) LANES {
      real part = TO_REAL(0);
      for (int j = 0; j < p->n; j++)
        part = ADD(part, MUL(m[p->matrix + (j * p->blocks + block) * width + l], m[p->vector + j]));
      m[p->to + block * width + l] = part;
    }
}

#include "program/prog_loop_impl.h"

#endif
