/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 as this program uses it: groups, texts, and arrays of rows that carry unit, meaning and
 * shape. h5.c is the only file with hdf5.h. */
#ifndef BRC_H5_H
#define BRC_H5_H

#include "common/base/table.h"
#include "common/output/checksum_header.h"

/* A file being written or read; ctx and path are for messages and must live as long. The handle is
 * a plain number here, so that nobody else needs HDF5's headers. */
struct brc_h5_file {
    struct brc_context *ctx;
    const char *path;
    int64_t id;
    const struct brc_checksum_kind *header;
};

/* A dataset of shape (rows, width), or (rows) where is_flat says so: VTK wants scalars flat, states
 * keep one shape for all fields. Texts may be NULL: then the dataset has no such attribute. */
struct brc_h5_array {
    const char *name; /* path in the file */
    enum brc_type type;
    size_t rows;
    int width;
    bool is_flat;
    const char *unit, *meaning;
    const char *row; /* what a row is, for the attribute `shape` */
};

/* Writes into memory; brc_h5_finish header that, writes it beside path, PATH.part, forces it to
 * disk and renames it, or after a failure (code != 0, which it returns) removes it. So the file
 * appears complete or not at all, and HDF5 never meets a full disk. */
int brc_h5_create(struct brc_context *ctx, const char *path, const struct brc_checksum_kind *header,
                  struct brc_h5_file *f);
int brc_h5_finish(struct brc_h5_file *f, int code);
/* A file that is not as it was written is refused before HDF5 sees it: HDF5 does not stand damaged
 * files. */
int brc_h5_open(struct brc_context *ctx, const char *path, const struct brc_checksum_kind *header,
                struct brc_h5_file *f);
void brc_h5_close(struct brc_h5_file *f);

int brc_h5_put_group(const struct brc_h5_file *f, const char *path);
/* A dataset that holds one text, of its own length; "" takes one byte. */
int brc_h5_put_text(const struct brc_h5_file *f, const char *path, const char *text);
/* A dataset of n texts, all of the length of the longest, filled up with bytes 0. */
int brc_h5_put_texts(const struct brc_h5_file *f, const char *path, const char *const *text,
                     size_t n);
/* Attributes of a group or dataset. */
int brc_h5_put_label(const struct brc_h5_file *f, const char *path, const char *name,
                     const char *text);
int brc_h5_put_count(const struct brc_h5_file *f, const char *path, const char *name, size_t n);
int brc_h5_put_pair(const struct brc_h5_file *f, const char *path, const char *name,
                    const int64_t pair[2]);
/* Packed: by zlib, where the array is large enough to gain. */
int brc_h5_put_array(const struct brc_h5_file *f, const struct brc_h5_array *a, const void *data,
                     bool is_packed);

/* *text is allocated, to be freed by the caller; NULL after a failure. A dataset of another kind is
 * a failure as a missing one is. */
int brc_h5_get_text(const struct brc_h5_file *f, const char *path, char **text);
int brc_h5_get_count(const struct brc_h5_file *f, const char *path, const char *name, size_t *n);
/* Judges rows, width and type, then reads all rows into data, which has room for them; with data
 * NULL it judges alone, so that no memory is taken for a size that only a faulty file claims. */
int brc_h5_get_array(const struct brc_h5_file *f, const struct brc_h5_array *a, void *data);

/* A dataset as brc_h5_visit meets it, in the order of names. */
struct brc_h5_item {
    const char *path;
    bool is_text;
    const char *type; /* "float64", "int32", "text" and the like */
    size_t rows, width;
    double value;                            /* of a single number, else not a number */
    char unit[64], meaning[400], shape[128]; /* "" where the dataset has none */
};
/* Calls act for each dataset of the file until it returns another value than 0, which is returned.
 */
int brc_h5_visit(const struct brc_h5_file *f,
                 int (*act)(void *user, const struct brc_h5_item *item), void *user);

/* Messages: what could not be written or read. They return the code. */
int brc_h5_write_failed(const struct brc_h5_file *f, const char *what);
int brc_h5_read_failed(const struct brc_h5_file *f, const char *what);

#endif
