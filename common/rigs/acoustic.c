/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Breaks are joined by union-find over those that are near, which a grid of cells finds: a run
 * breaks up to some 1e5 points, most of them in the few steps of its failure, where comparing all
 * with all would take minutes. Called when results are asked for; reads the log of cracks alone, so
 * that it knows no model.
 *
 * A break sets a pair of forces free, at the centres of its grains: the moments about these centres
 * that a force at the facet has beside it turn the grains, and are the part of the pair that is not
 * symmetric. So it goes, and what is left is the stress that the bond has carried times the volume
 * of its two grains (Love, Weber). Sources further away, whose loads change as waves pass, are
 * none of the event's: Hazzard and Young (2004) sum over all contacts of the grains that a crack
 * parts, which would need forces of whole contacts over steps to be kept for each break. */
#include "common/rigs/acoustic.h"

#include "common/base/disjoint.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct brc_acoustic
static const struct brc_field fields[] = {BRC_ACOUSTIC_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* ---- clusters ------------------------------------------------------------------------------ */

/* Cells whose diagonal is the reach, so that breaks in one cell are near, and one look at a cell's
 * latest break tells of all of them. By a table of hashes: fragments fly, and a grid over the box
 * of all places would have no bounds. */
struct cells {
    size_t mask;
    int64_t (*key)[3];
    int32_t *latest;   /* of a cell; -1: the slot is free */
    int32_t *previous; /* break of the same cell, -1: none */
};

enum { NEAR = 2 }; /* cells that the reach spans: the root of 3, rounded up */

/* The slot of a cell, or the free one where it would be. */
static size_t slot_of(const struct cells *c, const int64_t key[3])
{
    size_t i = (size_t)brc_hash_bytes(key, 3 * sizeof *key, BRC_HASH_SEED) & c->mask;
    while (c->latest[i] >= 0 && memcmp(c->key[i], key, sizeof c->key[i]) != 0)
        i = (i + 1) & c->mask;
    return i;
}

/* Joins a break with those of a cell. All of its breaks that are not too long ago are one set, as
 * they are near each other. */
static void join_cell(const struct cells *c, int32_t i, size_t slot, const int64_t *step,
                      double (*x)[3], int64_t steps, double reach, int32_t *of)
{
    int32_t j = c->latest[slot];
    if (j < 0 || brc_disjoint_root(of, j) == brc_disjoint_root(of, i))
        return;
    for (; j >= 0 && step[i] - step[j] <= steps; j = c->previous[j])
        if (brc_distance(x[i], x[j]) <= reach) {
            brc_disjoint_join(of, i, j);
            return;
        }
}

static void join_near(struct cells *c, int32_t i, const int64_t *step, double (*x)[3],
                      int64_t steps, double reach, int32_t *of)
{
    /* a little smaller, so that rounding makes no diagonal longer than the reach */
    double size = reach / 1.7321;
    int64_t own[3], key[3];
    for (int k = 0; k < 3; k++)
        own[k] = (int64_t)floor(x[i][k] / size);
    for (int m = 0; m < 125; m++) {
        const int shift[3] = {m % 5 - NEAR, m / 5 % 5 - NEAR, m / 25 - NEAR};
        for (int k = 0; k < 3; k++)
            key[k] = own[k] + shift[k];
        join_cell(c, i, slot_of(c, key), step, x, steps, reach, of);
    }
    size_t slot = slot_of(c, own);
    memcpy(c->key[slot], own, sizeof own);
    c->previous[i] = c->latest[slot];
    c->latest[slot] = i;
}

/* From roots to numbers, in place: a root is the lowest of its set, so its number is there before
 * it is asked for. */
static size_t number(int32_t *of, size_t n)
{
    size_t n_sets = 0;
    for (size_t i = 0; i < n; i++)
        of[i] = brc_disjoint_root(of, (int32_t)i);
    for (size_t i = 0; i < n; i++)
        of[i] = of[i] == (int32_t)i ? (int32_t)n_sets++ : of[of[i]];
    return n_sets;
}

int brc_acoustic_cluster(struct brc_context *ctx, const int64_t *step, double (*x)[3], size_t n,
                         int64_t steps, double reach, int32_t *of, size_t *n_events)
{
    size_t size = 16;
    while (size < 2 * n)
        size *= 2;
    struct cells c = {.mask = size - 1,
                      .key = brc_alloc(ctx, size, sizeof *c.key),
                      .latest = brc_alloc(ctx, size, sizeof *c.latest),
                      .previous = brc_alloc(ctx, n, sizeof *c.previous)};
    int code = c.key && c.latest && c.previous ? 0 : BRC_ERR_MEMORY;
    if (code == 0)
        memset(c.latest, -1, size * sizeof *c.latest);
    for (size_t i = 0; code == 0 && i < n; i++) {
        of[i] = (int32_t)i;
        join_near(&c, (int32_t)i, step, x, steps, reach, of);
    }
    *n_events = code == 0 ? number(of, n) : 0;
    free(c.key);
    free(c.latest);
    free(c.previous);
    return code;
}

/* ---- moments ------------------------------------------------------------------------------- */

/* Adds -sum of forces on the grains times their places: the force on b goes, and its opposite on a.
 * As they sum to 0, the places count from wherever one likes, and their difference is the branch.
 * With this sign a crack that opens has a positive trace, as an explosion has in seismology. */
static void add_moment(const struct brc_events *e, size_t event, double moment[6])
{
    static const int index[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    const double *f = e->force[event], *l = e->branch[event];
    for (int k = 0; k < 6; k++) {
        int i = index[k][0], j = index[k][1];
        moment[k] -= 0.5 * (f[i] * l[j] + f[j] * l[i]);
    }
}

/* Sum of the squares of all nine entries. */
static double squares(const double m[6])
{
    return m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + 2 * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5]);
}

double brc_acoustic_r(const double m[6])
{
    double trace = m[0] + m[1] + m[2], mean = trace / 3, part[3], sum = 0;
    double entries[9] = {m[0] - mean, m[5], m[4], m[5], m[1] - mean, m[3], m[4], m[3], m[2] - mean};
    if (!(squares(m) > 0))
        return NAN;
    gsl_matrix_view matrix = gsl_matrix_view_array(entries, 3, 3);
    gsl_vector_view values = gsl_vector_view_array(part, 3);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
    if (!work)
        return NAN;
    gsl_eigen_symm(&matrix.matrix, &values.vector, work);
    gsl_eigen_symm_free(work);
    for (int k = 0; k < 3; k++)
        sum += fabs(part[k]);
    return 100 * trace / (fabs(trace) + sum);
}

/* ---- events -------------------------------------------------------------------------------- */

static void add_break(const struct brc_events *e, struct brc_acoustic *a, size_t to, size_t event)
{
    if (a->breaks[to]++ == 0)
        a->first_step[to] = e->step[event];
    a->last_step[to] = e->step[event];
    a->tension[to] += e->mode[event] == BRC_MODE_TENSION;
    a->area[to] += e->area[event];
    a->energy[to] += e->energy[event];
    brc_axpy(a->x[to], e->area[event], e->x[event]);
    add_moment(e, event, a->moment[to]);
}

/* Both lists ascend, so that one walk finds all rows. */
static void set_loads(const struct brc_curve *c, struct brc_acoustic *a)
{
    size_t row = 0;
    for (size_t i = 0; i < a->table.n; i++) {
        while (row < c->table.n && c->step[row] < a->first_step[i])
            row++;
        a->strain[i] = row < c->table.n ? c->strain[row] : NAN;
        a->stress[i] = row < c->table.n ? c->stress[row] : NAN;
    }
}

static void finish(struct brc_acoustic *a)
{
    for (size_t i = 0; i < a->table.n; i++) {
        brc_scale(a->x[i], a->x[i], 1 / a->area[i]);
        a->magnitude[i] = a->energy[i] > 0 ? 2.0 / 3 * log10(a->energy[i]) - 3.2 : NAN;
        a->scalar_moment[i] = sqrt(0.5 * squares(a->moment[i]));
        a->moment_magnitude[i] =
            a->scalar_moment[i] > 0 ? 2.0 / 3 * log10(a->scalar_moment[i]) - 6.07 : NAN;
        a->r[i] = brc_acoustic_r(a->moment[i]);
    }
}

/* run.skin is in mean grain radii, so this is one. */
static double mean_radius(const struct brc_sim *sim)
{
    return sim->skin / sim->run.skin;
}

int brc_acoustic_find(const struct brc_sim *sim, struct brc_acoustic *out)
{
    const struct brc_events *e = &sim->events;
    struct brc_fieldset set = BRC_FIELDSET(fields, struct brc_acoustic);
    size_t n_events;
    *out = (struct brc_acoustic){0};
    brc_table_init(&out->table, "acoustic", set, out);
    int32_t *of = brc_alloc(sim->ctx, e->table.n, sizeof *of);
    if (!of)
        return BRC_ERR_MEMORY;
    const struct brc_test_params *p = &sim->rig.params;
    int code = brc_acoustic_cluster(sim->ctx, e->step, e->x, e->table.n, p->acoustic_steps,
                                    p->acoustic_radii * mean_radius(sim), of, &n_events);
    if (code == 0)
        code = brc_table_resize(sim->ctx, &out->table, n_events);
    for (size_t i = 0; code == 0 && i < e->table.n; i++)
        add_break(e, out, (size_t)of[i], i);
    free(of);
    BRC_TRY(code);
    set_loads(&sim->rig.curve, out);
    finish(out);
    return 0;
}

void brc_acoustic_free(struct brc_acoustic *a)
{
    brc_table_free(&a->table);
}
