/* operator.c - a variant on a mesh: the arithmetic's element arrays behind one
 * plain C interface. Without stiffness (E = 0) there is nothing to run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "kernels/arithmetics.h"

struct cb_operator {
  const struct cb_variant *variant;
  struct cb_form form;
  struct cb_elements *elements;
  size_t nodes, vector_bytes;
  bool slack; /* no stiffness */
};

enum cb_status cb_operator_create(const struct cb_variant *variant, const struct cb_mesh *mesh,
                                  const struct cb_material *material, double c,
                                  struct cb_operator **out) {
  struct cb_form form = variant->model->form[variant->storage][material->orthotropic];
  if (!form.update || !(c > 0) || mesh->tets == 0) return CB_INPUT;
  struct cb_operator *op = calloc(1, sizeof *op);
  if (!op) return CB_MEMORY;
  *op = (struct cb_operator){.variant = variant, .form = form};
  op->slack = !material->orthotropic && material->young == 0;
  op->nodes = mesh->nodes;
  op->vector_bytes = mesh->nodes * variant->arithmetic->stride * variant->arithmetic->scalar_bytes;
  enum cb_status status =
      variant->arithmetic->elements->create(variant, mesh, material, c, &op->elements);
  if (status)
    free(op);
  else
    *out = op;
  return status;
}

void cb_operator_free(struct cb_operator *op) {
  if (!op) return;
  op->variant->arithmetic->elements->free(op->elements);
  free(op);
}

void cb_operator_update(struct cb_operator *op, const void *x, const void *v, double h, void *out) {
  if (op->slack)
    memset(out, 0, op->vector_bytes);
  else
    op->form.update(op->elements, x, v, h, out);
}

void cb_operator_product(const struct cb_operator *op, const void *u, void *y) {
  if (op->slack)
    memset(y, 0, op->vector_bytes);
  else
    op->form.product(op->elements, u, y);
}

void cb_operator_reset(struct cb_operator *op) {
  op->variant->arithmetic->elements->reset(op->elements);
}

size_t cb_operator_bytes(const struct cb_operator *op) {
  return op->variant->arithmetic->elements->bytes(op->elements);
}

const struct cb_variant *cb_operator_variant(const struct cb_operator *op) { return op->variant; }

size_t cb_operator_nodes(const struct cb_operator *op) { return op->nodes; }

void cb_operator_pattern(const struct cb_operator *op, const uint32_t **row_start,
                         const uint32_t **column) {
  const struct cb_pattern *p = op->variant->arithmetic->elements->pattern(op->elements);
  *row_start = p->row_start;
  *column = p->column;
}

void cb_operator_blocks(const struct cb_operator *op, double *blocks) {
  op->variant->arithmetic->elements->blocks(op->elements, blocks);
}
