/* elastica.h - the slender beam that is held at one end and pushed sideways at the other,
 * however far it bends.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ELASTICA_H
#define CB_ELASTICA_H

#include "kernels/kernel.h"

/* Tip of an inextensible beam of length 1 under alpha = P L^2 / (E I) > 0, P keeping its
 * direction: shortening 1 - x and deflection y. Source: Bisshopp & Drucker 1945, elliptic
 * integrals by GSL. CB_NUMERIC when no root is found (alpha beyond about 1000). */
enum cb_status cb_elastica_tip(double alpha, double *shortening, double *deflection);

#endif
