/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts of gnuplot: what is drawn, from which data, and that titles stay text. */
#include "common/output/plot.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void make_folder(char dir[64])
{
    snprintf(dir, 64, "/tmp/breccia-test-%ld-plot", (long)getpid());
    char command[100];
    snprintf(command, sizeof command, "mkdir -p %s", dir);
    assert_int_equal(system(command), 0);
}

static void remove_folder(const char *dir)
{
    char command[100];
    snprintf(command, sizeof command, "rm -r %s", dir);
    assert_int_equal(system(command), 0);
}

static char *read_file(const char *dir, const char *name)
{
    char path[100];
    char *text = calloc(1 << 18, 1);
    snprintf(path, sizeof path, "%s/%s", dir, name);
    FILE *in = fopen(path, "r");
    assert_non_null(text);
    assert_non_null(in);
    assert_true(fread(text, 1, (1 << 18) - 1, in) < (1 << 18) - 1);
    fclose(in);
    return text;
}

static void break_part(struct fixture *f, int64_t step, int32_t facet, enum brc_mode mode,
                       double part)
{
    const struct brc_facets *t = &f->specimen.facets;
    const struct brc_event event = {.a = t->cell[facet][0],
                                    .b = t->cell[facet][1],
                                    .facet = facet,
                                    .mode = mode,
                                    .area = part * t->area[facet]};
    brc_events_add(&f->ctx, &f->sim.events, step, &event);
}

/* Number of inner facet k. */
static int32_t inner(const struct fixture *f, int k)
{
    for (int32_t i = 0; (size_t)i < f->specimen.facets.n_facets; i++)
        if (f->specimen.facets.cell[i][1] >= 0 && k-- == 0)
            return i;
    fail();
    return -1;
}

static void test_majority(void **state)
{
    struct fixture *f = *state;
    struct brc_output_params output;
    char dir[64];
    make_folder(dir);
    fixture_grid(f, 3, 3, 3, 0.01, 0);
    fixture_sim(f, &brc_model_null, "", "", "");
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_output_param_list, &output));
    /* one whole in torsion; one broken by half, more in shear; one just below a half */
    break_part(f, 1, inner(f, 0), BRC_MODE_TORSION, 1);
    break_part(f, 2, inner(f, 1), BRC_MODE_TENSION, 0.2);
    break_part(f, 2, inner(f, 1), BRC_MODE_SHEAR, 0.3);
    break_part(f, 3, inner(f, 2), BRC_MODE_TENSION, 0.49);
    CHECK_OK(&f->ctx, brc_plot_cracks(&f->ctx, dir, &f->sim, &output));
    char *text = read_file(dir, "cracks.plot");
    assert_non_null(strstr(text, "torsion: 1 facets, 1 cm\u00b2"));
    assert_non_null(strstr(text, "shear: 1 facets, 1 cm\u00b2'"));
    assert_non_null(strstr(text, "tension: 0 facets, 0 cm\u00b2"));
    assert_non_null(strstr(text, "$outline << end_of_data\n"));
    free(text);
    /* the sides of the second have moved apart twice as far as those of the first */
    const struct brc_facets *t = &f->specimen.facets;
    int32_t one = t->cell[inner(f, 0)][0], other = t->cell[inner(f, 0)][1];
    assert_int_equal(t->cell[inner(f, 1)][0], one);
    f->sim.bodies.x[other][0] += 1e-4;
    f->sim.bodies.x[t->cell[inner(f, 1)][1]][2] += 2e-4;
    output.opening = 1;
    CHECK_OK(&f->ctx, brc_plot_cracks(&f->ctx, dir, &f->sim, &output));
    text = read_file(dir, "cracks.plot");
    assert_non_null(strstr(text, "torsion: 1 facets, 1 cm\u00b2, 0 drawn"));
    assert_non_null(strstr(text, "shear: 1 facets, 1 cm\u00b2'"));
    free(text);
    remove_folder(dir);
}

static void test_broken_area(void **state)
{
    struct fixture *f = *state;
    char dir[64];
    make_folder(dir);
    fixture_grid(f, 2, 1, 1, 0.01, 0);
    fixture_sim(f, &brc_model_null, "", "", "");
    fixture_steps(f, 30);
    break_part(f, 11, inner(f, 0), BRC_MODE_SHEAR, 0.25);
    break_part(f, 20, inner(f, 0), BRC_MODE_SHEAR, 0.5);
    CHECK_OK(&f->ctx, brc_plot_broken(&f->ctx, dir, &f->sim));
    char *text = read_file(dir, "broken.csv");
    long long step;
    double strain, tension, shear, torsion, expected[3] = {0, 0.75, 0.75};
    const char *line = text;
    for (int i = 0; i < 3; i++) {
        line = strchr(line, '\n') + 1;
        assert_int_equal(
            sscanf(line, "%lld,%lf,%lf,%lf,%lf", &step, &strain, &tension, &shear, &torsion), 5);
        assert_int_equal(step, 10 * (i + 1));
        CHECK_NEAR(shear, expected[i], 1e-12, 0);
        CHECK_NEAR(tension + torsion, 0, 0, 0);
    }
    free(text);
    remove_folder(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(test_majority),
        FIXTURE_TEST(test_broken_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
