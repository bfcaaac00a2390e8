// Boxes -> one line, in Unicode (PL_MATH_LINE) or in the ASCII of the model language
// (PL_MATH_ASCII).
#include "notation_impl.h"

#include <string.h>

typedef struct line {
  pl_text* out;
  bool ascii;
} line;

static void write_box(line w, const pl_box* b);

static void add(line w, const char* s) {
  if (w.ascii) pl_write_ascii(w.out, s);
  else pl_text_add(w.out, s);
}

static void write_name(line w, const pl_box* b) {
  add(w, b->text);
  if (b->sub) {
    add(w, "_");
    add(w, b->sub);
  }
  for (int i = 0; i < b->dots; i++) pl_text_add(w.out, "'");
}

// The index of an element without blanks around its signs: x[i-1]'.
static void write_indexed(line w, const pl_box* b) {
  add(w, b->text);
  pl_text index = pl_text_make(w.out->arena);
  write_box((line){&index, w.ascii}, b->at[0]);
  pl_text_add(w.out, "[");
  for (const char* s = pl_text_string(&index); *s; s++) {
    bool blank = *s == ' ' && (strchr("+-", s[1]) || (s > index.at && strchr("+-", s[-1])));
    if (!blank) pl_text_add_n(w.out, s, 1);
  }
  pl_text_add(w.out, "]");
  for (int i = 0; i < b->dots; i++) pl_text_add(w.out, "'");
}

static void write_op(line w, const pl_box* b) {
  if (b->role == PL_OP_INFIX) pl_text_add(w.out, " ");
  add(w, b->text);
  if (b->role == PL_OP_INFIX || b->role == PL_OP_COMMA) pl_text_add(w.out, " ");
}

static void write_product(line w, const pl_box* b) {
  for (int i = 0; i < b->n; i++) {
    bool sign = b->at[i]->kind == PL_B_OP && b->at[i]->role == PL_OP_TIGHT;
    bool after_sign = i > 0 && b->at[i - 1]->kind == PL_B_OP && b->at[i - 1]->role == PL_OP_TIGHT;
    if (i > 0 && !sign && !after_sign) pl_text_add(w.out, " ");
    write_box(w, b->at[i]);
  }
}

// x², x⁻¹, x^n, x^(3/2)
static void write_exponent(line w, const pl_box* e) {
  pl_text t = pl_text_make(w.out->arena);
  write_box((line){&t, w.ascii}, e);
  const char* s = pl_text_string(&t);
  const char* small = w.ascii ? NULL : pl_superscript(w.out->arena, s);
  if (small && !strpbrk(s, "+()")) {
    pl_text_add(w.out, small);
    return;
  }
  bool plain = (e->kind == PL_B_NUMBER || e->kind == PL_B_NAME) && !strpbrk(s, ",.");
  pl_text_addf(w.out, plain ? "^%s" : "^(%s)", s);
}

static void write_power(line w, const pl_box* b) {
  write_box(w, b->at[0]);
  write_exponent(w, b->at[1]);
}

// sin φ, sin²φ, sin(2 φ), sin²(2 φ); ASCII: sin^2 phi
static void write_apply(line w, const pl_box* b) {
  write_box(w, b->at[0]);
  bool gap = b->at[1]->kind != PL_B_FENCE && (b->at[0]->kind == PL_B_WORD || w.ascii);
  if (gap) pl_text_add(w.out, " ");
  write_box(w, b->at[1]);
}

static void write_fence(line w, const pl_box* b) {
  bool bars = strcmp(b->text, "|") == 0;
  pl_text_add(w.out, bars ? "|" : "(");
  write_box(w, b->at[0]);
  pl_text_add(w.out, bars ? "|" : ")");
}

static void write_root(line w, const pl_box* b) {
  add(w, "√");
  bool bare = b->at[0]->kind != PL_B_FENCE;
  if (w.ascii && bare) pl_text_add(w.out, "(");
  write_box(w, b->at[0]);
  if (w.ascii && bare) pl_text_add(w.out, ")");
}

// 0.5 m; in the model language 0.5 [m], so that it is read back as it is meant.
static void write_unit(line w, const pl_box* b) {
  pl_text_addf(w.out, w.ascii ? " [" : " ");
  pl_text_add(w.out, w.ascii ? pl_unit_ascii(w.out->arena, b->text) : b->text);
  if (w.ascii) pl_text_add(w.out, "]");
}

static void write_box(line w, const pl_box* b) {
  switch (b->kind) {
    case PL_B_NAME:
    case PL_B_VECTOR: write_name(w, b); break;
    case PL_B_INDEXED: write_indexed(w, b); break;
    case PL_B_NUMBER:
    case PL_B_WORD:
    case PL_B_PROSE: add(w, b->text); break;
    case PL_B_UNIT: write_unit(w, b); break;
    case PL_B_OP: write_op(w, b); break;
    case PL_B_PRODUCT: write_product(w, b); break;
    case PL_B_POWER: write_power(w, b); break;
    case PL_B_APPLY: write_apply(w, b); break;
    case PL_B_FENCE: write_fence(w, b); break;
    case PL_B_ROOT: write_root(w, b); break;
    case PL_B_ROW:
    case PL_B_FRACTION:
    case PL_B_SUM_OVER:
    case PL_B_CASES:
      for (int i = 0; i < b->n; i++) write_box(w, b->at[i]);
      break;
  }
}

void pl_write_line(pl_text* out, const pl_box* b, bool ascii) { write_box((line){out, ascii}, b); }
