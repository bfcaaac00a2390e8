// Parts of a graph and orders of elimination.
//
// A graph is cut in two by a level of its breadth-first search from an end [George1973]: nodes
// before the level touch those behind it only through the level. Chains are cut at one node,
// ladders at a rung. Within a part the search from an end, read backwards, is the order of
// elimination: on trees it fills nothing in, on bands it keeps the band [CuthillMcKee1969].
#include "linalg/symmetric_impl.h"

#if __has_include(<suitesparse/amd.h>)
#  include <suitesparse/amd.h>
#else
#  include <amd.h>
#endif

typedef struct pl_cutter {
  const pl_graph* g;
  int* set;   // of each node: number of the set that it is in, -1 separator
  int* seen;  // search in which it was met
  int search;
  int *queue, *level;  // of the search at work: nodes, level of each
  bool* begins;        // of each level: a component begins
} pl_cutter;

// Searches from a node within its set; nodes go to queue[from ..] with levels from `level` on.
// Returns the end of the queue.
static int search_from(pl_cutter* c, int node, int from, int level) {
  int set = c->set[node], end = from;
  c->seen[node] = c->search;
  c->level[end] = level;
  c->queue[end++] = node;
  for (int i = from; i < end; i++)
    for (int e = c->g->start[c->queue[i]]; e < c->g->start[c->queue[i] + 1]; e++) {
      int next = c->g->to[e];
      if (c->set[next] != set || c->seen[next] == c->search) continue;
      c->seen[next] = c->search;
      c->level[end] = c->level[i] + 1;
      c->queue[end++] = next;
    }
  return end;
}

// The nodes of a set, searched from an end of each of its components.
static void search_all(pl_cutter* c, const int* nodes, int n) {
  int done = 0, level = 0, whole = ++c->search;
  for (int i = 0; i < n; i++) {
    if (c->seen[nodes[i]] >= whole) continue;
    int from = nodes[i], end;
    for (int round = 0; round < 2; round++) {
      c->search++;
      end = search_from(c, from, done, level);
      from = c->queue[end - 1];
    }
    c->search++;
    done = search_from(c, from, done, level);
    c->begins[level] = true;
    for (int l = level + 1; l <= c->level[done - 1]; l++) c->begins[l] = false;
    level = c->level[done - 1] + 1;
  }
}

// Where the searched nodes are cut best: those at [*from, *to) separate; none where a component
// begins.
static void best_cut(const pl_cutter* c, int n, int* from, int* to) {
  int best = -1;
  for (int i = 0; i < n;) {
    int end = i;
    while (end < n && c->level[end] == c->level[i]) end++;
    bool begins = c->begins[c->level[i]];
    int left = i, right = begins ? n - i : n - end, size = begins ? 0 : end - i;
    int price = (left > right ? left : right) + 4 * size;
    if (best < 0 || price < best) {
      best = price;
      *from = i;
      *to = begins ? i : end;
    }
    i = end;
  }
}

int pl_graph_cut(pl_arena* a, const pl_graph* g, int parts, int* part, int* separator, int* order,
                 int* first) {
  int n = g->n, n_separator = 0;
  pl_cutter c = {g,
                 part,
                 PL_ARRAY(a, int, n + 1),
                 0,
                 PL_ARRAY(a, int, n + 1),
                 PL_ARRAY(a, int, n + 1),
                 PL_ARRAY(a, bool, n + 1)};
  int *at = PL_ARRAY(a, int, parts + 1), *after = PL_ARRAY(a, int, parts + 1),
      *cut = PL_ARRAY(a, int, n + 1);
  for (int i = 0; i < n; i++) {
    order[i] = i;
    part[i] = 0;
  }
  at[1] = n;
  int n_cut = 0, *level_begin = PL_ARRAY(a, int, 34), n_levels = 0;
  for (int sets = 1; sets < parts; sets *= 2) {
    int filled = 0;
    level_begin[n_levels++] = n_cut;
    for (int s = 0; s < sets; s++) {
      int size = at[s + 1] - at[s], from = 0, to = 0;
      int* nodes = order + at[s];
      search_all(&c, nodes, size);
      if (size > 0) best_cut(&c, size, &from, &to);
      for (int i = from; i < to; i++) cut[n_cut++] = c.queue[i];
      after[2 * s] = filled;
      // the nodes move to the front, where those of earlier sets have left room
      for (int i = 0; i < from; i++) order[filled++] = c.queue[i];
      after[2 * s + 1] = filled;
      for (int i = to; i < size; i++) order[filled++] = c.queue[i];
    }
    after[2 * sets] = filled;
    for (int s = 0; s <= 2 * sets; s++) at[s] = after[s];
    for (int i = 0; i < n; i++) part[i] = -1;
    for (int s = 0; s < 2 * sets; s++)
      for (int i = at[s]; i < at[s + 1]; i++) part[order[i]] = s;
  }
  level_begin[n_levels] = n_cut;
  for (int l = n_levels - 1; l >= 0; l--)
    for (int i = level_begin[l]; i < level_begin[l + 1]; i++) separator[n_separator++] = cut[i];
  for (int s = 0; s < parts; s++) {
    int size = at[s + 1] - at[s];
    search_all(&c, order + at[s], size);
    for (int i = 0; i < size; i++) order[at[s] + i] = c.queue[size - 1 - i];
  }
  for (int s = 0; s <= parts; s++) first[s] = at[s];
  return n_separator;
}

bool pl_graph_least_degree(const pl_graph* g, int* order) {
  if (g->n == 0) return true;
  int how = amd_order(g->n, g->start, g->to, order, NULL, NULL);
  return how == AMD_OK || how == AMD_OK_BUT_JUMBLED;
}
