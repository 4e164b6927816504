/* table.h - every table that corobench prints, in three formats: aligned text
 * for people, CSV and JSON for programs. Columns have one name in all three.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TABLE_H
#define CB_TABLE_H

#include <stdio.h>

#include "kernels/kernel.h"

enum cb_format { CB_TABLE, CB_CSV, CB_JSON };

struct cb_table;

/* An empty table; columns: names separated by commas, units in the names
 * ("step_s_median"). NULL when out of memory. Free with cb_table_free. */
struct cb_table *cb_table_create(const char *columns);
void cb_table_free(struct cb_table *t);

/* Cells are appended from left to right, a full row begins the next. What
 * fails for want of memory is remembered and reported by cb_table_print. */
void cb_table_text(struct cb_table *t, const char *text); /* copied; "" allowed */
void cb_table_integer(struct cb_table *t, long long value);
void cb_table_number(struct cb_table *t, double value); /* CSV, JSON: 17 digits; text: 4 */
void cb_table_missing(struct cb_table *t);              /* CSV: empty, JSON: null, text: - */
size_t cb_table_rows(const struct cb_table *t);
bool cb_table_is_empty(const struct cb_table *t); /* nor was a cell lost */

/* Write the whole table, whose last row is full, and flush. A NaN is written
 * "nan" (JSON: null, as is infinity). CSV is quoted by RFC 4180, its lines end
 * in LF; JSON is an array of one object a row. CB_IO when the stream failed,
 * CB_MEMORY when a cell was lost, CB_INPUT for JSON of text that is not UTF-8;
 * all recorded. */
enum cb_status cb_table_print(const struct cb_table *t, enum cb_format format, FILE *stream);

#endif
