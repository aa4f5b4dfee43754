/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the loop over contacts (forces_kernels.inc.h) share: queues, four contacts on
 * their way through the loop, and the order in which what they exert is added up. Knows contacts by
 * their numbers in the list alone; which of them follow each other must not be felt in any sum.
 *
 * Each body gets the forces of its contacts, and the energies that they book, in ascending order of
 * (a, b), whatever contacts that exert nothing are listed between: so the bits of a run do not hang
 * on how a chunk begins, which contacts shared a queue, or how large the skin is. Contacts leave
 * the queues in another order; what they exert waits in the chunk, in L1, until all of it is done.
 * A chunk whose contacts are all affine so far adds at once, which is the same order. Rejected: a
 * pass over all contacts after the loop, as other models have it (3 more columns of 24 bytes a
 * contact to write and to read back), and atomics or colours, which have no order. BRC_FREE_SUMS
 * adds everything at once: what bench_vgcm measures the price of the order by. */
#ifndef VGCM_CONTACT4_KERNELS_H
#define VGCM_CONTACT4_KERNELS_H

#include "vgcm/contact.h"

#include <string.h>

#ifdef BRC_FREE_SUMS
enum { VGCM_FREE_SUMS = 1 };
#else
enum { VGCM_FREE_SUMS = 0 };
#endif

/* Contacts that are done together. 128: what they exert fits the first cache beside their state. */
enum { VGCM_CHUNK = 128 };

/* Contacts of a phase that wait for their turn. One that leaves its phase waits once more. */
struct vgcm_queue {
    int n;
    int32_t contact[VGCM_CHUNK];
};

/* What the contacts of a chunk exert, in the order of the list. */
enum vgcm_acts { VGCM_NOTHING, VGCM_FORCE, VGCM_FORCE_AND_ENERGY };
struct vgcm_chunk {
    size_t begin;
    bool is_waiting; /* a contact before those to come has yet to be done: nothing adds at once */
    uint8_t acts[VGCM_CHUNK];
    double force[VGCM_CHUNK][3 * BRC_LANES]; /* on b; moments on a and b; see vgcm_bodies_add */
    double energy[VGCM_CHUNK][BRC_N_ACCOUNTS];
};

struct vgcm_loop {
    struct brc_sim *sim;
    const struct vgcm_law *law;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    size_t ahead; /* the next contacts to be asked for */
    struct vgcm_queue queue[VGCM_N_PHASES];
    struct vgcm_chunk chunk;
};

/* On the stack, and written to the columns when it is sure that the contacts keep their phase. */
struct vgcm_contact4 {
    struct vgcm_index4 index;
    brc_mask live; /* lanes that do not repeat others */
    struct vgcm_motion m;
    brc_lanes u[VGCM_N_MOTION]; /* fields at the end of the step */
    brc_lanes sum[VGCM_N_MOTION];
    struct vgcm_energy_lanes energy; /* J, of the step */
    brc_lanes viscous;               /* J, dissipated by viscous forces */
};

VGCM_INLINE void vgcm_fetch(const void *at, size_t size)
{
    for (size_t k = 0; k < size; k += 64)
        __builtin_prefetch((const char *)at + k, 1, 2);
}

/* Asks for what four more contacts of the next chunk will want: machines do not foresee the order
 * of the queues. What tells where points are is wanted a chunk earlier. Without it a step takes
 * 27 % longer a point at half of the points damaged, 15 % over the whole of bench_vgcm (minima of
 * six runs, 20.0 against 15.8 ns and 14.5 against 12.7 ns). To keep the points
 * of damaged contacts together in memory gave less than 5 %,
 * and is gone. */
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

/* Nothing is booked yet. */
VGCM_INLINE void vgcm_contact4_clear(struct vgcm_contact4 *x)
{
    x->energy = (struct vgcm_energy_lanes){.bond = brc_lanes_all(0)};
    x->viscous = brc_lanes_all(0);
}

/* Takes the last contacts of a queue, four at most. */
VGCM_INLINE void vgcm_queue_next(struct vgcm_contact4 *x, struct vgcm_queue *q)
{
    x->live = brc_lanes_first(q->n);
    vgcm_contact4_clear(x);
    x->index.is_consecutive = false;
    for (int k = 0; k < BRC_LANES; k++)
        x->index.at[k] = q->contact[k < q->n ? q->n - 1 - k : 0];
    q->n -= q->n < BRC_LANES ? q->n : BRC_LANES;
}

static inline void vgcm_queue_add(struct vgcm_queue *q, int32_t i)
{
    q->contact[q->n++] = i;
}

/* Sorts by numbers of points, so that four contacts take about as many steps as each of them.
 * Without it bench_vgcm takes 6 % longer a point at half of the points damaged, 5 % over the whole
 * (least of three interleaved runs, 14.9 against 14.1 ns and 11.8 against 11.2 ns). */
static void vgcm_queue_sort(struct vgcm_queue *q, const int32_t *np)
{
    enum { KEYS = 32 };
    int32_t sorted[VGCM_CHUNK], start[KEYS + 1] = {0};
    for (int i = 0; i < q->n; i++)
        start[1 + (np[q->contact[i]] < KEYS - 1 ? np[q->contact[i]] : KEYS - 1)]++;
    for (int k = 0; k < KEYS; k++)
        start[k + 1] += start[k];
    for (int i = 0; i < q->n; i++)
        sorted[start[np[q->contact[i]] < KEYS - 1 ? np[q->contact[i]] : KEYS - 1]++] =
            q->contact[i];
    for (int i = 0; i < q->n; i++)
        q->contact[i] = sorted[i];
}

/* Motion of the contacts over the step, and their fields after it. Nothing is written yet. A
 * contact that leaves its phase is then done again from the same state. */
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

/* Adds to the sums of both bodies of contact i: the force on b and the moment on a, each with a
 * fourth value that rides along (0, and the work stored in the bond, which a gets), the moment on
 * b. A body's sum is eight numbers in two lanes of four, so that nothing is left over to be added
 * by itself. */
VGCM_INLINE void vgcm_bodies_add(const struct vgcm_loop *l, size_t i, brc_lanes f, brc_lanes ta,
                                 brc_lanes tb)
{
    double *a = l->sim->bodies.sum[l->c->a[i]], *b = l->sim->bodies.sum[l->c->b[i]];
    brc_lanes_put(a, brc_lanes_at(a) - f);
    brc_lanes_put(a + 4, brc_lanes_at(a + 4) + ta);
    brc_lanes_put(b, brc_lanes_at(b) + f);
    brc_lanes_put(b + 4, brc_lanes_at(b + 4) + tb);
}

/* What contact i books on the accounts of a, the first four of them as lanes. */
VGCM_INLINE void vgcm_energies_add(const struct vgcm_loop *l, size_t i, brc_lanes first,
                                   double viscous)
{
    double *e = l->sim->bodies.energy[l->c->a[i]];
    brc_lanes_put(e, brc_lanes_at(e) + first);
    e[BRC_ACCOUNT_VISCOUS] += viscous;
}

/* What four contacts book, but for the work stored in bonds, which rides with the moments. */
VGCM_INLINE void vgcm_contact4_book(struct vgcm_loop *l, const struct vgcm_contact4 *x)
{
    brc_lanes e[] = {x->energy.normal, x->energy.shear, x->energy.damage, x->energy.friction};
    brc_lanes_transpose(e);
    for (int k = BRC_LANES - 1; k >= 0; k--) { /* the first of equal contacts is what stays */
        size_t i = (size_t)x->index.at[k], slot = i - l->chunk.begin;
        if (VGCM_FREE_SUMS) {
            if (x->live[k])
                vgcm_energies_add(l, i, e[k], x->viscous[k]);
            continue;
        }
        brc_lanes_put(l->chunk.energy[slot], e[k]);
        l->chunk.energy[slot][BRC_ACCOUNT_VISCOUS] = x->viscous[k];
        l->chunk.acts[slot] = VGCM_FORCE_AND_ENERGY;
    }
}

/* Hands on what four contacts exert; books: more than work stored in bonds. */
VGCM_INLINE void vgcm_contact4_apply(struct vgcm_loop *l, const struct vgcm_contact4 *x, bool books)
{
    brc_lanes f[BRC_LANES], ta[BRC_LANES], tb[BRC_LANES];
    vgcm_force_of(f, ta, tb, &x->m, x->sum);
    vgcm_put3(l->c->f, &x->index, f);
    f[3] = tb[3] = brc_lanes_all(0);
    ta[3] = x->energy.bond;
    brc_lanes_transpose(f);
    brc_lanes_transpose(ta);
    brc_lanes_transpose(tb);
    if (VGCM_FREE_SUMS || !l->chunk.is_waiting) {
        for (int k = 0; k < BRC_LANES; k++)
            if (x->index.is_consecutive || x->live[k])
                vgcm_bodies_add(l, (size_t)x->index.at[k], f[k], ta[k], tb[k]);
    } else {
        for (int k = BRC_LANES - 1; k >= 0; k--) {
            size_t slot = (size_t)x->index.at[k] - l->chunk.begin;
            brc_lanes_put(l->chunk.force[slot], f[k]);
            brc_lanes_put(l->chunk.force[slot] + 4, ta[k]);
            brc_lanes_put(l->chunk.force[slot] + 8, tb[k]);
            l->chunk.acts[slot] = VGCM_FORCE;
        }
    }
    if (books)
        vgcm_contact4_book(l, x);
}

/* Adds what has waited, in the order of the list. The list of those that act comes first: half of
 * the contacts are loose past the peak, and a jump on each would be foreseen as often as not. */
static __attribute__((noinline)) void vgcm_chunk_add(struct vgcm_loop *l, size_t end)
{
    struct vgcm_chunk *chunk = &l->chunk;
    uint8_t act[VGCM_CHUNK];
    size_t n = 0;
    for (size_t slot = 0; slot < end - chunk->begin; slot++) {
        act[n] = (uint8_t)slot;
        n += chunk->acts[slot] != VGCM_NOTHING;
    }
    for (size_t k = 0; k < n; k++) {
        size_t slot = act[k], i = chunk->begin + slot;
        const double *f = chunk->force[slot], *e = chunk->energy[slot];
        vgcm_bodies_add(l, i, brc_lanes_at(f), brc_lanes_at(f + 4), brc_lanes_at(f + 8));
        if (chunk->acts[slot] == VGCM_FORCE_AND_ENERGY)
            vgcm_energies_add(l, i, brc_lanes_at(e), e[BRC_ACCOUNT_VISCOUS]);
    }
    memset(chunk->acts, VGCM_NOTHING, sizeof chunk->acts);
}

/* Least opening of points anywhere within the rims, and the largest. The sum of both bends and not
 * their root: a bound all the same, without a root. It is asked of every loose contact in each
 * step. */
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

/* Adds the viscous part to the generalised forces, and takes note of its dissipation. By the mean
 * of the forces before and after the step, the trapezoid rule that all works in the ledger
 * follow. */
VGCM_INLINE void vgcm_contact4_viscous(struct vgcm_loop *l, struct vgcm_contact4 *x,
                                       const brc_lanes viscous[VGCM_N_MOTION])
{
    brc_lanes old[VGCM_N_MOTION], mean[VGCM_N_MOTION];
    brc_lanes_gather6(old, l->f->viscous_force, x->index.at);
    for (int k = 0; k < VGCM_N_MOTION; k++) {
        mean[k] = 0.5 * (old[k] + viscous[k]);
        x->sum[k] += viscous[k];
    }
    brc_lanes_scatter6(l->f->viscous_force, x->index.at, viscous);
    x->viscous = vgcm_force_work(mean, x->m.du);
}

#endif
