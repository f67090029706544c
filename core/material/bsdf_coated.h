// bsdf_coated.h -- a clear dielectric coat, smooth or rough, over a diffuse surface or a metal.
//
// E(w) is the share of light from w that the coat's outside reflects, of which it lets T = 1 - E in; M is the mean of
// E, n the coat's index, and K = 1 - (1 - M) / n^2 the share of diffuse light that its inside reflects. Light goes
// back and forth between coat and base.
// - Diffuse base of reflectance p: f = T(o) T(i) p / (pi n^2 (1 - p K)), which is exact for a smooth coat, reciprocal,
//   and loses nothing for p = 1 (Wolff 1994, Diffuse-Reflectance Model for Smooth Dielectric Surfaces; Kubelka's
//   series). Linear: p / (1 - K) in place of p / (1 - p K), as Mitsuba's plastic has it.
// - Metal: its facets are met in directions that the coat's mean surface has bent, f_b(o', i'), so that
//   f = T(o) T(i) f_b / (n^2 (1 - R min(E(o), E(i)))) with the metal's reflectance R; exact where both are smooth.
//   The minimum keeps f reciprocal and within what is let in. The rest, which the coat's inside reflects back to the
//   metal, leaves evenly: a(o) a(i) C / (pi A), a = T times its share, A the mean of a, and
//   C = R^2 G (1 - K) / (1 - R G K) of the light that meets the metal twice and more, with the share G that its facets
//   let pass; C = 1 for a metal of R = G = 1. A rough coat bends light by slopes of its own, which
//   adds to the metal's roughness: alpha'^2 = alpha^2 + (1 - 1 / n)^2 alpha_coat^2 / 2 for small slopes.
// - A coat that absorbs: exp(-depth / cos') on each way at the bent cosine; light that the inside reflects passes it
//   twice more.
// E of a rough coat is glass_albedo.h's, so that light which the facets block goes in. Without compensation it is
// lost: T = 1 - E - m and K = 1 - m' - T_mean / n^2, with the shares m and mean m' that the facets block outside and
// inside.
#pragma once
#include <optional>

#include "material/bsdf_metal.h"
#include "material/glass_albedo.h"

namespace dg {

/// The coat.
struct ClearCoat {
    float ior = 1.5f;
    Facets facets;
    Spectrum tint{1.f};    // of what the coat reflects
    Spectrum depth{0.f};   // optical depth: absorption times thickness
    bool linear = false;   // no colour by light that goes back and forth
    bool compensated = true;   // of light that its facets block
};

/// The surface below: diffuse, or a metal whose index is relative to the coat's.
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
    /// A direction as the coat bends it, and what it loses there.
    struct Bent {
        float outside = 0, inside = 0;   // cosines
        float reflected = 0;             // E
        float entering = 0;              // T
        float caught = 0;                // a, what the coat takes aside
        Spectrum passed{0.f};            // and the way down
    };
    Bent bent(Vec3f w, float cos_w) const;
    Vec3f into(Vec3f n, Vec3f w, const Bent& b) const { return (w - n * b.outside) * (1 / coat_.ior) + n * b.inside; }
    float coat_probability(const Bent& o) const;
    Spectrum to_and_fro() const;
    Spectrum below_mirrored(const Bent& o) const;
    Evaluation coat_lobe(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const;
    Evaluation diffuse_lobe(const Bent& o, const Bent& i) const;
    Evaluation metal_lobe(const Facing& side, Vec3f wo, Vec3f wi, const Bent& o, const Bent& i) const;
    float even_probability(const Bent& o) const;
    Evaluation even_lobe(const Bent& o, const Bent& i) const;
    void catch_below();
    std::optional<BsdfSample> mirrored(const Facing& side, Vec3f wo, Spectrum share, float probability) const;
    std::optional<Vec3f> sample_metal(const Facing& side, Vec3f wo, const Bent& o, Vec2f u) const;

    ClearCoat coat_;
    CoatedBase base_;
    std::optional<GlassAlbedo> rough_;      // of a rough coat
    std::optional<CaughtBelow> caught_;     // of a rough metal
    Spectrum even_{0.f};                    // C / A
    Spectrum diffuse_;                      // p / (n^2 (1 - p K)), its pi aside
    float passed_mean_ = 1;                 // T_mean: 1 - M
    float lost_inside_ = 0;                 // m'
    bool absorbs_;
};

}  // namespace dg
