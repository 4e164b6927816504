/* corotated_forms.h - one corotated model: its storages, isotropic and orthotropic, from
 * the element functions of corotated.h, which includes this.
 *
 * SPDX-License-Identifier: BSD-3-Clause */

/* Isotropic elements in clusters are what is timed: their work is inlined. */
#define CLUSTER_UPDATE_iso(ID, POLICY, EXACT)                                                      \
  INLINE bool ID##_quick(const struct cb_elements *E, size_t count, const struct slot *s, T h) {   \
    return corotated_quick(E, POLICY, EXACT, count, s, h);                                         \
  }                                                                                                \
  STORAGE_CLUSTER(ID, iso, update_clusters_quickly, ID##_quick, FRAMES_AT_ONCE, ID##_ebe_iso)
#define CLUSTER_UPDATE_ortho(ID, POLICY, EXACT)                                                    \
  STORAGE_CLUSTER(ID, ortho, drive_update_clusters, ID##_ebe_ortho)

/* Functions of model ID with the element functions bound to constants. */
#define COROTATED_PACKS(ID, POLICY, EXACT, ORTHO, TAG)                                             \
  PACK_LINKAGE void ID##_pack_##TAG(const struct cb_elements *E, const T *r, const T *e,           \
                                    const T *own, const T *ev, T h, T *m, T *R, T *w, T *f) {      \
    corotated_pack(E, POLICY, EXACT, ORTHO, r, e, own, ev, h, m, R, w, f);                         \
  }                                                                                                \
  INLINE void ID##_ebe_##TAG(const struct cb_elements *E, const T *r, const T *e, const T *own,    \
                             const T *ev, T h, T *m, T *s, T *f) {                                 \
    corotated_ebe(E, ID##_pack_##TAG, POLICY, ORTHO, r, e, own, ev, h, m, s, f);                   \
  }                                                                                                \
  STORAGE_EBE(ID, TAG)                                                                             \
  CLUSTER_UPDATE_##TAG(ID, POLICY, EXACT)

#define COROTATED_FORM(ID, POLICY, EXACT, ORTHO, TAG)                                              \
  COROTATED_PACKS(ID, POLICY, EXACT, ORTHO, TAG)                                                   \
  INLINE void ID##_blocks_##TAG(const struct cb_elements *E, const T *r, const T *e, const T *own, \
                                const T *ev, T h, T *m, T *X, T *f) {                              \
    corotated_blocks(E, ID##_pack_##TAG, ORTHO, r, e, own, ev, h, m, X, f);                        \
  }                                                                                                \
  INLINE void ID##_terms_##TAG(const struct cb_elements *E, const T *r, const T *e, const T *own,  \
                               const T *ev, T h, T *m, T *X, T *f) {                               \
    if (ORTHO)                                                                                     \
      ID##_blocks_##TAG(E, r, e, own, ev, h, m, X, f);                                             \
    else                                                                                           \
      corotated_gradients(E, ID##_pack_##TAG, r, e, own, ev, h, m, X, f);                          \
  }                                                                                                \
  STORAGE_BLOCKS(ID, TAG, !(ORTHO))                                                                \
  STORAGE_ASSEMBLED(ID, TAG, ID##_terms_##TAG, (ORTHO) ? TERMS_BLOCKS : TERMS_GRADIENTS)

#define COROTATED_PRODUCT(ID, POLICY, TAG)                                                         \
  INLINE void ID##_ebe_product_##TAG(const struct cb_elements *E, const T *r, const T *s,          \
                                     const T *u, T *f) {                                           \
    corotated_ebe_product(E, POLICY, r, s, u, f);                                                  \
  }                                                                                                \
  STORAGE_EBE_PRODUCT(ID, TAG)                                                                     \
  STORAGE_CLUSTER_PRODUCT(ID, TAG, drive_product_clusters)

#define COROTATED_PAPER(ID, POLICY, EXACT, ORTHO, TAG)                                             \
  INLINE void ID##_paper_##TAG(const struct cb_elements *E, const T *r, const T *e, const T *own,  \
                               const T *ev, T h, T *m, T *s, T *f) {                               \
    corotated_paper(E, POLICY, EXACT, ORTHO, r, e, own, ev, h, m, s, f);                           \
  }                                                                                                \
  INLINE void ID##_paper_product_##TAG(const struct cb_elements *E, const T *r, const T *s,        \
                                       const T *u, T *f) {                                         \
    corotated_paper_product(E, POLICY, ORTHO, r, s, u, f);                                         \
  }                                                                                                \
  STORAGE_PAPER(ID, TAG)

/* What a model keeps between update and product, per storage. */
#define COROTATED_STATE_EBE(POLICY, ORTHO) (!(ORTHO) ? 9 : (POLICY) == POLICY_PRECOMPUTED ? 9 : 18)
#define COROTATED_STATE_PAPER(POLICY) ((POLICY) == POLICY_PRECOMPUTED ? 9 : SPARSE ? 18 : 21)

#if CB_LANES == 1
#define COROTATED_PAPERS(ID, POLICY, EXACT)                                                        \
  COROTATED_PAPER(ID, POLICY, EXACT, 0, iso)                                                       \
  COROTATED_PAPER(ID, POLICY, EXACT, 1, ortho)
#define COROTATED_PAPER_FORMS(ID, POLICY)                                                          \
  {                                                                                                \
    FORM_PAPER(ID, iso, COROTATED_STATE_PAPER(POLICY)),                                            \
        FORM_PAPER(ID, ortho, COROTATED_STATE_PAPER(POLICY))                                       \
  }
#else /* the paper's chain is what lanes are held against */
#define COROTATED_PAPERS(ID, POLICY, EXACT)
#define COROTATED_PAPER_FORMS(ID, POLICY)                                                          \
  {                                                                                                \
    {NULL, NULL, 0}, { NULL, NULL, 0 }                                                             \
  }
#endif

/* Gradients are functions of the positions alone where B is updated. */
#define COROTATED_RECOMPUTE_FORM(ID, POLICY)                                                       \
  (POLICY) == POLICY_PRECOMPUTED ? NULL : ID##_cluster_update_iso,                                 \
      (POLICY) == POLICY_PRECOMPUTED ? NULL : CB_NAME(cb_product_recompute), 1

#define COROTATED(ID, POLICY, EXACT)                                                               \
  COROTATED_FORM(ID, POLICY, EXACT, 0, iso)                                                        \
  COROTATED_FORM(ID, POLICY, EXACT, 1, ortho)                                                      \
  COROTATED_PRODUCT(ID, POLICY, ortho)                                                             \
  COROTATED_PAPERS(ID, POLICY, EXACT)

#define COROTATED_FORMS(ID, POLICY)                                                                \
  {                                                                                                \
    [CB_EBE_PAPER] = COROTATED_PAPER_FORMS(ID, POLICY),                                            \
    [CB_EBE] = {FORM_EBE_SHARED(ID, iso, COROTATED_STATE_EBE(POLICY, 0)),                          \
                FORM_EBE(ID, ortho, COROTATED_STATE_EBE(POLICY, 1))},                              \
    [CB_EBE_CLUSTER] = {FORM_CLUSTER_SHARED(ID, iso),                                              \
                        FORM_CLUSTER(ID, ortho, COROTATED_STATE_EBE(POLICY, 1))},                  \
    [CB_EBE_RECOMPUTE] = {{COROTATED_RECOMPUTE_FORM(ID, POLICY)}, {NULL, NULL, 0}},                \
    [CB_EBE_MATRIX] = {FORM_MATRIX(ID, iso), FORM_MATRIX(ID, ortho)},                              \
    [CB_CSR] = FORMS_CSR(ID, TERMS_GRADIENTS, TERMS_BLOCKS),                                       \
    [CB_BCSR] = FORMS_BCSR(ID, TERMS_GRADIENTS, TERMS_BLOCKS),                                     \
    [CB_BCSR_SYMMETRIC] = FORMS_BCSR_SYMMETRIC(ID, TERMS_GRADIENTS, TERMS_BLOCKS),                 \
  }

/* ID: C stem of the model; NAME, SUMMARY, SOURCE: strings; AXES, MEMORY: see
 * struct cb_model; LAWS_ISO, LAWS_ORTHO: claimed laws. EXACT: P is not
 * symmetric, isotropic either. */
#define COROTATED_MODEL(ID, NAME, SUMMARY, SOURCE, POLICY, AXES, MEMORY, EXACT, LAWS_ISO,          \
                        LAWS_ORTHO)                                                                \
  COROTATED(ID, POLICY, EXACT)                                                                     \
  const struct cb_model CB_NAME(cb_model_##ID) = {.name = NAME,                                    \
                                                  .summary = SUMMARY,                              \
                                                  .source = SOURCE,                                \
                                                  .laws = {LAWS_ISO, LAWS_ORTHO},                  \
                                                  .policy = POLICY,                                \
                                                  .axes = AXES,                                    \
                                                  .memory_numbers = MEMORY,                        \
                                                  .frame = FRAMES,                                 \
                                                  .form = COROTATED_FORMS(ID, POLICY)};

/* A model of isotropic elements for which neither speed in clusters nor assembling is
 * of interest: ebe, and scalar ebe-paper. */
#define COROTATED_TUNED(ID, NAME, SUMMARY, SOURCE, POLICY, MEMORY, KNOBS, LAWS_ISO)                \
  COROTATED_PACKS(ID, POLICY, 0, 0, iso)                                                           \
  COROTATED_TUNED_PAPER(ID, POLICY)                                                                \
  const struct cb_model CB_NAME(cb_model_##ID) = {                                                 \
      .name = NAME,                                                                                \
      .summary = SUMMARY,                                                                          \
      .source = SOURCE,                                                                            \
      .laws = {LAWS_ISO, 0},                                                                       \
      .policy = (POLICY) == POLICY_PRECOMPUTED ? POLICY_PRECOMPUTED : POLICY_UPDATED,              \
      .axes = SPARSE ? AXES_EDGES : AXES_WORLD,                                                    \
      .memory_numbers = MEMORY,                                                                    \
      .frame = FRAMES,                                                                             \
      .knobs = KNOBS,                                                                              \
      .form = {[CB_EBE_PAPER] = COROTATED_TUNED_FORM(ID, POLICY),                                  \
               [CB_EBE] = {FORM_EBE_SHARED(ID, iso, 9), {NULL, NULL, 0}},                          \
               [CB_EBE_CLUSTER] = {FORM_CLUSTER_SHARED(ID, iso), {NULL, NULL, 0}}}};
#if CB_LANES == 1
#define COROTATED_TUNED_PAPER(ID, POLICY) COROTATED_PAPER(ID, POLICY, 0, 0, iso)
#define COROTATED_TUNED_FORM(ID, POLICY)                                                           \
  {                                                                                                \
    FORM_PAPER(ID, iso, COROTATED_STATE_PAPER(POLICY)), { NULL, NULL, 0 }                          \
  }
#else
#define COROTATED_TUNED_PAPER(ID, POLICY)
#define COROTATED_TUNED_FORM(ID, POLICY)                                                           \
  {                                                                                                \
    {NULL, NULL, 0}, { NULL, NULL, 0 }                                                             \
  }
#endif

/* The three policies of one frame. UPDATED: laws of both updated ones, for
 * either material. */
#define COROTATED_FAMILY(STEM, NAME, TEXT, SOURCE, AXES, MEMORY, REST_ISO, REST_ORTHO, UPDATED)    \
  COROTATED_MODEL(STEM##_precomputed, NAME "-precomputed", TEXT ", rest B", SOURCE,                \
                  POLICY_PRECOMPUTED, AXES, MEMORY, 0, REST_ISO, REST_ORTHO)                       \
  COROTATED_MODEL(STEM##_updated, NAME "-updated", TEXT ", current B over rest volume", SOURCE,    \
                  POLICY_UPDATED, AXES, MEMORY, 0, UPDATED, UPDATED)                               \
  COROTATED_MODEL(STEM##_updated_volume, NAME "-updated-volume",                                   \
                  TEXT ", current B over current volume", SOURCE, POLICY_UPDATED_VOLUME, AXES,     \
                  MEMORY, 0, UPDATED, UPDATED)
