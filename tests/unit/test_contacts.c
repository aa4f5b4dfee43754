/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/engine/contacts.h"
#include "tests/near.h"

enum { N_BODIES = 40 };

#define MARK_FIELDS(SCALAR, VECTOR)                       \
    SCALAR(double, mark, BRC_STATE, "1", "names the row") \
    VECTOR(double, junk, 3, BRC_SCRATCH, "1", "scratch")
struct marks {
    MARK_FIELDS(BRC_COLUMN, BRC_COLUMN3)
};
#define BRC_OWNER struct marks
static const struct brc_field mark_fields[] = {MARK_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

struct trial {
    struct brc_context ctx;
    struct brc_contacts c;
    int32_t pair[N_BODIES * N_BODIES][2];
    uint64_t random;
};

static int set_up(void **state)
{
    static struct trial t;
    const struct brc_fieldset set = BRC_FIELDSET(mark_fields, struct marks);
    t = (struct trial){.ctx = BRC_CONTEXT_INIT, .random = 12345};
    *state = &t;
    return brc_contacts_create(&t.ctx, &t.c, "pairs", N_BODIES, set, set);
}

static int tear_down(void **state)
{
    struct trial *t = *state;
    brc_contacts_free(&t->c);
    return 0;
}

static uint32_t draw(struct trial *t)
{
    t->random = t->random * UINT64_C(6364136223846793005) + 1442695040888963407;
    return (uint32_t)(t->random >> 33);
}

static struct marks *row_marks(struct trial *t)
{
    return t->c.model_columns;
}

static struct marks *point_marks(struct trial *t)
{
    return t->c.point_columns;
}

/* Keeps about one pair in three of all. */
static void set_random(struct trial *t)
{
    size_t n = 0;
    for (int32_t a = 0; a < N_BODIES; a++)
        for (int32_t b = a + 1; b < N_BODIES; b++)
            if (draw(t) % 3 == 0) {
                t->pair[n][0] = a;
                t->pair[n++][1] = b;
            }
    CHECK_OK(&t->ctx, brc_contacts_set(&t->ctx, &t->c, t->pair, n));
    assert_int_equal(t->c.n, n);
}

static double code_of(const struct brc_contacts *c, size_t i)
{
    return 1 + c->a[i] * N_BODIES + c->b[i];
}

/* Names every row and gives it 0 to 4 points that carry the name. */
static void name_rows(struct trial *t)
{
    for (size_t i = 0; i < t->c.n; i++) {
        int32_t np = (int32_t)(draw(t) % 5);
        CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, i, np));
        row_marks(t)->mark[i] = code_of(&t->c, i);
        t->c.f[i][1] = -code_of(&t->c, i);
        t->c.status[i] = BRC_BROKEN;
        for (int32_t j = 0; j < np; j++)
            point_marks(t)->mark[t->c.p0[i] + j] = code_of(&t->c, i) + 0.1 * j;
    }
}

static void new_rows_are_zero(void **state)
{
    struct trial *t = *state;
    set_random(t);
    for (size_t i = 0; i < t->c.n; i++) {
        assert_int_equal(t->c.facet[i], -1);
        assert_int_equal(t->c.status[i], BRC_OPEN);
        assert_int_equal(t->c.np[i], 0);
        CHECK_NEAR_ARRAY(t->c.f[i], ((double[3]){0, 0, 0}), 3, 0, 0);
        CHECK_NEAR(row_marks(t)->mark[i], 0, 0, 0);
    }
}

static void survivors_keep_state_and_points(void **state)
{
    struct trial *t = *state;
    set_random(t);
    name_rows(t);
    for (int round = 0; round < 20; round++) {
        int64_t version = t->c.k_version;
        set_random(t);
        assert_true(t->c.k_version > version);
        size_t n_kept = 0;
        for (size_t i = 0; i < t->c.n; i++) {
            bool kept = row_marks(t)->mark[i] != 0;
            n_kept += kept;
            CHECK_NEAR(row_marks(t)->mark[i], kept ? code_of(&t->c, i) : 0, 0, 0);
            CHECK_NEAR(t->c.f[i][1], kept ? -code_of(&t->c, i) : 0, 0, 0);
            assert_int_equal(t->c.status[i], kept ? BRC_BROKEN : BRC_OPEN);
            if (!kept)
                assert_int_equal(t->c.np[i], 0);
            for (int32_t j = 0; j < t->c.np[i]; j++)
                CHECK_NEAR(point_marks(t)->mark[t->c.p0[i] + j], code_of(&t->c, i) + 0.1 * j, 0, 0);
        }
        assert_true(n_kept > 0 && n_kept < t->c.n);
        name_rows(t);
    }
}

static void find_agrees_with_search(void **state)
{
    struct trial *t = *state;
    set_random(t);
    for (int32_t a = 0; a < N_BODIES; a++)
        for (int32_t b = a + 1; b < N_BODIES; b++) {
            int64_t expected = -1;
            for (size_t i = 0; i < t->c.n; i++)
                if (t->c.a[i] == a && t->c.b[i] == b)
                    expected = (int64_t)i;
            assert_int_equal(brc_contacts_find(&t->c, a, b), expected);
        }
}

static void adjacency_lists_every_row_of_a_body(void **state)
{
    struct trial *t = *state;
    for (int round = 0; round < 3; round++) {
        set_random(t);
        size_t total = 0;
        for (size_t body = 0; body < N_BODIES; body++) {
            size_t k = t->c.adjacent_first[body];
            for (size_t i = 0; i < t->c.n; i++)
                if (t->c.a[i] == (int32_t)body || t->c.b[i] == (int32_t)body) {
                    uint32_t side = t->c.b[i] == (int32_t)body;
                    assert_int_equal(t->c.adjacent[k++], 2 * i + side);
                }
            assert_int_equal(k, t->c.adjacent_first[body + 1]);
            total += t->c.adjacent_first[body + 1] - t->c.adjacent_first[body];
        }
        assert_int_equal(total, 2 * t->c.n);
    }
}

static void points_grow_and_shrink_in_place(void **state)
{
    struct trial *t = *state;
    const int32_t pair[3][2] = {{0, 1}, {0, 2}, {5, 7}};
    CHECK_OK(&t->ctx, brc_contacts_set(&t->ctx, &t->c, pair, 3));
    name_rows(t);
    CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, 1, 3));
    for (int32_t j = 0; j < 3; j++)
        point_marks(t)->mark[t->c.p0[1] + j] = 10 + j;
    CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, 0, 9)); /* moves on */
    CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, 1, 1));
    CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, 1, 6));
    CHECK_NEAR(point_marks(t)->mark[t->c.p0[1]], 10, 0, 0);
    for (int32_t j = 1; j < 6; j++) /* points dropped before do not come back */
        CHECK_NEAR(point_marks(t)->mark[t->c.p0[1] + j], 0, 0, 0);
    CHECK_OK(&t->ctx, brc_contacts_compact(&t->ctx, &t->c));
    int32_t sum = 0;
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(t->c.p0[i], sum);
        sum += t->c.np[i];
    }
    CHECK_NEAR(point_marks(t)->mark[t->c.p0[1]], 10, 0, 0);
}

static void hash_ignores_where_points_lie(void **state)
{
    struct trial *t = *state;
    set_random(t);
    name_rows(t);
    uint64_t hash = brc_contacts_hash(&t->c, BRC_HASH_SEED);
    for (size_t i = 0; i < t->c.n; i += 3) { /* force ranges apart, then back to the old counts */
        int32_t np = t->c.np[i];
        CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, i, np + 20));
        CHECK_OK(&t->ctx, brc_contacts_points(&t->ctx, &t->c, i, np));
    }
    assert_true(brc_contacts_hash(&t->c, BRC_HASH_SEED) == hash);
    CHECK_OK(&t->ctx, brc_contacts_compact(&t->ctx, &t->c));
    assert_true(brc_contacts_hash(&t->c, BRC_HASH_SEED) == hash);
    row_marks(t)->junk[2][1] = NAN; /* scratch */
    assert_true(brc_contacts_hash(&t->c, BRC_HASH_SEED) == hash);
    size_t with_points = 0;
    while (t->c.np[with_points] == 0)
        with_points++;
    point_marks(t)->mark[t->c.p0[with_points]] += 1;
    assert_true(brc_contacts_hash(&t->c, BRC_HASH_SEED) != hash);
}

static void empty_set_is_valid(void **state)
{
    struct trial *t = *state;
    set_random(t);
    CHECK_OK(&t->ctx, brc_contacts_set(&t->ctx, &t->c, NULL, 0));
    assert_int_equal(t->c.n, 0);
    assert_int_equal(t->c.adjacent_first[N_BODIES], 0);
    assert_int_equal(brc_contacts_find(&t->c, 0, 1), -1);
    brc_contacts_free(&t->c);
    brc_contacts_free(&t->c); /* twice is harmless */
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(new_rows_are_zero),
        TEST(survivors_keep_state_and_points),
        TEST(find_agrees_with_search),
        TEST(adjacency_lists_every_row_of_a_body),
        TEST(points_grow_and_shrink_in_place),
        TEST(hash_ignores_where_points_lie),
        TEST(empty_set_is_valid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
