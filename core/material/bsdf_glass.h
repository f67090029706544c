// bsdf_glass.h -- clear glass with features beyond DielectricBsdf: anisotropic facets, tinted reflections, panes, and
// multiple scattering between facets.
//
// A pane has two parallel faces at a negligible distance: light passes it unrefracted, and inter-reflections leave in
// the same two directions. With F of a single face, R = F + (1 - F)^2 F / (1 - F^2) = 2 F / (1 + F) (Stokes 1860, On
// the Intensity of the Light Reflected from or Transmitted through a Pile of Plates). The transmitted lobe of a rough
// pane is its reflected lobe, mirrored at the surface.
//
// The share m(cos) of light that facets block is scattered diffusely, as an approximation of multiple scattering:
// reflected by (1 - T) m(o) m(i) / (pi M), with M the mean of m, and transmitted by T m(o) m'(i) / (pi eta^2 M') with
// m' of the other side (Kulla and Conty 2017, Revisiting Physically Based Shading at Imageworks, SIGGRAPH course). The
// lobe is reciprocal if T M = n^2 T' M'. T = (1 - F_mean) min(M, M') / M satisfies this, since the means of 1 - F have
// the same ratio.
#pragma once
#include <optional>

#include "material/dispersive.h"
#include "material/facets.h"
#include "material/glass_albedo.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// Energy that single scattering at rough glass loses, and the share of it that is transmitted, for both sides.
struct GlassCompensation {
    GlassAlbedo albedo;
    float transmitted_thin = 0, transmitted_dense = 0, transmitted_pane = 0;

    /// `n` >= 1: relative index.
    GlassCompensation(float n, const Facets& facets);
    bool used() const { return albedo.mean().missing_thin > 1e-6f && albedo.mean().missing_dense > 1e-6f; }
};

struct GlassBsdf {
    Vec3f ns, ng;
    Spectrum reflection_tint{1.f}, tint{1.f};
    float ior = 1.5f;  // at the hero wavelength
    bool thin = false;
    bool disperses = false;  // refracted light is for the hero only
    Spectrum iors{1.5f};     // per wavelength
    Facets facets{};
    std::optional<GlassCompensation> compensation{};

    static constexpr bool kOneLobe = false;
    bool is_specular() const { return facets.smooth || (!thin && std::abs(ior - 1) < 1e-3f); }
    float diffuse_share(Vec3f, Vec3f) const { return 0; }
    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const;
    Spectrum evaluate(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).f_cos; }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }
    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const;
    Interior interior() const { return {}; }
    bool bounds_volume() const { return !thin && ior != 1; }
    float reversed(Vec3f, Vec3f) const { return 1; }
    Spectrum straight_transmittance(Vec3f wo) const;

  private:
    /// Fresnel split at a facet with the cosine cos_h to wo, and the probability of reflection.
    struct Split {
        Spectrum reflected, transmitted;
        float probability;
    };
    Split split(float cos_h, float eta, bool front) const;
    Spectrum reflectance(float cos_h, bool front) const;
    float eta(bool front) const { return thin ? 1.f : front ? ior : 1 / ior; }
    Facet joined(const Facing& side, Vec3f wo, Vec3f wi, float cos_i, bool reflected) const;

    /// The diffuse lobe of multiple scattering from wo: its share of light, and its transmitted fraction.
    struct DiffuseCompensation {
        float share = 0, transmitted = 0, mean_here = 1, mean_beyond = 1;
        bool thin_side = true;
    };
    DiffuseCompensation diffuse_compensation(const Facing& side, Vec3f wo) const;
    void add_compensation(const DiffuseCompensation& e, const Facing& side, Vec3f wi, bool reflected,
                          Evaluation& sum) const;
};

}  // namespace dg
