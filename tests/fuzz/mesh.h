/* mesh.h - what a mesh owes that a reader accepts.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FUZZ_MESH_H
#define CB_FUZZ_MESH_H

#include <math.h>

#include "harness/files/mesh.h"
#include "harness/files/mesh_read.h"
#include "tests/fuzz/fuzz.h"

/* Finite nodes, elements of nodes that are there, none of them flat; then it is freed. */
static inline void fuzz_mesh(struct cb_mesh *mesh, long long *numbers) {
  fuzz_require(mesh->nodes > 0 && mesh->tets > 0 && numbers, "a mesh has nodes and tetrahedra");
  for (size_t i = 0; i < 3 * mesh->nodes; i++)
    fuzz_require(isfinite(mesh->X[i]), "coordinates are finite");
  for (size_t i = 0; i < 4 * mesh->tets; i++)
    fuzz_require(mesh->tet[i] < mesh->nodes, "elements are made of nodes");
  for (size_t e = 0; e < mesh->tets; e++) {
    const double volume = fabs(cb_mesh_six_volumes(mesh, e));
    fuzz_require(volume > 0 && isfinite(volume), "volumes are finite and not zero");
  }
  free(numbers);
  cb_mesh_free(mesh);
}

#endif
