// Compiled kernels: the plugin is opened when it is first asked for, objects come from the store on
// disk or are compiled.
//
// Nothing here changes a result: a compiled program gives the bits of the interpreted one, so that
// it does not matter when, or whether, a run goes over to it.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "jit/engine_impl.h"

// ----------------------------------------------------------------------------- where the plugin is
// The folder of the program or library that this code is part of.
static bool own_folder(char* folder) {
  Dl_info info;
  char path[PATH_MAX];
  bool of_program = !dladdr((void*)(uintptr_t)&pl_jit_compile, &info) || !info.dli_fname
                    || !strchr(info.dli_fname, '/') || strstr(info.dli_fname, ".so") == NULL;
  if (!realpath(of_program ? "/proc/self/exe" : info.dli_fname, path)) return false;
  char* slash = strrchr(path, '/');
  if (!slash || (size_t)(slash - path) >= PATH_MAX - 64) return false;
  *slash = '\0';
  strcpy(folder, path);
  return true;
}

// In the build tree below and beside the program, its tests and the library; then as installed.
static const char* const usual_places[] = {"src/jit", "../jit", "../../src/jit", PL_PLUGIN_FROM_BIN,
                                           PL_PLUGIN_FROM_LIB};

static const char* plugin_folder;  // of the first that asks; read once, under pthread_once

static void* open_plugin(void) {
  char folder[PATH_MAX], path[PATH_MAX + 96];
  if (plugin_folder && strlen(plugin_folder) < PATH_MAX) {
    snprintf(path, sizeof path, "%s/" PL_PLUGIN_FILE, plugin_folder);
    return dlopen(path, RTLD_NOW | RTLD_LOCAL);
  }
  if (own_folder(folder)) {
    for (size_t i = 0; i < sizeof usual_places / sizeof *usual_places; i++) {
      snprintf(path, sizeof path, "%s/%s/" PL_PLUGIN_FILE, folder, usual_places[i]);
      if (access(path, R_OK) == 0) {
        void* found = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (found) return found;
      }
    }
  }
  return dlopen(PL_PLUGIN_FOLDER "/" PL_PLUGIN_FILE, RTLD_NOW | RTLD_LOCAL);
}

// --------------------------------------------------------------------------------- opening it once
static pthread_once_t once = PTHREAD_ONCE_INIT;
// compiling and loading: one thread at a time
static pthread_mutex_t at_work = PTHREAD_MUTEX_INITIALIZER;
static const pl_plugin* plugin;
static char trouble[512];

static void open_once(void) {
  void* library = open_plugin();
  if (!library) {
    const char* why = dlerror();
    snprintf(trouble, sizeof trouble, "the compiler plugin cannot be opened: %s",
             why ? why : "not found");
    return;
  }
  void* symbol = dlsym(library, PL_PLUGIN_SYMBOL);
  const pl_plugin* (*get)(void);
  memcpy(&get, &symbol, sizeof get);
  const pl_plugin* found = symbol ? get() : NULL;
  if (found && found->version == PL_PLUGIN_VERSION) plugin = found;
  else snprintf(trouble, sizeof trouble, "the compiler plugin is of another version");
}

bool pl_jit_available(const char** why, const pl_jit_places* places) {
  static pthread_mutex_t first = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&first);
  if (places && places->plugin) plugin_folder = places->plugin;
  pthread_once(&once, open_once);
  plugin_folder = NULL;
  pthread_mutex_unlock(&first);
  if (why) *why = trouble;
  return plugin != NULL;
}

// --------------------------------------------------------------------------------------- compiling
struct pl_jit_code {
  void* loaded;
};

static uint64_t key_of(const pl_prog* const* progs, int n) {
  const char* text = plugin->describe();
  uint64_t h = pl_hash_bytes(text, strlen(text), PL_PLUGIN_VERSION);
  h = pl_hash_bytes(PL_VERSION, strlen(PL_VERSION), h);
  for (int i = 0; i < n; i++) h = pl_prog_hash(progs[i], h);
  return h;
}

static void* load(const unsigned char* object, size_t size, const pl_prog* const* progs, int n,
                  pl_prog_run** run) {
  return plugin->load(object, size, progs, n, run, trouble, sizeof trouble);
}

static void* compile(const pl_prog* const* progs, int n, pl_prog_run** run, uint64_t key,
                     const char* cache) {
  unsigned char* object = NULL;
  size_t size = 0;
  if (!plugin->compile(progs, n, &object, &size, trouble, sizeof trouble)) return NULL;
  void* loaded = load(object, size, progs, n, run);
  if (loaded) pl_store_put(cache, key, object, size);
  plugin->release(object);
  return loaded;
}

pl_jit_code* pl_jit_compile(pl_arena* a, const pl_prog* const* progs, int n, pl_prog_run** run,
                            pl_jit_story* story, const pl_jit_places* places) {
  const char* cache = places ? places->cache : NULL;
  pl_jit_story none;
  if (!story) story = &none;
  *story = (pl_jit_story){0};
  if (!pl_jit_available(NULL, places)) return NULL;
  double begin = pl_clock();
  pthread_mutex_lock(&at_work);
  uint64_t key = key_of(progs, n);
  size_t size = 0;
  unsigned char* object = pl_store_get(cache, key, &size);
  void* loaded = object ? load(object, size, progs, n, run) : NULL;
  free(object);
  story->stored = loaded != NULL;
  if (!loaded) loaded = compile(progs, n, run, key, cache);
  pthread_mutex_unlock(&at_work);
  story->seconds = pl_clock() - begin;
  if (!loaded) return NULL;
  pl_jit_code* code = PL_NEW(a, pl_jit_code);
  code->loaded = loaded;
  return code;
}

void pl_jit_free(pl_jit_code* code) {
  if (!code || !code->loaded) return;
  pthread_mutex_lock(&at_work);
  plugin->unload(code->loaded);
  pthread_mutex_unlock(&at_work);
  code->loaded = NULL;
}
