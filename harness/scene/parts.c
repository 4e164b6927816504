/* parts.c - see parts.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/parts.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/files/mesh.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
static const double ANY = DBL_MAX, TINY = DBL_MIN;

static enum cb_status read_block(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const struct cb_field fields[] = {{"cells", CB_FIELD_COUNTS, s->cells, 1, 200, true},
                                    {"cell_m", CB_FIELD_NUMBER, &s->cell, TINY, ANY, true}};
  return cb_json_member(json, "block", object, fields, COUNT(fields));
}

/* A beam along x, of square section. */
static enum cb_status read_beam(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  double length = 0, width = 0;
  size_t across = 0;
  const struct cb_field fields[] = {{"length_m", CB_FIELD_NUMBER, &length, TINY, ANY, true},
                                    {"width_m", CB_FIELD_NUMBER, &width, TINY, ANY, true},
                                    {"cells_across", CB_FIELD_COUNT, &across, 1, 100, true}};
  enum cb_status status = cb_json_member(json, "beam", object, fields, COUNT(fields));
  if (status) return status;
  s->cell = width / (double)across;
  const double along = round(length / s->cell);
  if (!(along >= 1 && along <= 10000 && fabs(along * s->cell - length) < 1e-9 * length)) {
    cb_json_enter(json, "beam", 0);
    return cb_json_fail(json,
                        "length_m over width_m times cells_across is %g cells along the beam; it "
                        "must be a whole number from 1 to 10000",
                        length / s->cell);
  }
  s->cells[0] = (size_t)along, s->cells[1] = s->cells[2] = across;
  return CB_OK;
}

static enum cb_status read_mesh(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const char *file = NULL;
  const struct cb_field fields[] = {
      {"file", CB_FIELD_TEXT, &file, 0, 0, true},
      {"metres_per_unit", CB_FIELD_NUMBER, &s->scale, TINY, ANY, true}};
  enum cb_status status = cb_json_member(json, "mesh", object, fields, COUNT(fields));
  if (status) return status;
  const char *slash = strrchr(json->path, '/');
  const int folder = file[0] == '/' || !slash ? 0 : (int)(slash + 1 - json->path);
  const int length =
      snprintf(s->mesh_path, sizeof s->mesh_path, "%.*s%s", folder, json->path, file);
  if (file[0] && length > 0 && (size_t)length < sizeof s->mesh_path) return CB_OK;
  cb_json_enter(json, "mesh", 0);
  return cb_json_fail(json, "'file' must be a path of 1 to %zu characters",
                      sizeof s->mesh_path - 1);
}

static enum cb_status read_shape(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const char *name = NULL;
  const struct cb_field fields[] = {{"name", CB_FIELD_TEXT, &name, 0, 0, true},
                                    {"cells", CB_FIELD_COUNT, &s->cells[0], 4, 200, true},
                                    {"length_m", CB_FIELD_NUMBER, &s->cell, TINY, ANY, true}};
  enum cb_status status = cb_json_member(json, "shape", object, fields, COUNT(fields));
  if (status) return status;
  snprintf(s->shape, sizeof s->shape, "%s", name);
  if (cb_mesh_is_shape(s->shape)) return CB_OK;
  cb_json_enter(json, "shape", 0);
  return cb_json_fail(json, "there is no shape '%s'; 'name' must be rabbit or liver", name);
}

enum cb_status cb_scene_geometry(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  json_t *block = NULL, *beam = NULL, *shape = NULL, *mesh = NULL;
  const struct cb_field fields[] = {{"block", CB_FIELD_OBJECT, &block, 0, 0, false},
                                    {"beam", CB_FIELD_OBJECT, &beam, 0, 0, false},
                                    {"shape", CB_FIELD_OBJECT, &shape, 0, 0, false},
                                    {"mesh", CB_FIELD_OBJECT, &mesh, 0, 0, false}};
  cb_json_enter(json, "geometry", 0);
  enum cb_status status = cb_json_object(json, object, fields, COUNT(fields));
  if (!status && (block != NULL) + (beam != NULL) + (shape != NULL) + (mesh != NULL) != 1)
    return cb_json_fail(json, "'geometry' must be one of 'block', 'beam', 'shape' and 'mesh'");
  if (!status)
    status = block   ? read_block(json, block, s)
             : beam  ? read_beam(json, beam, s)
             : shape ? read_shape(json, shape, s)
                     : read_mesh(json, mesh, s);
  if (!status) cb_json_leave(json);
  return status;
}

enum cb_status cb_scene_material(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  double young = 0, poisson = 0, density = 0;
  const struct cb_field fields[] = {{"young_pa", CB_FIELD_NUMBER, &young, 0, ANY, true},
                                    {"poisson", CB_FIELD_NUMBER, &poisson, -ANY, ANY, true},
                                    {"density_kg_m3", CB_FIELD_NUMBER, &density, TINY, ANY, true}};
  enum cb_status status = cb_json_member(json, "material", object, fields, COUNT(fields));
  if (status || cb_material_isotropic(young, poisson, density, &s->material) == CB_OK)
    return status;
  const bool usual = poisson > -1 && poisson < 0.5;
  cb_json_enter(json, "material", 0);
  cb_json_enter(json, usual ? "young_pa" : "poisson", 0);
  return usual ? cb_json_fail(json, "'young_pa' is %g; the stresses would not be finite", young)
               : cb_json_fail(json, "'poisson' is %g; it must be above -1 and below 0.5", poisson);
}
