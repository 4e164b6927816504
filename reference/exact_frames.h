/* exact_frames.h - the nearest rotation and the QR frame of a 3x3 matrix in quad
 * precision, of any rank: what rotation routines are held against.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_EXACT_FRAMES_H
#define CB_EXACT_FRAMES_H

/* How a frame answers a change of F: a relative one by u turns R by about u condition. */
struct cb_exact_frame {
  __float128 R[9];      /* row-major, det R = +1; where the answer is not unique, one of them */
  __float128 s[3];      /* polar: singular values, descending, the last with the sign of det F */
  __float128 column[2]; /* qr: lengths of the first two columns of F */
  double condition;     /* at least 1; infinity where the answer is not unique */
};

/* R maximises sum R_ij F_ij, which is s[0] + s[1] + s[2], and so minimises |F - R|, over
 * the rotations. condition: s[0] / (s[1] + s[2]). F[9] row-major, finite. */
void cb_exact_polar(const double F[9], struct cb_exact_frame *exact);

/* F = R T, T upper triangular, T11, T22 >= 0, det R = +1 (so T33 < 0 where det F < 0).
 * condition: 1 + length of the second column over what of it is not along the first. */
void cb_exact_qr(const double F[9], struct cb_exact_frame *exact);

#endif
