// The formatter: idempotent, keeps comments, changes no meaning; and the law that what is printed
// parses back.
#include "lang_testing.h"

#include <dirent.h>
#include <time.h>

static const char* formatted(bench* b, const char* text, pl_spelling spelling) {
  const char* out = NULL;
  pleuel_status s = pl_lang_format(&b->job, pl_source_make(b->arena, "f", text, strlen(text)),
                                   spelling, &out);
  return s == PLEUEL_OK ? out : NULL;
}

static void becomes(const char* text, pl_spelling spelling, const char* want) {
  bench* b = bench_make();
  const char* got = formatted(b, text, spelling);
  assert_non_null(got);
  assert_string_equal(got, want);
  assert_string_equal(formatted(b, got, spelling), want);
  bench_free(b);
}

static void layout_is_canonical(void** state) {
  (void)state;
  becomes("param   m=1[kg] ,l = 2\ncoord x,y", PL_SPELL_KEEP,
          "param m = 1 [kg], l = 2\ncoord x, y\n");
  becomes("\n\n#a\n\n\n\ncoord x # b\nparam long = 1  #c\n\n", PL_SPELL_KEEP,
          "# a\n\ncoord x         # b\nparam long = 1  # c\n");
  becomes("for i in 1 .. N {mass P[ i ]:m at (x[ i - 1 ],-a)}\n", PL_SPELL_KEEP,
          "for i in 1..N {\n    mass P[i]: m at (x[i-1], -a)\n}\n");
  becomes("let a = ( 1\n+ 2 ) * 3 # c\n", PL_SPELL_KEEP, "let a = (1\n    + 2)*3  # c\n");
  becomes("potential  m g( x+l )-1 / 2 k x ^ 2\n", PL_SPELL_KEEP,
          "potential m g(x + l) - 1/2 k x^2\n");
  becomes("ask b :dof ,limit m->0 of x''\n", PL_SPELL_KEEP, "ask b: dof, limit m -> 0 of x''\n");
  becomes("gravity g along - y\nplot - x vs t\n", PL_SPELL_KEEP,
          "gravity g along -y\nplot -x vs t\n");
  becomes("convention  lambda-minus ,right-handed\n", PL_SPELL_KEEP,
          "convention lambda-minus, right-handed\n");
  becomes("#: printed\ncoord x  #: too\n", PL_SPELL_KEEP, "#: printed\ncoord x  #: too\n");
}

static void spellings_can_be_chosen(void** state) {
  (void)state;
  becomes("init ϑ̇ = 2π R·x″, m₁ = √2 ≥ 3²\n", PL_SPELL_ASCII,
          "init theta' = 2pi R*x'', m1 = sqrt 2 >= 3^2\n");
  becomes("init theta' = 2 pi, m_1 = 90°, ẋ[i] = 1\n", PL_SPELL_UNICODE,
          "init θ' = 2 π, m_1 = 90°, x[i]' = 1\n");
  becomes("init φ = 90°, ẋ[i] = 3 [m²/s·°]\n", PL_SPELL_ASCII,
          "init phi = 90 [deg], x[i]' = 3 [m^2/s*deg]\n");
  becomes("param λ_1, lambda_2\n", PL_SPELL_UNICODE, "param λ_1, λ_2\n");
  becomes("plot sin²φ, πR vs t\n", PL_SPELL_ASCII, "plot sin^2 phi, pi R vs t\n");
}

// The same model, told by its dump.
static const char* meaning(bench* b, const char* text) {
  pl_model* m;
  int before = b->diagnostics.n_errors;
  pl_lang_parse(&b->job, pl_source_make(b->arena, "m", text, strlen(text)), NULL, NULL, 0, &m);
  pl_text t = pl_text_make(b->arena);
  pl_model_dump(&t, m);
  pl_text_addf(&t, "errors: %d\n", b->diagnostics.n_errors - before);
  return pl_text_string(&t);
}

// Requests are kept as written, so their spelling may differ.
static const char* without_requests(bench* b, const char* dump) {
  pl_text t = pl_text_make(b->arena);
  for (const char* s = dump; *s;) {
    size_t n = strcspn(s, "\n");
    bool request = strncmp(s, "ask ", 4) == 0 || strncmp(s, "plot ", 5) == 0
                   || strncmp(s, "system", 6) == 0;
    if (!request) pl_text_add_n(&t, s, n + (s[n] != 0));
    s += n + (s[n] != 0);
  }
  return pl_text_string(&t);
}

static void check_file(const char* path) {
  size_t n = 0;
  char* text = read_file(path, &n);
  assert_non_null(text);
  bench* b = bench_make();
  for (int spelling = 0; spelling < 3 && strlen(text) == n; spelling++) {
    const char* once = formatted(b, text, (pl_spelling)spelling);
    if (once == NULL) break;  // a file with syntax errors is left alone
    const char* twice = formatted(b, once, (pl_spelling)spelling);
    if (!twice || strcmp(once, twice) != 0) print_message("%s, spelling %d\n", path, spelling);
    assert_non_null(twice);
    assert_string_equal(once, twice);
    // a text with other errors may have them for its spelling: θ and ϑ are one in ASCII
    if (spelling != PL_SPELL_KEEP && strstr(meaning(b, text), "errors: 0") == NULL) continue;
    const char *before = without_requests(b, meaning(b, text)),
               *after = without_requests(b, meaning(b, once));
    if (strcmp(before, after) != 0) print_message("%s, spelling %d\n%s", path, spelling, once);
    assert_string_equal(before, after);
  }
  bench_free(b);
  free(text);
}

static void check_folder(const char* folder) {
  DIR* d = opendir(folder);
  assert_non_null(d);
  int n = 0;
  for (struct dirent* e; (e = readdir(d)) != NULL;) {
    const char* dot = strrchr(e->d_name, '.');
    if (!dot || strcmp(dot, ".pleuel") != 0) continue;
    char path[2000];
    snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
    check_file(path);
    n++;
  }
  closedir(d);
  assert_true(n >= 8);
}

static void formatting_twice_is_formatting_once_and_keeps_the_meaning(void** state) {
  (void)state;
  check_folder(PL_EXAMPLES);
  check_folder(PL_WRONG);
}

// ----------------------------------------------------------------------------- parse(print(e)) = e
static pl_expr random_expression(pl_random* r, pl_pool* p, const pl_expr* leaves, int n_leaves,
                                 int depth) {
  int pick = (int)(pl_random_bits(r) % (depth <= 0 ? 2 : 9));
  if (pick == 0) return leaves[pl_random_bits(r) % (unsigned)n_leaves];
  if (pick == 1)
    return pl_ratio(p, (long)(pl_random_bits(r) % 19) - 9, 1 + (long)(pl_random_bits(r) % 5));
  pl_expr a = random_expression(r, p, leaves, n_leaves, depth - 1);
  if (pick == 2) {
    static const pl_function functions[] = {PL_SIN, PL_COS, PL_TAN, PL_SINH,
                                            PL_EXP, PL_LN,  PL_ABS, PL_TANH};
    return pl_call(p, functions[pl_random_bits(r) % 8], a);
  }
  if (pick == 3) return pl_pow_int(p, a, (long)(pl_random_bits(r) % 5) - 2);
  if (pick == 4) return pl_sqrt(p, a);
  pl_expr b = random_expression(r, p, leaves, n_leaves, depth - 1);
  if (pick == 5) return pl_add(p, a, b);
  if (pick == 6) return pl_mul(p, a, b);
  if (pick == 7) return pl_div(p, a, b);
  return pl_sub(p, a, b);
}

static uint64_t seed_of_this_run(void) {
  const char* given = getenv("PL_SEED");
  return given ? strtoull(given, NULL, 0) : (uint64_t)time(NULL);
}

static void what_is_printed_parses_back(void** state) {
  (void)state;
  uint64_t seed = seed_of_this_run();
  print_message("PL_SEED=%llu\n", (unsigned long long)seed);
  pl_random r = {seed};
  bench* b = bench_text(
      "param m1, g, θ0, δ_m\ncoord x, θ, q[1..9]\nfor i in 1..9 {\n  mass P[i]: m1 at (q[i], "
      "0)\n}\nconstraint c: x = "
      "0\n");
  assert_int_equal(b->status, PLEUEL_OK);
  pl_pool* p = b->m->pool;
  static const char* const names[] = {"m1",   "g",       "θ0",  "δ_m", "x", "θ'",   "x''",
                                      "q[2]", "q[i-1]'", "λ_c", "t",   "π", "x(0)", "θ'(0)"};
  enum { N = sizeof names / sizeof names[0] };
  pl_expr leaves[N];
  for (int i = 0; i < N; i++) {
    if (pl_lang_expression(&b->job, b->m, names[i], &leaves[i]) != PLEUEL_OK)
      print_message("%s: %s\n", names[i], bench_said(b));
    assert_false(pl_is_poison(leaves[i]));
  }
  for (int k = 0; k < 400; k++) {
    pl_expr e = random_expression(&r, p, leaves, N, 5), back;
    if (pl_is_poison(e)) continue;
    const char* text = pl_expr_text(b->arena, p, e);
    pleuel_status s = pl_lang_expression(&b->job, b->m, text, &back);
    if (s != PLEUEL_OK || !pl_same(e, back)) {
      print_message("%s\n  read as %s\n  %s\n", text,
                    s == PLEUEL_OK ? pl_expr_text(b->arena, p, back) : "nothing", bench_said(b));
    }
    assert_int_equal(s, PLEUEL_OK);
    assert_true(pl_same(e, back));
    // through the formatter too, in both spellings
    for (int spelling = 1; spelling < 3; spelling++) {
      const char* line = formatted(b, pl_format(b->arena, "potential %s\n", text),
                                   (pl_spelling)spelling);
      assert_non_null(line);
      s = pl_lang_expression(&b->job, b->m, line + strlen("potential "), &back);
      if (s != PLEUEL_OK) print_message("%s\n%s%s\n", text, line, bench_said(b));
      assert_int_equal(s, PLEUEL_OK);
      if (!pl_same(e, back)) print_message("%s\n%s\n", text, line);
      assert_true(pl_same(e, back));
    }
  }
  bench_free(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(layout_is_canonical),
      cmocka_unit_test(spellings_can_be_chosen),
      cmocka_unit_test(formatting_twice_is_formatting_once_and_keeps_the_meaning),
      cmocka_unit_test(what_is_printed_parses_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
