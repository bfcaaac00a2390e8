// What names say about a constraint: a label that speaks of a rope or of a floor, a length called l
// or R.
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

static bool has_word(const char* text, const char* const* words) {
  char low[64];
  size_t n = 0;
  for (; text[n] && n + 1 < sizeof low; n++) low[n] = (char)tolower((unsigned char)text[n]);
  low[n] = 0;
  // long words may stand anywhere (Pendelstange), short ones begin a name: `ring`, but not in
  // `string`
  for (; *words; words++) {
    const char* at = strstr(low, *words);
    if (at && (strlen(*words) > 4 || at == low || !isalpha((unsigned char)at[-1]))) return true;
  }
  return false;
}

// What the label says about the thing that constrains: in both languages of the program.
pl_hint pl_hint_of(const char* label) {
  static const char* const rope[] = {"rope", "string", "cord",   "thread", "tether", "cable",
                                     "seil", "faden",  "schnur", "leine",  NULL};
  static const char* const rod[] = {"rod",  "bar",    "link",   "arm",   "tie",    "axle", "crank",
                                    "stab", "stange", "pleuel", "achse", "kurbel", NULL};
  static const char* const track[] = {"hoop",    "ring", "wire",   "track",   "rail",
                                      "guide",   "loop", "circle", "draht",   "reif",
                                      "schiene", "bahn", "kreis",  "führung", NULL};
  static const char* const ground[] = {
      "floor", "wall",   "ground", "plane", "hill",   "slope", "bowl",   "dome",  "surface",
      "table", "ramp",   "piste",  "touch", "slide",  "boden", "wand",   "ebene", "hang",
      "tisch", "kuppel", "schale", "rampe", "fläche", "kugel", "sphere", NULL};
  if (!label) return PL_HINT_NONE;
  if (has_word(label, rope)) return PL_HINT_ROPE;
  if (has_word(label, ground)) return PL_HINT_GROUND;
  if (has_word(label, track)) return PL_HINT_TRACK;
  if (has_word(label, rod)) return PL_HINT_ROD;
  return PL_HINT_NONE;
}

// A radius called R or a speaks of a round surface, a length l of a rod.
bool pl_radius_is_length(const pl_stage* s, const pl_bond* b, double radius) {
  pl_symbol found[16];
  int n = pl_symbols_in(s->pool, b->c->g, found, 16);
  for (int i = 0; i < n && i < 16; i++) {
    const pl_symbol_info* info = pl_symbol_get(s->pool, found[i]);
    if (info->role != PL_R_PARAM || !(fabs(fabs(s->value[found[i].id]) - radius) < 1e-6 * radius))
      continue;
    return strchr("lLdsbh", info->name[0]) != NULL || strncmp(info->name, "ℓ", strlen("ℓ")) == 0;
  }
  return false;
}
