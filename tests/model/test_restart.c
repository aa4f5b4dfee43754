/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run that is saved, loaded and continued has the same bits as one that never stopped. */
#include "common/output/io_h5.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <unistd.h>

static const struct brc_h5_extra nothing = {NULL, 0, NULL, 0};

struct setting {
    const char *test, *run;
    int before, after; /* steps up to the save, and from there on */
};

/* Both regimes; the load breaks bonds before and after the save. */
static const struct setting settings[] = {
    {"kind: compression; loading: fixed; rate: 1e-4 1/s; strain_max: 0.99", "", 430, 120},
    {"kind: tension; loading: adaptive; rate: 1e-4 1/s; rate_max: 2e-4 1/s; strain_max: 0.99", "",
     200, 95},
    {"kind: compression; loading: fixed; rate: 150 1/s; strain_max: 0.99", "regime: dynamic", 190,
     110},
};
enum { N_SETTINGS = sizeof settings / sizeof settings[0] };

static uint64_t continued(struct fixture *f, const struct brc_model *model, const struct setting *s,
                          const char *path)
{
    fixture_sim(f, model, "", s->test, s->run);
    CHECK_OK(&f->ctx, brc_h5_load(&f->ctx, path, &f->sim, &nothing));
    assert_int_equal(f->sim.step, s->before);
    fixture_steps(f, s->after);
    return brc_sim_hash(&f->sim);
}

/* Adds the events before and after the save. */
static void check_setting(struct fixture *f, const struct brc_model *model, const struct setting *s,
                          size_t events[2])
{
    char path[64];
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-restart.h5", (long)getpid());
    fixture_sim(f, model, "", s->test, s->run);
    fixture_steps(f, s->before);
    size_t before = f->sim.events.table.n;
    CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &nothing));
    fixture_steps(f, s->after);
    uint64_t hash = brc_sim_hash(&f->sim);
    events[0] += before;
    events[1] += f->sim.events.table.n - before;
    assert_true(continued(f, model, s, path) == hash);
    assert_true(continued(f, model, s, path) == hash);
    unlink(path);
}

static void test_restart(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        bool is_null = fixture_is(model, "null");
        size_t events[2] = {0, 0};
        for (int k = 0; k < N_SETTINGS; k++) {
            if (is_null && strstr(settings[k].run, "dynamic"))
                continue; /* nothing is stiff: no automatic step */
            fixture_specimen(f, "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                                "jitter: 0.6; seed: 3");
            check_setting(f, model, &settings[k], events);
        }
        print_message("%s: %zu breaks before the saves, %zu after\n", model->name, events[0],
                      events[1]);
        assert_true(is_null || (events[0] > 0 && events[1] > 0));
    }
}

/* Steps of the window, and how far each of them is continued. */
enum { WINDOW = 40, AHEAD = 5, MOST_STEPS = 2000 };

/* Two simulations of one case; events of the first when the window begins. */
static void start_pair(struct fixture *f, struct fixture *g, const struct brc_model *model)
{
    const struct setting *s = &settings[0];
    struct fixture *both[2] = {f, g};
    for (int i = 0; i < 2; i++) {
        fixture_specimen(both[i],
                         "shape: box; grains: grid; size: 3 cm, 3 cm, 4 cm; cells: 3, 3, 4; "
                         "jitter: 0.6; seed: 3");
        fixture_sim(both[i], model, "", s->test, s->run);
    }
    while (f->sim.events.table.n < 10 && f->sim.step < MOST_STEPS)
        fixture_steps(f, 1);
}

/* Every step of an avalanche is saved, loaded into another simulation, which holds what an earlier
 * load left there, and continued. */
static void test_every_step_of_an_avalanche(void **state)
{
    struct fixture *f = *state, *g;
    char path[64];
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-every.h5", (long)getpid());
    for (int i = 0; i < fixture_n_models(); i++) {
        const struct brc_model *model = fixture_model(i);
        uint64_t hash[AHEAD] = {0};
        int breaking = 0;
        if (fixture_is(model, "null"))
            continue;
        assert_int_equal(fixture_open((void **)&g), 0);
        start_pair(f, g, model);
        for (int step = 0; step < WINDOW + AHEAD; step++) {
            size_t events = f->sim.events.table.n;
            assert_true(step < AHEAD || brc_sim_hash(&f->sim) == hash[step % AHEAD]);
            CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &nothing));
            CHECK_OK(&g->ctx, brc_h5_load(&g->ctx, path, &g->sim, &nothing));
            fixture_steps(g, AHEAD);
            hash[step % AHEAD] = brc_sim_hash(&g->sim);
            fixture_steps(f, 1);
            breaking += f->sim.events.table.n > events;
        }
        print_message("%s: %d of %d steps with breaks, from step %lld\n", model->name, breaking,
                      WINDOW + AHEAD, (long long)f->sim.step - WINDOW - AHEAD);
        assert_true(breaking >= 10);
        fixture_close((void **)&g);
    }
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(test_restart),
                                       FIXTURE_TEST(test_every_step_of_an_avalanche)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
