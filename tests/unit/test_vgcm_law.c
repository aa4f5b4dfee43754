/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The point law against hand values: Table 1 of the paper, energies, unloading, friction. */
#include "tests/near.h"

#include "vgcm/law.h"

static const double AREA = 2e-6, DISTANCE = 5.1017e-3;
enum {
    SOFT = VGCM_LEDGER,
    LOSSES = VGCM_LEDGER | VGCM_LOSSES,
    BRITTLE = VGCM_LEDGER | VGCM_BRITTLE
};

static struct vgcm_law paper_law(void)
{
    struct vgcm_law law = {.e_bar = 48.8e9,
                           .eta = 0.125,
                           .mu = 0.05,
                           .sigma_t = 11.4e6,
                           .tau = 88.5e6,
                           .g_fn = 64.6,
                           .g_fs = 31114.4};
    vgcm_law_softening(&law, 0.25, 0.75);
    return law;
}

static double strength_at(const struct vgcm_law *law, double damage)
{
    return vgcm_lanes_strength(law, 0, brc_lanes_all(damage))[0];
}

static double damage_of(const struct vgcm_point *p)
{
    return fmin(p->dn + p->ds, 1);
}

/* What was added up over steps [J]. */
struct energy {
    double bond, normal, shear, damage, friction;
};

/* One point alone, by the lines that the loop has: the point is in all lanes. */
static void step_point(const struct vgcm_bond *bond, int flags, double area, const double du[3],
                       struct vgcm_point *p, struct energy *e)
{
    double kn = bond->kn * area, ks = bond->ks * area, inv = ks > 0 ? 1 / ks : 0;
    double s = p->fs * inv - du[1], t = p->ft * inv - du[2];
    struct vgcm_point_lanes q = {.dn = brc_lanes_all(p->dn),
                                 .ds = brc_lanes_all(p->ds),
                                 .un = brc_lanes_all(p->un + du[0]),
                                 .un_old = brc_lanes_all(p->un),
                                 .damage_old = brc_lanes_all(p->dn + p->ds),
                                 .s_old = brc_lanes_all(p->fs * inv),
                                 .t_old = brc_lanes_all(p->ft * inv),
                                 .s = brc_lanes_all(s),
                                 .t = brc_lanes_all(t),
                                 .force2 = brc_lanes_all(s * s + t * t)};
    struct vgcm_energy_lanes sum = {.bond = brc_lanes_all(0)};
    brc_lanes all[VGCM_N_BOND];
    vgcm_lanes_bond(all, bond->law, brc_lanes_all(bond->kn));
    vgcm_lanes_open(bond->law, all, flags, &q);
    vgcm_lanes_slide(bond->law, all, flags, &q);
    p->dissipated += vgcm_lanes_account(bond->law, all, flags, brc_lanes_all(area), &q, &sum)[0];
    p->un = q.un[0];
    p->fn = kn * q.normal_force[0];
    p->fs = ks * (q.shear_ratio[0] * s);
    p->ft = ks * (q.shear_ratio[0] * t);
    p->dn = q.dn[0];
    p->ds = q.ds[0];
    e->bond += sum.bond[0];
    e->normal += sum.normal[0];
    e->shear += sum.shear[0];
    e->damage += sum.damage[0];
    e->friction += sum.friction[0];
}

struct drive {
    struct vgcm_bond bond;
    double u0, wn, ws; /* m, opening at the peak; displacements past it at which damage is 1 */
    int flags;
    struct vgcm_point p;
    struct energy e;
    double work; /* J, by the trapezoid rule */
};

static struct drive begin(const struct vgcm_law *law, int flags)
{
    brc_lanes all[VGCM_N_BOND];
    struct drive d = {.bond = vgcm_springs_of(law, law->e_bar / DISTANCE), .flags = flags};
    vgcm_lanes_bond(all, law, brc_lanes_all(d.bond.kn));
    d.u0 = all[VGCM_U0][0];
    d.wn = 1 / all[VGCM_PER_WN][0];
    d.ws = 1 / all[VGCM_PER_WS][0];
    return d;
}

/* Moves the point by (opening, slips) in n equal steps. */
static void drive(struct drive *d, double open, double s, double t, int n)
{
    const double du[3] = {open / n, s / n, t / n};
    for (int i = 0; i < n; i++) {
        double fn = d->p.fn, fs = d->p.fs, ft = d->p.ft;
        step_point(&d->bond, d->flags, AREA, du, &d->p, &d->e);
        d->work += 0.5 * ((fn + d->p.fn) * du[0] - (fs + d->p.fs) * du[1] - (ft + d->p.ft) * du[2]);
    }
}

/* All the work is either stored or dissipated. */
static void check_balance(const struct drive *d)
{
    double sum = d->e.bond + d->e.normal + d->e.shear + d->e.damage + d->e.friction;
    CHECK_NEAR(sum, d->work, 1e-12 * fabs(d->e.damage), 1e-9);
}

static void elastic_energies_are_those_of_table_1(void **state)
{
    struct vgcm_law law = paper_law();
    double kn = law.e_bar / DISTANCE;
    (void)state;
    CHECK_NEAR(vgcm_law_elastic_n(&law, kn), 6.79, 0.005, 0);
    CHECK_NEAR(vgcm_law_elastic_s(&law, kn), 3275.2, 0.3, 0);
    CHECK_NEAR(9.5 * 6.8, law.g_fn, 1e-9, 0);
    CHECK_NEAR(9.5 * 3275.2, law.g_fs, 1e-9, 0);
}

static void softening_curve_has_its_kink_and_area(void **state)
{
    static const double shape[][3] = {{0.25, 0.75, 5}, {1.0 / 3, 0.8, 3.6}, {0.5, 1, 2}};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct vgcm_law law = paper_law();
        double area = 0;
        int n = 100000;
        vgcm_law_softening(&law, shape[i][0], shape[i][1]);
        CHECK_NEAR(law.wc, shape[i][2], 0, 1e-14);
        CHECK_NEAR(law.kink * law.wc, shape[i][1], 0, 1e-14);
        CHECK_NEAR(strength_at(&law, 0), 1, 0, 0);
        CHECK_NEAR(strength_at(&law, law.kink), shape[i][0], 0, 1e-14);
        CHECK_NEAR(strength_at(&law, 1), 0, 0, 0);
        for (int k = 0; k < n; k++)
            area += strength_at(&law, (k + 0.5) / n) * law.wc / n;
        CHECK_NEAR(area, 1, 0, 1e-8);
    }
}

static void elastic_point(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    (void)state;
    drive(&d, 1e-7, 2e-7, -3e-7, 1);
    double kn = law.e_bar / DISTANCE * AREA, ks = 0.125 * kn;
    CHECK_NEAR(d.p.fn, kn * 1e-7, 0, 1e-14);
    CHECK_NEAR(d.p.fs, -ks * 2e-7, 0, 1e-14);
    CHECK_NEAR(d.p.ft, ks * 3e-7, 0, 1e-14);
    CHECK_NEAR(d.e.bond, kn * 1e-14 / 2 + ks * 13e-14 / 2, 0, 1e-13);
    CHECK_NEAR(d.e.damage + d.e.friction, 0, 0, 0);
    drive(&d, -3e-7, 0, 0, 1);
    CHECK_NEAR(d.p.fn, -kn * 2e-7, 0, 1e-14);
    check_balance(&d);
}

static void tension_peaks_at_the_strength_and_takes_the_fracture_energy(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    double peak = 0, u_end = d.u0 + d.wn;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        drive(&d, 1.001 * u_end / 20000, 0, 0, 1);
        peak = fmax(peak, d.p.fn);
    }
    CHECK_NEAR(peak, 11.4e6 * AREA, 0, 1e-3);
    assert_true(damage_of(&d.p) == 1 && d.p.fn == 0);
    CHECK_NEAR(d.work, 64.6 * AREA, 0, 1e-6);
    CHECK_NEAR(d.e.damage, 64.6 * AREA, 0, 1e-6);
    CHECK_NEAR(d.p.dissipated, d.e.damage, 0, 1e-12);
    CHECK_NEAR(d.e.bond + d.e.normal, 0, 1e-9 * d.work, 0);
    check_balance(&d);
}

static void shear_takes_the_fracture_energy_in_any_direction(void **state)
{
    struct vgcm_law law = paper_law();
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct drive d = begin(&law, SOFT);
        double end = 1.001 * (law.tau / d.bond.ks + d.ws), angle = 0.7 * i, peak = 0;
        for (int k = 0; k < 20000; k++) {
            drive(&d, 0, end * cos(angle) / 20000, end * sin(angle) / 20000, 1);
            peak = fmax(peak, hypot(d.p.fs, d.p.ft));
        }
        CHECK_NEAR(peak, 88.5e6 * AREA, 0, 1e-3);
        assert_true(damage_of(&d.p) >= 1 && d.p.ds > d.p.dn);
        CHECK_NEAR(d.work, 31114.4 * AREA, 0, 1e-6);
        CHECK_NEAR(d.p.dissipated, 31114.4 * AREA, 0, 1e-6);
        check_balance(&d);
    }
}

static void post_peak_energies_add_the_elastic_part(void **state)
{
    struct vgcm_law law = paper_law();
    law.is_post_peak = 1;
    struct drive d = begin(&law, SOFT);
    (void)state;
    drive(&d, 1.001 * (d.u0 + d.wn), 0, 0, 20000);
    CHECK_NEAR(d.work, (64.6 + vgcm_law_elastic_n(&law, d.bond.kn)) * AREA, 0, 1e-6);
}

static void brittle_points_lose_all_at_once(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, BRITTLE), s = begin(&law, BRITTLE);
    (void)state;
    drive(&d, 0.999 * d.u0, 0, 0, 1000);
    assert_true(d.p.fn > 0.99 * 11.4e6 * AREA && damage_of(&d.p) == 0);
    drive(&d, 0.002 * d.u0, 0, 0, 2);
    assert_true(d.p.fn == 0 && damage_of(&d.p) == 1 && d.p.dn > d.p.ds);
    CHECK_NEAR(d.e.damage, vgcm_law_elastic_n(&law, d.bond.kn) * AREA, 0, 3e-3);
    check_balance(&d);
    double us = law.tau / s.bond.ks;
    drive(&s, 0, 1.001 * us, 0, 1001);
    assert_true(s.p.fs == 0 && s.p.ds > s.p.dn);
    CHECK_NEAR(s.p.dissipated, vgcm_law_elastic_s(&law, s.bond.kn) * AREA, 0, 3e-3);
    check_balance(&s);
}

static void tension_unloads_by_the_secant(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    (void)state;
    double most = d.u0 + 0.1 * d.wn;
    drive(&d, most, 0, 0, 1000);
    double force = d.p.fn, damaged = d.e.damage;
    CHECK_NEAR(force, AREA * 11.4e6 * strength_at(&law, 0.1), 0, 1e-9);
    drive(&d, -most / 2, 0, 0, 10);
    CHECK_NEAR(d.p.fn, force / 2, 0, 1e-9);
    drive(&d, -most, 0, 0, 10);
    CHECK_NEAR(d.p.fn, -d.bond.kn * AREA * most / 2, 0, 1e-9); /* compression is not weakened */
    drive(&d, most * 1.5, 0, 0, 30);
    CHECK_NEAR(d.p.fn, force, 0, 1e-9);
    CHECK_NEAR(d.e.damage, damaged, 1e-18, 1e-9);
    check_balance(&d);
}

static void shear_unloads_elastically(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    (void)state;
    drive(&d, 0, law.tau / d.bond.ks + 0.1 * d.ws, 0, 1000);
    double force = d.p.fs, damage = damage_of(&d.p);
    CHECK_NEAR(damage, 0.1, 1e-9, 0);
    CHECK_NEAR(force, -AREA * 88.5e6 * strength_at(&law, 0.1), 0, 1e-6);
    drive(&d, 0, -1e-6, 0, 10);
    CHECK_NEAR(d.p.fs - force, d.bond.ks * AREA * 1e-6, 0, 1e-9);
    CHECK_NEAR(damage_of(&d.p), damage, 0, 0);
    check_balance(&d);
}

static void damage_is_shared(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    (void)state;
    drive(&d, 0, law.tau / d.bond.ks + 0.4 * d.ws, 0, 4000);
    double ds = d.p.ds, peak = 0;
    for (int i = 0; i < 3000; i++) {
        drive(&d, d.u0 / 1000, 0, 0, 1);
        peak = fmax(peak, d.p.fn);
    }
    CHECK_NEAR(ds, 0.4, 1e-9, 0);
    CHECK_BETWEEN(peak, 0.8 * AREA * 11.4e6 * strength_at(&law, 0.4),
                  1.001 * AREA * 11.4e6 * strength_at(&law, 0.4));
    double end = d.u0 + 0.7 * d.wn;
    drive(&d, end - d.p.un, 0, 0, 1000);
    assert_true(damage_of(&d.p) == 1 && d.p.dn < 1 && d.p.ds < 1);
    assert_true(d.p.fn == 0 && d.p.fs == 0);
    check_balance(&d);
}

/* One kind of damage alone: the same point, whichever way the two would add. */
static void one_damage_alone_adds_nothing(void **state)
{
    struct vgcm_law law = paper_law();
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct drive d = begin(&law, SOFT), own = begin(&law, LOSSES);
        double open = i == 0 ? d.u0 + d.wn : 0;
        double slip = i == 1 ? law.tau / d.bond.ks + d.ws : 0;
        for (int k = 0; k < 2000; k++) {
            drive(&d, 1.01 * open / 2000, 1.01 * slip / 2000, 0, 1);
            drive(&own, 1.01 * open / 2000, 1.01 * slip / 2000, 0, 1);
            CHECK_NEAR(own.p.fn, d.p.fn, 1e-12 * AREA * law.sigma_t, 1e-12);
            CHECK_NEAR(own.p.fs, d.p.fs, 1e-12 * AREA * law.tau, 1e-12);
        }
        CHECK_NEAR(own.p.dissipated, (i == 0 ? law.g_fn : law.g_fs) * AREA, 0, 1e-4);
        check_balance(&own);
    }
}

/* A slip of 0.05 of its end costs 1/4 of both strengths; an opening of 0.08 of its end 0.4 more; at
 * 0.15 nothing is left, where parts of displacements would break at 0.95. */
static void losses_of_strength_add(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, LOSSES), s;
    const double left = 1 - 0.25 - 0.4;
    (void)state;
    drive(&d, 0, law.tau / d.bond.ks + 0.05 * d.ws, 0, 4000);
    CHECK_NEAR(d.p.ds, 0.05, 1e-9, 0);
    CHECK_NEAR(-d.p.fs, 0.75 * AREA * law.tau, 0, 1e-9);
    drive(&d, d.u0 + 0.08 * d.wn, 0, 0, 8000);
    CHECK_NEAR(d.p.dn, 0.08, 1e-9, 0);
    s = d;
    /* the shear force is cut back to what the opening leaves: some of it slips, and costs more */
    double lost = 5 * (d.p.ds - 0.05);
    CHECK_NEAR(d.p.fn, (left - lost) * AREA * law.sigma_t, 0, 1e-6);
    CHECK_NEAR(-d.p.fs, (left - lost) * AREA * law.tau - law.mu * d.p.fn, 0, 1e-6);
    assert_true(vgcm_law_is_whole(&law, LOSSES, d.p.dn, d.p.ds));
    drive(&d, 0.07 * d.wn, 0, 0, 4000);
    assert_false(vgcm_law_is_whole(&law, LOSSES, d.p.dn, d.p.ds));
    assert_true(d.p.fn == 0 && d.p.fs == 0 && d.p.dn < 0.15 && d.p.dn + d.p.ds < 0.3);
    check_balance(&d);
    double dn = d.p.dn;
    drive(&d, 0.2 * d.wn, 1e-5, 0, 100); /* for good */
    assert_true(d.p.dn == dn && d.p.fn == 0 && d.p.fs == 0);
    drive(&s, -(s.u0 + 0.08 * s.wn) / 2, 0, 0, 100); /* tension unloads by the secant */
    CHECK_NEAR(s.p.fn, (left - lost) * AREA * law.sigma_t / 2, 0, 1e-6);
    check_balance(&s);
}

static void compression_raises_the_shear_strength(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    (void)state;
    law.mu = 0.5;
    drive(&d, -2e-6, 0, 0, 1);
    double push = -d.p.fn, peak = 0;
    double end = law.tau / d.bond.ks + d.ws + push / AREA / d.bond.ks;
    for (int i = 0; i < 4000; i++) {
        drive(&d, 0, 1.5 * end / 4000, 0, 1);
        peak = fmax(peak, -d.p.fs);
    }
    CHECK_NEAR(peak, AREA * 88.5e6 + 0.5 * push, 0, 2e-3);
    CHECK_NEAR(-d.p.fs, 0.5 * push, 0, 1e-9); /* the residual is friction alone */
    CHECK_NEAR(d.e.damage, 31114.4 * AREA, 0, 2e-3);
    assert_true(d.e.friction > 0.5 * push * 0.5 * end);
    check_balance(&d);
}

static void broken_points_push_and_rub_only(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT);
    (void)state;
    d.p.dn = 1;
    drive(&d, 1e-6, 1e-6, 0, 10);
    assert_true(d.p.fn == 0 && d.p.fs == 0);
    drive(&d, -3e-6, 0, 0, 3); /* closes again */
    CHECK_NEAR(d.p.fn, -d.bond.kn * AREA * 2e-6, 0, 1e-9);
    drive(&d, 0, 3e-5, 4e-5, 200);
    double limit = 0.05 * -d.p.fn;
    CHECK_NEAR(d.p.fs, -0.6 * limit, 0, 1e-9);
    CHECK_NEAR(d.p.ft, -0.8 * limit, 0, 1e-9);
    CHECK_BETWEEN(d.e.friction, 0.9 * limit * 5e-5, limit * 5e-5);
    drive(&d, 3e-6, 0, 0, 300);
    assert_true(d.p.fn == 0 && d.p.fs == 0 && d.p.ft == 0);
    CHECK_NEAR(d.e.damage, 0, 0, 0);
    check_balance(&d);
}

static void broken_points_follow_their_own_law(void **state)
{
    struct vgcm_law law = paper_law();
    struct drive d = begin(&law, SOFT), own = begin(&law, SOFT);
    struct vgcm_energy_lanes e = {.bond = brc_lanes_all(0)};
    double scale = d.bond.kn * AREA * 1e-6;
    (void)state;
    d.p.dn = own.p.dn = 1;
    for (int i = 0; i < 3000; i++) {
        const double du[3] = {4e-8 * sin(0.01 * i), 2e-7 * cos(0.003 * i), 1e-7 * sin(0.02 * i)};
        step_point(&d.bond, SOFT, AREA, du, &d.p, &d.e);
        vgcm_law_friction(&own.bond, AREA, du, &own.p, &e);
        CHECK_NEAR(own.p.fn, d.p.fn, 1e-12 * scale, 1e-12);
        CHECK_NEAR(own.p.fs, d.p.fs, 1e-12 * scale, 1e-12);
        CHECK_NEAR(own.p.ft, d.p.ft, 1e-12 * scale, 1e-12);
    }
    assert_true(d.e.friction > 0);
    CHECK_NEAR(e.friction[0], d.e.friction, 0, 1e-11);
    CHECK_NEAR(e.normal[0], d.e.normal, 1e-12 * d.e.friction, 1e-11);
    CHECK_NEAR(e.shear[0], d.e.shear, 1e-12 * d.e.friction, 1e-11);
}

static void no_shear_stiffness_means_no_shear(void **state)
{
    struct vgcm_law law = paper_law();
    law.eta = 0;
    struct drive d = begin(&law, SOFT);
    (void)state;
    drive(&d, 2 * (d.u0 + d.wn), 1e-3, 0, 1000);
    assert_true(d.p.fs == 0 && d.p.ds == 0 && damage_of(&d.p) == 1);
    CHECK_NEAR(d.e.damage, 64.6 * AREA, 0, 1e-3);
}

static void ledger_does_not_change_the_motion(void **state)
{
    struct vgcm_law law = paper_law();
    (void)state;
    for (int brittle = 0; brittle < 2; brittle++) {
        int flags = brittle ? VGCM_BRITTLE : 0;
        struct drive a = begin(&law, flags), b = begin(&law, flags | VGCM_LEDGER);
        for (int i = 0; i < 3000; i++) {
            double open = 4e-8 * sin(0.01 * i), slip = 2e-6 * cos(0.003 * i);
            drive(&a, open, slip, open, 1);
            drive(&b, open, slip, open, 1);
            assert_memory_equal(&a.p, &b.p, sizeof a.p);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elastic_energies_are_those_of_table_1),
        cmocka_unit_test(softening_curve_has_its_kink_and_area),
        cmocka_unit_test(elastic_point),
        cmocka_unit_test(tension_peaks_at_the_strength_and_takes_the_fracture_energy),
        cmocka_unit_test(shear_takes_the_fracture_energy_in_any_direction),
        cmocka_unit_test(post_peak_energies_add_the_elastic_part),
        cmocka_unit_test(brittle_points_lose_all_at_once),
        cmocka_unit_test(tension_unloads_by_the_secant),
        cmocka_unit_test(shear_unloads_elastically),
        cmocka_unit_test(damage_is_shared),
        cmocka_unit_test(one_damage_alone_adds_nothing),
        cmocka_unit_test(losses_of_strength_add),
        cmocka_unit_test(compression_raises_the_shear_strength),
        cmocka_unit_test(broken_points_push_and_rub_only),
        cmocka_unit_test(broken_points_follow_their_own_law),
        cmocka_unit_test(no_shear_stiffness_means_no_shear),
        cmocka_unit_test(ledger_does_not_change_the_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
