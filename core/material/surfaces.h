// surfaces.h -- kinds of surfaces other than glTF's, as in research renderers.
#pragma once
#include <cstdint>

#include "material/bsdf_sample.h"
#include "material/facets.h"
#include "material/texture.h"
#include "spectrum/sampled_spectrum.h"

namespace dg {

struct Material;
struct MaterialChange;

/// Alpha along u and v (for GGX: roughness squared); both < 1e-3: smooth.
struct Roughness {
    float u = 0, v = 0;
    TextureSlot texture;   // R is a factor on u, G on v
    Distribution distribution = Distribution::ggx;

    Roughness(float alpha = 0) : u(alpha), v(alpha) {}  // NOLINT: implicit
    Roughness(float u, float v, TextureSlot texture = {}, Distribution distribution = Distribution::ggx)
        : u(u), v(v), texture(texture), distribution(distribution) {}
    /// Whether it is constant and isotropic.
    bool plain() const { return u == v && !texture.used(); }
    bool may_be_smooth() const { return texture.used() || (u < kSmoothAlpha && v < kSmoothAlpha); }
    float widest() const { return std::max(u, v); }
};

/// Two-sided Lambertian reflection and transmission.
struct DiffuseMaterial {
    SpectralColor reflectance{0.5f, 0.5f, 0.5f};
    TextureSlot reflectance_texture = {};
    SpectralColor transmittance = {};
    TextureSlot transmittance_texture = {};
};

/// Two-sided microfacets with the constant reflectance `reflectance`, or with `fresnel` its product with the Fresnel
/// reflectance of the index eta + i k.
struct ConductorMaterial {
    SpectralColor reflectance{1, 1, 1};
    Roughness alpha{0.1f};
    TextureSlot reflectance_texture = {};
    bool fresnel = false;
    SpectralColor eta = {}, k = {};
};

/// Clear dielectric, smooth or rough; the normal's side is outside.
struct DielectricMaterial {
    float ior = 1.5f;
    Roughness alpha = {};
    SpectralColor tint{1, 1, 1};   // factor on transmission
    float dispersion = 0;          // 20 / Abbe number (KHR_materials_dispersion); `ior` is n_d
    SharedSpectrum ior_by_wavelength = {};   // replaces ior and dispersion
    SpectralColor reflection_tint{1, 1, 1};
    bool thin = false;             // a pane without refraction
    bool energy_compensation = false;
};

/// A clear dielectric coat over a diffuse surface or a metal.
struct CoatedMaterial {
    bool metal = false;            // the base is metal; false: diffuse
    DiffuseMaterial diffuse = {};
    ConductorMaterial conductor = {};
    float ior = 1.5f;
    Roughness alpha = {};
    SpectralColor specular_tint{1, 1, 1};
    float thickness = 0;           // m
    SpectralColor absorption = {}; // 1/m
    bool nonlinear = true;         // colours saturate by inter-reflections of coat and base
    bool energy_compensation = true;
};

/// Pointers to a part of a mixture in the scene; animated if `change` is set.
struct MixPart {
    const Material* still = nullptr;
    const MaterialChange* change = nullptr;
    /// The part with every number at its maximum over time.
    const Material& most() const;
    /// Always equal, since pointers are not part of a material's value.
    friend bool operator==(const MixPart&, const MixPart&) { return true; }
};

/// A mixture of two materials by coverage.
struct MixMaterial {
    std::uint32_t first = 0, second = 0;   // indices of materials before this one
    float amount = 0.5f;                   // share of the second
    TextureSlot amount_texture = {};       // R
    MixPart parts[2] = {};                 // set when the scene is built

    static constexpr int kMostNested = 8;
};

/// An invisible boundary between media.
struct BoundaryMaterial {};

}  // namespace dg
