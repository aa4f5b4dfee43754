/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads what any state or frame holds from the file alone: no case, no model and no specimen is
 * needed, so that a file from another version can be looked at. Called by main.c. The file is gone
 * through once a group: HDF5 visits by name, where a group's fields and the groups in it alternate.
 */
#include "common/output/info.h"

#include "common/base/input_file.h"
#include "common/output/io_h5.h"
#include "common/output/checksum_header.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 256, MAX_GROUPS = 64 };

/* Groups are kept by name in the order of their first dataset; a file with more than MAX_GROUPS of
 * them is not ours, and the rest is left out. */
struct info {
    const struct brc_h5_file *f;
    FILE *out;
    double step; /* NAN: the file has none */
    int n_groups, now;
    bool is_first; /* nothing of group `now` has been printed */
    char group[MAX_GROUPS][NAME_SIZE];
};

/* One line a text of the provenance; texts of several lines come at the end. */
static int print_text(void *user, const struct brc_h5_item *item)
{
    const struct info *i = user;
    const char *name = strrchr(item->path, '/');
    char *text;
    if (!item->is_text)
        return 0;
    BRC_TRY(brc_h5_get_text(i->f, item->path, &text));
    if (!strchr(text, '\n'))
        fprintf(i->out, "  %-14s %s\n", name ? name + 1 : item->path, text);
    free(text);
    return 0;
}

static size_t group_length(const struct brc_h5_item *item)
{
    const char *slash = strrchr(item->path, '/');
    return slash ? (size_t)(slash - item->path) : 0;
}

/* Directly in the group: what lies deeper belongs to a group of its own. */
static bool is_of(const struct brc_h5_item *item, const char *group)
{
    size_t length = group_length(item);
    return strlen(group) == length && strncmp(group, item->path, length) == 0;
}

/* Finds the step, and lists the groups as they come up: groups in groups come in between. */
static int survey(void *user, const struct brc_h5_item *item)
{
    struct info *i = user;
    const char *slash = strrchr(item->path, '/');
    if (slash && strcmp(slash, "/step") == 0 && !isnan(item->value))
        i->step = item->value;
    for (int k = 0; k < i->n_groups; k++)
        if (is_of(item, i->group[k]))
            return 0;
    if (item->is_text || i->n_groups == MAX_GROUPS)
        return 0;
    char *name = i->group[i->n_groups++];
    snprintf(name, NAME_SIZE, "%.*s", (int)group_length(item), item->path);
    return 0;
}

/* A field of a group with unit and meaning; a single number with its value. */
static int print_field(void *user, const struct brc_h5_item *item)
{
    struct info *i = user;
    const char *slash = strrchr(item->path, '/');
    char name[NAME_SIZE], shape[32] = "", value[48] = "";
    if (item->is_text || !is_of(item, i->group[i->now]))
        return 0;
    if (i->is_first && item->rows != 1)
        fprintf(i->out, "\n%s: %zu rows\n", i->group[i->now], item->rows);
    else if (i->is_first)
        fprintf(i->out, "\n%s\n", i->group[i->now]);
    i->is_first = false;
    if (item->width > 1)
        snprintf(shape, sizeof shape, "(%zu)", item->width);
    if (!isnan(item->value))
        snprintf(value, sizeof value, " = %.10g", item->value);
    snprintf(name, sizeof name, "%s%s", slash ? slash + 1 : item->path, shape);
    fprintf(i->out, "  %-22s %-8s %s%s%s%s%s%s\n", name, item->type, *item->unit ? "[" : "",
            item->unit, *item->unit ? "]" : "", value, *item->meaning ? "  " : "", item->meaning);
    return 0;
}

/* Last, since it is as long as the user has made it. */
static int print_case(const struct info *i)
{
    char *text;
    BRC_TRY(brc_h5_get_text(i->f, "provenance/case", &text));
    fputs("\ncase\n", i->out);
    for (const char *line = text; *line;) {
        size_t n = strcspn(line, "\n");
        fprintf(i->out, "  %.*s\n", (int)n, line);
        line += n + (line[n] != '\0');
    }
    free(text);
    return 0;
}

/* That there is a text `program` is asked first: an HDF5 file behind a good header that is none of
 * ours ends with a message, not with half a list. */
static int print_all(const struct brc_h5_file *f, FILE *out)
{
    struct info i = {.f = f, .out = out, .step = NAN};
    char *program;
    BRC_TRY(brc_h5_get_text(f, "provenance/program", &program));
    free(program);
    BRC_TRY(brc_h5_visit(f, survey, &i));
    fprintf(out, "%s: %s of breccia, step %.0f\n\n", f->path,
            f->header == &brc_checksum_frame ? "frame (VTKHDF)" : "saved state", i.step);
    BRC_TRY(brc_h5_visit(f, print_text, &i));
    for (; i.now < i.n_groups; i.now++) {
        i.is_first = true;
        BRC_TRY(brc_h5_visit(f, print_field, &i));
    }
    return print_case(&i);
}

/* The file is opened once before its kind is asked for: that it is missing, or a folder, is another
 * message than that it is neither of the two. */
int brc_info_print(struct brc_context *ctx, FILE *out, const char *path)
{
    static const struct brc_checksum_kind *const kinds[] = {&brc_checksum_state,
                                                            &brc_checksum_frame};
    struct brc_h5_file f;
    const struct brc_input in = {.path = path, .largest = SIZE_MAX, .is_plain = true};
    const struct brc_checksum_kind *kind = NULL;
    FILE *file;
    BRC_TRY(brc_input_open(ctx, &in, &file, NULL));
    fclose(file);
    for (int i = 0; i < 2 && !kind; i++)
        kind = brc_checksum_is_there(path, kinds[i]) ? kinds[i] : NULL;
    if (!kind)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "%s is neither a saved state nor a frame of breccia, has lost its first bytes, or "
                 "is of a version before %s",
                 path, BRC_VERSION);
    BRC_TRY(brc_h5_open(ctx, path, kind, &f));
    int code = print_all(&f, out);
    brc_h5_close(&f);
    return code;
}
