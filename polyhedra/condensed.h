/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows that are condensed, four at a time: carried along by their tangents until they have used up
 * their path. */
#ifndef POLY_CONDENSED_H
#define POLY_CONDENSED_H

#include "polyhedra/motion.h"

/* Force on b and its moment about the centre of a of four rows: what they were, less the tangent
 * times the motion, turned with the pair. */
BRC_LANES_INLINE void tangent_forces(struct poly_wrenches *w, const struct poly_rows *rows,
                                     const struct shifts *s, const int32_t row[BRC_LANES])
{
    const brc_lanes motion[6] = {s->d[0], s->d[1], s->d[2], s->turn[0], s->turn[1], s->turn[2]};
    brc_lanes first[BRC_LANES], last[BRC_LANES]; /* of six, which begin at 0 and at 2 */
    brc_lanes both[3], turned[3];
    for (int k = 0; k < BRC_LANES; k++) {
        const double *slope = rows->tangent[row[k]];
        first[k] = brc_lanes_at(rows->held[row[k]]);
        last[k] = brc_lanes_at(rows->held[row[k]] + 2);
        for (int j = 0; j < 6; j++) {
            brc_lanes by = brc_lanes_all(((const double *)&motion[j])[k]);
            first[k] -= brc_lanes_at(slope + 6 * j) * by;
            last[k] -= brc_lanes_at(slope + 6 * j + 2) * by;
        }
    }
    brc_lanes_transpose(first);
    brc_lanes_transpose(last);
    scale(both, s->both, brc_lanes_all(2));
    set(w->f, first[0], first[1], first[2]);
    brc_lanes_cross(turned, both, w->f);
    add(w->f, w->f, turned);
    set(w->m, last[1], last[2], last[3]);
    brc_lanes_cross(turned, both, w->m);
    add(w->m, w->m, turned);
}

/* Work that four rows take up in a step by the trapezoid rule of ledger.h; their last force and
 * moment are those of the columns. The power of force f and moment m about the centre of a is
 * f . u + m . dw, with the velocity u of b relative to a at that centre, and the spin dw. */
BRC_LANES_INLINE brc_lanes work_of_rows(const struct brc_contacts *c, const struct poly_wrenches *w,
                                        const struct poly_row_group *g,
                                        const int32_t row[BRC_LANES], double dt)
{
    brc_lanes f[3], m[3], u[3], dw[3], back[3];
    brc_lanes_gather3(f, c->f, row);
    brc_lanes_gather3(m, c->ta, row); /* on a */
    brc_lanes_cross(u, g->x, g->wb);
    add(u, g->dv, u);
    sub(dw, g->wb, g->wa);
    brc_lanes_cross(back, g->wb, g->dv); /* of u, per time, to the last step's place of b */
    brc_lanes last = dt * brc_lanes_dot(f, back);
    add(f, f, w->f);
    sub(m, w->m, m);
    return -0.5 * dt * (brc_lanes_dot(f, u) + brc_lanes_dot(m, dw) + last);
}

/* Where the pairs have turned too far, as a whole, for the first order of the turn. */
BRC_LANES_INLINE brc_mask turns_far(const struct poly_block *block, const struct shifts *s)
{
    double most = 0.5 * poly_params_of(block->sim)->condensed_path;
    return brc_lanes_less(brc_lanes_all(most * most), brc_lanes_dot(s->both, s->both));
}

/* Moves four rows by a step. Returns how many of them are left to do: where some have used up their
 * path, none is moved, and the others come first in i. */
BRC_LANES_INLINE int carry_four(struct poly_block *block, struct numbers *i, int n,
                                const bool ledger)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    struct poly_row_group g;
    struct poly_wrenches w;
    struct frames f;
    struct shifts s;
    for (int k = 0; k < BRC_LANES; k++) {
        i->row[k] = i->row[k < n ? k : 0];
        i->a[k] = c->a[i->row[k]];
        i->b[k] = c->b[i->row[k]];
    }
    motion_of_group(block, &g, &f, i);
    gather_shifts(&s, rows, i->row);
    add_shifts(&s, &f, &g, block->sim->dt);
    brc_mask stays = brc_lanes_less(s.path, s.end) & ~turns_far(block, &s);
    if (brc_lanes_any(~stays)) {
        int left = 0;
        for (int k = 0; k < n; k++) {
            rows->carried[i->row[k]] = stays[k] != 0;
            i->row[left] = i->row[k];
            left += stays[k] != 0;
        }
        return left;
    }
    tangent_forces(&w, rows, &s, i->row);
    put_shifts(rows, i->row, &s);
    if (ledger)
        block->carried_work +=
            brc_lanes_where(brc_lanes_first(n), work_of_rows(c, &w, &g, i->row, block->sim->dt));
    put_wrenches(c, &w, &g, i->row);
    return 0;
}

BRC_LANES_INLINE void carry_kernel(struct poly_block *block, const bool ledger)
{
    const struct brc_contacts *c = &block->sim->pairs;
    const struct poly_rows *rows = c->model_columns;
    struct numbers i;
    int n = 0;
    block->carried_work = brc_lanes_all(0);
    for (size_t row = 0; row < c->n; row++) {
        i.row[n] = (int32_t)row;
        n += rows->carried[row];
        if (n == BRC_LANES)
            n = carry_four(block, &i, n, ledger);
    }
    while (n > 0)
        n = carry_four(block, &i, n, ledger);
    if (ledger)
        block->sim->ledger.contact_normal += brc_lanes_sum(block->carried_work);
}

#endif
