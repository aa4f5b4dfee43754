/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameter lists and units: quantities, ranges, choices, texts, and the messages of each error. */
#include "rig_list.h"
#include "common/rigs/rigs.h"
#include "common/input/params.h"
#include "common/input/casefile.h"
#include "common/engine/rig.h"
#include "common/engine/sim.h"
#include "common/input/units.h"
#include "tests/near.h"
#include "tests/param_lists.h"

#include <stdlib.h>

#define SAMPLE_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)           \
    REAL(e_bar, "Pa", "48.8 GPa", "(0, inf)", "contact modulus")            \
    REAL(length, "m", "5.1 mm", "[0, 1)", "a length")                       \
    REAL(rate, "1/s", "2e-7 1/s", "(0, inf)", "a rate")                     \
    REAL(friction, "1", "0.05", "[0, 10]", "a pure number")                 \
    REAL(angle, "rad", "30 deg", "[0, 1.6]", "an angle")                    \
    REAL(free, "N", "0 N", NULL, "any force")                               \
    REAL(needed, "Pa s", NULL, "[0, inf)", "a key without default")         \
    INT(count, "7", "[1, 1000]", "a number")                                \
    CHOICE(interaction, "all|gap|area", "gap", "which facets are contacts") \
    FLAG(ledger, "on", "a flag")                                            \
    TEXT(file, "", "a file")                                                \
    REAL3(size, "m", "10 cm, 20 cm, 30 cm", "(0, inf)", "three lengths")    \
    INT3(cells, "1, 2, 3", "[1, 100]", "three numbers")

struct sample {
    BRC_PARAM_MEMBERS(SAMPLE_PARAMS)
};
#define BRC_OWNER struct sample
static const struct brc_param sample_params[] = {BRC_PARAM_LIST(SAMPLE_PARAMS)};
#undef BRC_OWNER
static const struct brc_param_list sample_list = BRC_PARAMS(sample_params, struct sample);

static struct brc_context ctx = BRC_CONTEXT_INIT;

static double quantity(const char *text, const char *unit)
{
    double value = NAN;
    CHECK_OK(&ctx, brc_params_quantity(&ctx, text, unit, &value, "here"));
    return value;
}

/* Prefixes move the decimal point, so equal quantities are equal doubles. */
static void quantities_are_exact(void **state)
{
    (void)state;
    assert_true(quantity("48.8 GPa", "Pa") == 48.8e9);
    assert_true(quantity("48.8e3 MPa", "Pa") == 48.8e9);
    assert_true(quantity("48.8e9 Pa", "Pa") == 48.8e9);
    assert_true(quantity("5.1 mm", "m") == 0.0051);
    assert_true(quantity("  80mm ", "m") == 0.08);
    assert_true(quantity("5 cm2", "m2") == 5e-4);
    assert_true(quantity("5 cm^2", "m2") == 5e-4);
    assert_true(quantity("64.6 J/m2", "J/m2") == 64.6);
    assert_true(quantity("64.6 N/m", "J/m2") == 64.6);
    assert_true(quantity("2.638 g/cm3", "kg/m3") == 2638);
    assert_true(quantity("-1.5E-3 kN", "N") == -1.5);
    assert_true(quantity("2500 1/s", "1/s") == 2500);
    assert_true(quantity("2.5 kHz", "1/s") == 2500);
    assert_true(quantity("7 \xc2\xb5m", "m") == 7e-6);
    assert_true(quantity(".5", "1") == 0.5);
    assert_true(quantity("5 %", "1") == 0.05);
    CHECK_NEAR(quantity("45 deg", "rad"), BRC_PI / 4, 0, 1e-15);
    CHECK_NEAR(quantity("2 min", "s"), 120, 0, 1e-15);
    CHECK_NEAR(quantity("1 psi", "Pa"), 6894.757293168, 0, 1e-9);
}

struct bad_quantity {
    const char *text, *unit, *message;
};

static void bad_quantities_are_named(void **state)
{
    static const struct bad_quantity bad[] = {
        {"48.8", "Pa",
         "here: '48.8' has no unit; expected a unit of the dimension of Pa, for example '48.8 Pa'"},
        {"0", "m", "here: '0' has no unit; expected a unit of the dimension of m"},
        {"48.8 mm", "Pa",
         "here: the unit 'mm' has the wrong dimension (it is 0.001 m); expected a unit of the "
         "dimension of Pa"},
        {"3 m", "1", "the unit 'm' has the wrong dimension"},
        {"3 rad", "1", "the unit 'rad' has the wrong dimension"},
        {"3 %", "rad", "the unit '%' has the wrong dimension"},
        {"3 s", "1/s", "the unit 's' has the wrong dimension"},
        {"3 Gpa", "Pa", "'Gpa' is not a unit; expected a unit of the dimension of Pa"},
        {"3 m 3", "m", "'m 3' is not a unit"},
        {"3 4 m", "m", "'4 m' is not a unit"},
        {"3 m^0.5", "m", "'m^0.5' is not a unit"},
        {"3 m @ 5", "m", "'m @ 5' is not a unit"},
        {"3,5 MPa", "Pa", "decimal comma; write a decimal point, '3.5 MPa'"},
        {"20 degC", "K", "the unit 'degC' is not a plain multiple of K"},
        {"3 s since 2000-01-01", "s", "s since 2000-01-01' is not a"},
        {"GPa", "Pa", "here: 'GPa' does not start with a finite decimal number"},
        {"", "1", "'' does not start with a finite decimal number"},
        {"nan", "1", "'nan' does not start with a finite decimal number"},
        {"-inf Pa", "Pa", "'-inf Pa' does not start with a finite decimal number"},
        {"0x10 Pa", "Pa", "'0x10 Pa' does not start with a finite decimal number"},
        {"1e999 Pa", "Pa", "'1e999 Pa' is too large for a number"},
        {"1e99999 GPa", "Pa", "'1e99999 GPa' is too large for a number"},
        {"1e-999 Pa", "Pa", "'1e-999 Pa' is too small for a number"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double value = 1.25;
        CHECK_FAILS(&ctx, brc_params_quantity(&ctx, bad[i].text, bad[i].unit, &value, "here"),
                    BRC_ERR_INPUT, bad[i].message);
        assert_true(value == 1.25);
    }
}

static void units_have_factors(void **state)
{
    double factor = 0;
    (void)state;
    CHECK_OK(&ctx, brc_units_factor(&ctx, "km", "m", "here", &factor));
    CHECK_NEAR(factor, 1000, 0, 1e-15);
    CHECK_FAILS(&ctx, brc_units_factor(&ctx, "m", "nonsense", "here", &factor), BRC_ERR_INTERNAL,
                "'nonsense' is declared as a unit but is none");
}

static void defaults_are_filled(void **state)
{
    struct sample v;
    (void)state;
    memset(&v, 0xff, sizeof v);
    CHECK_OK(&ctx, brc_params_defaults(&ctx, sample_list, &v));
    assert_true(v.e_bar == 48.8e9 && v.length == 0.0051 && v.friction == 0.05);
    assert_true(v.needed == 0 && v.count == 7 && v.interaction == 1 && v.ledger == 1);
    assert_string_equal(v.file, "");
    assert_true(v.size[0] == 0.1 && v.size[1] == 0.2 && v.size[2] == 0.3);
    assert_true(v.cells[0] == 1 && v.cells[1] == 2 && v.cells[2] == 3);
}

static void values_are_set(void **state)
{
    struct sample v;
    (void)state;
    CHECK_OK(&ctx, brc_params_defaults(&ctx, sample_list, &v));
#define SET(key, text) CHECK_OK(&ctx, brc_params_set(&ctx, sample_list, &v, "s", key, text, "f:1"))
    SET("e_bar", "50 GPa");
    SET("length", "0 m");
    SET("count", "1000");
    SET("interaction", "area");
    SET("ledger", "No");
    SET("file", "a b.txt");
    SET("size", "1 m , 2 m,3 m");
    SET("cells", "4,5,6");
    assert_true(v.e_bar == 50e9 && v.length == 0 && v.count == 1000 && v.interaction == 2);
    assert_true(v.ledger == 0 && v.size[1] == 2 && v.cells[2] == 6);
    assert_string_equal(v.file, "a b.txt");
    static const char *const on[] = {"on", "true", "yes", "ON", "True"};
    for (int i = 0; i < 5; i++) {
        v.ledger = 0;
        SET("ledger", on[i]);
        assert_int_equal(v.ledger, 1);
    }
#undef SET
}

struct bad_value {
    const char *key, *text, *message;
};

static void bad_values_are_named(void **state)
{
    static const struct bad_value bad[] = {
        {"e_bar", "0 GPa", "f.yaml:12: vgcm.e_bar: 0 GPa is out of range; allowed (0, inf) Pa"},
        {"length", "1 m", "f.yaml:12: vgcm.length: 1 m is out of range; allowed [0, 1) m"},
        {"length", "-1 um", "vgcm.length: -1 um is out of range; allowed [0, 1) m"},
        {"friction", "10.1", "vgcm.friction: 10.1 is out of range; allowed [0, 10]"},
        {"e_bar", "3 m", "f.yaml:12: vgcm.e_bar: the unit 'm' has the wrong dimension"},
        {"e_bar", "3", "f.yaml:12: vgcm.e_bar: '3' has no unit"},
        {"count", "0", "f.yaml:12: vgcm.count: 0 is out of range; allowed [1, 1000]"},
        {"count", "1001", "vgcm.count: 1001 is out of range; allowed [1, 1000]"},
        {"count", "99999999999", "vgcm.count: 99999999999 is out of range; allowed [1, 1000]"},
        {"count", "7.0", "f.yaml:12: vgcm.count: '7.0' is not a whole number"},
        {"count", "1e2", "vgcm.count: '1e2' is not a whole number"},
        {"count", "7 m", "vgcm.count: '7 m' is not a whole number"},
        {"count", "", "vgcm.count: '' is not a whole number"},
        {"interaction", "gip",
         "f.yaml:12: vgcm.interaction: 'gip' is not a choice; allowed all|gap|area; did you mean "
         "'gap'?"},
        {"interaction", "1", "vgcm.interaction: '1' is not a choice; allowed all|gap|area"},
        {"ledger", "1",
         "f.yaml:12: vgcm.ledger: '1' is not a flag; allowed on, off, true, false, yes, no"},
        {"size", "1 m", "f.yaml:12: vgcm.size: '1 m' must be three values between commas, as in "},
        {"size", "1 m, 2 m, 3 m, 4 m", "must be three values between commas"},
        {"size", "1 m, 2 m, 3", "vgcm.size: '3' has no unit"},
        {"size", "1 m, 0 m, 3 m", "vgcm.size: 0 m is out of range; allowed (0, inf) m"},
        {"cells", "1, 2, 3.5", "vgcm.cells: '3.5' is not a whole number"},
        {"cells", "1, 200, 3", "vgcm.cells: 200 is out of range; allowed [1, 100]"},
        {"e_bra", "50 GPa", "; did you mean 'e_bar'?"},
        {"e_bra", "50 GPa", "f.yaml:12: vgcm.e_bra: unknown key; allowed e_bar, length, rate"},
        {"quite_another_thing", "1", "f.yaml:12: vgcm.quite_another_thing: unknown key; allowed"},
    };
    struct sample v, before;
    char many[BRC_TEXT_SIZE + 1];
    (void)state;
    CHECK_OK(&ctx, brc_params_defaults(&ctx, sample_list, &v));
    before = v;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK_FAILS(
            &ctx,
            brc_params_set(&ctx, sample_list, &v, "vgcm", bad[i].key, bad[i].text, "f.yaml:12"),
            BRC_ERR_INPUT, bad[i].message);
    memset(many, 'x', sizeof many - 1);
    many[sizeof many - 1] = '\0';
    CHECK_FAILS(&ctx, brc_params_set(&ctx, sample_list, &v, "vgcm", "file", many, "f.yaml:12"),
                BRC_ERR_INPUT, "f.yaml:12: vgcm.file: the text has 256 bytes; allowed at most 255");
    CHECK_FAILS(&ctx, brc_params_set(&ctx, sample_list, &v, "vgcm", "count", "0", "allowed.yaml:1"),
                BRC_ERR_INPUT, "vgcm.count: 0 is out of range; allowed [1, 1000]");
    assert_memory_equal(&v, &before, sizeof v);
}

/* A choice after the wrong one is not offered when it is nothing like it. */
static void hints_are_near(void **state)
{
    struct sample v = {0};
    (void)state;
    assert_int_not_equal(
        brc_params_set(&ctx, sample_list, &v, "s", "interaction", "polyhedra", "f:1"), 0);
    assert_null(strstr(ctx.message, "did you mean"));
    brc_error_clear(&ctx);
    assert_int_equal(brc_names_distance("kitten", "sitting"), 3);
    assert_int_equal(brc_names_distance("", "abc"), 3);
    assert_int_equal(brc_names_distance("E_Bar", "e_bar"), 0);
    char hint[BRC_HINT_SIZE];
    assert_string_equal(brc_params_hint(sample_list, "lenght", hint), "; did you mean 'length'?");
    assert_string_equal(brc_params_hint(sample_list, "zzzzz", hint), "");
    assert_ptr_equal(brc_params_find(sample_list, "rate"), &sample_params[2]);
    assert_null(brc_params_find(sample_list, "rat"));
}

static void check_text(const char *key, const char *text, const char *expected)
{
    struct sample v, again;
    char buffer[BRC_TEXT_SIZE];
    const struct brc_param *p = brc_params_find(sample_list, key);
    CHECK_OK(&ctx, brc_params_defaults(&ctx, sample_list, &v));
    again = v;
    CHECK_OK(&ctx, brc_params_set(&ctx, sample_list, &v, "s", key, text, "f:1"));
    brc_params_text(p, &v, buffer, sizeof buffer);
    assert_string_equal(buffer, expected);
    CHECK_OK(&ctx, brc_params_set(&ctx, sample_list, &again, "s", key, buffer, "f:1"));
    assert_memory_equal(&v, &again, sizeof v);
}

static void texts_use_the_default_unit(void **state)
{
    (void)state;
    check_text("e_bar", "50e9 Pa", "50 GPa");
    check_text("e_bar", "1 Pa", "1e-09 GPa");
    check_text("length", "0.1 m", "100 mm");
    check_text("rate", "3 1/s", "3 1/s");
    check_text("friction", "0.25", "0.25");
    check_text("angle", "1 rad", "57.29577951308232 deg");
    check_text("needed", "3 kPa s", "3000 Pa s");
    check_text("count", "12", "12");
    check_text("interaction", "all", "all");
    check_text("ledger", "no", "off");
    check_text("file", "x", "x");
    check_text("size", "1 m, 1 mm, 1 um", "100 cm, 0.1 cm, 0.0001 cm");
    check_text("cells", "9,8,7", "9, 8, 7");
}

/* Any double survives being written and read. */
static void texts_round_trip(void **state)
{
    char buffer[BRC_TEXT_SIZE];
    uint64_t seed = 12345;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        struct sample v = {0}, again = {0};
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        v.e_bar = ldexp((double)(seed >> 11) * 0x1p-53 + 0.5, (int)(seed % 80) - 20);
        v.angle = (double)(seed >> 11) * 0x1p-53;
        for (int k = 0; k < 2; k++) {
            const struct brc_param *p = brc_params_find(sample_list, k ? "angle" : "e_bar");
            brc_params_text(p, &v, buffer, sizeof buffer);
            CHECK_OK(&ctx, brc_params_set(&ctx, sample_list, &again, "s", p->key, buffer, "f:1"));
        }
        assert_true(v.e_bar == again.e_bar && v.angle == again.angle);
    }
}

/* ---- declarations -------------------------------------------------------------------------- */

#define OWNED_LIST(name, LIST, owner)                                       \
    static const struct brc_param name##_params[] = {BRC_PARAM_LIST(LIST)}; \
    static const struct brc_param_list name##_list = BRC_PARAMS(name##_params, owner)

#define BRC_OWNER struct brc_specimen_params
OWNED_LIST(specimen, BRC_SPECIMEN_PARAMS, struct brc_specimen_params);
#undef BRC_OWNER
#define BRC_OWNER struct brc_test_params
OWNED_LIST(test, BRC_TEST_PARAMS, struct brc_test_params);
#undef BRC_OWNER
#define BRC_OWNER struct brc_run_params
OWNED_LIST(run, BRC_RUN_PARAMS, struct brc_run_params);
#undef BRC_OWNER

static void declarations_are_sound(void **state)
{
    (void)state;
    CHECK_OK(&ctx, param_list_check(&ctx, "sample", sample_list));
    CHECK_OK(&ctx, param_list_check(&ctx, "case", brc_casefile_param_list));
    CHECK_OK(&ctx, param_list_check(&ctx, "specimen", specimen_list));
    CHECK_OK(&ctx, param_list_check(&ctx, "test", test_list));
    CHECK_OK(&ctx, param_list_check(&ctx, "run", run_list));
    for (int i = 0; i < brc_registry_count(); i++) {
        const struct brc_model *model = brc_registry_at(i);
        CHECK_OK(&ctx, param_list_check(&ctx, model->name, model->params));
    }
}

static void bad_declarations_are_found(void **state)
{
    struct {
        struct brc_param p;
        int code;
        const char *message;
    } bad[] = {
        {{"Key", BRC_REAL, 0, "m", "1 m", NULL, NULL, 0, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "snake case"},
        {{"a", BRC_REAL, 0, "m", "1 m", NULL, NULL, 0, .meaning = ""},
         BRC_ERR_INTERNAL,
         "meaning is missing"},
        {{"a", BRC_REAL, 0, "m", "1 m", NULL, NULL, 4, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "outside its struct"},
        {{"a", BRC_REAL, 0, "m", "1 m", "0, inf", NULL, 0, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "not an interval"},
        {{"a", BRC_REAL, 0, "m", "1 m", "[2, 1]", NULL, 0, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "not an interval"},
        {{"a", BRC_REAL, 0, "m", "1 m", "[2, 3] ", NULL, 0, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "not an interval"},
        {{"a", BRC_REAL, 0, "mm3x", "1 m", NULL, NULL, 0, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "is none"},
        {{"a", BRC_REAL, 0, "m", "1", NULL, NULL, 0, .meaning = "x"},
         BRC_ERR_INPUT,
         "declaration: l.a: '1' has"},
        {{"a", BRC_REAL, 0, "m", "1 m", "(1, 2)", NULL, 0, .meaning = "x"},
         BRC_ERR_INPUT,
         "out of range"},
        {{"a", BRC_CHOICE, 0, "1", "b", NULL, NULL, 0, .meaning = "x"},
         BRC_ERR_INTERNAL,
         "choices are missing"},
        {{"a", BRC_CHOICE, 0, "1", "b", NULL, "a|c", 0, .meaning = "x"},
         BRC_ERR_INPUT,
         "not a choice"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct brc_param_list list = {&bad[i].p, 1, sizeof(double)};
        CHECK_FAILS(&ctx, param_list_check(&ctx, "l", list), bad[i].code, bad[i].message);
    }
    struct brc_param twice[2] = {sample_params[0], sample_params[0]};
    struct brc_param_list list = {twice, 2, sizeof(struct sample)};
    CHECK_FAILS(&ctx, param_list_check(&ctx, "l", list), BRC_ERR_INTERNAL, "declared twice");
}

static void reference_is_aligned(void **state)
{
    char text[8192] = "";
    FILE *out = tmpfile();
    (void)state;
    assert_non_null(out);
    brc_params_print(out, "sample", sample_list);
    rewind(out);
    size_t n = fread(text, 1, sizeof text - 1, out);
    fclose(out);
    assert_true(n > 0 && strncmp(text, "sample\n", 7) == 0);
    int lines = 0;
    size_t column = 0;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"), lines++) {
        const char *meaning =
            lines < 2 ? strstr(line, "meaning") : strstr(line, sample_params[lines - 2].meaning);
        if (lines == 1)
            column = (size_t)(meaning - line);
        if (lines >= 1)
            assert_int_equal(meaning - line, column);
        if (lines == 8)
            assert_non_null(strstr(line, "needed       required"));
    }
    assert_int_equal(lines, 2 + sample_list.n);
}

/* A default that its owner finds later. */
static void a_value_may_be_auto(void **state)
{
    struct one {
        double kn, e;
    } v;
    static const struct brc_param params[] = {{"kn", BRC_REAL, 0, "N/m", "auto", "(0, inf)", NULL,
                                               offsetof(struct one, kn), .meaning = "stiffness"},
                                              {"e", BRC_REAL, 0, "Pa", "1 GPa", "(0, inf)", NULL,
                                               offsetof(struct one, e), .meaning = "modulus"}};
    const struct brc_param_list list = BRC_PARAMS(params, struct one);
    char text[64];
    (void)state;
    CHECK_OK(&ctx, param_list_check(&ctx, "s", list));
    CHECK_OK(&ctx, brc_params_defaults(&ctx, list, &v));
    assert_true(isnan(v.kn));
    assert_string_equal(brc_params_text(&params[0], &v, text, sizeof text), "auto");
    CHECK_OK(&ctx, brc_params_set(&ctx, list, &v, "s", "kn", "2 kN/m", "f:1"));
    assert_true(v.kn == 2e3);
    assert_string_equal(brc_params_text(&params[0], &v, text, sizeof text), "2000 N/m");
    CHECK_OK(&ctx, brc_params_set(&ctx, list, &v, "s", "kn", "auto", "f:1"));
    assert_true(isnan(v.kn));
    CHECK_FAILS(&ctx, brc_params_set(&ctx, list, &v, "s", "kn", "0 N/m", "f:1"), BRC_ERR_INPUT,
                "allowed (0, inf) N/m");
    CHECK_FAILS(&ctx, brc_params_set(&ctx, list, &v, "s", "kn", "Auto", "f:1"), BRC_ERR_INPUT,
                "or auto");
    CHECK_FAILS(&ctx, brc_params_set(&ctx, list, &v, "s", "e", "auto", "f:1"), BRC_ERR_INPUT,
                "f:1: s.e: 'auto' does not start with a finite decimal number");
    CHECK_FAILS(&ctx, brc_params_set(&ctx, list, &v, "s", "e", "nan Pa", "f:1"), BRC_ERR_INPUT,
                "does not start with a finite decimal number");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantities_are_exact),
        cmocka_unit_test(bad_quantities_are_named),
        cmocka_unit_test(units_have_factors),
        cmocka_unit_test(defaults_are_filled),
        cmocka_unit_test(values_are_set),
        cmocka_unit_test(bad_values_are_named),
        cmocka_unit_test(a_value_may_be_auto),
        cmocka_unit_test(hints_are_near),
        cmocka_unit_test(texts_use_the_default_unit),
        cmocka_unit_test(texts_round_trip),
        cmocka_unit_test(declarations_are_sound),
        cmocka_unit_test(bad_declarations_are_found),
        cmocka_unit_test(reference_is_aligned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
