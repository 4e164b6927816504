/* material.c - stress-strain matrices and lumped masses.
 * Source: Zienkiewicz, The Finite Element Method: isotropic and orthotropic
 *         elasticity in engineering constants, row-sum lumping.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/kernel.h"

#include <math.h>
#include <string.h>

static bool is_positive(double value) { return isfinite(value) && value > 0; }

enum cb_status cb_material_isotropic(double young, double poisson, double density,
                                     struct cb_material *m) {
  if (!(young >= 0 && poisson > -1 && poisson < 0.5 && is_positive(density))) return CB_INPUT;
  double mu = young / (2 * (1 + poisson));
  double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  if (!isfinite(lambda + 2 * mu)) return CB_INPUT;

  *m = (struct cb_material){.young = young, .poisson = poisson, .density = density};
  for (size_t i = 0; i < 3; i++) {
    for (size_t j = 0; j < 3; j++) m->D[6 * i + j] = i == j ? lambda + 2 * mu : lambda;
    m->D[6 * (3 + i) + 3 + i] = mu;
  }
  return CB_OK;
}

/* The normal compliance is S_ij = C_ij / sqrt(E_i E_j) with a unit diagonal in
 * C, so that the minors of C have no units and D_ij = sqrt(E_i E_j) C^-1_ij. */
enum cb_status cb_material_orthotropic(const double E[3], const double nu[3], const double G[3],
                                       double density, struct cb_material *m) {
  if (!is_positive(density)) return CB_INPUT;
  for (size_t i = 0; i < 3; i++)
    if (!is_positive(E[i]) || !is_positive(G[i]) || !isfinite(nu[i])) return CB_INPUT;

  double xy = -nu[0] * sqrt(E[1] / E[0]);
  double yz = -nu[1] * sqrt(E[2] / E[1]);
  double zx = -nu[2] * sqrt(E[0] / E[2]);
  double minor = 1 - xy * xy;
  double det = 1 + 2 * xy * yz * zx - xy * xy - yz * yz - zx * zx;
  if (!(minor > 0 && det > 0)) return CB_INPUT;

  const double adjugate[9] = {1 - yz * yz,  yz * zx - xy, xy * yz - zx, /* row x */
                              yz * zx - xy, 1 - zx * zx,  xy * zx - yz, /* row y */
                              xy * yz - zx, xy * zx - yz, minor};
  struct cb_material made = {.orthotropic = true, .density = density};
  for (size_t i = 0; i < 3; i++) {
    for (size_t j = 0; j < 3; j++) {
      double d = sqrt(E[i]) * sqrt(E[j]) * adjugate[3 * i + j] / det;
      if (!isfinite(d)) return CB_INPUT;
      made.D[6 * i + j] = d;
    }
    made.D[6 * (3 + i) + 3 + i] = G[i];
  }
  *m = made;
  return CB_OK;
}

double cb_mesh_six_volumes(const struct cb_mesh *mesh, size_t e) {
  const uint32_t *n = mesh->tet + 4 * e;
  const double *a = mesh->X + 3 * (size_t)n[0];
  double u[3][3];
  for (size_t j = 0; j < 3; j++)
    for (size_t k = 0; k < 3; k++) u[j][k] = mesh->X[3 * (size_t)n[j + 1] + k] - a[k];
  return u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) +
         u[0][1] * (u[1][2] * u[2][0] - u[1][0] * u[2][2]) +
         u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
}

void cb_mesh_mass(const struct cb_mesh *mesh, double density, double *mass) {
  memset(mass, 0, mesh->nodes * sizeof *mass);
  for (size_t e = 0; e < mesh->tets; e++) {
    double quarter = density * mesh->share * fabs(cb_mesh_six_volumes(mesh, e)) / 24;
    for (size_t j = 0; j < 4; j++) mass[mesh->tet[4 * e + j]] += quarter;
  }
}
