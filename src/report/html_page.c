// The page as a whole: head, navigation, title and question, then the sections in their order.
//
// The page forbids itself to load anything and to run any script but ours, whose hash it names, so
// that a model text that should ever slip through as markup would still do nothing.
#include "html_impl.h"

#include <string.h>

static const char brand[] =
    "<svg viewBox=\"0 0 32 20\" width=\"30\" height=\"19\" aria-hidden=\"true\"><circle cx=\"8\" "
    "cy=\"10\" r=\"6.5\" fill=\"none\" "
    "stroke=\"currentColor\" stroke-width=\"1.6\"/><line x1=\"12\" y1=\"5\" x2=\"27\" y2=\"10\" "
    "stroke=\"currentColor\" "
    "stroke-width=\"2.4\" stroke-linecap=\"round\"/><circle cx=\"12\" cy=\"5\" r=\"2.4\" "
    "fill=\"currentColor\"/><rect x=\"24\" y=\"7\" "
    "width=\"6.5\" height=\"6\" rx=\"1\" fill=\"currentColor\"/></svg>";

// -------------------------------------------------------------------------------------------- head
static void put_policy(pl_html* h) {
  unsigned char hash[32];
  pl_text base64 = pl_text_make(h->arena);
  pl_sha256(hash, pl_html_script, strlen(pl_html_script));
  pl_base64_add(&base64, hash, sizeof hash);
  pl_html_rawf(
      h,
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
      "'sha256-%s'; "
      "style-src 'unsafe-inline'; font-src data:; base-uri 'none'; form-action 'none'\">\n",
      pl_text_string(&base64));
}

static const char* title_of(const pl_html* h) {
  const char* title = h->model && h->model->title ? h->model->title : "";
  return *title ? title : pl_html_say(h, PL_BOTH("A mechanical system"));
}

static void put_head(pl_html* h) {
  pl_html_rawf(h, "<!doctype html>\n<html lang=\"%s\">\n<head>\n<meta charset=\"utf-8\">\n",
               pl_html_say(h, "en", "de"));
  pl_html_raw(h, "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n");
  put_policy(h);
  pl_html_raw(h, "<meta name=\"color-scheme\" content=\"light dark\">\n<title>");
  pl_html_text(h, title_of(h));
  pl_html_raw(h, " – pleuel</title>\n<style>\n");
  if (!h->in->no_font) {
    pl_html_raw(h, "@font-face{font-family:\"Pleuel Math\";src:url(data:font/woff2;base64,");
    pl_html_raw(h, pl_html_font);
    pl_html_raw(h, ") format(\"woff2\")}\n");
  }
  pl_html_raw(h, pl_html_style);
  pl_html_raw(h, "</style>\n</head>\n");
}

static void put_constraint(pl_html* h, const char* id, const char* words) {
  pl_html_rawf(h, "<a href=\"#%s\">%s</a>", id, words);
}

static void put_tool(pl_html* h, const char* id, const char* words, const char* label) {
  pl_html_rawf(h, "<button type=\"button\" id=\"%s\" aria-label=\"%s\">%s</button>", id, label,
               words);
}

static void put_top(pl_html* h) {
  pl_html_rawf(
      h,
      "<body>\n<header class=\"top\"><div class=\"wrap\"><span class=\"brand\">%spleuel</span>\n",
      brand);
  pl_html_rawf(h, "<nav aria-label=\"%s\">", pl_html_say(h, PL_BOTH("Sections")));
  put_constraint(h, "result", pl_html_say(h, PL_BOTH("Result")));
  if (pl_html_has_motion(h)) put_constraint(h, "motion", pl_html_say(h, PL_BOTH("Motion")));
  else if (pl_html_has_picture(h)) put_constraint(h, "motion", pl_html_say(h, "System", "System"));
  put_constraint(h, "derivation", pl_html_say(h, PL_BOTH("Derivation")));
  put_constraint(h, "checks", pl_html_say(h, PL_BOTH("Checks")));
  put_constraint(h, "model", pl_html_say(h, PL_BOTH("Model")));
  pl_html_raw(h, "</nav>\n<span class=\"tools\">");
  bool data = pl_html_has_motion(h) && h->in->data != PL_HTML_DATA_NONE;
  if (data) put_tool(h, "csv", "CSV", pl_html_say(h, PL_BOTH("Save the motion as CSV")));
  put_tool(h, "tex", "LaTeX", pl_html_say(h, PL_BOTH("Save the equations as LaTeX")));
  put_tool(h, "print", pl_html_say(h, PL_BOTH("Print")), pl_html_say(h, PL_BOTH("Print")));
  put_tool(h, "theme", "◐", pl_html_say(h, PL_BOTH("Switch between light and dark")));
  pl_html_raw(h, "</span></div></header>\n<main class=\"wrap\">\n");
}

// ------------------------------------------------------------------------------------------- title
static void put_title(pl_html* h) {
  pl_html_raw(h, "<h1>");
  pl_html_text(h, title_of(h));
  pl_html_raw(h, "</h1>\n");
  int n = h->model ? h->model->comments.n : 0;
  if (n > 0) pl_html_raw(h, "<p class=\"lead\">");
  for (int i = 0; i < n; i++) {
    if (i > 0) pl_html_raw(h, " ");
    pl_html_text(h, h->model->comments.at[i]);
  }
  if (n > 0) pl_html_raw(h, "</p>\n");
}

void pl_html_report(pl_text* out, const pl_html_input* in) {
  const pl_model* m = in->solution->model;
  pl_html page = {.out = out,
                  .arena = out->arena,
                  .pool = m ? m->pool : NULL,
                  .in = in,
                  .s = in->solution,
                  .model = m,
                  .lang = in->lang};
  pl_html* h = &page;
  put_head(h);
  put_top(h);
  put_title(h);
  pl_html_cards(h);
  pl_html_motion(h);
  pl_html_derivation(h);
  pl_html_checks(h);
  pl_html_model(h);
  pl_html_colophon(h);
  pl_html_raw(h, "</main>\n");
  pl_html_data(h);
  pl_html_rawf(h, "<script>%s</script>\n</body>\n</html>\n", pl_html_script);
}
