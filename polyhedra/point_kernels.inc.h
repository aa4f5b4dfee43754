/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The points of a batch's lists, four at a time: their geometry from items, then forces and springs
 * into the sums of their contacts. What points are is known by their items alone; which contact
 * they belong to is felt only where their sums are added. */
#ifndef POLY_POINT_KERNELS_H
#define POLY_POINT_KERNELS_H

#include "polyhedra/motion_kernels.inc.h"
#include "polyhedra/platen_geometry.h"

/* --- geometry --------------------------------------------------------------------------------- */

/* Distance s and outward normal n of v from planes. */
BRC_LANES_INLINE void poly_distance_to_planes(brc_lanes *s, brc_lanes n[3],
                                              const struct poly_batch *batch, const brc_lanes v[3],
                                              const int32_t *const item[])
{
    const double *plane[BRC_LANES];
    brc_lanes p[BRC_LANES];
    for (int k = 0; k < BRC_LANES; k++)
        plane[k] = batch->st->global_planes[item[k][POLY_ITEM_FEATURE]];
    brc_lanes_gather4(p, plane);
    poly_set3(n, p[0], p[1], p[2]);
    *s = brc_lanes_dot(n, v) - p[3];
}

/* Distance s and outward normal n of v from edges or vertices. Of an edge the part along it is
 * taken off; a vertex, both ends of which are one, has no direction, and the mask keeps 0/0 out. */
BRC_LANES_INLINE void poly_distance_to_edges(brc_lanes *s, brc_lanes n[3],
                                             const struct poly_batch *batch, const brc_lanes v[3],
                                             const int32_t *const item[])
{
    double(*vertices)[3] = batch->st->global_vertices;
    int32_t i[2][BRC_LANES];
    for (int k = 0; k < BRC_LANES; k++) {
        i[0][k] = item[k][POLY_ITEM_FEATURE];
        i[1][k] = item[k][POLY_ITEM_FEATURE + 1];
    }
    brc_lanes p[3], along[3];
    brc_lanes_gather3(p, vertices, i[0]);
    brc_lanes_gather3(along, vertices, i[1]);
    poly_sub3(along, along, p);
    poly_sub3(n, v, p);
    brc_lanes length2 = brc_lanes_dot(along, along);
    brc_lanes part = brc_lanes_where(poly_positive(length2), brc_lanes_dot(n, along) / length2);
    poly_axpy3(n, -part, along);
    *s = brc_lanes_sqrt(brc_lanes_dot(n, n));
    poly_scale3(n, n, 1 / *s);
}

/* Number of vertex i of the other core that may lower the weight, or -1. */
BRC_LANES_INLINE int32_t poly_near_vertex(const int32_t *item, int32_t i)
{
    const int32_t *near = item + POLY_ITEM_NEAR;
    if (i >= item[POLY_ITEM_LIST] >> POLY_NEAR_SHIFT)
        return -1;
    return item[POLY_ITEM_LIST] & POLY_IN_TURN ? near[0] + i : near[i];
}

/* Near vertices of the other core lower the weights of vertices v. */
BRC_LANES_INLINE void poly_fade_vertices(struct poly_geometry4 *t, const struct poly_batch *batch,
                                         const brc_lanes v[3], brc_lanes sign,
                                         const int32_t *const item[], int32_t n_near)
{
    struct poly_fading f;
    poly_fading_begin(&f);
    for (int32_t i = 0; i < n_near; i++) {
        int32_t u[BRC_LANES];
        brc_mask is_near;
        brc_lanes r[3];
        for (int k = 0; k < BRC_LANES; k++) {
            u[k] = poly_near_vertex(item[k], i);
            is_near[k] = u[k] < 0 ? 0 : -1;
            u[k] = u[k] < 0 ? item[k][POLY_ITEM_VERTEX] : u[k];
        }
        brc_lanes_gather3(r, batch->st->global_vertices, u);
        poly_sub3(r, v, r);
        poly_fading_add(&f, r, is_near, &batch->len);
    }
    poly_weigh_vertex(t, v, sign, &f);
}

/* As many turns of fading as the vertex with most near vertices needs. */
BRC_LANES_INLINE void poly_vertices_of_tasks(struct poly_geometry4 *t,
                                             const struct poly_batch *batch,
                                             const struct poly_task *task, const bool flat,
                                             const enum poly_rule rule)
{
    const struct poly_points *points = batch->contacts->point_columns;
    const int32_t *item[BRC_LANES];
    int32_t vertex[BRC_LANES], n_near = 0;
    brc_lanes v[3], s, out[3], sign;
    for (int k = 0; k < BRC_LANES; k++) {
        item[k] = points->item[task[k].point];
        vertex[k] = item[k][POLY_ITEM_VERTEX];
        sign[k] = item[k][POLY_ITEM_LIST] & POLY_OF_A ? -1 : 1;
        n_near = item[k][POLY_ITEM_LIST] >> POLY_NEAR_SHIFT > n_near
                     ? item[k][POLY_ITEM_LIST] >> POLY_NEAR_SHIFT
                     : n_near;
    }
    brc_lanes_gather3(v, batch->st->global_vertices, vertex);
    if (flat)
        poly_distance_to_planes(&s, out, batch, v, item);
    else
        poly_distance_to_edges(&s, out, batch, v, item);
    brc_mask touches = poly_vertex_geometry(t, v, s, out, sign, batch->len.contact_distance);
    /* Which faces count is another question inside the core. The nearest of them is as far. */
    if (rule == POLY_CLOSED)
        t->valid_path = brc_lanes_min(t->valid_path, s);
    if (n_near > 0)
        poly_fade_vertices(t, batch, v, sign, item, n_near);
    poly_hide_apart(t, touches);
}

/* The side on which edges have met is remembered with the point: without it, edges that have gone
 * through each other would pull. Under `closed` it is forgotten when they touch without crossing:
 * they may turn past parallel then, with which the sign of a side changes. */
BRC_LANES_INLINE void poly_edges_of_tasks(struct poly_geometry4 *t, const struct poly_batch *batch,
                                          const struct poly_task *task, const enum poly_rule rule)
{
    struct poly_points *points = batch->contacts->point_columns;
    int32_t end[4][BRC_LANES], *item[BRC_LANES];
    brc_lanes p[4][3], side, reach;
    for (int k = 0; k < BRC_LANES; k++) {
        item[k] = points->item[task[k].point];
        side[k] = item[k][POLY_ITEM_SIDE];
        reach[k] = poly_item_reach(item[k]);
        for (int j = 0; j < 4; j++)
            end[j][k] = item[k][POLY_ITEM_END + j];
    }
    for (int j = 0; j < 4; j++)
        brc_lanes_gather3(p[j], batch->st->global_vertices, end[j]);
    poly_edge_geometry(t, &batch->len, p, &side, reach, rule);
    for (int32_t k = 0; k < BRC_LANES; k++) {
        if (rule != POLY_CLOSED && item[k][POLY_ITEM_SIDE] != 0)
            continue;
        item[k][POLY_ITEM_SIDE] = side[k] < 0 ? -1 : side[k] > 0;
        points->active[task[k].point] = side[k] < 0 ? 2 : side[k] > 0 ? 1 : 3;
    }
}

/* Vertices at platens; those of the contact that nobody reads are taken along with the batch's
 * first.
 */
BRC_LANES_INLINE void poly_platens_of_tasks(struct poly_geometry4 *t,
                                            const struct poly_batch *batch,
                                            const struct poly_task *task)
{
    int32_t vertex[BRC_LANES], platen[BRC_LANES];
    for (int k = 0; k < BRC_LANES; k++) {
        int32_t contact = task[k].contact < batch->n_contacts ? task[k].contact : 0;
        vertex[k] = poly_platen_vertex(batch->sim, batch->st, (size_t)batch->contact[contact],
                                       (size_t)task[k].point);
        platen[k] = batch->b[contact];
    }
    poly_platen_geometry(t, batch->sim, batch->st, vertex, platen, 0);
}

/* --- forces ----------------------------------------------------------------------------------- */

/* Adds the stiffness of four points to the tangents of their contacts. Columns of 6 for shifts and
 * turns of b about the centre of a. A shift d of the contact gives a d; a turn moves it by the
 * cross product with the arm, and changes the weight by its couple c besides. */
BRC_LANES_INLINE void poly_add_tangents(struct poly_batch *batch, const int32_t contact[BRC_LANES],
                                        const struct poly_geometry4 *t, const brc_lanes xi[3],
                                        brc_mask slips, const brc_lanes arm[3], const bool friction)
{
    brc_lanes a[3][3], q[3], k[36], force[3], moment[3];
    poly_spring_stiffness(a, q, &batch->law, t, xi, slips, friction);
    for (int j = 0; j < 6; j++) {
        const int l = (j + 1) % 3, m = (j + 2) % 3;
        for (int i = 0; i < 3; i++)
            force[i] = j < 3 ? a[j][i] : arm[l] * a[m][i] - arm[m] * a[l][i] + q[i] * t->c[j % 3];
        brc_lanes_cross(moment, arm, force);
        for (int i = 0; i < 3; i++) {
            k[6 * j + i] = force[i];
            k[6 * j + i + 3] = moment[i];
        }
    }
    poly_add_rows(batch->tangent[0], 36, contact, k, 36);
    for (int i = 0; i < BRC_LANES; i++)
        if (t->weight[i] > 0)
            batch->valid_path[contact[i]] =
                poly_least(batch->valid_path[contact[i]], t->valid_path[i]);
}

/* Forces of four points, which touch or are apart. Returns where they slip. */
BRC_LANES_INLINE brc_mask poly_forces_of_points(const struct poly_batch *batch,
                                                struct poly_sums4 *s,
                                                const struct poly_geometry4 *t,
                                                const struct poly_frame4 *frame,
                                                struct poly_springs4 *springs,
                                                const brc_lanes arm[3], const int flags)
{
    const bool friction = flags & POLY_FRICTION, viscous = flags & POLY_VISCOUS;
    const struct poly_spring_law *law = &batch->law;
    brc_lanes back[3], u[3], old = springs->weight, stiff = brc_lanes_all(law->kn);
    brc_mask touches = poly_positive(t->weight), slips = {0};
    springs->weight = brc_lanes_pick(touches, t->weight, old);
    poly_sub3(back, arm, frame->x);
    poly_normal_force(&s->normal, t, law->kn, arm);
    if (friction) /* but for platens that have none */
        stiff = brc_lanes_pick(poly_positive(frame->limit), brc_lanes_all(law->stiff), stiff);
    stiff = brc_lanes_where(touches, stiff);
    s->k[0] = stiff;
    s->k[1] = stiff * brc_lanes_dot(arm, arm);
    s->k[2] = stiff * brc_lanes_dot(back, back);
    s->stored = s->slid = brc_lanes_all(0);
    if (friction || viscous)
        poly_slip_at(u, frame, arm);
    if (friction) {
        const brc_lanes turn[3] = {frame->along[0].turn, frame->along[1].turn,
                                   frame->along[2].turn};
        struct poly_slip4 slip = {.twirl = brc_lanes_dot(turn, t->n), .limit = frame->limit};
        poly_scale3(slip.du, u, brc_lanes_all(flags & POLY_TANGENTS ? 1 : batch->sim->dt));
        slips = poly_shear_force(springs, s, t, &slip, law->kt, arm, brc_lanes_where(touches, old),
                                 flags & POLY_LEDGER);
    } else {
        poly_clear((brc_lanes *)&s->shear, sizeof s->shear);
    }
    if (viscous) {
        brc_lanes f[3];
        poly_viscous_force(f, t, law->kn, frame->gn, frame->gt, u);
        poly_force_at(&s->viscous, f, arm);
    } else {
        poly_clear((brc_lanes *)&s->viscous, sizeof s->viscous);
    }
    return slips & touches;
}

/* Points that begin to touch, and those that are apart. Most points that are awake touch as they
 * did before, so one test of all lanes ends it. */
BRC_LANES_INLINE void poly_find_changes(struct poly_batch *batch, const struct poly_task *task,
                                        int32_t n, const struct poly_geometry4 *t, brc_lanes old)
{
    struct poly_points *points = batch->contacts->point_columns;
    brc_mask touches = poly_positive(t->weight), taken = brc_lanes_first(n);
    if (!brc_lanes_any(taken & (~touches | ~poly_positive(old))))
        return;
    for (int32_t k = 0; k < BRC_LANES && k < n; k++) {
        if (!touches[k]) {
            bool fades = t->fades[k] != 0;
            batch->has_apart[task[k].contact] |= !fades;
            batch->apart[batch->n_apart++] = (struct poly_apart){task[k].contact, task[k].point,
                                                                 poly_most(-t->delta[k], 0), fades};
        } else if (points->active[task[k].point] == 0)
            points->active[task[k].point] = 1;
    }
}

/* Forces of the four points from task on, of which the first n count. */
BRC_LANES_INLINE void poly_act_on_points(struct poly_batch *batch, const struct poly_task *task,
                                         int32_t n, const struct poly_geometry4 *t, const int flags)
{
    const struct poly_points *points = batch->contacts->point_columns;
    const double *frame[BRC_LANES], *from[BRC_LANES];
    int32_t contact[BRC_LANES];
    struct poly_frame4 f;
    struct poly_springs4 springs;
    struct poly_sums4 s;
    for (int k = 0; k < BRC_LANES; k++) {
        contact[k] = task[k].contact;
        frame[k] = batch->frame[contact[k]];
        from[k] = points->spring[task[k].point];
    }
    poly_gather_fours((brc_lanes *)&f, frame,
                      flags & (POLY_FRICTION | POLY_VISCOUS) ? POLY_FRAME : POLY_FRAME_SLIP);
    poly_gather_fours((brc_lanes *)&springs, from, POLY_SPRING);
    brc_lanes arm[3], old = springs.weight;
    poly_sub3(arm, t->x, f.xa);
    brc_mask slips = poly_forces_of_points(batch, &s, t, &f, &springs, arm, flags);
    poly_find_changes(batch, task, n, t, old);
    const bool *wanted = batch->will_linearise;
    if (flags & POLY_TANGENTS &&
        (wanted[contact[0]] | wanted[contact[1]] | wanted[contact[2]] | wanted[contact[3]]))
        poly_add_tangents(batch, contact, t, springs.xi, slips, arm, flags & POLY_FRICTION);
    brc_lanes *part = (brc_lanes *)&springs;
    brc_lanes_transpose(part);
    brc_lanes_transpose(part + BRC_LANES);
    for (int k = 0; k < BRC_LANES && k < n; k++) {
        brc_lanes_put(points->spring[task[k].point], part[k]);
        brc_lanes_put(points->spring[task[k].point] + BRC_LANES, part[BRC_LANES + k]);
        batch->nearest[contact[k]] =
            poly_least(batch->nearest[contact[k]], t->weight[k] > 0 ? -t->delta[k] : HUGE_VAL);
    }
    s.none = brc_lanes_all(0);
    /* one contact after the other, each in the order of its points: eq:gt12:6, eq:gt12:7 */
    poly_add_rows(batch->sum[0], POLY_SUMS, contact, (brc_lanes *)&s,
                  flags & POLY_VISCOUS ? POLY_SUMS : POLY_SUM_SLID + BRC_LANES);
}

/* Ends a list at a whole four: what is left over goes to a contact that nobody reads. Returns its
 * number of tasks; the list is empty then. */
BRC_LANES_INLINE int32_t poly_end_list(struct poly_batch *batch, int list)
{
    struct poly_task *task = batch->task[list];
    int32_t n = batch->n_tasks[list];
    for (int32_t k = n; k % BRC_LANES != 0; k++)
        task[k] = (struct poly_task){POLY_CONTACTS, task[n - 1].point};
    batch->n_tasks[list] = 0;
    return n;
}

BRC_LANES_INLINE void poly_points_of_list(struct poly_batch *batch, const int list,
                                          const enum poly_rule rule, const int flags)
{
    const struct poly_task *task = batch->task[list];
    int32_t n = poly_end_list(batch, list);
    for (int32_t k = 0; k < n; k += BRC_LANES) {
        struct poly_geometry4 t;
        if (list == POLY_KNOWN)
            t = batch->known[k / BRC_LANES];
        else if (list == POLY_CROSSING)
            poly_edges_of_tasks(&t, batch, task + k, rule);
        else
            poly_vertices_of_tasks(&t, batch, task + k, list == POLY_FLAT, rule);
        poly_act_on_points(batch, task + k, n - k, &t, flags);
    }
}

BRC_LANES_INLINE void poly_points_kernel(struct poly_batch *batch, const enum poly_rule rule,
                                         const int flags)
{
    poly_points_of_list(batch, POLY_FLAT, rule, flags);
    if (rule != POLY_STRICT)
        poly_points_of_list(batch, POLY_SHARP, rule, flags);
    poly_points_of_list(batch, POLY_CROSSING, rule, flags);
    poly_points_of_list(batch, POLY_KNOWN, rule, flags);
}

BRC_LANES_INLINE void poly_closed_kernel(struct poly_batch *batch, const int flags)
{
    poly_points_kernel(batch, POLY_CLOSED, flags);
}

BRC_LANES_INLINE void poly_strict_kernel(struct poly_batch *batch, const int flags)
{
    poly_points_kernel(batch, POLY_STRICT, flags);
}

BRC_LANES_INLINE void poly_merged_kernel(struct poly_batch *batch, const int flags)
{
    poly_points_kernel(batch, POLY_MERGED, flags);
}

/* Points of platens, whose friction is that of each contact. */
BRC_LANES_INLINE void poly_platens_kernel(struct poly_batch *batch, const int flags)
{
    const struct poly_task *task = batch->task[POLY_FLAT];
    int32_t n = poly_end_list(batch, POLY_FLAT);
    for (int32_t k = 0; k < n; k += BRC_LANES) {
        struct poly_geometry4 t;
        poly_platens_of_tasks(&t, batch, task + k);
        poly_act_on_points(batch, task + k, n - k, &t, flags | POLY_FRICTION);
    }
}

#endif
