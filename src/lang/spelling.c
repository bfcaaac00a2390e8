// Spelling of names. `m1`, `m_1`, `m₁` are one name, `theta` is `θ`, `ẋ` is `x` with one dot
// whichever way the dot was typed. The key of a name is its ASCII spelling: Greek letters as words,
// subscripts as digits, no underscore before a digit, one underscore where a Greek letter touches
// another letter. So a key can be typed, and reads back as the name.
#include "lang/lang_impl.h"

#include <string.h>

// ------------------------------------------------------------------------------------------ tables
typedef struct greek {
  uint32_t letter;
  const char* word;
} greek;
static const greek greek_letters[] = {
    // the first spelling of a word is the one that display uses
    {0x3b1, "alpha"},
    {0x3b2, "beta"},
    {0x3b3, "gamma"},
    {0x3b4, "delta"},
    {0x3b5, "epsilon"},
    {0x3b6, "zeta"},
    {0x3b7, "eta"},
    {0x3b8, "theta"},
    {0x3b9, "iota"},
    {0x3ba, "kappa"},
    {0x3bb, "lambda"},
    {0x3bc, "mu"},
    {0x3bd, "nu"},
    {0x3be, "xi"},
    {0x3c1, "rho"},
    {0x3c3, "sigma"},
    {0x3c4, "tau"},
    {0x3c5, "upsilon"},
    {0x3c6, "phi"},
    {0x3c7, "chi"},
    {0x3c8, "psi"},
    {0x3c9, "omega"},
    {0x393, "Gamma"},
    {0x394, "Delta"},
    {0x398, "Theta"},
    {0x39b, "Lambda"},
    {0x39e, "Xi"},
    {0x3a0, "Pi"},
    {0x3a3, "Sigma"},
    {0x3a6, "Phi"},
    {0x3a8, "Psi"},
    {0x3a9, "Omega"},
    // other spellings of the same words
    {0x3d1, "theta"},
    {0x3d5, "phi"},
    {0x3f5, "epsilon"},
    {0x3f1, "rho"},
    {0x3c2, "sigma"},
    {0x3f0, "kappa"},
    {0xb5, "mu"},
    {0x2126, "Omega"},
    {0x2206, "Delta"},
};
enum { N_GREEK = sizeof greek_letters / sizeof greek_letters[0] };

static const char* greek_word(uint32_t c) {
  for (int i = 0; i < N_GREEK; i++) {
    if (greek_letters[i].letter == c) return greek_letters[i].word;
  }
  return NULL;
}

static uint32_t greek_letter(const char* s, size_t n) {
  for (int i = 0; i < N_GREEK; i++) {
    if (strlen(greek_letters[i].word) == n && memcmp(greek_letters[i].word, s, n) == 0)
      return greek_letters[i].letter;
  }
  return 0;
}

// Letters that carry their dots with them, and the letter without.
typedef struct dotted {
  uint32_t whole;
  char base;
  int dots;
} dotted;
static const dotted dotted_letters[] = {
    {0x10a, 'C', 1},  {0x10b, 'c', 1},  {0x116, 'E', 1},  {0x117, 'e', 1},  {0x120, 'G', 1},
    {0x121, 'g', 1},  {0x130, 'I', 1},  {0x17b, 'Z', 1},  {0x17c, 'z', 1},  {0x226, 'A', 1},
    {0x227, 'a', 1},  {0x22e, 'O', 1},  {0x22f, 'o', 1},  {0x1e02, 'B', 1}, {0x1e03, 'b', 1},
    {0x1e0a, 'D', 1}, {0x1e0b, 'd', 1}, {0x1e1e, 'F', 1}, {0x1e1f, 'f', 1}, {0x1e22, 'H', 1},
    {0x1e23, 'h', 1}, {0x1e40, 'M', 1}, {0x1e41, 'm', 1}, {0x1e44, 'N', 1}, {0x1e45, 'n', 1},
    {0x1e56, 'P', 1}, {0x1e57, 'p', 1}, {0x1e58, 'R', 1}, {0x1e59, 'r', 1}, {0x1e60, 'S', 1},
    {0x1e61, 's', 1}, {0x1e6a, 'T', 1}, {0x1e6b, 't', 1}, {0x1e86, 'W', 1}, {0x1e87, 'w', 1},
    {0x1e8a, 'X', 1}, {0x1e8b, 'x', 1}, {0x1e8e, 'Y', 1}, {0x1e8f, 'y', 1}, {0xcb, 'E', 2},
    {0xeb, 'e', 2},   {0xcf, 'I', 2},   {0xef, 'i', 2},   {0xff, 'y', 2},   {0x178, 'Y', 2},
    {0x1e26, 'H', 2}, {0x1e27, 'h', 2}, {0x1e84, 'W', 2}, {0x1e85, 'w', 2}, {0x1e8c, 'X', 2},
    {0x1e8d, 'x', 2}, {0x1e97, 't', 2},
};
enum { N_DOTTED = sizeof dotted_letters / sizeof dotted_letters[0] };

// Umlauts are letters, not second derivatives.
typedef struct latin {
  uint32_t letter;
  const char* ascii;
  uint32_t base;
} latin;
static const latin latin_letters[] = {
    {0xe4, "ae", 'a'}, {0xf6, "oe", 'o'},  {0xfc, "ue", 'u'},  {0xc4, "Ae", 'A'}, {0xd6, "Oe", 'O'},
    {0xdc, "Ue", 'U'}, {0xdf, "ss", 0},    {0xe9, "e", 0},     {0xe8, "e", 0},    {0xea, "e", 0},
    {0xe0, "a", 0},    {0xe1, "a", 0},     {0xe2, "a", 0},     {0xe5, "aa", 0},   {0xc5, "Aa", 0},
    {0xe6, "ae", 0},   {0xf8, "oe", 0},    {0xd8, "Oe", 0},    {0xe7, "c", 0},    {0xf1, "n", 0},
    {0xf3, "o", 0},    {0xf4, "o", 0},     {0xed, "i", 0},     {0xee, "i", 0},    {0xfa, "u", 0},
    {0xfb, "u", 0},    {0x127, "hbar", 0}, {0x2113, "ell", 0},
};
enum { N_LATIN = sizeof latin_letters / sizeof latin_letters[0] };

static const latin* latin_letter(uint32_t c) {
  for (int i = 0; i < N_LATIN; i++) {
    if (latin_letters[i].letter == c) return &latin_letters[i];
  }
  return NULL;
}

// ----------------------------------------------------------------------------------------- reading
static bool is_ascii_letter(uint32_t c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
static bool is_digit(uint32_t c) { return c >= '0' && c <= '9'; }

// A letter of the name, with what it becomes in the key and on display.
typedef struct glyph {
  const char* ascii;
  char shown[5];
  bool is_greek, is_letter;
} glyph;

static bool read_glyph(pl_arena* a, uint32_t c, glyph* g) {
  *g = (glyph){0};
  g->shown[pl_utf8_encode(g->shown, c)] = 0;
  if (is_ascii_letter(c) || is_digit(c) || c == '_') {
    g->ascii = pl_copy(a, g->shown);
    g->is_letter = is_ascii_letter(c);
    return true;
  }
  g->is_letter = true;
  if ((g->ascii = greek_word(c)) != NULL) {
    g->is_greek = true;
    // look-alikes from other blocks are shown as the letter they stand for; ϑ, ϕ, ϵ stay as written
    if (c == 0xb5 || c == 0x2126 || c == 0x2206)
      g->shown[pl_utf8_encode(g->shown, greek_letter(g->ascii, strlen(g->ascii)))] = 0;
    return true;
  }
  const latin* l = latin_letter(c);
  if (l) g->ascii = l->ascii;
  else if (c >= 0xc0 && c < 0x250 && c != 0xd7 && c != 0xf7) g->ascii = pl_format(a, "u%04x", c);
  return g->ascii != NULL;
}

// Dots over the letter that was read last: the combining marks that follow it.
static uint32_t take_marks(const char* s, size_t n, size_t* at, uint32_t letter, int* dots) {
  for (uint32_t mark; *at < n;) {
    int used = pl_utf8_decode(s + *at, s + n, &mark);
    if (mark != 0x307 && mark != 0x308) return letter;
    *at += (size_t)used;
    if (mark == 0x307) {
      ++*dots;
      continue;
    }
    uint32_t umlaut = 0;
    for (int i = 0; i < N_LATIN; i++) {
      if (latin_letters[i].base == letter && letter) umlaut = latin_letters[i].letter;
    }
    if (umlaut) letter = umlaut;
    else *dots += 2;
  }
  return letter;
}

// Words such as theta become letters on display: a run of ASCII letters between digits, underscores
// or ends.
const char* pl_spell_unicode(pl_arena* a, const char* s) {
  pl_text out = pl_text_make(a);
  for (size_t i = 0; s[i];) {
    size_t n = 0;
    while (is_ascii_letter((unsigned char)s[i + n])) n++;
    bool touches = (i > 0 && ((unsigned char)s[i - 1] & 0x80)) || ((unsigned char)s[i + n] & 0x80);
    uint32_t letter = n && !touches ? greek_letter(s + i, n) : 0;
    if (letter) {
      char u[5];
      u[pl_utf8_encode(u, letter)] = 0;
      pl_text_add(&out, u);
      i += n;
    } else if (n) {
      pl_text_add_n(&out, s + i, n);
      i += n;
    } else {
      pl_text_add_n(&out, s + i, 1);
      i++;
    }
  }
  return pl_text_string(&out);
}

bool pl_spell(pl_arena* a, pl_names* names, const char* s, size_t n, pl_spelled* out, size_t* bad) {
  pl_text raw = pl_text_make(a), key = pl_text_make(a), shown = pl_text_make(a);
  *out = (pl_spelled){0};
  glyph before = {0};
  char last = 0;  // last byte of the key
  for (size_t at = 0; at < n;) {
    uint32_t c;
    *bad = at;
    int used = pl_utf8_decode(s + at, s + n, &c);
    if (used == 0) return false;
    at += (size_t)used;
    if (c >= 0x2080 && c <= 0x2089) c = '0' + (c - 0x2080);
    for (int i = 0; i < N_DOTTED; i++) {
      if (dotted_letters[i].whole != c) continue;
      c = (uint32_t)dotted_letters[i].base;
      out->dots += dotted_letters[i].dots;
      break;
    }
    c = take_marks(s, n, &at, c, &out->dots);
    if (c == 0x3b8) out->theta = true;
    if (c == 0x3d1) out->vartheta = true;
    glyph g;
    if (!read_glyph(a, c, &g)) return false;
    // m_1 is m1: the underscore before a digit goes, when a letter is before it
    if (is_digit(c) && last == '_' && key.n >= 2
        && is_ascii_letter((unsigned char)key.at[key.n - 2])) {
      key.at[--key.n] = 0;
      if (shown.n && shown.at[shown.n - 1] == '_') shown.at[--shown.n] = 0;
    }
    if (before.is_letter && g.is_letter && (before.is_greek || g.is_greek)) {
      pl_text_add(&key, "_");
      pl_text_add(&raw, "_");
    }
    pl_text_add(&key, g.ascii);
    pl_text_add(&raw, g.ascii);
    pl_text_add(&shown, g.shown);
    last = key.at[key.n - 1];
    before = g;
  }
  out->key = pl_intern(names, pl_text_string(&key));
  out->raw = pl_intern(names, pl_text_string(&raw));
  out->shown = pl_intern(names, pl_spell_unicode(a, pl_text_string(&shown)));
  return true;
}

// ------------------------------------------------------------------------------------- look-alikes
typedef struct look {
  uint32_t code;
  const char *meant, *what;
} look;
static const look looks[] = {
    {0x2013, "-", PL_KEY("an en dash")},
    {0x2014, "-", PL_KEY("an em dash")},
    {0x2010, "-", PL_KEY("a hyphen")},
    {0x2011, "-", PL_KEY("a hyphen")},
    {0xad, "", PL_KEY("an invisible hyphen")},
    {0x200b, "", PL_KEY("an invisible blank")},
    {0x200c, "", PL_KEY("an invisible character")},
    {0x200d, "", PL_KEY("an invisible character")},
    {0xfeff, "", PL_KEY("an invisible byte order mark")},
    {0x2060, "", PL_KEY("an invisible character")},
    {0x2019, "'", PL_KEY("a typographic quotation mark")},
    {0x2018, "'", PL_KEY("a typographic quotation mark")},
    {0xb4, "'", PL_KEY("an acute accent")},
    {'`', "'", PL_KEY("a grave accent")},
    {0x201c, "\"", PL_KEY("a typographic quotation mark")},
    {0x201d, "\"", PL_KEY("a typographic quotation mark")},
    {0x201e, "\"", PL_KEY("a typographic quotation mark")},
    {0xf7, "/", PL_KEY("a division sign")},
    {0x2215, "/", PL_KEY("a division slash")},
    {0x2044, "/", PL_KEY("a fraction slash")},
    {0x2026, "..", PL_KEY("an ellipsis")},
    {0x2217, "*", PL_KEY("an asterisk operator")},
    {0xba, "°", PL_KEY("an ordinal sign")},
    {0x2da, "°", PL_KEY("a ring")},
    {0x2202, NULL, PL_KEY("a partial derivative; diff(f, x) derives")},
    {0x222b, NULL, PL_KEY("an integral sign")},
    {0x3bf, "o", PL_KEY("a Greek omicron")},
    {0x391, "A", PL_KEY("a Greek Alpha")},
    {0x392, "B", PL_KEY("a Greek Beta")},
    {0x395, "E", PL_KEY("a Greek Epsilon")},
    {0x396, "Z", PL_KEY("a Greek Zeta")},
    {0x397, "H", PL_KEY("a Greek Eta")},
    {0x399, "I", PL_KEY("a Greek Iota")},
    {0x39a, "K", PL_KEY("a Greek Kappa")},
    {0x39c, "M", PL_KEY("a Greek Mu")},
    {0x39d, "N", PL_KEY("a Greek Nu")},
    {0x39f, "O", PL_KEY("a Greek Omicron")},
    {0x3a1, "P", PL_KEY("a Greek Rho")},
    {0x3a4, "T", PL_KEY("a Greek Tau")},
    {0x3a5, "Y", PL_KEY("a Greek Upsilon")},
    {0x3a7, "X", PL_KEY("a Greek Chi")},
    {0x212a, "K", PL_KEY("a Kelvin sign")},
    {0x212b, "A", PL_KEY("an Angstrom sign")},
};
enum { N_LOOKS = sizeof looks / sizeof looks[0] };

// Cyrillic letters that look Latin, in the order of their code points from 0x410 and 0x430.
static const struct {
  uint32_t code;
  char meant;
} cyrillic[] = {
    {0x410, 'A'}, {0x412, 'B'}, {0x415, 'E'}, {0x41a, 'K'}, {0x41c, 'M'}, {0x41d, 'H'},
    {0x41e, 'O'}, {0x420, 'P'}, {0x421, 'C'}, {0x422, 'T'}, {0x425, 'X'}, {0x430, 'a'},
    {0x435, 'e'}, {0x43e, 'o'}, {0x440, 'p'}, {0x441, 'c'}, {0x443, 'y'}, {0x445, 'x'},
    {0x456, 'i'}, {0x458, 'j'}, {0x455, 's'},
};

const char* pl_look_alike(uint32_t c, const char** what) {
  static const char* const ascii[] = {" ", "!", "\"", "#", "$", "%", "&", "'", "(", ")", "*",
                                      "+", ",", "-",  ".", "/", "0", "1", "2", "3", "4", "5",
                                      "6", "7", "8",  "9", ":", ";", "<", "=", ">"};
  for (int i = 0; i < N_LOOKS; i++) {
    if (looks[i].code != c) continue;
    *what = looks[i].what;
    return looks[i].meant;
  }
  for (size_t i = 0; i < sizeof cyrillic / sizeof cyrillic[0]; i++) {
    if (cyrillic[i].code != c) continue;
    static const char letters[] =
        "A\0B\0C\0D\0E\0F\0G\0H\0I\0J\0K\0L\0M\0N\0O\0P\0Q\0R\0S\0T\0U\0V\0W\0X\0Y\0Z\0"
        "a\0b\0c\0d\0e\0f\0g\0h\0i\0j\0k\0l\0m\0n\0o\0p\0q\0r\0s\0t\0u\0v\0w\0x\0y\0z";
    char m = cyrillic[i].meant;
    *what = PL_KEY("a Cyrillic letter");
    return letters + 2 * (m >= 'a' ? m - 'a' + 26 : m - 'A');
  }
  if (c >= 0xff01 && c <= 0xff1e) {
    *what = PL_KEY("a full-width character");
    return ascii[c - 0xff00];
  }
  return NULL;
}
