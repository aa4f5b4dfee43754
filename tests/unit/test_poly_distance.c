/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distances of features against sampling and search; the `merged` rule's springs against the
 * gradient of their energy; continuity over a whole cell. */
#include "tests/near.h"
#include "tests/poly_solids.h"

#include "common/geometry/vec.h"

enum { N_CORES = 12 };
static struct poly_shapes shapes;

static int make_shapes(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    unsigned seed = 11;
    int code = 0;
    for (int i = 0; code == 0 && i < N_CORES; i++)
        code = solid_random(&ctx, &shapes, &seed, 1);
    return code;
}

static int free_shapes(void **state)
{
    (void)state;
    poly_shapes_free(&shapes);
    return 0;
}

/* --- vertex to core --------------------------------------------------------------------------- */

/* The walk finds the closest place from any start; the distance has slope 1 and its normal. */
static void test_walk_agrees_with_search(void **state)
{
    (void)state;
    unsigned seed = 5;
    for (int trial = 0; trial < 4000; trial++) {
        struct poly_core c = poly_core_of(&shapes, (size_t)(trial % N_CORES));
        double p[3], h;
        for (int k = 0; k < 3; k++)
            p[k] = 3.2 * (solid_uniform(&seed) - 0.5);
        struct poly_closest walk, search, ahead;
        int32_t start = (int32_t)(solid_uniform(&seed) * c.n_faces);
        poly_closest_walk(&walk, &c, p, poly_feature_code(start, POLY_ON_FACE));
        int32_t high = poly_highest(&c, p, &h);
        if (h <= 0)
            poly_on_face(&search, &c, high, h);
        else
            poly_closest_search(&search, &c, p);
        CHECK_NEAR(walk.s, search.s, 1e-13, 1e-12);
        CHECK_NEAR(brc_norm(walk.n), 1, 1e-12, 0);
        /* any other start */
        poly_closest_walk(&ahead, &c, p, poly_feature_code(trial % c.n_vertices, POLY_ON_VERTEX));
        CHECK_NEAR(ahead.s, walk.s, 1e-13, 1e-12);
        brc_axpy(p, 1e-7, walk.n);
        poly_closest_walk(&ahead, &c, p, walk.feature);
        CHECK_NEAR(ahead.s - walk.s, 1e-7, 1e-12, 0);
    }
}

static void test_signed_inside(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_shapes s = {0};
    const double half[3] = {1, 1, 1}, p[3] = {0.2, 0.1, 0.9};
    CHECK_OK(&ctx, solid_box(&ctx, &s, half));
    struct poly_core c = poly_core_of(&s, 0);
    struct poly_closest closest;
    for (int32_t f = 0; f < c.n_faces; f++) {
        poly_closest_walk(&closest, &c, p, poly_feature_code(f, POLY_ON_FACE));
        CHECK_NEAR(closest.s, -0.1, 1e-15, 0);
        CHECK_NEAR(closest.n[2], 1, 1e-15, 0);
        bool touches = poly_closest_of_rule(&closest, &c, f, p, true, 0.2);
        assert_int_equal(touches, c.face[f].n[2] > 0.5);
        if (touches)
            CHECK_NEAR(closest.s, -0.1, 1e-15, 0);
    }
    poly_shapes_free(&s);
}

/* --- edge to edge ----------------------------------------------------------------------------- */

static void random_edges(double e[4][3], unsigned *seed)
{
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            e[i][k] = solid_uniform(seed) - 0.5;
}

static void in_all_lanes(brc_lanes all[4][3], const double (*e)[3])
{
    for (int i = 0; i < 4; i++)
        poly_all3(all[i], e[i]);
}

/* Distance of the closed edges; of parallel ones any closest points will do. */
static double edge_distance(double e[4][3])
{
    struct poly_crossings x;
    brc_lanes all[4][3];
    in_all_lanes(all, (const double(*)[3])e);
    poly_cross_edges(&x, all);
    return poly_edge_gap(&x, 0)[0];
}

static double sampled_distance(double e[4][3])
{
    enum { N = 100 };
    double best = HUGE_VAL;
    for (int i = 0; i <= N; i++)
        for (int j = 0; j <= N; j++) {
            double d2 = 0, s = i / (double)N, t = j / (double)N;
            for (int k = 0; k < 3; k++) {
                double d = e[0][k] + s * (e[1][k] - e[0][k]) - e[2][k] - t * (e[3][k] - e[2][k]);
                d2 += d * d;
            }
            best = fmin(best, d2);
        }
    return sqrt(best);
}

static void test_edges_against_sampling(void **state)
{
    (void)state;
    unsigned seed = 2;
    for (int trial = 0; trial < 200; trial++) {
        double e[4][3];
        random_edges(e, &seed);
        if (trial % 4 == 0) /* parallel, either sense */
            for (int k = 0; k < 3; k++)
                e[3][k] = e[2][k] + (trial % 8 ? 0.7 : -1.3) * (e[1][k] - e[0][k]);
        double d = edge_distance(e), sampled = sampled_distance(e);
        assert_true(d <= sampled + 1e-12);
        CHECK_NEAR(d, sampled, 0.01, 0);
    }
}

/* Parallel is relative: shrinking the edges changes nothing. */
static void test_parallel_is_relative(void **state)
{
    (void)state;
    const double sizes[] = {1, 1e-3, 1e-6};
    for (int k = 0; k < 3; k++) {
        double size = sizes[k];
        const double e[4][3] = {{-size, 0, 0},
                                {size, 0, 0},
                                {-size, -1e-4 * size, 0.1 * size},
                                {size, 1e-4 * size, 0.1 * size}};
        struct poly_crossings x;
        brc_lanes all[4][3];
        in_all_lanes(all, e);
        assert_true(poly_cross_edges(&x, all)[0]);
        assert_true(x.skew[0]);
        double d = x.rm[0] * sqrt(x.per_m[0]);
        CHECK_NEAR(x.ta[0], size, 0, 1e-6);
        CHECK_NEAR(fabs(d), 0.1 * size, 0, 1e-12);
    }
}

/* --- the merged rule -------------------------------------------------------------------------- */

/* Energy in units of K, force on b and moment about the centre of b of all feature contacts. */
static double pair_energy(const struct poly_pair *p, enum poly_rule rule, double f[3], double m[3],
                          int *count)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_list l = {0};
    double energy = 0, allowance;
    brc_set(f, 0, 0, 0);
    brc_set(m, 0, 0, 0);
    *count = 0;
    CHECK_OK(&ctx, poly_list_features(&ctx, &l, p, rule, 0.05 * p->contact_distance, &allowance));
    for (size_t k = 0; k < l.n; k++) {
        struct poly_geometry t;
        struct poly_feature feature = l.feature[k];
        uint8_t active = 0;
        double margin;
        if (!poly_find_contact(&t, p, &feature, &active, &margin, rule))
            continue;
        double push[3], arm[3], moment[3];
        brc_scale(push, t.n, t.weight * t.delta);
        brc_axpy(push, -0.5 * t.delta * t.delta, t.g);
        brc_sub(arm, t.x, p->xb);
        brc_cross(moment, arm, push);
        brc_axpy(moment, -0.5 * t.delta * t.delta, t.c);
        brc_add(f, f, push);
        brc_add(m, m, moment);
        energy += 0.5 * t.weight * t.delta * t.delta;
        *count += 1;
    }
    poly_list_free(&l);
    return energy;
}

/* Energy when b is moved by u and turned by phi about its centre. */
static double moved_energy(size_t a, const struct solid_pose *pa, size_t b,
                           const struct solid_pose *pb, const double u[3], const double phi[3],
                           double radius)
{
    struct solid_pose moved = {.v = NULL};
    double turn[4], f[3], m[3];
    int count;
    brc_add(moved.x, pb->x, u);
    brc_quat_from_rotation(turn, phi);
    brc_quat_mul(moved.q, turn, pb->q);
    solid_place(&moved, &shapes, b);
    struct poly_pair p = solid_pair(&shapes, a, pa, b, &moved, radius);
    double energy = pair_energy(&p, POLY_MERGED, f, m, &count);
    free(moved.v);
    return energy;
}

/* Random poses that overlap a little: b comes nearer until the rounded bodies meet. */
static void random_contact(size_t a, struct solid_pose *pa, size_t b, struct solid_pose *pb,
                           double radius, double depth, unsigned *seed)
{
    double dir[3], f[3], m[3];
    int count = 0;
    for (int k = 0; k < 3; k++)
        dir[k] = solid_uniform(seed) - 0.5;
    brc_normalise(dir, dir);
    brc_set(pa->x, 0, 0, 0);
    solid_rotation(pa->q, seed);
    solid_rotation(pb->q, seed);
    solid_place(pa, &shapes, a);
    for (int i = 0; count == 0; i++) {
        brc_scale(pb->x, dir, 4 - 0.2 * i * radius);
        solid_place(pb, &shapes, b);
        struct poly_pair p = solid_pair(&shapes, a, pa, b, pb, radius);
        pair_energy(&p, POLY_MERGED, f, m, &count);
    }
    brc_axpy(pb->x, -depth * radius, dir);
    solid_place(pb, &shapes, b);
}

/* Force and moment are minus the gradient of the energy, in every mix of features. */
static void test_merged_is_conservative(void **state)
{
    (void)state;
    const double radius = 0.1, h = 1e-6, none[3] = {0, 0, 0};
    struct solid_pose pa = {.v = NULL}, pb = {.v = NULL};
    unsigned seed = 21;
    int contacts = 0;
    for (int trial = 0; trial < 300; trial++) {
        size_t a = (size_t)(trial % N_CORES), b = (size_t)((trial * 5 + 1) % N_CORES);
        double f[3], m[3];
        int count;
        random_contact(a, &pa, b, &pb, radius, 0.5 * solid_uniform(&seed), &seed);
        struct poly_pair p = solid_pair(&shapes, a, &pa, b, &pb, radius);
        pair_energy(&p, POLY_MERGED, f, m, &count);
        contacts += count;
        for (int k = 0; k < 3; k++) {
            double d[3] = {0, 0, 0}, back[3] = {0, 0, 0};
            d[k] = h;
            back[k] = -h;
            double force = (moved_energy(a, &pa, b, &pb, back, none, radius) -
                            moved_energy(a, &pa, b, &pb, d, none, radius)) /
                           (2 * h);
            double moment = (moved_energy(a, &pa, b, &pb, none, back, radius) -
                             moved_energy(a, &pa, b, &pb, none, d, radius)) /
                            (2 * h);
            CHECK_NEAR(force, f[k], 1e-6, 1e-5);
            CHECK_NEAR(moment, m[k], 1e-6, 1e-5);
        }
    }
    assert_true(contacts > 400);
    free(pa.v);
    free(pb.v);
}

/* Largest change of the force between two places h apart: b, a small box turned at random, slides
 * with its lowest corner just inside the range of the large box a, from the middle of a face over
 * the face's edge (or corner) until it falls free, while its overlap changes slowly. */
static double largest_jump(enum poly_rule rule, double h, const double dir[2],
                           double *largest_force)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_shapes s = {0};
    const double half[3] = {1, 1, 1}, small[3] = {0.2, 0.2, 0.2}, radius = 0.1;
    struct solid_pose pa = {.q = {1, 0, 0, 0}}, pb = {.v = NULL};
    unsigned seed = 4;
    double before[3] = {0, 0, 0}, jump = 0, low = 0;
    CHECK_OK(&ctx, solid_box(&ctx, &s, half));
    CHECK_OK(&ctx, solid_box(&ctx, &s, small));
    solid_place(&pa, &s, 0);
    solid_rotation(pb.q, &seed);
    solid_place(&pb, &s, 1);
    for (int v = 0; v < 8; v++)
        low = fmin(low, pb.v[v][2]);
    *largest_force = 0;
    for (int i = 0; i * h < 1.6; i++) {
        double t = i * h, f[3], m[3];
        int count;
        brc_set(pb.x, t * dir[0], t * dir[1], 1 - low + (1.8 - 0.2 * t) * radius);
        solid_place(&pb, &s, 1);
        struct poly_pair p = solid_pair(&s, 0, &pa, 1, &pb, radius);
        pair_energy(&p, rule, f, m, &count);
        *largest_force = fmax(*largest_force, brc_norm(f));
        if (i > 0) {
            double d[3];
            brc_sub(d, f, before);
            jump = fmax(jump, brc_norm(d));
        }
        brc_copy(before, f);
    }
    assert_true(brc_norm(before) == 0);
    free(pa.v);
    free(pb.v);
    poly_shapes_free(&s);
    return jump;
}

static void test_sliding_over_a_cell(void **state)
{
    (void)state;
    const double dir[3][2] = {{1, 0.1}, {0.3, 1}, {1, 0.97}};
    for (int k = 0; k < 3; k++) {
        double force, unused, coarse = largest_jump(POLY_MERGED, 1e-3, dir[k], &unused);
        double fine = largest_jump(POLY_MERGED, 1e-4, dir[k], &force);
        double strict = largest_jump(POLY_STRICT, 1e-4, dir[k], &unused);
        double closed = largest_jump(POLY_CLOSED, 1e-4, dir[k], &unused);
        print_message("sliding %d, largest force %.3g K R: jumps merged %.2g (step 1e-3), "
                      "%.2g (1e-4), strict %.2g, closed %.2g K R\n",
                      k, force / 0.1, coarse / 0.1, fine / 0.1, strict / 0.1, closed / 0.1);
        /* continuous: the jump falls with the step, and is at most a few K times the step */
        assert_true(fine < 0.15 * coarse);
        assert_true(fine < 10 * 1e-4);
        assert_true(strict > 20 * fine);
    }
}

/* Springs between two boxes face to face, b shifted along the face; total weight in *weight. */
static int coincident_count(enum poly_rule rule, double shift, double *weight)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct poly_shapes s = {0};
    struct poly_list l = {0};
    const double half[3] = {1, 1, 1};
    struct solid_pose pa = {.q = {1, 0, 0, 0}},
                      pb = {.q = {1, 0, 0, 0}, .x = {shift, shift, 2.199}};
    double allowance;
    int count = 0;
    CHECK_OK(&ctx, solid_box(&ctx, &s, half));
    CHECK_OK(&ctx, solid_box(&ctx, &s, half));
    solid_place(&pa, &s, 0);
    solid_place(&pb, &s, 1);
    struct poly_pair p = solid_pair(&s, 0, &pa, 1, &pb, 0.1);
    CHECK_OK(&ctx, poly_list_features(&ctx, &l, &p, rule, 0.01, &allowance));
    *weight = 0;
    for (size_t k = 0; k < l.n; k++) {
        struct poly_geometry t;
        uint8_t active = 0;
        double margin;
        if (poly_find_contact(&t, &p, &l.feature[k], &active, &margin, rule)) {
            count++;
            *weight += t.weight;
        }
    }
    poly_list_free(&l);
    poly_shapes_free(&s);
    free(pa.v);
    free(pb.v);
    return count;
}

static void test_coincident_faces(void **state)
{
    (void)state;
    double closed[2], merged[2];
    int n[2] = {coincident_count(POLY_CLOSED, 0.5, &closed[0]),
                coincident_count(POLY_CLOSED, 0, &closed[1])};
    coincident_count(POLY_MERGED, 1e-9, &merged[0]);
    coincident_count(POLY_MERGED, 0, &merged[1]);
    print_message("coincident faces: closed counts %d springs shifted, %d coincident, %d at 1e-9; "
                  "merged %.9g and %.9g\n",
                  n[0], n[1], coincident_count(POLY_CLOSED, 1e-9, &closed[0]), merged[0],
                  merged[1]);
    assert_int_equal(n[0], 4);
    assert_true(n[1] >= 16);
    CHECK_NEAR(merged[1], 4, 1e-12, 0);
    CHECK_NEAR(merged[0], merged[1], 1e-7, 0);
    coincident_count(POLY_MERGED, 0.5, &merged[0]);
    CHECK_NEAR(merged[0], 4, 1e-12, 0);
}

/* --- lists ------------------------------------------------------------------------------------ */

/* Moves b by a path of at most `most`, half of it by shift, half by turn; returns the path. */
static double move_at_random(struct solid_pose *pose, double most, double reach, unsigned *seed)
{
    double shift[3], phi[3], turn[4], q[4];
    for (int k = 0; k < 3; k++) {
        shift[k] = (solid_uniform(seed) - 0.5) * most / sqrt(3);
        phi[k] = (solid_uniform(seed) - 0.5) * most / reach / sqrt(3);
    }
    brc_add(pose->x, pose->x, shift);
    brc_quat_from_rotation(turn, phi);
    memcpy(q, pose->q, sizeof q);
    brc_quat_mul(pose->q, turn, q);
    return brc_norm(shift) + reach * brc_norm(phi);
}

static bool is_listed(const struct poly_list *l, const struct poly_feature *x, enum poly_rule rule)
{
    for (size_t n = 0; n < l->n; n++) {
        const struct poly_feature *y = &l->feature[n];
        bool i = y->i == x->i, j = y->j == x->j;
        if (rule == POLY_MERGED && x->kind != POLY_EDGES)
            i = j = x->kind == POLY_VERTEX_A ? i : j;
        if (y->kind == x->kind && i && j)
            return true;
    }
    return false;
}

/* A listed pair keeps every contact while the bodies move by less than the allowance, and no pair
 * touches before its free path is used up. */
static void test_lists_are_exact(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    const double radius = 0.1, skin = 0.02;
    struct solid_pose pa = {.v = NULL}, pb = {.v = NULL};
    struct poly_list near = {0}, all = {0};
    unsigned seed = 8;
    int n_active = 0, n_free[3] = {0, 0, 0};
    for (int trial = 0; trial < 6000; trial++) {
        enum poly_rule rule = (enum poly_rule)(trial % 3);
        size_t a = (size_t)(trial % N_CORES), b = (size_t)((trial * 7 + 2) % N_CORES);
        double allowance, unused;
        random_contact(a, &pa, b, &pb, radius, 0.3 * solid_uniform(&seed) - 0.1, &seed);
        struct poly_pair p = solid_pair(&shapes, a, &pa, b, &pb, radius);
        CHECK_OK(&ctx, poly_list_features(&ctx, &near, &p, rule, skin, &allowance));
        assert_true(allowance >= skin);
        double path =
            move_at_random(&pb, solid_uniform(&seed) * allowance, solid_reach(&shapes, b), &seed);
        solid_place(&pb, &shapes, b);
        p = solid_pair(&shapes, a, &pa, b, &pb, radius);
        CHECK_OK(&ctx, poly_list_features(&ctx, &all, &p, rule, 5, &unused));
        for (size_t k = 0; k < all.n + near.n; k++) {
            struct poly_feature x = k < all.n ? all.feature[k] : near.feature[k - all.n];
            struct poly_feature start = x;
            struct poly_geometry t;
            uint8_t active = 0;
            double margin;
            bool touches = poly_find_contact(&t, &p, &x, &active, &margin, rule);
            n_active += touches;
            assert_true(!touches || is_listed(&near, &start, rule));
            if (k >= all.n && start.free > path) {
                n_free[rule]++;
                assert_false(touches);
            }
        }
    }
    print_message("lists: %d contacts, all listed; %d, %d and %d features sleep\n", n_active,
                  n_free[0], n_free[1], n_free[2]);
    assert_true(n_active > 20000 && n_free[0] > 2000 && n_free[1] > 500 && n_free[2] > 500);
    poly_list_free(&near);
    poly_list_free(&all);
    free(pa.v);
    free(pb.v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_walk_agrees_with_search), cmocka_unit_test(test_signed_inside),
        cmocka_unit_test(test_edges_against_sampling),  cmocka_unit_test(test_parallel_is_relative),
        cmocka_unit_test(test_merged_is_conservative),  cmocka_unit_test(test_sliding_over_a_cell),
        cmocka_unit_test(test_coincident_faces),        cmocka_unit_test(test_lists_are_exact),
    };
    return cmocka_run_group_tests(tests, make_shapes, free_shapes);
}
