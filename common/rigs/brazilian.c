/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Brazilian test: a disc, its axis along z, between two platens along y, whole or of a width. */
#include "common/engine/sim.h"
#include "common/rigs/two_platens.h"

#include <math.h>

static const struct brc_quantity quantities[] = {
    {"S", "Pa",
     "stiffness of the disc: force per thickness at half the strain of the peak, over it"},
    BRC_PEAK_QUANTITIES};

static double thickness(const struct brc_sim *sim)
{
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    return high[2] - low[2];
}

/* Area that makes the load the tensile stress in the middle of an elastic disc. The diameter is
 * that of the case where it is a cylinder, as the polygon that stands for it is narrower. */
static double section(const struct brc_sim *sim)
{
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    const struct brc_specimen_params *s = &sim->specimen->params;
    double diameter = s->shape == BRC_SHAPE_CYLINDER ? s->diameter : high[1] - low[1];
    return BRC_PI * diameter * thickness(sim) / 2; /* eq:gt12:16 */
}

static int place(struct brc_sim *sim)
{
    const struct brc_test_params *test = &sim->rig.params;
    bool is_strip = test->plate_width > 0;
    const struct brc_platen like = {.surface = is_strip ? BRC_SURFACE_STRIP : BRC_SURFACE_PLANE,
                                    .half_width = test->plate_width / 2,
                                    .friction = test->friction};
    return brc_two_platens_place(sim, 1, 1, section(sim), &like);
}

/* Primary slope: force per thickness at half the strain of the peak, over that strain. */
static double primary_slope(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    double half = rig->strain_peak / 2;
    size_t i = 0;
    while (rig->curve.strain[i] < half)
        i++;
    return 2 * rig->curve.force[i] / (2 * half * thickness(sim)); /* eq:gt12:17 */
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    const char *note = brc_curve_why_no_peak(&sim->rig);
    out[0] = (struct brc_measured){note ? NAN : primary_slope(sim), note};
    brc_curve_peak_results(sim, out + 1);
}

static const struct brc_rig_view view = {.is_from_above = true,
                                         .strain = "strain",
                                         .strain_label = "platen strain",
                                         .stress_label = "nominal tensile stress 2F/(\u03c0DT)"};

const struct brc_rig_type brc_rig_brazilian = {.name = "brazilian",
                                               .meaning = "Brazilian test of a disc along y",
                                               .keys = BRC_LOADING_KEYS BRC_CURVE_KEYS
                                               "friction plate_width",
                                               .quantities = quantities,
                                               .n_quantities = 1 + BRC_N_PEAK_RESULTS,
                                               .results = results,
                                               BRC_TWO_PLATENS,
                                               .view = &view,
                                               .check = brc_two_platens_check_closing,
                                               .place = place};
