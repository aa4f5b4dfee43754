/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of operations by which common/ knows this model, what is checked before a run, and
 * the line that a run prints. */
#include "polyhedra/poly.h"

#include "common/specimen/oblique.h"
#include "common/base/simd.h"

#include <stdio.h>
#include <stdlib.h>

#define BRC_OWNER struct poly_params
static const struct brc_param param_list[] = {BRC_PARAM_LIST(POLY_PARAMS)};
#undef BRC_OWNER

#define BRC_OWNER struct poly_contacts
static const struct brc_field contact_list[] = {
    POLY_CONTACT_FIELDS(BRC_FIELD, BRC_FIELD3, BRC_FIELD_RENAMED, BRC_FIELD3_RENAMED)};
#undef BRC_OWNER

#define BRC_OWNER struct poly_points
static const struct brc_field point_fields[] = {
    POLY_POINT_FIELDS(BRC_FIELD, BRC_FIELD3, BRC_FIELD_RENAMED)};
#undef BRC_OWNER

/* Bonds stretch along the lines of centres: where facets are oblique to these, the stiffness by
 * direction is not that of the bonds' medium. Cells and their centroids are always a little so. */
static const double GOOD_PART = 0.1;

static void warn_oblique(const struct brc_context *ctx, const struct brc_facets *f)
{
    struct brc_oblique o;
    brc_oblique_measure(&o, f, f->centre, false);
    if (o.soft < 1 - GOOD_PART || o.stiff > 1 / (1 - GOOD_PART))
        brc_log(ctx,
                "warning: facets are oblique to the lines of centres (mean cosine %.3f): under a "
                "uniform strain the bonds of polyhedra are %.3g to %.3g times as stiff as the "
                "medium that they stand for, by direction",
                o.mean_cos, o.soft, o.stiff);
}

/* What can be told from the numbers alone is refused here, before any memory is taken and any cell
 * eroded; what erosion finds out is told by erode.c. */
static int check(struct brc_context *ctx, const void *params, const struct brc_specimen *specimen)
{
    const struct poly_params *p = params;
    struct poly_scale scale;
    poly_scale_measure(&scale, &specimen->facets);
    if (p->radius >= 0.5 * scale.size) /* not where it is auto */
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "polyhedra.radius = %g m is not below half of the mean grain size (%g m): nothing "
                 "would be left of the grains; a tenth of the grain size is usual",
                 p->radius, scale.size);
    if (p->strain_length == POLY_LENGTH_CENTRES)
        warn_oblique(ctx, &specimen->facets);
    return 0;
}

static int create(struct brc_sim *sim, void **state)
{
    struct poly_params *p = sim->params;
    struct poly_scale scale;
    if (p->evaluation == POLY_LINEARISED && poly_is_viscous(sim))
        BRC_FAIL(sim->ctx, BRC_ERR_INPUT,
                 "polyhedra.evaluation = condensed goes without viscosity: set polyhedra.gn and "
                 "polyhedra.gt to 0 1/s, or run.regime to quasi_static");
    struct poly_state *st = *state = brc_alloc(sim->ctx, 1, sizeof *st);
    if (st == NULL)
        return BRC_ERR_MEMORY;
    /* Frames and sums are read in whole lanes, of a block whose parts lie on lines of the cache. */
    size_t size = (sizeof *st->batch + 63) / 64 * 64;
    st->batch = aligned_alloc(64, size);
    if (st->batch == NULL)
        BRC_FAIL(sim->ctx, BRC_ERR_MEMORY, "out of memory: %zu bytes for a batch of contacts",
                 size);
    memset(st->batch, 0, size);
    /* Asked before the value is set, for the header has to say which it was. */
    st->is_scaled = isnan(p->kn);
    poly_scale_measure(&scale, &sim->specimen->facets);
    poly_scale_params(&scale, p);
    return 0;
}

static void release(void *state)
{
    struct poly_state *st = state;
    if (st == NULL)
        return;
    poly_shapes_free(&st->shapes);
    poly_list_free(&st->list);
    brc_springs_free(&st->ahead);
    free(st->eroded);
    free(st->global_vertices);
    free(st->global_planes);
    free(st->batch);
    free(st->rotation);
    free(st);
}

/* Chosen once for a run: all instruction sets give the same bits, so that `run.simd` is for tests
 * and for measuring. AVX-512 is kept for its 32 registers, in lanes of four as elsewhere: 3 to 8 %
 * in the figures of bench_polyhedra on one machine, -2 to 29 % on another (docs/speed.md). */
static void select_kernels(struct brc_sim *sim, void *state)
{
    struct poly_state *st = state;
    static struct poly_kernels (*const kernels[BRC_N_SIMD])(const struct brc_sim *) = {
        poly_kernels_base, poly_kernels_avx2, poly_kernels_avx512};
    st->kernels = kernels[brc_simd_of(sim->run.simd)](sim);
}

/* Items are not saved: they are made anew. */
static int restore(struct brc_sim *sim, void *state)
{
    const struct poly_contacts *columns = sim->pairs.model_columns;
    const struct poly_points *points = sim->pairs.point_columns;
    (void)state;
    for (size_t p = 0; p < sim->pairs.points.n; p++)
        points->item[p][POLY_ITEM_LIST] = POLY_NO_LIST;
    memset(columns->ready, 0, sim->pairs.n * sizeof *columns->ready);
    return 0;
}

static const char *choice(const struct poly_params *p, const char *key, char *buffer, size_t size)
{
    const struct brc_param_list list = BRC_PARAMS(param_list, struct poly_params);
    return brc_params_text(brc_params_find(list, key), p, buffer, size);
}

/* Strain length, area and the rule of features change moduli by factors, so that a run without them
 * in its header could not be compared with anything. */
static void describe(const struct brc_sim *sim, const void *state, char *text, size_t size)
{
    const struct poly_params *p = poly_params_of(sim);
    const struct poly_state *st = state;
    char features[32], area[32], length[32];
    const struct brc_facets *f = &sim->specimen->facets;
    struct brc_oblique oblique;
    brc_oblique_measure(&oblique, f, f->centre, false);
    double stiff = st->n_bonds > 0 ? st->mean_area / st->mean_length : 0;
    snprintf(
        text, size,
        "Bonded spheropolyhedra: features %s, bond area %s, strain length %s, torsion %s, "
        "%zu bonds of mean area %.4g m2 and mean strain length %.4g m (stiffness %.4g N/m in "
        "tension, against K_n = %.4g N/m of a feature contact%s, with K_t = %.4g N/m); erosion by "
        "R = %.4g m removes %zu of "
        "the inner facets on a side%s; mean cosine of facet normals and lines of centres %.4f.",
        choice(p, "features", features, sizeof features), choice(p, "area", area, sizeof area),
        choice(p, "strain_length", length, sizeof length), p->torsion ? "on" : "off", st->n_bonds,
        st->mean_area, st->mean_length, p->bn * stiff, p->kn,
        st->is_scaled ? ", by kn_modulus" : "", p->kt, p->radius, st->n_removed,
        st->n_removed == 0            ? ""
        : p->area == POLY_AREA_ERODED ? ": they have no bond"
                                      : ": they are bonded by their own area",
        oblique.mean_cos);
}

/* Move a number when what it stands for computes otherwise; tests/cli/test_physics.sh watches. */
static const struct brc_physics physics[] = {{"polyhedra", 2, NULL},
                                             {"features closed", 2, "features=closed"},
                                             {"features strict", 1, "features=strict"},
                                             {"features merged", 1, "features=merged"},
                                             {"condensed", 1, "evaluation=auto|condensed"},
                                             {NULL, 0, NULL}};

/* Contacts with platens have no tangents, sleepers or feature pairs: the fields that are for these
 * are not saved there (no_platens), by their names in files. There is no after_break: a broken bond
 * needs no new list, since collision acts between bonded grains, too. */
const struct brc_model brc_model_polyhedra = {
    .name = "polyhedra",
    .citation = "S.A. Galindo-Torres, D.M. Pedroso, D.J. Williams, L. Li: Breaking processes in "
                "three-dimensional bonded granular materials with general shapes. Computer Physics "
                "Communications 183 (2012) 266-277",
    .params = BRC_PARAMS(param_list, struct poly_params),
    .physics = physics,
    .contact_fields = BRC_FIELDSET(contact_list, struct poly_contacts),
    .point_fields = BRC_FIELDSET(point_fields, struct poly_points),
    .point_lanes = BRC_LANES,
    .flags = BRC_MODEL_ROTATES | BRC_MODEL_ORIENTED,
    .no_platens = "room awake carried shift held tangent kind j near sleep",
    .shape = poly_shape,
    .bond = poly_open_bonds,
    .pairs = poly_update_contacts,
    .forces = poly_forces,
    .platens = poly_platens,
    .energy = poly_energy,
    .springs = poly_springs,
    .check = check,
    .create = create,
    .free = release,
    .select = select_kernels,
    .restore = restore,
    .describe = describe,
};
