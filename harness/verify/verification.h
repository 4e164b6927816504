/* verification.h - every model's claimed laws against what is measured.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_VERIFICATION_H
#define CB_VERIFICATION_H

#include "harness/verify/laws.h"

enum { CB_ISOTROPIC, CB_ORTHOTROPIC, CB_MATERIALS };
extern const char *const cb_material_name[CB_MATERIALS];
/* The two materials of every verification: E = 1 kPa, nu = 0.3; and one three
 * times as stiff along x as along y. */
enum cb_status cb_verification_material(int which, struct cb_material *m);

struct cb_law_row {
  const struct cb_variant *variant;
  int material;
  enum cb_law law;
  struct cb_law_value random; /* 1000 random elements, strongly deformed */
  double mesh;                /* the same law on a whole mesh */
  double limit;
  bool claimed, kept;
};
struct cb_verification {
  size_t count;
  struct cb_law_row *rows;
};

/* The larger of what the random elements and the mesh gave; NaN if either is. */
double cb_law_row_value(const struct cb_law_row *row);

/* Measure all laws for variants[count] and both materials; mesh: the user's, or
 * NULL for a block. Shows progress. CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_verification_run(const struct cb_variant *const *variants, size_t count,
                                   const struct cb_mesh *mesh, unsigned long seed,
                                   struct cb_verification *v);
void cb_verification_free(struct cb_verification *v);
/* The row of that model, or NULL. */
const struct cb_law_row *cb_verification_find(const struct cb_verification *v, const char *model,
                                              int material, enum cb_law law);

#endif
