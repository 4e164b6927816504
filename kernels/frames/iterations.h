/* iterations.h - how often the iterative frames iterate: always so often, in
 * every arithmetic of one precision (counted: as double), so that what is counted
 * is what is timed. The smallest numbers that leave less than one rounding of F
 * in that precision moves the frame by, on flat, inverted, stretched and
 * needle-like elements: tests/test_iterations.c measures it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_ITERATIONS_H
#define CB_FRAME_ITERATIONS_H

#define PER_PRECISION(count) (sizeof(S) == sizeof(float) ? count##_FLOAT : count##_DOUBLE)

/* Scaled iterations bring the singular values together, however far apart, the
 * others converge quadratically. */
#define HIGHAM_SCALED_FLOAT 3
#define HIGHAM_SCALED_DOUBLE 3
#define HIGHAM_SCALED PER_PRECISION(HIGHAM_SCALED)
#define HIGHAM_PLAIN_FLOAT 2
#define HIGHAM_PLAIN_DOUBLE 3
#define HIGHAM_PLAIN PER_PRECISION(HIGHAM_PLAIN)
/* Quadratic from at most 5 % off; then comes one plain iteration of Higham. */
#define CLOSED_NEWTON_FLOAT 2
#define CLOSED_NEWTON_DOUBLE 3
#define CLOSED_NEWTON PER_PRECISION(CLOSED_NEWTON)
/* Plane rotations; three are a sweep. The last few converge faster than
 * quadratically: in double 9, 11, 12 leave up to 1e-6, 5e-16, 3e-25 rad. */
#define JACOBI_TURNS_FLOAT 11
#define JACOBI_TURNS_DOUBLE 12
#define JACOBI_TURNS PER_PRECISION(JACOBI_TURNS)
/* The first so many by estimates of the angle, where the processor has them. */
#define JACOBI_ROUGH_FLOAT (2 * JACOBI_TURNS_FLOAT) /* all: degenerate.h does twice as many */
#define JACOBI_ROUGH_DOUBLE 8
#define JACOBI_ROUGH PER_PRECISION(JACOBI_ROUGH)
/* Not converged, on purpose. Each turn multiplies a small angle that is left by
 * s_max / (s_1 + s_2 + s_3), singular values of F: a third of it near rest. */
#define QUATERNION_TURNS 4

#endif
