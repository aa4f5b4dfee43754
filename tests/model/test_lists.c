/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kept candidate lists against lists made anew at every step: the same motion to the last bit and
 * the same active contacts, over 10 000 steps of a gas of grains in a box. Sleeping pairs, skins
 * and remembered places must be exact, not nearly so. */
#include "tests/model/gas.h"

enum { STEPS = 10000, N = GAS_N };

/* Rows and points that act. */
static uint64_t active_hash(const struct fixture *f, size_t *n)
{
    const struct brc_contacts *c = &f->sim.pairs;
    uint64_t hash = BRC_HASH_SEED;
    for (size_t i = 0; i < c->n; i++) {
        if (brc_norm2(c->f[i]) == 0)
            continue;
        ++*n;
        hash = brc_hash_bytes(&c->a[i], sizeof c->a[i], hash);
        hash = brc_hash_bytes(&c->b[i], sizeof c->b[i], hash);
        hash = brc_hash_bytes(c->f[i], sizeof c->f[i], hash);
        hash = brc_hash_bytes(c->tb[i], sizeof c->tb[i], hash);
    }
    return hash;
}

/* Candidates are listed anew in the step to come. */
static void forget(struct fixture *f)
{
    struct brc_bodies *b = &f->sim.bodies;
    for (size_t i = 0; i < b->n; i++)
        b->path_at_rebuild[i] = b->path_length[i] - 0.6 * f->sim.skin;
}

static void check_gas(struct fixture *f, const char *name, const char *settings, const char *run)
{
    const struct brc_model *model = brc_registry_find(name);
    struct fixture *g;
    void *other;
    size_t n[2] = {0, 0};
    assert_int_equal(fixture_open(&other), 0);
    g = other;
    gas_build(f, NULL, model, settings, run);
    gas_build(g, NULL, model, settings, run);
    int64_t listings = f->sim.n_rebuilds;
    for (int i = 0; i < STEPS; i++) {
        forget(g);
        fixture_steps(f, 1);
        fixture_steps(g, 1);
        assert_true(active_hash(f, &n[0]) == active_hash(g, &n[1]));
        assert_memory_equal(f->sim.bodies.x, g->sim.bodies.x, N * sizeof *f->sim.bodies.x);
        gas_reflect(f);
        gas_reflect(g);
    }
    print_message("%s: %zu active rows in %d steps, %ld listings against %ld\n", name, n[0], STEPS,
                  (long)(f->sim.n_rebuilds - listings), (long)g->sim.n_rebuilds);
    assert_true(n[0] > STEPS / 50);
    assert_true(f->sim.n_rebuilds - listings < STEPS / 2);
    assert_true(g->sim.n_rebuilds >= STEPS);
    fixture_close(&other);
}

static void polyhedra_merged(void **state)
{
    check_gas(*state, "polyhedra", "radius: 1 mm; kn: 1e5 N/m; kt: 1e5 N/m; gn: 200 1/s",
              "dt: 2e-5 s");
}

static void polyhedra_strict(void **state)
{
    check_gas(*state, "polyhedra",
              "radius: 1 mm; kn: 1e5 N/m; kt: 1e5 N/m; gn: 200 1/s; features: strict",
              "dt: 2e-5 s");
}

static void spheres(void **state)
{
    check_gas(*state, "vgcm", "e_bar: 1e7 Pa; viscous: 200 1/s; mu: 0.3", "dt: 2e-5 s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(polyhedra_merged),
        FIXTURE_TEST(polyhedra_strict),
        FIXTURE_TEST(spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
