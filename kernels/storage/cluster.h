/* cluster.h - the loops over clusters (kernels/clusters.h): nodes are gathered and
 * scattered once a cluster, and its elements take them from there. One copy an
 * arithmetic, in cluster.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTER_H
#define CB_CLUSTER_H

#include "kernels/storage/drive.h"
#include "kernels/team.h"

#define drive_update_clusters CB_NAME(cb_drive_update_clusters)
#define drive_product_clusters CB_NAME(cb_drive_product_clusters)
/* ebe-recompute keeps REST_W in the state's place, and the positions. */
void drive_update_clusters(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                           S *out, update_pack_fn *update);
void drive_product_clusters(const struct cb_elements *E, size_t thread, const S *u, S *y,
                            product_pack_fn *product);
/* cb_product_fn: state = nine world gradients, or what ebe-recompute keeps. */
void CB_NAME(cb_product_cluster_gradients)(const struct cb_elements *E, size_t thread,
                                           const void *u, void *y);
void CB_NAME(cb_product_recompute)(const struct cb_elements *E, size_t thread, const void *u,
                                   void *y);

#endif
