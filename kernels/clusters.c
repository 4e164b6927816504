/* clusters.c - the finished clusters of cluster_search.c in the order of their shapes,
 * and each shape with one vertex order for all its clusters where there is one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/clusters.h"

#include <stdlib.h>
#include <string.h>

#include "kernels/cluster_search.h"

enum { NODES = CB_CLUSTER_NODES, TETS = CB_CLUSTER_TETS };
static const uint32_t NONE = UINT32_MAX;

const uint8_t cb_permutation[24][4] = {
    {0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1},
    {1, 0, 2, 3}, {1, 0, 3, 2}, {1, 2, 0, 3}, {1, 2, 3, 0}, {1, 3, 0, 2}, {1, 3, 2, 0},
    {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3}, {2, 1, 3, 0}, {2, 3, 0, 1}, {2, 3, 1, 0},
    {3, 0, 1, 2}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}};

/* ---- one cluster -------------------------------------------------------------- */

/* The cluster's tetrahedra in the sequence of the shape's, and their vertex orders. */
struct labels {
  uint32_t tet[TETS];
  uint8_t order[TETS];
};

static uint8_t local_node(const struct cb_cluster *c, uint32_t node) {
  uint8_t v = 0;
  while (c->node[v] != node) v++;
  return v;
}

static struct cb_masks masks_of(const struct cb_mesh *mesh, const struct cb_cluster *c) {
  struct cb_masks m = {{0}};
  for (size_t i = 0; i < c->tets; i++) {
    unsigned mask = 0;
    for (size_t j = 0; j < 4; j++)
      mask |= 1u << local_node(c, mesh->tet[4 * (size_t)c->tet[i] + j]);
    cb_masks_insert(&m, i, (uint8_t)mask);
  }
  return m;
}

/* Of the permutations the one that gives these four numbers from the ascending. */
static uint8_t order_of(const uint8_t number[4]) {
  uint8_t order = 0;
  static const uint8_t weight[4] = {6, 2, 1, 0};
  for (size_t j = 0; j < 4; j++)
    for (size_t k = j + 1; k < 4; k++) order += (uint8_t)(number[k] < number[j]) * weight[j];
  return order;
}

/* Where tetrahedra share all nodes, those come first that have the lower order. */
static void label(const struct cb_mesh *mesh, const struct cb_cluster *c,
                  const struct cb_numbering *numbering, struct labels *out) {
  uint16_t key[TETS];
  for (size_t i = 0; i < c->tets; i++) {
    const uint32_t *t = mesh->tet + 4 * (size_t)c->tet[i];
    uint8_t number[4];
    unsigned mask = 0;
    for (size_t j = 0; j < 4; j++) {
      number[j] = numbering->place[local_node(c, t[j])];
      mask |= 1u << number[j];
    }
    const uint16_t k = (uint16_t)(mask << 8 | order_of(number));
    size_t n = i;
    for (; n > 0 && (key[n - 1] > k || (key[n - 1] == k && out->tet[n - 1] > c->tet[i])); n--)
      key[n] = key[n - 1], out->tet[n] = out->tet[n - 1];
    key[n] = k, out->tet[n] = c->tet[i];
  }
  for (size_t i = 0; i < c->tets; i++) out->order[i] = (uint8_t)key[i];
}

/* Of the numberings that make it the shape that with the least orders: clusters that
 * also agree in the vertex orders get the same. */
static enum cb_status place_cluster(const struct cb_mesh *mesh, struct cb_search *s,
                                    const struct cb_cluster *c, size_t at,
                                    struct cb_clusters *out) {
  const struct cb_numbered *known;
  const struct cb_masks masks = masks_of(mesh, c);
  if (cb_shapes_find(&s->shapes, &masks, &known)) return CB_MEMORY;
  struct labels best = {{0}, {0}}, l = best;
  const struct cb_numbering *chosen = NULL;
  for (uint32_t i = 0; i < known->numberings; i++) {
    const struct cb_numbering *numbering = s->shapes.numbering + known->first + i;
    label(mesh, c, numbering, &l);
    if (chosen && memcmp(l.order, best.order, c->tets) >= 0) continue;
    chosen = numbering;
    best = l;
  }
  for (size_t v = 0; v < c->nodes; v++) out->node[NODES * at + chosen->place[v]] = c->node[v];
  for (size_t v = c->nodes; v < NODES; v++) out->node[NODES * at + v] = out->node[NODES * at];
  for (size_t i = 0; i < TETS; i++) {
    out->tet[TETS * at + i] = best.tet[i < c->tets ? i : 0];
    out->order[TETS * at + i] = best.order[i < c->tets ? i : 0];
  }
  return CB_OK;
}

/* ---- shapes -------------------------------------------------------------------- */

static struct cb_template template_of(const struct cb_masks *masks) {
  struct cb_template t = {0};
  unsigned all = 0;
  for (; t.tets < TETS && masks->of[t.tets]; t.tets++) {
    for (uint8_t v = 0, j = 0; v < NODES; v++)
      if (masks->of[t.tets] >> v & 1) t.vertex[t.tets][j++] = v;
    all |= masks->of[t.tets];
  }
  t.nodes = (uint8_t)__builtin_popcount(all);
  return t;
}

/* Where all clusters of shape t have the same order, that becomes the shape's. */
static void bake_order(struct cb_clusters *c, size_t t) {
  struct cb_template *shape = c->shape + t;
  for (size_t i = 0; i < shape->tets; i++) {
    const uint8_t order = c->order[TETS * (size_t)c->first[t] + i];
    bool same = true;
    for (size_t n = c->first[t]; n < c->first[t + 1]; n++)
      same = same && c->order[TETS * n + i] == order;
    if (!same) continue;
    uint8_t vertex[4];
    memcpy(vertex, shape->vertex[i], 4);
    for (size_t j = 0; j < 4; j++) shape->vertex[i][j] = vertex[cb_permutation[order][j]];
    for (size_t n = c->first[t]; n < c->first[t + 1]; n++) c->order[TETS * n + i] = 0;
  }
  for (size_t n = c->first[t]; n < c->first[t + 1]; n++)
    for (size_t i = shape->tets; i < TETS; i++) c->order[TETS * n + i] = c->order[TETS * n];
}

/* at[shapes] := the new number of each shape that has clusters, in order of their
 * first meeting. */
static void number_shapes(const struct cb_search *s, uint32_t *at, struct cb_clusters *out) {
  for (size_t t = 0; t < s->shapes.shapes; t++) {
    at[t] = (uint32_t)out->templates;
    if (s->count[t] == 0) continue;
    out->shape[out->templates] = template_of(s->shapes.shape + t);
    out->first[out->templates + 1] = out->first[out->templates] + (uint32_t)s->count[t];
    out->templates++;
  }
}

/* cluster_of[tets] := the cluster whose lowest tetrahedron it is, or NONE. */
static void find_lowest(const struct cb_mesh *mesh, const struct cb_search *s,
                        uint32_t *cluster_of) {
  for (size_t e = 0; e < mesh->tets; e++) cluster_of[e] = NONE;
  for (size_t n = 0; n < s->clusters; n++) {
    const struct cb_cluster *c = s->cluster + n;
    uint32_t lowest = c->tet[0];
    for (size_t i = 1; i < c->tets; i++)
      if (c->tet[i] < lowest) lowest = c->tet[i];
    cluster_of[lowest] = (uint32_t)n;
  }
}

static enum cb_status place_all(const struct cb_mesh *mesh, struct cb_search *s,
                                struct cb_clusters *out) {
  enum cb_status status = CB_MEMORY;
  const size_t shapes = s->shapes.shapes + 1;
  uint32_t *cluster_of = malloc((mesh->tets + 1) * sizeof *cluster_of);
  uint32_t *at = calloc(shapes, sizeof *at), *next = calloc(shapes, sizeof *next);
  if (!cluster_of || !at || !next) goto done;
  number_shapes(s, at, out);
  memcpy(next, out->first, out->templates * sizeof *next);
  find_lowest(mesh, s, cluster_of);
  status = CB_OK;
  for (size_t e = 0; e < mesh->tets && !status; e++) {
    if (cluster_of[e] == NONE) continue;
    const struct cb_cluster *c = s->cluster + cluster_of[e];
    status = place_cluster(mesh, s, c, next[at[c->shape]]++, out);
  }
  for (size_t t = 0; t < out->templates && !status; t++) bake_order(out, t);
done:
  free(cluster_of);
  free(at);
  free(next);
  return status;
}

enum cb_status cb_clusters_create(const struct cb_mesh *mesh, size_t lanes,
                                  struct cb_clusters **out) {
  struct cb_search search;
  enum cb_status status = cb_search_create(mesh, lanes, &search);
  if (status) return status;
  const size_t n = search.clusters + 1, shapes = search.shapes.shapes + 1;
  struct cb_clusters *made = calloc(1, sizeof *made);
  status = CB_MEMORY;
  if (!made) goto done;
  made->clusters = search.clusters;
  made->shape = calloc(shapes, sizeof *made->shape);
  made->first = calloc(shapes, sizeof *made->first);
  made->node = malloc(n * NODES * sizeof *made->node);
  made->tet = malloc(n * TETS * sizeof *made->tet);
  made->order = malloc(n * TETS * sizeof *made->order);
  if (!made->shape || !made->first || !made->node || !made->tet || !made->order) goto done;
  status = place_all(mesh, &search, made);
  if (status) goto done;
  *out = made;
  made = NULL;
done:
  cb_clusters_free(made);
  cb_search_free(&search);
  return status;
}

void cb_clusters_free(struct cb_clusters *c) {
  if (!c) return;
  free(c->shape);
  free(c->first);
  free(c->node);
  free(c->tet);
  free(c->order);
  free(c);
}
