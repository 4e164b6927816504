/* faces.c - see faces.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/faces.h"

#include <stdlib.h>

static int compare(const void *left, const void *right) {
  const struct cb_face *a = left, *b = right;
  for (int j = 0; j < 3; j++)
    if (a->node[j] != b->node[j]) return a->node[j] < b->node[j] ? -1 : 1;
  return (a->tet > b->tet) - (a->tet < b->tet);
}

struct cb_face *cb_faces_create(size_t tets, const uint32_t *tet) {
  struct cb_face *face = malloc((4 * tets + 1) * sizeof *face);
  for (size_t n = 0; face && n < 4 * tets; n++) {
    uint32_t *f = face[n].node;
    face[n].tet = (uint32_t)(n / 4);
    for (size_t j = 0, filled = 0; j < 4; j++)
      if (j != n % 4) f[filled++] = tet[n / 4 * 4 + j];
    for (int pass = 0; pass < 3; pass++) /* three are sorted by three exchanges */
      if (f[pass % 2] > f[pass % 2 + 1]) {
        const uint32_t swap = f[pass % 2];
        f[pass % 2] = f[pass % 2 + 1], f[pass % 2 + 1] = swap;
      }
  }
  if (face) qsort(face, 4 * tets, sizeof *face, compare);
  return face;
}

bool cb_face_same(const struct cb_face *a, const struct cb_face *b) {
  return a->node[0] == b->node[0] && a->node[1] == b->node[1] && a->node[2] == b->node[2];
}
