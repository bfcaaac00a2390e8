// Parser: feeds the tokens of a file to the grammar, one at a time.
//
// Here is decided what depends on the place: where a statement ends (a line goes on while a bracket
// is open or it ends with an operator or comma), which words are keywords, and what happens after
// an error: one message for each statement, and the names that a broken declaration would have
// declared are kept, so that they are not missed later on.
#include "lang/lang_impl.h"

#include <stdarg.h>
#include <string.h>

#include "grammar.h"

// ------------------------------------------------------------------------------------------- nodes
enum { MAX_TREE = 5 * PL_MAX_DEPTH };

static void adopt(pl_parse* p, pl_ast* parent, char op, pl_ast* kid) {
  pl_push(p->arena, parent->kids, kid);
  pl_push(p->arena, parent->ops, op);
  if (kid == NULL) return;
  if (kid->depth + 1 > parent->depth) parent->depth = kid->depth + 1;
  if (parent->depth <= MAX_TREE) return;
  if (!p->said) {
    pl_complain(p->job, PL_E006, pl_ast_span(parent), PL_BOTH("this is nested too deeply"));
  }
  p->said = true;
  parent->kids.at[parent->kids.n - 1] = pl_ast_make(p, PL_AST_BROKEN,
                                                    (pl_bytes){kid->begin, kid->end});
  parent->depth = 2;
}

pl_ast* pl_ast_make(pl_parse* p, pl_ast_kind kind, pl_bytes at) {
  pl_ast* n = PL_NEW(p->arena, pl_ast);
  n->kind = kind;
  n->begin = at.begin;
  n->end = at.end;
  n->source = p->source;
  n->depth = 1;
  if (kind == PL_AST_WORD) n->text = pl_source_text(p->arena, pl_ast_span(n));
  return n;
}

pl_ast* pl_ast_of_token(pl_parse* p, int kind, const pl_token* t) {
  static const struct {
    int token;
    pl_ast_kind kind;
  } leaves[] = {
      {TOK_NUMBER, PL_AST_NUMBER},     {TOK_NAME, PL_AST_NAME}, {TOK_PI, PL_AST_PI},
      {TOK_INFINITY, PL_AST_INFINITY}, {TOK_TEXT, PL_AST_TEXT},
  };
  pl_ast* n = pl_ast_make(p, PL_AST_WORD, (pl_bytes){t->begin, t->end});
  for (size_t i = 0; i < sizeof leaves / sizeof leaves[0]; i++) {
    if (leaves[i].token == kind) n->kind = leaves[i].kind;
  }
  if (n->kind != PL_AST_WORD || t->text) n->text = t->text ? t->text : t->key;
  n->token = kind;
  n->tight = t->tight;
  n->key = t->key;
  n->shown = t->shown;
  n->raw = t->raw;
  n->number = t->number;
  if (kind == TOK_SUPER) {
    n->kind = PL_AST_NUMBER;
    n->text = pl_format(p->arena, "%d", t->number);
  }
  return n;
}

// The 0 that was not written.
pl_ast* pl_ast_zero(pl_parse* p, pl_bytes at) {
  pl_ast* zero = pl_ast_make(p, PL_AST_NUMBER, at);
  zero->text = "0";
  return zero;
}

static void add_kids(pl_parse* p, pl_ast* node, int n, va_list ap) {
  for (int i = 0; i < n; i++) adopt(p, node, 0, va_arg(ap, pl_ast*));
}

pl_ast* pl_ast_with(pl_parse* p, pl_ast_kind kind, pl_bytes at, int n, ...) {
  pl_ast* node = pl_ast_make(p, kind, at);
  va_list ap;
  va_start(ap, n);
  add_kids(p, node, n, ap);
  va_end(ap);
  return node;
}

pl_ast* pl_ast_append(pl_parse* p, pl_ast* list, char op, pl_ast* kid, pl_bytes at) {
  adopt(p, list, op, kid);
  if (list->kids.n == 1 && list->begin > at.begin) list->begin = at.begin;
  list->end = at.end > list->end ? at.end : list->end;
  return list;
}

pl_ast* pl_ast_statement(pl_parse* p, int token, pl_bytes at, int n, ...) {
  pl_ast* node = pl_ast_make(p, PL_AST_STATEMENT, at);
  node->token = token;
  node->broken = p->said && token != TOK_FOR;
  va_list ap;
  va_start(ap, n);
  add_kids(p, node, n, ap);
  va_end(ap);
  return node;
}

pl_ast* pl_ast_item(pl_parse* p, int token, pl_bytes at, int n, ...) {
  pl_ast* node = pl_ast_make(p, PL_AST_ITEM, at);
  node->token = token;
  va_list ap;
  va_start(ap, n);
  add_kids(p, node, n, ap);
  va_end(ap);
  return node;
}

pl_ast* pl_ast_option(pl_parse* p, const char* word, pl_bytes at, pl_ast* value, pl_ast* second) {
  pl_ast* node = pl_ast_make(p, PL_AST_OPTION, at);
  node->text = word;
  adopt(p, node, 0, value);
  if (second) adopt(p, node, 0, second);
  return node;
}

// -------------------------------------------------------------------------------------- the feeder
typedef struct feeder {
  pl_parse* p;
  pl_names* names;
  pl_yypstate* state;
  int open[PL_MAX_DEPTH];  // tokens of open brackets
  int n_open;
  int brace[PL_MAX_BLOCKS + 1];  // tokens of open braces
  int braces;
  int statement;    // keyword of the statement, 0 before it
  int last;         // kind pushed last
  int item;         // request being read
  int chain;        // ^ and signs in a row
  bool item_start;  // a request, a thing or an action may begin
  bool arrow;       // of an event
  bool skip;        // nothing more of this statement
} feeder;

static const pl_token* token_at(const pl_parse* p, int i) {
  return &p->tokens->list.at[i < p->tokens->list.n ? i : p->tokens->list.n - 1];
}

static int next_significant(const pl_parse* p, int i, bool over_lines) {
  for (i++; i < p->tokens->list.n - 1; i++) {
    int k = p->tokens->list.at[i].kind;
    if (k < 0 || (over_lines && k == TOK_EOL)) continue;
    return i;
  }
  return p->tokens->list.n - 1;
}

static void push(feeder* f, int kind, int i) {
  pl_parse* p = f->p;
  const pl_token* t = token_at(p, i);
  p->at = i;
  p->kinds[i] = kind;
  f->last = kind;
  pl_ast* value = pl_ast_of_token(p, kind, t);
  pl_bytes at = {t->begin, t->end};
  if (kind != TOK_EOL && f->skip) return;
  if (pl_yypush_parse(f->state, kind, &value, &at, p) == 2) f->skip = true;
}

// ------------------------------------------------------------------------------- keywords by place
static bool is_word(const pl_token* t, const char* word) {
  return t->kind == TOK_NAME && t->number == 0 && strcmp(t->key, word) == 0;
}

static bool followed_by_of(const pl_parse* p, int i) {
  const pl_token* t = token_at(p, next_significant(p, i, false));
  return is_word(t, "of") || is_word(t, "on");
}

// The token of the request that begins at token i, 0 if it is a plain quantity.
static int item_word(const pl_parse* p, int i) {
  const pl_token* t = token_at(p, i);
  if (t->kind != TOK_NAME || t->number) return 0;
  int word = pl_word_item(t->key);
  if (word == TOK_FORCE && !followed_by_of(p, i)) return 0;
  return word;
}

static int word_of_statement(feeder* f, const pl_token* t, int i) {
  bool top = f->n_open == 0;
  switch (f->statement) {
    case TOK_BODY:
      if (top && f->last == ':' && is_word(t, "mass")) return TOK_WORD_MASS;
      if (top && f->last == ',' && is_word(t, "inertia")) return TOK_WORD_INERTIA;
      if (top && is_word(t, "angle")) return TOK_WORD_ANGLE;
      if (top && is_word(t, "axes")) return TOK_WORD_AXES;
      return 0;
    case TOK_ROD:
      if (top && (f->last == ':' || f->last == TOK_ROD) && is_word(t, "mass")) return TOK_WORD_MASS;
      return 0;
    case TOK_FRICTION:
      if (top && f->last == ',' && is_word(t, "static")) return TOK_WORD_STATIC;
      if (top && f->last == ',' && is_word(t, "surface")) return TOK_WORD_SURFACE;
      return 0;
    case TOK_ASSUME:
      return top && is_word(t, "integer") && f->last != TOK_ASSUME && f->last != ','
                 ? TOK_WORD_INTEGER
                 : 0;
    case TOK_EVENT:
      if (!f->arrow || !f->item_start) return 0;
      if (is_word(t, "stop")) return TOK_WORD_STOP;
      if (is_word(t, "record")) return TOK_WORD_RECORD;
      if (is_word(t, "release")) return TOK_WORD_RELEASE;
      if (is_word(t, "attach")) return TOK_WORD_ATTACH;
      return 0;
    case TOK_ASK:
      if (f->item == TOK_SWEEP && f->last == TOK_OF && is_word(t, "equilibria"))
        return TOK_EQUILIBRIA;
      if (!f->item_start) return 0;
      return f->item == TOK_ANIMATE && f->last == ',' && is_word(t, "force") ? TOK_FORCE
                                                                             : item_word(f->p, i);
    case TOK_ANIMATE:
      return f->item_start && is_word(t, "force") && followed_by_of(f->p, i) ? TOK_FORCE : 0;
    case TOK_DRAW:
      return f->last != TOK_DRAW && is_word(t, "force") && followed_by_of(f->p, i) ? TOK_FORCE : 0;
    case TOK_SWEEP: return f->last == TOK_OF && is_word(t, "equilibria") ? TOK_EQUILIBRIA : 0;
    default: return 0;
  }
}

// A small word is a label where a label stands: before its colon, and wherever the file speaks of
// it again.
static bool declares_label(const pl_parse* p, int i) {
  const pl_token *before = token_at(p, i - 1), *after = token_at(p, i + 1);
  if (i < 1 || !before->first || before->kind != TOK_NAME || before->number
      || !pl_word_statement(before->key))
    return false;
  int word = pl_word_statement(before->key);
  return after->kind == ':'
         || (word == TOK_POINT && (is_word(after, "at") || is_word(after, "on")));
}

static bool is_known_label(const pl_parse* p, const char* key) {
  for (int i = 1; i < p->tokens->list.n; i++) {
    const pl_token* t = token_at(p, i);
    if (t->kind == TOK_NAME && t->number == 0 && strcmp(t->key, key) == 0 && declares_label(p, i))
      return true;
  }
  return false;
}

static bool speaks_of_label(const feeder* f, int i) {
  const pl_parse* p = f->p;
  const pl_token *t = token_at(p, i), *before = token_at(p, i - 1), *after = token_at(p, i + 1);
  switch (f->last) {
    case TOK_ON:
    case TOK_OF:
    case TOK_BETWEEN:
    case TOK_AND:
    case TOK_WHILE:
    case TOK_WORD_RELEASE:
    case TOK_WORD_ATTACH: return is_known_label(p, t->key);
    default: return before->kind == '(' && after->kind == ')' && is_known_label(p, t->key);
  }
}

// Does a new statement begin here?  For lines that seem to go on although a new one was meant.
static bool looks_like_statement(const pl_parse* p, int i) {
  const pl_token* t = token_at(p, i);
  if (t->kind != TOK_NAME || !t->first || t->number || pl_word_statement(t->key) == 0) return false;
  const pl_token* next = token_at(p, i + 1);
  if (next->tight) return false;
  return next->kind == TOK_NAME || next->kind == TOK_NUMBER || next->kind == TOK_TEXT
         || next->kind == '(' || next->kind == TOK_PI;
}

static bool goes_on_after(int kind) {
  switch (kind) {
    case '+':
    case '-':
    case '*':
    case '/':
    case '^':
    case ',':
    case '=':
    case '<':
    case '>':
    case TOK_GE:
    case TOK_LE:
    case TOK_NE:
    case TOK_ARROW:
    case TOK_MUCH:
    case TOK_RANGE:
    case TOK_SEPARATOR:
    case TOK_AND: return true;
    default: return false;
  }
}

// ------------------------------------------------------------------------------ ends of statements
static void keep_lost_names(feeder* f, int end) {
  pl_parse* p = f->p;
  bool all = f->statement == TOK_PARAM || f->statement == TOK_COORD || f->statement == TOK_LET
             || f->statement == TOK_INPUT || f->statement == TOK_OUTPUT || f->statement == TOK_FOR
             || f->statement == 0;
  bool first = true;
  for (int i = p->statement_first; i < end; i++) {
    const pl_token* t = token_at(p, i);
    if (t->kind != TOK_NAME) continue;
    bool is_keyword = i == p->statement_first && f->statement != 0;
    if (is_keyword) continue;
    bool label = token_at(p, i + 1)->kind == ':' || first;
    bool multiplier = f->statement == TOK_CONSTRAINT && is_word(token_at(p, i - 1), "with");
    if (all || label || multiplier) pl_push(p->arena, p->lost, t->key);
    if (label && f->statement == TOK_CONSTRAINT) {
      pl_push(p->arena, p->lost, pl_intern(f->names, pl_format(p->arena, "lambda_%s", t->key)));
    }
    first = false;
  }
  // a multiplier without a name is λ
  if (f->statement == TOK_CONSTRAINT) pl_push(p->arena, p->lost, pl_intern(f->names, "lambda"));
}

static void end_statement(feeder* f, int i) {
  push(f, TOK_EOL, i);
  pl_parsed_statement s = {f->p->statement_first, i, f->statement, f->p->said};
  if (s.first >= 0) pl_push(f->p->arena, f->p->statements, s);
  if (f->p->said) keep_lost_names(f, i);
  f->p->said = false;
  f->p->statement_first = -1;
  f->statement = f->n_open = f->item = f->chain = 0;
  f->arrow = f->skip = false;
}

static void complain_unclosed(feeder* f) {
  pl_parse* p = f->p;
  const pl_token* t = token_at(p, f->open[f->n_open - 1]);
  if (!p->said) {
    pl_diagnostic* m = pl_complain(p->job, PL_E008, (pl_span){p->source, t->begin, t->end},
                                   PL_BOTH("this bracket is not closed"));
    pl_suggest(p->job, m, NULL, PL_BOTH("add %s"), t->kind == '(' ? ")" : "]");
  }
  p->said = true;
}

// True when the statement ends at this end of line.
static bool statement_ends(feeder* f, int i) {
  if (f->n_open == 0 && !goes_on_after(f->last)) return true;
  int next = next_significant(f->p, i, true);
  const pl_token* t = token_at(f->p, next);
  bool unknown = t->kind == 0 && f->p->place;  // the text is cut off: it may go on
  if (unknown) return false;
  if (t->kind != 0 && t->kind != '}' && !looks_like_statement(f->p, next)) return false;
  if (f->n_open) complain_unclosed(f);
  return true;
}

// ---------------------------------------------------------------------------------------- brackets
static void open_bracket(feeder* f, int i) {
  pl_parse* p = f->p;
  if (f->n_open == PL_MAX_DEPTH) {
    const pl_token* t = token_at(p, i);
    if (!p->said) {
      pl_complain(p->job, PL_E006, (pl_span){p->source, t->begin, t->end},
                  PL_BOTH("more than %d brackets inside each other"), PL_MAX_DEPTH);
    }
    p->said = f->skip = true;
    return;
  }
  f->open[f->n_open++] = i;
  push(f, token_at(p, i)->kind, i);
}

static void close_bracket(feeder* f, int i) {
  pl_parse* p = f->p;
  const pl_token* t = token_at(p, i);
  int partner = t->kind == ')' ? '(' : '[';
  if (f->n_open && token_at(p, f->open[f->n_open - 1])->kind == partner) {
    f->n_open--;
    push(f, t->kind, i);
    return;
  }
  if (!p->said) {
    pl_diagnostic* m = pl_complain(p->job, PL_E008, (pl_span){p->source, t->begin, t->end},
                                   PL_BOTH("nothing was opened that this bracket could close"));
    pl_suggest(p->job, m, "", PL_BOTH("remove it"));
    if (f->n_open) {
      const pl_token* o = token_at(p, f->open[f->n_open - 1]);
      pl_report_label(p->job->diagnostics, m, (pl_span){p->source, o->begin, o->end}, "");
    }
  }
  p->said = f->skip = true;
}

static void open_brace(feeder* f, int i) {
  pl_parse* p = f->p;
  if (f->braces >= PL_MAX_BLOCKS && !p->said) {
    const pl_token* t = token_at(p, i);
    pl_complain(p->job, PL_E006, (pl_span){p->source, t->begin, t->end},
                PL_BOTH("more than %d blocks inside each other"), PL_MAX_BLOCKS);
    p->said = true;
  }
  if (f->statement == TOK_FOR && !p->said && f->n_open == 0) push(f, '{', i);
  if (f->statement != TOK_FOR || p->said || f->n_open) {
    if (!p->said) {
      const pl_token* t = token_at(p, i);
      pl_complain(p->job, PL_E001, (pl_span){p->source, t->begin, t->end},
                  PL_BOTH("{ belongs to for only"));
      p->said = true;
    }
    p->lost_braces++;
    f->skip = true;
  } else {
    f->brace[f->braces++] = i;
  }
  end_statement(f, i);
}

static void close_brace(feeder* f, int i) {
  pl_parse* p = f->p;
  if (f->n_open) complain_unclosed(f);
  if (f->p->statement_first >= 0) end_statement(f, i);
  if (p->lost_braces > 0) {
    p->lost_braces--;
    return;
  }
  if (f->braces == 0) {
    const pl_token* t = token_at(p, i);
    pl_diagnostic* m = pl_complain(p->job, PL_E008, (pl_span){p->source, t->begin, t->end},
                                   PL_BOTH("nothing was opened that this brace could close"));
    pl_suggest(p->job, m, "", PL_BOTH("remove it"));
    return;
  }
  f->braces--;
  p->statement_first = i;
  f->statement = '}';
  push(f, '}', i);
}

// --------------------------------------------------------------------------------- words and signs
static void unknown_statement(feeder* f, int i) {
  pl_parse* p = f->p;
  const pl_token* t = token_at(p, i);
  pl_span span = {p->source, t->begin, t->end};
  if (!p->said && t->kind != TOK_NAME) {
    pl_diagnostic* m = pl_complain(p->job, PL_E001, span,
                                   PL_BOTH("a statement begins with a word"));
    pl_suggest(p->job, m, NULL, PL_BOTH("begin with param, coord, mass, constraint, ..."));
  } else if (!p->said) {
    const char* word = pl_source_text(p->arena, span);
    pl_diagnostic* m = pl_complain(p->job, PL_E004, span, PL_BOTH("%s is not a statement"), word);
    const char* near = pl_slip_statement(t->key);
    if (!near) near = pl_word_near_statement(t->key);
    bool equation = false;
    for (int k = i; token_at(p, k)->kind != TOK_EOL && token_at(p, k)->kind != 0; k++)
      equation |= token_at(p, k)->kind == '=';
    if (near) pl_suggest(p->job, m, near, PL_BOTH("did you mean %s?"), near);
    else if (token_at(p, i + 1)->kind == '=')
      pl_suggest(p->job, m, NULL, PL_BOTH("write  param %1$s = ...  or  let %1$s = ..."), word);
    else if (equation) pl_suggest(p->job, m, NULL, PL_BOTH("write  constraint %s ... = ..."), word);
    else
      pl_suggest(
          p->job, m, NULL,
          PL_BOTH("statements are param, coord, let, mass, force, constraint, init, ask, ..."));
  }
  p->said = f->skip = true;
}

static void begin_statement(feeder* f, int i) {
  const pl_token* t = token_at(f->p, i);
  f->p->statement_first = i;
  f->statement = t->kind == TOK_NAME && t->number == 0 ? pl_word_statement(t->key) : 0;
  if (f->statement == 0) {
    unknown_statement(f, i);
    return;
  }
  f->item_start = true;
  push(f, f->statement, i);
}

static int feed_word(feeder* f, int i) {
  pl_parse* p = f->p;
  const pl_token* t = token_at(p, i);
  if (f->statement == TOK_SIMULATE && !p->said) {  // simulate 0 to 10 would be a product
    p->at = i;
    if (pl_slip(p)) {
      p->said = f->skip = true;
      return i;
    }
  }
  int word = word_of_statement(f, t, i);
  if (t->number == 0 && pl_word_reserved(t->key)
      && (declares_label(p, i) || speaks_of_label(f, i))) {
    f->item_start = false;
    push(f, TOK_NAME, i);
    return i;
  }
  if (f->item_start && f->statement == TOK_ASK) f->item = word;
  f->item_start = false;
  if (word == 0 && t->number == 0 && f->n_open == 0) word = pl_word_reserved(t->key);
  if (word == 0 && t->number == 0 && is_word(t, "in")) word = TOK_IN;
  if (word == 0 && t->number == 0 && f->n_open && pl_word_reserved(t->key))
    word = pl_word_reserved(t->key);
  push(f, word ? word : TOK_NAME, i);
  if (word == TOK_REDUNDANT && is_word(token_at(p, i + 1), "ok")) return i + 1;
  return i;
}

static void feed_comma(feeder* f, int i) {
  bool top = f->n_open == 0;
  f->item_start = top;
  int next = next_significant(f->p, i, true);
  int word = top && f->statement == TOK_ASK ? item_word(f->p, next) : 0;
  if (word && !(f->item == TOK_ANIMATE && word == TOK_FORCE)) push(f, TOK_SEPARATOR, i);
  else push(f, ',', i);
}

// Powers of powers and signs of signs nest; brackets are counted elsewhere.
static bool chain_too_long(feeder* f, int i) {
  enum { MAX_CHAIN = 60 };
  const pl_token* t = token_at(f->p, i);
  bool sign = t->kind == '-' && (goes_on_after(f->last) || f->last == '(');
  if (t->kind == '^' || sign) f->chain++;
  else if (t->kind == '+' || t->kind == '-' || t->kind == '*' || t->kind == '/' || t->kind == ','
           || t->kind == '=')
    f->chain = 0;
  if (f->chain <= MAX_CHAIN) return false;
  if (!f->p->said) {
    pl_complain(f->p->job, PL_E006, (pl_span){f->p->source, t->begin, t->end},
                PL_BOTH("more than %d powers or signs in a row"), MAX_CHAIN);
  }
  f->p->said = f->skip = true;
  return true;
}

static int feed(feeder* f, int i) {
  pl_parse* p = f->p;
  const pl_token* t = token_at(p, i);
  if (t->kind == PL_TOKEN_WRONG) p->said = true;
  if (t->kind < 0) return i;
  if (t->kind == TOK_EOL) {
    if (p->statement_first < 0) p->said = false;
    else if (statement_ends(f, i)) end_statement(f, i);
    return i;
  }
  if (t->kind == '}') {
    close_brace(f, i);
    return i;
  }
  if (p->statement_first < 0) {
    begin_statement(f, i);
    return i;
  }
  if (t->kind == '{') {
    open_brace(f, i);
    return i;
  }
  if (f->skip || chain_too_long(f, i)) return i;
  switch (t->kind) {
    case TOK_NAME: return feed_word(f, i);
    case '(':
    case '[':
      f->item_start = false;
      open_bracket(f, i);
      return i;
    case ')':
    case ']': close_bracket(f, i); return i;
    case ',': feed_comma(f, i); return i;
    default:
      f->arrow |= t->kind == TOK_ARROW;
      f->item_start = t->kind == ':' || (t->kind == TOK_ARROW && f->statement == TOK_EVENT);
      push(f, t->kind, i);
      return i;
  }
}

static void complain_open_block(feeder* f) {
  pl_parse* p = f->p;
  int at = p->tokens->list.n - 1;
  if (f->braces && !p->said) {
    const pl_token* t = token_at(p, f->brace[f->braces - 1]);
    pl_diagnostic* m = pl_complain(p->job, PL_E008, (pl_span){p->source, t->begin, t->end},
                                   PL_BOTH("a block of for is not closed"));
    pl_suggest(p->job, m, NULL, PL_BOTH("add }"));
  }
  // close what is open, so that the rest of the file counts
  for (; f->braces; f->braces--) {
    p->said = true;
    push(f, '}', at);
    push(f, TOK_EOL, at);
  }
}

// The end of a text that is cut off: a token that fits nowhere makes the grammar say what would.
static void ask_expected(feeder* f) {
  pl_parse* p = f->p;
  pl_parse_place* out = p->place;
  out->at_statement = p->statement_first < 0;
  out->fits = !p->said && !f->skip;
  out->in_block = f->braces > 0;
  out->statement = f->statement;
  out->last = f->last;
  out->item = f->item;
  out->depth = f->n_open;
  out->bracket = f->n_open ? f->open[f->n_open - 1] : -1;
  if (!out->at_statement && out->fits) push(f, TOK_CURSOR, p->tokens->list.n - 1);
}

static void feed_all(feeder* f, int start) {
  pl_parse* p = f->p;
  pl_token first = {0};
  pl_ast* value = pl_ast_of_token(p, start, &first);
  pl_bytes at = {0, 0};
  pl_yypush_parse(f->state, start, &value, &at, p);
  int n = p->tokens->list.n - 1;
  if (p->place) {
    // the end of the last line is not in the text
    if (n > 0 && token_at(p, n - 1)->begin == p->source->size) n--;
    for (int i = 0; i < n; i++) i = feed(f, i);
    ask_expected(f);
    return;
  }
  if (start == TOK_START_EXPRESSION) {
    p->statement_first = 0;
    f->statement = TOK_PARAM;
  }
  for (int i = 0; i < n; i++) i = feed(f, i);
  if (p->statement_first >= 0) {
    if (f->n_open) complain_unclosed(f);
    end_statement(f, n);
  }
  complain_open_block(f);
  f->skip = false;
  push(f, 0, n);
}

static void run(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source, int start,
                pl_parse_place* place) {
  *p = (pl_parse){
      .job = job, .arena = job->arena, .source = source, .statement_first = -1, .place = place};
  pl_tokens* tokens = PL_NEW(job->arena, pl_tokens);
  pl_lex(job, names, source, tokens);
  p->tokens = tokens;
  p->kinds = PL_ARRAY(job->arena, int, tokens->list.n);
  // the parser's stacks are its own memory: let them go when memory runs out here
  pl_yypstate* state = pl_yypstate_new();
  if (state == NULL) pl_unwind(job->arena, PLEUEL_NO_MEMORY);
  pl_guard guard;
  pleuel_status status = PLEUEL_OK;
  PL_GUARD(job->arena, guard) {
    feeder* f = PL_NEW(job->arena, feeder);
    f->p = p;
    f->names = names;
    f->state = state;
    feed_all(f, start);
  }
  else {
    status = guard.status;
  }
  pl_guard_end(job->arena, &guard);
  pl_yypstate_delete(state);
  if (status) pl_unwind(job->arena, status);
}

void pl_parse_text(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source) {
  run(p, job, names, source, TOK_START_FILE, NULL);
}

void pl_parse_cut(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source,
                  pl_parse_place* out) {
  *out = (pl_parse_place){0};
  run(p, job, names, source, TOK_START_FILE, out);
}

pl_ast* pl_parse_expression(pl_parse* p, pl_job* job, pl_names* names, const pl_source* source) {
  int before = job->diagnostics->n_errors;
  run(p, job, names, source, TOK_START_EXPRESSION, NULL);
  return job->diagnostics->n_errors > before ? NULL : p->root;
}
