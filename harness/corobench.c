/* corobench.c - the program: finds the verb, runs it, and is the only place
 * that prints an error and sets the exit status.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <argp.h>
#include <gsl/gsl_errno.h>
#include <string.h>

#include "harness/error.h"
#include "harness/nearest.h"
#include "harness/progress.h"
#include "harness/verbs/verbs.h"

static const struct cb_verb *const verbs[] = {
    &cb_verb_advise,   &cb_verb_trade,    &cb_verb_bench,   &cb_verb_verify, &cb_verb_truth,
    &cb_verb_extremes, &cb_verb_recovery, &cb_verb_frames,  &cb_verb_force,  &cb_verb_ops,
    &cb_verb_scene,    &cb_verb_run,      &cb_verb_machine, &cb_verb_list};
enum { VERBS = sizeof verbs / sizeof *verbs };

static void print_help(FILE *stream) {
  fputs("Usage: corobench VERB [OPTION...]\n"
        "Which corotational finite element kernel is the cheapest that is still right?\n\n",
        stream);
  for (size_t i = 0; i < VERBS; i++)
    fprintf(stream, "  %-8s %s\n", verbs[i]->name, verbs[i]->summary);
  fputs("\n'corobench VERB --help' lists a verb's options.\n"
        "Exit status: 0 done, 1 a checked expectation does not hold, 2 unusable input or another\n"
        "failure (said in one sentence on standard error), 3 nothing meets the needs of a scene,\n"
        "130 interrupted.\n",
        stream);
}

/* argv is the whole command line. */
static enum cb_status run_verb(int argc, char **argv) {
  struct cb_nearest nearest = {.text = argv[1]};
  char name[64];
  for (size_t i = 0; i < VERBS; i++) {
    cb_nearest_offer(&nearest, verbs[i]->name);
    if (strcmp(argv[1], verbs[i]->name) != 0) continue;
    snprintf(name, sizeof name, "corobench %s", verbs[i]->name);
    argv[1] = name; /* what argp's texts call the program */
    return verbs[i]->run(argc - 1, argv + 1);
  }
  return cb_fail(CB_INPUT, "unknown verb '%s' (nearest: %s); see 'corobench --help'", argv[1],
                 nearest.names);
}

static enum cb_status run(int argc, char **argv) {
  if (argc < 2) {
    print_help(stderr);
    return cb_fail(CB_INPUT, "no verb is given; name one of the above");
  }
  if (strcmp(argv[1], "--help") == 0)
    print_help(stdout);
  else if (strcmp(argv[1], "--version") == 0)
    puts(argp_program_version);
  else
    return run_verb(argc, argv);
  return CB_OK;
}

int main(int argc, char **argv) {
  cb_interrupt_install();
  gsl_set_error_handler_off(); /* GSL then reports by status, like everything here */
  enum cb_status status = run(argc, argv);
  if (status == CB_OK) status = cb_stdout_flush();
  if (status != CB_OK) fprintf(stderr, "corobench: %s\n", cb_error_message());
  return cb_exit_status(status);
}
