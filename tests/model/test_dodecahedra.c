/* SPDX-License-Identifier: GPL-3.0-or-later */
/* 512 packed dodecahedra: feature contacts against the counts that three independent programs give
 * for this packing, at three sizes. Its faces are out of plane by up to 1.1e-8 (their five corners
 * are given so); one vertex stands at 2 R (1 + 4.8e-8) from the mean plane of its face and is
 * counted by them: radii are taken 1e-7 larger here to have it too. */
#include "tests/near.h"
#include "tests/poly_solids.h"

#include "common/geometry/vec.h"

#include <stdio.h>

enum { N_BODIES = 512, MAX_VERTICES = 20, MAX_FACES = 12, MAX_SIDES = 60 };

struct packing {
    double radius;
    double vertex[MAX_VERTICES][3];
    size_t n_vertices, n_faces, n_bodies;
    size_t first[MAX_FACES + 1];
    int32_t loop[MAX_SIDES];
    struct solid_pose pose[N_BODIES];
};

static void read_face(struct packing *p, const char *text)
{
    size_t n = p->first[p->n_faces];
    int used = 0;
    while (sscanf(text, "%d%n", &p->loop[n], &used) == 1) {
        text += used;
        n++;
    }
    p->first[++p->n_faces] = n;
}

static struct packing *read_packing(double scale)
{
    struct packing *p = calloc(1, sizeof *p);
    FILE *file = fopen("tests/data/dodecahedra-512.txt", "r");
    char line[512];
    assert_non_null(p);
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        double v[7];
        int n = sscanf(line + 1, "%lf %lf %lf %lf %lf %lf %lf", v, v + 1, v + 2, v + 3, v + 4,
                       v + 5, v + 6);
        if (line[0] == 'r' && n == 1)
            p->radius = scale * v[0];
        if (line[0] == 'v' && n == 3)
            brc_scale(p->vertex[p->n_vertices++], v, scale);
        if (line[0] == 'f')
            read_face(p, line + 1);
        if (line[0] == 'b' && n == 7) {
            struct solid_pose *pose = &p->pose[p->n_bodies++];
            brc_scale(pose->x, v, scale);
            memcpy(pose->q, v + 3, sizeof pose->q);
        }
    }
    fclose(file);
    assert_int_equal(p->n_bodies, N_BODIES);
    assert_int_equal(p->n_faces, MAX_FACES);
    return p;
}

struct count {
    int vertex_face, edge_edge, merged_vertices;
    double merged_weight, merged_energy;
};

static void count_pair(struct count *c, const struct poly_pair *pair, enum poly_rule rule,
                       struct poly_list *list)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    double allowance;
    CHECK_OK(&ctx,
             poly_list_features(&ctx, list, pair, rule, 0.05 * pair->contact_distance, &allowance));
    for (size_t k = 0; k < list->n; k++) {
        struct poly_geometry t;
        struct poly_feature f = list->feature[k];
        uint8_t active = 0;
        double margin;
        if (!poly_find_contact(&t, pair, &f, &active, &margin, rule))
            continue;
        if (rule == POLY_STRICT) {
            c->vertex_face += f.kind != POLY_EDGES;
            c->edge_edge += f.kind == POLY_EDGES;
        } else {
            c->merged_vertices += f.kind != POLY_EDGES;
            c->merged_weight += t.weight;
            c->merged_energy += 0.5 * t.weight * t.delta * t.delta /
                                (pair->contact_distance * pair->contact_distance);
        }
    }
}

static struct count count_contacts(double scale, double widen)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct packing *p = read_packing(scale);
    double radius = p->radius * widen;
    struct poly_shapes shapes = {0};
    struct poly_list list = {0};
    struct count c = {0};
    struct brc_convex solid = {.n_vertices = p->n_vertices,
                               .vertex = p->vertex,
                               .n_faces = p->n_faces,
                               .first = p->first,
                               .loop = p->loop};
    struct brc_plane plane[MAX_FACES];
    solid_planes(&solid, plane);
    CHECK_OK(&ctx, poly_shapes_add(&ctx, &shapes, &solid));
    double near = 2 * (solid_reach(&shapes, 0) + p->radius);
    for (size_t i = 0; i < N_BODIES; i++)
        solid_place(&p->pose[i], &shapes, 0);
    for (size_t i = 0; i < N_BODIES; i++)
        for (size_t j = i + 1; j < N_BODIES; j++) {
            double d[3];
            brc_sub(d, p->pose[i].x, p->pose[j].x);
            if (brc_norm(d) > near)
                continue;
            struct poly_pair pair = solid_pair(&shapes, 0, &p->pose[i], 0, &p->pose[j], radius);
            count_pair(&c, &pair, POLY_STRICT, &list);
            count_pair(&c, &pair, POLY_MERGED, &list);
        }
    for (size_t i = 0; i < N_BODIES; i++)
        free(p->pose[i].v);
    poly_list_free(&list);
    poly_shapes_free(&shapes);
    free(p);
    return c;
}

static void test_counts_at_three_sizes(void **state)
{
    (void)state;
    struct count unit = count_contacts(1, 1 + 1e-7);
    print_message("dodecahedra: vertex-face %d, edge-edge %d; merged: %d vertices, total weight "
                  "%.4f\n",
                  unit.vertex_face, unit.edge_edge, unit.merged_vertices, unit.merged_weight);
    const double scales[] = {1, 1e-3, 1e-6};
    for (int k = 0; k < 3; k++) {
        double scale = scales[k];
        struct count c = count_contacts(scale, 1 + 1e-7);
        assert_int_equal(c.vertex_face, 1710);
        assert_int_equal(c.edge_edge, 1510);
        assert_int_equal(c.merged_vertices, unit.merged_vertices);
        CHECK_NEAR(c.merged_weight, unit.merged_weight, 0, 1e-9);
        CHECK_NEAR(c.merged_energy, unit.merged_energy, 0, 1e-9);
        c = count_contacts(scale, 1);
        assert_int_equal(c.vertex_face, 1709);
        assert_int_equal(c.edge_edge, 1510);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_counts_at_three_sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
