// Diagnostics: what is wrong with a model. Collected by the passes, put in order, and printed in
// the form of the manual: sentence, the user's own line, a caret range with the reason beside it,
// one suggestion. language.md, "Messages".
#include "base/base.h"

#include <string.h>

static const char* const names[PL_N_CODES] = {
#define PL_DIAGNOSTIC(code, en, de) #code,
#include "messages/diagnostics.def"
#undef PL_DIAGNOSTIC
};

static const char* const titles[PL_N_CODES][2] = {
#define PL_DIAGNOSTIC(code, en, de) {en, de},
#include "messages/diagnostics.def"
#undef PL_DIAGNOSTIC
};

static bool known(pl_code c) { return (int)c >= 0 && c < PL_N_CODES; }

const char* pl_code_name(pl_code c) { return known(c) ? names[c] : "?"; }

const char* pl_code_title(pl_code c, pl_language lang) {
  return known(c) ? titles[c][lang == PL_GERMAN] : "?";
}

pl_severity pl_code_severity(pl_code c) {
  char letter = pl_code_name(c)[0];
  return letter == 'W' ? PL_WARNING : letter == 'N' ? PL_NOTE : PL_ERROR;
}

bool pl_code_find(const char* name, pl_code* out) {
  for (int c = 0; c < PL_N_CODES; c++) {
    if (strcmp(names[c], name) == 0) {
      *out = (pl_code)c;
      return true;
    }
  }
  return false;
}

// -------------------------------------------------------------------------------------- collecting
pl_diagnostic* pl_report(pl_diagnostics* d, pl_code code, pl_span span, const char* en,
                         const char* de) {
  pl_push(d->arena, d->list, (pl_diagnostic){.code = code, .span = span, .sentence = {en, de}});
  if (pl_code_severity(code) == PL_ERROR) d->n_errors++;
  return &d->list.at[d->list.n - 1];
}

void pl_report_reason(pl_diagnostic* m, const char* en, const char* de) {
  m->reason[PL_ENGLISH] = en;
  m->reason[PL_GERMAN] = de;
}

void pl_report_fix(pl_diagnostic* m, const char* en, const char* de, const char* replacement) {
  m->fix[PL_ENGLISH] = en;
  m->fix[PL_GERMAN] = de;
  m->replacement = replacement;
}

void pl_report_fix_span(pl_diagnostic* m, pl_span span) { m->fix_span = span; }

pl_span pl_diagnostic_fix_span(const pl_diagnostic* m) {
  return m->fix_span.source ? m->fix_span : m->span;
}

void pl_report_label(pl_diagnostics* d, pl_diagnostic* m, pl_span span, const char* text) {
  pl_push(d->arena, m->labels, (pl_label){span, text});
}

// ------------------------------------------------------------------------------------------- order
static const char* text_in(const char* const by_language[2], pl_language lang) {
  const char* s = by_language[lang == PL_GERMAN];
  return s ? s : by_language[PL_ENGLISH];
}

// By source (in the order of their names), place and code; what concerns the whole model comes
// last.
static int compare_place(const pl_diagnostic* a, const pl_diagnostic* b) {
  const pl_source *s = a->span.source, *t = b->span.source;
  if (s == NULL || t == NULL) {
    if (s != t) return s == NULL ? 1 : -1;
  } else if (s != t) {
    int by_name = strcmp(s->name, t->name);
    if (by_name != 0) return by_name;
  }
  if (a->span.begin != b->span.begin) return a->span.begin < b->span.begin ? -1 : 1;
  return (a->code > b->code) - (a->code < b->code);
}

static bool same_message(const pl_diagnostic* a, const pl_diagnostic* b) {
  const char *s = text_in(a->sentence, PL_ENGLISH), *t = text_in(b->sentence, PL_ENGLISH);
  return compare_place(a, b) == 0 && a->span.end == b->span.end
         && strcmp(s ? s : "", t ? t : "") == 0;
}

static bool said_before(const pl_diagnostics* d, int kept, const pl_diagnostic* m) {
  for (int i = kept - 1; i >= 0 && compare_place(&d->list.at[i], m) == 0; i--) {
    if (same_message(&d->list.at[i], m)) return true;
  }
  return false;
}

// Stable merge of two sorted neighbours.
static void merge(pl_diagnostic* to, const pl_diagnostic* a, int n_a, const pl_diagnostic* b,
                  int n_b) {
  int i = 0, j = 0;
  while (i < n_a || j < n_b) {
    bool left = j == n_b || (i < n_a && compare_place(&a[i], &b[j]) <= 0);
    *to++ = left ? a[i++] : b[j++];
  }
}

static void sort_list(pl_diagnostic* at, pl_diagnostic* spare, int n) {
  if (n < 2) return;
  int half = n / 2;
  sort_list(at, spare, half);
  sort_list(at + half, spare, n - half);
  merge(spare, at, half, at + half, n - half);
  memcpy(at, spare, (size_t)n * sizeof *at);
}

void pl_diagnostics_sort(pl_diagnostics* d) {
  int n = d->list.n;
  if (n == 0) return;
  sort_list(d->list.at, PL_ARRAY(d->arena, pl_diagnostic, n), n);

  // drop what was said twice
  int kept = 0;
  d->n_errors = 0;
  for (int i = 0; i < n; i++) {
    if (said_before(d, kept, &d->list.at[i])) continue;
    d->list.at[kept] = d->list.at[i];
    d->n_errors += pl_code_severity(d->list.at[kept].code) == PL_ERROR;
    kept++;
  }
  d->list.n = kept;
}

bool pl_diagnostics_have(const pl_diagnostics* d, pl_code code) {
  for (int i = 0; i < d->list.n; i++) {
    if (d->list.at[i].code == code) return true;
  }
  return false;
}

void pl_diagnostics_drop(pl_diagnostics* d, pl_code code) {
  int kept = 0;
  for (int i = 0; i < d->list.n; i++) {
    if (d->list.at[i].code == code) {
      d->n_errors -= pl_code_severity(code) == PL_ERROR;
    } else {
      d->list.at[kept++] = d->list.at[i];
    }
  }
  d->list.n = kept;
}
