/* claim.h - private to the claims: what one claim is measured with.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLAIM_H
#define CB_CLAIM_H

#include "harness/verify/claims.h"

struct cb_claimant {
  const struct cb_verification *laws; /* of all models, double precision */
  unsigned long seed;
  struct cb_claim *claim; /* empty texts, to be filled */
};

/* Append to the text of what was measured, or of the verdict. */
#define MEASURED(c, ...) cb_claim_say((c)->measured, sizeof(c)->measured, __VA_ARGS__)
#define VERDICT(c, ...) cb_claim_say((c)->verdict, sizeof(c)->verdict, __VA_ARGS__)
void cb_claim_say(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Sets of models, by name. */
bool cb_is_corotated(const struct cb_model *m);
bool cb_is_updated(const struct cb_model *m); /* over the rest volume */
bool cb_is_volume(const struct cb_model *m);  /* updated over the current one */

/* One function a claim; the list is in claims.c. CB_MEMORY, CB_NUMERIC,
 * CB_BROKEN. */
typedef enum cb_status cb_claim_fn(struct cb_claimant *a);
/* claims_laws.c: judged by the verification */
cb_claim_fn cb_claim_order, cb_claim_newton, cb_claim_stale, cb_claim_scaling, cb_claim_exact,
    cb_claim_leak;
/* claims_shapes.c: measured on shapes of their own */
cb_claim_fn cb_claim_rotation, cb_claim_strain, cb_claim_flat, cb_claim_erratum;
/* claims_counts.c */
cb_claim_fn cb_claim_b_counts, cb_claim_df_counts;
/* claims_recovery.c: inverted elements, let go */
cb_claim_fn cb_claim_sign, cb_claim_vertex;
/* claims_timing.c: on the paper's block */
cb_claim_fn cb_claim_assembly, cb_claim_qr_speed, cb_claim_frames;
/* claims_scenes.c: the scenes of figures 5 and 6 */
cb_claim_fn cb_claim_rabbit, cb_claim_liver;

#endif
