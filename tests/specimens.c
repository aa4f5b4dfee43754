/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/specimens.h"

#include "common/base/table.h"
#include "tests/quality.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

struct brc_context specimens_ctx = BRC_CONTEXT_INIT;
char specimens_folder[] = "/tmp/breccia-test-XXXXXX";

int specimens_set_up(void **state)
{
    (void)state;
    return mkdtemp(specimens_folder) && setenv("BRECCIA_CACHE", specimens_folder, 1) == 0 ? 0 : -1;
}

int specimens_tear_down(void **state)
{
    (void)state;
    return rmdir(specimens_folder);
}

struct brc_specimen_params specimens_params(const char *const *pairs)
{
    struct brc_specimen_params p;
    CHECK_OK(&specimens_ctx, brc_params_defaults(&specimens_ctx, brc_specimen_param_list, &p));
    for (; *pairs; pairs += 2)
        CHECK_OK(&specimens_ctx, brc_params_set(&specimens_ctx, brc_specimen_param_list, &p,
                                                "specimen", pairs[0], pairs[1], "test"));
    return p;
}

uint64_t specimens_hash(const struct brc_specimen *s)
{
    const struct brc_facets *f = &s->facets;
    uint64_t h = brc_hash_bytes(f->vertex, f->n_vertices * sizeof *f->vertex, BRC_HASH_SEED);
    h = brc_hash_bytes(f->loop, f->first[f->n_facets] * sizeof *f->loop, h);
    h = brc_hash_bytes(f->area, f->n_facets * sizeof *f->area, h);
    h = brc_hash_bytes(f->seed, f->n_cells * sizeof *f->seed, h);
    return brc_hash_bytes(f->radius, f->n_cells * sizeof *f->radius, h);
}

void specimens_check_facets(const struct brc_specimen *s)
{
    struct brc_facets_quality q;
    q = brc_facets_quality(&s->facets, s->domain_volume);
    CHECK_NEAR(q.volume_error, 0, 1e-12, 0);
    CHECK_NEAR(q.closure_error, 0, 1e-11, 0);
    /* every boundary facet lies on the plane of its face */
    for (size_t i = 0; i < s->facets.n_facets; i++) {
        const struct brc_plane *plane = s->domain.plane;
        if (s->facets.cell[i][1] >= 0)
            continue;
        while (plane->id != s->facets.face[i])
            plane++;
        CHECK_NEAR(brc_dot(plane->n, s->facets.centroid[i]), plane->d, 1e-14, 1e-13);
        CHECK_NEAR_ARRAY(s->facets.normal[i], plane->n, 3, 1e-15, 0);
    }
}

char *specimens_path(char path[64], const char *name)
{
    snprintf(path, 64, "%s/%s", specimens_folder, name);
    return path;
}

void specimens_write(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}
