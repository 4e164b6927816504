/* mesh_tetgen.c - meshes of TetGen: a .node and an .ele file.
 * Source: Si, TetGen user's manual, file formats.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/mesh_read.h"

/* The path with its ending replaced; to be freed; NULL when out of memory. */
static char *replace_ending(const char *path, const char *ending) {
  char *made;
  int stem = (int)(strrchr(path, '.') - path);
  return asprintf(&made, "%.*s%s", stem, path, ending) < 0 ? NULL : made;
}

/* "count [dimension or nodes a tetrahedron [more]]" */
static enum cb_status read_header(struct cb_text *t, const char *what, size_t bytes, size_t *count,
                                  long long *second) {
  if (!cb_text_line(t, '#')) return cb_text_expected(t, "the number of %s", what);
  enum cb_status status = cb_text_count(t, what, bytes, count);
  if (status != CB_OK) return status;
  if (!cb_text_ended(t) && !cb_text_integer(t, second))
    return cb_text_expected(t, "%lld after the number of %s", *second, what);
  if (*count == 0) return cb_text_refuse(t, "the file has no %s; check the export", what);
  return CB_OK;
}

static enum cb_status read_headers(struct cb_text *nodes, struct cb_text *elements,
                                   size_t *node_count, size_t *tet_count) {
  long long dimension = 3, corners = 4;
  enum cb_status status = read_header(nodes, "nodes", sizeof "0 0 0 0", node_count, &dimension);
  if (status != CB_OK) return status;
  if (dimension != 3)
    return cb_text_refuse(nodes, "the nodes have %lld coordinates; give three", dimension);
  status = read_header(elements, "tetrahedra", sizeof "0 0 1 2 3", tet_count, &corners);
  if (status != CB_OK) return status;
  if (corners == 10)
    return cb_text_refuse(elements, "the tetrahedra have 10 nodes (second order); mesh again "
                                    "without -o2, 4 nodes are needed");
  if (corners != 4)
    return cb_text_refuse(elements, "the tetrahedra have %lld nodes; give 4", corners);
  return CB_OK;
}

static enum cb_status read_nodes(struct cb_text *t, struct cb_mesh *mesh, long long *numbers) {
  for (size_t i = 0; i < mesh->nodes; i++) {
    long long number;
    double xyz[3];
    if (!cb_text_line(t, '#') || !cb_text_integer(t, &number) || !cb_text_point(t, xyz))
      return cb_text_expected(t, "the number and three coordinates of a node, %zu of %zu", i + 1,
                              mesh->nodes);
    if (i == 0 ? number != 0 && number != 1 : number != numbers[i - 1] + 1)
      return cb_text_refuse(t,
                            "the node has number %lld; number the nodes one after the other "
                            "from 0 or 1",
                            number);
    numbers[i] = number;
    memcpy(mesh->X + 3 * i, xyz, sizeof xyz);
  }
  if (cb_text_line(t, '#'))
    return cb_text_refuse(t, "there are more nodes than the %zu announced; correct their number",
                          mesh->nodes);
  return CB_OK;
}

static enum cb_status read_elements(struct cb_text *t, long long first, struct cb_mesh *mesh) {
  for (size_t e = 0; e < mesh->tets; e++) {
    long long element, n[4];
    if (!cb_text_line(t, '#') || !cb_text_integer(t, &element) || !cb_text_integer(t, n) ||
        !cb_text_integer(t, n + 1) || !cb_text_integer(t, n + 2) || !cb_text_integer(t, n + 3))
      return cb_text_expected(t, "the number and four nodes of a tetrahedron, %zu of %zu", e + 1,
                              mesh->tets);
    for (size_t j = 0; j < 4; j++) {
      if (n[j] < first || (size_t)(n[j] - first) >= mesh->nodes)
        return cb_text_refuse(t, "the tetrahedron names node %lld, but nodes go from %lld to %lld",
                              n[j], first, first + (long long)mesh->nodes - 1);
      mesh->tet[4 * e + j] = (uint32_t)(n[j] - first);
    }
    enum cb_status status = cb_mesh_check_tet(t, mesh, e);
    if (status != CB_OK) return status;
  }
  if (cb_text_line(t, '#'))
    return cb_text_refuse(
        t, "there are more tetrahedra than the %zu announced; correct their number", mesh->tets);
  return CB_OK;
}

enum cb_status cb_mesh_read_tetgen(const char *path, struct cb_mesh *mesh, long long **numbers) {
  enum cb_status status = CB_OK;
  struct cb_text nodes = {0}, elements = {0};
  struct cb_mesh made = {0};
  long long *own = NULL;
  size_t node_count, tet_count;
  char *node_path = replace_ending(path, ".node"), *ele_path = replace_ending(path, ".ele");
  if (!node_path || !ele_path) {
    status = cb_fail_memory("the mesh");
    goto done;
  }
  if ((status = cb_text_open(node_path, &nodes)) != CB_OK) goto done;
  if ((status = cb_text_open(ele_path, &elements)) != CB_OK) goto done;
  if ((status = read_headers(&nodes, &elements, &node_count, &tet_count)) != CB_OK) goto done;
  if ((status = cb_mesh_allocate(node_count, tet_count, &made)) != CB_OK) goto done;
  own = reallocarray(NULL, node_count, sizeof *own);
  if (!own) {
    status = cb_fail_memory("the node numbers");
    goto done;
  }
  if ((status = read_nodes(&nodes, &made, own)) != CB_OK) goto done;
  if ((status = read_elements(&elements, own[0], &made)) != CB_OK) goto done;
  *mesh = made;
  *numbers = own;
  made = (struct cb_mesh){0};
  own = NULL;
done:
  free(own);
  cb_mesh_free(&made);
  cb_text_close(&elements);
  cb_text_close(&nodes);
  free(ele_path);
  free(node_path);
  return status;
}
