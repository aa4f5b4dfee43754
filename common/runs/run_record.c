/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines are JSON, so that other programs read them, and are taken apart by the reader of YAML, of
 * which JSON is a part. On opening only digests are checked: of thousands of lines a command may
 * need some. */
#include "common/runs/run_record.h"

#include "common/base/grow.h"
#include "common/base/input_file.h"
#include "common/input/casefile_tree.h"
#include "common/runs/run.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char head[] = "{\"key\": \"",
                  middle[] = "\", \"input\": ", tail[] = ", \"digest\": \"";
enum { KEY_SIZE = 16, INPUT_AT = sizeof head - 1 + KEY_SIZE + sizeof middle - 1 };

/* ---- reading ------------------------------------------------------------------------------- */

/* Whether a line is as it was written: what stands before the digest makes it. */
static bool is_whole(const char *line, size_t n, uint64_t *key)
{
    char text[sizeof tail + KEY_SIZE + 2];
    size_t n_tail = sizeof text - 1;
    if (n < INPUT_AT + n_tail || strncmp(line, head, sizeof head - 1) != 0)
        return false;
    snprintf(text, sizeof text, "%s%016" PRIx64 "\"}", tail,
             brc_hash_bytes(line, n - n_tail, BRC_HASH_SEED));
    *key = strtoull(line + sizeof head - 1, NULL, 16);
    return memcmp(line + n - n_tail, text, n_tail) == 0;
}

static int keep(struct brc_context *ctx, struct brc_run_record *r, const char *line, uint64_t key)
{
    BRC_GROW(ctx, r->row, r->cap, r->n + 1);
    r->row[r->n++] = (struct brc_run_row){key, line};
    return 0;
}

/* A line that a stop has cut is dropped. Anything else without an end of line is the user's: a
 * record by mistake may be a file of one line. */
static int drop_cut(struct brc_context *ctx, struct brc_run_record *r, const char *text,
                    const char *line, size_t n)
{
    size_t n_head = n < sizeof head - 1 ? n : sizeof head - 1;
    if (memcmp(line, head, n_head) != 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: its end is no line of a record of runs; name another file", r->path);
    if (n > 0 && r->file && ftruncate(fileno(r->file), line - text) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", r->path, strerror(errno));
    return 0;
}

/* Marks left by git where two versions did not fit together are lines like any other: they are
 * refused, and the message says what to do. */
static int read_lines(struct brc_context *ctx, struct brc_run_record *r, char *text, size_t n)
{
    char *line = text;
    for (char *end; (end = memchr(line, '\n', n - (size_t)(line - text))); line = end + 1) {
        uint64_t key;
        *end = '\0';
        if (!is_whole(line, (size_t)(end - line), &key))
            BRC_FAIL(ctx, BRC_ERR_INPUT,
                     "%s: the line '%.40s...' is not as it was written; remove it, and its run is "
                     "done again",
                     r->path, line);
        BRC_TRY(keep(ctx, r, line, key));
    }
    return drop_cut(ctx, r, text, line, n - (size_t)(line - text));
}

/* The text is kept as long as the record: rows point into it. */
static int read_old(struct brc_context *ctx, struct brc_run_record *r)
{
    const struct brc_input in = {.path = r->path, .largest = BRC_INPUT_LARGEST, .is_plain = true};
    char *text, *kept;
    size_t n;
    if (access(r->path, F_OK) != 0)
        return 0;
    BRC_TRY(brc_input_read(ctx, &in, &text, &n));
    kept = brc_pool_alloc(ctx, &r->pool, n + 1, 1);
    if (kept)
        memcpy(kept, text, n);
    free(text);
    return kept ? read_lines(ctx, r, kept, n) : BRC_ERR_MEMORY;
}

/* The folder and the name in it, as brc_run_open takes them. */
static int open_locked(struct brc_context *ctx, struct brc_run_record *r)
{
    char dir[BRC_PATH_SIZE];
    const char *slash = strrchr(r->path, '/');
    snprintf(dir, sizeof dir, "%.*s", slash ? (int)(slash - r->path) : 1, slash ? r->path : ".");
    if (slash == r->path)
        snprintf(dir, sizeof dir, "/");
    BRC_TRY(brc_folder_make(ctx, dir));
    return brc_run_open(ctx, dir, slash ? slash + 1 : r->path, &r->file);
}

int brc_run_record_open(struct brc_context *ctx, struct brc_run_record *r, const char *path,
                        bool is_read_only)
{
    *r = (struct brc_run_record){0};
    snprintf(r->path, sizeof r->path, "%s", path);
    if (!is_read_only)
        BRC_TRY(open_locked(ctx, r));
    return read_old(ctx, r);
}

void brc_run_record_close(struct brc_run_record *r)
{
    if (r->file)
        fclose(r->file);
    brc_pool_free(&r->pool);
    free(r->row);
    *r = (struct brc_run_record){0};
}

/* By the whole input, too: 64 bits are no proof. From the end, as a run that was done again has a
 * later line. */
const char *brc_run_record_find(const struct brc_run_record *r, const struct brc_run_key *key)
{
    size_t n = strlen(key->text);
    for (size_t i = r->n; i-- > 0;)
        if (r->row[i].key == key->hash && strncmp(r->row[i].line + INPUT_AT, key->text, n) == 0)
            return r->row[i].line;
    return NULL;
}

/* ---- writing ------------------------------------------------------------------------------- */

static void put_number(FILE *out, const char *name, double value)
{
    fprintf(out, ", \"%s\": ", name);
    brc_output_json_number(out, value);
}

static void put_text(FILE *out, const char *name, const char *text)
{
    fprintf(out, ", \"%s\": ", name);
    brc_output_json_text(out, text);
}

/* A pair [value, note] a result; the note where there is one. */
static void put_results(FILE *out, const struct brc_summary *s)
{
    fputs(", \"results\": {", out);
    for (int i = 0; i < s->n_results; i++) {
        fprintf(out, "%s\"%s\": [", i ? ", " : "", s->results[i].name);
        brc_output_json_number(out, s->results[i].value);
        if (s->results[i].note) {
            fputs(", ", out);
            brc_output_json_text(out, s->results[i].note);
        }
        fputc(']', out);
    }
    fputc('}', out);
}

/* Numbers have 17 digits: tables that are made of the record are those that were made of the runs.
 */
static void put_run(FILE *out, const struct brc_run_key *key, const struct brc_outcome *o)
{
    const struct brc_summary *s = &o->summary;
    fprintf(out, "%s%016" PRIx64 "%s%s, \"code\": %d", head, key->hash, middle, key->text, o->code);
    put_text(out, "message", o->code ? o->message : "");
    put_text(out, "ended_by", *s->ended_by ? s->ended_by : "failure");
    put_number(out, "steps", (double)s->steps);
    put_number(out, "n_grains", (double)s->n_grains);
    put_number(out, "n_contacts_mean", s->n_contacts_mean);
    put_number(out, "dt", s->dt);
    put_number(out, "cpu_s", s->cpu_s);
    put_number(out, "wall_s", s->wall_s);
    put_number(out, "energy_residual", s->energy_residual);
    put_number(out, "energy_drift", s->energy_drift);
    put_number(out, "unbalanced_max", s->unbalanced_max);
    fprintf(out, ", \"state_hash\": \"%016" PRIx64 "\"", s->state_hash);
    put_results(out, s);
}

char *brc_run_record_line(struct brc_context *ctx, struct brc_pool *pool,
                          const struct brc_run_key *key, const struct brc_outcome *outcome)
{
    char *text = NULL, *line = NULL;
    size_t n = 0;
    FILE *out = open_memstream(&text, &n);
    if (out)
        put_run(out, key, outcome);
    if (out && fclose(out) == 0)
        line = brc_pool_alloc(ctx, pool, n + sizeof tail + KEY_SIZE + 3, 1);
    if (line)
        sprintf(line, "%s%s%016" PRIx64 "\"}", text, tail, brc_hash_bytes(text, n, BRC_HASH_SEED));
    free(text);
    return line;
}

/* By one call of the system, so that a stop cuts no line, but for a full disk. */
int brc_run_record_add(struct brc_context *ctx, struct brc_run_record *r, const char *line)
{
    size_t n = strlen(line);
    uint64_t key;
    char *kept = brc_pool_alloc(ctx, &r->pool, n + 2, 1);
    if (!kept)
        return BRC_ERR_MEMORY;
    if (!is_whole(line, n, &key))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "a line for %s is not whole", r->path);
    memcpy(kept, line, n);
    kept[n] = '\n';
    BRC_TRY(brc_run_check_open(ctx, r->file, r->path));
    ssize_t done = write(fileno(r->file), kept, n + 1);
    if (done != (ssize_t)n + 1)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot write %s: %s", r->path,
                 done >= 0 ? "the disk is full" : strerror(errno));
    kept[n] = '\0';
    return keep(ctx, r, kept, key);
}

/* ---- one line ------------------------------------------------------------------------------ */

static const char *text_of(const struct brc_tree *row, const char *name)
{
    const struct brc_tree *t = brc_tree_find(row, name);
    return t ? t->text : "";
}

static double value_of(const struct brc_tree *t)
{
    return t && t->kind == BRC_TREE_TEXT ? strtod(t->text, NULL) : NAN;
}

static double number_of(const struct brc_tree *row, const char *name)
{
    return value_of(brc_tree_find(row, name));
}

static void read_results(const struct brc_tree *row, struct brc_kept_run *out)
{
    const struct brc_tree *all = brc_tree_find(row, "results");
    for (size_t i = 0; all && i < all->n && out->n_results < BRC_MAX_RESULTS; i++) {
        const struct brc_tree *t = &all->item[i];
        out->result[out->n_results++] =
            (struct brc_kept_result){.name = t->key,
                                     .note = t->n > 1 ? t->item[1].text : "",
                                     .value = t->n > 0 ? value_of(&t->item[0]) : NAN};
    }
}

int brc_run_record_read(struct brc_context *ctx, struct brc_pool *pool, const char *line,
                        struct brc_kept_run *out)
{
    struct brc_tree t;
    const struct brc_yaml_text from = {"the record", "line", line, strlen(line)};
    BRC_TRY(brc_tree_parse(ctx, pool, &from, &t));
    *out = (struct brc_kept_run){.code = (int)number_of(&t, "code"),
                                 .message = text_of(&t, "message"),
                                 .ended_by = text_of(&t, "ended_by"),
                                 .steps = (int64_t)number_of(&t, "steps"),
                                 .n_grains = number_of(&t, "n_grains"),
                                 .n_contacts_mean = number_of(&t, "n_contacts_mean"),
                                 .dt = number_of(&t, "dt"),
                                 .cpu_s = number_of(&t, "cpu_s"),
                                 .wall_s = number_of(&t, "wall_s"),
                                 .energy_residual = number_of(&t, "energy_residual"),
                                 .energy_drift = number_of(&t, "energy_drift"),
                                 .unbalanced_max = number_of(&t, "unbalanced_max"),
                                 .state_hash = strtoull(text_of(&t, "state_hash"), NULL, 16)};
    read_results(&t, out);
    return 0;
}

double brc_kept_result(const struct brc_kept_run *run, const char *name)
{
    for (int i = 0; i < run->n_results; i++)
        if (strcmp(run->result[i].name, name) == 0)
            return run->result[i].value;
    return NAN;
}
