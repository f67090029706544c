// phase_angles.h -- how much of a lamp's light a medium scatters toward a ray, by the angle under which the lamp sees
// the place on it.
//
// With the angle a from the foot of the lamp's perpendicular, from -pi / 2 far before it to pi / 2 far behind, light
// turns by an angle of cosine -sin a on its way to the ray's origin. What a lamp brings falls on even angles
// (equiangular.h) but for the phase function p(-sin a), whose integral is kept here, over cells in which it counts as
// even. A part of all is even over all angles, so that no density is too small to be weighed by. Source: Georgiev et
// al. 2013, Joint Importance Sampling of Low-Order Volumetric Scattering, ACM TOG 32(6), section 5.
#pragma once
#include <algorithm>
#include <array>

#include "math/vec.h"

namespace dg {

class PhaseAngles {
  public:
    PhaseAngles();   // light turns evenly
    /// `value`: the phase function of 1 - cosine of the angle by which light turns; its scale does not matter.
    template <typename Value>
    explicit PhaseAngles(const Value& value);

    /// Share of all before an angle, rad; the angle that has a share before it; density, per rad.
    double before(double angle) const;
    double angle(double share) const;
    double density(double angle) const {
        const int i = cell(angle);
        return (before_[i + 1] - before_[i]) / kWidth;
    }
    static constexpr int kCells = 128;
    static constexpr double kWidth = kPiD / kCells;

  private:
    static constexpr double kEvenShare = 0.02;
    static int cell(double angle) { return std::clamp(int((angle + kPiD / 2) / kWidth), 0, kCells - 1); }
    static double begin(int cell) { return cell * kWidth - kPiD / 2; }

    std::array<double, kCells + 1> before_;
};

inline PhaseAngles::PhaseAngles() {
    for (int i = 0; i <= kCells; ++i) before_[i] = double(i) / kCells;
}

template <typename Value>
PhaseAngles::PhaseAngles(const Value& value) {
    constexpr int kPoints = 16;   // in each cell
    before_[0] = 0;
    for (int i = 0; i < kCells; ++i) {
        double sum = 0;
        for (int k = 0; k < kPoints; ++k) {
            const double half = (begin(i) + kPiD / 2 + (k + 0.5) / kPoints * kWidth) / 2;   // of the turn
            sum += double(value(float(2 * std::sin(half) * std::sin(half))));
        }
        before_[i + 1] = before_[i] + sum;
    }
    const double all = before_[kCells];
    for (int i = 0; i <= kCells; ++i)
        before_[i] = kEvenShare * i / kCells + (1 - kEvenShare) * before_[i] / all;
}

inline double PhaseAngles::before(double angle) const {
    const int i = cell(angle);
    return before_[i] + (angle - begin(i)) / kWidth * (before_[i + 1] - before_[i]);
}

inline double PhaseAngles::angle(double share) const {
    const auto next = std::upper_bound(before_.begin() + 1, before_.end() - 1, share);
    const int i = int(next - before_.begin()) - 1;
    return begin(i) + (share - before_[i]) / (before_[i + 1] - before_[i]) * kWidth;
}

}  // namespace dg
