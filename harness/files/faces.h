/* faces.h - the faces of tetrahedra, for who asks which are shared.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FACES_H
#define CB_FACES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct cb_face {
  uint32_t node[3]; /* in rising order */
  uint32_t tet;     /* whose face it is */
};
/* The 4*tets faces of tet[4*tets], those of the same nodes next to each other, in the order of
 * their tetrahedra. To be freed; NULL: out of memory. */
struct cb_face *cb_faces_create(size_t tets, const uint32_t *tet);
bool cb_face_same(const struct cb_face *a, const struct cb_face *b); /* the same nodes */

#endif
