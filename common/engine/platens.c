/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which boundary facets face which platen, and the forces and work of platens. Models call the
 * search once, as they open contacts; the rest is sim.c's. It knows the specimen and the platens,
 * no test and no model: that a search stands here once is why a new test changes no model. */
#include "common/engine/platens.h"

#include "common/engine/platen_surface.h"
#include "common/engine/sim.h"
#include "common/geometry/vec.h"

#include <stdlib.h>

/* A facet faces a platen within 30 degrees: the sides of a prism that stands for a cylinder stay
 * out, the corners of its ends that a rough specimen has stay in. */
static const double FACING = 0.86602540378443864676;
/* It lies on a platen when it is parallel to it and this near, in lengths of the specimen: what the
 * digits of a tessellation read from a file allow. */
static const double ON_PLATEN = 1e-6;

/* By the lanes' function, so that the surface of a platen has one formula: a scalar twin would
 * differ in the last bit somewhere. */
bool brc_platen_height(const struct brc_platen *p, const double at[3], const double x[3], double *h,
                       double n[3])
{
    brc_lanes point[3], normal[3], height;
    for (int k = 0; k < 3; k++)
        point[k] = brc_lanes_all(x[k]);
    bool is_there = brc_platen_heights(p, at, point, &height, normal)[0];
    *h = height[0];
    for (int k = 0; k < 3; k++)
        n[k] = normal[k][0];
    return is_there;
}

/* By grain first: models walk over grains, and rows of contacts are sorted so. */
static int compare(const void *p, const void *q)
{
    const struct brc_facing *a = p, *b = q;
    if (a->cell != b->cell)
        return a->cell < b->cell ? -1 : 1;
    if (a->body != b->body)
        return a->body < b->body ? -1 : 1;
    return (a->facet > b->facet) - (a->facet < b->facet);
}

int brc_platens_facing(const struct brc_sim *sim, struct brc_facing **out, size_t *n)
{
    const struct brc_facets *f = &sim->specimen->facets;
    struct brc_facing *list;
    size_t n_boundary = 0, used = 0;
    for (size_t i = 0; i < f->n_facets; i++)
        n_boundary += f->cell[i][1] < 0;
    /* as if each faced every platen: a few times what is needed, for the start of a run alone */
    list = brc_alloc(sim->ctx, n_boundary * (size_t)sim->rig.n_platens, sizeof *list);
    if (!list)
        return BRC_ERR_MEMORY;
    for (size_t i = 0; i < f->n_facets; i++) {
        for (int k = 0; k < sim->rig.n_platens && f->cell[i][1] < 0; k++) {
            const struct brc_platen *p = &sim->rig.platen[k];
            double h, normal[3];
            /* beyond a sharp edge, too: some of its points may lie within */
            brc_platen_height(p, sim->bodies.x[p->body], f->centroid[i], &h, normal);
            double cosine = -brc_dot(f->normal[i], normal);
            if (cosine > FACING)
                list[used++] = (struct brc_facing){
                    .cell = f->cell[i][0],
                    .body = p->body,
                    .facet = (int32_t)i,
                    .is_on = cosine > 1 - ON_PLATEN &&
                             fabs(h) < ON_PLATEN * sim->rig.length[sim->rig.axis]};
        }
    }
    qsort(list, used, sizeof *list, compare);
    *out = list;
    *n = used;
    return 0;
}

/* Along the normal, of the platen on the specimen: the body has the sum on itself. */
static double force_of(const struct brc_sim *sim, const struct brc_platen *p)
{
    return -brc_dot(sim->bodies.f[p->body], p->n);
}

void brc_platens_measure(struct brc_sim *sim)
{
    for (int i = 0; i < sim->rig.n_platens; i++) {
        struct brc_platen *p = &sim->rig.platen[i];
        double force = force_of(sim, p);
        /* trapezoid rule of ledger.h; the platen moves along n alone */
        sim->ledger.boundary +=
            0.5 * (p->force + force) * brc_dot(sim->bodies.v[p->body], p->n) * sim->dt;
        p->force = force;
    }
}

void brc_platens_restore(struct brc_sim *sim)
{
    for (int i = 0; i < sim->rig.n_platens; i++)
        sim->rig.platen[i].force = force_of(sim, &sim->rig.platen[i]);
}
