// phase.h -- phase function of a medium: a weighted mean of Henyey-Greenstein lobes.
//
// With c the cosine of the scattering angle (1: forward) and g its mean, per sr
//   p(c) = (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)).
// Source: Henyey and Greenstein 1941, Diffuse radiation in the Galaxy, Astrophysical Journal 93. Both the function and
// the inverse of its integral are written in terms of 1 - c here, which is accurate for narrow lobes.
#pragma once
#include <array>
#include <span>

#include "medium/phase_angles.h"

namespace dg {

/// A Henyey-Greenstein lobe; |mean_cosine| < 1.
struct PhaseLobe {
    float mean_cosine = 0;
    float share = 1;   // fraction of the scattered light; the shares of a phase function sum to 1

    /// Value, 1/sr; `turn`: 1 - c.
    float value(float turn) const {
        const float g = std::abs(mean_cosine), from = mean_cosine < 0 ? 2 - turn : turn;
        const float base = (1 - g) * (1 - g) + 2 * g * from;
        return (1 - g * g) / (4 * kPi * base * std::sqrt(base));
    }
    /// Samples 1 - c with the density value().
    float sample(float u) const {
        const float g = std::abs(mean_cosine), below = 1 - g + 2 * g * u;
        const float root = (1 - g) * (1 + g) / below;
        const float turn = std::clamp((1 - g) * (1 - u) * (root + 1 - g) / below, 0.f, 2.f);
        return mean_cosine < 0 ? 2 - turn : turn;
    }
};

class Phase {
  public:
    static constexpr std::size_t kMost = 8;
    Phase() = default;
    /// Normalizes the shares. Throws Error unless there are 1 to kMost lobes with |mean cosine| < 1 and a positive sum
    /// of shares.
    explicit Phase(std::span<const PhaseLobe> lobes);

    /// Value, 1/sr, for directions that point away from the scattering point, as in a BSDF. Also the density of
    /// sample().
    float value(Vec3f wo, Vec3f wi) const;
    Vec3f sample(Vec3f wo, float u_lobe, Vec2f u) const;
    std::span<const PhaseLobe> lobes() const { return {lobes_.data(), count_}; }
    const PhaseAngles& angles() const { return angles_; }

  private:
    float of_turn(float turn) const;
    std::array<PhaseLobe, kMost> lobes_{};
    std::size_t count_ = 1;
    PhaseAngles angles_;
};

}  // namespace dg
