/* block.h - a small block of tetrahedra that steps: masses, fixed nodes, loads,
 * and a stepper of any variant on it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_BLOCK_H
#define CB_TESTS_BLOCK_H

#include "tests/variants.h"

enum { NODES = 12 };

/* A small block that moves: masses, two fixed nodes, a load on every node. */
struct block {
  struct scene scene;
  struct cb_material material;
  double mass[NODES];
  uint8_t fixed[NODES];
  double *load; /* [3*nodes] */
};

static inline void block_open(gsl_rng *rng, bool ortho, struct block *b) {
  *b = (struct block){.scene = scene_new(rng, SCENE_GRID), .material = scene_material(ortho)};
  size_t nodes = b->scene.mesh.nodes;
  assert_int_equal(nodes, NODES);
  b->load = malloc(3 * nodes * sizeof *b->load);
  assert_non_null(b->load);
  random_vector(rng, 3 * nodes, b->load);
  for (size_t i = 0; i < 3 * nodes; i++) b->load[i] *= 100;
  cb_mesh_mass(&b->scene.mesh, b->material.density, b->mass);
  b->fixed[2] = b->fixed[NODES - 1] = 1;
  for (size_t i = 0; i < 3 * nodes; i++)
    if (b->fixed[i / 3]) b->scene.v[i] = 0;
}

static inline void block_close(struct block *b) {
  scene_free(&b->scene);
  free(b->load);
}

/* A stepper on a variant, and its vectors: x, v of r and f. */
struct walk {
  struct run r;
  struct cb_stepper *stepper;
  void *f;
};

static inline void walk_open(struct walk *w, const struct block *b, const struct cb_variant *v,
                             const struct cb_step_parameters *p, const uint8_t *fixed) {
  run_open(&w->r, &b->scene, v, &b->material, cb_step_scale(p));
  assert_int_equal(cb_stepper_create(w->r.op, p, b->mass, fixed, &w->stepper), CB_OK);
  w->f = vector_new(v->arithmetic, b->scene.mesh.nodes, b->load);
}

static inline void walk_close(struct walk *w) {
  cb_stepper_free(w->stepper);
  run_close(&w->r);
  free(w->f);
}

static inline struct cb_variant f64_variant(const char *model, enum cb_storage storage) {
  return (struct cb_variant){scene_model(scene_f64(), model), storage, scene_f64()};
}

static const struct cb_step_parameters damped[] = {
    {.h = 0.02, .alpha = 0, .beta = 0, .iterations = 400},
    {.h = 0.02, .alpha = 0.05, .beta = 0, .iterations = 400},
    {.h = 0.02, .alpha = 0, .beta = 3, .iterations = 400},
    {.h = 0.01, .alpha = 0.003, .beta = 0.7, .iterations = 400}};

#endif
