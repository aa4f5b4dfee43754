/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes as VTKHDF files, version 1.0, which VTK from 9.1 and ParaView from 5.10 on read as they
 * are. For frames.c; knows meshes and tables, no simulation. */
#ifndef BRC_VTK_H
#define BRC_VTK_H

#include "common/output/io_h5.h"
#include "common/output/mesh.h"

/* Writes a mesh with the values of its cells, and one row of the table `whole` as values of the
 * whole; texts go to /provenance, which VTK passes over. The file appears complete or not at all.
 */
int brc_vtk_save(struct brc_context *ctx, const char *path, const struct brc_mesh *m,
                 const struct brc_table *whole, size_t row, const struct brc_h5_text *texts,
                 int n_texts);
/* "grains_00120.hdf" for the prefix grains and step 120. */
void brc_vtk_name(char *name, size_t size, const char *prefix, int64_t step);

#endif
