/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames: what the meshes hold against the state they are made of, and when one is due. */
#include "common/frame_mesh.h"
#include "common/frames.h"
#include "tests/fixture.h"

#include <stdlib.h>

static const char specimen[] = "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                               "jitter: 0.6; seed: 3";
static const char test[] = "kind: compression; loading: fixed; rate: 1e-4 1/s; strain_max: 1";

/* Volume of each grain by the cones of its polygons over the origin: closed and outward, or it is
 * another one. */
static void check_grains(const struct fixture *f, const struct brc_frame_mesh *frame)
{
    const struct brc_mesh *m = &frame->grains;
    const struct brc_facets *s = &f->specimen.facets;
    double *volume = calloc(s->n_cells, sizeof *volume);
    assert_non_null(volume);
    for (size_t i = 0; i < m->n_cells; i++) {
        size_t first = i ? (size_t)m->end[i - 1] : 0;
        for (size_t k = first + 1; k + 1 < (size_t)m->end[i]; k++) {
            double cross[3];
            brc_cross(cross, m->point[m->id[k]], m->point[m->id[k + 1]]);
            volume[frame->grain_cells.grain[i]] += brc_dot(m->point[m->id[first]], cross) / 6;
        }
    }
    for (size_t c = 0; c < s->n_cells; c++)
        CHECK_NEAR(volume[c], s->volume[c], 0, 1e-9);
    free(volume);
    for (size_t i = 0; i < m->n_cells; i++) {
        int32_t grain = frame->grain_cells.grain[i];
        assert_true(frame->grain_cells.velocity[i][1] == f->sim.bodies.v[grain][1]);
    }
}

static void check_bonds(const struct fixture *f, const struct brc_frame_mesh *frame)
{
    const struct brc_bond_cells *cells = &frame->bond_cells;
    const struct brc_facets *s = &f->specimen.facets;
    const struct brc_events *e = &f->sim.events;
    double broken[BRC_N_MODES] = {0}, logged[BRC_N_MODES] = {0};
    size_t n_intact = 0, n_rows = 0;
    for (size_t i = 0; i < frame->bonds.n_cells; i++) {
        double area = s->area[cells->facet[i]];
        broken[BRC_MODE_TENSION] += cells->tension[i] * area;
        broken[BRC_MODE_SHEAR] += cells->shear[i] * area;
        broken[BRC_MODE_TORSION] += cells->torsion[i] * area;
        n_intact += cells->status[i] == BRC_INTACT;
        assert_true((cells->first_break[i] >= 0) == (cells->mode[i] >= 0));
    }
    for (size_t k = 0; k < e->table.n; k++)
        logged[e->mode[k]] += e->area[k];
    for (size_t k = 0; k < f->sim.pairs.n; k++)
        n_rows += f->sim.pairs.status[k] == BRC_INTACT;
    for (int mode = 0; mode < BRC_N_MODES; mode++)
        CHECK_NEAR(broken[mode], logged[mode], 0, 1e-12);
    assert_int_equal(n_intact, n_rows);
}

/* The lines carry what the grains get, and compression is the sense of the test. */
static void check_contacts(const struct fixture *f, const struct brc_frame_mesh *frame)
{
    const struct brc_contact_cells *cells = &frame->contact_cells;
    double platens[3] = {0, 0, 0}, pushed = 0;
    for (size_t i = 0; i < frame->contacts.n_cells; i++) {
        size_t first = 2 * i;
        assert_int_equal(frame->contacts.end[i], 2 * (i + 1));
        CHECK_NEAR_ARRAY(frame->contacts.point[first], f->sim.bodies.x[cells->a[i]], 3, 0, 0);
        if (!cells->is_platen[i])
            continue;
        assert_true((size_t)cells->b[i] >= f->sim.bodies.n_grains);
        brc_axpy(platens, 1, cells->force[i]);
        pushed += cells->compression[i];
    }
    CHECK_NEAR(pushed, 2 * f->sim.rig.force, 0, 1e-9);
    assert_true(fabs(platens[2]) < pushed);
}

static void test_meshes(void **state)
{
    struct fixture *f = *state;
    struct brc_frame_mesh frame;
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        if (fixture_is(model, "null"))
            continue;
        fixture_specimen(f, specimen);
        fixture_sim(f, model, "", test, "");
        fixture_steps(f, 450);
        assert_true(f->sim.events.table.n > 0);
        CHECK_OK(&f->ctx, brc_frame_mesh_make(&f->ctx, &f->sim, &frame));
        check_grains(f, &frame);
        check_bonds(f, &frame);
        check_contacts(f, &frame);
        brc_frame_mesh_free(&frame);
    }
}

/* Steps at which a frame is due, when each that is due is taken. */
static int taken(struct fixture *f, const char *settings, int n_steps, int64_t *steps)
{
    struct brc_output_params p;
    struct brc_frames frames;
    int n = 0;
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_output_param_list, &p));
    fixture_set(f, brc_output_param_list, &p, settings);
    fixture_sim(f, &brc_model_null, "",
                "kind: compression; loading: fixed; rate: 1e-3 1/s; strain_max: 0.05", "");
    brc_frames_init(&frames);
    for (int i = 0; i <= n_steps; i++) {
        if (brc_frames_is_due(&frames, &p, &f->sim)) {
            CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &frames.table, (size_t)n + 1));
            frames.step[n] = f->sim.step;
            frames.strain[n] = f->sim.rig.strain;
            steps[n++] = f->sim.step;
        }
        fixture_steps(f, 1);
    }
    brc_frames_free(&frames);
    return n;
}

static void test_schedule(void **state)
{
    struct fixture *f = *state;
    int64_t steps[64];
    fixture_grid(f, 2, 2, 2, 0.01, 0.3);
    assert_int_equal(taken(f, "", 49, steps), 0);
    assert_int_equal(taken(f, "frames: 5", 49, steps), 5);
    for (int i = 0; i < 5; i++)
        assert_int_equal(steps[i], 10 * i);
    assert_int_equal(taken(f, "frame_strain: 0.02", 49, steps), 3);
    assert_int_equal(steps[2], 40);
    assert_int_equal(taken(f, "frames: 5; frame_steps: 7", 49, steps), 8);
    assert_int_equal(steps[7], 49);
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(test_meshes), FIXTURE_TEST(test_schedule)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
