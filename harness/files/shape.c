/* shape.c - bodies with an implicit surface: smooth unions of ellipsoids.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/shape.h"

#include <math.h>
#include <string.h>

struct ellipsoid {
  double centre[3], radius[3];
  double lean; /* rad: its z axis leans to -x */
  int sides;   /* 2: mirrored in y as well */
  int sign;    /* -1: cut out */
};
struct cb_shape {
  const char *name;
  double blend; /* radius of the fillets */
  double low[3], high[3];
  size_t count;
  struct ellipsoid part[10];
};

static const struct cb_shape shapes[] = {{"rabbit",
                                          0.05,
                                          {-0.08, -0.32, -0.06},
                                          {1.08, 0.32, 1.12},
                                          9,
                                          {{{0.42, 0, 0.30}, {0.34, 0.22, 0.27}, 0, 1, 1},
                                           {{0.25, 0.10, 0.22}, {0.18, 0.13, 0.20}, 0, 2, 1},
                                           {{0.66, 0, 0.32}, {0.15, 0.15, 0.22}, -0.4, 1, 1},
                                           {{0.82, 0, 0.53}, {0.18, 0.145, 0.155}, 0, 1, 1},
                                           {{0.72, 0.085, 0.83}, {0.085, 0.08, 0.24}, 0.35, 2, 1},
                                           {{0.05, 0, 0.33}, {0.085, 0.08, 0.085}, 0, 1, 1},
                                           {{0.72, 0.09, 0.08}, {0.13, 0.07, 0.085}, 0, 2, 1},
                                           {{0.34, 0.16, 0.07}, {0.21, 0.085, 0.075}, 0, 2, 1},
                                           {{0.96, 0, 0.50}, {0.06, 0.07, 0.06}, 0, 1, 1}}},
                                         {"liver",
                                          0.08,
                                          {-0.06, -0.34, -0.06},
                                          {1.06, 0.34, 0.66},
                                          4,
                                          {{{0.32, 0, 0.30}, {0.33, 0.26, 0.27}, 0.2, 1, 1},
                                           {{0.70, 0.02, 0.38}, {0.31, 0.17, 0.14}, -0.2, 1, 1},
                                           {{0.50, -0.03, 0.38}, {0.26, 0.21, 0.17}, 0, 1, 1},
                                           {{0.46, 0, 0.02}, {0.16, 0.4, 0.13}, 0, 1, -1}}}};

const struct cb_shape *cb_shape_find(const char *name) {
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    if (strcmp(shapes[i].name, name) == 0) return &shapes[i];
  return NULL;
}

void cb_shape_bounds(const struct cb_shape *s, double low[3], double high[3]) {
  memcpy(low, s->low, sizeof s->low);
  memcpy(high, s->high, sizeof s->high);
}

/* About the distance to the ellipsoid, negative inside. */
static double distance(const struct ellipsoid *e, const double *p, double side) {
  double d[3] = {p[0] - e->centre[0], p[1] - side * e->centre[1], p[2] - e->centre[2]}, k = 0,
         g = 0;
  const double c = cos(e->lean), s = sin(e->lean);
  const double x = c * d[0] + s * d[2], z = c * d[2] - s * d[0];
  d[0] = x, d[2] = z;
  for (int i = 0; i < 3; i++) {
    const double q = d[i] / e->radius[i];
    k += q * q, g += q * q / (e->radius[i] * e->radius[i]);
  }
  k = sqrt(k), g = sqrt(g);
  const double least = fmin(e->radius[0], fmin(e->radius[1], e->radius[2]));
  return g > 0 ? k * (k - 1) / g : -least; /* Quilez: first order at the surface */
}

/* The smaller one, rounded off within `blend`. */
static double smooth_minimum(double a, double b, double blend) {
  const double h = fmax(0, blend - fabs(a - b)) / blend;
  return fmin(a, b) - h * h * blend / 4;
}

double cb_shape_value(const struct cb_shape *s, const double *p) {
  double f = INFINITY;
  for (size_t i = 0; i < s->count; i++)
    for (int side = 0; side < s->part[i].sides; side++) {
      const double d = distance(&s->part[i], p, side ? -1 : 1);
      f = !isfinite(f)          ? d
          : s->part[i].sign < 0 ? -smooth_minimum(-f, d, s->blend)
                                : smooth_minimum(f, d, s->blend);
    }
  return f;
}

static void gradient(const struct cb_shape *s, const double *p, double *g) {
  const double e = 1e-5;
  for (int k = 0; k < 3; k++) {
    double q[3] = {p[0], p[1], p[2]};
    q[k] += e;
    g[k] = cb_shape_value(s, q);
    q[k] -= 2 * e;
    g[k] = (g[k] - cb_shape_value(s, q)) / (2 * e);
  }
}

bool cb_shape_approach(const struct cb_shape *s, double reach, double *p) {
  double g[3];
  const double f = cb_shape_value(s, p);
  gradient(s, p, g);
  const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
  if (!(square > 0) || !(fabs(f) <= reach * sqrt(square))) return false;
  for (int k = 0; k < 3; k++) p[k] -= f * g[k] / square;
  return true;
}
