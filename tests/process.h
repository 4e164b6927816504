/* process.h - run a program, mostly corobench, as a user does and look at what
 * it says. Include cmocka.h first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_PROCESS_H
#define CB_TESTS_PROCESS_H

#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/temporary.h"

struct process {
  int exit_status; /* -1: ended by a signal or could not be started */
  char *out, *err; /* what it wrote, NUL-terminated; "" where nothing */
};

/* The whole file as text, to be freed; "" if it cannot be read. */
static inline char *read_text(const char *path) {
  FILE *file = fopen(path, "r");
  char *text = NULL;
  size_t size = 0;
  if (!file || getdelim(&text, &size, '\0', file) < 0) {
    free(text);
    text = strdup("");
  }
  if (file) fclose(file);
  return text;
}

/* Run argv (NULL-terminated, argv[0] looked up in PATH) with that environment,
 * standard input empty, standard output to out_path (NULL: kept) and wait. */
static inline struct process process_run(const char *const *argv, char *const *environment,
                                         const char *out_path) {
  struct process p = {.exit_status = -1};
  posix_spawn_file_actions_t files;
  const char *out = temporary_path("stdout"), *err = temporary_path("stderr");
  pid_t pid;
  int status;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, out_path ? out_path : out,
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&files, 2, err, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (posix_spawnp(&pid, argv[0], &files, NULL, (char *const *)argv, environment) == 0 &&
      waitpid(pid, &status, 0) == pid && WIFEXITED(status))
    p.exit_status = WEXITSTATUS(status);
  posix_spawn_file_actions_destroy(&files);
  p.out = read_text(out);
  p.err = read_text(err);
  unlink(out);
  unlink(err);
  return p;
}

static inline void process_free(struct process *p) {
  free(p->out);
  free(p->err);
}

/* build/corobench of the test program build/tests/test_NAME. */
static char program[4096];

static inline void find_program(const char *test_program) {
  const char *slash = strrchr(test_program, '/');
  snprintf(program, sizeof program, "%.*s../corobench", slash ? (int)(slash + 1 - test_program) : 0,
           test_program);
}

/* corobench with those words (NULL-terminated, at most 30). */
static inline struct process run_words(const char *out_path, const char *const *words) {
  const char *argv[32] = {program};
  for (size_t i = 0; words[i]; i++) argv[i + 1] = words[i];
  return process_run(argv, environ, out_path);
}

static inline void assert_done(const struct process *p) {
  if (p->exit_status != 0) fail_msg("exit status %d: %s", p->exit_status, p->err);
}

static inline size_t lines(const char *text) {
  size_t n = 0;
  for (; *text; text++) n += *text == '\n';
  return n;
}

/* A small block of two positively oriented tetrahedra, as TetGen writes it. */
static inline const char *small_mesh(void) {
  const char *path = temporary_path("small.node");
  FILE *f = fopen(path, "w");
  fputs("5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0.1 1 0\n4 0.2 0.1 1\n5 1 1 1\n", f);
  fclose(f);
  f = fopen(temporary_path("small.ele"), "w");
  fputs("2 4 0\n1 1 2 3 4\n2 2 3 4 5\n", f);
  fclose(f);
  return path;
}

/* Exit status 2 and one line on standard error that says so. */
static inline void assert_one_sentence(const struct process *p, const char *said) {
  if (!strstr(p->err, said)) fail_msg("'%s' is not in: %s", said, p->err);
  assert_int_equal(strncmp(p->err, "corobench: ", 11), 0);
  assert_ptr_equal(strchr(p->err, '\n'), p->err + strlen(p->err) - 1);
  assert_int_equal(p->exit_status, 2);
}

static inline void assert_refused(struct process p, const char *said) {
  assert_one_sentence(&p, said);
  assert_string_equal(p.out, "");
  process_free(&p);
}

#endif
