/* stages.h - the parts of an update and a product whose operations are counted
 * apart.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STAGES_H
#define CB_STAGES_H

enum cb_stage {
  STAGE_REST,     /* rest shape, where it is made of the nodes' rest positions */
  STAGE_SCATTER,  /* adding an element's result to its nodes */
  STAGE_FRAME,    /* edges, deformation gradient, frame */
  STAGE_B,        /* strain-displacement: the gradients that B is made of */
  STAGE_FORCE,    /* strain, stress, nodal forces */
  STAGE_ASSEMBLY, /* element matrix, sum into the global one */
  STAGE_PRODUCT,  /* one product df = K du */
  STAGES
};

#endif
