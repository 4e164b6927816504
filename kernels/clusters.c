/* placeholder until the finder is merged: every tetrahedron is a cluster */
#include "kernels/clusters.h"
#include <stdlib.h>
const uint8_t cb_permutation[24][4] = {{0, 1, 2, 3}};
enum cb_status cb_clusters_create(const struct cb_mesh *mesh, size_t lanes,
                                  struct cb_clusters **out) {
  (void)lanes;
  struct cb_clusters *c = calloc(1, sizeof *c);
  c->templates = 1, c->clusters = mesh->tets;
  c->shape = calloc(1, sizeof *c->shape);
  *c->shape = (struct cb_template){4, 1, {{0, 1, 2, 3}}};
  c->first = calloc(2, 4), c->first[1] = (uint32_t)mesh->tets;
  c->node = calloc(mesh->tets, 4 * CB_CLUSTER_NODES);
  c->tet = calloc(mesh->tets, 4 * CB_CLUSTER_TETS);
  c->order = calloc(mesh->tets, CB_CLUSTER_TETS);
  for (size_t t = 0; t < mesh->tets; t++) {
    for (size_t j = 0; j < 4; j++) c->node[CB_CLUSTER_NODES * t + j] = mesh->tet[4 * t + j];
    c->tet[CB_CLUSTER_TETS * t] = (uint32_t)t;
  }
  *out = c;
  return CB_OK;
}
void cb_clusters_free(struct cb_clusters *c) {
  if (!c) return;
  free(c->shape), free(c->first), free(c->node), free(c->tet), free(c->order), free(c);
}
