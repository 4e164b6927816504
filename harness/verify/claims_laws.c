/* claims_laws.c - claims that the measured laws decide.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/verify/claim.h"
#include "harness/verify/figure3.h"

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
    cb_claim_say(names, sizeof t.kept_names, "%s%.*s", *names ? ", " : "", length, name);
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

static bool is_elementwise(const struct cb_model *m) { return !m->node_frames; }
static bool is_nodewise(const struct cb_model *m) { return m->node_frames; }
static bool is_qr(const struct cb_model *m) { return starts_with(m->name, "qr-"); }
static bool is_polar_of_f(const struct cb_model *m) {
  return starts_with(m->name, "polar-") && !starts_with(m->name, "polar-edges");
}
static bool is_precomputed(const struct cb_model *m) { return ends_with(m->name, "-precomputed"); }
static bool is_exact(const struct cb_model *m) { return ends_with(m->name, "-exact"); }

/* ---- C3 to C6: laws --------------------------------------------------------- */

enum cb_status cb_claim_order(struct cb_claimant *a) {
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

enum cb_status cb_claim_newton(struct cb_claimant *a) {
  struct tally elements = tally(a->laws, is_elementwise, CB_ISOTROPIC, CB_LAW_NEWTON);
  struct tally nodes = tally(a->laws, is_nodewise, CB_ISOTROPIC, CB_LAW_NEWTON);
  MEASURED(a->claim, "net force at most %.1g in %zu of %zu element-wise models; node-wise %.2g",
           elements.worst_kept, elements.kept, elements.kept + elements.broken, nodes.least_broken);
  VERDICT(a->claim, elements.broken == 0 && nodes.broken > 0 ? "reproduced" : "not reproduced");
  return CB_OK;
}

enum cb_status cb_claim_stale(struct cb_claimant *a) {
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

enum cb_status cb_claim_scaling(struct cb_claimant *a) {
  struct tally iso = tally(a->laws, cb_is_updated, CB_ISOTROPIC, CB_LAW_EULER);
  struct tally ortho = tally(a->laws, cb_is_updated, CB_ORTHOTROPIC, CB_LAW_EULER);
  MEASURED(a->claim, "torque with B over the rest volume at most %.1g in %zu of %zu cases",
           fmax(iso.worst_kept, ortho.worst_kept), iso.kept + ortho.kept,
           iso.kept + ortho.kept + iso.broken + ortho.broken);
  VERDICT(a->claim, iso.broken + ortho.broken == 0 ? "reproduced" : "not reproduced");
  return CB_OK;
}

/* ---- what this project adds -------------------------------------------------- */

enum cb_status cb_claim_exact(struct cb_claimant *a) {
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

enum cb_status cb_claim_leak(struct cb_claimant *a) {
  struct tally iso = tally(a->laws, cb_is_updated, CB_ISOTROPIC, CB_LAW_ENERGY);
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
