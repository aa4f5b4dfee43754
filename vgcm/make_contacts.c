/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which pairs interact, and the state in which new contacts begin. Called at the start and at each
 * neighbour search, never within a step; all that a contact keeps for good (stiffness, places and
 * areas of points, moments) is set here. It may not know the law past its elastic range. */
#include "vgcm/vgcm.h"

#include "common/geometry/vec.h"
#include "vgcm/points.h"

#include <stdlib.h>

/* Facets below this part of the mean area are points and lines that rounding has left. */
static const double LEAST_AREA = 1e-12;
/* Mean cosine between facets and lines of centres above which the cells are a Laguerre diagram with
 * the centres at its generators, to rounding; and the least that a projected area counts with. */
static const double NORMAL_COS = 1 - 1e-6, LEAST_COS = 0.01;
/* Smallest distance from a platen that its stiffness counts with, in radii of the grain's volume:
 * a Voronoi seed may lie on the platen itself. */
static const double LEAST_DISTANCE = 0.1;

/* Spheres of plain Voronoi cells do not overlap by it. */
double vgcm_radius(const struct brc_facets *facets, size_t cell)
{
    double least = HUGE_VAL, r[3];
    if (facets->radius[cell] > 0)
        return facets->radius[cell];
    for (size_t k = facets->cell_first[cell]; k < facets->cell_first[cell + 1]; k++) {
        size_t facet = (size_t)facets->cell_facet[k];
        brc_sub(r, facets->centroid[facet], facets->seed[cell]);
        least = fmin(least, fabs(brc_dot(r, facets->normal[facet])));
    }
    return least;
}

static double centre_distance(const struct brc_facets *facets, size_t facet)
{
    const int32_t *cell = facets->cell[facet];
    return brc_distance(facets->seed[cell[0]], facets->seed[cell[1]]);
}

/* The paper does not say which facets are contacts; README.md tells how these rules compare. The
 * gap rule takes a plain Voronoi cell for a sphere of its volume; a specimen of spheres has their
 * radii, so that the rule counts the gaps that the packing has. A facet that rounding has left has
 * no area to be stiff with, and would only cost time. */
static bool is_bonded(const struct vgcm_census *census, const struct vgcm_params *params,
                      const struct brc_facets *facets, size_t facet)
{
    if (facets->cell[facet][1] < 0 || !facets->is_contact[facet] ||
        facets->area[facet] <= LEAST_AREA * census->mean_area)
        return false;
    if (params->interaction == VGCM_INTERACTION_ALL)
        return true;
    if (params->interaction == VGCM_INTERACTION_AREA)
        return facets->area[facet] >= params->interaction_area * census->mean_area;
    double ra = brc_facets_radius(facets, (size_t)facets->cell[facet][0]);
    double rb = brc_facets_radius(facets, (size_t)facets->cell[facet][1]);
    return centre_distance(facets, facet) < ra + rb + census->gap;
}

/* Two passes over the facets, as the rules count in means that have to be known before. The oblique
 * measure is that of the areas that count: projected ones, where the cells are not a Laguerre
 * diagram of their centres. */
void vgcm_census_measure(struct vgcm_census *census, const struct vgcm_params *params,
                         const struct brc_facets *facets)
{
    double diameters = 0, sum = 0;
    *census = (struct vgcm_census){0};
    for (size_t i = 0; i < facets->n_cells; i++)
        diameters += 2 * brc_facets_radius(facets, i);
    double area = brc_facets_inner_area(facets, &census->n_inner);
    census->gap = params->interaction_gap > 0
                      ? params->interaction_gap
                      : params->interaction_gap_ratio * diameters / (double)facets->n_cells;
    if (census->n_inner > 0)
        census->mean_area = area / (double)census->n_inner;
    for (size_t i = 0; i < facets->n_facets; i++) {
        if (!is_bonded(census, params, facets, i))
            continue;
        double d = centre_distance(facets, i);
        census->n_contacts++;
        census->largest_distance = fmax(census->largest_distance, d);
        sum += d;
    }
    if (census->n_contacts > 0)
        census->mean_distance = sum / (double)census->n_contacts;
    brc_oblique_measure(&census->oblique, facets, facets->seed, false);
    census->is_projected = census->oblique.mean_cos < NORMAL_COS;
    if (census->is_projected)
        brc_oblique_measure(&census->oblique, facets, facets->seed, true);
}

/* Adds the facet's points to contact i, at their places (s, t, h) in the contact's frame about
 * origin, with that ratio of their areas. Places ride with the contact from now on, so that they
 * are kept in its frame, where they never change. */
static int add_points(struct brc_sim *sim, struct brc_contacts *c, size_t i, size_t facet,
                      const double origin[3], double ratio)
{
    const struct vgcm_params *params = sim->params;
    const struct brc_facets *facets = &sim->specimen->facets;
    size_t n_vertices = facets->first[facet + 1] - facets->first[facet];
    enum vgcm_points_rule rule = (enum vgcm_points_rule)params->points;
    int32_t n = vgcm_points_count(rule, n_vertices), old = c->np[i];
    double(*x)[3] = brc_alloc(sim->ctx, (size_t)n, sizeof *x);
    double *area = brc_alloc(sim->ctx, (size_t)n, sizeof *area);
    int code = x && area ? brc_contacts_points(sim->ctx, c, i, old + n) : BRC_ERR_MEMORY;
    if (code == 0) {
        const struct vgcm_contacts *f = vgcm_columns(c);
        const struct vgcm_points *p = vgcm_point_columns(c);
        double t[3], r[3];
        vgcm_points_place(rule, facets, facet, x, area);
        brc_cross(t, f->n[i], f->s[i]);
        for (size_t j = 0; j < (size_t)n; j++) {
            size_t to = (size_t)(c->p0[i] + old) + j;
            brc_sub(r, x[j], origin);
            p->law[to][VGCM_AT_S] = brc_dot(r, f->s[i]);
            p->law[to][VGCM_AT_T] = brc_dot(r, t);
            p->h[to] = brc_dot(r, f->n[i]);
            p->law[to][VGCM_AREA] = ratio * area[j];
        }
    }
    free(x);
    free(area);
    return code;
}

/* Area moments and radius of a contact from its points. The radius bounds where a point may be,
 * for the tests of strength and opening that look at no point (forces_kernels.inc.h). Six
 * moments carry the whole contact while it is elastic: its force, energy and stiffness are sums
 * over points of products of their places. */
static void set_moments(struct brc_contacts *c, size_t i)
{
    struct vgcm_contacts *f = vgcm_columns(c);
    const struct vgcm_points *p = vgcm_point_columns(c);
    double *m = f->moment[i], radius2 = 0;
    for (int k = 0; k < VGCM_N_MOMENTS; k++)
        m[k] = 0;
    for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++) {
        double area = p->law[j][VGCM_AREA], s = p->law[j][VGCM_AT_S], t = p->law[j][VGCM_AT_T];
        m[VGCM_A] += area;
        m[VGCM_A_S] += area * s;
        m[VGCM_A_T] += area * t;
        m[VGCM_A_SS] += area * s * s;
        m[VGCM_A_ST] += area * s * t;
        m[VGCM_A_TT] += area * t * t;
        radius2 = fmax(radius2, s * s + t * t);
    }
    f->facet_radius[i] = sqrt(radius2);
}

/* The reference point is where the line of centres meets the facet's plane. The sums of stiffness
 * count all points from the start, which bounds what any of them may do later: larger masses, never
 * an unstable step. */
static int bond_contact(struct brc_sim *sim, const struct vgcm_law *law, size_t i, size_t facet,
                        double ratio)
{
    struct brc_contacts *c = &sim->pairs;
    const struct brc_bodies *b = &sim->bodies;
    struct vgcm_contacts *f = vgcm_columns(c);
    double branch[3], t[3], to_facet[3], origin[3];
    const double *xa = b->x[c->a[i]];
    brc_sub(branch, b->x[c->b[i]], xa);
    double d = brc_normalise(f->n[i], branch);
    brc_frame(f->s[i], t, f->n[i]);
    brc_sub(to_facet, sim->specimen->facets.centroid[facet], xa);
    double h = brc_dot(to_facet, f->n[i]);
    brc_copy(origin, xa);
    brc_axpy(origin, h, f->n[i]);
    c->facet[i] = (int32_t)facet;
    c->status[i] = BRC_INTACT;
    f->phase[i] = VGCM_AFFINE;
    f->kn[i] = law->e_bar / d; /* eq:vgcm:28 */
    f->plane[i] = h - d / 2;   /* (R_a - R_b)/2 - d_v; eq:vgcm:8 */
    BRC_TRY(add_points(sim, c, i, facet, origin, ratio));
    set_moments(c, i);
    const double *m = f->moment[i];
    double k = f->kn[i] * fmax(1, law->eta), g = d - h, polar = m[VGCM_A_SS] + m[VGCM_A_TT];
    brc_set(c->k[i], k * m[VGCM_A], k * (m[VGCM_A] * h * h + polar),
            k * (m[VGCM_A] * g * g + polar));
    return 0;
}

/* An oblique facet is projected along the line of centres, points and area. The sum of A cos d over
 * the facets is three times the volume for any cells and centres, so that the mean stiffness over
 * all directions stays that of the continuum; no choice of a pair's stiffness does so direction by
 * direction (README.md). */
static double area_ratio(const struct vgcm_census *census, const struct brc_facets *facets,
                         size_t facet)
{
    return census->is_projected ? fmax(brc_oblique_cos(facets, facets->seed, facet), LEAST_COS) : 1;
}

/* Two grains have one facet at most, so contact i is that of the i-th one. */
static int bond_pairs(struct brc_sim *sim, const struct vgcm_law *law)
{
    const struct brc_facets *facets = &sim->specimen->facets;
    struct vgcm_census census;
    vgcm_census_measure(&census, sim->params, facets);
    struct brc_facing *facet = brc_alloc(sim->ctx, census.n_contacts, sizeof *facet);
    size_t n = 0;
    if (!facet)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < facets->n_facets; i++)
        if (is_bonded(&census, sim->params, facets, i))
            facet[n++] =
                (struct brc_facing){facets->cell[i][0], facets->cell[i][1], (int32_t)i, false};
    int code = brc_contacts_open(sim->ctx, &sim->pairs, facet, n);
    for (size_t i = 0; code == 0 && i < n; i++) {
        size_t at = (size_t)facet[i].facet;
        code = bond_contact(sim, law, i, at, area_ratio(&census, facets, at));
    }
    free(facet);
    return code;
}

/* Height of a grain's centre over a platen; false: beyond a sharp edge. */
static bool centre_height(const struct brc_sim *sim, int32_t cell, const struct brc_platen *platen,
                          double *height)
{
    double normal[3];
    return brc_platen_height(platen, sim->bodies.x[platen->body], sim->bodies.x[cell], height,
                             normal);
}

/* Drops the points beyond the platen's sharp edges. Where the platen is bonded the rest begin on
 * its surface: they are held as they lie, without a force. On a plane the height is that of the
 * others to the last bit, as a held plane of points should begin without a force; on a curved
 * surface each point moves along its own normal. */
static void fit_points(struct brc_sim *sim, size_t i, const struct brc_platen *platen, double above)
{
    struct brc_contacts *c = &sim->platens;
    const struct vgcm_contacts *f = vgcm_columns(c);
    const struct vgcm_points *p = vgcm_point_columns(c);
    size_t to = (size_t)c->p0[i], end = to + (size_t)c->np[i];
    double t[3], x[3], gap, normal[3];
    brc_cross(t, f->n[i], f->s[i]);
    for (size_t j = to; j < end; j++) {
        double s = p->law[j][VGCM_AT_S], u = p->law[j][VGCM_AT_T], h = p->h[j];
        brc_copy(x, sim->bodies.x[c->a[i]]);
        brc_axpy(x, s, f->s[i]);
        brc_axpy(x, u, t);
        brc_axpy(x, h, f->n[i]);
        if (!brc_platen_height(platen, sim->bodies.x[platen->body], x, &gap, normal))
            continue;
        if (platen->bonding != BRC_BONDING_NONE && vgcm_platen_is_curved(platen)) {
            s -= gap * brc_dot(normal, f->s[i]);
            u -= gap * brc_dot(normal, t);
            h -= gap * brc_dot(normal, f->n[i]);
        } else if (platen->bonding != BRC_BONDING_NONE) {
            h = above; /* to the last bit */
        }
        p->law[to][VGCM_AT_S] = s;
        p->law[to][VGCM_AT_T] = u;
        p->h[to] = h;
        p->law[to++][VGCM_AREA] = p->law[j][VGCM_AREA];
    }
    c->np[i] = (int32_t)(to - (size_t)c->p0[i]);
}

/* Half of the sums that pairs have, as a platen has no mass to be scaled. A platen that closes late
 * must not make a step unstable that has been chosen before.
 * All points count from the start, closed or not: what the masses and the step must bear. */
static void set_platen_stiffness(struct brc_contacts *c, size_t i, const struct vgcm_law *law)
{
    const struct vgcm_contacts *f = vgcm_columns(c);
    const struct vgcm_points *p = vgcm_point_columns(c);
    double k = f->kn[i] * fmax(1, law->eta), moment = 0;
    for (size_t j = (size_t)c->p0[i], end = j + (size_t)c->np[i]; j < end; j++)
        moment += p->law[j][VGCM_AREA] *
                  (p->law[j][VGCM_AT_S] * p->law[j][VGCM_AT_S] +
                   p->law[j][VGCM_AT_T] * p->law[j][VGCM_AT_T] + p->h[j] * p->h[j]);
    brc_set(c->k[i], k * f->moment[i][VGCM_A], k * moment, 0);
}

/* The points of the boundary facets of a grain that face a platen. By the distance of the centre to
 * the platen as its own half of a contact, whatever the shape of the surface; a seed on the platen
 * would be infinitely stiff, hence the least distance. It begins with its points: they may lie
 * anywhere and slide, so no field of six numbers is theirs. */
static int platen_contact(struct brc_sim *sim, const struct vgcm_law *law, size_t i,
                          const struct brc_facing *facing, size_t n)
{
    struct brc_contacts *c = &sim->platens;
    struct vgcm_contacts *f = vgcm_columns(c);
    const struct brc_platen *platen = brc_sim_platen(sim, c->b[i]);
    int32_t cell = c->a[i];
    double volume = sim->specimen->facets.volume[cell];
    double above, least = LEAST_DISTANCE * cbrt(3 * volume / (4 * BRC_PI));
    centre_height(sim, cell, platen, &above);
    brc_scale(f->n[i], platen->n, -1);
    brc_copy(f->s[i], platen->across);
    f->phase[i] = VGCM_POINTS;
    f->kn[i] = law->e_bar / fmax(above, least); /* eq:vgcm:28 */
    for (size_t k = 0; k < n; k++)
        BRC_TRY(add_points(sim, c, i, (size_t)facing[k].facet, sim->bodies.x[cell], 1));
    fit_points(sim, i, platen, above);
    set_moments(c, i);
    set_platen_stiffness(c, i, law);
    return 0;
}

/* One contact for each grain and platen, of all the facets that face it, which follow each other in
 * the list. */
static int bond_platens(struct brc_sim *sim, const struct vgcm_law *law)
{
    const struct brc_contacts *c = &sim->platens;
    struct brc_facing *facing = NULL;
    size_t n = 0;
    BRC_TRY(brc_platens_facing(sim, &facing, &n));
    int code = brc_contacts_open(sim->ctx, &sim->platens, facing, n);
    for (size_t i = 0, k = 0; code == 0 && i < c->n; i++) {
        size_t first = k;
        while (k < n && facing[k].cell == c->a[i] && facing[k].body == c->b[i])
            k++;
        code = platen_contact(sim, law, i, facing + first, k - first);
    }
    free(facing);
    return code;
}

int vgcm_bond(struct brc_sim *sim, void *state)
{
    const struct vgcm_state *own = state;
    BRC_TRY(bond_pairs(sim, &own->law));
    BRC_TRY(bond_platens(sim, &own->law));
    BRC_TRY(brc_contacts_compact(sim->ctx, &sim->pairs));
    return brc_contacts_compact(sim->ctx, &sim->platens);
}

/* Distance at which the spheres of a pair, or a sphere and a platen, begin to touch, and the one
 * that they have now. A platen has no radius; its height says how far the centre is. False: beyond
 * a sharp edge of the platen. */
static bool touching_distance(const struct brc_sim *sim, const int32_t pair[2], double *touch,
                              double *now)
{
    const struct vgcm_bodies *columns = sim->bodies.model_columns;
    *touch = columns->radius[pair[0]];
    if ((size_t)pair[1] >= sim->bodies.n_grains)
        return centre_height(sim, pair[0], brc_sim_platen(sim, pair[1]), now);
    *now = brc_distance(sim->bodies.x[pair[0]], sim->bodies.x[pair[1]]);
    *touch += columns->radius[pair[1]];
    return true;
}

/* A facet at a platen stays for good: it may come back, and its points' gaps at the start are part
 * of the test. A contact with a force stays until it has none, or energy would vanish with it. What
 * is new is watched from the skin of the neighbour search on, before it touches, and the list need
 * not be made anew in each step; beyond a sharp edge a sphere may meet the side of a strip, which
 * is not part of its surface. */
static bool stays(const void *user, const struct brc_contacts *c, const int32_t pair[2],
                  int64_t contact, bool is_near)
{
    const struct brc_sim *sim = user;
    double touch, now;
    if (contact >= 0) {
        bool is_facet = vgcm_columns(c)->phase[contact] != VGCM_SPHERE;
        if ((is_facet && c == &sim->platens) || c->status[contact] == BRC_INTACT ||
            brc_norm2(c->f[contact]) > 0 || (is_near && c->status[contact] == BRC_BROKEN))
            return true;
    }
    return is_near && touching_distance(sim, pair, &touch, &now) && now < touch + sim->skin;
}

/* Two grains without a bonded facet have no common plane, so that spheres are all that is left to
 * meet by. An overlap that is there when a pair is first seen (cells bulge out of their spheres,
 * and spheres of Laguerre cells overlap) would be energy from nowhere. The one point of a new
 * sphere contact, force-free as it is now. As stiff as E-bar A / d with the section of the smaller
 * sphere (README.md). */
static int sphere_contact(struct brc_sim *sim, const struct vgcm_law *law, struct brc_contacts *c,
                          size_t i)
{
    const struct vgcm_bodies *columns = sim->bodies.model_columns;
    bool is_platen = c == &sim->platens;
    BRC_TRY(brc_contacts_points(sim->ctx, c, i, 1));
    struct vgcm_contacts *f = vgcm_columns(c);
    struct vgcm_points *p = vgcm_point_columns(c);
    const int32_t pair[2] = {c->a[i], c->b[i]};
    double now, touch;
    touching_distance(sim, pair, &touch, &now);
    double ra = columns->radius[pair[0]], rb = is_platen ? ra : columns->radius[pair[1]];
    f->phase[i] = VGCM_SPHERE;
    f->kn[i] = law->e_bar / touch; /* eq:vgcm:28 */
    f->plane[i] = (ra - rb) / 2;
    f->contact_distance[i] = fmin(touch, now);
    c->gap[i] = fmax(now - touch, 0);
    p->law[c->p0[i]][VGCM_AREA] = BRC_PI * fmin(ra, rb) * fmin(ra, rb);
    if (is_platen) {
        const struct brc_platen *platen = brc_sim_platen(sim, pair[1]);
        brc_scale(f->n[i], platen->n, -1);
        brc_copy(f->s[i], platen->across);
        double k = f->kn[i] * fmax(1, law->eta) * p->law[c->p0[i]][VGCM_AREA];
        brc_set(c->k[i], k, k * touch * touch, 0);
    }
    set_moments(c, i);
    return 0;
}

/* Contacts that are new have no points yet: that is how they are told from the rest. */
static int update_contacts(struct brc_sim *sim, const struct vgcm_law *law, struct brc_contacts *c,
                           const struct brc_neighbours *list)
{
    BRC_TRY(brc_contacts_merge(sim->ctx, c, list, stays, sim));
    for (size_t i = 0; i < c->n; i++)
        if (c->np[i] == 0 && vgcm_columns(c)->phase[i] == VGCM_SPHERE)
            BRC_TRY(sphere_contact(sim, law, c, i));
    return brc_contacts_tidy(sim->ctx, c);
}

int vgcm_update_contacts(struct brc_sim *sim, void *state, const struct brc_neighbours *grains,
                         const struct brc_neighbours *platens)
{
    const struct vgcm_state *own = state;
    BRC_TRY(update_contacts(sim, &own->law, &sim->pairs, grains));
    return update_contacts(sim, &own->law, &sim->platens, platens);
}
