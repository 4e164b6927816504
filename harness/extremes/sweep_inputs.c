/* sweep_inputs.c - what should not be in an input: by every variant, shapes in denormal
 * numbers, vertices in one place, nodes without elements; by the readers, for all variants
 * alike, what is to be refused in one sentence.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/extremes/report.h"
#include "harness/files/mesh.h"

/* ---- shapes ------------------------------------------------------------------------------ */

struct shape {
  const char *name;
  double F[9]; /* row-major; its columns are the edges now */
};
static const struct shape shapes[] = {
    {"as at rest", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"edges denormal in double", {1e-310, 0, 3e-311, 2e-311, 2e-310, 0, 0, 1e-311, -1e-310}},
    {"edges denormal in float", {1e-40, 0, 3e-41, 2e-41, 2e-40, 0, 0, 1e-41, -1e-40}},
    {"one edge denormal in float", {1, 0, 1e-41, 0, 1, 2e-41, 0, 0, 3e-41}},
    {"vertices b and c in one place", {1, 1, 0, 0, 0, 0, 0, 0, 1}},
    {"vertices a and b in one place", {0, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"vertices c and d in one place", {1, 0, 0, 0, 1, 1, 0, 0, 0}},
    {"vertices a, b and c in one place", {0, 0, 0, 0, 0, 0, 0, 0, 1}},
    {"all vertices in one place", {0}}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static void shape_name(const void *context, size_t n, struct cb_extreme *row) {
  (void)context;
  row->value = (double)n;
  snprintf(row->parameter, sizeof row->parameter, "%s", shapes[n].name);
}

static enum cb_status run_shapes(struct cb_extremes *all) {
  struct cb_cases c;
  enum cb_status status = cb_cases_create(SHAPES, true, &c);
  if (status) return status;
  for (size_t n = 0; n < SHAPES; n++)
    for (size_t i = 0; i < 9; i++) c.x[12 * n + 3 + i % 3 * 3 + i / 3] = shapes[n].F[i];
  status = cb_cases_sweep("inputs", &c, 1, shape_name, NULL, all);
  cb_cases_free(&c);
  return status;
}

/* ---- nodes without elements ------------------------------------------------------------------ */

/* One element of the nodes 1 to 4, alone and between two more nodes, which may be anywhere:
 * the same force on its nodes to rounding, none on the others. */
static enum cb_status run_isolated(const struct cb_variant *v, struct cb_extremes *all) {
  static double X[18] = {9, 9, 9, 0, 0, 0, 1, 0.1, 0, 0.2, 0.9, 0.1, 0.1, 0.2, 1.1, -7, 0, 0};
  static uint32_t tet[4] = {1, 2, 3, 4}, alone_tet[4] = {0, 1, 2, 3};
  const struct cb_mesh mesh = {6, 1, X, tet, 1}, alone = {4, 1, X + 3, alone_tet, 1};
  struct cb_extreme row = cb_extreme_blank("inputs", v);
  struct cb_material m;
  struct cb_probe probe;
  double x[18], f[18], g[12];
  for (int i = 0; i < 18; i++) x[i] = X[i] * (1 + 0.1 * (i % 4));
  enum cb_status status = cb_material_isotropic(1000, 0.3, 1000, &m);
  if (!status) status = cb_probe_open(v, &mesh, &m, &probe);
  if (status) return status;
  cb_probe_force(&probe, x, f);
  cb_probe_close(&probe);
  status = cb_probe_open(v, &alone, &m, &probe);
  if (status) return status;
  cb_probe_force(&probe, x + 3, g);
  cb_probe_close(&probe);
  snprintf(row.parameter, sizeof row.parameter, "nodes without elements");
  row.value = SHAPES;
  double size = 0, off = 0;
  for (int i = 0; i < 12; i++) size = hypot(size, g[i]), off = hypot(off, f[i + 3] - g[i]);
  for (int i = 0; i < 18; i++) {
    row.finite = row.finite && isfinite(f[i]);
    if ((i < 3 || i >= 15) && f[i] != 0) row.law = "isolated nodes do nothing";
  }
  row.force_error = off / (size * v->arithmetic->roundoff);
  return cb_extremes_add(all, &row);
}

/* ---- files ---------------------------------------------------------------------------------- */

static const char mesh_text[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n"
                                "2 %s 0 0\n3 %s\n4 0 0 1\n$EndNodes\n$Elements\n%s$EndElements\n";
static const char positions_text[] = "node,x,y,z\n1,0,0,0\n2,%s,0,0\n3,0,1,0\n4,0,0,1\n";

struct file {
  const char *name;
  const char *at, *third, *elements; /* of the mesh: x of node 2, place of node 3 */
  const char *now;                   /* x of node 2 in the positions */
  bool right;                        /* is to be taken */
};
#define PLACE "0 1 0"
#define ELEMENT "1\n1 4 2 0 1 1 2 3 4\n"
static const struct file files[] = {
    {"mesh: right", "1", PLACE, ELEMENT, "1", true},
    {"mesh: nan", "nan", PLACE, ELEMENT, "1", false},
    {"mesh: inf", "inf", PLACE, ELEMENT, "1", false},
    {"mesh: 1e999", "1e999", PLACE, ELEMENT, "1", false},
    {"mesh: no element", "1", PLACE, "0\n", "1", false},
    {"mesh: a node twice in an element", "1", PLACE, "1\n1 4 2 0 1 1 2 3 3\n", "1", false},
    {"mesh: a node that is not there", "1", PLACE, "1\n1 4 2 0 1 1 2 3 9\n", "1", false},
    {"mesh: two vertices in one place", "1", "1 0 0", ELEMENT, "1", false},
    {"mesh: a flat element", "1", "1 0 1", ELEMENT, "1", false},
    {"mesh: denormal size", "1e-310", PLACE, ELEMENT, "1", false},
    {"positions: nan", "1", PLACE, ELEMENT, "nan", false},
    {"positions: inf", "1", PLACE, ELEMENT, "-inf", false},
    {"positions: 1e999", "1", PLACE, ELEMENT, "1e999", false},
    {"positions: nothing", "1", PLACE, ELEMENT, "", false},
    {"positions: denormal", "1", PLACE, ELEMENT, "1e-310", true}};
enum { FILES = sizeof files / sizeof *files };

static enum cb_status write_text(const char *path, const char *text) {
  FILE *stream = fopen(path, "w");
  const bool written = stream && fputs(text, stream) >= 0;
  if ((stream && fclose(stream) != 0) || !written)
    return cb_fail(CB_IO, "cannot write %s; set TMPDIR to a directory that can be written", path);
  return CB_OK;
}

/* What the readers say to both files; *read: of the reading alone. */
static enum cb_status read_files(const struct file *file, const char *directory,
                                 enum cb_status *read) {
  char mesh_path[512], positions_path[512], text[512];
  struct cb_mesh mesh = {0};
  long long *numbers = NULL;
  double x[12];
  snprintf(mesh_path, sizeof mesh_path, "%s/body.msh", directory);
  snprintf(positions_path, sizeof positions_path, "%s/x.csv", directory);
  snprintf(text, sizeof text, mesh_text, file->at, file->third, file->elements);
  enum cb_status status = write_text(mesh_path, text);
  snprintf(text, sizeof text, positions_text, file->now);
  if (!status) status = write_text(positions_path, text);
  if (!status) {
    *read = cb_mesh_read(mesh_path, &mesh, &numbers);
    if (!*read) *read = cb_positions_read(positions_path, &mesh, numbers, x);
  }
  free(numbers);
  cb_mesh_free(&mesh);
  unlink(mesh_path);
  unlink(positions_path);
  return status;
}

/* The recorded sentence from its line on, or from the name of the file: the directory is
 * another one in every run. */
static const char *without_path(const char *directory) {
  const char *sentence = cb_error_message(), *line = strstr(sentence, "line");
  const char *path = strstr(sentence, directory);
  return line ? line : path ? path + strlen(directory) + 1 : sentence;
}

/* finite: refused if it is to be, with CB_INPUT. */
static enum cb_status run_file(const struct file *file, const char *directory,
                               struct cb_extremes *all) {
  struct cb_extreme row = cb_extreme_blank("inputs", all->variants[0]);
  enum cb_status read = CB_OK, status = read_files(file, directory, &read);
  if (status) return status;
  if (read == CB_MEMORY) return read;
  snprintf(row.parameter, sizeof row.parameter, "%s", file->name);
  row.value = (double)(SHAPES + 1 + (file - files));
  row.finite = read == (file->right ? CB_OK : CB_INPUT);
  if (read) snprintf(row.note, sizeof row.note, "refused: %.80s", without_path(directory));
  if (!read && !file->right) snprintf(row.note, sizeof row.note, "taken");
  return cb_extremes_add(all, &row);
}

static enum cb_status run_files(struct cb_extremes *all) {
  const char *where = getenv("TMPDIR");
  char directory[256];
  snprintf(directory, sizeof directory, "%s/corobench-XXXXXX", where && *where ? where : "/tmp");
  if (!mkdtemp(directory))
    return cb_fail(CB_IO, "cannot make %s; set TMPDIR to a directory that can be written",
                   directory);
  enum cb_status status = CB_OK;
  for (size_t n = 0; !status && n < FILES; n++) status = run_file(&files[n], directory, all);
  rmdir(directory);
  return status;
}

/* --------------------------------------------------------------------------------------------- */

static enum cb_status run(struct cb_extremes *all) {
  enum cb_status status = run_shapes(all);
  for (size_t v = 0; !status && all->variants[v]; v++) status = run_isolated(all->variants[v], all);
  return !status && all->variants[0] ? run_files(all) : status;
}

const struct cb_sweep cb_sweep_inputs = {
    "inputs", "denormal numbers, vertices in one place, files that must be refused", run};
