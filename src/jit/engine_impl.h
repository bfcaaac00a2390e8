// Between the files that open the plugin and keep its objects.
#ifndef PL_JIT_ENGINE_IMPL_H
#define PL_JIT_ENGINE_IMPL_H

#include "jit/plugin.h"

// ---- store.c: objects on disk. Everything that goes wrong there only means that an object is not
// found. from malloc; NULL: not there, or damaged
// cache: NULL the usual folder, "" none.
unsigned char* pl_store_get(const char* cache, uint64_t key, size_t* size);
void pl_store_put(const char* cache, uint64_t key, const unsigned char* object, size_t size);

#endif
