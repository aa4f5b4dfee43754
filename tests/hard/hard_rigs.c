/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of whole tests: what the strength depends on besides the rock. */
#include "tests/hard/hard.h"

#include <stdlib.h>
#include <unistd.h>

enum { SAMPLES = 8 };

/* Largest load of the case with the overrides, over the section. */
static double strength(struct fixture *f, const char *name, const struct brc_model *model,
                       const char *const *overrides, int n)
{
    hard_case(f, name, model, overrides, n);
    while (!brc_rigs_done(&f->sim))
        fixture_steps(f, 1);
    return f->sim.rig.force_peak / f->sim.rig.section;
}

/* Mean and its standard error of the change of the strength over the samples. */
static void change_of(const double *value, const double *base, double change[2])
{
    double sum = 0, squares = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double c = value[i] / base[i] - 1;
        sum += c;
        squares += c * c;
    }
    change[0] = sum / SAMPLES;
    change[1] = sqrt((squares / SAMPLES - change[0] * change[0]) / (SAMPLES - 1));
}

/* The time step of the quasi-static regime is 1 and its masses are scaled: four times the mass is
 * half the step. */
static void loading_rate(void **state)
{
    struct fixture *f = *state;
    const char *const changed[3] = {"test.target=0.003", "test.target=0.0015",
                                    "run.mass_margin=4.8"};
    for (int m = 0; m < brc_registry_count(); m++) {
        const struct brc_model *model = brc_registry_at(m);
        double value[3][SAMPLES], rate[2], step[2], mean = 0;
        for (int i = 0; i < SAMPLES; i++)
            for (int c = 0; c < 3; c++) {
                char seed[64];
                snprintf(seed, sizeof seed, "specimen.seed=%d", i + 1);
                value[c][i] =
                    strength(f, "loading_rate", model, (const char *const[]){seed, changed[c]}, 2);
                mean += c == 0 ? value[c][i] / SAMPLES : 0;
            }
        change_of(value[1], value[0], rate);
        change_of(value[2], value[0], step);
        hard_row("loading_rate", model->name, fabs(rate[0]) < 0.03 && fabs(step[0]) < 0.03,
                 "strength, mean of 8 specimens: changes by less than 3 % with the loading target "
                 "or the time step halved",
                 "%.1f MPa; target %+.2f +- %.2f %%, step %+.2f +- %.2f %%", 1e-6 * mean,
                 100 * rate[0], 100 * rate[1], 100 * step[0], 100 * step[1]);
    }
}

static void damping(void **state)
{
    struct fixture *f = *state;
    const char *const alpha[4] = {"run.fluctuation_damping=0.2", "run.fluctuation_damping=0.4",
                                  "run.fluctuation_damping=0.6", "run.fluctuation_damping=0.8"};
    for (int m = 0; m < brc_registry_count(); m++) {
        const struct brc_model *model = brc_registry_at(m);
        double value[4], low = HUGE_VAL, high = 0;
        for (int i = 0; i < 4; i++) {
            value[i] = strength(f, "damping", model, &alpha[i], 1);
            low = fmin(low, value[i]);
            high = fmax(high, value[i]);
        }
        hard_row("damping", model->name, high / low < 1.05,
                 "direct tension at alpha 0.2, 0.4, 0.6, 0.8 within 5 %",
                 "%.3f, %.3f, %.3f, %.3f MPa", 1e-6 * value[0], 1e-6 * value[1], 1e-6 * value[2],
                 1e-6 * value[3]);
    }
}

/* The case's seeds, turned about the load's axis, as a file of points. */
static void write_turned(struct fixture *f, const char *path, double angle)
{
    const struct brc_facets *t = &f->specimen.facets;
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (size_t i = 0; i < t->n_cells; i++) {
        const double *x = t->seed[i], c = cos(angle), s = sin(angle);
        fprintf(file, "%.17g %.17g %.17g %.17g\n", c * x[0] - s * x[1], s * x[0] + c * x[1], x[2],
                t->radius[i]);
    }
    fclose(file);
}

/* Strength of the specimen turned by 5 of the 32 sides of its prism. */
static double turned(struct fixture *f, const struct brc_model *model, const char *kind, int sides)
{
    char path[] = "/tmp/breccia-hard-XXXXXX", text[2][64];
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    snprintf(text[0], sizeof text[0], "specimen.points=%s", path);
    snprintf(text[1], sizeof text[1], "run.damping=%s", kind);
    hard_case(f, "damping", model, NULL, 0);
    write_turned(f, path, 2 * BRC_PI * sides / 32);
    double value = strength(
        f, "damping", model,
        (const char *const[]){"specimen.grains=points", "specimen.sides=32", text[0], text[1]}, 4);
    unlink(path);
    return value;
}

static void rotated_specimen(void **state)
{
    struct fixture *f = *state;
    for (int m = 0; m < brc_registry_count(); m++) {
        const struct brc_model *model = brc_registry_at(m);
        double part[2];
        for (int i = 0; i < 2; i++) {
            const char *kind = i == 0 ? "cartesian" : "along_velocity";
            part[i] = turned(f, model, kind, 5) / turned(f, model, kind, 0) - 1;
        }
        hard_row("rotated specimen", model->name, fabs(part[0]) < 0.03 && fabs(part[1]) < 0.03,
                 "direct tension, specimen turned by 56 degrees about the load: within 3 %",
                 "change %+.2f %% with cartesian damping, %+.2f %% along the velocity",
                 100 * part[0], 100 * part[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        FIXTURE_TEST(damping),
        FIXTURE_TEST(rotated_specimen),
        FIXTURE_TEST(loading_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) + hard_failed;
}
