/* loops.h - the loops that show what a processor can do at most: multiply-adds
 * in registers, numbers read, numbers written. Each instruction set has its own.
 *
 * Source: the triad is McCalpin's STREAM, 1995.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_LOOPS_H
#define CB_LOOPS_H

#include "kernels/kernel.h"

enum cb_scalar { CB_F32, CB_F64, CB_SCALARS };

enum {
  CB_LOOP_UNIT = 64,  /* lengths are multiples of this many doubles, arrays aligned to it */
  CB_LOOP_CHAINS = 12 /* independent vectors of multiply_add */
};

struct cb_loops {
  const char *name;   /* of the instruction set */
  bool (*runs)(void); /* on this processor */
  size_t bytes;       /* in a vector */
  /* a[k] := a[k] factor + addend in CB_LOOP_CHAINS vectors, repeats times;
   * returns their sum. Two flops a number and repeat, whether the processor fuses
   * them (avx2, avx512) or not (generic x86-64). */
  double (*multiply_add[CB_SCALARS])(size_t repeats, double factor, double addend);
  /* Sum of x[n], repeats times over; n is a multiple of CB_LOOP_UNIT. */
  double (*read)(size_t repeats, size_t n, const double *x);
  /* a := b + factor c on n numbers each, repeats times; no overlap. */
  void (*triad)(size_t repeats, size_t n, double factor, const double *b, const double *c,
                double *a);
};

/* Those that this program has, widest last, then one with name NULL. The first
 * runs everywhere, the others where runs() says so. */
enum { CB_LOOP_SETS = 3 };
extern const struct cb_loops cb_loops[CB_LOOP_SETS + 1];

#endif
