// The terminal: colour, width, language, Ctrl-C, the line of progress.
#include "cli.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

bool cli_colour(const cli_options* o, FILE* stream) {
  if (o->color && strcmp(o->color, "always") == 0) return true;
  if (o->color && strcmp(o->color, "never") == 0) return false;
  const char* term = getenv("TERM");
  const char* no = getenv("NO_COLOR");
  if ((no && *no) || !term || strcmp(term, "dumb") == 0) return false;
  return isatty(fileno(stream));
}

int cli_width(FILE* stream) {
  enum { NARROWEST = 40, WIDEST = 100, USUAL = 78 };
  if (!isatty(fileno(stream))) return 0;
  struct winsize w;
  const char* columns = getenv("COLUMNS");
  int n = columns                                                  ? atoi(columns)
          : ioctl(fileno(stream), TIOCGWINSZ, &w) == 0 && w.ws_col ? w.ws_col
                                                                   : USUAL + 2;
  n -= 2;
  return n < NARROWEST ? NARROWEST : n > WIDEST ? WIDEST : n;
}

const char* cli_environment_language(void) {
  static const char* const names[] = {"PLEUEL_LANG", "LC_ALL", "LC_MESSAGES", "LANG"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    const char* value = getenv(names[i]);
    if (value && *value) return strncmp(value, "de", 2) == 0 ? "de" : "en";
  }
  return "en";
}

// ------------------------------------------------------------------------------------------ Ctrl-C
static pleuel* volatile watched;
static volatile sig_atomic_t interrupts;

static const char* volatile unfinished;
static const char* volatile witness;

void cli_remove_on_abort(const char* path) {
  unfinished = path;
  witness = NULL;
}

void cli_keep_on_abort(const char* path) { witness = path; }

static void on_interrupt(int signal_number) {
  (void)signal_number;
  if (interrupts++) {
    const char *path = unfinished, *kept = witness;
    if (path && !(kept && access(kept, F_OK) == 0)) unlink(path);
    _exit(EXIT_INTERRUPTED);
  }
  if (watched) pleuel_interrupt(watched);
}

void cli_watch_interrupt(pleuel* ctx) {
  watched = ctx;
  struct sigaction act = {0};
  act.sa_handler = on_interrupt;
  sigaction(SIGINT, &act, NULL);
  sigaction(SIGTERM, &act, NULL);
  // a terminal that goes away, unless nohup has said that it does not matter
  struct sigaction hang_up;
  if (sigaction(SIGHUP, NULL, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &act, NULL);
  signal(SIGPIPE, SIG_IGN);
}

bool cli_was_interrupted(void) { return interrupts != 0; }

// ---------------------------------------------------------------------------------------- progress
static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool shown;

// sim  38 %  t = 19.0 of 50 s  step 2.1e-3  energy 3e-12  eta 0:14
int cli_progress(void* user, const pleuel_progress* p) {
  (void)user;
  if (p->stage < PLEUEL_STAGE_RUN || isnan(p->t)) return 0;
  static const double patience_s = 0.5;  // shorter runs stay silent
  static const double interval_s = 0.1;
  static double start, last, part_before;
  double t = now(),
         part = p->t_end > p->t_begin ? (p->t - p->t_begin) / (p->t_end - p->t_begin) : 0;
  if (start <= 0) {
    start = t;
    part_before = part;
  }  // a run that goes on does not begin at zero
  if (!isatty(fileno(stderr)) || t - start < patience_s || t - last < interval_s) return 0;
  last = t;

  double eta = part > part_before ? (t - start) * (1 - part) / (part - part_before) : 0;
  fprintf(stderr, "\rsim %3.0f %%  t = %.4g of %.4g s  step %.1e", 100 * part, p->t, p->t_end,
          p->step);
  if (!isnan(p->energy_drift)) fprintf(stderr, "  energy %.0e", p->energy_drift);
  fprintf(stderr, "  eta %d:%02d \033[K", (int)(eta / 60), (int)eta % 60);
  fflush(stderr);
  shown = true;
  return 0;
}

void cli_progress_clear(void) {
  if (shown) fputs("\r\033[K", stderr);
  shown = false;
}
