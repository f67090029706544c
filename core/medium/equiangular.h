// equiangular.h -- distances along a ray at which a small lamp lights the medium.
//
// The light of a lamp at the distance h from the ray's line falls as 1 / (h^2 + s^2), with s from the foot of the
// lamp's perpendicular. Distances of even angles as seen from the lamp have that density, so that what remains has no
// peak but that of the phase function, by which the angles are weighed (phase_angles.h).
// Source: Kulla and Fajardo 2012, Importance Sampling Techniques for Path Tracing in Participating Media, EGSR.
#pragma once
#include <limits>

#include "math/vec.h"
#include "medium/phase_angles.h"

namespace dg {

/// A part of a ray, m from its origin; the end may be infinite.
struct RayPart {
    float begin, end;

    bool empty() const { return !(begin < end); }
    /// Part of it before a plane: the origin lies `height` m before it, and each metre on the ray `slope` m more.
    RayPart before_plane(float height, float slope) const {
        if (slope == 0) return {begin, height > 0 ? end : begin};
        const float met = -height / slope;
        return slope > 0 ? RayPart{std::max(begin, met), end} : RayPart{begin, std::min(end, met)};
    }
};

class Equiangular {
  public:
    /// Along `direction` (unit) from `origin`.
    Equiangular(Vec3f origin, Vec3f direction, RayPart part, Vec3f lamp, const PhaseAngles& angles)
        : angles_(angles), begin_(part.begin), end_(part.end) {
        const Vec3d to_lamp = to_double(lamp) - to_double(origin), d = to_double(direction);
        foot_ = dot(to_lamp, d);
        const double far = dg::length(to_lamp);
        height_ = std::max(dg::length(to_lamp - d * foot_), 1e-6 * far);   // a lamp on the line has no last distance
        low_ = angles.before(half_tangent(begin_ - foot_, height_));
        share_ = angles.before(half_tangent(end_ - foot_, height_)) - low_;
    }

    /// Distance, m; `u` in [0, 1).
    float sample(float u) const {
        constexpr double kMost = 1 - 1e-12;   // at 1 it is infinite
        const double half = std::min(angles_.half(low_ + share_ * double(u)), kMost);
        return float(std::clamp(foot_ + height_ * 2 * half / (1 - half * half), begin_, end_));
    }
    /// Density of sample(), per m.
    float pdf(float t) const {
        const double s = double(t) - foot_, r = std::sqrt(height_ * height_ + s * s);
        if (double(t) < begin_ || double(t) > end_) return 0;
        return float(angles_.density(half_tangent(s, height_)) * height_ / (share_ * r * (r + height_)));
    }
    /// False where the lamp stands at the very start of a way without length, or lights none of it.
    bool usable() const { return height_ > 0 && share_ > 0; }

  private:
    const PhaseAngles& angles_;
    double foot_, height_, low_, share_;
    double begin_, end_;
};

}  // namespace dg
