/* test_options.c - command lines: what is taken, what is refused and how.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/nearest.h"
#include "harness/verbs/verbs.h"

enum {
  ALL = CB_OPT_VARIANT | CB_OPT_MESH | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_SEED | CB_OPT_THREADS
};

static const struct argp_option own_options[] = {
    {"young", 1, "E", 0, "", 0}, {"quick", 2, NULL, 0, "", 0}, {0}};
static error_t parse_own(int key, char *text, struct argp_state *state) {
  double *young = state->input;
  if (key == 1) return cb_parse_number("--young", text, 0, DBL_MAX, young) == CB_OK ? 0 : EINVAL;
  return key == 2 ? 0 : ARGP_ERR_UNKNOWN;
}

/* Parse "corobench test" and the words, separated by spaces. */
static enum cb_status parse(unsigned mask, const char *words, struct cb_options *o, double *young) {
  static char text[4096]; /* the options point into it */
  char *argv[256] = {(char *)"corobench test"};
  int argc = 1;
  snprintf(text, sizeof text, "%s", words);
  for (char *word = strtok(text, " "); word; word = strtok(NULL, " ")) argv[argc++] = word;
  return cb_options_parse(argc, argv, mask, "doc", own_options, parse_own, young, o);
}

static void refused(unsigned mask, const char *words, const char *said) {
  struct cb_options o, before;
  double young = 0;
  memset(&before, 0x5a, sizeof before);
  o = before;
  assert_int_equal(parse(mask, words, &o, &young), CB_INPUT);
  assert_memory_equal(&o, &before, sizeof o);
  assert_non_null(strstr(cb_error_message(), said));
  assert_null(strchr(cb_error_message(), '\n'));
}

static void test_defaults(void **state) {
  (void)state;
  struct cb_options o;
  double young = 3;
  assert_int_equal(parse(ALL, "", &o, &young), CB_OK);
  assert_int_equal(o.glob_count, 0);
  assert_null(o.mesh_path);
  assert_null(o.output);
  assert_int_equal(o.format, CB_TABLE);
  assert_int_equal(o.seed, 2005);
  assert_true(young == 3);
}

static void test_everything_given(void **state) {
  (void)state;
  struct cb_options o;
  double young = 0;
  assert_int_equal(parse(ALL,
                         "--mesh a.msh --format=json --output out --seed 7 --young 1e6 --quick "
                         "--variant * --variant */*",
                         &o, &young),
                   CB_OK);
  assert_string_equal(o.mesh_path, "a.msh");
  assert_string_equal(o.output, "out");
  assert_int_equal(o.format, CB_JSON);
  assert_int_equal(o.seed, 7);
  assert_int_equal(o.glob_count, 2);
  assert_string_equal(o.globs[1], "*/*");
  assert_true(young == 1e6);
}

static void test_threads(void **state) {
  (void)state;
  struct cb_options o;
  double young;
  assert_int_equal(parse(ALL, "", &o, &young), CB_OK);
  assert_int_equal(o.threads.count, 0);
  assert_int_equal(parse(ALL, "--threads 4,1 --threads=64 --threads 1", &o, &young), CB_OK);
  assert_int_equal(o.threads.count, 3); /* each once */
  assert_int_equal(o.threads.of[0], 4);
  assert_int_equal(o.threads.of[1], 1);
  assert_int_equal(o.threads.of[2], 64);
  const char *const bad[] = {"0", "65", "-1", "two", "1,", ",1", "1,,2", "1;2", "1.5", "1,65"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    char words[64];
    snprintf(words, sizeof words, "--threads %s", bad[i]);
    refused(ALL, words, "--threads needs a whole number from 1 to 64");
  }
  refused(ALL & ~(unsigned)CB_OPT_THREADS, "--threads 1", "unknown option '--threads'");
}

static void test_words_refused(void **state) {
  (void)state;
  refused(ALL, "--varient *", "unknown option '--varient' (nearest: 'variant')");
  refused(ALL, "--quick --yung=3", "'young'");
  refused(ALL, "--nonsense", "corobench test --help");
  refused(ALL, "-x", "'-x'");
  refused(ALL, "--young 3 -xy", "'-xy'");
  refused(ALL, "--mesh", "'--mesh' needs a value, FILE");
  refused(ALL, "--quick=3", "'--quick' takes no value");
  refused(ALL, "word", "'word'");
  refused(ALL, "-- word", "'word'");
  refused(ALL, "--format xml", "'xml'");
  refused(ALL, "--seed -1", "'-1'");
  refused(ALL, "--young nan", "--young");
  refused(ALL, "--young 3 --young x", "'x'");
}

static void test_mask_hides_options(void **state) {
  (void)state;
  struct cb_options o;
  double young;
  refused(ALL & ~CB_OPT_MESH, "--mesh a.msh", "unknown option '--mesh'");
  refused(0, "--variant *", "unknown option '--variant'");
  assert_int_equal(parse(CB_OPT_SEED, "--seed 1", &o, &young), CB_OK);
}

static void test_too_many_globs(void **state) {
  (void)state;
  char words[2048] = "";
  for (size_t i = 0; i < 65; i++) strcat(words, "--variant * ");
  refused(ALL, words, "more than 64");
}

/* A full name selects that variant only, a model's name all of the model. */
static void test_selection(void **state) {
  (void)state;
  size_t variants;
  const struct cb_variant *v = cb_variants(&variants);
  assert_true(variants > 0);
  for (size_t i = 0; i < variants; i++) {
    char name[96], words[128];
    struct cb_options o;
    double young;
    cb_variant_name(&v[i], name);
    snprintf(words, sizeof words, "--variant %s", name);
    assert_int_equal(parse(ALL, words, &o, &young), CB_OK);
    for (size_t j = 0; j < variants; j++) assert_int_equal(cb_options_selects(&o, &v[j]), j == i);
    snprintf(words, sizeof words, "--variant %s", v[i].model->name);
    assert_int_equal(parse(ALL, words, &o, &young), CB_OK);
    for (size_t j = 0; j < variants; j++)
      assert_int_equal(cb_options_selects(&o, &v[j]),
                       strcmp(v[i].model->name, v[j].model->name) == 0);
  }
}

static void test_globs_add_up(void **state) {
  (void)state;
  struct cb_options none, storage, two;
  double young;
  const struct cb_variant *v = cb_variants(NULL);
  char words[256];
  snprintf(words, sizeof words, "--variant */%s/*", cb_storage_name[v->storage]);
  assert_int_equal(parse(ALL, "", &none, &young), CB_OK);
  assert_int_equal(parse(ALL, words, &storage, &young), CB_OK);
  for (const struct cb_variant *w = v; w->model; w++) {
    assert_true(cb_options_selects(&none, w));
    assert_int_equal(cb_options_selects(&storage, w), w->storage == v->storage);
  }
  snprintf(words, sizeof words, "--variant */%s/* --variant *", cb_storage_name[v->storage]);
  assert_int_equal(parse(ALL, words, &two, &young), CB_OK);
  for (const struct cb_variant *w = v; w->model; w++) assert_true(cb_options_selects(&two, w));
}

static void test_empty_selection(void **state) {
  (void)state;
  char name[96], words[128], quoted[100];
  const struct cb_variant *v = cb_variants(NULL);
  refused(ALL, "--variant zzz*zzz", "no variant matches 'zzz*zzz' (nearest: '");
  refused(ALL, "--variant * --variant [", "no variant matches '['");
  cb_variant_name(v, name);
  snprintf(quoted, sizeof quoted, "'%s'", name);
  snprintf(words, sizeof words, "--variant %sx", name);
  refused(ALL, words, quoted);
  snprintf(quoted, sizeof quoted, "'%s'", v->model->name);
  snprintf(words, sizeof words, "--variant %sx", v->model->name);
  refused(ALL, words, quoted);
}

static void test_numbers(void **state) {
  (void)state;
  double value = 5;
  const char *const bad[] = {"", " 1", "1 ", "1x", "x", "nan", "inf", "-inf", "1e999", "1,5"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_int_equal(cb_parse_number("--young", bad[i], -DBL_MAX, DBL_MAX, &value), CB_INPUT);
    assert_non_null(strstr(cb_error_message(), "--young"));
    assert_int_equal(cb_parse_number("--young", bad[i], -INFINITY, INFINITY, &value), CB_INPUT);
  }
  assert_int_equal(cb_parse_number("--h", "-0.1", 0, 1, &value), CB_INPUT);
  assert_int_equal(cb_parse_number("--h", "1.1", 0, 1, &value), CB_INPUT);
  assert_non_null(strstr(cb_error_message(), "from 0 to 1"));
  assert_true(value == 5);
  assert_int_equal(cb_parse_number("--h", "1", 0, 1, &value), CB_OK);
  assert_true(value == 1);
  assert_int_equal(cb_parse_number("--h", "-2.5e-3", -1, 1, &value), CB_OK);
  assert_true(value == -2.5e-3);
}

static void test_counts(void **state) {
  (void)state;
  unsigned long value = 5;
  const char *const bad[] = {"",     " 1", "1 ",  "-1", "+1",  "1.0",
                             "0x10", "x",  "1e3", "0",  "101", "99999999999999999999999"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    assert_int_equal(cb_parse_count("--n", bad[i], 1, 100, &value), CB_INPUT);
  assert_int_equal(cb_parse_count("--n", "99999999999999999999999", 0, ULONG_MAX, &value),
                   CB_INPUT);
  assert_int_equal(value, 5);
  assert_int_equal(cb_parse_count("--n", "100", 1, 100, &value), CB_OK);
  assert_int_equal(value, 100);
}

static void nearest_is(const char *text, const char *names) {
  static const char *const offered[] = {"list", "verify", "ops", "force", "bench", "list"};
  struct cb_nearest nearest = {.text = text};
  for (size_t i = 0; i < sizeof offered / sizeof *offered; i++)
    cb_nearest_offer(&nearest, offered[i]);
  assert_string_equal(nearest.names, names);
}

static void test_nearest(void **state) {
  (void)state;
  nearest_is("list", "'list'");
  nearest_is("lst", "'list'");
  nearest_is("forces", "'force'");
  nearest_is("ver*", "'verify'");
  nearest_is("?ps", "'ops'");
  nearest_is("*", "'list', 'verify', 'ops'");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_defaults),
      cmocka_unit_test(test_everything_given),
      cmocka_unit_test(test_threads),
      cmocka_unit_test(test_words_refused),
      cmocka_unit_test(test_mask_hides_options),
      cmocka_unit_test(test_too_many_globs),
      cmocka_unit_test(test_selection),
      cmocka_unit_test(test_globs_add_up),
      cmocka_unit_test(test_empty_selection),
      cmocka_unit_test(test_numbers),
      cmocka_unit_test(test_counts),
      cmocka_unit_test(test_nearest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
