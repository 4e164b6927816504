/* rest.h - rest data of a pack from the rest positions of its nodes. An element
 * then keeps nothing but its nodes and what the product needs; what is computed
 * again in each update costs less than the memory that it would take.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_REST_H
#define CB_REST_H

#include "kernels/elements.h"
#include "kernels/frames/qr.h"
#include "kernels/storage/gradients.h"

/* r[REST_ISOTROPIC] := rest data (kernels/elements.h) of rest edges e[9], m. */
INLINE void rest_of_edges(const struct cb_elements *E, const T *e, T *r) {
  T *g = r + REST_G, det;
  if (E->axes == AXES_EDGES) {
    T Q[9], y[6];
    frame_qr(e, Q, y);
    const T xb = y[0], xc = y[1], yc = y[2], xd = y[3], yd = y[4], zd = y[5];
    det = xb * yc * zd;
    g[0] = yc * zd, g[1] = -(xc * zd), g[2] = xc * yd - yc * xd;
    g[3] = LIT(0), g[4] = xb * zd, g[5] = -(xb * yd);
    g[6] = g[7] = LIT(0), g[8] = xb * yc;
  } else {
    edge_cofactors(e, g);
    det = dot3(e, g);
  }
  T sign = SELECT(det < LIT(0), LIT(-1), LIT(1)), volume = sign * det;
  T q = RSQRT(volume), rq = E->root * q; /* sqrt(c mu W) / volume */
  T s = rq * volume, scale = sign * q * q;
  r[REST_W] = s;
  r[REST_FORCE] = E->inverse_c * s;
  if (E->policy == POLICY_PRECOMPUTED) {
    scale = sign * rq;
    r[REST_EDGE] = E->inverse_root * q;
  }
  if (E->policy == POLICY_UPDATED) {
    r[REST_W] = rq;
    r[REST_FORCE] = sign * r[REST_FORCE];
  }
  for (int i = 0; i < 9; i++) g[i] = scale * g[i];
}

#endif
