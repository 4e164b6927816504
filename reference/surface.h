/* surface.h - which nodes of a mesh can be touched and seen.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SURFACE_H
#define CB_SURFACE_H

#include "kernels/kernel.h"

/* list[mesh->nodes] receives the nodes on the rest shape's boundary, ascending;
 * *count how many. A node is inside when the solid angles of its tetrahedra,
 * times the mesh's share, sum to the full sphere: this holds for superposed
 * splits too, whose faces do not match. Nodes that no tetrahedron uses are not
 * listed. Overlapping or folded rest shapes are not detected. CB_MEMORY. */
enum cb_status cb_surface_nodes(const struct cb_mesh *mesh, uint32_t *list, size_t *count);

#endif
