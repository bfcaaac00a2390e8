// Orders one by one: a program of few lines is written out for each order, so that nothing is
// addressed by k and there are no loops. Numbers that a program stores for itself alone stay in
// registers. Rows of streams, whose numbers come one after the other, are put together in a
// register when a sum reads them first, and stored as a whole: a row read from eight stores of one
// number each would wait until these have left the processor's store buffer.
#include <stdlib.h>
#include <string.h>

#include "jit/llvm_emit_impl.h"

struct pl_written {
  int order;
  LLVMValueRef* known;  // by place: the number there, in the function at work
  // by place / 8: the row there, or what a sum or product has put there, at the order at work
  LLVMValueRef* row;
  int* width;     // of that register
  bool* pending;  // by place / 8: numbers of this row are known, but not in memory
  int* pending_list;
  int n_pending;
  bool* of_stream;  // by place: row 0 of a stream whose rows the program writes there
  bool* own;        // by place: read by products of this program only
  size_t places;
};

// ------------------------------------------------------------------------------------------ places
static LLVMValueRef load(pl_emit* e, long at, int width) {
  return pl_emit_load(e, e->memory, at, width);
}

static LLVMValueRef entry_of(pl_emit* e, LLVMValueRef vector, int lane) {
  return LLVMBuildExtractElement(e->build, vector, pl_emit_whole(e, lane), "");
}

static LLVMValueRef known_load(pl_emit* e, long at) {
  pl_written* w = e->written;
  LLVMValueRef row = w->row[at / 8];
  int lane = (int)(at % 8);
  if (!w->known[at])
    w->known[at] = row && lane < w->width[at / 8] ? entry_of(e, row, lane) : load(e, at, 1);
  return w->known[at];
}

static void known_store(pl_emit* e, LLVMValueRef x, long at, bool row_of_stream) {
  pl_written* w = e->written;
  w->known[at] = x;
  if (w->own[at]) return;
  if (!row_of_stream) {
    pl_emit_store(e, x, e->memory, at, 1);
    return;
  }
  w->row[at / 8] = NULL;
  if (!w->pending[at / 8]) w->pending_list[w->n_pending++] = (int)(at / 8);
  w->pending[at / 8] = true;
}

// -------------------------------------------------------------------------------------------- rows
// So many lanes of a stream are in use.
static int lanes_of(const pl_written* w, int stream) {
  for (int l = 7; l >= 4; l--)
    if (w->of_stream[stream + l]) return 8;
  return 4;
}

static void store_numbers(pl_emit* e, long row) {
  for (int l = 0; l < 8; l++)
    if (e->written->known[8 * row + l])
      pl_emit_store(e, e->written->known[8 * row + l], e->memory, 8 * row + l, 1);
}

static bool complete(const pl_written* w, int stream, long row) {
  for (int l = 0; l < 8; l++)
    if (w->of_stream[stream + l] && !w->known[8 * row + l]) return false;
  return true;
}

static void put_together(pl_emit* e, int stream, long row) {
  pl_written* w = e->written;
  int width = lanes_of(w, stream);
  LLVMValueRef x = pl_emit_number(e, 0, width);
  for (int l = 0; l < width; l++)
    if (w->of_stream[stream + l])
      x = LLVMBuildInsertElement(e->build, x, w->known[8 * row + l], pl_emit_whole(e, l), "");
  pl_emit_store(e, x, e->memory, 8 * row, width);
  w->row[row] = x;
  w->width[row] = width;
}

static LLVMValueRef low_half(pl_emit* e, LLVMValueRef x) {
  LLVMTypeRef t = LLVMInt32TypeInContext(e->context);
  LLVMValueRef lanes[4];
  for (unsigned l = 0; l < 4; l++) lanes[l] = LLVMConstInt(t, l, 0);
  return LLVMBuildShuffleVector(e->build, x, LLVMGetUndef(e->vector), LLVMConstVector(lanes, 4),
                                "");
}

static LLVMValueRef row_of(pl_emit* e, int stream, int j, int width) {
  pl_written* w = e->written;
  long row = stream / 8 + j;
  if (w->pending[row]) {
    w->pending[row] = false;
    if (complete(w, stream, row)) put_together(e, stream, row);
    else store_numbers(e, row);
  }
  if (!w->row[row] || w->width[row] < width) return load(e, 8 * row, width);
  return w->width[row] > width ? low_half(e, w->row[row]) : w->row[row];
}

// What the next function, or a code that runs later, reads from memory.
static void store_pending(pl_emit* e) {
  pl_written* w = e->written;
  for (int i = 0; i < w->n_pending; i++) {
    if (w->pending[w->pending_list[i]]) store_numbers(e, w->pending_list[i]);
    w->pending[w->pending_list[i]] = false;
  }
  w->n_pending = 0;
}

// ------------------------------------------------------------------------------- sums and products
// Half a register is enough for a sum whose upper lanes are empty.
static int width_of(const pl_emit* e, const pl_prog_sum* s) {
  const pl_prog_pair* pairs = e->prog->pairs.at + s->first;
  for (int p = 0; p < s->n; p++)
    if (lanes_of(e->written, pairs[p].a) == 8 && lanes_of(e->written, pairs[p].b) == 8) return 8;
  return 4;
}

static void put(pl_emit* e, LLVMValueRef x, long at, int width) {
  pl_written* w = e->written;
  w->row[at / 8] = x;
  w->width[at / 8] = width;
  for (int l = 0; l < 8; l++) w->known[at + l] = NULL;
}

static void sum(pl_emit* e, const pl_prog_sum* s, int K) {
  const pl_prog_pair* pairs = e->prog->pairs.at + s->first;
  LLVMValueRef part[PL_PROG_PARTS];
  int parts = pl_prog_parts(s), width = width_of(e, s);
  for (int i = 0; i < parts; i++) part[i] = pl_emit_number(e, 0, width);
  for (int j = K / 2; j >= 1; j--)
    for (int p = 0; p < s->n; p++) {
      LLVMValueRef *up = &part[2 * p % parts], *down = &part[(2 * p + 1) % parts];
      *up = pl_emit_fused(e, row_of(e, pairs[p].a, j, width), row_of(e, pairs[p].b, K - j, width),
                          *up, width);
      if (2 * j == K) continue;
      *down = pl_emit_fused(e, row_of(e, pairs[p].a, K - j, width), row_of(e, pairs[p].b, j, width),
                            *down, width);
    }
  LLVMValueRef x = pl_emit_total(e, part, parts);
  if (s->scale >= 0)
    x = pl_emit_scaled(e, x, load(e, s->scale + 8L * K, width), load(e, s->rest + 8L * K, width),
                       width);
  put(e, x, s->to, width);
}

static LLVMValueRef known_column(pl_emit* e, const pl_prog_product* p, int j, int row) {
  return known_load(e, p->matrix + j * p->blocks * 8 + row);
}

static LLVMValueRef known_entry(pl_emit* e, const pl_prog_product* p, int j, int row) {
  (void)row;
  return known_load(e, p->vector + j);
}

static LLVMValueRef column(pl_emit* e, const pl_prog_product* p, int j, int block) {
  return load(e, p->matrix + (j * p->blocks + block) * 8, 8);
}

static LLVMValueRef spread_entry(pl_emit* e, const pl_prog_product* p, int j, int block) {
  (void)block;
  return pl_emit_spread(e, known_load(e, p->vector + j), 8);
}

static void product(pl_emit* e, const pl_prog_product* p) {
  enum { FEW = 4 };
  pl_written* w = e->written;
  if (p->n <= FEW)
    for (int i = 0; i < p->n; i++)
      w->known[p->to + i] = pl_emit_product_sum(e, p, i, 1, known_column, known_entry);
  else
    for (int b = 0; b < p->blocks; b++)
      put(e, pl_emit_product_sum(e, p, b, 8, column, spread_entry), p->to + 8 * b, 8);
}

// -------------------------------------------------------------------------------- lines, functions
bool pl_written_line(pl_emit* e, const pl_prog_line* l, LLVMValueRef x, LLVMValueRef* out) {
  long at = l->at + (long)l->by * e->written->order;
  const pl_prog_block* b;
  *out = NULL;
  switch (l->op) {
    case PL_PROG_LOAD: *out = known_load(e, at); return true;
    case PL_PROG_STORE: known_store(e, x, at, l->by == 8); return true;
    case PL_PROG_ORDER:
      *out = pl_emit_number(e, (double)(e->written->order + l->at), 1);
      return true;
    case PL_PROG_SUMS:
      b = &e->prog->blocks.at[l->at];
      for (int i = b->first; i < b->first + b->n; i++)
        sum(e, &e->prog->sums.at[i], e->written->order + b->shift);
      return true;
    case PL_PROG_PRODUCT: product(e, &e->prog->products.at[l->at]); return true;
    default: return false;
  }
}

// Orders from .. until a function is full; returns the next.
static int emit_orders(pl_emit* e, int from, LLVMValueRef* function) {
  const pl_prog* p = e->prog;
  pl_written* w = e->written;
  char name[128];
  snprintf(name, sizeof name, "%s_from_%d", p->name, from);
  *function = e->function = pl_emit_begin(e, name, e->line_type);
  LLVMSetLinkage(e->function, LLVMInternalLinkage);
  memset(w->known, 0, w->places * sizeof(LLVMValueRef));
  for (int operations = 0; from < p->orders && operations < PL_EMIT_WRITTEN; from++) {
    w->order = from;
    memset(w->row, 0, (w->places / 8 + 1) * sizeof(LLVMValueRef));
    for (int i = 0; i < p->lines.n; i++) {
      LLVMValueRef x = pl_emit_line(e, &p->lines.at[i]);
      if (p->lines.at[i].d >= 0) e->value[p->lines.at[i].d] = x;
    }
    operations += p->lines.n + p->pairs.n * 2 * from;
  }
  store_pending(e);
  LLVMBuildRetVoid(e->build);
  return from;
}

void pl_written_emit(pl_emit* e, LLVMValueRef* functions) {
  int n = 0;
  for (int k = e->prog->first_order; k < e->prog->orders;) k = emit_orders(e, k, &functions[n++]);
  LLVMValueRef f = pl_emit_begin(e, e->prog->name, e->run_type), zero = pl_emit_whole(e, 0);
  for (int i = 0; i < n; i++)
    LLVMBuildCall2(e->build, e->line_type, functions[i], (LLVMValueRef[]){LLVMGetParam(f, 0), zero},
                   2, "");
  LLVMBuildRetVoid(e->build);
}

// ---------------------------------------------------------------------------------- beginning, end
static void find_used(pl_emit* e) {
  const pl_prog* p = e->prog;
  for (int i = 0; i < p->lines.n; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    if (l->op != PL_PROG_STORE || l->by != 8) continue;
    for (int row = 0; row < 3 && l->at - 8 * row >= 0; row++)
      e->written->of_stream[l->at - 8 * row] = true;
  }
  for (int i = 0; i < p->products.n; i++)
    for (int j = 0; j < p->products.at[i].n; j++)
      e->written->own[p->products.at[i].vector + j] = true;
}

bool pl_written_make(pl_emit* e) {
  pl_written* w = e->written = calloc(1, sizeof *w);
  if (!w) return false;
  size_t n = w->places = (size_t)e->prog->spill + 16;
  w->known = calloc(n, sizeof *w->known);
  w->row = calloc(n / 8 + 1, sizeof *w->row);
  w->width = calloc(n / 8 + 1, sizeof *w->width);
  w->pending = calloc(n / 8 + 1, sizeof *w->pending);
  w->pending_list = calloc(n * (size_t)(e->prog->orders + 1), sizeof *w->pending_list);
  w->of_stream = calloc(n, sizeof *w->of_stream);
  w->own = calloc(n, sizeof *w->own);
  if (!w->known || !w->row || !w->width || !w->pending || !w->pending_list || !w->of_stream
      || !w->own)
    return false;
  find_used(e);
  return true;
}

void pl_written_free(pl_emit* e) {
  pl_written* w = e->written;
  if (!w) return;
  free(w->known);
  free(w->row);
  free(w->width);
  free(w->pending);
  free(w->pending_list);
  free(w->of_stream);
  free(w->own);
  free(w);
  e->written = NULL;
}
