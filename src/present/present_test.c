// The table of the symbolic design beside the textbook: what presentation makes of the quantities
// of the founding sheet and of classic systems, and that it never costs more operations than listed
// there.
#include "present/present.h"

#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct fixture {
  pl_arena* a;
  pl_pool* p;
  pl_job* job;
  pl_diagnostics diagnostics;
  pl_tower* t;
} fixture;

static int set_up(void** state) {
  pl_arena* a = pl_arena_make(NULL);
  fixture* f = PL_NEW(a, fixture);
  f->a = a;
  f->p = pl_pool_make(a);
  f->diagnostics.arena = a;
  f->job = PL_NEW(a, pl_job);
  f->job->arena = a;
  f->job->diagnostics = &f->diagnostics;
  f->t = pl_tower_make(f->job, f->p, NULL, 0);
  *state = f;
  return 0;
}

static int tear_down(void** state) {
  fixture* f = *state;
  pl_tower_free(f->t);
  pl_arena_free(f->a);
  return 0;
}

// -------------------------------------------------------------------------------- reading formulas
// Names say what they are: m.. masses, g gravity, l r R lengths, a b th.. phi psi x y z
// coordinates, others parameters; p_.. momenta, t time, primes velocities and accelerations.
static pl_symbol symbol_of(fixture* f, const char* name) {
  if (strcmp(name, "t") == 0) return pl_time(f->p);
  static const char* const coords[] = {"a", "b",  "th", "th0", "phi", "psi", "x",  "y",
                                       "z", "a1", "a2", "a3",  "x1",  "x2",  "rho"};
  pl_symbol_info i = {.name = name,
                      .ascii = name,
                      .role = PL_R_PARAM,
                      .class = PL_C_OTHER,
                      .sign = PL_SIGN_POSITIVE};
  if (name[0] == 'm') i.class = PL_C_MASS;
  if (strcmp(name, "g") == 0) i.class = PL_C_GRAVITY;
  if (name[0] == 'l' || name[0] == 'r' || name[0] == 'R') i.class = PL_C_LENGTH;
  if (strncmp(name, "p_", 2) == 0) {
    i.role = PL_R_MOMENTUM;
    i.sign = PL_SIGN_ANY;
  }
  for (size_t k = 0; k < sizeof coords / sizeof *coords; k++)
    if (strcmp(name, coords[k]) == 0) {
      i.role = PL_R_COORD;
      i.class = PL_C_COORD;
      i.sign = PL_SIGN_ANY;
    }
  return pl_symbol_make(f->p, &i);
}

typedef struct reader {
  fixture* f;
  const char* s;
} reader;
static pl_expr read_sum(reader* r);

static void blanks(reader* r) {
  while (*r->s == ' ') r->s++;
}

static pl_expr read_call(reader* r, const char* name) {
  pl_pool* p = r->f->p;
  r->s++;
  pl_expr x = read_sum(r);
  blanks(r);
  assert_int_equal(*r->s, ')');
  r->s++;
  if (strcmp(name, "sqrt") == 0) return pl_sqrt(p, x);
  for (int i = 0; i < PL_N_FUNCTIONS; i++)
    if (strcmp(pl_function_name[i], name) == 0) return pl_call(p, (pl_function)i, x);
  fail_msg("no function %s", name);
  return x;
}

static pl_expr read_atom(reader* r) {
  pl_pool* p = r->f->p;
  blanks(r);
  const char* begin = r->s;
  if (*r->s == '(') {
    r->s++;
    pl_expr x = read_sum(r);
    blanks(r);
    assert_int_equal(*r->s, ')');
    r->s++;
    return x;
  }
  if (isdigit((unsigned char)*r->s)) {
    while (isdigit((unsigned char)*r->s) || *r->s == '.') r->s++;
    return pl_number_from_text(p, begin, (size_t)(r->s - begin));
  }
  while (isalnum((unsigned char)*r->s) || *r->s == '_') r->s++;
  const char* name = pl_copy_n(r->f->a, begin, (size_t)(r->s - begin));
  if (*r->s == '(' && !isdigit((unsigned char)name[strlen(name) - 1])) return read_call(r, name);
  pl_symbol x = symbol_of(r->f, name);
  for (; *r->s == '\''; r->s++) x = pl_symbol_dot(p, x);
  return pl_sym(p, x);
}

static pl_expr read_power(reader* r) {
  pl_expr x = read_atom(r);
  blanks(r);
  if (*r->s != '^') return x;
  r->s++;
  return pl_pow(r->f->p, x, read_atom(r));
}

static pl_expr read_product(reader* r) {
  pl_expr x = read_power(r);
  for (blanks(r); *r->s == '*' || *r->s == '/'; blanks(r)) {
    char op = *r->s++;
    pl_expr y = read_power(r);
    x = op == '*' ? pl_mul(r->f->p, x, y) : pl_div(r->f->p, x, y);
  }
  return x;
}

static pl_expr read_sum(reader* r) {
  blanks(r);
  bool minus = *r->s == '-';
  if (minus) r->s++;
  pl_expr x = read_product(r);
  if (minus) x = pl_neg(r->f->p, x);
  for (blanks(r); *r->s == '+' || *r->s == '-'; blanks(r)) {
    char op = *r->s++;
    pl_expr y = read_product(r);
    x = op == '+' ? pl_add(r->f->p, x, y) : pl_sub(r->f->p, x, y);
  }
  return x;
}

static pl_expr formula(fixture* f, const char* text) {
  reader r = {f, text};
  pl_expr e = read_sum(&r);
  assert_int_equal(*r.s, 0);
  return e;
}

// ----------------------------------------------------------------------------------- writing forms
static void write_form(fixture* f, pl_text* out, const pl_form* x, int level);

static void write_list(fixture* f, pl_text* out, const pl_form* x, const char* between, int level) {
  for (int i = 0; i < x->n; i++) {
    if (i) pl_text_add(out, between);
    write_form(f, out, x->args[i], level);
  }
}

static void write_sum(fixture* f, pl_text* out, const pl_form* x) {
  for (int i = 0; i < x->n; i++) {
    const pl_form* term = x->args[i];
    bool minus = term->kind == PL_F_NEG;
    if (minus) term = term->args[0];
    pl_text_add(out, i ? (minus ? " - " : " + ") : (minus ? "-" : ""));
    write_form(f, out, term, 2);
  }
}

// level: 1 anything may stand here, 2 a term, 3 a factor, 4 the base of a power or a divisor
static void write_form(fixture* f, pl_text* out, const pl_form* x, int level) {
  int own = x->kind == PL_F_SUM || x->kind == PL_F_NEG            ? 1
            : x->kind == PL_F_PRODUCT || x->kind == PL_F_QUOTIENT ? 2
            : x->kind == PL_F_POWER                               ? 3
                                                                  : 4;
  bool half = x->kind == PL_F_QUOTIENT && level == 3 && x->args[1]->kind == PL_F_EXPR
              && pl_is_number(f->p, x->args[1]->expr);
  bool bracket = own < level && !half;
  if (bracket) pl_text_add(out, "(");
  switch (x->kind) {
    case PL_F_SUM: write_sum(f, out, x); break;
    case PL_F_NEG:
      pl_text_add(out, "-");
      write_form(f, out, x->args[0], 2);
      break;
    case PL_F_PRODUCT: write_list(f, out, x, " ", 3); break;
    case PL_F_QUOTIENT:
      write_form(f, out, x->args[0], 2);
      pl_text_add(out, "/");
      write_form(f, out, x->args[1], 3);
      break;
    case PL_F_POWER:
      write_form(f, out, x->args[0], 4);
      pl_text_add(out, "^");
      write_form(f, out, x->args[1], 4);
      break;
    case PL_F_ROOT:
      pl_text_add(out, "sqrt(");
      write_form(f, out, x->args[0], 1);
      pl_text_add(out, ")");
      break;
    case PL_F_CALL:
      pl_text_addf(out, "%s(", pl_function_name[x->function]);
      write_list(f, out, x, ", ", 1);
      pl_text_add(out, ")");
      break;
    default: {
      pl_symbol s = pl_kind_of(f->p, x->expr) == PL_SYMBOL ? pl_symbol_of(f->p, x->expr)
                                                           : (pl_symbol){0};
      if (s.id) {
        pl_text_add(out, pl_symbol_get(f->p, s)->name);
        for (int i = 0; i < pl_symbol_get(f->p, s)->dots; i++) pl_text_add(out, "'");
      } else {
        pl_text_add(out, pl_expr_text(f->a, f->p, x->expr));
      }
    }
  }
  if (bracket) pl_text_add(out, ")");
}

static const char* text_of(fixture* f, const pl_form* x) {
  pl_text t = pl_text_make(f->a);
  write_form(f, &t, x, 1);
  return pl_text_string(&t);
}

static const pl_form* presented(fixture* f, const char* from, pl_style style) {
  pl_expr e = formula(f, from);
  const pl_form* x = pl_present(f->t, e, style, 0.02);
  assert_int_equal(pl_alg_equal(f->t, pl_form_value(f->p, x), e), PL_YES);
  return x;
}

#define PRESENTS(style, from, to) assert_string_equal(text_of(f, presented(f, from, style)), to)

// ------------------------------------------------------------------------------------------ atwood
static void atwood_quotients(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "-2*g/(1/m1 + 1/m2)", "-2 m1 m2 g/(m1 + m2)");
  PRESENTS(PL_S_QUOTIENT, "g - 2*m2*g/(m1 + m2)", "(m1 - m2) g/(m1 + m2)");
  PRESENTS(PL_S_SOLUTION, "(m1 - m2)*g/(m1 + m2)*t^2/2 + v0*t + c",
           "c + v0 t + (m1 - m2) g t^2/(2 (m1 + m2))");
  PRESENTS(PL_S_ENERGY, "1/2*m1*x'^2 + 1/2*m2*x'^2 - m1*g*x - m2*g*(l - x)",
           "1/2 (m1 + m2) x'^2 - m1 g x - m2 g (l - x)");
}

// ------------------------------------------------------------------------------------ slider-crank
static const char* const slider =
    "(-r*phi'*sin(phi) + r^2*sin(phi)*cos(phi)*phi'/sqrt(l^2 - r^2*sin(phi)^2))";

static void crank_energy_keeps_the_square(void** state) {
  fixture* f = *state;
  const char* T = pl_format(f->a, "1/2*m1*r^2*phi'^2 + 1/2*m2*%s^2 - m1*g*r*sin(phi)", slider);
  PRESENTS(PL_S_ENERGY, T,
           "m1/2 r^2 phi'^2 + m2/2 r^2 phi'^2 sin(phi)^2 (1 - r cos(phi)/sqrt(l^2 - r^2 "
           "sin(phi)^2))^2 - m1 g r sin(phi)");
}

static void crank_velocity(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_PLAIN, slider, "-r phi' sin(phi) (1 - r cos(phi)/sqrt(l^2 - r^2 sin(phi)^2))");
}

static void crank_inertia(void** state) {
  fixture* f = *state;
  const char* M = pl_format(f->a, "m1*r^2 + m2*%s^2/phi'^2", slider);
  PRESENTS(PL_S_ENERGY, M,
           "m1 r^2 + m2 r^2 sin(phi)^2 (1 - r cos(phi)/sqrt(l^2 - r^2 sin(phi)^2))^2");
}

static void crank_small_oscillations(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "m1*g*r/(m1*r^2 + m2*r^2)", "m1 g/((m1 + m2) r)");
}

// ------------------------------------------------------------------------------------------- skier
static void skier_forces(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "m*g*cos(th) - 2*m*g*(1 - cos(th))", "m g (3 cos(th) - 2)");
  PRESENTS(PL_S_QUOTIENT, "m*(g*cos(th) - R*th'^2)", "m g cos(th) - m R th'^2");
  PRESENTS(PL_S_QUOTIENT, "2*g/R - 2*g*cos(th)/R", "2 g (1 - cos(th))/R");
}

static void skier_energy(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_ENERGY, "m*R*(R*th'^2 - 2*g*cos(th))/2", "1/2 m R^2 th'^2 - m g R cos(th)");
  PRESENTS(PL_S_ENERGY, "m*R^2*(th'^2 - w^2*sin(th)^2)/2",
           "1/2 m R^2 th'^2 - 1/2 m R^2 w^2 sin(th)^2");
}

// --------------------------------------------------------------------------------- double pendulum
static void double_pendulum_energy(void** state) {
  fixture* f = *state;
  const char* T =
      "1/2*m1*l1^2*a'^2 + 1/2*m2*((l1*a'*cos(a) + l2*b'*cos(b))^2 + (l1*a'*sin(a) + "
      "l2*b'*sin(b))^2)";
  PRESENTS(PL_S_ENERGY, T,
           "1/2 (m1 + m2) l1^2 a'^2 + 1/2 m2 l2^2 b'^2 + m2 l1 l2 a' b' cos(a - b)");
  PRESENTS(PL_S_ENERGY, "-m1*g*l1*cos(a) - m2*g*(l1*cos(a) + l2*cos(b))",
           "-(m1 + m2) g l1 cos(a) - m2 g l2 cos(b)");
}

static void double_pendulum_acceleration(void** state) {
  fixture* f = *state;
  // solution of the two equations by Cramer's rule, as the linear solver hands it over
  const char* num =
      "(m2*l1*l2*sin(a - b)*b'^2 + (m1 + m2)*g*l1*sin(a))*m2*l2^2"
      " - m2*l1*l2*cos(a - b)*(-m2*l1*l2*sin(a - b)*a'^2 + m2*g*l2*sin(b))";
  const char* den = "((m1 + m2)*l1^2*m2*l2^2 - (m2*l1*l2*cos(a - b))^2)";
  const pl_form* x = presented(f, pl_format(f->a, "-(%s)/%s", num, den), PL_S_QUOTIENT);
  if (pl_form_ops(x) > 35) fail_msg("%ld operations: %s", pl_form_ops(x), text_of(f, x));
}

static void double_pendulum_modes(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "(2 + sqrt(2))*g/l", "(2 + sqrt(2)) g/l");
  PRESENTS(PL_S_QUOTIENT, "(2 - sqrt(2))*g/l", "(2 - sqrt(2)) g/l");
}

// ------------------------------------------------------------------------------------------ others
static void cart_with_pendulum(void** state) {
  fixture* f = *state;
  symbol_of(f, "x");
  PRESENTS(PL_S_QUOTIENT, "-m2*sin(th)*(l*th'^2 + g*cos(th))/(-m2*sin(th)^2 - m1)",
           "m2 sin(th) (l th'^2 + g cos(th))/(m1 + m2 sin(th)^2)");
  PRESENTS(PL_S_QUOTIENT, "(m2*l*sin(th)*th'^2 + m2*g*sin(th)*cos(th))/(m1 + m2 - m2*cos(th)^2)",
           "m2 sin(th) (l th'^2 + g cos(th))/(m1 + m2 sin(th)^2)");
  PRESENTS(PL_S_ENERGY, "m1*x' + m2*x' + m2*l*cos(th)*th'", "(m1 + m2) x' + m2 l th' cos(th)");
}

static void hoop(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "w^2*sin(th)*cos(th) - g*sin(th)/R", "sin(th) (R w^2 cos(th) - g)/R");
}

static void spherical_pendulum_hamiltonian(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_ENERGY, "(sin(th)^2*p_th^2 + p_phi^2)/(2*m*l^2*sin(th)^2) - m*g*l*cos(th)",
           "p_th^2/(2 m l^2) + p_phi^2/(2 m l^2 sin(th)^2) - m g l cos(th)");
}

static void elastic_pendulum(void** state) {
  fixture* f = *state;
  const pl_form* x = presented(f, "rho*th'^2 + g*cos(th) + k*(l0 - rho)/m", PL_S_QUOTIENT);
  assert_string_equal(text_of(f, x), "rho th'^2 + g cos(th) + k (l0 - rho)/m");
  PRESENTS(PL_S_ENERGY, "m/2*(rho'^2 + rho^2*th'^2) - k/2*(rho - l0)^2 + m*g*rho*cos(th)",
           "1/2 m rho'^2 + 1/2 m rho^2 th'^2 + m g rho cos(th) - 1/2 k (l0 - rho)^2");
}

static void triple_pendulum_determinant(void** state) {
  fixture* f = *state;
  const pl_form* x = presented(f, "m2*sin(a1 - a2)^2*(m2 + m3) + m1*m3*sin(a2 - a3)^2 + m1*m2",
                               PL_S_PLAIN);
  assert_in_range(pl_form_ops(x), 1, 22);
}

static void multiples_of_angles(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_PLAIN, "sin(a - b)*cos(a - b)*2*l", "l sin(2 (a - b))");
  PRESENTS(PL_S_PLAIN, "cos(a)*cos(b) + sin(a)*sin(b)", "cos(a - b)");
  PRESENTS(PL_S_PLAIN, "cos(th)^2 - 1", "-sin(th)^2");
  PRESENTS(PL_S_PLAIN, "(1 - cos(th)^2)*l", "l sin(th)^2");
  PRESENTS(PL_S_PLAIN, "g*sin(th)/cos(th)", "g tan(th)");
}

static void fractions_stand_where_they_are_read_once(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "2*sin(th)/3", "2/3 sin(th)");
  PRESENTS(PL_S_QUOTIENT, "m*g*cos(th)/2", "1/2 m g cos(th)");
  PRESENTS(PL_S_QUOTIENT, "m*x^2/2", "m x^2/2");
  PRESENTS(PL_S_EQUATION, "m*l^2/12*th'' + m*g*l/2*cos(th)", "1/12 m l^2 th'' + 1/2 m g l cos(th)");
}

static void roots_come_together(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "sqrt(g/l)", "sqrt(g/l)");
  PRESENTS(PL_S_QUOTIENT, "sqrt(l)*sqrt(g)*th", "sqrt(g l) th");
}

static void distances_are_seen(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "m*((x1' - x2')^2 + (y' - z')^2)/(2*(x1 - x2)^2 + 2*(y - z)^2)",
           "m ((x1' - x2')^2 + (y' - z')^2)/(2 ((x1 - x2)^2 + (y - z)^2))");
  PRESENTS(PL_S_EQUATION,
           "2*(x1 - x2)*(x1'' - x2'') + 2*(y - z)*(y'' - z'') + 2*(x1' - x2')^2 + 2*(y' - z')^2",
           "2 (x1 - x2) (x1'' - x2'') + 2 (y - z) (y'' - z'') + 2 (x1' - x2')^2 + 2 (y' - z')^2");
}

static void symbols_go_under_the_root(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_QUOTIENT, "sqrt(l*(m*g + 2*l*k)/m)*x/l", "sqrt((m g + 2 l k)/(m l)) x");
  PRESENTS(PL_S_QUOTIENT, "2*p*l/sqrt(g*l)", "2 sqrt(l/g) p");
}

static void zero_and_numbers(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_PLAIN, "sin(a)^2 + cos(a)^2 - 1", "0");
  PRESENTS(PL_S_ENERGY, "sin(a)^2 + cos(a)^2", "1");
  PRESENTS(PL_S_EQUATION, "m*x'' + k*x", "m x'' + k x");
}

static void equations_are_ordered_by_derivatives(void** state) {
  fixture* f = *state;
  PRESENTS(PL_S_EQUATION,
           "-m2*l1*l2*sin(a - b)*a'^2 + m2*l2^2*b'' + m2*g*l2*sin(b) + m2*l1*l2*cos(a - b)*a''",
           "m2 l1 l2 a'' cos(a - b) + m2 l2^2 b'' - m2 l1 l2 a'^2 sin(a - b) + m2 g l2 sin(b)");
}

// ----------------------------------------------------------------------------------- whole systems
// Accelerations of a Lagrange function by the second kind, solved and presented; the sum of their
// operations.
static long operations(fixture* f, const char* lagrangian, const char* const* coords, int n,
                       double seconds) {
  pl_pool* p = f->p;
  pl_expr L = formula(f, lagrangian), A[16], b[4], x[4];
  assert_in_range(n, 1, 4);
  pl_symbol q[4], v[4], a[4];
  for (int i = 0; i < n; i++) {
    q[i] = symbol_of(f, coords[i]);
    v[i] = pl_symbol_dot(p, q[i]);
    a[i] = pl_symbol_dot(p, v[i]);
  }
  for (int i = 0; i < n; i++) {
    pl_expr e = pl_sub(p, pl_dt(p, pl_diff(p, L, v[i])), pl_diff(p, L, q[i]));
    for (int k = 0; k < n; k++) A[i * n + k] = pl_diff(p, e, a[k]);
    for (int k = 0; k < n; k++) e = pl_subst1(p, e, a[k], pl_int(p, 0));
    b[i] = pl_neg(p, e);
  }
  assert_int_equal(pl_alg_solve(f->t, n, A, b, x, 20000), PL_YES);
  long ops = 0;
  for (int i = 0; i < n; i++) {
    const pl_form* form = pl_present(f->t, x[i], PL_S_QUOTIENT, seconds);
    assert_int_equal(pl_alg_equal(f->t, pl_form_value(p, form), x[i]), PL_YES);
    ops += pl_form_ops(form);
    if (getenv("PRESENT_SHOW")) printf("%s'' = %s\n", coords[i], text_of(f, form));
  }
  return ops;
}

#define OPERATIONS(limit, seconds, L, ...)                                                   \
  do {                                                                                       \
    const char* const coords_[] = {__VA_ARGS__};                                             \
    long ops_ = operations(f, L, coords_, (int)(sizeof coords_ / sizeof *coords_), seconds); \
    if (ops_ > (limit)) fail_msg("%ld operations instead of %d", ops_, limit);               \
  } while (0)

static void accelerations_are_short(void** state) {
  fixture* f = *state;
  OPERATIONS(10, 0.02, "m/2*R^2*(th'^2 + w^2*sin(th)^2) + m*g*R*cos(th)", "th");
  OPERATIONS(36, 0.02, "(m1 + m2)/2*x'^2 + m2/2*l^2*th'^2 + m2*l*x'*th'*cos(th) + m2*g*l*cos(th)",
             "x", "th");
  OPERATIONS(19, 0.02, "m/2*(rho'^2 + rho^2*th'^2) + m*g*rho*cos(th) - k/2*(rho - l0)^2", "rho",
             "th");
  OPERATIONS(17, 0.02, "m/2*l^2*(th'^2 + sin(th)^2*phi'^2) + m*g*l*cos(th)", "th", "phi");
  OPERATIONS(34, 0.02, "m/2*(x'^2 + y'^2) - m*g*y - k/2*(sqrt(x^2 + y^2) - l0)^2", "x", "y");
}

static void double_pendulum_accelerations_are_short(void** state) {
  fixture* f = *state;
  OPERATIONS(75, 0.02,
             "(m1 + m2)/2*l1^2*a'^2 + m2/2*l2^2*b'^2 + m2*l1*l2*a'*b'*cos(a - b) + (m1 + "
             "m2)*g*l1*cos(a) + m2*g*l2*cos(b)",
             "a", "b");
  OPERATIONS(68, 1,
             "(m1 + m2)/2*l1^2*a'^2 + m2/2*l2^2*b'^2 + m2*l1*l2*a'*b'*cos(a - b) + (m1 + "
             "m2)*g*l1*cos(a) + m2*g*l2*cos(b)",
             "a", "b");
}

static void crank_acceleration_is_short(void** state) {
  fixture* f = *state;
  const char* L = pl_format(f->a, "1/2*m1*r^2*phi'^2 + 1/2*m2*%s^2 - m1*g*r*sin(phi)", slider);
  OPERATIONS(102, 1, L, "phi");
}

static void triple_pendulum_accelerations_are_short(void** state) {
  fixture* f = *state;
  const char* L =
      "(m1 + m2 + m3)/2*l1^2*a1'^2 + (m2 + m3)/2*l2^2*a2'^2 + m3/2*l3^2*a3'^2 + (m2 + "
      "m3)*l1*l2*a1'*a2'*cos(a1 - a2)"
      " + m3*l1*l3*a1'*a3'*cos(a1 - a3) + m3*l2*l3*a2'*a3'*cos(a2 - a3)"
      " + (m1 + m2 + m3)*g*l1*cos(a1) + (m2 + m3)*g*l2*cos(a2) + m3*g*l3*cos(a3)";
  OPERATIONS(280, 0.5, L, "a1", "a2", "a3");
}

// The same value, whatever comes in: sums and products of random shape.
static pl_expr random_expression(fixture* f, pl_random* r, int depth) {
  static const char* const atoms[] = {
      "m1",     "m2",     "g", "l",  "r", "sin(a)",         "cos(a)",
      "sin(b)", "cos(b)", "x", "x'", "2", "sqrt(l^2 - x^2)"};
  if (depth == 0) return formula(f, atoms[pl_random_bits(r) % (sizeof atoms / sizeof *atoms)]);
  pl_expr x = random_expression(f, r, depth - 1), y = random_expression(f, r, depth - 1);
  switch (pl_random_bits(r) % 5) {
    case 0: return pl_add(f->p, x, y);
    case 1: return pl_sub(f->p, x, y);
    case 2: return pl_square(f->p, x);
    case 3: return pl_is_zero_node(f->p, y) ? x : pl_div(f->p, x, y);
    default: return pl_mul(f->p, x, y);
  }
}

static void every_form_has_the_value_of_its_expression(void** state) {
  fixture* f = *state;
  for (uint64_t seed = 1; seed <= 60; seed++) {
    pl_random r = {seed};
    pl_expr e = random_expression(f, &r, 3);
    if (pl_is_poison(e)) continue;
    for (int style = PL_S_PLAIN; style <= PL_S_SOLUTION; style++) {
      const pl_form* x = pl_present(f->t, e, (pl_style)style, 0.004);
      pl_expr value = pl_form_value(f->p, x);
      if (pl_same(value, e)) continue;
      if (pl_alg_equal(f->t, value, e) == PL_NO)
        fail_msg("seed %llu: %s", (unsigned long long)seed, pl_expr_text(f->a, f->p, e));
    }
  }
}

static void the_same_input_gives_the_same_bytes(void** state) {
  fixture* f = *state;
  const char* e = "(m1*l1^2 + m2*l2^2*cos(a)^2)*a'^2/(m1 + m2) + sqrt(l^2 - x^2)*g";
  const char* first = text_of(f, presented(f, e, PL_S_QUOTIENT));
  pl_tower* other = pl_tower_make(f->job, f->p, NULL, 0);
  pl_present(other, formula(f, "x^2 + a*b*sin(b)"), PL_S_PLAIN, 0.01);
  assert_string_equal(text_of(f, pl_present(other, formula(f, e), PL_S_QUOTIENT, 0.02)), first);
  pl_tower_free(other);
}

int main(void) {
  const struct CMUnitTest tests[] = {
#define T(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
      T(atwood_quotients),
      T(crank_energy_keeps_the_square),
      T(crank_velocity),
      T(crank_inertia),
      T(crank_small_oscillations),
      T(skier_forces),
      T(skier_energy),
      T(double_pendulum_energy),
      T(double_pendulum_acceleration),
      T(double_pendulum_modes),
      T(cart_with_pendulum),
      T(hoop),
      T(spherical_pendulum_hamiltonian),
      T(elastic_pendulum),
      T(triple_pendulum_determinant),
      T(multiples_of_angles),
      T(fractions_stand_where_they_are_read_once),
      T(roots_come_together),
      T(distances_are_seen),
      T(symbols_go_under_the_root),
      T(zero_and_numbers),
      T(equations_are_ordered_by_derivatives),
      T(accelerations_are_short),
      T(double_pendulum_accelerations_are_short),
      T(crank_acceleration_is_short),
      T(triple_pendulum_accelerations_are_short),
      T(every_form_has_the_value_of_its_expression),
      T(the_same_input_gives_the_same_bytes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
