// lamp_sampler.h -- next-event estimation along a segment in a homogeneous medium: a lamp, and a distance at which its
// light is scattered toward the ray's origin.
//
// The distance is drawn by equiangular sampling (equiangular.h) with probability 0.9, else by the free-path density.
// The path itself may find the same light by being scattered after a free path and hitting the lamp. With densities
// n(t) p_lamp and c(t) p_phase, where n and c are densities of the distance t, the power heuristic would use n(t) /
// c(t). Here it uses a ratio that does not depend on t or the lamp, the expected numbers of light samples and of
// collisions on the segment (`light_samples_per_collision`): both estimators know it, so their weights add to 1.
// Equiangular sampling only lowers the variance of light sampling. Sources: Kulla and Fajardo 2012 (equiangular.h);
// Pharr, Jakob and Humphreys 2023, Physically Based Rendering, chapter 14.
#pragma once
#include <optional>

#include "medium/segment.h"
#include "transport/walk/direct_light.h"
#include "transport/walk/path_state.h"

namespace dg {

/// A light sample with a scattering distance.
struct LampSample {
    DirectLight direct{};   // weight 0: no contribution
    Spectrum scattering;    // scattering coefficient (1/m) times transmittance to the start of the segment
    float t = 0;            // m along the ray
};

class LampSampler {
  public:
    struct Random {
        float select, where;   // the lamp; the distance
        Vec2f place;           // the point on the lamp
    };
    LampSampler(const PathState& path, const Phase& phase, const Segment& segment)
        : path_(path), phase_(phase), segment_(segment) {}

    /// `light_samples_per_collision`: expected number of light samples over expected number of collisions at which the
    /// path is scattered, on the segment.
    LampSample sample(float light_samples_per_collision, const Random& u) const;

  private:
    struct Place {
        float t, density;   // m from the start of the segment; 1/m
    };
    Vec3f start() const;
    Place place(const std::optional<LightSet::Place>& lamp, float u) const;
    float light_share(float light_pdf, float phase_pdf) const;

    const PathState& path_;
    const Phase& phase_;
    const Segment& segment_;
};

/// A point of the ray as a surface hit, with normals opposite to the ray.
inline SurfaceHit in_medium(const Ray& ray, float t) {
    SurfaceHit at;
    at.position = ray.origin + ray.direction * t;
    at.wo = at.ng = at.ns = -ray.direction;
    at.t = t;
    at.time = ray.time;
    return at;
}

}  // namespace dg
