/* qr_lazy.c - qr-updated, with B kept in the frame until the stretch has moved by more
 * than cb_operator_tune says.
 * Trade:  a stale B makes a ghost torque; and in the QR frame B is cheaper than the
 *         question whether it has to be made.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/models/qr_element.h"

#define SPARSE 1
#define NO_FRAME 0
#define LAZY
#define FRAME_PACK qr_pack
#define FRAME_WORLD qr_world
#include "kernels/models/corotated.h"

/* As it comes, with tolerance 0, it is qr-updated. */
COROTATED_TUNED(qr_lazy, "qr-lazy", "QR frame, B updated when the shape has moved",
                "Nesme, Payan, Faure 2005; lazy: this project", POLICY_LAZY, LAZY_NUMBERS,
                CB_KNOB_LAZY, LAWS_ELEMENT | LAWS_EULER)
