// bsdf_coated.h -- a clear dielectric coat, smooth or rough, over a diffuse surface or a metal.
//
// E(w) is the reflectance of the coat's outside for light from w, T = 1 - E its transmittance, M the mean of E, n the
// coat's index, and K = 1 - (1 - M) / n^2 the reflectance of its inside for diffuse light. Light is reflected back and
// forth between coat and base.
// - Diffuse base of reflectance p: f = T(o) T(i) p / (pi n^2 (1 - p K)), which is exact for a smooth coat, reciprocal,
//   and loses nothing for p = 1 (Wolff 1994, Diffuse-Reflectance Model for Smooth Dielectric Surfaces; Kubelka's
//   series). Linear: p / (1 - K) in place of p / (1 - p K), as in Mitsuba's plastic.
// - Metal: light reaches its facets in directions refracted at the coat's mean surface, f_b(o', i'), so that
//   f = T(o) T(i) f_b / (n^2 (1 - R min(E(o), E(i)))) with the metal's reflectance R; exact if both are smooth.
//   The minimum keeps f reciprocal and energy-conserving. The remaining light, which the coat's inside reflects back to
//   the metal, leaves as a diffuse lobe: a(o) a(i) C / (pi A), with a = T times its share, A the mean of a, and
//   C = R^2 G (1 - K) / (1 - R G K) for light that hits the metal at least twice. G is the share that the metal's
//   facets do not block; C = 1 for R = G = 1. A rough coat scatters the refracted light, which increases the metal's
//   effective roughness: alpha'^2 = alpha^2 + (1 - 1 / n)^2 alpha_coat^2 / 2 for small slopes.
// - Absorbing coat: a factor exp(-depth / cos') for each pass at the refracted cosine; light reflected by the inside
//   passes twice more.
// E of a rough coat is from glass_albedo.h, so light blocked by its facets counts as transmitted. Without compensation
// that light is lost: T = 1 - E - m and K = 1 - m' - T_mean / n^2, where m and the mean m' are the shares that facets
// block outside and inside.
#pragma once
#include <optional>

#include "material/bsdf_metal.h"
#include "material/glass_albedo.h"

namespace dg {

/// Parameters of the coat.
struct ClearCoat {
    float ior = 1.5f;
    Facets facets;
    Spectrum tint{1.f};    // factor on the coat's reflection
    Spectrum depth{0.f};   // optical depth: absorption times thickness
    bool linear = false;   // no colour shift by inter-reflections
    bool compensated = true;   // light blocked by its facets is not lost
};

/// The base: diffuse, or a metal with an index relative to the coat's.
struct CoatedBase {
    bool metal = false;
    Spectrum diffuse{0.f};
    MetalReflectance reflectance{};
    Facets facets{};
};

class CoatedBsdf {
  public:
    Vec3f ns, ng;

    CoatedBsdf(Vec3f ns, Vec3f ng, const ClearCoat& coat, const CoatedBase& base);

    static constexpr bool kOneLobe = false;
    bool is_specular() const { return coat_.facets.smooth && base_.metal && base_.facets.smooth; }
    float diffuse_share(Vec3f wo, Vec3f wi) const;
    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const;
    Spectrum evaluate(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).f_cos; }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }
    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const;
    Interior interior() const { return {}; }
    bool bounds_volume() const { return false; }
    Spectrum straight_transmittance(Vec3f) const { return 0.f; }
    float reversed(Vec3f, Vec3f) const { return 1; }

  private:
    /// A direction refracted by the coat, and its shares of light.
    struct Bent {
        float outside = 0, inside = 0;   // cosines
        float reflected = 0;             // E
        float entering = 0;              // T
        float caught = 0;                // a: share of the diffuse lobe
        Spectrum passed{0.f};            // T times the absorption of a pass
    };
    Bent bent(Vec3f w, float cos_w) const;
    Vec3f into(Vec3f n, Vec3f w, const Bent& b) const { return (w - n * b.outside) * (1 / coat_.ior) + n * b.inside; }
    float coat_probability(const Bent& o) const;
    Spectrum to_and_fro() const;
    Spectrum below_mirrored(const Bent& o) const;
    Evaluation coat_lobe(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const;
    Evaluation diffuse_lobe(const Bent& o, const Bent& i) const;
    Evaluation metal_lobe(const Facing& side, Vec3f wo, Vec3f wi, const Bent& o, const Bent& i) const;
    float interreflection_probability(const Bent& o) const;
    /// The diffuse lobe of light that the coat reflects back to the metal.
    Evaluation interreflection_lobe(const Bent& o, const Bent& i) const;
    void catch_below();
    std::optional<BsdfSample> mirrored(const Facing& side, Vec3f wo, Spectrum share, float probability) const;
    std::optional<Vec3f> sample_metal(const Facing& side, Vec3f wo, const Bent& o, Vec2f u) const;

    ClearCoat coat_;
    CoatedBase base_;
    std::optional<GlassAlbedo> rough_;      // only for a rough coat
    std::optional<CaughtBelow> caught_;     // only for a metal
    Spectrum interreflection_{0.f};         // C / A
    Spectrum diffuse_;                      // p / (n^2 (1 - p K)), without 1 / pi
    float passed_mean_ = 1;                 // T_mean: 1 - M
    float lost_inside_ = 0;                 // m'
    bool absorbs_;
};

}  // namespace dg
