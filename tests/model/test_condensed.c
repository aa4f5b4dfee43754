/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bonded pairs of polyhedra with condensed springs against the literal ones. */
#include "common/io_h5.h"
#include "polyhedra/poly.h"
#include "tests/fixture.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern const struct brc_model brc_model_polyhedra;

static const struct brc_h5_extra nothing = {NULL, 0, NULL, 0};

enum { STEPS = 800 };

/* A pack that is pressed until many springs slip; part of it breaks when bonds are weak. */
static void press(struct fixture *f, const char *settings, const char *run)
{
    char all[200];
    snprintf(all, sizeof all, "radius: 1 mm; mu: 0.3; %s", settings);
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                        "jitter: 0.6; seed: 3");
    fixture_sim(f, &brc_model_polyhedra, all,
                "kind: compression; loading: fixed; rate: 4e-6 1/s; strain_max: 1", run);
}

static double force_after(struct fixture *f, const char *settings)
{
    press(f, settings, "");
    fixture_steps(f, STEPS);
    return f->sim.rig.force;
}

static size_t count_held(const struct fixture *f)
{
    const struct poly_rows *rows = f->sim.pairs.model_columns;
    size_t n = 0;
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        n += rows->shift[i][POLY_SHIFT_END] > 0;
    return n;
}

/* The error of the load is of second order in the path between two literal evaluations. */
static void load_is_that_of_literal_springs(void **state)
{
    struct fixture *f = *state;
    double literal = force_after(f, "eps_th: 0.05"), error[2];
    static const char *const paths[2] = {"0.01", "0.001"};
    for (int i = 0; i < 2; i++) {
        char settings[100];
        snprintf(settings, sizeof settings, "eps_th: 0.05; intact: condensed; intact_path: %s",
                 paths[i]);
        error[i] = fabs(force_after(f, settings) / literal - 1);
        print_message("path %s R: load off by %.2e, %zu rows condensed, residual %.1e\n", paths[i],
                      error[i], count_held(f), brc_ledger_residual(&f->sim.ledger));
        assert_true(count_held(f) > 20);
        assert_true(brc_ledger_residual(&f->sim.ledger) < 1e-4);
        assert_true(f->sim.events.table.n == 0);
    }
    assert_true(error[0] > 0 && error[0] < 2e-3);
    assert_true(error[1] < error[0] / 2);
}

/* The sum that is carried along is what bond and springs give literally, for the present pose. */
static void tangent_is_the_slope(void **state)
{
    struct fixture *f = *state;
    double largest = 0, off = 0, plain = 0;
    press(f, "eps_th: 0.05; intact: condensed; intact_path: 0.005; mu: 0", "");
    fixture_steps(f, STEPS);
    struct brc_contacts *c = &f->sim.pairs;
    struct poly_rows *rows = c->model_columns;
    double(*condensed)[3] = malloc(c->n * sizeof *condensed);
    double(*held)[6] = malloc(c->n * sizeof *held);
    bool *was_held = malloc(c->n * sizeof *was_held);
    for (size_t i = 0; i < c->n; i++) {
        const double *shift = rows->shift[i];
        was_held[i] = shift[POLY_SHIFT_END] > 0 &&
                      shift[POLY_SHIFT_PATH] > 0.3 * shift[POLY_SHIFT_END] &&
                      shift[POLY_SHIFT_PATH] < 0.9 * shift[POLY_SHIFT_END];
        memcpy(condensed[i], c->f[i], sizeof condensed[i]);
        memcpy(held[i], rows->held[i], sizeof held[i]);
        rows->shift[i][POLY_SHIFT_END] = 0;
    }
    double now[3];
    fixture_carry(f, 0);
    size_t n = 0;
    for (size_t i = 0; i < c->n; i++) {
        if (!was_held[i])
            continue;
        brc_sub(now, c->f[i], condensed[i]);
        off += brc_norm2(now);
        for (int k = 0; k < 3; k++)
            now[k] = c->f[i][k] - held[i][k];
        plain += brc_norm2(now);
        largest = fmax(largest, brc_norm(c->f[i]));
        n++;
    }
    print_message("%zu rows: change of force %.2e, off by %.2e, largest force %.2e\n", n,
                  sqrt(plain), sqrt(off), largest);
    assert_true(n > 10);
    assert_true(off < 0.05 * 0.05 * plain);
    free(condensed);
    free(held);
    free(was_held);
}

/* The same bits with every instruction set, through breaks, and from the middle of a path on. */
static void bits_are_the_same(void **state)
{
    struct fixture *f = *state;
    static const char *const sets[] = {"simd: base", "simd: avx2", "simd: avx512"};
    static const char settings[] = "eps_th: 1e-3; intact: condensed; intact_path: 0.01";
    char path[64];
    uint64_t hash[BRC_N_SIMD] = {0};
    for (int set = 0; set < BRC_N_SIMD; set++) {
        if (brc_simd_check(&f->ctx, 1 + set) != 0) {
            brc_error_clear(&f->ctx);
            hash[set] = hash[0];
            continue;
        }
        press(f, settings, sets[set]);
        fixture_steps(f, STEPS);
        hash[set] = brc_sim_hash(&f->sim);
        assert_true(f->sim.events.table.n > 0 && count_held(f) > 5);
    }
    assert_true(hash[0] == hash[1] && hash[0] == hash[2]);
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-condensed.h5", (long)getpid());
    press(f, settings, "");
    fixture_steps(f, STEPS / 2 + 3);
    CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &nothing));
    press(f, settings, "");
    CHECK_OK(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &nothing));
    fixture_steps(f, STEPS - STEPS / 2 - 3);
    unlink(path);
    assert_true(brc_sim_hash(&f->sim) == hash[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(load_is_that_of_literal_springs),
                                       FIXTURE_TEST(tangent_is_the_slope),
                                       FIXTURE_TEST(bits_are_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
