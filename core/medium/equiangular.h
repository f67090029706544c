// equiangular.h -- equiangular sampling: distances along a ray for in-scattered light of a small lamp.
//
// The irradiance of a lamp at the distance h from the ray's line is proportional to 1 / (h^2 + s^2), with s measured
// from the foot of the lamp's perpendicular. Distances at uniformly distributed angles from the lamp have that density.
// The remaining factor is the phase function, which weighs the angles (phase_angles.h).
// Source: Kulla and Fajardo 2012, Importance Sampling Techniques for Path Tracing in Participating Media, EGSR.
#pragma once
#include <limits>

#include "math/vec.h"
#include "medium/phase_angles.h"

namespace dg {

/// Interval on a ray, m from its origin; the end may be infinite.
struct RayPart {
    float begin, end;

    bool empty() const { return !(begin < end); }
    /// The subinterval in front of a plane. `height`: distance of the ray's origin in front of the plane, m. `slope`:
    /// its change per metre along the ray.
    RayPart before_plane(float height, float slope) const {
        if (slope == 0) return {begin, height > 0 ? end : begin};
        const float met = -height / slope;
        return slope > 0 ? RayPart{std::max(begin, met), end} : RayPart{begin, std::min(end, met)};
    }
};

class Equiangular {
  public:
    /// `origin`, `direction` (unit): of the ray.
    Equiangular(Vec3f origin, Vec3f direction, RayPart part, Vec3f lamp, const PhaseAngles& angles)
        : angles_(angles), begin_(part.begin), end_(part.end) {
        const Vec3d to_lamp = to_double(lamp) - to_double(origin), d = to_double(direction);
        foot_ = dot(to_lamp, d);
        const double far = dg::length(to_lamp);
        height_ = std::max(dg::length(to_lamp - d * foot_), 1e-6 * far);   // above 0 for a lamp on the line
        low_ = angles.before(half_tangent(begin_ - foot_, height_));
        share_ = angles.before(half_tangent(end_ - foot_, height_)) - low_;
    }

    /// Samples a distance, m; `u` in [0, 1).
    float sample(float u) const {
        constexpr double kMost = 1 - 1e-12;   // the distance is infinite at 1
        const double half = std::min(angles_.half(low_ + share_ * double(u)), kMost);
        return float(std::clamp(foot_ + height_ * 2 * half / (1 - half * half), begin_, end_));
    }
    /// Density of sample(), per m.
    float pdf(float t) const {
        const double s = double(t) - foot_, r = std::sqrt(height_ * height_ + s * s);
        if (double(t) < begin_ || double(t) > end_) return 0;
        return float(angles_.density(half_tangent(s, height_)) * height_ / (share_ * r * (r + height_)));
    }
    /// False if the lamp lights no part of the interval, or is at the start of an interval of length 0.
    bool usable() const { return height_ > 0 && share_ > 0; }

  private:
    const PhaseAngles& angles_;
    double foot_, height_, low_, share_;
    double begin_, end_;
};

}  // namespace dg
