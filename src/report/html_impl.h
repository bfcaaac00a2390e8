// html_impl: what the rooms of the HTML report share. A page is text under construction; everything
// that comes from a model goes through pl_html_text or pl_html_attribute, which leave nothing that
// a browser would take for markup.
#ifndef PL_HTML_IMPL_H
#define PL_HTML_IMPL_H

#include "report_impl.h"

typedef struct pl_html {
  pl_text* out;
  pl_arena* arena;
  pl_pool* pool;  // NULL when the model has none
  const pl_html_input* in;
  const pl_solution* s;
  const pl_model* model;
  pl_language lang;
} pl_html;

// The files of the folder assets, built in (tools/embed_asset.py).
extern const char pl_html_style[], pl_html_script[], pl_html_font[];

// ---- html_text.c
const char* pl_html_say(const pl_html* h, const char* en, const char* de);
const char* pl_html_words(const pl_html* h, const char* const words[2]);  // "" when there are none
void pl_html_raw(pl_html* h, const char* markup);
// %s only for our own words
void pl_html_rawf(pl_html* h, const char* markup, ...) __attribute__((format(printf, 2, 3)));
// escaped; control characters become visible
void pl_html_text(pl_html* h, const char* s);
void pl_html_attribute(pl_html* h, const char* s);  // the same inside "..."
const char* pl_html_escaped(pl_arena* a, const char* s);
const char* pl_html_number(const pl_html* h, double x, int digits);
// A number with a unit for display: angles in degrees.
const char* pl_html_quantity(const pl_html* h, double x, const char* unit, int digits);
// A string in JSON that may stand inside a script element.
void pl_html_json_string(pl_html* h, const char* s);

// ---- html_formula.c
void pl_html_inline(pl_html* h, const pl_form* f);  // <math> in a line of text
// <math display="block">, broken over lines when it is wide
void pl_html_display(pl_html* h, const pl_form* f);
void pl_html_symbol(pl_html* h, pl_symbol s);
int pl_html_cells(pl_html* h, const pl_form* f);  // how wide it is about, in letters
// Is part the formula itself or, behind relation signs, its end?
bool pl_html_ends_in(const pl_form* whole, const pl_form* part);
// Words with {1}, {2} ... replaced by formulas, and (4) linked to equation 4.
void pl_html_sentence(pl_html* h, const char* words, int n, const pl_form* const* inserts);

// What an event is called beside its mark: "h lets go".
const char* pl_html_event(const pl_html* h, const pl_result_event* e);

// ---- html_scene.c
bool pl_html_has_picture(const pl_html* h);
bool pl_html_scene_has(const pl_html* h, pl_shape_kind kind);
void pl_html_picture(pl_html* h);
void pl_html_scene_data(pl_html* h);

// ---- html_plots.c
// rows of the result that the page keeps
typedef struct pl_html_rows {
  int n;
  const int* at;
} pl_html_rows;
pl_html_rows pl_html_thin(pl_html* h);
void pl_html_plots(pl_html* h, const pl_html_rows* rows);
void pl_html_plot_data(pl_html* h, const pl_html_rows* rows);
// float32, little-endian, base64
const char* pl_html_floats(pl_html* h, const double* x, int n);

// ---- the sections, one file each
void pl_html_cards(pl_html* h);
void pl_html_motion(pl_html* h);
void pl_html_derivation(pl_html* h);
void pl_html_checks(pl_html* h);
void pl_html_model(pl_html* h);
void pl_html_colophon(pl_html* h);
void pl_html_data(pl_html* h);
bool pl_html_has_motion(const pl_html* h);

// The address of a section of the solution inside the page: "part-3".
const char* pl_html_part(const pl_html* h, int section);
// the section whose heading this one stands under
int pl_html_head_of(const pl_html* h, int section);

#endif
