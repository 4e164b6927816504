/* forms.h - from element functions to the functions of a cb_form. Given inline
 * element functions ID_ebe_TAG, ID_ebe_product_TAG, ID_paper_TAG,
 * ID_paper_product_TAG and ID_blocks_TAG, these macros instantiate the loops of
 * each storage and name them in a descriptor.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FORMS_H
#define CB_FORMS_H

#include "kernels/storage/blocks.h"
#include "kernels/storage/cluster.h"
#include "kernels/storage/paper.h"
#include "kernels/storage/products.h"

#define UPDATE_FUNCTION(NAME, CALL)                                                                \
  static void NAME(struct cb_elements *E, size_t thread, const void *x, const void *v, double h,   \
                   void *out) {                                                                    \
    CALL;                                                                                          \
  }
#define PRODUCT_FUNCTION(NAME, CALL)                                                               \
  static void NAME(const struct cb_elements *E, size_t thread, const void *u, void *y) { CALL; }

#define STORAGE_EBE(ID, TAG)                                                                       \
  UPDATE_FUNCTION(ID##_ebe_update_##TAG, drive_update(E, thread, x, v, h, out, ID##_ebe_##TAG))
/* ... in clusters, whether the state or the positions are kept; DRIVE:
 * update_clusters_quickly or update_clusters, functions inlined, or
 * drive_update_clusters, function called; of the product:
 * product_clusters_of_model or drive_product_clusters. */
#define STORAGE_CLUSTER(ID, TAG, DRIVE, ...)                                                       \
  UPDATE_FUNCTION(ID##_cluster_update_##TAG, DRIVE(E, thread, x, v, h, out, __VA_ARGS__))
#define STORAGE_CLUSTER_PRODUCT(ID, TAG, DRIVE)                                                    \
  PRODUCT_FUNCTION(ID##_cluster_run_##TAG, DRIVE(E, thread, u, y, ID##_ebe_product_##TAG))
/* ... and its product, unless it is cb_product_gradients. */
#define STORAGE_EBE_PRODUCT(ID, TAG)                                                               \
  PRODUCT_FUNCTION(ID##_ebe_run_##TAG, drive_product(E, thread, u, y, ID##_ebe_product_##TAG))
#define STORAGE_PAPER(ID, TAG)                                                                     \
  UPDATE_FUNCTION(ID##_paper_update_##TAG,                                                         \
                  drive_update(E, thread, x, v, h, out, ID##_paper_##TAG))                         \
  PRODUCT_FUNCTION(ID##_paper_run_##TAG,                                                           \
                   drive_product_nodes(E, thread, u, y, ID##_paper_product_##TAG))
/* PRODUCTS: blocks come as edge products. */
#define STORAGE_BLOCKS(ID, TAG, PRODUCTS)                                                          \
  UPDATE_FUNCTION(ID##_matrix_update_##TAG,                                                        \
                  drive_update_matrix(E, thread, x, v, h, out, ID##_blocks_##TAG, PRODUCTS))
/* TERMS: TERMS_GRADIENTS or TERMS_BLOCKS, what the element function FN makes. */
#define STORAGE_ASSEMBLED(ID, TAG, FN, TERMS)                                                      \
  UPDATE_FUNCTION(ID##_assembled_update_##TAG,                                                     \
                  drive_update_assembled(E, thread, x, v, h, out, FN, (TERMS) == TERMS_GRADIENTS))

#define FORM_EBE(ID, TAG, NUMBERS)                                                                 \
  { ID##_ebe_update_##TAG, ID##_ebe_run_##TAG, NUMBERS }
#define FORM_EBE_SHARED(ID, TAG, NUMBERS)                                                          \
  { ID##_ebe_update_##TAG, CB_NAME(cb_product_gradients), NUMBERS }
#define FORM_CLUSTER(ID, TAG, NUMBERS)                                                             \
  { ID##_cluster_update_##TAG, ID##_cluster_run_##TAG, NUMBERS }
#define FORM_CLUSTER_SHARED(ID, TAG)                                                               \
  { ID##_cluster_update_##TAG, CB_NAME(cb_product_cluster_gradients), 9 }
#define FORM_PAPER(ID, TAG, NUMBERS)                                                               \
  { ID##_paper_update_##TAG, ID##_paper_run_##TAG, NUMBERS }
#define FORM_MATRIX(ID, TAG)                                                                       \
  { ID##_matrix_update_##TAG, CB_NAME(cb_product_matrix), 54 }
/* The assembled storages; ISO, ORTHO: TERMS_*. */
#define FORMS_ASSEMBLED(ID, PRODUCT, ISO, ORTHO)                                                   \
  {                                                                                                \
    {ID##_assembled_update_iso, CB_NAME(PRODUCT), ISO}, {                                          \
      ID##_assembled_update_ortho, CB_NAME(PRODUCT), ORTHO                                         \
    }                                                                                              \
  }
#define FORMS_CSR(ID, ISO, ORTHO) FORMS_ASSEMBLED(ID, cb_product_csr, ISO, ORTHO)
#define FORMS_BCSR(ID, ISO, ORTHO) FORMS_ASSEMBLED(ID, cb_product_bcsr, ISO, ORTHO)
#define FORMS_BCSR_SYMMETRIC(ID, ISO, ORTHO)                                                       \
  FORMS_ASSEMBLED(ID, cb_product_bcsr_symmetric, ISO, ORTHO)

#endif
