/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bond and collision law of the polyhedra model against hand values. */
#include "tests/near.h"

#include "polyhedra/bond.h"
#include "polyhedra/contact.h"

static const struct poly_bond bond = {
    .kn = 100, .kt = 40, .ktheta = 7, .length = 0.5, .eps_th = 0.02, .theta_th = 0.05};

/* Two faces in contact at the origin, a below b. */
static struct poly_bond_pose pose_at_rest(void)
{
    return (struct poly_bond_pose){
        .na = {0, 0, 1}, .nb = {0, 0, -1}, .ta = {1, 0, 0}, .tb = {1, 0, 0}};
}

static void turn(double v[3], const double q[4])
{
    double r[3];
    brc_quat_rotate(r, q, v);
    brc_copy(v, r);
}

static void turn_pose(struct poly_bond_pose *p, const double q[4])
{
    double *vectors[] = {p->pa, p->pb, p->na, p->nb, p->ta, p->tb};
    for (int i = 0; i < 6; i++)
        turn(vectors[i], q);
}

static void test_bond_values(void **state)
{
    (void)state;
    struct poly_bond_pose p = pose_at_rest();
    struct poly_bond_result r;
    brc_set(p.pb, 0.003, 0, 0.002);
    poly_bond_law(&r, &bond, &p, true);
    CHECK_NEAR_ARRAY(r.n, ((double[]){0, 0, 1}), 3, 1e-15, 0);
    CHECK_NEAR_ARRAY(r.f, ((double[]){-0.12, 0, -0.2}), 3, 1e-15, 0);
    CHECK_NEAR_ARRAY(r.x, ((double[]){0.0015, 0, 0.001}), 3, 1e-15, 0);
    CHECK_NEAR(r.energy, 0.5 * (100 * 4e-6 + 40 * 9e-6), 1e-15, 0);
    CHECK_NEAR_ARRAY(r.term, ((double[]){0.2, 0.3, 0}), 3, 1e-14, 0);
    assert_false(poly_bond_breaks(&r));
    assert_int_equal(poly_bond_mode(&r), 1);
    /* closed: the ramp of eq 12, in force, energy and eq 15 */
    brc_set(p.pb, 0.003, 0, -0.02);
    poly_bond_law(&r, &bond, &p, true);
    CHECK_NEAR_ARRAY(r.f, ((double[]){-0.12, 0, 0}), 3, 1e-15, 0);
    CHECK_NEAR(r.energy, 0.5 * 40 * 9e-6, 1e-15, 0);
    CHECK_NEAR(r.term[0], 0, 0, 0);
}

static void test_torsion(void **state)
{
    (void)state;
    struct poly_bond_pose p = pose_at_rest();
    struct poly_bond_result r;
    brc_set(p.tb, cos(0.03), sin(0.03), 0);
    poly_bond_law(&r, &bond, &p, true);
    CHECK_NEAR(r.m, -7 * 0.03, 1e-15, 0);
    CHECK_NEAR(r.energy, 0.5 * 7 * 9e-4, 1e-15, 0);
    CHECK_NEAR(r.term[2], 0.6, 1e-13, 0);
    assert_int_equal(poly_bond_mode(&r), 2);
    poly_bond_law(&r, &bond, &p, false);
    CHECK_NEAR(r.m, 0, 0, 0);
    CHECK_NEAR(r.term[2], 0, 0, 0);
    struct poly_bond unlimited = bond;
    unlimited.theta_th = HUGE_VAL;
    poly_bond_law(&r, &unlimited, &p, true);
    CHECK_NEAR(r.term[2], 0, 0, 0);
}

static void test_breaking(void **state)
{
    (void)state;
    struct poly_bond_pose p = pose_at_rest();
    struct poly_bond_result r;
    brc_set(p.pb, 0.004, 0, 0.0059);
    poly_bond_law(&r, &bond, &p, true);
    assert_false(poly_bond_breaks(&r));
    brc_set(p.pb, 0.004, 0, 0.0061);
    poly_bond_law(&r, &bond, &p, true);
    assert_true(poly_bond_breaks(&r));
    assert_int_equal(poly_bond_mode(&r), 0);
    /* the sum of the three terms */
    brc_set(p.pb, 0.004, 0, 0.004);
    brc_set(p.tb, cos(0.0105), sin(0.0105), 0);
    poly_bond_law(&r, &bond, &p, true);
    assert_true(poly_bond_breaks(&r));
}

/* A rigid rotation of the pair turns the force with it and changes nothing else. */
static void test_bond_is_objective(void **state)
{
    (void)state;
    struct poly_bond_pose p = pose_at_rest(), turned;
    struct poly_bond_result r, s;
    const double phi[3] = {1.1, -2, 0.7};
    double q[4], f[3];
    brc_set(p.pb, 0.003, -0.001, 0.002);
    brc_set(p.tb, cos(0.03), sin(0.03), 0);
    poly_bond_law(&r, &bond, &p, true);
    brc_quat_from_rotation(q, phi);
    turned = p;
    turn_pose(&turned, q);
    poly_bond_law(&s, &bond, &turned, true);
    brc_quat_rotate(f, q, r.f);
    CHECK_NEAR_ARRAY(s.f, f, 3, 1e-15, 0);
    CHECK_NEAR(s.m, r.m, 1e-14, 0);
    CHECK_NEAR(s.energy, r.energy, 1e-15, 0);
    /* at rest: no force at any angle */
    turned = pose_at_rest();
    turn_pose(&turned, q);
    poly_bond_law(&s, &bond, &turned, true);
    CHECK_NEAR(brc_norm(s.f), 0, 0, 0);
    CHECK_NEAR(s.m, 0, 1e-14, 0);
}

static void test_pair_stiffness(void **state)
{
    (void)state;
    CHECK_NEAR(poly_pair_stiffness(5, 5), 5, 0, 0);
    CHECK_NEAR(poly_pair_stiffness(2, 6), 3, 1e-15, 0);
    CHECK_NEAR(poly_pair_stiffness(0, 0), 0, 0, 0);
}

static void test_friction(void **state)
{
    (void)state;
    const double n[3] = {0, 0, 1};
    double xi[3] = {0, 0, 0};
    poly_slide(xi, n, (double[]){3e-3, 0, 9}, 0.01);
    CHECK_NEAR_ARRAY(xi, ((double[]){3e-3, 0, 0}), 3, 1e-17, 0);
    poly_slide(xi, n, (double[]){0, 4e-3, 0}, 0.01);
    CHECK_NEAR_ARRAY(xi, ((double[]){3e-3, 4e-3, 0}), 3, 1e-17, 0);
    /* capped along xi, and the capped value stays: going back acts at once */
    poly_slide(xi, n, (double[]){3, 4, 0}, 0.01);
    CHECK_NEAR_ARRAY(xi, ((double[]){6e-3, 8e-3, 0}), 3, 1e-5, 0);
    CHECK_NEAR(brc_norm(xi), 0.01, 1e-17, 0);
    poly_slide(xi, n, (double[]){-6e-3, 0, 0}, 0.01);
    CHECK_NEAR(brc_norm(xi), 8e-3, 1e-5, 0);
}

/* xi follows a contact that is turned as a whole: tilt and twirl. */
static void test_turning(void **state)
{
    (void)state;
    const double w[3] = {0.6, -0.3, 0.8};
    const int steps = 2000;
    double n[3] = {0, 0, 1}, xi[3] = {1e-3, 2e-3, 0}, q[4], expected[3];
    for (int i = 1; i <= steps; i++) {
        double phi[3], n_old[3], n_new[3] = {0, 0, 1};
        brc_copy(n_old, n);
        brc_scale(phi, w, i / (double)steps);
        brc_quat_from_rotation(q, phi);
        brc_quat_rotate(n_new, q, n_new);
        brc_copy(n, n_new);
        poly_turn(xi, n_old, n, brc_dot(w, n) / steps);
        CHECK_NEAR(brc_norm(xi), sqrt(5) * 1e-3, 1e-15, 1e-9);
    }
    brc_quat_rotate(expected, q, (double[]){1e-3, 2e-3, 0});
    CHECK_NEAR_ARRAY(xi, expected, 3, 1e-3 * 1e-3, 0);
}

static void test_viscous(void **state)
{
    (void)state;
    const double n[3] = {0, 0, 1};
    double f[3];
    poly_viscous(f, n, (double[]){0.5, 0, -2}, 10, 4, 30);
    CHECK_NEAR_ARRAY(f, ((double[]){-2, 0, 20}), 3, 1e-15, 0);
    /* apart: never more than the elastic force */
    poly_viscous(f, n, (double[]){0, 0, 2}, 10, 4, 30);
    CHECK_NEAR(f[2], -20, 1e-15, 0);
    poly_viscous(f, n, (double[]){0, 0, 5}, 10, 4, 30);
    CHECK_NEAR(f[2], -30, 1e-15, 0);
}

static void test_weights(void **state)
{
    (void)state;
    double slope, grad[3];
    const double u[1][3] = {{0, 0, 0}}, rest = 0.2, ell = 0.1;
    CHECK_NEAR(poly_smooth(-1, &slope), 0, 0, 0);
    CHECK_NEAR(poly_smooth(0.5, &slope), 0.5, 1e-15, 0);
    CHECK_NEAR(slope, 1.5, 1e-15, 0);
    CHECK_NEAR(poly_smooth(2, &slope), 1, 0, 0);
    /* half at a vertex in range, one far away, never beyond */
    const double at[3] = {0, 0, rest}, far[3] = {ell, 0, rest},
                 middle[3] = {ell / sqrt(2), 0, rest};
    CHECK_NEAR(poly_vertex_weight(at, u, 1, rest * rest, ell * ell, grad), 0.5, 0, 0);
    CHECK_NEAR(poly_vertex_weight(far, u, 1, rest * rest, ell * ell, grad), 1, 1e-12, 0);
    CHECK_NEAR(poly_vertex_weight(middle, u, 1, rest * rest, ell * ell, grad), 0.75, 1e-12, 0);
    CHECK_NEAR(poly_foot_weight(0, 1, 0.1, &slope), 0, 0, 0);
    CHECK_NEAR(poly_foot_weight(0.5, 1, 0.1, &slope), 1, 0, 0);
    CHECK_NEAR(poly_foot_weight(0.95, 1, 0.1, &slope), 0.5, 1e-14, 0);
    CHECK_NEAR(slope, -15, 1e-12, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bond_values),    cmocka_unit_test(test_torsion),
        cmocka_unit_test(test_breaking),       cmocka_unit_test(test_bond_is_objective),
        cmocka_unit_test(test_pair_stiffness), cmocka_unit_test(test_friction),
        cmocka_unit_test(test_turning),        cmocka_unit_test(test_viscous),
        cmocka_unit_test(test_weights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
