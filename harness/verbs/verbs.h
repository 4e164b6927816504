/* verbs.h - the command line: `corobench VERB [OPTION...]`, one file per verb
 * (harness/verb_NAME.c). A verb parses its options, calls the rest of the
 * program and prints; it decides nothing else.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_VERBS_H
#define CB_VERBS_H

#include "harness/files/table.h"

struct cb_verb {
  const char *name, *summary;
  enum cb_status (*run)(int argc, char **argv); /* argv[0] = "corobench NAME" */
};
extern const struct cb_verb cb_verb_list, cb_verb_verify, cb_verb_ops, cb_verb_force, cb_verb_bench,
    cb_verb_machine, cb_verb_scene, cb_verb_advise, cb_verb_trade, cb_verb_truth, cb_verb_run,
    cb_verb_extremes, cb_verb_frames, cb_verb_recovery;

/* Options that several verbs share; a verb takes those of its mask. */
enum {
  CB_OPT_VARIANT = 1,  /* --variant GLOB, repeatable: on model/storage/arithmetic; a glob without
                          a slash is held against the model alone */
  CB_OPT_MESH = 2,     /* --mesh FILE */
  CB_OPT_FORMAT = 4,   /* --format table|csv|json */
  CB_OPT_OUTPUT = 8,   /* --output DIR */
  CB_OPT_SEED = 16,    /* --seed N, default 2005 */
  CB_OPT_THREADS = 32, /* --threads N[,N...], repeatable */
  CB_OPT_SCENE = 64    /* SCENE, the one word that is no option; must be there */
};
/* Numbers of threads, each once, in the order given. */
struct cb_threads {
  size_t count, of[64];
};
struct cb_options {
  const char *globs[64];
  size_t glob_count;
  const char *mesh_path, *output, *scene_path;
  enum cb_format format;
  unsigned long seed;
  struct cb_threads threads; /* count 0: not given */
};

#include <argp.h>
/* Parse argv by argp (--help, --usage, --version come with it): the shared
 * options of mask into *o, the verb's own through its `options` and `parser`
 * (NULL: none), called with `state->input == input`. Bad usage: CB_INPUT,
 * recorded, never exit(); --help, --usage and --version print and exit 0.
 * A glob that selects nothing is CB_INPUT and names the close matches. *o is
 * untouched on failure; its texts are argv's own. The verb's
 * parser does not see words that are not options: there are none but SCENE. */
enum cb_status cb_options_parse(int argc, char **argv, unsigned mask, const char *doc,
                                const struct argp_option *options, argp_parser_t parser,
                                void *input, struct cb_options *o);
/* Is the variant selected (no glob: everything is)? */
bool cb_options_selects(const struct cb_options *o, const struct cb_variant *v);

/* A number from an option's text, finite and in [low, high]; else CB_INPUT with
 * the option's name, what was given and the range. */
enum cb_status cb_parse_number(const char *option, const char *text, double low, double high,
                               double *value);
/* A whole number in [low, high], likewise; digits only. */
enum cb_status cb_parse_count(const char *option, const char *text, unsigned long low,
                              unsigned long high, unsigned long *value);

/* Flush standard output: CB_IO, recorded, if anything written there was lost. */
enum cb_status cb_stdout_flush(void);

#endif
