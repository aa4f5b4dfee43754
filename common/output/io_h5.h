/* SPDX-License-Identifier: GPL-3.0-or-later */
/* State files in HDF5: one dataset a field, of shape (rows, width), with the attributes unit,
 * meaning and shape; texts that tell where the state comes from under /provenance. */
#ifndef BRC_IO_H5_H
#define BRC_IO_H5_H

#include "common/output/h5.h"
#include "common/engine/state.h"

/* A text of the group /provenance. */
struct brc_h5_text {
    const char *name, *text;
};

/* What is saved beside the simulation: texts, and parts of the caller's own (times of the run, the
 * list of frames), which are loaded again but not part of the state's hash. */
struct brc_h5_extra {
    const struct brc_h5_text *texts;
    int n_texts;
    struct brc_state_part *parts;
    int n_parts;
};

/* Writes the whole state with version, compiler, model and state hash. The file appears at path
 * complete or not at all: it is written beside it, sealed, forced to disk and renamed. Point ranges
 * are packed for it. */
int brc_h5_save(struct brc_context *ctx, const char *path, struct brc_sim *sim,
                const struct brc_h5_extra *extra);
/* Texts of /provenance, after the program's name, version and compiler. */
int brc_h5_put_provenance(const struct brc_h5_file *f, const struct brc_h5_text *texts, int n);
/* Replaces the state of a simulation that was created from the same case. A file that is not as it
 * was saved is refused before HDF5 sees it; one of another model, another specimen or other fields
 * is an error, too. */
int brc_h5_load(struct brc_context *ctx, const char *path, struct brc_sim *sim,
                const struct brc_h5_extra *extra);
/* Replaces the rows of one table, a part as brc_state_list gives it, by those of a file; needs
 * neither the case nor its specimen. */
int brc_h5_load_table(struct brc_context *ctx, const char *path, struct brc_state_part *part);
/* A text of /provenance; *text is allocated, to be freed by the caller. */
int brc_h5_read_text(struct brc_context *ctx, const char *path, const char *name, char **text);

#endif
