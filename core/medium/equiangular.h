// equiangular.h -- distances along a ray at which a small lamp lights the medium.
//
// The light of a lamp at the distance h from the ray's line falls as 1 / (h^2 + s^2), with s from the foot of the lamp's
// perpendicular. Distances of even angles as seen from the lamp have that density, so that what remains has no peak but
// that of the phase function, by which the angles are weighed (phase_angles.h).
// Source: Kulla and Fajardo 2012, Importance Sampling Techniques for Path Tracing in Participating Media, EGSR.
#pragma once
#include <limits>

#include "medium/phase_angles.h"

namespace dg {

class Equiangular {
  public:
    /// Along `direction` (unit) from `origin`, for `length` m, which may be infinite.
    Equiangular(Vec3f origin, Vec3f direction, float length, Vec3f lamp, const PhaseAngles& angles)
        : angles_(angles) {
        const Vec3d to_lamp = to_double(lamp) - to_double(origin), d = to_double(direction);
        foot_ = dot(to_lamp, d);
        const double far = dg::length(to_lamp);
        height_ = std::max(dg::length(to_lamp - d * foot_), 1e-6 * far);   // a lamp on the line has no last distance
        length_ = length;
        const bool endless = !(length < std::numeric_limits<float>::infinity());
        low_ = angles.before(dg::atan2(-foot_, height_));
        const double high = endless ? 1 : angles.before(dg::atan2(length_ - foot_, height_));
        share_ = high - low_;
    }

    /// Distance, m; `u` in [0, 1).
    float sample(float u) const {
        const double t = foot_ + height_ * std::tan(angles_.angle(low_ + share_ * double(u)));
        return float(std::clamp(t, 0.0, double(length_)));
    }
    /// Density of sample(), per m.
    float pdf(float t) const {
        const double s = double(t) - foot_;
        const double density = angles_.density(dg::atan2(s, height_));
        return float(density * height_ / (share_ * (height_ * height_ + s * s)));
    }
    /// False where the lamp stands at the very start of a way without length.
    bool usable() const { return height_ > 0 && share_ > 0; }

  private:
    const PhaseAngles& angles_;
    double foot_, height_, low_, share_;
    double length_;
};

}  // namespace dg
