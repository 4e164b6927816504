/* energy.c - see energy.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/energy.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

/* Rows b-a, c-a, d-a of a tetrahedron. */
static void edges(const double *x, const uint32_t *tet, double *e) {
  for (int j = 0; j < 9; j++) e[j] = x[3 * tet[1 + j / 3] + j % 3] - x[3 * tet[0] + j % 3];
}

/* c rows: cofactors of the rows of e; returns det e. */
static double cofactors(const double *e, double *c) {
  for (int j = 0; j < 3; j++) {
    const double *u = e + 3 * ((j + 1) % 3), *w = e + 3 * ((j + 2) % 3);
    for (int k = 0; k < 3; k++)
      c[3 * j + k] = u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3];
  }
  return e[0] * c[0] + e[1] * c[1] + e[2] * c[2];
}

/* s[3] := singular values of F, descending, the last with the sign of det F. */
static void stretches(const double *X, const double *x, const uint32_t *tet, double *s) {
  double E[9], e[9], C[9], c[9], F[9], V[9];
  edges(X, tet, E);
  edges(x, tet, e);
  const double volume = cofactors(E, C);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      F[3 * i + k] = 0;
      for (int j = 0; j < 3; j++) F[3 * i + k] += e[3 * j + i] * C[3 * j + k] / volume;
    }
  const double det = cofactors(F, c);
  gsl_matrix_view A = gsl_matrix_view_array(F, 3, 3), B = gsl_matrix_view_array(V, 3, 3);
  gsl_vector_view S = gsl_vector_view_array(s, 3);
  gsl_linalg_SV_decomp_jacobi(&A.matrix, &B.matrix, &S.vector);
  if (det < 0) s[2] = -s[2];
}

double cb_elastic_energy(const struct cb_mesh *mesh, const struct cb_material *material,
                         const double *x, size_t *inverted) {
  const double mu = material->young / (2 * (1 + material->poisson));
  const double lambda = 2 * mu * material->poisson / (1 - 2 * material->poisson);
  double energy = 0;
  size_t count = 0;
  for (size_t e = 0; e < mesh->tets; e++) {
    double s[3], squares = 0, trace = 0;
    stretches(mesh->X, x, mesh->tet + 4 * e, s);
    count += s[2] < 0;
    for (int i = 0; i < 3; i++) {
      squares += (s[i] - 1) * (s[i] - 1);
      trace += s[i] - 1;
    }
    energy += mesh->share * fabs(cb_mesh_six_volumes(mesh, e)) / 6 *
              (mu * squares + lambda / 2 * trace * trace);
  }
  if (inverted) *inverted = count;
  return energy;
}
