// The files of a run: rows, which lie in FILE.part until they are complete, and FILE.resume, the
// state that a run which was interrupted goes on from (pleuel.h, pleuel_sim_options).
//
// FILE.part has a name of its own so that rows outlive the program; it is locked while a run writes
// it.
#include "cli.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static bool exists(const char* path) { return access(path, F_OK) == 0; }

static int add_ending(char out[4096], const char* path, const char* ending) {
  int n = snprintf(out, 4096, "%s%s", path, ending);
  return n < 0 || n >= 4096 ? cli_error(EXIT_FILE, "the name is too long: %s", path) : EXIT_DONE;
}

static int cannot_write(const char* path) {
  return cli_error(EXIT_FILE, "%s cannot be written: %s", path, strerror(errno));
}

// Whether `path` still names the file that is open: another run may have finished it in between.
static bool is_named(int fd, const char* path) {
  struct stat open_one, named;
  return fstat(fd, &open_one) == 0 && stat(path, &named) == 0 && open_one.st_ino == named.st_ino
         && open_one.st_dev == named.st_dev;
}

// Opens and locks; -1 after a message.
static int open_locked(const char* path, int flags) {
  for (int round = 0; round < 8; round++) {
    int fd = open(path, flags | O_RDWR | O_CLOEXEC, 0666);
    if (fd < 0) {
      cannot_write(path);
      return -1;
    }
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(fd);
      cli_error(EXIT_FILE, "another run writes %s just now", path);
      return -1;
    }
    if (is_named(fd, path)) return fd;
    close(fd);
  }
  cannot_write(path);
  return -1;
}

static int open_stream(cli_rows* r, int fd, const char* how) {
  r->file.to = fdopen(fd, how);
  if (r->file.to) return EXIT_DONE;
  close(fd);
  return cannot_write(r->file.temporary);
}

// --------------------------------------------------------------------------------------- beginning
static int begin_anew(cli_rows* r, const cli_options* o) {
  const char* path = r->file.path;
  struct stat st;
  bool there = stat(path, &st) == 0, interrupted = exists(r->state);
  if (there && !o->force && interrupted)
    return cli_error(EXIT_FILE,
                     "%s exists already, of a run that was interrupted: --resume goes on with it, "
                     "-f begins anew",
                     path);
  if (there && !o->force) return cli_error(EXIT_FILE, "%s exists already; -f replaces it", path);
  if (interrupted && !o->force)
    return cli_error(
        EXIT_FILE, "a run into %s was interrupted: --resume goes on with it, -f begins anew", path);
  int fd = open_locked(r->file.temporary, O_CREAT);
  if (fd < 0) return EXIT_FILE;
  unlink(r->state);
  if (there) fchmod(fd, st.st_mode & 07777);
  if (ftruncate(fd, 0) != 0) {
    close(fd);
    return cannot_write(r->file.temporary);
  }
  cli_remove_on_abort(r->file.temporary);
  cli_keep_on_abort(r->state);
  return open_stream(r, fd, "w+");
}

static int go_on(cli_rows* r, const cli_options* o) {
  const char *path = r->file.path, *part = r->file.temporary;
  if (!exists(r->state))
    return cli_error(EXIT_FILE,
                     "there is nothing to go on from: %s is not there. The run is complete, or was "
                     "interrupted before its "
                     "first state was kept; without --resume it begins anew",
                     r->state);
  bool in_part = exists(part);
  if (!in_part && !exists(path))
    return cli_error(EXIT_FILE, "the rows of %s are gone: without --resume the run begins anew",
                     r->state);
  if (in_part && exists(path) && !o->force)
    return cli_error(EXIT_FILE, "%s exists already; -f replaces it", path);
  int fd = open_locked(in_part ? part : path, 0);
  if (fd < 0) return EXIT_FILE;
  r->renamed = !in_part;
  if (r->renamed && rename(path, part) != 0) {
    close(fd);
    return cannot_write(part);
  }
  return open_stream(r, fd, "r+");
}

int cli_rows_open(cli_rows* r, const cli_options* o) {
  *r = (cli_rows){.file = {.path = o->output}};
  struct stat st;
  bool there = stat(o->output, &st) == 0;
  if (there && S_ISDIR(st.st_mode)) return cli_error(EXIT_FILE, "%s is a folder", o->output);
  if (there && !S_ISREG(st.st_mode)) {
    if (o->resume) return cli_error(EXIT_USAGE, "--resume needs rows in a file: -o FILE.csv");
    return cli_file_open(&r->file, o->output, o->force);
  }
  int code = add_ending(r->state, o->output, ".resume");
  if (!code) code = add_ending(r->file.temporary, o->output, ".part");
  if (code) return code;
  return o->resume ? go_on(r, o) : begin_anew(r, o);
}

// ------------------------------------------------------------------------------------------ ending
static int could_not(const cli_rows* r, int why) {
  int code = cli_error(EXIT_FILE, "%s could not be written: %s", r->file.path, strerror(why));
  if (exists(r->state)) cli_error(code, "what was computed is kept: --resume goes on with it");
  return code;
}

int cli_rows_close(cli_rows* r, pleuel_status s, bool started) {
  if (r->file.to == NULL) return EXIT_DONE;
  if (r->state[0] == '\0') {
    if (started) return cli_file_close(&r->file);
    cli_file_drop(&r->file);
    return EXIT_DONE;
  }
  bool bad = fflush(r->file.to) != 0 || ferror(r->file.to);
  int why = errno;
  bad |= fclose(r->file.to) != 0;
  r->file.to = NULL;
  cli_remove_on_abort(NULL);
  bool kept = exists(r->state);
  if (!started) {
    // as it was before; when memory ran out on the way, the rows so far stay beside the state
    if (r->renamed)
      return rename(r->file.temporary, r->file.path) == 0 ? EXIT_DONE : could_not(r, errno);
    if (!kept) unlink(r->file.temporary);
    return EXIT_DONE;
  }
  if (bad && !kept) unlink(r->file.temporary);
  if (bad) return could_not(r, why);
  if (rename(r->file.temporary, r->file.path) != 0) return could_not(r, errno);
  if (s != PLEUEL_INTERRUPTED) unlink(r->state);
  return EXIT_DONE;
}

// ---------------------------------------------------------------------------------- how it goes on
static void add(char* out, size_t size, const char* text) {
  size_t n = strlen(out);
  if (n < size) snprintf(out + n, size - n, "%s", text);
}

// A word of a command line, in quotes where the shell would take it apart.
static void add_word(char* out, size_t size, const char* word) {
  bool plain = *word != '\0';
  for (const char* c = word; *c; c++)
    plain = plain
            && ((unsigned char)*c > 127 || (*c >= '0' && *c <= '9') || (*c >= 'a' && *c <= 'z')
                || (*c >= 'A' && *c <= 'Z') || strchr("_./=,:+@%-", *c));
  add(out, size, " ");
  if (plain) {
    add(out, size, word);
    return;
  }
  add(out, size, "'");
  for (const char* c = word; *c; c++) add(out, size, *c == '\'' ? "'\\''" : (char[]){*c, '\0'});
  add(out, size, "'");
}

void cli_resume_command(char* out, size_t size, const cli_options* o) {
  const char* base = (const char*)o;
  snprintf(out, size, "pleuel sim");
  add_word(out, size, o->files[0]);
  for (const cli_flag* f = flags_sim; f->name; f++) {
    if (strcmp(f->name, "resume") == 0 || strcmp(f->name, "force") == 0) continue;
    char name[40];
    if (f->letter) snprintf(name, sizeof name, "-%c", f->letter);
    else snprintf(name, sizeof name, "--%s", f->name);
    if (f->kind == CLI_SETTING) {
      for (int i = 0; i < o->n_settings; i++) {
        char setting[512];
        snprintf(setting, sizeof setting, "%s=%s", o->settings[i].name, o->settings[i].value);
        add_word(out, size, name);
        add_word(out, size, setting);
      }
    } else if (f->kind == CLI_SWITCH) {
      if (*(const bool*)(base + f->offset)) add_word(out, size, name);
    } else {
      const char* value = *(const char* const*)(const void*)(base + f->offset);
      if (value) add_word(out, size, name);
      if (value) add_word(out, size, value);
    }
  }
  add_word(out, size, "--resume");
}
