/* fuzz_mesh_tetgen.c - the bytes as a .node file and, behind the first line that begins
 * with '=', a .ele file.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/fuzz/mesh.h"

enum { NODES, ELEMENTS, FILES };

/* How long the first file is, and the line between the two. */
static size_t split(const uint8_t *data, size_t size, size_t *between) {
  *between = 0;
  for (size_t i = 0; i < size; i++) {
    if (data[i] != '=' || (i > 0 && data[i - 1] != '\n')) continue;
    const uint8_t *stop = memchr(data + i, '\n', size - i);
    *between = stop ? (size_t)(stop + 1 - data) - i : size - i;
    return i;
  }
  return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct fuzz_file file[FILES];
  struct cb_mesh mesh = {0};
  long long *numbers = NULL;
  size_t between;
  const size_t first = split(data, size, &between);
  if (!file[0].path[0]) fuzz_files(FILES, (const char *[]){"mesh.node", "mesh.ele"}, file);
  fuzz_write(&file[NODES], data, first);
  fuzz_write(&file[ELEMENTS], data + first + between, size - first - between);
  const enum cb_status status = cb_mesh_read(file[NODES].path, &mesh, &numbers);
  fuzz_check(status, fuzz_folder_path);
  if (!status) fuzz_mesh(&mesh, numbers);
  return 0;
}
