// facets.h -- GGX facets of two roughnesses about a normal, as materials other than glTF's have them.
#pragma once
#include "material/bsdf_sample.h"
#include "material/ggx.h"

namespace dg {

struct Facets {
    StretchedGgx ggx;   // about the shading normal
    bool smooth = true;

    Facets() = default;
    /// `tangent`: unit, across the normal, where alpha_u counts.
    Facets(Vec3f normal, Vec3f tangent, float alpha_u, float alpha_v)
        : ggx{tangent, cross(normal, tangent), std::max(alpha_u, kSmoothAlpha), std::max(alpha_v, kSmoothAlpha)},
          smooth(alpha_u < kSmoothAlpha && alpha_v < kSmoothAlpha) {}

    Vec3f sample_visible(Vec3f n, Vec3f wo, Vec2f u) const {
        return sample_visible_normal(Frame{ggx.tangent, ggx.bitangent, n}, wo, Vec2f{ggx.alpha_t, ggx.alpha_b}, u);
    }
};

}  // namespace dg
