// medium.h -- a participating medium: absorption, scattering and emission (Pharr, Jakob and Humphreys 2023, Physically
// Based Rendering, chapter 11). Coefficients are for density 1; a density grid scales them.
#pragma once
#include <memory>

#include "medium/density_grid.h"
#include "medium/phase.h"
#include "spectrum/sampled_spectrum.h"

namespace dg {

/// A medium at the wavelengths of one path, at density 1.
struct MediumAt {
    Spectrum scattering, extinction;   // 1/m
    Spectrum emission;                 // radiance per metre
};

struct Medium {
    SpectralColor absorption, scattering;   // 1/m
    SpectralColor emission;                 // cd/m2 per m; a factor on the shape of D65
    Phase phase;
    std::shared_ptr<const DensityGrid> density = nullptr;   // null: 1 everywhere

    MediumAt at(const Wavelengths& wavelengths) const;
};

/// Transmittance of `length` metres. An extinction of 0 has a transmittance of 1 over an infinite length, too.
inline Spectrum transmittance(Spectrum extinction, float length) {
    Spectrum left;
    for (int i = 0; i < kWavelengths; ++i) left.set(i, extinction[i] > 0 ? std::exp(-extinction[i] * length) : 1.f);
    return left;
}

}  // namespace dg
