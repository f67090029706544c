// embree_rounds.h -- straight segments of curves, as user geometries.
//
// Embree's round linear curves are computed in single precision, with an error of the square of
// length over radius: 1 % of the radius for a segment 600 times as long as thick, and useless for a
// power line.
#pragma once
#include "geometry/embree_device.h"
#include "geometry/mesh.h"

namespace dg::embree {

/// User data of the callbacks. Filters have Embree's signature; null: none.
struct RoundSegments {
    const Mesh* mesh;
    void* owner = nullptr;  // user pointer of the filters
    RTCFilterFunctionN on_hit = nullptr, on_shadow = nullptr;
};

/// Keeps a pointer to `segments`. Hits store segment and CurvePlace as primID, u and v.
GeometryOwner geometry_of(Device& device, RoundSegments& segments);

}  // namespace dg::embree
