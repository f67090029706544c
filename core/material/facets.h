// facets.h -- anisotropic facets around a normal, GGX or Beckmann, for materials other than glTF's.
#pragma once
#include <cstdint>

#include "material/bsdf_sample.h"
#include "material/ggx.h"

namespace dg {

enum class Distribution : std::uint8_t { ggx, beckmann };

struct Facets {
    StretchedGgx ggx;   // around the shading normal; also holds the parameters of Beckmann facets
    bool smooth = true;
    Distribution distribution = Distribution::ggx;

    Facets() = default;
    /// `tangent`: unit, perpendicular to the normal, direction of alpha_u.
    Facets(Vec3f normal, Vec3f tangent, float alpha_u, float alpha_v, Distribution distribution = Distribution::ggx)
        : ggx{tangent, cross(normal, tangent), std::max(alpha_u, kSmoothAlpha), std::max(alpha_v, kSmoothAlpha)},
          smooth(alpha_u < kSmoothAlpha && alpha_v < kSmoothAlpha), distribution(distribution) {}

    Facet reflecting(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i) const {
        if (distribution == Distribution::ggx) return reflecting_facet(n, wo, wi, cos_o, cos_i, ggx);
        return reflecting_beckmann(n, wo, wi, cos_o, cos_i);
    }
    Facet refracting(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i, float eta) const {
        if (distribution == Distribution::ggx) return refracting_facet(n, wo, wi, cos_o, cos_i, ggx, eta);
        return refracting_beckmann(n, wo, wi, cos_o, cos_i, eta);
    }
    Vec3f sample_visible(Vec3f n, Vec3f wo, Vec2f u) const {
        if (distribution == Distribution::beckmann) return sample_beckmann(n, wo, u);
        return sample_visible_normal(Frame{ggx.tangent, ggx.bitangent, n}, wo, Vec2f{ggx.alpha_t, ggx.alpha_b}, u);
    }

  private:   // not inlined, which would slow down GGX
    Facet reflecting_beckmann(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i) const;
    Facet refracting_beckmann(Vec3f n, Vec3f wo, Vec3f wi, float cos_o, float cos_i, float eta) const;
    Vec3f sample_beckmann(Vec3f n, Vec3f wo, Vec2f u) const;
};

}  // namespace dg
