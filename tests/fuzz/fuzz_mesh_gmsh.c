/* fuzz_mesh_gmsh.c - the bytes as a .msh file.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/fuzz/mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct fuzz_file file;
  struct cb_mesh mesh = {0};
  long long *numbers = NULL;
  if (!file.path[0]) fuzz_files(1, (const char *[]){"mesh.msh"}, &file);
  fuzz_write(&file, data, size);
  const enum cb_status status = cb_mesh_read(file.path, &mesh, &numbers);
  fuzz_check(status, file.path);
  if (!status) fuzz_mesh(&mesh, numbers);
  return 0;
}
