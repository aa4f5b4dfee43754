/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program of one's own on the installed library: runs a model through the test of a case and
 * prints what was measured.
 *     cc example_library.c $(pkg-config --cflags --libs breccia) -o example
 *     ./example case.yaml vgcm */
#include <breccia/case.h>

#include <stdio.h>

static int run(struct brc_context *ctx, struct brc_case *run_case, const struct brc_model *model,
               struct brc_specimen *specimen, struct brc_sim *sim)
{
    struct brc_result result[BRC_MAX_RESULTS];
    BRC_TRY(brc_specimen_create(ctx, &run_case->specimen, specimen));
    BRC_TRY(brc_case_sim(ctx, run_case, model, specimen, sim));
    while (!brc_rigs_done(sim))
        BRC_TRY(brc_sim_step(sim));
    int n = brc_rigs_results(sim, result);
    for (int i = 0; i < n; i++)
        printf("%s = %.17g %s\n", result[i].name, result[i].value, result[i].unit);
    return 0;
}

int main(int argc, char **argv)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_case run_case = {0};
    struct brc_specimen specimen = {0};
    struct brc_sim sim = {0};
    const struct brc_model *model = argc == 3 ? brc_registry_find(argv[2]) : NULL;
    if (!model)
        return 2;
    int code = brc_case_read(&ctx, &run_case, argv[1], NULL, 0);
    if (code == 0)
        code = run(&ctx, &run_case, model, &specimen, &sim);
    if (code != 0)
        fprintf(stderr, "%s\n", ctx.message);
    brc_sim_free(&sim);
    brc_specimen_free(&specimen);
    brc_case_free(&run_case);
    return brc_error_exit_status(code);
}
