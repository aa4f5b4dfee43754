/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which rows are condensed, for how long, and by which tangent; condensed.h carries them along. */
#include "step.h"

/* A row is condensed when that is for this many steps or more: to find its tangent costs as much as
 * a step. */
static const double CONDENSE = 3;

void poly_account_bond(struct brc_sim *sim, size_t row, double stored)
{
    const struct poly_rows *rows = sim->pairs.model_columns;
    double gained = stored - rows->shift[row][POLY_SHIFT_STORED];
    rows->shift[row][POLY_SHIFT_STORED] = stored;
    if (!BRC_OPTION(sim->run.ledger))
        return;
    sim->ledger.bond += gained;
    sim->ledger.contact_normal -= gained;
}

/* Adds force and moment of a bond, and its slope, to what is carried along. */
static void hold_bond(const struct poly_block *block, int32_t i, double held[6],
                      double (*tangent)[6])
{
    const struct brc_sim *sim = block->sim;
    const struct poly_params *p = poly_params_of(sim);
    size_t row = (size_t)block->row[i];
    struct poly_bond bond = poly_bond_of(p, sim->pairs.model_columns, row);
    struct poly_bond_pose pose;
    struct poly_bond_result r;
    double arm[3], moment[3];
    poly_pose_bond(&pose, &sim->pairs, row, block->st, &sim->bodies, p->torsion);
    poly_bond_law(&r, &bond, &pose, p->torsion);
    brc_sub(arm, r.x, sim->bodies.x[block->a[i]]);
    brc_cross(moment, arm, r.f);
    for (int k = 0; k < 3; k++) {
        held[k] += r.f[k];
        held[3 + k] += moment[k] + r.m * r.n[k];
    }
    double kn = r.term[0] > 0 ? bond.kn : 0;
    for (int j = 0; j < 6; j++) {
        double unit[3] = {j % 3 == 0, j % 3 == 1, j % 3 == 2}, d[3], f[3];
        if (j < 3)
            brc_copy(d, unit);
        else
            brc_cross(d, unit, arm);
        double along = brc_dot(d, r.n);
        for (int k = 0; k < 3; k++)
            f[k] = kn * along * r.n[k] + bond.kt * (d[k] - along * r.n[k]);
        brc_cross(moment, arm, f);
        for (int k = 0; k < 3; k++) {
            tangent[j][k] += f[k];
            tangent[j][3 + k] += moment[k];
            if (j >= 3)
                tangent[j][3 + k] += bond.ktheta * r.n[j - 3] * r.n[k];
        }
    }
}

/* Relative path for which no point that sleeps can touch, `most` at most. That is also one for
 * which no vertex of `strict` leaves its face, since one of its edges comes or goes across the
 * face's then. */
static double path_of_sleepers(const struct brc_contacts *c, size_t row, double most)
{
    const struct poly_rows *rows = c->model_columns;
    const struct poly_points *points = c->point_columns;
    size_t p = (size_t)c->p0[row] + (size_t)rows->awake[row];
    size_t end = (size_t)c->p0[row] + (size_t)c->np[row];
    double room = rows->room[row];
    most = poly_least(most, room);
    for (; p < end && room - points->sleep[p] < most; p++)
        if (points->kind[p] != POLY_EDGES || points->hold[p] != POLY_FADES)
            return room - points->sleep[p];
    return most;
}

/* Relative path of a row before its bond can break, or begin or end to pull: openings change by
 * twice the path at most, strains by that over the strain length, the twist by the path over the
 * reach of b. */
static double path_of_bond(const struct poly_block *block, int32_t i)
{
    const struct poly_params *p = poly_params_of(block->sim);
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    const struct poly_row_group *g = &block->group[i / BRC_LANES];
    double length = *poly_bond_length(rows, (size_t)block->row[i]);
    double slope = 2 / (length * p->eps_th), path = 0.5 * fabs(g->opening[i % BRC_LANES]);
    if (p->torsion && p->theta_limit)
        slope += 1 / (block->sim->bodies.bounding_radius[block->b[i]] * p->theta_th);
    return p->breakable ? poly_least(path, (1 - g->broken[i % BRC_LANES]) / slope) : path;
}

/* Relative path for which a row may be condensed, as far as its acting springs do not matter. */
static double path_left(const struct poly_block *block, int32_t i)
{
    const struct poly_params *p = poly_params_of(block->sim);
    const struct brc_contacts *c = &block->sim->pairs;
    size_t row = (size_t)block->row[i];
    double most = p->condensed_path * p->radius;
    if (c->status[row] == BRC_INTACT)
        most = poly_least(most, path_of_bond(block, i));
    if (block->listed[i])
        return path_of_sleepers(c, row, most);
    return poly_least(block->group[i / BRC_LANES].gap[i % BRC_LANES], most);
}

/* Whether a path is worth it. What rests and may not move at all is not. */
static bool is_long(const struct poly_block *block, int32_t i, double path)
{
    return path > CONDENSE * block->group[i / BRC_LANES].path[i % BRC_LANES];
}

void poly_begin_tangent(struct poly_block *block, int32_t i)
{
    const struct poly_rows *rows = block->sim->pairs.model_columns;
    bool is_whole = !block->listed[i] || rows->ready[block->row[i]];
    block->steady[i] = is_whole && is_long(block, i, path_left(block, i));
    if (block->steady[i])
        memset(block->tangent[i], 0, sizeof block->tangent[i]);
}

void poly_condense_row(struct poly_block *block, int32_t i)
{
    struct brc_sim *sim = block->sim;
    const struct poly_rows *rows = sim->pairs.model_columns;
    size_t row = (size_t)block->row[i];
    bool is_intact = sim->pairs.status[row] == BRC_INTACT;
    double *shift = rows->shift[row];
    double stored = is_intact ? block->group[i / BRC_LANES].bond_stored[i % BRC_LANES] : 0;
    if (is_intact)
        poly_account_bond(sim, row, stored);
    memset(shift, 0, sizeof rows->shift[row]);
    shift[POLY_SHIFT_STORED] = stored;
    if (!block->steady[i] || block->open[i])
        return;
    double end = poly_least(block->lasting[i], path_left(block, i));
    if (!is_long(block, i, end))
        return;
    shift[POLY_SHIFT_END] = end;
    rows->carried[row] = 1;
    for (int k = 0; k < 6; k++)
        rows->held[row][k] = block->sum[i][POLY_SUM_NORMAL + k] + block->sum[i][POLY_SUM_SHEAR + k];
    memcpy(rows->tangent[row], block->tangent[i], sizeof rows->tangent[row]);
    if (is_intact)
        hold_bond(block, i, rows->held[row], (double(*)[6])rows->tangent[row]);
}
