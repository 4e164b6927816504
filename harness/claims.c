/* claims.c - the claims about laws and counts. A verdict is computed from the
 * numbers beside it; nothing here knows what it should be.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/claims.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/figure3.h"
#include "harness/mesh.h"
#include "harness/opcount.h"
#include "harness/probe.h"
#include "harness/progress.h"
#include "reference/oracles.h"

struct claimant {
  const struct cb_verification *laws;
  unsigned long seed;
  struct cb_claim *claim;
};

__attribute__((format(printf, 3, 4))) static void say(char *text, size_t size, const char *format,
                                                      ...) {
  size_t used = strlen(text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + used, size - used, format, arguments);
  va_end(arguments);
}
#define MEASURED(c, ...) say((c)->measured, sizeof(c)->measured, __VA_ARGS__)
#define VERDICT(c, ...) say((c)->verdict, sizeof(c)->verdict, __VA_ARGS__)

static bool ends_with(const char *text, const char *end) {
  size_t a = strlen(text), b = strlen(end);
  return a >= b && strcmp(text + a - b, end) == 0;
}

static bool starts_with(const char *text, const char *start) {
  return strncmp(text, start, strlen(start)) == 0;
}

/* What a set of models does with one law. */
struct tally {
  size_t kept, broken;
  double worst_kept, least_broken, most_broken; /* least and most: medians */
  char kept_names[200], broken_names[200];      /* frames, without the policy */
};

typedef bool model_set(const struct cb_model *m);

static struct tally tally(const struct cb_verification *v, model_set *set, int material,
                          enum cb_law law) {
  struct tally t = {.least_broken = INFINITY};
  for (size_t i = 0; i < v->count; i++) {
    const struct cb_law_row *r = &v->rows[i];
    const char *name = r->variant->model->name;
    if (r->material != material || r->law != law || !set(r->variant->model)) continue;
    char *names = r->kept ? t.kept_names : t.broken_names;
    int length = (int)strlen(name);
    static const char *const policies[] = {"-precomputed", "-updated", "-updated-volume"};
    for (int k = 0; k < 3; k++)
      if (ends_with(name, policies[k])) length = (int)(strlen(name) - strlen(policies[k]));
    say(names, sizeof t.kept_names, "%s%.*s", *names ? ", " : "", length, name);
    if (r->kept) {
      t.kept++;
      t.worst_kept = fmax(t.worst_kept, cb_law_row_value(r));
    } else {
      t.broken++;
      t.least_broken = fmin(t.least_broken, r->random.median);
      t.most_broken = fmax(t.most_broken, r->random.median);
    }
  }
  return t;
}

static bool is_corotated(const struct cb_model *m) {
  return !m->node_frames && strcmp(m->name, "linear") != 0 && strcmp(m->name, "green") != 0;
}
static bool is_elementwise(const struct cb_model *m) { return !m->node_frames; }
static bool is_nodewise(const struct cb_model *m) { return m->node_frames; }
static bool is_qr(const struct cb_model *m) { return starts_with(m->name, "qr-"); }
static bool is_polar_of_f(const struct cb_model *m) {
  return starts_with(m->name, "polar-") && !starts_with(m->name, "polar-edges");
}
static bool is_precomputed(const struct cb_model *m) { return ends_with(m->name, "-precomputed"); }
static bool is_updated(const struct cb_model *m) { return ends_with(m->name, "-updated"); }
static bool is_volume(const struct cb_model *m) { return ends_with(m->name, "-updated-volume"); }
static bool is_exact(const struct cb_model *m) { return ends_with(m->name, "-exact"); }

/* ---- C1: rotation ----------------------------------------------------------- */

/* Forces of a model on a block that is rigidly turned by 60 degrees about
 * (1, 1, 1): the largest, and the virial sum x . f / (E V), > 0: it inflates. */
static enum cb_status turned_block(const struct cb_variant *v, double *largest, double *virial) {
  struct cb_mesh mesh = {0};
  struct cb_material m;
  struct cb_probe probe = {0};
  double *x = NULL, *f;
  const double edge = 0.1,
               Q[9] = {2. / 3, -1. / 3, 2. / 3, 2. / 3, 2. / 3, -1. / 3, -1. / 3, 2. / 3, 2. / 3};
  enum cb_status status = cb_mesh_grid(2, 2, 2, edge, &mesh);
  if (!status) status = cb_material_isotropic(1, 0.3, 1, &m);
  if (!status) status = cb_probe_open(v, &mesh, &m, &probe);
  if (status) goto done;
  x = calloc(6 * mesh.nodes, sizeof *x);
  if (!x) {
    status = cb_fail_memory("the claims");
    goto done;
  }
  f = x + 3 * mesh.nodes;
  for (size_t i = 0; i < 3 * mesh.nodes; i++)
    for (size_t k = 0; k < 3; k++) x[i] += Q[3 * (i % 3) + k] * mesh.X[i - i % 3 + k];
  cb_probe_force(&probe, x, f);
  *largest = *virial = 0;
  for (size_t i = 0; i < 3 * mesh.nodes; i++) {
    *largest = cb_worst(*largest, fabs(f[i]) / (edge * edge));
    *virial += x[i] * f[i] / (8 * edge * edge * edge);
  }
done:
  cb_probe_close(&probe);
  cb_mesh_free(&mesh);
  free(x);
  return status;
}

static enum cb_status claim_rotation(struct claimant *a) {
  double linear = NAN, virial = NAN, worst = 0, largest, unused;
  size_t count = 0;
  enum cb_status status = CB_OK;
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    if (v->storage != CB_EBE || strcmp(v->arithmetic->name, "f64") != 0) continue;
    if (strcmp(v->model->name, "linear") == 0) status = turned_block(v, &linear, &virial);
    if (!is_corotated(v->model)) continue;
    status = turned_block(v, &largest, &unused);
    worst = cb_worst(worst, largest);
    count++;
  }
  MEASURED(a->claim,
           "block turned by 60 degrees: linear pushes outwards with %.2g E V (largest node force "
           "%.2g E A); largest force of %zu corotated models %.1g E A",
           virial, linear, count, worst);
  VERDICT(a->claim, virial > 1e-3 && worst <= 1e-10 ? "reproduced" : "not reproduced");
  return status;
}

/* ---- C2: strain ------------------------------------------------------------- */

static double distance_to_identity(const double *R, const double *F, bool symmetric) {
  double E[9], sum = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      E[3 * i + j] = R[i] * F[j] + R[3 + i] * F[3 + j] + R[6 + i] * F[6 + j] - (i == j);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      sum += pow(symmetric ? (E[3 * i + j] + E[3 * j + i]) / 2 : E[3 * i + j], 2);
  return sqrt(sum);
}

static enum cb_status claim_strain(struct claimant *a) {
  enum { SAMPLES = 2000 };
  double ratio[SAMPLES], tensor[SAMPLES];
  size_t higher = 0;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng) return cb_fail_memory("the claims");
  gsl_rng_set(rng, a->seed);
  enum cb_status status = CB_OK;
  for (size_t n = 0; n < SAMPLES && !status; n++) {
    double F[9], Q[9], R[9];
    for (int i = 0; i < 9; i++) F[i] = (i % 4 == 0) + gsl_ran_gaussian(rng, 0.25);
    status = cb_oracle_polar(F, R);
    if (!status) status = cb_oracle_qr(F, Q);
    ratio[n] = distance_to_identity(Q, F, false) / distance_to_identity(R, F, false);
    tensor[n] = distance_to_identity(Q, F, true) / distance_to_identity(R, F, true);
    higher += ratio[n] >= 1;
  }
  gsl_rng_free(rng);
  if (status) return cb_fail(status, "no frame of a random matrix; try another --seed");
  gsl_sort(ratio, 1, SAMPLES);
  gsl_sort(tensor, 1, SAMPLES);
  double median = gsl_stats_median_from_sorted_data(ratio, 1, SAMPLES);
  double median_tensor = gsl_stats_median_from_sorted_data(tensor, 1, SAMPLES);
  MEASURED(a->claim,
           "%d random F: |E - I| of QR over polar: median %.3f, higher in %.1f %%; of the "
           "symmetric strain tensors alone: median %.3f",
           SAMPLES, median, 100.0 * (double)higher / SAMPLES, median_tensor);
  if (median > 1 && median_tensor > 1)
    VERDICT(a->claim, "reproduced");
  else if (median > 1)
    VERDICT(a->claim, "only if the rotation left in E counts as strain");
  else
    VERDICT(a->claim, "not reproduced");
  return CB_OK;
}

/* ---- C3 to C6: laws --------------------------------------------------------- */

static enum cb_status claim_order(struct claimant *a) {
  struct tally qr = tally(a->laws, is_qr, CB_ISOTROPIC, CB_LAW_ORDER);
  struct tally polar = tally(a->laws, is_polar_of_f, CB_ISOTROPIC, CB_LAW_ORDER);
  const struct cb_law_row *edges =
      cb_verification_find(a->laws, "polar-edges-precomputed", CB_ISOTROPIC, CB_LAW_ORDER);
  MEASURED(a->claim,
           "force changes by %.2g (median) when vertices are renumbered: %zu of %zu QR models; at "
           "most %.1g: %zu of %zu polar models",
           qr.least_broken, qr.broken, qr.kept + qr.broken, polar.worst_kept, polar.kept,
           polar.kept + polar.broken);
  if (edges)
    MEASURED(a->claim, "; polar factor of the edges instead of F: %.2g", edges->random.median);
  VERDICT(a->claim, qr.kept || polar.broken ? "not reproduced"
                    : edges && !edges->kept ? "reproduced for the polar factor of F; not for that "
                                              "of the edge matrix"
                                            : "reproduced");
  return CB_OK;
}

static enum cb_status claim_newton(struct claimant *a) {
  struct tally elements = tally(a->laws, is_elementwise, CB_ISOTROPIC, CB_LAW_NEWTON);
  struct tally nodes = tally(a->laws, is_nodewise, CB_ISOTROPIC, CB_LAW_NEWTON);
  MEASURED(a->claim, "net force at most %.1g in %zu of %zu element-wise models; node-wise %.2g",
           elements.worst_kept, elements.kept, elements.kept + elements.broken, nodes.least_broken);
  VERDICT(a->claim, elements.broken == 0 && nodes.broken > 0 ? "reproduced" : "not reproduced");
  return CB_OK;
}

static enum cb_status claim_stale(struct claimant *a) {
  struct tally iso = tally(a->laws, is_precomputed, CB_ISOTROPIC, CB_LAW_EULER);
  struct tally ortho = tally(a->laws, is_precomputed, CB_ORTHOTROPIC, CB_LAW_EULER);
  double angle = NAN;
  enum cb_status status = cb_figure3_angle("qr-precomputed", &angle);
  MEASURED(a->claim, "torque, isotropic: broken by %.1g to %.2g (%s), kept to %.1g (%s); ",
           iso.least_broken, iso.most_broken, iso.broken_names, iso.worst_kept, iso.kept_names);
  MEASURED(a->claim, "orthotropic: broken in %zu of %zu; figure 3: turned by %.0f degrees",
           ortho.broken, ortho.broken + ortho.kept, angle * 180 / M_PI);
  if (iso.kept + ortho.kept == 0)
    VERDICT(a->claim, "reproduced");
  else if (iso.broken + ortho.broken == 0)
    VERDICT(a->claim, "not reproduced");
  else if (ortho.kept == 0)
    VERDICT(a->claim, "only if the material is not isotropic or the frame is not one of: %s",
            iso.kept_names);
  else
    VERDICT(a->claim, "only if the frame is one of: %s", iso.broken_names);
  return status;
}

static enum cb_status claim_scaling(struct claimant *a) {
  struct tally iso = tally(a->laws, is_updated, CB_ISOTROPIC, CB_LAW_EULER);
  struct tally ortho = tally(a->laws, is_updated, CB_ORTHOTROPIC, CB_LAW_EULER);
  MEASURED(a->claim, "torque with B over the rest volume at most %.1g in %zu of %zu cases",
           fmax(iso.worst_kept, ortho.worst_kept), iso.kept + ortho.kept,
           iso.kept + ortho.kept + iso.broken + ortho.broken);
  VERDICT(a->claim, iso.broken + ortho.broken == 0 ? "reproduced" : "not reproduced");
  return CB_OK;
}

/* ---- C7: counts ------------------------------------------------------------- */

static enum cb_status count_paper(const char *model, struct cb_operations *operations) {
  char name[96];
  snprintf(name, sizeof name, "%s/ebe-paper/counted", model);
  const struct cb_variant *v = cb_variant_find(name);
  return v ? cb_operations_count(v, operations)
           : cb_fail(CB_BROKEN, "%s is not in this program", name);
}

static bool counts(const struct cb_operations *o, double mul, double add) {
  return o->mul == mul && o->add == add;
}

static enum cb_status claim_b_counts(struct claimant *a) {
  struct cb_operations qr[STAGES], classic[STAGES];
  enum cb_status status = count_paper("qr-updated", qr);
  if (!status) status = count_paper("polar-higham-updated", classic);
  if (status) return status;
  bool same = counts(&qr[STAGE_B], 14, 5) && counts(&classic[STAGE_B], 72, 60);
  MEASURED(a->claim, "executed: classic %.0f+%.0f, QR %.0f+%.0f", classic[STAGE_B].mul,
           classic[STAGE_B].add, qr[STAGE_B].mul, qr[STAGE_B].add);
  VERDICT(a->claim, same ? "reproduced exactly" : "not reproduced");
  a->claim->failed = !same;
  return CB_OK;
}

static enum cb_status claim_df_counts(struct claimant *a) {
  struct cb_operations qr[STAGES], classic[STAGES];
  enum cb_status status = count_paper("qr-updated", qr);
  if (!status) status = count_paper("polar-higham-updated", classic);
  if (status) return status;
  const struct cb_operations *q = &qr[STAGE_PRODUCT], *c = &classic[STAGE_PRODUCT];
  MEASURED(a->claim,
           "executed in the chain R B^T D B R^T du: classic %.0f+%.0f, QR %.0f+%.0f; QR over "
           "classic %.2f (paper %.2f); dense products R^T, B (6x12), D (6x6), B^T, R as 12x12 and "
           "6x12 matrices would take 144+72+36+72+144 = 468 multiplications",
           c->mul, c->add, q->mul, q->add, (q->mul + q->add) / (c->mul + c->add),
           (4554.0 + 1707) / (6660 + 2760));
  VERDICT(a->claim, counts(c, 6660, 2760) && counts(q, 4554, 1707)
                        ? "reproduced exactly"
                        : "not reproduced: the text does not say what is counted; QR does need "
                          "fewer operations");
  return CB_OK;
}

/* ---- C8: flat elements ------------------------------------------------------ */

/* Largest node force of a model over E A on a unit tetrahedron whose height is
 * that fraction of the rest height, sheared a little. */
static enum cb_status flattened(const struct cb_variant *v, double height, double *force) {
  double X[12] = {0, 0, 0, 1, 0, 0, 0.2, 1, 0, 0.3, 0.3, 1}, x[12], f[12];
  uint32_t tet[4] = {0, 1, 2, 3};
  struct cb_mesh mesh = {4, 1, X, tet, 1};
  struct cb_material m;
  struct cb_probe probe;
  for (int i = 0; i < 12; i++) x[i] = i % 3 == 2 ? height * X[i] : X[i] + 0.1 * X[(i + 4) % 12];
  enum cb_status status = cb_material_isotropic(1, 0.3, 1, &m);
  if (!status) status = cb_probe_open(v, &mesh, &m, &probe);
  if (status) return status;
  cb_probe_force(&probe, x, f);
  cb_probe_close(&probe);
  *force = 0;
  for (int i = 0; i < 12; i++) *force = cb_worst(*force, fabs(f[i]));
  return CB_OK;
}

static enum cb_status claim_flat(struct claimant *a) {
  double worst = 0, least = INFINITY, force;
  size_t finite = 0, count = 0;
  enum cb_status status = CB_OK;
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    if (v->storage != CB_EBE_PAPER || strcmp(v->arithmetic->name, "f64") != 0) continue;
    if (is_updated(v->model)) {
      status = flattened(v, 0, &force);
      count++;
      finite += isfinite(force) != 0;
      if (isfinite(force)) worst = fmax(worst, force);
    } else if (is_volume(v->model)) {
      status = flattened(v, 1e-8, &force);
      if (force < least) least = force; /* infinity and NaN are not small */
    }
  }
  MEASURED(a->claim,
           "height 0: force finite in %zu of %zu models with rest volume, at most %.2g E A; height "
           "1e-8, current volume: at least %.1g E A",
           finite, count, worst, least);
  VERDICT(a->claim, finite == count && worst < 1e3 && least > 1e3 ? "reproduced"
                    : finite > 0                                  ? "only for some frames"
                                                                  : "not reproduced");
  return status;
}

/* ---- the erratum, and what this project adds --------------------------------- */

static enum cb_status claim_erratum(struct claimant *a) {
  const double xb = 1.1, xc = 0.3, yc = 0.9, xd = 0.4, yd = 0.2, zd = 0.8;
  const double first[3] = {-yc * zd, xc * zd - xb * zd, yc * xd - xc * yd + xb * yd - xb * yc};
  const double printed[9] = {yc * zd, xc * zd, yc * xd - xc * yd, 0, zd * xb, -yd * xb,
                             0,       0,       -xb * yc};
  const double right[9] = {yc * zd, -xc * zd, xc * yd - yc * xd, 0, xb * zd, -xb * yd, 0,
                           0,       xb * yc};
  double as_printed = 0, corrected = 0;
  for (int i = 0; i < 3; i++) {
    as_printed = fmax(as_printed, fabs(first[i] + printed[i] + printed[3 + i] + printed[6 + i]));
    corrected = fmax(corrected, fabs(first[i] + right[i] + right[3 + i] + right[6 + i]));
  }
  MEASURED(a->claim, "largest row sum of B: as printed %.2g, with corrected signs %.1g", as_printed,
           corrected);
  VERDICT(a->claim, as_printed > 1e-12 && corrected <= 1e-15
                        ? "gamma_b, delta_b and delta_d are printed with the wrong sign"
                        : "not confirmed");
  return CB_OK;
}

static enum cb_status claim_exact(struct claimant *a) {
  struct tally torque[2], energy[2];
  size_t kept = 0, all = 0;
  double worst = 0;
  for (int m = 0; m < CB_MATERIALS; m++) {
    torque[m] = tally(a->laws, is_exact, m, CB_LAW_EULER);
    energy[m] = tally(a->laws, is_exact, m, CB_LAW_ENERGY);
    kept += torque[m].kept + energy[m].kept;
    all += torque[m].kept + torque[m].broken + energy[m].kept + energy[m].broken;
    worst = fmax(worst, fmax(torque[m].worst_kept, energy[m].worst_kept));
  }
  MEASURED(a->claim, "qr-exact and polar-exact: torque and loop work at most %.1g in %zu of %zu",
           worst, kept, all);
  VERDICT(a->claim, kept == all && all > 0 ? "holds" : "does not hold");
  a->claim->failed = kept != all;
  return CB_OK;
}

static enum cb_status claim_leak(struct claimant *a) {
  struct tally iso = tally(a->laws, is_updated, CB_ISOTROPIC, CB_LAW_ENERGY);
  struct cb_patches p;
  struct cb_material m;
  struct cb_law_value values[CB_LAWS];
  const struct cb_variant *v = cb_variant_find("polar-higham-updated/ebe/f64");
  enum cb_status status = cb_patches_random(200, 1, 0.3, a->seed, &p);
  if (status) return status;
  status = cb_material_isotropic(1000, 1.0 / 3, 1000, &m);
  if (!status) status = cb_laws_measure(v, &m, &p, CB_KEEPS(CB_LAW_ENERGY), values);
  cb_patches_free(&p);
  if (status) return status;
  double third = values[CB_LAW_ENERGY].worst;
  bool theorem = third <= cb_law_limit(v->arithmetic);
  MEASURED(a->claim,
           "loop work %.1g to %.1g of all work (medians, nu = 0.3) in %zu of %zu models; polar at "
           "nu = 1/3: %.1g",
           iso.least_broken, iso.most_broken, iso.broken, iso.broken + iso.kept, third);
  VERDICT(a->claim, iso.kept == 0 && theorem ? "holds" : "does not hold");
  a->claim->failed = iso.kept != 0 || !theorem;
  return CB_OK;
}

/* ---------------------------------------------------------------------------- */

static enum cb_status claim_assembly(struct claimant *a) {
  return cb_claim_assembly(a->seed, a->claim);
}
static enum cb_status claim_speed(struct claimant *a) {
  return cb_claim_qr_speed(a->seed, a->claim);
}

static const struct {
  const char *id, *paper;
  enum cb_status (*measure)(struct claimant *a);
} list[] = {
    {"C1", "linear elements inflate under rotation, corotated ones do not (2.1)", claim_rotation},
    {"C2", "QR strain is a bit higher than polar strain (2.1)", claim_strain},
    {"C3", "QR depends on the vertex order, polar does not (2.1)", claim_order},
    {"C4", "element-wise methods keep Newton's law for any B, node-wise ones do not (2.2)",
     claim_newton},
    {"C5", "a stale B breaks Euler's law (2.3, figure 3)", claim_stale},
    {"C6", "scaling B by a scalar, as the rest volume does, makes no torque (2.3, 3.1)",
     claim_scaling},
    {"C7a", "computing B takes 72+60 operations, in the QR frame 14+5 (3.1)", claim_b_counts},
    {"C7b", "the product df takes 6660+2760 operations, in the QR frame 4554+1707 (3.1)",
     claim_df_counts},
    {"C8", "the rest volume as scale survives null volume (3.1)", claim_flat},
    {"C9", "assembly pays from about 50 iterations on, 3430 tetrahedra (3.2, figure 4)",
     claim_assembly},
    {"C10",
     "QR is about 30 % faster per step than polar, 5 iterations, and stays so (4.2, figure 7)",
     claim_speed},
    {"erratum", "B in the local frame as printed (3.1) sums to zero over the vertices (2.2)",
     claim_erratum},
    {"T1", "ours: the exact gradient needs no updated B: no torque, no energy leak", claim_exact},
    {"T2", "ours: updating B leaks energy, but for polar frames at nu = 1/3", claim_leak},
};

enum cb_status cb_claims_measure(const struct cb_verification *laws, unsigned long seed,
                                 struct cb_claim claims[CB_CLAIMS_MOST], size_t *count) {
  enum { CLAIMS = sizeof list / sizeof *list };
  _Static_assert((int)CLAIMS <= (int)CB_CLAIMS_MOST, "room for every claim");
  enum cb_status status = CB_OK;
  cb_progress_begin("claims", CLAIMS);
  for (size_t i = 0; i < CLAIMS && !status; i++) {
    struct claimant a = {laws, seed, &claims[i]};
    claims[i] = (struct cb_claim){.failed = false};
    snprintf(claims[i].id, sizeof claims[i].id, "%s", list[i].id);
    snprintf(claims[i].paper, sizeof claims[i].paper, "%s", list[i].paper);
    cb_progress((double)i, list[i].id);
    status = cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted while judging the claims")
                              : list[i].measure(&a);
  }
  cb_progress_end();
  if (!status) *count = CLAIMS;
  return status;
}
