// The worked solution in LaTeX: a fragment that needs amsmath and nothing else, or a document of
// its own.
//
// What a document may want to look different goes through macros with \providecommand: \plsection,
// \plheading, \pldot, \plddot, \plvec. The figure needs TikZ; a fragment shows it where TikZ is
// loaded.
#include "tex_impl.h"
#include "report_impl.h"

#include <string.h>

static const char preamble[] =
    "\\documentclass[11pt,a4paper]{article}\n"
    "\\usepackage{amsmath}\n"
    "\\ifdefined\\directlua\\else\\usepackage[T1]{fontenc}\\usepackage[utf8]{inputenc}\\fi\n"
    "\\IfFileExists{lmodern.sty}{\\usepackage{lmodern}}{}\n"
    "\\usepackage[margin=25mm]{geometry}\n"
    "\\IfFileExists{tikz.sty}{\\usepackage{tikz}}{}\n"
    "\\setlength{\\parindent}{0pt}\n"
    "\\setlength{\\parskip}{4pt plus 2pt}\n"
    "\\emergencystretch=3em\n"
    "\\allowdisplaybreaks\n"
    "\\begin{document}\n"
    "\\abovedisplayskip=6pt plus 2pt\n"
    "\\belowdisplayskip=6pt plus 2pt\n";

static const char macros[] =
    "\\providecommand{\\plsection}[2]{\\par\\bigskip\\noindent\\textbf{\\if\\relax#1\\relax\\else "
    "#1)\\enspace\\fi #2}}\n"
    "\\providecommand{\\plheading}[1]{\\par\\medskip\\noindent\\textit{#1}}\n";
static const char accents[] =
    "\\providecommand{\\pldot}[1]{\\dot{#1}}\n"
    "\\providecommand{\\plddot}[1]{\\ddot{#1}}\n"
    "\\providecommand{\\plvec}[1]{\\vec{#1}}\n";

static void put_title(pl_tex_page* g, const pl_model* m) {
  if (m->title && *m->title)
    pl_text_addf(g->out, "{\\Large\\bfseries %s\\par}\\medskip\n", pl_tex_plain(g, m->title));
  for (int i = 0; i < m->comments.n; i++) {
    const char* line = m->comments.at[i] + strspn(m->comments.at[i], " \t");
    pl_text_addf(g->out, "%s\n", pl_tex_plain(g, line));
    if (!*line) pl_text_add(g->out, "\n");
  }
  pl_text_add(g->out, "\n");
}

// ----------------------------------------------------------------------------------------- the end
static void put_notes(pl_tex_page* g, const pl_solution* s, const pl_diagnostics* notes) {
  const char* const note[2] = {PL_BOTH("Note")};
  pl_language lang = g->how.lang;
  for (int i = 0; notes && i < notes->list.n; i++) {
    const pl_diagnostic* d = &notes->list.at[i];
    if (pl_code_severity(d->code) != PL_NOTE || pl_worked_told(s, pl_code_name(d->code))) continue;
    const char* reason = d->reason[lang] ? d->reason[lang] : "";
    pl_text_addf(g->out, "\n\\emph{%s %s.} %s%s%s\n", note[lang], pl_code_name(d->code),
                 pl_tex_plain(g, d->sentence[lang]), *reason ? ". " : "", pl_tex_plain(g, reason));
  }
}

// Lines about the simulated motion; columns of events, separated by three blanks or more, become
// cells.
static void put_motion(pl_tex_page* g, const char* motion) {
  for (const char* s = motion ? motion : ""; *s;) {
    size_t n = strcspn(s, "\n");
    const char* line = pl_copy_n(g->arena, s, n);
    line += strspn(line, " ");
    pl_text out = pl_text_make(g->arena);
    for (const char* gap; (gap = strstr(line, "   ")) != NULL; line = gap + strspn(gap, " ")) {
      pl_notation_words(&out, pl_copy_n(g->arena, line, (size_t)(gap - line)));
      pl_text_add(&out, "\\qquad ");
    }
    pl_notation_words(&out, line);
    pl_text_addf(g->out, s == motion ? "\n\\plheading{%s}\n" : "\n%s\n", pl_text_string(&out));
    s += n + (s[n] == '\n');
  }
}

static void put_checks(pl_tex_page* g, const pl_solution* s) {
  const char* const label[2] = {PL_BOTH("Checks")};
  const char* const passed[2] = {PL_BOTH("all passed")};
  const char* const failed[2] = {PL_BOTH("failed")};
  if (s->checks.n == 0) return;
  bool all = true;
  pl_text_addf(g->out, "\n\\medskip\\emph{%s.} ", label[g->how.lang]);
  for (int i = 0; i < s->checks.n; i++) {
    const pl_check* c = &s->checks.at[i];
    const char* name = c->name[g->how.lang] ? c->name[g->how.lang] : c->name[0];
    pl_text_addf(g->out, "%s%s", i ? "; " : "", pl_tex_plain(g, name));
    if (!c->passed) pl_text_addf(g->out, " \\textbf{(%s)}", failed[g->how.lang]);
    all = all && c->passed;
  }
  pl_text_addf(g->out, all ? ": %s.\n" : ".\n", passed[g->how.lang]);
}

static void put_used(pl_tex_page* g, const pl_solution* s) {
  const char* const label[2] = {PL_BOTH("Used")};
  if (s->used.n == 0) return;
  pl_text_addf(g->out, "\n\\emph{%s.} ", label[g->how.lang]);
  for (int i = 0; i < s->used.n; i++) {
    pl_text_addf(g->out, "%s$%s$", i ? ", " : "",
                 pl_tex_math(g, pl_form_name(g->arena, s->used.at[i], pl_poison())));
  }
  pl_text_add(g->out, ".\n");
}

// --------------------------------------------------------------------------------------------- all
// "dir/atwood.pleuel" is atwood.
static const char* base_name(pl_arena* a, const char* path) {
  if (!path || *path == '<') return "model";
  const char* slash = strrchr(path, '/');
  const char* name = slash ? slash + 1 : path;
  return pl_copy_n(a, name, strcspn(name, "."));
}

void pl_tex(pl_text* out, const pl_solution* s, const pl_diagnostics* notes,
            const pl_tex_style* style) {
  pl_arena* a = out->arena;
  const pl_model* m = s->model;
  const char* name = base_name(a, style->name);
  pl_tex_page g = {.out = out,
                   .arena = a,
                   .pool = m->pool,
                   .style = style,
                   .how = {PL_MATH_TEX, style->lang},
                   .slug = pl_tex_slug(a, name, "model")};
  pl_tex_gather_labels(&g, s);
  pl_text_addf(out, "%% pleuel tex %s\n", g.slug);
  if (style->standalone) pl_text_add(out, preamble);
  pl_text_add(out, macros);
  if (!style->plain) pl_text_add(out, accents);
  if (style->standalone) put_title(&g, m);
  if (style->scene) pl_tex_figure(&g, style->scene);
  pl_tex_sections(&g, s);
  put_notes(&g, s, notes);
  put_motion(&g, style->motion);
  put_checks(&g, s);
  put_used(&g, s);
  if (style->standalone) pl_text_add(out, "\\end{document}\n");
}
