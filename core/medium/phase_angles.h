// phase_angles.h -- distribution of angles for equiangular sampling, weighted by the phase function.
//
// Let a be the angle at the lamp between the foot of its perpendicular on the ray and a point of the ray, from -pi / 2
// far before the foot to pi / 2 far behind it. The scattering angle toward the ray's origin then has the cosine -sin a.
// In-scattered light is uniform in a (equiangular.h) except for the phase function p(-sin a). This class tabulates its
// integral. Angles are represented by tan(a / 2), from -1 to 1, which needs no trigonometry; the density is constant in
// cells of that variable. A uniform part bounds the density from below, which bounds the weights. Source: Georgiev et
// al. 2013, Joint Importance Sampling of Low-Order Volumetric Scattering, ACM TOG 32(6), section 5.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "math/vec.h"

namespace dg {

/// tan(a / 2) for a point `along` m behind the foot, and a lamp at the distance `height` m from the line.
inline double half_tangent(double along, double height) {
    if (std::isinf(along)) return along > 0 ? 1 : -1;
    return along / (height + std::sqrt(height * height + along * along));
}

class PhaseAngles {
  public:
    PhaseAngles() : PhaseAngles([](float) { return 1.f; }) {}   // isotropic scattering
    /// `value`: the phase function, up to a factor, as a function of 1 - cosine of the scattering angle.
    template <typename Value>
    explicit PhaseAngles(const Value& value);

    /// Cumulative distribution, its inverse, and the density. Angles are given by their half tangent.
    double before(double half) const {
        const int i = cell(half);
        return before_[i] + (half - begin(i)) / kWidth * (before_[i + 1] - before_[i]);
    }
    double half(double share) const;
    double density(double half) const {
        const int i = cell(half);
        return (before_[i + 1] - before_[i]) / kWidth;
    }
    static constexpr int kCells = 128;
    static constexpr double kWidth = 2. / kCells;

  private:
    static constexpr double kEvenShare = 0.02;
    static int cell(double half) { return std::clamp(int((half + 1) / kWidth), 0, kCells - 1); }
    static double begin(int cell) { return cell * kWidth - 1; }

    std::array<double, kCells + 1> before_;
};

template <typename Value>
PhaseAngles::PhaseAngles(const Value& value) {
    constexpr int kPoints = 16;   // quadrature points per cell
    std::array<double, kCells + 1> angles{};
    before_[0] = 0;
    for (int i = 0; i < kCells; ++i) {
        before_[i + 1] = before_[i], angles[i + 1] = angles[i];
        for (int k = 0; k < kPoints; ++k) {
            const double half = begin(i) + (k + 0.5) / kPoints * kWidth, angle = 1 / (1 + half * half);
            before_[i + 1] += double(value(float((1 + half) * (1 + half) * angle))) * angle;
            angles[i + 1] += angle;
        }
    }
    const double all = before_[kCells];
    for (int i = 0; i <= kCells; ++i)
        before_[i] = kEvenShare * angles[i] / angles[kCells] + (1 - kEvenShare) * before_[i] / all;
}

inline double PhaseAngles::half(double share) const {
    const auto next = std::upper_bound(before_.begin() + 1, before_.end() - 1, share);
    const int i = int(next - before_.begin()) - 1;
    return begin(i) + (share - before_[i]) / (before_[i + 1] - before_[i]) * kWidth;
}

}  // namespace dg
