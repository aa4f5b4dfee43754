/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts that are listed but exert nothing change no bit of a run, though they move all others to
 * other places in the list, and so into other chunks, batches, lanes and queues. polyhedra without
 * linearised contacts: how long one may stay linearised hangs on when it was listed. */
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const struct brc_model brc_model_vgcm, brc_model_polyhedra;

static const struct {
    const struct brc_model *model;
    const char *settings[2]; /* quasi-static, dynamic */
} way[] = {
    {&brc_model_vgcm, {"", "viscous: 1e4 1/s"}},
    {&brc_model_polyhedra,
     {"evaluation: literal; eps_th: 1e-3", "evaluation: literal; eps_th: 1e-3; gn: 1e5 1/s"}}};

struct outcome {
    size_t n_contacts, n_events, n_bodies;
    /* N, N m, on each body; J, what it has booked: a last bit of one is not seen in their sum */
    struct {
        double force[3], moment[3], energy[BRC_N_ACCOUNTS];
    } * body;
    struct brc_ledger ledger;
};

static void run(struct fixture *f, int model, const char *skin, int regime, struct outcome *o)
{
    static const char *const more[] = {"ledger: on", "ledger: on; regime: dynamic; dt: 3e-7 s"};
    static const char *const test[] = {
        "kind: compression; friction: 0.2; rate: 4e-6 1/s",
        "kind: compression; friction: 0.2; loading: fixed; rate: 100 1/s"};
    char settings[128];
    snprintf(settings, sizeof settings, "%s; skin: %s", more[regime], skin);
    fixture_sim(f, way[model].model, way[model].settings[regime], test[regime], settings);
    fixture_steps(f, 600);
    const struct brc_bodies *b = &f->sim.bodies;
    *o = (struct outcome){.n_contacts = f->sim.pairs.n,
                          .n_events = f->sim.events.table.n,
                          .n_bodies = b->n,
                          .body = malloc(b->n * sizeof *o->body),
                          .ledger = f->sim.ledger};
    assert_non_null(o->body);
    for (size_t i = 0; i < b->n; i++) {
        memcpy(o->body[i].force, b->f[i], sizeof b->f[i]);
        memcpy(o->body[i].moment, b->t[i], sizeof b->t[i]);
        memcpy(o->body[i].energy, b->energy[i], sizeof b->energy[i]);
    }
}

static void listed_contacts_change_no_bit(void **state)
{
    struct fixture *f = *state;
    struct outcome few, many;
    fixture_specimen(f, "shape: box; grains: packing; size: 25 mm, 25 mm, 35 mm");
    for (int i = 0; i < 4; i++) {
        int model = i / 2, regime = i % 2;
        run(f, model, "0.2", regime, &few);
        run(f, model, "0.5", regime, &many);
        print_message("%s: %zu and %zu contacts, %zu and %zu events\n", way[model].model->name,
                      few.n_contacts, many.n_contacts, few.n_events, many.n_events);
        assert_true(many.n_contacts > few.n_contacts + 20);
        assert_true(few.n_events > 50);
        assert_int_equal(many.n_events, few.n_events);
        assert_memory_equal(few.body, many.body, few.n_bodies * sizeof *few.body);
        assert_memory_equal(&few.ledger, &many.ledger, sizeof few.ledger);
        free(few.body);
        free(many.body);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(listed_contacts_change_no_bit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
