/* scaling.h - what the figure of scaling shares with its search for the largest mesh.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SCALING_H
#define CB_SCALING_H

#include "harness/bench/bench.h"

enum { CB_SCALING_ITERATIONS = 5 };

/* Find the largest mesh, a grid and an irregular one, whose step of 5 iterations is
 * done within 33 ms, for each entry, the fastest first: a row each, written at once.
 * First guesses come from the rows of figure "scaling"; an entry without one, which
 * failed, gets no row. After budget_s no further entry is searched: its rows, of 0
 * measurements, say so. entries are reordered. */
enum cb_status cb_frame_search(struct cb_bench *b, size_t count, struct cb_entry *entries,
                               double budget_s);
void cb_frame_print(const struct cb_results *r, FILE *stream);

/* The row of that entry with the most tetrahedra, at 5 iterations, or NULL. */
const struct cb_row *cb_scaling_last(const struct cb_results *r, struct cb_entry entry);

/* Bytes that a job of that entry, whose smaller one has `row`, needs besides the mesh
 * and while it is made: an estimate, rather too much. */
double cb_scaling_bytes(const struct cb_row *row, double tetrahedra);

#endif
