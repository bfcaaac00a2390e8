// Between the files that turn programs into LLVM's intermediate language.
#ifndef PL_LLVM_EMIT_IMPL_H
#define PL_LLVM_EMIT_IMPL_H

#include "jit/llvm_emit.h"

// Lines of a function, operations of one that is written out for several orders; sums in a loop;
// strides of a function.
enum {
  PL_EMIT_CHUNK = 1500,
  PL_EMIT_WRITTEN = 1500,
  PL_EMIT_ACCUMULATORS = 24,
  PL_EMIT_STRIDES = 64
};

typedef struct pl_written pl_written;

typedef struct pl_emit {
  LLVMContextRef context;
  LLVMModuleRef module;
  LLVMBuilderRef build;
  LLVMTypeRef number, vector, whole, line_type, run_type;  // line_type: void (double*, i64)
  const pl_prog* prog;
  LLVMValueRef function, memory, k;
  LLVMValueRef* value;  // of each register in the function at work
  int* first_chunk;     // in which each register is computed
  int* last_chunk;      // in which it is read last
  int chunk;
  LLVMValueRef stride[PL_EMIT_STRIDES];  // memory + k by
  int stride_by[PL_EMIT_STRIDES], n_strides;
  pl_written* written;  // where orders are written out one by one; NULL: in a loop
} pl_emit;

// ---- llvm_parts.c: memory, numbers, calls, ends of sums.  Width: numbers side by side.
LLVMTypeRef pl_emit_type_of(const pl_emit* e, int width);
LLVMValueRef pl_emit_whole(const pl_emit* e, long x);
LLVMValueRef pl_emit_offset(const pl_emit* e, LLVMValueRef from, LLVMValueRef by);
LLVMValueRef pl_emit_load(pl_emit* e, LLVMValueRef base, long at, int width);
void pl_emit_store(pl_emit* e, LLVMValueRef x, LLVMValueRef base, long at, int width);
LLVMValueRef pl_emit_spread(pl_emit* e, LLVMValueRef x, int width);
LLVMValueRef pl_emit_number(const pl_emit* e, double x, int width);
LLVMValueRef pl_emit_intrinsic(pl_emit* e, const char* name, LLVMValueRef* x, int n, int width);
LLVMValueRef pl_emit_fused(pl_emit* e, LLVMValueRef a, LLVMValueRef b, LLVMValueRef c, int width);
LLVMValueRef pl_emit_call(pl_emit* e, int fn, LLVMValueRef* x, int n);
LLVMValueRef pl_emit_scaled(pl_emit* e, LLVMValueRef x, LLVMValueRef scale, LLVMValueRef rest,
                            int width);
LLVMValueRef pl_emit_total(pl_emit* e, const LLVMValueRef* part, int parts);
// of a block or a row of a matrix
typedef LLVMValueRef pl_column(pl_emit* e, const pl_prog_product* p, int j, int where);
LLVMValueRef pl_emit_product_sum(pl_emit* e, const pl_prog_product* p, int where, int width,
                                 pl_column* column, pl_column* entry);

// ---- llvm_emit.c
LLVMValueRef pl_emit_line(pl_emit* e, const pl_prog_line* l);
// a function; its first two arguments are memory and k
LLVMValueRef pl_emit_begin(pl_emit* e, const char* name, LLVMTypeRef t);

// ---- llvm_written.c: orders one by one
bool pl_written_make(pl_emit* e);  // false: no memory
void pl_written_free(pl_emit* e);
void pl_written_emit(pl_emit* e, LLVMValueRef* functions);
// What a line is at the order at work; false: nothing special.  x: the register that it reads.
bool pl_written_line(pl_emit* e, const pl_prog_line* l, LLVMValueRef x, LLVMValueRef* out);

#endif
