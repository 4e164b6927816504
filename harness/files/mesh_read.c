/* mesh_read.c - choice of the reader, and what the readers share.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/mesh_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"

enum cb_status cb_mesh_read(const char *path, struct cb_mesh *mesh, long long **numbers) {
  const char *ending = strrchr(path, '.');
  enum cb_status (*read)(const char *, struct cb_mesh *, long long **) = NULL;
  if (ending && (strcmp(ending, ".node") == 0 || strcmp(ending, ".ele") == 0))
    read = cb_mesh_read_tetgen;
  else if (ending && strcmp(ending, ".msh") == 0)
    read = cb_mesh_read_gmsh;
  if (!read)
    return cb_fail(CB_INPUT,
                   "cannot tell the format of %s; its name must end in .node or .ele (TetGen) or "
                   ".msh (Gmsh)",
                   path);

  long long *own;
  enum cb_status status = read(path, mesh, &own);
  if (status != CB_OK) return status;
  if (numbers)
    *numbers = own;
  else
    free(own);
  return CB_OK;
}

enum cb_status cb_mesh_check_tet(const struct cb_text *t, const struct cb_mesh *mesh, size_t e) {
  const uint32_t *n = mesh->tet + 4 * e;
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < i; j++)
      if (n[i] == n[j])
        return cb_text_refuse(t, "the tetrahedron has the same node twice; give it four different "
                                 "nodes or remove it");

  double squared = 0;
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < i; j++) {
      const double *a = mesh->X + 3 * (size_t)n[i], *b = mesh->X + 3 * (size_t)n[j];
      double x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
      squared = fmax(squared, x * x + y * y + z * z);
    }
  double longest = sqrt(squared), six_volumes = fabs(cb_mesh_six_volumes(mesh, e));
  if (!(six_volumes > 1e-12 * longest * longest * longest))
    return cb_text_refuse(t,
                          "the rest volume of the tetrahedron, %.3g m^3 at a longest edge of %.3g "
                          "m, is zero to rounding; remove it or mesh again",
                          six_volumes / 6, longest);
  return CB_OK;
}

struct cb_numbered {
  long long number;
  uint32_t node; /* UINT32_MAX: the slot is empty */
};

/* Numbers that follow each other fall into slots that do, so that the usual
 * dense numbering has no collisions and good locality; the odd factor spreads
 * numbers that are far apart. */
static struct cb_numbered *find_slot(const struct cb_numbers *map, long long number) {
  uint64_t n = (uint64_t)number;
  size_t i = (size_t)(n + (n >> map->shift) * UINT64_C(0x9E3779B97F4A7C15)) & map->mask;
  while (map->slot[i].node != UINT32_MAX && map->slot[i].number != number) i = (i + 1) & map->mask;
  return map->slot + i;
}

enum cb_status cb_numbers_create(const char *path, const long long *numbers, size_t count,
                                 struct cb_numbers *map) {
  struct cb_numbers made = {.shift = 1};
  while (((size_t)1 << made.shift) < 2 * count) made.shift++;
  made.mask = ((size_t)1 << made.shift) - 1;
  made.slot = reallocarray(NULL, made.mask + 1, sizeof *made.slot);
  if (!made.slot) return cb_fail_memory("the node numbers");
  for (size_t i = 0; i <= made.mask; i++) made.slot[i].node = UINT32_MAX;

  for (size_t i = 0; i < count; i++) {
    long long number = numbers ? numbers[i] : (long long)i;
    struct cb_numbered *slot = find_slot(&made, number);
    if (slot->node != UINT32_MAX) {
      cb_numbers_free(&made);
      return cb_fail(CB_INPUT, "%s: two nodes have the number %lld; give each its own", path,
                     number);
    }
    *slot = (struct cb_numbered){number, (uint32_t)i};
  }
  *map = made;
  return CB_OK;
}

void cb_numbers_free(struct cb_numbers *map) {
  free(map->slot);
  *map = (struct cb_numbers){0};
}

bool cb_numbers_find(const struct cb_numbers *map, long long number, uint32_t *node) {
  const struct cb_numbered *slot = find_slot(map, number);
  if (slot->node == UINT32_MAX) return false;
  *node = slot->node;
  return true;
}
