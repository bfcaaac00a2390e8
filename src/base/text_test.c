// Text, UTF-8, names, maps, random numbers.
#include "base/base_test_kit.h"

PL_TEST(a_text_grows_piece_by_piece) {
  pl_text t = pl_text_make(a);
  assert_string_equal(pl_text_string(&t), "");
  for (int i = 0; i < 1000; i++) pl_text_addf(&t, "%d,", i);
  pl_text_pad(&t, 3);
  pl_text_pad(&t, -3);
  pl_text_add_n(&t, "xyz", 2);
  assert_int_equal(t.n, 10 * 2 + 90 * 3 + 900 * 4 + 3 + 2);
  assert_int_equal(strlen(pl_text_string(&t)), t.n);
  assert_string_equal(pl_text_string(&t) + t.n - 9, "999,   xy");
  assert_string_equal(pl_format(a, "%s-%d", "a", 5), "a-5");
}

PL_TEST(every_code_point_survives_utf8) {
  for (uint32_t c = 1; c < 0x110000; c += c < 0x3000 ? 1 : 97) {
    if (c >= 0xd800 && c <= 0xdfff) continue;
    char s[4];
    uint32_t back = 0;
    int n = pl_utf8_encode(s, c);
    assert_int_equal(pl_utf8_decode(s, s + n, &back), n);
    assert_int_equal(back, c);
    assert_int_equal(pl_utf8_decode(s, s + n - 1, &back), 0);
  }
}

PL_TEST(malformed_utf8_is_refused) {
  const char* bad[] = {"\x80", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                       "\xff", "\xc3(",    "\xf0\x9f\x98"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    uint32_t c;
    assert_int_equal(pl_utf8_decode(bad[i], bad[i] + strlen(bad[i]), &c), 0);
  }
}

PL_TEST(width_counts_cells) {
  assert_int_equal(pl_utf8_width("m1"), 2);
  assert_int_equal(pl_utf8_width("ϑ² ≥ λ"), 6);
  assert_int_equal(pl_utf8_width("x\xcc\x87"), 1);     // x with a combining dot
  assert_int_equal(pl_utf8_width("\xe6\xbc\xa2"), 2);  // a wide character
  assert_int_equal(pl_utf8_width("a\x80z"), 3);
}

PL_TEST(edit_distance_knows_exchanged_letters) {
  assert_int_equal(pl_edit_distance("theta", "theta", 3), 0);
  assert_int_equal(pl_edit_distance("thtea", "theta", 3), 1);
  assert_int_equal(pl_edit_distance("x3", "x2", 3), 1);
  assert_int_equal(pl_edit_distance("ϑ", "θ", 3), 1);
  assert_int_equal(pl_edit_distance("", "abc", 5), 3);
  assert_int_equal(pl_edit_distance("kitten", "sitting", 5), 3);
  assert_int_equal(pl_edit_distance("gravity", "potential", 2), 3);
  char longer[200];
  memset(longer, 'a', sizeof longer);
  longer[199] = '\0';
  assert_int_equal(pl_edit_distance(longer, "a", 2), 3);
}

PL_TEST(equal_text_is_one_name) {
  pl_names* names = pl_names_make(a);
  const char* kept[2000];
  for (int i = 0; i < 2000; i++) kept[i] = pl_intern(names, pl_format(a, "name%d", i));
  for (int i = 0; i < 2000; i++) {
    assert_ptr_equal(pl_intern(names, pl_format(a, "name%d", i)), kept[i]);
    assert_string_equal(kept[i], pl_format(a, "name%d", i));
  }
  assert_ptr_equal(pl_intern_n(names, "name7 and more", 5), kept[7]);
  assert_ptr_not_equal(pl_intern_n(names, "name\0x", 6), pl_intern(names, "name"));
}

PL_TEST(a_map_holds_what_was_set_last) {
  pl_map* m = pl_map_make(a);
  pl_random r = {3};
  uint64_t keys[3000];
  for (int i = 0; i < 3000; i++) keys[i] = i < 2 ? (uint64_t)i - 1 : pl_random_bits(&r);
  for (int i = 0; i < 3000; i++) pl_map_set(m, keys[i], (uint64_t)i + 1);
  for (int i = 0; i < 3000; i++) assert_int_equal(pl_map_get(m, keys[i]), i + 1);
  assert_int_equal(pl_map_get(m, 12345), 0);
  assert_int_equal(pl_map_count(m), 3000);
  pl_map_set(m, keys[5], 0);
  pl_map_set(m, keys[6], 99);
  assert_int_equal(pl_map_count(m), 2999);
  assert_int_equal(pl_map_get(m, keys[6]), 99);
}

PL_TEST(random_numbers_repeat_with_their_seed) {
  pl_random r = {42}, s = {42};
  double sum = 0;
  for (int i = 0; i < 10000; i++) {
    double x = pl_random_between(&r, -1, 3);
    assert_true(x >= -1 && x < 3 && x == pl_random_between(&s, -1, 3));
    sum += x;
  }
  assert_true(sum > 9000 && sum < 11000);
  pl_random first = {0};
  assert_true(pl_random_bits(&first) == 0xe220a8397b1dcdafull);  // reference value of splitmix64
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_text_grows_piece_by_piece),
      cmocka_unit_test(every_code_point_survives_utf8),
      cmocka_unit_test(malformed_utf8_is_refused),
      cmocka_unit_test(width_counts_cells),
      cmocka_unit_test(edit_distance_knows_exchanged_letters),
      cmocka_unit_test(equal_text_is_one_name),
      cmocka_unit_test(a_map_holds_what_was_set_last),
      cmocka_unit_test(random_numbers_repeat_with_their_seed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
