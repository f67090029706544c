// hit.h -- a surface point with all that shading needs, in the world frame.
#pragma once
#include <cstdint>

#include "math/vec.h"

namespace dg {

/// Footprint of a ray's cone on a surface, in texture coordinates: the two axes (whole, not
/// half) of an ellipse. 0: a point.
struct UvFootprint {
    Vec2f across, along;
};

struct SurfaceHit {
    Vec3f position;  // m
    Vec3f ng;        // unit geometric normal, as the winding gives it (front side)
    Vec3f ns;        // unit shading normal, same hemisphere as ng
    /// Unit, along +u (glTF tangent if given), orthogonal to ns; set only for normal maps
    /// and anisotropy.
    Vec3f tangent;
    float tangent_sign = 1;  // bitangent = tangent_sign * cross(ns, tangent)
    Vec2f uv[2];
    UvFootprint footprint[2];         // of either uv set
    float slope_variance = 0;       // of a normal map under the footprint; shade() sets it
    float color[4] = {1, 1, 1, 1};  // vertex colour, linear RGBA
    Vec3f wo;                       // unit, toward where the ray came from
    float t = 0;                    // m along the ray
    float time = 0;                 // that of the ray
    std::uint32_t instance = 0, primitive = 0;
    bool front = true;  // dot(ng, wo) > 0
    float choice = 0;   // of a mixture: random number in [0, 1) that chooses the part
    float error =
        0;  // m; offset for rays that leave here (scaled to the magnitude of position)
};

}  // namespace dg
