/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cache that fails is a packing that is made again: no error leaves this file but a log line. The
 * key holds all that the packing depends on and a version, and the content a hash, since a wrong
 * packing would go unnoticed. Written under the number of the process and renamed, as several runs
 * may start at once. */
#include "common/specimen/packing_cache.h"

#include "common/base/table.h"
#include "common/base/folders.h"
#include "common/base/input_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* raise when the packing's rules change */
enum { CACHE_VERSION = 2 };
static const char MAGIC[8] = "brcpack";

struct header {
    char magic[8];
    uint64_t version, key, n, hash;
};

/* Numbers as bits and not as text: equal keys mean equal packings, to the last bit. Planes without
 * their labels, which the packing does not see. */
static uint64_t cache_key(const struct brc_specimen_params *p, const struct brc_convex *domain)
{
    double number[] = {p->diameter_min,  p->diameter_max, p->solid_fraction,
                       (double)p->count, (double)p->seed, CACHE_VERSION};
    uint64_t key = brc_hash_bytes(number, sizeof number, BRC_HASH_SEED);
    for (size_t i = 0; i < domain->n_faces; i++) {
        key = brc_hash_bytes(domain->plane[i].n, sizeof domain->plane[i].n, key);
        key = brc_hash_bytes(&domain->plane[i].d, sizeof domain->plane[i].d, key);
    }
    return key;
}

static uint64_t content_hash(const struct brc_seeds *s)
{
    uint64_t hash = brc_hash_bytes(s->x, s->n * sizeof *s->x, BRC_HASH_SEED);
    return brc_hash_bytes(s->radius, s->n * sizeof *s->radius, hash);
}

/* The file of a key; its folder is made where create is set. False when there is none. */
static bool cache_path(char path[BRC_PATH_SIZE], uint64_t key, bool create)
{
    static const char *const place[][2] = {
        {"BRECCIA_CACHE", ""}, {"XDG_CACHE_HOME", "/breccia"}, {"HOME", "/.cache/breccia"}};
    struct brc_context quiet = BRC_CONTEXT_INIT;
    char folder[BRC_PATH_SIZE], name[32];
    const char *value = NULL, *below = NULL;
    for (size_t i = 0; i < sizeof place / sizeof *place && !(value && *value); i++) {
        value = getenv(place[i][0]);
        below = place[i][1];
    }
    if (!value || !*value || snprintf(folder, BRC_PATH_SIZE, "%s%s", value, below) >= BRC_PATH_SIZE)
        return false;
    snprintf(name, sizeof name, "packing-%016llx", (unsigned long long)key);
    return (!create || brc_folder_make(&quiet, folder) == 0) &&
           brc_folder_path(&quiet, folder, name, path) == 0;
}

/* The number of seeds is checked before memory is asked for, and the content's hash after it is
 * read: what is cut off, or was written by a disk that has failed, is not found. */
static bool read_seeds(FILE *file, uint64_t key, struct brc_context *ctx, struct brc_seeds *out)
{
    struct header h;
    if (fread(&h, sizeof h, 1, file) != 1 || memcmp(h.magic, MAGIC, sizeof MAGIC) != 0 ||
        h.version != CACHE_VERSION || h.key != key || h.n == 0 || h.n > BRC_MAX_GRAINS)
        return false;
    if (brc_seeds_alloc(ctx, out, h.n, true) == 0 &&
        fread(out->x, sizeof *out->x, out->n, file) == out->n &&
        fread(out->radius, sizeof *out->radius, out->n, file) == out->n &&
        content_hash(out) == h.hash)
        return true;
    brc_seeds_free(out);
    return false;
}

/* Any doubt is a miss: to make the packing again takes seconds, and a wrong one would not be seen.
 */
bool brc_packing_cache_load(struct brc_context *ctx, const struct brc_specimen_params *p,
                            const struct brc_convex *domain, struct brc_seeds *out)
{
    char path[BRC_PATH_SIZE];
    uint64_t key = cache_key(p, domain);
    const struct brc_input in = {.path = path, .largest = BRC_INPUT_LARGEST, .is_plain = true};
    struct brc_context quiet = BRC_CONTEXT_INIT;
    FILE *file;
    if (!p->cache || !cache_path(path, key, false) || brc_input_open(&quiet, &in, &file, NULL) != 0)
        return false;
    bool found = read_seeds(file, key, ctx, out);
    fclose(file);
    return found;
}

/* Binary, in the order of this machine: the cache is its own, and a file from elsewhere fails at
 * the version. */
static bool write_seeds(const char *path, uint64_t key, const struct brc_seeds *s)
{
    struct header h = {.version = CACHE_VERSION, .key = key, .n = s->n, .hash = content_hash(s)};
    memcpy(h.magic, MAGIC, sizeof MAGIC);
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    bool written = fwrite(&h, sizeof h, 1, file) == 1 &&
                   fwrite(s->x, sizeof *s->x, s->n, file) == s->n &&
                   fwrite(s->radius, sizeof *s->radius, s->n, file) == s->n && fflush(file) == 0 &&
                   fsync(fileno(file)) == 0;
    return fclose(file) == 0 && written;
}

/* The seeds go on as they are whether they can be kept or not. A file under the number of a process
 * that was killed stays; it is never read. */
void brc_packing_cache_save(struct brc_context *ctx, const struct brc_specimen_params *p,
                            const struct brc_convex *domain, const struct brc_seeds *seeds)
{
    char path[BRC_PATH_SIZE], temporary[BRC_PATH_SIZE];
    uint64_t key = cache_key(p, domain);
    if (!p->cache)
        return;
    bool saved = cache_path(path, key, true);
    int length = saved ? snprintf(temporary, BRC_PATH_SIZE, "%s.%ld", path, (long)getpid()) : -1;
    saved = saved && length > 0 && length < BRC_PATH_SIZE && write_seeds(temporary, key, seeds) &&
            rename(temporary, path) == 0;
    if (saved)
        return;
    if (length > 0)
        remove(temporary);
    brc_log(ctx, "the packing cannot be kept on disk; set BRECCIA_CACHE to a folder that can be "
                 "written");
}
