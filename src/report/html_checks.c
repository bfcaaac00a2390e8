// What was checked, how, and how large the largest difference was; and the last lines: how the page
// was made.
#include "html_impl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ------------------------------------------------------------------------------------------ checks
static const char* verdict(const pl_html* h, bool passed) {
  return passed
             ? pl_format(h->arena, "<td class=\"pass\">%s</td>", pl_html_say(h, PL_BOTH("passed")))
             : pl_format(h->arena, "<td class=\"fail\">%s</td>", pl_html_say(h, PL_BOTH("failed")));
}

static void put_check(pl_html* h, const char* what, const char* how, const char* worst,
                      bool passed) {
  pl_html_raw(h, "<tr><td>");
  pl_html_text(h, what);
  pl_html_raw(h, "</td><td>");
  pl_html_text(h, how);
  pl_html_rawf(h, "</td><td class=\"r\">%s</td>%s</tr>\n", worst, verdict(h, passed));
}

// 3.1e-13 as 3.1·10⁻¹³, as markup.
static const char* power(const pl_html* h, double x) {
  if (isnan(x)) return "–";
  if (!(fabs(x) > 0)) return "0";
  int e = (int)floor(log10(fabs(x)));
  const char* mantissa = pl_html_number(h, x / pow(10, e), 2);
  if (e >= -2 && e <= 3) return pl_html_number(h, x, 2);
  return pl_format(h->arena, "%s·10<sup>%s%d</sup>", mantissa, e < 0 ? "−" : "", abs(e));
}

static const char* how_checked(const pl_html* h, const pl_check* c) {
  if (!c->passed && c->failed_on)
    return pl_format(h->arena, pl_html_say(h, PL_BOTH("at %s")), c->failed_on);
  if (c->formulas > 0 && c->points > 0) {
    return pl_format(h->arena, pl_html_say(h, PL_BOTH("%d formulas at %d random points")),
                     c->formulas, c->points);
  }
  if (c->formulas > 0)
    return pl_format(h->arena, pl_html_say(h, PL_BOTH("%d formulas, exactly")), c->formulas);
  if (c->points > 0)
    return pl_format(h->arena, pl_html_say(h, PL_BOTH("%d random points")), c->points);
  return pl_html_say(h, PL_BOTH("every equation of the model"));
}

static void put_expectations(pl_html* h) {
  for (int i = 0; i < h->s->sections.n; i++) {
    const pl_section* c = &h->s->sections.at[i];
    for (int k = 0; k < c->values.n; k++) {
      const pl_value* v = &c->values.at[k];
      if (v->passed < 0 || !c->item || strncmp(c->item, "expect", 6) != 0) continue;
      put_check(h, c->item, pl_html_say(h, PL_BOTH("claimed by the model")), "", v->passed == 1);
    }
  }
}

static void put_motion_checks(pl_html* h) {
  const pl_result* r = h->in->result;
  if (!r || r->rows.n == 0) return;
  const pl_stats* s = &r->stats;
  const char* how = pl_format(h->arena, pl_html_say(h, PL_BOTH("all %ld steps of order %d")),
                              s->steps, s->order);
  bool constrained = s->rank_start > 0 || s->max_g > 0;
  if (constrained) {
    put_check(h, pl_html_say(h, PL_BOTH("Simulation: constraints, relative to their terms")), how,
              power(h, s->max_g), s->max_g < 1e-9);
    put_check(h, pl_html_say(h, PL_BOTH("Simulation: their time derivatives")), how,
              power(h, s->max_gdot), s->max_gdot < 1e-8);
  }
  if (h->in->energy_conserved && !isnan(s->energy_drift)) {
    put_check(h, pl_html_say(h, PL_BOTH("Simulation: energy, relative")), how,
              power(h, s->energy_drift), s->energy_drift < 1e-6);
  }
}

void pl_html_checks(pl_html* h) {
  pl_html_rawf(h, "<section id=\"checks\"><h2>%s</h2>\n<div class=\"scroll\"><table>\n",
               pl_html_say(h, PL_BOTH("Checks")));
  pl_html_rawf(h,
               "<thead><tr><th scope=\"col\">%s</th><th scope=\"col\">%s</th><th scope=\"col\" "
               "class=\"r\">%s</th><th scope=\"col\">%s</th></tr></thead><tbody>\n",
               pl_html_say(h, PL_BOTH("What")), pl_html_say(h, PL_BOTH("How")),
               pl_html_say(h, PL_BOTH("Largest deviation")), pl_html_say(h, PL_BOTH("Verdict")));
  for (int i = 0; i < h->s->checks.n; i++) {
    const pl_check* c = &h->s->checks.at[i];
    put_check(h, pl_html_words(h, c->name), how_checked(h, c),
              power(h, c->worst > 1e-30 ? c->worst : 0), c->passed);
  }
  put_expectations(h);
  put_motion_checks(h);
  pl_html_raw(h, "</tbody></table></div>\n");
  if (h->s->used.n > 0) {
    pl_html_rawf(h, "<p class=\"hint\">%s ", pl_html_say(h, PL_BOTH("Used:")));
    for (int i = 0; i < h->s->used.n; i++) {
      pl_html_raw(h, i ? ", " : "");
      pl_html_text(h, h->s->used.at[i]);
    }
    pl_html_raw(h, "</p>\n");
  }
  pl_html_raw(h, "</section>\n");
}

// -------------------------------------------------------------------------------------- last lines
void pl_html_colophon(pl_html* h) {
  pl_html_rawf(h, "<footer><p>%s ", pl_html_say(h, PL_BOTH("Made with")));
  if (h->in->command) {
    pl_html_raw(h, "<code>");
    pl_html_text(h, h->in->command);
    pl_html_raw(h, "</code> · ");
  }
  pl_html_rawf(h, "pleuel %s", PLEUEL_VERSION);
  if (h->in->result && h->in->tol > 0) {
    pl_html_rawf(h, " · %s %s", pl_html_say(h, PL_BOTH("Taylor series, relative tolerance")),
                 power(h, h->in->tol));
  }
  const pl_source* source = h->model ? h->model->source : NULL;
  if (source) {
    unsigned char hash[32];
    pl_sha256(hash, source->text, source->size);
    pl_html_rawf(h, " · %s SHA-256 <code class=\"hash\">%s</code>",
                 pl_html_say(h, PL_BOTH("model")), pl_hex_text(h->arena, hash, sizeof hash));
  }
  pl_html_rawf(h, "<br>%s</p>", pl_html_say(h, PL_BOTH("This file needs no network.")));
  if (!h->in->no_font) {
    pl_html_rawf(
        h, "<p>%s</p>",
        pl_html_say(
            h, PL_BOTH("Formulas are set in a subset of STIX Math (SIL Open Font License 1.1).")));
  }
  pl_html_raw(h, "</footer>\n");
}
