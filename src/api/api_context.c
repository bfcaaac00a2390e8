// The context: memory, language, the last sentence, the wish to stop; and the way of every public
// function: options are copied and the work is done under a guard, so that memory that runs out
// becomes a status.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "api/api_impl.h"
#include "pleuel.h"

const char* pleuel_version(void) { return PLEUEL_VERSION; }

// ------------------------------------------------------------------------------------- context
pleuel* pleuel_open(const pleuel_allocator* alloc) {
  pl_arena* arena = pl_arena_make(alloc);
  if (!arena) return NULL;
  pleuel* volatile ctx = NULL;
  pl_guard guard;
  PL_GUARD(arena, guard) {
    pleuel* c = PL_NEW(arena, pleuel);
    c->arena = arena;
    if (alloc) {
      pleuel_allocator* copy = PL_NEW(arena, pleuel_allocator);
      *copy = *alloc;
      c->alloc = copy;
    }
    ctx = c;
  }
  pl_guard_end(arena, &guard);
  if (!ctx) pl_arena_free(arena);
  return ctx;
}

void pleuel_close(pleuel* ctx) {
  if (!ctx) return;
  while (ctx->first) pleuel_model_free(ctx->first);
  pl_arena_free(ctx->arena);
}

void pleuel_thread_end(void) { pl_algebra_thread_end(); }

const char* pleuel_message(const pleuel* ctx) { return ctx ? ctx->message : ""; }

pl_language pl_api_language(const char* name, pl_language otherwise) {
  if (!name || !*name) return otherwise;
  return strncmp(name, "de", 2) == 0 ? PL_GERMAN : PL_ENGLISH;
}

// What is asked for, else what the file names, else what the context speaks: messages and solution
// alike.
pl_language pl_api_language_of(const pleuel_model* m, const char* asked) {
  return pl_api_language(asked, m->job.lang);
}

pleuel_status pl_api_fail(pleuel* ctx, pleuel_status s, const char* sentence) {
  snprintf(ctx->message, sizeof ctx->message, "%s", pl_in_language(ctx->lang, sentence));
  return s;
}

pleuel_status pleuel_set_language(pleuel* ctx, const char* lang) {
  if (!ctx) return PLEUEL_USAGE;
  ctx->message[0] = '\0';
  if (!lang || (strncmp(lang, "en", 2) != 0 && strncmp(lang, "de", 2) != 0)) {
    return pl_api_fail(ctx, PLEUEL_USAGE, "languages are en and de");
  }
  ctx->lang = pl_api_language(lang, PL_ENGLISH);
  return PLEUEL_OK;
}

void pleuel_set_memory_limit(pleuel* ctx, size_t bytes) {
  if (ctx) ctx->limit = bytes;
}

void pleuel_interrupt(pleuel* ctx) {
  if (ctx) atomic_store(&ctx->interrupted.asked, 1);
}

void pleuel_interrupt_clear(pleuel* ctx) {
  if (ctx) atomic_store(&ctx->interrupted.asked, 0);
}

// ---------------------------------------------------------------------------------- progress, poll
static bool look(void* user) {
  pleuel* ctx = user;
  ctx->where.done = ctx->interrupted.done;
  ctx->where.of = ctx->interrupted.of;
  bool stop = ctx->progress && ctx->progress(ctx->progress_user, &ctx->where) != 0;
  if (!stop) stop = ctx->poll && ctx->poll(ctx->poll_user) != 0;
  return stop;
}

static void set_look(pleuel* ctx) {
  ctx->interrupted.user = ctx;
  ctx->interrupted.look = ctx->progress || ctx->poll ? look : NULL;
}

void pleuel_set_progress(pleuel* ctx, int (*progress)(void* user, const pleuel_progress* where),
                         void* user) {
  if (!ctx) return;
  ctx->progress = progress;
  ctx->progress_user = user;
  set_look(ctx);
}

void pleuel_set_poll(pleuel* ctx, int (*poll)(void* user), void* user) {
  if (!ctx) return;
  ctx->poll = poll;
  ctx->poll_user = user;
  set_look(ctx);
}

void pl_api_stage(pleuel* ctx, pleuel_stage stage) {
  if (!ctx) return;
  ctx->where = (pleuel_progress){.size = sizeof ctx->where,
                                 .stage = stage,
                                 .t = (double)NAN,
                                 .t_begin = (double)NAN,
                                 .t_end = (double)NAN,
                                 .energy_drift = (double)NAN};
  ctx->interrupted.done = ctx->interrupted.of = 0;
  if (ctx->interrupted.look && !ctx->interrupted.stopped) ctx->interrupted.stopped = look(ctx);
}

static const char* folder_of(pleuel* ctx, const char* name) {
  return name ? pl_copy(ctx->arena, name) : NULL;
}

pleuel_status pleuel_set_folders(pleuel* ctx, const char* cache, const char* plugin) {
  if (!ctx) return PLEUEL_USAGE;
  volatile pleuel_status s = PLEUEL_NO_MEMORY;
  pl_guard guard;
  PL_GUARD(ctx->arena, guard) {
    ctx->places.cache = folder_of(ctx, cache);
    ctx->places.plugin = folder_of(ctx, plugin);
    s = PLEUEL_OK;
  }
  pl_guard_end(ctx->arena, &guard);
  return s;
}

// ----------------------------------------------------------------------------------- guarded calls
void pl_api_copy(void* to, size_t size, const void* from) {
  memset(to, 0, size);
  if (!from) return;
  size_t given;
  memcpy(&given, from, sizeof given);
  memcpy(to, from, given < size ? given : size);
}

pleuel_status pl_api_take(pleuel* ctx, void* to, size_t size, const void* from) {
  size_t given = 1;
  if (from) memcpy(&given, from, sizeof given);
  if (given == 0)
    return pl_api_fail(ctx, PLEUEL_USAGE,
                       "options without their size: declare them with PLEUEL_OPTIONS");
  pl_api_copy(to, size, from);
  return PLEUEL_OK;
}

pleuel_status pl_api_give(void* to, const void* all, size_t size) {
  size_t room;
  memcpy(&room, to, sizeof room);
  if (room == 0) return PLEUEL_USAGE;
  memcpy(to, all, room < size ? room : size);
  memcpy(to, &room, sizeof room);  // the size stays that of the caller
  return PLEUEL_OK;
}

// Runs work under a guard.  Status and sentence of the job become those of the context.
pleuel_status pl_api_guarded(pleuel_model* m, pl_api_work* work, void* argument) {
  pleuel* ctx = m->ctx;
  ctx->message[0] = '\0';
  if (m->broken)
    return pl_api_fail(ctx, PLEUEL_NO_MEMORY, "memory ran out earlier; free this model");
  m->job.message[0] = '\0';
  m->job.status = PLEUEL_OK;
  ctx->interrupted.stopped = false;
  volatile pleuel_status status = PLEUEL_NO_MEMORY;
  pl_guard guard;
  PL_GUARD(m->arena, guard) { status = work(m, argument); }
  else {
    status = guard.status;
    m->broken = true;
  }
  pl_guard_end(m->arena, &guard);
  if (m->broken && status == PLEUEL_NO_MEMORY) {
    pl_api_fail(ctx, PLEUEL_NO_MEMORY,
                ctx->limit ? "this takes more memory than the limit allows" : "memory ran out");
  } else if (m->job.message[0]) {
    pl_api_fail(ctx, status, m->job.message);
  }
  return status;
}

typedef struct pl_working {
  pl_api_work* work;
  void* argument;
} pl_working;

// Each arena has a guard of its own; whichever runs out, the model is left as broken.
static pleuel_status in_work(pleuel_model* m, void* argument) {
  const pl_working* w = argument;
  volatile pleuel_status status = PLEUEL_NO_MEMORY;
  volatile bool done = false;
  pl_guard work, motion, recorded;
  pl_arena_rewind(m->work, m->work_empty);
  m->job.arena = m->work;
  PL_GUARD(m->recorded_in, recorded) {
    PL_GUARD(m->motion, motion) {
      PL_GUARD(m->work, work) {
        status = w->work(m, w->argument);
        done = true;
      }
      pl_guard_end(m->work, &work);
    }
    pl_guard_end(m->motion, &motion);
  }
  pl_guard_end(m->recorded_in, &recorded);
  m->job.arena = m->arena;
  m->broken = m->broken || !done;
  return status;
}

pleuel_status pl_api_worked(pleuel_model* m, pl_api_work* work, void* argument) {
  pl_working w = {work, argument};
  return pl_api_guarded(m, in_work, &w);
}
