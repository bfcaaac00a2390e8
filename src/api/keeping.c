// The file that a run keeps its state in. It is written beside itself and renamed, now and then and
// when the run is interrupted, after the rows so far have reached the disk; so at any moment there
// is one that is whole and whose rows are there. The clock decides when, never what.
//
//     head        16 bytes "pleuel state 1", then 8 each: a number that tells the order of bytes,
//                 length, checksum of the rest
//     traits      what must be the same in the run that goes on (keeping_traits.c)
//     rows        bytes of CSV, and their hash
//     state       the run (solve/checkpoint.c), then first and last row and the events (result)
//
// A run that goes on checks head, traits and rows before anything is changed; then rows behind the
// kept ones are cut off.
#include "api/keeping.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char magic[16] = "pleuel state 1\n";
static const uint64_t order_of_bytes = 0x0102030405060708u;
typedef struct pl_kept_head {
  char magic[16];
  uint64_t order, size, sum;
} pl_kept_head;

static const double usual_interval_s = 10;
static const double part_of_time = 0.02;  // that keeping may take

// -------------------------------------------------------------------------------------------- rows
enum { BLOCK = 1 << 16 };

static size_t read_at(int fd, unsigned char* to, long at, size_t n) {
  size_t got = 0;
  while (got < n) {
    ssize_t more = pread(fd, to + got, n - got, at + (off_t)got);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) break;
    got += (size_t)more;
  }
  return got;
}

// Hash of the first n bytes; what was hashed before is not read again. false: they are not there,
// or cannot be read.
static bool hash_rows(pl_keeping* k, long n, uint64_t* hash) {
  unsigned char block[BLOCK];
  int fd = fileno(k->csv);
  while (n - k->block_bytes >= BLOCK) {
    if (read_at(fd, block, k->block_bytes, BLOCK) != BLOCK) return false;
    k->block_hash = pl_hash_bytes(block, BLOCK, k->block_hash);
    k->block_bytes += BLOCK;
  }
  size_t rest = (size_t)(n - k->block_bytes);
  if (read_at(fd, block, k->block_bytes, rest) != rest) return false;
  *hash = pl_hash_bytes(block, rest, k->block_hash);
  return true;
}

// The rows so far, on the disk.
static bool rows_so_far(pl_keeping* k, pl_kept_rows* rows) {
  *rows = (pl_kept_rows){0};
  if (k->csv == NULL) return true;
  if (fflush(k->csv) != 0 || ferror(k->csv)) return false;
  rows->bytes = ftell(k->csv);
  return rows->bytes >= 0 && fsync(fileno(k->csv)) == 0 && hash_rows(k, rows->bytes, &rows->hash);
}

static void keep_rows(pl_keeper* k, pl_kept_rows* rows) {
  pl_keep_section(k, "csv");
  pl_keep_long(k, &rows->bytes, 0, INT64_MAX);
  pl_keep_bytes(k, &rows->hash, sizeof rows->hash);
}

// ----------------------------------------------------------------------------------------- writing
static bool write_all(int fd, const void* bytes, size_t n) {
  const char* at = bytes;
  while (n > 0) {
    ssize_t done = write(fd, at, n);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += done;
    n -= (size_t)done;
  }
  return true;
}

// So that the new name of the file outlives a power cut.
static void sync_folder(pl_arena* a, const char* path) {
  int fd = open(dirname(pl_copy(a, path)), O_RDONLY | O_DIRECTORY);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

static bool replace_file(pl_arena* a, const char* path, const pl_kept_head* head,
                         const pl_keeper* rest) {
  char* temporary = pl_format(a, "%s.XXXXXX", path);
  int fd = mkstemp(temporary);
  if (fd < 0) return false;
  bool fine = write_all(fd, head, sizeof *head) && write_all(fd, rest->at, rest->next)
              && fsync(fd) == 0;
  fine &= close(fd) == 0;
  fine = fine && rename(temporary, path) == 0;
  int why = errno;
  if (!fine) unlink(temporary);
  else sync_folder(a, path);
  errno = why;
  return fine;
}

static bool write_state(pl_keeping* k, pl_run* run, pl_arena* a) {
  pl_keeper out = pl_keeper_to_write(a);
  pl_kept_rows rows;
  if (!rows_so_far(k, &rows)) return false;
  pl_traits_keep(&out, &k->traits, a);
  keep_rows(&out, &rows);
  pl_run_save(run, &out);
  pl_result_keep(k->m->result, &out);
  pl_kept_head head = {.order = order_of_bytes,
                       .size = sizeof head + out.next,
                       .sum = pl_hash_bytes(out.at, out.next, 0)};
  memcpy(head.magic, magic, sizeof magic);
  return replace_file(a, k->path, &head, &out);
}

// Memory that runs out here costs the state, not the run.
static void write_guarded(pl_keeping* k, pl_run* run) {
  pl_arena* a = pl_arena_make(k->m->ctx->alloc);
  volatile bool fine = false;
  errno = ENOMEM;
  if (a) {
    pl_guard guard;
    PL_GUARD(a, guard) fine = write_state(k, run, a);
    pl_guard_end(a, &guard);
    int why = errno;
    pl_arena_free(a);
    errno = why;
  }
  k->m->kept = fine ? PL_KEPT_YES : PL_KEPT_FAILED;
  if (fine) k->m->rows_kept = k->m->result->n_rows;
  if (!fine) snprintf(k->m->kept_why, sizeof k->m->kept_why, "%s", strerror(errno));
}

// -------------------------------------------------------------------------------------------- when
// Looks at the clock about twenty times an interval, however long a step takes.
static void set_pace(pl_keeping* k, double now) {
  double a_step = (now - k->look_s) / (double)k->pace,
         wanted = a_step > 0 ? k->every_s / 20 / a_step : 1e9;
  k->pace = wanted < 1 ? 1 : wanted > 2.0 * (double)k->pace ? 2 * k->pace : (long)wanted;
  k->countdown = k->pace;
  k->look_s = now;
}

void pl_keeping_step(void* user, pl_run* run, bool interrupted) {
  pl_keeping* k = user;
  if (!interrupted && --k->countdown > 0) return;
  double now = pl_clock();
  if (interrupted || (k->every_s >= 0 && now - k->last_s >= k->every_s)) {
    write_guarded(k, run);
    k->last_s = pl_clock();
    // a state that takes long to write is written more rarely
    if (k->every_s >= 0) k->every_s = fmax(k->every_s, (k->last_s - now) / part_of_time);
    now = k->last_s;
  }
  set_pace(k, now);
}

// ----------------------------------------------------------------------------------------- reading
static pleuel_status no_file(pl_keeping* k, int why) {
  pl_job* job = &k->m->job;
  if (why == ENOENT)
    return pl_fail(job, PLEUEL_FILE,
                   "there is nothing to go on from: %s is not there. The run is complete, or was "
                   "interrupted before its first "
                   "state was kept; without --resume it begins anew",
                   k->path);
  return pl_fail(job, PLEUEL_FILE, "%s: %s", k->path, strerror(why));
}

static pleuel_status damaged(pl_keeping* k) {
  return pl_fail(&k->m->job, PLEUEL_FILE,
                 "%s is damaged: nothing can go on from it; without --resume the run begins anew",
                 k->path);
}

// The bytes behind the head, whole and as they were written.
static pleuel_status read_file(pl_keeping* k) {
  int fd = open(k->path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return no_file(k, errno);
  struct stat st;
  pl_kept_head head;
  bool fits = fstat(fd, &st) == 0 && S_ISREG(st.st_mode)
              && read_at(fd, (unsigned char*)&head, 0, sizeof head) == sizeof head;
  fits = fits && memcmp(head.magic, magic, sizeof magic) == 0 && head.order == order_of_bytes
         && head.size == (uint64_t)st.st_size;
  size_t n = fits ? (size_t)head.size - sizeof head : 0;
  unsigned char* bytes = pl_alloc(k->m->motion, n + 1);
  fits = fits && read_at(fd, bytes, sizeof head, n) == n && pl_hash_bytes(bytes, n, 0) == head.sum;
  close(fd);
  if (!fits) return damaged(k);
  k->state = pl_keeper_to_read(k->m->motion, bytes, n);
  return PLEUEL_OK;
}

static pleuel_status check_rows(pl_keeping* k) {
  uint64_t hash;
  if (k->csv == NULL) return PLEUEL_OK;
  struct stat st;
  if (fstat(fileno(k->csv), &st) != 0 || st.st_size < k->rows.bytes)
    return pl_fail(&k->m->job, PLEUEL_FILE,
                   "rows are missing: %s goes on behind %ld bytes of them. Restore the file of "
                   "rows, or begin anew without --resume",
                   k->path, k->rows.bytes);
  if (hash_rows(k, k->rows.bytes, &hash) && hash == k->rows.hash) return PLEUEL_OK;
  return pl_fail(&k->m->job, PLEUEL_FILE,
                 "the rows were changed since %s was written: restore the file of rows, or begin "
                 "anew without --resume",
                 k->path);
}

pl_keeping* pl_keeping_make(pleuel_model* m, const pleuel_sim_options* o) {
  if (o->state == NULL) return NULL;
  pl_keeping* k = PL_NEW(m->motion, pl_keeping);
  *k = (pl_keeping){.m = m,
                    .path = pl_copy(m->motion, o->state),
                    .csv = m->csv,
                    .resumes = o->resume != 0,
                    .countdown = 1,
                    .pace = 1};
  k->every_s = o->state_every == 0 ? usual_interval_s : o->state_every;
  return k;
}

pleuel_status pl_keeping_open(pl_keeping* k, const pleuel_sim_options* o,
                              const pl_run_options* how) {
  pl_traits_of(&k->traits, k->m, o, how);
  k->last_s = k->look_s = pl_clock();
  if (!k->resumes) return PLEUEL_OK;
  PL_TRY(read_file(k));
  pl_traits kept = {0};
  pl_traits_keep(&k->state, &kept, k->m->motion);
  if (k->state.wrong) return damaged(k);
  PL_TRY(pl_traits_compare(k->m, k->path, &kept, &k->traits));
  keep_rows(&k->state, &k->rows);
  if (k->state.wrong) return damaged(k);
  return check_rows(k);
}

pleuel_status pl_keeping_resume(pl_keeping* k, pl_run* run, const pl_sink* sink) {
  PL_TRY(pl_run_load(run, &k->state, sink));
  pl_result_keep(k->m->result, &k->state);
  if (!pl_keep_is_whole(&k->state)) return damaged(k);
  k->m->resumed_at = pl_run_time(run);
  k->m->rows_kept = k->m->result->n_rows;
  if (k->csv == NULL) return PLEUEL_OK;
  bool cut = ftruncate(fileno(k->csv), k->rows.bytes) == 0
             && fseek(k->csv, k->rows.bytes, SEEK_SET) == 0;
  return cut ? PLEUEL_OK
             : pl_fail(&k->m->job, PLEUEL_FILE, "the rows cannot be written: %s", strerror(errno));
}
