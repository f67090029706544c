// bsdf_gltf.h -- glTF 2.0 metallic-roughness with KHR_materials_{ior, specular, transmission, volume}. Source: glTF 2.0
// specification, Appendix B, and the texts of the extensions:
//   material   = mix(dielectric, metal, metallic)
//   metal      = specular_brdf * (base + (1 - base) s), s = (1 - |V.H|)^5
//   dielectric = fresnel_mix(base = mix(diffuse, specular_btdf * base, transmission), specular_brdf)
//   F          = F0 + (F90 - F0) s, F90 = specular,
//   F0         = min(((ior - 1) / (ior + 1))^2 specular_color, 1) specular, with 1 for the square if ior is 0
// with alpha = roughness^2. As fresnel_mix is linear in its base, the dielectric is a mixture of a clear dielectric
// (weight `transmission`) and an opaque dielectric. The Appendix leaves these choices to implementations:
// - Diffuse under specular. (1 - F(V.H)) of the Appendix gains energy at grazing angles, up to a factor of 1.9. Here
//   (1 - E(wo)) (1 - E(wi)) / (1 - mean E), reciprocal and lossless for white (Kelemen and Szirmay-Kalos 2001;
//   Ashikhmin and Shirley 2000), with E from ggx_albedo.h.
// - Thin walls (thickness 0): no refraction; the transmitted lobe is the reflected lobe mirrored at the surface, with
//   1 - F(V.H).
// - Volumes: Walter 2007 with 1 / eta^2 (see bsdf_dielectric.h), and the exact Fresnel curve rescaled to [0,1] in place
//   of Schlick's s, which includes total internal reflection.
// - KHR_materials_dispersion: see dispersive.h; F0 follows the index of each wavelength.
// - KHR_materials_diffuse_transmission takes its share of the diffuse lobe, behind the same interface. Into a volume
//   the lobe is not refracted, but carries 1 / eta^2 like refraction, so that light which enters by one of these lobes
//   and leaves by the other keeps its energy. (It is not reciprocal there: a real surface transmits less of the diffuse
//   light inside.)
// KHR_materials_anisotropy stretches the facets of every specular lobe: alpha along the direction is
// mix(alpha, 1, strength^2). KHR_materials_iridescence adds a film: F = mix(F, F_film, factor) with thin_film.h in
// place of the extension's fit to RGB; the index of the base is derived from its F0. Transmission is 1 - F at each
// wavelength.
#pragma once
#include <optional>

#include "material/bsdf_sample.h"
#include "material/dispersive.h"
#include "material/ggx.h"
#include "material/ggx_albedo.h"
#include "material/thin_film.h"
#include "spectrum/wavelengths.h"

namespace dg {

/// Parameters of a glTF material at a hit, factors times textures.
struct GltfSurface {
    Spectrum base{1.f};
    float metallic = 0, roughness = 1;
    float ior = 1.5f, specular = 1;  // ior: at the hero wavelength
    bool disperses = false;          // dispersive volume, and the path has all wavelengths
    Spectrum iors{1.5f};             // per wavelength, if it disperses
    Spectrum specular_color{1.f};
    float transmission = 0;
    float diffuse_transmission = 0;  // share of the diffuse lobe
    Spectrum diffuse_transmission_color{1.f};
    bool volume = false;  // thickness > 0
    Interior interior;
    float anisotropy = 0;  // strength
    Vec3f tangent{};       // unit, direction of increased roughness; set if anisotropy > 0
    float iridescence = 0;
    ThinFilm film{};
};

/// Fresnel term of iridescence: reflectance of a film on the dielectric and on the metal.
struct FilmFresnel {
    ThinFilm film;
    float factor;
    float metal, dielectric;  // weights in the opaque reflection
    float specular;
    Spectrum metal_ior, dielectric_ior;

    /// `f0`: of the dielectric, including `specular`. `opaque`: weight of the opaque dielectric.
    FilmFresnel(const GltfSurface& surface, Spectrum f0, float opaque);
    Spectrum on_dielectric(float cos_h) const {
        return specular * film.reflectance(cos_h, dielectric_ior);
    }
    /// Reflectance of the opaque surface; `plain`: its reflectance without a film.
    Spectrum mixed(Spectrum plain, float cos_h) const;
};

struct GltfBsdf {
    enum class Clear : unsigned char { none, thin, volume };

    Vec3f ns, ng;
    float alpha;
    bool smooth;        // the specular lobes are deltas
    bool has_specular;  // false: Lambertian only
    Clear clear;
    Spectrum diffuse;      // base colour of the diffuse lobe over 1 - mean E
    float diffuse_albedo;  // mean base colour over wavelengths; 0: no diffuse lobe
    Spectrum through{0.f};    // as `diffuse`, for diffuse transmission
    float through_share = 0;  // share of diffuse transmission in both diffuse lobes
    bool bends = false;       // diffuse transmission enters a volume
    Spectrum r0, r90_r0;   // reflection with Schlick's curve: r0 + r90_r0 s
    Spectrum f0;           // dielectric F0, for the clear part
    float f90, f0_max;
    float clear_weight;    // (1 - metallic) transmission
    Spectrum transmitted;  // colour of the clear part
    float ior, f0_ior;     // at the hero wavelength, if the volume disperses
    bool disperses;        // refracted light is for the hero only
    Spectrum iors;
    GgxAlbedo::Row row;
    Spectrum coupling;         // albedo E_c of the interface above the diffuse lobe
    Spectrum specular_albedo;  // estimate for the sum of all specular lobes
    Interior inside;
    std::optional<StretchedGgx> stretched;
    std::optional<FilmFresnel> film;

    GltfBsdf(const GltfSurface& surface, Vec3f ns, Vec3f ng);

    /// Precomputed values of wo, for several wi.
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
    /// Estimated albedo for wo, for choosing lobes.
    float albedo_estimate(Vec3f wo) const;
    Interior interior() const { return inside; }
    bool bounds_volume() const { return bends; }
    Spectrum straight_transmittance(Vec3f wo) const;
    float reversed(Vec3f, Vec3f) const { return 1; }
    float diffuse_share(Vec3f wo, Vec3f wi) const;

  private:
    /// Fresnel split at a facet with the cosine cos_h to wo: colours, and the probability of reflection.
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
