/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Started as it is: one process. test_comm.sh starts the same program on two ranks. */
#include "common/comm.h"
#include "tests/near.h"

#include <stdlib.h>
#include <time.h>

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void start_is_quick_and_may_be_repeated(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    (void)state;
    assert_int_equal(brc_comm_size(), 1);
    assert_int_equal(brc_comm_rank(), 0);
    double begin = seconds();
    CHECK_OK(&ctx, brc_comm_start(&ctx));
    double took = seconds() - begin;
    CHECK_OK(&ctx, brc_comm_start(&ctx));
    /* 0.03 s on an idle core, 0.35 s with the daemon of a singleton; several ranks take what the
     * launcher takes. The bound leaves room for a busy machine. */
    if (getenv("OMPI_COMM_WORLD_SIZE") == NULL)
        CHECK_BETWEEN(took, 0, 2.0);
}

static void ranks_are_those_of_the_launcher(void **state)
{
    const char *launched = getenv("OMPI_COMM_WORLD_SIZE");
    (void)state;
    assert_int_equal(brc_comm_size(), launched ? atoi(launched) : 1);
    assert_in_range(brc_comm_rank(), 0, brc_comm_size() - 1);
}

static void sum_is_formed_in_rank_order(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    int rank = brc_comm_rank(), size = brc_comm_size();
    double values[3] = {1 + rank, 0.1 * (rank + 1), rank == 0 ? 1e16 : 1};
    double expected[3] = {size * (size + 1) / 2.0, 0.1, 1e16};
    (void)state;
    for (int other = 1; other < size; other++) {
        expected[1] += 0.1 * (other + 1);
        expected[2] += 1;
    }
    CHECK_OK(&ctx, brc_comm_sum(&ctx, values, 3));
    assert_memory_equal(values, expected, sizeof values);
    CHECK_OK(&ctx, brc_comm_sum(&ctx, NULL, 0));
}

static void end_is_final(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    (void)state;
    brc_comm_end();
    brc_comm_end();
    assert_int_equal(brc_comm_size(), 1);
    CHECK_FAILS(&ctx, brc_comm_start(&ctx), BRC_ERR_INTERNAL, "cannot start again");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(start_is_quick_and_may_be_repeated),
        cmocka_unit_test(ranks_are_those_of_the_launcher),
        cmocka_unit_test(sum_is_formed_in_rank_order),
        cmocka_unit_test(end_is_final),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
