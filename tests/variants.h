/* variants.h - a variant on a scene, put together by hand, with its vectors read
 * in quad precision, and how far two of them are apart in roundings.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_VARIANTS_H
#define CB_TESTS_VARIANTS_H

#include "tests/scene.h"

#include <stdio.h>

typedef __float128 quad;

/* f64 is the first arithmetic; the oracle of rounding the one that is in quad. */
static inline const struct cb_arithmetic *scene_f64(void) { return cb_arithmetics[0]; }
static inline const struct cb_arithmetic *scene_counted(void) {
  const struct cb_arithmetic *const *a = cb_arithmetics;
  while (*a && (*a)->scalar_bytes != sizeof(quad)) a++;
  assert_non_null(*a);
  return *a;
}

static inline const struct cb_model *scene_model(const struct cb_arithmetic *a, const char *name) {
  const struct cb_model *const *m = a->models;
  while (*m && strcmp((*m)->name, name) != 0) m++;
  if (!*m) fail_msg("no model %s", name);
  return *m;
}

static inline void *vector_new(const struct cb_arithmetic *a, size_t nodes, const double *xyz) {
  void *v = aligned_alloc(64, (nodes * a->stride * a->scalar_bytes / 64 + 1) * 64);
  assert_non_null(v);
  if (xyz) a->from_double(nodes, xyz, v);
  return v;
}

/* out[3*nodes] := v, without rounding. */
static inline void vector_read(const struct cb_arithmetic *a, size_t nodes, const void *v,
                               quad *out) {
  if (a->scalar_bytes == sizeof(quad)) {
    for (size_t i = 0; i < 3 * nodes; i++) out[i] = ((const quad *)v)[i / 3 * a->stride + i % 3];
    return;
  }
  double *d = malloc(3 * nodes * sizeof *d);
  assert_non_null(d);
  a->to_double(nodes, v, d);
  for (size_t i = 0; i < 3 * nodes; i++) out[i] = d[i];
  free(d);
}

/* A variant on a scene's mesh, with its vectors. */
struct run {
  struct cb_variant variant;
  struct cb_operator *op;
  size_t nodes;
  void *x, *v, *u, *out;
  char name[96];
};

/* r stays where it is: the operator keeps the address of its variant. */
static inline void run_open(struct run *r, const struct scene *s, const struct cb_variant *variant,
                            const struct cb_material *material, double c) {
  const struct cb_arithmetic *a = variant->arithmetic;
  *r = (struct run){.variant = *variant, .nodes = s->mesh.nodes};
  cb_variant_name(variant, r->name);
  assert_int_equal(cb_operator_create(&r->variant, &s->mesh, material, c, 1, &r->op), CB_OK);
  r->x = vector_new(a, r->nodes, s->x);
  r->v = vector_new(a, r->nodes, s->v);
  r->u = vector_new(a, r->nodes, s->u);
  r->out = vector_new(a, r->nodes, NULL);
}

static inline void run_close(struct run *r) {
  cb_operator_free(r->op);
  free(r->x);
  free(r->v);
  free(r->u);
  free(r->out);
}

/* out := h f(x) - c K v (v NULL: h f), with frames that start cold. */
static inline void run_update(struct run *r, const void *v, double h, quad *out) {
  cb_operator_reset(r->op);
  cb_operator_update(r->op, r->x, v, h, r->out);
  vector_read(r->variant.arithmetic, r->nodes, r->out, out);
}

static inline void run_product(struct run *r, const void *u, quad *out) {
  cb_operator_product(r->op, u, r->out);
  vector_read(r->variant.arithmetic, r->nodes, r->out, out);
}

static inline quad *quads_new(size_t n) {
  quad *q = calloc(n, sizeof *q);
  assert_non_null(q);
  return q;
}

/* Squares summed in quad, so that differences of quad's size do not vanish. */
static inline double quad_norm(size_t n, const quad *a) {
  quad sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * a[i];
  return sqrt((double)sum);
}

static inline double quad_distance(size_t n, const quad *a, const quad *b) {
  quad sum = 0;
  for (size_t i = 0; i < n; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt((double)sum);
}

/* |a - b| <= limit units of roundoff times condition of |b|. */
static inline void assert_rounding(const char *what, size_t n, const quad *a, const quad *b,
                                   double roundoff, double condition, double limit) {
  double size = quad_norm(n, b);
  assert_true(size > 0);
  assert_within(what, quad_distance(n, a, b) / (size * roundoff * condition), limit);
}

#endif
