// footprint.cpp -- projects the circular cross section of a ray cone to the surface and to uv.
#include "scene/footprint.h"

#include "scene/curve_surface.h"

namespace dg {
namespace {

// Lower bound of the cosine, which limits the length of a footprint on the surface.
constexpr float kSmallestCosine = 1e-3f;

Vec3f world_edge(const InstanceRecord& r, const Placement& place, std::uint32_t from,
                 std::uint32_t to) {
    const Vec3d edge = r.position(place, to) - r.position(place, from);
    return to_float(place.world_from_local.vector(edge));
}

TexturedPatch triangle_patch(const InstanceRecord& r, const Placement& place, std::uint32_t primitive) {
    const auto& t = r.triangles[primitive];
    TexturedPatch patch{{world_edge(r, place, t[0], t[1]), world_edge(r, place, t[0], t[2])}, {}};
    for (int set = 0; set < 2; ++set) {
        if (!r.uv[set]) continue;
        patch.uv[set] = {r.uv[set][t[1]] - r.uv[set][t[0]], r.uv[set][t[2]] - r.uv[set][t[0]]};
    }
    return patch;
}

}  // namespace

// The cone intersects the plane in an ellipse: it has the width of the cone perpendicular to the plane of incidence,
// and is longer by 1 / cos along it. Each axis is expressed in the edges, which have known uv differences. Source:
// Akenine-Moller et al. 2021, Improved Shader and Texture Level of Detail Using Ray Cones, JCGT 10(1).
void set_footprint(const InstanceRecord& r, const Placement& place, float width,
                   SurfaceHit& hit) {
    if (r.curves ? !r.textured : !r.uv[0] && !r.uv[1]) return;
    const TexturedPatch patch = r.curves ? curve_patch(r, place, hit.primitive, hit)
                                         : triangle_patch(r, place, hit.primitive);
    const Vec3f e1 = patch.edge[0], e2 = patch.edge[1];
    const float area = dot(cross(e1, e2), hit.ng);
    if (!(std::abs(area) > 0)) return;
    const float cosine = dot(hit.ng, hit.wo);
    const Vec3f tilt = hit.wo - hit.ng * cosine;
    const float sine = length(tilt);
    const Vec3f forward = sine > 1e-4f ? tilt / sine : Frame::from_normal(hit.ng).x;
    const Vec3f along = forward * (width / std::max(std::abs(cosine), kSmallestCosine));
    const Vec3f across = cross(hit.ng, forward) * width;
    for (int set = 0; set < 2; ++set) {
        if (!r.curves && !r.uv[set]) continue;
        const auto [d1, d2] = patch.uv[set];
        const auto in_uv = [&](Vec3f axis) {
            const float u = dot(cross(axis, e2), hit.ng), v = dot(cross(e1, axis), hit.ng);
            return (d1 * u + d2 * v) * (1 / area);
        };
        hit.footprint[set] = {in_uv(across), in_uv(along)};
    }
}

// On a sphere of radius R the normals at two points differ by their distance / R, along the
// line between them.
float mean_curvature(const InstanceRecord& r, const Placement& place, std::uint32_t primitive) {
    if (r.curves) return curve_curvature(r, place, primitive);
    if (!r.normals) return 0;
    const auto& t = r.triangles[primitive];
    float bend = 0, lengths = 0;
    for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const auto normal = [&](std::uint32_t k) {
            return to_float(normalize(place.normal_matrix.vector(to_double(r.normal(place, k)))));
        };
        const Vec3f edge = world_edge(r, place, a, b);
        bend += dot(normal(b) - normal(a), edge);
        lengths += length_squared(edge);
    }
    const float c = bend / lengths;
    return std::isfinite(c) ? c : 0;
}

}  // namespace dg
