// What must be the same for a run to go on bit for bit: the model, what was asked for, the program,
// and how this machine computes.
#define _GNU_SOURCE  // dl_iterate_phdr

#ifdef __linux__
#  include <link.h>
#endif
#include <math.h>
#include <string.h>

#include "api/keeping.h"

// ----------------------------------------------------------------------------- program and machine
// The linker's name of this very build: another one may add in another order.
typedef struct pl_build {
  const void* here;
  char name[48];
} pl_build;

#ifdef __linux__
static void copy_build(pl_build* b, const struct dl_phdr_info* info, const ElfW(Phdr) * note) {
  const char *at = (const char*)(info->dlpi_addr + note->p_vaddr), *end = at + note->p_memsz;
  while (at + sizeof(ElfW(Nhdr)) <= end) {
    ElfW(Nhdr) head;
    memcpy(&head, at, sizeof head);
    const unsigned char* bytes = (const unsigned char*)at + sizeof head
                                 + ((head.n_namesz + 3u) & ~3u);
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4
        && memcmp(at + sizeof head, "GNU", 4) == 0)
      for (unsigned i = 0; i < head.n_descsz && 2 * i + 3 < sizeof b->name; i++)
        snprintf(b->name + 2 * i, 3, "%02x", bytes[i]);
    at = (const char*)bytes + ((head.n_descsz + 3u) & ~3u);
  }
}

static int find_build(struct dl_phdr_info* info, size_t size, void* user) {
  pl_build* b = user;
  bool ours = false;
  (void)size;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr)* p = &info->dlpi_phdr[i];
    uintptr_t from = info->dlpi_addr + p->p_vaddr, here = (uintptr_t)b->here;
    ours |= p->p_type == PT_LOAD && here >= from && here < from + p->p_memsz;
  }
  for (int i = 0; i < info->dlpi_phnum && ours; i++)
    if (info->dlpi_phdr[i].p_type == PT_NOTE) copy_build(b, info, &info->dlpi_phdr[i]);
  return ours;
}

static void name_build(pl_build* b) { dl_iterate_phdr(find_build, b); }
#else
static void name_build(pl_build* b) { (void)b; }  // then the version has to do
#endif

// The last digits of the functions that a motion is computed with. Libraries choose among versions
// of them by processor.
static uint64_t digits_of_functions(void) {
  static double (*const one[])(double) = {sin,  cos,  tan, asin, acos, atan, sinh,
                                          cosh, tanh, exp, log,  exp2, sqrt};
  static double (*const two[])(double, double) = {pow, atan2};
  uint64_t hash = 0;
  pl_random dice = {1};
  for (int i = 0; i < 64; i++) {
    double x = pl_random_unit(&dice), y = pl_random_between(&dice, -3, 3), out[15];
    for (int f = 0; f < 13; f++) out[f] = one[f](x);
    for (int f = 0; f < 2; f++) out[13 + f] = two[f](4 * x, y);
    hash = pl_hash_bytes(out, sizeof out, hash);
    for (int f = 0; f < 3; f++) out[f] = one[f](40 * y);
    hash = pl_hash_bytes(out, 3 * sizeof *out, hash);
  }
  return hash;
}

// ---------------------------------------------------------------------------------------- the list
static void add(pl_traits* list, pl_arena* a, const char* name, const char* flag,
                const char* value) {
  pl_push(a, *list, (pl_trait){name, flag, value});
}

static const char* number(pl_arena* a, double x) {
  char text[32];
  pl_double_text(text, x);
  return pl_copy(a, text);
}

static const char* settings(const pleuel_model* m) {
  pl_text text = pl_text_make(m->motion);
  for (int i = 0; i < m->n_settings; i++)
    pl_text_addf(&text, "%s%s=%s", i ? " --set " : "", m->settings[i].name, m->settings[i].value);
  return pl_text_string(&text);
}

void pl_traits_of(pl_traits* list, const pleuel_model* m, const pleuel_sim_options* o,
                  const pl_run_options* how) {
  static const char* const precision[] = {"double", "long", "quad"};
  static const char* const method[] = {
      [PL_METHOD_TAYLOR] = "taylor", [PL_METHOD_RADAU] = "radau", [PL_METHOD_AUTO] = "auto"};
  pl_arena* a = m->motion;
  pl_build build = {.here = (const void*)(uintptr_t)pl_traits_of};
  name_build(&build);
  add(list, a, "program", NULL, pleuel_version());
  add(list, a, "model", NULL, pl_format(a, "%016llx", (unsigned long long)m->text_hash));
  add(list, a, "set", "--set", settings(m));
  add(list, a, "t_0", "t_0", number(a, how->t_0));
  add(list, a, "until", "--until", number(a, how->t_end));
  add(list, a, "tol", "--tol", number(a, how->tol));
  add(list, a, "dt", "--dt", number(a, how->dt));
  add(list, a, "count", "count", number(a, (double)how->count));
  add(list, a, "method", "--method", method[how->method]);
  add(list, a, "precision", "--precision", precision[o->precision]);
  add(list, a, "sensitivities", "--sensitivities", o->sensitivities ? o->sensitivities : "");
  add(list, a, "rows", "-o", o->csv_file ? "csv" : o->row ? "row" : "");
  add(list, a, "build", NULL, pl_copy(a, build.name));
  add(list, a, "machine", NULL, pl_format(a, "%016llx", (unsigned long long)digits_of_functions()));
}

void pl_traits_keep(pl_keeper* k, pl_traits* list, pl_arena* a) {
  int n = list->n;
  pl_keep_section(k, "traits");
  pl_keep_count(k, &n, 16);
  for (int i = 0; i < n && k->wrong == NULL; i++) {
    pl_trait t = k->reads ? (pl_trait){0} : list->at[i];
    pl_keep_text(k, &t.name);
    pl_keep_text(k, &t.value);
    if (k->reads && k->wrong == NULL) pl_push(a, *list, t);
  }
}

// --------------------------------------------------------------------------------------- comparing
static const char* value_of(const pl_traits* list, const char* name) {
  for (int i = 0; i < list->n; i++)
    if (list->at[i].name && strcmp(list->at[i].name, name) == 0) return list->at[i].value;
  return NULL;
}

// 0 and nothing stand for: not given.
static const char* shown(const char* value) {
  return !value || !*value || strcmp(value, "0") == 0 ? "-" : value;
}

static pleuel_status differs(pleuel_model* m, const char* path, const pl_trait* now,
                             const char* was) {
  pl_job* job = &m->job;
  if (strcmp(now->name, "program") == 0)
    return pl_fail(job, PLEUEL_USAGE,
                   "%s is of pleuel %s, this is %s: go on with that one, or begin anew", path,
                   shown(was), now->value);
  if (strcmp(now->name, "build") == 0)
    return pl_fail(job, PLEUEL_USAGE,
                   "%s is of another build of pleuel %s: go on with that one, or begin anew", path,
                   pleuel_version());
  if (strcmp(now->name, "model") == 0)
    return pl_fail(job, PLEUEL_USAGE,
                   "%s belongs to another text of %s, or of a file that it includes: restore it, "
                   "or begin anew",
                   path, m->name);
  if (strcmp(now->name, "machine") == 0)
    return pl_fail(job, PLEUEL_USAGE,
                   "%s was written where sin, exp or pow have other last digits (another processor "
                   "or C library): go on there, or "
                   "begin anew",
                   path);
  return pl_fail(job, PLEUEL_USAGE, "%s belongs to a run with another %s: it was %s, now it is %s",
                 path, now->flag, shown(was), shown(now->value));
}

pleuel_status pl_traits_compare(pleuel_model* m, const char* path, const pl_traits* kept,
                                const pl_traits* now) {
  for (int i = 0; i < now->n; i++) {
    const char* was = value_of(kept, now->at[i].name);
    if (was == NULL || strcmp(was, now->at[i].value) != 0)
      return differs(m, path, &now->at[i], was);
  }
  return PLEUEL_OK;
}
