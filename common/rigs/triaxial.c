/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Conventional triaxial test: a pressure on the sides, two platens along z. First the platens come
 * nearer and the pressure follows their stress, so that the stress is isotropic, with no servo that
 * would have to be tuned; then the pressure stays and the platens go on. Load and stress of the
 * curve are the deviator, what the platens push with beyond the pressure: moduli, peak and end are
 * those of compression, which this test is, to round-off, without a pressure. */
#include "common/engine/sim.h"
#include "common/rigs/crack_stress.h"
#include "common/rigs/pressure.h"
#include "common/rigs/two_platens.h"

#include <math.h>

#define TRIAXIAL_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3) \
    REAL(pressure, "Pa", "10 MPa", "[0, inf)",                      \
         "on the sides; reached by an isotropic ramp, before the load along z grows on")

struct triaxial_params {
    BRC_PARAM_MEMBERS(TRIAXIAL_PARAMS)
};
#define BRC_OWNER struct triaxial_params
static const struct brc_param triaxial_params[] = {BRC_PARAM_LIST(TRIAXIAL_PARAMS)};
#undef BRC_OWNER

#define TRIAXIAL_STATE(SCALAR, VECTOR)                                     \
    SCALAR(double, pressure, BRC_STATE, "Pa", "pressure on the sides now") \
    SCALAR(double, pressure_sum, BRC_STATE, "Pa", "sum of it since the last row of the curve")
#define BRC_OWNER struct triaxial
struct triaxial {
    TRIAXIAL_STATE(BRC_COLUMN, BRC_COLUMN3)
};
static const struct brc_field triaxial_state[] = {TRIAXIAL_STATE(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

#define TRIAXIAL_COLUMNS(SCALAR, VECTOR)                                                \
    SCALAR(double, sigma_1, BRC_STATE, "Pa", "stress along z")                          \
    SCALAR(double, sigma_3, BRC_STATE, "Pa", "pressure on the sides")                   \
    SCALAR(double, eps_v, BRC_STATE, "1", "volume strain by the gauges, compression +") \
    SCALAR(double, area_lost, BRC_STATE, "1", "part of the sides whose grains have left")
#define BRC_OWNER struct columns
struct columns {
    TRIAXIAL_COLUMNS(BRC_COLUMN, BRC_COLUMN3)
};
static const struct brc_field triaxial_columns[] = {TRIAXIAL_COLUMNS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

static const struct brc_quantity quantities[] = {
    BRC_COMPRESSION_QUANTITIES,
    {"area_lost", "1", "part of the sides whose grains have left, so that no pressure acts there"}};
enum { N_QUANTITIES = sizeof quantities / sizeof quantities[0] };

static double pressure_asked(const struct brc_sim *sim)
{
    return ((const struct triaxial_params *)sim->rig.own)->pressure;
}

/* Without a pressure there are no sides to follow, and the test is compression to round-off. */
static int place(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    const struct brc_platen like = {.friction = rig->params.friction};
    BRC_TRY(brc_two_platens_place(sim, 2, 1, brc_two_platens_section(sim, 2), &like));
    if (pressure_asked(sim) == 0)
        return 0;
    struct brc_pressure *sides;
    BRC_TRY(brc_pressure_create(sim, &sides));
    rig->memory = sides;
    return 0;
}

static bool is_ramp(const struct brc_sim *sim)
{
    return sim->rig.stage == 0 && pressure_asked(sim) > 0;
}

/* The pressure is the platens' stress until that has reached what was asked. A Poisson's ratio
 * below 0.5 makes it stable: pressure that is too high raises the stress along z by less than
 * itself. It never falls back, as the stress along z shakes while the first load comes on. */
static double follow(const struct brc_sim *sim, double pressure, double stress)
{
    return fmin(fmax(stress, pressure), pressure_asked(sim));
}

/* A new stage changes velocities, so it begins when the work of those before has been booked. */
static int drive(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    struct triaxial *t = rig->own_scalars;
    double force = brc_two_platens_force(rig);
    if (is_ramp(sim))
        t->pressure[0] = follow(sim, t->pressure[0], force / rig->section);
    if (rig->memory)
        brc_pressure_apply(sim, rig->memory, t->pressure[0]);
    if (is_ramp(sim) && t->pressure[0] == pressure_asked(sim))
        brc_loading_begin_stage(sim, 1);
    t->pressure_sum[0] += t->pressure[0];
    return brc_two_platens_load(sim, force - t->pressure[0] * rig->section);
}

/* A row holds means over its steps, and so does the pressure beside it: in the ramp the two differ
 * from step to step, and a row of one and a value of the other would not sum to sigma_1. */
static int measure(struct brc_sim *sim)
{
    struct brc_rig *rig = &sim->rig;
    const struct brc_curve *c = &rig->curve;
    struct columns *own = c->own_columns;
    struct triaxial *t = rig->own_scalars;
    double steps = (double)rig->n_summed;
    size_t row = c->table.n;
    BRC_TRY(brc_curve_sample(sim));
    if (c->table.n == row)
        return 0;
    own->sigma_3[row] = t->pressure_sum[0] / steps;
    own->sigma_1[row] = c->stress[row] + own->sigma_3[row];
    own->eps_v[row] = c->strain_axial[row] + 2 * c->strain_lateral[row];
    own->area_lost[row] = rig->memory ? brc_pressure_lost(sim, rig->memory) : 0;
    t->pressure_sum[0] = 0;
    return 0;
}

static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    const struct brc_rig *rig = &sim->rig;
    brc_compression_results(sim, out);
    out[BRC_N_COMPRESSION_RESULTS] =
        (struct brc_measured){rig->memory ? brc_pressure_lost(sim, rig->memory) : 0, NULL};
}

/* The pressure acts on the sides as they are now, the platens' stress is over the first section: a
 * specimen that bulges has less along z than this says, by its strain across. */
static void stresses(const struct brc_sim *sim, size_t row, double sigma[3])
{
    const struct columns *c = sim->rig.curve.own_columns;
    sigma[0] = sigma[1] = c->sigma_3[row];
    sigma[2] = c->sigma_1[row];
}

/* Isotropic while the pressure is raised, and that of compression afterwards. */
static void field(const struct brc_sim *sim, size_t grain, double v[3])
{
    const struct brc_rig *rig = &sim->rig;
    brc_two_platens_field(sim, grain, v);
    for (int k = 0; k < 2 && is_ramp(sim); k++)
        v[k] = -rig->rate * (sim->bodies.x0[grain][k] - sim->bodies.x0[rig->platen[0].body][k]);
}

/* The ramp has no end of its own: the strain along z that it takes is none of the test's. */
static const char *end(const struct brc_sim *sim)
{
    return is_ramp(sim) ? NULL : brc_loading_end(sim);
}

/* The surface is made anew from the places of the grains; of its history only the pressure counts,
 * by which the next step books the work. */
static void restore(struct brc_sim *sim)
{
    const struct triaxial *t = sim->rig.own_scalars;
    if (sim->rig.memory)
        brc_pressure_restore(sim, sim->rig.memory, t->pressure[0]);
}

const struct brc_rig_type brc_rig_triaxial = {
    .name = "triaxial",
    .meaning = "compression along z under a pressure on the sides",
    .physics = 1,
    .keys = BRC_LOADING_KEYS BRC_CURVE_KEYS BRC_MODULI_KEYS "friction",
    .params = BRC_PARAMS(triaxial_params, struct triaxial_params),
    .state = BRC_FIELDSET(triaxial_state, struct triaxial),
    .columns = BRC_FIELDSET(triaxial_columns, struct columns),
    .quantities = quantities,
    .n_quantities = N_QUANTITIES,
    .n_platens = 2,
    .sides = BRC_CORE_SIDES,
    .has_sides = true,
    .view = &brc_curve_deviator_view,
    .check = brc_two_platens_check_closing,
    .place = place,
    .drive = drive,
    .measure = measure,
    .results = results,
    .stresses = stresses,
    .field = field,
    .end = end,
    .restore = restore,
    .free = brc_pressure_free};
