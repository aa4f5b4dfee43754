/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy, springs and strength left, from the state alone. Called
 * through the model's table, and seldom, so it is written for one point at a time
 * and shares only the law with the loops: what the loops book, step by step, is checked against
 * what stands here (brc_ledger_drift), which would be worth little if both used one piece of code.
 * It may not know queues, chunks or lanes. */
#include "vgcm/contact.h"

/* State of point j of contact i with its forces [N]. A facet keeps no opening and no force of its
 * points: they follow from its six numbers u, as in the loops. Loose: broken and open, which stores
 * nothing; its slip is not kept (vgcm.h). */
static struct vgcm_point point_of(const struct brc_contacts *c, const struct vgcm_bond *bond,
                                  size_t i, size_t j, int flags)
{
    const struct vgcm_points *p = vgcm_point_columns(c);
    const double *u = vgcm_columns(c)->u[i];
    double ks = bond->ks * p->law[j][VGCM_AREA];
    struct vgcm_point q = vgcm_point_at(p, j, c->gap[i], ks);
    if (vgcm_columns(c)->phase[i] != VGCM_SPHERE) {
        brc_lanes at[3], field[VGCM_N_MOTION];
        for (int k = 0; k < VGCM_N_MOTION; k++)
            field[k] = brc_lanes_all(u[k]);
        vgcm_motion_at(at, field, brc_lanes_all(p->law[j][VGCM_AT_S]),
                       brc_lanes_all(p->law[j][VGCM_AT_T]));
        q.un = at[0][0];
        q.dn = p->law[j][VGCM_DN];
        q.ds = p->law[j][VGCM_DS];
        bool is_loose = q.un > 0 && !vgcm_law_is_whole(bond->law, flags, q.dn, q.ds);
        q.fs = is_loose ? 0 : q.fs - ks * at[1][0];
        q.ft = is_loose ? 0 : q.ft - ks * at[2][0];
    }
    q.fn = vgcm_law_normal(bond, flags, p->law[j][VGCM_AREA], &q);
    return q;
}

/* Without shear stiffness a force has nowhere to be stored; it is 0 then, but 0/0 is not. */
static double shear_energy(const struct vgcm_bond *bond, double area, const struct vgcm_point *q)
{
    double k = bond->ks * area;
    return k > 0 ? (q->fs * q->fs + q->ft * q->ft) / (2 * k) : 0;
}

/* On the account of a, as the loops book it, so that the two can be compared grain by
 * grain. */
static void add_pair(const struct brc_sim *sim, const struct vgcm_law *law, size_t i,
                     double stored[BRC_N_ACCOUNTS])
{
    const struct brc_contacts *c = &sim->pairs;
    const struct vgcm_contacts *f = vgcm_columns(c);
    const struct vgcm_points *p = vgcm_point_columns(c);
    struct vgcm_bond bond = vgcm_springs_of(law, f->kn[i]);
    int flags = vgcm_law_flags(law);
    /* affine contacts by their area moments: their points keep no state that could be added up */
    if (f->phase[i] == VGCM_AFFINE) {
        brc_lanes u[VGCM_N_MOTION], moment[VGCM_N_MOMENTS];
        for (int k = 0; k < VGCM_N_MOTION; k++) {
            u[k] = brc_lanes_all(f->u[i][k]);
            moment[k] = brc_lanes_all(f->moment[i][k]);
        }
        stored[BRC_ACCOUNT_BOND] +=
            0.5 * vgcm_energy_affine(brc_lanes_all(bond.kn), brc_lanes_all(bond.ks), moment, u)[0];
        return;
    }
    for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++) {
        struct vgcm_point q = point_of(c, &bond, i, j, flags);
        /* what a broken point holds is a contact's, as the ledger books it from then on */
        bool is_bond = vgcm_law_is_whole(law, flags, q.dn, q.ds);
        double normal = 0.5 * q.fn * q.un, shear = shear_energy(&bond, p->law[j][VGCM_AREA], &q);
        stored[is_bond ? BRC_ACCOUNT_BOND : BRC_ACCOUNT_NORMAL] += normal;
        stored[is_bond ? BRC_ACCOUNT_BOND : BRC_ACCOUNT_SHEAR] += shear;
    }
}

/* By the opening that is kept with the point, as the height of a curved surface would have to be
 * asked anew. */
static void add_platen(const struct brc_sim *sim, const struct vgcm_law *law, size_t i,
                       double stored[BRC_N_ACCOUNTS])
{
    const struct brc_contacts *c = &sim->platens;
    const struct vgcm_points *p = vgcm_point_columns(c);
    bool is_held = vgcm_platen_bonding(c, i, brc_sim_platen(sim, c->b[i])) != BRC_BONDING_NONE;
    double kn = vgcm_columns(c)->kn[i];
    struct vgcm_bond bond = vgcm_springs_of(law, kn);
    for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++) {
        struct vgcm_point q = vgcm_point_at(p, j, p->un[j], bond.ks * p->law[j][VGCM_AREA]);
        if (is_held || q.un < 0)
            stored[BRC_ACCOUNT_NORMAL] += 0.5 * kn * p->law[j][VGCM_AREA] * q.un * q.un;
        stored[BRC_ACCOUNT_SHEAR] += shear_energy(&bond, p->law[j][VGCM_AREA], &q);
    }
}

void vgcm_energy(const struct brc_sim *sim, const void *state, double (*of_grain)[BRC_N_ACCOUNTS])
{
    const struct vgcm_law *law = &((const struct vgcm_state *)state)->law;
    for (size_t i = 0; i < sim->pairs.n; i++)
        add_pair(sim, law, i, of_grain[sim->pairs.a[i]]);
    for (size_t i = 0; i < sim->platens.n; i++)
        add_platen(sim, law, i, of_grain[sim->platens.a[i]]);
}

/* By area and not by the number of points: the centroid's stands for a third of the facet. */
double vgcm_strength_left(const struct brc_sim *sim, const void *state, size_t contact)
{
    const struct vgcm_law *law = &((const struct vgcm_state *)state)->law;
    const struct brc_contacts *c = &sim->pairs;
    const struct vgcm_points *p = vgcm_point_columns(c);
    int flags = vgcm_law_flags(law);
    double whole = 0, left = 0;
    /* no point of it has left the elastic range */
    if (vgcm_columns(c)->phase[contact] == VGCM_AFFINE)
        return 1;
    for (size_t j = (size_t)c->p0[contact], end = j + (size_t)c->np[contact]; j < end; j++) {
        brc_lanes dn = brc_lanes_all(p->law[j][VGCM_DN]), ds = brc_lanes_all(p->law[j][VGCM_DS]);
        double area = p->law[j][VGCM_AREA];
        whole += area;
        left += area * vgcm_lanes_left(law, flags, dn, ds)[0];
    }
    return whole > 0 ? left / whole : 0;
}

/* Springs of all points of a facet, those that are broken and open included, as they may close
 * again; that of a sphere contact is near while it does not touch. Along the present normal, that
 * of the pose, and not the one of the last step: this is called between steps and after a
 * restart. */
static int list_pair(const struct brc_sim *sim, const struct vgcm_law *law, size_t i,
                     struct brc_springs *out)
{
    const struct brc_contacts *c = &sim->pairs;
    const struct vgcm_contacts *f = vgcm_columns(c);
    const struct vgcm_points *p = vgcm_point_columns(c);
    struct vgcm_motion m;
    int32_t contact = (int32_t)i;
    const struct vgcm_index4 index = {.at = {contact, contact, contact, contact}};
    vgcm_motion_of(&sim->bodies, c, &index, 0, &m);
    struct brc_spring spring = {.a = c->a[i], .b = c->b[i], .is_near = c->k[i][0] == 0};
    double s[3], t[3];
    brc_set(spring.n, m.n[0][0], m.n[1][0], m.n[2][0]);
    brc_set(s, m.s[0][0], m.s[1][0], m.s[2][0]);
    brc_set(t, m.t[0][0], m.t[1][0], m.t[2][0]);
    for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++) {
        brc_scale(spring.ra, spring.n, m.h[0]);
        brc_axpy(spring.ra, p->law[j][VGCM_AT_S], s);
        brc_axpy(spring.ra, p->law[j][VGCM_AT_T], t);
        brc_copy(spring.rb, spring.ra);
        brc_axpy(spring.rb, -m.d[0], spring.n);
        spring.kn = f->kn[i] * p->law[j][VGCM_AREA];
        spring.ks = law->eta * spring.kn;
        BRC_TRY(brc_springs_add(sim->ctx, out, &spring));
    }
    return 0;
}

/* A grip has no shear: it holds along the normal alone. */
static int list_platen(const struct brc_sim *sim, const struct vgcm_law *law, size_t i,
                       struct brc_springs *out)
{
    const struct brc_contacts *c = &sim->platens;
    const struct vgcm_contacts *f = vgcm_columns(c);
    const struct vgcm_points *p = vgcm_point_columns(c);
    const struct brc_platen *platen = brc_sim_platen(sim, c->b[i]);
    struct brc_spring spring = {.a = c->a[i], .b = c->b[i]};
    double t[3], x[3], height, normal[3];
    brc_cross(t, f->n[i], f->s[i]);
    for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++) {
        brc_scale(spring.ra, f->n[i], p->h[j]);
        if (f->phase[i] == VGCM_SPHERE)
            brc_scale(spring.ra, f->n[i], p->un[j] + f->contact_distance[i]);
        brc_axpy(spring.ra, p->law[j][VGCM_AT_S], f->s[i]);
        brc_axpy(spring.ra, p->law[j][VGCM_AT_T], t);
        brc_add(x, sim->bodies.x[c->a[i]], spring.ra);
        brc_platen_height(platen, sim->bodies.x[c->b[i]], x, &height, normal);
        brc_scale(spring.n, normal, -1);
        spring.kn = f->kn[i] * p->law[j][VGCM_AREA];
        spring.ks =
            vgcm_platen_bonding(c, i, platen) == BRC_BONDING_GRIP ? 0 : law->eta * spring.kn;
        BRC_TRY(brc_springs_add(sim->ctx, out, &spring));
    }
    return 0;
}

int vgcm_springs(const struct brc_sim *sim, const void *state, struct brc_springs *out)
{
    const struct vgcm_law *law = &((const struct vgcm_state *)state)->law;
    for (size_t i = 0; i < sim->pairs.n; i++)
        BRC_TRY(list_pair(sim, law, i, out));
    for (size_t i = 0; i < sim->platens.n; i++)
        BRC_TRY(list_platen(sim, law, i, out));
    return 0;
}
