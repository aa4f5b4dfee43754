/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bond and collision law of the polyhedra model against hand values. */
#include "tests/near.h"
#include "tests/rotate.h"

#include "polyhedra/poly.h"

/* The laws are written for four contacts side by side: here they are all the same, and one is read.
 */
struct pose {
    double pa[3], pb[3]; /* material points on a and b */
    double na[3], nb[3]; /* outward normals of the two faces */
    double ta[3], tb[3]; /* tangents that were one at the start */
};

struct result {
    double n[3], f[3], m, x[3], term[3], energy, use;
};

static double theta_th = 0.05;

static void bond_law(struct result *r, const struct pose *p, bool torsion)
{
    struct poly_bonds4 bonds = {.kn = brc_lanes_all(100),
                                .kt = brc_lanes_all(40),
                                .ktheta = brc_lanes_all(torsion ? 7 : 0),
                                .length = brc_lanes_all(0.5),
                                .eps_th = 0.02,
                                .theta_th = theta_th};
    struct poly_bond_pose4 pose = {.twist = brc_lanes_all(0)};
    struct poly_bond_state4 all;
    brc_lanes na[3], nb[3], ta[3], tb[3];
    poly_all3(pose.pa, p->pa);
    poly_all3(pose.pb, p->pb);
    poly_all3(na, p->na);
    poly_all3(nb, p->nb);
    poly_all3(ta, p->ta);
    poly_all3(tb, p->tb);
    poly_mean_normal(pose.n, na, nb);
    poly_arm_of_pair(&pose);
    if (torsion)
        pose.twist = poly_twist(pose.n, ta, tb, brc_lanes_first(BRC_LANES));
    poly_bond_law(&all, &bonds, &pose);
    poly_lane3(r->n, pose.n, 0);
    poly_lane3(r->f, all.f, 0);
    poly_lane3(r->x, pose.arm, 0);
    poly_lane3(r->term, all.term, 0);
    r->m = all.m[0];
    r->energy = all.energy[0];
    r->use = poly_bond_use(&all)[0];
}

static int mode(const struct result *r)
{
    struct poly_bond bond = {.energy = r->energy};
    brc_copy(bond.term, r->term);
    return poly_bond_mode(&bond);
}

/* Two faces in contact at the origin, a below b. */
static struct pose pose_at_rest(void)
{
    return (struct pose){.na = {0, 0, 1}, .nb = {0, 0, -1}, .ta = {1, 0, 0}, .tb = {1, 0, 0}};
}

static void turn(double v[3], const double q[4])
{
    double r[3];
    brc_quat_rotate(r, q, v);
    brc_copy(v, r);
}

static void turn_pose(struct pose *p, const double q[4])
{
    double *vectors[] = {p->pa, p->pb, p->na, p->nb, p->ta, p->tb};
    for (int i = 0; i < 6; i++)
        turn(vectors[i], q);
}

static void test_bond_values(void **state)
{
    (void)state;
    struct pose p = pose_at_rest();
    struct result r;
    brc_set(p.pb, 0.003, 0, 0.002);
    bond_law(&r, &p, true);
    CHECK_NEAR_ARRAY(r.n, ((double[]){0, 0, 1}), 3, 1e-15, 0);
    CHECK_NEAR_ARRAY(r.f, ((double[]){-0.12, 0, -0.2}), 3, 1e-15, 0);
    CHECK_NEAR_ARRAY(r.x, ((double[]){0.0015, 0, 0.001}), 3, 1e-15, 0);
    CHECK_NEAR(r.energy, 0.5 * (100 * 4e-6 + 40 * 9e-6), 1e-15, 0);
    CHECK_NEAR_ARRAY(r.term, ((double[]){0.2, 0.3, 0}), 3, 1e-14, 0);
    assert_false(r.use > 1);
    assert_int_equal(mode(&r), 1);
    /* closed: the ramp of eq 12, in force, energy and eq 15 */
    brc_set(p.pb, 0.003, 0, -0.02);
    bond_law(&r, &p, true);
    CHECK_NEAR_ARRAY(r.f, ((double[]){-0.12, 0, 0}), 3, 1e-15, 0);
    CHECK_NEAR(r.energy, 0.5 * 40 * 9e-6, 1e-15, 0);
    CHECK_NEAR(r.term[0], 0, 0, 0);
}

static void test_torsion(void **state)
{
    (void)state;
    struct pose p = pose_at_rest();
    struct result r;
    brc_set(p.tb, cos(0.03), sin(0.03), 0);
    bond_law(&r, &p, true);
    CHECK_NEAR(r.m, -7 * 0.03, 1e-15, 0);
    CHECK_NEAR(r.energy, 0.5 * 7 * 9e-4, 1e-15, 0);
    CHECK_NEAR(r.term[2], 0.6, 1e-13, 0);
    assert_int_equal(mode(&r), 2);
    bond_law(&r, &p, false);
    CHECK_NEAR(r.m, 0, 0, 0);
    CHECK_NEAR(r.term[2], 0, 0, 0);
    theta_th = HUGE_VAL;
    bond_law(&r, &p, true);
    theta_th = 0.05;
    CHECK_NEAR(r.term[2], 0, 0, 0);
}

static void test_breaking(void **state)
{
    (void)state;
    struct pose p = pose_at_rest();
    struct result r;
    brc_set(p.pb, 0.004, 0, 0.0059);
    bond_law(&r, &p, true);
    assert_false(r.use > 1);
    brc_set(p.pb, 0.004, 0, 0.0061);
    bond_law(&r, &p, true);
    assert_true(r.use > 1);
    assert_int_equal(mode(&r), 0);
    /* the sum of the three terms */
    brc_set(p.pb, 0.004, 0, 0.004);
    brc_set(p.tb, cos(0.0105), sin(0.0105), 0);
    bond_law(&r, &p, true);
    assert_true(r.use > 1);
}

/* A rigid rotation of the pair turns the force with it and changes nothing else. */
static void test_bond_is_objective(void **state)
{
    (void)state;
    struct pose p = pose_at_rest(), turned;
    struct result r, s;
    const double phi[3] = {1.1, -2, 0.7};
    double q[4], f[3];
    brc_set(p.pb, 0.003, -0.001, 0.002);
    brc_set(p.tb, cos(0.03), sin(0.03), 0);
    bond_law(&r, &p, true);
    brc_quat_from_rotation(q, phi);
    turned = p;
    turn_pose(&turned, q);
    bond_law(&s, &turned, true);
    brc_quat_rotate(f, q, r.f);
    CHECK_NEAR_ARRAY(s.f, f, 3, 1e-15, 0);
    CHECK_NEAR(s.m, r.m, 1e-14, 0);
    CHECK_NEAR(s.energy, r.energy, 1e-15, 0);
    /* at rest: no force at any angle */
    turned = pose_at_rest();
    turn_pose(&turned, q);
    bond_law(&s, &turned, true);
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

static void slide(double xi[3], const double n[3], const double du[3], double limit)
{
    brc_lanes all[3], normal[3], slip[3];
    poly_all3(all, xi);
    poly_all3(normal, n);
    poly_all3(slip, du);
    poly_slide_spring(all, normal, slip, brc_lanes_all(limit));
    poly_lane3(xi, all, 0);
}

static void turn_spring(double xi[3], const double n_old[3], const double n[3], double twirl)
{
    brc_lanes all[3], before[3], now[3];
    poly_all3(all, xi);
    poly_all3(before, n_old);
    poly_all3(now, n);
    poly_turn_spring(all, before, now, brc_lanes_all(0.5 * twirl));
    poly_lane3(xi, all, 0);
}

/* Viscosities 10 and 4 along and across n, with a normal force of 30. */
static void viscous(double f[3], const double n[3], const double u[3])
{
    struct poly_geometry4 t = {.delta = brc_lanes_all(0.3), .weight = brc_lanes_all(1)};
    brc_lanes all[3], slip[3];
    poly_all3(t.n, n);
    poly_all3(slip, u);
    poly_viscous_force(all, &t, 100, brc_lanes_all(10), brc_lanes_all(4), slip);
    poly_lane3(f, all, 0);
}

static double vertex_weight(const double v[3], const double u[3], double contact_distance,
                            double fade)
{
    const struct poly_lengths len = {.contact_distance = contact_distance, .fade = fade};
    struct poly_geometry4 t = {.delta = brc_lanes_all(0)};
    struct poly_fading f;
    brc_lanes at[3], other[3];
    poly_all3(at, v);
    poly_all3(other, u);
    poly_sub3(other, at, other);
    poly_fading_begin(&f);
    poly_fading_add(&f, other, brc_lanes_first(BRC_LANES), &len);
    poly_weigh_vertex(&t, at, brc_lanes_all(1), &f);
    return t.weight[0];
}

static void test_friction(void **state)
{
    (void)state;
    const double n[3] = {0, 0, 1};
    double xi[3] = {0, 0, 0};
    slide(xi, n, (double[]){3e-3, 0, 9}, 0.01);
    CHECK_NEAR_ARRAY(xi, ((double[]){3e-3, 0, 0}), 3, 1e-17, 0);
    slide(xi, n, (double[]){0, 4e-3, 0}, 0.01);
    CHECK_NEAR_ARRAY(xi, ((double[]){3e-3, 4e-3, 0}), 3, 1e-17, 0);
    /* capped along xi, and the capped value stays: going back acts at once */
    slide(xi, n, (double[]){3, 4, 0}, 0.01);
    CHECK_NEAR_ARRAY(xi, ((double[]){6e-3, 8e-3, 0}), 3, 1e-5, 0);
    CHECK_NEAR(brc_norm(xi), 0.01, 1e-17, 0);
    slide(xi, n, (double[]){-6e-3, 0, 0}, 0.01);
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
        turn_spring(xi, n_old, n, brc_dot(w, n) / steps);
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
    viscous(f, n, (double[]){0.5, 0, -2});
    CHECK_NEAR_ARRAY(f, ((double[]){-2, 0, 20}), 3, 1e-15, 0);
    /* apart: never more than the elastic force */
    viscous(f, n, (double[]){0, 0, 2});
    CHECK_NEAR(f[2], -20, 1e-15, 0);
    viscous(f, n, (double[]){0, 0, 5});
    CHECK_NEAR(f[2], -30, 1e-15, 0);
}

static void test_weights(void **state)
{
    (void)state;
    brc_lanes slope;
    const double u[3] = {0, 0, 0}, rest = 0.2, ell = 0.1;
    CHECK_NEAR(poly_smooth(brc_lanes_all(-1), &slope)[0], 0, 0, 0);
    CHECK_NEAR(poly_smooth(brc_lanes_all(0.5), &slope)[0], 0.5, 1e-15, 0);
    CHECK_NEAR(slope[0], 1.5, 1e-15, 0);
    CHECK_NEAR(poly_smooth(brc_lanes_all(2), &slope)[0], 1, 0, 0);
    /* half at a vertex in range, one far away, never beyond */
    const double at[3] = {0, 0, rest}, far[3] = {ell, 0, rest},
                 middle[3] = {ell / sqrt(2), 0, rest};
    CHECK_NEAR(vertex_weight(at, u, rest, ell), 0.5, 0, 0);
    CHECK_NEAR(vertex_weight(far, u, rest, ell), 1, 1e-12, 0);
    CHECK_NEAR(vertex_weight(middle, u, rest, ell), 0.75, 1e-12, 0);
    const brc_lanes one = brc_lanes_all(1);
    CHECK_NEAR(poly_edge_weight(brc_lanes_all(0), one, 10, &slope)[0], 0, 0, 0);
    CHECK_NEAR(poly_edge_weight(brc_lanes_all(0.5), one, 10, &slope)[0], 1, 0, 0);
    CHECK_NEAR(poly_edge_weight(brc_lanes_all(0.95), one, 10, &slope)[0], 0.5, 1e-14, 0);
    CHECK_NEAR(slope[0], -15, 1e-12, 0);
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
