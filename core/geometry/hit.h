// hit.h -- surface interaction with all inputs of shading, in world space.
#pragma once
#include <cmath>
#include <cstdint>

#include "math/vec.h"

namespace dg {

/// Footprint of a ray cone on a surface in texture coordinates: the two full axes of an ellipse. 0:
/// a point.
struct UvFootprint {
    Vec2f across, along;
};

struct SurfaceHit {
    Vec3f position;  // m
    Vec3f ng;        // unit geometric normal on the front side, by winding
    Vec3f ns;        // unit shading normal, same hemisphere as ng
    /// Unit tangent along +u (glTF tangent if given), orthogonal to ns; set only for normal maps
    /// and anisotropy.
    Vec3f tangent;
    float tangent_sign = 1;  // bitangent = tangent_sign * cross(ns, tangent)
    Vec2f uv[2];
    UvFootprint footprint[2];         // per uv set
    float slope_variance = 0;       // of a normal map within the footprint; set by shade()
    float color[4] = {1, 1, 1, 1};  // vertex colour, linear RGBA
    Vec3f wo;                       // unit, toward the ray's origin
    float t = 0;                    // m along the ray
    float time = 0;                 // copied from the ray
    std::uint32_t instance = 0, primitive = 0;
    bool front = true;  // dot(ng, wo) > 0
    bool outside_disperses = false;   // the solid outside the surface disperses light
    bool smooth = false;  // the vertex normals differ and the material only reflects (scene/smooth_surface.h)
    float choice = 0;   // uniform number in [0, 1) that selects the component of a mixture
    float outside_ior = 1;   // index outside the surface, for the hero; other than 1 within another solid
    float error =
        0;  // m; offset of rays that leave the surface (scaled to the magnitude of position)
    float barycentric[2];  // of the second and third vertex; set if smooth
};

/// Replaces both normals by the normal of the smooth surface. Where that faces away from wo, by the nearest that does not.
inline void use_smooth_normal(SurfaceHit& hit) {
    const float g = dot(hit.ng, hit.wo), side = std::copysign(1.f, g), least = 0.1f * std::abs(g);
    const float c = side * dot(hit.ns, hit.wo);
    if (c < least) {
        const Vec3f across = hit.ns * side - hit.wo * c;
        const float l2 = length_squared(across);
        if (!(l2 > 1e-8f)) return;
        hit.ns = (across * std::sqrt((1 - least * least) / l2) + hit.wo * least) * side;
    }
    hit.ng = hit.ns;
}

}  // namespace dg
