// emitter.h -- the kinds of light one by one: check, bounds, and a sample toward them. A
// new kind of Light needs an overload of each.
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

/// For the tree; intensity 0: never shines, or is at infinity.
LightBounds emitter_bounds(const PointLight& light);
LightBounds emitter_bounds(const SpotLight& light);
LightBounds emitter_bounds(const DirectionalLight& light);
LightBounds emitter_bounds(const SphereLight& light);
LightBounds emitter_bounds(const TriangleLight& light);

/// Makes bounds as narrow as the spread of a lamp's profile; the intensity is still without it.
void narrow(LightBounds& bounds, const LampShape& lamp);

/// Sample like a LightSample, but the radiance is still an Rgb and the choice of the light is not
/// in the pdf.
struct EmitterSample {
    Vec3f wi;
    float distance;
    Rgb value;  // cd/m2, or lux for delta lights
    float pdf;
    bool delta;
    Vec2f barycentric{};
    float error = 0;  // m, along wi: how far from there a ray may meet the lamp
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

/// Unit vector toward a point of the disc from which a directional light shines, even over its solid angle.
Vec3f toward_disc(const DirectionalLight& light, Vec2f u);
/// Illuminance (lux) of the parallel light that each such direction stands for. An even disc of luminance L and half
/// angle h has the solid angle W = 2 pi (1 - cos h) and brings E = pi L sin^2 h to a surface that faces it, pi L from
/// h = pi / 2 on; this is L W.
Rgb disc_illuminance(const DirectionalLight& light);

/// Bound of the distance (m) at which a ray tracer meets a lamp off its surface, by its largest coordinate: a few units
/// in the last place, twice what rays that leave a surface are moved by.
inline float lamp_error(float largest_coordinate) { return 16 * 0x1p-24f * largest_coordinate; }

/// Solid-angle density of sample_emitter.
float emitter_pdf(const SphereLight& light, Vec3f position);
float emitter_pdf(const TriangleLight& light, float t, float cos_light);

/// Window of KHR_lights_punctual for lights of finite range, without the 1 / d^2.
float range_window(float distance, float range);
/// Angular attenuation of KHR_lights_punctual: 1 inside the inner cone, 0 outside the
/// outer one.
float spot_attenuation(float cos_angle, float inner_angle, float outer_angle);

float triangle_area(const TriangleLight& light);

}  // namespace dg
