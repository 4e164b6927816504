/* claims_counts.c - claims about numbers of operations.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>

#include "harness/error.h"
#include "harness/verify/claim.h"
#include "harness/verify/opcount.h"

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

enum cb_status cb_claim_b_counts(struct cb_claimant *a) {
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

enum cb_status cb_claim_df_counts(struct cb_claimant *a) {
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
  bool same = counts(c, 6660, 2760) && counts(q, 4554, 1707);
  VERDICT(a->claim, "%s; QR needs %s operations than the classic B",
          same ? "reproduced exactly" : "not reproduced: the text does not say what is counted",
          q->mul + q->add < c->mul + c->add ? "fewer" : "no fewer");
  return CB_OK;
}
