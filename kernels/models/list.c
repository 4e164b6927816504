/* list.c - the models of one arithmetic, in the order of every table. A new
 * model is a file here and a line below.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/arithmetic.h"
#include "kernels/arithmetics.h"

#define FAMILY(X, stem) X(stem##_precomputed) X(stem##_updated) X(stem##_updated_volume)
#define MODELS(X)                                                                                  \
  X(linear)                                                                                        \
  X(green)                                                                                         \
  X(node_warp)                                                                                     \
  FAMILY(X, qr)                                                                                    \
  X(qr_exact)                                                                                      \
  FAMILY(X, polar_higham)                                                                          \
  FAMILY(X, polar_closed)                                                                          \
  FAMILY(X, polar_eigen)                                                                           \
  FAMILY(X, polar_quaternion)                                                                      \
  FAMILY(X, polar_edges)                                                                           \
  FAMILY(X, polar_reflected)                                                                       \
  X(polar_higham_tuned)                                                                            \
  X(polar_quaternion_tuned)                                                                        \
  X(qr_lazy)                                                                                       \
  X(polar_closed_lazy)                                                                             \
  X(polar_exact)                                                                                   \
  X(polar_tangent)                                                                                 \
  X(polar_tangent_clamped)                                                                         \
  FAMILY(X, svd)

#define DECLARE(stem) extern const struct cb_model CB_NAME(cb_model_##stem);
#define LIST(stem) &CB_NAME(cb_model_##stem),
MODELS(DECLARE)
static const struct cb_model *const models[] = {MODELS(LIST) NULL};

static const struct cb_element_functions elements = {
    CB_NAME(cb_elements_create),  CB_NAME(cb_elements_free),  CB_NAME(cb_elements_reset),
    CB_NAME(cb_elements_tune),    CB_NAME(cb_elements_bytes), CB_NAME(cb_elements_visits),
    CB_NAME(cb_elements_pattern), CB_NAME(cb_elements_blocks)};

#ifndef CB_NEEDS
#define CB_NEEDS ""
#endif
#ifndef CB_FLAGS
#define CB_FLAGS ""
#endif
#ifdef CB_COUNTED
#define ROUNDOFF 0x1p-113
#else
#define ROUNDOFF (sizeof(S) == sizeof(float) ? 0x1p-24 : 0x1p-53)
#endif

const struct cb_arithmetic CB_NAME(cb_arithmetic) = {
    .name = CB_STRING(CB_SUFFIX),
    .needs = CB_NEEDS,
    .flags = CB_FLAGS,
    .scalar_bytes = sizeof(S),
    .lanes = LANES,
    .stride = STRIDE,
    .roundoff = ROUNDOFF,
    .models = models,
    .from_double = CB_NAME(cb_from_double),
    .to_double = CB_NAME(cb_to_double),
    .elements = &elements,
    .step = &CB_NAME(cb_step),
};
