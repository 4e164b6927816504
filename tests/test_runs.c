/* test_runs.c - verify, ops and bench as a user runs them: the columns that
 * programs may rely on, and how a run ends that is stopped, has no room or no
 * memory.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <dirent.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "tests/process.h"

#define RUN(...) run_words(NULL, (const char *const[]){__VA_ARGS__, NULL})

static void assert_begins(const char *text, const char *start) {
  if (strncmp(text, start, strlen(start)) != 0)
    fail_msg("expected '%s', found '%.200s'", start, text);
}

/* How many files the directory has, and how many of them are unfinished. */
static size_t count_files(const char *path, size_t *parts) {
  size_t n = 0;
  DIR *directory = opendir(path);
  *parts = 0;
  if (!directory) return 0;
  for (struct dirent *entry; (entry = readdir(directory));)
    if (entry->d_name[0] != '.') n++, *parts += strstr(entry->d_name, ".part") != NULL;
  closedir(directory);
  return n;
}

static void test_ops_columns(void **state) {
  (void)state;
  struct process p = RUN("ops", "--variant", "qr-updated/ebe-paper/*", "--format", "csv");
  assert_done(&p);
  assert_begins(p.out, "model,storage,stage,mul,add,div,sqrt\n");
  assert_non_null(strstr(p.out, "\nqr-updated,ebe-paper,strain-displacement,14,5,0,0\n"));
  assert_non_null(strstr(p.out, "\nqr-updated,ebe-paper,frame,"));
  assert_non_null(strstr(p.out, "\nqr-updated,ebe-paper,force,"));
  assert_non_null(strstr(p.out, "\nqr-updated,ebe-paper,product,"));
  process_free(&p);
  p = RUN("ops", "--variant", "svd-updated/ebe-paper/f64", "--format", "csv");
  assert_non_null(strstr(p.out, "\nsvd-updated,ebe-paper,strain-displacement,72,60,0,0\n"));
  process_free(&p);
}

static void test_laws_columns(void **state) {
  (void)state;
  struct process p = RUN("verify", "--laws", "--mesh", small_mesh(), "--variant", "qr-precomputed",
                         "--variant", "qr-exact", "--format", "csv");
  assert_done(&p);
  assert_begins(p.out, "model,material,law,value,expected,holds");
  assert_int_equal(lines(p.out), 1 + 2 * 2 * 8); /* models, materials, laws */
  assert_null(strstr(p.out, "FAILS"));
  const char *stale = strstr(p.out, "qr-precomputed,isotropic,euler,");
  const char *exact = strstr(p.out, "qr-exact,isotropic,euler,");
  assert_non_null(stale);
  assert_non_null(exact);
  double value;
  assert_int_equal(sscanf(stale, "qr-precomputed,isotropic,euler,%lf,broken,broken", &value), 1);
  assert_true(value > 1e-3);
  assert_int_equal(sscanf(exact, "qr-exact,isotropic,euler,%lf,kept,kept", &value), 1);
  assert_true(value < 1e-10);
  process_free(&p);
}

static void test_bench_columns(void **state) {
  (void)state;
  const char *results = temporary_path("results");
  struct process p = RUN("bench", "--quick", "--figure", "memory", "--output", results);
  assert_done(&p);
  process_free(&p);
  char *csv = read_text(temporary_path("results/bench.csv"));
  assert_begins(csv, "figure,variant,tetrahedra,nodes,iterations,threads,step_s_median,step_s_low,"
                     "step_s_high,bytes_per_tetrahedron,status");
  assert_true(lines(csv) > 50);
  free(csv);
}

static void test_bench_mesh(void **state) {
  (void)state;
  char results[256]; /* temporary_path keeps only the last four */
  snprintf(results, sizeof results, "%s", temporary_path("own"));
  struct process p = RUN("bench", "--quick", "--seconds", "1", "--mesh", small_mesh(), "--variant",
                         "qr-*/ebe/f64", "--output", results);
  assert_done(&p);
  process_free(&p);
  char *csv = read_text(temporary_path("own/bench.csv"));
  assert_non_null(strstr(csv, "\nmesh,qr-exact/ebe/f64,2,5,5,1,"));
  free(csv);
}

/* Start corobench, send a signal after a while, return its exit status; -1: it died of the
 * signal, which came before it was listening. */
static int signalled(const char *const *words, double seconds, int signal_number) {
  const char *argv[16] = {program};
  pid_t pid;
  int status = -1;
  posix_spawn_file_actions_t files;
  for (size_t i = 0; words[i]; i++) argv[i + 1] = words[i];
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, temporary_path("said"), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  assert_int_equal(posix_spawn(&pid, program, &files, NULL, (char *const *)argv, environ), 0);
  nanosleep(&(struct timespec){(time_t)seconds, (long)(1e9 * (seconds - (time_t)seconds))}, NULL);
  kill(pid, signal_number);
  assert_int_equal(waitpid(pid, &status, 0), pid);
  posix_spawn_file_actions_destroy(&files);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int interrupted(const char *const *words, double seconds, int signal_number) {
  int status = -1;
  for (; status == -1 && seconds < 60; seconds *= 2)
    status = signalled(words, seconds, signal_number);
  return status;
}

static void test_interrupt(void **state) {
  (void)state;
  const double after[] = {0.2, 1.1, 2.3};
  for (int i = 0; i < 3; i++) {
    size_t parts;
    const char *results = temporary_path("stopped");
    const char *words[] = {"bench", "--output", results, NULL};
    assert_int_equal(interrupted(words, after[i], i == 1 ? SIGTERM : SIGINT), 130);
    char *said = read_text(temporary_path("said"));
    assert_non_null(strstr(said, "interrupted"));
    free(said);
    count_files(temporary_path("stopped"), &parts);
    assert_int_equal(parts, 0);
  }
}

static void test_interrupted_verify(void **state) {
  (void)state;
  const char *words[] = {"verify", "--output", temporary_path("unverified"), NULL};
  size_t parts;
  assert_int_equal(interrupted(words, 0.5, SIGINT), 130);
  assert_int_equal(count_files(temporary_path("unverified"), &parts), 0);
}

static void test_no_room(void **state) {
  (void)state;
  /* a file where the directory should be */
  const char *blocked = temporary_path("blocked");
  fclose(fopen(blocked, "w"));
  assert_refused(RUN("bench", "--quick", "--figure", "memory", "--output", blocked), "blocked");
  assert_refused(RUN("verify", "--laws", "--output", temporary_path("blocked")), "blocked");
  struct process p =
      run_words("/dev/full", (const char *const[]){"ops", "--variant", "svd-*", NULL});
  assert_one_sentence(&p, "No space left");
  process_free(&p);
}

/* With too little address space every verb says so and leaves nothing half. */
static void test_no_memory(void **state) {
  (void)state;
  char *tight = NULL;
#if defined(__SANITIZE_ADDRESS__)
  skip(); /* the sanitizer itself needs terabytes of address space */
#endif
  assert_true(asprintf(&tight, "ulimit -v 120000; exec '%s' bench --quick --figure 7 --output '%s'",
                       program, temporary_path("tight")) > 0);
  const char *argv[] = {"sh", "-c", tight, NULL};
  struct process p = process_run(argv, environ, NULL);
  assert_int_equal(p.exit_status, 2);
  assert_non_null(strstr(p.err, "not enough memory"));
  size_t parts;
  count_files(temporary_path("tight"), &parts);
  assert_int_equal(parts, 0);
  process_free(&p);
  free(tight);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ops_columns),   cmocka_unit_test(test_laws_columns),
      cmocka_unit_test(test_bench_columns), cmocka_unit_test(test_bench_mesh),
      cmocka_unit_test(test_interrupt),     cmocka_unit_test(test_interrupted_verify),
      cmocka_unit_test(test_no_room),       cmocka_unit_test(test_no_memory),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
