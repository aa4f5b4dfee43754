/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every test must hold, whatever the model: run over all registered tests, the null one, and
 * one with state and columns of its own. */
#include "common/output/io_h5.h"
#include "common/output/output.h"
#include "common/rigs/readings.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern const struct brc_rig_type brc_rig_null;

/* ---- a test with a scalar and a column of its own -------------------------------------------- */

#define COUNT_STATE(SCALAR, VECTOR)  SCALAR(int64_t, n_driven, BRC_STATE, "1", "steps driven")
#define COUNT_COLUMN(SCALAR, VECTOR) SCALAR(int64_t, n_rows, BRC_STATE, "1", "rows so far")
#define BRC_OWNER                    struct count
struct count {
    COUNT_STATE(BRC_COLUMN, BRC_COLUMN3)
};
static const struct brc_field count_state[] = {COUNT_STATE(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER
#define BRC_OWNER struct counts
struct counts {
    COUNT_COLUMN(BRC_COLUMN, BRC_COLUMN3)
};
static const struct brc_field count_columns[] = {COUNT_COLUMN(BRC_FIELD, BRC_FIELD3)};
static const struct brc_quantity quantities[] = {{"n_driven", "1", "steps driven"}};

static int place(struct brc_sim *sim)
{
    return sim->ctx->code;
}
static int drive(struct brc_sim *sim)
{
    ((struct count *)sim->rig.own_scalars)->n_driven[0]++;
    return 0;
}
static int measure(struct brc_sim *sim)
{
    size_t row;
    BRC_TRY(brc_rig_add_row(sim->ctx, &sim->rig, &row));
    ((struct counts *)sim->rig.curve.own_columns)->n_rows[row] = (int64_t)row;
    return 0;
}
static void results(const struct brc_sim *sim, struct brc_measured *out)
{
    out[0].value = (double)((struct count *)sim->rig.own_scalars)->n_driven[0];
}
static const char *end(const struct brc_sim *sim)
{
    return sim->rig.curve.table.n >= 60 ? "60 rows" : NULL;
}
static const struct brc_rig_type rig_count = {.name = "count",
                                              .meaning = "counts",
                                              .keys = "",
                                              .quantities = quantities,
                                              .n_quantities = 1,
                                              .state = BRC_FIELDSET(count_state, struct count),
                                              .columns = BRC_FIELDSET(count_columns, struct counts),
                                              .place = place,
                                              .drive = drive,
                                              .measure = measure,
                                              .results = results,
                                              .end = end};

/* ---- the suite ------------------------------------------------------------------------------- */

static int n_rigs(void)
{
    return brc_rigs_count() + 2;
}

static const struct brc_rig_type *rig_at(int i)
{
    int own = i - brc_rigs_count();
    return own < 0 ? brc_rigs_at(i) : own == 0 ? &brc_rig_null : &rig_count;
}

/* A small disc, loaded fast, so that tests can be made on it to their end; six platens need a box.
 */
static void build(struct fixture *f, const struct brc_rig_type *rig)
{
    bool is_box = rig->n_platens == 6;
    if (f->has_specimen && is_box == (f->specimen.params.shape == BRC_SHAPE_BOX))
        return;
    fixture_specimen(f, is_box ? "shape: box; size: 2 cm, 2 cm, 2 cm; grains: packing; "
                                 "diameter_min: 5 mm; diameter_max: 7 mm; seed: 2; cache: off"
                               : "shape: cylinder; diameter: 2 cm; height: 2 cm; grains: packing; "
                                 "diameter_min: 5 mm; diameter_max: 7 mm; seed: 2; cache: off");
}

static void start(struct fixture *f, const struct brc_model *model, const struct brc_rig_type *rig)
{
    struct brc_test_params params;
    struct brc_run_params run;
    void *values = calloc(1, model->params.owner_size + 1), *own = NULL;
    fixture_drop_sim(f);
    build(f, rig);
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, model->params, values));
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_test_param_list, &params));
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_run_param_list, &run));
    if (rig->params.n > 0) {
        own = calloc(1, rig->params.owner_size);
        CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, rig->params, own));
        if (fixture_is(model, "null") && brc_params_find(rig->params, "load"))
            fixture_set(f, rig->params, own, "load: 1e-9 N"); /* nothing holds its grains */
    }
    params.target = 0.02;
    params.strain_max = 0.02;
    const struct brc_test test = {rig, &params, own};
    int code = brc_sim_create(&f->ctx, &f->sim, model, values, &f->specimen, &test, &run);
    free(values);
    free(own);
    CHECK_OK(&f->ctx, code);
    f->has_sim = true;
}

static void each(struct fixture *f, void (*check)(struct fixture *f))
{
    for (int m = 0; m < fixture_n_models(); m++)
        for (int i = 0; i < n_rigs(); i++) {
            start(f, fixture_model(m), rig_at(i));
            check(f);
        }
}

static void check_balance(struct fixture *f)
{
    double balance[2];
    fixture_steps(f, 40);
    fixture_forces(
        f); /* those of contacts and weight alone: a dead load is balanced at rest only */
    fixture_balance(f, balance);
    CHECK_NEAR(balance[0], 0, 1e-12, 0);
    CHECK_NEAR(balance[1], 0, 1e-11, 0);
}

static void forces_balance(void **state)
{
    each(*state, check_balance);
}

/* What a test adds to the forces and moments on grains as it drives, in a step and in the one
 * before: seen by driving it through a copy of its table. */
static struct outside {
    const struct brc_rig_type *type;
    struct brc_rig_type seen;
    double (*now)[6], (*before)[6];
} outside;

static int drive_seen(struct brc_sim *sim)
{
    struct brc_bodies *b = &sim->bodies;
    memcpy(outside.before, outside.now, b->n_grains * sizeof *outside.now);
    for (size_t i = 0; i < b->n_grains; i++)
        for (int k = 0; k < 6; k++)
            outside.now[i][k] = -(k < 3 ? b->f : b->t)[i][k % 3];
    int code = outside.type->drive(sim);
    for (size_t i = 0; i < b->n_grains; i++)
        for (int k = 0; k < 6; k++)
            outside.now[i][k] += (k < 3 ? b->f : b->t)[i][k % 3];
    return code;
}

/* By the trapezoid rule, over the velocities of the step that has been made. */
static double outside_work(const struct fixture *f, double (*v)[6], double *size)
{
    double work = 0;
    for (size_t i = 0; i < f->sim.bodies.n_grains; i++)
        for (int k = 0; k < 6; k++) {
            double mean = 0.5 * (outside.before[i][k] + outside.now[i][k]);
            work += mean * v[i][k] * f->sim.dt;
            *size += fabs(mean * v[i][k] * f->sim.dt);
        }
    return work;
}

/* The work of each platen's force over its way, and of what a test adds from outside, by the
 * trapezoid rule, is the boundary's. */
static void check_work(struct fixture *f)
{
    struct brc_rig *rig = &f->sim.rig;
    size_t n = f->sim.bodies.n_grains;
    double work = f->sim.ledger.boundary, size = 0, (*v)[6] = calloc(n, sizeof *v);
    outside = (struct outside){rig->type, *rig->type, calloc(n, sizeof *v), calloc(n, sizeof *v)};
    outside.seen.drive = drive_seen;
    rig->type = &outside.seen;
    for (int k = 0; k < 60; k++) {
        double before[BRC_MAX_PLATENS], way[BRC_MAX_PLATENS];
        for (size_t i = 0; i < n; i++) {
            brc_copy(v[i], f->sim.bodies.v[i]);
            brc_copy(v[i] + 3, f->sim.bodies.w[i]);
        }
        for (int i = 0; i < rig->n_platens; i++) {
            before[i] = rig->platen[i].force;
            way[i] = brc_dot(f->sim.bodies.v[rig->platen[i].body], rig->platen[i].n) * f->sim.dt;
        }
        fixture_steps(f, 1);
        for (int i = 0; i < rig->n_platens; i++) {
            double part = 0.5 * (before[i] + rig->platen[i].force) * way[i];
            work += part;
            size += fabs(part);
        }
        work += outside_work(f, v, &size);
    }
    rig->type = outside.type;
    free(v);
    free(outside.now);
    free(outside.before);
    CHECK_NEAR(f->sim.ledger.boundary, work, 1e-12 * size, 0);
    if (rig->n_platens > 0 && !fixture_is(&f->sim.model, "null"))
        assert_true(size > 0);
}

static void work_is_the_boundary_term(void **state)
{
    each(*state, check_work);
}

static void check_restart(struct fixture *f)
{
    static const struct brc_h5_extra nothing = {NULL, 0, NULL, 0};
    const struct brc_model *model = brc_registry_find(f->sim.model.name);
    const struct brc_rig_type *rig = f->sim.rig.type;
    char path[64];
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-rigs.h5", (long)getpid());
    fixture_steps(f, 37);
    CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &nothing));
    fixture_steps(f, 30);
    uint64_t hash = brc_sim_hash(&f->sim);
    start(f, model ? model : &brc_model_null, rig);
    CHECK_OK(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &nothing));
    fixture_steps(f, 30);
    assert_true(brc_sim_hash(&f->sim) == hash);
    unlink(path);
}

static void restart_gives_the_same_bits(void **state)
{
    each(*state, check_restart);
}

/* What is declared is given, in order, and a value that is none says why. */
static void check_results(struct fixture *f)
{
    const struct brc_rig_type *rig = f->sim.rig.type;
    struct brc_result result[BRC_MAX_RESULTS];
    fixture_steps(f, 20);
    int n = brc_rigs_results(&f->sim, result);
    assert_int_equal(n, rig->n_quantities + BRC_N_READINGS);
    assert_true(n <= BRC_MAX_RESULTS);
    for (int i = 0; i < rig->n_quantities; i++) {
        assert_string_equal(result[i].name, rig->quantities[i].name);
        assert_string_equal(result[i].unit, rig->quantities[i].unit);
        assert_true(strlen(rig->quantities[i].meaning) > 0);
    }
    for (int i = 0; i < n; i++)
        assert_true(isfinite(result[i].value) || result[i].note);
    for (int i = 0; i < BRC_N_READINGS; i++) {
        assert_string_equal(result[rig->n_quantities + i].name, brc_readings_quantities[i].name);
        assert_true(strlen(brc_readings_quantities[i].meaning) > 0);
    }
    for (const char *at = rig->keys; *at;) { /* keys that are there */
        char key[64];
        size_t length = strcspn(at, " ");
        snprintf(key, sizeof key, "%.*s", (int)length, at);
        assert_true(length == 0 || brc_params_find(brc_test_param_list, key));
        at += length + (at[length] == ' ');
    }
}

static void results_declared_are_results_given(void **state)
{
    each(*state, check_results);
}

static void an_end_is_reached(void **state)
{
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++)
        for (int i = 0; i < n_rigs(); i++) {
            if (rig_at(i)->n_platens == 0 && !rig_at(i)->end)
                continue; /* left to itself, it ends by run.max_steps */
            start(f, brc_registry_at(m), rig_at(i));
            while (!brc_rigs_done(&f->sim) && f->sim.step < 20000)
                fixture_steps(f, 1);
            print_message("%s, %s: %lld steps\n", brc_registry_at(m)->name, rig_at(i)->name,
                          (long long)f->sim.step);
            assert_true(brc_rigs_done(&f->sim));
        }
}

/* A test's own columns stand behind the curve's, row by row. */
static void own_columns_are_written(void **state)
{
    struct fixture *f = *state;
    char folder[] = "/tmp/breccia-test-rigs-XXXXXX", path[64], line[1024];
    assert_non_null(mkdtemp(folder));
    start(f, &brc_model_null, &rig_count);
    fixture_steps(f, 3);
    CHECK_OK(&f->ctx, brc_output_csv(&f->ctx, folder, "curve.csv", &f->sim.rig.curve.table,
                                     &f->sim.rig.curve.own));
    snprintf(path, sizeof path, "%s/curve.csv", folder);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    assert_non_null(fgets(line, sizeof line, in));
    assert_non_null(strstr(line, ",broken [1],n_rows [1]\n"));
    for (int row = 0; row < 3; row++) {
        char end[8];
        snprintf(end, sizeof end, ",0,%d\n", row);
        assert_non_null(fgets(line, sizeof line, in));
        assert_non_null(strstr(line, end));
    }
    assert_null(fgets(line, sizeof line, in));
    fclose(in);
    unlink(path);
    rmdir(folder);
}

static void incomplete_tables_are_refused(void **state)
{
    struct fixture *f = *state;
    struct brc_rig_type rig = brc_rig_null;
    const struct brc_test test = {&rig, NULL, NULL};
    CHECK_OK(&f->ctx, brc_rig_check(&f->ctx, &test));
    rig.drive = NULL;
    CHECK_FAILS(&f->ctx, brc_rig_check(&f->ctx, &test), BRC_ERR_INTERNAL,
                "test null lacks a required operation");
    rig = brc_rig_null;
    rig.n_quantities = BRC_MAX_QUANTITIES + 1;
    CHECK_FAILS(&f->ctx, brc_rig_check(&f->ctx, &test), BRC_ERR_INTERNAL, "25 quantities");
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(forces_balance),
                                       FIXTURE_TEST(work_is_the_boundary_term),
                                       FIXTURE_TEST(restart_gives_the_same_bits),
                                       FIXTURE_TEST(results_declared_are_results_given),
                                       FIXTURE_TEST(an_end_is_reached),
                                       FIXTURE_TEST(own_columns_are_written),
                                       FIXTURE_TEST(incomplete_tables_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
