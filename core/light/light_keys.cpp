// light_keys.cpp -- interpolation of lights between keys, and bounds over all keys.
#include "light/light_keys.h"

#include "light/emitter_check.h"

namespace dg {
namespace {

float on_the_way(float a, float b, float share) {
    if (a == b || (!std::isfinite(b - a) && share < 1)) return a;
    return share < 1 ? a * (1 - share) + b * share : b;
}
Vec3f on_the_way(Vec3f a, Vec3f b, float share) {
    return {on_the_way(a.x, b.x, share), on_the_way(a.y, b.y, share),
            on_the_way(a.z, b.z, share)};
}

/// Interpolates along the great circle, with the angle from atan2 as in slerp() of quaternion.h. Opposite directions
/// use an arbitrary great circle.
Vec3f turn_toward(Vec3f a, Vec3f b, float share) {
    const float angle = 2 * atan2(length(b - a), length(a + b));
    if (angle < 1e-4f) return normalize(on_the_way(a, b, share));
    Vec3f side = b - a * dot(a, b);
    if (length(side) < 1e-6f) side = Frame::from_normal(a).x;
    return normalize(a * std::cos(share * angle) + normalize(side) * std::sin(share * angle));
}

// Structured bindings name every field, so that a new field does not compile until it is listed here.
PointLight between(const PointLight& a, const PointLight& b, float s) {
    const auto& [position, intensity, range, lamp] = b;
    return {on_the_way(a.position, position, s), on_the_way(a.intensity, intensity, s),
            on_the_way(a.range, range, s), blend(a.lamp, lamp, s)};
}
SpotLight between(const SpotLight& a, const SpotLight& b, float s) {
    const auto& [position, direction, intensity, inner, outer, range] = b;
    return {on_the_way(a.position, position, s),   turn_toward(a.direction, direction, s),
            on_the_way(a.intensity, intensity, s), on_the_way(a.inner_angle, inner, s),
            on_the_way(a.outer_angle, outer, s),   on_the_way(a.range, range, s)};
}
DirectionalLight between(const DirectionalLight& a, const DirectionalLight& b, float s) {
    const auto& [direction, illuminance, angle] = b;
    return {turn_toward(a.direction, direction, s), on_the_way(a.illuminance, illuminance, s),
            on_the_way(a.angle, angle, s)};
}
SphereLight between(const SphereLight& a, const SphereLight& b, float s) {
    const auto& [shape, luminance, lamp] = b;
    return {blend(a.shape, shape, s), on_the_way(a.luminance, luminance, s), blend(a.lamp, lamp, s)};
}
TriangleLight between(const TriangleLight& a, const TriangleLight&, float) {
    return a;
}

}  // namespace

Light blend(const Light& a, const Light& b, float share) {
    return std::visit(
        [&](const auto& from) -> Light {
            using Kind = std::remove_cvref_t<decltype(from)>;
            return between(from, std::get<Kind>(b), share);
        },
        a);
}

void check_keys(std::span<const Light> keys, const std::string& where) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::string key = where + ", key " + std::to_string(i);
        const Light& light = keys[i];
        if (light.index() != keys[0].index())
            throw Error(key + ": kind: all keys must be the same kind of light");
        if (std::holds_alternative<TriangleLight>(light))
            throw input_error(key, "kind", "a light other than a triangle", "a triangle");
        const LampShape *lamp = lamp_of(light), *first = lamp_of(keys[0]);
        if (lamp && (lamp->profile != first->profile || lamp->mirrored != first->mirrored))
            throw Error(key + ": profile: must be the profile of the first key, not mirrored");
        std::visit([&](const auto& l) { check_emitter(l, key); }, light);
    }
}

/// Whether the profile of a lamp rotates.
static bool turns(const Keyed<Light>& keys) {
    const LampShape* first = lamp_of(keys.values[0]);
    return first && first->used() && std::ranges::any_of(keys.values, [&](const Light& key) {
        const Quaternionf a = first->rotation, b = lamp_of(key)->rotation;
        return a.x != b.x || a.y != b.y || a.z != b.z || a.w != b.w;
    });
}

LightBounds bounds_over(const Keyed<Light>& keys) {
    LightBounds all;
    float intensity = 0, luminance = 0, radius = 0;
    for (std::size_t i = 0; i < keys.values.size(); ++i) {
        const LightBounds b =
            std::visit([](const auto& l) { return emitter_bounds(l); }, keys.values[i]);
        all = i == 0 ? b : merge(all, b);
        intensity = std::max(intensity, b.intensity);
        if (const auto* sphere = std::get_if<SphereLight>(&keys.values[i])) {
            luminance = std::max(luminance, selection_weight(sphere->luminance));
            radius = std::max(radius, sphere->shape.radius);
        }
    }
    all.intensity = std::max(intensity, luminance * kPi * radius * radius);
    if (turns(keys)) all.spread = kPi, all.falloff = kPi / 2;   // its axis may leave the cone of the keys' axes
    return all;
}

float brightest(const Keyed<Light>& directional) {
    float most = 0;
    for (const Light& key : directional.values)
        most = std::max(most, selection_weight(std::get<DirectionalLight>(key).illuminance));
    return most;
}

/// Arcs of less than a right angle leave the box of their ends by at most 0.21 of the chord, and normals leave the cone
/// around both ends by at most half of the angle between them.
LightBounds bounds_over(std::span<const TriangleLight> steps, Rgb luminance) {
    LightBounds all;
    float area = 0, longest = 0, widest = 0;
    Vec3f last{};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const TriangleLight& t = steps[i];
        LightBounds b = emitter_bounds(t);
        area = std::max(area, triangle_area(t));
        if (i == 0) all = b;
        if (i > 0) {
            all = merge(all, b);
            const TriangleLight& before = steps[i - 1];
            longest = std::max({longest, length(t.a - before.a), length(t.b - before.b),
                                length(t.c - before.c)});
            widest = std::max(widest, 2 * atan2(length(b.axis - last), length(b.axis + last)));
        }
        last = b.axis;
    }
    const float out = 0.25f * longest;
    all.min = all.min - Vec3f{out, out, out};
    all.max = all.max + Vec3f{out, out, out};
    all.spread = std::min(kPi, all.spread + 0.5f * widest);
    all.intensity = selection_weight(luminance) * area;
    return all;
}

}  // namespace dg
