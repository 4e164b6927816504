/* test_machine.c - the loops compute what they say, a crew does all of its work on
 * processors of its own, the roofline, and what `corobench machine` reports. No
 * timing is judged.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/measure/crew.h"
#include "harness/measure/machine.h"
#include "tests/process.h"

/* ---- loops ----------------------------------------------------------------- */

/* Chain k after n repeats of a := a/2 + 1, exact in both scalars. */
static void test_multiply_add(void **state) {
  (void)state;
  for (const struct cb_loops *loops = cb_loops; loops->name; loops++) {
    if (!loops->runs()) continue;
    for (size_t n = 0; n < 4; n++) {
      double sum = 0;
      for (int k = 0; k < CB_LOOP_CHAINS; k++) {
        double a = k;
        for (size_t i = 0; i < n; i++) a = a / 2 + 1;
        sum += a;
      }
      const double lanes64 = (double)(loops->bytes / sizeof(double));
      assert_true(loops->multiply_add[CB_F64](n, 0.5, 1) == lanes64 * sum);
      assert_true(loops->multiply_add[CB_F32](n, 0.5, 1) == 2 * lanes64 * sum);
    }
  }
}

static void test_read_and_triad(void **state) {
  (void)state;
  enum { N = 2 * CB_LOOP_UNIT };
  static double a[N + CB_LOOP_UNIT] __attribute__((aligned(512)));
  static double b[N] __attribute__((aligned(512))), c[N] __attribute__((aligned(512)));
  for (const struct cb_loops *loops = cb_loops; loops->name; loops++) {
    if (!loops->runs()) continue;
    for (size_t i = 0; i < N; i++) {
      b[i] = (double)i;
      c[i] = (double)(i * i);
    }
    for (size_t i = 0; i < N + CB_LOOP_UNIT; i++) a[i] = -1;
    assert_true(loops->read(3, N, b) == 3.0 * N * (N - 1) / 2);
    loops->triad(2, N, 2, b, c, a);
    for (size_t i = 0; i < N; i++) assert_true(a[i] == b[i] + 2 * c[i]);
    for (size_t i = N; i < N + CB_LOOP_UNIT; i++) assert_true(a[i] == -1);
  }
}

/* ---- crew ------------------------------------------------------------------ */

struct tally {
  size_t calls[CPU_SETSIZE], repeats[CPU_SETSIZE];
  int cpus[CPU_SETSIZE], allowed[CPU_SETSIZE]; /* where it ran; how many it might use */
};

static void tally_work(void *context, size_t thread, size_t repeats) {
  struct tally *t = context;
  cpu_set_t set;
  t->calls[thread]++;
  t->repeats[thread] = repeats;
  t->cpus[thread] = sched_getcpu();
  t->allowed[thread] = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

static void test_crew(void **state) {
  (void)state;
  cpu_set_t before, after;
  assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
  assert_int_equal(cb_crew_limit(), CPU_COUNT(&before));
  static struct tally t;
  double seconds[5] = {-1, -1, -1, -1, -1};
  assert_int_equal(cb_crew_time(cb_crew_limit(), tally_work, &t, 0, 4, seconds), CB_OK);
  for (size_t i = 0; i < cb_crew_limit(); i++) {
    assert_int_equal(t.calls[i], 5); /* one to warm up */
    assert_int_equal(t.repeats[i], 1);
    assert_int_equal(t.allowed[i], 1);
    assert_true(CPU_ISSET(t.cpus[i], &before));
    for (size_t k = 0; k < i; k++) assert_int_not_equal(t.cpus[i], t.cpus[k]);
  }
  for (size_t e = 0; e < 4; e++) assert_true(seconds[e] >= 0);
  assert_true(seconds[4] == -1);
  assert_int_equal(sched_getaffinity(0, sizeof after, &after), 0);
  assert_true(CPU_EQUAL(&before, &after));
}

/* ---- roofline -------------------------------------------------------------- */

static void test_attainable(void **state) {
  (void)state;
  static struct cb_machine m;
  m.peak_flops[CB_F32][CB_ALL] = 100;
  m.bandwidth[CB_L2][CB_ALL] = 10;
  m.bandwidth[CB_L3][CB_ALL] = NAN;
  assert_true(cb_machine_attainable(&m, 5, 1, CB_L2, CB_ALL, CB_F32) == 50);
  assert_true(cb_machine_attainable(&m, 10, 1, CB_L2, CB_ALL, CB_F32) == 100);
  assert_true(cb_machine_attainable(&m, 1000, 1, CB_L2, CB_ALL, CB_F32) == 100);
  assert_true(cb_machine_attainable(&m, 1, 4, CB_L2, CB_ALL, CB_F32) == 2.5);
  assert_true(isnan(cb_machine_attainable(&m, 1, 1, CB_L3, CB_ALL, CB_F32)));
}

/* Private caches of 32 kB and 1 MB a core, 16 MB for two cores. */
static void test_level(void **state) {
  (void)state;
  const struct cb_environment e = {.cache_count = 4,
                                   .caches = {{1, 1, "Data", 32e3},
                                              {1, 1, "Instruction", 64e3},
                                              {2, 1, "Unified", 1e6},
                                              {3, 2, "Unified", 16e6}}};
  const struct cb_environment none = {.cache_count = 0};
  assert_int_equal(cb_machine_level(&e, 32e3, 1), CB_L1);
  assert_int_equal(cb_machine_level(&e, 33e3, 1), CB_L2);
  assert_int_equal(cb_machine_level(&e, 64e3, 2), CB_L1); /* two caches */
  assert_int_equal(cb_machine_level(&e, 1.9e6, 2), CB_L2);
  assert_int_equal(cb_machine_level(&e, 1.9e6, 1), CB_L3);
  assert_int_equal(cb_machine_level(&e, 16e6, 2), CB_L3); /* one cache for both */
  assert_int_equal(cb_machine_level(&e, 17e6, 2), CB_DRAM);
  assert_int_equal(cb_machine_level(&none, 1, 1), CB_DRAM);
}

/* ---- the verb -------------------------------------------------------------- */

#define RUN(...) run_words(NULL, (const char *const[]){__VA_ARGS__, NULL})

static bool runs_here(const char *set) {
  for (const struct cb_loops *loops = cb_loops; loops->name; loops++)
    if (strcmp(loops->name, set) == 0) return loops->runs();
  return false;
}

/* Every measured row is positive, in order, of this machine. */
static void check_row(const char *line, size_t *peaks, size_t *attainable, size_t *barriers) {
  char quantity[32], set[32], unit[16];
  double value, low, high;
  size_t threads, bytes = 0;
  if (strncmp(line, "attainable-", 11) == 0) {
    assert_int_equal(sscanf(line, "%31[^,],best,%zu,%lf,,,Gflop/s,", quantity, &threads, &value),
                     3);
    (*attainable)++;
    assert_true(value > 0 && isfinite(value));
    return;
  }
  if (strncmp(line, "barrier,", 8) == 0) {
    assert_int_equal(sscanf(line, "barrier,,%zu,%lf,%lf,%lf,ns,", &threads, &value, &low, &high),
                     4);
    (*barriers)++;
    assert_int_equal(threads, cb_crew_limit());
    assert_true(0 < low && low <= value && value <= high && isfinite(high));
    return;
  }
  const int cells = sscanf(line, "%31[^,],%31[^,],%zu,%lf,%lf,%lf,%15[^,],%zu", quantity, set,
                           &threads, &value, &low, &high, unit, &bytes);
  assert_true(cells == 7 || cells == 8);
  assert_true(0 < low && low <= value && value <= high && isfinite(high));
  assert_true(runs_here(set));
  assert_true(threads == 1 || threads == cb_crew_limit());
  const bool peak = strncmp(quantity, "fma-", 4) == 0;
  assert_string_equal(unit, peak ? "Gflop/s" : "GB/s");
  assert_true(peak ? bytes == 0 : bytes > 0);
  *peaks += peak;
}

static void test_verb(void **state) {
  (void)state;
  struct process p = RUN("machine", "--format", "csv", "--output", temporary_path("machine"),
                         "--flops", "129", "--bytes", "52");
  assert_int_equal(p.exit_status, 0);
  char *written = read_text(temporary_path("machine/machine.csv"));
  assert_string_equal(written, p.out);
  size_t sets = 0, rows = 0, peaks = 0, attainable = 0, barriers = 0;
  for (char *end, *line = p.out; (end = strchr(line, '\n')); line = end + 1, rows++) {
    *end = '\0';
    if (rows > 0)
      check_row(line, &peaks, &attainable, &barriers);
    else
      assert_string_equal(line,
                          "quantity,instruction_set,threads,value,low,high,unit,working_set_bytes");
  }
  for (const struct cb_loops *loops = cb_loops; loops->name; loops++) sets += loops->runs();
  const size_t crews = cb_crew_limit() > 1 ? 2 : 1;
  assert_int_equal(peaks, crews * sets * CB_SCALARS);
  /* As many bandwidths, read and triad, as levels with an f32 and an f64 roof; DRAM at least. */
  assert_true(attainable >= crews * CB_SCALARS);
  assert_int_equal(barriers, crews - 1);
  assert_int_equal(rows - 1 - peaks - attainable - barriers, attainable);
  free(written);
  process_free(&p);
}

static void test_verb_refuses(void **state) {
  (void)state;
  assert_refused(RUN("machine", "--flops", "129"), "give both");
  assert_refused(RUN("machine", "--flops", "0", "--bytes", "1"), "--flops");
  assert_refused(RUN("machine", "--variant", "*"), "unknown option '--variant'");
}

/* argv[1]: a pattern of the tests to run; without it all of them. */
int main(int argc, char **argv) {
  if (argc > 1) cmocka_set_test_filter(argv[1]);
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_multiply_add), cmocka_unit_test(test_read_and_triad),
      cmocka_unit_test(test_crew),         cmocka_unit_test(test_attainable),
      cmocka_unit_test(test_level),        cmocka_unit_test(test_verb),
      cmocka_unit_test(test_verb_refuses)};
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
