/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Case files: what is read, and the place and text of every error. */
#include "common/input/casefile.h"
#include "tests/near.h"

#include <stdlib.h>
#include <unistd.h>

#define MODEL_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)              \
    REAL(e_bar, "Pa", "48.8 GPa", "(0, inf)", "contact modulus")              \
    CHOICE(interaction, "all|gap|area", "all", "which facets are contacts")   \
    REAL(interaction_gap, "m", "0 m", "[0, inf)", "gap")                      \
    INT(softening, "1", "[1, 9]", "its parent is a key too")                  \
    CHOICE(softening_rule, "none|linear", "none", "a key that ends in _rule") \
    REAL3(size, "m", "1 m, 1 m, 1 m", "(0, inf)", "lengths")                  \
    TEXT(note, "", "a text", .renamed = "remark")
struct model {
    BRC_PARAM_MEMBERS(MODEL_PARAMS)
};
#define BRC_OWNER struct model
static const struct brc_param model_params[] = {BRC_PARAM_LIST(MODEL_PARAMS)};
#undef BRC_OWNER
static const struct brc_param_list model_list = BRC_PARAMS(model_params, struct model);

#define STRICT_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3) \
    REAL(load, "N", NULL, "(0, inf)", "what to apply")
struct strict {
    BRC_PARAM_MEMBERS(STRICT_PARAMS)
};
#define BRC_OWNER struct strict
static const struct brc_param strict_params[] = {BRC_PARAM_LIST(STRICT_PARAMS)};
#undef BRC_OWNER
static const struct brc_param_list strict_list = BRC_PARAMS(strict_params, struct strict);

static const char *const known[] = {"specimen", "test", "vgcm", "strict"};
static struct brc_context ctx = BRC_CONTEXT_INIT;

/* Everything that a command does with a case. */
static int read_all(const char *text, size_t size, struct model *m, struct brc_casefile *c)
{
    BRC_TRY(brc_casefile_parse(&ctx, "c.yaml", text, size, c));
    BRC_TRY(brc_casefile_section(&ctx, c, "vgcm", model_list, m));
    return brc_casefile_finish(&ctx, c, known, 4);
}

static struct model check_good(const char *text)
{
    struct model m;
    struct brc_casefile c;
    CHECK_OK(&ctx, read_all(text, strlen(text), &m, &c));
    brc_casefile_free(&c);
    return m;
}

static void check_bad_bytes(const char *text, size_t size, const char *message)
{
    struct model m;
    struct brc_casefile c;
    CHECK_FAILS(&ctx, read_all(text, size, &m, &c), BRC_ERR_INPUT, message);
    brc_casefile_free(&c);
}

static void check_bad(const char *text, const char *message)
{
    check_bad_bytes(text, strlen(text), message);
}

static void case_is_read(void **state)
{
    static const char text[] = "# a comment\n"
                               "breccia: 1\n"
                               "title: \"Ångström: 700 grains\"\n"
                               "model: vgcm\n"
                               "models: [polyhedra, vgcm]\n"
                               "specimen:\n"
                               "vgcm: {e_bar: 50 GPa, interaction: {rule: gap, gap: 1 mm},\n"
                               "       size: [1 m, 2 m, 3 m], note: ''}\n";
    struct model m;
    struct brc_casefile c;
    (void)state;
    CHECK_OK(&ctx, read_all(text, sizeof text - 1, &m, &c));
    assert_int_equal(c.head.breccia, 1);
    assert_string_equal(c.head.title, "Ångström: 700 grains");
    assert_string_equal(c.head.model, "vgcm");
    assert_int_equal(c.n_models, 2);
    assert_string_equal(c.models[0], "polyhedra");
    assert_string_equal(c.models[1], "vgcm");
    assert_true(m.e_bar == 50e9 && m.interaction == 1 && m.interaction_gap == 1e-3);
    assert_true(m.size[0] == 1 && m.size[1] == 2 && m.size[2] == 3);
    assert_string_equal(m.note, "");
    assert_string_equal(c.text, text);
    assert_int_equal(brc_casefile_find_section(&c, "specimen")->line, 6);
    assert_int_equal(brc_casefile_find_section(&c, "vgcm")->line, 7);
    assert_null(brc_casefile_find_section(&c, "test"));
    brc_casefile_free(&c);
}

static void spellings_agree(void **state)
{
    (void)state;
    struct model m = check_good("breccia: 1\nvgcm: {interaction: gap, interaction_gap: 2 mm}\n");
    assert_true(m.interaction == 1 && m.interaction_gap == 2e-3);
    m = check_good("breccia: 1\nvgcm:\n  softening: {rule: linear}\n  size: 1 m, 2 m, 4 m\n");
    assert_true(m.softening_rule == 1 && m.softening == 1 && m.size[2] == 4);
    m = check_good("breccia: 1\n");
    assert_true(m.e_bar == 48.8e9);
    m = check_good("breccia: 1\r\nvgcm:\r\n  e_bar: 3 Pa\r\n");
    assert_true(m.e_bar == 3);
}

static void overrides_hold(void **state)
{
    static const char text[] = "breccia: 1\nmodel: vgcm\nvgcm: {e_bar: 50 GPa}";
    struct model m;
    struct brc_casefile c;
    (void)state;
    CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", text, sizeof text - 1, &c));
    CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "vgcm.e_bar=1 GPa"));
    CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "vgcm.e_bar= 60 GPa"));
    CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "vgcm.interaction.rule=area"));
    CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "vgcm.note=a=b.c"));
    CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "model=polyhedra"));
    CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "models=a, b"));
    CHECK_OK(&ctx, brc_casefile_section(&ctx, &c, "vgcm", model_list, &m));
    assert_true(m.e_bar == 60e9 && m.interaction == 2);
    assert_string_equal(m.note, "a=b.c");
    assert_string_equal(c.head.model, "polyhedra");
    assert_int_equal(c.n_models, 2);
    assert_string_equal(c.text, text);
    brc_casefile_free(&c);
}

/* A text in which e_bar of vgcm is written over: what it becomes, and that it reads back. */
static void check_write(const char *text, const char *key, const char *value, const char *expected)
{
    struct brc_casefile c;
    bool is_top = brc_params_find(brc_casefile_param_list, key) != NULL;
    const char *section = is_top ? "" : "vgcm";
    const struct brc_param_list list = is_top ? brc_casefile_param_list : model_list;
    CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", text, strlen(text), &c));
    CHECK_OK(&ctx, brc_casefile_write(&ctx, &c, section, key, list, value));
    assert_string_equal(c.text, expected);
    const struct brc_casefile_entry *e = brc_casefile_find_entry(&c, section, key, list);
    assert_non_null(e);
    assert_string_equal(e->text, value);
    brc_casefile_free(&c);
}

static void values_are_written_in_their_place(void **state)
{
    (void)state;
    /* everything else stays, comments of any kind included */
    check_write(
        "# --set a=b\nbreccia: 1\nvgcm:\n  # stiff\n  e_bar:   50 GPa  # was 40\n  note: x\n",
        "e_bar", "60 GPa",
        "# --set a=b\nbreccia: 1\nvgcm:\n  # stiff\n  e_bar:   60 GPa  # was 40\n  note: x\n");
    check_write("breccia: 1\nvgcm: {e_bar: \"50 GPa\"#c\n}\n", "e_bar", "6 Pa",
                "breccia: 1\nvgcm: {e_bar: 6 Pa #c\n}\n");
    check_write("breccia: 1\nvgcm: {\"e_bar\":'50 GPa', note: x}", "e_bar", "6 Pa",
                "breccia: 1\nvgcm: {\"e_bar\":6 Pa, note: x}");
    check_write("{breccia: 1, vgcm: {note: \xc3\xa4\xe2\x82\xac, e_bar: 1 Pa}}", "e_bar", "6 Pa",
                "{breccia: 1, vgcm: {note: \xc3\xa4\xe2\x82\xac, e_bar: 6 Pa}}");
    /* values of several lines, and sequences */
    check_write("breccia: 1\nvgcm:\n  note: \"a\n    b\"\n  e_bar: 1 Pa\n", "note", "c",
                "breccia: 1\nvgcm:\n  note: c\n  e_bar: 1 Pa\n");
    check_write("breccia: 1\nvgcm:\n  note: >-\n    a\n    b\n\n  e_bar: 1 Pa\n", "note", "c",
                "breccia: 1\nvgcm:\n  note: c\n\n  e_bar: 1 Pa\n");
    check_write("breccia: 1\nvgcm:\n  size: [1 m, # x\n    2 m, 3 m] # y\n", "size",
                "1 m, 1 m, 1 m", "breccia: 1\nvgcm:\n  size: \"1 m, 1 m, 1 m\" # y\n");
    check_write("breccia: 1\nvgcm:\n  size:\n  - 1 m\n  - 2 m\n  - 3 m\n  # y\n  note: x\n", "size",
                "1 m, 1 m, 1 m",
                "breccia: 1\nvgcm:\n  size:\n    \"1 m, 1 m, 1 m\"\n  # y\n  note: x\n");
    check_write("breccia: 1\nvgcm:\n  size:\n      - 1 m\n      - 2 m\n      - 3 m", "size", "1 m",
                "breccia: 1\nvgcm:\n  size:\n      1 m");
    /* a: {rule: x} stands for a */
    check_write("breccia: 1\nvgcm: {interaction: {rule: gap, gap: 1 mm}}\n", "interaction", "area",
                "breccia: 1\nvgcm: {interaction: {rule: area, gap: 1 mm}}\n");
    check_write("breccia: 1\ntitle: x # y\n", "title", "a: #1 \"b\" \\ c",
                "breccia: 1\ntitle: \"a: #1 \\\"b\\\" \\\\ c\" # y\n");
}

static void keys_are_added_to_their_section(void **state)
{
    (void)state;
    check_write("breccia: 1\nvgcm:\n    note: x # y\n\nstrict:\n  load: 1 N\n", "e_bar", "6 Pa",
                "breccia: 1\nvgcm:\n    note: x # y\n    e_bar: 6 Pa\n\nstrict:\n  load: 1 N\n");
    check_write("breccia: 1\r\nvgcm:\r\n  note: x\r\n", "e_bar", "6 Pa",
                "breccia: 1\r\nvgcm:\r\n  note: x\r\n  e_bar: 6 Pa\r\n");
    check_write("breccia: 1\nvgcm: {note: x,}\n", "e_bar", "6 Pa",
                "breccia: 1\nvgcm: {note: x, e_bar: 6 Pa,}\n");
    check_write("breccia: 1\nvgcm: {}\n", "e_bar", "6 Pa", "breccia: 1\nvgcm: {e_bar: 6 Pa}\n");
    check_write("breccia: 1\nvgcm: {# y\n}\n", "e_bar", "6 Pa",
                "breccia: 1\nvgcm: {e_bar: 6 Pa # y\n}\n");
    check_write("breccia: 1\nvgcm: # y\nstrict: {}\n", "e_bar", "6 Pa",
                "breccia: 1\nvgcm: {e_bar: 6 Pa} # y\nstrict: {}\n");
    check_write("breccia: 1\nvgcm: ~", "e_bar", "6 Pa", "breccia: 1\nvgcm:  {e_bar: 6 Pa}");
    check_write("{breccia: 1, vgcm: }", "e_bar", "6 Pa", "{breccia: 1, vgcm:  {e_bar: 6 Pa}}");
    check_write("breccia: 1 # y", "e_bar", "6 Pa", "breccia: 1 # y\nvgcm: {e_bar: 6 Pa}");
    check_write("{breccia: 1}", "e_bar", "6 Pa", "{breccia: 1, vgcm: {e_bar: 6 Pa}}");
    check_write("--- \n  breccia: 1\n  strict:\n    load: 1 N\n...\n", "e_bar", "6 Pa",
                "--- \n  breccia: 1\n  strict:\n    load: 1 N\n  vgcm: {e_bar: 6 Pa}\n...\n");
    check_write("breccia: 1\nvgcm: {interaction: {gap: 1 mm}}\n", "interaction", "area",
                "breccia: 1\nvgcm: {interaction: {gap: 1 mm, rule: area}}\n");
    check_write("breccia: 1\n", "model", "vgcm", "breccia: 1\nmodel: vgcm\n");
}

/* Values that YAML would read as something else. */
static void every_value_reads_back(void **state)
{
    static const char *const value[] = {"",
                                        "null",
                                        "~",
                                        " a ",
                                        "-",
                                        "- a",
                                        "--- a",
                                        "?",
                                        "a: b",
                                        "a #b",
                                        "{a}",
                                        "[a",
                                        "'a'",
                                        "\"",
                                        "\\u0041",
                                        "&a",
                                        "*a",
                                        "!a",
                                        "%a",
                                        "@a",
                                        "`a`",
                                        "a,b",
                                        "\xe2\x80\xa8",
                                        "a\xe2\x80\xa9 b",
                                        "\xef\xbf\xbf",
                                        "\xef\xbf\xbe",
                                        "\xc3\xa4",
                                        "1e-3",
                                        "-.5 GPa",
                                        "../a-b_c.tess"};
    (void)state;
    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++) {
        struct brc_casefile c;
        const char *texts[] = {"breccia: 1\nvgcm: {note: x, e_bar: 1 Pa}\n", "breccia: 1\n"};
        for (int k = 0; k < 2; k++) {
            CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", texts[k], strlen(texts[k]), &c));
            CHECK_OK(&ctx, brc_casefile_write(&ctx, &c, "vgcm", "note", model_list, value[i]));
            assert_string_equal(brc_casefile_find_entry(&c, "vgcm", "note", model_list)->text,
                                value[i]);
            brc_casefile_free(&c);
        }
    }
}

static void check_bad_override(const char *assignment, int code, const char *message)
{
    static const char text[] = "breccia: 1\nvgcm: {e_bar: 50 GPa}\n";
    struct model m;
    struct brc_casefile c;
    CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", text, sizeof text - 1, &c));
    int result = brc_casefile_override(&ctx, &c, assignment);
    if (result == 0)
        result = brc_casefile_section(&ctx, &c, "vgcm", model_list, &m);
    if (result == 0)
        result = brc_casefile_finish(&ctx, &c, known, 4);
    CHECK_FAILS(&ctx, result, code, message);
    brc_casefile_free(&c);
}

static void bad_overrides_are_named(void **state)
{
    (void)state;
    check_bad_override("vgcm.e_bra=50 GPa", BRC_ERR_INPUT,
                       "--set: vgcm.e_bra: unknown key; allowed e_bar, interaction");
    check_bad_override("vgcm.e_bra=50 GPa", BRC_ERR_INPUT, "; did you mean 'e_bar'?");
    check_bad_override("vgcm.e_bar=50", BRC_ERR_INPUT, "--set: vgcm.e_bar: '50' has no unit");
    check_bad_override("vgmc.e_bar=50 GPa", BRC_ERR_INPUT,
                       "--set: vgmc: unknown section; allowed specimen, test, vgcm, strict; did "
                       "you mean 'vgcm'?");
    check_bad_override("vgcm.e_bar", BRC_ERR_USAGE, "not of the form section.key=value");
    check_bad_override("a.b.c.d=1", BRC_ERR_USAGE, "not of the form section.key=value");
    check_bad_override("vgcm..e_bar=1", BRC_ERR_INPUT, "--set: '.e_bar=1' is not a key");
    check_bad_override("=1", BRC_ERR_INPUT, "--set: '=1' is not a key");
    check_bad_override("vgcm.note=a\nb", BRC_ERR_USAGE, "not one line of UTF-8 text");
    check_bad_override("vgcm.note=\xff", BRC_ERR_USAGE, "not one line of UTF-8 text");
    check_bad_override("breccia=2", BRC_ERR_INPUT, "breccia: ");
    check_bad_override("titel=x", BRC_ERR_INPUT, "--set: titel: unknown key of the top level");
}

static void top_level_errors(void **state)
{
    (void)state;
    check_bad("", "c.yaml: breccia: required key is missing");
    check_bad("title: x\n", "c.yaml: breccia: required key is missing; a case file starts with the "
                            "version of its format, `breccia: 1`");
    check_bad("breccia: 2\n", "c.yaml:1: breccia: '2' is another version of the case format; "
                              "allowed 1; use the breccia that the case was written for");
    check_bad("breccia: 1\nmodle: vgcm\n", "c.yaml:2: modle: unknown key of the top level");
    check_bad("breccia: 1\nmodle: vgcm\n", "; did you mean 'model'?");
    check_bad("breccia: 1\nvgcm: 3\n", "c.yaml:2: vgcm: unknown key of the top level; allowed "
                                       "breccia, title, model, models and sections, which are "
                                       "mappings `vgcm: {key: value}`");
    check_bad("breccia: 1\ntitle: {a: b}\n", "c.yaml:2: title: takes a text, not a mapping");
    check_bad("breccia: 1\ntitle:\n", "c.yaml:2: title: has no value");
    check_bad("breccia: 1\ntitle: a\n\ntitle: b\n",
              "c.yaml:4: title: given twice, first in line 2");
    check_bad("- 1\n", "c.yaml:1: a case file is a mapping, `key: value`; this is a sequence");
    check_bad("just words\n", "c.yaml:1: a case file is a mapping, `key: value`; this is a lone");
    check_bad("breccia: 1\n---\nbreccia: 1\n", "c.yaml:2: a case file holds one document");
}

static void section_errors(void **state)
{
    (void)state;
    check_bad("breccia: 1\n\nvgmc: {e_bar: 3 Pa}\n",
              "c.yaml:3: vgmc: unknown section; allowed specimen, test, vgcm, strict; did you mean "
              "'vgcm'?");
    check_bad("breccia: 1\nqqq:\n", "c.yaml:2: qqq: unknown section; allowed specimen, test");
    check_bad("breccia: 1\nvgcm: {e_bar: 3 Pa}\nvgcm: {note: x}\n",
              "c.yaml:3: vgcm: given twice, first in line 2; keep one of the two");
    check_bad("breccia: 1\nvgcm:\n  e_bar: 3 Pa\n  note: a\n  e_bar: 4 Pa\n",
              "c.yaml:5: vgcm.e_bar: given twice, first in line 3; keep one of the two");
    check_bad("breccia: 1\nvgcm:\n  interaction: {gap: 1 m}\n  interaction_gap: 1 m\n",
              "c.yaml:4: vgcm.interaction_gap: given twice, first in line 3");
    check_bad("breccia: 1\nvgcm:\n  interaction: {rule: gap}\n  interaction: all\n",
              "c.yaml:4: vgcm.interaction: given twice, first in line 3");
    check_bad("breccia: 1\nvgcm:\n  interaction: {rule: gap}\n  interaction: {gap: 1 m}\n",
              "c.yaml:4: vgcm.interaction: given twice, first in line 3");
    check_bad("breccia: 1\nvgcm:\n  e_bar:\n", "c.yaml:3: e_bar: has no value");
    check_bad("breccia: 1\nvgcm:\n  e_bar: ~\n", "c.yaml:3: e_bar: has no value");
    check_bad("breccia: 1\nvgcm:\n  note: a\n  e_bra: 3 Pa\n", "c.yaml:4: vgcm.e_bra: unknown key; "
                                                               "allowed e_bar, interaction");
    check_bad("breccia: 1\nvgcm:\n  interaction: {gapp: 3 m}\n",
              "; did you mean 'interaction_gap'?");
    check_bad("breccia: 1\nvgcm:\n  note: a\n  e_bar: -3 Pa\n",
              "c.yaml:4: vgcm.e_bar: -3 Pa is out of range; allowed (0, inf) Pa");
    check_bad("breccia: 1\nvgcm:\n  e_bar: 3 m\n",
              "c.yaml:3: vgcm.e_bar: the unit 'm' has the wrong dimension (it is m); expected a "
              "unit of the dimension of Pa");
    check_bad("breccia: 1\nvgcm: {size: [1 m, 2 m]}\n",
              "c.yaml:2: vgcm.size: '1 m, 2 m' must be three values");
    check_bad("breccia: 1\nvgcm: {size: []}\n", "c.yaml:2: vgcm.size: '' must be three values");
}

static void required_keys_are_named(void **state)
{
    static const char *const text[] = {"breccia: 1\ntitle: x\nstrict: {}\n", "breccia: 1\n"};
    static const char *const message[] = {
        "c.yaml:3: strict.load: required key is missing (what to apply); allowed (0, inf), unit N",
        "c.yaml: strict.load: required key is missing"};
    struct strict s;
    struct brc_casefile c;
    (void)state;
    for (int i = 0; i < 2; i++) {
        CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", text[i], strlen(text[i]), &c));
        CHECK_FAILS(&ctx, brc_casefile_section(&ctx, &c, "strict", strict_list, &s), BRC_ERR_INPUT,
                    message[i]);
        CHECK_OK(&ctx, brc_casefile_override(&ctx, &c, "strict.load=3 kN"));
        CHECK_OK(&ctx, brc_casefile_section(&ctx, &c, "strict", strict_list, &s));
        assert_true(s.load == 3000);
        brc_casefile_free(&c);
    }
}

static void yaml_is_kept_plain(void **state)
{
    (void)state;
    check_bad("breccia: 1\nvgcm: {e_bar: 3 Pa\n", "c.yaml:3: not valid YAML: ");
    check_bad("breccia: 1\nvgcm:\n\te_bar: 3 Pa\n", "c.yaml:3: not valid YAML: ");
    check_bad("breccia: 1\nvgcm: &a {e_bar: 3 Pa}\n",
              "c.yaml:2: anchors and aliases (&name, *name) are not accepted; write the value out");
    check_bad("breccia: 1\nvgcm:\n  e_bar: &a 3 Pa\n", "c.yaml:3: anchors and aliases");
    check_bad("breccia: 1\nvgcm:\n  size: &a [1 m]\n", "c.yaml:3: anchors and aliases");
    check_bad("breccia: 1\nvgcm:\n  e_bar: *a\n", "c.yaml:3: anchors and aliases");
    check_bad("breccia: 1\nvgcm:\n  e_bar: !!float 3\n", "c.yaml:3: tags (!name) are not accepted");
    check_bad("breccia: 1\nvgcm: !x {}\n", "c.yaml:2: tags (!name) are not accepted");
    check_bad("breccia: 1\na: {b: {c:\n {d: 1}}}\n",
              "c.yaml:3: mappings are nested deeper than 3 levels");
    check_bad("breccia: 1\nvgcm:\n  size: [1 m, {a: b}]\n", "c.yaml:3: a sequence holds plain");
    check_bad("breccia: 1\nvgcm:\n  size: [1 m, [2 m]]\n", "c.yaml:3: a sequence holds plain");
    check_bad("breccia: 1\nvgcm:\n  [1, 2]: 3\n", "c.yaml:3: a key must be a plain word");
    check_bad("breccia: 1\nvgcm:\n  ? {a: b}\n  : 3\n", "c.yaml:3: a key must be a plain word");
    check_bad("breccia: 1\nvgcm:\n  note: |\n    a\n    b\n", "c.yaml:3: a value must be one line");
    check_bad("breccia: 1\nvgcm:\n  note: \"a\\0b\"\n", "c.yaml:3: a value must be one line");
    check_bad("breccia: 1\nvgcm:\n  a.b: 1\n", "c.yaml:3: 'a.b' is not a key");
    check_bad("breccia: 1\nvgcm:\n  '': 1\n", "c.yaml:3: '' is not a key");
    check_bad("breccia: 1\nvgcm:\n  "
              "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa: 1\n",
              "is not a key; a key has 1 to 63 characters and no dot");
    check_bad("breccia: 1\nvgcm:\n  aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa:\n"
              "    {bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb: 1}\n",
              "c.yaml:4: the key vgcm.aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa.bbbb");
}

static void bytes_are_checked(void **state)
{
    (void)state;
    check_bad("breccia: 1\ntitle: \xff\n", "c.yaml:2: byte 0xff starts no valid UTF-8 text");
    check_bad("breccia: 1\n\ntitle: \x07\n", "c.yaml:3: byte 0x07 starts no valid UTF-8 text or is "
                                             "a control character; save the file as plain UTF-8");
    check_bad("\xef\xbb\xbf"
              "breccia: 1\n",
              "c.yaml:1: byte 0xef");
    check_bad("title: \xc0\xaf\n", "c.yaml:1: byte 0xc0");     /* overlong */
    check_bad("title: \xed\xa0\x80\n", "c.yaml:1: byte 0xed"); /* surrogate */
    check_bad("title: \xf4\x90\x80\x80\n", "c.yaml:1: byte 0xf4");
    check_bad("title: \xe2\x82", "c.yaml:1: byte 0xe2"); /* cut off */
    check_bad("title: \xc2\x85\n", "c.yaml:1: byte 0xc2");
    check_bad_bytes("breccia: 1\n\0\n", 13, "c.yaml:2: byte 0x00");
}

static void sizes_are_bounded(void **state)
{
    size_t size = BRC_CASEFILE_MAX_BYTES + 1;
    char *text = malloc(size + 1);
    (void)state;
    assert_non_null(text);
    memset(text, ' ', size);
    memcpy(text, "breccia: 1\n#", 12);
    text[size] = '\0';
    check_bad_bytes(text, size, "c.yaml: the case file is larger than 1048576 bytes");
    text[size - 1] = '\0';
    check_good(text);
    size_t n = (size_t)sprintf(text, "breccia: 1\nvgcm:\n");
    for (int i = 0; i < BRC_CASEFILE_MAX_ENTRIES; i++)
        n += (size_t)sprintf(text + n, "  k%d: 1\n", i);
    check_bad_bytes(text, n, "c.yaml:4098: more than 4096 keys in one case");
    free(text);
    char many[512] = "breccia: 1\nmodels: [";
    for (int i = 0; i <= BRC_CASEFILE_MAX_MODELS; i++)
        sprintf(many + strlen(many), "%sm%d", i ? ", " : "", i);
    check_bad(strcat(many, "]\n"), "c.yaml: models: more than 16 names");
}

static void files_are_opened(void **state)
{
    char path[] = "/tmp/breccia_test_case_XXXXXX";
    struct brc_casefile c;
    int file = mkstemp(path);
    (void)state;
    assert_true(file >= 0);
    assert_int_equal(write(file, "breccia: 1\ntitle: t\n", 20), 20);
    close(file);
    CHECK_OK(&ctx, brc_casefile_read(&ctx, path, &c));
    assert_string_equal(c.head.title, "t");
    assert_string_equal(c.path, path);
    brc_casefile_free(&c);
    unlink(path);
    CHECK_FAILS(&ctx, brc_casefile_read(&ctx, path, &c), BRC_ERR_IO,
                "cannot read the case file /tmp/breccia_test_case_");
    brc_casefile_free(&c);
    CHECK_FAILS(&ctx, brc_casefile_read(&ctx, "/tmp", &c), BRC_ERR_IO,
                "cannot read the case file /tmp: ");
    brc_casefile_free(&c);
    CHECK_FAILS(&ctx, brc_casefile_read(&ctx, "/dev/zero", &c), BRC_ERR_IO,
                "cannot read the case file /dev/zero: it is a device");
    brc_casefile_free(&c);
}

/* Random damage to a good case ends in success or a message, never in a crash. */
static void damage_is_survived(void **state)
{
    static const char good[] = "breccia: 1\ntitle: a\nmodels: [a, b]\n"
                               "vgcm: {e_bar: 50 GPa, interaction: {rule: gap, gap: 1 mm}}\n";
    static const char bytes[] = "{}[]:,&*!?|>'\"%@`#- \n\t\\0aZ.\xff";
    uint64_t seed = 1;
    int n_failed = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        char text[sizeof good];
        struct model m;
        struct brc_casefile c;
        memcpy(text, good, sizeof good);
        for (int k = 0; k < 3; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            text[(seed >> 33) % (sizeof good - 1)] = bytes[(seed >> 20) % (sizeof bytes - 1)];
        }
        int code = read_all(text, sizeof good - 1, &m, &c);
        assert_true(code == 0 || (code == ctx.code && ctx.message[0] != '\0'));
        n_failed += code != 0;
        brc_error_clear(&ctx);
        brc_casefile_free(&c);
    }
    assert_true(n_failed > 10000);
}

/* Writes a key into the case that a text makes: that key reads back, all others are as before. */
static void check_only_one_changes(const struct brc_casefile *before, const char *key,
                                   const char *value)
{
    struct brc_casefile c;
    const char *text = before->text;
    CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", text, strlen(text), &c));
    CHECK_OK(&ctx, brc_casefile_write(&ctx, &c, "vgcm", key, model_list, value));
    const struct brc_casefile_entry *now = brc_casefile_find_entry(&c, "vgcm", key, model_list);
    assert_non_null(now);
    assert_string_equal(now->text, value);
    const struct brc_casefile_entry *old = brc_casefile_find_entry(before, "vgcm", key, model_list);
    assert_int_equal(c.n, before->n + (old == NULL));
    for (size_t i = 0; i < before->n; i++) {
        const struct brc_casefile_entry *e = &before->entries[i], *same = NULL;
        for (size_t k = 0; k < c.n; k++)
            if (strcmp(e->section, c.entries[k].section) == 0 &&
                strcmp(e->key, c.entries[k].key) == 0)
                same = &c.entries[k];
        assert_true(e == old || (same && strcmp(same->text, e->text) == 0));
    }
    brc_casefile_free(&c);
}

/* Whatever layout YAML allows. */
static void odd_layouts_take_values(void **state)
{
    static const char *const good[] = {
        "breccia: 1\ntitle: 'a'\nvgcm:\n  e_bar: 50 GPa #c\n  interaction:\n    gap: 1 mm\n",
        "breccia: 1\nvgcm: {e_bar: \"50 GPa\", interaction: {rule: gap, gap: 1 mm}}\n#c\nstrict:\n",
        "breccia: 1\nvgcm:\n  size:\n  - 1 m\n  - 2 m\n  - 3 m\n  note: >-\n    a\n\n    b\nmodel: "
        "x"};
    static const char bytes[] = "{}[]:,?|>'\"`#- \n\n \t\raZ.~";
    uint64_t seed = 7;
    int n_good = 0;
    (void)state;
    for (int i = 0; i < 60000; i++) {
        struct brc_casefile c;
        char text[256];
        size_t n = strlen(good[i % 3]);
        memcpy(text, good[i % 3], n + 1);
        for (int k = 0; k < 1 + i % 4; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            text[(seed >> 33) % n] = bytes[(seed >> 20) % (sizeof bytes - 1)];
        }
        if (brc_casefile_parse(&ctx, "c.yaml", text, n, &c) == 0) {
            check_only_one_changes(&c, "e_bar", "60 GPa");
            check_only_one_changes(&c, "note", "a: #b");
            n_good++;
        }
        brc_error_clear(&ctx);
        brc_casefile_free(&c);
    }
    assert_true(n_good > 5000);
}

/* An older name gives the value, in messages and written places too; beside the present name it is
 * the same key twice. */
static void older_names_are_read(void **state)
{
    struct brc_casefile c;
    struct model m = check_good("breccia: 1\nvgcm: {remark: old}\n");
    (void)state;
    assert_string_equal(m.note, "old");
    check_bad("breccia: 1\nvgcm:\n  note: a\n  remark: b\n",
              "c.yaml:4: vgcm.note: given twice, first in line 3");
    const char text[] = "breccia: 1\nvgcm: {remark: old}\n";
    CHECK_OK(&ctx, brc_casefile_parse(&ctx, "c.yaml", text, strlen(text), &c));
    CHECK_OK(&ctx, brc_casefile_write(&ctx, &c, "vgcm", "note", model_list, "new"));
    assert_string_equal(c.text, "breccia: 1\nvgcm: {remark: new}\n");
    brc_casefile_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(case_is_read),
        cmocka_unit_test(spellings_agree),
        cmocka_unit_test(overrides_hold),
        cmocka_unit_test(values_are_written_in_their_place),
        cmocka_unit_test(keys_are_added_to_their_section),
        cmocka_unit_test(every_value_reads_back),
        cmocka_unit_test(odd_layouts_take_values),
        cmocka_unit_test(bad_overrides_are_named),
        cmocka_unit_test(top_level_errors),
        cmocka_unit_test(section_errors),
        cmocka_unit_test(required_keys_are_named),
        cmocka_unit_test(yaml_is_kept_plain),
        cmocka_unit_test(bytes_are_checked),
        cmocka_unit_test(sizes_are_bounded),
        cmocka_unit_test(files_are_opened),
        cmocka_unit_test(damage_is_survived),
        cmocka_unit_test(older_names_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
