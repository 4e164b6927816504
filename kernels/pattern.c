/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/pattern.h"

#include <stdlib.h>
#include <string.h>

#include "kernels/memory.h"

/* One element at one edge: the high node, then 16 times the element's number plus 4
 * times the vertex of the low node plus that of the high one. */
typedef uint64_t share;

static share share_of(uint32_t node, size_t element, unsigned low, unsigned high) {
  return (uint64_t)node << 32 | (16 * element + 4 * low + high);
}

static uint32_t low_vertex(share s) { return (uint32_t)s / 4; }

static uint32_t high_vertex(share s) { return (uint32_t)s / 16 * 4 + (uint32_t)s % 4; }

static int by_value(const void *a, const void *b) {
  uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

/* Shares of all elements by low node: those of node i are start[i] to start[i+1] - 1.
 * Counts them (shares NULL), or puts each to where start[i + 1] says, and moves that. */
static void list_shares(const struct cb_packs *packs, share *shares, uint32_t *start) {
  const size_t lanes = packs->lanes;
  for (size_t t = 0; t < packs->threads; t++)
    for (size_t p = packs->chunk[t].part[0]; p < packs->chunk[t].part[3]; p++) {
      const bool last = p + 1 == packs->chunk[t].part[3];
      for (size_t l = 0; l < (last ? packs->chunk[t].last_live : lanes); l++)
        for (int e = 0; e < 6; e++) {
          unsigned low = cb_tet_edge[e][0], high = cb_tet_edge[e][1];
          const uint32_t *tet = packs->node + 4 * p * lanes + l;
          if (tet[low * lanes] > tet[high * lanes])
            low = cb_tet_edge[e][1], high = cb_tet_edge[e][0];
          const size_t i = tet[low * lanes];
          if (shares)
            shares[start[i + 1]++] = share_of(tet[high * lanes], p * lanes + l, low, high);
          else
            start[i + 1]++;
        }
    }
}

/* counts[i + 1] becomes the sum of the counts before i. */
static void sum_before(size_t n, uint32_t *counts) {
  uint32_t sum = 0;
  for (size_t i = 1; i <= n; i++) {
    const uint32_t count = counts[i];
    counts[i] = sum;
    sum += count;
  }
}

/* *out := shares by low node, then high node; start[nodes+1]. */
static enum cb_status sort_shares(size_t nodes, const struct cb_packs *packs, size_t terms,
                                  uint32_t *start, share **out) {
  share *shares = malloc(terms * sizeof *shares + 1);
  if (!shares) return CB_MEMORY;
  memset(start, 0, (nodes + 1) * sizeof *start);
  list_shares(packs, NULL, start);
  sum_before(nodes, start);
  list_shares(packs, shares, start);
  for (size_t i = 0; i < nodes; i++)
    qsort(shares + start[i], start[i + 1] - start[i], sizeof *shares, by_value);
  *out = shares;
  return CB_OK;
}

static bool new_edge(const share *shares, size_t first, size_t n) {
  return n == first || shares[n] >> 32 != shares[n - 1] >> 32;
}

static size_t count_edges(size_t nodes, const share *shares, const uint32_t *start) {
  size_t edges = 0;
  for (size_t i = 0; i < nodes; i++)
    for (size_t n = start[i]; n < start[i + 1]; n++) edges += new_edge(shares, start[i], n);
  return edges;
}

/* Edges, their terms, and high[edges]: their high nodes. */
static void fill_edges(struct cb_pattern *p, const share *shares, const uint32_t *start,
                       size_t stride, uint32_t *high) {
  uint32_t edge = 0;
  for (size_t i = 0; i < p->nodes; i++) {
    p->edge_start[i] = edge;
    for (uint32_t n = start[i]; n < start[i + 1]; n++) {
      if (new_edge(shares, start[i], n)) {
        high[edge] = (uint32_t)(shares[n] >> 32);
        p->term_start[edge++] = n;
      }
      p->term[2 * (size_t)n] = (uint32_t)stride * low_vertex(shares[n]);
      p->term[2 * (size_t)n + 1] = (uint32_t)stride * high_vertex(shares[n]);
    }
  }
  p->edge_start[p->nodes] = edge;
  p->term_start[edge] = start[p->nodes];
}

/* Edges come in ascending (low, high), so that columns do as well. */
static void fill_rows(struct cb_pattern *p, const uint32_t *high) {
  memset(p->lower_start, 0, (p->nodes + 1) * sizeof *p->lower_start);
  for (size_t e = 0; e < p->edges; e++) p->lower_start[high[e] + 1]++;
  for (size_t i = 0; i < p->nodes; i++) p->lower_start[i + 1] += p->lower_start[i];
  for (size_t i = 0; i <= p->nodes; i++)
    p->row_start[i] = (uint32_t)i + p->edge_start[i] + (p->symmetric ? 0 : p->lower_start[i]);
  for (size_t i = 0; i < p->nodes; i++) {
    uint32_t block = cb_pattern_diagonal(p, i);
    p->column[block++] = (uint32_t)i;
    for (uint32_t e = p->edge_start[i]; e < p->edge_start[i + 1]; e++, block++) {
      const uint32_t row = high[e], n = p->lower_start[row]++;
      p->column[block] = row;
      p->mirror[n] = block;
      if (!p->symmetric) p->column[row + p->edge_start[row] + n] = (uint32_t)i;
    }
  }
  memmove(p->lower_start + 1, p->lower_start, p->nodes * sizeof *p->lower_start);
  p->lower_start[0] = 0;
}

static void share_rows(struct cb_pattern *p) {
  size_t row = 0;
  for (size_t t = 0; t < p->threads; t++) {
    struct cb_rows *r = &p->rows[t];
    *r = (struct cb_rows){.first = row, .beyond = p->beyond};
    while (row < p->nodes && p->row_start[row] < p->blocks * (t + 1) / p->threads) row++;
    r->last = r->reach = row;
    for (size_t b = p->row_start[r->first]; b < p->row_start[r->last]; b++)
      if (p->column[b] >= r->reach) r->reach = (size_t)p->column[b] + 1;
    p->beyond += r->reach - r->last;
  }
}

static enum cb_status allocate(struct cb_pattern *p, size_t terms) {
  const size_t counts[] = {p->nodes + 1, p->blocks,    p->nodes + 1, p->nodes + 1,
                           p->edges,     p->edges + 1, 2 * terms};
  uint32_t **arrays[] = {&p->row_start, &p->column,     &p->edge_start, &p->lower_start,
                         &p->mirror,    &p->term_start, &p->term};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    const size_t count = counts[i] + CB_PATTERN_AHEAD;
    *arrays[i] = cb_memory(count, sizeof **arrays[i]);
    if (!*arrays[i]) return CB_MEMORY;
    p->bytes += count * sizeof **arrays[i];
  }
  p->rows = malloc(p->threads * sizeof *p->rows);
  p->bytes += p->threads * sizeof *p->rows;
  return p->rows ? CB_OK : CB_MEMORY;
}

enum cb_status cb_pattern_create(const struct cb_mesh *mesh, const struct cb_packs *packs,
                                 size_t stride, bool symmetric, struct cb_pattern **out) {
  const size_t terms = 6 * mesh->tets;
  if (16 * packs->packs * packs->lanes > UINT32_MAX) return CB_INPUT;
  share *shares = NULL;
  uint32_t *start = malloc((mesh->nodes + 1) * sizeof *start), *high = NULL;
  struct cb_pattern *p = calloc(1, sizeof *p);
  enum cb_status status = CB_MEMORY;
  if (!p || !start) goto done;
  status = sort_shares(mesh->nodes, packs, terms, start, &shares);
  if (status) goto done;
  p->nodes = mesh->nodes, p->symmetric = symmetric, p->threads = packs->threads;
  p->edges = count_edges(p->nodes, shares, start);
  p->blocks = p->nodes + (symmetric ? 1 : 2) * p->edges;
  high = malloc(p->edges * sizeof *high + 1);
  status = p->blocks > UINT32_MAX / 9 ? CB_INPUT : !high ? CB_MEMORY : allocate(p, terms);
  if (status) goto done;
  fill_edges(p, shares, start, stride, high);
  fill_rows(p, high);
  share_rows(p);
  *out = p;
  p = NULL;
done:
  free(shares);
  free(start);
  free(high);
  cb_pattern_free(p);
  return status;
}

void cb_pattern_free(struct cb_pattern *p) {
  if (!p) return;
  free(p->row_start);
  free(p->column);
  free(p->edge_start);
  free(p->lower_start);
  free(p->mirror);
  free(p->term_start);
  free(p->term);
  free(p->rows);
  free(p);
}
