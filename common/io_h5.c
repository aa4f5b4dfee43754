/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io_h5.h"

#include <hdf5.h>

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A file being written or read; the path is for messages. */
struct h5_file {
    struct brc_context *ctx;
    const char *path;
    hid_t id;
};

enum { PATH_SIZE = 4096, NAME_SIZE = 256 };

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

static int write_failed(const struct h5_file *f, const char *what)
{
    BRC_FAIL(f->ctx, BRC_ERR_IO, "cannot write %s to %s; is the disk full?", what, f->path);
}

static int read_failed(const struct h5_file *f, const char *what)
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

static hid_t create_group(hid_t where, const char *path)
{
    hid_t how = without_times(H5P_GROUP_CREATE);
    hid_t group = H5Gcreate2(where, path, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Pclose(how);
    return group;
}

/* A new file of the format of HDF5 1.10, the structures of which carry checksums. */
static hid_t create_file(const char *path)
{
    hid_t how = without_times(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, how, access);
    H5Pclose(access);
    H5Pclose(how);
    return id;
}

/* ---- texts --------------------------------------------------------------------------------- */

/* A type of fixed-length text; closed by the caller. */
static hid_t text_type(size_t length)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length + 1);
    return type;
}

/* An attribute of an object, or a dataset in a group, holding one text. */
static int write_text(const struct h5_file *f, hid_t where, bool is_attribute, const char *name,
                      const char *text)
{
    hid_t type = text_type(strlen(text)), space = H5Screate(H5S_SCALAR), id;
    herr_t status = -1;
    if (is_attribute) {
        id = H5Acreate2(where, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        if (id >= 0) {
            status = H5Awrite(id, type, text);
            H5Aclose(id);
        }
    } else {
        hid_t how = without_times(H5P_DATASET_CREATE);
        id = H5Dcreate2(where, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
        H5Pclose(how);
        if (id >= 0) {
            status = H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
            H5Dclose(id);
        }
    }
    H5Sclose(space);
    H5Tclose(type);
    return status < 0 ? write_failed(f, name) : 0;
}

static int read_text(const struct h5_file *f, const char *name, char **text)
{
    char full[NAME_SIZE];
    snprintf(full, sizeof full, "provenance/%s", name);
    *text = NULL;
    hid_t id = H5Dopen2(f->id, full, H5P_DEFAULT);
    if (id < 0)
        return read_failed(f, full);
    hid_t type = H5Dget_type(id);
    size_t size = H5Tget_size(type);
    int code = 0;
    *text = H5Tget_class(type) == H5T_STRING ? brc_alloc(f->ctx, size + 1, 1) : NULL;
    if (!*text)
        code = f->ctx->code ? BRC_ERR_MEMORY : read_failed(f, full);
    else if (H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *text) < 0)
        code = read_failed(f, full);
    H5Tclose(type);
    H5Dclose(id);
    if (code != 0) {
        free(*text);
        *text = NULL;
    }
    return code;
}

/* ---- fields -------------------------------------------------------------------------------- */

/* Copies the rows of a field between the simulation and a dense buffer. */
static void copy_rows(const struct brc_state_part *part, int field, char *buffer, bool to_buffer)
{
    size_t size = brc_field_size(&part->set.fields[field]);
    for (size_t row = 0; row < part->n; row++) {
        char *value = brc_state_value(part, field, row);
        if (to_buffer)
            memcpy(buffer + row * size, value, size);
        else
            memcpy(value, buffer + row * size, size);
    }
}

/* New dataset of the right shape. */
static hid_t create_dataset(hid_t group, const struct brc_field *field, size_t rows)
{
    hsize_t extent[2] = {rows, (hsize_t)field->width};
    hid_t space = H5Screate_simple(2, extent, NULL);
    hid_t how = without_times(H5P_DATASET_CREATE);
    hid_t id = H5Dcreate2(group, field->name, file_type(field->type), space, H5P_DEFAULT, how,
                          H5P_DEFAULT);
    H5Pclose(how);
    H5Sclose(space);
    return id;
}

static int write_field(const struct h5_file *f, hid_t group, const struct brc_state_part *part,
                       int i)
{
    const struct brc_field *field = &part->set.fields[i];
    char *buffer = brc_alloc(f->ctx, part->n, brc_field_size(field));
    if (!buffer)
        return BRC_ERR_MEMORY;
    copy_rows(part, i, buffer, true);
    hid_t id = create_dataset(group, field, part->n);
    herr_t status = -1;
    int code = 0;
    if (id >= 0) {
        status = H5Dwrite(id, memory_type(field->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
        code = write_text(f, id, true, "unit", field->unit);
        if (code == 0)
            code = write_text(f, id, true, "meaning", field->meaning);
        H5Dclose(id);
    }
    free(buffer);
    if (code == 0 && status < 0)
        code = write_failed(f, field->name);
    return code;
}

static bool is_saved(const struct brc_field *field)
{
    return (field->flags & BRC_STATE) != 0;
}

/* The number of rows as an attribute of the group: a part without fields has rows, too. */
static int write_rows(const struct h5_file *f, hid_t group, size_t n)
{
    uint64_t rows = n;
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t id = H5Acreate2(group, "rows", H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = id < 0 ? -1 : H5Awrite(id, H5T_NATIVE_UINT64, &rows);
    if (id >= 0)
        H5Aclose(id);
    H5Sclose(space);
    return status < 0 ? write_failed(f, "rows") : 0;
}

static int read_rows(const struct h5_file *f, const char *path, size_t *n)
{
    uint64_t rows = 0;
    hid_t id = H5Aopen_by_name(f->id, path, "rows", H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = id < 0 ? -1 : H5Aread(id, H5T_NATIVE_UINT64, &rows);
    if (id >= 0)
        H5Aclose(id);
    *n = (size_t)rows;
    return status < 0 ? read_failed(f, path) : 0;
}

/* The group and all its BRC_STATE fields; an empty part makes its group, too. */
static int write_part(const struct h5_file *f, const struct brc_state_part *part)
{
    hid_t group = create_group(f->id, part->path);
    if (group < 0)
        return write_failed(f, part->path);
    int code = write_rows(f, group, part->n);
    for (int i = 0; i < part->set.n && code == 0; i++)
        if (is_saved(&part->set.fields[i]))
            code = write_field(f, group, part, i);
    H5Gclose(group);
    return code;
}

/* Opens a field's dataset, which must have the rows, the width and the kind that are expected. The
 * caller closes *id. */
static int open_field(const struct h5_file *f, const struct brc_state_part *part,
                      const struct brc_field *field, hid_t *id)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "%s/%s", part->path, field->name);
    *id = H5Dopen2(f->id, name, H5P_DEFAULT);
    if (*id < 0)
        return read_failed(f, name);
    hsize_t extent[2] = {0, 0};
    hid_t space = H5Dget_space(*id), type = H5Dget_type(*id);
    bool fits = H5Sget_simple_extent_ndims(space) == 2 &&
                H5Sget_simple_extent_dims(space, extent, NULL) == 2 && extent[0] == part->n &&
                extent[1] == (hsize_t)field->width && H5Tequal(type, file_type(field->type)) > 0;
    H5Tclose(type);
    H5Sclose(space);
    if (fits)
        return 0;
    H5Dclose(*id);
    return read_failed(f, name);
}

static int read_field(const struct h5_file *f, const struct brc_state_part *part, int i)
{
    const struct brc_field *field = &part->set.fields[i];
    hid_t id;
    BRC_TRY(open_field(f, part, field, &id));
    int code = 0;
    char *buffer = brc_alloc(f->ctx, part->n, brc_field_size(field));
    if (!buffer)
        code = BRC_ERR_MEMORY;
    else if (H5Dread(id, memory_type(field->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer) < 0)
        code = read_failed(f, field->name);
    else
        copy_rows(part, i, buffer, false);
    free(buffer);
    H5Dclose(id);
    return code;
}

static int read_part(const struct h5_file *f, struct brc_state_part *part)
{
    size_t rows;
    BRC_TRY(read_rows(f, part->path, &rows));
    if (part->is_fixed && rows != part->n)
        BRC_FAIL(f->ctx, BRC_ERR_INPUT,
                 "%s has %zu rows of %s, the case makes %zu; resume with the case that made it",
                 f->path, rows, part->path, part->n);
    part->n = rows;
    for (int i = 0; i < part->set.n; i++) { /* before any memory is taken for it */
        hid_t id;
        if (!is_saved(&part->set.fields[i]))
            continue;
        BRC_TRY(open_field(f, part, &part->set.fields[i], &id));
        H5Dclose(id);
    }
    if (!part->is_fixed)
        BRC_TRY(brc_table_resize(f->ctx, part->table, rows));
    for (int i = 0; i < part->set.n; i++)
        if (is_saved(&part->set.fields[i]))
            BRC_TRY(read_field(f, part, i));
    return 0;
}

/* Contacts must be sorted and name bodies that exist: all that follows relies on it. */
static int restore_contacts(const struct h5_file *f, struct brc_contacts *c)
{
    size_t points = 0;
    for (size_t i = 0; i < c->table.n; i++) {
        bool sorted =
            i == 0 || c->a[i] > c->a[i - 1] || (c->a[i] == c->a[i - 1] && c->b[i] > c->b[i - 1]);
        if (!sorted || c->a[i] < 0 || c->a[i] >= c->b[i] || (size_t)c->b[i] >= c->n_bodies ||
            c->np[i] < 0 || (points += (size_t)c->np[i]) > INT32_MAX)
            return read_failed(f, c->table.name);
    }
    return brc_contacts_restore(f->ctx, c);
}

/* ---- whole files --------------------------------------------------------------------------- */

static void hash_text(const struct brc_sim *sim, char text[17])
{
    snprintf(text, 17, "%016" PRIx64, brc_sim_hash(sim));
}

static int write_provenance(const struct h5_file *f, const struct brc_sim *sim,
                            const struct brc_h5_extra *extra)
{
    char hash[17], format[16];
    hid_t group = create_group(f->id, "provenance");
    if (group < 0)
        return write_failed(f, "provenance");
    hash_text(sim, hash);
    snprintf(format, sizeof format, "%d", BRC_H5_FORMAT);
    const struct brc_h5_text own[] = {
        {"program", "breccia"}, {"version", BRC_VERSION},   {"compiler", __VERSION__},
        {"format", format},     {"model", sim->model.name}, {"state_hash", hash},
    };
    int code = 0;
    for (size_t i = 0; i < sizeof own / sizeof own[0] && code == 0; i++)
        code = write_text(f, group, false, own[i].name, own[i].text);
    for (int i = 0; i < extra->n_texts && code == 0; i++)
        code = write_text(f, group, false, extra->texts[i].name, extra->texts[i].text);
    H5Gclose(group);
    return code;
}

static int write_all(const struct h5_file *f, struct brc_sim *sim, const struct brc_h5_extra *extra)
{
    struct brc_state state;
    brc_state_list(sim, &state);
    BRC_TRY(write_provenance(f, sim, extra));
    for (int i = 0; i < state.n; i++)
        BRC_TRY(write_part(f, &state.part[i]));
    if (extra->part)
        BRC_TRY(write_part(f, extra->part));
    return H5Fflush(f->id, H5F_SCOPE_GLOBAL) < 0 ? write_failed(f, "the state") : 0;
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
    char folder[PATH_SIZE];
    BRC_TRY(sync_path(ctx, temporary, O_RDONLY));
    if (rename(temporary, path) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot rename %s to %s: %s", temporary, path, strerror(errno));
    snprintf(folder, sizeof folder, "%s", path);
    return sync_path(ctx, dirname(folder), O_RDONLY | O_DIRECTORY);
}

int brc_h5_save(struct brc_context *ctx, const char *path, struct brc_sim *sim,
                const struct brc_h5_extra *extra)
{
    char temporary[PATH_SIZE];
    if (snprintf(temporary, sizeof temporary, "%s.part", path) >= (int)sizeof temporary)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "the path %.80s... is too long", path);
    BRC_TRY(brc_contacts_compact(ctx, &sim->pairs));
    BRC_TRY(brc_contacts_compact(ctx, &sim->platens));
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    struct h5_file f = {ctx, path, create_file(temporary)};
    if (f.id < 0)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "cannot create %s: is the folder there, writable and not full, and does no other "
                 "run use it?",
                 temporary);
    int code = write_all(&f, sim, extra);
    if (H5Fclose(f.id) < 0 && code == 0)
        code = write_failed(&f, "the state");
    if (code == 0)
        code = publish(ctx, temporary, path);
    if (code != 0)
        unlink(temporary);
    return code;
}

static int open_file(struct brc_context *ctx, const char *path, struct h5_file *f)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    *f = (struct h5_file){ctx, path, H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT)};
    if (f->id < 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot read %s: it is missing or no HDF5 file", path);
    return 0;
}

/* A text of the file is what it must be. */
static int expect_text(const struct h5_file *f, const char *name, const char *expected,
                       const char *advice)
{
    char *text;
    BRC_TRY(read_text(f, name, &text));
    int code = 0;
    if (strcmp(text, expected) != 0)
        code = brc_error_set(f->ctx, BRC_ERR_INPUT, __FILE__, __LINE__,
                             "%s has the %s %s, expected %s; %s", f->path, name, text, expected,
                             advice);
    free(text);
    return code;
}

static int read_all(const struct h5_file *f, struct brc_sim *sim, const struct brc_h5_extra *extra)
{
    struct brc_state state;
    char format[16], hash[17];
    snprintf(format, sizeof format, "%d", BRC_H5_FORMAT);
    BRC_TRY(expect_text(f, "format", format, "resume with the version that wrote it"));
    BRC_TRY(expect_text(f, "model", sim->model.name, "choose that model with --model"));
    brc_state_list(sim, &state);
    for (int i = 0; i < state.n; i++)
        BRC_TRY(read_part(f, &state.part[i]));
    if (extra->part)
        BRC_TRY(read_part(f, extra->part));
    BRC_TRY(restore_contacts(f, &sim->pairs));
    BRC_TRY(restore_contacts(f, &sim->platens));
    hash_text(sim, hash);
    BRC_TRY(expect_text(f, "state_hash", hash,
                        "the file is damaged or comes from another build; start anew with "
                        "--force"));
    return brc_sim_restore(sim);
}

int brc_h5_load(struct brc_context *ctx, const char *path, struct brc_sim *sim,
                const struct brc_h5_extra *extra)
{
    struct h5_file f;
    BRC_TRY(open_file(ctx, path, &f));
    int code = read_all(&f, sim, extra);
    H5Fclose(f.id);
    return code;
}

int brc_h5_read_text(struct brc_context *ctx, const char *path, const char *name, char **text)
{
    struct h5_file f;
    *text = NULL;
    BRC_TRY(open_file(ctx, path, &f));
    int code = read_text(&f, name, text);
    H5Fclose(f.id);
    return code;
}
