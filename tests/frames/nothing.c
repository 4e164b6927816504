/* nothing.c - a library without any routine that is looked for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

int corobench_nothing(void);
int corobench_nothing(void) { return 0; }
