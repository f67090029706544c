// emissive_mesh.h -- emissive meshes become triangle lights.
#pragma once
#include "light/light.h"
#include "scene/instance_record.h"

namespace dg {

/// A point of one side of a triangle, at a time of the interval.
struct TrianglePoint {
    std::uint32_t primitive;
    Vec2f barycentric;
    bool front;
    float time = 0;
};

/// Emission (cd/m2) of a point of the triangle toward its front or back, as a ray that
/// hits it would find it on average: with texture, vertex colour and opacity. `toward` is
/// where it is seen from, for a clear coat; without it, along the normal. `width` (m): of the
/// ray's cone there, across it; textures are read as it covers them.
Rgb emission_at(const InstanceRecord& record, const Material& material,
                const std::vector<Texture>& textures, const TrianglePoint& point,
                std::optional<Vec3f> toward = {}, float width = 0);

/// Appends a light for each triangle of the instance that has area and emits anywhere. Of a
/// material that `changes`, `material` is its brightest: where that says nothing of a point
/// (textures move), the light is kept all the same, and never taken for even. `peak`: largest factor of
/// its profile, if it has one; then it is never even either.
void append_emissive_triangles(const InstanceRecord& record, std::uint32_t instance,
                               std::size_t triangle_count, const Material& material, bool changes,
                               const std::vector<Texture>& textures,
                               std::vector<Light>& lights, std::optional<float> peak = {});

}  // namespace dg
