/* journal.h - finished rows of long work, kept as they come, so that work that was killed can
 * go on where it was.
 *
 * DIRECTORY/NAME.unfinished, which nobody takes for a result: lines of JSON, the first says
 * whose they are, each other one is a finished row: its key, the session that made it, and
 * what its maker writes of it. A line is one write(2), so that it is there or not whenever the
 * program is killed; half a line at the end is no row. When the machine itself stops, the last
 * rows may be lost. The file goes when the results are in place.
 *
 * Rows are joined only if they were made by the same commit and compiler on the same machine
 * with the same options. What is compared with each other (ratios of interleaved times) must be
 * one row: nothing is the same in another session.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_JOURNAL_H
#define CB_JOURNAL_H

#include <jansson.h>
#include <stdint.h>

#include "kernels/kernel.h"

struct cb_journal;

/* Begin DIRECTORY/NAME.unfinished anew or, to resume, with the rows that are there; where there
 * is none, resuming begins as well. options: all that shapes the rows. CB_INPUT: the rows are
 * of other options, another commit, compiler or machine, another run is writing there, or it
 * is no journal; CB_IO, CB_MEMORY; all recorded. End with cb_journal_close. */
enum cb_status cb_journal_open(const char *directory, const char *name, const char *options,
                               bool resume, struct cb_journal **out);
/* Of this run: 1, or one more than any that left a row. */
size_t cb_journal_session(const struct cb_journal *j);
/* The row of that key that an earlier session finished, and which; NULL: none. Valid until the
 * journal is closed; session may be NULL. */
const json_t *cb_journal_row(const struct cb_journal *j, const char *key, size_t *session);
/* Add a finished row, whose reference is taken (NULL: CB_MEMORY); a key is used once. A number
 * that is not finite is for the caller to write otherwise. CB_IO, CB_MEMORY, recorded. */
enum cb_status cb_journal_add(struct cb_journal *j, const char *key, json_t *row);
/* The results are in place: the file goes. */
void cb_journal_done(struct cb_journal *j);
/* Free (NULL: nothing to do) and pass the status on. A file without a row goes, too; one that
 * stays is added to the recorded sentence, with how to go on. */
enum cb_status cb_journal_close(struct cb_journal *j, enum cb_status status);

/* A number for a row, and back: JSON has neither NaN nor infinity. */
json_t *cb_journal_number(double value); /* NULL when out of memory */
bool cb_journal_to_number(const json_t *json, double *value);
/* A number that tells one content of a file from another (not from a forged one); 0: unreadable. */
uint64_t cb_journal_digest(const char *path);

#endif
