/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bars, plain lines and time left, as a terminal, a file and a pipe get them. */
#include "common/base/progress.h"
#include "tests/near.h"

#include <stdlib.h>
#include <unistd.h>

static void test_duration(void **state)
{
    (void)state;
    char text[32];
    assert_string_equal(brc_progress_duration(0.4, text, sizeof text), "0:00");
    assert_string_equal(brc_progress_duration(65, text, sizeof text), "1:05");
    assert_string_equal(brc_progress_duration(3599.6, text, sizeof text), "1:00:00");
    assert_string_equal(brc_progress_duration(7384, text, sizeof text), "2:03:04");
}

static size_t drawn(bool quiet, char *text, size_t size)
{
    static const char *const labels[] = {"one", "two"};
    const struct brc_progress_report report = {
        .strain = 0.0123, .stress = 4.5e6, .step = 678, .broken = 9, .is_done = true};
    struct brc_progress p;
    FILE *out = tmpfile();
    assert_non_null(out);
    brc_progress_begin(&p, out, labels, 2, quiet);
    brc_progress_update(&p, 1, &report);
    brc_progress_end(&p);
    rewind(out);
    size_t n = fread(text, 1, size - 1, out);
    text[n] = '\0';
    fclose(out);
    return n;
}

static void test_plain_lines(void **state)
{
    (void)state;
    char text[2000];
    assert_true(drawn(false, text, sizeof text) > 0);
    assert_null(strchr(text, '\033'));
    const char *two = strstr(text, "two ");
    assert_non_null(two);
    assert_non_null(strstr(two, "678"));
    assert_non_null(strstr(two, "strain 1.2300 %"));
    assert_non_null(strstr(two, "4.500 MPa"));
    assert_non_null(strstr(two, "done"));
}

static void test_quiet(void **state)
{
    (void)state;
    char text[2000];
    assert_int_equal(drawn(true, text, sizeof text), 0);
}

static void test_pipe(void **state)
{
    (void)state;
    struct brc_progress p;
    struct brc_progress_report sent = {.step = 12, .strain = 0.5}, got = {0};
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    brc_progress_begin_pipe(&p, ends[1]);
    brc_progress_update(&p, 0, &sent);
    assert_int_equal(read(ends[0], &got, sizeof got), (long)sizeof got);
    assert_memory_equal(&got, &sent, sizeof got);
    close(ends[0]);
    close(ends[1]);
}

/* What stands at the end of the line after some steps, at a pace of a thousand steps in a tenth of
 * a second. */
static void line_after(double steps_left, char *text, size_t size)
{
    static const char *const labels[] = {"one"};
    struct brc_progress_report report = {.step = 5000, .steps_left = steps_left};
    struct brc_progress p;
    FILE *out = tmpfile();
    assert_non_null(out);
    brc_progress_begin(&p, out, labels, 1, false);
    brc_progress_update(&p, 0, &report); /* a resumed run: these steps were made before */
    p.run[0].time_before -= 0.1;
    report.step += 1000;
    brc_progress_update(&p, 0, &report);
    brc_progress_end(&p);
    rewind(out);
    text[fread(text, 1, size - 1, out)] = '\0';
    fclose(out);
}

/* The bound is steps times time a step, not what max_steps or a slow start would allow. */
static void test_time_left(void **state)
{
    (void)state;
    char text[2000];
    line_after(1.2e6, text, sizeof text);
    assert_non_null(strstr(text, "at most 2:0"));
    line_after(NAN, text, sizeof text);
    assert_non_null(strstr(text, "time left unknown"));
}

/* What work before a run says on standard error while half a minute passes. */
static void work_says(bool quiet, bool is_terminal, char *text, size_t size)
{
    struct brc_context ctx = {.quiet = quiet};
    struct brc_work w;
    FILE *out = tmpfile();
    int kept = dup(STDERR_FILENO);
    assert_true(out && kept >= 0 && dup2(fileno(out), STDERR_FILENO) >= 0);
    brc_work_begin(&w, &ctx, "packing");
    w.is_terminal = is_terminal;
    brc_work_update(&w, 0.01); /* at once: too early to say anything */
    w.started -= 30;
    w.last_drawn -= 30;
    brc_work_update(&w, 0.25);
    brc_work_update(&w, 0.26);
    brc_work_end(&w);
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    rewind(out);
    text[fread(text, 1, size - 1, out)] = '\0';
    fclose(out);
}

static void test_work(void **state)
{
    (void)state;
    char text[2000];
    work_says(false, false, text, sizeof text);
    assert_string_equal(text, "packing: 25 %, 0:30\n");
    work_says(true, false, text, sizeof text);
    assert_string_equal(text, "");
    work_says(false, true, text, sizeof text);
    assert_non_null(strstr(text, "[######..................]  0:30"));
    assert_string_equal(text + strlen(text) - 4, "\r\033[K"); /* wiped */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_duration),  cmocka_unit_test(test_plain_lines),
        cmocka_unit_test(test_quiet),     cmocka_unit_test(test_pipe),
        cmocka_unit_test(test_time_left), cmocka_unit_test(test_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
