/* cluster_joins.h - neighbouring clusters joined, two and two, where that is done in
 * the same way often enough to fill packs: nodes that both have are gathered and
 * scattered once. The cells of a grid become blocks of two or four; on irregular meshes
 * hardly any two neighbours meet like any other two.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTER_JOINS_H
#define CB_CLUSTER_JOINS_H

#include "kernels/clusters.h"

/* At most in one unit. */
enum { CB_UNIT_CLUSTERS = 4, CB_UNIT_NODES = 20, CB_UNIT_TETS = 40 };

/* What units of one shape have in common. */
struct cb_unit_shape {
  uint8_t nodes, tets;
  uint8_t node[CB_UNIT_NODES];     /* CB_CLUSTER_NODES k + v: node v of the k-th cluster */
  uint8_t tet[CB_UNIT_TETS];       /* CB_CLUSTER_TETS k + i: tetrahedron i of the k-th cluster */
  uint8_t vertex[CB_UNIT_TETS][4]; /* vertices as nodes of the unit */
};

/* One cluster, or several. */
struct cb_unit {
  uint32_t cluster[CB_UNIT_CLUSTERS];
  uint32_t shape;
  uint8_t clusters;
  uint8_t thread, part; /* kernels/packs.h */
};

struct cb_units {
  size_t shapes, units;
  struct cb_unit_shape *shape; /* [shapes] the clusters' come first, in their order */
  struct cb_unit *unit;        /* [units] */
  size_t room;                 /* of shape; private */
};

/* Each cluster in exactly one unit; joined: or several in one, all of the same thread
 * and part; so many such units of a thread, a part and a shape as fill whole packs.
 * thread, part: [clusters]. The same result for the same mesh. CB_MEMORY. */
enum cb_status cb_units_create(const struct cb_mesh *mesh, const struct cb_clusters *clusters,
                               const uint8_t *thread, const uint8_t *part, size_t lanes,
                               size_t threads, bool joined, struct cb_units *out);
void cb_units_free(struct cb_units *units); /* a zeroed one is allowed */

#endif
