/* order.c - nodes in the levels of a walk through the mesh from one of its ends,
 * tetrahedra by their lowest, then by their highest node.
 * Source: Cuthill & McKee 1969; the end by George & Liu 1979. Not sorted by degree
 *         and not reversed: neither changed the time of a step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/order.h"

#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"

/* At most: two or three found an end on every mesh that was tried; the limit keeps
 * the time linear on any other. */
enum { WALKS = 8 };

/* The tetrahedra around node n are around[start[n]] to around[start[n + 1] - 1]. */
struct walk {
  const struct cb_mesh *mesh;
  size_t *start;
  uint32_t *around;
  uint32_t *queue; /* [nodes] in the order of the visits */
  bool *seen;      /* [nodes] */
};

static void walk_free(struct walk *w) {
  free(w->start);
  free(w->around);
  free(w->queue);
  free(w->seen);
}

static enum cb_status walk_create(const struct cb_mesh *mesh, struct walk *w) {
  const size_t nodes = mesh->nodes, corners = 4 * mesh->tets;
  /* Counted two places on, so that each start ends up in its own. */
  *w = (struct walk){.mesh = mesh,
                     .start = calloc(nodes + 2, sizeof *w->start),
                     .around = calloc(corners + 1, sizeof *w->around),
                     .queue = calloc(nodes + 1, sizeof *w->queue),
                     .seen = calloc(nodes + 1, sizeof *w->seen)};
  if (!w->start || !w->around || !w->queue || !w->seen) {
    walk_free(w);
    return cb_fail_memory("the neighbours of the nodes");
  }
  for (size_t i = 0; i < corners; i++) w->start[mesh->tet[i] + (size_t)2]++;
  for (size_t n = 2; n < nodes + 2; n++) w->start[n] += w->start[n - 1];
  for (size_t i = 0; i < corners; i++)
    w->around[w->start[mesh->tet[i] + (size_t)1]++] = (uint32_t)(i / 4);
  return CB_OK;
}

/* Append the unseen nodes of the tetrahedra around node n to the queue of that
 * length, and return its new length. */
static size_t visit(struct walk *w, uint32_t n, size_t length) {
  for (size_t a = w->start[n]; a < w->start[n + (size_t)1]; a++)
    for (size_t j = 0; j < 4; j++) {
      const uint32_t other = w->mesh->tet[4 * (size_t)w->around[a] + j];
      if (w->seen[other]) continue;
      w->seen[other] = true;
      w->queue[length++] = other;
    }
  return length;
}

/* Queue the whole piece of root, level by level, from place first on. Returns
 * the end of the queue; *last := the first place of the last level, *depth := the
 * number of levels. */
static size_t walk_from(struct walk *w, uint32_t root, size_t first, size_t *last, size_t *depth) {
  size_t length = first;
  w->queue[length++] = root;
  w->seen[root] = true;
  *depth = 0;
  for (size_t i = first; i < length; ++*depth) {
    const size_t level_end = length;
    *last = i;
    for (; i < level_end; i++) length = visit(w, w->queue[i], length);
  }
  return length;
}

static size_t degree(const struct walk *w, uint32_t n) {
  return w->start[n + (size_t)1] - w->start[n];
}

/* Queue the piece of that node from one of its ends, so that the levels are many
 * and small: a node with the fewest tetrahedra in the last level of the walk
 * before, as long as that makes more levels. */
static size_t walk_piece(struct walk *w, uint32_t root, size_t first) {
  size_t deepest = 0, depth, last, end = walk_from(w, root, first, &last, &depth);
  for (int i = 1; i < WALKS && depth > deepest; i++) {
    deepest = depth;
    root = w->queue[last];
    for (size_t k = last; k < end; k++)
      if (degree(w, w->queue[k]) < degree(w, root)) root = w->queue[k];
    for (size_t k = first; k < end; k++) w->seen[w->queue[k]] = false;
    end = walk_from(w, root, first, &last, &depth);
  }
  return end;
}

static enum cb_status order_nodes(const struct cb_mesh *mesh, uint32_t *node) {
  struct walk w;
  enum cb_status status = walk_create(mesh, &w);
  if (status) return status;
  size_t length = 0;
  for (size_t n = 0; n < mesh->nodes; n++)
    if (!w.seen[n]) length = walk_piece(&w, (uint32_t)n, length);
  for (size_t i = 0; i < mesh->nodes; i++) node[w.queue[i]] = (uint32_t)i;
  walk_free(&w);
  return CB_OK;
}

/* Lowest or highest new number of a tetrahedron's nodes. */
static uint32_t extreme(const uint32_t *tet, const uint32_t *node, bool highest) {
  uint32_t found = node[tet[0]];
  for (size_t j = 1; j < 4; j++)
    if (highest ? node[tet[j]] > found : node[tet[j]] < found) found = node[tet[j]];
  return found;
}

/* to := from sorted by the extreme node, those with the same in the same sequence;
 * place[nodes + 1] is for work. */
static void sort_tets(const struct cb_mesh *mesh, const uint32_t *node, bool highest,
                      const uint32_t *from, uint32_t *to, size_t *place) {
  memset(place, 0, (mesh->nodes + 1) * sizeof *place);
  for (size_t e = 0; e < mesh->tets; e++)
    place[extreme(mesh->tet + 4 * e, node, highest) + (size_t)1]++;
  for (size_t n = 1; n <= mesh->nodes; n++) place[n] += place[n - 1];
  for (size_t i = 0; i < mesh->tets; i++)
    to[place[extreme(mesh->tet + 4 * (size_t)from[i], node, highest)]++] = from[i];
}

enum cb_status cb_order_create(const struct cb_mesh *mesh, struct cb_order *order) {
  struct cb_order made = {.nodes = mesh->nodes, .tets = mesh->tets};
  uint32_t *by_highest = malloc((mesh->tets + 1) * sizeof *by_highest);
  size_t *place = malloc((mesh->nodes + 1) * sizeof *place);
  made.node = malloc((mesh->nodes + 1) * sizeof *made.node);
  made.tet = malloc((mesh->tets + 1) * sizeof *made.tet);
  enum cb_status status = CB_OK;
  if (!by_highest || !place || !made.node || !made.tet)
    status = cb_fail_memory("the order of the mesh");
  if (!status) status = order_nodes(mesh, made.node);
  if (status) goto done;
  for (size_t e = 0; e < mesh->tets; e++) made.tet[e] = (uint32_t)e;
  sort_tets(mesh, made.node, true, made.tet, by_highest, place);
  sort_tets(mesh, made.node, false, by_highest, made.tet, place);
  *order = made;
  made = (struct cb_order){0};
done:
  cb_order_free(&made);
  free(place);
  free(by_highest);
  return status;
}

void cb_order_free(struct cb_order *order) {
  free(order->node);
  free(order->tet);
  *order = (struct cb_order){0};
}

enum cb_status cb_order_mesh(const struct cb_order *order, const struct cb_mesh *mesh,
                             struct cb_mesh *ordered) {
  struct cb_mesh made;
  enum cb_status status = cb_mesh_allocate(mesh->nodes, mesh->tets, &made);
  if (status) return status;
  made.share = mesh->share;
  cb_order_forward(order, 3, mesh->X, made.X);
  for (size_t e = 0; e < mesh->tets; e++)
    for (size_t j = 0; j < 4; j++)
      made.tet[4 * e + j] = order->node[mesh->tet[4 * (size_t)order->tet[e] + j]];
  *ordered = made;
  return CB_OK;
}

void cb_order_forward(const struct cb_order *order, size_t width, const double *in, double *out) {
  for (size_t n = 0; n < order->nodes; n++)
    memcpy(out + width * order->node[n], in + width * n, width * sizeof *out);
}

void cb_order_backward(const struct cb_order *order, size_t width, const double *in, double *out) {
  for (size_t n = 0; n < order->nodes; n++)
    memcpy(out + width * n, in + width * order->node[n], width * sizeof *out);
}

enum cb_status cb_order_apply(struct cb_mesh *mesh) {
  struct cb_order order = {0};
  struct cb_mesh ordered;
  enum cb_status status = cb_order_create(mesh, &order);
  if (!status) status = cb_order_mesh(&order, mesh, &ordered);
  if (!status) {
    cb_mesh_free(mesh);
    *mesh = ordered;
  }
  cb_order_free(&order);
  return status;
}
