// pages: what the library can tell without a model. Pages on messages, units, examples, the model
// to start from.
#include <math.h>
#include <string.h>

#include "api/api_impl.h"

// ----------------------------------------------------------------------------------- guarded texts
typedef const char* pl_page_work(pleuel* ctx, const char* argument);

// Runs work under a guard on the context's memory; NULL when that runs out.
static const char* guarded_page(pleuel* ctx, pl_page_work* work, const char* argument) {
  if (!ctx) return NULL;
  ctx->message[0] = '\0';
  const char* volatile text = NULL;
  pl_guard guard;
  PL_GUARD(ctx->arena, guard) { text = work(ctx, argument); }
  else {
    snprintf(ctx->message, sizeof ctx->message, "memory ran out");
  }
  pl_guard_end(ctx->arena, &guard);
  return text;
}

// ---------------------------------------------------------------------------------------- messages
static const char* embedded(const pl_embedded* table, const char* name) {
  for (; table->name; table++) {
    if (strcmp(table->name, name) == 0) return table->text;
  }
  return NULL;
}

// A code without a page of its own still has its title.
static const char* explain(pleuel* ctx, const char* name) {
  const char* page = embedded(pl_pages, name);
  pl_code code;
  if (page || !pl_code_find(name, &code)) return page;
  return pl_format(ctx->arena, "# %s: %s\n", name, pl_code_title(code, ctx->lang));
}

const char* pleuel_explain(pleuel* ctx, const char* code) {
  return code ? guarded_page(ctx, explain, code) : NULL;
}

static const char* codes(pleuel* ctx, const char* unused) {
  pl_text out = pl_text_make(ctx->arena);
  for (int c = 0; c < PL_N_CODES; c++) {
    pl_text_addf(&out, "%s  %s\n", pl_code_name((pl_code)c), pl_code_title((pl_code)c, ctx->lang));
  }
  return pl_text_string(&out);
}

const char* pleuel_codes(pleuel* ctx) { return guarded_page(ctx, codes, NULL); }

// --------------------------------------------------------------------------------- no model at all
typedef struct pl_no_model {
  const char* file;
  char message[512];
  pleuel_status status;
} pl_no_model;

static const char* failure_json(pleuel* ctx, const pl_no_model* f) {
  pl_text out = pl_text_make(ctx->arena);
  pl_json_input in = {.file = f->file,
                      .status = f->status,
                      .message = pl_copy(ctx->arena, f->message),
                      .lang = ctx->lang};
  pl_worked_json(&out, &in);
  return pl_text_string(&out);
}

const char* pleuel_failure_json(pleuel* ctx, const char* file, pleuel_status status) {
  if (!ctx) return NULL;
  pl_no_model f = {.file = file, .status = status};
  memcpy(f.message, ctx->message, sizeof f.message);
  const char* volatile text = NULL;
  pl_guard guard;
  PL_GUARD(ctx->arena, guard) { text = failure_json(ctx, &f); }
  pl_guard_end(ctx->arena, &guard);
  return text;
}

// ------------------------------------------------------------------------------- units, quantities
static const char* units(pleuel* ctx, const char* unit) {
  pl_pool* pool = pl_pool_make(ctx->arena);
  pl_unit parsed;
  size_t at, n;
  const char* near = NULL;
  const char* text = pl_unit_explain(ctx->arena, pool, unit, ctx->lang);
  size_t length = strlen(text);
  while (length > 0 && text[length - 1] == '\n') length--;
  if (pl_unit_parse(pool, unit, strlen(unit), &parsed, &at, &n, &near))
    return pl_format(ctx->arena, "%.*s\n", (int)length, text);
  snprintf(ctx->message, sizeof ctx->message, "%.*s", (int)length, text);
  return NULL;
}

pleuel_status pleuel_units(pleuel* ctx, const char** text, const char* unit) {
  if (text) *text = NULL;
  if (!ctx || !unit) return PLEUEL_USAGE;
  const char* answer = guarded_page(ctx, units, unit);
  if (text) *text = answer;
  return answer ? PLEUEL_OK : PLEUEL_USAGE;
}

// The number of a quantity such as 500[ms], in SI; what is wrong with it, or NULL.
static const char* read_quantity(pl_arena* a, pl_pool* pool, const char* text, pl_expr* out) {
  size_t n = strcspn(text, "[");
  const char* unit = text + n;
  while (n > 0 && text[n - 1] == ' ') n--;
  bool minus = n > 0 && text[0] == '-';
  pl_expr number = pl_number_from_text(pool, text + minus, n - minus);
  if (n == minus || pl_is_poison(number)) return "this is no number";
  if (*unit) {
    const char* close = strchr(unit, ']');
    pl_unit parsed;
    size_t at, bad;
    const char* near = NULL;
    if (!close || close[1]) return "a unit stands in [ ] behind the number";
    if (!pl_unit_parse(pool, unit + 1, (size_t)(close - unit - 1), &parsed, &at, &bad, &near)) {
      return near ? pl_format(a, "unknown unit; did you mean %s?", near) : "unknown unit";
    }
    number = pl_mul(pool, number, parsed.scale);
  }
  *out = minus ? pl_neg(pool, number) : number;
  return NULL;
}

static const char* number_of(pleuel* ctx, const char* text, double* value) {
  pl_pool* pool = pl_pool_make(ctx->arena);
  pl_expr number;
  const char* fault = read_quantity(ctx->arena, pool, text, &number);
  if (fault == NULL)
    *value = pl_eval(pool, number, PL_ARRAY(ctx->arena, double, pl_symbol_count(pool) + 1));
  return fault;
}

const char* pl_quantity_parts(pl_arena* a, const char* text, double part[3]) {
  pl_pool* pool = pl_pool_make(a);
  pl_expr number;
  const char* fault = read_quantity(a, pool, text, &number);
  if (fault == NULL && !pl_is_number(pool, number)) fault = "this is no rational number";
  if (fault == NULL) pl_number_doubles(pool, number, part);
  return fault;
}

pleuel_status pleuel_quantity(pleuel* ctx, double* value, const char* text) {
  if (!ctx || !value || !text) return PLEUEL_USAGE;
  ctx->message[0] = '\0';
  const char* volatile fault = "memory ran out";
  pl_guard guard;
  PL_GUARD(ctx->arena, guard) { fault = number_of(ctx, text, value); }
  pl_guard_end(ctx->arena, &guard);
  if (fault) snprintf(ctx->message, sizeof ctx->message, "%s", fault);
  return fault ? PLEUEL_USAGE : PLEUEL_OK;
}

// ---------------------------------------------------------------------------- models to start from
// The template's own name stands between the quotes of its `system` line; it is replaced.
static const char* template(pleuel* ctx, const char* name) {
  const char* text = pl_templates[0].text;
  const char* at = text ? strstr(text, "system \"") : NULL;
  if (!at) return text;
  at += strlen("system \"");
  const char* end = at + strcspn(at, "\"\n");
  char title[128];
  size_t n = 0;
  for (const char* c = name; *c && n + 1 < sizeof title; c++) {
    if ((unsigned char)*c >= ' ' && *c != '"' && *c != '\\') title[n++] = *c;
  }
  title[n] = '\0';
  return pl_format(ctx->arena, "%.*s%s%s", (int)(at - text), text, title, end);
}

const char* pleuel_template(pleuel* ctx, const char* name) {
  return name ? guarded_page(ctx, template, name) : NULL;
}

const char* pleuel_example(size_t i, const char** name) {
  size_t n = 0;
  while (pl_examples[n].name) n++;
  if (i >= n) return NULL;
  if (name) *name = pl_examples[i].name;
  return pl_examples[i].text;
}
