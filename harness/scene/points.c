/* points.c - see points.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/points.h"

#include <math.h>
#include <string.h>

#include "harness/files/mesh.h"

/* weight[4] of p in the tetrahedron; not finite without volume. */
static void weigh(const struct cb_mesh *mesh, const uint32_t *tet, const double *p,
                  double *weight) {
  const double *a = mesh->X + 3 * tet[0];
  double e[9], r[3], cof[9];
  for (int j = 0; j < 9; j++) e[j] = mesh->X[3 * tet[1 + j / 3] + j % 3] - a[j % 3];
  for (int k = 0; k < 3; k++) r[k] = p[k] - a[k];
  for (int j = 0; j < 3; j++) {
    const double *u = e + 3 * ((j + 1) % 3), *w = e + 3 * ((j + 2) % 3);
    for (int k = 0; k < 3; k++)
      cof[3 * j + k] = u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3];
  }
  const double volume = e[0] * cof[0] + e[1] * cof[1] + e[2] * cof[2];
  weight[0] = 1;
  for (int j = 0; j < 3; j++) {
    const double *c = cof + 3 * j;
    weight[j + 1] = (r[0] * c[0] + r[1] * c[1] + r[2] * c[2]) / volume;
    weight[0] -= weight[j + 1];
  }
}

static void place(const struct cb_point *point, const double *x, double *p) {
  for (int k = 0; k < 3; k++) {
    p[k] = 0;
    for (int j = 0; j < 4; j++) p[k] += point->weight[j] * x[3 * point->node[j] + k];
  }
}

/* The point with its negative weights taken away: on the tetrahedron's surface if it was
 * outside. */
static struct cb_point pulled_in(const struct cb_point *point) {
  struct cb_point in = *point;
  double sum = 0;
  for (int j = 0; j < 4; j++) sum += in.weight[j] = fmax(0, point->weight[j]);
  for (int j = 0; j < 4; j++) in.weight[j] /= sum;
  return in;
}

/* How far P is from the tetrahedron, at most, m^2; 0 inside, but for rounding. */
static double apart(const struct cb_mesh *mesh, const struct cb_point *point, const double *P) {
  const struct cb_point in = pulled_in(point);
  double q[3], sum = 0;
  place(&in, mesh->X, q);
  for (int k = 0; k < 3; k++) sum += (q[k] - P[k]) * (q[k] - P[k]);
  return sum;
}

/* P in the tetrahedron that comes nearest to it; where several hold it, as in both splits of
 * a cell, in the one that holds it deepest. */
static struct cb_point nearest(const struct cb_mesh *mesh, const double *P) {
  static const double ROUNDING = 1e-9;
  struct cb_point best = {{0}, {0}};
  double least = INFINITY, deepest = -INFINITY;
  for (size_t e = 0; e < mesh->tets; e++) {
    struct cb_point point;
    memcpy(point.node, mesh->tet + 4 * e, sizeof point.node);
    weigh(mesh, point.node, P, point.weight);
    const double *w = point.weight, depth = fmin(fmin(w[0], w[1]), fmin(w[2], w[3]));
    const double distance = depth > -ROUNDING ? 0 : apart(mesh, &point, P);
    if (!(distance < least || (distance == least && depth > deepest))) continue;
    least = distance;
    deepest = depth;
    best = point;
  }
  return best;
}

void cb_points_choose(const struct cb_mesh *mesh, double *P) {
  const struct cb_box box = cb_mesh_bounds(mesh);
  for (size_t n = 0; n < CB_POINTS; n++) {
    const size_t step[3] = {n % 4, n / 4 % 4, n / 16};
    double lattice[3];
    for (int k = 0; k < 3; k++)
      lattice[k] = box.low[k] + (box.high[k] - box.low[k]) * (double)step[k] / 3;
    const struct cb_point point = nearest(mesh, lattice), in = pulled_in(&point);
    place(&in, mesh->X, P + 3 * n);
  }
}

void cb_points_find(const struct cb_mesh *mesh, const double *P, struct cb_point *point) {
  for (size_t n = 0; n < CB_POINTS; n++) point[n] = nearest(mesh, P + 3 * n);
}

void cb_points_place(const struct cb_point *point, const double *x, double *p) {
  for (size_t n = 0; n < CB_POINTS; n++) place(&point[n], x, p + 3 * n);
}
