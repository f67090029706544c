// mesh.cpp -- validation of meshes.
#include "geometry/mesh.h"

#include <cmath>

#include "math/error.h"

namespace dg {
namespace {

bool finite(Vec2f v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}
bool finite(Vec3f v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const std::array<float, 4>& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]) &&
           std::isfinite(v[3]);
}

std::string text(Vec2f v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ")";
}
std::string text(Vec3f v) {
    return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
           std::to_string(v.z) + ")";
}
std::string text(const std::array<float, 4>& v) {
    return "(" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " +
           std::to_string(v[2]) + ", " + std::to_string(v[3]) + ")";
}

template <typename T>
void check_array(const std::string& where, const char* what, const SharedArray<T>& values,
                 std::size_t vertices, std::size_t steps = 1) {
    if (values.size() != vertices * steps) {
        throw input_error(where, std::string("length of ") + what,
                          std::to_string(vertices * steps) +
                              (steps > 1 ? " (one per vertex and time step)" : " (one per vertex)"),
                          std::to_string(values.size()));
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!finite(values[i])) {
            throw input_error(where,
                              std::string(what) + " of vertex " + std::to_string(i),
                              "finite numbers", text(values[i]));
        }
    }
}

/// Checks that attributes of curves have a value per position, or per curve.
void check_curve_values(const std::string& where, const Mesh& mesh) {
    const auto wanted = [&](std::size_t given) {
        return given == mesh.curves.ends.size() ? given : mesh.vertex_count();
    };
    if (!mesh.uv[0].empty())
        check_array(where, "texture coordinates 0", mesh.uv[0], wanted(mesh.uv[0].size()));
    if (!mesh.colors.empty())
        check_array(where, "colours", mesh.colors, wanted(mesh.colors.size()));
}

}  // namespace

void Mesh::validate() const {
    const std::string where = "mesh '" + name + "'";
    if (steps < 1 || steps > kMostMeshSteps)
        throw input_error(where, "time steps", "1 to " + std::to_string(kMostMeshSteps),
                          std::to_string(steps));
    const std::size_t n = vertex_count();
    check_array(where, "positions", positions, n, steps);
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (!within_limits(positions[i]))
            throw input_error(where, "position of vertex " + std::to_string(i), "numbers below 1e18", text(positions[i]));
    if (!curves.empty()) {
        curves.validate(*this);
        check_curve_values(where, *this);
        return;
    }
    if (!normals.empty()) check_array(where, "normals", normals, n, steps);
    for (int set = 0; set < 2; ++set) {
        const char* what = set == 0 ? "texture coordinates 0" : "texture coordinates 1";
        if (!uv[set].empty()) check_array(where, what, uv[set], n);
    }
    if (!tangents.empty()) check_array(where, "tangents", tangents, n, steps);
    if (!colors.empty()) check_array(where, "colours", colors, n);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::uint32_t vertex : triangles[i]) {
            if (vertex >= n) {
                throw input_error(where, "vertex index of triangle " + std::to_string(i),
                                  "less than " + std::to_string(n),
                                  std::to_string(vertex));
            }
        }
    }
}

/// A ball becomes an ellipsoid; its extent along an axis is the length of that row of the matrix.
Vec3f reach_around(const Mesh& mesh, const Affine3f& m) {
    if (mesh.curves.empty()) return {0, 0, 0};
    const float r = 1.0001f * mesh.curves.largest_radius();
    const auto row = [&](int k) { return r * length(Vec3f{m.x[k], m.y[k], m.z[k]}); };
    return {row(0), row(1), row(2)};
}

}  // namespace dg
