/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The folder of a run: what may be written there. Nothing that the run did not write is replaced or
 * removed without --force, and an input never. */
#include "common/runs/run.h"

#include "common/output/frames.h"
#include "common/base/input_file.h"
#include "common/base/text_file.h"
#include "common/runs/case_files.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a run writes beside case.yaml, log and frames. */
static const char *const result_files[] = {
    "summary.json", "state.h5",   "curve.csv", "events.csv",  "broken.csv", "curves.png",
    "curves.gp",    "cracks.png", "cracks.gp", "cracks.plot", "gnuplot.log"};
enum { N_RESULT_FILES = sizeof result_files / sizeof result_files[0] };

/* NULL when it is not there, or is not a plain file. */
static FILE *open_plain(const char *path)
{
    const struct brc_input in = {.path = path, .largest = SIZE_MAX, .is_plain = true};
    struct brc_context quiet = BRC_CONTEXT_INIT;
    FILE *file;
    return brc_input_open(&quiet, &in, &file, NULL) == 0 ? file : NULL;
}

/* A run's log begins with the program's name; a run that was ended before its first line has left
 * an empty one, which is worth nothing to anyone. */
static bool read_log(const char *dir, bool *is_empty)
{
    char path[BRC_PATH_SIZE], begin[sizeof "breccia "] = "";
    FILE *log =
        snprintf(path, sizeof path, "%s/log", dir) < BRC_PATH_SIZE ? open_plain(path) : NULL;
    size_t n = log ? fread(begin, 1, sizeof begin - 1, log) : 0;
    if (log)
        fclose(log);
    *is_empty = n == 0;
    return log && (n == 0 || strcmp(begin, "breccia ") == 0);
}

bool brc_run_has_begun(const char *dir)
{
    bool is_empty;
    return read_log(dir, &is_empty);
}

/* ---- what is in the way -------------------------------------------------------------------- */

static int fail_occupied(struct brc_context *ctx, const char *dir, const char *name)
{
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "%s already holds results (%s); go on with --resume, replace them with --force, or "
             "choose another folder with -o",
             dir, name);
}

static int check_absent(struct brc_context *ctx, const char *dir, const char *name)
{
    char part[256];
    snprintf(part, sizeof part, "%s.part", name);
    if (brc_folder_has(dir, name))
        return fail_occupied(ctx, dir, name);
    return brc_folder_has(dir, part) ? fail_occupied(ctx, dir, part) : 0;
}

static int check_input(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                       const char *name)
{
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, dir, name, path));
    if (brc_case_is_input(run_case, path))
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "%s is an input of this run, which would replace it; choose another folder with -o",
            path);
    return 0;
}

int brc_run_check_own(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                      const char *const *names, int n, bool may_replace)
{
    for (int i = 0; i < n; i++) {
        BRC_TRY(check_input(ctx, dir, run_case, names[i]));
        if (!may_replace)
            BRC_TRY(check_absent(ctx, dir, names[i]));
    }
    return 0;
}

static int check_new(struct brc_context *ctx, const char *dir)
{
    char frame[256];
    bool is_empty;
    BRC_TRY(check_absent(ctx, dir, "case.yaml"));
    read_log(dir, &is_empty);
    if (brc_folder_has(dir, "log") && !is_empty)
        return fail_occupied(ctx, dir, "log");
    return brc_frames_find(dir, frame, sizeof frame) ? fail_occupied(ctx, dir, frame) : 0;
}

/* A run that was ended before it has saved a state has no results but frames, and starts anew;
 * where there are results, their state is lost. */
static int check_resumed(struct brc_context *ctx, const char *dir)
{
    if (!brc_run_has_begun(dir))
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s holds no run to resume; leave out --resume", dir);
    for (int i = 0; i < N_RESULT_FILES && !brc_folder_has(dir, "state.h5"); i++)
        if (brc_folder_has(dir, result_files[i]))
            BRC_FAIL(
                ctx, BRC_ERR_INPUT,
                "%s holds results (%s) but no state.h5 to go on from; start anew with --force, "
                "or choose another folder with -o",
                dir, result_files[i]);
    return 0;
}

/* The kept case may be the one that is read: it is judged when it is written. */
int brc_run_check_folder(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                         bool is_resumed, bool is_forced)
{
    BRC_TRY(brc_folder_check_writable(ctx, dir));
    BRC_TRY(check_input(ctx, dir, run_case, "log"));
    BRC_TRY(brc_run_check_own(ctx, dir, run_case, result_files, N_RESULT_FILES,
                              is_resumed || is_forced));
    if (is_resumed)
        return check_resumed(ctx, dir);
    return is_forced ? 0 : check_new(ctx, dir);
}

/* ---- writing ------------------------------------------------------------------------------- */

/* True when the file holds just this text. */
static bool holds(const char *path, const char *text)
{
    FILE *file = open_plain(path);
    size_t n = strlen(text);
    char *found = file ? malloc(n + 1) : NULL;
    bool is_same = found && fread(found, 1, n + 1, file) == n && memcmp(found, text, n) == 0;
    free(found);
    if (file)
        fclose(file);
    return is_same;
}

uint64_t brc_run_case_digest(const char *text)
{
    return brc_hash_bytes(text, strlen(text), BRC_HASH_SEED);
}

/* The log tells the digest of each case that the run has kept, before it is written. */
static bool is_in_log(const char *dir, const char *path)
{
    char log[BRC_PATH_SIZE], line[1024], digest[32];
    char *text = NULL;
    size_t size = 0;
    bool is_found = false;
    FILE *file = open_plain(path);
    if (!file || getdelim(&text, &size, '\0', file) < 0)
        snprintf(digest, sizeof digest, "no digest");
    else
        snprintf(digest, sizeof digest, "digest %016" PRIx64, brc_run_case_digest(text));
    free(text);
    if (file)
        fclose(file);
    file = snprintf(log, sizeof log, "%s/log", dir) < BRC_PATH_SIZE ? open_plain(log) : NULL;
    while (file && !is_found && fgets(line, sizeof line, file))
        is_found = strncmp(line, "case.yaml: ", 11) == 0 && strstr(line, digest);
    if (file)
        fclose(file);
    return is_found;
}

int brc_run_check_case(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                       const char *text, bool is_resumed)
{
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, dir, "case.yaml", path));
    if (holds(path, text) || (is_resumed && is_in_log(dir, path)))
        return 0;
    if (brc_case_is_input(run_case, path))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s is the case that is read, and the options of this run would change it; choose "
                 "another folder with -o",
                 path);
    if (is_resumed && brc_folder_has(dir, "case.yaml"))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s is not the case that the run has kept there; move it away, then resume", path);
    return 0;
}

int brc_run_keep_case(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                      const char *text, bool is_new)
{
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, dir, "case.yaml", path));
    bool may_stay = !is_new || brc_case_is_input(run_case, path);
    return may_stay && holds(path, text) ? 0 : brc_text_file_write(ctx, NULL, path, text);
}

int brc_run_open(struct brc_context *ctx, const char *dir, const char *name, FILE **file)
{
    char path[BRC_PATH_SIZE];
    struct stat status;
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    *file = NULL;
    BRC_TRY(brc_folder_path(ctx, dir, name, path));
    *file = fopen(path, "a+");
    if (!*file)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", path, strerror(errno));
    if (fstat(fileno(*file), &status) != 0 || !S_ISREG(status.st_mode))
        BRC_FAIL(ctx, BRC_ERR_IO, "%s is not a plain file; choose another folder with -o", path);
    if (fcntl(fileno(*file), F_SETLK, &lock) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "another run writes to %s now; choose another folder with -o",
                 dir);
    return 0;
}

int brc_run_remove_results(struct brc_context *ctx, const char *dir)
{
    for (int i = 0; i < N_RESULT_FILES; i++)
        BRC_TRY(brc_folder_remove(ctx, dir, result_files[i]));
    return brc_frames_sweep(ctx, NULL, dir);
}

int brc_run_remove(struct brc_context *ctx, const char *dir)
{
    BRC_TRY(brc_run_remove_results(ctx, dir));
    BRC_TRY(brc_folder_remove(ctx, dir, "case.yaml"));
    BRC_TRY(brc_folder_remove(ctx, dir, "log"));
    rmdir(dir); /* stays when it holds what is not the run's */
    return 0;
}
