// Compiled objects on disk: $XDG_CACHE_HOME/pleuel (or ~/.cache/pleuel), one file an object, named
// by its key.
//
// A file is written under another name and renamed, so that readers see all of it or nothing,
// whoever writes at the same time. Its head holds key, length and a hash of the content: what does
// not fit is removed and compiled again. When the folder grows beyond its limit the files that were
// used least recently go first; reading a file marks it as used. A folder that cannot be written is
// no error. PLEUEL_CACHE=off switches the store off.
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "jit/engine_impl.h"

static const size_t most_bytes = (size_t)64 << 20;  // of all files together
static const size_t largest = (size_t)16 << 20;     // of one
enum { MOST_FILES = 4096 };

typedef struct pl_store_head {
  char magic[8];
  uint64_t key, size, hash;
} pl_store_head;
static const char magic[8] = "PLJIT01";

// ------------------------------------------------------------------------------------------ folder
static bool make_folder(const char* path) {
  struct stat s;
  if (mkdir(path, 0700) != 0 && errno != EEXIST) return false;
  // objects are executed: a folder of somebody else, or that others may write to, is not used
  return stat(path, &s) == 0 && S_ISDIR(s.st_mode) && s.st_uid == geteuid()
         && (s.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

// The folder of the caller is used as it is.
static bool own_folder_of(const char* cache, char* path, bool make) {
  int n = snprintf(path, PATH_MAX, "%s", cache);
  struct stat s;
  if (cache[0] == '\0' || n < 0 || n > PATH_MAX - 96) return false;
  if (make) return make_folder(path);
  return stat(path, &s) == 0 && s.st_uid == geteuid() && (s.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

static bool folder(const char* given, char* path, bool make) {
  if (given) return own_folder_of(given, path, make);
  const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME"),
             *off = getenv("PLEUEL_CACHE");
  int n;
  if (off && strcmp(off, "off") == 0) return false;
  if (cache && cache[0] == '/') n = snprintf(path, PATH_MAX, "%s", cache);
  else if (home && home[0] == '/') n = snprintf(path, PATH_MAX, "%s/.cache", home);
  else return false;
  if (n < 0 || n > PATH_MAX - 96) return false;
  if (make) mkdir(path, 0700);
  strcpy(path + n, "/pleuel");
  struct stat s;
  return make ? make_folder(path)
              : stat(path, &s) == 0 && s.st_uid == geteuid()
                    && (s.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

static bool file_of(const char* cache, char* path, uint64_t key, bool make) {
  if (!folder(cache, path, make)) return false;
  size_t n = strlen(path);
  snprintf(path + n, PATH_MAX - n, "/%016llx.o", (unsigned long long)key);
  return true;
}

// ----------------------------------------------------------------------------------------- reading
static bool read_all(int file, void* to, size_t n) {
  for (size_t done = 0; done < n;) {
    ssize_t got = read(file, (char*)to + done, n - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += (size_t)got;
  }
  return true;
}

static unsigned char* read_object(int file, uint64_t key, size_t* size) {
  pl_store_head head;
  struct stat s;
  if (fstat(file, &s) != 0 || !S_ISREG(s.st_mode) || s.st_uid != geteuid()
      || !read_all(file, &head, sizeof head))
    return NULL;
  if (memcmp(head.magic, magic, sizeof magic) != 0 || head.key != key || head.size > largest
      || (uint64_t)s.st_size != sizeof head + head.size)
    return NULL;
  unsigned char* object = malloc(head.size + 1);
  if (object && read_all(file, object, head.size)
      && pl_hash_bytes(object, head.size, key) == head.hash) {
    *size = head.size;
    return object;
  }
  free(object);
  return NULL;
}

unsigned char* pl_store_get(const char* cache, uint64_t key, size_t* size) {
  char path[PATH_MAX];
  if (!file_of(cache, path, key, false)) return NULL;
  int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return NULL;
  unsigned char* object = read_object(file, key, size);
  if (object) futimens(file, NULL);  // used just now
  else unlink(path);
  close(file);
  return object;
}

// ----------------------------------------------------------------------------------------- writing
static bool write_all(int file, const void* from, size_t n) {
  for (size_t done = 0; done < n;) {
    ssize_t put = write(file, (const char*)from + done, n - done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    done += (size_t)put;
  }
  return true;
}

typedef struct pl_store_file {
  char name[32];
  struct timespec used;
  size_t size;
} pl_store_file;

static int by_age(const void* a, const void* b) {
  const struct timespec *x = &((const pl_store_file*)a)->used,
                        *y = &((const pl_store_file*)b)->used;
  if (x->tv_sec != y->tv_sec) return x->tv_sec < y->tv_sec ? -1 : 1;
  return x->tv_nsec < y->tv_nsec ? -1 : x->tv_nsec > y->tv_nsec;
}

// Removes the oldest until what is left is below the limit.
static void trim(const char* path) {
  DIR* d = opendir(path);
  if (!d) return;
  pl_store_file* list = malloc(MOST_FILES * sizeof *list);
  int n = 0;
  size_t total = 0;
  for (struct dirent* e; list && n < MOST_FILES && (e = readdir(d)) != NULL;) {
    struct stat s;
    if (strlen(e->d_name) >= sizeof list->name || !strstr(e->d_name, ".o")) continue;
    if (fstatat(dirfd(d), e->d_name, &s, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(s.st_mode)) continue;
    strcpy(list[n].name, e->d_name);
    list[n].used = s.st_mtim;
    list[n].size = (size_t)s.st_size;
    total += list[n++].size;
  }
  if (list && total > most_bytes) qsort(list, (size_t)n, sizeof *list, by_age);
  for (int i = 0; i < n && total > most_bytes; i++) {
    unlinkat(dirfd(d), list[i].name, 0);
    total -= list[i].size;
  }
  free(list);
  closedir(d);
}

void pl_store_put(const char* cache, uint64_t key, const unsigned char* object, size_t size) {
  char path[PATH_MAX], draft[PATH_MAX + 8];
  if (size > largest || !file_of(cache, path, key, true)) return;
  pl_store_head head = {.key = key, .size = size, .hash = pl_hash_bytes(object, size, key)};
  memcpy(head.magic, magic, sizeof magic);
  snprintf(draft, sizeof draft, "%s.XXXXXX", path);
  int file = mkostemp(draft, O_CLOEXEC);
  if (file < 0) return;
  bool fine = write_all(file, &head, sizeof head) && write_all(file, object, size);
  if (close(file) != 0 || !fine || rename(draft, path) != 0) unlink(draft);
  *strrchr(path, '/') = '\0';
  trim(path);
}
