/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines end in a digest: a ladder takes days, and a line that a full disk or a stop has cut must be
 * told from a whole one. The file is locked while it is open. */
#include "common/runs/converge_record.h"

#include "common/base/grow.h"
#include "common/runs/run.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LINE_SIZE = 4096, HEADER_SIZE = 2048, N_COLUMNS = 8 };

static void make_header(const struct brc_converge_study *study, char header[HEADER_SIZE])
{
    int n =
        snprintf(header, HEADER_SIZE, "key,model,seed,setting,ended_by,steps [1],dt [s],cpu_s [s]");
    for (int i = 0; i < study->n_results; i++)
        n += snprintf(header + n, (size_t)(HEADER_SIZE - n), ",%s [%s]", study->results[i].name,
                      study->results[i].unit);
    snprintf(header + n, (size_t)(HEADER_SIZE - n), ",digest\n");
}

static int keep(struct brc_context *ctx, struct brc_converge_record *r,
                const struct brc_converge_run *run)
{
    BRC_GROW(ctx, r->run, r->cap, r->n + 1);
    r->run[r->n] = *run;
    r->run[r->n++].is_done = true;
    return 0;
}

/* The digest of what stands before it in a line. */
static uint64_t digest(const char *line, size_t n)
{
    return brc_hash_bytes(line, n, BRC_HASH_SEED);
}

/* A line ends with its digest, which is cut off. */
static bool has_digest(char *line)
{
    char text[17], *comma = strrchr(line, ',');
    if (!comma)
        return false;
    snprintf(text, sizeof text, "%016" PRIx64, digest(line, (size_t)(comma - line)));
    *comma = '\0';
    return strcmp(comma + 1, text) == 0;
}

/* Takes a whole line apart in its place; false when it is not one of ours. */
static bool read_line(char *line, int n_results, struct brc_converge_run *run)
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

/* Reads what is there. A last line that a stop has cut is dropped from the file; a cut header is no
 * more than the beginning of ours. */
static int read_old(struct brc_context *ctx, struct brc_converge_record *r, const char *header)
{
    char line[LINE_SIZE];
    long whole = 0;
    rewind(r->file);
    for (bool is_first = true; fgets(line, sizeof line, r->file); is_first = false) {
        struct brc_converge_run run;
        size_t n = strlen(line);
        bool is_whole = n > 0 && line[n - 1] == '\n';
        bool is_cut = !is_whole && feof(r->file);
        if (is_first && (is_cut ? strncmp(line, header, n) : strcmp(line, header)) != 0)
            BRC_FAIL(
                ctx, BRC_ERR_INPUT,
                "%s holds other results than this case has; replace it with --force, or choose "
                "another folder with -o",
                r->path);
        if (is_cut)
            break;
        if (is_whole)
            line[n - 1] = '\0';
        if (!is_whole || (!is_first && !read_line(line, r->n_results, &run)))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s: the line '%.40s...' is not as it was written; remove it, or replace all "
                     "with --force",
                     r->path, line);
        if (!is_first)
            BRC_TRY(keep(ctx, r, &run));
        whole = ftell(r->file);
    }
    if (ferror(r->file) || ftruncate(fileno(r->file), whole) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot read %s: %s", r->path, strerror(errno));
    return 0;
}

static int write_text(struct brc_context *ctx, struct brc_converge_record *r, const char *text)
{
    if (fseek(r->file, 0, SEEK_END) != 0 || fputs(text, r->file) < 0 || fflush(r->file) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", r->path, strerror(errno));
    return 0;
}

int brc_converge_record_open(struct brc_context *ctx, struct brc_converge_record *r,
                             const struct brc_converge_study *study)
{
    const struct brc_converge_options *o = study->options;
    char header[HEADER_SIZE];
    *r = (struct brc_converge_record){.n_results = study->n_results};
    BRC_TRY(brc_folder_path(ctx, o->dir, "converge_runs.csv", r->path));
    BRC_TRY(brc_run_open(ctx, o->dir, "converge_runs.csv", &r->file));
    make_header(study, header);
    /* another ladder may have begun, and ended, since the folder was looked at */
    fseek(r->file, 0, SEEK_END);
    if (!o->is_resumed && !o->is_forced && ftell(r->file) > 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s has been written by another run just now; choose another folder with -o",
                 r->path);
    if (o->is_forced && ftruncate(fileno(r->file), 0) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot empty %s: %s", r->path, strerror(errno));
    BRC_TRY(read_old(ctx, r, header));
    fseek(r->file, 0, SEEK_END);
    return ftell(r->file) > 0 ? 0 : write_text(ctx, r, header);
}

const struct brc_converge_run *brc_converge_record_find(const struct brc_converge_record *r,
                                                        uint64_t key)
{
    for (size_t i = 0; i < r->n; i++)
        if (r->run[i].key == key)
            return &r->run[i];
    return NULL;
}

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
    snprintf(line + n, sizeof line - (size_t)n, ",%016" PRIx64 "\n", digest(line, (size_t)n));
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
