/* cluster_search.c - clusters grown one after the other from where the fewest free
 * tetrahedra are left, the densest first; those of rare shapes are dissolved and
 * their tetrahedra searched again for the frequent shapes: those that fill a pack,
 * then, in a large mesh, two.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/cluster_search.h"

#include <stdlib.h>
#include <string.h>

enum { BUCKETS = 256, DENSE = 8, MANY = 128 };
static const uint32_t NONE = UINT32_MAX;
static const uint8_t UNTRIED = 255;

/* Fewest tetrahedra of a cluster in each pass over the mesh. */
static const uint8_t densest[] = {8, 6, 1};

/* Nodes by their number of free tetrahedra, those of a bucket doubly linked. */
struct queue {
  uint32_t head[BUCKETS], *next, *before;
  uint8_t *bucket; /* [nodes] 0: not queued */
};

struct work {
  struct cb_search *s;
  struct cb_free free;
  struct cb_growth *growth;
  struct queue queue;
  uint8_t *reach; /* [tets] tetrahedra in the cluster last found there, at most */
  bool *frequent; /* [frequents] the shapes that are allowed, NULL: all */
  size_t frequents;
};

/* ---- the queue ------------------------------------------------------------------- */

static void unlink_node(struct queue *q, uint32_t n) {
  if (!q->bucket[n]) return;
  if (q->before[n] == NONE)
    q->head[q->bucket[n]] = q->next[n];
  else
    q->next[q->before[n]] = q->next[n];
  if (q->next[n] != NONE) q->before[q->next[n]] = q->before[n];
  q->bucket[n] = 0;
}

/* To the head of its bucket: the search goes on where it was. */
static void queue_node(struct queue *q, uint32_t n, uint32_t free) {
  unlink_node(q, n);
  if (!free) return;
  const uint8_t b = (uint8_t)(free < BUCKETS ? free : BUCKETS - 1);
  q->bucket[n] = b;
  q->before[n] = NONE;
  q->next[n] = q->head[b];
  if (q->head[b] != NONE) q->before[q->head[b]] = n;
  q->head[b] = n;
}

static uint32_t first_node(const struct queue *q) {
  for (size_t b = 1; b < BUCKETS; b++)
    if (q->head[b] != NONE) return q->head[b];
  return NONE;
}

/* ---- clusters ---------------------------------------------------------------------- */

/* The first tetrahedra of the growing cluster. */
static struct cb_masks grown_masks(const struct cb_growth *g, size_t tets) {
  struct cb_masks m = {{0}};
  for (size_t i = 0; i < tets; i++) cb_masks_insert(&m, i, g->shared[g->c.tet[i]].nodes);
  return m;
}

/* Cut what has grown back to the most nodes with which it has an allowed shape. */
static enum cb_status cut(struct work *w) {
  struct cb_growth *g = w->growth;
  for (;; g->c.nodes--) {
    const struct cb_numbered *known;
    const struct cb_masks masks = grown_masks(g, g->tets_of[g->c.nodes]);
    g->c.tets = g->tets_of[g->c.nodes];
    if (cb_shapes_find(&w->s->shapes, &masks, &known)) return CB_MEMORY;
    g->c.shape = known->shape;
    if (!w->frequent || g->c.nodes == 4) return CB_OK;
    if (known->shape < w->frequents && w->frequent[known->shape]) return CB_OK;
  }
}

/* Room for one more cluster, and a count of each shape. */
static enum cb_status more_clusters(struct cb_search *s) {
  const size_t counted = s->room[0];
  size_t *count = cb_grown(s->count, &s->room[0], s->shapes.shapes, sizeof *count);
  if (!count) return CB_MEMORY;
  s->count = count;
  memset(count + counted, 0, (s->room[0] - counted) * sizeof *count);
  struct cb_cluster *cluster = cb_grown(s->cluster, &s->room[1], s->clusters + 1, sizeof *cluster);
  if (!cluster) return CB_MEMORY;
  s->cluster = cluster;
  return CB_OK;
}

static enum cb_status keep(struct work *w, const struct cb_cluster *c) {
  struct cb_search *s = w->s;
  if (more_clusters(s)) return CB_MEMORY;
  s->cluster[s->clusters++] = *c;
  s->count[c->shape]++;
  for (size_t i = 0; i < c->tets; i++) cb_free_take(&w->free, c->tet[i]);
  for (size_t v = 0; v < c->nodes; v++) queue_node(&w->queue, c->node[v], w->free.free[c->node[v]]);
  return CB_OK;
}

/* ---- passes -------------------------------------------------------------------------- */

/* The free tetrahedron around that node with the fewest others around its nodes, of
 * those where a cluster of that many may be found; NONE if there is none. */
static uint32_t choose_seed(const struct work *w, uint32_t node, uint8_t tets) {
  const struct cb_free *f = &w->free;
  uint32_t seed = NONE;
  size_t fewest = SIZE_MAX;
  for (uint32_t i = 0; i < f->free[node]; i++) {
    const size_t tet = f->corner[f->start[node] + i] / 4;
    if (w->reach[tet] < tets) continue;
    size_t sum = 0;
    for (size_t j = 0; j < 4; j++) sum += f->free[f->mesh->tet[4 * tet + j]];
    if (sum >= fewest) continue;
    fewest = sum;
    seed = (uint32_t)tet;
  }
  return seed;
}

/* Clusters of at least that many tetrahedra. Where one fails, its other tetrahedra
 * would hardly do better as seeds. */
static enum cb_status search(struct work *w, uint8_t tets) {
  for (size_t n = w->free.mesh->nodes; n-- > 0;)
    queue_node(&w->queue, (uint32_t)n, w->free.free[n]);
  for (uint32_t node; (node = first_node(&w->queue)) != NONE;) {
    const uint32_t seed = choose_seed(w, node, tets);
    if (seed == NONE) {
      unlink_node(&w->queue, node);
      continue;
    }
    const struct cb_cluster *c = &w->growth->c;
    cb_growth_start(w->growth, seed);
    cb_growth_finish(w->growth);
    if (cut(w)) return CB_MEMORY;
    if (c->tets >= tets) {
      if (keep(w, c)) return CB_MEMORY;
      continue;
    }
    w->reach[seed] = c->tets;
    for (size_t i = 0; i < c->tets; i++)
      if (w->reach[c->tet[i]] > c->tets) w->reach[c->tet[i]] = c->tets;
  }
  return CB_OK;
}

static enum cb_status search_all(struct work *w) {
  memset(w->reach, UNTRIED, w->free.mesh->tets);
  for (size_t i = 0; i < sizeof densest; i++)
    if (search(w, densest[i])) return CB_MEMORY;
  return CB_OK;
}

/* Dissolve the clusters of shapes with fewer than that many, and allow no more of
 * them; and all clusters that are not dense, so that what becomes free is found again
 * together with what is around. */
static enum cb_status dissolve(struct work *w, size_t fewest) {
  struct cb_search *s = w->s;
  bool *frequent = realloc(w->frequent, (s->shapes.shapes + 1) * sizeof *frequent);
  if (!frequent) return CB_MEMORY;
  w->frequent = frequent;
  w->frequents = s->shapes.shapes;
  for (size_t t = 0; t < w->frequents; t++) frequent[t] = s->count[t] >= fewest;
  const size_t clusters = s->clusters;
  s->clusters = 0;
  for (size_t n = 0; n < clusters; n++) {
    const struct cb_cluster *c = s->cluster + n;
    if (frequent[c->shape] && c->tets >= DENSE) {
      s->cluster[s->clusters++] = *c;
      continue;
    }
    s->count[c->shape]--;
    for (size_t i = 0; i < c->tets; i++) cb_free_return(&w->free, c->tet[i]);
  }
  return CB_OK;
}

static void work_free(struct work *w) {
  cb_free_free(&w->free);
  cb_growth_free(w->growth);
  free(w->queue.next);
  free(w->queue.before);
  free(w->queue.bucket);
  free(w->reach);
  free(w->frequent);
}

static enum cb_status work_create(const struct cb_mesh *mesh, struct cb_search *s, struct work *w) {
  *w = (struct work){.s = s, .reach = malloc(mesh->tets + 1)};
  struct queue *q = &w->queue;
  q->next = malloc((mesh->nodes + 1) * sizeof *q->next);
  q->before = malloc((mesh->nodes + 1) * sizeof *q->before);
  q->bucket = calloc(mesh->nodes + 1, 1);
  memset(q->head, 255, sizeof q->head);
  if (!w->reach || !q->next || !q->before || !q->bucket) return CB_MEMORY;
  if (cb_free_create(mesh, &w->free)) return CB_MEMORY;
  return cb_growth_create(&w->free, &w->growth);
}

enum cb_status cb_search_create(const struct cb_mesh *mesh, size_t lanes, struct cb_search *s) {
  if (mesh->tets >= 1u << 30) return CB_INPUT;
  struct cb_search made = {0};
  struct work w;
  enum cb_status status = work_create(mesh, &made, &w);
  if (!status) status = cb_shapes_create(&made.shapes);
  if (!status) status = search_all(&w);
  if (!status) status = dissolve(&w, lanes);
  if (!status) status = search_all(&w);
  if (!status && made.clusters >= MANY * lanes) { /* else a shape of few may be all there is */
    status = dissolve(&w, 2 * lanes);
    if (!status) status = search_all(&w);
  }
  work_free(&w);
  if (status) {
    cb_search_free(&made);
    return status;
  }
  *s = made;
  return CB_OK;
}

void cb_search_free(struct cb_search *s) {
  cb_shapes_free(&s->shapes);
  free(s->count);
  free(s->cluster);
  *s = (struct cb_search){0};
}
