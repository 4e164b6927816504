/* Bodies of an implicit surface: one piece, upright, of the promised quality, closed, and
 * of about the same volume whatever the resolution.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/scene/run.h"

static const char *const NAMES[] = {"rabbit", "liver"};

static double quality(const struct cb_mesh *m, size_t e) {
  double square = 0;
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < a; b++)
      for (int k = 0; k < 3; k++) {
        const double d =
            m->X[3 * m->tet[4 * e + (size_t)a] + k] - m->X[3 * m->tet[4 * e + (size_t)b] + k];
        square += d * d;
      }
  return M_SQRT2 * cb_mesh_six_volumes(m, e) / pow(square / 6, 1.5);
}

static int by_face(const void *a, const void *b) { return memcmp(a, b, 3 * sizeof(uint32_t)); }

/* Every face belongs to one tetrahedron or to two, and edges of those of one close up: the
 * sum of their outward areas vanishes. */
static void assert_closed(const struct cb_mesh *m) {
  uint32_t *face = malloc(12 * m->tets * sizeof *face);
  double area[3] = {0}, all = 0;
  static const uint8_t of[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (size_t n = 0; n < 4 * m->tets; n++) {
    for (int j = 0; j < 3; j++) face[3 * n + (size_t)j] = m->tet[n / 4 * 4 + of[n % 4][j]];
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
      u[k] = m->X[3 * face[3 * n + 1] + k] - m->X[3 * face[3 * n] + k];
      v[k] = m->X[3 * face[3 * n + 2] + k] - m->X[3 * face[3 * n] + k];
    }
    for (int k = 0; k < 3; k++) {
      const double a = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
      area[k] += a, all += fabs(a); /* inner faces come twice, with opposite signs */
    }
    for (int pass = 0; pass < 3; pass++) {
      uint32_t *f = face + 3 * n + pass % 2;
      if (f[0] > f[1]) {
        const uint32_t swap = f[0];
        f[0] = f[1], f[1] = swap;
      }
    }
  }
  for (int k = 0; k < 3; k++) assert_true(fabs(area[k]) < 1e-12 * all);
  qsort(face, 4 * m->tets, 3 * sizeof *face, by_face);
  for (size_t n = 2; n < 4 * m->tets; n++)
    assert_false(by_face(face + 3 * n, face + 3 * (n - 2)) == 0);
  free(face);
}

static size_t label(const size_t *part, size_t e) {
  while (part[e] != e) e = part[e];
  return e;
}

/* From any tetrahedron every other one is reached across faces. */
static size_t parts_by_faces(const struct cb_mesh *m) {
  struct face {
    uint32_t node[3], tet;
  } *face = malloc(4 * m->tets * sizeof *face);
  size_t *part = malloc(m->tets * sizeof *part), parts = m->tets;
  for (size_t n = 0; n < 4 * m->tets; n++) {
    uint32_t t[4]; /* in rising order, of which one is left out */
    memcpy(t, m->tet + n / 4 * 4, sizeof t);
    for (int i = 0; i < 4; i++)
      for (int j = i + 1; j < 4; j++)
        if (t[i] > t[j]) {
          const uint32_t swap = t[i];
          t[i] = t[j], t[j] = swap;
        }
    for (size_t i = 0, k = 0; i < 4; i++)
      if (i != n % 4) face[n].node[k++] = t[i];
    face[n].tet = (uint32_t)(n / 4);
    part[n / 4] = n / 4;
  }
  qsort(face, 4 * m->tets, sizeof *face, by_face);
  for (size_t n = 1; n < 4 * m->tets; n++) {
    const size_t a = label(part, face[n].tet), b = label(part, face[n - 1].tet);
    if (a == b || by_face(&face[n], &face[n - 1]) != 0) continue;
    part[a > b ? a : b] = a > b ? b : a;
    parts--;
  }
  free(part);
  free(face);
  return parts;
}

static void assert_no_node_is_alone(const struct cb_mesh *m) {
  uint8_t *used = calloc(m->nodes, 1);
  for (size_t n = 0; n < 4 * m->tets; n++) used[m->tet[n]] = 1;
  for (size_t i = 0; i < m->nodes; i++)
    if (!used[i]) fail_msg("node %zu of %zu is in no tetrahedron", i, m->nodes);
  free(used);
}

/* At every resolution: nothing hangs by an edge or a node. */
static void shapes_are_in_one_piece(void **state) {
  (void)state;
  for (size_t n = 0; n < 2; n++)
    for (size_t cells = 4; cells <= 32; cells++) {
      struct cb_mesh m;
      assert_int_equal(cb_mesh_shape(NAMES[n], cells, 1, &m), CB_OK);
      const size_t parts = parts_by_faces(&m);
      if (parts != 1) fail_msg("%s of %zu cells is in %zu parts", NAMES[n], cells, parts);
      assert_no_node_is_alone(&m);
      for (size_t e = 0; e < m.tets; e++) assert_true(quality(&m, e) > 0.2);
      assert_closed(&m);
      cb_mesh_free(&m);
    }
}

/* From the scene's own resolution on no ear of the rabbit is lost, on either side. */
static void the_rabbit_keeps_its_ears(void **state) {
  (void)state;
  for (size_t cells = 14; cells <= 32; cells++) {
    struct cb_mesh m;
    double top[2] = {0};
    assert_int_equal(cb_mesh_shape("rabbit", cells, 1, &m), CB_OK);
    for (size_t i = 0; i < m.nodes; i++) {
      double *side = &top[m.X[3 * i + 1] > 0];
      *side = fmax(*side, m.X[3 * i + 2]);
    }
    for (int side = 0; side < 2; side++) /* the head ends at 0.69, the ears at 1.06 */
      if (!(top[side] > 0.95)) fail_msg("%zu cells: it ends at %g", cells, top[side]);
    cb_mesh_free(&m);
  }
}

static void shapes_are_good_meshes(void **state) {
  (void)state;
  for (size_t n = 0; n < 2; n++) {
    double volume[3] = {0};
    for (size_t r = 0; r < 3; r++) {
      struct cb_mesh m;
      double worst = 1, long_x[2] = {1, -1};
      assert_int_equal(cb_mesh_shape(NAMES[n], 12 << r, 0.3, &m), CB_OK);
      for (size_t e = 0; e < m.tets; e++) {
        worst = fmin(worst, quality(&m, e));
        volume[r] += cb_mesh_six_volumes(&m, e) / 6;
      }
      assert_true(worst > 0.2);
      for (size_t i = 0; i < m.nodes; i++)
        long_x[0] = fmin(long_x[0], m.X[3 * i]), long_x[1] = fmax(long_x[1], m.X[3 * i]);
      assert_true(long_x[1] - long_x[0] > 0.26 && long_x[1] - long_x[0] < 0.36);
      assert_closed(&m);
      cb_mesh_free(&m);
    }
    /* finer lattices only add what was smaller than a cell */
    assert_true(fabs(volume[1] / volume[2] - 1) < 0.05);
    assert_true(fabs(volume[1] / volume[2] - 1) < fabs(volume[0] / volume[2] - 1));
  }
}

static void the_same_shape_is_the_same(void **state) {
  (void)state;
  struct cb_mesh a, b;
  assert_int_equal(cb_mesh_shape("liver", 10, 1, &a), CB_OK);
  assert_int_equal(cb_mesh_shape("liver", 10, 2, &b), CB_OK);
  assert_true(a.nodes == b.nodes && a.tets == b.tets);
  assert_memory_equal(a.tet, b.tet, 4 * a.tets * sizeof *a.tet);
  for (size_t i = 0; i < 3 * a.nodes; i++) assert_true(fabs(b.X[i] - 2 * a.X[i]) < 1e-14);
  cb_mesh_free(&a);
  cb_mesh_free(&b);
}

static void what_is_no_shape_is_refused(void **state) {
  (void)state;
  struct cb_mesh m;
  assert_int_equal(cb_mesh_shape("horse", 10, 1, &m), CB_INPUT);
  assert_non_null(strstr(cb_error_message(), "a shape is 'rabbit' or 'liver'"));
  assert_int_equal(cb_mesh_shape("liver", 3, 1, &m), CB_INPUT);
  assert_int_equal(cb_mesh_shape("liver", 10, NAN, &m), CB_INPUT);
  assert_false(cb_mesh_is_shape("horse"));
}

/* Crushed to no volume, or yanked until elements invert: with rest B and a frame that flips an
 * inversion away the body comes back, upright. */
static void crushed_bodies_come_back(void **state) {
  (void)state;
  static const char *const paths[] = {"scenes/rabbit-crush.json", "scenes/liver-yank.json"};
  for (size_t n = 0; n < 2; n++) {
    struct cb_scene s;
    struct cb_body b;
    static struct cb_outcome o;
    assert_int_equal(cb_scene_read(paths[n], &s), CB_OK);
    assert_int_equal(cb_body_create(&s, 0.625, &b), CB_OK);
    const struct cb_trial t = {.variant = cb_variant_find("polar-exact/ebe/f64"),
                               .threads = 1,
                               .iterations = 20,
                               .step = s.step};
    assert_int_equal(cb_body_run(&b, &t, &o), CB_OK);
    assert_true(cb_outcome_recovers(&o, &s.needs) && o.inverted == 0);
    /* from far: crushed it has no height, yanked it has inverted elements */
    assert_true(o.most_distance > 0.3 && (n == 0 || 20 * o.most_inverted > b.at.mesh.tets));
    s.needs.rest = o.distance / 2; /* what is not near enough has not recovered */
    assert_false(cb_outcome_recovers(&o, &s.needs));
    cb_body_free(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_are_in_one_piece),     cmocka_unit_test(the_rabbit_keeps_its_ears),
      cmocka_unit_test(shapes_are_good_meshes),      cmocka_unit_test(the_same_shape_is_the_same),
      cmocka_unit_test(what_is_no_shape_is_refused), cmocka_unit_test(crushed_bodies_come_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
