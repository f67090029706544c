// emissive_mesh.h -- converts emissive meshes to triangle lights.
#pragma once
#include "light/light.h"
#include "scene/instance_record.h"

namespace dg {

/// A point on a side of a triangle at a time.
struct TrianglePoint {
    std::uint32_t primitive;
    Vec2f barycentric;
    bool front;
    float time = 0;
};

/// Mean emission (cd/m2) that rays find at a point of the triangle on its front or back, including texture, vertex
/// colour and opacity. `toward`: direction of emission, for a clear coat; default: along the normal. `width` (m): width
/// of the ray cone at the point, for filtered texture lookups.
Rgb emission_at(const InstanceRecord& record, const Material& material,
                const std::vector<Texture>& textures, const TrianglePoint& point,
                std::optional<Vec3f> toward = {}, float width = 0);

/// Appends a light for each triangle of the instance with a positive area and emission. If the material `changes`,
/// `material` is its brightest state; triangles are then added even if they appear dark, as textures may move, and
/// count as uneven. `peak`: largest factor of its profile, if it has one; such triangles count as uneven, too.
void append_emissive_triangles(const InstanceRecord& record, std::uint32_t instance,
                               std::size_t triangle_count, const Material& material, bool changes,
                               const std::vector<Texture>& textures,
                               std::vector<Light>& lights, std::optional<float> peak = {});

}  // namespace dg
