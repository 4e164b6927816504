/* The block that is timed: fixed at its foot, twisted, shaken.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/order.h"

static const double HEIGHT = 0.1; /* m */
static const double TWIST = 0.5;  /* rad from foot to head */
static const double NOISE = 0.02; /* of a typical edge */

const size_t cb_bench_paper_cells[3] = {7, 7, 7};

void cb_bench_scene_free(struct cb_bench_scene *scene) {
  cb_mesh_free(&scene->mesh);
  free(scene->mass);
  free(scene->fixed);
  free(scene->x);
  free(scene->v);
  *scene = (struct cb_bench_scene){0};
}

/* Turn each node about the vertical axis through the middle, the higher the
 * more, and shake it. */
static void deform(struct cb_bench_scene *scene, gsl_rng *rng) {
  const struct cb_mesh *mesh = &scene->mesh;
  const struct cb_box box = cb_mesh_bounds(mesh);
  const double height = box.high[2] - box.low[2];
  const double volume = height * (box.high[0] - box.low[0]) * (box.high[1] - box.low[1]);
  const double shake = NOISE * cbrt(volume / (double)mesh->nodes);
  for (size_t i = 0; i < mesh->nodes; i++) {
    const double *X = mesh->X + 3 * i;
    double *x = scene->x + 3 * i, *v = scene->v + 3 * i;
    const double above = (X[2] - box.low[2]) / height, angle = TWIST * above;
    const double rx = X[0] - (box.low[0] + box.high[0]) / 2;
    const double ry = X[1] - (box.low[1] + box.high[1]) / 2;
    const double cosine = cos(angle), sine = sin(angle);
    x[0] = X[0] - rx + cosine * rx - sine * ry;
    x[1] = X[1] - ry + sine * rx + cosine * ry;
    x[2] = X[2];
    /* Nodes without mass belong to no element. */
    scene->fixed[i] = above < 1e-6 || !(scene->mass[i] > 0);
    for (int k = 0; k < 3; k++) {
      if (!scene->fixed[i]) x[k] += gsl_ran_gaussian(rng, shake);
      v[k] = x[k] - X[k]; /* as if it had come there within a second */
    }
  }
}

/* Everything but the mesh, which is taken over. */
static enum cb_status complete(unsigned long seed, struct cb_bench_scene *scene) {
  const size_t nodes = scene->mesh.nodes;
  scene->mass = malloc(nodes * sizeof *scene->mass);
  scene->fixed = malloc(nodes);
  scene->x = malloc(3 * nodes * sizeof *scene->x);
  scene->v = malloc(3 * nodes * sizeof *scene->v);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status = CB_OK;
  if (!scene->mass || !scene->fixed || !scene->x || !scene->v || !rng)
    status = cb_fail_memory("the scene");
  if (!status) status = cb_material_isotropic(1e5, 0.4, 1000, &scene->material);
  if (!status) {
    cb_mesh_mass(&scene->mesh, scene->material.density, scene->mass);
    gsl_rng_set(rng, seed);
    deform(scene, rng);
  }
  if (rng) gsl_rng_free(rng);
  if (status) cb_bench_scene_free(scene);
  return status;
}

enum cb_status cb_bench_scene_grid(const size_t cells[3], unsigned long seed,
                                   struct cb_bench_scene *scene) {
  struct cb_bench_scene made = {0};
  enum cb_status status =
      cb_mesh_grid(cells[0], cells[1], cells[2], HEIGHT / (double)cells[2], &made.mesh);
  if (!status) status = complete(seed, &made);
  if (!status) *scene = made;
  return status;
}

enum cb_status cb_bench_scene_irregular(const size_t cells[3], unsigned long seed,
                                        struct cb_bench_scene *scene) {
  struct cb_bench_scene made = {0};
  enum cb_status status =
      cb_mesh_irregular(cells[0], cells[1], cells[2], HEIGHT / (double)cells[2], seed, &made.mesh);
  if (status) return status;
  status = cb_order_apply(&made.mesh);
  if (!status) status = complete(seed, &made);
  if (status)
    cb_bench_scene_free(&made);
  else
    *scene = made;
  return status;
}

enum cb_status cb_bench_scene_mesh(const char *path, unsigned long seed,
                                   struct cb_bench_scene *scene) {
  struct cb_bench_scene made = {0};
  enum cb_status status = cb_mesh_read(path, &made.mesh, NULL);
  if (status) return status;
  const struct cb_box box = cb_mesh_bounds(&made.mesh);
  const double scale = HEIGHT / (box.high[2] - box.low[2]);
  if (!(scale > 0 && isfinite(scale))) {
    cb_mesh_free(&made.mesh);
    return cb_fail(CB_INPUT, "%s: the mesh has no height along z; give one of solid bodies", path);
  }
  for (size_t i = 0; i < 3 * made.mesh.nodes; i++) made.mesh.X[i] *= scale;
  status = cb_order_apply(&made.mesh);
  if (!status) status = complete(seed, &made);
  if (status)
    cb_bench_scene_free(&made);
  else
    *scene = made;
  return status;
}
