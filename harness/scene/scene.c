/* scene.c - see scene.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/scene.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/scene/parts.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
static const double ANY = DBL_MAX, TINY = DBL_MIN;

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
  for (int k = 0; !c->face && k < 3; k++)
    if (c->low[k] > c->high[k])
      return cb_json_fail(json, "'low' is %g and 'high' %g along %c; 'low' must not be the higher",
                          c->low[k], c->high[k], "xyz"[k]);
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
  struct cb_field fields[SELECTION_FIELDS + 4];
  selection_fields(&c, fields);
  fields[SELECTION_FIELDS] =
      (struct cb_field){"turn_rad", CB_FIELD_VECTOR, h->turn, -ANY, ANY, false};
  fields[SELECTION_FIELDS + 1] =
      (struct cb_field){"move_m", CB_FIELD_VECTOR, h->move, -ANY, ANY, false};
  fields[SELECTION_FIELDS + 2] =
      (struct cb_field){"over_s", CB_FIELD_NUMBER, &h->over, TINY, ANY, true};
  fields[SELECTION_FIELDS + 3] =
      (struct cb_field){"until_s", CB_FIELD_NUMBER, &h->until, TINY, ANY, false};
  enum cb_status status = cb_json_object(json, object, fields, COUNT(fields));
  return status ? status : to_selection(json, &c, &h->where);
}

static enum cb_status read_stage(struct cb_json *json, const json_t *object, struct cb_scene *s,
                                 size_t n) {
  struct cb_stiffening *stage = &s->stage[n];
  struct cb_material unused;
  const double before = n ? s->stage[n - 1].from : 0;
  const struct cb_field fields[] = {{"from_s", CB_FIELD_NUMBER, &stage->from, TINY, ANY, true},
                                    {"young_pa", CB_FIELD_NUMBER, &stage->young, 0, ANY, true}};
  enum cb_status status = cb_json_object(json, object, fields, COUNT(fields));
  if (status) return status;
  if (!(stage->from > before && stage->from < s->duration))
    return cb_json_fail(json,
                        "'from_s' is %g; it must be above %g, where the stage before begins, and "
                        "below 'duration_s', %g",
                        stage->from, before, s->duration);
  return cb_material_isotropic(stage->young, s->material.poisson, s->material.density, &unused)
             ? cb_json_fail(json, "'young_pa' is %g; the stresses would not be finite",
                            stage->young)
             : CB_OK;
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
  return cb_json_member(json, "start", object, fields, COUNT(fields));
}

static enum cb_status read_damping(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  const struct cb_field fields[] = {{"stiffness_s", CB_FIELD_NUMBER, &s->alpha, 0, ANY, false},
                                    {"mass_1_s", CB_FIELD_NUMBER, &s->beta, 0, ANY, false}};
  return cb_json_member(json, "damping", object, fields, COUNT(fields));
}

static enum cb_status read_needs(struct cb_json *json, const json_t *object, struct cb_scene *s) {
  struct cb_needs *n = &s->needs;
  static const enum cb_law laws[] = {CB_LAW_ROTATION, CB_LAW_NEWTON, CB_LAW_EULER, CB_LAW_ENERGY,
                                     CB_LAW_ORDER};
  bool asked[COUNT(laws)] = {false};
  struct cb_field fields[COUNT(laws) + 6] = {
      {"displacement_error", CB_FIELD_NUMBER, &n->displacement, TINY, ANY, false},
      {"torque", CB_FIELD_NUMBER, &n->torque, TINY, ANY, false},
      {"energy_error", CB_FIELD_NUMBER, &n->energy, TINY, ANY, false},
      {"frames_per_s", CB_FIELD_NUMBER, &n->frames_per_s, TINY, ANY, false},
      {"rest_distance", CB_FIELD_NUMBER, &n->rest, TINY, ANY, false},
      {"inversion", CB_FIELD_FLAG, &n->inversion, 0, 0, false}};
  for (size_t i = 0; i < COUNT(laws); i++)
    fields[6 + i] = (struct cb_field){cb_law_name[laws[i]], CB_FIELD_FLAG, &asked[i], 0, 0, false};
  enum cb_status status = cb_json_member(json, "needs", object, fields, COUNT(fields));
  for (size_t i = 0; i < COUNT(laws); i++)
    if (asked[i]) n->laws |= CB_KEEPS(laws[i]);
  return status;
}

/* ---- the whole ------------------------------------------------------------------- */

/* What no key is wrong in by itself. */
static enum cb_status check_whole(struct cb_json *json, const char *about, struct cb_scene *s) {
  const double steps = s->duration / s->step;
  const size_t length = strlen(about);
  if (!(steps >= 1 && steps <= 1e7)) {
    cb_json_enter(json, "duration_s", 0);
    return cb_json_fail(json, "'duration_s' is %g steps of 'step_s'; it must be 1 to 10000000",
                        steps);
  }
  if (!length || length >= sizeof s->about) {
    cb_json_enter(json, "about", 0);
    return cb_json_fail(json, "'about' has %zu bytes; it must be a sentence of 1 to %zu", length,
                        sizeof s->about - 1);
  }
  if (s->handle_count && s->alpha > 0) { /* the stepper takes what is held as standing still */
    cb_json_enter(json, "damping", 0);
    return cb_json_fail(json, "'stiffness_s' would drag on what moves with 'handles'; leave one "
                              "out, or damp by 'mass_1_s'");
  }
  memcpy(s->about, about, length + 1);
  return CB_OK;
}

static enum cb_status read_scene(struct cb_json *json, struct cb_scene *s) {
  const char *about = NULL;
  json_t *geometry = NULL, *material = NULL, *fixed = NULL, *loads = NULL, *handles = NULL;
  json_t *stiffness = NULL, *start = NULL, *damping = NULL, *needs = NULL;
  s->ground = NAN;
  const struct cb_field fields[] = {{"about", CB_FIELD_TEXT, &about, 0, 0, true},
                                    {"geometry", CB_FIELD_OBJECT, &geometry, 0, 0, true},
                                    {"material", CB_FIELD_OBJECT, &material, 0, 0, true},
                                    {"fixed", CB_FIELD_LIST, &fixed, 0, 0, false},
                                    {"loads", CB_FIELD_LIST, &loads, 0, 0, false},
                                    {"handles", CB_FIELD_LIST, &handles, 0, 0, false},
                                    {"stiffness", CB_FIELD_LIST, &stiffness, 0, 0, false},
                                    {"gravity_m_s2", CB_FIELD_VECTOR, s->gravity, -ANY, ANY, false},
                                    {"ground_m", CB_FIELD_NUMBER, &s->ground, -ANY, ANY, false},
                                    {"start", CB_FIELD_OBJECT, &start, 0, 0, false},
                                    {"damping", CB_FIELD_OBJECT, &damping, 0, 0, false},
                                    {"step_s", CB_FIELD_NUMBER, &s->step, TINY, ANY, true},
                                    {"duration_s", CB_FIELD_NUMBER, &s->duration, TINY, ANY, true},
                                    {"needs", CB_FIELD_OBJECT, &needs, 0, 0, true}};
  enum cb_status status = cb_json_object(json, json->root, fields, COUNT(fields));
  if (!status) status = cb_scene_geometry(json, geometry, s);
  if (!status) status = cb_scene_material(json, material, s);
  if (!status) status = read_list(json, "fixed", fixed, read_fixed, s, &s->fixed_count);
  if (!status) status = read_list(json, "loads", loads, read_load, s, &s->load_count);
  if (!status) status = read_list(json, "handles", handles, read_handle, s, &s->handle_count);
  if (!status) status = read_list(json, "stiffness", stiffness, read_stage, s, &s->stage_count);
  if (!status && start) status = read_start(json, start, s);
  if (!status && damping) status = read_damping(json, damping, s);
  if (!status) status = read_needs(json, needs, s);
  if (!status) status = check_whole(json, about, s);
  s->grounded = !isnan(s->ground);
  return status;
}

static void name_scene(const char *path, char name[64]) {
  const char *slash = strrchr(path, '/');
  snprintf(name, 64, "%s", slash ? slash + 1 : path);
  char *dot = strrchr(name, '.');
  if (dot) *dot = '\0';
}

/* *json has been opened, with that status. */
static enum cb_status read_opened(enum cb_status status, struct cb_json *json, const char *path,
                                  struct cb_scene *scene) {
  const struct cb_needs none = {
      .displacement = INFINITY, .torque = INFINITY, .energy = INFINITY, .rest = INFINITY};
  struct cb_scene s = {.scale = 1, .stretch = {1, 1, 1}, .needs = none};
  name_scene(path, s.name);
  if (!status) status = read_scene(json, &s);
  cb_json_close(json);
  if (!status) *scene = s;
  return status;
}

enum cb_status cb_scene_read(const char *path, struct cb_scene *scene) {
  struct cb_json json;
  enum cb_status status = read_opened(cb_json_open(path, &json), &json, path, scene);
  if (!status) snprintf(scene->path, sizeof scene->path, "%s", path);
  return status;
}

enum cb_status cb_scene_parse(const char *name, const char *text, struct cb_scene *scene) {
  struct cb_json json;
  return read_opened(cb_json_parse(name, text, &json), &json, name, scene);
}

enum cb_status cb_scene_fail(const struct cb_scene *scene, const char *list, size_t n,
                             const char *sentence) {
  struct cb_json json;
  enum cb_status status = cb_json_open(scene->path, &json);
  if (!status) {
    cb_json_enter(&json, list, 0);
    cb_json_enter(&json, NULL, n);
    status = cb_json_fail(&json, "entry %zu of '%s' %s", n + 1, list, sentence);
  } else
    status =
        cb_fail(CB_INPUT, "scene '%s': entry %zu of '%s' %s", scene->name, n + 1, list, sentence);
  cb_json_close(&json);
  return status;
}
