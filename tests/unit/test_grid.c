/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The broad phase against all pairs, and points that become one. */
#include "common/geometry/grid.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"
#include "tests/near.h"

#include <stdlib.h>

enum { N_MAX = 600 };

struct trial {
    struct brc_context ctx;
    struct brc_neighbours out;
    double x[N_MAX][3], reach[N_MAX];
    uint64_t random;
};

static int set_up(void **state)
{
    static struct trial t;
    t = (struct trial){.ctx = BRC_CONTEXT_INIT, .random = 4711};
    *state = &t;
    return 0;
}

static int tear_down(void **state)
{
    struct trial *t = *state;
    brc_neighbours_free(&t->out);
    return 0;
}

static double draw(struct trial *t)
{
    t->random = t->random * UINT64_C(6364136223846793005) + 1442695040888963407;
    return (double)(t->random >> 11) / 9007199254740992.0;
}

/* n bodies in a box of the given edge about the origin, reaches from 0.5 to 1 of size. */
static void scatter(struct trial *t, size_t n, double edge, double size)
{
    for (size_t i = 0; i < n; i++) {
        for (int k = 0; k < 3; k++)
            t->x[i][k] = edge * (draw(t) - 0.5);
        t->reach[i] = size * (0.5 + 0.5 * draw(t));
    }
}

/* Compares with all pairs in their order; returns how many there are. */
static size_t check_all_pairs(struct trial *t, size_t n, double skin)
{
    size_t count = 0;
    CHECK_OK(&t->ctx, brc_grid_pairs(&t->ctx, t->x, t->reach, n, skin, &t->out));
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++) {
            double d[3];
            brc_sub(d, t->x[j], t->x[i]);
            if (brc_norm(d) >= t->reach[i] + t->reach[j] + skin)
                continue;
            assert_true(count < t->out.n);
            assert_int_equal(t->out.pair[count][0], i);
            assert_int_equal(t->out.pair[count][1], j);
            count++;
        }
    assert_int_equal(t->out.n, count);
    return count;
}

static void random_clouds(void **state)
{
    struct trial *t = *state;
    for (int round = 0; round < 8; round++) {
        scatter(t, N_MAX, 1, 0.02 * (1 + round));
        assert_true(check_all_pairs(t, N_MAX, 0.01 * round) > 10);
    }
}

static void scale_does_not_matter(void **state)
{
    struct trial *t = *state;
    size_t count[3];
    for (int i = 0; i < 3; i++) {
        double unit = i == 0 ? 1 : i == 1 ? 1e-3 : 1e-6;
        t->random = 4711;
        scatter(t, 300, unit, 0.08 * unit);
        count[i] = check_all_pairs(t, 300, 0.02 * unit);
    }
    assert_int_equal(count[0], count[1]);
    assert_int_equal(count[0], count[2]);
}

static void one_giant_among_small_ones(void **state)
{
    struct trial *t = *state;
    scatter(t, 200, 1, 0.01);
    t->reach[37] = 0.4;
    assert_true(check_all_pairs(t, 200, 0.005) > 20);
}

static void runaways_cost_no_memory(void **state)
{
    struct trial *t = *state;
    scatter(t, 300, 1, 0.08);
    for (int i = 0; i < 5; i++)
        brc_set(t->x[60 * i], 1e6 * (i - 2.5), -3e7 * i, 1e5);
    check_all_pairs(t, 300, 0.02);
}

static void cell_borders_and_coincidence(void **state)
{
    /* exact lattice: every distance is a multiple of the cell, the hardest case for floor */
    struct trial *t = *state;
    for (size_t i = 0; i < 512; i++) {
        brc_set(t->x[i], (double)(i % 8) - 4, (double)(i / 8 % 8) - 4, (double)(i / 64) - 4);
        t->reach[i] = 0.5;
    }
    brc_copy(t->x[511], t->x[0]); /* two in one place */
    assert_int_equal(check_all_pairs(t, 512, 0), 1);
    /* 3 * 8 * 8 * 7 neighbours, less three of the moved one, plus its three and the pair itself */
    assert_int_equal(check_all_pairs(t, 512, 1e-9), 1344 + 1);
}

/* Each in turn takes the others that are near, if none has taken it and it takes part at all. */
static void points_join_the_first_near_one(void **state)
{
    struct trial *t = *state;
    int32_t to[N_MAX], expected[N_MAX];
    size_t joined = 0;
    scatter(t, N_MAX, 1, 0);
    for (int32_t i = 0; i < N_MAX; i++)
        to[i] = expected[i] = i % 7 == 3 ? -1 : i;
    for (int32_t i = 0; i < N_MAX; i++)
        for (int32_t j = i + 1; j < N_MAX && expected[i] == i; j++)
            if (expected[j] == j && brc_distance(t->x[j], t->x[i]) < 0.1) {
                expected[j] = i;
                joined++;
            }
    CHECK_OK(&t->ctx, brc_grid_join(&t->ctx, t->x, N_MAX, 0.1, to));
    assert_memory_equal(to, expected, sizeof to);
    assert_in_range(joined, 100, N_MAX - 100);
}

/* As the vertices of cells do whose seeds lie on a sphere. Their pairs would take 40 GB. */
static void many_points_join_at_one_place(void **state)
{
    struct trial *t = *state;
    const size_t n = 100000;
    double(*x)[3] = brc_alloc(&t->ctx, n, sizeof *x);
    int32_t *to = brc_alloc(&t->ctx, n, sizeof *to);
    for (size_t i = 0; i < n; i++)
        to[i] = (int32_t)i;
    CHECK_OK(&t->ctx, brc_grid_join(&t->ctx, (const double(*)[3])x, n, 1e-9, to));
    for (size_t i = 0; i < n; i++)
        assert_int_equal(to[i], 0);
    free(to);
    free(x);
}

static void few_bodies(void **state)
{
    struct trial *t = *state;
    scatter(t, 2, 0.1, 1);
    assert_int_equal(check_all_pairs(t, 0, 0.1), 0);
    assert_int_equal(check_all_pairs(t, 1, 0.1), 0);
    assert_int_equal(check_all_pairs(t, 2, 0.1), 1);
}

static void platens_see_whom_they_may_touch(void **state)
{
    struct trial *t = *state;
    struct brc_sim sim = {.ctx = &t->ctx, .skin = 0.03};
    struct brc_bodies *b = &sim.bodies;
    size_t n = 200, count = 0;
    CHECK_OK(&t->ctx, brc_bodies_create(&t->ctx, b, n, 2, (struct brc_fieldset){0}));
    scatter(t, n, 1, 0.05);
    memcpy(b->x, t->x, n * sizeof *b->x);
    memcpy(b->bounding_radius, t->reach, n * sizeof *b->bounding_radius);
    sim.rig.n_platens = 2;
    sim.rig.platen[0] = (struct brc_platen){.body = (int32_t)n, .n = {0, 0, 1}};
    sim.rig.platen[1] = (struct brc_platen){.body = (int32_t)n + 1, .n = {0, 0, -1}};
    brc_set(b->x[n], 5, 5, -0.5);
    brc_set(b->x[n + 1], -5, 5, 0.5);
    CHECK_OK(&t->ctx, brc_sim_near_platens(&sim, &t->out));
    for (size_t i = 0; i < n; i++)
        for (int p = 0; p < 2; p++) {
            double height = p == 0 ? b->x[i][2] + 0.5 : 0.5 - b->x[i][2];
            if (height >= b->bounding_radius[i] + sim.skin)
                continue;
            assert_int_equal(t->out.pair[count][0], i);
            assert_int_equal(t->out.pair[count][1], n + (size_t)p);
            count++;
        }
    assert_int_equal(t->out.n, count);
    assert_true(count > 10);
    brc_bodies_free(b);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(random_clouds),
        TEST(scale_does_not_matter),
        TEST(one_giant_among_small_ones),
        TEST(runaways_cost_no_memory),
        TEST(cell_borders_and_coincidence),
        TEST(points_join_the_first_near_one),
        TEST(many_points_join_at_one_place),
        TEST(few_bodies),
        TEST(platens_see_whom_they_may_touch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
