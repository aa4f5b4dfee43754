/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A signal that comes between the specimen and the first step: nothing is claimed to be saved, no
 * folder is made or touched, no pictures are drawn. */
#include "common/runs/compare.h"
#include "common/runs/run.h"
#include "common/base/signals.h"
#include "tests/near.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const char case_text[] =
    "breccia: 1\ntitle: x\n"
    "specimen: {shape: box, size: [2 cm, 2 cm, 2 cm], grains: grid, cells: [2, 2, 2]}\n"
    "test: {kind: compression, loading: fixed, rate: 1e-4 1/s, strain_max: 0.001}\n";

struct scene {
    struct brc_context ctx;
    struct brc_case run_case;
    struct brc_specimen specimen;
    char dir[64];
};

static void open_scene(struct scene *s)
{
    *s = (struct scene){.ctx = BRC_CONTEXT_INIT};
    snprintf(s->dir, sizeof s->dir, "/tmp/breccia-test-%ld-signals", (long)getpid());
    CHECK_OK(&s->ctx, brc_case_parse(&s->ctx, &s->run_case, "case.yaml", case_text));
    CHECK_OK(&s->ctx, brc_specimen_create(&s->ctx, &s->run_case.specimen, &s->specimen));
}

static void close_scene(struct scene *s)
{
    brc_specimen_free(&s->specimen);
    brc_case_free(&s->run_case);
}

/* A signal that is held now; taken back by forget. */
static void signal_waits(int number)
{
    brc_signals_hold();
    assert_int_equal(raise(number), 0);
    assert_true(brc_signals_held());
}

static void forget(int number)
{
    sigset_t set;
    int got;
    sigemptyset(&set);
    sigaddset(&set, number);
    assert_int_equal(sigwait(&set, &got), 0);
    assert_false(brc_signals_held());
}

static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};
enum { N_SIGNALS = sizeof signals / sizeof signals[0] };

static void test_run(void **state)
{
    struct scene s;
    struct brc_progress progress;
    struct brc_summary summary;
    const char *label = "vgcm";
    (void)state;
    open_scene(&s);
    struct brc_run_options order = {
        .run_case = &s.run_case, .specimen = &s.specimen, .dir = s.dir, .progress = &progress};
    CHECK_OK(&s.ctx, brc_case_model(&s.ctx, "vgcm", &order.model));
    for (int i = 0; i < N_SIGNALS; i++) {
        char *said = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&said, &size);
        signal_waits(signals[i]);
        brc_progress_begin(&progress, out, &label, 1, false);
        CHECK_FAILS(&s.ctx, brc_run(&s.ctx, &order, &summary), BRC_ERR_NOT_BEGUN,
                    "nothing was saved");
        brc_progress_end(&progress);
        forget(signals[i]);
        fclose(out);
        assert_null(strstr(said, "done"));
        assert_int_not_equal(access(s.dir, F_OK), 0);
        free(said);
    }
    close_scene(&s);
}

static void test_compare(void **state)
{
    struct scene s;
    (void)state;
    open_scene(&s);
    const struct brc_run_options order = {
        .run_case = &s.run_case, .specimen = &s.specimen, .dir = s.dir};
    s.ctx.quiet = 1;
    signal_waits(SIGUSR1);
    CHECK_FAILS(&s.ctx, brc_compare(&s.ctx, &order), BRC_ERR_NOT_BEGUN, "nothing was saved");
    forget(SIGUSR1);
    rmdir(s.dir);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_run), cmocka_unit_test(test_compare)};
    return cmocka_run_group_tests_name("signals", tests, NULL, NULL);
}
