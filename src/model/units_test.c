// Units: what is read, what is refused, and what is suggested instead.
#include "model/model_test_kit.h"

static void reads(const char* text, const char* scale, const char* si) {
  kit* k = kit_make(NULL);
  pl_unit u = {0};
  size_t at_bad = 0, n_bad = 0;
  const char* near = NULL;
  bool ok = pl_unit_parse(k->m->pool, text, strlen(text), &u, &at_bad, &n_bad, &near);
  if (!ok) print_message("%s refused at %zu (%zu)\n", text, at_bad, n_bad);
  assert_true(ok);
  assert_string_equal(pl_expr_text(k->arena, k->m->pool, u.scale), scale);
  assert_string_equal(pl_dimension_unit(k->arena, u.dimension, true), si);
  assert_true(pl_same(pl_unit_to_si(k->m->pool, u.factor), u.scale));
  kit_free(k);
}

static void refuses(const char* text, const char* bad, const char* near) {
  kit* k = kit_make(NULL);
  pl_unit u;
  size_t at_bad = 99, n_bad = 99;
  const char* found = NULL;
  assert_false(pl_unit_parse(k->m->pool, text, strlen(text), &u, &at_bad, &n_bad, &found));
  assert_true(at_bad + n_bad <= strlen(text));
  if (bad) {
    assert_int_equal(n_bad, strlen(bad));
    assert_memory_equal(text + at_bad, bad, n_bad);
  }
  if (near) {
    assert_non_null(found);
    assert_string_equal(found, near);
  } else {
    assert_null(found);
  }
  kit_free(k);
}

PL_TEST(base_and_derived_units_are_read) {
  reads("m", "1", "m");
  reads("kg", "1", "kg");
  reads("N", "1", "N");
  reads("J", "1", "J");
  reads("Hz", "1", "1/s");
  reads("N/m", "1", "N/m");
}

PL_TEST(prefixes_scale_exactly) {
  reads("mm", "1/1000", "m");
  reads("km", "1000", "m");
  reads("g", "1/1000", "kg");
  reads("mg", "1/1000000", "kg");
  reads("kN", "1000", "N");
  reads("µm", "1/1000000", "m");
  reads("μm", "1/1000000", "m");
  reads("um", "1/1000000", "m");
}

PL_TEST(a_symbol_wins_over_a_prefix) {
  reads("min", "60", "s");
  reads("cd", "1", "cd");
  reads("ft", "381/1250", "m");
  reads("mol", "1", "mol");
  reads("T", "1", "T");
}

PL_TEST(products_quotients_and_powers_are_read) {
  reads("m/s^2", "1", "m/s^2");
  reads("m/s²", "1", "m/s^2");
  reads("m s^-2", "1", "m/s^2");
  reads("m s⁻²", "1", "m/s^2");
  reads("kN m", "1000", "J");
  reads("kg*m/s^2", "1", "N");
  reads("kg·m/s²", "1", "N");
  reads("kg m^2 s^(-2)", "1", "J");
  reads("J/(kg K)", "1", "m^2/(s^2 K)");
  reads("1/min", "1/60", "1/s");
  reads("km/h", "5/18", "m/s");
  reads("kmh", "5/18", "m/s");
  reads("m^(1/2)", "1", "m^(1/2)");
  reads(" m / s ", "1", "m/s");
}

PL_TEST(angles_are_pure_numbers) {
  reads("rad", "1", "1");
  reads("deg", "pi/180", "1");
  reads("°", "pi/180", "1");
  reads("rad/s", "1", "1/s");
  reads("rpm", "pi/30", "1/s");
  reads("deg/s", "pi/180", "1/s");
  kit* k = kit_make(NULL);
  assert_true(unit_of(k, "deg").is_angle);
  assert_true(unit_of(k, "rad").is_angle);
  assert_false(unit_of(k, "rad/s").is_angle);
  assert_false(unit_of(k, "m").is_angle);
  assert_false(unit_of(k, "%").is_angle);
  kit_free(k);
}

PL_TEST(technical_units_are_exact) {
  reads("bar", "100000", "Pa");
  reads("atm", "101325", "Pa");
  reads("eV", "801088317/5000000000000000000000000000", "J");
  reads("t", "1000", "kg");
  reads("l", "1/1000", "m^3");
  reads("L", "1/1000", "m^3");
  reads("Nm", "1", "J");
  reads("h", "3600", "s");
  reads("d", "86400", "s");
}

PL_TEST(a_wrong_unit_is_shown_with_the_nearest) {
  refuses("sec", "sec", "s");
  refuses("Kg", "Kg", "kg");
  refuses("m/sec", "sec", "s");
  refuses("meter", "meter", "m");
  refuses("Newton", "Newton", "N");
  refuses("RPM", "RPM", "rpm");
  refuses("KN", "KN", "kN");
  refuses("furlong", "furlong", NULL);
  refuses("m2", "m2", "m^2");
  refuses("kg m2", "m2", "m^2");
}

PL_TEST(a_product_after_a_division_is_refused) {
  refuses("J/kg K", "kg K", "(kg K)");
  refuses("m/s*s", "s*s", "(s*s)");
  reads("m/s/s", "1", "m/s^2");
}

PL_TEST(broken_text_is_refused) {
  refuses("", "", NULL);
  refuses("m/", "", NULL);
  refuses("m^", "", NULL);
  refuses("(m", NULL, NULL);
  refuses("m)", ")", NULL);
  refuses("m^1000", "1000", NULL);
  refuses("m^99999999999999999999", "99999999999999999999", NULL);
  refuses("0 m", "0", NULL);
  refuses("1..2", "1..2", NULL);
  refuses("m $", "$", NULL);
  refuses("\xff", "\xff", NULL);
  refuses("m^(1/0)", NULL, NULL);
}

PL_TEST(deep_brackets_are_refused_without_a_crash) {
  char text[4001];
  memset(text, '(', 4000);
  text[4000] = 0;
  refuses(text, NULL, NULL);
}

// Every row stands for itself, and its inverse undoes it.
PL_TEST(every_row_has_an_inverse) {
  static const char* const rows[] = {
#define PL_UNIT(name, words, factor, pi, m, kg, s, A, K, mol, cd, prefixed) name,
#define PL_UNIT_WORD(word, unit)
#include "units/units.def"
#undef PL_UNIT
#undef PL_UNIT_WORD
  };
  kit* k = kit_make(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    pl_unit u = unit_of(k, rows[i]);
    pl_unit v = unit_of(k, pl_format(k->arena, "1/%s", rows[i]));
    assert_true(pl_is_one_node(k->m->pool, pl_mul(k->m->pool, u.factor, v.factor)));
    for (size_t j = 0; j < i; j++) assert_string_not_equal(rows[i], rows[j]);
  }
  kit_free(k);
}

PL_TEST(of_units_equally_near_the_one_of_every_day_is_meant) {
  kit* k = kit_make(NULL);
  assert_string_equal(pl_unit_near(k->arena, "kq", 2), "kg");
  kit_free(k);
}

PL_TEST(every_word_leads_to_a_unit) {
  static const char* const words[][2] = {
#define PL_UNIT(name, words, factor, pi, m, kg, s, A, K, mol, cd, prefixed)
#define PL_UNIT_WORD(word, unit) {word, unit},
#include "units/units.def"
#undef PL_UNIT
#undef PL_UNIT_WORD
  };
  kit* k = kit_make(NULL);
  for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
    unit_of(k, words[i][1]);
    pl_unit u;
    assert_string_equal(pl_unit_near(k->arena, words[i][0], strlen(words[i][0])), words[i][1]);
    if (strchr(words[i][0], '/') == NULL)
      assert_false(
          pl_unit_parse(k->m->pool, words[i][0], strlen(words[i][0]), &u, NULL, NULL, NULL));
  }
  kit_free(k);
}

// Random text never crashes, and what is refused is shown inside the text.
PL_TEST(random_text_is_read_or_refused) {
  static const char* const parts[] = {"m",  "kg", "s",    "/",   "*",  " ",   "^", "2",
                                      "-1", "(",  ")",    "²",   "·",  "deg", "k", "0.5",
                                      "°",  "x",  "\xc3", "1/2", "⁻¹", "."};
  const uint64_t seed = 20261121;
  pl_random r = {seed};
  for (int round = 0; round < 3000; round++) {
    kit* k = kit_make(NULL);
    char text[200] = "";
    int n = (int)(pl_random_bits(&r) % 12);
    for (int i = 0; i < n; i++)
      strcat(text, parts[pl_random_bits(&r) % (sizeof parts / sizeof parts[0])]);
    pl_unit u;
    size_t at_bad = 0, n_bad = 0;
    const char* near = NULL;
    if (!pl_unit_parse(k->m->pool, text, strlen(text), &u, &at_bad, &n_bad, &near)
        && at_bad + n_bad > strlen(text)) {
      fail_msg("seed %lu round %d: '%s' blames bytes %zu+%zu", (unsigned long)seed, round, text,
               at_bad, n_bad);
    }
    kit_free(k);
  }
}

PL_TEST(a_unit_is_explained) {
  kit* k = kit_make(NULL);
  const char* text = pl_unit_explain(k->arena, k->m->pool, "km/h", PL_ENGLISH);
  assert_non_null(strstr(text, "a velocity"));
  assert_non_null(strstr(text, "5/18 m/s"));
  text = pl_unit_explain(k->arena, k->m->pool, "km/h", PL_GERMAN);
  assert_non_null(strstr(text, "eine Geschwindigkeit"));
  text = pl_unit_explain(k->arena, k->m->pool, "m/sec", PL_ENGLISH);
  assert_non_null(strstr(text, "not a unit"));
  assert_non_null(strstr(text, "m/s"));
  kit_free(k);
}

PL_TEST(units_vanish_from_an_expression) {
  kit* k = kit_make(NULL);
  pl_expr e = num(k, "9.81", "m/s^2");
  assert_true(pl_unit_occurs(k->m->pool, e));
  pl_expr plain = pl_unit_to_si(k->m->pool, e);
  assert_false(pl_unit_occurs(k->m->pool, plain));
  assert_true(pl_same(plain, pl_ratio(k->m->pool, 981, 100)));
  kit_free(k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(base_and_derived_units_are_read),
      cmocka_unit_test(prefixes_scale_exactly),
      cmocka_unit_test(a_symbol_wins_over_a_prefix),
      cmocka_unit_test(products_quotients_and_powers_are_read),
      cmocka_unit_test(angles_are_pure_numbers),
      cmocka_unit_test(technical_units_are_exact),
      cmocka_unit_test(a_wrong_unit_is_shown_with_the_nearest),
      cmocka_unit_test(a_product_after_a_division_is_refused),
      cmocka_unit_test(broken_text_is_refused),
      cmocka_unit_test(deep_brackets_are_refused_without_a_crash),
      cmocka_unit_test(every_row_has_an_inverse),
      cmocka_unit_test(of_units_equally_near_the_one_of_every_day_is_meant),
      cmocka_unit_test(every_word_leads_to_a_unit),
      cmocka_unit_test(random_text_is_read_or_refused),
      cmocka_unit_test(a_unit_is_explained),
      cmocka_unit_test(units_vanish_from_an_expression),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
