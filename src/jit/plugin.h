// What the compiler plugin offers. It is a shared object that links LLVM; the library opens it when
// a compiled kernel pays.
#ifndef PL_JIT_PLUGIN_H
#define PL_JIT_PLUGIN_H

#include "jit/jit.h"

// of this header and of the codes: part of the key of what is kept on disk
enum { PL_PLUGIN_VERSION = 4 };
#define PL_PLUGIN_SYMBOL "pl_jit_plugin_4"

typedef struct pl_plugin {
  int version;
  // The compiler and the processor it compiles for, as text: part of the key of an object.
  const char* (*describe)(void);
  // Compiles programs to an object file in memory; *object is freed with release. False: message
  // says why.
  bool (*compile)(const pl_prog* const* progs, int n, unsigned char** object, size_t* size,
                  char* message, size_t room);
  void (*release)(unsigned char* object);
  // Makes an object callable; run[i] is the function of prog i.  NULL: message says why.
  void* (*load)(const unsigned char* object, size_t size, const pl_prog* const* progs, int n,
                pl_prog_run** run, char* message, size_t room);
  void (*unload)(void* loaded);
} pl_plugin;

#endif
