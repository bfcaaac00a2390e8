// From a model to its HTML page: what the report needs is brought together here.
#include <string.h>

#include "api/api_impl.h"

// Words of the language, for marking them in the text of the model.
static const char* const statements[] = {
#define PL_STATEMENT(token, word) word,
#include "lang/keywords.def"
    NULL};
static const char* const small_words[] = {
#define PL_ITEM(token, word)     word,
#define PL_RESERVED(token, word) word,
#include "lang/keywords.def"
    NULL};

// Frames enough for the eye between two steps of the run, within what a page can carry.
static int frames_for(const pl_views* v) {
  enum { FEWEST = 160, MOST = 480, A_STEP = 2 };
  long n = A_STEP * v->result->stats.steps;
  return n < FEWEST ? FEWEST : n > MOST ? MOST : (int)n;
}

// A model that cannot be drawn is reported without a picture.
static pl_scene* scene_of(pleuel_model* m, const pl_views* v) {
  pl_scene* scene = NULL;
  pl_scene_options how = {
      .frames = v->result ? frames_for(v) : 1, .forces = true, .velocities = true};
  return pl_scene_make(&m->job, m->model, v->result, &how, &scene) == PLEUEL_OK ? scene : NULL;
}

pleuel_status pl_report_page(pleuel_model* m, pl_language lang, const pleuel_report_options* o,
                             const char** html) {
  pl_views views = {0};
  char sentence[sizeof m->job.message];
  memcpy(sentence, m->job.message, sizeof sentence);
  pl_views_make(m, lang, &views);

  pl_scene* scene = !o->no_animation ? scene_of(m, &views) : NULL;

  memcpy(m->job.message, sentence, sizeof sentence);

  static const pl_html_amount amount[] = {PL_HTML_DATA_THIN, PL_HTML_DATA_NONE, PL_HTML_DATA_FULL};
  pl_html_input in = {.solution = m->solution,
                      .notes = &m->diagnostics,
                      .lang = lang,
                      .only = o->only,
                      .no_font = o->no_font,
                      .no_animation = o->no_animation,
                      .data = amount[o->data],
                      .command = o->command,
                      .words = statements,
                      .small_words = small_words,
                      .result = views.result,
                      .scene = scene,
                      .n_columns = views.n_columns,
                      .n_plots = views.plots.n,
                      .plots = views.plots.at,
                      .unplotted = views.missing,
                      .energy_conserved = views.energy_conserved,
                      .tol = views.tol,
                      .run_message = views.message};
  pl_text out = pl_text_make(m->work);
  pl_html_report(&out, &in);
  *html = pl_text_string(&out);
  return PLEUEL_OK;
}
