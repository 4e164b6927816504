/* film.c - see film.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/faces.h"
#include "harness/files/vtk.h"

struct cb_film_face {
  uint32_t node[3]; /* seen from outside at rest: counterclockwise */
  uint32_t tet;
};

/* ---- the boundary ----------------------------------------------------------------------- */

static void cross(const double *x, const uint32_t *node, double *n) {
  double u[3], v[3];
  for (int k = 0; k < 3; k++) {
    u[k] = x[3 * node[1] + k] - x[3 * node[0] + k];
    v[k] = x[3 * node[2] + k] - x[3 * node[0] + k];
  }
  for (int k = 0; k < 3; k++)
    n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
}

/* Turned so that the tetrahedron is behind it. */
static struct cb_film_face turned(const struct cb_mesh *mesh, const struct cb_face *face) {
  const uint32_t *t = mesh->tet + 4 * face->tet;
  struct cb_film_face f = {.tet = face->tet};
  double n[3], out = 0;
  memcpy(f.node, face->node, sizeof f.node);
  cross(mesh->X, f.node, n);
  for (int j = 0; j < 4; j++) /* of its own nodes nothing is added */
    for (int k = 0; k < 3; k++) out += n[k] * (mesh->X[3 * f.node[0] + k] - mesh->X[3 * t[j] + k]);
  if (out > 0) return f;
  const uint32_t swap = f.node[1];
  f.node[1] = f.node[2], f.node[2] = swap;
  return f;
}

/* Those that only one tetrahedron has. */
static enum cb_status find_faces(struct cb_film *film) {
  const struct cb_mesh *mesh = &film->body->at.mesh;
  const size_t all = 4 * mesh->tets;
  struct cb_face *face = cb_faces_create(mesh->tets, mesh->tet);
  film->face = malloc(all * sizeof *film->face);
  const bool there = face && film->face;
  for (size_t first = 0, next; there && first < all; first = next) {
    for (next = first + 1; next < all && cb_face_same(face + first, face + next);) next++;
    if (next == first + 1) film->face[film->faces++] = turned(mesh, face + first);
  }
  free(face);
  return there ? CB_OK : cb_fail_memory("the pictures");
}

/* ---- one picture ---------------------------------------------------------------------------- */

static bool is_inverted(const struct cb_mesh *mesh, size_t e, const double *x) {
  const uint32_t *t = mesh->tet + 4 * e;
  double n[3], six = 0;
  cross(x, t, n);
  for (int k = 0; k < 3; k++) six += n[k] * (x[3 * t[3] + k] - x[3 * t[0] + k]);
  return six * cb_mesh_six_volumes(mesh, e) < 0;
}

/* Of a face that light from above, in front and the left falls on: 1 where it faces it. */
static double shade(const double *n) {
  static const double light[3] = {-0.36, -0.64, 0.68};
  const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0)) return 0.5;
  return 0.5 + 0.5 * (light[0] * n[0] + light[1] * n[1] + light[2] * n[2]) / length;
}

static void write_faces(struct cb_film *film, const double *x) {
  FILE *f = film->shape.stream;
  for (size_t i = 0; i < film->faces; i++) {
    const struct cb_film_face *face = &film->face[i];
    double n[3];
    cross(x, face->node, n);
    for (int j = 0; j < 4; j++) {
      const double *p = x + 3 * face->node[j < 3 ? j : 2];
      fprintf(f, "%.5g %.5g %.5g %.3f %d\n%s", p[0], p[1], p[2], shade(n),
              is_inverted(&film->body->at.mesh, face->tet, x), j % 2 ? "\n" : "");
    }
    fputs("nan nan nan 0 0\nnan nan nan 0 0\n\n", f);
  }
  fputc('\n', f);
}

/* The mean place of chosen nodes. */
static void write_grip(FILE *f, size_t count, const uint32_t *node, const double *x, int moved) {
  double c[3] = {0};
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) c[k] += x[3 * node[i] + k] / (double)count;
  fprintf(f, "%.5g %.5g %.5g %d\n", c[0], c[1], c[2], moved);
}

static enum cb_status write_grips(struct cb_film *film, double t, const double *x) {
  const struct cb_body *b = film->body;
  uint32_t *node = malloc(b->at.mesh.nodes * sizeof *node);
  size_t written = 0;
  if (!node) return cb_fail_memory("the pictures");
  for (size_t n = 0; n < b->scene->fixed_count; n++, written++)
    write_grip(film->grips.stream, cb_body_chosen(b, &b->scene->fixed[n], node), node, x, 0);
  for (size_t n = 0; n < b->scene->handle_count; n++) {
    if (!cb_handle_holds(b->grip[n].handle, t)) continue;
    write_grip(film->grips.stream, b->grip[n].count, b->grip[n].node, x, 1);
    written++;
  }
  if (!written) fputs("nan nan nan 0\n", film->grips.stream); /* keeps the place of the picture */
  fputs("\n\n", film->grips.stream);
  free(node);
  return CB_OK;
}

enum cb_status cb_film_see(void *context, double t, const double *x) {
  struct cb_film *film = context;
  const struct cb_body *b = film->body;
  struct cb_picture *now = film->picture + film->count;
  char name[128];
  for (size_t i = 0; i < 3 * b->at.mesh.nodes; i++)
    if (!isfinite(x[i])) return CB_OK; /* the outcome says so */
  if (film->count == film->room) return CB_OK;
  *now = (struct cb_picture){.time = t, .distance = cb_body_distance(b, x)};
  for (size_t e = 0; e < b->at.mesh.tets; e++) now->inverted += is_inverted(&b->at.mesh, e, x);
  for (size_t i = 0; film->count && i < 3 * b->at.mesh.nodes; i += 3)
    now->way += hypot(hypot(x[i] - film->before[i], x[i + 1] - film->before[i + 1]),
                      x[i + 2] - film->before[i + 2]) /
                (b->size * (double)b->at.mesh.nodes);
  if (film->count) now->way += now[-1].way;
  memcpy(film->before, x, 3 * b->at.mesh.nodes * sizeof *x);
  cb_vtk_name(b->scene->name, film->count++, name);
  write_faces(film, x);
  enum cb_status status = write_grips(film, t, x);
  return status ? status : cb_vtk_write(film->directory, name, &b->at.mesh, x);
}

/* ---- the whole --------------------------------------------------------------------------------
 */

enum cb_status cb_film_open(const struct cb_body *body, const char *directory, size_t most,
                            struct cb_film *film) {
  struct cb_film made = {.body = body, .directory = directory, .room = most};
  char name[128];
  made.picture = malloc(most * sizeof *made.picture);
  made.before = malloc(3 * body->at.mesh.nodes * sizeof *made.before);
  enum cb_status status = made.picture && made.before ? CB_OK : cb_fail_memory("the pictures");
  if (!status) status = find_faces(&made);
  if (!status) status = cb_output_directory(directory);
  snprintf(name, sizeof name, "%s-faces.txt", body->scene->name);
  if (!status) status = cb_output_open(&made.shape, directory, name);
  snprintf(name, sizeof name, "%s-grips.txt", body->scene->name);
  if (!status) status = cb_output_open(&made.grips, directory, name);
  if (status)
    cb_film_abandon(&made);
  else
    *film = made;
  return status;
}

void cb_film_abandon(struct cb_film *film) {
  cb_output_abandon(&film->shape);
  cb_output_abandon(&film->grips);
  free(film->picture);
  free(film->before);
  free(film->face);
  *film = (struct cb_film){0};
}

/* Which picture is the n-th of the strip: a third by time, the rest by the way gone. */
static size_t of_strip(const struct cb_film *film, size_t n) {
  const struct cb_picture *last = film->picture + film->count - 1;
  const double part = (double)n / (CB_STRIP - 1);
  size_t best = 0;
  double least = INFINITY;
  for (size_t i = 0; i < film->count; i++) {
    const struct cb_picture *p = film->picture + i;
    const double time = last->time > 0 ? p->time / last->time : 0;
    const double way = last->way > 0 ? p->way / last->way : time;
    const double off = fabs((time + 2 * way) / 3 - part);
    if (off < least) least = off, best = i;
  }
  return best;
}

/* The picture before something lets go or is raised, in place of the nearest one. */
static void put_event(const struct cb_film *film, double time, size_t strip[CB_STRIP]) {
  size_t event = 0, nearest = 1;
  while (event + 1 < film->count && film->picture[event + 1].time <= time * (1 + 1e-9)) event++;
  for (size_t n = 1; n + 1 < CB_STRIP; n++) {
    const double off = fabs(film->picture[strip[n]].time - time);
    if (off < fabs(film->picture[strip[nearest]].time - time)) nearest = n;
  }
  strip[nearest] = event;
}

static void choose_strip(const struct cb_film *film, size_t strip[CB_STRIP]) {
  const struct cb_scene *s = film->body->scene;
  for (size_t n = 0; n < CB_STRIP; n++) strip[n] = of_strip(film, n);
  if (s->stage_count) put_event(film, s->stage[0].from, strip);
  for (size_t n = 0; n < s->handle_count; n++)
    if (s->handle[n].until > 0) put_event(film, s->handle[n].until, strip);
}

static enum cb_status write_table(const struct cb_film *film) {
  char name[128];
  size_t strip[CB_STRIP];
  struct cb_table *t =
      cb_table_create("picture,time_s,inverted,tetrahedra,distance,ground_m,strip");
  enum cb_status status = t ? CB_OK : cb_fail_memory("the pictures");
  choose_strip(film, strip);
  for (size_t i = 0; !status && i < film->count; i++) {
    cb_table_integer(t, (long long)i);
    cb_table_number(t, film->picture[i].time);
    cb_table_integer(t, (long long)film->picture[i].inverted);
    cb_table_integer(t, (long long)film->body->at.mesh.tets);
    cb_table_number(t, film->picture[i].distance);
    if (film->body->scene->grounded)
      cb_table_number(t, film->body->scene->ground);
    else
      cb_table_missing(t);
    bool in_strip = film->count <= CB_STRIP;
    for (size_t n = 0; n < CB_STRIP; n++) in_strip |= strip[n] == i;
    cb_table_integer(t, in_strip);
  }
  snprintf(name, sizeof name, "%s-film.csv", film->body->scene->name);
  if (!status) status = cb_output_table(film->directory, name, t, CB_CSV);
  cb_table_free(t);
  return status;
}

enum cb_status cb_film_close(struct cb_film *film) {
  double *times = malloc((film->count + 1) * sizeof *times);
  enum cb_status status = times ? CB_OK : cb_fail_memory("the pictures");
  for (size_t i = 0; times && i < film->count; i++) times[i] = film->picture[i].time;
  if (!status) status = cb_vtk_series(film->directory, film->body->scene->name, film->count, times);
  if (!status) status = cb_output_commit(&film->shape);
  if (!status) status = cb_output_commit(&film->grips);
  if (!status) status = write_table(film);
  free(times);
  cb_film_abandon(film);
  return status;
}
