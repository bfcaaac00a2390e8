// From programs to LLVM's intermediate language: one instruction of a program is one instruction
// there, so that both round alike. A program is cut into functions of at most 1500 lines, because
// compilers take more than their share of time for long ones; registers that are read behind a cut
// travel through memory.
#include "jit/llvm_emit_impl.h"

#include <stdlib.h>
#include <string.h>

static const int reads_of[PL_N_PROG_OPS] = {
#define PL_PROG(name, reads, meaning) reads,
#include "program/prog.def"
#undef PL_PROG
};

// ------------------------------------------------------------------------------------------ memory
// memory + k by, computed once a function.
static LLVMValueRef strided(pl_emit* e, int by) {
  if (by == 0) return e->memory;
  for (int i = 0; i < e->n_strides; i++)
    if (e->stride_by[i] == by) return e->stride[i];
  LLVMValueRef p = pl_emit_offset(e, e->memory,
                                  LLVMBuildMul(e->build, e->k, pl_emit_whole(e, by), ""));
  if (e->n_strides < PL_EMIT_STRIDES) {
    e->stride_by[e->n_strides] = by;
    e->stride[e->n_strides++] = p;
  }
  return p;
}

// -------------------------------------------------------------------------------------------- sums
static LLVMValueRef weigh(pl_emit* e, LLVMValueRef a, LLVMValueRef j, int width) {
  LLVMValueRef x = LLVMBuildSIToFP(e->build, j, e->number, "");
  return LLVMBuildFMul(e->build, pl_emit_spread(e, x, width), a, "");
}

// acc + A_ja B_jb; at_ja and at_jb are memory + j width.
static LLVMValueRef add_row(pl_emit* e, const pl_prog_sum* s, pl_prog_pair p, LLVMValueRef acc,
                            LLVMValueRef ja, LLVMValueRef at_ja, LLVMValueRef at_jb, int width) {
  LLVMValueRef a = pl_emit_load(e, at_ja, p.a, width), b = pl_emit_load(e, at_jb, p.b, width);
  if (s->weighted) a = weigh(e, a, ja, width);
  return pl_emit_fused(e, a, b, acc, width);
}

static LLVMValueRef row(pl_emit* e, LLVMValueRef j, int width) {
  return pl_emit_offset(e, e->memory, LLVMBuildMul(e->build, j, pl_emit_whole(e, width), ""));
}

// The parts of all sums of a loop, one after the other.
typedef struct pl_sum_parts {
  LLVMValueRef at[PL_EMIT_ACCUMULATORS];
} pl_sum_parts;

static int parts_of(const pl_prog_sum* s, int n) {
  int parts = 0;
  for (int i = 0; i < n; i++) parts += pl_prog_parts(&s[i]);
  return parts;
}

// Row K/2 with itself, when K is even.
static pl_sum_parts middle(pl_emit* e, const pl_prog_sum* s, int n, LLVMValueRef half, int width) {
  pl_sum_parts x = {{NULL}};
  LLVMValueRef at = row(e, half, width);
  for (int i = 0, first = 0; i < n; first += pl_prog_parts(&s[i++])) {
    int parts = pl_prog_parts(&s[i]);
    for (int j = 0; j < parts; j++) x.at[first + j] = pl_emit_number(e, 0, width);
    for (int p = 0; p < s[i].n; p++) {
      LLVMValueRef* to = &x.at[first + 2 * p % parts];
      *to = add_row(e, &s[i], e->prog->pairs.at[s[i].first + p], *to, half, at, at, width);
    }
  }
  return x;
}

static void both_rows(pl_emit* e, const pl_prog_sum* s, int n, pl_sum_parts* x, LLVMValueRef j,
                      LLVMValueRef other, int width) {
  LLVMValueRef at_j = row(e, j, width), at_other = row(e, other, width);
  for (int i = 0, first = 0; i < n; first += pl_prog_parts(&s[i++])) {
    int parts = pl_prog_parts(&s[i]);
    for (int p = 0; p < s[i].n; p++) {
      pl_prog_pair pair = e->prog->pairs.at[s[i].first + p];
      LLVMValueRef *up = &x->at[first + 2 * p % parts], *down = &x->at[first + (2 * p + 1) % parts];
      *up = add_row(e, &s[i], pair, *up, j, at_j, at_other, width);
      *down = add_row(e, &s[i], pair, *down, other, at_other, at_j, width);
    }
  }
}

static void store_sums(pl_emit* e, const pl_prog_sum* s, int n, const pl_sum_parts* x,
                       LLVMValueRef K, int width) {
  LLVMValueRef at_K = row(e, K, width);
  for (int i = 0, first = 0; i < n; first += pl_prog_parts(&s[i++])) {
    LLVMValueRef sum = pl_emit_total(e, x->at + first, pl_prog_parts(&s[i]));
    if (s[i].scale >= 0) {
      LLVMValueRef scale = pl_emit_load(e, at_K, s[i].scale, width),
                   rest = pl_emit_load(e, at_K, s[i].rest, width);
      sum = pl_emit_scaled(e, sum, scale, rest, width);
    }
    pl_emit_store(e, sum, e->memory, s[i].to, width);
  }
}

static pl_sum_parts phis(pl_emit* e, LLVMTypeRef t, int parts) {
  pl_sum_parts x = {{NULL}};
  for (int i = 0; i < parts; i++) x.at[i] = LLVMBuildPhi(e->build, t, "");
  return x;
}

static void incoming(pl_sum_parts* phi, const pl_sum_parts* x, int parts, LLVMBasicBlockRef from) {
  for (int i = 0; i < parts; i++) LLVMAddIncoming(phi->at[i], (LLVMValueRef[]){x->at[i]}, &from, 1);
}

static LLVMBasicBlockRef new_block(pl_emit* e, const char* name) {
  return LLVMAppendBasicBlockInContext(e->context, e->function, name);
}

// Several sums in one loop over j, each with its own parts.
static void sums(pl_emit* e, const pl_prog_block* b, const pl_prog_sum* s, int n) {
  int width = b->width, parts = parts_of(s, n);
  LLVMTypeRef t = pl_emit_type_of(e, width);
  LLVMValueRef one = pl_emit_whole(e, 1),
               K = LLVMBuildAdd(e->build, e->k, pl_emit_whole(e, b->shift), "");
  LLVMValueRef half = LLVMBuildAShr(e->build, K, one, ""),
               top = LLVMBuildAShr(e->build, LLVMBuildSub(e->build, K, one, ""), one, "");
  LLVMValueRef has_middle = LLVMBuildICmp(e->build, LLVMIntNE, half, top, ""),
               some = LLVMBuildICmp(e->build, LLVMIntSGE, half, one, "");
  LLVMValueRef even = LLVMBuildAnd(e->build, has_middle, some, "");
  LLVMBasicBlockRef before = LLVMGetInsertBlock(e->build), inner = new_block(e, "middle"),
                    head = new_block(e, "head");
  LLVMBasicBlockRef loop = new_block(e, "sum"), after = new_block(e, "summed");
  pl_sum_parts none, start, now, end;
  for (int i = 0; i < parts; i++) none.at[i] = pl_emit_number(e, 0, width);
  LLVMBuildCondBr(e->build, even, inner, head);
  LLVMPositionBuilderAtEnd(e->build, inner);
  pl_sum_parts first = middle(e, s, n, half, width);
  LLVMBuildBr(e->build, head);
  LLVMPositionBuilderAtEnd(e->build, head);
  start = phis(e, t, parts);
  incoming(&start, &none, parts, before);
  incoming(&start, &first, parts, inner);
  LLVMBuildCondBr(e->build, LLVMBuildICmp(e->build, LLVMIntSGE, top, one, ""), loop, after);
  LLVMPositionBuilderAtEnd(e->build, loop);
  LLVMValueRef j = LLVMBuildPhi(e->build, e->whole, "");
  now = end = phis(e, t, parts);
  both_rows(e, s, n, &end, j, LLVMBuildSub(e->build, K, j, ""), width);
  LLVMValueRef next = LLVMBuildSub(e->build, j, one, "");
  LLVMBuildCondBr(e->build, LLVMBuildICmp(e->build, LLVMIntSGE, next, one, ""), loop, after);
  LLVMAddIncoming(j, (LLVMValueRef[]){top, next}, (LLVMBasicBlockRef[]){head, loop}, 2);
  incoming(&now, &start, parts, head);
  incoming(&now, &end, parts, loop);
  LLVMPositionBuilderAtEnd(e->build, after);
  pl_sum_parts done = phis(e, t, parts);
  incoming(&done, &start, parts, head);
  incoming(&done, &end, parts, loop);
  store_sums(e, s, n, &done, K, width);
}

// As many sums at a time as there are registers for their parts.
static void block_of_sums(pl_emit* e, const pl_prog_block* b) {
  const pl_prog_sum* s = e->prog->sums.at + b->first;
  for (int i = 0, n; i < b->n; i += n) {
    for (n = 1; i + n < b->n && parts_of(s + i, n + 1) <= PL_EMIT_ACCUMULATORS;) n++;
    sums(e, b, s + i, n);
  }
}

static LLVMValueRef column_of_block(pl_emit* e, const pl_prog_product* p, int j, int block) {
  return pl_emit_load(e, e->memory, p->matrix + (j * p->blocks + block) * 8, 8);
}

static LLVMValueRef entry_for_block(pl_emit* e, const pl_prog_product* p, int j, int block) {
  (void)block;
  return pl_emit_spread(e, pl_emit_load(e, e->memory, p->vector + j, 1), 8);
}

static void emit_product(pl_emit* e, const pl_prog_product* p) {
  for (int b = 0; b < p->blocks; b++)
    pl_emit_store(e, pl_emit_product_sum(e, p, b, 8, column_of_block, entry_for_block), e->memory,
                  p->to + b * 8, 8);
}

// ------------------------------------------------------------------------------------------- lines
static LLVMValueRef read(pl_emit* e, int r) {
  if (!e->value[r])
    e->value[r] = pl_emit_load(e, e->memory, e->prog->spill + (long)r * e->prog->width,
                               e->prog->width);
  return e->value[r];
}

static LLVMValueRef choose(pl_emit* e, LLVMRealPredicate how, LLVMValueRef a, LLVMValueRef b,
                           LLVMValueRef yes, LLVMValueRef no) {
  return LLVMBuildSelect(e->build, LLVMBuildFCmp(e->build, how, a, b, ""), yes, no, "");
}

LLVMValueRef pl_emit_line(pl_emit* e, const pl_prog_line* l) {
  int width = e->prog->width, operands[] = {l->a, l->b, l->c, l->e};
  LLVMValueRef x[4] = {NULL}, zero = pl_emit_number(e, 0, width);
  for (int i = 0; i < reads_of[l->op]; i++) x[i] = read(e, operands[i]);
  LLVMValueRef special;
  if (e->written && pl_written_line(e, l, x[0], &special)) return special;
  switch ((pl_prog_op)l->op) {
    case PL_PROG_LOAD: return pl_emit_load(e, strided(e, l->by), l->at, width);
    case PL_PROG_SPREAD:
      return pl_emit_spread(e, pl_emit_load(e, strided(e, l->by), l->at, 1), width);
    case PL_PROG_STORE: pl_emit_store(e, x[0], strided(e, l->by), l->at, width); return NULL;
    case PL_PROG_NUMBER: return pl_emit_number(e, l->value, width);
    case PL_PROG_ORDER: {
      LLVMValueRef k = LLVMBuildAdd(e->build, e->k, pl_emit_whole(e, l->at), "");
      return pl_emit_spread(e, LLVMBuildSIToFP(e->build, k, e->number, ""), width);
    }
    case PL_PROG_ADD: return LLVMBuildFAdd(e->build, x[0], x[1], "");
    case PL_PROG_SUB: return LLVMBuildFSub(e->build, x[0], x[1], "");
    case PL_PROG_MUL: return LLVMBuildFMul(e->build, x[0], x[1], "");
    case PL_PROG_DIV: return LLVMBuildFDiv(e->build, x[0], x[1], "");
    case PL_PROG_FMA: return pl_emit_fused(e, x[0], x[1], x[2], width);
    case PL_PROG_FNMA:
      return pl_emit_fused(e, LLVMBuildFNeg(e->build, x[0], ""), x[1], x[2], width);
    case PL_PROG_NEG: return LLVMBuildFNeg(e->build, x[0], "");
    case PL_PROG_ABS: return pl_emit_intrinsic(e, "llvm.fabs", x, 1, width);
    case PL_PROG_SQRT: return pl_emit_intrinsic(e, "llvm.sqrt", x, 1, width);
    case PL_PROG_IF_MORE: return choose(e, LLVMRealOGT, x[0], zero, x[1], x[2]);
    case PL_PROG_IF_LESS: return choose(e, LLVMRealOLT, x[0], zero, x[1], x[2]);
    case PL_PROG_IF_LE: return choose(e, LLVMRealOLE, x[0], x[1], x[2], x[3]);
    case PL_PROG_CALL1: return pl_emit_call(e, l->fn, x, 1);
    case PL_PROG_CALL2: return pl_emit_call(e, l->fn, x, 2);
    case PL_PROG_SUMS: block_of_sums(e, &e->prog->blocks.at[l->at]); return NULL;
    case PL_PROG_PRODUCT: emit_product(e, &e->prog->products.at[l->at]); return NULL;
    case PL_N_PROG_OPS: break;
  }
  return NULL;
}

// --------------------------------------------------------------------------------------- functions
static void find_chunks(pl_emit* e) {
  const pl_prog* p = e->prog;
  for (int i = 0; i < p->lines.n; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    int operands[] = {l->a, l->b, l->c, l->e};
    if (l->d >= 0) e->first_chunk[l->d] = e->last_chunk[l->d] = i / PL_EMIT_CHUNK;
    for (int o = 0; o < reads_of[l->op]; o++) e->last_chunk[operands[o]] = i / PL_EMIT_CHUNK;
  }
}

static void add_attribute(pl_emit* e, LLVMValueRef f, const char* name, const char* value) {
  LLVMAttributeRef a = LLVMCreateStringAttribute(e->context, name, (unsigned)strlen(name), value,
                                                 (unsigned)strlen(value));
  LLVMAddAttributeAtIndex(f, (LLVMAttributeIndex)LLVMAttributeFunctionIndex, a);
}

static void mark(pl_emit* e, LLVMValueRef f, const char* attribute) {
  unsigned kind = LLVMGetEnumAttributeKindForName(attribute, strlen(attribute));
  LLVMAddAttributeAtIndex(f, (LLVMAttributeIndex)LLVMAttributeFunctionIndex,
                          LLVMCreateEnumAttribute(e->context, kind, 0));
}

LLVMValueRef pl_emit_begin(pl_emit* e, const char* name, LLVMTypeRef t) {
  LLVMValueRef f = LLVMAddFunction(e->module, name, t);
  mark(e, f, "nounwind");
  add_attribute(e, f, "min-legal-vector-width", "512");
  add_attribute(e, f, "prefer-vector-width", "512");
  LLVMPositionBuilderAtEnd(e->build, LLVMAppendBasicBlockInContext(e->context, f, ""));
  e->memory = LLVMGetParam(f, 0);
  e->k = LLVMGetParam(f, 1);
  return f;
}

static LLVMValueRef emit_chunk(pl_emit* e, int chunk) {
  const pl_prog* p = e->prog;
  char name[128];
  snprintf(name, sizeof name, "%s_%d", p->name, chunk);
  e->chunk = chunk;
  e->n_strides = 0;
  e->function = pl_emit_begin(e, name, e->line_type);
  LLVMSetLinkage(e->function, LLVMInternalLinkage);
  if (p->lines.n <= PL_EMIT_CHUNK) mark(e, e->function, "alwaysinline");
  // the strides first, where every block of the function sees them
  int by[PL_EMIT_STRIDES], n_by = 0;
  int end = (chunk + 1) * PL_EMIT_CHUNK < p->lines.n ? (chunk + 1) * PL_EMIT_CHUNK : p->lines.n;
  for (int i = chunk * PL_EMIT_CHUNK; i < end; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    bool known = l->by == 0 || n_by == PL_EMIT_STRIDES
                 || (l->op != PL_PROG_LOAD && l->op != PL_PROG_SPREAD && l->op != PL_PROG_STORE);
    for (int j = 0; j < n_by; j++) known |= by[j] == l->by;
    if (!known) strided(e, by[n_by++] = l->by);
  }
  memset(e->value, 0, ((size_t)p->n_registers + 1) * sizeof(LLVMValueRef));
  for (int i = chunk * PL_EMIT_CHUNK; i < end; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    LLVMValueRef x = pl_emit_line(e, l);
    if (l->d < 0) continue;
    e->value[l->d] = x;
    if (e->last_chunk[l->d] > chunk)
      pl_emit_store(e, x, e->memory, p->spill + (long)l->d * p->width, p->width);
  }
  LLVMBuildRetVoid(e->build);
  return e->function;
}

static void emit_loop(pl_emit* e, LLVMValueRef* chunks, int n) {
  LLVMValueRef f = pl_emit_begin(e, e->prog->name, e->run_type);
  LLVMBasicBlockRef entry = LLVMGetInsertBlock(e->build);
  LLVMBasicBlockRef loop = LLVMAppendBasicBlockInContext(e->context, f, "order");
  LLVMBasicBlockRef done = LLVMAppendBasicBlockInContext(e->context, f, "done");
  LLVMValueRef from = LLVMBuildSExt(e->build, LLVMGetParam(f, 1), e->whole, "");
  LLVMValueRef to = LLVMBuildSExt(e->build, LLVMGetParam(f, 2), e->whole, "");
  LLVMBuildCondBr(e->build, LLVMBuildICmp(e->build, LLVMIntSLT, from, to, ""), loop, done);
  LLVMPositionBuilderAtEnd(e->build, loop);
  LLVMValueRef k = LLVMBuildPhi(e->build, e->whole, "");
  for (int i = 0; i < n; i++)
    LLVMBuildCall2(e->build, e->line_type, chunks[i], (LLVMValueRef[]){LLVMGetParam(f, 0), k}, 2,
                   "");
  LLVMValueRef next = LLVMBuildAdd(e->build, k, pl_emit_whole(e, 1), "");
  LLVMBuildCondBr(e->build, LLVMBuildICmp(e->build, LLVMIntSLT, next, to, ""), loop, done);
  LLVMAddIncoming(k, (LLVMValueRef[]){from, next}, (LLVMBasicBlockRef[]){entry, loop}, 2);
  LLVMPositionBuilderAtEnd(e->build, done);
  LLVMBuildRetVoid(e->build);
}

void pl_llvm_emit(LLVMContextRef context, LLVMModuleRef module, const pl_prog* prog) {
  pl_emit emit = {.context = context,
                  .module = module,
                  .build = LLVMCreateBuilderInContext(context),
                  .prog = prog},
          *e = &emit;
  e->number = LLVMDoubleTypeInContext(context);
  e->vector = LLVMVectorType(e->number, 8);
  e->whole = LLVMInt64TypeInContext(context);
  LLVMTypeRef memory = LLVMPointerType(e->number, 0), small = LLVMInt32TypeInContext(context),
              nothing = LLVMVoidTypeInContext(context);
  e->line_type = LLVMFunctionType(nothing, (LLVMTypeRef[]){memory, e->whole}, 2, 0);
  e->run_type = LLVMFunctionType(nothing, (LLVMTypeRef[]){memory, small, small}, 3, 0);
  size_t registers = (size_t)prog->n_registers + 1;
  int n = (prog->lines.n + PL_EMIT_CHUNK - 1) / PL_EMIT_CHUNK;
  e->value = calloc(registers, sizeof *e->value);
  e->first_chunk = calloc(registers, sizeof *e->first_chunk);
  e->last_chunk = calloc(registers, sizeof *e->last_chunk);
  LLVMValueRef* chunks = calloc((size_t)(n > prog->orders ? n : prog->orders) + 1, sizeof *chunks);
  bool room = e->value && e->first_chunk && e->last_chunk && chunks,
       written = prog->orders > 0 && prog->width == 1;
  if (room && written) {
    if (pl_written_make(e)) pl_written_emit(e, chunks);
    pl_written_free(e);
  } else if (room) {
    find_chunks(e);
    for (int i = 0; i < n; i++) chunks[i] = emit_chunk(e, i);
    emit_loop(e, chunks, n);
  }
  free(e->value);
  free(e->first_chunk);
  free(e->last_chunk);
  free(chunks);
  LLVMDisposeBuilder(e->build);
}
