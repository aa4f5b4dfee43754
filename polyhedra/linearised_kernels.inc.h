/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts that are linearised, four at a time: carried along by their tangents until they have
 * used up their path. The first part of a step; contacts whose path ends here are computed
 * literally in the rest of it. May not read any point, for that is what linearising saves. */
#ifndef POLY_LINEARISED_KERNELS_H
#define POLY_LINEARISED_KERNELS_H

#include "polyhedra/motion_kernels.inc.h"

/* Force on b and its moment about the centre of a of four contacts: what they were, less the
 * tangent times the motion, turned with the pair. The turn is taken to first order, so
 * poly_turns_far ends it early. */
BRC_LANES_INLINE void poly_tangent_forces(struct poly_wrench4 *w,
                                          const struct poly_contacts *columns,
                                          const struct poly_motion4 *s,
                                          const int32_t contact[BRC_LANES])
{
    const brc_lanes motion[6] = {s->d[0], s->d[1], s->d[2], s->turn[0], s->turn[1], s->turn[2]};
    brc_lanes first[BRC_LANES], last[BRC_LANES]; /* of six, which begin at 0 and at 2 */
    brc_lanes both[3], turned[3];
    for (int k = 0; k < BRC_LANES; k++) {
        const double *slope = columns->tangent[contact[k]];
        first[k] = brc_lanes_at(columns->linearised_force[contact[k]]);
        last[k] = brc_lanes_at(columns->linearised_force[contact[k]] + 2);
        for (int j = 0; j < 6; j++) {
            brc_lanes by = brc_lanes_all(((const double *)&motion[j])[k]);
            first[k] -= brc_lanes_at(slope + 6 * j) * by;
            last[k] -= brc_lanes_at(slope + 6 * j + 2) * by;
        }
    }
    brc_lanes_transpose(first);
    brc_lanes_transpose(last);
    poly_scale3(both, s->both, brc_lanes_all(2));
    poly_set3(w->f, first[0], first[1], first[2]);
    brc_lanes_cross(turned, both, w->f);
    poly_add3(w->f, w->f, turned);
    poly_set3(w->m, last[1], last[2], last[3]);
    brc_lanes_cross(turned, both, w->m);
    poly_add3(w->m, w->m, turned);
}

/* Work that four contacts take up in a step by the trapezoid rule of ledger.h; their last force and
 * moment are those of the columns. The power of force f and moment m about the centre of a is
 * f . u + m . dw, with the velocity u of b relative to a at that centre, and the spin dw. */
BRC_LANES_INLINE brc_lanes poly_work_of_four(const struct brc_contacts *c,
                                             const struct poly_wrench4 *w,
                                             const struct poly_contact4 *g,
                                             const int32_t contact[BRC_LANES], double dt)
{
    brc_lanes f[3], m[3], u[3], dw[3], back[3];
    brc_lanes_gather3(f, c->f, contact);
    brc_lanes_gather3(m, c->ta, contact); /* on a */
    brc_lanes_cross(u, g->x, g->wb);
    poly_add3(u, g->dv, u);
    poly_sub3(dw, g->wb, g->wa);
    brc_lanes_cross(back, g->wb, g->dv); /* of u, per time, to the last step's place of b */
    brc_lanes last = dt * brc_lanes_dot(f, back);
    poly_add3(f, f, w->f);
    poly_sub3(m, w->m, m);
    return -0.5 * dt * (brc_lanes_dot(f, u) + brc_lanes_dot(m, dw) + last);
}

/* Where the pairs have turned too far, as a whole, for the first order of the turn. */
BRC_LANES_INLINE brc_mask poly_turns_far(const struct poly_batch *batch,
                                         const struct poly_motion4 *s)
{
    double most = 0.5 * poly_params_of(batch->sim)->condensed_path;
    return brc_lanes_less(brc_lanes_all(most * most), brc_lanes_dot(s->both, s->both));
}

/* Where contacts have come to their ends and may go on (poly_look_at_sleepers), they stay. Lanes
 * from n on have the first contact once more. */
BRC_LANES_INLINE void poly_look_on(struct poly_batch *batch, brc_mask *stays,
                                   struct poly_motion4 *s, const struct poly_index4 *i, int n)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    for (int k = 0; k < BRC_LANES; k++) {
        size_t contact = (size_t)i->contact[k];
        if ((*stays)[k])
            continue;
        if (k < n ? poly_look_at_sleepers(batch, contact, s->path[k]) : (*stays)[0] != 0) {
            (*stays)[k] = -1;
            s->end[k] = columns->motion[contact][POLY_MOTION_END];
        }
    }
}

/* Moves four contacts by a step. Returns how many of them are left to do: where some have used up
 * their path, none is moved, and the others come first in i. None is moved, as a store to some
 * lanes alone would cost all of them; those that stay are taken again with the next ones, so that
 * no lane's result depends on the others. */
BRC_LANES_INLINE int poly_move_linearised(struct poly_batch *batch, struct poly_index4 *i, int n,
                                          const int flags)
{
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    struct poly_contact4 g;
    struct poly_wrench4 w;
    struct poly_frame4 f;
    struct poly_motion4 s;
    for (int k = 0; k < BRC_LANES; k++) {
        i->contact[k] = i->contact[k < n ? k : 0];
        i->a[k] = c->a[i->contact[k]];
        i->b[k] = c->b[i->contact[k]];
    }
    poly_motion_of_four(batch, &g, &f, i, false);
    poly_gather_rows((brc_lanes *)&s, columns->motion[0], POLY_MOTION, i->contact, POLY_MOTION);
    poly_motion_add_step(&s, &f, &g, batch->sim->dt);
    brc_mask stays = brc_lanes_less(s.path, s.end), far = poly_turns_far(batch, &s);
    if (batch->looks && brc_lanes_any(~stays))
        poly_look_on(batch, &stays, &s, i, n);
    stays &= ~far;
    if (brc_lanes_any(~stays)) {
        int left = 0;
        for (int k = 0; k < n; k++) {
            columns->is_linearised[i->contact[k]] = stays[k] != 0;
            i->contact[left] = i->contact[k];
            left += stays[k] != 0;
        }
        return left;
    }
    poly_tangent_forces(&w, columns, &s, i->contact);
    poly_put_rows(columns->motion[0], POLY_MOTION, i->contact, (brc_lanes *)&s, POLY_MOTION);
    if (flags & POLY_LEDGER) {
        brc_lanes work = poly_work_of_four(c, &w, &g, i->contact, batch->sim->dt);
        for (int k = 0; k < n; k++)
            batch->sim->bodies.energy[i->a[k]][BRC_ACCOUNT_NORMAL] += work[k];
    }
    poly_put_wrenches(c, &w, &g, i->contact);
    return 0;
}

/* The number is written for every contact and counted for those that are linearised, so that
 * nothing branches. */
BRC_LANES_INLINE void poly_linearised_kernel(struct poly_batch *batch, const int flags)
{
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    struct poly_index4 i;
    int n = 0;
    for (size_t contact = 0; contact < c->n; contact++) {
        i.contact[n] = (int32_t)contact;
        n += columns->is_linearised[contact];
        if (n == BRC_LANES)
            n = poly_move_linearised(batch, &i, n, flags);
    }
    while (n > 0)
        n = poly_move_linearised(batch, &i, n, flags);
}

#endif
