/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two platens along an axis, moved alike by the loading: the whole mechanics of compression,
 * tension and the Brazilian test, which differ in axis, sense, surface and bond alone. It knows the
 * rig and the bodies, and no contact model. */
#include "common/rigs/two_platens.h"

#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "common/rigs/elastic_moduli.h"
#include "common/rigs/gauge.h"

#include <math.h>
#include <stdlib.h>

static const double PLATENS_MEET = 1; /* strain */
/* An end lies across the axis, to this many degrees, where its facets do in the mean (rough ends)
 * or one of them does (the sides of a disc). One that is tilted stands on an edge, and what is
 * measured is how the edge gives way. */
static const double MOST_TILT = 10;

/* For tests of any sense: those that pull may go as far as they like. */
int brc_two_platens_check(struct brc_context *ctx, const struct brc_test_params *t, const void *own)
{
    (void)own;
    BRC_TRY(brc_loading_check(ctx, t));
    return brc_moduli_check(ctx, t);
}

/* Refused before a specimen is made; what an adaptive rate may still do on the way is found in
 * brc_two_platens_load. */
int brc_two_platens_check_closing(struct brc_context *ctx, const struct brc_test_params *t,
                                  const void *own)
{
    if (t->strain_max >= PLATENS_MEET)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "test.strain_max = %g: the platens meet at a strain of 1; allowed in compression "
                 "and in the Brazilian test (0, 1)",
                 t->strain_max);
    return brc_two_platens_check(ctx, t, own);
}

/* The mean over the length, from the volume: a specimen with rough ends or a polygon for a circle
 * has no one section. */
double brc_two_platens_section(const struct brc_sim *sim, int axis)
{
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    return sim->specimen->domain_volume / (high[axis] - low[axis]);
}

/* Each by half of the rate, so that the middle of the specimen stays where it is: gauge and grains
 * then have no mean motion. */
static void set_velocities(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    for (int i = 0; i < 2; i++) /* other pairs are the test's own */
        brc_scale(sim->bodies.v[rig->platen[i].body], rig->platen[i].n,
                  rig->sense * 0.5 * rig->rate * rig->length[rig->axis]);
}

/* Bodies of platens come behind all grains, in the order of the rig's list: contacts know them by
 * that number alone. Across is any axis but their own, for surfaces that are not the same all
 * round. */
void brc_two_platens_face(struct brc_sim *sim, int first, int axis, const struct brc_platen *like)
{
    struct brc_bodies *b = &sim->bodies;
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    for (int i = first; i < first + 2; i++) {
        struct brc_platen *p = &sim->rig.platen[i];
        *p = *like;
        if (p->surface == BRC_SURFACE_PLANE)
            p->half_width = HUGE_VAL;
        p->body = (int32_t)b->n_grains + i;
        p->n[axis] = i == first ? 1 : -1;
        p->across[axis == 0] = 1;
        for (int k = 0; k < 3; k++)
            b->x[p->body][k] = 0.5 * (low[k] + high[k]);
        b->x[p->body][axis] = i == first ? low[axis] : high[axis];
        brc_copy(b->x0[p->body], b->x[p->body]);
    }
}

void brc_two_platens_begin(struct brc_sim *sim, int axis, double sense, double section)
{
    struct brc_rig *rig = &sim->rig;
    struct brc_bodies *b = &sim->bodies;
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    rig->axis = axis;
    rig->sense = sense;
    rig->section = section;
    for (int k = 0; k < 3; k++)
        rig->length[k] = high[k] - low[k];
    brc_gauge_check(sim);
    rig->rate = rig->params.rate = brc_loading_start_rate(&rig->params);
    for (size_t i = 0; i < b->n_grains; i++) {
        rig->type->field(sim, i, b->v[i]);
        brc_copy(b->v_mean[i], b->v[i]);
    }
}

/* What of the specimen's surface faces a platen. */
struct end {
    double sum[3]; /* m2, of its vector areas */
    double cosine; /* of the facet that lies most nearly across the axis */
    double on;     /* m2, of what lies on the platen */
};

static double tilt_of(const struct end *e, const double n[3])
{
    double mean = -brc_dot(e->sum, n) / brc_norm(e->sum);
    return acos(fmin(fmax(mean, e->cosine), 1)) * 180 / BRC_PI;
}

static int check_end(struct brc_sim *sim, int platen, const struct end *e)
{
    const struct brc_platen *p = &sim->rig.platen[platen];
    const char *where = platen == 0 ? "lower" : "upper", *kind = sim->rig.type->name;
    char axis = "xyz"[sim->rig.axis];
    if (brc_norm(e->sum) == 0)
        BRC_FAIL(sim->ctx, BRC_ERR_GEOMETRY,
                 "none of the specimen's surface faces the platen at the %s end of %c within 30 "
                 "degrees, and test.kind: %s loads it there: use a specimen with ends across %c",
                 where, axis, kind, axis);
    if (tilt_of(e, p->n) > MOST_TILT)
        BRC_FAIL(sim->ctx, BRC_ERR_GEOMETRY,
                 "the %s end of the specimen along %c is tilted by %.3g degrees against its "
                 "platen, allowed %g: turn the specimen so that its ends lie across %c, as "
                 "test.kind: %s loads it along %c",
                 where, axis, tilt_of(e, p->n), MOST_TILT, axis, kind, axis);
    if (p->bonding != BRC_BONDING_NONE && e->on == 0)
        BRC_FAIL(sim->ctx, BRC_ERR_GEOMETRY,
                 "no facet lies in the plane of the %s end along %c, so that its platen has "
                 "nothing to hold: test.kind: %s needs flat ends",
                 where, axis, kind);
    return 0;
}

/* A specimen that cannot carry the load would run to its last step, or fly. */
static int check_ends(struct brc_sim *sim)
{
    const struct brc_facets *f = &sim->specimen->facets;
    struct end end[2] = {0};
    struct brc_facing *facing;
    size_t n_facing;
    BRC_TRY(brc_platens_facing(sim, &facing, &n_facing));
    for (size_t i = 0; i < n_facing; i++) {
        struct end *e = &end[(size_t)facing[i].body - sim->bodies.n_grains];
        const double *normal = f->normal[facing[i].facet],
                     *n = brc_sim_platen(sim, facing[i].body)->n;
        brc_axpy(e->sum, f->area[facing[i].facet], normal);
        e->cosine = fmax(e->cosine, -brc_dot(normal, n));
        e->on += facing[i].is_on ? f->area[facing[i].facet] : 0;
    }
    free(facing);
    BRC_TRY(check_end(sim, 0, &end[0]));
    return check_end(sim, 1, &end[1]);
}

int brc_two_platens_place(struct brc_sim *sim, int axis, double sense, double section,
                          const struct brc_platen *like)
{
    brc_two_platens_face(sim, 0, axis, like);
    brc_two_platens_begin(sim, axis, sense, section);
    BRC_TRY(check_ends(sim));
    set_velocities(sim);
    return 0;
}

void brc_two_platens_field(const struct brc_sim *sim, size_t grain, double v[3])
{
    const struct brc_rig *rig = &sim->rig;
    const struct brc_platen *p = &rig->platen[0];
    int k = rig->axis;
    double middle = sim->bodies.x0[p->body][k] + 0.5 * rig->length[k] * p->n[k];
    brc_set(v, 0, 0, 0);
    v[k] = -rig->sense * rig->rate * (sim->bodies.x0[grain][k] - middle);
}

/* Over the first section, as the curve has it: where a specimen bulges, that is the larger stress,
 * and the one that laboratories report. */
void brc_two_platens_stresses(const struct brc_sim *sim, size_t row, double sigma[3])
{
    const struct brc_rig *rig = &sim->rig;
    brc_set(sigma, 0, 0, 0);
    sigma[rig->axis] = rig->sense * rig->curve.stress[row];
}

/* They differ while the specimen accelerates; curve and loading take the mean. */
double brc_two_platens_force(const struct brc_rig *rig)
{
    double mean = 0;
    for (int i = 0; i < 2; i++)
        mean += rig->sense * rig->platen[i].force / 2;
    return mean;
}

int brc_two_platens_drive(struct brc_sim *sim)
{
    return brc_two_platens_load(sim, brc_two_platens_force(&sim->rig));
}

int brc_two_platens_load(struct brc_sim *sim, double force)
{
    struct brc_rig *rig = &sim->rig;
    rig->force = force;
    rig->force_sum += force;
    rig->n_summed += 1;
    if (rig->sense > 0 && rig->strain + rig->rate * sim->dt >= PLATENS_MEET)
        BRC_FAIL(sim->ctx, BRC_ERR_BLOWUP,
                 "the platens have met at step %lld, at a strain of %g: lower test.strain_max (now "
                 "%g) or test.rate",
                 (long long)sim->step, rig->strain + rig->rate * sim->dt, rig->params.strain_max);
    brc_loading_step(sim);
    set_velocities(sim);
    return 0;
}
