/* The rows of figure "scaling" as first guesses for larger meshes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/bench/scaling.h"

#include <math.h>
#include <string.h>

const struct cb_row *cb_scaling_last(const struct cb_results *r, struct cb_entry entry) {
  const struct cb_row *last = NULL;
  char name[CB_NAME];
  cb_variant_name(entry.variant, name);
  for (size_t i = 0; i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (strcmp(row->figure, "scaling") == 0 && strcmp(row->variant, name) == 0 &&
        row->threads == entry.threads && row->iterations == CB_SCALING_ITERATIONS &&
        isfinite(row->step.value) && (!last || row->tetrahedra > last->tetrahedra))
      last = row;
  }
  return last;
}

double cb_scaling_bytes(const struct cb_row *row, double tetrahedra) {
  enum { BESIDES = 250 }; /* node vectors, clusters or an order being found */
  return tetrahedra * (row->bytes_per_tetrahedron + BESIDES);
}
