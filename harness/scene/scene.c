/* scene.c - see scene.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/scene.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/files/mesh.h"
#include "harness/scene/json.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
static const double ANY = DBL_MAX, TINY = DBL_MIN;

/* An object that stands under that key of the place where the reader is. */
static enum cb_status read_object(struct cb_json *json, const char *key, const json_t *object,
                                  const struct cb_field *fields, size_t count) {
  cb_json_enter(json, key, 0);
  enum cb_status status = cb_json_object(json, object, fields, count);
  if (!status) cb_json_leave(json);
  return status;
}

/* ---- geometry and material ---------------------------------------------------- */

static enum cb_status read_block(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const struct cb_field fields[] = {{"cells", CB_FIELD_COUNTS, s->cells, 1, 200, true},
                                    {"cell_m", CB_FIELD_NUMBER, &s->cell, TINY, ANY, true}};
  return read_object(json, "block", object, fields, COUNT(fields));
}

/* A beam along x, of square section. */
static enum cb_status read_beam(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  double length = 0, width = 0;
  size_t across = 0;
  const struct cb_field fields[] = {{"length_m", CB_FIELD_NUMBER, &length, TINY, ANY, true},
                                    {"width_m", CB_FIELD_NUMBER, &width, TINY, ANY, true},
                                    {"cells_across", CB_FIELD_COUNT, &across, 1, 100, true}};
  enum cb_status status = read_object(json, "beam", object, fields, COUNT(fields));
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
  enum cb_status status = read_object(json, "mesh", object, fields, COUNT(fields));
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
  enum cb_status status = read_object(json, "shape", object, fields, COUNT(fields));
  if (status) return status;
  snprintf(s->shape, sizeof s->shape, "%s", name);
  if (cb_mesh_is_shape(s->shape)) return CB_OK;
  cb_json_enter(json, "shape", 0);
  return cb_json_fail(json, "there is no shape '%s'; 'name' must be rabbit or liver", name);
}

static enum cb_status read_geometry(struct cb_json *json, const json_t *object,
                                    struct cb_scene *s) {
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

static enum cb_status read_material(struct cb_json *json, const json_t *object,
                                    struct cb_scene *s) {
  double young = 0, poisson = 0, density = 0;
  const struct cb_field fields[] = {
      {"young_pa", CB_FIELD_NUMBER, &young, 0, ANY, true},
      {"poisson", CB_FIELD_NUMBER, &poisson, -1 + DBL_EPSILON, 0.5 - DBL_EPSILON, true},
      {"density_kg_m3", CB_FIELD_NUMBER, &density, TINY, ANY, true}};
  enum cb_status status = read_object(json, "material", object, fields, COUNT(fields));
  if (!status) status = cb_material_isotropic(young, poisson, density, &s->material);
  return status;
}

/* ---- what is held, pushed and moved --------------------------------------------- */

/* Fields of a selection; the others of its object follow them. */
struct chosen {
  const char *face;
  double low[3], high[3];
};
enum { SELECTION_FIELDS = 3 };
static void selection_fields(struct chosen *c, struct cb_field *fields) {
  *c = (struct chosen){.low = {NAN, NAN, NAN}, .high = {NAN, NAN, NAN}};
  fields[0] = (struct cb_field){"face", CB_FIELD_TEXT, &c->face, 0, 0, false};
  fields[1] = (struct cb_field){"low", CB_FIELD_VECTOR, c->low, 0, 1, false};
  fields[2] = (struct cb_field){"high", CB_FIELD_VECTOR, c->high, 0, 1, false};
}

static enum cb_status to_selection(const struct cb_json *json, const struct chosen *c,
                                   struct cb_selection *where) {
  static const char *const faces[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
  const bool low = !isnan(c->low[0]), high = !isnan(c->high[0]);
  if (c->face ? low || high : !low || !high)
    return cb_json_fail(json, "nodes are chosen by 'face', or by 'low' and 'high', corners in "
                              "fractions of the bounding box");
  if (!c->face) {
    memcpy(where->low, c->low, sizeof where->low);
    memcpy(where->high, c->high, sizeof where->high);
    return CB_OK;
  }
  for (size_t i = 0; i < COUNT(faces); i++) {
    if (strcmp(c->face, faces[i]) != 0) continue;
    *where = (struct cb_selection){{0, 0, 0}, {1, 1, 1}};
    where->low[i / 2] = where->high[i / 2] = (double)(i % 2);
    return CB_OK;
  }
  return cb_json_fail(json, "'face' is '%s'; it must be x-, x+, y-, y+, z- or z+", c->face);
}

typedef enum cb_status read_item_fn(struct cb_json *json, const json_t *object, struct cb_scene *s,
                                    size_t n);

static enum cb_status read_fixed(struct cb_json *json, const json_t *object, struct cb_scene *s,
                                 size_t n) {
  struct chosen c;
  struct cb_field fields[SELECTION_FIELDS];
  selection_fields(&c, fields);
  enum cb_status status = cb_json_object(json, object, fields, COUNT(fields));
  return status ? status : to_selection(json, &c, &s->fixed[n]);
}

static enum cb_status read_load(struct cb_json *json, const json_t *object, struct cb_scene *s,
                                size_t n) {
  struct chosen c;
  struct cb_field fields[SELECTION_FIELDS + 1];
  selection_fields(&c, fields);
  fields[SELECTION_FIELDS] =
      (struct cb_field){"force_n", CB_FIELD_VECTOR, s->load[n].force, -ANY, ANY, true};
  enum cb_status status = cb_json_object(json, object, fields, COUNT(fields));
  return status ? status : to_selection(json, &c, &s->load[n].where);
}

static enum cb_status read_handle(struct cb_json *json, const json_t *object, struct cb_scene *s,
                                  size_t n) {
  struct chosen c;
  struct cb_handle *h = &s->handle[n];
  struct cb_field fields[SELECTION_FIELDS + 3];
  selection_fields(&c, fields);
  fields[SELECTION_FIELDS] =
      (struct cb_field){"turn_rad", CB_FIELD_VECTOR, h->turn, -ANY, ANY, false};
  fields[SELECTION_FIELDS + 1] =
      (struct cb_field){"move_m", CB_FIELD_VECTOR, h->move, -ANY, ANY, false};
  fields[SELECTION_FIELDS + 2] =
      (struct cb_field){"over_s", CB_FIELD_NUMBER, &h->over, TINY, ANY, true};
  enum cb_status status = cb_json_object(json, object, fields, COUNT(fields));
  return status ? status : to_selection(json, &c, &h->where);
}

static enum cb_status read_list(struct cb_json *json, const char *key, const json_t *list,
                                read_item_fn *read_item, struct cb_scene *s, size_t *count) {
  const size_t size = json_array_size(list); /* 0 for NULL */
  cb_json_enter(json, key, 0);
  if (size > CB_SCENE_LIST)
    return cb_json_fail(json, "'%s' has %zu entries; at most %d are allowed", key, size,
                        CB_SCENE_LIST);
  for (size_t i = 0; i < size; i++) {
    cb_json_enter(json, NULL, i);
    enum cb_status status = read_item(json, json_array_get(list, i), s, i);
    if (status) return status;
    cb_json_leave(json);
  }
  cb_json_leave(json);
  *count = size;
  return CB_OK;
}

/* ---- start, damping, needs --------------------------------------------------------- */

static enum cb_status read_start(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const struct cb_field fields[] = {
      {"velocity_m_s", CB_FIELD_VECTOR, s->velocity, -ANY, ANY, false},
      {"spin_rad_s", CB_FIELD_VECTOR, s->spin, -ANY, ANY, false},
      {"stretch", CB_FIELD_VECTOR, s->stretch, -ANY, ANY, false},
      {"twist_rad", CB_FIELD_NUMBER, &s->twist, -ANY, ANY, false}};
  return read_object(json, "start", object, fields, COUNT(fields));
}

static enum cb_status read_damping(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const struct cb_field fields[] = {{"stiffness_s", CB_FIELD_NUMBER, &s->alpha, 0, ANY, false},
                                    {"mass_1_s", CB_FIELD_NUMBER, &s->beta, 0, ANY, false}};
  return read_object(json, "damping", object, fields, COUNT(fields));
}

static enum cb_status read_needs(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  struct cb_needs *n = &s->needs;
  static const enum cb_law laws[] = {CB_LAW_ROTATION, CB_LAW_NEWTON, CB_LAW_EULER, CB_LAW_ENERGY,
                                     CB_LAW_ORDER};
  bool asked[COUNT(laws)] = {false};
  struct cb_field fields[COUNT(laws) + 5] = {
      {"displacement_error", CB_FIELD_NUMBER, &n->displacement, TINY, ANY, false},
      {"torque", CB_FIELD_NUMBER, &n->torque, TINY, ANY, false},
      {"energy_error", CB_FIELD_NUMBER, &n->energy, TINY, ANY, false},
      {"frames_per_s", CB_FIELD_NUMBER, &n->frames_per_s, TINY, ANY, false},
      {"inversion", CB_FIELD_FLAG, &n->inversion, 0, 0, false}};
  for (size_t i = 0; i < COUNT(laws); i++)
    fields[5 + i] = (struct cb_field){cb_law_name[laws[i]], CB_FIELD_FLAG, &asked[i], 0, 0, false};
  enum cb_status status = read_object(json, "needs", object, fields, COUNT(fields));
  for (size_t i = 0; i < COUNT(laws); i++)
    if (asked[i]) n->laws |= CB_KEEPS(laws[i]);
  return status;
}

/* ---- the whole ------------------------------------------------------------------- */

static enum cb_status read_scene(struct cb_json *json, struct cb_scene *s) {
  const char *about = NULL;
  json_t *geometry = NULL, *material = NULL, *fixed = NULL, *loads = NULL, *handles = NULL;
  json_t *start = NULL, *damping = NULL, *needs = NULL;
  const struct cb_field fields[] = {{"about", CB_FIELD_TEXT, &about, 0, 0, true},
                                    {"geometry", CB_FIELD_OBJECT, &geometry, 0, 0, true},
                                    {"material", CB_FIELD_OBJECT, &material, 0, 0, true},
                                    {"fixed", CB_FIELD_LIST, &fixed, 0, 0, false},
                                    {"loads", CB_FIELD_LIST, &loads, 0, 0, false},
                                    {"handles", CB_FIELD_LIST, &handles, 0, 0, false},
                                    {"gravity_m_s2", CB_FIELD_VECTOR, s->gravity, -ANY, ANY, false},
                                    {"start", CB_FIELD_OBJECT, &start, 0, 0, false},
                                    {"damping", CB_FIELD_OBJECT, &damping, 0, 0, false},
                                    {"step_s", CB_FIELD_NUMBER, &s->step, TINY, ANY, true},
                                    {"duration_s", CB_FIELD_NUMBER, &s->duration, TINY, ANY, true},
                                    {"needs", CB_FIELD_OBJECT, &needs, 0, 0, true}};
  enum cb_status status = cb_json_object(json, json->root, fields, COUNT(fields));
  if (!status) status = read_geometry(json, geometry, s);
  if (!status) status = read_material(json, material, s);
  if (!status) status = read_list(json, "fixed", fixed, read_fixed, s, &s->fixed_count);
  if (!status) status = read_list(json, "loads", loads, read_load, s, &s->load_count);
  if (!status) status = read_list(json, "handles", handles, read_handle, s, &s->handle_count);
  if (!status && start) status = read_start(json, start, s);
  if (!status && damping) status = read_damping(json, damping, s);
  if (!status) status = read_needs(json, needs, s);
  if (status) return status;
  snprintf(s->about, sizeof s->about, "%s", about);
  cb_json_enter(json, "duration_s", 0);
  const double steps = s->duration / s->step;
  if (!(steps >= 1 && steps <= 1e7))
    return cb_json_fail(json, "'duration_s' is %g steps of 'step_s'; it must be 1 to 10000000",
                        steps);
  return CB_OK;
}

static void name_scene(const char *path, char name[64]) {
  const char *slash = strrchr(path, '/');
  snprintf(name, 64, "%s", slash ? slash + 1 : path);
  char *dot = strrchr(name, '.');
  if (dot) *dot = '\0';
}

enum cb_status cb_scene_read(const char *path, struct cb_scene *scene) {
  struct cb_json json;
  struct cb_scene s = {.scale = 1,
                       .stretch = {1, 1, 1},
                       .needs = {.displacement = INFINITY, .torque = INFINITY, .energy = INFINITY}};
  name_scene(path, s.name);
  enum cb_status status = cb_json_open(path, &json);
  if (!status) status = read_scene(&json, &s);
  cb_json_close(&json);
  if (!status) *scene = s;
  return status;
}
