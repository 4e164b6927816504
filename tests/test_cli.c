/* test_cli.c - build/corobench as a user meets it: help, refusals of bad words,
 * a full disk, the list of variants.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>

#include "kernels/kernel.h"
#include "tests/process.h"

#define RUN(...) run_words(NULL, (const char *const[]){__VA_ARGS__, NULL})

static void test_help(void **state) {
  (void)state;
  const char *const verbs[] = {"bench", "verify", "force", "ops", "machine", "list"};
  struct process all = RUN("--help");
  assert_int_equal(all.exit_status, 0);
  assert_string_equal(all.err, "");
  for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
    char usage[64];
    struct process p = RUN(verbs[i], "--help");
    snprintf(usage, sizeof usage, "Usage: corobench %s", verbs[i]);
    assert_int_equal(p.exit_status, 0);
    assert_int_equal(strncmp(p.out, usage, strlen(usage)), 0);
    assert_string_equal(p.err, "");
    assert_non_null(strstr(all.out, verbs[i]));
    process_free(&p);
  }
  process_free(&all);
}

static void test_version(void **state) {
  (void)state;
  struct process p = RUN("--version"), q = RUN("list", "--version");
  assert_int_equal(p.exit_status, 0);
  assert_int_equal(q.exit_status, 0);
  assert_int_equal(strncmp(p.out, "corobench ", 10), 0);
  assert_string_equal(p.out, q.out);
  process_free(&p);
  process_free(&q);
}

static void test_no_verb(void **state) {
  (void)state;
  struct process p = run_words(NULL, (const char *const[]){NULL});
  assert_int_equal(p.exit_status, 2);
  assert_non_null(strstr(p.err, "force"));
  assert_string_equal(p.out, "");
  process_free(&p);
}

static void test_bad_words(void **state) {
  (void)state;
  assert_refused(RUN("lits"), "unknown verb 'lits' (nearest: 'list')");
  assert_refused(RUN("list", "--varient", "*"), "unknown option '--varient' (nearest: 'variant')");
  assert_refused(RUN("list", "--seed", "1"), "unknown option '--seed'");
  assert_refused(RUN("list", "--variant", "qr-updatid"), "no variant matches 'qr-updatid'");
  assert_refused(RUN("list", "--format", "xml"), "'xml'");
  assert_refused(RUN("list", "more"), "unexpected word 'more'");
}

static void test_full_disk(void **state) {
  (void)state;
  const char *const calls[][5] = {{"--help"}, {"--version"}, {"list"}, {"list", "--help"}};
  if (access("/dev/full", W_OK) != 0) skip();
  for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
    struct process p = run_words("/dev/full", calls[i]);
    assert_one_sentence(&p, "cannot write");
    process_free(&p);
  }
}

/* The next cell of a CSV table into text; *p then is at the comma or newline. */
static void read_cell(const char **p, char text[1024]) {
  bool quoted = **p == '"';
  size_t n = 0;
  for (*p += quoted; **p && (quoted || (**p != ',' && **p != '\n')); (*p)++) {
    if (quoted && **p == '"' && *++*p != '"') break;
    assert_true(n < 1023);
    text[n++] = **p;
  }
  text[n] = '\0';
}

static void test_list_csv(void **state) {
  (void)state;
  struct process p = RUN("list", "--format", "csv");
  const char *at = strchr(p.out, '\n') + 1;
  assert_int_equal(p.exit_status, 0);
  assert_int_equal(strncmp(p.out, "model,storage,arithmetic,variant,summary", 40), 0);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    char cell[1024], name[96];
    cb_variant_name(v, name);
    const char *const expected[] = {v->model->name,      cb_storage_name[v->storage],
                                    v->arithmetic->name, name,
                                    v->model->summary,   v->model->source};
    for (size_t i = 0; i < 6; i++) {
      read_cell(&at, cell);
      assert_string_equal(cell, expected[i]);
      assert_int_equal(*at++, i < 5 ? ',' : '\n');
    }
  }
  assert_string_equal(at, "");
  process_free(&p);
}

static void test_list_selected(void **state) {
  (void)state;
  char name[96];
  cb_variant_name(cb_variants(NULL), name);
  struct process p = RUN("list", "--format", "json", "--variant", name);
  json_t *rows = json_loads(p.out, 0, NULL);
  assert_int_equal(p.exit_status, 0);
  assert_int_equal(json_array_size(rows), 1);
  assert_string_equal(json_string_value(json_object_get(json_array_get(rows, 0), "variant")), name);
  json_decref(rows);
  process_free(&p);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_help),          cmocka_unit_test(test_version),
      cmocka_unit_test(test_no_verb),       cmocka_unit_test(test_bad_words),
      cmocka_unit_test(test_full_disk),     cmocka_unit_test(test_list_csv),
      cmocka_unit_test(test_list_selected),
  };
  (void)argc;
  find_program(argv[0]);
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
