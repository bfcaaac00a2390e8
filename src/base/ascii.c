// Sentences in pure ASCII, for terminals that have nothing else. Formulas come from notation in
// ASCII already; here are the words around them: Greek by name as the model language spells it,
// umlauts by two letters, typographic signs by the nearest plain ones.
#include "base/base.h"

#include <string.h>

typedef struct ascii_row {
  uint32_t code_point;
  const char* ascii;
} ascii_row;

// In order of code points, for the search.
static const ascii_row ascii_table[] = {
    {0x00a0, " "},     {0x00a7, "section "}, {0x00ab, "\""},      {0x00b0, " deg"},
    {0x00b1, "+-"},    {0x00b2, "^2"},       {0x00b3, "^3"},      {0x00b5, "u"},
    {0x00b7, "*"},     {0x00b9, "^1"},       {0x00bb, "\""},      {0x00bd, "1/2"},
    {0x00c4, "Ae"},    {0x00d6, "Oe"},       {0x00d7, "x"},       {0x00dc, "Ue"},
    {0x00df, "ss"},    {0x00e4, "ae"},       {0x00e9, "e"},       {0x00f6, "oe"},
    {0x00fc, "ue"},    {0x0391, "Alpha"},    {0x0393, "Gamma"},   {0x0394, "Delta"},
    {0x0398, "Theta"}, {0x039b, "Lambda"},   {0x03a0, "Pi"},      {0x03a3, "Sigma"},
    {0x03a6, "Phi"},   {0x03a8, "Psi"},      {0x03a9, "Omega"},   {0x03b1, "alpha"},
    {0x03b2, "beta"},  {0x03b3, "gamma"},    {0x03b4, "delta"},   {0x03b5, "epsilon"},
    {0x03b6, "zeta"},  {0x03b7, "eta"},      {0x03b8, "theta"},   {0x03b9, "iota"},
    {0x03ba, "kappa"}, {0x03bb, "lambda"},   {0x03bc, "mu"},      {0x03bd, "nu"},
    {0x03be, "xi"},    {0x03bf, "omicron"},  {0x03c0, "pi"},      {0x03c1, "rho"},
    {0x03c2, "sigma"}, {0x03c3, "sigma"},    {0x03c4, "tau"},     {0x03c5, "upsilon"},
    {0x03c6, "phi"},   {0x03c7, "chi"},      {0x03c8, "psi"},     {0x03c9, "omega"},
    {0x03d1, "theta"}, {0x03d5, "phi"},      {0x03f5, "epsilon"}, {0x2010, "-"},
    {0x2011, "-"},     {0x2012, "-"},        {0x2013, "-"},       {0x2014, "-"},
    {0x2018, "'"},     {0x2019, "'"},        {0x201a, "'"},       {0x201c, "\""},
    {0x201d, "\""},    {0x201e, "\""},       {0x2026, "..."},     {0x202f, " "},
    {0x2032, "'"},     {0x2033, "''"},       {0x207b, "^-"},      {0x2080, "0"},
    {0x2081, "1"},     {0x2082, "2"},        {0x2083, "3"},       {0x2084, "4"},
    {0x2085, "5"},     {0x2086, "6"},        {0x2087, "7"},       {0x2088, "8"},
    {0x2089, "9"},     {0x2190, "<-"},       {0x2192, "->"},      {0x21d2, "=>"},
    {0x2202, "d"},     {0x2207, "grad "},    {0x2208, "in"},      {0x2211, "sum "},
    {0x2212, "-"},     {0x221a, "sqrt"},     {0x221e, "inf"},     {0x222b, "integral "},
    {0x2248, "~"},     {0x2260, "!="},       {0x2264, "<="},      {0x2265, ">="},
    {0x226a, "<<"},    {0x226b, ">>"},       {0x22c5, "*"},
};

static const char* find_ascii(uint32_t code_point) {
  int lo = 0, hi = (int)(sizeof ascii_table / sizeof *ascii_table);
  while (lo < hi) {
    int mid = (lo + hi) / 2;
    if (ascii_table[mid].code_point < code_point) lo = mid + 1;
    else hi = mid;
  }
  bool found = lo < (int)(sizeof ascii_table / sizeof *ascii_table)
               && ascii_table[lo].code_point == code_point;
  return found ? ascii_table[lo].ascii : NULL;
}

// Superscript digits in a row share one ^: 10⁻¹² is 10^-12.
static int superscript_digit(uint32_t c) {
  if (c == 0xb9) return '1';
  if (c == 0xb2 || c == 0xb3) return '2' + (int)(c - 0xb2);
  if (c == 0x2070 || (c >= 0x2074 && c <= 0x2079)) return '0' + (int)(c - 0x2070);
  if (c == 0x207b) return '-';
  return 0;
}

const char* pl_ascii_of(pl_arena* a, const char* s) {
  pl_text out = pl_text_make(a);
  const char* end = s + strlen(s);
  bool raised = false, space = false;
  while (s < end) {
    uint32_t c;
    int n = pl_utf8_decode(s, end, &c);
    if (n <= 0) {
      c = '?';
      n = 1;
    }
    int digit = superscript_digit(c);
    bool dot = c == 0x0307 || c == 0x0308;  // combining dots: x with a dot is x'
    const char* plain = find_ascii(c);
    if (digit) {
      char one[3] = {'^', (char)digit, 0};
      pl_text_add(&out, raised ? one + 1 : one);
    } else if (c < 0x80) {
      // names of signs such as "grad " bring their own blank
      char one = (char)c;
      if (!(space && c == ' ')) pl_text_add_n(&out, &one, 1);
    } else if (dot) pl_text_add(&out, c == 0x0307 ? "'" : "''");
    else pl_text_add(&out, plain ? plain : "?");
    raised = digit != 0;
    space = plain && *plain && plain[strlen(plain) - 1] == ' ';
    s += n;
  }
  return pl_text_string(&out);
}
