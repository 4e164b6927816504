/* test_room.c - verbs that write where there is no room or no permission: one sentence, exit
 * status 2, and nothing half.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/process.h"
#include "tests/tally.h"

#define SCENE "tests/fuzz/corpus/scene/loads.json"
#define MESH "tests/fuzz/corpus/mesh_gmsh/version2.msh"

/* What writes to a directory, as words of a shell. */
static const char *const commands[] = {
    "bench --quick --seconds 1 --figure memory --variant 'qr-updated/ebe*/f64'",
    "verify --laws --mesh " MESH " --variant qr-exact",
    "verify --counts --variant qr-exact",
    "trade " SCENE " --quick --variant qr-updated/ebe-cluster/f64",
    "run " SCENE,
    "force --mesh " MESH " --variant qr-exact/ebe/f64 --young 1e5 --poisson 0.3 --positions '%s'"};
enum { COMMANDS = sizeof commands / sizeof *commands };

static size_t refused;

static const char *positions(void) {
  static char path[256];
  snprintf(path, sizeof path, "%s", temporary_path("x.csv"));
  FILE *file = fopen(path, "w");
  fputs("node,x,y,z\n1,0,0,0\n2,1.1,0,0\n3,0.1,1,0\n4,0.2,0.1,1\n5,1,1,1\n", file);
  fclose(file);
  return path;
}

/* The shell's `before`, then corobench with command n and --output directory. */
static struct process run_in(const char *before, size_t n, const char *directory) {
  char *words = NULL, *line = NULL;
  assert_true(asprintf(&words, commands[n], positions()) > 0);
  assert_true(asprintf(&line, "%s '%s' %s --output '%s' >/dev/null", before, program, words,
                       directory) > 0);
  struct process p = process_run((const char *const[]){"sh", "-c", line, NULL}, environ, NULL);
  free(line);
  free(words);
  return p;
}

/* No half file is there: none that is being written, and none without its last line feed. */
static void assert_whole(const char *path) {
  DIR *directory = opendir(path);
  if (!directory) return; /* it could not even be made */
  for (struct dirent *entry; (entry = readdir(directory));) {
    char name[600];
    if (entry->d_name[0] == '.') continue;
    snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
    const size_t length = strlen(entry->d_name);
    if (length > 5 && strcmp(entry->d_name + length - 5, ".part") == 0)
      fail_msg("%s is left", name);
    char *text = read_text(name);
    if (!*text || text[strlen(text) - 1] != '\n') fail_msg("%s is not whole", name);
    free(text);
  }
  closedir(directory);
}

/* Either there was room, or one sentence says what could not be written. */
static bool is_refused(struct process p, const char *directory) {
  const bool fits = p.exit_status == 0;
  if (!fits) assert_one_sentence(&p, directory);
  process_free(&p);
  assert_whole(directory);
  refused += !fits;
  return !fits;
}

/* Files may have so many blocks of 512 bytes and no more: the first write, or a later one of a
 * longer file, fails. */
static void files_that_may_not_grow(void **state) {
  (void)state;
  static const int blocks[] = {1, 2, 8, 100000}; /* in 1, a sentence has room */
  for (size_t n = 0; n < COMMANDS; n++)
    for (size_t i = 0; i < 4; i++) {
      char before[64], directory[256], name[32];
      snprintf(before, sizeof before, "trap '' XFSZ; ulimit -f %d; exec", blocks[i]);
      snprintf(name, sizeof name, "room%zu-%zu", n, i);
      snprintf(directory, sizeof directory, "%s", temporary_path(name));
      const bool no = is_refused(run_in(before, n, directory), directory);
      if (blocks[i] == 100000) assert_false(no);
    }
  assert_true(refused >= COMMANDS);
}

/* A file system of a few pages, which fills up; where the test may mount one. */
static void a_disk_that_is_full(void **state) {
  (void)state;
  char before[512], directory[256];
  snprintf(directory, sizeof directory, "%s", temporary_path("disk"));
  const char *const mount = "unshare -m sh -c 'mkdir -p \"$0\" && mount -t tmpfs -o size=%s none "
                            "\"$0\" && \"$@\"; s=$?; ls \"$0\" | grep -q \"part$\" && "
                            "s=99; exit $s' '%s'";
  snprintf(before, sizeof before, mount, "1m", directory);
  struct process p = run_in(before, 4, directory);
  const bool mounted = p.exit_status == 0;
  process_free(&p);
  if (!mounted) skip();
  snprintf(before, sizeof before, mount, "4k", directory);
  for (size_t n = 0; n < COMMANDS; n++) {
    p = run_in(before, n, directory);
    if (p.exit_status == 0) { /* what it writes is that small */
      process_free(&p);
      continue;
    }
    assert_one_sentence(&p, "No space left");
    refused++;
    process_free(&p);
  }
  snprintf(before, sizeof before, mount, "1m,ro", directory);
  for (size_t n = 0; n < COMMANDS; n++) {
    p = run_in(before, n, directory);
    assert_one_sentence(&p, "Read-only file system");
    refused++;
    process_free(&p);
  }
}

/* Where nothing can be made, and who runs this may not matter. */
static void no_directory(void **state) {
  (void)state;
  for (size_t n = 0; n < COMMANDS; n++)
    assert_true(
        is_refused(run_in("exec", n, "/proc/corobench/results"), "/proc/corobench/results"));
}

static int end(void **state) {
  tally("outputs refused for want of room or permission", refused);
  return temporary_remove(state);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {cmocka_unit_test(files_that_may_not_grow),
                                     cmocka_unit_test(a_disk_that_is_full),
                                     cmocka_unit_test(no_directory)};
  return cmocka_run_group_tests(tests, temporary_make, end);
}
