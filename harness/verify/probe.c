/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/probe.h"

#include <stdlib.h>

#include "harness/error.h"

enum cb_status cb_probe_open(const struct cb_variant *variant, const struct cb_mesh *mesh,
                             const struct cb_material *material, struct cb_probe *probe) {
  const struct cb_arithmetic *a = variant->arithmetic;
  struct cb_probe p = {.variant = variant, .nodes = mesh->nodes};
  char name[96];
  cb_variant_name(variant, name);
  enum cb_status status = cb_operator_create(variant, mesh, material, 1, 1, &p.op);
  size_t bytes = (mesh->nodes * a->stride * a->scalar_bytes / 64 + 2) * 64;
  p.x = aligned_alloc(64, bytes);
  p.out = aligned_alloc(64, bytes);
  if (!status && (!p.x || !p.out)) status = CB_MEMORY;
  if (!status) {
    *probe = p;
    return CB_OK;
  }
  cb_probe_close(&p);
  if (status == CB_MEMORY) return cb_fail_memory(name);
  return cb_fail(status, "%s cannot run on this mesh and material; choose another variant", name);
}

void cb_probe_close(struct cb_probe *p) {
  cb_operator_free(p->op);
  free(p->x);
  free(p->out);
  *p = (struct cb_probe){0};
}

void cb_probe_force(struct cb_probe *p, const double *x, double *f) {
  const struct cb_arithmetic *a = p->variant->arithmetic;
  a->from_double(p->nodes, x, p->x);
  cb_operator_update(p->op, p->x, NULL, 1, p->out);
  a->to_double(p->nodes, p->out, f);
}

void cb_probe_reset(struct cb_probe *p) { cb_operator_reset(p->op); }

void cb_probe_product(struct cb_probe *p, const double *u, double *y) {
  const struct cb_arithmetic *a = p->variant->arithmetic;
  a->from_double(p->nodes, u, p->x);
  cb_operator_product(p->op, p->x, p->out);
  a->to_double(p->nodes, p->out, y);
}
