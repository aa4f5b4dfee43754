/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CI and CD of curves whose cracks open by a formula. */
#include "common/rigs/crack_stress.h"
#include "tests/near.h"

enum { N = 1001 };
static const double E = 50e9, nu = 0.25, ROW = 0.1e6;

struct curve {
    double stress[N], axial[N], lateral[N];
    struct brc_strains rows;
};

/* Elastic to `begin`, then the sides widen with the square of the stress beyond it, by so much that
 * the volume is least at `turn`. */
static void make(struct curve *c, double begin, double turn)
{
    double a = (1 - 2 * nu) / E / (4 * (turn - begin));
    for (int i = 0; i < N; i++) {
        double s = c->stress[i] = ROW * i, past = s > begin ? s - begin : 0;
        c->axial[i] = s / E;
        c->lateral[i] = -nu * s / E - a * past * past;
    }
    c->rows = (struct brc_strains){c->stress, c->axial, c->lateral, N};
}

static void test_stresses_of_a_formula(void **state)
{
    (void)state;
    struct curve c;
    struct brc_measured out[BRC_N_CRACK_STRESSES];
    const double begin = 40e6, turn = 75e6, wide = turn - begin;
    make(&c, begin, turn);
    brc_crack_stresses(&c.rows, E, nu, out);
    /* where the slope of the lateral strain is that of the straight line to CD */
    CHECK_NEAR(out[0].value, begin + wide * wide / (2 * turn), ROW, 0);
    /* 2 a past^2 is a hundredth of the elastic volumetric strain at 100 MPa */
    CHECK_NEAR(out[1].value, begin + sqrt(0.01 * 100e6 * 2 * wide), ROW, 0);
    CHECK_NEAR(out[2].value, turn, ROW, 0);
    for (int i = 0; i < BRC_N_CRACK_STRESSES; i++)
        assert_null(out[i].note);
    c.rows.n = 701; /* the peak comes first */
    brc_crack_stresses(&c.rows, E, nu, out);
    CHECK_NEAR(out[1].value, begin + sqrt(0.01 * 70e6 * 2 * wide), ROW, 0);
}

static void check_missing(const struct brc_measured *m, const char *note)
{
    assert_true(isnan(m->value) && m->note && strstr(m->note, note));
}

static void test_what_cannot_be_read(void **state)
{
    (void)state;
    struct curve c;
    struct brc_measured out[BRC_N_CRACK_STRESSES];
    make(&c, 40e6, 75e6);
    c.rows.n = 751; /* the volume is least in the last row */
    brc_crack_stresses(&c.rows, E, nu, out);
    check_missing(&out[0], "turned round");
    check_missing(&out[2], "turned round");
    assert_null(out[1].note);
    c.rows.n = 401; /* elastic to the end */
    brc_crack_stresses(&c.rows, E, nu, out);
    check_missing(&out[1], "had not left its largest value");
    make(&c, 40e6, 75e6);
    for (int i = 0; i < N; i++) { /* fast at first, then slower: below the line nowhere */
        c.lateral[i] = -1e-4 * sqrt(c.stress[i] / 100e6);
        c.axial[i] = c.stress[i] < 50e6 ? c.stress[i] * 4 / E : 50e6 * 4 / E;
    }
    brc_crack_stresses(&c.rows, E, nu, out);
    check_missing(&out[0], "grew no faster");
    CHECK_NEAR(out[2].value, 50e6, 0, 1e-12);
    for (int i = 0; i < N; i++) /* ever larger */
        c.axial[i] = 0;
    brc_crack_stresses(&c.rows, E, nu, out);
    check_missing(&out[2], "had not risen");
    c.rows.n = 1;
    brc_crack_stresses(&c.rows, E, nu, out);
    for (int i = 0; i < BRC_N_CRACK_STRESSES; i++)
        assert_true(isnan(out[i].value) && out[i].note);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_stresses_of_a_formula),
                                       cmocka_unit_test(test_what_cannot_be_read)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
