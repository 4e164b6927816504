/* exact.c - see exact.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/exact.h"

#include <math.h>
#include <string.h>

#include "reference/exact_frames.h"

enum cb_definition cb_frame_definition(const struct cb_model *model) {
  static const struct {
    const char *begin;
    enum cb_definition definition;
  } known[] = {{"polar-reflected", CB_NEAREST_ORTHOGONAL},
               {"polar", CB_NEAREST_ROTATION},
               {"svd", CB_NEAREST_ROTATION},
               {"qr", CB_GRAM_SCHMIDT}};
  if (model->node_frames) return CB_NEAREST_ROTATION;
  for (size_t i = 0; model->frame && i < sizeof known / sizeof *known; i++)
    if (strncmp(model->name, known[i].begin, strlen(known[i].begin)) == 0)
      return known[i].definition;
  return CB_UNDEFINED;
}

bool cb_divides_by_volume(const struct cb_model *model) {
  return strstr(model->name, "-updated-volume") != NULL;
}

bool cb_squares_condition(const struct cb_model *model) {
  return strncmp(model->name, "polar-eigen", strlen("polar-eigen")) == 0;
}

/* Where det F < 0 the nearest orthogonal matrix is minus the nearest rotation to -F. */
static double orthogonal(const double F[9], struct cb_exact_frame *exact, double *sign) {
  double G[9];
  cb_exact_polar(F, exact);
  *sign = exact->s[2] < 0 ? -1 : 1;
  for (int i = 0; i < 9; i++) G[i] = *sign * F[i];
  cb_exact_polar(G, exact);
  return (double)(exact->s[0] / exact->s[2]);
}

void cb_frame_exact(enum cb_definition definition, const double F[9], double R[9],
                    double *condition) {
  struct cb_exact_frame exact;
  double sign = 1;
  if (definition == CB_NEAREST_ORTHOGONAL) {
    *condition = orthogonal(F, &exact, &sign);
  } else {
    (definition == CB_GRAM_SCHMIDT ? cb_exact_qr : cb_exact_polar)(F, &exact);
    *condition = exact.condition; /* at least 1, which none here needs to be */
    if (definition == CB_NEAREST_ROTATION && isfinite(*condition))
      *condition = (double)(exact.s[0] / (exact.s[1] + exact.s[2]));
  }
  for (int i = 0; i < 9 && isfinite(*condition); i++) R[i] = sign * (double)exact.R[i];
}
