// lamp_sampler.h -- one light sample for a ray's way through an even medium: a lamp, and a distance on the way at which
// its light is scattered toward the ray's origin.
//
// The distance is drawn by equiangular sampling (equiangular.h) or like a collision, nine to one. The path itself may
// find the same light: it is scattered after a free path and meets the lamp. With densities n(t) p_lamp and
// c(t) p_phase, the power heuristic would want n / c at the distance. It gets the ratio for collisions instead,
// 1 / chance of a collision. Both estimators know that, whichever lamp it is, so their weights add to 1. Equiangular
// distances only improve the first.
// Sources: Kulla and Fajardo 2012 (equiangular.h); Pharr, Jakob and Humphreys 2023, Physically Based Rendering,
// chapter 14.
#pragma once
#include <optional>

#include "medium/segment.h"
#include "transport/walk/direct_light.h"
#include "transport/walk/path_state.h"

namespace dg {

/// A lamp's light on its way to the ray's origin.
struct LampSample {
    DirectLight direct{};   // weight 0: it brings nothing
    Spectrum scattered;     // share of light that is scattered at the distance, per m and sr, and reaches the origin
    float t = 0;            // m along the ray
};

class LampSampler {
  public:
    struct Random {
        float select, where;   // which lamp; at which distance
        Vec2f place;           // on the lamp
    };
    LampSampler(const PathState& path, const Phase& phase, const Segment& way)
        : path_(path), phase_(phase), way_(way) {}

    /// `odds`: light samples over collisions of the path.
    LampSample sample(float odds, const Random& u) const;

  private:
    struct Place {
        float t, density;   // m from the start of the way; 1/m
    };
    Vec3f start() const;
    Place place(const std::optional<LightSet::Place>& lamp, float u) const;
    float light_share(float light_pdf, float phase_pdf) const;

    const PathState& path_;
    const Phase& phase_;
    const Segment& way_;
};

/// A point of the ray as a surface hit. It has no sides.
inline SurfaceHit in_medium(const Ray& ray, float t) {
    SurfaceHit at;
    at.position = ray.origin + ray.direction * t;
    at.wo = at.ng = at.ns = -ray.direction;
    at.t = t;
    at.time = ray.time;
    return at;
}

}  // namespace dg
