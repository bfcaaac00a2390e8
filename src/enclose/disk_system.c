// Accelerations and multipliers at all points of disks of t, q, v.
//
// The matrix A = [M -(G^T + W); G 0] and the right side b = (-h; -(dG/dt v + d²g/dt²)) are disks,
// the derivative along the motion taken with q' = v, t' = 1. With C near the inverse of A's centre
// and x near the solution there, e = A^-1 b - x satisfies (I - F) e = C (b - A x), F = I - C A. Let
// Φ >= |F| and u >= |C (b - A x)| entry by entry. If some d > 0 has u + Φ d <= d with u > 0, then Φ
// d < d, so the spectral radius of Φ is below 1, A is regular at every point, and |e| <= (I - Φ)^-1
// u <= d [Rump2010, sec. 10].
// See theory (18.4).
#include "enclose/enclose_impl.h"

// ---------------------------------------------------------------------------------------- programs
static const pl_disk* at(const pl_disk* d, int node) { return node < 0 ? NULL : d + node; }

static bool run_node(pl_ball_jet* j, int i) {
  const pl_tape_node* n = &j->tape->nodes[i];
  return pl_disk_op(&j->disk[i], n->op, at(j->disk, n->a), at(j->disk, n->b), at(j->disk, n->c));
}

static bool run_level(pl_ball_jet* j, pl_tape_level level) {
  for (int i = j->tape->level_end[level - 1]; i < j->tape->level_end[level]; i++)
    if ((j->wanted[i] & PL_FOR_MOTION) && j->tape->nodes[i].op >= PL_OP_ADD && !run_node(j, i))
      return false;
  return true;
}

// Derivatives along the motion; partners are there, since all values are.
static void run_slopes(pl_ball_jet* j) {
  for (int i = j->tape->level_end[PL_LEVEL_CONST]; i < j->tape->level_end[PL_LEVEL_POSITION]; i++) {
    const pl_tape_node* n = &j->tape->nodes[i];
    if (!(j->wanted[i] & PL_FOR_MOTION) || n->op < PL_OP_ADD) continue;
    pl_disk_derivative(&j->slope[i], n->op, &j->disk[i], at(j->disk, n->a), at(j->disk, n->b),
                       at(j->disk, n->c), at(j->slope, n->a), at(j->slope, n->b),
                       at(j->slope, n->c));
  }
}

static void copy(pl_disk* to, const pl_disk* from) {
  arb_set(&to->c, &from->c);
  mag_set(&to->r, &from->r);
}

static void load(const pl_system* s, pl_ball_jet* j, const pl_disk* t) {
  const pl_tape* tape = j->tape;
  for (int i = 0; i < tape->n_q; i++) {
    if (tape->v_node[i] >= 0) copy(&j->disk[tape->v_node[i]], &s->v_disk[j->q[i]]);
    if (tape->q_node[i] < 0) continue;
    copy(&j->disk[tape->q_node[i]], &s->q_disk[j->q[i]]);
    copy(&j->slope[tape->q_node[i]], &s->v_disk[j->q[i]]);
  }
  for (int i = tape->level_end[PL_LEVEL_CONST]; i < tape->level_end[PL_LEVEL_POSITION]; i++) {
    if (tape->nodes[i].op != PL_OP_TIME) continue;
    copy(&j->disk[i], t);
    arb_one(&j->slope[i].c);
    mag_zero(&j->slope[i].r);
  }
}

static bool run_programs(pl_system* s, const pl_disk* t) {
  for (int i = 0; i < s->n_jets; i++) {
    pl_ball_jet* j = &s->jet[i];
    load(s, j, t);
    if (!run_level(j, PL_LEVEL_POSITION) || !run_level(j, PL_LEVEL_VELOCITY)) return false;
    run_slopes(j);
  }
  return true;
}

// ---------------------------------------------------------------------------------------- assembly
static const pl_disk* root_of(const pl_ball_jet* j, const pl_disk* d, int root) {
  return d + j->tape->roots[root];
}

static pl_disk* entry(pl_system* s, int row, int col) {
  return s->matrix + (slong)row * (s->n_q + s->n_rows) + col;
}

static void assemble_matrix(pl_system* s, const pl_ball_jet* j) {
  const pl_pattern* p = j->pattern;
  for (int e = 0; e < p->n_mass; e++) {
    int r = j->q[p->mass[e].row], c = j->q[p->mass[e].col];
    const pl_disk* x = root_of(j, j->disk, p->mass[e].root);
    pl_disk_add(entry(s, r, c), entry(s, r, c), x);
    if (p->mass[e].row != p->mass[e].col) pl_disk_add(entry(s, c, r), entry(s, c, r), x);
  }
  for (int e = 0; e < p->n_G; e++) {
    int row = s->row_of[j->c[p->G[e].row]], col = j->q[p->G[e].col];
    if (row < 0) continue;
    const pl_disk* x = root_of(j, j->disk, p->G[e].root);
    pl_disk *G = entry(s, s->n_q + row, col), *GT = entry(s, col, s->n_q + row);
    pl_disk_add(G, G, x);
    pl_disk_sub(GT, GT, x);
  }
  for (int e = 0; e < p->n_W; e++) {
    int col = s->row_of[j->c[p->W[e].col]];
    if (col < 0) continue;
    pl_disk* W = entry(s, j->q[p->W[e].row], s->n_q + col);
    pl_disk_sub(W, W, root_of(j, j->disk, p->W[e].root));
  }
}

static void assemble_right(pl_system* s, const pl_ball_jet* j) {
  const pl_pattern* p = j->pattern;
  for (int e = 0; e < p->n_h; e++) {
    pl_disk* to = &s->right[j->q[p->h[e].row]];
    pl_disk_sub(to, to, root_of(j, j->disk, p->h[e].root));
  }
  for (int e = 0; e < p->n_G; e++) {
    int row = s->row_of[j->c[p->G[e].row]];
    if (row < 0) continue;
    pl_disk_mul(s->scratch, root_of(j, j->slope, p->G[e].root), &s->v_disk[j->q[p->G[e].col]]);
    pl_disk_sub(&s->right[s->n_q + row], &s->right[s->n_q + row], s->scratch);
  }
  for (int e = 0; e < p->n_gt; e++) {
    int row = s->row_of[j->c[p->gt[e].row]];
    if (row < 0) continue;
    pl_disk* to = &s->right[s->n_q + row];
    pl_disk_sub(to, to, root_of(j, j->slope, p->gt[e].root));
  }
}

static void assemble(pl_system* s) {
  int n = s->n_q + s->n_rows;
  for (slong i = 0; i < (slong)n * n; i++) {
    arb_zero(&s->matrix[i].c);
    mag_zero(&s->matrix[i].r);
  }
  for (int i = 0; i < n; i++) {
    arb_zero(&s->right[i].c);
    mag_zero(&s->right[i].r);
  }
  for (int i = 0; i < s->n_jets; i++) {
    assemble_matrix(s, &s->jet[i]);
    assemble_right(s, &s->jet[i]);
  }
}

// ---------------------------------------------------------------------------------------- solution
typedef struct solver {
  pl_system* s;
  int n;
  arb_mat_t C, F;   // near the inverse; I - C A at the centre
  arb_ptr x, rest;  // near the solution; b - A x at the centre
  mag_ptr phi;      // (n x n)
  mag_ptr u, d, next, size;
} solver;

static void begin(solver* z, pl_system* s) {
  *z = (solver){.s = s, .n = s->n_q + s->n_rows, .phi = s->slack, .u = s->spread};
  z->d = z->u + s->n;
  z->next = z->d + s->n;
  z->size = z->next + s->n;
  arb_mat_init(z->C, z->n, z->n);
  arb_mat_init(z->F, z->n, z->n);
  z->x = _arb_vec_init(z->n);
  z->rest = _arb_vec_init(z->n);
}

static void end(solver* z) {
  arb_mat_clear(z->C);
  arb_mat_clear(z->F);
  _arb_vec_clear(z->x, z->n);
  _arb_vec_clear(z->rest, z->n);
}

// C and x are numbers: any will do for the proof.
static void guess(solver* z) {
  pl_system* s = z->s;
  for (int i = 0; i < z->n; i++)
    for (int k = 0; k < z->n; k++) {
      arb_set_round(arb_mat_entry(z->C, i, k), arb_mat_entry(s->inverse, i, k), PL_DISK_BITS);
      mag_zero(arb_radref(arb_mat_entry(z->C, i, k)));
    }
  for (int i = 0; i < z->n; i++) {
    for (int k = 0; k < z->n; k++)
      arb_addmul(z->x + i, arb_mat_entry(z->C, i, k), &s->right[k].c, PL_DISK_BITS);
    mag_zero(arb_radref(z->x + i));
  }
}

// Φ >= |I - C A|
static void bound_matrix(solver* z) {
  pl_system* s = z->s;
  arb_mat_t A;
  mag_t c;
  arb_mat_init(A, z->n, z->n);
  mag_init(c);
  for (int i = 0; i < z->n; i++)
    for (int k = 0; k < z->n; k++) arb_set(arb_mat_entry(A, i, k), &entry(s, i, k)->c);
  arb_mat_mul(z->F, z->C, A, PL_DISK_BITS);
  for (int i = 0; i < z->n; i++) {
    arb_sub_si(arb_mat_entry(z->F, i, i), arb_mat_entry(z->F, i, i), 1, PL_DISK_BITS);
    for (int k = 0; k < z->n; k++) {
      mag_ptr phi = z->phi + (slong)i * z->n + k;
      arb_get_mag(phi, arb_mat_entry(z->F, i, k));
      for (int l = 0; l < z->n; l++) {
        arb_get_mag(c, arb_mat_entry(z->C, i, l));
        mag_addmul(phi, c, &entry(s, l, k)->r);
      }
    }
  }
  arb_mat_clear(A);
  mag_clear(c);
}

// u >= |C (b - A x)|, u > 0
static void bound_rest(solver* z) {
  pl_system* s = z->s;
  arb_t sum;
  mag_t m;
  arb_init(sum);
  mag_init(m);
  for (int i = 0; i < z->n; i++) {
    arb_set(z->rest + i, &s->right[i].c);
    mag_set(z->size + i, &s->right[i].r);
    for (int k = 0; k < z->n; k++) {
      arb_submul(z->rest + i, &entry(s, i, k)->c, z->x + k, PL_DISK_BITS);
      arb_get_mag(m, z->x + k);
      mag_addmul(z->size + i, m, &entry(s, i, k)->r);
    }
  }
  for (int i = 0; i < z->n; i++) {
    arb_zero(sum);
    mag_set_ui_2exp_si(z->u + i, 1, -400);
    for (int k = 0; k < z->n; k++) {
      arb_srcptr c = arb_mat_entry(z->C, i, k);
      arb_addmul(sum, c, z->rest + k, PL_DISK_BITS);
      arb_get_mag(m, c);
      mag_addmul(z->u + i, m, z->size + k);
    }
    arb_get_mag(m, sum);
    mag_add(z->u + i, z->u + i, m);
  }
  arb_clear(sum);
  mag_clear(m);
}

// next = u + Φ d; true when it does not exceed d.
static bool iterate(solver* z) {
  bool inside = true;
  for (int i = 0; i < z->n; i++) {
    mag_set(z->next + i, z->u + i);
    for (int k = 0; k < z->n; k++) mag_addmul(z->next + i, z->phi + (slong)i * z->n + k, z->d + k);
    inside = inside && mag_cmp(z->next + i, z->d + i) <= 0;
  }
  return inside;
}

enum { MOST_ROUNDS = 24 };

static bool enclose(solver* z) {
  mag_t wider;
  mag_init(wider);
  mag_set_d(wider, 1.05);
  bool found = false;
  for (int i = 0; i < z->n; i++) mag_set(z->d + i, z->u + i);
  for (int round = 0; round < MOST_ROUNDS && !found; round++) {
    found = iterate(z);
    for (int i = 0; i < z->n && !found; i++) {
      if (mag_is_inf(z->next + i)) round = MOST_ROUNDS;
      mag_mul(z->d + i, z->next + i, wider);
    }
  }
  mag_clear(wider);
  return found;
}

static void hand_over(const solver* z) {
  pl_system* s = z->s;
  for (int i = 0; i < z->n; i++) {
    pl_disk* to = i < s->n_q ? &s->a_disk[i] : &s->l_disk[s->constraint_of[i - s->n_q]];
    arb_set(&to->c, z->x + i);
    mag_set(&to->r, z->next + i);
  }
}

bool pl_system_disks(pl_system* s, const pl_disk* t) {
  if (!run_programs(s, t)) return false;
  assemble(s);
  solver z;
  begin(&z, s);
  guess(&z);
  bound_matrix(&z);
  bound_rest(&z);
  bool ok = enclose(&z);
  if (ok) hand_over(&z);
  end(&z);
  return ok;
}
