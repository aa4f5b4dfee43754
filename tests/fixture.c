/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/fixture.h"
#include "tests/rotate.h"

#include "common/geometry/grid.h"
#include "common/engine/integrate.h"
#include "common/runs/case.h"

#include <stdio.h>
#include <stdlib.h>

int fixture_open(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    if (!f)
        return -1;
    f->ctx = (struct brc_context)BRC_CONTEXT_INIT;
    f->ctx.quiet = 1;
    f->random = UINT64_C(88172645463325252);
    *state = f;
    return 0;
}

void fixture_drop_sim(struct fixture *f)
{
    if (f->has_sim)
        brc_sim_free(&f->sim);
    f->has_sim = false;
}

static void drop_specimen(struct fixture *f)
{
    fixture_drop_sim(f);
    if (f->has_specimen)
        brc_specimen_free(&f->specimen);
    f->has_specimen = false;
}

int fixture_close(void **state)
{
    struct fixture *f = *state;
    drop_specimen(f);
    free(f);
    return 0;
}

void fixture_set(struct fixture *f, struct brc_param_list list, void *values, const char *settings)
{
    char text[1024];
    assert_true(strlen(settings) < sizeof text);
    strcpy(text, settings);
    for (char *save, *item = strtok_r(text, ";", &save); item; item = strtok_r(NULL, ";", &save)) {
        char *key = item + strspn(item, " "), *value = strchr(key, ':');
        if (*key == '\0')
            continue;
        assert_non_null(value);
        *value++ = '\0';
        CHECK_OK(&f->ctx, brc_params_set(&f->ctx, list, values, "test", key,
                                         value + strspn(value, " "), "the test"));
    }
}

void fixture_specimen(struct fixture *f, const char *settings)
{
    struct brc_specimen_params p;
    drop_specimen(f);
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_specimen_param_list, &p));
    fixture_set(f, brc_specimen_param_list, &p, "cache: off");
    fixture_set(f, brc_specimen_param_list, &p, settings);
    CHECK_OK(&f->ctx, brc_specimen_create(&f->ctx, &p, &f->specimen));
    f->has_specimen = true;
}

void fixture_turn_vectors(double (*a)[3], size_t n, double m[3][3])
{
    for (size_t i = 0; i < n; i++) {
        double old[3];
        brc_copy(old, a[i]);
        brc_mat_mul(a[i], m, old);
    }
}

void fixture_turn(struct fixture *f, double m[3][3])
{
    struct brc_facets *s = &f->specimen.facets;
    fixture_turn_vectors(s->vertex, s->n_vertices, m);
    fixture_turn_vectors(s->normal, s->n_facets, m);
    fixture_turn_vectors(s->centroid, s->n_facets, m);
    fixture_turn_vectors(s->seed, s->n_cells, m);
    fixture_turn_vectors(s->centre, s->n_cells, m);
}

void fixture_grid(struct fixture *f, int nx, int ny, int nz, double edge, double jitter)
{
    char text[256];
    snprintf(text, sizeof text,
             "shape: box; grains: grid; size: %.17g m, %.17g m, %.17g m; cells: %d, %d, %d; "
             "jitter: %.17g",
             nx * edge, ny * edge, nz * edge, nx, ny, nz, jitter);
    fixture_specimen(f, text);
}

void fixture_box(struct fixture *f, struct brc_convex *c, const double centre[3],
                 const double edges[3])
{
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = centre[k] - edges[k] / 2;
        high[k] = centre[k] + edges[k] / 2;
    }
    CHECK_OK(&f->ctx, brc_convex_box(&f->ctx, c, low, high));
}

void fixture_octahedron(struct fixture *f, struct brc_convex *c, const double centre[3],
                        double size)
{
    struct brc_plane planes[8];
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++)
            planes[i].n[k] = (i >> k & 1 ? 1 : -1) / sqrt(3);
        planes[i].d = brc_dot(planes[i].n, centre) + size / sqrt(3);
        planes[i].id = i;
    }
    CHECK_OK(&f->ctx, brc_convex_from_planes(&f->ctx, c, planes, 8, centre, 2 * size));
}

/* Copies n items to memory of their own. */
static void *copy_of(struct brc_pool *pool, const void *from, size_t n, size_t size)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    void *to = brc_pool_alloc(&ctx, pool, n + 1, size);
    assert_non_null(to);
    if (from && n > 0)
        memcpy(to, from, n * size);
    return to;
}

static void append_cell(struct brc_facets *s, size_t i, const struct brc_convex *c)
{
    double inertia[3][3];
    brc_convex_mass(c, &s->volume[i], s->centre[i], inertia);
    brc_copy(s->seed[i], s->centre[i]);
    memcpy(s->vertex + s->n_vertices, c->vertex, c->n_vertices * sizeof *c->vertex);
    for (size_t k = 0; k < c->n_faces; k++) {
        size_t m = s->n_facets++, length = c->first[k + 1] - c->first[k];
        s->cell[m][0] = (int32_t)i;
        s->cell[m][1] = -1;
        s->face[m] = (int32_t)k;
        brc_copy(s->normal[m], c->plane[k].n);
        s->area[m] = brc_polygon_area(c->vertex, c->loop + c->first[k], length, c->plane[k].n,
                                      s->centroid[m]);
        for (size_t j = 0; j < length; j++)
            s->loop[s->first[m] + j] = c->loop[c->first[k] + j] + (int32_t)s->n_vertices;
        s->first[m + 1] = s->first[m] + length;
        s->cell_facet[m] = (int32_t)m;
    }
    s->n_vertices += c->n_vertices;
    s->cell_first[i + 1] = s->n_facets;
}

void fixture_loose(struct fixture *f, const struct brc_convex *cell, const double *radius, size_t n)
{
    struct brc_specimen *s = &f->specimen;
    size_t n_faces = 0, n_loop = 0, n_vertices = 0;
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    drop_specimen(f);
    for (size_t i = 0; i < n; i++) {
        n_faces += cell[i].n_faces;
        n_loop += cell[i].first[cell[i].n_faces];
        n_vertices += cell[i].n_vertices;
        for (size_t j = 0; j < cell[i].n_vertices; j++)
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], cell[i].vertex[j][k]);
                high[k] = fmax(high[k], cell[i].vertex[j][k]);
            }
    }
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_specimen_param_list, &s->params));
    fixture_set(f, brc_specimen_param_list, &s->params, "shape: box; grains: grid");
    s->domain = (struct brc_convex){0};
    CHECK_OK(&f->ctx, brc_convex_box(&f->ctx, &s->domain, low, high));
    s->domain_volume = (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
    struct brc_facets *t = &s->facets;
    t->n_cells = n;
    t->volume = copy_of(&t->pool, NULL, n, sizeof *t->volume);
    t->centre = copy_of(&t->pool, NULL, n, sizeof *t->centre);
    t->seed = copy_of(&t->pool, NULL, n, sizeof *t->seed);
    t->radius = copy_of(&t->pool, radius, n, sizeof *t->radius);
    t->cell_first = copy_of(&t->pool, NULL, n, sizeof *t->cell_first);
    t->cell_facet = copy_of(&t->pool, NULL, n_faces, sizeof *t->cell_facet);
    t->cell = copy_of(&t->pool, NULL, n_faces, sizeof *t->cell);
    t->face = copy_of(&t->pool, NULL, n_faces, sizeof *t->face);
    t->is_contact = copy_of(&t->pool, NULL, n_faces, sizeof *t->is_contact);
    memset(t->is_contact, 1, n_faces);
    t->area = copy_of(&t->pool, NULL, n_faces, sizeof *t->area);
    t->centroid = copy_of(&t->pool, NULL, n_faces, sizeof *t->centroid);
    t->normal = copy_of(&t->pool, NULL, n_faces, sizeof *t->normal);
    t->first = copy_of(&t->pool, NULL, n_faces, sizeof *t->first);
    t->loop = copy_of(&t->pool, NULL, n_loop, sizeof *t->loop);
    t->vertex = copy_of(&t->pool, NULL, n_vertices, sizeof *t->vertex);
    f->has_specimen = true;
    for (size_t i = 0; i < n; i++)
        append_cell(t, i, &cell[i]);
}

void fixture_sim(struct fixture *f, const struct brc_model *model, const char *settings,
                 const char *test, const char *run)
{
    fixture_test(f, model, settings, test, "", run);
}

void fixture_test(struct fixture *f, const struct brc_model *model, const char *settings,
                  const char *test, const char *own, const char *run)
{
    CHECK_OK(&f->ctx, fixture_try_sim(f, model, settings, test, own, run));
}

int fixture_try_sim(struct fixture *f, const struct brc_model *model, const char *settings,
                    const char *test, const char *own, const char *run)
{
    struct brc_test_params t;
    struct brc_run_params r;
    void *params = calloc(1, model->params.owner_size + 1);
    fixture_drop_sim(f);
    assert_non_null(params);
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, model->params, params));
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_test_param_list, &t));
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, brc_run_param_list, &r));
    fixture_set(f, model->params, params, settings);
    fixture_set(f, brc_test_param_list, &t, test);
    fixture_set(f, brc_run_param_list, &r, run);
    struct brc_test rig = brc_rigs_test(&t, NULL);
    if (f->instead)
        rig.type = f->instead;
    void *values = calloc(1, rig.type->params.owner_size + 1);
    assert_non_null(values);
    CHECK_OK(&f->ctx, brc_params_defaults(&f->ctx, rig.type->params, values));
    fixture_set(f, rig.type->params, values, own);
    rig.own = values;
    int code = brc_sim_create(&f->ctx, &f->sim, model, params, &f->specimen, &rig, &r);
    free(params);
    free(values);
    f->has_sim = code == 0;
    return code;
}

void fixture_case(struct fixture *f, const struct brc_model *model, const char *path,
                  const char *const *overrides, int n)
{
    struct brc_case run_case = {0};
    drop_specimen(f);
    CHECK_OK(&f->ctx, brc_case_read(&f->ctx, &run_case, path, overrides, n));
    CHECK_OK(&f->ctx, brc_specimen_create(&f->ctx, &run_case.specimen, &f->specimen));
    f->has_specimen = true;
    int code = brc_case_sim(&f->ctx, &run_case, model, &f->specimen, &f->sim);
    brc_case_free(&run_case);
    CHECK_OK(&f->ctx, code);
    f->has_sim = true;
}

void fixture_free_sim(struct fixture *f, const struct brc_model *model, const char *settings,
                      const char *run)
{
    char text[512];
    snprintf(text, sizeof text, "regime: dynamic; %s", run);
    fixture_sim(f, model, settings, "kind: none", text);
    fixture_rest(f);
}

int fixture_n_models(void)
{
    return brc_registry_count() + 1;
}

const struct brc_model *fixture_model(int i)
{
    return i < brc_registry_count() ? brc_registry_at(i) : &brc_model_null;
}

bool fixture_is(const struct brc_model *model, const char *name)
{
    return strcmp(model->name, name) == 0;
}

double fixture_draw(struct fixture *f)
{
    f->random ^= f->random << 13;
    f->random ^= f->random >> 7;
    f->random ^= f->random << 17;
    return (double)(f->random >> 11) / 9007199254740992.0 * 2 - 1;
}

void fixture_draw_unit(struct fixture *f, double n[3])
{
    do {
        for (int k = 0; k < 3; k++)
            n[k] = fixture_draw(f);
    } while (brc_norm2(n) > 1 || brc_norm2(n) < 0.01);
    brc_normalise(n, n);
}

void fixture_velocity(struct fixture *f, size_t body, const double v[3], const double w[3])
{
    struct brc_bodies *b = &f->sim.bodies;
    double m[3][3], c[3];
    brc_copy(b->v[body], v);
    brc_copy(b->w[body], w);
    brc_quat_matrix(m, b->q[body]);
    brc_mat_mul_t(c, m, w);
    for (int k = 0; k < 3; k++)
        c[k] *= b->inertia[body][k];
    brc_mat_mul(b->l[body], m, c);
}

void fixture_ledger(struct fixture *f)
{
    struct brc_ledger *l = &f->sim.ledger;
    const struct brc_bodies *b = &f->sim.bodies;
    /* v- . v+ = v+ . (v+ - dt f / m), the half steps of the leapfrog scheme */
    l->kinetic = fixture_kinetic(f);
    for (size_t i = 0; i < b->n_grains; i++) {
        l->kinetic -= 0.5 * f->sim.dt * (brc_dot(b->v[i], b->f[i]) + brc_dot(b->w[i], b->t[i]));
        b->damping_ahead[i] = 0;
    }
    brc_accounts_open(&f->sim);
}

void fixture_rest(struct fixture *f)
{
    const double zero[3] = {0, 0, 0};
    for (size_t i = 0; i < f->sim.bodies.n; i++)
        fixture_velocity(f, i, zero, zero);
    fixture_ledger(f);
}

void fixture_place(struct fixture *f, const double q[4], const double u[3])
{
    struct brc_bodies *b = &f->sim.bodies;
    for (size_t i = 0; i < b->n; i++) {
        double old[4];
        memcpy(old, b->q[i], sizeof old);
        brc_quat_rotate(b->x[i], q, b->x[i]);
        brc_add(b->x[i], b->x[i], u);
        brc_quat_mul(b->q[i], q, old);
    }
    for (int p = 0; p < f->sim.rig.n_platens; p++) {
        brc_quat_rotate(f->sim.rig.platen[p].n, q, f->sim.rig.platen[p].n);
        brc_quat_rotate(f->sim.rig.platen[p].across, q, f->sim.rig.platen[p].across);
    }
}

void fixture_list(struct fixture *f)
{
    struct brc_sim *s = &f->sim;
    struct brc_neighbours grains = {0}, platens = {0};
    for (size_t i = 0; i < s->bodies.n; i++)
        s->bodies.path_length[i] += 100 * s->bodies.bounding_radius[i];
    CHECK_OK(&f->ctx, brc_grid_pairs(&f->ctx, s->bodies.x, s->bodies.bounding_radius,
                                     s->bodies.n_grains, s->skin, &grains));
    CHECK_OK(&f->ctx, brc_sim_near_platens(s, &platens));
    CHECK_OK(&f->ctx, s->model.pairs(s, s->state, &grains, &platens));
    brc_neighbours_free(&grains);
    brc_neighbours_free(&platens);
    memcpy(s->bodies.path_at_rebuild, s->bodies.path_length,
           s->bodies.n * sizeof *s->bodies.path_length);
}

void fixture_forces(struct fixture *f)
{
    brc_sim_forces(&f->sim);
    CHECK_OK(&f->ctx, f->ctx.code);
}

void fixture_carry(struct fixture *f, double dt)
{
    struct brc_bodies *b = &f->sim.bodies;
    f->sim.dt = dt;
    for (size_t i = 0; i < b->n; i++) {
        double phi[3], turn[4], old[4];
        b->path_length[i] += dt * (brc_norm(b->v[i]) + b->bounding_radius[i] * brc_norm(b->w[i]));
        brc_axpy(b->x[i], dt, b->v[i]);
        brc_scale(phi, b->w[i], dt);
        brc_quat_from_rotation(turn, phi);
        memcpy(old, b->q[i], sizeof old);
        brc_quat_mul(b->q[i], turn, old);
    }
    f->sim.step++;
    fixture_forces(f);
}

void fixture_steps(struct fixture *f, int n)
{
    for (int i = 0; i < n; i++)
        CHECK_OK(&f->ctx, brc_sim_step(&f->sim));
    brc_accounts_settle(&f->sim);
}

double fixture_stored(const struct fixture *f)
{
    double stored[3];
    brc_accounts_stored(&f->sim, stored);
    return stored[0] + stored[1] + stored[2];
}

double fixture_kinetic(const struct fixture *f)
{
    const struct brc_bodies *b = &f->sim.bodies;
    double sum = 0;
    for (size_t i = 0; i < b->n_grains; i++) {
        double m[3][3], w[3];
        brc_quat_matrix(m, b->q[i]);
        brc_mat_mul_t(w, m, b->w[i]);
        sum += 0.5 * b->mass[i] * brc_norm2(b->v[i]);
        for (int k = 0; k < 3; k++)
            sum += 0.5 * b->inertia[i][k] * w[k] * w[k];
    }
    return sum;
}

void fixture_balance(const struct fixture *f, double balance[2])
{
    const struct brc_bodies *b = &f->sim.bodies;
    double force[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, size[2] = {0, 0};
    for (size_t i = 0; i < b->n; i++) {
        double m[3], own[3];
        brc_scale(own, f->sim.run.gravity, -b->true_mass[i]);
        brc_add(own, own, b->f[i]);
        brc_cross(m, b->x[i], own);
        brc_add(force, force, own);
        brc_add(moment, moment, m);
        brc_add(moment, moment, b->t[i]);
    }
    const struct brc_contacts *sets[2] = {&f->sim.pairs, &f->sim.platens};
    for (int s = 0; s < 2; s++)
        for (size_t i = 0; i < sets[s]->n; i++) {
            double row = brc_norm(sets[s]->f[i]);
            size[0] += 2 * row;
            size[1] += row * (brc_norm(b->x[sets[s]->a[i]]) + brc_norm(b->x[sets[s]->b[i]])) +
                       brc_norm(sets[s]->ta[i]) + brc_norm(sets[s]->tb[i]);
        }
    balance[0] = size[0] > 0 ? brc_norm(force) / size[0] : 0;
    balance[1] = size[1] > 0 ? brc_norm(moment) / size[1] : 0;
}

double fixture_third_law(const struct fixture *f)
{
    const struct brc_bodies *b = &f->sim.bodies;
    const struct brc_contacts *sets[2] = {&f->sim.pairs, &f->sim.platens};
    double largest = 0;
    /* the moments of pairs are not kept where the model adds them itself */
    for (int s = f->sim.model.flags & BRC_MODEL_ADDS ? 1 : 0; s < 2; s++)
        for (size_t i = 0; i < sets[s]->n; i++) {
            const struct brc_contacts *c = sets[s];
            double arm[3], m[3];
            brc_sub(arm, b->x[c->b[i]], b->x[c->a[i]]);
            brc_cross(m, arm, c->f[i]);
            brc_add(m, m, c->ta[i]);
            brc_add(m, m, c->tb[i]);
            double size = brc_norm(arm) * brc_norm(c->f[i]) + brc_norm(c->ta[i]);
            if (size > 0)
                largest = fmax(largest, brc_norm(m) / size);
        }
    return largest;
}

double fixture_largest_force(const struct fixture *f)
{
    double largest = 0;
    for (size_t i = 0; i < f->sim.pairs.n; i++)
        largest = fmax(largest, brc_norm(f->sim.pairs.f[i]));
    return largest;
}

void fixture_stress(const struct fixture *f, double stress[3][3])
{
    const struct brc_contacts *c = &f->sim.pairs;
    const struct brc_bodies *b = &f->sim.bodies;
    memset(stress, 0, 9 * sizeof(double));
    for (size_t i = 0; i < c->n; i++) {
        double d[3];
        brc_sub(d, b->x[c->b[i]], b->x[c->a[i]]);
        for (int p = 0; p < 3; p++)
            for (int q = 0; q < 3; q++) /* a bond in tension pulls b back */
                stress[p][q] -= d[p] * c->f[i][q] / f->specimen.domain_volume;
    }
}

struct brc_result fixture_result(const struct fixture *f, const char *name)
{
    struct brc_result all[BRC_MAX_RESULTS];
    int n = brc_rigs_results(&f->sim, all);
    for (int i = 0; i < n; i++)
        if (strcmp(all[i].name, name) == 0)
            return all[i];
    fail_msg("no result %s", name);
    return all[0];
}

const double *fixture_column(const struct fixture *f, const char *name)
{
    const struct brc_table *t = &f->sim.rig.curve.own;
    for (int i = 0; i < t->set.n; i++)
        if (strcmp(t->set.fields[i].name, name) == 0)
            return brc_table_column(t, i);
    fail_msg("no column %s", name);
    return NULL;
}

size_t fixture_row(const struct fixture *f, int32_t a, int32_t b)
{
    int64_t row = brc_contacts_find(&f->sim.pairs, a, b);
    assert_true(row >= 0);
    return (size_t)row;
}
