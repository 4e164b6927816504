/* oracles.h - what the element frames are held against: the singular value and
 * QR decompositions of GSL, and the eigenvalues of a symmetric matrix.
 * All matrices are row-major; outputs may be the inputs. GSL's error handler
 * is switched off during a call, so no two threads may be in here.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ORACLES_H
#define CB_ORACLES_H

#include "kernels/kernel.h"

/* F = U diag(S) V^T: U[9], V[9] orthogonal (their determinants may be -1),
 * S[3] >= 0 descending, for any rank. CB_NUMERIC when F is not finite. */
enum cb_status cb_oracle_svd(const double F[9], double U[9], double S[3], double V[9]);

/* R := the rotation nearest to F, U diag(1, 1, det U det V) V^T. Unique when
 * the second singular value exceeds the third (det F < 0) or zero. CB_NUMERIC
 * when F is not finite. */
enum cb_status cb_oracle_polar(const double F[9], double R[9]);

/* R := the orthogonal matrix nearest to F, U V^T: a reflection where
 * det F < 0. Unique when det F != 0. CB_NUMERIC when F is not finite. */
enum cb_status cb_oracle_polar_orthogonal(const double F[9], double R[9]);

/* R := Q of F = Q U, U upper triangular, U11, U22 > 0, and the third column of
 * Q the cross product of the first two (so U33 < 0 where det F < 0).
 * CB_NUMERIC when the first two columns are dependent to rounding or F is not
 * finite. */
enum cb_status cb_oracle_qr(const double F[9], double R[9]);

/* The angle, 0 to pi, rad, that the rotation R turns by: accurate to rounding
 * near 0 (relative) and near pi (absolute). That R is a rotation is not
 * checked. */
double cb_rotation_angle(const double R[9]);

/* values[n] := eigenvalues of the symmetric A[n*n], ascending. Only the lower
 * triangle is read. CB_MEMORY; CB_NUMERIC when it is not finite. */
enum cb_status cb_oracle_eigenvalues(size_t n, const double *A, double *values);

#endif
