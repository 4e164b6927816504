/* oracles.c - decompositions by GSL.
 * Source: Golub, Reinsch 1970 (svd); Householder QR; symmetric QR eigenvalues.
 * Trade:  backward stable and slow: no kernel shares a line with them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/oracles.h"

#include <float.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

/* GSL's iterations need not end on NaN. */
static bool all_finite(size_t count, const double *a) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(a[i])) return false;
  return true;
}

static double determinant(const double A[9]) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

enum cb_status cb_oracle_svd(const double F[9], double U[9], double S[3], double V[9]) {
  double u[9], s[3], v[9], work[3];
  if (!all_finite(9, F)) return CB_NUMERIC;
  memcpy(u, F, sizeof u);
  gsl_matrix_view um = gsl_matrix_view_array(u, 3, 3), vm = gsl_matrix_view_array(v, 3, 3);
  gsl_vector_view sv = gsl_vector_view_array(s, 3), wv = gsl_vector_view_array(work, 3);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  int failed = gsl_linalg_SV_decomp(&um.matrix, &vm.matrix, &sv.vector, &wv.vector);
  gsl_set_error_handler(handler);
  if (failed) return CB_NUMERIC;
  memcpy(U, u, sizeof u);
  memcpy(S, s, sizeof s);
  memcpy(V, v, sizeof v);
  return CB_OK;
}

/* R := U diag(1, 1, third) V^T */
static void compose(const double U[9], double third, const double V[9], double R[9]) {
  for (size_t i = 0; i < 3; i++)
    for (size_t j = 0; j < 3; j++)
      R[3 * i + j] =
          U[3 * i] * V[3 * j] + U[3 * i + 1] * V[3 * j + 1] + third * U[3 * i + 2] * V[3 * j + 2];
}

enum cb_status cb_oracle_polar(const double F[9], double R[9]) {
  double U[9], S[3], V[9];
  enum cb_status status = cb_oracle_svd(F, U, S, V);
  if (status == CB_OK) compose(U, determinant(U) * determinant(V) < 0 ? -1 : 1, V, R);
  return status;
}

enum cb_status cb_oracle_polar_orthogonal(const double F[9], double R[9]) {
  double U[9], S[3], V[9];
  enum cb_status status = cb_oracle_svd(F, U, S, V);
  if (status == CB_OK) compose(U, 1, V, R);
  return status;
}

enum cb_status cb_oracle_qr(const double F[9], double R[9]) {
  double qr[9], tau[3], q[9], u[9];
  if (!all_finite(9, F)) return CB_NUMERIC;
  memcpy(qr, F, sizeof qr);
  gsl_matrix_view qrm = gsl_matrix_view_array(qr, 3, 3), qm = gsl_matrix_view_array(q, 3, 3);
  gsl_matrix_view um = gsl_matrix_view_array(u, 3, 3);
  gsl_vector_view tv = gsl_vector_view_array(tau, 3);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  int failed = gsl_linalg_QR_decomp(&qrm.matrix, &tv.vector) ||
               gsl_linalg_QR_unpack(&qrm.matrix, &tv.vector, &qm.matrix, &um.matrix);
  gsl_set_error_handler(handler);
  double rounding = 8 * DBL_EPSILON * hypot(u[1], u[4]);
  if (failed || !(fabs(u[0]) > 0) || !(fabs(u[4]) > rounding)) return CB_NUMERIC;
  double first = copysign(1, u[0]), second = copysign(1, u[4]);
  double third = determinant(q) * first * second < 0 ? -1 : 1;
  for (size_t i = 0; i < 3; i++) {
    R[3 * i] = first * q[3 * i];
    R[3 * i + 1] = second * q[3 * i + 1];
    R[3 * i + 2] = third * q[3 * i + 2];
  }
  return CB_OK;
}

double cb_rotation_angle(const double R[9]) {
  /* (R - R^T)/2 has the axial vector sin(angle) n; the trace is 1 + 2 cos. */
  double x = R[7] - R[5], y = R[2] - R[6], z = R[3] - R[1];
  return atan2(hypot(hypot(x, y), z), R[0] + R[4] + R[8] - 1);
}

enum cb_status cb_oracle_eigenvalues(size_t n, const double *A, double *values) {
  enum cb_status status = CB_MEMORY;
  for (size_t i = 0; i < n; i++)
    if (!all_finite(i + 1, A + i * n)) return CB_NUMERIC;
  if (n == 0) return CB_OK;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  gsl_matrix *copy = gsl_matrix_alloc(n, n);
  gsl_vector *found = gsl_vector_alloc(n);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(n);
  if (!copy || !found || !work) goto done;
  memcpy(copy->data, A, n * n * sizeof *A);
  status = gsl_eigen_symm(copy, found, work) ? CB_NUMERIC : CB_OK;
  if (status != CB_OK) goto done;
  gsl_sort(found->data, 1, n);
  memcpy(values, found->data, n * sizeof *values);
done:
  gsl_eigen_symm_free(work);
  gsl_vector_free(found);
  gsl_matrix_free(copy);
  gsl_set_error_handler(handler);
  return status;
}
