/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Saved states for other programs. Tables come straight from a state's file, so that states of a
 * case whose inputs are gone can still be read; surfaces need the case, from which the specimen is
 * made anew, as states hold no geometry. Called by the program alone. */
#include "common/runs/export.h"

#include "common/base/text_file.h"
#include "common/base/tuples.h"
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

/* The model of a state. */
static int read_model(struct brc_context *ctx, const char *path, const struct brc_model **model)
{
    char *name;
    BRC_TRY(brc_h5_read_text(ctx, path, "model", &name));
    int code = brc_case_model(ctx, name, model);
    free(name);
    return code;
}

/* Loads a state; *l, all zero, is to be unloaded also after a failure. */
static int load(struct brc_context *ctx, const char *path, struct loaded *l)
{
    static const struct brc_h5_extra none = {NULL, 0, NULL, 0};
    const struct brc_model *model;
    char *text;
    BRC_TRY(brc_h5_read_text(ctx, path, "case", &text));
    int code = brc_case_parse(ctx, &l->run_case, path, text);
    free(text);
    BRC_TRY(code);
    BRC_TRY(read_model(ctx, path, &model));
    BRC_TRY(brc_specimen_create(ctx, &l->run_case.specimen, &l->specimen));
    BRC_TRY(brc_case_sim(ctx, &l->run_case, model, &l->specimen, &l->sim));
    return brc_h5_load(ctx, path, &l->sim, &none);
}

/* What is written: one of these, the others NULL. */
struct content {
    const struct brc_table *table;
    const struct brc_sim *fragments;
    const struct brc_specimen *tessellation;
};

/* The file out must not be there, nor where it is written first; what is read is never replaced,
 * with --force neither: the file and, where the case counts, those that it names. */
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

static int put(struct brc_context *ctx, FILE *out, const struct content *c)
{
    if (c->fragments)
        return brc_export_stl(ctx, out, c->fragments);
    if (c->tessellation)
        return brc_neper_write(ctx, out, c->tessellation);
    brc_output_table(out, c->table, NULL);
    return 0;
}

/* On the file at path, or on standard output where there is none. */
static int write_to(struct brc_context *ctx, const char *path, const struct content *c)
{
    struct brc_text_file file;
    if (!path)
        return put(ctx, stdout, c);
    BRC_TRY(brc_text_file_begin(ctx, &file, NULL, path));
    int code = put(ctx, file.out, c);
    if (code != 0)
        brc_text_file_drop(&file);
    return code != 0 ? code : brc_text_file_end(ctx, &file);
}

/* ---- tables -------------------------------------------------------------------------------- */

/* By the names of the groups in the file; parts without fields, and the row of scalars, are no
 * tables. */
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
int brc_export_table(struct brc_context *ctx, const struct brc_export_options *options,
                     const char *table)
{
    const struct brc_model *model;
    struct brc_sim sim;
    struct brc_state state;
    struct brc_state_part *part;
    BRC_TRY(check_out(ctx, options, NULL));
    BRC_TRY(read_model(ctx, options->path, &model));
    BRC_TRY(brc_sim_tables(ctx, &sim, model));
    brc_state_list(&sim, &state);
    int code = find_table(ctx, &state, table, &part);
    if (code == 0)
        code = brc_h5_load_table(ctx, options->path, part);
    if (code == 0)
        code = write_to(ctx, options->out, &(struct content){.table = part->table});
    brc_sim_free(&sim);
    return code;
}

/* ---- fragments ----------------------------------------------------------------------------- */

/* The vertices of one fragment at a time: each is met once a grain that has it, and lies in the
 * mean of where those grains carry it, as they may have moved apart. Marks rather than lists, so
 * that a fragment costs its own vertices only. */
struct surface {
    const struct brc_sim *sim;
    const struct brc_fragments *fragments;
    struct vertex {
        double sum[3];
        int32_t count, grain, fragment; /* met; last grain and fragment that it was met in */
    } * vertex;                         /* [n_vertices] */
    struct member {
        int32_t fragment, grain;
    } * member; /* [n_cells] by fragment, then grain */
};

/* Grains are sorted by fragment: those of one then stand together, in ascending order. */
static int open_surface(struct brc_context *ctx, struct surface *s)
{
    const struct brc_facets *f = &s->sim->specimen->facets;
    s->vertex = brc_alloc(ctx, f->n_vertices, sizeof *s->vertex);
    s->member = brc_alloc(ctx, f->n_cells, sizeof *s->member);
    if (!s->vertex || !s->member)
        return BRC_ERR_MEMORY;
    for (size_t v = 0; v < f->n_vertices; v++)
        s->vertex[v].grain = s->vertex[v].fragment = -1;
    for (size_t i = 0; i < f->n_cells; i++)
        s->member[i] = (struct member){s->fragments->of[i], (int32_t)i};
    qsort(s->member, f->n_cells, sizeof *s->member, brc_tuple2_compare);
    return 0;
}

/* A vertex that was last met in another fragment starts anew, so that the marks need not be cleared
 * between fragments; a grain meets its vertices once for each of its facets, and counts once. */
static void add_vertex(struct surface *s, int32_t v, int32_t grain, int32_t fragment)
{
    double x[3];
    struct vertex *at = &s->vertex[v];
    if (at->fragment != fragment)
        *at = (struct vertex){.grain = -1, .fragment = fragment};
    if (at->grain == grain)
        return;
    at->grain = grain;
    at->count++;
    brc_bodies_carry(&s->sim->bodies, (size_t)grain, s->sim->specimen->facets.vertex[v], x);
    brc_axpy(at->sum, 1, x);
}

/* STL wants the normal, too, though it follows from the corners. */
static void put_triangle(FILE *out, const struct surface *s, const int32_t v[3])
{
    double x[3][3], a[3], b[3], n[3];
    for (int k = 0; k < 3; k++)
        brc_scale(x[k], s->vertex[v[k]].sum, 1.0 / s->vertex[v[k]].count);
    brc_sub(a, x[1], x[0]);
    brc_sub(b, x[2], x[0]);
    brc_cross(n, a, b);
    brc_normalise(n, n);
    fprintf(out, "facet normal %.9g %.9g %.9g\n outer loop\n", n[0], n[1], n[2]);
    for (int k = 0; k < 3; k++)
        fprintf(out, "  vertex %.17g %.17g %.17g\n", x[k][0], x[k][1], x[k][2]);
    fputs(" endloop\nendfacet\n", out);
}

/* A facet of a grain as a fan of triangles, outward: cells are convex, so their facets are. None
 * where the fragment goes on behind it. The loop of a facet runs as its first cell sees it. */
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

/* The members from first to end are all of one fragment. All vertices are placed before a facet is
 * put, as the mean over the grains at one needs them all. */
static void put_fragment(FILE *out, struct surface *s, size_t first, size_t end)
{
    const struct brc_facets *f = &s->sim->specimen->facets;
    int32_t fragment = s->member[first].fragment;
    for (const struct member *p = s->member + first; p < s->member + end; p++)
        for (size_t j = f->cell_first[p->grain]; j < f->cell_first[p->grain + 1]; j++)
            for (size_t m = f->first[f->cell_facet[j]]; m < f->first[f->cell_facet[j] + 1]; m++)
                add_vertex(s, f->loop[m], p->grain, fragment);
    fprintf(out, "solid fragment_%d\n", fragment);
    for (const struct member *p = s->member + first; p < s->member + end; p++)
        for (size_t j = f->cell_first[p->grain]; j < f->cell_first[p->grain + 1]; j++)
            put_facet(out, s, (size_t)p->grain, (size_t)f->cell_facet[j]);
    fprintf(out, "endsolid fragment_%d\n", fragment);
}

/* Fragments by number, the largest first; each vertex is moved by all grains of its fragment that
 * have it, so that the surface has no gaps where grains have come apart by less than a break. */
int brc_export_stl(struct brc_context *ctx, FILE *out, const struct brc_sim *sim)
{
    struct brc_fragments fragments;
    struct surface s = {.sim = sim, .fragments = &fragments};
    int code = brc_fragments_find(ctx, sim, &fragments);
    if (code == 0)
        code = open_surface(ctx, &s);
    size_t n = code == 0 ? sim->specimen->facets.n_cells : 0;
    for (size_t first = 0, end; first < n; first = end) {
        for (end = first; end < n && s.member[end].fragment == s.member[first].fragment; end++)
            continue;
        put_fragment(out, &s, first, end);
    }
    free(s.vertex);
    free(s.member);
    brc_fragments_free(&fragments);
    return code;
}

/* ---- formats ------------------------------------------------------------------------------- */

/* A state is known by its checksum line, whatever its name is. */
static int load_specimen(struct brc_context *ctx, const char *path, struct loaded *l)
{
    if (brc_checksum_is_there(path, &brc_checksum_state))
        return load(ctx, path, l);
    BRC_TRY(brc_case_read(ctx, &l->run_case, path, NULL, 0));
    return brc_specimen_create(ctx, &l->run_case.specimen, &l->specimen);
}

/* -o is judged when all is loaded: which files are inputs, and may not be replaced, is known by the
 * case alone. */
int brc_export_format(struct brc_context *ctx, const struct brc_export_options *options,
                      const char *format)
{
    struct loaded l = {0};
    bool is_stl = strcmp(format, "stl") == 0;
    if (!is_stl && strcmp(format, "tess") != 0)
        BRC_FAIL(ctx, BRC_ERR_USAGE, "unknown format '%.60s'; there are: stl, tess", format);
    int code = is_stl ? load(ctx, options->path, &l) : load_specimen(ctx, options->path, &l);
    const struct content content = {.fragments = is_stl ? &l.sim : NULL,
                                    .tessellation = is_stl ? NULL : &l.specimen};
    if (code == 0)
        code = check_out(ctx, options, &l.run_case);
    if (code == 0)
        code = write_to(ctx, options->out, &content);
    brc_sim_free(&l.sim);
    brc_specimen_free(&l.specimen);
    brc_case_free(&l.run_case);
    return code;
}
