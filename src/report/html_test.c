// Unit tests of the HTML report: what keeps a model text from becoming markup, and what names it.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "html_impl.h"

typedef struct bench {
  pl_arena* arena;
  pl_text out;
  pl_html page;
} bench;

static int set_up(void** state) {
  pl_arena* a = pl_arena_make(NULL);
  bench* b = PL_NEW(a, bench);
  b->arena = a;
  b->out = pl_text_make(a);
  b->page = (pl_html){.out = &b->out, .arena = a, .lang = PL_GERMAN};
  *state = b;
  return 0;
}

static int tear_down(void** state) {
  pl_arena_free(((bench*)*state)->arena);
  return 0;
}

static void markup_becomes_text(void** state) {
  bench* b = *state;
  assert_string_equal(pl_html_escaped(b->arena, "<b a=\"1\" c='2'>&"),
                      "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
}

static void characters_that_steer_are_shown(void** state) {
  bench* b = *state;
  assert_string_equal(pl_html_escaped(b->arena,
                                      "a\xE2\x80\xAE"
                                      "b\x01"),
                      "a⟨U+202E⟩b⟨U+0001⟩");
  assert_string_equal(pl_html_escaped(b->arena, "\xEF\xBF\xBE"), "⟨U+FFFE⟩");
}

static void bytes_that_are_no_text_are_replaced(void** state) {
  bench* b = *state;
  assert_string_equal(pl_html_escaped(b->arena,
                                      "a\xFF"
                                      "b"),
                      "a\xEF\xBF\xBD"
                      "b");
}

static void no_json_ends_its_script(void** state) {
  bench* b = *state;
  pl_html_json_string(&b->page, "</script><!-- & \" \\ \xE2\x80\xA8");
  const char* s = pl_text_string(&b->out);
  assert_null(strpbrk(s, "<>&"));
  assert_string_equal(s, "\"\\u003c/script\\u003e\\u003c!-- \\u0026 \\u0022 \\u005c \\u2028\"");
}

static void random_text_never_opens_a_tag(void** state) {
  bench* b = *state;
  pl_random r = {20261121};
  for (int i = 0; i < 300; i++) {
    char s[40];
    int n = (int)(pl_random_bits(&r) % 39);
    for (int k = 0; k < n; k++) s[k] = (char)(1 + pl_random_bits(&r) % 255);
    s[n] = '\0';
    const char* out = pl_html_escaped(b->arena, s);
    if (strpbrk(out, "<>\"'")) fail_msg("seed 20261121, text %d: %s", i, out);
    for (const char* c = out; *c;) {
      uint32_t code;
      int taken = pl_utf8_decode(c, out + strlen(out), &code);
      assert_true(taken > 0);
      c += taken;
    }
  }
}

static void the_hash_is_sha_256(void** state) {
  bench* b = *state;
  unsigned char h[32];
  pl_sha256(h, "abc", 3);
  assert_string_equal(pl_hex_text(b->arena, h, 32),
                      "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  pl_sha256(h, "", 0);
  assert_string_equal(pl_hex_text(b->arena, h, 32),
                      "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  // FIPS 180-4: two blocks
  const char* two = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
  pl_sha256(h, two, strlen(two));
  assert_string_equal(pl_hex_text(b->arena, h, 32),
                      "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

static void base64_is_that_of_the_standard(void** state) {
  bench* b = *state;
  static const char* const pairs[][2] = {
      {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"foobar", "Zm9vYmFy"}};
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
    pl_text t = pl_text_make(b->arena);
    pl_base64_add(&t, pairs[i][0], strlen(pairs[i][0]));
    assert_string_equal(pl_text_string(&t), pairs[i][1]);
  }
}

static void quantities_read_as_in_the_language(void** state) {
  bench* b = *state;
  assert_string_equal(pl_html_quantity(&b->page, -1.5, "m/s", 4), "−1,5\u00A0m/s");
  assert_string_equal(pl_html_quantity(&b->page, 0.8410686705679303, "rad", 6), "48,1897°");
  assert_string_equal(pl_html_quantity(&b->page, 2, "1", 6), "2");
}

#define BENCH_TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
  const struct CMUnitTest tests[] = {
      BENCH_TEST(markup_becomes_text),
      BENCH_TEST(characters_that_steer_are_shown),
      BENCH_TEST(bytes_that_are_no_text_are_replaced),
      BENCH_TEST(no_json_ends_its_script),
      BENCH_TEST(random_text_never_opens_a_tag),
      BENCH_TEST(the_hash_is_sha_256),
      BENCH_TEST(base64_is_that_of_the_standard),
      BENCH_TEST(quantities_read_as_in_the_language),
  };
  return cmocka_run_group_tests_name("html", tests, NULL, NULL);
}
