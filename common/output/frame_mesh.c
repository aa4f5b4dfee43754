/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of the present state, made in memory and apart from writing: the frame at the peak is kept
 * until it is certain that no larger load follows. Called by frames.c; knows no files.
 *
 * Every grain has points of its own, also where it touches another: each carries its corners to
 * where it is now, and broken facets show as gaps. */
#include "common/output/frame_mesh.h"

#include "common/geometry/vec.h"

#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_grain_cells
static const struct brc_field grain_fields[] = {BRC_GRAIN_CELL_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct brc_bond_cells
static const struct brc_field bond_fields[] = {BRC_BOND_CELL_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct brc_contact_cells
static const struct brc_field contact_fields[] = {BRC_CONTACT_CELL_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

void brc_frame_mesh_free(struct brc_frame_mesh *f)
{
    brc_mesh_free(&f->grains);
    brc_mesh_free(&f->bonds);
    brc_mesh_free(&f->contacts);
}

/* ---- grains -------------------------------------------------------------------------------- */

/* The point of each vertex in the grain that is being made, -1 where it has none yet. Numbers of
 * the grain before are told by `grain`: to take them back would be a second walk over its facets.
 */
struct grain_points {
    int64_t *number; /* [n_vertices] */
    size_t *grain;   /* [n_vertices] the grain that the number is for, 1 is the first */
};

static int grain_polygon(struct brc_context *ctx, const struct brc_sim *sim, size_t grain,
                         size_t facet, const struct grain_points *p, struct brc_mesh *m)
{
    const struct brc_facets *s = &sim->specimen->facets;
    size_t first = s->first[facet], n = s->first[facet + 1] - first;
    bool is_low = s->cell[facet][0] == (int32_t)grain;
    for (size_t i = 0; i < n; i++) {
        int32_t v = s->loop[first + (is_low ? i : n - 1 - i)]; /* outward */
        double x[3];
        if (p->grain[v] != grain + 1)
            p->number[v] = -1;
        p->grain[v] = grain + 1;
        brc_bodies_carry(&sim->bodies, grain, s->vertex[v], x);
        BRC_TRY(brc_mesh_corner(ctx, m, x, &p->number[v]));
    }
    return brc_mesh_end_cell(ctx, m);
}

static int grain_shapes(struct brc_context *ctx, const struct brc_sim *sim, struct brc_mesh *m)
{
    const struct brc_facets *s = &sim->specimen->facets;
    const struct grain_points p = {brc_alloc(ctx, s->n_vertices, sizeof *p.number),
                                   brc_alloc(ctx, s->n_vertices, sizeof *p.grain)};
    int code = p.number && p.grain ? 0 : BRC_ERR_MEMORY;
    for (size_t grain = 0; grain < s->n_cells && code == 0; grain++)
        for (size_t k = s->cell_first[grain]; k < s->cell_first[grain + 1] && code == 0; k++)
            code = grain_polygon(ctx, sim, grain, (size_t)s->cell_facet[k], &p, m);
    free(p.number);
    free(p.grain);
    return code;
}

/* Fragments are found anew for each frame: nothing else needs them while a run goes on. */
static int make_grains(struct brc_context *ctx, const struct brc_sim *sim, struct brc_frame_mesh *f)
{
    const struct brc_facets *s = &sim->specimen->facets;
    const struct brc_bodies *b = &sim->bodies;
    struct brc_grain_cells *cells = &f->grain_cells;
    struct brc_fragments fragments;
    int code = brc_fragments_find(ctx, sim, &fragments);
    if (code == 0)
        code = grain_shapes(ctx, sim, &f->grains);
    if (code == 0)
        code = brc_table_resize(ctx, &f->grains.cells, f->grains.n_cells);
    for (size_t grain = 0, i = 0; grain < s->n_cells && code == 0; grain++) {
        for (size_t k = s->cell_first[grain]; k < s->cell_first[grain + 1]; k++, i++) {
            const int32_t *cell = s->cell[s->cell_facet[k]];
            cells->grain[i] = (int32_t)grain;
            cells->facet[i] = s->cell_facet[k];
            cells->neighbour[i] = cell[0] == (int32_t)grain ? cell[1] : cell[0];
            cells->fragment[i] = fragments.of[grain];
            cells->fragment_volume[i] = fragments.volume[fragments.of[grain]];
            brc_sub(cells->displacement[i], b->x[grain], b->x0[grain]);
            brc_copy(cells->velocity[i], b->v[grain]);
            brc_copy(cells->spin[i], b->w[grain]);
        }
    }
    brc_fragments_free(&fragments);
    return code;
}

/* ---- bonds --------------------------------------------------------------------------------- */

void brc_frame_mesh_sides(const struct brc_sim *sim, size_t facet, const double p[3], double low[3],
                          double high[3])
{
    const int32_t *cell = sim->specimen->facets.cell[facet];
    brc_bodies_carry(&sim->bodies, (size_t)cell[0], p, low);
    brc_bodies_carry(&sim->bodies, (size_t)cell[1], p, high);
}

/* Half-way between the two sides: on either side the polygon would hide behind a grain. */
static int bond_polygon(struct brc_context *ctx, const struct brc_sim *sim, size_t facet,
                        struct brc_mesh *m)
{
    const struct brc_facets *s = &sim->specimen->facets;
    for (size_t i = s->first[facet]; i < s->first[facet + 1]; i++) {
        double low[3], high[3], x[3];
        int64_t number = -1;
        brc_frame_mesh_sides(sim, facet, s->vertex[s->loop[i]], low, high);
        brc_add(x, low, high);
        brc_scale(x, x, 0.5);
        BRC_TRY(brc_mesh_corner(ctx, m, x, &number));
    }
    return brc_mesh_end_cell(ctx, m);
}

/* Breaks of the facets, from the log and not from the contacts: those of facets that broke whole
 * may be gone. mesh_cell[facet] is the cell of a facet, -1 for none. */
static void add_breaks(const struct brc_sim *sim, const int64_t *mesh_cell,
                       struct brc_bond_cells *cells)
{
    const struct brc_events *e = &sim->events;
    const struct brc_facets *s = &sim->specimen->facets;
    double *const part[BRC_N_MODES] = {cells->tension, cells->shear, cells->torsion};
    for (size_t k = 0; k < e->table.n; k++) {
        int64_t i =
            e->facet[k] >= 0 && (size_t)e->facet[k] < s->n_facets ? mesh_cell[e->facet[k]] : -1;
        if (i < 0)
            continue;
        part[e->mode[k]][i] += e->area[k] / s->area[e->facet[k]];
        if (cells->first_break[i] < 0)
            cells->first_break[i] = e->step[k];
        int most = 0;
        for (int mode = 1; mode < BRC_N_MODES; mode++)
            most = part[mode][i] > part[most][i] ? mode : most;
        cells->mode[i] = most;
        cells->status[i] = BRC_BROKEN;
    }
}

/* What the contacts add: a bond that has broken in part is intact. */
static void add_contact_state(const struct brc_sim *sim, const int64_t *mesh_cell,
                              struct brc_bond_cells *cells)
{
    const struct brc_contacts *c = &sim->pairs;
    for (size_t k = 0; k < c->n; k++) {
        int64_t i = c->facet[k] >= 0 ? mesh_cell[c->facet[k]] : -1;
        if (i < 0)
            continue;
        if (c->status[k] != BRC_OPEN)
            cells->status[i] = c->status[k];
        brc_copy(cells->force[i], c->f[k]);
    }
}

/* Facets below the specimen's area limit (is_contact) close their cells and were never bonded: they
 * are no bonds here either. */
static int bond_shapes(struct brc_context *ctx, const struct brc_sim *sim, int64_t *mesh_cell,
                       struct brc_mesh *m)
{
    const struct brc_facets *s = &sim->specimen->facets;
    for (size_t facet = 0; facet < s->n_facets; facet++) {
        mesh_cell[facet] = -1;
        if (s->cell[facet][1] < 0 || !s->is_contact[facet])
            continue;
        mesh_cell[facet] = (int64_t)m->n_cells;
        BRC_TRY(bond_polygon(ctx, sim, facet, m));
    }
    return brc_table_resize(ctx, &m->cells, m->n_cells);
}

static int make_bonds(struct brc_context *ctx, const struct brc_sim *sim, struct brc_frame_mesh *f)
{
    const struct brc_facets *s = &sim->specimen->facets;
    struct brc_bond_cells *cells = &f->bond_cells;
    int64_t *mesh_cell = brc_alloc(ctx, s->n_facets, sizeof *mesh_cell);
    int code = mesh_cell ? bond_shapes(ctx, sim, mesh_cell, &f->bonds) : BRC_ERR_MEMORY;
    for (size_t facet = 0; facet < s->n_facets && code == 0; facet++) {
        int64_t i = mesh_cell[facet];
        double low[3], high[3];
        if (i < 0)
            continue;
        brc_frame_mesh_sides(sim, facet, s->centroid[facet], low, high);
        brc_sub(cells->opening[i], high, low);
        cells->facet[i] = (int32_t)facet;
        cells->a[i] = s->cell[facet][0];
        cells->b[i] = s->cell[facet][1];
        cells->mode[i] = -1;
        cells->first_break[i] = -1;
    }
    if (code == 0) {
        add_breaks(sim, mesh_cell, cells);
        add_contact_state(sim, mesh_cell, cells);
    }
    free(mesh_cell);
    return code;
}

/* ---- contacts ------------------------------------------------------------------------------ */

/* Ends of the line of a contact: the centres, or the grain's centre and the point of the platen
 * straight before it: a platen's body lies behind it, anywhere. */
static void line_ends(const struct brc_sim *sim, const struct brc_contacts *c, size_t k,
                      bool is_platen, double a[3], double b[3])
{
    const struct brc_bodies *bodies = &sim->bodies;
    brc_copy(a, bodies->x[c->a[k]]);
    brc_copy(b, bodies->x[c->b[k]]);
    if (!is_platen)
        return;
    const double *n = brc_sim_platen(sim, c->b[k])->n;
    double away[3];
    brc_sub(away, a, b);
    brc_copy(b, a);
    brc_axpy(b, -brc_dot(away, n), n);
}

/* A row at a time: how many contacts carry a force is known only when all have been seen. */
static int add_contacts(struct brc_context *ctx, const struct brc_sim *sim,
                        const struct brc_contacts *c, bool is_platen, struct brc_frame_mesh *f)
{
    struct brc_contact_cells *cells = &f->contact_cells;
    for (size_t k = 0; k < c->n; k++) {
        double end[2][3], along[3];
        size_t i = f->contacts.n_cells;
        if (brc_norm2(c->f[k]) == 0) /* near, but without a force: most of the list */
            continue;
        line_ends(sim, c, k, is_platen, end[0], end[1]);
        for (int side = 0; side < 2; side++) {
            int64_t number = -1;
            BRC_TRY(brc_mesh_corner(ctx, &f->contacts, end[side], &number));
        }
        BRC_TRY(brc_mesh_end_cell(ctx, &f->contacts));
        BRC_TRY(brc_table_resize(ctx, &f->contacts.cells, i + 1));
        brc_sub(along, end[1], end[0]);
        brc_normalise(along, along);
        cells->a[i] = c->a[k];
        cells->b[i] = c->b[k];
        cells->is_platen[i] = is_platen;
        cells->status[i] = c->status[k];
        brc_copy(cells->force[i], c->f[k]);
        cells->compression[i] = brc_dot(c->f[k], along);
        cells->gap[i] = c->gap[k];
    }
    return 0;
}

/* After a failure the meshes hold what was made so far, for brc_frame_mesh_free. */
int brc_frame_mesh_make(struct brc_context *ctx, const struct brc_sim *sim,
                        struct brc_frame_mesh *f)
{
    const struct brc_fieldset grains = BRC_FIELDSET(grain_fields, struct brc_grain_cells);
    const struct brc_fieldset bonds = BRC_FIELDSET(bond_fields, struct brc_bond_cells);
    const struct brc_fieldset contacts = BRC_FIELDSET(contact_fields, struct brc_contact_cells);
    memset(f, 0, sizeof *f);
    brc_mesh_init(&f->grains, BRC_MESH_POLYGONS, "grains", grains, &f->grain_cells);
    brc_mesh_init(&f->bonds, BRC_MESH_POLYGONS, "bonds", bonds, &f->bond_cells);
    brc_mesh_init(&f->contacts, BRC_MESH_LINES, "contacts", contacts, &f->contact_cells);
    BRC_TRY(make_grains(ctx, sim, f));
    BRC_TRY(make_bonds(ctx, sim, f));
    BRC_TRY(add_contacts(ctx, sim, &sim->pairs, false, f));
    return add_contacts(ctx, sim, &sim->platens, true, f);
}
