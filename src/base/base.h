// base: what every other folder stands on. Arenas, growable arrays, text, names, sources and spans,
// diagnostics, status codes, dimensions, interruption. Knows nothing of mechanics.
//
// Memory. Everything lives in an arena and goes when the arena goes. Allocation never returns NULL:
// when memory runs out the arena unwinds to the innermost guard (pl_guard), where the seam turns it
// into PLEUEL_NO_MEMORY. So passes allocate and forget, and no pass has an error path for memory.
#ifndef PL_BASE_H
#define PL_BASE_H

#include <setjmp.h>
#include <stdatomic.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "messages/messages.h"
#include "pleuel.h"

// -------------------------------------------------------------------------------- answers in three
// A question that may be undecidable has three answers.
typedef enum pl_answer3 { PL_NO = 0, PL_YES = 1, PL_UNKNOWN = 2 } pl_answer3;

// ------------------------------------------------------------------------------------------- arena
typedef struct pl_arena pl_arena;

// The innermost place to unwind to when memory runs out or a pass gives up (pl_unwind).
typedef struct pl_guard {
  jmp_buf at;
  struct pl_guard* outer;
  pleuel_status status;  // why we are here, set before the jump
} pl_guard;

// pl_arena_make opens an arena. alloc may be NULL: then malloc and free. NULL when even the first
// block fails.
pl_arena* pl_arena_make(const pleuel_allocator* alloc);
void pl_arena_free(pl_arena* a);

// pl_alloc returns size zeroed bytes, aligned to 64 (a cache line, a vector of eight doubles).
void* pl_alloc(pl_arena* a, size_t size);
#define PL_NEW(a, T)      ((T*)pl_alloc((a), sizeof(T)))
#define PL_ARRAY(a, T, n) ((T*)pl_alloc_array((a), (size_t)(n), sizeof(T)))
void* pl_alloc_array(pl_arena* a, size_t n, size_t size);  // checks n * size for overflow

// Scratch is taken between a mark and a rewind.
typedef struct pl_mark {
  void* block;
  size_t used;
} pl_mark;
pl_mark pl_arena_mark(pl_arena* a);
void pl_arena_rewind(pl_arena* a, pl_mark m);

// Guards. Use: pl_guard guard; PL_GUARD(a, guard) { work } else { guard.status says why };
// pl_guard_end(a, &guard)
void pl_guard_begin(pl_arena* a, pl_guard* g);
void pl_guard_end(pl_arena* a, pl_guard* g);
#define PL_GUARD(a, g) if (pl_guard_begin((a), &(g)), setjmp((g).at) == 0)
_Noreturn void pl_unwind(pl_arena* a, pleuel_status why);

size_t pl_arena_total(const pl_arena* a);        // bytes taken from the system
void pl_arena_limit(pl_arena* a, size_t bytes);  // 0: no limit; beyond it allocation unwinds
// allocations so far, for the tests that count
unsigned long pl_arena_count(const pl_arena* a);

// --------------------------------------------------------------------------------- growable arrays
// PL_VEC(int) v = {0};  pl_push(a, v, 7);  v.at[0], v.n
#define PL_VEC(T) \
  struct {        \
    T* at;        \
    int n, cap;   \
  }
void* pl_vec_grow(pl_arena* a, void* at, int n, int* cap, size_t size);
#define pl_push(a, v, ...)                                                                        \
  do {                                                                                            \
    __typeof__(*(v).at) pl_pushed_ = __VA_ARGS__; /* first: finding it may push onto v as well */ \
    if ((v).n == (v).cap) (v).at = pl_vec_grow((a), (v).at, (v).n, &(v).cap, sizeof *(v).at);     \
    (v).at[(v).n++] = pl_pushed_;                                                                 \
  } while (0)

// -------------------------------------------------------------------------------------------- text
char* pl_copy(pl_arena* a, const char* s);  // NUL-terminated copy
char* pl_copy_n(pl_arena* a, const char* s, size_t n);
char* pl_format(pl_arena* a, const char* fmt, ...) __attribute__((format(printf, 2, 3)));
char* pl_vformat(pl_arena* a, const char* fmt, va_list ap);

// A text under construction.
typedef struct pl_text {
  pl_arena* arena;
  char* at;  // always NUL-terminated, never NULL after the first append
  size_t n, cap;
} pl_text;
pl_text pl_text_make(pl_arena* a);
void pl_text_add(pl_text* t, const char* s);
void pl_text_add_n(pl_text* t, const char* s, size_t n);
void pl_text_addf(pl_text* t, const char* fmt, ...) __attribute__((format(printf, 2, 3)));
void pl_text_pad(pl_text* t, int n);     // n blanks, none if n <= 0
const char* pl_text_string(pl_text* t);  // "" if nothing was added

// UTF-8. Columns are counted in character cells as a terminal shows them (combining marks count 0).
int pl_utf8_width(const char* s);  // cells of a NUL-terminated string
int pl_utf8_width_n(const char* s, size_t n);
// bytes taken, 0 if malformed
int pl_utf8_decode(const char* s, const char* end, uint32_t* code_point);
int pl_utf8_encode(char out[4], uint32_t code_point);  // bytes written

// Edit distance with transpositions [Damerau1964], capped: returns cap + 1 when it is larger.
int pl_edit_distance(const char* a, const char* b, int cap);

// ------------------------------------------------------------------------------------------- names
// Interned strings: equal text, equal pointer.
typedef struct pl_names pl_names;
pl_names* pl_names_make(pl_arena* a);
const char* pl_intern(pl_names* names, const char* s);
const char* pl_intern_n(pl_names* names, const char* s, size_t n);

// A map from 64-bit keys or interned pointers to 64-bit values; 0 is "absent".
typedef struct pl_map pl_map;
pl_map* pl_map_make(pl_arena* a);
uint64_t pl_map_get(const pl_map* m, uint64_t key);
void pl_map_set(pl_map* m, uint64_t key, uint64_t value);
int pl_map_count(const pl_map* m);

uint64_t pl_hash_bytes(const void* p, size_t n, uint64_t seed);
uint64_t pl_hash_mix(uint64_t h, uint64_t x);

// Random numbers for laws and sample points: splitmix64; the same seed gives the same numbers
// everywhere.
typedef struct pl_random {
  uint64_t state;
} pl_random;
uint64_t pl_random_bits(pl_random* r);
double pl_random_unit(pl_random* r);  // [0, 1)
double pl_random_between(pl_random* r, double lo, double hi);

// ---------------------------------------------------------------------------------- sources, spans
typedef struct pl_source {
  const char* name;  // as shown in messages: "atwood.pleuel", "<stdin>"
  const char* text;  // NUL-terminated
  size_t size;
  const size_t* lines;  // byte offset of each line                     (n_lines)
  int n_lines;
  const size_t* units;  // UTF-16 units before each line                (n_lines)
} pl_source;
pl_source* pl_source_make(pl_arena* a, const char* name, const char* text, size_t size);

typedef struct pl_span {
  const pl_source* source;  // NULL: no place
  uint32_t begin, end;      // bytes, half open
} pl_span;

typedef struct pl_place {
  int line, column;
} pl_place;  // both from 1; column in cells
pl_place pl_span_place(pl_span s);
// The same for editors: bytes and UTF-16 units from the beginning; columns from 1 in characters
// (code points) and in UTF-16 units.
typedef struct pl_position {
  size_t at, at16, line, column, column16;
} pl_position;
pl_position pl_source_position(const pl_source* s, size_t at);
pl_span pl_span_join(pl_span a, pl_span b);
const char* pl_source_line(pl_arena* a, const pl_source* s, int line);

// --------------------------------------------------------------------------------------- languages
typedef enum pl_language { PL_ENGLISH = 0, PL_GERMAN = 1 } pl_language;

// ------------------------------------------------------------------------------------- diagnostics
// Codes live in messages/diagnostics.def, one page each in docs/diagnostics. E... error, W...
// warning, N... note.
typedef enum pl_code {
#define PL_DIAGNOSTIC(code, title_en, title_de) PL_##code,
#include "messages/diagnostics.def"
#undef PL_DIAGNOSTIC
  PL_N_CODES
} pl_code;

typedef enum pl_severity { PL_ERROR, PL_WARNING, PL_NOTE } pl_severity;

// a second place: "m/s² (line 2)"
typedef struct pl_label {
  pl_span span;
  const char* text;
} pl_label;

typedef struct pl_diagnostic {
  pl_code code;
  pl_span span;             // span.source NULL when the message concerns the whole model
  const char* sentence[2];  // what is wrong, one sentence; by language
  const char* reason[2];    // why, or NULL: shown beside the caret
  // one suggestion that can be applied as it stands, or NULL; shown after "="
  const char* fix[2];
  const char* replacement;  // text that replaces span when the fix is applied, or NULL
  pl_span fix_span;         // what replacement replaces; source NULL: span
  PL_VEC(pl_label) labels;
} pl_diagnostic;

typedef struct pl_diagnostics {
  pl_arena* arena;
  PL_VEC(pl_diagnostic) list;
  int n_errors;
} pl_diagnostics;

const char* pl_code_name(pl_code c);  // "E011"
const char* pl_code_title(pl_code c, pl_language lang);
pl_severity pl_code_severity(pl_code c);
bool pl_code_find(const char* name, pl_code* out);

// pl_report appends a message and returns it, so that labels and fix can be added. The sentence is
// given in both languages, already formatted (pl_format); the list keeps the pointers.
pl_diagnostic* pl_report(pl_diagnostics* d, pl_code code, pl_span span, const char* en,
                         const char* de);
void pl_report_reason(pl_diagnostic* m, const char* en, const char* de);
void pl_report_fix(pl_diagnostic* m, const char* en, const char* de, const char* replacement);
// The place that the replacement of a fix replaces: that of the message, unless the fix has its
// own.
void pl_report_fix_span(pl_diagnostic* m, pl_span span);
pl_span pl_diagnostic_fix_span(const pl_diagnostic* m);
void pl_report_label(pl_diagnostics* d, pl_diagnostic* m, pl_span span, const char* text);

// pl_diagnostics_sort puts messages in the order of their places, without duplicates.
void pl_diagnostics_sort(pl_diagnostics* d);
// pl_diagnostics_drop takes out all messages of a code; pl_diagnostics_have asks for one.
void pl_diagnostics_drop(pl_diagnostics* d, pl_code code);
bool pl_diagnostics_have(const pl_diagnostics* d, pl_code code);

// pl_diagnostic_print writes one message in the form of the manual: sentence, line, caret, reason,
// fix.
typedef struct pl_print_style {
  pl_language lang;
  bool colour, terse;
} pl_print_style;
void pl_diagnostic_print(pl_text* out, const pl_diagnostic* m, pl_print_style style);

// ------------------------------------------------------------------------------------------ status
const char* pleuel_status_name(pleuel_status s);  // in pleuel.h too

// -------------------------------------------------------------------------------- context of a job
// The wish to stop, from other threads and signal handlers (asked), or of the one who is asked
// about ten times a second in the thread that works (look).
typedef struct pl_interruption {
  atomic_int asked;
  bool (*look)(void* user);  // true: stop; or NULL
  void* user;
  bool stopped;            // it was
  int done, of;            // parts of the work, for the one who looks
  double clock_s, look_s;  // when the clock was read last, when `look` was called last
  long countdown, pace;    // calls of pl_interrupted until the clock is read again
} pl_interruption;

// What every pass is handed: where memory comes from, where messages go, whether to stop.
typedef struct pl_job {
  pl_arena* arena;
  pl_diagnostics* diagnostics;
  pleuel_status status;
  char message[512];             // the sentence with numbers that belongs to status
  pl_interruption* interrupted;  // may be NULL
  pl_language lang;
  // pl_clock() value at which presentation stops deepening; 0: none
  double deadline_s;
} pl_job;

// Where compiled steps are kept and the compiler plug-in lies; NULL in it: the usual place.
// cache "": nothing is kept.
typedef struct pl_jit_places {
  const char *cache, *plugin;
} pl_jit_places;

// pl_fail records status and sentence and returns the status: return pl_fail(job, PLEUEL_SINGULAR,
// "...", x);
pleuel_status pl_fail(pl_job* job, pleuel_status s, const char* fmt, ...)
    __attribute__((format(printf, 3, 4)));
// pl_in_language gives a sentence of src/messages, or format with %s and the like, in a
// language; itself when it has none.
const char* pl_in_language(pl_language lang, const char* sentence);
bool pl_interrupted(const pl_job* job);
void pl_job_done(const pl_job* job, int done, int of);  // so many parts of the work
double pl_clock(void);                                  // monotonic seconds
#define PL_TRY(call)                          \
  do {                                        \
    pleuel_status pl_try_ = (call);           \
    if (pl_try_ != PLEUEL_OK) return pl_try_; \
  } while (0)

// ------------------------------------------------------------------------------------------ states
// pl_keeper writes a state down or reads it back: one function names the numbers in their order and
// serves both ways. What is read is not trusted: counts are held against what is there, integers
// against their limits. The first thing that does not fit is remembered, and from there on nothing
// is read any more.
typedef struct pl_keeper {
  bool reads;
  pl_arena* arena;    // of bytes that are written, texts that are read
  unsigned char* at;  // bytes, of which `next` are written or read
  size_t size, next;  // room; when reading, all that there is
  const char* wrong;  // reading: where it did not fit; NULL
  const char* section;
} pl_keeper;
pl_keeper pl_keeper_to_write(pl_arena* a);
pl_keeper pl_keeper_to_read(pl_arena* a, const void* bytes, size_t n);
void pl_keep_section(pl_keeper* k, const char* name);  // a mark that must be found again
void pl_keep_f64(pl_keeper* k, double* x);
void pl_keep_f64s(pl_keeper* k, double* x, size_t n);  // n is known from elsewhere
void pl_keep_int(pl_keeper* k, int* x, int least, int most);
void pl_keep_long(pl_keeper* k, long* x, long least, long most);
void pl_keep_bool(pl_keeper* k, bool* x);
void pl_keep_bools(pl_keeper* k, bool* x, size_t n);
// may be NULL; read ones lie in the arena
void pl_keep_text(pl_keeper* k, const char** text);
// of things that follow, so many bytes each at least
void pl_keep_count(pl_keeper* k, int* n, size_t bytes_each);
void pl_keep_bytes(pl_keeper* k, void* x, size_t n);
void pl_keep_fail(pl_keeper* k);  // what was read cannot be
// reading: all fitted, and nothing is left
bool pl_keep_is_whole(const pl_keeper* k);

// -------------------------------------------------------------------------------------- dimensions
// A physical dimension: rational exponents of the seven base units, in the order m kg s A K mol cd.
// Angles are dimensionless.
enum { PL_N_BASE_UNITS = 7 };
typedef struct pl_dimension {
  int8_t num[PL_N_BASE_UNITS];
  // > 0; all 1 for integers.  {0} is not a valid dimension: use pl_dimension_one()
  int8_t den[PL_N_BASE_UNITS];
} pl_dimension;
pl_dimension pl_dimension_one(void);
pl_dimension pl_dimension_of(int m, int kg, int s);  // the mechanical ones
pl_dimension pl_dimension_mul(pl_dimension a, pl_dimension b);
pl_dimension pl_dimension_div(pl_dimension a, pl_dimension b);
pl_dimension pl_dimension_pow(pl_dimension a, int num, int den);
bool pl_dimension_equal(pl_dimension a, pl_dimension b);
// SI unit as text: "kg m/s²" or, when a name fits better, "N", "N m", "J", "rad/s". ascii: "m/s^2".
const char* pl_dimension_unit(pl_arena* a, pl_dimension d, bool ascii);
// What it is in words: "a length", "an acceleration", or "a quantity in kg/s".
const char* pl_dimension_words(pl_arena* a, pl_dimension d, pl_language lang);

// ------------------------------------------------------------------------- text in ASCII (ascii.c)
// A sentence in pure ASCII: Greek letters by name, umlauts by two letters, ² as ^2, dashes and
// arrows as - and ->.
const char* pl_ascii_of(pl_arena* a, const char* s);

// ------------------------------------------------------------------------------------ writing JSON
// A writer on a pl_text: indented by two blanks, keys in the order given. Numbers are the shortest
// decimal that reads back to the same double; NaN and infinities become null. Strings are UTF-8;
// what is not valid UTF-8 becomes U+FFFD.
typedef struct pl_json {
  pl_text* out;
  int depth;
  bool empty;  // nothing was written yet at this depth
  bool after_key;
  uint64_t flat;  // bit per depth: written on one line
} pl_json;
pl_json pl_json_make(pl_text* out);
void pl_json_object(pl_json* j, const char* key);  // key NULL inside a list and at the top
void pl_json_list(pl_json* j, const char* key);
// the object or list just opened stays on one line
void pl_json_flat(pl_json* j);
void pl_json_end_object(pl_json* j);
void pl_json_end_list(pl_json* j);
void pl_json_string(pl_json* j, const char* key, const char* s);  // NULL writes null
void pl_json_number(pl_json* j, const char* key, double x);
void pl_json_int(pl_json* j, const char* key, long n);
void pl_json_bool(pl_json* j, const char* key, bool b);
void pl_json_null(pl_json* j, const char* key);
// a value already written as JSON
void pl_json_raw(pl_json* j, const char* key, const char* json);

// Shortest decimal text of x that reads back to x; "nan", "inf", "-inf".  out has room for 32.
int pl_double_text(char out[32], double x);
// The shortest decimal that reads back to x: "0.1", "-23.544", "1e-300".
const char* pl_shortest_double(pl_arena* a, double x);

// --------------------------------------------------------- hashes for readers (sha256.c, base64.c)
void pl_sha256(unsigned char out[32], const char* s, size_t n);  // FIPS 180-4
const char* pl_hex_text(pl_arena* a, const unsigned char* b, size_t n);
void pl_base64_add(pl_text* out, const void* data, size_t n);  // RFC 4648

#endif
