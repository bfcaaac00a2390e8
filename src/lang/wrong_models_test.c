// Every wrong model in tests/wrong says what it should, where it should. An expectation is a line
// `line:col: CODE: sentence` for each message; here codes and places of the text's own messages are
// compared, in both languages something is said.
#include "lang_testing.h"

#include <dirent.h>

static bool expected_has(const char* expected, const char* line) {
  size_t n = strlen(line);
  for (const char* s = expected; (s = strstr(s, line)) != NULL; s += n) {
    if (s == expected || s[-1] == '\n') return true;
  }
  return false;
}

static void check_said(bench* b, const char* name, const char* expected) {
  int found = 0;
  for (int i = 0; i < b->diagnostics.list.n; i++) {
    const pl_diagnostic* d = &b->diagnostics.list.at[i];
    pl_place at = d->span.source ? pl_span_place(d->span) : (pl_place){0, 0};
    const char* line = pl_format(b->arena, "%d:%d: %s: %s\n", at.line, at.column,
                                 pl_code_name(d->code), d->sentence[PL_ENGLISH]);
    bool here = expected_has(expected, line);
    if (!here) print_message("%s says %s", name, line);
    assert_true(here);
    found++;
    // a message in German too, and a way out or a reason
    assert_true(d->sentence[PL_GERMAN] && d->sentence[PL_GERMAN][0]);
    assert_true(d->fix[PL_ENGLISH] == NULL || d->fix[PL_GERMAN] != NULL);
  }
  int lines = 0;
  for (const char* s = expected; *s; s++) lines += *s == '\n';
  if (found != lines) print_message("%s: %d messages, %d expected\n", name, found, lines);
  assert_int_equal(found, lines);
}

static void check_model(const char* folder, const char* name) {
  char path[2000];
  size_t n = 0, n_expected = 0;
  snprintf(path, sizeof path, "%s/%s.pleuel", folder, name);
  char* text = read_file(path, &n);
  snprintf(path, sizeof path, "%s/%s.expected", folder, name);
  char* expected = read_file(path, &n_expected);
  assert_non_null(text);
  if (expected == NULL) print_message("%s has no expectation\n", name);
  assert_non_null(expected);
  bench* b = bench_with(text, n, NULL, 0);
  if (b->status == PLEUEL_OK) pl_model_check(&b->job, b->m);
  pl_diagnostics_sort(&b->diagnostics);
  bool text_is_wrong = b->status != PLEUEL_OK;
  if (text_is_wrong || b->diagnostics.n_errors == 0) check_said(b, name, expected);
  // the code in the name is among the messages
  char code[5] = {0};
  memcpy(code, name, 4);
  assert_non_null(strstr(expected, code));
  bench_free(b);
  free(text);
  free(expected);
}

static void wrong_models_say_what_they_should(void** state) {
  (void)state;
  DIR* d = opendir(PL_WRONG);
  assert_non_null(d);
  int n = 0;
  for (struct dirent* e; (e = readdir(d)) != NULL;) {
    char name[300];
    snprintf(name, sizeof name, "%s", e->d_name);
    char* dot = strrchr(name, '.');
    if (!dot || strcmp(dot, ".pleuel") != 0) continue;
    *dot = 0;
    check_model(PL_WRONG, name);
    n++;
  }
  closedir(d);
  assert_true(n >= 45);
}

// Cut off anywhere, or with a byte changed anywhere, a text gives messages and no harm.
static void damaged_texts_do_no_harm(void** state) {
  (void)state;
  static const char* const names[] = {"atwood", "chain", "ladder", "double-pendulum"};
  pl_random r = {20240607};
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    char path[2000];
    snprintf(path, sizeof path, "%s/%s.pleuel", PL_EXAMPLES, names[i]);
    size_t n = 0;
    char* text = read_file(path, &n);
    assert_non_null(text);
    for (size_t k = 0; k < n; k += 7) {
      bench_free(bench_with(text, k, NULL, 0));
      char kept = text[k];
      text[k] = (char)pl_random_bits(&r);
      bench* b = bench_with(text, n, NULL, 0);
      if (b->status == PLEUEL_OK) pl_model_check(&b->job, b->m);
      bench_free(b);
      text[k] = kept;
    }
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(wrong_models_say_what_they_should),
      cmocka_unit_test(damaged_texts_do_no_harm),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
