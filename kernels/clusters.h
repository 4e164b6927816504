/* clusters.h - tetrahedra of any mesh in clusters of the same shape, so that each
 * lane can have a cluster of its own and a node is gathered and scattered once a
 * cluster: 4 node visits a tetrahedron alone, 1.3 on irregular meshes, 0.8 in the
 * cells of the paper's grid. Only connectivity counts, no positions.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTERS_H
#define CB_CLUSTERS_H

#include "kernels/kernel.h"

/* At most in one cluster. */
enum { CB_CLUSTER_NODES = 8, CB_CLUSTER_TETS = 12 };

/* What clusters of one shape have in common: the vertices of each tetrahedron as
 * local nodes 0 to nodes-1. */
struct cb_template {
  uint8_t nodes, tets;
  uint8_t vertex[CB_CLUSTER_TETS][4];
};

struct cb_clusters {
  size_t templates, clusters;
  struct cb_template *shape; /* [templates] no two alike up to their numbering */
  uint32_t *first; /* [templates+1] clusters first[t] to first[t+1]-1 have shape t; these come by
                      their lowest tetrahedron */
  uint32_t *node;  /* CB_CLUSTER_NODES a cluster: the mesh's node of each local node */
  uint32_t *tet;   /* CB_CLUSTER_TETS a cluster: the mesh's tetrahedron of each of the shape's */
  uint8_t *order;  /* CB_CLUSTER_TETS a cluster: the mesh's own vertex j of that tetrahedron is the
                      shape's vertex cb_permutation[order][j]; 0 throughout where all clusters of
                      a shape agree, as on a grid */
};

/* All permutations of the four vertices; 0 is the identity. */
extern const uint8_t cb_permutation[24][4];

/* Each tetrahedron of the mesh in exactly one cluster; shapes that would not fill a
 * few packs of that many lanes are avoided. Unused places of node, tet and order
 * repeat the first. Any mesh is allowed: superposed or repeated tetrahedra, edges and
 * faces of many, isolated nodes; that nodes exist, and none is twice in a tetrahedron, is
 * not checked. Linear time (about 3 us a tetrahedron), the same result for the same mesh.
 * CB_MEMORY; CB_INPUT for 2^30 tetrahedra or more. */
enum cb_status cb_clusters_create(const struct cb_mesh *mesh, size_t lanes,
                                  struct cb_clusters **out);
void cb_clusters_free(struct cb_clusters *c); /* may be NULL */

#endif
