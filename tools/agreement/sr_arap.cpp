// SR-ARAP of CGAL's Surface_mesh_deformation. From standard input: numbers of vertices, triangles and held vertices;
// positions; triangles; held vertices with their targets; alpha; and after how many iterations to tell positions, rising.
// To standard output for each of these: seconds so far with set-up, and all positions. With any argument: the version.

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>
#include <CGAL/version.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <vector>

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Deformation = CGAL::Surface_mesh_deformation<Mesh, CGAL::Default, CGAL::Default, CGAL::SRE_ARAP>;
using Vertex = Mesh::Vertex_index;

static Point read_point() {
    double x, y, z;
    std::cin >> x >> y >> z;
    return Point(x, y, z);
}

static double seconds_since(std::chrono::steady_clock::time_point begun) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

int main(int count, char**) {
    if (count > 1) {
        std::puts(CGAL_STR(CGAL_VERSION));
        return 0;
    }
    std::size_t n_vertices, n_faces, n_held;
    std::cin >> n_vertices >> n_faces >> n_held;
    Mesh mesh;
    for (std::size_t v = 0; v < n_vertices; ++v) mesh.add_vertex(read_point());
    for (std::size_t f = 0; f < n_faces; ++f) {
        std::size_t a, b, c;
        std::cin >> a >> b >> c;
        if (mesh.add_face(Vertex(a), Vertex(b), Vertex(c)) == Mesh::null_face()) {
            std::fprintf(stderr, "triangle %zu does not fit a manifold\n", f);
            return 1;
        }
    }
    std::vector<std::pair<Vertex, Point>> held;
    for (std::size_t h = 0; h < n_held; ++h) {
        std::size_t v;
        std::cin >> v;
        held.emplace_back(Vertex(v), read_point());
    }
    double alpha;
    std::cin >> alpha;

    auto begun = std::chrono::steady_clock::now();
    Deformation deformation(mesh);
    deformation.set_sre_arap_alpha(alpha);
    deformation.insert_roi_vertices(vertices(mesh).first, vertices(mesh).second);
    for (const auto& [vertex, target] : held) deformation.insert_control_vertex(vertex);
    if (!deformation.preprocess()) {
        std::fprintf(stderr, "the matrix could not be factored\n");
        return 1;
    }
    for (const auto& [vertex, target] : held) deformation.set_target_position(vertex, target);
    double seconds = seconds_since(begun);

    unsigned done = 0, until;
    while (std::cin >> until) {
        begun = std::chrono::steady_clock::now();
        deformation.deform(until - done, 0.0);
        seconds += seconds_since(begun);
        done = until;
        std::printf("%.6f\n", seconds);
        for (Vertex v : mesh.vertices()) {
            const Point& p = mesh.point(v);
            std::printf("%.17g %.17g %.17g\n", p.x(), p.y(), p.z());
        }
        std::fflush(stdout);
    }
}
