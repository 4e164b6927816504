/* test_force.c - `corobench force` as a user meets it: the numbers, and what
 * bad input gets: exit status 2, one sentence, no file.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "kernels/kernel.h"
#include "tests/process.h"

enum { NODES = 8, TETS = 5 };
/* A unit cube of five tetrahedra; node i is at the corner of i's bits. */
static const uint32_t tets[4 * TETS] = {0, 3, 5, 6, 0, 3, 5, 1, 0, 3, 6, 2, 0, 5, 6, 4, 3, 5, 6, 7};

static char mesh[64], rest[64], turned[64], bent[64], results[64]; /* paths */
static double bent_xyz[3 * NODES];
static const char variant[] = "qr-updated/ebe/f64";

/* ---- files that the tests use ---------------------------------------------- */

static const char *in_directory(char path[64], const char *name) {
  snprintf(path, 64, "%s/%s", temporary, name);
  return path;
}

static const char *write_text(char path[64], const char *name, const char *text) {
  FILE *file = fopen(in_directory(path, name), "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  assert_int_equal(fclose(file), 0);
  return path;
}

/* Rows from the last node to the first: their order must not matter. */
static void write_positions(const char *path, const double *xyz) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs("node,x,y,z\n", file);
  for (size_t i = NODES; i-- > 0;)
    fprintf(file, "%zu,%.17g,%.17g,%.17g\n", i + 1, xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  assert_int_equal(fclose(file), 0);
}

static void write_mesh(void) {
  char text[4096], path[64];
  int used = sprintf(text, "%d 3 0 0\n", NODES);
  for (unsigned i = 0; i < NODES; i++)
    used += sprintf(text + used, "%u %u %u %u\n", i + 1, i & 1, i >> 1 & 1, i >> 2 & 1);
  write_text(mesh, "cube.node", text);
  used = sprintf(text, "%d 4 0\n", TETS);
  for (unsigned e = 0; e < TETS; e++) {
    const uint32_t *t = tets + 4 * e;
    used += sprintf(text + used, "%u %u %u %u %u\n", e + 1, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1);
  }
  write_text(path, "cube.ele", text);
}

static void write_shapes(void) {
  double x[3 * NODES], y[3 * NODES];
  const double c = cos(2.0), s = sin(2.0);
  for (unsigned i = 0; i < 3 * NODES; i++) x[i] = i / 3 >> i % 3 & 1;
  write_positions(in_directory(rest, "rest.csv"), x);
  for (unsigned i = 0; i < NODES; i++) { /* about z, then a shift */
    y[3 * i] = c * x[3 * i] - s * x[3 * i + 1] + 0.25;
    y[3 * i + 1] = s * x[3 * i] + c * x[3 * i + 1] - 3;
    y[3 * i + 2] = x[3 * i + 2] + 7;
  }
  write_positions(in_directory(turned, "turned.csv"), y);
  for (unsigned i = 0; i < 3 * NODES; i++) bent_xyz[i] = y[i] + 0.1 * sin(1.0 + 7 * i);
  write_positions(in_directory(bent, "bent.csv"), bent_xyz);
}

static int set_up(void **state) {
  if (temporary_make(state)) return -1;
  in_directory(results, "results");
  write_mesh();
  write_shapes();
  return 0;
}

/* ---- calls ------------------------------------------------------------------ */

/* What `force` is given; NULL: that option is left out. */
struct request {
  const char *mesh, *positions, *variant, *young, *poisson, *output;
};
static struct request good(void) {
  return (struct request){mesh, bent, variant, "1e5", "0.3", NULL};
}

static struct process force(struct request r) {
  const char *const pairs[][2] = {{"--mesh", r.mesh},       {"--positions", r.positions},
                                  {"--variant", r.variant}, {"--young", r.young},
                                  {"--poisson", r.poisson}, {"--output", r.output}};
  const char *words[16] = {"force"};
  size_t n = 1;
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
    if (pairs[i][1]) {
      words[n++] = pairs[i][0];
      words[n++] = pairs[i][1];
    }
  return run_words(NULL, words);
}

/* Refused, be it with the forces to standard output or to a directory. */
static void assert_nothing_done(struct request r, const char *said) {
  assert_refused(force(r), said);
  r.output = results;
  assert_refused(force(r), said);
  assert_int_not_equal(access(results, F_OK), 0);
}

static void read_forces(const char *csv, double f[3 * NODES]) {
  const char *line = csv;
  assert_int_equal(strncmp(line, "node,fx,fy,fz\n", 14), 0);
  for (int i = 0; i < NODES; i++) {
    int node, used = 0;
    line = strchr(line, '\n') + 1;
    assert_int_equal(
        sscanf(line, "%d,%lf,%lf,%lf%n", &node, f + 3 * i, f + 3 * i + 1, f + 3 * i + 2, &used), 4);
    assert_int_equal(node, i + 1);
    assert_int_equal(line[used], '\n');
  }
  assert_string_equal(strchr(line, '\n'), "\n");
}

/* The same by calling the operator directly. */
static void compute_forces(double f[3 * NODES]) {
  double X[3 * NODES];
  uint32_t copy[4 * TETS];
  const struct cb_variant *v = cb_variant_find(variant);
  struct cb_mesh m = {.nodes = NODES, .tets = TETS, .X = X, .tet = copy, .share = 1};
  struct cb_material material;
  struct cb_operator *op;
  for (unsigned i = 0; i < 3 * NODES; i++) X[i] = i / 3 >> i % 3 & 1;
  memcpy(copy, tets, sizeof copy);
  void *x = aligned_alloc(64, 64 * NODES), *y = aligned_alloc(64, 64 * NODES);
  assert_true(x && y && v->arithmetic->stride * v->arithmetic->scalar_bytes <= 64);
  assert_int_equal(cb_material_isotropic(1e5, 0.3, 1000, &material), CB_OK);
  assert_int_equal(cb_operator_create(v, &m, &material, 1, 1, &op), CB_OK);
  v->arithmetic->from_double(NODES, bent_xyz, x);
  cb_operator_update(op, x, NULL, 1, y);
  v->arithmetic->to_double(NODES, y, f);
  cb_operator_free(op);
  free(x);
  free(y);
}

/* ---- force ------------------------------------------------------------------ */

static void test_rigid(void **state) {
  (void)state;
  const char *const shapes[] = {rest, turned};
  for (size_t s = 0; s < 2; s++) {
    struct request r = good();
    double f[3 * NODES];
    r.positions = shapes[s];
    struct process p = force(r);
    assert_int_equal(p.exit_status, 0);
    read_forces(p.out, f);
    for (size_t i = 0; i < 3 * NODES; i++) /* E L |x| roundoff = 9e-11 N; measured 1.4e-11 */
      assert_true(fabs(f[i]) <= 1e-10);
    process_free(&p);
  }
}

/* 17 digits are the very numbers of the operator. */
static void test_bent(void **state) {
  (void)state;
  double f[3 * NODES], computed[3 * NODES], sum[3] = {0}, most = 0;
  struct process p = force(good());
  assert_int_equal(p.exit_status, 0);
  assert_string_equal(p.err, "");
  read_forces(p.out, f);
  compute_forces(computed);
  for (size_t i = 0; i < 3 * NODES; i++) {
    assert_true(f[i] == computed[i]);
    sum[i % 3] += f[i];
    most = fmax(most, fabs(f[i]));
  }
  assert_true(most > 1e3);
  for (size_t k = 0; k < 3; k++) assert_true(fabs(sum[k]) <= 1e-14 * NODES * most);
  process_free(&p);
}

/* Every node in one place, and a model that divides by the volume: its NaN must not reach the
 * user's file. */
static void test_collapsed(void **state) {
  (void)state;
  const double origin[3 * NODES] = {0};
  struct request r = good();
  char path[64];
  r.positions = in_directory(path, "collapsed.csv");
  r.variant = "qr-updated-volume/ebe/f64";
  write_positions(path, origin);
  assert_nothing_done(r, "not a finite number");
}

static void test_output(void **state) {
  (void)state;
  struct request r = good();
  char path[96];
  struct process plain = force(r);
  r.output = "-";
  struct process dash = force(r);
  r.output = results;
  struct process filed = force(r);
  assert_int_equal(dash.exit_status, 0);
  assert_string_equal(dash.out, plain.out);
  assert_int_equal(filed.exit_status, 0);
  assert_string_equal(filed.out, "");
  snprintf(path, sizeof path, "%s/force.csv", results);
  char *text = read_text(path);
  assert_string_equal(text, plain.out);
  assert_int_equal(unlink(path), 0);
  assert_int_equal(rmdir(results), 0); /* there was nothing else in it */
  free(text);
  process_free(&plain);
  process_free(&dash);
  process_free(&filed);
}

static void test_bad_options(void **state) {
  (void)state;
  struct {
    size_t member;
    const char *value, *said;
  } const cases[] = {
#define WITH(name, value, said) {offsetof(struct request, name), value, said}
      WITH(mesh, NULL, "--mesh"),
      WITH(positions, NULL, "--positions"),
      WITH(variant, NULL, "--variant"),
      WITH(young, NULL, "--young"),
      WITH(poisson, NULL, "--poisson"),
      WITH(variant, "*", "exactly one variant"),
      WITH(variant, "no/such/thing", "no variant matches"),
      WITH(young, "nan", "--young"),
      WITH(young, "1e999", "--young"),
      WITH(young, "12Pa", "'12Pa'"),
      WITH(young, "", "--young"),
      WITH(young, "-1", "-1"),
      WITH(poisson, "0.5", "0.5"),
      WITH(poisson, "-1", "-1"),
      WITH(poisson, "x", "--poisson"),
      WITH(mesh, "/nonexistent/cube.node", "/nonexistent/cube.node"),
      WITH(mesh, "/etc/passwd", "/etc/passwd"),
      WITH(mesh, "/tmp", "/tmp"),
      WITH(positions, "/nonexistent.csv", "/nonexistent.csv"),
      WITH(positions, "/tmp", "/tmp"),
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct request r = good();
    memcpy((char *)&r + cases[i].member, &cases[i].value, sizeof cases[i].value);
    assert_nothing_done(r, cases[i].said);
  }
}

static void test_bad_meshes(void **state) {
  (void)state;
  const char *const elements[] = {"",
                                  "0 4 0\n",
                                  "1 4 0\n",
                                  "1 4 0\n1 1 2 3\n",
                                  "1 4 0\n1 1 2 3 9\n",
                                  "1 4 0\n1 1 2 3 3\n",
                                  "1 4 0\n1 1 2 3 4\n",
                                  "1 4 0\n1 a b c d\n",
                                  "-1 4 0\n"};
  char nodes[64], other[64];
  struct request r = good();
  r.mesh = write_text(nodes, "bad.node", "8 3 0 0\n");
  write_text(other, "bad.ele", "1 4 0\n1 1 2 3 5\n");
  assert_nothing_done(r, "bad.node");
  r.mesh = write_text(other, "huge.node", "99999999999 3 0 0\n1 0 0 0\n");
  assert_nothing_done(r, ""); /* too little memory or too short a file: the system's choice */
  char *good_nodes = read_text(mesh);
  r.mesh = write_text(nodes, "bad.node", good_nodes);
  free(good_nodes);
  for (size_t i = 0; i < sizeof elements / sizeof *elements; i++) {
    write_text(other, "bad.ele", elements[i]);
    assert_nothing_done(r, "bad.ele");
  }
}

static void test_bad_positions(void **state) {
  (void)state;
  const char *const last_rows[] = {"8,nan,0,0\n", "8,0,0\n",   "7,0,0,0\n",
                                   "9,0,0,0\n",   "",          "8,0,0,0\n9,0,0,0\n",
                                   "8,0,0,inf\n", "8,0,0,x\n", "8,0,0,0\n8,0,0,0\n"};
  struct request r = good();
  char path[64];
  for (size_t i = 0; i < sizeof last_rows / sizeof *last_rows; i++) {
    char text[512] = "node,x,y,z\n";
    for (int node = 1; node < NODES; node++)
      sprintf(text + strlen(text), "%d,%d,%d,%d\n", node, node & 1, node & 2, node & 4);
    strcat(text, last_rows[i]);
    r.positions = write_text(path, "positions.csv", text);
    assert_nothing_done(r, "positions.csv");
  }
  r.positions = write_text(path, "positions.csv", "a,b\n");
  assert_nothing_done(r, "positions.csv");
}

/* A directory below a file cannot be made, not even by root. */
static void test_unwritable(void **state) {
  (void)state;
  struct request r = good();
  char path[96];
  snprintf(path, sizeof path, "%s/below", rest);
  r.output = path;
  assert_refused(force(r), path);
  r.output = "/dev/full";
  assert_refused(force(r), "/dev/full");
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_rigid),         cmocka_unit_test(test_bent),
      cmocka_unit_test(test_collapsed),     cmocka_unit_test(test_output),
      cmocka_unit_test(test_bad_options),   cmocka_unit_test(test_bad_meshes),
      cmocka_unit_test(test_bad_positions), cmocka_unit_test(test_unwritable),
  };
  (void)argc;
  find_program(argv[0]);
  return cmocka_run_group_tests(tests, set_up, temporary_remove);
}
