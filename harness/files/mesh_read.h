/* mesh_read.h - what the mesh readers share.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_MESH_READ_H
#define CB_MESH_READ_H

#include "harness/files/mesh_text.h"

/* One file format each; contract of cb_mesh_read, except that numbers is not NULL. */
enum cb_status cb_mesh_read_tetgen(const char *path, struct cb_mesh *mesh, long long **numbers);
enum cb_status cb_mesh_read_gmsh(const char *path, struct cb_mesh *mesh, long long **numbers);

/* CB_INPUT, recorded, when tetrahedron e of the mesh, the current line's,
 * repeats a node or its rest volume is zero to rounding: |6 V| <= 1e-12 times
 * the cube of its longest edge. Its nodes are in range, as the caller knows. */
enum cb_status cb_mesh_check_tet(const struct cb_text *t, const struct cb_mesh *mesh, size_t e);

/* Which node has which number in the file: a hash table. */
struct cb_numbers {
  size_t mask; /* slots - 1, slots a power of two */
  unsigned shift;
  struct cb_numbered *slot;
};
/* numbers[count], NULL: 0, 1, 2, ... CB_INPUT, recorded, for a repeated number,
 * with path; CB_MEMORY. Free with cb_numbers_free (zeroed: allowed). */
enum cb_status cb_numbers_create(const char *path, const long long *numbers, size_t count,
                                 struct cb_numbers *map);
void cb_numbers_free(struct cb_numbers *map);
/* *node := the node of that number; false, untouched, when there is none. */
bool cb_numbers_find(const struct cb_numbers *map, long long number, uint32_t *node);

#endif
