/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "frames.h"

#include "frame_mesh.h"
#include "vtk.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

#define BRC_OWNER struct brc_frames
static const struct brc_field frame_fields[] = {BRC_FRAME_FIELDS(BRC_FIELD, BRC_FIELD3)};
#undef BRC_OWNER

static const char *const kind_name[BRC_N_FRAME_KINDS] = {"grains", "bonds", "contacts"};

void brc_frames_init(struct brc_frames *f)
{
    const struct brc_fieldset set = BRC_FIELDSET(frame_fields, struct brc_frames);
    memset(f, 0, sizeof *f);
    brc_table_init(&f->table, "frames", set, f);
}

void brc_frames_free(struct brc_frames *f)
{
    brc_table_free(&f->table);
}

bool brc_frames_are_on(const struct brc_output_params *p)
{
    return p->frames > 0 || p->frame_strain > 0 || p->frame_steps > 0;
}

/* The first state is due, and each that has passed one more multiple of the interval. */
bool brc_frames_is_due(const struct brc_frames *f, const struct brc_output_params *p,
                       const struct brc_sim *sim)
{
    size_t n = f->table.n;
    if (!brc_frames_are_on(p))
        return false;
    if (n == 0)
        return true;
    if (p->frame_steps > 0)
        return sim->step / p->frame_steps > f->step[n - 1] / p->frame_steps;
    double every = p->frame_strain > 0 ? p->frame_strain : sim->rig.params.strain_max / p->frames;
    /* a multiple that rounding has put just below counts as reached */
    return floor(sim->rig.strain / every + 1e-9) > floor(f->strain[n - 1] / every + 1e-9);
}

static int in_frames(struct brc_context *ctx, const char *dir, const char *name,
                     char path[PATH_SIZE])
{
    if (snprintf(path, PATH_SIZE, "%s/frames%s%s", dir, *name ? "/" : "", name) >= PATH_SIZE)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "the path %.80s... is too long", dir);
    return 0;
}

/* One file of a frame, with the row of the frame as values of the whole. */
static int write_kind(struct brc_context *ctx, const struct brc_frames *f, const char *dir,
                      enum brc_frame_kind kind, const struct brc_mesh *m,
                      const struct brc_h5_extra *extra)
{
    char path[PATH_SIZE], name[64];
    struct brc_frames now = *f;
    size_t i = f->table.n - 1;
    now.step += i;
    now.time += i;
    now.strain += i;
    now.force += i;
    now.table.columns = &now;
    now.table.n = 1;
    snprintf(name, sizeof name, "%s_%05zu.hdf", kind_name[kind], i);
    BRC_TRY(in_frames(ctx, dir, name, path));
    BRC_TRY(brc_vtk_save(ctx, path, m, &now.table, extra->texts, extra->n_texts));
    snprintf(name, sizeof name, "%s.hdf.series", kind_name[kind]);
    BRC_TRY(in_frames(ctx, dir, name, path));
    return brc_vtk_series(ctx, path, kind_name[kind], f->time, f->table.n);
}

static int write_all(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_sim *sim, const struct brc_h5_extra *extra)
{
    struct brc_frame_mesh mesh;
    const struct brc_mesh *const kinds[BRC_N_FRAME_KINDS] = {&mesh.grains, &mesh.bonds,
                                                             &mesh.contacts};
    int code = brc_frame_mesh_make(ctx, sim, &mesh);
    for (int k = 0; k < BRC_N_FRAME_KINDS && code == 0; k++) {
        code = write_kind(ctx, f, dir, (enum brc_frame_kind)k, kinds[k], extra);
        f->last[k] = (struct brc_frame_count){kind_name[k], kinds[k]->n_points, kinds[k]->n_cells};
    }
    brc_frame_mesh_free(&mesh);
    return code;
}

int brc_frames_write(struct brc_context *ctx, struct brc_frames *f, const char *dir,
                     const struct brc_sim *sim, const struct brc_h5_extra *extra)
{
    char path[PATH_SIZE];
    size_t n = f->table.n, i = n > 0 && f->step[n - 1] == sim->step ? n - 1 : n;
    BRC_TRY(in_frames(ctx, dir, "", path));
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot make the folder %s: %s", path, strerror(errno));
    BRC_TRY(brc_table_resize(ctx, &f->table, i + 1));
    f->step[i] = sim->step;
    f->time[i] = sim->time;
    f->strain[i] = sim->rig.strain;
    f->force[i] = sim->rig.force;
    return write_all(ctx, f, dir, sim, extra);
}

/* "grains_00012.hdf", "grains.hdf.series", and their beginnings "...part". */
static bool is_ours(const char *name)
{
    for (int k = 0; k < BRC_N_FRAME_KINDS; k++) {
        size_t n = strlen(kind_name[k]);
        if (strncmp(name, kind_name[k], n) != 0)
            continue;
        const char *rest = name + n;
        size_t digits = *rest == '_' ? strspn(rest + 1, "0123456789") : 0;
        const char *ending = digits >= 5 ? ".hdf" : ".hdf.series";
        rest += digits >= 5 ? digits + 1 : 0;
        n = strlen(ending);
        if (strncmp(rest, ending, n) == 0 && (!rest[n] || strcmp(rest + n, ".part") == 0))
            return true;
    }
    return false;
}

bool brc_frames_find(const char *dir, char *name, size_t size)
{
    char path[PATH_SIZE];
    bool is_found = false;
    DIR *folder = snprintf(path, sizeof path, "%s/frames", dir) < PATH_SIZE ? opendir(path) : NULL;
    for (struct dirent *entry; folder && !is_found && (entry = readdir(folder));) {
        is_found = is_ours(entry->d_name);
        snprintf(name, size, "frames/%s", entry->d_name);
    }
    if (folder)
        closedir(folder);
    return is_found;
}

int brc_frames_remove(struct brc_context *ctx, const char *dir)
{
    char path[PATH_SIZE];
    int code = 0;
    BRC_TRY(in_frames(ctx, dir, "", path));
    DIR *folder = opendir(path);
    if (!folder)
        return 0;
    for (struct dirent *entry; code == 0 && (entry = readdir(folder));) {
        if (!is_ours(entry->d_name))
            continue;
        code = in_frames(ctx, dir, entry->d_name, path);
        if (code == 0 && unlink(path) != 0)
            code = brc_error_set(ctx, BRC_ERR_IO, __FILE__, __LINE__, "cannot remove %s: %s", path,
                                 strerror(errno));
    }
    closedir(folder);
    BRC_TRY(code);
    BRC_TRY(in_frames(ctx, dir, "", path));
    rmdir(path); /* stays when it holds what is not ours */
    return 0;
}
