// emitter.h -- functions of each kind of light: validation, bounds, and light sampling. A new kind of Light needs an
// overload of each.
#pragma once
#include <string>

#include "light/light.h"

namespace dg {

/// Throws Error that starts with `where`.
void check_emitter(const PointLight& light, const std::string& where);
void check_emitter(const SpotLight& light, const std::string& where);
void check_emitter(const DirectionalLight& light, const std::string& where);
void check_emitter(const SphereLight& light, const std::string& where);
void check_emitter(const TriangleLight& light, const std::string& where);

/// Bounds for the light tree; intensity 0: never emits, or is at infinity.
LightBounds emitter_bounds(const PointLight& light);
LightBounds emitter_bounds(const SpotLight& light);
LightBounds emitter_bounds(const DirectionalLight& light);
LightBounds emitter_bounds(const SphereLight& light);
LightBounds emitter_bounds(const TriangleLight& light);

/// Narrows bounds to the spread of a lamp's profile, without changing the intensity.
void narrow(LightBounds& bounds, const LampShape& lamp);

/// A LightSample with an Rgb radiance and a density without the choice of the light.
struct EmitterSample {
    Vec3f wi;
    float distance;
    Rgb value;  // cd/m2, or lux for delta lights
    float pdf;
    bool delta;
    Vec2f barycentric{};
    float error = 0;  // m: error bound of the distance at which a ray along wi hits the lamp
};
std::optional<EmitterSample> sample_emitter(const PointLight& light, Vec2f u,
                                            Vec3f position);
std::optional<EmitterSample> sample_emitter(const SpotLight& light, Vec2f u,
                                            Vec3f position);
std::optional<EmitterSample> sample_emitter(const DirectionalLight& light, Vec2f u,
                                            Vec3f position);
std::optional<EmitterSample> sample_emitter(const SphereLight& light, Vec2f u,
                                            Vec3f position);
std::optional<EmitterSample> sample_emitter(const TriangleLight& light, Vec2f u,
                                            Vec3f position);

/// Unit vector toward a uniformly sampled point of a directional light's disc.
Vec3f toward_disc(const DirectionalLight& light, Vec2f u);
/// Illuminance (lux) of the equivalent parallel light for a sampled direction, L W. A uniform disc of luminance L and
/// half angle h has the solid angle W = 2 pi (1 - cos h) and the illuminance E = pi L sin^2 h on a facing surface, or
/// pi L for h >= pi / 2.
Rgb disc_illuminance(const DirectionalLight& light);

/// Error bound (m) of ray tracer hits on a lamp, from its largest coordinate: a few units in the last place, twice the
/// offset of rays that leave a surface.
inline float lamp_error(float largest_coordinate) { return 16 * 0x1p-24f * largest_coordinate; }

/// Density of sample_emitter, 1/sr.
float emitter_pdf(const SphereLight& light, Vec3f position);
float emitter_pdf(const TriangleLight& light, float t, float cos_light);

/// Window of KHR_lights_punctual for lights of finite range, without the 1 / d^2.
float range_window(float distance, float range);
/// Angular attenuation of KHR_lights_punctual: 1 inside the inner cone, 0 outside the
/// outer one.
float spot_attenuation(float cos_angle, float inner_angle, float outer_angle);

float triangle_area(const TriangleLight& light);

}  // namespace dg
