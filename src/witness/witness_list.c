// What the sections of a solution state of the motion. The left sides are read from the requests as
// they were written, not from what the derivation made of them.
#include <string.h>

#include "witness/witness_impl.h"

void pl_statement_add(pl_witness* w, pl_statement s) {
  if (pl_is_poison(s.shown)) return;
  s.stage = w->solution->sections.at[s.section].stage;
  pl_push(w->arena, w->statements, s);
}

// The symbol that a value is named after, when it is one of the motion. Results hide behind names
// of given quantities.
pl_expr pl_statement_subject(const pl_witness* w, const pl_value* v) {
  if (!pl_is_poison(v->lhs)) return v->lhs;
  pl_symbol s = pl_symbol_find(w->pool, v->name);
  if (!s.id) return pl_poison();
  pl_role role = pl_symbol_get(w->pool, s)->role;
  bool moves = role == PL_R_COORD || role == PL_R_VELOCITY || role == PL_R_ACCELERATION
               || role == PL_R_MULTIPLIER;
  return moves ? pl_sym(w->pool, s) : pl_poison();
}

const pl_motion* pl_statement_motion(const pl_ask* ask) {
  return ask && ask->motion.given ? &ask->motion : NULL;
}

// ------------------------------------------------------------------------------ by kind of request
static void state_subjects(pl_witness* w, int section, const pl_ask* ask) {
  const pl_section* s = &w->solution->sections.at[section];
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    pl_expr left = pl_statement_subject(w, v);
    bool shows_itself = pl_same(left, v->expr);
    if (pl_is_poison(left) || shows_itself) continue;
    pl_statement_add(w, (pl_statement){.kind = PL_EQUALS,
                                       .section = section,
                                       .value = v,
                                       .shown = v->expr,
                                       .left = left,
                                       .name = v->name,
                                       .from = pl_statement_motion(ask)});
  }
}

static void state_motion(pl_witness* w, int section) {
  const pl_section* s = &w->solution->sections.at[section];
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    pl_expr left = pl_statement_subject(w, v);
    // with free names it is one motion of many
    if (pl_is_poison(left) || v->n_free > 0) continue;
    pl_statement_add(w, (pl_statement){.kind = PL_FOLLOWS,
                                       .section = section,
                                       .value = v,
                                       .shown = v->expr,
                                       .left = left,
                                       .name = v->name});
  }
}

static void state_conserved(pl_witness* w, int section) {
  const pl_section* s = &w->solution->sections.at[section];
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    if (v->conserved != 1) continue;
    pl_statement_add(w, (pl_statement){.kind = PL_STAYS,
                                       .section = section,
                                       .value = v,
                                       .shown = v->expr,
                                       .left = pl_poison(),
                                       .name = v->name});
  }
}

// Equations of motion: what is left minus what is right vanishes.
static void state_equations(pl_witness* w, int section) {
  const pl_section* s = &w->solution->sections.at[section];
  for (int i = 0; i < s->steps.n; i++) {
    const pl_step* step = &s->steps.at[i];
    const pl_form* f = step->formula;
    if (step->kind != PL_STEP_EQUATION || step->number == 0 || step->detail || !f
        || f->kind != PL_F_RELATION)
      continue;
    if (strcmp(f->text, "=") != 0) continue;
    pl_expr left = pl_form_value(w->pool, f->args[0]), right = pl_form_value(w->pool, f->args[1]);
    if (pl_is_poison(left) || pl_is_poison(right)) continue;
    const pl_value* v = s->values.n > 0 ? &s->values.at[0] : NULL;
    pl_statement_add(w, (pl_statement){.kind = PL_VANISHES,
                                       .section = section,
                                       .value = v,
                                       .shown = pl_sub(w->pool, left, right),
                                       .left = pl_poison(),
                                       .name = pl_format(w->arena, "(%d)", step->number)});
  }
}

static void state_value(pl_witness* w, int section, const pl_ask* ask) {
  const pl_section* s = &w->solution->sections.at[section];
  for (int i = 0; i < s->values.n; i++) {
    const pl_value* v = &s->values.at[i];
    // else it stands on the way there
    bool is_asked = strcmp(v->name, pl_expr_text(w->arena, w->pool, ask->value)) == 0;
    pl_expr left = is_asked ? ask->value : pl_statement_subject(w, v);
    if (pl_is_poison(left) || pl_same(left, v->expr)) continue;
    pl_statement_add(w, (pl_statement){.kind = PL_EQUALS,
                                       .section = section,
                                       .value = v,
                                       .shown = v->expr,
                                       .left = left,
                                       .name = v->name,
                                       .from = pl_statement_motion(ask)});
  }
}

// An answer of somebody's own that was found right.
static void state_expected(pl_witness* w, int section, const pl_ask* ask) {
  const pl_section* s = &w->solution->sections.at[section];
  bool plain = ask->where.n == 1 && ask->where.at[0].relation == PL_EQ;
  for (int i = 0; plain && i < s->values.n; i++) {
    if (s->values.at[i].passed != 1) continue;
    pl_statement_add(w, (pl_statement){.kind = PL_EQUALS,
                                       .section = section,
                                       .value = &s->values.at[i],
                                       .shown = ask->where.at[0].right,
                                       .left = ask->where.at[0].left,
                                       .name = "expect",
                                       .from = pl_statement_motion(ask)});
  }
}

static void state_section(pl_witness* w, int section) {
  const pl_ask* ask = w->solution->sections.at[section].ask;
  if (!ask) return;
  switch (ask->kind) {
    case PL_ASK_LAGRANGE1:
    case PL_ASK_NEWTON:
    case PL_ASK_LAGRANGE2:
      state_equations(w, section);
      state_subjects(w, section, ask);
      break;
    case PL_ASK_SOLVE:
      if (ask->of_time) state_motion(w, section);
      else state_subjects(w, section, ask);
      break;
    case PL_ASK_VALUE:
      if (ask->where.n == 0) state_value(w, section, ask);
      break;
    case PL_ASK_FORCE_OF:
    case PL_ASK_FORCE_ON:
      state_subjects(w, section, ask);
      pl_statements_of_forces(w, section);
      break;
    case PL_ASK_LAGRANGIAN:
    case PL_ASK_HAMILTONIAN: state_subjects(w, section, ask); break;
    case PL_ASK_EXPECT: state_expected(w, section, ask); break;
    case PL_ASK_CONSERVED: state_conserved(w, section); break;
    default: break;
  }
}

// Several values of one quantity in one section are its assemblies: one of them is that of the
// motion.
static void group_assemblies(pl_witness* w) {
  int groups = 0;
  for (int i = 0; i < w->statements.n; i++) {
    pl_statement* s = &w->statements.at[i];
    s->group = ++groups;
    for (int k = 0; k < i && s->kind != PL_VANISHES; k++) {
      const pl_statement* other = &w->statements.at[k];
      bool same = other->section == s->section && other->kind == s->kind
                  && pl_same(other->left, s->left);
      if (same && strcmp(other->name, s->name) == 0) s->group = other->group;
    }
  }
}

void pl_statements_collect(pl_witness* w) {
  for (int i = 0; i < w->solution->sections.n; i++) state_section(w, i);
  group_assemblies(w);
}
