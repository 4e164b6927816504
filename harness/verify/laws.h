/* laws.h - the laws of mechanics that a plausible kernel keeps, each measured as
 * one number per patch: 0 for a kernel that keeps it.
 *   rotation       |f(Q x + t) - Q f(x)| / |f(x)|, and |f(Q X + t)| / |f(x)| at rest
 *   newton         |sum f| / sum |f|
 *   euler          |sum (x - c) x f| / sum |x - c| |f|: the ghost torque
 *   energy         |closed-path work| / work of both signs
 *   order          |f(relabelled vertices) - relabelled f(x)| / |f(x)|
 *   symmetric      |K - K^T| / |K|
 *   semi-definite  most negative eigenvalue of K / largest in size
 *   tangent        |K + df/dx| / |df/dx|, differences in quad precision
 * Warm-started frames come to x from a near shape, as they do in a simulation.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_LAWS_H
#define CB_LAWS_H

#include "harness/verify/patches.h"

struct cb_law_value {
  double median, worst; /* over the patches; NaN if any patch gives NaN */
};

/* Below this a law is kept, above it is broken, NaN is broken: roundoff of the
 * arithmetic times 1e6, which is what rounding may grow to on the worst shaped
 * of the random elements; what breaks a law in fact does so by 1e-6 and more. */
double cb_law_limit(const struct cb_arithmetic *arithmetic);
bool cb_law_kept(double value, double limit);
/* The larger one; NaN if either is, whichever comes first. */
double cb_worst(double a, double b);

/* values[CB_LAWS] of a variant for one material. Energy is measured on the
 * closed paths of the patches, everything else on x. On patches of more than
 * five nodes K is probed by random vectors instead of decomposed, and the
 * tangent along one random direction. CB_MEMORY, CB_INPUT (material not
 * offered), CB_INTERRUPTED. */
enum cb_status cb_laws_measure(const struct cb_variant *variant, const struct cb_material *material,
                               const struct cb_patches *patches, unsigned laws,
                               struct cb_law_value *values);

#endif
