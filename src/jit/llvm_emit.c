// From programs to LLVM's intermediate language: one instruction of a program is one instruction there, so that both round
// alike.  A program is cut into functions of at most 500 lines, because compilers take more than their share of time for
// long ones; registers that are read behind a cut travel through memory.
#include "jit/llvm_emit.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1500, WRITTEN_CHUNK = 500, ACCUMULATORS = 24, STEPS = 64 };

static const int reads_of[PL_N_PROG_OPS] = {
#define PL_PROG(name, reads, meaning) reads,
#include "prog.def"
#undef PL_PROG
};

typedef struct pl_emit {
  LLVMContextRef context;
  LLVMModuleRef module;
  LLVMBuilderRef build;
  LLVMTypeRef number, vector, whole, line_type, run_type;   // line_type: void (double*, i64)
  const pl_prog* prog;
  LLVMValueRef function, memory, k;
  LLVMValueRef* value;       // of each register in the function at work
  int* first_chunk;          // in which each register is computed
  int* last_chunk;           // in which it is read last
  int chunk;
  LLVMValueRef stride[STEPS];      // memory + k by
  int stride_by[STEPS], n_strides;
  // written out for every order: what is known of each place in memory, in the function at work
  bool unrolled;
  int order;
  LLVMValueRef* known;
  bool *loaded, *stored;     // places that the program reads by themselves; streams that it writes (row 0)
} pl_emit;

static LLVMTypeRef type_of(const pl_emit* e, int width) { return width == 8 ? e->vector : e->number; }
static LLVMValueRef whole(const pl_emit* e, long x) { return LLVMConstInt(e->whole, (unsigned long long)x, 1); }

// ---------------------------------------------------------------------------------------------- memory
static LLVMValueRef offset(const pl_emit* e, LLVMValueRef from, LLVMValueRef by) {
  return LLVMBuildGEP2(e->build, e->number, from, &by, 1, "");
}

// memory + k by, computed once a function.
static LLVMValueRef strided(pl_emit* e, int by) {
  if (by == 0) return e->memory;
  for (int i = 0; i < e->n_strides; i++)
    if (e->stride_by[i] == by) return e->stride[i];
  LLVMValueRef p = offset(e, e->memory, LLVMBuildMul(e->build, e->k, whole(e, by), ""));
  if (e->n_strides < STEPS) {
    e->stride_by[e->n_strides] = by;
    e->stride[e->n_strides++] = p;
  }
  return p;
}

static LLVMValueRef pointer(pl_emit* e, LLVMValueRef base, long at, int width) {
  LLVMValueRef p = at ? offset(e, base, whole(e, at)) : base;
  return width == 8 ? LLVMBuildBitCast(e->build, p, LLVMPointerType(e->vector, 0), "") : p;
}

static LLVMValueRef load(pl_emit* e, LLVMValueRef base, long at, int width) {
  LLVMValueRef x = LLVMBuildLoad2(e->build, type_of(e, width), pointer(e, base, at, width), "");
  LLVMSetAlignment(x, 8);
  return x;
}

static void store(pl_emit* e, LLVMValueRef x, LLVMValueRef base, long at, int width) {
  LLVMSetAlignment(LLVMBuildStore(e->build, x, pointer(e, base, at, width)), 8);
}

static LLVMValueRef spread(pl_emit* e, LLVMValueRef x, int width) {
  if (width == 1) return x;
  LLVMValueRef one = LLVMBuildInsertElement(e->build, LLVMGetUndef(e->vector), x, whole(e, 0), "");
  LLVMValueRef zeros = LLVMConstNull(LLVMVectorType(LLVMInt32TypeInContext(e->context), 8));
  return LLVMBuildShuffleVector(e->build, one, LLVMGetUndef(e->vector), zeros, "");
}

static LLVMValueRef number(const pl_emit* e, double x, int width) {
  LLVMValueRef one = LLVMConstReal(e->number, x), all[8];
  if (width == 1) return one;
  for (int l = 0; l < 8; l++) all[l] = one;
  return LLVMConstVector(all, 8);
}

// ---------------------------------------------------------------------------------------------- calls
static LLVMValueRef intrinsic(pl_emit* e, const char* name, LLVMValueRef* x, int n, int width) {
  LLVMTypeRef t = type_of(e, width);
  unsigned id = LLVMLookupIntrinsicID(name, strlen(name));
  LLVMValueRef f = LLVMGetIntrinsicDeclaration(e->module, id, &t, 1);
  return LLVMBuildCall2(e->build, LLVMIntrinsicGetType(e->context, id, &t, 1), f, x, (unsigned)n, "");
}

static LLVMValueRef fused(pl_emit* e, LLVMValueRef a, LLVMValueRef b, LLVMValueRef c, int width) {
  LLVMValueRef x[] = {a, b, c};
  return intrinsic(e, "llvm.fma", x, 3, width);
}

static const char* const function_name[] = {
#define NAME(name, reads) #name,
    PL_PROG_FUNCTIONS(NAME)
#undef NAME
};

// Functions of the C library are called as they are: not known to the compiler, so never computed by it.
static LLVMValueRef call_scalar(pl_emit* e, int fn, LLVMValueRef* x, int n) {
  LLVMTypeRef parameters[2] = {e->number, e->number}, t = LLVMFunctionType(e->number, parameters, (unsigned)n, 0);
  LLVMValueRef f = LLVMGetNamedFunction(e->module, function_name[fn]);
  unsigned plain = LLVMGetEnumAttributeKindForName("nobuiltin", 9);
  if (!f) f = LLVMAddFunction(e->module, function_name[fn], t);
  LLVMValueRef call = LLVMBuildCall2(e->build, t, f, x, (unsigned)n, "");
  LLVMAddCallSiteAttribute(call, (LLVMAttributeIndex)LLVMAttributeFunctionIndex, LLVMCreateEnumAttribute(e->context, plain, 0));
  return call;
}

static LLVMValueRef call(pl_emit* e, int fn, LLVMValueRef* x, int n) {
  if (e->prog->width == 1) return call_scalar(e, fn, x, n);
  LLVMValueRef result = LLVMGetUndef(e->vector);
  for (int l = 0; l < 8; l++) {
    LLVMValueRef part[2];
    for (int i = 0; i < n; i++) part[i] = LLVMBuildExtractElement(e->build, x[i], whole(e, l), "");
    result = LLVMBuildInsertElement(e->build, result, call_scalar(e, fn, part, n), whole(e, l), "");
  }
  return result;
}

// ---------------------------------------------------------------------------------------------- sums
static LLVMValueRef weigh(pl_emit* e, LLVMValueRef a, LLVMValueRef j, int width) {
  LLVMValueRef x = LLVMBuildSIToFP(e->build, j, e->number, "");
  return LLVMBuildFMul(e->build, spread(e, x, width), a, "");
}

// acc + A_ja B_jb; at_ja and at_jb are memory + j width.
static LLVMValueRef add_row(pl_emit* e, const pl_prog_sum* s, pl_prog_pair p, LLVMValueRef acc, LLVMValueRef ja,
                            LLVMValueRef at_ja, LLVMValueRef at_jb, int width) {
  LLVMValueRef a = load(e, at_ja, p.a, width), b = load(e, at_jb, p.b, width);
  if (s->weighted) a = weigh(e, a, ja, width);
  return fused(e, a, b, acc, width);
}

static LLVMValueRef row(pl_emit* e, LLVMValueRef j, int width) {
  return offset(e, e->memory, LLVMBuildMul(e->build, j, whole(e, width), ""));
}

// The parts of all sums of a loop, one after the other.
typedef struct pl_sum_parts { LLVMValueRef at[ACCUMULATORS]; } pl_sum_parts;

static int parts_of(const pl_prog_sum* s, int n) {
  int parts = 0;
  for (int i = 0; i < n; i++) parts += pl_prog_parts(&s[i]);
  return parts;
}

// Row K/2 with itself, when K is even.
static pl_sum_parts middle(pl_emit* e, const pl_prog_sum* s, int n, LLVMValueRef half, int width) {
  pl_sum_parts x;
  LLVMValueRef at = row(e, half, width);
  for (int i = 0, first = 0; i < n; first += pl_prog_parts(&s[i++])) {
    int parts = pl_prog_parts(&s[i]);
    for (int j = 0; j < parts; j++) x.at[first + j] = number(e, 0, width);
    for (int p = 0; p < s[i].n; p++) {
      LLVMValueRef* to = &x.at[first + 2 * p % parts];
      *to = add_row(e, &s[i], e->prog->pairs.at[s[i].first + p], *to, half, at, at, width);
    }
  }
  return x;
}

static void both_rows(pl_emit* e, const pl_prog_sum* s, int n, pl_sum_parts* x, LLVMValueRef j, LLVMValueRef other, int width) {
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

static LLVMValueRef scaled(pl_emit* e, LLVMValueRef x, LLVMValueRef scale, LLVMValueRef rest, int width) {
  return fused(e, x, rest, LLVMBuildFMul(e->build, x, scale, ""), width);
}

static LLVMValueRef total(pl_emit* e, const LLVMValueRef* part, int parts) {
  LLVMValueRef x = LLVMBuildFAdd(e->build, part[0], part[1], "");
  return parts == 2 ? x : LLVMBuildFAdd(e->build, x, LLVMBuildFAdd(e->build, part[2], part[3], ""), "");
}

static void store_sums(pl_emit* e, const pl_prog_sum* s, int n, const pl_sum_parts* x, LLVMValueRef K, int width) {
  LLVMValueRef at_K = row(e, K, width);
  for (int i = 0, first = 0; i < n; first += pl_prog_parts(&s[i++])) {
    LLVMValueRef sum = total(e, x->at + first, pl_prog_parts(&s[i]));
    if (s[i].scale >= 0) sum = scaled(e, sum, load(e, at_K, s[i].scale, width), load(e, at_K, s[i].rest, width), width);
    store(e, sum, e->memory, s[i].to, width);
  }
}

static pl_sum_parts phis(pl_emit* e, LLVMTypeRef t, int parts) {
  pl_sum_parts x;
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
  LLVMTypeRef t = type_of(e, width);
  LLVMValueRef one = whole(e, 1), K = LLVMBuildAdd(e->build, e->k, whole(e, b->shift), "");
  LLVMValueRef half = LLVMBuildAShr(e->build, K, one, ""), top = LLVMBuildAShr(e->build, LLVMBuildSub(e->build, K, one, ""), one, "");
  LLVMValueRef even = LLVMBuildAnd(e->build, LLVMBuildICmp(e->build, LLVMIntNE, half, top, ""), LLVMBuildICmp(e->build, LLVMIntSGE, half, one, ""), "");
  LLVMBasicBlockRef before = LLVMGetInsertBlock(e->build), inner = new_block(e, "middle"), head = new_block(e, "head");
  LLVMBasicBlockRef loop = new_block(e, "sum"), after = new_block(e, "summed");
  pl_sum_parts none, start, now, end;
  for (int i = 0; i < parts; i++) none.at[i] = number(e, 0, width);
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
    for (n = 1; i + n < b->n && parts_of(s + i, n + 1) <= ACCUMULATORS;) n++;
    sums(e, b, s + i, n);
  }
}

static void product(pl_emit* e, const pl_prog_product* p) {
  LLVMValueRef part[4];
  for (int b = 0; b < p->blocks; b++) {
    for (int i = 0; i < 4; i++) part[i] = number(e, 0, 8);
    for (int j = 0; j < p->n; j++) {
      LLVMValueRef column = load(e, e->memory, p->matrix + (j * p->blocks + b) * 8, 8);
      part[j % 4] = fused(e, column, spread(e, load(e, e->memory, p->vector + j, 1), 8), part[j % 4], 8);
    }
    LLVMValueRef low = LLVMBuildFAdd(e->build, part[0], part[1], ""), high = LLVMBuildFAdd(e->build, part[2], part[3], "");
    store(e, LLVMBuildFAdd(e->build, low, high, ""), e->memory, p->to + b * 8, 8);
  }
}

// ---------------------------------------------------------------------------------------------- written out
// Below so few operations a program is written out for each order: its coefficients then stay in registers.
static LLVMValueRef known_load(pl_emit* e, long at) {
  if (!e->known[at]) e->known[at] = load(e, e->memory, at, 1);
  return e->known[at];
}

static void known_store(pl_emit* e, LLVMValueRef x, long at) {
  store(e, x, e->memory, at, 1);
  e->known[at] = x;
}

static void find_used(pl_emit* e) {
  const pl_prog* p = e->prog;
  for (int i = 0; i < p->lines.n; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    if (l->op == PL_PROG_LOAD && l->by == 0) e->loaded[l->at] = true;
    if (l->op != PL_PROG_STORE || l->by != 8) continue;
    for (int row = 0; row < 3 && l->at - 8 * row >= 0; row++) e->stored[l->at - 8 * row] = true;
  }
}

// One lane of a sum.  Pairs without streams in this lane add 0 0, which only makes a -0 positive.
static LLVMValueRef lane_sum(pl_emit* e, const pl_prog_sum* s, int lane, int K) {
  const pl_prog_pair* pairs = e->prog->pairs.at + s->first;
  LLVMValueRef part[PL_PROG_PARTS];
  int parts = pl_prog_parts(s);
  bool left_out[PL_PROG_PARTS] = {false};
  for (int i = 0; i < parts; i++) part[i] = number(e, 0, 1);
  for (int j = K / 2; j >= 1; j--)
    for (int p = 0; p < s->n; p++) {
      long a = pairs[p].a + lane, b = pairs[p].b + lane;
      int up = 2 * p % parts, down = up + 1;
      if (!e->stored[a] || !e->stored[b]) {
        left_out[up] = left_out[down] = true;
        continue;
      }
      part[up] = fused(e, known_load(e, a + 8L * j), known_load(e, b + 8L * (K - j)), part[up], 1);
      if (2 * j != K) part[down] = fused(e, known_load(e, a + 8L * (K - j)), known_load(e, b + 8L * j), part[down], 1);
    }
  for (int i = 0; i < parts; i++)
    if (left_out[i]) part[i] = LLVMBuildFAdd(e->build, part[i], number(e, 0, 1), "");
  LLVMValueRef x = total(e, part, parts);
  return s->scale < 0 ? x : scaled(e, x, known_load(e, s->scale + 8L * K + lane), known_load(e, s->rest + 8L * K + lane), 1);
}

static void unrolled_sums(pl_emit* e, const pl_prog_block* b) {
  for (int i = b->first; i < b->first + b->n; i++) {
    const pl_prog_sum* s = &e->prog->sums.at[i];
    for (int l = 0; l < 8; l++)
      if (e->loaded[s->to + l]) known_store(e, lane_sum(e, s, l, e->order + b->shift), s->to + l);
  }
}

static void unrolled_product(pl_emit* e, const pl_prog_product* p) {
  enum { FEW = 4 };
  for (int i = 0; p->n <= FEW && i < p->n; i++) {
    LLVMValueRef part[4];
    for (int j = 0; j < 4; j++) part[j] = number(e, 0, 1);
    for (int j = 0; j < p->n; j++)
      part[j % 4] = fused(e, known_load(e, p->matrix + j * p->blocks * 8 + i), known_load(e, p->vector + j), part[j % 4], 1);
    LLVMValueRef low = LLVMBuildFAdd(e->build, part[0], part[1], ""), high = LLVMBuildFAdd(e->build, part[2], part[3], "");
    known_store(e, LLVMBuildFAdd(e->build, low, high, ""), p->to + i);
  }
  if (p->n <= FEW) return;
  product(e, p);
  for (int i = 0; i < 8 * p->blocks; i++) e->known[p->to + i] = NULL;
}

// ---------------------------------------------------------------------------------------------- lines
static LLVMValueRef read(pl_emit* e, int r) {
  if (!e->value[r]) e->value[r] = load(e, e->memory, e->prog->spill + (long)r * e->prog->width, e->prog->width);
  return e->value[r];
}

static LLVMValueRef choose(pl_emit* e, LLVMRealPredicate how, LLVMValueRef a, LLVMValueRef b, LLVMValueRef yes, LLVMValueRef no) {
  return LLVMBuildSelect(e->build, LLVMBuildFCmp(e->build, how, a, b, ""), yes, no, "");
}

static LLVMValueRef line(pl_emit* e, const pl_prog_line* l) {
  int width = e->prog->width, operands[] = {l->a, l->b, l->c, l->e};
  LLVMValueRef x[4] = {NULL}, zero = number(e, 0, width);
  for (int i = 0; i < reads_of[l->op]; i++) x[i] = read(e, operands[i]);
  if (e->unrolled) {
    long at = l->at + (long)l->by * e->order;
    if (l->op == PL_PROG_LOAD) return known_load(e, at);
    if (l->op == PL_PROG_STORE) return known_store(e, x[0], at), NULL;
    if (l->op == PL_PROG_ORDER) return number(e, (double)(e->order + l->at), 1);
    if (l->op == PL_PROG_SUMS) return unrolled_sums(e, &e->prog->blocks.at[l->at]), NULL;
    if (l->op == PL_PROG_PRODUCT) return unrolled_product(e, &e->prog->products.at[l->at]), NULL;
  }
  switch ((pl_prog_op)l->op) {
    case PL_PROG_LOAD: return load(e, strided(e, l->by), l->at, width);
    case PL_PROG_SPREAD: return spread(e, load(e, strided(e, l->by), l->at, 1), width);
    case PL_PROG_STORE: store(e, x[0], strided(e, l->by), l->at, width); return NULL;
    case PL_PROG_NUMBER: return number(e, l->value, width);
    case PL_PROG_ORDER: {
      LLVMValueRef k = LLVMBuildAdd(e->build, e->k, whole(e, l->at), "");
      return spread(e, LLVMBuildSIToFP(e->build, k, e->number, ""), width);
    }
    case PL_PROG_ADD: return LLVMBuildFAdd(e->build, x[0], x[1], "");
    case PL_PROG_SUB: return LLVMBuildFSub(e->build, x[0], x[1], "");
    case PL_PROG_MUL: return LLVMBuildFMul(e->build, x[0], x[1], "");
    case PL_PROG_DIV: return LLVMBuildFDiv(e->build, x[0], x[1], "");
    case PL_PROG_FMA: return fused(e, x[0], x[1], x[2], width);
    case PL_PROG_FNMA: return fused(e, LLVMBuildFNeg(e->build, x[0], ""), x[1], x[2], width);
    case PL_PROG_NEG: return LLVMBuildFNeg(e->build, x[0], "");
    case PL_PROG_ABS: return intrinsic(e, "llvm.fabs", x, 1, width);
    case PL_PROG_SQRT: return intrinsic(e, "llvm.sqrt", x, 1, width);
    case PL_PROG_IF_MORE: return choose(e, LLVMRealOGT, x[0], zero, x[1], x[2]);
    case PL_PROG_IF_LESS: return choose(e, LLVMRealOLT, x[0], zero, x[1], x[2]);
    case PL_PROG_IF_LE: return choose(e, LLVMRealOLE, x[0], x[1], x[2], x[3]);
    case PL_PROG_CALL1: return call(e, l->fn, x, 1);
    case PL_PROG_CALL2: return call(e, l->fn, x, 2);
    case PL_PROG_SUMS: block_of_sums(e, &e->prog->blocks.at[l->at]); return NULL;
    case PL_PROG_PRODUCT: product(e, &e->prog->products.at[l->at]); return NULL;
    case PL_N_PROG_OPS: break;
  }
  return NULL;
}

// ---------------------------------------------------------------------------------------------- functions
static void find_chunks(pl_emit* e) {
  const pl_prog* p = e->prog;
  for (int i = 0; i < p->lines.n; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    int operands[] = {l->a, l->b, l->c, l->e};
    if (l->d >= 0) e->first_chunk[l->d] = e->last_chunk[l->d] = i / CHUNK;
    for (int o = 0; o < reads_of[l->op]; o++) e->last_chunk[operands[o]] = i / CHUNK;
  }
}

static void add_attribute(pl_emit* e, LLVMValueRef f, const char* name, const char* value) {
  LLVMAttributeRef a = LLVMCreateStringAttribute(e->context, name, (unsigned)strlen(name), value, (unsigned)strlen(value));
  LLVMAddAttributeAtIndex(f, (LLVMAttributeIndex)LLVMAttributeFunctionIndex, a);
}

static LLVMValueRef begin_function(pl_emit* e, const char* name, LLVMTypeRef t) {
  LLVMValueRef f = LLVMAddFunction(e->module, name, t);
  unsigned quiet = LLVMGetEnumAttributeKindForName("nounwind", 8);
  LLVMAddAttributeAtIndex(f, (LLVMAttributeIndex)LLVMAttributeFunctionIndex, LLVMCreateEnumAttribute(e->context, quiet, 0));
  add_attribute(e, f, "min-legal-vector-width", "512");
  add_attribute(e, f, "prefer-vector-width", "512");
  LLVMPositionBuilderAtEnd(e->build, LLVMAppendBasicBlockInContext(e->context, f, ""));
  return f;
}

static LLVMValueRef emit_chunk(pl_emit* e, int chunk) {
  const pl_prog* p = e->prog;
  char name[128];
  snprintf(name, sizeof name, "%s_%d", p->name, chunk);
  e->chunk = chunk;
  e->n_strides = 0;
  e->function = begin_function(e, name, e->line_type);
  LLVMSetLinkage(e->function, LLVMInternalLinkage);
  e->memory = LLVMGetParam(e->function, 0);
  e->k = LLVMGetParam(e->function, 1);
  int by[STEPS], n_by = 0;   // the strides first, where every block of the function sees them
  int end = (chunk + 1) * CHUNK < p->lines.n ? (chunk + 1) * CHUNK : p->lines.n;
  for (int i = chunk * CHUNK; i < end; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    bool known = l->by == 0 || n_by == STEPS || (l->op != PL_PROG_LOAD && l->op != PL_PROG_SPREAD && l->op != PL_PROG_STORE);
    for (int j = 0; j < n_by; j++) known |= by[j] == l->by;
    if (!known) strided(e, by[n_by++] = l->by);
  }
  memset(e->value, 0, ((size_t)p->n_registers + 1) * sizeof(LLVMValueRef));
  for (int i = chunk * CHUNK; i < end; i++) {
    const pl_prog_line* l = &p->lines.at[i];
    LLVMValueRef x = line(e, l);
    if (l->d < 0) continue;
    e->value[l->d] = x;
    if (e->last_chunk[l->d] > chunk) store(e, x, e->memory, p->spill + (long)l->d * p->width, p->width);
  }
  LLVMBuildRetVoid(e->build);
  return e->function;
}

// Orders from .. of an unrolled program until a function is full; returns the next.
static int emit_orders(pl_emit* e, int from, LLVMValueRef* function) {
  const pl_prog* p = e->prog;
  char name[128];
  snprintf(name, sizeof name, "%s_from_%d", p->name, from);
  *function = e->function = begin_function(e, name, e->line_type);
  LLVMSetLinkage(e->function, LLVMInternalLinkage);
  e->memory = LLVMGetParam(e->function, 0);
  memset(e->known, 0, ((size_t)p->spill + 1) * sizeof *e->known);
  int k = from;
  for (int operations = 0; k < p->orders && (k == from || operations < WRITTEN_CHUNK); k++) {
    e->order = k;
    memset(e->value, 0, ((size_t)p->n_registers + 1) * sizeof(LLVMValueRef));
    for (int i = 0; i < p->lines.n; i++) {
      LLVMValueRef x = line(e, &p->lines.at[i]);
      if (p->lines.at[i].d >= 0) e->value[p->lines.at[i].d] = x;
    }
    operations += p->lines.n + p->pairs.n * 4 * k;
  }
  LLVMBuildRetVoid(e->build);
  return k;
}

static void emit_unrolled(pl_emit* e, LLVMValueRef* functions) {
  int n = 0;
  for (int k = e->prog->first_order; k < e->prog->orders;) k = emit_orders(e, k, &functions[n++]);
  LLVMValueRef f = begin_function(e, e->prog->name, e->run_type);
  LLVMValueRef zero = whole(e, 0);
  for (int i = 0; i < n; i++) LLVMBuildCall2(e->build, e->line_type, functions[i], (LLVMValueRef[]){LLVMGetParam(f, 0), zero}, 2, "");
  LLVMBuildRetVoid(e->build);
}

static void emit_loop(pl_emit* e, LLVMValueRef* chunks, int n) {
  LLVMValueRef f = begin_function(e, e->prog->name, e->run_type);
  LLVMBasicBlockRef entry = LLVMGetInsertBlock(e->build);
  LLVMBasicBlockRef loop = LLVMAppendBasicBlockInContext(e->context, f, "order");
  LLVMBasicBlockRef done = LLVMAppendBasicBlockInContext(e->context, f, "done");
  LLVMValueRef from = LLVMBuildSExt(e->build, LLVMGetParam(f, 1), e->whole, "");
  LLVMValueRef to = LLVMBuildSExt(e->build, LLVMGetParam(f, 2), e->whole, "");
  LLVMBuildCondBr(e->build, LLVMBuildICmp(e->build, LLVMIntSLT, from, to, ""), loop, done);
  LLVMPositionBuilderAtEnd(e->build, loop);
  LLVMValueRef k = LLVMBuildPhi(e->build, e->whole, "");
  for (int i = 0; i < n; i++) LLVMBuildCall2(e->build, e->line_type, chunks[i], (LLVMValueRef[]){LLVMGetParam(f, 0), k}, 2, "");
  LLVMValueRef next = LLVMBuildAdd(e->build, k, whole(e, 1), "");
  LLVMBuildCondBr(e->build, LLVMBuildICmp(e->build, LLVMIntSLT, next, to, ""), loop, done);
  LLVMAddIncoming(k, (LLVMValueRef[]){from, next}, (LLVMBasicBlockRef[]){entry, loop}, 2);
  LLVMPositionBuilderAtEnd(e->build, done);
  LLVMBuildRetVoid(e->build);
}

void pl_llvm_emit(LLVMContextRef context, LLVMModuleRef module, const pl_prog* prog) {
  pl_emit emit = {.context = context, .module = module, .build = LLVMCreateBuilderInContext(context), .prog = prog}, *e = &emit;
  e->number = LLVMDoubleTypeInContext(context);
  e->vector = LLVMVectorType(e->number, 8);
  e->whole = LLVMInt64TypeInContext(context);
  LLVMTypeRef memory = LLVMPointerType(e->number, 0), small = LLVMInt32TypeInContext(context), nothing = LLVMVoidTypeInContext(context);
  e->line_type = LLVMFunctionType(nothing, (LLVMTypeRef[]){memory, e->whole}, 2, 0);
  e->run_type = LLVMFunctionType(nothing, (LLVMTypeRef[]){memory, small, small}, 3, 0);
  size_t registers = (size_t)prog->n_registers + 1;
  int n = (prog->lines.n + CHUNK - 1) / CHUNK;
  e->value = calloc(registers, sizeof *e->value);
  e->first_chunk = calloc(registers, sizeof *e->first_chunk);
  e->last_chunk = calloc(registers, sizeof *e->last_chunk);
  e->unrolled = prog->orders > 0 && prog->width == 1;
  size_t places = e->unrolled ? (size_t)prog->spill + 1 : 1;
  e->known = calloc(places, sizeof *e->known);
  e->loaded = calloc(places, sizeof *e->loaded);
  e->stored = calloc(places, sizeof *e->stored);
  LLVMValueRef* chunks = calloc((size_t)(n > prog->orders ? n : prog->orders) + 1, sizeof *chunks);
  if (e->value && e->first_chunk && e->last_chunk && chunks && e->known && e->loaded && e->stored) {
    if (e->unrolled) {
      find_used(e);
      emit_unrolled(e, chunks);
    } else {
      find_chunks(e);
      for (int i = 0; i < n; i++) chunks[i] = emit_chunk(e, i);
      emit_loop(e, chunks, n);
    }
  }
  free(e->known);
  free(e->loaded);
  free(e->stored);
  free(e->value);
  free(e->first_chunk);
  free(e->last_chunk);
  free(chunks);
  LLVMDisposeBuilder(e->build);
}
