/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The only user of HDF5. A file is made in memory and written at once, as the library crashes when
 * a disk is full; files hold no times, so that equal states are equal files. */
#include "common/output/h5.h"

#include "common/base/folders.h"

#include <hdf5.h>

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

_Static_assert(sizeof(hid_t) == sizeof(int64_t), "h5.h keeps handles of HDF5 as int64_t");

enum { PACK_LEVEL = 4, PACK_ROWS = 1024, CHUNK_BYTES = 1 << 20 };
/* bytes by which files in memory grow */
enum { CORE_STEP = 1 << 20 };

static hid_t memory_type(enum brc_type type)
{
    switch (type) {
    case BRC_F64:
        return H5T_NATIVE_DOUBLE;
    case BRC_I64:
        return H5T_NATIVE_INT64;
    case BRC_I32:
        return H5T_NATIVE_INT32;
    case BRC_U8:
        return H5T_NATIVE_UINT8;
    }
    return H5I_INVALID_HID;
}

/* Little-endian on disk, whatever the machine. */
static hid_t file_type(enum brc_type type)
{
    switch (type) {
    case BRC_F64:
        return H5T_IEEE_F64LE;
    case BRC_I64:
        return H5T_STD_I64LE;
    case BRC_I32:
        return H5T_STD_I32LE;
    case BRC_U8:
        return H5T_STD_U8LE;
    }
    return H5I_INVALID_HID;
}

int brc_h5_write_failed(const struct brc_h5_file *f, const char *what)
{
    BRC_FAIL(f->ctx, BRC_ERR_MEMORY, "HDF5 cannot take up %s for %s; is the memory exhausted?",
             what, f->path);
}

int brc_h5_read_failed(const struct brc_h5_file *f, const char *what)
{
    BRC_FAIL(f->ctx, BRC_ERR_IO,
             "%s holds no readable '%s': it is damaged or of another version; start the run anew "
             "with --force",
             f->path, what);
}

/* Properties of a new object of the class: no time stamps, so that equal states give equal files.
 */
static hid_t without_times(hid_t class)
{
    hid_t how = H5Pcreate(class);
    H5Pset_obj_track_times(how, false);
    return how;
}

/* ---- files --------------------------------------------------------------------------------- */

static int part_path(struct brc_context *ctx, const char *path, char temporary[BRC_PATH_SIZE])
{
    if (snprintf(temporary, BRC_PATH_SIZE, "%s.part", path) >= BRC_PATH_SIZE)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "the path %.80s... is too long", path);
    return 0;
}

/* A new file in memory: HDF5 crashes when it cannot write to a full disk. In the oldest format:
 * from 1.8 on the superblock of an image has a wrong checksum. Integrity is the header's. */
int brc_h5_create(struct brc_context *ctx, const char *path, const struct brc_checksum_kind *header,
                  struct brc_h5_file *f)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    hid_t how = without_times(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_userblock(how, BRC_CHECKSUM_SIZE);
    H5Pset_fapl_core(access, CORE_STEP, false);
    H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, how, access);
    *f = (struct brc_h5_file){ctx, path, id, header};
    H5Pclose(access);
    H5Pclose(how);
    return id < 0 ? brc_h5_write_failed(f, "a new file") : 0;
}

/* The bytes of the file without its user block; allocated. */
static int copy_image(const struct brc_h5_file *f, char **image, size_t *n)
{
    ssize_t size = H5Fflush(f->id, H5F_SCOPE_GLOBAL) < 0 ? -1 : H5Fget_file_image(f->id, NULL, 0);
    *image = NULL;
    if (size <= 0)
        return brc_h5_write_failed(f, "all data");
    *n = (size_t)size;
    *image = brc_alloc(f->ctx, *n, 1);
    if (!*image)
        return BRC_ERR_MEMORY;
    return H5Fget_file_image(f->id, *image, *n) == size ? 0 : brc_h5_write_failed(f, "all data");
}

static int write_file(const struct brc_h5_file *f, const char *path, const char *image, size_t n)
{
    char header[BRC_CHECKSUM_SIZE];
    FILE *file = fopen(path, "wb");
    brc_checksum_make(header, f->header, image, n);
    bool is_good = file && fwrite(header, sizeof header, 1, file) == 1;
    is_good = is_good && fwrite(image, n, 1, file) == 1 && fflush(file) == 0;
    int reason = errno;
    if (file && fclose(file) != 0 && is_good) {
        is_good = false;
        reason = errno;
    }
    if (!is_good)
        BRC_FAIL(f->ctx, BRC_ERR_IO,
                 "cannot write %s: %s; what was saved before stays: make room or choose another "
                 "folder, then go on with --resume",
                 path, strerror(reason));
    return 0;
}

static int sync_path(struct brc_context *ctx, const char *path, int flags)
{
    int fd = open(path, flags);
    int status = fd < 0 ? -1 : fsync(fd);
    int reason = errno;
    if (fd >= 0)
        close(fd);
    if (status != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot force %s to disk: %s", path, strerror(reason));
    return 0;
}

/* The complete file takes its place: on disk first, then renamed, then the folder on disk. */
static int publish(struct brc_context *ctx, const char *temporary, const char *path)
{
    char folder[BRC_PATH_SIZE];
    BRC_TRY(sync_path(ctx, temporary, O_RDONLY));
    if (rename(temporary, path) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot rename %s to %s: %s", temporary, path, strerror(errno));
    snprintf(folder, sizeof folder, "%s", path);
    return sync_path(ctx, dirname(folder), O_RDONLY | O_DIRECTORY);
}

int brc_h5_finish(struct brc_h5_file *f, int code)
{
    char temporary[BRC_PATH_SIZE], *image = NULL;
    size_t n = 0;
    if (code == 0)
        code = copy_image(f, &image, &n);
    H5Fclose(f->id);
    if (code == 0)
        code = part_path(f->ctx, f->path, temporary);
    if (code == 0) {
        code = write_file(f, temporary, image, n);
        if (code == 0)
            code = publish(f->ctx, temporary, f->path);
        if (code != 0)
            unlink(temporary);
    }
    free(image);
    return code;
}

int brc_h5_open(struct brc_context *ctx, const char *path, const struct brc_checksum_kind *header,
                struct brc_h5_file *f)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    *f = (struct brc_h5_file){ctx, path, H5I_INVALID_HID, header};
    BRC_TRY(brc_checksum_check(ctx, path, header));
    f->id = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (f->id < 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot read %s: it is not an HDF5 file", path);
    return 0;
}

void brc_h5_close(struct brc_h5_file *f)
{
    H5Fclose(f->id);
}

int brc_h5_put_group(const struct brc_h5_file *f, const char *path)
{
    hid_t how = without_times(H5P_GROUP_CREATE);
    hid_t group = H5Gcreate2(f->id, path, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Pclose(how);
    if (group < 0)
        return brc_h5_write_failed(f, path);
    H5Gclose(group);
    return 0;
}

/* ---- texts --------------------------------------------------------------------------------- */

/* A type of fixed-length text without a byte at its end: VTK compares them all. Closed by the
 * caller. */
static hid_t text_type(const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, *text ? strlen(text) : 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    return type;
}

int brc_h5_put_text(const struct brc_h5_file *f, const char *path, const char *text)
{
    hid_t type = text_type(text), space = H5Screate(H5S_SCALAR);
    hid_t how = without_times(H5P_DATASET_CREATE);
    hid_t id = H5Dcreate2(f->id, path, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    herr_t status = id < 0 ? -1 : H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
    if (id >= 0)
        H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
    H5Tclose(type);
    return status < 0 ? brc_h5_write_failed(f, path) : 0;
}

/* An attribute of the object at path. */
static int put_attribute(const struct brc_h5_file *f, const char *path, const char *name,
                         hid_t file_form, hid_t memory_form, hid_t space, const void *value)
{
    hid_t id = H5Acreate_by_name(f->id, path, name, file_form, space, H5P_DEFAULT, H5P_DEFAULT,
                                 H5P_DEFAULT);
    herr_t status = id < 0 ? -1 : H5Awrite(id, memory_form, value);
    if (id >= 0)
        H5Aclose(id);
    H5Sclose(space);
    return status < 0 ? brc_h5_write_failed(f, name) : 0;
}

int brc_h5_put_label(const struct brc_h5_file *f, const char *path, const char *name,
                     const char *text)
{
    hid_t type = text_type(text);
    int code = put_attribute(f, path, name, type, type, H5Screate(H5S_SCALAR), text);
    H5Tclose(type);
    return code;
}

int brc_h5_put_count(const struct brc_h5_file *f, const char *path, const char *name, size_t n)
{
    uint64_t value = n;
    return put_attribute(f, path, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, H5Screate(H5S_SCALAR),
                         &value);
}

int brc_h5_put_pair(const struct brc_h5_file *f, const char *path, const char *name,
                    const int64_t pair[2])
{
    const hsize_t extent = 2;
    return put_attribute(f, path, name, H5T_STD_I64LE, H5T_NATIVE_INT64,
                         H5Screate_simple(1, &extent, NULL), pair);
}

/* Reads the text of a dataset, or of an attribute (a label). */
static int get_text(const struct brc_h5_file *f, const char *path, hid_t id, bool is_label,
                    char **text)
{
    hid_t type = is_label ? H5Aget_type(id) : H5Dget_type(id);
    hid_t space = is_label ? H5Aget_space(id) : H5Dget_space(id);
    bool is_text = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                   H5Sget_simple_extent_npoints(space) == 1;
    herr_t status = -1;
    *text = is_text ? brc_alloc(f->ctx, H5Tget_size(type) + 1, 1) : NULL;
    if (*text)
        status = is_label ? H5Aread(id, type, *text)
                          : H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *text);
    H5Sclose(space);
    H5Tclose(type);
    if (status >= 0)
        return 0;
    free(*text);
    *text = NULL;
    return f->ctx->code ? f->ctx->code : brc_h5_read_failed(f, path);
}

int brc_h5_get_text(const struct brc_h5_file *f, const char *path, char **text)
{
    *text = NULL;
    hid_t id = H5Dopen2(f->id, path, H5P_DEFAULT);
    if (id < 0)
        return brc_h5_read_failed(f, path);
    int code = get_text(f, path, id, false, text);
    H5Dclose(id);
    return code;
}

int brc_h5_get_label(const struct brc_h5_file *f, const char *path, const char *name, char **text)
{
    *text = NULL;
    hid_t id = H5Aopen_by_name(f->id, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (id < 0)
        return brc_h5_read_failed(f, path);
    int code = get_text(f, path, id, true, text);
    H5Aclose(id);
    return code;
}

int brc_h5_get_count(const struct brc_h5_file *f, const char *path, const char *name, size_t *n)
{
    uint64_t value = 0;
    hid_t id = H5Aopen_by_name(f->id, path, name, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = id < 0 ? -1 : H5Aread(id, H5T_NATIVE_UINT64, &value);
    if (id >= 0)
        H5Aclose(id);
    *n = (size_t)value;
    return status < 0 ? brc_h5_read_failed(f, path) : 0;
}

/* ---- arrays -------------------------------------------------------------------------------- */

/* Chunks of about CHUNK_BYTES, shuffled and packed; a small array stays as it is. */
static void pack(hid_t how, const struct brc_h5_array *a)
{
    size_t row_size = brc_type_size(a->type) * (size_t)a->width;
    hsize_t chunk[2] = {CHUNK_BYTES / row_size, (hsize_t)a->width};
    if (a->rows < PACK_ROWS)
        return;
    if (chunk[0] > a->rows)
        chunk[0] = a->rows;
    H5Pset_chunk(how, a->is_flat ? 1 : 2, chunk);
    H5Pset_shuffle(how);
    H5Pset_deflate(how, PACK_LEVEL);
}

static int put_labels(const struct brc_h5_file *f, const struct brc_h5_array *a)
{
    char shape[256];
    if (a->unit)
        BRC_TRY(brc_h5_put_label(f, a->name, "unit", a->unit));
    if (a->meaning)
        BRC_TRY(brc_h5_put_label(f, a->name, "meaning", a->meaning));
    if (!a->row)
        return 0;
    snprintf(shape, sizeof shape, a->is_flat ? "(%s)" : "(%s, %d)", a->row, a->width);
    return brc_h5_put_label(f, a->name, "shape", shape);
}

int brc_h5_put_array(const struct brc_h5_file *f, const struct brc_h5_array *a, const void *data,
                     bool is_packed)
{
    const hsize_t extent[2] = {a->rows, (hsize_t)a->width};
    hid_t space = H5Screate_simple(a->is_flat ? 1 : 2, extent, NULL);
    hid_t how = without_times(H5P_DATASET_CREATE);
    if (is_packed)
        pack(how, a);
    hid_t id = H5Dcreate2(f->id, a->name, file_type(a->type), space, H5P_DEFAULT, how, H5P_DEFAULT);
    herr_t status =
        id < 0 ? -1 : H5Dwrite(id, memory_type(a->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    if (id >= 0)
        H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
    return status < 0 ? brc_h5_write_failed(f, a->name) : put_labels(f, a);
}

/* Opens the dataset, which must have the shape and the type of a. The caller closes *id. */
static int open_array(const struct brc_h5_file *f, const struct brc_h5_array *a, hid_t *id)
{
    int rank = a->is_flat ? 1 : 2;
    hsize_t extent[2] = {0, (hsize_t)a->width};
    *id = H5Dopen2(f->id, a->name, H5P_DEFAULT);
    if (*id < 0)
        return brc_h5_read_failed(f, a->name);
    hid_t space = H5Dget_space(*id), type = H5Dget_type(*id);
    bool fits = H5Sget_simple_extent_ndims(space) == rank &&
                H5Sget_simple_extent_dims(space, extent, NULL) == rank && extent[0] == a->rows &&
                extent[1] == (hsize_t)a->width && H5Tequal(type, file_type(a->type)) > 0;
    H5Tclose(type);
    H5Sclose(space);
    if (fits)
        return 0;
    H5Dclose(*id);
    return brc_h5_read_failed(f, a->name);
}

int brc_h5_check_array(const struct brc_h5_file *f, const struct brc_h5_array *a)
{
    hid_t id;
    BRC_TRY(open_array(f, a, &id));
    H5Dclose(id);
    return 0;
}

int brc_h5_get_array(const struct brc_h5_file *f, const struct brc_h5_array *a, void *data)
{
    hid_t id;
    BRC_TRY(open_array(f, a, &id));
    herr_t status = H5Dread(id, memory_type(a->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(id);
    return status < 0 ? brc_h5_read_failed(f, a->name) : 0;
}

/* ---- visiting ------------------------------------------------------------------------------ */

struct visit {
    const struct brc_h5_file *f;
    int (*act)(void *user, const struct brc_h5_item *item);
    void *user;
};

static const char *type_name(hid_t type)
{
    size_t size = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_STRING)
        return "text";
    if (H5Tget_class(type) == H5T_FLOAT)
        return size == 8 ? "float64" : "float";
    if (H5Tget_class(type) == H5T_INTEGER)
        return size == 8 ? "int64" : size == 4 ? "int32" : size == 1 ? "uint8" : "integer";
    return "other";
}

/* A short text attribute of an open dataset; "" when there is none. */
static void label_of(hid_t id, const char *name, char *text, size_t size)
{
    text[0] = '\0';
    if (H5Aexists(id, name) <= 0)
        return;
    hid_t label = H5Aopen(id, name, H5P_DEFAULT), type = H5Aget_type(label);
    bool fits = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                H5Tget_size(type) < size;
    memset(text, 0, size);
    if (!fits || H5Aread(label, type, text) < 0)
        text[0] = '\0';
    H5Tclose(type);
    H5Aclose(label);
}

static void describe(hid_t id, struct brc_h5_item *item)
{
    hsize_t extent[2] = {1, 1};
    hid_t space = H5Dget_space(id), type = H5Dget_type(id);
    int rank = H5Sget_simple_extent_ndims(space);
    if (rank == 1 || rank == 2)
        H5Sget_simple_extent_dims(space, extent, NULL);
    item->rows = (size_t)extent[0];
    item->width = (size_t)extent[1];
    item->type = type_name(type);
    item->is_text = H5Tget_class(type) == H5T_STRING;
    item->value = NAN;
    if (!item->is_text && H5Sget_simple_extent_npoints(space) == 1 &&
        H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &item->value) < 0)
        item->value = NAN;
    label_of(id, "unit", item->unit, sizeof item->unit);
    label_of(id, "meaning", item->meaning, sizeof item->meaning);
    H5Tclose(type);
    H5Sclose(space);
}

static herr_t visit_link(hid_t where, const char *path, const H5L_info_t *info, void *user)
{
    const struct visit *v = user;
    struct brc_h5_item item = {.path = path};
    if (info->type != H5L_TYPE_HARD)
        return 0;
    hid_t object = H5Oopen(where, path, H5P_DEFAULT);
    bool is_dataset = object >= 0 && H5Iget_type(object) == H5I_DATASET;
    if (is_dataset)
        describe(object, &item);
    if (object >= 0)
        H5Oclose(object);
    return is_dataset ? v->act(v->user, &item) : 0;
}

int brc_h5_visit(const struct brc_h5_file *f,
                 int (*act)(void *user, const struct brc_h5_item *item), void *user)
{
    struct visit v = {f, act, user};
    herr_t status = H5Lvisit(f->id, H5_INDEX_NAME, H5_ITER_INC, visit_link, &v);
    if (status < 0 && f->ctx->code == 0)
        return brc_h5_read_failed(f, "list of datasets");
    return status;
}
