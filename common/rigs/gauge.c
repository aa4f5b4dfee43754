/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The strain of the middle of the specimen by the centres of its grains, as a strain gauge sees it:
 * the ends are held or rubbed by the platens. A slope over all grains of the gauge rather than the
 * distance of two, since single grains turn and slip. Called as a test begins, and for each row of
 * its curve. */
#include "common/rigs/gauge.h"

#include "common/engine/sim.h"
#include "common/parallel/sums.h"

#include <math.h>

/* Grains that a gauge strain needs, and their spread over the width of the gauge, or of the
 * specimen across the load; places all over a width have 0.29. */
enum { GAUGE_GRAINS = 4 };
static const double GAUGE_SPREAD = 0.1;

static bool is_in_gauge(const struct brc_sim *sim, size_t grain)
{
    const struct brc_rig *rig = &sim->rig;
    double middle = sim->bodies.x0[rig->platen[0].body][rig->axis] +
                    0.5 * rig->length[rig->axis] * rig->platen[0].n[rig->axis];
    double half = 0.5 * rig->length[rig->axis] * rig->params.gauge;
    return fabs(sim->bodies.x0[grain][rig->axis] - middle) <= half;
}

/* Grains in the gauge and the standard deviation of their places along k, which a slope needs: a
 * single layer would give the slope of its round-off. */
static void check_axis(struct brc_sim *sim, int k)
{
    struct brc_rig *rig = &sim->rig;
    double low[3], high[3], mean = 0, square = 0;
    size_t n = 0;
    brc_specimen_extent(sim->specimen, low, high);
    double width = k == rig->axis ? rig->length[k] * rig->params.gauge : high[k] - low[k];
    for (size_t i = 0; i < sim->bodies.n_grains; i++) {
        if (!is_in_gauge(sim, i))
            continue;
        double x = sim->bodies.x0[i][k] - 0.5 * (low[k] + high[k]), step = x - mean;
        double place = sim->bodies.x0[i][k];
        rig->gauge[k].x += place;
        rig->gauge[k].xx += place * place;
        mean += step / (double)++n;
        square += step * (x - mean);
    }
    rig->gauge[k].n = (double)n;
    rig->has_gauge[k] = n >= GAUGE_GRAINS && sqrt(square / (double)n) >= GAUGE_SPREAD * width;
}

/* Sums over the gauge's grains of u and x u, of displacements and places along k. Exact, as rows of
 * the curve are part of the state; the others count as zeros. */
static void sum_displacements(const struct brc_sim *sim, int k, double *u, double *xu)
{
    const struct brc_bodies *b = &sim->bodies;
    for (size_t i = 0; i < b->n_grains; i++)
        b->terms[i] = is_in_gauge(sim, i) ? b->x[i][k] - b->x0[i][k] : 0;
    *u = brc_sum_exact(b->terms, b->n_grains);
    for (size_t i = 0; i < b->n_grains; i++)
        b->terms[i] *= b->x0[i][k];
    *xu = brc_sum_exact(b->terms, b->n_grains);
}

double brc_gauge_strain(const struct brc_sim *sim, int k)
{
    const struct brc_gauge *g = &sim->rig.gauge[k];
    double u, xu;
    if (sim->rig.n_platens == 0)
        return 0;
    if (!sim->rig.has_gauge[k])
        return NAN;
    sum_displacements(sim, k, &u, &xu);
    return -(g->n * xu - g->x * u) / (g->n * g->xx - g->x * g->x);
}

void brc_gauge_check(struct brc_sim *sim)
{
    for (int k = 0; k < 3; k++)
        check_axis(sim, k);
}
