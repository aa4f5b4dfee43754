/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The record of finished runs. Lines end in a digest: a ladder takes days, and a line that a full
 * disk or a stop has cut must be told from a whole one. It is a CSV file, so that it can be read by
 * other programs, too; it is locked while it is open, as two ladders would mix their lines. */
#include "common/runs/converge_record.h"

#include "common/base/grow.h"
#include "common/base/input_file.h"
#include "common/runs/run.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LINE_SIZE = 4096, HEADER_SIZE = 2048, N_COLUMNS = 8 };

/* The header names the results with their units: a record of another test, or of a version that
 * measures otherwise, does not fit and is refused. */
static void make_header(const struct brc_converge_study *study, char header[HEADER_SIZE])
{
    int n =
        snprintf(header, HEADER_SIZE, "key,model,seed,setting,ended_by,steps [1],dt [s],cpu_s [s]");
    for (int i = 0; i < study->n_results; i++)
        n += snprintf(header + n, (size_t)(HEADER_SIZE - n), ",%s [%s]", study->results[i].name,
                      study->results[i].unit);
    snprintf(header + n, (size_t)(HEADER_SIZE - n), ",digest\n");
}

/* Of two lines of one key the first is found; both are the same run. */
static int keep(struct brc_context *ctx, struct brc_converge_record *r,
                const struct brc_converge_run *run)
{
    BRC_GROW(ctx, r->run, r->cap, r->n + 1);
    r->run[r->n] = *run;
    r->run[r->n++].is_done = true;
    return 0;
}

/* A line ends with the digest of what stands before it, which is cut off. */
static bool has_digest(char *line)
{
    char text[17], *comma = strrchr(line, ',');
    if (!comma)
        return false;
    snprintf(text, sizeof text, "%016" PRIx64,
             brc_hash_bytes(line, (size_t)(comma - line), BRC_HASH_SEED));
    *comma = '\0';
    return strcmp(comma + 1, text) == 0;
}

/* Takes a whole line apart in its place; false when it is not one of ours. */
static bool parse_line(char *line, int n_results, struct brc_converge_run *run)
{
    if (!has_digest(line))
        return false;
    char *column[N_COLUMNS + BRC_MAX_RESULTS] = {NULL}, *end = line;
    int n = 0, n_wanted = N_COLUMNS + n_results;
    for (char *at = line; at && n < n_wanted; n++) {
        column[n] = at;
        at = strchr(at, ',');
        if (at)
            *at++ = '\0';
        end = at;
    }
    if (n < N_COLUMNS || n < n_wanted || end)
        return false;
    *run = (struct brc_converge_run){.key = strtoull(column[0], &end, 16),
                                     .steps = strtoll(column[5], NULL, 10),
                                     .dt = strtod(column[6], NULL),
                                     .cpu_s = strtod(column[7], NULL)};
    snprintf(run->ended_by, sizeof run->ended_by, "%s", column[4]);
    for (int i = 0; i < n_results; i++)
        run->result[i] = strtod(column[N_COLUMNS + i], NULL);
    return end == column[0] + 16;
}

static int read_line(struct brc_context *ctx, struct brc_converge_record *r, char *line)
{
    struct brc_converge_run run;
    if (!parse_line(line, r->n_results, &run))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: the line '%.40s...' is not as it was written; remove it, or replace all "
                 "with --force",
                 r->path, line);
    return keep(ctx, r, &run);
}

/* Takes what is there; the text is taken apart in its place. A last line that a stop has cut is
 * dropped from the file; a cut header is no more than the beginning of ours. By the size and not up
 * to a byte 0, which a power cut may leave: all lines behind it would be dropped. */
static int read_text(struct brc_context *ctx, struct brc_converge_record *r, const char *header,
                     char *text, size_t n)
{
    size_t size = strlen(header);
    if (memcmp(text, header, n < size ? n : size) != 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s holds other results than this case has; replace it with --force, or choose "
                 "another folder with -o",
                 r->path);
    char *line = n < size ? text : text + size;
    for (char *end; (end = memchr(line, '\n', n - (size_t)(line - text))); line = end + 1) {
        *end = '\0';
        BRC_TRY(read_line(ctx, r, line));
    }
    if (ftruncate(fileno(r->file), line - text) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", r->path, strerror(errno));
    return 0;
}

/* By its path and not from the stream that holds the lock: the reader of inputs bounds what it
 * takes, and refuses what is no plain file. */
static int read_old(struct brc_context *ctx, struct brc_converge_record *r, const char *header)
{
    const struct brc_input in = {.path = r->path, .largest = BRC_INPUT_LARGEST, .is_plain = true};
    char *text;
    size_t n;
    BRC_TRY(brc_input_read(ctx, &in, &text, &n));
    int code = read_text(ctx, r, header, text, n);
    free(text);
    return code;
}

/* Flushed at once: a line that is only in memory would be lost with the program. */
static int write_text(struct brc_context *ctx, struct brc_converge_record *r, const char *text)
{
    BRC_TRY(brc_run_check_open(ctx, r->file, r->path));
    if (fseek(r->file, 0, SEEK_END) != 0 || fputs(text, r->file) < 0 || fflush(r->file) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", r->path, strerror(errno));
    return 0;
}

/* Opened to add: what is there stays until it is known whose it is. */
int brc_converge_record_open(struct brc_context *ctx, struct brc_converge_record *r,
                             const struct brc_converge_study *study)
{
    const struct brc_converge_options *o = study->options;
    char header[HEADER_SIZE];
    *r = (struct brc_converge_record){.n_results = study->n_results};
    BRC_TRY(brc_folder_path(ctx, o->run.dir, "converge_runs.csv", r->path));
    BRC_TRY(brc_run_open(ctx, o->run.dir, "converge_runs.csv", &r->file));
    make_header(study, header);
    /* another ladder may have begun, and ended, since the folder was looked at */
    fseek(r->file, 0, SEEK_END);
    if (!o->run.is_resumed && !o->run.is_forced && ftell(r->file) > 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s has been written by another run just now; choose another folder with -o",
                 r->path);
    if (o->run.is_forced && ftruncate(fileno(r->file), 0) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot empty %s: %s", r->path, strerror(errno));
    BRC_TRY(read_old(ctx, r, header));
    fseek(r->file, 0, SEEK_END);
    return ftell(r->file) > 0 ? 0 : write_text(ctx, r, header);
}

/* By a look at each: at most some thousand, against runs that take seconds. */
const struct brc_converge_run *brc_converge_record_find(const struct brc_converge_record *r,
                                                        uint64_t key)
{
    for (size_t i = 0; i < r->n; i++)
        if (r->run[i].key == key)
            return &r->run[i];
    return NULL;
}

/* Numbers have 17 digits, so that a ladder that goes on makes the same table to the last digit. */
int brc_converge_record_add(struct brc_context *ctx, struct brc_converge_record *r,
                            const char *model, int seed, const struct brc_converge_setting *s,
                            const struct brc_converge_run *run)
{
    char line[LINE_SIZE];
    int n = snprintf(line, sizeof line, "%016" PRIx64 ",%s,%d,%s %s", run->key, model, seed,
                     s->axis, s->label);
    n += snprintf(line + n, sizeof line - (size_t)n, ",%s,%" PRId64 ",%.17g,%.17g", run->ended_by,
                  run->steps, run->dt, run->cpu_s);
    for (int i = 0; i < r->n_results; i++)
        n += snprintf(line + n, sizeof line - (size_t)n, ",%.17g", run->result[i]);
    snprintf(line + n, sizeof line - (size_t)n, ",%016" PRIx64 "\n",
             brc_hash_bytes(line, (size_t)n, BRC_HASH_SEED));
    BRC_TRY(write_text(ctx, r, line));
    return keep(ctx, r, run);
}

void brc_converge_record_close(struct brc_converge_record *r)
{
    if (r->file)
        fclose(r->file);
    free(r->run);
    *r = (struct brc_converge_record){0};
}
