/* vtk.c - see vtk.h.
 * Source: The VTK user's guide, 11th ed., "VTK file formats".
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/vtk.h"

#include <stdio.h>

#include "harness/files/output.h"

void cb_vtk_name(const char *name, size_t number, char text[128]) {
  snprintf(text, 128, "%.100s-%04zu", name, number);
}

/* Six times the volume at x. */
static double six_volumes(const struct cb_mesh *mesh, size_t e, const double *x) {
  double u[9];
  for (size_t j = 0; j < 9; j++)
    u[j] = x[3 * mesh->tet[4 * e + 1 + j / 3] + j % 3] - x[3 * mesh->tet[4 * e] + j % 3];
  return u[0] * (u[4] * u[8] - u[5] * u[7]) + u[1] * (u[5] * u[6] - u[3] * u[8]) +
         u[2] * (u[3] * u[7] - u[4] * u[6]);
}

enum cb_status cb_vtk_write(const char *directory, const char *name, const struct cb_mesh *mesh,
                            const double *x) {
  enum { TETRAHEDRON = 10 }; /* VTK's cell type */
  struct cb_output o;
  char file[160];
  snprintf(file, sizeof file, "%s.vtu", name);
  enum cb_status status = cb_output_open(&o, directory, file);
  if (status) return status;
  FILE *f = o.stream;
  fprintf(f,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n"
          "<UnstructuredGrid>\n<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n"
          "<Points>\n<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">\n",
          mesh->nodes, mesh->tets);
  for (size_t i = 0; i < mesh->nodes; i++)
    fprintf(f, "%.7g %.7g %.7g\n", x[3 * i], x[3 * i + 1], x[3 * i + 2]);
  fputs("</DataArray>\n</Points>\n<Cells>\n"
        "<DataArray type=\"UInt32\" Name=\"connectivity\" format=\"ascii\">\n",
        f);
  for (size_t e = 0; e < mesh->tets; e++) {
    const uint32_t *t = mesh->tet + 4 * e;
    fprintf(f, "%u %u %u %u\n", t[0], t[1], t[2], t[3]);
  }
  fputs("</DataArray>\n<DataArray type=\"UInt32\" Name=\"offsets\" format=\"ascii\">\n", f);
  for (size_t e = 0; e < mesh->tets; e++) fprintf(f, "%zu\n", 4 * (e + 1));
  fputs("</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n", f);
  for (size_t e = 0; e < mesh->tets; e++) fprintf(f, "%d\n", TETRAHEDRON);
  fputs("</DataArray>\n</Cells>\n<CellData Scalars=\"volume\">\n"
        "<DataArray type=\"Float32\" Name=\"volume\" format=\"ascii\">\n",
        f);
  for (size_t e = 0; e < mesh->tets; e++)
    fprintf(f, "%.5g\n", six_volumes(mesh, e, x) / cb_mesh_six_volumes(mesh, e));
  fputs("</DataArray>\n</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n", f);
  return cb_output_commit(&o);
}

enum cb_status cb_vtk_series(const char *directory, const char *name, size_t count,
                             const double *times) {
  struct cb_output o;
  char file[160];
  snprintf(file, sizeof file, "%.100s.pvd", name);
  enum cb_status status = cb_output_open(&o, directory, file);
  if (status) return status;
  fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
        o.stream);
  for (size_t n = 0; n < count; n++) {
    char moment[128];
    cb_vtk_name(name, n, moment);
    fprintf(o.stream, "<DataSet timestep=\"%.9g\" file=\"%s.vtu\"/>\n", times[n], moment);
  }
  fputs("</Collection>\n</VTKFile>\n", o.stream);
  return cb_output_commit(&o);
}
