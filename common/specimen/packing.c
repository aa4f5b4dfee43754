/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vgcm's growth packing: spheres of uniformly distributed diameters are inserted at half of their
 * radius, grown to the full one, and relaxed without cohesion until they rest. At the paper's solid
 * fraction they overlap a little everywhere, which is what makes every Laguerre cell a compact one.
 *
 * A small run of its own rather than a model in the engine: spheres neither turn nor rub, nothing
 * is saved or compared, and no parameter has a meaning beyond the packing. Called by specimen.c;
 * its result is places and radii (vgcm 2.5). */
#include "common/specimen/seeds.h"

#include "common/geometry/grid.h"
#include "common/base/progress.h"
#include "common/geometry/vec.h"

#include <gsl/gsl_rng.h>

enum {
    MAX_TRIES = 10000,      /* random places tried for one sphere */
    GROWTH_STEPS = 400,     /* steps from half to full radius */
    MAX_RELAX_STEPS = 20000 /* steps at full radius */
};
/* Springs and masses of 1: a sphere of a dense pack touches about 12 others, so its largest
 * eigenfrequency is below sqrt(4 * 12) and a step of 0.2 is stable. */
static const double STEP = 0.2, FRICTION = 0.3;
/* At rest: mean unbalanced force over mean contact force. The packing gives places only, and 1e-3
 * moves them by less than a thousandth of a radius at six times the cost. */
static const double REST = 1e-2, LAST_REST = 1e-5;
static const double SKIN = 0.3; /* of the mean radius */
/* Spheres whose volumes sum to more than that of the domain press each other out of it. */
static const double MAX_FRACTION = 1;
/* Overlap, in mean radii, that counts as none: a loose packing rests when only such are left. Its
 * mean contact force goes to zero, and a ratio to that alone would never fall. */
static const double LOOSE = 1e-3;

struct packing {
    const struct brc_convex *domain;
    size_t n;
    double (*x)[3], (*v)[3], (*f)[3], (*listed)[3];
    double *radius;  /* full */
    double *present; /* at this stage of growth */
    double mean_radius, skin;
    struct brc_neighbours near;
    struct brc_neighbours near_wall; /* sphere and plane of the domain */
    double contact;                  /* mean contact force of the last step */
    struct brc_work work;
    struct brc_pool pool; /* owns the arrays but for x and radius, which are the result */
};

/* By the mean volume of a sphere, before one is made: what cannot be packed is refused at once and
 * not after minutes of relaxing. */
static int choose_count(struct brc_context *ctx, const struct brc_specimen_params *s,
                        double domain_volume, size_t *n)
{
    /* mean of d^3 over uniform d: (high^4 - low^4) / (4 (high - low)) */
    double low = s->diameter_min, high = s->diameter_max;
    double mean = BRC_PI / 6 * ((low * low + high * high) * (low + high) / 4);
    double count = s->count > 0 ? s->count : floor(s->solid_fraction * domain_volume / mean + 0.5);
    double most = fmin(floor(MAX_FRACTION * domain_volume / mean), BRC_MAX_GRAINS);
    if (s->diameter_min > s->diameter_max)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.diameter_min = %g m is larger than specimen.diameter_max = %g m",
                 s->diameter_min, s->diameter_max);
    if (count < 1 || most < 1)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "no sphere fits: the domain holds %g m3, a sphere takes %g m3; enlarge the "
                 "specimen or lower specimen.diameter_min and diameter_max",
                 domain_volume, mean);
    if (s->count > most)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "specimen.count = %d spheres have %.3g times the volume of the specimen; at most "
                 "%.0f fit: lower specimen.count or specimen.diameter_min and diameter_max, or "
                 "enlarge the specimen",
                 s->count, count * mean / domain_volume, most);
    if (count > BRC_MAX_GRAINS)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%g spheres asked for, at most %g are allowed; raise specimen.diameter_min and "
                 "diameter_max",
                 count, (double)BRC_MAX_GRAINS);
    *n = (size_t)count;
    return 0;
}

/* Of a centre, positive inside; a sphere touches the plane where it is its radius. */
static double wall_distance(const struct brc_plane *plane, const double x[3])
{
    return plane->d - brc_dot(plane->n, x);
}

static bool is_inside(const struct brc_convex *domain, const double x[3], double distance)
{
    for (size_t i = 0; i < domain->n_faces; i++)
        if (wall_distance(&domain->plane[i], x) < distance)
            return false;
    return true;
}

/* Uniform places inside the domain, the wall at least half of a radius away; places of the box
 * around it that are not are drawn again. Overlaps at half radius (8 % of the volume is filled
 * then) are left to the relaxation that follows at once. */
static int insert(struct brc_context *ctx, struct packing *p, gsl_rng *rng,
                  const struct brc_specimen_params *s)
{
    double low[3], high[3];
    brc_box_of(low, high, p->domain->vertex, p->domain->n_vertices);
    for (size_t i = 0; i < p->n; i++) {
        /* one diameter from each of n equal classes: the solid fraction hits its mark */
        double rank = ((double)i + gsl_rng_uniform(rng)) / (double)p->n;
        double d = s->diameter_min + (s->diameter_max - s->diameter_min) * rank;
        p->radius[i] = d / 2;
        int tries = 0;
        do
            for (int k = 0; k < 3; k++)
                p->x[i][k] = low[k] + (high[k] - low[k]) * gsl_rng_uniform(rng);
        while (!is_inside(p->domain, p->x[i], d / 4) && ++tries < MAX_TRIES);
        if (tries == MAX_TRIES)
            BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                     "sphere %zu of radius %g m does not fit into the domain; lower "
                     "specimen.diameter_max or enlarge the specimen",
                     i, d / 2);
    }
    return 0;
}

/* Pairs of a sphere and a plane, with the same skin as those of spheres. A domain has few planes,
 * or many that are far from most spheres: no grid is needed. */
static int list_walls(struct brc_context *ctx, struct packing *p)
{
    p->near_wall.n = 0;
    for (size_t i = 0; i < p->n; i++)
        for (size_t k = 0; k < p->domain->n_faces; k++)
            if (wall_distance(&p->domain->plane[k], p->x[i]) <= p->radius[i] + p->skin)
                BRC_TRY(brc_neighbours_add(ctx, &p->near_wall, i, k));
    return 0;
}

/* Lists are made for the full radii, so that growth does not outdate them, and hold until a sphere
 * has moved by half of the skin. */
static int list_neighbours(struct brc_context *ctx, struct packing *p)
{
    bool stale = p->near.pair == NULL;
    for (size_t i = 0; i < p->n && !stale; i++)
        stale = brc_distance(p->x[i], p->listed[i]) > 0.5 * p->skin;
    if (!stale)
        return 0;
    for (size_t i = 0; i < p->n; i++)
        brc_copy(p->listed[i], p->x[i]);
    BRC_TRY(list_walls(ctx, p));
    return brc_grid_pairs(ctx, p->x, p->radius, p->n, p->skin, &p->near);
}

/* Overlap times the direction, between spheres and against the domain's planes. The mean is over
 * pairs of spheres alone. Two centres at one place have no direction; their other neighbours part
 * them. */
static void repel(struct packing *p)
{
    double sum = 0;
    size_t touching = 0;
    for (size_t i = 0; i < p->n; i++)
        brc_set(p->f[i], 0, 0, 0);
    for (size_t k = 0; k < p->near.n; k++) {
        int32_t a = p->near.pair[k][0], b = p->near.pair[k][1];
        double d[3], reach = p->present[a] + p->present[b];
        brc_sub(d, p->x[b], p->x[a]);
        double distance = brc_norm(d);
        if (distance >= reach || distance == 0)
            continue;
        double push = (reach - distance) / distance;
        brc_axpy(p->f[b], push, d);
        brc_axpy(p->f[a], -push, d);
        sum += reach - distance;
        touching++;
    }
    for (size_t k = 0; k < p->near_wall.n; k++) {
        int32_t i = p->near_wall.pair[k][0];
        const struct brc_plane *plane = &p->domain->plane[p->near_wall.pair[k][1]];
        double gap = wall_distance(plane, p->x[i]) - p->present[i];
        if (gap < 0)
            brc_axpy(p->f[i], gap, plane->n);
    }
    p->contact = touching > 0 ? sum / (double)touching : 0;
}

/* One damped step; ratio is the mean unbalanced force over the mean contact force. Symplectic
 * Euler: the place moves with the new velocity, which keeps the step stable up to the limit above.
 */
static int relax(struct brc_context *ctx, struct packing *p, double *ratio)
{
    double unbalanced = 0;
    BRC_TRY(list_neighbours(ctx, p));
    repel(p);
    for (size_t i = 0; i < p->n; i++) {
        unbalanced += brc_norm(p->f[i]);
        brc_scale(p->v[i], p->v[i], 1 - FRICTION * STEP);
        brc_axpy(p->v[i], STEP, p->f[i]);
        brc_axpy(p->x[i], STEP, p->v[i]);
    }
    *ratio = unbalanced / (double)p->n / fmax(p->contact, LOOSE * p->mean_radius);
    return 0;
}

/* The first sphere whose centre is not in its own Laguerre cell (another's power there is lower), n
 * when there is none. Such a centre lies inside the other sphere, so near pairs are all to test.
 * Asked here, since relaxing on can still part the two, while specimen.c can only refuse them. */
static size_t find_swallowed(const struct packing *p)
{
    for (size_t k = 0; k < p->near.n; k++) {
        int32_t a = p->near.pair[k][0], b = p->near.pair[k][1];
        double d[3], square = p->radius[a] * p->radius[a] - p->radius[b] * p->radius[b];
        brc_sub(d, p->x[b], p->x[a]);
        if (brc_norm2(d) <= fabs(square))
            return (size_t)(square > 0 ? b : a);
    }
    return p->n;
}

/* In the order in which a user can do something about it: rest, then sizes, then the fraction. */
static int check_packing(struct brc_context *ctx, const struct packing *p, double ratio)
{
    size_t swallowed = find_swallowed(p);
    if (ratio > REST)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "the packing does not come to rest in %d steps (unbalanced ratio %g); try another "
                 "specimen.seed or a smaller specimen.solid_fraction",
                 MAX_RELAX_STEPS, ratio);
    if (swallowed < p->n)
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY,
                 "sphere %zu of radius %g m at (%g, %g, %g) m has its centre in the cell of a "
                 "larger one; use a narrower range of diameters or a smaller "
                 "specimen.solid_fraction",
                 swallowed, p->radius[swallowed], p->x[swallowed][0], p->x[swallowed][1],
                 p->x[swallowed][2]);
    for (size_t i = 0; i < p->n; i++)
        if (!is_inside(p->domain, p->x[i], 0))
            BRC_FAIL(
                ctx, BRC_ERR_GEOMETRY,
                "sphere %zu was pushed out of the domain; use a smaller specimen.solid_fraction",
                i);
    return 0;
}

/* Grows the spheres and relaxes them until they rest, and longer while a cell lacks its centre:
 * then rest is asked for ten times as strictly, until it is as strict as is of any use. */
static int grow(struct brc_context *ctx, struct packing *p)
{
    double ratio = 1, rest = REST, done = 0;
    for (int step = 0; step < GROWTH_STEPS; step++) {
        double part = 0.5 + 0.5 * (step + 1) / GROWTH_STEPS;
        for (size_t i = 0; i < p->n; i++)
            p->present[i] = part * p->radius[i];
        BRC_TRY(relax(ctx, p, &ratio));
        brc_work_update(&p->work, 0.5 * step / GROWTH_STEPS);
    }
    for (int step = 0; step < MAX_RELAX_STEPS && rest >= LAST_REST; step++) {
        if (ratio <= rest && find_swallowed(p) == p->n)
            break;
        if (ratio <= rest)
            rest /= 10;
        BRC_TRY(relax(ctx, p, &ratio));
        /* a damped pack loses about a constant part of the ratio in each step */
        done = fmax(done, fmin(log(ratio) / log(rest), 1));
        brc_work_update(&p->work, 0.5 + 0.5 * done);
    }
    return check_packing(ctx, p, ratio);
}

static int pack(struct brc_context *ctx, struct packing *p, const struct brc_specimen_params *s,
                gsl_rng *rng)
{
    p->v = brc_pool_alloc(ctx, &p->pool, p->n, sizeof *p->v);
    p->f = brc_pool_alloc(ctx, &p->pool, p->n, sizeof *p->f);
    p->listed = brc_pool_alloc(ctx, &p->pool, p->n, sizeof *p->listed);
    p->present = brc_pool_alloc(ctx, &p->pool, p->n, sizeof *p->present);
    if (p->pool.is_failed || !rng)
        return BRC_ERR_MEMORY;
    gsl_rng_set(rng, (unsigned long)s->seed);
    BRC_TRY(insert(ctx, p, rng, s));
    brc_work_begin(&p->work, ctx, "packing");
    int code = grow(ctx, p);
    brc_work_end(&p->work);
    return code;
}

/* Places and radii are made in the result itself; all else is work that ends with the packing. */
int brc_seeds_packing(struct brc_context *ctx, const struct brc_specimen_params *s,
                      const struct brc_convex *domain, double domain_volume, struct brc_seeds *out)
{
    struct packing p = {.domain = domain};
    BRC_TRY(choose_count(ctx, s, domain_volume, &p.n));
    BRC_TRY(brc_seeds_alloc(ctx, out, p.n, true));
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    p.x = out->x;
    p.radius = out->radius;
    p.mean_radius = 0.25 * (s->diameter_min + s->diameter_max);
    p.skin = SKIN * p.mean_radius;
    int code = pack(ctx, &p, s, rng);
    gsl_rng_free(rng); /* takes NULL */
    brc_pool_free(&p.pool);
    brc_neighbours_free(&p.near);
    brc_neighbours_free(&p.near_wall);
    return code;
}
