/* linear.c - small displacements: R = I, constant stiffness matrix.
 * Source: Zienkiewicz & Cheung 1967; the method that corotation repairs.
 * Trade:  nothing is computed per step but K u; a turned element inflates.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#define SPARSE 0
#define NO_FRAME 1
#define FRAME_ROTATION(e, F, memory, R) identity3(R)
#include "kernels/models/corotated.h"

COROTATED_FORM(linear, POLICY_PRECOMPUTED, 0, 0, iso)
COROTATED_FORM(linear, POLICY_PRECOMPUTED, 0, 1, ortho)
COROTATED_PRODUCT(linear, POLICY_PRECOMPUTED, ortho)

static void assembled(struct cb_elements *E, size_t thread) {
  cb_team_barrier(E->team, thread);
  if (thread == 0) E->assembled = true;
}

/* The matrix is assembled once; afterwards only the force pass is left. */
#define ASSEMBLED_ONCE(NAME, FULL, FORCE)                                                          \
  UPDATE_FUNCTION(                                                                                 \
      NAME, if (E->assembled) FORCE(E, thread, x, v, h, out); else {                               \
        FULL(E, thread, x, v, h, out);                                                             \
        assembled(E, thread);                                                                      \
      })
ASSEMBLED_ONCE(linear_once_assembled_update_iso, linear_assembled_update_iso, linear_ebe_update_iso)
ASSEMBLED_ONCE(linear_once_assembled_update_ortho, linear_assembled_update_ortho,
               linear_ebe_update_ortho)
ASSEMBLED_ONCE(linear_matrix_once_iso, linear_matrix_update_iso, linear_ebe_update_iso)
ASSEMBLED_ONCE(linear_matrix_once_ortho, linear_matrix_update_ortho, linear_ebe_update_ortho)

#define LINEAR_LAWS                                                                                \
  (CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_ENERGY) | CB_KEEPS(CB_LAW_ORDER) |                    \
   CB_KEEPS(CB_LAW_SYMMETRIC) | CB_KEEPS(CB_LAW_SEMIDEFINITE) | CB_KEEPS(CB_LAW_TANGENT))

const struct cb_model CB_NAME(cb_model_linear) = {
    .name = "linear",
    .summary = "small displacements, constant matrix, no frame",
    .source = "Zienkiewicz & Cheung 1967",
    .laws = {LINEAR_LAWS, LINEAR_LAWS},
    .policy = POLICY_PRECOMPUTED,
    .keeps_rest = true,
    .form = {
        [CB_EBE] = {{linear_ebe_update_iso, CB_NAME(cb_product_rest), 0},
                    FORM_EBE(linear, ortho, 0)},
        [CB_EBE_CLUSTER] = {{linear_cluster_update_iso, CB_NAME(cb_product_cluster_rest), 0},
                            FORM_CLUSTER(linear, ortho, 0)},
        [CB_EBE_MATRIX] = {{linear_matrix_once_iso, CB_NAME(cb_product_matrix), 54},
                           {linear_matrix_once_ortho, CB_NAME(cb_product_matrix), 54}},
        [CB_CSR] = FORMS_CSR(linear_once, TERMS_GRADIENTS, TERMS_BLOCKS),
        [CB_BCSR] = FORMS_BCSR(linear_once, TERMS_GRADIENTS, TERMS_BLOCKS),
        [CB_BCSR_SYMMETRIC] = FORMS_BCSR_SYMMETRIC(linear_once, TERMS_GRADIENTS, TERMS_BLOCKS)}};
