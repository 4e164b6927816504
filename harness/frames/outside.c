/* outside.c - somebody else's routine, loaded and called in a child process, so that neither a
 * crash nor a hang there ends this program.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "harness/error.h"
#include "harness/frames/frames.h"
#include "harness/measure/timer.h"
#include "harness/progress.h"

/* A 3x3 rotation takes microseconds; so long (s) on one input is forever. */
static const double PATIENCE = 3;

static const char *const SYMBOL[2] = {"corobench_frame", "corobench_frame_f32"};

/* What the child leaves to its parent, in memory that both share. */
struct left {
  volatile size_t at;
  volatile bool complete;
  enum cb_status status;
  char message[512];
  bool has[2];
  struct cb_frame_result result;
};

struct call {
  const struct cb_outside *library;
  const struct cb_frame_set *set;
  const struct cb_frame_group *group;
};

/* ---- in the child --------------------------------------------------------------------------- */

union routine {
  void *symbol;
  void (*f64)(const double F[9], double R[9]);
  void (*f32)(const float F[9], float R[9]);
};

static void run_f64(const void *context, size_t count, const void *F, void *R) {
  const union routine *routine = context;
  for (size_t n = 0; n < count; n++) routine->f64((const double *)F + 9 * n, (double *)R + 9 * n);
}

static void run_f32(const void *context, size_t count, const void *F, void *R) {
  const union routine *routine = context;
  for (size_t n = 0; n < count; n++) routine->f32((const float *)F + 9 * n, (float *)R + 9 * n);
}

static void look_inside(const struct call *call, struct left *left) {
  const char *path = call->library->path;
  void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    left->status = cb_fail(CB_INPUT, "cannot load the library: %s", dlerror());
    return;
  }
  for (int i = 0; i < 2; i++) left->has[i] = dlsym(handle, SYMBOL[i]) != NULL;
  if (!left->has[0] && !left->has[1])
    left->status = cb_fail(CB_INPUT,
                           "'%s' has neither corobench_frame nor corobench_frame_f32; define 'void "
                           "corobench_frame(const double F[9], double R[9])' in it, extern \"C\" "
                           "if it is C++",
                           path);
}

static void measure_inside(const struct call *call, struct left *left) {
  const bool f32 = call->set->scalar_bytes == sizeof(float);
  void *handle = dlopen(call->library->path, RTLD_NOW | RTLD_LOCAL);
  union routine routine = {handle ? dlsym(handle, SYMBOL[f32]) : NULL};
  const struct cb_frame_routine outside = {f32 ? run_f32 : run_f64, &routine};
  if (!routine.symbol)
    left->status = cb_fail(CB_INPUT, "'%s' cannot be loaded again", call->library->path);
  else
    left->status = cb_frame_measure(&outside, call->set, call->group, &left->at, &left->result);
}

/* Never returns. What the library prints goes to standard error: the table stays whole. */
static void be_child(void (*work)(const struct call *, struct left *), const struct call *call,
                     struct left *left) {
  const int signals[] = {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  const struct rlimit no_core = {0, 0};
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) signal(signals[i], SIG_DFL);
  setrlimit(RLIMIT_CORE, &no_core);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  work(call, left);
  if (left->status) snprintf(left->message, sizeof left->message, "%s", cb_error_message());
  left->complete = true;
  _exit(EXIT_SUCCESS);
}

/* ---- in the parent -------------------------------------------------------------------------- */

/* Wait until it ends; ended by force when it is interrupted or stays at one input. */
static int watch(pid_t child, const struct left *left, bool *hung) {
  int how = 0;
  size_t last = SIZE_MAX;
  double since = cb_timer_now();
  while (waitpid(child, &how, WNOHANG) != child) {
    const double now = cb_timer_now();
    if (left->at != last) last = left->at, since = now;
    *hung = now - since > PATIENCE;
    if (*hung || cb_interrupted()) {
      kill(child, SIGKILL);
      waitpid(child, &how, 0);
      break;
    }
    nanosleep(&(struct timespec){.tv_nsec = 500000}, NULL);
  }
  return how;
}

static void say_how(const struct call *call, const struct left *left, int how,
                    struct cb_outside_end *end) {
  char where[96] = "while it was loaded", what[64];
  if (call->group && left->at < call->group->count)
    snprintf(where, sizeof where, "on input %zu of group %s", left->at + 1, call->group->name);
  else if (call->group)
    snprintf(where, sizeof where, "while it was timed on group %s", call->group->name);
  if (end->how == CB_OUTSIDE_HUNG)
    snprintf(what, sizeof what, "did not come back within %g s", PATIENCE);
  else if (end->how == CB_OUTSIDE_CRASHED)
    snprintf(what, sizeof what, "crashed (%s)", strsignal(WTERMSIG(how)));
  else
    snprintf(what, sizeof what, "ended the program (status %d)", WEXITSTATUS(how));
  snprintf(end->sentence, sizeof end->sentence, "%s %s %s",
           call->set ? SYMBOL[call->set->scalar_bytes == sizeof(float)] : "the library", what,
           where);
}

/* *out: to be unmapped, unless the status is not CB_OK. */
static enum cb_status in_child(void (*work)(const struct call *, struct left *),
                               const struct call *call, struct left **out,
                               struct cb_outside_end *end) {
  struct left *left =
      mmap(NULL, sizeof *left, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (left == MAP_FAILED) return cb_fail_memory("a child process");
  fflush(NULL); /* or it would be written twice */
  const pid_t child = fork();
  if (child < 0) {
    munmap(left, sizeof *left);
    return cb_fail(CB_IO, "no child process: %s", strerror(errno));
  }
  if (child == 0) be_child(work, call, left);
  bool hung = false;
  const int how = watch(child, left, &hung);
  *end = (struct cb_outside_end){.how = CB_OUTSIDE_DONE};
  enum cb_status status = CB_OK;
  if (cb_interrupted()) {
    status = cb_fail(CB_INTERRUPTED, "interrupted while a library was checked");
  } else if (!left->complete) {
    end->how = hung ? CB_OUTSIDE_HUNG : WIFEXITED(how) ? CB_OUTSIDE_LEFT : CB_OUTSIDE_CRASHED;
    say_how(call, left, how, end);
  } else if (left->status) {
    status = cb_fail(left->status, "%s", left->message);
  }
  if (status)
    munmap(left, sizeof *left);
  else
    *out = left;
  return status;
}

enum cb_status cb_outside_open(const char *path, struct cb_outside *library) {
  struct cb_outside made = {.has = {false}};
  char *absolute = realpath(path, NULL);
  struct cb_outside_end end;
  struct left *left;
  if (absolute && strlen(absolute) >= sizeof made.path) {
    free(absolute);
    absolute = NULL, errno = ENAMETOOLONG;
  }
  if (!absolute && errno == ENOMEM) return cb_fail_memory("the library's name");
  if (!absolute) return cb_fail(CB_INPUT, "cannot load '%s': %s", path, strerror(errno));
  strcpy(made.path, absolute);
  free(absolute);
  const struct call call = {.library = &made};
  enum cb_status status = in_child(look_inside, &call, &left, &end);
  if (status) return status;
  memcpy(made.has, left->has, sizeof made.has);
  munmap(left, sizeof *left);
  if (end.how != CB_OUTSIDE_DONE) return cb_fail(CB_INPUT, "'%s': %s", path, end.sentence);
  *library = made;
  return CB_OK;
}

enum cb_status cb_outside_measure(const struct cb_outside *library, const struct cb_frame_set *set,
                                  const struct cb_frame_group *group,
                                  struct cb_frame_result *result, struct cb_outside_end *end) {
  const struct call call = {library, set, group};
  struct left *left;
  enum cb_status status = in_child(measure_inside, &call, &left, end);
  if (status) return status;
  *result = left->result;
  if (end->how != CB_OUTSIDE_DONE) *result = cb_frame_unmeasured(group);
  munmap(left, sizeof *left);
  return CB_OK;
}
