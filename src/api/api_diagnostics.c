// Messages as fields, and edits made in the text.
#include "api/editor.h"

#include <string.h>

// ------------------------------------------------------------------------------------ messages
static const char* in_language(const pleuel_model* m, const char* const words[2]) {
  pl_language lang = pl_api_language_of(m, NULL);
  return words[lang] ? words[lang] : words[PL_ENGLISH];
}

static pleuel_diagnostic diagnostic(pleuel_model* m, pl_arena* a, const pl_diagnostic* d) {
  pleuel_diagnostic out = {.code = pl_code_name(d->code),
                           .severity = (pleuel_severity)pl_code_severity(d->code),
                           .span = pl_api_span(d->span),
                           .sentence = in_language(m, d->sentence),
                           .reason = in_language(m, d->reason),
                           .hint = in_language(m, d->fix),
                           .n_labels = (size_t)d->labels.n};
  pleuel_label* labels = PL_ARRAY(a, pleuel_label, d->labels.n);
  for (int i = 0; i < d->labels.n; i++) {
    labels[i] = (pleuel_label){pl_api_span(d->labels.at[i].span), d->labels.at[i].text};
  }
  out.labels = labels;
  pl_span fix = pl_diagnostic_fix_span(d);
  if (d->replacement && fix.source) {
    pleuel_edit* edit = PL_NEW(a, pleuel_edit);
    *edit = (pleuel_edit){pl_api_span(fix), d->replacement};
    out.n_edits = 1;
    out.edits = edit;
  }
  return out;
}

static pleuel_status list_diagnostics(pleuel_model* m, pl_arena* a, void* argument) {
  (void)argument;
  int n = m->diagnostics.list.n;
  pleuel_diagnostic* all = PL_ARRAY(a, pleuel_diagnostic, n);
  for (int i = 0; i < n; i++) all[i] = diagnostic(m, a, &m->diagnostics.list.at[i]);
  m->editor->diagnostics = all;
  return PLEUEL_OK;
}

// Messages are added, sorted and dropped by every stage: what they are tells whether the list is
// old.
static uint64_t hash_of(const pleuel_model* m) {
  uint64_t h = 1 + (uint64_t)m->diagnostics.list.n;
  for (int i = 0; i < m->diagnostics.list.n; i++) {
    const pl_diagnostic* d = &m->diagnostics.list.at[i];
    h = pl_hash_mix(h, (uint64_t)(uintptr_t)d->sentence[0]);
    h = pl_hash_mix(h, d->span.begin);
  }
  return pl_hash_mix(h, (uint64_t)pl_api_language_of(m, NULL));
}

pleuel_status pleuel_diagnostic_get(pleuel_model* m, size_t i, pleuel_diagnostic* out) {
  if (!m || !out) return PLEUEL_USAGE;
  pl_editor* e = pl_editor_of(m);
  if (!e) return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  if (i >= (size_t)m->diagnostics.list.n) return PLEUEL_USAGE;
  uint64_t hash = hash_of(m);
  if (!e->diagnostics || e->diagnostics_hash != hash) {
    pleuel_status s = pl_editor_answer(m, PL_ANSWER_DIAGNOSTICS, list_diagnostics, NULL);
    if (s != PLEUEL_OK) return s;
    e->diagnostics_hash = hash;
  }
  return pl_api_give(out, &e->diagnostics[i], sizeof *out);
}

// ---------------------------------------------------------------------------------------- edits
typedef struct pl_editing {
  const pleuel_edit* edits;
  size_t n;
  const char* text;
} pl_editing;

static bool is_here(const pleuel_model* m, const pleuel_edit* e) {
  return e->span.file && strcmp(e->span.file, m->source->name) == 0 && e->span.begin <= e->span.end
         && e->span.end <= m->source->size;
}

// The edit that comes next behind a place; of several insertions at one place the first given.
static const pleuel_edit* next_edit(const pleuel_model* m, const pl_editing* w, const bool* done) {
  const pleuel_edit* best = NULL;
  for (size_t i = 0; i < w->n; i++) {
    const pleuel_edit* e = &w->edits[i];
    if (done[i] || !is_here(m, e)) continue;
    bool first = !best || e->span.begin < best->span.begin
                 || (e->span.begin == best->span.begin && e->span.end < best->span.end);
    if (first) best = e;
  }
  return best;
}

static pleuel_status edited(pleuel_model* m, pl_arena* a, void* argument) {
  pl_editing* w = argument;
  bool* done = PL_ARRAY(a, bool, w->n);
  pl_text out = pl_text_make(a);
  size_t at = 0;
  for (const pleuel_edit* e; (e = next_edit(m, w, done)) != NULL;) {
    if (e->span.begin < at) return pl_api_fail(m->ctx, PLEUEL_USAGE, "edits overlap");
    done[e - w->edits] = true;
    pl_text_add_n(&out, m->source->text + at, e->span.begin - at);
    pl_text_add(&out, e->text);
    at = e->span.end;
  }
  pl_text_add_n(&out, m->source->text + at, m->source->size - at);
  w->text = pl_text_string(&out);
  return PLEUEL_OK;
}

pleuel_status pleuel_edited(pleuel_model* m, const pleuel_edit* edits, size_t n,
                            const char** text) {
  if (text) *text = NULL;
  if (!m || !text || (n && !edits)) return PLEUEL_USAGE;
  pl_editing w = {edits, n, NULL};
  pleuel_status s = pl_editor_answer(m, PL_ANSWER_EDITED, edited, &w);
  *text = w.text;
  return s;
}
