/* laws_operator.c - laws of the operator K: symmetric, positive semi-definite,
 * the derivative of the force.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/verify/law_session.h"
#include "reference/oracles.h"

enum {
  PROBES = 16, /* random vectors where K is too large to decompose */
  DENSE_NODES = 5,
  TANGENT_PATCHES = 100 /* quad precision is slow */
};

/* K[count][d*d] of small patches, column j of all at once. */
static double *dense(struct cb_law_session *s, size_t d) {
  double *K = calloc(s->p->count, d * d * sizeof *K);
  if (!K) return NULL;
  cb_law_force(&s->probe, s->p->before, s->p->x, s->g);
  for (size_t j = 0; j < d; j++) {
    for (size_t i = 0; i < d * s->p->count; i++) s->u[i] = i % d == j;
    cb_probe_product(&s->probe, s->u, s->g);
    for (size_t i = 0; i < d * s->p->count; i++) K[i / d * d * d + i % d * d + j] = s->g[i];
  }
  return K;
}

static enum cb_status measure_dense(struct cb_law_session *s, bool semidefinite) {
  size_t d = 3 * s->p->nodes;
  double eigen[3 * DENSE_NODES], *K = dense(s, d);
  enum cb_status status = K ? CB_OK : cb_fail_memory("the laws");
  for (size_t n = 0; n < s->p->count && !status; n++) {
    double *A = K + n * d * d, skew = 0, size = 0;
    for (size_t i = 0; i < d; i++)
      for (size_t j = 0; j < d; j++) {
        skew += pow(A[i * d + j] - A[j * d + i], 2);
        size += pow(A[i * d + j], 2);
      }
    s->value[n] = sqrt(skew / size);
    if (!semidefinite || !isfinite(size)) continue;
    for (size_t i = 0; i < d; i++) /* the quadratic form sees the symmetric part */
      for (size_t j = 0; j < i; j++) A[i * d + j] = (A[i * d + j] + A[j * d + i]) / 2;
    status = cb_oracle_eigenvalues(d, A, eigen);
    if (status == CB_MEMORY) cb_fail_memory("the laws");
    s->value[n] = fmax(0, -eigen[0]) / fmax(-eigen[0], eigen[d - 1]);
  }
  free(K);
  return status;
}

/* A large patch: u . K w - w . K u, and the least u . K u, over random u, w. */
static enum cb_status measure_probes(struct cb_law_session *s, bool semidefinite) {
  size_t length = 3 * s->p->mesh.nodes;
  double worst = 0, *w = calloc(2 * length, sizeof *w), *Kw = w + length;
  if (!w) return cb_fail_memory("the laws");
  cb_law_force(&s->probe, s->p->before, s->p->x, s->g);
  for (int k = 0; k < PROBES; k++) {
    double uKw = 0, wKu = 0, uKu = 0, uu = 0, ww = 0, KuKu = 0;
    for (size_t i = 0; i < length; i++)
      s->u[i] = gsl_ran_gaussian(s->rng, 1), w[i] = gsl_ran_gaussian(s->rng, 1);
    cb_probe_product(&s->probe, s->u, s->g);
    cb_probe_product(&s->probe, w, Kw);
    for (size_t i = 0; i < length; i++) {
      uKw += s->u[i] * Kw[i], wKu += w[i] * s->g[i], uKu += s->u[i] * s->g[i];
      uu += s->u[i] * s->u[i], ww += w[i] * w[i], KuKu += s->g[i] * s->g[i];
    }
    double value =
        semidefinite ? fmax(0, -uKu / sqrt(uu * KuKu)) : fabs(uKw - wKu) / sqrt(ww * KuKu);
    if (isnan(uKu)) value = NAN; /* fmax would hide it */
    worst = cb_worst(worst, value);
  }
  s->value[0] = worst;
  free(w);
  return CB_OK;
}

static enum cb_status measure(struct cb_law_session *s, bool semidefinite) {
  return s->p->nodes <= DENSE_NODES ? measure_dense(s, semidefinite)
                                    : measure_probes(s, semidefinite);
}

enum cb_status cb_law_symmetric(struct cb_law_session *s) { return measure(s, false); }

enum cb_status cb_law_semidefinite(struct cb_law_session *s) { return measure(s, true); }

/* ---- the operator against the derivative of the force, in quad ------------- */

typedef __float128 quad;

struct tangent {
  struct cb_operator *op;
  size_t length;
  quad *x, *u, *f, *K; /* K u, then K u + df/dx u */
};

/* t->f, t->K := df/dx along u, and its difference to -K u. */
static void quad_difference(struct tangent *t, quad step) {
  cb_operator_reset(t->op);
  cb_operator_update(t->op, t->x, NULL, 1, t->f);
  cb_operator_product(t->op, t->u, t->K);
  for (int side = 1; side >= -1; side -= 2) {
    quad *out = side == 1 ? t->f : t->x + t->length;
    for (size_t i = 0; i < t->length; i++) t->x[i] += (quad)side * step * t->u[i];
    cb_operator_reset(t->op);
    cb_operator_update(t->op, t->x, NULL, 1, out);
    for (size_t i = 0; i < t->length; i++) t->x[i] -= (quad)side * step * t->u[i];
  }
  for (size_t i = 0; i < t->length; i++) {
    t->f[i] = (t->f[i] - t->x[t->length + i]) / (2 * step);
    t->K[i] += t->f[i];
  }
}

static const struct cb_variant *in_quad(const struct cb_variant *v) {
  for (const struct cb_variant *q = cb_variants(NULL); q->model; q++)
    if (strcmp(q->arithmetic->name, "counted") == 0 && q->storage == v->storage &&
        strcmp(q->model->name, v->model->name) == 0)
      return q;
  return NULL;
}

enum cb_status cb_law_tangent(struct cb_law_session *s, const struct cb_material *material,
                              size_t *measured) {
  size_t count = s->p->count < TANGENT_PATCHES ? s->p->count : TANGENT_PATCHES;
  size_t d = 3 * s->p->nodes, dofs = s->p->nodes <= DENSE_NODES ? d : 1;
  struct cb_mesh mesh = s->p->mesh;
  struct tangent t = {.length = count * d};
  mesh.nodes = count * s->p->nodes, mesh.tets = count * s->p->tets;
  double *wrong = calloc(2 * count, sizeof *wrong), *size = wrong + count;
  quad *vectors = calloc(5 * t.length, sizeof *vectors);
  enum cb_status status = CB_MEMORY;
  if (wrong && vectors)
    status = cb_operator_create(in_quad(s->probe.variant), &mesh, material, 1, 1, &t.op);
  if (status) goto done;
  t.x = vectors, t.u = t.x + 2 * t.length, t.f = t.u + t.length, t.K = t.f + t.length;
  for (size_t i = 0; i < t.length; i++) t.x[i] = s->p->x[i];
  for (size_t j = 0; j < dofs && !cb_interrupted(); j++) {
    for (size_t i = 0; i < t.length; i++)
      t.u[i] = dofs == 1 ? gsl_ran_gaussian(s->rng, 1) : i % d == j;
    quad_difference(&t, (quad)1e-10 * (quad)s->p->size);
    for (size_t i = 0; i < t.length; i++) {
      wrong[i / d] += (double)(t.K[i] * t.K[i]);
      size[i / d] += (double)(t.f[i] * t.f[i]);
    }
  }
  for (size_t n = 0; n < count; n++) s->value[n] = sqrt(wrong[n] / size[n]);
  *measured = count;
done:
  cb_operator_free(t.op);
  free(wrong);
  free(vectors);
  return status == CB_MEMORY ? cb_fail_memory("the laws") : status;
}
