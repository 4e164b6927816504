/* cluster_search.h - the search for clusters: which tetrahedra go together, before
 * their nodes are numbered alike.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTER_SEARCH_H
#define CB_CLUSTER_SEARCH_H

#include "kernels/cluster_growth.h"
#include "kernels/cluster_shapes.h"

struct cb_search {
  struct cb_shapes shapes;
  size_t *count; /* [shapes.shapes] clusters of each shape */
  size_t clusters;
  struct cb_cluster *cluster;
  size_t room[2]; /* of count and cluster */
};

/* Each tetrahedron of the mesh in one cluster. Errors as cb_clusters_create. */
enum cb_status cb_search_create(const struct cb_mesh *mesh, size_t lanes, struct cb_search *s);
void cb_search_free(struct cb_search *s); /* a zeroed one is allowed */

#endif
