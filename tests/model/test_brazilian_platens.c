/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Platens of the Brazilian test: planes, strips with rounded edges, jaws; and where its crack
 * starts, by a log of events made by hand. */
#include "tests/fixture.h"

#include <stdio.h>

static const char disc[] = "shape: cylinder; diameter: 2 cm; height: 5 mm; grains: packing; "
                           "diameter_min: 2 mm; diameter_max: 3 mm; seed: 4; cache: off";

/* Both models, elastic. */
static const struct {
    const char *name, *settings;
} models[] = {{"vgcm", "softening: none; sigma_t: 1 GPa; tau: 10 GPa"},
              {"polyhedra", "breakable: off"}};
enum { N_MODELS = 2 };
static int model;

static int disc_between(struct fixture *f, const char *test, const char *own)
{
    char text[200];
    if (!f->has_specimen)
        fixture_specimen(f, disc);
    snprintf(text, sizeof text, "kind: brazilian; loading: fixed; rate: 2e-6 1/s; %s", test);
    return fixture_try_sim(f, brc_registry_find(models[model].name), models[model].settings, text,
                           own, "");
}

/* Load of an elastic disc at a strain of 2e-3. */
static double load_between(struct fixture *f, const char *test, const char *own)
{
    CHECK_OK(&f->ctx, disc_between(f, test, own));
    fixture_steps(f, 1000);
    CHECK_BETWEEN(brc_ledger_residual(&f->sim.ledger), 0, 1e-7);
    return f->sim.rig.force;
}

/* Edges rounder than the disc is small are a plane; a jaw embraces the disc and is stiffer than a
 * plane, the more the closer its radius; one of a huge radius is a plane again. */
static void check_shapes(struct fixture *f)
{
    double plane = load_between(f, "", "");
    double round = load_between(f, "plate_width: 0.1 mm", "edge_radius: 1000 m");
    double sharp = load_between(f, "plate_width: 0.5 mm", "");
    double smooth = load_between(f, "plate_width: 0.5 mm", "edge_radius: 1 mm");
    double jaw = load_between(f, "", "platens: jaws");
    double wide = load_between(f, "", "platens: jaws; jaw_ratio: 100");
    print_message("%s: load over that of planes: rounded %.5f, strip %.3f, with edges %.3f, jaws "
                  "%.3f, wide ones %.3f\n",
                  models[model].name, round / plane, sharp / plane, smooth / plane, jaw / plane,
                  wide / plane);
    CHECK_NEAR(round, plane, 0, 1e-3);
    assert_true(sharp < plane && smooth < 0.99 * round);
    assert_true(jaw > 1.1 * wide && wide > 0.99 * plane);
    CHECK_NEAR(wide, plane, 0, 0.05);
    CHECK_OK(&f->ctx, disc_between(f, "", "platens: jaws"));
    CHECK_NEAR(f->sim.rig.platen[1].radius, 0.015, 0, 1e-12);
}

static void platens_have_their_shape(void **state)
{
    for (model = N_MODELS - 1; model >= 0; model--)
        check_shapes(*state);
    model = 0;
}

static void keys_that_do_not_go_together_are_refused(void **state)
{
    struct fixture *f = *state;
    CHECK_FAILS(&f->ctx, disc_between(f, "plate_width: 1 mm", "platens: jaws"), BRC_ERR_INPUT,
                "brazilian.platens is jaws: leave it out, or choose flat");
    CHECK_FAILS(&f->ctx, disc_between(f, "", "edge_radius: 1 mm"), BRC_ERR_INPUT,
                "has no edge to round");
}

/* A peak in the second row of four, at step 20. */
static void make_curve(struct brc_sim *sim)
{
    static const double force[] = {1, 3, 1, 0.5};
    for (size_t i = 0; i < 4; i++) {
        size_t row;
        CHECK_OK(sim->ctx, brc_rig_add_row(sim->ctx, &sim->rig, &row));
        sim->rig.curve.step[row] = 10 * (int64_t)(i + 1);
        sim->rig.curve.strain[row] = 1e-3 * (double)(i + 1);
        sim->rig.curve.force[row] = force[i];
    }
    sim->rig.force_peak = 3;
    sim->rig.strain_peak = 2e-3;
}

static void break_at(struct brc_sim *sim, int64_t step, double part_of_radius, double area)
{
    const struct brc_event event = {
        .a = 0, .b = 1, .x = {0, 0.01 * part_of_radius, 0.001}, .area = area};
    brc_events_add(sim->ctx, &sim->events, step, &event);
}

static struct brc_result crack_start(const struct fixture *f)
{
    struct brc_result all[BRC_MAX_RESULTS];
    brc_rigs_results(&f->sim, all);
    assert_string_equal(all[1].name, "crack_start");
    return all[1];
}

static void crack_start_is_that_of_the_first_part(void **state)
{
    struct fixture *f = *state;
    CHECK_OK(&f->ctx, disc_between(f, "", ""));
    make_curve(&f->sim);
    struct brc_result r = crack_start(f);
    assert_false(isfinite(r.value));
    assert_string_equal(r.note, "nothing had broken at the peak");
    /* of 100 the first 5: 2 at 0.1, 3 of the 98 at 0.6; what breaks after the peak counts nowhere
     */
    break_at(&f->sim, 5, 0.1, 2);
    break_at(&f->sim, 20, 0.6, 98);
    break_at(&f->sim, 25, 0.9, 1000);
    r = crack_start(f);
    CHECK_NEAR(r.value, 0.4, 1e-12, 0);
    assert_null(r.note);
}

static void a_crack_that_starts_outside_is_told(void **state)
{
    struct fixture *f = *state;
    CHECK_OK(&f->ctx, disc_between(f, "", ""));
    make_curve(&f->sim);
    break_at(&f->sim, 5, 0.7, 10);
    break_at(&f->sim, 6, 0.1, 90);
    struct brc_result r = crack_start(f);
    CHECK_NEAR(r.value, 0.7, 1e-12, 0);
    assert_non_null(strstr(r.note, "did not start inside half of the radius"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(platens_have_their_shape),
                                       FIXTURE_TEST(keys_that_do_not_go_together_are_refused),
                                       FIXTURE_TEST(crack_start_is_that_of_the_first_part),
                                       FIXTURE_TEST(a_crack_that_starts_outside_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
