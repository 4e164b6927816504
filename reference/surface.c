/* surface.c - boundary nodes by solid angles, without looking at faces.
 * Source: Van Oosterom, Strackee 1983, eq. 8 (solid angle of a triangle).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/surface.h"

#include <math.h>
#include <stdlib.h>

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Solid angle, sr, of the corner at `apex` towards the other three; positive
 * for either orientation. */
static double corner_angle(const double *X, uint32_t apex, const uint32_t other[3]) {
  double e[3][3], length[3];
  for (size_t i = 0; i < 3; i++) {
    for (size_t c = 0; c < 3; c++) e[i][c] = X[3 * (size_t)other[i] + c] - X[3 * (size_t)apex + c];
    length[i] = sqrt(dot(e[i], e[i]));
  }
  double cross[3] = {e[1][1] * e[2][2] - e[1][2] * e[2][1], e[1][2] * e[2][0] - e[1][0] * e[2][2],
                     e[1][0] * e[2][1] - e[1][1] * e[2][0]};
  double cosine = length[0] * length[1] * length[2] + dot(e[0], e[1]) * length[2] +
                  dot(e[1], e[2]) * length[0] + dot(e[2], e[0]) * length[1];
  return 2 * atan2(fabs(dot(e[0], cross)), cosine);
}

enum cb_status cb_surface_nodes(const struct cb_mesh *mesh, uint32_t *list, size_t *count) {
  const double full = 4 * acos(-1), rounding = 1e-6;
  double *angle = calloc(mesh->nodes, sizeof *angle);
  if (!angle && mesh->nodes) return CB_MEMORY;
  for (size_t t = 0; t < mesh->tets; t++) {
    const uint32_t *v = mesh->tet + 4 * t;
    for (size_t i = 0; i < 4; i++) {
      const uint32_t other[3] = {v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]};
      angle[v[i]] += mesh->share * corner_angle(mesh->X, v[i], other);
    }
  }
  size_t found = 0;
  for (size_t i = 0; i < mesh->nodes; i++)
    if (angle[i] > 0 && angle[i] < full * (1 - rounding)) list[found++] = (uint32_t)i;
  *count = found;
  free(angle);
  return CB_OK;
}
