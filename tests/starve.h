/* starve.h - works whose n-th allocation fails, for n = 1, 2, ... until none does, alone and with
 * all after it. To be included by one file of a test program, after cmocka.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STARVE_H
#define CB_STARVE_H

#include <fcntl.h>
#include <unistd.h>

#include "harness/error.h"
#include "harness/verbs/verbs.h"
#include "tests/process.h"
#include "tests/shortage.h"

/* Every allocation of a short work; of a long one the first, and then some at equal distances. */
enum { FIRST = 300, LATER = 60 };

struct work {
  const char *name;
  enum cb_status (*run)(void *context);
  void *context;
  bool silent;         /* the kernels return a status and record no sentence */
  bool unsteady;       /* how many it asks for depends on times, or a child process asks */
  size_t first, later; /* 0: FIRST, LATER */
};

static size_t injected, harmless;

static void assert_clean(const struct work *w, size_t n, enum cb_status status) {
  const bool harmed = status != CB_OK;
  injected++;
  harmless += !harmed;
  if (shortage_live_count)
    fail_msg("%s, allocation %zu: status %d, %zu blocks are left", w->name, n, status,
             shortage_live_count);
  if (harmed && status != CB_MEMORY && status != CB_IO && status != CB_NUMERIC)
    fail_msg("%s, allocation %zu: status %d: %s", w->name, n, status, cb_error_message());
  if (harmed && !w->silent && !cb_error_message()[0])
    fail_msg("%s, allocation %zu: status %d without a sentence", w->name, n, status);
}

static enum cb_status run_short(const struct work *w, size_t n, bool lasts) {
  cb_fail(CB_INPUT, "%s", "");
  shortage_arm(n, lasts);
  const enum cb_status status = w->run(w->context);
  shortage_disarm();
  return status;
}

static void starve(const struct work *w) {
  run_short(w, 0, false); /* what libraries make once is made */
  assert_int_equal(run_short(w, 0, false), CB_OK);
  const size_t all = shortage.asked;
  if (all == 0 && !shortage_reaches_libc) return; /* what it asks for, others ask for it */
  if (all == 0 || shortage_live_count)
    fail_msg("%s: %zu allocations, %zu blocks are left", w->name, all, shortage_live_count);
  const size_t first = w->first ? w->first : FIRST, later = w->later ? w->later : LATER;
  const size_t stride = all > first + later ? (all - first) / later : 1;
  for (size_t n = 1; n <= all; n += n <= first ? 1 : stride)
    for (int lasts = 0; lasts < 2; lasts++) {
      const enum cb_status status = run_short(w, n, lasts);
      if (!shortage.failed && !w->unsteady)
        fail_msg("%s: allocation %zu of %zu is not asked for", w->name, n, all);
      assert_clean(w, n, status);
    }
  assert_int_equal(run_short(w, 0, false), CB_OK);
}

/* ---- verbs and other works that print ---------------------------------------------------- */

struct command {
  const struct cb_verb *verb;
  const char *words[12];
};

static int nowhere, own[2]; /* /dev/null; what the test itself writes to */

static void starve_begin(void) {
  own[0] = dup(1), own[1] = dup(2), nowhere = open("/dev/null", O_WRONLY);
  assert_true(own[0] >= 0 && own[1] >= 0 && nowhere >= 0);
}

static void starve_end(void) { close(own[0]), close(own[1]), close(nowhere); }

static void send(int out, int err) {
  fflush(stdout);
  dup2(out, 1);
  dup2(err, 2);
}

/* As main does, in this process, unheard. */
static enum cb_status run_verb(void *context) {
  const struct command *c = context;
  char *argv[16] = {(char *)"corobench"};
  int argc = 1;
  for (; c->words[argc - 1]; argc++) argv[argc] = (char *)c->words[argc - 1];
  send(nowhere, nowhere);
  const enum cb_status status = c->verb->run(argc, argv);
  send(own[0], own[1]);
  return status;
}

#endif
