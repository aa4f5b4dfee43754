/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The folder of a run: what may be written there. Nothing that the run did not write is replaced or
 * removed without --force, and an input never. Called by run, compare and converge before they make
 * anything; it knows names of files, not what they hold, but for the log and the kept case. */
#include "common/runs/run.h"

#include "common/output/frames.h"
#include "common/base/input_file.h"
#include "common/base/text_file.h"
#include "common/runs/case_files.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a run writes beside case.yaml, log and frames. A name that is missing here would be left
 * behind by --force, and mixed with the results of the new run. */
static const char *const result_files[] = {
    "summary.json",     "state.h5",      "curve.csv",  "profile.csv",
    "events.csv",       "broken.csv",    "curves.png", "events_clustered.csv",
    "crack_angles.csv", "fragments.csv", "curves.gp",  "cracks.png",
    "cracks.gp",        "cracks.plot",   "gnuplot.log"};
enum { N_RESULT_FILES = sizeof result_files / sizeof result_files[0] };

/* The text of a file of the folder, to be freed, and its size, since a file that begins with a
 * byte 0 is not empty. NULL when it is not there, or is not a plain file: whatever else has this
 * name is not a run's. */
static char *read_plain(const char *dir, const char *name, size_t *n)
{
    char path[BRC_PATH_SIZE], *text = NULL;
    const struct brc_input in = {.path = path, .largest = BRC_INPUT_LARGEST, .is_plain = true};
    struct brc_context quiet = BRC_CONTEXT_INIT;
    if (brc_folder_path(&quiet, dir, name, path) != 0 || brc_input_read(&quiet, &in, &text, n) != 0)
        return NULL;
    return text;
}

/* A run's log begins with the program's name; a run that was ended before its first line has left
 * an empty one, which is worth nothing to anyone. */
static bool read_log(const char *dir, bool *is_empty)
{
    size_t n = 0;
    char *log = read_plain(dir, "log", &n);
    *is_empty = n == 0;
    bool is_ours = log && (n == 0 || strncmp(log, "breccia ", 8) == 0);
    free(log);
    return is_ours;
}

bool brc_run_has_begun(const char *dir)
{
    bool is_empty;
    return read_log(dir, &is_empty);
}

/* ---- what is in the way -------------------------------------------------------------------- */

/* One message for all that may be in the way: what to do is the same, and which file it was may
 * tell the user that the folder is another one than he thinks. */
static int fail_occupied(struct brc_context *ctx, const char *dir, const char *name)
{
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "%s already holds results (%s); go on with --resume, replace them with --force, or "
             "choose another folder with -o",
             dir, name);
}

/* The beginning of a file (.part) counts, too: it is left by a run that was killed, or belongs to
 * one that writes now. */
static int check_absent(struct brc_context *ctx, const char *dir, const char *name)
{
    char part[256];
    snprintf(part, sizeof part, "%s.part", name);
    if (brc_folder_has(dir, name))
        return fail_occupied(ctx, dir, name);
    return brc_folder_has(dir, part) ? fail_occupied(ctx, dir, part) : 0;
}

/* By device and inode, so that links and .. do not hide it. */
static int check_input(struct brc_context *ctx, const struct brc_run_options *o, const char *name)
{
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, o->dir, name, path));
    if (brc_case_is_input(o->run_case, path))
        BRC_FAIL(
            ctx, BRC_ERR_INPUT,
            "%s is an input of this run, which would replace it; choose another folder with -o",
            path);
    return 0;
}

/* Inputs first, since they are refused whatever is allowed. */
int brc_run_check_own(struct brc_context *ctx, const struct brc_run_options *o,
                      const char *const *names, int n, bool may_replace)
{
    for (int i = 0; i < n; i++) {
        BRC_TRY(check_input(ctx, o, names[i]));
        if (!may_replace)
            BRC_TRY(check_absent(ctx, o->dir, names[i]));
    }
    return 0;
}

/* An empty log is no result: a run that was ended before its first line has left it. */
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
 * where there are results, their state is lost, and to start anew would replace them unasked. */
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
int brc_run_check_folder(struct brc_context *ctx, const struct brc_run_options *o)
{
    BRC_TRY(brc_folder_check_writable(ctx, o->dir));
    BRC_TRY(check_input(ctx, o, "log"));
    BRC_TRY(brc_run_check_own(ctx, o, result_files, N_RESULT_FILES, o->is_resumed || o->is_forced));
    if (o->is_resumed)
        return check_resumed(ctx, o->dir);
    return o->is_forced ? 0 : check_new(ctx, o->dir);
}

/* ---- writing ------------------------------------------------------------------------------- */

uint64_t brc_run_case_digest(const char *text)
{
    return brc_hash_bytes(text, strlen(text), BRC_HASH_SEED);
}

/* The kept case is just this text. */
static bool is_kept(const char *dir, const char *text)
{
    size_t n;
    char *found = read_plain(dir, "case.yaml", &n);
    bool is_same = found && n == strlen(text) && memcmp(found, text, n) == 0;
    free(found);
    return is_same;
}

/* The log tells the digest of each case that the run has kept, before it is written. So a user's
 * own file of that name is told from the run's, even where the program was ended between the two.
 */
static bool is_in_log(const char *dir)
{
    size_t n;
    char *kept = read_plain(dir, "case.yaml", &n), *log = read_plain(dir, "log", &n), line[64];
    snprintf(line, sizeof line, "\ncase.yaml: digest %016" PRIx64 "\n",
             kept ? brc_run_case_digest(kept) : 0);
    bool is_found = kept && log && strstr(log, line);
    free(kept);
    free(log);
    return is_found;
}

/* A case that stands there as it would be written needs no leave: to write the same bytes changes
 * nothing, even where it is the file that is read. */
int brc_run_check_case(struct brc_context *ctx, const char *dir, const struct brc_case *run_case,
                       const char *text, bool is_resumed)
{
    char path[BRC_PATH_SIZE];
    BRC_TRY(brc_folder_path(ctx, dir, "case.yaml", path));
    if (is_kept(dir, text) || (is_resumed && is_in_log(dir)))
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
    return may_stay && is_kept(dir, text) ? 0 : brc_text_file_write(ctx, NULL, path, text);
}

/* A lock of the file rather than a file that says "locked": it ends with the process, however that
 * ends. Not one of fcntl, which is lost as soon as the process closes the same file anywhere else,
 * as it does when it reads its log. */
int brc_run_open(struct brc_context *ctx, const char *dir, const char *name, FILE **file)
{
    char path[BRC_PATH_SIZE];
    struct stat status;
    *file = NULL;
    BRC_TRY(brc_folder_path(ctx, dir, name, path));
    *file = fopen(path, "a+");
    if (!*file)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", path, strerror(errno));
    if (fstat(fileno(*file), &status) != 0 || !S_ISREG(status.st_mode))
        BRC_FAIL(ctx, BRC_ERR_IO, "%s is not a plain file; choose another folder with -o", path);
    if (flock(fileno(*file), LOCK_EX | LOCK_NB) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "another run writes to %s now; choose another folder with -o",
                 dir);
    return 0;
}

int brc_run_check_open(struct brc_context *ctx, FILE *file, const char *path)
{
    struct stat opened, there;
    if (fstat(fileno(file), &opened) == 0 && stat(path, &there) == 0 &&
        opened.st_dev == there.st_dev && opened.st_ino == there.st_ino)
        return 0;
    BRC_FAIL(ctx, BRC_ERR_IO,
             "%s was removed or replaced while runs were added to it, as git does on a change of "
             "branch; call again, and what it lacks is done",
             path);
}

/* The case and the log stay: the one has taken its place already, and the other is locked. */
int brc_run_remove_results(struct brc_context *ctx, const char *dir)
{
    for (int i = 0; i < N_RESULT_FILES; i++)
        BRC_TRY(brc_folder_remove(ctx, dir, result_files[i]));
    return brc_frames_sweep(ctx, NULL, dir);
}

/* By name, one after the other: a folder may hold what is the user's own. */
int brc_run_remove(struct brc_context *ctx, const char *dir)
{
    BRC_TRY(brc_run_remove_results(ctx, dir));
    BRC_TRY(brc_folder_remove(ctx, dir, "case.yaml"));
    BRC_TRY(brc_folder_remove(ctx, dir, "log"));
    rmdir(dir); /* stays when it holds what is not the run's */
    return 0;
}
