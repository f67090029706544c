// punctual.cpp -- point, spot and directional lights, as defined by KHR_lights_punctual.
#include "light/emitter.h"
#include "light/emitter_check.h"
#include "math/warp.h"

namespace dg {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Sample toward a point, with 1 / d^2; empty at the point itself.
std::optional<EmitterSample> toward(Vec3f light, Rgb intensity, float range,
                                    Vec3f position) {
    const Vec3f to = light - position;
    const float d2 = length_squared(to);
    if (!(d2 > 0)) return std::nullopt;
    const float d = std::sqrt(d2);
    const float window = range_window(d, range);
    if (window <= 0) return std::nullopt;
    return EmitterSample{to * (1 / d), d, intensity * (window / d2), 1, true};
}

/// 1 - cos without cancellation at small angles.
float one_minus_cos_half(float angle) {
    const float s = std::sin(angle / 4);
    return 2 * s * s;
}

}  // namespace

float range_window(float distance, float range) {
    if (range == kInfinity) return 1;
    const float q = distance / range, q2 = q * q;
    return std::clamp(1 - q2 * q2, 0.f, 1.f);
}

float spot_attenuation(float cos_angle, float inner_angle, float outer_angle) {
    const float cos_outer = std::cos(outer_angle);
    const float scale = 1 / std::max(0.001f, std::cos(inner_angle) - cos_outer);
    const float a = std::clamp((cos_angle - cos_outer) * scale, 0.f, 1.f);
    return a * a;
}

void check_emitter(const PointLight& light, const std::string& where) {
    check_finite(where, "position", light.position);
    check_color(where, "intensity", light.intensity);
    check_positive(where, "range", light.range);
}

void check_emitter(const SpotLight& light, const std::string& where) {
    check_finite(where, "position", light.position);
    check_unit(where, "direction", light.direction);
    check_color(where, "intensity", light.intensity);
    check_positive(where, "range", light.range);
    const bool ordered = light.inner_angle >= 0 &&
                         light.inner_angle <= light.outer_angle &&
                         light.outer_angle > 0 && light.outer_angle <= kPi / 2 + 1e-5f;
    if (!ordered) {
        throw input_error(where, "cone", "0 <= inner angle <= outer angle <= pi/2",
                          std::to_string(light.inner_angle) + " and " +
                              std::to_string(light.outer_angle) + " rad");
    }
}

void check_emitter(const DirectionalLight& light, const std::string& where) {
    check_unit(where, "direction", light.direction);
    check_color(where, "illuminance", light.illuminance);
    if (!(light.angle >= 0 && light.angle <= 2 * kPi + 1e-5f))
        throw input_error(where, "angle", "0 to 2 pi rad", std::to_string(light.angle));
}

LightBounds emitter_bounds(const PointLight& light) {
    LightBounds b;
    b.min = b.max = light.position;
    b.intensity = selection_weight(light.intensity);
    narrow(b, light.lamp);
    return b;
}

LightBounds emitter_bounds(const SpotLight& light) {
    LightBounds b;
    b.min = b.max = light.position;
    b.axis = light.direction;
    b.spread = light.outer_angle;
    b.falloff = 0;
    b.intensity = selection_weight(light.intensity);
    return b;
}

LightBounds emitter_bounds(const DirectionalLight&) {
    return {};
}

std::optional<EmitterSample> sample_emitter(const PointLight& light, Vec2f,
                                            Vec3f position) {
    return toward(light.position, light.intensity, light.range, position);
}

std::optional<EmitterSample> sample_emitter(const SpotLight& light, Vec2f,
                                            Vec3f position) {
    auto sample = toward(light.position, light.intensity, light.range, position);
    if (!sample) return std::nullopt;
    const float a = spot_attenuation(-dot(sample->wi, light.direction), light.inner_angle,
                                     light.outer_angle);
    if (a <= 0) return std::nullopt;
    sample->value *= a;
    return sample;
}

Vec3f toward_disc(const DirectionalLight& light, Vec2f u) {
    if (light.angle == 0) return -light.direction;
    const Vec3f w = warp_cone(u, one_minus_cos_half(light.angle));
    return normalize(Frame::from_normal(-light.direction).to_world(w));
}

Rgb disc_illuminance(const DirectionalLight& light) {
    const float c = one_minus_cos_half(light.angle);
    return light.illuminance * (c <= 1 ? 2 / (2 - c) : 2 * c);   // sin^2 h = c (2 - c)
}

std::optional<EmitterSample> sample_emitter(const DirectionalLight& light, Vec2f u, Vec3f) {
    return EmitterSample{toward_disc(light, u), kInfinity, disc_illuminance(light), 1, true};
}

}  // namespace dg
