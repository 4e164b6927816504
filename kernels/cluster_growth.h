/* cluster_growth.h - the free tetrahedra around each node, and the growth of one
 * cluster among them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTER_GROWTH_H
#define CB_CLUSTER_GROWTH_H

#include "kernels/clusters.h"

/* Nodes and tetrahedra in the sequence in which they were added. */
struct cb_cluster {
  uint32_t node[CB_CLUSTER_NODES], tet[CB_CLUSTER_TETS];
  uint32_t shape;
  uint8_t nodes, tets;
};

/* Corner 4*tet + j is vertex j of a tetrahedron. Those of the free tetrahedra around
 * node n are corner[start[n]] to corner[start[n] + free[n] - 1]. */
struct cb_free {
  const struct cb_mesh *mesh;
  uint32_t *start, *free, *corner;
  uint32_t *at; /* [4*tets] place of each free corner */
};

/* All tetrahedra are free. CB_MEMORY. */
enum cb_status cb_free_create(const struct cb_mesh *mesh, struct cb_free *f);
void cb_free_free(struct cb_free *f); /* a zeroed one is allowed */
void cb_free_take(struct cb_free *f, uint32_t tet);
void cb_free_return(struct cb_free *f, uint32_t tet);

/* Of a node with more free tetrahedra only so many are scanned; what else it has is
 * found from its other nodes, in time that does not grow with them. */
enum { CB_HUB = 256 };

/* Bit masks: which of the cluster's nodes a tetrahedron has, which of its vertices
 * they are. */
struct cb_shared {
  uint8_t nodes, vertices;
};

/* What a growing cluster sees: tetrahedra with at least one of its nodes. */
struct cb_growth {
  const struct cb_free *free;
  struct cb_cluster c;
  uint8_t tets_of[CB_CLUSTER_NODES + 1]; /* tetrahedra of the first n nodes */
  uint8_t hubs;                          /* bit mask of nodes that were not scanned whole */
  struct cb_shared *shared;              /* [mesh tets] */
  uint32_t seen[CB_CLUSTER_NODES * CB_HUB + 1], near[CB_CLUSTER_NODES * CB_HUB + 1];
  size_t seens, nears; /* near: three nodes are shared, or all */
};

enum cb_status cb_growth_create(const struct cb_free *f, struct cb_growth **out);
void cb_growth_free(struct cb_growth *g); /* may be NULL */

/* c := the free tetrahedra on the four nodes of the seed, at most CB_CLUSTER_TETS. */
void cb_growth_start(struct cb_growth *g, uint32_t seed);
/* Add the nodes that close the most, until there is no room or no such node; of
 * equals that with the fewest free tetrahedra, so that no single ones are left. */
void cb_growth_finish(struct cb_growth *g);

#endif
