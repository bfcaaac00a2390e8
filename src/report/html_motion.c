// The motion: picture and plots beside each other, with one time for both; and the numbers they are
// drawn from.
#include "html_impl.h"

#include <math.h>
#include <string.h>

bool pl_html_has_motion(const pl_html* h) { return h->in->result && h->in->result->rows.n > 1; }

const char* pl_html_event(const pl_html* h, const pl_result_event* e) {
  const char* label = e->label ? e->label : "";
  switch (e->kind) {
    case PL_EV_RELEASE: return pl_format(h->arena, pl_html_say(h, PL_BOTH("%s lets go")), label);
    case PL_EV_IMPACT: return pl_format(h->arena, pl_html_say(h, PL_BOTH("impact on %s")), label);
    case PL_EV_CONTACT:
      return pl_format(h->arena, pl_html_say(h, PL_BOTH("contact with %s")), label);
    case PL_EV_SINGULAR: return pl_html_say(h, PL_BOTH("singular position"));
    default: return *label ? label : pl_html_say(h, PL_BOTH("event"));
  }
}

// ---------------------------------------------------------------------------------------- controls
static void put_switch(pl_html* h, const char* id, const char* words, bool on) {
  pl_html_rawf(h, "<label><input type=\"checkbox\" id=\"%s\"%s> %s</label>\n", id,
               on ? " checked" : "", words);
}

static void put_event_buttons(pl_html* h, double t0, double t1) {
  const pl_result* r = h->in->result;
  pl_html_raw(h, "<div class=\"marks\">");
  for (int i = 0; i < r->events.n && i < 20; i++) {
    const pl_result_event* e = &r->events.at[i];
    double part = t1 > t0 ? (e->t - t0) / (t1 - t0) : 0;
    const char* words = pl_format(h->arena, "%s, t = %s", pl_html_event(h, e),
                                  pl_html_quantity(h, e->t, h->model->uses_units ? "s" : "", 5));
    pl_html_rawf(h,
                 "<button type=\"button\" data-t=\"%.17g\" style=\"left:calc(8px + (100%% - "
                 "16px)*%.5f)\" title=\"",
                 e->t, part);
    pl_html_attribute(h, words);
    pl_html_raw(h, "\" aria-label=\"");
    pl_html_attribute(h, words);
    pl_html_raw(h, "\"></button>");
  }
  pl_html_raw(h, "</div>");
}

static void put_controls(pl_html* h, bool picture) {
  const pl_result* r = h->in->result;
  double t0 = r->rows.at[0][0], t1 = r->rows.at[r->rows.n - 1][0];
  pl_html_rawf(
      h, "<div class=\"ctl\"><button type=\"button\" id=\"play\" aria-label=\"%s\">▶</button>\n",
      pl_html_say(h, PL_BOTH("Play or pause")));
  pl_html_rawf(h,
               "<div class=\"scrub\"><input id=\"scrub\" type=\"range\" min=\"0\" max=\"1000\" "
               "step=\"any\" value=\"0\" aria-label=\"%s\">",
               pl_html_say(h, PL_BOTH("Time")));
  put_event_buttons(h, t0, t1);
  pl_html_raw(h, "</div>\n<output id=\"time\">t = 0</output>\n");
  if (picture && pl_html_scene_has(h, PL_SHAPE_FORCE))
    put_switch(h, "forces", pl_html_say(h, PL_BOTH("forces")), true);
  if (picture && pl_html_scene_has(h, PL_SHAPE_VELOCITY))
    put_switch(h, "velocity", pl_html_say(h, PL_BOTH("velocity")), false);
  if (picture && pl_html_scene_has(h, PL_SHAPE_TRAIL))
    put_switch(h, "trail", pl_html_say(h, PL_BOTH("trail")), true);
  pl_html_rawf(h,
               "<label>%s <select id=\"speed\"><option value=\"0.25\">0%s25×</option><option "
               "value=\"0.5\">0%s5×</option>"
               "<option value=\"1\" selected>1×</option><option "
               "value=\"2\">2×</option></select></label></div>\n",
               pl_html_say(h, PL_BOTH("speed")), pl_html_say(h, ".", ","),
               pl_html_say(h, ".", ","));
}

// ----------------------------------------------------------------------------------------- section
static void put_no_motion(pl_html* h) {
  bool message = h->in->run_message && *h->in->run_message, picture = pl_html_has_picture(h);
  if (!message && !picture) return;
  pl_html_rawf(h, "<section id=\"motion\"><h2>%s</h2>\n", pl_html_say(h, "System", "System"));
  if (picture) {
    pl_html_raw(h, "<figure class=\"still\">");
    pl_html_picture(h);
    pl_html_raw(h, "</figure>\n");
  }
  if (message) {
    pl_html_rawf(h, "<p class=\"note\"><b>%s</b> ", pl_html_say(h, PL_BOTH("Not simulated:")));
    pl_html_text(h, h->in->run_message);
    pl_html_raw(h, "</p>");
  }
  pl_html_raw(h, "</section>\n");
}

static void put_hint(pl_html* h) {
  pl_html_rawf(
      h, "<p class=\"hint\">%s</p>\n",
      pl_html_say(h,
                  PL_BOTH("Hover to read values, drag to zoom in time, double-click to reset, ← → "
                          "to step. The cursor moves the picture.")));
}

void pl_html_motion(pl_html* h) {
  if (!pl_html_has_motion(h)) {
    put_no_motion(h);
    return;
  }
  bool picture = pl_html_has_picture(h);
  pl_html_rows rows = pl_html_thin(h);
  pl_html_rawf(h, "<section id=\"motion\"><h2>%s</h2>\n<div class=\"%s\">\n<figure>",
               pl_html_say(h, PL_BOTH("Motion")), picture ? "stage" : "stage alone");
  if (picture) pl_html_picture(h);
  put_controls(h, picture);
  pl_html_raw(h, "</figure>\n<div class=\"plots\">\n");
  pl_html_plots(h, &rows);
  pl_html_raw(h, "</div></div>\n");
  put_hint(h);
  if (h->in->unplotted) {
    pl_html_rawf(h, "<p class=\"note\"><b>%s</b> ",
                 pl_html_say(h, PL_BOTH("No numbers, and so no curve:")));
    pl_html_text(h, h->in->unplotted);
    pl_html_raw(h, "</p>\n");
  }
  if (h->in->run_message && *h->in->run_message) {
    pl_html_rawf(h, "<p class=\"note\"><b>%s</b> ",
                 pl_html_say(h, PL_BOTH("The motion ends early:")));
    pl_html_text(h, h->in->run_message);
    pl_html_raw(h, "</p>\n");
  }
  pl_html_raw(h, "</section>\n");
}

// ----------------------------------------------------------------------------------------- numbers
static void put_mark_list(pl_html* h) {
  const pl_result* r = h->in->result;
  pl_html_raw(h, ",\"marks\":[");
  for (int i = 0; i < r->events.n && i < 200; i++) {
    pl_html_rawf(h, "%s[%.17g,", i ? "," : "", r->events.at[i].t);
    pl_html_json_string(h, pl_html_event(h, &r->events.at[i]));
    pl_html_raw(h, "]");
  }
  pl_html_raw(h, "]");
}

void pl_html_data(pl_html* h) {
  if (!pl_html_has_motion(h)) return;
  pl_html_rows rows = pl_html_thin(h);
  pl_html_raw(h, "<script type=\"application/json\" id=\"data\">{");
  pl_html_plot_data(h, &rows);
  put_mark_list(h);
  pl_html_rawf(h, ",\"unit\":\"%s\"", h->model->uses_units ? "s" : "");
  if (pl_html_has_picture(h)) {
    pl_html_raw(h, ",\n\"scene\":");
    pl_html_scene_data(h);
  }
  pl_html_raw(h, "}</script>\n");
}
