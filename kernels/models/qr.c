/* qr.c - frame by Gram-Schmidt on the current edges, B triangular in it; and
 * qr-exact, the true gradient of the same energy with the same rest B.
 * Source: Nesme, Payan, Faure 2005, sections 2.1, 3.1.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/models/qr_element.h"

#define SPARSE 1
#define NO_FRAME 0
#define FRAME_PACK qr_pack
#define FRAME_WORLD qr_world
#define ANY_PACK qr_pack
#include "kernels/models/corotated.h"

COROTATED_FAMILY(qr, "qr", "QR frame", "Nesme, Payan, Faure 2005", AXES_EDGES, 0, LAWS_ELEMENT,
                 LAWS_ELEMENT, LAWS_ELEMENT | LAWS_EULER)
COROTATED_MODEL(qr_exact, "qr-exact", "QR frame, rest B, true gradient of the energy",
                "this project; energy of Nesme, Payan, Faure 2005", POLICY_PRECOMPUTED, AXES_EDGES,
                0, 1, LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY,
                LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY)
