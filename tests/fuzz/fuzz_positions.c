/* fuzz_positions.c - the bytes as positions of five nodes, which have the numbers 0 to 4 or,
 * if their number is even, others.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/fuzz/mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  enum { NODES = 5 };
  static struct fuzz_file file;
  static const long long numbers[NODES] = {-3, 7, 1000000, 1, 2};
  const struct cb_mesh mesh = {.nodes = NODES};
  double x[3 * NODES];
  if (!file.path[0]) fuzz_files(1, (const char *[]){"positions.csv"}, &file);
  fuzz_write(&file, data, size);
  for (size_t i = 0; i < 3 * NODES; i++) x[i] = NAN;
  const enum cb_status status = cb_positions_read(file.path, &mesh, size % 2 ? NULL : numbers, x);
  fuzz_check(status, file.path);
  for (size_t i = 0; i < 3 * NODES; i++)
    fuzz_require(status ? isnan(x[i]) : isfinite(x[i]), "all positions are set, or none");
  return 0;
}
