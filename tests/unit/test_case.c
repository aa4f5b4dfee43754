/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case as a whole: keys that others make meaningless, keys that bound each other, sections. */
#include "common/runs/applies.h"
#include "common/runs/case_keep.h"
#include "common/runs/case_text.h"
#include "tests/near.h"

#include <stdio.h>
#include <stdlib.h>

static struct brc_context ctx = BRC_CONTEXT_INIT;

static void good(const char *text)
{
    struct brc_case run_case;
    CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", text));
    brc_case_free(&run_case);
}

static void bad(const char *text, const char *message)
{
    struct brc_case run_case;
    CHECK_FAILS(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", text), BRC_ERR_INPUT, message);
    brc_case_free(&run_case);
}

static void keys_of_another_kind_are_refused(void **state)
{
    (void)state;
    bad("breccia: 1\nspecimen: {shape: box,\n  diameter: 3 cm}\n",
        "c.yaml:3: specimen.diameter: applies only with shape=cylinder, but specimen.shape is box; "
        "leave the key out, or change specimen.shape; what applies now is size");
    bad("breccia: 1\nspecimen: {size: [1 m, 1 m, 1 m]}\n",
        "c.yaml:2: specimen.size: applies only with shape=box, but specimen.shape is cylinder (its "
        "default); leave the key out, or change specimen.shape; what applies now is diameter, "
        "height, sides");
    bad("breccia: 1\nrun: {dt: 1 s}\n",
        "run.dt: applies only with regime=dynamic, but run.regime is quasi_static (its default); "
        "leave the key out, or change run.regime; what applies now is mass_margin");
    bad("breccia: 1\nrun: {regime: dynamic, dt: 1 s, dt_margin: 0.5}\n",
        "run.dt_margin: applies only with dt=0, but run.dt is 1 s;");
    bad("breccia: 1\nspecimen: {grains: grid, shape: box, count: 7}\n",
        "specimen.count: applies only with grains=packing, but specimen.grains is grid; leave the "
        "key out, or change specimen.grains; what applies now is cells, jitter, seed");
    bad("breccia: 1\ntest: {grip: full}\n", "test.grip: applies only with kind=tension, but");
    bad("breccia: 1\ntest: {loading: fixed, target: 0.01}\n",
        "test.target: applies only with loading=adaptive, but test.loading is fixed");
    bad("breccia: 1\ntest: {kind: none, strain_max: 0.1}\n", "but test.kind is none");
    bad("breccia: 1\ntest: {kind: tension, plate_width: 1 mm}\n",
        "test.plate_width: applies only with kind=brazilian");
    bad("breccia: 1\nvgcm: {interaction: {rule: all, gap: 1 mm}}\n",
        "vgcm.interaction_gap: applies only with interaction=gap, but vgcm.interaction is all");
    bad("breccia: 1\nvgcm: {softening: none, g_fn: 5 J/m2}\n",
        "vgcm.g_fn: applies only with softening=linear|bilinear, but vgcm.softening is none");
    bad("breccia: 1\nvgcm: {g_fn: 5 J/m2, g_fs: 5 J/m2, energy_ratio: 9}\n",
        "vgcm.energy_ratio: applies only with g_fn=auto or g_fs=auto, but vgcm.g_fn is 5 J/m2");
    bad("breccia: 1\nvgcm: {viscous: 1 1/s}\n",
        "vgcm.viscous: applies only with run.regime=dynamic, but run.regime is quasi_static");
    good("breccia: 1\nvgcm: {g_fn: 5 J/m2, energy_ratio: 9}\n");
    good("breccia: 1\nvgcm: {viscous: 1 1/s}\nrun: {regime: dynamic}\n");
    good("breccia: 1\nspecimen: {shape: box, size: [1 m, 1 m, 1 m]}\n");
}

/* Every declaration can be read. A key at its default is taken or refused by its declaration. */
static void every_key_is_judged(void **state)
{
    struct brc_case run_case;
    struct brc_case_section s;
    const char *clause;
    int n_refused = 0, n_taken = 0;
    (void)state;
    CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", "breccia: 1\n"));
    for (int i = 0; brc_case_section(NULL, i, &s); i++)
        for (int k = 0; k < s.list.n; k++) {
            const struct brc_param *p = &s.list.params[k];
            char text[512];
            if (!p->applies || !p->default_text)
                continue;
            CHECK_OK(&ctx, brc_applies(&ctx, &run_case, s.name, p, &clause));
            snprintf(text, sizeof text, "breccia: 1\n%s: {%s: '%s'}\n", s.name, p->key,
                     p->default_text);
            if (clause)
                bad(text, "applies only with");
            else
                good(text);
            *(clause ? &n_refused : &n_taken) += 1;
        }
    brc_case_free(&run_case);
    assert_true(n_refused > 15 && n_taken > 15);
}

static void check_override(const char *text, const char *const *overrides, int n,
                           const char *message)
{
    struct brc_case run_case, changed;
    CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", text));
    int code = brc_case_change(&ctx, &run_case, overrides, n, &changed);
    if (message)
        CHECK_FAILS(&ctx, code, BRC_ERR_INPUT, message);
    else
        CHECK_OK(&ctx, code);
    brc_case_free(&changed);
    brc_case_free(&run_case);
}

static void an_override_makes_another_case(void **state)
{
    static const char text[] = "breccia: 1\ntest: {target: 0.01}\n";
    (void)state;
    check_override(text, (const char *const[]){"test.loading=fixed"}, 1, NULL);
    check_override(text, (const char *const[]){"test.grip=full"}, 1,
                   "--set: test.grip: applies only with kind=tension");
    check_override(text, (const char *const[]){"test.loading=fixed", "test.rate_max=1e-6 1/s"}, 2,
                   "--set: test.rate_max: applies only with loading=adaptive");
    check_override("breccia: 1\nvgcm: {softening_beta: 0.3}\n",
                   (const char *const[]){"vgcm.softening.rule=linear"}, 1, NULL);
}

/* What a run keeps says only what counts. */
static void check_kept(const char *text, const char *override, const char *expected)
{
    struct brc_case run_case, changed;
    char *kept;
    CHECK_OK(&ctx, brc_case_parse(&ctx, &run_case, "c.yaml", text));
    CHECK_OK(&ctx, brc_case_change(&ctx, &run_case, &override, 1, &changed));
    CHECK_OK(&ctx, brc_case_keep(&ctx, &changed, brc_registry_find("vgcm"), "/tmp", &kept));
    assert_string_equal(kept, expected);
    good(kept);
    free(kept);
    brc_case_free(&changed);
    brc_case_free(&run_case);
}

static void keys_without_a_meaning_are_not_kept(void **state)
{
    (void)state;
    check_kept("breccia: 1\nmodel: vgcm\ntest:\n  target: 0.01 # fine\n  loading: adaptive # x\n",
               "test.loading=fixed", "breccia: 1\nmodel: vgcm\ntest:\n  loading: fixed # x\n");
    check_kept("breccia: 1\nmodel: vgcm\ntest: {target: 0.01, loading: adaptive}\n",
               "test.loading=fixed", "breccia: 1\nmodel: vgcm\ntest: { loading: fixed}\n");
    check_kept("breccia: 1\nmodel: vgcm\ntest: {loading: adaptive, target: 0.01}\n",
               "test.loading=fixed", "breccia: 1\nmodel: vgcm\ntest: {loading: fixed, }\n");
    check_kept(
        "breccia: 1\nmodel: vgcm\nspecimen:\n  shape: box\n  grains: grid\n  cells:\n    - 3\n"
        "    - 3\n    - 3\n  size: [1 m, 1 m,\n    1 m]\n",
        "specimen.grains=packing",
        "breccia: 1\nmodel: vgcm\nspecimen:\n  shape: box\n  grains: packing\n"
        "  size: [1 m, 1 m,\n    1 m]\n");
    check_kept("breccia: 1\nmodel: vgcm\nvgcm:\n  interaction:\n    gap: 1 mm\n", /* alone */
               "vgcm.interaction.rule=all",
               "breccia: 1\nmodel: vgcm\nvgcm:\n  interaction:\n    rule: all\n");
    /* alone in its section, whose kind another one decides */
    check_kept("breccia: 1\nmodel: vgcm\nvgcm:\n  viscous: 1 1/s # much\nrun: {regime: dynamic}\n",
               "run.regime=quasi_static",
               "breccia: 1\nmodel: vgcm\nvgcm:\n  {} # much\nrun: {regime: quasi_static}\n");
}

static void sections_stand_in_the_first_column(void **state)
{
    (void)state;
    bad("breccia: 1\nspecimen:\n  shape: box\n  test:\n    kind: tension\n",
        "c.yaml:4: test is a section, but it is indented under specimen; write it in the first "
        "column");
    bad("breccia: 1\nvgcm:\n  polyhedra: {radius: 1 mm}\n",
        "c.yaml:3: polyhedra is a section, but it is indented under vgcm");
    bad("breccia: 1\nspecimen:\n  seed: 3\n  title: foo\n",
        "c.yaml:4: title is a key of the top level, but it is indented under specimen");
}

static void usual_slips_are_named(void **state)
{
    (void)state;
    bad("breccia: 1\nvgcm:\n  e_bar: 48,8 GPa\n",
        "c.yaml:3: vgcm.e_bar: '48,8 GPa' has a decimal comma; write a decimal point, '48.8 GPa'");
    bad("breccia: 1\nvgcm: {e_bar: 48,8 GPa}\n",
        "c.yaml:2: '8 GPa' follows a comma: in braces and brackets a comma ends a value, so write "
        "numbers with a decimal point");
    bad("breccia: 1\nspecimen: {shape: box, size: '4,5 cm, 1 cm, 1 cm'}\n", "decimal point");
    bad("breccia: 1\nvgcm:\n\te_bar: 1 GPa\n",
        "c.yaml:3: not valid YAML: the line is indented by a tab, indent it by blanks");
    bad("breccia: 1\nvgcm:\n  mu: 0.1\n \te_bar: 1 GPa\n", "the line is indented by a tab");
    bad("breccia: 1\nvgcm:\n  mu: 0.1\n tau: 1 GPa\n", "c.yaml:4: not valid YAML: ");
    bad("breccia: 1\nvgcm: {youngs_modulus: 5 GPa}\n",
        "vgcm.youngs_modulus: unknown key; did you mean 'e_bar' (modulus of the equivalent "
        "continuum, eq 28)? allowed density");
    bad("breccia: 1\nvgcm: {cohesion: 5 GPa}\n", "did you mean 'tau' (cohesion of a point");
    bad("breccia: 1\nvgcm: {sigmat: 5 MPa}\n", "did you mean 'sigma_t'?");
    bad("breccia: 1\nmodels: [vgcm, polyhedra, vgcm]\n",
        "c.yaml:2: models: vgcm is named twice; name each model once");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_of_another_kind_are_refused),
        cmocka_unit_test(every_key_is_judged),
        cmocka_unit_test(an_override_makes_another_case),
        cmocka_unit_test(keys_without_a_meaning_are_not_kept),
        cmocka_unit_test(sections_stand_in_the_first_column),
        cmocka_unit_test(usual_slips_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
