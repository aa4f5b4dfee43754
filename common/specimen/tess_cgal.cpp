/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The only C++ of breccia. Exact predicates give the combinatorial structure; positions are rounded
 * from long double or, where that loses digits, from exact arithmetic. No exception leaves.
 *
 * CGAL rather than a library that makes cells one by one, as Voro++ does: decisions are exact
 * whatever the seeds, so that grids and coincident spheres need no special case, and the dual gives
 * each vertex and facet once, shared by all cells. It is kept to one file, which takes longest of
 * all to compile, so that templates and exceptions stop here. Cells are bounded by guards far
 * outside; the domain, of which CGAL hears nothing, cuts them in cell_complex.c. */
#define CGAL_NDEBUG
/* false alarms in the headers of CGAL and Boost, seen through inlining */
#pragma GCC diagnostic ignored "-Wnull-dereference"

extern "C" {
#include "common/specimen/tess_cgal.h"
}

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>
#include <new>
#include <utility>
#include <vector>

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Weighted = Kernel::Weighted_point_3;

using Vertex_base =
    CGAL::Triangulation_vertex_base_with_info_3<int32_t, Kernel,
                                                CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using Cell_base = CGAL::Triangulation_cell_base_with_info_3<
    int32_t, Kernel,
    CGAL::Regular_triangulation_cell_base_3<Kernel, CGAL::Triangulation_cell_base_3<Kernel>,
                                            CGAL::Discard_hidden_points>>;
/* Plain Voronoi cells are the dual of the regular triangulation with equal weights, too. */
using Regular =
    CGAL::Regular_triangulation_3<Kernel,
                                  CGAL::Triangulation_data_structure_3<Vertex_base, Cell_base>>;
using Vertex = Regular::Vertex_handle;

using Mesh = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>,
                                                 CGAL::Delaunay_mesh_face_base_2<Kernel>>>;

/* A triangle is bad when its area is above the limit or its smallest angle below 20.7 degrees (the
 * bound that is proved to end). CGAL's own area criterion mistakes the sine by a factor of two.
 * Large triangles are split before flat ones. */
class Area_criteria
{
  public:
    using Face_handle = Mesh::Face_handle;
    using Quality = CGAL::Delaunay_mesh_size_criteria_2<Mesh>::Quality; /* sine^2, relative area */

    explicit Area_criteria(double area) : max_area(area)
    {
    }

    CGAL::Mesh_2::Face_badness operator()(Quality q) const
    {
        if (q.size() > 1)
            return CGAL::Mesh_2::IMPERATIVELY_BAD;
        return q.sine() < 0.125 ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
    }

    CGAL::Mesh_2::Face_badness operator()(const Face_handle &f, Quality &q) const
    {
        const auto &a = f->vertex(0)->point(), &b = f->vertex(1)->point(),
                   &c = f->vertex(2)->point();
        double area = CGAL::area(a, b, c), ab = CGAL::squared_distance(a, b),
               bc = CGAL::squared_distance(b, c), ca = CGAL::squared_distance(c, a);
        double longest_two = ab * bc * ca / std::fmin(ab, std::fmin(bc, ca));
        q = Quality(4 * area * area / longest_two, area / max_area);
        return (*this)(q);
    }

    using Is_bad = Area_criteria;
    Is_bad is_bad_object() const
    {
        return *this;
    }

  private:
    double max_area;
};

/* Guards stand far around the region, at the corners of a cube, so that all cells of seeds are
 * bounded. They have the infos -8 to -1, which no seed has. */
constexpr int32_t n_guards = 8;

/* Cramer's rule: numerators and determinant of d x = b. */
template <class Number>
void solve(const Number d[3][3], const Number b[3], Number x[3], Number &det)
{
    for (int i = 0; i < 3; i++) {
        const Number *p = d[(i + 1) % 3], *q = d[(i + 2) % 3];
        const Number cross[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                                 p[0] * q[1] - p[1] * q[0]};
        if (i == 0)
            det = d[0][0] * cross[0] + d[0][1] * cross[1] + d[0][2] * cross[2];
        for (int k = 0; k < 3; k++)
            x[k] = i == 0 ? b[i] * cross[k] : x[k] + b[i] * cross[k];
    }
}

/* The point of equal power to four seeds p with weights w, relative to p[0]: numerators and
 * determinant; shape is the product of the squared edge lengths, to compare the determinant with.
 * Written once for both kinds of numbers, and without a division, which MP_Float lacks. */
template <class Number>
void power_centre(const double p[4][3], const double w[4], Number x[3], Number &det, Number &shape)
{
    Number d[3][3], b[3], product(1);
    for (int i = 0; i < 3; i++) {
        Number square(0);
        for (int k = 0; k < 3; k++) {
            d[i][k] = Number(p[i + 1][k]) - Number(p[0][k]);
            square = square + d[i][k] * d[i][k];
        }
        b[i] = (square - Number(w[i + 1]) + Number(w[0])) * Number(0.5);
        product = product * square;
    }
    solve(d, b, x, det);
    shape = product;
}

/* A vertex of the diagram: where the powers of four seeds are equal. Relative to the first of them,
 * so that its digits are those of the distance and not of the place. */
void cell_centre(const std::array<Vertex, 4> &corner, double x[3])
{
    /* Below this sine, long double may lose more than the last digits of a double. Few tetrahedra
     * are so flat, and exact numbers would be slow for all. */
    constexpr long double flat = 1e-3L;
    double p[4][3], w[4];
    for (size_t i = 0; i < 4; i++) {
        const auto &q = corner[i]->point();
        p[i][0] = q.x();
        p[i][1] = q.y();
        p[i][2] = q.z();
        w[i] = q.weight();
    }
    long double c[3], det, product;
    power_centre<long double>(p, w, c, det, product);
    if (det * det > flat * flat * product) {
        for (int k = 0; k < 3; k++)
            x[k] = static_cast<double>(p[0][k] + c[k] / det);
        return;
    }
    CGAL::MP_Float exact[3], exact_det, exact_product;
    power_centre<CGAL::MP_Float>(p, w, exact, exact_det, exact_product);
    for (int k = 0; k < 3; k++)
        x[k] = p[0][k] + CGAL::to_double(exact[k]) / CGAL::to_double(exact_det);
}

/* CGAL's own order of cells and edges follows addresses in memory. Sorted by the seeds' numbers,
 * equal seeds give equal bits. */
struct Sorted {
    struct Cell {
        std::array<Vertex, 4> corner;
        Regular::Cell_handle handle;
    };
    struct Edge {
        int32_t low, high; /* high < 0: a guard */
        Regular::Edge edge;
    };
    std::vector<Cell> cells;
    std::vector<Edge> edges;

    explicit Sorted(const Regular &t);
};

Sorted::Sorted(const Regular &t)
{
    auto by_info = [](Vertex a, Vertex b) { return a->info() < b->info(); };
    cells.reserve(t.number_of_finite_cells());
    for (auto c = t.finite_cells_begin(); c != t.finite_cells_end(); ++c) {
        Cell cell = {{c->vertex(0), c->vertex(1), c->vertex(2), c->vertex(3)}, c};
        std::sort(cell.corner.begin(), cell.corner.end(), by_info);
        cells.push_back(cell);
    }
    std::sort(cells.begin(), cells.end(), [by_info](const Cell &a, const Cell &b) {
        return std::lexicographical_compare(a.corner.begin(), a.corner.end(), b.corner.begin(),
                                            b.corner.end(), by_info);
    });
    edges.reserve(t.number_of_finite_edges());
    for (auto e = t.finite_edges_begin(); e != t.finite_edges_end(); ++e) {
        Regular::Edge edge = *e;
        int32_t a = edge.first->vertex(edge.second)->info();
        int32_t b = edge.first->vertex(edge.third)->info();
        if (b >= 0 && (a < 0 || a > b)) {
            std::swap(a, b);
            std::swap(edge.second, edge.third);
        }
        if (a >= 0)
            edges.push_back({a, b, edge});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge &a, const Edge &b) {
        return std::make_pair(a.low, a.high) < std::make_pair(b.low, b.high);
    });
}

/* The facet across the edge between two seeds: the cells around the edge, in turn. Its loop begins
 * with the lowest vertex, since CGAL begins anywhere, and areas are summed from the first one. The
 * normal is that of the seeds and not of the vertices, so that small facets have it exactly. */
int add_facet(brc_context *ctx, const Regular &t, const Sorted::Edge &e, double (*seed)[3],
              std::vector<int32_t> &loop, brc_cell_complex *out)
{
    loop.clear();
    auto start = t.incident_cells(e.edge), at = start;
    do
        loop.push_back(at->info());
    while (++at != start);
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    bool is_open = e.high < 0;
    brc_cell_complex_facet facet = {{e.low, is_open ? -1 : e.high},
                                    is_open ? BRC_FACE_OPEN : BRC_FACE_INNER,
                                    static_cast<int32_t>(loop.size()),
                                    0,
                                    {0, 0, 0}};
    if (!is_open) {
        double d[3], length;
        for (int k = 0; k < 3; k++)
            d[k] = seed[e.high][k] - seed[e.low][k];
        length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int k = 0; k < 3; k++)
            facet.normal[k] = d[k] / length;
    }
    return brc_cell_complex_add_facet(ctx, out, &facet, loop.data());
}

/* Vertices have the numbers of the sorted tetrahedra; the infos of CGAL's cells carry these to the
 * facets, which meet the cells in CGAL's order. */
int copy_cells(brc_context *ctx, const Regular &t, double (*seed)[3], brc_cell_complex *out)
{
    Sorted sorted(t);
    int32_t n = 0;
    for (const auto &cell : sorted.cells) {
        double x[3];
        cell_centre(cell.corner, x);
        BRC_TRY(brc_cell_complex_add_vertex(ctx, out, x));
        cell.handle->info() = n++;
    }
    std::vector<int32_t> loop;
    for (const auto &edge : sorted.edges)
        BRC_TRY(add_facet(ctx, t, edge, seed, loop, out));
    return 0;
}

/* All points at once: CGAL then inserts them along a curve of its own, and the infos tell
 * afterwards which is which. A seed that has no vertex is hidden, by the one whose power is least
 * at its place. */
int make_cells(brc_context *ctx, double (*seed)[3], const double *radius, size_t n,
               const double centre[3], double half_width, int32_t *hider, brc_cell_complex *out)
{
    Regular t;
    auto weight = [radius](size_t i) { return radius ? radius[i] * radius[i] : 0; };
    double low = INFINITY, high = 0;
    for (size_t i = 0; i < n; i++) {
        low = std::fmin(low, weight(i));
        high = std::fmax(high, weight(i));
    }
    /* far enough that inside the region every seed is nearer, whatever the weights */
    double far = 8 * std::sqrt(half_width * half_width + high - low);
    std::vector<std::pair<Weighted, int32_t>> points;
    points.reserve(n + n_guards);
    for (int32_t k = 0; k < n_guards; k++) {
        Point guard(centre[0] + (k & 1 ? far : -far), centre[1] + (k & 2 ? far : -far),
                    centre[2] + (k & 4 ? far : -far));
        points.emplace_back(Weighted(guard, low), k - n_guards);
    }
    for (size_t i = 0; i < n; i++)
        points.emplace_back(Weighted(Point(seed[i][0], seed[i][1], seed[i][2]), weight(i)),
                            static_cast<int32_t>(i));
    t.insert(points.begin(), points.end());
    std::fill(hider, hider + n, 0);
    for (auto v = t.finite_vertices_begin(); v != t.finite_vertices_end(); ++v)
        if (v->info() >= 0)
            hider[v->info()] = -1;
    for (size_t i = 0; i < n; i++)
        if (hider[i] == 0)
            hider[i] = t.nearest_power_vertex(points[i + n_guards].first.point())->info();
    return copy_cells(ctx, t, seed, out);
}

/* A mesh in an order of its own, since CGAL's follows addresses: vertices by place, triangles by
 * their vertices, each from its lowest one. By maps, as this kind of triangulation has no room for
 * a number in its vertices. */
struct Sorted_mesh {
    using Place = std::pair<double, double>;
    struct Face {
        Mesh::Face_handle handle;
        int first; /* CGAL's number of the lowest vertex */
    };
    std::map<Place, int32_t> vertices;
    std::map<std::array<int32_t, 3>, Face> faces;
    std::map<Mesh::Face_handle, int32_t> numbers;

    explicit Sorted_mesh(const Mesh &mesh);
};

Sorted_mesh::Sorted_mesh(const Mesh &mesh)
{
    for (auto v = mesh.finite_vertices_begin(); v != mesh.finite_vertices_end(); ++v)
        vertices.emplace(Place(v->point().x(), v->point().y()), 0);
    int32_t n = 0;
    for (auto &vertex : vertices)
        vertex.second = n++;
    for (auto f = mesh.finite_faces_begin(); f != mesh.finite_faces_end(); ++f) {
        std::array<int32_t, 3> corner;
        for (int k = 0; k < 3; k++) {
            const auto &p = f->vertex(k)->point();
            corner[static_cast<size_t>(k)] = vertices.at(Place(p.x(), p.y()));
        }
        auto lowest = std::min_element(corner.begin(), corner.end());
        int first = static_cast<int>(lowest - corner.begin());
        std::rotate(corner.begin(), lowest, corner.end());
        if (f->is_in_domain())
            faces.emplace(corner, Face{f, first});
    }
    n = 0;
    for (const auto &face : faces)
        numbers.emplace(face.second.handle, n++);
}

/* CGAL numbers a neighbour by the vertex that it lies opposite to; turning a triangle, so that it
 * begins with its lowest vertex, has moved both alike. */
int copy_mesh(brc_context *ctx, const Mesh &mesh, brc_pool *pool, brc_cgal_mesh *out)
{
    Sorted_mesh sorted(mesh);
    size_t n = sorted.faces.size(), n_vertices = sorted.vertices.size();
    out->vertex =
        static_cast<double(*)[2]>(brc_pool_alloc(ctx, pool, n_vertices, sizeof *out->vertex));
    out->triangle = static_cast<int32_t(*)[3]>(brc_pool_alloc(ctx, pool, n, sizeof *out->triangle));
    out->neighbour =
        static_cast<int32_t(*)[3]>(brc_pool_alloc(ctx, pool, n, sizeof *out->neighbour));
    if (pool->is_failed)
        return BRC_ERR_MEMORY;
    for (const auto &[place, number] : sorted.vertices) {
        out->vertex[number][0] = place.first;
        out->vertex[number][1] = place.second;
        out->n_vertices++;
    }
    for (const auto &[corner, face] : sorted.faces) {
        for (int k = 0; k < 3; k++) {
            auto other = sorted.numbers.find(face.handle->neighbor((face.first + k) % 3));
            out->triangle[out->n_triangles][k] = corner[static_cast<size_t>(k)];
            out->neighbour[out->n_triangles][k] =
                other == sorted.numbers.end() ? -1 : other->second;
        }
        out->n_triangles++;
    }
    return 0;
}

/* The ring is given as constraints, so that the rim stays a polygon of n sides: refining adds
 * points on its sides, and none beside them. */
int make_mesh(brc_context *ctx, double (*corner)[2], size_t n, double max_area, brc_pool *pool,
              brc_cgal_mesh *out)
{
    Mesh mesh;
    std::vector<Mesh::Vertex_handle> ring;
    for (size_t i = 0; i < n; i++)
        ring.push_back(mesh.insert(Mesh::Point(corner[i][0], corner[i][1])));
    for (size_t i = 0; i < n; i++)
        mesh.insert_constraint(ring[i], ring[(i + 1) % n]);
    CGAL::Delaunay_mesher_2<Mesh, Area_criteria> mesher(mesh, Area_criteria(max_area));
    mesher.refine_mesh();
    return copy_mesh(ctx, mesh, pool, out);
}

/* Runs work and turns exceptions into error codes: they must not pass through C. A lack of
 * memory is the one to be expected, as CGAL's own checks are compiled out. */
template <class Work> int guarded(brc_context *ctx, const char *what, Work work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        BRC_FAIL(ctx, BRC_ERR_MEMORY, "out of memory in the %s; use fewer grains", what);
    } catch (const std::exception &e) {
        BRC_FAIL(ctx, BRC_ERR_GEOMETRY, "the %s failed: %s", what, e.what());
    } catch (...) {
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "the %s failed", what);
    }
}

} /* namespace */

extern "C" int brc_cgal_cells(brc_context *ctx, double (*seed)[3], const double *radius, size_t n,
                              const double centre[3], double half_width, int32_t *hider,
                              brc_cell_complex *out)
{
    return guarded(ctx, "tessellation", [&] {
        return make_cells(ctx, seed, radius, n, centre, half_width, hider, out);
    });
}

extern "C" int brc_cgal_triangulate(brc_context *ctx, double (*corner)[2], size_t n,
                                    double max_area, brc_pool *pool, brc_cgal_mesh *out)
{
    return guarded(ctx, "triangle mesher",
                   [&] { return make_mesh(ctx, corner, n, max_area, pool, out); });
}
