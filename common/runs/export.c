/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables come straight from a state's file; surfaces need the case, from which the specimen is made
 * anew, as states hold no geometry. */
#include "common/runs/export.h"

#include "common/base/text_file.h"
#include "common/engine/fragments.h"
#include "common/output/io_h5.h"
#include "common/runs/case.h"
#include "common/specimen/neper.h"
#include "common/output/output.h"
#include "common/output/checksum_header.h"
#include "common/geometry/vec.h"
#include "common/runs/case_files.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A state with all that it hangs on. */
struct loaded {
    struct brc_case run_case;
    struct brc_specimen specimen;
    struct brc_sim sim;
};

static void unload(struct loaded *l)
{
    if (l->sim.ctx)
        brc_sim_free(&l->sim);
    brc_specimen_free(&l->specimen);
    brc_case_free(&l->run_case);
}

/* The model of a state. */
static int read_model(struct brc_context *ctx, const char *path, const struct brc_model **model)
{
    char *name;
    BRC_TRY(brc_h5_read_text(ctx, path, "model", &name));
    int code = brc_case_model(ctx, name, model);
    free(name);
    return code;
}

static int load_sim(struct brc_context *ctx, const char *path, struct loaded *l)
{
    static const struct brc_h5_extra none = {NULL, 0, NULL, 0};
    const struct brc_model *model;
    BRC_TRY(read_model(ctx, path, &model));
    BRC_TRY(brc_specimen_create(ctx, &l->run_case.specimen, &l->specimen));
    BRC_TRY(brc_case_sim(ctx, &l->run_case, model, &l->specimen, &l->sim));
    return brc_h5_load(ctx, path, &l->sim, &none);
}

/* Loads a state; *l is to be unloaded also after a failure. */
static int load(struct brc_context *ctx, const char *path, struct loaded *l)
{
    char *text;
    memset(l, 0, sizeof *l);
    BRC_TRY(brc_h5_read_text(ctx, path, "case", &text));
    int code = brc_case_parse(ctx, &l->run_case, path, text);
    free(text);
    BRC_TRY(code);
    return load_sim(ctx, path, l);
}

/* Runs put on the file at path, or on standard output. */
struct target {
    int (*put)(struct brc_context *ctx, FILE *out, const void *what);
    const void *what;
};

/* The file out must not be there, nor where it is written first; what is read is never replaced:
 * the file and, where the case counts, those that it names. */
static int check_out(struct brc_context *ctx, const struct brc_export_options *o,
                     const struct brc_case *run_case)
{
    char part[4096];
    struct stat status;
    const char *in_the_way = o->out;
    if (!o->out)
        return 0;
    if (snprintf(part, sizeof part, "%s.part", o->out) >= (int)sizeof part)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "-o: the path %.80s... is too long", o->out);
    if (lstat(o->out, &status) != 0 && lstat((in_the_way = part), &status) != 0)
        return 0;
    if (!S_ISREG(status.st_mode))
        BRC_FAIL(
            ctx, BRC_ERR_USAGE,
            "-o: %s is there and is not a plain file; choose another name, or leave -o out for "
            "standard output",
            in_the_way);
    if (brc_case_is_same_file(o->path, o->out) || (run_case && brc_case_is_input(run_case, o->out)))
        BRC_FAIL(ctx, BRC_ERR_USAGE, "-o: %s is what is read; choose another name", o->out);
    if (!o->is_forced)
        BRC_FAIL(ctx, BRC_ERR_USAGE,
                 "-o: %s is there; replace it with --force, or choose another "
                 "name",
                 in_the_way);
    return 0;
}

static int write_to(struct brc_context *ctx, const char *path, const struct target *target)
{
    struct brc_text_file file;
    if (!path)
        return target->put(ctx, stdout, target->what);
    BRC_TRY(brc_text_file_begin(ctx, &file, NULL, path));
    int code = target->put(ctx, file.out, target->what);
    if (code != 0)
        brc_text_file_drop(&file);
    return code != 0 ? code : brc_text_file_end(ctx, &file);
}

/* ---- tables -------------------------------------------------------------------------------- */

static int put_table(struct brc_context *ctx, FILE *out, const void *what)
{
    (void)ctx;
    brc_output_table(out, what, NULL);
    return 0;
}

static int find_table(struct brc_context *ctx, struct brc_state *state, const char *name,
                      struct brc_state_part **found)
{
    char all[BRC_NAMES_SIZE] = "";
    *found = NULL;
    for (int i = 0; i < state->n; i++) {
        struct brc_state_part *part = &state->part[i];
        if (!part->table || part->set.n == 0)
            continue;
        if (strcmp(part->path, name) == 0)
            *found = part;
        brc_names_add(all, sizeof all, part->path);
    }
    if (!*found)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "no table '%.60s'; there are: %s", name, all);
    return 0;
}

/* Straight from the file: neither the case nor the files that it names are needed. */
int brc_export_table(struct brc_context *ctx, const struct brc_export_options *order,
                     const char *table)
{
    const struct brc_model *model;
    struct brc_sim sim;
    struct brc_state state;
    struct brc_state_part *part;
    BRC_TRY(check_out(ctx, order, NULL));
    BRC_TRY(read_model(ctx, order->path, &model));
    BRC_TRY(brc_sim_tables(ctx, &sim, model));
    brc_state_list(&sim, &state);
    int code = find_table(ctx, &state, table, &part);
    if (code == 0)
        code = brc_h5_load_table(ctx, order->path, part);
    if (code == 0)
        code = write_to(ctx, order->out, &(struct target){put_table, part->table});
    brc_sim_free(&sim);
    return code;
}

/* ---- fragments ----------------------------------------------------------------------------- */

/* Vertices of one fragment: sum of where its grains carry them; mark tells the last grain and the
 * fragment that a vertex was met in. */
struct surface {
    const struct brc_sim *sim;
    const struct brc_fragments *fragments;
    double (*sum)[3];
    int32_t *count, *grain, *fragment; /* [n_vertices] */
    size_t *first, *order;             /* grains by fragment */
};

static int open_surface(struct brc_context *ctx, struct surface *s)
{
    const struct brc_facets *f = &s->sim->specimen->facets;
    size_t n = f->n_vertices;
    s->sum = brc_alloc(ctx, n, sizeof *s->sum);
    s->count = brc_alloc(ctx, n, sizeof *s->count);
    s->grain = brc_alloc(ctx, n, sizeof *s->grain);
    s->fragment = brc_alloc(ctx, n, sizeof *s->fragment);
    s->first = brc_alloc(ctx, s->fragments->n + 1, sizeof *s->first);
    s->order = brc_alloc(ctx, f->n_cells, sizeof *s->order);
    if (!s->sum || !s->count || !s->grain || !s->fragment || !s->first || !s->order)
        return BRC_ERR_MEMORY;
    for (size_t v = 0; v < n; v++)
        s->grain[v] = s->fragment[v] = -1;
    for (size_t k = 0; k < s->fragments->n; k++)
        s->first[k + 1] = s->first[k] + (size_t)s->fragments->size[k];
    for (size_t i = 0; i < f->n_cells; i++)
        s->order[s->first[s->fragments->of[i]]++] = i;
    for (size_t k = s->fragments->n; k > 0; k--)
        s->first[k] = s->first[k - 1];
    s->first[0] = 0;
    return 0;
}

static void close_surface(struct surface *s)
{
    free(s->sum);
    free(s->count);
    free(s->grain);
    free(s->fragment);
    free(s->first);
    free(s->order);
}

static void add_vertex(struct surface *s, int32_t v, int32_t grain, int32_t fragment)
{
    double x[3];
    if (s->fragment[v] != fragment) {
        s->fragment[v] = fragment;
        s->count[v] = 0;
        s->grain[v] = -1;
        brc_set(s->sum[v], 0, 0, 0);
    }
    if (s->grain[v] == grain)
        return;
    s->grain[v] = grain;
    brc_bodies_carry(&s->sim->bodies, (size_t)grain, s->sim->specimen->facets.vertex[v], x);
    brc_axpy(s->sum[v], 1, x);
    s->count[v]++;
}

static void put_triangle(FILE *out, const struct surface *s, const int32_t v[3])
{
    double x[3][3], a[3], b[3], n[3];
    for (int k = 0; k < 3; k++)
        brc_scale(x[k], s->sum[v[k]], 1.0 / s->count[v[k]]);
    brc_sub(a, x[1], x[0]);
    brc_sub(b, x[2], x[0]);
    brc_cross(n, a, b);
    brc_normalise(n, n);
    fprintf(out, "facet normal %.9g %.9g %.9g\n outer loop\n", n[0], n[1], n[2]);
    for (int k = 0; k < 3; k++)
        fprintf(out, "  vertex %.17g %.17g %.17g\n", x[k][0], x[k][1], x[k][2]);
    fputs(" endloop\nendfacet\n", out);
}

/* A facet of a grain as a fan of triangles, outward; none where the fragment goes on behind it. */
static void put_facet(FILE *out, const struct surface *s, size_t grain, size_t facet)
{
    const struct brc_facets *f = &s->sim->specimen->facets;
    bool is_low = f->cell[facet][0] == (int32_t)grain;
    int32_t other = f->cell[facet][is_low ? 1 : 0];
    const int32_t *loop = f->loop + f->first[facet];
    size_t n = f->first[facet + 1] - f->first[facet];
    if (other >= 0 && s->fragments->of[other] == s->fragments->of[grain])
        return;
    for (size_t i = 1; i + 1 < n; i++) {
        const int32_t v[3] = {loop[0], loop[is_low ? i : i + 1], loop[is_low ? i + 1 : i]};
        put_triangle(out, s, v);
    }
}

static void put_fragment(FILE *out, struct surface *s, size_t k)
{
    const struct brc_facets *f = &s->sim->specimen->facets;
    for (size_t i = s->first[k]; i < s->first[k + 1]; i++)
        for (size_t j = f->cell_first[s->order[i]]; j < f->cell_first[s->order[i] + 1]; j++)
            for (size_t m = f->first[f->cell_facet[j]]; m < f->first[f->cell_facet[j] + 1]; m++)
                add_vertex(s, f->loop[m], (int32_t)s->order[i], (int32_t)k);
    fprintf(out, "solid fragment_%zu\n", k);
    for (size_t i = s->first[k]; i < s->first[k + 1]; i++)
        for (size_t j = f->cell_first[s->order[i]]; j < f->cell_first[s->order[i] + 1]; j++)
            put_facet(out, s, s->order[i], (size_t)f->cell_facet[j]);
    fprintf(out, "endsolid fragment_%zu\n", k);
}

int brc_export_stl(struct brc_context *ctx, FILE *out, const struct brc_sim *sim)
{
    struct brc_fragments fragments;
    struct surface s = {.sim = sim, .fragments = &fragments};
    int code = brc_fragments_find(ctx, sim, &fragments);
    if (code == 0)
        code = open_surface(ctx, &s);
    for (size_t k = 0; k < fragments.n && code == 0; k++)
        put_fragment(out, &s, k);
    close_surface(&s);
    brc_fragments_free(&fragments);
    return code;
}

/* ---- formats ------------------------------------------------------------------------------- */

static int put_stl(struct brc_context *ctx, FILE *out, const void *what)
{
    return brc_export_stl(ctx, out, what);
}

static int put_tess(struct brc_context *ctx, FILE *out, const void *what)
{
    return brc_neper_write(ctx, out, what);
}

/* The specimen of a state or of a case file. */
static int load_specimen(struct brc_context *ctx, const char *path, struct loaded *l)
{
    if (brc_checksum_is_there(path, &brc_checksum_state))
        return load(ctx, path, l);
    memset(l, 0, sizeof *l);
    BRC_TRY(brc_case_read(ctx, &l->run_case, path, NULL, 0));
    return brc_specimen_create(ctx, &l->run_case.specimen, &l->specimen);
}

int brc_export_format(struct brc_context *ctx, const struct brc_export_options *order,
                      const char *format)
{
    struct loaded l;
    bool is_stl = strcmp(format, "stl") == 0;
    if (!is_stl && strcmp(format, "tess") != 0)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "unknown format '%.60s'; there are: stl, tess", format);
    int code = is_stl ? load(ctx, order->path, &l) : load_specimen(ctx, order->path, &l);
    const struct target stl = {put_stl, &l.sim}, tess = {put_tess, &l.specimen};
    if (code == 0)
        code = check_out(ctx, order, &l.run_case);
    if (code == 0)
        code = write_to(ctx, order->out, is_stl ? &stl : &tess);
    unload(&l);
    return code;
}
