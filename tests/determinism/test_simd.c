/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every instruction set that this machine has gives the same bits, through failure. */
#include "tests/fixture.h"

static const char *const SETTINGS[][2] = {
    {"kind: compression; friction: 0.2; rate: 4e-6 1/s", "ledger: on"},
    {"kind: tension; grip: full; rate: 4e-6 1/s", "ledger: off"},
    {"kind: none", "regime: dynamic"},
};
static const char *const SETS[BRC_N_SIMD] = {"base", "avx2", "avx512"};

/* Hash after 400 steps; the grains of a run without platens fly apart and meet again. */
static uint64_t hash_with(struct fixture *f, const struct brc_model *model, int setting, int set,
                          size_t *events)
{
    char run[100];
    const char *softening = "softening: none";
    snprintf(run, sizeof run, "%s; simd: %s", SETTINGS[setting][1], SETS[set]);
    fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                        "jitter: 0.8; seed: 5");
    if (!fixture_is(model, "vgcm") || setting == 0)
        softening = fixture_is(model, "polyhedra") ? FIXTURE_TABLE_1 "; eps_th: 2e-4" : "";
    fixture_sim(f, model, softening, SETTINGS[setting][0], run);
    for (size_t c = 0; setting == 2 && c < f->sim.bodies.n_grains; c++)
        for (int j = 0; j < 3; j++)
            f->sim.bodies.v[c][j] = 3 * sin(17.0 * (double)c + 5 * j);
    fixture_steps(f, 400);
    *events += f->sim.events.table.n;
    return brc_sim_hash(&f->sim);
}

static void same_bits_with_every_instruction_set(void **state)
{
    struct fixture *f = *state;
    for (int m = 0; m < fixture_n_models(); m++) {
        const struct brc_model *model = fixture_model(m);
        size_t events = 0;
        if (fixture_is(model, "null"))
            continue; /* nothing is stiff: no automatic step */
        for (int i = 0; i < (int)(sizeof SETTINGS / sizeof SETTINGS[0]); i++) {
            uint64_t base = hash_with(f, model, i, BRC_SIMD_BASE, &events);
            for (int set = 1; set < BRC_N_SIMD; set++) {
                if (brc_simd_check(&f->ctx, 1 + set) != 0) {
                    print_message("no %s here\n", SETS[set]);
                    brc_error_clear(&f->ctx);
                    continue;
                }
                assert_true(hash_with(f, model, i, set, &events) == base);
            }
        }
        print_message("%s: %zu breaks\n", model->name, events);
        assert_true(events > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(same_bits_with_every_instruction_set)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
