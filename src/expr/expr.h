// expr: the algebra of the house. A hash-consed DAG of immutable expressions: equal construction,
// equal handle.
//
// Constructors apply only what is always true and always wanted: exact numbers are folded, sums and
// products are flat and sorted, like terms and like factors are collected, x^0 = 1, (a^2)^3 = a^6,
// sqrt(9) = 3, sin(0) = 0, sin(-x) = -sin x, cos(pi/3) = 1/2. Nothing is expanded and nothing
// depends on assumptions. A failure (division by an exact zero, 0^-1, ...) gives the poison handle,
// id 0, which spreads like NaN.
#ifndef PL_EXPR_H
#define PL_EXPR_H

#include "base/base.h"

typedef struct pl_expr {
  uint32_t id;
} pl_expr;  // id 0 is poison
typedef struct pl_symbol {
  uint32_t id;
} pl_symbol;  // id 0 is "no symbol"
typedef struct pl_pool pl_pool;

// ----------------------------------------------------------------------------------------- symbols
typedef enum pl_role {
  PL_R_PARAM,         // given                                      m1, g, l
  PL_R_COORD,         // moves                                      x, θ
  PL_R_VELOCITY,      // first time derivative of a coordinate      x'
  PL_R_ACCELERATION,  // second                                     x''
  PL_R_TIME,          // t
  PL_R_MULTIPLIER,    // λ_g1
  PL_R_START,         // start value of a coordinate or velocity    x(0), x'(0)
  PL_R_MOMENTUM,      // conjugate momentum                         p_θ
  PL_R_CONSTANT,      // constant of a motion                       E, H, c1
  PL_R_INDEX,         // index of a family                          i
  PL_R_SMALL,         // introduced by series or limit              δm
  PL_R_LOCAL,         // named intermediate                         M in M(φ)
  PL_R_ARRAY          // name of a family of coordinates, only inside pl_at
} pl_role;

// What kind of quantity a name is: decides the order in which factors and terms are written (style
// rule K5).
typedef enum pl_class {
  PL_C_NUMBER,
  PL_C_MASS,
  PL_C_GRAVITY,
  PL_C_LENGTH,
  PL_C_OTHER,
  PL_C_TIME,
  PL_C_FUNCTION,
  PL_C_COORD,
  PL_C_VELOCITY,
  PL_C_ACCELERATION,
  PL_C_MULTIPLIER
} pl_class;

typedef enum pl_sign_known {
  PL_SIGN_ANY,
  PL_SIGN_POSITIVE,
  PL_SIGN_NONNEGATIVE,
  PL_SIGN_NEGATIVE,
  PL_SIGN_NONPOSITIVE,
  PL_SIGN_NONZERO
} pl_sign_known;

typedef struct pl_symbol_info {
  // as displayed, UTF-8, without dots: "ϑ", "m1", "λ"; velocities carry the coordinate's name
  const char* name;
  // unique in the pool, for expr in JSON, CSV and dumps: "theta", "lambda_g1", "x1_dot", "x1_ddot",
  // "x1_0"
  const char* ascii;
  pl_role role;
  pl_class class;
  pl_sign_known sign;      // assumed
  pl_dimension dimension;  // of the quantity
  bool dimension_known;
  bool torque;  // an energy by its dimension, but in N m
  int dots;     // 0, 1, 2 for coordinate, velocity, acceleration
  // of a velocity, acceleration or start value: its coordinate (for x'(0): the coordinate too)
  pl_symbol base;
  // of a coordinate or velocity: its time derivative; 0 if none was made yet
  pl_symbol up;
  // A number with its unit, `20 [kN/m]`, is a symbol of its own, so that formulas keep it as it was
  // written.
  pl_expr number;    // its exact value in SI; poison: the symbol is a name
  pl_expr written;   // the number in front of the unit
  const char* unit;  // the unit as displayed: "kN/m"
} pl_symbol_info;

// ------------------------------------------------------------------------------------------- nodes
typedef enum pl_kind {
  PL_POISON,    // spreads
  PL_NUMBER,    // exact rational
  PL_PI,        // π
  PL_INFINITY,  // +∞; only as the target of a limit and in answers
  PL_SYMBOL,
  PL_AT,    // element of a family: array symbol, dots, index expression: x[i-1]'
  PL_ADD,   // n-ary, at most one number, sorted
  PL_MUL,   // n-ary, at most one number, sorted
  PL_POW,   // base, exponent; sqrt(x) is x^(1/2)
  PL_CALL,  // function of 1 or 2 arguments
  // reserved for user functions that stay symbolic: U(r), and their derivatives
  PL_UNKNOWN_FUNCTION,
  PL_IF,  // condition lhs - rhs > 0 (arg 0), then, else
  PL_SUM  // sum over an index: index symbol as expr, lo, hi, body (kept as a pattern)
} pl_kind;

typedef enum pl_function {
#define PL_FUNCTION(name, ...) PL_##name,
#include "functions.def"
  PL_N_FUNCTIONS
} pl_function;

extern const char* const pl_function_name[PL_N_FUNCTIONS];
extern const char* const pl_function_tex[PL_N_FUNCTIONS];
extern const int pl_function_arity[PL_N_FUNCTIONS];

pl_pool* pl_pool_make(pl_arena* a);
pl_arena* pl_pool_arena(const pl_pool* p);
// The pool as it is now, for pl_eval in another thread while nodes are added to p.  Its scratch is
// its own; no nodes may be made in it.
const pl_pool* pl_pool_view(pl_arena* a, const pl_pool* p);

// Symbols.  pl_symbol_make returns the existing symbol when `ascii` is taken.
pl_symbol pl_symbol_make(pl_pool* p, const pl_symbol_info* info);
pl_symbol pl_symbol_find(const pl_pool* p, const char* ascii);  // 0 if absent
// may be written: dimension, sign
pl_symbol_info* pl_symbol_get(const pl_pool* p, pl_symbol s);
int pl_symbol_count(const pl_pool* p);  // ids run 1..count
// x -> x', x' -> x''; made when needed
pl_symbol pl_symbol_dot(pl_pool* p, pl_symbol s);
pl_symbol pl_symbol_start(pl_pool* p, pl_symbol s);  // x -> x(0), x' -> x'(0)
pl_symbol pl_time(pl_pool* p);                       // t
// The unit in which a quantity with this name is written: a multiplier that is an energy is the
// torque that turns an angle, in N m; so are given quantities that were found to be torques.
const char* pl_unit_of_symbol(pl_arena* a, const pl_pool* p, pl_symbol s, pl_dimension d,
                              bool ascii);
bool pl_is_measure(const pl_pool* p, pl_expr e);  // e is a number with its unit
// each number with its unit replaced by its value in SI
pl_expr pl_without_measures(pl_pool* p, pl_expr e);

// Construction
static inline pl_expr pl_poison(void) { return (pl_expr){0}; }
pl_expr pl_int(pl_pool* p, long n);
pl_expr pl_ratio(pl_pool* p, long num, long den);
// "9.81", "1e-3", "3/4": exact
pl_expr pl_number_from_text(pl_pool* p, const char* decimal, size_t n);
pl_expr pl_pi(pl_pool* p);
pl_expr pl_infinity(pl_pool* p);
pl_expr pl_sym(pl_pool* p, pl_symbol s);
pl_expr pl_at(pl_pool* p, pl_symbol array, int dots, pl_expr index);
pl_expr pl_add(pl_pool* p, pl_expr a, pl_expr b);
pl_expr pl_add_n(pl_pool* p, const pl_expr* terms, int n);
pl_expr pl_sub(pl_pool* p, pl_expr a, pl_expr b);
pl_expr pl_neg(pl_pool* p, pl_expr a);
pl_expr pl_mul(pl_pool* p, pl_expr a, pl_expr b);
pl_expr pl_mul_n(pl_pool* p, const pl_expr* factors, int n);
pl_expr pl_div(pl_pool* p, pl_expr a, pl_expr b);
pl_expr pl_pow(pl_pool* p, pl_expr base, pl_expr exponent);
pl_expr pl_pow_int(pl_pool* p, pl_expr base, long n);
pl_expr pl_square(pl_pool* p, pl_expr a);
pl_expr pl_sqrt(pl_pool* p, pl_expr a);
pl_expr pl_call(pl_pool* p, pl_function f, pl_expr a);
pl_expr pl_call_slope(pl_pool* p, pl_expr e);  // f'(a) of e = f(a)
pl_expr pl_call2(pl_pool* p, pl_function f, pl_expr a, pl_expr b);
pl_expr pl_if(pl_pool* p, pl_expr positive, pl_expr then, pl_expr otherwise);
pl_expr pl_sum_over(pl_pool* p, pl_symbol index, pl_expr lo, pl_expr hi, pl_expr body);

// Inspection
pl_kind pl_kind_of(const pl_pool* p, pl_expr e);
int pl_n_args(const pl_pool* p, pl_expr e);
pl_expr pl_arg(const pl_pool* p, pl_expr e, int i);
pl_function pl_function_of(const pl_pool* p, pl_expr e);  // of a PL_CALL
pl_symbol pl_symbol_of(const pl_pool* p, pl_expr e);      // of a PL_SYMBOL, PL_AT or PL_SUM
int pl_dots_of(const pl_pool* p, pl_expr e);              // of a PL_AT
bool pl_same(pl_expr a, pl_expr b);                       // same handle
bool pl_is_poison(pl_expr e);
bool pl_is_number(const pl_pool* p, pl_expr e);
bool pl_is_zero_node(const pl_pool* p, pl_expr e);  // the number 0
bool pl_is_one_node(const pl_pool* p, pl_expr e);
// an integer that fits; value may be NULL
bool pl_is_int(const pl_pool* p, pl_expr e, long* value);
bool pl_is_ratio(const pl_pool* p, pl_expr e, long* num, long* den);
int pl_number_sign(const pl_pool* p, pl_expr e);  // of a PL_NUMBER
double pl_number_double(const pl_pool* p, pl_expr e);
// A number as a sum of three doubles, each the nearest to what those before leave: 159 bits or
// more.
void pl_number_doubles(const pl_pool* p, pl_expr e, double out[3]);
const char* pl_number_text(pl_arena* a, const pl_pool* p, pl_expr e);  // "3", "-3/4", exact
// numerator in decimal, with sign
const char* pl_number_num_text(pl_arena* a, const pl_pool* p, pl_expr e);
// denominator in decimal
const char* pl_number_den_text(pl_arena* a, const pl_pool* p, pl_expr e);
bool pl_is_sqrt(const pl_pool* p, pl_expr e);  // PL_POW with exponent 1/2
bool pl_has_symbol(const pl_pool* p, pl_expr e, pl_symbol s);
// some symbol (or PL_AT element) of that role occurs
bool pl_has_role(const pl_pool* p, pl_expr e, pl_role r);
bool pl_is_constant(const pl_pool* p, pl_expr e);  // no symbol at all
// Symbols that occur in e, each once, in order of id.  Returns how many; out may be NULL to count.
int pl_symbols_in(const pl_pool* p, pl_expr e, pl_symbol* out, int max);
long pl_dag_size(const pl_pool* p, pl_expr e);  // distinct nodes
// operators and calls in the tree as written, n-ary sums n-1
long pl_op_count(const pl_pool* p, pl_expr e);

// Calculus
pl_expr pl_diff(pl_pool* p, pl_expr e, pl_symbol x);  // partial derivative
// with respect to a PL_AT element, as an atom
pl_expr pl_diff_at(pl_pool* p, pl_expr e, pl_expr element);
// total time derivative: x -> x', x' -> x'', explicit t, elements of families too
pl_expr pl_dt(pl_pool* p, pl_expr e);

// Substitution, all at once (not one after the other).
typedef struct pl_replace {
  pl_symbol from;
  pl_expr to;
} pl_replace;
pl_expr pl_subst(pl_pool* p, pl_expr e, const pl_replace* r, int n);
pl_expr pl_subst1(pl_pool* p, pl_expr e, pl_symbol from, pl_expr to);
// every occurrence of the very node
pl_expr pl_subst_expr(pl_pool* p, pl_expr e, pl_expr from, pl_expr to);
// Multiplies out products of sums and integer powers of sums up to max_terms; beyond it e is
// returned unchanged.
pl_expr pl_expand(pl_pool* p, pl_expr e, int max_terms);

// -------------------------------------------------------------------------------------- evaluation
// Values by symbol id; NaN where unknown.  Result NaN outside the domain.
double pl_eval(const pl_pool* p, pl_expr e, const double* value_of_symbol);
// The size of the terms of e: what the rounding error of pl_eval is relative to.
double pl_eval_terms(const pl_pool* p, pl_expr e, const double* value_of_symbol);

// Modulo P, a prime just below 2^61. sin and cos through t = tan(x/2) with one residue per angle
// base; of the two square roots always the one that is a square itself, so sqrt(a) sqrt(b) = sqrt(a
// b). ok = false when the point is bad (division by zero, no root): take another. Why this prime:
// modular.c; what a value tells: evaluate_mod.c.
#define PL_MOD_P 2305833743229868799ull  // 2^61 - 9265983825153
typedef struct pl_mod_point pl_mod_point;
// random residues for all symbols
pl_mod_point* pl_mod_point_make(pl_arena* a, const pl_pool* p, uint64_t seed);
uint64_t pl_eval_mod(pl_mod_point* m, pl_expr e, bool* ok);
// e.g. accelerations found by a solve
void pl_mod_point_set(pl_mod_point* m, pl_symbol s, uint64_t value);
uint64_t pl_mod_mul(uint64_t a, uint64_t b);
uint64_t pl_mod_add(uint64_t a, uint64_t b);
uint64_t pl_mod_inv(uint64_t a);

// ------------------------------------------------------------------------------- text for machines
// ASCII with explicit *, ^, brackets and calls, names as in pl_symbol_info.ascii: the `expr` of the
// JSON contract. Parses back with the model language. Deterministic.
const char* pl_expr_text(pl_arena* a, const pl_pool* p, pl_expr e);

// ------------------------------------------------------------------------------------------- forms
// A form is an expression or statement as it is to be written: n-ary, ordered, nothing simplified.
// It is what presentation produces and notation prints; pl_form_value gives back the expression for
// certification.
typedef enum pl_form_kind {
  PL_F_EXPR,       // a leaf: number, π, ∞, symbol or element            .expr
  PL_F_SUM,        // terms; a term may be PL_F_NEG                      .args
  PL_F_NEG,        // -x                                                 1
  PL_F_PRODUCT,    // factors in the order written                       .args
  PL_F_QUOTIENT,   // numerator, denominator                             2
  PL_F_POWER,      // base, exponent                                     2
  PL_F_ROOT,       // square root                                        1
  PL_F_CALL,       // function                                           .function, .args
  PL_F_GROUP,      // explicit brackets around one form                  1
  PL_F_PLUSMINUS,  // a ± b                                              2; b only if 1
  // lhs op rhs                               .text is "=", "≥", "≤", "≠", "->", "<", ">", "≈"; 2
  PL_F_RELATION,
  // sum of component times unit vector                 .args components, .names e_x ...
  PL_F_VECTOR,
  // a name that is not a symbol: "T", "Z", "M(φ)", "E", "e_r"   .text (UTF-8), .expr its value
  PL_F_NAME,
  PL_F_DERIVATIVE,  // d .args[0] / d .expr, kept as such: diff(M, φ)     1
  PL_F_INTEGRAL,    // ∫ .args[0] d .expr                                 1
  PL_F_ORDER,       // O(.args[0])                                        1
  PL_F_LIST,        // forms separated by commas                          .args
  PL_F_TEXT         // words inside a formula, by language                .words
} pl_form_kind;

typedef struct pl_form pl_form;
struct pl_form {
  pl_form_kind kind;
  pl_expr expr;
  pl_function function;
  int n;
  const pl_form* const* args;  // (n)
  const char* text;
  const char* const* names;  // unit vectors of PL_F_VECTOR, as "e_x"  (n)
  const char* words[2];
};

pl_form* pl_form_make(pl_arena* a, pl_form_kind k, int n, const pl_form* const* args);
pl_form* pl_form_leaf(pl_arena* a, pl_expr e);
pl_form* pl_form_sum(pl_arena* a, const pl_form* const* terms, int n);
pl_form* pl_form_product(pl_arena* a, const pl_form* const* factors, int n);
pl_form* pl_form_neg(pl_arena* a, const pl_form* x);
pl_form* pl_form_quotient(pl_arena* a, const pl_form* num, const pl_form* den);
// a sum that begins without a minus, if it can
const pl_form* pl_form_positive_first(pl_arena* a, const pl_form* f);
pl_form* pl_form_power(pl_arena* a, const pl_form* base, const pl_form* exponent);
pl_form* pl_form_root(pl_arena* a, const pl_form* x);
pl_form* pl_form_call(pl_arena* a, pl_function f, const pl_form* const* args, int n);
pl_form* pl_form_relation(pl_arena* a, const pl_form* lhs, const char* op, const pl_form* rhs);
pl_form* pl_form_name(pl_arena* a, const char* text, pl_expr value);
pl_form* pl_form_vector(pl_arena* a, const pl_form* const* components,
                        const char* const* unit_vectors, int n);
pl_form* pl_form_words(pl_arena* a, const char* en, const char* de);
// The plain form of an expression, in the order of style rule K5 (number, masses, g, lengths,
// functions, velocities; indices ascending), -1 and 1/2 and negative powers turned into minus signs
// and fractions. No algebra is done.
pl_form* pl_form_of(pl_arena* a, pl_pool* p, pl_expr e);
// The expression that a form writes; poison for relations, lists, vectors, words.
pl_expr pl_form_value(pl_pool* p, const pl_form* f);
long pl_form_ops(const pl_form* f);  // operators and calls, n-ary sums and products n-1
// Order of factors and terms, rule K5: <0, 0, >0.
int pl_symbol_compare(const pl_pool* p, pl_symbol a, pl_symbol b);

#endif
