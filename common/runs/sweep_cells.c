/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/runs/sweep_cells.h"

#include "common/rigs/readings.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

/* ---- statistics ---------------------------------------------------------------------------- */

struct brc_sweep_mean brc_sweep_mean(const double *value, size_t n)
{
    struct brc_sweep_mean m = {0, NAN, NAN, NAN, NAN};
    double sum = 0, squares = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(value[i])) {
            sum += value[i];
            m.n++;
        }
    if (m.n == 0)
        return m;
    m.mean = sum / m.n;
    if (m.n == 1)
        return m;
    for (size_t i = 0; i < n; i++)
        if (isfinite(value[i]))
            squares += (value[i] - m.mean) * (value[i] - m.mean);
    m.standard_error = sqrt(squares / (m.n - 1) / m.n);
    double half = gsl_cdf_tdist_Pinv(0.975, m.n - 1) * m.standard_error;
    m.low = m.mean - half;
    m.high = m.mean + half;
    return m;
}

/* ---- cells --------------------------------------------------------------------------------- */

static bool is_same_cell(const struct brc_sweep_run *a, const struct brc_sweep_run *b)
{
    if (a->group != b->group)
        return false;
    for (size_t k = 0; k < a->group->n_axes; k++)
        if (!a->group->axis[k].is_over && a->at[k] != b->at[k])
            return false;
    return true;
}

bool brc_sweep_is_good(const struct brc_sweep_run *run)
{
    return run->is_done && run->kept.code == 0;
}

static void count(struct brc_sweep_cell *c)
{
    for (size_t i = 0; i < c->n; i++) {
        c->n_done += c->run[i]->is_done;
        c->n_failed += c->run[i]->is_done && !brc_sweep_is_good(c->run[i]);
        if (brc_sweep_is_good(c->run[i]))
            c->cpu_s += c->run[i]->kept.cpu_s;
    }
    c->cpu_s = c->n_done > c->n_failed ? c->cpu_s / (c->n_done - c->n_failed) : NAN;
}

/* In the order of their first runs. */
static int find_cells(struct brc_sweep_cells *c)
{
    const struct brc_sweep_runs *runs = c->runs;
    c->cell = brc_pool_alloc(c->ctx, &c->pool, runs->n, sizeof *c->cell);
    c->value = brc_pool_alloc(c->ctx, &c->pool, runs->n, sizeof *c->value);
    if (c->pool.is_failed)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < runs->n; i++) {
        const struct brc_sweep_run *run = &runs->run[i];
        size_t k = 0, most = 1;
        while (k < c->n && !is_same_cell(c->cell[k].run[0], run))
            k++;
        for (size_t a = 0; a < run->group->n_axes; a++)
            most *= run->group->axis[a].is_over ? run->group->axis[a].n : 1;
        if (k == c->n) {
            /* NOLINTNEXTLINE(bugprone-sizeof-expression): an array of pointers is meant */
            c->cell[k].run = brc_pool_alloc(c->ctx, &c->pool, most, sizeof *c->cell[k].run);
            if (!c->cell[k].run)
                return BRC_ERR_MEMORY;
            c->n++;
        }
        c->cell[k].run[c->cell[k].n++] = run;
    }
    for (size_t k = 0; k < c->n; k++)
        count(&c->cell[k]);
    return 0;
}

struct brc_sweep_mean brc_sweep_cell_mean(struct brc_sweep_cells *c,
                                          const struct brc_sweep_cell *cell, const char *quantity)
{
    for (size_t i = 0; i < cell->n; i++)
        c->value[i] =
            brc_sweep_is_good(cell->run[i]) ? brc_kept_result(&cell->run[i]->kept, quantity) : NAN;
    return brc_sweep_mean(c->value, cell->n);
}

const struct brc_quantity *brc_sweep_quantity(const struct brc_rig_type *rig, int i)
{
    int reading = i - rig->n_quantities;
    return reading < 0                ? &rig->quantities[i]
           : reading < BRC_N_READINGS ? &brc_readings_quantities[reading]
                                      : NULL;
}

bool brc_sweep_is_collected(const struct brc_sweep_group *g, const char *name)
{
    for (size_t i = 0; i < g->n_collect; i++)
        if (strcmp(g->collect[i], name) == 0)
            return true;
    return g->n_collect == 0;
}

int brc_sweep_shown(const struct brc_sweep_run *run, const struct brc_quantity **shown, int cap)
{
    const struct brc_sweep_group *g = run->group;
    const struct brc_quantity *q;
    int n = 0;
    for (size_t k = 0; k < (g->n_collect > 0 ? g->n_collect : 1); k++)
        for (int i = 0; (q = brc_sweep_quantity(run->rig, i)) != NULL && n < cap; i++)
            if (g->n_collect == 0 || strcmp(q->name, g->collect[k]) == 0)
                shown[n++] = q;
    return n;
}

int brc_sweep_cells_make(struct brc_context *ctx, const struct brc_sweep_runs *runs,
                         struct brc_sweep_cells *out)
{
    *out = (struct brc_sweep_cells){.ctx = ctx, .runs = runs};
    return find_cells(out);
}

void brc_sweep_cells_free(struct brc_sweep_cells *c)
{
    brc_pool_free(&c->pool);
}
