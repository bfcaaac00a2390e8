// The motion as it is looked at: rows on an even grid that is fine enough for a picture, and beside
// the columns of `sim` the quantities of the `plot` lines. Without such lines: coordinates,
// multipliers, energies.
#include <math.h>
#include <string.h>

#include "api/api_impl.h"

enum {
  FEWEST_ROWS = 320,
  A_STEP = 3,
  MOST_FINER = 2400,
  MOST_ROWS = 20000,
  MOST_CURVES = 4,
  MOST_PLOTS = 8
};

// --------------------------------------------------------------------------------- what is plotted
// A quantity of a plot line becomes an output of the run under this name.
static const char* hidden_name(pl_arena* a, int plot, int curve) {
  return pl_format(a, "plot %d %d", plot, curve);
}

static void add_outputs(pleuel_model* m) {
  pl_model* model = m->model;
  for (int i = 0; i < model->plots.n; i++) {
    const pl_plot* p = &model->plots.at[i];
    for (int k = -1; k < p->y.n; k++) {
      pl_output o = {.name = hidden_name(m->work, i, k),
                     .value = k < 0 ? p->x : p->y.at[k],
                     .span = p->span,
                     .optional = true};
      pl_push(m->arena, model->outputs, o);
    }
  }
}

// A name as it is displayed: dots over letters, small indices.
static const char* shown_name(pl_views* v, pl_pool* p, pl_symbol s) {
  return pl_notation_symbol(v->arena, p, s, (pl_notation){PL_MATH_2D, PL_ENGLISH});
}

static const char* column_name(pl_views* v, pl_pool* p, const char* name) {
  pl_symbol s = pl_symbol_find(p, name);
  return s.id ? shown_name(v, p, s) : name;
}

static const char* unicode_unit(pl_arena* a, const char* unit) {
  if (!unit) return "";
  pl_text t = pl_text_make(a);
  for (const char* c = unit; *c; c++) {
    if (c[0] == '^' && c[1] == '2') {
      pl_text_add(&t, "²");
      c++;
    } else if (c[0] == '^' && c[1] == '3') {
      pl_text_add(&t, "³");
      c++;
    } else pl_text_add_n(&t, c, 1);
  }
  return pl_text_string(&t);
}

// The unit of a plotted quantity; that of a coordinate or multiplier is the one of its column, so
// that angles are in rad.
static const char* unit_of(pl_views* v, pl_pool* p, pl_expr e, int column) {
  const char* own = v->result->columns[column].unit;
  if (pl_kind_of(p, e) != PL_SYMBOL) return unicode_unit(v->arena, own);
  int plain = pl_result_find(v->result, pl_symbol_get(p, pl_symbol_of(p, e))->ascii);
  return unicode_unit(v->arena, plain >= 0 ? v->result->columns[plain].unit : own);
}

static bool names_output(const pl_model* m, const char* text) {
  for (int i = 0; i < m->outputs.n; i++) {
    if (strcmp(m->outputs.at[i].name, text) == 0) return true;
  }
  return false;
}

static const char* curve_name(pl_views* v, const pl_model* m, pl_expr e, const char* text) {
  bool symbol = pl_kind_of(m->pool, e) == PL_SYMBOL && !names_output(m, text);
  return symbol ? shown_name(v, m->pool, pl_symbol_of(m->pool, e)) : text;
}

// ------------------------------------------------------------------------------------------- plots
static void add_curve(pl_views* v, pl_html_plot* plot, pl_html_curve c) {
  pl_html_curve* more = PL_ARRAY(v->arena, pl_html_curve, plot->n_curves + 1);
  for (int i = 0; i < plot->n_curves; i++) more[i] = plot->curves[i];
  more[plot->n_curves++] = c;
  plot->curves = more;
}

static pl_html_plot* new_plot(pl_views* v) {
  pl_html_plot p = {.x_column = 0};
  pl_push(v->arena, v->plots, p);
  return &v->plots.at[v->plots.n - 1];
}

static double size_of(const pl_result* r, int column) {
  double size = 0;
  for (int i = 0; i < r->rows.n; i++)
    if (fabs(r->rows.at[i][column]) > size) size = fabs(r->rows.at[i][column]);
  return size;
}

// The plot that takes another curve of this unit, among those from `first` on; curves of very
// different size (0: whatever it is) would hide each other.
static pl_html_plot* plot_for(pl_views* v, int first, const char* unit, double size) {
  for (int i = first; i < v->plots.n; i++) {
    pl_html_plot* p = &v->plots.at[i];
    double there = size > 0 ? size_of(v->result, p->curves[0].column) : 0;
    bool alike = !(size > 0) || (size < 8 * there && there < 8 * size);
    if (p->n_curves < MOST_CURVES && alike && strcmp(p->curves[0].unit, unit) == 0) return p;
  }
  return v->plots.n < MOST_PLOTS ? new_plot(v) : NULL;
}

static void plot_line(pl_views* v, pleuel_model* m, int i) {
  const pl_plot* line = &m->model->plots.at[i];
  pl_pool* p = m->model->pool;
  bool over_time = pl_kind_of(p, line->x) == PL_SYMBOL
                   && pl_symbol_of(p, line->x).id == pl_time(p).id;
  int x = over_time
              ? 0
              : pl_result_find(v->result, pl_ascii_of(v->arena, hidden_name(v->arena, i, -1)));
  if (x < 0) return;
  int first = v->plots.n;
  for (int k = 0; k < line->y.n; k++) {
    int column = pl_result_find(v->result, pl_ascii_of(v->arena, hidden_name(v->arena, i, k)));
    if (column < 0) continue;
    const char* unit = unit_of(v, p, line->y.at[k], column);
    pl_html_plot* plot = plot_for(v, first, unit, 0);
    if (!plot) continue;
    add_curve(
        v, plot,
        (pl_html_curve){curve_name(v, m->model, line->y.at[k], line->y_text.at[k]), unit, column});
    if (over_time) continue;
    plot->x_column = x;
    plot->x_name = curve_name(v, m->model, line->x, line->x_text);
    plot->x_unit = unit_of(v, p, line->x, x);
  }
}

// Does a column change enough to be looked at?
static bool moves(const pl_result* r, int column) {
  double lo = INFINITY, hi = -INFINITY;
  for (int i = 0; i < r->rows.n; i++) {
    double x = r->rows.at[i][column];
    if (isnan(x)) continue;
    if (x < lo) lo = x;
    if (x > hi) hi = x;
  }
  double size = fmax(fabs(lo), fabs(hi));
  return lo < hi && hi - lo > 1e-9 * size && size > 1e-12;
}

static void plot_columns(pl_views* v, pleuel_model* m, int from, int to) {
  int first = v->plots.n, n = 0;
  for (int i = from; i < to; i++) n += moves(v->result, i);
  int most = 2 * MOST_CURVES, step = n > most ? n / most : 1, k = 0;
  for (int i = from; i < to; i++) {
    if (!moves(v->result, i) || k++ % step != 0) continue;
    const pl_result_column* c = &v->result->columns[i];
    const char* unit = unicode_unit(v->arena, c->unit);
    pl_html_plot* plot = plot_for(v, first, unit, size_of(v->result, i));
    if (plot) add_curve(v, plot, (pl_html_curve){column_name(v, m->model->pool, c->name), unit, i});
  }
}

// A quantity of a `plot` line that has no column has no number along the motion: that is said.
static const char* missing_quantities(pl_views* v, const pl_model* m) {
  pl_text names = pl_text_make(v->arena);
  int n = 0;
  for (int i = 0; i < m->plots.n; i++) {
    const pl_plot* line = &m->plots.at[i];
    for (int k = -1; k < line->y.n; k++) {
      const char* column = pl_ascii_of(v->arena, hidden_name(v->arena, i, k));
      if (pl_result_find(v->result, column) >= 0) continue;
      pl_text_addf(&names, "%s%s", n++ ? ", " : "", k < 0 ? line->x_text : line->y_text.at[k]);
    }
  }
  return n ? pl_text_string(&names) : NULL;
}

static int count_shown(const pl_setup* s) {
  int n = 0;
  for (int i = 0; i < s->n_q; i++) n += !s->coordinates[i].hidden;
  return n;
}

static int count_multipliers(const pl_setup* s) {
  int n = 0;
  for (int i = 0; i < s->n_c; i++) n += s->constraints[i].column != NULL;
  return n;
}

static void plot_energies(pl_views* v, const pl_model* m) {
  const char* const name[] = {pl_model_column(m, v->arena, "T"), pl_model_column(m, v->arena, "V"),
                              pl_model_column(m, v->arena, "E")};
  pl_html_plot* plot = NULL;
  for (int i = 0; i < 3; i++) {
    int column = pl_result_find(v->result, name[i]);
    if (column < 0 || (i < 2 && !moves(v->result, column)) || (i == 2 && !plot)) continue;
    if (!plot) plot = new_plot(v);
    plot->title = v->lang == PL_GERMAN ? pl_german("Energies") : "Energies";
    add_curve(
        v, plot,
        (pl_html_curve){name[i], unicode_unit(v->arena, v->result->columns[column].unit), column});
  }
}

static void choose_plots(pl_views* v, pleuel_model* m) {
  const pl_setup* s = &m->recording->setup;
  int n_q = count_shown(s), n_c = count_multipliers(s);
  for (int i = 0; i < m->model->plots.n; i++) plot_line(v, m, i);
  if (v->plots.n == 0) {
    plot_columns(v, m, 1, 1 + n_q);
    plot_columns(v, m, 1 + 2 * n_q, 1 + 2 * n_q + n_c);
  }
  plot_energies(v, m->model);
}

// ----------------------------------------------------------------------------------------- the run
// The rows that the file asks for, divided further until there are enough for a picture.
static long grid_of(const pl_recording* r) {
  double span = fabs(r->t_end - r->t_0);
  double given = r->count > 0                  ? (double)r->count
                 : r->dt > 0 && isfinite(span) ? floor(span / r->dt + 0.5)
                                               : 1;
  if (!(given >= 1) || given > MOST_ROWS) return r->count > 0 || r->dt > 0 ? 0 : FEWEST_ROWS;
  bool even = r->count > 0 || (r->dt > 0 && fabs(given * r->dt - span) < 1e-9 * span);
  if (!even && r->dt > 0) return 0;
  long n = (long)given;
  return n >= FEWEST_ROWS ? n : n * ((FEWEST_ROWS + n - 1) / n);
}

static pleuel_status run_once(pleuel_model* m, pl_views* v, long count) {
  if (count > 0) {
    m->recording->count = count;
    m->recording->dt = 0;
  }
  PLEUEL_OPTIONS(pleuel_sim_options, how);
  pl_pipeline_forget_run(m);
  m->result = pl_result_make(m->motion, true);
  pl_run* r = NULL;
  pleuel_status s = pl_pipeline_start(m, &how, &r);
  if (s == PLEUEL_OK) s = pl_run_to_end(r);
  if (r) pl_run_free(r);
  v->result = m->result;
  return s;
}

// A motion that takes many steps needs more rows than one that takes few, which is known only
// afterwards.
static pleuel_status run(pleuel_model* m, pl_views* v) {
  m->recorded = pl_pipeline_record(m);
  if (m->recorded != PLEUEL_OK) return m->recorded;
  if (isnan(m->recording->t_end)) return PLEUEL_USAGE;
  long count = grid_of(m->recording);
  pleuel_status s = run_once(m, v, count);
  long wanted = v->result ? A_STEP * v->result->stats.steps : 0;
  if (s != PLEUEL_OK || count <= 0 || wanted <= count) return s;
  if (wanted > MOST_FINER) wanted = MOST_FINER;
  long times = (wanted + count - 1) / count;
  return times > 1 ? run_once(m, v, times * count) : s;
}

// Nothing of this is remembered as "the run" of the model, which has the columns and rows that the
// file asks for.
pleuel_status pl_views_make(pleuel_model* m, pl_language lang, pl_views* v) {
  *v = (pl_views){.arena = m->work, .lang = lang};
  if (!m->model->simulate.given) return PLEUEL_OK;
  int n_outputs = m->model->outputs.n;
  add_outputs(m);
  m->is_recorded = false;
  m->run = run(m, v);
  m->is_run = true;
  if (m->run != PLEUEL_OK) snprintf(m->run_message, sizeof m->run_message, "%s", m->job.message);
  v->message = m->run == PLEUEL_OK ? NULL : pl_copy(m->work, m->run_message);
  v->tol = m->tol_used;
  if (v->result && v->result->rows.n > 1) {
    v->n_columns = v->result->n_columns;
    for (int i = v->n_columns - 1; i >= 0 && strncmp(v->result->columns[i].name, "plot ", 5) == 0;
         i--)
      v->n_columns--;
    v->energy_conserved = m->recording->setup.energy_conserved;
    v->missing = missing_quantities(v, m->model);
    choose_plots(v, m);
  } else {
    v->result = NULL;
  }
  m->model->outputs.n = n_outputs;
  m->is_recorded = false;
  return m->run;
}
