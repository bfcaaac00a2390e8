// Every construct in all five manners, and what the model language needs to read a line back.
#include "notation/notation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

typedef struct fixture {
  pl_arena* a;
  pl_pool* p;
  pl_expr m1, m2, g, l, r, R, phi, phid, theta, thetad, x1, x1d, x1dd, lambda, start, startd, t;
} fixture;

static pl_expr symbol(fixture* f, const char* name, const char* ascii, pl_role role,
                      pl_class class) {
  pl_symbol_info i = {.name = name, .ascii = ascii, .role = role, .class = class};
  return pl_sym(f->p, pl_symbol_make(f->p, &i));
}

static int set_up(void** state) {
  pl_arena* a = pl_arena_make(NULL);
  fixture* f = PL_NEW(a, fixture);
  f->a = a;
  f->p = pl_pool_make(a);
  f->m1 = symbol(f, "m1", "m1", PL_R_PARAM, PL_C_MASS);
  f->m2 = symbol(f, "m2", "m2", PL_R_PARAM, PL_C_MASS);
  f->g = symbol(f, "g", "g", PL_R_PARAM, PL_C_GRAVITY);
  f->l = symbol(f, "l", "l", PL_R_PARAM, PL_C_LENGTH);
  f->r = symbol(f, "r", "r", PL_R_PARAM, PL_C_LENGTH);
  f->R = symbol(f, "R", "R", PL_R_PARAM, PL_C_LENGTH);
  f->phi = symbol(f, "φ", "phi", PL_R_COORD, PL_C_COORD);
  f->theta = symbol(f, "ϑ", "theta", PL_R_COORD, PL_C_COORD);
  f->x1 = symbol(f, "x1", "x1", PL_R_COORD, PL_C_COORD);
  pl_symbol x1 = pl_symbol_of(f->p, f->x1), x1d = pl_symbol_dot(f->p, x1);
  f->x1d = pl_sym(f->p, x1d);
  f->x1dd = pl_sym(f->p, pl_symbol_dot(f->p, x1d));
  f->phid = pl_sym(f->p, pl_symbol_dot(f->p, pl_symbol_of(f->p, f->phi)));
  f->thetad = pl_sym(f->p, pl_symbol_dot(f->p, pl_symbol_of(f->p, f->theta)));
  f->start = pl_sym(f->p, pl_symbol_start(f->p, x1));
  f->startd = pl_sym(f->p, pl_symbol_start(f->p, x1d));
  f->lambda = symbol(f, "λ_g1", "lambda_g1", PL_R_MULTIPLIER, PL_C_MULTIPLIER);
  f->t = pl_sym(f->p, pl_time(f->p));
  *state = f;
  return 0;
}

static int tear_down(void** state) {
  fixture* f = *state;
  pl_arena_free(f->a);
  return 0;
}

// -------------------------------------------------------------------------------- building by hand
static const pl_form* leaf(fixture* f, pl_expr e) { return pl_form_leaf(f->a, e); }
static const pl_form* number(fixture* f, long n) { return leaf(f, pl_int(f->p, n)); }
#define FORMS(...)                       \
  (const pl_form* const[]){__VA_ARGS__}, \
      (int)(sizeof((const pl_form* const[]){__VA_ARGS__}) / sizeof(const pl_form*))
#define SUM(...)    ((const pl_form*)pl_form_sum(f->a, FORMS(__VA_ARGS__)))
#define PROD(...)   ((const pl_form*)pl_form_product(f->a, FORMS(__VA_ARGS__)))
#define NEG(x)      ((const pl_form*)pl_form_neg(f->a, x))
#define QUOT(x, y)  ((const pl_form*)pl_form_quotient(f->a, x, y))
#define POW(x, y)   ((const pl_form*)pl_form_power(f->a, x, y))
#define SQ(x)       POW(x, N(2))
#define ROOT(x)     ((const pl_form*)pl_form_root(f->a, x))
#define FN(id, ...) ((const pl_form*)pl_form_call(f->a, id, FORMS(__VA_ARGS__)))
#define L(name)     leaf(f, f->name)
#define N(n)        number(f, n)

static const char* print(fixture* f, const pl_form* form, pl_math math) {
  return pl_notation_print(f->a, f->p, form, (pl_notation){math, PL_ENGLISH});
}
#define LINE(form, text)    assert_string_equal(print(f, form, PL_MATH_LINE), text)
#define ASCII(form, text)   assert_string_equal(print(f, form, PL_MATH_ASCII), text)
#define TEX(form, text)     assert_string_equal(print(f, form, PL_MATH_TEX), text)
#define PICTURE(form, text) assert_string_equal(print(f, form, PL_MATH_2D), text)
#define MATHML(form, text)  assert_string_equal(print(f, form, PL_MATH_MATHML), text)

// ------------------------------------------------------------------------------------------- names
static void names_carry_dots_and_indices(void** state) {
  fixture* f = *state;
  LINE(L(x1dd), "x1''");
  ASCII(L(x1dd), "x1''");
  PICTURE(L(x1dd), "ẍ₁");
  TEX(L(x1dd), "\\ddot{x}_{1}");
  MATHML(L(x1dd),
         "<msub><mover accent=\"true\" class=\"acc ddot\"><mi>x</mi><mo "
         "stretchy=\"false\">¨</mo></mover><mn>1</mn></msub>");
}

static void greek_letters_have_names(void** state) {
  fixture* f = *state;
  LINE(L(thetad), "ϑ'");
  ASCII(L(thetad), "theta'");
  PICTURE(L(thetad), "ϑ\u0307");
  TEX(L(thetad), "\\dot{\\vartheta}");
  TEX(L(phi), "\\varphi");
  MATHML(L(phi), "<mi>φ</mi>");
}

static void multipliers_keep_their_label(void** state) {
  fixture* f = *state;
  LINE(L(lambda), "λ_g1");
  ASCII(L(lambda), "lambda_g1");
  TEX(L(lambda), "\\lambda_{g_{1}}");
  MATHML(L(lambda), "<msub><mi>λ</mi><mi>g1</mi></msub>");
}

static void start_values_are_written_at_zero(void** state) {
  fixture* f = *state;
  LINE(L(start), "x1(0)");
  LINE(L(startd), "x1'(0)");
  ASCII(L(startd), "x1'(0)");
  PICTURE(L(startd), "ẋ₁(0)");
  TEX(L(startd), "\\dot{x}_{1}(0)");
  LINE(SQ(L(startd)), "x1'(0)²");
}

static void elements_of_families_have_brackets(void** state) {
  fixture* f = *state;
  pl_symbol i = pl_symbol_of(f->p, symbol(f, "i", "i", PL_R_INDEX, PL_C_OTHER));
  pl_symbol x = pl_symbol_of(f->p, symbol(f, "x", "x", PL_R_ARRAY, PL_C_COORD));
  pl_expr e = pl_at(f->p, x, 1, pl_sub(f->p, pl_sym(f->p, i), pl_int(f->p, 1)));
  LINE(leaf(f, e), "x[i-1]'");
  ASCII(leaf(f, e), "x[i-1]'");
  TEX(leaf(f, e), "\\dot{x}_{i - 1}");
}

// ------------------------------------------------------------------------------- the atwood answer
static const pl_form* atwood(fixture* f) {
  return QUOT(PROD(N(-2), L(m1), L(m2), L(g)), SUM(L(m1), L(m2)));
}

static void a_multiplier_in_all_manners(void** state) {
  fixture* f = *state;
  LINE(atwood(f), "-2 m1 m2 g / (m1 + m2)");
  ASCII(atwood(f), "-2 m1 m2 g / (m1 + m2)");
  TEX(atwood(f), "-\\frac{2 m_{1} m_{2} g}{m_{1} + m_{2}}");
  PICTURE(atwood(f), "   2 m₁ m₂ g\n− ───────────\n    m₁ + m₂");
}

static void a_fraction_beside_a_factor(void** state) {
  fixture* f = *state;
  const pl_form* x = PROD(NEG(QUOT(PROD(N(2), L(m1), L(m2)), SUM(L(m1), L(m2)))), L(g));
  const pl_form* relation = pl_form_relation(f->a, pl_form_name(f->a, "λ", f->lambda), "=", x);
  PICTURE(relation, "       2 m₁ m₂\nλ = − ───────── g\n       m₁ + m₂");
}

static void short_quotients_are_tight(void** state) {
  fixture* f = *state;
  LINE(QUOT(SUM(L(m1), NEG(L(m2))), SUM(L(m1), L(m2))), "(m1 - m2)/(m1 + m2)");
  LINE(QUOT(SQ(L(x1d)), N(2)), "x1'²/2");
  LINE(QUOT(PROD(L(m1), L(g)), PROD(N(2), L(m2))), "m1 g/(2 m2)");
  LINE(QUOT(PROD(L(r), FN(PL_COS, L(phi))), ROOT(SUM(SQ(L(l)), NEG(SQ(L(r)))))),
       "r cos φ / √(l² - r²)");
  LINE(QUOT(PROD(L(m1), L(g)), PROD(SUM(L(m1), L(m2)), L(r))), "m1 g / ((m1 + m2) r)");
}

// ------------------------------------------------------------------------------------------ rule 5
static void a_product_after_a_division_needs_brackets(void** state) {
  fixture* f = *state;
  LINE(PROD(QUOT(L(g), L(R)), FN(PL_COS, L(phi))), "(g/R) cos φ");
  LINE(PROD(QUOT(N(1), N(2)), L(m1), SQ(L(x1d))), "1/2 m1 x1'²");
  LINE(PROD(QUOT(L(m1), N(2)), SQ(L(r)), SQ(L(phid))), "m1/2 r² φ'²");
  LINE(PROD(L(m1), QUOT(N(1), N(2))), "m1 (1/2)");
  LINE(PROD(L(m1), QUOT(L(r), L(l))), "m1 r/l");
  LINE(PROD(N(2), QUOT(L(g), L(R)), SUM(N(1), NEG(FN(PL_COS, L(theta))))), "2 (g/R) (1 - cos ϑ)");
  LINE(QUOT(FN(PL_COS, L(phi)), N(2)), "cos(φ)/2");
  LINE(QUOT(PROD(L(g), FN(PL_COS, L(phi))), L(R)), "g cos(φ)/R");
  LINE(QUOT(FN(PL_COS, L(phi)), FN(PL_SIN, L(phi))), "cos φ/sin φ");
  TEX(QUOT(FN(PL_COS, L(phi)), N(2)), "\\frac{\\cos \\varphi}{2}");
  LINE(QUOT(QUOT(L(g), L(R)), L(l)), "(g/R)/l");
  LINE(QUOT(L(g), QUOT(L(R), L(l))), "g/(R/l)");
  LINE(QUOT(L(g), PROD(L(R), L(l))), "g/(R l)");
  LINE(PROD(L(m1), QUOT(PROD(L(m2), L(g)), SUM(L(m1), L(m2)))), "m1 (m2 g / (m1 + m2))");
}

static void numbers_side_by_side_get_a_sign(void** state) {
  fixture* f = *state;
  LINE(PROD(L(m1), N(2)), "m1·2");
  ASCII(PROD(L(m1), N(2)), "m1*2");
  TEX(PROD(N(3), N(2)), "3 \\cdot 2");
  LINE(PROD(FN(PL_COS, L(phi)), N(2)), "cos φ·2");
}

static void minus_signs_stand_where_they_may(void** state) {
  fixture* f = *state;
  LINE(SUM(L(m1), NEG(L(m2)), NEG(SUM(L(l), L(r)))), "m1 - m2 - (l + r)");
  LINE(SUM(L(m1), PROD(N(-2), L(m2))), "m1 - 2 m2");
  LINE(NEG(SUM(L(l), L(r))), "-(l + r)");
  LINE(PROD(L(m1), NEG(L(g))), "m1 (-g)");
  LINE(QUOT(NEG(L(m1)), L(g)), "-m1/g");
  LINE(QUOT(L(m1), NEG(L(g))), "m1/(-g)");
  LINE(POW(NEG(L(m1)), N(2)), "(-m1)²");
  LINE(SQ(N(-3)), "(-3)²");
  LINE(SUM(NEG(L(m1)), QUOT(N(-1), N(2))), "-m1 - 1/2");
}

// -------------------------------------------------------------------------------- powers and roots
static void powers_bind_their_base(void** state) {
  fixture* f = *state;
  LINE(SQ(SUM(L(l), L(r))), "(l + r)²");
  LINE(SQ(PROD(L(l), L(r))), "(l r)²");
  LINE(SQ(QUOT(L(l), L(r))), "(l/r)²");
  LINE(POW(SQ(L(l)), N(3)), "(l²)³");
  LINE(POW(L(l), N(-1)), "l⁻¹");
  ASCII(POW(L(l), N(-1)), "l^(-1)");
  LINE(POW(L(l), leaf(f, pl_ratio(f->p, 3, 2))), "l^(3/2)");
  TEX(POW(L(l), leaf(f, pl_ratio(f->p, 3, 2))), "l^{3/2}");
  LINE(POW(L(l), L(r)), "l^r");
  LINE(POW(L(l), SUM(L(r), N(1))), "l^(r + 1)");
  ASCII(SQ(L(phid)), "phi'^2");
  TEX(SQ(L(phid)), "\\dot{\\varphi}^{2}");
  LINE(POW(leaf(f, pl_ratio(f->p, 1, 3)), N(2)), "(1/3)²");
}

static void powers_of_functions_stand_at_the_name(void** state) {
  fixture* f = *state;
  LINE(SQ(FN(PL_SIN, L(phi))), "sin²φ");
  ASCII(SQ(FN(PL_SIN, L(phi))), "sin^2 phi");
  TEX(SQ(FN(PL_SIN, L(phi))), "\\sin^{2} \\varphi");
  MATHML(SQ(FN(PL_SIN, L(phi))),
         "<mrow><msup><mi class=\"fn\">sin</mi><mn>2</mn></msup><mo>&#x2061;</mo><mspace "
         "width=\"0.17em\"/><mi>φ</mi></mrow>");
  LINE(POW(FN(PL_SIN, L(phi)), N(-1)), "(sin φ)⁻¹");
  LINE(SQ(FN(PL_LN, L(l))), "(ln l)²");
}

static void functions_take_brackets_when_more_than_a_name_follows(void** state) {
  fixture* f = *state;
  LINE(FN(PL_COS, SUM(L(phi), NEG(L(theta)))), "cos(φ - ϑ)");
  LINE(FN(PL_COS, PROD(N(2), L(phi))), "cos(2 φ)");
  LINE(FN(PL_COS, L(phid)), "cos(φ')");
  LINE(FN(PL_COS, L(start)), "cos x1(0)");
  LINE(FN(PL_ACOS, QUOT(N(2), N(3))), "acos(2/3)");
  LINE(FN(PL_EXP, L(t)), "exp(t)");
  LINE(FN(PL_ATAN2, L(l), L(r)), "atan2(l, r)");
  LINE(FN(PL_ABS, L(x1)), "abs(x1)");
  TEX(FN(PL_ABS, L(x1)), "\\lvert x_{1}\\rvert ");
  TEX(FN(PL_EXP, NEG(L(t))), "e^{-t}");
  TEX(FN(PL_COS, SUM(L(phi), NEG(L(theta)))), "\\cos(\\varphi - \\vartheta)");
  LINE(PROD(FN(PL_SIN, L(phi)), L(r)), "sin(φ) r");
  LINE(PROD(FN(PL_SIN, L(phi)), L(phid)), "sin φ φ'");
  TEX(PROD(FN(PL_SIN, L(phi)), L(phid)), "\\sin \\varphi\\, \\dot{\\varphi}");
  LINE(PROD(ROOT(N(2)), L(r)), "√2·r");
  LINE(PROD(L(r), ROOT(N(2))), "r √2");
}

static void roots_are_drawn(void** state) {
  fixture* f = *state;
  const pl_form* x = ROOT(SUM(SQ(L(l)), NEG(PROD(SQ(L(r)), SQ(FN(PL_SIN, L(phi)))))));
  LINE(x, "√(l² - r² sin²φ)");
  ASCII(x, "sqrt(l^2 - r^2 sin^2 phi)");
  TEX(x, "\\sqrt{l^{2} - r^{2} \\sin^{2} \\varphi}");
  PICTURE(x, " _____________\n√l² − r² sin²φ");
  LINE(ROOT(N(2)), "√2");
  ASCII(ROOT(N(2)), "sqrt(2)");
  LINE(ROOT(QUOT(L(g), L(l))), "√(g/l)");
  TEX(ROOT(QUOT(L(g), L(l))), "\\sqrt{\\frac{g}{l}}");
}

// ---------------------------------------------------------------------------------- two dimensions
static void tall_brackets_are_drawn(void** state) {
  fixture* f = *state;
  const pl_form* x = SQ(SUM(N(1), NEG(QUOT(L(r), L(l)))));
  PICTURE(x, "⎛     r ⎞²\n⎜1 − ───⎟\n⎝     l ⎠");
  TEX(x, "\\left(1 - \\frac{r}{l}\\right)^{2}");
}

static void height_and_base_line_are_told(void** state) {
  fixture* f = *state;
  int above = -1, below = -1;
  pl_notation_print_2d(f->a, f->p, QUOT(L(g), L(l)), (pl_notation){PL_MATH_2D, PL_ENGLISH}, &above,
                       &below);
  assert_int_equal(above, 1);
  assert_int_equal(below, 1);
}

// ----------------------------------------------------------------------------------------- numbers
static void exact_decimals_stay_decimal(void** state) {
  fixture* f = *state;
  LINE(leaf(f, pl_number_from_text(f->p, "9.81", 4)), "9.81");
  LINE(leaf(f, pl_number_from_text(f->p, "0.01", 4)), "0.01");
  LINE(leaf(f, pl_ratio(f->p, -3, 4)), "-3/4");
  LINE(leaf(f, pl_ratio(f->p, 2, 5)), "2/5");
  assert_string_equal(pl_notation_print(f->a, f->p, leaf(f, pl_number_from_text(f->p, "9.81", 4)),
                                        (pl_notation){PL_MATH_2D, PL_GERMAN}),
                      "9,81");
  assert_string_equal(pl_notation_print(f->a, f->p, leaf(f, pl_number_from_text(f->p, "9.81", 4)),
                                        (pl_notation){PL_MATH_ASCII, PL_GERMAN}),
                      "9.81");
}

static void shown(fixture* f, double x, int digits, pl_math math, pl_language lang,
                  const char* text) {
  assert_string_equal(pl_notation_number(f->a, x, digits, (pl_notation){math, lang}), text);
}

static void measured_numbers_are_rounded_for_display(void** state) {
  fixture* f = *state;
  shown(f, -23.544, 6, PL_MATH_LINE, PL_ENGLISH, "-23.544");
  shown(f, -23.544, 6, PL_MATH_2D, PL_GERMAN, "−23,544");
  shown(f, -23.544, 6, PL_MATH_TEX, PL_GERMAN, "-23{,}544");
  shown(f, 1.962, 6, PL_MATH_LINE, PL_ENGLISH, "1.962");
  shown(f, 3.2e-7, 6, PL_MATH_LINE, PL_ENGLISH, "3.2e-7");
  shown(f, 3.2e-7, 6, PL_MATH_2D, PL_GERMAN, "3,2·10⁻⁷");
  shown(f, 3.2e-7, 6, PL_MATH_TEX, PL_ENGLISH, "3.2\\cdot 10^{-7}");
  shown(f, 2.0, 6, PL_MATH_LINE, PL_ENGLISH, "2");
  shown(f, -0.0, 6, PL_MATH_LINE, PL_ENGLISH, "0");
  shown(f, 1e300, 6, PL_MATH_LINE, PL_ENGLISH, "1e300");
  shown(f, 0.0001, 6, PL_MATH_LINE, PL_ENGLISH, "0.0001");
  shown(f, 48.18968510422, 6, PL_MATH_LINE, PL_ENGLISH, "48.1897");
  shown(f, -1.0 / 0.0, 6, PL_MATH_LINE, PL_ENGLISH, "-∞");
  shown(f, 0.0 / 0.0, 6, PL_MATH_ASCII, PL_ENGLISH, "NaN");
  shown(f, 999999.7, 6, PL_MATH_LINE, PL_ENGLISH, "1e6");
}

// -------------------------------------------------------------------------------------- statements
static void vectors_are_sums_along_unit_vectors(void** state) {
  fixture* f = *state;
  const char* const units[] = {"e_r", "e_ϑ"};
  const pl_form* c[] = {NEG(PROD(L(m1), L(g), FN(PL_COS, L(theta)))),
                        PROD(L(m1), L(g), FN(PL_SIN, L(theta)))};
  const pl_form* v = pl_form_vector(f->a, c, units, 2);
  LINE(v, "-m1 g cos ϑ e_r + m1 g sin ϑ e_ϑ");
  ASCII(v, "-m1 g cos theta e_r + m1 g sin theta e_theta");
  TEX(v,
      "-m_{1} g \\cos \\vartheta\\, \\vec{e}_{r} + m_{1} g \\sin \\vartheta\\, "
      "\\vec{e}_{\\vartheta}");
  const pl_form* one[] = {L(lambda), N(0)};
  LINE(pl_form_vector(f->a, one, units, 2), "λ_g1 e_r");
  const pl_form* none[] = {N(0), N(0)};
  LINE(pl_form_vector(f->a, none, units, 2), "0");
  const pl_form* fraction[] = {atwood(f), N(-1)};
  LINE(pl_form_vector(f->a, fraction, units, 2), "-(2 m1 m2 g / (m1 + m2)) e_r - e_ϑ");
}

static void relations_and_names(void** state) {
  fixture* f = *state;
  const pl_form* x = pl_form_relation(f->a, pl_form_name(f->a, "M(φ)", pl_poison()), "≥", N(0));
  LINE(x, "M(φ) ≥ 0");
  ASCII(x, "M(phi) >= 0");
  TEX(x, "M(\\varphi) \\ge 0");
  const pl_form* to = pl_form_relation(f->a, L(m2), "->", N(0));
  LINE(to, "m2 -> 0");
  TEX(to, "m_{2} \\to 0");
  PICTURE(to, "m₂ → 0");
  MATHML(pl_form_relation(f->a, L(l), "<", L(r)), "<mrow><mi>l</mi><mo>&lt;</mo><mi>r</mi></mrow>");
}

static void derivatives_integrals_and_orders(void** state) {
  fixture* f = *state;
  pl_form* d = pl_form_make(f->a, PL_F_DERIVATIVE, 1,
                            (const pl_form* const[]){pl_form_name(f->a, "M", pl_poison())});
  d->expr = f->phi;
  LINE(PROD(QUOT(N(1), N(2)), d, SQ(L(phid))), "1/2 diff(M, φ) φ'²");
  TEX(d, "\\frac{\\mathrm{d}M}{\\mathrm{d}\\varphi}");
  pl_form* i = pl_form_make(f->a, PL_F_INTEGRAL, 1,
                            (const pl_form* const[]){ROOT(SUM(L(l), L(phi)))});
  i->expr = f->phi;
  LINE(i, "∫ dφ √(l + φ)");
  TEX(i, "\\int \\, \\mathrm{d}\\varphi\\, \\sqrt{l + \\varphi}");
  pl_form* o = pl_form_make(f->a, PL_F_ORDER, 1, (const pl_form* const[]){POW(L(l), N(3))});
  LINE(SUM(L(m1), o), "m1 + O(l³)");
  pl_form* pm = pl_form_make(f->a, PL_F_PLUSMINUS, 2, (const pl_form* const[]){L(l), ROOT(N(2))});
  LINE(pm, "l ± √2");
  TEX(pm, "l \\pm \\sqrt{2}");
  LINE(PROD(L(r), pm), "r (l ± √2)");
}

static void words_follow_the_language(void** state) {
  fixture* f = *state;
  const pl_form* w = pl_form_words(f->a, "or", "oder");
  assert_string_equal(pl_notation_print(f->a, f->p, w, (pl_notation){PL_MATH_LINE, PL_GERMAN}),
                      "oder");
  assert_string_equal(pl_notation_print(f->a, f->p, w, (pl_notation){PL_MATH_TEX, PL_ENGLISH}),
                      "\\text{or}");
}

static void sums_over_an_index_and_cases(void** state) {
  fixture* f = *state;
  pl_symbol i = pl_symbol_of(f->p, symbol(f, "i", "i", PL_R_INDEX, PL_C_OTHER));
  pl_expr n = symbol(f, "N", "N", PL_R_PARAM, PL_C_OTHER);
  pl_symbol x = pl_symbol_of(f->p, symbol(f, "y", "y", PL_R_ARRAY, PL_C_COORD));
  pl_expr sum = pl_sum_over(f->p, i, pl_int(f->p, 1), n, pl_at(f->p, x, 0, pl_sym(f->p, i)));
  LINE(leaf(f, sum), "sum(i in 1..N, y[i])");
  TEX(leaf(f, sum), "\\sum_{i=1}^{N} y_{i}");
  pl_expr cases = pl_if(f->p, f->x1, f->l, f->r);
  LINE(leaf(f, cases), "if(x1 > 0, l, r)");
  TEX(leaf(f, cases), "\\begin{cases}l & x_{1} > 0 \\\\ r & \\text{else}\\end{cases}");
}

static void mathml_brackets_stretch_only_when_tall(void** state) {
  fixture* f = *state;
  const char* flat = print(f, SQ(SUM(L(l), L(r))), PL_MATH_MATHML);
  const char* tall = print(f, SQ(SUM(L(l), QUOT(L(r), L(l)))), PL_MATH_MATHML);
  assert_non_null(strstr(flat, "stretchy=\"false\" form=\"prefix\" lspace=\"0\" rspace=\"0\">("));
  assert_null(strstr(flat, "stretchy=\"true\""));
  assert_non_null(strstr(tall, "stretchy=\"true\" form=\"prefix\" lspace=\"0\" rspace=\"0\">("));
}

static void mathml_prefix_minus_has_no_space(void** state) {
  fixture* f = *state;
  const char* s = print(f, pl_form_relation(f->a, L(l), "=", NEG(L(r))), PL_MATH_MATHML);
  assert_non_null(strstr(s, "<mo form=\"prefix\" lspace=\"0\" rspace=\"0\">−</mo>"));
}

static void hollow_and_deep_forms_do_not_crash(void** state) {
  fixture* f = *state;
  pl_form* hollow = pl_form_make(f->a, PL_F_QUOTIENT, 0, NULL);
  LINE(hollow, "?");
  LINE(pl_form_make(f->a, PL_F_SUM, 0, NULL), "0");
  LINE(pl_form_make(f->a, PL_F_LIST, 0, NULL), "");
  const pl_form* deep = L(l);
  for (int i = 0; i < 5000; i++) deep = FN(PL_SIN, deep);
  for (int math = PL_MATH_LINE; math <= PL_MATH_MATHML; math++)
    assert_non_null(print(f, deep, (pl_math)math));
  const pl_form *minus = L(l), *product = L(l), *quotient = L(l);
  for (int i = 0; i < 100000; i++) {
    minus = NEG(minus);
    product = PROD(product, L(r));
    quotient = QUOT(quotient, L(r));
  }
  for (int math = PL_MATH_LINE; math <= PL_MATH_MATHML; math++) {
    assert_non_null(print(f, minus, (pl_math)math));
    assert_non_null(print(f, product, (pl_math)math));
    assert_non_null(print(f, quotient, (pl_math)math));
  }
  LINE(leaf(f, pl_poison()), "undefined");
}

int main(void) {
  const struct CMUnitTest tests[] = {
#define T(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
      T(names_carry_dots_and_indices),
      T(greek_letters_have_names),
      T(multipliers_keep_their_label),
      T(start_values_are_written_at_zero),
      T(elements_of_families_have_brackets),
      T(a_multiplier_in_all_manners),
      T(a_fraction_beside_a_factor),
      T(short_quotients_are_tight),
      T(a_product_after_a_division_needs_brackets),
      T(numbers_side_by_side_get_a_sign),
      T(minus_signs_stand_where_they_may),
      T(powers_bind_their_base),
      T(powers_of_functions_stand_at_the_name),
      T(functions_take_brackets_when_more_than_a_name_follows),
      T(roots_are_drawn),
      T(tall_brackets_are_drawn),
      T(height_and_base_line_are_told),
      T(exact_decimals_stay_decimal),
      T(measured_numbers_are_rounded_for_display),
      T(vectors_are_sums_along_unit_vectors),
      T(relations_and_names),
      T(derivatives_integrals_and_orders),
      T(words_follow_the_language),
      T(sums_over_an_index_and_cases),
      T(mathml_brackets_stretch_only_when_tall),
      T(mathml_prefix_minus_has_no_space),
      T(hollow_and_deep_forms_do_not_crash),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
