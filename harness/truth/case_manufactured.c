/* case_manufactured.c - linear elasticity on the unit cube with the solution
 *   u = (sin pi x sin pi y sin pi z, 0, 0)
 * and the body force that goes with it: with linear elements the error of u falls with
 * h^2, that of its gradient with h (Strang & Fix 1973).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/truth/truth.h"
#include "reference/equilibrium.h"

enum { POINTS = 4 }; /* Gauss points along each edge of a cube that is collapsed */
static const double YOUNG = 1, POISSON = 0.3;

static void exact(const double *p, double *u, double *gradient) {
  const double s[3] = {sin(M_PI * p[0]), sin(M_PI * p[1]), sin(M_PI * p[2])};
  const double c[3] = {cos(M_PI * p[0]), cos(M_PI * p[1]), cos(M_PI * p[2])};
  *u = s[0] * s[1] * s[2];
  gradient[0] = M_PI * c[0] * s[1] * s[2];
  gradient[1] = M_PI * s[0] * c[1] * s[2];
  gradient[2] = M_PI * s[0] * s[1] * c[2];
}

/* -(lambda + mu) grad div u - mu laplace u. */
static void body_force(const double *p, double *b) {
  const double mu = YOUNG / (2 * (1 + POISSON)), lambda = 2 * mu * POISSON / (1 - 2 * POISSON);
  const double s[3] = {sin(M_PI * p[0]), sin(M_PI * p[1]), sin(M_PI * p[2])};
  const double c[3] = {cos(M_PI * p[0]), cos(M_PI * p[1]), cos(M_PI * p[2])};
  const double square = M_PI * M_PI, both = lambda + mu;
  b[0] = square * (both + 3 * mu) * s[0] * s[1] * s[2];
  b[1] = -square * both * c[0] * c[1] * s[2];
  b[2] = -square * both * c[0] * s[1] * c[2];
}

/* Points of a tetrahedron: weight (of 1 together) and the four shape functions. */
struct rule {
  double weight[POINTS * POINTS * POINTS], N[POINTS * POINTS * POINTS][4];
};

static enum cb_status make_rule(struct rule *rule) {
  gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(POINTS);
  if (!gauss) return cb_fail_memory("the quadrature");
  for (size_t n = 0; n < POINTS * POINTS * POINTS; n++) {
    const size_t index[3] = {n % POINTS, n / POINTS % POINTS, n / (POINTS * POINTS)};
    double a[3], w[3];
    for (int k = 0; k < 3; k++) gsl_integration_glfixed_point(0, 1, index[k], &a[k], &w[k], gauss);
    /* x = a, y = b (1 - a), z = c (1 - a)(1 - b) (Duffy 1982) */
    const double x = a[0], y = a[1] * (1 - a[0]), z = a[2] * (1 - a[0]) * (1 - a[1]);
    rule->weight[n] = 6 * w[0] * w[1] * w[2] * (1 - a[0]) * (1 - a[0]) * (1 - a[1]);
    rule->N[n][0] = 1 - x - y - z, rule->N[n][1] = x, rule->N[n][2] = y, rule->N[n][3] = z;
  }
  gsl_integration_glfixed_table_free(gauss);
  return CB_OK;
}

static void point_at(const struct cb_mesh *mesh, size_t e, const double *N, double *p) {
  for (int k = 0; k < 3; k++) {
    p[k] = 0;
    for (int j = 0; j < 4; j++) p[k] += N[j] * mesh->X[3 * mesh->tet[4 * e + (size_t)j] + k];
  }
}

static void load(const struct cb_mesh *mesh, const struct rule *rule, double *external) {
  memset(external, 0, 3 * mesh->nodes * sizeof *external);
  for (size_t e = 0; e < mesh->tets; e++) {
    const double volume = mesh->share * fabs(cb_mesh_six_volumes(mesh, e)) / 6;
    for (size_t q = 0; q < POINTS * POINTS * POINTS; q++) {
      double p[3], b[3];
      point_at(mesh, e, rule->N[q], p);
      body_force(p, b);
      for (int j = 0; j < 4; j++)
        for (int k = 0; k < 3; k++)
          external[3 * mesh->tet[4 * e + (size_t)j] + k] +=
              volume * rule->weight[q] * rule->N[q][j] * b[k];
    }
  }
}

/* Gradients of the shape functions of b, c, d, rows. */
static void shape_gradients(const struct cb_mesh *mesh, size_t e, double *g) {
  double edge[9];
  for (int j = 0; j < 9; j++)
    edge[j] = mesh->X[3 * mesh->tet[4 * e + 1 + (size_t)j / 3] + j % 3] -
              mesh->X[3 * mesh->tet[4 * e] + j % 3];
  const double volume = cb_mesh_six_volumes(mesh, e);
  for (int j = 0; j < 3; j++) {
    const double *u = edge + 3 * ((j + 1) % 3), *v = edge + 3 * ((j + 2) % 3);
    for (int k = 0; k < 3; k++)
      g[3 * j + k] = (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]) / volume;
  }
}

/* L2 errors of u and of its gradient; d[3*nodes] displacements. */
static void errors(const struct cb_mesh *mesh, const struct rule *rule, const double *d,
                   double *displacement, double *gradient) {
  *displacement = *gradient = 0;
  for (size_t e = 0; e < mesh->tets; e++) {
    const double volume = mesh->share * fabs(cb_mesh_six_volumes(mesh, e)) / 6;
    double g[9], H[9] = {0};
    shape_gradients(mesh, e, g);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
          H[3 * i + k] += g[3 * j + k] * (d[3 * mesh->tet[4 * e + 1 + (size_t)j] + i] -
                                          d[3 * mesh->tet[4 * e] + i]);
    for (size_t q = 0; q < POINTS * POINTS * POINTS; q++) {
      double p[3], u[3], true_gradient[9] = {0};
      point_at(mesh, e, rule->N[q], p);
      exact(p, u, true_gradient);
      u[1] = u[2] = 0;
      for (int i = 0; i < 3; i++) {
        double value = 0;
        for (int j = 0; j < 4; j++)
          value += rule->N[q][j] * d[3 * mesh->tet[4 * e + (size_t)j] + i];
        *displacement += volume * rule->weight[q] * (value - u[i]) * (value - u[i]);
      }
      for (int i = 0; i < 9; i++)
        *gradient +=
            volume * rule->weight[q] * (H[i] - true_gradient[i]) * (H[i] - true_gradient[i]);
    }
  }
  *displacement = sqrt(*displacement), *gradient = sqrt(*gradient);
}

static enum cb_status solve(size_t cells, bool irregular, const struct rule *rule,
                            double *displacement, double *gradient) {
  struct cb_mesh mesh = {0};
  struct cb_material m;
  struct cb_newton newton;
  double *external = NULL, *x = NULL;
  uint8_t *fixed = NULL;
  const double cell = 1.0 / (double)cells;
  enum cb_status status = irregular ? cb_mesh_irregular(cells, cells, cells, cell, 2005, &mesh)
                                    : cb_mesh_grid(cells, cells, cells, cell, &mesh);
  if (!status) status = cb_material_isotropic(YOUNG, POISSON, 1, &m);
  if (status) goto done;
  external = malloc(3 * mesh.nodes * sizeof *external);
  x = malloc(3 * mesh.nodes * sizeof *x);
  fixed = malloc(mesh.nodes);
  if (!external || !x || !fixed) {
    status = cb_fail_memory("the manufactured solution");
    goto done;
  }
  for (size_t i = 0; i < mesh.nodes; i++) {
    fixed[i] = false;
    for (int k = 0; k < 3; k++)
      fixed[i] |= mesh.X[3 * i + k] < 1e-9 || mesh.X[3 * i + k] > 1 - 1e-9;
  }
  load(&mesh, rule, external);
  memcpy(x, mesh.X, 3 * mesh.nodes * sizeof *x);
  status =
      cb_equilibrium_solve("linear", CB_NEWTON_USUAL, &mesh, &m, fixed, external, 1e-9, x, &newton);
  if (status)
    status = cb_fail(status, "the manufactured solution could not be computed");
  else {
    for (size_t i = 0; i < 3 * mesh.nodes; i++) x[i] -= mesh.X[i];
    errors(&mesh, rule, x, displacement, gradient);
  }
done:
  free(external);
  free(x);
  free(fixed);
  cb_mesh_free(&mesh);
  return status;
}

enum cb_status cb_truth_manufactured(struct cb_truth *t) {
  static const size_t cells[3] = {4, 8, 16};
  struct rule rule;
  enum cb_status status = cb_truth_asked(t, "linear") ? make_rule(&rule) : CB_OK;
  for (int irregular = 0; !status && cb_truth_asked(t, "linear") && irregular < 2; irregular++) {
    double u[3], g[3];
    const char *mesh = irregular ? "irregular mesh" : "grid";
    char name[CB_TRUTH_NAME];
    for (size_t n = 0; !status && n < 3; n++)
      status = solve(cells[n], irregular, &rule, &u[n], &g[n]);
    for (int k = 0; !status && k < 2; k++) { /* L2, then H1 */
      const double *e = k ? g : u;
      snprintf(name, sizeof name, "manufactured, error in %s, %s", k ? "H1" : "L2", mesh);
      struct cb_truth_row row = cb_truth_row(name, "linear", "Strang & Fix 1973: order 2, 1");
      row.exact = 0, row.coarse = e[0], row.medium = e[1], row.fine = e[2];
      row.judged = row.order = cb_truth_order(0, e[1], e[2], 2);
      row.low = (k ? 1 : 2) - 0.15, row.high = (k ? 1 : 2) + 0.15;
      status = cb_truth_add(t, &row);
    }
  }
  return status;
}
