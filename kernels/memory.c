/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static const size_t LINE = 64, PAGE = (size_t)1 << 21;

void *cb_memory(size_t n, size_t size) {
  const size_t bytes = n * size;
  if ((size && bytes / size != n) || bytes > SIZE_MAX - 2 * PAGE) return NULL;
  const size_t unit = bytes < 2 * PAGE ? LINE : PAGE;
  const size_t whole = (bytes + LINE + unit - 1) / unit * unit;
  void *a = aligned_alloc(unit, whole);
  if (!a) return NULL;
  if (unit == PAGE) madvise(a, whole, MADV_HUGEPAGE); /* refused: slower, not wrong */
  memset(a, 0, bytes + LINE);
  return a;
}
