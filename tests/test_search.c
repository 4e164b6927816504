/* The search for the largest size that fits, on costs that are known.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/bench/search.h"

struct fake {
  double unit, power; /* cost = unit * size^power ... */
  size_t step;        /* ... and ten times that from here on; 0: nowhere */
  size_t low, high, fail_after, calls;
  uint8_t seen[4096];
};

static enum cb_status cost_of(void *context, size_t size, double *cost) {
  struct fake *f = context;
  assert_in_range(size, f->low, f->high);
  assert_int_equal(f->seen[size]++, 0); /* no size twice */
  if (f->fail_after && ++f->calls == f->fail_after) return CB_INTERRUPTED;
  *cost = f->unit * pow((double)size, f->power);
  if (f->step && size >= f->step) *cost *= 10;
  return CB_OK;
}

static struct cb_search search_of(struct fake *f, size_t first, double resolution) {
  memset(f->seen, 0, sizeof f->seen);
  return (struct cb_search){.low = f->low,
                            .high = f->high,
                            .first = first,
                            .resolution = resolution,
                            .limit = 33,
                            .measure = cost_of,
                            .context = f};
}

/* Whatever the first guess and the power, the answer is exact; few measurements where
 * the power is the expected one. */
static void test_exact(void **state) {
  (void)state;
  const double powers[] = {1, 2, 3, 3.3, 5};
  const size_t answers[] = {2, 3, 17, 58, 99, 640};
  for (size_t p = 0; p < 5; p++)
    for (size_t a = 0; a < 6; a++)
      for (size_t first = 1; first <= 1000; first += 37) {
        struct fake f = {.power = powers[p], .low = 1, .high = 1000};
        f.unit = 33 / pow((double)answers[a] + 0.5, f.power);
        struct cb_search s = search_of(&f, first, 0);
        assert_int_equal(cb_search_run(&s), CB_OK);
        assert_int_equal(s.fits, answers[a]);
        assert_int_equal(s.exceeds, answers[a] + 1);
        assert_true(s.measurements <= (powers[p] == 3 ? 4 : 40));
      }
}

static void test_resolution(void **state) {
  (void)state;
  for (size_t first = 10; first <= 2000; first += 97) {
    struct fake f = {.power = 3, .low = 10, .high = 2000};
    f.unit = 33 / pow(1000.5, 3);
    struct cb_search s = search_of(&f, first, 0.05);
    assert_int_equal(cb_search_run(&s), CB_OK);
    assert_true(s.fits <= 1000 && s.exceeds > 1000);
    assert_true((double)(s.exceeds - s.fits) <= 0.05 * (double)s.fits);
  }
}

static void test_ends(void **state) {
  (void)state;
  struct fake cheap = {.unit = 1e-9, .power = 3, .low = 5, .high = 200};
  struct cb_search s = search_of(&cheap, 50, 0);
  assert_int_equal(cb_search_run(&s), CB_OK);
  assert_int_equal(s.fits, 200);
  assert_int_equal(s.exceeds, 0);
  struct fake dear = {.unit = 1e9, .power = 3, .low = 5, .high = 200};
  s = search_of(&dear, 50, 0);
  assert_int_equal(cb_search_run(&s), CB_OK);
  assert_int_equal(s.fits, 0);
  assert_int_equal(s.exceeds, 5);
}

/* A cache that ends makes the cost jump; a NaN never fits. */
static void test_jump_and_nan(void **state) {
  (void)state;
  struct fake f = {.power = 3, .step = 40, .low = 1, .high = 1000};
  f.unit = 33 / pow(90, 3);
  struct cb_search s = search_of(&f, 200, 0);
  assert_int_equal(cb_search_run(&s), CB_OK);
  assert_int_equal(s.fits, 41); /* 41^3 * 10 < 90^3 < 42^3 * 10 */
  struct fake nan = {.unit = NAN, .power = 3, .low = 3, .high = 1000};
  s = search_of(&nan, 500, 0);
  assert_int_equal(cb_search_run(&s), CB_OK);
  assert_int_equal(s.fits, 0);
}

static void test_failure(void **state) {
  (void)state;
  struct fake f = {.unit = 1, .power = 3, .low = 1, .high = 1000, .fail_after = 2};
  struct cb_search s = search_of(&f, 500, 0);
  assert_int_equal(cb_search_run(&s), CB_INTERRUPTED);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_exact),   cmocka_unit_test(test_resolution),
      cmocka_unit_test(test_ends),    cmocka_unit_test(test_jump_and_nan),
      cmocka_unit_test(test_failure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
