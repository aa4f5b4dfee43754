/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equal input gives equal bits: within one process whatever the state of the heap, and by the lines
 * `hash NAME VALUE` that this program prints, across processes and builds (see test_builds.sh). */
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const SPECIMENS[] = {
    "shape: box; grains: grid; size: 4 cm, 4 cm, 4 cm; cells: 4, 4, 4; jitter: 0.9",
    "shape: box; grains: grid; size: 3 cm, 3 cm, 3 cm; cells: 3, 3, 3; jitter: 0",
    "shape: cylinder; diameter: 25 mm; height: 30 mm; sides: 16; grains: packing",
    "shape: cylinder; diameter: 80 cm; height: 1 cm; sides: 30; grains: mesh; triangle_area: 60 "
    "cm2",
};
enum { N_SPECIMENS = sizeof SPECIMENS / sizeof SPECIMENS[0] };

static uint64_t facets_hash(const struct brc_facets *s)
{
    uint64_t h = BRC_HASH_SEED;
#define HASH(column, n) h = brc_hash_bytes(s->column, (n) * sizeof *s->column, h)
    HASH(volume, s->n_cells);
    HASH(centre, s->n_cells);
    HASH(seed, s->n_cells);
    HASH(radius, s->n_cells);
    HASH(cell_first, s->n_cells + 1);
    HASH(cell, s->n_facets);
    HASH(face, s->n_facets);
    HASH(is_contact, s->n_facets);
    HASH(area, s->n_facets);
    HASH(centroid, s->n_facets);
    HASH(normal, s->n_facets);
    HASH(loop, s->first[s->n_facets]);
    HASH(vertex, s->n_vertices);
#undef HASH
    return h;
}

/* Leaves the heap full of holes of many sizes, so that the next objects lie in another order; what
 * lies between the holes goes at the next call. */
static void stir_heap(struct fixture *f)
{
    enum { N = 3000 };
    static void *block[N];
    for (int i = 0; i < N; i++)
        if (!block[i] || fixture_draw(f) > 0) {
            free(block[i]);
            block[i] = malloc((size_t)(1 + 2000 * fabs(fixture_draw(f))));
        }
    for (int i = 0; i < N; i++)
        if (fixture_draw(f) > -0.6) {
            free(block[i]);
            block[i] = NULL;
        }
}

static void specimens(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < N_SPECIMENS; i++) {
        uint64_t first = 0;
        for (int k = 0; k < 4; k++) {
            stir_heap(f);
            fixture_specimen(f, SPECIMENS[i]);
            uint64_t hash = facets_hash(&f->specimen.facets);
            if (k == 0) {
                first = hash;
                print_message("hash specimen_%d %016llx\n", i, (unsigned long long)hash);
            }
            assert_true(hash == first);
        }
    }
}

static void runs(void **state)
{
    struct fixture *f = *state;
    const char *tests[3] = {"kind: compression; friction: 0.2; rate: 2e-6 1/s",
                            "kind: tension; grip: full; rate: 2e-6 1/s", "kind: none"};
    for (int m = 0; m < fixture_n_models(); m++)
        for (int t = 0; t < 3; t++) {
            uint64_t first = 0;
            const struct brc_model *model = fixture_model(m);
            for (int k = 0; k < 2; k++) {
                stir_heap(f);
                fixture_specimen(f, SPECIMENS[0]);
                const char *settings =
                    fixture_is(model, "polyhedra") ? FIXTURE_TABLE_1 "; eps_th: 5e-4" : "";
                const char *run = t < 2                       ? ""
                                  : fixture_is(model, "null") ? "regime: dynamic; dt: 1e-6 s"
                                                              : "regime: dynamic";
                fixture_sim(f, model, settings, tests[t], run);
                for (size_t c = 0; t == 2 && c < f->sim.bodies.n_grains; c++)
                    for (int j = 0; j < 3; j++)
                        f->sim.bodies.v[c][j] = 2 * sin(17.0 * (double)c + 5 * j);
                fixture_steps(f, 300);
                uint64_t hash = brc_sim_hash(&f->sim);
                if (k == 0) {
                    first = hash;
                    print_message("hash %s_%d %016llx\n", model->name, t, (unsigned long long)hash);
                }
                assert_true(hash == first);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(specimens),
        FIXTURE_TEST(runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
