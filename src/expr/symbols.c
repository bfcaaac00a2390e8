// Symbols: what a name stands for, and the names that belong to another one: velocities,
// accelerations, start values.
#include "expr/expr_impl.h"

#include <ctype.h>
#include <string.h>

static uint64_t hash_name(const char* ascii) { return pl_hash_bytes(ascii, strlen(ascii), 1); }

static uint32_t symbol_slot(const pl_pool* p, const uint32_t* table, uint32_t cap,
                            const char* ascii) {
  uint32_t i = (uint32_t)hash_name(ascii) & (cap - 1);
  while (table[i] != 0 && strcmp(p->symbols.at[table[i] - 1]->ascii, ascii) != 0)
    i = (i + 1) & (cap - 1);
  return i;
}

static void widen_symbols(pl_pool* p) {
  uint32_t cap = p->symbol_cap * 2;
  uint32_t* table = PL_ARRAY(p->arena, uint32_t, cap);
  for (int i = 0; i < p->symbols.n; i++)
    table[symbol_slot(p, table, cap, p->symbols.at[i]->ascii)] = (uint32_t)i + 1;
  p->symbol_table = table;
  p->symbol_cap = cap;
}

pl_symbol pl_symbol_find(const pl_pool* p, const char* ascii) {
  return (pl_symbol){p->symbol_table[symbol_slot(p, p->symbol_table, p->symbol_cap, ascii)]};
}

pl_symbol pl_symbol_make(pl_pool* p, const pl_symbol_info* info) {
  const char* ascii = info->ascii ? info->ascii : info->name ? info->name : "";
  pl_symbol found = pl_symbol_find(p, ascii);
  if (found.id != 0) return found;

  if ((uint32_t)p->symbols.n * 2 >= p->symbol_cap) widen_symbols(p);
  pl_symbol_info* kept = PL_NEW(p->arena, pl_symbol_info);
  *kept = *info;
  kept->ascii = pl_copy(p->arena, ascii);
  kept->name = pl_copy(p->arena, info->name ? info->name : ascii);
  if (!kept->dimension_known && kept->dimension.den[0] == 0) kept->dimension = pl_dimension_one();
  pl_push(p->arena, p->symbols, kept);
  p->symbol_table[symbol_slot(p, p->symbol_table, p->symbol_cap, kept->ascii)] =
      (uint32_t)p->symbols.n;
  return (pl_symbol){(uint32_t)p->symbols.n};
}

pl_symbol_info* pl_symbol_get(const pl_pool* p, pl_symbol s) {
  if (s.id == 0 || s.id > (uint32_t)p->symbols.n) return NULL;
  return p->symbols.at[s.id - 1];
}

int pl_symbol_count(const pl_pool* p) { return p->symbols.n; }

// ------------------------------------------------------------------------------- names that belong
// Makes info under its ascii name, or, when a stranger has that name, with underscores behind it.
static pl_symbol make_own(pl_pool* p, pl_symbol_info info) {
  for (;;) {
    pl_symbol s = pl_symbol_find(p, info.ascii);
    if (s.id == 0) return pl_symbol_make(p, &info);
    const pl_symbol_info* x = pl_symbol_get(p, s);
    if (x->role == info.role && x->base.id == info.base.id && x->dots == info.dots) return s;
    info.ascii = pl_format(p->arena, "%s_", info.ascii);
  }
}

// "x_dot", "x_ddot", "x_dddot" ...
static const char* dotted_name(pl_pool* p, const char* base, int dots) {
  pl_text t = pl_text_make(p->arena);
  pl_text_addf(&t, "%s_", base);
  for (int i = 0; i < dots; i++) pl_text_add(&t, "d");
  pl_text_add(&t, "ot");
  return pl_text_string(&t);
}

pl_symbol pl_symbol_dot(pl_pool* p, pl_symbol s) {
  pl_symbol_info* x = pl_symbol_get(p, s);
  if (x == NULL) return (pl_symbol){0};
  if (x->up.id != 0) return x->up;
  pl_symbol coordinate = x->dots > 0 && x->base.id != 0 ? x->base : s;
  const pl_symbol_info* q = pl_symbol_get(p, coordinate);
  int dots = x->dots + 1;
  pl_symbol_info info = {
      .name = q->name,
      .ascii = dotted_name(p, q->ascii, dots),
      .role = dots == 1 ? PL_R_VELOCITY : PL_R_ACCELERATION,
      .class = dots == 1 ? PL_C_VELOCITY : PL_C_ACCELERATION,
      .dimension = pl_dimension_div(x->dimension, pl_dimension_of(0, 0, 1)),
      .dimension_known = x->dimension_known,
      .dots = dots,
      .base = coordinate,
  };
  x->up = make_own(p, info);
  return x->up;
}

pl_symbol pl_symbol_start(pl_pool* p, pl_symbol s) {
  const pl_symbol_info* x = pl_symbol_get(p, s);
  if (x == NULL) return (pl_symbol){0};
  pl_symbol_info info = {
      .name = x->name,
      .ascii = pl_format(p->arena, "%s_0", x->ascii),
      .role = PL_R_START,
      .class = x->class,
      .dimension = x->dimension,
      .dimension_known = x->dimension_known,
      .dots = x->dots,
      .base = x->dots > 0 && x->base.id != 0 ? x->base : s,
  };
  return make_own(p, info);
}

pl_symbol pl_time(pl_pool* p) {
  if (p->time.id == 0) {
    p->time = make_own(p, (pl_symbol_info){.name = "t",
                                           .ascii = "t",
                                           .role = PL_R_TIME,
                                           .class = PL_C_TIME,
                                           .dimension = pl_dimension_of(0, 0, 1),
                                           .dimension_known = false});
  }
  return p->time;
}

// ---------------------------------------------------------------------------------- order of names
// Letters by code, runs of digits by value: m2 before m10.  Equal only if the texts are.
int pl_natural_compare(const char* a, const char* b) {
  const char *s = a, *t = b;
  while (*s && *t) {
    if (isdigit((unsigned char)*s) && isdigit((unsigned char)*t)) {
      while (*s == '0' && isdigit((unsigned char)s[1])) s++;
      while (*t == '0' && isdigit((unsigned char)t[1])) t++;
      size_t n = strspn(s, "0123456789"), m = strspn(t, "0123456789");
      if (n != m) return n < m ? -1 : 1;
      int c = strncmp(s, t, n);
      if (c != 0) return c;
      s += n;
      t += m;
      continue;
    }
    if (*s != *t) return (unsigned char)*s < (unsigned char)*t ? -1 : 1;
    s++;
    t++;
  }
  if (*s || *t) return *s ? 1 : -1;
  return strcmp(a, b);
}

int pl_symbol_compare(const pl_pool* p, pl_symbol a, pl_symbol b) {
  if (a.id == b.id) return 0;
  const pl_symbol_info *x = pl_symbol_get(p, a), *y = pl_symbol_get(p, b);
  if (x == NULL || y == NULL) return x == NULL ? -1 : 1;
  if (x->class != y->class) return x->class < y->class ? -1 : 1;
  int c = pl_natural_compare(x->name, y->name);
  if (c != 0) return c;
  if (x->dots != y->dots) return x->dots < y->dots ? -1 : 1;
  return pl_natural_compare(x->ascii, y->ascii);
}

const char* pl_unit_of_symbol(pl_arena* a, const pl_pool* p, pl_symbol s, pl_dimension d,
                              bool ascii) {
  const pl_symbol_info* info = s.id ? pl_symbol_get(p, s) : NULL;
  bool torque = info && (info->role == PL_R_MULTIPLIER || info->torque)
                && pl_dimension_equal(d, pl_dimension_of(2, 1, -2));
  return torque ? "N m" : pl_dimension_unit(a, d, ascii);
}
