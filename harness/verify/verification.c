/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/verification.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/progress.h"

const char *const cb_material_name[CB_MATERIALS] = {"isotropic", "orthotropic"};

enum { RANDOM_ELEMENTS = 1000 };
static const double STRENGTH = 0.3; /* of node displacements, in edges */

enum cb_status cb_verification_material(int which, struct cb_material *m) {
  static const double E[3] = {1500, 500, 800}, nu[3] = {0.3, 0.2, 0.25}, G[3] = {400, 250, 300};
  return which == CB_ISOTROPIC ? cb_material_isotropic(1000, 0.3, 1000, m)
                               : cb_material_orthotropic(E, nu, G, 1000, m);
}

double cb_law_row_value(const struct cb_law_row *row) {
  return cb_worst(row->random.worst, row->mesh);
}

struct samples {
  struct cb_patches single, pair, mesh;
};

static void samples_free(struct samples *s) {
  cb_patches_free(&s->single);
  cb_patches_free(&s->pair);
  cb_patches_free(&s->mesh);
}

static enum cb_status samples_make(const struct cb_mesh *mesh, unsigned long seed,
                                   struct samples *s) {
  struct cb_mesh block = {0};
  enum cb_status status = CB_OK;
  if (!mesh) status = cb_mesh_grid(3, 3, 3, 0.1, &block);
  if (!status) status = cb_patches_random(RANDOM_ELEMENTS, 1, STRENGTH, seed, &s->single);
  if (!status) status = cb_patches_random(RANDOM_ELEMENTS, 2, STRENGTH, seed, &s->pair);
  if (!status) status = cb_patches_mesh(mesh ? mesh : &block, STRENGTH, seed, &s->mesh);
  cb_mesh_free(&block);
  return status;
}

/* All laws of one variant for one material into rows[CB_LAWS]. */
static enum cb_status measure(const struct cb_variant *variant, int which, const struct samples *s,
                              struct cb_law_row *rows) {
  struct cb_material m;
  struct cb_law_value random[CB_LAWS], mesh[CB_LAWS];
  /* what a node shares with its neighbours shows on pairs only */
  const struct cb_patches *elements = variant->model->node_frames ? &s->pair : &s->single;
  enum cb_status status = cb_verification_material(which, &m);
  if (!status) status = cb_laws_measure(variant, &m, elements, ~0u, random);
  if (!status) status = cb_laws_measure(variant, &m, &s->mesh, ~0u, mesh);
  for (int law = 0; law < CB_LAWS && !status; law++) {
    rows[law] = (struct cb_law_row){variant,
                                    which,
                                    (enum cb_law)law,
                                    random[law],
                                    mesh[law].worst,
                                    cb_law_limit(variant->arithmetic),
                                    variant->model->laws[which] & CB_KEEPS(law),
                                    false};
    rows[law].kept = cb_law_kept(cb_law_row_value(&rows[law]), rows[law].limit);
  }
  return status;
}

enum cb_status cb_verification_run(const struct cb_variant *const *variants, size_t count,
                                   const struct cb_mesh *mesh, unsigned long seed,
                                   struct cb_verification *v) {
  struct samples s = {0};
  struct cb_verification new = {0};
  enum cb_status status = samples_make(mesh, seed, &s);
  if (!status) {
    new.rows = calloc(count * CB_MATERIALS * CB_LAWS + 1, sizeof *new.rows);
    if (!new.rows) status = cb_fail_memory("the verification");
  }
  cb_progress_begin("laws", (double)(count * CB_MATERIALS));
  for (size_t n = 0; n < count * CB_MATERIALS && !status; n++) {
    const struct cb_variant *variant = variants[n / CB_MATERIALS];
    const int material = (int)(n % CB_MATERIALS);
    cb_progress((double)n, variant->model->name);
    if (!variant->model->form[variant->storage][material].update) continue; /* not offered */
    status = measure(variant, material, &s, new.rows + new.count);
    new.count += CB_LAWS;
  }
  cb_progress_end();
  samples_free(&s);
  if (status)
    cb_verification_free(&new);
  else
    *v = new;
  return status;
}

void cb_verification_free(struct cb_verification *v) {
  free(v->rows);
  *v = (struct cb_verification){0};
}

const struct cb_law_row *cb_verification_find(const struct cb_verification *v, const char *model,
                                              int material, enum cb_law law) {
  for (size_t i = 0; i < v->count; i++)
    if (v->rows[i].material == material && v->rows[i].law == law &&
        strcmp(v->rows[i].variant->model->name, model) == 0)
      return &v->rows[i];
  return NULL;
}
