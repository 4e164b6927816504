/* cluster_shapes.h - which clusters of tetrahedra have the same shape: the shapes
 * that were met so far, found again under any numbering of their nodes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTER_SHAPES_H
#define CB_CLUSTER_SHAPES_H

#include <stdlib.h>

#include "kernels/clusters.h"

/* The array, moved if it has not yet room for that many elements, or NULL without
 * memory: then it stays as it is. */
static inline void *cb_grown(void *array, size_t *room, size_t needed, size_t size) {
  if (needed <= *room) return array;
  size_t more = 2 * *room > needed ? 2 * *room : needed + 16;
  void *grown = reallocarray(array, more, size);
  if (grown) *room = more;
  return grown;
}

/* A numbered cluster: one bit mask of four nodes for each tetrahedron, ascending, the
 * rest zero. The nodes are 0 to n-1, each in some tetrahedron. */
struct cb_masks {
  uint8_t of[CB_CLUSTER_TETS];
};

/* Put a mask to the first n. */
static inline void cb_masks_insert(struct cb_masks *masks, size_t n, uint8_t mask) {
  for (; n > 0 && masks->of[n - 1] > mask; n--) masks->of[n] = masks->of[n - 1];
  masks->of[n] = mask;
}

/* How a numbered cluster becomes its shape: place[node] is the shape's node. */
struct cb_numbering {
  uint8_t place[CB_CLUSTER_NODES];
};

/* What is known of a numbered cluster. Each of its numberings (those that exchange
 * equal parts are many; 48 are kept) makes it the shape. */
struct cb_numbered {
  struct cb_masks masks;
  uint32_t shape;
  uint32_t first, numberings; /* in struct cb_shapes */
};

struct cb_shapes {
  size_t shapes;
  struct cb_masks *shape; /* [shapes] */
  size_t known;           /* private from here on */
  struct cb_numbered *cluster;
  struct cb_numbering *numbering;
  size_t numberings;
  size_t room[3]; /* of the three arrays */
  size_t slots;   /* a power of two */
  uint32_t *slot;
};

enum cb_status cb_shapes_create(struct cb_shapes *s);
void cb_shapes_free(struct cb_shapes *s); /* a zeroed one is allowed */

/* *found := what is known of that cluster; valid until the next call. CB_MEMORY. */
enum cb_status cb_shapes_find(struct cb_shapes *s, const struct cb_masks *masks,
                              const struct cb_numbered **found);

#endif
