// One sentence for those who cannot see the picture, in both languages: what there is, what holds
// it, what happens.
#include <math.h>
#include <string.h>

#include "scene/scene_impl.h"

static int count(const pl_stage* s, pl_shape_kind kind) {
  int n = 0;
  for (int i = 0; i < s->parts.n; i++) n += s->parts.at[i].kind == kind;
  return n;
}

typedef struct pl_words {
  pl_shape_kind kind;
  const char *one, *many;
} pl_words;
static const pl_words words[] = {
    {PL_SHAPE_MASS, PL_KEY("one mass"), PL_KEY("%d masses")},
    {PL_SHAPE_BODY, PL_KEY("one body"), PL_KEY("%d bodies")},
    {PL_SHAPE_ROD, PL_KEY("a rod"), PL_KEY("%d rods")},
    {PL_SHAPE_ROPE, PL_KEY("a rope"), PL_KEY("%d ropes")},
    {PL_SHAPE_SPRING, PL_KEY("a spring"), PL_KEY("%d springs")},
    {PL_SHAPE_DAMPER, PL_KEY("a damper"), PL_KEY("%d dampers")},
    {PL_SHAPE_CURVE, PL_KEY("a curve that is followed"), PL_KEY("%d curves that are followed")},
    {PL_SHAPE_GROUND, PL_KEY("a surface"), PL_KEY("%d surfaces")},
};

static const char* decimal(pl_arena* a, double x, int lang) {
  char* text = pl_format(a, "%.4g", x);
  for (char* c = text; lang == 1 && *c; c++)
    if (*c == '.') *c = ',';
  return text;
}

static const char* happening(pl_arena* a, const pl_result_event* e, int lang) {
  const char* label = e->label ? e->label : "";
  switch (e->kind) {
    case PL_EV_RELEASE: return pl_format(a, lang ? pl_german("%s lets go") : "%s lets go", label);
    case PL_EV_IMPACT:
      return pl_format(a, lang ? pl_german("impact on %s") : "impact on %s", label);
    case PL_EV_CONTACT:
      return pl_format(a, lang ? pl_german("contact with %s") : "contact with %s", label);
    case PL_EV_SINGULAR: return lang ? pl_german("singular position") : "singular position";
    default: break;
  }
  return label;
}

enum { MOST_HAPPENINGS = 3 };

void pl_stage_words(pl_stage* s, pl_scene* scene) {
  const pl_result* r = s->result;
  for (int lang = 0; lang < 2; lang++) {
    pl_text out = pl_text_make(s->arena);
    pl_text_addf(&out, "%s: ",
                 s->model->title ? s->model->title
                 : lang          ? pl_german("The system")
                                 : "The system");
    int said = 0;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
      int n = count(s, words[i].kind);
      if (n == 0) continue;
      pl_text_add(&out, said++ ? ", " : "");
      if (n == 1) pl_text_add(&out, pl_in_language(lang, words[i].one));
      else pl_text_addf(&out, pl_in_language(lang, words[i].many), n);
    }
    if (!said)
      pl_text_add(&out, lang ? pl_german("nothing that has a place") : "nothing that has a place");
    if (s->n_frames > 1) {
      pl_text_addf(
          &out, lang ? pl_german("; motion from t = %s to %s s") : "; motion from t = %s to %s s",
          decimal(s->arena, s->t[0], lang), decimal(s->arena, s->t[s->n_frames - 1], lang));
    }
    for (int i = 0; r && i < r->events.n && i < MOST_HAPPENINGS; i++) {
      pl_text_addf(&out, lang ? pl_german("; %s at t = %s s") : "; %s at t = %s s",
                   happening(s->arena, &r->events.at[i], lang),
                   decimal(s->arena, r->events.at[i].t, lang));
    }
    pl_text_add(&out, ".");
    scene->description[lang] = pl_text_string(&out);
  }
}
