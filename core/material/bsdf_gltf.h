// bsdf_gltf.h -- glTF 2.0 metallic-roughness with KHR_materials_{ior, specular,
// transmission, volume}. Source: glTF 2.0 specification, Appendix B, and the extensions'
// own texts:
//   material   = mix(dielectric, metal, metallic)
//   metal      = specular_brdf * (base + (1 - base) s),                    s = (1 -
//   |V.H|)^5 dielectric = fresnel_mix(base = mix(diffuse, specular_btdf * base,
//   transmission), specular_brdf) F          = F0 + (F90 - F0) s, F90 = specular, F0 =
//   min(((ior - 1) / (ior + 1))^2 specular_color, 1) specular  (ior 0: F0 of 1 before)
// with alpha = roughness^2. As fresnel_mix is linear in its base, the dielectric is a
// mixture of a clear one (weight `transmission`) and an opaque one. Three choices, all
// within what the Appendix leaves to an implementation:
// - Diffuse under specular. (1 - F(V.H)) of the Appendix reflects up to 1.9 times the
// light at grazing
//   angles. Here (1 - E(wo)) (1 - E(wi)) / (1 - mean E), reciprocal and lossless for
//   white (Kelemen and Szirmay-Kalos 2001; Ashikhmin and Shirley 2000), E from
//   ggx_albedo.h.
// - Thin walls (thickness 0): no bending; the transmitted lobe is the reflected one
// mirrored through
//   the surface, with 1 - F(V.H).
// - Volumes: Walter 2007 with 1 / eta^2 (see bsdf_dielectric.h), and Schlick's s replaced
// by the exact
//   Fresnel curve rescaled to [0,1], which also knows total internal reflection.
// - KHR_materials_dispersion: see dispersive.h; F0 follows the index of each wavelength.
// - KHR_materials_diffuse_transmission takes its share of the diffuse lobe, behind the same
//   interface. Into a volume it does not bend, but carries 1 / eta^2 as refraction does, so
//   that light which enters by one lobe and leaves by the other keeps its energy. (So it is
//   not reciprocal there: of light that is diffuse inside, a real surface lets less out.)
// KHR_materials_anisotropy stretches the facets of every specular lobe: alpha along the
// direction is mix(alpha, 1, strength^2). KHR_materials_iridescence puts a film on them:
// F = mix(F, F_film, factor) with thin_film.h in place of the extension's fit to RGB; the
// base's index comes from its F0. What passes is the rest at each wavelength.
#pragma once
#include <optional>

#include "material/bsdf_sample.h"
#include "material/dispersive.h"
#include "material/ggx.h"
#include "material/ggx_albedo.h"
#include "material/thin_film.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// A glTF material at one point, textures and factors multiplied.
struct GltfSurface {
    Spectrum base{1.f};
    float metallic = 0, roughness = 1;
    float ior = 1.5f, specular = 1;  // a dispersive volume: the hero's index
    bool disperses = false;          // such a volume, and the path has all wavelengths
    Spectrum iors{1.5f};             // of the four, if it disperses
    Spectrum specular_color{1.f};
    float transmission = 0;
    float diffuse_transmission = 0;  // share of the diffuse lobe
    Spectrum diffuse_transmission_color{1.f};
    bool volume = false;  // thickness > 0
    Interior interior;
    float anisotropy = 0;  // strength
    Vec3f tangent{};       // unit, where the roughness grows; set if anisotropy > 0
    float iridescence = 0;
    ThinFilm film{};
};

/// F of iridescence: what a film on the dielectric and on the metal reflects.
struct FilmFresnel {
    ThinFilm film;
    float factor;
    float metal, dielectric;  // weights in what reflects like the opaque surface
    float specular;
    Spectrum metal_ior, dielectric_ior;

    /// `f0` of the dielectric with `specular` in it; `opaque` is the weight it has.
    FilmFresnel(const GltfSurface& surface, Spectrum f0, float opaque);
    Spectrum on_dielectric(float cos_h) const {
        return specular * film.reflectance(cos_h, dielectric_ior);
    }
    /// The opaque surface, of which `plain` is reflected without a film.
    Spectrum mixed(Spectrum plain, float cos_h) const;
};

struct GltfBsdf {
    enum class Clear : unsigned char { none, thin, volume };

    Vec3f ns, ng;
    float alpha;
    bool smooth;        // the specular lobes are deltas
    bool has_specular;  // false: Lambert alone
    Clear clear;
    Spectrum diffuse;      // base colour of the diffuse lobe, Kelemen's mean included
    float diffuse_albedo;  // mean over wavelengths, mean not included; 0: no diffuse lobe
    Spectrum through{0.f};    // as `diffuse`, of the diffuse lobe on the far side
    float through_share = 0;  // of the two diffuse lobes together
    bool bends = false;       // a volume that light enters
    Spectrum r0, r90_r0;   // reflection that follows Schlick: r0 + r90_r0 s
    Spectrum f0;           // dielectric F0, of the clear part
    float f90, f0_max;
    float clear_weight;    // (1 - metallic) transmission
    Spectrum transmitted;  // its colour
    float ior, f0_ior;     // the hero's, where the volume disperses
    bool disperses;        // what is bent is the hero's alone
    Spectrum iors;
    GgxAlbedo::Row row;
    Spectrum coupling;         // albedo E_c of the interface above the diffuse lobe
    Spectrum specular_albedo;  // estimate, all specular lobes together
    Interior inside;
    std::optional<StretchedGgx> stretched;
    std::optional<FilmFresnel> film;

    GltfBsdf(const GltfSurface& surface, Vec3f ns, Vec3f ng);

    /// Facts that wo alone decides, for whoever asks for several wi.
    struct Seen {
        Vec3f wo;
        Facing side;
        float diffuse_probability = 0, interface = 0;  // E_c(wo)
    };
    Seen seen_from(Vec3f wo) const;
    Evaluation evaluate_with_pdf(const Seen& seen, Vec3f wi) const;
    std::optional<BsdfSample> sample(const Seen& seen, float u_lobe, Vec2f u) const;

    Evaluation evaluate_with_pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(seen_from(wo), wi); }
    std::optional<BsdfSample> sample(Vec3f wo, float u_lobe, Vec2f u) const { return sample(seen_from(wo), u_lobe, u); }
    Spectrum evaluate(Vec3f wo, Vec3f wi) const {
        return evaluate_with_pdf(wo, wi).f_cos;
    }
    float pdf(Vec3f wo, Vec3f wi) const { return evaluate_with_pdf(wo, wi).pdf; }
    static constexpr bool kOneLobe = false;
    bool is_specular() const { return smooth && diffuse_albedo == 0; }
    /// Estimate of the share of light from wo that is scattered, for choosing lobes.
    float albedo_estimate(Vec3f wo) const;
    Interior interior() const { return inside; }
    bool bounds_volume() const { return bends; }
    Spectrum straight_transmittance(Vec3f wo) const;
    float reversed(Vec3f, Vec3f) const { return 1; }
    float diffuse_share(Vec3f wo, Vec3f wi) const;

  private:
    /// Split of light at a facet whose normal makes cos_h with wo: colours, and the chance to
    /// reflect.
    struct Split {
        Spectrum reflected, transmitted{0.f};
        float reflect_probability = 1;
    };
    Split split(float cos_h, float eta) const;
    void disperse(const GltfSurface& surface);
    Spectrum dispersed_reflectance(float cos_h, bool front) const;
    Facet reflecting(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const;
    Facet refracting(const Facing& side, Vec3f wo, Vec3f wi, float cos_i) const;
    Vec3f sample_facet(Vec3f n, Vec3f wo, Vec2f u) const;
    void stretch(const GltfSurface& surface);
    float eta(bool front) const {
        return !bends ? 1.f : front ? ior : 1 / ior;
    }
    Evaluation evaluate_diffuse(const Seen& seen, Vec3f wi, float cos_i) const;
    LobeAlbedo lobe_albedo(Vec3f w, float cos_w) const {
        return stretched ? stretched_row(w).at(cos_w) : row.at(cos_w);
    }
    GgxAlbedo::Row stretched_row(Vec3f w) const;
    Evaluation evaluate_through(const Seen& seen, Vec3f wi, float cos_i, float eta) const;
    void set_through(const GltfSurface& surface, float weight, float entering);
};

}  // namespace dg
