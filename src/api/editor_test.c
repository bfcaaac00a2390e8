// The interface for editors as a program that embeds the library meets it: through pleuel.h only.
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pleuel.h"

#define PL_TEST(name) static void name(void** state)

static pleuel* ctx;

static int set_up(void** state) {
  (void)state;
  ctx = pleuel_open(NULL);
  return ctx ? 0 : -1;
}

static int tear_down(void** state) {
  (void)state;
  pleuel_close(ctx);
  return 0;
}

static pleuel_model* load(const char* text) {
  pleuel_model* m = NULL;
  pleuel_load_text(ctx, &m, text, strlen(text), NULL);
  assert_non_null(m);
  return m;
}

static size_t place(const char* text, const char* mark) {
  const char* at = strstr(text, mark);
  assert_non_null(at);
  return (size_t)(at - text);
}

// ------------------------------------------------------------------------------------ messages
PL_TEST(a_message_has_its_place_in_bytes_units_lines_and_a_fix_as_an_edit) {
  // 𝄞 has four bytes and two UTF-16 units, θ two bytes and one unit
  static const char text[] = "# 𝄞 θ\nparam m = 1\ncoord θ1\nmass m at (thet1, 0) # 𝄞\n";
  pleuel_model* m = load(text);
  PLEUEL_OPTIONS(pleuel_diagnostic, d);
  assert_int_equal(pleuel_diagnostic_get(m, 0, &d), PLEUEL_OK);
  assert_string_equal(d.code, "E011");
  assert_int_equal(d.severity, PLEUEL_ERROR);
  assert_int_equal(d.span.begin, place(text, "thet1"));
  assert_int_equal(d.span.end - d.span.begin, 5);
  assert_int_equal(d.span.begin16, d.span.begin - 4);
  assert_int_equal(d.span.line, 4);
  assert_int_equal(d.span.column, 12);
  assert_int_equal(d.span.end_column16, 17);
  assert_string_equal(d.span.file, "<text>");
  assert_int_equal(d.n_edits, 1);
  assert_string_equal(d.edits[0].text, "θ1");
  const char* then = NULL;
  assert_int_equal(pleuel_edited(m, d.edits, d.n_edits, &then), PLEUEL_OK);
  assert_non_null(strstr(then, "mass m at (θ1, 0) # 𝄞\n"));
  assert_int_equal(pleuel_diagnostic_get(m, 99, &d), PLEUEL_USAGE);
  pleuel_model_free(m);
}

PL_TEST(a_message_speaks_of_related_places) {
  pleuel_model* m = load("param m = 1\ncoord x\nparam m = 2\nmass m at (x, 0)\n");
  PLEUEL_OPTIONS(pleuel_diagnostic, d);
  assert_int_equal(pleuel_diagnostic_get(m, 0, &d), PLEUEL_OK);
  assert_string_equal(d.code, "E012");
  assert_int_equal(d.n_labels, 1);
  assert_int_equal(d.labels[0].span.line, 1);
  pleuel_model_free(m);
}

PL_TEST(a_structure_without_size_is_refused) {
  pleuel_model* m = load("coord y\n");
  pleuel_diagnostic d = {0};
  pleuel_name n = {0};
  assert_int_equal(pleuel_diagnostic_get(m, 0, &d), PLEUEL_USAGE);
  assert_int_equal(pleuel_name_get(m, 0, &n), PLEUEL_USAGE);
  pleuel_model_free(m);
}

static const char* included(void* user, const char* path, const char* from) {
  (void)user;
  (void)from;
  return strcmp(path, "parts.pleuel") == 0 ? "param m = 2 [kg]  # of the ball\nparam k = = 1\n"
                                           : NULL;
}

PL_TEST(messages_and_names_of_included_files_name_their_file) {
  static const char text[] = "include \"parts.pleuel\"\ncoord x\nmass m at (x, 0)\n";
  PLEUEL_OPTIONS(pleuel_load_options, o);
  o.read = included;
  pleuel_model* m = NULL;
  assert_int_equal(pleuel_load_text(ctx, &m, text, strlen(text), &o), PLEUEL_MODEL_ERROR);
  PLEUEL_OPTIONS(pleuel_diagnostic, d);
  assert_int_equal(pleuel_diagnostic_get(m, 0, &d), PLEUEL_OK);
  assert_string_equal(d.span.file, "parts.pleuel");
  PLEUEL_OPTIONS(pleuel_name, n);
  assert_int_equal(pleuel_name_find(m, "m", &n), PLEUEL_OK);
  assert_string_equal(n.span.file, "parts.pleuel");
  assert_string_equal(n.meaning, "of the ball");
  const pleuel_edit* edits;
  size_t k;
  assert_int_equal(pleuel_rename(m, place(text, "m at"), "M", &edits, &k), PLEUEL_OK);
  assert_int_equal(k, 2);
  pleuel_model_free(m);
}

// ---------------------------------------------------------------------------------------- names
static const char pendulum[] =
    "system \"Pendulum\"\n"
    "param m = 500 [g], l = 1/2 [m], g = 9.81 [m/s^2]   # given\n"
    "coord x, y, φ\n"
    "mass ball: m at (x, y)\n"
    "gravity g along -y\n"
    "constraint rod: x^2 + y^2 = l^2\n"
    "constraint angle: x = l sin φ with N\n"
    "init φ = 30°, φ' = 2 [rad/s]\n"
    "output h = y + l\n"
    "ask b: solve λ_rod, N\n"
    "event low: when x = 0 -> stop\n";

PL_TEST(all_that_has_a_name_is_listed_with_unit_and_value) {
  pleuel_model* m = load(pendulum);
  PLEUEL_OPTIONS(pleuel_name, n);
  assert_int_equal(pleuel_name_find(m, "m", &n), PLEUEL_OK);
  assert_int_equal(n.kind, PLEUEL_KIND_PARAMETER);
  assert_string_equal(n.unit, "kg");
  assert_true(n.has_value && n.value == 0.5);
  assert_string_equal(n.meaning, "given");
  assert_int_equal(n.span.line, 2);
  assert_int_equal(pleuel_name_find(m, "φ'", &n), PLEUEL_OK);
  assert_int_equal(n.kind, PLEUEL_KIND_VELOCITY);
  assert_string_equal(n.ascii, "phi_dot");
  assert_string_equal(n.unit, "rad/s");
  assert_true(n.has_value && n.value == 2);
  assert_int_equal(pleuel_name_find(m, "phi_dot", &n), PLEUEL_OK);
  assert_string_equal(n.of, "phi");
  assert_int_equal(pleuel_name_find(m, "λ_rod", &n), PLEUEL_OK);
  assert_int_equal(n.kind, PLEUEL_KIND_MULTIPLIER);
  assert_string_equal(n.unit, "N/m");
  assert_int_equal(pleuel_name_find(m, "lambda_angle", &n), PLEUEL_OK);
  assert_string_equal(n.shown, "N");
  assert_int_equal(pleuel_name_find(m, "h", &n), PLEUEL_OK);
  assert_int_equal(n.kind, PLEUEL_KIND_OUTPUT);
  assert_string_equal(n.unit, "m");
  assert_int_equal(pleuel_name_find(m, "ball", &n), PLEUEL_OK);
  assert_int_equal(n.kind, PLEUEL_KIND_MASS);
  assert_int_equal(pleuel_name_find(m, "low", &n), PLEUEL_OK);
  assert_int_equal(n.kind, PLEUEL_KIND_EVENT);
  assert_int_equal(pleuel_name_find(m, "nothing", &n), PLEUEL_USAGE);
  assert_string_equal(pleuel_message(ctx), "nothing has this name");
  pleuel_model_free(m);
}

PL_TEST(every_name_that_is_listed_is_found_by_its_spellings) {
  pleuel_model* m = load(pendulum);
  size_t count = pleuel_name_count(m);
  assert_true(count >= 15);
  for (size_t i = 0; i < count; i++) {
    PLEUEL_OPTIONS(pleuel_name, n);
    PLEUEL_OPTIONS(pleuel_name, found);
    assert_int_equal(pleuel_name_get(m, i, &n), PLEUEL_OK);
    assert_int_equal(pleuel_name_find(m, n.ascii, &found), PLEUEL_OK);
    assert_string_equal(found.ascii, n.ascii);
    assert_int_equal(pleuel_name_find(m, n.shown, &found), PLEUEL_OK);
    assert_string_equal(found.shown, n.shown);
  }
  pleuel_model_free(m);
}

PL_TEST(uses_lead_from_any_use_to_all_of_them) {
  pleuel_model* m = load(pendulum);
  const pleuel_use* uses;
  size_t n;
  assert_int_equal(pleuel_uses(m, place(pendulum, "φ' ="), &uses, &n), PLEUEL_OK);
  assert_int_equal(n, 4);
  assert_true(uses[0].defines && !uses[1].defines);
  assert_int_equal(uses[0].span.line, 3);
  assert_int_equal(pleuel_uses(m, 2, &uses, &n), PLEUEL_OK);
  assert_int_equal(n, 0);
  pleuel_model_free(m);
}

PL_TEST(a_renamed_model_is_the_same_model) {
  pleuel_model* m = load(pendulum);
  const pleuel_edit* edits;
  size_t n;
  const char* text;
  assert_int_equal(pleuel_rename(m, place(pendulum, "rod:"), "stab", &edits, &n), PLEUEL_OK);
  assert_int_equal(n, 2);
  assert_int_equal(pleuel_edited(m, edits, n, &text), PLEUEL_OK);
  assert_non_null(strstr(text, "solve λ_stab, N"));
  pleuel_model* then = load(text);
  assert_int_equal(pleuel_diagnostic_count(then, PLEUEL_ERROR), 0);
  pleuel_model_free(then);
  assert_int_equal(pleuel_rename(m, place(pendulum, "rod:"), "angle", &edits, &n), PLEUEL_USAGE);
  assert_string_equal(pleuel_message(ctx), "another thing has this name");
  assert_int_equal(pleuel_rename(m, place(pendulum, "rod:"), "cos", &edits, &n), PLEUEL_USAGE);
  pleuel_model_free(m);
}

PL_TEST(hover_tells_what_stands_at_a_place) {
  pleuel_model* m = load(pendulum);
  const char* text;
  pleuel_span span;
  assert_int_equal(pleuel_hover(m, place(pendulum, "m at ("), &text, &span), PLEUEL_OK);
  assert_non_null(strstr(text, "**m** parameter [kg] = 0.5 kg"));
  assert_non_null(strstr(text, "m = 500 [g]"));
  assert_non_null(strstr(text, "<text>, line 2"));
  assert_int_equal(span.begin, place(pendulum, "m at ("));
  assert_int_equal(pleuel_hover(m, place(pendulum, "gravity"), &text, &span), PLEUEL_OK);
  assert_non_null(strstr(text, "gravity EXPR along [-]AXIS"));
  assert_int_equal(pleuel_hover(m, place(pendulum, "m/s^2"), &text, &span), PLEUEL_OK);
  assert_non_null(text);
  assert_int_equal(pleuel_hover(m, place(pendulum, "\"Pend"), &text, &span), PLEUEL_OK);
  assert_null(text);
  pleuel_model_free(m);
}

PL_TEST(a_broken_text_has_names_hover_and_completion) {
  static const char text[] =
      "param m = 1 [kg], l = [m\ncoord x\nmass m at (x\nconstraint c: x = l wi\ninit x = \n";
  pleuel_model* m = load(text);
  PLEUEL_OPTIONS(pleuel_name, n);
  assert_int_equal(pleuel_name_find(m, "l", &n), PLEUEL_OK);
  assert_int_equal(pleuel_name_find(m, "c", &n), PLEUEL_OK);
  const char* hover;
  assert_int_equal(pleuel_hover(m, place(text, "x = l"), &hover, NULL), PLEUEL_OK);
  assert_non_null(strstr(hover, "coordinate"));
  const pleuel_offer* offers;
  size_t k;
  pleuel_span span;
  assert_int_equal(pleuel_complete(m, place(text, "wi\n") + 2, &span, &offers, &k), PLEUEL_OK);
  assert_int_equal(span.begin, place(text, "wi\n"));
  bool with = false;
  for (size_t i = 0; i < k; i++) with |= strcmp(offers[i].text, "with") == 0;
  assert_true(with);
  pleuel_model_free(m);
}

PL_TEST(tokens_cover_the_text_in_order) {
  pleuel_model* m = load(pendulum);
  const pleuel_token* t;
  size_t n, at = 0;
  assert_int_equal(pleuel_tokens(m, &t, &n), PLEUEL_OK);
  for (size_t i = 0; i < n; i++) {
    assert_true(t[i].span.begin >= at && t[i].span.end > t[i].span.begin);
    for (size_t k = at; k < t[i].span.begin; k++) assert_non_null(strchr(" \t\n", pendulum[k]));
    at = t[i].span.end;
  }
  assert_int_equal(t[0].kind, PLEUEL_TOKEN_STATEMENT);
  assert_int_equal(t[1].kind, PLEUEL_TOKEN_TEXT);
  assert_int_equal(t[3].kind, PLEUEL_TOKEN_NAME);
  assert_true(t[3].defines && t[3].name_kind == PLEUEL_KIND_PARAMETER);
  pleuel_model_free(m);
}

// ----------------------------------------------------------------------------------- tolerance
static pleuel_model* load_tolerantly(const char* text, pleuel_status* status) {
  PLEUEL_OPTIONS(pleuel_load_options, o);
  o.tolerant = 1;
  pleuel_model* m = NULL;
  *status = pleuel_load_text(ctx, &m, text, strlen(text), &o);
  assert_non_null(m);
  return m;
}

PL_TEST(what_is_whole_of_a_broken_text_is_checked_and_drawn) {
  static const char text[] =
      "param m = 1 [kg], l = 2 [m], g = 9.81 [m/s^2]\ncoord x, y\nmass m at (x, y)\ngravity g "
      "along -y\n"
      "constraint rod: x^2 + y^2 = l^2\ninit x = 1 [m]\nguess y = -1 [m]\nforce (1 [N], on m\nask "
      "solve "
      "lambda_\nplot x vs\n";
  pleuel_status s;
  pleuel_model* m = load_tolerantly(text, &s);
  const char *summary, *bytes;
  size_t n;
  assert_int_equal(s, PLEUEL_MODEL_ERROR);
  assert_true(pleuel_diagnostic_count(m, PLEUEL_ERROR) >= 3);
  assert_int_equal(pleuel_check(m, &summary, NULL), PLEUEL_OK);
  assert_non_null(strstr(summary, "1"));
  PLEUEL_OPTIONS(pleuel_plot_options, o);
  o.panels = PLEUEL_PANELS_DRAWING;
  assert_int_equal(pleuel_plot(m, &bytes, &n, &o), PLEUEL_OK);
  assert_non_null(strstr(bytes, "<svg"));
  PLEUEL_OPTIONS(pleuel_name, name);
  assert_int_equal(pleuel_name_find(m, "lambda_rod", &name), PLEUEL_OK);
  assert_string_equal(name.unit, "N/m");
  pleuel_model_free(m);
  // without being asked for it, a text with errors is no model
  m = load(text);
  assert_int_equal(pleuel_check(m, &summary, NULL), PLEUEL_MODEL_ERROR);
  pleuel_model_free(m);
}

// ---------------------------------------------------------------------------------------- laws
static char* read_whole(const char* path) {
  FILE* f = fopen(path, "rb");
  assert_non_null(f);
  char* text = calloc(1, 1 << 20);
  size_t n = fread(text, 1, (1 << 20) - 1, f);
  fclose(f);
  text[n] = '\0';
  return text;
}

// How often a message with this sentence comes.
static size_t count_of(pleuel_model* m, const char* code, const char* sentence) {
  PLEUEL_OPTIONS(pleuel_diagnostic, d);
  size_t n = 0;
  for (size_t i = 0; pleuel_diagnostic_get(m, i, &d) == PLEUEL_OK; i++) {
    n += strcmp(d.code, code) == 0 && strcmp(d.sentence, sentence) == 0;
  }
  return n;
}

// A fix takes its message away.
static int fixes;

static void check_fixes(const char* name, const char* text) {
  pleuel_model* m = NULL;
  pleuel_load_text(ctx, &m, text, strlen(text), NULL);
  assert_non_null(m);
  pleuel_check(m, NULL, NULL);
  PLEUEL_OPTIONS(pleuel_diagnostic, d);
  for (size_t i = 0; pleuel_diagnostic_get(m, i, &d) == PLEUEL_OK; i++) {
    if (d.n_edits == 0) continue;
    fixes++;
    const char* fixed = NULL;
    assert_int_equal(pleuel_edited(m, d.edits, d.n_edits, &fixed), PLEUEL_OK);
    char code[8], sentence[512];
    snprintf(code, sizeof code, "%s", d.code);
    snprintf(sentence, sizeof sentence, "%s", d.sentence);
    size_t before = count_of(m, code, sentence);
    pleuel_model* then = NULL;
    pleuel_load_text(ctx, &then, fixed, strlen(fixed), NULL);
    assert_non_null(then);
    pleuel_check(then, NULL, NULL);
    size_t after = count_of(then, code, sentence);
    size_t errors = pleuel_diagnostic_count(m, PLEUEL_ERROR);
    bool broke = errors == 0 && pleuel_diagnostic_count(then, PLEUEL_ERROR) > 0;
    if (broke) fail_msg("%s: the fix of %s makes an error\n%s\n%s", name, code, sentence, fixed);
    if (after >= before)
      fail_msg("%s: the fix of %s leaves it\n%s\n%s", name, code, sentence, fixed);
    pleuel_model_free(then);
  }
  pleuel_model_free(m);
}

static int check_folder(const char* name) {
  DIR* folder = opendir(name);
  assert_non_null(folder);
  int count = 0;
  for (struct dirent* e; (e = readdir(folder)) != NULL;) {
    size_t n = strlen(e->d_name);
    if (n < 8 || strcmp(e->d_name + n - 7, ".pleuel") != 0) continue;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", name, e->d_name);
    char* text = read_whole(path);
    check_fixes(e->d_name, text);
    free(text);
    count++;
  }
  closedir(folder);
  return count;
}

PL_TEST(a_fix_that_is_applied_takes_its_message_away) {
  assert_true(check_folder(PL_WRONG) > 50 && fixes > 30);
  assert_true(check_folder(PL_EXAMPLES) >= 5);
}

// Whatever is left out, the rest is a model or is refused: nothing breaks.
static void look_at_rest(const char* text) {
  pleuel_status s;
  const char *summary, *bytes;
  size_t n;
  pleuel_model* m = load_tolerantly(text, &s);
  pleuel_check(m, &summary, NULL);
  PLEUEL_OPTIONS(pleuel_plot_options, o);
  o.panels = PLEUEL_PANELS_DRAWING;
  o.has_until = 1;
  pleuel_plot(m, &bytes, &n, &o);
  pleuel_name_count(m);
  pleuel_model_free(m);
}

static void cut_and_look(const char* path) {
  char* text = read_whole(path);
  size_t n = strlen(text);
  look_at_rest(text);
  for (size_t at = n / 7; at < n; at += 1 + n / 6) {
    char kept = text[at];
    text[at] = '\0';
    look_at_rest(text);
    text[at] = kept;
  }
  free(text);
}

static int cut_folder(const char* name) {
  DIR* folder = opendir(name);
  assert_non_null(folder);
  int count = 0;
  for (struct dirent* e; (e = readdir(folder)) != NULL;) {
    size_t n = strlen(e->d_name);
    if (n < 8 || strcmp(e->d_name + n - 7, ".pleuel") != 0) continue;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", name, e->d_name);
    cut_and_look(path);
    count++;
  }
  closedir(folder);
  return count;
}

PL_TEST(a_text_that_is_broken_anywhere_leaves_a_model_or_is_refused) {
  assert_true(cut_folder(PL_EXAMPLES) >= 5);
  assert_true(cut_folder(PL_WRONG) > 50);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_message_has_its_place_in_bytes_units_lines_and_a_fix_as_an_edit),
      cmocka_unit_test(a_message_speaks_of_related_places),
      cmocka_unit_test(a_structure_without_size_is_refused),
      cmocka_unit_test(messages_and_names_of_included_files_name_their_file),
      cmocka_unit_test(all_that_has_a_name_is_listed_with_unit_and_value),
      cmocka_unit_test(every_name_that_is_listed_is_found_by_its_spellings),
      cmocka_unit_test(uses_lead_from_any_use_to_all_of_them),
      cmocka_unit_test(a_renamed_model_is_the_same_model),
      cmocka_unit_test(hover_tells_what_stands_at_a_place),
      cmocka_unit_test(a_broken_text_has_names_hover_and_completion),
      cmocka_unit_test(tokens_cover_the_text_in_order),
      cmocka_unit_test(what_is_whole_of_a_broken_text_is_checked_and_drawn),
      cmocka_unit_test(a_text_that_is_broken_anywhere_leaves_a_model_or_is_refused),
      cmocka_unit_test(a_fix_that_is_applied_takes_its_message_away),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
