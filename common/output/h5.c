/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The only user of HDF5. A file is made in memory and written at once, as the library crashes when
 * a disk is full; files hold no times, so that equal states are equal files. States and frames come
 * through here; what stands in them is no business of this file.
 *
 * The library prints no error of its own. Closing a handle that was never opened is then a failure
 * without a trace, so that nothing here asks before it closes. */
#include "common/output/h5.h"

#include "common/base/text_file.h"

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

/* zlib's level; the least rows that are packed: fewer gain nothing; bytes of a chunk; bytes by
 * which files in memory grow */
enum { PACK_LEVEL = 4, PACK_ROWS = 1024, CHUNK_BYTES = 1 << 20, CORE_STEP = 1 << 20 };

/* Little-endian on disk, whatever the machine. The table is not static: HDF5 knows its types only
 * when it has started. */
static hid_t type_of(enum brc_type type, bool is_on_disk)
{
    const hid_t types[][2] = {[BRC_F64] = {H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE},
                              [BRC_I64] = {H5T_NATIVE_INT64, H5T_STD_I64LE},
                              [BRC_I32] = {H5T_NATIVE_INT32, H5T_STD_I32LE},
                              [BRC_U8] = {H5T_NATIVE_UINT8, H5T_STD_U8LE}};
    return types[type][is_on_disk];
}

/* Files are in memory while they are made: what fails then is the memory, not the disk. */
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

/* The bytes of the file without its user block; allocated. A second copy for a moment, so that
 * saving takes twice the size of the file: the price of never letting HDF5 meet the disk. */
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

/* Header and image in their place, by way of a file beside it; then the folder on disk, too: only
 * with that does the new name outlast a power cut. What fwrite cannot write stays in the stream as
 * an error, which the end reports. */
static int write_file(const struct brc_h5_file *f, const char *image, size_t n)
{
    char header[BRC_CHECKSUM_SIZE], folder[BRC_PATH_SIZE];
    struct brc_text_file file;
    BRC_TRY(brc_text_file_begin(f->ctx, &file, NULL, f->path));
    brc_checksum_make(header, f->header, image, n);
    fwrite(header, sizeof header, 1, file.out);
    fwrite(image, n, 1, file.out);
    int code = brc_text_file_end(f->ctx, &file);
    if (code != 0) {
        size_t used = strlen(f->ctx->message);
        snprintf(f->ctx->message + used, sizeof f->ctx->message - used,
                 ", then go on with --resume");
        return code;
    }
    snprintf(folder, sizeof folder, "%s", f->path);
    int fd = open(dirname(folder), O_RDONLY | O_DIRECTORY);
    bool is_on_disk = fd >= 0 && fsync(fd) == 0;
    int reason = errno;
    close(fd);
    if (!is_on_disk)
        BRC_FAIL(f->ctx, BRC_ERR_IO, "cannot force %s to disk: %s", folder, strerror(reason));
    return 0;
}

/* Closed in any case, written only when nothing failed: half a state is none. */
int brc_h5_finish(struct brc_h5_file *f, int code)
{
    char *image = NULL;
    size_t n = 0;
    if (code == 0)
        code = copy_image(f, &image, &n);
    H5Fclose(f->id);
    if (code == 0)
        code = write_file(f, image, n);
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

/* A dataset with these data; takes the properties and the space. */
static int put_dataset(const struct brc_h5_file *f, const char *path, hid_t file_form,
                       hid_t memory_form, hid_t space, hid_t how, const void *data)
{
    hid_t id = H5Dcreate2(f->id, path, file_form, space, H5P_DEFAULT, how, H5P_DEFAULT);
    herr_t status = H5Dwrite(id, memory_form, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
    return status < 0 ? brc_h5_write_failed(f, path) : 0;
}

int brc_h5_put_text(const struct brc_h5_file *f, const char *path, const char *text)
{
    hid_t type = text_type(text);
    int code = put_dataset(f, path, type, type, H5Screate(H5S_SCALAR),
                           without_times(H5P_DATASET_CREATE), text);
    H5Tclose(type);
    return code;
}

int brc_h5_put_texts(const struct brc_h5_file *f, const char *path, const char *const *text,
                     size_t n)
{
    size_t width = 1;
    const hsize_t extent = n;
    for (size_t i = 0; i < n; i++)
        width = strlen(text[i]) > width ? strlen(text[i]) : width;
    char *all = brc_alloc(f->ctx, n, width);
    if (!all)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < n; i++)
        memcpy(all + i * width, text[i], strlen(text[i]));
    hid_t type = text_type("");
    H5Tset_size(type, width);
    int code = put_dataset(f, path, type, type, H5Screate_simple(1, &extent, NULL),
                           without_times(H5P_DATASET_CREATE), all);
    H5Tclose(type);
    free(all);
    return code;
}

/* An attribute of the object at path; takes the space. */
static int put_attribute(const struct brc_h5_file *f, const char *path, const char *name,
                         hid_t file_form, hid_t memory_form, hid_t space, const void *value)
{
    hid_t id = H5Acreate_by_name(f->id, path, name, file_form, space, H5P_DEFAULT, H5P_DEFAULT,
                                 H5P_DEFAULT);
    herr_t status = H5Awrite(id, memory_form, value);
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

/* The text of a dataset, or of an attribute (a label), allocated; NULL where it is none, or too
 * large for the memory. Only texts of fixed length are read, as they are written: HDF5 allocates
 * others by itself, by a length that stands in the file. */
static char *read_string(const struct brc_h5_file *f, hid_t id, bool is_label)
{
    hid_t type = is_label ? H5Aget_type(id) : H5Dget_type(id);
    hid_t space = is_label ? H5Aget_space(id) : H5Dget_space(id);
    bool is_text = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                   H5Sget_simple_extent_npoints(space) == 1;
    char *text = is_text ? brc_alloc(f->ctx, H5Tget_size(type) + 1, 1) : NULL;
    herr_t status = !text      ? -1
                    : is_label ? H5Aread(id, type, text)
                               : H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
    H5Sclose(space);
    H5Tclose(type);
    if (status >= 0)
        return text;
    free(text);
    return NULL;
}

int brc_h5_get_text(const struct brc_h5_file *f, const char *path, char **text)
{
    hid_t id = H5Dopen2(f->id, path, H5P_DEFAULT);
    *text = read_string(f, id, false);
    H5Dclose(id);
    return *text ? 0 : brc_h5_read_failed(f, path);
}

/* Of any integer type: HDF5 converts, and says so when it cannot. */
int brc_h5_get_count(const struct brc_h5_file *f, const char *path, const char *name, size_t *n)
{
    uint64_t value = 0;
    hid_t id = H5Aopen_by_name(f->id, path, name, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = H5Aread(id, H5T_NATIVE_UINT64, &value);
    H5Aclose(id);
    *n = (size_t)value;
    return status < 0 ? brc_h5_read_failed(f, path) : 0;
}

/* ---- arrays -------------------------------------------------------------------------------- */

/* Chunks of about CHUNK_BYTES, shuffled and packed; a small array stays as it is. Shuffling puts
 * like bytes of the numbers side by side: the exponents of a field are much alike, the last digits
 * not. */
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

/* What makes a field readable without this program: unit, meaning, and what its rows are. */
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
    BRC_TRY(
        put_dataset(f, a->name, type_of(a->type, true), type_of(a->type, false), space, how, data));
    return put_labels(f, a);
}

/* Rank, extent and type are asked for one by one, as a faulty writer could have made any of them,
 * and HDF5 would convert what it can in silence. */
int brc_h5_get_array(const struct brc_h5_file *f, const struct brc_h5_array *a, void *data)
{
    int rank = a->is_flat ? 1 : 2;
    hsize_t extent[2] = {0, (hsize_t)a->width};
    hid_t id = H5Dopen2(f->id, a->name, H5P_DEFAULT);
    hid_t space = H5Dget_space(id), type = H5Dget_type(id);
    bool fits = H5Sget_simple_extent_ndims(space) == rank &&
                H5Sget_simple_extent_dims(space, extent, NULL) == rank && extent[0] == a->rows &&
                extent[1] == (hsize_t)a->width && H5Tequal(type, type_of(a->type, true)) > 0;
    H5Tclose(type);
    H5Sclose(space);
    herr_t status = fits ? 0 : -1;
    if (fits && data)
        status = H5Dread(id, type_of(a->type, false), H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(id);
    return status < 0 ? brc_h5_read_failed(f, a->name) : 0;
}

/* ---- visiting ------------------------------------------------------------------------------ */

struct visit {
    const struct brc_h5_file *f;
    int (*act)(void *user, const struct brc_h5_item *item);
    void *user;
};

/* Names as other programs have them (numpy), since they are for users of those. */
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

/* A text attribute of an open dataset, cut to the size; "" when there is none. Asked for by
 * opening: whether there is one and whether it can be read is the same to the caller. */
static void label_of(const struct brc_h5_file *f, hid_t id, const char *name, char *label,
                     size_t size)
{
    hid_t attribute = H5Aopen(id, name, H5P_DEFAULT);
    char *text = read_string(f, attribute, true);
    snprintf(label, size, "%s", text ? text : "");
    free(text);
    H5Aclose(attribute);
}

/* Also of datasets that this version would not write: files of other versions are to be looked at,
 * not judged. Of a single number the value is read, whatever its type. */
static void describe(const struct brc_h5_file *f, hid_t id, struct brc_h5_item *item)
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
    label_of(f, id, "unit", item->unit, sizeof item->unit);
    label_of(f, id, "meaning", item->meaning, sizeof item->meaning);
    label_of(f, id, "shape", item->shape, sizeof item->shape);
    H5Tclose(type);
    H5Sclose(space);
}

/* Links that lead out of the file, or into it a second time, are passed over: a state has none. */
static herr_t visit_link(hid_t where, const char *path, const H5L_info_t *info, void *user)
{
    const struct visit *v = user;
    struct brc_h5_item item = {.path = path};
    if (info->type != H5L_TYPE_HARD)
        return 0;
    hid_t object = H5Oopen(where, path, H5P_DEFAULT);
    bool is_dataset = H5Iget_type(object) == H5I_DATASET;
    if (is_dataset)
        describe(v->f, object, &item);
    H5Oclose(object);
    return is_dataset ? v->act(v->user, &item) : 0;
}

/* In the order of names, the one that every HDF5 file has; that of creation is kept only where it
 * was asked for. */
int brc_h5_visit(const struct brc_h5_file *f,
                 int (*act)(void *user, const struct brc_h5_item *item), void *user)
{
    struct visit v = {f, act, user};
    herr_t status = H5Lvisit(f->id, H5_INDEX_NAME, H5_ITER_INC, visit_link, &v);
    if (status < 0 && f->ctx->code == 0)
        return brc_h5_read_failed(f, "list of datasets");
    return status;
}
