/* mesh.c - room for a mesh, and the paper's block.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/mesh.h"

#include <math.h>
#include <stdlib.h>

#include "harness/error.h"

enum cb_status cb_mesh_allocate(size_t nodes, size_t tets, struct cb_mesh *mesh) {
  double *X = reallocarray(NULL, nodes, 3 * sizeof *X);
  uint32_t *tet = reallocarray(NULL, tets, 4 * sizeof *tet);
  if (!X || !tet) {
    free(X);
    free(tet);
    return cb_fail_memory("the mesh");
  }
  *mesh = (struct cb_mesh){.nodes = nodes, .tets = tets, .X = X, .tet = tet, .share = 1};
  return CB_OK;
}

struct cb_box cb_mesh_bounds(const struct cb_mesh *mesh) {
  struct cb_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  for (size_t i = 0; i < 3 * mesh->nodes; i++) {
    box.low[i % 3] = fmin(box.low[i % 3], mesh->X[i]);
    box.high[i % 3] = fmax(box.high[i % 3], mesh->X[i]);
  }
  return box;
}

void cb_mesh_free(struct cb_mesh *mesh) {
  free(mesh->X);
  free(mesh->tet);
  *mesh = (struct cb_mesh){0};
}

/* A cell's corners are numbered x + 2 y + 4 z. One of its two splits: the inner
 * tetrahedron and four corners, all positively oriented. Its mirror image in x
 * has the corners with the lowest bit flipped and two vertices exchanged. */
static const uint8_t split[5][4] = {
    {0, 5, 3, 6}, {1, 0, 5, 3}, {2, 3, 6, 0}, {4, 5, 0, 6}, {7, 6, 3, 5}};

static void fill_cell(const uint32_t corner[8], uint32_t *tet) {
  for (size_t e = 0; e < 5; e++) {
    const uint8_t *s = split[e];
    for (size_t j = 0; j < 4; j++) *tet++ = corner[s[j]];
    const uint8_t mirrored[4] = {s[0] ^ 1, s[1] ^ 1, s[3] ^ 1, s[2] ^ 1};
    for (size_t j = 0; j < 4; j++) *tet++ = corner[mirrored[j]];
  }
}

static void fill_grid(size_t nx, size_t ny, size_t nz, double edge, struct cb_mesh *mesh) {
  double *X = mesh->X;
  for (size_t k = 0; k <= nz; k++)
    for (size_t j = 0; j <= ny; j++)
      for (size_t i = 0; i <= nx; i++, X += 3) {
        X[0] = edge * (double)i;
        X[1] = edge * (double)j;
        X[2] = edge * (double)k;
      }

  uint32_t *tet = mesh->tet;
  for (size_t k = 0; k < nz; k++)
    for (size_t j = 0; j < ny; j++)
      for (size_t i = 0; i < nx; i++, tet += 40) {
        uint32_t corner[8];
        for (size_t c = 0; c < 8; c++)
          corner[c] =
              (uint32_t)(i + (c & 1) + (nx + 1) * (j + (c >> 1 & 1) + (ny + 1) * (k + (c >> 2))));
        fill_cell(corner, tet);
      }
}

enum cb_status cb_mesh_grid(size_t nx, size_t ny, size_t nz, double edge, struct cb_mesh *mesh) {
  double nodes = ((double)nx + 1) * ((double)ny + 1) * ((double)nz + 1);
  if (nx == 0 || ny == 0 || nz == 0)
    return cb_fail(CB_INPUT,
                   "a grid of %zu x %zu x %zu cells is empty; give at least one cell along "
                   "each axis",
                   nx, ny, nz);
  if (!(nodes < UINT32_MAX))
    return cb_fail(CB_INPUT,
                   "a grid of %zu x %zu x %zu cells has more than the %u nodes that can be "
                   "numbered; give fewer cells",
                   nx, ny, nz, UINT32_MAX - 1);
  if (!(edge > 0 && isnormal(edge * edge * edge) && isfinite(edge * edge * edge * nodes)))
    return cb_fail(CB_INPUT, "a cell edge of %g m cannot be used; give a positive length", edge);

  struct cb_mesh made;
  enum cb_status status =
      cb_mesh_allocate((nx + 1) * (ny + 1) * (nz + 1), 10 * nx * ny * nz, &made);
  if (status != CB_OK) return status;
  made.share = 0.5;
  fill_grid(nx, ny, nz, edge, &made);
  *mesh = made;
  return CB_OK;
}

double cb_mesh_quality(const double *X, const uint32_t *t) {
  double e[9], square = 0;
  for (int j = 0; j < 9; j++) e[j] = X[3 * t[1 + j / 3] + j % 3] - X[3 * t[0] + j % 3];
  const double six = e[0] * (e[4] * e[8] - e[5] * e[7]) + e[1] * (e[5] * e[6] - e[3] * e[8]) +
                     e[2] * (e[3] * e[7] - e[4] * e[6]);
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < a; b++)
      for (int k = 0; k < 3; k++) {
        const double d = X[3 * t[a] + k] - X[3 * t[b] + k];
        square += d * d;
      }
  return M_SQRT2 * six / pow(square / 6, 1.5);
}
