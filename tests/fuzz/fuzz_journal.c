/* fuzz_journal.c - the bytes as what follows the header of a journal; the row "a", if there is
 * one, as a part of a run of bench.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/journal.h"
#include "harness/measure/results_slices.h"
#include "tests/fuzz/fuzz.h"

static char path[64], header[2048];
static size_t header_length;

/* The first line, as this program writes it. */
static void make_header(void) {
  struct cb_journal *j = NULL;
  fuzz_require(mkdtemp(fuzz_folder_path) != NULL, "no folder can be made");
  fuzz_names[0] = "work.unfinished";
  atexit(fuzz_clean);
  snprintf(path, sizeof path, "%s/work.unfinished", fuzz_folder_path);
  fuzz_require(!cb_journal_open(fuzz_folder_path, "work", "", false, &j), "a journal can be made");
  FILE *file = fopen(path, "r");
  fuzz_require(file != NULL, "a journal can be read");
  header_length = fread(header, 1, sizeof header, file);
  fclose(file);
  cb_journal_close(j, CB_OK);
}

static void write_journal(const uint8_t *data, size_t size) {
  FILE *file = fopen(path, "w");
  fuzz_require(file && fwrite(header, 1, header_length, file) == header_length &&
                   fwrite(data, 1, size, file) == size && fclose(file) == 0,
               "the input cannot be written");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  struct cb_journal *j = NULL;
  struct cb_results results = {.session = 1};
  size_t session = 0;
  if (!header_length) make_header();
  write_journal(data, size);
  const enum cb_status status = cb_journal_open(fuzz_folder_path, "work", "", true, &j);
  fuzz_check(status, path);
  if (status) return 0;
  const json_t *row = cb_journal_row(j, "a", &session);
  if (row) {
    fuzz_require(session >= 1 && session < cb_journal_session(j), "a row has a session");
    const enum cb_status restored = cb_results_restore(&results, row, session);
    fuzz_require(!restored || cb_error_message()[0], "a refusal has a sentence");
    for (size_t i = 0; !restored && i < results.sample_count; i++)
      fuzz_require(results.samples[i].row < results.row_count, "a sample is of a row");
    cb_results_free(&results);
  }
  cb_journal_close(j, CB_OK);
  return 0;
}
