/* test_threads.c - several threads compute what one does, to rounding; the same to
 * the last bit in every run; and a team is what it says. Whole steps of every
 * model, storage and arithmetic, on meshes of one element, with isolated nodes, of
 * more elements than lanes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/team.h"
#include "tests/tally.h"
#include "tests/variants.h"

static const struct cb_step_parameters PARAMETERS = {
    .h = 0.01, .alpha = 0.002, .beta = 0.5, .iterations = 5};
/* More than there are processors, and more than some meshes have packs. */
static const size_t THREADS[] = {2, 3};
/* Units of roundoff times the condition; measured at most 14. */
static const double LIMIT = 64;

/* ---- teams ------------------------------------------------------------------- */

static void a_team_has_a_size(void **state) {
  (void)state;
  struct cb_team *team = NULL;
  assert_int_equal(cb_team_create(0, &team), CB_INPUT);
  assert_int_equal(cb_team_create(CB_TEAM_MOST + 1, &team), CB_INPUT);
  assert_null(team);
  cb_team_free(NULL);
}

struct relay {
  struct cb_team *team;
  size_t threads, round[CB_TEAM_MOST];
  bool ahead;
};

/* After each barrier, everybody has done the round before it, and knows what others told. */
static void run_relay(void *context, size_t thread) {
  struct relay *r = context;
  for (size_t n = 1; n <= 200; n++) {
    r->round[thread] = n;
    cb_team_barrier(r->team, thread);
    for (size_t t = 0; t < r->threads; t++)
      if (r->round[t] != n) r->ahead = true;
    const size_t word = 100 * n + thread;
    cb_team_tell(r->team, thread, &word, sizeof word);
    for (size_t t = 0; t < r->threads; t++) {
      size_t told;
      memcpy(&told, cb_team_told(r->team, thread, t), sizeof told);
      if (told != 100 * n + t) r->ahead = true;
    }
  }
}

static void barriers_hold_everybody(void **state) {
  (void)state;
  for (size_t threads = 1; threads <= 5; threads++) {
    struct relay r = {.threads = threads};
    assert_int_equal(cb_team_create(threads, &r.team), CB_OK);
    assert_int_equal(cb_team_threads(r.team), threads);
    for (int run = 0; run < 3; run++) cb_team_run(r.team, run_relay, &r);
    assert_false(r.ahead);
    for (size_t t = 0; t < threads; t++) assert_int_equal(r.round[t], 200);
    cb_team_free(r.team);
  }
}

static void shares_are_all_and_once(void **state) {
  (void)state;
  for (size_t n = 0; n < 20; n++)
    for (size_t threads = 1; threads < 8; threads++) {
      size_t next = 0, first, last;
      for (size_t t = 0; t < threads; t++, next = last) {
        cb_team_share(n, threads, t, &first, &last);
        assert_int_equal(first, next);
        assert_true(last >= first && last - first <= n / threads + 1);
      }
      assert_int_equal(next, n);
    }
}

/* ---- steps ------------------------------------------------------------------- */

/* x[3*nodes] := positions after three steps of so many threads; raw: their bytes. */
static void three_steps(const struct cb_variant *variant, const struct scene *s,
                        const struct cb_material *m, size_t threads, quad *x, void *raw) {
  const struct cb_arithmetic *a = variant->arithmetic;
  struct cb_operator *op;
  struct cb_stepper *stepper;
  double *mass = calloc(s->mesh.nodes, sizeof *mass);
  uint8_t *fixed = calloc(s->mesh.nodes, 1);
  assert_true(mass && fixed);
  cb_mesh_mass(&s->mesh, 1000, mass);
  fixed[1] = 1;
  for (size_t n = 0; n < s->mesh.nodes; n++) fixed[n] |= !(mass[n] > 0);
  assert_int_equal(
      cb_operator_create(variant, &s->mesh, m, cb_step_scale(&PARAMETERS), threads, &op), CB_OK);
  assert_int_equal(cb_stepper_create(op, &PARAMETERS, mass, fixed, &stepper), CB_OK);
  void *p = vector_new(a, s->mesh.nodes, s->x), *v = vector_new(a, s->mesh.nodes, s->v);
  for (int i = 0; i < 3; i++) cb_stepper_step(stepper, p, v, NULL);
  vector_read(a, s->mesh.nodes, p, x);
  memcpy(raw, p, s->mesh.nodes * a->stride * a->scalar_bytes);
  free(p);
  free(v);
  free(mass);
  free(fixed);
  cb_stepper_free(stepper);
  cb_operator_free(op);
}

static size_t runs;

static void compare_steps(const struct cb_variant *v, const struct scene *s,
                          const struct cb_material *m) {
  const size_t n = 3 * s->mesh.nodes;
  const size_t bytes = s->mesh.nodes * v->arithmetic->stride * v->arithmetic->scalar_bytes;
  quad *one = quads_new(2 * n), *many = one + n;
  char *first = malloc(2 * bytes), *again = first + bytes, name[96];
  assert_non_null(first);
  cb_variant_name(v, name);
  three_steps(v, s, m, 1, one, first);
  for (size_t t = 0; t < sizeof THREADS / sizeof *THREADS; t++) {
    three_steps(v, s, m, THREADS[t], many, first);
    assert_rounding(name, n, many, one, v->arithmetic->roundoff, s->condition, LIMIT);
    three_steps(v, s, m, THREADS[t], many, again);
    runs += 2;
    if (memcmp(first, again, bytes) != 0)
      fail_msg("%s: %zu threads do not repeat their result", name, THREADS[t]);
  }
  free(first);
  free(one);
}

static void threads_do_what_one_does(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int kind = SCENE_RANDOM; kind < SCENES; kind++) {
    struct scene s = scene_new(rng, (enum scene_kind)kind);
    struct cb_material iso = scene_material(false), ortho = scene_material(true);
    for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
      const bool counted = v->arithmetic == scene_counted();
      if (counted && strcmp(v->model->name, "qr-updated") != 0) continue; /* slow, the same code */
      compare_steps(v, &s, &iso);
      if (v->model->form[v->storage][1].update) compare_steps(v, &s, &ortho);
    }
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* Chunks of many packs, with all three parts. */
static void threads_share_larger_meshes(void **state) {
  (void)state;
  static const char *const names[] = {"qr-updated", "polar-closed-precomputed", "node-warp",
                                      "green"};
  gsl_rng *rng = scene_rng();
  struct scene s = {0};
  assert_int_equal(cb_mesh_irregular(6, 6, 6, 1, 1, &s.mesh), CB_OK);
  scene_complete(rng, &s);
  struct cb_material m = scene_material(false);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
      if (strcmp(v->model->name, names[i]) == 0 && v->arithmetic != scene_counted())
        compare_steps(v, &s, &m);
  scene_free(&s);
  gsl_rng_free(rng);
}

static int end(void **state) {
  (void)state;
  tally("runs on threads", runs);
  return 0;
}

/* argv[1]: a pattern of the tests to run; without it all of them. */
int main(int argc, char **argv) {
  if (argc > 1) cmocka_set_test_filter(argv[1]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_team_has_a_size),           cmocka_unit_test(barriers_hold_everybody),
      cmocka_unit_test(shares_are_all_and_once),     cmocka_unit_test(threads_do_what_one_does),
      cmocka_unit_test(threads_share_larger_meshes),
  };
  return cmocka_run_group_tests(tests, NULL, end);
}
