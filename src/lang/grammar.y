// Grammar of the model language.  It builds a tree and decides nothing that needs the declarations: a blank product is a
// list of factors, a bracket after a name is the next factor.  lower_expr.c makes sense of them.
//
// Words are keywords by their place (keywords.def, parse.c), so names can be `force` or `mass`.  Every statement ends with
// EOL, also before `}` and after `{`; errors are caught at that end.
%code requires {
#include "lang/lang_impl.h"
}

%code {
#include "grammar.h"

// Spans join: from the first symbol to the last; an empty rule sits after what is before it.
#define YYLLOC_DEFAULT(current, rhs, n)                       \
  do {                                                        \
    if (n) {                                                  \
      (current).begin = YYRHSLOC(rhs, 1).begin;               \
      (current).end = YYRHSLOC(rhs, n).end;                   \
    } else {                                                  \
      (current).begin = (current).end = YYRHSLOC(rhs, 0).end; \
    }                                                         \
  } while (0)

static void pl_yyerror(pl_bytes* at, pl_parse* p, const char* message);
#define NODE(kind, at, ...) pl_ast_with(p, PL_AST_##kind, at, __VA_ARGS__)
#define STATEMENT(token, at, ...) pl_ast_statement(p, TOK_##token, at, __VA_ARGS__)
#define ITEM(token, at, ...) pl_ast_item(p, TOK_##token, at, __VA_ARGS__)
#define APPEND(list, op, kid, at) pl_ast_append(p, list, op, kid, at)
#define LIST(kid, at) pl_ast_append(p, pl_ast_make(p, PL_AST_LIST, at), ',', kid, at)
}

%define api.pure full
%define api.push-pull push
%define api.prefix {pl_yy}
%define api.token.prefix {TOK_}
%define api.value.type {pl_ast*}
%define api.location.type {pl_bytes}
%define parse.error custom
%define parse.lac full
%locations
%parse-param {pl_parse* p}
%initial-action { @$ = (pl_bytes){0, 0}; }
%expect 0

%token START_FILE START_EXPRESSION
// stands in no rule: where a text is cut off it makes the parser list what would fit
%token CURSOR
%token EOL
%token NUMBER NAME PI INFINITY TEXT UNIT DEGREE PRIMES SUPER
%token GE LE NE ARROW MUCH RANGE SEPARATOR
// statements
%token PLEUEL SYSTEM LANG AXES CONVENTION INCLUDE PARAM COORD LET ASSUME INPUT OUTPUT MASS BODY POINT ROD GRAVITY FORCE
%token TORQUE POTENTIAL KINETIC LAGRANGIAN RAYLEIGH SPRING DAMPER DRAG CONSTRAINT FRICTION RESTITUTION CHOOSE BRANCH
%token INIT GUESS EVENT ASK SIMULATE PLOT ANIMATE DRAW SWEEP POINCARE
// requests
%token DOF CONSTRAINTS LAGRANGE1 LAGRANGE2 HAMILTONIAN NEWTON SOLVE CONSERVED EQUILIBRIA MODES LIMIT SERIES THRESHOLD
%token MAXIMUM MINIMUM AVERAGE STABILITY EXPECT
// small words
%token AT ON OF WITH WHEN WHERE WHILE FROM IN AND FOR VS ALONG BETWEEN OVER HOLDING RISING FALLING STEP COUNT TOL ORDER
%token REST OFF REDUNDANT
// words of one statement
%token WORD_MASS WORD_INERTIA WORD_ANGLE WORD_AXES WORD_STATIC WORD_SURFACE WORD_INTEGER WORD_STOP WORD_RECORD WORD_RELEASE
%token WORD_ATTACH

// a list inside a request takes the comma; the next request needs its keyword
%precedence LIST_ENDS
%precedence ','

%%
start
  : START_FILE lines                  { p->root = $2; }
  | START_EXPRESSION element eols     { p->root = $2; }
  | START_EXPRESSION error eols       { p->root = NULL; }
  ;
eols : %empty | eols EOL { yyerrok; } ;

lines
  : %empty                            { $$ = pl_ast_make(p, PL_AST_FILE, @$); }
  | lines EOL                         { $$ = $1; }
  | lines statement EOL               { $$ = APPEND($1, 0, $2, @$); yyerrok; }
  | lines error EOL                   { $$ = $1; yyerrok; }
  ;

statement
  : PLEUEL NUMBER                     { $$ = STATEMENT(PLEUEL, @$, 1, $2); }
  | SYSTEM TEXT                       { $$ = STATEMENT(SYSTEM, @$, 1, $2); }
  | LANG NAME                         { $$ = STATEMENT(LANG, @$, 1, $2); }
  | LANG TEXT                         { $$ = STATEMENT(LANG, @$, 1, $2); }
  | AXES axes                         { $$ = STATEMENT(AXES, @$, 1, $2); }
  | CONVENTION words                  { $$ = STATEMENT(CONVENTION, @$, 1, $2); }
  | INCLUDE TEXT                      { $$ = STATEMENT(INCLUDE, @$, 1, $2); }
  | PARAM params                      { $$ = STATEMENT(PARAM, @$, 1, $2); }
  | COORD coords                      { $$ = STATEMENT(COORD, @$, 1, $2); }
  | LET lets                          { $$ = STATEMENT(LET, @$, 1, $2); }
  | ASSUME conditions                 { $$ = STATEMENT(ASSUME, @$, 1, $2); }
  | INPUT coords                      { $$ = STATEMENT(INPUT, @$, 1, $2); }
  | OUTPUT NAME '=' expr              { $$ = STATEMENT(OUTPUT, @$, 2, $2, $4); }
  | MASS expr AT expr                 { $$ = STATEMENT(MASS, @$, 3, NULL, $2, $4); }
  | MASS label ':' expr AT expr       { $$ = STATEMENT(MASS, @$, 3, $2, $4, $6); }
  | BODY label ':' WORD_MASS expr ',' WORD_INERTIA expr AT expr WORD_ANGLE expr
                                      { $$ = STATEMENT(BODY, @$, 5, $2, $5, $8, $10, $12); }
  | BODY label ':' WORD_MASS expr ',' WORD_INERTIA expr AT expr WORD_AXES expressions
                                      { $$ = STATEMENT(BODY, @$, 6, $2, $5, $8, $10, NULL, $12); }
  | POINT label AT expr               { $$ = STATEMENT(POINT, @$, 3, $2, $4, NULL); }
  | POINT label ON expr AT expr       { $$ = STATEMENT(POINT, @$, 3, $2, $6, $4); }
  | ROD WORD_MASS expr BETWEEN expr AND expr
                                      { $$ = STATEMENT(ROD, @$, 4, NULL, $3, $5, $7); }
  | ROD label ':' WORD_MASS expr BETWEEN expr AND expr
                                      { $$ = STATEMENT(ROD, @$, 4, $2, $5, $7, $9); }
  | GRAVITY expr ALONG direction      { $$ = STATEMENT(GRAVITY, @$, 2, $2, $4); }
  | FORCE expr ON expr                { $$ = STATEMENT(FORCE, @$, 3, NULL, $2, $4); }
  | FORCE label ':' expr ON expr      { $$ = STATEMENT(FORCE, @$, 3, $2, $4, $6); }
  | TORQUE expr ON expr               { $$ = STATEMENT(TORQUE, @$, 3, NULL, $2, $4); }
  | TORQUE label ':' expr ON expr     { $$ = STATEMENT(TORQUE, @$, 3, $2, $4, $6); }
  | POTENTIAL expr                    { $$ = STATEMENT(POTENTIAL, @$, 2, NULL, $2); }
  | POTENTIAL label ':' expr          { $$ = STATEMENT(POTENTIAL, @$, 2, $2, $4); }
  | KINETIC expr                      { $$ = STATEMENT(KINETIC, @$, 2, NULL, $2); }
  | KINETIC label ':' expr            { $$ = STATEMENT(KINETIC, @$, 2, $2, $4); }
  | LAGRANGIAN expr                   { $$ = STATEMENT(LAGRANGIAN, @$, 2, NULL, $2); }
  | RAYLEIGH expr                     { $$ = STATEMENT(RAYLEIGH, @$, 2, NULL, $2); }
  | SPRING expr rest BETWEEN expr AND expr
                                      { $$ = STATEMENT(SPRING, @$, 5, NULL, $2, $3, $5, $7); }
  | SPRING label ':' expr rest BETWEEN expr AND expr
                                      { $$ = STATEMENT(SPRING, @$, 5, $2, $4, $5, $7, $9); }
  | DAMPER expr BETWEEN expr AND expr { $$ = STATEMENT(DAMPER, @$, 4, NULL, $2, $4, $6); }
  | DAMPER label ':' expr BETWEEN expr AND expr
                                      { $$ = STATEMENT(DAMPER, @$, 4, $2, $4, $6, $8); }
  | DRAG expr ON expr                 { $$ = STATEMENT(DRAG, @$, 3, NULL, $2, $4); }
  | DRAG label ':' expr ON expr       { $$ = STATEMENT(DRAG, @$, 3, $2, $4, $6); }
  | CONSTRAINT relation options       { $$ = STATEMENT(CONSTRAINT, @$, 3, NULL, $2, $3); }
  | CONSTRAINT label ':' relation options
                                      { $$ = STATEMENT(CONSTRAINT, @$, 3, $2, $4, $5); }
  | FRICTION expr friction ON expr    { $$ = STATEMENT(FRICTION, @$, 3, $2, $3, $5); }
  | RESTITUTION expr ON expr          { $$ = STATEMENT(RESTITUTION, @$, 2, $2, $4); }
  | CHOOSE expressions                { $$ = STATEMENT(CHOOSE, @$, 2, $2, NULL); }
  | CHOOSE expressions WITH relations { $$ = STATEMENT(CHOOSE, @$, 2, $2, $4); }
  | BRANCH relations                  { $$ = STATEMENT(BRANCH, @$, 1, $2); }
  | INIT relations                    { $$ = STATEMENT(INIT, @$, 2, NULL, $2); }
  | INIT AT factor relations          { $$ = STATEMENT(INIT, @$, 2, $3, $4); }
  | GUESS relations                   { $$ = STATEMENT(GUESS, @$, 2, NULL, $2); }
  | EVENT label ':' WHEN relation way ARROW actions
                                      { $$ = STATEMENT(EVENT, @$, 4, $2, $5, $6, $8); }
  | ASK items                         { $$ = STATEMENT(ASK, @$, 2, NULL, $2); }
  | ASK NAME ':' items                { $$ = STATEMENT(ASK, @$, 2, $2, $4); }
  | SIMULATE times tolerance          { $$ = STATEMENT(SIMULATE, @$, 2, $2, $3); }
  | PLOT expressions                  { $$ = STATEMENT(PLOT, @$, 2, $2, NULL); }
  | PLOT expressions VS expr          { $$ = STATEMENT(PLOT, @$, 2, $2, $4); }
  | ANIMATE                           { $$ = STATEMENT(ANIMATE, @$, 1, pl_ast_make(p, PL_AST_LIST, @$)); }
  | ANIMATE things                    { $$ = STATEMENT(ANIMATE, @$, 1, $2); }
  | DRAW NAME things                  { $$ = STATEMENT(DRAW, @$, 4, $2, $3, NULL, NULL); }
  | DRAW NAME BETWEEN expr AND expr   { $$ = STATEMENT(DRAW, @$, 4, $2, NULL, $4, $6); }
  | SWEEP sweeps OF swept             { $$ = STATEMENT(SWEEP, @$, 2, $2, $4); }
  | POINCARE relation way OF expressions
                                      { $$ = STATEMENT(POINCARE, @$, 3, $2, $3, $5); }
  | FOR NAME IN range '{' lines '}'   { $$ = STATEMENT(FOR, @$, 3, $2, $4, $6); }
  ;

// ---------------------------------------------------------------------------------------------- declarations
axes : axis                           { $$ = LIST($1, @$); }
  | axes ',' axis                     { $$ = APPEND($1, ',', $3, @$); }
  ;
axis : NAME                           { $$ = NODE(AXIS, @$, 2, $1, NULL); }
  | NAME NAME                         { $$ = NODE(AXIS, @$, 2, $1, $2); }
  ;
words : word                          { $$ = LIST($1, @$); }
  | words ',' word                    { $$ = APPEND($1, ',', $3, @$); }
  ;
word : NAME                           { $$ = pl_ast_make(p, PL_AST_WORD, @$); }
  | word '-' NAME                     { $$ = pl_ast_make(p, PL_AST_WORD, @$); }
  | word '-' FROM                     { $$ = pl_ast_make(p, PL_AST_WORD, @$); }
  | word '-' ALONG                    { $$ = pl_ast_make(p, PL_AST_WORD, @$); }
  ;
params : param                        { $$ = LIST($1, @$); }
  | params ',' param                  { $$ = APPEND($1, ',', $3, @$); }
  ;
param : declared                      { $$ = NODE(DEFINITION, @$, 4, $1, NULL, NULL, NULL); }
  | declared '=' expr                 { $$ = NODE(DEFINITION, @$, 4, $1, NULL, $3, NULL); }
  | declared unit                     { $$ = NODE(DEFINITION, @$, 4, $1, NULL, NULL, $2); }
  | declared unit '=' expr            { $$ = NODE(DEFINITION, @$, 4, $1, NULL, $4, $2); }
  ;
coords : coord                        { $$ = LIST($1, @$); }
  | coords ',' coord                  { $$ = APPEND($1, ',', $3, @$); }
  ;
coord : declared                      { $$ = NODE(DEFINITION, @$, 4, $1, NULL, NULL, NULL); }
  | declared unit                     { $$ = NODE(DEFINITION, @$, 4, $1, NULL, NULL, $2); }
  ;
lets : let                            { $$ = LIST($1, @$); }
  | lets ',' let                      { $$ = APPEND($1, ',', $3, @$); }
  ;
let : declared '=' expr               { $$ = NODE(DEFINITION, @$, 4, $1, NULL, $3, NULL); }
  | NAME group '=' expr               { $$ = NODE(DEFINITION, @$, 4, $1, $2, $4, NULL); }
  ;
declared : NAME | indexed ;
unit : UNIT                           { $$ = NODE(UNIT, @$, 1, NULL); $$->text = $1->text; }
  ;
conditions : condition                { $$ = LIST($1, @$); }
  | conditions ',' condition          { $$ = APPEND($1, ',', $3, @$); }
  ;
condition : relation
  | expr IN range                     { $$ = NODE(IN, @$, 2, $1, $3); }
  | expr WORD_INTEGER                 { $$ = NODE(INTEGER, @$, 1, $1); }
  ;

// ---------------------------------------------------------------------------------------------- physics
label : NAME                          { $$ = NODE(LABEL, @$, 2, $1, NULL); }
  | indexed                           { $$ = NODE(LABEL, @$, 2, pl_ast_kid($1, 0), pl_ast_kid($1, 1)); }
  ;
indexed : NAME '[' index ']'          { $$ = NODE(INDEXED, @$, 2, $1, $3); }
  ;
index : expr
  | expr RANGE expr                   { $$ = NODE(RANGE, @$, 4, $1, $3, NULL, NULL); }
  ;
direction : NAME                      { $$ = NODE(DIRECTION, @$, 1, $1); $$->number = 1; }
  | '+' NAME                          { $$ = NODE(DIRECTION, @$, 1, $2); $$->number = 1; }
  | '-' NAME                          { $$ = NODE(DIRECTION, @$, 1, $2); $$->number = -1; }
  ;
rest : %empty                         { $$ = NULL; }
  | ',' REST expr                     { $$ = $3; }
  ;
options : %empty                      { $$ = pl_ast_make(p, PL_AST_LIST, @$); }
  | options WITH NAME                 { $$ = APPEND($1, 0, pl_ast_option(p, "with", @3, $3, NULL), @$); }
  | options WHILE label               { $$ = APPEND($1, 0, pl_ast_option(p, "while", @3, $3, NULL), @$); }
  | options ',' REDUNDANT             { $$ = APPEND($1, 0, pl_ast_option(p, "redundant", @3, NULL, NULL), @$); }
  | options ',' OFF                   { $$ = APPEND($1, 0, pl_ast_option(p, "off", @3, NULL, NULL), @$); }
  ;
friction : %empty                     { $$ = pl_ast_make(p, PL_AST_LIST, @$); }
  | friction ',' WORD_STATIC expr     { $$ = APPEND($1, 0, pl_ast_option(p, "static", @4, $4, NULL), @$); }
  | friction ',' WORD_SURFACE expr    { $$ = APPEND($1, 0, pl_ast_option(p, "surface", @4, $4, NULL), @$); }
  | friction ',' AT expr              { $$ = APPEND($1, 0, pl_ast_option(p, "at", @4, $4, NULL), @$); }
  ;
relations : relation                  { $$ = LIST($1, @$); }
  | relations ',' relation            { $$ = APPEND($1, ',', $3, @$); }
  ;
way : %empty                          { $$ = NULL; }
  | RISING
  | FALLING
  ;
actions : action                      { $$ = LIST($1, @$); }
  | actions ',' action                { $$ = APPEND($1, ',', $3, @$); }
  ;
action : WORD_STOP                    { $$ = NODE(ACTION, @$, 0); $$->text = "stop"; }
  | WORD_RECORD                       { $$ = NODE(ACTION, @$, 0); $$->text = "record"; }
  | WORD_RELEASE label                { $$ = NODE(ACTION, @$, 1, $2); $$->text = "release"; }
  | WORD_ATTACH label                 { $$ = NODE(ACTION, @$, 1, $2); $$->text = "attach"; }
  | expr '=' expr                     { $$ = NODE(ACTION, @$, 2, $1, $3); $$->text = "set"; }
  ;

// ---------------------------------------------------------------------------------------------- requests
items : item                          { $$ = LIST($1, @$); }
  | items ',' item                    { $$ = APPEND($1, ',', $3, @$); }
  | items SEPARATOR item              { $$ = APPEND($1, ',', $3, @$); }
  ;
item : DOF                            { $$ = ITEM(DOF, @$, 0); }
  | CONSTRAINTS                       { $$ = ITEM(CONSTRAINTS, @$, 0); }
  | CONSERVED                         { $$ = ITEM(CONSERVED, @$, 0); }
  | LAGRANGE1 frame                   { $$ = ITEM(LAGRANGE1, @$, 1, $2); }
  | LAGRANGE2 frame                   { $$ = ITEM(LAGRANGE2, @$, 1, $2); }
  | LAGRANGIAN frame                  { $$ = ITEM(LAGRANGIAN, @$, 1, $2); }
  | HAMILTONIAN frame                 { $$ = ITEM(HAMILTONIAN, @$, 1, $2); }
  | NEWTON frame                      { $$ = ITEM(NEWTON, @$, 1, $2); }
  | SOLVE expr                        { $$ = ITEM(SOLVE, @$, 1, $2); }
  | expr where motion                 { $$ = ITEM(NAME, @$, 3, $1, $2, $3); }
  | FORCE OF label motion             { $$ = ITEM(FORCE, @$, 3, $3, NULL, $4); $$->number = TOK_OF; }
  | FORCE ON label frame motion       { $$ = ITEM(FORCE, @$, 3, $3, $4, $5); $$->number = TOK_ON; }
  | EQUILIBRIA of_label for_relation  { $$ = ITEM(EQUILIBRIA, @$, 2, $2, $3); }
  | MODES at_element holding          { $$ = ITEM(MODES, @$, 2, $2, $3); }
  | LIMIT expr ARROW expr OF expr     { $$ = ITEM(LIMIT, @$, 3, $2, $4, $6); $$->number = TOK_ARROW; }
  | LIMIT expr '=' expr OF expr       { $$ = ITEM(LIMIT, @$, 3, $2, $4, $6); $$->number = '='; }
  | LIMIT expr MUCH expr OF expr      { $$ = ITEM(LIMIT, @$, 3, $2, $4, $6); $$->number = TOK_MUCH; }
  | SERIES expr ARROW expr order OF expr
                                      { $$ = ITEM(SERIES, @$, 6, NULL, NULL, $2, $4, $5, $7); }
  | SERIES expr '=' expr ',' expr ARROW expr order OF expr
                                      { $$ = ITEM(SERIES, @$, 6, $2, $4, $6, $8, $9, $11); }
  | THRESHOLD expr OF element at_element
                                      { $$ = ITEM(THRESHOLD, @$, 3, $2, $4, $5); }
  | MAXIMUM expr motion               { $$ = ITEM(MAXIMUM, @$, 2, $2, $3); }
  | MINIMUM expr motion               { $$ = ITEM(MINIMUM, @$, 2, $2, $3); }
  | AVERAGE OVER expr                 { $$ = ITEM(AVERAGE, @$, 1, $3); }
  | STABILITY OF relation OVER expr   { $$ = ITEM(STABILITY, @$, 2, $3, $5); }
  | EXPECT relation where motion      { $$ = ITEM(EXPECT, @$, 3, $2, $3, $4); }
  | SIMULATE times tolerance          { $$ = ITEM(SIMULATE, @$, 2, $2, $3); }
  | PLOT expressions VS expr          { $$ = ITEM(PLOT, @$, 2, $2, $4); }
  | ANIMATE things %prec LIST_ENDS    { $$ = ITEM(ANIMATE, @$, 1, $2); }
  | SWEEP sweeps OF swept             { $$ = ITEM(SWEEP, @$, 2, $2, $4); }
  | POINCARE relation way OF expressions %prec LIST_ENDS
                                      { $$ = ITEM(POINCARE, @$, 3, $2, $3, $5); }
  ;
frame : %empty                        { $$ = NULL; }
  | IN group                          { $$ = $2; }
  ;
where : %empty                        { $$ = NULL; }
  | WHERE all                         { $$ = $2; }
  ;
all : relation                        { $$ = LIST($1, @$); }
  | all AND relation                  { $$ = APPEND($1, ',', $3, @$); }
  ;
motion : %empty                       { $$ = NULL; }
  | FROM all                          { $$ = NODE(MOTION, @$, 1, $2); }
  | FROM all AT REST                  { $$ = NODE(MOTION, @$, 1, $2); $$->number = 1; }
  | FROM REST                         { $$ = NODE(MOTION, @$, 1, NULL); $$->number = 1; }
  ;
of_label : %empty                     { $$ = NULL; }
  | OF label                          { $$ = $2; }
  ;
for_relation : %empty                 { $$ = NULL; }
  | FOR all                           { $$ = $2; }
  ;
at_element : %empty                   { $$ = NULL; }
  | AT element                        { $$ = $2; }
  ;
holding : %empty                      { $$ = NULL; }
  | HOLDING expressions %prec LIST_ENDS { $$ = $2; }
  ;
order : %empty                        { $$ = NULL; }
  | ORDER expr                        { $$ = $2; }
  ;
tolerance : %empty                    { $$ = NULL; }
  | TOL expr                          { $$ = $2; }
  ;
things : thing                        { $$ = LIST($1, @$); }
  | things ',' thing                  { $$ = APPEND($1, ',', $3, @$); }
  ;
thing : NAME                          { $$ = pl_ast_option(p, $1->text, @1, NULL, NULL); }
  | NAME OF label                     { $$ = pl_ast_option(p, $1->text, @1, $3, NULL); }
  | FORCE OF label                    { $$ = pl_ast_option(p, "force", @1, $3, NULL); }
  | FORCE ON label                    { $$ = pl_ast_option(p, "force on", @1, $3, NULL); }
  | COUNT expr                        { $$ = pl_ast_option(p, "count", @1, $2, NULL); }
  ;
sweeps : sweep                        { $$ = LIST($1, @$); }
  | sweeps ',' sweep                  { $$ = APPEND($1, ',', $3, @$); }
  ;
sweep : NAME '=' range                { $$ = NODE(LIST, @$, 2, $1, $3); }
  ;
swept : expressions %prec LIST_ENDS
  | EQUILIBRIA                        { $$ = NULL; }
  ;
expressions : expr                    { $$ = LIST($1, @$); }
  | expressions ',' expr              { $$ = APPEND($1, ',', $3, @$); }
  ;
range : expr RANGE expr               { $$ = NODE(RANGE, @$, 4, $1, $3, NULL, NULL); }
  | expr RANGE expr STEP expr         { $$ = NODE(RANGE, @$, 4, $1, $3, $5, NULL); }
  | expr RANGE expr COUNT expr        { $$ = NODE(RANGE, @$, 4, $1, $3, NULL, $5); }
  ;

// simulate 10 [s] begins at 0
times : range
  | expr                              { $$ = NODE(RANGE, @$, 4, pl_ast_zero(p, @$), $1, NULL, NULL); }
  | expr STEP expr                    { $$ = NODE(RANGE, @$, 4, pl_ast_zero(p, @$), $1, $3, NULL); }
  | expr COUNT expr                   { $$ = NODE(RANGE, @$, 4, pl_ast_zero(p, @$), $1, NULL, $3); }
  ;

// ---------------------------------------------------------------------------------------------- expressions
relation
  : expr relates expr                 { $$ = APPEND(APPEND(pl_ast_make(p, PL_AST_RELATION, @$), 0, $1, @1), (char)$2->number, $3, @$); }
  | relation relates expr             { $$ = APPEND($1, (char)$2->number, $3, @$); }
  ;
relates
  : '='                               { $$ = $1; $$->number = '='; }
  | GE                                { $$ = $1; $$->number = 'g'; }
  | LE                                { $$ = $1; $$->number = 'l'; }
  | '>'                               { $$ = $1; $$->number = '>'; }
  | '<'                               { $$ = $1; $$->number = '<'; }
  | NE                                { $$ = $1; $$->number = '!'; }
  ;
element : expr
  | relation
  | expr IN range                     { $$ = NODE(IN, @$, 2, $1, $3); }
  ;
elements : element                    { $$ = NODE(GROUP, @$, 1, $1); }
  | elements ',' element              { $$ = APPEND($1, ',', $3, @$); }
  ;
group : '(' elements ')'              { $$ = $2; $$->begin = @$.begin; $$->end = @$.end; $$->tight = $1->tight; }
  ;
expr
  : term                              { $$ = $1; }
  | '-' term                          { $$ = APPEND(pl_ast_make(p, PL_AST_SUM, @$), '-', $2, @$); }
  | '+' term                          { $$ = $2; }
  | expr '+' term                     { $$ = APPEND($1->kind == PL_AST_SUM ? $1 : APPEND(pl_ast_make(p, PL_AST_SUM, @$), '+', $1, @1), '+', $3, @$); }
  | expr '-' term                     { $$ = APPEND($1->kind == PL_AST_SUM ? $1 : APPEND(pl_ast_make(p, PL_AST_SUM, @$), '+', $1, @1), '-', $3, @$); }
  ;
term
  : factor                            { $$ = APPEND(pl_ast_make(p, PL_AST_PRODUCT, @$), 0, $1, @$); }
  | term factor                       { $$ = APPEND($1, ' ', $2, @$); }
  | term '*' signed                   { $$ = APPEND($1, '*', $3, @$); }
  | term '/' signed                   { $$ = APPEND($1, '/', $3, @$); }
  ;
signed : factor
  | '-' signed                        { $$ = NODE(NEG, @$, 1, $2); }
  ;
factor : power
  | factor UNIT                       { $$ = NODE(UNIT, @$, 1, $1); $$->text = $2->text; $$->tight = $1->tight; }
  | factor DEGREE                     { $$ = NODE(DEGREE, @$, 1, $1); $$->tight = $1->tight; }
  ;
power : postfix
  | postfix '^' exponent              { $$ = NODE(POWER, @$, 2, $1, $3); $$->tight = $1->tight; }
  ;
exponent : postfix
  | postfix '^' exponent              { $$ = NODE(POWER, @$, 2, $1, $3); }
  | '-' exponent                      { $$ = NODE(NEG, @$, 1, $2); }
  | '+' exponent                      { $$ = $2; }
  ;
postfix : primary
  | postfix PRIMES                    { $$ = NODE(PRIME, @$, 1, $1); $$->number = $2->number; $$->tight = $1->tight; }
  | postfix SUPER                     { $$ = NODE(POWER, @$, 2, $1, $2); $$->tight = $1->tight; }
  ;
primary : NUMBER | NAME | PI | INFINITY
  | indexed                           { $$ = $1; }
  | group
  ;
%%

// ---------------------------------------------------------------------------------------------- errors
static void pl_yyerror(pl_bytes* at, pl_parse* p, const char* message) {
  // only "memory exhausted" comes this way: the stack of the parser is at its limit
  (void)at;
  (void)message;
  const pl_token* t = &p->tokens->list.at[p->at];
  if (!p->said) {
    pl_complain(p->job, PL_E006, (pl_span){p->source, t->begin, t->end}, PL_BOTH("this is nested too deeply"));
  }
  p->said = true;
}

static int yyreport_syntax_error(const yypcontext_t* context, pl_parse* p) {
  enum { MOST = 200 };
  yysymbol_kind_t expected[MOST];
  int tokens[MOST];
  int n = yypcontext_expected_tokens(context, expected, MOST);
  if (n < 0) n = 0;
  int n_tokens = 0;
  for (int i = 0; i < n; i++) {
    for (int t = 0; t <= 600; t++) {
      if (YYTRANSLATE(t) != expected[i] || expected[i] == YYSYMBOL_YYUNDEF) continue;
      tokens[n_tokens++] = t;
      break;
    }
  }
  if (p->place) {
    for (int i = 0; i < n_tokens; i++) pl_push(p->arena, p->place->expected, tokens[i]);
    if (p->kinds[p->at] == TOK_CURSOR) return 0;
    p->place->expected.n = 0;
  }
  pl_parse_complain(p, tokens, n_tokens);
  return 0;
}
