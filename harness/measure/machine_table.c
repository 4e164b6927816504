/* The rates of a machine as a table.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>

#include "harness/measure/machine.h"
#include "kernels/team.h"

static void add_rate(struct cb_table *t, const char *kind, const char *what, const char *set,
                     size_t threads, struct cb_interval rate, const char *unit) {
  char quantity[32];
  snprintf(quantity, sizeof quantity, "%s-%s", kind, what);
  cb_table_text(t, quantity);
  cb_table_text(t, set);
  cb_table_integer(t, (long long)threads);
  cb_table_number(t, 1e-9 * rate.value);
  cb_table_number(t, 1e-9 * rate.low);
  cb_table_number(t, 1e-9 * rate.high);
  cb_table_text(t, unit);
}

static void add_peaks(struct cb_table *t, const struct cb_machine *m, enum cb_crew crew) {
  for (size_t set = 0; cb_loops[set].name; set++)
    for (enum cb_scalar scalar = 0; scalar < CB_SCALARS; scalar++) {
      if (isnan(m->peak[set][scalar][crew].value)) continue;
      add_rate(t, "fma", cb_scalar_name[scalar], cb_loops[set].name, m->threads[crew],
               m->peak[set][scalar][crew], "Gflop/s");
      cb_table_missing(t);
    }
}

static void add_bandwidths(struct cb_table *t, const struct cb_machine *m, enum cb_crew crew) {
  for (enum cb_level level = 0; level < CB_LEVELS; level++) {
    if (m->bytes[level][crew] == 0) continue;
    add_rate(t, "read", cb_level_name[level], m->vectors, m->threads[crew], m->read[level][crew],
             "GB/s");
    cb_table_integer(t, (long long)m->bytes[level][crew]);
    add_rate(t, "triad", cb_level_name[level], m->vectors, m->threads[crew], m->triad[level][crew],
             "GB/s");
    cb_table_integer(t, (long long)m->bytes[level][crew]);
  }
}

static void add_barrier(struct cb_table *t, const struct cb_machine *m) {
  const size_t threads = m->threads[CB_ALL];
  cb_table_text(t, "barrier");
  cb_table_missing(t);
  cb_table_integer(t, (long long)(threads < CB_TEAM_MOST ? threads : CB_TEAM_MOST));
  cb_table_number(t, 1e9 * m->barrier.value);
  cb_table_number(t, 1e9 * m->barrier.low);
  cb_table_number(t, 1e9 * m->barrier.high);
  cb_table_text(t, "ns");
  cb_table_missing(t);
}

struct cb_table *cb_machine_table(const struct cb_machine *m) {
  struct cb_table *t = cb_table_create(CB_MACHINE_COLUMNS);
  const enum cb_crew crews = m->threads[CB_ALL] > 1 ? CB_CREWS : CB_ALL;
  for (enum cb_crew crew = 0; t && crew < crews; crew++) add_peaks(t, m, crew);
  for (enum cb_crew crew = 0; t && crew < crews; crew++) add_bandwidths(t, m, crew);
  if (t && crews == CB_CREWS) add_barrier(t, m);
  return t;
}
