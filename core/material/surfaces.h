// surfaces.h -- kinds of surfaces: what renderers for research and Python have, glTF's aside.
#pragma once
#include <cstdint>

#include "material/bsdf_sample.h"
#include "material/facets.h"
#include "material/texture.h"
#include "spectrum/sampled_spectrum.h"

namespace dg {

struct Material;
struct MaterialChange;

/// Alpha of slopes along u and along v (of GGX: roughness squared); both < 1e-3: smooth.
struct Roughness {
    float u = 0, v = 0;
    TextureSlot texture;   // R is a factor on u, G on v
    Distribution distribution = Distribution::ggx;

    Roughness(float alpha = 0) : u(alpha), v(alpha) {}  // NOLINT: a number is one
    Roughness(float u, float v, TextureSlot texture = {}, Distribution distribution = Distribution::ggx)
        : u(u), v(v), texture(texture), distribution(distribution) {}
    /// The same everywhere and in all directions.
    bool plain() const { return u == v && !texture.used(); }
    bool may_be_smooth() const { return texture.used() || (u < kSmoothAlpha && v < kSmoothAlpha); }
    float widest() const { return std::max(u, v); }
};

/// Lambert on both sides, for light that is reflected and light that passes.
struct DiffuseMaterial {
    SpectralColor reflectance{0.5f, 0.5f, 0.5f};
    TextureSlot reflectance_texture = {};
    SpectralColor transmittance = {};
    TextureSlot transmittance_texture = {};
};

/// Microfacets, both sides, whose reflectance is `reflectance` at every angle, or with `fresnel` that times the
/// Fresnel reflectance of the index eta + i k.
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
    SpectralColor tint{1, 1, 1};   // multiplies transmission
    float dispersion = 0;          // 20 / Abbe number (KHR_materials_dispersion); `ior` is n_d
    SharedSpectrum ior_by_wavelength = {};   // in place of both
    SpectralColor reflection_tint{1, 1, 1};
    bool thin = false;             // a pane: nothing is bent
    bool energy_compensation = false;
};

/// A clear dielectric coat over a diffuse surface or a metal.
struct CoatedMaterial {
    bool metal = false;            // which of the two lies below
    DiffuseMaterial diffuse = {};
    ConductorMaterial conductor = {};
    float ior = 1.5f;
    Roughness alpha = {};
    SpectralColor specular_tint{1, 1, 1};
    float thickness = 0;           // m
    SpectralColor absorption = {}; // 1/m
    bool nonlinear = true;         // colours saturate by light between coat and base
    bool energy_compensation = true;
};

/// A part of a mixture where the scene has it; changes over time if `change` is set.
struct MixPart {
    const Material* still = nullptr;
    const MaterialChange* change = nullptr;
    /// With every number at its most.
    const Material& most() const;
    /// Where it is says nothing of what it is.
    friend bool operator==(const MixPart&, const MixPart&) { return true; }
};

/// Two materials, each of which covers a share of every point.
struct MixMaterial {
    std::uint32_t first = 0, second = 0;   // indices of materials before this one
    float amount = 0.5f;                   // share of the second
    TextureSlot amount_texture = {};       // R
    MixPart parts[2] = {};                 // set when the scene is built

    static constexpr int kMostNested = 8;
};

/// Invisible: only media change there.
struct BoundaryMaterial {};

}  // namespace dg
