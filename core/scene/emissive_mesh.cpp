// emissive_mesh.cpp -- converts emissive meshes to triangle lights.
#include "scene/emissive_mesh.h"

#include <algorithm>

#include "material/material_needs.h"
#include "scene/footprint.h"

namespace dg {
namespace {

// Largest number of points per edge of the lattice that measures a textured triangle.
constexpr int kLargestLattice = 32;
// Lower bound of the emission of textured triangles that the lattice does not resolve, relative to the largest possible
// emission, so that light sampling reaches every lit texel.
constexpr float kUnseenShare = 1e-3f;

/// Number of steps along an edge with a spacing of at most one texel.
int texel_steps(const InstanceRecord& r, const TextureSlot& slot,
                const std::vector<Texture>& textures, std::uint32_t primitive) {
    const Texture& texture = textures[slot.index];
    const Vec2f* uv = r.uv[slot.uv_set];
    if (!uv) return 1;
    float longest = 0;
    const auto& t = r.triangles[primitive];
    for (int i = 0; i < 3; ++i) {
        const Vec2f d = slot.transform(uv[t[i]]) - slot.transform(uv[t[(i + 1) % 3]]);
        longest = std::max(longest, std::max(std::abs(d.x) * texture.width,
                                             std::abs(d.y) * texture.height));
    }
    return longest < 1e6f ? std::max(1, static_cast<int>(std::ceil(longest))) : 1'000'000;
}

struct Measured {
    Rgb mean{0, 0, 0};  // mean of the brighter side
    bool front = false, back = false;
    bool even = false;  // emission equals the mean at every point
};

bool has_emission_texture(const Material& material) {
    return std::ranges::any_of(emission_textures(material), &TextureSlot::used);
}

/// Whether opacity is constant.
bool same_opacity(const InstanceRecord& record, const Material& material, const std::vector<Texture>& textures) {
    if (!has_cutout(material, textures)) return true;
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (material.opacity_texture.used() || is_mixture(material)) return false;
    return !m || m->alpha_mode == GltfMaterial::AlphaMode::opaque ||
           (!m->base_color_texture.used() && !record.colors);
}

/// Whether emission and opacity are independent of point and direction.
bool same_everywhere(const InstanceRecord& record, const Material& material, const std::vector<Texture>& textures) {
    const auto* m = std::get_if<GltfMaterial>(&material.kind);
    if (m && m->unlit && record.colors) return false;
    return !has_emission_texture(material) && !emission_is_coated(material) &&
           same_opacity(record, material, textures);
}

/// Number of points per edge that resolves every texel, at least 2.
int wanted_steps(const InstanceRecord& record, const Material& material, const std::vector<Texture>& textures,
                 std::uint32_t primitive) {
    if (!has_emission_texture(material)) return 2;
    int steps = 1;
    for (const TextureSlot& slot : emission_textures(material))
        if (slot.used()) steps = std::max(steps, texel_steps(record, slot, textures, primitive));
    return steps;
}

Measured measure(const InstanceRecord& record, const Material& material, bool changes,
                 const std::vector<Texture>& textures, std::uint32_t primitive) {
    if (!changes && same_everywhere(record, material, textures)) {
        const Vec2f anywhere{0, 0};
        const Rgb front =
            emission_at(record, material, textures, {primitive, anywhere, true});
        const Rgb back =
            emission_at(record, material, textures, {primitive, anywhere, false});
        Measured m{front, max_component(front) > 0, max_component(back) > 0};
        if (m.back && max_component(back) > max_component(front)) m.mean = back;
        m.even = m.front && (!m.back || front == back);
        return m;
    }
    const int wanted = wanted_steps(record, material, textures, primitive);
    const int n = std::min(wanted, kLargestLattice);
    Rgb sums[2]{};
    int count = 0;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n - i; ++j, ++count) {
            const Vec2f b{float(i) / float(n), float(j) / float(n)};
            for (int side = 0; side < 2; ++side) {
                sums[side] +=
                    emission_at(record, material, textures, {primitive, b, side == 0});
            }
        }
    }
    Measured m;
    m.front = max_component(sums[0]) > 0;
    m.back = max_component(sums[1]) > 0;
    if (wanted > n || changes) {
        const Rgb least = emission_factor(material) * kUnseenShare;
        for (Rgb& s : sums) {
            s = {std::max(s.x, least.x * count), std::max(s.y, least.y * count),
                 std::max(s.z, least.z * count)};
        }
        m.front = true;
        m.back = m.back || emits_from_behind(material);
    }
    const bool brighter_back = m.back && max_component(sums[1]) > max_component(sums[0]);
    m.mean = sums[brighter_back ? 1 : 0] / float(count);
    return m;
}

}  // namespace

Rgb emission_at(const InstanceRecord& record, const Material& material,
                const std::vector<Texture>& textures, const TrianglePoint& point,
                std::optional<Vec3f> toward, float width) {
    const auto& [primitive, barycentric, front, time] = point;
    SurfaceHit hit;
    hit.time = time;
    hit.front = front;
    if (width != 0 || emission_is_coated(material)) {
        PlacementRoom made;
        const Placement& placement = record.placement(time, made);
        surface_at(record, placement, primitive, barycentric.x, barycentric.y, hit);
        hit.primitive = primitive;
        hit.wo = toward.value_or(front ? hit.ng : -hit.ng);
        if (width != 0) set_footprint(record, placement, width, hit);
    } else {
        interpolate_attributes(record, primitive, barycentric.x, barycentric.y, hit);
    }
    const Rgb full = emitted(material, textures, hit);
    if (max_component(full) <= 0) return {0, 0, 0};
    return full * opacity(material, textures, hit.uv, hit.color[3], time);
}

void append_emissive_triangles(const InstanceRecord& record, std::uint32_t instance,
                               std::size_t triangle_count, const Material& material,
                               bool changes, const std::vector<Texture>& textures,
                               std::vector<Light>& lights, std::optional<float> peak) {
    if (!emits(material) || peak == 0.f) return;
    for (std::uint32_t i = 0; i < triangle_count; ++i) {
        const auto [a, b, c] = corners_at(record, record.still, i);
        TriangleLight light{a, b, c, {}, instance, i, false, record.still.mirrored};
        if (!record.changes() && !(length(cross(b - a, c - a)) > 0)) continue;
        const Measured m = measure(record, material, changes, textures, i);
        if (!m.front && !m.back) continue;
        light.mean_luminance = m.mean * peak.value_or(1.f);
        light.two_sided = m.back;
        light.even = m.even && !peak;
        lights.push_back(light);
    }
}

}  // namespace dg
