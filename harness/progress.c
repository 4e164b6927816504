/* progress.c - see progress.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/progress.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "harness/files/output.h"

/* ---- interrupts ------------------------------------------------------------ */

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
  (void)signal_number;
  if (interrupted) {
    cb_output_remove_parts();
    _exit(130);
  }
  interrupted = 1;
  int kept = errno;
  static const char text[] = "\nending; what is complete is kept (again: end at once)\n";
  ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  (void)written; /* nothing could be done about it */
  errno = kept;
}

void cb_interrupt_install(void) {
  struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

bool cb_interrupted(void) { return interrupted; }

/* ---- bar ------------------------------------------------------------------- */

static const double redraw_s = 0.1, line_s = 5;

static struct {
  bool active, terminal;
  char title[64];
  double total, began, drawn; /* began, drawn: clock readings, s */
  int width;                  /* characters of the bar now on the terminal */
} bar;

static double clock_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* "1:02:03" or "2:03". */
static void format_time(double seconds, char text[32]) {
  if (!(seconds < 360000)) {
    snprintf(text, 32, "?");
    return;
  }
  long s = lround(seconds);
  if (s >= 3600)
    snprintf(text, 32, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  else
    snprintf(text, 32, "%ld:%02ld", s / 60, s % 60);
}

void cb_progress_begin(const char *title, double total) {
  memset(&bar, 0, sizeof bar);
  bar.active = true;
  bar.terminal = isatty(STDERR_FILENO);
  snprintf(bar.title, sizeof bar.title, "%s", title);
  bar.total = total;
  bar.began = clock_s();
  bar.drawn = bar.terminal ? -INFINITY : bar.began;
}

static void draw_bar(double fraction, const char *text) {
  struct winsize size;
  int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col ? size.ws_col : 80;
  char line[256], cells[21];
  size_t filled = (size_t)(20 * fraction);
  for (size_t i = 0; i < 20; i++) cells[i] = i < filled ? '#' : '.';
  cells[20] = '\0';
  int width = snprintf(line, sizeof line, "%s [%s] %s", bar.title, cells, text);
  if (width > (int)sizeof line - 1) width = sizeof line - 1;
  if (width > columns - 1) width = columns - 1; /* a bar that wraps cannot be erased */
  int blanks = bar.width > width ? bar.width - width : 0;
  fprintf(stderr, "\r%.*s%*s", width, line, blanks, "");
  bar.width = width;
}

void cb_progress(double done, const char *what) {
  double now = clock_s();
  if (!bar.active || now - bar.drawn < (bar.terminal ? redraw_s : line_s)) return;
  bar.drawn = now;
  double elapsed = now - bar.began, fraction = fmin(fmax(done / bar.total, 0), 1);
  char text[192], spent[32], remaining[32];
  format_time(elapsed, spent);
  format_time(elapsed * (1 - fraction) / fraction, remaining);
  snprintf(text, sizeof text, "%3.0f %%, %s elapsed, %s remaining, %s", floor(100 * fraction),
           spent, remaining, what);
  if (bar.terminal)
    draw_bar(fraction, text);
  else
    fprintf(stderr, "%s: %s\n", bar.title, text);
}

void cb_progress_end(void) {
  if (bar.width > 0) fprintf(stderr, "\r%*s\r", bar.width, "");
  bar.active = false;
  bar.width = 0;
}
