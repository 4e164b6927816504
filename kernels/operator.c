/* operator.c - a variant on a mesh: the arithmetic's element arrays behind one
 * plain C interface. Without stiffness (E = 0) there is nothing to run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "kernels/arithmetics.h"
#include "kernels/team.h"

struct cb_operator {
  const struct cb_variant *variant;
  struct cb_form form;
  struct cb_elements *elements;
  struct cb_team *team;
  size_t nodes, node_bytes;
  bool slack; /* no stiffness */
};

enum cb_status cb_operator_create(const struct cb_variant *variant, const struct cb_mesh *mesh,
                                  const struct cb_material *material, double c, size_t threads,
                                  struct cb_operator **out) {
  const struct cb_arithmetic *a = variant->arithmetic;
  struct cb_form form = variant->model->form[variant->storage][material->orthotropic];
  if (!form.update || !(c > 0) || mesh->tets == 0) return CB_INPUT;
  struct cb_operator *op = calloc(1, sizeof *op);
  if (!op) return CB_MEMORY;
  *op = (struct cb_operator){.variant = variant, .form = form, .nodes = mesh->nodes};
  op->slack = !material->orthotropic && material->young == 0;
  op->node_bytes = a->stride * a->scalar_bytes;
  enum cb_status status = cb_team_create(threads, &op->team);
  if (!status) status = a->elements->create(variant, mesh, material, c, op->team, &op->elements);
  if (status)
    cb_operator_free(op);
  else
    *out = op;
  return status;
}

void cb_operator_free(struct cb_operator *op) {
  if (!op) return;
  op->variant->arithmetic->elements->free(op->elements);
  cb_team_free(op->team);
  free(op);
}

void cb_operator_update_part(struct cb_operator *op, size_t thread, const void *x, const void *v,
                             double h, void *out) {
  if (!op->slack) op->form.update(op->elements, thread, x, v, h, out);
}

void cb_operator_product_part(const struct cb_operator *op, size_t thread, const void *u, void *y) {
  if (!op->slack) op->form.product(op->elements, thread, u, y);
}

/* A whole vector, made by the team: zero, then its parts. */
struct whole {
  struct cb_operator *update; /* or NULL */
  const struct cb_operator *op;
  const void *x, *v;
  double h;
  void *out;
};

static void whole_part(void *context, size_t thread) {
  const struct whole *w = context;
  size_t first, last;
  cb_team_share(w->op->nodes, cb_team_threads(w->op->team), thread, &first, &last);
  memset((char *)w->out + first * w->op->node_bytes, 0, (last - first) * w->op->node_bytes);
  cb_team_barrier(w->op->team, thread);
  if (w->update)
    cb_operator_update_part(w->update, thread, w->x, w->v, w->h, w->out);
  else
    cb_operator_product_part(w->op, thread, w->x, w->out);
}

void cb_operator_update(struct cb_operator *op, const void *x, const void *v, double h, void *out) {
  struct whole w = {.update = op, .op = op, .x = x, .v = v, .h = h, .out = out};
  cb_team_run(op->team, whole_part, &w);
}

void cb_operator_product(const struct cb_operator *op, const void *u, void *y) {
  struct whole w = {.op = op, .x = u, .out = y};
  cb_team_run(op->team, whole_part, &w);
}

void cb_operator_reset(struct cb_operator *op) {
  op->variant->arithmetic->elements->reset(op->elements);
}

enum cb_status cb_operator_tune(struct cb_operator *op, const struct cb_tuning *tuning) {
  const bool frame = tuning->frame_iterations || tuning->frame_tolerance != 0;
  const unsigned turned = (frame ? CB_KNOB_FRAME : 0) | (tuning->lazy != 0 ? CB_KNOB_LAZY : 0);
  if (turned & ~op->variant->model->knobs) return CB_INPUT;
  op->variant->arithmetic->elements->tune(op->elements, tuning);
  return CB_OK;
}

size_t cb_operator_bytes(const struct cb_operator *op) {
  return op->variant->arithmetic->elements->bytes(op->elements);
}

double cb_operator_visits(const struct cb_operator *op) {
  return op->variant->arithmetic->elements->visits(op->elements);
}

const struct cb_variant *cb_operator_variant(const struct cb_operator *op) { return op->variant; }

size_t cb_operator_nodes(const struct cb_operator *op) { return op->nodes; }

struct cb_team *cb_operator_team(const struct cb_operator *op) {
  return op->team;
}

void cb_operator_pattern(const struct cb_operator *op, const uint32_t **row_start,
                         const uint32_t **column) {
  const struct cb_pattern *p = op->variant->arithmetic->elements->pattern(op->elements);
  *row_start = p->row_start;
  *column = p->column;
}

void cb_operator_blocks(const struct cb_operator *op, double *blocks) {
  op->variant->arithmetic->elements->blocks(op->elements, blocks);
}
