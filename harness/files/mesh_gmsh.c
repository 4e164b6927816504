/* mesh_gmsh.c - meshes of Gmsh: .msh files of version 2.2 and 4.1, ASCII.
 * Source: Geuzaine, Remacle, Gmsh reference manual, "MSH file format".
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/mesh_read.h"

enum { TETRAHEDRON = 4 }; /* the element type of 4 nodes */

struct reader {
  struct cb_text text;
  bool blocks; /* version 4.1: nodes and elements come in blocks, one an entity */
  struct cb_mesh mesh;
  long long *numbers;
  struct cb_numbers map;
};

/* The next line holds that section name and nothing else? */
static bool at_section(struct cb_text *t, const char *name) {
  size_t length = strlen(name);
  if (strncmp(t->at, name, length) != 0) return false;
  return t->at[length + strspn(t->at + length, " \t\r")] == '\0';
}

static enum cb_status end_section(struct cb_text *t, const char *name) {
  if (!cb_text_line(t, 0) || !at_section(t, name)) return cb_text_expected(t, "%s", name);
  return CB_OK;
}

static enum cb_status skip_section(struct cb_text *t) {
  size_t opened = t->line;
  while (cb_text_line(t, 0))
    if (strncmp(t->at, "$End", 4) == 0) return CB_OK;
  return cb_text_expected(t, "the end of the section of line %zu", opened);
}

static enum cb_status read_format(struct reader *r) {
  struct cb_text *t = &r->text;
  double version;
  long long binary;
  if (!cb_text_line(t, 0) || !at_section(t, "$MeshFormat"))
    return cb_text_expected(t, "$MeshFormat, the beginning of a Gmsh mesh");
  if (!cb_text_line(t, 0) || !cb_text_real(t, &version) || !cb_text_integer(t, &binary))
    return cb_text_expected(t, "the format's version and file type");
  if (binary != 0)
    return cb_text_refuse(t, "the mesh is binary, which is not read; write it again as ASCII (in "
                             "Gmsh: Mesh.Binary = 0)");
  if (version != 2.2 && version != 4.1)
    return cb_text_refuse(t,
                          "the format's version is %g; write the mesh again as version 4.1 or 2.2 "
                          "(in Gmsh: Mesh.MshFileVersion = 4.1)",
                          version);
  r->blocks = version == 4.1;
  return end_section(t, "$EndMeshFormat");
}

/* ---- nodes ---------------------------------------------------------------- */

static enum cb_status read_node_list(struct reader *r) {
  for (size_t i = 0; i < r->mesh.nodes; i++)
    if (!cb_text_line(&r->text, 0) || !cb_text_integer(&r->text, r->numbers + i) ||
        !cb_text_point(&r->text, r->mesh.X + 3 * i))
      return cb_text_expected(&r->text, "the number and three coordinates of a node, %zu of %zu",
                              i + 1, r->mesh.nodes);
  return CB_OK;
}

/* *count := the fourth number of the line that heads a block, after three
 * others; no more than what is left of the section's total. */
static enum cb_status read_block_header(struct cb_text *t, const char *what, size_t bytes,
                                        size_t left, long long head[3], size_t *count) {
  if (!cb_text_line(t, 0) || !cb_text_integer(t, head) || !cb_text_integer(t, head + 1) ||
      !cb_text_integer(t, head + 2))
    return cb_text_expected(t, "the four numbers that begin a block of %s", what);
  enum cb_status status = cb_text_count(t, what, bytes, count);
  if (status != CB_OK) return status;
  if (*count > left)
    return cb_text_refuse(t,
                          "the block has %zu %s, but only %zu are left of those announced; "
                          "write the mesh again",
                          *count, what, left);
  return CB_OK;
}

static enum cb_status check_total(const struct cb_text *t, const char *what, size_t found,
                                  size_t announced) {
  if (found == announced) return CB_OK;
  return cb_text_refuse(t, "the blocks have %zu %s, %zu are announced; write the mesh again", found,
                        what, announced);
}

/* A block: the numbers of its nodes, then their coordinates (those of parametric
 * blocks are followed by parameters). */
static enum cb_status read_node_blocks(struct reader *r, long long blocks) {
  struct cb_text *t = &r->text;
  size_t first = 0, count;
  for (; blocks > 0; blocks--, first += count) {
    long long head[3];
    enum cb_status status =
        read_block_header(t, "nodes", sizeof "1\n0 0 0", r->mesh.nodes - first, head, &count);
    if (status != CB_OK) return status;
    for (size_t i = first; i < first + count; i++)
      if (!cb_text_line(t, 0) || !cb_text_integer(t, r->numbers + i) || !cb_text_ended(t))
        return cb_text_expected(t, "the number of a node, %zu of %zu", i + 1, r->mesh.nodes);
    for (size_t i = first; i < first + count; i++)
      if (!cb_text_line(t, 0) || !cb_text_point(t, r->mesh.X + 3 * i))
        return cb_text_expected(t, "three coordinates of a node, %zu of %zu", i + 1, r->mesh.nodes);
  }
  return check_total(t, "nodes", first, r->mesh.nodes);
}

/* The line that begins a section: its count; in 4.1 after the number of blocks. */
static enum cb_status read_section_header(struct reader *r, const char *what, size_t bytes,
                                          long long *blocks, size_t *count) {
  if (!cb_text_line(&r->text, 0) || (r->blocks && !cb_text_integer(&r->text, blocks)))
    return cb_text_expected(&r->text, "the number of %s", what);
  return cb_text_count(&r->text, what, bytes, count);
}

static enum cb_status read_nodes(struct reader *r) {
  if (r->mesh.X) return cb_text_refuse(&r->text, "a second $Nodes; keep one mesh in the file");
  long long blocks;
  size_t count;
  enum cb_status status = read_section_header(r, "nodes", sizeof "1 0 0 0", &blocks, &count);
  if (status != CB_OK) return status;
  r->mesh.X = reallocarray(NULL, count, 3 * sizeof *r->mesh.X);
  r->numbers = reallocarray(NULL, count, sizeof *r->numbers);
  if (!r->mesh.X || !r->numbers) return cb_fail_memory("the mesh");
  r->mesh.nodes = count;
  status = r->blocks ? read_node_blocks(r, blocks) : read_node_list(r);
  if (status != CB_OK) return status;
  if ((status = end_section(&r->text, "$EndNodes")) != CB_OK) return status;
  return cb_numbers_create(r->text.path, r->numbers, count, &r->map);
}

/* ---- elements ------------------------------------------------------------- */

static enum cb_status read_tetrahedron(struct reader *r) {
  struct cb_text *t = &r->text;
  uint32_t *n = r->mesh.tet + 4 * r->mesh.tets;
  for (size_t j = 0; j < 4; j++) {
    long long number;
    if (!cb_text_integer(t, &number))
      return cb_text_expected(t, "the numbers of a tetrahedron's four nodes");
    if (!cb_numbers_find(&r->map, number, n + j))
      return cb_text_refuse(t, "the tetrahedron names node %lld, which $Nodes does not have",
                            number);
  }
  return cb_mesh_check_tet(t, &r->mesh, r->mesh.tets++);
}

/* A line: number, type, number of tags, tags, nodes. */
static enum cb_status read_element_list(struct reader *r, size_t count) {
  struct cb_text *t = &r->text;
  for (size_t i = 0; i < count; i++) {
    long long element, type, tags, tag;
    if (!cb_text_line(t, 0) || !cb_text_integer(t, &element) || !cb_text_integer(t, &type) ||
        !cb_text_integer(t, &tags))
      return cb_text_expected(t, "number, type and tags of an element, %zu of %zu", i + 1, count);
    if (type != TETRAHEDRON) continue;
    for (; tags > 0; tags--)
      if (!cb_text_integer(t, &tag)) return cb_text_expected(t, "%lld more tags", tags);
    enum cb_status status = read_tetrahedron(r);
    if (status != CB_OK) return status;
  }
  return CB_OK;
}

/* A block: the line with its element type, then a line with number and nodes an
 * element. */
static enum cb_status read_element_blocks(struct reader *r, long long blocks, size_t total) {
  struct cb_text *t = &r->text;
  size_t first = 0, count;
  for (; blocks > 0; blocks--, first += count) {
    long long head[3], element;
    enum cb_status status =
        read_block_header(t, "elements", sizeof "1 1", total - first, head, &count);
    if (status != CB_OK) return status;
    for (size_t i = first; i < first + count; i++) {
      if (!cb_text_line(t, 0) || !cb_text_integer(t, &element))
        return cb_text_expected(t, "the number of an element, %zu of %zu", i + 1, total);
      if (head[2] != TETRAHEDRON) continue;
      if ((status = read_tetrahedron(r)) != CB_OK) return status;
    }
  }
  return check_total(t, "elements", first, total);
}

static enum cb_status read_elements(struct reader *r) {
  if (!r->mesh.X)
    return cb_text_refuse(&r->text, "$Elements comes before $Nodes; write the mesh again");
  if (r->mesh.tet) return cb_text_refuse(&r->text, "a second $Elements; keep one mesh in the file");
  long long blocks;
  size_t count;
  enum cb_status status = read_section_header(r, "elements", sizeof "1 1", &blocks, &count);
  if (status != CB_OK) return status;
  r->mesh.tet = reallocarray(NULL, count, 4 * sizeof *r->mesh.tet);
  if (!r->mesh.tet) return cb_fail_memory("the mesh");
  status = r->blocks ? read_element_blocks(r, blocks, count) : read_element_list(r, count);
  if (status != CB_OK) return status;
  return end_section(&r->text, "$EndElements");
}

/* ---- file ----------------------------------------------------------------- */

static enum cb_status read_sections(struct reader *r) {
  struct cb_text *t = &r->text;
  enum cb_status status = read_format(r);
  while (status == CB_OK && cb_text_line(t, 0)) {
    if (at_section(t, "$Nodes"))
      status = read_nodes(r);
    else if (at_section(t, "$Elements"))
      status = read_elements(r);
    else if (*t->at == '$' && strncmp(t->at, "$End", 4) != 0)
      status = skip_section(t);
    else
      status = cb_text_expected(t, "the name of a section, such as $Nodes");
  }
  if (status != CB_OK) return status;
  if (!r->mesh.tet) return cb_text_expected(t, "%s", r->mesh.X ? "$Elements" : "$Nodes");
  if (r->mesh.tets == 0)
    return cb_fail(CB_INPUT,
                   "%s has no tetrahedra of 4 nodes; mesh the volume in first order (in Gmsh: -3 "
                   "-order 1)",
                   t->path);
  return CB_OK;
}

enum cb_status cb_mesh_read_gmsh(const char *path, struct cb_mesh *mesh, long long **numbers) {
  struct reader r = {.mesh.share = 1};
  enum cb_status status = cb_text_open(path, &r.text);
  if (status == CB_OK) status = read_sections(&r);
  if (status == CB_OK) {
    /* Room was made for elements of every type. */
    uint32_t *fitting = reallocarray(r.mesh.tet, r.mesh.tets, 4 * sizeof *fitting);
    if (fitting) r.mesh.tet = fitting;
    *mesh = r.mesh;
    *numbers = r.numbers;
  } else {
    cb_mesh_free(&r.mesh);
    free(r.numbers);
  }
  cb_numbers_free(&r.map);
  cb_text_close(&r.text);
  return status;
}
