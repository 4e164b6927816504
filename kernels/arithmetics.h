/* arithmetics.h - what each arithmetic's objects export, behind cb_arithmetic.
 * Included by the type-generic sources (which define them, once per arithmetic)
 * and by the registry (which lists them).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ARITHMETICS_H
#define CB_ARITHMETICS_H

#include "kernels/kernel.h"
#include "kernels/pattern.h"

struct cb_element_functions {
  enum cb_status (*create)(const struct cb_variant *, const struct cb_mesh *,
                           const struct cb_material *, double c, struct cb_team *,
                           struct cb_elements **);
  void (*free)(struct cb_elements *);
  void (*reset)(struct cb_elements *);
  void (*tune)(struct cb_elements *, const struct cb_tuning *);
  size_t (*bytes)(const struct cb_elements *);
  double (*visits)(const struct cb_elements *);
  const struct cb_pattern *(*pattern)(const struct cb_elements *);
  void (*blocks)(const struct cb_elements *, double *blocks);
};

/* struct cb_stepper's vectors are the arithmetic's; see kernels/solver/step.c. */
struct cb_step_functions {
  enum cb_status (*create)(struct cb_operator *, const struct cb_step_parameters *,
                           const double *mass, const uint8_t *fixed, size_t nodes,
                           struct cb_stepper **);
  void (*free)(struct cb_stepper *);
  /* One thread's part of each, by all of the operator's team at once: */
  void (*right_side)(struct cb_stepper *, size_t thread, const void *x, const void *v,
                     const void *f_ext);
  void (*solve)(struct cb_stepper *, size_t thread);
  void (*advance)(struct cb_stepper *, size_t thread, void *x, void *v);
};

/* Declares what the objects of one arithmetic define. */
#define CB_DECLARE_ARITHMETIC(A)                                                                   \
  enum cb_status cb_elements_create_##A(const struct cb_variant *, const struct cb_mesh *,         \
                                        const struct cb_material *, double, struct cb_team *,      \
                                        struct cb_elements **);                                    \
  void cb_elements_free_##A(struct cb_elements *);                                                 \
  void cb_elements_reset_##A(struct cb_elements *);                                                \
  void cb_elements_tune_##A(struct cb_elements *, const struct cb_tuning *);                       \
  size_t cb_elements_bytes_##A(const struct cb_elements *);                                        \
  double cb_elements_visits_##A(const struct cb_elements *);                                       \
  const struct cb_pattern *cb_elements_pattern_##A(const struct cb_elements *);                    \
  void cb_elements_blocks_##A(const struct cb_elements *, double *);                               \
  void cb_from_double_##A(size_t, const double *, void *);                                         \
  void cb_to_double_##A(size_t, const void *, double *);                                           \
  extern const struct cb_arithmetic cb_arithmetic_##A;                                             \
  extern const struct cb_step_functions cb_step_##A;

#ifdef CB_SUFFIX
#define CB_DECLARE_ARITHMETIC_(A) CB_DECLARE_ARITHMETIC(A)
CB_DECLARE_ARITHMETIC_(CB_SUFFIX)
#endif

#endif
