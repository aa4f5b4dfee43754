/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of every type: rows keep their values through growth and reordering, and the hash sees
 * each bit of the state and nothing else. */
#include "common/base/table.h"
#include "tests/near.h"

#define THING_FIELDS(SCALAR, VECTOR)                        \
    SCALAR(double, mass, BRC_STATE, "kg", "mass")           \
    VECTOR(double, x, 3, BRC_STATE, "m", "place")           \
    SCALAR(uint8_t, kind, BRC_STATE, "1", "kind")           \
    VECTOR(int32_t, pair, 2, BRC_STATE, "1", "two numbers") \
    SCALAR(int64_t, id, BRC_STATE, "1", "stable number")    \
    SCALAR(double, work, BRC_SCRATCH, "J", "derived at each step")
struct things {
    THING_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};
#define BRC_OWNER struct things
static const struct brc_field thing_fields[] = {THING_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

struct fixture_table {
    struct brc_context ctx;
    struct things things;
    struct brc_table table;
};

static int set_up(void **state)
{
    static struct fixture_table f;
    f = (struct fixture_table){.ctx = BRC_CONTEXT_INIT};
    brc_table_init(&f.table, "things",
                   (struct brc_fieldset)BRC_FIELDSET(thing_fields, struct things), &f.things);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture_table *f = *state;
    brc_table_free(&f->table);
    return 0;
}

static void fill(struct fixture_table *f, size_t n)
{
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, n));
    for (size_t i = 0; i < n; i++) {
        f->things.mass[i] = 1 + (double)i;
        f->things.x[i][2] = -(double)i;
        f->things.kind[i] = (uint8_t)(i % 7);
        f->things.pair[i][1] = (int32_t)i * 3;
        f->things.id[i] = INT64_C(1) << 40 | (int64_t)i;
        f->things.work[i] = 0.5;
    }
}

static void list_describes_the_struct(void **state)
{
    (void)state;
    assert_int_equal(sizeof thing_fields / sizeof thing_fields[0], 6);
    assert_string_equal(thing_fields[1].name, "x");
    assert_string_equal(thing_fields[1].unit, "m");
    assert_int_equal(thing_fields[1].width, 3);
    assert_int_equal(thing_fields[2].type, BRC_U8);
    assert_int_equal(thing_fields[3].type, BRC_I32);
    assert_int_equal(thing_fields[4].type, BRC_I64);
    assert_int_equal(thing_fields[5].offset, offsetof(struct things, work));
    assert_int_equal(brc_field_size(&thing_fields[1]), 24);
    assert_int_equal(brc_field_size(&thing_fields[3]), 8);
}

static void growing_keeps_rows_and_zeroes_new_ones(void **state)
{
    struct fixture_table *f = *state;
    fill(f, 5);
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 1000));
    assert_int_equal(f->table.n, 1000);
    for (size_t i = 0; i < 5; i++) {
        CHECK_NEAR(f->things.mass[i], 1 + (double)i, 0, 0);
        assert_int_equal(f->things.id[i], INT64_C(1) << 40 | (int64_t)i);
    }
    for (size_t i = 5; i < 1000; i++) {
        CHECK_NEAR(f->things.mass[i], 0, 0, 0);
        assert_int_equal(f->things.pair[i][1], 0);
    }
    assert_int_equal((uintptr_t)f->things.x % 64, 0);
}

static void shrunk_rows_come_back_as_zero(void **state)
{
    struct fixture_table *f = *state;
    fill(f, 12);
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 3));
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 12));
    CHECK_NEAR(f->things.mass[2], 3, 0, 0);
    CHECK_NEAR(f->things.mass[3], 0, 0, 0);
    CHECK_NEAR(f->things.x[11][2], 0, 0, 0);
    fill(f, 12);
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 3));
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 5));
    CHECK_NEAR(f->things.mass[7], 0, 0, 0); /* room up to a multiple of four */
}

static void gather_takes_the_rows_asked_for(void **state)
{
    struct fixture_table *f = *state;
    const size_t from[5] = {4, BRC_NEW_ROW, 0, 4, 2};
    fill(f, 5);
    CHECK_OK(&f->ctx, brc_table_gather(&f->ctx, &f->table, from, 5));
    CHECK_NEAR_ARRAY(f->things.mass, ((double[5]){5, 0, 1, 5, 3}), 5, 0, 0);
    assert_int_equal(f->things.pair[4][1], 6);
    assert_int_equal(f->things.kind[1], 0);
    CHECK_OK(&f->ctx, brc_table_gather(&f->ctx, &f->table, from, 0));
    assert_int_equal(f->table.n, 0);
}

/* Rows that keep their order move within their columns: any mix of rows that go and rows that come.
 */
static void gather_in_order_moves_in_place(void **state)
{
    struct fixture_table *f = *state;
    unsigned seed = 1;
    for (int trial = 0; trial < 200; trial++) {
        size_t from[64], n = 0, next = 0;
        fill(f, 30);
        CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 64));
        CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 30));
        const void *before = f->things.mass;
        while (next < 30 && n < 64) {
            unsigned pick = (seed = seed * 1103515245 + 12345) >> 16 & 3;
            next += pick == 0;
            from[n++] = pick == 1 || next >= 30 ? BRC_NEW_ROW : next++;
        }
        CHECK_OK(&f->ctx, brc_table_gather(&f->ctx, &f->table, from, n));
        assert_ptr_equal(before, f->things.mass);
        assert_int_equal(f->table.n, n);
        for (size_t i = 0; i < n; i++) {
            CHECK_NEAR(f->things.mass[i], from[i] == BRC_NEW_ROW ? 0 : 1 + (double)from[i], 0, 0);
            assert_int_equal(f->things.pair[i][1], from[i] == BRC_NEW_ROW ? 0 : 3 * from[i]);
        }
    }
}

static void hash_sees_state_and_only_state(void **state)
{
    struct fixture_table *f = *state;
    fill(f, 9);
    uint64_t hash = brc_table_hash(&f->table, BRC_HASH_SEED);
    f->things.work[3] = NAN;
    assert_true(brc_table_hash(&f->table, BRC_HASH_SEED) == hash);
    f->things.kind[8] ^= 1; /* the last byte of a column that fills no whole word */
    assert_true(brc_table_hash(&f->table, BRC_HASH_SEED) != hash);
    f->things.kind[8] ^= 1;
    f->things.x[4][1] = -0.0; /* bits, not values */
    assert_true(brc_table_hash(&f->table, BRC_HASH_SEED) != hash);
    f->things.x[4][1] = 0;
    assert_true(brc_table_hash(&f->table, BRC_HASH_SEED) == hash);
    assert_true(brc_table_hash(&f->table, hash) != hash);
    CHECK_OK(&f->ctx, brc_table_resize(&f->ctx, &f->table, 10));
    assert_true(brc_table_hash(&f->table, BRC_HASH_SEED) != hash);
}

static void hash_does_not_confuse_swapped_rows(void **state)
{
    struct fixture_table *f = *state;
    const size_t from[2] = {1, 0};
    fill(f, 2);
    uint64_t hash = brc_table_hash(&f->table, BRC_HASH_SEED);
    CHECK_OK(&f->ctx, brc_table_gather(&f->ctx, &f->table, from, 2));
    assert_true(brc_table_hash(&f->table, BRC_HASH_SEED) != hash);
}

static void too_large_is_an_error(void **state)
{
    struct fixture_table *f = *state;
    fill(f, 3);
    /* 2^61 doubles are 2^64 bytes: a product that wraps to 0 */
    for (int bits = 59; bits < 64; bits++)
        CHECK_FAILS(&f->ctx, brc_table_resize(&f->ctx, &f->table, (size_t)1 << bits),
                    BRC_ERR_MEMORY, "memory");
    CHECK_NEAR(f->things.mass[2], 3, 0, 0); /* the old rows stand */
    assert_int_equal(f->table.n, 3);
}

static void no_fields_is_a_table_too(void **state)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_table t;
    (void)state;
    brc_table_init(&t, "nothing", (struct brc_fieldset){0}, NULL);
    CHECK_OK(&ctx, brc_table_resize(&ctx, &t, 20));
    assert_int_equal(t.n, 20);
    CHECK_OK(&ctx, brc_table_gather(&ctx, &t, (size_t[2]){3, BRC_NEW_ROW}, 2));
    brc_table_free(&t);
    brc_table_free(&t);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(list_describes_the_struct),          TEST(growing_keeps_rows_and_zeroes_new_ones),
        TEST(shrunk_rows_come_back_as_zero),      TEST(gather_takes_the_rows_asked_for),
        TEST(gather_in_order_moves_in_place),     TEST(hash_sees_state_and_only_state),
        TEST(hash_does_not_confuse_swapped_rows), TEST(too_large_is_an_error),
        TEST(no_fields_is_a_table_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
