/* products.h - stiffness products that every model shares.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PRODUCTS_H
#define CB_PRODUCTS_H

#include "kernels/elements.h"

/* All are cb_product_fn. ebe, isotropic: state = nine world gradients. */
void CB_NAME(cb_product_gradients)(const struct cb_elements *E, size_t thread, const void *u,
                                   void *y);
/* ... without a frame: the gradients are those of the rest data. */
void CB_NAME(cb_product_rest)(const struct cb_elements *E, size_t thread, const void *u, void *y);
/* ebe-matrix: state = six blocks. */
void CB_NAME(cb_product_matrix)(const struct cb_elements *E, size_t thread, const void *u, void *y);
/* assembled: values */
void CB_NAME(cb_product_csr)(const struct cb_elements *E, size_t thread, const void *u, void *y);
void CB_NAME(cb_product_bcsr)(const struct cb_elements *E, size_t thread, const void *u, void *y);
void CB_NAME(cb_product_bcsr_symmetric)(const struct cb_elements *E, size_t thread, const void *u,
                                        void *y);

#endif
