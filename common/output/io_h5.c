/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which parts of a simulation stand in a state file, and what is checked first on the way back:
 * sizes before memory is taken, the specimen's hash before fields, the state's hash last. A file
 * that passed its checksum may still be one of another version, another case, or a faulty writer.
 */
#include "common/output/io_h5.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 256 };

/* ---- fields -------------------------------------------------------------------------------- */

/* Tables know which fields hold nothing here; parts of scalars have only the flag. */
static bool is_saved(const struct brc_state_part *part, int i)
{
    return part->table ? brc_table_saves(part->table, i) : part->set.fields[i].flags & BRC_STATE;
}

/* The dataset of a field; the name is put into the buffer. */
static struct brc_h5_array array_of(const struct brc_state_part *part, int i, char name[NAME_SIZE])
{
    const struct brc_field *field = &part->set.fields[i];
    snprintf(name, NAME_SIZE, "%s/%s", part->path, field->name);
    return (struct brc_h5_array){.name = name,
                                 .type = field->type,
                                 .rows = part->n,
                                 .width = field->width,
                                 .unit = field->unit,
                                 .meaning = field->meaning,
                                 .row = part->path};
}

/* A field between the file and the simulation, by way of a dense buffer: the simulation's rows may
 * lie apart (brc_state_value), and HDF5 would need a description of that for each part. */
static int move_field(const struct brc_h5_file *f, const struct brc_state_part *part, int i,
                      bool is_read)
{
    char name[NAME_SIZE];
    struct brc_h5_array a = array_of(part, i, name);
    size_t size = brc_field_size(&part->set.fields[i]);
    char *buffer = brc_alloc(f->ctx, part->n, size);
    int code = !buffer ? BRC_ERR_MEMORY : is_read ? brc_h5_get_array(f, &a, buffer) : 0;
    for (size_t row = 0; code == 0 && row < part->n; row++) {
        char *value = brc_state_value(part, i, row), *dense = buffer + row * size;
        memcpy(is_read ? value : dense, is_read ? dense : value, size);
    }
    if (code == 0 && !is_read)
        code = brc_h5_put_array(f, &a, buffer, false);
    free(buffer);
    return code;
}

/* The group and all its BRC_STATE fields; an empty part makes its group, too, so that it is told
 * from one that is missing. Its number of rows is an attribute, since a part without fields has
 * rows, too. */
static int write_part(const struct brc_h5_file *f, const struct brc_state_part *part)
{
    BRC_TRY(brc_h5_put_group(f, part->path));
    BRC_TRY(brc_h5_put_count(f, part->path, "rows", part->n));
    for (int i = 0; i < part->set.n; i++)
        if (is_saved(part, i))
            BRC_TRY(move_field(f, part, i, false));
    return 0;
}

/* The number of rows comes first. Where the case decides it, another number means another case, and
 * the message says so; where the run decided it (contacts, events), the table takes what the file
 * has. */
static int read_part(const struct brc_h5_file *f, struct brc_state_part *part)
{
    char name[NAME_SIZE];
    size_t rows;
    BRC_TRY(brc_h5_get_count(f, part->path, "rows", &rows));
    if (part->is_fixed && rows != part->n)
        BRC_FAIL(f->ctx, BRC_ERR_INPUT,
                 "%s has %zu rows of %s, the case makes %zu; resume with the case that made it",
                 f->path, rows, part->path, part->n);
    part->n = rows;
    for (int i = 0; i < part->set.n; i++) { /* before any memory is taken for it */
        struct brc_h5_array a = array_of(part, i, name);
        if (is_saved(part, i))
            BRC_TRY(brc_h5_get_array(f, &a, NULL));
    }
    if (!part->is_fixed)
        BRC_TRY(brc_table_resize(f->ctx, part->table, rows));
    for (int i = 0; i < part->set.n; i++)
        if (is_saved(part, i))
            BRC_TRY(move_field(f, part, i, true));
    return 0;
}

/* Contacts must be sorted and name bodies that exist: all that follows relies on it, and would read
 * outside of arrays where it does not hold. */
static int restore_contacts(const struct brc_h5_file *f, struct brc_contacts *c)
{
    size_t points = 0;
    for (size_t i = 0; i < c->table.n; i++) {
        bool sorted =
            i == 0 || c->a[i] > c->a[i - 1] || (c->a[i] == c->a[i - 1] && c->b[i] > c->b[i - 1]);
        if (!sorted || c->a[i] < 0 || c->a[i] >= c->b[i] || (size_t)c->b[i] >= c->n_bodies ||
            c->np[i] < 0 || (points += (size_t)c->np[i]) > INT32_MAX)
            return brc_h5_read_failed(f, c->table.name);
    }
    return brc_contacts_restore(f->ctx, c);
}

/* ---- whole files --------------------------------------------------------------------------- */

static void hash_text(uint64_t hash, char text[17])
{
    snprintf(text, 17, "%016" PRIx64, hash);
}

/* Texts of a group, in which another program finds where a state comes from without this one. */
static int write_texts(const struct brc_h5_file *f, const struct brc_h5_text *texts, int n)
{
    char name[NAME_SIZE];
    for (int i = 0; i < n; i++) {
        snprintf(name, sizeof name, "provenance/%s", texts[i].name);
        BRC_TRY(brc_h5_put_text(f, name, texts[i].text));
    }
    return 0;
}

/* The same three first for states and frames: who, which version, which compiler. Not the time, nor
 * the machine: equal runs shall leave equal files. */
int brc_h5_put_provenance(const struct brc_h5_file *f, const struct brc_h5_text *texts, int n)
{
    static const struct brc_h5_text own[] = {
        {"program", "breccia"}, {"version", BRC_VERSION}, {"compiler", __VERSION__}};
    BRC_TRY(brc_h5_put_group(f, "provenance"));
    BRC_TRY(write_texts(f, own, sizeof own / sizeof own[0]));
    return write_texts(f, texts, n);
}

static int write_all(const struct brc_h5_file *f, struct brc_sim *sim,
                     const struct brc_h5_extra *extra)
{
    struct brc_state state;
    char hash[17], format[16], specimen[17];
    const struct brc_h5_text identity[] = {{"format", format},
                                           {"model", sim->model.name},
                                           {"state_hash", hash},
                                           {"specimen_hash", specimen}};
    brc_state_list(sim, &state);
    hash_text(brc_sim_hash(sim), hash);
    hash_text(brc_facets_hash(&sim->specimen->facets), specimen);
    snprintf(format, sizeof format, "%d", brc_checksum_state.format);
    BRC_TRY(brc_h5_put_provenance(f, extra->texts, extra->n_texts));
    BRC_TRY(write_texts(f, identity, sizeof identity / sizeof identity[0]));
    for (int i = 0; i < state.n; i++)
        BRC_TRY(write_part(f, &state.part[i]));
    for (int i = 0; i < extra->n_parts; i++)
        BRC_TRY(write_part(f, &extra->parts[i]));
    return 0;
}

/* Contacts are packed for the file, so that equal states make equal files whatever has come and
 * gone in the lists; the simulation gets its room for growth back also after a failure. */
int brc_h5_save(struct brc_context *ctx, const char *path, struct brc_sim *sim,
                const struct brc_h5_extra *extra)
{
    struct brc_h5_file f;
    struct brc_contacts *sets[2] = {&sim->pairs, &sim->platens};
    for (int i = 0; i < 2; i++)
        BRC_TRY(brc_contacts_pack(ctx, sets[i], 1));
    int code = brc_h5_create(ctx, path, &brc_checksum_state, &f);
    if (code == 0)
        code = brc_h5_finish(&f, write_all(&f, sim, extra));
    for (int i = 0; i < 2; i++) {
        int compacted = brc_contacts_compact(ctx, sets[i]);
        code = code != 0 ? code : compacted;
    }
    return code;
}

static int read_text(const struct brc_h5_file *f, const char *name, char **text)
{
    char full[NAME_SIZE];
    snprintf(full, sizeof full, "provenance/%s", name);
    return brc_h5_get_text(f, full, text);
}

/* A text of the file is what it must be; the advice says what to do where it is not, as the cause
 * differs with the text. */
static int expect_text(const struct brc_h5_file *f, const char *name, const char *expected,
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

/* The hash of the whole state comes last, over what is in memory by then: it also finds a field
 * that one version saves and another does not know. Only then is anything derived from the state.
 */
static int read_all(const struct brc_h5_file *f, struct brc_sim *sim,
                    const struct brc_h5_extra *extra)
{
    struct brc_state state;
    char hash[17], specimen[17];
    hash_text(brc_facets_hash(&sim->specimen->facets), specimen);
    BRC_TRY(expect_text(f, "model", sim->model.name, "choose that model with --model"));
    BRC_TRY(expect_text(f, "specimen_hash", specimen,
                        "the case makes another specimen now: resume with the case, and the files "
                        "that it names, that the run began with"));
    brc_state_list(sim, &state);
    for (int i = 0; i < state.n; i++)
        BRC_TRY(read_part(f, &state.part[i]));
    for (int i = 0; i < extra->n_parts; i++)
        BRC_TRY(read_part(f, &extra->parts[i]));
    BRC_TRY(restore_contacts(f, &sim->pairs));
    BRC_TRY(restore_contacts(f, &sim->platens));
    hash_text(brc_sim_hash(sim), hash);
    BRC_TRY(expect_text(f, "state_hash", hash,
                        "the file is damaged or comes from another build; start anew with "
                        "--force"));
    return brc_sim_restore(sim);
}

int brc_h5_load(struct brc_context *ctx, const char *path, struct brc_sim *sim,
                const struct brc_h5_extra *extra)
{
    struct brc_h5_file f;
    BRC_TRY(brc_h5_open(ctx, path, &brc_checksum_state, &f));
    int code = read_all(&f, sim, extra);
    brc_h5_close(&f);
    return code;
}

int brc_h5_load_table(struct brc_context *ctx, const char *path, struct brc_state_part *part)
{
    struct brc_h5_file f;
    part->is_fixed = false;
    BRC_TRY(brc_h5_open(ctx, path, &brc_checksum_state, &f));
    int code = read_part(&f, part);
    brc_h5_close(&f);
    return code;
}

/* Opened for a text alone: who resumes needs the kept case before there is a simulation to load. */
int brc_h5_read_text(struct brc_context *ctx, const char *path, const char *name, char **text)
{
    struct brc_h5_file f;
    *text = NULL;
    BRC_TRY(brc_h5_open(ctx, path, &brc_checksum_state, &f));
    int code = read_text(&f, name, text);
    brc_h5_close(&f);
    return code;
}
