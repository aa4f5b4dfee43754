/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectors and rotations against hand values. */
#include "common/base/brc.h"
#include "common/geometry/vec.h"
#include "tests/near.h"
#include "tests/rotate.h"

/* Results here are a handful of products of numbers of order one: a few units of 2.2e-16. */
enum { N_DRAWS = 200 };
static const double ROUND = 2e-15;

/* xorshift: reproducible, no library state */
static double draw(uint64_t *s)
{
    *s ^= *s << 13;
    *s ^= *s >> 7;
    *s ^= *s << 17;
    return (double)(*s >> 11) / 9007199254740992.0 * 2 - 1;
}

static void draw3(double r[3], uint64_t *s)
{
    for (int k = 0; k < 3; k++)
        r[k] = draw(s);
}

static void draw_quat(double q[4], uint64_t *s)
{
    double n = 0;
    while (n < 0.1) {
        n = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = draw(s);
            n += q[k] * q[k];
        }
    }
    for (int k = 0; k < 4; k++)
        q[k] /= sqrt(n);
}

static void products_by_hand(void **state)
{
    const double a[3] = {1, 2, 3}, b[3] = {-4, 5, 0.5};
    double r[3];
    (void)state;
    brc_cross(r, a, b);
    CHECK_NEAR_ARRAY(r, ((double[3]){-14, -12.5, 13}), 3, 0, 0);
    CHECK_NEAR(brc_dot(a, b), 7.5, 0, 0);
    CHECK_NEAR(brc_norm(a), 3.7416573867739413, 0, 1e-15);
    brc_axpy(r, 2, a);
    CHECK_NEAR_ARRAY(r, ((double[3]){-12, -8.5, 19}), 3, 0, 0);
    brc_sub(r, a, b);
    CHECK_NEAR_ARRAY(r, ((double[3]){5, -3, 2.5}), 3, 0, 0);
}

static void outputs_may_alias(void **state)
{
    double a[3] = {1, 2, 3}, b[3] = {-4, 5, 0.5};
    (void)state;
    brc_cross(a, a, b);
    CHECK_NEAR_ARRAY(a, ((double[3]){-14, -12.5, 13}), 3, 0, 0);
    brc_add(b, a, b);
    CHECK_NEAR_ARRAY(b, ((double[3]){-18, -7.5, 13.5}), 3, 0, 0);
}

static void zero_vector_stays_zero(void **state)
{
    double a[3] = {0, 0, 0}, phi[3] = {0, 0, 0}, q[4];
    (void)state;
    CHECK_NEAR(brc_normalise(a, a), 0, 0, 0);
    CHECK_NEAR_ARRAY(a, ((double[3]){0, 0, 0}), 3, 0, 0);
    brc_quat_from_rotation(q, phi);
    CHECK_NEAR_ARRAY(q, ((double[4]){1, 0, 0, 0}), 4, 0, 0);
}

static void frames_are_right_handed(void **state)
{
    uint64_t seed = 7;
    (void)state;
    for (int i = 0; i < N_DRAWS; i++) {
        double n[3], s[3], t[3], c[3];
        draw3(n, &seed);
        if (i < 6) /* the axes are where a choice of helper vector goes wrong */
            brc_set(n, i % 3 == 0 ? 1 - i / 3 * 2 : 0, i % 3 == 1 ? 1 - i / 3 * 2 : 0,
                    i % 3 == 2 ? 1 - i / 3 * 2 : 0);
        brc_normalise(n, n);
        brc_frame(s, t, n);
        brc_cross(c, s, t);
        CHECK_NEAR_ARRAY(c, n, 3, ROUND, 0);
        CHECK_NEAR(brc_norm(s), 1, ROUND, 0);
        CHECK_NEAR(brc_dot(s, n), 0, ROUND, 0);
    }
}

static void rotation_by_hand(void **state)
{
    /* a quarter turn about z takes x to y; scalar first, body to space */
    double q[4], r[3], m[3][3];
    (void)state;
    brc_quat_from_rotation(q, (double[3]){0, 0, BRC_PI / 2});
    CHECK_NEAR_ARRAY(q, ((double[4]){sqrt(0.5), 0, 0, sqrt(0.5)}), 4, ROUND, 0);
    brc_quat_rotate(r, q, (double[3]){1, 0, 0});
    CHECK_NEAR_ARRAY(r, ((double[3]){0, 1, 0}), 3, ROUND, 0);
    brc_quat_matrix(m, q);
    brc_mat_mul_t(r, m, (double[3]){0, 1, 0});
    CHECK_NEAR_ARRAY(r, ((double[3]){1, 0, 0}), 3, ROUND, 0);
}

static void quaternion_is_its_matrix(void **state)
{
    uint64_t seed = 11;
    (void)state;
    for (int i = 0; i < N_DRAWS; i++) {
        double a[4], b[4], ab[4], ma[3][3], mb[3][3], x[3], u[3], v[3], w[3];
        draw_quat(a, &seed);
        draw_quat(b, &seed);
        draw3(x, &seed);
        brc_quat_mul(ab, a, b);
        brc_quat_matrix(ma, a);
        brc_quat_matrix(mb, b);
        brc_mat_mul(u, mb, x);
        brc_mat_mul(v, ma, u);
        brc_quat_rotate(w, ab, x);
        CHECK_NEAR_ARRAY(w, v, 3, 4 * ROUND, 0);
        brc_mat_mul_t(u, ma, v); /* the transpose is the inverse */
        brc_mat_mul(w, ma, u);
        CHECK_NEAR_ARRAY(w, v, 3, 4 * ROUND, 0);
    }
}

static void point_velocity_is_the_derivative(void **state)
{
    const double v[3] = {0.1, -0.2, 0.3}, w[3] = {1, 0.5, -2}, r[3] = {0.4, 0.2, 0.1};
    double u[3], q[4], after[3], before[3], phi[3], h = 1e-5;
    (void)state;
    brc_point_velocity(u, v, w, r);
    for (int sign = -1; sign <= 1; sign += 2) {
        brc_scale(phi, w, sign * h);
        brc_quat_from_rotation(q, phi);
        brc_quat_rotate(sign > 0 ? after : before, q, r);
    }
    brc_sub(after, after, before);
    brc_scale(after, after, 0.5 / h);
    brc_add(after, after, v);
    /* central difference: |w|^3 |r| h^2 / 6 = 1e-10, and round-off / h = 1e-11 */
    CHECK_NEAR_ARRAY(u, after, 3, 1e-9, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_by_hand),
        cmocka_unit_test(outputs_may_alias),
        cmocka_unit_test(zero_vector_stays_zero),
        cmocka_unit_test(frames_are_right_handed),
        cmocka_unit_test(rotation_by_hand),
        cmocka_unit_test(quaternion_is_its_matrix),
        cmocka_unit_test(point_velocity_is_the_derivative),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
