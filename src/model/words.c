// Names and sides found again in the text of a statement. Expressions are sorted by their
// constructors and no longer know where they stood; a message wants to point at the very name, so
// it is looked up in the text of the statement.
#include "model_impl.h"

#include <string.h>

// ---------------------------------------------------------------------------------------- spelling
typedef struct greek_letter {
  const char* letter;
  const char* name;
} greek_letter;
static const greek_letter greek[] = {
    {"α", "alpha"},   {"β", "beta"},    {"γ", "gamma"}, {"δ", "delta"}, {"ε", "epsilon"},
    {"ζ", "zeta"},    {"η", "eta"},     {"θ", "theta"}, {"ϑ", "theta"}, {"ι", "iota"},
    {"κ", "kappa"},   {"λ", "lambda"},  {"μ", "mu"},    {"ν", "nu"},    {"ξ", "xi"},
    {"ο", "omicron"}, {"π", "pi"},      {"ρ", "rho"},   {"σ", "sigma"}, {"ς", "sigma"},
    {"τ", "tau"},     {"υ", "upsilon"}, {"φ", "phi"},   {"ϕ", "phi"},   {"χ", "chi"},
    {"ψ", "psi"},     {"ω", "omega"},   {"Γ", "Gamma"}, {"Δ", "Delta"}, {"Θ", "Theta"},
    {"Λ", "Lambda"},  {"Ξ", "Xi"},      {"Π", "Pi"},    {"Σ", "Sigma"}, {"Φ", "Phi"},
    {"Ψ", "Psi"},     {"Ω", "Omega"},
};
static const char* const subscripts[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};

// One letter of a name: bytes taken, and its spelling in ASCII in *out.  0: no letter of a name.
static int name_letter(const char* s, const char* end, const char** out, char one[2]) {
  unsigned char c = (unsigned char)*s;
  *out = one;
  one[0] = (char)c;
  one[1] = 0;
  if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_')
    return 1;
  if (c < 0x80) return 0;
  for (size_t i = 0; i < sizeof greek / sizeof greek[0]; i++) {
    size_t n = strlen(greek[i].letter);
    if ((size_t)(end - s) >= n && memcmp(s, greek[i].letter, n) == 0) {
      *out = greek[i].name;
      return (int)n;
    }
  }
  for (int i = 0; i < 10; i++) {
    size_t n = strlen(subscripts[i]);
    if ((size_t)(end - s) >= n && memcmp(s, subscripts[i], n) == 0) {
      one[0] = (char)('0' + i);
      return (int)n;
    }
  }
  return 0;
}

// Reads a name at s and writes its spelling without underscores, so that m_1, m₁ and m1 agree.
// Bytes taken.
static size_t read_name(const char* s, const char* end, char* key, size_t max) {
  const char* at = s;
  size_t n = 0;
  while (at < end) {
    const char* spelling;
    char one[2];
    int k = name_letter(at, end, &spelling, one);
    if (k == 0) break;
    for (; *spelling; spelling++) {
      if (*spelling != '_' && n + 1 < max) key[n++] = *spelling;
    }
    at += k;
  }
  key[n] = 0;
  return (size_t)(at - s);
}

static void plain_key(const char* ascii, char* key, size_t max) {
  read_name(ascii, ascii + strlen(ascii), key, max);
}

enum { MAX_KEY = 128 };

// Calls on each name of a text, comments and quoted text left out. Returns the next name after
// `from`, or NULL.
static const char* next_name(const char* from, const char* end, char key[MAX_KEY], size_t* n) {
  const char* at = from;
  while (at < end) {
    if (*at == '#') {
      while (at < end && *at != '\n') at++;
      continue;
    }
    // a unit: letters in it are no names, indices are short and found elsewhere
    if (*at == '[') {
      const char* close = memchr(at, ']', (size_t)(end - at));
      const char* line = memchr(at, '\n', (size_t)(end - at));
      if (close && (!line || close < line) && at > from && at[-1] == ' ') {
        at = close + 1;
        continue;
      }
    }
    bool digit = *at >= '0' && *at <= '9';
    *n = read_name(at, end, key, MAX_KEY);
    if (*n == 0) {
      uint32_t code;
      int k = pl_utf8_decode(at, end, &code);
      at += k > 0 ? k : 1;
      continue;
    }
    if (!digit) return at;
    // a number: 1e5 and 2x start with digits
    while (at < end && ((*at >= '0' && *at <= '9') || *at == '.')) at++;
  }
  return NULL;
}

bool pl_span_find_name(pl_span where, const char* ascii, pl_span* out) {
  if (!where.source || !ascii) return false;
  char wanted[MAX_KEY], key[MAX_KEY];
  plain_key(ascii, wanted, sizeof wanted);
  const char* end = where.source->text + where.end;
  size_t n;
  for (const char* at = where.source->text + where.begin;
       (at = next_name(at, end, key, &n)) != NULL; at += n) {
    if (strcmp(key, wanted) != 0) continue;
    out->source = where.source;
    out->begin = (uint32_t)(at - where.source->text);
    out->end = (uint32_t)(out->begin + n);
    return true;
  }
  return false;
}

int pl_source_count_name(const pl_source* s, const char* ascii) {
  if (!s) return 0;
  char wanted[MAX_KEY], key[MAX_KEY];
  plain_key(ascii, wanted, sizeof wanted);
  const char* end = s->text + s->size;
  size_t n;
  int count = 0;
  for (const char* at = s->text; (at = next_name(at, end, key, &n)) != NULL; at += n)
    count += strcmp(key, wanted) == 0;
  return count;
}

// ------------------------------------------------------------------------------------------- sides
static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

static pl_span trimmed(pl_span s) {
  const char* text = s.source->text;
  while (s.begin < s.end && is_blank(text[s.begin])) s.begin++;
  while (s.end > s.begin && is_blank(text[s.end - 1])) s.end--;
  return s;
}

// Bytes of a relation sign at s, 0 if there is none.
static size_t relation_sign(const char* s, const char* end) {
  static const char* const signs[] = {">=", "<=", "==", "!=", "=", "≥", "≤", "<", ">", "≠"};
  for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++) {
    size_t n = strlen(signs[i]);
    if ((size_t)(end - s) >= n && memcmp(s, signs[i], n) == 0) return n;
  }
  return 0;
}

// Where the right side ends: a comma outside brackets, a comment, a clause word, or the end of the
// line.
static const char* right_end(const char* s, const char* end) {
  int depth = 0;
  const char* at = s;
  for (; at < end && *at != '#'; at++) {
    if (*at == '(' || *at == '[') depth++;
    if (*at == ')' || *at == ']') depth--;
    if (depth == 0 && *at == ',') break;
    if (depth == 0 && is_blank(*at)) {
      static const char* const words[] = {"with ",  "while ",  "redundant ", "off",    "->",
                                          "rising", "falling", "of ",        "where ", "from ",
                                          "and ",   "at rest", "order ",     "for "};
      const char* next = at;
      while (next < end && is_blank(*next)) next++;
      for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        size_t n = strlen(words[i]);
        if ((size_t)(end - next) >= n && memcmp(next, words[i], n) == 0) return at;
      }
    }
  }
  return at;
}

bool pl_span_split_relation(pl_span where, pl_span* left, pl_span* right) {
  if (!where.source) return false;
  const char* text = where.source->text;
  const char* begin = text + where.begin;
  const char* end = text + where.end;
  const char* from = begin;
  int depth = 0;
  for (const char* at = begin; at < end && *at != '#'; at++) {
    if (*at == '(' || *at == '[') depth++;
    if (*at == ')' || *at == ']') depth--;
    if (depth != 0) continue;
    if (*at == ':') from = at + 1;
    size_t n = relation_sign(at, end);
    if (!n) continue;
    // a statement word before the left side is no part of it
    static const char* const words[] = {"constraint ", "init ", "guess ", "branch ",
                                        "assume ",     "let ",  "when ",  "param "};
    while (from < at && is_blank(*from)) from++;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
      size_t k = strlen(words[i]);
      if ((size_t)(at - from) > k && memcmp(from, words[i], k) == 0) from += k;
    }
    *left = trimmed((pl_span){where.source, (uint32_t)(from - text), (uint32_t)(at - text)});
    *right = trimmed((pl_span){where.source, (uint32_t)(at + n - text),
                               (uint32_t)(right_end(at + n, end) - text)});
    return left->begin < left->end && right->begin < right->end;
  }
  return false;
}

const char* pl_span_text(pl_arena* a, pl_span s, int max) {
  if (!s.source) return "";
  s = trimmed(s);
  const char* text = s.source->text + s.begin;
  const char* end = s.source->text + s.end;
  const char* line = memchr(text, '\n', (size_t)(end - text));
  if (line) end = line;
  const char* comment = memchr(text, '#', (size_t)(end - text));
  if (comment) end = comment;
  while (end > text && is_blank(end[-1])) end--;
  if (pl_utf8_width_n(text, (size_t)(end - text)) <= max)
    return pl_copy_n(a, text, (size_t)(end - text));
  const char* at = text;
  int cells = 0;
  while (at < end && cells < max - 3) {
    uint32_t code;
    int k = pl_utf8_decode(at, end, &code);
    at += k > 0 ? k : 1;
    cells++;
  }
  return pl_format(a, "%.*s...", (int)(at - text), text);
}
