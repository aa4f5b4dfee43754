/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Damaged files: whatever bytes of a state, a frame or a tessellation have been changed, cut or
 * put in between, reading ends in a message (a tessellation may still be a good one). `make check`
 * does it some hundred times a kind, under the sanitizers it is thousands; DAMAGE_N sets the number
 * and DAMAGE_SEED the changes. */
#include "common/output/frames.h"
#include "common/output/info.h"
#include "common/output/io_h5.h"
#include "common/specimen/neper.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* A file as it was written, and one that is damaged over and over. */
struct target {
    char *bytes;
    size_t n;
    char path[128];
};

static int n_damages(void)
{
    const char *n = getenv("DAMAGE_N"), *cfg = getenv("CFG");
    return n ? atoi(n) : cfg && strcmp(cfg, "san") == 0 ? 4000 : 400;
}

static void take_file(struct target *t, const char *path)
{
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    fseek(in, 0, SEEK_END);
    t->n = (size_t)ftell(in);
    rewind(in);
    t->bytes = malloc(t->n + 1);
    assert_non_null(t->bytes);
    assert_int_equal(fread(t->bytes, 1, t->n, in), t->n);
    fclose(in);
    snprintf(t->path, sizeof t->path, "%s.damaged", path);
}

static void drop_file(struct target *t)
{
    unlink(t->path);
    free(t->bytes);
}

static size_t pick(struct fixture *f, size_t n)
{
    return (size_t)(0.5 * (fixture_draw(f) + 1) * (double)n) % n;
}

/* Writes the file with one kind of damage. Text is changed to text, so that it reaches beyond the
 * first check. */
static void write_damaged(struct fixture *f, const struct target *t, bool is_text)
{
    static const char texts[] = "0123456789-+. \n*e";
    size_t at = pick(f, t->n), n = t->n, kind = pick(f, 8);
    char *bytes = malloc(t->n);
    assert_non_null(bytes);
    memcpy(bytes, t->bytes, t->n);
    for (size_t k = 0; k < (kind < 4 ? 1 : pick(f, 8) + 1) && kind < 7; k++) {
        char old = bytes[at];
        while (bytes[at] == old)
            bytes[at] = is_text ? texts[pick(f, sizeof texts - 1)] : (char)pick(f, 256);
        at = kind < 6 ? pick(f, t->n) : (at + 1) % t->n;
    }
    if (kind == 7)
        n = at;
    FILE *out = fopen(t->path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, n, out), n);
    assert_int_equal(fclose(out), 0);
    free(bytes);
}

/* Damages the file over and over; each time reading it must fail with a message, or may do well. */
static void damage(struct fixture *f, struct target *t, bool is_text,
                   int (*read_it)(struct fixture *f, const char *path))
{
    const char *seed = getenv("DAMAGE_SEED");
    f->random = seed ? strtoull(seed, NULL, 10) : 27;
    int n = n_damages(), n_good = 0;
    for (int i = 0; i < n; i++) {
        write_damaged(f, t, is_text);
        int code = read_it(f, t->path);
        assert_true(code != 0 ? *f->ctx.message != '\0' : is_text);
        n_good += code == 0;
        brc_error_clear(&f->ctx);
    }
    assert_true(n_good < n);
}

static int inform(struct fixture *f, const char *path)
{
    FILE *out = fopen("/dev/null", "w");
    int code = brc_info_print(&f->ctx, out, path);
    fclose(out);
    return code;
}

static const struct brc_h5_text texts[] = {{"case", "title: x\n"}, {"seed", "1"}};
static const struct brc_h5_extra extra = {texts, 2, NULL, 0};

static int load(struct fixture *f, const char *path)
{
    char *text;
    int code = brc_h5_load(&f->ctx, path, &f->sim, &extra);
    int other = brc_h5_read_text(&f->ctx, path, "case", &text);
    free(text);
    assert_int_equal(code, other);
    return code;
}

static void make_sim(struct fixture *f)
{
    fixture_grid(f, 3, 3, 2, 0.01, 0.5);
    fixture_sim(f, &brc_model_null, "", "", "");
    fixture_steps(f, 3);
}

static void test_state(void **state)
{
    struct fixture *f = *state;
    struct target t;
    char path[64];
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-damage.h5", (long)getpid());
    make_sim(f);
    CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, path, &f->sim, &extra));
    CHECK_OK(&f->ctx, load(f, path));
    CHECK_OK(&f->ctx, inform(f, path));
    take_file(&t, path);
    damage(f, &t, false, load);
    damage(f, &t, false, inform);
    drop_file(&t);
    unlink(path);
}

static void test_frame(void **state)
{
    struct fixture *f = *state;
    struct brc_frames frames;
    char dir[64], path[100];
    snprintf(dir, sizeof dir, "/tmp/breccia-test-%ld-damage", (long)getpid());
    snprintf(path, sizeof path, "mkdir %s", dir);
    assert_int_equal(system(path), 0);
    make_sim(f);
    brc_frames_init(&frames);
    CHECK_OK(&f->ctx, brc_frames_write(&f->ctx, &frames, dir, &f->sim, &extra));
    static const char *const kind[] = {"grains", "bonds", "contacts"};
    for (int k = 0; k < 3; k++) {
        struct target t;
        snprintf(path, sizeof path, "%s/frames/%s_%05d.hdf", dir, kind[k], (int)f->sim.step);
        CHECK_OK(&f->ctx, inform(f, path));
        take_file(&t, path);
        damage(f, &t, false, inform);
        drop_file(&t);
    }
    brc_frames_free(&frames);
    snprintf(path, sizeof path, "rm -r %s", dir);
    assert_int_equal(system(path), 0);
}

static int read_tess(struct fixture *f, const char *path)
{
    struct brc_convex domain = {0};
    struct brc_facets facets = {0};
    int code = brc_neper_read(&f->ctx, path, 1, true, &domain, &facets);
    brc_convex_free(&domain);
    brc_facets_free(&facets);
    return code;
}

static void test_tess(void **state)
{
    struct fixture *f = *state;
    struct target t;
    char path[64];
    snprintf(path, sizeof path, "/tmp/breccia-test-%ld-damage.tess", (long)getpid());
    fixture_grid(f, 2, 2, 2, 0.01, 0.5);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    CHECK_OK(&f->ctx, brc_neper_write(&f->ctx, out, &f->specimen));
    fclose(out);
    CHECK_OK(&f->ctx, read_tess(f, path));
    take_file(&t, path);
    damage(f, &t, true, read_tess);
    drop_file(&t);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(test_state), FIXTURE_TEST(test_frame),
                                       FIXTURE_TEST(test_tess)};
    return cmocka_run_group_tests_name("damage", tests, NULL, NULL);
}
