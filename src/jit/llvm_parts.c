// What programs consist of in LLVM's intermediate language: memory, numbers, calls, and the ends of
// sums.
#include "jit/llvm_emit_impl.h"

#include <string.h>

LLVMTypeRef pl_emit_type_of(const pl_emit* e, int width) {
  return width == 1   ? e->number
         : width == 8 ? e->vector
                      : LLVMVectorType(e->number, (unsigned)width);
}

LLVMValueRef pl_emit_whole(const pl_emit* e, long x) {
  return LLVMConstInt(e->whole, (unsigned long long)x, 1);
}

// ------------------------------------------------------------------------------------------ memory
LLVMValueRef pl_emit_offset(const pl_emit* e, LLVMValueRef from, LLVMValueRef by) {
  return LLVMBuildGEP2(e->build, e->number, from, &by, 1, "");
}

static LLVMValueRef pointer(pl_emit* e, LLVMValueRef base, long at, int width) {
  LLVMValueRef p = at ? pl_emit_offset(e, base, pl_emit_whole(e, at)) : base;
  return width > 1
             ? LLVMBuildBitCast(e->build, p, LLVMPointerType(pl_emit_type_of(e, width), 0), "")
             : p;
}

LLVMValueRef pl_emit_load(pl_emit* e, LLVMValueRef base, long at, int width) {
  LLVMValueRef x = LLVMBuildLoad2(e->build, pl_emit_type_of(e, width), pointer(e, base, at, width),
                                  "");
  LLVMSetAlignment(x, 8);
  return x;
}

void pl_emit_store(pl_emit* e, LLVMValueRef x, LLVMValueRef base, long at, int width) {
  LLVMSetAlignment(LLVMBuildStore(e->build, x, pointer(e, base, at, width)), 8);
}

LLVMValueRef pl_emit_spread(pl_emit* e, LLVMValueRef x, int width) {
  if (width == 1) return x;
  LLVMValueRef none = LLVMGetUndef(pl_emit_type_of(e, width)),
               one = LLVMBuildInsertElement(e->build, none, x, pl_emit_whole(e, 0), "");
  LLVMValueRef zeros =
      LLVMConstNull(LLVMVectorType(LLVMInt32TypeInContext(e->context), (unsigned)width));
  return LLVMBuildShuffleVector(e->build, one, none, zeros, "");
}

LLVMValueRef pl_emit_number(const pl_emit* e, double x, int width) {
  LLVMValueRef one = LLVMConstReal(e->number, x), all[8];
  if (width == 1) return one;
  for (int l = 0; l < width; l++) all[l] = one;
  return LLVMConstVector(all, (unsigned)width);
}

// ------------------------------------------------------------------------------------------- calls
LLVMValueRef pl_emit_intrinsic(pl_emit* e, const char* name, LLVMValueRef* x, int n, int width) {
  LLVMTypeRef t = pl_emit_type_of(e, width);
  unsigned id = LLVMLookupIntrinsicID(name, strlen(name));
  LLVMValueRef f = LLVMGetIntrinsicDeclaration(e->module, id, &t, 1);
  return LLVMBuildCall2(e->build, LLVMIntrinsicGetType(e->context, id, &t, 1), f, x, (unsigned)n,
                        "");
}

LLVMValueRef pl_emit_fused(pl_emit* e, LLVMValueRef a, LLVMValueRef b, LLVMValueRef c, int width) {
  LLVMValueRef x[] = {a, b, c};
  return pl_emit_intrinsic(e, "llvm.fma", x, 3, width);
}

static const char* const function_name[] = {
#define PL_LIBRARY(name, n) #name,
#include "program/library.def"
};

// Functions of the C library are called as they are: not known to the compiler, so never computed
// by it.
static LLVMValueRef call_scalar(pl_emit* e, int fn, LLVMValueRef* x, int n) {
  LLVMTypeRef parameters[2] = {e->number, e->number},
              t = LLVMFunctionType(e->number, parameters, (unsigned)n, 0);
  LLVMValueRef f = LLVMGetNamedFunction(e->module, function_name[fn]);
  unsigned plain = LLVMGetEnumAttributeKindForName("nobuiltin", 9);
  if (!f) f = LLVMAddFunction(e->module, function_name[fn], t);
  LLVMValueRef call = LLVMBuildCall2(e->build, t, f, x, (unsigned)n, "");
  LLVMAddCallSiteAttribute(call, (LLVMAttributeIndex)LLVMAttributeFunctionIndex,
                           LLVMCreateEnumAttribute(e->context, plain, 0));
  return call;
}

LLVMValueRef pl_emit_call(pl_emit* e, int fn, LLVMValueRef* x, int n) {
  if (e->prog->width == 1) return call_scalar(e, fn, x, n);
  LLVMValueRef result = LLVMGetUndef(e->vector);
  for (int l = 0; l < 8; l++) {
    LLVMValueRef part[2];
    for (int i = 0; i < n; i++)
      part[i] = LLVMBuildExtractElement(e->build, x[i], pl_emit_whole(e, l), "");
    result = LLVMBuildInsertElement(e->build, result, call_scalar(e, fn, part, n),
                                    pl_emit_whole(e, l), "");
  }
  return result;
}

// ------------------------------------------------------------------------------------ ends of sums
LLVMValueRef pl_emit_scaled(pl_emit* e, LLVMValueRef x, LLVMValueRef scale, LLVMValueRef rest,
                            int width) {
  return pl_emit_fused(e, x, rest, LLVMBuildFMul(e->build, x, scale, ""), width);
}

LLVMValueRef pl_emit_total(pl_emit* e, const LLVMValueRef* part, int parts) {
  LLVMValueRef x = LLVMBuildFAdd(e->build, part[0], part[1], "");
  return parts == 2 ? x
                    : LLVMBuildFAdd(e->build, x, LLVMBuildFAdd(e->build, part[2], part[3], ""), "");
}

LLVMValueRef pl_emit_product_sum(pl_emit* e, const pl_prog_product* p, int where, int width,
                                 pl_column* column, pl_column* entry) {
  LLVMValueRef part[4], last[2];
  for (int i = 0; i < 4; i++) part[i] = last[i / 2] = pl_emit_number(e, 0, width);
  int early = p->n - p->late;
  for (int j = 0; j < early; j++)
    part[j % 4] = pl_emit_fused(e, column(e, p, j, where), entry(e, p, j, where), part[j % 4],
                                width);
  last[0] = pl_emit_total(e, part, 4);
  for (int j = early; j < p->n; j++) {
    LLVMValueRef* to = &last[(j - early) % 2];
    *to = pl_emit_fused(e, column(e, p, j, where), entry(e, p, j, where), *to, width);
  }
  return p->late > 1 ? LLVMBuildFAdd(e->build, last[0], last[1], "") : last[0];
}
