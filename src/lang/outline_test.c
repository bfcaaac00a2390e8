// What an editor asks of a text: names, their uses, tokens, what may stand at a place; in whole
// and in broken texts.
#include "lang/lang_testing.h"
#include "lang/outline.h"

#include <dirent.h>
#include <stdio.h>

#define PL_TEST(name) static void name(void** state)

typedef struct reader {
  pl_arena* a;
  pl_outline* o;
} reader;

static reader read_text(const char* text) {
  pl_arena* a = pl_arena_make(NULL);
  pl_source* s = pl_source_make(a, "test.pleuel", text, strlen(text));
  return (reader){a, pl_outline_make(a, s, NULL)};
}

static const char* source_of(const reader* r, pl_span s) {
  return pl_copy_n(r->a, s.source->text + s.begin, s.end - s.begin);
}

// "m@8 m@40": where the name under a mark of the text stands.
static const char* uses_at(const reader* r, const char* text, const char* mark, size_t in_mark) {
  const char* at = strstr(text, mark);
  assert_non_null(at);
  const pl_source* s = r->o->uses.at[0].span.source;
  int use = pl_outline_use_at(r->o, s, (size_t)(at - text) + in_mark);
  if (use < 0) return "none";
  pl_text out = pl_text_make(r->a);
  for (int i = 0; i < r->o->uses.n; i++) {
    const pl_use* u = &r->o->uses.at[i];
    if (u->named != r->o->uses.at[use].named) continue;
    pl_text_addf(&out, "%s%s@%u", out.n ? " " : "", source_of(r, u->span), u->span.begin);
  }
  return pl_text_string(&out);
}

static bool offers(const reader* r, size_t at, const char* word) {
  pl_offers all = pl_outline_offer(r->a, r->o, at);
  for (int i = 0; i < all.list.n; i++) {
    if (strcmp(all.list.at[i].text, word) == 0) return true;
  }
  return false;
}

static bool offers_behind(const char* text, const char* word) {
  reader r = read_text(text);
  bool found = offers(&r, strlen(text), word);
  pl_arena_free(r.a);
  return found;
}

// ---------------------------------------------------------------------------------------- uses
PL_TEST(every_use_of_a_name_is_found_in_all_its_spellings) {
  static const char text[] =
      "param m_1 = 1\ncoord θ1\nmass m₁ at (sin theta1, θ1_dot)\ninit theta_1' = 0\n";
  reader r = read_text(text);
  assert_string_equal(uses_at(&r, text, "m_1", 0), "m_1@6 m₁@29");
  assert_string_equal(uses_at(&r, text, "θ1\n", 0), "θ1@20 theta1@42 θ1@50 theta_1@64");
  pl_arena_free(r.a);
}

PL_TEST(labels_and_values_of_one_name_are_two_names) {
  static const char text[] =
      "coord x, A\nparam m\nmass A: m at (x, 0)\nforce (A, 0) on A\nconstraint c: x(A) = A\nask "
      "force of c\n";
  reader r = read_text(text);
  assert_string_equal(uses_at(&r, text, "A\nparam", 0), "A@9 A@46 A@78");
  assert_string_equal(uses_at(&r, text, "A: m", 0), "A@24 A@55 A@73");
  assert_string_equal(uses_at(&r, text, "c: x", 0), "c@68 c@93");
  pl_arena_free(r.a);
}

PL_TEST(a_multiplier_belongs_to_its_constraint) {
  static const char text[] =
      "coord x, y\nconstraint rod: x = y\nconstraint up: y = 0 with N\n"
      "ask solve λ_rod, lambda_rod, N\n";
  reader r = read_text(text);
  assert_string_equal(uses_at(&r, text, "rod: x", 0), "rod@22 rod@74 rod@86");
  assert_string_equal(uses_at(&r, text, "N\nask", 0), "N@59 N@91");
  pl_arena_free(r.a);
}

PL_TEST(an_index_hides_what_has_its_name) {
  static const char text[] =
      "param i = 3, N = 2\ncoord x[1..N]\nfor i in 1..N {\n init x[i] = i\n}\n"
      "let f(N) = 2 N\nplot sum(i in 1..N, x[i]), i\n";
  reader r = read_text(text);
  assert_string_equal(uses_at(&r, text, "i = 3", 0), "i@6 i@108");
  assert_string_equal(uses_at(&r, text, "i in 1..N {", 0), "i@37 i@57 i@62");
  assert_string_equal(uses_at(&r, text, "N) =", 0), "N@72 N@79");
  assert_string_equal(uses_at(&r, text, "i in 1..N, x", 0), "i@90 i@103");
  pl_arena_free(r.a);
}

PL_TEST(a_mass_without_label_is_its_parameter) {
  static const char text[] = "param m1 = 1\ncoord x\nmass m1 at (x, 0)\nforce (1, 0) on m1\n";
  reader r = read_text(text);
  assert_string_equal(uses_at(&r, text, "m1 = 1", 0), "m1@6 m1@26 m1@55");
  pl_arena_free(r.a);
}

PL_TEST(a_broken_line_still_declares_and_uses) {
  static const char text[] =
      "param m = 1, l = , g = 9.81\ncoord x\nmass m at (x, 0\nconstraint c: x = = l with λ\n"
      "ask solve λ\ngravity g along -y\n";
  reader r = read_text(text);
  assert_string_equal(uses_at(&r, text, "l = ,", 0), "l@13 l@72");
  assert_string_equal(uses_at(&r, text, "g = 9", 0), "g@19 g@103");
  assert_string_equal(uses_at(&r, text, "λ\nask", 0), "λ@79 λ@92");
  pl_arena_free(r.a);
}

PL_TEST(a_comment_at_the_end_of_a_line_explains_its_names) {
  reader r = read_text("param m = 75 [kg]  # mass of the skier\ncoord x\n");
  assert_string_equal(r.o->named.at[0].comment, "mass of the skier");
  assert_null(r.o->named.at[1].comment);
  pl_arena_free(r.a);
}

PL_TEST(names_that_are_taken_or_no_names_are_refused) {
  reader r = read_text("param m1 = 1\ncoord x\n");
  const char* why[2];
  assert_true(pl_outline_name_is_free(r.o, "y", why));
  assert_true(pl_outline_name_is_free(r.o, "θ", why));
  assert_false(pl_outline_name_is_free(r.o, "m_1", why));
  assert_false(pl_outline_name_is_free(r.o, "sin", why));
  assert_false(pl_outline_name_is_free(r.o, "at", why));
  assert_false(pl_outline_name_is_free(r.o, "2x", why));
  assert_false(pl_outline_name_is_free(r.o, "a b", why));
  assert_false(pl_outline_name_is_free(r.o, "ẋ", why));
  assert_false(pl_outline_name_is_free(r.o, "", why));
  pl_arena_free(r.a);
}

// ------------------------------------------------------------------------------- completion
PL_TEST(a_line_begins_with_a_statement) {
  assert_true(offers_behind("coord x\n", "constraint"));
  assert_true(offers_behind("coord x\nco", "coord"));
  assert_false(offers_behind("coord x\nfor i in 1..3 {\n", "param"));
  assert_true(offers_behind("coord x\nfor i in 1..3 {\n", "mass"));
}

PL_TEST(the_words_of_a_statement_are_offered_where_they_fit) {
  assert_true(offers_behind("coord x\nmass 1 ", "at"));
  assert_true(offers_behind("coord x\nconstraint c: x = 0 ", "with"));
  assert_true(offers_behind("coord x\nconstraint c: x = 0, ", "redundant ok"));
  assert_true(offers_behind("coord x\nask a: ", "lagrange1"));
  assert_true(offers_behind("coord x\nevent e: when x = 0 -> ", "stop"));
  assert_true(offers_behind("coord x\nbody B: mass 1, ", "inertia"));
  assert_false(offers_behind("coord x\nmass 1 ", "with"));
}

PL_TEST(names_are_offered_where_they_can_be_meant) {
  static const char head[] = "param m = 1\ncoord x, φ\nmass A: m at (x, 0)\nconstraint c: x = 1\n";
#define HERE(rest, word) offers_behind(pl_format(a, "%s%s", head, rest), word)
  pl_arena* a = pl_arena_make(NULL);
  assert_true(HERE("mass ", "m"));
  assert_true(HERE("init ", "φ"));
  assert_true(HERE("init x = ", "sin"));
  assert_true(HERE("force (1, 0) on ", "A"));
  assert_true(HERE("ask force of ", "c"));
  assert_false(HERE("ask force of ", "A"));
  assert_true(HERE("ask pos(", "A"));
  assert_true(HERE("ask ", "E"));
  assert_false(HERE("param ", "m"));
  assert_false(HERE("param k = 2, ", "m"));
  assert_false(HERE("mass B: m at (x, x) # ", "m"));
  assert_true(HERE("axes x ", "right"));
  pl_arena_free(a);
#undef HERE
}

PL_TEST(units_are_offered_between_their_brackets) {
  assert_true(offers_behind("param m = 1 [k", "kg"));
  assert_true(offers_behind("param m [", "N"));
  assert_false(offers_behind("param m [kg] ", "N"));
}

PL_TEST(a_line_with_an_error_before_the_place_offers_what_has_a_name) {
  assert_true(offers_behind("param m = 1\ncoord x\nmass m at (x, ) + ", "m"));
}

PL_TEST(a_word_has_help) {
  static const char text[] = "coord x\nask conserved\nplot sin(x)\n";
  reader r = read_text(text);
  pl_span span;
  assert_string_equal(pl_outline_help_at(r.o, 2, PL_ENGLISH, &span),
                      "coord NAME, ...\ncoordinates: what moves");
  assert_string_equal(pl_outline_help_at(r.o, 14, PL_GERMAN, &span), "conserved\nErhaltungsgrößen");
  assert_string_equal(pl_outline_help_at(r.o, 28, PL_ENGLISH, &span), "sin(x)\nsine");
  assert_null(pl_outline_help_at(r.o, 6, PL_ENGLISH, &span));
  pl_arena_free(r.a);
}

// ---------------------------------------------------------------------------------------- laws
static char* file_text(const char* path, size_t* n) { return read_file(path, n); }

typedef void on_model(const char* name, const char* text, size_t n);

static int for_models(const char* folder, on_model* visit) {
  DIR* d = opendir(folder);
  assert_non_null(d);
  int count = 0;
  for (struct dirent* e; (e = readdir(d)) != NULL;) {
    size_t n = strlen(e->d_name);
    if (n < 8 || strcmp(e->d_name + n - 7, ".pleuel") != 0) continue;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
    size_t size = 0;
    char* text = file_text(path, &size);
    assert_non_null(text);
    visit(e->d_name, text, size);
    free(text);
    count++;
  }
  closedir(d);
  return count;
}

// What is offered at a place fits there: with the word written and a blank behind it, the line has
// no error.
static void offers_fit(const char* name, const char* text, size_t n) {
  pl_random random = {pl_hash_bytes(text, n, 7)};
  for (int trial = 0; trial < 4; trial++) {
    size_t at = (size_t)(pl_random_unit(&random) * (double)n);
    pl_arena* a = pl_arena_make(NULL);
    pl_outline* o = pl_outline_make(a, pl_source_make(a, name, text, n), NULL);
    pl_offers all = pl_outline_offer(a, o, at);
    for (int i = trial; all.fits && i < all.list.n; i += 5) {
      if (all.list.at[i].kind == PL_OFFER_UNIT) break;
      const char* with = pl_format(a, "%.*s%s ", (int)all.span.begin, text, all.list.at[i].text);
      pl_outline* then = pl_outline_make(a, pl_source_make(a, name, with, strlen(with)), NULL);
      if (!pl_outline_offer(a, then, strlen(with)).fits) {
        fail_msg("%s, byte %zu: `%s` is offered and does not fit", name, at, all.list.at[i].text);
      }
    }
    pl_arena_free(a);
  }
}

PL_TEST(what_is_offered_fits_at_random_places_of_all_examples) {
  assert_true(for_models(PL_EXAMPLES, offers_fit) >= 5);
}

// Each name of a whole model that is used is declared, so every use leads to a definition.
static void uses_lead_home(const char* name, const char* text, size_t n) {
  pl_arena* a = pl_arena_make(NULL);
  pl_outline* o = pl_outline_make(a, pl_source_make(a, name, text, n), NULL);
  for (int i = 0; i < o->classed.n; i++) {
    const pl_classed* c = &o->classed.at[i];
    if (c->class != PL_CLASS_NAME || c->use >= 0) continue;
    const char* word = pl_copy_n(a, text + c->span.begin, c->span.end - c->span.begin);
    // names that nothing declares: the time, energies, axes and their directions, things in the
    // picture, languages
    static const char* const own[] = {
        "t",     "T",      "V",      "L",      "E",      "H",         "right",   "left",
        "up",    "down",   "out",    "x",      "y",      "z",         "de",      "en",
        "force", "weight", "trail",  "axes",   "angles", "velocity",  "line",    "rod",
        "rope",  "spring", "damper", "hide",   "show",   "potential", "kinetic", "energy",
        "ok",    "rest",   "stable", "lambda", "minus",  "δm",        "λ"};
    bool known = false;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++) known |= strcmp(own[k], word) == 0;
    if (!known) fail_msg("%s, byte %u: %s leads nowhere", name, c->span.begin, word);
  }
  pl_arena_free(a);
}

PL_TEST(every_name_of_the_examples_leads_to_its_definition) {
  assert_true(for_models(PL_EXAMPLES, uses_lead_home) >= 5);
}

// Cut anywhere, a text has an outline.
static void cut_anywhere(const char* name, const char* text, size_t n) {
  for (size_t at = 0; at < n; at += 1 + n / 40) {
    pl_arena* a = pl_arena_make(NULL);
    pl_outline* o = pl_outline_make(a, pl_source_make(a, name, text, at), NULL);
    pl_outline_offer(a, o, at);
    for (int i = 0; i < o->uses.n; i++) assert_true(o->uses.at[i].span.end <= at);
    pl_arena_free(a);
  }
}

PL_TEST(a_text_that_is_cut_anywhere_has_an_outline) {
  assert_true(for_models(PL_EXAMPLES, cut_anywhere) >= 5);
  assert_true(for_models(PL_WRONG, cut_anywhere) >= 50);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_use_of_a_name_is_found_in_all_its_spellings),
      cmocka_unit_test(labels_and_values_of_one_name_are_two_names),
      cmocka_unit_test(a_multiplier_belongs_to_its_constraint),
      cmocka_unit_test(an_index_hides_what_has_its_name),
      cmocka_unit_test(a_mass_without_label_is_its_parameter),
      cmocka_unit_test(a_broken_line_still_declares_and_uses),
      cmocka_unit_test(a_comment_at_the_end_of_a_line_explains_its_names),
      cmocka_unit_test(names_that_are_taken_or_no_names_are_refused),
      cmocka_unit_test(a_line_begins_with_a_statement),
      cmocka_unit_test(the_words_of_a_statement_are_offered_where_they_fit),
      cmocka_unit_test(names_are_offered_where_they_can_be_meant),
      cmocka_unit_test(units_are_offered_between_their_brackets),
      cmocka_unit_test(a_line_with_an_error_before_the_place_offers_what_has_a_name),
      cmocka_unit_test(a_word_has_help),
      cmocka_unit_test(what_is_offered_fits_at_random_places_of_all_examples),
      cmocka_unit_test(every_name_of_the_examples_leads_to_its_definition),
      cmocka_unit_test(a_text_that_is_cut_anywhere_has_an_outline),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
