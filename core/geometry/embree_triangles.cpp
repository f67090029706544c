// embree_triangles.cpp -- mesh arrays for Embree, shared where that is safe.
#include "geometry/embree_triangles.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "geometry/layout.h"

namespace dg::embree {
namespace {

/// Whether the bytes past the end of an array can be read: memory is mapped in pages (of 4096 bytes
/// or a multiple), so the page that contains the end is readable as a whole.
bool readable_behind(const void* end, std::size_t bytes) {
    constexpr std::uintptr_t kPage = 4096;
    const std::uintptr_t used = reinterpret_cast<std::uintptr_t>(end) % kPage;
    return used != 0 && used + bytes <= kPage;
}

GeometryOwner without_vertices(Device& device, const Mesh& mesh) {
    GeometryOwner geometry =
        device.new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE, "mesh '" + mesh.name + "'");
    rtcSetGeometryBuildQuality(geometry.get(), kBuildQuality);
    rtcSetGeometryTimeStepCount(geometry.get(), mesh.steps);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(mesh.triangles[0]),
                               mesh.triangles.size());
    return geometry;
}

std::span<const Vec3f> positions_at(const Mesh& mesh, std::uint32_t step) {
    return {mesh.positions.data() + step * mesh.vertex_count(), mesh.vertex_count()};
}

/// Allocates vertices of a time step in Embree's memory.
Vec3f* new_vertices(Device& device, RTCGeometry geometry, const Mesh& mesh, std::uint32_t step) {
    void* copy = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step,
                                         RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                         mesh.vertex_count());
    device.check("vertices of mesh '" + mesh.name + "'");
    return static_cast<Vec3f*>(copy);
}

}  // namespace

GeometryOwner triangles_of(Device& device, const Mesh& mesh) {
    GeometryOwner geometry = without_vertices(device, mesh);
    for (std::uint32_t step = 0; step < mesh.steps; ++step) {
        const auto p = positions_at(mesh, step);
        if (step + 1 < mesh.steps || readable_behind(p.data() + p.size(), 4)) {
            // Embree reads 16 bytes at the last vertex
            rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, step,
                                       RTC_FORMAT_FLOAT3, p.data(), 0, sizeof(Vec3f), p.size());
        } else {
            std::ranges::copy(p, new_vertices(device, geometry.get(), mesh, step));
        }
    }
    return geometry;
}

GeometryOwner world_triangles_of(Device& device, const Mesh& mesh,
                                 const Affine3f& world_from_local) {
    if (is_identity(world_from_local)) return triangles_of(device, mesh);
    GeometryOwner geometry = without_vertices(device, mesh);
    for (std::uint32_t step = 0; step < mesh.steps; ++step) {
        Vec3f* world = new_vertices(device, geometry.get(), mesh, step);
        for (Vec3f p : positions_at(mesh, step)) *world++ = world_from_local.point(p);
    }
    return geometry;
}

}  // namespace dg::embree
