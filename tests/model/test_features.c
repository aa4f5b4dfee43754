/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact detection of polyhedra against a brute-force twin: random convex bodies and the packed
 * dodecahedra whose contacts three independent programs have counted. */
#include "tests/dodecahedra.h"
#include "tests/model/gas.h"
#include "tests/model/twin_features.h"

#include "polyhedra/poly.h"

#include <stdio.h>
#include <stdlib.h>

static const double RADIUS = 1e-3;

/* Active feature contacts of the simulation, by vertices and by edges. */
static void count_active(const struct fixture *f, int *vertices, int *edges)
{
    const struct brc_contacts *c = &f->sim.pairs;
    const struct poly_points *p = c->point_columns;
    *vertices = *edges = 0;
    for (size_t r = 0; r < c->n; r++)
        for (int32_t k = c->p0[r]; k < c->p0[r] + c->np[r]; k++) {
            *vertices += p->active[k] && p->kind[k] != POLY_EDGES;
            *edges += p->active[k] && p->kind[k] == POLY_EDGES;
        }
}

/* Body i's core in space, from the core as it was when the body had x0, q0. */
static void move_core(const struct fixture *f, size_t i, const struct twin_core *start,
                      struct twin_core *now)
{
    const struct brc_bodies *b = &f->sim.bodies;
    double m0[3][3], m[3][3];
    brc_quat_matrix(m0, b->q0[i]);
    brc_quat_matrix(m, b->q[i]);
    for (size_t k = 0; k < start->n_vertices; k++) {
        double r[3], body[3];
        brc_sub(r, start->vertex[k], b->x0[i]);
        brc_mat_mul_t(body, m0, r);
        brc_mat_mul(r, m, body);
        brc_add(now->vertex[k], r, b->x[i]);
    }
    for (size_t k = 0; k < start->n_faces; k++) {
        double body[3];
        brc_mat_mul_t(body, m0, start->normal[k]);
        brc_mat_mul(now->normal[k], m, body);
    }
}

/* A random convex body about centre: tangent planes of a sphere of radius 5 mm in random
 * directions, and its core with every plane moved in by R. */
static void random_body(struct fixture *f, const double centre[3], double radius,
                        struct brc_convex *cell, struct brc_convex *core)
{
    enum { N_PLANES = 14 };
    struct brc_plane planes[N_PLANES];
    for (int i = 0; i < N_PLANES; i++) {
        fixture_draw_unit(f, planes[i].n);
        if (i % 2 == 1) /* opposite directions bound it for sure, with the next one's help */
            brc_scale(planes[i].n, planes[i - 1].n, -1);
        planes[i].id = i;
    }
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < N_PLANES; i++)
            planes[i].d = brc_dot(planes[i].n, centre) + 5e-3 * (1 + 0.02 * (i % 5)) - k * radius;
        CHECK_OK(&f->ctx, brc_convex_from_planes(&f->ctx, k == 0 ? cell : core, planes, N_PLANES,
                                                 centre, 0.1));
    }
}

/* Two random bodies, their cores as they are at the start and now. */
struct duel {
    struct twin_core start[2], now[2];
};

static void begin_duel(struct fixture *f, struct duel *d, const char *rule)
{
    struct brc_convex cell[2], core;
    char settings[256];
    core = (struct brc_convex){0};
    for (int i = 0; i < 2; i++) {
        cell[i] = (struct brc_convex){0};
        random_body(f, (double[3]){i * 0.02, 0, 0}, RADIUS, &cell[i], &core);
        twin_core_from(&d->start[i], &core);
        twin_core_from(&d->now[i], &core);
    }
    fixture_loose(f, cell, NULL, 2);
    snprintf(settings, sizeof settings,
             FIXTURE_TABLE_1 "; mu: 0; gn: 0 1/s; evaluation: literal; features: %s", rule);
    fixture_free_sim(f, brc_registry_find("polyhedra"), settings, "dt: 1e-9 s");
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    brc_convex_free(&core);
}

/* Turns both at random and puts the second at a random place near the first; false when the cores
 * overlap. */
static bool place_duel(struct fixture *f, struct duel *d)
{
    struct brc_bodies *b = &f->sim.bodies;
    double phi[3], n[3], old[4], q[4];
    for (size_t i = 0; i < 2; i++) {
        fixture_draw_unit(f, phi);
        brc_scale(phi, phi, 3 * fixture_draw(f));
        brc_quat_from_rotation(q, phi);
        memcpy(old, b->q[i], sizeof old);
        brc_quat_mul(b->q[i], q, old);
    }
    fixture_draw_unit(f, n);
    b->x[1][0] = 10; /* apart first, so that nothing is remembered of the last trial */
    struct poly_contacts *columns = f->sim.pairs.model_columns;
    for (size_t row = 0; row < f->sim.pairs.n; row++)
        columns->skin_left[row] = 0; /* a jump is not a path */
    fixture_forces(f);
    fixture_list(f);
    assert_int_equal(f->sim.pairs.n, 0);
    brc_copy(b->x[1], b->x[0]);
    brc_axpy(b->x[1], 1.3e-2 + 3e-3 * fixture_draw(f), n);
    for (size_t i = 0; i < 2; i++)
        move_core(f, i, &d->start[i], &d->now[i]);
    return !twin_overlap(&d->now[0], &d->now[1]);
}

static void check_random_bodies(struct fixture *f, const char *rule, bool strict)
{
    const double stiffness = 1e8;
    struct duel d;
    int n_touching = 0, n_edges = 0, vertices, edges;
    begin_duel(f, &d, rule);
    for (int trial = 0; trial < 500; trial++) {
        if (!place_duel(f, &d))
            continue;
        fixture_list(f);
        fixture_forces(f);
        struct twin_sum sum = {.closest = HUGE_VAL, .doubt = 1e-15};
        twin_compare(&d.now[0], &d.now[1], 2 * RADIUS, strict, &sum);
        count_active(f, &vertices, &edges);
        if (strict) {
            assert_int_equal(vertices, sum.vertex_face);
            assert_int_equal(edges, sum.edge_edge);
        } else {
            assert_in_range(vertices + edges, sum.closed, sum.closed + sum.doubtful);
        }
        const struct brc_bodies *b = &f->sim.bodies;
        double force[3], moment[3], size = stiffness * (brc_norm(sum.overlap) + 1e-6), arm[3];
        brc_scale(force, sum.overlap, stiffness);
        brc_cross(arm, b->x[1], force);
        brc_scale(moment, sum.moment, stiffness);
        brc_sub(moment, moment, arm);
        /* distances of 1e-3 m known to 1e-17 m; directions over them to 1e-14 */
        CHECK_NEAR_ARRAY(b->f[1], force, 3, 1e-10 * size, 0);
        CHECK_NEAR_ARRAY(b->t[1], moment, 3, 1e-12 * size, 0);
        n_touching += brc_norm(force) > 0;
        n_edges += sum.edge_edge > 0;
    }
    assert_true(n_touching > 60 && n_edges > 20);
    for (int i = 0; i < 2; i++) {
        twin_core_free(&d.start[i]);
        twin_core_free(&d.now[i]);
    }
}

static void random_bodies_strict(void **state)
{
    for (int i = 0; i < 4; i++)
        check_random_bodies(*state, "strict", true);
}

static void random_bodies_closed(void **state)
{
    for (int i = 0; i < 4; i++)
        check_random_bodies(*state, "closed", false);
}

/* --- kept feature lists ------------------------------------------------------------------------
 */

/* Counts of a row's active contacts, and their force, against the twin's; cores that overlap are
 * left out. Returns how many the twin finds. */
static int check_row(const struct fixture *f, const struct twin_core *core, size_t i, size_t j,
                     bool strict)
{
    struct twin_sum sum = {.closest = HUGE_VAL, .doubt = 1e-15};
    if (twin_overlap(&core[i], &core[j]))
        return 0;
    twin_compare(&core[i], &core[j], 2e-3, strict, &sum);
    const struct brc_contacts *c = &f->sim.pairs;
    const struct poly_points *p = c->point_columns;
    int64_t row = brc_contacts_find(c, (int32_t)i, (int32_t)j);
    int n[2] = {0, 0};
    for (int32_t k = 0; row >= 0 && k < c->np[row]; k++) {
        int32_t point = c->p0[row] + k;
        n[p->kind[point] == POLY_EDGES] += p->active[point] != 0;
    }
    if (strict) {
        assert_int_equal(n[0], sum.vertex_face);
        assert_int_equal(n[1], sum.edge_edge);
        return sum.vertex_face + sum.edge_edge;
    }
    assert_in_range(n[0] + n[1], sum.closed, sum.closed + sum.doubtful);
    for (int k = 0; k < 3 && row >= 0; k++)
        CHECK_NEAR(c->f[row][k], 1e5 * sum.overlap[k], 1e-9, 1e-10);
    return sum.closed;
}

/* Pairs and features sleep until their motion has used up their gap, and closest features are
 * remembered: at every one of 10 000 steps exactly those act that brute force finds, with its
 * force. */
static void check_gas(struct fixture *f, bool strict)
{
    struct brc_convex cell[GAS_N], core;
    struct twin_core start[GAS_N], now[GAS_N];
    int n = 0;
    gas_build(f, cell, brc_registry_find("polyhedra"),
              strict ? "radius: 1 mm; kn: 1e5 N/m; kt: 1e5 N/m; gn: 2000 1/s; features: strict"
                     : "radius: 1 mm; kn: 1e5 N/m; mu: 0; gn: 0 1/s; features: closed",
              "dt: 2e-5 s");
    core = (struct brc_convex){0};
    for (size_t i = 0; i < GAS_N; i++) {
        for (size_t k = 0; k < cell[i].n_faces; k++)
            cell[i].plane[k].d -= 1e-3;
        CHECK_OK(&f->ctx, brc_convex_from_planes(&f->ctx, &core, cell[i].plane, cell[i].n_faces,
                                                 f->sim.bodies.x0[i], 0.1));
        twin_core_from(&start[i], &core);
        twin_core_from(&now[i], &core);
        brc_convex_free(&cell[i]);
    }
    for (int step = 0; step < 10000; step++) {
        fixture_steps(f, 1);
        for (size_t i = 0; i < GAS_N; i++)
            move_core(f, i, &start[i], &now[i]);
        for (size_t i = 0; i < GAS_N; i++)
            for (size_t j = i + 1; j < GAS_N; j++) {
                double d[3];
                brc_sub(d, f->sim.bodies.x[j], f->sim.bodies.x[i]);
                if (brc_norm(d) < 0.0175) /* twice the reach of a box */
                    n += check_row(f, now, i, j, strict);
            }
        gas_reflect(f);
    }
    print_message("gas, %s: %d feature contacts in 10000 steps, all found\n",
                  strict ? "strict" : "closed", n);
    assert_true(n > 1000);
    for (size_t i = 0; i < GAS_N; i++) {
        twin_core_free(&start[i]);
        twin_core_free(&now[i]);
    }
    brc_convex_free(&core);
}

static void kept_features_of_a_gas(void **state)
{
    check_gas(*state, true);
    check_gas(*state, false);
}

/* --- packs under load, `closed` ----------------------------------------------------------------
 */

/* What has been found in the contacts of a pack. */
struct found {
    int springs, doubtful, contacts;
    double largest, off; /* N, of forces; of their difference from the twin's */
};

/* The core of a grain as it is now. */
static void core_of_grain(const struct fixture *f, int32_t grain, struct twin_core *core)
{
    const struct poly_state *st = f->sim.state;
    const struct poly_core c = poly_core_of(&st->shapes, (size_t)grain);
    const struct brc_bodies *b = &f->sim.bodies;
    double m[3][3];
    brc_quat_matrix(m, b->q[grain]);
    *core = (struct twin_core){.n_vertices = (size_t)c.n_vertices,
                               .n_edges = (size_t)c.n_edges,
                               .n_faces = (size_t)c.n_faces};
    core->vertex = calloc(core->n_vertices, sizeof *core->vertex);
    core->edge = calloc(core->n_edges, sizeof *core->edge);
    core->first = calloc(core->n_faces + 1, sizeof *core->first);
    core->loop = calloc(2 * core->n_edges, sizeof *core->loop);
    core->normal = calloc(core->n_faces, sizeof *core->normal);
    memcpy(core->edge, c.end, core->n_edges * sizeof *core->edge);
    for (size_t v = 0; v < core->n_vertices; v++) {
        brc_mat_mul(core->vertex[v], m, c.vertex[v]);
        brc_add(core->vertex[v], core->vertex[v], b->x[grain]);
    }
    for (size_t k = 0; k < core->n_faces; k++) {
        brc_mat_mul(core->normal[k], m, c.face[k].n);
        core->first[k + 1] = core->first[k] + (size_t)c.face[k].n_sides;
        for (size_t j = core->first[k]; j < core->first[k + 1]; j++)
            core->loop[j] = c.link[(size_t)c.face[k].first + j - core->first[k]].v;
    }
}

/* One contact against the twin: as many springs, and the same force of them. What is linearised has
 * the springs of when it was computed, which must still be those. */
static void check_closed(const struct fixture *f, size_t row, double rest, struct found *found)
{
    const struct brc_contacts *c = &f->sim.pairs;
    const struct poly_points *p = c->point_columns;
    const struct poly_contacts *columns = c->model_columns;
    const double kn = 1e8;
    struct twin_core a, b;
    struct twin_sum sum = {.closest = HUGE_VAL, .doubt = 1e-11 * rest};
    int n = 0;
    core_of_grain(f, c->a[row], &a);
    core_of_grain(f, c->b[row], &b);
    twin_compare(&a, &b, rest, false, &sum);
    for (int32_t k = c->p0[row]; k < c->p0[row] + c->np[row]; k++)
        n += p->active[k] != 0;
    assert_in_range(n, sum.closed, sum.closed + sum.doubtful);
    if (!columns->is_linearised[row] && c->status[row] != BRC_INTACT) {
        double off[3];
        for (int k = 0; k < 3; k++)
            off[k] = c->f[row][k] - kn * sum.overlap[k];
        found->off = fmax(found->off, brc_norm(off));
        found->largest = fmax(found->largest, brc_norm(c->f[row]));
    }
    found->springs += n;
    found->doubtful += sum.doubtful;
    found->contacts++;
    twin_core_free(&a);
    twin_core_free(&b);
}

/* Compression without friction and bonds (then forces are those of the springs), or with both. */
static void check_pack(struct fixture *f, const char *specimen, const char *kind, double radius,
                       const char *settings)
{
    char all[300], test[100];
    struct found found = {0};
    snprintf(all, sizeof all, "radius: %g m; kn: 1e8 N/m; kt: 1e8 N/m; features: closed; %s",
             radius, settings);
    snprintf(test, sizeof test, "kind: %s; loading: fixed; rate: 4e-6 1/s; strain_max: 0.99", kind);
    fixture_specimen(f, specimen);
    fixture_sim(f, brc_registry_find("polyhedra"), all, test, "");
    for (int step = 0; step < 300; step += 25) {
        fixture_steps(f, 25);
        for (size_t row = 0; row < f->sim.pairs.n; row++)
            check_closed(f, row, 2 * radius, &found);
    }
    print_message(
        "%s, %s: %d springs of %d contacts, all found (%d in doubt); forces up to %.2e N, "
        "off by %.1e\n",
        specimen, settings, found.springs, found.contacts, found.doubtful, found.largest,
        found.off);
    assert_true(found.springs > 900);
    /* 1e-11, but for edges that are almost parallel, as in prisms: where they are closest is known
     * to the round-off over their squared sine alone */
    assert_true(found.off <= 1e-6 * found.largest);
}

static void packs_under_load_closed(void **state)
{
    static const char *const settings[] = {"bonds: off; mu: 0; evaluation: literal",
                                           "bonds: off; mu: 0",
                                           "eps_th: 0.05; strain_length: gap; area: eroded"};
    for (int i = 0; i < 3; i++) {
        check_pack(*state,
                   "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; jitter: 0.6; "
                   "seed: 3",
                   "compression", 1e-3, settings[i]);
        check_pack(*state,
                   "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; jitter: 0",
                   "compression", 1e-3, settings[i]);
        check_pack(*state,
                   "shape: cylinder; grains: mesh; diameter: 10 cm; height: 5 cm; "
                   "triangle_area: 4 cm2",
                   "brazilian", 1e-3, settings[i]);
    }
}

/* A block is crushed: edges that touch turn past parallel, and cross on what their remembered side
 * would call the wrong one. What is stored is what has been booked; one such pair would have 800 J.
 */
static void closed_edges_forget_their_side(void **state)
{
    struct fixture *f = *state;
    double(*of_grain)[BRC_N_ACCOUNTS], stored = 0, booked = 0;
    fixture_specimen(f, "shape: box; grains: grid; size: 4 cm, 4 cm, 4 cm; cells: 4, 4, 4");
    fixture_sim(f, brc_registry_find("polyhedra"),
                FIXTURE_TABLE_1 "; features: closed; strain_length: gap; area: eroded; "
                                "evaluation: literal",
                "kind: compression; loading: fixed; rate: 5e-6 1/s; strain_max: 0.99", "");
    fixture_steps(f, 3200);
    of_grain = test_calloc(f->sim.bodies.n, sizeof *of_grain);
    poly_pose_bodies(&f->sim, f->sim.state);
    poly_energy(&f->sim, f->sim.state, of_grain);
    for (size_t i = 0; i < f->sim.bodies.n; i++) {
        stored += of_grain[i][BRC_ACCOUNT_NORMAL];
        booked += f->sim.bodies.energy[i][BRC_ACCOUNT_NORMAL];
    }
    print_message("stored in normal springs: %g J, booked %g J\n", stored, booked);
    CHECK_NEAR(booked, stored, 1, 0);
    test_free(of_grain);
}

/* --- the file ----------------------------------------------------------------------------------
 */

static void dodecahedra_are_counted_right(void **state)
{
    struct fixture *f = *state;
    struct dodecahedra *d = test_malloc(sizeof *d);
    struct brc_plane planes[20], placed[12];
    struct brc_convex *cell = test_calloc(512, sizeof *cell), core;
    struct twin_core *twin = test_calloc(512, sizeof *twin);
    dodecahedra_read(d);
    assert_int_equal(dodecahedra_planes(d, planes), 12);
    core = (struct brc_convex){0};
    for (size_t i = 0; i < 512; i++) {
        cell[i] = (struct brc_convex){0};
        dodecahedra_place(d, i, planes, d->radius, placed);
        CHECK_OK(&f->ctx, brc_convex_from_planes(&f->ctx, &cell[i], placed, 12, d->x[i], 2));
        dodecahedra_place(d, i, planes, 0, placed);
        CHECK_OK(&f->ctx, brc_convex_from_planes(&f->ctx, &core, placed, 12, d->x[i], 2));
        twin_core_from(&twin[i], &core);
    }
    struct twin_sum sum = {.closest = HUGE_VAL};
    for (size_t i = 0; i < 512; i++)
        for (size_t j = i + 1; j < 512; j++) {
            double r[3];
            brc_sub(r, d->x[j], d->x[i]);
            if (brc_norm(r) < 2 * (0.446 + d->radius)) /* circumradius sqrt(3) 0.25718 */
                twin_compare(&twin[i], &twin[j], 2 * d->radius, true, &sum);
        }
    print_message("twin: vertex-face %d, edge-edge %d, vertex-edge %d, vertex-vertex %d\n",
                  sum.vertex_face, sum.edge_edge, sum.vertex_edge, sum.vertex_vertex);
    assert_int_equal(sum.vertex_face, 1710);
    assert_int_equal(sum.edge_edge, 1510);
    assert_int_equal(sum.vertex_edge, 125);
    assert_int_equal(sum.vertex_vertex, 3);

    char settings[128];
    int vertices, edges;
    fixture_loose(f, cell, NULL, 512);
    snprintf(settings, sizeof settings, "radius: %.17g m; features: strict; mu: 0; gn: 0 1/s",
             d->radius);
    fixture_free_sim(f, brc_registry_find("polyhedra"), settings, "");
    count_active(f, &vertices, &edges);
    assert_int_equal(vertices, 1710);
    assert_int_equal(edges, 1510);
    for (size_t i = 0; i < 512; i++) {
        brc_convex_free(&cell[i]);
        twin_core_free(&twin[i]);
    }
    brc_convex_free(&core);
    test_free(cell);
    test_free(twin);
    test_free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(random_bodies_strict),           FIXTURE_TEST(random_bodies_closed),
        FIXTURE_TEST(kept_features_of_a_gas),         FIXTURE_TEST(packs_under_load_closed),
        FIXTURE_TEST(closed_edges_forget_their_side), FIXTURE_TEST(dodecahedra_are_counted_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
