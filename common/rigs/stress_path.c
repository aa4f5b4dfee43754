/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stages of a true triaxial test. Every rule among the axes is a line in sigma_z, so that a stage
 * needs no more than two numbers an axis while it runs. Called by the test that is driven so; it
 * knows stresses and words, and no simulation. */
#include "common/rigs/stress_path.h"

#include "common/geometry/vec.h"
#include "common/input/params.h"

#include <stdio.h>
#include <string.h>

/* Words that begin a stage, and the values that follow them: numbers, angles or stresses. */
static const struct rule {
    const char *words;
    enum brc_path_kind kind;
    int n_values;
    const char *unit, *form;
} rules[] = {
    {"isotropic", BRC_PATH_ISOTROPIC, 0, NULL, "isotropic to 110 MPa"},
    {"p constant", BRC_PATH_P_CONSTANT, 0, NULL, "p constant to strain 0.2"},
    {"lateral constant", BRC_PATH_LATERAL, 0, NULL, "lateral constant to strain 0.02"},
    {"plane strain", BRC_PATH_PLANE, 0, NULL, "plane strain to strain 0.02"},
    {"uniaxial strain", BRC_PATH_UNIAXIAL, 0, NULL, "uniaxial strain to strain 0.001"},
    {"lode", BRC_PATH_LODE, 1, "rad", "lode 30 degree to strain 0.02"},
    {"ratio", BRC_PATH_RATIO, 2, "1", "ratio 0.5 0.7 to 100 MPa"},
    {"stress", BRC_PATH_STRESS, 3, "Pa", "stress 20 MPa 30 MPa 60 MPa"},
};
enum { N_RULES = sizeof rules / sizeof rules[0] };

/* --- reading -----------------------------------------------------------------------------------
 */

/* Text of one stage while it is read: the words that are left. */
struct words {
    char text[BRC_TEXT_SIZE];
    char *at;
};

static void skip_blanks(struct words *w)
{
    w->at += strspn(w->at, " \t");
}

/* Takes the words where they stand next. */
static bool take_words(struct words *w, const char *words)
{
    size_t n = strlen(words);
    skip_blanks(w);
    if (strncmp(w->at, words, n) != 0 || (w->at[n] != '\0' && w->at[n] != ' '))
        return false;
    w->at += n;
    return true;
}

/* A number, and the word behind it as its unit, unless it is "to" or a number. */
static int take_value(struct brc_context *ctx, struct words *w, const char *unit, const char *where,
                      double *value)
{
    char text[BRC_TEXT_SIZE];
    skip_blanks(w);
    size_t n = strcspn(w->at, " ");
    if (strcmp(unit, "1") != 0) {
        n += strspn(w->at + n, " ");
        n += strcspn(w->at + n, " ");
    }
    snprintf(text, sizeof text, "%.*s", (int)n, w->at);
    w->at += n;
    return brc_params_quantity(ctx, text, unit, value, where);
}

static int fail_form(struct brc_context *ctx, const char *stage)
{
    char forms[600] = "";
    for (int i = 0; i < N_RULES; i++)
        snprintf(forms + strlen(forms), sizeof forms - strlen(forms), "%s'%s'", i > 0 ? ", " : "",
                 rules[i].form);
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "true_triaxial.stages: '%s' is not a stage; write it like one of %s, with commas "
             "between stages",
             stage, forms);
}

/* "to strain 0.2" or "to 110 MPa". */
static int read_end(struct brc_context *ctx, struct words *w, const char *stage,
                    struct brc_stage *out)
{
    if (out->kind == BRC_PATH_STRESS) {
        out->to = out->value[2];
        return 0;
    }
    if (!take_words(w, "to"))
        return fail_form(ctx, stage);
    out->is_to_strain = take_words(w, "strain");
    return take_value(ctx, w, out->is_to_strain ? "1" : "Pa", "true_triaxial.stages", &out->to);
}

static int read_stage(struct brc_context *ctx, const char *stage, struct brc_stage *out)
{
    struct words w;
    const struct rule *rule = rules;
    snprintf(w.text, sizeof w.text, "%s", stage);
    w.at = w.text;
    while (rule < rules + N_RULES && !take_words(&w, rule->words))
        rule++;
    if (rule == rules + N_RULES)
        return fail_form(ctx, stage);
    *out = (struct brc_stage){.kind = rule->kind};
    for (int i = 0; i < rule->n_values; i++)
        BRC_TRY(take_value(ctx, &w, rule->unit, "true_triaxial.stages", &out->value[i]));
    BRC_TRY(read_end(ctx, &w, stage, out));
    skip_blanks(&w);
    if (*w.at != '\0')
        return fail_form(ctx, stage);
    if (out->is_to_strain && (out->to == 0 || fabs(out->to) >= 1))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "true_triaxial.stages: '%s': the strain must lie in (-1, 1) and not be 0", stage);
    if (out->kind == BRC_PATH_LODE && !(out->value[0] >= 0 && out->value[0] <= BRC_PI / 3 + 1e-9))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "true_triaxial.stages: '%s': the Lode angle must lie in [0, 60] degrees", stage);
    return 0;
}

int brc_stages_read(struct brc_context *ctx, const char *text, struct brc_stage *stages, int *n)
{
    char copy[BRC_TEXT_SIZE], *save = NULL;
    snprintf(copy, sizeof copy, "%s", text);
    *n = 0;
    for (char *at = strtok_r(copy, ",", &save); at; at = strtok_r(NULL, ",", &save)) {
        at += strspn(at, " \t");
        for (size_t end = strlen(at); end > 0 && at[end - 1] == ' '; end--)
            at[end - 1] = '\0';
        if (*n == BRC_MAX_STAGES)
            BRC_FAIL(ctx, BRC_ERR_INPUT, "true_triaxial.stages: more than %d stages",
                     BRC_MAX_STAGES);
        BRC_TRY(read_stage(ctx, at, &stages[*n]));
        (*n)++;
    }
    return *n > 0 ? 0 : fail_form(ctx, text);
}

/* --- laws --------------------------------------------------------------------------------------
 */

/* sigma_i - p is in proportion to cos(angle_i), with z first, y behind by 120 degrees: at a
 * constant p the others follow from sigma_z. */
static void lode_laws(double angle, double p, struct brc_axis_law law[2])
{
    double third = 2 * BRC_PI / 3;
    double part[2] = {cos(angle + third) / cos(angle), cos(angle - third) / cos(angle)};
    for (int k = 0; k < 2; k++)
        law[k] = (struct brc_axis_law){.constant = p * (1 - part[k]), .part = part[k]};
}

/* A straight line from sigma to the target, told by sigma_z. */
static void line_laws(const double target[3], const double sigma[3], struct brc_axis_law law[2])
{
    for (int k = 0; k < 2; k++) {
        law[k].part = (target[k] - sigma[k]) / (target[2] - sigma[2]);
        law[k].constant = sigma[k] - law[k].part * sigma[2];
    }
}

void brc_stage_laws(const struct brc_stage *stage, const double sigma[3],
                    struct brc_axis_law law[2])
{
    double p = brc_mean_stress(sigma);
    for (int k = 0; k < 2; k++) /* what most have: the stress across stays */
        law[k] = (struct brc_axis_law){.constant = sigma[k]};
    switch (stage->kind) {
    case BRC_PATH_ISOTROPIC:
        law[0] = law[1] = (struct brc_axis_law){.part = 1};
        break;
    case BRC_PATH_P_CONSTANT:
        law[0] = law[1] = (struct brc_axis_law){.constant = 1.5 * p, .part = -0.5};
        break;
    case BRC_PATH_LATERAL:
        break;
    case BRC_PATH_PLANE:
        law[1].is_held = true;
        break;
    case BRC_PATH_UNIAXIAL:
        law[0].is_held = law[1].is_held = true;
        break;
    case BRC_PATH_LODE:
        lode_laws(stage->value[0], p, law);
        break;
    case BRC_PATH_RATIO:
        for (int k = 0; k < 2; k++)
            law[k] = (struct brc_axis_law){.part = stage->value[k]};
        break;
    case BRC_PATH_STRESS:
        line_laws(stage->value, sigma, law);
        break;
    }
}

static double measure_of_end(const struct brc_stage *stage, const double sigma[3])
{
    return stage->kind == BRC_PATH_ISOTROPIC ? brc_mean_stress(sigma) : sigma[2];
}

double brc_stage_sense(const struct brc_stage *stage, const double sigma[3])
{
    double left = stage->is_to_strain ? stage->to : stage->to - measure_of_end(stage, sigma);
    return left < 0 ? -1 : 1;
}

bool brc_stage_is_over(const struct brc_stage *stage, double sense, double strain,
                       const double sigma[3])
{
    if (stage->is_to_strain)
        return strain >= fabs(stage->to);
    return sense * (measure_of_end(stage, sigma) - stage->to) >= 0;
}

void brc_stage_reaches(const struct brc_stage *stage, const double now[3], double sigma[3])
{
    brc_copy(sigma, now);
    if (stage->is_to_strain)
        return;
    if (stage->kind == BRC_PATH_ISOTROPIC)
        brc_set(sigma, stage->to, stage->to, stage->to);
    if (stage->kind == BRC_PATH_STRESS)
        brc_copy(sigma, stage->value);
}

/* --- invariants --------------------------------------------------------------------------------
 */

double brc_mean_stress(const double sigma[3])
{
    return (sigma[0] + sigma[1] + sigma[2]) / 3; /* eq:gt12:20 */
}

static double squares_of_differences(const double s[3])
{
    double a = s[0] - s[1], b = s[0] - s[2], c = s[1] - s[2];
    return a * a + b * b + c * c;
}

double brc_deviatoric_stress(const double sigma[3])
{
    return sqrt(squares_of_differences(sigma) / 2); /* eq:gt12:21 */
}

/* cos(3 angle) = 27/2 J_3 / q^3; without a deviator there is no angle. */
double brc_lode_angle(const double sigma[3])
{
    double p = brc_mean_stress(sigma), q = brc_deviatoric_stress(sigma);
    double j3 = (sigma[0] - p) * (sigma[1] - p) * (sigma[2] - p);
    return q > 0 ? acos(fmin(fmax(13.5 * j3 / (q * q * q), -1), 1)) / 3 : NAN;
}

double brc_volume_strain(const double eps[3])
{
    return eps[0] + eps[1] + eps[2]; /* eq:gt12:22 */
}

/* Eq 23 is printed with sqrt(2/3) and is then sqrt(3) times the conjugate of q. */
double brc_deviatoric_strain(const double eps[3])
{
    return sqrt(2 * squares_of_differences(eps)) / 3; /* eq:gt12:23 */
}
