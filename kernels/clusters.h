/* clusters.h - placeholder of the interface until the finder is merged. */
#ifndef CB_CLUSTERS_H
#define CB_CLUSTERS_H
#include "kernels/kernel.h"
enum { CB_CLUSTER_NODES = 8, CB_CLUSTER_TETS = 12 };
struct cb_template {
  uint8_t nodes, tets;
  uint8_t vertex[CB_CLUSTER_TETS][4];
};
struct cb_clusters {
  size_t templates, clusters;
  struct cb_template *shape;
  uint32_t *first, *node, *tet;
  uint8_t *order;
};
enum cb_status cb_clusters_create(const struct cb_mesh *mesh, size_t lanes,
                                  struct cb_clusters **out);
void cb_clusters_free(struct cb_clusters *clusters);
extern const uint8_t cb_permutation[24][4];
#endif
