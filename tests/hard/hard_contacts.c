/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of geometry and of one contact. */
#include "tests/hard/hard.h"

/* --- faces, slivers, sizes -------------------------------------------------------------------- */

struct press {
    double stress, residual;
    size_t points;
};

/* The case pressed to its strain, with the jitter given. */
static struct press press(struct fixture *f, const char *name, const struct brc_model *model,
                          const char *jitter, const char *features)
{
    char text[2][64];
    snprintf(text[0], sizeof text[0], "specimen.jitter=%s", jitter);
    snprintf(text[1], sizeof text[1], "polyhedra.features=%s", features);
    hard_case(f, name, model, (const char *const[]){text[0], text[1]}, 2);
    while (!brc_rigs_done(&f->sim))
        fixture_steps(f, 1);
    f->sim.rig.rate = 0; /* held until it rests */
    fixture_steps(f, 3000);
    struct press p = {f->sim.rig.force / f->sim.rig.section, brc_ledger_residual(&f->sim.ledger),
                      0};
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        p.points += brc_norm2(f->sim.pairs.f[i]) > 0 ? (size_t)f->sim.pairs.np[i] : 0;
    return p;
}

static void coincident_faces(void **state)
{
    struct fixture *f = *state;
    const char *name = "coincident_faces";
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        struct press exact = press(f, name, model, "0", "merged");
        struct press near = press(f, name, model, "1e-9", "merged");
        double change = fabs(near.stress / exact.stress - 1);
        hard_row(name, model->name, change < 1e-6 && exact.residual < 1e-9,
                 "stress of exact and by 1e-9 jittered faces equal within 1e-6",
                 "change %.1e at %.4g MPa, residual %.0e", change, 1e-6 * exact.stress,
                 exact.residual);
    }
    const struct brc_model *polyhedra = brc_registry_find("polyhedra");
    struct press exact = press(f, name, polyhedra, "0", "closed");
    struct press near = press(f, name, polyhedra, "1e-9", "closed");
    hard_row("coincident_faces, `features: closed`", "polyhedra",
             fabs(near.stress / exact.stress - 1) < 1e-6,
             "the same within 1e-6 (more springs a face, so stiffer)", "change %.1e at %.4g MPa",
             fabs(near.stress / exact.stress - 1), 1e-6 * exact.stress);
}

static void slivers(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        struct press exact = press(f, "slivers", model, "0", "merged");
        struct press sliver = press(f, "slivers", model, "1e-6", "merged");
        const struct brc_facets *t = &f->specimen.facets;
        double volume = 0, least = HUGE_VAL;
        for (size_t k = 0; k < t->n_cells; k++)
            volume += t->volume[k];
        for (size_t k = 0; k < t->n_facets; k++)
            least = fmin(least, t->area[k]);
        double lost = fabs(volume / f->specimen.domain_volume - 1);
        double change = fabs(sliver.stress / exact.stress - 1);
        hard_row("slivers", model->name, lost < 1e-12 && change < 1e-4 && sliver.residual < 1e-8,
                 "volume within 1e-12, stress within 1e-4 of the exact grid, ledger closed",
                 "smallest facet %.0e of a face, volume %.0e, stress %.1e, residual %.0e",
                 least / 1e-4, lost, change, sliver.residual);
    }
}

static void radius_ratio(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        hard_case(f, "radius_ratio", model, NULL, 0);
        const struct brc_facets *t = &f->specimen.facets;
        double low = HUGE_VAL, high = 0, volume = 0;
        for (size_t k = 0; k < t->n_cells; k++) {
            low = fmin(low, t->radius[k]);
            high = fmax(high, t->radius[k]);
            volume += t->volume[k];
        }
        double lost = fabs(volume / f->specimen.domain_volume - 1);
        while (!brc_rigs_done(&f->sim))
            fixture_steps(f, 1);
        double residual = brc_ledger_residual(&f->sim.ledger);
        hard_row("radius_ratio", model->name,
                 high / low > 5 && lost < 1e-12 && residual < 1e-4 && f->sim.events.table.n > 0,
                 "every sphere has a cell, volume within 1e-12, breaks with residual < 1e-4",
                 "%zu grains, radii 1:%.1f, volume %.0e, %zu broken, residual %.0e", t->n_cells,
                 high / low, lost, f->sim.events.table.n, residual);
    }
}

/* --- one contact ------------------------------------------------------------------------------ */

static const double R = 1e-3, TIP = 0.01, BOX = 0.02, K = 1e6;

/* A rounded tip over a box's face, at x = 0, its core `height` above the face of the core. */
static void tip_over_face(struct fixture *f, double height, const char *settings)
{
    struct brc_convex cell[2];
    char all[128];
    for (int i = 0; i < 2; i++)
        cell[i] = (struct brc_convex){0};
    fixture_box(f, &cell[0], (double[3]){-BOX / 2, 0, 0}, (double[3]){BOX, BOX, BOX});
    fixture_octahedron(f, &cell[1], (double[3]){TIP - sqrt(3) * R - R + height, 0, 0}, TIP);
    fixture_loose(f, cell, NULL, 2);
    for (int i = 0; i < 2; i++)
        brc_convex_free(&cell[i]);
    snprintf(all, sizeof all, "radius: 1 mm; kn: 1e6 N/m; kt: 0 N/m; mu: 0; gn: 0 1/s; %s",
             settings);
    fixture_free_sim(f, brc_registry_find("polyhedra"), all, "dt: 1e-9 s");
}

/* Force on the tip after it has been carried by v in n steps, the largest change of a step in
 * *jump. */
static void carry(struct fixture *f, const double v[3], int n, double *jump, double *least)
{
    const double zero[3] = {0, 0, 0};
    double old[3];
    *jump = 0;
    *least = HUGE_VAL;
    fixture_list(f);
    fixture_forces(f);
    brc_copy(old, f->sim.bodies.f[1]);
    for (int i = 0; i < n; i++) {
        double d[3];
        fixture_velocity(f, 0, zero, zero);
        fixture_velocity(f, 1, v, zero);
        fixture_carry(f, 1.0 / n);
        brc_sub(d, f->sim.bodies.f[1], old);
        *jump = fmax(*jump, brc_norm(d));
        *least = fmin(*least, f->sim.bodies.f[1][0]);
        brc_copy(old, f->sim.bodies.f[1]);
    }
}

static void overlap_deeper_than_the_radius(void **state)
{
    struct fixture *f = *state;
    double jump[2], least, force[2];
    /* from touch (2 R apart) to 1.9 R deep, and on to where the core's tip is R inside the core */
    const double depth[2] = {1.9 * R, 3 * R};
    for (int i = 0; i < 2; i++) {
        tip_over_face(f, 2 * R, "");
        carry(f, (double[3]){-depth[i], 0, 0}, 1000, &jump[i], &least);
        force[i] = f->sim.bodies.f[1][0];
    }
    hard_row("overlap deeper than R", "polyhedra",
             fabs(force[0] / (K * depth[0]) - 1) < 1e-9 &&
                 fabs(force[1] / (K * depth[1]) - 1) < 1e-9 && jump[1] < 1.01 * K * depth[1] / 1000,
             "force K_n delta without a jump, to 1.9 R and to 3 R (cores overlap by R)",
             "force / (K_n delta) - 1: %.0e, %.0e; largest step %.4f of the mean one",
             force[0] / (K * depth[0]) - 1, force[1] / (K * depth[1]) - 1,
             jump[1] / (K * depth[1] / 1000));
}

static void vertex_over_a_whole_cell(void **state)
{
    struct fixture *f = *state;
    double jump[2], least;
    for (int i = 0; i < 2; i++) {
        /* from beyond one edge of the face, over its middle and out past a corner on the other side
         */
        tip_over_face(f, 1.5 * R, "features: merged");
        carry(f, (double[3]){0, -0.6 * BOX, -0.5 * BOX}, 1000, &jump[i], &least);
        carry(f, (double[3]){0, 1.2 * BOX, 1.0 * BOX}, 2000 << i, &jump[i], &least);
    }
    double force = K * 0.5 * R;
    hard_row("vertex over a whole cell", "polyhedra",
             jump[1] < 0.6 * jump[0] && jump[0] < 0.2 * force && least > -1e-9 * force,
             "force continuous: its largest step halves with the path's; it never pulls",
             "largest step %.2e, then %.2e of the force on the face; least %.0e", jump[0] / force,
             jump[1] / force, fmin(least, 0) / force);
}

static void mass_ratio(void **state)
{
    struct fixture *f = *state;
    double e[2];
    for (int i = 0; i < 2; i++) {
        /* an octahedron of 1e-4 of the box's mass flies at its face and back */
        struct brc_convex cell[2];
        double size = cbrt(1e-4 * BOX * BOX * BOX * 3 / 4), tip = size - sqrt(3) * 1e-4 + 1e-4;
        for (int k = 0; k < 2; k++)
            cell[k] = (struct brc_convex){0};
        fixture_box(f, &cell[0], (double[3]){-BOX / 2, 0, 0}, (double[3]){BOX, BOX, BOX});
        fixture_octahedron(f, &cell[1], (double[3]){tip + 1e-6, 0, 0}, size);
        fixture_loose(f, cell, NULL, 2);
        for (int k = 0; k < 2; k++)
            brc_convex_free(&cell[k]);
        fixture_free_sim(f, brc_registry_find("polyhedra"),
                         "radius: 0.1 mm; kn: 1e6 N/m; kt: 0 N/m; mu: 0; gn: 0 1/s",
                         i == 0 ? "" : "dt_margin: 0.25");
        const double v[3] = {-0.01, 0, 0}, zero[3] = {0, 0, 0};
        fixture_velocity(f, 1, v, zero);
        fixture_ledger(f);
        fixture_steps(f, 3000);
        e[i] = (f->sim.bodies.v[1][0] - f->sim.bodies.v[0][0]) / 0.01;
    }
    hard_row("mass ratio 1e4", "polyhedra", fabs(e[0] - 1) < 0.1 && fabs(e[1] - 1) < 0.03,
             "elastic impact at the automatic step: restitution 1 within 0.1, at half of it 0.03",
             "restitution %.4f, %.4f", e[0], e[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(coincident_faces),
        FIXTURE_TEST(slivers),
        FIXTURE_TEST(radius_ratio),
        FIXTURE_TEST(mass_ratio),
        FIXTURE_TEST(overlap_deeper_than_the_radius),
        FIXTURE_TEST(vertex_over_a_whole_cell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) + hard_failed;
}
