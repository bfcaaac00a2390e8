// Models in, results out: FILE or -, several files, files that appear only when they are complete.
#include "cli.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int cli_exit_code(pleuel_status s) {
  switch (s) {
    case PLEUEL_OK: return EXIT_DONE;
    case PLEUEL_EXPECT_FAILED: return EXIT_EXPECT;
    case PLEUEL_USAGE: return EXIT_USAGE;
    case PLEUEL_MODEL_ERROR: return EXIT_MODEL;
    case PLEUEL_CONTRADICTION: return EXIT_CONTRADICTION;
    case PLEUEL_NO_CLOSED_FORM: return EXIT_NO_FORM;
    case PLEUEL_NUMERICAL:
    case PLEUEL_SINGULAR:
    case PLEUEL_NO_MEMORY:
    case PLEUEL_UNSUPPORTED: return EXIT_NUMERICAL;
    case PLEUEL_FILE: return EXIT_FILE;
    case PLEUEL_INTERRUPTED: return EXIT_INTERRUPTED;
  }
  return EXIT_NUMERICAL;
}

// --------------------------------------------------------------------------------------- models in
// All of stdin, grown as needed; NULL when it cannot be read.
static char* read_stdin(size_t* size) {
  size_t cap = 1 << 16, n = 0;
  char* text = malloc(cap);
  while (text) {
    n += fread(text + n, 1, cap - n, stdin);
    if (n < cap) break;
    char* more = realloc(text, cap *= 2);
    if (!more) free(text);
    text = more;
  }
  if (text && ferror(stdin)) {
    free(text);
    return NULL;
  }
  *size = n;
  return text;
}

const char* cli_display_name(const char* file) { return strcmp(file, "-") == 0 ? "<stdin>" : file; }

pleuel_model* cli_load(pleuel* ctx, const cli_options* o, const char* file, int* code) {
  PLEUEL_OPTIONS(pleuel_load_options, how);
  how.name = cli_display_name(file);
  how.settings = o->settings;
  how.n_settings = (size_t)o->n_settings;
  pleuel_model* m = NULL;
  pleuel_status s;
  if (strcmp(file, "-") == 0) {
    size_t size = 0;
    char* text = read_stdin(&size);
    if (!text) {
      *code = cli_error(EXIT_FILE, "stdin could not be read");
      return NULL;
    }
    s = pleuel_load_text(ctx, &m, text, size, &how);
    free(text);
  } else {
    s = pleuel_load_file(ctx, &m, file, &how);
  }
  *code = cli_exit_code(s);
  if (s != PLEUEL_OK && !m) {
    const char* document = o->json ? pleuel_failure_json(ctx, cli_display_name(file), s) : NULL;
    cli_error(*code, "%s", pleuel_message(ctx));
    if (document) fputs(document, stdout);
  }
  return m;
}

void cli_print_diagnostics(pleuel_model* m, const cli_options* o, FILE* to, unsigned severities) {
  PLEUEL_OPTIONS(pleuel_text_options, how);
  how.colour = cli_colour(o, to);
  how.terse = o->terse;
  how.lang = o->lang;
  const char* text = pleuel_diagnostics_text(m, severities, &how);
  if (text) fputs(text, to);
}

int cli_each_file(pleuel* ctx, const cli_options* o,
                  int (*work)(pleuel*, const cli_options*, const char* file)) {
  if (o->n_files == 0) return cli_error(EXIT_USAGE, "which file? - is stdin");
  bool several = o->n_files > 1;
  int worst = EXIT_DONE;
  if (several && o->json) fputs("{\"pleuel\": 1, \"documents\": [\n", stdout);
  for (int i = 0; i < o->n_files && !cli_was_interrupted(); i++) {
    if (several && o->json && i > 0) fputs(",\n", stdout);
    if (several && !o->json && !o->terse)
      printf("%s==> %s <==\n", i ? "\n" : "", cli_display_name(o->files[i]));
    fflush(stdout);
    int code = work(ctx, o, o->files[i]);
    if (code > worst) worst = code;
  }
  if (several && o->json) fputs("]}\n", stdout);
  return worst;
}

// ------------------------------------------------------------------------------------- results out
int cli_file_open(cli_file* f, const char* path, bool replace) {
  *f = (cli_file){.path = path};
  struct stat st;
  bool there = stat(path, &st) == 0;
  if (there && S_ISDIR(st.st_mode)) return cli_error(EXIT_FILE, "%s is a folder", path);
  if (there && S_ISREG(st.st_mode) && !replace)
    return cli_error(EXIT_FILE, "%s exists already; -f replaces it", path);
  if (there && !S_ISREG(st.st_mode)) {  // a device or a pipe: nothing to rename
    f->to = fopen(path, "w");
    return f->to ? EXIT_DONE : cli_error(EXIT_FILE, "%s: %s", path, strerror(errno));
  }
  int n = snprintf(f->temporary, sizeof f->temporary, "%s.XXXXXX", path);
  if (n < 0 || (size_t)n >= sizeof f->temporary)
    return cli_error(EXIT_FILE, "the name is too long: %s", path);
  int fd = mkstemp(f->temporary);
  if (fd < 0) {
    f->temporary[0] = '\0';
    return cli_error(EXIT_FILE, "%s cannot be written: %s", path, strerror(errno));
  }
  cli_remove_on_abort(f->temporary);
  mode_t mask = umask(0);
  umask(mask);
  fchmod(fd, there ? st.st_mode & 07777 : 0666 & ~mask);
  f->to = fdopen(fd, "w");
  if (f->to) return EXIT_DONE;
  close(fd);
  cli_file_drop(f);
  return cli_error(EXIT_FILE, "%s cannot be written: %s", path, strerror(errno));
}

int cli_file_close(cli_file* f) {
  bool bad = fflush(f->to) != 0 || ferror(f->to);
  bad |= fclose(f->to) != 0;
  f->to = NULL;
  if (!bad && f->temporary[0]) bad = rename(f->temporary, f->path) != 0;
  cli_remove_on_abort(NULL);
  if (!bad) return EXIT_DONE;
  int why = errno;
  cli_file_drop(f);
  return cli_error(EXIT_FILE, "%s could not be written: %s", f->path, strerror(why));
}

void cli_file_drop(cli_file* f) {
  if (f->to) fclose(f->to);
  if (f->temporary[0]) unlink(f->temporary);
  cli_remove_on_abort(NULL);
  f->to = NULL;
  f->temporary[0] = '\0';
}

// -------------------------------------------------------------------------- one text as the answer
static int write_answer(const cli_options* o, const char* bytes, size_t n) {
  if (!o->output || strcmp(o->output, "-") == 0) {
    fwrite(bytes, 1, n, stdout);
    return EXIT_DONE;
  }
  cli_file f;
  int code = cli_file_open(&f, o->output, o->force);
  if (code != EXIT_DONE) return code;
  fwrite(bytes, 1, n, f.to);
  return cli_file_close(&f);
}

int cli_finish_text(pleuel* ctx, pleuel_model* m, const cli_options* o, pleuel_status s,
                    const char* text) {
  return cli_finish_bytes(ctx, m, o, s, text, text ? strlen(text) : 0);
}

int cli_finish_bytes(pleuel* ctx, pleuel_model* m, const cli_options* o, pleuel_status s,
                     const char* bytes, size_t n) {
  char why[512];
  snprintf(why, sizeof why, "%s", pleuel_message(ctx));
  int written = bytes ? write_answer(o, bytes, n) : EXIT_DONE;
  cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR | 1u << PLEUEL_WARNING);
  if (s != PLEUEL_OK && *why && pleuel_diagnostic_count(m, PLEUEL_ERROR) == 0)
    cli_error(0, "%s", why);
  pleuel_model_free(m);
  if (written != EXIT_DONE) return written;
  if (s == PLEUEL_NO_CLOSED_FORM && !o->strict) return EXIT_DONE;
  return cli_exit_code(s);
}

int cli_write(void* file, const void* bytes, size_t n) { return fwrite(bytes, 1, n, file) != n; }
