// bsdf_layered.h -- layers on a glTF material: sheen (KHR_materials_sheen), and a clear coat above it
// (KHR_materials_clearcoat). Formulas of the extensions:
//   sheen  = colour D V + base min(1 - m E(wo), 1 - m E(wi)),   m = largest of colour
//   coated = mix(sheen, specular_brdf, factor F(|Nc.V|)),       F = 0.04 + 0.96 s
// with D, V and E of charlie.h. Sheen over the base is reciprocal. The coat is not: following the extension, the mix
// depends only on wo, so paths from the camera conserve energy for any base.
#pragma once
#include <optional>

#include "material/bsdf_gltf.h"
#include "material/charlie.h"

namespace dg {

inline constexpr float kCoatF0 = 0.04f, kCoatIor = 1.5f;

/// Share of a clear coat of weight `factor` in the light reflected toward a direction.
inline float coat_share(float factor, float cos_o) {
    return factor * (kCoatF0 + (1 - kCoatF0) * schlick(std::abs(cos_o)));
}

/// The coat at a hit.
struct Coat {
    Vec3f ns;  // shading normal of the coat
    float factor = 0, alpha = 0;
    bool smooth() const { return alpha < kSmoothAlpha; }
    Evaluation evaluate_with_pdf(Vec3f ng, Vec3f wo, Vec3f wi) const;
};

/// The sheen at a hit; `largest` is m in the formula.
struct Sheen {
    Spectrum color{0.f};
    float largest = 0, alpha = 1;
    CharlieAlbedo::Row row;

    Sheen() = default;
    Sheen(Spectrum color, float largest, float roughness);
    bool present() const { return largest > 0; }
    /// f |cos wi|; `ns`: shading normal on the side of both directions.
    Spectrum evaluate(Vec3f ns, Vec3f wo, Vec3f wi, float cos_o, float cos_i) const;
    /// Factor on the base for these two cosines.
    float passed(float cos_o, float cos_i) const;
    float albedo(float cos_o) const { return std::min(1.f, row.at(cos_o)); }
};

struct LayeredBsdf {
    GltfBsdf base;
    Coat coat;
    Sheen sheen;

    LayeredBsdf(const GltfSurface& surface, Vec3f ns, Vec3f ng, const Coat& coat,
                const Sheen& sheen)
        : base(surface, ns, ng), coat(coat), sheen(sheen) {}

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const;
    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const;
    Spectrum evaluate(Vec3f wo, Vec3f wi) const {
        return evaluate_with_pdf(wo, wi).f_cos;
    }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }
    static constexpr bool kOneLobe = false;
    bool is_specular() const {
        return base.is_specular() && !sheen.present() &&
               (coat.factor == 0 || coat.smooth());
    }
    Interior interior() const { return base.interior(); }
    bool bounds_volume() const { return base.bounds_volume(); }
    /// The base's transmittance, reduced by coat and sheen.
    Spectrum straight_transmittance(Vec3f wo) const;
    float reversed(Vec3f wo, Vec3f wi) const;
    /// Sheen counts as diffuse, the coat as glossy.
    float diffuse_share(Vec3f wo, Vec3f wi) const;

  private:
    /// Share of the coat for wo, and the sampling probabilities of coat, sheen and base.
    struct Shares {
        float coat, coat_probability, sheen_probability, base_probability;
    };
    Shares shares(Vec3f wo) const;
    std::optional<BsdfSample> weighed(BsdfSample s, Vec3f wo) const;
    std::optional<BsdfSample> sample_coat(const Shares& p, Vec3f wo, Vec2f u) const;
    std::optional<BsdfSample> sample_base(const Shares& p, Vec3f wo, float u_lobe,
                                          Vec2f u) const;
};

}  // namespace dg
