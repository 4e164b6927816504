/* The timer on a clock that only the measured work moves, so that nothing here
 * depends on the machine.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/measure/timer.h"
#include "harness/progress.h"

enum { SUBJECTS = 3, LOG = 4096 };

static double clock_s;
static char order[LOG]; /* the subject of each epoch, in order */
static size_t epochs;

struct work {
  char letter;
  double seconds; /* per repeat */
  size_t prepared, interrupt_at;
};

static double fake_clock(void) { return clock_s; }

static void prepare(void *context) {
  struct work *work = context;
  work->prepared++;
  clock_s += 100; /* must not be part of any sample */
}

static void run(void *context, size_t repeats) {
  struct work *work = context;
  clock_s += work->seconds * (double)repeats;
  if (epochs < LOG) order[epochs++] = work->letter;
  if (work->interrupt_at && epochs == work->interrupt_at) raise(SIGINT);
}

static struct work works[SUBJECTS];
static struct cb_subject subjects[SUBJECTS];
static struct cb_timing timing;

static int setup(void **state) {
  (void)state;
  const double seconds[SUBJECTS] = {1e-6, 3e-4, 7};
  for (int i = 0; i < SUBJECTS; i++) {
    works[i] = (struct work){(char)('a' + i), seconds[i], 0, 0};
    subjects[i] = (struct cb_subject){"work", prepare, run, &works[i]};
  }
  timing = (struct cb_timing){.epoch_s = 2e-3,
                              .budget_s = 1e9,
                              .min_rounds = 6,
                              .max_rounds = 20,
                              .seed = 2005,
                              .now = fake_clock};
  clock_s = 0;
  epochs = 0;
  return 0;
}

static void test_samples_are_seconds_per_repeat(void **state) {
  (void)state;
  struct cb_samples samples;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  assert_int_equal(samples.rounds, 20);
  for (size_t s = 0; s < SUBJECTS; s++)
    for (size_t r = 0; r < samples.rounds; r++) {
      const size_t at = s * samples.stride + r;
      assert_true(fabs(samples.step_s[at] / works[s].seconds - 1) < 1e-6);
      assert_true(samples.cpu_s[at] >= 0);
    }
  cb_samples_free(&samples);
}

static void test_epochs_are_long_enough_and_jittered(void **state) {
  (void)state;
  struct cb_samples samples;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  size_t different = 0;
  for (size_t s = 0; s < SUBJECTS; s++)
    for (size_t r = 0; r < samples.rounds; r++) {
      const size_t repeats = samples.repeats[s * samples.stride + r];
      assert_true((double)repeats * works[s].seconds >= timing.epoch_s);
      assert_true(repeats == 1 || (double)repeats * works[s].seconds < 2 * timing.epoch_s);
      different += s == 0 && repeats != samples.repeats[0];
    }
  assert_true(different > 10);
  cb_samples_free(&samples);
}

/* Every pair must come in both orders equally often, and not always alternate. */
static void test_order_is_balanced_and_random(void **state) {
  (void)state;
  struct cb_samples samples;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  const size_t measured = samples.rounds * SUBJECTS;
  const char *first = order + epochs - measured;
  size_t before[SUBJECTS][SUBJECTS] = {{0}}, changes = 0;
  for (size_t r = 0; r < samples.rounds; r++) {
    const char *round = first + SUBJECTS * r;
    for (size_t i = 0; i < SUBJECTS; i++)
      for (size_t j = i + 1; j < SUBJECTS; j++) before[round[i] - 'a'][round[j] - 'a']++;
    changes += r >= 2 && round[0] != round[0 - 2 * SUBJECTS];
  }
  for (size_t i = 0; i < SUBJECTS; i++)
    for (size_t j = i + 1; j < SUBJECTS; j++) assert_int_equal(before[i][j], before[j][i]);
  assert_true(changes > 2);
  cb_samples_free(&samples);
}

static void test_prepared_before_every_epoch(void **state) {
  (void)state;
  struct cb_samples samples;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  size_t prepared = 0;
  for (int s = 0; s < SUBJECTS; s++) prepared += works[s].prepared;
  assert_int_equal(prepared, epochs);
  cb_samples_free(&samples);
}

static void test_budget_ends_it_but_not_before_min_rounds(void **state) {
  (void)state;
  struct cb_samples samples;
  timing.budget_s = 1;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  assert_int_equal(samples.rounds, timing.min_rounds);
  cb_samples_free(&samples);
}

static void test_same_seed_same_order(void **state) {
  struct cb_samples samples;
  char kept[LOG];
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  cb_samples_free(&samples);
  memcpy(kept, order, sizeof kept);
  setup(state);
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  cb_samples_free(&samples);
  assert_memory_equal(kept, order, epochs);
  setup(state);
  timing.seed++;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  cb_samples_free(&samples);
  assert_memory_not_equal(kept, order, epochs);
}

static double last_share;

static void watch(void *context, double share, const char *subject) {
  (void)context;
  assert_string_equal(subject, "work");
  assert_true(share >= last_share && share <= 1);
  last_share = share;
}

static void test_progress_grows_to_one(void **state) {
  (void)state;
  struct cb_samples samples;
  timing.progress = watch;
  last_share = 0;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_OK);
  assert_true(last_share == 1);
  cb_samples_free(&samples);
}

/* Last: the flag stays set. */
static void test_interrupt(void **state) {
  (void)state;
  struct cb_samples samples = {.subjects = 77};
  cb_interrupt_install();
  for (int i = 0; i < SUBJECTS; i++) works[i].interrupt_at = 20;
  assert_int_equal(cb_timer_run(SUBJECTS, subjects, &timing, &samples), CB_INTERRUPTED);
  assert_int_equal(epochs, 20);
  assert_int_equal(samples.subjects, 77);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup(test_samples_are_seconds_per_repeat, setup),
      cmocka_unit_test_setup(test_epochs_are_long_enough_and_jittered, setup),
      cmocka_unit_test_setup(test_order_is_balanced_and_random, setup),
      cmocka_unit_test_setup(test_prepared_before_every_epoch, setup),
      cmocka_unit_test_setup(test_budget_ends_it_but_not_before_min_rounds, setup),
      cmocka_unit_test_setup(test_same_seed_same_order, setup),
      cmocka_unit_test_setup(test_progress_grows_to_one, setup),
      cmocka_unit_test_setup(test_interrupt, setup),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
