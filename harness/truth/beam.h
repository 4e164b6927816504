/* beam.h - a beam along x, held at x-, with a force on its end x+.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_BEAM_H
#define CB_BEAM_H

#include "kernels/kernel.h"

struct cb_beam {
  struct cb_mesh mesh;
  struct cb_material material;
  uint8_t *fixed;
  double *x, *external; /* [3*nodes] */
  double length;
};

/* `widths` long, `across` cells wide; x at rest, no force. nu = 0, as beam theory has it.
 * CB_MEMORY, recorded. */
enum cb_status cb_beam_create(double width, size_t widths, size_t across, double young,
                              struct cb_beam *beam);
void cb_beam_free(struct cb_beam *beam); /* zeroed is allowed */
/* external := -force along z on the end, shared out by area. */
void cb_beam_push(struct cb_beam *beam, double force);
/* Mean displacement of the end along x and z, of the length. */
void cb_beam_tip(const struct cb_beam *beam, double *along, double *down);

#endif
