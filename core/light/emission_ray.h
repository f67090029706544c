// emission_ray.h -- rays that leave emitters: where paths from the light begin.
//
// A light is chosen by its power. Densities are those of a ray, per m2 sr: per m2 of the emitter, per sr,
// over the cosine there. Light from infinity has them per m2 across the ray. A delta light lacks a factor
// that it lacks in light sampling too: a point is one, so the density is per sr, and that of a direction
// per m2, also where it is one of many that a directional light draws.
#pragma once
#include "light/emission_aim.h"
#include "light/light.h"

namespace dg {

struct EmissionRay {
    std::int32_t light = -1;  // index in lights(), or LightSet::kEnvironment
    Vec3f origin, direction;  // from infinity: before everything that the ray may meet
    Vec2f barycentric{};      // of a triangle
    Rgb value;                // cd/m2, cd or lux; of a triangle the mean
    float pdf = 0;
};

/// Where light may go.
struct EmissionReach {
    Sphere lit;         // holds what light may fall on
    Sphere all;         // and what may stop it on its way
    EmissionAim aim{};  // where more light goes than chance would send
};

class EmissionRays {
  public:
    EmissionRays() = default;
    /// `lights` must outlive this.
    EmissionRays(const LightSet& lights, EmissionReach reach);

    /// Nothing shines, or an even sky alone: following paths from the camera finds that best.
    bool empty() const { return choice_.empty(); }
    std::optional<EmissionRay> sample(float u_light, Vec2f u_point, Vec2f u_direction,
                                      float time) const;
    /// Density with which sample() would have sent a ray from the light, where `position` sees it along
    /// `wi` at `distance` (m). Of a point light per m2 at that distance.
    float pdf(std::int32_t light, Vec3f position, Vec3f wi, float distance, float time) const;
    double power() const { return choice_.empty() ? 0 : choice_.sum(); }  // lm

  private:
    float chance(std::int32_t light) const;
    std::optional<EmissionRay> sample_sky(Vec2f u_point, Vec2f u_direction, float time) const;

    const LightSet* lights_ = nullptr;
    EmissionReach reach_{};
    DiscreteDistribution choice_;   // by light; the last is the environment
};

/// Attenuation of the light of a point or spot light of finite range after `distance` m; 1 of others.
float range_attenuation(const Light& light, float distance);

}  // namespace dg
