/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/law_session.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"

/* The integrand is smooth and periodic: the trapezoid rule converges geometrically. */
enum { PATH_POINTS = 128 };

double cb_law_limit(const struct cb_arithmetic *arithmetic) { return 1e6 * arithmetic->roundoff; }

bool cb_law_kept(double value, double limit) { return value <= limit; }

double cb_worst(double a, double b) { return isnan(a) || a > b ? a : b; }

static double norm3(const double *a) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

static size_t first(const struct cb_law_session *s, size_t patch) {
  return 3 * patch * s->p->nodes;
}

/* |a - b| / |scale| over the components of one patch. */
static double difference(const struct cb_law_session *s, size_t patch, const double *a,
                         const double *b, const double *scale) {
  double d = 0, n = 0;
  for (size_t i = first(s, patch); i < first(s, patch + 1); i++) {
    d += (a[i] - b[i]) * (a[i] - b[i]);
    n += scale[i] * scale[i];
  }
  return sqrt(d / n);
}

void cb_law_force(struct cb_probe *probe, const double *before, const double *x, double *f) {
  cb_probe_reset(probe);
  cb_probe_force(probe, before, f);
  cb_probe_force(probe, x, f);
}

/* out := Q in + t for every node of every patch, Q and t by patch; turn: no t. */
static void move(const struct cb_law_session *s, const double *Q, const double *t, const double *in,
                 double *out) {
  for (size_t n = 0; n < s->p->count; n++)
    for (size_t i = first(s, n); i < first(s, n + 1); i++) {
      const double *row = Q + 9 * n + 3 * (i % 3), *node = in + i - i % 3;
      out[i] = row[0] * node[0] + row[1] * node[1] + row[2] * node[2] + (t ? t[3 * n + i % 3] : 0);
    }
}

static enum cb_status measure_rotation(struct cb_law_session *s) {
  size_t count = s->p->count, length = 3 * s->p->mesh.nodes;
  double *Q = calloc(count, 9 * sizeof *Q), *q = calloc(count, 9 * sizeof *q);
  double *t = calloc(count, 3 * sizeof *t), *b = calloc(length, sizeof *b);
  double *turned = calloc(length, sizeof *turned);
  enum cb_status status = Q && q && t && b && turned ? CB_OK : cb_fail_memory("the laws");
  if (status) goto done;
  for (size_t n = 0; n < count; n++) {
    double u[3], d[9];
    for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(s->rng);
    cb_random_rotation(u, -1, Q + 9 * n);
    for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(s->rng);
    cb_random_rotation(u, 0.05, d);
    for (int i = 0; i < 3; i++) t[3 * n + (size_t)i] = gsl_ran_gaussian(s->rng, s->p->size);
    for (int i = 0; i < 9; i++) /* q: Q a little earlier */
      q[9 * n + (size_t)i] = Q[9 * n + (size_t)(i / 3 * 3)] * d[i % 3] +
                             Q[9 * n + (size_t)(i / 3 * 3 + 1)] * d[3 + i % 3] +
                             Q[9 * n + (size_t)(i / 3 * 3 + 2)] * d[6 + i % 3];
  }
  move(s, Q, t, s->p->before, b);
  move(s, Q, t, s->p->x, s->x);
  cb_law_force(&s->probe, b, s->x, s->g);
  move(s, Q, NULL, s->f, turned);
  for (size_t n = 0; n < count; n++) s->value[n] = difference(s, n, s->g, turned, s->f);
  move(s, q, t, s->p->mesh.X, b);
  move(s, Q, t, s->p->mesh.X, s->x);
  cb_law_force(&s->probe, b, s->x, s->g);
  memset(turned, 0, length * sizeof *turned);
  for (size_t n = 0; n < count; n++) {
    double rest = difference(s, n, s->g, turned, s->f);
    s->value[n] = cb_worst(s->value[n], rest);
  }
done:
  free(Q), free(q), free(t), free(b), free(turned);
  return status;
}

static void measure_newton_euler(struct cb_law_session *s, bool euler) {
  const double *x = s->p->x, *f = s->f;
  for (size_t n = 0; n < s->p->count; n++) {
    double sum[3] = {0}, size = 0, c[3] = {0};
    for (size_t i = first(s, n); i < first(s, n + 1); i++) c[i % 3] += x[i] / (double)s->p->nodes;
    for (size_t i = first(s, n); i < first(s, n + 1); i += 3) {
      double r[3] = {x[i] - c[0], x[i + 1] - c[1], x[i + 2] - c[2]};
      double torque[3] = {r[1] * f[i + 2] - r[2] * f[i + 1], r[2] * f[i] - r[0] * f[i + 2],
                          r[0] * f[i + 1] - r[1] * f[i]};
      for (int k = 0; k < 3; k++) sum[k] += euler ? torque[k] : f[i + (size_t)k];
      size += euler ? norm3(r) * norm3(f + i) : norm3(f + i);
    }
    s->value[n] = norm3(sum) / size;
  }
}

static enum cb_status measure_energy(struct cb_law_session *s) {
  size_t length = 3 * s->p->mesh.nodes, count = s->p->count;
  double *work = calloc(2 * count, sizeof *work), *total = work + count;
  if (!work) return cb_fail_memory("the laws");
  cb_probe_reset(&s->probe);
  for (int k = -1; k < PATH_POINTS; k++) { /* the first one only warms frames up */
    double t = 2 * M_PI * k / PATH_POINTS, c = cos(t), d = sin(t);
    for (size_t i = 0; i < length; i++)
      s->x[i] = s->p->mesh.X[i] + c * s->p->cosine[i] + d * s->p->sine[i];
    cb_probe_force(&s->probe, s->x, s->g);
    for (size_t n = 0; n < count && k >= 0; n++) {
      double power = 0;
      for (size_t i = first(s, n); i < first(s, n + 1); i++)
        power += s->g[i] * (c * s->p->sine[i] - d * s->p->cosine[i]);
      work[n] += power;
      total[n] += fabs(power);
    }
  }
  for (size_t n = 0; n < count; n++) s->value[n] = fabs(work[n]) / total[n];
  free(work);
  return CB_OK;
}

/* The vertices of element t in one of their 24 orders. */
static void relabel(const uint32_t *tet, size_t order, uint32_t *out) {
  uint32_t left[4];
  memcpy(left, tet, sizeof left);
  for (size_t j = 0, k = 4; j < 4; j++, k--) {
    size_t pick = order % k;
    order /= k;
    out[j] = left[pick];
    memmove(left + pick, left + pick + 1, (k - pick - 1) * sizeof *left);
  }
}

static enum cb_status measure_order(struct cb_law_session *s, const struct cb_material *material) {
  struct cb_mesh mesh = s->p->mesh;
  struct cb_probe probe = {0};
  mesh.tet = calloc(mesh.tets, 4 * sizeof *mesh.tet);
  if (!mesh.tet) return cb_fail_memory("the laws");
  for (size_t t = 0; t < mesh.tets; t++)
    relabel(s->p->mesh.tet + 4 * t, 1 + t % 23, mesh.tet + 4 * t);
  enum cb_status status = cb_probe_open(s->probe.variant, &mesh, material, &probe);
  free(mesh.tet);
  if (status) return status;
  cb_law_force(&probe, s->p->before, s->p->x, s->g);
  for (size_t n = 0; n < s->p->count; n++) s->value[n] = difference(s, n, s->g, s->f, s->f);
  cb_probe_close(&probe);
  return CB_OK;
}

/* ---------------------------------------------------------------------------- */

static enum cb_status measure(struct cb_law_session *s, const struct cb_material *material,
                              enum cb_law law, size_t *measured) {
  switch (law) {
  case CB_LAW_ROTATION: return measure_rotation(s);
  case CB_LAW_NEWTON: measure_newton_euler(s, false); return CB_OK;
  case CB_LAW_EULER: measure_newton_euler(s, true); return CB_OK;
  case CB_LAW_ENERGY: return measure_energy(s);
  case CB_LAW_ORDER: return measure_order(s, material);
  case CB_LAW_SYMMETRIC: return cb_law_symmetric(s);
  case CB_LAW_SEMIDEFINITE: return cb_law_semidefinite(s);
  case CB_LAW_TANGENT: return cb_law_tangent(s, material, measured);
  case CB_LAWS: break;
  }
  return CB_INPUT;
}

static struct cb_law_value summary(double *value, size_t count) {
  struct cb_law_value v = {0, 0};
  for (size_t n = 0; n < count; n++) v.worst = cb_worst(v.worst, value[n]);
  if (isnan(v.worst)) return (struct cb_law_value){NAN, NAN};
  gsl_sort(value, 1, count);
  v.median = gsl_stats_median_from_sorted_data(value, 1, count);
  return v;
}

enum cb_status cb_laws_measure(const struct cb_variant *variant, const struct cb_material *material,
                               const struct cb_patches *patches, unsigned laws,
                               struct cb_law_value *values) {
  size_t length = 3 * patches->mesh.nodes;
  struct cb_law_session s = {.p = patches, .rng = gsl_rng_alloc(gsl_rng_mt19937)};
  double *vectors = calloc(4 * length + patches->count, sizeof *vectors);
  enum cb_status status = CB_MEMORY;
  if (!s.rng || !vectors) {
    cb_fail_memory("the laws");
    goto done;
  }
  s.f = vectors, s.g = s.f + length, s.x = s.g + length, s.u = s.x + length;
  s.value = s.u + length;
  status = cb_probe_open(variant, &patches->mesh, material, &s.probe);
  if (status) goto done;
  cb_law_force(&s.probe, patches->before, patches->x, s.f);
  for (int law = 0; law < CB_LAWS && !status; law++) {
    size_t measured = patches->count;
    if (!(laws & CB_KEEPS(law))) continue;
    if (cb_interrupted())
      status = cb_fail(CB_INTERRUPTED, "interrupted while measuring laws");
    else
      status = measure(&s, material, (enum cb_law)law, &measured);
    if (!status) values[law] = summary(s.value, measured);
  }
done:
  cb_probe_close(&s.probe);
  if (s.rng) gsl_rng_free(s.rng);
  free(vectors);
  return status;
}
