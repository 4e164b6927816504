/* test_counter.c - executed operations: the paper's 72 + 60 and 14 + 5, products
 * as counted by hand, the same for every shape, each in its stage; and a counter
 * that the linker does not know is found out.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/counter.h"
#include "tests/variants.h"

/* A second counter, with names that no --wrap leads to: what a program has that
 * was linked without the flags. */
void detached_stage(int stage);
void detached_reset(void);
void detached_read(struct cb_counts *counts);
bool detached_works(void);
#define cb_counter_stage detached_stage
#define cb_counter_reset detached_reset
#define cb_counter_read detached_read
#define cb_counter_works detached_works
#define __wrap___addtf3 detached_addtf3
#define __wrap___subtf3 detached_subtf3
#define __wrap___multf3 detached_multf3
#define __wrap___divtf3 detached_divtf3
#define __wrap_sqrtq detached_sqrtq
#include "harness/verify/counter.c"
#undef cb_counter_stage
#undef cb_counter_reset
#undef cb_counter_read
#undef cb_counter_works

static void a_counter_out_of_reach_is_found_out(void **state) {
  (void)state;
  struct cb_counts before[STAGES], after[STAGES];
  cb_counter_reset();
  cb_counter_read(before);
  assert_true(cb_counter_works());
  assert_false(detached_works());
  cb_counter_read(after);
  before[STAGE_SCATTER] = after[STAGE_SCATTER]; /* the other one's were counted here */
  assert_memory_equal(before, after, sizeof before);
}

/* ---- counting ------------------------------------------------------------------ */

/* Of one warm update, then of one product. */
static void count(struct run *r, struct cb_counts update[STAGES],
                  struct cb_counts product[STAGES]) {
  cb_operator_update(r->op, r->x, NULL, 1, r->out);
  cb_counter_reset();
  cb_operator_update(r->op, r->x, NULL, 1, r->out);
  cb_counter_read(update);
  cb_counter_reset();
  cb_operator_product(r->op, r->u, r->out);
  cb_counter_read(product);
}

static void count_variant(const struct scene *s, const char *model, enum cb_storage storage,
                          bool ortho, struct cb_counts update[STAGES],
                          struct cb_counts product[STAGES]) {
  struct cb_variant v = {scene_model(scene_counted(), model), storage, scene_counted()};
  struct cb_material m = scene_material(ortho);
  struct run r;
  run_open(&r, s, &v, &m, 1);
  count(&r, update, product);
  run_close(&r);
}

static void assert_counts(const char *what, struct cb_counts c, unsigned mul, unsigned add,
                          unsigned div, unsigned sqrt) {
  if (c.mul != mul || c.add != add || c.div != div || c.sqrt != sqrt)
    fail_msg("%s: %lu mul %lu add %lu div %lu sqrt, expected %u %u %u %u", what, c.mul, c.add,
             c.div, c.sqrt, mul, add, div, sqrt);
}

static bool ends_with(const char *name, const char *end) {
  size_t n = strlen(name), k = strlen(end);
  return n >= k && strcmp(name + n - k, end) == 0;
}

/* Over current volume: 1/V by a product of three edges' parts (qr: on the diagonal),
 * a division, and twelve numbers scaled (qr: in their products). */
static void b_costs_what_the_paper_says(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_ONE);
  size_t updated = 0;
  for (const struct cb_model *const *m = scene_counted()->models; *m; m++)
    for (int ortho = 0; ortho < 2; ortho++) {
      const char *name = (*m)->name;
      struct cb_counts update[STAGES], product[STAGES], *b = update + STAGE_B;
      bool qr = strncmp(name, "qr-", 3) == 0;
      if (!(*m)->form[CB_EBE_PAPER][ortho].update) continue;
      count_variant(&s, name, CB_EBE_PAPER, ortho, update, product);
      if (ends_with(name, "-updated"))
        updated++, assert_counts(name, *b, qr ? 14 : 72, qr ? 5 : 60, 0, 0);
      else if (ends_with(name, "-updated-volume"))
        assert_counts(name, *b, qr ? 16 : 87, qr ? 5 : 62, 1, 0);
      else if (ends_with(name, "-lazy")) /* not moved: F, and the stretch to see that */
        assert_counts(name, *b, 54, 54, 0, 0);
      else
        assert_counts(name, *b, 0, 0, 0, 0);
    }
  assert_int_equal(updated, 2 * 8);
  scene_free(&s);
  gsl_rng_free(rng);
}

/* Counted by hand, isotropic: differences of edges 9; du w^T 27 + 18, stress 1 + 11,
 * times w 27 + 18, a's share 6; and so on. */
static void products_cost_what_their_formulas_say(void **state) {
  (void)state;
  static const struct {
    const char *model;
    enum cb_storage storage;
    unsigned mul, add;
  } table[] = {{"qr-updated", CB_EBE, 55, 62},
               {"svd-precomputed", CB_EBE, 55, 62},
               {"svd-updated", CB_EBE_CLUSTER, 55, 62},
               {"svd-updated", CB_EBE_RECOMPUTE, 82, 80},
               {"linear", CB_EBE, 55, 62},
               {"svd-updated", CB_EBE_PAPER, 145, 110},
               {"qr-updated", CB_EBE_PAPER, 127, 92},
               {"qr-precomputed", CB_EBE_PAPER, 127, 92},
               {"qr-updated", CB_EBE_MATRIX, 81, 96},
               {"green", CB_EBE_MATRIX, 81, 96},
               {"qr-updated", CB_CSR, 144, 156},
               {"linear", CB_CSR, 144, 156},
               {"svd-updated", CB_BCSR, 144, 156},
               {"svd-updated", CB_BCSR_SYMMETRIC, 144, 156}};
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_ONE);
  for (size_t n = 0; n < sizeof table / sizeof *table; n++) {
    struct cb_counts update[STAGES], product[STAGES];
    char name[96];
    count_variant(&s, table[n].model, table[n].storage, false, update, product);
    snprintf(name, sizeof name, "%s/%s", table[n].model, cb_storage_name[table[n].storage]);
    assert_counts(name, product[STAGE_PRODUCT], table[n].mul, table[n].add, 0, 0);
  }
  scene_free(&s);
  gsl_rng_free(rng);
}

/* Edges 9 additions; two dot products, reciprocal roots (a root, a division) and
 * lengths by them, and the rest of Gram-Schmidt, by hand. */
static void the_qr_frame_costs_what_its_formula_says(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_ONE);
  struct cb_counts update[STAGES], product[STAGES];
  count_variant(&s, "qr-updated", CB_EBE_PAPER, false, update, product);
  /* one more: is what is left of the second edge more than rounding of it? */
  assert_counts("qr frame", update[STAGE_FRAME], 35 + 1, 9 + 18, 2, 2);
  scene_free(&s);
  gsl_rng_free(rng);
}

static bool none(struct cb_counts c) { return !c.mul && !c.add && !c.div && !c.sqrt; }

/* An update leaves the product's stage alone and the other way round; frames
 * cost the same in every storage; only assembling storages assemble; each
 * vertex gets three additions in an element's scatter, and in that of a cluster. */
static void operations_belong_to_their_stage(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_ONE);
  for (const struct cb_model *const *m = scene_counted()->models; *m; m++)
    for (int ortho = 0; ortho < 2; ortho++) {
      struct cb_counts reference[STAGES], other[STAGES], update[STAGES], product[STAGES];
      if (!(*m)->form[CB_EBE][ortho].update) continue;
      count_variant(&s, (*m)->name, CB_EBE, ortho, reference, other);
      for (int storage = 0; storage < CB_STORAGES; storage++) {
        bool updated_b = strstr((*m)->name, "-updated") && storage == CB_EBE_PAPER;
        if (!(*m)->form[storage][ortho].update) continue;
        count_variant(&s, (*m)->name, (enum cb_storage)storage, ortho, update, product);
        assert_true(none(update[STAGE_PRODUCT]));
        for (int stage = STAGE_FRAME; stage < STAGE_PRODUCT; stage++)
          assert_true(none(product[stage]));
        assert_false(none(product[STAGE_PRODUCT]));
        bool clustered = storage == CB_EBE_CLUSTER || storage == CB_EBE_RECOMPUTE;
        assert_counts((*m)->name, update[STAGE_SCATTER], 0, clustered ? 24 : 12, 0, 0);
        if (storage >= CB_EBE_MATRIX && strcmp((*m)->name, "linear") != 0)
          assert_false(none(update[STAGE_ASSEMBLY]));
        if (storage < CB_EBE_MATRIX) assert_true(none(update[STAGE_ASSEMBLY]));
        /* the paper's B wants the vertices in local axes, done with the frame; qr needs
         * of them what Gram-Schmidt leaves, and e_d */
        struct cb_counts frame = reference[STAGE_FRAME];
        bool qr = strncmp((*m)->name, "qr-", 3) == 0;
        if (qr && storage == CB_EBE_PAPER && !ortho && strcmp((*m)->name, "qr-exact") != 0)
          frame.mul += 9, frame.add += 6;
        if (!updated_b || qr) assert_memory_equal(update + STAGE_FRAME, &frame, sizeof frame);
      }
    }
  scene_free(&s);
  gsl_rng_free(rng);
}

/* Upright shapes; of an inverted one polar-higham turns an axis, which costs. */
static void counts_do_not_depend_on_the_shape(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene one = scene_new(rng, SCENE_RANDOM), two = scene_new(rng, SCENE_RANDOM);
  size_t n = 3 * one.mesh.nodes;
  memcpy(two.mesh.tet, one.mesh.tet, 4 * one.mesh.tets * sizeof *one.mesh.tet);
  memcpy(two.mesh.X, one.mesh.X, n * sizeof *one.mesh.X);
  deform(rng, &two);
  assert_true(distance(n, one.x, two.x) > 1);
  for (const struct cb_model *const *m = scene_counted()->models; *m; m++)
    for (int ortho = 0; ortho < 2; ortho++)
      for (int storage = 0; storage < CB_STORAGES; storage++) {
        struct cb_counts a[2][STAGES], b[2][STAGES];
        if (!(*m)->form[storage][ortho].update || (*m)->knobs) continue; /* as far as needed */
        count_variant(&one, (*m)->name, (enum cb_storage)storage, ortho, a[0], a[1]);
        count_variant(&two, (*m)->name, (enum cb_storage)storage, ortho, b[0], b[1]);
        assert_memory_equal(a, b, sizeof a);
      }
  scene_free(&one);
  scene_free(&two);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_counter_out_of_reach_is_found_out),
      cmocka_unit_test(b_costs_what_the_paper_says),
      cmocka_unit_test(products_cost_what_their_formulas_say),
      cmocka_unit_test(the_qr_frame_costs_what_its_formula_says),
      cmocka_unit_test(operations_belong_to_their_stage),
      cmocka_unit_test(counts_do_not_depend_on_the_shape),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
