/* claims.h - the paper's claims, each measured and judged by the program.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLAIMS_H
#define CB_CLAIMS_H

#include "harness/verify/verification.h"

enum { CB_CLAIMS_MOST = 24 };
struct cb_claim {
  char id[12];         /* C1 ... C15, erratum, and ours: T1 ... */
  char paper[200];     /* what the paper (T: this project) says */
  char measured[3200]; /* the numbers */
  char verdict[200];   /* reproduced / not reproduced / only if ...; for a claim
                          that is exact: exactly */
  bool failed;         /* something this program guarantees does not hold */
};

/* claims[*count] from the laws (all models, double precision) and from what is
 * measured here, timings included. Shows progress. CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_claims_measure(const struct cb_verification *laws, unsigned long seed,
                                 struct cb_claim claims[CB_CLAIMS_MOST], size_t *count);

#endif
