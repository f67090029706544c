// embree_rounds.h -- straight segments of curves, as user geometries.
//
// Embree has such segments of its own (round linear curves), but finds their surface in single
// precision, off by the square of length over radius: by 1 % of the radius where a segment is 600
// times as long as thick, and nowhere near a power line.
#pragma once
#include "geometry/embree_device.h"
#include "geometry/mesh.h"

namespace dg::embree {

/// Data of the callbacks. Filters are called as Embree calls them; null: none.
struct RoundSegments {
    const Mesh* mesh;
    void* owner = nullptr;  // user pointer of the filters
    RTCFilterFunctionN on_hit = nullptr, on_shadow = nullptr;
};

/// Keeps a pointer to `segments`. Hits bring segment and CurvePlace as primID, u and v.
GeometryOwner geometry_of(Device& device, RoundSegments& segments);

}  // namespace dg::embree
