// units: what a unit is called and means, and the algebra of dimensions that are not yet known.
#ifndef PL_UNITS_H
#define PL_UNITS_H

#include "expr/expr.h"

// ----------------------------------------------------------------------------------------- units.c
// A unit as written. `factor` is what a number in front of the unit is multiplied by: the exact
// factor to SI times the SI base units as symbols ("[m]", "[kg]", ...), so that `1 [m] + 2 [s]` is
// still seen to be wrong after the constructors have sorted it. pl_model_check puts 1 for these
// symbols everywhere in the model; pl_unit_to_si does it for one expression. `scale` is the plain
// exact number. deg, rpm, min, bar, prefixes: units/units.def.
typedef struct pl_unit {
  pl_expr factor;
  pl_dimension dimension;
  bool is_angle;
  pl_expr scale;
} pl_unit;
// e with every unit symbol replaced by 1, every number with a unit by its value
pl_expr pl_unit_to_si(pl_pool* p, pl_expr e);
// some unit symbol or number with a unit occurs in e
bool pl_unit_occurs(const pl_pool* p, pl_expr e);
// A number with its unit as a symbol (pl_symbol_info.number) that displays as written, `text` being
// the unit. Equal quantities are one symbol. Zero and pure numbers stay numbers, a negative one is
// minus the symbol.
pl_expr pl_measure_make(pl_pool* p, pl_expr number, const pl_unit* unit, const char* text);
// 0.5 m + 20 cm as one, 0.7 m; e itself if it has names in it
pl_expr pl_measure_join(pl_pool* p, pl_expr e);
// pl_unit_parse reads "m/s^2", "kN m", "m²/s". On failure false, with the offending part in *bad
// (offset, length) and the nearest known unit in *near (may be NULL).
bool pl_unit_parse(pl_pool* p, const char* text, size_t n, pl_unit* out, size_t* bad_at,
                   size_t* bad_n, const char** near);

// pl_unit_name gives the i-th unit without its prefixes, NULL behind the last.
const char* pl_unit_name(int i);

// pl_unit_explain answers `pleuel units m/s`: dimension, factor to SI, and what fits; or what is
// wrong and near names.
const char* pl_unit_explain(pl_arena* a, pl_pool* p, const char* text, pl_language lang);
// The nearest unit to a word: a known spelling, or one within two typing errors. NULL if nothing is
// near.
const char* pl_unit_near(pl_arena* a, const char* word, size_t n);
bool pl_unit_is_symbol(const pl_pool* p, pl_symbol s);  // a base unit, or a number with its unit
pl_expr pl_unit_drop(pl_pool* p, pl_expr e);

// ------------------------------------------------------------------------------------- exponents.c
// lowest terms, den > 0; den 0: overflow
typedef struct pl_fraction {
  int64_t num, den;
} pl_fraction;
// of m kg s A K mol cd
typedef struct pl_exponents {
  pl_fraction e[PL_N_BASE_UNITS];
} pl_exponents;
bool pl_fraction_valid(pl_fraction a);
pl_fraction pl_fraction_make(int64_t num, int64_t den);
pl_fraction pl_fraction_add(pl_fraction a, pl_fraction b);
pl_fraction pl_fraction_mul(pl_fraction a, pl_fraction b);
pl_fraction pl_fraction_div(pl_fraction a, pl_fraction b);
pl_exponents pl_exponents_zero(void);
pl_exponents pl_exponents_add(pl_exponents a, pl_fraction f, pl_exponents b);  // a + f b
bool pl_exponents_are_zero(pl_exponents a);
pl_exponents pl_exponents_of(pl_dimension d);
// false: too large for pl_dimension
bool pl_exponents_get_dimension(pl_exponents a, pl_dimension* out);

// ------------------------------------------------------------------------------ dimension_system.c
// The dimension of something that is not yet known: fixed exponents plus rational multiples of
// unknown dimensions.
typedef struct pl_dim_part {
  int var;
  pl_fraction f;
} pl_dim_part;
typedef struct pl_dim_form {
  pl_exponents fixed;
  int n;
  pl_dim_part* part;  // by rising var, no zero factors                              (n)
} pl_dim_form;

typedef enum pl_dim_var_kind { PL_DIM_SYMBOL, PL_DIM_NUMBER, PL_DIM_ENERGY } pl_dim_var_kind;
typedef struct pl_dim_var {
  pl_dim_var_kind kind;
  pl_symbol symbol;  // PL_DIM_SYMBOL
  pl_expr number;    // PL_DIM_NUMBER: a bare number
  pl_span span;      // where it is declared, or where the number stands
  bool declared;     // its unit is written down
  bool solved;
  bool tainted;              // took part in a conflict: later ones are echoes
  const pl_dim_form* row;    // solved: what it equals, shortened as more gets known
  const pl_dim_form* first;  // solved: the same as first found
  pl_span reason;            // solved: the statement that settled it
} pl_dim_var;

typedef struct pl_dim_system {
  pl_arena* arena;
  PL_VEC(pl_dim_var) vars;
} pl_dim_system;

int pl_dim_var_add(pl_dim_system* s, pl_dim_var_kind kind);
const pl_dim_form* pl_dim_fixed(pl_dim_system* s, pl_exponents d);
const pl_dim_form* pl_dim_unknown(pl_dim_system* s, int var);
const pl_dim_form* pl_dim_combine(pl_dim_system* s, const pl_dim_form* a, pl_fraction f,
                                  const pl_dim_form* b);  // a B^f
// Makes a and b equal.  false: they cannot be.
bool pl_dim_unify(pl_dim_system* s, const pl_dim_form* a, const pl_dim_form* b, pl_span reason);
// resolves; false: still unknown
bool pl_dim_known(pl_dim_system* s, const pl_dim_form* a, pl_dimension* out);

#endif
