/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the loop over contacts (forces_kernels.inc.h) share: four contacts on their way
 * through it, and viscous forces. */
#ifndef VGCM_CONTACT4_KERNELS_H
#define VGCM_CONTACT4_KERNELS_H

#include "vgcm/contact.h"

/* What the ledger gets, sums side by side [J]. */
struct vgcm_booked {
    struct vgcm_energy_lanes points;
    struct vgcm_energy spheres;
    brc_lanes affine, viscous; /* stored by affine contacts; dissipated by viscous forces */
};

/* Contacts of a phase that wait for their turn. A contact that leaves its phase waits once more. */
enum { VGCM_CHUNK = 128 };
struct vgcm_queue {
    int n;
    int32_t contact[VGCM_CHUNK];
};

struct vgcm_loop {
    struct vgcm_booked booked;
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    size_t ahead; /* the next contacts to be asked for */
    struct vgcm_queue queue[VGCM_N_PHASES];
};

struct vgcm_contact4 {
    struct vgcm_index4 index;
    brc_mask live; /* lanes that do not repeat others */
    struct vgcm_motion m;
    brc_lanes u[VGCM_N_MOTION]; /* fields at the end of the step */
    brc_lanes sum[VGCM_N_MOTION];
};

VGCM_INLINE void vgcm_fetch(const void *at, size_t size)
{
    for (size_t k = 0; k < size; k += 64)
        __builtin_prefetch((const char *)at + k, 1, 2);
}

/* Asks for what four more contacts of the next chunk will want: machines do not foresee the order
 * of the queues. What tells where points are is wanted a chunk earlier. Without it a step takes
 * 27 % longer a point at half of the points damaged, 15 % over the whole of bench_vgcm (minima of
 * six runs, 20.0 against 15.8 ns and 14.5 against 12.7 ns). Two more tricks of this kind gave
 * nothing and are gone: to keep the points of damaged contacts together in memory, and to build
 * the loops for AVX-512 too. */
VGCM_INLINE void vgcm_fetch_ahead(struct vgcm_loop *l)
{
    const struct brc_contacts *c = l->c;
    const struct vgcm_contacts *f = l->f;
    size_t i = l->ahead, far = i + VGCM_CHUNK;
    l->ahead += BRC_LANES;
    if (far + BRC_LANES > c->n)
        return;
    vgcm_fetch(c->p0 + far, BRC_LANES * sizeof *c->p0);
    vgcm_fetch(c->np + far, BRC_LANES * sizeof *c->np);
    vgcm_fetch(c->a + i, BRC_LANES * sizeof *c->a);
    vgcm_fetch(c->b + i, BRC_LANES * sizeof *c->b);
    vgcm_fetch(f->kn + i, BRC_LANES * sizeof *f->kn);
    vgcm_fetch(f->plane + i, BRC_LANES * sizeof *f->plane);
    vgcm_fetch(f->facet_radius + i, BRC_LANES * sizeof *f->facet_radius);
    vgcm_fetch(c->gap + i, BRC_LANES * sizeof *c->gap);
    vgcm_fetch(f->n + i, BRC_LANES * sizeof *f->n);
    vgcm_fetch(f->s + i, BRC_LANES * sizeof *f->s);
    vgcm_fetch(f->u + i, BRC_LANES * sizeof *f->u);
    vgcm_fetch(c->f + i, BRC_LANES * sizeof *c->f);
    for (size_t k = i; k < i + BRC_LANES; k++) {
        if (f->phase[k] == VGCM_AFFINE)
            vgcm_fetch(f->moment + k, sizeof *f->moment);
        else if (f->phase[k] == VGCM_POINTS)
            vgcm_fetch(l->p->law + c->p0[k], (size_t)c->np[k] * sizeof *l->p->law);
    }
}

/* Takes the last contacts of a queue, four at most. */
VGCM_INLINE void vgcm_queue_next(struct vgcm_contact4 *x, struct vgcm_queue *q)
{
    x->live = brc_lanes_first(q->n);
    x->index.is_consecutive = false;
    for (int k = 0; k < BRC_LANES; k++)
        x->index.at[k] = q->contact[k < q->n ? q->n - 1 - k : 0];
    q->n -= q->n < BRC_LANES ? q->n : BRC_LANES;
}

static inline void vgcm_queue_add(struct vgcm_queue *q, int32_t i)
{
    q->contact[q->n++] = i;
}

/* Motion of the contacts over the step, and their fields after it. Nothing is written yet. */
VGCM_INLINE void vgcm_contact4_move(const struct vgcm_loop *l, struct vgcm_contact4 *x)
{
    vgcm_motion_of(&l->sim->bodies, l->c, &x->index, l->sim->dt, &x->m);
    brc_lanes_gather6(x->u, l->f->u, x->index.at);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        x->u[k] += x->m.du[k]; /* eq:vgcm:14 */
}

VGCM_INLINE void vgcm_contact4_write(const struct vgcm_loop *l, const struct vgcm_contact4 *x)
{
    vgcm_put3(l->f->n, &x->index, x->m.n);
    vgcm_put3(l->f->s, &x->index, x->m.s);
    brc_lanes_scatter6(l->f->u, x->index.at, x->u);
    vgcm_put(l->c->gap, &x->index, x->u[VGCM_OPEN]);
}

VGCM_INLINE void vgcm_contact4_apply(const struct vgcm_loop *l, const struct vgcm_contact4 *x)
{
    vgcm_force_apply(&l->sim->bodies, l->c, &x->index, x->live, &x->m, x->sum);
}

/* Least opening of points anywhere within the rims, and the largest. */
VGCM_INLINE void vgcm_openings(brc_lanes range[2], const brc_lanes u[VGCM_N_MOTION],
                               brc_lanes facet_radius)
{
    brc_lanes bend = facet_radius * (brc_lanes_abs(u[VGCM_BEND_S]) + brc_lanes_abs(u[VGCM_BEND_T]));
    range[0] = u[VGCM_OPEN] - bend;
    range[1] = u[VGCM_OPEN] + bend;
}

/* Viscosity per area of four contacts, over dt: force = this times area times increment. */
VGCM_INLINE brc_lanes vgcm_viscosity(const struct vgcm_loop *l, const struct vgcm_index4 *index)
{
    brc_lanes c = brc_lanes_all(0);
    double dt = l->sim->dt;
    const double *mass = l->sim->bodies.true_mass;
    for (int k = 0; k < BRC_LANES; k++) {
        int32_t i = index->at[k];
        double ma = mass[l->c->a[i]], mb = mass[l->c->b[i]];
        c[k] = dt > 0 ? l->law->viscous * ma * mb / (ma + mb) / (l->f->moment[i][VGCM_A] * dt) : 0;
    }
    return c;
}

/* Adds the viscous part to the generalised forces, and its dissipation to what is booked. */
VGCM_INLINE void vgcm_contact4_viscous(struct vgcm_loop *l, struct vgcm_contact4 *x, int flags,
                                       const brc_lanes viscous[VGCM_N_MOTION])
{
    brc_lanes old[VGCM_N_MOTION], mean[VGCM_N_MOTION];
    brc_lanes_gather6(old, l->f->viscous_force, x->index.at);
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        mean[k] = 0.5 * (old[k] + viscous[k]);
        x->sum[k] += viscous[k];
    }
    brc_lanes_scatter6(l->f->viscous_force, x->index.at, viscous);
    if (flags & VGCM_LEDGER)
        l->booked.viscous += brc_lanes_where(x->live, vgcm_force_work(mean, x->m.du));
}

#endif
