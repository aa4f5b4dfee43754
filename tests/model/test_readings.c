/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is read off every test: acoustic events, fragments, the work up to the peak. */
#include "common/rigs/acoustic.h"
#include "common/rigs/readings.h"
#include "common/rigs/sieve.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>

static const char weak[] = "interaction: all; sigma_t: 1 MPa; tau: 8 MPa; softening: none",
                  pull[] = "kind: tension; loading: fixed; rate: 1e-6 1/s; strain_max: 3e-4; "
                           "stop_drop: 0.2";

static double reading(const struct fixture *f, const char *name, const char **note)
{
    struct brc_measured out[BRC_N_READINGS];
    brc_readings(&f->sim, out);
    for (int i = 0; i < BRC_N_READINGS; i++)
        if (strcmp(brc_readings_quantities[i].name, name) == 0) {
            assert_true(isfinite(out[i].value) == !out[i].note);
            *note = out[i].note ? out[i].note : "";
            return out[i].value;
        }
    fail_msg("no reading %s", name);
    return 0;
}

/* ---- clusters ------------------------------------------------------------------------------ */

/* The naive twin: all pairs, until nothing changes; numbers by first members. */
static void cluster_all(const int64_t *step, double (*x)[3], int n, int64_t steps, double reach,
                        int32_t *of)
{
    for (int i = 0; i < n; i++)
        of[i] = i;
    for (bool is_changed = true; is_changed;) {
        is_changed = false;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < i; j++)
                if (step[i] - step[j] <= steps && brc_distance(x[i], x[j]) <= reach &&
                    of[i] != of[j]) {
                    of[i] = of[j] = of[i] < of[j] ? of[i] : of[j];
                    is_changed = true;
                }
    }
}

static void clusters_are_those_of_all_pairs(void **state)
{
    enum { N = 300 };
    struct fixture *f = *state;
    int64_t step[N];
    double x[N][3];
    int32_t of[N], naive[N];
    for (int trial = 0; trial < 60; trial++) {
        size_t n_events, n_naive = 0;
        for (int i = 0; i < N; i++) {
            step[i] = i == 0 ? 0 : step[i - 1] + (int64_t)(2 * fabs(fixture_draw(f)));
            for (int k = 0; k < 3; k++)
                x[i][k] = 1 + 0.2 * (trial % 12) * fixture_draw(f);
        }
        x[N / 2][0] = -1e6; /* one has flown away */
        CHECK_OK(&f->ctx,
                 brc_acoustic_cluster(&f->ctx, step, x, N, trial / 12, 0.3, of, &n_events));
        cluster_all(step, x, N, trial / 12, 0.3, naive);
        for (int i = 0; i < N; i++) {
            n_naive += naive[i] == i;
            for (int j = 0; j < i; j++)
                assert_int_equal(of[i] == of[j], naive[i] == naive[j]);
            assert_true(of[i] >= 0 && (size_t)of[i] < n_events);
            assert_true(naive[i] != i || of[i] == (int32_t)n_naive - 1); /* numbered by firsts */
        }
        assert_int_equal(n_events, n_naive);
    }
}

/* ---- moments ------------------------------------------------------------------------------- */

static void r_tells_bursts_from_shear(void **state)
{
    (void)state;
    const double burst[] = {2, 2, 2, 0, 0, 0}, fall[] = {-1, -1, -1, 0, 0, 0},
                 shear[] = {0, 0, 0, 0, 3, 0}, opening[] = {0, 0, 5, 0, 0, 0},
                 turned[] = {2.5, 2.5, 0, 0, 0, 2.5}, none[6] = {0}, unknown[6] = {NAN};
    CHECK_NEAR(brc_acoustic_r(burst), 100, 0, 1e-12);
    CHECK_NEAR(brc_acoustic_r(fall), -100, 0, 1e-12);
    CHECK_NEAR(brc_acoustic_r(shear), 0, 1e-10, 0);
    CHECK_NEAR(brc_acoustic_r(opening), 300.0 / 7, 0, 1e-12);
    CHECK_NEAR(brc_acoustic_r(turned), 300.0 / 7, 0, 1e-12);
    assert_true(isnan(brc_acoustic_r(none)) && isnan(brc_acoustic_r(unknown)));
}

static void add(struct fixture *f, int64_t step, size_t row, enum brc_mode mode, double energy)
{
    struct brc_contacts *c = &f->sim.pairs;
    const struct brc_facets *facets = &f->specimen.facets;
    struct brc_event event = {.a = c->a[row],
                              .b = c->b[row],
                              .facet = c->facet[row],
                              .mode = mode,
                              .area = facets->area[c->facet[row]],
                              .energy = energy};
    brc_copy(event.x, facets->centroid[c->facet[row]]);
    brc_copy(event.n, facets->normal[c->facet[row]]);
    brc_sub(event.branch, f->sim.bodies.x[event.b], f->sim.bodies.x[event.a]);
    double up = event.branch[2] > 0 ? 1 : -1; /* what pulls b back, or has held it from slipping */
    brc_set(event.force, mode == BRC_MODE_SHEAR ? -8e6 * event.area * up : 0, 0,
            mode == BRC_MODE_TENSION ? -1e6 * event.area * up : 0);
    c->status[row] = BRC_BROKEN;
    brc_events_add(&f->ctx, &f->sim.events, step, &event);
}

/* Rows whose facet is normal to z, at the lower or the upper one of two such layers. */
static bool is_between(const struct fixture *f, size_t row, double z)
{
    const struct brc_facets *facets = &f->specimen.facets;
    int32_t facet = f->sim.pairs.facet[row];
    return fabs(facets->normal[facet][2]) > 0.9 && fabs(facets->centroid[facet][2] - z) < 1e-6;
}

static double layer(const struct fixture *f, int i)
{
    double low[3], high[3];
    brc_specimen_extent(&f->specimen, low, high);
    return low[2] + 0.01 * i;
}

/* A layer of facets that opens in one step, and one in shear later on: strength times area times
 * distance of the centres. */
static void breaks_near_in_time_are_one_event(void **state)
{
    struct fixture *f = *state;
    struct brc_acoustic a;
    const double area = 1e-4, edge = 0.01;
    fixture_grid(f, 2, 2, 3, edge, 0);
    fixture_sim(f, brc_registry_find("vgcm"), weak, pull, "");
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        if (is_between(f, i, layer(f, 1)))
            add(f, 100 + (int64_t)i % 2, i, BRC_MODE_TENSION, 0.25e-3);
    size_t first = f->sim.events.table.n;
    assert_int_equal(first, 4);
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        if (is_between(f, i, layer(f, 2)))
            add(f, 150, i, BRC_MODE_SHEAR, 1e-6);
    CHECK_OK(&f->ctx, brc_acoustic_find(&f->sim, &a));
    assert_int_equal(a.table.n, 2);
    assert_int_equal(a.first_step[0], 100);
    assert_int_equal(a.last_step[0], 101);
    assert_int_equal(a.breaks[0], 4);
    assert_int_equal(a.tension[0], 4);
    assert_int_equal(a.tension[1], 0);
    CHECK_NEAR(a.area[0], 4 * area, 0, 1e-9);
    CHECK_NEAR(a.energy[0], 1e-3, 0, 1e-12);
    CHECK_NEAR(a.magnitude[0], -2 - 3.2, 0, 1e-12);
    CHECK_NEAR(a.x[0][2], layer(f, 1), 1e-9, 0);
    const double open[6] = {0, 0, 1e6 * 4 * area * edge, 0, 0, 0};
    const double slip[6] = {0, 0, 0, 0, 0.5 * 8e6 * 4 * area * edge, 0};
    CHECK_NEAR_ARRAY(a.moment[0], open, 6, 1e-9, 1e-9);
    CHECK_NEAR_ARRAY(a.moment[1], slip, 6, 1e-9, 1e-9);
    CHECK_NEAR(a.scalar_moment[1], 16, 0, 1e-9);
    CHECK_NEAR(a.r[0], 300.0 / 7, 0, 1e-9);
    CHECK_NEAR(a.r[1], 0, 1e-7, 0);
    brc_acoustic_free(&a);
}

/* The keys of the case: how far apart in steps, and in grain radii. */
static void the_window_is_that_of_the_case(void **state)
{
    static const struct window {
        const char *test;
        size_t n_events;
    } windows[] = {{"", 2},
                   {"; acoustic_steps: 60", 1},
                   {"; acoustic_steps: 0", 3},
                   {"; acoustic_radii: 0.1", 8}};
    struct fixture *f = *state;
    for (int k = 0; k < 4; k++) {
        struct brc_acoustic a;
        char test[256];
        snprintf(test, sizeof test, "%s%s", pull, windows[k].test);
        fixture_grid(f, 2, 2, 3, 0.01, 0);
        fixture_sim(f, brc_registry_find("vgcm"), weak, test, "");
        for (int side = 1; side < 3; side++)
            for (size_t i = 0; i < f->sim.pairs.n; i++)
                if (is_between(f, i, layer(f, side)))
                    add(f, side == 1 ? 100 + (int64_t)(f->sim.events.table.n > 1) : 150, i,
                        BRC_MODE_TENSION, 1e-6);
        CHECK_OK(&f->ctx, brc_acoustic_find(&f->sim, &a));
        assert_int_equal(a.table.n, windows[k].n_events);
        brc_acoustic_free(&a);
    }
}

/* ---- principal stresses -------------------------------------------------------------------- */

/* A curve made by hand: a peak of 8 N and what follows it. */
static void add_rows(struct fixture *f, int n, double first, double last)
{
    for (int i = 0; i < n; i++) {
        size_t row;
        struct brc_rig *rig = &f->sim.rig;
        CHECK_OK(&f->ctx, brc_rig_add_row(&f->ctx, rig, &row));
        rig->curve.force[row] = first + (last - first) * i / (n - 1);
        rig->curve.stress[row] = rig->curve.force[row] / rig->section;
        rig->force_peak = fmax(rig->force_peak, rig->curve.force[row]);
    }
}

static void principal_stresses(void **state)
{
    struct fixture *f = *state;
    const char *note;
    fixture_grid(f, 2, 2, 3, 0.01, 0);
    fixture_sim(f, brc_registry_find("vgcm"), weak, pull, "");
    double per_force = 1 / f->sim.rig.section;
    add_rows(f, 9, 0, 8);
    reading(f, "sigma_3", &note);
    assert_non_null(strstr(note, "no peak"));
    add_rows(f, 40, 8, 3);
    CHECK_NEAR(reading(f, "sigma_1", &note), 0, 0, 0);
    CHECK_NEAR(reading(f, "sigma_3", &note), -8 * per_force, 0, 1e-12); /* it pulls */
    reading(f, "sigma_3_residual", &note);
    assert_non_null(strstr(note, "still changing"));
    add_rows(f, 40, 2, 2.2);
    CHECK_NEAR(reading(f, "sigma_3_residual", &note), -2.15 * per_force, 0, 0.02);
    CHECK_NEAR(reading(f, "sigma_1_residual", &note), 0, 0, 0);
    fixture_sim(f, brc_registry_find("vgcm"), weak, "kind: none", "");
    reading(f, "sigma_1", &note);
    assert_non_null(strstr(note, "not uniform"));
}

/* ---- fragments ----------------------------------------------------------------------------- */

static void a_sieve_sorts_fragments(void **state)
{
    struct fixture *f = *state;
    struct brc_sieve s;
    const char *note;
    fixture_grid(f, 2, 2, 3, 0.01, 0);
    fixture_sim(f, brc_registry_find("polyhedra"), "", pull, "");
    CHECK_NEAR(reading(f, "largest_piece", &note), 1, 0, 1e-12);
    CHECK_NEAR(reading(f, "n_pieces", &note), 1, 0, 0);
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        if (is_between(f, i, layer(f, 1)))
            f->sim.pairs.status[i] = BRC_BROKEN;
    int32_t lone = f->sim.pairs.a[0];
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        if (f->sim.pairs.a[i] == lone || f->sim.pairs.b[i] == lone)
            f->sim.pairs.status[i] = BRC_BROKEN;
    CHECK_OK(&f->ctx, brc_sieve_make(&f->sim, &s));
    assert_int_equal(s.table.n, 3);
    assert_int_equal(s.n_pieces, 2);
    assert_int_equal(s.grains[2], 1);
    assert_int_equal(s.grains[0] + s.grains[1], 11);
    CHECK_NEAR(s.diameter[0], cbrt(6 * (double)s.grains[0] * 1e-6 / BRC_PI), 0, 1e-9);
    CHECK_NEAR(s.passing[0], 1, 0, 1e-12);
    CHECK_NEAR(s.passing[1], 1 - (double)s.grains[0] / 12, 0, 1e-6);
    CHECK_NEAR(s.passing[2], 1.0 / 12, 0, 1e-6);
    CHECK_NEAR(reading(f, "largest_piece", &note), (double)s.grains[0] / 12, 0, 1e-6);
    CHECK_NEAR(reading(f, "n_pieces", &note), 2, 0, 0);
    brc_sieve_free(&s);
}

/* ---- readings ------------------------------------------------------------------------------ */

/* The work by rows against the ledger's, which is kept for the present step alone. */
static void work_at_the_peak_is_that_of_the_ledger(void **state)
{
    enum { MOST_ROWS = 1000 };
    struct fixture *f = *state;
    double boundary[MOST_ROWS] = {0}, energy = 0; /* at the last step before row i was there */
    const char *note;
    fixture_grid(f, 3, 3, 6, 0.01, 0.7);
    fixture_sim(f, brc_registry_find("vgcm"), weak, pull, "");
    reading(f, "work_at_peak", &note);
    assert_non_null(strstr(note, "no row"));
    while (!brc_rigs_done(&f->sim)) {
        fixture_steps(f, 1);
        size_t n = f->sim.rig.curve.table.n;
        assert_true(n < MOST_ROWS);
        boundary[n] = f->sim.ledger.boundary;
    }
    size_t row = brc_curve_peak_row(&f->sim.rig);
    assert_true(row > 0);
    /* the row holds means over its steps: their middle */
    double middle = 0.5 * (boundary[row - 1] + boundary[row]);
    print_message("work %g by rows, %g by the ledger\n", reading(f, "work_at_peak", &note), middle);
    CHECK_NEAR(reading(f, "work_at_peak", &note), middle, 0, 0.05);
    const struct brc_events *e = &f->sim.events;
    for (size_t i = 0; i < e->table.n && e->step[i] <= f->sim.rig.curve.step[row]; i++)
        energy += e->energy[i];
    CHECK_NEAR(reading(f, "break_energy_at_peak", &note), energy, 0, 1e-12);
    assert_true(energy < f->sim.ledger.damage * (1 + 1e-9));
}

/* Of a curve made by hand, as those of tests have what they have. */
static void the_shape_of_a_curve_is_read(void **state)
{
    static const double force[] = {1, 4, 3.7, 3.2, 6, 10, 9, 4};
    struct fixture *f = *state;
    struct brc_rig *rig = &f->sim.rig;
    const char *note;
    fixture_grid(f, 3, 3, 6, 0.01, 0.7);
    fixture_sim(f, brc_registry_find("vgcm"), weak, pull, "");
    while (!brc_rigs_done(&f->sim))
        fixture_steps(f, 1);
    size_t n = sizeof force / sizeof force[0];
    assert_true(rig->curve.table.n > n);
    rig->curve.table.n = n;
    for (size_t i = 0; i < n; i++) {
        rig->curve.force[i] = force[i];
        rig->curve.strain[i] = 0.001 * (double)(i + 1);
    }
    rig->force_peak = 10;
    rig->strain_peak = 0.006;
    CHECK_NEAR(reading(f, "drop_before_peak", &note), 0.08, 0, 1e-12);
    CHECK_NEAR(reading(f, "strain_at_end", &note), 0.008, 0, 1e-12);
    CHECK_NEAR(reading(f, "load_at_end", &note), 0.4, 0, 1e-12);
}

/* What cannot be read says why; without a break there are no cracks. */
static void without_breaks_there_are_no_cracks(void **state)
{
    struct fixture *f = *state;
    const char *note;
    fixture_grid(f, 2, 2, 3, 0.01, 0);
    fixture_sim(f, brc_registry_find("vgcm"), weak, pull, "");
    const char *const cracks[] = {"crack_angle", "crack_alignment"};
    for (int i = 0; i < 2; i++) {
        reading(f, cracks[i], &note);
        assert_non_null(strstr(note, "nothing has broken"));
    }
    reading(f, "localisation", &note);
    assert_non_null(strstr(note, "fewer than 10 facets"));
    reading(f, "b_value", &note);
    assert_non_null(strstr(note, "fewer than 25"));
    CHECK_NEAR(reading(f, "n_events", &note), 0, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(clusters_are_those_of_all_pairs),
        FIXTURE_TEST(r_tells_bursts_from_shear),
        FIXTURE_TEST(breaks_near_in_time_are_one_event),
        FIXTURE_TEST(the_window_is_that_of_the_case),
        FIXTURE_TEST(principal_stresses),
        FIXTURE_TEST(a_sieve_sorts_fragments),
        FIXTURE_TEST(work_at_the_peak_is_that_of_the_ledger),
        FIXTURE_TEST(the_shape_of_a_curve_is_read),
        FIXTURE_TEST(without_breaks_there_are_no_cracks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
