/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON and CSV as other programs read them, with texts and numbers that break simple writers. */
#include "common/runs/compare.h"
#include "tests/near.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* ---- a strict JSON reader: returns the end of the value, NULL where it is none -----------------
 */

static const char *skip_blanks(const char *c)
{
    return c ? c + strspn(c, " \n\t\r") : NULL;
}

static const char *json_string(const char *c)
{
    if (*c++ != '"')
        return NULL;
    for (; *c != '"'; c++) {
        if ((unsigned char)*c < 0x20)
            return NULL;
        if (*c != '\\')
            continue;
        c++;
        if (!*c || !strchr("u\"\\/bfnrt", *c))
            return NULL;
        for (int i = 0; i < 4 && *c == 'u'; i++)
            if (!isxdigit((unsigned char)c[i + 1]))
                return NULL;
    }
    return c + 1;
}

static const char *json_value(const char *c);

static const char *json_object(const char *c)
{
    c = skip_blanks(c + 1);
    if (*c == '}')
        return c + 1;
    for (;;) {
        c = skip_blanks(json_string(c));
        if (!c || *c != ':')
            return NULL;
        c = skip_blanks(json_value(skip_blanks(c + 1)));
        if (!c || *c == '}')
            return c ? c + 1 : NULL;
        if (*c != ',')
            return NULL;
        c = skip_blanks(c + 1);
    }
}

static const char *json_value(const char *c)
{
    static const char *const words[] = {"true", "false", "null"};
    char *end;
    if (*c == '{')
        return json_object(c);
    if (*c == '"')
        return json_string(c);
    for (int i = 0; i < 3; i++)
        if (strncmp(c, words[i], strlen(words[i])) == 0)
            return c + strlen(words[i]);
    if (!isdigit((unsigned char)*c) && *c != '-')
        return NULL;
    strtod(c, &end);
    return end > c ? end : NULL;
}

/* ---- helpers ------------------------------------------------------------------------------- */

static char *read_all(const char *path)
{
    FILE *in = fopen(path, "r");
    char *text = calloc(1 << 16, 1);
    assert_non_null(in);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 16) - 1, in) < (1 << 16) - 1);
    fclose(in);
    return text;
}

static void make_path(char path[64], const char *name)
{
    snprintf(path, 64, "/tmp/breccia-test-%ld-%s", (long)getpid(), name);
}

static struct brc_summary sample(void)
{
    struct brc_summary s = {
        .model = "vgcm",
        .title = "a \"quoted\" back\\slash\nline",
        .case_name = "demo",
        .ended_by = "test.stop_drop",
        .is_finished = true,
        .seed = 7,
        .n_grains = 500,
        .steps = INT64_C(12345678901),
        .cpu_s = 0.1,
        .ns_per_contact_step = NAN,
        .energy_residual = HUGE_VAL,
        .state_hash = UINT64_C(0x00ab00000000000f),
        .n_results = 2,
        .results = {{.name = "E", .value = 48.8e9, .unit = "Pa"},
                    {.name = "nu", .value = NAN, .unit = "1", .note = "no \"gauge\""}}};
    return s;
}

/* ---- tests --------------------------------------------------------------------------------- */

static void test_summary_is_json(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_summary s = sample();
    char path[64];
    make_path(path, "summary.json");
    CHECK_OK(&ctx, brc_output_summary(&ctx, NULL, path, &s));
    char *text = read_all(path);
    const char *end = json_value(text);
    assert_non_null(end);
    assert_string_equal(end, "\n");
    assert_non_null(strstr(text, "\"steps\": 12345678901,"));
    assert_non_null(strstr(text, "\"state_hash\": \"00ab00000000000f\""));
    assert_non_null(strstr(text, "\"cpu_s\": 0.10000000000000001,"));
    assert_non_null(strstr(text, "\"ns_per_contact_step\": null"));
    assert_non_null(strstr(text, "\"energy_residual\": null"));
    assert_non_null(strstr(text, "\"energy\": {\n    \"kinetic\": null,")); /* no ledger */
    assert_non_null(strstr(text, "\"E\": {\"value\": 48800000000, \"unit\": \"Pa\"}"));
    assert_non_null(
        strstr(text, "\"nu\": {\"value\": null, \"unit\": \"1\", \"note\": \"no \\\"gauge\\\"\"}"));
    assert_non_null(strstr(text, "a \\\"quoted\\\" back\\\\slash\\u000aline"));
    free(text);
    unlink(path);
}

static void test_empty_results(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_summary s = sample();
    char path[64];
    s.n_results = 0;
    s.energy_check = BRC_ENERGY_GOOD;
    s.ledger.damage = 0.25;
    make_path(path, "empty.json");
    CHECK_OK(&ctx, brc_output_summary(&ctx, NULL, path, &s));
    char *text = read_all(path);
    assert_non_null(json_value(text));
    assert_non_null(strstr(text, "\"damage\": 0.25,"));
    free(text);
    unlink(path);
}

static void test_unwritable(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_summary s = sample();
    CHECK_FAILS(&ctx, brc_output_summary(&ctx, "/nowhere", "summary.json", &s), BRC_ERR_IO,
                "/nowhere/summary.json");
}

#define ROW_FIELDS(SCALAR, VECTOR)                \
    SCALAR(int64_t, step, BRC_STATE, "1", "step") \
    VECTOR(double, x, 3, BRC_STATE, "m", "place") \
    SCALAR(uint8_t, mode, BRC_STATE, "1", "mode")
struct rows {
    ROW_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};
#define BRC_OWNER struct rows
static const struct brc_field row_fields[] = {ROW_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

static void test_csv(void **state)
{
    (void)state;
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct rows rows = {0};
    struct brc_table table;
    struct brc_fieldset set = BRC_FIELDSET(row_fields, struct rows);
    char path[64];
    make_path(path, "rows.csv");
    brc_table_init(&table, "rows", set, &rows);
    CHECK_OK(&ctx, brc_table_resize(&ctx, &table, 2));
    rows.step[1] = -3;
    rows.x[1][0] = 0.1;
    rows.x[1][2] = 1e-300;
    rows.mode[1] = 255;
    CHECK_OK(&ctx, brc_output_csv(&ctx, NULL, path, &table, NULL));
    char *text = read_all(path);
    assert_string_equal(text, "step [1],x_1 [m],x_2 [m],x_3 [m],mode [1]\n"
                              "0,0,0,0,0\n"
                              "-3,0.10000000000000001,0,1e-300,255\n");
    free(text);
    brc_table_free(&table);
    unlink(path);
}

static void test_table(void **state)
{
    (void)state;
    struct brc_summary a = sample(), b = sample();
    const struct brc_summary *both[] = {&a, &b};
    char *text = NULL;
    size_t size = 0;
    strcpy(b.model, "polyhedra");
    b.is_finished = false;
    strcpy(b.ended_by, "run.max_steps");
    b.results[0].value = 0.5e9;
    b.results[1] = (struct brc_result){.name = "strength", .value = 12.34e6, .unit = "Pa"};
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    brc_compare_table(out, both, 2);
    fclose(out);
    assert_non_null(strstr(text, "vgcm       polyhedra\n"));
    assert_non_null(strstr(text, "E [GPa]                              48.80          0.5000\n"));
    /* nu was not measured by the one and is unknown to the other */
    assert_non_null(strstr(text, "nu                                       -               -\n"));
    assert_non_null(strstr(text, "polyhedra did not reach the end of the test: ended by "
                                 "run.max_steps\n"));
    assert_non_null(strstr(text, "\nvgcm: nu: no \"gauge\"\n"));
    free(text);
}

/* Details are for files: neither they nor why there are none are on the screen. */
static void test_details_are_not_in_the_table(void **state)
{
    (void)state;
    struct brc_summary s = sample();
    const struct brc_summary *one = &s;
    char *text = NULL;
    size_t size = 0;
    s.n_results = 4;
    s.results[2] =
        (struct brc_result){.name = "b_value", .value = 1.5, .unit = "1", .is_detail = 1};
    s.results[3] = (struct brc_result){
        .name = "n_events", .value = NAN, .unit = "1", .note = "no \"gauge\"", .is_detail = true};
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    brc_compare_table(out, &one, 1);
    fclose(out);
    assert_null(strstr(text, "b value"));
    assert_null(strstr(text, "n_events"));
    assert_non_null(strstr(text, "\nvgcm: nu: no \"gauge\"\n"));
    free(text);
}

/* The last line of the table of one run. */
static char *end_of_table(const struct brc_summary *s)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    brc_compare_table(out, &s, 1);
    fclose(out);
    char *last = text + size - 1; /* its newline */
    while (last > text && last[-1] != '\n')
        last--;
    last = strdup(last);
    free(text);
    return last;
}

/* A run that has not failed says so; one that has says nothing. */
static void test_end_of_table(void **state)
{
    (void)state;
    struct brc_summary s = sample();
    s.results[1] = (struct brc_result){.name = "strength", .value = 12.34e6, .unit = "Pa"};
    char *text = end_of_table(&s);
    assert_null(strstr(text, "ended by"));
    free(text);
    strcpy(s.ended_by, "test.strain_max");
    text = end_of_table(&s);
    assert_string_equal(text, "vgcm: ended by test.strain_max, past its peak, before the load had "
                              "fallen to test.stop_drop\n");
    free(text);
    s.results[0] =
        (struct brc_result){.name = "force_peak", .value = NAN, .unit = "N", .note = "no peak"};
    s.results[1] =
        (struct brc_result){.name = "strength", .value = NAN, .unit = "Pa", .note = "no peak"};
    text = end_of_table(&s);
    assert_string_equal(text, "vgcm: force_peak, strength: no peak\n");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_summary_is_json), cmocka_unit_test(test_empty_results),
        cmocka_unit_test(test_unwritable),      cmocka_unit_test(test_csv),
        cmocka_unit_test(test_table),           cmocka_unit_test(test_details_are_not_in_the_table),
        cmocka_unit_test(test_end_of_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
