// The loop over the lines of a program, for one type of numbers: included by a file that defines
// `real`, its arithmetic (TO_REAL, ADD, SUB, MUL, DIV, FMA, FNMA, NEG, MORE, AT_MOST),
// FUNCTION(name) for functions of the C library, and block_sums and product.
#ifndef PL_PROG_LOOP_IMPL_H
#define PL_PROG_LOOP_IMPL_H

#include "program/program.h"

#ifndef LANES
#  define LANES for (int l = 0; l < width; l++)
#endif

// --------------------------------------------------------------------------------------- functions
static real call1(int fn, real x) {
  switch (fn) {
#define CASE_1(name) \
  case PL_FN_##name: \
    return FUNCTION(name)(x);
#define CASE_2(name)
#define PL_LIBRARY(name, n) CASE_##n(name)
#include "program/library.def"
#undef CASE_1
#undef CASE_2
  }
  return TO_REAL((double)NAN);
}

static real call2(int fn, real x, real y) {
  switch (fn) {
#define CASE_1(name)
#define CASE_2(name) \
  case PL_FN_##name: \
    return FUNCTION(name)(x, y);
#define PL_LIBRARY(name, n) CASE_##n(name)
#include "program/library.def"
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
      case PL_PROG_FMA: LANES d[l] = FMA(a[l], b[l], c[l]); break;
      case PL_PROG_FNMA: LANES d[l] = FNMA(a[l], b[l], c[l]); break;
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
