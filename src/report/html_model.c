// The text of the model with its words marked, and the table of its parameters.
#include "html_impl.h"

#include <math.h>
#include <string.h>

// -------------------------------------------------------------------------------------------- text
static bool is_word_byte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'
         || (unsigned char)c >= 0x80;
}

static size_t word_length(const char* s, const char* end) {
  size_t n = 0;
  while (s + n < end && is_word_byte(s[n])) n++;
  return n;
}

static bool is_among(const char* const* list, const char* s, size_t n) {
  for (; list && *list; list++)
    if (strlen(*list) == n && memcmp(*list, s, n) == 0) return true;
  return false;
}

static void put_marked(pl_html* h, const char* tag, const char* class, const char* s, size_t n) {
  pl_html_rawf(h, "<%s%s>", tag, class);
  pl_html_text(h, pl_copy_n(h->arena, s, n));
  pl_html_rawf(h, "</%s>", tag);
}

static size_t up_to(const char* s, const char* end, char c) {
  const char* at = memchr(s + 1, c, (size_t)(end - s - 1));
  return at ? (size_t)(at - s) + 1 : (size_t)(end - s);
}

static void put_source_line(pl_html* h, const char* s, const char* end) {
  bool first = true;
  while (s < end) {
    size_t n = word_length(s, end);
    if (n > 0) {
      bool statement = first && is_among(h->in->words, s, n),
           small = !first && is_among(h->in->small_words, s, n);
      if (statement) put_marked(h, "b", "", s, n);
      else if (small) put_marked(h, "i", "", s, n);
      else pl_html_text(h, pl_copy_n(h->arena, s, n));
      first = false;
      s += n;
      continue;
    }
    n = *s == '#'   ? (size_t)(end - s)
        : *s == '"' ? up_to(s, end, '"')
        : *s == '[' ? up_to(s, end, ']')
                    : 1;
    if (*s == '#') put_marked(h, "span", " class=\"cm\"", s, n);
    else if (*s == '"') put_marked(h, "span", " class=\"st\"", s, n);
    else if (*s == '[') put_marked(h, "span", " class=\"un\"", s, n);
    else pl_html_text(h, pl_copy_n(h->arena, s, n));
    // `ask a: simulate ...`, `for ... {`
    if (*s == ':' || *s == '{' || *s == ',') first = *s != ',';
    else if (*s != ' ' && *s != '\t') first = false;
    s += n;
  }
}

static void put_source(pl_html* h) {
  const pl_source* source = h->model ? h->model->source : NULL;
  if (!source) return;
  pl_html_raw(h, "<pre class=\"src\"><code>");
  const char *s = source->text, *end = source->text + source->size;
  while (end > s && (end[-1] == '\n' || end[-1] == ' ')) end--;
  while (s < end) {
    const char* line = memchr(s, '\n', (size_t)(end - s));
    const char* stop = line ? line : end;
    put_source_line(h, s, stop);
    if (line) pl_html_raw(h, "\n");
    s = line ? line + 1 : end;
  }
  pl_html_raw(h, "</code></pre>\n");
}

// -------------------------------------------------------------------------------------- parameters
static bool is_symbol(const pl_html* h, pl_expr e, pl_symbol s) {
  return !pl_is_poison(e) && pl_kind_of(h->pool, e) == PL_SYMBOL
         && pl_symbol_of(h->pool, e).id == s.id;
}

static const char* load_meaning(pl_html* h, const pl_load* l, pl_symbol s) {
  if (l->kind == PL_L_SPRING && is_symbol(h, l->value, s))
    return pl_html_say(h, PL_BOTH("stiffness of a spring"));
  if (l->kind == PL_L_SPRING && is_symbol(h, l->rest, s))
    return pl_html_say(h, PL_BOTH("length of a spring at rest"));
  if (l->kind == PL_L_DAMPER && is_symbol(h, l->value, s))
    return pl_html_say(h, PL_BOTH("damping"));
  if (l->kind == PL_L_DRAG && is_symbol(h, l->value, s)) return pl_html_say(h, PL_BOTH("drag"));
  return NULL;
}

// What a parameter is, by the place where it is used; NULL when that does not tell.
static const char* use_of(pl_html* h, pl_symbol s) {
  const pl_model* m = h->model;
  for (int i = 0; i < m->gravities.n; i++) {
    if (is_symbol(h, m->gravities.at[i].g, s))
      return pl_html_say(h, PL_BOTH("acceleration of gravity"));
  }
  for (int i = 0; i < m->masses.n; i++) {
    const pl_mass* p = &m->masses.at[i];
    if (!is_symbol(h, p->mass, s)) continue;
    if (p->name.generated || !p->name.text
        || strcmp(p->name.text, pl_symbol_get(h->pool, s)->name) == 0)
      return pl_html_say(h, PL_BOTH("mass"));
    return pl_format(h->arena, pl_html_say(h, PL_BOTH("mass of %s")), p->name.text);
  }
  for (int i = 0; i < m->bodies.n; i++) {
    if (is_symbol(h, m->bodies.at[i].mass, s)) return pl_html_say(h, PL_BOTH("mass"));
    if (is_symbol(h, m->bodies.at[i].inertia, s))
      return pl_html_say(h, PL_BOTH("moment of inertia"));
  }
  for (int i = 0; i < m->loads.n; i++) {
    const char* words = load_meaning(h, &m->loads.at[i], s);
    if (words) return words;
  }
  return NULL;
}

// A comment behind a line with this parameter alone says it best.
static const char* comment_of(pl_html* h, const pl_param* p, int i) {
  const pl_source* source = p->span.source;
  if (!source) return NULL;
  int line = pl_span_place(p->span).line;
  for (int k = 0; k < h->model->params.n; k++) {
    const pl_param* other = &h->model->params.at[k];
    if (other->literal) continue;
    if (k != i && other->span.source == source && pl_span_place(other->span).line == line)
      return NULL;
  }
  const char* text = pl_source_line(h->arena, source, line);
  const char* at = strchr(text, '#');
  if (!at) return NULL;
  at += strspn(at, "#: \t");
  return *at ? at : NULL;
}

static const char* meaning_of(pl_html* h, const pl_param* p, int i) {
  const char* words = comment_of(h, p, i);
  if (!words) words = use_of(h, p->symbol);
  if (words) return words;
  const pl_symbol_info* s = pl_symbol_get(h->pool, p->symbol);
  bool angle = p->unit_text
               && (strcmp(p->unit_text, "deg") == 0 || strcmp(p->unit_text, "°") == 0
                   || strcmp(p->unit_text, "rad") == 0);
  if (angle) return pl_html_say(h, PL_BOTH("angle"));
  if (!h->model->uses_units || !s->dimension_known) return "";
  words = pl_dimension_words(h->arena, s->dimension, h->lang);
  static const char* const article[] = {"an ", "a ", PL_KEY("eine ")};
  for (int k = 0; k < 4; k++)
    if (strncmp(words, article[k], strlen(article[k])) == 0) return words + strlen(article[k]);
  return words;
}

static bool mentions(const char* text, const char* name) {
  size_t n = strlen(name);
  for (const char* at = strstr(text, name); at; at = strstr(at + 1, name)) {
    bool left = at == text || !is_word_byte(at[-1]), right = !is_word_byte(at[n]);
    if (left && right) return true;
  }
  return false;
}

static void put_assumptions(pl_html* h, const char* name) {
  bool any = false;
  for (int i = 0; i < h->s->used.n; i++) {
    if (!mentions(h->s->used.at[i], name)) continue;
    pl_html_raw(h, any ? ", " : "");
    pl_html_text(h, h->s->used.at[i]);
    any = true;
  }
}

static void put_parameter(pl_html* h, const double* value, int i) {
  const pl_param* p = &h->model->params.at[i];
  const pl_symbol_info* s = pl_symbol_get(h->pool, p->symbol);
  double x = value[p->symbol.id];
  pl_html_raw(h, "<tr><td>");
  pl_html_symbol(h, p->symbol);
  pl_html_raw(h, "</td><td>");
  pl_html_text(h, meaning_of(h, p, i));
  pl_html_raw(h, "</td><td class=\"r\">");
  bool angle = p->unit_text && (strcmp(p->unit_text, "deg") == 0 || strcmp(p->unit_text, "°") == 0);
  const char* unit = angle ? "rad"
                     : s->dimension_known && h->model->uses_units
                         ? pl_unit_of_symbol(h->arena, h->pool, p->symbol, s->dimension, false)
                         : "";
  if (isnan(x)) pl_html_raw(h, "–");
  else pl_html_text(h, pl_html_quantity(h, x, unit, 6));
  pl_html_raw(h, "</td><td>");
  put_assumptions(h, s->name);
  pl_html_raw(h, "</td></tr>\n");
}

static void put_parameters(pl_html* h) {
  int n = 0;
  for (int i = 0; h->model && i < h->model->params.n; i++) n += !h->model->params.at[i].literal;
  if (!h->pool || n == 0) return;
  const double* value = pl_model_values(h->model, h->arena);
  pl_html_raw(h, "<div class=\"scroll\"><table>");
  pl_html_rawf(h,
               "<thead><tr><th scope=\"col\">%s</th><th scope=\"col\">%s</th><th scope=\"col\" "
               "class=\"r\">%s</th><th scope=\"col\">%s</th></tr></thead><tbody>\n",
               "Symbol", pl_html_say(h, PL_BOTH("Meaning")), pl_html_say(h, PL_BOTH("Value")),
               pl_html_say(h, PL_BOTH("Used")));
  for (int i = 0; i < h->model->params.n; i++)
    if (!h->model->params.at[i].literal) put_parameter(h, value, i);
  pl_html_raw(h, "</tbody></table></div>\n");
}

void pl_html_model(pl_html* h) {
  pl_html_rawf(h, "<section id=\"model\"><h2>%s</h2>\n<div class=\"two\">\n",
               pl_html_say(h, PL_BOTH("Model")));
  put_source(h);
  put_parameters(h);
  pl_html_raw(h, "</div></section>\n");
}
