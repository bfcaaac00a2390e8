// The interpreter of programs for one type of numbers: included by a file that defines `real`, its
// arithmetic (TO_REAL, ADD, SUB, MUL, DIV, NEG, MORE, AT_MOST) and FUNCTION(name) for elementary
// functions.
//
// A multiply-add rounds twice: one that rounds once is hundreds of times slower here. What a
// program keeps in eight lanes for the sake of vector registers is computed in those lanes only
// that hold something.
#ifndef PL_REAL_RUN_IMPL_H
#define PL_REAL_RUN_IMPL_H

#include "program/program.h"

#define INLINE static inline __attribute__((always_inline))
#define LANES  for (int l = 0; l < width; l++)

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

// --------------------------------------------------------------------------------------- functions
static real call1(int fn, real x) {
  switch (fn) {
#define CASE_1(name) \
  case PL_FN_##name: \
    return FUNCTION(name)(x);
#define CASE_2(name)
#define CASE(name, reads) CASE_##reads(name)
    PL_PROG_FUNCTIONS(CASE)
#undef CASE_1
#undef CASE_2
  }
  return TO_REAL((double)NAN);
}

static real call2(int fn, real x, real y) {
  switch (fn) {
#define CASE_1(name)
#define CASE_2(name) \
  case PL_FN_##name: return FUNCTION(name)(x, y);
    PL_PROG_FUNCTIONS(CASE)
  }
  return TO_REAL((double)NAN);
}

// ------------------------------------------------------------------------------------------- lines
INLINE void run(const pl_prog* code, real* m, int k, int width) {
  real* r = m + code->spill;
  for (int i = 0; i < code->lines.n; i++) {
    const pl_prog_line* x = &code->lines.at[i];
    real* d = r + x->d * width;
    const real *a = r + x->a * width, *b = r + x->b * width, *c = r + x->c * width,
               *e = r + x->e * width;
    real* at = m + x->at + (long)x->by * k;
    switch ((pl_prog_op)x->op) {
      case PL_PROG_LOAD: LANES d[l] = at[l]; break;
      case PL_PROG_SPREAD: LANES d[l] = *at; break;
      case PL_PROG_STORE: LANES at[l] = a[l]; break;
      case PL_PROG_NUMBER: LANES d[l] = TO_REAL(x->value); break;
      case PL_PROG_ORDER: LANES d[l] = TO_REAL(k + x->at); break;
      case PL_PROG_ADD: LANES d[l] = ADD(a[l], b[l]); break;
      case PL_PROG_SUB: LANES d[l] = SUB(a[l], b[l]); break;
      case PL_PROG_MUL: LANES d[l] = MUL(a[l], b[l]); break;
      case PL_PROG_DIV: LANES d[l] = DIV(a[l], b[l]); break;
      case PL_PROG_FMA: LANES d[l] = ADD(MUL(a[l], b[l]), c[l]); break;
      case PL_PROG_FNMA: LANES d[l] = SUB(c[l], MUL(a[l], b[l])); break;
      case PL_PROG_NEG: LANES d[l] = NEG(a[l]); break;
      case PL_PROG_ABS: LANES d[l] = FUNCTION(fabs)(a[l]); break;
      case PL_PROG_SQRT: LANES d[l] = FUNCTION(sqrt)(a[l]); break;
      case PL_PROG_IF_MORE: LANES d[l] = MORE(a[l], TO_REAL(0)) ? b[l] : c[l]; break;
      case PL_PROG_IF_LESS: LANES d[l] = MORE(TO_REAL(0), a[l]) ? b[l] : c[l]; break;
      case PL_PROG_IF_LE: LANES d[l] = AT_MOST(a[l], b[l]) ? c[l] : e[l]; break;
      case PL_PROG_CALL1: LANES d[l] = call1(x->fn, a[l]); break;
      case PL_PROG_CALL2: LANES d[l] = call2(x->fn, a[l], b[l]); break;
      case PL_PROG_SUMS: block_sums(code, &code->blocks.at[x->at], m, k); break;
      case PL_PROG_PRODUCT: product(&code->products.at[x->at], m); break;
      case PL_N_PROG_OPS: break;
    }
  }
}

static void interpret(const pl_prog* c, void* memory, int from, int to) {
  for (int k = from; k < to; k++) {
    if (c->width == 8) run(c, memory, k, 8);
    else run(c, memory, k, 1);
  }
}

#endif
