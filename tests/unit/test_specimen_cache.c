/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cache of packings on disk. */
#include "tests/specimens.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Name of the only file in the cache folder. */
static void find_cache_file(char path[512])
{
    DIR *dir = opendir(specimens_folder);
    struct dirent *entry;
    int n = 0;
    assert_non_null(dir);
    while ((entry = readdir(dir)) != NULL)
        if (entry->d_name[0] != '.') {
            snprintf(path, 512, "%s/%s", specimens_folder, entry->d_name);
            n++;
        }
    closedir(dir);
    assert_int_equal(n, 1);
}

/* Through the cache the bits are the same; a damaged file is made anew, and the lack of a
 * folder does no harm. */
static void test_cache(void **state)
{
    (void)state;
    char path[512];
    struct stat info;
    struct brc_specimen_params p =
        PARAMS("diameter", "30 mm", "height", "20 mm", "count", "120", "cache", "on");
    struct brc_specimen s;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    uint64_t first = specimens_hash(&s);
    brc_specimen_free(&s);
    find_cache_file(path);
    for (int damage = 0; damage < 4; damage++) {
        assert_int_equal(stat(path, &info), 0);
        if (damage == 1)
            assert_int_equal(truncate(path, info.st_size - 8), 0);
        if (damage == 2)
            assert_int_equal(truncate(path, 0), 0);
        if (damage == 3) {
            FILE *file = fopen(path, "r+b");
            assert_non_null(file);
            fseek(file, info.st_size / 2, SEEK_SET);
            fputs("damage", file);
            fclose(file);
        }
        CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
        assert_int_equal(specimens_hash(&s), first);
        brc_specimen_free(&s);
        find_cache_file(path);
    }
    p.cache = 0;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    assert_int_equal(specimens_hash(&s), first);
    brc_specimen_free(&s);
    p.cache = 1;
    p.seed = 5;
    setenv("BRECCIA_CACHE", "/proc/no/such/folder", 1);
    specimens_ctx.quiet = 1;
    CHECK_OK(&specimens_ctx, brc_specimen_create(&specimens_ctx, &p, &s));
    specimens_ctx.quiet = 0;
    assert_int_not_equal(specimens_hash(&s), first);
    setenv("BRECCIA_CACHE", specimens_folder, 1);
    brc_specimen_free(&s);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cache),
    };
    return cmocka_run_group_tests(tests, specimens_set_up, specimens_tear_down);
}
