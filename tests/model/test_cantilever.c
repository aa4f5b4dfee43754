/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cantilever: beams of cubes against the theory of beams and against an independent solution of
 * the network of springs, loads that keep or follow their direction, and what is refused. A beam of
 * 16 cubes across, which takes minutes, runs with `test_cantilever 16`. */
#include "tests/fixture.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int finest = 8;

/* A beam of 5 x 1 x 1 cm of cubes, n of them across. */
static void cut_beam(struct fixture *f, int n)
{
    char text[200];
    snprintf(text, sizeof text,
             "shape: box; size: 5 cm, 1 cm, 1 cm; grains: grid; jitter: 0; cells: %d, %d, %d",
             5 * n, n, n);
    fixture_specimen(f, text);
}

static void bend(struct fixture *f, const char *model, const char *settings, const char *own)
{
    CHECK_OK(&f->ctx,
             fixture_try_sim(f, brc_registry_find(model), settings, "kind: cantilever", own, ""));
    while (!brc_rigs_done(&f->sim) && f->sim.step < 200000)
        fixture_steps(f, 1);
    assert_string_equal(brc_rigs_end(&f->sim), "cantilever.tolerance");
    CHECK_BETWEEN(brc_ledger_residual(&f->sim.ledger), 0, 1e-6);
}

/* ---- against beams ----------------------------------------------------------------------------
 */

/* Facets with all their points bend like the continuum's section; with one point in the middle they
 * lack their own second moment, which is 1 / n^2 of the section's. */
static void cubes_of_vgcm_bend_as_timoshenko_says(void **state)
{
    struct fixture *f = *state;
    double missed[2] = {0, 0};
    for (int n = finest / 2, k = 0; n <= finest; n *= 2, k++) {
        cut_beam(f, n);
        bend(f, "vgcm", "e_bar: 50 GPa; eta: 1; points: exact", "load: 1 N; poisson: 0");
        double exact = fixture_result(f, "E_c_shear").value / 50e9;
        CHECK_BETWEEN(brc_ledger_residual(&f->sim.ledger), 0, 1e-11);
        CHECK_NEAR(fixture_result(f, "root_force").value, 1, 2e-4, 0);
        CHECK_NEAR(fixture_result(f, "root_moment").value, 0.05, 2e-4 * 0.05, 0);
        assert_true(fixture_result(f, "E_c").value < fixture_result(f, "E_c_shear").value);
        bend(f, "vgcm", "e_bar: 50 GPa; eta: 1; points: one", "load: 1 N; poisson: 0");
        missed[k] = 1 - fixture_result(f, "E_c_shear").value / 50e9;
        print_message("%d cubes: all points %.5f of E, one point %.5f, discrete section %.5f\n", n,
                      exact, 1 - missed[k], 1 - 1.0 / (n * n));
        CHECK_NEAR(exact, 1, 0.01, 0);
        CHECK_NEAR(1 - missed[k], 1 - 1.0 / (n * n), 0.01, 0);
    }
    CHECK_BETWEEN(log2(missed[0] / missed[1]), 1.7, 2.3);
}

/* ---- against the network of springs -----------------------------------------------------------
 */

/* A spring between a point of a and one of b (-1: the clamp) along n. Bonds pull alone, touches
 * push alone, shear does both. */
struct bar {
    int a, b, way; /* way: +1 pulls, -1 pushes, 0 both */
    double at[3], n[3], k;
    bool is_twist; /* resists the turn about n, not the way along it */
    bool acts;
};
enum { MAX_BARS = 4000 };

struct net {
    struct bar bar[MAX_BARS];
    int n_bars;
    size_t n; /* degrees of freedom */
    const struct fixture *f;
};

static void add_bar(struct net *net, const int body[2], int way, const double at[3],
                    const double n[3], double k, bool is_twist)
{
    struct bar *bar = &net->bar[net->n_bars++];
    assert_true(net->n_bars <= MAX_BARS);
    *bar = (struct bar){
        .a = body[0], .b = body[1], .way = way, .k = k, .is_twist = is_twist, .acts = true};
    brc_copy(bar->at, at);
    brc_copy(bar->n, n);
}

#define BN     40e9
#define BT     15e9
#define BM     5e9
#define KN     2e7
#define RADIUS 1e-4

/* Bond of a facet, and the touches at the corners of the cores, which lie RADIUS within the edges;
 * length: between the centres, or from the centre to the clamp. */
static void add_joint(struct net *net, size_t facet, const int body[2], double length)
{
    const struct brc_facets *s = &net->f->specimen.facets;
    const double *at = s->centroid[facet], *n = s->normal[facet];
    double area = s->area[facet], t[2][3];
    brc_frame(t[0], t[1], n);
    add_bar(net, body, 1, at, n, BN * area / length, false);
    for (int k = 0; k < 2; k++)
        add_bar(net, body, 0, at, t[k], BT * area / length, false);
    if (body[1] >= 0) /* a clamp holds without torsion */
        add_bar(net, body, 0, at, n, BM * area * length, true);
    for (size_t i = s->first[facet]; i < s->first[facet + 1]; i++) {
        double corner[3];
        brc_copy(corner, s->vertex[s->loop[i]]);
        for (int k = 0; k < 3; k++)
            if (fabs(n[k]) < 0.5)
                corner[k] += corner[k] > at[k] ? -RADIUS : RADIUS;
        add_bar(net, body, -1, corner, n, KN, false);
    }
}

/* Coefficients of the change of length by the degrees of freedom of body a or b. */
static void arms(const struct net *net, const struct bar *bar, int body, double c[6])
{
    double arm[3];
    brc_sub(arm, bar->at, net->f->sim.bodies.x0[body]);
    brc_copy(c, bar->n);
    brc_cross(c + 3, arm, bar->n);
    if (bar->is_twist) {
        brc_set(c, 0, 0, 0);
        brc_copy(c + 3, bar->n);
    }
}

static double stretch(const struct net *net, const struct bar *bar, const gsl_vector *u)
{
    double sum = 0, c[6];
    for (int side = 0; side < 2; side++) {
        int body = side ? bar->b : bar->a;
        if (body < 0)
            continue;
        arms(net, bar, body, c);
        for (size_t k = 0; k < 6; k++)
            sum += (side ? 1 : -1) * c[k] * gsl_vector_get(u, 6 * (size_t)body + k);
    }
    return sum;
}

static void assemble(const struct net *net, gsl_matrix *m)
{
    gsl_matrix_set_zero(m);
    for (int i = 0; i < net->n_bars; i++) {
        const struct bar *bar = &net->bar[i];
        const int body[2] = {bar->a, bar->b};
        double c[2][6];
        if (!bar->acts)
            continue;
        for (int s = 0; s < 2; s++)
            if (body[s] >= 0)
                arms(net, bar, body[s], c[s]);
        for (int s = 0; s < 2; s++)
            for (int r = 0; r < 2; r++)
                for (size_t p = 0; p < 36 && body[s] >= 0 && body[r] >= 0; p++) {
                    double *to =
                        gsl_matrix_ptr(m, 6 * (size_t)body[s] + p / 6, 6 * (size_t)body[r] + p % 6);
                    *to += (s == r ? 1 : -1) * bar->k * c[s][p / 6] * c[r][p % 6];
                }
    }
}

/* Slope of the energy along d at u: what the springs that act there do, less the load's. */
static double slope(struct net *net, const gsl_vector *load, const gsl_vector *u,
                    const gsl_vector *d)
{
    double sum = 0, work = 0;
    for (int i = 0; i < net->n_bars; i++) {
        struct bar *bar = &net->bar[i];
        double s = stretch(net, bar, u);
        bar->acts = bar->way == 0 || bar->way * s > 0;
        if (bar->acts)
            sum += bar->k * s * stretch(net, bar, d);
    }
    gsl_blas_ddot(load, d, &work);
    return sum - work;
}

/* Newton's steps to the least energy, which is convex; each as far as the energy falls, since
 * springs that act one way go in and out. Leaves the springs that act at u. Returns the step's
 * length. */
static double step(struct net *net, const gsl_vector *load, gsl_matrix *m, gsl_vector *u)
{
    gsl_permutation *p = gsl_permutation_alloc(net->n);
    gsl_vector *d = gsl_vector_alloc(net->n), *at = gsl_vector_alloc(net->n);
    double low = 0, high = 1;
    int sign;
    assemble(net, m);
    gsl_linalg_LU_decomp(m, p, &sign);
    gsl_linalg_LU_solve(m, p, load, d);
    gsl_vector_sub(d, u);
    for (int i = 0; i < 50; i++) {
        double t = i == 0 ? 1 : 0.5 * (low + high);
        gsl_vector_memcpy(at, u);
        gsl_blas_daxpy(t, d, at);
        bool is_past = slope(net, load, at, d) > 0;
        if (i == 0 && !is_past)
            break;
        *(is_past ? &high : &low) = t;
    }
    double moved = gsl_blas_dnrm2(d) / gsl_blas_dnrm2(at);
    gsl_vector_memcpy(u, at);
    gsl_vector_free(d);
    gsl_vector_free(at);
    gsl_permutation_free(p);
    return moved;
}

static void solve(struct net *net, const gsl_vector *load, gsl_vector *u)
{
    gsl_matrix *m = gsl_matrix_alloc(net->n, net->n);
    int round = 0;
    while (step(net, load, m, u) > 1e-9)
        assert_true(++round < 200);
    gsl_matrix_free(m);
}

/* Way of the loaded end, by virtual work. */
static double solve_beam(const struct fixture *f, double load)
{
    static struct net net;
    const struct brc_facets *s = &f->specimen.facets;
    double area = 0, low[3], high[3];
    net = (struct net){.n = 6 * s->n_cells, .f = f};
    gsl_vector *force = gsl_vector_calloc(net.n), *u = gsl_vector_calloc(net.n);
    brc_specimen_extent(&f->specimen, low, high);
    for (size_t i = 0; i < s->n_facets; i++) {
        const int body[2] = {s->cell[i][0], s->cell[i][1]};
        double d[3];
        brc_sub(d, s->centroid[i], f->sim.bodies.x0[body[0]]);
        if (body[1] >= 0)
            add_joint(&net, i, body, 2 * brc_norm(d));
        else if (s->normal[i][0] < -0.5)
            add_joint(&net, i, body, brc_norm(d));
        else if (s->normal[i][0] > 0.5)
            area += s->area[i];
    }
    for (size_t i = 0; i < s->n_facets; i++)
        if (s->cell[i][1] < 0 && s->normal[i][0] > 0.5) {
            double part[3] = {0, 0, -load * s->area[i] / area}, arm[3], moment[3];
            brc_sub(arm, s->centroid[i], f->sim.bodies.x0[s->cell[i][0]]);
            brc_cross(moment, arm, part);
            for (size_t k = 0; k < 6; k++)
                *gsl_vector_ptr(force, 6 * (size_t)s->cell[i][0] + k) +=
                    k < 3 ? part[k] : moment[k - 3];
        }
    solve(&net, force, u);
    double work = 0;
    for (size_t k = 0; k < net.n; k++)
        work += gsl_vector_get(force, k) * gsl_vector_get(u, k);
    gsl_vector_free(force);
    gsl_vector_free(u);
    return work / load;
}

static void polyhedra_bend_as_their_springs_do(void **state)
{
    struct fixture *f = *state;
    char text[300];
    fixture_specimen(f, "shape: box; size: 2 cm, 5 mm, 5 mm; grains: grid; jitter: 0; "
                        "cells: 8, 2, 2");
    snprintf(text, sizeof text,
             "radius: %g m; kn: %g N/m; kt: 0 N/m; mu: 0; bn: %g Pa; bt: %g Pa; bm: %g Pa; "
             "breakable: off; strain_length: centres; area: facet; "
             "evaluation: literal",
             RADIUS, KN, BN, BT, BM);
    bend(f, "polyhedra", text, "load: 0.1 N; tolerance: 1e-5");
    double tip = fixture_result(f, "tip").value, expected = solve_beam(f, 0.1);
    print_message("tip %.6g m, springs %.6g m: %.5f\n", tip, expected, tip / expected);
    CHECK_NEAR(tip, expected, 0, 1e-4);
}

/* ---- the load ---------------------------------------------------------------------------------
 */

/* A load that turns with the end has a part along the beam, which the clamp carries; one that keeps
 * its direction has none. Far enough for the turn to be seen, in both models. */
static void a_load_keeps_or_follows_its_direction(void **state)
{
    struct fixture *f = *state;
    static const char *const model[] = {"vgcm", "polyhedra"};
    static const char *const settings[] = {"softening: none; sigma_t: 1e12 Pa; tau: 1e13 Pa",
                                           "breakable: off; bt: 9 GPa"};
    cut_beam(f, 2);
    for (int m = 0; m < 2; m++)
        for (int follows = 0; follows < 2; follows++) {
            bend(f, model[m], settings[m],
                 follows ? "load: 200 N; load_follows: followed" : "load: 200 N");
            const struct brc_platen *clamp = &f->sim.rig.platen[0];
            const struct brc_table *own = &f->sim.rig.curve.own;
            double turn = brc_table_number(own, 2, f->sim.rig.curve.table.n - 1);
            print_message("%s: turn %g, axial force %g N\n", model[m], turn, clamp->force);
            CHECK_BETWEEN(turn, 0.002, 0.3);
            CHECK_NEAR(clamp->force, follows ? 200 * sin(turn) : 0, 0.05, 0);
        }
}

/* ---- specimens --------------------------------------------------------------------------------
 */

/* Planes of the same box, and the axis by its length. */
static void a_polyhedron_with_flat_ends_bends(void **state)
{
    struct fixture *f = *state;
    char path[64], text[200];
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-planes.txt", (long)getpid());
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs("1 0 0 0.01\n-1 0 0 0\n0 1 0 0.05\n0 -1 0 0\n0 0 1 0.01\n0 0 -1 0\n", out);
    assert_int_equal(fclose(out), 0);
    snprintf(text, sizeof text,
             "shape: polyhedron; planes: %s; grains: packing; diameter_min: 2.5 mm; "
             "diameter_max: 3.5 mm; seed: 3; cache: off",
             path);
    fixture_specimen(f, text);
    unlink(path);
    bend(f, "vgcm", "", "load: 1 N");
    assert_int_equal(f->sim.rig.axis, 1);
    double flat = fixture_result(f, "E_c_shear").value;
    CHECK_BETWEEN(flat, 20e9, 80e9);
}

static void what_is_no_beam_is_refused(void **state)
{
    struct fixture *f = *state;
    const struct brc_model *vgcm = brc_registry_find("vgcm");
    fixture_specimen(f, "shape: cylinder; diameter: 1 cm; height: 2 cm; grains: packing; "
                        "diameter_min: 3 mm; diameter_max: 4 mm; cache: off");
    CHECK_FAILS(&f->ctx, fixture_try_sim(f, vgcm, "", "kind: cantilever", "axis: x", ""),
                BRC_ERR_GEOMETRY,
                "needs a prism with flat ends along its axis (cantilever.axis = x)");
    CHECK_FAILS(&f->ctx, fixture_try_sim(f, vgcm, "", "kind: cantilever", "direction: -z", ""),
                BRC_ERR_INPUT, "lies along the beam, whose axis is z");
    CHECK_OK(&f->ctx, fixture_try_sim(f, vgcm, "", "kind: cantilever", "direction: x", ""));
}

int main(int argc, char **argv)
{
    if (argc > 1)
        finest = atoi(argv[1]);
    const struct CMUnitTest tests[] = {FIXTURE_TEST(cubes_of_vgcm_bend_as_timoshenko_says),
                                       FIXTURE_TEST(polyhedra_bend_as_their_springs_do),
                                       FIXTURE_TEST(a_load_keeps_or_follows_its_direction),
                                       FIXTURE_TEST(a_polyhedron_with_flat_ends_bends),
                                       FIXTURE_TEST(what_is_no_beam_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
