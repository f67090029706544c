// emission_ray.h -- samples rays that leave emitters, as the start of light paths.
//
// Lights are chosen by power. Densities are densities of rays, 1/(m2 sr): per m2 of the emitter and per sr, over the
// cosine at the emitter. For light from infinity the area is perpendicular to the ray. Delta lights lack the same
// factor as in light sampling: the density is per sr for point lights and per m2 for directional lights, also for
// directional lights with a disc of directions.
#pragma once
#include "light/emission_aim.h"
#include "light/light.h"

namespace dg {

struct EmissionRay {
    std::int32_t light = -1;  // index in lights(), or LightSet::kEnvironment
    Vec3f origin, direction;  // for light from infinity, the origin is in front of the scene
    Vec2f barycentric{};      // for triangles
    Rgb value;                // cd/m2, cd or lux; for triangles the mean
    float pdf = 0;
};

/// Targets of emitted light.
struct EmissionReach {
    Sphere lit;         // bounds of surfaces that light may reach
    Sphere all;         // bounds of surfaces and occluders
    EmissionAim aim{};  // preferred targets
};

class EmissionRays {
  public:
    EmissionRays() = default;
    /// `lights` must outlive this.
    EmissionRays(const LightSet& lights, EmissionReach reach);

    /// No emitters, or only a uniform sky, which camera paths sample best.
    bool empty() const { return choice_.empty(); }
    std::optional<EmissionRay> sample(float u_light, Vec2f u_point, Vec2f u_direction,
                                      float time) const;
    /// Density with which sample() returns the ray from the light to `position`, which sees the light along `wi` at
    /// `distance` (m). For point lights, per m2 at that distance.
    float pdf(std::int32_t light, Vec3f position, Vec3f wi, float distance, float time) const;
    double power() const { return choice_.empty() ? 0 : choice_.sum(); }  // lm

  private:
    float chance(std::int32_t light) const;
    std::optional<EmissionRay> sample_sky(Vec2f u_point, Vec2f u_direction, float time) const;

    const LightSet* lights_ = nullptr;
    EmissionReach reach_{};
    DiscreteDistribution choice_;   // per light; the last entry is the environment
};

/// Attenuation of a point or spot light of finite range after `distance` m; 1 for other lights.
float range_attenuation(const Light& light, float distance);

}  // namespace dg
