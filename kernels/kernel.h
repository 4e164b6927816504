/* kernel.h - the contract between element kernels and everything that uses
 * them: mesh and material, the descriptor of a model, the operator (a model
 * driven by a storage on a mesh) and the implicit step around it.
 *
 * A variant is model/storage/arithmetic, e.g. qr-updated/ebe/f64. Node vectors
 * are arrays of the arithmetic's own scalar, `stride` scalars a node (x, y, z
 * and zero padding); cb_arithmetic converts them from and to double.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_KERNEL_H
#define CB_KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Every function that can fail returns one of these; outputs are untouched
 * unless it is CB_OK. */
enum cb_status {
  CB_OK = 0,
  CB_INPUT,       /* the caller's data are unusable (exit status 2) */
  CB_MEMORY,      /* an allocation failed */
  CB_IO,          /* a file could not be read or written */
  CB_NUMERIC,     /* a matrix is not positive definite, a fit is singular */
  CB_INTERRUPTED, /* Ctrl-C */
  CB_BROKEN,      /* an expectation that the program checks does not hold */
  CB_UNMET        /* nothing does what is needed */
};

/* ---- mesh and material --------------------------------------------------- */

/* Linear tetrahedra. Either orientation is allowed, a zero rest volume is not
 * (checked by the readers, not here). */
struct cb_mesh {
  size_t nodes, tets;
  double *X;     /* 3*nodes rest positions, m, x y z of node 0 first */
  uint32_t *tet; /* 4*tets node indices, 0-based */
  double share;  /* fraction of its volume that each tetrahedron carries: 1, or
                    1/2 where two splits of the same cell are superposed */
};

/* Young's modulus, Poisson's ratio (isotropic) or engineering constants along
 * the world axes (orthotropic). Voigt order xx yy zz xy yz zx, engineering
 * shears (gamma = 2 eps). */
struct cb_material {
  bool orthotropic;
  double young, poisson; /* Pa, 1; isotropic only */
  double D[36];          /* stress-strain matrix, row-major, Pa; always set */
  double density;        /* kg/m^3 */
};

/* Fill *m. CB_INPUT when a parameter is not finite, young < 0, density <= 0,
 * poisson outside (-1, 1/2), or the orthotropic D is not positive definite.
 * young = 0 is allowed: the element is there and exerts nothing. */
enum cb_status cb_material_isotropic(double young, double poisson, double density,
                                     struct cb_material *m);
/* E[3] along x y z; nu[3] = nu_xy nu_yz nu_zx (strain in the second axis for
 * stress along the first, sign changed); G[3] = G_xy G_yz G_zx, Pa. */
enum cb_status cb_material_orthotropic(const double E[3], const double nu[3], const double G[3],
                                       double density, struct cb_material *m);

/* Six times the signed rest volume of tetrahedron e, det [b-a, c-a, d-a], m^3. */
double cb_mesh_six_volumes(const struct cb_mesh *mesh, size_t e);
/* mass[nodes] := a quarter of each adjacent element's mass, kg (lumped). */
void cb_mesh_mass(const struct cb_mesh *mesh, double density, double *mass);

/* ---- names on the three axes --------------------------------------------- */

/* How the stiffness product of each conjugate gradient iteration is done. */
enum cb_storage {
  CB_EBE_PAPER,      /* unassembled: R, B, D apart, the paper's chain */
  CB_EBE,            /* unassembled: world-frame gradients, no frame stored */
  CB_EBE_CLUSTER,    /* the same in clusters that share their nodes */
  CB_EBE_RECOMPUTE,  /* in clusters, gradients made of the positions in each product */
  CB_EBE_MATRIX,     /* unassembled: the element's stiffness matrix */
  CB_CSR,            /* assembled, scalar rows */
  CB_BCSR,           /* assembled, 3x3 blocks */
  CB_BCSR_SYMMETRIC, /* assembled, 3x3 blocks on and above the diagonal */
  CB_STORAGES
};
extern const char *const cb_storage_name[CB_STORAGES];
extern const char *const cb_storage_summary[CB_STORAGES];

/* Laws that a model claims to keep (PHYSICS: invariance, Newton, Euler, closed
 * path energy, vertex order, symmetric and positive semi-definite operator). */
enum cb_law {
  CB_LAW_ROTATION,
  CB_LAW_NEWTON,
  CB_LAW_EULER,
  CB_LAW_ENERGY,
  CB_LAW_ORDER,
  CB_LAW_SYMMETRIC,
  CB_LAW_SEMIDEFINITE,
  CB_LAW_TANGENT, /* the operator is the derivative of the force */
  CB_LAWS
};
extern const char *const cb_law_name[CB_LAWS];
#define CB_KEEPS(law) (1u << (law))

struct cb_team;     /* kernels/team.h */
struct cb_elements; /* one arithmetic's element arrays; kernels/elements.h */

/* One thread's part of out += h f(x) - c K(x) v over all elements (v NULL: out +=
 * h f(x)). All vectors are node vectors of the arithmetic; out must not overlap x
 * or v. Run by all threads of the operator's team at once. */
typedef void cb_update_fn(struct cb_elements *elements, size_t thread, const void *x, const void *v,
                          double h, void *out);
/* One thread's part of y += c K u with K from the last update; y must not overlap u. */
typedef void cb_product_fn(const struct cb_elements *elements, size_t thread, const void *u,
                           void *y);

/* What a storage of a model is made of; .update NULL: not offered. */
struct cb_form {
  cb_update_fn *update;
  cb_product_fn *product;
  uint16_t state_numbers; /* stored per element between update and product */
};

/* R[9*count] := frames of the deformation gradients F[9*count], row-major, both of the
 * arithmetic's scalar: those of elements that at rest have the unit vectors as edges.
 * Warm-started frames start cold for each. For every finite F they are finite rotations, or
 * reflections where the model says so. R must not overlap F. */
typedef void cb_frame_fn(size_t count, const void *F, void *R);

/* One model in one arithmetic. `laws[0]` isotropic, `laws[1]` orthotropic:
 * the claims that verify tests. */
struct cb_model {
  const char *name, *summary, *source;
  unsigned laws[2];
  uint8_t policy, axes;                /* enums of kernels/elements.h */
  uint8_t memory_numbers;              /* kept per element from one update to the next */
  uint8_t knobs;                       /* CB_KNOB_* that cb_operator_tune may turn */
  bool node_frames;                    /* one frame per node (node-warp) */
  bool keeps_rest;                     /* its products read rest data: they are stored */
  cb_frame_fn *frame;                  /* NULL: its elements have none */
  struct cb_form form[CB_STORAGES][2]; /* [storage][orthotropic] */
};

/* One arithmetic: its scalar, its lanes, its models. */
struct cb_arithmetic {
  const char *name;
  const char *needs;                    /* instruction set: "", "avx2", "avx512" */
  const char *flags;                    /* compiled with, beside the program's */
  size_t scalar_bytes, lanes, stride;   /* stride: scalars per node */
  double roundoff;                      /* unit roundoff of the scalar */
  const struct cb_model *const *models; /* NULL-terminated */
  void (*from_double)(size_t nodes, const double *xyz, void *vector); /* pads with 0 */
  void (*to_double)(size_t nodes, const void *vector, double *xyz);
  const struct cb_element_functions *elements; /* kernels/arithmetics.h */
  const struct cb_step_functions *step;
};
extern const struct cb_arithmetic *const cb_arithmetics[]; /* NULL-terminated; f64 first */
/* Does this processor have what it needs? Variants of the others are not listed
 * and must not be run. */
bool cb_arithmetic_runs(const struct cb_arithmetic *a);

struct cb_variant {
  const struct cb_model *model;
  enum cb_storage storage;
  const struct cb_arithmetic *arithmetic;
};
/* Every offered variant in a fixed order, NULL-terminated by model == NULL.
 * Static storage; count may be NULL. */
const struct cb_variant *cb_variants(size_t *count);
/* "model/storage/arithmetic" into name[96]. */
void cb_variant_name(const struct cb_variant *v, char name[96]);
/* The variant of exactly that name, or NULL. */
const struct cb_variant *cb_variant_find(const char *name);

/* ---- operator: a variant on a mesh --------------------------------------- */

struct cb_operator;

/* Build every array; nothing is allocated afterwards. c scales the product
 * (c K). Everything that the operator and its stepper do is done by so many
 * threads: 1 to 64 (kernels/team.h); for the same number of them results are the
 * same to the last bit. CB_MEMORY; CB_INPUT if the variant does not offer this
 * material, c is not > 0, the mesh has no tetrahedra, or threads are out of range. Free with
 * cb_operator_free (NULL allowed). The mesh and the material may go away, the variant (cb_variants:
 * static) may not. */
enum cb_status cb_operator_create(const struct cb_variant *variant, const struct cb_mesh *mesh,
                                  const struct cb_material *material, double c, size_t threads,
                                  struct cb_operator **out);
void cb_operator_free(struct cb_operator *op);

/* out := h f(x) - c K(x) v (v NULL: h f(x)); y := c K u. Whole vectors, by all
 * threads; see cb_update_fn, cb_product_fn. */
void cb_operator_update(struct cb_operator *op, const void *x, const void *v, double h, void *out);
void cb_operator_product(const struct cb_operator *op, const void *u, void *y);
/* Forget what warm-started frames remember: the next update starts cold. */
void cb_operator_reset(struct cb_operator *op);
/* Knobs of the models that have any (struct cb_model.knobs). */
enum { CB_KNOB_FRAME = 1, CB_KNOB_LAZY = 2 };
struct cb_tuning {
  size_t frame_iterations; /* at most so many; 0: the model's own number */
  double frame_tolerance;  /* a frame that moves by less in an iteration is done, 1 */
  double lazy;             /* B of elements whose stretch moved by less is kept, 1 */
};
/* From the next update on. CB_INPUT if the model has not the knob that is turned. */
enum cb_status cb_operator_tune(struct cb_operator *op, const struct cb_tuning *tuning);
/* Bytes really allocated, node vectors not included. */
size_t cb_operator_bytes(const struct cb_operator *op);
/* Nodes that an update reads and adds to, per tetrahedron: 4, or fewer in clusters. */
double cb_operator_visits(const struct cb_operator *op);
const struct cb_variant *cb_operator_variant(const struct cb_operator *op);
size_t cb_operator_nodes(const struct cb_operator *op);
struct cb_team *cb_operator_team(const struct cb_operator *op);
/* One thread's part of an update or a product, for a stepper that runs on the same
 * team: out and y are added to (cb_update_fn, cb_product_fn). */
void cb_operator_update_part(struct cb_operator *op, size_t thread, const void *x, const void *v,
                             double h, void *out);
void cb_operator_product_part(const struct cb_operator *op, size_t thread, const void *u, void *y);

/* Block pattern of a csr or bcsr operator, and its numbers as 3x3 blocks (for
 * the direct solver): *rows = nodes, row_start[nodes+1], column[blocks].
 * blocks[9*count] receives c K of the last update as double (zero before the
 * first). Only for CB_CSR and CB_BCSR. */
void cb_operator_pattern(const struct cb_operator *op, const uint32_t **row_start,
                         const uint32_t **column);
void cb_operator_blocks(const struct cb_operator *op, double *blocks);

/* ---- one implicit step ---------------------------------------------------- */

/* Backward Euler, linearised once a step (Baraff & Witkin 1998, eq. 6):
 *   (M - h C' - h^2 K') dv = h (f + h K' v),  C = alpha K + beta M,
 * that is, with c = h (h + alpha), the c of cb_operator_create:
 *   ((1 + h beta) M + c K) dv = h (f + f_ext) - c K v - h beta M v. */
struct cb_step_parameters {
  double h;           /* s */
  double alpha, beta; /* Rayleigh damping: s, 1/s */
  size_t iterations;  /* of conjugate gradients; see cb_stepper_ended */
};
static inline double cb_step_scale(const struct cb_step_parameters *p) {
  return p->h * (p->h + p->alpha);
}

struct cb_stepper;
/* op is used, not owned, and was created with c = cb_step_scale(p). mass[nodes]
 * in kg; fixed[nodes] nonzero keeps that node where it is, exactly, and sets its
 * velocity to zero (NULL: none). A node without mass must be fixed or carry no
 * load: not checked. CB_MEMORY. */
enum cb_status cb_stepper_create(struct cb_operator *op, const struct cb_step_parameters *p,
                                 const double *mass, const uint8_t *fixed, struct cb_stepper **out);
void cb_stepper_free(struct cb_stepper *s);
void cb_stepper_set_iterations(struct cb_stepper *s, size_t iterations);
/* x, v := after one step. f_ext: external force, N, or NULL. Node vectors. */
void cb_stepper_step(struct cb_stepper *s, void *x, void *v, const void *f_ext);
/* The parts of a step, to be timed apart, in this order: */
void cb_stepper_right_side(struct cb_stepper *s, const void *x, const void *v, const void *f_ext);
void cb_stepper_solve(struct cb_stepper *s);
void cb_stepper_advance(struct cb_stepper *s, void *x, void *v);

/* Why conjugate gradients stopped, and after how many steps. Whatever the operator and
 * the right-hand side, dv is finite, and the quadratic form 1/2 dv.A dv - b.dv, which each
 * step lessens, is not above its value for dv = 0. Nodes without mass and stiffness that
 * carry a load are found at the latest when all else is solved; their dv means nothing. */
enum cb_ending {
  CB_ENDED_ITERATIONS, /* all that were asked for */
  CB_ENDED_SOLVED,     /* the residual is zero to rounding; the other iterations run, for equal
                          times, and change nothing */
  CB_ENDED_INDEFINITE, /* p.A p <= 0, or nothing beside an earlier one: A is not positive
                          definite to rounding. dv is what was there before; in the first
                          iteration b times b.b / max(|b.A b|, b.M b) */
  CB_ENDED_OVERFLOW    /* b, p.A p or dv would not be finite: dv is what was there before, or 0 */
};
struct cb_ended {
  enum cb_ending why;
  size_t iterations; /* that changed dv */
};
/* Of the last cb_stepper_solve or cb_stepper_step; no iterations before the first. */
struct cb_ended cb_stepper_ended(const struct cb_stepper *s);
/* Right-hand side and last solution (node vectors of the arithmetic). */
const void *cb_stepper_b(const struct cb_stepper *s);
const void *cb_stepper_dv(const struct cb_stepper *s);
size_t cb_stepper_bytes(const struct cb_stepper *s);

#endif
