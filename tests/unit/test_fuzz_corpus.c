/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What fuzzing has found worth keeping, run again: every input of tests/fuzz/corpus, and each cut
 * short. */
#include "tests/fuzz.h"
#include "tests/near.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX_SIZE = 1 << 16, CUTS = 8 };

static void replay_file(const char *path, int (*target)(const uint8_t *, size_t))
{
    static uint8_t bytes[MAX_SIZE];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t n = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    for (size_t k = 0; k < CUTS; k++) {
        size_t part = n - n * k / CUTS;
        uint8_t *copy = malloc(part + 1); /* of its own size, for the sanitizers */
        assert_non_null(copy);
        memcpy(copy, bytes, part);
        target(copy, part);
        free(copy);
    }
}

static void replay(const char *folder, int (*target)(const uint8_t *, size_t))
{
    char path[512];
    int n = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));) {
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        replay_file(path, target);
        n++;
    }
    closedir(dir);
    assert_true(n > 0);
    print_message("%s: %d inputs\n", folder, n);
}

static void test_case(void **state)
{
    (void)state;
    replay("tests/fuzz/corpus/case", fuzz_case);
}

static void test_state(void **state)
{
    (void)state;
    replay("tests/fuzz/corpus/state", fuzz_state);
}

static void test_numbers(void **state)
{
    (void)state;
    replay("tests/fuzz/corpus/numbers", fuzz_numbers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_case), cmocka_unit_test(test_state),
                                       cmocka_unit_test(test_numbers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
