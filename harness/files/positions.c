/* positions.c - deformed node positions from a CSV file.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/mesh_read.h"

/* One row into read[3*nodes], whose NaN mark the nodes still missing. */
static enum cb_status read_row(struct cb_text *t, const struct cb_numbers *map, double *read) {
  long long number;
  uint32_t node;
  double xyz[3];
  if (!cb_text_integer(t, &number))
    return cb_text_expected(t, "node,x,y,z, beginning with a number");
  for (size_t k = 0; k < 3; k++)
    if (!cb_text_comma(t) || !cb_text_real(t, xyz + k))
      return cb_text_expected(t, "node,x,y,z with three finite coordinates");
  if (!cb_text_ended(t)) return cb_text_expected(t, "nothing after node,x,y,z");
  if (!cb_numbers_find(map, number, &node))
    return cb_text_refuse(t, "the mesh has no node %lld; use the numbers of the mesh file", number);
  if (!isnan(read[3 * (size_t)node]))
    return cb_text_refuse(t, "node %lld has a position already; keep one", number);
  memcpy(read + 3 * (size_t)node, xyz, sizeof xyz);
  return CB_OK;
}

static enum cb_status read_rows(struct cb_text *t, const struct cb_mesh *mesh,
                                const long long *numbers, const struct cb_numbers *map,
                                double *read) {
  if (!cb_text_line(t, 0) || strncmp(t->at, "node,x,y,z", 10) != 0 ||
      (t->at += 10, !cb_text_ended(t)))
    return cb_text_expected(t, "the header node,x,y,z");
  for (size_t i = 0; i < 3 * mesh->nodes; i++) read[i] = NAN;
  while (cb_text_line(t, 0)) {
    enum cb_status status = read_row(t, map, read);
    if (status != CB_OK) return status;
  }
  for (size_t i = 0; i < mesh->nodes; i++)
    if (isnan(read[3 * i]))
      return cb_fail(CB_INPUT, "%s: node %lld has no position; give every node of the mesh a row",
                     t->path, numbers ? numbers[i] : (long long)i);
  return CB_OK;
}

enum cb_status cb_positions_read(const char *path, const struct cb_mesh *mesh,
                                 const long long *numbers, double *x) {
  struct cb_text text = {0};
  struct cb_numbers map = {0};
  double *read = reallocarray(NULL, mesh->nodes, 3 * sizeof *read);
  enum cb_status status = read ? CB_OK : cb_fail_memory("the positions");
  if (status == CB_OK) status = cb_text_open(path, &text);
  if (status == CB_OK) status = cb_numbers_create(path, numbers, mesh->nodes, &map);
  if (status == CB_OK) status = read_rows(&text, mesh, numbers, &map, read);
  if (status == CB_OK) memcpy(x, read, 3 * mesh->nodes * sizeof *x);
  cb_numbers_free(&map);
  cb_text_close(&text);
  free(read);
  return status;
}
