/* verb_verify.c - `corobench verify`: laws, operation counts and claims, each
 * against what is expected; exit status 1 when an expectation fails.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/output.h"
#include "harness/measure/environment.h"
#include "harness/progress.h"
#include "harness/verbs/verbs.h"
#include "harness/verify/claims.h"
#include "harness/verify/figure3.h"
#include "harness/verify/opcount.h"

static const char doc[] =
    "Check every model against the laws that it claims to keep, count the operations it executes, "
    "and judge the paper's claims by what is measured. Exit status 1 when a claimed law is broken, "
    "a count that must be exact is not, or something that this project states does not hold."
    "\vWithout --laws, --counts or --claims, all three are done. value is the larger of the worst "
    "of 1000 random elements and the mesh; 'better' marks a law that is kept though not claimed. "
    "With --output the tables are also written there as CSV, with the data of figure 3.";

enum { KEY_LAWS = 1, KEY_COUNTS, KEY_CLAIMS };
static const struct argp_option own_options[] = {
    {"laws", KEY_LAWS, NULL, 0, "Only the laws", 0},
    {"counts", KEY_COUNTS, NULL, 0, "Only the operation counts", 0},
    {"claims", KEY_CLAIMS, NULL, 0, "Only the paper's claims", 0},
    {0}};

struct request {
  struct cb_options options;
  bool laws, counts, claims;
  bool failed;             /* a claimed law, or a claim of ours */
  const char *wrong_count; /* the model whose B is not counted as it must be */
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *r = state->input;
  (void)text;
  switch (key) {
  case KEY_LAWS: r->laws = true; return 0;
  case KEY_COUNTS: r->counts = true; return 0;
  case KEY_CLAIMS: r->claims = true; return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- output ------------------------------------------------------------------ */

/* To stdout, under a title when for people, and to DIR/name.csv. */
static enum cb_status emit(const struct request *r, const char *title, const char *name,
                           const struct cb_table *t) {
  if (!t) return cb_fail_memory("the tables");
  if (r->options.format == CB_TABLE) printf("\n%s\n\n", title);
  enum cb_status status = cb_table_print(t, r->options.format, stdout);
  if (!status && r->options.output) status = cb_output_table(r->options.output, name, t, CB_CSV);
  return status;
}

/* ---- laws -------------------------------------------------------------------- */

/* One variant a model: of the selected ones that of the first arithmetic (f64, if
 * it is among them), ebe before other storages. */
static const struct cb_variant **select_models(const struct cb_options *o, size_t *count) {
  size_t all;
  const struct cb_variant *v = cb_variants(&all), **list = calloc(all + 1, sizeof *list);
  *count = 0;
  for (; list && v->model; v++) {
    if (strcmp(v->arithmetic->name, "counted") == 0 || !cb_options_selects(o, v)) continue;
    size_t i = 0;
    while (i < *count && strcmp(list[i]->model->name, v->model->name) != 0) i++;
    if (i == *count)
      list[(*count)++] = v;
    else if (v->storage == CB_EBE && v->arithmetic == list[i]->arithmetic)
      list[i] = v;
  }
  return list;
}

static struct cb_table *laws_table(const struct cb_verification *v, bool *failed) {
  struct cb_table *t =
      cb_table_create("model,material,law,value,expected,holds,verdict,median,mesh,limit");
  for (size_t i = 0; i < v->count && t; i++) {
    const struct cb_law_row *r = &v->rows[i];
    cb_table_text(t, r->variant->model->name);
    cb_table_text(t, cb_material_name[r->material]);
    cb_table_text(t, cb_law_name[r->law]);
    cb_table_number(t, cb_law_row_value(r));
    cb_table_text(t, r->claimed ? "kept" : "broken");
    cb_table_text(t, r->kept ? "kept" : "broken");
    cb_table_text(t, r->kept == r->claimed ? "ok" : r->kept ? "better" : "FAILS");
    cb_table_number(t, r->random.median);
    cb_table_number(t, r->mesh);
    cb_table_number(t, r->limit);
    if (r->claimed && !r->kept) *failed = true;
  }
  return t;
}

/* For people: one line a model and material, one column a law. */
static enum cb_status print_laws(const struct cb_verification *v) {
  struct cb_table *t = cb_table_create("model,material,rotation,newton,euler,energy,order,"
                                       "symmetric,semi-definite,tangent");
  for (size_t i = 0; i < v->count && t; i++) {
    const struct cb_law_row *r = &v->rows[i];
    char cell[32];
    if (r->law == 0) {
      cb_table_text(t, r->variant->model->name);
      cb_table_text(t, cb_material_name[r->material]);
    }
    snprintf(cell, sizeof cell, "%.0e %s", cb_law_row_value(r),
             r->kept == r->claimed ? (r->kept ? "kept" : "-")
             : r->kept             ? "kept (more than claimed)"
                                   : "FAILS");
    cb_table_text(t, cell);
  }
  if (!t) return cb_fail_memory("the tables");
  printf("\nLaws: worst relative violation over 1000 random elements and a mesh; '-' marks a law "
         "that is broken, as expected\n\n");
  enum cb_status status = cb_table_print(t, CB_TABLE, stdout);
  cb_table_free(t);
  return status;
}

static enum cb_status run_laws(struct request *r, const struct cb_verification *v) {
  struct cb_table *t = laws_table(v, &r->failed);
  enum cb_status status = CB_OK;
  if (r->options.format != CB_TABLE)
    status = emit(r, "", "laws.csv", t);
  else {
    status = t ? print_laws(v) : cb_fail_memory("the tables");
    if (!status && r->options.output)
      status = cb_output_table(r->options.output, "laws.csv", t, CB_CSV);
  }
  cb_table_free(t);
  return status;
}

static enum cb_status measure_laws(const struct request *r, struct cb_verification *v) {
  struct cb_mesh mesh = {0};
  size_t count = 0;
  const struct cb_variant **list = select_models(&r->options, &count);
  enum cb_status status = list ? CB_OK : cb_fail_memory("the verification");
  if (!status && r->options.mesh_path) status = cb_mesh_read(r->options.mesh_path, &mesh, NULL);
  if (!status)
    status =
        cb_verification_run(list, count, r->options.mesh_path ? &mesh : NULL, r->options.seed, v);
  cb_mesh_free(&mesh);
  free(list);
  return status;
}

/* ---- counts ------------------------------------------------------------------ */

static enum cb_status run_counts(struct request *r) {
  struct cb_table *t = cb_table_create(CB_OPS_COLUMNS);
  enum cb_status status = t ? CB_OK : cb_fail_memory("the counts");
  cb_progress_begin("counts", 1);
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    struct cb_operations o[STAGES];
    if (strcmp(v->arithmetic->name, "counted") != 0 || v->storage > CB_EBE) continue;
    cb_progress(0, v->model->name);
    status = cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted while counting")
                              : cb_operations_table(t, v);
    if (status || v->storage != CB_EBE_PAPER) continue;
    status = cb_operations_count(v, o);
    size_t length = strlen(v->model->name);
    bool updated = length > 8 && strcmp(v->model->name + length - 8, "-updated") == 0;
    bool qr = strncmp(v->model->name, "qr-", 3) == 0;
    if (updated && !(o[STAGE_B].mul == (qr ? 14 : 72) && o[STAGE_B].add == (qr ? 5 : 60)))
      r->wrong_count = v->model->name;
  }
  cb_progress_end();
  if (!status)
    status = emit(r,
                  "Operations per tetrahedron, executed ('corobench ops' lists every storage); "
                  "the strain-displacement stage of ebe-paper must be 72+60, or 14+5 for qr",
                  "ops.csv", t);
  cb_table_free(t);
  return status;
}

/* ---- claims ------------------------------------------------------------------ */

/* label and text in lines of at most 100 columns. */
static void print_wrapped(const char *label, const char *text) {
  enum { WIDTH = 100, INDENT = 9 };
  size_t column = INDENT;
  printf("%-*s", INDENT, label);
  while (*text) {
    size_t word = strcspn(text, " ");
    if (column > INDENT && column + 1 + word > WIDTH) {
      printf("\n%*s", INDENT, "");
      column = INDENT;
    } else if (column > INDENT) {
      putchar(' ');
      column++;
    }
    printf("%.*s", (int)word, text);
    column += word;
    text += word;
    text += strspn(text, " ");
  }
  putchar('\n');
}

static enum cb_status print_claims(const struct cb_claim *claims, size_t count) {
  printf("\nClaims: what is claimed, what was measured, the verdict\n");
  for (size_t i = 0; i < count; i++) {
    putchar('\n');
    print_wrapped(claims[i].id, claims[i].paper);
    print_wrapped("measured", claims[i].measured);
    print_wrapped("verdict", claims[i].verdict);
  }
  return CB_OK;
}

static enum cb_status run_claims(struct request *r, const struct cb_verification *laws) {
  struct cb_claim claims[CB_CLAIMS_MOST];
  size_t count = 0;
  enum cb_status status = cb_claims_measure(laws, r->options.seed, claims, &count);
  if (status) return status;
  struct cb_table *t = cb_table_create("claim,paper,measured,verdict");
  for (size_t i = 0; i < count && t; i++) {
    cb_table_text(t, claims[i].id);
    cb_table_text(t, claims[i].paper);
    cb_table_text(t, claims[i].measured);
    cb_table_text(t, claims[i].verdict);
    if (claims[i].failed) r->failed = true;
  }
  if (!t)
    status = cb_fail_memory("the claims");
  else if (r->options.format == CB_TABLE)
    status = print_claims(claims, count);
  else
    status = cb_table_print(t, r->options.format, stdout);
  if (!status && r->options.output)
    status = cb_output_table(r->options.output, "claims.csv", t, CB_CSV);
  cb_table_free(t);
  return status;
}

/* One line for the foot of figure 3: which machine and program. */
/* Figure 3 is drawn from files; without --output there is nobody to draw it. */
static enum cb_status write_figure3(const struct request *r) {
  struct cb_table *t = NULL;
  enum cb_status status = cb_figure3_run(&t);
  if (!status) status = cb_output_table(r->options.output, "figure3.csv", t, CB_CSV);
  if (!status) status = cb_environment_footer(r->options.output, "verify-footer.txt");
  cb_table_free(t);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct request r = {0};
  struct cb_verification laws = {0};
  unsigned mask = CB_OPT_VARIANT | CB_OPT_MESH | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_SEED;
  enum cb_status status =
      cb_options_parse(argc, argv, mask, doc, own_options, parse, &r, &r.options);
  if (status) return status;
  if (r.claims && r.options.glob_count > 0)
    return cb_fail(CB_INPUT, "--claims are about all models; leave --variant out");
  bool all = !r.laws && !r.counts && !r.claims;
  if (r.options.output) status = cb_output_directory(r.options.output);
  if (!status && (all || r.laws || r.claims)) status = measure_laws(&r, &laws);
  if (!status && (all || r.laws)) status = run_laws(&r, &laws);
  if (!status && (all || r.counts)) status = run_counts(&r);
  /* claims are about all models; a selection answers for its laws only */
  bool judged = r.claims || (all && r.options.glob_count == 0);
  if (!status && judged) status = run_claims(&r, &laws);
  if (!status && all && r.options.output) status = write_figure3(&r);
  cb_verification_free(&laws);
  if (!status && r.failed)
    status = cb_fail(CB_BROKEN, "an expectation does not hold: see the laws marked FAILS and the "
                                "verdicts that say 'does not hold' or 'not reproduced'");
  if (!status && r.wrong_count)
    status = cb_fail(CB_BROKEN,
                     "the strain-displacement stage of %s/ebe-paper is not counted as "
                     "72+60, or 14+5 for qr; see the counts",
                     r.wrong_count);
  return status;
}

const struct cb_verb cb_verb_verify = {"verify", "laws, operation counts and the paper's claims",
                                       run};
