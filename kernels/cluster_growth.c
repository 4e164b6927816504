/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/cluster_growth.h"

#include <stdlib.h>

enum { NODES = CB_CLUSTER_NODES, TETS = CB_CLUSTER_TETS, CANDIDATES = 64 };

/* ---- free tetrahedra ----------------------------------------------------------- */

void cb_free_free(struct cb_free *f) {
  free(f->start);
  free(f->free);
  free(f->corner);
  free(f->at);
  *f = (struct cb_free){0};
}

enum cb_status cb_free_create(const struct cb_mesh *mesh, struct cb_free *f) {
  const size_t nodes = mesh->nodes, corners = 4 * mesh->tets;
  struct cb_free made = {.mesh = mesh,
                         .start = calloc(nodes + 1, sizeof *made.start),
                         .free = calloc(nodes + 1, sizeof *made.free),
                         .corner = calloc(corners + 1, sizeof *made.corner),
                         .at = calloc(corners + 1, sizeof *made.at)};
  if (!made.start || !made.free || !made.corner || !made.at) {
    cb_free_free(&made);
    return CB_MEMORY;
  }
  for (size_t c = 0; c < corners; c++) made.start[mesh->tet[c] + (size_t)1]++;
  for (size_t n = 0; n < nodes; n++) made.start[n + 1] += made.start[n];
  for (size_t e = 0; e < mesh->tets; e++) cb_free_return(&made, (uint32_t)e);
  *f = made;
  return CB_OK;
}

void cb_free_take(struct cb_free *f, uint32_t tet) {
  for (uint32_t c = 4 * tet; c < 4 * tet + 4; c++) {
    const uint32_t n = f->mesh->tet[c], last = f->corner[f->start[n] + --f->free[n]];
    f->at[last] = f->at[c];
    f->corner[f->at[c]] = last;
  }
}

void cb_free_return(struct cb_free *f, uint32_t tet) {
  for (uint32_t c = 4 * tet; c < 4 * tet + 4; c++) {
    const uint32_t n = f->mesh->tet[c];
    f->at[c] = f->start[n] + f->free[n]++;
    f->corner[f->at[c]] = c;
  }
}

/* ---- growth -------------------------------------------------------------------- */

enum cb_status cb_growth_create(const struct cb_free *f, struct cb_growth **out) {
  struct cb_growth *g = calloc(1, sizeof *g);
  if (!g) return CB_MEMORY;
  g->free = f;
  g->shared = calloc(f->mesh->tets + 1, sizeof *g->shared);
  if (!g->shared) {
    cb_growth_free(g);
    return CB_MEMORY;
  }
  *out = g;
  return CB_OK;
}

void cb_growth_free(struct cb_growth *g) {
  if (!g) return;
  free(g->shared);
  free(g);
}

static void share(struct cb_growth *g, uint32_t corner, size_t slot) {
  static const uint8_t bits[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
  const uint32_t tet = corner / 4;
  struct cb_shared *s = g->shared + tet;
  if (s->vertices >> corner % 4 & 1) return;
  s->nodes |= (uint8_t)(1u << slot);
  s->vertices |= (uint8_t)(1u << corner % 4);
  if (bits[s->vertices] == 3) g->near[g->nears++] = tet;
  if (bits[s->vertices] == 4 && g->c.tets < TETS) g->c.tet[g->c.tets++] = tet;
}

static void share_node(struct cb_growth *g, uint32_t tet, size_t slot) {
  for (uint32_t c = 4 * tet; c < 4 * tet + 4; c++)
    if (g->free->mesh->tet[c] == g->c.node[slot]) share(g, c, slot);
}

static void see(struct cb_growth *g, uint32_t tet) {
  g->seen[g->seens++] = tet;
  for (unsigned hubs = g->hubs; hubs; hubs &= hubs - 1)
    share_node(g, tet, (size_t)__builtin_ctz(hubs));
}

/* The cluster with that node and the free tetrahedra that it closes. */
static void add(struct cb_growth *g, uint32_t node) {
  const struct cb_free *f = g->free;
  const size_t slot = g->c.nodes++;
  g->c.node[slot] = node;
  const uint32_t around = f->free[node];
  if (around > CB_HUB) {
    for (size_t i = 0; i < g->seens; i++) share_node(g, g->seen[i], slot);
    g->hubs |= (uint8_t)(1u << slot);
  }
  for (uint32_t i = 0; i < around && i < CB_HUB; i++) {
    const uint32_t corner = f->corner[f->start[node] + i];
    if (!g->shared[corner / 4].nodes) see(g, corner / 4);
    share(g, corner, slot);
  }
  g->tets_of[g->c.nodes] = g->c.tets;
}

void cb_growth_start(struct cb_growth *g, uint32_t seed) {
  for (size_t i = 0; i < g->seens; i++) g->shared[g->seen[i]] = (struct cb_shared){0, 0};
  g->seens = g->nears = 0;
  g->hubs = g->c.nodes = g->c.tets = 0;
  see(g, seed); /* four hubs would not */
  for (size_t j = 0; j < 4; j++) add(g, g->free->mesh->tet[4 * (size_t)seed + j]);
}

struct candidate {
  uint32_t node;
  unsigned closes;
};

static size_t find_candidates(const struct cb_growth *g, struct candidate c[CANDIDATES]) {
  size_t n = 0;
  for (size_t i = 0; i < g->nears; i++) {
    const uint32_t tet = g->near[i];
    const unsigned missing = 15u & ~g->shared[tet].vertices;
    if (!missing) continue;
    const uint32_t node = g->free->mesh->tet[4 * (size_t)tet + (size_t)__builtin_ctz(missing)];
    size_t k = 0;
    while (k < n && c[k].node != node) k++;
    if (k == CANDIDATES) break;
    if (k == n) c[n++] = (struct candidate){node, 0};
    c[k].closes++;
  }
  return n;
}

void cb_growth_finish(struct cb_growth *g) {
  struct candidate c[CANDIDATES];
  while (g->c.nodes < NODES) {
    const struct candidate *best = NULL;
    const size_t n = find_candidates(g, c);
    for (const struct candidate *i = c; i < c + n; i++) {
      if (g->c.tets + i->closes > TETS) continue;
      if (!best || i->closes > best->closes ||
          (i->closes == best->closes && g->free->free[i->node] < g->free->free[best->node]))
        best = i;
    }
    if (!best) return;
    add(g, best->node);
  }
}
