/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of the VGCM-3D model: what common calls, and all that it may know of the folder. Checks
 * the input against the specimen before any memory is taken, shapes the grains, and picks the loops
 * that suit the options once a run; the work is in the other files. */
#include "vgcm/vgcm.h"

#include "common/geometry/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BRC_OWNER struct vgcm_params
static const struct brc_param params[] = {BRC_PARAM_LIST(VGCM_PARAMS)};
#undef BRC_OWNER
#define BRC_OWNER struct vgcm_bodies
static const struct brc_field body_fields[] = {VGCM_BODY_FIELDS(BRC_FIELD)};
#undef BRC_OWNER
#define BRC_OWNER struct vgcm_contacts
static const struct brc_field contact_fields[] = {
    VGCM_CONTACT_FIELDS(BRC_FIELD, BRC_FIELD3, BRC_FIELD_RENAMED, BRC_FIELD3_RENAMED)};
#undef BRC_OWNER
#define BRC_OWNER struct vgcm_points
static const struct brc_field point_fields[] = {VGCM_POINT_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* Called again by select whenever parameters may have changed, so nothing of the law may come from
 * anywhere else. */
void vgcm_law_of(struct vgcm_law *law, const struct vgcm_params *p)
{
    *law = (struct vgcm_law){.e_bar = p->e_bar,
                             .eta = p->eta,
                             .mu = p->mu,
                             .sigma_t = p->sigma_t,
                             .tau = p->tau,
                             .g_fn = p->g_fn,
                             .g_fs = p->g_fs,
                             .is_brittle = p->softening == VGCM_SOFTENING_NONE,
                             .adds_losses = p->damage == VGCM_DAMAGE_STRENGTH,
                             .is_post_peak = p->energies == VGCM_ENERGIES_POST_PEAK,
                             .viscous = p->viscous};
    if (p->softening == VGCM_SOFTENING_BILINEAR)
        vgcm_law_softening(law, p->softening_beta, p->softening_w1);
    else
        vgcm_law_softening(law, 0.5, 1); /* a straight line */
}

/* Elastic energies per area grow with the distance of the centres: an energy in their measure makes
 * a specimen as brittle as a scaled one. Without shear stiffness, that of eta = 1 stands in. */
void vgcm_scale_params(struct vgcm_params *p, const struct brc_facets *facets)
{
    struct vgcm_census census;
    struct vgcm_law law;
    vgcm_law_of(&law, p);
    vgcm_census_measure(&census, p, facets);
    law.eta = p->eta > 0 ? p->eta : 1;
    double kn = census.n_contacts > 0 ? law.e_bar / census.mean_distance : law.e_bar;
    double ratio = p->energy_ratio - (law.is_post_peak ? 1 : 0);
    if (isnan(p->g_fn))
        p->g_fn = ratio * vgcm_law_elastic_n(&law, kn);
    if (isnan(p->g_fs))
        p->g_fs = ratio * vgcm_law_elastic_s(&law, kn);
}

/* The softening branch of every contact must fall to the right: no snap-back. With less energy the
 * strength would have to fall while the displacement goes back, which no step of a displacement can
 * follow. */
static int check_energy(struct brc_context *ctx, const char *name, double given, double elastic,
                        double distance)
{
    if (given > elastic)
        return 0;
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "vgcm.%s = %g J/m2 must be above %g J/m2, the elastic energy at the peak strength of "
             "the contact whose centres are %g m apart (strength^2 distance / (2 modulus)): raise "
             "it, lower the strength, or choose softening: none or energies: post_peak",
             name, given, elastic, distance);
}

/* Bounds on the mean cosine and on the stiffness by direction: good, and bearable. */
static const double GOOD_COS = 0.99, LEAST_COS = 0.9, GOOD_PART = 0.05, LEAST_PART = 0.2;

/* A stiffness counts as off by the same ratio both ways. */
static bool is_oblique(const struct brc_oblique *o, double least_cos, double most)
{
    return o->mean_cos < least_cos || o->soft < 1 - most || o->stiff > 1 / (1 - most);
}

/* Springs along the lines of centres stand for the continuum only where facets are normal to them.
 * Seeds that lie outside of their cells are refused first: a normal that points backwards has no
 * stiffness that could be off. */
static int check_oblique(struct brc_context *ctx, const struct brc_oblique *o, bool is_kept,
                         const struct brc_facets *facets)
{
    if (o->reversed != SIZE_MAX)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "the centres of grains %d and %d lie on the wrong sides of their facet %zu: seeds "
                 "must lie in their cells",
                 facets->cell[o->reversed][0], facets->cell[o->reversed][1], o->reversed);
    if (is_oblique(o, LEAST_COS, LEAST_PART) && !is_kept)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "facets are oblique to the lines of centres (mean cosine %.3f, least %g), and "
                 "vgcm would "
                 "be %.3g to %.3g times as stiff as it should be, by direction (%g to %g allowed): "
                 "it needs the cells of a Laguerre or Voronoi diagram with the seeds "
                 "at its generators; vgcm.oblique: keep runs it all the same",
                 o->mean_cos, LEAST_COS, o->soft, o->stiff, 1 - LEAST_PART, 1 / (1 - LEAST_PART));
    if (is_oblique(o, GOOD_COS, GOOD_PART))
        brc_log(ctx,
                "warning: facets are oblique to the lines of centres (mean cosine %.3f): under a "
                "uniform strain vgcm is %.3g to %.3g times as stiff as the medium that it stands "
                "for, by direction",
                o->mean_cos, o->soft, o->stiff);
    return 0;
}

/* All that can be known to be wrong before a run, each with the numbers to mend it by: the law has
 * no checks of its own, as its loops have no place to report from. Fracture energies that are
 * `auto` are set in a copy: the parameters themselves are not for a check to change. */
static int check(struct brc_context *ctx, const void *values, const struct brc_specimen *specimen)
{
    struct vgcm_params scaled = *(const struct vgcm_params *)values, *p = &scaled;
    struct vgcm_census census;
    struct vgcm_law law;
    vgcm_scale_params(p, &specimen->facets);
    vgcm_law_of(&law, p);
    vgcm_census_measure(&census, p, &specimen->facets);
    if (census.n_inner > 0 && census.n_contacts == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "vgcm.interaction leaves none of the %zu facets as contacts: raise "
                 "interaction_gap (now %g m), lower interaction_area, or choose interaction: all",
                 census.n_inner, census.gap);
    if (p->tau < p->mu * p->sigma_t)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "vgcm.tau = %g Pa must be at least mu sigma_t = %g Pa, or a point in tension "
                 "would have no shear strength left",
                 p->tau, p->mu * p->sigma_t);
    if (p->softening == VGCM_SOFTENING_BILINEAR && law.kink >= 1)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "vgcm.softening_w1 = %g puts the kink behind the end of softening at (2 - "
                 "w1)/beta = %g: lower softening_w1 or softening_beta",
                 p->softening_w1, law.wc);
    BRC_TRY(
        check_oblique(ctx, &census.oblique, p->oblique == VGCM_OBLIQUE_KEEP, &specimen->facets));
    if (law.is_brittle || law.is_post_peak || census.n_contacts == 0)
        return 0;
    double kn = law.e_bar / census.largest_distance;
    BRC_TRY(
        check_energy(ctx, "g_fn", p->g_fn, vgcm_law_elastic_n(&law, kn), census.largest_distance));
    return check_energy(ctx, "g_fs", p->g_fs, vgcm_law_elastic_s(&law, kn),
                        census.largest_distance);
}

/* The law is made again by select; it is here so that bonds can be made before that. */
static int create(struct brc_sim *sim, void **state)
{
    struct vgcm_state *own = brc_alloc(sim->ctx, 1, sizeof *own);
    if (!own)
        return BRC_ERR_MEMORY;
    vgcm_scale_params(sim->params, &sim->specimen->facets);
    vgcm_law_of(&own->law, sim->params);
    sim->platens.lanes =
        BRC_LANES; /* platens_kernels.inc.h takes so many points of a contact at a time */
    *state = own;
    return 0;
}

/* Spheres at their centres, with the mass of the whole cell: a specimen of spheres alone would
 * weigh two thirds of what the rock does. The bounding sphere takes in the whole cell, as broken
 * facets act until the cells are apart. Inertia of a sphere of that volume, so that no orientation
 * has to be integrated. */
static int shape(struct brc_sim *sim, void *state)
{
    const struct vgcm_params *p = sim->params;
    const struct brc_facets *facets = &sim->specimen->facets;
    struct brc_bodies *b = &sim->bodies;
    struct vgcm_bodies *columns = b->model_columns;
    (void)state;
    for (size_t i = 0; i < facets->n_cells; i++) {
        double mass = p->density * facets->volume[i];
        double r2 = pow(3 * facets->volume[i] / (4 * BRC_PI), 2.0 / 3), reach2 = 0;
        columns->radius[i] = vgcm_radius(facets, i);
        brc_copy(b->x[i], facets->seed[i]);
        b->q[i][0] = 1;
        b->volume[i] = facets->volume[i];
        b->true_mass[i] = mass;
        brc_set(b->true_inertia[i], 0.4 * mass * r2, 0.4 * mass * r2, 0.4 * mass * r2);
        for (size_t k = facets->cell_first[i]; k < facets->cell_first[i + 1]; k++) {
            size_t facet = (size_t)facets->cell_facet[k];
            for (size_t v = facets->first[facet]; v < facets->first[facet + 1]; v++) {
                double r[3];
                brc_sub(r, facets->vertex[facets->loop[v]], b->x[i]);
                reach2 = fmax(reach2, brc_norm2(r));
            }
        }
        b->bounding_radius[i] = fmax(sqrt(reach2), columns->radius[i]);
    }
    return 0;
}

/* Flags are constants of the loops: what is off costs nothing in a step. */
static void select_loops(struct brc_sim *sim, void *state)
{
    static const struct vgcm_loops *const loops[BRC_N_SIMD] = {&vgcm_loops_base, &vgcm_loops_avx2,
                                                               &vgcm_loops_avx512};
    struct vgcm_state *own = state;
    vgcm_law_of(&own->law, sim->params);
    own->flags =
        vgcm_law_flags(&own->law) | (BRC_OPTION(sim->run.ledger) ? VGCM_LEDGER : 0) |
        (BRC_OPTION(own->law.viscous > 0 && sim->run.regime == BRC_DYNAMIC) ? VGCM_VISCOUS : 0);
    /* AVX-512 gives 8 % an elastic point on a machine of AMD's family 26 (3.62 against 3.93 ns,
     * least of three runs by turns), 5 % on one of Intel's and a loss on another (docs/speed.md) */
    own->loops = loops[brc_simd_of(sim->run.simd)];
}

/* Two of the operations choose their loop; all others of the table are called as they are. */
static void forces(struct brc_sim *sim, void *state)
{
    const struct vgcm_state *own = state;
    own->loops->forces[own->flags](sim, &own->law);
}

static void platens(struct brc_sim *sim, void *state)
{
    const struct vgcm_state *own = state;
    own->loops->platens(sim, &own->law, own->flags);
}

/* One line for the header of a run: what a reader wants who compares it with the print. */
static void describe(const struct brc_sim *sim, const void *state, char *text, size_t size)
{
    static const char *const rule[] = {"gap", "all", "area"};
    static const char *const softening[] = {"none (brittle)", "linear", "bilinear"};
    static const char *const points[] = {"paper", "exact", "one"};
    static const char *const damage[] = {"displacement", "strength"};
    const struct vgcm_state *own = state;
    const struct vgcm_params *p = sim->params;
    struct vgcm_census census;
    vgcm_census_measure(&census, p, &sim->specimen->facets);
    double kn = census.mean_distance > 0 ? p->e_bar / census.mean_distance : 0, eta = p->eta;
    snprintf(text, size,
             "interaction %s: %zu of %zu inner facets, mean centre distance %.4g mm (gap %.4g mm); "
             "points %s; softening %s, damage by %s; elastic energy at the peak, mean distance: "
             "%.4g J/m2 in "
             "tension, %.4g J/m2 in shear; fracture energies: %.4g and %.4g J/m2; uniform-strain "
             "estimate for all facets: E = %.4g GPa, nu = %.3g; mean cosine of facet normals and "
             "lines of centres %.6f%s",
             rule[p->interaction], census.n_contacts, census.n_inner, 1e3 * census.mean_distance,
             1e3 * census.gap, points[p->points], softening[p->softening], damage[p->damage],
             kn > 0 ? vgcm_law_elastic_n(&own->law, kn) : 0,
             kn > 0 ? vgcm_law_elastic_s(&own->law, kn) : 0, p->g_fn, p->g_fs,
             1e-9 * p->e_bar * (2 + 3 * eta) / (4 + eta), (1 - eta) / (4 + eta),
             census.oblique.mean_cos, census.is_projected ? " (areas are projected)" : "");
}

/* Move a number when what it stands for computes otherwise; tests/cli/test_physics.sh watches. */
static const struct brc_physics physics[] = {{"vgcm", 1, NULL},
                                             {"brittle", 1, "softening=none"},
                                             {"softening", 1, "softening=linear|bilinear"},
                                             {NULL, 0, NULL}};

/* Not saved (no_pairs and so on): moments on grains, which the loop adds to the bodies at once, and
 * what only points of platens have. */
const struct brc_model brc_model_vgcm = {
    .name = "vgcm",
    .citation = "M. Candeias, N. Monteiro Azevedo, M. L. Braga Farinha: VGCM3D - A 3D rigid "
                "particle model for rock fracture following the Voronoi tessellation of the grain "
                "structure: formulation and validation",
    .params = BRC_PARAMS(params, struct vgcm_params),
    .physics = physics,
    .body_fields = BRC_FIELDSET(body_fields, struct vgcm_bodies),
    .contact_fields = BRC_FIELDSET(contact_fields, struct vgcm_contacts),
    .point_fields = BRC_FIELDSET(point_fields, struct vgcm_points),
    .flags = BRC_MODEL_ROTATES | BRC_MODEL_ADDS,
    .no_bodies = "l",
    .no_pairs = "ta tb h un",
    .no_platens = "u status onset",
    .shape = shape,
    .bond = vgcm_bond,
    .pairs = vgcm_update_contacts,
    .forces = forces,
    .platens = platens,
    .energy = vgcm_energy,
    .springs = vgcm_springs,
    .check = check,
    .create = create,
    .free = free,
    .select = select_loops,
    .strength_left = vgcm_strength_left,
    .describe = describe};
