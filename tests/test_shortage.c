/* test_shortage.c - the n-th allocation fails, for n = 1, 2, ... until none does, alone and with
 * all after it: the work ends in a clean error, or without harm, and leaves nothing behind.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "harness/advise/advise.h"
#include "harness/files/mesh.h"
#include "harness/files/output.h"
#include "harness/files/vtk.h"
#include "harness/scene/run.h"
#include "harness/truth/truth.h"
#include "tests/starve.h"
#include "tests/tally.h"

#define CORPUS "tests/fuzz/corpus/"

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

/* Those that simulate or measure for long have their allocations in the works above. */
static void verbs(void **state) {
  (void)state;
  static const struct command commands[] = {
      {&cb_verb_bench,
       {"--quick", "--seconds", "1", "--figure", "memory", "--variant", "qr-updated/ebe*/f64",
        "--output", temporary}},
      {&cb_verb_verify,
       {"--laws", "--mesh", CORPUS "mesh_gmsh/version2.msh", "--variant", "qr-exact", "--output",
        temporary}},
      {&cb_verb_trade,
       {CORPUS "scene/loads.json", "--quick", "--variant", "qr-updated/ebe-cluster/f64", "--output",
        temporary}},
      {&cb_verb_run, {CORPUS "scene/loads.json", "--output", temporary}}};
  starve_begin();
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    starve(&(struct work){.name = commands[i].verb->name,
                          .run = run_verb,
                          .context = (void *)&commands[i],
                          .first = 40,
                          .later = 20});
  starve_end();
}

/* ---- frames ------------------------------------------------------------------------------- */

static char right_library[4200];

/* Ours, the set as files, and somebody's routine in a child process. */
static void frames(void **state) {
  (void)state;
  const struct command commands[] = {{&cb_verb_frames, {"--variant", "svd-precomputed/ebe/f64"}},
                                     {&cb_verb_frames, {"--write", temporary}},
                                     {&cb_verb_frames, {"--check", right_library}}};
  starve_begin();
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    starve(&(struct work){.name = commands[i].words[0],
                          .run = run_verb,
                          .context = (void *)&commands[i],
                          .unsteady = commands[i].words[1] == right_library,
                          .first = 25,
                          .later = 6});
  starve_end();
}

/* What a work wrote that ended well is whole: what it wrote without shortage, *whole, which is
 * read the first time, and to be freed. */
static void assert_same_text(const char *name, char **whole) {
  shortage_disarm();
  char *text = read_text(temporary_path(name));
  if (*whole) {
    if (strcmp(text, *whole) != 0) fail_msg("%s is not whole: %s", name, text);
    free(text);
  } else {
    *whole = text;
  }
}

/* ---- truth --------------------------------------------------------------------------------- */

struct truth_case {
  const char *name;
  cb_truth_fn *run;
  size_t later; /* few where it takes long */
  size_t rows;  /* found without shortage */
  struct cb_truth_row row[8];
};

/* Without room for its ordering of choice CHOLMOD takes another one, which rounds otherwise. */
static void assert_same_row(const struct cb_truth_row *a, const struct cb_truth_row *b) {
  const double x[] = {a->exact, a->coarse, a->medium, a->fine, a->order, a->judged};
  const double y[] = {b->exact, b->coarse, b->medium, b->fine, b->order, b->judged};
  for (size_t i = 0; i < sizeof x / sizeof *x; i++)
    if (!(isnan(x[i]) && isnan(y[i])) && !(fabs(x[i] - y[i]) <= 1e-6 * fabs(y[i])))
      fail_msg("%s, %s: %.17g instead of %.17g", a->name, a->model, x[i], y[i]);
}

static enum cb_status run_truth(void *context) {
  const struct cb_options linear = {.globs = {"linear/ebe/f64"}, .glob_count = 1, .seed = 2005};
  struct truth_case *c = context;
  struct cb_truth found = {.options = &linear};
  send(nowhere, nowhere); /* METIS complains */
  const enum cb_status status = c->run(&found);
  send(own[0], own[1]);
  if (!status && !c->rows) {
    c->rows = found.count;
    memcpy(c->row, found.rows, found.count * sizeof *found.rows);
  }
  if (!status) {
    assert_int_equal(found.count, c->rows);
    for (size_t i = 0; i < c->rows; i++) assert_same_row(&found.rows[i], &c->row[i]);
  }
  cb_truth_free(&found);
  return status;
}

/* Of random numbers, which must have been drawn. */
static enum cb_status sweep_tangents(void *text) {
  const struct cb_options linear = {.globs = {"linear/ebe/f64"}, .glob_count = 1, .seed = 2005};
  struct cb_table *t = NULL;
  enum cb_status status = cb_tangent_sweep(&linear, &t);
  if (!status) status = cb_output_table(temporary, "tangent.csv", t, CB_CSV);
  cb_table_free(t);
  if (!status) assert_same_text("tangent.csv", text);
  return status;
}

/* The verb with a model that has the short cases only; the long ones with the fastest model. */
static void truth(void **state) {
  (void)state;
  static const struct command all = {&cb_verb_truth,
                                     {"--variant", "polar-tangent/ebe/f64", "--output", temporary}};
  static struct truth_case cases[] = {
      {.name = "manufactured solution", .run = cb_truth_manufactured, .later = 2},
      {.name = "torsion", .run = cb_truth_torsion, .later = 8},
      {.name = "spinning body", .run = cb_truth_spin, .later = 4},
      {.name = "cantilever", .run = cb_truth_cantilever, .later = 3}};
  starve_begin();
  starve(&(struct work){
      .name = "truth", .run = run_verb, .context = (void *)&all, .first = 130, .later = 8});
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    starve(&(struct work){.name = cases[i].name,
                          .run = run_truth,
                          .context = &cases[i],
                          .first = 6,
                          .later = cases[i].later});
  char *tangents = NULL;
  starve(&(struct work){.name = "tangents", .run = sweep_tangents, .context = &tangents});
  free(tangents);
  starve_end();
}

/* ---- advice --------------------------------------------------------------------------------- */

/* What is printed is whole, or the status says that it is not. */
struct printing {
  const struct cb_body *body;
  const struct cb_advice *advice;
  enum cb_format format;
  char *whole; /* printed without shortage */
};

static enum cb_status print_advice(void *context) {
  struct printing *p = context;
  const char *path = temporary_path("advice");
  const int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
  send(file, own[1]);
  const enum cb_status status = cb_advice_print(p->body, p->advice, p->format);
  send(own[0], own[1]);
  close(file);
  if (!status) assert_same_text("advice", &p->whole);
  return status;
}

/* The needs of the scene: one that laws, and one that nothing meets. */
static void advice(void **state) {
  (void)state;
  static const struct command all = {
      &cb_verb_advise,
      {CORPUS "scene/loads.json", "--quick", "--threads", "1", "--variant", "linear"}};
  const struct cb_options options = {.globs = {"qr-precomputed", "linear"},
                                     .glob_count = 2,
                                     .seed = 2005,
                                     .threads = {.count = 1, .of = {1}}};
  struct cb_scene scene;
  struct cb_body body;
  starve_begin();
  starve(&(struct work){.name = "advise",
                        .run = run_verb,
                        .context = (void *)&all,
                        .unsteady = true,
                        .first = 40,
                        .later = 8});
  assert_int_equal(cb_scene_read(CORPUS "scene/needs.json", &scene), CB_OK);
  assert_int_equal(cb_body_create(&scene, 1, &body), CB_OK);
  for (int n = 0; n < 2; n++) { /* as the scene has it, and with what linear elements do meet */
    const struct cb_advise_request request = {
        .options = &options, .tolerance = NAN, .budget_s = NAN, .quick = true};
    struct cb_advice made;
    send(nowhere, nowhere);
    if (n == 1) scene.needs.energy = INFINITY, scene.needs.laws = 0;
    const enum cb_status status = cb_advise(&body, &request, &made);
    send(own[0], own[1]);
    assert_int_equal(status, CB_OK);
    for (enum cb_format format = CB_TABLE; format <= CB_JSON; format++) {
      struct printing p = {&body, &made, format, NULL};
      starve(&(struct work){.name = "a piece of advice", .run = print_advice, .context = &p});
      free(p.whole);
    }
    cb_advice_free(&made);
  }
  cb_body_free(&body);
  starve_end();
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
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(readers),     cmocka_unit_test(scenes),  cmocka_unit_test(operators),
      cmocka_unit_test(simulations), cmocka_unit_test(outputs), cmocka_unit_test(verbs),
      cmocka_unit_test(frames),      cmocka_unit_test(truth),   cmocka_unit_test(advice)};
  const char *slash = strrchr(argv[0], '/');
  snprintf(right_library, sizeof right_library, "%.*sframes/right.so",
           slash ? (int)(slash + 1 - argv[0]) : 0, argv[0]);
  return cmocka_run_group_tests(tests, temporary_make, end);
}
