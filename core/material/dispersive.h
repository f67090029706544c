// dispersive.h -- wavelength-dependent indices of refraction. A dispersive interface refracts each wavelength in a
// different direction, so only the hero is followed further, with the weight of all four (hero_alone()). Reflection
// keeps all wavelengths, each with a separate reflectance.
#pragma once
#include <algorithm>

#include "material/fresnel.h"
#include "spectrum/spectrum.h"

namespace dg {

/// Index at each wavelength (nm) of a glass of index `ior` at 587.6 nm and of the Abbe
/// number V = 20 / dispersion: Cauchy's A + B / nm^2 through (n_F - n_C) = (n_d - 1) / V.
/// Source: KHR_materials_dispersion, "Overview", with indices of at least 1. The upper bound is the limit for
/// refraction in float.
inline Spectrum dispersed_ior(float ior, float dispersion, Spectrum nm) {
    Spectrum n;
    for (int k = 0; k < kWavelengths; ++k) {
        const float shift = 523655.f / (nm[k] * nm[k]) - 1.5168f;
        n.set(k, std::clamp(ior + (ior - 1) * dispersion / 20 * shift, 1.f, 1e4f));
    }
    return n;
}

/// Fresnel reflectance at each wavelength, from the outside (`front`) or the inside.
inline Spectrum fresnel_dielectric(float cos_i, Spectrum ior, bool front) {
    Spectrum r;
    for (int k = 0; k < kWavelengths; ++k)
        r.set(k, fresnel_dielectric(cos_i, front ? ior[k] : 1 / ior[k]));
    return r;
}

}  // namespace dg
