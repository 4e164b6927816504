/* test_shortage.c - the n-th allocation fails, for n = 1, 2, ... until none does, alone and with
 * all after it: the work ends in a clean error, or without harm, and leaves nothing behind.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/output.h"
#include "harness/files/vtk.h"
#include "harness/scene/run.h"
#include "tests/process.h"
#include "tests/shortage.h"
#include "tests/tally.h"

#define CORPUS "tests/fuzz/corpus/"

/* Every allocation of a short work; of a long one the first, and then some at equal distances. */
enum { FIRST = 300, LATER = 60 };

struct work {
  const char *name;
  enum cb_status (*run)(void *context);
  void *context;
  bool silent;         /* the kernels return a status and record no sentence */
  size_t first, later; /* 0: FIRST, LATER */
};

static size_t injected, harmless;

static void assert_clean(const struct work *w, size_t n, enum cb_status status) {
  const bool harmed = status != CB_OK;
  injected++;
  harmless += !harmed;
  if (shortage_live_count)
    fail_msg("%s, allocation %zu: status %d, %zu blocks are left", w->name, n, status,
             shortage_live_count);
  if (harmed && status != CB_MEMORY && status != CB_IO && status != CB_NUMERIC)
    fail_msg("%s, allocation %zu: status %d: %s", w->name, n, status, cb_error_message());
  if (harmed && !w->silent && !cb_error_message()[0])
    fail_msg("%s, allocation %zu: status %d without a sentence", w->name, n, status);
}

static enum cb_status run_short(const struct work *w, size_t n, bool lasts) {
  cb_fail(CB_INPUT, "%s", "");
  shortage_arm(n, lasts);
  const enum cb_status status = w->run(w->context);
  shortage_disarm();
  return status;
}

static void starve(const struct work *w) {
  run_short(w, 0, false); /* what libraries make once is made */
  assert_int_equal(run_short(w, 0, false), CB_OK);
  const size_t all = shortage.asked;
  if (all == 0 && !shortage_reaches_libc) return; /* what it asks for, others ask for it */
  if (all == 0 || shortage_live_count)
    fail_msg("%s: %zu allocations, %zu blocks are left", w->name, all, shortage_live_count);
  const size_t first = w->first ? w->first : FIRST, later = w->later ? w->later : LATER;
  const size_t stride = all > first + later ? (all - first) / later : 1;
  for (size_t n = 1; n <= all; n += n <= first ? 1 : stride)
    for (int lasts = 0; lasts < 2; lasts++) {
      const enum cb_status status = run_short(w, n, lasts);
      if (!shortage.failed) fail_msg("%s: allocation %zu of %zu is not asked for", w->name, n, all);
      assert_clean(w, n, status);
    }
  assert_int_equal(run_short(w, 0, false), CB_OK);
}

/* ---- readers --------------------------------------------------------------------------- */

static enum cb_status read_mesh(void *path) {
  struct cb_mesh mesh = {0};
  long long *numbers = NULL;
  const enum cb_status status = cb_mesh_read(path, &mesh, &numbers);
  if (status) return status;
  free(numbers);
  cb_mesh_free(&mesh);
  return CB_OK;
}

static enum cb_status read_positions(void *path) {
  const struct cb_mesh mesh = {.nodes = 5};
  double x[15];
  return cb_positions_read(path, &mesh, NULL, x);
}

static void readers(void **state) {
  (void)state;
  char path[256];
  snprintf(path, sizeof path, "%s", small_mesh());
  starve(&(struct work){.name = "TetGen", .run = read_mesh, .context = path});
  starve(&(struct work){
      .name = "Gmsh 2.2", .run = read_mesh, .context = CORPUS "mesh_gmsh/version2.msh"});
  starve(&(struct work){
      .name = "Gmsh 4.1", .run = read_mesh, .context = CORPUS "mesh_gmsh/version4.msh"});
  starve(&(struct work){
      .name = "positions", .run = read_positions, .context = CORPUS "positions/from-zero.csv"});
}

/* ---- scenes ------------------------------------------------------------------------------ */

static enum cb_status make_body(void *path) {
  struct cb_scene scene;
  struct cb_body body = {0};
  enum cb_status status = cb_scene_read(path, &scene);
  if (!status) status = cb_body_create(&scene, 0.5, &body);
  if (!status) cb_body_free(&body);
  return status;
}

static void scenes(void **state) {
  (void)state;
  static const char *const paths[] = {CORPUS "scene/loads.json", CORPUS "scene/handles.json",
                                      CORPUS "scene/beam.json",  CORPUS "scene/liver.json",
                                      "scenes/block.json",       "scenes/twisted-bar.json"};
  for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
    starve(&(struct work){.name = paths[i], .run = make_body, .context = (void *)paths[i]});
}

/* ---- operators ----------------------------------------------------------------------------- */

struct ready {
  const struct cb_variant *variant;
  const struct cb_mesh *mesh;
  size_t threads;
};

static enum cb_status make_stepper(void *context) {
  const struct ready *r = context;
  const struct cb_step_parameters step = {.h = 0.01, .iterations = 1};
  struct cb_material material;
  double mass[64];
  struct cb_operator *op = NULL;
  struct cb_stepper *stepper = NULL;
  assert_int_equal(cb_material_isotropic(1e5, 0.3, 1000, &material), CB_OK);
  assert_true(r->mesh->nodes <= 64);
  cb_mesh_mass(r->mesh, 1000, mass);
  enum cb_status status =
      cb_operator_create(r->variant, r->mesh, &material, cb_step_scale(&step), r->threads, &op);
  if (!status) status = cb_stepper_create(op, &step, mass, NULL, &stepper);
  if (status && status != CB_MEMORY) fail_msg("status %d", status);
  cb_stepper_free(stepper);
  cb_operator_free(op);
  return status;
}

/* All storages and arithmetics of one model, and what others allocate besides. */
static bool wanted(const struct cb_variant *v) {
  if (strcmp(v->model->name, "qr-updated") == 0) return true;
  static const char *const others[] = {"polar-exact", "node-warp", "qr-lazy"};
  for (size_t i = 0; v->arithmetic == cb_arithmetics[0] && i < 3; i++)
    if (strcmp(v->model->name, others[i]) == 0) return true;
  return false;
}

static void operators(void **state) {
  (void)state;
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_irregular(2, 2, 2, 1, 1, &mesh), CB_OK);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    /* a team of two is slow to make, and the same in all arithmetics */
    for (size_t threads = 1; wanted(v) && threads <= 1 + (v->arithmetic == cb_arithmetics[0]);
         threads++) {
      char name[96];
      cb_variant_name(v, name);
      starve(&(struct work){.name = name,
                            .run = make_stepper,
                            .context = &(struct ready){v, &mesh, threads},
                            .silent = true});
    }
  cb_mesh_free(&mesh);
}

/* ---- simulations ----------------------------------------------------------------------------- */

struct simulation {
  const struct cb_body *body;
  struct cb_trial trial;
};

static enum cb_status simulate(void *context) {
  const struct simulation *s = context;
  static struct cb_outcome outcome;
  return cb_body_run(s->body, &s->trial, &outcome);
}

static void simulations(void **state) {
  (void)state;
  struct cb_scene scene;
  struct cb_body body;
  assert_int_equal(cb_scene_read(CORPUS "scene/loads.json", &scene), CB_OK);
  assert_int_equal(cb_body_create(&scene, 2, &body), CB_OK);
  const struct cb_trial cheap = {.variant = cb_variant_find("qr-updated/ebe-cluster/f32"),
                                 .threads = 2,
                                 .iterations = 3,
                                 .step = scene.step};
  const struct cb_trial direct = {
      .variant = cb_variant_find("polar-exact/bcsr/f64"), .threads = 1, .step = scene.step};
  starve(&(struct work){
      .name = "iterated", .run = simulate, .context = &(struct simulation){&body, cheap}});
  starve(&(struct work){
      .name = "direct", .run = simulate, .context = &(struct simulation){&body, direct}});
  cb_body_free(&body);
}

/* ---- outputs ----------------------------------------------------------------------------------
 */

static enum cb_status write_table(void *format) {
  struct cb_table *t = cb_table_create("name,count,value");
  if (!t) return cb_fail_memory("the table");
  for (long long i = 0; i < 40; i++) {
    cb_table_text(t, "an \"entry\"");
    cb_table_integer(t, i);
    cb_table_number(t, 1.0 / (double)(i + 1));
  }
  const enum cb_status status =
      cb_output_table(temporary, "table", t, *(const enum cb_format *)format);
  cb_table_free(t);
  return status;
}

static enum cb_status write_vtk(void *mesh) {
  const double times[] = {0, 0.1};
  const struct cb_mesh *m = mesh;
  enum cb_status status = cb_vtk_write(temporary, "body-0000", m, m->X);
  if (!status) status = cb_vtk_series(temporary, "body", 2, times);
  return status;
}

static void outputs(void **state) {
  (void)state;
  struct cb_mesh mesh;
  for (enum cb_format format = CB_TABLE; format <= CB_JSON; format++)
    starve(&(struct work){.name = "a table", .run = write_table, .context = &format});
  assert_int_equal(cb_mesh_grid(2, 2, 2, 0.1, &mesh), CB_OK);
  starve(&(struct work){.name = "VTK", .run = write_vtk, .context = &mesh});
  cb_mesh_free(&mesh);
}

/* ---- verbs -------------------------------------------------------------------------------------
 */

struct command {
  const struct cb_verb *verb;
  const char *words[12];
};

static int nowhere, own[2]; /* /dev/null; what the test itself writes to */

static void send(int out, int err) {
  fflush(stdout);
  dup2(out, 1);
  dup2(err, 2);
}

/* As main does, in this process, unheard. */
static enum cb_status run_verb(void *context) {
  const struct command *c = context;
  char *argv[16] = {(char *)"corobench"};
  int argc = 1;
  for (; c->words[argc - 1]; argc++) argv[argc] = (char *)c->words[argc - 1];
  argv[argc++] = (char *)"--output";
  argv[argc++] = temporary;
  send(nowhere, nowhere);
  const enum cb_status status = c->verb->run(argc, argv);
  send(own[0], own[1]);
  return status;
}

/* Those that simulate or measure for long have their allocations in the works above. */
static void verbs(void **state) {
  (void)state;
  static const struct command commands[] = {
      {&cb_verb_bench,
       {"--quick", "--seconds", "1", "--figure", "memory", "--variant", "qr-updated/ebe*/f64"}},
      {&cb_verb_verify,
       {"--laws", "--mesh", CORPUS "mesh_gmsh/version2.msh", "--variant", "qr-exact"}},
      {&cb_verb_trade,
       {CORPUS "scene/loads.json", "--quick", "--variant", "qr-updated/ebe-cluster/f64"}},
      {&cb_verb_run, {CORPUS "scene/loads.json"}}};
  own[0] = dup(1), own[1] = dup(2), nowhere = open("/dev/null", O_WRONLY);
  assert_true(own[0] >= 0 && own[1] >= 0 && nowhere >= 0);
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    starve(&(struct work){.name = commands[i].verb->name,
                          .run = run_verb,
                          .context = (void *)&commands[i],
                          .first = 40,
                          .later = 20});
  close(own[0]), close(own[1]), close(nowhere);
}

static int end(void **state) {
  tally("allocations failed", injected);
  tally("of them harmless", harmless);
  return temporary_remove(state);
}

int main(int argc, char **argv) {
  if (argc > 1) cmocka_set_test_filter(argv[1]);
  shortage_begin();
  gsl_set_error_handler_off();
  const struct CMUnitTest tests[] = {cmocka_unit_test(readers),   cmocka_unit_test(scenes),
                                     cmocka_unit_test(operators), cmocka_unit_test(simulations),
                                     cmocka_unit_test(outputs),   cmocka_unit_test(verbs)};
  return cmocka_run_group_tests(tests, temporary_make, end);
}
