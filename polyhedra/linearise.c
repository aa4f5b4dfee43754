/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which contacts are linearised, for how long, and by which tangent; linearised.h carries them
 * along. */
#include "polyhedra/poly.h"

/* A contact is linearised when that is for this many steps or more: to find its tangent costs as
 * much as a step. */
static const double WORTH_STEPS = 3;

void poly_account_bond(struct poly_batch *batch, int32_t i, double stored)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    double *last = &columns->motion[batch->contact[i]][POLY_MOTION_STORED], gained = stored - *last;
    *last = stored;
    batch->energy[i][BRC_ACCOUNT_BOND] += gained;
    batch->energy[i][BRC_ACCOUNT_NORMAL] -= gained;
}

/* Adds force and moment of a bond, and its slope, to what the tangent moves along. Columns are the
 * answers to the six unit motions of b about the centre of a: three shifts, three turns. A turn
 * moves the place of the bond by its cross product with the arm; torsion answers to the part of the
 * turn about the normal alone. */
static void add_bond(const struct poly_contact4 *g, int lane, double force[6], double (*tangent)[6])
{
    double n[3], arm[3], moment[3];
    double kn = g->bond_kn[lane], kt = g->bond_kt[lane], ktheta = g->bond_ktheta[lane];
    poly_lane3(n, g->bond_n, lane);
    poly_lane3(arm, g->bond_arm, lane);
    for (int k = 0; k < 3; k++) {
        force[k] += g->bond.f[k][lane];
        force[3 + k] += g->bond.m[k][lane];
    }
    for (int j = 0; j < 6; j++) {
        double unit[3] = {j % 3 == 0, j % 3 == 1, j % 3 == 2}, d[3], f[3];
        if (j < 3)
            brc_copy(d, unit);
        else
            brc_cross(d, unit, arm);
        double along = brc_dot(d, n);
        for (int k = 0; k < 3; k++)
            f[k] = kn * along * n[k] + kt * (d[k] - along * n[k]);
        brc_cross(moment, arm, f);
        for (int k = 0; k < 3; k++) {
            tangent[j][k] += f[k];
            tangent[j][3 + k] += moment[k];
            if (j >= 3)
                tangent[j][3 + k] += ktheta * n[j - 3] * n[k];
        }
    }
}

/* Relative path for which no point that sleeps can touch, `most` at most. That is also one for
 * which no vertex of `strict` leaves its face, since one of its edges comes or goes across the
 * face's then. They stand sorted by when they wake up, so the first that counts ends the search.
 * Edges that fade, where some do, are left out: they come and go with a weight that begins at 0
 * (README.md). */
static double path_of_sleepers(const struct brc_contacts *c, size_t contact, double most,
                               bool fades)
{
    const struct poly_contacts *columns = c->model_columns;
    const struct poly_points *points = c->point_columns;
    size_t p = (size_t)c->p0[contact] + (size_t)columns->awake[contact];
    size_t end = (size_t)c->p0[contact] + (size_t)c->np[contact];
    double skin_left = columns->skin_left[contact];
    most = poly_least(most, skin_left);
    if (!fades)
        return p < end ? poly_least(most, skin_left - points->sleep[p]) : most;
    for (; p < end && skin_left - points->sleep[p] < most; p++)
        if (points->kind[p] != POLY_EDGES || points->feature_valid_to[p] != POLY_FADES)
            return skin_left - points->sleep[p];
    return most;
}

/* `closed` lists three times as many feature pairs of a contact as `merged`, and of faces that were
 * one most begin at a distance of just 2 R: some pair is always about to touch, by its bound,
 * though hardly any does. To compute the contact anew for each takes 12.5e6 instead of 9.7e6
 * instructions a step of the block of bench_polyhedra, and points that hover would keep it literal.
 */
bool poly_look_at_sleepers(struct poly_batch *batch, size_t contact, double path)
{
    struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    const struct poly_points *points = c->point_columns;
    double *end = &columns->motion[contact][POLY_MOTION_END];
    double skin_left = columns->skin_left[contact] - path,
           most = *poly_tangent_end(columns, contact);
    size_t first = (size_t)c->p0[contact] + (size_t)columns->awake[contact];
    size_t last = (size_t)c->p0[contact] + (size_t)c->np[contact];
    struct poly_pair pair;
    if (path >= most)
        return false;
    poly_pair_of(&pair, batch->sim, batch->st, c->a[contact], c->b[contact]);
    while (first < last && points->sleep[first] >= skin_left) {
        struct poly_feature f = poly_point(points, first);
        double sleep = skin_left - poly_closed_gap(&pair, &f);
        if (sleep >= skin_left)
            return false;
        poly_sleep_on(c, contact, sleep);
    }
    *end = first < last ? poly_least(most, path + (skin_left - points->sleep[first])) : most;
    return path < *end;
}

/* Relative path of a contact before its bond can break, or begin or end to pull: openings change by
 * twice the path at most, strains by that over the strain length, the twist by the path over the
 * reach of b. A bond that is closed has no tension stiffness and one that is open has: the tangent
 * has one or the other, so it ends where the opening changes its sign. */
static double path_of_bond(const struct poly_batch *batch, int32_t i)
{
    const struct poly_params *p = poly_params_of(batch->sim);
    const struct poly_contacts *columns = batch->contacts->model_columns;
    const struct poly_contact4 *g = &batch->four[i / BRC_LANES];
    double length = columns->bond[batch->contact[i]][POLY_BOND_LENGTH];
    double slope = 2 / (length * p->eps_th), path = 0.5 * fabs(g->opening[i % BRC_LANES]);
    if (p->torsion && p->theta_limit)
        slope += 1 / (batch->sim->bodies.bounding_radius[batch->b[i]] * p->theta_th);
    return p->breakable ? poly_least(path, (1 - g->broken[i % BRC_LANES]) / slope) : path;
}

/* Relative path for which a contact may be linearised, as far as its acting springs do not matter;
 * without regard to sleepers where they are looked at one by one. All of it from saved fields of
 * the contact and its bodies, so that a restart decides alike. */
static double path_left(const struct poly_batch *batch, int32_t i)
{
    const struct poly_params *p = poly_params_of(batch->sim);
    const struct brc_contacts *c = batch->contacts;
    const struct poly_contacts *columns = c->model_columns;
    size_t contact = (size_t)batch->contact[i];
    /* The limit by accuracy first; what may begin to touch, or break, only shortens it. */
    double most = p->condensed_path * p->radius;
    if (c->status[contact] == BRC_INTACT)
        most = poly_least(most, path_of_bond(batch, i));
    if (batch->listed[i])
        return batch->looks ? poly_least(most, columns->skin_left[contact])
                            : path_of_sleepers(c, contact, most, true);
    return poly_least(batch->four[i / BRC_LANES].gap[i % BRC_LANES], most);
}

/* Whether a path is worth it. What rests and may not move at all is not. */
static bool is_long(const struct poly_batch *batch, int32_t i, double path)
{
    return path > WORTH_STEPS * batch->four[i / BRC_LANES].path[i % BRC_LANES];
}

/* Asked before the forces, since the tangent is summed up along with them; what their points have
 * to say is asked again afterwards (poly_linearise). A contact that fills the work lists by itself
 * is left out: its points have been worked off in parts. */
void poly_begin_tangent(struct poly_batch *batch, int32_t i)
{
    const struct poly_contacts *columns = batch->contacts->model_columns;
    bool is_whole = !batch->listed[i] || columns->ready[batch->contact[i]];
    batch->will_linearise[i] = is_whole && is_long(batch, i, path_left(batch, i));
    if (batch->will_linearise[i])
        memset(batch->tangent[i], 0, sizeof batch->tangent[i]);
}

/* The motion begins at 0 whether the contact is linearised or not: it is also what a contact that
 * stays literal has moved by its next step. */
void poly_linearise(struct poly_batch *batch, int32_t i)
{
    struct brc_sim *sim = batch->sim;
    const struct poly_contacts *columns = sim->pairs.model_columns;
    size_t contact = (size_t)batch->contact[i];
    bool is_intact = sim->pairs.status[contact] == BRC_INTACT;
    double *motion = columns->motion[contact];
    double stored = is_intact ? batch->four[i / BRC_LANES].bond_stored[i % BRC_LANES] : 0;
    if (is_intact)
        poly_account_bond(batch, i, stored);
    memset(motion, 0, sizeof columns->motion[contact]);
    motion[POLY_MOTION_STORED] = stored;
    /* A point that is awake and apart may touch within a few steps. Rather than to look for its
     * bound here, the contact waits until it sleeps: then it has one. */
    if (!batch->will_linearise[i] || (batch->has_apart[i] && !batch->looks))
        return;
    double end = poly_least(batch->valid_path[i], path_left(batch, i));
    if (!is_long(batch, i, end))
        return;
    motion[POLY_MOTION_END] = end;
    if (batch->looks) {
        *poly_tangent_end(columns, contact) = end;
        if (batch->listed[i])
            motion[POLY_MOTION_END] = path_of_sleepers(batch->contacts, contact, end, false);
    }
    columns->is_linearised[contact] = 1;
    for (int k = 0; k < 6; k++)
        columns->linearised_force[contact][k] =
            batch->sum[i][POLY_SUM_NORMAL + k] + batch->sum[i][POLY_SUM_SHEAR + k];
    memcpy(columns->tangent[contact], batch->tangent[i], sizeof columns->tangent[contact]);
    if (is_intact)
        add_bond(&batch->four[i / BRC_LANES], i % BRC_LANES, columns->linearised_force[contact],
                 (double(*)[6])columns->tangent[contact]);
}
