/* simulators.c - what a model is called in simulators that many use.
 * Source: SOFA's TetrahedronFEMForceField (data `method`, `updateStiffnessMatrix`),
 *         VegaFEM's corotational linear FEM (warp).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <string.h>

#include "harness/advise/advise.h"

static bool begins(const char *text, const char *with) {
  return strncmp(text, with, strlen(with)) == 0;
}

void cb_advise_settings(const struct cb_candidate *c, char sofa[160], char vega[160]) {
  const char *model = c->trial.variant->model->name;
  const bool updated = strstr(model, "-updated") != NULL;
  const char *method = begins(model, "linear")  ? "small"
                       : begins(model, "qr-")   ? "large"
                       : begins(model, "polar") ? "polar"
                       : begins(model, "svd")   ? "svd"
                                                : NULL;
  const char *note = strstr(model, "-exact")
                         ? "; its true gradient is not offered there: this keeps the frame only"
                     : begins(model, "polar") ? "; the frame there is that of the edges, not of F"
                                              : "";
  if (method)
    snprintf(sofa, 160, "TetrahedronFEMForceField method=\"%s\" updateStiffnessMatrix=\"%s\"%s",
             method, updated ? "true" : "false", note);
  else
    snprintf(sofa, 160, "not offered");
  if (begins(model, "linear"))
    snprintf(vega, 160, "corotationalLinearFEM, warp 0");
  else if (begins(model, "polar") && !updated)
    snprintf(vega, 160, "corotationalLinearFEM, warp 1 (2: with the derivative of the frame)");
  else if (begins(model, "green"))
    snprintf(vega, 160, "StVKFEM");
  else
    snprintf(vega, 160, "not offered");
}
