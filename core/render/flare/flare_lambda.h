// flare_lambda.h -- the random numbers of four wavelengths: where in [0, 1) of Wavelengths::at, and how densely
// they are drawn there.
#pragma once
#include <algorithm>

#include "spectrum/spectrum.h"

namespace dg {

struct FlareLambda {
    Spectrum u{0.f}, density{1.f};

    FlareLambda(Spectrum at, Spectrum times) : u(at), density(times) {}
    /// Evenly: one in each quarter, and in any of them the hero.
    FlareLambda(float hero) {  // NOLINT: one random number is four wavelengths
        const int quarter = std::min(int(hero * kWavelengths), kWavelengths - 1);
        for (int k = 0; k < kWavelengths; ++k)
            u.set(k, hero + float((quarter + k) % kWavelengths - quarter) / kWavelengths);
    }
};

}  // namespace dg
