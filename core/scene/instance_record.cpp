// instance_record.cpp -- position, normals, frame and attributes from triangle and barycentrics.
#include "scene/instance_record.h"

#include "material/material_needs.h"
#include "scene/curve_surface.h"

namespace dg {
namespace {

// Positions are interpolated and transformed in double, so the error is the rounding of vertices (flattened) or of the
// ray (instanced) in the ray tracer: a few units in the last place of the largest coordinate. Measured by the test of
// closed meshes, which fails below 0.3 of this.
constexpr float kUlps = 8 * 0x1p-24f;

struct Corners {
    std::uint32_t a, b, c;
};

Corners corners_of(const InstanceRecord& r, std::uint32_t primitive) {
    const auto& t = r.triangles[primitive];
    return {t[0], t[1], t[2]};
}

/// Largest row sum of |entries|: bound of the factor by which a linear map scales a coordinate.
double row_norm(Vec3d x, Vec3d y, Vec3d z) {
    double norm = 0;
    for (int i = 0; i < 3; ++i) {
        norm = std::max(norm, std::abs(x[i]) + std::abs(y[i]) + std::abs(z[i]));
    }
    return norm;
}

Vec3f unit_or(Vec3f v, Vec3f fallback) {
    const float l2 = length_squared(v);
    return l2 > 1e-30f ? v * (1 / std::sqrt(l2)) : fallback;  // false for NaN, too
}

/// Direction of +u on the triangle, with the handedness of -v (in glTF v points down and green points up). Empty for
/// degenerate uv.
struct UvFrame {
    Vec3f along_u, along_minus_v;
    bool good;
};
UvFrame uv_frame(const InstanceRecord& r, const Placement& place, Corners t) {
    const Vec2f uv_b = r.tangent_uv[t.b] - r.tangent_uv[t.a];
    const Vec2f uv_c = r.tangent_uv[t.c] - r.tangent_uv[t.a];
    const float det = uv_b.x * uv_c.y - uv_b.y * uv_c.x;
    if (!(std::abs(det) > 0)) return {{}, {}, false};
    const Vec3f a = to_float(r.position(place, t.a));
    const Vec3f e1 = to_float(r.position(place, t.b)) - a,
                e2 = to_float(r.position(place, t.c)) - a;
    const float sign = std::copysign(1.f, det);  // without scale
    const Vec3f du = (e1 * uv_c.y - e2 * uv_b.y) * sign;
    const Vec3f dv = (e2 * uv_b.x - e1 * uv_c.x) * sign;
    auto world = [&](Vec3f v) {
        return to_float(place.world_from_local.vector(to_double(v)));
    };
    return {world(du), -world(dv), true};
}

void set_tangent(const InstanceRecord& r, const Placement& place, Corners t, float w, float u,
                 float v, SurfaceHit& hit) {
    Vec3f tangent{};
    hit.tangent_sign = 1;
    if (r.tangents) {
        const Vec3f local =
            r.tangent(place, t.a) * w + r.tangent(place, t.b) * u + r.tangent(place, t.c) * v;
        tangent = to_float(place.world_from_local.vector(to_double(local)));
        // Mirroring flips the cross product of normal and tangent.
        const bool turned = r.tangents[place.first_vertex + t.a][3] < 0;
        hit.tangent_sign = turned != place.mirrored ? -1.f : 1.f;
    } else if (r.tangent_uv) {
        const UvFrame frame = uv_frame(r, place, t);
        tangent = frame.along_u;
        if (frame.good && dot(cross(hit.ns, frame.along_u), frame.along_minus_v) < 0) {
            hit.tangent_sign = -1;
        }
    }
    const Vec3f orthogonal =
        unit_or(tangent, {}) - hit.ns * dot(unit_or(tangent, {}), hit.ns);
    hit.tangent = length_squared(orthogonal) > 1e-8f ? normalize(orthogonal)
                                                     : Frame::from_normal(hit.ns).x;
}

Placement place(const Affine3d& m, bool flattened) {
    Placement p{};
    p.world_from_local = m;
    p.mirrored = m.determinant() < 0;
    const double side = p.mirrored ? -1 : 1;  // cofactors, as in Affine::normal
    p.normal_matrix = {
        cross(m.y, m.z) * side, cross(m.z, m.x) * side, cross(m.x, m.y) * side, {}};

    // Adds the rounding of the ray's transform to the mesh's space.
    const Affine3d inv = inverse(m);
    const double there = row_norm(m.x, m.y, m.z), back = row_norm(inv.x, inv.y, inv.z);
    const double growth = flattened ? 1 : 1 + there * back;
    p.error_scale = static_cast<float>(kUlps * growth * there);
    p.error_base = static_cast<float>(kUlps * growth * largest_coordinate(to_float(m.origin)));
    return p;
}

}  // namespace

Placement InstanceRecord::at(float time) const {
    Placement p = motion ? place(motion->at(time), false) : still;
    set_step(p, time);
    return p;
}

Placement InstanceRecord::where(float time) const {
    Placement p{};
    p.world_from_local = motion ? motion->at(time) : still.world_from_local;
    p.mirrored = p.world_from_local.determinant() < 0;
    set_step(p, time);
    return p;
}

void InstanceRecord::set_step(Placement& p, float time) const {
    if (steps == 1) return;
    const MeshStep step = step_at(steps, time);
    p.first_vertex = std::size_t(step.index) * vertex_count;
    p.step_share = step.share;
}

InstanceRecord make_record(const Mesh& mesh, const Material& material,
                           std::uint32_t material_index, const InstanceGeometry& geometry,
                           bool flattened) {
    const bool textured = uses_textures(material);
    InstanceRecord r{};
    r.curves = mesh.curves.empty() ? nullptr : &mesh;
    r.positions = mesh.positions.data();
    r.steps = mesh.steps;
    r.vertex_count = mesh.vertex_count();
    r.triangles = mesh.triangles.data();
    r.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
    for (int set = 0; set < 2; ++set) {
        if (textured && !mesh.uv[set].empty()) r.uv[set] = mesh.uv[set].data();
    }
    const int set = tangent_set(material);
    r.needs_frame = set >= 0;
    r.textured = textured;
    r.mixed = is_mixture(material);
    r.smooth = r.normals && only_reflects(material);
    if (r.needs_frame) {
        r.tangents = mesh.tangents.empty() ? nullptr : mesh.tangents.data();
        r.tangent_uv = mesh.uv[set].empty() ? nullptr : mesh.uv[set].data();
    }
    r.colors = mesh.colors.empty() ? nullptr : mesh.colors.data();
    r.material = material_index;
    r.motion = geometry.motion;
    r.shown = geometry.shown;
    r.still = place(to_double(geometry.world_from_local), flattened);
    return r;
}

std::array<Vec3f, 3> corners_at(const InstanceRecord& r, const Placement& place,
                                std::uint32_t primitive) {
    const Corners t = corners_of(r, primitive);
    const auto world = [&](std::uint32_t i) {
        return to_float(place.world_from_local.point(r.position(place, i)));
    };
    return {world(t.a), world(t.b), world(t.c)};
}

Vec3d point_at(const InstanceRecord& r, std::uint32_t primitive, float u, float v, float time) {
    if (r.curves) return curve_point_at(r, primitive, {u, v}, time);
    const Corners t = corners_of(r, primitive);
    PlacementRoom made;
    const Placement& place = r.placement(time, made);
    const Vec3d a = r.position(place, t.a);
    const Vec3d e1 = r.position(place, t.b) - a, e2 = r.position(place, t.c) - a;
    return place.world_from_local.point(a + e1 * double(u) + e2 * double(v));
}

void interpolate_attributes(const InstanceRecord& r, std::uint32_t primitive, float u,
                            float v, SurfaceHit& hit) {
    if (r.curves) return interpolate_curve(r, primitive, {u, v}, hit);
    const Corners t = corners_of(r, primitive);
    const float w = 1 - u - v;
    for (int set = 0; set < 2; ++set) {
        if (const Vec2f* uv = r.uv[set])
            hit.uv[set] = uv[t.a] * w + uv[t.b] * u + uv[t.c] * v;
    }
    if (!r.colors) return;
    for (int i = 0; i < 4; ++i) {
        hit.color[i] = r.colors[t.a][i] * w + r.colors[t.b][i] * u + r.colors[t.c][i] * v;
    }
}

void surface_at(const InstanceRecord& r, const Placement& place, std::uint32_t primitive, float u,
                float v, SurfaceHit& hit) {
    if (r.curves) return curve_surface_at(r, place, primitive, {u, v}, hit);
    const Corners t = corners_of(r, primitive);
    const Vec3d a = r.position(place, t.a), b = r.position(place, t.b), c = r.position(place, t.c);
    const Vec3d e1 = b - a, e2 = c - a;
    hit.position =
        to_float(place.world_from_local.point(a + e1 * double(u) + e2 * double(v)));
    hit.error =
        place.error_scale *
            float(std::max({largest_coordinate(a), largest_coordinate(b), largest_coordinate(c)})) +
        place.error_base;
    hit.ng = to_float(normalize(place.normal_matrix.vector(cross(e1, e2))));

    const float w = 1 - u - v;
    hit.ns = hit.ng;
    if (r.normals) {
        const Vec3f na = r.normal(place, t.a), nb = r.normal(place, t.b), nc = r.normal(place, t.c);
        const Vec3f n = na * w + nb * u + nc * v;
        hit.ns =
            unit_or(to_float(place.normal_matrix.vector(to_double(unit_or(n, {})))), hit.ng);
        if (dot(hit.ns, hit.ng) < 0) hit.ns = -hit.ns;
        hit.smooth = r.smooth && !(na == nb && nb == nc);
        if (hit.smooth) hit.barycentric[0] = u, hit.barycentric[1] = v;
    }
    if (r.uv[0] || r.uv[1] || r.colors) interpolate_attributes(r, primitive, u, v, hit);
    if (r.needs_frame) set_tangent(r, place, t, w, u, v, hit);
}

}  // namespace dg
