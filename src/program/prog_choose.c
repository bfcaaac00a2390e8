// Which build of the interpreter this processor can run.  Both give the same bits.
#include "program/program.h"

void pl_prog_interpret_plain(const pl_prog* c, double* memory, int from, int to);
void pl_prog_interpret_fused(const pl_prog* c, double* memory, int from, int to);

void pl_prog_interpret(const pl_prog* c, double* memory, int from, int to) {
#ifdef PL_FUSED
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2")) {
    pl_prog_interpret_fused(c, memory, from, to);
    return;
  }
#endif
  pl_prog_interpret_plain(c, memory, from, to);
}
