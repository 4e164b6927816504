/* beam.c - see beam.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/truth/beam.h"

#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"

enum cb_status cb_beam_create(double width, size_t widths, size_t across, double young,
                              struct cb_beam *beam) {
  struct cb_beam b = {.length = width * (double)widths};
  enum cb_status status =
      cb_mesh_grid(across * widths, across, across, width / (double)across, &b.mesh);
  if (!status) status = cb_material_isotropic(young, 0, 1, &b.material);
  if (status) return status;
  b.fixed = malloc(b.mesh.nodes);
  b.x = malloc(3 * b.mesh.nodes * sizeof *b.x);
  b.external = calloc(b.mesh.nodes, 3 * sizeof *b.external);
  if (!b.fixed || !b.x || !b.external) {
    cb_beam_free(&b);
    return cb_fail_memory("the beam");
  }
  memcpy(b.x, b.mesh.X, 3 * b.mesh.nodes * sizeof *b.x);
  for (size_t i = 0; i < b.mesh.nodes; i++) b.fixed[i] = b.mesh.X[3 * i] < 1e-9;
  *beam = b;
  return CB_OK;
}

void cb_beam_free(struct cb_beam *beam) {
  cb_mesh_free(&beam->mesh);
  free(beam->fixed);
  free(beam->x);
  free(beam->external);
  *beam = (struct cb_beam){0};
}

static bool at_end(const struct cb_beam *b, size_t i) {
  return b->mesh.X[3 * i] > b->length * (1 - 1e-9);
}

/* The area of a node: of cells, a quarter for each that it is a corner of. */
static double area(const struct cb_beam *b, size_t i) {
  double part = 1, high = 0;
  for (size_t n = 0; n < b->mesh.nodes; n++)
    if (b->mesh.X[3 * n + 1] > high) high = b->mesh.X[3 * n + 1];
  for (int k = 1; k < 3; k++) {
    const double at = b->mesh.X[3 * i + k];
    if (at < 1e-9 || at > high * (1 - 1e-9)) part /= 2;
  }
  return part;
}

void cb_beam_push(struct cb_beam *beam, double force) {
  double all = 0;
  for (size_t i = 0; i < beam->mesh.nodes; i++)
    if (at_end(beam, i)) all += area(beam, i);
  for (size_t i = 0; i < beam->mesh.nodes; i++)
    if (at_end(beam, i)) beam->external[3 * i + 2] = -force * area(beam, i) / all;
}

void cb_beam_tip(const struct cb_beam *beam, double *along, double *down) {
  double count = 0;
  *along = *down = 0;
  for (size_t i = 0; i < beam->mesh.nodes; i++) {
    if (!at_end(beam, i)) continue;
    *along += (beam->mesh.X[3 * i] - beam->x[3 * i]) / beam->length;
    *down += (beam->mesh.X[3 * i + 2] - beam->x[3 * i + 2]) / beam->length;
    count++;
  }
  *along /= count, *down /= count;
}
