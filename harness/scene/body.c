/* body.c - see body.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/order.h"

/* ---- geometry -------------------------------------------------------------------- */

static enum cb_status make_mesh(const struct cb_scene *s, double resolution, struct cb_mesh *mesh) {
  size_t cells[3];
  if (s->mesh_path[0]) {
    enum cb_status status = cb_mesh_read(s->mesh_path, mesh, NULL);
    for (size_t i = 0; !status && i < 3 * mesh->nodes; i++) mesh->X[i] *= s->scale;
    return status ? status : cb_order_apply(mesh);
  }
  if (s->shape[0]) {
    const double along = fmax(4, round(resolution * (double)s->cells[0]));
    enum cb_status status = cb_mesh_shape(s->shape, (size_t)along, s->cell, mesh);
    return status ? status : cb_order_apply(mesh);
  }
  for (int i = 0; i < 3; i++) cells[i] = (size_t)fmax(1, round(resolution * (double)s->cells[i]));
  enum cb_status status = cb_mesh_grid(cells[0], cells[1], cells[2], 1, mesh);
  /* of the same size at every resolution, so its cells are not always cubes */
  for (size_t i = 0; !status && i < 3 * mesh->nodes; i++)
    mesh->X[i] *= s->cell * (double)s->cells[i % 3] / (double)cells[i % 3];
  return status;
}

static bool chosen(const struct cb_selection *where, const struct cb_box *box, const double *X) {
  for (int i = 0; i < 3; i++) {
    const double at = (X[i] - box->low[i]) / (box->high[i] - box->low[i]);
    if (!(at > where->low[i] - 1e-6 && at < where->high[i] + 1e-6)) return false;
  }
  return true;
}

size_t cb_body_chosen(const struct cb_body *body, const struct cb_selection *where,
                      uint32_t *node) {
  const struct cb_box box = cb_mesh_bounds(&body->at.mesh);
  size_t count = 0;
  for (uint32_t i = 0; i < body->at.mesh.nodes; i++)
    if (chosen(where, &box, body->at.mesh.X + 3 * i)) node[count++] = i;
  return count;
}

/* How many nodes are chosen; none is refused. */
static enum cb_status count_chosen(const struct cb_body *b, const struct cb_box *box,
                                   const struct cb_selection *where, const char *what, size_t n,
                                   size_t *count) {
  *count = 0;
  for (size_t i = 0; i < b->at.mesh.nodes; i++) *count += chosen(where, box, b->at.mesh.X + 3 * i);
  if (*count) return CB_OK;
  return cb_scene_fail(b->scene, what, n, "holds no node; widen its box");
}

/* ---- what is held, moved and pushed ------------------------------------------------ */

static enum cb_status hold(struct cb_body *b, const struct cb_box *box) {
  enum cb_status status = CB_OK;
  size_t count;
  for (size_t i = 0; i < b->at.mesh.nodes; i++) b->at.fixed[i] = !(b->at.mass[i] > 0);
  for (size_t n = 0; !status && n < b->scene->fixed_count; n++) {
    const struct cb_selection *where = &b->scene->fixed[n];
    status = count_chosen(b, box, where, "fixed", n, &count);
    for (size_t i = 0; i < b->at.mesh.nodes; i++)
      b->at.fixed[i] |= chosen(where, box, b->at.mesh.X + 3 * i);
  }
  return status;
}

static enum cb_status grip(struct cb_body *b, const struct cb_box *box, size_t n) {
  struct cb_grip *g = &b->grip[n];
  g->handle = &b->scene->handle[n];
  size_t count, filled = 0;
  enum cb_status status = count_chosen(b, box, &g->handle->where, "handles", n, &count);
  if (status) return status;
  g->node = malloc(count * sizeof *g->node);
  if (!g->node) return cb_fail_memory("the handles");
  for (uint32_t i = 0; i < b->at.mesh.nodes; i++) {
    const double *X = b->at.mesh.X + 3 * i;
    if (!chosen(&g->handle->where, box, X)) continue;
    b->at.fixed[i] = 1;
    g->node[filled++] = i;
    for (int k = 0; k < 3; k++) g->centre[k] += X[k] / (double)count;
  }
  g->count = count;
  return CB_OK;
}

static enum cb_status push(struct cb_body *b, const struct cb_box *box) {
  const struct cb_scene *s = b->scene;
  const struct cb_mesh *mesh = &b->at.mesh;
  enum cb_status status = CB_OK;
  const bool heavy = s->gravity[0] != 0 || s->gravity[1] != 0 || s->gravity[2] != 0;
  if (!heavy && !s->load_count) return CB_OK;
  b->external = calloc(mesh->nodes, 3 * sizeof *b->external);
  if (!b->external) return cb_fail_memory("the loads");
  for (size_t i = 0; i < 3 * mesh->nodes; i++)
    b->external[i] = s->gravity[i % 3] * b->at.mass[i / 3];
  for (size_t n = 0; !status && n < s->load_count; n++) {
    const struct cb_load *load = &s->load[n];
    double mass = 0;
    size_t count, free = 0;
    status = count_chosen(b, box, &load->where, "loads", n, &count);
    for (size_t i = 0; i < mesh->nodes; i++)
      if (chosen(&load->where, box, mesh->X + 3 * i)) {
        mass += b->at.mass[i];
        free += !b->at.fixed[i];
      }
    if (!status && !free)
      status = cb_scene_fail(b->scene, "loads", n, "pushes only nodes that are held or moved");
    for (size_t i = 0; i < 3 * mesh->nodes; i++)
      if (chosen(&load->where, box, mesh->X + i / 3 * 3))
        b->external[i] += load->force[i % 3] * b->at.mass[i / 3] / mass;
  }
  return status;
}

/* ---- the start ----------------------------------------------------------------------- */

static void centre_of_mass(const struct cb_bench_scene *at, double *c) {
  double mass = 0;
  c[0] = c[1] = c[2] = 0;
  for (size_t i = 0; i < at->mesh.nodes; i++) {
    mass += at->mass[i];
    for (int k = 0; k < 3; k++) c[k] += at->mass[i] * at->mesh.X[3 * i + k];
  }
  for (int k = 0; k < 3; k++) c[k] /= mass;
}

/* Stretched about the centre of mass, twisted about the vertical axis through the
 * middle, moving and spinning. */
static void start(struct cb_body *b, const struct cb_box *box) {
  const struct cb_scene *s = b->scene;
  double c[3];
  centre_of_mass(&b->at, c);
  for (size_t i = 0; i < b->at.mesh.nodes; i++) {
    const double *X = b->at.mesh.X + 3 * i;
    double *x = b->at.x + 3 * i, *v = b->at.v + 3 * i, r[3];
    const bool held = b->at.fixed[i];
    const double angle = s->twist * (X[2] - box->low[2]) / (box->high[2] - box->low[2]);
    const double rx = X[0] - (box->low[0] + box->high[0]) / 2;
    const double ry = X[1] - (box->low[1] + box->high[1]) / 2;
    for (int k = 0; k < 3; k++) x[k] = held ? X[k] : c[k] + s->stretch[k] * (X[k] - c[k]);
    if (!held && angle != 0) {
      x[0] += cos(angle) * rx - sin(angle) * ry - rx;
      x[1] += sin(angle) * rx + cos(angle) * ry - ry;
    }
    for (int k = 0; k < 3; k++) r[k] = x[k] - c[k];
    for (int k = 0; k < 3; k++)
      v[k] = held ? 0
                  : s->velocity[k] + s->spin[(k + 1) % 3] * r[(k + 2) % 3] -
                        s->spin[(k + 2) % 3] * r[(k + 1) % 3];
  }
}

/* ---- points --------------------------------------------------------------------------- */

/* Chosen in the scene's own mesh, found in this one. */
static enum cb_status find_points(struct cb_body *b, double resolution) {
  double P[3 * CB_POINTS];
  struct cb_mesh own = {0};
  enum cb_status status = resolution == 1 ? CB_OK : make_mesh(b->scene, 1, &own);
  if (!status) {
    cb_points_choose(resolution == 1 ? &b->at.mesh : &own, P);
    cb_points_find(&b->at.mesh, P, b->point);
  }
  cb_mesh_free(&own);
  return status;
}

void cb_body_points(const struct cb_body *body, const double *x, double *p) {
  cb_points_place(body->point, x, p);
}

/* ---- handles in time --------------------------------------------------------------------- */

/* r := turned about the axis, by its length (Rodrigues). */
static void turn(const double *axis, double *r) {
  const double angle = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  if (!(angle > 0)) return;
  const double n[3] = {axis[0] / angle, axis[1] / angle, axis[2] / angle};
  const double along = n[0] * r[0] + n[1] * r[1] + n[2] * r[2], c = cos(angle), s = sin(angle);
  double q[3];
  for (int k = 0; k < 3; k++)
    q[k] = c * r[k] + (1 - c) * along * n[k] +
           s * (n[(k + 1) % 3] * r[(k + 2) % 3] - n[(k + 2) % 3] * r[(k + 1) % 3]);
  memcpy(r, q, sizeof q);
}

bool cb_handle_holds(const struct cb_handle *handle, double t) {
  return !(handle->until > 0) || t <= handle->until * (1 + 1e-9);
}

void cb_body_grip(const struct cb_body *body, double t, double *x) {
  for (size_t n = 0; n < body->scene->handle_count; n++) {
    const struct cb_grip *g = &body->grip[n];
    if (!cb_handle_holds(g->handle, t)) continue;
    const double way = fmin(1, t / g->handle->over);
    const double axis[3] = {way * g->handle->turn[0], way * g->handle->turn[1],
                            way * g->handle->turn[2]};
    for (size_t i = 0; i < g->count; i++) {
      double r[3];
      for (int k = 0; k < 3; k++) r[k] = body->at.mesh.X[3 * g->node[i] + k] - g->centre[k];
      turn(axis, r);
      for (int k = 0; k < 3; k++)
        x[3 * g->node[i] + k] = g->centre[k] + r[k] + way * g->handle->move[k];
    }
  }
}

/* ---- the whole --------------------------------------------------------------------------- */

static enum cb_status fill(struct cb_body *b, double resolution) {
  struct cb_bench_scene *at = &b->at;
  const size_t nodes = at->mesh.nodes;
  const struct cb_box box = cb_mesh_bounds(&at->mesh);
  at->material = b->scene->material;
  at->mass = malloc(nodes * sizeof *at->mass);
  at->fixed = malloc(nodes);
  b->anchored = malloc(nodes);
  at->x = malloc(3 * nodes * sizeof *at->x);
  at->v = malloc(3 * nodes * sizeof *at->v);
  if (!at->mass || !at->fixed || !b->anchored || !at->x || !at->v)
    return cb_fail_memory("the scene");
  for (int k = 0; k < 3; k++) b->size = fmax(b->size, box.high[k] - box.low[k]);
  cb_mesh_mass(&at->mesh, at->material.density, at->mass);
  enum cb_status status = hold(b, &box);
  memcpy(b->anchored, at->fixed, nodes);
  for (size_t n = 0; !status && n < b->scene->handle_count; n++) status = grip(b, &box, n);
  if (!status) status = push(b, &box);
  if (status) return status;
  start(b, &box);
  return find_points(b, resolution);
}

static bool all_finite(size_t n, const double *a) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(a[i])) return false;
  return true;
}

/* What a scene asks for may be no number, or become none: nothing such is passed on. */
static enum cb_status check(const struct cb_body *b) {
  const struct cb_bench_scene *at = &b->at;
  const size_t length = 3 * at->mesh.nodes;
  const char *what = !all_finite(length, at->mesh.X)                   ? "a place at rest"
                     : !all_finite(at->mesh.nodes, at->mass)           ? "a mass"
                     : b->external && !all_finite(length, b->external) ? "a load"
                     : !all_finite(length, at->x)                      ? "a place at the start"
                     : !all_finite(length, at->v)                      ? "a velocity"
                                                                       : NULL;
  if (!what) return CB_OK;
  return cb_fail(CB_INPUT, "scene '%s': %s is not a finite number; correct what it is made of",
                 b->scene->name, what);
}

enum cb_status cb_body_create(const struct cb_scene *scene, double resolution,
                              struct cb_body *body) {
  struct cb_body made = {.scene = scene};
  enum cb_status status = make_mesh(scene, resolution, &made.at.mesh);
  if (!status) status = fill(&made, resolution);
  if (!status) status = check(&made);
  if (status)
    cb_body_free(&made);
  else
    *body = made;
  return status;
}

void cb_body_free(struct cb_body *body) {
  for (size_t n = 0; n < CB_SCENE_LIST; n++) free(body->grip[n].node);
  free(body->anchored);
  free(body->external);
  cb_bench_scene_free(&body->at);
  *body = (struct cb_body){0};
}
