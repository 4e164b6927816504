/* claims.c - the list of claims, and what their files share. A verdict is
 * computed from the numbers beside it; nothing here knows what it should be.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/verify/claim.h"

void cb_claim_say(char *text, size_t size, const char *format, ...) {
  size_t used = strlen(text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + used, size - used, format, arguments);
  va_end(arguments);
}

static bool ends_with(const char *text, const char *end) {
  size_t a = strlen(text), b = strlen(end);
  return a >= b && strcmp(text + a - b, end) == 0;
}

bool cb_is_corotated(const struct cb_model *m) {
  return !m->node_frames && strcmp(m->name, "linear") != 0 && strcmp(m->name, "green") != 0;
}
bool cb_is_updated(const struct cb_model *m) { return ends_with(m->name, "-updated"); }
bool cb_is_volume(const struct cb_model *m) { return ends_with(m->name, "-updated-volume"); }

static const struct {
  const char *id, *paper;
  cb_claim_fn *measure;
} list[] = {
    {"C1", "linear elements inflate under rotation, corotated ones do not (2.1)",
     cb_claim_rotation},
    {"C2", "QR strain is a bit higher than polar strain (2.1)", cb_claim_strain},
    {"C3", "QR depends on the vertex order, polar does not (2.1)", cb_claim_order},
    {"C4", "element-wise methods keep Newton's law for any B, node-wise ones do not (2.2)",
     cb_claim_newton},
    {"C5", "a stale B breaks Euler's law (2.3, figure 3)", cb_claim_stale},
    {"C6", "scaling B by a scalar, as the rest volume does, makes no torque (2.3, 3.1)",
     cb_claim_scaling},
    {"C7a", "computing B takes 72+60 operations, in the QR frame 14+5 (3.1)", cb_claim_b_counts},
    {"C7b", "the product df takes 6660+2760 operations, in the QR frame 4554+1707 (3.1)",
     cb_claim_df_counts},
    {"C8", "the rest volume as scale survives null volume (3.1)", cb_claim_flat},
    {"C9", "assembly pays from about 50 iterations on, 3430 tetrahedra (3.2, figure 4)",
     cb_claim_assembly},
    {"C10",
     "QR is about 30 % faster per step than polar, 5 iterations, and stays so (4.2, figure 7)",
     cb_claim_qr_speed},
    {"C11",
     "polar without sign handling converges to the mirrored shape, a flip cures it, SVD is dearer "
     "(4.1)",
     cb_claim_sign},
    {"C12",
     "inversion by vertex d is plausible under QR, by another it recovers by a large rotation "
     "(4.1)",
     cb_claim_vertex},
    {"C13",
     "a rabbit crushed at zero stiffness regains its shape when it is raised (4.1, figure 5)",
     cb_claim_rabbit},
    {"C14", "a liver yanked until elements invert stays stable and recovers (4.1, figure 6)",
     cb_claim_liver},
    {"C15", "30 frames a second with 2000 to 3000 tetrahedra, display included (4.2)",
     cb_claim_frames},
    {"erratum", "B in the local frame as printed (3.1) sums to zero over the vertices (2.2)",
     cb_claim_erratum},
    {"T1", "ours: the exact gradient needs no updated B: no torque, no energy leak",
     cb_claim_exact},
    {"T2", "ours: updating B leaks energy, but for polar frames at nu = 1/3", cb_claim_leak},
};

enum cb_status cb_claims_measure(const struct cb_verification *laws, unsigned long seed,
                                 struct cb_claim claims[CB_CLAIMS_MOST], size_t *count) {
  enum { CLAIMS = sizeof list / sizeof *list };
  _Static_assert((int)CLAIMS <= (int)CB_CLAIMS_MOST, "room for every claim");
  enum cb_status status = CB_OK;
  cb_progress_begin("claims", CLAIMS);
  for (size_t i = 0; i < CLAIMS && !status; i++) {
    struct cb_claimant a = {laws, seed, &claims[i]};
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
