/* mesh_irregular.c - an irregular mesh of a block, for what must not depend on the
 * regularity of the grid.
 * Source: the pulling triangulation with respect to a random sequence of the nodes:
 *         De Loera, Rambau, Santos 2010, chapter 4.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"

/* Largest displacement of a node along each axis; smallest volume of a tetrahedron;
 * both over the cell's, the latter times six: 1 without displacements. */
static const double DISPLACEMENT = 0.2, SMALLEST = 0.2;

/* The corners around each face of a cell, numbered x + 2 y + 4 z. */
static const uint8_t face[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};

/* Place in which `around` has the node of the lowest rank. */
static size_t lowest(const uint32_t *corner, const uint8_t *around, size_t n,
                     const uint32_t *rank) {
  size_t low = 0;
  for (size_t i = 1; i < n; i++)
    if (rank[corner[around[i]]] < rank[corner[around[low]]]) low = i;
  return low;
}

/* The lowest node over the two halves of each of the three faces without it, each
 * cut from its own lowest node: both cells at a face cut it alike. */
static uint32_t *fill_cell(const uint32_t corner[8], const uint32_t *rank, uint32_t *tet) {
  static const uint8_t all[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const size_t apex = lowest(corner, all, 8, rank);
  for (size_t f = 0; f < 6; f++) {
    if (memchr(face[f], (int)apex, 4)) continue;
    const size_t from = lowest(corner, face[f], 4, rank);
    for (size_t half = 1; half < 3; half++, tet += 4) {
      tet[0] = corner[apex];
      tet[1] = corner[face[f][from]];
      tet[2] = corner[face[f][(from + half) % 4]];
      tet[3] = corner[face[f][(from + half + 1) % 4]];
    }
  }
  return tet;
}

static void fill_cells(const size_t n[3], const uint32_t *rank, uint32_t *tet) {
  for (size_t k = 0; k < n[2]; k++)
    for (size_t j = 0; j < n[1]; j++)
      for (size_t i = 0; i < n[0]; i++) {
        uint32_t corner[8];
        for (size_t c = 0; c < 8; c++)
          corner[c] = (uint32_t)(i + (c & 1) +
                                 (n[0] + 1) * (j + (c >> 1 & 1) + (n[1] + 1) * (k + (c >> 2))));
        tet = fill_cell(corner, rank, tet);
      }
}

/* Nodes in the surface stay in it. */
static void displace(gsl_rng *rng, const size_t n[3], double edge, const struct cb_mesh *mesh,
                     double *u) {
  for (size_t i = 0; i < 3 * mesh->nodes; i++) {
    const double random = (2 * gsl_rng_uniform(rng) - 1) * DISPLACEMENT * edge;
    const double X = mesh->X[i], last = edge * (double)n[i % 3];
    u[i] = X == 0 || X == last ? 0 : random;
  }
}

/* Add u to the positions, the nodes of tetrahedra that become too small by half,
 * until none does: u = 0 is the grid. u is spent. */
static void add_displacements(double edge, struct cb_mesh *mesh, double *u) {
  for (size_t i = 0; i < 3 * mesh->nodes; i++) mesh->X[i] += u[i];
  for (size_t small = 1; small;) {
    small = 0;
    for (size_t e = 0; e < mesh->tets; e++) {
      if (fabs(cb_mesh_six_volumes(mesh, e)) >= SMALLEST * edge * edge * edge) continue;
      small++;
      for (size_t i = 0; i < 12; i++) {
        const size_t at = 3 * (size_t)mesh->tet[4 * e + i / 3] + i % 3;
        u[at] /= 2;
        mesh->X[at] -= u[at];
      }
    }
  }
}

/* Nodes, tetrahedra and their vertices in random sequence; number[nodes] := the new
 * numbers, X: room for the positions. */
static void shuffle(gsl_rng *rng, struct cb_mesh *mesh, uint32_t *number, double *X) {
  gsl_ran_shuffle(rng, number, mesh->nodes, sizeof *number);
  memcpy(X, mesh->X, 3 * mesh->nodes * sizeof *X);
  for (size_t i = 0; i < mesh->nodes; i++)
    memcpy(mesh->X + 3 * (size_t)number[i], X + 3 * i, 3 * sizeof *X);
  gsl_ran_shuffle(rng, mesh->tet, mesh->tets, 4 * sizeof *mesh->tet);
  for (size_t e = 0; e < mesh->tets; e++) {
    uint32_t *t = mesh->tet + 4 * e;
    for (size_t j = 0; j < 4; j++) t[j] = number[t[j]];
    gsl_ran_shuffle(rng, t, 4, sizeof *t);
    if (cb_mesh_six_volumes(mesh, e) > 0) continue;
    const uint32_t third = t[2];
    t[2] = t[3];
    t[3] = third;
  }
}

enum cb_status cb_mesh_irregular(size_t nx, size_t ny, size_t nz, double edge, unsigned long seed,
                                 struct cb_mesh *mesh) {
  const size_t n[3] = {nx, ny, nz};
  struct cb_mesh made;
  enum cb_status status = cb_mesh_grid(nx, ny, nz, edge, &made);
  if (status != CB_OK) return status;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  uint32_t *number = malloc(made.nodes * sizeof *number);
  double *u = malloc(3 * made.nodes * sizeof *u);
  if (!rng || !number || !u) {
    status = cb_fail_memory("the irregular mesh");
    goto done;
  }
  gsl_rng_set(rng, seed);
  made.share = 1;
  made.tets = 6 * nx * ny * nz;
  for (size_t i = 0; i < made.nodes; i++) number[i] = (uint32_t)i;
  gsl_ran_shuffle(rng, number, made.nodes, sizeof *number);
  fill_cells(n, number, made.tet);
  displace(rng, n, edge, &made, u);
  add_displacements(edge, &made, u);
  shuffle(rng, &made, number, u);
  *mesh = made;
  made = (struct cb_mesh){0};
done:
  cb_mesh_free(&made);
  free(u);
  free(number);
  if (rng) gsl_rng_free(rng);
  return status;
}
