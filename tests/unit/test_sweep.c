/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a sweep: what names a run and what does not, the record, means, and that a kept run
 * which is not what the program computes is found. */
#include "common/output/h5.h"
#include "common/runs/run_key.h"
#include "common/runs/sweep.h"
#include "common/runs/sweep_cells.h"
#include "tests/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;

static const char head[] = "breccia: 1\nspecimen: {shape: box, grains: grid}\n";

/* ---- keys ---------------------------------------------------------------------------------- */

static struct brc_run_key key_of(const char *text, const struct brc_model *model)
{
    struct brc_case run_case;
    struct brc_run_key key;
    char all[1000];
    snprintf(all, sizeof all, "%s%s", head, text);
    CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", all));
    CHECK_OK(&ctx, brc_run_key_make(&ctx, &run_case, model, &key));
    brc_case_free(&run_case);
    return key;
}

static uint64_t hash_of(const char *text)
{
    struct brc_run_key key = key_of(text, brc_registry_find("vgcm"));
    free(key.text);
    return key.hash;
}

static void the_key_is_of_what_counts(void **state)
{
    (void)state;
    uint64_t plain = hash_of("");
    static const char *const same[] = {
        "vgcm: {e_bar: 48.8 GPa}\n",      "vgcm: {e_bar: 48800 MPa}\n", "title: another\n",
        "polyhedra: {mu: 0.1}\n",         "run: {simd: base}\n",        "run: {checkpoint: 1 s}\n",
        "run: {checkpoint_steps: 100}\n", "output: {plots: off}\n",     "model: polyhedra\n"};
    static const char *const other[] = {"vgcm: {e_bar: 48.9 GPa}\n", "test: {strain_max: 0.01}\n",
                                        "run: {max_steps: 5}\n",     "test: {kind: tension}\n",
                                        "vgcm: {softening: none}\n", "run: {ledger: off}\n"};
    for (size_t i = 0; i < sizeof same / sizeof same[0]; i++)
        if (hash_of(same[i]) != plain)
            fail_msg("%s moves the key", same[i]);
    for (size_t i = 0; i < sizeof other / sizeof other[0]; i++)
        if (hash_of(other[i]) == plain)
            fail_msg("%s does not move the key", other[i]);
    struct brc_run_key p = key_of("", brc_registry_find("polyhedra"));
    assert_true(p.hash != plain);
    assert_non_null(strstr(p.text, "\"polyhedra.kn\": \"auto\""));
    assert_null(strstr(p.text, "vgcm"));
    assert_null(strstr(p.text, "polyhedra.gn")); /* of the dynamic regime */
    free(p.text);
}

/* The versions of a model: its own and that of a law which the case chooses move the key, that of
 * another law does not. */
static void versions_move_the_key(void **state)
{
    (void)state;
    const struct brc_physics old[] = {{"vgcm", 1, NULL},
                                      {"brittle", 1, "softening=none"},
                                      {"softening", 1, "softening=linear|bilinear"},
                                      {NULL, 0, NULL}};
    struct brc_physics now[4];
    struct brc_model model = *brc_registry_find("vgcm");
    model.physics = now;
    const bool moves[] = {true, false, true};
    memcpy(now, old, sizeof now);
    struct brc_run_key plain = key_of("", &model);
    assert_non_null(strstr(plain.text, "vgcm 1, softening 1, compression 1\""));
    for (size_t i = 0; i < 3; i++) {
        memcpy(now, old, sizeof now);
        now[i].version = 2;
        struct brc_run_key key = key_of("", &model);
        assert_int_equal(key.hash != plain.hash, moves[i]);
        free(key.text);
    }
    free(plain.text);
}

struct option {
    double stiffness;
    int wear;
    double depth;
};
#define OPTION_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)          \
    REAL(stiffness, "Pa", "1 GPa", "(0, inf)", "there from the beginning") \
    FLAG(wear, "off", "added later", .off = "off")                         \
    REAL(depth, "m", "1 mm", "(0, inf)", "added later", NULL, .off = "1000 um")
#define BRC_OWNER struct option
static const struct brc_param option_params[] = {BRC_PARAM_LIST(OPTION_PARAMS)};
#undef BRC_OWNER

static char *section_text(const struct brc_case *run_case, int n, struct option *values)
{
    const struct brc_case_section s = {"later", {option_params, n, sizeof *values}, values};
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    CHECK_OK(&ctx, brc_run_key_section(&ctx, run_case, &s, out));
    fclose(out);
    return text;
}

/* An option that is added and off leaves all keys as they were; on, it moves them. */
static void an_option_that_is_off_moves_nothing(void **state)
{
    (void)state;
    struct brc_case run_case;
    CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", head));
    struct option values = {1e9, 0, 1e-3};
    char *before = section_text(&run_case, 1, &values), *off = section_text(&run_case, 3, &values);
    assert_string_equal(off, before);
    assert_string_equal(before, ", \"later.stiffness\": \"1 GPa\"");
    values.wear = 1;
    char *on = section_text(&run_case, 3, &values);
    assert_string_equal(on, ", \"later.stiffness\": \"1 GPa\", \"later.wear\": \"on\"");
    values = (struct option){1e9, 0, 2e-3};
    char *deep = section_text(&run_case, 3, &values);
    assert_string_equal(deep, ", \"later.stiffness\": \"1 GPa\", \"later.depth\": \"2 mm\"");
    free(before), free(off), free(on), free(deep);
    brc_case_free(&run_case);
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* A file counts by what it holds, not by its name. */
static void files_count_by_their_content(void **state)
{
    (void)state;
    char name[2][64], text[200];
    uint64_t hash[3];
    const char *const content[] = {"0 0 0\n", "0 0 0\n", "0 0 1\n"};
    for (int i = 0; i < 2; i++)
        snprintf(name[i], sizeof name[i], "/tmp/breccia_points_%ld_%d", (long)getpid(), i);
    for (int i = 0; i < 3; i++) {
        write_file(name[i == 1], content[i]);
        snprintf(text, sizeof text,
                 "breccia: 1\nspecimen: {shape: box, grains: points, points: %s}\n", name[i == 1]);
        struct brc_case run_case;
        struct brc_run_key key;
        CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", text));
        CHECK_OK(&ctx, brc_run_key_make(&ctx, &run_case, brc_registry_at(0), &key));
        hash[i] = key.hash;
        free(key.text);
        brc_case_free(&run_case);
    }
    assert_true(hash[0] == hash[1]);
    assert_true(hash[0] != hash[2]);
    unlink(name[0]);
    unlink(name[1]);
}

/* ---- means --------------------------------------------------------------------------------- */

static void means_are_students(void **state)
{
    (void)state;
    const double value[] = {1, NAN, 2, 3};
    struct brc_sweep_mean m = brc_sweep_mean(value, 4);
    assert_int_equal(m.n, 3);
    CHECK_NEAR(m.mean, 2, 0, 1e-15);
    CHECK_NEAR(m.standard_error, 1 / sqrt(3), 0, 1e-14);
    /* quantile p of two degrees of freedom, in closed form; GSL finds it to ten digits */
    double t = (2 * 0.975 - 1) / sqrt(2 * 0.975 * 0.025);
    CHECK_NEAR(m.high, 2 + t / sqrt(3), 0, 1e-9);
    CHECK_NEAR(m.low, 2 - t / sqrt(3), 0, 1e-9);
    m = brc_sweep_mean(value, 2);
    assert_int_equal(m.n, 1);
    CHECK_NEAR(m.mean, 1, 0, 0);
    assert_true(isnan(m.standard_error) && isnan(m.low) && isnan(m.high));
    m = brc_sweep_mean(value + 1, 1);
    assert_int_equal(m.n, 0);
    assert_true(isnan(m.mean));
}

/* ---- record -------------------------------------------------------------------------------- */

static char folder[64];

static const char *in_folder(const char *name)
{
    static char path[2][128];
    static int k;
    k = !k;
    snprintf(path[k], sizeof path[k], "%s/%s", folder, name);
    return path[k];
}

static int open_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/breccia_sweep_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int close_folder(void **state)
{
    static const char *const names[] = {"r.jsonl",       "c.yaml",       "s.yaml",
                                        "out/sweep.csv", "out/runs.csv", "out/sweep.h5",
                                        "out/runs.jsonl"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(in_folder(names[i]));
    rmdir(in_folder("out"));
    return rmdir(folder);
}

static void a_record_keeps_every_bit(void **state)
{
    (void)state;
    struct brc_outcome *o = calloc(1, sizeof *o);
    struct brc_run_record r;
    struct brc_pool pool = {0};
    struct brc_kept_run kept;
    struct brc_run_key key = key_of("", brc_registry_at(0)),
                       other = key_of("run: {max_steps: 3}\n", brc_registry_at(0));
    assert_non_null(o);
    o->summary.steps = 123456789012;
    o->summary.cpu_s = 1.0 / 3;
    o->summary.energy_residual = NAN;
    o->summary.state_hash = UINT64_C(0xfedcba9876543210);
    snprintf(o->summary.ended_by, sizeof o->summary.ended_by, "test.stop_drop");
    o->summary.n_results = 2;
    o->summary.results[0] = (struct brc_result){"E", 0.1 + 0.2, "Pa", NULL, false};
    o->summary.results[1] =
        (struct brc_result){"nu", NAN, "1", "a \"note\",\n of two lines", false};
    const char *path = in_folder("r.jsonl");
    CHECK_OK(&ctx, brc_run_record_open(&ctx, &r, path, false));
    const char *line = brc_run_record_line(&ctx, &pool, &key, o);
    CHECK_OK(&ctx, brc_run_record_add(&ctx, &r, line));
    brc_run_record_close(&r);
    CHECK_OK(&ctx, brc_run_record_open(&ctx, &r, path, true));
    assert_null(brc_run_record_find(&r, &other));
    line = brc_run_record_find(&r, &key);
    assert_non_null(line);
    CHECK_OK(&ctx, brc_run_record_read(&ctx, &pool, line, &kept));
    assert_int_equal(kept.steps, 123456789012);
    assert_true(kept.cpu_s == 1.0 / 3 && isnan(kept.energy_residual));
    assert_true(kept.state_hash == UINT64_C(0xfedcba9876543210));
    assert_string_equal(kept.ended_by, "test.stop_drop");
    assert_true(brc_kept_result(&kept, "E") == 0.1 + 0.2);
    assert_true(isnan(brc_kept_result(&kept, "nu")) && isnan(brc_kept_result(&kept, "K")));
    assert_string_equal(kept.result[1].note, "a \"note\",\n of two lines");
    brc_run_record_close(&r);
    brc_pool_free(&pool);
    free(key.text), free(other.text), free(o);
}

/* ---- a whole sweep ------------------------------------------------------------------------- */

/* One bit of the state is another one in the record than what the program computes; the digest of
 * the line is right. */
static void a_forged_bit_is_found(void **state)
{
    (void)state;
    char *const path = strdup(in_folder("s.yaml"));
    write_file(in_folder("c.yaml"), "breccia: 1\nmodel: vgcm\nspecimen: {shape: box, grains: grid, "
                                    "cells: [2, 2, 2]}\nrun: {max_steps: 20}\n");
    write_file(path, "breccia: 1\ncase: c.yaml\n");
    char *const dir = strdup(in_folder("out")), *const cache = strdup(in_folder("r.jsonl"));
    struct brc_sweep_options options = {.path = path, .dir = dir, .cache = cache, .jobs = 1};
    ctx.quiet = 1;
    CHECK_OK(&ctx, brc_sweep(&ctx, &options));
    options.verify = "100%";
    CHECK_OK(&ctx, brc_sweep(&ctx, &options));
    /* with another state, and its digest */
    FILE *file = fopen(cache, "r+");
    char *text = NULL;
    size_t size = 0;
    assert_true(file && getline(&text, &size, file) > 0);
    char *hash = strstr(text, "\"state_hash\": \""), *tail = strstr(text, ", \"digest\"");
    assert_true(hash && tail);
    hash[15] = hash[15] == '0' ? '1' : '0';
    sprintf(tail, ", \"digest\": \"%016llx\"}\n",
            (unsigned long long)brc_hash_bytes(text, (size_t)(tail - text), BRC_HASH_SEED));
    rewind(file);
    fputs(text, file);
    fclose(file);
    free(text);
    CHECK_FAILS(&ctx, brc_sweep(&ctx, &options), BRC_ERR_RUNS, "IS NOT AS KEPT: state ");
    ctx.quiet = 0;
    free(dir), free(cache), free(path);
}

static void tables_are_in_hdf5(void **state)
{
    (void)state;
    struct brc_h5_file f;
    double value[BRC_MAX_RESULTS];
    char *const path = strdup(in_folder("s.yaml")), *const dir = strdup(in_folder("out"));
    write_file(in_folder("c.yaml"), "breccia: 1\nspecimen: {shape: box, grains: grid, "
                                    "cells: [2, 2, 2]}\nrun: {max_steps: 20}\n");
    write_file(path, "breccia: 1\ncase: c.yaml\naxes: {model: [vgcm, polyhedra], specimen.seed: "
                     "1..3}\ncollect: broken_tension\n");
    const struct brc_sweep_options options = {.path = path, .dir = dir, .jobs = 2};
    ctx.quiet = 1;
    CHECK_OK(&ctx, brc_sweep(&ctx, &options));
    ctx.quiet = 0;
    CHECK_OK(&ctx, brc_h5_open(&ctx, in_folder("out/sweep.h5"), &brc_checksum_tables, &f));
    struct brc_h5_array a = {
        .name = "sweep/runs", .type = BRC_F64, .rows = 2, .width = 1, .is_flat = true};
    CHECK_OK(&ctx, brc_h5_get_array(&f, &a, value));
    CHECK_NEAR(value[0], 3, 0, 0);
    a = (struct brc_h5_array){
        .name = "runs/steps", .type = BRC_F64, .rows = 6, .width = 1, .is_flat = true};
    CHECK_OK(&ctx, brc_h5_get_array(&f, &a, value));
    CHECK_NEAR(value[5], 20, 0, 0);
    brc_h5_close(&f);
    free(path), free(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_key_is_of_what_counts),
        cmocka_unit_test(versions_move_the_key),
        cmocka_unit_test(an_option_that_is_off_moves_nothing),
        cmocka_unit_test(files_count_by_their_content),
        cmocka_unit_test(means_are_students),
        cmocka_unit_test_setup_teardown(a_record_keeps_every_bit, open_folder, close_folder),
        cmocka_unit_test_setup_teardown(a_forged_bit_is_found, open_folder, close_folder),
        cmocka_unit_test_setup_teardown(tables_are_in_hdf5, open_folder, close_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
