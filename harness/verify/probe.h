/* probe.h - a variant on a mesh with its vectors, spoken to in double.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PROBE_H
#define CB_PROBE_H

#include "kernels/kernel.h"

struct cb_probe {
  const struct cb_variant *variant;
  struct cb_operator *op;
  size_t nodes;
  void *x, *out; /* node vectors of the arithmetic */
};

/* c = 1. CB_MEMORY or CB_INPUT, recorded. Close with cb_probe_close. */
enum cb_status cb_probe_open(const struct cb_variant *variant, const struct cb_mesh *mesh,
                             const struct cb_material *material, struct cb_probe *probe);
void cb_probe_close(struct cb_probe *probe);
/* f[3*nodes] := elastic force at x[3*nodes]. Frames that remember come from the
 * shape of the last call, or start cold after cb_probe_reset. */
void cb_probe_force(struct cb_probe *probe, const double *x, double *f);
void cb_probe_reset(struct cb_probe *probe);
/* y[3*nodes] := K u, K of the last force. */
void cb_probe_product(struct cb_probe *probe, const double *u, double *y);

#endif
