/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames: what the meshes hold against the state they are made of, and when one is due. */
#include "common/output/frame_mesh.h"
#include "common/output/frames.h"
#include "common/output/vtk.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char specimen[] = "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                               "jitter: 0.6; seed: 3";
static const char test[] = "kind: compression; loading: fixed; rate: 1e-4 1/s; strain_max: 0.99";

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

static char folder[] = "/tmp/breccia-test-XXXXXX";
static const struct brc_h5_extra nothing = {NULL, 0, NULL, 0};

/* A run with frames as run.c makes it, to its end or for n steps; its steps with a frame. save_at:
 * the step at which the frames are saved, as with a state. */
static size_t run(struct fixture *f, const char *settings, int64_t n, int64_t save_at,
                  struct brc_frames *frames)
{
    struct brc_output_params p;
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_output_param_list, &p));
    fixture_set(f, brc_output_param_list, &p, settings);
    brc_frames_init(frames);
    while (f->sim.step < n && !brc_rigs_done(&f->sim)) {
        CHECK_OK(&f->ctx, brc_frames_update(&f->ctx, frames, folder, &p, &f->sim, &nothing));
        fixture_steps(f, 1);
        if (f->sim.step == save_at) {
            CHECK_OK(&f->ctx, brc_frames_flush(&f->ctx, frames, folder, &nothing));
            CHECK_OK(&f->ctx, brc_frames_sweep(&f->ctx, frames, folder));
        }
    }
    CHECK_OK(&f->ctx, brc_frames_flush(&f->ctx, frames, folder, &nothing));
    CHECK_OK(&f->ctx, brc_frames_sweep(&f->ctx, frames, folder));
    if (brc_frames_are_on(&p))
        CHECK_OK(&f->ctx, brc_frames_write(&f->ctx, frames, folder, &f->sim, &nothing));
    return frames->table.n;
}

static bool is_there(const char *kind, int64_t step)
{
    char name[64], path[128];
    brc_vtk_name(name, sizeof name, kind, step);
    snprintf(path, sizeof path, "%s/frames/%s", folder, name);
    return access(path, R_OK) == 0;
}

static void forget(struct fixture *f, struct brc_frames *frames)
{
    brc_frames_free(frames);
    CHECK_OK(&f->ctx, brc_frames_sweep(&f->ctx, NULL, folder));
}

/* Frames by steps or strain, and at the end; without a load there is no peak. */
static void test_intervals(void **state)
{
    struct fixture *f = *state;
    struct brc_frames frames;
    static const struct {
        const char *settings;
        int64_t step[9]; /* -1: the end */
    } cases[] = {{"", {-1}},
                 {"frame_strain: 0.02", {0, 20, 40, 49, -1}},
                 {"frames: 5; frame_steps: 14", {0, 14, 28, 42, 49, -1}}};
    fixture_grid(f, 2, 2, 2, 0.01, 0.3);
    for (int k = 0; k < 3; k++) {
        size_t n = 0;
        fixture_sim(f, &brc_model_null, "",
                    "kind: compression; loading: fixed; rate: 1e-3 1/s; strain_max: 0.05", "");
        run(f, cases[k].settings, 49, -1, &frames);
        for (; cases[k].step[n] >= 0; n++)
            assert_int_equal(frames.step[n], cases[k].step[n]);
        assert_int_equal(frames.table.n, n);
        forget(f, &frames);
    }
}

/* As many as are asked for, one of them at the peak, evenly by what happens, and each is on disk:
 * in a test that ends early and suddenly. The simulation does not feel them, nor does saving. */
static void test_what_happens(void **state)
{
    struct fixture *f = *state;
    struct brc_frames frames, again;
    fixture_specimen(f, specimen);
    for (int i = 0; i < brc_registry_count(); i++)
        for (int asked = 3; asked <= 24; asked = 2 * asked) {
            const struct brc_model *model = brc_registry_at(i);
            char settings[32];
            snprintf(settings, sizeof settings, "frames: %d", asked);
            fixture_sim(f, model, "", "kind: tension; strain_max: 0.1", "");
            size_t n = run(f, settings, INT64_MAX, -1, &frames);
            uint64_t hash = brc_sim_hash(&f->sim);
            print_message("%s: %d frames asked, %zu\n", model->name, asked, n);
            CHECK_BETWEEN((double)n, asked, asked + 2);
            const struct brc_rig *rig = &f->sim.rig;
            int peaks = 0;
            for (size_t k = 0; k < n; k++) {
                assert_true(is_there("grains", frames.step[k]) &&
                            is_there("contacts", frames.step[k]));
                peaks += frames.force[k] == rig->force_peak;
            }
            assert_int_equal(peaks, 1);
            assert_true(frames.step[0] == 0 && frames.step[n - 1] == f->sim.step);
            /* no gap of strain up to the peak is wider than a few frames' share */
            for (size_t k = 1; k < n && frames.strain[k] <= rig->strain_peak; k++)
                CHECK_BETWEEN(frames.strain[k] - frames.strain[k - 1], 0,
                              6 * rig->strain_peak / asked);
            fixture_sim(f, model, "", "kind: tension; strain_max: 0.1", "");
            assert_int_equal(run(f, settings, INT64_MAX, frames.step[n / 2] + 1, &again), n);
            assert_true(brc_sim_hash(&f->sim) == hash);
            assert_memory_equal(again.step, frames.step, n * sizeof *again.step);
            fixture_sim(f, model, "", "kind: tension; strain_max: 0.1", "");
            while (!brc_rigs_done(&f->sim))
                fixture_steps(f, 1);
            assert_true(brc_sim_hash(&f->sim) == hash);
            brc_frames_free(&again);
            forget(f, &frames);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(test_meshes), FIXTURE_TEST(test_intervals),
                                       FIXTURE_TEST(test_what_happens)};
    if (!mkdtemp(folder))
        return 1;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    rmdir(folder);
    return failed;
}
