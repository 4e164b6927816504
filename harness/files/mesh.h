/* mesh.h - meshes made and read.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_MESH_H
#define CB_MESH_H

#include "kernels/kernel.h"

/* Arrays for that many nodes and tetrahedra, uninitialised, share 1. CB_MEMORY. */
enum cb_status cb_mesh_allocate(size_t nodes, size_t tets, struct cb_mesh *mesh);
struct cb_box {
  double low[3], high[3]; /* m; of no node: infinity, -infinity */
};
struct cb_box cb_mesh_bounds(const struct cb_mesh *mesh); /* at rest */
void cb_mesh_free(struct cb_mesh *mesh); /* and zero it; a zeroed mesh is allowed */

/* The paper's block: nx*ny*nz cubic cells of that edge length (m), corner at
 * the origin, each filled by both mirror-image splits into five tetrahedra,
 * superposed: 10 tetrahedra a cell, share 1/2. 7,7,7 gives 512 nodes and 3430
 * tetrahedra. CB_INPUT for a zero count or a size that is not positive. */
enum cb_status cb_mesh_grid(size_t nx, size_t ny, size_t nz, double edge, struct cb_mesh *mesh);

/* A block of nx*ny*nz cubic cells of that edge length (m) with an irregular mesh,
 * 6 tetrahedra a cell, share 1, the same again for the same seed: conforming, no
 * two nodes alike, every tetrahedron positively oriented with at least a fifth of
 * the mean volume; nodes, tetrahedra and the vertices of each come in random
 * sequence. CB_INPUT as for the grid; CB_MEMORY. */
enum cb_status cb_mesh_irregular(size_t nx, size_t ny, size_t nz, double edge, unsigned long seed,
                                 struct cb_mesh *mesh);

/* "rabbit" or "liver": about `length` m long along x, z up, `cells` of the lattice to that
 * length (at least 4); conforming, every tetrahedron positively oriented with a quality of at
 * least 0.2 (6 sqrt 2 volumes by the cube of the root mean square edge: 1 if regular), in one
 * piece, joined by faces. CB_INPUT, CB_MEMORY. */
enum cb_status cb_mesh_shape(const char *name, size_t cells, double length, struct cb_mesh *mesh);
bool cb_mesh_is_shape(const char *name);

/* Read by the name's ending: .node or .ele (TetGen pair, either names both; 0-
 * or 1-based, comments, attributes and markers skipped) or .msh (Gmsh 2.2 and
 * 4.1, ASCII; elements that are not 4-node tetrahedra are skipped). Nodes that
 * no tetrahedron uses are kept: node i of the mesh is the file's i-th node.
 * *numbers (may be NULL) := each node's number in the file, to be freed: from 0
 * or 1 without a gap in TetGen files, anything in Gmsh files.
 * CB_INPUT with file, line, what was expected; also for an element with a
 * repeated node, a node that is not there, a coordinate that is not finite, a
 * rest volume that is zero to rounding. CB_IO, CB_MEMORY. */
enum cb_status cb_mesh_read(const char *path, struct cb_mesh *mesh, long long **numbers);

/* x[3*nodes] := positions from a CSV with the header node,x,y,z, one row a node
 * in any order, nodes named by their number in the mesh file (numbers NULL: from
 * 0, as in a grid). Missing, repeated or unknown nodes, and coordinates that are
 * not finite, are CB_INPUT. CB_IO, CB_MEMORY. */
enum cb_status cb_positions_read(const char *path, const struct cb_mesh *mesh,
                                 const long long *numbers, double *x);

/* Of the tetrahedron of nodes t[4] at X: 6 sqrt(2) V / (root mean square edge)^3, 1 for the
 * regular one, 0 for a flat one, negative where its orientation is. */
double cb_mesh_quality(const double *X, const uint32_t *t);

#endif
