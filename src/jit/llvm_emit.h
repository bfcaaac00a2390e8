// From programs to LLVM's intermediate language.  For files of the plugin.
#ifndef PL_LLVM_EMIT_H
#define PL_LLVM_EMIT_H

#include <llvm-c/Core.h>

#include "jit/plugin.h"

// Adds a function `void name(double* memory, int from, int to)` to the module, with the functions
// that it is cut into.
void pl_llvm_emit(LLVMContextRef context, LLVMModuleRef module, const pl_prog* prog);

#endif
