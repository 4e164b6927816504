/* iterations.h - how often the iterative frames iterate: always so often, in
 * every arithmetic, so that what is counted is what is timed. The smallest
 * numbers that leave less than one rounding of F in double moves the frame by,
 * on flat, inverted, stretched and needle-like elements: tests/test_iterations.c
 * measures it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_ITERATIONS_H
#define CB_FRAME_ITERATIONS_H

/* Scaled iterations bring the singular values together, however far apart, the
 * others converge quadratically. */
#define HIGHAM_SCALED 3
#define HIGHAM_PLAIN 3
/* Three sweeps leave up to 3e-5 rad, four 1e-20. */
#define JACOBI_SWEEPS 4
/* Not converged, on purpose. Each turn multiplies a small angle that is left by
 * s_max / (s_1 + s_2 + s_3), singular values of F: a third of it near rest. */
#define QUATERNION_TURNS 4

#endif
