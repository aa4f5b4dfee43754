/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over contacts of grains with platens. The points of boundary facets ride on the grain:
 * frame (n, s, t) of the row turns with it and a point is at h n + s s + t t from the centre. The
 * contact's own frame is fixed by the platen: normal out of the grain, against the platen's. All
 * vectors of a row are in that frame until its forces are summed up. */
#include "vgcm/contact.h"

struct wall {
    struct brc_sim *sim;
    struct brc_contacts *c;
    struct vgcm_contacts *f;
    struct vgcm_points *p;
    const struct brc_platen *platen;
    struct vgcm_law law; /* with the platen's friction */
    struct vgcm_bond bond;
    struct vgcm_energy energy;
    double frame[3][3];       /* in space: normal from grain to platen, two axes of its plane */
    double riding[3][3];      /* frame that rides on the grain */
    double move[3];           /* m, of the platen against the grain's centre in this step */
    double turn[3];           /* rad, of the grain in this step */
    double viscosity;         /* viscous force over area and increment */
    double force[6], drag[6]; /* on the platen, moment about the grain; viscous part of it */
    double viscous;           /* J */
    double gap;               /* m, smallest opening */
};

/* A vector of space in the contact's frame. */
static void to_frame(const struct wall *w, double r[3], const double v[3])
{
    for (int k = 0; k < 3; k++)
        r[k] = brc_dot(v, w->frame[k]);
}

static void to_space(const struct wall *w, double v[3], const double r[3])
{
    brc_scale(v, w->frame[0], r[0]);
    brc_axpy(v, r[1], w->frame[1]);
    brc_axpy(v, r[2], w->frame[2]);
}

static void set_frames(struct wall *w, size_t i)
{
    const struct brc_bodies *b = &w->sim->bodies;
    size_t a = (size_t)w->c->a[i];
    double dt = w->sim->dt, q[4], m[3][3], turned[2][3], turn[3], move[3], across[3];
    brc_scale(w->frame[0], w->platen->n, -1);
    brc_copy(w->frame[1], w->platen->across);
    brc_cross(w->frame[2], w->frame[0], w->frame[1]);
    brc_scale(turn, b->w[a], dt);
    if (brc_norm2(turn) > 0) {
        brc_quat_from_rotation(q, turn);
        brc_quat_matrix(m, q);
        brc_mat_mul(turned[0], m, w->f->n[i]);
        brc_mat_mul(turned[1], m, w->f->s[i]);
        brc_normalise(w->f->n[i], turned[0]);
        brc_normalise(w->f->s[i], turned[1]);
    }
    brc_cross(across, w->f->n[i], w->f->s[i]);
    brc_sub(move, b->v[w->c->b[i]], b->v[a]);
    brc_scale(move, move, dt);
    to_frame(w, w->turn, turn);
    to_frame(w, w->move, move);
    to_frame(w, w->riding[0], w->f->n[i]);
    to_frame(w, w->riding[1], w->f->s[i]);
    to_frame(w, w->riding[2], across);
}

/* Motion of the platen against the grain's point at r: opening, slips. */
static void relative_motion(const struct wall *w, const double r[3], double du[3])
{
    double swing[3], middle[3];
    brc_cross(swing, w->turn, r);
    brc_copy(middle, r);
    brc_axpy(middle, -0.5, swing); /* the arm halfway through the step */
    brc_cross(swing, w->turn, middle);
    brc_sub(du, w->move, swing);
}

/* A gripped point: springs both ways that never break. Forces and energies are per area. */
static void step_grip(const struct wall *w, const double du[3], struct vgcm_point *q,
                      struct vgcm_energy *e)
{
    double old[3] = {w->bond.kn * q->un, q->fs, q->ft};
    q->un += du[0];
    q->fn = w->bond.kn * q->un;
    e->normal += 0.5 * (old[0] + q->fn) * du[0];
    if (w->platen->grip == BRC_GRIP_AXIAL)
        return;
    q->fs -= w->bond.ks * du[1];
    q->ft -= w->bond.ks * du[2];
    e->shear -= 0.5 * ((old[1] + q->fs) * du[1] + (old[2] + q->ft) * du[2]);
}

/* Viscous force per area on the platen; a plain contact is never pulled by it. */
static void point_drag(const struct wall *w, const double du[3], const struct vgcm_point *q,
                       double drag[3])
{
    for (int k = 0; k < 3; k++)
        drag[k] = -w->viscosity * du[k];
    if (w->platen->grip == BRC_GRIP_AXIAL)
        drag[1] = drag[2] = 0;
    if (w->platen->grip == BRC_GRIP_NONE && q->un >= 0)
        brc_set(drag, 0, 0, 0);
    if (w->platen->grip == BRC_GRIP_NONE && drag[0] < q->fn)
        drag[0] = q->fn;
}

/* Adds a force on an area at the arm r of the grain to a sum of forces and moments. */
static void add_force(double sum[6], double area, const double per_area[3], const double r[3])
{
    double part[3], moment[3];
    brc_scale(part, per_area, area);
    brc_cross(moment, r, part);
    for (int k = 0; k < 3; k++) {
        sum[k] += part[k];
        sum[3 + k] += moment[k];
    }
}

/* Point j of a row, at the arm r of the grain, with the opening un. */
static void step_point(struct wall *w, size_t j, int flags, const double r[3], double un)
{
    struct vgcm_points *p = w->p;
    struct vgcm_energy e = {0};
    double area = p->law[j][VGCM_AREA], du[3];
    relative_motion(w, r, du);
    struct vgcm_point q = vgcm_point_at(p, j, un - du[0], w->bond.ks);
    if (w->platen->grip != BRC_GRIP_NONE)
        step_grip(w, du, &q, &e);
    else
        vgcm_law_rub(&w->bond, 1, du, &q, &e);
    w->energy.normal += area * e.normal;
    w->energy.shear += area * e.shear;
    w->energy.friction += area * e.friction;
    p->un[j] = un;
    vgcm_point_put(p, j, w->bond.per_ks, &q);
    double part[3] = {-q.fn, q.fs, q.ft}; /* eq:vgcm:19 */
    add_force(w->force, area, part, r);
    if (flags & VGCM_VISCOUS) {
        point_drag(w, du, &q, part);
        add_force(w->drag, area, part, r);
    }
    w->gap = un < w->gap ? un : w->gap;
}

/* Dissipation of the viscous forces, by the mean of those before and after the step. */
static void account_drag(struct wall *w, size_t i)
{
    for (int k = 0; k < 3; k++) {
        double force = 0.5 * (w->f->drag[i][k] + w->drag[k]);
        double moment = 0.5 * (w->f->drag[i][3 + k] + w->drag[3 + k]);
        w->viscous += moment * w->turn[k] - force * w->move[k];
    }
    for (int k = 0; k < 6; k++) {
        w->f->drag[i][k] = w->drag[k];
        w->force[k] += w->drag[k];
    }
}

static void begin_row(struct wall *w, size_t i)
{
    struct brc_contacts *c = w->c;
    const struct brc_sim *sim = w->sim;
    w->platen = brc_sim_platen(sim, c->b[i]);
    w->law.mu = w->platen->friction;
    w->bond = vgcm_springs_of(&w->law, w->f->kn[i]);
    w->gap = HUGE_VAL;
    w->viscosity = sim->dt > 0 ? w->law.viscous * sim->bodies.true_mass[c->a[i]] /
                                     (w->f->moment[i][VGCM_A] * sim->dt)
                               : 0;
    for (int k = 0; k < 6; k++)
        w->force[k] = w->drag[k] = 0;
    set_frames(w, i);
}

/* Force on the platen and moments about both centres, in space. */
static void finish_row(const struct wall *w, size_t i)
{
    const struct brc_bodies *b = &w->sim->bodies;
    struct brc_contacts *c = w->c;
    double moment[3], arm[3];
    to_space(w, c->f[i], w->force);
    to_space(w, moment, w->force + 3);
    brc_scale(c->ta[i], moment, -1);
    brc_sub(arm, b->x[c->a[i]], b->x[c->b[i]]);
    brc_cross(c->tb[i], arm, c->f[i]);
    brc_add(c->tb[i], c->tb[i], moment);
    c->gap[i] = w->gap;
}

static void step_row(struct wall *w, size_t i, int flags)
{
    const struct brc_bodies *b = &w->sim->bodies;
    double height[3];
    begin_row(w, i);
    brc_sub(height, b->x[w->c->a[i]], b->x[w->c->b[i]]);
    double above = brc_dot(height, w->platen->n);
    for (size_t j = (size_t)w->c->p0[i], end = j + (size_t)w->c->np[i]; j < end; j++) {
        double r[3] = {above, 0, 0}, un = above - w->f->rest[i];
        if (w->f->phase[i] != VGCM_SPHERE) {
            brc_scale(r, w->riding[0], w->p->h[j]);
            brc_axpy(r, w->p->law[j][VGCM_AT_S], w->riding[1]);
            brc_axpy(r, w->p->law[j][VGCM_AT_T], w->riding[2]);
            un = above - r[0];
        }
        step_point(w, j, flags, r, un);
    }
    if (flags & VGCM_VISCOUS)
        account_drag(w, i);
    finish_row(w, i);
}

void vgcm_walls(struct brc_sim *sim, const struct vgcm_law *law, int flags)
{
    struct wall w = {.sim = sim,
                     .c = &sim->platens,
                     .f = vgcm_columns(&sim->platens),
                     .p = vgcm_point_columns(&sim->platens),
                     .law = *law};
    for (size_t i = 0; i < w.c->n; i++)
        step_row(&w, i, flags);
    if (flags & VGCM_LEDGER) {
        sim->ledger.contact_normal += w.energy.normal;
        sim->ledger.contact_shear += w.energy.shear;
        sim->ledger.friction += w.energy.friction;
        sim->ledger.viscous += w.viscous;
    }
}
