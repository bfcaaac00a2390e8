// Names of symbols in other programs: those of the JSON document where they are free there, else
// with something behind them. Mathematica knows no underscores: x1_dot is x1Dot, x1_0 is x1$0.
#include "export/export_impl.h"

#include <ctype.h>
#include <string.h>

static bool is_reserved(const pl_dialect* d, const char* name) {
  size_t n = strlen(name);
  for (const char* at = d->reserved; (at = strstr(at, name)) != NULL; at++) {
    if (at[-1] == ' ' && at[n] == ' ') return true;
  }
  // what Mathematica defines begins with a capital and is a word
  return d->camel && n > 1 && isupper((unsigned char)name[0])
         && strspn(name + 1, "abcdefghijklmnopqrstuvwxyz") == n - 1;
}

// Letters, digits and underscores, a letter first.
static const char* plain(pl_arena* a, const char* ascii) {
  pl_text out = pl_text_make(a);
  if (!isalpha((unsigned char)*ascii)) pl_text_add(&out, "v");
  for (const char* c = ascii; *c; c++) {
    bool fits = isalnum((unsigned char)*c) && (unsigned char)*c < 128;
    if (!fits && c[1] == '\0') break;
    pl_text_add_n(&out, fits ? c : "_", 1);
  }
  return pl_text_string(&out);
}

static const char* camel(pl_arena* a, const char* name) {
  pl_text out = pl_text_make(a);
  for (const char* c = name; *c; c++) {
    bool joint = *c == '_';
    if (joint) c += strspn(c, "_");
    if (!*c) break;
    if (joint && isdigit((unsigned char)*c)) pl_text_add(&out, "$");
    char letter = joint ? (char)toupper((unsigned char)*c) : *c;
    pl_text_add_n(&out, &letter, 1);
  }
  return pl_text_string(&out);
}

typedef struct taken {
  pl_names* names;
  pl_map* map;
} taken;

static bool take(taken* t, const char* name) {
  uint64_t key = (uint64_t)(uintptr_t)pl_intern(t->names, name);
  if (pl_map_get(t->map, key)) return false;
  pl_map_set(t->map, key, 1);
  return true;
}

const char* pl_export_ascii(pl_arena* a, const pl_pool* p, pl_symbol s, int dots) {
  static const char* const end[PL_EXPORT_DOTS] = {"", "_dot", "_ddot"};
  return pl_format(a, "%s%s", pl_symbol_get(p, s)->ascii, end[dots]);
}

pl_export_names pl_export_names_make(pl_arena* a, const pl_pool* p, const pl_dialect* d) {
  int n = pl_symbol_count(p);
  pl_export_names names = {PL_ARRAY(a, pl_export_spelling, n + 1)};
  taken t = {pl_names_make(a), pl_map_make(a)};
  for (int i = 1; i <= n; i++) {
    pl_symbol s = {(uint32_t)i};
    int n_dots = pl_symbol_get(p, s)->role == PL_R_ARRAY ? PL_EXPORT_DOTS : 1;
    for (int k = 0; k < n_dots; k++) {
      const char* name = plain(a, pl_export_ascii(a, p, s, k));
      if (d->camel) name = camel(a, name);
      while (is_reserved(d, name) || !take(&t, name))
        name = pl_format(a, "%s%s", name, d->camel ? "Var" : "_");
      names.of[i].name[k] = name;
    }
  }
  return names;
}
