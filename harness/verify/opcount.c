/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/opcount.h"

#include <math.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/verify/probe.h"

const char *const cb_stage_name[STAGES] = {"rest",  "scatter",  "frame",  "strain-displacement",
                                           "force", "assembly", "product"};

static enum cb_status sample_mesh(const struct cb_variant *v, struct cb_mesh *mesh) {
  static const double X[12] = {0, 0, 0, 1, 0.1, 0, 0.2, 1, 0.1, 0.3, 0.2, 1};
  if (v->storage >= CB_CSR || v->model->node_frames)
    return cb_mesh_grid(7, 7, 7, 1, mesh);
  enum cb_status status = cb_mesh_allocate(4, 1, mesh);
  for (uint32_t i = 0; i < 12 && !status; i++) mesh->X[i] = X[i], mesh->tet[i % 4] = i % 4;
  return status;
}

enum cb_status cb_operations_count(const struct cb_variant *variant,
                                   struct cb_operations *operations) {
  struct cb_material material;
  struct cb_mesh mesh = {0};
  struct cb_probe probe = {0};
  struct cb_counts counts[STAGES];
  double *x = NULL, *f;
  if (!cb_counter_works())
    return cb_fail(CB_BROKEN, "operations are not counted: link with the Makefile's COUNT flags");
  enum cb_status status = cb_material_isotropic(1, 0.3, 1, &material);
  if (!status) status = sample_mesh(variant, &mesh);
  if (!status) status = cb_probe_open(variant, &mesh, &material, &probe);
  if (status) goto done;
  size_t length = 3 * mesh.nodes;
  x = calloc(2 * length, sizeof *x);
  if (!x) {
    status = cb_fail_memory("the operation counts");
    goto done;
  }
  f = x + length;
  for (size_t i = 0; i < length; i++) x[i] = mesh.X[i] + 0.05 * sin((double)(7 * i));
  cb_probe_force(&probe, x, f); /* warm */
  cb_counter_reset();
  cb_probe_force(&probe, x, f);
  cb_probe_product(&probe, x, f);
  cb_counter_read(counts);
  for (int s = 0; s < STAGES; s++) {
    double n = (double)mesh.tets;
    operations[s] = (struct cb_operations){(double)counts[s].mul / n, (double)counts[s].add / n,
                                           (double)counts[s].div / n, (double)counts[s].sqrt / n};
  }
done:
  cb_probe_close(&probe);
  cb_mesh_free(&mesh);
  free(x);
  return status;
}

enum cb_status cb_operations_table(struct cb_table *table, const struct cb_variant *variant) {
  struct cb_operations operations[STAGES];
  enum cb_status status = cb_operations_count(variant, operations);
  for (int stage = 0; stage < STAGES && !status; stage++) {
    cb_table_text(table, variant->model->name);
    cb_table_text(table, cb_storage_name[variant->storage]);
    cb_table_text(table, cb_stage_name[stage]);
    cb_table_number(table, operations[stage].mul);
    cb_table_number(table, operations[stage].add);
    cb_table_number(table, operations[stage].div);
    cb_table_number(table, operations[stage].sqrt);
  }
  return status;
}
