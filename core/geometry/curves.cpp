// curves.cpp -- validation of curves, and rotation-minimizing frames.
#include "geometry/curves.h"

#include <algorithm>
#include <cmath>

#include "geometry/curve_frames.h"
#include "geometry/mesh.h"
#include "math/error.h"

namespace dg {
namespace {

std::string whole(const char* what, std::size_t i) { return what + (" " + std::to_string(i)); }

/// Checks that segments and positions are contiguous, as curve_of() requires.
void check_layout(const std::string& where, const Curves& c, std::size_t points) {
    std::size_t segment = 0, point = 0;
    const std::size_t step = c.points_per_segment();
    for (std::size_t k = 0; k < c.ends.size(); ++k) {
        if (c.ends[k] <= segment || c.ends[k] > c.starts.size())
            throw input_error(where, whole("end of curve", k), "more than the end before",
                              std::to_string(c.ends[k]));
        for (; segment < c.ends[k]; ++segment, point += step)
            if (c.starts[segment] != point)
                throw input_error(where, whole("start of segment", segment), std::to_string(point),
                                  std::to_string(c.starts[segment]));
        ++point;
    }
    if (segment != c.starts.size() || point != points)
        throw input_error(where, "positions", std::to_string(point) + " (of all segments)",
                          std::to_string(points));
}

Vec3d any_reference(Vec3d along) {
    return to_double(Frame::from_normal(to_float(along)).x);
}

}  // namespace

float Curves::largest_radius() const {
    return radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
}

void Curves::validate(const Mesh& mesh) const {
    const std::string where = "curves '" + mesh.name + "'";
    if (!mesh.triangles.empty())
        throw Error(where + ": curves cannot have triangles");
    const std::size_t n = mesh.vertex_count();
    if (radii.size() != n)
        throw input_error(where, "length of radii", std::to_string(n) + " (one per position)",
                          std::to_string(radii.size()));
    for (std::size_t i = 0; i < n; ++i)
        if (!(radii[i] >= 0 && radii[i] < kFar))
            throw input_error(where, whole("radius of position", i), "a number from 0 to below 1e18",
                              std::to_string(radii[i]));
    check_layout(where, *this, n);
}

void Curves::complete(const Mesh& mesh) {
    if (empty()) return;
    std::vector<Vec3f> made;
    made.reserve(starts.size() * mesh.steps);
    std::vector<Vec3d> roots(ends.size()), tangents(ends.size());  // of the previous time step
    for (std::uint32_t step = 0; step < mesh.steps; ++step) {
        const float time = mesh.steps == 1 ? 0 : float(step) / float(mesh.steps - 1);
        Vec3d across{}, before{};
        for (std::uint32_t s = 0; s < starts.size(); ++s) {
            const CurveSegment segment = segment_at(mesh, s, time);
            const Vec3d along = segment.tangent(0);
            if (begins_curve(s)) {
                Vec3d &root = roots[curve_of(s)], &tangent = tangents[curve_of(s)];
                root = step == 0 ? any_reference(along) : transported(root, tangent, along);
                tangent = along;
                across = root;
            } else {
                across = transported(across, before, along);
            }
            made.push_back(to_float(across));
            before = segment.tangent(1);
            across = transported(across, along, before);
        }
    }
    references = std::move(made);
}

}  // namespace dg
