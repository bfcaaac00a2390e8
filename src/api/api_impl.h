// api, inside: the context, the model with all that was found out about it, and the steps between.
#ifndef PL_API_IMPL_H
#define PL_API_IMPL_H

#include "api/embedded.h"
#include "assembly/assembly.h"
#include "worked/worked.h"
#include "lang/lang.h"
#include "model/model.h"
#include "export/export.h"
#include "report/report.h"
#include "result/result.h"
#include "solve/solve.h"

struct pleuel {
  pl_arena* arena;                // the context itself and the texts that belong to it
  const pleuel_allocator* alloc;  // a copy in the arena; NULL: malloc and free
  char message[512];
  pl_language lang;
  size_t limit;  // bytes a model may take; 0: none
  pl_interruption interrupted;
  int (*progress)(void* user, const pleuel_progress* where);
  void* progress_user;
  int (*poll)(void* user);
  void* poll_user;
  pleuel_progress where;  // the call that works
  pl_jit_places places;
  pleuel_model* first;  // models that are open
};

// Whether the state of a run that was interrupted lies in its file.
typedef enum pl_kept { PL_KEPT_NO, PL_KEPT_YES, PL_KEPT_FAILED } pl_kept;
typedef struct pl_keeping pl_keeping;

enum {
  PL_STAGE_CHECK,
  PL_STAGE_DERIVE,
  PL_STAGE_WITNESS,
  PL_STAGE_RECORD,
  PL_STAGE_RUN,
  PL_N_STAGES
};

// A file that the text includes, as it was asked for.
typedef struct pl_included {
  const char *path, *from;
  const pl_source* source;
} pl_included;

struct pl_editor;

struct pleuel_model {
  pleuel* ctx;                  // NULL: closed, but systems live on
  atomic_int owners;            // the context, and systems
  pleuel_allocator alloc;       // a copy; take NULL: malloc and free
  pleuel_model *before, *next;  // list of the context
  pl_arena* arena;
  // what is made for one call and the texts that it hands out; emptied when the next one begins
  pl_arena* work;
  pl_arena* motion;       // of the last run, and what it found; emptied when the next run begins
  pl_arena* recorded_in;  // of the recording; emptied when it is recorded anew
  pl_mark work_empty, motion_empty, recorded_empty;
  pl_job job;
  pl_diagnostics diagnostics;
  const char* name;
  const pl_source* source;
  const pl_include_reader* reader;
  PL_VEC(pl_included) included;
  // called after each request that is answered; false: stop.  NULL: nobody waits
  bool (*ready)(void* user, const pl_solution* solution);
  void* ready_user;
  struct pl_editor* editor;  // editor.h; NULL until it is asked for
  const pl_setting* settings;
  int n_settings;
  bool tolerant;       // statements with errors are left out, the rest counts
  bool broken;         // memory ran out once: nothing but freeing is left
  uint64_t text_hash;  // of the text and of all that it includes

  // the value at each arrow of the pipeline, and how it was reached
  pl_model* model;
  pleuel_status parsed, checked, derived, recorded, run;
  bool is_checked, is_derived, is_recorded, is_run;
  bool exact;  // the run that is asked for is on numbers wider than doubles
  pl_solution* solution;
  const char* solved_only;  // letters it was derived for
  bool structure;           // derived as far as freedoms and notes
  bool start_only;          // derived for what holds at the start, not along the motion
  pl_recording* recording;
  pl_result* result;
  pl_start_report start;
  struct pl_certificate_of_run* certified;  // what `certify` found; NULL: not asked for
  bool tol_raised, start_reported;
  double tol_used;
  char run_message[512];
  FILE* csv;            // of csv_file, while a run is at work
  pl_keeping* keeping;  // of the run at work; NULL: its state is not kept
  pl_kept kept;
  char kept_why[128];                  // PL_KEPT_FAILED
  const char *state, *resume_command;  // file of the state, and how the run goes on; NULL
  double resumed_at;                   // s; NaN: it began at the beginning
  long rows_kept;                      // that the state in the file stands behind
  double stage_ms[PL_N_STAGES];
};

// ---- api_context.c: the way of every public function
pleuel_status pl_api_fail(pleuel* ctx, pleuel_status s, const char* sentence);
// Options of an older caller are shorter: what it does not know keeps its default.
void pl_api_copy(void* to, size_t size, const void* from);
// The same; PLEUEL_USAGE for options without their size.
pleuel_status pl_api_take(pleuel* ctx, void* to, size_t size, const void* from);
// As much of a structure as the caller knows.  PLEUEL_USAGE: it has no size.
pleuel_status pl_api_give(void* to, const void* all, size_t size);
// A stage begins: the caller is told, and may stop.
void pl_api_stage(pleuel* ctx, pleuel_stage stage);
typedef pleuel_status pl_api_work(pleuel_model* m, void* argument);
// Runs work under a guard.  Status and sentence of the job become those of the context.
pleuel_status pl_api_guarded(pleuel_model* m, pl_api_work* work, void* argument);
// The same for calls that make a text or a motion: the job works in m->work, which is emptied
// first.
pleuel_status pl_api_worked(pleuel_model* m, pl_api_work* work, void* argument);
pl_language pl_api_language(const char* name, pl_language otherwise);
// What is asked for, else what the file names, else what the context speaks.
pl_language pl_api_language_of(const pleuel_model* m, const char* asked);

// ---- api_model.c: a model lives as long as one of its owners
void pl_model_keep(pleuel_model* m);
void pl_model_drop(pleuel_model* m);

// ---- pipeline.c: every arrow
pleuel_status pl_pipeline_parse(pleuel_model* m);
pleuel_status pl_pipeline_check(pleuel_model* m);
// along: also for what holds later in the motion.
pleuel_status pl_pipeline_derive(pleuel_model* m, const char* only, double seconds, bool along);
pleuel_status pl_pipeline_structure(pleuel_model* m);  // freedoms, ranks and notes only
pleuel_status pl_pipeline_record(pleuel_model* m);
// The memory of the last run is emptied; what is known of it is forgotten.
void pl_pipeline_forget_run(pleuel_model* m);
pleuel_status pl_pipeline_start(pleuel_model* m, const pleuel_sim_options* o, pl_run** out);
pleuel_status pl_pipeline_run(pleuel_model* m, const pleuel_sim_options* o);

// ---- keeping.c: the state of a run in a file
pl_keeping* pl_keeping_make(pleuel_model* m, const pleuel_sim_options* o);  // NULL: not wanted
// reads and checks
pleuel_status pl_keeping_open(pl_keeping* k, const pleuel_sim_options* o,
                              const pl_run_options* how);
pleuel_status pl_keeping_resume(pl_keeping* k, pl_run* run, const pl_sink* sink);
void pl_keeping_step(void* user, pl_run* run, bool interrupted);  // pl_run_options.keep
// ---- pages.c
// 500[ms] in three doubles; what is wrong, or NULL
const char* pl_quantity_parts(pl_arena* a, const char* text, double part[3]);

// ---- views.c: the motion as it is looked at
typedef struct pl_views {
  pl_arena* arena;
  pl_language lang;
  pl_result* result;  // with its rows; NULL: there is no motion
  int n_columns;      // those of `sim`; the plotted quantities stand behind them
  bool energy_conserved;
  double tol;
  const char* message;  // why the motion ends early or is not there; NULL
  // quantities of plot lines without a number along the motion, "a, b"; NULL
  const char* missing;
  PL_VEC(pl_html_plot) plots;
} pl_views;
// Runs the model for a picture. A run that stops early keeps its rows. PLEUEL_OK and no result
// without `simulate`.
pleuel_status pl_views_make(pleuel_model* m, pl_language lang, pl_views* out);

// ---- report_page.c: the HTML report
pleuel_status pl_report_page(pleuel_model* m, pl_language lang, const pleuel_report_options* o,
                             const char** html);

// ---- pictures.c: drawings, plots, animations
pleuel_status pl_picture_plot(pleuel_model* m, pl_language lang, const pleuel_plot_options* o,
                              const char** bytes, size_t* size);
pleuel_status pl_picture_animate(pleuel_model* m, pl_language lang, const pleuel_animate_options* o,
                                 const char** bytes, size_t* size);

// The drawing of a model along its motion, or at its start when it has none; NULL when it cannot be
// drawn.
pl_scene* pl_picture_scene(pleuel_model* m, pl_language lang);

// ---- start_messages.c: a start that does not fit, as messages
void pl_start_report_trouble(pleuel_model* m);
void pl_start_report_choice(pleuel_model* m);  // several solutions fit: which one was taken

// ---- motion.c: words and JSON about a run
// how the steps were computed
void pl_engine_text(pl_text* out, const pleuel_model* m, pl_language lang);
void pl_motion_text(pl_text* out, const pleuel_model* m, pl_language lang, bool ascii,
                    bool events_only);
void pl_motion_json(pl_text* out, const pleuel_model* m);

// ---- certified.c: the proven enclosure of a run; certified_words.c: what is said of it The start
// of the run, before it moves; then, when it is over, the enclosure and how far the run is from it.
void pl_certify_begin(pleuel_model* m, const pleuel_sim_options* o, const pl_run* run);
pleuel_status pl_certify_end_of_run(pleuel_model* m, const pleuel_sim_options* o);
void pl_certified_text(pl_text* out, const pleuel_model* m, pl_language lang, bool ascii);
void pl_certified_json(pl_json* j, const pleuel_model* m);

// ---- summary.c: what `check` says
void pl_check_summary(pl_text* out, const pleuel_model* m, pl_language lang);

#endif
