/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/pattern.h"

#include <stdlib.h>

static int by_value(const void *a, const void *b) {
  uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

static uint64_t edge_key(const uint32_t *tet, int edge) {
  uint32_t i = tet[cb_tet_edge[edge][0]], j = tet[cb_tet_edge[edge][1]];
  return i < j ? (uint64_t)i << 32 | j : (uint64_t)j << 32 | i;
}

/* keys := the distinct edges, ascending; returns their number. */
static size_t unique_edges(const struct cb_mesh *mesh, uint64_t *keys) {
  size_t n = 0, count = 0;
  for (size_t t = 0; t < mesh->tets; t++)
    for (int e = 0; e < 6; e++) keys[n++] = edge_key(mesh->tet + 4 * t, e);
  qsort(keys, n, sizeof *keys, by_value);
  for (size_t i = 0; i < n; i++)
    if (i == 0 || keys[i] != keys[i - 1]) keys[count++] = keys[i];
  return count;
}

/* Edges come in ascending (low, high): filling the lower halves of all rows
 * first and the upper halves after the diagonal keeps columns ascending. */
static void fill_rows(struct cb_pattern *p) {
  uint32_t *next = p->row_start + 1; /* next[i] ends as the start of row i+1 */
  for (size_t i = 0; i <= p->nodes; i++) p->row_start[i] = 0;
  for (size_t e = 0; e < p->edges; e++) next[p->low[e]]++, next[p->high[e]]++;
  for (size_t i = 0, start = 0; i < p->nodes; i++) {
    size_t count = next[i] + 1;
    next[i] = (uint32_t)start;
    start += count;
  }
  for (size_t e = 0; e < p->edges; e++) {
    p->lower[e] = next[p->high[e]]++;
    p->column[p->lower[e]] = p->low[e];
  }
  for (size_t i = 0; i < p->nodes; i++) {
    p->diagonal[i] = next[i]++;
    p->column[p->diagonal[i]] = (uint32_t)i;
  }
  for (size_t e = 0; e < p->edges; e++) {
    p->upper[e] = next[p->low[e]]++;
    p->column[p->upper[e]] = p->high[e];
  }
}

static void map_elements(const struct cb_packs *packs, const uint64_t *keys, struct cb_pattern *p) {
  const size_t lanes = packs->lanes;
  for (size_t n = 0; n < packs->packs * lanes; n++) {
    uint32_t tet[4];
    for (size_t j = 0; j < 4; j++) tet[j] = packs->node[(n / lanes * 4 + j) * lanes + n % lanes];
    for (int e = 0; e < 6; e++) {
      uint64_t key = edge_key(tet, e);
      const uint64_t *found = bsearch(&key, keys, p->edges, sizeof *keys, by_value);
      int turned = tet[cb_tet_edge[e][0]] > tet[cb_tet_edge[e][1]];
      p->edge_of[(n / lanes * 6 + e) * lanes + n % lanes] =
          2 * (uint32_t)(found - keys) + (uint32_t)turned;
    }
  }
}

enum cb_status cb_pattern_create(const struct cb_mesh *mesh, const struct cb_packs *packs,
                                 struct cb_pattern **out) {
  enum cb_status status = CB_MEMORY;
  struct cb_pattern *p = calloc(1, sizeof *p);
  uint64_t *keys = malloc(6 * mesh->tets * sizeof *keys + 1);
  if (!p || !keys) goto done;
  p->nodes = mesh->nodes;
  p->edges = unique_edges(mesh, keys);
  p->blocks = p->nodes + 2 * p->edges;
  if (p->blocks > UINT32_MAX / 9) {
    status = CB_INPUT;
    goto done;
  }
  size_t mapped = packs->packs * packs->lanes * 6;
  size_t counts[] = {p->nodes + 1, p->blocks, p->nodes, p->edges,
                     p->edges,     p->edges,  p->edges, mapped};
  uint32_t **arrays[] = {&p->row_start, &p->column, &p->diagonal, &p->upper,
                         &p->lower,     &p->low,    &p->high,     &p->edge_of};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    *arrays[i] = malloc(counts[i] * sizeof **arrays[i] + 1);
    if (!*arrays[i]) goto done;
    p->bytes += counts[i] * sizeof **arrays[i];
  }
  for (size_t e = 0; e < p->edges; e++)
    p->low[e] = (uint32_t)(keys[e] >> 32), p->high[e] = (uint32_t)keys[e];
  fill_rows(p);
  map_elements(packs, keys, p);
  *out = p;
  p = NULL;
  status = CB_OK;
done:
  free(keys);
  cb_pattern_free(p);
  return status;
}

void cb_pattern_free(struct cb_pattern *p) {
  if (!p) return;
  free(p->row_start);
  free(p->column);
  free(p->diagonal);
  free(p->upper);
  free(p->lower);
  free(p->low);
  free(p->high);
  free(p->edge_of);
  free(p);
}
