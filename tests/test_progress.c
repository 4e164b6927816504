/* test_progress.c - the bar on a terminal, and nothing of it elsewhere.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <pty.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "harness/progress.h"

static void show_progress(void) {
  cb_progress(1, "before the beginning");
  cb_progress_begin("bench", 8);
  cb_progress(2, "qr/ebe/f64");
  cb_progress(4, "too soon to be drawn");
  usleep(150000);
  cb_progress(6, "polar");
  cb_progress_end();
  cb_progress(7, "after the end");
}

/* What a child writes to a terminal of that many columns. */
static void watch_terminal(unsigned short columns, char *text, size_t size) {
  struct winsize window = {.ws_row = 24, .ws_col = columns};
  int terminal;
  fflush(NULL);
  pid_t child = forkpty(&terminal, NULL, NULL, &window);
  assert_true(child >= 0);
  if (child == 0) {
    show_progress();
    _exit(0);
  }
  size_t used = 0;
  for (ssize_t got; used < size - 1 && (got = read(terminal, text + used, size - 1 - used)) > 0;)
    used += (size_t)got;
  text[used] = '\0';
  close(terminal);
  assert_int_equal(waitpid(child, NULL, 0), child);
}

static void bar_is_drawn_and_erased(void **state) {
  (void)state;
  char text[4096];
  watch_terminal(120, text, sizeof text);
  assert_non_null(strstr(text, "bench [#####...............]  25 %, 0:00 elapsed, "));
  assert_non_null(strstr(text, " 75 %, "));
  assert_non_null(strstr(text, "remaining, polar"));
  assert_null(strstr(text, "before"));
  assert_null(strstr(text, "after"));
  /* The last thing between two returns is blank: nothing stays. */
  size_t length = strlen(text);
  assert_true(length > 1 && text[length - 1] == '\r');
  text[length - 1] = '\0';
  const char *last = strrchr(text, '\r');
  assert_non_null(last);
  assert_int_equal(strspn(last + 1, " "), strlen(last + 1));
}

static void bar_fits_the_terminal(void **state) {
  (void)state;
  char text[4096], *rest = text;
  watch_terminal(30, text, sizeof text);
  size_t longest = 0;
  for (char *line; (line = strsep(&rest, "\r"));)
    if (strlen(line) > longest) longest = strlen(line);
  assert_int_equal(longest, 29);
}

static void file_gets_no_bar(void **state) {
  (void)state;
  FILE *file = tmpfile();
  assert_non_null(file);
  int kept = dup(STDERR_FILENO);
  dup2(fileno(file), STDERR_FILENO);
  show_progress();
  dup2(kept, STDERR_FILENO);
  close(kept);
  char text[4096];
  rewind(file);
  text[fread(text, 1, sizeof text - 1, file)] = '\0';
  fclose(file);
  assert_null(strchr(text, '\r'));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bar_is_drawn_and_erased),
      cmocka_unit_test(bar_fits_the_terminal),
      cmocka_unit_test(file_gets_no_bar),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
