/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States in HDF5: all that is saved comes back, and a file that differs in any part is refused
 * before it is read into a simulation. */
#include "common/output/h5.h"
#include "common/output/io_h5.h"
#include "common/output/checksum_header.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const struct brc_h5_text texts[] = {{"case", "breccia: 1\n# \xc3\xa4\n"}, {"empty", ""}};
static const struct brc_h5_extra extra = {texts, 2, NULL, 0};

static void make_path(char path[64])
{
    snprintf(path, 64, "/tmp/breccia-test-%ld-state.h5", (long)getpid());
}

#define POINT_FIELDS(SCALAR, VECTOR)             \
    SCALAR(double, u, BRC_STATE, "m", "opening") \
    SCALAR(double, w, BRC_SCRATCH, "m", "not saved")
struct points {
    POINT_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};
#define BRC_OWNER struct points
static const struct brc_field point_fields[] = {POINT_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

/* The null model, with points that hold something. */
static void start_sim(struct fixture *f)
{
    struct brc_model model = brc_model_null;
    model.point_fields = (struct brc_fieldset)BRC_FIELDSET(point_fields, struct points);
    fixture_sim(f, &model, "", "", "");
}

/* A simulation of the null model with something in every table. */
static void make_sim(struct fixture *f)
{
    fixture_grid(f, 3, 2, 2, 0.01, 0.5);
    start_sim(f);
    fixture_steps(f, 25);
    const int32_t pair[][2] = {{0, 3}, {1, 2}, {1, 5}};
    CHECK_OK(&f->ctx, brc_contacts_set(&f->ctx, &f->sim.pairs, pair, 3));
    CHECK_OK(&f->ctx, brc_contacts_points(&f->ctx, &f->sim.pairs, 1, 4));
    CHECK_OK(&f->ctx, brc_contacts_points(&f->ctx, &f->sim.pairs, 0, 2));
    struct points *p = f->sim.pairs.point_columns; /* row 1 before row 0 */
    for (int i = 0; i < 6; i++)
        p->u[f->sim.pairs.p0[1] + i] = 100 + i;
    f->sim.pairs.f[2][1] = -12.5;
    f->sim.pairs.status[2] = BRC_BROKEN;
    const struct brc_event event = {.a = 1, .b = 5, .facet = 2, .mode = BRC_MODE_SHEAR};
    brc_events_add(&f->ctx, &f->sim.events, 17, &event);
    f->sim.bodies.energy[0][BRC_ACCOUNT_FRICTION] = 1.5;
    f->sim.rig.force_peak = 3e4;
}

static void save(struct fixture *f, const char *path)
{
    CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &extra));
}

static void test_round_trip(void **state)
{
    struct fixture *f = *state;
    char path[64], *text;
    make_path(path);
    make_sim(f);
    uint64_t hash = brc_sim_hash(&f->sim);
    save(f, path);
    assert_true(brc_sim_hash(&f->sim) == hash);
    start_sim(f);
    assert_false(brc_sim_hash(&f->sim) == hash);
    CHECK_OK(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra));
    assert_true(brc_sim_hash(&f->sim) == hash);
    assert_int_equal(f->sim.step, 25);
    assert_int_equal(f->sim.pairs.n, 3);
    assert_int_equal(f->sim.pairs.np[1], 4);
    assert_int_equal(f->sim.pairs.p0[1], 2);
    const struct points *p = f->sim.pairs.point_columns;
    const double expected[6] = {104, 105, 100, 101, 102, 103};
    CHECK_NEAR_ARRAY(p->u, expected, 6, 0, 0);
    assert_true(f->sim.pairs.f[2][1] == -12.5);
    assert_int_equal(f->sim.events.count[BRC_MODE_SHEAR], 1);
    assert_int_equal(f->sim.rig.curve.table.n, 2);
    assert_true(f->sim.ledger.friction == 1.5);
    CHECK_OK(&f->ctx, brc_h5_read_text(&f->ctx, path, "case", &text));
    assert_string_equal(text, texts[0].text);
    free(text);
    CHECK_OK(&f->ctx, brc_h5_read_text(&f->ctx, path, "empty", &text));
    assert_string_equal(text, "");
    free(text);
    unlink(path);
}

static void test_equal_states_give_equal_files(void **state)
{
    struct fixture *f = *state;
    char path[64], other[80], command[200];
    make_path(path);
    snprintf(other, sizeof other, "%s.2", path);
    make_sim(f);
    save(f, path);
    sleep(1); /* no time is written */
    save(f, other);
    snprintf(command, sizeof command, "cmp %s %s", path, other);
    assert_int_equal(system(command), 0);
    unlink(path);
    unlink(other);
}

static const struct {
    const char *field, *unit, *meaning, *shape; /* NULL: whatever it is */
} described[] = {
    {"bodies/x", "m", "centre of mass", "(bodies, 3)"},
    {"pairs/points/u", "m", NULL, "(pairs/points, 1)"},
    {"scalars/time", "s", NULL, NULL},
    {"events/mode", NULL, "0 tension, 1 shear, 2 torsion", NULL},
};

static int check_item(void *user, const struct brc_h5_item *item)
{
    for (size_t i = 0; i < sizeof described / sizeof described[0]; i++) {
        if (strcmp(item->path, described[i].field) != 0)
            continue;
        assert_true(!described[i].unit || strcmp(item->unit, described[i].unit) == 0);
        assert_true(!described[i].meaning || strcmp(item->meaning, described[i].meaning) == 0);
        assert_true(!described[i].shape || strcmp(item->shape, described[i].shape) == 0);
        ++*(size_t *)user;
    }
    return 0;
}

/* What another program finds: unit, meaning and shape of a field. */
static void test_table_describe_themselves(void **state)
{
    struct fixture *f = *state;
    char path[64];
    struct brc_h5_file file;
    size_t n = 0;
    make_path(path);
    make_sim(f);
    save(f, path);
    CHECK_OK(&f->ctx, brc_h5_open(&f->ctx, path, &brc_checksum_state, &file));
    CHECK_OK(&f->ctx, brc_h5_visit(&file, check_item, &n));
    assert_int_equal(n, sizeof described / sizeof described[0]);
    brc_h5_close(&file);
    unlink(path);
}

static void fails_to_load(struct fixture *f, const char *path, int code, const char *text)
{
    CHECK_FAILS(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra), code, text);
    start_sim(f);
}

/* Seals what stands behind the first skip bytes of a file. */
static void seal(const char *path, int format, size_t skip)
{
    char seal[BRC_CHECKSUM_SIZE], *bytes = malloc(1 << 20);
    FILE *file = fopen(path, "rb");
    assert_true(bytes && file);
    size_t n = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    assert_in_range(n, skip + 1, (1 << 20) - 1);
    const struct brc_checksum_kind kind = {"state", format};
    brc_checksum_make(seal, &kind, bytes + skip, n - skip);
    file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(seal, sizeof seal, 1, file), 1);
    assert_int_equal(fwrite(bytes + skip, n - skip, 1, file), 1);
    fclose(file);
    free(bytes);
}

static void test_foreign_files(void **state)
{
    struct fixture *f = *state;
    struct brc_model other = brc_model_null;
    char path[64];
    make_path(path);
    make_sim(f);
    save(f, path);
    other.name = "other";
    fixture_sim(f, &other, "", "", "");
    fails_to_load(f, path, BRC_ERR_INPUT, "model null, expected other");
    fixture_grid(f, 2, 2, 2, 0.01, 0.5);
    start_sim(f);
    fails_to_load(f, path, BRC_ERR_INPUT, "the case makes another specimen now");
    fixture_grid(f, 3, 2, 2, 0.01, 0.500001); /* as many bodies, elsewhere */
    start_sim(f);
    fails_to_load(f, path, BRC_ERR_INPUT, "the case makes another specimen now");
    unlink(path);
    fails_to_load(f, path, BRC_ERR_IO, "No such file");
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs("this is not an HDF5 file", out);
    fclose(out);
    fails_to_load(f, path, BRC_ERR_IO, "not a state file of breccia");
    seal(path, brc_checksum_state.format, 0);
    fails_to_load(f, path, BRC_ERR_IO, "not an HDF5 file");
    unlink(path);
}

static void flip(const char *path, long at)
{
    FILE *file = fopen(path, "r+");
    assert_non_null(file);
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 0x5a, file);
    assert_int_equal(fclose(file), 0);
}

/* Any byte that has changed, the seal's included, ends the load with one message; so does any byte
 * that is missing or too much. */
static void test_damage(void **state)
{
    struct fixture *f = *state;
    char path[64];
    make_path(path);
    make_sim(f);
    save(f, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    fclose(file);
    for (long at = 0; at < size; at += at < BRC_CHECKSUM_SIZE ? 1 : 97) {
        flip(path, at);
        CHECK_FAILS(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra),
                    at == 22 ? BRC_ERR_INPUT : BRC_ERR_IO, path);
        flip(path, at);
    }
    CHECK_OK(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra));
    file = fopen(path, "a");
    assert_non_null(file);
    fputc(0, file);
    fclose(file);
    CHECK_FAILS(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra), BRC_ERR_IO, "overwritten");
    for (long at = size - 1; at > 0; at /= 2) {
        assert_int_equal(truncate(path, at), 0);
        CHECK_FAILS(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra), BRC_ERR_IO, "cut short");
    }
    unlink(path);
}

static void test_other_format(void **state)
{
    struct fixture *f = *state;
    char path[64];
    make_path(path);
    make_sim(f);
    save(f, path);
    seal(path, brc_checksum_state.format + 1, BRC_CHECKSUM_SIZE);
    CHECK_FAILS(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &extra), BRC_ERR_INPUT,
                "has the state format 6, breccia " BRC_VERSION " reads 5");
    unlink(path);
}

static void test_failed_save_keeps_the_old_file(void **state)
{
    struct fixture *f = *state;
    char folder[64], path[80], command[300];
    snprintf(folder, sizeof folder, "/tmp/breccia-test-%ld", (long)getpid());
    snprintf(path, sizeof path, "%s/none/state.h5", folder);
    make_sim(f);
    CHECK_FAILS(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &extra), BRC_ERR_IO, "cannot write");
    /* the temporary's name is taken by a folder */
    snprintf(command, sizeof command, "mkdir -p %s/state.h5.part && echo old >%s/state.h5", folder,
             folder);
    assert_int_equal(system(command), 0);
    snprintf(path, sizeof path, "%s/state.h5", folder);
    CHECK_FAILS(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &extra), BRC_ERR_IO, "cannot write");
    snprintf(command, sizeof command, "grep -qx old %s && rm -r %s", path, folder);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(test_round_trip),
        FIXTURE_TEST(test_table_describe_themselves),
        FIXTURE_TEST(test_equal_states_give_equal_files),
        FIXTURE_TEST(test_foreign_files),
        FIXTURE_TEST(test_damage),
        FIXTURE_TEST(test_other_format),
        FIXTURE_TEST(test_failed_save_keeps_the_old_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
