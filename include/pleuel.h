/* pleuel: constrained classical mechanics, from a model text to a worked solution and the motion.
 *
 * This header is the whole public interface.  It reads from top to bottom as a course: one call that does it all,
 * then the steps, then the options.  Strings are UTF-8.  Everything is SI inside.
 *
 * A context (pleuel*) and what was made from it belong to one thread at a time; several contexts may live in several
 * threads.  The library keeps no global state, prints nothing and never ends the process.
 */
#ifndef PLEUEL_H
#define PLEUEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PLEUEL_VERSION "0.1.0"
#define PLEUEL_VERSION_MAJOR 0
#define PLEUEL_VERSION_MINOR 1
#define PLEUEL_VERSION_PATCH 0

/* ------------------------------------------------------------------------------------------------ status */

/* pleuel_status tells how a call ended.  PLEUEL_OK is 0.  The sentence with numbers is in pleuel_message. */
typedef enum pleuel_status {
  PLEUEL_OK = 0,
  PLEUEL_EXPECT_FAILED,  /* done, but an `expect` of the model or a check of our own is false          */
  PLEUEL_USAGE,          /* a call with arguments that make no sense                                    */
  PLEUEL_MODEL_ERROR,    /* the text has errors: see the diagnostics                                    */
  PLEUEL_CONTRADICTION,  /* constraints or start values contradict each other                           */
  PLEUEL_NO_CLOSED_FORM, /* a closed form was asked for and not found                                   */
  PLEUEL_NUMERICAL,      /* the computation cannot go on: residual, step size, iteration               */
  PLEUEL_SINGULAR,       /* the constraints lose rank: singular position                                */
  PLEUEL_FILE,           /* a file could not be read or written                                         */
  PLEUEL_INTERRUPTED,    /* stopped from outside; what was done is kept                                 */
  PLEUEL_NO_MEMORY,      /* memory, or the limit set for it, ran out                                    */
  PLEUEL_UNSUPPORTED     /* understood, but this version cannot compute it                              */
} pleuel_status;

/* pleuel_status_name returns the identifier of a status as text, "PLEUEL_OK".  Static, never NULL. */
const char *pleuel_status_name(pleuel_status status);

/* ------------------------------------------------------------------------------------------------ context */

/* pleuel is a context: memory, last status and message, diagnostics of the last call. */
typedef struct pleuel pleuel;

/* pleuel_allocator replaces malloc and free.  size in bytes; `take` returns NULL when there is no more. */
typedef struct pleuel_allocator {
  void *(*take)(void *user, size_t size);
  void (*give)(void *user, void *block);
  void *user;
} pleuel_allocator;

/* pleuel_open makes a context.  alloc may be NULL.  NULL when memory is short.  Close with pleuel_close. */
pleuel *pleuel_open(const pleuel_allocator *alloc);
void pleuel_close(pleuel *ctx);

/* pleuel_message returns the sentence of the last failure, "" if none.  Owned by ctx, valid until the next call. */
const char *pleuel_message(const pleuel *ctx);

#ifdef __cplusplus
}
#endif
#endif
