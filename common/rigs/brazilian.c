/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Brazilian test: a disc, its axis along z, between two platens along y: planes, whole or of a
 * width, or hollow jaws. */
#include "common/engine/sim.h"
#include "common/rigs/end_face.h"
#include "common/rigs/two_platens.h"

#include <math.h>

/* The jaws of the ISRM have 1.5 times the radius of the disc. */
#define BRAZILIAN_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                          \
    CHOICE(platens, "flat|jaws", "flat", "planes, or hollow cylinders about the disc (ISRM)") \
    REAL(edge_radius, "m", "0 m", "[0, inf)",                                                 \
         "of the rounded edges beyond test.plate_width; 0: sharp", "platens=flat")            \
    REAL(jaw_ratio, "1", "1.5", "(1, 100]", "radius of the jaws over that of the disc",       \
         "platens=jaws")

struct brazilian_params {
    BRC_PARAM_MEMBERS(BRAZILIAN_PARAMS)
};

#define BRC_OWNER struct brazilian_params
static const struct brc_param brazilian_params[] = {BRC_PARAM_LIST(BRAZILIAN_PARAMS)};
#undef BRC_OWNER

enum { PLATENS_FLAT, PLATENS_JAWS };
enum { N_RESULTS = 2 + BRC_N_PEAK_RESULTS };
static const struct brc_quantity quantities[N_RESULTS] = {
    {"S", "Pa",
     "stiffness of the disc: force per thickness at half the strain of the peak, over it"},
    {"crack_start", "1",
     "where the first 5 % of the area broken at the peak lie: mean distance from the axis, over "
     "the radius"},
    BRC_PEAK_QUANTITIES};

static double thickness(const struct brc_sim *sim)
{
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    return high[2] - low[2];
}

/* That of the case where the disc is a cylinder, as the polygon that stands for it is narrower. */
static double diameter(const struct brc_sim *sim)
{
    double low[3], high[3];
    brc_specimen_extent(sim->specimen, low, high);
    const struct brc_specimen_params *s = &sim->specimen->params;
    return s->shape == BRC_SHAPE_CYLINDER ? s->diameter : high[1] - low[1];
}

/* Area that makes the load the tensile stress in the middle of an elastic disc. */
static double section(const struct brc_sim *sim)
{
    return BRC_PI * diameter(sim) * thickness(sim) / 2; /* eq:gt12:16 */
}

static int check(struct brc_context *ctx, const struct brc_test_params *test, const void *own)
{
    const struct brazilian_params *p = own;
    if (p->platens == PLATENS_JAWS && test->plate_width > 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "test.plate_width = %g m is that of flat platens, but brazilian.platens is jaws: "
                 "leave it out, or choose flat",
                 test->plate_width);
    if (p->edge_radius > 0 && test->plate_width == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "brazilian.edge_radius = %g m has no edge to round, as the platens are without "
                 "end: give test.plate_width",
                 p->edge_radius);
    return brc_two_platens_check_closing(ctx, test, own);
}

/* Part of a circle's area by which that of a disc may be off: a polygon of 12 sides is by 2 %. */
static const double ROUND = 0.05;
/* Part of the section by which flat faces may be off it, where their normals are z. */
static const double PRISM = 0.01;

/* Eq 16 holds for discs, and between strips for other prisms, too: cubes are split so (EN 12390-6).
 */
static int check_shape(struct brc_sim *sim)
{
    double low[3], high[3], mean = brc_two_platens_section(sim, 2);
    struct brc_end_face face[2];
    brc_specimen_extent(sim->specimen, low, high);
    for (int k = 0; k < 2; k++)
        brc_end_face_measure(sim->specimen, brc_end_of(sim->specimen, 2, k == 1), 1, &face[k]);
    if (!(fabs(face[0].area - mean) < PRISM * mean && fabs(face[1].area - mean) < PRISM * mean))
        BRC_FAIL(sim->ctx, BRC_ERR_GEOMETRY,
                 "a Brazilian test needs a disc, or a prism, with flat faces across z, each of "
                 "volume over thickness (%.3g m2) to %g: they have %.3g and %.3g m2; use another "
                 "specimen, or turn it",
                 mean, PRISM, face[0].area, face[1].area);
    double circle = BRC_PI / 4 * diameter(sim) * diameter(sim), wide = high[0] - low[0];
    bool is_round = fabs(mean / circle - 1) < ROUND && fabs(wide / diameter(sim) - 1) < ROUND;
    if (is_round || sim->rig.params.plate_width > 0)
        return 0;
    BRC_FAIL(sim->ctx, BRC_ERR_GEOMETRY,
             "a Brazilian test between %s needs a disc along z: the section is %.3g of the circle "
             "as high as the specimen, which is %.3g m wide and %.3g m high; use a disc, or split "
             "this prism between strips: test.plate_width: %.2g m",
             ((const struct brazilian_params *)sim->rig.own)->platens == PLATENS_JAWS ? "jaws"
                                                                                      : "planes",
             mean / circle, wide, diameter(sim), 0.1 * diameter(sim));
}

static int place(struct brc_sim *sim)
{
    const struct brc_test_params *test = &sim->rig.params;
    const struct brazilian_params *p = sim->rig.own;
    BRC_TRY(check_shape(sim));
    struct brc_platen like = {.surface = BRC_SURFACE_PLANE, .friction = test->friction};
    if (p->platens == PLATENS_JAWS) {
        like.surface = BRC_SURFACE_CYLINDER;
        like.radius = p->jaw_ratio * diameter(sim) / 2;
    } else if (test->plate_width > 0) {
        like.surface = BRC_SURFACE_STRIP;
        like.half_width = test->plate_width / 2;
        like.edge_radius = p->edge_radius;
    }
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

/* The formula of the strength holds for a crack that begins in the middle, where the stress is that
 * of eq 16: one that begins under a platen tells of the platen. */
static const double VALID = 0.5, FIRST = 0.05;

/* In the order of the log, the last event with the part that is still wanted: so a single large
 * bond counts as much as it should. */
static double mean_distance(const struct brc_sim *sim, double wanted)
{
    const struct brc_events *e = &sim->events;
    double low[3], high[3], sum = 0, left = wanted;
    brc_specimen_extent(sim->specimen, low, high);
    for (size_t i = 0; i < e->table.n && left > 0; i++) {
        double area = fmin(e->area[i], left);
        double x = e->x[i][0] - 0.5 * (low[0] + high[0]), y = e->x[i][1] - 0.5 * (low[1] + high[1]);
        sum += area * sqrt(x * x + y * y);
        left -= area;
    }
    return sum / wanted;
}

static struct brc_measured crack_start(const struct brc_sim *sim)
{
    static const char whole[] = "nothing had broken at the peak";
    static const char outside[] =
        "the crack did not start inside half of the radius, where a Brazilian test is valid";
    const struct brc_events *e = &sim->events;
    int64_t peak = sim->rig.curve.step[brc_curve_peak_row(&sim->rig)];
    double area = 0;
    for (size_t i = 0; i < e->table.n && e->step[i] <= peak; i++)
        area += e->area[i];
    if (area == 0)
        return (struct brc_measured){NAN, whole};
    double part = mean_distance(sim, FIRST * area) / (diameter(sim) / 2);
    return (struct brc_measured){part, part < VALID ? NULL : outside};
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    const char *note = brc_curve_why_no_peak(&sim->rig);
    out[0] = (struct brc_measured){note ? NAN : primary_slope(sim), note};
    out[1] = note ? out[0] : crack_start(sim);
    brc_curve_peak_results(sim, out + 2);
}

static const struct brc_rig_view view = {.is_from_above = true,
                                         .strain = "strain",
                                         .strain_label = "platen strain",
                                         .stress_label = "nominal tensile stress 2F/(\u03c0DT)"};

const struct brc_rig_type brc_rig_brazilian = {
    .name = "brazilian",
    .meaning = "Brazilian test of a disc along y",
    .physics = 1,
    .keys = BRC_LOADING_KEYS BRC_CURVE_KEYS "friction plate_width",
    .params = BRC_PARAMS(brazilian_params, struct brazilian_params),
    .quantities = quantities,
    .n_quantities = N_RESULTS,
    .results = results,
    BRC_TWO_PLATENS,
    .view = &view,
    .check = check,
    .place = place};
