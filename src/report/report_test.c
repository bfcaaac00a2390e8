// Tests of the layout and of the JSON document, with solutions made by hand: what derive hands
// over, without deriving.
#include "report.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct bench {
  pl_arena* a;
  pl_pool* p;
  pl_model* m;
  pl_solution s;
  pl_symbol m1, m2, g, x1, theta, lambda;
} bench;

static pl_symbol bench_symbol(bench* b, const char* name, const char* ascii, pl_role role,
                              pl_class class) {
  pl_symbol_info info = {
      .name = name, .ascii = ascii, .role = role, .class = class, .sign = PL_SIGN_POSITIVE};
  info.dimension = pl_dimension_one();
  return pl_symbol_make(b->p, &info);
}

static bench bench_make(void) {
  bench b = {.a = pl_arena_make(NULL)};
  b.p = pl_pool_make(b.a);
  b.m = pl_model_make(b.a);
  b.m->pool = b.p;
  b.m->title = "Atwood machine";
  b.s.model = b.m;
  b.m1 = bench_symbol(&b, "m1", "m1", PL_R_PARAM, PL_C_MASS);
  b.m2 = bench_symbol(&b, "m2", "m2", PL_R_PARAM, PL_C_MASS);
  b.g = bench_symbol(&b, "g", "g", PL_R_PARAM, PL_C_GRAVITY);
  b.x1 = bench_symbol(&b, "x1", "x1", PL_R_COORD, PL_C_COORD);
  b.theta = bench_symbol(&b, "ϑ", "theta", PL_R_COORD, PL_C_COORD);
  b.lambda = bench_symbol(&b, "λ", "lambda_g1", PL_R_MULTIPLIER, PL_C_MULTIPLIER);
  return b;
}

static pl_section* bench_section(bench* b, const char* letter, const char* en, const char* de) {
  pl_section s = {.letter = letter, .item = "solve λ", .title = {en, de}};
  pl_push(b->a, b->s.sections, s);
  return &b->s.sections.at[b->s.sections.n - 1];
}

static pl_step* bench_step(bench* b, pl_section* s, pl_step_kind kind, const char* en,
                           const char* de) {
  pl_step step = {.kind = kind, .words = {en, de}};
  pl_push(b->a, s->steps, step);
  return &s->steps.at[s->steps.n - 1];
}

static const pl_form* bench_name(bench* b, const char* text) {
  return pl_form_name(b->a, text, pl_poison());
}

static const char* bench_text(bench* b, pl_worked_style style) {
  pl_text out = pl_text_make(b->a);
  pl_worked_text(&out, &b->s, NULL, &style);
  return pl_text_string(&out);
}

static const char* bench_json(bench* b) {
  pl_text out = pl_text_make(b->a);
  pl_json_input in = {
      .file = "atwood.pleuel", .model = b->m, .solution = &b->s, .status = PLEUEL_OK};
  pl_worked_json(&out, &in);
  return pl_text_string(&out);
}

static void assert_has(const char* text, const char* part) {
  if (text && strstr(text, part)) return;
  fputs(text ? text : "", stderr);
  fail_msg("not found above: %s", part);
}

static void assert_has_not(const char* text, const char* part) {
  if (text && !strstr(text, part)) return;
  fputs(text ? text : "", stderr);
  fail_msg("found above: %s", part);
}

static int widest_line(const char* s) {
  int widest = 0;
  while (*s) {
    size_t n = strcspn(s, "\n");
    int w = pl_utf8_width_n(s, n);
    if (w > widest) widest = w;
    s += n + (s[n] == '\n');
  }
  return widest;
}

// -------------------------------------------------------------------------------------------- text
static void sections_stand_under_their_letters(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "b", "Degrees of freedom", "Freiheitsgrade");
  bench_step(&b, s, PL_STEP_TEXT, "One sentence.", "Ein Satz.");
  s = bench_section(&b, NULL, "Equilibria", "Gleichgewichtslagen");
  bench_step(&b, s, PL_STEP_TEXT, "None.", "Keine.");
  assert_string_equal(bench_text(&b, pl_worked_style_default(PL_ENGLISH)),
                      "Atwood machine\n\n  b) Degrees of freedom\n     One sentence.\n\n  –) "
                      "Equilibria\n     None.\n");
  assert_string_equal(bench_text(&b, pl_worked_style_default(PL_GERMAN)),
                      "Atwood machine\n\n  b) Freiheitsgrade\n     Ein Satz.\n\n  –) "
                      "Gleichgewichtslagen\n     Keine.\n");
  pl_arena_free(b.a);
}

static void same_letter_and_other_title_is_a_heading_inside(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "d", "Motion", "Bewegung");
  bench_step(&b, s, PL_STEP_TEXT, "First.", "Erstens.");
  s = bench_section(&b, "d", "Conserved", "Erhalten");
  bench_step(&b, s, PL_STEP_TEXT, "Second.", "Zweitens.");
  s = bench_section(&b, "d", "Conserved", "Erhalten");
  s->continues = true;
  bench_step(&b, s, PL_STEP_TEXT, "Third.", "Drittens.");
  assert_string_equal(
      bench_text(&b, pl_worked_style_default(PL_ENGLISH)),
      "Atwood machine\n\n  d) Motion\n     First.\n\n     Conserved\n     Second.\n     Third.\n");
  pl_arena_free(b.a);
}

static void equation_numbers_end_at_the_margin(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "c", "Equations", "Gleichungen");
  pl_step* e = bench_step(&b, s, PL_STEP_EQUATION, NULL, NULL);
  e->formula = bench_name(&b, "λ");
  e->number = 4;
  e->has_value = true;
  e->value = -23.544;
  e->unit = "N";
  const char* text = bench_text(&b, pl_worked_style_default(PL_ENGLISH));
  assert_has(text,
             "     λ                                                                     (4)\n");
  assert_has(text,
             "                                                                   = -23.544 N\n");
  assert_int_equal(widest_line(text), 78);
  assert_has(bench_text(&b, pl_worked_style_default(PL_GERMAN)), "= -23,544 N\n");
  pl_arena_free(b.a);
}

static void angles_are_shown_in_degrees(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "d", "Take-off", "Abheben");
  pl_step* e = bench_step(&b, s, PL_STEP_EQUATION, NULL, NULL);
  e->formula = bench_name(&b, "ϑ");
  e->has_value = true;
  e->value = acos(2.0 / 3);
  e->unit = "rad";
  assert_has(bench_text(&b, pl_worked_style_default(PL_ENGLISH)), "= 48.1897°\n");
  pl_worked_style ascii = pl_worked_style_default(PL_ENGLISH);
  ascii.math = PL_MATH_ASCII;
  assert_has(bench_text(&b, ascii), "= 48.1897 deg\n");
  pl_arena_free(b.a);
}

static void rows_make_a_table(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "b", "Degrees of freedom", "Freiheitsgrade");
  pl_step* r = bench_step(&b, s, PL_STEP_ROW, "coordinates", "Koordinaten");
  r->formula = bench_name(&b, "x1 x2");
  r->margin = "2";
  r = bench_step(&b, s, PL_STEP_ROW, "constraints", "Zwangsbedingungen");
  r->formula = bench_name(&b, "x1 + x2 = l");
  r->margin = "-1";
  r->after[0] = "dropped";
  r->after[1] = "entfällt";
  r = bench_step(&b, s, PL_STEP_ROW, "degrees of freedom", "Freiheitsgrade");
  r->margin = "1";
  bench_step(&b, s, PL_STEP_TEXT, "Done.", "Fertig.");
  assert_string_equal(
      bench_text(&b, pl_worked_style_default(PL_ENGLISH)),
      "Atwood machine\n\n  b) Degrees of freedom\n"
      "     coordinates    x1 x2                                                    2\n"
      "     constraints    x1 + x2 = l                                             -1   dropped\n"
      "     degrees of freedom                                                      1\n"
      "\n     Done.\n");
  pl_arena_free(b.a);
}

static void sentences_are_wrapped_between_words(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "a", "Words", "Worte");
  bench_step(&b, s, PL_STEP_TEXT, "aaaa bbbb cccc dddd eeee ffff gggg hhhh iiii jjjj", "x");
  pl_worked_style narrow = pl_worked_style_default(PL_ENGLISH);
  narrow.width = 40;
  assert_has(bench_text(&b, narrow),
             "     aaaa bbbb cccc dddd eeee ffff gggg\n     hhhh iiii jjjj\n");
  narrow.width = 0;
  assert_has(bench_text(&b, narrow), "     aaaa bbbb cccc dddd eeee ffff gggg hhhh iiii jjjj\n");
  pl_arena_free(b.a);
}

static void inserts_take_their_places_and_do_not_break(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "a", "Words", "Worte");
  const pl_form* insert[2] = {bench_name(&b, "x1 + x2"), bench_name(&b, "λ")};
  pl_step* t = bench_step(&b, s, PL_STEP_TEXT, "{2} belongs to the long rope, see {1} for {3}{}{9.",
                          "x");
  t->n_inserts = 2;
  t->inserts = insert;
  pl_worked_style narrow = pl_worked_style_default(PL_ENGLISH);
  narrow.width = 40;
  assert_has(bench_text(&b, narrow),
             "     λ belongs to the long rope, see\n     x1 + x2 for {}{9.\n");
  pl_arena_free(b.a);
}

static void long_formulas_break_before_signs_with_hanging_indent(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "a", "Long", "Lang");
  pl_step* e = bench_step(&b, s, PL_STEP_EQUATION, NULL, NULL);
  e->formula = bench_name(&b,
                          "L = aaaaaaaaaa (b - c) + dddddddddddd - (eeeeeeeeee + ffffffff) + gggg");
  e->number = 12;
  pl_worked_style narrow = pl_worked_style_default(PL_ENGLISH);
  narrow.width = 48;
  const char* text = bench_text(&b, narrow);
  assert_has(text,
             "     L = aaaaaaaaaa (b - c) + dddddddddddd\n         - (eeeeeeeeee + ffffffff) + "
             "gggg   (12)\n");
  assert_true(widest_line(text) <= 48);
  narrow.width = 0;
  assert_has(bench_text(&b, narrow),
             "     L = aaaaaaaaaa (b - c) + dddddddddddd - (eeeeeeeeee + ffffffff) + gggg  (12)\n");
  pl_arena_free(b.a);
}

static void tall_formulas_keep_the_number_on_the_base_line(void** state) {
  (void)state;
  bench b = bench_make();
  pl_expr m1 = pl_sym(b.p, b.m1), m2 = pl_sym(b.p, b.m2);
  const pl_form* f = pl_form_quotient(b.a, pl_form_of(b.a, b.p, pl_mul(b.p, m1, m2)),
                                      pl_form_of(b.a, b.p, pl_add(b.p, m1, m2)));
  pl_section* s = bench_section(&b, "c", "Tall", "Hoch");
  pl_step* e = bench_step(&b, s, PL_STEP_EQUATION, NULL, NULL);
  e->formula = pl_form_relation(b.a, pl_form_leaf(b.a, pl_sym(b.p, b.lambda)), "=", f);
  e->number = 7;
  pl_worked_style style = pl_worked_style_default(PL_ENGLISH);
  style.math = PL_MATH_2D;
  const char* text = bench_text(&b, style);
  const char* base = strstr(text, "     λ = ");
  assert_non_null(base);
  assert_int_equal(pl_utf8_width_n(base, strcspn(base, "\n")), 78);
  assert_has(base, "(7)\n");
  pl_arena_free(b.a);
}

static void ascii_is_ascii(void** state) {
  (void)state;
  bench b = bench_make();
  b.m->title = "Pleuelstange – Übung ½";
  pl_section* s = bench_section(&b, NULL, "Größe … α", "x");
  pl_step* t = bench_step(&b, s, PL_STEP_TEXT, "2 m/s², 10⁻¹² kg · «π» λ₁ → ∞ … \xff", "x");
  t->after[0] = NULL;
  pl_step* e = bench_step(&b, s, PL_STEP_EQUATION, NULL, NULL);
  e->formula = pl_form_of(b.a, b.p, pl_square(b.p, pl_sym(b.p, b.theta)));
  e->after[0] = "für ϑ ≥ 0";
  pl_push(b.a, b.s.used, "ϑ ≠ 0");
  pl_worked_style style = pl_worked_style_default(PL_ENGLISH);
  style.math = PL_MATH_ASCII;
  const char* text = bench_text(&b, style);
  for (const char* c = text; *c; c++) {
    if ((unsigned char)*c >= 0x80) fail_msg("not ASCII at %.20s in\n%s", c, text);
  }
  assert_has(text, "2 m/s^2, 10^-12 kg");
  assert_has(text, "Groesse");
  assert_has(text, "theta != 0");
  pl_arena_free(b.a);
}

static void details_are_for_full_steps(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "a", "A", "A");
  bench_step(&b, s, PL_STEP_TEXT, "always", "immer");
  bench_step(&b, s, PL_STEP_TEXT, "on demand", "auf Wunsch")->detail = true;
  pl_worked_style style = pl_worked_style_default(PL_ENGLISH);
  assert_has_not(bench_text(&b, style), "on demand");
  style.full = true;
  assert_has(bench_text(&b, style), "on demand");
  pl_arena_free(b.a);
}

static void only_the_wanted_letters_are_written(void** state) {
  (void)state;
  bench b = bench_make();
  const char* letters[] = {"a", "b", NULL, "c"};
  for (int i = 0; i < 4; i++) {
    pl_section* s = bench_section(&b, letters[i], pl_format(b.a, "Title%d", i), "x");
    bench_step(&b, s, PL_STEP_TEXT, "text", "Text");
  }
  pl_worked_style style = pl_worked_style_default(PL_ENGLISH);
  style.only = "a, c";
  const char* text = bench_text(&b, style);
  assert_has(text, "a) Title0");
  assert_has(text, "c) Title3");
  assert_has_not(text, "Title1");
  assert_has_not(text, "Title2");
  pl_arena_free(b.a);
}

static pl_check bench_check(const char* name, bool passed) {
  return (pl_check){.name = {name, name}, .passed = passed, .points = 50, .formulas = 3};
}

static void failed_checks_are_named(void** state) {
  (void)state;
  bench b = bench_make();
  pl_push(b.a, b.s.checks, bench_check("units", true));
  pl_push(b.a, b.s.checks, bench_check("numbers", true));
  assert_has(bench_text(&b, pl_worked_style_default(PL_ENGLISH)), "  checks  units · numbers");
  assert_has(bench_text(&b, pl_worked_style_default(PL_ENGLISH)), "all passed\n");
  b.s.checks.at[1].passed = false;
  b.s.checks.at[1].failed_on = "x1'' = 0";
  const char* text = bench_text(&b, pl_worked_style_default(PL_ENGLISH));
  assert_has(text, "1 failed\n");
  assert_has(text, "failed: numbers, at x1'' = 0\n");
  assert_has_not(text, "all passed");
  pl_arena_free(b.a);
}

static void colour_changes_no_column(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "c", "Equations", "Gleichungen");
  pl_step* e = bench_step(&b, s, PL_STEP_EQUATION, NULL, NULL);
  e->formula = bench_name(&b, "λ = 1");
  e->number = 3;
  bench_step(&b, s, PL_STEP_NOTE, "N055: watch out", "N055: aufgepasst");
  pl_push(b.a, b.s.checks, bench_check("units", true));
  pl_worked_style style = pl_worked_style_default(PL_ENGLISH);
  const char* plain = bench_text(&b, style);
  style.colour = true;
  const char* coloured = bench_text(&b, style);
  assert_has(coloured, "\033[33m");
  pl_text bare = pl_text_make(b.a);
  for (const char* c = coloured; *c; c++) {
    if (*c == '\033') c = strchr(c, 'm');
    else pl_text_add_n(&bare, c, 1);
  }
  assert_string_equal(pl_text_string(&bare), plain);
  assert_has(plain, "     note N055: watch out\n");
  pl_arena_free(b.a);
}

// Law: no line is wider than the page whenever no single word or unbreakable formula is.
static void random_sentences_stay_on_the_page(void** state) {
  (void)state;
  uint64_t seed = 7;
  pl_random r = {seed};
  for (int round = 0; round < 200; round++) {
    bench b = bench_make();
    pl_section* s = bench_section(&b, "a", "A", "A");
    pl_text words = pl_text_make(b.a);
    int n = (int)(pl_random_bits(&r) % 60);
    for (int i = 0; i < n; i++) {
      int length = 1 + (int)(pl_random_bits(&r) % 12);
      for (int k = 0; k < length; k++) pl_text_add(&words, pl_random_bits(&r) % 3 ? "a" : "ö");
      pl_text_add(&words, " ");
    }
    bench_step(&b, s, PL_STEP_TEXT, pl_text_string(&words), "x");
    pl_worked_style style = pl_worked_style_default(PL_ENGLISH);
    style.width = 40 + (int)(pl_random_bits(&r) % 60);
    const char* text = bench_text(&b, style);
    if (widest_line(text) > style.width)
      fail_msg("seed %lu, round %d: wider than %d:\n%s", (unsigned long)seed, round, style.width,
               text);
    pl_arena_free(b.a);
  }
}

// -------------------------------------------------------------------------------------------- JSON
static void json_escapes_and_indents(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_text out = pl_text_make(a);
  pl_json j = pl_json_make(&out);
  pl_json_object(&j, NULL);
  pl_json_string(&j, "a\"b", "x\\y\n\t\x01ü\xff");
  pl_json_list(&j, "empty");
  pl_json_end_list(&j);
  pl_json_list(&j, "flat");
  pl_json_flat(&j);
  pl_json_int(&j, NULL, -3);
  pl_json_bool(&j, NULL, true);
  pl_json_number(&j, NULL, (double)NAN);
  pl_json_end_list(&j);
  pl_json_object(&j, "deep");
  pl_json_null(&j, "n");
  pl_json_end_object(&j);
  pl_json_end_object(&j);
  assert_string_equal(pl_text_string(&out),
                      "{\n  \"a\\\"b\": \"x\\\\y\\n\\t\\u0001ü\\ufffd\",\n  \"empty\": [],\n  "
                      "\"flat\": [-3, true, null],\n"
                      "  \"deep\": {\n    \"n\": null\n  }\n}");
  pl_arena_free(a);
}

static void numbers_are_the_shortest_that_read_back(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  assert_string_equal(pl_shortest_double(a, 0.1), "0.1");
  assert_string_equal(pl_shortest_double(a, -23.544), "-23.544");
  assert_string_equal(pl_shortest_double(a, acos(2.0 / 3)), "0.8410686705679303");
  assert_string_equal(pl_shortest_double(a, -0.0), "0");
  assert_string_equal(pl_shortest_double(a, 20), "20");
  assert_string_equal(pl_shortest_double(a, -1000), "-1000");
  assert_string_equal(pl_shortest_double(a, 1e15), "1000000000000000");
  assert_string_equal(pl_shortest_double(a, 1e22), "1e+22");
  assert_string_equal(pl_shortest_double(a, 0.00001), "1e-05");
  pl_random r = {11};
  for (int i = 0; i < 2000; i++) {
    union {
      uint64_t bits;
      double x;
    } u = {.bits = pl_random_bits(&r)};
    if (!isfinite(u.x) || u.x == 0) continue;
    const char* s = pl_shortest_double(a, u.x);
    if (strtod(s, NULL) != u.x) fail_msg("seed 11: %a written as %s", u.x, s);
  }
  pl_arena_free(a);
}

static void json_keys_stand_in_the_order_of_the_contract(void** state) {
  (void)state;
  bench b = bench_make();
  pl_section* s = bench_section(&b, "c", "Force", "Kraft");
  pl_expr e = pl_neg(b.p, pl_mul(b.p, pl_sym(b.p, b.m1), pl_sym(b.p, b.g)));
  pl_value v = {.name = "lambda_g1",
                .of = "g1",
                .expr = e,
                .form = pl_form_of(b.a, b.p, e),
                .number = -29.43,
                .unit = "N",
                .conserved = -1,
                .passed = -1,
                .order = -1};
  pl_push(b.a, s->values, v);
  const char* text = bench_json(&b);
  const char* keys[] = {"\"pleuel\": 1",
                        "\"file\"",
                        "\"system\"",
                        "\"coords\"",
                        "\"parameters\"",
                        "\"constraints\"",
                        "\"dof\"",
                        "\"answers\"",
                        "\"c\": [",
                        "\"item\"",
                        "\"steps\"",
                        "\"values\"",
                        "\"name\": \"lambda_g1\"",
                        "\"of\": \"g1\"",
                        "\"expr\": \"-",
                        "\"text\"",
                        "\"tex\"",
                        "\"mathml\"",
                        "\"number\": -29.43",
                        "\"unit\": \"N\"",
                        "\"display\": \"-29.43 N\"",
                        "\"assuming\": []",
                        "\"checks\": []",
                        "\"assumptions\": []",
                        "\"notes\": []",
                        "\"status\": \"ok\"",
                        "\"timing_ms\": {}"};
  const char* at = text;
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
    const char* next = strstr(at, keys[i]);
    if (!next) fail_msg("%s is missing or too early in\n%s", keys[i], text);
    at = next;
  }
  pl_arena_free(b.a);
}

static void sections_without_letter_are_numbered_and_letters_collect(void** state) {
  (void)state;
  bench b = bench_make();
  const char* letters[] = {"e", NULL, "e", NULL};
  for (int i = 0; i < 4; i++)
    bench_section(&b, letters[i], "T", "T")->item = pl_format(b.a, "item%d", i);
  const char* text = bench_json(&b);
  const char* order[] = {"\"e\": [", "item0", "item2", "\"1\": [", "item1", "\"2\": [", "item3"};
  const char* at = text;
  for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
    at = strstr(at, order[i]);
    if (!at) fail_msg("%s not in order in\n%s", order[i], text);
  }
  assert_null(strstr(strstr(text, "\"e\": [") + 1, "\"e\": ["));
  pl_arena_free(b.a);
}

static void errors_have_the_shape_of_answers(void** state) {
  (void)state;
  pl_arena* a = pl_arena_make(NULL);
  pl_diagnostics d = {.arena = a};
  const char* source = "param m\ncoord x\nmass m at (y)\n";
  pl_source* file = pl_source_make(a, "bad.pleuel", source, strlen(source));
  pl_diagnostic* m = pl_report(&d, PL_E011, (pl_span){file, 27, 28}, "y is not declared",
                               "y ist nicht vereinbart");
  pl_report_fix(m, "did you mean x?", "ist x gemeint?", "x");
  pl_json_input in = {
      .file = "bad.pleuel", .diagnostics = &d, .status = PLEUEL_MODEL_ERROR, .lang = PL_GERMAN};
  pl_text out = pl_text_make(a);
  pl_worked_json(&out, &in);
  const char* text = pl_text_string(&out);
  assert_has(text, "\"system\": null");
  assert_has(text, "\"answers\": {}");
  assert_has(text, "\"dof\": null");
  assert_has(text, "\"code\": \"E011\"");
  assert_has(text, "\"severity\": \"error\"");
  assert_has(text, "\"line\": 3");
  assert_has(text, "\"col\": 12");
  assert_has(text, "\"text\": \"y ist nicht vereinbart\"");
  assert_has(text, "\"fix\": \"ist x gemeint?\"");
  assert_has(text, "\"replacement\": \"x\"");
  assert_has(text, "\"status\": \"model_error\"");
  pl_arena_free(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_stand_under_their_letters),
      cmocka_unit_test(same_letter_and_other_title_is_a_heading_inside),
      cmocka_unit_test(equation_numbers_end_at_the_margin),
      cmocka_unit_test(angles_are_shown_in_degrees),
      cmocka_unit_test(rows_make_a_table),
      cmocka_unit_test(sentences_are_wrapped_between_words),
      cmocka_unit_test(inserts_take_their_places_and_do_not_break),
      cmocka_unit_test(long_formulas_break_before_signs_with_hanging_indent),
      cmocka_unit_test(tall_formulas_keep_the_number_on_the_base_line),
      cmocka_unit_test(ascii_is_ascii),
      cmocka_unit_test(details_are_for_full_steps),
      cmocka_unit_test(only_the_wanted_letters_are_written),
      cmocka_unit_test(failed_checks_are_named),
      cmocka_unit_test(colour_changes_no_column),
      cmocka_unit_test(random_sentences_stay_on_the_page),
      cmocka_unit_test(json_escapes_and_indents),
      cmocka_unit_test(numbers_are_the_shortest_that_read_back),
      cmocka_unit_test(json_keys_stand_in_the_order_of_the_contract),
      cmocka_unit_test(sections_without_letter_are_numbered_and_letters_collect),
      cmocka_unit_test(errors_have_the_shape_of_answers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
