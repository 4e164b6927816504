/* options.c - what the verbs' command lines have in common, through argp.
 * argp's own messages are switched off, as they take several lines and exit;
 * every refusal becomes one recorded sentence.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <fnmatch.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/nearest.h"
#include "harness/verbs/verbs.h"
#include "kernels/team.h"

const char *argp_program_version = "corobench 0.1, commit " CB_COMMIT;

enum {
  KEY_VARIANT = 0x1000, /* no short options */
  KEY_MESH,
  KEY_FORMAT,
  KEY_OUTPUT,
  KEY_SEED,
  KEY_THREADS,
  KEY_HELP,
  KEY_USAGE,
  KEY_VERSION
};

/* A verb takes those whose bit is in its mask, and all of mask 0. */
static const struct {
  unsigned mask;
  struct argp_option option;
} shared[] = {
    {CB_OPT_VARIANT,
     {"variant", KEY_VARIANT, "GLOB", 0,
      "Take the variants model/storage/arithmetic that match, e.g. 'qr-*/ebe/f64'; without a "
      "slash GLOB is held against the model alone; may be repeated",
      1}},
    {CB_OPT_MESH,
     {"mesh", KEY_MESH, "FILE", 0,
      "Tetrahedra from TetGen (.node or .ele) or Gmsh 2.2 or 4.1 ASCII (.msh)", 1}},
    {CB_OPT_FORMAT, {"format", KEY_FORMAT, "FORMAT", 0, "table (default), csv or json", 1}},
    {CB_OPT_OUTPUT, {"output", KEY_OUTPUT, "DIR", 0, "Directory to write to, made if missing", 1}},
    {CB_OPT_SEED, {"seed", KEY_SEED, "N", 0, "Seed of everything random (default 2005)", 1}},
    {CB_OPT_THREADS,
     {"threads", KEY_THREADS, "N", 0,
      "Threads of the kernels, 1 to 64, each on a processor of its own; a list like 1,2 or "
      "repeated: one after the other",
      1}},
    {0, {"help", KEY_HELP, NULL, 0, "Show this text", -1}},
    {0, {"usage", KEY_USAGE, NULL, 0, "Show the options in short", -1}},
    {0, {"version", KEY_VERSION, NULL, 0, "Show version and commit", -1}}};
enum { SHARED = sizeof shared / sizeof *shared };

struct parse {
  struct cb_options options;
  void *input; /* of the verb's parser */
  const struct argp_option *own;
  struct argp_option taken[SHARED + 1];
  const struct argp *root;
  bool scene; /* is one expected? */
};

static error_t to_argp(enum cb_status status) { return status == CB_OK ? 0 : EINVAL; }

enum cb_status cb_stdout_flush(void) {
  errno = 0;
  if (fflush(stdout) == 0 && !ferror(stdout)) return CB_OK;
  return cb_fail(CB_IO, "cannot write to standard output: %s",
                 errno ? strerror(errno) : "an earlier write failed");
}

static error_t show_and_exit(const struct parse *p, int key, char *name) {
  if (key == KEY_VERSION)
    puts(argp_program_version);
  else if (key == KEY_USAGE)
    argp_help(p->root, stdout, ARGP_HELP_USAGE, name);
  else
    argp_help(p->root, stdout, ARGP_HELP_SHORT_USAGE | ARGP_HELP_LONG | ARGP_HELP_DOC, name);
  if (cb_stdout_flush() == CB_OK) exit(EXIT_SUCCESS);
  return EINVAL;
}

static enum cb_status take_format(const char *text, enum cb_format *format) {
  static const char *const names[] = {"table", "csv", "json"};
  static const enum cb_format formats[] = {CB_TABLE, CB_CSV, CB_JSON};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(text, names[i]) == 0) {
      *format = formats[i];
      return CB_OK;
    }
  return cb_fail(CB_INPUT, "--format needs table, csv or json, not '%s'", text);
}

static enum cb_status take_glob(const char *text, struct cb_options *o) {
  size_t most = sizeof o->globs / sizeof *o->globs;
  if (o->glob_count == most)
    return cb_fail(CB_INPUT, "--variant is given more than %zu times; use wider globs", most);
  o->globs[o->glob_count++] = text;
  return CB_OK;
}

static void add_threads(size_t n, struct cb_threads *threads) {
  for (size_t i = 0; i < threads->count; i++)
    if (threads->of[i] == n) return;
  threads->of[threads->count++] = n; /* of 1 to 64, each once: there is room */
}

static enum cb_status take_threads(const char *text, struct cb_threads *threads) {
  const char *rest = text;
  do {
    char piece[32];
    unsigned long n;
    const size_t length = strcspn(rest, ",");
    snprintf(piece, sizeof piece, "%.*s", (int)(length < sizeof piece ? length : sizeof piece),
             rest);
    enum cb_status status = cb_parse_count("--threads", piece, 1, CB_TEAM_MOST, &n);
    if (status) return status;
    add_threads(n, threads);
    rest += length;
  } while (*rest++);
  return CB_OK;
}

static error_t parse_shared(int key, char *text, struct argp_state *state) {
  struct parse *p = state->input;
  struct cb_options *o = &p->options;
  switch (key) {
  case KEY_VARIANT: return to_argp(take_glob(text, o));
  case KEY_MESH: o->mesh_path = text; return 0;
  case KEY_FORMAT: return to_argp(take_format(text, &o->format));
  case KEY_OUTPUT: o->output = text; return 0;
  case KEY_THREADS: return to_argp(take_threads(text, &o->threads));
  case KEY_SEED: return to_argp(cb_parse_count("--seed", text, 0, ULONG_MAX, &o->seed));
  case KEY_HELP:
  case KEY_USAGE:
  case KEY_VERSION: return show_and_exit(p, key, state->name);
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* The option that `name` stands for: its name or the beginning of only one. */
static const struct argp_option *find_option(const struct parse *p, const char *name,
                                             struct cb_nearest *nearest) {
  const struct argp_option *const tables[] = {p->own, p->taken}, *found = NULL;
  size_t matches = 0;
  for (size_t t = 0; t < 2; t++)
    for (const struct argp_option *o = tables[t]; o && (o->name || o->key || o->doc); o++) {
      if (!o->name) continue;
      if (strcmp(o->name, name) == 0) return o;
      cb_nearest_offer(nearest, o->name);
      if (strncmp(o->name, name, strlen(name)) == 0) {
        found = o;
        matches++;
      }
    }
  return matches == 1 ? found : NULL;
}

/* getopt said no, silently: find the word that it stopped at and say why. */
static enum cb_status explain(const struct parse *p, const struct argp_state *state) {
  char name[64];
  const char *word = state->argv[state->next - 1];
  if (word[0] != '-' && state->next < state->argc) word = state->argv[state->next];
  if (strncmp(word, "--", 2) != 0)
    return cb_fail(CB_INPUT, "unknown option '%s': options begin with two dashes; see '%s --help'",
                   word, state->name);
  snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
  struct cb_nearest nearest = {.text = name};
  const struct argp_option *option = find_option(p, name, &nearest);
  if (!option)
    return cb_fail(CB_INPUT, "unknown option '--%s' (nearest: %s); see '%s --help'", name,
                   nearest.names, state->name);
  if (!option->arg) return cb_fail(CB_INPUT, "option '--%s' takes no value", option->name);
  return cb_fail(CB_INPUT, "option '--%s' needs a value, %s; see '%s --help'", option->name,
                 option->arg, state->name);
}

static error_t parse_root(int key, char *text, struct argp_state *state) {
  struct parse *p = state->input;
  switch (key) {
  case ARGP_KEY_INIT:
    state->child_inputs[0] = p;
    if (state->root_argp->children[1].argp) state->child_inputs[1] = p->input;
    return 0;
  case ARGP_KEY_ARG:
    if (p->scene && !p->options.scene_path) {
      p->options.scene_path = text;
      return 0;
    }
    return to_argp(cb_fail(CB_INPUT,
                           "unexpected word '%s': options begin with two dashes; see "
                           "'%s --help'",
                           text, state->name));
  case ARGP_KEY_ERROR:
    if (cb_error_message()[0] == '\0') explain(p, state);
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static bool glob_selects(const char *glob, const struct cb_variant *v) {
  char name[96];
  if (!strchr(glob, '/')) return fnmatch(glob, v->model->name, 0) == 0;
  cb_variant_name(v, name);
  return fnmatch(glob, name, 0) == 0;
}

static enum cb_status check_glob(const char *glob) {
  struct cb_nearest nearest = {.text = glob};
  char name[96];
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    if (glob_selects(glob, v)) return CB_OK;
    cb_variant_name(v, name);
    cb_nearest_offer(&nearest, strchr(glob, '/') ? name : v->model->name);
  }
  return cb_fail(CB_INPUT, "no variant matches '%s' (nearest: %s); 'corobench list' shows all",
                 glob, nearest.names);
}

bool cb_options_selects(const struct cb_options *o, const struct cb_variant *v) {
  for (size_t i = 0; i < o->glob_count; i++)
    if (glob_selects(o->globs[i], v)) return true;
  return o->glob_count == 0;
}

enum cb_status cb_options_parse(int argc, char **argv, unsigned mask, const char *doc,
                                const struct argp_option *options, argp_parser_t parser,
                                void *input, struct cb_options *o) {
  struct parse p = {.options = {.format = CB_TABLE, .seed = 2005}, .input = input, .own = options};
  struct argp common = {.options = p.taken, .parser = parse_shared};
  struct argp verb = {.options = options, .parser = parser};
  struct argp_child children[] = {{&common, 0, NULL, 0}, {parser ? &verb : NULL, 0, NULL, 0}, {0}};
  struct argp root = {.parser = parse_root,
                      .args_doc = mask & CB_OPT_SCENE ? "SCENE" : NULL,
                      .doc = doc,
                      .children = children};
  p.root = &root, p.scene = mask & CB_OPT_SCENE;
  for (size_t i = 0, n = 0; i < SHARED; i++)
    if (!shared[i].mask || (shared[i].mask & mask)) p.taken[n++] = shared[i].option;

  cb_fail(CB_INPUT, "%s", ""); /* so that explain() can tell whether a parser spoke */
  error_t error =
      argp_parse(&root, argc, argv, ARGP_NO_HELP | ARGP_NO_ERRS | ARGP_NO_EXIT, NULL, &p);
  if (error == ENOMEM) return cb_fail_memory("the command line");
  if (error) return CB_INPUT;
  for (size_t i = 0; i < p.options.glob_count; i++)
    if (check_glob(p.options.globs[i]) != CB_OK) return CB_INPUT;
  if (p.scene && !p.options.scene_path)
    return cb_fail(CB_INPUT,
                   "no scene is given: name a file, e.g. scenes/block.json; see '%s --help'",
                   argv[0]);
  *o = p.options;
  return CB_OK;
}

enum cb_status cb_parse_number(const char *option, const char *text, double low, double high,
                               double *value) {
  char *end;
  double number = strtod(text, &end);
  bool whole = *text && !isspace((unsigned char)*text) && !*end;
  if (whole && number >= low && number <= high && number >= -DBL_MAX && number <= DBL_MAX) {
    *value = number;
    return CB_OK;
  }
  if (low <= -DBL_MAX && high >= DBL_MAX)
    return cb_fail(CB_INPUT, "%s needs a finite number, not '%s'", option, text);
  if (high >= DBL_MAX)
    return cb_fail(CB_INPUT, "%s needs a finite number of at least %g, not '%s'", option, low,
                   text);
  return cb_fail(CB_INPUT, "%s needs a number from %g to %g, not '%s'", option, low, high, text);
}

enum cb_status cb_parse_count(const char *option, const char *text, unsigned long low,
                              unsigned long high, unsigned long *value) {
  char *end;
  errno = 0;
  unsigned long number = strtoul(text, &end, 10);
  /* strtoul accepts signs and spaces. */
  if (isdigit((unsigned char)*text) && !*end && !errno && number >= low && number <= high) {
    *value = number;
    return CB_OK;
  }
  return cb_fail(CB_INPUT, "%s needs a whole number from %lu to %lu, not '%s'", option, low, high,
                 text);
}
