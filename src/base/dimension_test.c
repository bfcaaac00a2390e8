// Dimensions: arithmetic, units as text, words.
#include "base/base_test_kit.h"

PL_TEST(dimensions_form_a_group) {
  pl_random r = {9};
  for (int i = 0; i < 500; i++) {
    pl_dimension x = pl_dimension_of((int)(pl_random_bits(&r) % 7) - 3,
                                     (int)(pl_random_bits(&r) % 5) - 2,
                                     (int)(pl_random_bits(&r) % 9) - 4);
    pl_dimension y = pl_dimension_pow(x, (int)(pl_random_bits(&r) % 7) - 3,
                                      1 + (int)(pl_random_bits(&r) % 3));
    assert_true(pl_dimension_equal(pl_dimension_div(pl_dimension_mul(x, y), y), x));
    assert_true(pl_dimension_equal(pl_dimension_pow(pl_dimension_pow(y, 2, 3), 3, 2), y));
    assert_true(
        pl_dimension_equal(pl_dimension_mul(x, pl_dimension_pow(x, -1, 1)), pl_dimension_one()));
    assert_true(pl_dimension_equal(pl_dimension_mul(y, y), pl_dimension_pow(y, 2, 1)));
  }
}

PL_TEST(units_prefer_names) {
  struct {
    int m, kg, s;
    const char *unit, *ascii;
  } cases[] = {{1, 1, -2, "N", "N"},
               {2, 1, -2, "J", "J"},
               {2, 1, -3, "W", "W"},
               {-1, 1, -2, "Pa", "Pa"},
               {0, 0, 0, "1", "1"},
               {1, 0, -2, "m/s²", "m/s^2"},
               {0, 0, -1, "1/s", "1/s"},
               {0, 1, -1, "kg/s", "kg/s"},
               {1, 1, -1, "kg m/s", "kg m/s"},
               {0, 1, -2, "N/m", "N/m"},
               {2, 1, 0, "kg m²", "kg m^2"},
               {-1, 1, -1, "kg/(m s)", "kg/(m s)"},
               {-12, 0, 0, "1/m¹²", "1/m^12"},
               {3, 0, 2, "m³ s²", "m^3 s^2"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    pl_dimension d = pl_dimension_of(cases[i].m, cases[i].kg, cases[i].s);
    assert_string_equal(pl_dimension_unit(a, d, false), cases[i].unit);
    assert_string_equal(pl_dimension_unit(a, d, true), cases[i].ascii);
  }
  assert_string_equal(pl_dimension_unit(a, pl_dimension_pow(pl_dimension_of(1, 0, 0), 1, 2), false),
                      "m^(1/2)");
}

PL_TEST(words_say_what_it_is) {
  assert_string_equal(pl_dimension_words(a, pl_dimension_of(1, 0, 0), PL_ENGLISH), "a length");
  assert_string_equal(pl_dimension_words(a, pl_dimension_of(1, 0, -2), PL_GERMAN),
                      "eine Beschleunigung");
  assert_string_equal(pl_dimension_words(a, pl_dimension_of(0, 1, -1), PL_ENGLISH),
                      "a quantity in kg/s");
  assert_string_equal(pl_dimension_words(a, pl_dimension_of(0, 1, -1), PL_GERMAN),
                      "eine Größe in kg/s");
}

PL_TEST(absurd_exponents_stay_in_range) {
  pl_dimension d = pl_dimension_pow(pl_dimension_of(3, 0, 0), 1000000000, 1);
  assert_int_equal(d.num[0], 127);
  assert_true(pl_dimension_equal(pl_dimension_pow(d, 1, 0), pl_dimension_one()));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dimensions_form_a_group),
      cmocka_unit_test(units_prefer_names),
      cmocka_unit_test(words_say_what_it_is),
      cmocka_unit_test(absurd_exponents_stay_in_range),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
