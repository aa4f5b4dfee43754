/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the loop over contacts (forces.h) share: four rows on their way through it, and
 * viscous forces. */
#ifndef VGCM_FOUR_H
#define VGCM_FOUR_H

#include "vgcm/contact.h"

/* What the ledger gets, sums side by side [J]. */
struct booked {
    struct vgcm_energy_lanes points;
    struct vgcm_energy spheres;
    brc_lanes affine, viscous; /* stored by affine contacts; dissipated by viscous forces */
};

/* Rows of a phase that wait for their turn. A row that leaves its phase waits once more. */
enum { CHUNK = 128 };
struct queue {
    int n;
    int32_t row[CHUNK];
};

struct loop {
    struct booked booked;
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    size_t ahead; /* the next rows to be asked for */
    struct queue queue[VGCM_N_PHASES];
};

struct four {
    struct vgcm_rows rows;
    brc_mask live; /* lanes that do not repeat others */
    struct vgcm_motion m;
    brc_lanes u[VGCM_N_MOTION]; /* fields at the end of the step */
    brc_lanes sum[VGCM_N_MOTION];
};

VGCM_INLINE void fetch(const void *at, size_t size)
{
    for (size_t k = 0; k < size; k += 64)
        __builtin_prefetch((const char *)at + k, 1, 2);
}

/* Asks for what four more rows of the next chunk will want: machines do not foresee the order
 * of the queues. What tells where points are is wanted a chunk earlier. */
VGCM_INLINE void fetch_ahead(struct loop *l)
{
    const struct brc_contacts *c = l->c;
    const struct vgcm_contacts *f = l->f;
    size_t i = l->ahead, far = i + CHUNK;
    l->ahead += BRC_LANES;
    if (far + BRC_LANES > c->n)
        return;
    fetch(c->p0 + far, BRC_LANES * sizeof *c->p0);
    fetch(c->np + far, BRC_LANES * sizeof *c->np);
    fetch(c->a + i, BRC_LANES * sizeof *c->a);
    fetch(c->b + i, BRC_LANES * sizeof *c->b);
    fetch(f->kn + i, BRC_LANES * sizeof *f->kn);
    fetch(f->plane + i, BRC_LANES * sizeof *f->plane);
    fetch(f->rim + i, BRC_LANES * sizeof *f->rim);
    fetch(c->gap + i, BRC_LANES * sizeof *c->gap);
    fetch(f->n + i, BRC_LANES * sizeof *f->n);
    fetch(f->s + i, BRC_LANES * sizeof *f->s);
    fetch(f->u + i, BRC_LANES * sizeof *f->u);
    fetch(c->f + i, BRC_LANES * sizeof *c->f);
    for (size_t k = i; k < i + BRC_LANES; k++) {
        if (f->phase[k] == VGCM_AFFINE)
            fetch(f->moment + k, sizeof *f->moment);
        else if (f->phase[k] == VGCM_POINTS)
            fetch(l->p->law + c->p0[k], (size_t)c->np[k] * sizeof *l->p->law);
    }
}

/* Takes the last rows of a queue, four at most. */
VGCM_INLINE void next_four(struct four *x, struct queue *q)
{
    x->live = brc_lanes_first(q->n);
    x->rows.is_run = false;
    for (int k = 0; k < BRC_LANES; k++)
        x->rows.at[k] = q->row[k < q->n ? q->n - 1 - k : 0];
    q->n -= q->n < BRC_LANES ? q->n : BRC_LANES;
}

static inline void wait_again(struct queue *q, int32_t row)
{
    q->row[q->n++] = row;
}

/* Motion of the rows over the step, and their fields after it. Nothing is written yet. */
VGCM_INLINE void move_four(const struct loop *l, struct four *x)
{
    vgcm_motion_of(&l->sim->bodies, l->c, &x->rows, l->sim->dt, &x->m);
    brc_lanes_gather6(x->u, l->f->u, x->rows.at);
    for (int k = 0; k < VGCM_N_MOTION; k++)
        x->u[k] += x->m.du[k]; /* eq:vgcm:14 */
}

VGCM_INLINE void write_motion(const struct loop *l, const struct four *x)
{
    vgcm_put3(l->f->n, &x->rows, x->m.n);
    vgcm_put3(l->f->s, &x->rows, x->m.s);
    brc_lanes_scatter6(l->f->u, x->rows.at, x->u);
    vgcm_put(l->c->gap, &x->rows, x->u[VGCM_OPEN]);
}

VGCM_INLINE void apply_forces(const struct loop *l, const struct four *x)
{
    vgcm_force_apply(&l->sim->bodies, l->c, &x->rows, x->live, &x->m, x->sum);
}

/* Least opening of points anywhere within the rims, and the largest. */
VGCM_INLINE void openings_of(brc_lanes range[2], const brc_lanes u[VGCM_N_MOTION], brc_lanes rim)
{
    brc_lanes bend = rim * (brc_lanes_abs(u[VGCM_BEND_S]) + brc_lanes_abs(u[VGCM_BEND_T]));
    range[0] = u[VGCM_OPEN] - bend;
    range[1] = u[VGCM_OPEN] + bend;
}

/* Viscosity per area of four rows, over dt: force = this times area times increment. */
VGCM_INLINE brc_lanes drag_of(const struct loop *l, const struct vgcm_rows *rows)
{
    brc_lanes c = brc_lanes_all(0);
    double dt = l->sim->dt;
    const double *mass = l->sim->bodies.true_mass;
    for (int k = 0; k < BRC_LANES; k++) {
        int32_t i = rows->at[k];
        double ma = mass[l->c->a[i]], mb = mass[l->c->b[i]];
        c[k] = dt > 0 ? l->law->viscous * ma * mb / (ma + mb) / (l->f->moment[i][VGCM_A] * dt) : 0;
    }
    return c;
}

/* Adds the viscous part to the generalised forces, and its dissipation to what is booked. */
VGCM_INLINE void add_drag(struct loop *l, struct four *x, int flags,
                          const brc_lanes drag[VGCM_N_MOTION])
{
    brc_lanes old[VGCM_N_MOTION], mean[VGCM_N_MOTION];
    brc_lanes_gather6(old, l->f->drag, x->rows.at);
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        mean[k] = 0.5 * (old[k] + drag[k]);
        x->sum[k] += drag[k];
    }
    brc_lanes_scatter6(l->f->drag, x->rows.at, drag);
    if (flags & VGCM_LEDGER)
        l->booked.viscous += brc_lanes_where(x->live, vgcm_force_work(mean, x->m.du));
}

#endif
