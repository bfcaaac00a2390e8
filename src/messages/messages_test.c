// The table of sentences: found, left alone, in order.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "messages/messages.h"
#include "messages/messages_table.h"

static void every_sentence_is_found(void** state) {
  (void)state;
  assert_true(pl_n_messages > 1000);
  for (size_t i = 0; i < pl_n_messages; i++)
    assert_ptr_equal(pl_german(pl_messages[i].english), pl_messages[i].german);
}

static void the_table_is_in_order(void** state) {
  (void)state;
  for (size_t i = 1; i < pl_n_messages; i++)
    assert_true(strcmp(pl_messages[i - 1].english, pl_messages[i].english) < 0);
}

static void what_is_no_sentence_stays(void** state) {
  (void)state;
  const char text[] = "no sentence of the program";
  assert_ptr_equal(pl_german(text), text);
  assert_null(pl_german(NULL));
}

static void both_languages_are_two_arguments(void** state) {
  (void)state;
  const char* words[] = {PL_BOTH("coordinates")};
  assert_int_equal(sizeof words / sizeof *words, 2);
  assert_string_equal(words[0], "coordinates");
  assert_string_equal(words[1], "Koordinaten");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_sentence_is_found),
                                     cmocka_unit_test(the_table_is_in_order),
                                     cmocka_unit_test(what_is_no_sentence_stays),
                                     cmocka_unit_test(both_languages_are_two_arguments)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
