/* verb_force.c - `corobench force`: the elastic force on every node of a
 * deformed mesh, to be held against another simulator's.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/files/output.h"
#include "harness/progress.h"
#include "harness/verbs/verbs.h"

static const char doc[] =
    "Write the elastic force (N, the one that restores the rest shape) on every node of a deformed "
    "mesh, as CSV with the header node,fx,fy,fz and 17 digits, nodes numbered as in the mesh file: "
    "to standard output, or with --output to DIR/force.csv."
    "\vThe material is isotropic. A model that remembers its frames from the last step starts "
    "cold, without any memory. Nothing is written unless every force is finite.";

enum { KEY_POSITIONS = 1, KEY_YOUNG, KEY_POISSON };
static const struct argp_option own_options[] = {
    {"positions", KEY_POSITIONS, "FILE", 0, "CSV with the header node,x,y,z: deformed positions, m",
     0},
    {"young", KEY_YOUNG, "E", 0, "Young's modulus, Pa", 0},
    {"poisson", KEY_POISSON, "NU", 0, "Poisson's ratio, in (-1, 1/2)", 0},
    {0}};

struct request {
  const char *positions;
  double young, poisson; /* NaN: not given */
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *r = state->input;
  enum cb_status status = CB_OK;
  switch (key) {
  case KEY_POSITIONS: r->positions = text; break;
  case KEY_YOUNG: status = cb_parse_number("--young", text, -DBL_MAX, DBL_MAX, &r->young); break;
  case KEY_POISSON:
    status = cb_parse_number("--poisson", text, -DBL_MAX, DBL_MAX, &r->poisson);
    break;
  default: return ARGP_ERR_UNKNOWN;
  }
  return status == CB_OK ? 0 : EINVAL;
}

static enum cb_status check_complete(const struct request *r, const struct cb_options *o) {
  const char *missing = !o->glob_count      ? "--variant"
                        : !o->mesh_path     ? "--mesh"
                        : !r->positions     ? "--positions"
                        : isnan(r->young)   ? "--young"
                        : isnan(r->poisson) ? "--poisson"
                                            : NULL;
  if (!missing && o->threads.count > 1)
    return cb_fail(CB_INPUT, "force is computed once: give --threads one number, not a list");
  if (!missing) return CB_OK;
  return cb_fail(CB_INPUT, "force needs %s; see 'corobench force --help'", missing);
}

static enum cb_status the_material(const struct request *r, struct cb_material *material) {
  const double any_density = 1; /* the elastic force does not depend on it */
  if (cb_material_isotropic(r->young, r->poisson, any_density, material) == CB_OK) return CB_OK;
  return cb_fail(
      CB_INPUT,
      "--young %g with --poisson %g is no isotropic material: Young's modulus must be at "
      "least 0 and Poisson's ratio inside (-1, 1/2)",
      r->young, r->poisson);
}

static enum cb_status the_variant(const struct cb_options *o, const struct cb_variant **chosen) {
  const struct cb_variant *first = NULL, *second = NULL;
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !second; v++) {
    if (!cb_options_selects(o, v)) continue;
    if (first)
      second = v;
    else
      first = v;
  }
  if (second) {
    char a[96], b[96];
    cb_variant_name(first, a);
    cb_variant_name(second, b);
    return cb_fail(CB_INPUT,
                   "force needs exactly one variant, and --variant selects several: '%s', '%s' and "
                   "maybe more; write one in full",
                   a, b);
  }
  *chosen = first;
  return CB_OK;
}

/* A node vector of the variant's arithmetic, aligned for any lanes. */
static void *vector_create(const struct cb_arithmetic *a, size_t nodes) {
  enum { LINE = 64 };
  size_t node_bytes = a->stride * a->scalar_bytes;
  if (nodes > (SIZE_MAX - LINE) / node_bytes) return NULL;
  return aligned_alloc(LINE, (nodes * node_bytes + LINE - 1) / LINE * LINE);
}

/* xyz[3*nodes]: positions in, elastic forces out. */
static enum cb_status evaluate(const struct cb_variant *variant, size_t threads,
                               const struct cb_mesh *mesh, const struct cb_material *material,
                               double *xyz) {
  const struct cb_arithmetic *arithmetic = variant->arithmetic;
  struct cb_operator *op = NULL;
  void *x = vector_create(arithmetic, mesh->nodes), *f = vector_create(arithmetic, mesh->nodes);
  enum cb_status status =
      x && f ? cb_operator_create(variant, mesh, material, 1, threads, &op) : CB_MEMORY;
  if (status != CB_OK) {
    status = status == CB_MEMORY ? cb_fail_memory("the element arrays")
                                 : cb_fail(status, "this variant is not offered for this material "
                                                   "or the mesh has no tetrahedron");
    goto done;
  }
  arithmetic->from_double(mesh->nodes, xyz, x);
  cb_operator_update(op, x, NULL, 1, f);
  arithmetic->to_double(mesh->nodes, f, xyz);
done:
  cb_operator_free(op);
  free(f);
  free(x);
  return status;
}

static enum cb_status check_finite(const double *f, size_t nodes, const long long *numbers) {
  for (size_t i = 0; i < 3 * nodes; i++)
    if (!isfinite(f[i]))
      return cb_fail(CB_NUMERIC,
                     "the force on node %lld is not a finite number: this variant cannot handle "
                     "the shape of a tetrahedron there; try another --variant",
                     numbers[i / 3]);
  return CB_OK;
}

static enum cb_status write_forces(const double *f, size_t nodes, const long long *numbers,
                                   const char *directory) {
  struct cb_table *table = cb_table_create("node,fx,fy,fz");
  if (!table) return cb_fail_memory("the table of forces");
  for (size_t i = 0; i < nodes; i++) {
    cb_table_integer(table, numbers[i]);
    for (size_t k = 0; k < 3; k++) cb_table_number(table, f[3 * i + k]);
  }
  enum cb_status status = CB_OK;
  if (!directory || strcmp(directory, "-") == 0)
    status = cb_table_print(table, CB_CSV, stdout);
  else if ((status = cb_output_directory(directory)) == CB_OK)
    status = cb_output_table(directory, "force.csv", table, CB_CSV);
  cb_table_free(table);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct request r = {.young = NAN, .poisson = NAN};
  struct cb_options o;
  const struct cb_variant *variant = NULL;
  struct cb_material material;
  struct cb_mesh mesh = {0};
  long long *numbers = NULL;
  double *xyz = NULL;
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_MESH | CB_OPT_OUTPUT | CB_OPT_THREADS,
                       doc, own_options, parse, &r, &o);
  if (status != CB_OK || (status = check_complete(&r, &o)) != CB_OK ||
      (status = the_variant(&o, &variant)) != CB_OK ||
      (status = the_material(&r, &material)) != CB_OK ||
      (status = cb_mesh_read(o.mesh_path, &mesh, &numbers)) != CB_OK)
    goto done;
  xyz = calloc(mesh.nodes, 3 * sizeof *xyz);
  if (!xyz) {
    status = cb_fail_memory("the positions");
    goto done;
  }
  if ((status = cb_positions_read(r.positions, &mesh, numbers, xyz)) != CB_OK ||
      (status = evaluate(variant, o.threads.count ? o.threads.of[0] : 1, &mesh, &material, xyz)) !=
          CB_OK ||
      (status = check_finite(xyz, mesh.nodes, numbers)) != CB_OK)
    goto done;
  status = cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted; no force was written")
                            : write_forces(xyz, mesh.nodes, numbers, o.output);
done:
  free(xyz);
  free(numbers);
  cb_mesh_free(&mesh);
  return status;
}

const struct cb_verb cb_verb_force = {"force", "elastic forces on the nodes of a deformed mesh",
                                      run};
