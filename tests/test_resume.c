/* test_resume.c - runs of bench, trade and extremes, killed at random moments and resumed: no
 * finished row is lost, and in the end there are the rows of a run that nobody has killed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_rng.h>
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include <time.h>

#include <cmocka.h>

#include "tests/process.h"
#include "tests/tally.h"

/* A verb that keeps a journal, and what tells its rows apart: the first columns of its files. */
enum { FILES = 2 };
struct verb {
  const char *name, *results[FILES]; /* the second may be NULL */
  int columns;
  const char *words[16];
};
static const struct verb BENCH = {"bench",
                                  {"bench.csv"},
                                  6,
                                  {"--quick", "--seconds", "1", "--figure", "memory", "--figure",
                                   "4", "--figure", "7", "--variant", "qr-updated/ebe/f64",
                                   "--threads", "1"}};
static const struct verb TRADE = {"trade",
                                  {"trade.csv"},
                                  11,
                                  {"tests/fuzz/corpus/scene/loads.json", "--quick", "--variant",
                                   "qr-updated/*", "--variant", "linear"}};

/* Nothing is timed: all columns are the same again. Without a row that breaks. */
static const struct verb EXTREMES = {"extremes",
                                     {"extremes.csv", "extremes-steps.csv"},
                                     INT_MAX,
                                     {"--variant", "linear/ebe/f64", "--variant",
                                      "qr-updated/ebe/f64", "--variant",
                                      "svd-updated-volume/ebe/f64"}};

static double clock_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* corobench NAME words --output DIR, and one more word or none. */
static void words_of(const struct verb *v, const char *directory, const char *last,
                     const char **argv) {
  size_t n = 0;
  argv[n++] = program;
  argv[n++] = v->name;
  for (size_t i = 0; v->words[i]; i++) argv[n++] = v->words[i];
  argv[n++] = "--output";
  argv[n++] = directory;
  argv[n++] = last;
  argv[n] = NULL;
}

static pid_t start(const struct verb *v, const char *directory, const char *last) {
  const char *argv[32];
  pid_t pid;
  posix_spawn_file_actions_t files;
  words_of(v, directory, last, argv);
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, temporary_path("said"), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  assert_int_equal(posix_spawn(&pid, program, &files, NULL, (char *const *)argv, environ), 0);
  posix_spawn_file_actions_destroy(&files);
  return pid;
}

static void wait_s(double seconds) {
  nanosleep(&(struct timespec){(time_t)seconds, (long)(1e9 * (seconds - floor(seconds)))}, NULL);
}

/* Resume, kill after so many seconds unless it has ended before; was it killed? */
static bool killed_after(const struct verb *v, const char *directory, double seconds) {
  int status;
  const pid_t pid = start(v, directory, "--resume");
  wait_s(seconds);
  kill(pid, SIGKILL);
  assert_int_equal(waitpid(pid, &status, 0), pid);
  if (WIFSIGNALED(status)) return true;
  char *said = read_text(temporary_path("said"));
  if (WEXITSTATUS(status) != 0) fail_msg("exit status %d: %s", WEXITSTATUS(status), said);
  free(said);
  return false;
}

/* What tells the rows of that file apart, a line each; to be freed. */
static char *rows_of(const struct verb *v, int file, const char *directory) {
  if (!v->results[file]) return strdup("");
  char path[512];
  snprintf(path, sizeof path, "%s/%s", directory, v->results[file]);
  char *text = read_text(path), *to = text;
  assert_true(lines(text) > 5);
  for (char *line = text; *line;) {
    int columns = 0;
    for (; *line != '\n'; line++) {
      columns += *line == ',';
      if (columns < v->columns) *to++ = *line;
    }
    *to++ = *line++;
  }
  *to = '\0';
  return text;
}

/* The whole lines of the journal; "" when there is none. */
static char *journal_of(const struct verb *v, const char *directory) {
  char path[512];
  snprintf(path, sizeof path, "%s/%s.unfinished", directory, v->name);
  char *text = read_text(path);
  size_t length = strlen(text);
  while (length > 0 && text[length - 1] != '\n') length--;
  text[length] = '\0';
  return text;
}

/* From its beginning to its end, killed as often as it takes, at most `kills` times, each within
 * half the time of a whole run: a few times on the way. */
static size_t campaign(const struct verb *v, const char *directory, double longest, size_t kills,
                       gsl_rng *rng) {
  size_t killed = 0;
  char *before = strdup("");
  while (killed < kills && killed_after(v, directory, longest / 2 * gsl_rng_uniform(rng))) {
    char *now = journal_of(v, directory);
    killed++;
    if (strncmp(now, before, strlen(before)) != 0)
      fail_msg("finished rows are lost: there were\n%s\nthere are\n%s", before, now);
    free(before);
    before = now;
  }
  free(before);
  return killed;
}

static void survive(const struct verb *v, size_t kills) {
  char whole[256], broken[256];
  snprintf(whole, sizeof whole, "%s", temporary_path("whole"));
  snprintf(broken, sizeof broken, "%s", temporary_path("broken"));
  const char *argv[32];
  words_of(v, whole, NULL, argv);
  const double begin = clock_s();
  struct process p = process_run(argv, environ, NULL);
  const double longest = clock_s() - begin;
  assert_done(&p);
  process_free(&p);
  char *expected[FILES];
  for (int i = 0; i < FILES; i++) expected[i] = rows_of(v, i, whole);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  assert_non_null(rng);
  size_t killed = 0, finished = 0;
  while (killed < kills) {
    killed += campaign(v, broken, longest, kills - killed, rng);
    /* and what is left, undisturbed */
    words_of(v, broken, "--resume", argv);
    p = process_run(argv, environ, NULL);
    assert_done(&p);
    process_free(&p);
    for (int i = 0; i < FILES; i++) {
      char *found = rows_of(v, i, broken);
      assert_string_equal(found, expected[i]);
      free(found);
    }
    char *left = journal_of(v, broken);
    assert_string_equal(left, "");
    free(left);
    finished++;
  }
  gsl_rng_free(rng);
  for (int i = 0; i < FILES; i++) free(expected[i]);
  char what[64];
  snprintf(what, sizeof what, "kills of %s survived", v->name);
  tally(what, killed);
  snprintf(what, sizeof what, "runs of %s resumed to the end", v->name);
  tally(what, finished);
}

/* How often: few in every test, fewer where a run takes ten times as long, many where it is
 * asked for. */
static size_t kills_of(size_t few) {
  const char *text = getenv("CB_KILLS");
#if defined(__SANITIZE_ADDRESS__)
  few = 2;
#endif
  return text ? strtoul(text, NULL, 10) : few;
}

static void bench_survives(void **state) {
  (void)state;
  survive(&BENCH, kills_of(6));
}

static void trade_survives(void **state) {
  (void)state;
  survive(&TRADE, kills_of(4));
}

static void extremes_survives(void **state) {
  (void)state;
  survive(&EXTREMES, kills_of(6));
  assert_refused(run_words(NULL, (const char *const[]){"extremes", "--resume", NULL}),
                 "--resume needs the --output directory");
}

/* ---- how it is told ------------------------------------------------------------------------ */

/* Begin and, as soon as so many lines are in the journal, end by that signal; the wait status. */
static int ended_at(const char *directory, size_t wanted, int signal_number) {
  int status;
  const pid_t pid = start(&BENCH, directory, NULL);
  const double begin = clock_s();
  for (size_t found = 0; found < wanted && clock_s() - begin < 60; wait_s(0.002)) {
    char *text = journal_of(&BENCH, directory);
    found = lines(text);
    free(text);
  }
  kill(pid, signal_number);
  assert_int_equal(waitpid(pid, &status, 0), pid);
  return status;
}

static struct process resumed(const char *directory, const char *more, const char *value) {
  const char *argv[32];
  words_of(&BENCH, directory, "--resume", argv);
  size_t n = 0;
  while (argv[n]) n++;
  argv[n] = more, argv[n + 1] = more ? value : NULL, argv[n + 2] = NULL;
  return process_run(argv, environ, NULL);
}

/* The last column of the last row of that figure in bench.csv; 0: no row. */
static char session_of(const char *directory, const char *figure) {
  char path[512], line[1024], session = 0;
  snprintf(path, sizeof path, "%s/bench.csv", directory);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  while (fgets(line, sizeof line, file))
    if (strncmp(line, figure, strlen(figure)) == 0) session = line[strlen(line) - 2];
  fclose(file);
  return session;
}

static void rows_tell_their_session(void **state) {
  (void)state;
  char directory[256];
  snprintf(directory, sizeof directory, "%s", temporary_path("told"));
  int tries = 0;
  while (!WIFSIGNALED(ended_at(directory, 3, SIGKILL))) assert_true(tries++ < 20);
  assert_refused(resumed(directory, "--seconds", "2"), "another options");
  assert_refused(resumed(directory, "--seed", "7"), "seed 7");
  struct process p = resumed(directory, NULL, NULL);
  assert_done(&p);
  process_free(&p);
  assert_int_equal(session_of(directory, "memory,"), '1');
  assert_int_equal(session_of(directory, "4,"), '1');
  assert_int_equal(session_of(directory, "7,"), '2');
  char *footer = read_text(temporary_path("told/footer.txt"));
  assert_non_null(strstr(footer, "resumed, 2 sessions"));
  free(footer);
}

static void an_interrupt_says_how_to_go_on(void **state) {
  (void)state;
  char directory[256];
  snprintf(directory, sizeof directory, "%s", temporary_path("interrupted"));
  int status, tries = 0; /* a busy machine may let the run end before the signal comes */
  while (status = ended_at(directory, 2, SIGINT), WEXITSTATUS(status) != 130) {
    assert_true(tries++ < 20);
    unlink(temporary_path("interrupted/bench.csv"));
  }
  char *said = read_text(temporary_path("said"));
  assert_non_null(strstr(said, "interrupted"));
  assert_non_null(strstr(said, "--resume"));
  free(said);
  struct stat found;
  assert_int_not_equal(stat(temporary_path("interrupted/bench.csv"), &found), 0);
  struct process p = resumed(directory, NULL, NULL);
  assert_done(&p);
  process_free(&p);
}

int main(int argc, char **argv) {
  if (argc > 1) cmocka_set_test_filter(argv[1]);
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bench_survives), cmocka_unit_test(trade_survives),
      cmocka_unit_test(extremes_survives), cmocka_unit_test(rows_tell_their_session),
      cmocka_unit_test(an_interrupt_says_how_to_go_on)};
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
