// What an editor does with a text: uses of a name, renaming, completion, colours.
#include "api/editor.h"

#include <string.h>

typedef struct pl_editing_at {
  size_t at;
  const char* name;
  pleuel_use* uses;
  pleuel_edit* edits;
  pleuel_offer* offers;
  pl_span span;
  size_t n;
} pl_editing_at;

// ---------------------------------------------------------------------------------------- uses
static pleuel_status uses(pleuel_model* m, pl_arena* a, void* argument) {
  pl_editing_at* w = argument;
  const pl_outline* o = m->editor->outline;
  int at = pl_outline_use_at(o, m->source, w->at);
  if (at < 0) return PLEUEL_OK;
  w->uses = PL_ARRAY(a, pleuel_use, o->uses.n);
  for (int i = 0; i < o->uses.n; i++) {
    const pl_use* u = &o->uses.at[i];
    if (u->named != o->uses.at[at].named) continue;
    w->uses[w->n++] = (pleuel_use){pl_api_span(u->span), u->defines};
  }
  return PLEUEL_OK;
}

pleuel_status pleuel_uses(pleuel_model* m, size_t at, const pleuel_use** out, size_t* n) {
  if (out) *out = NULL;
  if (n) *n = 0;
  if (!m || !out || !n) return PLEUEL_USAGE;
  pl_editing_at w = {.at = at};
  pleuel_status s = pl_editor_answer(m, PL_ANSWER_USES, uses, &w);
  *out = w.uses;
  *n = w.n;
  return s;
}

// ------------------------------------------------------------------------------- renaming
// What the name is called at a use: ẋ becomes s'.
static const char* spelled_at(pl_arena* a, const pl_use* u, const char* name) {
  if (!u->dotted) return name;
  return pl_format(a, "%s%s", name, u->dots == 2 ? "''" : "'");
}

static pleuel_status rename_all(pleuel_model* m, pl_arena* a, void* argument) {
  pl_editing_at* w = argument;
  const pl_outline* o = m->editor->outline;
  int at = pl_outline_use_at(o, m->source, w->at);
  if (at < 0) return pl_api_fail(m->ctx, PLEUEL_USAGE, "no name stands here");
  const char* why[2];
  const char* now = o->named.at[o->uses.at[at].named].shown;
  bool other = !pl_spelled_same(a, now, w->name);
  if (other && !pl_outline_name_is_free(o, w->name, why)) {
    return pl_api_fail(m->ctx, PLEUEL_USAGE, why[m->ctx->lang]);
  }
  w->edits = PL_ARRAY(a, pleuel_edit, o->uses.n);
  for (int i = 0; i < o->uses.n; i++) {
    const pl_use* u = &o->uses.at[i];
    if (u->named != o->uses.at[at].named) continue;
    w->edits[w->n++] = (pleuel_edit){pl_api_span(u->span), spelled_at(a, u, pl_copy(a, w->name))};
  }
  return PLEUEL_OK;
}

pleuel_status pleuel_rename(pleuel_model* m, size_t at, const char* name, const pleuel_edit** edits,
                            size_t* n) {
  if (edits) *edits = NULL;
  if (n) *n = 0;
  if (!m || !name || !edits || !n) return PLEUEL_USAGE;
  pl_editing_at w = {.at = at, .name = name};
  pleuel_status s = pl_editor_answer(m, PL_ANSWER_RENAME, rename_all, &w);
  *edits = w.edits;
  *n = s == PLEUEL_OK ? w.n : 0;
  return s;
}

// ------------------------------------------------------------------------------- completion
static pleuel_status complete(pleuel_model* m, pl_arena* a, void* argument) {
  pl_editing_at* w = argument;
  const pl_outline* o = m->editor->outline;
  pl_language lang = pl_api_language_of(m, NULL);
  pl_offers all = pl_outline_offer(a, o, w->at);
  w->span = all.span;
  w->offers = PL_ARRAY(a, pleuel_offer, all.list.n);
  for (int i = 0; i < all.list.n; i++) {
    const pl_offer* one = &all.list.at[i];
    const pl_named* named = one->named >= 0 ? &o->named.at[one->named] : NULL;
    w->offers[w->n++] = (pleuel_offer){
        .kind = (pleuel_offer_kind)one->kind,
        .name_kind = named ? (pleuel_kind)named->kind : PLEUEL_KIND_TIME,
        .text = one->text,
        .form = one->form,
        .meaning = named ? named->comment : one->words[lang]};
  }
  return PLEUEL_OK;
}

pleuel_status pleuel_complete(pleuel_model* m, size_t at, pleuel_span* span,
                              const pleuel_offer** offers, size_t* n) {
  if (offers) *offers = NULL;
  if (n) *n = 0;
  if (span) *span = (pleuel_span){0};
  if (!m || !offers || !n) return PLEUEL_USAGE;
  pl_editing_at w = {.at = at};
  pleuel_status s = pl_editor_answer(m, PL_ANSWER_OFFERS, complete, &w);
  *offers = w.offers;
  *n = w.n;
  if (span) *span = pl_api_span(w.span);
  return s;
}

// ---------------------------------------------------------------------------------------- colours
static pleuel_status list_tokens(pleuel_model* m, pl_arena* a, void* argument) {
  (void)argument;
  const pl_outline* o = m->editor->outline;
  pleuel_token* all = PL_ARRAY(a, pleuel_token, o->classed.n + 1);
  for (int i = 0; i < o->classed.n; i++) {
    const pl_classed* c = &o->classed.at[i];
    const pl_use* u = c->use >= 0 ? &o->uses.at[c->use] : NULL;
    all[i] = (pleuel_token){.kind = (pleuel_token_kind)c->class,
                            .name_kind = u ? (int)o->named.at[u->named].kind : -1,
                            .defines = u && u->defines,
                            .span = pl_api_span(c->span)};
  }
  m->editor->tokens = all;
  m->editor->n_tokens = (size_t)o->classed.n;
  return PLEUEL_OK;
}

pleuel_status pleuel_tokens(pleuel_model* m, const pleuel_token** tokens, size_t* n) {
  if (tokens) *tokens = NULL;
  if (n) *n = 0;
  if (!m || !tokens || !n) return PLEUEL_USAGE;
  pl_editor* e = pl_editor_of(m);
  if (!e) return pl_api_fail(m->ctx, PLEUEL_NO_MEMORY, "memory ran out");
  pleuel_status s = e->tokens ? PLEUEL_OK : pl_editor_keep(m, list_tokens, NULL);
  *tokens = e->tokens;
  *n = e->n_tokens;
  return s;
}
