/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which states become frames. Strain and load go unevenly and their ends are not known, so frames
 * are not taken at fixed intervals: a new one displaces the one whose loss leaves the smallest gap.
 * Spaced by strain over strain_max, as they once were, four of ten fell into a rock that failed
 * early, and none at its peak.
 *
 * The table is part of the saved state, and files that are not in it are removed: a run that goes
 * on ends with the frames of one that never stopped. Called by runs/run.c and, for folders of
 * earlier runs, by runs/run_folder.c. */
#include "common/output/frames.h"

#include "common/base/text_file.h"
#include "common/output/vtk.h"

#include <dirent.h>
#include <inttypes.h>
#include <math.h>
#include <regex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define BRC_OWNER struct brc_frames
static const struct brc_field frame_fields[] = {BRC_FRAME_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

static const char *const kind_name[BRC_N_FRAME_KINDS] = {"grains", "bonds", "contacts"};
/* Names of their files: "grains_00012.hdf", "grains.hdf.series", and their beginnings, "...part".
 */
#define FILE_PATTERN "^(grains|bonds|contacts)(_[0-9]{5,}[.]hdf|[.]hdf[.]series)([.]part)?$"

void brc_frames_init(struct brc_frames *f)
{
    const struct brc_fieldset set = BRC_FIELDSET(frame_fields, struct brc_frames);
    memset(f, 0, sizeof *f);
    brc_table_init(&f->table, "frames", set, f);
}

static void drop_peak_mesh(struct brc_frames *f)
{
    if (f->peak)
        brc_frame_mesh_free(f->peak);
    free(f->peak);
    f->peak = NULL;
}

void brc_frames_free(struct brc_frames *f)
{
    drop_peak_mesh(f);
    brc_table_free(&f->table);
}

/* By any of the three keys; the two with an interval win over the number, see choose. */
bool brc_frames_are_on(const struct brc_output_params *p)
{
    return p->frames > 0 || p->frame_strain > 0 || p->frame_steps > 0;
}

/* ---- the table ----------------------------------------------------------------------------- */

/* The force at a row of the curve is its mean, which makes the peak; that of a single step swings
 * about it. */
static bool is_row(const struct brc_sim *sim)
{
    const struct brc_curve *c = &sim->rig.curve;
    return c->table.n > 0 && c->step[c->table.n - 1] == sim->step;
}

/* The row of this very step, made where there is none. */
static int add_row(struct brc_context *ctx, struct brc_frames *f, const struct brc_sim *sim,
                   uint8_t role)
{
    const struct brc_curve *c = &sim->rig.curve;
    size_t n = f->table.n;
    if (n > 0 && f->step[n - 1] == sim->step) {
        f->role[n - 1] |= role;
        return 0;
    }
    BRC_TRY(brc_table_resize(ctx, &f->table, n + 1));
    f->step[n] = sim->step;
    f->time[n] = sim->time;
    f->strain[n] = sim->rig.strain;
    f->force[n] = is_row(sim) ? c->force[c->table.n - 1] : sim->rig.force;
    f->broken[n] = (int64_t)sim->events.table.n;
    f->role[n] = role;
    return 0;
}

/* Takes a role from a row, and the row away when it has none left. Its file goes with the next
 * save: until then the saved table still names it. */
static int drop_role(struct brc_context *ctx, struct brc_frames *f, size_t i, uint8_t role)
{
    f->role[i] &= (uint8_t)~role;
    if (f->role[i] != 0)
        return 0;
    brc_table_copy(&f->table, i, i + 1, f->table.n - 1 - i);
    return brc_table_resize(ctx, &f->table, f->table.n - 1);
}

/* The row before i of a role, SIZE_MAX where there is none. */
static size_t row_before(const struct brc_frames *f, size_t i, uint8_t role)
{
    while (i-- > 0)
        if (f->role[i] & role)
            return i;
    return SIZE_MAX;
}

/* ---- which states are frames --------------------------------------------------------------- */

/* Change as a part of all that has happened so far; 0 while nothing has. */
static double part(double from, double to, double all)
{
    return all > 0 ? fabs(to - from) / all : 0;
}

/* How much has happened between two frames, of all that has so far. Without platens steps have to
 * do for strain and load. */
static double distance(const struct brc_frames *f, size_t i, size_t j, const struct brc_sim *sim)
{
    double broken = part((double)f->broken[i], (double)f->broken[j], (double)sim->events.table.n);
    if (sim->rig.n_platens == 0)
        return broken + part((double)f->step[i], (double)f->step[j], (double)sim->step);
    return broken + part(f->strain[i], f->strain[j], sim->rig.strain) +
           part(f->force[i], f->force[j], sim->rig.force_peak);
}

/* The present state, the last row, becomes one of at most `most` frames: where there are as many,
 * in place of the one that leaves the smallest gap. The newest gives way to it only where it stands
 * much too near to the one before. The first stays. */
static int choose_by_gaps(struct brc_context *ctx, struct brc_frames *f, const struct brc_sim *sim,
                          size_t most, bool *is_taken)
{
    size_t before = SIZE_MAX, middle = SIZE_MAX, least = SIZE_MAX, newest = SIZE_MAX, n = 0;
    double least_gap = HUGE_VAL, newest_gap = 0, all = 0;
    for (size_t i = 0; i < f->table.n; i++) {
        bool is_now = i + 1 == f->table.n;
        if (!is_now && !(f->role[i] & BRC_FRAME_SPACED))
            continue;
        double gap = middle != SIZE_MAX ? distance(f, middle, i, sim) : 0;
        double without = before != SIZE_MAX ? distance(f, before, i, sim) : HUGE_VAL;
        if (without < least_gap) {
            least_gap = without;
            least = middle;
        }
        all += gap;
        newest = is_now ? middle : newest;
        newest_gap = is_now ? newest_gap : gap;
        n += !is_now;
        before = middle;
        middle = i;
    }
    *is_taken = n < most ||
                (least != SIZE_MAX && (least != newest || newest_gap < 0.5 * all / (double)most));
    return *is_taken && n >= most ? drop_role(ctx, f, least, BRC_FRAME_SPACED) : 0;
}

/* Counts each multiple of the interval that has been passed; one that rounding has put just below
 * counts as reached. */
static bool has_passed(double from, double to, double every)
{
    return floor(to / every + 1e-9) > floor(from / every + 1e-9);
}

/* The present state is a frame by what has happened since the last one; then it has a row. The
 * first state always is. By number only rows of the curve are asked, as their forces are means. */
static int choose(struct brc_context *ctx, struct brc_frames *f, const struct brc_output_params *p,
                  const struct brc_sim *sim, bool *is_taken)
{
    size_t last = row_before(f, f->table.n, BRC_FRAME_SPACED);
    bool is_first = last == SIZE_MAX;
    *is_taken = is_first;
    if (is_first || p->frame_steps > 0 || p->frame_strain > 0) {
        if (!is_first)
            *is_taken = p->frame_steps > 0
                            ? sim->step / p->frame_steps > f->step[last] / p->frame_steps
                            : has_passed(f->strain[last], sim->rig.strain, p->frame_strain);
        return *is_taken ? add_row(ctx, f, sim, BRC_FRAME_SPACED) : 0;
    }
    if (!is_row(sim) || f->step[last] == sim->step)
        return 0;
    BRC_TRY(add_row(ctx, f, sim, 0));
    BRC_TRY(choose_by_gaps(ctx, f, sim, p->frames > 2 ? (size_t)p->frames - 1 : 1, is_taken));
    if (*is_taken)
        f->role[f->table.n - 1] |= BRC_FRAME_SPACED;
    return *is_taken ? 0 : drop_role(ctx, f, f->table.n - 1, 0);
}

/* By the rig's own record of the peak, so that the frame, the strength and the curve are of one
 * row. */
static bool is_new_peak(const struct brc_sim *sim)
{
    const struct brc_rig *rig = &sim->rig;
    return is_row(sim) && rig->curve.force[rig->curve.table.n - 1] == rig->force_peak &&
           rig->curve.strain[rig->curve.table.n - 1] == rig->strain_peak;
}

/* The present state is the peak, in place of the one so far. */
static int move_peak(struct brc_context *ctx, struct brc_frames *f, const struct brc_sim *sim)
{
    size_t old = row_before(f, f->table.n, BRC_FRAME_PEAK);
    if (old != SIZE_MAX && f->step[old] == sim->step)
        return 0;
    drop_peak_mesh(f);
    if (old != SIZE_MAX)
        BRC_TRY(drop_role(ctx, f, old, BRC_FRAME_PEAK));
    return add_row(ctx, f, sim, BRC_FRAME_PEAK);
}

/* ---- files --------------------------------------------------------------------------------- */

/* DIR/frames, or a file in it: a folder of their own, since there may be hundreds. */
static int in_frames(struct brc_context *ctx, const char *dir, const char *name,
                     char path[BRC_PATH_SIZE])
{
    char inner[300];
    snprintf(inner, sizeof inner, "frames%s%s", *name ? "/" : "", name);
    return brc_folder_path(ctx, dir, inner, path);
}

/* The index of a kind, as ParaView reads it: names and times, without a peak that is not yet
 * written.
 */
static int write_series(struct brc_context *ctx, const struct brc_frames *f, const char *dir,
                        const char *kind)
{
    char name[64];
    const char *comma = "";
    struct brc_text_file file;
    snprintf(name, sizeof name, "frames/%s.hdf.series", kind);
    BRC_TRY(brc_text_file_begin(ctx, &file, dir, name));
    fputs("{\n  \"file-series-version\": \"1.0\",\n  \"files\": [", file.out);
    for (size_t i = 0; i < f->table.n; i++) {
        if (f->peak && f->role[i] == BRC_FRAME_PEAK)
            continue;
        brc_vtk_name(name, sizeof name, kind, f->step[i]);
        fprintf(file.out, "%s\n    {\"name\": \"%s\", \"time\": %.17g}", comma, name, f->time[i]);
        comma = ",";
    }
    fputs("\n  ]\n}\n", file.out);
    return brc_text_file_end(ctx, &file);
}

/* The files of row i, and the index: last, so that it names no file that is not there. Each file
 * has its row (but the role, the last column, which may change) as values of the whole. */
static int write_meshes(struct brc_context *ctx, struct brc_frames *f, size_t i, const char *dir,
                        const struct brc_frame_mesh *mesh, const struct brc_h5_extra *extra)
{
    char path[BRC_PATH_SIZE], name[64];
    const struct brc_mesh *const kinds[BRC_N_FRAME_KINDS] = {&mesh->grains, &mesh->bonds,
                                                             &mesh->contacts};
    struct brc_table whole = f->table;
    whole.set.n--;
    BRC_TRY(in_frames(ctx, dir, "", path));
    BRC_TRY(brc_folder_make(ctx, path));
    for (int k = 0; k < BRC_N_FRAME_KINDS; k++) {
        brc_vtk_name(name, sizeof name, kind_name[k], f->step[i]);
        BRC_TRY(in_frames(ctx, dir, name, path));
        BRC_TRY(brc_vtk_save(ctx, path, kinds[k], &whole, i, extra->texts, extra->n_texts));
        f->last[k] = (struct brc_frame_count){kind_name[k], kinds[k]->n_points, kinds[k]->n_cells};
    }
    for (int k = 0; k < BRC_N_FRAME_KINDS; k++)
        BRC_TRY(write_series(ctx, f, dir, kind_name[k]));
    return 0;
}

/* The files of the last row, which is the present state. */
static int write_now(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_sim *sim, const struct brc_h5_extra *extra)
{
    struct brc_frame_mesh mesh;
    int code = brc_frame_mesh_make(ctx, sim, &mesh);
    if (code == 0)
        code = write_meshes(ctx, f, f->table.n - 1, dir, &mesh, extra);
    brc_frame_mesh_free(&mesh);
    return code;
}

/* In memory, not on disk: on the way up every row of the curve is a new peak, and nearly all of
 * their files would be removed again. */
static int keep_peak(struct brc_context *ctx, struct brc_frames *f, const struct brc_sim *sim)
{
    if (f->peak)
        return 0;
    f->peak = brc_alloc(ctx, 1, sizeof *f->peak);
    return f->peak ? brc_frame_mesh_make(ctx, sim, f->peak) : BRC_ERR_MEMORY;
}

/* The peak moves also where the state is a frame anyhow: then its row has both roles, and is
 * written at once. */
int brc_frames_update(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                      const struct brc_output_params *p, const struct brc_sim *sim,
                      const struct brc_h5_extra *extra)
{
    bool is_taken;
    if (!brc_frames_are_on(p))
        return 0;
    BRC_TRY(choose(ctx, f, p, sim, &is_taken));
    bool is_peak = is_new_peak(sim);
    if (is_peak)
        BRC_TRY(move_peak(ctx, f, sim));
    if (is_taken)
        return write_now(ctx, f, dir, sim, extra);
    return is_peak && f->role[f->table.n - 1] == BRC_FRAME_PEAK ? keep_peak(ctx, f, sim) : 0;
}

/* Before a save, so that a run that is resumed from it finds the file of every row of the table. */
int brc_frames_flush(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_h5_extra *extra)
{
    size_t row = row_before(f, f->table.n, BRC_FRAME_PEAK);
    struct brc_frame_mesh *peak = f->peak;
    if (!peak || row == SIZE_MAX)
        return 0;
    f->peak = NULL; /* so that the index names it */
    int code = write_meshes(ctx, f, row, dir, peak, extra);
    f->peak = peak;
    drop_peak_mesh(f);
    return code;
}

int brc_frames_write(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_sim *sim, const struct brc_h5_extra *extra)
{
    BRC_TRY(add_row(ctx, f, sim, 0));
    return write_now(ctx, f, dir, sim, extra);
}

static bool is_ours(const char *name)
{
    regex_t pattern;
    if (regcomp(&pattern, FILE_PATTERN, REG_EXTENDED | REG_NOSUB) != 0)
        return false;
    bool is_match = regexec(&pattern, name, 0, NULL, 0) == 0;
    regfree(&pattern);
    return is_match;
}

/* Any is enough: it is named in the message that refuses the folder. */
bool brc_frames_find(const char *dir, char *name, size_t size)
{
    char path[BRC_PATH_SIZE];
    bool is_found = false;
    struct brc_context quiet = BRC_CONTEXT_INIT;
    DIR *folder = in_frames(&quiet, dir, "", path) == 0 ? opendir(path) : NULL;
    for (struct dirent *entry; folder && !is_found && (entry = readdir(folder));) {
        is_found = is_ours(entry->d_name);
        snprintf(name, size, "frames/%s", entry->d_name);
    }
    if (folder)
        closedir(folder);
    return is_found;
}

/* Files of frames alone: the index is written anew with each of them and is never left over. */
static bool is_left_over(const struct brc_frames *f, const char *name)
{
    const char *digits = strchr(name, '_'), *end = strrchr(name, '.');
    if (!is_ours(name) || !digits || strcmp(end, ".hdf") != 0)
        return false;
    long long step = strtoll(digits + 1, NULL, 10);
    for (size_t i = 0; i < f->table.n; i++)
        if (f->step[i] == step)
            return false;
    return true;
}

int brc_frames_sweep(struct brc_context *ctx, const struct brc_frames *f, const char *dir)
{
    char path[BRC_PATH_SIZE];
    int code = 0;
    BRC_TRY(in_frames(ctx, dir, "", path));
    DIR *folder = opendir(path);
    if (!folder)
        return 0;
    for (struct dirent *entry; code == 0 && (entry = readdir(folder));)
        if (f ? is_left_over(f, entry->d_name) : is_ours(entry->d_name))
            code = brc_folder_remove(ctx, path, entry->d_name);
    closedir(folder);
    rmdir(path); /* stays when it holds anything, ours or not */
    return code;
}
