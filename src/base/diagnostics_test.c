// Diagnostics: places, order, and the form in which they are printed (language.md, "Messages").
#include "base/base_test_kit.h"

static const char atwood[] =
    "param g = 9.81 [m/s^2]\n"
    "constraint g1: x1 + x2 = g\n"
    "init x1 = 1 [m]\r\n"
    "mass ϑϑ at \tx3";

static pl_span span_of(const pl_source* s, const char* text) {
  const char* at = strstr(s->text, text);
  assert_non_null(at);
  uint32_t begin = (uint32_t)(at - s->text);
  return (pl_span){s, begin, begin + (uint32_t)strlen(text)};
}

static pl_source* source(pl_arena* a) {
  return pl_source_make(a, "atwood.pleuel", atwood, sizeof atwood - 1);
}

static const char* printed(pl_arena* a, const pl_diagnostic* m, pl_print_style style) {
  pl_text t = pl_text_make(a);
  pl_diagnostic_print(&t, m, style);
  return pl_text_string(&t);
}

PL_TEST(places_count_lines_and_cells) {
  pl_source* s = source(a);
  assert_int_equal(s->n_lines, 4);
  pl_place p = pl_span_place(span_of(s, "x1 + x2"));
  assert_int_equal(p.line, 2);
  assert_int_equal(p.column, 16);
  p = pl_span_place(span_of(s, "at \t"));
  assert_int_equal(p.line, 4);
  assert_int_equal(p.column, 9);  // two Greek letters are two cells
  p = pl_span_place((pl_span){s, 100000, 100001});
  assert_int_equal(p.line, 4);
  assert_string_equal(pl_source_line(a, s, 3), "init x1 = 1 [m]");
  assert_string_equal(pl_source_line(a, s, 5), "");
}

PL_TEST(spans_join) {
  pl_source* s = source(a);
  pl_span j = pl_span_join(span_of(s, "x2 = g"), span_of(s, "g1"));
  assert_int_equal(j.begin, span_of(s, "g1").begin);
  assert_int_equal(j.end, span_of(s, "x2 = g").end);
  assert_ptr_equal(pl_span_join((pl_span){0}, j).source, s);
}

PL_TEST(a_message_shows_sentence_line_carets_reason_and_fix) {
  pl_source* s = source(a);
  pl_diagnostics d = {.arena = a};
  pl_diagnostic* m = pl_report(&d, PL_E021, span_of(s, "x1 + x2"),
                               "a length cannot equal an acceleration",
                               "eine Länge kann keiner Beschleunigung gleich sein");
  pl_report_reason(m, "m  (x1 from line 3)", NULL);
  pl_span g = span_of(s, "= g\n");
  pl_report_label(&d, m, (pl_span){s, g.begin + 2, g.begin + 3}, "m/s²  (line 1)");
  pl_report_fix(m, "did you mean l?", NULL, "l");
  assert_string_equal(printed(a, m, (pl_print_style){0}),
                      "atwood.pleuel:2: E021  a length cannot equal an acceleration\n"
                      "    2 | constraint g1: x1 + x2 = g\n"
                      "      |                ^^^^^^^   ^ m/s²  (line 1)\n"
                      "      |                m  (x1 from line 3)\n"
                      "      = did you mean l?\n");
  assert_string_equal(
      printed(a, m, (pl_print_style){.lang = PL_GERMAN, .terse = true}),
      "atwood.pleuel:2:16: E021: eine Länge kann keiner Beschleunigung gleich sein\n");
}

PL_TEST(marks_on_another_line_bring_their_line) {
  pl_source* s = source(a);
  pl_diagnostics d = {.arena = a};
  pl_diagnostic* m = pl_report(&d, PL_E012, span_of(s, "x1 = 1"), "x1 is declared twice", NULL);
  pl_report_label(&d, m, span_of(s, "x1 + x2"), "here first");
  assert_string_equal(printed(a, m, (pl_print_style){.lang = PL_GERMAN}),
                      "atwood.pleuel:3: E012  x1 is declared twice\n"
                      "    3 | init x1 = 1 [m]\n"
                      "      |      ^^^^^^\n"
                      "    2 | constraint g1: x1 + x2 = g\n"
                      "      |                ^^^^^^^ here first\n");
}

PL_TEST(a_message_about_the_whole_model_has_no_line) {
  pl_diagnostics d = {.arena = a};
  pl_diagnostic* m = pl_report(&d, PL_E043, (pl_span){0}, "2 solutions fit the start", NULL);
  pl_report_fix(m, "add  branch x2 < x1\nor   branch x2 > x1", NULL, NULL);
  assert_string_equal(printed(a, m, (pl_print_style){0}),
                      "E043  2 solutions fit the start\n"
                      "      = add  branch x2 < x1\n"
                      "        or   branch x2 > x1\n");
}

PL_TEST(what_a_terminal_would_obey_is_not_printed) {
  const char text[] = "bad \033[31m\ttab \x80 end";
  pl_source* s = pl_source_make(a, "x", text, sizeof text - 1);
  pl_diagnostics d = {.arena = a};
  const char* shown = printed(a, pl_report(&d, PL_E001, span_of(s, "tab"), "s", NULL),
                              (pl_print_style){0});
  assert_null(strchr(shown, '\033'));
  assert_null(strchr(shown, '\t'));
  assert_non_null(strstr(shown, "      |           ^^^\n"));
  assert_non_null(
      strstr(printed(a, &d.list.at[0], (pl_print_style){.colour = true}), "\033[1;31m^^^\033[0m"));
}

PL_TEST(a_very_long_line_is_cut_to_a_window) {
  char* text = pl_alloc(a, 5001);
  memset(text, 'y', 5000);
  memcpy(text + 4000, "HERE", 4);
  pl_source* s = pl_source_make(a, "x", text, 5000);
  pl_diagnostics d = {.arena = a};
  const char* shown = printed(a, pl_report(&d, PL_E001, span_of(s, "HERE"), "s", NULL),
                              (pl_print_style){0});
  assert_true(strlen(shown) < 500);
  const char *here = strstr(shown, "HERE"), *line = strstr(shown, "    1 | "),
             *carets = strstr(shown, "^^^^");
  assert_non_null(here);
  const char* caret_line = strstr(shown, "      | ");
  assert_int_equal(here - line, carets - caret_line);
}

PL_TEST(messages_are_put_in_order_and_said_once) {
  pl_source* s = source(a);
  pl_diagnostics d = {.arena = a};
  pl_report(&d, PL_N061, (pl_span){0}, "general", NULL);
  pl_report(&d, PL_E011, span_of(s, "x3"), "x3", NULL);
  pl_report(&d, PL_E021, span_of(s, "x1 + x2"), "units", NULL);
  pl_report(&d, PL_E011, span_of(s, "x3"), "x3", NULL);
  pl_report(&d, PL_E011, span_of(s, "x1 + x2"), "x1", NULL);
  assert_int_equal(d.n_errors, 4);
  pl_diagnostics_sort(&d);
  assert_int_equal(d.list.n, 4);
  assert_int_equal(d.n_errors, 3);
  assert_string_equal(d.list.at[0].sentence[0], "x1");
  assert_string_equal(d.list.at[1].sentence[0], "units");
  assert_string_equal(d.list.at[2].sentence[0], "x3");
  assert_string_equal(d.list.at[3].sentence[0], "general");
}

PL_TEST(codes_are_found_by_their_names) {
  for (int c = 0; c < PL_N_CODES; c++) {
    pl_code found;
    assert_true(pl_code_find(pl_code_name((pl_code)c), &found));
    assert_int_equal(found, c);
    assert_true(strlen(pl_code_title((pl_code)c, PL_ENGLISH)) > 0);
    assert_true(strlen(pl_code_title((pl_code)c, PL_GERMAN)) > 0);
  }
  pl_code none;
  assert_false(pl_code_find("E999", &none));
  assert_int_equal(pl_code_severity(PL_E011), PL_ERROR);
  assert_int_equal(pl_code_severity(PL_N052), PL_NOTE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(places_count_lines_and_cells),
      cmocka_unit_test(spans_join),
      cmocka_unit_test(a_message_shows_sentence_line_carets_reason_and_fix),
      cmocka_unit_test(marks_on_another_line_bring_their_line),
      cmocka_unit_test(a_message_about_the_whole_model_has_no_line),
      cmocka_unit_test(what_a_terminal_would_obey_is_not_printed),
      cmocka_unit_test(a_very_long_line_is_cut_to_a_window),
      cmocka_unit_test(messages_are_put_in_order_and_said_once),
      cmocka_unit_test(codes_are_found_by_their_names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
