/* registry.c - every variant model/storage/arithmetic that this binary offers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "kernels/arithmetics.h"

CB_DECLARE_ARITHMETIC(f64)
CB_DECLARE_ARITHMETIC(f32)
CB_DECLARE_ARITHMETIC(f64x4)
CB_DECLARE_ARITHMETIC(f64x8)
CB_DECLARE_ARITHMETIC(f32x8)
CB_DECLARE_ARITHMETIC(f32x16)
CB_DECLARE_ARITHMETIC(counted)
const struct cb_arithmetic *const cb_arithmetics[] = {
    &cb_arithmetic_f64,   &cb_arithmetic_f32,    &cb_arithmetic_f64x4,   &cb_arithmetic_f64x8,
    &cb_arithmetic_f32x8, &cb_arithmetic_f32x16, &cb_arithmetic_counted, NULL};

bool cb_arithmetic_runs(const struct cb_arithmetic *a) {
#if defined(__x86_64__)
  if (strcmp(a->needs, "avx2") == 0)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (strcmp(a->needs, "avx512") == 0)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
#endif
  return a->needs[0] == '\0';
}

const char *const cb_storage_name[CB_STORAGES] = {"ebe-paper",     "ebe",           "ebe-cluster",
                                                  "ebe-recompute", "ebe-matrix",    "csr",
                                                  "bcsr",          "bcsr-symmetric"};
const char *const cb_storage_summary[CB_STORAGES] = {
    "unassembled: R, B and D apart, the paper's chain",
    "unassembled: world-frame gradients, no frame stored",
    "the same in clusters of neighbours that share their nodes",
    "in clusters, gradients made of positions in each product",
    "unassembled: element stiffness matrix, six 3x3 blocks",
    "assembled: compressed scalar rows",
    "assembled: compressed rows of 3x3 blocks",
    "assembled: the same without the blocks below the diagonal",
};
const char *const cb_law_name[CB_LAWS] = {"rotation", "newton",    "euler",         "energy",
                                          "order",    "symmetric", "semi-definite", "tangent"};

enum { MOST = 4096 };
static struct cb_variant variants[MOST + 1];
static size_t variant_count;

static void list_variants(void) {
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++)
    for (const struct cb_model *const *m = (*a)->models; *m && cb_arithmetic_runs(*a); m++)
      for (int s = 0; s < CB_STORAGES; s++)
        if ((*m)->form[s][0].update) {
          assert(variant_count < MOST);
          variants[variant_count++] = (struct cb_variant){*m, (enum cb_storage)s, *a};
        }
}

const struct cb_variant *cb_variants(size_t *count) {
  if (variant_count == 0) list_variants();
  if (count) *count = variant_count;
  return variants;
}

void cb_variant_name(const struct cb_variant *v, char name[96]) {
  snprintf(name, 96, "%s/%s/%s", v->model->name, cb_storage_name[v->storage], v->arithmetic->name);
}

const struct cb_variant *cb_variant_find(const char *name) {
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    char own[96];
    cb_variant_name(v, own);
    if (strcmp(own, name) == 0) return v;
  }
  return NULL;
}
