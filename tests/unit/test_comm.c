/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Started as it is: one process. test_comm.sh starts the same program on two ranks. */
#include "common/parallel/comm.h"
#include "tests/near.h"

#include <stdlib.h>

static const char *launched(void)
{
    return getenv("OMPI_COMM_WORLD_SIZE");
}

/* test_comm.sh breaks MPI's own settings for one process: a start of MPI would end it here. */
static void start_may_be_repeated(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_comm all;
    (void)state;
    assert_int_equal(brc_comm_of(&ctx)->size, 1);
    assert_int_equal(brc_comm_of(&ctx)->rank, 0);
    CHECK_OK(&ctx, brc_comm_start(&ctx, &all));
    CHECK_OK(&ctx, brc_comm_start(&ctx, &all));
}

static void ranks_are_those_of_the_launcher(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_comm all;
    (void)state;
    CHECK_OK(&ctx, brc_comm_start(&ctx, &all));
    const struct brc_comm *comm = brc_comm_of(&ctx);
    assert_int_equal(comm->size, launched() ? atoi(launched()) : 1);
    assert_in_range(comm->rank, 0, comm->size - 1);
    assert_true(launched() ? comm == &all : comm == &brc_comm_serial);
}

static void sum_is_formed_in_rank_order(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_comm all;
    CHECK_OK(&ctx, brc_comm_start(&ctx, &all));
    const struct brc_comm *comm = brc_comm_of(&ctx);
    int rank = comm->rank, size = comm->size;
    double values[3] = {1 + rank, 0.1 * (rank + 1), rank == 0 ? 1e16 : 1};
    double expected[3] = {size * (size + 1) / 2.0, 0.1, 1e16};
    (void)state;
    for (int other = 1; other < size; other++) {
        expected[1] += 0.1 * (other + 1);
        expected[2] += 1;
    }
    CHECK_OK(&ctx, comm->sum(&ctx, comm, values, 3));
    assert_memory_equal(values, expected, sizeof values);
    CHECK_OK(&ctx, comm->sum(&ctx, comm, NULL, 0));
}

/* MPI cannot start a second time; one process has not started it. */
static void end_is_final_under_a_launcher(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_comm all;
    (void)state;
    brc_comm_end();
    brc_comm_end();
    assert_int_equal(brc_comm_of(&ctx)->size, 1);
    if (launched())
        CHECK_FAILS(&ctx, brc_comm_start(&ctx, &all), BRC_ERR_INTERNAL, "cannot start again");
    else
        CHECK_OK(&ctx, brc_comm_start(&ctx, &all));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(start_may_be_repeated),
        cmocka_unit_test(ranks_are_those_of_the_launcher),
        cmocka_unit_test(sum_is_formed_in_rank_order),
        cmocka_unit_test(end_is_final_under_a_launcher),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
