/* fuzz_mesh_text.c - the lines and numbers under all mesh readers: the first byte says which
 * comments there are, and in what order numbers, commas and ends are asked for.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/mesh_text.h"
#include "tests/fuzz/fuzz.h"

/* Ask for one thing of the line; false: it is not there. */
static int ask(struct cb_text *t, unsigned what) {
  long long integer;
  double real, point[3];
  size_t count = 0;
  switch (what % 5) {
  case 0: return cb_text_integer(t, &integer);
  case 1: return cb_text_real(t, &real);
  case 2: return cb_text_point(t, point);
  case 3: return cb_text_comma(t);
  default:
    if (cb_text_count(t, "nodes", 8, &count)) return 0;
    fuzz_require(8 * count <= (size_t)(t->end - t->next) + 1, "what is counted fits in the file");
    return 1;
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct fuzz_file file;
  struct cb_text text = {0};
  const unsigned first = size ? data[0] : 0;
  if (!file.path[0]) fuzz_files(1, (const char *[]){"text"}, &file);
  fuzz_write(&file, data, size);
  fuzz_require(cb_text_open(file.path, &text) == CB_OK, "any bytes can be opened");
  size_t lines = 0;
  for (; cb_text_line(&text, first % 2 ? '#' : 0); lines++) {
    fuzz_require(text.line > lines, "lines are counted");
    unsigned what = first / 2;
    while (!cb_text_ended(&text) && ask(&text, what)) what = 3 * what + 1;
    fuzz_require(text.at >= text.start && text.at <= text.end, "reading stays in the file");
    if (cb_text_ended(&text)) continue;
    fuzz_check(cb_text_expected(&text, "something else"), file.path);
  }
  fuzz_check(cb_text_expected(&text, "another line"), file.path);
  cb_text_close(&text);
  return 0;
}
