/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The events of a step stand by grains and point, in whatever order the contacts broke. */
#include "common/engine/events.h"
#include "tests/near.h"

static const struct brc_event broken[] = {
    {.a = 3, .b = 7, .point = 0, .area = 1}, {.a = 1, .b = 9, .point = 2, .area = 2},
    {.a = 3, .b = 5, .point = 1, .area = 3}, {.a = 1, .b = 9, .point = 0, .area = 4},
    {.a = 2, .b = 4, .point = 0, .area = 5},
};
enum { N = sizeof broken / sizeof broken[0] };

static void events_of_a_step_are_in_order(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    const double sorted[N] = {4, 2, 5, 3, 1};
    (void)state;
    for (int first = 0; first < N; first++) {
        struct brc_events e;
        brc_events_init(&e);
        brc_events_add(&ctx, &e, 6, &broken[0]); /* an earlier step stays where it is */
        for (int k = 0; k < N; k++)
            brc_events_add(&ctx, &e, 7, &broken[(first + 2 * k) % N]);
        assert_int_equal(ctx.code, 0);
        assert_int_equal(e.table.n, N + 1);
        assert_true(e.step[0] == 6 && e.area[0] == 1);
        for (int k = 0; k < N; k++) {
            assert_true(e.area[k + 1] == sorted[k]);
            assert_int_equal(e.step[k + 1], 7);
        }
        brc_events_free(&e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(events_of_a_step_are_in_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
