// pleuel animate FILE -o FILE.svg|gif|mp4: the motion as a film. MP4 is made by the program ffmpeg,
// which is handed the frames.
#include "cli.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

const cli_flag flags_animate[] = {
    {"output", 'o', CLI_TEXT, CLI_AT(output), "FILE",
     "file.svg, file.gif or file.mp4; - for SVG on stdout"},
    {"force", 'f', CLI_SWITCH, CLI_AT(force), NULL, "replace a file that is there"},
    {"size", 0, CLI_TEXT, CLI_AT(size), "WxH", "pixels: 480x440"},
    {"fps", 0, CLI_TEXT, CLI_AT(fps), "NUMBER", "frames per second; default 15, 30 for MP4"},
    {"forces", 0, CLI_SWITCH, CLI_AT(forces), NULL, "with force arrows"},
    {"style", 0, CLI_CHOICE, CLI_AT(style), "light|dark|print", "colours"},
    {"until", 0, CLI_TEXT, CLI_AT(until), "TIME", "end of the motion: 10, '500[ms]'"},
    CLI_FLAG_SET,
    CLI_FLAG_LANG,
    CLI_FLAG_COLOR,
    CLI_FLAG_HELP,
    CLI_FLAG_END,
};

// ------------------------------------------------------------------------------------------ ffmpeg
typedef struct cli_film {
  const char* path;  // written to
  double fps;
  pid_t child;
  int pipe;  // frames go in here
  bool started, failed;
} cli_film;

static bool start_ffmpeg(cli_film* f, int width, int height) {
  char size[32], rate[32];
  snprintf(size, sizeof size, "%dx%d", width, height);
  snprintf(rate, sizeof rate, "%g", f->fps);
  const char* const arguments[] = {
      "ffmpeg",   "-v",      "error",     "-f",  "rawvideo",
      "-pix_fmt", "bgr0",    "-s",        size,  "-r",
      rate,       "-i",      "-",         "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2",
      "-pix_fmt", "yuv420p", "-bitexact", "-f",  "mp4",
      "-y",       f->path,   NULL};
  int ends[2];
  if (pipe(ends) != 0) return false;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  char* copy[sizeof arguments / sizeof *arguments];
  memcpy(copy, arguments, sizeof copy);
  int bad = posix_spawnp(&f->child, "ffmpeg", &actions, NULL, copy, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  f->pipe = ends[1];
  if (bad) close(ends[1]);
  f->started = !bad;
  return !bad;
}

static int hand_frame(void* user, const unsigned* pixels, int width, int height) {
  cli_film* f = user;
  if (!f->started && !start_ffmpeg(f, width, height)) return (f->failed = true);
  const char* at = (const char*)pixels;
  size_t left = 4 * (size_t)width * (size_t)height;
  while (left > 0) {
    ssize_t n = write(f->pipe, at, left);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return (f->failed = true);
    at += n;
    left -= (size_t)n;
  }
  return 0;
}

static void end_ffmpeg(cli_film* f) {
  int status = 0;
  if (!f->started) return;
  close(f->pipe);
  while (waitpid(f->child, &status, 0) < 0 && errno == EINTR) {}
  f->failed |= !WIFEXITED(status) || WEXITSTATUS(status) != 0;
}

static bool on_path(const char* program) {
  const char* path = getenv("PATH");
  char name[4096];
  while (path && *path) {
    size_t n = strcspn(path, ":");
    snprintf(name, sizeof name, "%.*s/%s", (int)n, n ? path : ".", program);
    if (access(name, X_OK) == 0) return true;
    path += n + (path[n] == ':');
  }
  return false;
}

static int write_film(pleuel* ctx, const cli_options* o, pleuel_model* m,
                      pleuel_animate_options* how) {
  if (!on_path("ffmpeg"))
    return cli_error(EXIT_FILE,
                     "MP4 needs the program ffmpeg, which is not there; .svg and .gif do without");
  cli_file file;
  int code = cli_file_open(&file, o->output, o->force);
  if (code != EXIT_DONE) return code;
  if (!file.temporary[0]) {
    cli_file_drop(&file);
    return cli_error(EXIT_FILE, "%s: a film goes into a file", o->output);
  }
  cli_film film = {.path = file.temporary, .fps = how->fps};
  how->frame = hand_frame;
  how->user = &film;
  const char* none;
  size_t n;
  struct sigaction ignore = {.sa_handler = SIG_IGN}, before;
  sigaction(SIGPIPE, &ignore, &before);  // ffmpeg that ends early is noticed by write
  pleuel_status s = pleuel_animate(m, &none, &n, how);
  end_ffmpeg(&film);
  sigaction(SIGPIPE, &before, NULL);
  if (film.started && !film.failed && (s == PLEUEL_OK || !cli_was_interrupted())) {
    code = cli_file_close(&file);
    if (code == EXIT_DONE && s != PLEUEL_OK) cli_error(0, "%s", pleuel_message(ctx));
    return code != EXIT_DONE ? code : cli_exit_code(s);
  }
  cli_file_drop(&file);
  if (film.failed) return cli_error(EXIT_FILE, "ffmpeg could not write %s", o->output);
  if (pleuel_diagnostic_count(m, PLEUEL_ERROR) > 0)
    cli_print_diagnostics(m, o, stderr, 1u << PLEUEL_ERROR);
  else cli_error(0, "%s", pleuel_message(ctx));
  return cli_exit_code(s);
}

// -------------------------------------------------------------------------------------------- verb
static int read_rate(const char* text, double* fps) {
  if (!text) return EXIT_DONE;
  char* end;
  *fps = strtod(text, &end);
  if (*end || end == text || !(*fps >= 1 && *fps <= 100))
    return cli_error(EXIT_USAGE, "--fps takes a number from 1 to 100, not `%s`", text);
  return EXIT_DONE;
}

int verb_animate(pleuel* ctx, const cli_options* o) {
  if (o->n_files != 1)
    return cli_error(EXIT_USAGE, "animate takes one file:  pleuel animate FILE -o film.svg");
  if (!o->output) return cli_error(EXIT_USAGE, "where to?  pleuel animate FILE -o film.svg");
  PLEUEL_OPTIONS(pleuel_animate_options, how);
  bool film = cli_ends_with(o->output, ".mp4"), gif = cli_ends_with(o->output, ".gif");
  if (!film && !gif && !cli_ends_with(o->output, ".svg") && strcmp(o->output, "-") != 0) {
    return cli_error(EXIT_USAGE, "%s: an animation is written as .svg, .gif or .mp4", o->output);
  }
  how.fps = film ? 30 : 0;
  int code = read_rate(o->fps, &how.fps);
  if (code == EXIT_DONE) code = cli_read_size(o->size, &how.width, &how.height);
  if (code != EXIT_DONE) return code;
  how.lang = o->lang;
  how.style = cli_style(o->style);
  how.forces = o->forces;
  how.format = gif ? PLEUEL_GIF : PLEUEL_SVG;
  if (o->until) {
    how.has_until = 1;
    if (pleuel_quantity(ctx, &how.until, o->until) != PLEUEL_OK)
      return cli_error(EXIT_USAGE, "--until: %s", pleuel_message(ctx));
  }
  pleuel_model* m = cli_load(ctx, o, o->files[0], &code);
  if (!m) return code;
  if (film) {
    code = write_film(ctx, o, m, &how);
    pleuel_model_free(m);
    return code;
  }
  const char* bytes = NULL;
  size_t n = 0;
  pleuel_status s = pleuel_animate(m, &bytes, &n, &how);
  return cli_finish_bytes(ctx, m, o, s, bytes, n);
}
