// Boxes -> presentation MathML, the content of <math>. Follows what was measured in browsers: dots
// as spacing characters in an accent that does not stretch, brackets that stretch only around tall
// contents, a thin space after a function name that has no brackets, minus signs marked as prefix.
#include "notation_impl.h"

#include <string.h>

static void write_box(pl_text* out, const pl_box* b);

static void write_escaped(pl_text* out, const char* s) {
  for (; *s; s++) {
    if (*s == '&') pl_text_add(out, "&amp;");
    else if (*s == '<') pl_text_add(out, "&lt;");
    else if (*s == '>') pl_text_add(out, "&gt;");
    else pl_text_add_n(out, s, 1);
  }
}

static void element(pl_text* out, const char* tag, const char* content) {
  pl_text_addf(out, "<%s>", tag);
  write_escaped(out, content);
  pl_text_addf(out, "</%s>", tag);
}

static void write_stem(pl_text* out, const char* s, int dots) {
  if (dots < 1) {
    element(out, "mi", s);
    return;
  }
  static const char* const accent[] = {"˙", "¨", "⃛"};
  pl_text_addf(out, "<mover accent=\"true\" class=\"acc %s\">", dots == 1 ? "dot" : "ddot");
  element(out, "mi", s);
  pl_text_addf(out, "<mo stretchy=\"false\">%s</mo></mover>", accent[dots > 3 ? 2 : dots - 1]);
}

static void write_index(pl_text* out, const char* s) {
  element(out, strspn(s, "0123456789") == strlen(s) ? "mn" : "mi", s);
}

static void write_name(pl_text* out, const pl_box* b) {
  bool indexed = b->kind == PL_B_INDEXED;
  if (b->sub || indexed) pl_text_add(out, "<msub>");
  if (b->arrow) pl_text_add(out, "<mover accent=\"true\" class=\"acc vec\">");
  write_stem(out, b->text, b->dots);
  if (b->arrow) pl_text_add(out, "<mo stretchy=\"false\">→</mo></mover>");
  if (!b->sub && !indexed) return;
  if (indexed) pl_text_add(out, "<mrow>");
  if (b->sub) write_index(out, b->sub);
  if (b->sub && indexed) pl_text_add(out, "<mo>,</mo>");
  if (indexed) {
    write_box(out, b->at[0]);
    pl_text_add(out, "</mrow>");
  }
  pl_text_add(out, "</msub>");
}

static void write_vector(pl_text* out, const pl_box* b) {
  pl_text_add(out, "<msub><mover accent=\"true\" class=\"acc vec\">");
  element(out, "mi", b->text);
  pl_text_add(out, "<mo stretchy=\"false\">→</mo></mover>");
  write_index(out, b->sub ? b->sub : "");
  pl_text_add(out, "</msub>");
}

static void write_op(pl_text* out, const pl_box* b) {
  const char* s = b->text;
  if (strcmp(s, "-") == 0) s = "−";
  if (strcmp(s, "->") == 0) s = "→";
  if (strcmp(s, "in") == 0) s = "∈";
  if (b->role == PL_OP_PREFIX && strcmp(s, "∫") != 0)
    pl_text_add(out, "<mo form=\"prefix\" lspace=\"0\" rspace=\"0\">");
  else if (strcmp(s, "d") == 0 || strcmp(s, "∂") == 0)
    pl_text_add(out, "<mo lspace=\"0\" rspace=\"0\">");
  else if (b->role == PL_OP_TIGHT && strcmp(s, "·") != 0)
    pl_text_add(out, "<mo stretchy=\"false\" lspace=\"0\" rspace=\"0\">");
  else pl_text_add(out, "<mo>");
  write_escaped(out, s);
  pl_text_add(out, "</mo>");
  if (b->role == PL_OP_COMMA) pl_text_add(out, "<mspace width=\"0.3em\"/>");
}

static void write_space(pl_text* out, const char* width) {
  pl_text_addf(out, "<mspace width=\"%s\"/>", width);
}

static bool is_bare_call(const pl_box* b) {
  return b->kind == PL_B_APPLY && b->at[1]->kind != PL_B_FENCE;
}

static void write_product(pl_text* out, const pl_box* b) {
  pl_text_add(out, "<mrow>");
  for (int i = 0; i < b->n; i++) {
    bool sign = b->at[i]->kind == PL_B_OP || (i > 0 && b->at[i - 1]->kind == PL_B_OP);
    if (i > 0 && !sign) {
      if (is_bare_call(b->at[i - 1]) || b->at[i]->kind == PL_B_VECTOR) write_space(out, "0.17em");
      else if (b->at[i]->kind == PL_B_APPLY) write_space(out, "0.1em");
      else if (b->at[i]->kind == PL_B_FRACTION && b->at[i - 1]->kind == PL_B_FRACTION)
        write_space(out, "0.17em");
    }
    write_box(out, b->at[i]);
  }
  pl_text_add(out, "</mrow>");
}

static void write_row(pl_text* out, const pl_box* b) {
  pl_text_add(out, "<mrow>");
  for (int i = 0; i < b->n; i++) write_box(out, b->at[i]);
  pl_text_add(out, "</mrow>");
}

static void write_fence(pl_text* out, const pl_box* b) {
  bool bars = strcmp(b->text, "|") == 0;
  const char* stretchy = b->at[0]->tall ? "true" : "false";
  pl_text_addf(
      out,
      "<mrow><mo fence=\"true\" stretchy=\"%s\" form=\"prefix\" lspace=\"0\" rspace=\"0\">%s</mo>",
      stretchy, bars ? "|" : "(");
  write_box(out, b->at[0]);
  pl_text_addf(out,
               "<mo fence=\"true\" stretchy=\"%s\" form=\"postfix\" lspace=\"0\" "
               "rspace=\"0\">%s</mo></mrow>",
               stretchy, bars ? "|" : ")");
}

static void write_pair(pl_text* out, const char* tag, const pl_box* x, const pl_box* y) {
  pl_text_addf(out, "<%s>", tag);
  write_box(out, x);
  write_box(out, y);
  pl_text_addf(out, "</%s>", tag);
}

static void write_apply(pl_text* out, const pl_box* b) {
  pl_text_add(out, "<mrow>");
  write_box(out, b->at[0]);
  pl_text_add(out, "<mo>&#x2061;</mo>");
  if (is_bare_call(b)) write_space(out, "0.17em");
  write_box(out, b->at[1]);
  pl_text_add(out, "</mrow>");
}

static void write_sum_over(pl_text* out, const pl_box* b) {
  pl_text_add(out, "<mrow><munderover><mo>∑</mo><mrow>");
  write_box(out, b->at[0]);
  pl_text_add(out, "<mo>=</mo>");
  write_box(out, b->at[1]);
  pl_text_add(out, "</mrow>");
  write_box(out, b->at[2]);
  pl_text_add(out, "</munderover>");
  write_box(out, b->at[3]);
  pl_text_add(out, "</mrow>");
}

static void write_cases(pl_text* out, const pl_box* b) {
  pl_text_add(out,
              "<mrow><mo fence=\"true\" stretchy=\"true\" form=\"prefix\">{</mo><mtable "
              "class=\"cases\"><mtr><mtd>");
  write_box(out, b->at[1]);
  pl_text_add(out, "</mtd><mtd>");
  write_box(out, b->at[0]);
  pl_text_add(out, "</mtd></mtr><mtr><mtd>");
  write_box(out, b->at[2]);
  pl_text_add(out, "</mtd><mtd><mtext>else</mtext></mtd></mtr></mtable></mrow>");
}

static void write_word(pl_text* out, const char* s) {
  pl_text_add(out, "<mi class=\"fn\">");
  write_escaped(out, s);
  pl_text_add(out, "</mi>");
}

static void write_unit(pl_text* out, const char* unit) {
  write_space(out, "0.17em");
  pl_text_add(out, "<mi mathvariant=\"normal\">");
  write_escaped(out, unit);
  pl_text_add(out, "</mi>");
}

static void write_box(pl_text* out, const pl_box* b) {
  switch (b->kind) {
    case PL_B_NAME:
    case PL_B_INDEXED: write_name(out, b); break;
    case PL_B_VECTOR: write_vector(out, b); break;
    case PL_B_NUMBER: element(out, "mn", b->text); break;
    case PL_B_WORD: write_word(out, b->text); break;
    case PL_B_UNIT: write_unit(out, b->text); break;
    case PL_B_OP: write_op(out, b); break;
    case PL_B_PROSE: element(out, "mtext", b->text); break;
    case PL_B_ROW: write_row(out, b); break;
    case PL_B_PRODUCT: write_product(out, b); break;
    case PL_B_FRACTION: write_pair(out, "mfrac", b->at[0], b->at[1]); break;
    case PL_B_ROOT:
      pl_text_add(out, "<msqrt>");
      write_box(out, b->at[0]);
      pl_text_add(out, "</msqrt>");
      break;
    case PL_B_POWER: write_pair(out, "msup", b->at[0], b->at[1]); break;
    case PL_B_APPLY: write_apply(out, b); break;
    case PL_B_FENCE: write_fence(out, b); break;
    case PL_B_SUM_OVER: write_sum_over(out, b); break;
    case PL_B_CASES: write_cases(out, b); break;
  }
}

void pl_write_mathml(pl_text* out, const pl_box* b) { write_box(out, b); }
