// flare_lambda.h -- random numbers in [0, 1) of four wavelengths (Wavelengths::at), and their densities.
#pragma once
#include <algorithm>

#include "spectrum/spectrum.h"

namespace dg {

struct FlareLambda {
    Spectrum u{0.f}, density{1.f};

    FlareLambda(Spectrum at, Spectrum times) : u(at), density(times) {}
    /// Uniform: one wavelength in each quarter; the hero is in the quarter of its random number.
    FlareLambda(float hero) {  // NOLINT: one random number is four wavelengths
        const int quarter = std::min(int(hero * kWavelengths), kWavelengths - 1);
        for (int k = 0; k < kWavelengths; ++k)
            u.set(k, hero + float((quarter + k) % kWavelengths - quarter) / kWavelengths);
    }
};

}  // namespace dg
